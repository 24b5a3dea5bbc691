#include <math.h>

#include "sim/bridge_app.h"
#include "sim/cia402_app.h"
#include "sim/cm1e_app.h"
#include "sim/esc_chip.h"

static cm1e_sim_cm1e_t *drive_at(cm1e_sim_segment_t *segment, uint32_t position)
{
    return segment ? cm1e_sim_cm1e_of(cm1e_sim_segment_slave(segment, position)) : NULL;
}

static cm1e_sim_bridge_axis_t *motor_at(cm1e_sim_segment_t *segment, uint32_t position, unsigned channel)
{
    cm1e_sim_bridge_t *bridge = segment ? cm1e_sim_bridge_of(cm1e_sim_segment_slave(segment, position)) : NULL;
    return bridge && channel >= 1 && channel <= CM1E_BRIDGE_AXES ? &bridge->axes[channel - 1] : NULL;
}

static void probe_drive(cm1e_sim_cm1e_t *drive, cm1e_sim_probe_t *probe)
{
    cm1e_sim_refresh(drive);
    *probe = (cm1e_sim_probe_t){
        .position_counts = drive->mechanics.position,
        .velocity_counts_per_s = drive->mechanics.velocity,
        .torque_nm = drive->servo.torque,
        .torque_on = drive->fsa.state == OPERATION_ENABLED,
        .statusword = (uint16_t)drive->objects.statusword,
        .controlword = (uint16_t)drive->objects.controlword,
        .error_code = (uint16_t)drive->objects.error_code,
        .mode = (int8_t)drive->objects.mode_display,
        .digital_inputs = cm1e_sim_digital_inputs(drive),
        .digital_outputs = (uint16_t)drive->objects.digital_outputs,
        .peak_velocity_counts_per_s = drive->mechanics.peak_velocity,
        .travel_counts = drive->mechanics.travel,
    };
}

static void probe_motor(const cm1e_sim_bridge_axis_t *axis, cm1e_sim_probe_t *probe)
{
    *probe = (cm1e_sim_probe_t){
        .position_counts = axis->mechanics.position * axis->scale,
        .velocity_counts_per_s = axis->mechanics.velocity * axis->scale,
        .torque_nm = axis->motor_free ? 0 : axis->servo.torque,
        .torque_on = !axis->motor_free,
        .statusword = cm1e_sim_bridge_statusword(axis),
        .controlword = axis->controlword,
        .error_code = axis->error,
        .mode = axis->mode,
        .digital_inputs = cm1e_sim_bridge_inputs_of(axis),
        .digital_outputs = axis->outputs,
        .peak_velocity_counts_per_s = axis->mechanics.peak_velocity * axis->scale,
        .travel_counts = axis->mechanics.travel * axis->scale,
        .broken_rules = axis->broken_rules,
    };
}

static void probe_other(cm1e_sim_cia402_t *drive, cm1e_sim_probe_t *probe)
{
    cm1e_sim_cia402_refresh(drive);
    *probe = (cm1e_sim_probe_t){
        .position_counts = drive->mechanics.position * drive->scale,
        .velocity_counts_per_s = drive->mechanics.velocity * drive->scale,
        .torque_nm = drive->servo.torque,
        .torque_on = drive->state == OPERATION_ENABLED || drive->state == QUICK_STOP_ACTIVE,
        .statusword = (uint16_t)*drive->v.statusword,
        .controlword = (uint16_t)*drive->v.controlword,
        .error_code = (uint16_t)*drive->v.error_code,
        .mode = (int8_t)*drive->v.mode_display,
        .digital_inputs = (uint16_t)cm1e_sim_cia402_inputs(drive),
        .digital_outputs = (uint16_t)(*drive->v.outputs >> CM1E_CIA402_OUTPUT_SHIFT),
        .peak_velocity_counts_per_s = drive->mechanics.peak_velocity * drive->scale,
        .travel_counts = drive->mechanics.travel * drive->scale,
    };
}

void cm1e_sim_probe_channel(cm1e_sim_segment_t *segment, uint32_t position, unsigned channel, cm1e_sim_probe_t *probe)
{
    cm1e_sim_cm1e_t *drive = channel == 0 ? drive_at(segment, position) : NULL;
    const cm1e_sim_bridge_axis_t *motor = motor_at(segment, position, channel);
    if (!probe)
        return;
    *probe = (cm1e_sim_probe_t){0};
    if (drive)
        probe_drive(drive, probe);
    else if (channel == 0 && segment && cm1e_sim_cia402_of(cm1e_sim_segment_slave(segment, position)))
        probe_other(cm1e_sim_cia402_of(cm1e_sim_segment_slave(segment, position)), probe);
    else if (motor)
        probe_motor(motor, probe);
}

void cm1e_sim_probe_reset_channel(cm1e_sim_segment_t *segment, uint32_t position, unsigned channel)
{
    cm1e_sim_cm1e_t *drive = channel == 0 ? drive_at(segment, position) : NULL;
    cm1e_sim_bridge_axis_t *motor = motor_at(segment, position, channel);
    cm1e_mechanics_t *mechanics = drive ? &drive->mechanics : motor ? &motor->mechanics : NULL;
    if (!mechanics)
        return;
    if (motor)
        motor->broken_rules = 0;
    mechanics->peak_velocity = fabs(mechanics->velocity);
    mechanics->travel = 0;
}

void cm1e_sim_probe(cm1e_sim_segment_t *segment, uint32_t position, cm1e_sim_probe_t *probe)
{
    cm1e_sim_probe_channel(segment, position, 0, probe);
}

void cm1e_sim_probe_reset(cm1e_sim_segment_t *segment, uint32_t position)
{
    cm1e_sim_probe_reset_channel(segment, position, 0);
}

void cm1e_sim_segment_clock(cm1e_sim_segment_t *segment, uint32_t position, cm1e_sim_clock_t *result)
{
    const cm1e_sim_slave_t *slave = segment ? cm1e_sim_segment_slave(segment, position) : NULL;
    if (!result)
        return;
    *result = (cm1e_sim_clock_t){0};
    if (slave && cm1e_sim_esc_present(slave))
        cm1e_sim_esc_clock(slave, result);
}
