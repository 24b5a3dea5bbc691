/*
 * A pause: frames were not lost but never sent, because the work of a cycle or a wake-up took whole cycles too long. In
 * CSP the motor stands at its last target by then, in CSV it has gone on with its last velocity. A profile that simply
 * went on would ask it for a step of velocity; so what moves begins anew from there: from rest, or from where the motor
 * must be by now. Stops and ramps of errors end where they stand.
 */
#include "axis/axis_private.h"

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

void cm1e_axis_after_pause(cm1e_axis_t *axis, int64_t pause_ns)
{
    const bool goes_on = axis->mode == CM1E_MODE_CSV;
    if (!goes_on)
        axis->backlash.offset_velocity = 0.0;
    if (axis->activity != ACTIVITY_PROFILE)
        return;
    if (goes_on)
        axis->set = cm1e_position_plus(axis->set, axis->set_velocity * axis->scale * (double)pause_ns * 1e-9);
    else
        axis->set_velocity = 0.0;
    axis->set_acceleration = 0.0;
    const bool stops = !axis->active || axis->kind == CM1E_COMMAND_STOP;
    const cm1e_error_t error = stops ? stop_anew(axis) : cm1e_axis_replan(axis);
    if (error)
        cm1e_axis_fail(axis, error, cm1e_axis_units(axis, axis->set),
                       axis->set_velocity > 0.0 ? axis->upper : axis->lower);
}
