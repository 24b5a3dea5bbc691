#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bus/bus_internal.h"
#include "bus/kept.h"
#include "config/copy.h"
#include "config/interface.h"
#include "core/in_task.h"
#include "device/place.h"

enum { DEFAULT_CYCLE_NS = 1000000, DEFAULT_LOST_CYCLES = 3 };

static cm1e_error_t copy_config(cm1e_bus_config_t *to, const cm1e_bus_config_t *from)
{
    const cm1e_error_t error = cm1e_config_copy(to, from);
    if (error != CM1E_OK)
        return error;
    if (!to->interface_name[0])
        strcpy(to->interface_name, CM1E_SIM_INTERFACE);
    if (to->cycle_time_ns == 0)
        to->cycle_time_ns = DEFAULT_CYCLE_NS;
    if (to->frame_timeout_ns == 0)
        to->frame_timeout_ns = to->cycle_time_ns / 4;
    if (to->lost_cycles_limit == 0)
        to->lost_cycles_limit = DEFAULT_LOST_CYCLES;
    for (uint32_t i = 0; i < to->axis_count; i++) {
        cm1e_axis_config_t *axis = &to->axes[i];
        if (!axis->name[0])
            snprintf(axis->name, sizeof axis->name, "axis%u", i + 1);
        axis->address = cm1e_axis_address(to, i);
    }
    for (uint32_t i = 0; i < to->slave_count; i++)
        if (!to->slaves[i].name[0])
            snprintf(to->slaves[i].name, sizeof to->slaves[i].name, "slave%u", i + 1);
    return CM1E_OK;
}

cm1e_error_t cm1e_bus_make(cm1e_bus_t **bus, const cm1e_bus_config_t *config, cm1e_diag_t *diag)
{
    cm1e_bus_t *made = calloc(1, sizeof *made);
    if (made && copy_config(&made->config, config) == CM1E_OK) {
        *bus = made;
        return CM1E_OK;
    }
    free(made);
    return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "Out of memory when opening the bus.");
}

static cm1e_error_t open_parts(cm1e_bus_t *bus, cm1e_diag_t *diag)
{
    const cm1e_error_t error = cm1e_nic_open(&bus->nic, &bus->config, diag);
    if (error != CM1E_OK)
        return error;
    bus->clock = cm1e_nic_clock(bus->nic);
    bus->soem = cm1e_soem_create(bus->nic, &bus->config);
    if (!bus->soem)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "Out of memory when opening the bus.");
    cm1e_bus_set_phase(bus, BUS_OPEN);
    return CM1E_OK;
}

cm1e_error_t cm1e_bus_open(cm1e_bus_t **bus, const cm1e_bus_config_t *config, cm1e_diag_t *diag)
{
    if (!bus || !config)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0,
                             "cm1e_bus_open() needs a place for the bus and a configuration.");
    *bus = NULL;
    if (cm1e_in_task())
        return cm1e_in_task_refuse("cm1e_bus_open()", "", diag);
    cm1e_error_t error = cm1e_bus_config_check(config, diag);
    if (error != CM1E_OK)
        return error;
    cm1e_bus_t *made;
    error = cm1e_bus_make(&made, config, diag);
    if (error != CM1E_OK)
        return error;
    error = open_parts(made, diag);
    if (error != CM1E_OK) {
        cm1e_bus_close(made);
        return error;
    }
    *bus = made;
    return CM1E_OK;
}

cm1e_error_t cm1e_bus_close(cm1e_bus_t *bus)
{
    if (!bus)
        return CM1E_OK;
    if (cm1e_in_task_note("cm1e_bus_close()") || cm1e_bus_refuse_end(bus, "cm1e_bus_close()"))
        return CM1E_ERROR_STATE;
    cm1e_bus_stop(bus);
    cm1e_soem_destroy(bus->soem);
    const cm1e_error_t error = cm1e_nic_close(bus->nic);
    if (bus->remote)
        bus->remote->close(bus->remote_state);
    cm1e_bus_free_image(bus);
    free(bus->remote_texts);
    free(bus->slaves);
    cm1e_bus_config_free(&bus->config);
    free(bus);
    cm1e_clock_make_current(NULL); /* the clock of the nic is gone */
    return error;
}
