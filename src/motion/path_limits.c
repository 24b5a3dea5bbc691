/* What the limits of the axes allow along a piece. With q the position of an axis over the length, v, a and j the
 * motion along the path, the axis has the velocity q' v, the acceleration q'' v2 + q' a and the jerk q''' v3 + 3 q'' v
 * a + q' j. For a line q'' and q''' are 0, and the limits follow directly. In a bend the terms share the limits of the
 * axis: more acceleration along the path leaves less velocity. The share with the shortest time over the piece is
 * chosen. A stop gets slower, so the share for it is known at several velocities. */
#include <math.h>

#include "core/extreme.h"
#include "motion/path_piece.h"

enum { STEPS_LEAST = 40, STEPS_MOST = 96, BENDS_MAX = (STEPS_MOST + 1) * CM1E_PATH_AXES, SOLVER_STEPS = 40 };

/** Allowance for what the parabolas through the evaluated points of a curve do not show. */
static const double BEYOND_PARABOLAS = 1.001;

/** Allowance for rounding at a limit that is fully used. */
static const double ROUNDING = 1e-9;

/** A velocity that is lower by this fraction counts as equal. */
static const double ENOUGH = 1e-4;

/** Sizes of the derivatives of an axis by the length, and its limits. */
typedef struct {
    double first, second, third, acceleration, jerk;
} bend_t;

typedef struct {
    cm1e_motion_limits_t straight; /**< limits without the bend */
    double velocity; /**< velocity above which the bend alone exceeds the limits */
    bool round; /**< a circle: the terms along and across never reach their maxima at the same time */
    int count;
    bend_t bend[BENDS_MAX];
} bends_t;

static void add(bends_t *bends, const cm1e_path_axis_t *axis, const cm1e_path_share_t *share, const bend_t *sizes)
{
    const double acceleration = axis->acceleration * share->acceleration, jerk = axis->jerk * share->jerk;
    if (sizes->first > 0) {
        bends->straight.velocity = smaller(bends->straight.velocity, axis->velocity / sizes->first);
        bends->straight.acceleration = smaller(bends->straight.acceleration, acceleration / sizes->first);
        bends->straight.jerk = smaller(bends->straight.jerk, jerk / sizes->first);
    }
    if (sizes->second > 0 || sizes->third > 0) {
        bends->bend[bends->count] = *sizes;
        bends->bend[bends->count].acceleration = acceleration;
        bends->bend[bends->count++].jerk = jerk;
    }
}

/** The sharper a curve, the shorter the distance over the middle of its parameter, and the faster its bend changes
 *  there. */
static int steps_over(const cm1e_path_piece_t *curve)
{
    double shortest = INFINITY;
    for (int i = 0; i < CM1E_PATH_KNOTS; i++)
        shortest = smaller(shortest, curve->at[i + 1] - curve->at[i]);
    const double sharpness = curve->length / CM1E_PATH_KNOTS / shortest;
    return (int)smaller(larger(STEPS_LEAST / 4.0 * sharpness * sharpness, STEPS_LEAST), STEPS_MOST);
}

/** The largest size up to half way to the next points. A parabola is above its chords by at most an eighth of its
 *  second difference. */
static double most_near(double here, double second_difference)
{
    return BEYOND_PARABOLAS * larger(fabs(here), fabs(here - second_difference / 8));
}

static void look_along(bends_t *bends, const cm1e_path_piece_t *curve, const cm1e_path_config_t *config,
                       const cm1e_path_share_t *share)
{
    const int steps = steps_over(curve);
    double by_length[3][3][CM1E_PATH_AXES]; /* of three points, by the number of the point modulo 3 */
    for (int k = 0; k < 3; k++)
        cm1e_path_curve_derivatives(curve, config->axes, (double)k / steps, by_length[k]);
    for (int k = 0; k <= steps; k++) {
        if (k > 1 && k < steps)
            cm1e_path_curve_derivatives(curve, config->axes, (k + 1.0) / steps, by_length[(k + 1) % 3]);
        const int middle = k == 0 ? 1 : k == steps ? steps - 1 : k;
        for (int i = 0; i < config->axes; i++) {
            double most[3];
            for (int order = 0; order < 3; order++)
                most[order] = most_near(by_length[k % 3][order][i],
                                        by_length[(middle - 1) % 3][order][i] - 2 * by_length[middle % 3][order][i] +
                                            by_length[(middle + 1) % 3][order][i]);
            add(bends, &config->axis[i], share, &(bend_t){most[0], most[1], most[2], 0, 0});
        }
    }
}

static void look(bends_t *bends, const cm1e_path_piece_t *piece, const cm1e_path_config_t *config,
                 const cm1e_path_share_t *share)
{
    bends->straight = (cm1e_motion_limits_t){INFINITY, INFINITY, INFINITY, INFINITY};
    bends->round = piece->kind == CM1E_PATH_ARC;
    bends->count = 0;
    if (piece->kind == CM1E_PATH_CURVE) {
        look_along(bends, piece, config, share);
    } else {
        for (int i = 0; i < config->axes; i++) {
            const bool bent = bends->round && i < piece->measured;
            const double round = bent ? hypot(piece->u[0][i], piece->v[0][i]) : 0;
            const double curvature = bent ? 1 / piece->radius : 0;
            add(bends, &config->axis[i], share,
                &(bend_t){round + fabs(piece->direction[i]), round * curvature, round * curvature * curvature, 0, 0});
        }
    }
    bends->straight.deceleration = bends->straight.acceleration;
    double curvature = 0, change = 0;
    for (int i = 0; i < bends->count; i++) {
        curvature = larger(curvature, bends->bend[i].second / bends->bend[i].acceleration);
        change = larger(change, bends->bend[i].third / bends->bend[i].jerk);
    }
    bends->velocity = smaller(bends->straight.velocity, smaller(1 / sqrt(curvature), 1 / cbrt(change)));
}

/** The velocity at which the jerk reaches its limit. For a circle it is found by bisection, otherwise as the root of a
 *  cubic by Newton's method from above. */
static double velocity_for_jerk(const bends_t *bends, const bend_t *bend, double velocity, double a, double pushed)
{
    if (!bends->round) {
        const double linear = 3 * bend->second * a;
        for (int k = 0; k < SOLVER_STEPS; k++) {
            const double square = velocity * velocity;
            const double less = (velocity * (bend->third * square + linear) + pushed - bend->jerk) /
                                (3 * bend->third * square + linear);
            velocity -= less;
            if (less <= ENOUGH * velocity)
                break;
        }
        return larger(0, velocity * (1 - ENOUGH));
    }
    const double jerk = bend->jerk * (1 + ROUNDING);
    double low = 0, high = velocity;
    for (int k = 0; k < SOLVER_STEPS && high - low > ENOUGH * high; k++) {
        const double middle = (low + high) / 2;
        if (hypot(pushed + bend->third * middle * middle * middle, 3 * bend->second * middle * a) <= jerk)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/** The highest velocity up to `velocity` with this acceleration and jerk along the path. */
static double velocity_with(const bends_t *bends, double velocity, double a, double j)
{
    for (int i = 0; i < bends->count; i++) {
        const bend_t *bend = &bends->bend[i];
        const double along = bend->first * a, pushed = bend->first > 0 ? bend->first * j : 0; /* j may be infinite */
        const double square = velocity * velocity, across = bend->second * square;
        const double whole = bends->round ? hypot(along, across) : along + across;
        if (whole > bend->acceleration * (1 + ROUNDING)) {
            const double most = bend->acceleration * (1 + ROUNDING);
            const double left = bends->round ? sqrt(larger(0, (most - along) * (most + along)))
                                             : larger(0, most - along);
            velocity = sqrt(left / bend->second);
        }
        const double turned = 3 * bend->second * velocity * a;
        const double pushed_on = pushed + bend->third * velocity * velocity * velocity;
        const double jerk = bends->round ? hypot(pushed_on, turned) : pushed_on + turned;
        if (jerk > bend->jerk * (1 + ROUNDING))
            velocity = velocity_for_jerk(bends, bend, velocity, a, pushed);
    }
    return velocity;
}

static double strongest(const cm1e_motion_limits_t *limits)
{
    return larger(limits->acceleration, limits->deceleration);
}

static cm1e_motion_limits_t lower(const cm1e_motion_limits_t *a, const cm1e_motion_limits_t *b, double share)
{
    return (cm1e_motion_limits_t){smaller(a->velocity, b->velocity), smaller(a->acceleration, share * b->acceleration),
                                  smaller(a->deceleration, share * b->deceleration), smaller(a->jerk, share * b->jerk)};
}

static cm1e_motion_limits_t choose(const bends_t *bends, double length, const cm1e_motion_limits_t *wanted)
{
    static const double shares[] = {1, 0.7, 0.5, 0.35, 0.2, 0.1, 0.03};
    cm1e_motion_limits_t best = lower(wanted, &bends->straight, 1);
    const double velocity = smaller(best.velocity, bends->velocity);
    double soonest = INFINITY;
    for (size_t i = 0; bends->count > 0 && i < sizeof shares / sizeof *shares; i++) {
        cm1e_motion_limits_t limits = lower(wanted, &bends->straight, shares[i]);
        limits.velocity = velocity_with(bends, velocity, strongest(&limits), limits.jerk);
        const double time = length / limits.velocity + limits.velocity / strongest(&limits) / 2 +
                            (isinf(limits.jerk) ? 0 : strongest(&limits) / limits.jerk / 2);
        if (time > soonest)
            break;
        if (time < soonest) {
            soonest = time;
            best = limits;
        }
        if (limits.velocity == velocity)
            break;
    }
    return best;
}

/* ---- braking ----------------------------------------------------------------------------------------------------- */

/** Which part of the straight deceleration and jerk is left, of at most `share`, beside what the bend takes at that
 *  velocity. Where the terms of a circle add up across, the root of a quadratic. An axis that does not move along the
 *  path takes part in nothing that is shared: 0 / 0 is no number, and smaller() then takes the other one. */
static double share_of(const bends_t *bends, const bend_t *bend, double velocity, double share)
{
    const double square = velocity * velocity, across = bend->second * square, turned = bend->third * square * velocity;
    const double along = bend->first * bends->straight.acceleration, limit = bend->acceleration;
    const bool jerk = !isinf(bends->straight.jerk);
    const double pushed = jerk ? bend->first * bends->straight.jerk : 0;
    const double swung = 3 * bend->second * velocity * bends->straight.acceleration;
    if (!bends->round) {
        if (across + along * share > limit)
            share = smaller(share, larger(0, limit - across) / along);
        return jerk && turned + (pushed + swung) * share > bend->jerk
                   ? smaller(share, larger(0, bend->jerk - turned) / (pushed + swung)) : share;
    }
    const double left = sqrt(larger(0, (limit - across) * (limit + across)));
    share = along * share > left ? left / along : share;
    if (!jerk || hypot(turned + pushed * share, swung * share) <= bend->jerk)
        return share;
    const double whole = larger(0, (bend->jerk - turned) * (bend->jerk + turned)), mixed = pushed * turned;
    return smaller(share, whole / (mixed + sqrt(mixed * mixed + (pushed * pushed + swung * swung) * whole)));
}

/** Which part of the straight jerk is left, of at most `share`, beside that deceleration. */
static double jerk_beside(const bends_t *bends, const bend_t *bend, double velocity, double deceleration, double share)
{
    const double turned = bend->third * velocity * velocity * velocity, pushed = bend->first * bends->straight.jerk;
    const double swung = 3 * bend->second * velocity * deceleration, most = bend->jerk;
    if (bends->round)
        return smaller(share, larger(0, sqrt(larger(0, (most - swung) * (most + swung))) - turned) / pushed);
    return pushed > 0 && turned + swung + pushed * share > most ? larger(0, most - turned - swung) / pushed : share;
}

static void brake_at_level(cm1e_path_brake_t *brake, const bends_t *bends, int level)
{
    const double velocity = cm1e_path_level(brake, level);
    double share = 1, jerk[CM1E_PATH_BRAKES];
    for (int i = 0; i < bends->count && share > 0; i++)
        share = share_of(bends, &bends->bend[i], velocity, share);
    for (int w = 0; w < CM1E_PATH_BRAKES; w++)
        jerk[w] = 1;
    const bool no_jerk = isinf(bends->straight.jerk);
    for (int i = 0; i < bends->count && share > 0 && !no_jerk; i++)
        for (int w = 0; w < CM1E_PATH_BRAKES; w++)
            jerk[w] = jerk_beside(bends, &bends->bend[i], velocity,
                                  cm1e_path_part(w) * share * bends->straight.acceleration, jerk[w]);
    brake->share[level] = share * (1 - ROUNDING);
    for (int w = 0; w < CM1E_PATH_BRAKES; w++)
        brake->jerk_share[w][level] = jerk[w] * (1 - ROUNDING);
}

static void brake(cm1e_path_brake_t *brake, const bends_t *bends)
{
    brake->velocity = bends->velocity;
    brake->deceleration = bends->straight.acceleration;
    brake->jerk = bends->straight.jerk;
    for (int k = 0; k < CM1E_PATH_LEVELS; k++)
        brake_at_level(brake, bends, k);
}

void cm1e_path_allow(cm1e_path_allowance_t *allowance, const cm1e_path_piece_t *piece,
                     const cm1e_path_config_t *config, const cm1e_path_share_t *share,
                     const cm1e_motion_limits_t *wanted)
{
    bends_t bends;
    look(&bends, piece, config, share);
    brake(&allowance->brake, &bends);
    allowance->limits = choose(&bends, piece->length, wanted);
    allowance->highest = larger(allowance->limits.velocity, velocity_with(&bends, bends.velocity,
                                                                        strongest(&allowance->limits),
                                                                        allowance->limits.jerk));
    allowance->limits.velocity = wanted->velocity;
}
