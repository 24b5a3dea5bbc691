/* Drives without a device. The drive of a virtual axis is enabled on command, and its actual position is its target.
 * The drive of an encoder axis shows the counts of a signal of a slave, or those that the program has written, and is
 * never enabled. */
#include <math.h>

#include "drive/drive_kind.h"
#include "drive/drive_private.h"
#include "drive/drive_wiring.h"

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
static void take_way(cm1e_drive_t *drive, int64_t way, bool is_motion)
{
    cm1e_drive_feedback_t *f = &drive->feedback;
    const int64_t elapsed_ns = drive->now_ns - drive->actual.read_ns;
    if (is_motion && elapsed_ns > 0) {
        const int64_t velocity = way * INT64_C(1000000000) / elapsed_ns;
        f->velocity = (int32_t)(velocity > INT32_MAX ? INT32_MAX : velocity < INT32_MIN ? INT32_MIN : velocity);
    }
    f->position = (int32_t)((uint32_t)f->position + (uint32_t)way);
    drive->actual.read_ns = drive->now_ns;
    drive->actual.seen = true;
}

static void read_encoder(cm1e_drive_t *drive)
{
    cm1e_drive_feedback_t *f = &drive->feedback;
    f->online = f->fresh = drive->encoder.valid;
    drive->encoder.valid = false; /* it has to be written in every cycle, otherwise it is offline */
    if (f->fresh)
        take_way(drive, (int32_t)(drive->encoder.counts - (uint32_t)f->position), drive->actual.seen);
}

/* The way from one value of a counter to another one, around its end if that is shorter. */
static int64_t counted(int64_t from, int64_t to, unsigned bits)
{
    const unsigned unused = 64 - bits;
    return (int64_t)(((uint64_t)to - (uint64_t)from) << unused) >> unused;
}

/* Whether an encoder can have turned so far since its last value, whose age in the frame may have been a cycle less. */
static bool can_have_turned(const cm1e_drive_t *drive, int64_t way)
{
    const double quantum = 2.0, possible = cm1e_unit_peak_velocity(drive->config);
    const int64_t elapsed_ns = drive->now_ns - drive->actual.read_ns;
    const int64_t cycle_ns = cm1e_bus_configuration(drive->bus)->cycle_time_ns;
    return fabs((double)way) <= possible * (double)(elapsed_ns + cycle_ns) * 1e-9 + quantum;
}

/* A jump of the counts is no position, as long as others may follow this axis. After lost_cycles_limit they have
 * stopped; then the counter goes on from where it is, as it does when its slave has come back. */
static void read_counter(cm1e_drive_t *drive)
{
    cm1e_drive_feedback_t *f = &drive->feedback;
    cm1e_drive_wiring_t *wiring = drive->wiring;
    const cm1e_io_t *io = &wiring->encoder;
    const uint32_t limit = cm1e_bus_configuration(drive->bus)->lost_cycles_limit;
    const cm1e_io_quality_t quality = cm1e_io_quality(io);
    const int64_t value = cm1e_io_integer(io), way = counted(wiring->counted, value, io->bits);
    const bool anew = !drive->actual.seen || wiring->missed > (limit ? limit : 3) + 1;
    f->online = quality == CM1E_IO_GOOD || quality == CM1E_IO_STALE;
    f->fresh = quality == CM1E_IO_GOOD && (anew || can_have_turned(drive, way));
    wiring->missed = f->fresh ? 0 : wiring->missed + (wiring->missed < UINT32_MAX);
    if (!f->fresh)
        return;
    take_way(drive, way, !anew);
    if (anew)
        f->velocity = 0;
    wiring->counted = value;
}

void cm1e_drive_virtual_read(cm1e_drive_t *drive)
{
    cm1e_drive_feedback_t *f = &drive->feedback;
    if (drive->config->type == CM1E_AXIS_ENCODER) {
        if (drive->wiring && drive->wiring->has_encoder)
            read_counter(drive);
        else
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
