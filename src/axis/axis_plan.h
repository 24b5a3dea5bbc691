/**
 * @file axis_plan.h
 * Profiles of commands: from where they begin to where they end (axis_plan.c).
 */
#ifndef CM1E_AXIS_AXIS_PLAN_H
#define CM1E_AXIS_AXIS_PLAN_H

#include "axis/axis_parts.h"

/** The set-point, all that moves taken together. What takes over from a ramp without limit of jerk ends its acceleration
 *  with the step that the ramp would have ended with: a limited jerk would carry the axis through standstill and back. */
static inline from_t from_set(const cm1e_axis_t *axis)
{
    return (from_t){axis->setpoint.position, axis->setpoint.velocity,
                    axis->setpoint.brakes_hard ? 0.0 : axis->setpoint.acceleration, false};
}
/** Without what is superimposed. */
static inline from_t from_base(const cm1e_axis_t *axis)
{
    const cm1e_motion_state_t *on_top = &axis->superimposed.now;
    if (!axis->superimposed.id)
        return from_set(axis);
    return (from_t){cm1e_position_plus(axis->setpoint.position, -on_top->position * axis->position.scale),
                    axis->setpoint.velocity - on_top->velocity,
                    axis->setpoint.brakes_hard ? 0.0 : axis->setpoint.acceleration - on_top->acceleration,
                    axis->superimposed.moving && !axis->superimposed.alone};
}
/** Fills `target` and `origin` of a command that begins there. */
cm1e_error_t cm1e_axis_resolve(const cm1e_axis_t *axis, const from_t *from, move_t *move);
/** u/s; MC_MoveVelocity: with its direction. */
cm1e_error_t cm1e_axis_signed_velocity(const cm1e_axis_t *axis, const from_t *from, const move_t *move,
                                       double *velocity);
/** The profile of a command whose target is resolved, relative to where it begins. Refuses what leaves the limits.
 *  `before_others`: those that wait come behind it, and its exit velocity is theirs to take over. */
cm1e_error_t cm1e_axis_plan(cm1e_axis_t *axis, const from_t *from, move_t *move, bool before_others,
                            cm1e_profile_t *profile);
/** Where that profile ends: at the target, exactly, if the command has one. */
position_t cm1e_axis_profile_end(const cm1e_axis_t *axis, const from_t *from, const move_t *move,
                                 const cm1e_profile_t *profile);
/** Whether a profile that begins there goes beyond its target (NULL: it has none), or back where its way lies ahead. */
bool cm1e_axis_strays(const cm1e_axis_t *axis, const cm1e_motion_state_t *start, const double *target,
                      const cm1e_profile_t *profile);
/** As cm1e_axis_strays(), of the profile of a command. */
bool cm1e_axis_profile_strays(const cm1e_axis_t *axis, const from_t *from, const move_t *move,
                              const cm1e_profile_t *profile);
/** Whether a profile that begins there stays inside the software limits, with no disabled direction in it. */
cm1e_error_t cm1e_axis_limits_check(const cm1e_axis_t *axis, const from_t *from, const cm1e_profile_t *profile);
/** A stop; one that would run over a software limit brakes as an error does instead. */
cm1e_error_t cm1e_axis_plan_stop(const cm1e_axis_t *axis, const from_t *from, const cm1e_motion_limits_t *limits,
                                 cm1e_profile_t *profile);

#endif
