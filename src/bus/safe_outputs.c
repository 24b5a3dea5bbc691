/* The safe values of outputs of the slaves that the configuration names: see docs/BUS-FILE.md. */
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "bus/bus_internal.h"
#include "bus/io_list.h"
#include "config/io_types.h"

/** The bits of a value of a signal. */
static uint64_t bits_of_value(const cm1e_io_info_t *info, double value)
{
    const float narrow = (float)value;
    uint32_t word;
    uint64_t wide;
    memcpy(&word, &narrow, sizeof word);
    memcpy(&wide, &value, sizeof wide);
    if (cm1e_io_types[info->type].is_real)
        return info->type == CM1E_IO_REAL ? word : wide;
    return value < 0 ? (uint64_t)(int64_t)value : (uint64_t)value;
}

static void put_bit(uint8_t *bytes, uint32_t bit, bool on)
{
    const uint8_t mask = (uint8_t)(1u << bit % 8);
    bytes[bit / 8] = (uint8_t)(on ? bytes[bit / 8] | mask : bytes[bit / 8] & ~mask);
}

static cm1e_error_t take_signal(cm1e_bus_t *bus, const cm1e_bus_slave_t *slave, const cm1e_listed_signal_t *signal,
                                cm1e_diag_t *diag)
{
    const cm1e_io_info_t *info = &signal->info;
    char label[CM1E_LABEL_LENGTH];
    if (!signal->config || !info->output || info->bits > 64)
        return CM1E_OK;
    const double safe = signal->config->safe;
    if (safe != 0 && !cm1e_io_fits(info->type, info->bits, safe))
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "The safe value %.10g of \"%s\" of %s is no %s of %u bits.",
                             safe, info->name, cm1e_bus_label(bus, slave, label), cm1e_io_type_name(info->type),
                             info->bits);
    const uint64_t value = bits_of_value(info, safe);
    for (uint32_t n = 0; n < info->bits; n++) {
        const uint32_t bit = 8 * slave->placement.output_offset + info->bit_offset + n;
        put_bit(bus->safe.mask, bit, !signal->config->hold);
        put_bit(bus->safe.values, bit, value >> n & 1);
    }
    return CM1E_OK;
}

cm1e_error_t cm1e_bus_prepare_safe_outputs(cm1e_bus_t *bus, cm1e_diag_t *diag)
{
    cm1e_error_t error = CM1E_OK;
    bus->safe.released = bus->safe.any = false;
    for (uint32_t i = 0; i < bus->slave_count && error == CM1E_OK; i++) {
        const cm1e_bus_slave_t *slave = &bus->slaves[i];
        if (!slave->config)
            continue;
        bus->safe.any |= slave->placement.output_bytes > 0;
        memset(bus->safe.mask + slave->placement.output_offset, 0xFF, slave->placement.output_bytes);
        for (uint32_t n = 0; n < slave->signals->count && error == CM1E_OK; n++)
            error = take_signal(bus, slave, &slave->signals->at[n], diag);
    }
    if (error == CM1E_OK)
        memcpy(bus->outputs, bus->safe.values, bus->output_bytes); /* until the program writes them */
    return error;
}

static void make_safe(cm1e_bus_t *bus, uint32_t offset, size_t bytes)
{
    for (size_t i = offset; i < offset + bytes; i++)
        bus->outputs[i] = (uint8_t)((bus->outputs[i] & ~bus->safe.mask[i]) | (bus->safe.values[i] & bus->safe.mask[i]));
}

void cm1e_bus_make_outputs_safe(cm1e_bus_t *bus)
{
    if (!bus->safe.any)
        return;
    if (bus->safe.released || cm1e_bus_health(bus) == CM1E_ERROR_BUS_LOST) {
        make_safe(bus, 0, bus->output_bytes);
        return;
    }
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        const cm1e_bus_slave_t *slave = &bus->slaves[i];
        if (slave->config && (slave->watch.lost || cm1e_recovery_mutes(&slave->recovery)))
            make_safe(bus, slave->placement.output_offset, slave->placement.output_bytes);
    }
}

void cm1e_bus_release_outputs(cm1e_bus_t *bus) { bus->safe.released = true; }
