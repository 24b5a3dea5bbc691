/*
 * Which axes stop together if a follower or its master cannot go on: `coupling_stop` of the configuration.
 *
 * With keep_ratio the slave, in ErrorStop, follows its master to standstill. Either the master has failed by itself,
 * and the slave follows its ramp; or the slave would break a limit of its own, and both brake. In the latter case the
 * master brakes no harder than the slave can follow, on the way that is left. So the braking begins a cycle before the
 * limit, while the slave can still follow. If it cannot follow, it brakes alone.
 */
#include <math.h>
#include <string.h>

#include "axis/axis_events.h"
#include "axis/axis_guard.h"
#include "axis/axis_position.h"
#include "axis/axis_setpoint.h"
#include "coupling/coupling_private.h"

static bool keeps_ratio(const cm1e_axis_t *axis)
{
    return axis->config->coupling_stop == CM1E_COUPLING_STOP_KEEP_RATIO && axis->drive.feedback.enabled &&
           !axis->superimposed.id; /* a superimposed motion ends with the commands */
}

/* Stops an axis because of `cause`, whose name goes into the text of the error. */
static void fail_with(cm1e_axis_t *axis, const cm1e_axis_t *cause, double deceleration)
{
    if (axis->state == CM1E_AXIS_ERROR_STOP || axis_free(axis))
        return; /* without torque there is no motion to stop */
    memcpy(axis->followed->other_name, cause->config->name, sizeof axis->followed->other_name);
    cm1e_axis_fail_gently(axis, CM1E_ERROR_AXIS_COUPLED, deceleration);
}

/* Whether the slave follows by this link now, and does not only wait for it. */
static bool in_force(const link_t *link)
{
    const follow_t *now = link->slave->coupling->now;
    return axis_follows(link->slave) && (link == &now->links[0] || link == &now->links[1]);
}

void cm1e_coupling_failed(cm1e_axis_t *axis)
{
    const follow_t *follow = axis->coupling->now;
    if (axis->config->coupling_stop != CM1E_COUPLING_STOP_COUPLED)
        return;
    for (int i = 0; i < follow->count; i++) {
        cm1e_axis_t *master = follow->links[i].master;
        if (!master)
            continue;
        fail_with(master, axis, INFINITY);
        for (const link_t *link = master->followed->slaves; link; link = link->next)
            if (in_force(link))
                fail_with(link->slave, axis, INFINITY);
    }
}

bool cm1e_coupling_follows_to_the_end(cm1e_axis_t *axis, master_trouble_t trouble)
{
    if (trouble != MASTER_STOPPING || !keeps_ratio(axis))
        return false;
    axis->coupling->stopping = true;
    cm1e_axis_fail(axis, CM1E_ERROR_AXIS_MASTER_LOST, 0.0, 0.0);
    return true;
}

/* A slave that still gets in step has no ratio to keep: both brake with their own ramps. If the master braked no harder
 * than the ratio allows, it could go on for minutes after its slave has stopped. */
static bool gets_in_step(const cm1e_axis_t *axis)
{
    const catch_up_t *catch_up = &axis->coupling->catch_up;
    return !axis->coupling->was_in_step || (catch_up->on && !catch_up->made_up);
}

/* u/s2 of the slave: its deceleration if its master is braked too. 0: the master is not. */
static double braking_with_master(const cm1e_axis_t *axis)
{
    const follow_t *follow = axis->coupling->now;
    const link_t *link = &follow->links[0];
    const double own = axis->limits.emergency.deceleration, slope = follow->function->steepest(axis, follow, 0);
    if (follow->count != 1 || link->source != mcSetValue || !set_points_move(link->master) || !(slope > 0.0))
        return 0.0;
    return gets_in_step(axis) ? own : fmin(own, link->master->limits.emergency.deceleration * slope);
}

/* The software limit that the slave would leave if both went on for another cycle before they brake. */
static guard_t limit_ahead(const cm1e_axis_t *axis, double braking)
{
    const double t = axis->cycle_s, v = axis->setpoint.velocity + axis->setpoint.acceleration * t;
    const double line = cm1e_axis_line(axis, axis->setpoint.position) + (axis->setpoint.velocity + v) / 2.0 * t;
    const double end = line + v * fabs(v) / (2.0 * braking) + v * t;
    if (axis->limits.software_limits && ((v > 0.0 && end > axis->limits.upper) ||
                                         (v < 0.0 && end < axis->limits.lower)))
        return (guard_t){.limit = GUARD_SOFTWARE_LIMIT, .asked = line,
                         .allowed = v > 0.0 ? axis->limits.upper : axis->limits.lower};
    return (guard_t){.limit = GUARD_KEPT};
}

/* u/s2 of the slave: its deceleration if it has to brake with its master. 0: it would brake alone, or does already. */
static double braking(const cm1e_axis_t *axis)
{
    const coupling_t *c = axis->coupling;
    const bool can = keeps_ratio(axis) && !c->stopping && c->phase.velocity == 0.0; /* a phase shift ends by itself */
    return can ? braking_with_master(axis) : 0.0;
}

bool cm1e_coupling_brakes_with_master(const cm1e_axis_t *axis, guard_t guard)
{
    return guard.limit == GUARD_VELOCITY && !coupling_gives_way(axis) && braking(axis) > 0.0;
}

/* The ramp of both has no limit of jerk: so this set-point needs none either. Where the function itself is faster than
 * the axis may be, by what its jerk makes of it in a cycle, the slave lags by that until the next one. */
guard_t cm1e_coupling_before_braking(const cm1e_axis_t *axis, const from_t *f, from_t *next)
{
    *next = *f;
    const guard_t guard = cm1e_axis_guard(axis, next, false);
    if (guard.limit != GUARD_VELOCITY)
        return guard;
    next->velocity = copysign(axis->limits.maximum.velocity, f->velocity);
    const double way = (axis->setpoint.velocity + next->velocity) / 2.0 * axis->cycle_s;
    next->position = cm1e_position_plus(axis->setpoint.position, way * axis->position.scale);
    return cm1e_axis_guard(axis, next, false);
}

/* u/s2 of the master: with which the slave can follow at the steepest place of its function. */
static double gentle_braking(const cm1e_axis_t *axis)
{
    const follow_t *follow = axis->coupling->now;
    return braking(axis) / follow->function->steepest(axis, follow, 0);
}

static bool keeps_ratio_by(const link_t *link)
{
    return in_force(link) && braking(link->slave) > 0.0 && !gets_in_step(link->slave);
}

/* u/s2 of the axis: with which all that follow it, and so on, can follow anywhere. */
static double braking_of_followers(const cm1e_axis_t *axis)
{
    double all = INFINITY;
    for (const link_t *link = axis->followed->slaves; link; link = link->next)
        if (keeps_ratio_by(link)) {
            const follow_t *follow = link->slave->coupling->now;
            const double own = fmin(braking(link->slave), braking_of_followers(link->slave));
            all = fmin(all, own / follow->function->steepest(link->slave, follow, 0));
        }
    return all;
}

/* u/s2 of the master: with which it, and all that follow it, can follow on the way that is left, at most `hard`. */
static double braking_on_way(const cm1e_axis_t *axis, double hard, int *steps)
{
    const follow_t *now = axis->coupling->now;
    const double own = fmin(axis->limits.emergency.deceleration, axis->limits.maximum.deceleration);
    const coupling_braking_t asked = {.own = fmin(own, braking_of_followers(axis)), .gentle = gentle_braking(axis),
                                      .hard = hard, .steps = steps};
    if (axis->coupling->catch_up.on || !now->function->braking)
        return fmin(asked.gentle, asked.own / now->function->steepest(axis, now, 0));
    return now->function->braking(axis, now, &asked);
}

/* u/s2 of the master: with which all slaves that keep their ratio can follow it, but at least what this one can follow
 * anywhere. However many they are, the cycle has to end in time: they share their steps. */
static double braking_with_slaves(const cm1e_axis_t *axis, const cm1e_axis_t *master)
{
    const double gentle = gentle_braking(axis);
    double all = master->limits.emergency.deceleration;
    int steps = CM1E_CAM_BRAKING_STEPS;
    for (const link_t *link = master->followed->slaves; link && all > gentle; link = link->next)
        if (keeps_ratio_by(link))
            all = fmin(all, braking_on_way(link->slave, all, &steps));
    return fmax(gentle, all);
}

void cm1e_coupling_keep_ratio(cm1e_axis_t *axis, guard_t broken)
{
    coupling_t *c = axis->coupling;
    const double deceleration = braking(axis);
    if (!(deceleration > 0.0))
        return;
    if (!broken.limit)
        broken = limit_ahead(axis, deceleration);
    if (!broken.limit)
        return;
    cm1e_axis_t *master = c->now->links[0].master;
    const bool in_step = !gets_in_step(axis);
    const double of_master = in_step ? braking_with_slaves(axis, master) : INFINITY;
    c->stopping = in_step;
    fail_with(master, axis, of_master);
    cm1e_axis_guard_fail(axis, broken);
}
