/**
 * @file path_private.h
 * Shared declarations of the path sources. Private to the room. @rt cycle throughout.
 */
#ifndef CM1E_MOTION_PATH_PRIVATE_H
#define CM1E_MOTION_PATH_PRIVATE_H

#include <math.h>

#include "motion/path_piece.h"
#include "motion/pieces.h"

static inline cm1e_path_element_t *cm1e_path_element(cm1e_path_t *path, int index)
{
    return &path->element[(path->first_element + index) % CM1E_PATH_ELEMENTS];
}

/** The run from that element on, to the first element that is not joined, or before `until`. */
cm1e_path_run_t cm1e_path_run(cm1e_path_t *path, int first, int until);

/** Something has changed on which it depends whether the next steps are ordinary. */
static inline void cm1e_path_look_anew(cm1e_path_t *path) { path->ordinary_until_s = -INFINITY; }

/** Present distance on the first element. */
static inline double cm1e_path_here(const cm1e_path_t *path)
{
    return path->element_count ? path->along.position - path->begin : 0;
}

/** A distance that is longer by this fraction counts as equal. */
#define CM1E_PATH_AS_LONG 1e-9

/** The velocity when the acceleration has come to 0. */
static inline double cm1e_path_eased(const cm1e_motion_state_t *start, double jerk)
{
    return start->velocity + start->acceleration * (fabs(start->acceleration) / jerk) / 2;
}

/** After how long a motion of constant jerk, which never turns round, has gone that way within `most_s`. */
double cm1e_path_time_of(const cm1e_motion_state_t *start, double jerk, double most_s, double way);
/** Plans the soonest stop with at most these limits; `*end`: the length of the elements that it leads over. */
bool cm1e_path_brake_in_stages(cm1e_path_t *path, double deceleration, double jerk, const cm1e_motion_state_t *start,
                               cm1e_profile_t *stop, double *end);
/** The smallest and the largest velocity of a profile. */
void cm1e_path_velocities(const cm1e_profile_t *profile, double *lowest, double *highest);
/** Whether it goes ahead only, not beyond its end and not too fast. */
bool cm1e_path_keeps(const cm1e_profile_t *profile, const cm1e_motion_state_t *start, double end, double highest);
/** That is the motion from now on; `start` counts from the beginning of the first element. */
void cm1e_path_follow(cm1e_path_t *path, const cm1e_profile_t *profile, const cm1e_motion_state_t *start);

/** Appends a segment behind the previous one (NULL: none), as its command says, and plans. */
void cm1e_path_join(cm1e_path_t *path, cm1e_path_segment_t *before, cm1e_path_segment_t *segment);

/** Looks ahead and plans the run again from here, after elements from `changed` on have changed. Returns false if that
 *  is not possible; the present motion is then unchanged, but does not follow from a plan. */
bool cm1e_path_plan(cm1e_path_t *path, int changed);
/** Used if rounding leaves no plan within all limits: the one that exceeds them least, and like any other keeps to the
 *  path, goes ahead only and does not run over its end. */
void cm1e_path_keep_going(cm1e_path_t *path);
/** Plans the continuation with another override, or from within a stop, if possible. */
void cm1e_path_change_pace(cm1e_path_t *path);
/** Tries to begin the commanded stop. */
bool cm1e_path_plan_stop(cm1e_path_t *path);
/** Cuts the path off at the point where it can be at rest. */
void cm1e_path_cut(cm1e_path_t *path);

#endif
