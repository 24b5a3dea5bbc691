/**
 * @file axis_events.h
 * How motions report to the commands (axis_events_t).
 */
#ifndef CM1E_AXIS_AXIS_EVENTS_H
#define CM1E_AXIS_AXIS_EVENTS_H

#include "axis/axis_parts.h"

/** Begins a waiting command at the end of a motion: see cm1e_axis_begin_next(). */
static inline bool cm1e_axis_begin_waiting(cm1e_axis_t *axis, const from_t *from, double offset_s)
{
    return axis->events->begin_waiting(axis, from, offset_s);
}
/** The axis cannot go on: ErrorStop. */
static inline void cm1e_axis_fail(cm1e_axis_t *axis, cm1e_error_t error, double value, double bound)
{
    axis->events->failed(axis, error, value, bound, &axis->limits.emergency);
}
/** Like cm1e_axis_fail(), but the ramp has at most this deceleration, u/s2. */
static inline void cm1e_axis_fail_gently(cm1e_axis_t *axis, cm1e_error_t error, double deceleration)
{
    cm1e_motion_limits_t ramp = axis->limits.emergency;
    ramp.deceleration = fmin(ramp.deceleration, deceleration);
    axis->events->failed(axis, error, 0.0, 0.0, &ramp);
}

#endif
