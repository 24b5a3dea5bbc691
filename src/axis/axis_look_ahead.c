/*
 * Look-ahead: the velocity with which a command passes its end into the waiting one.
 *
 * The velocity at a junction is that of the buffer mode. It is limited to what the following commands can brake from
 * (computed from the last one backwards), and to what the present command can reach without going back. It is zero
 * where the direction changes, where the mode is mcBuffered, and before a command that begins at rest.
 */
#include <float.h>
#include <math.h>

#include "axis/axis_commands.h"
#include "axis/axis_limits.h"
#include "axis/axis_plan.h"
#include "axis/axis_position.h"
#include "axis/axis_superimpose.h"
#include "core/extreme.h"

/* A waiting command that begins without a stop before it. */
typedef struct leg {
    cm1e_motion_limits_t limits;
    double distance;       /* u; if it has no end, only the sign counts */
    double exit_velocity;  /* u/s, in its own direction */
    double room;           /* u; from its begin to the software limit; infinite: none */
    const cm1e_motion_limits_t *most; /* maximum values of the axis */
    bool open;             /* it has no end position */
    MC_BUFFER_MODE mode;
} leg_t;

static double junction_velocity(MC_BUFFER_MODE mode, double first, double second)
{
    switch (mode) {
    case mcBlendingLow: return smaller(first, second);
    case mcBlendingPrevious: return first;
    case mcBlendingNext: return second;
    case mcBlendingHigh: return larger(first, second);
    default: return 0.0;
    }
}

/* The distance of a command, shortened by what a superimposed motion covers before the command begins. */
static double nearer(const cm1e_axis_t *axis, const move_t *move, double distance)
{
    if (!axis->superimposed.id || kind_row(move->kind)->target != TARGET_ABSOLUTE)
        return distance;
    const double left = distance > 0.0 ? distance - larger(axis->superimposed.highest, 0.0)
                                       : distance - smaller(axis->superimposed.lowest, 0.0);
    return left * distance > 0.0 ? left : 0.0;
}

/* Makes a leg of a waiting command. `end` is where the command before it ends, `sign` is its direction; both become
 * those of this command. false: the command before it has to stop. */
static bool make_leg(cm1e_axis_t *axis, waiting_t *waiting, position_t *end, double sign, leg_t *leg)
{
    move_t own = move_of_waiting(waiting), *move = &own;
    const from_t from = {*end, sign * DBL_MIN, 0.0, axis_shares(axis)}; /* only the direction is known so far */
    move->origin = *end;
    if (move->buffer_mode <= mcBuffered || !is_planned(move->kind) ||
        cm1e_axis_limits_of(axis, &from, move, &leg->limits) != CM1E_OK ||
        cm1e_axis_resolve(axis, &from, move) != CM1E_OK)
        return false;
    waiting->target = move->target;
    leg->mode = (MC_BUFFER_MODE)move->buffer_mode;
    leg->open = false;
    leg->exit_velocity = 0.0;
    leg->distance = nearer(axis, move, cm1e_position_minus(move->target, *end) / axis->position.scale);
    if (move->kind == CM1E_COMMAND_MOVE_VELOCITY) {
        leg->open = true;
        (void)cm1e_axis_signed_velocity(axis, &from, move, &leg->distance);
    } else if (move->kind == CM1E_COMMAND_HALT) {
        leg->open = true;
        leg->distance = sign;
        leg->limits.velocity = 0.0;
    } else if (kind_row(move->kind)->plan == PLAN_THROUGH_TARGET) {
        const double exit_velocity = cm1e_axis_exit_velocity(axis, &from, move);
        leg->exit_velocity = larger(0.0, leg->distance > 0.0 ? exit_velocity : -exit_velocity);
    }
    const double begin = cm1e_axis_line(axis, *end);
    leg->room = !axis->limits.software_limits ? INFINITY
                : leg->distance > 0.0 ? axis->limits.upper - begin : begin - axis->limits.lower;
    leg->most = &axis->limits.maximum;
    *end = move->target;
    return leg->distance != 0.0;
}

/* The maximum velocity with which a leg may be entered from a command of this velocity and direction. With a limit of
 * jerk, the way down to a stop can be shorter than the way down to a low velocity. An entry that plans a stop loses the
 * velocity at the next junction, so only an axis that is already too fast does that. Else a further command in the
 * buffer, which lets this leg be left faster, could demand a slower entry than was planned. */
static double entry_velocity(const leg_t *leg, double velocity_before, double sign, bool as_if_to_stop)
{
    double velocity = junction_velocity(leg->mode, velocity_before, leg->limits.velocity);
    if (isfinite(leg->room)) /* if it cannot begin there, the axis has to stop inside its limits */
        velocity = cm1e_profile_entry_velocity(larger(leg->room, 0.0), velocity, 0.0, leg->most);
    if (leg->distance * sign <= 0.0)
        return 0.0;
    if (leg->open)
        return velocity;
    const double distance = fabs(leg->distance);
    const double entry = cm1e_profile_entry_velocity(distance, velocity, leg->exit_velocity, &leg->limits);
    return as_if_to_stop ? larger(entry, cm1e_profile_entry_velocity(distance, velocity, 0.0, &leg->limits)) : entry;
}

/* The velocity with which a command of this velocity may enter the first leg, computed from the last leg backwards. */
static double look_ahead(leg_t *legs, int count, double velocity, bool as_if_to_stop)
{
    for (int i = count - 1; i > 0; i--)
        legs[i - 1].exit_velocity = entry_velocity(&legs[i], legs[i - 1].limits.velocity,
                                                   copysign(1.0, legs[i - 1].distance), as_if_to_stop);
    /* The direction of the first leg; the profile decides from which side the command reaches its target. */
    const double sign = copysign(1.0, legs[0].distance);
    return sign * entry_velocity(&legs[0], velocity, sign, as_if_to_stop);
}

double cm1e_axis_exit_velocity(cm1e_axis_t *axis, const from_t *from, const move_t *move)
{
    const double factor = axis->override.velocity > 0.0 ? axis->override.velocity : 1.0;
    if (kind_row(move->kind)->plan == PLAN_THROUGH_TARGET)
        return factor * move->end_velocity;
    cm1e_motion_limits_t limits;
    if (axis->commands.waiting.count == 0 || kind_row(move->kind)->plan != PLAN_TO_TARGET ||
        cm1e_axis_limits_of(axis, from, move, &limits) != CM1E_OK)
        return 0.0;
    leg_t legs[CM1E_AXIS_BUFFER_DEPTH];
    const double distance = cm1e_position_minus(move->target, from->position) / axis->position.scale;
    position_t end = move->target;
    double sign = copysign(1.0, distance);
    int count = 0;
    while (count < axis->commands.waiting.count &&
           make_leg(axis, waiting_move(axis, count), &end, sign, &legs[count])) {
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
    if (!cm1e_axis_direction_enabled(axis, wanted)) /* in that direction it may only brake */
        return 0.0;
    const double velocity = cm1e_profile_passing_velocity(&start, distance, wanted, &limits);
    if (velocity == wanted)
        return velocity;
    return cm1e_profile_passing_velocity(&start, distance, look_ahead(legs, count, limits.velocity, true), &limits);
}
