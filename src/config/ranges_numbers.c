/* The numbers of an axis: units, limits, speeds and windows, each within its range. */
#include <math.h>
#include <string.h>

#include "config/ranges.h"
#include "device/place.h"
#include "device/unit.h"

/* BY_REVOLUTION: in counts, the minimum in those of a CM1-E. */
typedef enum scale { AS_IS, IN_COUNTS, BY_REVOLUTION } scale_t;

/* A number of the axis configuration; 0 is its default. If an object is named, its range in the dictionary applies. */
typedef struct number {
    const char *key;
    size_t offset;
    scale_t scale;
    const char *unit; /* of the range */
    double minimum, maximum;
    int homing;           /* a parameter of the drive's homing; NO_HOMING: none */
} number_t;
enum { NO_HOMING = -1 };

#define FIELD(member) offsetof(cm1e_axis_config_t, member)
/* Bounds without an object keep the profile computable: below them a stop would take minutes, above them an axis would
 * reach its peak speed within one cycle. */
static const number_t numbers[] = {
    {"limits.acceleration", FIELD(max_acceleration), BY_REVOLUTION, "counts/s2", CM1E_LEAST_ACCELERATION_COUNTS, 1e11,
     NO_HOMING},
    {"limits.deceleration", FIELD(max_deceleration), BY_REVOLUTION, "counts/s2", CM1E_LEAST_ACCELERATION_COUNTS, 1e11,
     NO_HOMING},
    {"limits.jerk", FIELD(max_jerk), BY_REVOLUTION, "counts/s3", CM1E_LEAST_JERK_COUNTS, 1e15, NO_HOMING},
    {"limits.position_lag", FIELD(max_position_lag), IN_COUNTS, "counts", CM1E_LEAST_LAG_COUNTS,
     CM1E_LARGEST_LAG_COUNTS, NO_HOMING},
    {"in_position.window", FIELD(in_position_window), IN_COUNTS, "counts", CM1E_LEAST_LAG_COUNTS,
     CM1E_LARGEST_LAG_COUNTS, NO_HOMING},
    {"in_position.time_s", FIELD(in_position_time_s), AS_IS, "s", CM1E_LEAST_IN_POSITION_TIME_S,
     CM1E_LARGEST_IN_POSITION_TIME_S, NO_HOMING},
    {"in_position.timeout_s", FIELD(in_position_timeout_s), AS_IS, "s", CM1E_LEAST_IN_POSITION_TIMEOUT_S,
     CM1E_LARGEST_IN_POSITION_TIMEOUT_S, NO_HOMING},
    {"backlash.gap", FIELD(backlash), IN_COUNTS, "counts", 1, 500000, NO_HOMING},
    {"homing.offset", FIELD(homing.offset), IN_COUNTS, "counts", .homing = CM1E_HOMING_OFFSET},
    {"homing.velocity", FIELD(homing.velocity), IN_COUNTS, "counts/s", .homing = CM1E_HOMING_SPEED},
    {"homing.acceleration", FIELD(homing.acceleration), IN_COUNTS, "counts/s2", .homing = CM1E_HOMING_ACCELERATION},
    {"homing.torque", FIELD(homing.torque), AS_IS, "%", .homing = CM1E_HOMING_TORQUE},
    {"homing.timeout_s", FIELD(homing.timeout_s), AS_IS, "s", 0.1, 3600, NO_HOMING},
    {"encoder_filter_s", FIELD(encoder_filter_s), AS_IS, "s", 1e-4, 10, NO_HOMING},
    {"sim.load_inertia_kgm2", FIELD(sim.load_inertia), AS_IS, "kg m2", 1e-9, 1, NO_HOMING},
    {"sim.friction_nm", FIELD(sim.friction), AS_IS, "Nm", 1e-9, 10, NO_HOMING},
    {"sim.viscous_friction_nms", FIELD(sim.viscous_friction), AS_IS, "Nm s/rad", 1e-9, 1, NO_HOMING},
    {"sim.stop_negative_counts", FIELD(sim.stop_negative), AS_IS, "counts", -1e12, -1, NO_HOMING},
    {"sim.stop_positive_counts", FIELD(sim.stop_positive), AS_IS, "counts", 1, 1e12, NO_HOMING},
    {"sim.sensor_input2_counts", FIELD(sim.sensor_input2), AS_IS, "counts", -1e12, 1e12, NO_HOMING},
    {"sim.sensor_input3_counts", FIELD(sim.sensor_input3), AS_IS, "counts", -1e12, 1e12, NO_HOMING},
};

/* The range of a parameter of the drive's homing, in counts; false: the drive has no such parameter. */
static bool homing_range(const check_t *check, int parameter, double *minimum, double *maximum)
{
    const cm1e_homing_object_t *object = &drive_of(check)->homing->objects[parameter];
    const cm1e_device_t *device = device_of(check);
    const cm1e_entry_t *entry = object->range ? object->range
                                : object->index ? device->entry(device, object->index, object->subindex) : NULL;
    if (!entry)
        return false;
    *minimum = (double)entry->minimum * object->unit;
    *maximum = (double)entry->maximum * object->unit;
    return true;
}

static bool check_range(const check_t *check, const char *key, double value, scale_t scale, double minimum,
                        double maximum, const char *unit)
{
    if (!isfinite(value))
        return axis_wrong(check, key, "is not a finite number");
    if (scale == AS_IS) {
        if (value >= minimum && value <= maximum)
            return true;
        return axis_wrong(check, key, "is %.10g; expected %.10g ... %.10g %s", value, minimum, maximum, unit);
    }
    if (scale == BY_REVOLUTION)
        minimum *= cm1e_unit_count(check->axis);
    /* Only whole counts are sent, so a fraction of a count beyond the exact bound is accepted: a rounded decimal, or
     * the rounding of doubles for a part of a revolution. */
    const double least = scale == BY_REVOLUTION ? minimum * (1.0 - 1e-9) : minimum;
    const double exact = value * check->counts_per_unit, whole = round(exact);
    const double counts = scale == BY_REVOLUTION && minimum < 1.0 && fabs(exact) < 1.0 ? exact : whole;
    if (counts >= least && counts <= maximum)
        return true;
    return axis_wrong(check, key, "is %.10g, %.10g %s; expected %.10g ... %.10g, %.10g ... %.10g %s", value, counts,
                      unit, minimum / check->counts_per_unit, maximum / check->counts_per_unit, minimum, maximum, unit);
}

static bool check_number(const check_t *check, const number_t *number)
{
    double value, minimum = number->minimum, maximum = number->maximum;
    memcpy(&value, (const char *)check->axis + number->offset, sizeof value);
    if (value == 0)
        return true;
    if (number->homing != NO_HOMING && !homing_range(check, number->homing, &minimum, &maximum))
        return axis_wrong(check, number->key, "is given, and a %s has no such parameter; expected no such key",
                          drive_of(check)->short_name);
    return check_range(check, number->key, value, number->scale, minimum, maximum, number->unit);
}

static bool check_numbers(const check_t *check)
{
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++)
        if (!check_number(check, &numbers[i]))
            return false;
    return true;
}

static bool check_gear(const check_t *check)
{
    const cm1e_axis_config_t *axis = check->axis;
    const struct {
        const char *key;
        bool given;
    } by_revolutions[] = {{"unit.gear_numerator", axis->gear_numerator != 0},
                          {"unit.gear_denominator", axis->gear_denominator != 0},
                          {"unit.units_per_revolution", axis->units_per_revolution != 0}};
    for (int i = 0; i < 3; i++)
        if (by_revolutions[i].given && axis->counts_per_unit != 0)
            return axis_wrong(check, by_revolutions[i].key, "is given, and counts_per_unit too, which already defines "
                              "the unit; expected only counts_per_unit, or gear and units_per_revolution");
    if (axis->gear_numerator > 1000000)
        return axis_wrong(check, "unit.gear_numerator", "is %u; expected 1 ... 1000000", axis->gear_numerator);
    if (axis->gear_denominator > 1000000)
        return axis_wrong(check, "unit.gear_denominator", "is %u; expected 1 ... 1000000", axis->gear_denominator);
    return axis->units_per_revolution == 0 || check_range(check, "unit.units_per_revolution",
                                                          axis->units_per_revolution, AS_IS, 1e-6, 1e9, "units");
}

bool cm1e_config_check_unit(check_t *check)
{
    const cm1e_axis_config_t *axis = check->axis;
    if (!check_gear(check))
        return false;
    check->counts_per_unit = axis->counts_per_unit != 0 ? axis->counts_per_unit : cm1e_unit_scale(axis);
    const char *key = axis->units_per_revolution != 0 ? "unit.units_per_revolution"
                      : axis->gear_numerator != 0     ? "unit.gear_numerator"
                                                      : "unit.counts_per_unit";
    if (check->counts_per_unit >= 1e-3 && check->counts_per_unit <= 1e12)
        return true;
    if (axis->counts_per_unit == 0)
        return axis_wrong(check, key, "makes a unit of %.10g counts; expected 0.001 ... 1e+12", check->counts_per_unit);
    return check_range(check, key, check->counts_per_unit, AS_IS, 1e-3, 1e12, "counts per unit");
}

static bool check_modulo(const check_t *check)
{
    const cm1e_axis_config_t *axis = check->axis;
    cm1e_fraction_t turn;
    if (axis->modulo_range == 0)
        return true;
    if (!check_range(check, "unit.modulo_range", axis->modulo_range, BY_REVOLUTION, CM1E_LEAST_MODULO_COUNTS,
                     CM1E_LARGEST_MODULO_COUNTS, "counts"))
        return false;
    if (!cm1e_unit_modulo(axis, &turn))
        return axis_wrong(check, "unit.modulo_range", "is %.17g, which with the unit of the axis is not a fraction of "
                          "counts that can be computed exactly; expected fewer digits, or gear and "
                          "units_per_revolution instead of counts_per_unit", axis->modulo_range);
    if (axis->software_limit_negative != 0 || axis->software_limit_positive != 0)
        return axis_wrong(check, "software_limits", "are given, and unit.modulo_range too: the positions of a modulo "
                          "axis repeat and have no ends; expected one of them");
    return true;
}

/* The compensation of backlash is added to every motion, so its velocity is kept free. */
static bool check_velocity(check_t *check)
{
    const cm1e_axis_config_t *axis = check->axis;
    const double peak = cm1e_unit_peak_velocity(axis);
    double kept = 0;
    if (!cm1e_axis_has_motor(axis)) {
        check->most_velocity = peak;
        return axis->max_velocity == 0 || check_range(check, "limits.velocity", axis->max_velocity, BY_REVOLUTION,
                                                      CM1E_LEAST_VELOCITY_COUNTS, CM1E_VIRTUAL_MOST_VELOCITY_COUNTS,
                                                      "counts/s");
    }
    if (axis->backlash == 0 && axis->backlash_velocity != 0)
        return axis_wrong(check, "backlash.velocity", "is given without a gap; expected backlash.gap too");
    if (axis->backlash != 0)
        kept = cm1e_unit_backlash_velocity(axis);
    if (axis->backlash_velocity != 0) {
        if (!check_range(check, "backlash.velocity", axis->backlash_velocity, BY_REVOLUTION,
                         CM1E_LEAST_VELOCITY_COUNTS, peak / 2, "counts/s"))
            return false;
        kept = axis->backlash_velocity * check->counts_per_unit;
    }
    check->most_velocity = floor(peak - kept);
    if (axis->max_velocity == 0)
        return true;
    check->most_velocity = axis->max_velocity * check->counts_per_unit;
    return check_range(check, "limits.velocity", axis->max_velocity, BY_REVOLUTION, CM1E_LEAST_VELOCITY_COUNTS,
                       floor(peak - kept), kept != 0 ? "counts/s beside the compensation of backlash" : "counts/s");
}

static bool check_software_limits(const check_t *check)
{
    const cm1e_axis_config_t *axis = check->axis;
    const double negative = axis->software_limit_negative, positive = axis->software_limit_positive;
    /* The axis keeps positions as doubles: whole counts are exact up to 2^53. Behind a bridge K37 limits the counts of
     * the motor. Infinite: no limit on this side. */
    const double most = cm1e_axis_has_motor(axis) && device_of(check)->position_limit
                            ? device_of(check)->position_limit(axis) : 9e15;
    if ((negative != -INFINITY &&
         !check_range(check, "software_limits.negative", negative, IN_COUNTS, -most, most, "counts")) ||
        (positive != INFINITY &&
         !check_range(check, "software_limits.positive", positive, IN_COUNTS, -most, most, "counts")))
        return false;
    if (negative < positive || (negative == 0 && positive == 0))
        return true;
    return axis_wrong(check, "software_limits.positive", "is %.10g, not above the negative one, %.10g", positive,
                      negative);
}

static bool check_jog(const check_t *check)
{
    const cm1e_axis_config_t *axis = check->axis;
    const double most = check->most_velocity;
    if (axis->jog_slow != 0 && !check_range(check, "jog.slow", axis->jog_slow, BY_REVOLUTION,
                                            CM1E_LEAST_VELOCITY_COUNTS, most, "counts/s"))
        return false;
    return axis->jog_fast == 0 || check_range(check, "jog.fast", axis->jog_fast, BY_REVOLUTION,
                                              CM1E_LEAST_VELOCITY_COUNTS, most, "counts/s");
}

static bool check_in_position(const check_t *check)
{
    const cm1e_axis_config_t *axis = check->axis;
    const double time_s = axis->in_position_time_s, timeout_s = axis->in_position_timeout_s;
    if (axis->max_position_lag != 0 && axis->in_position_window > axis->max_position_lag)
        return axis_wrong(check, "in_position.window", "is %.10g, and limits.position_lag %.10g, beyond which the axis "
                          "stops with an error; expected a window not above it", axis->in_position_window,
                          axis->max_position_lag);
    const double time = time_s != 0 ? time_s : CM1E_IN_POSITION_TIME_S;
    const double timeout = timeout_s != 0 ? timeout_s : CM1E_IN_POSITION_TIMEOUT_S;
    return timeout > time || axis_wrong(check, timeout_s != 0 ? "in_position.timeout_s" : "in_position.time_s",
                                        "is %.10g; expected a timeout_s, %.10g, longer than time_s, %.10g",
                                        timeout_s != 0 ? timeout_s : time_s, timeout, time);
}

bool cm1e_config_check_numbers(check_t *check)
{
    return check_velocity(check) && check_numbers(check) && check_software_limits(check) && check_modulo(check) &&
           check_jog(check) && check_in_position(check);
}
