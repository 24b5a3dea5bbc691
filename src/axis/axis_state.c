/*
 * The state diagram of PLCopen Part 1 v2.0, figure 2. A cell is the state that the trigger leads to, or the error with
 * which a command is refused in that state, or STAYS.
 *
 * Homing has no arrow to a motion, so it accepts only MC_Stop and the next step of a homing in steps (Part 5). Stopping
 * accepts another MC_Stop only when no MC_Stop holds it any more (axis_command.c). So the same block may be triggered
 * again while the axis still brakes. A superimposed motion changes no state except Standstill (3.8). Commands that
 * leave a master, or shift against it, need a master (4.4, 4.6, 4.8). ErrorStop always ends without torque, so MC_Reset
 * leads to Disabled (note 3), and from there to Standstill if MC_Power.Enable is TRUE: this is note 4.
 */
#include "axis/axis_state.h"

#include "axis/axis_parts.h"

enum {
    DISABLED = CM1E_AXIS_DISABLED,
    STANDSTILL = CM1E_AXIS_STANDSTILL,
    HOMING = CM1E_AXIS_HOMING,
    DISCRETE = CM1E_AXIS_DISCRETE_MOTION,
    CONTINUOUS = CM1E_AXIS_CONTINUOUS_MOTION,
    SYNCHRON = CM1E_AXIS_SYNCHRONIZED_MOTION,
    STOPPING = CM1E_AXIS_STOPPING,
    ERRORSTOP = CM1E_AXIS_ERROR_STOP,
    STAYS = CM1E_AXIS_STATE_COUNT,
    /* refused */
    NO_POWER = CM1E_ERROR_AXIS_NOT_POWERED,
    HOMES = CM1E_ERROR_AXIS_HOMING,
    MOVES = CM1E_ERROR_AXIS_STATE,
    NO_MASTER = CM1E_ERROR_AXIS_NOT_COUPLED,
    STOPS = CM1E_ERROR_AXIS_STOPPING,
    ERROR = CM1E_ERROR_AXIS_ERROR_STOP,
};

static const int16_t diagram[STATE_TRIGGER_COUNT][CM1E_AXIS_STATE_COUNT] = {
    /* in                   Disabled  Standstill  Homing      Discrete    Continuous  Synchronized Stopping ErrorStop */
    [ON_DISCRETE]          = {NO_POWER, DISCRETE,   HOMES,      DISCRETE,   DISCRETE,   DISCRETE,   STOPS,      ERROR},
    [ON_CONTINUOUS]        = {NO_POWER, CONTINUOUS, HOMES,      CONTINUOUS, CONTINUOUS, CONTINUOUS, STOPS,      ERROR},
    [ON_COUPLE]            = {NO_POWER, SYNCHRON,   HOMES,      SYNCHRON,   SYNCHRON,   SYNCHRON,   STOPS,      ERROR},
    [ON_DECOUPLE]          = {NO_POWER, NO_MASTER,  HOMES,      NO_MASTER,  NO_MASTER,  CONTINUOUS, STOPS,      ERROR},
    [ON_SHIFT_PHASE]       = {NO_POWER, NO_MASTER,  HOMES,      NO_MASTER,  NO_MASTER,  STAYS,      STOPS,      ERROR},
    [ON_FOLLOW]            = {NO_POWER, SYNCHRON,   HOMES,      MOVES,      MOVES,      MOVES,      STOPS,      ERROR},
    [ON_SUPERIMPOSE]       = {NO_POWER, DISCRETE,   HOMES,      STAYS,      STAYS,      STAYS,      STOPS,      ERROR},
    [ON_HALT_SUPERIMPOSED] = {NO_POWER, STAYS,      HOMES,      STAYS,      STAYS,      STAYS,      STOPS,      ERROR},
    [ON_HOME]              = {NO_POWER, HOMING,     HOMES,      MOVES,      MOVES,      MOVES,      STOPS,      ERROR},
    [ON_HOMING_STEP]       = {NO_POWER, HOMING,     STAYS,      MOVES,      MOVES,      MOVES,      STOPS,      ERROR},
    [ON_STOP]              = {NO_POWER, STOPPING,   STOPPING,   STOPPING,   STOPPING,   STOPPING,   STAYS,      ERROR},
    [ON_AT_REST]           = {STAYS,    STAYS,      STAYS,      STANDSTILL, STANDSTILL, STAYS,      STAYS,      STAYS},
    [ON_DONE]              = {STAYS,    STAYS,      STANDSTILL, STANDSTILL, STAYS,      STAYS,      STAYS,      STAYS},
    [ON_BROKEN_OFF]        = {STAYS,    STAYS,      STAYS,      STAYS,      DISCRETE,   DISCRETE,   STAYS,      STAYS},
    [ON_STOP_RELEASED]     = {STAYS,    STAYS,      STAYS,      STAYS,      STAYS,      STAYS,      STANDSTILL, STAYS},
    [ON_LED]               = {STAYS,    SYNCHRON,   STAYS,      STAYS,      STAYS,      STAYS,      STAYS,      STAYS},
    [ON_LET_GO]            = {STAYS,    STAYS,      STAYS,      STAYS,      STAYS,      STANDSTILL, STAYS,      STAYS},
    [ON_POWER_ON]          = {STANDSTILL, STAYS,    STAYS,      STAYS,      STAYS,      STAYS,      STAYS,      STAYS},
    [ON_POWER_OFF]         = {STAYS,    DISABLED,   DISABLED,   DISABLED,   DISABLED,   DISABLED,   DISABLED,   STAYS},
    [ON_ERROR]             = {ERRORSTOP, ERRORSTOP, ERRORSTOP,  ERRORSTOP,  ERRORSTOP,  ERRORSTOP,  ERRORSTOP,  STAYS},
    [ON_RESET]             = {STAYS,    STAYS,      STAYS,      STAYS,      STAYS,      STAYS,      STAYS,   DISABLED},
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

cm1e_error_t cm1e_axis_state_refusal(cm1e_axis_state_t state, state_trigger_t trigger)
{
    const int cell = diagram[trigger][state];
    return cell < 0 ? (cm1e_error_t)cell : CM1E_OK;
}

/* The same one where the diagram has no arrow, or the command is refused. */
static cm1e_axis_state_t state_after(cm1e_axis_state_t state, state_trigger_t trigger)
{
    const int cell = diagram[trigger][state];
    return cell < 0 || cell == STAYS ? state : (cm1e_axis_state_t)cell;
}

void cm1e_axis_go(cm1e_axis_t *axis, state_trigger_t trigger)
{
    axis->state = state_after(axis->state, trigger);
}

const char *cm1e_axis_state_name(cm1e_axis_state_t state)
{
    return (unsigned)state < CM1E_AXIS_STATE_COUNT ? names[state] : "unknown";
}
