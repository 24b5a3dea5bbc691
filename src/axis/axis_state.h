/**
 * @file axis_state.h
 * The state diagram of PLCopen Part 1 v2.0, figure 2, as a table: trigger x state. Only cm1e_axis_go() assigns the
 * state of an axis.
 */
#ifndef CM1E_AXIS_AXIS_STATE_H
#define CM1E_AXIS_AXIS_STATE_H

#include "axis/axis_api.h"

/** The triggers of the diagram. */
typedef enum state_trigger {
    /* commands; commands that the diagram treats alike have one trigger (axis_kind.c) */
    ON_DISCRETE = 0,
    ON_CONTINUOUS,
    ON_COUPLE,
    ON_DECOUPLE,
    ON_SHIFT_PHASE,
    ON_FOLLOW,
    ON_SUPERIMPOSE,
    ON_HALT_SUPERIMPOSED,
    ON_HOME,
    ON_HOMING_STEP,
    ON_STOP,
    COMMAND_TRIGGERS,
    /* the ends of commands */
    ON_AT_REST = COMMAND_TRIGGERS, /**< the motion of a command has come to rest */
    ON_DONE,                       /**< a homing is over; a command that waited for its motor is Done */
    ON_BROKEN_OFF,                 /**< a motion is broken off: it is braked */
    ON_STOP_RELEASED,              /**< MC_Stop is done, and its Execute FALSE (note 6) */
    /* groups */
    ON_LED,                        /**< a group begins to give the set-points */
    ON_LET_GO,                     /**< the group ends that, with the axis at rest */
    /* power, errors, reset */
    ON_POWER_ON,                   /**< MC_Power.Enable, and the drive is enabled (note 5) */
    ON_POWER_OFF,                  /**< MC_Power.Enable FALSE (note 2) */
    ON_ERROR,                      /**< note 1 */
    ON_RESET,                      /**< MC_Reset has been done (note 3) */
    STATE_TRIGGER_COUNT,
} state_trigger_t;

/** Why a command is refused in this state; CM1E_OK: it is accepted. */
cm1e_error_t cm1e_axis_state_refusal(cm1e_axis_state_t state, state_trigger_t trigger);
/** Assigns the state that the trigger leads to. */
void cm1e_axis_go(cm1e_axis_t *axis, state_trigger_t trigger);

#endif
