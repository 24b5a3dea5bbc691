/* The state diagram of PLCopen Part 1 v2.0, figure 2, as far as commands move it: state x command. The transitions by
 * MC_Power, MC_Reset and axis errors are in axis_power.c, those at the end of a command in axis_motion.c. */
#include "axis/axis_private.h"

#define REFUSED(why) {.refusal = CM1E_ERROR_AXIS_##why}
#define TO(state) {.refusal = CM1E_OK, .next = CM1E_AXIS_##state}

/* Commands that the diagram does not tell apart. */
typedef enum trigger {
    DISCRETE = 0,
    CONTINUOUS,
    STOP,
    HOME,
    HOMING_STEP,
    SUPERIMPOSED,
    HALT_SUPERIMPOSED,
    COUPLE,
    DECOUPLE,
    PHASING,
    TRIGGER_COUNT,
} trigger_t;

static const trigger_t triggers[CM1E_COMMAND_KIND_COUNT] = {
    [CM1E_COMMAND_MOVE_ABSOLUTE] = DISCRETE,
    [CM1E_COMMAND_MOVE_RELATIVE] = DISCRETE,
    [CM1E_COMMAND_MOVE_ADDITIVE] = DISCRETE,
    [CM1E_COMMAND_MOVE_VELOCITY] = CONTINUOUS,
    [CM1E_COMMAND_MOVE_CONTINUOUS_ABSOLUTE] = CONTINUOUS,
    [CM1E_COMMAND_MOVE_CONTINUOUS_RELATIVE] = CONTINUOUS,
    [CM1E_COMMAND_POSITION_PROFILE] = DISCRETE,
    [CM1E_COMMAND_VELOCITY_PROFILE] = CONTINUOUS,
    [CM1E_COMMAND_ACCELERATION_PROFILE] = CONTINUOUS,
    [CM1E_COMMAND_HALT] = DISCRETE,
    [CM1E_COMMAND_STOP] = STOP,
    [CM1E_COMMAND_HOME] = HOME,
    [CM1E_COMMAND_HOMING_STEP] = HOMING_STEP,
    [CM1E_COMMAND_MOVE_SUPERIMPOSED] = SUPERIMPOSED,
    [CM1E_COMMAND_HALT_SUPERIMPOSED] = HALT_SUPERIMPOSED,
    [CM1E_COMMAND_GEAR_IN] = COUPLE,
    [CM1E_COMMAND_GEAR_IN_POS] = COUPLE,
    [CM1E_COMMAND_CAM_IN] = COUPLE,
    [CM1E_COMMAND_COMBINE_AXES] = COUPLE,
    [CM1E_COMMAND_GEAR_OUT] = DECOUPLE,
    [CM1E_COMMAND_CAM_OUT] = DECOUPLE,
    [CM1E_COMMAND_PHASING_ABSOLUTE] = PHASING,
    [CM1E_COMMAND_PHASING_RELATIVE] = PHASING,
};

/* Homing has no arrow to a motion, so only MC_Stop and the next step of a homing in steps (Part 5) are taken there.
 * Stopping takes another MC_Stop only when no MC_Stop holds it any more (axis_command.c): the same block may so be
 * triggered again while the axis still brakes. A superimposed motion changes no state but Standstill (3.8).
 * What leaves a master, or shifts against it, needs one (4.4, 4.6, 4.8). */
static const state_rule_t rules[CM1E_AXIS_STATE_COUNT][TRIGGER_COUNT] = {
    [CM1E_AXIS_DISABLED] = {
        [DISCRETE] = REFUSED(NOT_POWERED),
        [CONTINUOUS] = REFUSED(NOT_POWERED),
        [STOP] = REFUSED(NOT_POWERED),
        [HOME] = REFUSED(NOT_POWERED),
        [HOMING_STEP] = REFUSED(NOT_POWERED),
        [SUPERIMPOSED] = REFUSED(NOT_POWERED),
        [HALT_SUPERIMPOSED] = REFUSED(NOT_POWERED),
        [COUPLE] = REFUSED(NOT_POWERED),
        [DECOUPLE] = REFUSED(NOT_POWERED),
        [PHASING] = REFUSED(NOT_POWERED),
    },
    [CM1E_AXIS_STANDSTILL] = {
        [DISCRETE] = TO(DISCRETE_MOTION),
        [CONTINUOUS] = TO(CONTINUOUS_MOTION),
        [STOP] = TO(STOPPING),
        [HOME] = TO(HOMING),
        [HOMING_STEP] = TO(HOMING),
        [SUPERIMPOSED] = TO(DISCRETE_MOTION),
        [HALT_SUPERIMPOSED] = TO(STANDSTILL),
        [COUPLE] = TO(SYNCHRONIZED_MOTION),
        [DECOUPLE] = REFUSED(NOT_COUPLED),
        [PHASING] = REFUSED(NOT_COUPLED),
    },
    [CM1E_AXIS_HOMING] = {
        [DISCRETE] = REFUSED(HOMING),
        [CONTINUOUS] = REFUSED(HOMING),
        [STOP] = TO(STOPPING),
        [HOME] = REFUSED(HOMING),
        [HOMING_STEP] = TO(HOMING),
        [SUPERIMPOSED] = REFUSED(HOMING),
        [HALT_SUPERIMPOSED] = REFUSED(HOMING),
        [COUPLE] = REFUSED(HOMING),
        [DECOUPLE] = REFUSED(HOMING),
        [PHASING] = REFUSED(HOMING),
    },
    [CM1E_AXIS_DISCRETE_MOTION] = {
        [DISCRETE] = TO(DISCRETE_MOTION),
        [CONTINUOUS] = TO(CONTINUOUS_MOTION),
        [STOP] = TO(STOPPING),
        [HOME] = REFUSED(STATE),
        [HOMING_STEP] = REFUSED(STATE),
        [SUPERIMPOSED] = TO(DISCRETE_MOTION),
        [HALT_SUPERIMPOSED] = TO(DISCRETE_MOTION),
        [COUPLE] = TO(SYNCHRONIZED_MOTION),
        [DECOUPLE] = REFUSED(NOT_COUPLED),
        [PHASING] = REFUSED(NOT_COUPLED),
    },
    [CM1E_AXIS_CONTINUOUS_MOTION] = {
        [DISCRETE] = TO(DISCRETE_MOTION),
        [CONTINUOUS] = TO(CONTINUOUS_MOTION),
        [STOP] = TO(STOPPING),
        [HOME] = REFUSED(STATE),
        [HOMING_STEP] = REFUSED(STATE),
        [SUPERIMPOSED] = TO(CONTINUOUS_MOTION),
        [HALT_SUPERIMPOSED] = TO(CONTINUOUS_MOTION),
        [COUPLE] = TO(SYNCHRONIZED_MOTION),
        [DECOUPLE] = REFUSED(NOT_COUPLED),
        [PHASING] = REFUSED(NOT_COUPLED),
    },
    [CM1E_AXIS_SYNCHRONIZED_MOTION] = {
        [DISCRETE] = TO(DISCRETE_MOTION),
        [CONTINUOUS] = TO(CONTINUOUS_MOTION),
        [STOP] = TO(STOPPING),
        [HOME] = REFUSED(STATE),
        [HOMING_STEP] = REFUSED(STATE),
        [SUPERIMPOSED] = TO(SYNCHRONIZED_MOTION),
        [HALT_SUPERIMPOSED] = TO(SYNCHRONIZED_MOTION),
        [COUPLE] = TO(SYNCHRONIZED_MOTION),
        [DECOUPLE] = TO(CONTINUOUS_MOTION),
        [PHASING] = TO(SYNCHRONIZED_MOTION),
    },
    [CM1E_AXIS_STOPPING] = {
        [DISCRETE] = REFUSED(STOPPING),
        [CONTINUOUS] = REFUSED(STOPPING),
        [STOP] = TO(STOPPING),
        [HOME] = REFUSED(STOPPING),
        [HOMING_STEP] = REFUSED(STOPPING),
        [SUPERIMPOSED] = REFUSED(STOPPING),
        [HALT_SUPERIMPOSED] = REFUSED(STOPPING),
        [COUPLE] = REFUSED(STOPPING),
        [DECOUPLE] = REFUSED(STOPPING),
        [PHASING] = REFUSED(STOPPING),
    },
    [CM1E_AXIS_ERROR_STOP] = {
        [DISCRETE] = REFUSED(ERROR_STOP),
        [CONTINUOUS] = REFUSED(ERROR_STOP),
        [STOP] = REFUSED(ERROR_STOP),
        [HOME] = REFUSED(ERROR_STOP),
        [HOMING_STEP] = REFUSED(ERROR_STOP),
        [SUPERIMPOSED] = REFUSED(ERROR_STOP),
        [HALT_SUPERIMPOSED] = REFUSED(ERROR_STOP),
        [COUPLE] = REFUSED(ERROR_STOP),
        [DECOUPLE] = REFUSED(ERROR_STOP),
        [PHASING] = REFUSED(ERROR_STOP),
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
    return &rules[state][triggers[kind]];
}

const char *cm1e_axis_state_name(cm1e_axis_state_t state)
{
    return (unsigned)state < CM1E_AXIS_STATE_COUNT ? names[state] : "unknown";
}
