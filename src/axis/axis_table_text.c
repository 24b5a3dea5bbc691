/* What is wrong with a table over time that was refused: which point, and what would be right. */
#include <math.h>
#include <stdio.h>

#include "axis/axis_plan.h"
#include "axis/axis_position.h"
#include "axis/axis_setpoint.h"
#include "axis/axis_table.h"

static double factor(double given) { return given == 0.0 ? 1.0 : given; }

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

static double read_point(const cm1e_axis_table_t *table, int index, double *delta_s)
{
    TIME delta_ns;
    double value;
    table->read(table->reference, index, &delta_ns, &value);
    *delta_s = (double)delta_ns * 1e-9 * factor(table->time_scale);
    return value * factor(table->scale) + table->offset;
}

static bool has_wrong_point(const cm1e_axis_table_t *table, table_refusal_t *wrong)
{
    for (int i = 0; i < table->count; i++) {
        double delta_s;
        const double value = read_point(table, i, &delta_s);
        if (delta_s < 0.0 || (delta_s == 0.0 && i > 0)) {
            *wrong = (table_refusal_t){TABLE_TIME, i + 1, delta_s, 0.0};
            return true;
        }
        if (!isfinite(value)) {
            *wrong = (table_refusal_t){TABLE_VALUE, i + 1, value, 0.0};
            return true;
        }
    }
    return false;
}

/* What the axis has, as the table counts it. */
static double present(const cm1e_axis_t *axis, cm1e_command_kind_t kind, bool absolute)
{
    const from_t from = from_set(axis);
    if (kind == CM1E_COMMAND_POSITION_PROFILE)
        return absolute ? cm1e_axis_units(axis, from.position) : 0.0;
    return absolute ? from.velocity : 0.0;
}

static void find_begin(const cm1e_axis_t *axis, const cm1e_axis_command_t *command, table_refusal_t *wrong)
{
    const cm1e_axis_table_t *table = command->table;
    double delta_s;
    const double value = read_point(table, 0, &delta_s);
    if (delta_s > 0.0)
        *wrong = (table_refusal_t){.fault = TABLE_BEYOND_NUMBERS};
    else if (table->count == 1)
        *wrong = (table_refusal_t){.fault = TABLE_ONLY_NOW, .point = 1};
    else
        *wrong = (table_refusal_t){TABLE_JUMP, 1, value, present(axis, command->kind, table->absolute)};
}

void cm1e_axis_table_note(cm1e_axis_t *axis, const cm1e_axis_command_t *command)
{
    if (!axis->set_aside.tables || axis->commands.refusal != CM1E_ERROR_AXIS_TABLE)
        return;
    table_refusal_t *wrong = &axis->set_aside.tables->refused;
    if (!is_wrong_as_a_whole(command->table, wrong) && !has_wrong_point(command->table, wrong))
        find_begin(axis, command, wrong);
}

static void sentence(const table_refusal_t *wrong, const char *quantity, char *text, size_t size)
{
    switch (wrong->fault) {
    case TABLE_MISSING:
        snprintf(text, size, "no table was given");
        break;
    case TABLE_COUNT:
        snprintf(text, size, "the table has %.0f points; 1 ... %d are right", wrong->given, CM1E_TABLE_POINTS_MAX);
        break;
    case TABLE_TIME_SCALE:
        snprintf(text, size, "TimeScale is %g; above 0 is right, or 0, which acts as 1", wrong->given);
        break;
    case TABLE_SCALE:
        snprintf(text, size, "the factor of all values is %g; a finite number is right", wrong->given);
        break;
    case TABLE_OFFSET:
        snprintf(text, size, "Offset is %g; a finite number is right", wrong->given);
        break;
    case TABLE_TIME:
        snprintf(text, size, "point %d of the table comes %g s after the one before; above 0 is right%s", wrong->point,
                 wrong->given, wrong->point == 1 ? ", or 0" : "");
        break;
    case TABLE_VALUE:
        snprintf(text, size, "the %s of point %d of the table is %g; a finite number is right", quantity, wrong->point,
                 wrong->given);
        break;
    case TABLE_ONLY_NOW:
        snprintf(text, size, "the only point of the table is at time 0; a time above 0 is right");
        break;
    case TABLE_JUMP:
        snprintf(text, size, "the table begins with a jump: its first point, at time 0, has the %s %g, and the axis has "
                 "%g. Give that one, or a time above 0", quantity, wrong->given, wrong->right);
        break;
    case TABLE_BEYOND_NUMBERS:
        snprintf(text, size, "the values of the table are so large, or its times so short, that nothing can be computed "
                 "with them");
        break;
    }
}

void cm1e_axis_table_refused_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    static const char *const quantities[] = {"position", "velocity", "acceleration"};
    const cm1e_command_kind_t kind = axis->commands.refused.kind;
    char what[240];
    sentence(&axis->set_aside.tables->refused,
             quantities[(kind == CM1E_COMMAND_VELOCITY_PROFILE) + 2 * (kind == CM1E_COMMAND_ACCELERATION_PROFILE)], what,
             sizeof what);
    snprintf(text, size, "Axis \"%s\": %s.", axis->config->name, what);
}
