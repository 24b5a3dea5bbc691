/**
 * @file servo.h
 * The position servo inside a simulated motor: from a reference position and velocity to a motor torque within a limit.
 * @rt cycle.
 */
#ifndef CM1E_SIM_SERVO_H
#define CM1E_SIM_SERVO_H

#include <stdbool.h>

#include "sim/mechanics.h"

typedef struct cm1e_servo {
    double reference;          /**< counts, on the scale of the mechanics */
    double reference_velocity; /**< counts/s */
    double feed_forward;       /**< counts/s, the velocity fed forward */
    double last_velocity;      /**< reference_velocity of the last step */
    bool own_profile;          /**< the reference is a profile of the drive, not a set-point of the master */
    double torque_limit;       /**< Nm */
    double integral;           /**< Nm, holds the load at rest */
    double torque;             /**< Nm, of the last step */
    bool saturated;            /**< the last step was at the limit */
    double stiffness;          /**< Nm per count */
    double damping;            /**< Nm per count/s */
    double step_s, response;   /**< gain of the implicit step, kept for the step length used last */
} cm1e_servo_t;

/** Initialises the servo, tuned to the mechanics like a commissioned drive. */
void cm1e_servo_init(cm1e_servo_t *servo, const cm1e_mechanics_t *mechanics);
/** Starts to hold the present position with no torque. */
void cm1e_servo_catch(cm1e_servo_t *servo, const cm1e_mechanics_t *mechanics);
/** Called where a mode with a velocity begins, which knows no position. What the servo could not make up with all of
 *  its torque, it would keep as a distance behind a reference that runs with the motor, and drive the motor away from
 *  there. */
void cm1e_servo_forget_distance(cm1e_servo_t *servo, const cm1e_mechanics_t *mechanics);
/** For a reference without a target position: when it has stopped and the shaft is at rest, the servo holds that place
 *  with the present torque, and no deviation remains. */
void cm1e_servo_rest(cm1e_servo_t *servo, const cm1e_mechanics_t *mechanics);
/** Moves a reference of velocity on. While the torque limit holds the motor back the reference moves with it: a
 *  velocity servo does not catch up. */
void cm1e_servo_run(cm1e_servo_t *servo, const cm1e_mechanics_t *mechanics, double step_s);
/** Torque for the next `step_s` seconds, at whose end the reference applies. */
double cm1e_servo_step(cm1e_servo_t *servo, const cm1e_mechanics_t *mechanics, double step_s);

#endif
