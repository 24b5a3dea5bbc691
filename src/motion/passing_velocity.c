/* Maximum velocity with which a position can be passed. The fastest change from (v, a) to a velocity w >= 0 needs the
 * smallest distance for the velocity to which reducing the acceleration to 0 leads. Above it the distance grows with w,
 * at first about like a square root. Below it, while braking, the distance first grows with falling w and then shrinks,
 * since reducing the deceleration at a higher velocity takes more distance. So the velocities that fit into a distance
 * are those up to some velocity and those between two higher ones; either set may be empty. */
#include <math.h>

#include "core/extreme.h"
#include "motion/pieces.h"

enum { SOLVER_STEPS_MAX = 200, NEWTON_STEPS = 12 };

/** All values are mirrored so that the target is passed with a velocity >= 0. */
typedef struct {
    const cm1e_motion_limits_t *limits;
    double velocity, acceleration, distance, noise;
} passing_t;

static double way(const passing_t *passing, double velocity)
{
    cm1e_pieces_t change;
    change.count = 0;
    cm1e_pieces_append_velocity_change(&change, passing->velocity, passing->acceleration, velocity, passing->limits);
    return cm1e_pieces_displacement(&change, passing->velocity);
}

/** Whether cm1e_profile_to_state() goes there without a run-up. */
static bool fits(const passing_t *passing, double velocity)
{
    const double needed = way(passing, velocity);
    return needed - passing->distance <=
           passing->noise + 4 * DBL_EPSILON * fabs(needed) + CM1E_MOTION_TOO_SHORT * fabs(needed);
}

/** The limit between a velocity that fits and one that does not: regula falsi in the root of the velocity, with the
 *  Illinois modification. */
static double last_fitting(const passing_t *passing, double fitting, double too_much)
{
    const double enough = 1e-13 * fabs(passing->distance);
    double left = passing->distance - way(passing, fitting);
    double low = 0, spare = left, high = sqrt(too_much - fitting), excess = way(passing, too_much) - passing->distance;
    int side = 0;
    for (int i = 0; i < SOLVER_STEPS_MAX && high - low > 2 * DBL_EPSILON * high; i++) {
        if (left >= 0 && left <= enough)
            break;
        double root = low + (high - low) * (spare / (spare + excess));
        if (!(root > low && root < high))
            root = low + (high - low) / 2;
        left = passing->distance - way(passing, fitting + root * root);
        if (left >= 0) {
            low = root;
            spare = left;
            excess = side > 0 ? excess / 2 : excess;
            side = 1;
        } else {
            high = root;
            excess = -left;
            spare = side < 0 ? spare / 2 : spare;
            side = -1;
        }
    }
    return fitting + low * low;
}

/** That limit in closed form, or by Newton's method from above on a convex function, for an axis that moves towards the
 *  target and accelerates: the change from (v, a) is the change from (rest, 0) without the distance up to (v, a). In
 *  other cases it is any number or NaN: the caller looks whether it is the limit. */
static double last_rise(const passing_t *passing)
{
    const cm1e_motion_limits_t *limits = passing->limits;
    const double v = passing->velocity, a = passing->acceleration, jerk = limits->jerk, most = limits->acceleration;
    if (isinf(jerk))
        return sqrt(v * v + 2 * passing->distance * most);
    const double ramp = fabs(a) / jerk, rest = v - fabs(a) * ramp / 2;
    /* From -a the velocity falls to `rest`; the distance equals that of the rise from there with a. */
    const double way = ramp * (rest + fabs(a) * ramp / 6), whole = passing->distance + (a < 0 ? -way : way);
    const double edge = most / jerk * most, long_way = rest - edge / 2;
    const double velocity = sqrt(larger(0, long_way * long_way + 2 * whole * most)) - edge / 2;
    if (velocity - rest >= edge)
        return velocity;
    /* u3 + 2 rest u = whole sqrt(jerk), where u is the root of the velocity gained */
    const double right = whole * sqrt(jerk);
    double u = sqrt(smaller(edge, larger(0, limits->velocity * 4 - rest)));
    for (int i = 0; i < NEWTON_STEPS; i++) {
        const double less = (u * (u * u + 2 * rest) - right) / (3 * u * u + 2 * rest);
        u -= less;
        if (!(less > DBL_EPSILON * u))
            break;
    }
    return rest + u * u;
}

double cm1e_profile_passing_velocity(const cm1e_motion_state_t *start, double target, double velocity,
                                     const cm1e_motion_limits_t *limits)
{
    if (!cm1e_motion_is_valid(start, limits) || !cm1e_motion_is_number(target) || !cm1e_motion_is_number(velocity) ||
        velocity == 0)
        return 0;
    const double sign = velocity > 0 ? 1 : -1, a = sign * start->acceleration;
    const passing_t passing = {
        .limits = limits, .velocity = sign * start->velocity, .acceleration = a,
        .distance = sign * (target - start->position), .noise = cm1e_motion_noise(start->position, target, 0),
    };
    if (fits(&passing, fabs(velocity)))
        return velocity;
    const double eased = larger(0, passing.velocity + (isinf(limits->jerk) ? 0 : fabs(a) * (a / limits->jerk) / 2));
    const double rise = last_rise(&passing) * (1 - 1e-13);
    if (rise > eased && rise < fabs(velocity) && way(&passing, rise) <= passing.distance &&
        way(&passing, rise * (1 + 1e-12)) > passing.distance)
        return sign * rise;
    if (eased < fabs(velocity) && fits(&passing, eased))
        return sign * last_fitting(&passing, eased, fabs(velocity));
    return fits(&passing, 0) ? sign * last_fitting(&passing, 0, smaller(eased, fabs(velocity))) : 0;
}

double cm1e_profile_entry_velocity(double distance, double velocity, double exit_velocity,
                                   const cm1e_motion_limits_t *limits)
{
    if (fabs(velocity) <= fabs(exit_velocity))
        return fabs(velocity);
    const cm1e_motion_limits_t reversed = {limits->velocity, limits->deceleration, limits->acceleration, limits->jerk};
    const cm1e_motion_state_t exit = {0, fabs(exit_velocity), 0};
    return cm1e_profile_passing_velocity(&exit, distance, fabs(velocity), &reversed);
}
