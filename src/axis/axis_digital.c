/* Digital inputs and outputs of the motor, and the switches that are wired to them. */
#include "axis/axis_device.h"
#include "axis/axis_extras.h"
#include "axis/axis_setpoint.h"
#include "axis/axis_signals.h"
#include "axis/axis_text.h"
#include "core/clock.h"
#include "drive/drive_wiring.h"

/* ---- behind a bridge --------------------------------------------------------------------------------------------- */

/* Longer than any undisturbed request takes. */
static const int64_t input_timeout_ns = 1000 * MS_IN_NS;
/* At the end the torque stays so long until the outputs are off. */
static const int64_t output_timeout_ns = 500 * MS_IN_NS;

static bool in_process_data(const cm1e_axis_t *axis) { return cm1e_drive_signals_in_cycle(&axis->drive); }

/* Behind a bridge, signals can be read and written only in csp while the motor is enabled (BR 6.5). */
static cm1e_error_t reachable(const cm1e_axis_t *axis)
{
    if (in_process_data(axis) || axis_acts(axis))
        return CM1E_OK;
    return drive_homes(axis) ? CM1E_ERROR_AXIS_HOMING : CM1E_ERROR_AXIS_NOT_POWERED;
}

const char *cm1e_axis_signals_advice(const cm1e_axis_t *axis, cm1e_error_t error)
{
    const cm1e_drive_t *drive = &axis->drive;
    const char *const *advice = drive->kind->signals.advice;
    const char *text = error == CM1E_ERROR_AXIS_SIGNAL        ? advice[CM1E_ADVICE_SIGNAL]
                       : error == CM1E_ERROR_PDO_MAPPING      ? advice[CM1E_ADVICE_MAPPING]
                       : error == CM1E_ERROR_AXIS_NOT_POWERED ? advice[CM1E_ADVICE_POWER] : NULL;
    return text ? text : "";
}

/* ---- inputs ------------------------------------------------------------------------------------------------------ */

bool cm1e_axis_input_level(const cm1e_axis_t *axis, int number)
{
    const int wired = cm1e_drive_wired_input(&axis->drive, number);
    if (wired >= 0)
        return axis->drive.wiring->values >> wired & 1;
    return axis->drive.feedback.digital_inputs >> (number - 1) & 1;
}

/* The bits of an input on another slave; those of the motor itself are known where the motor is. */
static bool wired_bit(const cm1e_axis_t *axis, int number, uint8_t bits)
{
    const int wired = cm1e_drive_wired_input(&axis->drive, number);
    return wired < 0 || (bits >> wired & 1);
}

bool cm1e_axis_input_fresh(const cm1e_axis_t *axis, int number)
{
    return !axis->drive.wiring || wired_bit(axis, number, axis->drive.wiring->fresh);
}

bool cm1e_axis_input_away(const cm1e_axis_t *axis, int number)
{
    return axis->drive.wiring && !wired_bit(axis, number, axis->drive.wiring->known);
}

/* Checks the number of a signal. The drive has the signals in `there`; those in `mask` can be reached now. */
static cm1e_error_t check_signal(int number, int most, unsigned there, unsigned mask)
{
    if (number < 1 || number > most || !(there >> (number - 1) & 1))
        return CM1E_ERROR_AXIS_SIGNAL;
    return mask >> (number - 1) & 1 ? CM1E_OK : CM1E_ERROR_PDO_MAPPING;
}

cm1e_error_t cm1e_axis_check_input(const cm1e_axis_t *axis, int number)
{
    const cm1e_device_signals_t *signals = &axis->drive.kind->signals;
    const unsigned mask = cm1e_drive_input_mask(&axis->drive);
    if (cm1e_drive_wired_input(&axis->drive, number) >= 0)
        return CM1E_OK;
    if (cm1e_drive_is_virtual(&axis->drive))
        return number < CM1E_WIRED_FIRST ? CM1E_ERROR_AXIS_VIRTUAL : CM1E_ERROR_AXIS_SIGNAL;
    return check_signal(number, CM1E_AXIS_INPUTS, signals->by_sdo ? mask : signals->inputs, mask);
}

uint16_t cm1e_axis_encoder_slave(const cm1e_axis_t *axis)
{
    const cm1e_drive_wiring_t *wiring = axis->drive.wiring;
    return wiring && wiring->has_encoder ? wiring->encoder.position : 0;
}

bool cm1e_axis_sees_input(const cm1e_axis_t *axis, int number)
{
    if (cm1e_drive_wired_input(&axis->drive, number) >= 0)
        return true;
    return cm1e_drive_input_mask(&axis->drive) != 0 && in_process_data(axis);
}

/* Requests inputs by SDO. inputs_since_ns is when the requests without a pause began. */
static cm1e_error_t ask(cm1e_axis_t *axis)
{
    const int64_t before_ns = axis->signals.inputs_asked_ns;
    cm1e_drive_want_inputs(&axis->drive);
    axis->signals.inputs_asked_ns = axis->now_ns;
    if (axis->drive.feedback.digital_known || axis->now_ns - before_ns >= input_timeout_ns)
        axis->signals.inputs_since_ns = axis->now_ns;
    if (axis->drive.feedback.digital_known)
        return CM1E_OK;
    const cm1e_error_t error = reachable(axis);
    if (error != CM1E_OK) {
        axis->signals.inputs_since_ns = axis->now_ns;
        return error;
    }
    return axis->now_ns - axis->signals.inputs_since_ns >= input_timeout_ns ? CM1E_ERROR_TIMEOUT : CM1E_ERROR_BUSY;
}

cm1e_error_t cm1e_axis_read_input(cm1e_axis_t *axis, int number, bool *value)
{
    *value = false;
    const cm1e_error_t error = cm1e_axis_check_input(axis, number);
    if (error != CM1E_OK)
        return error;
    *value = cm1e_axis_input_level(axis, number);
    if (cm1e_drive_wired_input(&axis->drive, number) >= 0)
        return cm1e_axis_input_away(axis, number) ? CM1E_ERROR_AXIS_SIGNAL_AWAY : CM1E_OK;
    if (!axis->drive.feedback.online)
        return CM1E_ERROR_AXIS_OFFLINE;
    return in_process_data(axis) ? CM1E_OK : ask(axis);
}

static bool normally_closed(const cm1e_axis_t *axis, cm1e_axis_switch_t which)
{
    const cm1e_input_config_t *inputs = &axis->config->inputs;
    return which == CM1E_SWITCH_HOME ? inputs->home_normally_closed : inputs->limits_normally_closed;
}

int cm1e_axis_switch_input(const cm1e_axis_t *axis, cm1e_axis_switch_t which)
{
    const cm1e_input_config_t *inputs = &axis->config->inputs;
    return which == CM1E_SWITCH_LIMIT_POSITIVE   ? inputs->limit_positive
           : which == CM1E_SWITCH_LIMIT_NEGATIVE ? inputs->limit_negative : inputs->home;
}

bool cm1e_axis_has_switch(const cm1e_axis_t *axis, cm1e_axis_switch_t which)
{
    return cm1e_axis_check_input(axis, cm1e_axis_switch_input(axis, which)) == CM1E_OK;
}

bool cm1e_axis_switch_away(const cm1e_axis_t *axis, cm1e_axis_switch_t which)
{
    return cm1e_axis_has_switch(axis, which) && cm1e_axis_input_away(axis, cm1e_axis_switch_input(axis, which));
}

void cm1e_axis_want_switches(cm1e_axis_t *axis)
{
    bool any = false;
    for (int i = 0; i < CM1E_SWITCH_COUNT; i++) {
        const cm1e_axis_switch_t which = (cm1e_axis_switch_t)i;
        const bool wired = cm1e_drive_wired_input(&axis->drive, cm1e_axis_switch_input(axis, which)) >= 0;
        any = any || (!wired && cm1e_axis_has_switch(axis, which));
    }
    if (any && !in_process_data(axis))
        (void)ask(axis);
}

bool cm1e_axis_switch_active(const cm1e_axis_t *axis, cm1e_axis_switch_t which)
{
    const int number = cm1e_axis_switch_input(axis, which);
    const bool wired = cm1e_drive_wired_input(&axis->drive, number) >= 0;
    const bool known = wired || in_process_data(axis) || axis->drive.feedback.digital_known;
    if (!known || !cm1e_axis_has_switch(axis, which))
        return false;
    if (cm1e_axis_input_away(axis, number))
        return which != CM1E_SWITCH_HOME; /* a limit switch that nobody sees may be pressed */
    return cm1e_axis_input_level(axis, number) != normally_closed(axis, which);
}

/* ---- output ------------------------------------------------------------------------------------------------------ */

static cm1e_error_t check_output(const cm1e_axis_t *axis, int number)
{
    const cm1e_device_signals_t *signals = &axis->drive.kind->signals;
    const unsigned mask = cm1e_drive_output_mask(&axis->drive);
    if (cm1e_drive_wired_output(&axis->drive, number) >= 0)
        return CM1E_OK;
    if (cm1e_drive_is_virtual(&axis->drive))
        return number < CM1E_WIRED_FIRST ? CM1E_ERROR_AXIS_VIRTUAL : CM1E_ERROR_AXIS_SIGNAL;
    return check_signal(number, CM1E_AXIS_OUTPUTS, signals->by_sdo ? mask : signals->outputs, mask);
}

static cm1e_error_t set_wired_output(cm1e_axis_t *axis, int number, bool value, int64_t until_ns)
{
    const int wired = cm1e_drive_wired_output(&axis->drive, number);
    return cm1e_drive_wired_write(&axis->drive, wired, value, until_ns) ? CM1E_OK : CM1E_ERROR_AXIS_SIGNAL_AWAY;
}

static cm1e_error_t set_output(cm1e_axis_t *axis, int number, bool value, int64_t until_ns)
{
    cm1e_error_t error = check_output(axis, number);
    if (cm1e_drive_wired_output(&axis->drive, number) >= 0)
        return set_wired_output(axis, number, value, until_ns);
    if (error == CM1E_OK && !cm1e_drive_operational(&axis->drive))
        error = CM1E_ERROR_AXIS_OFFLINE;
    if (error == CM1E_OK)
        error = reachable(axis);
    if (error != CM1E_OK)
        return error;
    const uint16_t bit = (uint16_t)(1u << (number - 1));
    uint16_t *outputs = &axis->drive.command.digital_outputs;
    *outputs = (uint16_t)(value ? *outputs | bit : *outputs & ~bit);
    axis->signals.output_until_ns = until_ns;
    cm1e_axis_signals_changed(axis);
    return CM1E_OK;
}

cm1e_error_t cm1e_axis_write_output(cm1e_axis_t *axis, int number, bool value)
{
    const cm1e_error_t error = set_output(axis, number, value, INT64_MAX);
    cm1e_axis_tell_output(axis, error, number);
    return error;
}

void cm1e_axis_output_off(cm1e_axis_t *axis, int number) { (void)set_output(axis, number, false, INT64_MAX); }

void cm1e_axis_tell_output(cm1e_axis_t *axis, cm1e_error_t error, int number)
{
    cm1e_axis_remember_not_set(axis, (not_set_t){.error = error, .what = NOT_SET_OUTPUT, .number = number});
}

cm1e_command_state_t cm1e_axis_output_state(cm1e_axis_t *axis, int number, cm1e_error_t *error)
{
    *error = CM1E_OK;
    if (cm1e_drive_wired_output(&axis->drive, number) >= 0) /* sent with the frame of its cycle */
        return CM1E_COMMAND_DONE;
    switch (cm1e_drive_outputs(&axis->drive)) {
    case CM1E_DRIVE_OUTPUTS_SET:
        return CM1E_COMMAND_DONE;
    case CM1E_DRIVE_OUTPUTS_FAILED:
        *error = CM1E_ERROR_BUS_MAILBOX;
        break;
    case CM1E_DRIVE_OUTPUTS_WAITING:
        *error = reachable(axis);
        break;
    case CM1E_DRIVE_OUTPUTS_UNDER_WAY:
        break;
    }
    if (!*error)
        return CM1E_COMMAND_ACTIVE;
    cm1e_axis_remember_not_set(axis, (not_set_t){.error = *error, .what = NOT_SET_OUTPUT, .number = number});
    return CM1E_COMMAND_ERROR;
}

cm1e_error_t cm1e_axis_hold_output(cm1e_axis_t *axis, int number, bool value, int64_t keep_ns)
{
    const cm1e_error_t error = check_output(axis, number);
    const bool in_cycle = cm1e_drive_wired_output(&axis->drive, number) >= 0 || in_process_data(axis);
    if (error != CM1E_OK || !in_cycle)
        return error != CM1E_OK ? error : CM1E_ERROR_PDO_MAPPING;
    return set_output(axis, number, value, axis->now_ns + keep_ns);
}

cm1e_error_t cm1e_axis_read_output(const cm1e_axis_t *axis, int number, bool *value)
{
    const cm1e_error_t error = check_output(axis, number);
    const int wired = cm1e_drive_wired_output(&axis->drive, number);
    if (wired >= 0) {
        *value = cm1e_drive_wired_output_value(&axis->drive, wired);
        return cm1e_drive_wired_reached(&axis->drive, wired) ? CM1E_OK : CM1E_ERROR_AXIS_SIGNAL_AWAY;
    }
    *value = error == CM1E_OK && (axis->drive.command.digital_outputs >> (number - 1) & 1);
    return error;
}

/* ---- torque ------------------------------------------------------------------------------------------------------ */

cm1e_error_t cm1e_axis_read_torque(const cm1e_axis_t *axis, double *percent)
{
    *percent = axis->drive.feedback.torque * (axis->position.scale < 0.0 ? -0.1 : 0.1);
    if (cm1e_drive_is_virtual(&axis->drive))
        return CM1E_ERROR_AXIS_VIRTUAL;
    if (axis->drive.image.in_torque.bytes == 0)
        return CM1E_ERROR_PDO_MAPPING;
    return axis->drive.feedback.online ? CM1E_OK : CM1E_ERROR_AXIS_OFFLINE;
}

/* ---- off --------------------------------------------------------------------------------------------------------- */

void cm1e_axis_outputs_off(cm1e_axis_t *axis) { axis->drive.command.digital_outputs = 0; }

bool cm1e_axis_outputs_off_first(cm1e_axis_t *axis)
{
    if (in_process_data(axis))
        return true;
    if (axis->drive.command.digital_outputs != 0 || axis->signals.output_until_ns == INT64_MAX)
        axis->signals.output_until_ns = axis->now_ns + output_timeout_ns;
    axis->drive.command.digital_outputs = 0;
    return cm1e_drive_outputs(&axis->drive) == CM1E_DRIVE_OUTPUTS_SET || axis->now_ns >= axis->signals.output_until_ns;
}
