/* The limits of an axis: dynamics, software limits, enabled directions. */
#include <math.h>

#include "axis/axis_limits.h"
#include "axis/axis_backlash.h"
#include "axis/axis_position.h"
#include "axis/axis_setpoint.h"
#include "core/extreme.h"

/* Tolerance of positions: smaller than any useful difference, and larger than the rounding of sums of doubles. */
static const double tolerance_counts = 0.01;
static const double relative_tolerance = 1e-9;

/* Counts/s, counts/s2, counts/s3: nothing useful is so slow, and the way of a stop may be farther than counts go. */
static const double least_counts = 1e-2;

/* Counts of a CM1-E: 100 revolutions/s2, 2000 revolutions/s3, half a revolution. */
static const double default_acceleration_counts = 5e6;
static const double default_jerk_counts = 1e8;
static const double default_lag_counts = 25000.0;

static double or_default(double value, double otherwise) { return value > 0.0 ? value : otherwise; }

static cm1e_error_t check_configuration(const cm1e_axis_t *axis, cm1e_diag_t *diag)
{
    const cm1e_axis_config_t *c = axis->config;
    const double numbers[] = {c->counts_per_unit, c->units_per_revolution, c->modulo_range, c->backlash,
                              c->backlash_velocity, c->max_velocity, c->max_acceleration, c->max_deceleration,
                              c->max_jerk, c->max_position_lag, c->in_position_window, c->in_position_time_s,
                              c->in_position_timeout_s};
    bool good = !isnan(c->software_limit_negative) && !isnan(c->software_limit_positive);
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++)
        good = good && isfinite(numbers[i]) && numbers[i] >= 0.0;
    if (!good)
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "Axis \"%s\": a limit or the scale of the axis is negative "
                             "or not a finite number; expected finite numbers from 0 on.", c->name);
    const bool limited = c->software_limit_negative != 0.0 || c->software_limit_positive != 0.0;
    if (limited && c->modulo_range > 0.0)
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "Axis \"%s\": a modulo axis has no software limits; leave "
                             "out the limits or the modulo range.", c->name);
    if (limited && !(c->software_limit_negative < c->software_limit_positive))
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "Axis \"%s\": the negative software limit %g is not below "
                             "the positive one %g.", c->name, c->software_limit_negative, c->software_limit_positive);
    return CM1E_OK;
}

/* Target positions of a motor behind a bridge have less than 32 bits (BR appendix 5). Its counts differ from ours by
 * multiples of 2^32, and by the backlash. */
static void find_counts_limits(cm1e_axis_t *axis)
{
    const double reach = (double)axis->limits.counts_limit - axis->backlash.gap;
    const position_t zero = {axis->position.actual_counts - axis->position.raw, 0.0};
    const double a = cm1e_axis_line(axis, cm1e_position_plus(zero, -reach));
    const double b = cm1e_axis_line(axis, cm1e_position_plus(zero, reach));
    axis->limits.counts_lower = axis->limits.counts_limit ? smaller(a, b) : -INFINITY;
    axis->limits.counts_upper = axis->limits.counts_limit ? larger(a, b) : INFINITY;
}

void cm1e_axis_apply_limits(cm1e_axis_t *axis)
{
    find_counts_limits(axis);
    axis->limits.upper = smaller(axis->limits.positive_enabled ? axis->limits.positive : INFINITY,
                              axis->limits.counts_upper);
    axis->limits.lower = larger(axis->limits.negative_enabled ? axis->limits.negative : -INFINITY,
                              axis->limits.counts_lower);
    axis->limits.software_limits = axis->limits.positive_enabled || axis->limits.negative_enabled ||
                                   axis->limits.counts_limit;
    cm1e_axis_look_anew(axis);
}

static void take_software_limits(cm1e_axis_t *axis)
{
    const double negative = axis->config->software_limit_negative, positive = axis->config->software_limit_positive;
    const bool limited = negative != 0.0 || positive != 0.0;
    axis->limits.positive_enabled = limited && isfinite(positive);
    axis->limits.negative_enabled = limited && isfinite(negative);
    axis->limits.positive = axis->limits.positive_enabled ? positive : 0.0;
    axis->limits.negative = axis->limits.negative_enabled ? negative : 0.0;
    cm1e_axis_apply_limits(axis);
}

cm1e_error_t cm1e_axis_limits_init(cm1e_axis_t *axis, cm1e_diag_t *diag)
{
    const cm1e_axis_config_t *c = axis->config;
    const cm1e_error_t error = check_configuration(axis, diag);
    if (error != CM1E_OK)
        return error;
    axis->limits.counts_limit = axis->drive.kind->position_limited ? axis->drive.range.position_most : 0;
    const double counts = cm1e_unit_scale(c), count = cm1e_unit_count(c);
    const double backlash_velocity = c->backlash == 0.0 ? 0.0
                                     : or_default(c->backlash_velocity, cm1e_unit_backlash_velocity(c) / counts);
    const double peak = cm1e_unit_peak_velocity(axis->config) / counts - backlash_velocity;
    if (!cm1e_axis_position_init(axis) || !(peak > 0.0))
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "Axis \"%s\": the backlash velocity, the unit or the turn of "
                             "%.17g u is too large or too small to compute with.", c->name, c->modulo_range);
    axis->limits.maximum.velocity = smaller(or_default(c->max_velocity, peak), peak);
    axis->limits.maximum.acceleration = or_default(c->max_acceleration, default_acceleration_counts * count / counts);
    axis->limits.maximum.deceleration = or_default(c->max_deceleration, axis->limits.maximum.acceleration);
    axis->limits.maximum.jerk = or_default(c->max_jerk, default_jerk_counts * count / counts);
    axis->limits.system = axis->limits.maximum;
    axis->limits.emergency = axis->limits.system;
    axis->limits.emergency.jerk = INFINITY;
    axis->limits.emergency_way = 0.5 / axis->limits.emergency.deceleration;
    axis->limits.tolerance = tolerance_counts / fabs(axis->position.scale);
    axis->limits.max_lag = or_default(c->max_position_lag, default_lag_counts * count / counts);
    axis->limits.lag_monitoring = true;
    cm1e_axis_backlash_init(axis);
    take_software_limits(axis);
    return CM1E_OK;
}

static int32_t whole_counts(double counts) { return (int32_t)smaller(ceil(counts), INT32_MAX); }

void cm1e_axis_steps_init(cm1e_axis_t *axis)
{
    const double scale = fabs(axis->position.scale);
    const double acceleration = larger(axis->limits.system.acceleration, axis->limits.system.deceleration);
    cm1e_drive_command_t *command = &axis->drive.command;
    command->position_step = whole_counts((axis->limits.system.velocity * scale + axis->backlash.velocity) *
                                          axis->cycle_s);
    command->velocity_step = whole_counts((acceleration * scale + axis->backlash.acceleration) * axis->cycle_s);
}

/* Chooses a dynamic value. 0 selects the maximum. A larger value is limited, or else refused. */
static bool choose(double asked, double maximum, bool limited, double *value)
{
    *value = asked == 0.0 ? maximum : asked;
    if (!isfinite(asked) || asked < 0.0)
        return false;
    if (*value <= maximum * (1.0 + relative_tolerance))
        return true;
    *value = maximum;
    return limited;
}

/* Keeps an acceleration under way from overshooting the maximum velocity. With a smaller jerk than before, the
 * acceleration may take too long to end. Then the jerk is raised, at most to that of the motion so far. */
static void keep_below_maximum_velocity(const from_t *from, double most, double system, double most_jerk,
                                        cm1e_motion_limits_t *limits)
{
    const double a = from->acceleration;
    if (a == 0.0)
        return;
    const double needed = a * a / (2.0 * most_jerk), velocity = a > 0.0 ? from->velocity : -from->velocity;
    double room = most - velocity;
    if (needed > room + relative_tolerance * system) /* the application has just lowered its maximum */
        room = system - velocity;
    limits->jerk = larger(limits->jerk, smaller(a * a / (2.0 * larger(room, 0.0)), most_jerk));
    /* The acceleration of a ramp without a limit of jerk needs more. */
    if (needed > room + relative_tolerance * system)
        limits->jerk = a * a / (2.0 * larger(room, relative_tolerance * system));
}

void cm1e_axis_keep_below_maximum(const cm1e_axis_t *axis, const from_t *from, cm1e_motion_limits_t *limits)
{
    keep_below_maximum_velocity(from, axis->limits.maximum.velocity, axis->limits.system.velocity,
                                axis->limits.maximum.jerk, limits);
}

/* ---- too small --------------------------------------------------------------------------------------------------- */

bool cm1e_axis_find_small(const move_t *move, const cm1e_motion_limits_t *maximum, const override_t *factors,
                          double scale, small_input_t *found)
{
    const command_kind_t *kind = kind_row(move->kind);
    const double velocity_factor = factors->velocity > 0.0 ? factors->velocity : 1.0; /* 0: a pause */
    const struct {
        const char *name, *unit;
        bool used;
        double value, maximum, factor;
        cm1e_error_t error;
    } inputs[] = {
        {"Velocity", "u/s", kind->has_velocity, move->velocity, 0.0, velocity_factor, CM1E_ERROR_AXIS_VELOCITY_RANGE},
        {"Acceleration", "u/s2", !kind->is_stop, move->acceleration, maximum->acceleration, factors->acceleration,
         CM1E_ERROR_AXIS_DYNAMICS_RANGE},
        {"Deceleration", "u/s2", true, move->deceleration, maximum->deceleration, factors->acceleration,
         CM1E_ERROR_AXIS_DYNAMICS_RANGE},
        {"Jerk", "u/s3", true, move->jerk, maximum->jerk, factors->jerk, CM1E_ERROR_AXIS_DYNAMICS_RANGE},
    };
    for (size_t i = 0; i < sizeof inputs / sizeof inputs[0]; i++) {
        const bool given = inputs[i].value != 0.0;
        const double value = given ? inputs[i].value : inputs[i].maximum, least = least_counts / fabs(scale);
        const double factor = kind->has_override ? inputs[i].factor : 1.0;
        if (!inputs[i].used || value == 0.0 || !(fabs(value) * factor < least))
            continue;
        *found = (small_input_t){inputs[i].name, inputs[i].unit, value, least, factor, !given, inputs[i].error};
        return true;
    }
    return false;
}

bool cm1e_axis_has_small(const cm1e_axis_t *axis, const move_t *move, small_input_t *found)
{
    return cm1e_axis_find_small(move, &axis->limits.maximum, &axis->override, axis->position.scale, found);
}

cm1e_error_t cm1e_axis_cannot_plan(const cm1e_axis_t *axis, const move_t *move, cm1e_error_t otherwise)
{
    small_input_t found;
    return cm1e_axis_has_small(axis, move, &found) ? found.error : otherwise;
}

/* ---- of a command ------------------------------------------------------------------------------------------------ */

/* The dynamics that a command asks for, checked against the maximum values of the axis. */
static cm1e_error_t asked_limits(const cm1e_axis_t *axis, const move_t *move, cm1e_motion_limits_t *limits)
{
    const cm1e_motion_limits_t *most = &axis->limits.maximum;
    const command_kind_t *kind = kind_row(move->kind);
    const bool limited = kind->is_stop || move->accepted;
    const double acceleration = kind->is_stop ? 0.0 : move->acceleration;
    if (!choose(acceleration, most->acceleration, limited, &limits->acceleration) ||
        !choose(move->deceleration, most->deceleration, limited, &limits->deceleration) ||
        !choose(move->jerk, most->jerk, limited, &limits->jerk))
        return CM1E_ERROR_AXIS_DYNAMICS_RANGE;
    limits->velocity = most->velocity;
    if (!kind->has_velocity)
        return CM1E_OK;
    /* Only the velocity of MC_MoveVelocity may be negative; its sign is a direction (3.10). */
    const double speed = kind->plan == PLAN_VELOCITY ? fabs(move->velocity) : move->velocity;
    const double largest = move->accepted ? INFINITY : most->velocity * (1.0 + relative_tolerance);
    if (!(speed > 0.0) || !(speed <= largest) || !(fabs(move->end_velocity) <= largest))
        return CM1E_ERROR_AXIS_VELOCITY_RANGE;
    limits->velocity = smaller(speed, most->velocity);
    return CM1E_OK;
}

double cm1e_axis_velocity_beside(const cm1e_axis_t *axis)
{
    const double most = axis->limits.maximum.velocity, share = axis->superimposed.share.velocity, left = most - share;
    if (left >= -relative_tolerance * most)
        return larger(left, 0.0);
    return larger(smaller(most / 2.0, axis->limits.system.velocity - share), 0.0);
}

/* Takes the share of a superimposed motion off the limits, so that the sum of both stays within the maximum values in
 * every direction. An acceleration above the rest falls as fast as that of the other motion can rise. Where the maxima
 * were lowered since, and the superimposed motion goes on as it was commanded, there is half of them for the other
 * one. */
static void share_with_superimposed(const cm1e_axis_t *axis, const from_t *from, cm1e_motion_limits_t *limits)
{
    const cm1e_motion_limits_t *most = &axis->limits.maximum, *share = &axis->superimposed.share;
    const double least = smaller(most->acceleration, most->deceleration);
    const double rest = larger(least - share->acceleration, least / 2.0);
    limits->velocity = smaller(limits->velocity, cm1e_axis_velocity_beside(axis));
    limits->acceleration = smaller(limits->acceleration, rest);
    limits->deceleration = smaller(limits->deceleration, rest);
    limits->jerk = smaller(limits->jerk, larger(most->jerk - share->jerk, most->jerk / 2.0));
    if (fabs(from->acceleration) > rest)
        limits->jerk = larger(limits->jerk, share->jerk);
}

cm1e_error_t cm1e_axis_limits_with(const cm1e_axis_t *axis, const from_t *from, const move_t *move,
                                   const override_t *override, cm1e_motion_limits_t *limits)
{
    const cm1e_error_t error = asked_limits(axis, move, limits);
    if (error == CM1E_OK && kind_row(move->kind)->has_override) {
        limits->velocity *= override->velocity > 0.0 ? override->velocity : 1.0; /* 0: see axis_override.c */
        limits->acceleration *= override->acceleration;
        limits->deceleration *= override->acceleration;
        limits->jerk *= override->jerk;
    }
    if (error != CM1E_OK)
        return error;
    if (from->shared)
        share_with_superimposed(axis, from, limits);
    const cm1e_motion_limits_t nothing = {0}, *share = from->shared ? &axis->superimposed.share : &nothing;
    keep_below_maximum_velocity(from, axis->limits.maximum.velocity - share->velocity,
                                axis->limits.system.velocity - share->velocity,
                                axis->limits.maximum.jerk - share->jerk, limits);
    return CM1E_OK;
}

cm1e_error_t cm1e_axis_limits_of(const cm1e_axis_t *axis, const from_t *from, const move_t *move,
                                 cm1e_motion_limits_t *limits)
{
    return cm1e_axis_limits_with(axis, from, move, &axis->override, limits);
}

cm1e_error_t cm1e_axis_limits_on_top(const cm1e_axis_t *axis, const superimposed_t *on_top,
                                     const override_t *override, cm1e_motion_limits_t *limits)
{
    const from_t rest = {.position = axis->setpoint.position};
    const from_t from = {axis->setpoint.position, on_top->now.velocity, on_top->now.acceleration, false};
    const cm1e_motion_limits_t *share = &on_top->share;
    const cm1e_motion_limits_t *most = &axis->limits.maximum;
    move_t move = on_top->move; /* it was accepted: a maximum that was lowered since limits it */
    move.velocity = smaller(move.velocity, most->velocity);
    move.acceleration = smaller(move.acceleration, most->acceleration);
    move.deceleration = smaller(move.deceleration, most->deceleration);
    move.jerk = smaller(move.jerk, most->jerk);
    const cm1e_error_t error = cm1e_axis_limits_with(axis, &rest, &move, override, limits);
    limits->velocity = smaller(limits->velocity, share->velocity);
    limits->acceleration = smaller(limits->acceleration, share->acceleration);
    limits->deceleration = smaller(limits->deceleration, share->deceleration);
    limits->jerk = smaller(limits->jerk, share->jerk);
    keep_below_maximum_velocity(&from, share->velocity, share->velocity, share->jerk, limits);
    return error;
}

void cm1e_axis_exchange_maximum(cm1e_axis_t *axis, cm1e_motion_limits_t *most)
{
    const cm1e_motion_limits_t before = axis->limits.maximum;
    axis->limits.maximum = *most;
    *most = before;
}

bool cm1e_axis_direction_enabled(const cm1e_axis_t *axis, double velocity)
{
    return velocity > 0.0 ? axis->power.enable_positive : velocity < 0.0 ? axis->power.enable_negative : true;
}

/* An axis outside the limits, where it was pushed without torque, may come back, but not go farther. */
bool cm1e_axis_limits_contain_way(const cm1e_axis_t *axis, const from_t *from, double lowest, double highest)
{
    if (!axis->limits.software_limits)
        return true;
    const double tolerance = axis->limits.tolerance, now = cm1e_axis_line(axis, from->position);
    if (from->shared) {
        lowest += axis->superimposed.lowest;
        highest += axis->superimposed.highest;
    }
    return now + highest <= larger(axis->limits.upper, now) + tolerance &&
           now + lowest >= smaller(axis->limits.lower, now) - tolerance;
}

bool cm1e_axis_limits_contain_target(const cm1e_axis_t *axis, const from_t *from, position_t target)
{
    const double way = cm1e_position_minus(target, from->position) / axis->position.scale;
    return cm1e_axis_limits_contain_way(axis, from, smaller(way, 0.0), larger(way, 0.0));
}

bool cm1e_axis_limits_keep_within(const cm1e_axis_t *axis, const from_t *from, const cm1e_profile_t *profile)
{
    if (!axis->limits.software_limits)
        return true;
    double lowest, highest;
    cm1e_profile_extent(profile, &lowest, &highest);
    return cm1e_axis_limits_contain_way(axis, from, lowest, highest);
}

/* During a homing in steps positions are not valid until the move that ends it. */
bool cm1e_axis_limits_contain(const cm1e_axis_t *axis, const from_t *from, const cm1e_profile_t *profile)
{
    const bool meaningless = axis->state == CM1E_AXIS_HOMING && !axis->homing_step.finishing;
    return meaningless || cm1e_axis_limits_keep_within(axis, from, profile);
}

/* The whole motion is judged, from its begin. So a limit that the axis has already passed may be refused too. */
bool cm1e_axis_way_keeps(const cm1e_axis_t *axis, double lowest, double highest, double lower, double upper)
{
    const double base = axis->setpoint.base_line, now = cm1e_axis_line(axis, axis->setpoint.position);
    const double v = axis->setpoint.velocity;
    const double end = axis->setpoint.profile.end.velocity, brake = axis->limits.emergency_way;
    const superimposed_t *on_top = &axis->superimposed;
    const double below = on_top->id ? smaller(on_top->lowest, 0.0) : 0.0;
    const double above = on_top->id ? larger(on_top->highest, 0.0) : 0.0;
    const double stops[] = {base + lowest + below, base + highest + above, now + v * fabs(v) * brake,
                            base + axis->setpoint.profile.end.position + end * fabs(end) * brake};
    for (int i = 0; i < 4; i++)
        if (stops[i] > upper + axis->limits.tolerance || stops[i] < lower - axis->limits.tolerance)
            return false;
    return true;
}

bool cm1e_axis_unknown_way_keeps(const cm1e_axis_t *axis, double lower, double upper)
{
    (void)axis;
    return isinf(lower) && isinf(upper);
}

bool cm1e_axis_profile_keeps(const cm1e_axis_t *axis, double lower, double upper)
{
    double lowest, highest;
    cm1e_profile_extent(&axis->setpoint.profile, &lowest, &highest);
    return cm1e_axis_way_keeps(axis, lowest, highest, lower, upper);
}
