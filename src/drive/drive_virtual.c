/* Drives without a device. The drive of a virtual axis is enabled on command, and its actual position is its target.
 * The drive of an encoder axis shows the counts that the program has written, and is never enabled. */
#include "drive/drive_kind.h"
#include "drive/drive_private.h"

/* UG 6.1.3. Nobody has to wait for motor power. */
enum {
    STATUSWORD_NEVER = STATUSWORD_REMOTE | STATUSWORD_SWITCH_ON_DISABLED,
    STATUSWORD_OFF = STATUSWORD_REMOTE | STATUSWORD_QUICK_STOP | STATUSWORD_VOLTAGE_ENABLED |
                     STATUSWORD_READY_TO_SWITCH_ON,
    STATUSWORD_ON = STATUSWORD_OFF | STATUSWORD_SWITCHED_ON | STATUSWORD_OPERATION_ENABLED | STATUSWORD_BIT12,
};

static const cm1e_device_words_t words = {.states = cm1e_fsa_table};
static const cm1e_device_mode_t modes[] = {
    {.mode = CM1E_MODE_CSP, .abbreviation = "CSP", .words = &words, .target = CM1E_NO_ROLE, .torque = true,
     .holds_position = true, .ways = CM1E_DEVICE_WAYS_ALL},
};
static const cm1e_device_homing_t no_homing = {.place = ""};
static const cm1e_device_drive_t no_device = {
    .name = "virtual axis", .short_name = "virtual axis", .place = "", .modes = modes, .mode_count = 1,
    .homing = &no_homing, .error = cm1e_device_error,
};

cm1e_error_t cm1e_drive_init_virtual(cm1e_drive_t *drive)
{
    drive->kind = &no_device;
    drive->mode.commanded = drive->command.mode = CM1E_MODE_CSP;
    drive->mode.wanted = drive->mode.shown = cm1e_device_mode(drive->kind, CM1E_MODE_CSP);
    drive->mode.words = drive->mode.wanted->words;
    drive->range.position_least = INT32_MIN;
    drive->range.position_most = INT32_MAX;
    drive->range.velocity_unit = 1;
    drive->feedback = drive->config->type == CM1E_AXIS_ENCODER
                          ? (cm1e_drive_feedback_t){.state = SWITCH_ON_DISABLED, .statusword = STATUSWORD_NEVER}
                          : (cm1e_drive_feedback_t){.state = READY_TO_SWITCH_ON, .statusword = STATUSWORD_OFF,
                                                    .mode = CM1E_MODE_CSP, .voltage = true};
    return CM1E_OK;
}

/* The velocity is the difference of two positions, as for a motor whose mapping lacks 0x606C. */
static void read_encoder(cm1e_drive_t *drive)
{
    cm1e_drive_feedback_t *f = &drive->feedback;
    const int64_t elapsed_ns = drive->now_ns - drive->actual.read_ns;
    const int32_t way = (int32_t)(drive->encoder.counts - (uint32_t)f->position);
    f->online = f->fresh = drive->encoder.valid;
    drive->encoder.valid = false; /* it has to be written in every cycle, otherwise it is offline */
    if (!f->fresh)
        return;
    if (drive->actual.seen && elapsed_ns > 0) {
        const int64_t velocity = (int64_t)way * INT64_C(1000000000) / elapsed_ns;
        f->velocity = (int32_t)(velocity > INT32_MAX ? INT32_MAX : velocity < INT32_MIN ? INT32_MIN : velocity);
    }
    f->position = (int32_t)drive->encoder.counts;
    drive->actual.read_ns = drive->now_ns;
    drive->actual.seen = true;
}

void cm1e_drive_virtual_read(cm1e_drive_t *drive)
{
    cm1e_drive_feedback_t *f = &drive->feedback;
    if (drive->config->type == CM1E_AXIS_ENCODER) {
        read_encoder(drive);
        return;
    }
    f->online = f->fresh = drive->actual.seen = true;
    f->enabled = drive->mode.operates = drive->torque.asked;
    f->state = drive->torque.asked ? OPERATION_ENABLED : READY_TO_SWITCH_ON;
    f->statusword = drive->torque.asked ? STATUSWORD_ON : STATUSWORD_OFF;
    f->position = drive->target.position;
    f->velocity = drive->torque.asked ? drive->command.target_velocity : 0;
    drive->actual.read_ns = drive->now_ns;
}

void cm1e_drive_virtual_write(cm1e_drive_t *drive)
{
    const cm1e_drive_command_t *command = &drive->command;
    if (cm1e_drive_reset_asked(drive))
        drive->fault = (cm1e_drive_fault_t){0};
    drive->torque.asked = command->enable && drive->config->type == CM1E_AXIS_VIRTUAL;
    if (drive->torque.asked && drive->feedback.enabled)
        drive->target.position = command->target_position;
    drive->feedback.enabled = drive->feedback.enabled && drive->torque.asked;
}
