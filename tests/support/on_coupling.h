/**
 * @file on_coupling.h
 * How a superimposed motion is judged: on a slave it keeps its velocity and its distance whatever the master does, so its
 * own jerk may come on top of that of the coupling.
 */
#ifndef CM1E_TESTS_ON_COUPLING_H
#define CM1E_TESTS_ON_COUPLING_H

#include <math.h>

#include "axis/axis_parts.h"

/** What the judge of a cycle needs to know of the cycle before. */
typedef struct on_coupling {
    double jerk;                   /**< u/s3, that may come on top; 0: there is no such motion */
    double velocity, acceleration; /**< of the superimposed motion */
} on_coupling_t;

/** What may come on top of the maximum jerk in this cycle; the end of a motion may be that of the cycle before. */
static inline double jerk_on_coupling(const cm1e_axis_t *axis, on_coupling_t *before)
{
    const bool both = axis->state == CM1E_AXIS_SYNCHRONIZED_MOTION && axis->superimposed.id != 0;
    const double now = both ? axis->superimposed.share.jerk : 0.0, most = fmax(now, before->jerk);
    before->jerk = now;
    return most;
}

/** It is no faster than what it is to reach (VelocityDiff times its factor, 0 where it comes to rest), or than it had to
 *  become, because its acceleration ends with its jerk. */
static inline bool keeps_velocity_diff(const cm1e_axis_t *axis, on_coupling_t *before)
{
    const superimposed_t *on_top = &axis->superimposed;
    const double asked = isnan(on_top->plan.target) ? 0.0 : fmin(on_top->plan.limits.velocity, on_top->share.velocity);
    const double v = before->velocity, a = before->acceleration, jerk = fmin(on_top->plan.limits.jerk, on_top->share.jerk);
    const double peak = fmax(fabs(v), fabs(v + a * fabs(a) / (2.0 * jerk)));
    const bool good = on_top->id == 0 || !on_top->moving ||
                      fabs(on_top->now.velocity) <= fmax(asked, peak) * (1.0 + 1e-4) + 1e-9;
    before->velocity = on_top->id ? on_top->now.velocity : 0.0;
    before->acceleration = on_top->id ? on_top->now.acceleration : 0.0;
    return good;
}

#endif
