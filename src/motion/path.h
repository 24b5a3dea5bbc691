/**
 * @file path.h
 * Motion of several axes along one path of lines and arcs, with a limited jerk: it looks ahead over all appended
 * segments, so that the path is left only as far as the command allows, and stops only where necessary. Pure functions,
 * no clock, no heap: the owner has the memory. Units: u of each axis for positions; along the path the unit of the
 * space axes, s. @rt cycle throughout: a step takes a fraction of a microsecond, an append some ten.
 *
 * The first `space` axes (up to three: X, Y, Z) span the space in which lengths are measured and arcs lie; further axes
 * move linearly with the length of a segment. A line that moves none of the space axes is as long as the Euclidean norm
 * of the others.
 *
 * Kept at every instant: the velocity, acceleration and jerk of every axis and, along the path, those of the command of
 * the segment (the acceleration of a command is the one along the path; the one across is for the axes' limits), and
 * the bounds of every axis's position, which are checked when a segment is appended. What is planned always ends at
 * rest, within everything that has been appended; an append, an override or a stop that cannot be brought together with
 * the motion under way takes effect as soon as it can, and until then that motion goes on as it was planned.
 */
#ifndef CM1E_MOTION_PATH_H
#define CM1E_MOTION_PATH_H

#include <stdbool.h>
#include <stdint.h>

#include "motion/profile.h"
#include "motion/slow_time.h"

enum {
    CM1E_PATH_AXES = 8,
    CM1E_PATH_SPACE = 3,
    CM1E_PATH_SEGMENTS = 32, /**< including the active one */
};

/** Limits of one axis: u/s, u/s2, u/s3 (positive; INFINITY: no limit) and its position range (-/+INFINITY: none). */
typedef struct cm1e_path_axis {
    double velocity, acceleration, jerk;
    double lowest, highest;
} cm1e_path_axis_t;

typedef struct cm1e_path_config {
    int axes;       /**< 1 ... CM1E_PATH_AXES */
    int space;      /**< 1 ... CM1E_PATH_SPACE, not more than axes: the first ones are the space axes */
    double cycle_s; /**< time between two steps */
    cm1e_path_axis_t axis[CM1E_PATH_AXES];
} cm1e_path_config_t;

/** How the end of the previous segment is passed. */
typedef enum cm1e_path_junction {
    CM1E_PATH_STOP,  /**< at rest */
    /** Exactly along both segments. If the tangent of any axis breaks by more than 0.001, the path stops there. If it
     *  breaks by less, or only the curvature does (a line into an arc), the acceleration of axes steps. The junction is
     *  then passed so slowly that the step is at most half of what the jerk limit of the axis allows in a cycle; for
     *  one cycle before and after, the path has the other half of that limit, and what is left of the acceleration. */
    CM1E_PATH_EXACT,
    /** By a transition from `parameter` u (length of path) before the end to the same distance behind it, smooth in
     *  tangent and curvature. It is shorter if that is more than half of one of the segments, or has begun. */
    CM1E_PATH_CORNER_DISTANCE,
    /** By a transition that stays within `parameter` of the junction: in space, and in u of each further axis. */
    CM1E_PATH_CORNER_DEVIATION,
} cm1e_path_junction_t;

/** The velocity at a junction without stop: that of the slower of both segments, of the first, of the second, of the
 *  faster. The second segment then changes to its own velocity. */
typedef enum cm1e_path_blend {
    CM1E_PATH_BLEND_LOW,
    CM1E_PATH_BLEND_PREVIOUS,
    CM1E_PATH_BLEND_NEXT,
    CM1E_PATH_BLEND_HIGH,
} cm1e_path_blend_t;

/** Parameters of a segment. */
typedef struct cm1e_path_command {
    cm1e_motion_limits_t limits; /**< along the path; 0 or INFINITY selects as much as the axes allow */
    cm1e_path_junction_t junction;
    cm1e_path_blend_t blend;
    double parameter;            /**< u, > 0; for the two kinds of transition */
    unsigned not_up, not_down;   /**< bits of the axes that must not move in the positive or negative direction */
    uint32_t tag;                /**< number given by the owner, not 0 */
} cm1e_path_command_t;

/** Sense of rotation of an arc by centre, seen against the normal of its plane. The normal points to +Z; for an upright
 *  plane to +Y, or else to +X. With two space axes a rotation from +X to +Y is counter-clockwise. */
typedef enum cm1e_path_way { CM1E_PATH_CLOCKWISE, CM1E_PATH_COUNTER_CLOCKWISE } cm1e_path_way_t;

/** Why something was not appended. */
typedef enum cm1e_path_refusal {
    CM1E_PATH_FINE,
    CM1E_PATH_FULL,        /**< CM1E_PATH_SEGMENTS exist already: try later */
    CM1E_PATH_NO_NUMBER,   /**< a position or a limit is not finite, too large, or negative; a tag is 0 */
    CM1E_PATH_NO_ARC,      /**< fewer than two space axes, points that coincide or lie on a line, centre not in the
                                middle */
    CM1E_PATH_OUT_OF_BOUNDS, /**< `axis` would reach `position` (an arc may bulge over a bound between its ends) */
    CM1E_PATH_WRONG_WAY,     /**< `axis` would move in a direction in which it must not */
    CM1E_PATH_NO_TRANSITION, /**< the parameter of a transition is not positive */
} cm1e_path_refusal_t;

typedef struct cm1e_path_problem {
    cm1e_path_refusal_t refusal;
    int axis;        /**< from 0 */
    double position; /**< u, the position that it would reach */
} cm1e_path_problem_t;

typedef enum cm1e_path_phase {
    CM1E_PATH_IDLE,     /**< at rest at the end of the path */
    CM1E_PATH_MOVING,   /**< also while it waits with an override of 0 */
    CM1E_PATH_STOPPING, /**< braking for a commanded stop */
    CM1E_PATH_STOPPED,  /**< at rest with path left: use cm1e_path_go_on() or cm1e_path_clear() */
} cm1e_path_phase_t;

/** Result of a step. */
typedef struct cm1e_path_sample {
    double position[CM1E_PATH_AXES], velocity[CM1E_PATH_AXES], acceleration[CM1E_PATH_AXES];
    double path_velocity, path_acceleration;
    cm1e_path_phase_t phase;
    uint32_t active;     /**< tag of the present segment (a transition belongs to the second one); 0 when idle */
    int done;            /**< number of segments that ended in this step */
    uint32_t done_tags[CM1E_PATH_SEGMENTS]; /**< their tags, in order; `done` of them are set */
} cm1e_path_sample_t;

/* ---- private from here: what the memory is for ------------------------------------------------------------------- */

typedef enum cm1e_path_kind { CM1E_PATH_LINE, CM1E_PATH_ARC, CM1E_PATH_CURVE } cm1e_path_kind_t;

enum { CM1E_PATH_KNOTS = 8 };

/** A piece of geometry over its own length. Lines and arcs are computed from the nearer of both ends, so that the ends
 *  are exact and an arc of any radius is as exact as a line: from + direction l, and of an arc besides radius (v sin(l
 *  / radius) - u (1 - cos(l / radius))), where u points from the centre to the end and v along. A curve is a polynomial
 *  of degree 5 over 0 ... 1; `at` is the length from its beginning at CM1E_PATH_KNOTS parts. */
typedef struct cm1e_path_piece {
    cm1e_path_kind_t kind;
    int measured; /**< number of axes whose norm is the length */
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

/** Position at a length of a piece, with its derivatives by the length. */
typedef struct cm1e_path_point {
    double position[CM1E_PATH_AXES], tangent[CM1E_PATH_AXES], curvature[CM1E_PATH_AXES];
} cm1e_path_point_t;

/** A run: elements that are planned together. */
typedef struct cm1e_path_run {
    int count;
    double length;
    cm1e_motion_limits_t limits; /**< limits of all elements, override included */
    double highest;              /**< velocity that the axes allow on all elements */
} cm1e_path_run_t;

enum { CM1E_PATH_LEVELS = 8, CM1E_PATH_BRAKES = 2 };

/** What the axes leave for braking in a bend, which is more at a lower velocity: at most at the velocity of a level
 *  (cm1e_path_level()), a share of the deceleration and the jerk that they allow without the bend. Less deceleration
 *  (cm1e_path_part()) leaves more jerk. */
typedef struct cm1e_path_brake {
    double velocity;              /**< of the highest level: the bend alone takes all that the axes have */
    double deceleration, jerk;    /**< without the bend */
    double share[CM1E_PATH_LEVELS]; /**< of the deceleration */
    double jerk_share[CM1E_PATH_BRAKES][CM1E_PATH_LEVELS];
} cm1e_path_brake_t;

/** An element: a part of the path with its own limits. It is a segment without its transitions, a transition, or the
 *  part next to a step of the curvature. */
typedef struct cm1e_path_element {
    const cm1e_path_piece_t *piece;
    uint32_t tag;
    bool last_of_tag;             /**< its end is the end of the segment */
    bool dropped;                 /**< the segment was cut off here, so it is not reported as done */
    bool joined;                  /**< planned together with the element before, so that the acceleration continues */
    double lost;                  /**< s, estimated time that planning the run together costs up to here */
    double skipped, length;       /**< part of the piece: its beginning and its length */
    cm1e_motion_limits_t limits;  /**< limits of the command; except for the velocity reduced to what the axes allow */
    double highest;               /**< velocity that the axes allow with these limits */
    cm1e_path_brake_t brake;
    double passed;                /**< maximum velocity at its beginning */
    double junction;              /**< velocity that the command requests there, at an override of 1 */
    double entry, hard_entry;     /**< look-ahead velocities at the beginning of a run: within all limits, and within
                                       the limits of the axes */
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
    double override;                /**< the one that acts */
    double next_override;           /**< the commanded one; another one only during the last stop */
    int first_segment, segment_count;
    cm1e_path_segment_t segment[CM1E_PATH_SEGMENTS]; /**< a ring */
    int first_element, element_count;
    cm1e_path_element_t element[CM1E_PATH_ELEMENTS]; /**< ring; the first is the present one */
    bool cut;                       /**< the end is the end of a stop: no segment goes on there */
    bool last_stop;                 /**< cleared: it comes to rest at the end of what is left, and nothing hinders
                                         that */
    bool stop_wanted;
    bool stopping;                  /**< the profile is a stop without a given end position */
    cm1e_motion_limits_t stop;      /**< deceleration and jerk of it */
    cm1e_profile_t profile;         /**< profile of the elements joined with the first one */
    cm1e_profile_stretch_t stretch;
    double time_s;                  /**< on the profile */
    double begin;                   /**< place on the profile where the first element begins */
    cm1e_motion_state_t along;      /**< on the profile */
    cm1e_slow_time_t slow;          /**< the time of the profile runs slower */
    uint32_t course;                /**< a number: cm1e_path_course() */
    double ordinary_until_s;        /**< on the profile: steps before it are ordinary; -INFINITY: none is */
    const cm1e_path_element_t *present; /**< the first element, for these steps */
} cm1e_path_t;

/* ---- functions --------------------------------------------------------------------------------------------------- */

/** Starts a path, at rest at `position`. CM1E_ERROR_INVALID_ARGUMENT: the configuration is not valid. A position
 *  outside of the bounds is allowed: the first segment must then lead back inside, and is refused only if it leads
 *  farther out. */
cm1e_error_t cm1e_path_begin(cm1e_path_t *path, const cm1e_path_config_t *config, const double *position);

/** Makes `copy` a copy of the path, from which the path itself can be made again: of the segments and elements, those
 *  that there are. */
void cm1e_path_copy(cm1e_path_t *copy, const cm1e_path_t *path);

/** Appends a straight line to `end` (all axes). Returns CM1E_ERROR_FULL, CM1E_ERROR_INVALID_ARGUMENT,
 *  CM1E_ERROR_AXIS_DIRECTION_DISABLED or CM1E_ERROR_AXIS_POSITION_RANGE with the reason in `problem` (may be NULL), and
 *  then nothing has changed. A line of no length is a segment too; it is done at once when it becomes active. During a
 *  stop, or while the path is stopped, it waits behind the remaining segments. */
cm1e_error_t cm1e_path_append_line(cm1e_path_t *path, const double *end, const cm1e_path_command_t *command,
                                   cm1e_path_problem_t *problem);
/** Appends an arc from the end of the path through `border` (its space axes) to `end`, in the plane of the three
 *  points. */
cm1e_error_t cm1e_path_append_arc_border(cm1e_path_t *path, const double *border, const double *end,
                                         const cm1e_path_command_t *command, cm1e_path_problem_t *problem);
/** Appends an arc around `centre`, in the plane of beginning, centre and end. The end must be as far from the centre as
 *  the beginning, to within 1e-6 of the radius and 1e-3 of the length; both ends are kept exactly. An end equal to the
 *  beginning in space (to within 1e-9 of the radius) is a full circle. If the three points lie on a line (half and full
 *  circles), the plane is the one parallel to X and Y, provided that all three are equally high. If they are not, and
 *  lie within 0.02 rad of a line, an arc of more than a quarter is refused, because a small error of an end would turn
 *  its plane; an arc by border must be used. */
cm1e_error_t cm1e_path_append_arc_centre(cm1e_path_t *path, const double *centre, const double *end,
                                         cm1e_path_way_t way, const cm1e_path_command_t *command,
                                         cm1e_path_problem_t *problem);

/** End position of the last appended segment. */
void cm1e_path_end(const cm1e_path_t *path, double *position);
/** Length of path from here to its end. */
double cm1e_path_left(const cm1e_path_t *path);

/** Sets the factor (>= 0) of the velocities of commands; the limits of the axes still apply. 0: the path comes to rest
 *  and waits. After cm1e_path_clear() it acts when the path has come to rest. */
void cm1e_path_override(cm1e_path_t *path, double factor);
/** Stops along the path, as soon as `deceleration` and `jerk` allow (0 selects as much as the axes allow). Where the
 *  way that is left is too short for these, or the next corner too near, it stops as gently as fits; where not even the
 *  limits of the commands fit before a corner, it begins as soon as they do. A stop under way stays where the path is
 *  cut off at its end and these would need longer. The state is CM1E_PATH_STOPPING, then CM1E_PATH_STOPPED
 *  (CM1E_PATH_IDLE at the end of the path). The remaining segments wait. */
void cm1e_path_stop(cm1e_path_t *path, double deceleration, double jerk);
/** Continues with the remaining segments, also while it still stops; after cm1e_path_clear() when it has come to
 *  rest. With an override of 0 it goes on braking, no more gently than that override does. */
void cm1e_path_go_on(cm1e_path_t *path);
/** Drops the segments that are no longer needed. During a stop these are the segments behind the point of rest; that
 *  point becomes the end of the path (cm1e_path_end()), and segments appended later begin there. At rest all segments
 *  are dropped. A moving path is first stopped with the limits of the axes, like cm1e_path_stop(). Dropped segments and
 *  the present one are not reported as done. */
void cm1e_path_clear(cm1e_path_t *path);

/** The axes have come to rest at the last step, because no further set-points were sent. The remaining segments begin
 *  again from there, from rest. A path without further segments that comes to rest after cm1e_path_clear() ends
 *  there. */
void cm1e_path_pause(cm1e_path_t *path);

/** The axes go on with this part (0.5 ... 1) of their velocities at the last step, along the path, and get back to what
 *  is planned within all limits: the time of the path runs slower for a while (slow_time.h). What is appended meanwhile
 *  keeps the limits of the axes; those of its command it may exceed a little until then. Changes the velocities and
 *  accelerations of the last step's `sample`. */
void cm1e_path_slow(cm1e_path_t *path, double factor, cm1e_path_sample_t *sample);

/** The bounds of the motion of an axis from the last step on, and how long it lasts at most. They hold as long as the
 *  number cm1e_path_course() stays, which every step changes that does not go on within the same stretch of the profile
 *  and the same element. false: they are not known. */
bool cm1e_path_bounds(const cm1e_path_t *path, int axis, cm1e_motion_bounds_t *most, double *left_s);
static inline uint32_t cm1e_path_course(const cm1e_path_t *path) { return path->course; }

/** cm1e_path_step() within one stretch of the profile and one element, while nothing else is wanted of the path. Most
 *  steps are of this kind, and the step before has decided it. false, and nothing has changed: this one is not. */
bool cm1e_path_ordinary_step(cm1e_path_t *path, cm1e_path_sample_t *sample);
/** Computes the positions of the axes after one more cycle. */
void cm1e_path_step(cm1e_path_t *path, cm1e_path_sample_t *sample);

#endif
