#include "axis/axis_guest.h"

#include <math.h>

#include "axis/axis_extras.h"
#include "axis/axis_signals.h"

cm1e_guest_refusal_t cm1e_axis_guest_may(const cm1e_axis_t *axis, cm1e_command_id_t own)
{
    const bool owned = own != 0 && axis->commands.active == own;
    const bool rests = axis->state == CM1E_AXIS_DISABLED || axis->state == CM1E_AXIS_STANDSTILL ||
                       axis->state == CM1E_AXIS_ERROR_STOP;
    if (axis->config->type == CM1E_AXIS_ENCODER)
        return CM1E_GUEST_NO_MOTOR;
    if (!owned && (axis->commands.active != 0 || !rests))
        return CM1E_GUEST_COMMANDED;
    if (axis->commands.waiting.count > 0 || axis_awaits(axis) || axis->superimposed.id)
        return CM1E_GUEST_COMMANDED;
    if (axis->belongs.group || axis->leader)
        return CM1E_GUEST_GROUPED;
    if (axis->coupling_hooks && axis->coupling_hooks->is_followed(axis))
        return CM1E_GUEST_FOLLOWED;
    return CM1E_GUEST_MAY;
}

cm1e_error_t cm1e_axis_guest_jog(cm1e_axis_t *axis, double velocity, double acceleration, cm1e_command_id_t *id)
{
    const cm1e_axis_measures_t measures = cm1e_axis_measures(axis);
    const double limit = velocity < 0.0 ? measures.lower : measures.upper;
    cm1e_axis_info_t info;
    cm1e_axis_get(axis, &info);
    cm1e_axis_command_t command = {.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = fabs(velocity),
                                   .acceleration = acceleration, .deceleration = acceleration,
                                   .direction = velocity < 0.0 ? mcNegativeDirection : mcPositiveDirection};
    *id = 0;
    if (isfinite(limit)) {
        if ((limit - info.set_position) * copysign(1.0, velocity) <= measures.resolution)
            return CM1E_ERROR_AXIS_POSITION_RANGE;
        command = (cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = limit,
                                        .velocity = fabs(velocity), .acceleration = acceleration,
                                        .deceleration = acceleration};
    }
    return cm1e_axis_start(axis, &command, id);
}

cm1e_error_t cm1e_axis_guest_home(cm1e_axis_t *axis, cm1e_command_id_t *id)
{
    return cm1e_axis_start(axis, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_HOME}, id);
}

bool cm1e_axis_guest_runs(const cm1e_axis_t *axis, cm1e_command_id_t id)
{
    return id != 0 && axis->commands.active == id;
}

/* In Homing only MC_Stop is taken. Nobody holds it, so that it ends by itself. */
void cm1e_axis_guest_end(cm1e_axis_t *axis, double deceleration, cm1e_command_id_t *id)
{
    const cm1e_command_kind_t kind = axis->state == CM1E_AXIS_HOMING ? CM1E_COMMAND_STOP : CM1E_COMMAND_HALT;
    const cm1e_axis_command_t end = {.kind = kind, .deceleration = deceleration};
    if (!cm1e_axis_guest_runs(axis, *id)) {
        *id = 0;
        return;
    }
    /* A deceleration that the axis refuses is no reason to go on. */
    if (cm1e_axis_start(axis, &end, id) != CM1E_OK &&
        cm1e_axis_start(axis, &(cm1e_axis_command_t){.kind = kind}, id) != CM1E_OK)
        cm1e_axis_start(axis, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_STOP}, id);
    cm1e_axis_hold_stop(axis, *id, false);
}

void cm1e_axis_guest_reset(cm1e_axis_t *axis) { cm1e_axis_reset(axis); }
