/**
 * @file axis_in_position.h
 * Whether the motor is where its set-point stands (axis_in_position.c).
 */
#ifndef CM1E_AXIS_AXIS_IN_POSITION_H
#define CM1E_AXIS_AXIS_IN_POSITION_H

#include "axis/axis.h"

typedef struct in_position {
    bool inside;                /**< where it was seen last, the motor is in the window; FALSE: the set-point moves */
    bool there;                 /**< ... and has been for the time */
    bool done_waits;
    bool missed;                /**< an error ended a command that waited */
    cm1e_command_id_t settling; /**< the command that waits for the motor while it is active and the axis holds */
    int64_t inside_ns;          /**< since when */
    int64_t arrived_ns;         /**< since when the set-point of that command stands */
    double window;              /**< u, to either side */
    uint32_t time_us, timeout_us;
    float torque;               /**< % of rated torque, while it waited last: a fault takes it away; NAN: not known */
    double missed_actual, missed_by; /**< for the text; u */
} in_position_t;

void cm1e_axis_in_position_init(cm1e_axis_t *axis); /* @rt init; after limits and mode */
/** The set-point stands, and the motor has been there for the time that is asked for. */
bool cm1e_axis_in_position(const cm1e_axis_t *axis);
/** In every cycle in which the axis holds. */
void cm1e_axis_in_position_step(cm1e_axis_t *axis);
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

#endif
