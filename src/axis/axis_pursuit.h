/**
 * @file axis_pursuit.h
 * A motor that has run ahead of its set-point while it got no targets (axis_pursuit.c). @rt cycle.
 */
#ifndef CM1E_AXIS_AXIS_PURSUIT_H
#define CM1E_AXIS_AXIS_PURSUIT_H

#include "axis/axis_extras.h"
#include "axis/axis_parts.h"

/** Called after a pause, before the motion begins anew: the next actual position shows whether the motor has run
 *  ahead. */
void cm1e_axis_pursuit_prepare(cm1e_axis_t *axis, double unheard_s);
/** Called after a silence, before the motion begins anew. true: the motor has run ahead, and the set-point goes after
 *  it from this cycle on. */
bool cm1e_axis_pursuit_begin(cm1e_axis_t *axis);
/** Called when the bus is lost, before the set-point is held: where a load turns the motor on, it is held near the
 *  place where it comes to rest. */
void cm1e_axis_pursuit_hold(cm1e_axis_t *axis);
/** Whether a motor that has run ahead may be beyond the limit of the lag, and brakes all the same. */
static inline bool cm1e_axis_may_lead(const cm1e_axis_t *axis) { return axis_has_extra(axis, EXTRA_PURSUIT); }
/** u/s; the velocity of the axis before its motor got no targets, or its set velocity. */
double cm1e_axis_pursuit_velocity(const cm1e_axis_t *axis);
/** Called in every cycle with EXTRA_PURSUIT. true: it has made the set-point of this cycle. */
bool cm1e_axis_pursue(cm1e_axis_t *axis);

#endif
