/* The motor of the drive as the other parts see it: its place, whether it is at standstill, what its sensors show. */
#include "sim/cm1e_app.h"

#define STANDSTILL_TIME_S 0.005

bool cm1e_sim_stands(const cm1e_sim_cm1e_t *drive)
{
    const bool moved = drive->fsa.state == OPERATION_ENABLED && drive->servo.reference_velocity != 0;
    return !moved && drive->watch.still_s >= STANDSTILL_TIME_S;
}

int64_t cm1e_sim_actual_counts(const cm1e_sim_cm1e_t *drive)
{
    return cm1e_sim_rounded(drive->mechanics.position) - drive->zero;
}

uint16_t cm1e_sim_digital_inputs(const cm1e_sim_cm1e_t *drive)
{
    return cm1e_sim_sensors_inputs(&drive->sensors, drive->mechanics.position);
}
