/**
 * @file axis_in_position.h
 * Whether the motor is where its set-point stands (axis_in_position.c).
 */
#ifndef CM1E_AXIS_AXIS_IN_POSITION_H
#define CM1E_AXIS_AXIS_IN_POSITION_H

#include "axis/axis_setpoint.h"

void cm1e_axis_in_position_init(cm1e_axis_t *axis); /* @rt init; after limits and mode */
/** The set-point stands, and the motor has been there for the time that is asked for. */
bool cm1e_axis_in_position(const cm1e_axis_t *axis);
/** In every cycle in which the axis holds. */
void cm1e_axis_in_position_step(cm1e_axis_t *axis);
/** The set-point moves. */
static inline void cm1e_axis_in_position_leave(cm1e_axis_t *axis) { axis->in_position.inside = false; }
/** The set-point of the active command has arrived and stands. TRUE: the command stays active until the motor is
 *  there, in its state of the diagram. */
bool cm1e_axis_settle(cm1e_axis_t *axis);
/** Such a command is Done now, also where the motor is not there yet: another one goes on from its end. */
void cm1e_axis_settled(cm1e_axis_t *axis);
/** All commands end. */
void cm1e_axis_in_position_ended(cm1e_axis_t *axis, bool by_error);
void cm1e_axis_in_position_text(const cm1e_axis_t *axis, char *text, size_t size);
/** Behind the text of a fault: where the motor was, if something waited for it. */
void cm1e_axis_in_position_add(const cm1e_axis_t *axis, char *text, size_t size);
/** A command stays active for the motor alone. */
static inline bool axis_settling(const cm1e_axis_t *axis)
{
    return axis->commands.active != 0 && axis->commands.active == axis->in_position.settling && axis_holds(axis);
}

#endif
