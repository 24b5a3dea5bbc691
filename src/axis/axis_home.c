/*
 * MC_Home with the drive's own routines (UG 6.2.4): parameters over SDO while the axis holds its position, homing mode,
 * start bit, the table of statusword bits 13, 12 and 10, and back to the axis's own mode with the set-point where the
 * motor stands. The drive calls the end position 0; the axis calls it MC_Home.Position.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "axis/axis_private.h"
#include "core/bytes.h"

static const int64_t start_timeout_ns = 500 * MS_IN_NS;
static const int64_t longest_halt_ns = 10000 * MS_IN_NS;
static const int64_t standing_ns = 50 * MS_IN_NS;
static const int64_t interrupted_ns = 100 * MS_IN_NS;
static const int32_t standing_counts = 10;

typedef struct homing_object {
    uint16_t index;
    uint8_t subindex;
} homing_object_t;

enum { OFFSET = 0, METHOD, SPEED, ACCELERATION, TORQUE, TIMEOUT };
enum { FIRST_METHOD = -6, LAST_METHOD = -1 };
static const double longest_timeout_s = 1e6;
static const homing_object_t homing_objects[HOMING_PARAMETERS] = {
    [OFFSET] = {OBJ_607C_HOME_OFFSET, 0},
    [METHOD] = {OBJ_6098_HOMING_METHOD, 0},
    [SPEED] = {OBJ_6099_HOMING_SPEEDS, 1},
    [ACCELERATION] = {OBJ_609A_HOMING_ACCELERATION, 0},
    [TORQUE] = {OBJ_60F6_K_PARAMETERS, CM1E_K_PARAMETER_HOMING_TORQUE},
};

/* UG 6.2.4, "Bit Sequence", by bit 13 * 4 + bit 12 * 2 + bit 10. 110 is not in the table; with the error bit in it, it
 * is one. */
typedef enum meaning { IN_PROGRESS = 0, INTERRUPTED, ATTAINED, COMPLETED, FAILED } meaning_t;
static const meaning_t meanings[8] = {IN_PROGRESS, INTERRUPTED, ATTAINED, COMPLETED, FAILED, FAILED, FAILED, FAILED};

static uint8_t bits(const cm1e_axis_t *axis)
{
    const cm1e_drive_feedback_t *f = &axis->drive.feedback;
    return (uint8_t)(f->bit13 << 2 | f->bit12 << 1 | f->target_reached);
}

/* Checked against the device's range and rounded as the device rounds, before anything reaches the wire. */
static bool parameter(homing_t *home, int which, double value)
{
    const homing_object_t *object = &homing_objects[which];
    const cm1e_entry_t *entry = cm1e_device_entry(object->index, object->subindex);
    if (!entry || !isfinite(value) || fabs(value) > INT32_MAX)
        return false;
    const int64_t rounded = cm1e_entry_round(entry, llround(value));
    if (rounded < entry->minimum || rounded > entry->maximum)
        return false;
    home->raw[which] = (int32_t)rounded;
    return true;
}

static cm1e_error_t wrong(homing_t *home, int which, double value)
{
    home->wrong = (uint8_t)which;
    home->wrong_value = value;
    return which == METHOD ? CM1E_ERROR_AXIS_HOMING_METHOD : CM1E_ERROR_AXIS_HOMING_PARAMETER;
}

void cm1e_axis_home_wrong_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    static const char *const names[] = {"offset", "method", "velocity", "acceleration", "torque", "timeout_s"};
    static const char *const units[] = {" u", "", " u/s", " u/s2", " %", " s"};
    const int which = axis->home.wrong;
    double least = FIRST_METHOD, most = LAST_METHOD;
    if (which == TIMEOUT) {
        least = 0.0;
        most = longest_timeout_s;
    } else if (which != METHOD) {
        const cm1e_entry_t *entry = cm1e_device_entry(homing_objects[which].index, homing_objects[which].subindex);
        const double counts = which == TORQUE ? 1.0 : fabs(axis->scale);
        least = (double)entry->minimum / counts;
        most = (double)entry->maximum / counts;
    }
    const bool has_default = which == SPEED || which == ACCELERATION || which == TORQUE || which == TIMEOUT;
    snprintf(text, size, "Axis \"%s\": homing was not started: homing.%s is %.6g%s; %.6g ... %.6g%s is right%s.",
             axis->config->name, names[which], axis->home.wrong_value, units[which], least, most, units[which],
             has_default ? ", or 0 for the default" : "");
}

cm1e_error_t cm1e_axis_home_prepare(cm1e_axis_t *axis, const cm1e_axis_command_t *command)
{
    const cm1e_homing_config_t *c = command->homing ? command->homing : &axis->config->homing;
    homing_t *home = &axis->home;
    position_t position;
    if (!cm1e_axis_position_from_units(axis, command->position, &position))
        return CM1E_ERROR_AXIS_POSITION_RANGE;
    if (!(axis->enable_positive && axis->enable_negative))
        return CM1E_ERROR_AXIS_DIRECTION_DISABLED; /* every method moves both ways */
    if (c->method > LAST_METHOD || c->method < FIRST_METHOD) /* 0 is "no home routine selected": it would never end */
        return wrong(home, METHOD, c->method);
    if (home->submitted && cm1e_sdo_state(&home->sdo) == CM1E_SDO_BUSY)
        return CM1E_ERROR_BUSY; /* a transfer of a homing that was stopped */
    if (!isfinite(c->timeout_s) || c->timeout_s < 0.0 || c->timeout_s > longest_timeout_s)
        return wrong(home, TIMEOUT, c->timeout_s);
    const double scale = fabs(axis->scale);
    const double values[HOMING_PARAMETERS] = {
        [OFFSET] = c->offset * axis->scale,
        [METHOD] = c->method,
        [SPEED] = c->velocity == 0.0 ? 50000.0 : c->velocity * scale,
        [ACCELERATION] = c->acceleration == 0.0 ? 100000.0 : c->acceleration * scale,
        [TORQUE] = c->torque == 0.0 ? 30.0 : c->torque,
    };
    const double asked[HOMING_PARAMETERS] = {c->offset, c->method, c->velocity, c->acceleration, c->torque};
    for (int i = 0; i < HOMING_PARAMETERS; i++)
        if (!parameter(home, i, values[i]))
            return wrong(home, i, asked[i]);
    home->position = command->position;
    home->timeout_ns = (int64_t)((c->timeout_s == 0.0 ? 60.0 : c->timeout_s) * 1e9);
    return CM1E_OK;
}

static void enter(cm1e_axis_t *axis, home_step_t step)
{
    axis->home.step = step;
    axis->home.step_ns = axis->now_ns;
    axis->home.quiet_ns = axis->now_ns;
    axis->home.quiet_position = axis->raw;
}

void cm1e_axis_home_begin(cm1e_axis_t *axis)
{
    axis->home.next = 0;
    axis->home.submitted = false;
    axis->home.refused = CM1E_OK;
    axis->home.goal = HOME_GOAL_DONE;
    axis->home.deadline_ns = axis->now_ns + axis->home.timeout_ns;
    axis->activity = ACTIVITY_HOMING;
    enter(axis, HOME_WRITE);
}

/* Homing is over in the axis's own mode. */
static void leave(cm1e_axis_t *axis)
{
    axis->activity = ACTIVITY_HOLD;
    if (axis->active)
        cm1e_axis_command_end(axis, CM1E_COMMAND_DONE, CM1E_OK); /* of MC_Home, or of the MC_Stop that ended it */
    if (axis->state == CM1E_AXIS_HOMING)
        axis->state = CM1E_AXIS_STANDSTILL;
}

/* ---- the steps --------------------------------------------------------------------------------------------------- */

static void refuse(cm1e_axis_t *axis, cm1e_error_t error)
{
    axis->home.refused = error;
    cm1e_axis_command_end(axis, CM1E_COMMAND_ERROR, error);
    leave(axis); /* nothing has moved: no reason for ErrorStop */
}

static void submit(cm1e_axis_t *axis)
{
    homing_t *home = &axis->home;
    const homing_object_t *object = &homing_objects[home->next];
    const cm1e_entry_t *entry = cm1e_device_entry(object->index, object->subindex);
    const unsigned bytes = entry->bits / 8u;
    cm1e_put_uint(home->data, bytes, (uint32_t)home->raw[home->next]);
    home->sdo = (cm1e_sdo_t){.position = axis->drive.position, .index = object->index, .subindex = object->subindex,
                             .write = true, .data = home->data, .size = bytes};
    const cm1e_error_t error = cm1e_sdo_submit(axis->drive.bus, &home->sdo);
    if (error == CM1E_OK)
        home->submitted = true;
    else if (error != CM1E_ERROR_FULL) /* full: again in the next cycle */
        refuse(axis, error);
}

static void step_write(cm1e_axis_t *axis)
{
    homing_t *home = &axis->home;
    if (axis->now_ns >= home->deadline_ns) {
        refuse(axis, CM1E_ERROR_TIMEOUT); /* a transfer under way ends by itself */
        return;
    }
    if (!home->submitted) {
        submit(axis);
        return;
    }
    const cm1e_sdo_state_t state = cm1e_sdo_state(&home->sdo);
    if (state == CM1E_SDO_ERROR) {
        home->submitted = false;
        refuse(axis, home->sdo.error);
    } else if (state == CM1E_SDO_DONE) {
        home->submitted = false;
        if (++home->next < HOMING_PARAMETERS) {
            submit(axis);
            return;
        }
        axis->drive.command.mode = CM1E_MODE_HM;
        axis->drive.command.homing_start = false;
        axis->drive.command.halt = false;
        enter(axis, HOME_SWITCH);
    }
}

static bool acting_in(const cm1e_axis_t *axis, cm1e_mode_t mode)
{
    return axis->drive.feedback.enabled && axis->drive.feedback.mode == (int8_t)mode;
}

/* Without torque there is nothing to stop and no mode to wait for. */
static bool off(cm1e_axis_t *axis)
{
    if (axis->home.goal != HOME_GOAL_OFF)
        return false;
    axis->drive.command.homing_start = false;
    axis->drive.command.halt = false;
    axis->drive.command.mode = axis->mode;
    cm1e_axis_become_free(axis);
    return true;
}

static void step_switch(cm1e_axis_t *axis)
{
    cm1e_axis_set_to_actual(axis);
    if (!acting_in(axis, CM1E_MODE_HM)) /* the drive's mode timeout bounds this */
        return;
    if (axis->home.goal != HOME_GOAL_DONE) {
        axis->drive.command.mode = axis->mode;
        enter(axis, HOME_RETURN);
        return;
    }
    axis->homed = false;
    axis->home.bits_before = bits(axis);
    axis->home.deadline_ns = axis->now_ns + axis->home.timeout_ns;
    axis->drive.command.homing_start = true;
    enter(axis, HOME_START);
}

static void complete(cm1e_axis_t *axis)
{
    /* The drive's 0 is the reference, wherever in its last counts the motor stands just now. */
    cm1e_axis_set_origin(axis, cm1e_axis_load(axis, axis->actual_counts - axis->raw), axis->home.position);
    axis->homed = true;
    axis->drive.command.homing_start = false;
    axis->drive.command.mode = axis->mode;
    enter(axis, HOME_RETURN);
}

static void fail(cm1e_axis_t *axis, cm1e_error_t error) { cm1e_axis_fail(axis, error, bits(axis), 0.0); }

static bool timed_out(cm1e_axis_t *axis)
{
    if (axis->now_ns < axis->home.deadline_ns)
        return false;
    fail(axis, CM1E_ERROR_AXIS_HOMING_TIMEOUT);
    return true;
}

/* The bits of the last homing stay until the new one has begun: only a change, or "in progress", is news. */
static void step_start(cm1e_axis_t *axis)
{
    cm1e_axis_set_to_actual(axis);
    if (!axis->drive.feedback.online || timed_out(axis))
        return;
    const uint8_t now = bits(axis);
    const meaning_t meaning = meanings[now];
    if (meaning == IN_PROGRESS || meaning == ATTAINED || (now != axis->home.bits_before && meaning != INTERRUPTED))
        enter(axis, HOME_RUN);
    else if (axis->now_ns - axis->home.step_ns >= start_timeout_ns)
        fail(axis, CM1E_ERROR_AXIS_HOMING_FAILED);
}

static void step_run(cm1e_axis_t *axis)
{
    cm1e_axis_set_to_actual(axis);
    if (!axis->drive.feedback.online)
        return;
    const meaning_t meaning = meanings[bits(axis)];
    if (meaning != INTERRUPTED)
        axis->home.quiet_ns = axis->now_ns;
    if (meaning == COMPLETED)
        complete(axis);
    else if (meaning == FAILED || axis->now_ns - axis->home.quiet_ns >= interrupted_ns)
        fail(axis, CM1E_ERROR_AXIS_HOMING_FAILED);
    else
        timed_out(axis);
}

/* How long the halt may take: the speed over the deceleration (UG 6.2.4: that of 0x609A). Who sees the motor gives it
 * twice that and a second more; who does not, because the bus is gone, waits for it and then takes the torque away. */
static int64_t halt_bound_ns(const cm1e_axis_t *axis)
{
    const int32_t *raw = axis->home.raw;
    const int64_t braking_ns = INT64_C(1000000000) * raw[SPEED] / raw[ACCELERATION];
    const bool blind = axis->drive.fault.error != CM1E_OK;
    const int64_t bound_ns = blind ? braking_ns + standing_ns : 2 * braking_ns + 1000 * MS_IN_NS;
    return bound_ns < longest_halt_ns ? bound_ns : longest_halt_ns;
}

/* Halt first and the mode later: before V1.3.0 a halt together with a switch of the mode did not stop (UG 10.1). */
static void step_halt(cm1e_axis_t *axis)
{
    homing_t *home = &axis->home;
    cm1e_axis_set_to_actual(axis);
    const int32_t moved = (int32_t)((uint32_t)axis->raw - (uint32_t)home->quiet_position);
    if (!axis->drive.feedback.online || abs(moved) > standing_counts) {
        home->quiet_ns = axis->now_ns;
        home->quiet_position = axis->raw;
    }
    const bool expired = axis->now_ns - home->step_ns >= halt_bound_ns(axis);
    if (!expired && axis->now_ns - home->quiet_ns < standing_ns)
        return;
    if (off(axis))
        return;
    if (expired) {
        fail(axis, CM1E_ERROR_AXIS_HOMING_FAILED);
        return;
    }
    axis->drive.command.homing_start = false; /* the halt stays until the mode is left: its end would start again */
    axis->drive.command.mode = axis->mode;
    enter(axis, HOME_RETURN);
}

static void step_return(cm1e_axis_t *axis)
{
    cm1e_axis_set_to_actual(axis);
    if (!acting_in(axis, axis->mode))
        return;
    axis->drive.command.halt = false;
    leave(axis);
}

void cm1e_axis_home_step(cm1e_axis_t *axis)
{
    static void (*const steps[])(cm1e_axis_t *) = {
        [HOME_WRITE] = step_write, [HOME_SWITCH] = step_switch, [HOME_START] = step_start,
        [HOME_RUN] = step_run, [HOME_HALT] = step_halt, [HOME_RETURN] = step_return,
    };
    if (!axis->drive.feedback.enabled && axis->home.goal == HOME_GOAL_OFF && axis->drive.fault.error) {
        (void)off(axis);
        return;
    }
    steps[axis->home.step](axis);
}

void cm1e_axis_home_abort(cm1e_axis_t *axis, home_goal_t goal)
{
    homing_t *home = &axis->home;
    home->goal = goal;
    switch (home->step) {
    case HOME_WRITE: /* still in the axis's own mode, holding; a transfer under way may end by itself */
        if (!off(axis))
            leave(axis);
        break;
    case HOME_SWITCH:
    case HOME_RETURN: /* standing; HOLD has to wait for the mode that is under way */
        (void)off(axis);
        break;
    case HOME_START:
    case HOME_RUN:
        axis->drive.command.halt = true;
        enter(axis, HOME_HALT);
        break;
    case HOME_HALT:
        break;
    }
}
