/* Compares what the mapping needs of each slave controller with what the controller has. */
#include "bus/bus_internal.h"
#include "core/bytes.h"

enum { REG_UNITS = 0x0004 /* FMMUs, then sync managers, a byte each (ETG.1000.4 section 6.1) */ };

static unsigned used_sync_managers(const cm1e_slave_placement_t *placement)
{
    unsigned used = 0;
    for (unsigned i = 0; i < 4; i++)
        if (cm1e_get_u16(placement->sync_managers[i] + 2) > 0)
            used = i + 1;
    return used;
}

static cm1e_error_t check_slave(cm1e_bus_t *bus, const cm1e_bus_slave_t *slave, cm1e_diag_t *diag)
{
    char label[CM1E_LABEL_LENGTH];
    uint8_t units[2] = {0};
    const unsigned fmmus = slave->placement.fmmu_count, managers = used_sync_managers(&slave->placement);
    if (!cm1e_bus_read_registers(bus, slave->info.position, REG_UNITS, units, sizeof units))
        return CM1E_OK; /* the next function that needs the slave reports that it is gone */
    /* A controller that states 0 does not tell its number. */
    if ((units[0] == 0 || fmmus <= units[0]) && (units[1] == 0 || managers <= units[1]))
        return CM1E_OK;
    return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0,
                         "The controller of %s has %u FMMUs and %u sync managers; its process data needs %u and %u. "
                         "Assign fewer PDOs to it, or take a device with another controller.",
                         cm1e_bus_label(bus, slave, label), units[0], units[1], fmmus, managers);
}

cm1e_error_t cm1e_bus_check_resources(cm1e_bus_t *bus, cm1e_diag_t *diag)
{
    cm1e_error_t error = CM1E_OK;
    for (uint32_t i = 0; i < bus->scanned && error == CM1E_OK; i++)
        error = check_slave(bus, &bus->slaves[i], diag);
    return error;
}
