/* Slaves and transfers of a bus that another program runs. */
#include <stdlib.h>
#include <string.h>

#include "bus/bus_internal.h"

static void take_device(cm1e_bus_slave_t *slave, const cm1e_remote_slave_t *told)
{
    cm1e_slave_info_t *info = &slave->info;
    const cm1e_device_t *by_profile = cm1e_device_recognised(CM1E_BY_PROFILE);
    const cm1e_device_t *by_model = cm1e_device_of_model(info->model);
    info->device = cm1e_device_of_identity(info->vendor_id, info->product_code);
    if (!info->device && by_model && by_model->recognised == CM1E_BY_OBJECTS && strcmp(by_model->kind, told->kind) == 0)
        info->device = by_model;
    else if (!info->device && strcmp(cm1e_device_unknown_bridge.kind, told->kind) == 0)
        info->device = &cm1e_device_unknown_bridge;
    else if (!info->device && by_profile && strcmp(by_profile->kind, told->kind) == 0)
        info->device = by_profile;
    info->kind = info->device ? info->device->kind : NULL;
    slave->firmware = info->device && info->device->firmware ? info->device->firmware(info->software_version) : NULL;
    slave->facts.coe = told->coe;
    for (unsigned i = 0; i < CM1E_BRIDGE_AXES; i++)
        slave->bridge.motors[i] = info->motors[i];
}

static void take_emergencies(cm1e_bus_slave_t *slave, const cm1e_remote_slave_t *told)
{
    for (uint32_t i = 0; i < told->emergency_count; i++) {
        cm1e_history_go_on_after(slave->emergencies, told->emergencies[i].number - 1);
        cm1e_history_add(slave->emergencies, CM1E_EMERGENCY_SHAPE, &told->emergencies[i]);
    }
}

cm1e_error_t cm1e_bus_scan_remote(cm1e_bus_t *bus, cm1e_diag_t *diag)
{
    cm1e_remote_slave_t *told = calloc(CM1E_MAX_SLAVES, sizeof *told);
    cm1e_remote_network_t network = {0};
    uint32_t count = 0;
    if (!told)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "Out of memory for the slaves of another program.");
    cm1e_error_t error = bus->remote->scan(bus->remote_state, told, CM1E_MAX_SLAVES, &count, &network, diag);
    if (error == CM1E_OK)
        error = cm1e_bus_make_room(bus, count, diag);
    bus->ring.ring = network.ring;
    cm1e_strangers_set(&bus->search.strangers, network.strangers, network.stranger_count);
    free(bus->remote_texts);
    bus->remote_texts = calloc(CM1E_MAX_SLAVES, sizeof *bus->remote_texts);
    for (uint32_t i = 0; i < count && error == CM1E_OK; i++) {
        memset(&bus->slaves[i], 0, sizeof bus->slaves[i]);
        bus->slaves[i].info = told[i].info;
        take_device(&bus->slaves[i], &told[i]);
        take_emergencies(&bus->slaves[i], &told[i]);
        bus->slaves[i].hot = (cm1e_hot_t){.presence = (uint32_t)told[i].presence, .group = "", .member = 1};
        bus->slaves[i].ports.place.known = told[i].open_ports != 0;
        for (unsigned port = 0; port < CM1E_PORTS; port++)
            bus->slaves[i].ports.place.open[port] = told[i].open_ports >> port & 1;
        if (bus->remote_texts)
            memcpy(bus->remote_texts[i], told[i].presence_text, sizeof told[i].presence_text);
        bus->dc.used = (i > 0 && bus->dc.used) || told[i].has_clock;
        bus->dc.slaves[i].clock = told[i].clock;
    }
    free(told);
    if (error != CM1E_OK)
        return error;
    bus->slave_count = bus->scanned = count;
    cm1e_bus_set_phase(bus, BUS_SCANNED);
    return CM1E_OK;
}

cm1e_error_t cm1e_bus_transfer_remote(cm1e_bus_t *bus, const cm1e_bus_slave_t *slave, cm1e_sdo_t *sdo,
                                      cm1e_diag_t *diag)
{
    cm1e_error_t error = CM1E_OK;
    if (!slave->facts.coe)
        sdo->error = CM1E_ERROR_UNSUPPORTED;
    else
        error = bus->remote->transfer(bus->remote_state, sdo, diag);
    if (error != CM1E_OK)
        return error;
    return sdo->error == CM1E_OK ? CM1E_OK : cm1e_bus_diagnose_sdo(bus, slave, sdo, "SDO transfer", diag);
}

cm1e_error_t cm1e_bus_errand_remote(cm1e_bus_t *bus, cm1e_errand_t *errand, cm1e_diag_t *diag)
{
    return bus->remote->errand(bus->remote_state, errand, diag);
}

cm1e_error_t cm1e_bus_refuse_attached(const cm1e_bus_t *bus, const char *function, cm1e_diag_t *diag)
{
    if (!bus->remote)
        return CM1E_OK;
    return cm1e_diag_set(diag, CM1E_ERROR_INTERFACE_IN_USE, 0,
                         "%s needs the network for itself, and another program runs it: end that program first.",
                         function);
}
