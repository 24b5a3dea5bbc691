/**
 * @file axis_kind.h
 * What the axis has to know of a kind of command: one row of a table for each. A new kind is an entry of
 * cm1e_command_kind_t in axis.h, and a row in axis_kind.c. Const data, for any thread.
 */
#ifndef CM1E_AXIS_AXIS_KIND_H
#define CM1E_AXIS_AXIS_KIND_H

#include "axis/axis_state.h"

/** How a command becomes a motion. axis_method.c has a row for each. */
typedef enum command_plan {
    PLAN_NONE = 0,     /**< of no kind */
    /* as one profile from any state of motion (axis_plan.c) */
    PLAN_TO_TARGET,
    PLAN_THROUGH_TARGET,
    PLAN_VELOCITY,
    PLAN_STOP,
    PLAN_KEEP_VELOCITY, /**< of an axis that leaves its master: `end_velocity` */
    /* in another way */
    PLAN_TABLE,
    PLAN_HOMING,       /**< by the drive */
    PLAN_HOMING_STEP,
    PLAN_ON_TOP,       /**< superimposed: it never is the active command */
    PLAN_COUPLING,
    PLAN_PHASING,      /**< changes the phase shift of a slave: it never is the active command */
    PLAN_COUNT,
} command_plan_t;

/** What `position` of a command says. */
typedef enum command_target {
    TARGET_NONE = 0,   /**< nothing, or not where a motion ends */
    TARGET_ABSOLUTE,
    TARGET_RELATIVE,
} command_target_t;

typedef struct command_kind {
    const char *name;          /**< as the texts call it */
    state_trigger_t trigger;
    command_plan_t plan;
    command_target_t target;
    bool has_buffer_mode;      /**< FALSE: it begins at once, whatever its buffer mode is */
    bool is_endless;           /**< goes on when it has reached what it was to reach */
    bool has_velocity;         /**< `velocity` is what it moves with */
    bool is_stop;              /**< dynamics above the maximum are cut, not refused */
    bool has_override;         /**< MC_SetOverride acts on it. Not on MC_Stop, a matter of safety; not on a homing,
                                    which has its own measures; not on a slave: its velocity is its master's (3.18) */
    bool carries_superimposed; /**< a superimposed motion may go on above it */
    bool drive_can;            /**< an axis with `motion: drive` takes it */
} command_kind_t;

extern const command_kind_t cm1e_axis_kinds[CM1E_COMMAND_KIND_COUNT];

/** Its row; `kind` is below CM1E_COMMAND_KIND_COUNT. */
static inline const command_kind_t *kind_row(unsigned kind) { return &cm1e_axis_kinds[kind]; }

/** It is planned as one profile from any state of motion. */
static inline bool is_planned(unsigned kind)
{
    const command_plan_t plan = kind_row(kind)->plan;
    return plan > PLAN_NONE && plan <= PLAN_KEEP_VELOCITY;
}

/** It never is the active command, but goes on beside that and has a record of its own. */
static inline bool is_beside(unsigned kind)
{
    const command_plan_t plan = kind_row(kind)->plan;
    return plan == PLAN_ON_TOP || plan == PLAN_PHASING;
}

/** By the drive, or in steps. */
static inline bool is_homing(unsigned kind)
{
    const command_plan_t plan = kind_row(kind)->plan;
    return plan == PLAN_HOMING || plan == PLAN_HOMING_STEP;
}

#endif
