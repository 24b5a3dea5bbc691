/* The catch-up: how it begins, goes on and ends, within what the coupling function leaves of the limits of the axis
 * (coupling_private.h). */
#include <math.h>

#include "axis/axis_position.h"
#include "axis/axis_setpoint.h"
#include "core/extreme.h"
#include "coupling/coupling_private.h"

static const double same_moment = 1e-6; /* cycles */
static const double rounding_counts = 1e-3;

/* ---- its limits and its plan ------------------------------------------------------------------------------------- */

/* The part of a limit that the catch-up always gets, so that it comes to an end. */
static const double minimum_part = 0.01;

static double rest_of(double asked, double most, double used)
{
    return smaller(asked, larger(minimum_part * most, most - used));
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
                   smaller(larger(minimum_part * most, left), room_beside(axis, f)));
}

/* The maximum velocity, acceleration and jerk that the cam needs anywhere, at the present velocity of the master. */
static cm1e_motion_limits_t cam_demand(const follow_t *follow)
{
    const cam_place_t *cam = &follow->cam;
    const double once = 1.0 / fabs(cam->master_scaling), all = fabs(cam->slave_scaling) * once;
    cm1e_curve_extremes_t scaled = cam->slot->cam.extremes;
    cm1e_motion_limits_t demand;
    scaled.least_slope *= all;
    scaled.most_slope *= all;
    scaled.curvature *= all * once;
    scaled.third *= all * once * once;
    cm1e_approach_demand(&scaled, follow->links[0].seen.velocity, &demand);
    return demand;
}

static double part_of(double asked, double most, double needed)
{
    const double smallest = 0.1, largest = 0.5; /* a part: the master may become faster */
    return smaller(asked, larger(smaller(most - needed, largest * most), smallest * most));
}

/* What the cam leaves of the limits of the axis at the present velocity of the master. */
static cm1e_motion_limits_t limits_beside_cam(const cm1e_axis_t *axis, const follow_t *follow,
                                              const cm1e_motion_limits_t *asked)
{
    const cm1e_motion_limits_t nothing = {0}, *most = &axis->limits.maximum;
    const cm1e_motion_limits_t needed = follow->cam.slot ? cam_demand(follow) : nothing;
    /* Both are bounded alike, because a deceleration of the catch-up may accelerate the axis. */
    const double change = part_of(smaller(asked->acceleration, asked->deceleration),
                                  smaller(most->acceleration, most->deceleration),
                                  larger(needed.acceleration, needed.deceleration));
    return (cm1e_motion_limits_t){
        .velocity = part_of(asked->velocity, most->velocity, needed.velocity),
        .acceleration = change,
        .deceleration = change,
        .jerk = part_of(asked->jerk, most->jerk, needed.jerk),
    };
}

/* The limits of the catch-up: those of the axis without what the coupling function uses. The velocity of the catch-up
 * goes to 0 while the velocity of the axis changes to that of the function. Where the acceleration of the function
 * helps that change, the catch-up has the whole limits. */
static cm1e_motion_limits_t limits_beside(const cm1e_axis_t *axis, const from_t *f, double jerk)
{
    const catch_up_t *catch_up = &axis->coupling->catch_up;
    if (axis->coupling->now->to_position && !catch_up->momentary)
        return limits_beside_cam(axis, axis->coupling->now, &catch_up->asked);
    const cm1e_motion_limits_t *most = &axis->limits.maximum;
    const double now = f->velocity + catch_up->now.velocity, way = catch_up->now.velocity > 0.0 ? -1.0 : 1.0;
    const bool helps = f->acceleration * way <= 0.0 && catch_up->now.acceleration * way >= 0.0;
    const double used = helps ? 0.0 : fabs(f->acceleration);
    const double up = rest_of(catch_up->asked.acceleration, most->acceleration, used);
    const double down = rest_of(catch_up->asked.deceleration, most->deceleration, used);
    const double change = now * f->velocity < 0.0 ? smaller(up, down) : fabs(f->velocity) > fabs(now) ? up : down;
    const double velocity = catch_up->to_place ? velocity_to_place(axis, f)
                                               : 2.0 * (most->velocity + fabs(catch_up->now.velocity));
    return (cm1e_motion_limits_t){velocity, change, change, jerk};
}

/* An estimate of an actual value is never quite even: what is far from the limits of the axis is its noise. */
static double largest_unevenness(const cm1e_axis_t *axis)
{
    const double part = 0.5;
    const cm1e_motion_limits_t *most = &axis->limits.maximum;
    return axis->coupling->now->by_actual ? part * smaller(most->acceleration, most->deceleration) : 0.0;
}

/* Whether the catch-up makes up distance now, and not only velocity. A gear that accelerates may need all limits of the
 * axis. So distance is made up while the gear is steady and leaves some velocity. */
static bool goes_to_place(const cm1e_axis_t *axis, const from_t *f)
{
    const double next_to_nothing = 1e-4 * axis->limits.maximum.velocity;
    const coupling_t *c = axis->coupling;
    const double most = largest_unevenness(axis);
    const bool steady = fabs(f->acceleration) <= most && fabs(c->f_acceleration) <= most;
    if (c->now->to_position)
        return !c->catch_up.momentary;
    return c->catch_up.made_up && steady && room_beside(axis, f) > next_to_nothing;
}

static void plan(cm1e_axis_t *axis, const from_t *f, double jerk)
{
    coupling_t *c = axis->coupling;
    catch_up_t *catch_up = &c->catch_up;
    catch_up->to_place = goes_to_place(axis, f);
    const cm1e_motion_limits_t limits = limits_beside(axis, f, jerk);
    const cm1e_error_t error = catch_up->to_place ? cm1e_profile_to_position(&c->plan, &catch_up->now, 0.0, &limits)
                                                  : cm1e_profile_to_velocity(&c->plan, &catch_up->now, 0.0, &limits);
    catch_up->cycles = 0;
    catch_up->on = error != CM1E_OK || c->plan.duration_s > 0.0 || catch_up->now.position != 0.0;
    if (error != CM1E_OK) /* the numbers are too large for doubles: the catch-up stays, and the guard judges it */
        c->plan = (cm1e_profile_t){.end = catch_up->now};
}

/* ---- a cycle of it ----------------------------------------------------------------------------------------------- */

static const double part_of_jerk_left[ATTEMPTS] = {
    [WITH_JERK_LEFT] = 1.0, [WITH_HALF_OF_IT] = 0.5, [WITH_QUARTER_OF_IT] = 0.25};

double cm1e_coupling_jerk(const cm1e_axis_t *axis, const from_t *f)
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
    return part_of_jerk_left[attempt] * rest_of(asked, axis->limits.maximum.jerk, cm1e_coupling_jerk(axis, f));
}

/* u/s2; the acceleration at the end of a cycle, into which it changes evenly from `a`, that is the maximum where the
 * velocity changes its sign. Before, it may be the maximum deceleration. */
static double passing_zero(double v, double a, double most, double t)
{
    return v < 0.0 && a > most ? a + (a * a - most * most) * t / (2.0 * v) : most;
}

/* u/s2; the largest acceleration at the end of a cycle, into which it changes evenly from `a`, with which the axis has
 * room then (has_room()), and its jerk can end the acceleration before the maximum velocity. */
static double largest_acceleration(const cm1e_axis_t *axis, double v, double a)
{
    const cm1e_motion_limits_t *most = &axis->limits.maximum;
    const double t = axis->cycle_s, jerk = most->jerk, half = jerk * t / 2.0, left = most->velocity - v - a * t / 2.0;
    if (v + a * t / 2.0 >= 0.0 && left < 0.0) /* it ends within the cycle: neither the end nor the mean is too fast */
        return smaller(2.0 * left / t, 6.0 * (most->velocity - v) / t - 2.0 * a);
    if (v + a * t / 2.0 >= 0.0)
        return smaller(passing_zero(v, a, most->acceleration, t), sqrt(half * half + 2.0 * jerk * left) - half);
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

/* u/s2; towards a velocity, and no more than the jerk of the axis can end there. */
static double acceleration_to(const cm1e_axis_t *axis, double velocity)
{
    const double left = velocity - axis->setpoint.velocity, speed = fabs(left);
    return copysign(smaller(speed / axis->cycle_s, sqrt(2.0 * axis->limits.maximum.jerk * speed)), left);
}

/* The catch-up is what is left between the function and a set-point of which the acceleration changes evenly, to that
 * of the function and the present catch-up as far as the limits of the axis allow. The acceleration of an estimate that
 * is disturbed leads to nothing: only its velocity counts. */
static void go_on_without_jerk(cm1e_axis_t *axis, const from_t *f)
{
    const cm1e_motion_state_t on_top = axis->superimposed.id ? axis->superimposed.now : (cm1e_motion_state_t){0};
    cm1e_motion_state_t *now = &axis->coupling->catch_up.now;
    const double t = axis->cycle_s, v = axis->setpoint.velocity, a = axis->setpoint.acceleration;
    const double asked = axis->coupling->settling > 0 ? acceleration_to(axis, f->velocity + on_top.velocity)
                                                      : f->acceleration + now->acceleration + on_top.acceleration;
    const double next = nearest_acceleration(axis, asked);
    const double so_far = cm1e_position_minus(axis->setpoint.position, f->position) / axis->position.scale;
    *now = (cm1e_motion_state_t){so_far + t * (v + t * (2.0 * a + next) / 6.0) - on_top.position,
                                 v + t * (a + next) / 2.0 - f->velocity - on_top.velocity,
                                 next - f->acceleration - on_top.acceleration};
}

void cm1e_catch_up_step(cm1e_axis_t *axis, const from_t *f, attempt_t attempt)
{
    coupling_t *c = axis->coupling;
    catch_up_t *catch_up = &c->catch_up;
    const bool disturbed = f->acceleration != 0.0 || c->f_acceleration != 0.0;
    catch_up->held_back = attempt == WITHOUT_JERK || (attempt > AS_PLANNED && disturbed);
    if (attempt == WITHOUT_JERK) {
        go_on_without_jerk(axis, f);
        c->plan.duration_s = INFINITY;
        return;
    }
    if (attempt > AS_PLANNED)
        plan(axis, f, jerk_of_attempt(axis, f, attempt));
    if (catch_up->on)
        cm1e_profile_sample(&c->plan, (double)++catch_up->cycles * axis->cycle_s, &catch_up->now);
}

/* ---- its beginning and its end ----------------------------------------------------------------------------------- */

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

/* A difference that is only rounding does not move the anchor, because it would add up. */
void cm1e_catch_up_begin(cm1e_axis_t *axis, const from_t *from, const cm1e_motion_limits_t *asked,
                         distance_rule_t rule, catch_up_order_t order)
{
    coupling_t *c = axis->coupling;
    from_t f;
    c->now->function->evaluate(axis, c->now, &f);
    double counts = cm1e_position_minus(from->position, f.position);
    if (rule == DISTANCE_IS_LOST) {
        if (fabs(counts) > rounding_counts)
            c->now->anchor = cm1e_position_plus(c->now->anchor, counts);
        counts = 0.0;
    }
    cm1e_axis_look_anew(axis);
    c->f_velocity = f.velocity;
    c->f_acceleration = f.acceleration;
    c->catch_up = (catch_up_t){.asked = *asked, .made_up = rule == DISTANCE_IS_MADE_UP,
                       .momentary = order == VELOCITY_FIRST && c->now->to_position,
                       .now = {counts / axis->position.scale, from->velocity - f.velocity,
                               from->acceleration - f.acceleration},
                       .held_back = f.acceleration != 0.0};
    if (is_nothing(axis, &c->catch_up.now))
        c->catch_up.now = (cm1e_motion_state_t){0};
    if (c->catch_up.held_back) { /* the first set-point plans it, as every one while the function accelerates */
        c->catch_up.on = is_something(&c->catch_up.now);
        return;
    }
    plan(axis, &f, asked->jerk);
}

/* If lost distance is not made up (4.5, note 1), it becomes a part of the anchor. */
static void end(cm1e_axis_t *axis)
{
    coupling_t *c = axis->coupling;
    const double left = c->plan.end.position;
    if (!c->catch_up.made_up)
        c->now->anchor = cm1e_position_plus(c->now->anchor, left * axis->position.scale);
    c->catch_up.on = false;
    c->catch_up.now = (cm1e_motion_state_t){0};
}

/* Distance that is still to be made up at the end of the profile waits until the function is steady. */
void cm1e_catch_up_after(cm1e_axis_t *axis, const from_t *f)
{
    catch_up_t *catch_up = &axis->coupling->catch_up;
    const double time_s = (double)catch_up->cycles * axis->cycle_s;
    if (time_s < axis->coupling->plan.duration_s - same_moment * axis->cycle_s)
        return;
    if (!catch_up->made_up || catch_up->to_place ||
        fabs(catch_up->now.position * axis->position.scale) < rounding_counts) {
        end(axis);
        return;
    }
    catch_up->held_back = catch_up->momentary = false;
    if (goes_to_place(axis, f))
        plan(axis, f, catch_up->asked.jerk);
}
