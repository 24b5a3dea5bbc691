/*
 * A table becomes a polygon of accelerations over time, which then only has to be integrated. Its corners ("knots") lie
 *   - for accelerations: at the points;
 *   - for velocities: in the middle between two points. The change of velocity from point to point is one equation for
 *     each knot. (Knots at the points would leave a swing in the acceleration that never dies out.)
 *   - for positions: at the points, that is a cubic spline, and in the middle of the first and of the last interval:
 *     the two that make room for both velocity and acceleration at both ends.
 * The equations are tridiagonal and dominated by their diagonal: solved by elimination in one pass there and one back.
 */
#include "core/extreme.h"
#include "motion/table_profile.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

#include "motion/pieces.h"

/* Of an interval: below it, numbers of up to 1e30 by its powers could leave what doubles hold. */

enum { INTERVALS_MAX = CM1E_TABLE_POINTS_MAX };

/** The points with the axis's own state as number 0. */
typedef struct {
    int intervals;
    double time[INTERVALS_MAX + 1], value[INTERVALS_MAX + 1];
} table_t;

/** below[i] x[i-1] + middle[i] x[i] + above[i] x[i+1] = right[i] */
typedef struct {
    int size;
    double below[INTERVALS_MAX], middle[INTERVALS_MAX], above[INTERVALS_MAX], right[INTERVALS_MAX];
} equations_t;

/** The solution takes the place of the right sides. */
static void solve(equations_t *equations)
{
    double *middle = equations->middle, *right = equations->right;
    for (int i = 1; i < equations->size; i++) {
        const double factor = equations->below[i] / middle[i - 1];
        middle[i] -= factor * equations->above[i - 1];
        right[i] -= factor * right[i - 1];
    }
    right[equations->size - 1] /= middle[equations->size - 1];
    for (int i = equations->size - 2; i >= 0; i--)
        right[i] = (right[i] - equations->above[i] * right[i + 1]) / middle[i];
}

static double span(const table_t *table, int i) { return table->time[i + 1] - table->time[i]; }

static double rise(const table_t *table, int i) { return table->value[i + 1] - table->value[i]; }

static void add_knot(cm1e_table_profile_t *profile, double time_s, double acceleration)
{
    profile->knots[profile->knot_count++] = (cm1e_table_knot_t){time_s, acceleration};
}

static double start_value(cm1e_table_kind_t kind, const cm1e_motion_state_t *start)
{
    return kind == CM1E_TABLE_POSITION ? start->position
           : kind == CM1E_TABLE_VELOCITY ? start->velocity
                                         : start->acceleration;
}

/** Puts the state of the axis before the points. A point at time 0 must equal that state, or replaces it
 *  (acceleration). */
static bool take_points(table_t *table, cm1e_table_kind_t kind, const cm1e_motion_state_t *start,
                        const cm1e_table_point_t *points, int count)
{
    double low = INFINITY, high = -INFINITY;
    table->intervals = 0;
    table->time[0] = 0;
    table->value[0] = start_value(kind, start);
    if (count < 1 || count > CM1E_TABLE_POINTS_MAX)
        return false;
    for (int i = 0; i < count; i++) {
        const cm1e_table_point_t *point = &points[i];
        if (!cm1e_motion_is_number(point->value) || !cm1e_motion_is_number(point->time_s))
            return false;
        low = smaller(low, point->value);
        high = larger(high, point->value);
        if (i == 0 && point->time_s == 0)
            continue;
        if (!(point->time_s - table->time[table->intervals] >= CM1E_TABLE_SHORTEST_S))
            return false;
        table->intervals++;
        table->time[table->intervals] = point->time_s;
        table->value[table->intervals] = point->value;
    }
    if (table->intervals == 0)
        return false;
    if (points[0].time_s > 0)
        return true;
    if (kind == CM1E_TABLE_ACCELERATION) {
        table->value[0] = points[0].value;
        return true;
    }
    return fabs(points[0].value - table->value[0]) <= 1e-6 * (high - low) + 1e-12 * fabs(table->value[0]);
}

static void straight(cm1e_table_profile_t *profile, const table_t *table, double jerk)
{
    if (table->value[0] != profile->start.acceleration)
        add_knot(profile, 0, profile->start.acceleration);
    for (int i = 0; i <= table->intervals; i++)
        add_knot(profile, table->time[i], table->value[i]);
    const double last = table->value[table->intervals];
    if (last != 0)
        add_knot(profile, table->time[table->intervals] + fabs(last) / jerk, 0);
}

static void through_velocities(cm1e_table_profile_t *profile, const table_t *table)
{
    const int n = table->intervals;
    equations_t equations = {.size = n};
    for (int i = 0; i < n; i++) { /* rise = h / 4 (a before + 2 x[i] + a behind), at the points by proportion */
        const double h = span(table, i);
        equations.middle[i] = 2;
        equations.right[i] = 4 * rise(table, i) / h;
        if (i == 0) {
            equations.right[i] -= profile->start.acceleration;
        } else {
            const double both = h + span(table, i - 1);
            equations.below[i] = h / both;
            equations.middle[i] += span(table, i - 1) / both;
        }
        if (i < n - 1) {
            const double both = h + span(table, i + 1);
            equations.above[i] = h / both;
            equations.middle[i] += span(table, i + 1) / both;
        }
    }
    solve(&equations);
    add_knot(profile, 0, profile->start.acceleration);
    for (int i = 0; i < n; i++)
        add_knot(profile, table->time[i] + span(table, i) / 2, equations.right[i]);
    add_knot(profile, table->time[n], 0);
}

/** One interval needs both knots, in its thirds: one equation for the velocity, one for the position. */
static void through_one_position(cm1e_table_profile_t *profile, const table_t *table)
{
    const double h = span(table, 0), third = h / 3, a = profile->start.acceleration;
    const double sum = -profile->start.velocity / third - a / 2;
    const double moment = (rise(table, 0) - profile->start.velocity * h) / (third * third) - 4 * a / 3;
    add_knot(profile, 0, a);
    add_knot(profile, third, moment - sum);
    add_knot(profile, 2 * third, 2 * sum - moment);
    add_knot(profile, h, 0);
}

static void through_positions(cm1e_table_profile_t *profile, const table_t *table)
{
    const int n = table->intervals;
    /* Half of the first and of the last interval, and what is missing there when the axis goes on as it starts. */
    const double first = span(table, 0) / 2, missing = rise(table, 0) - 2 * first * profile->start.velocity;
    const double last = span(table, n - 1) / 2, left = -rise(table, n - 1), a = profile->start.acceleration;
    equations_t equations = {.size = n - 1};
    for (int i = 0; i < n - 1; i++) { /* at point i + 1, the velocity from before and from behind is the same */
        const double before = span(table, i), behind = span(table, i + 1);
        if (i == 0) {
            equations.middle[i] = first / 3;
            equations.right[i] = -profile->start.velocity - missing / first + first * a / 3;
        } else {
            equations.below[i] = before / 6;
            equations.middle[i] = before / 3;
            equations.right[i] = -rise(table, i) / before;
        }
        if (i == n - 2) {
            equations.middle[i] += last / 3;
            equations.right[i] -= left / last;
        } else {
            equations.above[i] = behind / 6;
            equations.middle[i] += behind / 3;
            equations.right[i] += rise(table, i + 1) / behind;
        }
    }
    solve(&equations);
    add_knot(profile, 0, a);
    add_knot(profile, first, missing / (first * first) - 5 * a / 6 - equations.right[0] / 6);
    for (int i = 0; i < n - 1; i++)
        add_knot(profile, table->time[i + 1], equations.right[i]);
    add_knot(profile, table->time[n] - last, left / (last * last) - equations.right[n - 2] / 6);
    add_knot(profile, table->time[n], 0);
}

static double piece_jerk(const cm1e_table_knot_t *knot)
{
    return (knot[1].acceleration - knot[0].acceleration) / (knot[1].time_s - knot[0].time_s);
}

static cm1e_motion_state_t after(const cm1e_table_knot_t *knot, const cm1e_motion_state_t *here, double time_s)
{
    const cm1e_piece_t piece = {.jerk = piece_jerk(knot), .acceleration = knot->acceleration};
    return cm1e_piece_state(&piece, here->position, here->velocity, time_s);
}

/** The state at the next knot. */
static cm1e_motion_state_t next(const cm1e_table_knot_t *knot, const cm1e_motion_state_t *here)
{
    const double t = knot[1].time_s - knot[0].time_s, a = knot[0].acceleration, b = knot[1].acceleration;
    return (cm1e_motion_state_t){here->position + t * (here->velocity + t * (2 * a + b) / 6),
                                 here->velocity + t * (a + b) / 2, b};
}

/** Adds one state to the extremes; the acceleration increases or decreases |v|. */
static void widen(cm1e_table_extremes_t *extremes, const cm1e_motion_state_t *state, bool grows)
{
    double *limit = grows ? &extremes->acceleration : &extremes->deceleration;
    extremes->lowest = smaller(extremes->lowest, state->position);
    extremes->highest = larger(extremes->highest, state->position);
    extremes->velocity = larger(extremes->velocity, fabs(state->velocity));
    *limit = larger(*limit, fabs(state->acceleration));
}

/** A piece is divided into parts in which velocity and acceleration keep their signs; there all values are
 *  monotonic. */
static void widen_by_piece(cm1e_table_extremes_t *extremes, const cm1e_table_knot_t *knot,
                           const cm1e_motion_state_t *here)
{
    const double length = knot[1].time_s - knot[0].time_s;
    const double v = here->velocity, a = knot->acceleration;
    if (!(length > 0)) {
        if (a != knot[1].acceleration)
            extremes->jerk = INFINITY;
        return;
    }
    const double j = piece_jerk(knot), root = sqrt(larger(0, a * a - 2 * j * v)), sum = -(a + copysign(root, a));
    double times[] = {-a / j, 2 * v / sum, sum / j, length};
    extremes->jerk = larger(extremes->jerk, fabs(j));
    for (double from = 0; from < length;) {
        double to = length;
        for (int i = 0; i < 3; i++)
            if (times[i] > from && times[i] < to)
                to = times[i];
        const cm1e_motion_state_t begin = after(knot, here, from), middle = after(knot, here, (from + to) / 2);
        const cm1e_motion_state_t end = to < length ? after(knot, here, to) : next(knot, here);
        const bool grows = middle.velocity * middle.acceleration >= 0;
        widen(extremes, &begin, grows);
        widen(extremes, &end, grows);
        from = to;
    }
}

cm1e_error_t cm1e_table_profile(cm1e_table_profile_t *profile, cm1e_table_kind_t kind, const cm1e_motion_state_t *start,
                                const cm1e_table_point_t *points, int count, double jerk,
                                cm1e_table_extremes_t *extremes)
{
    table_t table;
    profile->knot_count = 0;
    profile->start = profile->here = *start;
    if (!cm1e_motion_is_number(start->position) || !cm1e_motion_is_number(start->velocity) ||
        !cm1e_motion_is_number(start->acceleration) || !(jerk > 0) || !take_points(&table, kind, start, points, count))
        return CM1E_ERROR_INVALID_ARGUMENT;
    if (kind == CM1E_TABLE_ACCELERATION)
        straight(profile, &table, jerk);
    else if (kind == CM1E_TABLE_VELOCITY)
        through_velocities(profile, &table);
    else if (table.intervals == 1)
        through_one_position(profile, &table);
    else
        through_positions(profile, &table);

    cm1e_table_extremes_t seen = {.lowest = start->position, .highest = start->position};
    cm1e_motion_state_t state = *start;
    for (int i = 0; i + 1 < profile->knot_count; i++) {
        widen_by_piece(&seen, &profile->knots[i], &state);
        state = next(&profile->knots[i], &state);
    }
    profile->at = 0;
    profile->duration_s = profile->knots[profile->knot_count - 1].time_s;
    profile->end = state;
    if (kind == CM1E_TABLE_POSITION)
        profile->end = (cm1e_motion_state_t){table.value[table.intervals], 0, 0};
    else if (kind == CM1E_TABLE_VELOCITY)
        profile->end.velocity = table.value[table.intervals];
    if (extremes)
        *extremes = seen;
    return isfinite(profile->duration_s + state.position + seen.velocity + seen.acceleration + seen.deceleration)
               ? CM1E_OK
               : CM1E_ERROR_INVALID_ARGUMENT;
}

void cm1e_table_profile_sample(cm1e_table_profile_t *profile, double time_s, cm1e_motion_state_t *state)
{
    if (!(time_s < profile->duration_s)) {
        *state = profile->end;
        state->position += profile->end.velocity * (time_s - profile->duration_s);
        return;
    }
    if (!(time_s > 0)) {
        *state = profile->start;
        return;
    }
    if (time_s < profile->knots[profile->at].time_s) {
        profile->at = 0;
        profile->here = profile->start;
    }
    while (time_s >= profile->knots[profile->at + 1].time_s) {
        profile->here = next(&profile->knots[profile->at], &profile->here);
        profile->at++;
    }
    *state = after(&profile->knots[profile->at], &profile->here, time_s - profile->knots[profile->at].time_s);
}

void cm1e_table_profile_stretch_at(cm1e_table_profile_t *profile, double time_s, cm1e_profile_stretch_t *stretch)
{
    if (!(time_s < profile->duration_s)) {
        *stretch = (cm1e_profile_stretch_t){profile->duration_s, INFINITY, profile->duration_s, profile->end, 0.0};
        return;
    }
    cm1e_motion_state_t unused;
    cm1e_table_profile_sample(profile, larger(time_s, 1e-300), &unused); /* also at 0 it finds its place */
    const cm1e_table_knot_t *knot = &profile->knots[profile->at];
    *stretch = (cm1e_profile_stretch_t){knot[0].time_s, knot[1].time_s, knot[0].time_s, profile->here,
                                        piece_jerk(knot)};
    stretch->origin.acceleration = knot[0].acceleration;
}
