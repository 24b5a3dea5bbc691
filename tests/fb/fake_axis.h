/**
 * @file fake_axis.h
 * Axes without anything behind them, for the tests of the function blocks' own logic: the test says what becomes of
 * each command. Include it once in a test program; it defines the functions of axis/axis_api.h that blocks call.
 */
#ifndef CM1E_TESTS_FAKE_AXIS_H
#define CM1E_TESTS_FAKE_AXIS_H

#include <string.h>

#include "axis/axis_api.h"
#include "axis/axis_guest.h"
#include "coupling/coupling.h"

enum { FAKE_AXES = 2, FAKE_COMMANDS = 8 };

struct cm1e_axis {
    cm1e_axis_info_t info;
    cm1e_error_t start_error;       /**< answer to the next cm1e_axis_start() and cm1e_axis_reset() */
    unsigned starts, resets, updates;
    cm1e_command_id_t updated;      /**< whose inputs */
    cm1e_error_t update_error;      /**< answer to cm1e_axis_update() */
    cm1e_axis_command_t command;    /**< the last one */
    cm1e_axis_coupling_t coupling;  /**< the coupling of that command */
    cm1e_command_id_t id;           /**< of the last one */
    cm1e_command_status_t status[FAKE_COMMANDS]; /**< by id % FAKE_COMMANDS */
    cm1e_command_state_t reset_state;
    cm1e_error_t reset_error;
    bool hold;
    cm1e_command_id_t hold_id;
    const void *owner;
    uint64_t settled;
    bool enable, positive, negative, powered;
    cm1e_error_t power_error;
    unsigned power_calls;
    double override[3];
    MC_CAM_REF cam;                 /**< the last one selected */
    bool cam_flags[3];              /**< periodic, master absolute, slave absolute */
    MC_CAM_ID cams;
};

static cm1e_axis_t fake_axes[FAKE_AXES];

static void fake_reset(void)
{
    memset(fake_axes, 0, sizeof fake_axes);
    for (int i = 0; i < FAKE_AXES; i++)
        fake_axes[i].info.online = true;
}

cm1e_axis_t *cm1e_axis_from_reference(const AXIS_REF_t *reference)
{
    return reference->Handle >= 1 && reference->Handle <= FAKE_AXES ? &fake_axes[reference->Handle - 1] : NULL;
}

/** The block's own memory of the coupling is gone after its call. */
static void fake_keep(cm1e_axis_t *axis, const cm1e_axis_command_t *command)
{
    axis->command = *command;
    if (command->coupling)
        axis->coupling = *command->coupling;
    axis->command.coupling = NULL;
}

cm1e_error_t cm1e_axis_refuse_input(cm1e_axis_t *axis, cm1e_error_t error, const char *input, double value,
                                    const char *right)
{
    (void)axis;
    (void)input;
    (void)value;
    (void)right;
    return error;
}
cm1e_error_t cm1e_axis_refuse_level(cm1e_axis_t *axis, cm1e_error_t error, const char *input, int value, const char *right,
                                    bool begins)
{
    (void)begins;
    return cm1e_axis_refuse_input(axis, error, input, value, right);
}

void cm1e_axis_reads_right(cm1e_axis_t *axis)
{
    (void)axis;
}
cm1e_error_t cm1e_axis_refuse(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_error_t error)
{
    (void)axis;
    (void)command;
    return error;
}
cm1e_error_t cm1e_axis_start(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id)
{
    static cm1e_command_id_t next_id;
    axis->starts++;
    *id = 0;
    if (axis->start_error != CM1E_OK)
        return axis->start_error;
    if (axis->id && axis->status[axis->id % FAKE_COMMANDS].state == CM1E_COMMAND_ACTIVE)
        axis->status[axis->id % FAKE_COMMANDS].state = CM1E_COMMAND_ABORTED;
    fake_keep(axis, command);
    axis->id = *id = ++next_id;
    axis->status[axis->id % FAKE_COMMANDS] = (cm1e_command_status_t){.state = CM1E_COMMAND_ACTIVE};
    return CM1E_OK;
}

cm1e_error_t cm1e_axis_set_override(cm1e_axis_t *axis, double velocity, double acceleration, double jerk)
{
    if (!(acceleration > 0.0))
        return CM1E_ERROR_AXIS_OVERRIDE;
    axis->override[0] = velocity;
    axis->override[1] = acceleration;
    axis->override[2] = jerk;
    return CM1E_OK;
}

void cm1e_axis_refuse_override(cm1e_axis_t *axis, cm1e_error_t error, double velocity, double acceleration, double jerk,
                               bool begins)
{
    (void)axis;
    (void)error;
    (void)velocity;
    (void)acceleration;
    (void)jerk;
    (void)begins;
}

void cm1e_axis_feed(AXIS_REF_t reference, cm1e_command_id_t id, double position)
{
    (void)reference;
    (void)id;
    (void)position;
}

cm1e_error_t cm1e_axis_update(cm1e_axis_t *axis, cm1e_command_id_t id, const cm1e_axis_command_t *command)
{
    axis->updates++;
    axis->updated = id;
    if (axis->update_error == CM1E_OK)
        fake_keep(axis, command);
    return axis->update_error;
}

cm1e_command_status_t cm1e_axis_command_status(const cm1e_axis_t *axis, cm1e_command_id_t id)
{
    return id ? axis->status[id % FAKE_COMMANDS] : (cm1e_command_status_t){.state = CM1E_COMMAND_UNKNOWN};
}

cm1e_error_t cm1e_axis_cam_select(cm1e_axis_t *slave, const MC_CAM_REF *cam, bool periodic, bool master_absolute,
                                  bool slave_absolute, MC_CAM_ID *id)
{
    slave->starts++;
    *id = 0;
    if (slave->start_error != CM1E_OK)
        return slave->start_error;
    slave->cam = *cam;
    slave->cam_flags[0] = periodic;
    slave->cam_flags[1] = master_absolute;
    slave->cam_flags[2] = slave_absolute;
    *id = ++slave->cams;
    return CM1E_OK;
}

bool cm1e_axis_hold_stop(cm1e_axis_t *axis, cm1e_command_id_t id, bool hold)
{
    cm1e_axis_info_t info;
    axis->hold = hold;
    axis->hold_id = id;
    cm1e_axis_get(axis, &info);
    return hold && info.state == CM1E_AXIS_STOPPING;
}

cm1e_error_t cm1e_axis_power(cm1e_axis_t *axis, const void *owner, bool enable, bool enable_positive,
                             bool enable_negative)
{
    axis->power_calls++;
    if (axis->owner && axis->owner != owner)
        return CM1E_ERROR_FB_SECOND_POWER;
    axis->owner = enable ? owner : NULL;
    axis->enable = enable;
    axis->positive = enable_positive;
    axis->negative = enable_negative;
    return axis->power_error;
}

void cm1e_axis_claim_power(AXIS_REF_t reference) { (void)reference; }

bool cm1e_axis_powered(const cm1e_axis_t *axis) { return axis->powered; }

void cm1e_axis_power_settle(cm1e_axis_t *axis, const void *owner, uint64_t shown)
{
    axis->settled = axis->power_error == CM1E_OK && axis->owner == owner && axis->enable && axis->powered ? shown : 0;
}

bool cm1e_axis_power_settled(AXIS_REF_t reference, const void *owner, uint64_t shown)
{
    const cm1e_axis_t *axis = cm1e_axis_from_reference(&reference);
    return axis && axis->power_error == CM1E_OK && axis->owner == owner && axis->settled == shown && axis->powered;
}

bool cm1e_axis_runs(AXIS_REF_t reference, cm1e_command_id_t id)
{
    const cm1e_axis_t *axis = cm1e_axis_from_reference(&reference);
    return axis && axis->status[id % FAKE_COMMANDS].state == CM1E_COMMAND_ACTIVE;
}

cm1e_following_t cm1e_axis_follows_by(AXIS_REF_t reference, cm1e_command_id_t id)
{
    if (!cm1e_axis_runs(reference, id))
        return (cm1e_following_t){.follows = false};
    const cm1e_command_status_t status = cm1e_axis_command_status(cm1e_axis_from_reference(&reference), id);
    return (cm1e_following_t){true, status.reached, status.synchronizing, status.ends};
}

cm1e_error_t cm1e_axis_reset(cm1e_axis_t *axis)
{
    axis->resets++;
    axis->starts++;
    if (axis->start_error != CM1E_OK)
        return axis->start_error;
    axis->reset_state = CM1E_COMMAND_ACTIVE;
    return CM1E_OK;
}

cm1e_command_state_t cm1e_axis_reset_state(const cm1e_axis_t *axis, cm1e_error_t *error)
{
    *error = axis->reset_error;
    return axis->reset_state;
}

void cm1e_axis_get(const cm1e_axis_t *axis, cm1e_axis_info_t *info) { *info = axis->info; }

#endif
