/* What is wrong with a table over time that was refused: which point, and what would be right. */
#include <stdio.h>

#include "axis/axis_table.h"

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
        snprintf(text, size, "point %d of the table comes %g s after %s; %g s or more is right%s", wrong->point,
                 wrong->given, wrong->point == 1 ? "the start" : "the one before", CM1E_TABLE_SHORTEST_S,
                 wrong->point == 1 ? ", or 0" : "");
        break;
    case TABLE_VALUE:
        snprintf(text, size, "the %s of point %d of the table is %g; a number between -1e30 and 1e30 is right",
                 quantity, wrong->point, wrong->given);
        break;
    case TABLE_ONLY_NOW:
        snprintf(text, size, "the only point of the table is at time 0; a time above 0 is right");
        break;
    case TABLE_JUMP:
        snprintf(text, size, "the table begins with a jump: its first point, at time 0, has the %s %g, and the axis "
                 "has %g. Give that one, or a time above 0", quantity, wrong->given, wrong->right);
        break;
    case TABLE_BEYOND_NUMBERS:
        snprintf(text, size, "the numbers of the table are so large that nothing can be computed with them");
        break;
    }
}

void cm1e_axis_table_refused_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    static const char *const quantities[] = {"position", "velocity", "acceleration"};
    const cm1e_command_kind_t kind = axis->commands.refused.kind;
    char what[240];
    sentence(&axis->set_aside.tables->refused,
             quantities[(kind == CM1E_COMMAND_VELOCITY_PROFILE) + 2 * (kind == CM1E_COMMAND_ACCELERATION_PROFILE)],
             what, sizeof what);
    snprintf(text, size, "Axis \"%s\": %s.", axis->config->name, what);
}
