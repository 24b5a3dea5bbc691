/**
 * @file pieces.h
 * A motion as a list of pieces of constant jerk, without position: the planner uses it before it becomes a profile.
 * Private to the room. @rt cycle throughout.
 */
#ifndef CM1E_MOTION_PIECES_H
#define CM1E_MOTION_PIECES_H

#include <float.h>
#include <stdbool.h>

#include "motion/profile.h"

/** The acceleration is stored, not integrated: a piece at a limit is exactly at that limit, and with infinite jerk the
 *  acceleration jumps from piece to piece. */
typedef struct cm1e_piece {
    double jerk, acceleration, duration_s;
} cm1e_piece_t;

enum { CM1E_PIECES_MAX = CM1E_PROFILE_MAX_SEGMENTS };

/** An empty list has `count` 0, and nothing else is set: clearing the pieces would cost a tenth of a plan. */
typedef struct cm1e_pieces {
    int count;
    cm1e_piece_t piece[CM1E_PIECES_MAX];
} cm1e_pieces_t;

/** Appends a piece; one of no duration is left out, one that continues the jerk of the last is merged with it. */
void cm1e_pieces_append(cm1e_pieces_t *pieces, double jerk, double acceleration, double duration_s);

/** Appends the fastest change from (velocity, acceleration) to (target, 0). */
void cm1e_pieces_append_velocity_change(cm1e_pieces_t *pieces, double velocity, double acceleration, double target,
                                        const cm1e_motion_limits_t *limits);

/** Appends the fastest way from (velocity < 0, acceleration) to standstill, with the largest acceleration there from
 *  which the velocity may rise on: `*at_zero`. false: the case is of another kind, and what was appended is of no use.
 *  A limit of jerk is needed. */
bool cm1e_pieces_append_rise_to_standstill(cm1e_pieces_t *pieces, double velocity, double acceleration,
                                           const cm1e_motion_limits_t *limits, double *at_zero);

/** Appends the move from (velocity, acceleration) to standstill `target` ahead, if it is of the common kind: within the
 *  limits, at first perhaps away from the target, and then only forward. Else it returns false, and what it appended is
 *  of no use. The target must lie beyond the place where the axis could stand soonest. */
bool cm1e_pieces_append_forward_move(cm1e_pieces_t *pieces, double velocity, double acceleration, double target,
                                     const cm1e_motion_limits_t *limits);

/** Distance covered by the pieces if they are entered with this velocity. */
double cm1e_pieces_displacement(const cm1e_pieces_t *pieces, double velocity);

/** The state after `time_s` of a piece that is entered with this position and velocity. */
static inline cm1e_motion_state_t cm1e_piece_state(const cm1e_piece_t *piece, double position, double velocity,
                                                   double time_s)
{
    const double a = piece->acceleration, j = piece->jerk, t = time_s;
    return (cm1e_motion_state_t){
        .position = position + t * (velocity + t * (a / 2 + t * (j / 6))),
        .velocity = velocity + t * (a + t * (j / 2)),
        .acceleration = a + t * j,
    };
}

/** Makes a profile to standstill out of pieces that lead there from the start. */
cm1e_error_t cm1e_pieces_to_standstill(cm1e_profile_t *profile, const cm1e_motion_state_t *start,
                                       const cm1e_pieces_t *pieces, const cm1e_motion_limits_t *limits);

/** Whether the numbers are such that doubles can hold the motion. */
bool cm1e_motion_is_number(double value);
bool cm1e_motion_is_valid(const cm1e_motion_state_t *start, const cm1e_motion_limits_t *limits);

/** Position error that rounding alone can cause in a motion that ends at the target. */
double cm1e_motion_noise(double start, double target, double displacement);

/** A distance that is too short for a velocity change by no more than this fraction counts as long enough. The
 *  difference comes from rounding when a motion is planned again, and a run-up would be an unintended motion. */
#define CM1E_MOTION_TOO_SHORT 1e-9

#endif
