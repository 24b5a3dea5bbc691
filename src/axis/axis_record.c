/* The records of commands and refusals: how a command ended, by its number; and what was refused last, for the text. */
#include "axis/axis_commands.h"
#include "axis/axis_setpoint.h"
#include "axis/axis_text.h"

/* ---- records ----------------------------------------------------------------------------------------------------- */

void cm1e_axis_record(cm1e_axis_t *axis, cm1e_command_id_t id, cm1e_command_state_t state, cm1e_error_t error)
{
    axis->commands.records[id % COMMANDS_REMEMBERED] =
        (command_record_t){.id = id, .error = (int16_t)error, .state = (uint8_t)state};
}

cm1e_command_id_t cm1e_axis_next_id(cm1e_axis_t *axis)
{
    if (++axis->commands.last_id == 0)
        axis->commands.last_id = 1; /* 0 is not the number of a command */
    return axis->commands.last_id;
}

/* ---- commands as they are kept ----------------------------------------------------------------------------------- */

move_t cm1e_axis_move_of(const cm1e_axis_command_t *command)
{
    return (move_t){
        .kind = (uint8_t)command->kind,
        .buffer_mode = (uint8_t)command->buffer_mode,
        .direction = (unsigned)command->direction <= UINT8_MAX ? (uint8_t)command->direction : UINT8_MAX,
        .position = command->position,
        .velocity = command->velocity,
        .end_velocity = kind_row(command->kind)->plan == PLAN_THROUGH_TARGET ? command->end_velocity : 0.0,
        .acceleration = command->acceleration,
        .deceleration = command->deceleration,
        .jerk = command->jerk,
    };
}

bool cm1e_axis_same_way(const move_t *a, const move_t *b)
{
    return a->position == b->position && a->direction == b->direction;
}

bool cm1e_axis_same_inputs(const move_t *a, const move_t *b)
{
    return cm1e_axis_same_way(a, b) && a->velocity == b->velocity && a->end_velocity == b->end_velocity &&
           a->acceleration == b->acceleration && a->deceleration == b->deceleration && a->jerk == b->jerk;
}

waiting_t *cm1e_axis_find_waiting(cm1e_axis_t *axis, cm1e_command_id_t id)
{
    for (int i = 0; i < axis->commands.waiting.count; i++)
        if (waiting_move(axis, i)->id == id)
            return waiting_move(axis, i);
    return NULL;
}

/* ---- refusals ---------------------------------------------------------------------------------------------------- */

void cm1e_axis_remember_refusal(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_error_t error)
{
    axis->commands.refusal = error;
    if (error == CM1E_OK)
        return;
    axis->commands.refused = *command;
    axis->not_set.error = CM1E_OK;
}

cm1e_error_t cm1e_axis_refuse(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_error_t error)
{
    cm1e_axis_remember_refusal(axis, command, error);
    return error;
}

void cm1e_axis_remember_not_set(cm1e_axis_t *axis, not_set_t what)
{
    if (what.error == CM1E_OK && axis->not_set.what != what.what)
        return;
    axis->not_set = what;
    if (what.error != CM1E_OK)
        axis->commands.refusal = CM1E_OK;
}

void cm1e_axis_remember_repeated(cm1e_axis_t *axis, not_set_t what, bool begins)
{
    what.repeated = true;
    if (begins || (axis->not_set.error == CM1E_OK && axis->commands.refusal == CM1E_OK))
        cm1e_axis_remember_not_set(axis, what);
}

/* Those that are still refused tell it again. */
void cm1e_axis_reads_right(cm1e_axis_t *axis)
{
    if (axis->not_set.repeated)
        cm1e_axis_forget_not_set(axis);
}

void cm1e_axis_remember_end(cm1e_axis_t *axis, cm1e_command_kind_t kind, cm1e_error_t error)
{
    if (error != CM1E_OK && error != CM1E_ERROR_AXIS_ERROR_STOP)
        cm1e_axis_remember_not_set(axis, (not_set_t){.error = error, .what = NOT_FINISHED, .number = (int)kind});
}

void cm1e_axis_command_end(cm1e_axis_t *axis, cm1e_command_state_t state, cm1e_error_t error)
{
    if (!axis->commands.active)
        return;
    cm1e_axis_record(axis, axis->commands.active, state, error);
    cm1e_axis_remember_end(axis, axis->commands.kind, error);
    axis->commands.active = 0;
    cm1e_axis_set_reached(axis, false);
}
