/*
 * The primitive of every profile: the fastest change from (v, a) to (w, 0).
 *
 * All functions except the last use it mirrored by `sign` so that the velocity has to grow ("up"). The ceiling of the
 * acceleration is then the deceleration limit below standstill, where |v| shrinks, and the acceleration limit above it.
 * Where the ceiling falls at standstill, the acceleration has to come down before: it must obey the lower limit when v
 * gets there.
 */
#include <math.h>

#include "core/extreme.h"
#include "motion/pieces.h"

void cm1e_pieces_append(cm1e_pieces_t *pieces, double jerk, double acceleration, double duration_s)
{
    if (!(duration_s > 0))
        return;
    if (pieces->count > 0 && jerk != 0 && pieces->piece[pieces->count - 1].jerk == jerk)
        pieces->piece[pieces->count - 1].duration_s += duration_s;
    else if (pieces->count < CM1E_PIECES_MAX)
        pieces->piece[pieces->count++] = (cm1e_piece_t){jerk, acceleration, duration_s};
}

double cm1e_pieces_displacement(const cm1e_pieces_t *pieces, double velocity)
{
    cm1e_motion_state_t state = {0, velocity, 0};
    for (int i = 0; i < pieces->count; i++)
        state = cm1e_piece_state(&pieces->piece[i], state.position, state.velocity, pieces->piece[i].duration_s);
    return state.position;
}

/** A piece that was planned mirrored by `sign`. */
static void append(cm1e_pieces_t *pieces, double sign, double jerk, double acceleration, double duration_s)
{
    cm1e_pieces_append(pieces, sign * jerk, sign * acceleration, duration_s);
}

/** From acceleration a >= 0 to `a_end` >= 0 while the velocity grows by dv, at most `ceiling`. The caller knows that it
 *  can be done, i.e. that going from a straight to a_end needs no more than dv. */
static void append_rise(cm1e_pieces_t *pieces, double sign, double dv, double a, double a_end, double ceiling,
                        double jerk)
{
    if (a > ceiling) {
        append(pieces, sign, -jerk, a, (a - ceiling) / jerk);
        dv -= (a + ceiling) * ((a - ceiling) / jerk) / 2;
        a = ceiling;
    }
    const double at_ceiling = dv - (ceiling * ceiling - (a * a + a_end * a_end) / 2) / jerk;
    double peak = ceiling;
    if (!(at_ceiling > 0)) {
        peak = sqrt(larger(0, jerk * dv) + (a * a + a_end * a_end) / 2);
        peak = smaller(larger(peak, larger(a, a_end)), ceiling);
    }
    append(pieces, sign, jerk, a, (peak - a) / jerk);
    append(pieces, sign, 0, peak, at_ceiling / peak);
    append(pieces, sign, -jerk, peak, (peak - a_end) / jerk);
}

/** From (v < 0, a >= 0) to standstill, and there to an acceleration `*at_zero` of at most `allowed`. false: appends
 *  nothing, as the axis is too fast for that, or outside the limit. */
static bool append_rise_to_zero(cm1e_pieces_t *pieces, double sign, double v, double a, double allowed,
                                const cm1e_motion_limits_t *limits, double *at_zero)
{
    const double below = limits->deceleration, jerk = limits->jerk;
    /* Squares of the acceleration at v = 0 when jerk is applied from now on, upwards and downwards. */
    const double pushed = a * a - 2 * jerk * v, eased = a * a + 2 * jerk * v;
    if (a <= below && pushed <= allowed * allowed) { /* no limit in the way below zero */
        *at_zero = sqrt(pushed);
        append(pieces, sign, jerk, a, (*at_zero - a) / jerk);
        return true;
    }
    if (eased <= allowed * allowed) {
        *at_zero = allowed;
        append_rise(pieces, sign, -v, a, allowed, below, jerk);
        return true;
    }
    return false;
}

/** The change from (v < 0, a >= 0) to (w > 0, 0). */
static void append_rise_through_zero(cm1e_pieces_t *pieces, double sign, double v, double a, double w,
                                     const cm1e_motion_limits_t *limits)
{
    const double above = limits->acceleration, below = limits->deceleration, jerk = limits->jerk;
    /* Maximum acceleration at v = 0: within both limits, and low enough to arrive at w. */
    const double lower = smaller(above, below);
    const double allowed = 2 * jerk * w < lower * lower ? sqrt(2 * jerk * w) : lower;
    const double eased = a * a + 2 * jerk * v;
    double at_zero;
    if (a > below && eased >= below * below) { /* from outside the limits, and still so at v = 0 */
        at_zero = sqrt(eased);
        append(pieces, sign, -jerk, a, (a - at_zero) / jerk);
        append_rise(pieces, sign, w, at_zero, 0, above, jerk);
    } else if (append_rise_to_zero(pieces, sign, v, a, allowed, limits, &at_zero)) {
        append_rise(pieces, sign, w, at_zero, 0, above, jerk);
    } else { /* too fast to obey the lower limit at v = 0: down to it at once */
        append_rise(pieces, sign, w - v, a, 0, above, jerk);
    }
}

bool cm1e_pieces_append_rise_to_standstill(cm1e_pieces_t *pieces, double velocity, double acceleration,
                                           const cm1e_motion_limits_t *limits, double *at_zero)
{
    double v = velocity, a = acceleration;
    if (a > limits->deceleration)
        return false;
    if (a < 0) {
        append(pieces, 1, limits->jerk, a, -a / limits->jerk);
        v -= a * (a / limits->jerk) / 2;
        a = 0;
    }
    return append_rise_to_zero(pieces, 1, v, a, smaller(limits->acceleration, limits->deceleration), limits, at_zero);
}

static void append_up(cm1e_pieces_t *pieces, double sign, double v, double a, double w,
                      const cm1e_motion_limits_t *limits)
{
    const double above = limits->acceleration, below = limits->deceleration, jerk = limits->jerk;
    if (a < 0) {
        append(pieces, sign, jerk, a, -a / jerk);
        v -= a * (a / jerk) / 2;
        a = 0;
    }
    if (v < 0 && w > 0 && above != below)
        append_rise_through_zero(pieces, sign, v, a, w, limits);
    else
        append_rise(pieces, sign, w - v, a, 0, v < 0 ? below : above, jerk);
}

static void append_up_trapezoid(cm1e_pieces_t *pieces, double sign, double v, double w,
                                const cm1e_motion_limits_t *limits)
{
    if (v < 0)
        append(pieces, sign, 0, limits->deceleration, (smaller(w, 0) - v) / limits->deceleration);
    if (w > 0)
        append(pieces, sign, 0, limits->acceleration, (w - larger(v, 0)) / limits->acceleration);
}

void cm1e_pieces_append_velocity_change(cm1e_pieces_t *pieces, double velocity, double acceleration, double target,
                                        const cm1e_motion_limits_t *limits)
{
    const double v = velocity, a = acceleration, w = target, jerk = limits->jerk;
    if (isinf(jerk)) {
        const double sign = w >= v ? 1 : -1;
        append_up_trapezoid(pieces, sign, sign * v, sign * w, limits);
    } else {
        /* The velocity after the acceleration is brought to zero. Rounding must not cause a motion: even the last bits
         * of a velocity take time (the root of their size), and would move a fast axis noticeably. */
        const double ease = fabs(a) * (a / jerk) / 2, missing = w - v - ease;
        if (fabs(missing) <= 1e-13 * (fabs(v) + fabs(w) + fabs(ease))) {
            cm1e_pieces_append(pieces, a > 0 ? -jerk : jerk, a, fabs(a) / jerk);
            return;
        }
        const double sign = missing > 0 ? 1 : -1;
        append_up(pieces, sign, sign * v, sign * a, sign * w, limits);
    }
}
