/**
 * @file path_private.h
 * What the files of the path share. Private to the room. @rt cycle throughout.
 */
#ifndef CM1E_MOTION_PATH_PRIVATE_H
#define CM1E_MOTION_PATH_PRIVATE_H

#include "motion/path_piece.h"

static inline cm1e_path_element_t *cm1e_path_element(cm1e_path_t *path, int index)
{
    return &path->element[(path->first_element + index) % CM1E_PATH_ELEMENTS];
}

/** The run from that element on: to the first one that is not joined, or before `until`. */
cm1e_path_run_t cm1e_path_run(cm1e_path_t *path, int first, int until);

/** How far on the first element it is. */
static inline double cm1e_path_here(const cm1e_path_t *path)
{
    return path->element_count ? path->along.position - path->begin : 0;
}

/** Puts a segment behind the one before it (NULL: there is none), as its command says, and plans. */
void cm1e_path_join(cm1e_path_t *path, cm1e_path_segment_t *before, cm1e_path_segment_t *segment);

/** Looks ahead and plans the way from here to the end of the run anew, after elements from `changed` on have changed.
 *  FALSE: that cannot be done; the motion under way is as it was, and no longer a plan. */
bool cm1e_path_plan(cm1e_path_t *path, int changed);
/** Where rounding has left no plan that keeps everything: the velocity goes on without a step all the same. */
void cm1e_path_keep_going(cm1e_path_t *path);
/** Plans the way on with another override, or from within a stop, if that can be done. */
void cm1e_path_change_pace(cm1e_path_t *path);
/** Tries to begin with the stop that is wanted. */
bool cm1e_path_plan_stop(cm1e_path_t *path);
/** Cuts the path off where it can be at rest. */
void cm1e_path_cut(cm1e_path_t *path);

#endif
