/**
 * @file axis_position.h
 * Positions of an axis: counts of the drive without wrap-around, units, turns of a modulo axis, the origin
 * (axis_position.c).
 */
#ifndef CM1E_AXIS_AXIS_POSITION_H
#define CM1E_AXIS_AXIS_POSITION_H

#include "axis/axis_parts.h"

/** A tolerance in counts of this motor, given in counts of a CM1-E. It is at least two counts, because one is rounding.
 *  */
static inline double cm1e_axis_tolerance_counts(const cm1e_axis_t *axis, double counts)
{
    return fmax(counts * axis->position.count, 2.0);
}
/** Whether a distance in u is in the range of the counts. It is not if it is not a number. */
static inline bool cm1e_axis_can_count(const cm1e_axis_t *axis, double units)
{
    return fabs(units * axis->position.scale) < (double)CM1E_FARTHEST_COUNTS;
}
/** Sets the meaning of counts by the configuration. false: the axis cannot compute with these numbers. @rt init */
bool cm1e_axis_position_init(cm1e_axis_t *axis);
/** Sets MC_ReadAxisInfo.IsHomed. */
static inline void cm1e_axis_set_homed(cm1e_axis_t *axis, bool homed) { axis->position.homed = homed; }
double cm1e_axis_units(const cm1e_axis_t *axis, position_t position);
/** Set and actual position, as they are shown. */
void cm1e_axis_shown(const cm1e_axis_t *axis, double *set, double *actual);
/** A position in u without the turns of a modulo axis, as limits are compared with it. */
double cm1e_axis_line(const cm1e_axis_t *axis, position_t position);
/** Counts of a distance in u, without the direction of the motor. */
static inline double cm1e_axis_to_counts(const cm1e_axis_t *axis, double units)
{
    return units * axis->position.unit.counts / axis->position.unit.units;
}
/** The inverse of cm1e_axis_line(); false: not finite, or outside the range of the counts. */
static inline bool cm1e_axis_position_from_line(const cm1e_axis_t *axis, double line, position_t *position)
{
    const double from_origin = axis->position.modulo_range > 0.0 ? line : line - axis->position.origin_units;
    const double counts = cm1e_axis_to_counts(axis, from_origin);
    if (!(fabs(counts) < (double)CM1E_FARTHEST_COUNTS))
        return false;
    *position = cm1e_position_plus(axis->position.origin, axis->position.scale > 0.0 ? counts : -counts);
    return cm1e_position_in_range(*position);
}
/** The inverse of cm1e_axis_units(); false: not finite, or outside the range of the counts. */
bool cm1e_axis_position_from_units(const cm1e_axis_t *axis, double units, position_t *position);
/** mcCurrentDirection of an axis with this velocity (u/s): at standstill it is the direction of the last motion. */
static inline bool cm1e_axis_goes_positive(const cm1e_axis_t *axis, double velocity)
{
    return velocity != 0.0 ? velocity > 0.0 : axis->setpoint.positive_before;
}
/** The target of a command to `position` (u) that begins at `from` with `velocity` (u/s). On a linear axis it is that
 *  position, whatever the direction. On a modulo axis it is the first repetition in the commanded direction beyond the
 *  point where the axis can stop, `stop` (u, signed) after `from`. The shortest way is judged at `from`. */
cm1e_error_t cm1e_axis_resolve_target(const cm1e_axis_t *axis, double position, MC_DIRECTION direction,
                                      position_t from, double velocity, double stop, position_t *target);
/** MC_SetPosition: the new value of the actual position `now`; false: out of range. */
bool cm1e_axis_new_position(const cm1e_axis_t *axis, double now, double position, bool relative, double *value);
/** Sets the coordinates: the position `at` is `units`. On a modulo axis `units` is less than a turn. */
void cm1e_axis_set_origin(cm1e_axis_t *axis, position_t at, double units);
/** u; the approximate end of the range of the counts. */
double cm1e_axis_farthest(const cm1e_axis_t *axis);
void cm1e_axis_track(cm1e_axis_t *axis);
void cm1e_axis_set_to_actual(cm1e_axis_t *axis);

#endif
