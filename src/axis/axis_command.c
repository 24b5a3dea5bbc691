/* Commands: posted by function blocks, known by number, one of them active. */
#include <math.h>

#include "axis/axis_private.h"

static command_record_t *record_of(cm1e_axis_t *axis, cm1e_command_id_t id)
{
    return &axis->records[id % COMMANDS_REMEMBERED];
}

void cm1e_axis_command_end(cm1e_axis_t *axis, cm1e_command_state_t state, cm1e_error_t error)
{
    if (!axis->active)
        return;
    command_record_t *record = record_of(axis, axis->active);
    if (record->id == axis->active) {
        record->state = state;
        record->error = error;
    }
    axis->active = 0;
    axis->reached = false;
}

static cm1e_command_id_t begin(cm1e_axis_t *axis, cm1e_command_kind_t kind)
{
    cm1e_axis_command_end(axis, CM1E_COMMAND_ABORTED, CM1E_OK);
    if (++axis->last_id == 0)
        axis->last_id = 1; /* 0 is no command */
    *record_of(axis, axis->last_id) = (command_record_t){.id = axis->last_id, .state = CM1E_COMMAND_ACTIVE};
    axis->active = axis->last_id;
    axis->kind = kind;
    return axis->last_id;
}

/* A plan, not yet in force: a command that is refused changes nothing. */
typedef struct plan {
    cm1e_profile_t profile;
    position_t target;
} plan_t;

static cm1e_error_t plan_position(const cm1e_axis_t *axis, const cm1e_axis_command_t *command, plan_t *plan)
{
    cm1e_motion_limits_t limits;
    cm1e_error_t error = cm1e_axis_limits_of(axis, command, false, &limits);
    if (error)
        return error;
    const cm1e_motion_state_t start = {0.0, axis->set_velocity, axis->set_acceleration};
    const double distance = cm1e_position_minus(plan->target, axis->set) / axis->scale;
    error = cm1e_profile_to_position(&plan->profile, &start, distance, &limits);
    return error ? CM1E_ERROR_AXIS_POSITION_RANGE : cm1e_axis_limits_check(axis, &plan->profile);
}

/* How far the command would need to stop: on a modulo axis it says which repetition of the position is the first. */
static cm1e_error_t stopping_way(const cm1e_axis_t *axis, const cm1e_axis_command_t *command, double *way)
{
    cm1e_motion_limits_t limits;
    cm1e_profile_t stop;
    const cm1e_motion_state_t start = {0.0, axis->set_velocity, axis->set_acceleration};
    cm1e_error_t error = cm1e_axis_limits_of(axis, command, false, &limits);
    if (!error)
        error = cm1e_profile_to_velocity(&stop, &start, 0.0, &limits);
    *way = error ? 0.0 : stop.end.position;
    return error;
}

static cm1e_error_t plan_absolute(const cm1e_axis_t *axis, const cm1e_axis_command_t *command, plan_t *plan)
{
    double way = 0.0;
    cm1e_error_t error = axis->modulo_range > 0.0 ? stopping_way(axis, command, &way) : CM1E_OK;
    if (!error)
        error = cm1e_axis_resolve_target(axis, command->position, command->direction, axis->set, axis->set_velocity,
                                         way, &plan->target);
    return error ? error : plan_position(axis, command, plan);
}

static cm1e_error_t plan_relative(const cm1e_axis_t *axis, const cm1e_axis_command_t *command, plan_t *plan)
{
    const double counts = command->position * axis->scale;
    if (!isfinite(counts) || fabs(counts) > 4.5e15)
        return CM1E_ERROR_AXIS_POSITION_RANGE;
    plan->target = cm1e_position_plus(axis->set, counts);
    if (!cm1e_axis_position_in_range(plan->target))
        return CM1E_ERROR_AXIS_POSITION_RANGE;
    return plan_position(axis, command, plan);
}

/* 3.10: the direction of Direction, turned round by a negative Velocity. */
static cm1e_error_t signed_velocity(const cm1e_axis_t *axis, const cm1e_axis_command_t *command, double *velocity)
{
    bool positive;
    switch ((int)command->direction) {
    case 0:
    case mcPositiveDirection:
        positive = true;
        break;
    case mcNegativeDirection:
        positive = false;
        break;
    case mcCurrentDirection:
        positive = axis->set_velocity != 0.0 ? axis->set_velocity > 0.0 : axis->positive_before;
        break;
    default: /* the shortest way to a velocity is none */
        return CM1E_ERROR_AXIS_DIRECTION;
    }
    *velocity = positive ? command->velocity : -command->velocity;
    return CM1E_OK;
}

static cm1e_error_t plan_velocity(const cm1e_axis_t *axis, const cm1e_axis_command_t *command, plan_t *plan)
{
    cm1e_motion_limits_t limits;
    double velocity;
    cm1e_error_t error = cm1e_axis_limits_of(axis, command, false, &limits);
    if (!error)
        error = signed_velocity(axis, command, &velocity);
    if (error)
        return error;
    if (!cm1e_axis_direction_enabled(axis, velocity))
        return CM1E_ERROR_AXIS_DIRECTION_DISABLED;
    const double now = cm1e_axis_units(axis, axis->set);
    if (axis->software_limits && (velocity > 0.0 ? now >= axis->upper : now <= axis->lower))
        return CM1E_ERROR_AXIS_POSITION_RANGE;
    velocity = velocity > 0.0 ? fmin(velocity, limits.velocity) : fmax(velocity, -limits.velocity);
    const cm1e_motion_state_t start = {0.0, axis->set_velocity, axis->set_acceleration};
    plan->target = axis->set; /* none */
    if (cm1e_profile_to_velocity(&plan->profile, &start, velocity, &limits))
        return CM1E_ERROR_AXIS_VELOCITY_RANGE;
    cm1e_motion_state_t next;
    cm1e_profile_sample(&plan->profile, axis->cycle_s, &next);
    return cm1e_axis_limits_can_stop(axis, axis->set, &next) ? CM1E_OK : CM1E_ERROR_AXIS_POSITION_RANGE;
}

static cm1e_error_t plan_stop(const cm1e_axis_t *axis, const cm1e_axis_command_t *command, plan_t *plan)
{
    cm1e_motion_limits_t limits;
    cm1e_error_t error = cm1e_axis_limits_of(axis, command, true, &limits);
    if (error)
        return error;
    error = cm1e_axis_plan_stop(axis, &limits, &plan->profile);
    plan->target = cm1e_position_plus(axis->set, plan->profile.end.position * axis->scale);
    return error;
}

typedef cm1e_error_t planner_t(const cm1e_axis_t *axis, const cm1e_axis_command_t *command, plan_t *plan);
static planner_t *const planners[CM1E_COMMAND_KIND_COUNT] = {
    [CM1E_COMMAND_MOVE_ABSOLUTE] = plan_absolute, [CM1E_COMMAND_MOVE_RELATIVE] = plan_relative,
    [CM1E_COMMAND_MOVE_VELOCITY] = plan_velocity, [CM1E_COMMAND_HALT] = plan_stop,
    [CM1E_COMMAND_STOP] = plan_stop,
};

/* MC_Stop has no buffer mode; the others only know aborting in this version. */
static bool buffer_mode_supported(const cm1e_axis_command_t *command)
{
    return command->kind == CM1E_COMMAND_STOP || command->buffer_mode == mcAborting;
}

static void take_stop(cm1e_axis_t *axis, cm1e_command_id_t id)
{
    axis->stop = id;
    axis->stop_held = true;
}

static cm1e_error_t start(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id)
{
    *id = 0;
    if ((unsigned)command->kind >= CM1E_COMMAND_KIND_COUNT)
        return CM1E_ERROR_INVALID_ARGUMENT;
    const state_rule_t *rule = cm1e_axis_state_rule(axis->state, command->kind);
    if (rule->refusal)
        return rule->refusal;
    if (command->kind != CM1E_COMMAND_HOME && !planners[command->kind])
        return CM1E_ERROR_UNSUPPORTED;
    if (axis->state == CM1E_AXIS_STOPPING && axis->stop_held)
        return CM1E_ERROR_AXIS_STOPPING;
    if (!buffer_mode_supported(command))
        return CM1E_ERROR_AXIS_BUFFER_MODE;

    if (command->kind == CM1E_COMMAND_HOME) {
        const cm1e_error_t error = cm1e_axis_home_prepare(axis, command);
        if (error)
            return error;
        *id = begin(axis, command->kind);
        cm1e_axis_home_begin(axis);
    } else if (axis->activity == ACTIVITY_HOMING) { /* only MC_Stop gets here: the drive has to stop itself first */
        cm1e_motion_limits_t unused;
        const cm1e_error_t error = cm1e_axis_limits_of(axis, command, true, &unused);
        if (error)
            return error;
        *id = begin(axis, command->kind);
        take_stop(axis, *id);
        cm1e_axis_home_abort(axis, HOME_GOAL_HOLD);
    } else {
        plan_t plan;
        const cm1e_error_t error = planners[command->kind](axis, command, &plan);
        if (error)
            return error;
        *id = begin(axis, command->kind);
        if (command->kind == CM1E_COMMAND_STOP)
            take_stop(axis, *id);
        cm1e_axis_run_profile(axis, &plan.profile, plan.target);
    }
    axis->state = rule->next;
    return CM1E_OK;
}

cm1e_error_t cm1e_axis_start(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id)
{
    axis->refusal = start(axis, command, id);
    if (axis->refusal)
        axis->refused = *command;
    return axis->refusal;
}

cm1e_error_t cm1e_axis_update(cm1e_axis_t *axis, cm1e_command_id_t id, const cm1e_axis_command_t *command)
{
    (void)command;
    return record_of(axis, id)->id == id ? CM1E_ERROR_UNSUPPORTED : CM1E_ERROR_INVALID_ARGUMENT;
}

cm1e_error_t cm1e_axis_set_override(cm1e_axis_t *axis, double velocity, double acceleration, double jerk)
{
    (void)axis;
    return velocity == 1.0 && acceleration == 1.0 && jerk == 1.0 ? CM1E_OK : CM1E_ERROR_UNSUPPORTED;
}

cm1e_command_status_t cm1e_axis_command_status(const cm1e_axis_t *axis, cm1e_command_id_t id)
{
    const command_record_t *record = &axis->records[id % COMMANDS_REMEMBERED];
    if (id == 0 || record->id != id)
        return (cm1e_command_status_t){.state = CM1E_COMMAND_UNKNOWN};
    return (cm1e_command_status_t){
        .state = record->state,
        .error = record->error,
        .reached = id == axis->active && axis->kind == CM1E_COMMAND_MOVE_VELOCITY && axis->reached,
    };
}

bool cm1e_axis_runs(AXIS_REF_t reference, cm1e_command_id_t id)
{
    const cm1e_axis_t *axis = cm1e_axis_from_reference(&reference);
    return axis && id != 0 && axis->active == id;
}

void cm1e_axis_hold_stop(cm1e_axis_t *axis, cm1e_command_id_t id, bool hold)
{
    if (id != 0 && id == axis->stop)
        axis->stop_held = hold;
}
