/* An optional slave that is absent at the start: what the configuration knows of it, the room that is kept free for it
 * in the process image, and its place there when it has come. */
#include <stdlib.h>
#include <string.h>

#include "bus/bus_internal.h"
#include "config/clock_pulses.h"
#include "config/io_types.h"
#include "core/bytes.h"
#include "device/place.h"

/** Kept free in each direction for a slave whose process data nothing states; for a drive whose mapping is its own. */
enum { ROOM_BYTES = 32, DRIVE_ROOM_BYTES = 64 };

/* ---- identification ---------------------------------------------------------------------------------------------- */

void cm1e_hot_forget(cm1e_bus_t *bus)
{
    if (bus->remote)
        return; /* the program that runs it has told how it stands with each */
    bus->slave_count = bus->scanned;
    cm1e_soem_set_count(bus->soem, (uint16_t)bus->scanned);
    bus->search = (cm1e_search_t){0};
    for (uint32_t i = 0; i < bus->slave_count; i++)
        bus->slaves[i].hot = (cm1e_hot_t){.counted = true, .member = 1, .place = (uint16_t)(i + 1), .group = ""};
}

cm1e_bus_slave_t *cm1e_hot_plan(cm1e_bus_t *bus, cm1e_address_kind_t kind, uint16_t address, cm1e_diag_t *diag)
{
    if (bus->slave_count == CM1E_MAX_SLAVES) {
        cm1e_diag_set(diag, CM1E_ERROR_BUS_IDENTITY, 0, "Together with the optional slaves that are absent there are "
                      "more than %d slaves.", CM1E_MAX_SLAVES);
        return NULL;
    }
    cm1e_bus_slave_t *slave = &bus->slaves[bus->slave_count++];
    free(slave->signals);
    memset(slave, 0, sizeof *slave);
    slave->info.position = (uint16_t)bus->slave_count;
    slave->info.alias = kind == CM1E_ADDRESS_ALIAS ? address : 0;
    slave->info.explicit_id = kind == CM1E_ADDRESS_EXPLICIT_ID ? address : 0;
    slave->hot = (cm1e_hot_t){.optional = true, .planned = true, .away = true, .member = 1, .group = ""};
    slave->watch = (cm1e_slave_watch_t){.lost = true, .absent = true};
    return slave;
}

/** The model of a bridge by the motors of the configuration. */
static void describe_motors(const cm1e_bus_t *bus, cm1e_bus_slave_t *slave)
{
    const char *motors[CM1E_BRIDGE_AXES] = {"", "", "", ""};
    for (unsigned channel = 0; channel < CM1E_CHANNELS; channel++) {
        const cm1e_axis_config_t *axis = cm1e_bus_axis_of(bus, slave, channel);
        if (axis)
            slave->info.device = cm1e_device_configured(axis);
        if (axis && channel)
            motors[channel - 1] = axis->motor;
    }
    const cm1e_device_t *device = slave->info.device;
    if (device->with_motors)
        slave->info.device = device->with_motors(motors);
    slave->info.kind = slave->info.device->kind;
    slave->info.model = slave->info.device->model;
    slave->info.vendor_id = slave->info.device->vendor_id;
    slave->info.product_code = slave->info.device->product_code;
    const char *label = slave->info.device->label;
    memcpy(slave->info.name, label, strnlen(label, sizeof slave->info.name - 1));
}

static void describe_device(cm1e_bus_slave_t *slave)
{
    slave->info.vendor_id = slave->config->vendor;
    slave->info.product_code = slave->config->product;
    slave->info.revision = slave->config->revision;
    memcpy(slave->info.name, "not seen yet", sizeof "not seen yet");
}

static void take_settings(const cm1e_bus_t *bus, cm1e_bus_slave_t *slave)
{
    cm1e_recover_t policy = slave->config ? slave->config->recover : CM1E_RECOVER_DEFAULT;
    for (unsigned channel = 0; channel < CM1E_CHANNELS; channel++) {
        const cm1e_axis_config_t *axis = cm1e_bus_axis_of(bus, slave, channel);
        slave->hot.axis = slave->hot.axis ? slave->hot.axis : axis;
        policy = axis && axis->recover != CM1E_RECOVER_DEFAULT ? axis->recover : policy;
    }
    if (slave->config && slave->config->hot_connect[0]) {
        slave->hot.group = slave->config->hot_connect;
        slave->hot.member = cm1e_slave_is_member(slave->config) ? slave->config->address : 1;
    }
    const bool motors = cm1e_bus_has_motors(slave);
    slave->hot.policy = policy != CM1E_RECOVER_DEFAULT ? policy : motors ? CM1E_RECOVER_ASK : CM1E_RECOVER_AUTO;
}

cm1e_error_t cm1e_hot_describe(cm1e_bus_t *bus, cm1e_diag_t *diag)
{
    (void)diag;
    if (bus->remote)
        return CM1E_OK;
    cm1e_soem_set_count(bus->soem, (uint16_t)bus->slave_count);
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        cm1e_bus_slave_t *slave = &bus->slaves[i];
        if (slave->hot.planned) {
            cm1e_soem_facts(bus->soem, slave->info.position, &slave->facts);
            slave->al.station = slave->facts.station;
            if (cm1e_bus_is_used(slave))
                describe_motors(bus, slave);
            else
                describe_device(slave);
            slave->hot.vendor_id = slave->info.vendor_id;
            slave->hot.product_code = slave->info.product_code;
        }
        take_settings(bus, slave);
        bus->search.used = bus->search.used || slave->hot.optional;
    }
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        bus->slaves[i].hot.moves = bus->search.used;
        cm1e_hot_note(bus, &bus->slaves[i]);
    }
    return CM1E_OK;
}

/* ---- room in the image ------------------------------------------------------------------------------------------- */

static bool add_entry(cm1e_mapped_direction_t *mapped, uint16_t index, uint8_t subindex, uint8_t bits)
{
    if (mapped->entry_count == CM1E_MAPPED_ENTRIES)
        return false;
    mapped->entries[mapped->entry_count++] =
        (cm1e_mapped_entry_t){.index = index, .subindex = subindex, .bits = bits, .bit_offset = mapped->bits};
    mapped->bits = (uint16_t)(mapped->bits + bits);
    return true;
}

/** A PDO as the dictionary of the device has it: its mapping object by default. */
static void plan_pdo(cm1e_mapped_direction_t *mapped, const cm1e_device_t *device, uint16_t pdo)
{
    for (unsigned n = 1; n <= 0xFF; n++) {
        const cm1e_entry_t *entry = device->entry(device, pdo, (uint8_t)n);
        if (!entry || !add_entry(mapped, (uint16_t)(entry->default_value >> 16), (uint8_t)(entry->default_value >> 8),
                                 (uint8_t)entry->default_value))
            return;
    }
}

/** A drive whose assignment nobody states is taken for one with the first PDOs of its kind. */
static void plan_motors(const cm1e_bus_t *bus, cm1e_bus_slave_t *slave)
{
    const cm1e_device_t *device = slave->info.device;
    cm1e_pdo_choice_t choice = device->pdos(cm1e_bus_axis_of(bus, slave, 0));
    const bool own = device->recognised == CM1E_BY_PROFILE;
    if (own)
        choice = (cm1e_pdo_choice_t){1, {{0x1600}, {0x1A00}}};
    for (int direction = 0; direction < 2; direction++) {
        for (unsigned i = 0; i < choice.count; i++)
            plan_pdo(&slave->mapped[direction], device, choice.pdos[direction][i]);
        slave->hot.room[direction] = own ? DRIVE_ROOM_BYTES : (uint16_t)((slave->mapped[direction].bits + 7) / 8);
    }
}

/** The entries of the PDOs that the configuration assigns, where it states them too; false: it does not. */
static bool plan_stated(const cm1e_slave_config_t *config, int direction, cm1e_mapped_direction_t *mapped)
{
    /* NOLINTNEXTLINE(clang-analyzer-core.NullDereference): the configuration has this slave */
    const unsigned count = direction ? config->inputs_pdo_count : config->outputs_pdo_count;
    const uint16_t *pdos = direction ? config->inputs_pdos : config->outputs_pdos;
    for (unsigned i = 0; i < count; i++) {
        const unsigned before = mapped->entry_count;
        for (unsigned n = 0; n < (unsigned)config->entry_count + config->described_count; n++)
            if (config->entries[n].pdo == pdos[i])
                add_entry(mapped, config->entries[n].index, config->entries[n].subindex, config->entries[n].bits);
        if (mapped->entry_count == before) {
            *mapped = (cm1e_mapped_direction_t){0};
            return false;
        }
    }
    return count > 0;
}

/** Bits that the signals of the configuration reach to. */
static unsigned bits_named(const cm1e_slave_config_t *config, bool output)
{
    unsigned most = 0;
    for (unsigned i = 0; i < config->signal_count; i++) {
        const cm1e_signal_config_t *signal = &config->signals[i];
        const unsigned bits = signal->bits ? signal->bits : signal->type_stated ? cm1e_io_types[signal->type].bits : 1;
        const unsigned end = signal->index || signal->output != output ? 0 : signal->bit + bits;
        most = end > most ? end : most;
    }
    return most;
}

static cm1e_error_t plan_device(const cm1e_bus_t *bus, cm1e_bus_slave_t *slave, cm1e_diag_t *diag)
{
    char label[CM1E_LABEL_LENGTH];
    const cm1e_slave_config_t *config = slave->config;
    bool *stated = slave->hot.stated;
    for (int direction = 0; direction < 2; direction++) {
        stated[direction] = plan_stated(config, direction, &slave->mapped[direction]);
        const unsigned bits = stated[direction] ? slave->mapped[direction].bits : bits_named(config, !direction);
        const unsigned bytes = (bits + 7) / 8;
        slave->hot.room[direction] = (uint16_t)(bytes > ROOM_BYTES ? bytes : ROOM_BYTES);
    }
    slave->by_pdos = stated[0] || stated[1];
    for (unsigned i = 0; i < config->signal_count; i++)
        if (config->signals[i].index && !stated[!config->signals[i].output])
            return cm1e_diag_set(diag, CM1E_ERROR_PDO_MAPPING, 0, "%s is absent, so where its object 0x%04X:%02X will "
                                 "be is not known (signal \"%s\"): state its bit, or %s and mapping, or start with the "
                                 "slave plugged in.", cm1e_bus_label_first(bus, slave, label), config->signals[i].index,
                                 config->signals[i].subindex, config->signals[i].name,
                                 config->signals[i].output ? "outputs_pdos" : "inputs_pdos");
    return CM1E_OK;
}

cm1e_error_t cm1e_hot_reserve(cm1e_bus_t *bus, cm1e_bus_slave_t *slave, cm1e_diag_t *diag)
{
    char label[CM1E_LABEL_LENGTH];
    const cm1e_axis_config_t *axis = cm1e_bus_axis_of(bus, slave, 0);
    const cm1e_dc_config_t *dc = axis ? &axis->dc : slave->config ? &slave->config->dc : NULL;
    memset(slave->mapped, 0, sizeof slave->mapped);
    slave->by_pdos = false;
    if (dc && cm1e_config_has_pulses(dc))
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "%s is absent, and it has dc: its clock is set up only at the "
                             "start. Start with the slave plugged in.", cm1e_bus_label_first(bus, slave, label));
    if (!cm1e_bus_is_used(slave))
        return plan_device(bus, slave, diag);
    plan_motors(bus, slave);
    return CM1E_OK;
}

/* ---- its place when it has come ---------------------------------------------------------------------------------- */

enum { PROCESS_OUTPUTS = 2, FMMU_READ = 1, FMMU_WRITE = 2, FMMU_AT_PHYSICAL = 8 };

/** Bits that each sync manager carries in a direction. */
static void find_bits(const cm1e_bus_slave_t *slave, int direction, uint16_t bits[CM1E_SII_SYNC_MANAGERS])
{
    memcpy(bits, slave->hot.scouted.bits[direction], CM1E_SII_SYNC_MANAGERS * sizeof *bits);
    if (!cm1e_bus_has_motors(slave) && !slave->by_pdos)
        return;
    memset(bits, 0, CM1E_SII_SYNC_MANAGERS * sizeof *bits);
    bits[PROCESS_OUTPUTS + (direction ^ (int)slave->facts.swapped)] = slave->mapped[direction].bits;
}

static void put_sync_manager(uint8_t *to, const cm1e_sii_sync_manager_t *from, uint16_t length)
{
    cm1e_put_u16(to, from->start);
    cm1e_put_u16(to + 2, length);
    to[4] = from->control;
    to[5] = to[7] = 0;
    to[6] = from->enable;
}

/** Of a motor only its place is taken from the SII, as at the start: see set_direction() of soem_adapter.c. */
static cm1e_sii_sync_manager_t sync_manager_of(const cm1e_bus_slave_t *slave, int sm)
{
    cm1e_sii_sync_manager_t manager = slave->hot.scouted.sync_managers[sm];
    if (sm >= PROCESS_OUTPUTS && cm1e_bus_has_motors(slave)) {
        /* cppcheck-suppress arrayIndexOutOfBoundsCond ; sm is one of the four */
        const cm1e_sync_manager_t *standard = &cm1e_device_sync_managers[sm];
        manager.start = manager.start ? manager.start : standard->start;
        manager.control = standard->control;
        manager.enable = standard->enable;
    }
    return manager;
}

static void add_fmmu(cm1e_slave_placement_t *placement, uint32_t logical, uint16_t physical, uint16_t bytes, int type)
{
    uint8_t *fmmu = placement->fmmus[placement->fmmu_count++];
    memset(fmmu, 0, FMMU_BYTES);
    cm1e_put_u32(fmmu, logical);
    cm1e_put_u16(fmmu + 4, bytes);
    fmmu[7] = 7;
    cm1e_put_u16(fmmu + FMMU_AT_PHYSICAL, physical);
    fmmu[11] = (uint8_t)type;
    fmmu[12] = 1;
}

/** Returns the bytes of the direction; more than the room, if they do not fit. */
static unsigned place_direction(cm1e_bus_slave_t *slave, int direction)
{
    cm1e_slave_placement_t *placement = &slave->placement;
    const uint32_t base = direction ? slave->hot.inputs_begin : slave->hot.outputs_begin;
    uint16_t bits[CM1E_SII_SYNC_MANAGERS];
    unsigned bytes = 0;
    find_bits(slave, direction, bits);
    for (int sm = 0; sm < 4; sm++) {
        const unsigned length = (bits[sm] + 7u) / 8u;
        const cm1e_sii_sync_manager_t manager = sync_manager_of(slave, sm);
        if (length == 0)
            continue;
        if (manager.start == 0 || placement->fmmu_count == 4 || bytes + length > slave->hot.room[direction])
            return UINT16_MAX;
        put_sync_manager(placement->sync_managers[sm], &manager, (uint16_t)length);
        add_fmmu(placement, base + bytes, manager.start, (uint16_t)length, direction ? FMMU_READ : FMMU_WRITE);
        bytes += length;
    }
    return bytes;
}

bool cm1e_hot_place(cm1e_bus_slave_t *slave)
{
    cm1e_slave_placement_t *placement = &slave->placement;
    const cm1e_slave_config_t *config = slave->config;
    unsigned bytes[2];
    memset(placement->sync_managers[PROCESS_OUTPUTS], 0, 2 * SYNC_MANAGER_BYTES);
    placement->fmmu_count = 0;
    for (int direction = 0; direction < 2; direction++) {
        bytes[direction] = place_direction(slave, direction);
        if (bytes[direction] > slave->hot.room[direction]) {
            slave->hot.refused = "its process data need more room than was kept free for it: start with it plugged in";
            return false;
        }
        if (config && bits_named(config, !direction) > 8 * bytes[direction]) {
            slave->hot.refused = "it has fewer process data than the signals of the configuration need";
            return false;
        }
    }
    placement->output_bytes = slave->info.output_bytes = (uint16_t)bytes[0];
    placement->input_bytes = slave->info.input_bytes = (uint16_t)bytes[1];
    slave->hot.bound++;
    return true;
}
