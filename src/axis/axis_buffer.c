/*
 * The commands that wait (2.4.2, table 4): taking them in, how fast each one's end position is passed on the way to the
 * next, and the change from one to the next at the very moment, inside a cycle, at which the first one ends.
 *
 * Velocity at a junction: what the buffer mode says, at most as much as the following commands can brake from (looking
 * ahead from the last one backwards), and as much as the present one can reach without backing up. It is zero where the
 * direction turns, where the mode is mcBuffered, and before a command that begins at rest.
 */
#include <float.h>
#include <math.h>

#include "axis/axis_private.h"

/* What an exit velocity may differ by when it is asked again on the way. */
static const double same_velocity = 1e-9;

move_t *cm1e_axis_find_waiting(cm1e_axis_t *axis, cm1e_command_id_t id)
{
    for (int i = 0; i < axis->waiting.count; i++)
        if (waiting_move(axis, i)->id == id)
            return waiting_move(axis, i);
    return NULL;
}

/* ---- looking ahead ----------------------------------------------------------------------------------------------- */

/* A waiting command that is passed into without a stop. */
typedef struct leg {
    cm1e_motion_limits_t limits;
    double distance;       /* u; where it has no end: only the sign counts */
    double exit_velocity;  /* u/s, in its own direction */
    double room;           /* u; from where it begins to the software limit, where there is one */
    const cm1e_motion_limits_t *most; /* of the axis */
    bool open;             /* it has no end at which it would have to stop */
    MC_BUFFER_MODE mode;
} leg_t;

static double junction_velocity(MC_BUFFER_MODE mode, double first, double second)
{
    switch (mode) {
    case mcBlendingLow: return fmin(first, second);
    case mcBlendingPrevious: return first;
    case mcBlendingNext: return second;
    case mcBlendingHigh: return fmax(first, second);
    default: return 0.0;
    }
}

static bool shared(const cm1e_axis_t *axis) { return axis->superimposed.moving && !axis->superimposed.alone; }

/* A superimposed motion that ends before such a command begins will have moved it nearer. */
static double nearer(const cm1e_axis_t *axis, const move_t *move, double distance)
{
    if (!axis->superimposed.id || kind_row(move->kind)->target != TARGET_ABSOLUTE)
        return distance;
    const double left = distance > 0.0 ? distance - fmax(axis->superimposed.highest, 0.0)
                                       : distance - fmin(axis->superimposed.lowest, 0.0);
    return left * distance > 0.0 ? left : 0.0;
}

/* FALSE: the command before it has to stop. `end` is where that one ends, `sign` the way it goes; both are moved on. */
static bool make_leg(cm1e_axis_t *axis, move_t *move, position_t *end, double sign, leg_t *leg)
{
    const from_t from = {*end, sign * DBL_MIN, 0.0, shared(axis)}; /* only the direction is known yet */
    move->origin = *end;
    if (move->buffer_mode <= mcBuffered || !is_planned(move->kind) ||
        cm1e_axis_limits_of(axis, &from, move, &leg->limits) || cm1e_axis_resolve(axis, &from, move))
        return false;
    leg->mode = (MC_BUFFER_MODE)move->buffer_mode;
    leg->open = false;
    leg->exit_velocity = 0.0;
    leg->distance = nearer(axis, move, cm1e_position_minus(move->target, *end) / axis->scale);
    if (move->kind == CM1E_COMMAND_MOVE_VELOCITY) {
        leg->open = true;
        (void)cm1e_axis_signed_velocity(axis, &from, move, &leg->distance);
    } else if (move->kind == CM1E_COMMAND_HALT) {
        leg->open = true;
        leg->distance = sign;
        leg->limits.velocity = 0.0;
    } else if (kind_row(move->kind)->plan == PLAN_THROUGH_TARGET) {
        const double exit_velocity = cm1e_axis_exit_velocity(axis, &from, move);
        leg->exit_velocity = fmax(0.0, leg->distance > 0.0 ? exit_velocity : -exit_velocity);
    }
    const double begin = cm1e_axis_line(axis, *end);
    leg->room = !axis->software_limits ? INFINITY : leg->distance > 0.0 ? axis->upper - begin : begin - axis->lower;
    leg->most = &axis->maximum;
    *end = move->target;
    return leg->distance != 0.0;
}

/* How fast a leg may be entered when the command before it has this velocity and direction. With a limit of jerk the
 * way down to a stop can be shorter than the way down to a low velocity. To enter as if to stop costs the junction
 * behind its velocity, so only an axis that is already too fast does so: a command more in the buffer, which lets this
 * leg be left faster, must not ask it for a slower entry than it was planned for. */
static double entry_velocity(const leg_t *leg, double velocity_before, double sign, bool as_if_to_stop)
{
    double velocity = junction_velocity(leg->mode, velocity_before, leg->limits.velocity);
    if (isfinite(leg->room)) /* it may turn out not to be able to begin there: then the axis stops inside its limits */
        velocity = cm1e_profile_entry_velocity(fmax(leg->room, 0.0), velocity, 0.0, leg->most);
    if (leg->distance * sign <= 0.0)
        return 0.0;
    if (leg->open)
        return velocity;
    const double distance = fabs(leg->distance);
    const double entry = cm1e_profile_entry_velocity(distance, velocity, leg->exit_velocity, &leg->limits);
    return as_if_to_stop ? fmax(entry, cm1e_profile_entry_velocity(distance, velocity, 0.0, &leg->limits)) : entry;
}

/* From the last leg backwards: how fast the first one is to be entered by a command of this velocity. */
static double look_ahead(leg_t *legs, int count, double velocity, bool as_if_to_stop)
{
    for (int i = count - 1; i > 0; i--)
        legs[i - 1].exit_velocity = entry_velocity(&legs[i], legs[i - 1].limits.velocity,
                                                   copysign(1.0, legs[i - 1].distance), as_if_to_stop);
    /* From which side the command gets to its target is for the profile to know. */
    const double sign = copysign(1.0, legs[0].distance);
    return sign * entry_velocity(&legs[0], velocity, sign, as_if_to_stop);
}

double cm1e_axis_exit_velocity(cm1e_axis_t *axis, const from_t *from, const move_t *move)
{
    const double factor = axis->override.velocity > 0.0 ? axis->override.velocity : 1.0;
    if (kind_row(move->kind)->plan == PLAN_THROUGH_TARGET)
        return factor * move->end_velocity;
    cm1e_motion_limits_t limits;
    if (axis->waiting.count == 0 || kind_row(move->kind)->plan != PLAN_TO_TARGET ||
        cm1e_axis_limits_of(axis, from, move, &limits))
        return 0.0;
    leg_t legs[CM1E_AXIS_BUFFER_DEPTH];
    const double distance = cm1e_position_minus(move->target, from->position) / axis->scale;
    position_t end = move->target;
    double sign = copysign(1.0, distance);
    int count = 0;
    while (count < axis->waiting.count && make_leg(axis, waiting_move(axis, count), &end, sign, &legs[count])) {
        sign = copysign(1.0, legs[count].distance);
        if (legs[count].open || kind_row(waiting_move(axis, count)->kind)->is_endless) {
            count++;
            break;
        }
        count++;
    }
    if (count == 0)
        return 0.0;
    const cm1e_motion_state_t start = {0.0, from->velocity, from->acceleration};
    const double wanted = look_ahead(legs, count, limits.velocity, false);
    if (!cm1e_axis_direction_enabled(axis, wanted)) /* braking is all that may still go that way */
        return 0.0;
    const double velocity = cm1e_profile_passing_velocity(&start, distance, wanted, &limits);
    if (velocity == wanted)
        return velocity;
    return cm1e_profile_passing_velocity(&start, distance, look_ahead(legs, count, limits.velocity, true), &limits);
}

/* ---- taking in --------------------------------------------------------------------------------------------------- */

/* What can be known beforehand. `end`: of the command before, NULL where nobody knows that. */
static cm1e_error_t check(const cm1e_axis_t *axis, move_t *move, const position_t *end)
{
    const from_t from = {end ? *end : axis->set, 0.0, 0.0, shared(axis)};
    const command_kind_t *kind = kind_row(move->kind);
    cm1e_motion_limits_t limits;
    if (!is_planned(move->kind))
        return CM1E_OK;
    cm1e_error_t error = cm1e_axis_limits_of(axis, &from, move, &limits);
    move->origin = from.position;
    if (!error)
        error = cm1e_axis_resolve(axis, &from, move);
    double way = cm1e_position_minus(move->target, from.position) / axis->scale;
    if (!error && kind->plan == PLAN_VELOCITY)
        error = cm1e_axis_signed_velocity(axis, &from, move, &way);
    if (error || kind->plan == PLAN_STOP)
        return error;
    if ((end || kind->target == TARGET_ABSOLUTE) && !cm1e_axis_limits_contain_target(axis, &from, move->target))
        return CM1E_ERROR_AXIS_POSITION_RANGE;
    const bool direction_known = end || kind->plan == PLAN_VELOCITY || kind->target == TARGET_RELATIVE;
    if (direction_known && !cm1e_axis_direction_enabled(axis, way))
        return CM1E_ERROR_AXIS_DIRECTION_DISABLED;
    return CM1E_OK;
}

/* The command that is before the waiting one of that index. */
static const move_t *before(cm1e_axis_t *axis, int index, const command_kind_t **kind)
{
    const move_t *move = index > 0 ? waiting_move(axis, index - 1) : &axis->move;
    *kind = kind_row(index > 0 ? move->kind : axis->kind); /* a homing that is active has no move */
    return move;
}

static cm1e_error_t check_behind(cm1e_axis_t *axis, int index, move_t *move)
{
    const command_kind_t *kind;
    const move_t *first = before(axis, index, &kind);
    if (is_homing(move->kind) && (kind->is_endless || kind->plan == PLAN_COUPLING))
        return CM1E_ERROR_AXIS_STATE; /* homing begins at rest */
    return check(axis, move, kind->target != TARGET_NONE ? &first->target : NULL);
}

/* What goes on when it has reached what it was to reach, and then lets the next command take its place. */
static bool hands_over(const cm1e_axis_t *axis)
{
    if (kind_row(axis->kind)->plan == PLAN_COUPLING)
        return axis->coupling_hooks->hands_over(axis);
    return kind_row(axis->kind)->is_endless;
}

cm1e_error_t cm1e_axis_buffer(cm1e_axis_t *axis, move_t *move)
{
    if (axis->waiting.count == CM1E_AXIS_BUFFER_DEPTH)
        return CM1E_ERROR_FULL;
    const cm1e_error_t error = check_behind(axis, axis->waiting.count, move);
    if (error)
        return error;
    move->id = cm1e_axis_next_id(axis);
    *waiting_move(axis, axis->waiting.count++) = *move;
    if (axis->reached && hands_over(axis)) { /* the signal that it waits for is there already (table 4) */
        const from_t from = from_base(axis);
        (void)cm1e_axis_begin_waiting(axis, &from, 0.0);
    } else if (kind_row(axis->kind)->plan == PLAN_TO_TARGET) {
        (void)cm1e_axis_replan(axis);
    }
    return CM1E_OK;
}

cm1e_error_t cm1e_axis_update_waiting(cm1e_axis_t *axis, const move_t *move)
{
    for (int i = 0; i < axis->waiting.count; i++) {
        if (waiting_move(axis, i)->id != move->id)
            continue;
        move_t checked = *move;
        const cm1e_error_t error = check_behind(axis, i, &checked);
        if (error)
            return error;
        *waiting_move(axis, i) = checked;
        if (kind_row(axis->kind)->plan == PLAN_TO_TARGET)
            (void)cm1e_axis_replan(axis);
    }
    return CM1E_OK;
}

/* ---- from one to the next ---------------------------------------------------------------------------------------- */

static move_t take_first(cm1e_axis_t *axis)
{
    const move_t move = *waiting_move(axis, 0);
    axis->waiting.first = (uint8_t)((axis->waiting.first + 1) % CM1E_AXIS_BUFFER_DEPTH);
    axis->waiting.count--;
    return move;
}

cm1e_error_t cm1e_axis_begin_move(cm1e_axis_t *axis, move_t *move, const from_t *from, double offset_s)
{
    cm1e_profile_t profile;
    move->origin = from->position;
    cm1e_error_t error = cm1e_axis_resolve(axis, from, move);
    if (error)
        return error;
    error = cm1e_axis_plan(axis, from, move, true, &profile);
    if (!error)
        cm1e_axis_take(axis, move, from, &profile, offset_s);
    return error;
}

bool cm1e_axis_begin_waiting(cm1e_axis_t *axis, const from_t *at, double offset_s)
{
    from_t from = *at;
    while (axis->waiting.count > 0) {
        const command_kind_t *kind = kind_row(waiting_move(axis, 0)->kind);
        const command_method_t *method = cm1e_axis_method(axis, kind->plan);
        if (axis->superimposed.id && (axis->superimposed.alone || !kind->carries_superimposed))
            return false; /* nothing goes on top of these, or it has all the limits: they wait for its end */
        if (method->awaits && method->awaits(axis, &from, offset_s))
            return false;
        if (is_planned(waiting_move(axis, 0)->kind) && offset_s == 0.0)
            cm1e_axis_superimposed_give_way(axis, &from);
        move_t move = take_first(axis);
        cm1e_error_t error = cm1e_axis_state_refusal(axis->state, kind->trigger);
        if (!error)
            error = method->begin(axis, &move, &from, offset_s);
        if (!error) {
            cm1e_axis_taken(axis, kind);
            return true;
        }
        cm1e_axis_record(axis, move.id, CM1E_COMMAND_ERROR, error);
        cm1e_axis_remember_end(axis, (cm1e_command_kind_t)move.kind, error);
    }
    return false;
}

static void go_on_as(cm1e_axis_t *axis, const from_t *from, const move_t *move, const cm1e_profile_t *profile)
{
    axis->move = *move;
    cm1e_axis_run(axis, from, profile, cm1e_axis_profile_end(axis, from, move, profile), 0.0);
    axis->paused = move->paused;
}

cm1e_error_t cm1e_axis_replan_as(cm1e_axis_t *axis, const move_t *as)
{
    move_t move = *as;
    cm1e_profile_t profile;
    const from_t from = from_base(axis);
    const cm1e_error_t error = cm1e_axis_plan(axis, &from, &move, true, &profile);
    if (!error)
        go_on_as(axis, &from, &move, &profile);
    return error;
}

static bool can_replan(const cm1e_axis_t *axis)
{
    return axis->active && axis_on_profile(axis) && axis->kind != CM1E_COMMAND_STOP &&
           is_planned(axis->kind);
}

/* `careful`: not when it would then run over its target, or go back. */
static cm1e_error_t replan(cm1e_axis_t *axis, bool careful, bool *done)
{
    move_t move = axis->move;
    cm1e_profile_t profile;
    const from_t from = from_base(axis);
    const cm1e_error_t error = cm1e_axis_plan(axis, &from, &move, true, &profile);
    *done = !error && !(careful && cm1e_axis_profile_strays(axis, &from, &move, &profile));
    if (*done)
        go_on_as(axis, &from, &move, &profile);
    return error;
}

/* What runs does so itself: it began too late for anything else. */
static bool runs_astray(const cm1e_axis_t *axis)
{
    const cm1e_motion_state_t *start = &axis->profile.segments[0].start;
    const from_t from = {axis->base, start->velocity, start->acceleration, false};
    return axis->profile.segment_count > 0 && cm1e_axis_profile_strays(axis, &from, &axis->move, &axis->profile);
}

/* One that keeps its target, or passes it with a velocity, cannot always be changed any more: then it stays. */
cm1e_error_t cm1e_axis_replan(cm1e_axis_t *axis)
{
    bool done;
    return can_replan(axis) ? replan(axis, !axis->paused && !runs_astray(axis), &done) : CM1E_OK;
}

bool cm1e_axis_replan_if(cm1e_axis_t *axis)
{
    bool done = false;
    return can_replan(axis) && replan(axis, true, &done) == CM1E_OK && done;
}

/* ---- a shift of the coordinates ---------------------------------------------------------------------------------- */

/* Those that wait behind a homing are meant in the coordinates that it makes. */
static int before_homing(cm1e_axis_t *axis)
{
    int count = 0;
    while (count < axis->waiting.count && !is_homing(waiting_move(axis, count)->kind))
        count++;
    return count;
}

bool cm1e_axis_waiting_hold(cm1e_axis_t *axis, double lower, double upper)
{
    const int count = before_homing(axis);
    bool known = axis->active && kind_row(axis->kind)->target != TARGET_NONE;
    for (int i = 0; i < count; i++) {
        const move_t *move = waiting_move(axis, i);
        const command_target_t has = kind_row(move->kind)->target;
        const double target = cm1e_axis_line(axis, move->target);
        known = has == TARGET_ABSOLUTE || (known && has == TARGET_RELATIVE);
        if (known && !(target <= upper + axis->tolerance && target >= lower - axis->tolerance))
            return false;
    }
    return true;
}

bool cm1e_axis_shift_waiting(cm1e_axis_t *axis, double shift)
{
    const int count = before_homing(axis);
    for (int i = 0; i < count; i++)
        waiting_move(axis, i)->shift += shift;
    if (count == 0 || !axis->software_limits || !can_replan(axis) || kind_row(axis->kind)->plan != PLAN_TO_TARGET)
        return true;
    /* What begins behind the target has less room now. */
    const from_t from = from_base(axis);
    const double planned = axis->move.exit_velocity, now = cm1e_axis_exit_velocity(axis, &from, &axis->move);
    if (fabs(now) >= fabs(planned) * (1.0 - same_velocity) || cm1e_axis_replan_if(axis))
        return true;
    for (int i = 0; i < count; i++)
        waiting_move(axis, i)->shift -= shift;
    return false;
}
