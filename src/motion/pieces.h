/**
 * @file pieces.h
 * A motion as a list of pieces of constant jerk, without position: what the planner works on before it becomes a
 * profile. Private to the room. @rt cycle throughout.
 */
#ifndef CM1E_MOTION_PIECES_H
#define CM1E_MOTION_PIECES_H

#include "motion/profile.h"

/** The acceleration is stored rather than carried along: a piece at a limit is at that limit to the last bit, and with
 *  infinite jerk the acceleration jumps from piece to piece. */
typedef struct cm1e_piece {
    double jerk, acceleration, duration_s;
} cm1e_piece_t;

enum { CM1E_PIECES_MAX = 16 };

typedef struct cm1e_pieces {
    int count;
    cm1e_piece_t piece[CM1E_PIECES_MAX];
} cm1e_pieces_t;

/** Appends a piece; one of no duration is left out, one that continues the jerk of the last is merged with it. */
void cm1e_pieces_append(cm1e_pieces_t *pieces, double jerk, double acceleration, double duration_s);

/** Appends the shortest way from (velocity, acceleration) to (target, 0). */
void cm1e_pieces_append_velocity_change(cm1e_pieces_t *pieces, double velocity, double acceleration, double target,
                                        const cm1e_motion_limits_t *limits);

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

#endif
