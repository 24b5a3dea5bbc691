/**
 * @file random_master.h
 * On axes_bench.h: an axis that drives about at random, as a master for others: velocities in both directions, ways,
 * halts, one taking over from the other at any time.
 */
#ifndef CM1E_TESTS_RANDOM_MASTER_H
#define CM1E_TESTS_RANDOM_MASTER_H

#include "axes_bench.h"
#include "chance.h"

/** What it may do; u of the master. */
typedef struct random_master {
    int axis;
    cm1e_motion_limits_t most;
    double middle;      /**< u, along the line; it drives around this place, if `far` is finite */
    double far;         /**< u, maximum distance from `middle` */
    unsigned seldom;    /**< cycles from one command to the next, about */
} random_master_t;

/** The part of the master's own limits, and of a follower's at this ratio (u of the follower by u of the master), that
 *  leaves `room` of both. */
random_master_t random_master_for(int axis, int follower, double ratio, double part);

/** What both may do. */
random_master_t random_master_of_both(random_master_t one, const random_master_t *other);
void random_master_command(const random_master_t *master);

/** In every cycle, before the outputs. */
void random_master_drive(const random_master_t *master);

#endif
