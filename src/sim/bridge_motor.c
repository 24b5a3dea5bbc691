/* The motor: where it is, its torque, and how it follows targets. */
#include <math.h>

#include "sim/bridge_app.h"

/* Not in the guide: of the size usual for such motors. */
#define STANDSTILL_COUNTS_PER_S 100.0
#define STANDSTILL_PULSES_PER_S 10.0 /* for motors with few pulses in a revolution */
/* A step larger than any motor makes in a cycle, with a margin for late cycles. */
#define STEP_IN_CYCLE_COUNTS 2750.0
#define STEP_AT_START_COUNTS 100.0

double cm1e_sim_bridge_peak_torque(void) { return cm1e_device_motor("")->peak_torque_nm; }

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
    axis->servo.torque_limit = percent > 0 ? peak / CM1E_SIM_BRIDGE_PEAK_TO_RATED * percent / 100 : peak;
}

int64_t cm1e_sim_bridge_shown_position(const cm1e_sim_bridge_axis_t *axis)
{
    return axis->unplugged ? axis->known_position : cm1e_sim_bridge_position(axis);
}

void cm1e_sim_bridge_axis_hold(cm1e_sim_bridge_axis_t *axis) { axis->servo.reference_velocity = 0; }

void cm1e_sim_bridge_axis_power(cm1e_sim_bridge_axis_t *axis, bool on)
{
    if (on == !axis->motor_free || axis->unplugged) /* it does not hear */
        return;
    axis->motor_free = !on;
    cm1e_sim_bridge_axis_torque(axis, 0);
    cm1e_servo_catch(&axis->servo, &axis->mechanics);
    cm1e_sim_bridge_axis_hold(axis);
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

bool cm1e_sim_bridge_follows_targets(const cm1e_sim_bridge_axis_t *axis)
{
    return (axis->mode == CM1E_BRIDGE_MODE_CSP && !axis->abnormal) || axis->mode == CM1E_BRIDGE_MODE_CPIO;
}

void cm1e_sim_bridge_axis_plug(cm1e_sim_bridge_axis_t *axis, bool plugged)
{
    axis->known_position = cm1e_sim_bridge_shown_position(axis);
    axis->unplugged = !plugged;
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

/* The target is taken as it is: one that is not the actual position makes the motor jump. */
void cm1e_sim_bridge_axis_begin_csp(cm1e_sim_bridge_axis_t *axis)
{
    if (!cm1e_sim_bridge_follows_targets(axis)) {
        axis->broken_rules |= axis->abnormal && axis->mode == CM1E_BRIDGE_MODE_CSP ? CM1E_SIM_MODE_NO_WAY : 0u;
        return;
    }
    const double goal = target(axis);
    /* A motor that does not hear begins nothing, and nobody knows where it is. */
    if (!axis->unplugged && fabs(goal - axis->mechanics.position) > STEP_AT_START_COUNTS)
        axis->broken_rules |= CM1E_SIM_STEP_AT_START;
    cm1e_sim_line_begin(&axis->line, &axis->servo, goal);
}

void cm1e_sim_bridge_axis_follow(cm1e_sim_bridge_axis_t *axis)
{
    const double goal = target(axis);
    if (fabs(goal - axis->line.goal) > STEP_IN_CYCLE_COUNTS)
        axis->broken_rules |= CM1E_SIM_STEP_IN_CYCLE;
    cm1e_sim_line_target(&axis->line, goal, CM1E_SIM_BRIDGE_CYCLE_S);
}
