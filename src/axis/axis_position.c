/*
 * Positions: from the drive's 32-bit counts, which wrap, to 64 bits and to units; the turns of a modulo axis; the shift
 * of the coordinates by MC_SetPosition and homing. A turn of a modulo axis is a fraction of counts. Turn k begins at
 * exactly k times that fraction, computed anew each time. So no rounding adds up, however long the axis turns.
 */
#include <float.h>
#include <math.h>

#include "axis/axis_position.h"
#include "axis/axis_backlash.h"
#include "axis/axis_limits.h"
#include "axis/axis_setpoint.h"

__extension__ typedef __int128 wide_t;

/* Positions that whole counts of a drive cannot tell apart are one place, and not a whole turn apart. */
static const double same_counts = 0.5 + 1e-6;

/* The rounding of a fraction of a count after a few sums. */
static const double rounding_counts = 1e-9;

/* floor() of a value that fits, without a call. */
static int64_t floor_of(double value)
{
    const int64_t whole = (int64_t)value;
    return whole - ((double)whole > value);
}

static position_t normal(int64_t counts, double fraction)
{
    const int64_t whole = floor_of(fraction);
    fraction -= (double)whole;
    counts += whole;
    /* -1e-20 + 1 is 1 */
    return fraction < 1.0 ? (position_t){counts, fraction} : (position_t){counts + 1, 0.0};
}

static position_t sum(position_t a, position_t b) { return normal(a.counts + b.counts, a.fraction + b.fraction); }

/* A position relative to the origin, in the direction in which u grows. */
static position_t from_origin(const cm1e_axis_t *axis, position_t position)
{
    const position_t o = axis->position.origin;
    return axis->position.scale > 0.0 ? normal(position.counts - o.counts, position.fraction - o.fraction)
                                      : normal(o.counts - position.counts, o.fraction - position.fraction);
}

double cm1e_axis_farthest(const cm1e_axis_t *axis) { return (double)CM1E_FARTHEST_COUNTS / fabs(axis->position.scale); }

static double to_units(const cm1e_axis_t *axis, double counts)
{
    return counts * axis->position.unit.units / axis->position.unit.counts;
}

/* ---- modulo ------------------------------------------------------------------------------------------------------ */

static double turn_counts(const cm1e_axis_t *axis)
{
    return (double)axis->position.turn.numerator / (double)axis->position.turn.denominator;
}

/* n / d with n >= 0, as a double, without losing the fraction of a large quotient. */
static double quotient(wide_t n, int64_t d) { return (double)(int64_t)(n / d) + (double)(int64_t)(n % d) / (double)d; }

/* The rounding of the arithmetic with a turn of so many counts. */
static double turn_rounding(double turn) { return rounding_counts + 4.0 * DBL_EPSILON * turn; }

/* The turn of a position relative to the origin, and its counts from the begin of that turn; 0 <= phase < a turn. If a
 * turn is no whole number of counts, its begin is rounded, perhaps down. It still belongs to its turn. */
static int64_t turn_of(const cm1e_axis_t *axis, position_t position, double *phase)
{
    const int64_t numerator = axis->position.turn.numerator, denominator = axis->position.turn.denominator;
    int64_t turn, short_product;
    wide_t rest;
    if (!__builtin_mul_overflow(position.counts, denominator, &short_product)) { /* nearly always, and faster */
        turn = short_product / numerator;
        rest = short_product % numerator;
    } else {
        const wide_t product = (wide_t)position.counts * denominator;
        turn = (int64_t)(product / numerator);
        rest = product % numerator;
    }
    if (rest < 0) {
        rest += numerator;
        turn--;
    }
    *phase = quotient(rest, denominator) + position.fraction;
    const double all = turn_counts(axis);
    if (*phase >= all - turn_rounding(all)) { /* rounding: it is the begin of the next turn */
        *phase = fmax(*phase - all, 0.0);
        turn++;
    }
    return turn;
}

/* The position at `phase` counts of a turn. */
static position_t in_turn(const cm1e_axis_t *axis, int64_t turn, double phase)
{
    const wide_t product = (wide_t)turn * axis->position.turn.numerator;
    const int64_t whole = (int64_t)(product / axis->position.turn.denominator);
    const double part = (double)(int64_t)(product % axis->position.turn.denominator) /
                        (double)axis->position.turn.denominator;
    const position_t begin = normal(whole, part);
    const position_t way = cm1e_position_plus(begin, phase);
    return sum(axis->position.origin, axis->position.scale > 0.0 ? way : normal(-way.counts, -way.fraction));
}

static bool in_modulo_range(const cm1e_axis_t *axis, double units)
{
    return units >= 0.0 && units < axis->position.modulo_range;
}

/* ---- units ------------------------------------------------------------------------------------------------------- */

double cm1e_axis_units(const cm1e_axis_t *axis, position_t position)
{
    if (axis->position.modulo_range > 0.0) {
        double phase;
        turn_of(axis, from_origin(axis, position), &phase);
        const double units = to_units(axis, phase);
        return units < axis->position.modulo_range ? units : 0.0; /* the last 1e-16 of a turn */
    }
    return cm1e_axis_line(axis, position);
}

/* The positions as they are shown. At rest, set and actual position may be on both sides of the begin of a turn, less
 * than a count apart. A user who reads a turn beside 0 would see a lag of a turn. So the position before the begin is
 * shown as the begin. */
void cm1e_axis_shown(const cm1e_axis_t *axis, double *set, double *actual)
{
    const position_t at = axis_actual(axis);
    const bool rests = axis->setpoint.velocity == 0.0 && axis->setpoint.acceleration == 0.0;
    *set = cm1e_axis_units(axis, axis->setpoint.position);
    *actual = cm1e_axis_units(axis, at);
    if (!(axis->position.modulo_range > 0.0) || !rests)
        return;
    double phase;
    const int64_t turn = turn_of(axis, from_origin(axis, at), &phase);
    int64_t set_turn = turn_of(axis, from_origin(axis, axis->setpoint.position), &phase);
    if (turn_counts(axis) - phase < axis->limits.tolerance * fabs(axis->position.scale)) {
        *set = 0.0;
        set_turn++;
    }
    if (set_turn != turn && fabs(cm1e_position_minus(axis->setpoint.position, at)) <= same_counts)
        *(set_turn < turn ? set : actual) = 0.0;
}

double cm1e_axis_line(const cm1e_axis_t *axis, position_t position)
{
    const position_t way = from_origin(axis, position);
    const double origin = axis->position.modulo_range > 0.0 ? 0.0 : axis->position.origin_units;
    return origin + to_units(axis, (double)way.counts + way.fraction);
}

bool cm1e_axis_position_from_units(const cm1e_axis_t *axis, double units, position_t *position)
{
    if (axis->position.modulo_range > 0.0) {
        double phase;
        if (!in_modulo_range(axis, units))
            return false;
        *position = in_turn(axis, turn_of(axis, from_origin(axis, axis->setpoint.position), &phase),
                            cm1e_axis_to_counts(axis, units));
        return cm1e_position_in_range(*position);
    }
    return cm1e_axis_position_from_line(axis, units, position);
}

/* The repetition of a position, `way` counts away, to which the axis goes: the first one in the commanded direction
 * beyond the point where it can stop (2.4.2, 3.5). */
static double repetitions(double way, double turn, double stop, bool positive)
{
    return positive ? ceil((stop - same_counts - way) / turn) : floor((stop + same_counts - way) / turn);
}

/* The direction of the shortest way. If both ways are equal, apart from rounding, it is positive. If there is no way,
 * it is the direction of the motion. */
static bool shortest_is_positive(double way, double turn, double velocity)
{
    way -= turn * round(way / turn);
    if (fabs(way) <= same_counts)
        return velocity >= 0.0;
    return way > 0.0 || way <= -turn / 2.0 + turn_rounding(turn);
}

cm1e_error_t cm1e_axis_resolve_target(const cm1e_axis_t *axis, double position, MC_DIRECTION direction,
                                      position_t from, double velocity, double stop, position_t *target)
{
    if (!(axis->position.modulo_range > 0.0))
        return cm1e_axis_position_from_units(axis, position, target) ? CM1E_OK : CM1E_ERROR_AXIS_POSITION_RANGE;
    if (!in_modulo_range(axis, position))
        return CM1E_ERROR_AXIS_POSITION_RANGE;
    const double turn = turn_counts(axis), phase = cm1e_axis_to_counts(axis, position);
    double now;
    const int64_t number = turn_of(axis, from_origin(axis, from), &now);
    const double way = phase - now;
    bool positive;
    switch ((int)direction) {
    case mcPositiveDirection:
        positive = true;
        break;
    case mcNegativeDirection:
        positive = false;
        break;
    case mcCurrentDirection:
        positive = cm1e_axis_goes_positive(axis, velocity);
        break;
    case 0: /* not given */
    case mcShortestWay:
        positive = shortest_is_positive(way, turn, velocity);
        break;
    default:
        return CM1E_ERROR_AXIS_DIRECTION;
    }
    const double more = repetitions(way, turn, stop * fabs(axis->position.scale), positive);
    if (!(fabs(more) * turn < (double)CM1E_FARTHEST_COUNTS))
        return CM1E_ERROR_AXIS_POSITION_RANGE;
    *target = in_turn(axis, number + (int64_t)more, phase);
    return cm1e_position_in_range(*target) ? CM1E_OK : CM1E_ERROR_AXIS_POSITION_RANGE;
}

/* ---- the origin -------------------------------------------------------------------------------------------------- */

bool cm1e_axis_new_position(const cm1e_axis_t *axis, double now, double position, bool relative, double *value)
{
    if (!isfinite(position))
        return false;
    if (axis->position.modulo_range > 0.0) {
        double turned = now + fmod(position, axis->position.modulo_range);
        turned = fmod(turned + axis->position.modulo_range, axis->position.modulo_range);
        *value = relative ? turned : position;
        return in_modulo_range(axis, *value);
    }
    *value = relative ? now + position : position;
    return fabs(cm1e_axis_to_counts(axis, *value)) < (double)CM1E_FARTHEST_COUNTS;
}

bool cm1e_axis_position_init(cm1e_axis_t *axis)
{
    const cm1e_axis_config_t *c = axis->config;
    const double counts = cm1e_unit_scale(c);
    axis->position.unit = cm1e_unit_of(c);
    axis->position.count = cm1e_unit_count(c);
    axis->position.scale = c->invert ? -counts : counts;
    axis->position.modulo_range = c->modulo_range;
    return !(c->modulo_range > 0.0) || cm1e_unit_modulo(c, &axis->position.turn);
}

void cm1e_axis_set_origin(cm1e_axis_t *axis, position_t at, double units)
{
    if (axis->position.modulo_range > 0.0) {
        axis->position.origin = at;
        axis->position.origin = in_turn(axis, 0, -cm1e_axis_to_counts(axis, units));
    } else {
        axis->position.origin = at;
        axis->position.origin_units = units;
    }
    cm1e_axis_renew_base_line(axis);
    cm1e_axis_apply_limits(axis);
}

/* ---- the drive's counts ------------------------------------------------------------------------------------------ */

/* Follows the actual position. Differences of counts that wrap are exact while the motor moves less than half of their
 * range between two calls. */
void cm1e_axis_track(cm1e_axis_t *axis)
{
    const int32_t raw = axis->drive.feedback.position;
    if (axis->position.known) {
        const int32_t moved = (int32_t)((uint32_t)raw - (uint32_t)axis->position.raw);
        axis->position.actual_counts += moved;
        if (axis_has_extra(axis, EXTRA_BACKLASH))
            cm1e_axis_backlash_track(axis, moved);
    } else {
        axis->position.actual_counts = raw;
        axis->position.known = true;
    }
    axis->position.raw = raw;
}

void cm1e_axis_set_to_actual(cm1e_axis_t *axis)
{
    cm1e_axis_jump(axis, axis_actual(axis));
    cm1e_axis_put_velocity(axis, 0.0);
}
