/*
 * Checks set-points that the axis has not planned itself. A set-point that the motor could not follow within the limits
 * of the axis is not sent to it.
 *
 * Only the ends of cycles are known. So a cycle is judged by the gentlest motion that leads from one end to the other:
 * a step of the velocity or of the acceleration inside a cycle is seen if it needs more than the limits at its ends, or
 * more jerk inside. What stays unseen is a detour of the position that is over at the end of the cycle, which no motor
 * is sent, and a step of the position of less than a quarter of (acceleration * cycle time^2). Of an axis of a group
 * the ends alone are judged, because the time of its path may run slower from within a cycle on. Without a limit of
 * jerk (a linear cam, an actual value, a stop) the velocity may step by what the acceleration makes of it in a cycle.
 */
#include <math.h>
#include <stdio.h>

#include "axis/axis_guard.h"
#include "axis/axis_events.h"
#include "axis/axis_lead.h"
#include "axis/axis_limits.h"
#include "axis/axis_position.h"
#include "axis/axis_setpoint.h"
#include "core/extreme.h"
#include "core/rare.h"

/* Tolerances for rounding: relative, and in counts. */
static const double slack = 1e-6;
static const double slack_counts = 1e-5;

static guard_t broken(guard_limit_t limit, double asked, double allowed)
{
    return (guard_t){.limit = limit, .asked = asked, .allowed = allowed};
}

/* The limits that apply. A follower keeps what the application allows at present. A led axis keeps the limits of motor
 * and configuration, because its leader planned with what was allowed at the start. */
static const cm1e_motion_limits_t *limits_of(const cm1e_axis_t *axis)
{
    return axis_led(axis) ? &axis->limits.system : &axis->limits.maximum;
}

/* Checks the change of the velocity in a cycle. If the velocity changes its sign, both limits apply in turn. */
static guard_t guard_acceleration(const cm1e_axis_t *axis, const from_t *next)
{
    const cm1e_motion_limits_t *most = limits_of(axis);
    const double v0 = axis->setpoint.velocity, v1 = next->velocity, a = next->acceleration, t = axis->cycle_s;
    const bool turns = v0 * v1 < 0.0, grows = fabs(v1) >= fabs(v0);
    const double bound = turns ? larger(most->acceleration, most->deceleration)
                         : grows ? most->acceleration : most->deceleration;
    const double change = fabs(v1 - v0) / t, either = larger(most->acceleration, most->deceleration);
    const double noise = slack_counts / fabs(axis->position.scale) / t;
    const guard_limit_t limit = !turns && !grows ? GUARD_DECELERATION : GUARD_ACCELERATION;
    if (change > bound * (1.0 + slack) + noise)
        return broken(limit, change, bound);
    if (fabs(a) > either * (1.0 + slack) + noise)
        return broken(limit, fabs(a), either);
    return broken(GUARD_KEPT, 0.0, 0.0);
}

/* Checks the step of the position in a cycle, while the velocity changes within the limits. */
static guard_t guard_step(const cm1e_axis_t *axis, const from_t *next, bool kept_jerk)
{
    const double t = axis->cycle_s;
    const double step = cm1e_position_minus(next->position, axis->setpoint.position) / axis->position.scale;
    const double mean = (axis->setpoint.velocity + next->velocity) * 0.5 * t;
    const double most = larger(limits_of(axis)->acceleration, limits_of(axis)->deceleration) * t * t /
                        (kept_jerk ? 4.0 : 1.0); /* without a limit of jerk it may change at any moment */
    /* The rounding of a double that holds the whole position. */
    const double far = 1e-15 * fabs(cm1e_axis_line(axis, next->position)) + slack_counts / fabs(axis->position.scale);
    if (!(fabs(step - mean) <= most * (1.0 + slack) + slack * fabs(mean) + far))
        return broken(GUARD_STEP, step, mean);
    return broken(GUARD_KEPT, 0.0, 0.0);
}

/* Whether the axis leaves its software limits. The velocity of an estimated master at rest is noise, so the positions
 * decide the direction. An axis outside the limits may come back. */
static bool leaves_limits(const cm1e_axis_t *axis, double line)
{
    const double before = cm1e_axis_line(axis, axis->setpoint.position);
    return axis->limits.software_limits && ((line > axis->limits.upper + axis->limits.tolerance && line > before) ||
                                            (line < axis->limits.lower - axis->limits.tolerance && line < before));
}

/* The smallest jerk that leads from one velocity and acceleration to the next within the cycle. It changes once. */
static double jerk_inside(const cm1e_axis_t *axis, const from_t *next)
{
    const double t = axis->cycle_s, a0 = axis->setpoint.acceleration, gain = next->velocity - axis->setpoint.velocity;
    const double mean = (next->acceleration - a0) / t, noise = 1e-12 * fabs(next->velocity);
    const double beside = larger(fabs(gain - (a0 + next->acceleration) * t / 2.0) - noise, 0.0) / (t * t);
    return 2.0 * beside + sqrt(4.0 * beside * beside + mean * mean);
}

/* The limits of the acceleration by its sign, u/s2. If the velocity changes its sign, both limits apply in turn. */
typedef struct bounds {
    double up, down;
} bounds_t;

static bounds_t bounds_between(const cm1e_motion_limits_t *most, double v0, double v)
{
    const double either = larger(most->acceleration, most->deceleration);
    if (v0 > 0.0 && v > 0.0)
        return (bounds_t){most->acceleration, most->deceleration};
    if (v0 < 0.0 && v < 0.0)
        return (bounds_t){most->deceleration, most->acceleration};
    return (bounds_t){either, either};
}

/* u/s2. Two ways make the second difference of the set positions: what the acceleration adds in a cycle to the way of
 * its first velocity (`early`), and what was missing in the cycle before to the way of its last velocity (`late`). Each
 * of them may use half of the limit. */
typedef struct differences {
    double early, late, noise;
} differences_t;

static differences_t differences(const cm1e_axis_t *axis, const from_t *next, double step)
{
    const double v0 = axis->setpoint.velocity, v = next->velocity, t = axis->cycle_s;
    return (differences_t){2.0 * (step - v0 * t) / (t * t), 2.0 * (v * t - step) / (t * t),
                           2e-9 / fabs(axis->position.scale) / (t * t) + 2e-13 * fabs(v) / t};
}

static guard_t guard_second_difference(const cm1e_axis_t *axis, const from_t *next)
{
    const double v = next->velocity;
    const bounds_t bounds = bounds_between(limits_of(axis), axis->setpoint.velocity, v);
    const double step = cm1e_position_minus(next->position, axis->setpoint.position) / axis->position.scale;
    const differences_t made = differences(axis, next, step);
    const double most = larger(made.early, made.late), least = smaller(made.early, made.late);
    if (most > bounds.up * (1.0 + slack) + made.noise)
        return broken(v < 0.0 ? GUARD_DECELERATION : GUARD_ACCELERATION, most, bounds.up);
    if (least < -bounds.down * (1.0 + slack) - made.noise)
        return broken(v > 0.0 ? GUARD_DECELERATION : GUARD_ACCELERATION, -least, bounds.down);
    return broken(GUARD_KEPT, 0.0, 0.0);
}

CM1E_RARE guard_t cm1e_axis_look_closely(const cm1e_axis_t *axis, const from_t *next, bool kept_jerk)
{
    const cm1e_motion_limits_t *most = limits_of(axis);
    const double v = next->velocity, a = next->acceleration, line = cm1e_axis_line(axis, next->position);
    if (!isfinite(v) || !isfinite(a))
        return broken(GUARD_FINITE, 0.0, 0.0);
    /* The velocity rises by this peak before the jerk has ended the acceleration. */
    const double peak = fabs(v) + (kept_jerk && a * v > 0.0 ? a * a * axis->guarding.ease : 0.0);
    if (peak > most->velocity * (1.0 + slack))
        return broken(GUARD_VELOCITY, peak, most->velocity);
    if (fabs(v) > axis->limits.tolerance && !cm1e_axis_direction_enabled(axis, v))
        return broken(GUARD_DIRECTION, v, 0.0);
    guard_t guard = guard_acceleration(axis, next);
    if (guard.limit)
        return guard;
    const double jerk = fabs(a - axis->setpoint.acceleration) / axis->cycle_s;
    const double jerk_noise = 1e-9 * larger(most->acceleration, most->deceleration) / axis->cycle_s;
    if (kept_jerk && jerk > most->jerk * (1.0 + slack) + jerk_noise)
        return broken(GUARD_JERK, jerk, most->jerk);
    if (kept_jerk && !axis_led(axis)) {
        const double inside = jerk_inside(axis, next);
        if (inside > most->jerk * (1.0 + slack) + jerk_noise)
            return broken(GUARD_JERK, inside, most->jerk);
        guard = guard_second_difference(axis, next);
        if (guard.limit)
            return guard;
    }
    guard = guard_step(axis, next, kept_jerk);
    if (guard.limit)
        return guard;
    if (!cm1e_axis_limits_can_stop(axis, line, (cm1e_motion_state_t){0.0, v, a}))
        return broken(GUARD_SOFTWARE_LIMIT, line, v > 0.0 ? axis->limits.upper : axis->limits.lower);
    if (leaves_limits(axis, line))
        return broken(GUARD_SOFTWARE_LIMIT, line, line > axis->limits.upper ? axis->limits.upper : axis->limits.lower);
    return guard;
}

static bool is_within(double difference, bounds_t bounds, double noise)
{
    return difference <= bounds.up * (1.0 + slack) + noise && -difference <= bounds.down * (1.0 + slack) + noise;
}

/* Whether a cycle in which the velocity changes its sign keeps both limits: the axis brakes in it if its way leads on,
 * and accelerates already if that leads back. */
CM1E_RARE static bool turns_within_limits(const cm1e_axis_t *axis, const from_t *next, double step)
{
    const cm1e_motion_limits_t *most = limits_of(axis);
    const differences_t made = differences(axis, next, step);
    return is_within(made.early, bounds_between(most, axis->setpoint.velocity, step), made.noise) &&
           is_within(made.late, bounds_between(most, step, next->velocity), made.noise);
}

/* The largest change of the velocity in t, from acceleration a to b, without an acceleration above `most`. */
static double largest_gain(double a, double b, double t, double jerk, double per_jerk, double most)
{
    const double peak = (a + b + jerk * t) / 2.0;
    if (peak <= most)
        return (a + b) / 2.0 * t + (jerk * t - (b - a)) * (jerk * t + (b - a)) * (per_jerk / 4.0);
    return most * t - ((most - a) * (most - a) + (most - b) * (most - b)) * (per_jerk / 2.0);
}

/* The farthest position that a jerk of at most 1 reaches in a time of 1 from rest, if it ends with acceleration x and
 * velocity y. The jerk of that motion changes its sign twice. */
static double farthest(double x, double y)
{
    const double against = larger((1.0 - x) / 2.0, slack), middle = (0.5 - y) / (2.0 * against);
    return 1.0 / 6.0 - against * (middle * middle + against * against / 12.0);
}

CM1E_RARE bool cm1e_axis_guard_smooth(const cm1e_axis_t *axis, const from_t *next)
{
    const cm1e_motion_limits_t *most = limits_of(axis);
    const double t = axis->cycle_s, jerk = most->jerk, v0 = axis->setpoint.velocity, a0 = axis->setpoint.acceleration;
    const double v = next->velocity, a = next->acceleration;
    const double per_jerk = 1.0 / jerk, per_t = 1.0 / t; /* most of the time here is that of divisions */
    const bounds_t bounds = bounds_between(most, v0, v);
    const double noise = slack * jerk * t * t + 1e-12 * fabs(v), gain = v - v0;
    if (gain > largest_gain(a0, a, t, jerk, per_jerk, larger(bounds.up, larger(a0, a))) + noise ||
        -gain > largest_gain(-a0, -a, t, jerk, per_jerk, larger(bounds.down, larger(-a0, -a))) + noise)
        return false;
    const double per_count = axis->guarding.per_count;
    const double step = cm1e_position_minus(next->position, axis->setpoint.position) * per_count;
    if (v0 * v < 0.0 && !turns_within_limits(axis, next, step))
        return false;
    /* Of a jerk for a cycle. */
    const double unit_a = per_jerk * per_t, unit_v = unit_a * per_t, unit_s = unit_v * per_t;
    const double x = (a - a0) * unit_a, y = (gain - a0 * t) * unit_v, z = (step - t * (v0 + t * a0 / 2.0)) * unit_s;
    const double few = slack + (1e-9 * fabs(per_count) + 1e-13 * fabs(step)) * unit_s;
    return z <= farthest(x, y) + few && -z <= farthest(-x, -y) + few;
}

bool cm1e_axis_well_ahead(const cm1e_axis_t *axis, const cm1e_motion_bounds_t *most, double lowest, double highest)
{
    const guarding_t *g = &axis->guarding;
    const double t = axis->cycle_s, v = most->velocity, a = most->acceleration, j = most->jerk;
    const double line = cm1e_axis_line(axis, axis->setpoint.position), way = v * v * axis->limits.emergency_way;
    const bool steps = isinf(j); /* of the velocity, within a cycle */
    const double beside = steps ? a * t * t / 2.0 : j * t * t * t / 12.0; /* u; of a step, the mean velocity */
    if (!steps && !(j * t <= g->jerk && v + a * a * g->ease <= g->velocity &&
                    a * t + 2.0 * beside / t <= smaller(g->up, g->down)))
        return false;
    return axis->power.enable_positive && axis->power.enable_negative && v <= g->velocity && a <= g->acceleration &&
           a * t <= smaller(g->up, g->down) && beside <= g->step * fabs(g->per_count) &&
           (!axis->limits.software_limits ||
            (line + highest + way <= axis->limits.upper && line + lowest - way >= axis->limits.lower)) &&
           cm1e_position_reaches(axis->setpoint.position, highest * axis->position.scale) &&
           cm1e_position_reaches(axis->setpoint.position, lowest * axis->position.scale);
}

void cm1e_axis_guard_decide(cm1e_axis_t *axis, bool kept, uint32_t leaders_course)
{
    axis->guarding.own_course = axis->setpoint.course;
    axis->guarding.kept_course = kept ? axis->setpoint.course : axis->setpoint.course - 1;
    axis->guarding.leaders_course = leaders_course;
}

void cm1e_axis_guard_renew(cm1e_axis_t *axis)
{
    const cm1e_motion_limits_t *most = limits_of(axis);
    const double t = axis->cycle_s, either = larger(most->acceleration, most->deceleration);
    cm1e_axis_look_anew(axis);
    axis->guarding = (guarding_t){
        .velocity = most->velocity,
        .up = most->acceleration * t,
        .down = most->deceleration * t,
        .acceleration = either,
        .jerk = most->jerk * t,
        .twice_jerk = axis_led(axis) ? 0.0 : 2.0 * most->jerk, /* the time of a path may change within a cycle */
        .ease = axis_led(axis) ? 0.0 : 0.5 / most->jerk, /* the group has planned its path with these limits */
        .half_cycle = axis->position.scale * t / 2.0,
        .step = either * t * t / 4.0 * fabs(axis->position.scale) + slack_counts,
        .per_count = 1.0 / axis->position.scale,
        .per_step = axis_led(axis) ? 0.0 : 2.0 / (fabs(axis->position.scale) * t),
        .own_course = axis->setpoint.course - 1, /* nothing was decided about this one */
        .kept_course = axis->setpoint.course - 1,
    };
}

void cm1e_axis_guard_fail(cm1e_axis_t *axis, guard_t guard)
{
    guard.by_actual = axis_follows(axis) && axis->coupling_hooks->by_actual(axis);
    if (axis->state != CM1E_AXIS_ERROR_STOP)
        axis->broken = guard;
    cm1e_axis_fail(axis, guard.from_outside ? CM1E_ERROR_AXIS_SET_POINT_LIMIT : CM1E_ERROR_AXIS_COUPLING_LIMIT,
                   guard.asked, guard.allowed);
}

/* What was commanded, with the numbers commanded and allowed. */
static const char *const said[GUARD_COUNT] = {
    [GUARD_KEPT] = "nothing",
    [GUARD_FINITE] = "a set-point that is not a finite number, or too far away",
    [GUARD_PAUSE] = "motion after a pause of the cycle, in which the motor ran on at %.6g u/s",
    [GUARD_DIRECTION] = "a velocity of %.6g u/s, in a direction that MC_Power does not enable",
    [GUARD_VELOCITY] = "a velocity of %.6g u/s; up to %.6g u/s is right",
    [GUARD_ACCELERATION] = "an acceleration of %.6g u/s2; up to %.6g u/s2 is right",
    [GUARD_DECELERATION] = "a deceleration of %.6g u/s2; up to %.6g u/s2 is right",
    [GUARD_JERK] = "a jerk of %.6g u/s3; up to %.6g u/s3 is right",
    [GUARD_STEP] = "a step of %.6g u in a cycle in which its velocity covers %.6g u",
    [GUARD_SOFTWARE_LIMIT] = "the position %.6g u, from which it cannot stop before the software limit at %.6g u",
};

void cm1e_axis_guard_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    char asked[160];
    const bool outside = axis->broken.from_outside;
    if (outside && axis->broken.limit == GUARD_PAUSE) {
        snprintf(text, size,
                 "Axis \"%s\": it followed positions from outside at %.6g u/s, and the bus paused or was silent for so "
                 "long that the motor could not go on with them. The axis was braked. Look at overruns of the cycle "
                 "and lost frames; then reset the axis with MC_Reset.", axis->config->name, axis->broken.asked);
        return;
    }
    snprintf(asked, sizeof asked, said[axis->broken.limit], axis->broken.asked, axis->broken.allowed);
    snprintf(text, size,
             "Axis \"%s\": %s commanded %s. That set-point was not given to the motor, and "
             "the axis was braked. Reduce the dynamics of %s, or raise the limits of this "
             "axis%s; then reset the axis with MC_Reset.",
             axis->config->name, outside ? "a set-point from outside" : "its coupling or its axes group", asked,
             outside ? "its planner" : "the master or of the group",
             axis->broken.by_actual ? ", or filter the actual value of its master more (encoder_filter_s of the master)"
                                    : "");
}
