/**
 * @file axis_source.h
 * Where the set-point comes from, as a table of functions: a profile, a table over time, a master, the drive itself, a
 * leader, or nowhere. Each source has its own function that begins it; the last thing that function does is
 * cm1e_axis_set_source(). A new source is a new file with such a function and such a table. All in the cycle.
 */
#ifndef CM1E_AXIS_AXIS_SOURCE_H
#define CM1E_AXIS_AXIS_SOURCE_H

#include "axis/axis.h"

/** What comes after the drive has ended a motion of its own. */
typedef enum home_goal { HOME_GOAL_DONE = 0, HOME_GOAL_HOLD, HOME_GOAL_OFF } home_goal_t;

typedef struct source {
    /** The set-point of the cycle. FALSE: there is none, as the source has ended; a profile that has taken over gives
     *  it. */
    bool (*step)(cm1e_axis_t *axis);
    /** What moves comes to rest: by this ramp, or as the drive does it, which then has `goal`. */
    void (*stop)(cm1e_axis_t *axis, const cm1e_motion_limits_t *ramp, home_goal_t goal);
    /** What moves begins anew at the present set-point. NULL: as a profile does (axis_pause.c), or nothing moves. */
    void (*begin_anew)(cm1e_axis_t *axis);
    /** Goes on, at first with this part of its velocity or, led, of that of all. NULL: it begins anew with it. */
    void (*slow)(cm1e_axis_t *axis, double part);
    /** Another source takes over. NULL: nothing is to be done then. */
    void (*leave)(cm1e_axis_t *axis);
    /** What is left to go: whether any of it goes in the direction of `sign`. NULL: none does. */
    bool (*goes)(cm1e_axis_t *axis, double sign);
    /** What is left to go: whether it, and a stop from it, keeps these software limits (u). NULL: it does. */
    bool (*keeps)(const cm1e_axis_t *axis, double lower, double upper);
    /** Of a profile over time: finds the stretch that `time_s` lies in. NULL: the source is no such profile. */
    void (*find_stretch)(cm1e_axis_t *axis, double time_s);
    /** Targets of the drive that do not follow from the set-point. NULL: there are none. */
    void (*write)(cm1e_axis_t *axis);
    bool is_free;      /**< no torque */
    bool holds;        /**< the set-point stands */
    bool moves;        /**< set-points of ours change from cycle to cycle */
    bool is_composite; /**< they are a part of something that would be lost if it began anew */
    bool follows;      /**< masters are what moves the axis */
    bool by_drive;     /**< the drive moves, or is about to, by itself */
    bool homes;        /**< the drive moves by itself in its homing */
} source_t;

extern const source_t cm1e_source_free;    /**< no torque: the set-point is the actual position; axis_free.c */
extern const source_t cm1e_source_hold;    /**< it stands; axis_motion.c */
extern const source_t cm1e_source_profile; /**< of a command, or of a stopping ramp; axis_motion.c */
extern const source_t cm1e_source_table;   /**< axis_table.c */
extern const source_t cm1e_source_drive;   /**< the drive's own profile; axis_drive_profile.c */
extern const source_t cm1e_source_leader;  /**< somebody above; axis_lead.c */

#endif
