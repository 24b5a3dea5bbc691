/**
 * @file axis_commands.h
 * The commands of an axis: the active one, those that wait, what became of the last ones.
 */
#ifndef CM1E_AXIS_AXIS_COMMANDS_H
#define CM1E_AXIS_AXIS_COMMANDS_H

#include "axis/axis_parts.h"

/** A step is the active command. */
static inline bool axis_stepping(const cm1e_axis_t *axis)
{
    return axis->commands.active != 0 && axis->commands.kind == CM1E_COMMAND_HOMING_STEP;
}
/** A command moves it: a single motion, or a continuous one. */
static inline bool axis_moves_by_command(const cm1e_axis_t *axis)
{
    const bool moving = axis->state == CM1E_AXIS_DISCRETE_MOTION || axis->state == CM1E_AXIS_CONTINUOUS_MOTION;
    return moving && ((axis->commands.active && axis->commands.kind != CM1E_COMMAND_HALT) || axis->superimposed.id);
}
/** It becomes the active command; cm1e_axis_command_end() has ended the one before. */
static inline void cm1e_axis_activate(cm1e_axis_t *axis, const move_t *move)
{
    axis->commands.active = move->id;
    axis->commands.kind = (cm1e_command_kind_t)move->kind;
    axis->commands.move = *move;
}
/** Of a homing, which is no move. */
static inline void cm1e_axis_activate_homing(cm1e_axis_t *axis, cm1e_command_id_t id, cm1e_command_kind_t kind)
{
    axis->commands.active = id;
    axis->commands.kind = kind;
}
/** Its position lies behind now. */
static inline void cm1e_axis_set_passing(cm1e_axis_t *axis) { axis->commands.move.passing = true; }
/** It began and ends so many counts farther on. */
static inline void cm1e_axis_shift_move(cm1e_axis_t *axis, double counts)
{
    axis->commands.move.origin = cm1e_position_plus(axis->commands.move.origin, counts);
    axis->commands.move.target = cm1e_position_plus(axis->commands.move.target, counts);
}
/** The first waiting command awaits a place of its master. */
static inline void cm1e_axis_set_awaits(cm1e_axis_t *axis, bool awaits) { axis->commands.awaits = awaits; }
/** Why a command was refused, for the text; CM1E_OK: none was. */
static inline void cm1e_axis_set_refusal(cm1e_axis_t *axis, cm1e_error_t error) { axis->commands.refusal = error; }
/** The first of those that wait is 0. */
static inline move_t *waiting_move(cm1e_axis_t *axis, int index)
{
    return &axis->commands.waiting.moves[(axis->commands.waiting.first + index) % CM1E_AXIS_BUFFER_DEPTH];
}
/** There is room for it. */
static inline void cm1e_axis_append_waiting(cm1e_axis_t *axis, const move_t *move)
{
    *waiting_move(axis, axis->commands.waiting.count++) = *move;
}
/** Of a room above the axis, or its own; without `start`: the axis cannot do it. */
static inline const command_method_t *cm1e_axis_method(const cm1e_axis_t *axis, command_plan_t plan)
{
    const command_method_t *coupling = axis->coupling_hooks ? &axis->coupling_hooks->methods[plan] : NULL;
    const command_method_t *homing = axis->homing_hooks ? &axis->homing_hooks->methods[plan] : NULL;
    return coupling && coupling->start ? coupling : homing && homing->start ? homing : &axis->events->methods[plan];
}

/* axis_method.c */
extern const command_method_t cm1e_axis_methods[]; /**< by command_plan_t; of the axis itself */

/* axis_command.c, axis_record.c, axis_replan.c */
/** Of a command or an update, for the text: what was refused last is told. CM1E_OK: it was accepted. */
void cm1e_axis_remember_refusal(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_error_t error);
/** The active command ends; those that wait are for cm1e_axis_begin_waiting(). */
void cm1e_axis_command_end(cm1e_axis_t *axis, cm1e_command_state_t state, cm1e_error_t error);
/** All end, the waiting ones with CM1E_ERROR_AXIS_ERROR_STOP where `state` is an error. */
void cm1e_axis_waiting_end(cm1e_axis_t *axis, cm1e_command_state_t state);
void cm1e_axis_commands_end(cm1e_axis_t *axis, cm1e_command_state_t state, cm1e_error_t error);
/** For the text: one that was taken ended with this error. That of ErrorStop is told by the axis's own. */
void cm1e_axis_remember_end(cm1e_axis_t *axis, cm1e_command_kind_t kind, cm1e_error_t error);
void cm1e_axis_record(cm1e_axis_t *axis, cm1e_command_id_t id, cm1e_command_state_t state, cm1e_error_t error);
cm1e_command_id_t cm1e_axis_next_id(cm1e_axis_t *axis);
/** A command that has been planned becomes the active one; the one before, if any, is aborted. */
void cm1e_axis_take(cm1e_axis_t *axis, const move_t *move, const from_t *from, const cm1e_profile_t *profile,
                    double offset_s);
/** A command has begun: the state diagram follows it. */
void cm1e_axis_taken(cm1e_axis_t *axis, const command_kind_t *kind);
cm1e_error_t cm1e_axis_start_move(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id);
cm1e_error_t cm1e_axis_buffer_move(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id);

/* axis_buffer.c, axis_look_ahead.c, axis_replan.c */
/** The waiting command of that number; NULL: none. */
move_t *cm1e_axis_find_waiting(cm1e_axis_t *axis, cm1e_command_id_t id);
/** Takes it in behind the others and gives it its number. */
cm1e_error_t cm1e_axis_buffer(cm1e_axis_t *axis, move_t *move);
/** A waiting command with this number, if there is one, gets these inputs. */
cm1e_error_t cm1e_axis_update_waiting(cm1e_axis_t *axis, const move_t *move);
/** MC_SetPosition: whether the targets of those that wait, as far as they are known, keep these software limits (u). */
bool cm1e_axis_waiting_hold(cm1e_axis_t *axis, double lower, double upper);
/** The coordinates have been shifted by so much: those that wait end where they were to. FALSE: their limits are such
 *  now that the motion that runs would have to come slower to its end, and cannot. Nothing has changed then. */
bool cm1e_axis_shift_waiting(cm1e_axis_t *axis, double shift);
/** The velocity with which a move that begins there shall pass its target, for the sake of those that wait. */
double cm1e_axis_exit_velocity(cm1e_axis_t *axis, const from_t *from, const move_t *move);
cm1e_error_t cm1e_axis_begin_move(cm1e_axis_t *axis, move_t *move, const from_t *from, double late_s);
/** The first waiting command that can begin there does; those before it fail. FALSE: none could. Motions call
 *  cm1e_axis_begin_waiting(). */
bool cm1e_axis_begin_next(cm1e_axis_t *axis, const from_t *from, double offset_s);
/** Whether the active command is one that is planned anew where something changes. */
bool cm1e_axis_can_replan(const cm1e_axis_t *axis);
/** Something that the active command's profile depends on has changed: it is planned anew from the present set-point.
 *  Where that is refused, it goes on as it was. */
cm1e_error_t cm1e_axis_replan(cm1e_axis_t *axis);
/** As cm1e_axis_replan(). false, and nothing has changed: it is refused, or it would run over its target. */
bool cm1e_axis_replan_if(cm1e_axis_t *axis);
/** As cm1e_axis_replan(), with other inputs, which are in force if it is not refused. */
cm1e_error_t cm1e_axis_replan_as(cm1e_axis_t *axis, const move_t *move);

/* axis_record.c */
bool cm1e_axis_same_way(const move_t *a, const move_t *b);
bool cm1e_axis_same_inputs(const move_t *a, const move_t *b);
move_t cm1e_axis_move_of(const cm1e_axis_command_t *command);
cm1e_error_t cm1e_axis_update_move(cm1e_axis_t *axis, cm1e_command_id_t id, const cm1e_axis_command_t *command);

#endif
