/**
 * @file profile.h
 * Online trajectories of one axis: from any state (position, velocity, acceleration) to a target position at rest, or
 * to a target velocity, with limits on velocity, acceleration, deceleration and jerk. Pure functions, no clock, no
 * heap. Units: u, u/s, u/s2, u/s3, s. @rt cycle throughout.
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

enum { CM1E_PROFILE_MAX_SEGMENTS = 24 };

typedef struct cm1e_profile {
    int segment_count;
    double duration_s;       /**< until the target is reached; afterwards the end state goes on at constant velocity */
    cm1e_motion_state_t end; /**< exactly the target */
    cm1e_profile_segment_t segments[CM1E_PROFILE_MAX_SEGMENTS];
} cm1e_profile_t;

/** To `target` at rest, in the shortest time. A start that violates the limits is brought inside first. Fails only
 *  (with CM1E_ERROR_INVALID_ARGUMENT, and then the profile is of no use) for input that is not finite, for limits that
 *  are not positive, and for numbers so large, so small or so far apart that doubles cannot hold the motion; never
 *  while all are zero or within 15 decades of 1. */
cm1e_error_t cm1e_profile_to_position(cm1e_profile_t *profile, const cm1e_motion_state_t *start, double target,
                                      const cm1e_motion_limits_t *limits);
/** To `velocity` (signed; beyond limits->velocity it is clamped) with acceleration 0, at no particular position. */
cm1e_error_t cm1e_profile_to_velocity(cm1e_profile_t *profile, const cm1e_motion_state_t *start, double velocity,
                                      const cm1e_motion_limits_t *limits);
/** State at time_s (0 = start; before: start, after the end: constant end velocity). */
void cm1e_profile_sample(const cm1e_profile_t *profile, double time_s, cm1e_motion_state_t *state);
/** Lowest and highest position on the way (end included): for software limits. */
void cm1e_profile_extent(const cm1e_profile_t *profile, double *lowest, double *highest);

#endif
