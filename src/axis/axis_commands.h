/**
 * @file axis_commands.h
 * The commands of an axis: the active one, the waiting ones, and the results of the last ones.
 */
#ifndef CM1E_AXIS_AXIS_COMMANDS_H
#define CM1E_AXIS_AXIS_COMMANDS_H

#include "axis/axis_course.h"

/** Whether a step of a homing is the active command. */
static inline bool axis_stepping(const cm1e_axis_t *axis)
{
    return axis->commands.active != 0 && axis->commands.kind == CM1E_COMMAND_HOMING_STEP;
}
/** Whether a command moves the axis, in a discrete or a continuous motion. */
static inline bool axis_moves_by_command(const cm1e_axis_t *axis)
{
    const bool moving = axis->state == CM1E_AXIS_DISCRETE_MOTION || axis->state == CM1E_AXIS_CONTINUOUS_MOTION;
    return moving && ((axis->commands.active && axis->commands.kind != CM1E_COMMAND_HALT) || axis->superimposed.id);
}
/** Makes a move the active command. cm1e_axis_command_end() has ended the one before. */
static inline void cm1e_axis_activate(cm1e_axis_t *axis, const move_t *move)
{
    axis->commands.active = move->id;
    axis->commands.kind = (cm1e_command_kind_t)move->kind;
    axis->commands.lowered = false;
    axis->commands.move = *move;
}
/** Makes a homing the active command. */
static inline void cm1e_axis_activate_homing(cm1e_axis_t *axis, cm1e_command_id_t id, cm1e_command_kind_t kind)
{
    axis->commands.active = id;
    axis->commands.kind = kind;
}
/** The active move has passed its position. */
static inline void cm1e_axis_set_passing(cm1e_axis_t *axis) { axis->commands.move.passing = true; }
/** Shifts the begin and the end of the active move by so many counts. */
static inline void cm1e_axis_shift_move(cm1e_axis_t *axis, double counts)
{
    axis->commands.move.origin = cm1e_position_plus(axis->commands.move.origin, counts);
    axis->commands.move.target = cm1e_position_plus(axis->commands.move.target, counts);
}
/** Remembers why a command was refused, for the text; CM1E_OK: none was. */
static inline void cm1e_axis_set_refusal(cm1e_axis_t *axis, cm1e_error_t error) { axis->commands.refusal = error; }
/** A waiting command as a move. */
static inline move_t move_of_waiting(const waiting_t *w)
{
    return (move_t){.id = w->id, .kind = w->kind, .buffer_mode = w->buffer_mode, .direction = w->direction,
                    .position = w->position, .velocity = w->velocity, .end_velocity = w->end_velocity,
                    .acceleration = w->acceleration, .deceleration = w->deceleration, .jerk = w->jerk,
                    .shift = w->shift, .target = w->target};
}
/** A move that has not begun, as it waits. */
static inline waiting_t waiting_of_move(const move_t *move)
{
    return (waiting_t){.id = move->id, .kind = move->kind, .buffer_mode = move->buffer_mode,
                       .direction = move->direction, .position = move->position, .velocity = move->velocity,
                       .end_velocity = move->end_velocity, .acceleration = move->acceleration,
                       .deceleration = move->deceleration, .jerk = move->jerk, .shift = move->shift,
                       .target = move->target};
}
/** A waiting command; 0 is the first one. */
static inline waiting_t *waiting_move(cm1e_axis_t *axis, int index)
{
    return &axis->commands.waiting.moves[(axis->commands.waiting.first + index) % CM1E_AXIS_BUFFER_DEPTH];
}
/** Appends a waiting command. The caller has checked that there is room. */
static inline void cm1e_axis_append_waiting(cm1e_axis_t *axis, const move_t *move)
{
    *waiting_move(axis, axis->commands.waiting.count++) = waiting_of_move(move);
    cm1e_axis_look_anew(axis);
}
/** The method of a kind of plan, from the axis or a room above it. Without `start` the axis cannot do it. */
static inline const command_method_t *cm1e_axis_method(const cm1e_axis_t *axis, command_plan_t plan)
{
    const command_method_t *coupling = axis->coupling_hooks ? &axis->coupling_hooks->methods[plan] : NULL;
    const command_method_t *homing = axis->homing_hooks ? &axis->homing_hooks->methods[plan] : NULL;
    return coupling && coupling->start ? coupling : homing && homing->start ? homing : &axis->events->methods[plan];
}

/* axis_method.c */
extern const command_method_t cm1e_axis_methods[]; /**< methods of the axis itself, by command_plan_t */

/* axis_command.c, axis_record.c, axis_replan.c */
/** Remembers the refusal of a command or an update, for the text. CM1E_OK: it was accepted. */
void cm1e_axis_remember_refusal(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_error_t error);
/** Ends the active command. cm1e_axis_begin_waiting() begins the next one. */
void cm1e_axis_command_end(cm1e_axis_t *axis, cm1e_command_state_t state, cm1e_error_t error);
/** Ends all waiting commands; with CM1E_ERROR_AXIS_ERROR_STOP if `state` is an error. */
void cm1e_axis_waiting_end(cm1e_axis_t *axis, cm1e_command_state_t state);
void cm1e_axis_commands_end(cm1e_axis_t *axis, cm1e_command_state_t state, cm1e_error_t error);
/** Remembers for the text that an accepted command ended with this error. The error of ErrorStop has its own text. */
void cm1e_axis_remember_end(cm1e_axis_t *axis, cm1e_command_kind_t kind, cm1e_error_t error);
void cm1e_axis_record(cm1e_axis_t *axis, cm1e_command_id_t id, cm1e_command_state_t state, cm1e_error_t error);
cm1e_command_id_t cm1e_axis_next_id(cm1e_axis_t *axis);
/** Makes a planned command the active one, and aborts the one before. */
void cm1e_axis_take(cm1e_axis_t *axis, const move_t *move, const from_t *from, const cm1e_profile_t *profile,
                    double offset_s);
/** Sets the state of the diagram for a command that has begun. */
void cm1e_axis_taken(cm1e_axis_t *axis, const command_kind_t *kind);
cm1e_error_t cm1e_axis_start_move(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id);
cm1e_error_t cm1e_axis_buffer_move(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id);

/* axis_buffer.c, axis_look_ahead.c, axis_replan.c */
/** The waiting command with a number; NULL: none. */
waiting_t *cm1e_axis_find_waiting(cm1e_axis_t *axis, cm1e_command_id_t id);
/** Buffers a move behind the others and gives it its number. */
cm1e_error_t cm1e_axis_buffer(cm1e_axis_t *axis, move_t *move);
/** Gives new inputs to the waiting command with this number, if there is one. */
cm1e_error_t cm1e_axis_update_waiting(cm1e_axis_t *axis, const move_t *move);
/** MC_SetPosition: whether the known targets of the waiting commands keep these software limits (u). */
bool cm1e_axis_waiting_hold(cm1e_axis_t *axis, double lower, double upper);
/** Shifts the targets of waiting commands with the coordinates, so that they end at the same places. false, and nothing
 *  has changed: by the limits there, the present motion would have to reach its end slower, and it cannot. */
bool cm1e_axis_shift_waiting(cm1e_axis_t *axis, double shift);
/** A maximum value was lowered: a command that is entered with a velocity planned before may need the earlier one. */
void cm1e_axis_maximum_lowered(cm1e_axis_t *axis);
/** The velocity with which a move that begins at `from` has to pass its target, as the waiting commands need it. */
double cm1e_axis_exit_velocity(cm1e_axis_t *axis, const from_t *from, const move_t *move);
cm1e_error_t cm1e_axis_begin_move(cm1e_axis_t *axis, move_t *move, const from_t *from, double late_s);
/** Begins the first waiting command that can begin at `from`. The commands before it fail. false: none could begin.
 *  Motions call cm1e_axis_begin_waiting(). */
bool cm1e_axis_begin_next(cm1e_axis_t *axis, const from_t *from, double offset_s);
/** Whether the active command can be planned anew. */
bool cm1e_axis_can_replan(const cm1e_axis_t *axis);
/** Plans the active command anew from the present set-point, because something has changed on which its profile
 *  depends. If the new plan is refused, the motion goes on as before. */
cm1e_error_t cm1e_axis_replan(cm1e_axis_t *axis);
/** Like cm1e_axis_replan(). false, and nothing has changed: the plan is refused, or would overrun the target. */
bool cm1e_axis_replan_if(cm1e_axis_t *axis);
/** Like cm1e_axis_replan(), with other inputs. They are in force if the plan is not refused. */
cm1e_error_t cm1e_axis_replan_as(cm1e_axis_t *axis, const move_t *move);
/** Like cm1e_axis_replan(), after the set-point has changed by a step, so that the present profile is of no use. */
cm1e_error_t cm1e_axis_replan_anew(cm1e_axis_t *axis);

/* axis_record.c */
bool cm1e_axis_same_way(const move_t *a, const move_t *b);
bool cm1e_axis_same_inputs(const move_t *a, const move_t *b);
move_t cm1e_axis_move_of(const cm1e_axis_command_t *command);
cm1e_error_t cm1e_axis_update_move(cm1e_axis_t *axis, cm1e_command_id_t id, const cm1e_axis_command_t *command);

#endif
