/*
 * An axis that is led from a room above: by its axes group. The leader gives a set-point in every cycle, and the axis
 * checks it. The axis stops by itself if the motor cannot follow a set-point, or if there is none.
 */
#include "axis/axis_lead.h"
#include "axis/axis_backlash.h"
#include "axis/axis_events.h"
#include "axis/axis_guard.h"
#include "axis/axis_limits.h"
#include "axis/axis_position.h"
#include "axis/axis_setpoint.h"
#include "core/rare.h"

static bool at_rest(const cm1e_axis_t *axis)
{
    return axis->setpoint.velocity == 0.0 && axis->setpoint.acceleration == 0.0;
}

cm1e_error_t cm1e_axis_lead(cm1e_axis_t *axis, cm1e_axis_leader_t *leader)
{
    if (drive_profiles(axis))
        return CM1E_ERROR_UNSUPPORTED;
    if (axis->state != CM1E_AXIS_STANDSTILL || !axis_holds(axis) || axis->commands.active ||
        axis->commands.waiting.count > 0 || axis->superimposed.id || !axis_acts(axis))
        return CM1E_ERROR_AXIS_STATE;
    axis->leader = leader;
    cm1e_axis_set_source(axis, &cm1e_source_leader);
    cm1e_axis_guard_renew(axis);
    cm1e_axis_go(axis, ON_LED);
    return CM1E_OK;
}

void cm1e_axis_release(cm1e_axis_t *axis)
{
    if (!axis_led(axis))
        return;
    axis->leader = NULL;
    if (at_rest(axis)) {
        cm1e_axis_set_source(axis, &cm1e_source_hold);
        cm1e_axis_go(axis, ON_LET_GO);
    } else {
        cm1e_axis_go(axis, ON_BROKEN_OFF);
        cm1e_axis_ramp_down(axis, &axis->limits.maximum);
    }
}

bool cm1e_axis_join(cm1e_axis_t *axis, const void *group)
{
    if (axis->belongs.group && axis->belongs.group != group)
        return false;
    axis->belongs.group = group;
    return true;
}

void cm1e_axis_leave(cm1e_axis_t *axis, const void *group)
{
    if (axis->belongs.group == group)
        axis->belongs.group = NULL;
}

/* ---- the cycle --------------------------------------------------------------------------------------------------- */

/* Whether all set-points are well within the limits, as long as the course of the leader stays. */
CM1E_RARE static void look_ahead(cm1e_axis_t *axis)
{
    cm1e_axis_leader_t *leader = axis->leader;
    cm1e_motion_bounds_t most;
    double left_s;
    const bool kept = leader->bounds && leader->bounds(leader->context, leader->index, &most, &left_s) &&
                      cm1e_axis_well_ahead(axis, &most, -most.velocity * left_s, most.velocity * left_s);
    cm1e_axis_guard_decide(axis, kept, leader->course ? *leader->course : 0);
    leader->line_origin = axis->position.modulo_range > 0.0 ? 0.0 : axis->position.origin_units;
    leader->line_counts = copysign(axis->position.unit.counts, axis->position.scale);
}

CM1E_RARE static bool refuse(cm1e_axis_t *axis, guard_t guard)
{
    cm1e_axis_guard_fail(axis, guard);
    return false;
}

/* Without a set-point the axis stops by itself, unless the leader has just let it go. */
CM1E_RARE static bool be_left(cm1e_axis_t *axis)
{
    if (axis_led(axis))
        cm1e_axis_fail(axis, CM1E_ERROR_AXIS_COUPLED, 0.0, 0.0);
    return false;
}

/* What cm1e_axis_position_from_line() does, with what does not change while the axis is led, and without its checks:
 * the position was found to be in the range of the counts ahead. */
static inline bool take_set_point(cm1e_axis_t *axis, const cm1e_axis_leader_t *leader)
{
    const double counts =
        (*leader->position - leader->line_origin) * leader->line_counts / axis->position.unit.units;
    const from_t next = {cm1e_position_plus(axis->position.origin, counts), *leader->velocity, *leader->acceleration,
                         false};
    *leader->asked |= leader->bit;
    cm1e_axis_put_set_point(axis, &next);
    return true;
}

/* The first axis that asks makes the set-point of all. */
CM1E_APART static bool take_first_set_point(cm1e_axis_t *axis, const cm1e_axis_leader_t *leader,
                                            axis_otherwise_t otherwise)
{
    return leader->ordinary(leader->context) ? take_set_point(axis, leader) : otherwise(axis);
}

static bool ordinary(cm1e_axis_t *axis, axis_otherwise_t otherwise)
{
    const cm1e_axis_leader_t *leader = axis->leader;
    if (!CM1E_USUALLY(cm1e_axis_guard_kept(axis, leader->course)))
        return otherwise(axis);
    if ((*leader->asked & leader->bit) != 0)
        return take_first_set_point(axis, leader, otherwise);
    return take_set_point(axis, leader);
}

/* The leader may let the axis go while it gives the set-point. */
static bool step(cm1e_axis_t *axis)
{
    const uint32_t *course = axis->leader->course;
    double line = 0.0, velocity, acceleration;
    const cm1e_lead_t lead =
        axis->leader->next(axis->leader->context, axis->leader->index, &line, &velocity, &acceleration);
    if (lead == CM1E_LEAD_NONE)
        return be_left(axis);
    from_t next = {.velocity = velocity, .acceleration = acceleration};
    if (!cm1e_axis_position_from_line(axis, line, &next.position))
        return refuse(axis, (guard_t){.limit = GUARD_FINITE});
    const bool decided = course && cm1e_axis_guard_decided(axis, *course);
    if (!decided || !cm1e_axis_guard_kept(axis, course)) {
        const guard_t guard = cm1e_axis_guard(axis, &next, true);
        if (guard.limit)
            return refuse(axis, guard);
    }
    cm1e_axis_put_set_point(axis, &next);
    if (!decided && axis_led(axis))
        look_ahead(axis);
    if (lead == CM1E_LEAD_LAST)
        cm1e_axis_release(axis);
    return true;
}

static void begin_anew(cm1e_axis_t *axis)
{
    const cm1e_axis_leader_t *leader = axis->leader;
    if (axis->setpoint.velocity == 0.0)
        leader->paused(leader->context, leader->index);
    else
        cm1e_axis_guard_fail(axis, (guard_t){.limit = GUARD_PAUSE, .asked = axis->setpoint.velocity});
}

static void slow(cm1e_axis_t *axis, double part)
{
    (void)part; /* the leader asks every axis for its part */
    const cm1e_axis_leader_t *leader = axis->leader;
    double velocity = axis->setpoint.velocity, acceleration = axis->setpoint.acceleration;
    if (leader->slow)
        leader->slow(leader->context, leader->index, &velocity, &acceleration);
    cm1e_axis_put_motion(axis, velocity, acceleration);
}

const source_t cm1e_source_leader = {
    .step = step,
    .ordinary = ordinary,
    .stop = cm1e_axis_stop_by_ramp,
    .begin_anew = begin_anew,
    .slow = slow,
    .keeps = cm1e_axis_unknown_way_keeps,
    .moves = true,
    .is_composite = true,
};

void cm1e_axis_lead_fail(cm1e_axis_t *axis, cm1e_error_t error)
{
    const double time_s = axis->leader->stop_time ? axis->leader->stop_time(axis->leader->context) : 0.0;
    cm1e_axis_fail_gently(axis, error, time_s > 0.0 ? fabs(axis->setpoint.velocity) / time_s : INFINITY);
}

void cm1e_axis_bounds(const cm1e_axis_t *axis, cm1e_motion_limits_t *limits, double *lower, double *upper)
{
    *limits = axis->limits.maximum;
    *lower = axis->limits.lower;
    *upper = axis->limits.upper;
}

double cm1e_axis_cycle(const cm1e_axis_t *axis) { return axis->cycle_s; }

bool cm1e_axis_may_go(const cm1e_axis_t *axis, bool positive)
{
    return positive ? axis->power.enable_positive : axis->power.enable_negative;
}

double cm1e_axis_place(const cm1e_axis_t *axis, bool actual)
{
    return cm1e_axis_line(axis, actual ? axis_actual(axis) : axis->setpoint.position);
}
