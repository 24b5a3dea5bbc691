/* The power drive system of CiA 402 with all its states, errors, and the statusword. */
#include "sim/cia402_app.h"

enum { INITIALISE_NS = 20000000, REACTION_NS = 1000000 };
enum { ERROR_DC_LINK_UNDER_VOLTAGE = 0x3220 };

static bool in_fault(const cm1e_sim_cia402_t *drive)
{
    return drive->state == FAULT || drive->state == FAULT_REACTION_ACTIVE;
}

static void report(cm1e_sim_cia402_t *drive, uint16_t code)
{
    static const uint8_t no_data[5];
    const cm1e_device_error_t *error = cm1e_cia402_error(code);
    *drive->v.error_code = code;
    *drive->v.error_register = error ? error->error_register : 0x01;
    if (drive->slave && code != drive->reported_code)
        cm1e_sim_slave_emergency(drive->slave, code, (uint8_t)*drive->v.error_register, no_data);
    drive->reported_code = code;
}

static void enter(cm1e_sim_cia402_t *drive, cm1e_fsa_state_t state)
{
    const cm1e_fsa_state_t before = drive->state;
    drive->state = state;
    drive->state_deadline_ns = state == NOT_READY_TO_SWITCH_ON   ? drive->now_ns + INITIALISE_NS
                               : state == FAULT_REACTION_ACTIVE ? drive->now_ns + REACTION_NS : INT64_MAX;
    const bool torque = state == OPERATION_ENABLED || state == QUICK_STOP_ACTIVE;
    const bool torque_before = before == OPERATION_ENABLED || before == QUICK_STOP_ACTIVE;
    if (torque != torque_before)
        cm1e_servo_catch(&drive->servo, &drive->mechanics);
    if (!torque) {
        drive->homing.search.phase = drive->homing.search.phase == SEARCH_DONE ? SEARCH_DONE : SEARCH_IDLE;
        drive->homing.started = drive->homing.halted = false;
    }
    drive->lag_s = 0;
    if (state == OPERATION_ENABLED && before != OPERATION_ENABLED && drive->generator)
        drive->generator->enter(drive);
}

void cm1e_sim_cia402_reset(cm1e_sim_cia402_t *drive)
{
    drive->last_controlword = 0;
    drive->generator = NULL;
    drive->reported_code = 0;
    enter(drive, NOT_READY_TO_SWITCH_ON);
}

void cm1e_sim_cia402_deadline(cm1e_sim_cia402_t *drive)
{
    drive->state_deadline_ns = INT64_MAX;
    if (drive->state == NOT_READY_TO_SWITCH_ON)
        enter(drive, SWITCH_ON_DISABLED);
    else if (drive->state == FAULT_REACTION_ACTIVE)
        enter(drive, FAULT);
}

void cm1e_sim_cia402_disable(cm1e_sim_cia402_t *drive)
{
    if (!in_fault(drive) && drive->state != NOT_READY_TO_SWITCH_ON && drive->state != SWITCH_ON_DISABLED)
        enter(drive, SWITCH_ON_DISABLED);
}

void cm1e_sim_cia402_fault(cm1e_sim_cia402_t *drive, uint16_t code)
{
    if (in_fault(drive))
        return;
    report(drive, code);
    enter(drive, FAULT_REACTION_ACTIVE);
}

void cm1e_sim_cia402_motor_power(cm1e_sim_cia402_t *drive, bool on)
{
    drive->motor_power = on;
    if (!on && (drive->state == OPERATION_ENABLED || drive->state == QUICK_STOP_ACTIVE))
        cm1e_sim_cia402_fault(drive, ERROR_DC_LINK_UNDER_VOLTAGE);
    else if (!on && drive->state == SWITCHED_ON)
        enter(drive, READY_TO_SWITCH_ON);
}

/* ---- controlword ------------------------------------------------------------------------------------------------- */

static const cm1e_fsa_transition_t transitions[] = {
    {2, SWITCH_ON_DISABLED, READY_TO_SWITCH_ON, COMMAND_SHUTDOWN},
    {3, READY_TO_SWITCH_ON, SWITCHED_ON, COMMAND_SWITCH_ON},
    {3, READY_TO_SWITCH_ON, SWITCHED_ON, COMMAND_ENABLE_OPERATION},
    {4, SWITCHED_ON, OPERATION_ENABLED, COMMAND_ENABLE_OPERATION},
    {5, OPERATION_ENABLED, SWITCHED_ON, COMMAND_SWITCH_ON},
    {6, SWITCHED_ON, READY_TO_SWITCH_ON, COMMAND_SHUTDOWN},
    {7, READY_TO_SWITCH_ON, SWITCH_ON_DISABLED, COMMAND_DISABLE_VOLTAGE},
    {7, READY_TO_SWITCH_ON, SWITCH_ON_DISABLED, COMMAND_QUICK_STOP},
    {8, OPERATION_ENABLED, READY_TO_SWITCH_ON, COMMAND_SHUTDOWN},
    {9, OPERATION_ENABLED, SWITCH_ON_DISABLED, COMMAND_DISABLE_VOLTAGE},
    {10, SWITCHED_ON, SWITCH_ON_DISABLED, COMMAND_DISABLE_VOLTAGE},
    {10, SWITCHED_ON, SWITCH_ON_DISABLED, COMMAND_QUICK_STOP},
    {11, OPERATION_ENABLED, QUICK_STOP_ACTIVE, COMMAND_QUICK_STOP},
    {12, QUICK_STOP_ACTIVE, SWITCH_ON_DISABLED, COMMAND_DISABLE_VOLTAGE},
};

static void apply(cm1e_sim_cia402_t *drive, uint16_t controlword)
{
    const cm1e_fsa_command_t command = cm1e_fsa_command_of(controlword);
    for (size_t i = 0; i < sizeof transitions / sizeof transitions[0]; i++) {
        const cm1e_fsa_transition_t *t = &transitions[i];
        if (t->from != drive->state || t->command != command)
            continue;
        if (t->to != SWITCHED_ON || drive->motor_power)
            enter(drive, t->to);
        return;
    }
}

static void fault_reset(cm1e_sim_cia402_t *drive)
{
    if (drive->state != FAULT)
        return;
    report(drive, 0);
    enter(drive, SWITCH_ON_DISABLED);
    if (drive->held_code)
        cm1e_sim_cia402_fault(drive, drive->held_code);
}

static void choose_mode(cm1e_sim_cia402_t *drive)
{
    const cm1e_sim_cia402_mode_t *mode = cm1e_sim_cia402_mode((int8_t)*drive->v.mode);
    if (mode == drive->generator || !mode) /* a value that is no mode changes nothing */
        return;
    drive->generator = mode;
    *drive->v.mode_display = mode->mode;
    if (drive->state == OPERATION_ENABLED)
        mode->enter(drive);
}

void cm1e_sim_cia402_command(cm1e_sim_cia402_t *drive)
{
    const uint16_t controlword = (uint16_t)*drive->v.controlword;
    const uint16_t rising = (uint16_t)(controlword & ~drive->last_controlword);
    drive->last_controlword = controlword;
    choose_mode(drive);
    if (rising & CONTROLWORD_FAULT_RESET)
        fault_reset(drive);
    else if (drive->generator) /* no torque without a mode */
        apply(drive, controlword);
    if (drive->state == OPERATION_ENABLED)
        /* NOLINTNEXTLINE(clang-analyzer-core.NullDereference): Operation enabled has a generator */
        drive->generator->outputs(drive, rising);
}

uint16_t cm1e_sim_cia402_statusword(const cm1e_sim_cia402_t *drive)
{
    unsigned word = cm1e_fsa_cia402_table[drive->state].value | STATUSWORD_REMOTE;
    if (drive->motor_power)
        word |= STATUSWORD_VOLTAGE_ENABLED;
    if (drive->generator)
        word |= drive->generator->status_bits(drive);
    return (uint16_t)word;
}
