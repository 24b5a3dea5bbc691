/* What an axis shows of itself: values, state, warnings. */
#include <math.h>

#include "axis/axis_backlash.h"
#include "axis/axis_handle.h"
#include "axis/axis_in_position.h"
#include "axis/axis_position.h"
#include "axis/axis_signals.h"
#include "config/interface.h"

/* u/s. One count a cycle is too coarse for the velocity of an encoder, so its filter gives it. */
static double actual_velocity(const cm1e_axis_t *axis)
{
    if (axis->config->wiring.encoder[0] && axis->coupling_hooks)
        return axis->coupling_hooks->observed_velocity(axis);
    return axis_actual_velocity(axis) / axis->position.scale;
}

cm1e_axis_state_t cm1e_axis_present_state(const cm1e_axis_t *axis) { return axis->state; }

void cm1e_axis_get(const cm1e_axis_t *axis, cm1e_axis_info_t *info)
{
    const cm1e_drive_feedback_t *f = &axis->drive.feedback;
    *info = (cm1e_axis_info_t){
        .state = axis->state,
        .set_velocity = axis->setpoint.velocity,
        .set_acceleration = axis->setpoint.acceleration,
        .actual_velocity = actual_velocity(axis),
        .actual_torque = f->torque * (axis->position.scale < 0.0 ? -0.1 : 0.1),
        .position_lag = cm1e_position_minus(axis->setpoint.position, axis_actual(axis)) / axis->position.scale,
        .powered = cm1e_axis_powered(axis),
        .homed = axis->position.homed,
        .in_position = cm1e_axis_in_position(axis),
        .online = f->online,
        .torque_known = axis->drive.image.in_torque.bytes > 0,
        .digital_known = f->digital_known,
        .temperature_known = axis->drive.image.in_temperature.bytes > 0,
        .dc_link_known = axis->drive.image.in_dc.bytes > 0,
        .error = axis->fault.error,
        .device_error = axis->fault.device_error,
        .digital_inputs = f->digital_inputs,
        .statusword = f->statusword,
        .mode = f->mode,
        .temperature = f->temperature,
        .dc_link_voltage = f->dc_link_decivolt * 0.1,
    };
    cm1e_axis_shown(axis, &info->set_position, &info->actual_position);
}

cm1e_error_t cm1e_axis_read(AXIS_REF_t reference, cm1e_axis_info_t *info)
{
    const cm1e_axis_t *axis = cm1e_axis_from_reference(&reference);
    if (!axis)
        return CM1E_ERROR_FB_AXIS_REF;
    if (!info)
        return CM1E_ERROR_INVALID_ARGUMENT;
    cm1e_axis_get(axis, info);
    return CM1E_OK;
}

int64_t cm1e_axis_time(const cm1e_axis_t *axis) { return axis->now_ns; }

/* Whether the error code says only that the drive is not enabled, which is no warning. */
static bool tells_only_that_it_is_off(const cm1e_drive_t *drive)
{
    const cm1e_device_error_t *error = drive->kind->error(drive->feedback.error_code);
    return drive->feedback.state != OPERATION_ENABLED && error && error->only_off;
}

cm1e_axis_condition_t cm1e_axis_condition(const cm1e_axis_t *axis)
{
    const cm1e_drive_feedback_t *f = &axis->drive.feedback;
    const char *name = cm1e_bus_configuration(axis->drive.bus)->interface_name;
    const cm1e_device_words_t *words = axis->drive.mode.words;
    const bool rests = words->rests_disabled && f->state == SWITCH_ON_DISABLED;
    return (cm1e_axis_condition_t){
        .simulation = cm1e_interface_is_simulated(name),
        .communication = f->online,
        .ready_for_power_on = axis->state == CM1E_AXIS_DISABLED && f->online && f->voltage && !f->fault &&
                              (f->state == READY_TO_SWITCH_ON || f->state == SWITCHED_ON || rests),
        .warning = !f->fault && (f->statusword & words->warning ||
                                 (f->error_code != 0 && !tells_only_that_it_is_off(&axis->drive))),
    };
}

cm1e_axis_measures_t cm1e_axis_measures(const cm1e_axis_t *axis)
{
    const cm1e_axis_config_t *config = axis->config;
    const double most = axis->limits.maximum.velocity;
    return (cm1e_axis_measures_t){
        .resolution = 1.0 / fabs(axis->position.scale),
        .modulo_range = axis->position.modulo_range,
        .max_velocity = most,
        .max_lag = axis->limits.max_lag,
        .lower = axis->position.modulo_range > 0.0 ? -INFINITY : axis->limits.lower,
        .upper = axis->position.modulo_range > 0.0 ? INFINITY : axis->limits.upper,
        .jog_slow = fmin(config->jog_slow > 0.0 ? config->jog_slow : 0.05 * most, most),
        .jog_fast = fmin(config->jog_fast > 0.0 ? config->jog_fast : 0.25 * most, most),
    };
}
