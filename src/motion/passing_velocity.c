/*
 * How fast a position can be passed. The way that the shortest change from (v, a) to a velocity w >= 0 needs is
 * shortest for the velocity that easing the acceleration leads to; from there on it grows with w, about like a square
 * root at its beginning. Below, braking, it first grows with w too, since easing the deceleration at a higher velocity
 * takes more way, and then shrinks. So the velocities that fit into a way are those up to some velocity and those
 * between two higher ones, and either may be none.
 */
#include <math.h>

#include "motion/pieces.h"

enum { SOLVER_STEPS_MAX = 200 };

/** All mirrored so that the target is to be passed with a velocity >= 0. */
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

/** Exactly when cm1e_profile_to_state() goes there without a run-up. */
static bool fits(const passing_t *passing, double velocity)
{
    const double needed = way(passing, velocity);
    return needed - passing->distance <=
           passing->noise + 4 * DBL_EPSILON * fabs(needed) + CM1E_MOTION_TOO_SHORT * fabs(needed);
}

/** The velocity between one that fits and one that does not where that changes: regula falsi in the root of the
 *  velocity, where an end that stays twice counts half (Illinois). */
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
    const double eased = fmax(0, passing.velocity + (isinf(limits->jerk) ? 0 : fabs(a) * (a / limits->jerk) / 2));
    if (eased < fabs(velocity) && fits(&passing, eased))
        return sign * last_fitting(&passing, eased, fabs(velocity));
    return fits(&passing, 0) ? sign * last_fitting(&passing, 0, fmin(eased, fabs(velocity))) : 0;
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
