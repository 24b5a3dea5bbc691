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

/** All positive. An infinite jerk gives a trapezoidal velocity profile. "Acceleration" is for growing, "deceleration"
 *  for shrinking absolute velocity, whatever the direction. */
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
    double duration_s;       /**< until the target is reached; afterwards the end state goes on at constant velocity */
    cm1e_motion_state_t end; /**< exactly the target */
    cm1e_profile_segment_t segments[CM1E_PROFILE_MAX_SEGMENTS];
} cm1e_profile_t;

/** To `target_position` with `target_velocity` (signed) and acceleration 0 there, in the shortest time. A start that
 *  violates the limits is brought inside first. Where the way is too short to get to that velocity, the axis goes
 *  back for a run-up, or overshoots, stops and comes again: ask cm1e_profile_passing_velocity() for one that needs
 *  neither. A target velocity beyond limits->velocity is allowed: limits->velocity then is kept until the axis gets
 *  up to its target velocity at the end. (Only where the way is longer than without any pause at limits->velocity,
 *  but too short for an eased one, is the pause not the very shortest.) Fails only (with CM1E_ERROR_INVALID_ARGUMENT,
 *  and then the profile is of no use) for input that is not finite, for limits that are not positive, and for numbers
 *  so large, so small or so far apart that doubles cannot hold the motion; never while all are zero or within 15
 *  decades of 1, with a target velocity within 6. */
cm1e_error_t cm1e_profile_to_state(cm1e_profile_t *profile, const cm1e_motion_state_t *start, double target_position,
                                   double target_velocity, const cm1e_motion_limits_t *limits);
/** The same with target velocity 0. */
cm1e_error_t cm1e_profile_to_position(cm1e_profile_t *profile, const cm1e_motion_state_t *start, double target,
                                      const cm1e_motion_limits_t *limits);
/** To `velocity` (signed; beyond limits->velocity it is clamped) with acceleration 0, at no particular position. */
cm1e_error_t cm1e_profile_to_velocity(cm1e_profile_t *profile, const cm1e_motion_state_t *start, double velocity,
                                      const cm1e_motion_limits_t *limits);

/** The highest velocity with the sign of `velocity`, and not faster, with which the axis can pass `target` in that
 *  direction, acceleration 0 there, without a run-up and without an overshoot: cm1e_profile_to_state() with the
 *  result goes to the target once, and not back after the start has turned to it. 0 where there is none: where the
 *  target lies behind, and where the way is too short to come down to |velocity|, also to a standstill:
 *  cm1e_profile_to_state() then overshoots; and for input that has no sense. At most 1e-12 below what is possible; a
 *  way too short by rounding counts as long enough, so that the answer stays the same when it is asked again on the
 *  way. |velocity| may be above limits->velocity. A lower velocity need not be one: to slow down may be what the way
 *  is too short for. */
double cm1e_profile_passing_velocity(const cm1e_motion_state_t *start, double target, double velocity,
                                     const cm1e_motion_limits_t *limits);
/** Its mirror, for looking ahead: the highest speed not above |velocity| from which, at acceleration 0, the axis
 *  comes down to |exit_velocity| within `distance` (u, >= 0). A speed below the exit velocity is always one: whether
 *  the axis can get up to the exit velocity is for cm1e_profile_passing_velocity() to say, once it is known how it
 *  enters. */
double cm1e_profile_entry_velocity(double distance, double velocity, double exit_velocity,
                                   const cm1e_motion_limits_t *limits);
/** A part of a profile in closed form: the state at from_s <= t < until_s is that of `origin`, at origin_s, under a
 *  constant jerk. Who samples a profile cycle by cycle keeps the one that he is in. */
typedef struct cm1e_profile_stretch {
    double from_s, until_s, origin_s;
    cm1e_motion_state_t origin;
    double jerk;
} cm1e_profile_stretch_t;
/** The stretch at time_s >= 0; the last one has no end. */
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
/** State at time_s (0 = start; before: start, after the end: constant end velocity). */
void cm1e_profile_sample(const cm1e_profile_t *profile, double time_s, cm1e_motion_state_t *state);
/** Lowest and highest position on the way (end included): for software limits. */
void cm1e_profile_extent(const cm1e_profile_t *profile, double *lowest, double *highest);
/** How far it goes against the direction of `sign`, all such stretches together: 0, but for rounding, where it never
 *  turns that way. */
double cm1e_profile_way_back(const cm1e_profile_t *profile, double sign);

#endif
