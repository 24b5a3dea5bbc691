/* The set-point of a follower that has a catch-up or a superimposed motion, or is close to a limit: the sum, whether it
 * keeps the limits, and what is tried where it does not (coupling_private.h). */
#include <math.h>

#include "axis/axis_guard.h"
#include "axis/axis_position.h"
#include "axis/axis_setpoint.h"
#include "axis/axis_superimpose.h"
#include "core/extreme.h"
#include "core/rare.h"
#include "coupling/coupling_private.h"

/* ---- the sum ----------------------------------------------------------------------------------------------------- */

from_t cm1e_coupled_sum(const cm1e_axis_t *axis, const from_t *f)
{
    const cm1e_motion_state_t *catch_up = &axis->coupling->catch_up.now, *on_top = &axis->superimposed.now;
    from_t sum = *f;
    if (axis->coupling->catch_up.on) {
        sum.position = cm1e_position_plus(sum.position, catch_up->position * axis->position.scale);
        sum.velocity += catch_up->velocity;
        sum.acceleration += catch_up->acceleration;
    }
    if (axis->superimposed.id) {
        sum.position = cm1e_position_plus(sum.position, on_top->position * axis->position.scale);
        sum.velocity += on_top->velocity;
        sum.acceleration += on_top->acceleration;
    }
    return sum;
}

typedef struct verdict {
    guard_t guard;
    bool smooth; /**< the motion between the set-points keeps the limits too */
} verdict_t;

/* Whether the axis can go on within its limits: its jerk ends an acceleration before the maximum velocity, and where
 * the deceleration may be larger than the acceleration, turns the one into the other until the velocity changes its
 * sign. */
static bool has_room(const cm1e_axis_t *axis, const from_t *sum)
{
    static const double rounding = 1.0 + 1e-6, rounding_v = 1.0 + 1e-10;
    const cm1e_motion_limits_t *most = &axis->limits.maximum;
    const double a = fabs(sum->acceleration), at_rest = most->acceleration * rounding, speed = fabs(sum->velocity);
    if (sum->acceleration * sum->velocity >= 0.0)
        return a <= at_rest && speed + a * a * axis->guarding.ease <= most->velocity * rounding_v;
    return a <= most->deceleration * rounding && a * a <= at_rest * at_rest + 2.0 * most->jerk * speed;
}

/* What moves beside the function uses next to nothing of the guard's tolerance of velocity, which is for its rounding.
 * Here `most` is a little more than the maximum. */
static bool keeps_velocity(const cm1e_axis_t *axis, const from_t *sum, double most)
{
    const double way = cm1e_position_minus(sum->position, axis->setpoint.position) * axis->guarding.per_count;
    return fabs(sum->velocity) <= most && fabs(way) <= most * axis->cycle_s;
}

static verdict_t judge_sum(const cm1e_axis_t *axis, const from_t *sum)
{
    const bool kept_jerk = coupling_keeps_jerk(axis->coupling);
    const double most = axis->limits.maximum.velocity;
    const bool kept = keeps_velocity(axis, sum, most * (1.0 + 1e-9));
    guard_t guard = cm1e_axis_guard(axis, sum, kept_jerk);
    if (!kept && !guard.limit && !keeps_velocity(axis, sum, most * (1.0 + 1e-8)))
        guard = (guard_t){.limit = GUARD_VELOCITY, .asked = fabs(sum->velocity), .allowed = most};
    const bool eased = !coupling_eases(axis->coupling) || (kept && has_room(axis, sum));
    return (verdict_t){guard, !guard.limit && eased && (!kept_jerk || cm1e_axis_guard_smooth(axis, sum))};
}

/* ---- with a catch-up --------------------------------------------------------------------------------------------- */

/* Tries to go on from the present catch-up. Returns the set-point, and in `*verdict` whether it keeps the limits. */
static from_t attempt_to(cm1e_axis_t *axis, const from_t *f, attempt_t attempt, verdict_t *verdict)
{
    cm1e_catch_up_step(axis, f, attempt);
    const from_t sum = cm1e_coupled_sum(axis, f);
    *verdict = judge_sum(axis, &sum);
    return sum;
}

/* Whether to look no further. Where the coupling function itself leads beyond a limit, a catch-up could hold the axis
 * at it for ever. */
static bool is_settled(const verdict_t *verdict)
{
    return verdict->smooth || verdict->guard.limit == GUARD_DIRECTION || verdict->guard.limit == GUARD_SOFTWARE_LIMIT;
}

/* Tries the attempts after the first one, which was not smooth. The first attempt that is smooth is taken; if none is,
 * the first one that keeps the limits at the set-points. */
CM1E_RARE static from_t with_next_attempts(cm1e_axis_t *axis, const from_t *f, const catch_up_t *before,
                                           attempt_t first, from_t sum, verdict_t *verdict)
{
    coupling_t *c = axis->coupling;
    const cm1e_profile_t plan = c->plan; /* of the first attempt: it went by the plan before, or needs that no more */
    attempt_t kept = verdict->guard.limit ? ATTEMPTS : first;
    for (int attempt = (int)first + 1; attempt < ATTEMPTS; attempt++) {
        c->catch_up = *before;
        c->plan = plan;
        sum = attempt_to(axis, f, (attempt_t)attempt, verdict);
        if (is_settled(verdict))
            return sum;
        if (!verdict->guard.limit && kept == ATTEMPTS)
            kept = (attempt_t)attempt;
    }
    if (kept == ATTEMPTS || kept == WITHOUT_JERK)
        return sum;
    c->catch_up = *before;
    c->plan = plan;
    return attempt_to(axis, f, kept, verdict);
}

/* The catch-up was planned with the limits that the coupling function left at that time. If the function needs more,
 * the catch-up is planned anew in every cycle until it ends. Beside an estimate that is disturbed, no plan holds. */
static from_t with_catch_up(cm1e_axis_t *axis, const from_t *f, verdict_t *verdict)
{
    coupling_t *c = axis->coupling;
    if (c->settling > 0) {
        c->catch_up.on = true;
        return attempt_to(axis, f, WITHOUT_JERK, verdict);
    }
    if (!c->catch_up.on) {
        const from_t sum = cm1e_coupled_sum(axis, f);
        *verdict = judge_sum(axis, &sum);
        if (!coupling_approaches(axis) || is_settled(verdict))
            return sum;
        c->catch_up.on = c->catch_up.held_back = true;
    }
    const catch_up_t before = c->catch_up;
    const bool disturbed = f->acceleration != 0.0 || c->f_acceleration != 0.0;
    const bool interrupted = disturbed && before.to_place && !c->now->to_position;
    const attempt_t first = before.held_back || interrupted ? WITH_ALL_JERK : AS_PLANNED;
    const from_t sum = attempt_to(axis, f, first, verdict);
    return is_settled(verdict) ? sum : with_next_attempts(axis, f, &before, first, sum, verdict);
}

/* ---- with a superimposed motion ---------------------------------------------------------------------------------- */

/* What changes in an attempt to go on. */
typedef struct parts {
    superimposed_t on_top;
    catch_up_t catch_up;
    cm1e_profile_t plan;
} parts_t;

static parts_t parts_of(const cm1e_axis_t *axis)
{
    return (parts_t){axis->superimposed, axis->coupling->catch_up, axis->coupling->plan};
}

static void put_back(cm1e_axis_t *axis, const parts_t *parts)
{
    cm1e_axis_superimposed_put_back(axis, &parts->on_top);
    axis->coupling->catch_up = parts->catch_up;
    axis->coupling->plan = parts->plan;
}

/* Whether what the masters ask for has more jerk by itself than the axis has. */
static bool function_jerks(const cm1e_axis_t *axis, const from_t *f)
{
    const double most = axis->limits.maximum.jerk, rounding = 1e-9 * axis->limits.maximum.acceleration / axis->cycle_s;
    return coupling_keeps_jerk(axis->coupling) && cm1e_coupling_jerk(axis, f) > most * (1.0 + 1e-6) + rounding;
}

/* Whether the superimposed motion makes the acceleration of the sum larger than it may be behind the standstill, to
 * which it comes nearer. One whose share is more than that, because a maximum was lowered since, could not brake by its
 * plan. */
static bool adds_too_much(const cm1e_axis_t *axis, const from_t *sum)
{
    const superimposed_t *on_top = &axis->superimposed;
    const cm1e_motion_limits_t *most = &axis->limits.maximum;
    const double a = sum->acceleration, either = smaller(most->acceleration, most->deceleration) * (1.0 + 1e-6);
    return coupling_keeps_jerk(axis->coupling) && fabs(a) > either && a * sum->velocity <= 0.0 &&
           on_top->now.acceleration * a > 0.0 &&
           larger(on_top->share.acceleration, on_top->share.deceleration) <= either;
}

static bool lacks_room(const cm1e_axis_t *axis, const from_t *sum)
{
    return coupling_eases(axis->coupling) && !has_room(axis, sum);
}

static bool breaks_more_than_jerk(const cm1e_axis_t *axis, const from_t *sum)
{
    return cm1e_axis_guard(axis, sum, false).limit || lacks_room(axis, sum);
}

/* What the sum keeps in an attempt to go on otherwise: all limits but the jerk, or all but that and the acceleration
 * behind the standstill (adds_too_much()). */
typedef enum keeping { KEEPS_ALL_BUT_JERK = 0, MAY_ADD_TOO_MUCH } keeping_t;

static bool keeps(const cm1e_axis_t *axis, const from_t *sum, keeping_t keeping)
{
    return !breaks_more_than_jerk(axis, sum) && (keeping == MAY_ADD_TOO_MUCH || !adds_too_much(axis, sum));
}

/* The superimposed motion goes on without jerk for a cycle, or, where the acceleration of the sum is too large, without
 * some of its own. It may pass its target then, and comes back. false: that does not help. */
CM1E_RARE static bool goes_on_otherwise(cm1e_axis_t *axis, const from_t *f, const parts_t *before, keeping_t keeping,
                                        from_t *sum)
{
    verdict_t verdict;
    put_back(axis, before);
    if (cm1e_axis_superimposed_hold(axis, false)) {
        *sum = with_catch_up(axis, f, &verdict);
        if (keeps(axis, sum, keeping))
            return true;
    }
    put_back(axis, before);
    if (!cm1e_axis_superimposed_ease(axis))
        return false;
    *sum = with_catch_up(axis, f, &verdict);
    return keeps(axis, sum, keeping);
}

/* With a superimposed motion, whose sum with the function breaks a limit: if it is the jerk alone, the superimposed
 * motion goes on without jerk as long as that leads neither beyond VelocityDiff nor beyond its target; then the jerk of
 * the sum is larger than the maximum, by that of the superimposed motion at most. */
CM1E_RARE static from_t with_less(cm1e_axis_t *axis, const from_t *f, const parts_t *before, from_t planned,
                                  verdict_t *verdict)
{
    const parts_t as_planned = parts_of(axis);
    const verdict_t refused = *verdict;
    from_t sum = planned;
    if (function_jerks(axis, f))
        return planned;
    const bool breaks = breaks_more_than_jerk(axis, &planned);
    if (breaks || adds_too_much(axis, &planned)) {
        if (goes_on_otherwise(axis, f, before, KEEPS_ALL_BUT_JERK, &sum) ||
            (breaks && goes_on_otherwise(axis, f, before, MAY_ADD_TOO_MUCH, &sum))) {
            *verdict = (verdict_t){.smooth = true};
            return sum;
        }
        put_back(axis, &as_planned);
        *verdict = refused;
        if (breaks || !refused.guard.limit)
            return planned;
    }
    put_back(axis, before);
    if (cm1e_axis_superimposed_hold(axis, true)) {
        sum = with_catch_up(axis, f, verdict);
        if (!verdict->guard.limit)
            return sum;
    }
    put_back(axis, &as_planned);
    *verdict = (verdict_t){.smooth = true};
    return planned;
}

static from_t with_superimposed(cm1e_axis_t *axis, const from_t *f, verdict_t *verdict)
{
    const parts_t before = parts_of(axis);
    cm1e_motion_state_t unused = {0};
    cm1e_axis_superimposed_step(axis, &unused);
    const from_t sum = with_catch_up(axis, f, verdict);
    const bool too_much = verdict->guard.limit || lacks_room(axis, &sum) || adds_too_much(axis, &sum);
    return too_much && axis->superimposed.moving ? with_less(axis, f, &before, sum, verdict) : sum;
}

CM1E_RARE guard_t cm1e_coupled_judge(cm1e_axis_t *axis, const from_t *f, from_t *next)
{
    verdict_t verdict;
    *next = *f;
    if (axis->superimposed.id)
        *next = with_superimposed(axis, f, &verdict);
    else if (coupling_gives_way(axis) || axis->coupling->settling > 0)
        *next = with_catch_up(axis, f, &verdict);
    else
        return cm1e_axis_look_closely(axis, f, coupling_keeps_jerk(axis->coupling));
    return verdict.guard;
}
