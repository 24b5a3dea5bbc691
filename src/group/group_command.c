/* Commands of a group: what function blocks may request in which state, where it leads, and how it starts. */
#include "group/group_private.h"

/* ---- what a command asks for ------------------------------------------------------------------------------------- */

static cm1e_error_t refuse(cm1e_group_t *group, cm1e_error_t error, double value, const char *why)
{
    return cm1e_group_refuse(group, (group_refusal_t){.error = error, .value = value, .why = why});
}

static bool is_move(cm1e_group_kind_t kind) { return kind < CM1E_GROUP_HALT; }
static bool is_circle(cm1e_group_kind_t kind)
{
    return kind == CM1E_GROUP_CIRCULAR_ABSOLUTE || kind == CM1E_GROUP_CIRCULAR_RELATIVE;
}
static bool is_relative(cm1e_group_kind_t kind)
{
    return kind == CM1E_GROUP_LINEAR_RELATIVE || kind == CM1E_GROUP_CIRCULAR_RELATIVE;
}
static bool is_blending(const cm1e_group_command_t *command) { return command->buffer_mode >= mcBlendingLow; }

static bool is_limit(double value) { return value >= 0.0 && isfinite(value); }

static cm1e_error_t check_modes(cm1e_group_t *group, const cm1e_group_command_t *command)
{
    if ((unsigned)command->buffer_mode > mcBlendingHigh)
        return refuse(group, CM1E_ERROR_AXIS_BUFFER_MODE, 0.0, "BufferMode is 0 (mcAborting) ... 5 (mcBlendingHigh).");
    if (command->kind == CM1E_GROUP_HALT)
        return is_blending(command) ? refuse(group, CM1E_ERROR_AXIS_BUFFER_MODE, 0.0,
                                             "MC_GroupHalt supports only mcAborting and mcBuffered.") : CM1E_OK;
    if (command->coordinates != mcACS)
        return refuse(group, CM1E_ERROR_GROUP_COORD_SYSTEM, 0.0, NULL);
    if (command->transition != mcTMNone && command->transition != mcTMCornerDistance &&
        command->transition != mcTMMaxCornerDeviation)
        return refuse(group, CM1E_ERROR_GROUP_TRANSITION, 0.0,
                      "Supported are mcTMNone, mcTMCornerDistance and mcTMMaxCornerDeviation.");
    if (is_blending(command) && command->transition != mcTMNone &&
        !(command->transition_parameter > 0.0 && isfinite(command->transition_parameter)))
        return refuse(group, CM1E_ERROR_GROUP_TRANSITION, command->transition_parameter,
                      "TransitionParameter must be above 0: the distance in u before the corner, or from it.");
    if (is_circle(command->kind) && command->circ_mode != mcBorder && command->circ_mode != mcCenter)
        return refuse(group, CM1E_ERROR_UNSUPPORTED, 0.0, "CircMode must be mcBorder or mcCenter.");
    if (is_circle(command->kind) && command->path_choice != mcClockwise && command->path_choice != mcCounterClockwise)
        return refuse(group, CM1E_ERROR_INVALID_ARGUMENT, 0.0, "PathChoice must be mcClockwise or mcCounterClockwise.");
    return CM1E_OK;
}

static cm1e_error_t check(cm1e_group_t *group, const cm1e_group_command_t *command)
{
    if (is_move(command->kind) && !is_limit(command->velocity))
        return refuse(group, CM1E_ERROR_AXIS_VELOCITY_RANGE, command->velocity,
                      "It must be 0 (as much as the axes allow) or above.");
    if ((is_move(command->kind) && !is_limit(command->acceleration)) || !is_limit(command->deceleration) ||
        !is_limit(command->jerk))
        return refuse(group, CM1E_ERROR_AXIS_DYNAMICS_RANGE, 0.0,
                      "Acceleration, Deceleration and Jerk must be 0 (as much as the axes allow) or above.");
    return command->kind >= CM1E_GROUP_STOP ? CM1E_OK : check_modes(group, command);
}

/* ---- where it goes ----------------------------------------------------------------------------------------------- */

/* The repetition of a modulo position that is closest to the end of the path. */
static bool on_the_line(const cm1e_axis_t *axis, double from, double *position)
{
    const double range = cm1e_axis_configuration(axis)->modulo_range;
    if (!(range > 0.0))
        return true;
    if (!(*position >= 0.0 && *position < range))
        return false;
    *position = from + remainder(*position - from, range);
    return true;
}

/* Target and auxiliary point in the coordinates of the path. Relative positions count from `origin`. */
static cm1e_error_t resolve(cm1e_group_t *group, const cm1e_group_command_t *command, const double *origin,
                            double *target, double *auxiliary)
{
    double end[CM1E_PATH_AXES];
    cm1e_path_end(&group->path, end);
    for (int i = 0; i < group->axes; i++) {
        const uint32_t ident = group->ident[i];
        const cm1e_axis_t *axis = cm1e_group_axis(group, ident);
        const double add = is_relative(command->kind) ? origin[i] : 0.0;
        target[i] = add + command->position[ident - 1];
        auxiliary[i] = add + command->auxiliary[ident - 1];
        const bool turns = axis && cm1e_axis_configuration(axis)->modulo_range > 0.0;
        if (turns && is_circle(command->kind) && i < CM1E_PATH_SPACE)
            return cm1e_group_refuse(group, (group_refusal_t){.error = CM1E_ERROR_GROUP_PATH, .ident = ident,
                                                              .why = "A circle needs linear axes."});
        if (turns && !is_relative(command->kind) && !on_the_line(axis, end[i], &target[i]))
            return cm1e_group_refuse(group, (group_refusal_t){.error = CM1E_ERROR_GROUP_PATH, .ident = ident,
                                                              .value = target[i],
                                                              .why = "It is outside the range of this modulo axis."});
    }
    return CM1E_OK;
}

/* MC_Power may permit one direction only. */
static void bar_directions(const cm1e_group_t *group, cm1e_path_command_t *way)
{
    for (int i = 0; i < group->axes; i++) {
        const cm1e_axis_t *axis = cm1e_group_axis(group, group->ident[i]);
        way->not_up |= axis && !cm1e_axis_may_go(axis, true) ? 1u << i : 0;
        way->not_down |= axis && !cm1e_axis_may_go(axis, false) ? 1u << i : 0;
    }
}

static cm1e_error_t refuse_path(cm1e_group_t *group, cm1e_error_t error, const cm1e_path_problem_t *problem)
{
    if (problem->refusal == CM1E_PATH_WRONG_WAY)
        return cm1e_group_refuse(group, (group_refusal_t){.error = error, .ident = group->ident[problem->axis]});
    group_refusal_t refusal = {.error = error == CM1E_ERROR_FULL ? CM1E_ERROR_FULL : CM1E_ERROR_GROUP_PATH,
                               .path = problem->refusal, .value = problem->position};
    if (problem->refusal == CM1E_PATH_OUT_OF_BOUNDS) {
        refusal.ident = group->ident[problem->axis];
        refusal.lower = group->path.config.axis[problem->axis].lowest;
        refusal.upper = group->path.config.axis[problem->axis].highest;
    }
    return cm1e_group_refuse(group, refusal);
}

static cm1e_path_command_t path_command(const cm1e_group_command_t *command, bool follows, cm1e_command_id_t id)
{
    static const cm1e_path_junction_t junctions[] = {
        [mcTMNone] = CM1E_PATH_EXACT,
        [mcTMCornerDistance] = CM1E_PATH_CORNER_DISTANCE,
        [mcTMMaxCornerDeviation] = CM1E_PATH_CORNER_DEVIATION,
    };
    const bool blends = follows && is_blending(command);
    return (cm1e_path_command_t){
        .limits = {command->velocity, command->acceleration, command->deceleration, command->jerk},
        .junction = blends ? junctions[command->transition] : CM1E_PATH_STOP,
        .blend = blends ? (cm1e_path_blend_t)(command->buffer_mode - mcBlendingLow) : CM1E_PATH_BLEND_LOW,
        .parameter = command->transition_parameter,
        .tag = id,
    };
}

static cm1e_error_t append(cm1e_group_t *group, const cm1e_group_command_t *command, const double *origin,
                           bool follows, cm1e_command_id_t id)
{
    double target[CM1E_PATH_AXES], auxiliary[CM1E_PATH_AXES];
    cm1e_path_command_t way = path_command(command, follows, id);
    cm1e_path_problem_t problem = {.refusal = CM1E_PATH_FINE};
    cm1e_error_t error = resolve(group, command, origin, target, auxiliary);
    if (error != CM1E_OK)
        return error;
    bar_directions(group, &way);
    if (!is_circle(command->kind))
        error = cm1e_path_append_line(&group->path, target, &way, &problem);
    else if (command->circ_mode == mcBorder)
        error = cm1e_path_append_arc_border(&group->path, auxiliary, target, &way, &problem);
    else
        error = cm1e_path_append_arc_centre(&group->path, auxiliary, target, command->path_choice == mcClockwise
                                            ? CM1E_PATH_CLOCKWISE : CM1E_PATH_COUNTER_CLOCKWISE, &way, &problem);
    return error != CM1E_OK ? refuse_path(group, error, &problem) : CM1E_OK;
}

/* ---- start ------------------------------------------------------------------------------------------------------- */

/* Starts a command from GroupStandby. */
static cm1e_error_t begin_move(cm1e_group_t *group, const cm1e_group_command_t *command, cm1e_command_id_t id)
{
    cm1e_error_t error = cm1e_group_begin_path(group);
    if (error == CM1E_OK)
        error = append(group, command, group->sample.position, false, id);
    return error != CM1E_OK ? error : cm1e_group_lead(group, false);
}

/* Appends a command to the waiting ones. */
static cm1e_error_t wait_behind(cm1e_group_t *group, const cm1e_group_command_t *command, cm1e_command_id_t id)
{
    double end[CM1E_PATH_AXES];
    if (group->queue.count == CM1E_GROUP_COMMANDS)
        return refuse(group, CM1E_ERROR_FULL, 0.0, "Wait until one of the commands of the group is done.");
    cm1e_path_end(&group->path, end);
    const cm1e_error_t error = append(group, command, end, !group->halting, id);
    if (error == CM1E_OK && (group->halting || group->interruption.on)) /* it does not make the group go on */
        cm1e_path_stop(&group->path, group->rest_deceleration, group->rest_jerk);
    return error;
}

/* Replaces the present commands: the group comes to rest along the present path and goes on from there. A relative line
 * counts from where the axes are now, a relative circle from where it begins. */
static cm1e_error_t replace(cm1e_group_t *group, const cm1e_group_command_t *command, cm1e_command_id_t id)
{
    double rest[CM1E_PATH_AXES];
    const bool halting = group->halting;
    const double deceleration = group->rest_deceleration, jerk = group->rest_jerk;
    cm1e_path_copy(&group->before, &group->path);
    cm1e_group_brake(group, command->deceleration, command->jerk);
    cm1e_path_end(&group->path, rest);
    const cm1e_error_t error =
        append(group, command, is_circle(command->kind) ? rest : group->sample.position, false, id);
    if (error != CM1E_OK) {
        cm1e_path_copy(&group->path, &group->before);
        group->halting = halting;
        group->rest_deceleration = deceleration;
        group->rest_jerk = jerk;
        return error;
    }
    cm1e_path_go_on(&group->path);
    cm1e_group_end_all(group, CM1E_COMMAND_ABORTED, CM1E_OK);
    return CM1E_OK;
}

static cm1e_error_t start_move(cm1e_group_t *group, const cm1e_group_command_t *command, cm1e_command_id_t id)
{
    const bool moving = group->state == CM1E_GROUP_MOVING, aborting = command->buffer_mode == mcAborting;
    const cm1e_error_t error = !moving ? begin_move(group, command, id)
                               : aborting ? replace(group, command, id) : wait_behind(group, command, id);
    if (error == CM1E_OK)
        cm1e_group_enqueue(group, id);
    return error;
}

/* Starts MC_GroupHalt. A waiting halt is done when it becomes active and the group is at rest. */
static cm1e_error_t start_halt(cm1e_group_t *group, const cm1e_group_command_t *command, cm1e_command_id_t id)
{
    if (group->state == CM1E_GROUP_STANDBY) {
        cm1e_group_record(group, id, CM1E_COMMAND_DONE, CM1E_OK);
        return CM1E_OK;
    }
    if (command->buffer_mode == mcBuffered) {
        const cm1e_group_command_t rest = {.kind = CM1E_GROUP_LINEAR_RELATIVE, .buffer_mode = mcBuffered};
        const cm1e_error_t error = wait_behind(group, &rest, id);
        if (error == CM1E_OK)
            cm1e_group_enqueue(group, id);
        return error;
    }
    cm1e_group_brake(group, command->deceleration, command->jerk);
    cm1e_group_end_all(group, CM1E_COMMAND_ABORTED, CM1E_OK);
    group->halting = true;
    cm1e_group_enqueue(group, id);
    return CM1E_OK;
}

/* Starts MC_GroupStop. A group at rest holds those of its axes that are at rest, so that no other command moves
 * them. */
static void start_stop(cm1e_group_t *group, const cm1e_group_command_t *command, cm1e_command_id_t id)
{
    if (group->state == CM1E_GROUP_STANDBY && cm1e_group_begin_path(group) == CM1E_OK)
        (void)cm1e_group_lead(group, true);
    cm1e_group_brake(group, command->deceleration, command->jerk);
    cm1e_group_end_all(group, CM1E_COMMAND_ABORTED, CM1E_OK);
    group->stop = id;
    group->stop_held = true;
    cm1e_group_enqueue(group, id);
    if (!group->led)
        cm1e_group_finish(group, id);
}

/* Starts MC_GroupInterrupt: the group comes to rest along its path, and nothing is dropped. */
static void start_interrupt(cm1e_group_t *group, const cm1e_group_command_t *command, cm1e_command_id_t id)
{
    cm1e_group_end_interrupt(group, CM1E_COMMAND_ABORTED, CM1E_OK);
    group->interruption = (interruption_t){.on = true, .braking = id};
    cm1e_group_suspend(group);
    cm1e_group_rest(group, command->deceleration, command->jerk);
}

static cm1e_error_t start(cm1e_group_t *group, const cm1e_group_command_t *command, cm1e_command_id_t id)
{
    static const group_trigger_t triggers[CM1E_GROUP_KIND_COUNT] = {
        [CM1E_GROUP_HALT] = TRIGGER_HALT,
        [CM1E_GROUP_STOP] = TRIGGER_STOP,
        [CM1E_GROUP_INTERRUPT] = TRIGGER_INTERRUPT};
    const group_trigger_t trigger = is_move(command->kind) ? TRIGGER_MOVE : triggers[command->kind];
    const group_rule_t *rule = cm1e_group_rule(group->state, trigger);
    if (rule->refusal != CM1E_OK)
        return refuse(group, rule->refusal, 0.0, rule->refusal == CM1E_ERROR_GROUP_STATE
                      ? "It does not move: there is nothing to interrupt." : NULL);
    if (group->state == CM1E_GROUP_STOPPING && group->stop_held)
        return refuse(group, CM1E_ERROR_GROUP_STOPPING, 0.0, NULL);
    cm1e_error_t error = check(group, command);
    if (error != CM1E_OK)
        return error;
    if (group->state == CM1E_GROUP_STANDBY)
        cm1e_group_let_go(group); /* no axis asks, but for one left out of its last cycle */
    if (is_move(command->kind))
        error = start_move(group, command, id);
    else if (command->kind == CM1E_GROUP_HALT)
        error = start_halt(group, command, id);
    else if (command->kind == CM1E_GROUP_STOP)
        start_stop(group, command, id);
    else
        start_interrupt(group, command, id);
    if (error == CM1E_OK)
        group->state = rule->next;
    return error;
}

cm1e_error_t cm1e_group_start(cm1e_group_t *group, const cm1e_group_command_t *command, cm1e_command_id_t *id)
{
    *id = 0;
    if ((unsigned)command->kind >= CM1E_GROUP_KIND_COUNT)
        return CM1E_ERROR_INVALID_ARGUMENT;
    cm1e_group_refresh(group);
    group->refusal = (group_refusal_t){.error = CM1E_OK};
    const cm1e_command_id_t number = cm1e_group_next_id(group);
    const cm1e_error_t error = start(group, command, number);
    if (error == CM1E_OK)
        *id = number;
    return error;
}

cm1e_error_t cm1e_group_continue(cm1e_group_t *group)
{
    cm1e_group_refresh(group);
    const cm1e_error_t refusal = cm1e_group_rule(group->state, TRIGGER_INTERRUPT)->refusal;
    if (refusal != CM1E_OK || !group->interruption.on)
        return refuse(group, refusal != CM1E_OK ? refusal : CM1E_ERROR_GROUP_STATE, 0.0,
                      "Nothing is interrupted that could go on.");
    cm1e_group_end_interrupt(group, CM1E_COMMAND_ABORTED, CM1E_OK);
    group->interruption.on = false;
    cm1e_group_resume(group);
    if (!group->halting) /* else it goes on behind the halt */
        cm1e_path_go_on(&group->path);
    return refuse(group, CM1E_OK, 0.0, NULL);
}

void cm1e_group_hold_stop(cm1e_group_t *group, cm1e_command_id_t id, bool hold)
{
    if (id == 0 || id != group->stop)
        return;
    group->stop_held = hold;
    if (!hold && !group->led && group->state == CM1E_GROUP_STOPPING)
        group->state = cm1e_group_rule(group->state, TRIGGER_AT_REST)->next;
}

static bool is_override(double velocity) { return velocity >= 0.0 && velocity <= 1.0; }

cm1e_error_t cm1e_group_set_override(cm1e_group_t *group, double velocity)
{
    if (!is_override(velocity))
        return CM1E_ERROR_AXIS_OVERRIDE;
    if (velocity == group->override)
        return CM1E_OK;
    group->override = velocity;
    if (group->led && group->apart.off == 0) /* else the path waits for its axes */
        cm1e_path_override(&group->path, velocity);
    return CM1E_OK;
}

void cm1e_group_refuse_override(cm1e_group_t *group, cm1e_error_t error, double velocity, double acceleration,
                                double jerk, bool begins)
{
    group_refusal_t refusal = {.error = error, .value = jerk, .why = "JerkFactor must be 1 in this version."};
    if (!is_override(velocity))
        refusal = (group_refusal_t){.error = error, .value = velocity, .why = "VelFactor must be 0 ... 1."};
    else if (acceleration != 1.0)
        refusal = (group_refusal_t){.error = error, .value = acceleration,
                                    .why = "AccFactor must be 1 in this version."};
    const group_refusal_t *last = &group->refusal;
    const bool another = last->error == error && (last->value != refusal.value || last->why != refusal.why);
    if (begins || another)
        (void)cm1e_group_refuse(group, refusal);
}
