/*
 * Homing in steps (Part 5, 3.1 ... 3.8), by the axis in its own mode. It searches with a velocity, checks the inputs
 * and the motor's torque and velocity in every cycle, stops, and sets the position of the place where the event was.
 *
 * Every step leaves the axis in Homing; MC_HomeDirect and MC_FinishHoming lead to Standstill. A limit of the step that
 * is reached is an error of the block (Part 1, 2.2.2). It is shown when the axis is at standstill, and does not lead to
 * ErrorStop. Positions are not valid in Homing, so the software limits apply only to the move of MC_FinishHoming.
 *
 * An event lies between two cycles. Its place is taken as halfway between the two actual positions, which is wrong by
 * at most half of their distance.
 */
#include <math.h>

#include "axis/axis_backlash.h"
#include "axis/axis_commands.h"
#include "axis/axis_device.h"
#include "axis/axis_limits.h"
#include "axis/axis_plan.h"
#include "axis/axis_position.h"
#include "axis/axis_setpoint.h"
#include "axis/axis_signals.h"
#include "core/clock.h"
#include "homing/homing_private.h"

static const int64_t default_detection_ns = 50 * MS_IN_NS;
static const double default_timeout_s = 60.0;
/* All counts in this file are counts of a CM1-E. */
static const double tolerance_counts = 20.0;
static const double relief_velocity_counts = 5000.0; /* counts/s; the set-point goes back from a stop */
static const double creep_velocity_counts = 250.0;   /* counts/s; the set-point comes nearer to the stop again */
static const double pressing_time_s = 0.01;
static const double farthest_relief_counts = 5000.0;
/* The part of the maximum lag that shows a stop if no TorqueLimit is given. */
static const double pressing_lag = 0.25;
/* Within this time a free motor reaches its set-point, in spite of friction. */
static const int64_t settling_ns = 50 * MS_IN_NS;

/* ---- signals ----------------------------------------------------------------------------------------------------- */

static cm1e_axis_switch_t limit_switch(double way)
{
    return way > 0.0 ? CM1E_SWITCH_LIMIT_POSITIVE : CM1E_SWITCH_LIMIT_NEGATIVE;
}

/* A step searches for an input by its number, or for a switch of the configuration. */
static bool by_number(const cm1e_homing_step_t *step)
{
    return step->kind != CM1E_STEP_LIMIT_SWITCH && step->input != 0;
}

static cm1e_axis_switch_t switch_of(const cm1e_homing_step_t *step, double way)
{
    return step->kind == CM1E_STEP_LIMIT_SWITCH ? limit_switch(way) : CM1E_SWITCH_HOME;
}

static bool level_of(const cm1e_axis_t *axis, const stepping_t *s)
{
    return by_number(&s->step) ? cm1e_axis_input_level(axis, s->step.input)
                                 : cm1e_axis_switch_active(axis, switch_of(&s->step, s->search));
}

static int input_of(const cm1e_axis_t *axis, const cm1e_homing_step_t *step, double way)
{
    return by_number(step) ? step->input : cm1e_axis_switch_input(axis, switch_of(step, way));
}

/* Whether the slave with the signal of the step, or with the limit switch ahead, is away. Nobody would see the place
 * at which the search has to end. */
static bool signal_away(const cm1e_axis_t *axis, const cm1e_homing_step_t *step, double search, double way)
{
    return cm1e_axis_switch_away(axis, limit_switch(way)) ||
           (step_by_switch(step->kind) && cm1e_axis_input_away(axis, input_of(axis, step, search)));
}

/* ---- check ------------------------------------------------------------------------------------------------------- */

static bool searches(cm1e_homing_step_kind_t kind) { return step_by_switch(kind) || kind == CM1E_STEP_BLOCK; }

static double search_direction(const cm1e_homing_step_t *step)
{
    return step->direction == mcNegativeDirection || step->direction == mcSwitchNegative ? -1.0 : 1.0;
}

/* Whether a position can be set: it is in the range of the axis, or NAN for none. */
static bool position_valid(const cm1e_axis_t *axis, double position)
{
    position_t unused;
    return isnan(position) || cm1e_axis_position_from_units(axis, position, &unused);
}

static cm1e_error_t check_signal(const cm1e_axis_t *axis, const cm1e_homing_step_t *step)
{
    const double search = search_direction(step);
    const bool by_switch = step_by_switch(step->kind);
    if ((step->torque_limit > 0.0 && axis->drive.image.in_torque.bytes == 0) ||
        (by_switch && !cm1e_axis_sees_input(axis, input_of(axis, step, search))))
        return CM1E_ERROR_PDO_MAPPING;
    if (signal_away(axis, step, search, -1.0) || signal_away(axis, step, search, 1.0))
        return CM1E_ERROR_AXIS_SIGNAL_AWAY;
    if (!by_switch)
        return CM1E_OK;
    if (by_number(step))
        return cm1e_axis_check_input(axis, step->input) == CM1E_OK ? CM1E_OK : cm1e_homing_wrong_signal(axis, step);
    return cm1e_axis_has_switch(axis, switch_of(step, search)) ? CM1E_OK : CM1E_ERROR_AXIS_STEP_SWITCH;
}

cm1e_error_t cm1e_homing_step_check(const cm1e_axis_t *axis, const cm1e_homing_step_t *step, const move_t *move)
{
    if (!step || (unsigned)step->kind > CM1E_STEP_FINISH)
        return CM1E_ERROR_INVALID_ARGUMENT;
    if (move->buffer_mode != mcAborting && move->buffer_mode != mcBuffered)
        return CM1E_ERROR_AXIS_BUFFER_MODE;
    if (step->kind == CM1E_STEP_FINISH)
        return isfinite(move->position) ? CM1E_OK : CM1E_ERROR_AXIS_POSITION_RANGE;
    if (!position_valid(axis, move->position) || (step->kind == CM1E_STEP_DIRECT && isnan(move->position)))
        return CM1E_ERROR_AXIS_POSITION_RANGE;
    if (!searches(step->kind))
        return CM1E_OK;
    if (cm1e_drive_is_virtual(&axis->drive)) /* a virtual axis has neither switches nor torque */
        return CM1E_ERROR_AXIS_VIRTUAL;
    const from_t from = from_set(axis);
    cm1e_motion_limits_t unused;
    cm1e_error_t error = cm1e_homing_step_inputs(axis, step);
    if (error == CM1E_OK)
        error = check_signal(axis, step);
    return error != CM1E_OK ? error : cm1e_axis_limits_of(axis, &from, move, &unused);
}

/* ---- motions ----------------------------------------------------------------------------------------------------- */

static cm1e_motion_state_t set_state(const cm1e_axis_t *axis)
{
    const from_t from = from_set(axis);
    return (cm1e_motion_state_t){0.0, from.velocity, from.acceleration};
}

static void run(cm1e_axis_t *axis, const cm1e_profile_t *profile)
{
    const from_t from = from_set(axis);
    cm1e_axis_run(axis, &from, profile,
                  cm1e_position_plus(axis->setpoint.position, profile->end.position * axis->position.scale), 0.0);
}

static void go_within(cm1e_axis_t *axis, double velocity, const cm1e_motion_limits_t *limits)
{
    cm1e_profile_t profile;
    const cm1e_motion_state_t now = set_state(axis);
    if (cm1e_profile_to_velocity(&profile, &now, velocity, limits) == CM1E_OK)
        run(axis, &profile);
}

static void go(cm1e_axis_t *axis, double velocity) { go_within(axis, velocity, &axis->homing->stepping.limits); }

/* Changes the velocity of the set-point while the motor is blocked. No limit of jerk is needed then. The acceleration
 * is only as large as needed for a change within `pressing_time_s`, because the next motion begins with a step to
 * acceleration 0 (from_set()). */
static void press_on(cm1e_axis_t *axis, double velocity)
{
    cm1e_motion_limits_t limits = axis->limits.emergency;
    const double soon = fmax(fabs(axis->setpoint.velocity), fabs(velocity)) / pressing_time_s;
    if (soon > 0.0)
        limits.acceleration = limits.deceleration = fmin(axis->limits.emergency.deceleration, soon);
    go_within(axis, velocity, &limits);
}

static void turn_to(cm1e_axis_t *axis, double way)
{
    axis->homing->stepping.way = way;
    go(axis, way * axis->homing->stepping.limits.velocity);
}

static double torque_percent(const cm1e_axis_t *axis)
{
    return axis->drive.feedback.torque * (axis->position.scale < 0.0 ? -0.1 : 0.1);
}

static double lag_counts(const cm1e_axis_t *axis)
{
    return cm1e_position_minus(axis->setpoint.position, axis_actual(axis));
}

static double relief_velocity(const cm1e_axis_t *axis)
{
    return fmin(relief_velocity_counts * axis->position.count / fabs(axis->position.scale),
                axis->limits.maximum.velocity);
}

/* Relieves a motor that pushes in the direction `way`. The set-point goes back at least to the position of the motor,
 * and farther while the integral part of the drive's controller still pushes. */
static void relieve(cm1e_axis_t *axis, double way)
{
    stepping_t *s = &axis->homing->stepping;
    s->phase = STEPPING_RELIEVE;
    s->way = -way;
    s->travel = -fabs(lag_counts(axis) / axis->position.scale);
    press_on(axis, s->way * relief_velocity(axis));
}

static void relieve_cycle(cm1e_axis_t *axis)
{
    stepping_t *s = &axis->homing->stepping;
    s->travel += fabs(axis->setpoint.velocity) * axis->cycle_s;
    const double push = -s->way, lag = lag_counts(axis) / axis->position.scale;
    /* A lag below one count and a torque below one per cent are rounding. */
    const bool pushes = lag * fabs(axis->position.scale) * push > 1.0 || torque_percent(axis) * push > 1.0;
    const bool enough = s->travel * fabs(axis->position.scale) >= farthest_relief_counts * axis->position.count;
    if ((pushes && !enough) || !axis->drive.feedback.fresh)
        return;
    s->phase = STEPPING_RELIEVED;
    press_on(axis, 0.0);
}

/* The torque of a search for a switch carries a load, as it did when the search began. What has come meanwhile presses
 * against a stop, and so does all of it where it has ended the search. */
static bool presses_by_torque(const cm1e_axis_t *axis)
{
    const stepping_t *s = &axis->homing->stepping;
    const double limit = s->step.torque_limit, torque = torque_percent(axis);
    const bool carries = step_by_switch(s->step.kind) && s->outcome != CM1E_ERROR_AXIS_STEP_TORQUE;
    return limit > 0.0 && fabs(torque) > 0.5 * limit && (!carries || fabs(torque - s->carried) > 0.25 * limit);
}

/* Whether the motor presses against something: a free motor is never so far from a set-point at rest. */
static bool presses(const cm1e_axis_t *axis)
{
    return presses_by_torque(axis) ||
           fabs(lag_counts(axis) / axis->position.scale) >= pressing_lag * axis->limits.max_lag;
}

/* Whether the motor is where the set-point is, and does not press. What is older than this cycle does not show it. */
static bool has_arrived(const cm1e_axis_t *axis)
{
    const bool away = fabs(lag_counts(axis)) > cm1e_axis_tolerance_counts(axis, tolerance_counts);
    return axis->drive.feedback.fresh && !away && !presses_by_torque(axis);
}

static double pushed_way(const cm1e_axis_t *axis)
{
    const double lag = lag_counts(axis) / axis->position.scale;
    const bool lags = fabs(lag * axis->position.scale) > cm1e_axis_tolerance_counts(axis, tolerance_counts);
    return (lags ? lag : torque_percent(axis)) > 0.0 ? 1.0 : -1.0;
}

/* Begins to wait for the motor while the set-point is at rest. A free motor arrives, perhaps late because of friction.
 * A blocked motor does not, and is relieved. */
static void settle(cm1e_axis_t *axis)
{
    axis->homing->stepping.phase = STEPPING_SETTLE;
    axis->homing->stepping.settled_ns = axis->now_ns + settling_ns;
    if (presses(axis))
        relieve(axis, pushed_way(axis));
}

static void settle_cycle(cm1e_axis_t *axis)
{
    stepping_t *s = &axis->homing->stepping;
    if (!axis->drive.feedback.fresh)
        return;
    if (has_arrived(axis)) {
        s->phase = STEPPING_RELIEVED;
        press_on(axis, 0.0); /* the set-point is at rest already, so this profile ends at once */
    } else if (presses(axis) || axis->now_ns >= s->settled_ns) {
        relieve(axis, pushed_way(axis));
    }
}

static void decide(cm1e_axis_t *axis, cm1e_error_t outcome)
{
    axis->homing->stepping.outcome = outcome;
    axis->homing->stepping.phase = STEPPING_STOP;
}

static void found(cm1e_axis_t *axis, position_t reference)
{
    axis->homing->stepping.reference = reference;
    decide(axis, CM1E_OK);
    go(axis, 0.0);
}

static void give_up(cm1e_axis_t *axis, cm1e_error_t error)
{
    decide(axis, error);
    go(axis, 0.0);
}

/* ---- begin ------------------------------------------------------------------------------------------------------- */

static cm1e_error_t prepare_finish(const cm1e_axis_t *axis, const move_t *move, stepping_t *next,
                                   cm1e_profile_t *profile)
{
    if (axis->state != CM1E_AXIS_HOMING)
        return CM1E_ERROR_AXIS_STATE;
    const cm1e_motion_state_t now = set_state(axis);
    const from_t from = from_set(axis);
    move_t dynamics = *move;
    if (move->position == 0.0)
        dynamics.kind = CM1E_COMMAND_HALT; /* acts as a halt, whose velocity does not matter */
    const cm1e_error_t error = cm1e_axis_limits_of(axis, &from, &dynamics, &next->limits);
    if (error != CM1E_OK)
        return error;
    next->referenced = axis->homing->stepping.referenced;
    next->finishing = true;
    if (move->position == 0.0)
        return cm1e_profile_to_velocity(profile, &now, 0.0, &next->limits);
    if (cm1e_profile_to_position(profile, &now, move->position, &next->limits) != CM1E_OK)
        return CM1E_ERROR_AXIS_POSITION_RANGE;
    return cm1e_axis_limits_check(axis, &from, profile);
}

/* The direction in which a search begins. It first leaves a switch that is on, unless it searches for that switch. */
static double first_way(const cm1e_axis_t *axis, stepping_t *s)
{
    const bool by_level = s->step.direction == mcSwitchPositive || s->step.direction == mcSwitchNegative ||
                          s->step.kind == CM1E_STEP_LIMIT_SWITCH;
    s->level = level_of(axis, s);
    s->seen_on = s->level;
    return by_level && s->level ? -s->search : s->search;
}

static cm1e_error_t prepare_search(const cm1e_axis_t *axis, const move_t *move, stepping_t *next,
                                   cm1e_profile_t *profile)
{
    const from_t from = from_set(axis);
    const cm1e_error_t error = cm1e_axis_limits_of(axis, &from, move, &next->limits);
    if (error != CM1E_OK)
        return error;
    next->search = search_direction(&next->step);
    next->way = first_way(axis, next);
    if (!cm1e_axis_direction_enabled(axis, next->way))
        return CM1E_ERROR_AXIS_DIRECTION_DISABLED;
    if (next->step.time_limit_ns == 0) {
        const double timeout_s = axis->config->homing.timeout_s;
        next->step.time_limit_ns = (int64_t)((timeout_s > 0.0 ? timeout_s : default_timeout_s) * 1e9);
    }
    if (next->step.detection_velocity == 0.0)
        next->step.detection_velocity = 0.1 * next->limits.velocity;
    if (next->step.detection_ns == 0)
        next->step.detection_ns = default_detection_ns;
    next->deadline_ns = next->step.time_limit_ns > INT64_MAX - axis->now_ns
                            ? INT64_MAX : axis->now_ns + next->step.time_limit_ns;
    next->actual_before = axis_actual(axis);
    const cm1e_motion_state_t now = set_state(axis);
    return cm1e_profile_to_velocity(profile, &now, next->way * next->limits.velocity, &next->limits) != CM1E_OK
               ? CM1E_ERROR_AXIS_VELOCITY_RANGE : CM1E_OK;
}

cm1e_error_t cm1e_homing_step_prepare(const cm1e_axis_t *axis, const cm1e_homing_step_t *step, const move_t *move,
                                    stepping_t *next, cm1e_profile_t *profile)
{
    const stepping_t *ended = &axis->homing->stepping;
    *next = (stepping_t){.step = *step, .position = move->position, .after_push = axis->homing_step.pushing};
    next->carried = next->after_push ? ended->carried : torque_percent(axis);
    if (searches(next->step.kind))
        return prepare_search(axis, move, next, profile);
    next->phase = STEPPING_STOP;
    const bool halts = next->step.kind == CM1E_STEP_DIRECT || move->position == 0.0;
    if (next->after_push && halts && !step_by_switch(ended->step.kind)) /* the drive may press without any lag */
        next->step.torque_limit = ended->step.torque_limit;
    if (next->step.kind == CM1E_STEP_FINISH)
        return prepare_finish(axis, move, next, profile);
    const cm1e_motion_state_t now = set_state(axis);
    next->limits = axis->limits.maximum;
    return cm1e_profile_to_velocity(profile, &now, 0.0, &next->limits);
}

void cm1e_homing_step_run(cm1e_axis_t *axis, const stepping_t *next, const cm1e_profile_t *profile)
{
    axis->homing->stepping = *next;
    axis->homing_step.finishing = next->finishing;
    axis->homing_step.pushing = true;
    axis->homing_step.after_stop = false;
    cm1e_axis_go(axis, ON_HOMING_STEP);
    if (searches(next->step.kind))
        cm1e_axis_set_homed(axis, false);
    run(axis, profile);
    if (next->step.kind == CM1E_STEP_DIRECT && profile->duration_s == 0.0)
        (void)cm1e_homing_step_ended(axis); /* at standstill: done at once */
}

/* ---- search ------------------------------------------------------------------------------------------------------ */

static bool edge_is_meant(const stepping_t *s, bool rising, double moving)
{
    const bool limit_switch = s->step.kind == CM1E_STEP_LIMIT_SWITCH;
    switch (s->step.mode) {
    case mcOn:
    case mcRisingEdge: return rising && moving == s->search;
    case mcOff:
    case mcFallingEdge: return !rising && moving == (limit_switch ? -s->search : s->search);
    case mcEdgeSwitchPositive: return rising == (moving > 0.0);
    case mcEdgeSwitchNegative: return rising == (moving < 0.0);
    }
    return false;
}

/* Whether a level of the switch is the event. For an absolute switch the levels (mcOn, mcOff) are conditions, whichever
 * edge leads to them. */
static bool level_is_meant(const stepping_t *s, bool on)
{
    return s->step.kind == CM1E_STEP_ABSOLUTE_SWITCH &&
           ((s->step.mode == mcOn && on) || (s->step.mode == mcOff && !on));
}

static position_t halfway(const cm1e_axis_t *axis)
{
    const position_t before = axis->homing->stepping.actual_before;
    return cm1e_position_plus(before, 0.5 * cm1e_position_minus(axis_actual(axis), before));
}

/* Looks at the switch. true: the event has occurred. */
static bool look_at_switch(cm1e_axis_t *axis)
{
    stepping_t *s = &axis->homing->stepping;
    const bool on = level_of(axis, s), before = s->level;
    const double moving = axis->setpoint.velocity > 0.0 ? 1.0 : axis->setpoint.velocity < 0.0 ? -1.0 : 0.0;
    s->level = on;
    s->seen_on |= on;
    if (!level_is_meant(s, on) && !(on != before && moving != 0.0 && edge_is_meant(s, on, moving)))
        return false;
    found(axis, on != before ? halfway(axis) : axis_actual(axis));
    return true;
}

/* Whether a search in the opposite direction has to turn back to its own: it has passed the switch, or met a limit
 * switch. */
static bool time_to_turn(const stepping_t *s)
{
    const bool falling_limit = s->step.kind == CM1E_STEP_LIMIT_SWITCH &&
                               (s->step.mode == mcOff || s->step.mode == mcFallingEdge);
    if (falling_limit)
        return s->way == s->search && s->level;
    return s->way != s->search && s->seen_on && !s->level;
}

/* Turns the search at a limit switch, once at each of them (Part 5, 3.1). */
static void look_at_limit_switch(cm1e_axis_t *axis)
{
    stepping_t *s = &axis->homing->stepping;
    if (s->step.kind == CM1E_STEP_LIMIT_SWITCH && s->way == s->search)
        return; /* the step searches for this limit switch */
    if (!cm1e_axis_switch_active(axis, limit_switch(s->way)))
        return;
    bool *turned = s->way > 0.0 ? &s->turned_positive : &s->turned_negative;
    if (s->step.kind != CM1E_STEP_ABSOLUTE_SWITCH || *turned) {
        give_up(axis, CM1E_ERROR_AXIS_STEP_LIMIT_SWITCH);
        return;
    }
    *turned = true;
    s->seen_on = s->level;
    turn_to(axis, -s->way);
}

static double actual_velocity(const cm1e_axis_t *axis) { return axis->drive.feedback.velocity / axis->position.scale; }

static bool stands(const cm1e_axis_t *axis)
{
    return fabs(actual_velocity(axis)) <= axis->homing->stepping.step.detection_velocity;
}

/* How clearly the motor presses against a stop: its torque or lag relative to the limit. 1 is enough. */
static double pressure(const cm1e_axis_t *axis)
{
    const stepping_t *s = &axis->homing->stepping;
    if (s->step.torque_limit > 0.0)
        return torque_percent(axis) * s->way / s->step.torque_limit;
    return lag_counts(axis) / axis->position.scale * s->way / (pressing_lag * axis->limits.max_lag);
}

/* Moves the set-point so that the motor keeps pressing with about TorqueLimit, although the drive's controller
 * integrates the lag. Without a TorqueLimit the set-point stays. */
static void keep_pressed(cm1e_axis_t *axis, double now)
{
    stepping_t *s = &axis->homing->stepping;
    const double pace = s->step.torque_limit == 0.0 ? 0.0
                        : now >= 1.0 ? -relief_velocity(axis)
                        : creep_velocity_counts * axis->position.count / fabs(axis->position.scale);
    if (s->pressed && pace == s->pace)
        return;
    s->pace = pace;
    press_on(axis, s->way * pace);
}

/* Searches for a stop: a place where the motor presses and stands for the detection time. If it comes free, the search
 * goes on. */
static void look_for_block(cm1e_axis_t *axis)
{
    stepping_t *s = &axis->homing->stepping;
    const double now = pressure(axis);
    /* The set-point has to be faster than the detection velocity first, or a start from rest would look like a stop. */
    const bool fast = fabs(axis->setpoint.velocity) > s->step.detection_velocity;
    if (!s->pressed && !(stands(axis) && fast && now >= 1.0))
        return;
    if (!stands(axis)) {
        s->pressed = false;
        turn_to(axis, s->way);
        return;
    }
    keep_pressed(axis, now);
    if (!s->pressed || now < 0.5)
        s->pressed_ns = axis->now_ns;
    s->pressed = true;
    if (axis->now_ns - s->pressed_ns >= s->step.detection_ns) {
        s->reference = axis_actual(axis);
        decide(axis, CM1E_OK);
        relieve(axis, s->way);
    }
}

/* Whether the axis has to brake now, because the counts of a motor behind a bridge end, whatever the positions of the
 * axis are. */
static bool out_of_counts(const cm1e_axis_t *axis)
{
    const double v = axis->setpoint.velocity, now = cm1e_axis_line(axis, axis->setpoint.position);
    const double end = now + v * (axis->cycle_s + fabs(v) * axis->limits.emergency_way);
    return v > 0.0 ? end > axis->limits.counts_upper : v < 0.0 && end < axis->limits.counts_lower;
}

/* Checks the limits of the step. true: one is reached, or MC_Power no longer permits the direction. */
static bool over_a_limit(cm1e_axis_t *axis)
{
    const stepping_t *s = &axis->homing->stepping;
    cm1e_error_t error = CM1E_OK;
    if (axis->limits.counts_limit && out_of_counts(axis)) {
        decide(axis, CM1E_ERROR_AXIS_POSITION_RANGE);
        go_within(axis, 0.0, &axis->limits.emergency);
        return true;
    }
    if (!cm1e_axis_direction_enabled(axis, s->way))
        error = CM1E_ERROR_AXIS_DIRECTION_DISABLED;
    else if (signal_away(axis, &s->step, s->search, s->way))
        error = CM1E_ERROR_AXIS_SIGNAL_AWAY;
    else if (axis->now_ns >= s->deadline_ns)
        error = CM1E_ERROR_AXIS_STEP_TIME;
    else if (s->step.distance_limit > 0.0 && s->travel >= s->step.distance_limit)
        error = CM1E_ERROR_AXIS_STEP_DISTANCE;
    else if (step_by_switch(s->step.kind) && s->step.torque_limit > 0.0 && axis->drive.feedback.fresh &&
             fabs(torque_percent(axis)) > s->step.torque_limit)
        error = CM1E_ERROR_AXIS_STEP_TORQUE;
    if (error != CM1E_OK)
        give_up(axis, error);
    return error != CM1E_OK;
}

static void search(cm1e_axis_t *axis)
{
    stepping_t *s = &axis->homing->stepping;
    s->travel += fabs(axis->setpoint.velocity) * axis->cycle_s;
    const bool by_input = step_by_switch(s->step.kind);
    const bool look = axis->drive.feedback.fresh &&
                      (!by_input || cm1e_axis_input_fresh(axis, input_of(axis, &s->step, s->search)));
    if (look && by_input && look_at_switch(axis))
        return;
    if (over_a_limit(axis))
        return;
    if (!look)
        return;
    look_at_limit_switch(axis);
    if (s->phase == STEPPING_SEARCH && s->step.kind == CM1E_STEP_BLOCK)
        look_for_block(axis);
    else if (s->phase == STEPPING_SEARCH && time_to_turn(s))
        turn_to(axis, -s->way);
    s->actual_before = axis_actual(axis);
}

/* Whether the motor still has to be relieved after MC_Stop has ended a step. Then MC_Stop is not Done yet. */
static bool relieving_after_stop(const cm1e_axis_t *axis)
{
    return axis->homing_step.after_stop && axis->state == CM1E_AXIS_STOPPING;
}

void cm1e_homing_step_cycle(cm1e_axis_t *axis)
{
    const bool stepping = axis_stepping(axis);
    if (!stepping && !relieving_after_stop(axis))
        return;
    if (axis->homing->stepping.phase == STEPPING_RELIEVE)
        relieve_cycle(axis);
    else if (axis->homing->stepping.phase == STEPPING_SETTLE)
        settle_cycle(axis);
    else if (stepping && axis->homing->stepping.phase == STEPPING_SEARCH)
        search(axis);
    else if (stepping && axis->homing->stepping.finishing && axis->homing->stepping.outcome == CM1E_OK &&
             !cm1e_axis_direction_enabled(axis, axis->setpoint.velocity))
        give_up(axis, CM1E_ERROR_AXIS_DIRECTION_DISABLED);
}

/* ---- end --------------------------------------------------------------------------------------------------------- */

static void complete(cm1e_axis_t *axis)
{
    stepping_t *s = &axis->homing->stepping;
    const bool last = s->step.kind == CM1E_STEP_DIRECT || s->step.kind == CM1E_STEP_FINISH;
    axis->homing_step.pushing = false;
    if (s->outcome != CM1E_OK) { /* waiting steps would build on this one */
        cm1e_axis_command_end(axis, CM1E_COMMAND_ERROR, s->outcome);
        cm1e_axis_commands_end(axis, CM1E_COMMAND_ABORTED, CM1E_OK);
        return;
    }
    if (s->step.kind != CM1E_STEP_FINISH && !isnan(s->position)) {
        cm1e_axis_set_origin(axis, s->step.kind == CM1E_STEP_DIRECT ? axis_actual(axis) : s->reference, s->position);
        s->referenced = true;
    }
    if (last) {
        cm1e_axis_set_homed(axis, s->referenced);
        cm1e_axis_go(axis, ON_DONE);
    }
    cm1e_axis_command_end(axis, CM1E_COMMAND_DONE, CM1E_OK);
}

/* The set-point of MC_Stop has come to rest, or the motor has been relieved. */
static bool stop_ended(cm1e_axis_t *axis)
{
    axis->homing_step.after_stop = false;
    if (axis->state != CM1E_AXIS_STOPPING || !axis->homing_step.pushing)
        return false;
    axis->homing_step.pushing = false;
    if (has_arrived(axis))
        return false;
    cm1e_axis_stand(axis);
    axis->homing_step.after_stop = true;
    settle(axis);
    return true;
}

bool cm1e_homing_step_ended(cm1e_axis_t *axis)
{
    const stepping_t *s = &axis->homing->stepping;
    const bool stepping = axis_stepping(axis);
    if (axis->setpoint.profile.end.velocity != 0.0) {
        cm1e_axis_set_reached(axis, stepping || relieving_after_stop(axis));
        return axis->setpoint.reached;
    }
    if (!stepping)
        return stop_ended(axis);
    cm1e_axis_stand(axis);
    if (s->phase == STEPPING_SEARCH)
        return true; /* the motor presses; the detection time runs */
    if (s->phase == STEPPING_STOP && (s->after_push || s->outcome != CM1E_OK) && !has_arrived(axis))
        settle(axis);
    else
        complete(axis);
    return true;
}

/* Continues a step after a pause: with the velocity of its search or relief, or to the end of MC_FinishHoming. */
cm1e_error_t cm1e_homing_step_anew(cm1e_axis_t *axis)
{
    const stepping_t *s = &axis->homing->stepping;
    const cm1e_motion_state_t now = set_state(axis);
    const double way = cm1e_position_minus(axis->setpoint.target, axis->setpoint.position) / axis->position.scale;
    const double end = axis->setpoint.profile.end.velocity;
    cm1e_profile_t profile;
    const bool to_end = s->finishing && s->phase != STEPPING_RELIEVE;
    const bool planned = to_end ? cm1e_profile_to_position(&profile, &now, way, &s->limits) == CM1E_OK
                                : cm1e_profile_to_velocity(&profile, &now, end, &s->limits) == CM1E_OK;
    if (!planned)
        return CM1E_ERROR_AXIS_POSITION_RANGE;
    run(axis, &profile);
    return CM1E_OK;
}
