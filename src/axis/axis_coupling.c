/* Followers: their commands, and their set-point of every cycle (axis_coupling.h). */
#include "axis/axis_coupling.h"

#include <math.h>
#include <stdlib.h>

static const double same_moment = 1e-6; /* cycles */

cm1e_error_t cm1e_axis_coupling_init(cm1e_axis_t *axis, cm1e_diag_t *diag)
{
    axis->coupling = calloc(1, sizeof *axis->coupling);
    axis->observed = axis->config->type == CM1E_AXIS_ENCODER;
    return axis->coupling ? CM1E_OK : cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "No memory for what axis \"%s\" "
                                                    "may follow.", axis->config->name);
}

void cm1e_axis_coupling_free(cm1e_axis_t *axis)
{
    if (axis->coupling)
        cm1e_axis_unlink(axis);
    free(axis->coupling);
    axis->coupling = NULL;
}

/* ---- what is not in step yet ------------------------------------------------------------------------------------- */

static double at_most(double asked, double most, double used)
{
    const double least_part = 0.01; /* it must come to an end */
    return fmin(asked, fmax(most - used, least_part * most));
}

/* What F leaves of the axis's limits. The velocity of the rest goes to 0 while the axis's own grows or shrinks to F's. An
 * acceleration of F that helps on the way leaves all of them. */
static cm1e_motion_limits_t limits_beside(const cm1e_axis_t *axis, const from_t *f, double f_jerk, bool full_jerk)
{
    const rest_t *rest = &axis->coupling->rest;
    if (axis->coupling->now->to_position)
        return cm1e_axis_cam_leaves(axis, axis->coupling->now, &rest->asked);
    const cm1e_motion_limits_t *most = &axis->maximum;
    const double now = f->velocity + rest->now.velocity, way = rest->now.velocity > 0.0 ? -1.0 : 1.0;
    const bool helps = f->acceleration * way <= 0.0 && rest->now.acceleration * way >= 0.0;
    const double used = helps ? 0.0 : fabs(f->acceleration);
    const double up = at_most(rest->asked.acceleration, most->acceleration, used);
    const double down = at_most(rest->asked.deceleration, most->deceleration, used);
    const double change = now * f->velocity < 0.0 ? fmin(up, down) : fabs(f->velocity) > fabs(now) ? up : down;
    const double jerk = full_jerk ? rest->asked.jerk : at_most(rest->asked.jerk, most->jerk, fabs(f_jerk));
    return (cm1e_motion_limits_t){2.0 * (most->velocity + fabs(rest->now.velocity)), change, change, jerk};
}

static void plan_rest(cm1e_axis_t *axis, const cm1e_motion_limits_t *limits)
{
    coupling_t *c = axis->coupling;
    rest_t *rest = &c->rest;
    const cm1e_error_t error =
        c->now->to_position ? cm1e_profile_to_position(&rest->profile, &rest->now, 0.0, limits)
                            : cm1e_profile_to_velocity(&rest->profile, &rest->now, 0.0, limits);
    rest->cycles = 0;
    rest->on = error || rest->profile.duration_s > 0.0;
    if (error) { /* numbers that doubles cannot hold: as it is, for the guard to judge */
        rest->profile.segment_count = 0;
        rest->profile.duration_s = INFINITY;
        rest->profile.end = rest->now;
    }
}

static void next_of_rest(cm1e_axis_t *axis)
{
    rest_t *rest = &axis->coupling->rest;
    cm1e_profile_sample(&rest->profile, (double)++rest->cycles * axis->cycle_s, &rest->now);
}

/* ---- the cycle --------------------------------------------------------------------------------------------------- */

static from_t sum_of(const cm1e_axis_t *axis, const from_t *f)
{
    const cm1e_motion_state_t *rest = &axis->coupling->rest.now, *on_top = &axis->superimposed.now;
    from_t sum = *f;
    if (axis->coupling->rest.on) {
        sum.position = cm1e_position_plus(sum.position, rest->position * axis->scale);
        sum.velocity += rest->velocity;
        sum.acceleration += rest->acceleration;
    }
    if (axis->superimposed.id) {
        sum.position = cm1e_position_plus(sum.position, on_top->position * axis->scale);
        sum.velocity += on_top->velocity;
        sum.acceleration += on_top->acceleration;
    }
    return sum;
}

static bool keeps_jerk(const coupling_t *c) { return !c->now->linear && !c->now->by_actual; }

/* How the rest may go on in a cycle: by its plan; planned anew beside what F has come to need, first with all its jerk,
 * which may go against F's; and without any jerk. */
typedef enum attempt { AS_PLANNED = 0, WITH_ALL_JERK, WITH_JERK_LEFT, WITHOUT_JERK, ATTEMPTS } attempt_t;

static void go_on(cm1e_axis_t *axis, const from_t *f, attempt_t attempt)
{
    rest_t *rest = &axis->coupling->rest;
    const double f_jerk = (f->acceleration - axis->coupling->f_acceleration) / axis->cycle_s, t = axis->cycle_s;
    if (attempt == WITH_ALL_JERK || attempt == WITH_JERK_LEFT) {
        const cm1e_motion_limits_t limits = limits_beside(axis, f, f_jerk, attempt == WITH_ALL_JERK);
        plan_rest(axis, &limits);
    }
    const double v = rest->now.velocity, a = rest->now.acceleration;
    if (attempt == WITHOUT_JERK) {
        rest->now = (cm1e_motion_state_t){rest->now.position + t * (v + t * a / 2.0), v + t * a, a};
        rest->profile.duration_s = INFINITY;
    } else if (rest->on) {
        next_of_rest(axis);
    }
}

/* Once F has come to need more of the limits than was left to it, the rest is planned anew in every cycle until it has
 * ended: it takes what there is. */
static from_t with_rest(cm1e_axis_t *axis, const from_t *f, guard_t *guard)
{
    rest_t *rest = &axis->coupling->rest;
    const cm1e_motion_state_t before = rest->now;
    const bool disturbed = f->acceleration != 0.0 || axis->coupling->f_acceleration != 0.0;
    from_t sum;
    for (int attempt = rest->held_back ? WITH_ALL_JERK : AS_PLANNED; attempt < ATTEMPTS; attempt++) {
        rest->now = before;
        rest->on = true;
        rest->held_back = attempt == WITHOUT_JERK || (attempt > AS_PLANNED && disturbed);
        go_on(axis, f, (attempt_t)attempt);
        sum = sum_of(axis, f);
        *guard = cm1e_axis_guard(axis, &sum, keeps_jerk(axis->coupling));
        if (!guard->limit)
            break;
    }
    return sum;
}

static void emit(cm1e_axis_t *axis, const from_t *point)
{
    axis->set = point->position;
    axis->set_velocity = point->velocity;
    axis->set_acceleration = point->acceleration;
    if (point->velocity != 0.0)
        axis->positive_before = point->velocity > 0.0;
}

/* Lost distance is not made up (4.5, note 1). */
static void end_rest(cm1e_axis_t *axis)
{
    coupling_t *c = axis->coupling;
    const double left = c->rest.profile.end.position;
    if (!c->now->to_position)
        c->now->anchor = cm1e_position_plus(c->now->anchor, left * axis->scale);
    c->rest = (rest_t){.on = false};
}

static void after_set_point(cm1e_axis_t *axis)
{
    coupling_t *c = axis->coupling;
    rest_t *rest = &c->rest;
    if (rest->on && (double)rest->cycles * axis->cycle_s >= rest->profile.duration_s - same_moment * axis->cycle_s)
        end_rest(axis);
    if (axis->superimposed.id)
        cm1e_axis_superimposed_after(axis);
    axis->reached = !rest->on && c->now->in_step;
    if (axis->reached && axis->waiting.count > 0 && (!c->now->waits_for_end || c->end_of_profile || c->now->ended)) {
        const from_t from = from_base(axis);
        (void)cm1e_axis_begin_waiting(axis, &from, 0.0);
    }
}

static void master_lost(cm1e_axis_t *axis)
{
    cm1e_axis_fail(axis, CM1E_ERROR_AXIS_MASTER_LOST, 0.0, 0.0);
}

bool cm1e_axis_coupled_step(cm1e_axis_t *axis)
{
    coupling_t *c = axis->coupling;
    from_t f, sum;
    const from_t *next = &f;
    guard_t guard;
    if (c->phasing.moving)
        cm1e_axis_phasing_step(axis);
    if (cm1e_axis_see(axis, c->now)) {
        master_lost(axis);
        return false;
    }
    c->end_of_profile = false;
    c->now->kind->evaluate(axis, c->now, &f);
    if (axis->superimposed.id) {
        cm1e_motion_state_t unused = {0};
        cm1e_axis_superimposed_step(axis, &unused);
    }
    const bool in_step = !c->rest.on;
    if (!in_step || axis->superimposed.id) {
        sum = in_step ? sum_of(axis, &f) : with_rest(axis, &f, &guard);
        next = &sum;
    }
    if (in_step)
        guard = cm1e_axis_guard(axis, next, keeps_jerk(c));
    if (guard.limit) {
        cm1e_axis_guard_fail(axis, guard);
        return false;
    }
    c->f_acceleration = f.acceleration;
    emit(axis, next);
    after_set_point(axis);
    return true;
}

/* ---- beginnings -------------------------------------------------------------------------------------------------- */

follow_t *cm1e_axis_follow_spare(cm1e_axis_t *axis)
{
    coupling_t *c = axis->coupling;
    follow_t *spare = c->follows;
    while (spare == c->now || spare == c->next)
        spare++;
    return spare;
}

/* What rounding leaves of nothing at all. */
static bool is_nothing(const cm1e_axis_t *axis, const cm1e_motion_state_t *rest)
{
    const double counts = 1e-6, t = axis->cycle_s, scale = fabs(axis->scale);
    return fabs(rest->position) * scale < counts && fabs(rest->velocity) * scale * t < counts &&
           fabs(rest->acceleration) * scale * t * t < counts;
}

/* The rest is what `from` differs from F as its masters are seen. */
static void begin_rest(cm1e_axis_t *axis, const from_t *from, const cm1e_motion_limits_t *asked)
{
    coupling_t *c = axis->coupling;
    from_t f;
    c->now->kind->evaluate(axis, c->now, &f);
    c->f_acceleration = f.acceleration;
    c->rest = (rest_t){.asked = *asked,
                       .now = {cm1e_position_minus(from->position, f.position) / axis->scale,
                               from->velocity - f.velocity, from->acceleration - f.acceleration},
                       .held_back = f.acceleration != 0.0};
    if (is_nothing(axis, &c->rest.now))
        c->rest.now = (cm1e_motion_state_t){0};
    const cm1e_motion_limits_t limits = limits_beside(axis, &f, 0.0, true);
    plan_rest(axis, &limits);
}

/* Where all stand at their last targets, they are in step as before: the rest is none but what it was. */
void cm1e_axis_coupled_after_pause(cm1e_axis_t *axis)
{
    coupling_t *c = axis->coupling;
    const from_t from = from_set(axis);
    cm1e_axis_phasing_rest(axis);
    for (int i = 0; i < c->now->count; i++) {
        link_t *link = &c->now->links[i];
        if (link->source == mcSetValue && link->master && link->master->mode != CM1E_MODE_CSV)
            link->seen.velocity = link->seen.acceleration = 0.0;
    }
    const cm1e_motion_limits_t asked = c->rest.on ? c->rest.asked : axis->maximum;
    begin_rest(axis, &from, &asked);
}

void cm1e_axis_follow(cm1e_axis_t *axis, follow_t *follow, const from_t *from, const cm1e_motion_limits_t *asked)
{
    coupling_t *c = axis->coupling;
    if (!axis_follows(axis) || c->now->links[0].master != follow->links[0].master)
        cm1e_axis_phasing_forget(axis);
    if (c->now)
        cm1e_axis_unlist_links(c->now);
    if (c->next)
        cm1e_axis_unlist_links(c->next);
    cm1e_axis_list_links(follow);
    c->now = follow;
    c->next = NULL;
    c->synchronizing = c->end_of_profile = false;
    begin_rest(axis, from, asked);
    axis->activity = ACTIVITY_COUPLED;
    axis->reached = axis->paused = axis->stands = axis->along_table = false;
}

void cm1e_axis_coupled_begin(cm1e_axis_t *axis)
{
    from_t f;
    cm1e_motion_state_t unused = {0};
    if (axis->superimposed.id)
        cm1e_axis_superimposed_step(axis, &unused);
    axis->coupling->now->kind->evaluate(axis, axis->coupling->now, &f);
    const from_t point = sum_of(axis, &f);
    emit(axis, &point);
}

/* ---- commands ---------------------------------------------------------------------------------------------------- */

typedef cm1e_error_t prepare_t(cm1e_axis_t *axis, const move_t *move, const cm1e_axis_coupling_t *coupling,
                               const from_t *from);

static prepare_t *const preparers[CM1E_COMMAND_KIND_COUNT] = {
    [CM1E_COMMAND_GEAR_IN] = cm1e_axis_gear_prepare,
    [CM1E_COMMAND_CAM_IN] = cm1e_axis_cam_prepare,
    [CM1E_COMMAND_COMBINE_AXES] = cm1e_axis_gear_prepare,
};

bool cm1e_axis_can_couple(cm1e_command_kind_t kind) { return preparers[kind] != NULL; }

static cm1e_error_t prepare(cm1e_axis_t *axis, const move_t *move, const cm1e_axis_coupling_t *coupling,
                            const from_t *from, cm1e_motion_limits_t *limits)
{
    const cm1e_error_t error = cm1e_axis_limits_of(axis, from, move, limits);
    return error ? error : preparers[move->kind](axis, move, coupling, from);
}

static void take(cm1e_axis_t *axis, const move_t *move, const cm1e_axis_coupling_t *coupling, const from_t *from,
                 const cm1e_motion_limits_t *limits)
{
    cm1e_axis_command_end(axis, CM1E_COMMAND_ABORTED, CM1E_OK);
    axis->active = move->id;
    axis->kind = (cm1e_command_kind_t)move->kind;
    axis->move = *move;
    axis->coupling->inputs = *coupling;
    axis->coupling->ends = 0;
    cm1e_axis_follow(axis, cm1e_axis_follow_spare(axis), from, limits);
}

cm1e_error_t cm1e_axis_couple(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id)
{
    const from_t from = from_set(axis);
    move_t move = cm1e_axis_move_of(command);
    cm1e_motion_limits_t limits;
    const cm1e_error_t error = command->coupling ? prepare(axis, &move, command->coupling, &from, &limits)
                                                 : CM1E_ERROR_INVALID_ARGUMENT;
    if (error)
        return error;
    cm1e_axis_commands_end(axis, CM1E_COMMAND_ABORTED, CM1E_OK);
    *id = move.id = cm1e_axis_next_id(axis);
    take(axis, &move, command->coupling, &from, &limits);
    return CM1E_OK;
}

/* ---- buffered ---------------------------------------------------------------------------------------------------- */

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

/* Before it waits it has its place: what it waits for may be there already, and it begins at once. */
cm1e_error_t cm1e_axis_coupling_buffer(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id)
{
    move_t move = cm1e_axis_move_of(command);
    waiting_coupling_t *place = free_place(axis);
    if (!command->coupling)
        return CM1E_ERROR_INVALID_ARGUMENT;
    if (!place)
        return CM1E_ERROR_FULL;
    *place = (waiting_coupling_t){axis->last_id + 1 ? axis->last_id + 1 : 1, *command->coupling};
    const cm1e_error_t error = cm1e_axis_buffer(axis, &move);
    if (!error)
        *id = move.id;
    return error;
}

/* It follows from the present set-point on, which is where the command before it has come to since its end. */
cm1e_error_t cm1e_axis_coupling_begin(cm1e_axis_t *axis, const move_t *move, const from_t *from, double late_s)
{
    const waiting_coupling_t *waiting = waiting_of(axis, move->id);
    from_t here = *from;
    cm1e_motion_limits_t limits;
    here.position = cm1e_position_plus(from->position, from->velocity * late_s * axis->scale);
    const cm1e_error_t error = waiting ? prepare(axis, move, &waiting->coupling, &here, &limits)
                                       : CM1E_ERROR_AXIS_STATE;
    if (!error)
        take(axis, move, &waiting->coupling, &here, &limits);
    return error;
}
