/* Changes of the profile of a command: another one takes over, or it is planned anew from the present set-point. */
#include "axis/axis_commands.h"
#include "axis/axis_plan.h"
#include "axis/axis_setpoint.h"

void cm1e_axis_take(cm1e_axis_t *axis, const move_t *move, const from_t *from, const cm1e_profile_t *profile,
                    double offset_s)
{
    cm1e_axis_command_end(axis, CM1E_COMMAND_ABORTED, CM1E_OK);
    cm1e_axis_activate(axis, move);
    cm1e_axis_run(axis, from, profile, cm1e_axis_profile_end(axis, from, move, profile), offset_s);
    cm1e_axis_set_paused(axis, move->paused);
}

void cm1e_axis_taken(cm1e_axis_t *axis, const command_kind_t *kind)
{
    if (kind->plan != PLAN_HOMING_STEP) /* a step sets the state itself: MC_HomeDirect may be over already */
        cm1e_axis_go(axis, kind->trigger);
}

static void go_on_as(cm1e_axis_t *axis, const from_t *from, const move_t *move, const cm1e_profile_t *profile)
{
    axis->commands.move = *move;
    cm1e_axis_run(axis, from, profile, cm1e_axis_profile_end(axis, from, move, profile), 0.0);
    cm1e_axis_set_paused(axis, move->paused);
}

cm1e_error_t cm1e_axis_replan_as(cm1e_axis_t *axis, const move_t *as)
{
    move_t move = *as;
    cm1e_profile_t profile;
    const from_t from = from_base(axis);
    const cm1e_error_t error = cm1e_axis_plan(axis, &from, &move, true, &profile);
    if (error == CM1E_OK)
        go_on_as(axis, &from, &move, &profile);
    return error;
}

/* Behind lost frames or a pause, the deceleration and the jerk of a command may no longer end before a software limit:
 * its motor has another velocity, without an acceleration, or has run on. The axis may brake harder. */
static cm1e_error_t plan_harder(cm1e_axis_t *axis, const from_t *from, move_t *move, cm1e_profile_t *profile)
{
    move_t harder = *move;
    harder.deceleration = axis->limits.maximum.deceleration;
    harder.jerk = axis->limits.maximum.jerk;
    const cm1e_error_t error = cm1e_axis_plan(axis, from, &harder, true, profile);
    if (error == CM1E_OK)
        move->target = harder.target;
    return error;
}

/* What was accepted goes on within what the application allows now, but for the braking that it needs to reach its
 * target. */
cm1e_error_t cm1e_axis_replan_anew(cm1e_axis_t *axis)
{
    move_t move = axis->commands.move;
    cm1e_profile_t profile;
    const from_t from = from_base(axis);
    move.accepted = true;
    cm1e_error_t error = cm1e_axis_plan(axis, &from, &move, true, &profile);
    if (axis->commands.lowered && cm1e_axis_goes_wrong(axis, &from, &move, &profile, error))
        error = cm1e_axis_plan_as_before(axis, &from, &move, &profile);
    if (error == CM1E_ERROR_AXIS_POSITION_RANGE)
        error = plan_harder(axis, &from, &move, &profile);
    if (error == CM1E_OK)
        go_on_as(axis, &from, &move, &profile);
    return error;
}

bool cm1e_axis_can_replan(const cm1e_axis_t *axis)
{
    return axis->commands.active && axis_on_profile(axis) && axis->commands.kind != CM1E_COMMAND_STOP &&
           is_planned(axis->commands.kind);
}

/* Whether the present profile goes both ways. */
static bool turns_round(const cm1e_axis_t *axis)
{
    const cm1e_profile_t *profile = &axis->setpoint.profile;
    const double tolerance = axis->limits.tolerance;
    return cm1e_profile_way_back(profile, 1.0) > tolerance && cm1e_profile_way_back(profile, -1.0) > tolerance;
}

/* Plans the command anew. `careful`: not if it would then overrun its target or go back. An axis that turns round
 * anyway may need a way back to come to rest in a pause. */
static cm1e_error_t replan(cm1e_axis_t *axis, bool careful, bool *done)
{
    move_t move = axis->commands.move;
    cm1e_profile_t profile;
    const from_t from = from_base(axis);
    move.accepted = !axis->setpoint.paused;
    const cm1e_error_t error = cm1e_axis_plan(axis, &from, &move, true, &profile);
    *done = error == CM1E_OK &&
            ((move.paused && turns_round(axis)) ||
             !(careful && cm1e_axis_profile_strays(axis, &from, &move, &profile)));
    if (*done)
        go_on_as(axis, &from, &move, &profile);
    return error;
}

/* Whether the present profile overruns its target or goes back already, because it began too late. */
static bool runs_astray(const cm1e_axis_t *axis)
{
    const cm1e_motion_state_t *start = &axis->setpoint.profile.segments[0].start;
    const from_t from = {axis->setpoint.base, start->velocity, start->acceleration, false};
    return axis->setpoint.profile.segment_count > 0 &&
           cm1e_axis_profile_strays(axis, &from, &axis->commands.move, &axis->setpoint.profile);
}

/* A profile that reaches its target, or passes it with a velocity, stays if the new plan would not do so. */
cm1e_error_t cm1e_axis_replan(cm1e_axis_t *axis)
{
    bool done;
    return cm1e_axis_can_replan(axis) ? replan(axis, !axis->setpoint.paused && !runs_astray(axis), &done) : CM1E_OK;
}

bool cm1e_axis_replan_if(cm1e_axis_t *axis)
{
    bool done = false;
    return cm1e_axis_can_replan(axis) && replan(axis, true, &done) == CM1E_OK && done;
}
