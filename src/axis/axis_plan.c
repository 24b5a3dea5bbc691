/* The profile of each kind of command, from any state of motion. Nothing here changes the axis. */
#include <math.h>

#include "axis/axis_plan.h"
#include "axis/axis_commands.h"
#include "axis/axis_limits.h"
#include "axis/axis_position.h"
#include "core/extreme.h"

static cm1e_motion_state_t start_of(const from_t *from)
{
    return (cm1e_motion_state_t){0.0, from->velocity, from->acceleration};
}

/* ---- targets ----------------------------------------------------------------------------------------------------- */

/* The distance that the command needs to stop. On a modulo axis it decides which repetition of the position is the
 * first. */
static cm1e_error_t stopping_way(const cm1e_axis_t *axis, const from_t *from, const move_t *move, double *way)
{
    cm1e_motion_limits_t limits;
    cm1e_profile_t stop;
    const cm1e_motion_state_t start = start_of(from);
    cm1e_error_t error = cm1e_axis_limits_of(axis, from, move, &limits);
    if (error == CM1E_OK && (cm1e_profile_to_velocity(&stop, &start, 0.0, &limits) != CM1E_OK ||
                             !cm1e_axis_can_count(axis, stop.end.position)))
        error = cm1e_axis_cannot_plan(axis, move, CM1E_ERROR_AXIS_DYNAMICS_RANGE);
    *way = error != CM1E_OK ? 0.0 : stop.end.position;
    return error;
}

/* Where a position lies after a shift of the coordinates; MC_SetPosition itself takes no other than one in the range.
 * */
static double shifted(const cm1e_axis_t *axis, const move_t *move)
{
    const double range = axis->position.modulo_range, position = move->position + move->shift;
    if (move->shift == 0.0 || !(range > 0.0))
        return position;
    const double turned = position - range * floor(position / range);
    return turned >= 0.0 && turned < range ? turned : 0.0;
}

static cm1e_error_t resolve_absolute(const cm1e_axis_t *axis, const from_t *from, move_t *move)
{
    double way = 0.0;
    const cm1e_error_t error = axis->position.modulo_range > 0.0 ? stopping_way(axis, from, move, &way) : CM1E_OK;
    return error != CM1E_OK ? error : cm1e_axis_resolve_target(axis, shifted(axis, move), (MC_DIRECTION)move->direction,
                                                    from->position, from->velocity, way, &move->target);
}

static cm1e_error_t resolve_relative(const cm1e_axis_t *axis, const from_t *from, move_t *move)
{
    (void)from;
    const double counts = move->position * axis->position.scale;
    if (!cm1e_position_reaches(move->origin, counts))
        return CM1E_ERROR_AXIS_POSITION_RANGE;
    move->target = cm1e_position_plus(move->origin, counts);
    return CM1E_OK;
}

static cm1e_error_t resolve_none(const cm1e_axis_t *axis, const from_t *from, move_t *move)
{
    (void)axis;
    move->target = from->position;
    return CM1E_OK;
}

/* ---- profiles ---------------------------------------------------------------------------------------------------- */

/* Whether a profile overruns a target. */
static bool passes(const cm1e_axis_t *axis, const cm1e_profile_t *profile, double start, double target)
{
    double lowest, highest;
    cm1e_profile_extent(profile, &lowest, &highest);
    return target > start ? highest > target + axis->limits.tolerance : lowest < target - axis->limits.tolerance;
}

/* Whether a motion that goes on in its direction turns round on the way to its end. What is left of an acceleration may
 * need more jerk than there is now, to end before the axis stands. */
static bool turns_back(const cm1e_axis_t *axis, double velocity, const cm1e_profile_t *profile)
{
    static const double rounding = 0.01; /* a way back within the tolerance would become a larger one when replanned */
    return velocity != 0.0 && profile->end.velocity * velocity >= 0.0 &&
           cm1e_profile_way_back(profile, velocity) > rounding * axis->limits.tolerance;
}

bool cm1e_axis_strays(const cm1e_axis_t *axis, const cm1e_motion_state_t *start, const double *target,
                      const cm1e_profile_t *profile)
{
    const double velocity = start->velocity != 0.0 ? start->velocity : start->acceleration;
    if (target && passes(axis, profile, start->position, *target))
        return true;
    return (!target || velocity * (*target - start->position) > 0.0) && turns_back(axis, velocity, profile);
}

bool cm1e_axis_profile_strays(const cm1e_axis_t *axis, const from_t *from, const move_t *move,
                              const cm1e_profile_t *profile)
{
    const command_plan_t plan = kind_row(move->kind)->plan;
    const cm1e_motion_state_t start = start_of(from);
    const double target = cm1e_position_minus(move->target, from->position) / axis->position.scale;
    if (plan == PLAN_THROUGH_TARGET && !move->passing) /* its run-up may lead anywhere, unless the position is ahead */
        return from->velocity * target > 0.0 && cm1e_axis_strays(axis, &start, NULL, profile);
    return cm1e_axis_strays(axis, &start, plan == PLAN_TO_TARGET && !move->paused ? &target : NULL, profile);
}

static bool slowed(const cm1e_axis_t *axis)
{
    return axis->override.velocity < 1.0 || axis->override.acceleration < 1.0 || axis->override.jerk < 1.0;
}

static cm1e_error_t plan_to_target(const cm1e_axis_t *axis, const from_t *from, move_t *move, cm1e_profile_t *profile)
{
    const double distance = cm1e_position_minus(move->target, from->position) / axis->position.scale;
    cm1e_motion_limits_t limits;
    const cm1e_error_t error = cm1e_axis_limits_of(axis, from, move, &limits);
    if (error != CM1E_OK)
        return error;
    const cm1e_motion_state_t start = start_of(from);
    if (cm1e_profile_to_state(profile, &start, distance, move->exit_velocity, &limits) != CM1E_OK)
        return cm1e_axis_cannot_plan(axis, move, CM1E_ERROR_AXIS_POSITION_RANGE);
    return cm1e_axis_limits_check(axis, from, profile);
}

cm1e_error_t cm1e_axis_signed_velocity(const cm1e_axis_t *axis, const from_t *from, const move_t *move,
                                       double *velocity)
{
    bool positive; /* 3.10: the direction of Direction, turned round by a negative Velocity */
    switch (move->direction) {
    case 0:
    case mcPositiveDirection:
        positive = true;
        break;
    case mcNegativeDirection:
        positive = false;
        break;
    case mcCurrentDirection:
        positive = cm1e_axis_goes_positive(axis, from->velocity);
        break;
    default: /* there is no shortest way to a velocity */
        return CM1E_ERROR_AXIS_DIRECTION;
    }
    *velocity = positive ? move->velocity : -move->velocity;
    return CM1E_OK;
}

bool cm1e_axis_directions_allow(const cm1e_axis_t *axis, const cm1e_profile_t *profile, const cm1e_profile_t *brake)
{
    const double tolerance = axis->limits.tolerance;
    return (axis->power.enable_positive ||
            cm1e_profile_way_back(profile, -1.0) <= cm1e_profile_way_back(brake, -1.0) + tolerance) &&
           (axis->power.enable_negative ||
            cm1e_profile_way_back(profile, 1.0) <= cm1e_profile_way_back(brake, 1.0) + tolerance);
}

/* Whether the directions permit a profile. */
static bool directions_allow(const cm1e_axis_t *axis, const from_t *from, const cm1e_profile_t *profile)
{
    cm1e_profile_t brake;
    if (axis->power.enable_positive && axis->power.enable_negative)
        return true;
    return cm1e_axis_plan_stop(axis, from, &axis->limits.maximum, &brake) == CM1E_OK &&
           cm1e_axis_directions_allow(axis, profile, &brake);
}

/* Whether an endless motion first goes over the limit that lies behind it: what is left of a braking may need more jerk
 * than there is now, to end before the axis stands. */
static bool swings_out(const cm1e_axis_t *axis, const from_t *from, const cm1e_profile_t *profile)
{
    double lowest, highest;
    cm1e_profile_extent(profile, &lowest, &highest);
    return profile->end.velocity > 0.0 ? !cm1e_axis_limits_contain_way(axis, from, lowest, 0.0)
                                       : !cm1e_axis_limits_contain_way(axis, from, 0.0, highest);
}

/* Checks an endless motion: the directions of its way must be permitted, and it must be able to brake before a
 * limit. */
static cm1e_error_t check_endless(const cm1e_axis_t *axis, const from_t *from, const cm1e_profile_t *profile)
{
    const double velocity = profile->end.velocity, now = cm1e_axis_line(axis, from->position);
    if (!cm1e_axis_direction_enabled(axis, velocity) || !directions_allow(axis, from, profile))
        return CM1E_ERROR_AXIS_DIRECTION_DISABLED;
    const limits_t *most = &axis->limits;
    if (most->software_limits && (velocity > 0.0 ? now >= most->upper : velocity < 0.0 && now <= most->lower))
        return CM1E_ERROR_AXIS_POSITION_RANGE;
    cm1e_motion_state_t next;
    cm1e_profile_sample(profile, axis->cycle_s, &next);
    const bool inside = cm1e_axis_limits_can_stop(axis, now, next) && !swings_out(axis, from, profile);
    return inside ? CM1E_OK : CM1E_ERROR_AXIS_POSITION_RANGE;
}

static cm1e_error_t plan_velocity(const cm1e_axis_t *axis, const from_t *from, move_t *move, cm1e_profile_t *profile)
{
    cm1e_motion_limits_t limits;
    double velocity;
    cm1e_error_t error = cm1e_axis_limits_of(axis, from, move, &limits);
    if (error == CM1E_OK)
        error = cm1e_axis_signed_velocity(axis, from, move, &velocity);
    if (error != CM1E_OK)
        return error;
    const cm1e_motion_state_t start = start_of(from);
    if (cm1e_profile_to_velocity(profile, &start, copysign(limits.velocity, velocity), &limits) != CM1E_OK)
        return cm1e_axis_cannot_plan(axis, move, CM1E_ERROR_AXIS_VELOCITY_RANGE);
    return check_endless(axis, from, profile);
}

/* u/s; what a superimposed motion leaves of the maximum. */
static double velocity_left(const cm1e_axis_t *axis, const from_t *from)
{
    return from->shared ? cm1e_axis_velocity_beside(axis) : axis->limits.maximum.velocity;
}

/* Plans a motion through the position with the end velocity (3.11); if necessary the axis goes back first. If the
 * position lies ahead, and only the way is too short to reach the end velocity there, the axis does not go back. It
 * passes the position with a lower velocity and reaches the end velocity later. */
static cm1e_error_t plan_through_target(const cm1e_axis_t *axis, const from_t *from, move_t *move,
                                        cm1e_profile_t *profile)
{
    cm1e_motion_limits_t limits;
    const cm1e_error_t error = cm1e_axis_limits_of(axis, from, move, &limits);
    if (error != CM1E_OK)
        return error;
    const cm1e_motion_state_t start = start_of(from);
    const double distance = cm1e_position_minus(move->target, from->position) / axis->position.scale;
    const double left = velocity_left(axis, from);
    const double end = larger(-left, smaller(move->exit_velocity, left)), cruise = limits.velocity;
    limits.velocity = larger(cruise, fabs(end));
    if (cm1e_profile_to_velocity(profile, &start, end, &limits) != CM1E_OK)
        return cm1e_axis_cannot_plan(axis, move, CM1E_ERROR_AXIS_VELOCITY_RANGE);
    const double needed = profile->end.position;
    if (end > 0.0 ? distance > 0.0 && needed >= distance : end < 0.0 && distance < 0.0 && needed <= distance)
        move->passing = true;
    if (move->passing)
        return check_endless(axis, from, profile);
    limits.velocity = cruise;
    if (cm1e_profile_to_state(profile, &start, distance, end, &limits) != CM1E_OK)
        return cm1e_axis_cannot_plan(axis, move, CM1E_ERROR_AXIS_POSITION_RANGE);
    if (!cm1e_axis_direction_enabled(axis, end))
        return CM1E_ERROR_AXIS_DIRECTION_DISABLED;
    return cm1e_axis_limits_check(axis, from, profile);
}

cm1e_error_t cm1e_axis_plan_stop(const cm1e_axis_t *axis, const from_t *from, const cm1e_motion_limits_t *limits,
                                 cm1e_profile_t *profile)
{
    const cm1e_motion_state_t start = start_of(from);
    cm1e_motion_limits_t enough = *limits;
    cm1e_axis_keep_below_maximum(axis, from, &enough);
    const cm1e_error_t error = cm1e_profile_to_velocity(profile, &start, 0.0, &enough);
    if (error != CM1E_OK || cm1e_axis_limits_contain(axis, from, profile))
        return error;
    return cm1e_profile_to_velocity(profile, &start, 0.0, &axis->limits.emergency);
}

static const override_t no_override = {1.0, 1.0, 1.0};

void cm1e_axis_keep_direction(const cm1e_axis_t *axis, double v, double a, double most_jerk,
                              cm1e_motion_limits_t *limits)
{
    if (v * a < 0.0 && !cm1e_axis_direction_enabled(axis, a))
        limits->jerk = larger(limits->jerk, smaller(a * a / (2.0 * fabs(v)), most_jerk));
}

/* Plans a stop by a command, with the override as far as the stop then keeps the software limits. */
static cm1e_error_t plan_stop(const cm1e_axis_t *axis, const from_t *from, move_t *move, cm1e_profile_t *profile)
{
    cm1e_motion_limits_t limits;
    const cm1e_motion_state_t start = start_of(from);
    cm1e_error_t error = cm1e_axis_limits_of(axis, from, move, &limits);
    if (error != CM1E_OK)
        return error;
    if (kind_row(move->kind)->is_stop && !from->shared)
        cm1e_axis_keep_direction(axis, from->velocity, from->acceleration, axis->limits.maximum.jerk, &limits);
    /* The other numbers are the axis's own, so the inputs are too small to compute with. */
    if (cm1e_profile_to_velocity(profile, &start, 0.0, &limits) != CM1E_OK)
        return CM1E_ERROR_AXIS_DYNAMICS_RANGE;
    if (cm1e_axis_limits_contain(axis, from, profile))
        return CM1E_OK;
    error = cm1e_axis_limits_with(axis, from, move, &no_override, &limits);
    return error != CM1E_OK ? error : cm1e_axis_plan_stop(axis, from, &limits, profile);
}

/* Plans the motion after a master was left: it keeps the velocity (4.4, 4.6). A VelFactor that is smaller than the one
 * of that time, move->velocity, reduces it; none makes it faster than it was. */
static cm1e_error_t plan_kept(const cm1e_axis_t *axis, const from_t *from, move_t *move, cm1e_profile_t *profile)
{
    static const double next_to_nothing = 1e-12;
    cm1e_motion_limits_t limits;
    const cm1e_motion_state_t start = start_of(from);
    const cm1e_error_t error = cm1e_axis_limits_of(axis, from, move, &limits);
    if (error != CM1E_OK)
        return error;
    const double left = velocity_left(axis, from);
    const double factor = axis->override.velocity > 0.0 ? smaller(axis->override.velocity / move->velocity, 1.0) : 1.0;
    const double scaled = larger(-left, smaller(move->end_velocity * factor, left));
    const double kept = fabs(scaled) > next_to_nothing * left ? scaled : 0.0;
    limits.velocity = larger(limits.velocity, fabs(kept));
    if (!cm1e_axis_direction_enabled(axis, kept))
        return CM1E_ERROR_AXIS_DIRECTION_DISABLED;
    if (cm1e_profile_to_velocity(profile, &start, kept, &limits) != CM1E_OK)
        return CM1E_ERROR_AXIS_VELOCITY_RANGE;
    return from->velocity == 0.0 && kept != 0.0 ? check_endless(axis, from, profile) : CM1E_OK; /* it begins again */
}

/* ---- by kind ----------------------------------------------------------------------------------------------------- */

typedef cm1e_error_t resolve_t(const cm1e_axis_t *axis, const from_t *from, move_t *move);
typedef cm1e_error_t plan_t(const cm1e_axis_t *axis, const from_t *from, move_t *move, cm1e_profile_t *profile);

static resolve_t *const resolvers[] = {
    [TARGET_NONE] = resolve_none,
    [TARGET_ABSOLUTE] = resolve_absolute,
    [TARGET_RELATIVE] = resolve_relative,
};

static plan_t *const planners[] = {
    [PLAN_TO_TARGET] = plan_to_target,
    [PLAN_THROUGH_TARGET] = plan_through_target,
    [PLAN_VELOCITY] = plan_velocity,
    [PLAN_STOP] = plan_stop,
    [PLAN_KEEP_VELOCITY] = plan_kept,
};

cm1e_error_t cm1e_axis_resolve(const cm1e_axis_t *axis, const from_t *from, move_t *move)
{
    return resolvers[kind_row(move->kind)->target](axis, from, move);
}

/* Plans an override of velocity 0: the axis brakes to standstill and waits there. If it is too late to stop before a
 * position that has to be passed with a velocity, the position is passed, and the next command waits. */
static bool plan_pause(const cm1e_axis_t *axis, const from_t *from, move_t *move, cm1e_profile_t *profile)
{
    const bool has_target = kind_row(move->kind)->plan == PLAN_TO_TARGET;
    const double distance = cm1e_position_minus(move->target, from->position) / axis->position.scale;
    cm1e_motion_limits_t limits;
    cm1e_profile_t stop;
    if (plan_stop(axis, from, move, &stop) != CM1E_OK)
        return false;
    if (has_target && passes(axis, &stop, 0.0, distance) &&
        (cm1e_axis_limits_with(axis, from, move, &no_override, &limits) != CM1E_OK ||
         cm1e_axis_plan_stop(axis, from, &limits, &stop) != CM1E_OK || passes(axis, &stop, 0.0, distance)))
        return false;
    *profile = stop;
    return true;
}

static cm1e_error_t plan_with_exit(const cm1e_axis_t *axis, const from_t *from, move_t *move, bool passing,
                                   cm1e_profile_t *profile)
{
    const command_plan_t plan = kind_row(move->kind)->plan;
    const bool moves = plan != PLAN_STOP;
    move->passing = passing;
    const cm1e_error_t error = planners[plan](axis, from, move, profile);
    move->paused = error == CM1E_OK && moves && axis->override.velocity == 0.0 && plan_pause(axis, from, move, profile);
    return error;
}

static double exit_velocity(cm1e_axis_t *axis, const from_t *from, const move_t *move, bool before_others)
{
    const bool has_exit = before_others || kind_row(move->kind)->is_endless;
    return has_exit ? cm1e_axis_exit_velocity(axis, from, move) : 0.0;
}

bool cm1e_axis_goes_wrong(const cm1e_axis_t *axis, const from_t *from, const move_t *move,
                          const cm1e_profile_t *profile, cm1e_error_t error)
{
    return error == CM1E_ERROR_AXIS_POSITION_RANGE || error == CM1E_ERROR_AXIS_DIRECTION_DISABLED ||
           (error == CM1E_OK && cm1e_axis_profile_strays(axis, from, move, profile));
}

/* Plans a command. An override reduces acceleration and jerk only so far that the axis does not overrun its target and
 * does not go back (3.18, note 9). If the axis is too fast to slow down within the way, it leaves the way no faster
 * than it entered it: this was its plan before the override changed. */
cm1e_error_t cm1e_axis_plan(cm1e_axis_t *axis, const from_t *from, move_t *move, bool before_others,
                            cm1e_profile_t *profile)
{
    const override_t factors = axis->override;
    const bool passing = move->passing;
    move->exit_velocity = exit_velocity(axis, from, move, before_others);
    cm1e_error_t error = plan_with_exit(axis, from, move, passing, profile);
    if (!slowed(axis) || !cm1e_axis_goes_wrong(axis, from, move, profile, error))
        return error;
    axis->override = (override_t){factors.velocity, 1.0, 1.0};
    move->exit_velocity = exit_velocity(axis, from, move, before_others);
    error = plan_with_exit(axis, from, move, passing, profile);
    if (before_others && cm1e_axis_goes_wrong(axis, from, move, profile, error)) {
        axis->override = no_override;
        const double most = fabs(from->velocity);
        move->exit_velocity = larger(-most, smaller(exit_velocity(axis, from, move, true), most));
        axis->override = (override_t){factors.velocity, 1.0, 1.0};
        error = plan_with_exit(axis, from, move, passing, profile);
    }
    axis->override = factors;
    return error;
}

/* The velocity of the begin was planned with larger maxima than the application allows now: the command needs them. */
cm1e_error_t cm1e_axis_plan_as_before(cm1e_axis_t *axis, const from_t *from, move_t *move, cm1e_profile_t *profile)
{
    cm1e_motion_limits_t most = axis->limits.system;
    most.velocity = axis->limits.maximum.velocity;
    move->exit_velocity = cm1e_axis_exit_velocity(axis, from, move); /* by the present ones */
    cm1e_axis_exchange_maximum(axis, &most);
    cm1e_error_t error = plan_with_exit(axis, from, move, move->passing, profile);
    if (cm1e_axis_goes_wrong(axis, from, move, profile, error)) /* it cannot become so slow on its way */
        error = cm1e_axis_plan(axis, from, move, true, profile);
    cm1e_axis_exchange_maximum(axis, &most);
    return error;
}

position_t cm1e_axis_profile_end(const cm1e_axis_t *axis, const from_t *from, const move_t *move,
                                 const cm1e_profile_t *profile)
{
    const command_plan_t plan = kind_row(move->kind)->plan;
    if (!move->paused && (plan == PLAN_TO_TARGET || (plan == PLAN_THROUGH_TARGET && !move->passing)))
        return move->target;
    /* A ramp that takes longer than the axis can count ends nowhere, and is left for another motion. */
    return cm1e_position_towards(from->position, profile->end.position * axis->position.scale);
}

cm1e_error_t cm1e_axis_limits_check(const cm1e_axis_t *axis, const from_t *from, const cm1e_profile_t *profile)
{
    if (!cm1e_axis_limits_keep_within(axis, from, profile))
        return CM1E_ERROR_AXIS_POSITION_RANGE;
    return directions_allow(axis, from, profile) ? CM1E_OK : CM1E_ERROR_AXIS_DIRECTION_DISABLED;
}
