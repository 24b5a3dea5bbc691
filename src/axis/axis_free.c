/* The source of set-points of an axis without torque: its set-point is the actual position. */
#include "axis/axis_lead.h"
#include "axis/axis_position.h"
#include "axis/axis_power.h"
#include "axis/axis_setpoint.h"

void cm1e_axis_lead_end(cm1e_axis_t *axis, cm1e_error_t error)
{
    if (!axis_led(axis))
        return;
    const cm1e_axis_leader_t *leader = axis->leader;
    axis->leader = NULL;
    leader->lost(leader->context, leader->index, error);
}

static bool step_free(cm1e_axis_t *axis)
{
    cm1e_axis_set_to_actual(axis);
    return true;
}

static void stop_nothing(cm1e_axis_t *axis, const cm1e_motion_limits_t *ramp, home_goal_t goal)
{
    (void)axis;
    (void)ramp;
    (void)goal;
}

const source_t cm1e_source_free = {.step = step_free, .stop = stop_nothing, .is_free = true};

void cm1e_axis_become_free(cm1e_axis_t *axis)
{
    cm1e_axis_lead_end(axis, CM1E_ERROR_AXIS_ERROR_STOP);
    cm1e_axis_set_source(axis, &cm1e_source_free);
    axis->power.energized = false;
    cm1e_axis_power_unsettle(axis);
    axis->homing_step.pushing = axis->homing_step.after_stop = false;
    axis->power.free_ns = axis->power.brake_until_ns = axis->now_ns;
    cm1e_axis_set_to_actual(axis);
}

void cm1e_axis_let_go(cm1e_axis_t *axis)
{
    cm1e_axis_become_free(axis);
    axis->power.letting_go = true;
}
