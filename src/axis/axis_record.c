/* What is kept of commands and refusals: how a command ended, for who asks by number, and what was refused last, for the
 * text. */
#include "axis/axis_private.h"

/* ---- records ----------------------------------------------------------------------------------------------------- */

void cm1e_axis_record(cm1e_axis_t *axis, cm1e_command_id_t id, cm1e_command_state_t state, cm1e_error_t error)
{
    axis->records[id % COMMANDS_REMEMBERED] =
        (command_record_t){.id = id, .error = (int16_t)error, .state = (uint8_t)state};
}

cm1e_command_id_t cm1e_axis_next_id(cm1e_axis_t *axis)
{
    if (++axis->last_id == 0)
        axis->last_id = 1; /* 0 is no command */
    return axis->last_id;
}

/* ---- refusals ---------------------------------------------------------------------------------------------------- */

void cm1e_axis_remember_refusal(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_error_t error)
{
    axis->refusal = error;
    if (!error)
        return;
    axis->refused = *command;
    axis->not_set.error = CM1E_OK;
}

void cm1e_axis_remember_not_set(cm1e_axis_t *axis, not_set_t what)
{
    if (!what.error && axis->not_set.what != what.what)
        return;
    axis->not_set = what;
    if (what.error)
        axis->refusal = CM1E_OK;
}

void cm1e_axis_remember_end(cm1e_axis_t *axis, cm1e_command_kind_t kind, cm1e_error_t error)
{
    if (error && error != CM1E_ERROR_AXIS_ERROR_STOP)
        cm1e_axis_remember_not_set(axis, (not_set_t){.error = error, .what = NOT_FINISHED, .number = (int)kind});
}
