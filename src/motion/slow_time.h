/**
 * @file slow_time.h
 * A motion whose time runs slower for a while: at first by a given part, then faster and faster up to full pace. The
 * path in space stays, and the motion arrives later. Its velocity, acceleration and jerk keep the limits that they keep
 * at full pace. Pure functions, no clock, no heap. @rt cycle throughout.
 *
 * The time of the motion advances by 1 - m in a unit of time, where m (`missing`) falls exponentially: m' = -r m. A
 * velocity v, acceleration a and jerk j of the motion thereby become
 *
 *     (1 - m) v,   (1 - m)^2 a + r m v,   (1 - m)^3 j + 3 (1 - m) r m a - r^2 m v.
 *
 * With |v| <= V, |a| <= A, |j| <= J the second one is at most A if r V <= (2 - m) A, and the third one at most J if
 * r^2 V + 3 r A <= (3 - 3 m) J. The largest r that meets both is used, so all limits are kept whatever the motion does
 * meanwhile.
 */
#ifndef CM1E_MOTION_SLOW_TIME_H
#define CM1E_MOTION_SLOW_TIME_H

#include "motion/profile.h"

typedef struct cm1e_slow_time {
    double missing; /**< 0: full pace */
    double rate;    /**< 1/s; at which that falls */
} cm1e_slow_time_t;

/** From now on the time runs at `factor` (0.5 ... 1) of its present pace, and from there back to its full pace. */
void cm1e_slow_time_begin(cm1e_slow_time_t *slow, double factor);
/** Limits that the motion keeps, and is to keep while its time is slower. Call it for all of them after
 *  cm1e_slow_time_begin(). */
void cm1e_slow_time_keep(cm1e_slow_time_t *slow, const cm1e_motion_limits_t *limits);
/** Goes on by so long. Returns by how much the time of the motion advances; s. */
double cm1e_slow_time_step(cm1e_slow_time_t *slow, double time_s);
/** Makes of the state of the motion at its own time the state at present. The position stays. */
void cm1e_slow_time_apply(const cm1e_slow_time_t *slow, cm1e_motion_state_t *state);

#endif
