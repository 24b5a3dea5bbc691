/**
 * @file approach.h
 * The way of a slave into step with its master (Part 1, 4.3 and 4.7): a curve over the master's position from what the
 * slave does now to what it shall do at the point of synchronisation. As it depends on the master's position alone, a
 * master that stops, or turns round on the way, has the slave stop and come back along it. Pure functions, no clock, no
 * heap. @rt cycle throughout.
 */
#ifndef CM1E_MOTION_APPROACH_H
#define CM1E_MOTION_APPROACH_H

#include "cm1e/mc_types.h"
#include "motion/curve.h"

/** What a curve asks of the slave while its master goes at a constant speed: absolute values. `deceleration` is that
 *  of `acceleration`, without regard of what grows. */
void cm1e_approach_demand(const cm1e_curve_extremes_t *extremes, double master_velocity, cm1e_motion_limits_t *demand);
/** Which place of a modulo slave to go to, of those that are `turn` apart from `end`. `start` and `slope` are those of
 *  the slave where the way begins, `ratio` the slope at its end, `way` (signed) what the master goes on it. mcCatchUp:
 *  the first that takes a mean slope of at least the ratio, mcSlowDown: of at most the ratio; mcShortest: the one for
 *  which the slope changes least. `turn` 0, a linear slave: `end`. */
double cm1e_approach_end(MC_SYNC_MODE mode, double start, double slope, double end, double ratio, double way,
                         double turn);

#endif
