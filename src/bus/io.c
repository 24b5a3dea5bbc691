/* The process data of slaves, signal by signal: see cm1e/io.h. Where a signal lies is found at start-up; reading and
 * writing moves at most nine bytes. */
#include "cm1e/io.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "bus/io_guest.h"
#include "bus/io_list.h"
#include "config/io_types.h"

/* ---- to find one ------------------------------------------------------------------------------------------------- */

static cm1e_error_t check_ready(const cm1e_bus_t *bus, cm1e_diag_t *diag)
{
    const cm1e_error_t attached = bus ? cm1e_bus_refuse_attached(bus, "Access to process data", diag) : CM1E_OK;
    if (attached != CM1E_OK)
        return attached;
    if (!bus)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "To find a signal needs a bus.");
    if (!bus->layout.present)
        return cm1e_diag_set(diag, CM1E_ERROR_STATE, 0, "Signals are known from cm1e_bus_configure() on: configure or "
                             "start the bus first.");
    return CM1E_OK;
}

static cm1e_error_t no_place(cm1e_diag_t *diag)
{
    return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "A signal that is found needs a place, a cm1e_io_t.");
}

static cm1e_error_t no_slave(const cm1e_bus_t *bus, uint32_t position, cm1e_diag_t *diag)
{
    return cm1e_diag_set(diag, CM1E_ERROR_NOT_FOUND, 0, "There is no slave %" PRIu32 ": the network has %" PRIu32 ".",
                         position, bus->slave_count);
}

/** Number of the process image, and of what the slave has in it: a motor that comes may have its objects elsewhere than
 *  was planned, and a handle would show another one. */
static uint32_t layout_of(const cm1e_bus_t *bus, uint16_t position)
{
    enum { RELAID_AT = 16 };
    const cm1e_bus_slave_t *slave = cm1e_bus_at(bus, position);
    return bus->layout.present && slave ? bus->layout.present + (slave->hot.relaid << RELAID_AT) : 0;
}

static cm1e_error_t find_bits(cm1e_bus_t *bus, uint16_t position, bool output, uint32_t bit_offset, uint16_t bits,
                              cm1e_io_type_t type, cm1e_io_t *io, cm1e_diag_t *diag)
{
    *io = (cm1e_io_t){0};
    const cm1e_error_t error = check_ready(bus, diag);
    if (error != CM1E_OK)
        return error;
    const cm1e_bus_slave_t *slave = cm1e_bus_at(bus, position);
    if (!slave)
        return no_slave(bus, position, diag);
    const uint32_t most = (unsigned)type < CM1E_IO_TYPE_COUNT ? cm1e_io_types[type].bits : 0;
    const bool exact = (unsigned)type < CM1E_IO_TYPE_COUNT && (type == CM1E_IO_BOOL || cm1e_io_types[type].is_real);
    if ((unsigned)type >= CM1E_IO_TYPE_COUNT || bits == 0 || (most && bits > most) || (exact && bits != most))
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "A signal of type %s has not %u bits.",
                             cm1e_io_type_name(type), bits);
    const cm1e_slave_placement_t *placement = &slave->placement;
    const uint32_t there = 8u * (output ? placement->output_bytes : placement->input_bytes);
    if (bit_offset > there || bits > there - bit_offset)
        return cm1e_diag_set(diag, CM1E_ERROR_NOT_FOUND, 0, "Slave %u has %" PRIu32 " bits of %s: bits %" PRIu32
                             " ... %" PRIu32 " are not among them.", position, there, output ? "outputs" : "inputs",
                             bit_offset, bit_offset + bits - 1u);
    *io = (cm1e_io_t){.bus = bus, .layout = layout_of(bus, position), .position = position, .bits = bits,
                      .type = (uint8_t)type,
                      .byte = (output ? placement->output_offset : placement->input_offset) + bit_offset / 8,
                      .shift = bit_offset % 8, .output = output};
    return CM1E_OK;
}

/** From now on the outputs that were found are the program's. */
static cm1e_error_t claim(const cm1e_io_t *io, cm1e_error_t error)
{
    for (unsigned bit = io->shift; error == CM1E_OK && io->output && bit < io->shift + (unsigned)io->bits; bit++)
        io->bus->safe.claimed[io->byte + bit / 8] |= (uint8_t)(1u << bit % 8);
    return error;
}

cm1e_error_t cm1e_io_find_bits(cm1e_bus_t *bus, uint16_t position, bool output, uint32_t bit_offset, uint16_t bits,
                               cm1e_io_type_t type, cm1e_io_t *io, cm1e_diag_t *diag)
{
    return io ? claim(io, find_bits(bus, position, output, bit_offset, bits, type, io, diag)) : no_place(diag);
}

cm1e_error_t cm1e_io_find_object(cm1e_bus_t *bus, uint16_t position, uint16_t index, uint8_t subindex, bool output,
                                 cm1e_io_t *io, cm1e_diag_t *diag)
{
    if (!io)
        return no_place(diag);
    *io = (cm1e_io_t){0};
    const cm1e_error_t error = check_ready(bus, diag);
    if (error != CM1E_OK)
        return error;
    const cm1e_bus_slave_t *slave = cm1e_bus_at(bus, position);
    if (!slave)
        return no_slave(bus, position, diag);
    cm1e_io_info_t info = {0};
    while (cm1e_io_next(bus, slave, &info))
        if (info.output == output && info.index == index && info.subindex == subindex)
            return claim(io, cm1e_io_guest_take(bus, &info, io, diag));
    return cm1e_diag_set(diag, CM1E_ERROR_NOT_FOUND, 0, "Object 0x%04X:%02X is not among the %s of slave %u.", index,
                         subindex, output ? "outputs" : "inputs", position);
}

/** Where `name` goes on behind "WORD."; NULL: it does not begin so. */
static const char *behind(const char *name, const char *word)
{
    const size_t length = strlen(word);
    return length > 0 && strncasecmp(name, word, length) == 0 && name[length] == '.' ? name + length + 1 : NULL;
}

static bool is_the_only_one(const cm1e_bus_t *bus, const cm1e_bus_slave_t *slave)
{
    unsigned count = 0;
    for (uint32_t i = 0; i < bus->slave_count; i++)
        count += strcasecmp(bus->slaves[i].info.name, slave->info.name) == 0;
    return count == 1;
}

/** The name of the signal, where `name` begins with this slave; else NULL. The configuration's name counts first. */
static const char *behind_slave(const cm1e_bus_t *bus, const cm1e_bus_slave_t *slave, const char *name, bool by_config)
{
    char word[16];
    if (by_config)
        return slave->config ? behind(name, slave->config->name) : NULL;
    snprintf(word, sizeof word, "slave %u", slave->info.position);
    const char *found = behind(name, word);
    if (!found)
        found = behind(name, word + sizeof "slave " - 1);
    if (!found && is_the_only_one(bus, slave))
        found = behind(name, slave->info.name);
    return found;
}

static bool is_named(const cm1e_io_info_t *info, const char *word)
{
    char by_number[24], by_object[16];
    snprintf(by_number, sizeof by_number, "%s %u", info->output ? "output" : "input", info->number);
    snprintf(by_object, sizeof by_object, "0x%04X:%02X", info->index, info->subindex);
    return strcasecmp(word, info->name) == 0 || strcasecmp(word, by_number) == 0 || strcasecmp(word, by_object) == 0;
}

static cm1e_error_t not_found(const cm1e_bus_t *bus, const cm1e_bus_slave_t *slave, const char *word, cm1e_diag_t *diag)
{
    char list[300] = "";
    size_t used = 0;
    cm1e_io_info_t info = {0};
    while (cm1e_io_next(bus, slave, &info) && used + 80 < sizeof list)
        used += (size_t)snprintf(list + used, sizeof list - used, "%s\"%s\" (%s %u)", used ? ", " : "", info.name,
                                 info.output ? "output" : "input", info.number);
    return cm1e_diag_set(diag, CM1E_ERROR_NOT_FOUND, 0, "Slave %u has no signal \"%.60s\". It has: %s%s.",
                         slave->info.position, word, used ? list : "none", used + 80 >= sizeof list ? " ..." : "");
}

/** The one signal of this name; its name alone may be that of several. */
static cm1e_error_t find_word(cm1e_bus_t *bus, const cm1e_bus_slave_t *slave, const char *word, cm1e_io_t *io,
                              cm1e_diag_t *diag)
{
    cm1e_io_info_t info = {0}, found = {0};
    unsigned count = 0;
    while (cm1e_io_next(bus, slave, &info)) {
        if (!is_named(&info, word))
            continue;
        found = info;
        count++;
    }
    if (count == 0)
        return not_found(bus, slave, word, diag);
    if (count > 1)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "Slave %u has %u signals with the name \"%.60s\": "
                             "choose one by its number, such as \"%u.%s %u\".", slave->info.position, count, word,
                             slave->info.position, found.output ? "output" : "input", found.number);
    return cm1e_io_guest_take(bus, &found, io, diag);
}

cm1e_error_t cm1e_io_find(cm1e_bus_t *bus, const char *name, cm1e_io_t *io, cm1e_diag_t *diag)
{
    return io ? claim(io, cm1e_io_guest_find(bus, name, io, diag)) : no_place(diag);
}

cm1e_error_t cm1e_io_guest_find(cm1e_bus_t *bus, const char *name, cm1e_io_t *io, cm1e_diag_t *diag)
{
    *io = (cm1e_io_t){0};
    const cm1e_error_t error = check_ready(bus, diag);
    if (error != CM1E_OK)
        return error;
    if (!name)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "A signal needs a name, such as \"3.input 1\".");
    for (uint32_t n = 0; n < 2 * bus->slave_count; n++) {
        /* NOLINTNEXTLINE(clang-analyzer-core.DivideZero): the number of slaves stays */
        const cm1e_bus_slave_t *slave = &bus->slaves[n % bus->slave_count];
        const char *word = behind_slave(bus, slave, name, n < bus->slave_count);
        if (word)
            return find_word(bus, slave, word, io, diag);
    }
    return cm1e_diag_set(diag, CM1E_ERROR_NOT_FOUND, 0, "\"%.80s\" names no slave of the network, which has %" PRIu32
                         ". A signal is named as in \"3.input 1\", or by the name of a slave that no other has.", name,
                         bus->slave_count);
}

/* ---- for guests -------------------------------------------------------------------------------------------------- */

bool cm1e_io_guest_next(const cm1e_bus_t *bus, cm1e_io_info_t *info)
{
    uint32_t position = info->position ? info->position : 1;
    while (bus->layout.present && position <= bus->slave_count) {
        if (cm1e_io_next(bus, cm1e_bus_at(bus, position), info))
            return true;
        *info = (cm1e_io_info_t){0};
        position++;
    }
    return false;
}

cm1e_error_t cm1e_io_guest_take(cm1e_bus_t *bus, const cm1e_io_info_t *info, cm1e_io_t *io, cm1e_diag_t *diag)
{
    return find_bits(bus, info->position, info->output, info->bit_offset, info->bits, info->type, io, diag);
}

bool cm1e_io_is_claimed(const cm1e_io_t *io)
{
    bool claimed = false;
    for (unsigned bit = io->shift; io->output && bit < io->shift + (unsigned)io->bits; bit++)
        claimed = claimed || (io->bus->safe.claimed[io->byte + bit / 8] >> bit % 8 & 1);
    return claimed;
}

void cm1e_io_guest_release(const cm1e_io_t *io)
{
    for (unsigned bit = io->shift; io->output && bit < io->shift + (unsigned)io->bits; bit++) {
        const uint8_t mask = (uint8_t)(1u << bit % 8);
        uint8_t *byte = &io->bus->outputs[io->byte + bit / 8];
        *byte = (uint8_t)((*byte & ~mask) | (io->bus->safe.values[io->byte + bit / 8] & mask));
    }
}

/* ---- in the cycle ------------------------------------------------------------------------------------------------ */

const char *cm1e_io_quality_name(cm1e_io_quality_t quality)
{
    static const char *const names[] = {"good", "stale", "offline", "invalid"};
    return (unsigned)quality < sizeof names / sizeof names[0] ? names[quality] : "?";
}

static bool is_valid(const cm1e_io_t *io)
{
    return io && io->bus && io->layout != 0 && io->layout == layout_of(io->bus, io->position);
}

cm1e_io_quality_t cm1e_io_quality(const cm1e_io_t *io)
{
    if (!is_valid(io))
        return CM1E_IO_INVALID;
    if (io->bus->phase != BUS_OPERATING)
        return CM1E_IO_OFFLINE;
    const cm1e_slave_watch_t watch = cm1e_bus_slave_watch(io->bus, io->position);
    /* The supervision looks at one slave in each cycle. Before its first look (0) the start has seen Operational. */
    const bool operational = watch.al_state == 0 || watch.al_state == CM1E_AL_OP;
    if (watch.lost || watch.silent || !operational || cm1e_bus_health(io->bus) == CM1E_ERROR_BUS_LOST)
        return CM1E_IO_OFFLINE;
    return watch.fresh ? CM1E_IO_GOOD : CM1E_IO_STALE;
}

/** The bits of a signal of at most 64 bits. They begin anywhere in a byte, so they may lie in nine. */
static uint64_t bits_of(const cm1e_io_t *io)
{
    if (!is_valid(io) || io->bits > 64)
        return 0;
    const uint8_t *bytes = (io->output ? io->bus->outputs : io->bus->inputs) + io->byte;
    const unsigned count = (io->shift + io->bits + 7u) / 8u;
    uint64_t value = 0;
    for (unsigned i = 0; i < count && i < 8; i++)
        value |= (uint64_t)bytes[i] << 8 * i;
    value >>= io->shift;
    if (count > 8)
        value |= (uint64_t)bytes[8] << (64 - io->shift);
    return io->bits < 64 ? value & ((UINT64_C(1) << io->bits) - 1) : value;
}

static void put_bits(const cm1e_io_t *io, uint64_t value)
{
    uint8_t *bytes = io->bus->outputs + io->byte;
    for (unsigned done = 0, at = io->shift; done < io->bits;) {
        const unsigned room = 8 - at % 8, left = io->bits - done, count = left < room ? left : room;
        const uint8_t mask = (uint8_t)(((1u << count) - 1u) << at % 8);
        bytes[at / 8] = (uint8_t)((bytes[at / 8] & ~mask) | ((value >> done << at % 8) & mask));
        done += count;
        at += count;
    }
}

int64_t cm1e_io_integer(const cm1e_io_t *io)
{
    if (!io)
        return 0;
    const uint64_t value = bits_of(io);
    if (cm1e_io_types[io->type].is_real) {
        const double real = cm1e_io_real(io);
        return isnan(real) ? 0 : real >= 0x1p63 ? INT64_MAX : real < -0x1p63 ? INT64_MIN : (int64_t)real;
    }
    if (cm1e_io_types[io->type].is_signed && io->bits < 64 && (value >> (io->bits - 1) & 1))
        return (int64_t)(value | ~UINT64_C(0) << io->bits);
    return (int64_t)value;
}

double cm1e_io_real(const cm1e_io_t *io)
{
    if (!io)
        return 0.0;
    const uint64_t value = bits_of(io);
    double real = (double)value;
    if (io->type == CM1E_IO_REAL) {
        const uint32_t word = (uint32_t)value;
        float narrow;
        memcpy(&narrow, &word, sizeof narrow);
        real = (double)narrow;
    } else if (io->type == CM1E_IO_LREAL) {
        memcpy(&real, &value, sizeof real);
    } else if (cm1e_io_types[io->type].is_signed) {
        real = (double)cm1e_io_integer(io);
    }
    return real;
}

bool cm1e_io_bool(const cm1e_io_t *io)
{
    return io && (cm1e_io_types[io->type].is_real ? cm1e_io_real(io) != 0.0 : bits_of(io) != 0);
}

/** Byte number `i` of a signal, as a signal of at most 8 bits. */
static cm1e_io_t byte_of(const cm1e_io_t *io, size_t i)
{
    const unsigned left = io->bits - 8u * (unsigned)i;
    cm1e_io_t part = *io;
    part.byte += (uint32_t)i;
    part.bits = (uint16_t)(left < 8 ? left : 8);
    return part;
}

size_t cm1e_io_bytes(const cm1e_io_t *io, void *bytes, size_t size)
{
    const size_t count = io ? (io->bits + 7u) / 8u : 0;
    if (!is_valid(io) || !bytes || count > size)
        return 0;
    for (size_t i = 0; i < count; i++) {
        const cm1e_io_t part = byte_of(io, i);
        ((uint8_t *)bytes)[i] = (uint8_t)bits_of(&part);
    }
    return count;
}

static cm1e_error_t check_output(const cm1e_io_t *io)
{
    if (!io)
        return CM1E_ERROR_INVALID_ARGUMENT;
    if (!is_valid(io))
        return CM1E_ERROR_STATE;
    if (!io->output || cm1e_bus_has_motors(&io->bus->slaves[io->position - 1]))
        return CM1E_ERROR_INVALID_ARGUMENT;
    return CM1E_OK;
}

static bool in_range(const cm1e_io_t *io, int64_t value)
{
    if (io->bits >= 64)
        return cm1e_io_types[io->type].is_signed || value >= 0;
    if (cm1e_io_types[io->type].is_signed)
        return value >= -(INT64_C(1) << (io->bits - 1)) && value < INT64_C(1) << (io->bits - 1);
    return value >= 0 && (uint64_t)value < UINT64_C(1) << io->bits;
}

cm1e_error_t cm1e_io_set_integer(const cm1e_io_t *io, int64_t value)
{
    const cm1e_error_t error = check_output(io);
    if (error == CM1E_OK && cm1e_io_types[io->type].is_real)
        return cm1e_io_set_real(io, (double)value);
    if (error == CM1E_OK && (io->type == CM1E_IO_BYTES || !in_range(io, value)))
        return CM1E_ERROR_INVALID_ARGUMENT;
    if (error == CM1E_OK)
        put_bits(io, (uint64_t)value);
    return error;
}

cm1e_error_t cm1e_io_set_bool(const cm1e_io_t *io, bool value) { return cm1e_io_set_integer(io, value); }

cm1e_error_t cm1e_io_set_real(const cm1e_io_t *io, double value)
{
    const cm1e_error_t error = check_output(io);
    if (error != CM1E_OK)
        return error;
    if (!cm1e_io_fits((cm1e_io_type_t)io->type, io->bits, value))
        return CM1E_ERROR_INVALID_ARGUMENT;
    if (!cm1e_io_types[io->type].is_real) {
        put_bits(io, value < 0 ? (uint64_t)(int64_t)value : (uint64_t)value);
        return CM1E_OK;
    }
    const float narrow = (float)value;
    uint32_t word;
    uint64_t wide;
    memcpy(&word, &narrow, sizeof word);
    memcpy(&wide, &value, sizeof wide);
    put_bits(io, io->type == CM1E_IO_REAL ? word : wide);
    return CM1E_OK;
}

cm1e_error_t cm1e_io_set_bytes(const cm1e_io_t *io, const void *bytes, size_t size)
{
    const cm1e_error_t error = check_output(io);
    if (error != CM1E_OK)
        return error;
    if (!bytes || size != (io->bits + 7u) / 8u)
        return CM1E_ERROR_INVALID_ARGUMENT;
    for (size_t i = 0; i < size; i++) {
        const cm1e_io_t part = byte_of(io, i);
        put_bits(&part, ((const uint8_t *)bytes)[i]);
    }
    return CM1E_OK;
}
