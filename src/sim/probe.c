#include <math.h>

#include "sim/cm1e_app.h"

static cm1e_sim_cm1e_t *drive_at(cm1e_sim_segment_t *segment, uint32_t position)
{
    return segment ? cm1e_sim_cm1e_of(cm1e_sim_segment_slave(segment, position)) : NULL;
}

void cm1e_sim_probe(cm1e_sim_segment_t *segment, uint32_t position, cm1e_sim_probe_t *probe)
{
    if (!probe)
        return;
    *probe = (cm1e_sim_probe_t){0};
    cm1e_sim_cm1e_t *drive = drive_at(segment, position);
    if (!drive)
        return;
    cm1e_sim_refresh(drive);
    *probe = (cm1e_sim_probe_t){
        .position_counts = drive->mechanics.position,
        .velocity_counts_per_s = drive->mechanics.velocity,
        .torque_nm = drive->servo.torque,
        .torque_on = drive->state == OPERATION_ENABLED,
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

void cm1e_sim_probe_reset(cm1e_sim_segment_t *segment, uint32_t position)
{
    cm1e_sim_cm1e_t *drive = drive_at(segment, position);
    if (!drive)
        return;
    drive->mechanics.peak_velocity = fabs(drive->mechanics.velocity);
    drive->mechanics.travel = 0;
}
