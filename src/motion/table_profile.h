/**
 * @file table_profile.h
 * A motion along a table of positions, velocities or accelerations over time: a chain of pieces of constant jerk, with
 * position, velocity and (but for steps in a table of accelerations) acceleration continuous. It starts with the
 * present state of the axis. Pure functions, no clock, no heap; memory is the caller's. Units: u, u/s, u/s2, u/s3, s.
 * @rt cycle throughout; the cost grows in proportion to the number of points, about 5 us for 64.
 */
#ifndef CM1E_MOTION_TABLE_PROFILE_H
#define CM1E_MOTION_TABLE_PROFILE_H

#include "motion/profile.h"

typedef enum cm1e_table_kind {
    CM1E_TABLE_POSITION, /**< cubic spline through the positions; at rest at the end, acceleration 0 */
    CM1E_TABLE_VELOCITY, /**< quadratic spline through the velocities; acceleration 0 at the end */
    CM1E_TABLE_ACCELERATION, /**< straight lines between the accelerations, from the last one to 0 */
} cm1e_table_kind_t;

typedef struct cm1e_table_point {
    double time_s; /**< time since the start, rising by 1 ps at least. A first point at 0 must be the state of the axis,
                        otherwise the table is refused */
    double value;
} cm1e_table_point_t;

enum { CM1E_TABLE_POINTS_MAX = 64 };
#define CM1E_TABLE_SHORTEST_S 1e-12 /**< from one point to the next */

/** The acceleration is linear between knots. Two knots at the same time are a step. */
typedef struct cm1e_table_knot {
    double time_s, acceleration;
} cm1e_table_knot_t;

/** Values that the limits must allow. */
typedef struct cm1e_table_extremes {
    double lowest, highest;                                /**< position, end included */
    double velocity, acceleration, deceleration, jerk;     /**< absolute values; a step: infinite jerk */
} cm1e_table_extremes_t;

typedef struct cm1e_table_profile {
    int knot_count;
    double duration_s;
    cm1e_motion_state_t end;        /**< after it the motion goes on at constant velocity */
    cm1e_motion_state_t start;
    int at;                         /**< the knot before the last sample */
    cm1e_motion_state_t here;       /**< the state there, private */
    cm1e_table_knot_t knots[CM1E_TABLE_POINTS_MAX + 3];
} cm1e_table_profile_t;

/** Builds the motion from `start` along the points. `jerk` takes the last acceleration of a table of accelerations to
 *  0, after its end; INFINITY: at once. CM1E_ERROR_INVALID_ARGUMENT, after which the profile is invalid: no point, more
 *  than CM1E_TABLE_POINTS_MAX points, times that do not rise by 1 ps, numbers that are not finite or beyond 1e30, or a
 *  point of positions or velocities at time 0 that differs from the state of the axis (by more than a millionth of the
 *  range of the table). `extremes` may be NULL. */
cm1e_error_t cm1e_table_profile(cm1e_table_profile_t *profile, cm1e_table_kind_t kind, const cm1e_motion_state_t *start,
                                const cm1e_table_point_t *points, int count, double jerk,
                                cm1e_table_extremes_t *extremes);
/** State at time_s (before the start: the start, after the end: constant end velocity). Cheapest when times grow. */
void cm1e_table_profile_sample(cm1e_table_profile_t *profile, double time_s, cm1e_motion_state_t *state);
/** The part at time_s >= 0; the last one has no end. */
void cm1e_table_profile_stretch_at(cm1e_table_profile_t *profile, double time_s, cm1e_profile_stretch_t *stretch);

#endif
