/**
 * @file axis_driving.h
 * Motions that a drive makes by itself.
 */
#ifndef CM1E_AXIS_AXIS_DRIVING_H
#define CM1E_AXIS_AXIS_DRIVING_H

#include "axis/axis_parts.h"

/* axis_drive_profile.c */
/** Checks a command that begins at standstill; nothing has changed then. */
cm1e_error_t cm1e_axis_drive_prepare(cm1e_axis_t *axis, const from_t *from, move_t *move, driving_t *d);
void cm1e_axis_drive_begin(cm1e_axis_t *axis, const driving_t *d);

#endif
