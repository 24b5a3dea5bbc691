#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "config/ranges.h"
#include "config/interface.h"
#include "device/devices.h"
#include "device/place.h"
#include "device/unit.h"

static const int64_t longest_silence_ns = 50000000;

__attribute__((format(printf, 3, 4)))
static bool bus_wrong(const check_t *check, const char *key, const char *format, ...)
{
    snprintf(check->problem->path, sizeof check->problem->path, "bus.%s", key);
    int length = snprintf(check->problem->text, sizeof check->problem->text, "%s ", key);
    va_list args;
    va_start(args, format);
    vsnprintf(check->problem->text + length, sizeof check->problem->text - (size_t)length, format, args);
    va_end(args);
    return false;
}

bool cm1e_config_axis_wrong(const check_t *check, const char *key, const char *format, ...)
{
    snprintf(check->problem->path, sizeof check->problem->path, "axes[%u].%s", check->index, key);
    int length = snprintf(check->problem->text, sizeof check->problem->text, "axis %s: %s ", check->name, key);
    va_list args;
    va_start(args, format);
    vsnprintf(check->problem->text + length, sizeof check->problem->text - (size_t)length, format, args);
    va_end(args);
    return false;
}

/* Whether a text ends within its array and has no control characters. */
static bool is_text(const char *text, size_t size)
{
    const char *end = memchr(text, '\0', size);
    if (!end)
        return false;
    for (const char *p = text; p < end; p++)
        if ((unsigned char)*p < 0x20 || *p == 0x7F)
            return false;
    return true;
}
#define IS_TEXT(array) is_text(array, sizeof(array))
#define NO_TEXT "is not a text of less than %zu bytes without control characters"

/* ---- the bus ----------------------------------------------------------------------------------------------------- */

static bool check_cycle_time(const check_t *check)
{
    const int64_t cycle_time_ns = check->config->cycle_time_ns;
    bool accepted = cycle_time_ns == 0;
    for (size_t i = 0; i < sizeof cm1e_device_cycle_times_ns / sizeof cm1e_device_cycle_times_ns[0]; i++)
        accepted = accepted || cycle_time_ns == cm1e_device_cycle_times_ns[i];
    if (!accepted)
        return bus_wrong(check, "cycle_time_us", "is %g; expected 200, 250, 500 or 1000, which the CM1-E accepts",
                         (double)cycle_time_ns / 1000);
    const int64_t cycle = cycle_time_ns ? cycle_time_ns : 1000000;
    if (check->config->frame_timeout_ns < 0 || check->config->frame_timeout_ns > cycle)
        return bus_wrong(check, "frame_timeout_us", "is %g; expected at most the cycle time, %g",
                         (double)check->config->frame_timeout_ns / 1000, (double)cycle / 1000);
    if (check->config->lost_cycles_limit * cycle > longest_silence_ns)
        return bus_wrong(check, "lost_cycles_limit", "is %u; expected 1 ... %u with a cycle of %g us: a lost bus must "
                         "be noticed within %g ms, before the watchdog of a motor (100 ms) acts",
                         check->config->lost_cycles_limit, (unsigned)(longest_silence_ns / cycle), (double)cycle / 1000,
                         (double)longest_silence_ns * 1e-6);
    return true;
}

static bool check_bus(const check_t *check)
{
    const cm1e_bus_config_t *config = check->config;
    if (!IS_TEXT(config->interface_name))
        return bus_wrong(check, "interface", NO_TEXT, sizeof config->interface_name);
    if (!IS_TEXT(config->second_interface))
        return bus_wrong(check, "second_interface", NO_TEXT, sizeof config->second_interface);
    if (!IS_TEXT(config->pcap_file))
        return bus_wrong(check, "pcap_file", NO_TEXT, sizeof config->pcap_file);
    if (config->second_interface[0] && strcmp(config->second_interface, config->interface_name) == 0)
        return bus_wrong(check, "second_interface", "is %s like the first; expected the other end of the ring",
                         config->second_interface);
    if (config->virtual_time && !cm1e_interface_is_simulated(config->interface_name))
        return bus_wrong(check, "virtual_time", "is on with the interface %s; expected only with interface sim",
                         config->interface_name);
    if (config->sim_pdo_order != CM1E_PDO_ORDER_UG_4_4 && config->sim_pdo_order != CM1E_PDO_ORDER_UG_7_2)
        return bus_wrong(check, "sim_pdo_order", "is %d; expected one of the enumeration", (int)config->sim_pdo_order);
    if ((unsigned)config->sim_gaps > CM1E_SIM_IO_COUPLER)
        return bus_wrong(check, "sim_gaps", "is %d; expected one of the enumeration", (int)config->sim_gaps);
    return check_cycle_time(check);
}

/* ---- numbers of an axis ------------------------------------------------------------------------------------------ */

/* BY_REVOLUTION: in counts, the minimum in those of a CM1-E. */
typedef enum scale { AS_IS, IN_COUNTS, BY_REVOLUTION } scale_t;

/* A number of the axis configuration; 0 is its default. If an object is named, its range in the dictionary applies. */
typedef struct number {
    const char *key;
    size_t offset;
    scale_t scale;
    const char *unit; /* of the range */
    double minimum, maximum;
    int homing;           /* ... of a homing of the drive: which of them; NO_HOMING: none */
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
    {"homing.offset", FIELD(homing.offset), IN_COUNTS, "counts", 0, 0, CM1E_HOMING_OFFSET},
    {"homing.velocity", FIELD(homing.velocity), IN_COUNTS, "counts/s", 0, 0, CM1E_HOMING_SPEED},
    {"homing.acceleration", FIELD(homing.acceleration), IN_COUNTS, "counts/s2", 0, 0, CM1E_HOMING_ACCELERATION},
    {"homing.torque", FIELD(homing.torque), AS_IS, "%", 0, 0, CM1E_HOMING_TORQUE},
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

static const cm1e_device_t *device_of(const check_t *check) { return cm1e_device_configured(check->axis); }

static const cm1e_device_drive_t *drive_of(const check_t *check) { return cm1e_device_drive_configured(check->axis); }

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

/* The motor behind the bridge; if it is not stated, the one with the larger range. */
static cm1e_bridge_motor_t motor_of(const check_t *check)
{
    return cm1e_bridge_motor(device_of(check)->model, check->axis->channel - 1u);
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

/* ---- what an axis is --------------------------------------------------------------------------------------------- */

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

static bool check_unit(check_t *check)
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

/* "A, B or C" */
static void list_motors(const cm1e_device_t *device, char *text, size_t size)
{
    size_t used = 0;
    text[0] = '\0';
    for (size_t i = 0; device->motor(i) && used < size; i++)
        used += (size_t)snprintf(text + used, size - used, "%s%s",
                                 i == 0 ? "" : device->motor(i + 1) ? ", " : " or ", device->motor(i));
}

static bool check_motor(const check_t *check)
{
    const cm1e_axis_config_t *axis = check->axis;
    const cm1e_device_t *device = device_of(check);
    const char *name = IS_TEXT(axis->motor) ? axis->motor : "?";
    char list[120];
    if (name[0] == '\0')
        return true;
    for (size_t i = 0; device->motor(i); i++)
        if (strcmp(device->motor(i), name) == 0)
            return true;
    list_motors(device, list, sizeof list);
    return axis_wrong(check, "motor", "is '%s'; expected %s%s", name, list, device->motors_note);
}

static bool check_firmware(const check_t *check)
{
    const char *version = check->axis->firmware;
    if (version[0] == '\0')
        return true;
    const cm1e_firmware_info_t *info = IS_TEXT(check->axis->firmware) ? cm1e_firmware_from_version(version) : NULL;
    if (!info || strcmp(info->version, version) != 0) {
        char known[80] = "";
        for (int i = 0; i < CM1E_FIRMWARE_COUNT; i++)
            snprintf(known + strlen(known), sizeof known - strlen(known), "%s%s", i ? ", " : "",
                     cm1e_firmware_info((cm1e_firmware_t)i)->version);
        return axis_wrong(check, "firmware", "is '%.*s'; expected one of: %s", (int)sizeof check->axis->firmware - 1,
                          IS_TEXT(check->axis->firmware) ? version : "?", known);
    }
    const int64_t cycle_time_ns = check->config->cycle_time_ns;
    if (!info->all_cycle_times && cycle_time_ns != 0 && cycle_time_ns != 1000000)
        return axis_wrong(check, "firmware", "is %s, which runs at 1000 us only; the cycle time is %g us", version,
                          (double)cycle_time_ns / 1000);
    return true;
}

static const struct {
    const char *key;
    uint16_t maximum;
} addresses[] = {
    [CM1E_ADDRESS_POSITION] = {"position", CM1E_MAX_SLAVES},
    [CM1E_ADDRESS_ALIAS] = {"alias", 65535},
    [CM1E_ADDRESS_EXPLICIT_ID] = {"explicit_id", 254}, /* UG 4.2.3: 0xFF cannot be used */
};

static bool at_same_address(const check_t *check, uint32_t other)
{
    const cm1e_axis_config_t *axis = &check->config->axes[other];
    return cm1e_axis_has_motor(axis) && axis->address_kind == check->axis->address_kind &&
           cm1e_axis_address(check->config, other) == cm1e_axis_address(check->config, check->index);
}

/* An earlier entry has the same address: allowed only behind one bridge, each axis at its own connector. */
static bool may_share(const check_t *check, uint32_t other)
{
    const unsigned channel = check->axis->channel, taken = check->config->axes[other].channel;
    const char *key = addresses[check->axis->address_kind].key;
    const unsigned address = cm1e_axis_address(check->config, check->index);
    if (!channel && !taken)
        return axis_wrong(check, key, "is %u, which entry %u of the list has already; expected one axis at each "
                          "address", address, other + 1);
    if (!channel || !taken)
        return axis_wrong(check, key, "is %u, as that of entry %u of the list, and only one of the two has a channel; "
                          "expected a channel for every axis of a bridge", address, other + 1);
    if (channel == taken)
        return axis_wrong(check, "channel", "is %u, which entry %u of the list has already on this bridge; expected "
                          "one axis at each channel", channel, other + 1);
    return true;
}

static bool check_address(const check_t *check)
{
    const unsigned kind = check->axis->address_kind;
    if (kind > CM1E_ADDRESS_EXPLICIT_ID)
        return axis_wrong(check, "position", "is of the unknown kind %u; expected position, alias or explicit ID",
                          kind);
    const uint16_t address = cm1e_axis_address(check->config, check->index);
    if (address == 0 || address > addresses[kind].maximum)
        return axis_wrong(check, addresses[kind].key, "is %u; expected 1 ... %u", address, addresses[kind].maximum);
    for (uint32_t i = 0; i < check->index; i++)
        if (at_same_address(check, i) && !may_share(check, i))
            return false;
    return true;
}

static void effective_name(char *name, size_t size, const cm1e_axis_config_t *axis, uint32_t index)
{
    if (axis->name[0])
        snprintf(name, size, "%s", axis->name);
    else
        snprintf(name, size, "axis%u", index + 1);
}

static bool check_name(check_t *check)
{
    snprintf(check->name, sizeof check->name, "%u", check->index + 1);
    if (!IS_TEXT(check->axis->name))
        return axis_wrong(check, "name", NO_TEXT, sizeof check->axis->name);
    effective_name(check->name, sizeof check->name, check->axis, check->index);
    for (uint32_t i = 0; i < check->index; i++) {
        char other[sizeof check->name];
        effective_name(other, sizeof other, &check->config->axes[i], i);
        if (strcmp(other, check->name) == 0)
            return axis_wrong(check, "name", "is also the name of entry %u of the list; expected a name of its own",
                              i + 1);
    }
    return true;
}

/* ---- contradictions within an axis ------------------------------------------------------------------------------- */

static bool check_software_limits(const check_t *check)
{
    const cm1e_axis_config_t *axis = check->axis;
    const double negative = axis->software_limit_negative, positive = axis->software_limit_positive;
    /* The axis keeps positions as doubles: whole counts are exact up to 2^53. Behind a bridge K37 limits the counts of
     * the motor. Infinite: no limit on this side. */
    const double most = axis->channel ? cm1e_bridge_position_limit(motor_of(check), axis->k37) : 9e15;
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

/* UG 6.2.4, 4a, valid for the bridge too: an offset on the far side of a hard stop drives the load into it. */
static bool check_homing(const check_t *check)
{
    const cm1e_homing_config_t *homing = &check->axis->homing;
    const cm1e_device_homing_t *kind = drive_of(check)->homing;
    const int least = kind->first_method, most = kind->last_method < 0 ? 0 : kind->last_method;
    if (homing->method != 0 && (homing->method < least || homing->method > most))
        return axis_wrong(check, "homing.method", kind->place[0] ? "is %d; expected 0 (none) or %d ... %d%s"
                                                                 : "is %d; expected %d ... %d%s",
                          homing->method, least, most, kind->place);
    const double offset = check->axis->invert ? -homing->offset : homing->offset;
    const bool positive = homing->method != 0 && homing->method == kind->positive_stop;
    const bool negative = homing->method != 0 && homing->method == kind->negative_stop;
    if ((positive && offset > 0) || (negative && offset < 0))
        return axis_wrong(check, "homing.offset", "is %.10g, beyond the hard stop that method %d runs against; "
                          "expected an offset of the other sign", homing->offset, homing->method);
    return true;
}

static bool check_inputs(const check_t *check)
{
    const cm1e_input_config_t *inputs = &check->axis->inputs;
    const struct {
        const char *key;
        unsigned number;
    } switches[] = {{"inputs.limit_positive", inputs->limit_positive},
                    {"inputs.limit_negative", inputs->limit_negative}, {"inputs.home", inputs->home}};
    for (int i = 0; i < 3; i++)
        if (switches[i].number > 4)
            return axis_wrong(check, switches[i].key, "is %u; expected 1 ... 4", switches[i].number);
        else if (switches[i].number == 1 && !(drive_of(check)->signals.inputs & 1))
            return axis_wrong(check, switches[i].key, "is 1, through which a CM1 talks to the bridge; expected 2 ... "
                              "4");
    if (inputs->limit_negative && inputs->limit_negative == inputs->limit_positive)
        return axis_wrong(check, "inputs.limit_negative", "is %u, which is the input of the other limit switch too; "
                          "expected another input, so that the direction away from a switch "
                          "is known", inputs->limit_negative);
    return true;
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

static bool check_sim(const check_t *check)
{
    const cm1e_sim_axis_config_t *sim = &check->axis->sim;
    if (sim->no_stops && (sim->stop_negative != 0 || sim->stop_positive != 0))
        return axis_wrong(check, "sim.no_stops", "is true, and a stop is given; expected one of them");
    if (sim->no_sensors && (sim->sensor_input2 != 0 || sim->sensor_input3 != 0))
        return axis_wrong(check, "sim.no_sensors", "is true, and a sensor is given; expected one of them");
    return true;
}

static bool check_motion(const check_t *check)
{
    const cm1e_axis_config_t *axis = check->axis;
    if (axis->motion == CM1E_MOTION_HOST)
        return true;
    if (axis->motion != CM1E_MOTION_DRIVE)
        return axis_wrong(check, "motion", "is %d; expected one of the enumeration", (int)axis->motion);
    if (axis->mapping != CM1E_MAPPING_DYNAMIC && axis->mapping != CM1E_MAPPING_PROFILE)
        return axis_wrong(check, "motion", "is drive, and the mapping has no profile modes; expected the mapping "
                          "dynamic or profile");
    if (axis->backlash != 0)
        return axis_wrong(check, "motion", "is drive, and backlash is given, which the drive does not compensate; "
                          "expected one of them");
    return true;
}

/* ---- behind a bridge --------------------------------------------------------------------------------------------- */

/* The motors at this address, up to this entry. */
static bool check_model(const check_t *check)
{
    const char *motors[CM1E_BRIDGE_AXES] = {"", "", "", ""};
    cm1e_device_model_t model;
    for (uint32_t i = 0; i <= check->index; i++)
        if (at_same_address(check, i))
            motors[check->config->axes[i].channel - 1] = check->config->axes[i].motor;
    return cm1e_bridge_model_with(motors, &model) ||
           axis_wrong(check, "motor", "is %s at channel %u, which no bridge has together with the others; expected CM1 "
                      "at all channels (EB01), CM2 at all (EB02), or CM1 at 1 and 2 and CM2 at 3 and 4 (EB12)",
                      check->axis->motor, check->axis->channel);
}

static bool check_k37(const check_t *check)
{
    const cm1e_axis_config_t *axis = check->axis;
    const cm1e_bridge_motor_t motor = motor_of(check);
    if (!axis->k37_stated)
        return axis_wrong(check, "k37", "is missing; expected the K37 of the motor, which defines counts and speeds: "
                          "send it \"K37.%u\" with cm1e cml", axis->channel);
    if (cm1e_bridge_counts_per_revolution(axis->k37) > 0 && cm1e_bridge_position_limit(motor, axis->k37) > 0)
        return true;
    return axis_wrong(check, "k37", "is %u; expected 0 ... 8 or 10, 40 ... 50, or each of these plus 20%s", axis->k37,
                      motor == CM1E_BRIDGE_CM2 ? ", or 80 ... 88 or 90" : "");
}

/* What means nothing for the device. */
static bool check_absent(const check_t *check)
{
    const cm1e_axis_config_t *axis = check->axis;
    const struct {
        const char *key;
        bool given;
    } keys[] = {
        {"explicit_id", axis->address_kind == CM1E_ADDRESS_EXPLICIT_ID},
        {"k37", axis->k37_stated},
        {"firmware", axis->firmware[0] != '\0'},
        {"mapping", axis->mapping != CM1E_MAPPING_DYNAMIC},
        {"motion", axis->motion != CM1E_MOTION_HOST},
        {"wire.velocity_unit", axis->velocity_unit_stated},
        {"wire.acceleration_unit", axis->acceleration_in_kpulses},
    };
    for (const cm1e_absent_key_t *absent = device_of(check)->absent; absent->key; absent++)
        for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++)
            if (keys[i].given && strcmp(keys[i].key, absent->key) == 0)
                return axis_wrong(check, keys[i].key, "%s", absent->text);
    return true;
}

static bool check_bridge(const check_t *check)
{
    const cm1e_device_t *device = device_of(check);
    const int64_t cycle_time_ns = check->config->cycle_time_ns;
    if (!device->channels)
        return check_absent(check);
    if (cycle_time_ns != 0 && cycle_time_ns != device->cycle_times_ns[0])
        return axis_wrong(check, "channel", "is given, and a bridge runs at 1000 us only; the cycle time is %g us",
                          (double)cycle_time_ns / 1000);
    return check_absent(check) && check_model(check) && check_k37(check);
}

/* ---- which device ------------------------------------------------------------------------------------------------ */

static bool check_kind(const check_t *check)
{
    const cm1e_axis_config_t *axis = check->axis;
    const cm1e_device_t *device = IS_TEXT(axis->device) ? device_of(check) : NULL;
    if (!device)
        return axis_wrong(check, "device", "is '%.*s'; expected cm1-e, bridge or cia402", (int)sizeof axis->device - 1,
                          IS_TEXT(axis->device) ? axis->device : "?");
    if (device->channels && axis->channel == 0)
        return axis_wrong(check, "channel", "is missing; expected 1 ... %u, the connector of the bridge",
                          device->channels);
    return device->channels || axis->channel == 0 ||
           axis_wrong(check, "channel", "is %u, and the device %s is one axis; expected no channel", axis->channel,
                      device->kind);
}

/* A motor that the library does not know is stated. */
static bool check_stated_motor(const check_t *check)
{
    const cm1e_axis_config_t *axis = check->axis;
    const bool needed = device_of(check)->motor_stated;
    const struct {
        const char *key;
        bool given, needed;
    } keys[] = {{"drive.counts_per_revolution", axis->counts_per_revolution != 0, true},
                {"drive.max_speed_rpm", axis->max_speed_rpm != 0, true},
                {"drive.outputs_pdo", axis->outputs_pdo != 0, axis->inputs_pdo != 0},
                {"drive.inputs_pdo", axis->inputs_pdo != 0, axis->outputs_pdo != 0}};
    for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++)
        if (keys[i].given && !needed)
            return axis_wrong(check, keys[i].key, "is given, and the device %s is known without it; expected it with "
                              "the device cia402 only", device_of(check)->kind);
        else if (needed && keys[i].needed && !keys[i].given)
            return axis_wrong(check, keys[i].key, "is missing; expected it with the device %s",
                              device_of(check)->kind);
    if (!needed)
        return true;
    if (axis->counts_per_revolution < 100 || axis->counts_per_revolution > 1 << 30)
        return axis_wrong(check, "drive.counts_per_revolution", "is %u; expected 100 ... %d",
                          axis->counts_per_revolution, 1 << 30);
    if (!(axis->max_speed_rpm >= 1 && axis->max_speed_rpm <= 100000))
        return axis_wrong(check, "drive.max_speed_rpm", "is %g; expected 1 ... 100000", axis->max_speed_rpm);
    return cm1e_unit_peak_velocity(axis) <= INT32_MAX ||
           axis_wrong(check, "drive.max_speed_rpm", "is %g, at which the motor makes %.0f counts/s; expected at most "
                      "%d counts/s", axis->max_speed_rpm, cm1e_unit_peak_velocity(axis), INT32_MAX);
}

static bool check_channel(const check_t *check)
{
    return check->axis->channel <= CM1E_BRIDGE_AXES ||
           axis_wrong(check, "channel", "is %u; expected 1 ... %d", check->axis->channel, CM1E_BRIDGE_AXES);
}

/* ---- all together ------------------------------------------------------------------------------------------------ */

static bool check_device(const check_t *check)
{
    if (!cm1e_axis_has_motor(check->axis))
        return cm1e_config_check_without_motor(check);
    return check_channel(check) && check_kind(check) && check_address(check) && check_motor(check) &&
           check_bridge(check) && check_stated_motor(check) && check_firmware(check);
}

static bool check_coupling(const check_t *check)
{
    const unsigned points = check->axis->cam_points;
    if (points != 0 && (points < CM1E_CAM_POINTS_MINIMUM || points > CM1E_CAM_POINTS_MAXIMUM))
        return axis_wrong(check, "cam_points", "is %u; expected %d ... %d", points, CM1E_CAM_POINTS_MINIMUM,
                          CM1E_CAM_POINTS_MAXIMUM);
    return (unsigned)check->axis->coupling_stop <= CM1E_COUPLING_STOP_KEEP_RATIO ||
           axis_wrong(check, "coupling_stop", "is %d; expected one of the enumeration",
                      (int)check->axis->coupling_stop);
}

static bool check_axis(check_t *check)
{
    if (!check_name(check))
        return false;
    if ((unsigned)check->axis->type > CM1E_AXIS_ENCODER)
        return axis_wrong(check, "type", "is %d; expected one of the enumeration", (int)check->axis->type);
    if (!check_device(check) || !check_unit(check) || !check_coupling(check))
        return false;
    if ((unsigned)check->axis->mapping > CM1E_MAPPING_PROFILE)
        return axis_wrong(check, "mapping", "is %d; expected one of the enumeration", (int)check->axis->mapping);
    return check_motion(check) && check_velocity(check) && check_numbers(check) && check_software_limits(check) &&
           check_modulo(check) && check_homing(check) && check_inputs(check) && check_jog(check) &&
           check_in_position(check) && check_sim(check);
}

bool cm1e_config_find_problem(const cm1e_bus_config_t *config, cm1e_config_problem_t *problem)
{
    check_t check = {.config = config, .problem = problem};
    if (config->axis_count > CM1E_MAX_AXES) {
        snprintf(problem->path, sizeof problem->path, "axes");
        snprintf(problem->text, sizeof problem->text, "axis_count is %u; expected at most %d", config->axis_count,
                 CM1E_MAX_AXES);
        return false;
    }
    if (config->axis_count > 0 && !config->axes) {
        snprintf(problem->path, sizeof problem->path, "axes");
        snprintf(problem->text, sizeof problem->text, "axis_count is %u, but there is no memory for axes; expected are "
                 "axes made with cm1e_bus_config_init() or cm1e_bus_config_add_axis()", config->axis_count);
        return false;
    }
    if (!check_bus(&check))
        return false;
    for (check.index = 0; check.index < config->axis_count; check.index++) {
        check.axis = &config->axes[check.index];
        if (!check_axis(&check))
            return false;
    }
    return true;
}
