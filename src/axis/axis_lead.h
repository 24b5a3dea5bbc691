/**
 * @file axis_lead.h
 * Axes whose set-points somebody above gives: a group (axis_lead.c).
 */
#ifndef CM1E_AXIS_AXIS_LEAD_H
#define CM1E_AXIS_AXIS_LEAD_H

#include "axis/axis_parts.h"

static inline bool axis_led(const cm1e_axis_t *axis) { return axis->leader.next != NULL; }
/** What leads the axis is told that it does so no longer. */
void cm1e_axis_lead_end(cm1e_axis_t *axis, cm1e_error_t error); /* axis_free.c */
/** ErrorStop by a lost bus: in CSV all that are led together brake in the same time, which keeps them on a line. */
void cm1e_axis_lead_fail(cm1e_axis_t *axis, cm1e_error_t error);

#endif
