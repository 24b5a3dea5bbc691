/* The commands MC_Home and the steps of Part 5: started at once, buffered, and begun after another command. */
#include "axis/axis_commands.h"
#include "axis/axis_setpoint.h"
#include "homing/homing_private.h"

cm1e_error_t cm1e_homing_start(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id)
{
    const cm1e_error_t error = cm1e_homing_prepare(axis, command);
    if (error != CM1E_OK)
        return error;
    cm1e_axis_commands_end(axis, CM1E_COMMAND_ABORTED, CM1E_OK);
    *id = cm1e_axis_next_id(axis);
    cm1e_axis_activate_homing(axis, *id, command->kind);
    cm1e_homing_run(axis);
    return CM1E_OK;
}

/* A step begins in Standstill, or in Homing after another step (Part 5), but not during a homing by the drive. */
cm1e_error_t cm1e_homing_step_start(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id)
{
    const move_t move = cm1e_axis_move_of(command);
    stepping_t next;
    cm1e_profile_t profile;
    cm1e_error_t error = drive_homes(axis) ? CM1E_ERROR_AXIS_HOMING
                                           : cm1e_homing_step_check(axis, command->step, &move);
    if (error == CM1E_OK)
        error = cm1e_homing_step_prepare(axis, command->step, &move, &next, &profile);
    if (error != CM1E_OK)
        return error;
    cm1e_axis_commands_end(axis, CM1E_COMMAND_ABORTED, CM1E_OK);
    *id = cm1e_axis_next_id(axis);
    cm1e_axis_activate_homing(axis, *id, command->kind);
    cm1e_homing_step_run(axis, &next, &profile);
    return CM1E_OK;
}

/* ---- buffered ---------------------------------------------------------------------------------------------------- */

cm1e_error_t cm1e_homing_begin(cm1e_axis_t *axis, move_t *move, const from_t *from, double late_s)
{
    (void)from; /* a homing begins at rest */
    (void)late_s;
    const waiting_homing_t *waiting = &axis->homing->waiting;
    const cm1e_axis_command_t command = {
        .kind = (cm1e_command_kind_t)move->kind,
        .position = move->position,
        .homing = waiting->configured ? NULL : &waiting->config,
    };
    const cm1e_error_t error = cm1e_homing_prepare(axis, &command);
    if (error != CM1E_OK)
        return error;
    cm1e_axis_activate_homing(axis, move->id, command.kind);
    cm1e_homing_run(axis);
    return CM1E_OK;
}

/* Keeps the parameters of a waiting homing. There is one place, because only one homing can wait. */
static cm1e_error_t keep_homing(cm1e_axis_t *axis, const cm1e_axis_command_t *command)
{
    for (int i = 0; i < axis->commands.waiting.count; i++)
        if (waiting_move(axis, i)->kind == CM1E_COMMAND_HOME)
            return CM1E_ERROR_BUSY;
    if (!drive_homes(axis)) {
        const cm1e_error_t error = cm1e_homing_prepare(axis, command);
        if (error != CM1E_OK)
            return error;
    }
    axis->homing->waiting.configured = command->homing == NULL;
    if (command->homing)
        axis->homing->waiting.config = *command->homing;
    return CM1E_OK;
}

static waiting_step_t *step_of(cm1e_axis_t *axis, cm1e_command_id_t id)
{
    for (int i = 0; i < STEPS_WAITING; i++)
        if (axis->homing->waiting_steps[i].id == id)
            return &axis->homing->waiting_steps[i];
    return NULL;
}

cm1e_error_t cm1e_homing_step_begin(cm1e_axis_t *axis, move_t *move, const from_t *from, double late_s)
{
    (void)from; /* a step begins at the present set-point */
    (void)late_s;
    stepping_t next;
    cm1e_profile_t profile;
    const waiting_step_t *waiting = step_of(axis, move->id);
    const cm1e_error_t error = waiting ? cm1e_homing_step_prepare(axis, &waiting->step, move, &next, &profile)
                                       : CM1E_ERROR_AXIS_STATE;
    if (error != CM1E_OK)
        return error;
    cm1e_axis_activate_homing(axis, move->id, CM1E_COMMAND_HOMING_STEP);
    cm1e_homing_step_run(axis, &next, &profile);
    return CM1E_OK;
}

static waiting_step_t *free_step(cm1e_axis_t *axis)
{
    for (int i = 0; i < STEPS_WAITING; i++)
        if (!cm1e_axis_find_waiting(axis, axis->homing->waiting_steps[i].id))
            return &axis->homing->waiting_steps[i];
    return NULL;
}

cm1e_error_t cm1e_homing_step_buffer(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id)
{
    move_t move = cm1e_axis_move_of(command);
    waiting_step_t *place = free_step(axis);
    cm1e_error_t error = cm1e_homing_step_check(axis, command->step, &move);
    if (error == CM1E_OK)
        error = place ? cm1e_axis_buffer(axis, &move) : CM1E_ERROR_FULL;
    if (error == CM1E_OK)
        *place = (waiting_step_t){.id = *id = move.id, .step = *command->step};
    return error;
}

cm1e_error_t cm1e_homing_buffer(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id)
{
    const cm1e_error_t error = keep_homing(axis, command);
    return error != CM1E_OK ? error : cm1e_axis_buffer_move(axis, command, id);
}
