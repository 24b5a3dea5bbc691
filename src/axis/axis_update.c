/*
 * ContinuousUpdate (2.4.6): new inputs of an active or waiting command. If no input has changed, it costs one
 * comparison. Else the command is planned anew from the present set-point. Relative values still count from the begin
 * of the command.
 */
#include "axis/axis_commands.h"
#include "axis/axis_in_position.h"
#include "axis/axis_limits.h"
#include "axis/axis_plan.h"
#include "axis/axis_setpoint.h"

/* An old command with new inputs. */
static move_t merged(const move_t *old, const move_t *inputs)
{
    move_t move = *inputs;
    move.id = old->id;
    move.buffer_mode = old->buffer_mode; /* the buffer mode has taken effect already */
    move.origin = old->origin;
    move.target = old->target;
    move.shift = cm1e_axis_same_way(old, inputs) ? old->shift : 0.0;
    move.passing = old->passing && cm1e_axis_same_way(old, inputs);
    return move;
}

static cm1e_error_t update_active(cm1e_axis_t *axis, const move_t *inputs)
{
    if (drive_profiles(axis))
        return cm1e_axis_same_inputs(&axis->commands.move, inputs) ? CM1E_OK : CM1E_ERROR_UNSUPPORTED;
    if ((!axis_on_profile(axis) && !axis_settling(axis)) || inputs->kind != axis->commands.kind)
        return CM1E_ERROR_INVALID_ARGUMENT;
    if (cm1e_axis_same_inputs(&axis->commands.move, inputs))
        return CM1E_OK;
    move_t move = merged(&axis->commands.move, inputs);
    const from_t from = from_base(axis);
    if (!cm1e_axis_same_way(&axis->commands.move, inputs)) {
        const cm1e_error_t error = cm1e_axis_resolve(axis, &from, &move);
        if (error != CM1E_OK)
            return error;
    } else if (axis_settling(axis)) { /* its set-point is at the target: nothing to plan */
        cm1e_motion_limits_t unused;
        return cm1e_axis_limits_of(axis, &from, &move, &unused);
    }
    return cm1e_axis_replan_as(axis, &move);
}

cm1e_error_t cm1e_axis_update_move(cm1e_axis_t *axis, cm1e_command_id_t id, const cm1e_axis_command_t *command)
{
    const move_t inputs = cm1e_axis_move_of(command);
    if (id == axis->commands.active)
        return update_active(axis, &inputs);
    const waiting_t *waiting = cm1e_axis_find_waiting(axis, id);
    if (!waiting)
        return CM1E_OK; /* the command has ended */
    if (waiting->kind != inputs.kind)
        return CM1E_ERROR_INVALID_ARGUMENT;
    const move_t old = move_of_waiting(waiting), move = merged(&old, &inputs);
    return cm1e_axis_same_inputs(&old, &inputs) ? CM1E_OK : cm1e_axis_update_waiting(axis, &move);
}

static cm1e_error_t update(cm1e_axis_t *axis, cm1e_command_id_t id, const cm1e_axis_command_t *command)
{
    if (id == 0 || (unsigned)command->kind >= CM1E_COMMAND_KIND_COUNT)
        return CM1E_ERROR_INVALID_ARGUMENT;
    const command_method_t *method = cm1e_axis_method(axis, kind_row(command->kind)->plan);
    return method->update ? method->update(axis, id, command) : CM1E_ERROR_INVALID_ARGUMENT;
}

cm1e_error_t cm1e_axis_update(cm1e_axis_t *axis, cm1e_command_id_t id, const cm1e_axis_command_t *command)
{
    const cm1e_error_t error = update(axis, id, command);
    if (error != CM1E_OK) /* a success must not clear an earlier refusal: it comes with every call of a block */
        cm1e_axis_remember_refusal(axis, command, error);
    return error;
}
