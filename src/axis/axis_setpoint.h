/**
 * @file axis_setpoint.h
 * The set-point of every cycle: where it comes from, where it is, and the profile that it is on. axis_motion.c samples
 * profiles; the other sources (axis_source.h) write the set-point itself.
 */
#ifndef CM1E_AXIS_AXIS_SETPOINT_H
#define CM1E_AXIS_AXIS_SETPOINT_H

#include "axis/axis_move.h"

typedef struct setpoint {
    const source_t *source;         /**< cm1e_axis_set_source() */
    bool reached, positive_before;
    bool paused;                    /**< its end is not that of its command, which waits (MC_SetOverride) */
    bool stands;                    /**< the base has come to its end, only a superimposed motion goes on */
    bool brakes_hard;               /**< the set-point is one of a ramp without limit of jerk */
    position_t position;            /**< set position */
    position_t base, target;        /**< base: where the profile began; target: where it ends, exactly */
    double velocity, acceleration;  /**< set velocity and acceleration; u/s, u/s2 */
    double base_line;               /**< u; cm1e_axis_line() of base */
    int64_t profile_cycles;         /**< since it began ... */
    double profile_offset_s;        /**< ... so long before the first of them */
    double profile_next_s;          /**< its time in the next cycle */
    cm1e_profile_stretch_t stretch; /**< of it, the one that the set-point is in */
    double loop_velocity;           /**< counts/s that the position loop adds in CSV */
    cm1e_profile_t profile;         /**< relative to base, in u; along a table only its duration and end */
} setpoint_t;

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
