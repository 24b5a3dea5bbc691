/**
 * @file axis_kind.h
 * The kinds of commands as a table: a row has all that the axis needs to know of a kind. A new kind is an entry of
 * cm1e_command_kind_t in axis_api.h, and a row in axis_kind.c. Const data, for any thread.
 */
#ifndef CM1E_AXIS_AXIS_KIND_H
#define CM1E_AXIS_AXIS_KIND_H

#include "axis/axis_state.h"

/** How a command becomes a motion. axis_method.c has a row for each. */
typedef enum command_plan {
    PLAN_NONE = 0,     /**< no command */
    /* planned as one profile from any state of motion (axis_plan.c) */
    PLAN_TO_TARGET,
    PLAN_THROUGH_TARGET,
    PLAN_VELOCITY,
    PLAN_STOP,
    PLAN_KEEP_VELOCITY, /**< leaves the masters and keeps the velocity, `end_velocity` */
    /* planned in another way */
    PLAN_TABLE,
    PLAN_HOMING,       /**< by the drive */
    PLAN_HOMING_STEP,
    PLAN_ON_TOP,       /**< superimposed; never the active command */
    PLAN_COUPLING,
    PLAN_OUTSIDE,      /**< a program gives a position in every cycle */
    PLAN_PHASING,      /**< changes the phase shift of a slave; never the active command */
    PLAN_COUNT,
} command_plan_t;

/** The meaning of `position` of a command. */
typedef enum command_target {
    TARGET_NONE = 0,   /**< none, or not the end of a motion */
    TARGET_ABSOLUTE,
    TARGET_RELATIVE,
} command_target_t;

typedef struct command_kind {
    const char *name;          /**< the name in texts */
    state_trigger_t trigger;
    command_plan_t plan;
    command_target_t target;
    bool has_buffer_mode;      /**< false: it begins at once, whatever its buffer mode is */
    bool is_endless;           /**< goes on after it has reached its aim */
    bool has_velocity;         /**< uses the input `velocity` */
    bool is_stop;              /**< values above the maximum are limited, not refused */
    bool has_override;         /**< MC_SetOverride acts on it. It does not act on MC_Stop, for safety; on a homing,
                                    which has its own velocities; on a slave, whose velocity its master has (3.18) */
    bool carries_superimposed; /**< a superimposed motion may go on with it */
    bool drive_can;            /**< an axis with `motion: drive` accepts it */
} command_kind_t;

extern const command_kind_t cm1e_axis_kinds[CM1E_COMMAND_KIND_COUNT];

/** The row of a kind, which is below CM1E_COMMAND_KIND_COUNT. */
static inline const command_kind_t *kind_row(unsigned kind) { return &cm1e_axis_kinds[kind]; }

/** Whether the kind is planned as one profile from any state of motion. */
static inline bool is_planned(unsigned kind)
{
    const command_plan_t plan = kind_row(kind)->plan;
    return plan > PLAN_NONE && plan <= PLAN_KEEP_VELOCITY;
}

/** Whether the kind is never the active command, but goes on beside it with a record of its own. */
static inline bool is_beside(unsigned kind)
{
    const command_plan_t plan = kind_row(kind)->plan;
    return plan == PLAN_ON_TOP || plan == PLAN_PHASING;
}

/** Whether the kind is a homing, by the drive or in steps. */
static inline bool is_homing(unsigned kind)
{
    const command_plan_t plan = kind_row(kind)->plan;
    return plan == PLAN_HOMING || plan == PLAN_HOMING_STEP;
}

#endif
