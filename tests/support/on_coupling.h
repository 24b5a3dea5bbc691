/**
 * @file on_coupling.h
 * What a judge allows a superimposed motion on a slave: it keeps VelocityDiff and its distance whatever the master does, so
 * its own jerk may come on top of that of the coupling.
 */
#ifndef CM1E_TESTS_ON_COUPLING_H
#define CM1E_TESTS_ON_COUPLING_H

#include "axis/axis_parts.h"

/** How much of it the judge of a cycle needs to know of the cycle before. */
typedef struct on_coupling {
    double jerk; /**< u/s3, that may come on top; 0: there is no such motion */
} on_coupling_t;

/** What may come on top of the maximum jerk in this cycle; the end of a motion may be that of the cycle before. */
static inline double jerk_on_coupling(const cm1e_axis_t *axis, on_coupling_t *before)
{
    const bool both = axis->state == CM1E_AXIS_SYNCHRONIZED_MOTION && axis->superimposed.id != 0;
    const double now = both ? axis->superimposed.share.jerk : 0.0, most = now > before->jerk ? now : before->jerk;
    before->jerk = now;
    return most;
}

/** A superimposed motion is no faster than its VelocityDiff. */
static inline bool keeps_velocity_diff(const cm1e_axis_t *axis)
{
    const superimposed_t *on_top = &axis->superimposed;
    const double v = on_top->now.velocity < 0.0 ? -on_top->now.velocity : on_top->now.velocity;
    return on_top->id == 0 || v <= on_top->share.velocity * (1.0 + 1e-5);
}

#endif
