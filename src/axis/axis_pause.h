/**
 * @file axis_pause.h
 * Cycles in which the motor did not take part, or perhaps did not (axis_pause.c).
 */
#ifndef CM1E_AXIS_AXIS_PAUSE_H
#define CM1E_AXIS_AXIS_PAUSE_H

#include "axis/axis_parts.h"

/** Before the set-point of the first cycle in which a frame has come back again. */
void cm1e_axis_after_silence(cm1e_axis_t *axis);
/** Counts by which a motor has gone on in a silence that ended just now (CSV). */
double cm1e_axis_ran_on(const cm1e_axis_t *axis);

#endif
