/**
 * @file observer.h
 * Estimates position, velocity and acceleration of a master from its counts. They are measured once a cycle, quantised,
 * noisy and delayed, and some are lost. The observer is a critically damped tracking filter of third order (the weight
 * of a sample falls by e in a time constant). It has no lag at constant velocity or constant acceleration. Positions
 * stay exact over any number of counts. Pure functions, no clock, no heap. @rt cycle throughout.
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

/** The estimate for the present moment: the master is at `counts` + `offset`. */
typedef struct cm1e_observed {
    int64_t counts;
    double offset, velocity, acceleration;
} cm1e_observed_t;

/** Starts at rest at `counts`. `delay_s` is the age of a measured value. A time constant of 0 selects no filter, but
 *  the parabola through the last three samples. */
void cm1e_observer_init(cm1e_observer_t *observer, double cycle_s, double time_constant_s, double delay_s,
                        int64_t counts);
/** Restarts at rest at `counts`, after a jump that is not a motion of the master. */
void cm1e_observer_reset(cm1e_observer_t *observer, int64_t counts);
/** Takes one sample per cycle. `valid` false: no sample came, and the master is assumed to go on unchanged. */
void cm1e_observer_step(cm1e_observer_t *observer, int64_t counts, bool valid);
/** The same for a sample that does not come when it should: `since_s` after the last one, and `delay_s` old. */
void cm1e_observer_step_after(cm1e_observer_t *observer, double since_s, double delay_s, int64_t counts, bool valid);
cm1e_observed_t cm1e_observer_now(const cm1e_observer_t *observer);

#endif
