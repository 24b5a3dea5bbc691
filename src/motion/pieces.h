/**
 * @file pieces.h
 * A motion as a list of pieces of constant jerk, without position: what the planner works on before it becomes a
 * profile. Private to the room. @rt cycle throughout.
 */
#ifndef CM1E_MOTION_PIECES_H
#define CM1E_MOTION_PIECES_H

#include <float.h>
#include <stdbool.h>

#include "motion/profile.h"

/** The acceleration is stored rather than carried along: a piece at a limit is at that limit to the last bit, and with
 *  infinite jerk the acceleration jumps from piece to piece. */
typedef struct cm1e_piece {
    double jerk, acceleration, duration_s;
} cm1e_piece_t;

enum { CM1E_PIECES_MAX = CM1E_PROFILE_MAX_SEGMENTS };

/** An empty one has `count` 0, and nothing else is set: to clear the pieces would cost a tenth of a plan. */
typedef struct cm1e_pieces {
    int count;
    cm1e_piece_t piece[CM1E_PIECES_MAX];
} cm1e_pieces_t;

/** Appends a piece; one of no duration is left out, one that continues the jerk of the last is merged with it. */
void cm1e_pieces_append(cm1e_pieces_t *pieces, double jerk, double acceleration, double duration_s);

/** Appends the shortest way from (velocity, acceleration) to (target, 0). */
void cm1e_pieces_append_velocity_change(cm1e_pieces_t *pieces, double velocity, double acceleration, double target,
                                        const cm1e_motion_limits_t *limits);

/** The way that the pieces go when they are entered with this velocity. */
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

/** Whether the numbers are such that doubles can hold the motion. */
bool cm1e_motion_is_number(double value);
bool cm1e_motion_is_valid(const cm1e_motion_state_t *start, const cm1e_motion_limits_t *limits);

/** What rounding of the positions alone can make of a motion that ends at the target. */
double cm1e_motion_noise(double start, double target, double displacement);

/** A way too short to get to a velocity by no more than this part of it is as good as long enough: what is missing is
 *  what rounding makes of a plan that is made anew on the way, and a run-up would be a motion that nobody meant. */
#define CM1E_MOTION_TOO_SHORT 1e-9

#endif
