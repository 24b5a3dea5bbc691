/* Plans to a position with a velocity there, in the shortest time. From any state one motion reaches the target
 * velocity soonest. If that motion ends short of the target, the axis pushes: it accelerates towards the velocity limit
 * in the direction of the target, and changes at the switching time to the motion that reaches the target velocity
 * soonest. The position at which it then has the target velocity is called the reach, so the switching time is the
 * first root of the reach (minus the target). With a target velocity towards the target, or 0, the reach never falls.
 * With a target velocity away from the target, the reach falls while the axis does not get beyond standstill in
 * between, and grows afterwards, up to a cruise of any length. If the axis starts while its velocity falls, the reach
 * first grows to a maximum, the hill. This covers starts with any acceleration, short distances without zero
 * acceleration in between, targets that need an overshoot or a run-up, and starts outside the limits, because both
 * motions return inside the limits first. */
#include "motion/profile.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>

#include "core/extreme.h"
#include "motion/pieces.h"

enum { SOLVER_STEPS_MAX = 120, HILL_STEPS = 30 };

/** The problem: target of the push, the piece of the push in which the change to the target velocity begins, and the
 *  state at the start of that piece. */
typedef struct {
    const cm1e_motion_limits_t *limits;
    double start_velocity, start_acceleration, target, target_velocity;
    double per_jerk, per_deceleration; /**< 1 / the limit */
    bool simple; /**< the change of velocity crosses neither standstill nor limits->velocity */
    cm1e_piece_t piece;
    double position, velocity;
    double reached; /**< end of the change from this state */
} push_t;

/** The reach: position at which the axis has the target velocity, if the change begins after a time of the piece. */
typedef struct {
    double position, slope;
} reach_t;

/** A step of the position by this fraction of the distance is ignored. */
static const double OVERLOOKED = 1e-11;

/** Beyond these the powers and products of the numbers would leave the range of doubles. */
static const double LARGEST = 1e30, SMALLEST_LIMIT = 1e-30;

bool cm1e_motion_is_number(double value) { return fabs(value) <= LARGEST; }

static bool is_limit(double value) { return value >= SMALLEST_LIMIT && value <= LARGEST; }

bool cm1e_motion_is_valid(const cm1e_motion_state_t *start, const cm1e_motion_limits_t *limits)
{
    return cm1e_motion_is_number(start->position) && cm1e_motion_is_number(start->velocity) &&
           cm1e_motion_is_number(start->acceleration) && is_limit(limits->velocity) &&
           is_limit(limits->acceleration) && is_limit(limits->deceleration) &&
           (is_limit(limits->jerk) || limits->jerk == INFINITY);
}

/** Rounding may miss the target by this fraction of the way. */
static const double MISSED = 1e-9;

/** At least the length of the whole way, there and back; `last`: the velocity at the end. */
static double travelled(const cm1e_profile_t *profile, double last)
{
    double way = 0;
    for (int i = 0; i < profile->segment_count; i++) {
        const cm1e_profile_segment_t *segment = &profile->segments[i];
        const bool is_last = i == profile->segment_count - 1;
        const double until_s = is_last ? profile->duration_s : segment[1].start_s;
        const double v_end = is_last ? last : segment[1].start.velocity;
        way += larger(fabs(segment->start.velocity), fabs(v_end)) * (until_s - segment->start_s);
    }
    return way;
}

/** Makes the profile out of pieces that were planned mirrored by `sign` and relative to the start. The start and the
 *  end state are exact, without rounding. Refuses pieces that do not lead to the end: the numbers are then too far
 *  apart for doubles. */
static cm1e_error_t build(cm1e_profile_t *profile, const cm1e_motion_state_t *start, const cm1e_pieces_t *pieces,
                          double sign, const cm1e_motion_state_t *end, const cm1e_motion_limits_t *limits)
{
    double time = 0, position = 0, velocity = sign * start->velocity;
    profile->segment_count = pieces->count;
    for (int i = 0; i < pieces->count; i++) {
        const cm1e_piece_t *piece = &pieces->piece[i];
        if (piece->jerk == 0 && piece->acceleration == 0) /* the cruise may be long, so its velocity must be exact */
            velocity = i + 1 < pieces->count ? limits->velocity : sign * end->velocity;
        profile->segments[i] = (cm1e_profile_segment_t){
            .start_s = time,
            .jerk = sign * piece->jerk,
            .start = {start->position + sign * position, sign * velocity, sign * piece->acceleration},
        };
        const cm1e_motion_state_t next = cm1e_piece_state(piece, position, velocity, piece->duration_s);
        position = next.position;
        velocity = next.velocity;
        time += piece->duration_s;
    }
    profile->duration_s = time;
    profile->end = *end;
    if (isnan(end->position))
        profile->end.position = start->position + sign * position;
    const double missing = profile->end.position - start->position - sign * position;
    const double noise = 16 * DBL_EPSILON * (fabs(start->position) + fabs(profile->end.position)) + DBL_MIN;
    if (!isfinite(time))
        return CM1E_ERROR_INVALID_ARGUMENT;
    if (fabs(missing) < MISSED * fabs(position) + noise) /* it is shorter than the whole way, and known already */
        return CM1E_OK;
    const double most = MISSED * travelled(profile, sign * velocity) + noise;
    return isfinite(most) && fabs(missing) <= most ? CM1E_OK : CM1E_ERROR_INVALID_ARGUMENT;
}

/** Valid if the change begins by lowering the acceleration; otherwise push and change are equal. */
static reach_t simple_reach(const push_t *push, double time)
{
    const double d = push->limits->deceleration, w = push->target_velocity, per_jerk = push->per_jerk;
    const cm1e_motion_state_t state = cm1e_piece_state(&push->piece, push->position, push->velocity, time);
    const double v = state.velocity, a = state.acceleration;
    if (per_jerk == 0) {
        const double less = v > w ? v - w : 0;
        return (reach_t){state.position + less * push->per_deceleration * ((v + w) / 2),
                         v * (1 + a * push->per_deceleration)};
    }
    /* The change from (v, a) is the change from (peak, 0) plus the distance from (v, a) to there, backwards if a <
     * 0. */
    const double ramp = a * per_jerk, less = v + a * ramp / 2 - w, edge = d * per_jerk;
    const double mean = w + less / 2;
    double duration, duration_slope;
    if (less > d * edge) {
        duration = less * push->per_deceleration + edge;
        duration_slope = push->per_deceleration;
    } else if (less > 0) {
        const double side = sqrt(less * per_jerk);
        duration = 2 * side;
        duration_slope = side / less;
    } else {
        return (reach_t){state.position + ramp * (v + a * ramp * (1.0 / 3.0)), 0};
    }
    return (reach_t){
        state.position + ramp * (v + a * ramp * (1.0 / 3.0)) + mean * duration,
        (push->piece.jerk * per_jerk + 1) * (w + less + a * (ramp / 2 + duration / 2 + mean * duration_slope)),
    };
}

/** Any change of velocity as a whole. The derivative follows from its steepest acceleration (m, at the end of its first
 *  ramp) and from the velocity at which it would have begun with no acceleration (p): (1 + a/m)(p + a m / 2 jerk) for
 *  one downwards, whatever comes after its first ramp. */
static reach_t any_reach(const push_t *push, double time)
{
    const cm1e_motion_state_t state = cm1e_piece_state(&push->piece, push->position, push->velocity, time);
    const double v = state.velocity, a = state.acceleration, per_jerk = push->per_jerk;
    cm1e_pieces_t change;
    change.count = 0;
    cm1e_pieces_append_velocity_change(&change, v, a, push->target_velocity, push->limits);
    reach_t reach = {state.position + cm1e_pieces_displacement(&change, v), 0};
    if (per_jerk == 0) {
        const double limit = v > 0 ? push->limits->deceleration : push->limits->acceleration;
        reach.slope = v > push->target_velocity ? v * (1 + a / limit) : 0;
    } else if (change.count > 0) {
        const double end = a + change.piece[0].jerk * change.piece[0].duration_s; /* -m or m */
        const double turn = change.piece[0].jerk < 0 ? 1 : -1, from = v + turn * a * (a * per_jerk) / 2;
        if (turn * end < 0) /* not lost in the rounding of a: then there is no slope, and the bracket is halved */
            reach.slope = (1 + turn * push->piece.jerk * per_jerk) * (1 - a / end) *
                          (from - turn * a * end * per_jerk / 2);
    }
    return reach;
}

static reach_t reach(const push_t *push, double time)
{
    return push->simple ? simple_reach(push, time) : any_reach(push, time);
}

/** The time of the piece from which on reach() is valid; its duration if never. */
static double growth_start(const push_t *push)
{
    const cm1e_piece_t *piece = &push->piece;
    const double v = push->velocity, a = piece->acceleration, w = push->target_velocity;
    if (!push->simple)
        return 0;
    if (piece->jerk < 0 || (piece->jerk == 0 && a <= 0))
        return piece->duration_s;
    if (piece->jerk == 0)
        return larger(0, (w - v - a * (a * push->per_jerk) / 2) / a);
    const double at_rest = v - a * (a * push->per_jerk) / 2; /* the velocity at which the acceleration is zero */
    const double from = at_rest > w ? -push->limits->deceleration : sqrt((w - at_rest) * push->limits->jerk);
    return from > a ? (from - a) * push->per_jerk : 0;
}

/** The switching time between low and high, where the reach is below and not below the target; `from`: the reach at
 *  low. The reach mostly grows from there on like a power of the time, with an exponent between 1/2 and 4 that changes
 *  on the way: Newton's method on its logarithm comes close from any start, plain Newton does the rest, and bisection
 *  takes over if it leaves the bracket or its steps do not get shorter. */
static double solve(const push_t *push, double low, double from, double high, reach_t at_high)
{
    const double origin = low, missing = push->target - from;
    double time = high, last_step = 2 * (high - low);
    reach_t at = at_high;
    for (int i = 0; i < SOLVER_STEPS_MAX; i++) {
        const double grown = at.position - from, excess = at.position - push->target;
        double next = time - excess / at.slope;
        if (fabs(excess) <= 1e-8 * missing || fabs(next - time) <= DBL_EPSILON * time) /* quadratic: that was it */
            return smaller(high, larger(low, next));
        if (excess > 0)
            high = time;
        else
            low = time;
        if (grown > 2 * missing)
            next = origin + (time - origin) * pow(missing / grown, grown / (at.slope * (time - origin)));
        if (!(next > low && next < high) || fabs(next - time) > last_step / 2)
            next = low + (high - low) / 2;
        last_step = fabs(next - time);
        time = next;
        at = reach(push, time);
    }
    return time;
}

/** The steepest acceleration of the beginning of the change from (velocity, 0). */
static double steepest(const push_t *push, double velocity)
{
    const double jerk = push->limits->jerk;
    if (push->simple)
        return smaller(push->limits->deceleration, sqrt((velocity - push->target_velocity) * jerk));
    cm1e_pieces_t change;
    change.count = 0;
    cm1e_pieces_append_velocity_change(&change, velocity, 0, push->target_velocity, push->limits);
    return jerk * change.piece[0].duration_s;
}

/** An expression with the sign of the derivative of the reach, where the push has the acceleration -x. It begins to
 *  change from a state that lies on the change from (peak, 0); seen over x this is a parabola, or nearly. */
static double hill_slope(const push_t *push, double at_rest, double x)
{
    const double peak = at_rest + x * (x / push->limits->jerk);
    return peak - x * (steepest(push, peak) / push->limits->jerk) / 2;
}

/** The time of the hill in the first piece of the push; 0 if there is none. */
static double hill(const push_t *push)
{
    const cm1e_piece_t *piece = &push->piece;
    const double jerk = push->limits->jerk, most = smaller(-piece->acceleration, push->limits->deceleration);
    const double at_rest = push->velocity - piece->acceleration * (piece->acceleration / jerk) / 2;
    if (!(push->target_velocity < 0 && piece->jerk > 0 && most > 0 && at_rest > push->target_velocity) ||
        at_rest + most * (most / jerk) / 2 <= 0 || hill_slope(push, at_rest, most) <= 0)
        return 0;
    double falls = at_rest < 0 ? 0 : steepest(push, at_rest) / 4, grows = most;
    if (falls >= most || hill_slope(push, at_rest, falls) >= 0)
        return 0;
    for (int i = 0; i < HILL_STEPS; i++) {
        const double x = (falls + grows) / 2;
        if (hill_slope(push, at_rest, x) > 0)
            grows = x;
        else
            falls = x;
    }
    return (-piece->acceleration - grows) / jerk;
}

/** The switching time within the piece; negative: not in this piece. */
static double switching_time(push_t *push, bool first)
{
    const double end = push->piece.duration_s, grows = growth_start(push), top = first ? hill(push) : 0;
    reach_t at;
    double low = grows;
    if (top > 0 && top > grows) {
        at = reach(push, top);
        if (at.position >= push->target)
            return solve(push, grows, push->reached, top, at);
        low = top;
        push->reached = at.position;
    }
    if (!(low < end))
        return -1;
    at = reach(push, end);
    if (at.position >= push->target)
        return solve(push, low, push->reached, end, at);
    push->reached = at.position;
    return -1;
}

/** The piece up to the switching time, and the change. With a target velocity towards the target, the reach begins to
 *  grow infinitely fast, so that adjacent doubles differ too much. Then the value before the target is taken, and the
 *  remaining distance is covered at target velocity. */
static void append_change(cm1e_pieces_t *pieces, const push_t *push, double time)
{
    const int count = pieces->count; /* and the last piece, before another may be merged with it */
    const cm1e_piece_t last = count > 0 ? pieces->piece[count - 1] : (cm1e_piece_t){0, 0, 0};
    const cm1e_piece_t *piece = &push->piece;
    const double w = push->target_velocity;
    const double overlooked = OVERLOOKED * (fabs(push->target) + fabs(push->start_velocity) * time);
    double left;
    for (double step = DBL_EPSILON; time >= 0; step *= 4) {
        const cm1e_motion_state_t state = cm1e_piece_state(piece, push->position, push->velocity, time);
        cm1e_pieces_append(pieces, piece->jerk, piece->acceleration, time);
        cm1e_pieces_append_velocity_change(pieces, state.velocity, state.acceleration, w, push->limits);
        if (!(w > 0))
            return;
        left = push->target - cm1e_pieces_displacement(pieces, push->start_velocity);
        if (left > overlooked)
            cm1e_pieces_append(pieces, 0, 0, left / w);
        if (left >= -overlooked)
            return;
        pieces->count = count;
        if (count > 0)
            pieces->piece[count - 1] = last;
        time = time > 0 ? larger(0, time - step * time) : -1;
    }
    pieces->count = 0; /* a step that begins in a piece before: without any push */
    cm1e_pieces_append_velocity_change(pieces, push->start_velocity, push->start_acceleration, w, push->limits);
    left = push->target - cm1e_pieces_displacement(pieces, push->start_velocity);
    cm1e_pieces_append(pieces, 0, 0, left / w);
}

/** The change from the velocity limit to `w`, and its length. */
static double change_at_limit(cm1e_pieces_t *change, double w, const cm1e_motion_limits_t *limits)
{
    change->count = 0;
    cm1e_pieces_append_velocity_change(change, limits->velocity, 0, w, limits);
    return cm1e_pieces_displacement(change, limits->velocity);
}

static void append_all(cm1e_pieces_t *pieces, const cm1e_pieces_t *more)
{
    for (int i = 0; i < more->count; i++)
        cm1e_pieces_append(pieces, more->piece[i].jerk, more->piece[i].acceleration, more->piece[i].duration_s);
}

/** All mirrored so that the target lies beyond the end of the soonest change of velocity, `direct`. */
static void append_push_and_change(cm1e_pieces_t *pieces, double velocity, double acceleration, double target,
                                   double target_velocity, double direct, const cm1e_motion_limits_t *limits)
{
    const double w = target_velocity;
    cm1e_pieces_t whole;
    whole.count = 0;
    cm1e_pieces_append_velocity_change(&whole, velocity, acceleration, limits->velocity, limits);
    /* Where the reach never falls, the change begins within the push only if its end is too far. */
    const bool simple = fabs(w) <= limits->velocity && (w >= 0 || limits->acceleration == limits->deceleration);
    const double left = target - cm1e_pieces_displacement(&whole, velocity);
    if (simple && w >= 0 && left >= 0) {
        cm1e_pieces_t change;
        const double cruise = left - change_at_limit(&change, w, limits);
        if (cruise >= 0) {
            append_all(pieces, &whole);
            cm1e_pieces_append(pieces, 0, 0, cruise / limits->velocity);
            append_all(pieces, &change);
            return;
        }
    }
    push_t push = {
        .limits = limits, .start_velocity = velocity, .start_acceleration = acceleration,
        .target = target, .target_velocity = w,
        .per_jerk = 1 / limits->jerk, .per_deceleration = 1 / limits->deceleration,
        .velocity = velocity, .reached = direct, .simple = simple,
    };
    for (int i = 0; i < whole.count; i++) {
        const cm1e_piece_t *piece = &push.piece;
        push.piece = whole.piece[i];
        const double time = switching_time(&push, i == 0);
        if (time >= 0) {
            append_change(pieces, &push, time);
            return;
        }
        const cm1e_motion_state_t state = cm1e_piece_state(piece, push.position, push.velocity, piece->duration_s);
        cm1e_pieces_append(pieces, piece->jerk, piece->acceleration, piece->duration_s);
        push.position = state.position;
        push.velocity = state.velocity;
    }
    cm1e_pieces_t change;
    const double braking = change_at_limit(&change, w, limits);
    cm1e_pieces_append(pieces, 0, 0, (target - push.position - braking) / limits->velocity);
    append_all(pieces, &change);
}

double cm1e_motion_noise(double start, double target, double displacement)
{
    return 4 * DBL_EPSILON * (fabs(start) + fabs(target) + fabs(displacement));
}

cm1e_error_t cm1e_profile_to_state(cm1e_profile_t *profile, const cm1e_motion_state_t *start, double target_position,
                                   double target_velocity, const cm1e_motion_limits_t *limits)
{
    if (!cm1e_motion_is_valid(start, limits) || !cm1e_motion_is_number(target_position) ||
        !cm1e_motion_is_number(target_velocity))
        return CM1E_ERROR_INVALID_ARGUMENT;
    const cm1e_motion_state_t end = {target_position, target_velocity, 0};
    cm1e_pieces_t pieces;
    pieces.count = 0;
    cm1e_pieces_append_velocity_change(&pieces, start->velocity, start->acceleration, target_velocity, limits);
    const double distance = target_position - start->position;
    const double change = cm1e_pieces_displacement(&pieces, start->velocity);
    double noise = cm1e_motion_noise(start->position, target_position, change);
    if ((distance - change) * target_velocity < 0) /* too short only by rounding: no run-up */
        noise += CM1E_MOTION_TOO_SHORT * fabs(change);
    else if (target_velocity != 0) /* tolerance of cm1e_profile_passing_velocity() */
        noise += OVERLOOKED * fabs(change);
    if (fabs(distance - change) <= noise)
        return build(profile, start, &pieces, 1, &end, limits);

    const double sign = distance > change ? 1 : -1;
    pieces.count = 0;
    if (target_velocity == 0 &&
        cm1e_pieces_append_forward_move(&pieces, sign * start->velocity, sign * start->acceleration, sign * distance,
                                        limits) &&
        build(profile, start, &pieces, sign, &end, limits) == CM1E_OK)
        return CM1E_OK;
    pieces.count = 0;
    append_push_and_change(&pieces, sign * start->velocity, sign * start->acceleration, sign * distance,
                           sign * target_velocity, sign * change, limits);
    return build(profile, start, &pieces, sign, &end, limits);
}

cm1e_error_t cm1e_profile_to_position(cm1e_profile_t *profile, const cm1e_motion_state_t *start, double target,
                                      const cm1e_motion_limits_t *limits)
{
    return cm1e_profile_to_state(profile, start, target, 0, limits);
}

cm1e_error_t cm1e_profile_to_velocity(cm1e_profile_t *profile, const cm1e_motion_state_t *start, double velocity,
                                      const cm1e_motion_limits_t *limits)
{
    if (!cm1e_motion_is_valid(start, limits) || !cm1e_motion_is_number(velocity))
        return CM1E_ERROR_INVALID_ARGUMENT;
    velocity = larger(-limits->velocity, smaller(limits->velocity, velocity));
    cm1e_pieces_t pieces;
    pieces.count = 0;
    cm1e_pieces_append_velocity_change(&pieces, start->velocity, start->acceleration, velocity, limits);
    const cm1e_motion_state_t end = {NAN, velocity, 0}; /* without a target position */
    return build(profile, start, &pieces, 1, &end, limits);
}

cm1e_error_t cm1e_pieces_to_standstill(cm1e_profile_t *profile, const cm1e_motion_state_t *start,
                                       const cm1e_pieces_t *pieces, const cm1e_motion_limits_t *limits)
{
    const cm1e_motion_state_t end = {NAN, 0, 0};
    return build(profile, start, pieces, 1, &end, limits);
}
