/* What the bus shows of itself and of its slaves, how a slave is named in a diagnosis, and the memory for slaves. */
#include <stdio.h>
#include <stdlib.h>

#include "bus/bus_internal.h"
#include "cm1e/control.h"

int64_t cm1e_bus_enter(cm1e_bus_t *bus)
{
    cm1e_clock_make_current(bus->clock);
    return cm1e_clock_now(bus->clock);
}

uint32_t cm1e_bus_slave_count(const cm1e_bus_t *bus) { return bus ? bus->slave_count : 0; }

const cm1e_slave_info_t *cm1e_bus_slave(const cm1e_bus_t *bus, uint32_t position)
{
    const cm1e_bus_slave_t *slave = cm1e_bus_at(bus, position);
    return slave ? &slave->info : NULL;
}

uint16_t cm1e_bus_axis_position(const cm1e_bus_t *bus, uint32_t axis)
{
    return bus && axis < bus->config.axis_count ? bus->axis_position[axis] : 0;
}

const cm1e_bus_counters_t *cm1e_bus_counters(const cm1e_bus_t *bus)
{
    static const cm1e_bus_counters_t none;
    return bus ? &bus->counters : &none;
}

const cm1e_bus_config_t *cm1e_bus_configuration(const cm1e_bus_t *bus)
{
    static const cm1e_bus_config_t none;
    return bus ? &bus->config : &none;
}

uint32_t cm1e_bus_operation(const cm1e_bus_t *bus) { return bus->phase == BUS_OPERATING ? bus->operations : 0; }
cm1e_clock_t *cm1e_bus_clock(cm1e_bus_t *bus) { return bus->clock; }

int64_t cm1e_bus_sent_ns(const cm1e_bus_t *bus) { return bus->sent_ns; }
struct cm1e_nic *cm1e_bus_nic(cm1e_bus_t *bus) { return bus->nic; }

const cm1e_firmware_info_t *cm1e_bus_slave_firmware(const cm1e_bus_t *bus, uint16_t position)
{
    const cm1e_bus_slave_t *slave = cm1e_bus_at(bus, position);
    return slave ? slave->firmware : NULL;
}

const char *cm1e_bus_kind(const cm1e_bus_slave_t *slave, char kind[CM1E_KIND_LENGTH])
{
    const cm1e_device_t *device = slave->info.device;
    if (device && device->family)
        snprintf(kind, CM1E_KIND_LENGTH, "%s %s", device->family, device->name ? device->name : "of an unknown model");
    else
        snprintf(kind, CM1E_KIND_LENGTH, "%s", slave->info.name[0] ? slave->info.name : "no name");
    return kind;
}

const char *cm1e_bus_label(const cm1e_bus_t *bus, const cm1e_bus_slave_t *slave, char label[CM1E_LABEL_LENGTH])
{
    char kind[CM1E_KIND_LENGTH];
    int used = snprintf(label, CM1E_LABEL_LENGTH, "slave %u (", slave->info.position);
    if (slave->config)
        used += snprintf(label + used, CM1E_LABEL_LENGTH - (size_t)used, "\"%s\", ", slave->config->name);
    for (unsigned channel = 0; channel < CM1E_CHANNELS; channel++) {
        const cm1e_axis_config_t *axis = cm1e_bus_axis_of(bus, slave, channel);
        if (axis)
            used += snprintf(label + used, CM1E_LABEL_LENGTH - (size_t)used, "\"%s\", ", axis->name);
    }
    snprintf(label + used, CM1E_LABEL_LENGTH - (size_t)used, "%s)", cm1e_bus_kind(slave, kind));
    return label;
}

const char *cm1e_bus_label_first(const cm1e_bus_t *bus, const cm1e_bus_slave_t *slave, char label[CM1E_LABEL_LENGTH])
{
    cm1e_bus_label(bus, slave, label);
    label[0] = 'S';
    return label;
}

const char *cm1e_bus_slave_label(const cm1e_bus_t *bus, uint16_t position, char label[CM1E_LABEL_LENGTH])
{
    const cm1e_bus_slave_t *slave = cm1e_bus_at(bus, position);
    if (slave)
        return cm1e_bus_label(bus, slave, label);
    snprintf(label, CM1E_LABEL_LENGTH, "slave %u", position);
    return label;
}

const char *cm1e_bus_slave_name(const cm1e_bus_t *bus, uint32_t position)
{
    const cm1e_bus_slave_t *slave = cm1e_bus_at(bus, position);
    return slave && slave->config ? slave->config->name : "";
}

bool cm1e_bus_is_attached(const cm1e_bus_t *bus) { return bus && bus->remote; }

bool cm1e_bus_slave_has_coe(const cm1e_bus_t *bus, uint16_t position)
{
    const cm1e_bus_slave_t *slave = cm1e_bus_at(bus, position);
    return slave && slave->facts.coe;
}

cm1e_error_t cm1e_bus_make_room(cm1e_bus_t *bus, uint32_t answering, cm1e_diag_t *diag)
{
    const uint32_t wanted = answering + bus->config.axis_count + bus->config.slave_count;
    const uint32_t room = wanted < CM1E_MAX_SLAVES ? wanted : CM1E_MAX_SLAVES;
    if (room <= bus->slave_room)
        return CM1E_OK;
    bus->slave_count = bus->scanned = 0;
    free(bus->slaves);
    bus->slaves = calloc(room, sizeof *bus->slaves);
    bus->slave_room = bus->slaves ? room : 0;
    if (!bus->slaves)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "Out of memory for %u slaves.", room);
    return CM1E_OK;
}
