/* Followers: how a coupling begins, and the set-point of every cycle (coupling_private.h). */
#include "axis/axis_events.h"
#include "axis/axis_guard.h"
#include "axis/axis_plan.h"
#include "axis/axis_position.h"
#include "axis/axis_setpoint.h"
#include "axis/axis_superimpose.h"
#include "core/extreme.h"
#include "core/rare.h"
#include "coupling/coupling_private.h"

#include <math.h>

/* ---- the cycle --------------------------------------------------------------------------------------------------- */

/* A slave that is late at the end of its approach still synchronises, until it is in step for the first time. */
static void show_synchronizing(cm1e_axis_t *axis)
{
    const coupling_t *c = axis->coupling;
    cm1e_axis_set_synchronizing(axis, !c->now->in_step || (axis->setpoint.synchronizing && c->catch_up.on));
}

static void emit(cm1e_axis_t *axis, const from_t *point)
{
    cm1e_axis_put_set_point(axis, point);
    if (!cm1e_position_in_range(axis->setpoint.position))
        cm1e_axis_fail(axis, CM1E_ERROR_AXIS_POSITION_RANGE, cm1e_axis_units(axis, axis->setpoint.position),
                       cm1e_axis_farthest(axis));
}

static void after_set_point(cm1e_axis_t *axis, const from_t *f)
{
    coupling_t *c = axis->coupling;
    if (c->catch_up.on)
        cm1e_catch_up_after(axis, f);
    if (axis->superimposed.id)
        cm1e_axis_superimposed_after(axis);
    show_synchronizing(axis);
    const bool in_step = !c->catch_up.on && c->now->in_step;
    c->was_in_step |= in_step;
    cm1e_axis_set_reached(axis, in_step && coupling_sees_all(c->now));
    if (axis->setpoint.reached && axis->commands.waiting.count > 0 &&
        (!c->now->waits_for_end || c->end_of_profile || c->now->cam.left != 0.0)) {
        const from_t from = from_base(axis);
        (void)cm1e_axis_begin_waiting(axis, &from, 0.0);
    }
}

/* Stops the axis without its masters. Returns false, for step(). In ErrorStop the error is reported already. */
static bool stop_alone(cm1e_axis_t *axis, guard_t guard)
{
    if (axis->coupling->stopping)
        cm1e_axis_ramp_down(axis, &axis->limits.emergency);
    else if (guard.limit)
        cm1e_axis_guard_fail(axis, guard);
    else
        cm1e_axis_fail(axis, CM1E_ERROR_AXIS_MASTER_LOST, 0.0, 0.0);
    return false;
}

/* With keep_ratio, the coupling ends when the masters are at standstill. */
static void stand_with_masters(cm1e_axis_t *axis, const from_t *f)
{
    if (!axis->coupling->stopping || axis->coupling->catch_up.on || f->velocity != 0.0 || f->acceleration != 0.0)
        return;
    cm1e_axis_set_source(axis, &cm1e_source_hold);
}

static bool has_to_stop(cm1e_axis_t *axis, master_trouble_t trouble)
{
    return trouble && !(axis->coupling->stopping && trouble == MASTER_STOPPING) &&
           !cm1e_coupling_follows_to_the_end(axis, trouble);
}

/* Where the master begins anew meanwhile is no jump. */
bool cm1e_coupling_sees_trouble(cm1e_axis_t *axis)
{
    return has_to_stop(axis, cm1e_coupling_look(axis, axis->coupling->now));
}

static bool step(cm1e_axis_t *axis)
{
    coupling_t *c = axis->coupling;
    from_t f, sum;
    const from_t *next = &f;
    guard_t broken = {.limit = GUARD_KEPT};
    if (c->phasing.moving)
        cm1e_phasing_step(axis);
    if (has_to_stop(axis, cm1e_coupling_see(axis, c->now)))
        return stop_alone(axis, (guard_t){.limit = GUARD_KEPT});
    c->end_of_profile = false;
    c->now->function->evaluate(axis, c->now, &f);
    if (coupling_gives_way(axis) || c->settling > 0 || axis->superimposed.id ||
        !cm1e_axis_well_within(axis, &f, coupling_keeps_jerk(c))) {
        guard_t guard = cm1e_coupled_judge(axis, &f, &sum);
        if (guard.limit && cm1e_coupling_brakes_with_master(axis, guard)) {
            broken = guard;
            guard = cm1e_coupling_before_braking(axis, &f, &sum);
        }
        if (guard.limit)
            return stop_alone(axis, guard);
        next = &sum;
    }
    c->settling -= c->settling > 0;
    c->f_velocity = f.velocity;
    c->f_acceleration = f.acceleration;
    emit(axis, next);
    if (axis_follows(axis))
        after_set_point(axis, &f);
    if (c->keeps_ratio && axis_follows(axis)) {
        cm1e_coupling_keep_ratio(axis, broken);
        stand_with_masters(axis, &f);
    }
    if (next == &f) /* else the step to the next set-point is more than that of the coupling function */
        cm1e_coupling_look_ahead(axis);
    return true;
}

/* ---- the source of set-points ------------------------------------------------------------------------------------ */

static void begin_anew(cm1e_axis_t *axis);

static void leave(cm1e_axis_t *axis)
{
    cm1e_phasing_forget(axis); /* the shift goes with the masters (4.8) */
    axis->coupling->stopping = false;
}

/* Whether an emergency stop would end within the bounds. What the masters will do is not known. */
static bool keeps(const cm1e_axis_t *axis, double lower, double upper)
{
    const double v = axis->setpoint.velocity;
    const double stop = cm1e_axis_line(axis, axis->setpoint.position) + v * fabs(v) * axis->limits.emergency_way;
    return stop <= upper + axis->limits.tolerance && stop >= lower - axis->limits.tolerance;
}

const source_t cm1e_source_coupling = {
    .step = step,
    .ordinary = cm1e_coupling_ordinary_step,
    .stop = cm1e_axis_stop_by_ramp,
    .begin_anew = begin_anew,
    .leave = leave,
    .keeps = keeps,
    .moves = true,
    .follows = true,
};

/* ---- beginnings -------------------------------------------------------------------------------------------------- */

static distance_rule_t rule_of(bool made_up) { return made_up ? DISTANCE_IS_MADE_UP : DISTANCE_IS_LOST; }

void cm1e_coupling_follow(cm1e_axis_t *axis, follow_t *follow, const from_t *from, const cm1e_motion_limits_t *asked)
{
    coupling_t *c = axis->coupling;
    const bool followed = axis_follows(axis);
    if (!followed || c->now->links[0].master != follow->links[0].master)
        cm1e_phasing_forget(axis);
    if (c->now)
        cm1e_coupling_unlist_links(c->now);
    cm1e_coupling_await_nothing(axis);
    cm1e_coupling_list_links(follow);
    c->now = follow;
    c->end_of_profile = c->stopping = c->due = c->was_in_step = false;
    c->settling = 0;
    cm1e_catch_up_begin(axis, from, asked, rule_of(c->now->to_position), ALL_TOGETHER);
    cm1e_axis_set_source(axis, &cm1e_source_coupling);
    if (!followed)
        cm1e_axis_guard_renew(axis); /* else its numbers are of the present limits, and its course has ended above */
    cm1e_axis_set_synchronizing(axis, !follow->in_step);
    cm1e_axis_set_reached(axis, false);
    cm1e_axis_set_paused(axis, false);
    cm1e_axis_set_stands(axis, false);
}

/* Begins the catch-up anew after a pause or silence. If masters and slave kept their last targets, the difference is
 * what it was before. */
static void begin_anew(cm1e_axis_t *axis)
{
    coupling_t *c = axis->coupling;
    const from_t from = from_set(axis);
    const cm1e_motion_limits_t asked = c->catch_up.asked;
    cm1e_phasing_stand(axis);
    const bool across = cm1e_coupling_settle(axis);
    const master_trouble_t trouble = cm1e_coupling_look_anew(axis);
    if (trouble && !(c->stopping && trouble == MASTER_STOPPING)) {
        (void)stop_alone(axis, (guard_t){.limit = GUARD_KEPT});
        return;
    }
    /* A slave that was in step makes up the distance, also where its motor went on by itself (CSV) and that of its
     * master did not. One that was still on its way does not (4.5, note 1). */
    const bool was_in_step = !c->catch_up.on || c->catch_up.made_up;
    cm1e_catch_up_begin(axis, &from, &asked, rule_of(c->now->to_position || was_in_step),
                        across ? VELOCITY_FIRST : ALL_TOGETHER);
    c->settling = c->now->by_actual ? cm1e_coupling_settles_in(axis) : 0; /* or one lost frame would be an error */
    show_synchronizing(axis);
    cm1e_axis_set_reached(axis, false);
}

/* Goes on from the present set-point, without a step, after what is seen of a master has changed. */
static void go_on_from_here(cm1e_axis_t *axis)
{
    coupling_t *c = axis->coupling;
    const from_t from = from_base(axis);
    const cm1e_motion_limits_t asked = c->catch_up.asked;
    const bool was_in_step = !c->catch_up.on || c->catch_up.made_up;
    if (cm1e_coupling_look(axis, c->now) != MASTER_GOOD && !c->stopping)
        return; /* the next set-point deals with it */
    cm1e_catch_up_begin(axis, &from, &asked, rule_of(c->now->to_position || was_in_step), VELOCITY_FIRST);
    show_synchronizing(axis);
    cm1e_axis_set_reached(axis, false);
}

void cm1e_coupling_look_across(cm1e_axis_t *axis)
{
    if (axis->silence.frozen)
        cm1e_coupling_fall_behind(axis);
    else if (cm1e_coupling_settle(axis))
        go_on_from_here(axis);
}

void cm1e_coupling_first_set_point(cm1e_axis_t *axis)
{
    from_t f;
    cm1e_motion_state_t unused = {0};
    if (axis->superimposed.id)
        cm1e_axis_superimposed_step(axis, &unused);
    axis->coupling->now->function->evaluate(axis, axis->coupling->now, &f);
    const from_t point = cm1e_coupled_sum(axis, &f);
    emit(axis, &point);
    show_synchronizing(axis);
}
