/**
 * @file axis_plan.h
 * Profiles of commands (axis_plan.c).
 */
#ifndef CM1E_AXIS_AXIS_PLAN_H
#define CM1E_AXIS_AXIS_PLAN_H

#include "axis/axis_parts.h"

/** The state of the whole set-point. After a ramp without a limit of jerk, the next motion ends the acceleration with a
 *  step, as the ramp would have. A limited jerk would move the axis through standstill and back. */
static inline from_t from_set(const cm1e_axis_t *axis)
{
    return (from_t){axis->setpoint.position, axis->setpoint.velocity,
                    axis->setpoint.brakes_hard ? 0.0 : axis->setpoint.acceleration, false};
}
/** The state of the base, without a superimposed motion. */
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
/** Fills in `target` and `origin` of a command that begins at `from`. */
cm1e_error_t cm1e_axis_resolve(const cm1e_axis_t *axis, const from_t *from, move_t *move);
/** The velocity (u/s) of a command with its sign; for MC_MoveVelocity by its direction. */
cm1e_error_t cm1e_axis_signed_velocity(const cm1e_axis_t *axis, const from_t *from, const move_t *move,
                                       double *velocity);
/** Plans the profile of a command whose target is resolved, relative to its begin. Refuses a profile that leaves the
 *  limits. `before_others`: the waiting commands follow it and go on from its exit velocity. */
cm1e_error_t cm1e_axis_plan(cm1e_axis_t *axis, const from_t *from, move_t *move, bool before_others,
                            cm1e_profile_t *profile);
/** The end of that profile; if the command has a target, exactly the target. */
position_t cm1e_axis_profile_end(const cm1e_axis_t *axis, const from_t *from, const move_t *move,
                                 const cm1e_profile_t *profile);
/** Whether a profile overruns its target (NULL: none), or goes back although its target lies ahead. */
bool cm1e_axis_strays(const cm1e_axis_t *axis, const cm1e_motion_state_t *start, const double *target,
                      const cm1e_profile_t *profile);
/** Whether a plan that ended with this error leads where it should not: it strays, or, which is an error, beyond a
 *  software limit or in a disabled direction. */
bool cm1e_axis_goes_wrong(const cm1e_axis_t *axis, const from_t *from, const move_t *move,
                          const cm1e_profile_t *profile, cm1e_error_t error);
/** Plans a move with the acceleration, deceleration and jerk that were allowed before, as far as the axis has them. */
cm1e_error_t cm1e_axis_plan_as_before(cm1e_axis_t *axis, const from_t *from, move_t *move, cm1e_profile_t *profile);
/** Like cm1e_axis_strays(), for the profile of a command. */
bool cm1e_axis_profile_strays(const cm1e_axis_t *axis, const from_t *from, const move_t *move,
                              const cm1e_profile_t *profile);
/** Checks that a profile from `from` keeps the software limits and the enabled directions. */
cm1e_error_t cm1e_axis_limits_check(const cm1e_axis_t *axis, const from_t *from, const cm1e_profile_t *profile);
/** Whether the directions permit a profile. In a disabled direction only the braking under way, `brake`, is permitted,
 *  and no way back to a target that is too near. */
bool cm1e_axis_directions_allow(const cm1e_axis_t *axis, const cm1e_profile_t *profile, const cm1e_profile_t *brake);
/** For a stop. The braking before may be harder than its jerk can end before the axis stands: it would turn round.
 *  Where that direction is disabled, the jerk becomes the one with which velocity and braking end together, or
 *  `most_jerk`. Elsewhere it stays as it was told: slaves may need it. */
void cm1e_axis_keep_direction(const cm1e_axis_t *axis, double velocity, double acceleration, double most_jerk,
                              cm1e_motion_limits_t *limits);
/** Plans a stop. If it would overrun a software limit, the axis brakes with the ramp of an error. */
cm1e_error_t cm1e_axis_plan_stop(const cm1e_axis_t *axis, const from_t *from, const cm1e_motion_limits_t *limits,
                                 cm1e_profile_t *profile);

#endif
