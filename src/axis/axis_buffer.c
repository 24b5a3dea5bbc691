/*
 * Waiting commands (2.4.2, table 4): how they are buffered, with which velocity the end position of a command is passed
 * on the way to the next, and the change from one command to the next. The change is at the exact time, inside a cycle,
 * at which the first command ends.
 */
#include <float.h>
#include <math.h>

#include "axis/axis_commands.h"
#include "axis/axis_events.h"
#include "axis/axis_limits.h"
#include "axis/axis_plan.h"
#include "axis/axis_position.h"
#include "axis/axis_superimpose.h"

/* Tolerance of an exit velocity that is computed again during the motion. */
static const double same_velocity = 1e-9;

/* ---- taking in --------------------------------------------------------------------------------------------------- */

/* Checks what can be known before the command begins. `end`: end position of the command before it; NULL: unknown. */
static cm1e_error_t check(const cm1e_axis_t *axis, move_t *move, const position_t *end)
{
    const from_t from = {end ? *end : axis->setpoint.position, 0.0, 0.0, axis_shares(axis)};
    const command_kind_t *kind = kind_row(move->kind);
    cm1e_motion_limits_t limits;
    if (!is_planned(move->kind))
        return CM1E_OK;
    cm1e_error_t error = cm1e_axis_limits_of(axis, &from, move, &limits);
    move->origin = from.position;
    if (error == CM1E_OK)
        error = cm1e_axis_resolve(axis, &from, move);
    double way = cm1e_position_minus(move->target, from.position) / axis->position.scale;
    if (error == CM1E_OK && kind->plan == PLAN_VELOCITY)
        error = cm1e_axis_signed_velocity(axis, &from, move, &way);
    if (error != CM1E_OK || kind->plan == PLAN_STOP)
        return error;
    if ((end || kind->target == TARGET_ABSOLUTE) && !cm1e_axis_limits_contain_target(axis, &from, move->target))
        return CM1E_ERROR_AXIS_POSITION_RANGE;
    const bool direction_known = end || kind->plan == PLAN_VELOCITY || kind->target == TARGET_RELATIVE;
    if (direction_known && !cm1e_axis_direction_enabled(axis, way))
        return CM1E_ERROR_AXIS_DIRECTION_DISABLED;
    return CM1E_OK;
}

/* Where the command before the waiting command `index` ends, and its kind. */
static const position_t *before(cm1e_axis_t *axis, int index, const command_kind_t **kind)
{
    const waiting_t *waiting = index > 0 ? waiting_move(axis, index - 1) : NULL;
    *kind = kind_row(waiting ? waiting->kind : axis->commands.kind); /* an active homing has no move */
    return waiting ? &waiting->target : &axis->commands.move.target;
}

static cm1e_error_t check_behind(cm1e_axis_t *axis, int index, move_t *move)
{
    const command_kind_t *kind;
    const position_t *end = before(axis, index, &kind);
    if (kind->plan == PLAN_OUTSIDE)
        return CM1E_ERROR_AXIS_BUFFER_MODE; /* it does not end by itself */
    if (is_homing(move->kind) && (kind->is_endless || kind->plan == PLAN_COUPLING))
        return CM1E_ERROR_AXIS_STATE; /* homing begins at rest */
    return check(axis, move, kind->target != TARGET_NONE ? end : NULL);
}

/* Whether an endless command that has reached its aim lets the next command begin. */
static bool hands_over(const cm1e_axis_t *axis)
{
    if (kind_row(axis->commands.kind)->plan == PLAN_COUPLING)
        return axis->coupling_hooks->hands_over(axis);
    return kind_row(axis->commands.kind)->is_endless;
}

cm1e_error_t cm1e_axis_buffer(cm1e_axis_t *axis, move_t *move)
{
    if (axis->commands.waiting.count == CM1E_AXIS_BUFFER_DEPTH)
        return CM1E_ERROR_FULL;
    const cm1e_error_t error = check_behind(axis, axis->commands.waiting.count, move);
    if (error != CM1E_OK)
        return error;
    move->id = cm1e_axis_next_id(axis);
    cm1e_axis_append_waiting(axis, move);
    if (axis->setpoint.reached && hands_over(axis)) { /* the signal that starts it (table 4) is present already */
        const from_t from = from_base(axis);
        (void)cm1e_axis_begin_waiting(axis, &from, 0.0);
    } else if (kind_row(axis->commands.kind)->plan == PLAN_TO_TARGET) {
        (void)cm1e_axis_replan(axis);
    }
    return CM1E_OK;
}

cm1e_error_t cm1e_axis_update_waiting(cm1e_axis_t *axis, const move_t *move)
{
    for (int i = 0; i < axis->commands.waiting.count; i++) {
        if (waiting_move(axis, i)->id != move->id)
            continue;
        move_t checked = *move;
        const cm1e_error_t error = check_behind(axis, i, &checked);
        if (error != CM1E_OK)
            return error;
        *waiting_move(axis, i) = waiting_of_move(&checked);
        if (kind_row(axis->commands.kind)->plan == PLAN_TO_TARGET)
            (void)cm1e_axis_replan(axis);
    }
    return CM1E_OK;
}

/* ---- from one to the next ---------------------------------------------------------------------------------------- */

static move_t take_first(cm1e_axis_t *axis)
{
    const move_t move = move_of_waiting(waiting_move(axis, 0));
    axis->commands.waiting.first = (uint8_t)((axis->commands.waiting.first + 1) % CM1E_AXIS_BUFFER_DEPTH);
    axis->commands.waiting.count--;
    return move;
}

/* Whether a waiting command begins where the one before it has passed its target. The look-ahead has chosen that
 * velocity by the target of the waiting command, which is on a modulo axis in the turn that is next from there. */
static bool was_looked_ahead(const cm1e_axis_t *axis, const from_t *from)
{
    const double way = cm1e_position_minus(from->position, axis->commands.move.target) / axis->position.scale;
    return kind_row(axis->commands.kind)->plan == PLAN_TO_TARGET && fabs(way) <= axis->limits.tolerance;
}

void cm1e_axis_maximum_lowered(cm1e_axis_t *axis) { axis->commands.lowered = true; }

cm1e_error_t cm1e_axis_begin_move(cm1e_axis_t *axis, move_t *move, const from_t *from, double offset_s)
{
    cm1e_profile_t profile;
    from_t at = *from;
    move->origin = from->position;
    if (was_looked_ahead(axis, from) && from->velocity != 0.0) /* the direction alone counts, as there */
        at.velocity = copysign(DBL_MIN, from->velocity), at.acceleration = 0.0;
    cm1e_error_t error = cm1e_axis_resolve(axis, &at, move);
    if (error != CM1E_OK)
        return error;
    error = cm1e_axis_plan(axis, from, move, true, &profile);
    const bool lowered = axis->commands.lowered && was_looked_ahead(axis, from) &&
                         cm1e_axis_goes_wrong(axis, from, move, &profile, error);
    if (lowered)
        error = cm1e_axis_plan_as_before(axis, from, move, &profile);
    if (error == CM1E_OK)
        cm1e_axis_take(axis, move, from, &profile, offset_s);
    axis->commands.lowered = axis->commands.lowered || lowered;
    return error;
}

bool cm1e_axis_begin_next(cm1e_axis_t *axis, const from_t *at, double offset_s)
{
    from_t from = *at;
    while (axis->commands.waiting.count > 0) {
        const command_kind_t *kind = kind_row(waiting_move(axis, 0)->kind);
        const command_method_t *method = cm1e_axis_method(axis, kind->plan);
        if (axis->superimposed.id && (axis->superimposed.alone || !kind->carries_superimposed))
            return false; /* these wait for the end of the superimposed motion */
        if (method->awaits && method->awaits(axis, &from, offset_s))
            return false;
        move_t move = take_first(axis);
        /* A halt has no place to count from. */
        const bool may_begin_now = offset_s == 0.0 || move.kind == CM1E_COMMAND_HALT;
        if (is_planned(move.kind) && may_begin_now && cm1e_axis_superimposed_give_way(axis, &move, &from) &&
            offset_s != 0.0)
            offset_s = axis->cycle_s; /* since the present set-point */
        cm1e_error_t error = cm1e_axis_state_refusal(axis->state, kind->trigger);
        if (error == CM1E_OK)
            error = method->begin(axis, &move, &from, offset_s);
        if (error == CM1E_OK) {
            cm1e_axis_taken(axis, kind);
            return true;
        }
        cm1e_axis_record(axis, move.id, CM1E_COMMAND_ERROR, error);
        cm1e_axis_remember_end(axis, (cm1e_command_kind_t)move.kind, error);
    }
    return false;
}

/* ---- a shift of the coordinates ---------------------------------------------------------------------------------- */

/* The number of commands before the first waiting homing. Positions of the commands after it are in the new
 * coordinates. */
static int before_homing(cm1e_axis_t *axis)
{
    int count = 0;
    while (count < axis->commands.waiting.count && !is_homing(waiting_move(axis, count)->kind))
        count++;
    return count;
}

bool cm1e_axis_waiting_hold(cm1e_axis_t *axis, double lower, double upper)
{
    const int count = before_homing(axis);
    bool known = axis->commands.active && kind_row(axis->commands.kind)->target != TARGET_NONE;
    for (int i = 0; i < count; i++) {
        const waiting_t *move = waiting_move(axis, i);
        const command_target_t has = kind_row(move->kind)->target;
        const double target = cm1e_axis_line(axis, move->target);
        known = has == TARGET_ABSOLUTE || (known && has == TARGET_RELATIVE);
        if (known && !(target <= upper + axis->limits.tolerance && target >= lower - axis->limits.tolerance))
            return false;
    }
    return true;
}

bool cm1e_axis_shift_waiting(cm1e_axis_t *axis, double shift)
{
    const int count = before_homing(axis);
    for (int i = 0; i < count; i++)
        waiting_move(axis, i)->shift += shift;
    if (count == 0 || !axis->limits.software_limits || !cm1e_axis_can_replan(axis) ||
        kind_row(axis->commands.kind)->plan != PLAN_TO_TARGET)
        return true;
    /* The command after this one has less room to begin now. */
    const from_t from = from_base(axis);
    const double planned = axis->commands.move.exit_velocity;
    const double now = cm1e_axis_exit_velocity(axis, &from, &axis->commands.move);
    if (fabs(now) >= fabs(planned) * (1.0 - same_velocity) || cm1e_axis_replan_if(axis))
        return true;
    for (int i = 0; i < count; i++)
        waiting_move(axis, i)->shift -= shift;
    return false;
}
