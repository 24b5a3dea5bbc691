/**
 * @file axis_driving.h
 * Motions that a drive makes by itself, and what they have in common with a homing by the drive (src/homing).
 */
#ifndef CM1E_AXIS_AXIS_DRIVING_H
#define CM1E_AXIS_AXIS_DRIVING_H

#include "axis/axis_parts.h"

/* axis_drive_profile.c */
/** Sets memory aside, if the drive makes the motions. @rt init */
cm1e_error_t cm1e_axis_drive_profile_init(cm1e_axis_t *axis, cm1e_diag_t *diag);
/** Checks a command that begins at standstill; nothing has changed then. */
cm1e_error_t cm1e_axis_drive_prepare(cm1e_axis_t *axis, const from_t *from, move_t *move, driving_t *d);
void cm1e_axis_drive_begin(cm1e_axis_t *axis, const driving_t *d);

/* axis_driving.c */
/** Whether the motor has torque in this mode. */
bool cm1e_axis_acts_in(const cm1e_axis_t *axis, cm1e_mode_t mode);
/** Begins to watch the motor: it counts as moving until it has been at rest for 50 ms. */
void cm1e_axis_watch_standstill(const cm1e_axis_t *axis, standstill_t *standstill);
/** Called in every cycle of the watch: whether the motor is at standstill. An offline drive shows none. */
bool cm1e_axis_is_at_standstill(const cm1e_axis_t *axis, standstill_t *standstill);
/** ns; how long the motor has not moved by then. */
int64_t cm1e_axis_stood(const cm1e_axis_t *axis, const standstill_t *standstill);
/** How long a halt may take whose deceleration takes `braking_s`. A motor with a halt bit gets twice that and a second.
 *  A motor without one, and a motor that nobody sees because the bus is gone, get little more than they need. */
int64_t cm1e_axis_halt_bound_ns(const cm1e_axis_t *axis, double braking_s, bool has_halt);
/** Whether the motion only waits for the end of a torque that is gone already, with the drive in error. */
bool cm1e_axis_has_lost_torque(const cm1e_axis_t *axis, home_goal_t goal);

#endif
