/**
 * @file profile.h
 * Online trajectories of one axis: from any state (position, velocity, acceleration) to a target position with a target
 * velocity there, or to a target velocity anywhere, in the shortest time, with limits on velocity, acceleration,
 * deceleration and jerk. Pure functions, no clock, no heap. Units: u, u/s, u/s2, u/s3, s. @rt cycle throughout.
 */
#ifndef CM1E_MOTION_PROFILE_H
#define CM1E_MOTION_PROFILE_H

#include "cm1e/error.h"

typedef struct cm1e_motion_state {
    double position, velocity, acceleration;
} cm1e_motion_state_t;

/** Limits, all positive. An infinite jerk gives a trapezoidal velocity profile. "Acceleration" is for growing,
 *  "deceleration" for shrinking absolute velocity, whatever the direction. */
typedef struct cm1e_motion_limits {
    double velocity, acceleration, deceleration, jerk;
} cm1e_motion_limits_t;

/** A piece of constant jerk. */
typedef struct cm1e_profile_segment {
    double start_s, jerk;
    cm1e_motion_state_t start;
} cm1e_profile_segment_t;

/** A change of velocity takes at most 5: three on one side of standstill and two on the other, where it begins or ends
 *  at the lower of the limits. So a push and a change with a cruise in between take 11. */
enum { CM1E_PROFILE_MAX_SEGMENTS = 11 };

typedef struct cm1e_profile {
    int segment_count;
    double duration_s;       /**< time to the target; afterwards the motion goes on at constant velocity */
    cm1e_motion_state_t end; /**< exactly the target */
    cm1e_profile_segment_t segments[CM1E_PROFILE_MAX_SEGMENTS];
} cm1e_profile_t;

/** Plans to `target_position` with `target_velocity` (signed) and acceleration 0 there, in the shortest time. A start
 *  that violates the limits is brought inside first. If the distance is too short for that velocity, the axis goes back
 *  for a run-up, or overshoots, stops and returns: ask cm1e_profile_passing_velocity() for one that needs neither. A
 *  target velocity beyond limits->velocity is allowed: limits->velocity then is kept until the axis gets up to its
 *  target velocity at the end. (Only where the way is longer than without any pause at limits->velocity, but too short
 *  for an eased one, is the pause not the very shortest.) Fails only (with CM1E_ERROR_INVALID_ARGUMENT, and then the
 *  profile is of no use) for input that is not finite, for limits that are not positive, and for numbers so large, so
 *  small or so far apart that doubles cannot hold the motion; never while all are zero or within 15 decades of 1, with
 *  a target velocity within 6. */
cm1e_error_t cm1e_profile_to_state(cm1e_profile_t *profile, const cm1e_motion_state_t *start, double target_position,
                                   double target_velocity, const cm1e_motion_limits_t *limits);
/** cm1e_profile_to_state() with target velocity 0. */
cm1e_error_t cm1e_profile_to_position(cm1e_profile_t *profile, const cm1e_motion_state_t *start, double target,
                                      const cm1e_motion_limits_t *limits);
/** Plans to `velocity` (signed, clamped to limits->velocity) with acceleration 0, without a target position. */
cm1e_error_t cm1e_profile_to_velocity(cm1e_profile_t *profile, const cm1e_motion_state_t *start, double velocity,
                                      const cm1e_motion_limits_t *limits);

/** The maximum velocity, with the sign of `velocity` and not above it, with which the axis can pass `target` in that
 *  direction, acceleration 0 there, without a run-up and without an overshoot: cm1e_profile_to_state() with the result
 *  goes to the target once, and not back after the start has turned to it. It is 0 if there is none: if the target lies
 *  behind, if the distance is too short to brake to |velocity| (cm1e_profile_to_state() then overshoots), and for
 *  invalid input. The result is at most 1e-12 below the possible maximum. A distance that is too short by rounding
 *  counts as long enough, so that the result does not change when it is computed again during the motion. |velocity|
 *  may be above limits->velocity. A lower velocity may not be possible, because the distance may be too short to brake
 *  to it. */
double cm1e_profile_passing_velocity(const cm1e_motion_state_t *start, double target, double velocity,
                                     const cm1e_motion_limits_t *limits);
/** The counterpart for look-ahead: the maximum speed not above |velocity| from which the axis, at acceleration 0,
 *  brakes to |exit_velocity| within `distance` (u, >= 0). A speed below the exit velocity is always possible. Whether
 *  the axis can accelerate to the exit velocity is decided by cm1e_profile_passing_velocity(), when the entry state is
 *  known. */
double cm1e_profile_entry_velocity(double distance, double velocity, double exit_velocity,
                                   const cm1e_motion_limits_t *limits);
/** A part of a profile in closed form: the state at from_s <= t < until_s is that of `origin`, at origin_s, under a
 *  constant jerk. A caller that samples a profile cycle by cycle keeps the present part. */
typedef struct cm1e_profile_stretch {
    double from_s, until_s, origin_s;
    cm1e_motion_state_t origin;
    double jerk;
} cm1e_profile_stretch_t;
/** The part at time_s >= 0; the last one has no end. */
void cm1e_profile_stretch_at(const cm1e_profile_t *profile, double time_s, cm1e_profile_stretch_t *stretch);
static inline cm1e_motion_state_t cm1e_profile_stretch_state(const cm1e_profile_stretch_t *stretch, double time_s)
{
    const double t = time_s - stretch->origin_s, a = stretch->origin.acceleration, j = stretch->jerk;
    return (cm1e_motion_state_t){
        .position = stretch->origin.position +
                    t * (stretch->origin.velocity + t * (a * 0.5 + t * (j * (1.0 / 6.0)))),
        .velocity = stretch->origin.velocity + t * (a + t * (j * 0.5)),
        .acceleration = a + t * j,
    };
}
/** The largest absolute values in a motion: u/s, u/s2, u/s3. */
typedef struct cm1e_motion_bounds {
    double velocity, acceleration, jerk;
} cm1e_motion_bounds_t;
/** Those between two times of the stretch. The velocity is infinite if the motion turns round in between. */
cm1e_motion_bounds_t cm1e_profile_stretch_bounds(const cm1e_profile_stretch_t *stretch, double from_s, double until_s);
/** State at time_s (0 = start; before: start, after the end: constant end velocity). */
void cm1e_profile_sample(const cm1e_profile_t *profile, double time_s, cm1e_motion_state_t *state);
/** Minimum and maximum position of the motion, end included; used for software limits. */
void cm1e_profile_extent(const cm1e_profile_t *profile, double *lowest, double *highest);
/** Total distance against the direction of `sign`; 0, except for rounding, if the motion never goes that way. */
double cm1e_profile_way_back(const cm1e_profile_t *profile, double sign);

#endif
