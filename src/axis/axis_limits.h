/**
 * @file axis_limits.h
 * The limits of an axis: dynamics, software limits, directions (axis_limits.c).
 */
#ifndef CM1E_AXIS_AXIS_LIMITS_H
#define CM1E_AXIS_AXIS_LIMITS_H

#include "axis/axis_parts.h"

cm1e_error_t cm1e_axis_limits_init(cm1e_axis_t *axis, cm1e_diag_t *diag); /* @rt init */
/** The dynamics of a command that begins at `from`. Too large values are refused; for MC_Halt and MC_Stop they are
 *  limited. */
cm1e_error_t cm1e_axis_limits_of(const cm1e_axis_t *axis, const from_t *from, const move_t *move,
                                 cm1e_motion_limits_t *limits);
/** Like cm1e_axis_limits_of(), with these factors instead of the override of the axis. */
cm1e_error_t cm1e_axis_limits_with(const cm1e_axis_t *axis, const from_t *from, const move_t *move,
                                   const override_t *override, cm1e_motion_limits_t *limits);
/** Raises the jerk if the acceleration of the motion before would else overshoot the maximum velocity. */
void cm1e_axis_keep_below_maximum(const cm1e_axis_t *axis, const from_t *from, cm1e_motion_limits_t *limits);
/** The dynamics of a superimposed motion: its inputs times these factors, limited to its share. */
cm1e_error_t cm1e_axis_limits_on_top(const cm1e_axis_t *axis, const superimposed_t *on_top,
                                     const override_t *override, cm1e_motion_limits_t *limits);
/** u/s; what a superimposed motion leaves the base: the rest of the maximum. If that was lowered below its share, and
 *  it goes on as it was commanded, half of the maximum. */
double cm1e_axis_velocity_beside(const cm1e_axis_t *axis);
/** For the planning of one motion: the maximum values become these, and these become what they were. */
void cm1e_axis_exchange_maximum(cm1e_axis_t *axis, cm1e_motion_limits_t *most);
/** An input of a command with which no profile can be computed, because it is too small. */
typedef struct small_input {
    const char *name, *unit;
    double value, least;  /**< u and s: as it was commanded, or the maximum; what can be computed with */
    double factor;        /**< of MC_SetOverride */
    bool is_maximum;      /**< it was 0, which selects the maximum of the axis */
    cm1e_error_t error;   /**< under which it is refused */
} small_input_t;
/** false: the inputs of the command are large enough for any motion. `maximum`: what they are without a value;
 *  `scale`: counts per u. */
bool cm1e_axis_find_small(const move_t *move, const cm1e_motion_limits_t *maximum, const override_t *factors,
                          double scale, small_input_t *found);
/** cm1e_axis_find_small() for a motion of this axis. */
bool cm1e_axis_has_small(const cm1e_axis_t *axis, const move_t *move, small_input_t *found);
/** The error of a command that cannot be planned: that of the input that is too small, or else this one. */
cm1e_error_t cm1e_axis_cannot_plan(const cm1e_axis_t *axis, const move_t *move, cm1e_error_t otherwise);
/** Whether a target is inside the software limits, or not farther outside than the begin of the way. A superimposed
 *  motion of `from` is included. */
bool cm1e_axis_limits_contain_target(const cm1e_axis_t *axis, const from_t *from, position_t target);
/** Like cm1e_axis_limits_contain_target(), for the range between two positions, in u from `from`. */
bool cm1e_axis_limits_contain_way(const cm1e_axis_t *axis, const from_t *from, double lowest, double highest);
/** Whether a profile that begins at `from` stays inside the software limits. */
bool cm1e_axis_limits_contain(const cm1e_axis_t *axis, const from_t *from, const cm1e_profile_t *profile);
/** Like cm1e_axis_limits_contain(), but also during a homing in steps. */
bool cm1e_axis_limits_keep_within(const cm1e_axis_t *axis, const from_t *from, const cm1e_profile_t *profile);
bool cm1e_axis_direction_enabled(const cm1e_axis_t *axis, double velocity);

/** Whether a motion that goes so far from its begin (u), and ends as the profile of the axis, keeps these limits. */
bool cm1e_axis_way_keeps(const cm1e_axis_t *axis, double lowest, double highest, double lower, double upper);
/** source_t.keeps of a motion whose way only the drive, the planner outside or the leader knows: it may go anywhere. */
bool cm1e_axis_unknown_way_keeps(const cm1e_axis_t *axis, double lower, double upper);
/** source_t.keeps of a profile. */
bool cm1e_axis_profile_keeps(const cm1e_axis_t *axis, double lower, double upper);

/** Computes how far targets may change in a cycle (cm1e_drive_command_t). @rt cycle; after the limits */
void cm1e_axis_steps_init(cm1e_axis_t *axis);
/** Puts the limits in force. Called when limits are written, and when positions get another meaning. */
void cm1e_axis_apply_limits(cm1e_axis_t *axis);
/** Whether the emergency ramp from `next` (its position counted from `base`, u) would end inside the software
 *  limits. */
static inline bool cm1e_axis_limits_can_stop(const cm1e_axis_t *axis, double base, cm1e_motion_state_t next)
{
    if (!axis->limits.software_limits)
        return true;
    /* Without a limit of jerk the way of a stop has a closed form, which does not depend on the acceleration. */
    const double end = base + next.position + next.velocity * fabs(next.velocity) * axis->limits.emergency_way;
    return next.velocity > 0.0 ? end <= axis->limits.upper + axis->limits.tolerance
           : next.velocity < 0.0 ? end >= axis->limits.lower - axis->limits.tolerance : true;
}
/** Whether the motion under way, and a stop from it, would keep these software limits (u). */
static inline bool cm1e_axis_limits_hold(const cm1e_axis_t *axis, double lower, double upper)
{
    return !axis->setpoint.source->keeps || axis->setpoint.source->keeps(axis, lower, upper);
}

#endif
