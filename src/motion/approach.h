/**
 * @file approach.h
 * The approach of a slave to its master (Part 1, 4.3 and 4.7): a curve over the master's position, from the present
 * motion of the slave to its motion at the synchronisation point. The curve depends only on the master's position, so
 * the slave stops if the master stops, and goes back along the curve if the master reverses. Pure functions, no clock,
 * no heap. @rt cycle throughout.
 */
#ifndef CM1E_MOTION_APPROACH_H
#define CM1E_MOTION_APPROACH_H

#include "cm1e/mc_types.h"
#include "motion/curve.h"

/** What a curve requires of the slave while its master moves at a constant speed, as absolute values. `deceleration`
 *  equals `acceleration`: rising and falling speed are not distinguished. */
void cm1e_approach_demand(const cm1e_curve_extremes_t *extremes, double master_velocity, cm1e_motion_limits_t *demand);
/** The end position of an approach of a modulo slave: `end`, or a position that is a multiple of `turn` away from it.
 *  `start` and `slope` belong to the slave where the approach begins, `ratio` is the slope at its end, `way` the signed
 *  distance of the master during it. mcCatchUp selects the first position with a mean slope of at least the ratio,
 *  mcSlowDown the first with at most the ratio, mcShortest the one with the smallest change of slope. With `turn` 0, a
 *  linear slave, the result is `end`. */
double cm1e_approach_end(MC_SYNC_MODE mode, double start, double slope, double end, double ratio, double way,
                         double turn);

#endif
