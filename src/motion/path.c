#include "motion/path.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "core/extreme.h"
#include "core/rare.h"
#include "motion/path_private.h"

static const double LARGEST = 1e15;
/** Minimum as a fraction of what the axes can do. A slower command would last longer than a number can represent. */
static const double LEAST = 1e-12;

/** An arc that moves an axis by less than this part of its length, or of the position, does not move it. */
static const double STILL = 1e-12;

static bool is_limit(double value) { return value >= 0; } /* also infinite */

cm1e_error_t cm1e_path_begin(cm1e_path_t *path, const cm1e_path_config_t *config, const double *position)
{
    if (config->axes < 1 || config->axes > CM1E_PATH_AXES || config->space < 1 || config->space > CM1E_PATH_SPACE ||
        config->space > config->axes || !(config->cycle_s > 0) || !isfinite(config->cycle_s))
        return CM1E_ERROR_INVALID_ARGUMENT;
    for (int i = 0; i < config->axes; i++) {
        const cm1e_path_axis_t *axis = &config->axis[i];
        if (!(axis->velocity > 0 && axis->acceleration > 0 && axis->jerk > 0 && axis->velocity < LARGEST &&
              axis->acceleration < LARGEST && axis->lowest <= axis->highest && fabs(position[i]) < LARGEST))
            return CM1E_ERROR_INVALID_ARGUMENT;
    }
    path->config = *config;
    path->course++;
    cm1e_path_look_anew(path);
    path->override = path->next_override = 1;
    path->first_segment = path->segment_count = path->first_element = path->element_count = 0;
    path->cut = path->last_stop = path->stop_wanted = path->stopping = false;
    path->along = (cm1e_motion_state_t){0, 0, 0};
    path->begin = path->time_s = 0;
    path->slow = (cm1e_slow_time_t){0, 0};
    for (int i = 0; i < config->axes; i++)
        path->end[i] = position[i];
    return CM1E_OK;
}

void cm1e_path_copy(cm1e_path_t *copy, const cm1e_path_t *path)
{
    const size_t rings = offsetof(cm1e_path_t, segment), rest = offsetof(cm1e_path_t, cut);
    memcpy(copy, path, rings);
    for (int i = 0; i < path->segment_count; i++) {
        const int place = (path->first_segment + i) % CM1E_PATH_SEGMENTS;
        copy->segment[place] = path->segment[place];
    }
    copy->first_element = path->first_element;
    copy->element_count = path->element_count;
    for (int i = 0; i < path->element_count; i++) {
        const int place = (path->first_element + i) % CM1E_PATH_ELEMENTS;
        copy->element[place] = path->element[place];
    }
    memcpy((char *)copy + rest, (const char *)path + rest, sizeof *path - rest);
}

/** Minimum velocity of a path. */
static cm1e_motion_limits_t least_limits(const cm1e_path_t *path)
{
    cm1e_motion_limits_t least = {INFINITY, INFINITY, INFINITY, INFINITY};
    for (int i = 0; i < path->config.axes; i++) {
        const cm1e_path_axis_t *axis = &path->config.axis[i];
        least.velocity = smaller(least.velocity, LEAST * axis->velocity);
        least.acceleration = smaller(least.acceleration, LEAST * axis->acceleration);
        least.jerk = smaller(least.jerk, LEAST * (isinf(axis->jerk) ? axis->acceleration : axis->jerk));
    }
    least.deceleration = least.acceleration;
    return least;
}

/** 0: none but the axes'. */
static double limit_of(double wanted, double least) { return wanted > 0 ? larger(wanted, least) : INFINITY; }

/* ---- appending --------------------------------------------------------------------------------------------------- */

static cm1e_path_segment_t *segment_at(cm1e_path_t *path, int index)
{
    return &path->segment[(path->first_segment + index) % CM1E_PATH_SEGMENTS];
}

static cm1e_error_t refuse(cm1e_path_problem_t *problem, cm1e_path_refusal_t refusal, int axis, double position)
{
    if (problem)
        *problem = (cm1e_path_problem_t){refusal, axis, position};
    switch (refusal) {
    case CM1E_PATH_FINE: return CM1E_OK;
    case CM1E_PATH_FULL: return CM1E_ERROR_FULL;
    case CM1E_PATH_OUT_OF_BOUNDS: return CM1E_ERROR_AXIS_POSITION_RANGE;
    case CM1E_PATH_WRONG_WAY: return CM1E_ERROR_AXIS_DIRECTION_DISABLED;
    default: return CM1E_ERROR_INVALID_ARGUMENT;
    }
}

static bool are_numbers(const double *point, int count)
{
    for (int i = 0; i < count; i++)
        if (!(fabs(point[i]) < LARGEST))
            return false;
    return true;
}

/** `point`: what defines an arc beside its end; NULL for a line. */
static cm1e_path_refusal_t check(const cm1e_path_t *path, const double *point, const double *end,
                                 const cm1e_path_command_t *command)
{
    if (path->segment_count == CM1E_PATH_SEGMENTS || path->element_count > CM1E_PATH_ELEMENTS - 3)
        return CM1E_PATH_FULL;
    const cm1e_motion_limits_t *limits = &command->limits;
    if (!is_limit(limits->velocity) || !is_limit(limits->acceleration) || !is_limit(limits->deceleration) ||
        !is_limit(limits->jerk) || command->tag == 0 || !are_numbers(end, path->config.axes) ||
        (point && !are_numbers(point, path->config.space)))
        return CM1E_PATH_NO_NUMBER;
    const bool transition = command->junction == CM1E_PATH_CORNER_DISTANCE ||
                            command->junction == CM1E_PATH_CORNER_DEVIATION;
    return transition && !(command->parameter > 0) ? CM1E_PATH_NO_TRANSITION : CM1E_PATH_FINE;
}

/** Whether an axis would move in a direction in which it must not: a line goes one way, an arc beyond one of its ends
 *  both. What an arc adds by rounding is no motion. */
static bool goes_wrong_way(const cm1e_path_command_t *command, int axis, double from, double low, double high,
                           double to, double length)
{
    const double rounding = STILL * (fabs(from) + length);
    const bool beyond = smaller(from, to) - low > rounding || high - larger(from, to) > rounding;
    return ((command->not_up & 1u << axis) != 0 && (to > from || beyond)) ||
           ((command->not_down & 1u << axis) != 0 && (to < from || beyond));
}

/** The ring has a place for the next segment; its contents count only when the segment is accepted. */
static cm1e_error_t take_in(cm1e_path_t *path, const cm1e_path_command_t *command, cm1e_path_problem_t *problem)
{
    cm1e_path_segment_t *segment = segment_at(path, path->segment_count);
    const cm1e_path_frame_t frame = {path->config.axes, path->config.space};
    for (int i = 0; i < path->config.axes; i++) {
        const cm1e_path_axis_t *axis = &path->config.axis[i];
        double low, high;
        cm1e_path_extent(&segment->piece, &frame, i, &low, &high);
        if (low < smaller(axis->lowest, path->end[i]))
            return refuse(problem, CM1E_PATH_OUT_OF_BOUNDS, i, low);
        if (high > larger(axis->highest, path->end[i]))
            return refuse(problem, CM1E_PATH_OUT_OF_BOUNDS, i, high);
        if (goes_wrong_way(command, i, path->end[i], low, high, segment->piece.to[i], segment->piece.length))
            return refuse(problem, CM1E_PATH_WRONG_WAY, i, segment->piece.to[i]);
    }
    const cm1e_motion_limits_t *wanted = &command->limits, least = least_limits(path);
    segment->command = *command;
    segment->command.limits = (cm1e_motion_limits_t){
        limit_of(wanted->velocity, least.velocity), limit_of(wanted->acceleration, least.acceleration),
        limit_of(wanted->deceleration, least.deceleration), limit_of(wanted->jerk, least.jerk)};
    const bool at_rest = path->element_count == 0;
    cm1e_path_segment_t *before = at_rest ? NULL : segment_at(path, path->segment_count - 1);
    path->segment_count++;
    cm1e_path_look_anew(path);
    if (at_rest) {
        path->along = (cm1e_motion_state_t){0, 0, 0};
        path->begin = path->time_s = 0;
        path->slow.missing = 0;
    }
    cm1e_path_join(path, before, segment);
    path->cut = false;
    for (int i = 0; i < path->config.axes; i++)
        path->end[i] = segment->piece.to[i];
    return refuse(problem, CM1E_PATH_FINE, 0, 0);
}

cm1e_error_t cm1e_path_append_line(cm1e_path_t *path, const double *end, const cm1e_path_command_t *command,
                                   cm1e_path_problem_t *problem)
{
    const cm1e_path_refusal_t refusal = check(path, NULL, end, command);
    if (refusal)
        return refuse(problem, refusal, 0, 0);
    const cm1e_path_frame_t frame = {path->config.axes, path->config.space};
    cm1e_path_make_line(&segment_at(path, path->segment_count)->piece, &frame, path->end, end);
    return take_in(path, command, problem);
}

cm1e_error_t cm1e_path_append_arc_border(cm1e_path_t *path, const double *border, const double *end,
                                         const cm1e_path_command_t *command, cm1e_path_problem_t *problem)
{
    const cm1e_path_refusal_t refusal = check(path, border, end, command);
    if (refusal)
        return refuse(problem, refusal, 0, 0);
    const cm1e_path_frame_t frame = {path->config.axes, path->config.space};
    cm1e_path_segment_t *segment = segment_at(path, path->segment_count);
    if (!cm1e_path_make_border_arc(&segment->piece, &frame, path->end, border, end))
        return refuse(problem, CM1E_PATH_NO_ARC, 0, 0);
    return take_in(path, command, problem);
}

cm1e_error_t cm1e_path_append_arc_centre(cm1e_path_t *path, const double *centre, const double *end,
                                         cm1e_path_way_t way, const cm1e_path_command_t *command,
                                         cm1e_path_problem_t *problem)
{
    const cm1e_path_refusal_t refusal = check(path, centre, end, command);
    if (refusal)
        return refuse(problem, refusal, 0, 0);
    const cm1e_path_frame_t frame = {path->config.axes, path->config.space};
    cm1e_path_segment_t *segment = segment_at(path, path->segment_count);
    if (!cm1e_path_make_centre_arc(&segment->piece, &frame, path->end, centre, way, end))
        return refuse(problem, CM1E_PATH_NO_ARC, 0, 0);
    return take_in(path, command, problem);
}

void cm1e_path_end(const cm1e_path_t *path, double *position)
{
    for (int i = 0; i < path->config.axes; i++)
        position[i] = path->end[i];
}

double cm1e_path_left(const cm1e_path_t *path)
{
    double left = -cm1e_path_here(path);
    for (int i = 0; i < path->element_count; i++)
        left += path->element[(path->first_element + i) % CM1E_PATH_ELEMENTS].length;
    return larger(0, left);
}

/* ---- stopping and going on --------------------------------------------------------------------------------------- */

static bool must_stop(const cm1e_path_t *path) { return path->stop_wanted || path->override == 0; }

static bool is_at_rest(const cm1e_path_t *path)
{
    return path->element_count == 0 || (path->stopping && path->time_s >= path->profile.duration_s);
}

/** Cancels a stop, but not the last one. If no continuation can be planned any more, the stop is completed first. */
static void try_to_go_on(cm1e_path_t *path)
{
    /* At rest, the next step goes on. */
    if (!must_stop(path) && path->stopping && !path->last_stop && !is_at_rest(path))
        cm1e_path_change_pace(path);
}

/** At rest: the override that was commanded meanwhile acts. */
static void end_last_stop(cm1e_path_t *path)
{
    path->last_stop = false;
    path->override = path->next_override;
}

void cm1e_path_override(cm1e_path_t *path, double factor)
{
    if (!(factor >= 0) || factor == path->next_override)
        return;
    cm1e_path_look_anew(path);
    path->next_override = factor > 0 ? smaller(larger(factor, LEAST), LARGEST) : 0;
    if (path->last_stop)
        return;
    path->override = path->next_override;
    if (path->element_count == 0 || is_at_rest(path))
        return;
    if (factor == 0 && !path->stopping) {
        if (!path->stop_wanted) /* else the stop that was told has yet to begin */
            path->stop = cm1e_path_run(path, 0, path->element_count).limits;
        (void)cm1e_path_plan_stop(path);
    } else if (path->stopping) {
        try_to_go_on(path);
    } else {
        cm1e_path_change_pace(path);
    }
}

void cm1e_path_stop(cm1e_path_t *path, double deceleration, double jerk)
{
    if (path->element_count == 0)
        return;
    const cm1e_motion_limits_t least = least_limits(path);
    cm1e_path_look_anew(path);
    path->stop_wanted = true;
    path->stop.deceleration = limit_of(deceleration, least.deceleration);
    path->stop.jerk = limit_of(jerk, least.jerk);
    if (!is_at_rest(path))
        (void)cm1e_path_plan_stop(path);
}

/** It waits with an override of 0: not more gently than that brakes. */
static void wait_without_stop(cm1e_path_t *path)
{
    const cm1e_motion_limits_t limits = cm1e_path_run(path, 0, path->element_count).limits;
    path->stop.deceleration = larger(path->stop.deceleration, limits.deceleration);
    path->stop.jerk = larger(path->stop.jerk, limits.jerk);
    (void)cm1e_path_plan_stop(path);
}

void cm1e_path_go_on(cm1e_path_t *path)
{
    const bool waits = path->stop_wanted && path->override == 0 && !path->last_stop && !is_at_rest(path);
    cm1e_path_look_anew(path);
    path->stop_wanted = false;
    if (waits)
        wait_without_stop(path);
    try_to_go_on(path);
}

/** The path ends where it is, at rest. */
static void end_here(cm1e_path_t *path)
{
    const cm1e_path_element_t *element = cm1e_path_element(path, 0);
    cm1e_path_point_t point;
    cm1e_path_point_at(element->piece, path->config.axes, element->skipped + cm1e_path_here(path), &point);
    for (int i = 0; i < path->config.axes; i++)
        path->end[i] = point.position[i];
    path->element_count = path->segment_count = 0;
    path->stop_wanted = path->stopping = false;
    end_last_stop(path);
}

void cm1e_path_clear(cm1e_path_t *path)
{
    cm1e_path_look_anew(path);
    if (path->element_count == 0)
        return;
    if (is_at_rest(path)) {
        end_here(path);
        return;
    }
    if (!path->stop_wanted)
        cm1e_path_stop(path, 0, 0);
    cm1e_path_cut(path);
    path->cut = true;
    path->last_stop = true;
    path->stop_wanted = false;
}

void cm1e_path_pause(cm1e_path_t *path)
{
    cm1e_path_look_anew(path);
    if (path->element_count == 0)
        return;
    path->along.velocity = path->along.acceleration = 0;
    path->slow.missing = 0;
    if (path->cut) {
        end_here(path);
        return;
    }
    path->stopping = false; /* a stop that is wanted is planned in the next step */
    end_last_stop(path);
    (void)cm1e_path_plan(path, 0); /* the override may be another one since */
}

/* ---- a cycle ----------------------------------------------------------------------------------------------------- */

static void pop(cm1e_path_t *path, cm1e_path_sample_t *sample)
{
    const cm1e_path_element_t *element = cm1e_path_element(path, 0);
    path->course++;
    if (element->last_of_tag) {
        if (!element->dropped)
            sample->done_tags[sample->done++] = element->tag;
        path->first_segment = (path->first_segment + 1) % CM1E_PATH_SEGMENTS;
        path->segment_count--;
    }
    path->begin += element->length;
    path->first_element = (path->first_element + 1) % CM1E_PATH_ELEMENTS;
    path->element_count--;
}

/** Those that the profile has passed, but not the last one of a run: that ends with the profile. */
static void pop_passed(cm1e_path_t *path, cm1e_path_sample_t *sample)
{
    while (path->element_count > 1 && cm1e_path_here(path) >= cm1e_path_element(path, 0)->length) {
        const cm1e_path_element_t *next = cm1e_path_element(path, 1);
        if (!next->joined && !(path->stopping && next->passed > 0))
            break;
        pop(path, sample);
    }
}

/** The stop has ended. false: the path stays at rest. */
static bool end_stop(cm1e_path_t *path, cm1e_path_sample_t *sample)
{
    const double slack = 1e-12 * path->along.position; /* tolerance of an end */
    while (path->element_count > 0 && cm1e_path_here(path) >= cm1e_path_element(path, 0)->length - slack)
        pop(path, sample);
    path->time_s = path->profile.duration_s;
    end_last_stop(path);
    if (path->element_count > 0 && must_stop(path))
        return false;
    path->stopping = false;
    if (path->element_count > 0)
        path->along.position = larger(0, cm1e_path_here(path));
    return true;
}

/** The profile has ended, and with it the last element of the run. Of what two transitions have taken all length,
 *  nothing is left to move on: no profile could change a velocity there, not even by what rounding has added to it. */
static void end_run(cm1e_path_t *path, cm1e_path_sample_t *sample)
{
    const int count = cm1e_path_run(path, 0, path->element_count).count;
    for (int i = 0; i < count; i++)
        pop(path, sample);
    while (path->element_count > 1 && cm1e_path_element(path, 0)->length == 0 && cm1e_path_element(path, 1)->passed > 0)
        pop(path, sample);
    path->along.position = 0;
    if (path->element_count == 0 || cm1e_path_element(path, 0)->passed == 0)
        end_last_stop(path);
}

/** What comes after the end of the profile. false: nothing yet. */
static bool go_to_next(cm1e_path_t *path, cm1e_path_sample_t *sample)
{
    const double over_s = path->time_s - path->profile.duration_s;
    const bool other_pace = path->stopping || path->last_stop; /* the override may be another one since */
    path->course++;
    path->along = (cm1e_motion_state_t){path->profile.end.position, path->profile.end.velocity, 0};
    if (!path->stopping)
        end_run(path, sample);
    else if (!end_stop(path, sample))
        return false;
    path->begin = 0;
    if (path->element_count == 0) {
        path->along = (cm1e_motion_state_t){0, 0, 0};
        path->stop_wanted = path->cut = false;
        return false;
    }
    if (!cm1e_path_plan(path, other_pace ? 0 : path->element_count))
        cm1e_path_keep_going(path);
    path->time_s = over_s;
    return true;
}

/** The largest derivatives of an axis by the length of a line or an arc. An arc is round about as far as its radius. */
static void largest_derivatives(const cm1e_path_piece_t *piece, int axis, double *tangent, double *curvature,
                                double *third)
{
    const bool round = piece->kind == CM1E_PATH_ARC && axis < piece->measured;
    const double across =
        round ? larger(hypot(piece->u[0][axis], piece->v[0][axis]), hypot(piece->u[1][axis], piece->v[1][axis])) : 0;
    *tangent = across + fabs(piece->direction[axis]);
    *curvature = round ? across / piece->radius : 0;
    *third = round ? *curvature / piece->radius : 0;
}

bool cm1e_path_bounds(const cm1e_path_t *path, int axis, cm1e_motion_bounds_t *most, double *left_s)
{
    const double until_s = smaller(path->stretch.until_s, path->profile.duration_s);
    const cm1e_path_piece_t *piece = path->element[path->first_element].piece;
    if (path->element_count == 0 || path->slow.missing != 0 || !(path->time_s < until_s) ||
        piece->kind == CM1E_PATH_CURVE)
        return false;
    const cm1e_motion_bounds_t along = cm1e_profile_stretch_bounds(&path->stretch, path->time_s, until_s);
    const double v = along.velocity, a = along.acceleration;
    double tangent, curvature, third;
    largest_derivatives(piece, axis, &tangent, &curvature, &third);
    *most = (cm1e_motion_bounds_t){tangent * v, curvature * v * v + tangent * a,
                                   third * v * v * v + 3 * curvature * v * a + tangent * along.jerk};
    *left_s = until_s - path->time_s;
    return isfinite(v);
}

/* A line has no curvature: 0 is added so that a zero has the sign that it has elsewhere. The axes are computed in
 * pairs: an axis behind the last one gets zeros. */
static inline void fill_line(const cm1e_path_piece_t *line, int axes, double length, double v, double a,
                             cm1e_path_sample_t *restrict sample)
{
    double l;
    const double *origin = cm1e_path_nearer_end(line, length, &l) ? line->to : line->from;
    for (int first = 0; first < axes; first += 2)
        for (int i = first; i < first + 2; i++) {
            const double direction = line->direction[i];
            sample->position[i] = origin[i] + direction * l;
            sample->velocity[i] = direction * v;
            sample->acceleration[i] = 0.0 + direction * a;
        }
}

CM1E_APART static void fill_curved(const cm1e_path_piece_t *piece, int axes, double length, double v, double a,
                        cm1e_path_sample_t *sample)
{
    cm1e_path_point_t point;
    cm1e_path_point_at(piece, axes, length, &point);
    for (int i = 0; i < axes; i++) {
        sample->position[i] = point.position[i];
        sample->velocity[i] = point.tangent[i] * v;
        sample->acceleration[i] = point.curvature[i] * v * v + point.tangent[i] * a;
    }
}

/* The motion of all axes where the path is `here` on its first element, at this velocity and acceleration. */
static inline void fill_motion(const cm1e_path_t *path, const cm1e_path_element_t *element, double here, double v,
                               double a, cm1e_path_sample_t *sample)
{
    const int axes = path->config.axes;
    sample->path_velocity = v;
    sample->path_acceleration = a;
    if (element->piece->kind == CM1E_PATH_LINE)
        fill_line(element->piece, axes, element->skipped + here, v, a, sample);
    else
        fill_curved(element->piece, axes, element->skipped + here, v, a, sample);
}

static void fill(cm1e_path_t *path, cm1e_path_sample_t *sample)
{
    const cm1e_path_element_t *element = cm1e_path_element(path, 0);
    cm1e_motion_state_t along = path->along;
    cm1e_slow_time_apply(&path->slow, &along);
    const double here = smaller(larger(path->along.position - path->begin, 0), element->length);
    fill_motion(path, element, here, along.velocity, along.acceleration, sample);
    sample->active = element->tag;
    sample->phase = !path->stop_wanted ? CM1E_PATH_MOVING : is_at_rest(path) ? CM1E_PATH_STOPPED : CM1E_PATH_STOPPING;
}

static void fill_idle(const cm1e_path_t *path, cm1e_path_sample_t *sample)
{
    sample->path_velocity = sample->path_acceleration = 0;
    for (int i = 0; i < path->config.axes; i++) {
        sample->position[i] = path->end[i];
        sample->velocity[i] = sample->acceleration[i] = 0;
    }
    sample->active = 0;
    sample->phase = CM1E_PATH_IDLE;
}

void cm1e_path_slow(cm1e_path_t *path, double factor, cm1e_path_sample_t *sample)
{
    if (path->element_count == 0)
        return;
    cm1e_path_look_anew(path);
    cm1e_slow_time_begin(&path->slow, factor);
    for (int i = 0; i < path->config.axes; i++) {
        const cm1e_path_axis_t *axis = &path->config.axis[i];
        cm1e_slow_time_keep(&path->slow, &(cm1e_motion_limits_t){axis->velocity, axis->acceleration,
                                                                 axis->acceleration, axis->jerk});
    }
    for (int i = 0; i < path->element_count; i++) {
        const cm1e_path_element_t *element = cm1e_path_element(path, i);
        cm1e_motion_limits_t limits = element->limits;
        limits.velocity = smaller(limits.velocity, element->highest);
        cm1e_slow_time_keep(&path->slow, &limits);
    }
    fill(path, sample);
}

static void find_stretch(cm1e_path_t *path)
{
    path->course++;
    cm1e_profile_stretch_at(&path->profile, path->time_s, &path->stretch);
}

/* Called when the step is made: whether the next ones are ordinary. */
static void look_ahead(cm1e_path_t *path)
{
    cm1e_path_look_anew(path);
    if (path->element_count == 0 || must_stop(path) || path->stopping || path->slow.missing != 0)
        return;
    path->present = cm1e_path_element(path, 0);
    path->ordinary_until_s = smaller(path->stretch.until_s, path->profile.duration_s);
}

bool cm1e_path_ordinary_step(cm1e_path_t *path, cm1e_path_sample_t *sample)
{
    const double time_s = path->time_s + path->config.cycle_s;
    if (!(time_s < path->ordinary_until_s))
        return false;
    const cm1e_motion_state_t along = cm1e_profile_stretch_state(&path->stretch, time_s);
    const double here = along.position - path->begin;
    if (!(here < path->present->length))
        return false;
    path->time_s = time_s;
    path->along = along;
    sample->done = 0;
    fill_motion(path, path->present, here < 0 ? 0 : here, along.velocity, along.acceleration, sample);
    return true;
}

void cm1e_path_step(cm1e_path_t *path, cm1e_path_sample_t *sample)
{
    sample->done = 0;
    if (path->slow.missing != 0 || path->element_count == 0)
        path->course++;
    if (path->element_count > 0 && must_stop(path) && !path->stopping)
        (void)cm1e_path_plan_stop(path);
    path->time_s += cm1e_slow_time_step(&path->slow, path->config.cycle_s);
    bool moves = path->element_count > 0;
    while (moves && path->time_s >= path->profile.duration_s)
        moves = go_to_next(path, sample);
    if (moves) {
        if (path->time_s >= path->stretch.until_s)
            find_stretch(path);
        path->along = cm1e_profile_stretch_state(&path->stretch, path->time_s);
        pop_passed(path, sample);
    }
    if (path->element_count > 0)
        fill(path, sample);
    else
        fill_idle(path, sample);
    look_ahead(path);
}
