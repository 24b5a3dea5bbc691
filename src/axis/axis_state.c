/* The state diagram of PLCopen Part 1 v2.0, figure 2, as far as commands move it: state x command. The transitions by
 * MC_Power, MC_Reset and axis errors are in axis_power.c, those at the end of a command in axis_motion.c. */
#include "axis/axis_private.h"

#define REFUSED(why) {.refusal = CM1E_ERROR_AXIS_##why}
#define TO(state) {.refusal = CM1E_OK, .next = CM1E_AXIS_##state}

/* Homing has no arrow to a motion, so only MC_Stop and the next step of a homing in steps (Part 5) are taken there.
 * Stopping takes another MC_Stop only when no MC_Stop holds it any more (axis_command.c): the same block may so be
 * triggered again while the axis still brakes. A superimposed motion changes no state but Standstill (3.8).
 * What leaves a master, or shifts against it, needs one (4.4, 4.6, 4.8). */
static const state_rule_t rules[CM1E_AXIS_STATE_COUNT][STATE_TRIGGER_COUNT] = {
    [CM1E_AXIS_DISABLED] = {
        [ON_DISCRETE] = REFUSED(NOT_POWERED),
        [ON_CONTINUOUS] = REFUSED(NOT_POWERED),
        [ON_STOP] = REFUSED(NOT_POWERED),
        [ON_HOME] = REFUSED(NOT_POWERED),
        [ON_HOMING_STEP] = REFUSED(NOT_POWERED),
        [ON_SUPERIMPOSE] = REFUSED(NOT_POWERED),
        [ON_HALT_SUPERIMPOSED] = REFUSED(NOT_POWERED),
        [ON_COUPLE] = REFUSED(NOT_POWERED),
        [ON_DECOUPLE] = REFUSED(NOT_POWERED),
        [ON_SHIFT_PHASE] = REFUSED(NOT_POWERED),
    },
    [CM1E_AXIS_STANDSTILL] = {
        [ON_DISCRETE] = TO(DISCRETE_MOTION),
        [ON_CONTINUOUS] = TO(CONTINUOUS_MOTION),
        [ON_STOP] = TO(STOPPING),
        [ON_HOME] = TO(HOMING),
        [ON_HOMING_STEP] = TO(HOMING),
        [ON_SUPERIMPOSE] = TO(DISCRETE_MOTION),
        [ON_HALT_SUPERIMPOSED] = TO(STANDSTILL),
        [ON_COUPLE] = TO(SYNCHRONIZED_MOTION),
        [ON_DECOUPLE] = REFUSED(NOT_COUPLED),
        [ON_SHIFT_PHASE] = REFUSED(NOT_COUPLED),
    },
    [CM1E_AXIS_HOMING] = {
        [ON_DISCRETE] = REFUSED(HOMING),
        [ON_CONTINUOUS] = REFUSED(HOMING),
        [ON_STOP] = TO(STOPPING),
        [ON_HOME] = REFUSED(HOMING),
        [ON_HOMING_STEP] = TO(HOMING),
        [ON_SUPERIMPOSE] = REFUSED(HOMING),
        [ON_HALT_SUPERIMPOSED] = REFUSED(HOMING),
        [ON_COUPLE] = REFUSED(HOMING),
        [ON_DECOUPLE] = REFUSED(HOMING),
        [ON_SHIFT_PHASE] = REFUSED(HOMING),
    },
    [CM1E_AXIS_DISCRETE_MOTION] = {
        [ON_DISCRETE] = TO(DISCRETE_MOTION),
        [ON_CONTINUOUS] = TO(CONTINUOUS_MOTION),
        [ON_STOP] = TO(STOPPING),
        [ON_HOME] = REFUSED(STATE),
        [ON_HOMING_STEP] = REFUSED(STATE),
        [ON_SUPERIMPOSE] = TO(DISCRETE_MOTION),
        [ON_HALT_SUPERIMPOSED] = TO(DISCRETE_MOTION),
        [ON_COUPLE] = TO(SYNCHRONIZED_MOTION),
        [ON_DECOUPLE] = REFUSED(NOT_COUPLED),
        [ON_SHIFT_PHASE] = REFUSED(NOT_COUPLED),
    },
    [CM1E_AXIS_CONTINUOUS_MOTION] = {
        [ON_DISCRETE] = TO(DISCRETE_MOTION),
        [ON_CONTINUOUS] = TO(CONTINUOUS_MOTION),
        [ON_STOP] = TO(STOPPING),
        [ON_HOME] = REFUSED(STATE),
        [ON_HOMING_STEP] = REFUSED(STATE),
        [ON_SUPERIMPOSE] = TO(CONTINUOUS_MOTION),
        [ON_HALT_SUPERIMPOSED] = TO(CONTINUOUS_MOTION),
        [ON_COUPLE] = TO(SYNCHRONIZED_MOTION),
        [ON_DECOUPLE] = REFUSED(NOT_COUPLED),
        [ON_SHIFT_PHASE] = REFUSED(NOT_COUPLED),
    },
    [CM1E_AXIS_SYNCHRONIZED_MOTION] = {
        [ON_DISCRETE] = TO(DISCRETE_MOTION),
        [ON_CONTINUOUS] = TO(CONTINUOUS_MOTION),
        [ON_STOP] = TO(STOPPING),
        [ON_HOME] = REFUSED(STATE),
        [ON_HOMING_STEP] = REFUSED(STATE),
        [ON_SUPERIMPOSE] = TO(SYNCHRONIZED_MOTION),
        [ON_HALT_SUPERIMPOSED] = TO(SYNCHRONIZED_MOTION),
        [ON_COUPLE] = TO(SYNCHRONIZED_MOTION),
        [ON_DECOUPLE] = TO(CONTINUOUS_MOTION),
        [ON_SHIFT_PHASE] = TO(SYNCHRONIZED_MOTION),
    },
    [CM1E_AXIS_STOPPING] = {
        [ON_DISCRETE] = REFUSED(STOPPING),
        [ON_CONTINUOUS] = REFUSED(STOPPING),
        [ON_STOP] = TO(STOPPING),
        [ON_HOME] = REFUSED(STOPPING),
        [ON_HOMING_STEP] = REFUSED(STOPPING),
        [ON_SUPERIMPOSE] = REFUSED(STOPPING),
        [ON_HALT_SUPERIMPOSED] = REFUSED(STOPPING),
        [ON_COUPLE] = REFUSED(STOPPING),
        [ON_DECOUPLE] = REFUSED(STOPPING),
        [ON_SHIFT_PHASE] = REFUSED(STOPPING),
    },
    [CM1E_AXIS_ERROR_STOP] = {
        [ON_DISCRETE] = REFUSED(ERROR_STOP),
        [ON_CONTINUOUS] = REFUSED(ERROR_STOP),
        [ON_STOP] = REFUSED(ERROR_STOP),
        [ON_HOME] = REFUSED(ERROR_STOP),
        [ON_HOMING_STEP] = REFUSED(ERROR_STOP),
        [ON_SUPERIMPOSE] = REFUSED(ERROR_STOP),
        [ON_HALT_SUPERIMPOSED] = REFUSED(ERROR_STOP),
        [ON_COUPLE] = REFUSED(ERROR_STOP),
        [ON_DECOUPLE] = REFUSED(ERROR_STOP),
        [ON_SHIFT_PHASE] = REFUSED(ERROR_STOP),
    },
};

static const char *const names[CM1E_AXIS_STATE_COUNT] = {
    [CM1E_AXIS_DISABLED] = "Disabled",
    [CM1E_AXIS_STANDSTILL] = "Standstill",
    [CM1E_AXIS_HOMING] = "Homing",
    [CM1E_AXIS_DISCRETE_MOTION] = "DiscreteMotion",
    [CM1E_AXIS_CONTINUOUS_MOTION] = "ContinuousMotion",
    [CM1E_AXIS_SYNCHRONIZED_MOTION] = "SynchronizedMotion",
    [CM1E_AXIS_STOPPING] = "Stopping",
    [CM1E_AXIS_ERROR_STOP] = "ErrorStop",
};

const state_rule_t *cm1e_axis_state_rule(cm1e_axis_state_t state, cm1e_command_kind_t kind)
{
    return &rules[state][kind_row(kind)->trigger];
}

const char *cm1e_axis_state_name(cm1e_axis_state_t state)
{
    return (unsigned)state < CM1E_AXIS_STATE_COUNT ? names[state] : "unknown";
}
