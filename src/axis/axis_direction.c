/* MC_Power no longer permits a direction (3.1). */
#include "axis/axis_commands.h"
#include "axis/axis_events.h"
#include "axis/axis_plan.h"
#include "axis/axis_setpoint.h"
#include "axis/axis_superimpose.h"

void cm1e_axis_direction_disabled(cm1e_axis_t *axis, double sign)
{
    const cm1e_error_t error = CM1E_ERROR_AXIS_DIRECTION_DISABLED;
    const bool halts = axis->setpoint.stands || (axis->commands.active && axis->commands.kind == CM1E_COMMAND_HALT);
    const bool on_top_goes = cm1e_axis_superimposed_goes(axis, sign);
    const bool base_goes = !halts && axis->setpoint.source->goes && axis->setpoint.source->goes(axis, sign);
    if (!axis_moves_by_command(axis) || !(base_goes || on_top_goes))
        return;
    cm1e_axis_superimposed_end(axis, on_top_goes ? CM1E_COMMAND_ERROR : CM1E_COMMAND_ABORTED,
                               on_top_goes ? error : CM1E_OK);
    const move_t move = axis->commands.move;
    if (!base_goes && axis->commands.active && cm1e_axis_replan_as(axis, &move) == CM1E_OK)
        return;
    const from_t from = from_set(axis);
    cm1e_axis_command_end(axis, CM1E_COMMAND_ERROR, error);
    cm1e_axis_go(axis, ON_BROKEN_OFF);
    if (!cm1e_axis_begin_waiting(axis, &from, 0.0)) /* the next command begins (2.2.2, case 2) */
        axis->setpoint.source->stop(axis, &axis->limits.maximum, HOME_GOAL_HOLD);
}
