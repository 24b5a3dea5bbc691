/*
 * The common move: forward to standstill, with one rise of the velocity to a peak and one fall. An axis that moves away
 * from the target first comes to standstill; what its acceleration is there does not depend on the peak. Its ways are
 * mean velocities by times, so no piece has to be integrated. Where the peak is the velocity limit, all is in closed
 * form. Else the peak is the root of the whole way, a convex function of the time in which the acceleration would be
 * ramped up to it: Newton's method finds it from any start.
 */
#include <math.h>

#include "core/extreme.h"
#include "motion/pieces.h"

enum { NEWTON_STEPS = 20 };

/** A change of velocity between accelerations 0: the acceleration is ramped up, stays and is ramped down. */
typedef struct change {
    double peak, ramp_s, flat_s;
} change_t;

/** The rise continues one that began at acceleration 0 and velocity `rest`; after a deceleration it begins there. */
typedef struct forward {
    double rest, begun_s; /**< so long ago */
    double way;           /**< from there to the target */
    double up, down, jerk, per_up, per_down, per_jerk;
} forward_t;

static inline change_t change_of(double velocity, double most, double per_most, double jerk, double per_jerk)
{
    const double ramp_s = most * per_jerk, flat_s = velocity * per_most - ramp_s;
    if (flat_s > 0)
        return (change_t){most, ramp_s, flat_s};
    const double short_s = sqrt(velocity * per_jerk);
    return (change_t){short_s * jerk, short_s, 0};
}

static inline double time_of(const change_t *change) { return 2 * change->ramp_s + change->flat_s; }

/** The time of the ramp up to the peak, as if acceleration had no limit; negative: the case is of another kind. */
static double ramp_to_peak(const forward_t *f, double most, double excess)
{
    /* The nearest end: after a peak of that size, as below standstill the rise goes as far back as above it forward. */
    const double low = fabs(f->rest);
    const change_t soonest = change_of(low, f->down, f->per_down, f->jerk, f->per_jerk);
    const double missing = f->way - low / 2 * time_of(&soonest);
    const double largest = sqrt((most - f->rest) * f->per_jerk);
    if (!(missing > 0))
        return -1;
    /* The way mostly grows like the third power. */
    double ramp_s = larger(f->begun_s, largest * cbrt(missing / (missing + excess)));
    for (int i = 0; i < NEWTON_STEPS; i++) {
        const double gained = f->jerk * ramp_s * ramp_s, peak = f->rest + gained;
        const bool flat_up = f->jerk * ramp_s > f->up, flat_down = peak * f->jerk > f->down * f->down;
        const double fall_s = flat_down ? 0 : sqrt(peak * f->per_jerk);
        const double rise = flat_up ? (peak + f->rest) / 2 * (gained * f->per_up + f->up * f->per_jerk)
                                    : (peak + f->rest) * ramp_s;
        const double fall = flat_down ? peak / 2 * (peak * f->per_down + f->down * f->per_jerk) : peak * fall_s;
        const double rise_slope = flat_up ? 2 * f->jerk * ramp_s * (peak * f->per_up + f->up * f->per_jerk / 2)
                                          : 2 * f->rest + 3 * gained;
        const double fall_slope = 2 * f->jerk * ramp_s * (flat_down ? peak * f->per_down + f->down * f->per_jerk / 2
                                                                    : 1.5 * fall_s);
        const double beyond = rise + fall - f->way;
        ramp_s -= beyond / (rise_slope + fall_slope);
        if (fabs(beyond) <= 1e-9 * missing) /* quadratic: that was it */
            return ramp_s;
    }
    return -1;
}

bool cm1e_pieces_append_forward_move(cm1e_pieces_t *pieces, double velocity, double acceleration, double target,
                                     const cm1e_motion_limits_t *limits)
{
    const double jerk = limits->jerk, most = limits->velocity;
    double v = velocity, a = acceleration;
    if (isinf(jerk))
        return false;
    if (v < 0) {
        if (!cm1e_pieces_append_rise_to_standstill(pieces, velocity, acceleration, limits, &a))
            return false;
        target -= cm1e_pieces_displacement(pieces, velocity);
        v = 0;
    }
    if (a > limits->acceleration)
        return false;
    const double per_jerk = 1 / jerk, begun_s = a * per_jerk, rest = v - a * begun_s / 2;
    if ((a < 0 && rest < 0) || v + a * begun_s / 2 > most)
        return false; /* it passes standstill, where the limits may change, or is too fast */
    const forward_t f = {
        rest, begun_s, target + begun_s * (rest + a * begun_s * (1.0 / 6.0)), limits->acceleration,
        limits->deceleration, jerk, 1 / limits->acceleration, 1 / limits->deceleration, per_jerk,
    };
    change_t up = change_of(most - rest, f.up, f.per_up, jerk, per_jerk);
    change_t down = change_of(most, f.down, f.per_down, jerk, per_jerk);
    double cruise = f.way - (most + rest) / 2 * time_of(&up) - most / 2 * time_of(&down);
    if (!(cruise >= 0)) {
        const double ramp_s = ramp_to_peak(&f, most, -cruise), gained = jerk * ramp_s * ramp_s;
        if (!(ramp_s >= 0))
            return false;
        up = change_of(gained, f.up, f.per_up, jerk, per_jerk);
        down = change_of(rest + gained, f.down, f.per_down, jerk, per_jerk);
        cruise = 0;
    }
    if (!(up.ramp_s >= begun_s)) /* the peak is as near as the present acceleration allows: rounding decides */
        return false;
    cm1e_pieces_append(pieces, jerk, a, up.ramp_s - begun_s);
    cm1e_pieces_append(pieces, 0, up.peak, up.flat_s);
    cm1e_pieces_append(pieces, -jerk, up.peak, up.ramp_s);
    cm1e_pieces_append(pieces, 0, 0, cruise / most);
    cm1e_pieces_append(pieces, -jerk, 0, down.ramp_s);
    cm1e_pieces_append(pieces, 0, -down.peak, down.flat_s);
    cm1e_pieces_append(pieces, jerk, -down.peak, down.ramp_s);
    return true;
}
