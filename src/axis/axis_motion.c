/* The set-point of every cycle: a sample of the profile that was planned when the command began. */
#include <math.h>

#include "axis/axis_backlash.h"
#include "axis/axis_commands.h"
#include "axis/axis_events.h"
#include "axis/axis_in_position.h"
#include "axis/axis_limits.h"
#include "axis/axis_plan.h"
#include "axis/axis_position.h"
#include "axis/axis_setpoint.h"
#include "axis/axis_superimpose.h"
#include "core/extreme.h"
#include "core/rare.h"

/* 1/s. In CSV (a mapping without target position) the position loop is ours. */
static const double csv_position_gain = 20.0;

static const cm1e_profile_stretch_t no_stretch = {.from_s = INFINITY};

void cm1e_axis_begin_run(cm1e_axis_t *axis, const source_t *source, const from_t *from, position_t target,
                         double offset_s)
{
    axis->setpoint.stretch = no_stretch;
    axis->setpoint.slow.missing = 0.0;
    axis->setpoint.base = from->position;
    axis->setpoint.base_line = cm1e_axis_line(axis, axis->setpoint.base);
    axis->setpoint.target = target;
    axis->setpoint.profile_cycles = 0;
    axis->setpoint.profile_offset_s = offset_s;
    axis->setpoint.profile_next_s = offset_s + axis->cycle_s;
    axis->setpoint.reached = false;
    axis->setpoint.paused = false;
    axis->setpoint.stands = false;
    cm1e_axis_look_anew(axis);
    cm1e_axis_set_source(axis, source);
}

void cm1e_axis_run(cm1e_axis_t *axis, const from_t *from, const cm1e_profile_t *profile, position_t target,
                   double offset_s)
{
    axis->setpoint.profile = *profile;
    cm1e_axis_begin_run(axis, &cm1e_source_profile, from, target, offset_s);
}

static void ramp_down_from(cm1e_axis_t *axis, const from_t *from, const cm1e_motion_limits_t *limits, double offset_s)
{
    cm1e_profile_t profile;
    if (cm1e_axis_plan_stop(axis, from, limits, &profile) == CM1E_OK)
        cm1e_axis_run(axis, from, &profile,
                      cm1e_position_plus(from->position, profile.end.position * axis->position.scale), offset_s);
    else
        cm1e_axis_set_source(axis, &cm1e_source_hold);
}

void cm1e_axis_ramp_down(cm1e_axis_t *axis, const cm1e_motion_limits_t *limits)
{
    const from_t from = from_set(axis); /* with what is superimposed, so that ends here */
    cm1e_axis_superimposed_end(axis, CM1E_COMMAND_ABORTED, CM1E_OK);
    ramp_down_from(axis, &from, limits, 0.0);
}

void cm1e_axis_stop_by_ramp(cm1e_axis_t *axis, const cm1e_motion_limits_t *ramp, home_goal_t goal)
{
    (void)goal; /* what follows is decided when the ramp has ended */
    cm1e_axis_ramp_down(axis, ramp);
}

/* Whether the profile still moves in the direction `sign`: now, at its end, or in between. A stretch in one direction
 * that begins and ends at rest contains a border of two segments, so the borders are tested. */
bool cm1e_axis_profile_goes(cm1e_axis_t *axis, double sign)
{
    const cm1e_profile_t *profile = &axis->setpoint.profile;
    const double velocity = axis->setpoint.velocity - axis->superimposed.now.velocity;
    const double now_s = (double)axis->setpoint.profile_cycles * axis->cycle_s + axis->setpoint.profile_offset_s;
    if (velocity * sign > 0.0 || profile->end.velocity * sign > 0.0)
        return true;
    for (int i = 0; i < profile->segment_count; i++)
        if (profile->segments[i].start_s > now_s && profile->segments[i].start.velocity * sign > 0.0)
            return true;
    return false;
}

/* ---- the cycle --------------------------------------------------------------------------------------------------- */

static void hold_target(cm1e_axis_t *axis)
{
    cm1e_axis_put_position(axis, axis->setpoint.target);
    cm1e_axis_put_velocity(axis, 0.0);
    cm1e_axis_set_source(axis, &cm1e_source_hold);
    axis->setpoint.stands = false;
}

void cm1e_axis_hold_here(cm1e_axis_t *axis)
{
    axis->setpoint.target = axis->setpoint.position;
    cm1e_axis_put_velocity(axis, 0.0);
    cm1e_axis_set_source(axis, &cm1e_source_hold);
}

void cm1e_axis_stand(cm1e_axis_t *axis)
{
    hold_target(axis);
    cm1e_axis_go(axis, ON_AT_REST);
}

static void brake_after(cm1e_axis_t *axis, const from_t *end, double late_s)
{
    const from_t from = from_set(axis);
    const bool on_top = axis->superimposed.id != 0;
    cm1e_axis_superimposed_end(axis, CM1E_COMMAND_ABORTED, CM1E_OK);
    if (on_top) /* from the last set-point, which has both motions */
        ramp_down_from(axis, &from, &axis->limits.maximum, axis->cycle_s);
    else
        ramp_down_from(axis, end, &axis->limits.maximum, late_s);
}

/* Whether a command may go on: only while it can still be stopped before a software limit. Moves to a position were
 * checked as a whole when they were planned; endless motions and changes during a motion are checked here. */
static bool may_go_on(const cm1e_axis_t *axis, cm1e_motion_state_t next)
{
    return !axis->limits.software_limits || !axis_moves_by_command(axis) ||
           cm1e_axis_limits_can_stop(axis, axis->setpoint.base_line, next);
}

/* Whether a waiting command may begin where the profile ended `late_s` ago. It may not begin where the axis can no
 * longer be stopped before a limit. A coupling begins at the present set-point instead. */
static bool may_hand_over(cm1e_axis_t *axis, double late_s)
{
    cm1e_motion_state_t begin = axis->setpoint.profile.end;
    if (axis->commands.waiting.count > 0 && kind_row(waiting_move(axis, 0)->kind)->plan == PLAN_COUPLING)
        begin.position += begin.velocity * late_s;
    return may_go_on(axis, begin);
}

/* Called when the profile ended `late_s` ago, inside the present cycle. If its command ends with it, the next command
 * began at that moment. true: the axis goes on with a profile. */
static bool profile_ended(cm1e_axis_t *axis, double late_s)
{
    const bool shared = axis->superimposed.moving && !axis->superimposed.alone;
    cm1e_motion_state_t last = {0.0, axis->setpoint.profile.end.velocity, 0.0};
    cm1e_slow_time_apply(&axis->setpoint.slow, &last);
    const from_t end = {axis->setpoint.target, last.velocity, last.acceleration, shared};
    const bool goes_on = end.velocity != 0.0;
    if (axis->homing_hooks && axis->homing_hooks->step_ended(axis))
        return axis_on_profile(axis);
    if (axis->commands.active && kind_row(axis->commands.kind)->is_endless) {
        if (may_hand_over(axis, late_s) && cm1e_axis_begin_waiting(axis, &end, late_s))
            return axis_on_profile(axis); /* false if it follows a master now */
        axis->setpoint.reached = true;
        cm1e_axis_set_passing(axis); /* the position has been passed, whatever changes later */
        return true;
    }
    if (axis->commands.active && !goes_on && cm1e_axis_settle(axis)) {
        hold_target(axis); /* the state of the diagram stays */
        return false;
    }
    if (axis->commands.active)
        cm1e_axis_command_end(axis, CM1E_COMMAND_DONE, CM1E_OK);
    if (!goes_on && axis->superimposed.id)
        axis->setpoint.stands = true; /* 3.8, figure 23: the superimposed motion goes on */
    else if (!goes_on)
        cm1e_axis_stand(axis);
    if (axis->state == CM1E_AXIS_STANDSTILL || axis->state == CM1E_AXIS_DISCRETE_MOTION) {
        if (cm1e_axis_begin_waiting(axis, &end, late_s))
            return axis_on_profile(axis);
        if (goes_on) /* for a command that could not begin in the end */
            brake_after(axis, &end, late_s);
    }
    return axis_on_profile(axis);
}

static double next_time(cm1e_axis_t *axis)
{
    const double time_s = axis->setpoint.profile_next_s;
    cm1e_axis_count_cycle(axis);
    return time_s;
}

CM1E_RARE static void find_stretch(cm1e_axis_t *axis, double time_s)
{
    cm1e_profile_stretch_at(&axis->setpoint.profile, time_s, &axis->setpoint.stretch);
}

/* Begins to count anew in a motion that goes on for weeks: from here on the profile is one that has ended already. This
 * happens at most once in 20 minutes. It uses long double, because its rounding would add up. */
CM1E_RARE static void count_anew(cm1e_axis_t *axis)
{
    const cm1e_motion_state_t end = axis->setpoint.profile.end;
    const long double time_s = (long double)axis->setpoint.profile_offset_s +
                               (long double)axis->setpoint.profile_cycles * (long double)axis->cycle_s;
    const long double after_s = time_s - (long double)axis->setpoint.profile.duration_s;
    const long double counts = (end.position + end.velocity * after_s) * (long double)axis->position.scale;
    const int64_t whole = (int64_t)counts;
    axis->setpoint.base.counts += whole;
    axis->setpoint.base = axis->setpoint.position = cm1e_position_plus(axis->setpoint.base,
                                                                       (double)(counts - (long double)whole));
    axis->setpoint.base_line = cm1e_axis_line(axis, axis->setpoint.base);
    axis->setpoint.source = &cm1e_source_profile;
    axis->setpoint.profile.segment_count = 0;
    axis->setpoint.profile.duration_s = 0.0;
    axis->setpoint.profile.end.position = 0.0;
    axis->setpoint.profile_cycles = 0;
    axis->setpoint.profile_offset_s = 0.0;
    axis->setpoint.profile_next_s = axis->cycle_s;
    axis->setpoint.stretch = no_stretch;
    cm1e_axis_look_anew(axis);
}

CM1E_RARE static void meet_limit(cm1e_axis_t *axis, double velocity);

/* The set-point at a time of the profile. */
static inline void follow(cm1e_axis_t *axis, double time_s)
{
    if (!(time_s >= axis->setpoint.stretch.from_s && time_s < axis->setpoint.stretch.until_s))
        axis->setpoint.source->find_stretch(axis, time_s);
    cm1e_motion_state_t next = cm1e_profile_stretch_state(&axis->setpoint.stretch, time_s);
    const bool on_top = axis->superimposed.id != 0;
    if (on_top) {
        cm1e_motion_state_t sum = next; /* a copy, so that `next` can stay in registers */
        cm1e_axis_superimposed_step(axis, &sum);
        next = sum;
    }
    if (!may_go_on(axis, next)) {
        meet_limit(axis, next.velocity);
        return;
    }
    const double counts = next.position * axis->position.scale;
    axis->setpoint.position = cm1e_position_plus(axis->setpoint.base, counts);
    if (axis->setpoint.reached && !on_top && fabs(counts) > profile_farthest_from_base &&
        axis->setpoint.slow.missing == 0.0)
        count_anew(axis);
    axis->setpoint.velocity = next.velocity;
    axis->setpoint.acceleration = next.acceleration;
    if (next.velocity != 0.0)
        axis->setpoint.positive_before = next.velocity > 0.0;
    if (on_top && axis->superimposed.id)
        cm1e_axis_superimposed_after(axis);
    if (!cm1e_position_in_range(axis->setpoint.position))
        cm1e_axis_fail(axis, CM1E_ERROR_AXIS_POSITION_RANGE, cm1e_axis_units(axis, axis->setpoint.position),
                       cm1e_axis_farthest(axis));
}

/* Replaces the profile by a ramp that belongs to no command. */
static void meet_limit(cm1e_axis_t *axis, double velocity)
{
    cm1e_axis_fail(axis, CM1E_ERROR_AXIS_POSITION_RANGE, cm1e_axis_units(axis, axis->setpoint.position),
                   velocity > 0.0 ? axis->limits.upper : axis->limits.lower);
    if (axis_on_profile(axis))
        follow(axis, next_time(axis));
}

static bool at_end(const cm1e_axis_t *axis, double time_s)
{
    return time_s >= axis->setpoint.profile.duration_s - profile_same_moment * axis->cycle_s &&
           !axis->setpoint.reached && !axis->setpoint.paused && !axis->setpoint.stands;
}

/* Passes the end of the profile, and of all further profiles that end within this cycle. */
CM1E_RARE static void follow_over_end(cm1e_axis_t *axis, double time_s)
{
    while (at_end(axis, time_s)) {
        const double over_s = larger(time_s - axis->setpoint.profile.duration_s, 0.0);
        if (!profile_ended(axis, over_s / (1.0 - axis->setpoint.slow.missing))) {
            if (axis_follows(axis))
                axis->coupling_hooks->first_set_point(axis);
            return;
        }
        if (!axis->setpoint.reached && !axis->setpoint.stands)
            time_s = axis->setpoint.profile_offset_s;
    }
    follow(axis, time_s);
}

bool cm1e_axis_profile_step(cm1e_axis_t *axis)
{
    const double time_s = next_time(axis);
    if (at_end(axis, time_s))
        follow_over_end(axis, time_s);
    else
        follow(axis, time_s);
    return true;
}

bool cm1e_axis_timed_step(cm1e_axis_t *axis)
{
    setpoint_t *s = &axis->setpoint;
    if (s->slow.missing == 0.0)
        return cm1e_axis_profile_step(axis);
    const source_t *source = s->source;
    const double late_s = axis->cycle_s - cm1e_slow_time_step(&s->slow, axis->cycle_s);
    s->profile_offset_s -= late_s;
    s->profile_next_s -= late_s;
    (void)cm1e_axis_profile_step(axis);
    if (s->source == source) {
        cm1e_motion_state_t now = {0.0, s->velocity, s->acceleration};
        cm1e_slow_time_apply(&s->slow, &now);
        s->velocity = now.velocity;
        s->acceleration = now.acceleration;
    }
    return true;
}

void cm1e_axis_timed_slow(cm1e_axis_t *axis, double part)
{
    setpoint_t *s = &axis->setpoint;
    const double now_s = s->profile_offset_s + (double)s->profile_cycles * axis->cycle_s;
    s->source->find_stretch(axis, now_s);
    cm1e_motion_state_t now = cm1e_profile_stretch_state(&s->stretch, now_s);
    cm1e_slow_time_begin(&s->slow, part);
    cm1e_slow_time_keep(&s->slow, &axis->limits.maximum);
    cm1e_slow_time_apply(&s->slow, &now);
    cm1e_axis_put_motion(axis, now.velocity, now.acceleration);
}

const source_t cm1e_source_profile = {
    .step = cm1e_axis_profile_step,
    .stop = cm1e_axis_stop_by_ramp,
    .goes = cm1e_axis_profile_goes,
    .keeps = cm1e_axis_profile_keeps,
    .find_stretch = find_stretch,
    .moves = true,
};

static bool step_hold(cm1e_axis_t *axis)
{
    cm1e_axis_in_position_step(axis);
    return true;
}

const source_t cm1e_source_hold = {.step = step_hold, .stop = cm1e_axis_stop_by_ramp, .holds = true};

/* Whether the set-point is on a ramp without a limit of jerk, which ends with a step of its acceleration. */
static bool on_hard_ramp(const cm1e_axis_t *axis)
{
    const cm1e_profile_t *profile = &axis->setpoint.profile;
    if (axis->setpoint.source != &cm1e_source_profile || profile->segment_count == 0)
        return false;
    const cm1e_profile_segment_t *last = &profile->segments[profile->segment_count - 1];
    return last->jerk == 0.0 && last->start.acceleration != 0.0;
}

/* What follows from the set-point of the cycle. */
static inline void after_set_point(cm1e_axis_t *axis)
{
    axis->setpoint.brakes_hard = on_hard_ramp(axis);
    /* Note 6: MC_Stop done and its Execute FALSE. */
    if (axis->state == CM1E_AXIS_STOPPING && axis_holds(axis) && !axis->commands.stop_held &&
        !axis->homing_step.after_stop)
        cm1e_axis_go(axis, ON_STOP_RELEASED);
    if (axis_holds(axis) && !axis->commands.active && axis->commands.waiting.count > 0) { /* after a homing */
        const from_t from = from_set(axis);
        (void)cm1e_axis_begin_waiting(axis, &from, 0.0);
    }
}

void cm1e_axis_motion_turned(cm1e_axis_t *axis, bool made)
{
    if (!made && axis_on_profile(axis))
        cm1e_axis_profile_step(axis);
    after_set_point(axis);
}

void cm1e_axis_motion_step(cm1e_axis_t *axis)
{
    if (axis_stepping(axis) || (axis->state == CM1E_AXIS_STOPPING && axis->homing_step.after_stop))
        axis->homing_hooks->step_cycle(axis);
    if (!axis_holds(axis))
        cm1e_axis_in_position_leave(axis);
    if (axis->setpoint.source == &cm1e_source_profile) /* the common case: it saves a call by pointer */
        cm1e_axis_profile_step(axis);
    else if (!axis->setpoint.source->step(axis) && axis_on_profile(axis))
        cm1e_axis_profile_step(axis);
    after_set_point(axis);
}

/* The correction of the position loop. While inputs are missing the last correction stays, and an offline ramp of
 * ErrorStop has none. When the actual velocity contradicts the actual position, the last correction stays too at first,
 * and then there is none. Else an actual position that stays the same would drive the motor faster and faster. */
static double loop_velocity(const cm1e_axis_t *axis, double lag)
{
    if (cm1e_drive_contradicts_itself(&axis->drive))
        return 0.0;
    if (axis->drive.feedback.fresh && axis->drive.actual.contradictions == 0)
        return csv_position_gain * lag;
    return axis->state == CM1E_AXIS_ERROR_STOP ? 0.0 : axis->setpoint.loop_velocity;
}

static double lag(const cm1e_axis_t *axis) { return cm1e_position_minus(axis->setpoint.position, axis_actual(axis)); }

/* The actual position is from before the pause, in which the motor has gone on with the set velocity and the last
 * correction. So the lag of then is less what that correction has made up, which is all of it at most: a motor that a
 * long pause has taken beyond is not known here. Without this the last correction would stay for as long as every cycle
 * is late, and the lag would grow. */
void cm1e_axis_loop_after_pause(cm1e_axis_t *axis, double pause_s)
{
    const double step = axis->setpoint.velocity * axis->position.scale * axis->cycle_s;
    const double made_up = axis->setpoint.loop_velocity * smaller(pause_s, 1.0 / csv_position_gain);
    axis->setpoint.loop_velocity = loop_velocity(axis, lag(axis) + step - made_up);
}

/* The target velocity with the correction, at most the maximum velocity. Motors stay far below 2^31 counts/s. */
static int32_t target_velocity(cm1e_axis_t *axis)
{
    const double most = axis->limits.system.velocity * fabs(axis->position.scale) + axis->backlash.velocity;
    if (axis->silence.resumed != RESUMED_FROM_PAUSE)
        axis->setpoint.loop_velocity = loop_velocity(axis, lag(axis));
    const double velocity = axis->setpoint.velocity * axis->position.scale + cm1e_axis_backlash_velocity(axis) +
                            axis->setpoint.loop_velocity;
    return (int32_t)round(larger(-most, smaller(velocity, most)));
}

void cm1e_axis_write_set_point(cm1e_axis_t *axis)
{
    cm1e_drive_command_t *command = &axis->drive.command;
    /* The drive's counts differ from ours only by multiples of 2^32. */
    command->target_position = (int32_t)(uint32_t)(uint64_t)cm1e_axis_motor_target(axis);
    if (axis->mode == CM1E_MODE_CSV)
        command->target_velocity = target_velocity(axis);
    else if (cm1e_drive_is_virtual(&axis->drive)) /* shown as its actual velocity; whole counts are too coarse */
        command->target_velocity = (int32_t)round(axis->setpoint.velocity * axis->position.scale);
    else if (axis->setpoint.source->write)
        axis->setpoint.source->write(axis);
}
