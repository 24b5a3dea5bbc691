/**
 * @file path_piece.h
 * The geometry of a path: lines, arcs and the curves between them, each over its own length, and what the limits of
 * the axes allow along them. Private to the room. @rt cycle throughout.
 */
#ifndef CM1E_MOTION_PATH_PIECE_H
#define CM1E_MOTION_PATH_PIECE_H

#include "motion/path.h"

/** The space of the path and its axes. */
typedef struct cm1e_path_frame {
    int axes, space;
} cm1e_path_frame_t;

/** A line that moves the space axes by less than this fraction of the others is measured by all axes. */
#define CM1E_PATH_NO_SPACE 1e-6

void cm1e_path_make_line(cm1e_path_piece_t *piece, const cm1e_path_frame_t *frame, const double *from,
                         const double *to);
/** Returns false if there is no such arc. */
bool cm1e_path_make_border_arc(cm1e_path_piece_t *piece, const cm1e_path_frame_t *frame, const double *from,
                               const double *border, const double *to);
bool cm1e_path_make_centre_arc(cm1e_path_piece_t *piece, const cm1e_path_frame_t *frame, const double *from,
                               const double *centre, cm1e_path_way_t way, const double *to);
/** Makes the curve from `before`, `leave` u before its end, to `after`, `enter` u behind its beginning, with equal
 *  tangent and curvature there. */
void cm1e_path_make_curve(cm1e_path_piece_t *piece, const cm1e_path_frame_t *frame, const cm1e_path_piece_t *before,
                          double leave, const cm1e_path_piece_t *after, double enter);
/** Distance from the junction at which a curve begins, per deviation from it, for lines with that cosine between their
 *  directions. */
double cm1e_path_reach_per_deviation(double cosine);
/** Deviation of a curve: its smallest distance from the junction, in space or of any further axis, whichever is larger;
 *  or its distance from the nearer of both pieces, if that is larger. */
double cm1e_path_deviation(const cm1e_path_piece_t *curve, const cm1e_path_frame_t *frame,
                           const cm1e_path_piece_t *before, const cm1e_path_piece_t *after);

/** The nearer end of a line or an arc (0: its beginning), and how far the place is from there; negative: before the
 *  end. */
static inline int cm1e_path_nearer_end(const cm1e_path_piece_t *piece, double length, double *from_there)
{
    const bool end = length > piece->length / 2;
    *from_there = !end ? length : length < piece->length ? length - piece->length : 0;
    return end;
}

void cm1e_path_point_at(const cm1e_path_piece_t *piece, int axes, double length, cm1e_path_point_t *point);
/** Range of an axis on the piece; for a curve an upper bound. */
void cm1e_path_extent(const cm1e_path_piece_t *piece, const cm1e_path_frame_t *frame, int axis, double *lowest,
                      double *highest);

/** The first three derivatives of the positions by the length, for a curve (parameter 0 ... 1). */
void cm1e_path_curve_derivatives(const cm1e_path_piece_t *curve, int axes, double x,
                                 double by_length[3][CM1E_PATH_AXES]);

/** Limits along a piece with which every axis keeps its own limits, whatever the motion does within them. */
typedef struct cm1e_path_allowance {
    cm1e_motion_limits_t limits; /**< the requested limits, except for the velocity */
    double highest;              /**< velocity with these limits */
    cm1e_path_brake_t brake;     /**< for the soonest stop */
} cm1e_path_allowance_t;

/** The velocity of a level of a brake. Near the highest one the share falls faster, so they are closer together. */
static inline double cm1e_path_level(const cm1e_path_brake_t *brake, int level)
{
    static const double parts[CM1E_PATH_LEVELS] = {1, 0.96, 0.9, 0.83, 0.74, 0.63, 0.48, 0.3};
    return parts[level] * brake->velocity;
}

/** The deceleration of a brake in parts of the share of its level. */
static inline double cm1e_path_part(int brake)
{
    static const double parts[CM1E_PATH_BRAKES] = {1, 0.6};
    return parts[brake];
}

/** Which part of the limits of the axes there is for the motion along a piece. */
typedef struct cm1e_path_share {
    double acceleration, jerk;
} cm1e_path_share_t;

/** Any value of `wanted` may be INFINITY. */
void cm1e_path_allow(cm1e_path_allowance_t *allowance, const cm1e_path_piece_t *piece,
                     const cm1e_path_config_t *config, const cm1e_path_share_t *share,
                     const cm1e_motion_limits_t *wanted);

#endif
