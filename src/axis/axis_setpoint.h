/**
 * @file axis_setpoint.h
 * The set-point of every cycle: where it comes from, where it is, and the profile that it is on. axis_motion.c samples
 * profiles; the other sources (axis_source.h) write the set-point itself.
 */
#ifndef CM1E_AXIS_AXIS_SETPOINT_H
#define CM1E_AXIS_AXIS_SETPOINT_H

#include "axis/axis_parts.h"

/* Where the set-point comes from. */
static inline void cm1e_axis_set_source(cm1e_axis_t *axis, const source_t *source)
{
    if (axis->setpoint.source != source && axis->setpoint.source->leave)
        axis->setpoint.source->leave(axis);
    axis->setpoint.source = source;
}
static inline bool axis_free(const cm1e_axis_t *axis) { return axis->setpoint.source->is_free; }
static inline bool axis_holds(const cm1e_axis_t *axis) { return axis->setpoint.source->holds; }
/** A profile, or a table over time, which is one too. */
static inline bool axis_on_profile(const cm1e_axis_t *axis) { return axis->setpoint.source->find_stretch != NULL; }
/** F of a coupling is what moves the axis. */
static inline bool axis_follows(const cm1e_axis_t *axis) { return axis->setpoint.source->follows; }
/** Set-points of ours change from cycle to cycle. */
static inline bool set_points_move(const cm1e_axis_t *axis) { return axis->setpoint.source->moves; }
/** The drive moves, or is about to, by itself. */
static inline bool drive_moves(const cm1e_axis_t *axis) { return axis->setpoint.source->by_drive; }
/** ... in its homing. */
static inline bool drive_homes(const cm1e_axis_t *axis) { return axis->setpoint.source->homes; }
/** The axis's motions are the drive's: `motion: drive`. */
static inline bool drive_profiles(const cm1e_axis_t *axis) { return axis->config->motion == CM1E_MOTION_DRIVE; }
/** Set-points of ours reach the motor. */
static inline bool axis_acts(const cm1e_axis_t *axis)
{
    return axis->drive.feedback.enabled && axis->drive.feedback.mode == (int8_t)axis->mode;
}

/** The axis's own half of cm1e_axis_outputs(): state diagram and set-point, before they become the drive's. */
void cm1e_axis_advance(cm1e_axis_t *axis);
/** A profile takes over that began at `from`, `offset_s` before the present set-point. */
void cm1e_axis_run(cm1e_axis_t *axis, const from_t *from, const cm1e_profile_t *profile, position_t target,
                   double offset_s);
/** Of any source that is a profile. */
void cm1e_axis_begin_run(cm1e_axis_t *axis, const source_t *source, const from_t *from, position_t target,
                         double offset_s);
/** Down to standstill without a command. */
void cm1e_axis_ramp_down(cm1e_axis_t *axis, const cm1e_motion_limits_t *limits);
/** The same, as sources have it whose set-points are ours. */
void cm1e_axis_stop_by_ramp(cm1e_axis_t *axis, const cm1e_motion_limits_t *ramp, home_goal_t goal);
/** The profile's functions, which a table over time shares. */
bool cm1e_axis_profile_step(cm1e_axis_t *axis);
bool cm1e_axis_profile_goes(cm1e_axis_t *axis, double sign);
/** Motion in the direction of `sign` is no longer enabled (MC_Power, 3.1): a command that goes there fails, the next
 *  one begins, or the axis stops. */
void cm1e_axis_direction_disabled(cm1e_axis_t *axis, double sign);
/** The set-point stands at the end of its profile. */
void cm1e_axis_stand(cm1e_axis_t *axis);
void cm1e_axis_motion_step(cm1e_axis_t *axis);
void cm1e_axis_write_set_point(cm1e_axis_t *axis);

#endif
