/* The power drive system of an axis (BR 6.1), and errors of its motor. */
#include "sim/bridge_app.h"

/* State A is reached: "when transiting to state A from state B or C, Cool Muscle will be motor free automatically". */
void cm1e_sim_bridge_axis_release(cm1e_sim_bridge_axis_t *axis, cm1e_fsa_state_t state)
{
    axis->state = state;
    cm1e_sim_bridge_search_abort(axis);
    cm1e_sim_bridge_axis_power(axis, false);
}

static void switch_on(cm1e_sim_bridge_axis_t *axis)
{
    axis->state = SWITCHED_ON;
    cm1e_sim_bridge_search_abort(axis);
    cm1e_sim_bridge_axis_power(axis, true);
    cm1e_sim_bridge_axis_hold(axis);
}

static void enable_operation(cm1e_sim_bridge_axis_t *axis)
{
    axis->state = OPERATION_ENABLED;
    cm1e_sim_bridge_axis_begin_csp(axis);
}

void cm1e_sim_bridge_axis_error(cm1e_sim_bridge_axis_t *axis, uint8_t status)
{
    axis->error = status;
    cm1e_sim_bridge_search_abort(axis);
    cm1e_sim_bridge_axis_power(axis, false);
    axis->overload = axis->lag_s = 0;
    if (axis->state != FAULT && axis->state != NOT_READY_TO_SWITCH_ON)
        axis->state = FAULT_REACTION_ACTIVE;
}

void cm1e_sim_bridge_axis_disable(cm1e_sim_bridge_axis_t *axis)
{
    if (axis->state == SWITCHED_ON || axis->state == OPERATION_ENABLED)
        cm1e_sim_bridge_axis_release(axis, SWITCH_ON_DISABLED);
    cm1e_sim_bridge_search_abort(axis);
    axis->last_controlword = axis->controlword = 0;
    axis->same_words = UINT16_MAX; /* none goes over the serial line any more */
}

void cm1e_sim_bridge_axis_ready(cm1e_sim_bridge_axis_t *axis)
{
    if (axis->state == NOT_READY_TO_SWITCH_ON)
        axis->state = axis->error ? FAULT : SWITCH_ON_DISABLED;
}

/* One transition each cycle; the numbers are those of BR 6.1.1. */
void cm1e_sim_bridge_axis_obey(cm1e_sim_bridge_axis_t *axis, unsigned controlword)
{
    const cm1e_fsa_command_t command = cm1e_fsa_command_of((uint16_t)controlword); /* BR 6.1.2 */
    const bool wants_power = command == COMMAND_SWITCH_ON || command == COMMAND_ENABLE_OPERATION;
    if (command == COMMAND_QUICK_STOP) /* no command here: it is ignored */
        axis->broken_rules |= CM1E_SIM_QUICK_STOP;
    switch (axis->state) {
    case SWITCH_ON_DISABLED:
        if (command == COMMAND_SHUTDOWN)
            axis->state = READY_TO_SWITCH_ON; /* 2 */
        break;
    case READY_TO_SWITCH_ON:
        if (wants_power)
            switch_on(axis); /* 3 */
        else if (command == COMMAND_DISABLE_VOLTAGE)
            axis->state = SWITCH_ON_DISABLED; /* 7: from state A to state A, which leaves the motor as it is */
        break;
    case SWITCHED_ON:
    case OPERATION_ENABLED:
        if (command == COMMAND_ENABLE_OPERATION && axis->state == SWITCHED_ON)
            enable_operation(axis); /* 4 */
        else if (command == COMMAND_SWITCH_ON)
            switch_on(axis); /* 5 */
        else if (command == COMMAND_SHUTDOWN)
            cm1e_sim_bridge_axis_release(axis, READY_TO_SWITCH_ON); /* 6, 8 */
        else if (command == COMMAND_DISABLE_VOLTAGE)
            cm1e_sim_bridge_axis_release(axis, SWITCH_ON_DISABLED); /* 9, 10 */
        break;
    default:
        break;
    }
}

void cm1e_sim_bridge_axis_reset_fault(cm1e_sim_bridge_axis_t *axis)
{
    axis->error = 0;
    axis->silent_ms = 0;
    cm1e_sim_bridge_axis_release(axis, SWITCH_ON_DISABLED); /* 15 */
}

bool cm1e_sim_bridge_io_available(const cm1e_sim_bridge_axis_t *axis)
{
    return axis->mode == CM1E_BRIDGE_MODE_CSP && (axis->state == SWITCHED_ON || axis->state == OPERATION_ENABLED);
}

/* BR 6.1.3: of the lower bits, 4 and 5 are no part of the state, and 0 here. */
uint16_t cm1e_sim_bridge_state_bits(const cm1e_sim_bridge_axis_t *axis)
{
    static const uint16_t bits_of_state[CM1E_FSA_STATE_COUNT] = {
        [NOT_READY_TO_SWITCH_ON] = 0x00, [SWITCH_ON_DISABLED] = 0x40,    [READY_TO_SWITCH_ON] = 0x01,
        [SWITCHED_ON] = 0x03,            [OPERATION_ENABLED] = 0x07,     [FAULT_REACTION_ACTIVE] = 0x0F,
        [FAULT] = 0x08,
    };
    return bits_of_state[axis->state];
}
