/* Faults of a drive: detects them in the inputs, and latches the first one with its details. */
#include "drive/drive_private.h"

void cm1e_drive_fail(cm1e_drive_t *drive, cm1e_error_t error)
{
    cm1e_drive_fault_t *fault = &drive->fault;
    drive->ordinary.calm = false;
    if (fault->error == CM1E_OK)
        *fault = (cm1e_drive_fault_t){
            .error = error,
            .device_code = drive->feedback.fault ? drive->feedback.error_code : 0,
            .statusword = drive->feedback.statusword,
            .mode_commanded = (int8_t)drive->mode.commanded,
            .mode_shown = drive->feedback.mode != CM1E_MODE_NONE ? drive->feedback.mode : drive->change.read,
        };
    /* Adds details that arrive after the first sign: the code of the device, and what the supervision found. */
    if (fault->device_code == 0 && drive->feedback.online && drive->feedback.fault)
        fault->device_code = drive->feedback.error_code;
    if (fault->error == CM1E_ERROR_BUS_WORKING_COUNTER && fault->missing == 0) {
        const uint16_t missing = cm1e_bus_missing_slave(drive->bus);
        fault->missing = missing != drive->position ? missing : 0;
    }
    fault->keeps_torque |= error == CM1E_ERROR_DRIVE_KEEPS_TORQUE;
    fault->slave_lost |= drive->watch.lost;
    fault->slave_absent |= drive->watch.lost || drive->watch.silent;
    /* While the working counter stays wrong, nothing shows that the slave hears again. */
    fault->slave_absent |= fault->error == CM1E_ERROR_BUS_WORKING_COUNTER && error == CM1E_ERROR_BUS_LOST;
    if (!cm1e_drive_operational(drive)) {
        fault->al_state = drive->watch.al_state;
        fault->al_status_code = drive->watch.al_status_code;
    }
}

/* The cause of what this cycle's inputs show, or CM1E_OK. */
static cm1e_error_t cause_in_inputs(const cm1e_drive_t *drive)
{
    const cm1e_drive_feedback_t *f = &drive->feedback;
    if (f->fault) {
        const cm1e_device_error_t *error = drive->kind->error(f->error_code);
        return error && error->motor_power ? CM1E_ERROR_DRIVE_POWER : CM1E_ERROR_DRIVE_FAULT;
    }
    if (!drive->torque.asked)
        return CM1E_OK;
    const bool power_stage = f->state == OPERATION_ENABLED || f->state == SWITCHED_ON;
    if (!f->voltage && (power_stage || drive->torque.was_enabled))
        return CM1E_ERROR_DRIVE_POWER;
    if (drive->torque.was_enabled && !drive->mode.operates)
        return CM1E_ERROR_DRIVE_ENABLE_LOST;
    const bool shown = f->mode == (int8_t)drive->mode.commanded;
    if (drive->torque.was_enabled && !shown && drive->torque.confirmed)
        return CM1E_ERROR_DRIVE_MODE_LOST;
    if (drive->torque.was_enabled && !shown && drive->now_ns >= drive->change.deadline_ns)
        return CM1E_ERROR_DRIVE_MODE_TIMEOUT;
    if (!drive->torque.was_enabled && !drive->mode.operates && drive->now_ns >= drive->waits.enable_deadline_ns)
        return !f->voltage ? CM1E_ERROR_DRIVE_POWER
               : !shown    ? CM1E_ERROR_DRIVE_MODE_TIMEOUT : CM1E_ERROR_DRIVE_ENABLE_TIMEOUT;
    return CM1E_OK;
}

void cm1e_drive_latch_faults(cm1e_drive_t *drive)
{
    cm1e_error_t error = drive->fault.error; /* a latched fault only collects its details */
    if (error == CM1E_OK && drive->torque.asked && drive->watch.lost)
        error = CM1E_ERROR_AXIS_OFFLINE;
    if (error == CM1E_OK && drive->torque.asked && !cm1e_drive_operational(drive))
        error = CM1E_ERROR_BUS_STATE;
    if (error == CM1E_OK && drive->feedback.online)
        error = cause_in_inputs(drive);
    if (error == CM1E_OK && drive->torque.asked && drive->actual.rejected > 0 &&
        drive->actual.rejected >= cm1e_bus_configuration(drive->bus)->lost_cycles_limit)
        error = CM1E_ERROR_DRIVE_POSITION;
    if (error != CM1E_OK)
        cm1e_drive_fail(drive, error);
}
