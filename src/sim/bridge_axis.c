#include <math.h>

#include "sim/bridge_app.h"

#define CYCLE_S 1e-3 /* BR 6.3 */
/* Not in the guide: of the size usual for such motors, and those of the simulated CM1-E. */
#define LAG_LIMIT_COUNTS 50000.0 /* a revolution */
#define LAG_TIME_S 0.005
#define FOLLOWING_WINDOW_COUNTS 1000.0
#define OVERLOAD_LIMIT_S 0.5     /* i2t */
#define PEAK_TO_RATED_TORQUE 1.25
#define STANDSTILL_COUNTS_PER_S 100.0
#define STANDSTILL_PULSES_PER_S 10.0 /* where one of them is a long way: nobody outside could tell */
enum { SILENCE_MS = 10 };        /* without a good answer: an error of the serial line */
enum { SETTING_NS = 100000000 }; /* until a setting of homing is done (BR appendix 4.1) */
enum { K_RESOLUTION = 37, K_ENABLE_AT_POWER_ON = 68 };

double cm1e_sim_bridge_peak_torque(void) { return cm1e_device_motor("")->peak_torque_nm; }

/* ---- the motor -------------------------------------------------------------------------------------------------- */

int64_t cm1e_sim_bridge_position(const cm1e_sim_bridge_axis_t *axis)
{
    return (int64_t)floor((axis->mechanics.position - (double)axis->zero) * axis->scale + 0.5);
}

void cm1e_sim_bridge_axis_zero(cm1e_sim_bridge_axis_t *axis)
{
    axis->zero = (int64_t)floor(axis->mechanics.position + 0.5);
}

void cm1e_sim_bridge_axis_torque(cm1e_sim_bridge_axis_t *axis, double percent)
{
    const double peak = cm1e_sim_bridge_peak_torque();
    axis->servo.torque_limit = percent > 0 ? peak / PEAK_TO_RATED_TORQUE * percent / 100 : peak;
}

int64_t cm1e_sim_bridge_shown_position(const cm1e_sim_bridge_axis_t *axis)
{
    return axis->unplugged ? axis->known_position : cm1e_sim_bridge_position(axis);
}

static void hold(cm1e_sim_bridge_axis_t *axis) { axis->servo.reference_velocity = 0; }

void cm1e_sim_bridge_axis_power(cm1e_sim_bridge_axis_t *axis, bool on)
{
    if (on == !axis->motor_free || axis->unplugged) /* it does not hear */
        return;
    axis->motor_free = !on;
    cm1e_sim_bridge_axis_torque(axis, 0);
    cm1e_servo_catch(&axis->servo, &axis->mechanics);
    hold(axis);
}

uint8_t cm1e_sim_bridge_inputs_of(const cm1e_sim_bridge_axis_t *axis)
{
    const uint8_t inputs = cm1e_sim_sensors_inputs(&axis->sensors, axis->mechanics.position);
    return inputs & cm1e_bridge_input_mask(axis->motor);
}

/* 0x607A on the scale of the mechanics, within what the resolution allows (BR appendix 5). It has 32 bits and wraps:
 * the nearest turn of the wheel is meant. */
static double target(const cm1e_sim_bridge_axis_t *axis)
{
    int32_t wanted = axis->target_position;
    if (wanted > axis->limit)
        wanted = axis->limit;
    else if (wanted < -axis->limit)
        wanted = -axis->limit;
    const int64_t actual = cm1e_sim_bridge_position(axis);
    return (double)axis->zero + (double)(actual + (int32_t)((uint32_t)wanted - (uint32_t)actual)) / axis->scale;
}

/* Further than any motor goes in a cycle, with a little for cycles that come late. */
#define STEP_IN_CYCLE_COUNTS 2750.0
#define STEP_AT_START_COUNTS 100.0

static bool follows_targets(const cm1e_sim_bridge_axis_t *axis)
{
    return (axis->mode == CM1E_BRIDGE_MODE_CSP && !axis->abnormal) || axis->mode == CM1E_BRIDGE_MODE_CPIO;
}

static void supervise(cm1e_sim_bridge_axis_t *axis, double step_s)
{
    const double lag = fabs(axis->servo.reference - axis->mechanics.position);
    const double load = axis->servo.torque * PEAK_TO_RATED_TORQUE / cm1e_sim_bridge_peak_torque();
    axis->lag_s = lag > LAG_LIMIT_COUNTS ? axis->lag_s + step_s : 0;
    axis->overload = fmax(0, axis->overload + step_s * (load * load - 1));
    if (axis->lag_s > LAG_TIME_S)
        cm1e_sim_bridge_axis_error(axis, BRIDGE_STATUS_POSITION_OVERFLOW);
    else if (axis->overload > OVERLOAD_LIMIT_S)
        cm1e_sim_bridge_axis_error(axis, BRIDGE_STATUS_OVERLOAD);
}

void cm1e_sim_bridge_axis_step(cm1e_sim_bridge_axis_t *axis, double step_s)
{
    if (axis->motor_free) {
        if (!cm1e_mechanics_at_rest(&axis->mechanics))
            cm1e_mechanics_step(&axis->mechanics, 0, step_s);
        return;
    }
    if (cm1e_sim_search_running(&axis->search))
        cm1e_sim_bridge_search_step(axis, step_s);
    else if (axis->unplugged)
        hold(axis);
    else if (axis->state == OPERATION_ENABLED && follows_targets(axis))
        cm1e_sim_line_step(&axis->line, &axis->servo, CYCLE_S, step_s);
    cm1e_mechanics_step(&axis->mechanics, cm1e_servo_step(&axis->servo, &axis->mechanics, step_s), step_s);
    supervise(axis, step_s);
}

void cm1e_sim_bridge_axis_plug(cm1e_sim_bridge_axis_t *axis, bool plugged)
{
    axis->known_position = cm1e_sim_bridge_shown_position(axis);
    axis->unplugged = !plugged;
}

/* One broken answer is counted, some in a row are an error of the line. Of a motor that nothing is heard of nothing is
 * lost: it stands where it is. */
void cm1e_sim_bridge_axis_exchange(cm1e_sim_bridge_axis_t *axis)
{
    const bool heard = !axis->unplugged && axis->broken_answers == 0;
    if (axis->state == FAULT_REACTION_ACTIVE)
        axis->state = FAULT; /* 14 */
    axis->sent++;
    axis->received += heard;
    axis->broken_answers -= axis->broken_answers > 0;
    axis->silent_ms = heard ? 0 : axis->silent_ms + 1;
    if (axis->silent_ms >= SILENCE_MS && axis->error != BRIDGE_STATUS_SERIAL_ERROR)
        cm1e_sim_bridge_axis_error(axis, BRIDGE_STATUS_SERIAL_ERROR);
}

bool cm1e_sim_bridge_axis_stands(const cm1e_sim_bridge_axis_t *axis)
{
    const double least = fmax(STANDSTILL_COUNTS_PER_S, STANDSTILL_PULSES_PER_S / axis->scale);
    return fabs(axis->mechanics.velocity) < least && axis->servo.reference_velocity == 0;
}

uint8_t cm1e_sim_bridge_motor_status(const cm1e_sim_bridge_axis_t *axis)
{
    if (axis->error)
        return axis->error;
    if (axis->motor_free)
        return BRIDGE_STATUS_MOTOR_FREE;
    return cm1e_sim_bridge_axis_stands(axis) ? BRIDGE_STATUS_IN_POSITION : BRIDGE_STATUS_RUNNING;
}

/* ---- power drive system (BR 6.1) -------------------------------------------------------------------------------- */

/* State A is reached: "when transiting to state A from state B or C, Cool Muscle will be motor free automatically". */
static void release(cm1e_sim_bridge_axis_t *axis, cm1e_fsa_state_t state)
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
    hold(axis);
}

/* The target is taken as it is: one that is not the actual position makes the motor jump. */
void cm1e_sim_bridge_axis_begin_csp(cm1e_sim_bridge_axis_t *axis)
{
    if (!follows_targets(axis)) {
        axis->broken_rules |= axis->abnormal && axis->mode == CM1E_BRIDGE_MODE_CSP ? CM1E_SIM_MODE_NO_WAY : 0u;
        return;
    }
    const double goal = target(axis);
    if (fabs(goal - axis->mechanics.position) > STEP_AT_START_COUNTS)
        axis->broken_rules |= CM1E_SIM_STEP_AT_START;
    cm1e_sim_line_begin(&axis->line, &axis->servo, goal);
}

static void follow(cm1e_sim_bridge_axis_t *axis)
{
    const double goal = target(axis);
    if (fabs(goal - axis->line.goal) > STEP_IN_CYCLE_COUNTS)
        axis->broken_rules |= CM1E_SIM_STEP_IN_CYCLE;
    cm1e_sim_line_target(&axis->line, goal, CYCLE_S);
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
        release(axis, SWITCH_ON_DISABLED);
    cm1e_sim_bridge_search_abort(axis);
    axis->last_controlword = axis->controlword = 0;
    axis->same_words = UINT16_MAX; /* none goes over the serial line any more */
}

void cm1e_sim_bridge_axis_ready(cm1e_sim_bridge_axis_t *axis)
{
    if (axis->state == NOT_READY_TO_SWITCH_ON)
        axis->state = axis->error ? FAULT : SWITCH_ON_DISABLED;
}

/* What a controlword asks for (BR 6.1.2). Quick stop is no command here: it is ignored. */
static cm1e_fsa_command_t command_of(unsigned controlword)
{
    if (!(controlword & CONTROLWORD_ENABLE_VOLTAGE))
        return COMMAND_DISABLE_VOLTAGE;
    if (!(controlword & CONTROLWORD_QUICK_STOP))
        return COMMAND_QUICK_STOP;
    if (!(controlword & CONTROLWORD_SWITCH_ON))
        return COMMAND_SHUTDOWN;
    return controlword & CONTROLWORD_ENABLE_OPERATION ? COMMAND_ENABLE_OPERATION : COMMAND_SWITCH_ON;
}

/* One transition each cycle; the numbers are those of BR 6.1.1. */
void cm1e_sim_bridge_axis_obey(cm1e_sim_bridge_axis_t *axis, unsigned controlword)
{
    const cm1e_fsa_command_t command = command_of(controlword);
    const bool wants_power = command == COMMAND_SWITCH_ON || command == COMMAND_ENABLE_OPERATION;
    if (command == COMMAND_QUICK_STOP)
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
            release(axis, SWITCH_ON_DISABLED); /* 7 */
        break;
    case SWITCHED_ON:
    case OPERATION_ENABLED:
        if (command == COMMAND_ENABLE_OPERATION && axis->state == SWITCHED_ON)
            enable_operation(axis); /* 4 */
        else if (command == COMMAND_SWITCH_ON)
            switch_on(axis); /* 5 */
        else if (command == COMMAND_SHUTDOWN)
            release(axis, READY_TO_SWITCH_ON); /* 6, 8 */
        else if (command == COMMAND_DISABLE_VOLTAGE)
            release(axis, SWITCH_ON_DISABLED); /* 9, 10 */
        break;
    default:
        break;
    }
}

static void reset_fault(cm1e_sim_bridge_axis_t *axis)
{
    axis->error = 0;
    axis->silent_ms = 0;
    release(axis, SWITCH_ON_DISABLED); /* 15 */
}

/* csp and hm (BR 6.1.2). */
static void drive_profile_outputs(cm1e_sim_bridge_t *bridge, cm1e_sim_bridge_axis_t *axis)
{
    const unsigned rising = axis->controlword & ~(unsigned)axis->last_controlword;
    if (axis->state == FAULT && (rising & CONTROLWORD_FAULT_RESET))
        reset_fault(axis);
    else if (!(axis->controlword & CONTROLWORD_FAULT_RESET))
        cm1e_sim_bridge_axis_obey(axis, axis->controlword);
    const bool may_search = axis->mode == CM1E_BRIDGE_MODE_HM && axis->state == OPERATION_ENABLED;
    if (may_search && (rising & CONTROLWORD_HOMING_START) && !cm1e_sim_search_running(&axis->search)) {
        if (bridge->now_ns < axis->settings_ns + SETTING_NS)
            axis->broken_rules |= CM1E_SIM_HOMING_TOO_SOON;
        cm1e_sim_bridge_search_begin(bridge, axis);
    }
    if (may_search && !(axis->controlword & CONTROLWORD_HOMING_START))
        cm1e_sim_bridge_search_abort(axis);
}

void cm1e_sim_bridge_axis_outputs(cm1e_sim_bridge_t *bridge, cm1e_sim_bridge_axis_t *axis)
{
    axis->same_words = axis->controlword == axis->last_controlword ? axis->same_words + 1 : 1;
    if (axis->mode == CM1E_BRIDGE_MODE_CMD)
        cm1e_sim_bridge_command_outputs(bridge, axis);
    else if (axis->mode == CM1E_BRIDGE_MODE_CPIO)
        cm1e_sim_bridge_cpio_outputs(axis);
    else if (axis->mode != CM1E_BRIDGE_MODE_CML) /* there the controlword says nothing */
        drive_profile_outputs(bridge, axis);
    if (axis->state == OPERATION_ENABLED && follows_targets(axis))
        follow(axis);
    axis->last_controlword = axis->controlword;
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

/* BR 6.1.3 and 6.4.2: bits 10, 12 and 13. */
static unsigned mode_bits(const cm1e_sim_bridge_axis_t *axis)
{
    const double lag = fabs(axis->servo.reference - axis->mechanics.position);
    if (axis->mode == CM1E_BRIDGE_MODE_HM)
        return (cm1e_sim_search_running(&axis->search) ? 0u : STATUSWORD_TARGET_REACHED) |
               (axis->search.phase == SEARCH_DONE ? STATUSWORD_HOMING_ATTAINED : 0u) |
               (axis->error || axis->search_failed ? STATUSWORD_HOMING_ERROR : 0u);
    const bool follows = axis->state == OPERATION_ENABLED && follows_targets(axis) && lag <= FOLLOWING_WINDOW_COUNTS;
    return follows ? STATUSWORD_BIT12 : 0u;
}

uint16_t cm1e_sim_bridge_statusword(const cm1e_sim_bridge_axis_t *axis)
{
    if (axis->mode == CM1E_BRIDGE_MODE_CMD)
        return cm1e_sim_bridge_command_status(axis);
    if (axis->mode == CM1E_BRIDGE_MODE_CPIO)
        return cm1e_sim_bridge_cpio_status(axis);
    const unsigned error = axis->error ? CM1E_BRIDGE_STATUSWORD_ERROR : 0;
    const unsigned no_torque = axis->motor_free ? CM1E_BRIDGE_STATUSWORD_FREE : 0;
    return (uint16_t)(cm1e_sim_bridge_state_bits(axis) | STATUSWORD_REMOTE | mode_bits(axis) | error | no_torque);
}

/* ---- life ------------------------------------------------------------------------------------------------------- */

/* A revolution has as many pulses as K37 says. */
static void take_resolution(const cm1e_sim_bridge_t *bridge, cm1e_sim_bridge_axis_t *axis)
{
    const int32_t k37 = (int32_t)*cm1e_sim_bridge_k(bridge, axis->number, K_RESOLUTION);
    axis->scale = cm1e_bridge_counts_per_revolution(k37) / (double)CM1E_COUNTS_PER_REVOLUTION;
    axis->limit = cm1e_bridge_position_limit(axis->motor, k37);
}

void cm1e_sim_bridge_axis_create(cm1e_sim_bridge_t *bridge, unsigned number, const cm1e_axis_config_t *config)
{
    cm1e_sim_bridge_axis_t *axis = &bridge->axes[number];
    cm1e_sim_axis_config_t load = config->sim;
    axis->number = (uint8_t)number;
    axis->motor = cm1e_bridge_motor(bridge->model, number);
    if (config->k37_stated && cm1e_bridge_position_limit(axis->motor, config->k37) > 0)
        *cm1e_sim_bridge_k(bridge, number, K_RESOLUTION) = config->k37;
    take_resolution(bridge, axis);
    load.stop_positive /= axis->scale;
    load.stop_negative /= axis->scale;
    load.sensor_input2 /= axis->scale;
    load.sensor_input3 /= axis->scale;
    cm1e_sim_sensors_init(&axis->sensors, &load);
    cm1e_mechanics_init(&axis->mechanics, &load, cm1e_sim_bridge_peak_torque() * CM1E_ROTOR_INERTIA_PER_PEAK_TORQUE);
    cm1e_servo_init(&axis->servo, &axis->mechanics);
}

/* "When transiting to the state A after power is supplied, CM1 will be motor enable and CM2 is settable" (BR 6.1.1). */
void cm1e_sim_bridge_axis_power_on(cm1e_sim_bridge_t *bridge, cm1e_sim_bridge_axis_t *axis)
{
    take_resolution(bridge, axis); /* a new K37 counts from now on */
    cm1e_sim_bridge_axis_zero(axis);
    axis->error = 0;
    axis->silent_ms = 0;
    axis->sent = axis->received = 0;
    axis->controlword = axis->last_controlword = 0;
    axis->target_position = 0;
    axis->overload = axis->lag_s = 0;
    axis->outputs = 0;
    axis->armed = false;
    axis->answer = 0;
    axis->same_words = UINT16_MAX; /* none has come yet */
    axis->cml = (cm1e_sim_cml_t){0};
    cm1e_sim_bridge_search_reset(axis);
    axis->settings_ns = INT64_MIN / 2;
    cm1e_sim_bridge_mode_reset(axis);
    release(axis, NOT_READY_TO_SWITCH_ON);
    if (axis->motor == CM1E_BRIDGE_CM1 || *cm1e_sim_bridge_k(bridge, axis->number, K_ENABLE_AT_POWER_ON) == 1)
        cm1e_sim_bridge_axis_power(axis, true);
}
