#include "sim/reference.h"

#include <math.h>

#define TIME_BASE_PULL 0.125    /* part of an output's delay by which the time base follows it */
#define TIME_BASE_PATIENCE 1.25 /* cycles from one target on, in which the next one should come */

void cm1e_sim_ramp(double *velocity, double wanted, double acceleration, double step_s)
{
    const double most = acceleration * step_s;
    if (wanted > *velocity + most)
        *velocity += most;
    else if (wanted < *velocity - most)
        *velocity -= most;
    else
        *velocity = wanted;
}

bool cm1e_sim_move_step(cm1e_servo_t *servo, double target, double velocity, double acceleration, double step_s)
{
    const double distance = target - servo->reference;
    const double most = acceleration * step_s; /* change of velocity in one step */
    if (fabs(distance) <= most * step_s && fabs(servo->reference_velocity) <= most) {
        servo->reference = target;
        servo->reference_velocity = 0;
        return true;
    }
    /* The velocity from which steps of `most` end at the target, from v^2 / 2a + v step / 2 = distance. The last step
     * is cut to the remaining distance, if it is nearly equal. */
    const double stopping = sqrt(most * most / 4 + 2 * acceleration * fabs(distance)) - most / 2;
    const double fastest = fmin(stopping, velocity), last = distance / step_s;
    cm1e_sim_ramp(&servo->reference_velocity, distance < 0 ? -fastest : fastest, acceleration, step_s);
    if (fabs(servo->reference_velocity) > fabs(last) && fabs(servo->reference_velocity - last) <= most)
        servo->reference_velocity = last;
    servo->reference += servo->reference_velocity * step_s;
    return false;
}

double cm1e_sim_stopping_place(const cm1e_servo_t *servo, double acceleration)
{
    const double velocity = servo->reference_velocity;
    return servo->reference + velocity * fabs(velocity) / (2 * acceleration);
}

void cm1e_sim_halt_step(cm1e_servo_t *servo, double acceleration, double step_s)
{
    cm1e_sim_ramp(&servo->reference_velocity, 0, acceleration, step_s);
    servo->reference += servo->reference_velocity * step_s;
}

void cm1e_sim_line_begin(cm1e_sim_line_t *line, cm1e_servo_t *servo, double goal)
{
    *line = (cm1e_sim_line_t){.goal = goal};
    servo->own_profile = false;
    servo->reference = goal;
    servo->reference_velocity = 0;
}

/* A straight line from the last target to the new one, on a time base of the drive's own that follows the outputs
 * slowly: without SYNC0 they come a little early or late, and the motor should not feel it. */
void cm1e_sim_line_target(cm1e_sim_line_t *line, double goal, double cycle_s)
{
    const double late_s = line->slot_s - cycle_s;
    line->slot_s = fabs(late_s) < cycle_s / 2 ? late_s * (1 - TIME_BASE_PULL) : 0;
    line->velocity = (goal - line->goal) / cycle_s;
    line->goal = goal;
}

/* If the next target is late, the line continues for a while; then the motor stops at the last target. */
void cm1e_sim_line_step(cm1e_sim_line_t *line, cm1e_servo_t *servo, double cycle_s, double step_s)
{
    line->slot_s += step_s;
    if (line->slot_s > TIME_BASE_PATIENCE * cycle_s)
        line->velocity = 0;
    servo->reference = line->goal - line->velocity * (cycle_s - line->slot_s);
    servo->reference_velocity = line->velocity;
}
