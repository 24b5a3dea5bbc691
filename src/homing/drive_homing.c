/*
 * MC_Home with the drive's own routines (UG 6.2.4; BR 6.4 and appendix 4 behind a bridge). The steps are: write the
 * parameters over SDO, switch to homing mode, set the start bit, read the result from statusword bits 13, 12 and 10,
 * and switch back to the axis's own mode with the set-point at the position of the motor. The drive calls the end
 * position 0; the axis calls it MC_Home.Position. The differences between the drives, above all the order of the steps,
 * are in the table of the device.
 *
 * A CM1-E stops by its halt bit. The bridge has no halt bit (BR 6.1.2), and its guide does not say what ends an origin
 * search. So the start bit is taken away, which interrupts a homing by CiA 402. If bit 10 still says "during homing",
 * or the motor does not come to rest, its torque is taken away: "motor free" is the only end that the guide names (BR
 * 6.1.1).
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "axis/axis_backlash.h"
#include "axis/axis_commands.h"
#include "axis/axis_driving.h"
#include "axis/axis_events.h"
#include "axis/axis_in_position.h"
#include "axis/axis_position.h"
#include "axis/axis_power.h"
#include "axis/axis_setpoint.h"
#include "core/bytes.h"
#include "core/clock.h"
#include "homing/homing_private.h"

static const int64_t start_timeout_ns = 500 * MS_IN_NS;
static const int64_t rest_timeout_ns = 1000 * MS_IN_NS;
static const int64_t interrupted_ns = 100 * MS_IN_NS;
static const int64_t taken_ns = 100 * MS_IN_NS; /* BR appendix 4.1: "until setting is done" */

enum { OFFSET = CM1E_HOMING_OFFSET, METHOD = CM1E_HOMING_METHOD, SPEED = CM1E_HOMING_SPEED,
       ACCELERATION = CM1E_HOMING_ACCELERATION, TORQUE = CM1E_HOMING_TORQUE, TIMEOUT };
static const double longest_timeout_s = 1e6;

/* What the user may state, as the bus file calls it. */
static const struct {
    const char *name, *unit;
    bool has_default; /* which 0 selects */
} stated[] = {
    [OFFSET] = {"offset", " u", false},
    [METHOD] = {"method", "", false},
    [SPEED] = {"velocity", " u/s", true},
    [ACCELERATION] = {"acceleration", " u/s2", true},
    [TORQUE] = {"torque", " %", true},
    [TIMEOUT] = {"timeout_s", " s", true},
};

/* The table of the device has all differences between the drives. */
static const cm1e_device_homing_t *kind_of(const cm1e_axis_t *axis) { return axis->drive.kind->homing; }

bool cm1e_homing_by_switch(const cm1e_axis_t *axis, int method)
{
    const cm1e_device_homing_t *kind = kind_of(axis);
    return method >= kind->first_by_switch && method <= kind->last_by_switch;
}

static bool k45_is_known(const drive_homing_t *home) { return cm1e_bridge_offset_unit(home->k45) != 0; }

/* The object of a parameter for a method, with its range. */
static cm1e_homing_object_t object_of(const cm1e_axis_t *axis, int which, int method)
{
    const cm1e_device_homing_t *kind = kind_of(axis);
    cm1e_homing_object_t object = kind->objects[which];
    if (which == SPEED && kind->subindex_by_stop && !cm1e_homing_by_switch(axis, method))
        object.subindex = kind->subindex_by_stop;
    if (which == OFFSET && axis->homing->drive.k45 >= 0 && k45_is_known(&axis->homing->drive))
        object.unit = cm1e_bridge_offset_unit(axis->homing->drive.k45);
    return object;
}

static const cm1e_entry_t *range_of(const cm1e_axis_t *axis, cm1e_homing_object_t object)
{
    return object.range ? object.range : cm1e_drive_entry(&axis->drive, object.index, object.subindex);
}

/* UG 6.2.4, "Bit Sequence", and BR 6.4.2, by bit 13 * 4 + bit 12 * 2 + bit 10. 110 is not in their tables; it counts as
 * a failure because it has the error bit. */
typedef enum meaning { IN_PROGRESS = 0, INTERRUPTED, ATTAINED, COMPLETED, FAILED } meaning_t;
static const meaning_t meanings[8] = {IN_PROGRESS, INTERRUPTED, ATTAINED, COMPLETED, FAILED, FAILED, FAILED, FAILED};

static uint8_t bits(const cm1e_axis_t *axis)
{
    const cm1e_drive_feedback_t *f = &axis->drive.feedback;
    return (uint8_t)(f->bit13 << 2 | f->bit12 << 1 | f->target_reached);
}

/* ---- parameters -------------------------------------------------------------------------------------------------- */

/* The default of a parameter is that of the drive, but the default speed is at most one revolution per second. K42
 * counts pulses, and a CM1 with K37 = 0 has 200 pulses per revolution: its default would be 50 revolutions per second,
 * into a hard stop. */
static double default_of(const cm1e_axis_t *axis, int which, const cm1e_homing_object_t *object,
                         const cm1e_entry_t *entry)
{
    const double most = CM1E_COUNTS_PER_REVOLUTION * axis->position.count / object->unit;
    return which == SPEED ? fmin((double)entry->default_value, most) : (double)entry->default_value;
}

/* Checks a parameter against the range of the device and rounds it as the device does, before anything is written. 0
 * selects the default, if the parameter has one. */
static bool parameter(cm1e_axis_t *axis, int which, int method, double value)
{
    const cm1e_homing_object_t object = object_of(axis, which, method);
    if (object.index == 0) /* the drive has no such parameter */
        return value == 0.0;
    const cm1e_entry_t *entry = range_of(axis, object);
    if (!entry || !isfinite(value) || fabs(value / object.unit) > INT32_MAX)
        return false;
    const bool by_default = value == 0.0 && stated[which].has_default;
    const double asked = by_default ? default_of(axis, which, &object, entry) : value / object.unit;
    const int64_t rounded = cm1e_entry_round(entry, llround(asked));
    if (rounded < entry->minimum || rounded > entry->maximum)
        return false;
    axis->homing->drive.raw[which] = (int32_t)rounded;
    return true;
}

static cm1e_error_t wrong(drive_homing_t *home, int which, double value)
{
    home->wrong = (uint8_t)which;
    home->wrong_value = value;
    return which == METHOD ? CM1E_ERROR_AXIS_HOMING_METHOD : CM1E_ERROR_AXIS_HOMING_PARAMETER;
}

void cm1e_homing_wrong_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    const int which = axis->homing->drive.wrong;
    double least = kind_of(axis)->first_method, most = kind_of(axis)->last_method;
    if (which == OFFSET && !k45_is_known(&axis->homing->drive)) {
        snprintf(text, size, "Axis \"%s\": homing was not started: the second digit of the motor's K45 = %d says in "
                 "which unit homing.offset is; 0, 1 or 2 is right (100, 10 or 1 pulses). Set K45, parameter 1045, or "
                 "leave the offset out.", axis->config->name, (int)axis->homing->drive.k45);
        return;
    }
    if (which == TIMEOUT) {
        least = 0.0;
        most = longest_timeout_s;
    } else if (which != METHOD) {
        const cm1e_homing_object_t object = object_of(axis, which, axis->homing->drive.raw[METHOD]);
        const cm1e_entry_t *entry = range_of(axis, object);
        const double counts = which == TORQUE ? 1.0 : fabs(axis->position.scale);
        least = (double)entry->minimum * object.unit / counts;
        most = (double)entry->maximum * object.unit / counts;
    }
    snprintf(text, size, "Axis \"%s\": homing was not started: homing.%s is %.6g%s; %.6g ... %.6g%s is right%s.",
             axis->config->name, stated[which].name, axis->homing->drive.wrong_value, stated[which].unit, least, most,
             stated[which].unit, stated[which].has_default ? ", or 0 for the default" : "");
}

double cm1e_homing_velocity(const cm1e_axis_t *axis)
{
    const drive_homing_t *home = &axis->homing->drive;
    return home->raw[SPEED] * object_of(axis, SPEED, home->raw[METHOD]).unit / fabs(axis->position.scale);
}

static cm1e_error_t take_parameters(cm1e_axis_t *axis, const cm1e_homing_config_t *c)
{
    const double scale = fabs(axis->position.scale);
    const double values[HOMING_PARAMETERS] = {
        [OFFSET] = kind_of(axis)->offset_by_axis ? 0.0 : c->offset * axis->position.scale,
        [METHOD] = c->method,
        [SPEED] = c->velocity * scale,
        [ACCELERATION] = c->acceleration * scale,
        [TORQUE] = c->torque,
    };
    const double asked[HOMING_PARAMETERS] = {c->offset, c->method, c->velocity, c->acceleration, c->torque};
    axis->homing->drive.k45 = -1; /* not read yet: the largest unit is assumed */
    axis->homing->drive.offset = c->offset * axis->position.scale;
    if (!isfinite(c->offset) || fabs(axis->homing->drive.offset) > INT32_MAX)
        return wrong(&axis->homing->drive, OFFSET, c->offset);
    axis->homing->drive.raw[METHOD] = c->method;
    for (int i = 0; i < HOMING_PARAMETERS; i++)
        if (!parameter(axis, i, c->method, values[i]))
            return wrong(&axis->homing->drive, i, asked[i]);
    return CM1E_OK;
}

cm1e_error_t cm1e_homing_prepare(cm1e_axis_t *axis, const cm1e_axis_command_t *command)
{
    const cm1e_homing_config_t *c = command->homing ? command->homing : &axis->config->homing;
    const cm1e_device_homing_t *kind = kind_of(axis);
    drive_homing_t *home = &axis->homing->drive;
    position_t position;
    if (cm1e_drive_is_virtual(&axis->drive))
        return CM1E_ERROR_AXIS_VIRTUAL;
    if (!cm1e_axis_position_from_units(axis, command->position, &position))
        return CM1E_ERROR_AXIS_POSITION_RANGE;
    if (axis->motor_hooks && axis->motor_hooks->refuses_homing(axis))
        return CM1E_ERROR_CM_MODE;
    if (!(axis->power.enable_positive && axis->power.enable_negative))
        return CM1E_ERROR_AXIS_DIRECTION_DISABLED; /* every method may move in both directions */
    if (c->method > kind->last_method || c->method < kind->first_method || c->method == 0) /* 0: none selected */
        return wrong(home, METHOD, c->method);
    if (home->submitted && cm1e_sdo_state(&home->sdo) == CM1E_SDO_BUSY)
        return CM1E_ERROR_BUSY; /* a transfer of a stopped homing is still under way */
    if (!isfinite(c->timeout_s) || c->timeout_s < 0.0 || c->timeout_s > longest_timeout_s)
        return wrong(home, TIMEOUT, c->timeout_s);
    const cm1e_error_t error = take_parameters(axis, c);
    if (error != CM1E_OK)
        return error;
    home->position = command->position;
    home->timeout_ns = (int64_t)((c->timeout_s == 0.0 ? 60.0 : c->timeout_s) * 1e9);
    return CM1E_OK;
}

/* ---- from step to step ------------------------------------------------------------------------------------------- */

/* Begins a step. */
static void enter(cm1e_axis_t *axis, cm1e_home_step_t step)
{
    drive_homing_t *home = &axis->homing->drive;
    cm1e_drive_command_t *command = &axis->drive.command;
    home->step = step;
    home->step_ns = home->told_ns = axis->now_ns;
    cm1e_axis_watch_standstill(axis, &home->standstill);
    if (step == HOME_SWITCH) {
        home->away = true;
        command->mode = CM1E_MODE_HM;
        command->homing_start = command->halt = false;
    } else if (step == HOME_START) {
        cm1e_axis_set_homed(axis, false);
        home->bits_before = bits(axis);
        home->deadline_ns = axis->now_ns + home->timeout_ns;
        command->homing_start = true;
    } else if (step == HOME_SETTLE) {
        command->homing_start = false;
    } else if (step == HOME_RETURN) { /* the halt bit stays: clearing it would restart the homing */
        command->homing_start = false;
        command->mode = axis->mode;
    }
}

/* Sets the position at the reference, which is the 0 of the drive. The motor may be some counts beside it. A drive that
 * does not move by the offset has its 0 that far before the reference. */
static void take_reference(cm1e_axis_t *axis)
{
    const int64_t offset = kind_of(axis)->offset_by_axis ? llround(axis->homing->drive.offset) : 0;
    const position_t at = cm1e_axis_load(axis, axis->position.actual_counts - axis->position.raw + offset);
    cm1e_axis_set_origin(axis, at, axis->homing->drive.position);
    cm1e_axis_set_homed(axis, true);
}

static void next_step(cm1e_axis_t *axis)
{
    const cm1e_home_step_t step = kind_of(axis)->steps[++axis->homing->drive.place];
    if (step == HOME_RETURN)
        take_reference(axis);
    enter(axis, step);
}

void cm1e_homing_run(cm1e_axis_t *axis)
{
    drive_homing_t *home = &axis->homing->drive;
    home->next = home->place = 0;
    home->submitted = home->away = home->unstoppable = home->unsettled = home->late = false;
    home->refused = CM1E_OK;
    home->goal = HOME_GOAL_DONE;
    home->deadline_ns = axis->now_ns + home->timeout_ns;
    cm1e_axis_set_source(axis, &cm1e_source_homing);
    enter(axis, kind_of(axis)->steps[0]);
}

/* Ends the homing. The drive is in the axis's own mode. */
static void leave(cm1e_axis_t *axis)
{
    cm1e_axis_set_source(axis, &cm1e_source_hold);
    axis->homing->drive.away = false;
    if (cm1e_axis_settle(axis))
        return;
    if (axis->commands.active)
        cm1e_axis_command_end(axis, CM1E_COMMAND_DONE, CM1E_OK); /* MC_Home, or the MC_Stop that ended it */
    cm1e_axis_go(axis, ON_DONE);
}

/* Ends the command with an error. The motor has not moved, so the axis does not go to ErrorStop. */
static void refuse(cm1e_axis_t *axis, cm1e_error_t error)
{
    axis->homing->drive.refused = error;
    cm1e_axis_command_end(axis, CM1E_COMMAND_ERROR, error);
    if (!axis->homing->drive.away) {
        leave(axis);
        return;
    }
    axis->homing->drive.goal = HOME_GOAL_HOLD;
    enter(axis, HOME_RETURN);
}

/* ---- the steps --------------------------------------------------------------------------------------------------- */

static void submit(cm1e_axis_t *axis, uint16_t index, uint8_t subindex, unsigned bytes, bool write)
{
    drive_homing_t *home = &axis->homing->drive;
    home->sdo = (cm1e_sdo_t){.position = axis->drive.position, .index = cm1e_drive_index(&axis->drive, index),
                             .subindex = subindex, .write = write, .data = home->data, .size = bytes};
    const cm1e_error_t error = cm1e_sdo_submit(axis->drive.bus, &home->sdo);
    if (error == CM1E_OK)
        home->submitted = true;
    else if (error != CM1E_ERROR_FULL) /* a full queue: the next cycle tries again */
        refuse(axis, error);
}

/* Looks at the transfer under way. true: it has ended without an error. */
static bool transferred(cm1e_axis_t *axis)
{
    drive_homing_t *home = &axis->homing->drive;
    const cm1e_sdo_state_t state = cm1e_sdo_state(&home->sdo);
    if (state != CM1E_SDO_ERROR && state != CM1E_SDO_DONE)
        return false;
    home->submitted = false;
    if (state == CM1E_SDO_ERROR)
        refuse(axis, home->sdo.error);
    return state == CM1E_SDO_DONE;
}

static void submit_parameter(cm1e_axis_t *axis)
{
    drive_homing_t *home = &axis->homing->drive;
    const cm1e_homing_object_t object = object_of(axis, home->next, home->raw[METHOD]);
    const unsigned bits = cm1e_drive_entry(&axis->drive, object.index, object.subindex)->bits;
    const unsigned bytes = bits <= 8 * sizeof home->data ? bits / 8 : (unsigned)sizeof home->data;
    cm1e_put_uint(home->data, bytes, (uint32_t)home->raw[home->next]);
    submit(axis, object.index, object.subindex, bytes, true);
}

/* Refuses the homing when the deadline of a step with transfers is over. A transfer under way ends by itself. */
static bool too_late(cm1e_axis_t *axis)
{
    if (axis->now_ns < axis->homing->drive.deadline_ns)
        return false;
    axis->homing->drive.late = true;
    refuse(axis, CM1E_ERROR_TIMEOUT);
    return true;
}

static void step_write(cm1e_axis_t *axis)
{
    drive_homing_t *home = &axis->homing->drive;
    if (home->away)
        cm1e_axis_set_to_actual(axis);
    if (too_late(axis))
        return;
    if (home->submitted) {
        if (!transferred(axis))
            return;
        home->next++;
    }
    while (home->next < HOMING_PARAMETERS && kind_of(axis)->objects[home->next].index == 0)
        home->next++;
    if (home->next < HOMING_PARAMETERS)
        submit_parameter(axis);
    else
        next_step(axis);
}

/* Takes the unit of the offset from K45. Without an offset the unit does not matter. */
static void take_offset_unit(cm1e_axis_t *axis)
{
    drive_homing_t *home = &axis->homing->drive;
    home->k45 = (int32_t)(cm1e_get_u32(home->data) & INT32_MAX);
    if (home->offset == 0.0)
        next_step(axis);
    else if (k45_is_known(home) && parameter(axis, OFFSET, home->raw[METHOD], home->offset))
        next_step(axis);
    else
        refuse(axis, wrong(home, OFFSET, home->offset / axis->position.scale));
}

static void step_read(cm1e_axis_t *axis)
{
    drive_homing_t *home = &axis->homing->drive;
    if (too_late(axis))
        return;
    if (!home->submitted)
        submit(axis, OBJ_60F6_K_PARAMETERS, CM1E_K_PARAMETER_HOMING_OFFSET_UNIT, sizeof home->data, false);
    else if (!transferred(axis))
        return;
    else if (home->sdo.size != sizeof home->data)
        refuse(axis, CM1E_ERROR_BUS_MAILBOX);
    else
        take_offset_unit(axis);
}

static bool stands(cm1e_axis_t *axis) { return cm1e_axis_is_at_standstill(axis, &axis->homing->drive.standstill); }

/* Waits for standstill: BR appendix 3.1 requires it before the mode is switched. */
static void step_rest(cm1e_axis_t *axis)
{
    if (stands(axis))
        next_step(axis);
    else if (axis->now_ns - axis->homing->drive.step_ns >= rest_timeout_ns)
        refuse(axis, CM1E_ERROR_AXIS_NOT_AT_REST);
}

/* Ends a homing whose goal is no torque: then there is no motion to stop and no mode to wait for. */
static bool off(cm1e_axis_t *axis)
{
    if (axis->homing->drive.goal != HOME_GOAL_OFF)
        return false;
    axis->drive.command.homing_start = false;
    axis->drive.command.halt = false;
    axis->drive.command.mode = axis->mode;
    cm1e_axis_let_go(axis);
    return true;
}

static void step_switch(cm1e_axis_t *axis)
{
    cm1e_axis_set_to_actual(axis);
    if (!cm1e_axis_acts_in(axis, CM1E_MODE_HM)) /* the drive room bounds this wait */
        return;
    if (axis->homing->drive.goal == HOME_GOAL_DONE)
        next_step(axis);
    else
        enter(axis, HOME_RETURN);
}

static void step_taken(cm1e_axis_t *axis)
{
    cm1e_axis_set_to_actual(axis);
    if (axis->now_ns - axis->homing->drive.step_ns >= taken_ns)
        next_step(axis);
}

static void fail(cm1e_axis_t *axis, cm1e_error_t error) { cm1e_axis_fail(axis, error, bits(axis), 0.0); }

static void fail_when_late(cm1e_axis_t *axis)
{
    if (axis->now_ns >= axis->homing->drive.deadline_ns)
        fail(axis, CM1E_ERROR_AXIS_HOMING_TIMEOUT);
}

/* Waits until the homing has begun. The drive shows the bits of the last homing until then, so only a change of the
 * bits or "in progress" counts. */
static void step_start(cm1e_axis_t *axis)
{
    cm1e_axis_set_to_actual(axis);
    if (!axis->drive.feedback.online)
        return;
    const uint8_t now = bits(axis);
    const meaning_t meaning = meanings[now];
    const bool progress = meaning == IN_PROGRESS || (meaning == ATTAINED && !kind_of(axis)->attained_is_enough);
    if (progress || (now != axis->homing->drive.bits_before && meaning != INTERRUPTED))
        next_step(axis);
    else if (axis->now_ns - axis->homing->drive.step_ns >= start_timeout_ns)
        fail(axis, CM1E_ERROR_AXIS_HOMING_FAILED);
    else
        fail_when_late(axis);
}

static bool completed(cm1e_axis_t *axis, meaning_t meaning)
{
    const bool enough = meaning == ATTAINED && kind_of(axis)->attained_is_enough;
    return meaning == COMPLETED || (stands(axis) && enough);
}

static void step_run(cm1e_axis_t *axis)
{
    drive_homing_t *home = &axis->homing->drive;
    cm1e_axis_set_to_actual(axis);
    if (!axis->drive.feedback.online)
        return;
    const meaning_t meaning = meanings[bits(axis)];
    if (meaning != INTERRUPTED)
        home->told_ns = axis->now_ns;
    if (completed(axis, meaning))
        next_step(axis);
    else if (meaning == FAILED || axis->now_ns - home->told_ns >= interrupted_ns)
        fail(axis, CM1E_ERROR_AXIS_HOMING_FAILED);
    else
        fail_when_late(axis);
}

/* Waits for standstill. A drive may say too early that it has homed, and while the mode is switched the target rests:
 * it would be far behind a motor that still turns. Behind a bridge the end of the homing and the position come over the
 * serial line of the motor, and not always in one cycle. */
static void step_settle(cm1e_axis_t *axis)
{
    cm1e_axis_set_to_actual(axis);
    const bool failed = axis->drive.feedback.online && meanings[bits(axis)] == FAILED;
    axis->homing->drive.unsettled = !failed && axis->now_ns - axis->homing->drive.step_ns >= rest_timeout_ns;
    if (!failed && stands(axis))
        next_step(axis);
    else if (failed || axis->homing->drive.unsettled)
        fail(axis, CM1E_ERROR_AXIS_HOMING_FAILED);
}

/* The stop takes speed / deceleration; the deceleration is 0x609A (UG 6.2.4). */
static int64_t halt_bound_ns(const cm1e_axis_t *axis)
{
    const cm1e_device_homing_t *kind = kind_of(axis);
    const double speed = axis->homing->drive.raw[SPEED] * kind->objects[SPEED].unit;
    const double acceleration = axis->homing->drive.raw[ACCELERATION] * kind->objects[ACCELERATION].unit;
    return cm1e_axis_halt_bound_ns(axis, speed / acceleration, kind->halts);
}

/* Waits for the halt, and switches the mode only then: before V1.3.0 a halt together with a switch of the mode did not
 * stop the motor (UG 10.1). */
static void step_halt(cm1e_axis_t *axis)
{
    drive_homing_t *home = &axis->homing->drive;
    cm1e_axis_set_to_actual(axis);
    const bool searching = !kind_of(axis)->halts && meanings[bits(axis)] == IN_PROGRESS;
    const bool at_rest = stands(axis) && !searching;
    const bool expired = axis->now_ns - home->step_ns >= halt_bound_ns(axis);
    if (!expired && !at_rest)
        return;
    if (off(axis))
        return;
    if (expired) {
        home->unstoppable = true;
        fail(axis, CM1E_ERROR_AXIS_HOMING_FAILED);
        return;
    }
    enter(axis, HOME_RETURN);
}

static void step_return(cm1e_axis_t *axis)
{
    cm1e_axis_set_to_actual(axis);
    if (!cm1e_axis_acts_in(axis, axis->mode))
        return;
    axis->drive.command.halt = false;
    leave(axis);
}

static bool step(cm1e_axis_t *axis)
{
    static void (*const steps[])(cm1e_axis_t *) = {
        [HOME_READ] = step_read,   [HOME_REST] = step_rest,   [HOME_WRITE] = step_write, [HOME_SWITCH] = step_switch,
        [HOME_TAKEN] = step_taken, [HOME_START] = step_start, [HOME_RUN] = step_run,     [HOME_SETTLE] = step_settle,
        [HOME_HALT] = step_halt,   [HOME_RETURN] = step_return,
    };
    if (cm1e_axis_has_lost_torque(axis, axis->homing->drive.goal)) {
        (void)off(axis);
        return true;
    }
    steps[axis->homing->drive.step](axis);
    return true;
}

static void stop(cm1e_axis_t *axis, const cm1e_motion_limits_t *ramp, home_goal_t goal)
{
    (void)ramp; /* the drive uses its own ramp */
    drive_homing_t *home = &axis->homing->drive;
    home->goal = goal;
    switch (home->step) {
    case HOME_READ:
    case HOME_REST:
    case HOME_WRITE: /* at standstill, in the own mode or in homing mode */
    case HOME_TAKEN:
        if (off(axis))
            break;
        if (home->away)
            enter(axis, HOME_RETURN);
        else
            leave(axis);
        break;
    case HOME_SWITCH:
    case HOME_RETURN: /* at standstill; HOLD waits for the switch of the mode */
        (void)off(axis);
        break;
    case HOME_START:
    case HOME_RUN:
    case HOME_SETTLE:
        axis->drive.command.halt = kind_of(axis)->halts;
        if (!kind_of(axis)->halts)
            axis->drive.command.homing_start = false;
        enter(axis, HOME_HALT);
        break;
    case HOME_HALT:
        break;
    }
}

const source_t cm1e_source_homing = {.step = step, .stop = stop, .by_drive = true, .homes = true};
