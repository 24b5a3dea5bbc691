/* Parameters of table 5 (3.19, 3.20). "System" values are the limits of motor and configuration. "Appl" values are the
 * smaller limits that the application sets. Commands keep the Appl values, and the ramp of an error keeps the System
 * values. */
#include "axis/axis_parameters.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>

#include "axis/axis_commands.h"
#include "axis/axis_guard.h"
#include "axis/axis_limits.h"
#include "axis/axis_setpoint.h"
#include "axis/axis_text.h"

/* Limits are doubles, in which whole counts are exact up to 2^53. */
static const double farthest_limit_counts = 9e15;

/* The rule by which a parameter is written. */
typedef enum rule { READ_ONLY = 0, LIMIT, SWITCH, LAG, APPLICATION, IN_POSITION } rule_t;

typedef struct parameter {
    const char *name;
    rule_t rule;
    size_t value;        /* offset of the value in the axis; 0: see value_of() */
    size_t system;       /* APPLICATION: offset of the maximum */
    double least_counts; /* APPLICATION: minimum, for a CM1-E */
} parameter_t;

#define AT(member) offsetof(struct cm1e_axis, member)
enum { OURS = CM1E_PARAMETER_END, ROWS = OURS + CM1E_PARAMETER_IN_POSITION_END - CM1E_PARAMETER_IN_POSITION };
#define OUR(number) [OURS + CM1E_PARAMETER_IN_POSITION##number - CM1E_PARAMETER_IN_POSITION]
static const parameter_t parameters[ROWS] = {
    [CM1E_PARAMETER_COMMANDED_POSITION] = {"CommandedPosition", READ_ONLY, 0, 0, 0},
    [CM1E_PARAMETER_SW_LIMIT_POS] = {"SWLimitPos", LIMIT, AT(limits.positive), 0, 0},
    [CM1E_PARAMETER_SW_LIMIT_NEG] = {"SWLimitNeg", LIMIT, AT(limits.negative), 0, 0},
    [CM1E_PARAMETER_ENABLE_LIMIT_POS] = {"EnableLimitPos", SWITCH, AT(limits.positive_enabled), 0, 0},
    [CM1E_PARAMETER_ENABLE_LIMIT_NEG] = {"EnableLimitNeg", SWITCH, AT(limits.negative_enabled), 0, 0},
    [CM1E_PARAMETER_ENABLE_POS_LAG_MONITORING] = {"EnablePosLagMonitoring", SWITCH, AT(limits.lag_monitoring), 0, 0},
    [CM1E_PARAMETER_MAX_POSITION_LAG] = {"MaxPositionLag", LAG, AT(limits.max_lag), 0, 0},
    [CM1E_PARAMETER_MAX_VELOCITY_SYSTEM] = {"MaxVelocitySystem", READ_ONLY, AT(limits.system.velocity), 0, 0},
    [CM1E_PARAMETER_MAX_VELOCITY_APPL] = {"MaxVelocityAppl", APPLICATION, AT(limits.maximum.velocity),
                                          AT(limits.system.velocity), CM1E_LEAST_VELOCITY_COUNTS},
    [CM1E_PARAMETER_ACTUAL_VELOCITY] = {"ActualVelocity", READ_ONLY, 0, 0, 0},
    [CM1E_PARAMETER_COMMANDED_VELOCITY] = {"CommandedVelocity", READ_ONLY, AT(setpoint.velocity), 0, 0},
    [CM1E_PARAMETER_MAX_ACCELERATION_SYSTEM] = {"MaxAccelerationSystem", READ_ONLY,
                                                AT(limits.system.acceleration), 0, 0},
    [CM1E_PARAMETER_MAX_ACCELERATION_APPL] = {"MaxAccelerationAppl", APPLICATION, AT(limits.maximum.acceleration),
                                              AT(limits.system.acceleration), CM1E_LEAST_ACCELERATION_COUNTS},
    [CM1E_PARAMETER_MAX_DECELERATION_SYSTEM] = {"MaxDecelerationSystem", READ_ONLY,
                                                AT(limits.system.deceleration), 0, 0},
    [CM1E_PARAMETER_MAX_DECELERATION_APPL] = {"MaxDecelerationAppl", APPLICATION, AT(limits.maximum.deceleration),
                                              AT(limits.system.deceleration), CM1E_LEAST_ACCELERATION_COUNTS},
    [CM1E_PARAMETER_MAX_JERK_SYSTEM] = {"MaxJerkSystem", READ_ONLY, AT(limits.system.jerk), 0, 0},
    [CM1E_PARAMETER_MAX_JERK_APPL] = {"MaxJerkAppl", APPLICATION, AT(limits.maximum.jerk), AT(limits.system.jerk),
                                      CM1E_LEAST_JERK_COUNTS},
    OUR() = {"InPosition", READ_ONLY, 0, 0, 0},
    OUR(_WINDOW) = {"InPositionWindow", LAG, AT(in_position.window), 0, 0},
    OUR(_TIME) = {"InPositionTime", IN_POSITION, AT(in_position.time_us), 0, 0},
    OUR(_TIMEOUT) = {"InPositionTimeout", IN_POSITION, AT(in_position.timeout_us), 0, 0},
    OUR(_DONE_WAITS) = {"InPositionDoneWaits", SWITCH, AT(in_position.done_waits), 0, 0},
};

/* The row of a parameter; NULL: the axis has none of this number. */
static const parameter_t *row(int number)
{
    const bool ours = number >= CM1E_PARAMETER_IN_POSITION && number < CM1E_PARAMETER_IN_POSITION_END;
    return ours ? &parameters[OURS + number - CM1E_PARAMETER_IN_POSITION]
           : number > 0 && number < CM1E_PARAMETER_END ? &parameters[number] : NULL;
}

bool cm1e_axis_parameter_is_bool(int number)
{
    return row(number) && (row(number)->rule == SWITCH || number == CM1E_PARAMETER_IN_POSITION);
}

static const void *at(const cm1e_axis_t *axis, size_t offset) { return (const char *)axis + offset; }
static double double_at(const cm1e_axis_t *axis, size_t offset) { return *(const double *)at(axis, offset); }
static bool bool_at(const cm1e_axis_t *axis, size_t offset) { return *(const bool *)at(axis, offset); }
static double seconds_at(const cm1e_axis_t *axis, size_t us) { return *(const uint32_t *)at(axis, us) * 1e-6; }

/* The value of a parameter that is not stored as such. */
static double value_of(const cm1e_axis_t *axis, int number)
{
    cm1e_axis_info_t info;
    cm1e_axis_get(axis, &info);
    switch (number) {
    case CM1E_PARAMETER_IN_POSITION: return info.in_position ? 1.0 : 0.0;
    case CM1E_PARAMETER_ACTUAL_VELOCITY: return info.actual_velocity;
    default: return info.set_position;
    }
}

cm1e_error_t cm1e_axis_read_parameter(const cm1e_axis_t *axis, int number, double *value)
{
    const parameter_t *parameter = row(number);
    *value = 0.0;
    if (!parameter)
        return CM1E_ERROR_AXIS_PARAMETER;
    if (number == CM1E_PARAMETER_ACTUAL_VELOCITY && !axis->drive.feedback.online)
        return CM1E_ERROR_AXIS_OFFLINE;
    if (parameter->rule == SWITCH)
        *value = bool_at(axis, parameter->value) ? 1.0 : 0.0;
    else if (parameter->rule == IN_POSITION)
        *value = seconds_at(axis, parameter->value);
    else
        *value = parameter->value ? double_at(axis, parameter->value) : value_of(axis, number);
    return CM1E_OK;
}

/* ---- writing ----------------------------------------------------------------------------------------------------- */

/* Changes the software limits, if they are in order and the present motion keeps them. An axis outside may come back,
 * but not go farther. */
static cm1e_error_t change_limits(cm1e_axis_t *axis, double positive, double negative, bool positive_enabled,
                                  bool negative_enabled)
{
    const bool enabled = positive_enabled || negative_enabled;
    if (enabled && axis->position.modulo_range > 0.0)
        return CM1E_ERROR_UNSUPPORTED;
    if (positive_enabled && negative_enabled && !(negative < positive))
        return CM1E_ERROR_AXIS_PARAMETER_RANGE;
    if (!cm1e_axis_limits_hold(axis, negative_enabled ? negative : -INFINITY, positive_enabled ? positive : INFINITY))
        return CM1E_ERROR_AXIS_POSITION_RANGE;
    axis->limits.positive = positive;
    axis->limits.negative = negative;
    axis->limits.positive_enabled = positive_enabled;
    axis->limits.negative_enabled = negative_enabled;
    cm1e_axis_apply_limits(axis);
    return CM1E_OK;
}

static cm1e_error_t write_limit(cm1e_axis_t *axis, int number, double value)
{
    if (!(fabs(value * axis->position.scale) <= farthest_limit_counts))
        return CM1E_ERROR_AXIS_PARAMETER_RANGE;
    const bool positive = number == CM1E_PARAMETER_SW_LIMIT_POS;
    return change_limits(axis, positive ? value : axis->limits.positive, positive ? axis->limits.negative : value,
                         axis->limits.positive_enabled, axis->limits.negative_enabled);
}

static cm1e_error_t write_switch(cm1e_axis_t *axis, int number, double value)
{
    if (value != 0.0 && value != 1.0)
        return CM1E_ERROR_AXIS_PARAMETER_RANGE;
    const bool on = value != 0.0;
    if (number == CM1E_PARAMETER_ENABLE_POS_LAG_MONITORING) {
        axis->limits.lag_monitoring = on;
        return CM1E_OK;
    }
    if (number == CM1E_PARAMETER_IN_POSITION_DONE_WAITS) {
        axis->in_position.done_waits = on;
        return CM1E_OK;
    }
    const bool positive = number == CM1E_PARAMETER_ENABLE_LIMIT_POS;
    return change_limits(axis, axis->limits.positive, axis->limits.negative,
                         positive ? on : axis->limits.positive_enabled, positive ? axis->limits.negative_enabled : on);
}

static cm1e_error_t write_number(cm1e_axis_t *axis, const parameter_t *parameter, double value, double least_counts,
                                 double largest)
{
    if (!(value * fabs(axis->position.scale) >= least_counts * (1.0 - 1e-9)) || !(value <= largest))
        return CM1E_ERROR_AXIS_PARAMETER_RANGE;
    double *present = (double *)((char *)axis + parameter->value);
    if (value < *present)
        cm1e_axis_maximum_lowered(axis);
    *present = value;
    cm1e_axis_guard_renew(axis);
    return CM1E_OK;
}

/* s; the bounds as in the bus file. The timeout must also be longer than the time. */
static void bounds_of_time(const cm1e_axis_t *axis, int number, double *least, double *largest)
{
    const in_position_t *p = &axis->in_position;
    const bool time = number == CM1E_PARAMETER_IN_POSITION_TIME;
    *least = time ? CM1E_LEAST_IN_POSITION_TIME_S : fmax(CM1E_LEAST_IN_POSITION_TIMEOUT_S, (p->time_us + 1) * 1e-6);
    *largest = time ? fmin(CM1E_LARGEST_IN_POSITION_TIME_S, (p->timeout_us - 1) * 1e-6)
                    : CM1E_LARGEST_IN_POSITION_TIMEOUT_S;
}

static cm1e_error_t write_time(cm1e_axis_t *axis, const parameter_t *parameter, int number, double value)
{
    double least, largest;
    bounds_of_time(axis, number, &least, &largest);
    if (!(value >= least && value <= largest))
        return CM1E_ERROR_AXIS_PARAMETER_RANGE;
    *(uint32_t *)((char *)axis + parameter->value) = (uint32_t)lround(value * 1e6);
    return CM1E_OK;
}

/* What a slave needs of a maximum now. In step its coupling gives way to nothing, and on its way into step to no
 * maximum that it is beyond already: with less it would be in ErrorStop in the next cycle. Other motions were
 * planned, and go on as they are. */
static double needed(const cm1e_axis_t *axis, int number)
{
    const double v = axis->setpoint.velocity, a = axis->setpoint.acceleration, rounding = 1.0 - 1e-9;
    const bool faster = a * v > 0.0;
    if (!axis_follows(axis))
        return 0.0;
    switch (number) {
    case CM1E_PARAMETER_MAX_VELOCITY_APPL: /* until the jerk has ended the acceleration */
        return rounding * (fabs(v) + (faster ? a * a / (2.0 * axis->limits.maximum.jerk) : 0.0));
    case CM1E_PARAMETER_MAX_ACCELERATION_APPL: return faster ? rounding * fabs(a) : 0.0;
    case CM1E_PARAMETER_MAX_DECELERATION_APPL: return faster ? 0.0 : rounding * fabs(a);
    default: return 0.0;
    }
}

static cm1e_error_t write(cm1e_axis_t *axis, int number, double value)
{
    const parameter_t *parameter = row(number);
    if (!parameter)
        return CM1E_ERROR_AXIS_PARAMETER;
    switch (parameter->rule) {
    case LIMIT: return write_limit(axis, number, value);
    case SWITCH: return write_switch(axis, number, value);
    case LAG:
        return write_number(axis, parameter, value, CM1E_LEAST_LAG_COUNTS,
                            CM1E_LARGEST_LAG_COUNTS / fabs(axis->position.scale));
    case APPLICATION:
        if (value < needed(axis, number))
            return CM1E_ERROR_AXIS_PARAMETER_RANGE;
        return write_number(axis, parameter, value, parameter->least_counts * axis->position.count,
                            double_at(axis, parameter->system));
    case IN_POSITION: return write_time(axis, parameter, number, value);
    case READ_ONLY: break;
    }
    return CM1E_ERROR_AXIS_PARAMETER_READ_ONLY;
}

cm1e_error_t cm1e_axis_write_parameter(cm1e_axis_t *axis, int number, double value)
{
    const cm1e_error_t error = write(axis, number, value);
    cm1e_axis_remember_not_set(axis, (not_set_t){.error = error, .number = number, .value = value});
    return error;
}

/* ---- the refusal in words ---------------------------------------------------------------------------------------- */

static void range_text(const cm1e_axis_t *axis, const parameter_t *parameter, char *text, size_t size)
{
    const double scale = fabs(axis->position.scale), value = axis->not_set.value;
    double least, largest;
    switch (parameter->rule) {
    case APPLICATION:
        least = parameter->least_counts * axis->position.count / scale;
        largest = double_at(axis, parameter->system);
        if (value >= least && value <= largest)
            snprintf(text, size, "%.6g was given, which is less than the axis needed then to follow its master. Let "
                     "its master be slower before, or end the coupling.", value);
        else
            snprintf(text, size, "%.6g was given; %.6g ... %.6g is right, which is %s.", value, least, largest,
                     (parameter - 1)->name);
        break;
    case LAG:
        snprintf(text, size, "%.6g was given; %.6g ... %.6g u is right.", value, CM1E_LEAST_LAG_COUNTS / scale,
                 CM1E_LARGEST_LAG_COUNTS / scale);
        break;
    case IN_POSITION:
        bounds_of_time(axis, axis->not_set.number, &least, &largest);
        snprintf(text, size, "%.6g was given; %.6g ... %.6g s is right.", value, least, largest);
        break;
    case SWITCH:
        if (value != 0.0 && value != 1.0)
            snprintf(text, size, "%.6g was given; 0 or 1 is right.", value);
        else
            snprintf(text, size, "%.6g was given; SWLimitNeg, %.6g u, has to be below SWLimitPos, %.6g u.",
                     value, axis->limits.negative, axis->limits.positive);
        break;
    default:
        snprintf(text, size, "%.6g was given; a finite value is right, SWLimitNeg (%.6g u) below SWLimitPos "
                 "(%.6g u).", value, axis->limits.negative, axis->limits.positive);
        break;
    }
}

void cm1e_axis_parameter_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    const not_set_t *refused = &axis->not_set;
    const char *name = axis->config->name;
    int length;
    if (!row(refused->number)) {
        snprintf(text, size, "Axis \"%s\": parameter %d: %s. Right is %s.", name, refused->number,
                 cm1e_strerror(refused->error), CM1E_PARAMETER_NUMBERS);
    } else if (refused->error == CM1E_ERROR_AXIS_PARAMETER_RANGE) {
        length = snprintf(text, size, "Axis \"%s\": parameter %d, %s: ", name, refused->number,
                          row(refused->number)->name);
        if (length > 0 && (size_t)length < size)
            range_text(axis, row(refused->number), text + length, size - (size_t)length);
    } else {
        snprintf(text, size, "Axis \"%s\": parameter %d, %s: %.6g was given: %s.", name, refused->number,
                 row(refused->number)->name, refused->value, cm1e_strerror(refused->error));
    }
}
