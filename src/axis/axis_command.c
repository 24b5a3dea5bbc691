/* Commands: function blocks post them and know them by number; one of them is active. */
#include "axis/axis_commands.h"
#include "axis/axis_driving.h"
#include "axis/axis_extras.h"
#include "axis/axis_handle.h"
#include "axis/axis_in_position.h"
#include "axis/axis_lead.h"
#include "axis/axis_limits.h"
#include "axis/axis_plan.h"
#include "axis/axis_setpoint.h"
#include "axis/axis_superimpose.h"
#include "axis/axis_table.h"
#include "axis/axis_text.h"
#include "core/rare.h"

/* ---- ends -------------------------------------------------------------------------------------------------------- */

void cm1e_axis_waiting_end(cm1e_axis_t *axis, cm1e_command_state_t state)
{
    if (axis_awaits(axis))
        axis->coupling_hooks->await_nothing(axis);
    for (int i = 0; i < axis->commands.waiting.count; i++)
        cm1e_axis_record(axis, waiting_move(axis, i)->id, state,
                         state == CM1E_COMMAND_ERROR ? CM1E_ERROR_AXIS_ERROR_STOP : CM1E_OK);
    axis->commands.waiting.count = 0;
}

void cm1e_axis_commands_end(cm1e_axis_t *axis, cm1e_command_state_t state, cm1e_error_t error)
{
    cm1e_axis_in_position_ended(axis, state == CM1E_COMMAND_ERROR);
    cm1e_axis_command_end(axis, state, error);
    cm1e_axis_lead_end(axis, error);
    cm1e_axis_superimposed_end(axis, state, state == CM1E_COMMAND_ERROR ? CM1E_ERROR_AXIS_ERROR_STOP : CM1E_OK);
    if (state == CM1E_COMMAND_ERROR && axis->coupling_hooks) /* else it ends when the axis leaves its master */
        axis->coupling_hooks->phasing_end(axis, state, CM1E_ERROR_AXIS_ERROR_STOP);
    cm1e_axis_waiting_end(axis, state);
}

static void tell_of_coupling(const cm1e_axis_t *axis, cm1e_command_status_t *status)
{
    status->synchronizing = axis->setpoint.synchronizing;
    status->ends = axis->setpoint.ends;
}

cm1e_command_status_t cm1e_axis_command_status(const cm1e_axis_t *axis, cm1e_command_id_t id)
{
    cm1e_command_status_t status = {.state = CM1E_COMMAND_ACTIVE, .reached = axis->setpoint.reached};
    if (id != 0 && id == axis->commands.active) {
        if (axis_follows(axis))
            tell_of_coupling(axis, &status);
        return status;
    }
    for (int i = 0; i < axis->commands.waiting.count; i++)
        if (axis->commands.waiting.moves[(axis->commands.waiting.first + i) % CM1E_AXIS_BUFFER_DEPTH].id == id)
            return (cm1e_command_status_t){.state = CM1E_COMMAND_BUFFERED};
    const superimposed_t *on_top = &axis->superimposed;
    if (id != 0 && id == on_top->id)
        return (cm1e_command_status_t){.state = CM1E_COMMAND_ACTIVE, .covered = on_top->now.position};
    const coupling_hooks_t *hooks = axis->coupling_hooks;
    if (hooks && hooks->phasing_status(axis, id, &status))
        return status;
    const command_record_t *record = &axis->commands.records[id % COMMANDS_REMEMBERED];
    if (id == 0 || record->id != id)
        return (cm1e_command_status_t){.state = CM1E_COMMAND_UNKNOWN};
    return (cm1e_command_status_t){.state = (cm1e_command_state_t)record->state,
                                   .error = (cm1e_error_t)record->error,
                                   .covered = id == on_top->ended ? on_top->covered
                                              : hooks             ? hooks->phasing_covered(axis, id) : 0.0};
}

bool cm1e_axis_runs(AXIS_REF_t reference, cm1e_command_id_t id)
{
    const cm1e_axis_t *axis = cm1e_axis_from_handle(reference.Handle);
    return CM1E_USUALLY(axis && id != 0 && axis->commands.active == id);
}

cm1e_following_t cm1e_axis_follows_by(AXIS_REF_t reference, cm1e_command_id_t id)
{
    const cm1e_axis_t *axis = cm1e_axis_from_handle(reference.Handle);
    if (CM1E_USUALLY(axis && id != 0 && axis->commands.active == id && axis_follows(axis)))
        return (cm1e_following_t){true, axis->setpoint.reached, axis->setpoint.synchronizing, axis->setpoint.ends};
    return (cm1e_following_t){.follows = false};
}

/* ---- start ------------------------------------------------------------------------------------------------------- */

/* The most recently commanded position (3.7): the target of the present discrete motion, or of the last one if it was
 * aborted. A continuous motion has none. */
static position_t commanded_position(const cm1e_axis_t *axis)
{
    if (!axis_on_profile(axis) || axis->state != CM1E_AXIS_DISCRETE_MOTION)
        return axis->setpoint.position;
    const commands_t *commands = &axis->commands;
    const bool has_target = commands->active && kind_row(commands->kind)->plan == PLAN_TO_TARGET;
    const position_t base = has_target ? commands->move.target : axis->setpoint.target;
    return cm1e_position_plus(base, cm1e_axis_superimposed_goal(axis) * axis->position.scale);
}

static void hold_stop(cm1e_axis_t *axis, cm1e_command_id_t id)
{
    axis->commands.stop = id;
    axis->commands.stop_held = true;
}

static cm1e_error_t plan_move(cm1e_axis_t *axis, const from_t *from, const cm1e_axis_command_t *command, move_t *move,
                              cm1e_profile_t *profile)
{
    *move = cm1e_axis_move_of(command);
    move->origin = move->kind == CM1E_COMMAND_MOVE_ADDITIVE ? commanded_position(axis) : from->position;
    const cm1e_error_t error = cm1e_axis_resolve(axis, from, move);
    return error != CM1E_OK ? error : cm1e_axis_plan(axis, from, move, false, profile);
}

/* Starts a profile at the present set-point, whatever moves the axis now. */
static cm1e_error_t start_profile(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id)
{
    from_t from = from_set(axis);
    move_t move;
    cm1e_profile_t profile;
    cm1e_error_t error = plan_move(axis, &from, command, &move, &profile);
    if (error != CM1E_OK && axis->setpoint.brakes_hard) { /* the way back from a limit may need all of it */
        from.acceleration = axis->setpoint.acceleration;
        error = plan_move(axis, &from, command, &move, &profile);
    }
    if (error != CM1E_OK)
        return error;
    cm1e_axis_commands_end(axis, CM1E_COMMAND_ABORTED, CM1E_OK);
    *id = move.id = cm1e_axis_next_id(axis);
    if (move.kind == CM1E_COMMAND_STOP)
        hold_stop(axis, *id);
    cm1e_axis_take(axis, &move, &from, &profile, 0.0);
    return CM1E_OK;
}

/* Stops a homing by the drive. Only MC_Stop may do that; the drive brakes by itself. */
static cm1e_error_t stop_homing(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id)
{
    const from_t from = from_set(axis);
    const move_t move = cm1e_axis_move_of(command);
    cm1e_motion_limits_t unused;
    const cm1e_error_t error = cm1e_axis_limits_of(axis, &from, &move, &unused);
    if (error != CM1E_OK)
        return error;
    cm1e_axis_commands_end(axis, CM1E_COMMAND_ABORTED, CM1E_OK);
    *id = axis->commands.active = cm1e_axis_next_id(axis);
    axis->commands.kind = command->kind;
    hold_stop(axis, *id);
    axis->setpoint.source->stop(axis, &axis->limits.maximum, HOME_GOAL_HOLD);
    return CM1E_OK;
}

/* Starts or ends a motion by the drive. Such a motion begins at standstill, and MC_Halt or MC_Stop ends it. */
static cm1e_error_t start_drive(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id)
{
    const from_t from = from_set(axis);
    move_t move = cm1e_axis_move_of(command);
    const bool stopping = kind_row(command->kind)->is_stop;
    cm1e_motion_limits_t unused;
    driving_t driving;
    if (drive_moves(axis) && !stopping)
        return CM1E_ERROR_AXIS_STATE;
    move.origin = from.position;
    const cm1e_error_t error = stopping ? cm1e_axis_limits_of(axis, &from, &move, &unused)
                                        : cm1e_axis_drive_prepare(axis, &from, &move, &driving);
    if (error != CM1E_OK)
        return error;
    cm1e_axis_commands_end(axis, CM1E_COMMAND_ABORTED, CM1E_OK);
    *id = axis->commands.active = move.id = cm1e_axis_next_id(axis);
    axis->commands.kind = command->kind;
    axis->commands.move = move;
    if (command->kind == CM1E_COMMAND_STOP)
        hold_stop(axis, *id);
    if (stopping)
        axis->setpoint.source->stop(axis, &axis->limits.maximum, HOME_GOAL_HOLD);
    else
        cm1e_axis_drive_begin(axis, &driving);
    return CM1E_OK;
}

/* Whether the drive itself has to move or to stop. A stop at standstill does not need the drive. */
static bool by_drive(const cm1e_axis_t *axis, cm1e_command_kind_t kind)
{
    return drive_moves(axis) || (drive_profiles(axis) && axis_holds(axis) && !kind_row(kind)->is_stop);
}

cm1e_error_t cm1e_axis_start_move(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id)
{
    if (drive_homes(axis))
        return stop_homing(axis, command, id);
    return by_drive(axis, command->kind) ? start_drive(axis, command, id) : start_profile(axis, command, id);
}

/* ---- buffered ---------------------------------------------------------------------------------------------------- */

cm1e_error_t cm1e_axis_buffer_move(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id)
{
    move_t move = cm1e_axis_move_of(command);
    const cm1e_error_t error = cm1e_axis_buffer(axis, &move);
    if (error == CM1E_OK)
        *id = move.id;
    return error;
}

/* ---- taking in --------------------------------------------------------------------------------------------------- */

/* Whether the command has to wait for another one. Then it does not matter whether it could begin in the present
 * state. */
static bool has_to_wait(const cm1e_axis_t *axis, const cm1e_axis_command_t *command)
{
    return command->buffer_mode != mcAborting && kind_row(command->kind)->has_buffer_mode &&
           !is_beside(command->kind) && (axis->commands.active || axis_awaits(axis)) &&
           axis->state != CM1E_AXIS_STOPPING;
}

/* Checks the command without its numbers. */
static cm1e_error_t check(const cm1e_axis_t *axis, const cm1e_axis_command_t *command, bool waits)
{
    const command_kind_t *kind = kind_row(command->kind);
    const cm1e_error_t state_refusal = cm1e_axis_state_refusal(axis->state, kind->trigger);
    if (axis_led(axis) && command->kind != CM1E_COMMAND_STOP)
        return CM1E_ERROR_AXIS_IN_GROUP;
    if (drive_profiles(axis) && !kind->drive_can)
        return CM1E_ERROR_UNSUPPORTED;
    if (state_refusal != CM1E_OK && !waits)
        return state_refusal;
    if (axis->state == CM1E_AXIS_STOPPING && axis->commands.stop_held)
        return CM1E_ERROR_AXIS_STOPPING;
    if (kind->has_buffer_mode && (unsigned)command->buffer_mode > mcBlendingHigh)
        return CM1E_ERROR_AXIS_BUFFER_MODE;
    return waits && drive_profiles(axis) ? CM1E_ERROR_AXIS_BUFFER_MODE : CM1E_OK;
}

static cm1e_error_t start(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id)
{
    *id = 0;
    if ((unsigned)command->kind >= CM1E_COMMAND_KIND_COUNT)
        return CM1E_ERROR_INVALID_ARGUMENT;
    const command_kind_t *kind = kind_row(command->kind);
    const command_method_t *method = cm1e_axis_method(axis, kind->plan);
    const bool waits = has_to_wait(axis, command);
    cm1e_error_t error = check(axis, command, waits);
    if (error != CM1E_OK)
        return error;
    if (!method->start)
        return CM1E_ERROR_UNSUPPORTED;
    if (waits)
        return method->buffer(axis, command, id);
    error = method->start(axis, command, id);
    const bool later = cm1e_axis_find_waiting(axis, *id) != NULL; /* it waits for its master: 4.7, note 1 */
    if (error == CM1E_OK && !later)
        cm1e_axis_taken(axis, kind);
    return error;
}

cm1e_error_t cm1e_axis_start(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id)
{
    if (axis->not_set.what == NOT_FINISHED) /* this command may end at once, and then it is reported */
        cm1e_axis_forget_not_set(axis);
    cm1e_axis_remember_refusal(axis, command, start(axis, command, id));
    if (axis->commands.refusal && (unsigned)command->kind < CM1E_COMMAND_KIND_COUNT &&
        kind_row(command->kind)->plan == PLAN_TABLE)
        cm1e_axis_table_needs(axis, command, &axis->commands.refused);
    return axis->commands.refusal;
}

bool cm1e_axis_hold_stop(cm1e_axis_t *axis, cm1e_command_id_t id, bool hold)
{
    if (id == 0 || id != axis->commands.stop)
        return false;
    axis->commands.stop_held = hold;
    return hold && axis->state == CM1E_AXIS_STOPPING;
}
