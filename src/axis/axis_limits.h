/**
 * @file axis_limits.h
 * What the axis may do: dynamics, software limits, directions (axis_limits.c).
 */
#ifndef CM1E_AXIS_AXIS_LIMITS_H
#define CM1E_AXIS_AXIS_LIMITS_H

#include "axis/axis_move.h"

/** What a set-point may be beside the one before it, in the numbers that are compared; made once. */
typedef struct guarding {
    double velocity;         /**< u/s */
    double up, down;         /**< u/s in a cycle */
    double acceleration;     /**< u/s2 */
    double jerk;             /**< u/s2 in a cycle */
    double ease;             /**< s3/u; by the square of an acceleration: what it adds to the velocity while it ends */
    double half_cycle, step; /**< counts in half a cycle at 1 u/s; counts beside the mean of both velocities */
    double per_count;        /**< u, signed */
} guarding_t;

typedef struct limits {
    bool software_limits;           /**< one of them at least; those in force are ... */
    bool lag_monitoring;
    bool positive_enabled, negative_enabled;
    int32_t counts_limit;           /**< of the motor's own counts in either direction, by its K37; 0: none */
    double lower, upper;            /**< u, as cm1e_axis_line() counts; infinite: none on that side */
    double tolerance;               /**< u; which they are kept with */
    double emergency_way;           /**< s2/u; times the square of a velocity: that it goes */
    guarding_t guarding;
    double max_lag;                 /**< u */
    cm1e_motion_limits_t system;    /**< u; of motor and configuration */
    cm1e_motion_limits_t maximum;   /**< u; what the application allows of it: the bounds of commands */
    cm1e_motion_limits_t emergency; /**< u; the ramp of an error: that of `system` without a limit of jerk */
    double positive, negative;      /**< u; the software limits as they are written */
    double counts_lower, counts_upper; /**< u, as cm1e_axis_line() counts; where that limit is; infinite: none */
} limits_t;

cm1e_error_t cm1e_axis_limits_init(cm1e_axis_t *axis, cm1e_diag_t *diag); /* @rt init */
/** The dynamics of a command that begins there; MC_Halt and MC_Stop have too large ones cut to the axis's instead of
 *  refused. */
cm1e_error_t cm1e_axis_limits_of(const cm1e_axis_t *axis, const from_t *from, const move_t *move,
                                 cm1e_motion_limits_t *limits);
/** The same with these factors instead of the axis's override. */
cm1e_error_t cm1e_axis_limits_with(const cm1e_axis_t *axis, const from_t *from, const move_t *move,
                                   const override_t *override, cm1e_motion_limits_t *limits);
/** More jerk, where what is left of another motion's acceleration would else overshoot the maximum velocity. */
void cm1e_axis_keep_below_maximum(const cm1e_axis_t *axis, const from_t *from, cm1e_motion_limits_t *limits);
/** Those of a superimposed motion: what it asks for with these factors, cut to its share. */
cm1e_error_t cm1e_axis_limits_on_top(const cm1e_axis_t *axis, const superimposed_t *on_top,
                                     const override_t *override, cm1e_motion_limits_t *limits);
/** A target inside the software limits, or not farther outside than where the way there begins; with a superimposed
 *  motion on top where `from` has one. */
bool cm1e_axis_limits_contain_target(const cm1e_axis_t *axis, const from_t *from, position_t target);
/** The same for a way between two positions, counted from there in u. */
bool cm1e_axis_limits_contain_way(const cm1e_axis_t *axis, const from_t *from, double lowest, double highest);
/** Whether a profile that begins there stays inside the software limits. */
bool cm1e_axis_limits_contain(const cm1e_axis_t *axis, const from_t *from, const cm1e_profile_t *profile);
/** The same, also while a homing in steps makes positions mean nothing. */
bool cm1e_axis_limits_keep_within(const cm1e_axis_t *axis, const from_t *from, const cm1e_profile_t *profile);
bool cm1e_axis_direction_enabled(const cm1e_axis_t *axis, double velocity);

/** The same of a profile. */
bool cm1e_axis_profile_keeps(const cm1e_axis_t *axis, double lower, double upper);

/** What the drive may be given in a cycle: cm1e_drive_command_t. @rt init; after the limits */
void cm1e_axis_steps_init(cm1e_axis_t *axis);
/** When limits are written, and when positions get another meaning. */
void cm1e_axis_apply_limits(cm1e_axis_t *axis);

#endif
