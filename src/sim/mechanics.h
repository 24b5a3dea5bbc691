/**
 * @file mechanics.h
 * The mechanics on the shaft of a motor: inertia, Coulomb and viscous friction, an external load torque, two hard
 * stops. Positions are counts of the shaft since the simulation began. They are integrated with the semi-implicit Euler
 * method in steps that the caller chooses (at most 250 us); no step can add energy, whatever the parameters. @rt cycle
 * but for init.
 */
#ifndef CM1E_SIM_MECHANICS_H
#define CM1E_SIM_MECHANICS_H

#include <stdbool.h>

#include "cm1e/config.h"

#define CM1E_COUNTS_PER_RADIAN (50000.0 / 6.283185307179586)
/** kg m2 for 1 Nm. Not in the manuals: of the size usual for such motors. */
#define CM1E_ROTOR_INERTIA_PER_PEAK_TORQUE 3e-5

typedef struct cm1e_mechanics {
    double position;         /**< counts */
    double velocity;         /**< counts/s */
    double load_torque;      /**< Nm, from outside, positive drives CW */
    double gain;             /**< counts/s2 that 1 Nm gives */
    double friction;         /**< Nm, Coulomb; as large at rest as in motion */
    double viscous_rate;     /**< 1/s by which viscous friction slows down */
    double stop_positive, stop_negative; /**< counts; infinite: none */
    double peak_velocity;    /**< largest absolute velocity since the last reset of the probe */
    double travel;           /**< sum of absolute movement since then */
    double step_s, damping;  /**< 1 / (1 + viscous_rate * step_s), kept for the step length used last */
} cm1e_mechanics_t;

/** Initialises the mechanics, with the shaft at rest at 0. Zeros in `config` select the defaults of cm1e/config.h. */
void cm1e_mechanics_init(cm1e_mechanics_t *mechanics, const cm1e_sim_axis_config_t *config, double rotor_inertia);
/** Lets `step_s` seconds pass with `torque` Nm from the motor. */
void cm1e_mechanics_step(cm1e_mechanics_t *mechanics, double torque, double step_s);
/** Whether the shaft is at rest and friction holds the load: without motor torque nothing moves. */
bool cm1e_mechanics_at_rest(const cm1e_mechanics_t *mechanics);
/** Pressed against or standing at a hard stop. */
bool cm1e_mechanics_at_stop(const cm1e_mechanics_t *mechanics);

#endif
