/**
 * @file path.h
 * Motion of several axes along one path of lines and arcs, with a limited jerk: what is appended is looked ahead over,
 * so that the path is left as little as the command says and stopped at only where it has to be. Pure functions, no
 * clock, no heap: the owner has the memory. Units: u of each axis for positions; along the path the unit of the space
 * axes, s. @rt cycle throughout: a step takes a fraction of a microsecond, an append a few.
 *
 * The first `space` axes (up to three: X, Y, Z) span the space in which lengths are measured and arcs lie; further axes
 * go linearly along with the length of a segment. A line that moves none of the space axes is as long as the Euclidean
 * norm of the others.
 *
 * Kept at every instant: the velocity, acceleration and jerk of every axis and, along the path, those of the command
 * of the segment (the acceleration of a command is the one along the path; the one across is for the axes' limits), and
 * the bounds of every axis's position, which are checked when a segment is appended. What is planned always ends at
 * rest, within everything that has been appended; an append, an override or a stop that cannot be brought together with
 * the motion under way takes effect as soon as it can, and until then that motion goes on as it was planned.
 */
#ifndef CM1E_MOTION_PATH_H
#define CM1E_MOTION_PATH_H

#include <stdbool.h>
#include <stdint.h>

#include "motion/profile.h"

enum {
    CM1E_PATH_AXES = 8,
    CM1E_PATH_SPACE = 3,
    CM1E_PATH_SEGMENTS = 32, /**< the active one counts */
};

/** Of one axis: u/s, u/s2, u/s3 (positive; INFINITY: no limit) and the positions it may have (-/+INFINITY: any). */
typedef struct cm1e_path_axis {
    double velocity, acceleration, jerk;
    double lowest, highest;
} cm1e_path_axis_t;

typedef struct cm1e_path_config {
    int axes;       /**< 1 ... CM1E_PATH_AXES */
    int space;      /**< 1 ... CM1E_PATH_SPACE, not more than axes: the first ones are the space axes */
    double cycle_s; /**< how far apart the steps are */
    cm1e_path_axis_t axis[CM1E_PATH_AXES];
} cm1e_path_config_t;

/** How the end of the segment before is passed. */
typedef enum cm1e_path_junction {
    CM1E_PATH_STOP,  /**< at rest */
    /** Exactly along both segments. Where the tangent of any axis breaks: at rest. Where it does not, but the curvature
     *  does (a line into an arc), the acceleration of axes steps; it is passed so slowly that the step is at most half
     *  of what the axis's limit of jerk allows in a cycle, and for a cycle before and after the path has the other half
     *  of that limit. */
    CM1E_PATH_EXACT,
    /** By a transition from `parameter` u (length of path) before the end to as much behind it, smooth in tangent and
     *  curvature. Less where that is more than half of one of the segments, or has begun. */
    CM1E_PATH_CORNER_DISTANCE,
    /** The same, as far that the transition keeps within `parameter` of the junction: in space, and in u of each
     *  further axis. */
    CM1E_PATH_CORNER_DEVIATION,
} cm1e_path_junction_t;

/** The velocity at a junction without stop: of the slower of both segments, the first, the second, the faster.
 *  In the segment behind it is brought to that one's own. */
typedef enum cm1e_path_blend {
    CM1E_PATH_BLEND_LOW,
    CM1E_PATH_BLEND_PREVIOUS,
    CM1E_PATH_BLEND_NEXT,
    CM1E_PATH_BLEND_HIGH,
} cm1e_path_blend_t;

/** What a segment is appended with. */
typedef struct cm1e_path_command {
    cm1e_motion_limits_t limits; /**< along the path; 0 or INFINITY: as much as the axes allow */
    cm1e_path_junction_t junction;
    cm1e_path_blend_t blend;
    double parameter;            /**< u, of the two kinds of transition: > 0 */
    uint32_t tag;                /**< the owner's name for it, not 0 */
} cm1e_path_command_t;

/** Which way round an arc by centre goes, seen from the side where its plane's normal points: to +Z; where the plane is
 *  upright to +Y, or else to +X. With two space axes as usual: +X turned towards +Y is counter-clockwise. */
typedef enum cm1e_path_way { CM1E_PATH_CLOCKWISE, CM1E_PATH_COUNTER_CLOCKWISE } cm1e_path_way_t;

/** Why something was not appended. */
typedef enum cm1e_path_refusal {
    CM1E_PATH_FINE,
    CM1E_PATH_FULL,        /**< CM1E_PATH_SEGMENTS are there already: later again */
    CM1E_PATH_NO_NUMBER,   /**< a position or a limit is not finite, too large, or negative; a tag is 0 */
    CM1E_PATH_NO_ARC,      /**< fewer than two space axes, points that coincide or lie in a line, centre not in the
                            *   middle */
    CM1E_PATH_OUT_OF_BOUNDS, /**< `axis` would get to `position` (an arc may bulge over a bound between its ends) */
    CM1E_PATH_NO_TRANSITION, /**< the parameter of a transition is not positive */
} cm1e_path_refusal_t;

typedef struct cm1e_path_problem {
    cm1e_path_refusal_t refusal;
    int axis;        /**< from 0 */
    double position; /**< u, where it would get to */
} cm1e_path_problem_t;

typedef enum cm1e_path_phase {
    CM1E_PATH_IDLE,     /**< at rest at the end of everything */
    CM1E_PATH_MOVING,   /**< also when it waits with an override of 0 */
    CM1E_PATH_STOPPING, /**< on the way to a stop that was asked for */
    CM1E_PATH_STOPPED,  /**< at rest, with a way to go: cm1e_path_go_on() or cm1e_path_clear() */
} cm1e_path_phase_t;

/** What a step results in. */
typedef struct cm1e_path_sample {
    double position[CM1E_PATH_AXES], velocity[CM1E_PATH_AXES], acceleration[CM1E_PATH_AXES];
    double path_velocity, path_acceleration;
    cm1e_path_phase_t phase;
    uint32_t active;     /**< tag of the segment it is on (a transition belongs to the second one); 0 when idle */
    int done;            /**< how many segments ended in this step */
    uint32_t done_tags[CM1E_PATH_SEGMENTS]; /**< and which, in order; only `done` of them are set */
} cm1e_path_sample_t;

/* ---- private from here: what the memory is for ------------------------------------------------------------------- */

typedef enum cm1e_path_kind { CM1E_PATH_LINE, CM1E_PATH_ARC, CM1E_PATH_CURVE } cm1e_path_kind_t;

enum { CM1E_PATH_KNOTS = 8 };

/** A piece of geometry over its own length. Lines and arcs are reckoned from the nearer of both ends, so that these are
 *  exact and an arc of any radius is as exact as a line: from + direction l, and of an arc besides
 *  radius (v sin(l / radius) - u (1 - cos(l / radius))), where u points from the centre to the end and v along. A curve
 *  is a polynomial of degree 5 over 0 ... 1; `at` is the length from its beginning at CM1E_PATH_KNOTS parts. */
typedef struct cm1e_path_piece {
    cm1e_path_kind_t kind;
    int measured; /**< the length is the norm of so many axes */
    double length;
    union {
        struct {
            double from[CM1E_PATH_AXES], to[CM1E_PATH_AXES], direction[CM1E_PATH_AXES];
            double u[2][CM1E_PATH_SPACE], v[2][CM1E_PATH_SPACE], radius;
        };
        struct {
            double power[6][CM1E_PATH_AXES], at[CM1E_PATH_KNOTS + 1];
        };
    };
} cm1e_path_piece_t;

/** Where a length on a piece is, and how it goes on from there: per length. */
typedef struct cm1e_path_point {
    double position[CM1E_PATH_AXES], tangent[CM1E_PATH_AXES], curvature[CM1E_PATH_AXES];
} cm1e_path_point_t;

/** Elements that are planned in one. */
typedef struct cm1e_path_run {
    int count;
    double length;
    cm1e_motion_limits_t limits; /**< of all of them, override included */
    double highest;              /**< the velocity that the axes allow on all of them */
} cm1e_path_run_t;

/** A stretch of path with limits of its own: a segment without what its junctions took, a transition, or what is next
 *  to a step of the curvature. */
typedef struct cm1e_path_element {
    const cm1e_path_piece_t *piece;
    uint32_t tag;
    bool last_of_tag;             /**< its end is the end of the segment */
    bool dropped;                 /**< with the segment cut off, so it is not reported as done */
    bool joined;                  /**< planned in one with the element before, so that the acceleration goes on */
    double lost;                  /**< s, about: what the run up to here takes longer for being one */
    double skipped, length;       /**< of the piece: where it begins, and how far it goes */
    cm1e_motion_limits_t limits;  /**< of the command; but for the velocity as far as the axes allow */
    double highest;               /**< the velocity that the axes allow with them */
    cm1e_motion_limits_t most;    /**< what the axes allow for a stop */
    double passed;                /**< the highest velocity with which its beginning can be passed */
    double junction;              /**< and the one that the command wants there, at an override of 1 */
    double entry, hard_entry;     /**< looked ahead, where it begins a run: to keep all, and to keep the axes' limits */
    cm1e_path_run_t braking, hard_braking; /**< over what it then is planned in one */
} cm1e_path_element_t;

typedef struct cm1e_path_segment {
    cm1e_path_piece_t piece, transition; /**< the transition leads to it */
    cm1e_path_command_t command;
} cm1e_path_segment_t;

enum { CM1E_PATH_ELEMENTS = 3 * CM1E_PATH_SEGMENTS };

typedef struct cm1e_path {
    cm1e_path_config_t config;
    double end[CM1E_PATH_AXES];     /**< of everything */
    double override;
    int first_segment, segment_count;
    cm1e_path_segment_t segment[CM1E_PATH_SEGMENTS]; /**< a ring */
    int first_element, element_count;
    cm1e_path_element_t element[CM1E_PATH_ELEMENTS]; /**< a ring; the first is the one it is on */
    bool cut;                       /**< the end is where a stop will be, not the end of a segment */
    bool stop_wanted;
    bool stopping;                  /**< the profile is that of a stop: it ends wherever it does */
    cm1e_motion_limits_t stop;      /**< deceleration and jerk of it */
    cm1e_profile_t profile;         /**< of the elements that are joined with the first one */
    cm1e_profile_stretch_t stretch;
    double time_s;                  /**< on the profile */
    double begin;                   /**< where on the profile the first element begins */
    cm1e_motion_state_t along;      /**< on the profile */
} cm1e_path_t;

/* ---- functions --------------------------------------------------------------------------------------------------- */

/** Begins anew, at rest at `position`. CM1E_ERROR_INVALID_ARGUMENT for a configuration of no sense. A position outside
 *  of the bounds is none: then the first segment has to lead back inside, and is refused only when it leads further
 *  out. */
cm1e_error_t cm1e_path_begin(cm1e_path_t *path, const cm1e_path_config_t *config, const double *position);

/** Appends a straight line to `end` (all axes). Returns CM1E_ERROR_FULL, CM1E_ERROR_INVALID_ARGUMENT or
 *  CM1E_ERROR_AXIS_POSITION_RANGE with the reason in `problem` (may be NULL), and then nothing has changed. A line of
 *  no length is a segment too: it is done at once when it is its turn. While a stop is under way or the path is
 *  stopped: it waits behind what is left. */
cm1e_error_t cm1e_path_append_line(cm1e_path_t *path, const double *end, const cm1e_path_command_t *command,
                                   cm1e_path_problem_t *problem);
/** An arc from where the path ends by way of `border` (the space axes of it) to `end`, in the plane of the three. */
cm1e_error_t cm1e_path_append_arc_border(cm1e_path_t *path, const double *border, const double *end,
                                         const cm1e_path_command_t *command, cm1e_path_problem_t *problem);
/** An arc around `centre`, in the plane of beginning, centre and end; the end as far from the centre as the beginning,
 *  to within 1e-6 of the radius; both ends are kept. End equal to beginning in space (to within 1e-9 of the radius): a
 *  full circle. Where the three lie in a line (half and full circles) the plane is the one parallel to X and Y
 *  if the centre is as high as the beginning, else there is none: take the border. */
cm1e_error_t cm1e_path_append_arc_centre(cm1e_path_t *path, const double *centre, const double *end,
                                         cm1e_path_way_t way, const cm1e_path_command_t *command,
                                         cm1e_path_problem_t *problem);

/** How many segments can be appended now. */
int cm1e_path_room(const cm1e_path_t *path);
/** Where everything that has been appended ends. */
void cm1e_path_end(const cm1e_path_t *path, double *position);
/** Length of path from here to the end of everything. */
double cm1e_path_left(const cm1e_path_t *path);

/** Factor >= 0 of the velocities of commands, never beyond the axes' limits. 0: comes to rest and waits. */
void cm1e_path_override(cm1e_path_t *path, double factor);
/** Comes to rest along the path, as soon as `deceleration` and `jerk` (0: as much as the axes allow) allow but not
 *  later than planned, and stays there: CM1E_PATH_STOPPING, then CM1E_PATH_STOPPED (CM1E_PATH_IDLE if that is the end
 *  of everything). What is left waits. */
void cm1e_path_stop(cm1e_path_t *path, double deceleration, double jerk);
/** Goes on with what is left, also while it still stops. */
void cm1e_path_go_on(cm1e_path_t *path);
/** Drops everything that is not needed: when it stops, what is behind the point where it will be at rest; that point
 *  then is the end of the path (cm1e_path_end()), and where it goes on from when something is appended. At rest:
 *  everything. While it moves it does as cm1e_path_stop() with the axes' limits first. Segments that are dropped as a
 *  whole are not reported as done; neither is the one it was on. */
void cm1e_path_clear(cm1e_path_t *path);

/** The axes have come to rest where the last step brought them, since nobody told them to go on: what is left begins
 *  anew from there, from rest. */
void cm1e_path_pause(cm1e_path_t *path);

/** Where the axes are after one more cycle. */
void cm1e_path_step(cm1e_path_t *path, cm1e_path_sample_t *sample);

#endif
