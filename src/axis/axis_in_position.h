/**
 * @file axis_in_position.h
 * Whether the motor is at its set-point while that is at rest (axis_in_position.c).
 */
#ifndef CM1E_AXIS_AXIS_IN_POSITION_H
#define CM1E_AXIS_AXIS_IN_POSITION_H

#include "axis/axis_setpoint.h"

void cm1e_axis_in_position_init(cm1e_axis_t *axis); /* @rt init; after limits and mode */
/** Whether the set-point is at rest and the motor has been at it for the configured time. */
bool cm1e_axis_in_position(const cm1e_axis_t *axis);
/** Called in every cycle in which the axis holds. */
void cm1e_axis_in_position_step(cm1e_axis_t *axis);
/** Called when the set-point moves. */
static inline void cm1e_axis_in_position_leave(cm1e_axis_t *axis) { axis->in_position.inside = false; }
/** Called when the set-point of the active command has arrived. true: the command stays active, in its state of the
 *  diagram, until the motor is there. */
bool cm1e_axis_settle(cm1e_axis_t *axis);
/** Ends the wait for the motor: the command is Done, because another one goes on from its end. */
void cm1e_axis_settled(cm1e_axis_t *axis);
/** The motor did not come to rest at its set-point, or its target, in time: the command and the axis fail. `missed_by`:
 *  how far it is beyond it; u. */
void cm1e_axis_in_position_fail(cm1e_axis_t *axis, double missed_by);
/** Called when all commands end. */
void cm1e_axis_in_position_ended(cm1e_axis_t *axis, bool by_error);
void cm1e_axis_in_position_text(const cm1e_axis_t *axis, char *text, size_t size);
/** Adds to the text of a fault where the motor was, if a command waited for it. */
void cm1e_axis_in_position_add(const cm1e_axis_t *axis, char *text, size_t size);
/** Whether a command stays active only until the motor is there. */
static inline bool axis_settling(const cm1e_axis_t *axis)
{
    return axis->commands.active != 0 && axis->commands.active == axis->in_position.settling && axis_holds(axis);
}

#endif
