/**
 * @file axis_setpoint.h
 * The set-point of every cycle: its source, its state of motion, and its profile. axis_motion.c samples profiles. The
 * other sources (axis_source.h) write the set-point themselves.
 */
#ifndef CM1E_AXIS_AXIS_SETPOINT_H
#define CM1E_AXIS_AXIS_SETPOINT_H

#include "axis/axis_course.h"
#include "axis/axis_extras.h"
#include "axis/axis_position.h"

/* Sets the source of the set-point. */
static inline void cm1e_axis_set_source(cm1e_axis_t *axis, const source_t *source)
{
    if (axis->setpoint.source != source && axis->setpoint.source->leave)
        axis->setpoint.source->leave(axis);
    axis->setpoint.source = source;
    cm1e_axis_look_anew(axis);
}
static inline void cm1e_axis_setpoint_init(cm1e_axis_t *axis) /* @rt init */
{
    axis->setpoint.source = &cm1e_source_free;
    axis->setpoint.positive_before = true;
}
static inline bool axis_free(const cm1e_axis_t *axis) { return axis->setpoint.source->is_free; }
static inline bool axis_holds(const cm1e_axis_t *axis) { return axis->setpoint.source->holds; }
/** Whether the set-point is on a profile or on a table over time. */
static inline bool axis_on_profile(const cm1e_axis_t *axis) { return axis->setpoint.source->find_stretch != NULL; }
/** Whether a coupling function moves the axis. */
static inline bool axis_follows(const cm1e_axis_t *axis) { return axis->setpoint.source->follows; }
/** Whether our set-points change from cycle to cycle. */
static inline bool set_points_move(const cm1e_axis_t *axis) { return axis->setpoint.source->moves; }
/** Whether the drive moves by itself, or is about to. */
static inline bool drive_moves(const cm1e_axis_t *axis) { return axis->setpoint.source->by_drive; }
/** Whether the drive moves by itself in a homing. */
static inline bool drive_homes(const cm1e_axis_t *axis) { return axis->setpoint.source->homes; }
/** Whether the drive makes the motions of the axis (`motion: drive`). */
static inline bool drive_profiles(const cm1e_axis_t *axis) { return axis->config->motion == CM1E_MOTION_DRIVE; }
/** Whether our set-points act on the motor. */
static inline bool axis_acts(const cm1e_axis_t *axis)
{
    return axis->drive.feedback.enabled && axis->drive.feedback.mode == (int8_t)axis->mode;
}

/** Called when that may have changed, or an answer of the bus is missing or has come again. */
static inline void cm1e_axis_note_disturbed(cm1e_axis_t *axis)
{
    cm1e_axis_set_extra(axis, EXTRA_DISTURBED,
                        !axis_acts(axis) || axis->silence.silent_before > 0 || axis->silence.frozen);
}

/** The first half of cm1e_axis_outputs(): state diagram and set-point, before they are written to the drive. */
void cm1e_axis_advance(cm1e_axis_t *axis);
/** cm1e_axis_inputs() and cm1e_axis_advance() for any cycle. Tests compare them with the short ways of an ordinary
 *  cycle. */
void cm1e_axis_inputs_any(cm1e_axis_t *axis, cm1e_error_t received, cm1e_error_t health, int64_t now_ns);
void cm1e_axis_advance_any(cm1e_axis_t *axis);
/** cm1e_axis_inputs() for an ordinary cycle; false, and nothing has changed: it is not one. */
bool cm1e_axis_inputs_ordinary(cm1e_axis_t *axis, cm1e_error_t received, cm1e_error_t health, int64_t now_ns);
/** cm1e_axis_advance() for an ordinary cycle of a move; false, and nothing has changed: it is not one
 *  (axis_ordinary.c). */
bool cm1e_axis_ordinary_step(cm1e_axis_t *axis);
/** cm1e_axis_advance() but for the short ways of a cycle that was decided ahead. It is not inlined, so that these save
 *  no registers. Always true: an axis_otherwise_t. */
bool cm1e_axis_advance_undecided(cm1e_axis_t *axis);
/** cm1e_axis_advance() for an axis in SynchronizedMotion that has nothing to do but to follow its master or leader.
 *  false, and nothing has changed: it has. `*over`: another source has taken over, and the cycle is not complete. */
bool cm1e_axis_led_step(cm1e_axis_t *axis, bool *over);
/** cm1e_axis_advance() of such an axis for a cycle about which everything was decided ahead (source_t.ordinary); false,
 *  and nothing but the masters has changed: it was not. Called before cm1e_axis_led_step(). */
bool cm1e_axis_led_ordinary_step(cm1e_axis_t *axis);
/* What sources write that are no profile of axis_motion.c, and those who change something beside the motion. */
/** Writes the set-point of this cycle. */
static inline void cm1e_axis_put_set_point(cm1e_axis_t *axis, const from_t *point)
{
    axis->setpoint.position = point->position;
    axis->setpoint.velocity = point->velocity;
    axis->setpoint.acceleration = point->acceleration;
    if (point->velocity > 0.0)
        axis->setpoint.positive_before = true;
    else if (point->velocity < 0.0)
        axis->setpoint.positive_before = false;
}
static inline void cm1e_axis_put_position(cm1e_axis_t *axis, position_t position)
{
    axis->setpoint.position = position;
    cm1e_axis_look_anew(axis);
}
/** Moves the set-point to a position without a motion. */
static inline void cm1e_axis_jump(cm1e_axis_t *axis, position_t position)
{
    cm1e_axis_put_position(axis, position);
    axis->setpoint.jumps++;
}
/** Sets the velocity (u/s) and the acceleration (u/s2). */
static inline void cm1e_axis_put_motion(cm1e_axis_t *axis, double velocity, double acceleration)
{
    axis->setpoint.velocity = velocity;
    axis->setpoint.acceleration = acceleration;
    cm1e_axis_look_anew(axis);
}
/** Sets the velocity (u/s), without acceleration. */
static inline void cm1e_axis_put_velocity(cm1e_axis_t *axis, double velocity)
{
    cm1e_axis_put_motion(axis, velocity, 0.0);
}
static inline void cm1e_axis_shift_set_point(cm1e_axis_t *axis, double counts)
{
    cm1e_axis_put_position(axis, cm1e_position_plus(axis->setpoint.position, counts));
}
/** Called when the coordinates have changed. */
static inline void cm1e_axis_renew_base_line(cm1e_axis_t *axis)
{
    axis->setpoint.base_line = cm1e_axis_line(axis, axis->setpoint.base);
    cm1e_axis_look_anew(axis);
}
/** Shifts the begin and the end of the profile by so many counts. */
static inline void cm1e_axis_shift_profile(cm1e_axis_t *axis, double counts)
{
    axis->setpoint.base = cm1e_position_plus(axis->setpoint.base, counts);
    axis->setpoint.target = cm1e_position_plus(axis->setpoint.target, counts);
    cm1e_axis_renew_base_line(axis);
}
/** Shifts the set-point with it; no slave may follow that. */
static inline void cm1e_axis_shift_motion(cm1e_axis_t *axis, double counts)
{
    cm1e_axis_jump(axis, cm1e_position_plus(axis->setpoint.position, counts));
    cm1e_axis_shift_profile(axis, counts);
}
/** Cycles: a profile that ends so shortly after a set-point counts as ended. */
static const double profile_same_moment = 1e-6;
/** Counts: a set-point that is farther from the begin of its profile counts from a new base. At this distance a double
 *  still has a resolution of a millionth of a count. */
static const double profile_farthest_from_base = 0x1p32;
/** Counts a cycle of the profile. The next time is computed a cycle ahead, to keep it out of the way of the next
 *  set-point. */
static inline void cm1e_axis_count_cycle(cm1e_axis_t *axis)
{
    setpoint_t *s = &axis->setpoint;
    s->profile_cycles++;
    s->profile_next_s = s->profile_offset_s + (double)(s->profile_cycles + 1) * axis->cycle_s;
}
/** Sets the duration and the end, which is all that the profile has of a table over time. */
static inline void cm1e_axis_put_duration(cm1e_axis_t *axis, double duration_s, cm1e_motion_state_t end)
{
    axis->setpoint.profile.duration_s = duration_s;
    axis->setpoint.profile.end = end;
    axis->setpoint.profile.segment_count = 0;
    cm1e_axis_look_anew(axis);
}
static inline void cm1e_axis_set_reached(cm1e_axis_t *axis, bool reached)
{
    if (axis->setpoint.reached != reached)
        cm1e_axis_look_anew(axis);
    axis->setpoint.reached = reached;
}
/** Sets whether a follower is still approaching. */
static inline void cm1e_axis_set_synchronizing(cm1e_axis_t *axis, bool on) { axis->setpoint.synchronizing = on; }
/** Of a cam: cm1e_command_status_t.ends */
static inline void cm1e_axis_set_ends(cm1e_axis_t *axis, uint32_t ends) { axis->setpoint.ends = ends; }
static inline void cm1e_axis_set_paused(cm1e_axis_t *axis, bool paused)
{
    axis->setpoint.paused = paused;
    cm1e_axis_look_anew(axis);
}
static inline void cm1e_axis_set_stands(cm1e_axis_t *axis, bool stands)
{
    axis->setpoint.stands = stands;
    cm1e_axis_look_anew(axis);
}

/** Puts a profile in force that began at `from`, `offset_s` before the present set-point. */
void cm1e_axis_run(cm1e_axis_t *axis, const from_t *from, const cm1e_profile_t *profile, position_t target,
                   double offset_s);
/** Begins any source that is a profile. */
void cm1e_axis_begin_run(cm1e_axis_t *axis, const source_t *source, const from_t *from, position_t target,
                         double offset_s);
/** Ramps down to standstill without a command. */
void cm1e_axis_ramp_down(cm1e_axis_t *axis, const cm1e_motion_limits_t *limits);
/** source_t.stop of sources whose set-points are ours: cm1e_axis_ramp_down(). */
void cm1e_axis_stop_by_ramp(cm1e_axis_t *axis, const cm1e_motion_limits_t *ramp, home_goal_t goal);
/** Functions of the profile that a table over time uses too. */
bool cm1e_axis_profile_step(cm1e_axis_t *axis);
/** source_t.step and slowing of a profile whose time can run slower for a while (motion/slow_time.h). */
bool cm1e_axis_timed_step(cm1e_axis_t *axis);
void cm1e_axis_timed_slow(cm1e_axis_t *axis, double part);
bool cm1e_axis_profile_goes(cm1e_axis_t *axis, double sign);
/** Called when MC_Power no longer enables the direction `sign` (3.1). A command in that direction fails, and the next
 *  one begins, or the axis stops. */
void cm1e_axis_direction_disabled(cm1e_axis_t *axis, double sign);
/** Stops the set-point where it is. Its profile ends there. */
void cm1e_axis_hold_here(cm1e_axis_t *axis);
/** Puts the set-point to rest at the end of its profile. */
void cm1e_axis_stand(cm1e_axis_t *axis);
void cm1e_axis_motion_step(cm1e_axis_t *axis);
/** The rest of cm1e_axis_motion_step() after the step of a source that another one has replaced in it. `made`: the step
 *  made the set-point of the cycle. */
void cm1e_axis_motion_turned(cm1e_axis_t *axis, bool made);
void cm1e_axis_write_set_point(cm1e_axis_t *axis);
/** In CSV, in the first cycle after a pause, before the set-point is where the motor has run on to. */
void cm1e_axis_loop_after_pause(cm1e_axis_t *axis, double pause_s);

#endif
