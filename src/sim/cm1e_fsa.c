#include "sim/cm1e_app.h"

enum {
    /* States that are "automatically transitioned through" (UG 6.1.3) are there for a moment. */
    PASSING_NS = 1000000,
    /* From a new 0x6060 to the same value in 0x6061: the slave switches the motor's own controller. */
    MODE_SWITCH_NS = 3000000,
    /* Absence from the bus when clearing a power-up fault resets the device's processor (UG 10.1, V1.3.5). */
    RESTART_NS = 300000000,
    OVER_TEMPERATURE_C = 85,
};
enum { ERROR_OVER_TEMPERATURE = 0x4310, ERROR_NO_MODE = 0x4502, ERROR_CONNECTION = 0x7510, ERROR_NOT_FOLLOWING = 0x8611,
       ERROR_DISABLED = 0xFF01, ERROR_MOTOR_POWER = 0xFF05 };

static bool in_fault(const cm1e_sim_cm1e_t *drive)
{
    return drive->fsa.state == FAULT || drive->fsa.state == FAULT_REACTION_ACTIVE;
}

static void set_deadline(cm1e_sim_cm1e_t *drive)
{
    drive->fsa.deadline_ns = drive->fsa.state_deadline_ns < drive->fsa.mode_deadline_ns ? drive->fsa.state_deadline_ns
                                                                            : drive->fsa.mode_deadline_ns;
}

/* "No CiA mode of operation selected" (UG 6.1.3) or ready. */
static cm1e_fsa_state_t resting_state(const cm1e_sim_cm1e_t *drive)
{
    return drive->objects.mode_display == CM1E_MODE_NONE ? NOT_READY_TO_SWITCH_ON : READY_TO_SWITCH_ON;
}

static void torque_off(cm1e_sim_cm1e_t *drive)
{
    cm1e_servo_catch(&drive->servo, &drive->mechanics);
    cm1e_sim_homing_abort(drive);
    drive->watch.following = false;
}

static void torque_on(cm1e_sim_cm1e_t *drive)
{
    cm1e_servo_catch(&drive->servo, &drive->mechanics);
    drive->servo.torque_limit = drive->motor->peak_torque_nm;
    drive->watch.lag_s = 0;
    drive->watch.overspeed_s = 0;
    drive->fsa.was_enabled = true;
    if (drive->fsa.generator)
        drive->fsa.generator->enter(drive);
}

static void enter_state(cm1e_sim_cm1e_t *drive, cm1e_fsa_state_t state)
{
    const cm1e_fsa_state_t before = drive->fsa.state;
    drive->fsa.state = state;
    drive->fsa.settled = false;
    drive->fsa.state_deadline_ns =
        state == SWITCH_ON_DISABLED || state == FAULT_REACTION_ACTIVE ? drive->now_ns + PASSING_NS : INT64_MAX;
    set_deadline(drive);
    if (before == OPERATION_ENABLED && state != OPERATION_ENABLED)
        torque_off(drive);
    else if (before != OPERATION_ENABLED && state == OPERATION_ENABLED)
        torque_on(drive);
}

void cm1e_sim_fsa_disable(cm1e_sim_cm1e_t *drive)
{
    if (!in_fault(drive) && drive->fsa.state != resting_state(drive))
        enter_state(drive, resting_state(drive));
    drive->fsa.settled = false;
    drive->fsa.last_controlword = 0;
    cm1e_sim_fsa_update_error(drive);
}

void cm1e_sim_fsa_off(cm1e_sim_cm1e_t *drive)
{
    drive->fsa.mode_deadline_ns = INT64_MAX;
    enter_state(drive, NOT_READY_TO_SWITCH_ON);
    drive->fsa.settled = true;
}

/* ---- errors (UG 7.3.1) ------------------------------------------------------------------------------------------ */

static uint16_t present_code(const cm1e_sim_cm1e_t *drive)
{
    if (drive->fsa.fault_code)
        return drive->fsa.fault_code;
    if (drive->fsa.power_up_fault)
        return ERROR_CONNECTION;
    if (!drive->motor_power)
        return ERROR_MOTOR_POWER;
    if (drive->troubles.shown_code)
        return drive->troubles.shown_code;
    if (drive->objects.mode_display == CM1E_MODE_NONE)
        return ERROR_NO_MODE;
    if (drive->fsa.state != OPERATION_ENABLED)
        return drive->fsa.was_enabled ? ERROR_DISABLED : ERROR_NOT_FOLLOWING;
    return drive->watch.following ? 0 : ERROR_NOT_FOLLOWING;
}

void cm1e_sim_fsa_update_error(cm1e_sim_cm1e_t *drive)
{
    const uint16_t code = present_code(drive);
    const uint16_t shown = (uint16_t)cm1e_sim_slave_code(drive->slave, CM1E_SIM_CODE_ERROR, code);
    if (shown == drive->objects.error_code)
        return;
    const uint8_t before = (uint8_t)drive->objects.error_register;
    const cm1e_device_error_t *error = cm1e_device_error(code);
    drive->objects.error_code = shown;
    drive->objects.error_register = error->error_register;
    static const uint8_t no_data[5];
    if (!drive->slave)
        return;
    if (error->error_register != 0)
        cm1e_sim_slave_emergency(drive->slave, shown, error->error_register, no_data);
    else if (before != 0) /* ETG.1000.6 5.6.4: error reset */
        cm1e_sim_slave_emergency(drive->slave, 0, 0, no_data);
}

void cm1e_sim_fsa_error(cm1e_sim_cm1e_t *drive, uint16_t code)
{
    const cm1e_device_error_t *error = cm1e_device_error(code);
    if (!error || !error->fault || in_fault(drive))
        return;
    if (error->fault_only_when_enabled && drive->fsa.state != OPERATION_ENABLED)
        return;
    drive->fsa.fault_code = code;
    enter_state(drive, FAULT_REACTION_ACTIVE);
    cm1e_sim_fsa_update_error(drive);
}

void cm1e_sim_fsa_motor_power(cm1e_sim_cm1e_t *drive, bool on)
{
    drive->motor_power = on;
    drive->objects.dc_link = on ? (int32_t)cm1e_device_entry(OBJ_6079_DC_LINK_VOLTAGE, 0)->default_value : 0;
    drive->fsa.settled = false;
    if (!on) {
        /* A fault in Operation enabled; below it only the code is shown (UG 7.3.1 note 3). */
        cm1e_sim_fsa_error(drive, ERROR_MOTOR_POWER);
        if (drive->fsa.state == SWITCHED_ON)
            enter_state(drive, READY_TO_SWITCH_ON);
    }
    cm1e_sim_fsa_update_error(drive);
}

/* What has not gone away is there again at once. */
static void raise_present_causes(cm1e_sim_cm1e_t *drive)
{
    if (drive->troubles.held_code)
        cm1e_sim_fsa_error(drive, drive->troubles.held_code);
    if (drive->objects.temperature >= OVER_TEMPERATURE_C)
        cm1e_sim_fsa_error(drive, ERROR_OVER_TEMPERATURE);
}

void cm1e_sim_fsa_temperature(cm1e_sim_cm1e_t *drive, int16_t degrees)
{
    drive->objects.temperature = degrees;
    raise_present_causes(drive);
}

/* One attempt to talk to the motor controller, as after power-on. */
static bool connection_fails(cm1e_sim_cm1e_t *drive)
{
    if (drive->troubles.failing_power_ups == 0)
        return false;
    if (drive->troubles.failing_power_ups != UINT32_MAX)
        drive->troubles.failing_power_ups--;
    return true;
}

static void restart(cm1e_sim_cm1e_t *drive)
{
    cm1e_sim_fsa_off(drive);
    drive->restarts = true;
    if (drive->slave)
        cm1e_sim_slave_reset(drive->slave, drive->now_ns + RESTART_NS);
}

/* The rising edge of controlword bit 7. */
static void fault_reset(cm1e_sim_cm1e_t *drive)
{
    if (drive->fsa.power_up_fault && drive->firmware->communication_fault_resets) {
        restart(drive);
        return;
    }
    if (drive->fsa.power_up_fault)
        drive->fsa.power_up_fault = connection_fails(drive);
    if (drive->fsa.state == FAULT) {
        drive->fsa.fault_code = 0;
        drive->watch.overload = 0;
        drive->fsa.was_enabled = false;
        enter_state(drive, resting_state(drive));
        raise_present_causes(drive);
    }
    cm1e_sim_fsa_update_error(drive);
}

/* ---- controlword (UG 6.1.2) ------------------------------------------------------------------------------------- */

static cm1e_fsa_command_t decode_command(uint16_t controlword)
{
    for (int i = 0; i < CM1E_FSA_COMMAND_COUNT; i++)
        if ((controlword & cm1e_fsa_commands[i].mask) == cm1e_fsa_commands[i].value)
            return cm1e_fsa_commands[i].command;
    return CM1E_FSA_COMMAND_COUNT;
}

static const cm1e_fsa_transition_t *find_transition(cm1e_fsa_state_t from, cm1e_fsa_command_t command)
{
    for (const cm1e_fsa_transition_t *t = cm1e_fsa_transitions; t->number != 0xFF; t++)
        if (t->from == from && t->command == command)
            return t;
    return NULL;
}

/* Motor power must be present from Switched on upwards (UG 6.1.1). */
static bool may_enter(const cm1e_sim_cm1e_t *drive, cm1e_fsa_state_t state)
{
    return (state != SWITCHED_ON && state != OPERATION_ENABLED) || (drive->motor_power && !drive->fsa.power_up_fault);
}

static void apply_controlword(cm1e_sim_cm1e_t *drive, uint16_t controlword)
{
    const cm1e_fsa_command_t command = decode_command(controlword);
    const cm1e_fsa_transition_t *transition;
    while (command != COMMAND_FAULT_RESET && (transition = find_transition(drive->fsa.state, command)) &&
           may_enter(drive, transition->to))
        enter_state(drive, transition->to);
    drive->fsa.settled = true;
}

void cm1e_sim_fsa_outputs(cm1e_sim_cm1e_t *drive)
{
    const uint16_t controlword = (uint16_t)drive->objects.controlword;
    const uint16_t rising = (uint16_t)(controlword & ~drive->fsa.last_controlword);
    if (controlword != drive->fsa.last_controlword)
        drive->fsa.settled = false;
    drive->fsa.last_controlword = controlword;
    if (drive->objects.mode != drive->fsa.next_mode)
        cm1e_sim_fsa_request_mode(drive);
    if (rising & CONTROLWORD_FAULT_RESET)
        fault_reset(drive);
    if (!drive->fsa.settled)
        apply_controlword(drive, controlword);
    if (drive->fsa.state == OPERATION_ENABLED)
        drive->fsa.generator->outputs(drive, rising);
}

/* ---- modes of operation (UG 6.2.1) ------------------------------------------------------------------------------ */

void cm1e_sim_fsa_request_mode(cm1e_sim_cm1e_t *drive)
{
    const int8_t mode = (int8_t)drive->objects.mode;
    if (mode != CM1E_MODE_NONE && !cm1e_sim_mode(mode))
        return; /* a value that is no mode changes nothing */
    drive->fsa.next_mode = mode;
    drive->fsa.mode_deadline_ns = mode == drive->objects.mode_display ? INT64_MAX : drive->now_ns + MODE_SWITCH_NS;
    set_deadline(drive);
}

static void switch_mode(cm1e_sim_cm1e_t *drive)
{
    drive->fsa.mode_deadline_ns = INT64_MAX;
    set_deadline(drive);
    drive->objects.mode_display = drive->fsa.next_mode;
    drive->fsa.generator = cm1e_sim_mode(drive->fsa.next_mode);
    drive->fsa.settled = false;
    if (drive->fsa.next_mode == CM1E_MODE_NONE) {
        if (!in_fault(drive))
            enter_state(drive, NOT_READY_TO_SWITCH_ON);
    } else if (drive->fsa.state == NOT_READY_TO_SWITCH_ON) {
        enter_state(drive, SWITCH_ON_DISABLED);
    } else if (drive->fsa.state == OPERATION_ENABLED) {
        drive->servo.torque_limit = drive->motor->peak_torque_nm;
        drive->fsa.generator->enter(drive);
    }
}

/* Homing under way is stopped first. Below V1.3.0 it was not: the routine ran on while the new mode was shown already
 * (UG 10.1, V1.3.0: "Halt bit on Homing Mode would not halt the motor when switching modes at the same time"). */
static void leave_mode(cm1e_sim_cm1e_t *drive)
{
    if (!cm1e_sim_homing_running(drive)) {
        switch_mode(drive);
        return;
    }
    if (drive->firmware->firmware < CM1E_FIRMWARE_1_3_0 && !drive->homing.halted)
        drive->objects.mode_display = drive->fsa.next_mode;
    else
        drive->homing.abandoned = true;
}

void cm1e_sim_fsa_deadline(cm1e_sim_cm1e_t *drive)
{
    if (drive->fsa.state_deadline_ns <= drive->now_ns)
        enter_state(drive, drive->fsa.state == FAULT_REACTION_ACTIVE ? FAULT : resting_state(drive));
    if (drive->fsa.mode_deadline_ns <= drive->now_ns)
        leave_mode(drive);
    cm1e_sim_fsa_update_error(drive);
}

/* ---- status ----------------------------------------------------------------------------------------------------- */

uint16_t cm1e_sim_fsa_statusword(const cm1e_sim_cm1e_t *drive)
{
    unsigned word = cm1e_fsa_table[drive->fsa.state].value | STATUSWORD_REMOTE;
    if (drive->fsa.state != SWITCH_ON_DISABLED) /* both 0 there: UG 6.1.3 */
        word |= STATUSWORD_QUICK_STOP | (drive->motor_power ? STATUSWORD_VOLTAGE_ENABLED : 0u);
    if (drive->fsa.generator && drive->fsa.generator->mode == drive->objects.mode_display)
        word |= drive->fsa.generator->status_bits(drive);
    if (drive->firmware->user_variables)
        word |= (unsigned)drive->objects.user_variable_1 & 0xC000u; /* UG 7.4.1 */
    return (uint16_t)word;
}

void cm1e_sim_fsa_reset(cm1e_sim_cm1e_t *drive)
{
    cm1e_sim_fsa_off(drive);
    drive->fsa.next_mode = CM1E_MODE_NONE;
    drive->fsa.generator = NULL;
    drive->fsa.settled = false;
    drive->fsa.was_enabled = false;
    drive->fsa.last_controlword = 0;
    drive->fsa.fault_code = 0;
    drive->objects.error_code = 0;
    drive->fsa.power_up_fault = connection_fails(drive);
    if (drive->fsa.power_up_fault && drive->firmware->fault_bit_on_7510) {
        drive->fsa.fault_code = ERROR_CONNECTION;
        drive->fsa.state = FAULT;
    }
    if (!drive->fsa.power_up_fault)
        raise_present_causes(drive);
    cm1e_sim_fsa_motor_power(drive, drive->motor_power);
}
