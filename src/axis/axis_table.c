/*
 * Motions along a table of positions, velocities or accelerations over time (3.14 ... 3.16). The table is copied when
 * the command is accepted. Its points become a chain of pieces that begins with the present motion of the axis. The
 * whole chain is checked against the limits before it begins. It is locked to time: no override acts on it, and there
 * is no ContinuousUpdate.
 *
 * A table of positions ends at rest. Tables of velocities and accelerations go on with their last velocity.
 */
#include <math.h>
#include <stdlib.h>

#include "axis/axis_table.h"
#include "axis/axis_commands.h"
#include "axis/axis_limits.h"
#include "axis/axis_plan.h"
#include "axis/axis_position.h"
#include "axis/axis_setpoint.h"
#include "core/extreme.h"
#include "core/rare.h"
#include "motion/pieces.h"

static const double relative_tolerance = 1e-9;

static cm1e_table_kind_t table_kind(cm1e_command_kind_t kind)
{
    return kind == CM1E_COMMAND_POSITION_PROFILE   ? CM1E_TABLE_POSITION
           : kind == CM1E_COMMAND_VELOCITY_PROFILE ? CM1E_TABLE_VELOCITY : CM1E_TABLE_ACCELERATION;
}

cm1e_error_t cm1e_axis_table_init(cm1e_axis_t *axis, cm1e_diag_t *diag)
{
    if (!axis->config->table_profiles)
        return CM1E_OK;
    axis->set_aside.tables = calloc(1, sizeof *axis->set_aside.tables);
    return axis->set_aside.tables ? CM1E_OK
                        : cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "No memory for the profiles of an axis.");
}

/* ---- the points -------------------------------------------------------------------------------------------------- */

static bool is_wrong_as_a_whole(const cm1e_axis_table_t *table, table_refusal_t *wrong)
{
    if (!table || !table->read)
        *wrong = (table_refusal_t){.fault = TABLE_MISSING};
    else if (table->count < 1 || table->count > CM1E_TABLE_POINTS_MAX)
        *wrong = (table_refusal_t){.fault = TABLE_COUNT, .given = table->count};
    else if (!isfinite(table->time_scale) || table->time_scale < 0.0)
        *wrong = (table_refusal_t){.fault = TABLE_TIME_SCALE, .given = table->time_scale};
    else if (!isfinite(table->scale))
        *wrong = (table_refusal_t){.fault = TABLE_SCALE, .given = table->scale};
    else if (!isfinite(table->offset))
        *wrong = (table_refusal_t){.fault = TABLE_OFFSET, .given = table->offset};
    else
        return false;
    return true;
}

/* A factor of 0 is an input that was not set. */
static double factor(double given) { return given == 0.0 ? 1.0 : given; }

/* Reads point `i`, which comes after those before it. */
static bool read_point(const cm1e_axis_table_t *table, int i, table_points_t *points, table_refusal_t *wrong)
{
    TIME delta_ns;
    double value;
    table->read(table->reference, i, &delta_ns, &value);
    value = value * factor(table->scale) + table->offset;
    const double before_s = i > 0 ? points->points[i - 1].time_s : 0.0;
    const double delta_s = (double)delta_ns * 1e-9 * factor(table->time_scale), time_s = before_s + delta_s;
    points->points[i] = (cm1e_table_point_t){time_s, value};
    if (!(time_s - before_s >= CM1E_TABLE_SHORTEST_S) && !(i == 0 && delta_ns == 0))
        *wrong = (table_refusal_t){TABLE_TIME, i + 1, delta_s, 0.0};
    else if (!cm1e_motion_is_number(value))
        *wrong = (table_refusal_t){TABLE_VALUE, i + 1, value, 0.0};
    else if (!cm1e_motion_is_number(time_s))
        *wrong = (table_refusal_t){.fault = TABLE_BEYOND_NUMBERS};
    else
        return true;
    return false;
}

/* `wrong` says why it is no table. */
static cm1e_error_t read_points(const cm1e_axis_table_t *table, table_points_t *points, table_refusal_t *wrong)
{
    if (is_wrong_as_a_whole(table, wrong))
        return CM1E_ERROR_AXIS_TABLE;
    points->count = table->count;
    points->absolute = table->absolute;
    for (int i = 0; i < table->count; i++)
        if (!read_point(table, i, points, wrong))
            return CM1E_ERROR_AXIS_TABLE;
    if (points->count > 1 || points->points[0].time_s > 0.0)
        return CM1E_OK;
    *wrong = (table_refusal_t){.fault = TABLE_ONLY_NOW};
    return CM1E_ERROR_AXIS_TABLE;
}

/* The offset of the table for the kernel, which counts positions from the start, and velocities and accelerations from
 * zero. */
static double shift(const cm1e_axis_t *axis, const from_t *from, cm1e_command_kind_t kind, bool absolute)
{
    if (kind == CM1E_COMMAND_POSITION_PROFILE)
        return absolute ? -cm1e_axis_units(axis, from->position) : 0.0;
    return absolute ? 0.0 : kind == CM1E_COMMAND_VELOCITY_PROFILE ? from->velocity : from->acceleration;
}

/* ---- the check --------------------------------------------------------------------------------------------------- */

/* Whether a motion along the table moves in the direction `sign` after `from_s`. The velocity has its extremes where
 * pieces meet and, inside a piece, where the acceleration is zero. Only the place of the sampling in the table is
 * changed. */
static bool goes_after(cm1e_table_profile_t *table, double from_s, double sign)
{
    const double rounding = relative_tolerance * (1.0 + fabs(table->end.velocity));
    cm1e_motion_state_t state;
    for (int i = 0; i < table->knot_count; i++) {
        const cm1e_table_knot_t *knot = &table->knots[i];
        const double a = knot[0].acceleration, b = i + 1 < table->knot_count ? knot[1].acceleration : a;
        const double turn_s = a * b < 0.0 ? knot->time_s + (knot[1].time_s - knot->time_s) * a / (a - b) : knot->time_s;
        for (int at_turn = 0; at_turn <= 1; at_turn++) {
            const double time_s = at_turn ? turn_s : knot->time_s;
            cm1e_table_profile_sample(table, time_s, &state);
            if (time_s >= from_s && state.velocity * sign > rounding)
                return true;
        }
    }
    return table->end.velocity * sign > rounding;
}

static bool goes(cm1e_axis_t *axis, double sign)
{
    const double now_s = (double)axis->setpoint.profile_cycles * axis->cycle_s + axis->setpoint.profile_offset_s;
    return cm1e_axis_profile_goes(axis, sign) || goes_after(&axis->set_aside.tables->running, now_s, sign);
}

CM1E_RARE static void find_stretch(cm1e_axis_t *axis, double time_s)
{
    cm1e_table_profile_stretch_at(&axis->set_aside.tables->running, time_s, &axis->setpoint.stretch);
}

static bool keeps(const cm1e_axis_t *axis, double lower, double upper)
{
    const tables_t *tables = axis->set_aside.tables;
    return cm1e_axis_way_keeps(axis, tables->lowest, tables->highest, lower, upper);
}

const source_t cm1e_source_table = {
    .step = cm1e_axis_timed_step,
    .slow = cm1e_axis_timed_slow,
    .stop = cm1e_axis_stop_by_ramp,
    .goes = goes,
    .keeps = keeps,
    .find_stretch = find_stretch,
    .moves = true,
    .is_composite = true,
};

static void run_table(cm1e_axis_t *axis, const from_t *from, const cm1e_table_profile_t *table,
                      const cm1e_table_extremes_t *needed, position_t target, double offset_s)
{
    tables_t *tables = axis->set_aside.tables;
    tables->running = *table;
    tables->lowest = smaller(needed->lowest, 0.0);
    tables->highest = larger(needed->highest, 0.0);
    cm1e_axis_put_duration(axis, table->duration_s, table->end);
    cm1e_axis_begin_run(axis, &cm1e_source_table, from, target, offset_s);
}

static bool above(double needed, double allowed) { return !(needed <= allowed * (1.0 + relative_tolerance)); }

static cm1e_error_t check(const cm1e_axis_t *axis, const from_t *from, cm1e_table_profile_t *table,
                          const cm1e_table_extremes_t *needed)
{
    const cm1e_motion_limits_t *most = &axis->limits.maximum;
    if (above(needed->velocity, most->velocity))
        return CM1E_ERROR_AXIS_VELOCITY_RANGE;
    if (above(needed->acceleration, most->acceleration) || above(needed->deceleration, most->deceleration) ||
        above(needed->jerk, most->jerk))
        return CM1E_ERROR_AXIS_DYNAMICS_RANGE;
    if (!cm1e_position_reaches(from->position, needed->lowest * axis->position.scale) ||
        !cm1e_position_reaches(from->position, needed->highest * axis->position.scale) ||
        !cm1e_axis_limits_contain_way(axis, from, needed->lowest, needed->highest))
        return CM1E_ERROR_AXIS_POSITION_RANGE;
    if ((!axis->power.enable_positive && goes_after(table, 0.0, 1.0)) ||
        (!axis->power.enable_negative && goes_after(table, 0.0, -1.0)))
        return CM1E_ERROR_AXIS_DIRECTION_DISABLED;
    return cm1e_axis_limits_can_stop(axis, cm1e_axis_line(axis, from->position), table->end)
               ? CM1E_OK : CM1E_ERROR_AXIS_POSITION_RANGE;
}

/* Why no motion leads along points that are right one by one. */
static table_refusal_t find_fault(const table_points_t *points, const cm1e_table_profile_t *table, double more,
                                  cm1e_command_kind_t kind)
{
    if (table->knot_count > 0 || points->points[0].time_s > 0.0 || kind == CM1E_COMMAND_ACCELERATION_PROFILE)
        return (table_refusal_t){.fault = TABLE_BEYOND_NUMBERS};
    const double present = kind == CM1E_COMMAND_POSITION_PROFILE ? 0.0 : table->start.velocity;
    return (table_refusal_t){TABLE_JUMP, 1, points->points[0].value, present - more};
}

static cm1e_error_t prepare(const cm1e_axis_t *axis, const from_t *from, cm1e_command_kind_t kind,
                            const table_points_t *points, cm1e_table_profile_t *table, cm1e_table_extremes_t *needed,
                            table_refusal_t *wrong)
{
    const cm1e_motion_state_t start = {0.0, from->velocity, from->acceleration};
    const double more = shift(axis, from, kind, points->absolute);
    cm1e_table_point_t shifted[CM1E_TABLE_POINTS_MAX];
    for (int i = 0; i < points->count; i++)
        shifted[i] = (cm1e_table_point_t){points->points[i].time_s, points->points[i].value + more};
    if (cm1e_table_profile(table, table_kind(kind), &start, shifted, points->count, axis->limits.maximum.jerk,
                           needed) == CM1E_OK)
        return check(axis, from, table, needed);
    *wrong = find_fault(points, table, more, kind);
    return CM1E_ERROR_AXIS_TABLE;
}

/* ---- the command ------------------------------------------------------------------------------------------------- */

/* The end of the motion: exactly the last position of the table, if it is a position of the axis. */
static position_t end_of(const cm1e_axis_t *axis, const from_t *from, cm1e_command_kind_t kind,
                         const table_points_t *points, const cm1e_table_profile_t *table)
{
    position_t end;
    if (kind == CM1E_COMMAND_POSITION_PROFILE && points->absolute && !(axis->position.modulo_range > 0.0) &&
        cm1e_axis_position_from_units(axis, points->points[points->count - 1].value, &end))
        return end;
    return cm1e_position_plus(from->position, table->end.position * axis->position.scale);
}

static void take(cm1e_axis_t *axis, const move_t *move, const from_t *from, const table_points_t *points,
                 const cm1e_table_profile_t *table, const cm1e_table_extremes_t *needed, double offset_s)
{
    const cm1e_command_kind_t kind = (cm1e_command_kind_t)move->kind;
    cm1e_axis_command_end(axis, CM1E_COMMAND_ABORTED, CM1E_OK);
    move_t taken = *move;
    taken.target = end_of(axis, from, kind, points, table);
    cm1e_axis_activate(axis, &taken);
    run_table(axis, from, table, needed, taken.target, offset_s);
}

cm1e_error_t cm1e_axis_table_start(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id)
{
    const from_t from = from_set(axis);
    table_points_t points;
    cm1e_table_profile_t table;
    cm1e_table_extremes_t needed;
    tables_t *tables = axis->set_aside.tables;
    cm1e_error_t error = tables ? read_points(command->table, &points, &tables->refused) : CM1E_ERROR_AXIS_NO_TABLES;
    if (error == CM1E_OK)
        error = prepare(axis, &from, command->kind, &points, &table, &needed, &tables->refused);
    if (error != CM1E_OK)
        return error;
    cm1e_axis_commands_end(axis, CM1E_COMMAND_ABORTED, CM1E_OK);
    *id = cm1e_axis_next_id(axis);
    take(axis, &(move_t){.id = *id, .kind = (uint8_t)command->kind, .origin = from.position}, &from, &points, &table,
         &needed, 0.0);
    return CM1E_OK;
}

cm1e_error_t cm1e_axis_table_buffer(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id)
{
    if (!axis->set_aside.tables)
        return CM1E_ERROR_AXIS_NO_TABLES;
    if (command->buffer_mode != mcBuffered)
        return CM1E_ERROR_AXIS_BUFFER_MODE;
    if (cm1e_axis_find_waiting(axis, axis->set_aside.tables->waiting_id))
        return CM1E_ERROR_FULL;
    table_points_t points;
    move_t move = {.kind = (uint8_t)command->kind, .buffer_mode = mcBuffered};
    cm1e_error_t error = read_points(command->table, &points, &axis->set_aside.tables->refused);
    if (error != CM1E_OK)
        return error;
    /* The number is set before it waits, because it may begin at once. */
    axis->set_aside.tables->waiting_id = axis->commands.last_id + 1 ? axis->commands.last_id + 1 : 1;
    axis->set_aside.tables->waiting = points;
    error = cm1e_axis_buffer(axis, &move);
    axis->set_aside.tables->waiting_id = *id = error != CM1E_OK ? 0 : move.id;
    return error;
}

cm1e_error_t cm1e_axis_table_begin(cm1e_axis_t *axis, move_t *move, const from_t *from, double offset_s)
{
    cm1e_table_profile_t table;
    cm1e_table_extremes_t needed;
    if (!axis->set_aside.tables || axis->set_aside.tables->waiting_id != move->id)
        return CM1E_ERROR_AXIS_STATE;
    const table_points_t *points = &axis->set_aside.tables->waiting;
    const cm1e_error_t error = prepare(axis, from, (cm1e_command_kind_t)move->kind, points, &table, &needed,
                                       &axis->set_aside.tables->refused);
    if (error == CM1E_OK)
        take(axis, move, from, points, &table, &needed, offset_s);
    return error;
}

void cm1e_axis_table_needs(const cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_axis_command_t *needs)
{
    const from_t from = from_set(axis);
    table_points_t points;
    cm1e_table_profile_t table;
    cm1e_table_extremes_t needed;
    table_refusal_t wrong;
    needs->table = NULL;
    if (read_points(command->table, &points, &wrong) != CM1E_OK ||
        prepare(axis, &from, command->kind, &points, &table, &needed, &wrong) == CM1E_ERROR_AXIS_TABLE)
        return;
    needs->velocity = needed.velocity;
    needs->acceleration = needed.acceleration;
    needs->deceleration = needed.deceleration;
    needs->jerk = needed.jerk;
    needs->position = needed.highest > -needed.lowest ? needed.highest : needed.lowest;
}
