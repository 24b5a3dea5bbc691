/**
 * @file axis_superimpose.h
 * Superimposed motions (axis_superimpose.c).
 */
#ifndef CM1E_AXIS_AXIS_SUPERIMPOSE_H
#define CM1E_AXIS_AXIS_SUPERIMPOSE_H

#include "axis/axis_parts.h"

/** Whether a superimposed motion goes on and has its share of the limits. */
static inline bool axis_shares(const cm1e_axis_t *axis)
{
    return axis->superimposed.moving && !axis->superimposed.alone;
}
cm1e_error_t cm1e_axis_superimpose(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id);
cm1e_error_t cm1e_axis_superimpose_update(cm1e_axis_t *axis, cm1e_command_id_t id, const cm1e_axis_command_t *command);
/** Adds the superimposed motion to the base of this cycle. */
void cm1e_axis_superimposed_step(cm1e_axis_t *axis, cm1e_motion_state_t *next);
/** Called instead where the sum would break a limit: goes on without jerk, and plans the rest from there. false, and
 *  nothing has changed: its velocity would exceed VelocityDiff later, or (`to_target`) it would pass its target. */
bool cm1e_axis_superimposed_hold(cm1e_axis_t *axis, bool to_target);
/** Called instead: its acceleration goes towards 0 with the maximum jerk of the axis. false, and nothing has changed:
 *  it is 0, or there is no plan from there. */
bool cm1e_axis_superimposed_ease(cm1e_axis_t *axis);
/** What it was before an attempt to go on. */
void cm1e_axis_superimposed_put_back(cm1e_axis_t *axis, const superimposed_t *before);
/** Goes on with this part of the velocity. false: it cannot, and nothing has changed. */
bool cm1e_axis_superimposed_slow(cm1e_axis_t *axis, double part);
/** Called when a command begins at `from` as the base. If that is faster than the superimposed motion leaves room for,
 *  or is a halt that needs all limits to stay inside the software limits, the superimposed motion waits, its velocity
 *  becomes a part of the base, and `*from` is the present set-point. false: it goes on. */
bool cm1e_axis_superimposed_give_way(cm1e_axis_t *axis, const move_t *move, from_t *from);
/** Called after the set-point. When the superimposed motion has ended, the base gets all limits again. */
void cm1e_axis_superimposed_after(cm1e_axis_t *axis);
/** Ends the superimposed motion. It becomes a part of the motion that is planned next from the set-point. */
void cm1e_axis_superimposed_end(cm1e_axis_t *axis, cm1e_command_state_t state, cm1e_error_t error);
/** Aborts the superimposed motion. The base goes on alone, and its target is shifted by the covered distance. */
void cm1e_axis_superimposed_abandon(cm1e_axis_t *axis);
/** u; the distance that is commanded of it, whether it has begun or waits for room; of a halt where it ends. 0: there
 *  is none. */
double cm1e_axis_superimposed_goal(const cm1e_axis_t *axis);
void cm1e_axis_superimposed_replan(cm1e_axis_t *axis);
/** Whether the superimposed motion moves in the direction `sign`, now or later. */
bool cm1e_axis_superimposed_goes(const cm1e_axis_t *axis, double sign);

#endif
