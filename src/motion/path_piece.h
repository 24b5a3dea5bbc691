/**
 * @file path_piece.h
 * The geometry of a path: lines, arcs and the curves between them, each over its own length, and what the limits of
 * the axes allow along them. Private to the room. @rt cycle throughout.
 */
#ifndef CM1E_MOTION_PATH_PIECE_H
#define CM1E_MOTION_PATH_PIECE_H

#include "motion/path.h"

/** In which space, and which axes there are. */
typedef struct cm1e_path_frame {
    int axes, space;
} cm1e_path_frame_t;

/** A line that moves the space axes by less than this part of the others is measured by all of them. */
#define CM1E_PATH_NO_SPACE 1e-6

void cm1e_path_make_line(cm1e_path_piece_t *piece, const cm1e_path_frame_t *frame, const double *from,
                         const double *to);
/** FALSE: there is no such arc. */
bool cm1e_path_make_border_arc(cm1e_path_piece_t *piece, const cm1e_path_frame_t *frame, const double *from,
                               const double *border, const double *to);
bool cm1e_path_make_centre_arc(cm1e_path_piece_t *piece, const cm1e_path_frame_t *frame, const double *from,
                               const double *centre, cm1e_path_way_t way, const double *to);
/** From `before` at `leave` u before its end to `after` at `enter` u behind its beginning, of equal tangent and
 *  curvature there. */
void cm1e_path_make_curve(cm1e_path_piece_t *piece, const cm1e_path_frame_t *frame, const cm1e_path_piece_t *before,
                          double leave, const cm1e_path_piece_t *after, double enter);
/** How far from the junction a curve begins per deviation from it, between lines whose directions have that cosine. */
double cm1e_path_reach_per_deviation(double cosine);
/** How far a curve stays away: from the junction that it goes round, the larger of the distance in space and that of
 *  any further axis where it is nearest; or from the nearer of both pieces, where that is more. */
double cm1e_path_deviation(const cm1e_path_piece_t *curve, const cm1e_path_frame_t *frame,
                           const cm1e_path_piece_t *before, const cm1e_path_piece_t *after);

void cm1e_path_point_at(const cm1e_path_piece_t *piece, int axes, double length, cm1e_path_point_t *point);
/** What of an axis the piece covers; of a curve at least that. */
void cm1e_path_extent(const cm1e_path_piece_t *piece, const cm1e_path_frame_t *frame, int axis, double *lowest,
                      double *highest);

/** Of a curve (0 ... 1 of its parameter): the first three derivatives of the positions by the length. */
void cm1e_path_curve_derivatives(const cm1e_path_piece_t *curve, int axes, double x,
                                 double by_length[3][CM1E_PATH_AXES]);

/** What may be had along a piece so that every axis keeps its own limits, whatever the motion does within them. */
typedef struct cm1e_path_allowance {
    cm1e_motion_limits_t limits; /**< of what is wanted, but for the velocity */
    double highest;              /**< the velocity with them */
    cm1e_motion_limits_t most;   /**< when nothing is wanted but to be soon through */
} cm1e_path_allowance_t;

/** `jerk_share`: of the axes' limits. Any of `wanted` may be INFINITY. */
void cm1e_path_allow(cm1e_path_allowance_t *allowance, const cm1e_path_piece_t *piece,
                     const cm1e_path_config_t *config, double jerk_share, const cm1e_motion_limits_t *wanted);

#endif
