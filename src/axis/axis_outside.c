/*
 * Set-points from outside (CM_FollowPosition). Another planner, of a numerical control or a robot, has computed the
 * motion. A program gives its position in every cycle; velocity and acceleration follow from the positions.
 *
 * The axis takes over only if it stands where the first position is, so nothing jumps. Every set-point is checked
 * against the limits of the axis, except that of jerk, which many planners do not limit. A set-point that the motor
 * could not follow is not sent: the axis stops by its own ramp. It stops like that also in the first cycle in which no
 * position was given, because a planner that has gone on meanwhile could not be caught up with.
 *
 * While the bus is silent the time of all set-points stops (axis_pause.c), but the program goes on. So positions wait
 * in a queue, and the axis goes the whole way, later by as many cycles. It makes up for the delay when it rests.
 */
#include <math.h>
#include <stdio.h>

#include "axis/axis_outside.h"
#include "axis/axis_commands.h"
#include "axis/axis_events.h"
#include "axis/axis_guard.h"
#include "axis/axis_handle.h"
#include "axis/axis_lead.h"
#include "axis/axis_limits.h"
#include "axis/axis_plan.h"
#include "axis/axis_position.h"
#include "axis/axis_setpoint.h"

/* The set-point at a position (u, as cm1e_axis_line() counts), one cycle after the present one. */
static bool reach(const cm1e_axis_t *axis, double line, from_t *next)
{
    if (!cm1e_axis_position_from_line(axis, line, &next->position))
        return false;
    const double way = cm1e_position_minus(next->position, axis->setpoint.position) / axis->position.scale;
    next->velocity = way / axis->cycle_s;
    next->acceleration = (next->velocity - axis->setpoint.velocity) / axis->cycle_s;
    next->shared = false;
    return true;
}

static guard_t judge(const cm1e_axis_t *axis, double line, from_t *next)
{
    guard_t guard = {.limit = GUARD_FINITE};
    if (reach(axis, line, next))
        guard = cm1e_axis_guard(axis, next, false);
    guard.from_outside = true;
    return guard;
}

/* ---- the queue --------------------------------------------------------------------------------------------------- */

static double first(const outside_t *outside) { return outside->lines[outside->first]; }

static void take_first(outside_t *outside)
{
    outside->first = (uint8_t)((outside->first + 1) % OUTSIDE_WAITING);
    outside->count--;
}

/* Positions of an axis that rests need not wait. */
static void make_up(outside_t *outside, double line)
{
    while (outside->count > 0 && first(outside) == line)
        take_first(outside);
}

void cm1e_axis_feed(AXIS_REF_t reference, cm1e_command_id_t id, double position)
{
    cm1e_axis_t *axis = cm1e_axis_from_handle(reference.Handle);
    if (!axis || id == 0 || axis->commands.active != id || !axis_from_outside(axis))
        return;
    outside_t *outside = &axis->outside;
    const bool rests = axis->setpoint.velocity == 0.0;
    if (rests && outside->count == 1 && first(outside) == position)
        return; /* the bus is silent, and the axis stays where it is */
    if (outside->count == OUTSIDE_WAITING) {
        outside->overrun = true;
        return;
    }
    outside->lines[(outside->first + outside->count) % OUTSIDE_WAITING] = position;
    outside->count++;
}

/* ---- the source -------------------------------------------------------------------------------------------------- */

static void fail_after_pause(cm1e_axis_t *axis, double velocity)
{
    cm1e_axis_guard_fail(axis, (guard_t){.limit = GUARD_PAUSE, .asked = velocity, .from_outside = true});
}

static bool step(cm1e_axis_t *axis)
{
    outside_t *outside = &axis->outside;
    from_t next;
    if (outside->overrun) {
        fail_after_pause(axis, axis->setpoint.velocity);
        return false;
    }
    if (outside->count == 0) {
        cm1e_axis_fail(axis, CM1E_ERROR_AXIS_SET_POINT_MISSING, axis->setpoint.velocity, 0.0);
        return false;
    }
    const double line = first(outside);
    take_first(outside);
    const guard_t guard = judge(axis, line, &next);
    if (guard.limit) {
        cm1e_axis_guard_fail(axis, guard);
        return false;
    }
    cm1e_axis_put_set_point(axis, &next);
    outside->velocity = next.velocity;
    if (next.velocity == 0.0)
        make_up(outside, line);
    return true;
}

/* After a pause the motor rests, and the planner has gone on: only an axis that rested anyway can go on. */
static void begin_anew(cm1e_axis_t *axis)
{
    if (axis->outside.velocity != 0.0)
        fail_after_pause(axis, axis->outside.velocity);
}

/* After a short silence at nearly the maximum velocity the motor would exceed it, and the planner does not slow
 * down. */
static void slow(cm1e_axis_t *axis, double part)
{
    if (part < 1.0)
        fail_after_pause(axis, axis->setpoint.velocity);
}

static void leave(cm1e_axis_t *axis) { axis->outside = (outside_t){0}; }

static bool goes(cm1e_axis_t *axis, double sign) { return axis->setpoint.velocity * sign > 0.0; }

const source_t cm1e_source_outside = {
    .step = step,
    .stop = cm1e_axis_stop_by_ramp,
    .begin_anew = begin_anew,
    .slow = slow,
    .leave = leave,
    .goes = goes,
    .keeps = cm1e_axis_unknown_way_keeps,
    .moves = true,
    .is_composite = true,
};

/* ---- the command ------------------------------------------------------------------------------------------------- */

cm1e_error_t cm1e_axis_outside_start(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id)
{
    from_t next;
    if (!axis_holds(axis) || axis->commands.active || axis->superimposed.id || !axis_acts(axis))
        return CM1E_ERROR_AXIS_STATE;
    cm1e_axis_guard_renew(axis);
    if (judge(axis, command->position, &next).limit)
        return CM1E_ERROR_AXIS_SET_POINT_JUMP;
    cm1e_axis_commands_end(axis, CM1E_COMMAND_ABORTED, CM1E_OK);
    *id = cm1e_axis_next_id(axis);
    cm1e_axis_activate(axis, &(move_t){.id = *id, .kind = (uint8_t)command->kind, .origin = axis->setpoint.position});
    cm1e_axis_set_source(axis, &cm1e_source_outside);
    return CM1E_OK;
}

void cm1e_axis_outside_refused_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    snprintf(text, size,
             "Axis \"%s\": the first position from outside is %.9g u, and the axis stands at %.9g u: it would jump. "
             "Begin with the position of the axis. Within its limits it could also not have begun beyond its software "
             "limits, or in a direction that MC_Power does not enable.",
             axis->config->name, axis->commands.refused.position, cm1e_axis_line(axis, axis->setpoint.position));
}

void cm1e_axis_outside_missing_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    snprintf(text, size,
             "Axis \"%s\": it followed positions from outside at %.6g u/s, and for one cycle none was given. The axis "
             "was braked. Find out why the source of the positions stopped, or why CM_FollowPosition was not called in "
             "every cycle of the bus; then reset the axis with MC_Reset.",
             axis->config->name, axis->fault.value);
}
