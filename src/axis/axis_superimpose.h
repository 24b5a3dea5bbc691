/**
 * @file axis_superimpose.h
 * Motions on top of the commanded one (axis_superimpose.c).
 */
#ifndef CM1E_AXIS_AXIS_SUPERIMPOSE_H
#define CM1E_AXIS_AXIS_SUPERIMPOSE_H

#include "axis/axis_parts.h"

/** A superimposed motion goes on above the base and has its share of the limits. */
static inline bool axis_shares(const cm1e_axis_t *axis)
{
    return axis->superimposed.moving && !axis->superimposed.alone;
}
cm1e_error_t cm1e_axis_superimpose(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id);
cm1e_error_t cm1e_axis_superimpose_update(cm1e_axis_t *axis, cm1e_command_id_t id, const cm1e_axis_command_t *command);
/** Adds its part to the base's of this cycle. */
void cm1e_axis_superimposed_step(cm1e_axis_t *axis, cm1e_motion_state_t *next);
/** Instead of that: its part is what was `before`, without jerk, and it goes on from there. */
void cm1e_axis_superimposed_hold(cm1e_axis_t *axis, const cm1e_motion_state_t *before);
/** Its part goes on with so much of its velocity. FALSE: it cannot, and nothing has changed. */
bool cm1e_axis_superimposed_slow(cm1e_axis_t *axis, double part);
/** A command begins there (the present set-point), as the base. Where that is faster than what is left beside the
 *  superimposed motion, that one stops being one, waits, and its part of the velocity is the base's. */
void cm1e_axis_superimposed_give_way(cm1e_axis_t *axis, from_t *from);
/** After the set-point: where it has come to its end, the base has all the limits again. */
void cm1e_axis_superimposed_after(cm1e_axis_t *axis);
/** What is superimposed becomes part of the one motion that is then planned from the set-point. */
void cm1e_axis_superimposed_end(cm1e_axis_t *axis, cm1e_command_state_t state, cm1e_error_t error);
/** Aborted: the base goes on alone, and ends so much beyond as has been covered. */
void cm1e_axis_superimposed_abandon(cm1e_axis_t *axis);
void cm1e_axis_superimposed_replan(cm1e_axis_t *axis);
/** Whether it goes that way, now or later. */
bool cm1e_axis_superimposed_goes(const cm1e_axis_t *axis, double sign);

#endif
