#include "cia402/cia402.h"

/* UG 6.1.3, to the letter: Switch on disabled has bits 4 and 5 at 0, which the standard leaves open. */
const cm1e_fsa_row_t cm1e_fsa_table[CM1E_FSA_STATE_COUNT] = {
    {NOT_READY_TO_SWITCH_ON, 0x004F, 0x0000, "Not ready to switch on"},
    {SWITCH_ON_DISABLED, 0x007F, 0x0040, "Switch on disabled"},
    {READY_TO_SWITCH_ON, 0x006F, 0x0021, "Ready to switch on"},
    {SWITCHED_ON, 0x006F, 0x0023, "Switched on"},
    {OPERATION_ENABLED, 0x006F, 0x0027, "Operation enabled"},
    {QUICK_STOP_ACTIVE, 0x006F, 0x0007, "Quick stop active"},
    {FAULT_REACTION_ACTIVE, 0x004F, 0x000F, "Fault reaction active"},
    {FAULT, 0x004F, 0x0008, "Fault"},
};

/* IEC 61800-7-201: bit 5 is part of the states below Fault, bit 4 of none. */
const cm1e_fsa_row_t cm1e_fsa_cia402_table[CM1E_FSA_STATE_COUNT] = {
    {NOT_READY_TO_SWITCH_ON, 0x004F, 0x0000, "Not ready to switch on"},
    {SWITCH_ON_DISABLED, 0x004F, 0x0040, "Switch on disabled"},
    {READY_TO_SWITCH_ON, 0x006F, 0x0021, "Ready to switch on"},
    {SWITCHED_ON, 0x006F, 0x0023, "Switched on"},
    {OPERATION_ENABLED, 0x006F, 0x0027, "Operation enabled"},
    {QUICK_STOP_ACTIVE, 0x006F, 0x0007, "Quick stop active"},
    {FAULT_REACTION_ACTIVE, 0x004F, 0x000F, "Fault reaction active"},
    {FAULT, 0x004F, 0x0008, "Fault"},
};

/* A state that never shows: no word AND 0 is that. */
#define NEVER 0x0000, 0xFFFF

/* BR 6.1.3: bits 4 and 5 are "-", so they are no part of the state; there is no quick stop. */
const cm1e_fsa_row_t cm1e_fsa_bridge_table[CM1E_FSA_STATE_COUNT] = {
    {NOT_READY_TO_SWITCH_ON, 0x004F, 0x0000, "Not ready to switch on"},
    {SWITCH_ON_DISABLED, 0x004F, 0x0040, "Switch on disabled"},
    {READY_TO_SWITCH_ON, 0x004F, 0x0001, "Ready to switch on"},
    {SWITCHED_ON, 0x004F, 0x0003, "Switched on"},
    {OPERATION_ENABLED, 0x004F, 0x0007, "Operation enabled"},
    {QUICK_STOP_ACTIVE, NEVER, "Quick stop active"},
    {FAULT_REACTION_ACTIVE, 0x004F, 0x000F, "Fault reaction active"},
    {FAULT, 0x004F, 0x0008, "Fault"},
};

/* BR 7.1.3, note 3. Bit 6 is an input: Not ready to switch on looks like Switch on disabled. */
const cm1e_fsa_row_t cm1e_fsa_cpio_table[CM1E_FSA_STATE_COUNT] = {
    {NOT_READY_TO_SWITCH_ON, NEVER, "Not ready to switch on"},
    {SWITCH_ON_DISABLED, 0xF00F, 0xC000, "Switch on disabled"},
    {READY_TO_SWITCH_ON, 0xF00F, 0xC001, "Ready to switch on"},
    {SWITCHED_ON, 0xF00F, 0xC003, "Switched on"},
    {OPERATION_ENABLED, 0xF00F, 0xC007, "Operation enabled"},
    {QUICK_STOP_ACTIVE, NEVER, "Quick stop active"},
    {FAULT_REACTION_ACTIVE, 0xF00F, 0xC00F, "Fault reaction active"},
    {FAULT, 0xF00F, 0xC008, "Fault"},
};

cm1e_fsa_state_t cm1e_fsa_decode_by(const cm1e_fsa_row_t *table, uint16_t statusword)
{
    for (int i = 0; i < CM1E_FSA_STATE_COUNT; i++)
        if ((statusword & table[i].mask) == table[i].value)
            return table[i].state;
    return CM1E_FSA_UNKNOWN;
}

cm1e_fsa_state_t cm1e_fsa_decode(uint16_t statusword) { return cm1e_fsa_decode_by(cm1e_fsa_table, statusword); }

const char *cm1e_fsa_name(cm1e_fsa_state_t state)
{
    return (unsigned)state < CM1E_FSA_STATE_COUNT ? cm1e_fsa_table[state].name : "unknown state";
}

/* The CM1-E ignores the quick stop bit (UG 6.1.2), so no mask below looks at it and the quick stop command, which
 * differs from the others in nothing else, is never decoded. Every controlword is exactly one command. */
const cm1e_fsa_command_row_t cm1e_fsa_commands[CM1E_FSA_COMMAND_COUNT] = {
    {COMMAND_DISABLE_VOLTAGE, 0x0082, 0x0000, 0x0000, "Disable voltage"},
    {COMMAND_SHUTDOWN, 0x0083, 0x0002, 0x0006, "Shutdown"},
    {COMMAND_SWITCH_ON, 0x008B, 0x0003, 0x0007, "Switch on"},
    {COMMAND_ENABLE_OPERATION, 0x008B, 0x000B, 0x000F, "Enable operation"},
    {COMMAND_QUICK_STOP, 0x0000, 0x0002, 0x0002, "Quick stop"},
    {COMMAND_FAULT_RESET, 0x0080, 0x0080, 0x0086, "Fault reset"},
};

#define AUTOMATIC CM1E_FSA_COMMAND_COUNT

/*
 * UG 6.1.1 and 6.1.2 in the numbers of CiA 402. What makes the automatic ones happen: 1 a mode of operation was chosen,
 * 2 and 14 nothing further, 13 an error. Switch on disabled is passed through only, so that Disable voltage ends in
 * Ready to switch on; 7 (Ready to switch on to Switch on disabled) would go in a circle and does not exist, nor do 11,
 * 12 and 16 without a quick stop.
 */
const cm1e_fsa_transition_t cm1e_fsa_transitions[] = {
    {1, NOT_READY_TO_SWITCH_ON, SWITCH_ON_DISABLED, AUTOMATIC},
    {2, SWITCH_ON_DISABLED, READY_TO_SWITCH_ON, AUTOMATIC},
    {3, READY_TO_SWITCH_ON, SWITCHED_ON, COMMAND_SWITCH_ON},
    {3, READY_TO_SWITCH_ON, SWITCHED_ON, COMMAND_ENABLE_OPERATION},
    {4, SWITCHED_ON, OPERATION_ENABLED, COMMAND_ENABLE_OPERATION},
    {5, OPERATION_ENABLED, SWITCHED_ON, COMMAND_SWITCH_ON},
    {6, SWITCHED_ON, READY_TO_SWITCH_ON, COMMAND_SHUTDOWN},
    {8, OPERATION_ENABLED, READY_TO_SWITCH_ON, COMMAND_SHUTDOWN},
    {9, OPERATION_ENABLED, SWITCH_ON_DISABLED, COMMAND_DISABLE_VOLTAGE},
    {10, SWITCHED_ON, SWITCH_ON_DISABLED, COMMAND_DISABLE_VOLTAGE},
    {13, NOT_READY_TO_SWITCH_ON, FAULT_REACTION_ACTIVE, AUTOMATIC},
    {13, SWITCH_ON_DISABLED, FAULT_REACTION_ACTIVE, AUTOMATIC},
    {13, READY_TO_SWITCH_ON, FAULT_REACTION_ACTIVE, AUTOMATIC},
    {13, SWITCHED_ON, FAULT_REACTION_ACTIVE, AUTOMATIC},
    {13, OPERATION_ENABLED, FAULT_REACTION_ACTIVE, AUTOMATIC},
    {14, FAULT_REACTION_ACTIVE, FAULT, AUTOMATIC},
    {15, FAULT, READY_TO_SWITCH_ON, COMMAND_FAULT_RESET},
    {0xFF, CM1E_FSA_UNKNOWN, CM1E_FSA_UNKNOWN, AUTOMATIC},
};

/* In the order of the states, an unknown one last. Where only waiting helps, and where the state cannot be told, it is
 * Shutdown, under which the motor has no torque. */
static const struct {
    cm1e_fsa_command_t enable, disable;
} next_commands[CM1E_FSA_STATE_COUNT + 1] = {
    [NOT_READY_TO_SWITCH_ON] = {COMMAND_SHUTDOWN, COMMAND_SHUTDOWN},
    [SWITCH_ON_DISABLED] = {COMMAND_SHUTDOWN, COMMAND_SHUTDOWN},
    [READY_TO_SWITCH_ON] = {COMMAND_SWITCH_ON, COMMAND_SHUTDOWN},
    [SWITCHED_ON] = {COMMAND_ENABLE_OPERATION, COMMAND_SHUTDOWN},
    [OPERATION_ENABLED] = {COMMAND_ENABLE_OPERATION, COMMAND_SHUTDOWN},
    [QUICK_STOP_ACTIVE] = {COMMAND_DISABLE_VOLTAGE, COMMAND_DISABLE_VOLTAGE},
    [FAULT_REACTION_ACTIVE] = {COMMAND_SHUTDOWN, COMMAND_SHUTDOWN},
    [FAULT] = {COMMAND_FAULT_RESET, COMMAND_FAULT_RESET},
    [CM1E_FSA_UNKNOWN] = {COMMAND_SHUTDOWN, COMMAND_SHUTDOWN},
};

cm1e_fsa_command_t cm1e_fsa_command_of(uint16_t controlword)
{
    if (!(controlword & CONTROLWORD_ENABLE_VOLTAGE))
        return COMMAND_DISABLE_VOLTAGE;
    if (!(controlword & CONTROLWORD_QUICK_STOP))
        return COMMAND_QUICK_STOP;
    if (!(controlword & CONTROLWORD_SWITCH_ON))
        return COMMAND_SHUTDOWN;
    return controlword & CONTROLWORD_ENABLE_OPERATION ? COMMAND_ENABLE_OPERATION : COMMAND_SWITCH_ON;
}

cm1e_fsa_command_t cm1e_fsa_next_command(cm1e_fsa_state_t state, bool enable)
{
    if ((unsigned)state > CM1E_FSA_UNKNOWN)
        state = CM1E_FSA_UNKNOWN;
    return enable ? next_commands[state].enable : next_commands[state].disable;
}
