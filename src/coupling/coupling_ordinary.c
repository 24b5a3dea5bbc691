/*
 * The short way of an ordinary cycle of a follower. It is in step with one master, and nothing is beside the coupling
 * function: no catch-up, no phase shift that moves, no waiting command. Then its set-points follow from those of the
 * master alone. If the course of the master is known (axis_course.h), its largest velocity, acceleration and jerk are,
 * and so are those of the slave: the checks of the guard, and whether the master can be followed, are decided for the
 * whole course. What is left to each cycle is the coupling function. Whatever could change one of these decisions
 * changes the number of the course of the master or of the slave. Both ways give the same bits (test_axis_ordinary_led,
 * and by its bench every test of couplings).
 */
#include <math.h>

#include "axis/axis_guard.h"
#include "axis/axis_setpoint.h"
#include "core/rare.h"
#include "coupling/coupling_private.h"

/* The master may fail meanwhile, and the slave with it: then the course of the slave is another one. */
CM1E_RARE static bool step_after_master(cm1e_axis_t *axis, axis_otherwise_t otherwise)
{
    cm1e_axis_advance(axis->coupling->now->links[0].master);
    return cm1e_coupling_ordinary_step(axis, otherwise);
}

bool cm1e_coupling_ordinary_step(cm1e_axis_t *axis, axis_otherwise_t otherwise)
{
    coupling_t *c = axis->coupling;
    if (!CM1E_USUALLY(c->ordinary && c->course == axis->setpoint.course))
        return otherwise(axis);
    link_t *link = &c->now->links[0];
    const cm1e_axis_t *master = link->master;
    if (!CM1E_USUALLY(master->advanced))
        return step_after_master(axis, otherwise);
    const setpoint_t *seen = &master->setpoint;
    if (!CM1E_USUALLY(c->masters_course == seen->course))
        return otherwise(axis);
    link->seen.counts = cm1e_position_minus(seen->position, link->origin) + c->phase.position * master->position.scale;
    link->seen.velocity = seen->velocity + c->phase.velocity;
    link->seen.acceleration = seen->acceleration + c->phase.acceleration;
    c->end_of_profile = false;
    return c->now->function->ordinary(axis, c->now);
}

/* Whether the slave is in step, and nothing is beside the coupling function. */
static bool only_follows(const cm1e_axis_t *axis)
{
    const coupling_t *c = axis->coupling;
    const link_t *link = &c->now->links[0];
    return axis_follows(axis) && axis->setpoint.reached && c->now->count == 1 && link->master &&
           link->source == mcSetValue && link->assumed == SEEN && !c->catch_up.on && !c->phasing.moving &&
           !c->keeps_ratio && !c->stopping && axis->superimposed.id == 0 && c->now->function->ordinary &&
           axis->commands.waiting.count == 0;
}

/* Whether all set-points on this course of the master are well within the limits. */
static bool is_ordinary(const cm1e_axis_t *axis)
{
    const follow_t *now = axis->coupling->now;
    course_t course;
    cm1e_motion_bounds_t most;
    if (!only_follows(axis) || !cm1e_axis_course(now->links[0].master, &course) ||
        !now->function->bounds(axis, now, &course, &most))
        return false;
    const double reach = most.velocity * course.time_s;
    return cm1e_axis_well_ahead(axis, &most, -reach, reach);
}

CM1E_RARE static void look_ahead(cm1e_axis_t *axis, uint32_t masters_course)
{
    coupling_t *c = axis->coupling;
    c->ordinary = is_ordinary(axis);
    c->course = axis->setpoint.course;
    c->masters_course = masters_course;
}

void cm1e_coupling_look_ahead(cm1e_axis_t *axis)
{
    const coupling_t *c = axis->coupling;
    const cm1e_axis_t *master = c->now->links[0].master;
    if (master && (c->course != axis->setpoint.course || c->masters_course != master->setpoint.course))
        look_ahead(axis, master->setpoint.course);
}
