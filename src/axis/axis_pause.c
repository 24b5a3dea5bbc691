/*
 * Cycles in which the motor did not take part, or perhaps did not.
 *
 * Silence: frames were sent and did not come back, or not with the part of every slave. It is not known which of them
 * the drive received. So the time of all set-points stops, and the drive room repeats its last target (CSP). With the
 * first answer the target of the drive is known again, and its actual velocity shows whether the motor has stopped
 * meanwhile. The motion goes on as before, or begins anew from there with the velocity that is left. In CSV the motor
 * has gone on with its last velocity: after more than a few cycles the motion begins anew from where the motor must be.
 * Silence of the bus stops the time of all axes alike, so that followers stay in step and groups stay on their path.
 *
 * A motor that was at its maximum velocity has slowed down, and would exceed that velocity while it catches up. So the
 * motion goes on slower at first, by a part for each cycle. If it is made of several motions (a path, a table over
 * time, a superimposed motion), none of them is lost: the time of a path and of a table runs slower for a while
 * (motion/slow_time.h), and a base and its superimposed motion are both planned anew.
 *
 * A pause: frames were not sent, because the work of a cycle or a wake-up took whole cycles too long. In CSP the motor
 * has stopped at its last target; in CSV it has gone on with its last velocity. The motion begins anew from rest, or
 * from where the motor must be now. Stops and ramps of errors end where they are. Set-points are those of planned
 * cycles: so a pause counts in whole cycles, wherever in its cycle it ends.
 */
#include "axis/axis_pause.h"
#include "axis/axis_backlash.h"
#include "axis/axis_commands.h"
#include "axis/axis_events.h"
#include "axis/axis_lead.h"
#include "axis/axis_limits.h"
#include "axis/axis_plan.h"
#include "axis/axis_position.h"
#include "axis/axis_power.h"
#include "axis/axis_pursuit.h"
#include "axis/axis_setpoint.h"
#include "axis/axis_superimpose.h"

/* The part of the maximum velocity that is kept free for each cycle of silence, because a motor that has slowed down
 * overshoots when it gets back to its speed. */
static const double reserve = 0.08;

/* The ramp of an error goes on as it was: others may follow it, or be on one path with it, and brake no harder. */
static cm1e_motion_limits_t limits_of_stop(const cm1e_axis_t *axis)
{
    const cm1e_profile_t *ramp = &axis->setpoint.profile;
    cm1e_motion_limits_t limits = axis->limits.emergency;
    if (axis->state != CM1E_AXIS_ERROR_STOP)
        /* Without a limit of jerk: a motor that turned when it got its torque. */
        return axis->power.energized ? axis->limits.maximum : limits;
    const bool hard = axis->setpoint.brakes_hard && ramp->segment_count > 0;
    const double of_ramp = hard ? fabs(ramp->segments[ramp->segment_count - 1].start.acceleration) : 0.0;
    if (of_ramp > 0.0)
        limits.deceleration = fmin(limits.deceleration, of_ramp);
    return limits;
}

static cm1e_error_t stop_anew(cm1e_axis_t *axis)
{
    const from_t from = from_set(axis);
    cm1e_motion_limits_t limits = limits_of_stop(axis);
    cm1e_profile_t profile;
    cm1e_error_t error = axis->commands.active ? cm1e_axis_limits_of(axis, &from, &axis->commands.move, &limits)
                         : CM1E_OK;
    if (error == CM1E_OK)
        error = cm1e_axis_plan_stop(axis, &from, &limits, &profile);
    if (error == CM1E_OK)
        cm1e_axis_run(axis, &from, &profile,
                      cm1e_position_plus(from.position, profile.end.position * axis->position.scale), 0.0);
    return error;
}

/* Ends a table whose times have passed. The next command begins (2.2.2, case 2), or the axis stops. */
static cm1e_error_t end_table(cm1e_axis_t *axis)
{
    const from_t from = from_set(axis);
    cm1e_axis_command_end(axis, CM1E_COMMAND_ERROR, CM1E_ERROR_AXIS_TABLE_LATE);
    cm1e_axis_go(axis, ON_BROKEN_OFF);
    if (!cm1e_axis_begin_waiting(axis, &from, 0.0))
        cm1e_axis_ramp_down(axis, &axis->limits.maximum);
    return CM1E_OK;
}

static cm1e_error_t move_anew(cm1e_axis_t *axis)
{
    if (axis->commands.active && kind_row(axis->commands.kind)->plan == PLAN_TABLE)
        return end_table(axis);
    const bool relieves = axis->state == CM1E_AXIS_STOPPING && axis->homing_step.after_stop;
    if (relieves || (axis->commands.active && axis->commands.kind == CM1E_COMMAND_HOMING_STEP))
        return axis->homing_hooks->step_anew(axis);
    if (!axis->commands.active || axis->commands.kind == CM1E_COMMAND_STOP)
        return stop_anew(axis);
    return cm1e_axis_replan_anew(axis);
}

static void profile_anew(cm1e_axis_t *axis)
{
    const cm1e_error_t error = move_anew(axis);
    if (error != CM1E_OK)
        cm1e_axis_fail(axis, error, cm1e_axis_units(axis, axis->setpoint.position),
                       axis->setpoint.velocity > 0.0 ? axis->limits.upper : axis->limits.lower);
}

static void lost_speed(cm1e_axis_t *axis, double velocity)
{
    axis->silence.began_anew = true;
    cm1e_axis_keep_torque(axis, velocity);
}

void cm1e_axis_begin_anew(cm1e_axis_t *axis, double velocity)
{
    lost_speed(axis, axis->setpoint.velocity - velocity);
    cm1e_axis_put_velocity(axis, velocity);
    cm1e_axis_superimposed_abandon(axis);
    if (axis->setpoint.source->begin_anew)
        axis->setpoint.source->begin_anew(axis);
    else
        profile_anew(axis);
}

/* Whether it only brakes, without a target. */
static bool only_brakes(const cm1e_axis_t *axis)
{
    const bool stops = axis->commands.kind == CM1E_COMMAND_STOP || axis->commands.kind == CM1E_COMMAND_HALT;
    return (stops || !axis->commands.active) && axis->setpoint.source == &cm1e_source_profile &&
           !axis->homing_step.after_stop && !axis->superimposed.id;
}

/* In CSV the motor has gone on with the set velocity. A ramp down to standstill goes on from there: if it began anew in
 * every pause, with a limit of jerk, it would not brake where every cycle is late. */
static void go_on_after_pause(cm1e_axis_t *axis, double pause_s)
{
    const double way = axis->setpoint.velocity * axis->position.scale * pause_s; /* counts */
    cm1e_axis_shift_set_point(axis, way);
    if (!only_brakes(axis)) {
        cm1e_axis_begin_anew(axis, axis->setpoint.velocity);
        return;
    }
    lost_speed(axis, 0.0);
    cm1e_axis_shift_profile(axis, way);
}

void cm1e_axis_after_pause(cm1e_axis_t *axis, int64_t pause_ns)
{
    const bool goes_on = axis->mode == CM1E_MODE_CSV;
    cm1e_drive_note_late(&axis->drive);
    if (axis->silence.resumed) /* a follower has caused it already */
        return;
    axis->silence.resumed = RESUMED_FROM_PAUSE;
    if (axis_follows(axis))
        axis->coupling_hooks->resume_masters(axis, pause_ns);
    if (goes_on && axis->power.energized && axis_acts(axis))
        cm1e_axis_loop_after_pause(axis, (double)pause_ns * 1e-9);
    if (!goes_on)
        cm1e_axis_backlash_stop(axis);
    if (!set_points_move(axis))
        return;
    cm1e_axis_pursuit_prepare(axis, (double)pause_ns * 1e-9);
    if (goes_on)
        go_on_after_pause(axis, (double)pause_ns * 1e-9);
    else
        cm1e_axis_begin_anew(axis, 0.0);
}

/* ---- silence ----------------------------------------------------------------------------------------------------- */

static uint16_t add_up(uint16_t to, int64_t more)
{
    return (uint16_t)(to + more < UINT16_MAX ? to + more : UINT16_MAX);
}

static void note_silence(cm1e_axis_t *axis, int64_t cycles)
{
    axis->silence.silent = add_up(axis->silence.silent, cycles);
    axis->silence.shaken = add_up(axis->silence.shaken, cycles * CM1E_SHAKEN_BY_SILENCE);
}

/* Whether a cycle without an answer, or a late one, does not keep the set-point: a velocity may be reduced in any. */
static bool brakes_on(const cm1e_axis_t *axis)
{
    return axis->mode == CM1E_MODE_CSV && axis->state == CM1E_AXIS_ERROR_STOP;
}

void cm1e_axis_note_answer(cm1e_axis_t *axis, bool answered, bool lost)
{
    axis->silence.resumed = RESUMED_FROM_NOTHING;
    axis->silence.began_anew = false;
    axis->silence.silent_before = answered ? axis->silence.silent : 0;
    axis->silence.frozen = !answered && !lost && !brakes_on(axis);
    if (answered) {
        axis->silence.silent = 0;
        if (axis->silence.shaken > 0)
            axis->silence.shaken--;
    } else {
        note_silence(axis, 1);
    }
}

void cm1e_axis_hold_cycle(cm1e_axis_t *axis, int64_t missed)
{
    note_silence(axis, missed);
    axis->silence.frozen = !brakes_on(axis);
    cm1e_axis_note_disturbed(axis);
    cm1e_drive_note_late(&axis->drive);
    cm1e_drive_slew(&axis->drive);
}

/* Whether the motor goes on by itself, as it does in CSV. */
static bool motor_goes_on(const cm1e_axis_t *axis)
{
    return axis->mode == CM1E_MODE_CSV || cm1e_drive_is_virtual(&axis->drive);
}

bool cm1e_axis_stops_unheard(const cm1e_axis_t *axis)
{
    return !motor_goes_on(axis) && axis->silence.silent > CM1E_AXIS_RIDDEN_OUT_CYCLES;
}

/* u/s; no more, so that the motor does not exceed its maximum velocity while it gets back to its speed. */
static double highest_after(const cm1e_axis_t *axis, int silent_cycles)
{
    return axis->limits.system.velocity * fmax(0.0, 1.0 - reserve * (double)silent_cycles);
}

/* The cycles of silence from which the motor has not recovered. */
static int cycles_shaken(const cm1e_axis_t *axis)
{
    return (axis->silence.shaken + CM1E_SHAKEN_BY_SILENCE - 1) / CM1E_SHAKEN_BY_SILENCE;
}

/* u/s; the velocity to which the set velocity grows until the motor has recovered. */
static double speed_ahead(const cm1e_axis_t *axis)
{
    const double v = axis->setpoint.velocity, a = axis->setpoint.acceleration;
    const double ahead = fabs(v) + fmax(0.0, v > 0.0 ? a : -a) * axis->cycle_s * 2 * CM1E_SHAKEN_BY_SILENCE;
    return fmax(fabs(v), fmin(ahead, axis->limits.system.velocity));
}

/* The part of the set velocity that stays below `highest`. */
static double part_below(const cm1e_axis_t *axis, double highest)
{
    static const double rounding = 1.0 + 1e-9;
    const double ahead = speed_ahead(axis);
    return ahead <= highest * rounding ? 1.0 : highest / ahead;
}

double cm1e_axis_part_left(const cm1e_axis_t *axis)
{
    return motor_goes_on(axis) ? 1.0 : part_below(axis, highest_after(axis, cycles_shaken(axis)));
}

/* u/s; the velocity that the motor still has. */
static double velocity_left(const cm1e_axis_t *axis)
{
    const double set = axis->setpoint.velocity;
    if (motor_goes_on(axis))
        return set;
    const double motor = axis_actual_velocity(axis) / axis->position.scale;
    const double left = set > 0.0 ? fmax(0.0, fmin(motor, set)) : fmin(0.0, fmax(motor, set));
    const double most = fabs(set) * part_below(axis, highest_after(axis, axis->silence.silent_before));
    const double change = fmax(axis->limits.system.acceleration, axis->limits.system.deceleration) * axis->cycle_s *
                          (double)(axis->silence.silent_before + 1);
    const double kept = fabs(set - left) <= change + CM1E_AXIS_VELOCITY_NOISE / fabs(axis->position.scale) ? set : left;
    return fmax(-most, fmin(kept, most));
}

/* Whether the motion is made of several, so that a part would be lost if it began anew. */
static bool is_composite(const cm1e_axis_t *axis)
{
    return axis->setpoint.source->is_composite || axis->superimposed.id;
}

double cm1e_axis_ran_on(const cm1e_axis_t *axis)
{
    if (axis->mode != CM1E_MODE_CSV || axis->silence.silent_before <= CM1E_AXIS_RIDDEN_OUT_CYCLES ||
        !set_points_move(axis) || axis->state == CM1E_AXIS_ERROR_STOP) /* the ramp has gone on */
        return 0.0;
    return axis->setpoint.velocity * axis->position.scale * axis->cycle_s * (double)axis->silence.silent_before;
}

bool cm1e_axis_begins_anew(const cm1e_axis_t *axis)
{
    const bool in_place = axis->mode == CM1E_MODE_CSV; /* the motor is nearly there, and as fast as before */
    const bool shaken = !in_place && axis->silence.shaken > CM1E_AXIS_RIDDEN_OUT_CYCLES * CM1E_SHAKEN_BY_SILENCE;
    return shaken || cm1e_axis_ran_on(axis) != 0.0;
}

bool cm1e_axis_held(const cm1e_axis_t *axis) { return axis->silence.frozen; }

uint32_t cm1e_axis_was_silent(const cm1e_axis_t *axis) { return axis->silence.silent_before; }

/* The path of a group begins anew for all of its axes, or goes on for all. */
static bool begins_anew(const cm1e_axis_t *axis)
{
    const cm1e_axis_leader_t *leader = axis->leader;
    return axis_led(axis) && leader->begins_anew ? leader->begins_anew(leader->context) : cm1e_axis_begins_anew(axis);
}

/* Slows a base and its superimposed motion down; false: the superimposed motion cannot go on. */
static bool both_slower(cm1e_axis_t *axis, double part)
{
    if (!cm1e_axis_superimposed_slow(axis, part))
        return false;
    cm1e_axis_put_motion(axis, axis->setpoint.velocity * part, axis->setpoint.acceleration * part * part);
    if (!axis->setpoint.stands)
        profile_anew(axis);
    return true;
}

/* What is superimposed on a slave takes all of it: its base stays in step. false: it is too slow for that. */
static bool only_superimposed_slower(cm1e_axis_t *axis, double part)
{
    const cm1e_motion_state_t on_top = axis->superimposed.now;
    const double lost = axis->setpoint.velocity * (1.0 - part);
    if (fabs(lost) >= fabs(on_top.velocity) || lost * on_top.velocity <= 0.0)
        return false;
    if (!cm1e_axis_superimposed_slow(axis, 1.0 - lost / on_top.velocity))
        return false;
    cm1e_axis_put_motion(axis, axis->setpoint.velocity - lost,
                         axis->setpoint.acceleration - on_top.acceleration + axis->superimposed.now.acceleration);
    return true;
}

/* Goes on slower with a motion made of several, so that none is lost. A led axis is as slow as all axes of its
 * leader. */
static void go_on_slower(cm1e_axis_t *axis)
{
    const double part = cm1e_axis_part_left(axis), before = axis->setpoint.velocity;
    if (part == 1.0 && !axis_led(axis))
        return;
    if (axis->setpoint.source->slow)
        axis->setpoint.source->slow(axis, part);
    else if (!(axis_follows(axis) ? only_superimposed_slower(axis, part) : both_slower(axis, part)))
        cm1e_axis_begin_anew(axis, axis->setpoint.velocity * part);
    if (axis->setpoint.velocity != before)
        lost_speed(axis, before - axis->setpoint.velocity);
}

/* The axis is not where its leader has the others: it comes back to them by itself. */
static bool goes_on_alone(cm1e_axis_t *axis)
{
    const cm1e_axis_leader_t *leader = axis->leader;
    if (!axis_led(axis) || !leader->alone || !leader->alone(leader->context, leader->index))
        return false;
    if (cm1e_axis_pursuit_begin(axis))
        return true;
    cm1e_axis_shift_set_point(axis, cm1e_axis_ran_on(axis));
    const double left = velocity_left(axis);
    lost_speed(axis, axis->setpoint.velocity - left);
    cm1e_axis_put_velocity(axis, left);
    return true;
}

static void go_on_or_begin_anew(cm1e_axis_t *axis)
{
    if (goes_on_alone(axis))
        return;
    if (cm1e_axis_pursuit_begin(axis)) {
        if (axis_led(axis)) /* the path begins anew from rest, as for the axes that stay on it */
            axis->leader->paused(axis->leader->context, axis->leader->index);
        return;
    }
    const bool follows_on = axis_follows(axis) && axis->coupling_hooks->begins_anew(axis);
    const double ran_on = cm1e_axis_ran_on(axis);
    if (is_composite(axis) && !follows_on && !begins_anew(axis)) {
        go_on_slower(axis);
        return;
    }
    cm1e_axis_shift_set_point(axis, ran_on);
    const bool led = axis_led(axis); /* the path also pauses for an axis at rest */
    const double left = led && axis->mode != CM1E_MODE_CSV ? 0.0 : velocity_left(axis);
    if (left != axis->setpoint.velocity || follows_on || led || ran_on != 0.0)
        cm1e_axis_begin_anew(axis, left);
}

/* Slaves are handled after their masters, and before any axis advances, so that all see the same place. */
void cm1e_axis_after_silence(cm1e_axis_t *axis)
{
    if (axis->silence.resumed || axis->silence.silent_before == 0)
        return;
    axis->silence.resumed = RESUMED_FROM_SILENCE;
    if (axis_follows(axis))
        axis->coupling_hooks->resume_masters(axis, 0);
    if (!motor_goes_on(axis) && axis->silence.silent_before > CM1E_AXIS_RIDDEN_OUT_CYCLES)
        cm1e_axis_backlash_stop(axis);
    if (set_points_move(axis))
        go_on_or_begin_anew(axis);
    if (axis->coupling_hooks)
        axis->coupling_hooks->resume_slaves(axis);
}

/* First the axes of buses that were silent, then those that saw them from other buses: these go on without a step. */
void cm1e_axis_meet(cm1e_axis_t *const *axes, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        cm1e_axis_after_silence(axes[i]);
    for (uint32_t i = 0; i < count; i++)
        if (axis_follows(axes[i]))
            axes[i]->coupling_hooks->look_across(axes[i]);
}
