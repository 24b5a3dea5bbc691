/**
 * @file observer.h
 * Position, velocity and acceleration of a master from its counts, measured once a cycle: quantised, noisy, some time
 * old, some of them lost. A tracking filter of third order, critically damped (a fading memory: the weight of a sample
 * falls by e in a time constant), so no velocity and no constant acceleration makes it lag. Positions stay exact over
 * any number of counts. Pure functions, no clock, no heap. @rt cycle throughout.
 */
#ifndef CM1E_MOTION_OBSERVER_H
#define CM1E_MOTION_OBSERVER_H

#include <stdbool.h>
#include <stdint.h>

typedef struct cm1e_observer {
    double cycle_s, delay_s;
    double position_gain, velocity_gain, acceleration_gain;
    int64_t counts;                         /**< whole counts near the estimate */
    double offset, velocity, acceleration;  /**< the estimate: counts from there, counts/s, counts/s2 */
} cm1e_observer_t;

/** What is estimated for now: the master is at `counts` + `offset`. */
typedef struct cm1e_observed {
    int64_t counts;
    double offset, velocity, acceleration;
} cm1e_observed_t;

/** `delay_s`: how old a measured value is when it comes. A time constant of 0: no filter, but the parabola through
 *  the last three samples. At rest at `counts`. */
void cm1e_observer_init(cm1e_observer_t *observer, double cycle_s, double time_constant_s, double delay_s,
                        int64_t counts);
/** A jump that is none of the master: at rest at `counts`. */
void cm1e_observer_reset(cm1e_observer_t *observer, int64_t counts);
/** Once a cycle; `valid` FALSE: no sample came, and the master is taken to go on as it did. */
void cm1e_observer_step(cm1e_observer_t *observer, int64_t counts, bool valid);
cm1e_observed_t cm1e_observer_now(const cm1e_observer_t *observer);

#endif
