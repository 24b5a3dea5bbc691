/* The junction of two segments: a stop, a passage, or a curve that replaces both ends; and which elements are planned
 * together. */
#include <math.h>

#include "core/extreme.h"
#include "motion/path_private.h"

enum { TRIES = 4 };

/** A break of the tangent by more than this (rad, or u per u of path) is a corner. */
static const double CORNER = 1e-3;

/** A step of the acceleration below this fraction of what the jerk limit allows in a cycle is ignored. */
static const double NO_STEP = 1e-6;

/** How much of an arc a transition may take (rad), and how far back a corner may turn that it goes round (cosine). */
static const double MOST_OF_ARC = 0.7, BACK = -0.9;

/** A transition shorter than this fraction of the segments is omitted. */
static const double NO_REACH = 1e-6;

/** Allowance for a larger deviation of a curve between the evaluated points. */
static const double BETWEEN_POINTS = 0.98;

/** Which part of the time in which the acceleration comes to 0 a junction between runs costs: one way or the other only
 *  where it does not come to 0 there of itself. */
static const double SAVED = 0.15;

/** Which part of a limit of jerk is for steps of the acceleration. */
static const double STEP_SHARE = 0.5;

static const cm1e_path_share_t ALL = {1, 1};

static cm1e_path_frame_t frame_of(const cm1e_path_t *path)
{
    return (cm1e_path_frame_t){path->config.axes, path->config.space};
}

static void pop_last(cm1e_path_t *path, int count) { path->element_count -= count; }

/** Puts a part of a piece behind everything, not to be entered but from rest. */
static cm1e_path_element_t *push(cm1e_path_t *path, const cm1e_path_piece_t *piece, double skipped, double length,
                                 const cm1e_path_command_t *command, const cm1e_path_share_t *share)
{
    cm1e_path_element_t *element = cm1e_path_element(path, path->element_count++);
    *element = (cm1e_path_element_t){.piece = piece, .tag = command->tag, .last_of_tag = true, .skipped = skipped,
                                     .length = length};
    cm1e_path_allowance_t allowance = {{1, 1, 1, 1}, 1, {.velocity = 1, .deceleration = 1, .jerk = 1}};
    if (piece->length > 0)
        cm1e_path_allow(&allowance, piece, &path->config, share, &command->limits);
    element->limits = allowance.limits;
    element->highest = allowance.highest;
    element->brake = allowance.brake;
    return element;
}

static double blended(cm1e_path_blend_t blend, double first, double second)
{
    switch (blend) {
    case CM1E_PATH_BLEND_PREVIOUS: return first;
    case CM1E_PATH_BLEND_NEXT: return second;
    case CM1E_PATH_BLEND_HIGH: return larger(first, second);
    default: return smaller(first, second);
    }
}

/* ---- one run ----------------------------------------------------------------------------------------------------- */

/** Whether to plan an element in one with those before: they get the lowest of all limits, but the acceleration along
 *  the path need not come to 0 in between. What that takes is compared with what it saves. */
static bool worth_joining(cm1e_path_t *path, int index)
{
    int first = index - 1;
    while (first > 0 && cm1e_path_element(path, first)->joined)
        first--;
    cm1e_path_element_t *element = cm1e_path_element(path, index);
    const cm1e_path_run_t run = cm1e_path_run(path, first, index);
    cm1e_motion_limits_t own = element->limits, low = run.limits;
    own.velocity = smaller(own.velocity * (path->override > 0 ? path->override : 1), element->highest);
    low.velocity = smaller(own.velocity, low.velocity);
    low.acceleration = smaller(own.acceleration, low.acceleration);
    low.deceleration = smaller(own.deceleration, low.deceleration);
    low.jerk = smaller(own.jerk, low.jerk);
    if (low.velocity > element->passed * (1 + 1e-9))
        return false;
    const double same = 1 - 1e-9;
    const bool lowers_run = low.velocity < run.limits.velocity * same || element->highest < run.highest * same ||
                            low.acceleration < run.limits.acceleration * same ||
                            low.deceleration < run.limits.deceleration * same ||
                            low.jerk < run.limits.jerk * same;
    if (lowers_run && first == 0 && (path->along.velocity != 0 || path->along.acceleration != 0))
        return false; /* it is on the way already */
    const double a = smaller(low.acceleration, low.deceleration);
    const double ease = isinf(low.jerk) ? 0 : smaller(a / low.jerk, sqrt(low.velocity / low.jerk));
    const double slower = run.length * (1 / low.velocity - 1 / run.limits.velocity) +
                          element->length * (1 / low.velocity - 1 / own.velocity);
    const double run_a = smaller(run.limits.acceleration, run.limits.deceleration);
    const double own_a = smaller(own.acceleration, own.deceleration);
    const double weaker = smaller(low.velocity / a, 2 * sqrt(2 * run.length / a)) * (1 - a / run_a) +
                          smaller(low.velocity / a, 2 * sqrt(2 * element->length / a)) * (1 - a / own_a);
    element->lost = cm1e_path_element(path, index - 1)->lost + larger(0, slower + weaker);
    return element->lost <= SAVED * ease + 1e-9 * (run.length + element->length) / low.velocity;
}

static void set_entry(cm1e_path_t *path, int index, double passed, double junction)
{
    cm1e_path_element_t *element = cm1e_path_element(path, index);
    element->passed = passed;
    element->junction = junction;
    element->joined = passed > 0 && worth_joining(path, index);
    element->lost = element->joined ? element->lost : 0;
}

/** What of the last element is not needed for the motion under way. */
static double room_on_last(cm1e_path_t *path)
{
    const int last = path->element_count - 1;
    const double length = cm1e_path_element(path, last)->length;
    double used = path->stopping ? path->profile.end.position - path->begin : cm1e_path_here(path);
    for (int i = 0; i < last; i++)
        used -= cm1e_path_element(path, i)->length;
    return length - larger(0, used);
}

/* ---- exactly ----------------------------------------------------------------------------------------------------- */

typedef struct {
    bool corner, even; /**< a break of the tangent; no step of the acceleration either */
    double velocity;   /**< at which the step is as large as it may be */
    double bend_s;     /**< of the acceleration of an axis, per velocity: what a break of the tangent makes in a
                            cycle */
} break_t;

static break_t look_at_break(const cm1e_path_t *path, const cm1e_path_piece_t *before, const cm1e_path_piece_t *after,
                             double velocity)
{
    const cm1e_path_config_t *config = &path->config;
    cm1e_path_point_t a, b;
    cm1e_path_point_at(before, config->axes, before->length, &a);
    cm1e_path_point_at(after, config->axes, 0, &b);
    break_t found = {before->measured != after->measured, true, INFINITY, 0};
    for (int i = 0; i < config->axes; i++) {
        const double bend = fabs(b.tangent[i] - a.tangent[i]) / config->cycle_s;
        const double curve = fabs(b.curvature[i] - a.curvature[i]);
        const double allowed = STEP_SHARE * smaller(config->axis[i].jerk * config->cycle_s,
                                                    config->axis[i].acceleration);
        found.corner = found.corner || bend * config->cycle_s > CORNER;
        found.even = found.even && bend * velocity + curve * velocity * velocity <= NO_STEP * allowed;
        found.bend_s = larger(found.bend_s, bend / config->axis[i].acceleration);
        const double root = sqrt(bend * bend + 4 * curve * allowed);
        if (bend + root > 0)
            found.velocity = smaller(found.velocity, 2 * allowed / (bend + root));
    }
    return found;
}

/** Next to a step, half of the axes' jerk is for the step; and of their acceleration what a break of the tangent
 *  takes. */
static bool pass_slowly(cm1e_path_t *path, cm1e_path_segment_t *before, cm1e_path_segment_t *segment, double velocity,
                        double bend_s, double junction)
{
    const int last = path->element_count - 1;
    cm1e_path_element_t *element = cm1e_path_element(path, last);
    const double zone = velocity * path->config.cycle_s;
    if (!(zone < room_on_last(path) / 2 && zone < segment->piece.length / 2))
        return false;
    element->length -= zone;
    element->last_of_tag = false;
    const cm1e_path_share_t beside = {1 - velocity * bend_s, 1 - STEP_SHARE};
    const struct {
        const cm1e_path_segment_t *of;
        double skipped, length;
        const cm1e_path_share_t *share;
    } parts[3] = {{before, element->skipped + element->length, zone, &beside},
                  {segment, 0, zone, &beside},
                  {segment, zone, segment->piece.length - zone, &ALL}};
    for (int i = 0; i < 3; i++) {
        cm1e_path_element_t *part = push(path, &parts[i].of->piece, parts[i].skipped, parts[i].length,
                                         &parts[i].of->command, parts[i].share);
        part->last_of_tag = i != 1;
        if (i < 2)
            part->highest = smaller(part->highest, velocity);
        set_entry(path, last + 1 + i, velocity, junction);
    }
    if (cm1e_path_plan(path, last))
        return true;
    pop_last(path, 3);
    element->length += zone;
    element->last_of_tag = true;
    return false;
}

static void stop_between(cm1e_path_t *path, cm1e_path_segment_t *segment)
{
    push(path, &segment->piece, 0, segment->piece.length, &segment->command, &ALL);
    (void)cm1e_path_plan(path, path->element_count - 1);
}

static void pass_exactly(cm1e_path_t *path, cm1e_path_segment_t *before, cm1e_path_segment_t *segment)
{
    const double junction = blended(segment->command.blend, before->command.limits.velocity,
                                    segment->command.limits.velocity);
    const int last = path->element_count - 1;
    cm1e_path_element_t *element = push(path, &segment->piece, 0, segment->piece.length, &segment->command, &ALL);
    const double most = smaller(cm1e_path_element(path, last)->highest, element->highest);
    const break_t found = look_at_break(path, &before->piece, &segment->piece, most);
    if (!found.corner && found.even) {
        set_entry(path, last + 1, most, junction);
        if (cm1e_path_plan(path, last))
            return;
        element->joined = false;
        if (cm1e_path_plan(path, last))
            return;
    }
    pop_last(path, 1);
    if (!found.corner && !found.even && pass_slowly(path, before, segment, smaller(most, found.velocity), found.bend_s,
                                                  junction))
        return;
    stop_between(path, segment);
}

/* ---- by a transition --------------------------------------------------------------------------------------------- */

static double most_of(const cm1e_path_piece_t *piece)
{
    return piece->kind == CM1E_PATH_ARC ? smaller(piece->length / 2, MOST_OF_ARC * piece->radius) : piece->length / 2;
}

static bool within_bounds(const cm1e_path_t *path, const cm1e_path_piece_t *piece)
{
    const cm1e_path_frame_t frame = frame_of(path);
    for (int i = 0; i < path->config.axes; i++) {
        double low, high;
        cm1e_path_extent(piece, &frame, i, &low, &high);
        if (low < path->config.axis[i].lowest || high > path->config.axis[i].highest)
            return false;
    }
    return true;
}

/** How far from the junction a transition begins and ends; 0: there is none. */
static double reach_of(const cm1e_path_t *path, const cm1e_path_segment_t *before, cm1e_path_segment_t *segment,
                       double room)
{
    const cm1e_path_frame_t frame = frame_of(path);
    cm1e_path_point_t a, b;
    cm1e_path_point_at(&before->piece, frame.axes, before->piece.length, &a);
    cm1e_path_point_at(&segment->piece, frame.axes, 0, &b);
    double cosine = 0;
    for (int i = 0; i < before->piece.measured; i++)
        cosine += a.tangent[i] * b.tangent[i];
    if (before->piece.measured != segment->piece.measured || cosine < BACK)
        return 0;
    double reach = smaller(room, smaller(most_of(&before->piece), most_of(&segment->piece)));
    const bool by_distance = segment->command.junction == CM1E_PATH_CORNER_DISTANCE;
    if (by_distance)
        reach = smaller(reach, segment->command.parameter);
    else
        reach = smaller(reach, segment->command.parameter * cm1e_path_reach_per_deviation(cosine));
    const double least = NO_REACH * smaller(before->piece.length, segment->piece.length);
    for (int i = 0; i < 2 * TRIES && reach > least; i++) {
        cm1e_path_make_curve(&segment->transition, &frame, &before->piece, reach, &segment->piece, reach);
        const double deviation =
            by_distance ? 0
                        : cm1e_path_deviation(&segment->transition, &frame, &before->piece, &segment->piece);
        if (deviation > BETWEEN_POINTS * segment->command.parameter)
            reach *= 0.999 * BETWEEN_POINTS * segment->command.parameter / deviation;
        else if (!within_bounds(path, &segment->transition))
            reach /= 2;
        else
            return reach;
    }
    return 0;
}

/** The least time from rest over a way. */
static double least_time(const cm1e_path_element_t *element, double way)
{
    const double velocity = smaller(element->highest, element->limits.velocity);
    return larger(way / velocity, larger(sqrt(2 * way / element->limits.acceleration),
                                     isinf(element->limits.jerk) ? 0 : cbrt(6 * way / element->limits.jerk)));
}

/** Makes the curve. */
static bool try_transition(cm1e_path_t *path, cm1e_path_segment_t *before, cm1e_path_segment_t *segment, double reach)
{
    const int last = path->element_count - 1;
    cm1e_path_element_t *element = cm1e_path_element(path, last);
    const cm1e_path_element_t saved = *element;
    const double junction = blended(segment->command.blend, before->command.limits.velocity,
                                    segment->command.limits.velocity);
    element->length = larger(0, element->length - reach);
    cm1e_path_command_t command = segment->command;
    command.limits.velocity = junction;
    cm1e_path_element_t *curve = push(path, &segment->transition, 0, segment->transition.length, &command, &ALL);
    curve->last_of_tag = false;
    set_entry(path, last + 1, smaller(curve->highest, element->highest), junction);
    const double slow = curve->length / smaller(curve->highest, junction);
    const double rest = segment->piece.length - reach;
    cm1e_path_element_t *main = push(path, &segment->piece, reach, rest, &segment->command, &ALL);
    set_entry(path, last + 2, smaller(curve->highest, main->highest), junction);
    const bool worth = slow <= least_time(&saved, reach) + least_time(main, reach); /* or a stop is faster */
    for (int i = 0; worth && i < 3; i++) {
        if (cm1e_path_plan(path, last))
            return true;
        curve->joined = false;
        if (i == 1)
            main->joined = false;
    }
    pop_last(path, 2);
    /* What was known of the way stays that of this try: the next plan finds it changed. */
    element->length = saved.length;
    return false;
}

static void pass_by_transition(cm1e_path_t *path, cm1e_path_segment_t *before, cm1e_path_segment_t *segment)
{
    const cm1e_path_frame_t frame = frame_of(path);
    double reach = reach_of(path, before, segment, room_on_last(path));
    for (int i = 0; i < TRIES && reach > 0; i++) {
        if (try_transition(path, before, segment, reach))
            return;
        reach /= 2;
        cm1e_path_make_curve(&segment->transition, &frame, &before->piece, reach, &segment->piece, reach);
    }
    pass_exactly(path, before, segment);
}

void cm1e_path_join(cm1e_path_t *path, cm1e_path_segment_t *before, cm1e_path_segment_t *segment)
{
    const bool has_length = segment->piece.length > 0 && before && before->piece.length > 0;
    if (!has_length || path->cut || segment->command.junction == CM1E_PATH_STOP)
        stop_between(path, segment);
    else if (segment->command.junction == CM1E_PATH_EXACT)
        pass_exactly(path, before, segment);
    else
        pass_by_transition(path, before, segment);
}
