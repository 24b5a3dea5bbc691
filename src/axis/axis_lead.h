/**
 * @file axis_lead.h
 * Axes that are led from a room above: by a group (axis_lead.c).
 */
#ifndef CM1E_AXIS_AXIS_LEAD_H
#define CM1E_AXIS_AXIS_LEAD_H

#include "axis/axis_parts.h"

static inline bool axis_led(const cm1e_axis_t *axis) { return axis->leader != NULL; }
/** Ends the lead, and tells the leader. */
void cm1e_axis_lead_end(cm1e_axis_t *axis, cm1e_error_t error); /* axis_free.c */
/** ErrorStop by a lost bus. In CSV all axes of a leader brake in the same time, so that they stay on their line. */
void cm1e_axis_lead_fail(cm1e_axis_t *axis, cm1e_error_t error);

#endif
