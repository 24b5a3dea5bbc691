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

static const double same_moment = 1e-6; /* cycles */
static const double rounding_counts = 1e-3;
static const double few = 1.0 + 1e-10;

/* ---- what is not in step yet ------------------------------------------------------------------------------------- */

/* The part of a limit that the catch-up always gets, so that it comes to an end. */
static const double least_part = 0.01;

static double at_most(double asked, double most, double used)
{
    return smaller(asked, larger(least_part * most, most - used));
}

/* u/s. A slave that makes up distance in the direction in which the coupling function moves has only the velocity that
 * the function and a superimposed motion leave; in the other direction it has all of it. */
static double room_beside(const cm1e_axis_t *axis, const from_t *f)
{
    const cm1e_motion_state_t *now = &axis->coupling->catch_up.now;
    const double most = axis->limits.maximum.velocity;
    const double on_top = axis->superimposed.moving ? axis->superimposed.share.velocity : 0.0;
    const double at_rest = now->position + now->velocity * fabs(now->velocity) * axis->limits.emergency_way;
    const bool lags = at_rest * f->velocity < 0.0;
    return lags ? larger(0.0, most - fabs(f->velocity) - on_top) : most;
}

/* The velocity with which distance is made up. It is a part of what the coupling function leaves: the function may
 * become faster, and the catch-up can slow down only with its jerk. */
static double velocity_to_place(const cm1e_axis_t *axis, const from_t *f)
{
    const double part = 0.1, most = axis->limits.maximum.velocity, left = part * (most - fabs(f->velocity));
    return smaller(axis->coupling->catch_up.asked.velocity,
                        smaller(larger(least_part * most, left), room_beside(axis, f)));
}

/* The limits of the catch-up: those of the axis without what the coupling function uses. The velocity of the catch-up
 * goes to 0 while the velocity of the axis changes to that of the function. Where the acceleration of the function
 * helps that change, the catch-up has the whole limits. */
static cm1e_motion_limits_t limits_beside(const cm1e_axis_t *axis, const from_t *f, double jerk)
{
    const catch_up_t *catch_up = &axis->coupling->catch_up;
    if (axis->coupling->now->to_position && !catch_up->momentary)
        return cm1e_cam_leaves(axis, axis->coupling->now, &catch_up->asked);
    const cm1e_motion_limits_t *most = &axis->limits.maximum;
    const double now = f->velocity + catch_up->now.velocity, way = catch_up->now.velocity > 0.0 ? -1.0 : 1.0;
    const bool helps = f->acceleration * way <= 0.0 && catch_up->now.acceleration * way >= 0.0;
    const double used = helps ? 0.0 : fabs(f->acceleration);
    const double up = at_most(catch_up->asked.acceleration, most->acceleration, used);
    const double down = at_most(catch_up->asked.deceleration, most->deceleration, used);
    const double change = now * f->velocity < 0.0 ? smaller(up, down) : fabs(f->velocity) > fabs(now) ? up : down;
    const double velocity = catch_up->to_place ? velocity_to_place(axis, f)
                                               : 2.0 * (most->velocity + fabs(catch_up->now.velocity));
    return (cm1e_motion_limits_t){velocity, change, change, jerk};
}

static void plan_catch_up(cm1e_axis_t *axis, const cm1e_motion_limits_t *limits)
{
    coupling_t *c = axis->coupling;
    catch_up_t *catch_up = &c->catch_up;
    const cm1e_error_t error = catch_up->to_place ? cm1e_profile_to_position(&c->plan, &catch_up->now, 0.0, limits)
                                                  : cm1e_profile_to_velocity(&c->plan, &catch_up->now, 0.0, limits);
    catch_up->cycles = 0;
    catch_up->on = error != CM1E_OK || c->plan.duration_s > 0.0 || catch_up->now.position != 0.0;
    if (error != CM1E_OK) /* the numbers are too large for doubles: the catch-up stays, and the guard judges it */
        c->plan = (cm1e_profile_t){.end = catch_up->now};
}

/* Whether the catch-up makes up distance now, and not only velocity. A gear that accelerates may need all limits of the
 * axis. So distance is made up while the gear is steady and leaves some velocity. */
static bool goes_to_place(const cm1e_axis_t *axis, const from_t *f, bool steady)
{
    const double next_to_nothing = 1e-4 * axis->limits.maximum.velocity;
    const coupling_t *c = axis->coupling;
    if (c->now->to_position)
        return !c->catch_up.momentary;
    return (c->catch_up.made_up && steady && room_beside(axis, f) > next_to_nothing);
}

static void next_of_catch_up(cm1e_axis_t *axis)
{
    catch_up_t *catch_up = &axis->coupling->catch_up;
    cm1e_profile_sample(&axis->coupling->plan, (double)++catch_up->cycles * axis->cycle_s, &catch_up->now);
}

/* ---- the cycle --------------------------------------------------------------------------------------------------- */

static from_t sum_of(const cm1e_axis_t *axis, const from_t *f)
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

/* Whether the axis can go on within its limits: its jerk ends an acceleration before the maximum velocity, and where the
 * deceleration may be larger than the acceleration, turns the one into the other until the velocity changes its sign. */
static bool has_room(const cm1e_axis_t *axis, const from_t *sum)
{
    static const double rounding = 1.0 + 1e-6;
    const cm1e_motion_limits_t *most = &axis->limits.maximum;
    const double a = fabs(sum->acceleration), at_rest = most->acceleration * rounding, speed = fabs(sum->velocity);
    if (sum->acceleration * sum->velocity >= 0.0)
        return a <= at_rest && speed + a * a * axis->guarding.ease <= most->velocity * few;
    return a <= most->deceleration * rounding && a * a <= at_rest * at_rest + 2.0 * most->jerk * speed;
}

/* What moves beside the function uses next to nothing of the guard's tolerance of velocity, which is for its rounding. Here
 * `most` is a little more than the maximum. */
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

/* How the catch-up may go on in a cycle, in the order in which it is tried: by its plan; by a new plan with the whole
 * jerk, which may act against the jerk of the coupling function; by a new plan with the jerk that the function leaves,
 * and with parts of it, because the function may have begun its jerk within the cycle; without jerk, but for giving way
 * where the function takes all of a limit. */
typedef enum attempt {
    AS_PLANNED = 0, WITH_ALL_JERK, WITH_JERK_LEFT, WITH_HALF_OF_IT, WITH_QUARTER_OF_IT, WITHOUT_JERK, ATTEMPTS
} attempt_t;

static const double part_of_jerk_left[ATTEMPTS] = {
    [WITH_JERK_LEFT] = 1.0, [WITH_HALF_OF_IT] = 0.5, [WITH_QUARTER_OF_IT] = 0.25};

/* The smallest jerk that explains what the coupling function did in this cycle, if the jerk may change once in it. */
static double jerk_of_function(const cm1e_axis_t *axis, const from_t *f)
{
    const coupling_t *c = axis->coupling;
    const double t = axis->cycle_s, mean = (f->acceleration - c->f_acceleration) / t;
    const double beside = (f->velocity - c->f_velocity - (f->acceleration + c->f_acceleration) * t / 2.0) / (t * t);
    return 2.0 * fabs(beside) + sqrt(4.0 * beside * beside + mean * mean);
}

static double jerk_of_attempt(const cm1e_axis_t *axis, const from_t *f, attempt_t attempt)
{
    const double asked = axis->coupling->catch_up.asked.jerk;
    if (attempt == WITH_ALL_JERK)
        return asked;
    return part_of_jerk_left[attempt] * at_most(asked, axis->limits.maximum.jerk, jerk_of_function(axis, f));
}

/* u/s2; the largest acceleration at the end of a cycle, into which it changes evenly from `a`, with which the axis has room
 * then (has_room()), and its jerk can end the acceleration before the maximum velocity. */
static double largest_acceleration(const cm1e_axis_t *axis, double v, double a)
{
    const cm1e_motion_limits_t *most = &axis->limits.maximum;
    const double t = axis->cycle_s, jerk = most->jerk, half = jerk * t / 2.0, left = most->velocity - v - a * t / 2.0;
    if (v + a * t / 2.0 >= 0.0 && left < 0.0) /* it ends within the cycle: neither the end nor the mean is too fast */
        return smaller(2.0 * left / t, 6.0 * (most->velocity - v) / t - 2.0 * a);
    if (v + a * t / 2.0 >= 0.0)
        return smaller(most->acceleration, sqrt(half * half + 2.0 * jerk * left) - half);
    const double square = half * half + most->acceleration * most->acceleration - 2.0 * jerk * (v + a * t / 2.0);
    return smaller(most->deceleration, larger(most->acceleration, sqrt(square) - half));
}

/* u/s2; the acceleration nearest to `asked` that the axis can have at the end of the cycle. */
static double nearest_acceleration(const cm1e_axis_t *axis, double asked)
{
    const double v = axis->setpoint.velocity, a = axis->setpoint.acceleration;
    const double step = coupling_keeps_jerk(axis->coupling) ? axis->limits.maximum.jerk * axis->cycle_s : INFINITY;
    const double next = smaller(largest_acceleration(axis, v, a), larger(-largest_acceleration(axis, -v, -a), asked));
    return smaller(a + step, larger(a - step, next));
}

/* The catch-up is what is left between the function and a set-point of which the acceleration changes evenly, to that of
 * the function and the present catch-up as far as the limits of the axis allow. */
static void go_on_without_jerk(cm1e_axis_t *axis, const from_t *f)
{
    const cm1e_motion_state_t on_top = axis->superimposed.id ? axis->superimposed.now : (cm1e_motion_state_t){0};
    cm1e_motion_state_t *now = &axis->coupling->catch_up.now;
    const double t = axis->cycle_s, v = axis->setpoint.velocity, a = axis->setpoint.acceleration;
    const double next = nearest_acceleration(axis, f->acceleration + now->acceleration + on_top.acceleration);
    const double so_far = cm1e_position_minus(axis->setpoint.position, f->position) / axis->position.scale;
    *now = (cm1e_motion_state_t){so_far + t * (v + t * (2.0 * a + next) / 6.0) - on_top.position,
                                 v + t * (a + next) / 2.0 - f->velocity - on_top.velocity,
                                 next - f->acceleration - on_top.acceleration};
}

static void go_on(cm1e_axis_t *axis, const from_t *f, attempt_t attempt)
{
    catch_up_t *catch_up = &axis->coupling->catch_up;
    if (attempt > AS_PLANNED && attempt < WITHOUT_JERK) {
        const bool steady = f->acceleration == 0.0 && axis->coupling->f_acceleration == 0.0;
        catch_up->to_place = goes_to_place(axis, f, steady);
        const cm1e_motion_limits_t limits = limits_beside(axis, f, jerk_of_attempt(axis, f, attempt));
        plan_catch_up(axis, &limits);
    }
    if (attempt == WITHOUT_JERK) {
        go_on_without_jerk(axis, f);
        axis->coupling->plan.duration_s = INFINITY;
    } else if (catch_up->on) {
        next_of_catch_up(axis);
    }
}

/* Tries to go on from the present catch-up. Returns the set-point, and in `*verdict` whether it keeps the limits. */
static from_t attempt_to(cm1e_axis_t *axis, const from_t *f, attempt_t attempt, verdict_t *verdict)
{
    catch_up_t *catch_up = &axis->coupling->catch_up;
    const bool disturbed = f->acceleration != 0.0 || axis->coupling->f_acceleration != 0.0;
    catch_up->held_back = attempt == WITHOUT_JERK || (attempt > AS_PLANNED && disturbed);
    go_on(axis, f, attempt);
    const from_t sum = sum_of(axis, f);
    *verdict = judge_sum(axis, &sum);
    return sum;
}

/* Whether to look no further. Where the coupling function itself leads beyond a limit, a catch-up could hold the axis at
 * it for ever. */
static bool is_settled(const verdict_t *verdict)
{
    return verdict->smooth || verdict->guard.limit == GUARD_DIRECTION || verdict->guard.limit == GUARD_SOFTWARE_LIMIT;
}

/* Tries the attempts after the first one, which was not smooth. The first attempt that is smooth is taken; if none is,
 * the first one that keeps the limits at the set-points. */
CM1E_RARE static from_t with_next_attempts(cm1e_axis_t *axis, const from_t *f, const catch_up_t *before, attempt_t first,
                                           from_t sum, verdict_t *verdict)
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

/* Whether the slave still approaches, or ends its approach in this cycle. Where the master asks for too much on the curve
 * of the approach, the slave leaves the curve and makes up what it lags: it may be late then. */
static bool approaches(const cm1e_axis_t *axis) { return axis->setpoint.synchronizing && !axis->coupling->stopping; }

/* The catch-up was planned with the limits that the coupling function left at that time. If the function needs more,
 * the catch-up is planned anew in every cycle until it ends. */
static from_t with_catch_up(cm1e_axis_t *axis, const from_t *f, verdict_t *verdict)
{
    coupling_t *c = axis->coupling;
    if (!c->catch_up.on) {
        const from_t sum = sum_of(axis, f);
        *verdict = judge_sum(axis, &sum);
        if (!approaches(axis) || is_settled(verdict))
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
    return coupling_keeps_jerk(axis->coupling) && jerk_of_function(axis, f) > most * (1.0 + 1e-6) + rounding;
}

/* Whether the superimposed motion makes the acceleration of the sum larger than it may be behind the standstill, to which it
 * comes nearer. One whose share is more than that, because a maximum was lowered since, could not brake by its plan. */
static bool adds_too_much(const cm1e_axis_t *axis, const from_t *sum)
{
    const superimposed_t *on_top = &axis->superimposed;
    const cm1e_motion_limits_t *most = &axis->limits.maximum;
    const double a = sum->acceleration, either = smaller(most->acceleration, most->deceleration) * (1.0 + 1e-6);
    return coupling_keeps_jerk(axis->coupling) && fabs(a) > either && a * sum->velocity <= 0.0 &&
           on_top->now.acceleration * a > 0.0 && larger(on_top->share.acceleration, on_top->share.deceleration) <= either;
}

static bool lacks_room(const cm1e_axis_t *axis, const from_t *sum)
{
    return coupling_eases(axis->coupling) && !has_room(axis, sum);
}

static bool breaks_more_than_jerk(const cm1e_axis_t *axis, const from_t *sum)
{
    return cm1e_axis_guard(axis, sum, false).limit || lacks_room(axis, sum);
}

/* The superimposed motion goes on without jerk for a cycle, or, where the acceleration of the sum is too large, without
 * some of its own. It may pass its target then, and comes back. `adding`: it may add too much. false: that does not help. */
CM1E_RARE static bool goes_on_otherwise(cm1e_axis_t *axis, const from_t *f, const parts_t *before, bool adding, from_t *sum)
{
    verdict_t verdict;
    put_back(axis, before);
    if (cm1e_axis_superimposed_hold(axis, false)) {
        *sum = with_catch_up(axis, f, &verdict);
        if (!breaks_more_than_jerk(axis, sum) && (adding || !adds_too_much(axis, sum)))
            return true;
    }
    put_back(axis, before);
    if (!cm1e_axis_superimposed_ease(axis))
        return false;
    *sum = with_catch_up(axis, f, &verdict);
    return !breaks_more_than_jerk(axis, sum) && (adding || !adds_too_much(axis, sum));
}

/* With a superimposed motion, whose sum with the function breaks a limit: if it is the jerk alone, the superimposed motion
 * goes on without jerk as long as that leads neither beyond VelocityDiff nor beyond its target; then the jerk of the sum is
 * larger than the maximum, by that of the superimposed motion at most. */
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
        if (goes_on_otherwise(axis, f, before, false, &sum) || (breaks && goes_on_otherwise(axis, f, before, true, &sum))) {
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

static void emit(cm1e_axis_t *axis, const from_t *point)
{
    cm1e_axis_put_set_point(axis, point);
    cm1e_axis_set_synchronizing(axis, !axis->coupling->now->in_step);
    if (!cm1e_position_in_range(axis->setpoint.position))
        cm1e_axis_fail(axis, CM1E_ERROR_AXIS_POSITION_RANGE, cm1e_axis_units(axis, axis->setpoint.position),
                       cm1e_axis_farthest(axis));
}

/* Ends the catch-up. If lost distance is not made up (4.5, note 1), it becomes a part of the anchor. */
static void end_catch_up(cm1e_axis_t *axis)
{
    coupling_t *c = axis->coupling;
    const double left = c->plan.end.position;
    if (!c->catch_up.made_up)
        c->now->anchor = cm1e_position_plus(c->now->anchor, left * axis->position.scale);
    c->catch_up.on = false;
    c->catch_up.now = (cm1e_motion_state_t){0};
}

/* The profile of the catch-up has ended. Distance that is still to be made up waits until the function is steady. */
static void catch_up_ended(cm1e_axis_t *axis, const from_t *f)
{
    catch_up_t *catch_up = &axis->coupling->catch_up;
    if (!catch_up->made_up || catch_up->to_place ||
        fabs(catch_up->now.position * axis->position.scale) < rounding_counts) {
        end_catch_up(axis);
        return;
    }
    catch_up->held_back = catch_up->momentary = false;
    catch_up->to_place = goes_to_place(axis, f, f->acceleration == 0.0);
    if (!catch_up->to_place)
        return;
    const cm1e_motion_limits_t limits = limits_beside(axis, f, catch_up->asked.jerk);
    plan_catch_up(axis, &limits);
}

static void after_set_point(cm1e_axis_t *axis, const from_t *f)
{
    coupling_t *c = axis->coupling;
    catch_up_t *catch_up = &c->catch_up;
    const double time_s = (double)catch_up->cycles * axis->cycle_s;
    if (catch_up->on && time_s >= c->plan.duration_s - same_moment * axis->cycle_s)
        catch_up_ended(axis, f);
    if (axis->superimposed.id)
        cm1e_axis_superimposed_after(axis);
    cm1e_axis_set_reached(axis, !catch_up->on && c->now->in_step && coupling_sees_all(c->now));
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

/* Judges a set-point in the rare case: with a catch-up or a superimposed motion, or close to a limit. */
CM1E_RARE static guard_t judge(cm1e_axis_t *axis, const from_t *f, from_t *next)
{
    verdict_t verdict;
    *next = *f;
    if (axis->superimposed.id)
        *next = with_superimposed(axis, f, &verdict);
    else if (axis->coupling->catch_up.on || approaches(axis))
        *next = with_catch_up(axis, f, &verdict);
    else
        return cm1e_axis_look_closely(axis, f, coupling_keeps_jerk(axis->coupling));
    return verdict.guard;
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
    if (c->phasing.moving)
        cm1e_phasing_step(axis);
    if (has_to_stop(axis, cm1e_coupling_see(axis, c->now)))
        return stop_alone(axis, (guard_t){.limit = GUARD_KEPT});
    c->end_of_profile = false;
    c->now->function->evaluate(axis, c->now, &f);
    if (c->catch_up.on || axis->superimposed.id || approaches(axis) ||
        !cm1e_axis_well_within(axis, &f, coupling_keeps_jerk(c))) {
        const guard_t guard = judge(axis, &f, &sum);
        if (guard.limit)
            return stop_alone(axis, guard);
        next = &sum;
    }
    c->f_velocity = f.velocity;
    c->f_acceleration = f.acceleration;
    emit(axis, next);
    if (axis_follows(axis))
        after_set_point(axis, &f);
    if (c->keeps_ratio && axis_follows(axis)) {
        cm1e_coupling_keep_ratio(axis);
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

/* Whether a difference is only rounding. */
static bool is_nothing(const cm1e_axis_t *axis, const cm1e_motion_state_t *left)
{
    const double counts = 1e-6, t = axis->cycle_s, scale = fabs(axis->position.scale);
    return fabs(left->position) * scale < counts && fabs(left->velocity) * scale * t < counts &&
           fabs(left->acceleration) * scale * t * t < counts;
}

static bool is_something(const cm1e_motion_state_t *left)
{
    return left->position != 0.0 || left->velocity != 0.0 || left->acceleration != 0.0;
}

/* Begins the catch-up from the state `from`. If lost distance is not made up, the coupling function begins at the
 * position of the axis. A difference that is only rounding does not move the anchor, because it would add up. `across`:
 * a master on another bus may have changed its velocity at any place of a cam. Then the velocity comes first, with all
 * that the cam leaves there, and the position after it, as at the beginning of a cam. */
static void begin_catch_up(cm1e_axis_t *axis, const from_t *from, const cm1e_motion_limits_t *asked, bool made_up,
                           bool across)
{
    coupling_t *c = axis->coupling;
    from_t f;
    c->now->function->evaluate(axis, c->now, &f);
    double counts = cm1e_position_minus(from->position, f.position);
    if (!made_up) {
        if (fabs(counts) > rounding_counts)
            c->now->anchor = cm1e_position_plus(c->now->anchor, counts);
        counts = 0.0;
    }
    cm1e_axis_look_anew(axis);
    c->f_velocity = f.velocity;
    c->f_acceleration = f.acceleration;
    c->catch_up = (catch_up_t){.asked = *asked, .made_up = made_up, .momentary = across && c->now->to_position,
                       .now = {counts / axis->position.scale, from->velocity - f.velocity,
                               from->acceleration - f.acceleration},
                       .held_back = f.acceleration != 0.0};
    if (is_nothing(axis, &c->catch_up.now))
        c->catch_up.now = (cm1e_motion_state_t){0};
    if (c->catch_up.held_back) { /* the first set-point plans it, as every one while the function accelerates */
        c->catch_up.on = is_something(&c->catch_up.now);
        return;
    }
    c->catch_up.to_place = goes_to_place(axis, &f, f.acceleration == 0.0);
    const cm1e_motion_limits_t limits = limits_beside(axis, &f, asked->jerk);
    plan_catch_up(axis, &limits);
}

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
    c->end_of_profile = c->stopping = c->due = false;
    begin_catch_up(axis, from, asked, c->now->to_position, false);
    cm1e_axis_set_source(axis, &cm1e_source_coupling);
    if (!followed)
        cm1e_axis_guard_renew(axis); /* else its numbers are of the present limits, and begin_catch_up() ended its course */
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
    const master_trouble_t trouble = cm1e_coupling_look(axis, c->now);
    if (trouble && !(c->stopping && trouble == MASTER_STOPPING)) {
        (void)stop_alone(axis, (guard_t){.limit = GUARD_KEPT});
        return;
    }
    /* A slave that was in step makes up the distance. One that was still on its way does not (4.5, note 1). Nor does a
     * motor in CSV that went on by itself: it is not moved back. */
    const bool was_in_step = !c->catch_up.on || c->catch_up.made_up, comes_back = axis->mode == CM1E_MODE_CSP ||
                                                                          axis->silence.silent_before > 0;
    begin_catch_up(axis, &from, &asked, c->now->to_position || (was_in_step && comes_back), across);
    cm1e_axis_set_synchronizing(axis, !c->now->in_step);
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
    begin_catch_up(axis, &from, &asked, c->now->to_position || was_in_step, true);
    cm1e_axis_set_synchronizing(axis, !c->now->in_step);
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
    const from_t point = sum_of(axis, &f);
    emit(axis, &point);
}
