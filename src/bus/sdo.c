#include "bus/bus_internal.h"
#include "bus/kept.h"
#include "core/in_task.h"

/* Transfers that block until the slave has answered. */

#define INSTEAD "In a task: cm1e_sdo_submit(), then cm1e_sdo_state() in the cycles that follow."

static cm1e_error_t transfer(cm1e_bus_t *bus, cm1e_sdo_t *sdo, cm1e_diag_t *diag)
{
    if (!bus)
        return cm1e_bus_missing(sdo->write ? "cm1e_sdo_write()" : "cm1e_sdo_read()", diag);
    const cm1e_error_t driven =
        cm1e_bus_refuse_driven(bus, sdo->write ? "cm1e_sdo_write()" : "cm1e_sdo_read()",
                               "From another thread: cm1e_sdo_submit(), then cm1e_sdo_state() until it has ended.",
                               diag);
    if (driven != CM1E_OK)
        return driven;
    if (bus->phase < BUS_SCANNED)
        return cm1e_diag_set(diag, CM1E_ERROR_STATE, 0, "Scan the bus before SDO transfers.");
    cm1e_bus_enter(bus);
    const cm1e_bus_slave_t *slave = cm1e_bus_at(bus, sdo->position);
    if (!slave)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "There is no slave %u; %u were found.",
                             sdo->position, bus->slave_count);
    if (bus->remote)
        return cm1e_bus_transfer_remote(bus, slave, sdo, diag);
    const cm1e_error_t error = cm1e_sdo_submit(bus, sdo);
    if (error == CM1E_ERROR_FULL)
        return cm1e_diag_set(diag, error, 0, "Too many SDO transfers wait.");
    if (error != CM1E_OK)
        return cm1e_bus_diagnose_sdo(bus, slave, sdo, "SDO transfer", diag);
    /* The transfer is on the caller's stack, so it must end before this function returns; the client ensures that. */
    while (cm1e_sdo_state(sdo) == CM1E_SDO_BUSY)
        cm1e_bus_pump(bus);
    if (cm1e_sdo_state(sdo) == CM1E_SDO_ERROR)
        return cm1e_bus_diagnose_sdo(bus, slave, sdo, "SDO transfer", diag);
    return CM1E_OK;
}

cm1e_error_t cm1e_sdo_read(cm1e_bus_t *bus, uint16_t position, uint16_t index, uint8_t subindex, void *data,
                           size_t *size, cm1e_diag_t *diag)
{
    if (cm1e_in_task())
        return cm1e_in_task_refuse("cm1e_sdo_read()", INSTEAD, diag);
    if (!size || (!data && *size > 0))
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "cm1e_sdo_read() needs a buffer and its size.");
    cm1e_sdo_t sdo = {.position = position, .index = index, .subindex = subindex, .data = data, .size = *size};
    const cm1e_error_t error = transfer(bus, &sdo, diag);
    if (error == CM1E_OK)
        *size = sdo.size;
    return error;
}

cm1e_error_t cm1e_sdo_write(cm1e_bus_t *bus, uint16_t position, uint16_t index, uint8_t subindex, const void *data,
                            size_t size, cm1e_diag_t *diag)
{
    if (cm1e_in_task())
        return cm1e_in_task_refuse("cm1e_sdo_write()", INSTEAD, diag);
    if (!data && size > 0)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "cm1e_sdo_write() needs the bytes to write.");
    union { /* a write transfer only reads the data */
        const void *in;
        void *out;
    } bytes = {.in = data};
    cm1e_sdo_t sdo = {.position = position, .index = index, .subindex = subindex, .write = true, .data = bytes.out,
                      .size = size};
    return transfer(bus, &sdo, diag);
}
