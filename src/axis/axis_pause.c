/*
 * A pause: frames were not lost but never sent, because the work of a cycle or a wake-up took whole cycles too long. In
 * CSP the motor stands at its last target by then, in CSV it has gone on with its last velocity. A profile that simply
 * went on would ask it for a step of velocity; so what moves begins anew from there: from rest, or from where the motor
 * must be by now. Stops and ramps of errors end where they stand.
 */
#include "axis/axis_coupling.h"

static cm1e_error_t stop_anew(cm1e_axis_t *axis)
{
    const from_t from = from_set(axis);
    cm1e_motion_limits_t limits = axis->state == CM1E_AXIS_ERROR_STOP ? axis->emergency : axis->maximum;
    cm1e_profile_t profile;
    cm1e_error_t error = axis->active ? cm1e_axis_limits_of(axis, &from, &axis->move, &limits) : CM1E_OK;
    if (!error)
        error = cm1e_axis_plan_stop(axis, &from, &limits, &profile);
    if (!error)
        cm1e_axis_run(axis, &from, &profile, cm1e_position_plus(from.position, profile.end.position * axis->scale),
                      0.0);
    return error;
}

/* A step of a homing goes on as it was about to: to the velocity of its search, or to the end of MC_FinishHoming. */
static cm1e_error_t step_anew(cm1e_axis_t *axis)
{
    const cm1e_motion_state_t now = {0.0, axis->set_velocity, axis->set_acceleration};
    const double way = cm1e_position_minus(axis->target, axis->set) / axis->scale, end = axis->profile.end.velocity;
    const from_t from = from_set(axis);
    cm1e_profile_t profile;
    const bool planned = axis->stepping.finishing
                             ? cm1e_profile_to_position(&profile, &now, way, &axis->stepping.limits) == CM1E_OK
                             : cm1e_profile_to_velocity(&profile, &now, end, &axis->stepping.limits) == CM1E_OK;
    if (!planned)
        return CM1E_ERROR_AXIS_POSITION_RANGE;
    cm1e_axis_run(axis, &from, &profile, cm1e_position_plus(axis->set, profile.end.position * axis->scale), 0.0);
    return CM1E_OK;
}

/* Its times have passed. The next command begins (2.2.2, case 2), or the axis stops. */
static cm1e_error_t end_table(cm1e_axis_t *axis)
{
    const from_t from = from_set(axis);
    cm1e_axis_command_end(axis, CM1E_COMMAND_ERROR, CM1E_ERROR_AXIS_TABLE_LATE);
    axis->state = CM1E_AXIS_DISCRETE_MOTION;
    if (!cm1e_axis_begin_waiting(axis, &from, 0.0))
        cm1e_axis_ramp_down(axis, &axis->maximum);
    return CM1E_OK;
}

static cm1e_error_t move_anew(cm1e_axis_t *axis)
{
    if (axis->active && is_table(axis->kind))
        return end_table(axis);
    if (!axis->active || axis->kind == CM1E_COMMAND_STOP)
        return stop_anew(axis);
    const move_t move = axis->move;
    return axis->kind == CM1E_COMMAND_HOMING_STEP ? step_anew(axis) : cm1e_axis_replan_as(axis, &move);
}

void cm1e_axis_after_pause(cm1e_axis_t *axis, int64_t pause_ns)
{
    const bool goes_on = axis->mode == CM1E_MODE_CSV;
    if (axis->resumed) /* a follower has asked for that */
        return;
    axis->resumed = true;
    if (axis_follows(axis))
        cm1e_axis_resume_masters(axis, pause_ns);
    if (!goes_on)
        axis->backlash.offset_velocity = 0.0;
    if (!set_points_move(axis))
        return;
    if (goes_on)
        axis->set = cm1e_position_plus(axis->set, axis->set_velocity * axis->scale * (double)pause_ns * 1e-9);
    else
        axis->set_velocity = 0.0;
    axis->set_acceleration = 0.0;
    if (axis_led(axis)) {
        cm1e_axis_lead_after_pause(axis);
        return;
    }
    if (axis_follows(axis))
        cm1e_axis_coupling_shift(axis, axis->superimposed.now.position);
    cm1e_axis_superimposed_end(axis, CM1E_COMMAND_ABORTED, CM1E_OK); /* what is left of it belongs to the base now */
    if (axis_follows(axis)) {
        cm1e_axis_coupled_after_pause(axis);
        return;
    }
    const cm1e_error_t error = move_anew(axis);
    if (error)
        cm1e_axis_fail(axis, error, cm1e_axis_units(axis, axis->set),
                       axis->set_velocity > 0.0 ? axis->upper : axis->lower);
}
