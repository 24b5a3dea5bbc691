#include "bus/firmware_update.h"

#include "bus/bootstrap.h"
#include "bus/bus_internal.h"
#include "bus/foe_client.h"
#include "core/in_task.h"

uint8_t cm1e_firmware_all_states(cm1e_bus_t *bus)
{
    uint8_t status[2] = {0};
    cm1e_bus_enter(bus);
    const int answered = cm1e_soem_transfer(bus->soem, COMMAND_BRD, 0, REG_AL_STATUS, status, sizeof status);
    return answered > 0 ? status[0] & AL_STATE_MASK : 0;
}

cm1e_error_t cm1e_firmware_update(cm1e_bus_t *bus, uint16_t position, const cm1e_firmware_file_t *file,
                                  cm1e_firmware_state_t *state, cm1e_diag_t *diag)
{
    cm1e_bootstrap_t bootstrap = {.bus = bus, .position = position, .diag = diag};
    cm1e_foe_t foe = {.bus = bus, .position = position, .mailbox = &bootstrap.mailbox, .options = file->options,
                      .diag = diag};
    *state = CM1E_FIRMWARE_UNTOUCHED;
    if (cm1e_in_task())
        return cm1e_in_task_refuse("cm1e_firmware_update()", "", diag);
    if (bus->phase < BUS_OPEN || bus->phase >= BUS_CONFIGURED || bus->remote)
        return cm1e_diag_set(diag, CM1E_ERROR_STATE, 0,
                             "An update of the firmware needs a bus of its own, before its start.");
    cm1e_bus_enter(bus);
    cm1e_error_t error = cm1e_bootstrap_enter(&bootstrap);
    if (error == CM1E_OK) {
        error = cm1e_foe_send(&foe, file->name, file->bytes, file->size);
        *state = foe.partly ? CM1E_FIRMWARE_PARTLY : CM1E_FIRMWARE_UNTOUCHED;
    }
    if (error == CM1E_OK) {
        *state = CM1E_FIRMWARE_WRITTEN;
        error = cm1e_bootstrap_leave(&bootstrap);
    }
    cm1e_bus_set_phase(bus, BUS_OPEN); /* the states of the other slaves are no longer known */
    return error;
}
