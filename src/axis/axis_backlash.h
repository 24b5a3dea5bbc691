/**
 * @file axis_backlash.h
 * Backlash: the gap between motor and load (axis_backlash.c).
 */
#ifndef CM1E_AXIS_AXIS_BACKLASH_H
#define CM1E_AXIS_AXIS_BACKLASH_H

#include "axis/axis_extras.h"

void cm1e_axis_backlash_init(cm1e_axis_t *axis); /* @rt init; after the limits */
/** Position of the motor relative to its load, in counts; 0 without backlash. */
double cm1e_axis_backlash_offset(const cm1e_axis_t *axis);
/** Velocity of the motor relative to its load, in counts/s. */
double cm1e_axis_backlash_velocity(const cm1e_axis_t *axis);
/** Way of a motor without torque relative to its load in this cycle, in counts. */
double cm1e_axis_backlash_slip(const cm1e_axis_t *axis);
bool cm1e_axis_backlash_at_rest(const cm1e_axis_t *axis);
/** Whether the offset is what the positions of the motor say: without torque it may take as long as a crossing. */
bool cm1e_axis_backlash_is_seen(const cm1e_axis_t *axis);
/* The next two are called only for an axis with a gap. */
void cm1e_axis_backlash_track(cm1e_axis_t *axis, int32_t moved_counts);
void cm1e_axis_backlash_step(cm1e_axis_t *axis);

/** The motor did not follow the compensation: its velocity becomes 0. */
static inline void cm1e_axis_backlash_stop(cm1e_axis_t *axis) { axis->backlash.offset_velocity = 0.0; }
/** The position of the load for a position of the motor. */
static inline position_t cm1e_axis_load(const cm1e_axis_t *axis, int64_t motor_counts)
{
    const position_t motor = {motor_counts, 0.0};
    return axis_has_extra(axis, EXTRA_BACKLASH) ? cm1e_position_plus(motor, -cm1e_axis_backlash_offset(axis)) : motor;
}
/** The actual position of the axis: that of the load. */
static inline position_t axis_actual(const cm1e_axis_t *axis)
{
    return cm1e_axis_load(axis, axis->position.actual_counts);
}
/** Its actual velocity, counts/s: that of the motor, without the way of the backlash. */
static inline double axis_actual_velocity(const cm1e_axis_t *axis)
{
    return axis->drive.feedback.velocity - cm1e_axis_backlash_velocity(axis);
}
/** The target position of the motor for the set-point, in whole counts. */
static inline int64_t cm1e_axis_motor_target(const cm1e_axis_t *axis)
{
    const position_t target = axis_has_extra(axis, EXTRA_BACKLASH)
                              ? cm1e_position_plus(axis->setpoint.position, cm1e_axis_backlash_offset(axis))
                                                       : axis->setpoint.position;
    return target.counts + (target.fraction >= 0.5);
}

#endif
