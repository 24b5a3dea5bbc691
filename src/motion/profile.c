/*
 * To a position in the shortest time. From any state there is one motion that stops soonest. If it ends short of the
 * target, the axis pushes: it goes for the velocity limit in the direction of the target, as fast as it may, and
 * changes at the switching time to the motion that stops soonest. The later it switches, the farther it gets, so the
 * switching time is the root of a function that never falls, piece by piece of the push. That covers starts with any
 * acceleration, short ways that never bring the acceleration to zero before the stop, targets that can only be reached
 * by way of an overshoot, and starts outside the limits, since both motions come inside on the shortest way.
 */
#include "motion/profile.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>

#include "motion/pieces.h"

enum { SOLVER_STEPS_MAX = 120 };

/** The piece of the push within which the stop begins, and the state in which it is entered. */
typedef struct {
    cm1e_piece_t piece;
    double position, velocity;
} push_t;

/** Beyond these the powers and products of the numbers would leave the range of doubles. */
static const double LARGEST = 1e30, SMALLEST_LIMIT = 1e-30;

static bool is_number(double value) { return fabs(value) <= LARGEST; }

static bool is_limit(double value) { return value >= SMALLEST_LIMIT && value <= LARGEST; }

static bool is_valid(const cm1e_motion_state_t *start, double target, const cm1e_motion_limits_t *limits)
{
    return is_number(start->position) && is_number(start->velocity) && is_number(start->acceleration) &&
           is_number(target) && is_limit(limits->velocity) && is_limit(limits->acceleration) &&
           is_limit(limits->deceleration) && (is_limit(limits->jerk) || limits->jerk == INFINITY);
}

/** Makes the profile out of pieces that were planned mirrored by `sign` and relative to the start. The start and the
 *  end state are taken as they are, not as rounding left them. Refuses pieces that do not lead to the end: the numbers
 *  are then too far apart for doubles. */
static cm1e_error_t build(cm1e_profile_t *profile, const cm1e_motion_state_t *start, const cm1e_pieces_t *pieces,
                          double sign, const cm1e_motion_state_t *end, const cm1e_motion_limits_t *limits)
{
    double time = 0, position = 0, farthest = 0, velocity = sign * start->velocity;
    profile->segment_count = pieces->count;
    for (int i = 0; i < pieces->count; i++) {
        const cm1e_piece_t *piece = &pieces->piece[i];
        if (piece->jerk == 0 && piece->acceleration == 0) /* the cruise may be long: no rounded velocity there */
            velocity = limits->velocity;
        profile->segments[i] = (cm1e_profile_segment_t){
            .start_s = time,
            .jerk = sign * piece->jerk,
            .start = {start->position + sign * position, sign * velocity, sign * piece->acceleration},
        };
        const cm1e_motion_state_t next = cm1e_piece_state(piece, position, velocity, piece->duration_s);
        position = next.position;
        velocity = next.velocity;
        farthest = fmax(farthest, fabs(position));
        time += piece->duration_s;
    }
    profile->duration_s = time;
    profile->end = *end;
    if (isnan(end->position))
        profile->end.position = start->position + sign * position;
    const double missing = profile->end.position - start->position - sign * position;
    const double noise = 1e-9 * farthest + 16 * DBL_EPSILON * (fabs(start->position) + fabs(profile->end.position));
    return isfinite(time) && isfinite(noise) && fabs(missing) <= noise ? CM1E_OK : CM1E_ERROR_INVALID_ARGUMENT;
}

static double displacement(const cm1e_pieces_t *pieces, double velocity)
{
    cm1e_motion_state_t state = {0, velocity, 0};
    for (int i = 0; i < pieces->count; i++)
        state = cm1e_piece_state(&pieces->piece[i], state.position, state.velocity, pieces->piece[i].duration_s);
    return state.position;
}

/** Where the axis comes to rest when it switches to the stop after `time` of the piece, and the derivative. Valid
 *  where the stop begins by lowering the acceleration; where it does not, push and stop are still the same. */
static double reach(const push_t *push, const cm1e_motion_limits_t *limits, double time, double *slope)
{
    const cm1e_motion_state_t state = cm1e_piece_state(&push->piece, push->position, push->velocity, time);
    const double v = state.velocity, a = state.acceleration, d = limits->deceleration;
    if (isinf(limits->jerk)) {
        *slope = v * (1 + a / d);
        return state.position + v * (v / d) / 2;
    }
    /* The stop from (v, a) is the stop from (peak, 0) plus the way from (v, a) to there, backwards if a < 0. */
    const double ramp = a / limits->jerk, peak = fmax(0, v + a * ramp / 2), edge = d / limits->jerk;
    double stop, stop_slope;
    if (peak > d * edge) {
        stop = peak * (peak / d + edge) / 2;
        stop_slope = peak / d + edge / 2;
    } else {
        const double side = sqrt(peak / limits->jerk);
        stop = peak * side;
        stop_slope = 1.5 * side;
    }
    *slope = (push->piece.jerk / limits->jerk + 1) * (peak + a * (ramp / 2 + stop_slope));
    return state.position + ramp * (v + a * ramp / 3) + stop;
}

/** From which time of the piece on the reach grows; its duration if not at all. */
static double growth_start(const push_t *push, const cm1e_motion_limits_t *limits)
{
    const cm1e_piece_t *piece = &push->piece;
    const double v = push->velocity, a = piece->acceleration, jerk = limits->jerk;
    if (piece->jerk < 0 || (piece->jerk == 0 && a <= 0))
        return piece->duration_s;
    if (piece->jerk == 0)
        return fmax(0, -(v + a * (a / jerk) / 2) / a);
    const double at_rest = v - a * (a / jerk) / 2; /* the velocity at which the acceleration is zero */
    const double from = at_rest > 0 ? -limits->deceleration : sqrt(-at_rest * jerk);
    return fmax(0, (from - a) / jerk);
}

/** The switching time between low and high. The reach grows from `low` on like a power of the time, with an exponent
 *  between 1 and 4 that changes on the way: Newton's method on its logarithm comes close from anywhere, Newton's method
 *  proper does the rest, and bisection takes over where that leaves the bracket or its steps do not get shorter. */
static double solve(const push_t *push, const cm1e_motion_limits_t *limits, double target, double low, double high)
{
    const double origin = low;
    double slope, time = high, last_step = 2 * (high - low);
    const double origin_reach = reach(push, limits, low, &slope), missing = target - origin_reach;
    for (int i = 0; i < SOLVER_STEPS_MAX; i++) {
        const double grown = reach(push, limits, time, &slope) - origin_reach, excess = grown - missing;
        double next = time - excess / slope;
        if (fabs(excess) <= 1e-8 * missing || fabs(next - time) <= DBL_EPSILON * time) /* quadratic: that was it */
            return fmin(fmax(next, low), high);
        if (excess > 0)
            high = time;
        else
            low = time;
        if (grown > 2 * missing)
            next = origin + (time - origin) * pow(missing / grown, grown / (slope * (time - origin)));
        if (!(next > low && next < high) || fabs(next - time) > last_step / 2)
            next = low + (high - low) / 2;
        last_step = fabs(next - time);
        time = next;
    }
    return time;
}

/** All mirrored so that the target lies beyond the position of the soonest stop. */
static void append_push_and_stop(cm1e_pieces_t *pieces, double velocity, double acceleration, double target,
                                 const cm1e_motion_limits_t *limits)
{
    cm1e_pieces_t whole = {.count = 0};
    cm1e_pieces_append_velocity_change(&whole, velocity, acceleration, limits->velocity, limits);
    push_t push = {.position = 0, .velocity = velocity};
    for (int i = 0; i < whole.count; i++) {
        const cm1e_piece_t *piece = &push.piece;
        push.piece = whole.piece[i];
        const double grows = growth_start(&push, limits);
        double slope;
        if (grows < piece->duration_s && reach(&push, limits, piece->duration_s, &slope) >= target) {
            const double time = solve(&push, limits, target, grows, piece->duration_s);
            const cm1e_motion_state_t state = cm1e_piece_state(piece, push.position, push.velocity, time);
            cm1e_pieces_append(pieces, piece->jerk, piece->acceleration, time);
            cm1e_pieces_append_velocity_change(pieces, state.velocity, state.acceleration, 0, limits);
            return;
        }
        cm1e_pieces_append(pieces, piece->jerk, piece->acceleration, piece->duration_s);
        const cm1e_motion_state_t state = cm1e_piece_state(piece, push.position, push.velocity, piece->duration_s);
        push.position = state.position;
        push.velocity = state.velocity;
    }
    cm1e_pieces_t stop = {.count = 0};
    cm1e_pieces_append_velocity_change(&stop, limits->velocity, 0, 0, limits);
    const double cruise = target - push.position - displacement(&stop, limits->velocity);
    cm1e_pieces_append(pieces, 0, 0, cruise / limits->velocity);
    for (int i = 0; i < stop.count; i++)
        cm1e_pieces_append(pieces, stop.piece[i].jerk, stop.piece[i].acceleration, stop.piece[i].duration_s);
}

cm1e_error_t cm1e_profile_to_position(cm1e_profile_t *profile, const cm1e_motion_state_t *start, double target,
                                      const cm1e_motion_limits_t *limits)
{
    if (!is_valid(start, target, limits))
        return CM1E_ERROR_INVALID_ARGUMENT;
    const cm1e_motion_state_t end = {target, 0, 0};
    cm1e_pieces_t pieces = {.count = 0};
    cm1e_pieces_append_velocity_change(&pieces, start->velocity, start->acceleration, 0, limits);
    const double distance = target - start->position, stop = displacement(&pieces, start->velocity);
    /* What rounding of the positions alone can make of a target that is where the axis stops anyway. */
    const double noise = 4 * DBL_EPSILON * (fabs(start->position) + fabs(target) + fabs(stop));
    if (fabs(distance - stop) <= noise)
        return build(profile, start, &pieces, 1, &end, limits);

    const double sign = distance > stop ? 1 : -1;
    pieces.count = 0;
    append_push_and_stop(&pieces, sign * start->velocity, sign * start->acceleration, sign * distance, limits);
    return build(profile, start, &pieces, sign, &end, limits);
}

cm1e_error_t cm1e_profile_to_velocity(cm1e_profile_t *profile, const cm1e_motion_state_t *start, double velocity,
                                      const cm1e_motion_limits_t *limits)
{
    if (!is_valid(start, velocity, limits))
        return CM1E_ERROR_INVALID_ARGUMENT;
    velocity = fmax(-limits->velocity, fmin(limits->velocity, velocity));
    cm1e_pieces_t pieces = {.count = 0};
    cm1e_pieces_append_velocity_change(&pieces, start->velocity, start->acceleration, velocity, limits);
    const cm1e_motion_state_t end = {NAN, velocity, 0}; /* wherever it is reached */
    return build(profile, start, &pieces, 1, &end, limits);
}
