/**
 * @file reference.h
 * Moves the reference of a simulated motor's servo: ramps, trapezoidal moves, the line between the targets of cyclic
 * synchronous position. @rt cycle.
 */
#ifndef CM1E_SIM_REFERENCE_H
#define CM1E_SIM_REFERENCE_H

#include "sim/servo.h"

/** Moves `*velocity` towards `wanted` by at most acceleration * step. */
void cm1e_sim_ramp(double *velocity, double wanted, double acceleration, double step_s);
/** Makes one step of a trapezoidal move of the servo's reference to `target`. Returns true when it is at rest there. */
bool cm1e_sim_move_step(cm1e_servo_t *servo, double target, double velocity, double acceleration, double step_s);

/** Where the reference comes to rest if it brakes now. */
double cm1e_sim_stopping_place(const cm1e_servo_t *servo, double acceleration);
/** Makes one step of a ramp to rest. */
void cm1e_sim_halt_step(cm1e_servo_t *servo, double acceleration, double step_s);

/** Straight lines from one cyclic target to the next. Targets are not checked: a target that is not the actual position
 *  makes the motor jump. */
typedef struct cm1e_sim_line {
    double goal;     /**< counts, on the scale of the mechanics */
    double velocity; /**< counts/s */
    double slot_s;   /**< time since the line to the goal began */
} cm1e_sim_line_t;

/** Sets the reference to rest at `goal`. */
void cm1e_sim_line_begin(cm1e_sim_line_t *line, cm1e_servo_t *servo, double goal);
/** Takes a target of the process data, which comes every `cycle_s`. */
void cm1e_sim_line_target(cm1e_sim_line_t *line, double goal, double cycle_s);
void cm1e_sim_line_step(cm1e_sim_line_t *line, cm1e_servo_t *servo, double cycle_s, double step_s);

#endif
