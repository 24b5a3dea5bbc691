/* MC_SetPosition (3.17): the coordinates shift, and nothing moves. */
#include <math.h>

#include "axis/axis_backlash.h"
#include "axis/axis_commands.h"
#include "axis/axis_lead.h"
#include "axis/axis_limits.h"
#include "axis/axis_position.h"
#include "axis/axis_setpoint.h"
#include "axis/axis_text.h"

static cm1e_error_t set_position(cm1e_axis_t *axis, double position, bool relative)
{
    if (axis_led(axis))
        return CM1E_ERROR_AXIS_IN_GROUP;
    if (axis->state == CM1E_AXIS_HOMING || drive_homes(axis))
        return CM1E_ERROR_AXIS_HOMING;
    if (!axis->position.known || !axis->drive.feedback.online)
        return CM1E_ERROR_AXIS_OFFLINE;
    const position_t actual = axis_actual(axis);
    const double now = cm1e_axis_units(axis, actual);
    double value;
    if (!cm1e_axis_new_position(axis, now, position, relative, &value))
        return CM1E_ERROR_AXIS_POSITION_RANGE;
    /* The software limits as written. The limits of the motor's counts do not shift. */
    const double lower = axis->limits.negative_enabled ? axis->limits.negative : -INFINITY;
    const double upper = axis->limits.positive_enabled ? axis->limits.positive : INFINITY;
    const bool limited = axis->limits.negative_enabled || axis->limits.positive_enabled;
    if (limited && drive_moves(axis))
        return CM1E_ERROR_AXIS_STATE; /* only the end of a motion by the drive is known */
    const double shift = value - now;
    if (limited) {
        const double set = cm1e_axis_units(axis, axis->setpoint.position) + shift;
        if (!(set >= lower && set <= upper) || !cm1e_axis_limits_hold(axis, lower - shift, upper - shift) ||
            !cm1e_axis_waiting_hold(axis, lower - shift, upper - shift))
            return CM1E_ERROR_AXIS_POSITION_RANGE;
    }
    const position_t origin = axis->position.origin;
    const double origin_units = axis->position.origin_units;
    cm1e_axis_set_origin(axis, actual, value);
    if (cm1e_axis_shift_waiting(axis, shift))
        return CM1E_OK;
    cm1e_axis_set_origin(axis, origin, origin_units); /* of a linear axis: no other has software limits */
    return CM1E_ERROR_AXIS_POSITION_RANGE;
}

cm1e_error_t cm1e_axis_set_position(cm1e_axis_t *axis, double position, bool relative)
{
    const cm1e_error_t error = set_position(axis, position, relative);
    cm1e_axis_remember_not_set(axis, (not_set_t){.error = error, .what = NOT_SET_POSITION, .value = position,
                                                 .number = relative});
    return error;
}
