/**
 * @file axis_outside.h
 * Set-points from outside: a program gives a position in every cycle, which another planner has computed
 * (axis_outside.c).
 */
#ifndef CM1E_AXIS_AXIS_OUTSIDE_H
#define CM1E_AXIS_AXIS_OUTSIDE_H

#include "axis/axis_parts.h"

/** Whether set-points from outside move the axis. */
static inline bool axis_from_outside(const cm1e_axis_t *axis)
{
    return axis->setpoint.source == &cm1e_source_outside;
}
cm1e_error_t cm1e_axis_outside_start(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id);
/** Explains why set-points from outside were refused, and why the axis has stopped without them. */
void cm1e_axis_outside_refused_text(const cm1e_axis_t *axis, char *text, size_t size);
void cm1e_axis_outside_missing_text(const cm1e_axis_t *axis, char *text, size_t size);

#endif
