/* Digital inputs and the output of the motor, the switches among them, and what goes off when it is not renewed. */
#include <math.h>
#include <string.h>

#include "axis/axis_private.h"
#include "axis/axis_signals.h"

int64_t cm1e_axis_time(const cm1e_axis_t *axis) { return axis->now_ns; }

/* ---- inputs ------------------------------------------------------------------------------------------------------ */

static bool input_bit(const cm1e_axis_t *axis, int number)
{
    return axis->drive.feedback.digital_inputs >> (number - 1) & 1;
}

cm1e_error_t cm1e_axis_read_input(const cm1e_axis_t *axis, int number, bool *value)
{
    *value = false;
    if (number < 1 || number > CM1E_AXIS_INPUTS)
        return CM1E_ERROR_AXIS_SIGNAL;
    if (axis->drive.in_digital.bytes == 0)
        return CM1E_ERROR_PDO_MAPPING;
    *value = input_bit(axis, number);
    return axis->drive.feedback.online ? CM1E_OK : CM1E_ERROR_AXIS_OFFLINE;
}

static int input_of(const cm1e_axis_t *axis, cm1e_axis_switch_t which, bool *normally_closed)
{
    const cm1e_input_config_t *inputs = &axis->config->inputs;
    *normally_closed = which == CM1E_SWITCH_HOME ? inputs->home_normally_closed : inputs->limits_normally_closed;
    return which == CM1E_SWITCH_LIMIT_POSITIVE   ? inputs->limit_positive
           : which == CM1E_SWITCH_LIMIT_NEGATIVE ? inputs->limit_negative : inputs->home;
}

bool cm1e_axis_has_switch(const cm1e_axis_t *axis, cm1e_axis_switch_t which)
{
    bool normally_closed;
    const int number = input_of(axis, which, &normally_closed);
    return number >= 1 && number <= CM1E_AXIS_INPUTS && axis->drive.in_digital.bytes > 0;
}

bool cm1e_axis_switch_active(const cm1e_axis_t *axis, cm1e_axis_switch_t which)
{
    bool normally_closed;
    const int number = input_of(axis, which, &normally_closed);
    return cm1e_axis_has_switch(axis, which) && input_bit(axis, number) != normally_closed;
}

/* ---- output ------------------------------------------------------------------------------------------------------ */

static cm1e_error_t check_output(const cm1e_axis_t *axis, int number)
{
    if (number < 1 || number > CM1E_AXIS_OUTPUTS)
        return CM1E_ERROR_AXIS_SIGNAL;
    return axis->drive.out_digital.bytes == 0 ? CM1E_ERROR_PDO_MAPPING : CM1E_OK;
}

static cm1e_error_t set_output(cm1e_axis_t *axis, int number, bool value, int64_t until_ns)
{
    const cm1e_error_t error = check_output(axis, number);
    if (error)
        return error;
    if (!cm1e_drive_operational(&axis->drive))
        return CM1E_ERROR_AXIS_OFFLINE;
    const uint16_t bit = (uint16_t)(1u << (number - 1));
    uint16_t *outputs = &axis->drive.command.digital_outputs;
    *outputs = (uint16_t)(value ? *outputs | bit : *outputs & ~bit);
    axis->output_until_ns = until_ns;
    return CM1E_OK;
}

cm1e_error_t cm1e_axis_write_output(cm1e_axis_t *axis, int number, bool value)
{
    return set_output(axis, number, value, INT64_MAX);
}

cm1e_error_t cm1e_axis_hold_output(cm1e_axis_t *axis, int number, bool value, int64_t keep_ns)
{
    return set_output(axis, number, value, axis->now_ns + keep_ns);
}

cm1e_error_t cm1e_axis_read_output(const cm1e_axis_t *axis, int number, bool *value)
{
    const cm1e_error_t error = check_output(axis, number);
    *value = !error && (axis->drive.command.digital_outputs >> (number - 1) & 1);
    return error;
}

/* ---- condition --------------------------------------------------------------------------------------------------- */

/* UG 7.3.1: what a drive says that is just not enabled, and otherwise would be worth a look. */
static bool tells_only_that_it_is_off(const cm1e_drive_feedback_t *f)
{
    const uint16_t code = f->error_code;
    return f->state != OPERATION_ENABLED && (code == 0x4502 || code == 0x8611 || code == 0xFF01);
}

cm1e_axis_condition_t cm1e_axis_condition(const cm1e_axis_t *axis)
{
    const cm1e_drive_feedback_t *f = &axis->drive.feedback;
    const char *name = cm1e_bus_configuration(axis->drive.bus)->interface_name;
    return (cm1e_axis_condition_t){
        .simulation = name[0] == '\0' || strcmp(name, "sim") == 0 || strncmp(name, "sim:", 4) == 0,
        .communication = f->online,
        .ready_for_power_on = axis->state == CM1E_AXIS_DISABLED && f->online && f->voltage && !f->fault &&
                              (f->state == READY_TO_SWITCH_ON || f->state == SWITCHED_ON),
        .warning = !f->fault && (f->statusword & STATUSWORD_WARNING ||
                                 (f->error_code != 0 && !tells_only_that_it_is_off(f))),
    };
}

cm1e_axis_measures_t cm1e_axis_measures(const cm1e_axis_t *axis)
{
    const cm1e_axis_config_t *config = axis->config;
    const double most = axis->maximum.velocity;
    return (cm1e_axis_measures_t){
        .resolution = 1.0 / fabs(axis->scale),
        .modulo_range = axis->modulo_range,
        .max_velocity = most,
        .lower = axis->modulo_range > 0.0 ? -INFINITY : axis->lower,
        .upper = axis->modulo_range > 0.0 ? INFINITY : axis->upper,
        .jog_slow = fmin(config->jog_slow > 0.0 ? config->jog_slow : 0.05 * most, most),
        .jog_fast = fmin(config->jog_fast > 0.0 ? config->jog_fast : 0.25 * most, most),
    };
}

/* ---- what has to be renewed -------------------------------------------------------------------------------------- */

void cm1e_axis_keep(cm1e_axis_t *axis, cm1e_command_id_t id, int64_t keep_ns, double deceleration, double jerk)
{
    axis->kept = id;
    axis->kept_until_ns = axis->now_ns + keep_ns;
    axis->kept_deceleration = deceleration;
    axis->kept_jerk = jerk;
}

void cm1e_axis_signals_step(cm1e_axis_t *axis)
{
    /* A slave that left Operational may have been without power: nothing comes on again by itself when it is back. */
    if (!cm1e_drive_operational(&axis->drive) || axis->now_ns >= axis->output_until_ns)
        axis->drive.command.digital_outputs = 0;
    if (axis->kept == 0 || axis->now_ns < axis->kept_until_ns)
        return;
    cm1e_command_id_t halt;
    const bool moves = axis->kept == axis->active;
    axis->kept = 0;
    if (!moves)
        return;
    /* Values that a person typed in and that the axis refuses are no reason to go on. */
    const cm1e_axis_command_t kept = {.kind = CM1E_COMMAND_HALT, .deceleration = axis->kept_deceleration,
                                      .jerk = axis->kept_jerk};
    if (cm1e_axis_start(axis, &kept, &halt))
        cm1e_axis_start(axis, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_HALT}, &halt);
}

void cm1e_axis_outputs_off(cm1e_axis_t *axis) { axis->drive.command.digital_outputs = 0; }
