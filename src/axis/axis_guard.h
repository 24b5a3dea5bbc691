/**
 * @file axis_guard.h
 * The check of set-points that come from outside the axis: from masters and leaders (axis_guard.c).
 */
#ifndef CM1E_AXIS_AXIS_GUARD_H
#define CM1E_AXIS_AXIS_GUARD_H

#include "axis/axis_course.h"
#include "core/extreme.h"

guard_t cm1e_axis_look_closely(const cm1e_axis_t *axis, const from_t *next, bool kept_jerk);
/** Whether the next set-point can be reached with acceleration and jerk within their limits at every moment of the
 *  cycle. Then the differences of the set positions keep these limits too. */
bool cm1e_axis_guard_smooth(const cm1e_axis_t *axis, const from_t *next);
/** Computes the numbers anew. Called when the axis begins to follow or to be led, when its limits are written, and when
 *  its set-point has gone after its motor. */
void cm1e_axis_guard_renew(cm1e_axis_t *axis);
/** ErrorStop with CM1E_ERROR_AXIS_COUPLING_LIMIT or CM1E_ERROR_AXIS_SET_POINT_LIMIT, whose text has the value asked for
 *  and the value allowed. */
void cm1e_axis_guard_fail(cm1e_axis_t *axis, guard_t broken);
void cm1e_axis_guard_text(const cm1e_axis_t *axis, char *text, size_t size);
/** Whether a set-point is within the limits without any tolerance. Nearly every set-point is, and this test is cheap. A
 *  set-point that is not a number fails it. */
static inline bool cm1e_axis_well_within(const cm1e_axis_t *axis, const from_t *next, bool kept_jerk)
{
    const guarding_t *g = &axis->guarding;
    const double v0 = axis->setpoint.velocity, v = next->velocity, a = next->acceleration, speed = fabs(v);
    const double step = cm1e_position_minus(next->position, axis->setpoint.position) - (v0 + v) * g->half_cycle;
    const double change = fabs(v - v0), most = speed >= fabs(v0) ? g->up : g->down;
    if (!(speed <= g->velocity && change <= most &&
          fabs(a) <= g->acceleration && fabs(step) <= g->step && axis->power.enable_positive &&
              axis->power.enable_negative))
        return false;
    const double a0 = axis->setpoint.acceleration, beside = fabs(2.0 * (v - v0) - (a0 + a) * axis->cycle_s);
    if (kept_jerk && !((a - a0) * (a - a0) + beside * g->twice_jerk <= g->jerk * g->jerk &&
                       change + fabs(step) * g->per_step <= smaller(g->up, g->down) &&
                       (a * v <= 0.0 || speed + a * a * g->ease <= g->velocity)))
        return false;
    if (!axis->limits.software_limits)
        return true;
    const double line = axis->position.origin_units + cm1e_position_minus(next->position, axis->position.origin) *
                        g->per_count;
    const double way = speed * speed * axis->limits.emergency_way;
    return line + way <= axis->limits.upper && line - way >= axis->limits.lower;
}
/** Whether all set-points of a motion are well within the limits: a motion of which the largest velocity, acceleration
 *  and jerk are known, and which stays between these two places (u from the set-point). An infinite jerk: the limit of
 *  jerk does not count. */
bool cm1e_axis_well_ahead(const cm1e_axis_t *axis, const cm1e_motion_bounds_t *most, double lowest, double highest);
/** Remembers what cm1e_axis_well_ahead() said of the present courses of the axis and of its leader. */
void cm1e_axis_guard_decide(cm1e_axis_t *axis, bool kept, uint32_t leaders_course);
/** Whether that was said of these courses. */
static inline bool cm1e_axis_guard_decided(const cm1e_axis_t *axis, uint32_t leaders_course)
{
    const guarding_t *g = &axis->guarding;
    return g->own_course == axis->setpoint.course && g->leaders_course == leaders_course;
}
/** Whether all set-points on these courses are well within the limits. The leader may have no course: NULL. */
static inline bool cm1e_axis_guard_kept(const cm1e_axis_t *axis, const uint32_t *leaders_course)
{
    const guarding_t *g = &axis->guarding;
    return g->kept_course == axis->setpoint.course && g->leaders_course == *leaders_course;
}
/** Whether the next set-point may follow the present one. `kept_jerk`: the limit of jerk counts too. */
static inline guard_t cm1e_axis_guard(const cm1e_axis_t *axis, const from_t *next, bool kept_jerk)
{
    return cm1e_axis_well_within(axis, next, kept_jerk) ? (guard_t){.limit = GUARD_KEPT}
                                                        : cm1e_axis_look_closely(axis, next, kept_jerk);
}

#endif
