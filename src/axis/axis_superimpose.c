/*
 * MC_MoveSuperimposed and MC_HaltSuperimposed (3.8, 3.9): a second motion in addition to the commanded one, its base.
 * The set-point is the sum of both.
 *
 * The limits are shared, so that the sum keeps the limits of the axis. The superimposed motion gets at most half of the
 * acceleration and jerk, and the base is planned anew with the rest; a base that needs no more than the rest keeps its
 * time (3.8). Both change with the same jerk, so that the sum also keeps the limits during the change. A base that is
 * about to arrive and needs its whole deceleration for that gets it; then the superimposed motion begins later. The
 * velocity of a follower is that of its master, which is not shared: where it takes the limits, the superimposed motion
 * goes on with less acceleration, or the sum with more jerk (coupling/coupled_sum.c). If a command takes over from a
 * follower that is faster than the rest, or is a halt that would pass a software limit with the rest, the command gets
 * the whole motion, and the superimposed motion waits, with what it has covered, until there is room for it again. On
 * an axis in Standstill the superimposed motion has all limits.
 *
 * Of the plan the axis keeps from what it was made, and makes it again when the motion comes to its next stretch: few
 * axes have such a motion, and the profile would be an eighth of the memory of all of them.
 *
 * During a superimposed motion the base counts its positions without it. At its end the base and its target are shifted
 * by what it has covered.
 */
#include <math.h>

#include "axis/axis_superimpose.h"
#include "axis/axis_commands.h"
#include "axis/axis_events.h"
#include "axis/axis_extras.h"
#include "axis/axis_in_position.h"
#include "axis/axis_limits.h"
#include "axis/axis_plan.h"
#include "axis/axis_position.h"
#include "axis/axis_setpoint.h"

static const double same_moment = 1e-6; /* cycles */

/* ---- planning ---------------------------------------------------------------------------------------------------- */

static cm1e_error_t make_profile(const on_top_plan_t *plan, cm1e_profile_t *profile)
{
    return isnan(plan->target) ? cm1e_profile_to_velocity(profile, &plan->start, 0.0, &plan->limits)
                               : cm1e_profile_to_position(profile, &plan->start, plan->target, &plan->limits);
}

static bool plan_with(const cm1e_axis_t *axis, const override_t *override, superimposed_t *on_top,
                      cm1e_profile_t *profile, bool *strays)
{
    const double target = on_top->move.position;
    const bool stops = on_top->paused || on_top->move.kind == CM1E_COMMAND_HALT_SUPERIMPOSED;
    on_top_plan_t made = {.start = on_top->now, .target = stops ? NAN : target};
    if (cm1e_axis_limits_on_top(axis, on_top, override, &made.limits) != CM1E_OK)
        return false;
    if (stops)
        cm1e_axis_keep_direction(axis, on_top->now.velocity, on_top->now.acceleration, on_top->share.jerk,
                                 &made.limits);
    if (make_profile(&made, profile) != CM1E_OK)
        return false;
    made.duration_s = profile->duration_s;
    made.end = profile->end.position;
    on_top->plan = made;
    const bool has_target = on_top->move.kind == CM1E_COMMAND_MOVE_SUPERIMPOSED;
    *strays = cm1e_axis_strays(axis, &on_top->now, has_target ? &target : NULL, profile);
    return true;
}

/* The state at a time of the plan. */
static void sample(on_top_plan_t *plan, double time_s, cm1e_motion_state_t *state)
{
    cm1e_profile_t profile;
    if (!(time_s >= plan->stretch.from_s && time_s < plan->stretch.until_s) && make_profile(plan, &profile) == CM1E_OK)
        cm1e_profile_stretch_at(&profile, time_s, &plan->stretch);
    *state = cm1e_profile_stretch_state(&plan->stretch, time_s);
}

/* Plans the superimposed motion. An override reduces it no more than cm1e_axis_plan() allows. */
static bool plan(const cm1e_axis_t *axis, superimposed_t *on_top)
{
    const override_t full = {axis->override.velocity, 1.0, 1.0};
    cm1e_profile_t profile;
    bool strays;
    on_top->paused = axis->override.velocity == 0.0 && on_top->move.kind == CM1E_COMMAND_MOVE_SUPERIMPOSED;
    on_top->cycles = 0;
    if (!plan_with(axis, &axis->override, on_top, &profile, &strays) ||
        (strays && !plan_with(axis, &full, on_top, &profile, &strays)))
        return false;
    cm1e_profile_extent(&profile, &on_top->lowest, &on_top->highest);
    return true;
}

/* u/s; the maximum of the present and the commanded velocities of the base, with those of waiting commands. */
static double base_velocity(cm1e_axis_t *axis)
{
    const from_t from = from_base(axis);
    double fastest = fabs(from.velocity);
    const bool has_own = axis->commands.active && kind_row(axis->commands.kind)->plan != PLAN_KEEP_VELOCITY;
    if (has_own && !axis_follows(axis)) /* Velocity of MC_GearInPos is that of its approach */
        fastest = fmax(fastest, fmax(fabs(axis->commands.move.velocity), fabs(axis->commands.move.end_velocity)));
    for (int i = 0; i < axis->commands.waiting.count; i++) {
        const waiting_t *move = waiting_move(axis, i);
        fastest = fmax(fastest, fmax(fabs(move->velocity), fabs(move->end_velocity)));
    }
    return fastest;
}

/* The velocity that the base reaches until its acceleration has ended, also if it changes its direction. */
static double peak_of(const from_t *from, double jerk)
{
    const double a = from->acceleration;
    return fmax(fabs(from->velocity), fabs(from->velocity + a * fabs(a) / (2.0 * jerk)));
}

static cm1e_motion_limits_t share_of(const cm1e_axis_t *axis, const cm1e_motion_limits_t *asked)
{
    const cm1e_motion_limits_t *most = &axis->limits.maximum;
    const double half = fmin(most->acceleration, most->deceleration) / 2.0;
    const double acceleration = fmin(fmax(asked->acceleration, asked->deceleration), half);
    return (cm1e_motion_limits_t){asked->velocity, acceleration, acceleration, fmin(asked->jerk, most->jerk / 2.0)};
}

/* Whether a halt with the rest of the limits would pass a software limit. */
static bool needs_all_to_halt(const cm1e_axis_t *axis, const from_t *from, const move_t *move)
{
    const cm1e_motion_state_t start = {0.0, from->velocity, from->acceleration};
    cm1e_motion_limits_t limits;
    cm1e_profile_t stop;
    return move->kind == CM1E_COMMAND_HALT && axis->limits.software_limits &&
           (cm1e_axis_limits_of(axis, from, move, &limits) != CM1E_OK ||
            cm1e_profile_to_velocity(&stop, &start, 0.0, &limits) != CM1E_OK ||
            !cm1e_axis_limits_contain(axis, from, &stop));
}

/* u/s; what both may have together: the maximum, but where that was lowered. */
static double velocity_of_both(const cm1e_axis_t *axis)
{
    return axis->superimposed.share.velocity + cm1e_axis_velocity_beside(axis);
}

/* Plans the base with the rest of the limits; false: that is not possible now. */
static bool base_gives_way(cm1e_axis_t *axis)
{
    if (axis->setpoint.stands)
        return true;
    const from_t from = from_base(axis);
    if (axis->commands.active && needs_all_to_halt(axis, &from, &axis->commands.move))
        return false;
    const double peak = peak_of(&from, axis->limits.maximum.jerk / 2.0);
    if (!axis->commands.active || peak + axis->superimposed.share.velocity > velocity_of_both(axis))
        return false;
    return axis->setpoint.reached || cm1e_axis_replan_if(axis); /* InVelocity stays (3.10) */
}

static bool begin(cm1e_axis_t *axis)
{
    superimposed_t *on_top = &axis->superimposed;
    on_top->moving = true;
    if (base_gives_way(axis) && plan(axis, on_top))
        return true;
    on_top->moving = false;
    return false;
}

bool cm1e_axis_superimposed_give_way(cm1e_axis_t *axis, const move_t *move, from_t *from)
{
    static const double rounding = 1.0 + 1e-9;
    superimposed_t *on_top = &axis->superimposed;
    const double peak = peak_of(from, axis->limits.maximum.jerk - on_top->share.jerk);
    if (!from->shared || (peak + on_top->share.velocity <= velocity_of_both(axis) * rounding &&
                          !needs_all_to_halt(axis, from, move)))
        return false;
    on_top->moving = false;
    on_top->now.velocity = on_top->now.acceleration = 0.0;
    *from = from_base(axis);
    return true;
}

/* ---- its place in the base --------------------------------------------------------------------------------------- */

/* Makes the distance covered so far a part of the base. */
static void give_to_base(cm1e_axis_t *axis)
{
    const double covered = axis->superimposed.now.position, counts = covered * axis->position.scale;
    cm1e_axis_shift_profile(axis, counts);
    if (axis_follows(axis))
        axis->coupling_hooks->shift(axis, covered);
    if (axis->commands.active)
        cm1e_axis_shift_move(axis, counts);
    axis->superimposed.now.position = 0.0;
}

static void set_id(cm1e_axis_t *axis, cm1e_command_id_t id)
{
    axis->superimposed.id = id;
    cm1e_axis_set_extra(axis, EXTRA_ON_TOP, id != 0);
}

static void record(cm1e_axis_t *axis, cm1e_command_state_t state, cm1e_error_t error)
{
    superimposed_t *on_top = &axis->superimposed;
    cm1e_axis_record(axis, on_top->id, state, error);
    cm1e_axis_remember_end(axis, (cm1e_command_kind_t)on_top->move.kind, error);
    on_top->ended = on_top->id;
    on_top->covered = on_top->now.position;
    set_id(axis, 0);
}

void cm1e_axis_superimposed_end(cm1e_axis_t *axis, cm1e_command_state_t state, cm1e_error_t error)
{
    if (!axis->superimposed.id)
        return;
    record(axis, state, error);
    axis->superimposed.moving = false;
    axis->superimposed.now = (cm1e_motion_state_t){0};
    cm1e_axis_set_stands(axis, false);
}

void cm1e_axis_superimposed_abandon(cm1e_axis_t *axis)
{
    if (!axis->superimposed.id)
        return;
    record(axis, CM1E_COMMAND_ABORTED, CM1E_OK);
    give_to_base(axis);
    axis->superimposed.moving = false;
    cm1e_axis_set_stands(axis, false);
    axis->superimposed.now = (cm1e_motion_state_t){0};
}

/* The base has reached a velocity, but a smaller one than it was commanded: what was left for it. */
static bool falls_short(cm1e_axis_t *axis)
{
    static const double rounding = 1.0 + 1e-9;
    const move_t *move = &axis->commands.move;
    const from_t from = from_base(axis);
    const command_plan_t plan = kind_row(move->kind)->plan;
    const bool through = plan == PLAN_THROUGH_TARGET;
    cm1e_motion_limits_t limits;
    if (!axis->commands.active || !(through || plan == PLAN_VELOCITY) || axis->setpoint.paused ||
        cm1e_axis_limits_of(axis, &from, move, &limits) != CM1E_OK)
        return false;
    const double commanded = through ? fabs(cm1e_axis_exit_velocity(axis, &from, move)) : limits.velocity;
    return commanded > fabs(axis->setpoint.profile.end.velocity) * rounding;
}

static void finish(cm1e_axis_t *axis)
{
    superimposed_t *on_top = &axis->superimposed;
    on_top->now.position = on_top->moving ? on_top->plan.end : on_top->now.position;
    record(axis, CM1E_COMMAND_DONE, CM1E_OK);
    give_to_base(axis);
    on_top->now = (cm1e_motion_state_t){0};
    on_top->moving = false;
    if (axis->setpoint.stands)
        cm1e_axis_stand(axis);
    else if (!axis->setpoint.reached || falls_short(axis))
        (void)cm1e_axis_replan(axis);
    if (axis->setpoint.reached && axis->commands.waiting.count > 0) { /* they waited for the end of this motion */
        const from_t from = from_set(axis);
        (void)cm1e_axis_begin_waiting(axis, &from, 0.0);
    }
}

/* ---- commands ---------------------------------------------------------------------------------------------------- */

double cm1e_axis_superimposed_goal(const cm1e_axis_t *axis)
{
    const superimposed_t *on_top = &axis->superimposed;
    if (!on_top->id)
        return 0.0;
    if (on_top->move.kind == CM1E_COMMAND_MOVE_SUPERIMPOSED)
        return on_top->move.position;
    return on_top->moving ? on_top->plan.end : on_top->now.position;
}

/* Whether the present position and the target of the base, with the superimposed distance, are inside the software
 * limits. What a motion that is replaced has covered becomes a part of the base. */
static bool inside(cm1e_axis_t *axis, double distance, bool replaces)
{
    const double covered = replaces ? axis->superimposed.now.position * axis->position.scale : 0.0;
    const position_t base = from_base(axis).position;
    const bool rests = axis->setpoint.stands || axis_holds(axis);
    const command_kind_t *kind = kind_row(axis->commands.kind);
    position_t ends[CM1E_AXIS_BUFFER_DEPTH + 2] = {
        cm1e_position_plus(base, covered), cm1e_position_plus(rests ? base : axis->setpoint.target, covered)};
    int count = axis->commands.active && (kind->is_endless || kind->plan == PLAN_COUPLING) ? 1 : 2;
    for (int i = 0; i < axis->commands.waiting.count; i++)
        if (kind_row(waiting_move(axis, i)->kind)->plan == PLAN_TO_TARGET)
            ends[count++] = waiting_move(axis, i)->target;
    for (int i = 0; i < count; i++) {
        const from_t from = {ends[i], 0.0, 0.0, false};
        if (!cm1e_axis_limits_contain_target(axis, &from, cm1e_position_plus(ends[i], distance * axis->position.scale)))
            return false;
    }
    return true;
}

/* `replaces`: it takes the place of a superimposed motion, and does not only change its inputs. */
static cm1e_error_t check(cm1e_axis_t *axis, const move_t *move, bool alone, bool replaces,
                          cm1e_motion_limits_t *limits)
{
    static const override_t none = {1.0, 1.0, 1.0};
    const from_t rest = {axis->setpoint.position, 0.0, 0.0, false};
    const cm1e_error_t error = axis->commands.active && !kind_row(axis->commands.kind)->carries_superimposed
                                   ? CM1E_ERROR_AXIS_STATE /* the drive has its own times and limits */
                                   : cm1e_axis_limits_with(axis, &rest, move, &none, limits);
    const double counts = move->position * axis->position.scale;
    if (error != CM1E_OK)
        return error;
    if (!isfinite(counts) || fabs(counts) > 4.5e15 || !inside(axis, move->position, replaces))
        return CM1E_ERROR_AXIS_POSITION_RANGE;
    if (!cm1e_axis_direction_enabled(axis, move->position))
        return CM1E_ERROR_AXIS_DIRECTION_DISABLED;
    const double most = axis->limits.maximum.velocity * (1.0 + 1e-9);
    return !alone && move->velocity + base_velocity(axis) > most ? CM1E_ERROR_AXIS_VELOCITY_RANGE : CM1E_OK;
}

/* Makes the base of an axis in Standstill: it stays at its position. */
static void stand_as_base(cm1e_axis_t *axis)
{
    const from_t from = from_set(axis);
    const cm1e_motion_state_t rest = {0};
    cm1e_profile_t profile;
    cm1e_axis_settled(axis);
    (void)cm1e_profile_to_velocity(&profile, &rest, 0.0, &axis->limits.maximum);
    cm1e_axis_run(axis, &from, &profile, axis->setpoint.position, 0.0);
    cm1e_axis_set_stands(axis, true);
}

/* Whether a plan goes no farther in a disabled direction than the braking under way. */
static bool directions_allow(const cm1e_axis_t *axis, const superimposed_t *on_top)
{
    const on_top_plan_t stop = {.start = on_top->now, .target = NAN, .limits = on_top->share};
    cm1e_profile_t profile, brake;
    return (axis->power.enable_positive && axis->power.enable_negative) ||
           (make_profile(&on_top->plan, &profile) == CM1E_OK && make_profile(&stop, &brake) == CM1E_OK &&
            cm1e_axis_directions_allow(axis, &profile, &brake));
}

/* Whether the superimposed motion can go on as `move` from its present state. This is tested before anything changes,
 * because the present motion cannot end at once. */
static cm1e_error_t check_going_on(const cm1e_axis_t *axis, const move_t *move, bool alone,
                                   const cm1e_motion_limits_t *share)
{
    superimposed_t trial = {.move = *move, .alone = alone, .share = *share, .now = axis->superimposed.now};
    trial.now.position = 0.0;
    if (!plan(axis, &trial)) /* the values are too small, perhaps by MC_SetOverride */
        return cm1e_axis_cannot_plan(axis, move, CM1E_ERROR_AXIS_DYNAMICS_RANGE);
    const bool halts = move->kind == CM1E_COMMAND_HALT_SUPERIMPOSED; /* none is refused */
    return halts || directions_allow(axis, &trial) ? CM1E_OK : CM1E_ERROR_AXIS_DIRECTION_DISABLED;
}

static cm1e_error_t superimpose(cm1e_axis_t *axis, const move_t *move, cm1e_command_id_t *id)
{
    superimposed_t *on_top = &axis->superimposed;
    const bool replaces = on_top->id && on_top->moving, alone = axis_holds(axis) || (replaces && on_top->alone);
    cm1e_motion_limits_t limits;
    cm1e_error_t error = check(axis, move, alone, on_top->id != 0, &limits);
    if (error != CM1E_OK)
        return error;
    /* A motion that replaces another one gets the share of that one. */
    const cm1e_motion_limits_t share = replaces ? on_top->share : alone ? axis->limits.maximum
                                       : share_of(axis, &limits);
    error = check_going_on(axis, move, alone, &share);
    if (error != CM1E_OK)
        return error;
    if (axis_holds(axis))
        stand_as_base(axis);
    if (on_top->id)
        record(axis, CM1E_COMMAND_ABORTED, CM1E_OK);
    give_to_base(axis);
    *id = cm1e_axis_next_id(axis);
    set_id(axis, *id);
    on_top->move = *move;
    on_top->alone = alone;
    on_top->share = share;
    on_top->lowest = fmin(move->position, 0.0);
    on_top->highest = fmax(move->position, 0.0);
    (void)(replaces ? plan(axis, on_top) : begin(axis));
    return CM1E_OK;
}

static cm1e_error_t halt(cm1e_axis_t *axis, const move_t *move, cm1e_command_id_t *id)
{
    superimposed_t *on_top = &axis->superimposed;
    const from_t rest = {axis->setpoint.position, 0.0, 0.0, false};
    cm1e_motion_limits_t limits;
    cm1e_error_t error = cm1e_axis_limits_of(axis, &rest, move, &limits);
    if (error == CM1E_OK && on_top->moving)
        error = check_going_on(axis, move, on_top->alone, &on_top->share);
    if (error != CM1E_OK)
        return error;
    *id = cm1e_axis_next_id(axis);
    if (!on_top->id) {
        cm1e_axis_record(axis, *id, CM1E_COMMAND_DONE, CM1E_OK); /* there is no superimposed motion */
        return CM1E_OK;
    }
    record(axis, CM1E_COMMAND_ABORTED, CM1E_OK);
    give_to_base(axis);
    set_id(axis, *id);
    on_top->move = *move;
    if (on_top->moving)
        (void)plan(axis, on_top);
    else
        finish(axis);
    return CM1E_OK;
}

cm1e_error_t cm1e_axis_superimpose(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id)
{
    const move_t move = cm1e_axis_move_of(command);
    return command->kind == CM1E_COMMAND_HALT_SUPERIMPOSED ? halt(axis, &move, id) : superimpose(axis, &move, id);
}

/* ContinuousUpdate: new inputs act within the share with which the motion began. */
cm1e_error_t cm1e_axis_superimpose_update(cm1e_axis_t *axis, cm1e_command_id_t id, const cm1e_axis_command_t *command)
{
    superimposed_t *on_top = &axis->superimposed;
    const move_t inputs = cm1e_axis_move_of(command);
    if (command->kind == CM1E_COMMAND_HALT_SUPERIMPOSED)
        return CM1E_ERROR_INVALID_ARGUMENT;
    if (id != on_top->id)
        return CM1E_OK; /* the command has ended */
    if (inputs.kind != on_top->move.kind)
        return CM1E_ERROR_INVALID_ARGUMENT;
    if (cm1e_axis_same_inputs(&on_top->move, &inputs))
        return CM1E_OK;
    cm1e_motion_limits_t limits;
    const cm1e_error_t error = check(axis, &inputs, true, false, &limits);
    if (error != CM1E_OK)
        return error;
    superimposed_t next = *on_top;
    next.move = inputs;
    if (!plan(axis, &next))
        return cm1e_axis_cannot_plan(axis, &inputs, CM1E_ERROR_AXIS_DYNAMICS_RANGE);
    if (!directions_allow(axis, &next))
        return CM1E_ERROR_AXIS_DIRECTION_DISABLED;
    *on_top = next;
    return CM1E_OK;
}

void cm1e_axis_superimposed_replan(cm1e_axis_t *axis)
{
    superimposed_t next = axis->superimposed;
    if (next.id && next.moving && plan(axis, &next))
        axis->superimposed = next;
}

bool cm1e_axis_superimposed_slow(cm1e_axis_t *axis, double part)
{
    superimposed_t slower = axis->superimposed;
    slower.now.velocity *= part;
    slower.now.acceleration *= part * part;
    if (slower.moving && !plan(axis, &slower))
        return false;
    axis->superimposed = slower;
    return true;
}

bool cm1e_axis_superimposed_goes(const cm1e_axis_t *axis, double sign)
{
    const superimposed_t *on_top = &axis->superimposed;
    return on_top->id && (on_top->now.velocity * sign > 0.0 ||
                          (on_top->move.position - on_top->now.position) * sign > axis->limits.tolerance);
}

/* ---- the cycle --------------------------------------------------------------------------------------------------- */

void cm1e_axis_superimposed_step(cm1e_axis_t *axis, cm1e_motion_state_t *next)
{
    superimposed_t *on_top = &axis->superimposed;
    if (on_top->moving)
        sample(&on_top->plan, (double)++on_top->cycles * axis->cycle_s, &on_top->now);
    next->position += on_top->now.position;
    next->velocity += on_top->now.velocity;
    next->acceleration += on_top->now.acceleration;
}

/* Whether it stays within the velocity that it is to have (0 if it comes to rest), or does not become faster, if its
 * acceleration ends with its own jerk. */
static bool keeps_velocity(const superimposed_t *on_top)
{
    static const double rounding = 1.0 + 1e-9;
    const double most = isnan(on_top->plan.target) ? 0.0 : on_top->plan.limits.velocity;
    const from_t from = {.velocity = on_top->now.velocity, .acceleration = on_top->now.acceleration};
    return peak_of(&from, on_top->share.jerk) <= fmax(most, fabs(from.velocity)) * rounding;
}

static bool passes_target(const cm1e_axis_t *axis, const superimposed_t *on_top)
{
    const double target = on_top->move.position, now = on_top->now.position, tolerance = axis->limits.tolerance;
    return on_top->move.kind == CM1E_COMMAND_MOVE_SUPERIMPOSED && !on_top->paused &&
           (on_top->highest > fmax(target, now) + tolerance || on_top->lowest < fmin(target, now) - tolerance);
}

/* Its state after `t`, in which its acceleration changes evenly to `acceleration`. */
static void advance(cm1e_motion_state_t *state, double acceleration, double t)
{
    const double v = state->velocity, a = state->acceleration;
    *state = (cm1e_motion_state_t){state->position + t * (v + t * (2.0 * a + acceleration) / 6.0),
                                   v + t * (a + acceleration) / 2.0, acceleration};
}

bool cm1e_axis_superimposed_hold(cm1e_axis_t *axis, bool to_target)
{
    superimposed_t held = axis->superimposed;
    advance(&held.now, held.now.acceleration, axis->cycle_s);
    if (!keeps_velocity(&held) || !plan(axis, &held) || (to_target && passes_target(axis, &held)))
        return false;
    axis->superimposed = held;
    return true;
}

bool cm1e_axis_superimposed_ease(cm1e_axis_t *axis)
{
    superimposed_t eased = axis->superimposed;
    const double a = eased.now.acceleration, jerk = axis->limits.maximum.jerk, t = axis->cycle_s;
    const double changing = fmin(t, fabs(a) / jerk);
    advance(&eased.now, fabs(a) > jerk * t ? a - copysign(jerk * t, a) : 0.0, changing);
    advance(&eased.now, eased.now.acceleration, t - changing);
    if (a == 0.0 || !plan(axis, &eased))
        return false;
    axis->superimposed = eased;
    return true;
}

void cm1e_axis_superimposed_put_back(cm1e_axis_t *axis, const superimposed_t *before) { axis->superimposed = *before; }

void cm1e_axis_superimposed_after(cm1e_axis_t *axis)
{
    superimposed_t *on_top = &axis->superimposed;
    if (!on_top->moving) {
        (void)begin(axis);
        return;
    }
    const double time_s = (double)on_top->cycles * axis->cycle_s;
    if (!on_top->paused && time_s >= on_top->plan.duration_s - same_moment * axis->cycle_s)
        finish(axis);
}
