/**
 * @file axis_source.h
 * Where the set-point comes from, as a table of functions: a profile, a table over time, a master, the drive itself, a
 * leader, or nowhere. Each source has its own function that begins it; the last thing that function does is
 * cm1e_axis_set_source(). A new source is a new file with such a function and such a table. All in the cycle.
 */
#ifndef CM1E_AXIS_AXIS_SOURCE_H
#define CM1E_AXIS_AXIS_SOURCE_H

#include "axis/axis_api.h"

/** What follows when a motion by the drive has ended: its command is done, the axis holds, or it has no torque. */
typedef enum home_goal { HOME_GOAL_DONE = 0, HOME_GOAL_HOLD, HOME_GOAL_OFF } home_goal_t;

typedef bool (*axis_otherwise_t)(cm1e_axis_t *axis);

typedef struct source {
    /** Makes the set-point of the cycle. false: the source has ended and made none; the profile that took over makes
     *  it. */
    bool (*step)(cm1e_axis_t *axis);
    /** step() of an axis that is led, in a cycle about which everything was decided ahead: true. If it was not, nothing
     *  has changed, and the result is that of `otherwise`, which is called last so that no registers are saved for it.
     *  NULL: nothing is decided ahead here. */
    bool (*ordinary)(cm1e_axis_t *axis, axis_otherwise_t otherwise);
    /** Brings the motion to rest by this ramp. A motion by the drive ends in the drive's own way, with `goal`. */
    void (*stop)(cm1e_axis_t *axis, const cm1e_motion_limits_t *ramp, home_goal_t goal);
    /** Begins the motion anew at the present set-point. NULL: as a profile does (axis_pause.c), or nothing moves. */
    void (*begin_anew)(cm1e_axis_t *axis);
    /** Goes on with this part of its velocity at first; a led axis with this part of the velocity of all. NULL: it
     *  begins anew with that velocity. */
    void (*slow)(cm1e_axis_t *axis, double part);
    /** Called when another source takes over. NULL: nothing to do. */
    void (*leave)(cm1e_axis_t *axis);
    /** Whether any of the remaining motion is in the direction of `sign`. NULL: none is. */
    bool (*goes)(cm1e_axis_t *axis, double sign);
    /** Whether the remaining motion, and a stop from it, keeps these software limits (u). NULL: it does. */
    bool (*keeps)(const cm1e_axis_t *axis, double lower, double upper);
    /** Finds the stretch of a profile over time that contains `time_s`. NULL: the source is no such profile. */
    void (*find_stretch)(cm1e_axis_t *axis, double time_s);
    /** Targets of the drive that do not follow from the set-point. NULL: there are none. */
    void (*write)(cm1e_axis_t *axis);
    bool is_free;      /**< no torque */
    bool holds;        /**< the set-point is at rest */
    bool moves;        /**< our set-points change from cycle to cycle */
    bool is_composite; /**< the motion is made of several, and cannot begin anew without losing one */
    bool follows;      /**< masters move the axis */
    bool by_drive;     /**< the drive moves by itself, or is about to */
    bool homes;        /**< the drive moves by itself in a homing */
} source_t;

extern const source_t cm1e_source_free;    /**< no torque: the set-point is the actual position; axis_free.c */
extern const source_t cm1e_source_hold;    /**< the set-point is at rest; axis_motion.c */
extern const source_t cm1e_source_profile; /**< a profile of a command, or a ramp; axis_motion.c */
extern const source_t cm1e_source_table;   /**< axis_table.c */
extern const source_t cm1e_source_drive;   /**< the drive's own profile; axis_drive_profile.c */
extern const source_t cm1e_source_outside; /**< positions of a program in every cycle; axis_outside.c */
extern const source_t cm1e_source_leader;  /**< a leader from a room above; axis_lead.c */

#endif
