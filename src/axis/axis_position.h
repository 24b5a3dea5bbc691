/**
 * @file axis_position.h
 * Where the axis is: counts of the drive without wrap-around, units, turns of a modulo axis, the origin
 * (axis_position.c).
 */
#ifndef CM1E_AXIS_AXIS_POSITION_H
#define CM1E_AXIS_AXIS_POSITION_H

#include "axis/axis_parts.h"

/** Counts of this motor that are as far as so many of a CM1-E; two at least, as one is rounding. */
static inline double cm1e_axis_few(const cm1e_axis_t *axis, double counts)
{
    return fmax(counts * axis->position.count, 2.0);
}
/** Whether a way of so many u can be counted; what is not a number cannot. */
static inline bool cm1e_axis_can_count(const cm1e_axis_t *axis, double units)
{
    return fabs(units * axis->position.scale) < (double)CM1E_FARTHEST_COUNTS;
}
/** What counts mean, by the configuration. FALSE: numbers that the axis cannot compute with. @rt init */
bool cm1e_axis_position_init(cm1e_axis_t *axis);
/** MC_ReadAxisInfo.IsHomed */
static inline void cm1e_axis_set_homed(cm1e_axis_t *axis, bool homed) { axis->position.homed = homed; }
double cm1e_axis_units(const cm1e_axis_t *axis, position_t position);
/** Set and actual position, as they are shown. */
void cm1e_axis_shown(const cm1e_axis_t *axis, double *set, double *actual);
/** Without the turns of a modulo axis: what limits are compared with. */
double cm1e_axis_line(const cm1e_axis_t *axis, position_t position);
/** The way back; FALSE: not finite, or farther away than the axis counts. */
bool cm1e_axis_position_from_line(const cm1e_axis_t *axis, double line, position_t *position);
/** FALSE: not finite, or farther away than the axis counts. */
bool cm1e_axis_position_from_units(const cm1e_axis_t *axis, double units, position_t *position);
/** Where a command to `position` (u) ends that begins at `from` with `velocity` (u/s): on a linear axis there, whatever
 *  the direction; on a modulo axis the first repetition in that direction, seen from the point where the axis can stop,
 *  `stop` (u, signed) after `from`. The shortest way is judged at `from`. */
cm1e_error_t cm1e_axis_resolve_target(const cm1e_axis_t *axis, double position, MC_DIRECTION direction,
                                      position_t from, double velocity, double stop, position_t *target);
/** MC_SetPosition: what the actual position `now` becomes; FALSE: out of range. */
bool cm1e_axis_new_position(const cm1e_axis_t *axis, double now, double position, bool relative, double *value);
/** From now on the axis is at `units` when it is at `at`; on a modulo axis `units` is less than a turn. */
void cm1e_axis_set_origin(cm1e_axis_t *axis, position_t at, double units);
/** u; about where that range ends. */
double cm1e_axis_farthest(const cm1e_axis_t *axis);
void cm1e_axis_track(cm1e_axis_t *axis);
void cm1e_axis_set_to_actual(cm1e_axis_t *axis);

#endif
