/* Commands of followers: those that begin at once, those that wait, and those that wait for their master. */
#include "axis/axis_commands.h"
#include "axis/axis_limits.h"
#include "axis/axis_plan.h"
#include "axis/axis_setpoint.h"
#include "coupling/coupling_private.h"

typedef cm1e_error_t prepare_t(cm1e_axis_t *axis, const move_t *move, const cm1e_axis_coupling_t *coupling,
                               const from_t *from);

static prepare_t *const preparers[CM1E_COMMAND_KIND_COUNT] = {
    [CM1E_COMMAND_GEAR_IN] = cm1e_gear_prepare,
    [CM1E_COMMAND_GEAR_IN_POS] = cm1e_gear_in_pos_prepare,
    [CM1E_COMMAND_CAM_IN] = cm1e_cam_in_prepare,
    [CM1E_COMMAND_COMBINE_AXES] = cm1e_gear_prepare,
};

/* What can be said of the command without its numbers. */
static cm1e_error_t check(const cm1e_axis_t *axis, const cm1e_axis_command_t *command)
{
    if (!command->coupling)
        return CM1E_ERROR_INVALID_ARGUMENT;
    return coupling_can(axis, command->kind) ? CM1E_OK : CM1E_ERROR_AXIS_NO_COUPLINGS;
}

/* Whether plans are possible with any motion within such a number (motion/profile.h). */
static bool is_of_usual_size(double number) { return number >= 1e-15 && number <= 1e15; }

/* Refuses limits that are too small to compute with. What the masters do when the command begins does not matter. */
static cm1e_error_t check_size(const cm1e_axis_t *axis, const cm1e_motion_limits_t *asked)
{
    const double most = axis->limits.maximum.velocity;
    if (is_of_usual_size(2.0 * most) && is_of_usual_size(asked->acceleration) &&
        is_of_usual_size(asked->deceleration) && is_of_usual_size(asked->jerk))
        return CM1E_OK;
    const cm1e_motion_state_t fastest = {.velocity = most};
    const cm1e_motion_limits_t limits = {2.0 * most, asked->acceleration, asked->deceleration, asked->jerk};
    cm1e_profile_t profile;
    if (cm1e_profile_to_velocity(&profile, &fastest, 0.0, &limits) != CM1E_OK)
        return CM1E_ERROR_AXIS_DYNAMICS_RANGE;
    return CM1E_OK;
}

static cm1e_error_t prepare(cm1e_axis_t *axis, const move_t *move, const cm1e_axis_coupling_t *coupling,
                            const from_t *from, cm1e_motion_limits_t *limits)
{
    cm1e_error_t error = cm1e_axis_limits_of(axis, from, move, limits);
    if (error == CM1E_OK)
        error = check_size(axis, limits);
    return error != CM1E_OK ? error : preparers[move->kind](axis, move, coupling, from);
}

static void take(cm1e_axis_t *axis, const move_t *move, const cm1e_axis_coupling_t *coupling, follow_t *follow,
                 const from_t *from, const cm1e_motion_limits_t *limits)
{
    cm1e_axis_command_end(axis, CM1E_COMMAND_ABORTED, CM1E_OK);
    cm1e_axis_activate(axis, move);
    axis->coupling->inputs = *coupling;
    cm1e_axis_set_ends(axis, 0);
    cm1e_coupling_follow(axis, follow, from, limits);
}

static bool same_master(const cm1e_coupling_master_t *a, const cm1e_coupling_master_t *b)
{
    return a->axis.Handle == b->axis.Handle && a->source == b->source && a->numerator == b->numerator &&
           a->denominator == b->denominator;
}

static bool same_inputs(const cm1e_axis_coupling_t *a, const cm1e_axis_coupling_t *b)
{
    return same_master(&a->master[0], &b->master[0]) && same_master(&a->master[1], &b->master[1]) &&
           a->combine == b->combine && a->master_sync_position == b->master_sync_position &&
           a->slave_sync_position == b->slave_sync_position && a->master_start_distance == b->master_start_distance &&
           a->sync_mode == b->sync_mode && a->cam == b->cam && a->start_mode == b->start_mode &&
           a->master_offset == b->master_offset && a->slave_offset == b->slave_offset &&
           a->master_scaling == b->master_scaling && a->slave_scaling == b->slave_scaling;
}

/* Whether changed inputs of this command begin a new coupling at the present set-point. */
static bool begins_anew(cm1e_command_kind_t kind)
{
    return kind == CM1E_COMMAND_GEAR_IN || kind == CM1E_COMMAND_COMBINE_AXES;
}

static cm1e_error_t update_active(cm1e_axis_t *axis, const cm1e_axis_command_t *command)
{
    coupling_t *c = axis->coupling;
    const from_t from = from_base(axis);
    move_t move = cm1e_axis_move_of(command);
    cm1e_motion_limits_t limits;
    if (axis_follows(axis) && command->kind == axis->commands.kind && command->kind == CM1E_COMMAND_CAM_IN)
        return cm1e_cam_in_update(axis, command->coupling);
    if (!axis_follows(axis) || command->kind != axis->commands.kind || !begins_anew(command->kind))
        return CM1E_ERROR_INVALID_ARGUMENT;
    if (cm1e_axis_same_inputs(&axis->commands.move, &move) && same_inputs(&c->inputs, command->coupling))
        return CM1E_OK;
    const cm1e_error_t error = prepare(axis, &move, command->coupling, &from, &limits);
    if (error != CM1E_OK)
        return error;
    move.id = axis->commands.move.id;
    cm1e_axis_activate(axis, &move);
    c->inputs = *command->coupling;
    cm1e_coupling_follow(axis, cm1e_coupling_spare(axis), &from, &limits);
    return CM1E_OK;
}

/* ---- those that wait --------------------------------------------------------------------------------------------- */

static waiting_coupling_t *waiting_of(cm1e_axis_t *axis, cm1e_command_id_t id)
{
    for (int i = 0; i < COUPLINGS_WAITING; i++)
        if (axis->coupling->waiting[i].id == id)
            return &axis->coupling->waiting[i];
    return NULL;
}

static waiting_coupling_t *free_place(cm1e_axis_t *axis)
{
    for (int i = 0; i < COUPLINGS_WAITING; i++)
        if (!cm1e_axis_find_waiting(axis, axis->coupling->waiting[i].id))
            return &axis->coupling->waiting[i];
    return NULL;
}

/* Takes a coupling whose approach begins later. The active command goes on until the master is at that place; waiting
 * commands are aborted. */
static void take_later(cm1e_axis_t *axis, move_t *move, const cm1e_axis_coupling_t *coupling, follow_t *follow)
{
    cm1e_axis_waiting_end(axis, CM1E_COMMAND_ABORTED);
    move->id = cm1e_axis_next_id(axis);
    *free_place(axis) = (waiting_coupling_t){move->id, *coupling};
    cm1e_axis_append_waiting(axis, move);
    cm1e_coupling_await(axis, follow);
}

cm1e_error_t cm1e_coupling_start(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id)
{
    const from_t from = from_set(axis);
    move_t move = cm1e_axis_move_of(command);
    cm1e_motion_limits_t limits;
    cm1e_error_t error = check(axis, command);
    if (error == CM1E_OK)
        error = prepare(axis, &move, command->coupling, &from, &limits);
    if (error != CM1E_OK)
        return error;
    follow_t *follow = cm1e_coupling_spare(axis);
    if (follow->approach.awaited) {
        take_later(axis, &move, command->coupling, follow);
        *id = move.id;
        return CM1E_OK;
    }
    cm1e_axis_commands_end(axis, CM1E_COMMAND_ABORTED, CM1E_OK);
    *id = move.id = cm1e_axis_next_id(axis);
    take(axis, &move, command->coupling, follow, &from, &limits);
    return CM1E_OK;
}

/* ---- buffered ---------------------------------------------------------------------------------------------------- */

/* Buffers a coupling. It gets its place before it waits, because it may be able to begin at once. */
cm1e_error_t cm1e_coupling_buffer(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id)
{
    move_t move = cm1e_axis_move_of(command);
    cm1e_error_t error = check(axis, command);
    if (error != CM1E_OK)
        return error;
    waiting_coupling_t *place = free_place(axis);
    if (!place)
        return CM1E_ERROR_FULL;
    *place = (waiting_coupling_t){axis->commands.last_id + 1 ? axis->commands.last_id + 1 : 1, *command->coupling};
    error = cm1e_axis_buffer(axis, &move);
    if (error != CM1E_OK)
        place->id = 0; /* the number will belong to another command */
    else
        *id = move.id;
    return error;
}

/* The state at the end of the previous command, moved on by its velocity to the present set-point. */
static from_t at_present(const cm1e_axis_t *axis, const from_t *from, double late_s)
{
    from_t here = *from;
    here.position = cm1e_position_plus(from->position, from->velocity * late_s * axis->position.scale);
    return here;
}

bool cm1e_coupling_awaits(cm1e_axis_t *axis, const from_t *from, double late_s)
{
    coupling_t *c = axis->coupling;
    if (axis->coupling->awaited)
        return !c->due;
    const move_t move = move_of_waiting(waiting_move(axis, 0));
    const waiting_coupling_t *waiting = waiting_of(axis, move.id);
    const from_t here = at_present(axis, from, late_s);
    follow_t *follow = cm1e_coupling_spare(axis);
    cm1e_motion_limits_t limits;
    if (!waiting || prepare(axis, &move, &waiting->coupling, &here, &limits) != CM1E_OK || !follow->approach.awaited)
        return false;
    cm1e_coupling_await(axis, follow);
    return true;
}

/* Begins an awaited coupling, with the place that it got when the wait began. */
static cm1e_error_t begin_awaited(cm1e_axis_t *axis, const move_t *move, const cm1e_axis_coupling_t *coupling,
                                  const from_t *from)
{
    coupling_t *c = axis->coupling;
    cm1e_motion_limits_t limits;
    cm1e_error_t error = c->due_error != CM1E_OK ? c->due_error : cm1e_axis_limits_of(axis, from, move, &limits);
    if (error == CM1E_OK)
        error = cm1e_coupling_approach_begin(axis, axis->coupling->awaited, move, from);
    if (error != CM1E_OK)
        cm1e_coupling_await_nothing(axis);
    else
        take(axis, move, coupling, axis->coupling->awaited, from, &limits);
    return error;
}

/* The coupling begins at the present set-point. */
cm1e_error_t cm1e_coupling_begin(cm1e_axis_t *axis, move_t *move, const from_t *from, double late_s)
{
    const waiting_coupling_t *waiting = waiting_of(axis, move->id);
    const from_t here = at_present(axis, from, late_s);
    cm1e_motion_limits_t limits;
    if (waiting && axis->coupling->awaited)
        return begin_awaited(axis, move, &waiting->coupling, &here);
    axis->coupling->at_end = axis_follows(axis) && axis->coupling->end_of_profile;
    const cm1e_error_t error = waiting ? prepare(axis, move, &waiting->coupling, &here, &limits)
                                       : CM1E_ERROR_AXIS_STATE;
    axis->coupling->at_end = false;
    if (error == CM1E_OK)
        take(axis, move, &waiting->coupling, cm1e_coupling_spare(axis), &here, &limits);
    return error;
}

cm1e_error_t cm1e_coupling_update(cm1e_axis_t *axis, cm1e_command_id_t id, const cm1e_axis_command_t *command)
{
    if (!command->coupling)
        return CM1E_ERROR_INVALID_ARGUMENT;
    if (id == axis->commands.active)
        return update_active(axis, command);
    waiting_t *waiting = cm1e_axis_find_waiting(axis, id);
    if (!waiting)
        return CM1E_OK; /* the command has ended */
    if (waiting->kind != (uint8_t)command->kind || command->kind == CM1E_COMMAND_GEAR_IN_POS)
        return CM1E_ERROR_INVALID_ARGUMENT;
    if (waiting == waiting_move(axis, 0) && axis->coupling->awaited)
        return CM1E_OK; /* it has a place already, and waits for its master alone */
    move_t move = cm1e_axis_move_of(command);
    move.id = id;
    move.buffer_mode = waiting->buffer_mode;
    *waiting = waiting_of_move(&move);
    waiting_of(axis, id)->coupling = *command->coupling;
    return CM1E_OK;
}
