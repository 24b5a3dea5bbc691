#include <math.h>

#include "sim/bridge_app.h"

/* Not in the guide: of the size usual for such motors, and those of the simulated CM1-E. */
#define LAG_LIMIT_COUNTS 50000.0 /* a revolution */
#define LAG_TIME_S 0.005
#define FOLLOWING_WINDOW_COUNTS 1000.0
#define OVERLOAD_LIMIT_S 0.5     /* i2t */
enum { SILENCE_MS = 10 };        /* without a good answer: an error of the serial line */
enum { SETTING_NS = 100000000 }; /* until a setting of homing is done (BR appendix 4.1) */
enum { K_RESOLUTION = 37, K_ENABLE_AT_POWER_ON = 68 };

/* ---- time ------------------------------------------------------------------------------------------------------- */

static void supervise(cm1e_sim_bridge_axis_t *axis, double step_s)
{
    const double lag = fabs(axis->servo.reference - axis->mechanics.position);
    const double load = axis->servo.torque * CM1E_SIM_BRIDGE_PEAK_TO_RATED / cm1e_sim_bridge_peak_torque();
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
        cm1e_sim_bridge_axis_hold(axis);
    else if (axis->state == OPERATION_ENABLED && cm1e_sim_bridge_follows_targets(axis))
        cm1e_sim_line_step(&axis->line, &axis->servo, CM1E_SIM_BRIDGE_CYCLE_S, step_s);
    cm1e_mechanics_step(&axis->mechanics, cm1e_servo_step(&axis->servo, &axis->mechanics, step_s), step_s);
    supervise(axis, step_s);
}

/* Counts a broken answer; several in a row are an error of the line. A motor that is not heard loses nothing: it stands
 * where it is. */
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

/* ---- process data ----------------------------------------------------------------------------------------------- */

/* csp and hm (BR 6.1.2). */
static void drive_profile_outputs(cm1e_sim_bridge_t *bridge, cm1e_sim_bridge_axis_t *axis)
{
    const unsigned rising = axis->controlword & ~(unsigned)axis->last_controlword;
    if (axis->state == FAULT && (rising & CONTROLWORD_FAULT_RESET))
        cm1e_sim_bridge_axis_reset_fault(axis);
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
    else if (axis->mode != CM1E_BRIDGE_MODE_CML) /* in CML the controlword has no meaning */
        drive_profile_outputs(bridge, axis);
    if (axis->state == OPERATION_ENABLED && cm1e_sim_bridge_follows_targets(axis))
        cm1e_sim_bridge_axis_follow(axis);
    axis->last_controlword = axis->controlword;
}

/* BR 6.1.3 and 6.4.2: bits 10, 12 and 13. */
static unsigned mode_bits(const cm1e_sim_bridge_axis_t *axis)
{
    const double lag = fabs(axis->servo.reference - axis->mechanics.position);
    if (axis->mode == CM1E_BRIDGE_MODE_HM)
        return (cm1e_sim_search_running(&axis->search) ? 0u : STATUSWORD_TARGET_REACHED) |
               (axis->search.phase == SEARCH_DONE ? STATUSWORD_HOMING_ATTAINED : 0u) |
               (axis->error || axis->search_failed ? STATUSWORD_HOMING_ERROR : 0u);
    const bool follows = axis->state == OPERATION_ENABLED && cm1e_sim_bridge_follows_targets(axis) &&
                         lag <= FOLLOWING_WINDOW_COUNTS;
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
    cm1e_sim_bridge_axis_release(axis, NOT_READY_TO_SWITCH_ON);
    if (axis->motor == CM1E_BRIDGE_CM1 || *cm1e_sim_bridge_k(bridge, axis->number, K_ENABLE_AT_POWER_ON) == 1)
        cm1e_sim_bridge_axis_power(axis, true);
}
