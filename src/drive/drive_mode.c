/* The mode of operation (UG 6.2.1): in the process data where 0x6060 and 0x6061 are mapped, else over SDO. */
#include "drive/drive_private.h"

enum { PHASE_IDLE = 0, PHASE_WRITING, PHASE_READING, PHASE_SUBMIT_READ };

static const int64_t mode_timeout_ns = 1000 * MS_IN_NS;
static const int64_t sdo_timeout_ns = 300 * MS_IN_NS;
static const int64_t sdo_retry_ns = 50 * MS_IN_NS;

static const cm1e_mode_t mapping_modes[] = {
    [CM1E_MAPPING_DYNAMIC] = CM1E_MODE_CSP, [CM1E_MAPPING_CSP] = CM1E_MODE_CSP,
    [CM1E_MAPPING_CSV] = CM1E_MODE_CSV, [CM1E_MAPPING_PROFILE] = CM1E_MODE_CSP,
};

cm1e_mode_t cm1e_drive_mapping_mode(cm1e_mapping_t mapping) { return mapping_modes[mapping]; }

cm1e_error_t cm1e_drive_mode_init(cm1e_drive_t *drive, cm1e_diag_t *diag)
{
    drive->mode = cm1e_drive_mapping_mode(drive->config->mapping);
    drive->command.mode = drive->mode;
    if (drive->out_mode.bytes)
        return CM1E_OK;
    const int8_t mode = (int8_t)drive->mode;
    cm1e_error_t error = cm1e_sdo_write(drive->bus, drive->position, OBJ_6060_MODES_OF_OPERATION, 0, &mode, 1, diag);
    if (error)
        return error;
    int8_t shown = 0;
    size_t size = sizeof shown;
    error = cm1e_sdo_read(drive->bus, drive->position, OBJ_6061_MODES_OF_OPERATION_DISPLAY, 0, &shown, &size, diag);
    if (error)
        return error;
    if (size != sizeof shown)
        return cm1e_diag_set(diag, CM1E_ERROR_BUS_MAILBOX, 0,
                             "Axis \"%s\" (slave %u): object 0x6061 was read with %zu bytes instead of 1.",
                             drive->config->name, drive->position, size);
    /* A device that needs its time shows the mode later: the cycle asks again (cm1e_drive_mode_step). */
    drive->mode_shown = shown == mode ? shown : CM1E_MODE_NONE;
    return CM1E_OK;
}

static void submit(cm1e_drive_t *drive, bool write)
{
    drive->mode_data = (int8_t)drive->mode;
    drive->mode_sdo = (cm1e_sdo_t){
        .position = drive->position, .write = write, .data = &drive->mode_data, .size = 1,
        .index = write ? OBJ_6060_MODES_OF_OPERATION : OBJ_6061_MODES_OF_OPERATION_DISPLAY,
        .timeout_ns = sdo_timeout_ns,
    };
    drive->mode_shown = CM1E_MODE_NONE; /* uncertain from now on */
    if (cm1e_sdo_submit(drive->bus, &drive->mode_sdo) == CM1E_OK)
        drive->mode_phase = write ? PHASE_WRITING : PHASE_READING;
    else
        drive->mode_retry_ns = drive->now_ns + sdo_retry_ns;
}

static void read_done(cm1e_drive_t *drive)
{
    const bool good = drive->mode_sdo.size == 1;
    drive->mode_shown = good ? drive->mode_data : (int8_t)CM1E_MODE_NONE;
    drive->mode_phase = PHASE_IDLE;
    if (drive->mode_shown != (int8_t)drive->mode)
        drive->mode_retry_ns = drive->now_ns + sdo_retry_ns;
}

void cm1e_drive_mode_step(cm1e_drive_t *drive)
{
    if (drive->out_mode.bytes)
        return;
    if (drive->mode_phase == PHASE_SUBMIT_READ) {
        submit(drive, false);
    } else if (drive->mode_phase == PHASE_IDLE) {
        if (drive->mode_shown != (int8_t)drive->mode && drive->now_ns >= drive->mode_retry_ns)
            submit(drive, true);
    } else {
        switch (cm1e_sdo_state(&drive->mode_sdo)) {
        case CM1E_SDO_DONE:
            if (drive->mode_phase == PHASE_READING)
                read_done(drive);
            else
                drive->mode_phase = PHASE_SUBMIT_READ;
            break;
        case CM1E_SDO_ERROR:
            drive->mode_phase = PHASE_IDLE;
            drive->mode_retry_ns = drive->now_ns + sdo_retry_ns;
            break;
        default:
            break;
        }
    }
}

void cm1e_drive_mode_forget(cm1e_drive_t *drive)
{
    if (drive->mode_phase == PHASE_IDLE)
        drive->mode_shown = CM1E_MODE_NONE;
    drive->mode_retry_ns = drive->now_ns;
}

/* One switch at a time: until the display shows the last one, nobody knows which mode the next process data meet. */
void cm1e_drive_mode_choose(cm1e_drive_t *drive)
{
    const cm1e_mode_t wanted = drive->command.mode;
    if (wanted == drive->mode || wanted == CM1E_MODE_NONE || !cm1e_mode_find((int8_t)wanted))
        return;
    if (drive->was_enabled && drive->feedback.mode != (int8_t)drive->mode)
        return;
    drive->mode = wanted;
    drive->mode_confirmed = false;
    drive->mode_deadline_ns = drive->now_ns + mode_timeout_ns;
}
