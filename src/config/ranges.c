/* The check of a configuration: the bus, then each axis. */
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "config/interface.h"
#include "config/ranges.h"
#include "device/place.h"

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

/* ---- the bus ----------------------------------------------------------------------------------------------------- */

static bool some_device_has(int64_t cycle_time_ns)
{
    const cm1e_device_t *device;
    for (size_t i = 0; (device = cm1e_device_number(i)); i++)
        if (cm1e_device_has_cycle_time(device, cycle_time_ns))
            return true;
    return false;
}

/* All slaves have one cycle time. A device that several axes share is checked with each of them (ranges_device.c). */
static bool check_cycle_time(const check_t *check)
{
    const cm1e_bus_config_t *config = check->config;
    const double cycle_time_us = (double)config->cycle_time_ns / 1000;
    char list[CM1E_CYCLE_TIMES_TEXT];
    if (config->cycle_time_ns == 0)
        return true;
    for (uint32_t i = 0; i < config->axis_count; i++) {
        const cm1e_axis_config_t *axis = &config->axes[i];
        const bool own = cm1e_axis_has_motor(axis) && IS_TEXT(axis->device) && !cm1e_device_is_shared(axis);
        const cm1e_device_t *device = own ? cm1e_device_configured(axis) : NULL;
        if (device && !cm1e_device_has_cycle_time(device, config->cycle_time_ns))
            return bus_wrong(check, "cycle_time_us", "is %g; expected %s, which the %s accepts", cycle_time_us,
                             cm1e_device_cycle_times(device, "or", list), device->label);
    }
    return some_device_has(config->cycle_time_ns) ||
           bus_wrong(check, "cycle_time_us", "is %g; expected a cycle time that a device accepts", cycle_time_us);
}

static bool check_times(const check_t *check)
{
    const int64_t cycle = check->config->cycle_time_ns ? check->config->cycle_time_ns : 1000000;
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

/* All slaves are checked before. */
static bool check_overlap(const check_t *check)
{
    const cm1e_bus_config_t *config = check->config;
    if (config->overlap && config->second_interface[0])
        return bus_wrong(check, "overlap", "is true together with a second_interface: a ring sends a frame on that "
                         "slaves have answered, and their inputs could reach them as outputs; expected one of the two");
    for (uint32_t i = 0; config->overlap && i < config->axis_count; i++)
        if (config->axes[i].optional)
            return bus_wrong(check, "overlap", "is true, and entry %u of the axes is optional: a slave that comes and "
                             "goes needs places of its own; expected one of the two", i + 1);
    for (uint32_t i = 0; config->overlap && i < config->slave_count; i++)
        if (cm1e_slave_is_optional(&config->slaves[i]))
            return bus_wrong(check, "overlap", "is true, and entry %u of the slaves is optional: a slave that comes "
                             "and goes needs places of its own; expected one of the two", i + 1);
    return true;
}

static bool check_way(const check_t *check, const char *field, const char *name)
{
    char wrong[300];
    return cm1e_interface_way(name, wrong, sizeof wrong) != CM1E_WAY_UNKNOWN || bus_wrong(check, field, "%s", wrong);
}

static bool check_bus(const check_t *check)
{
    const cm1e_bus_config_t *config = check->config;
    if (!IS_TEXT(config->interface_name))
        return bus_wrong(check, "interface", NO_TEXT, sizeof config->interface_name);
    if (!IS_TEXT(config->second_interface))
        return bus_wrong(check, "second_interface", NO_TEXT, sizeof config->second_interface);
    if (!check_way(check, "interface", config->interface_name) ||
        !check_way(check, "second_interface", config->second_interface))
        return false;
    if (!IS_TEXT(config->pcap_file))
        return bus_wrong(check, "pcap_file", NO_TEXT, sizeof config->pcap_file);
    if (config->second_interface[0] && cm1e_config_uses_clocks(config))
        return bus_wrong(check, "second_interface", "is given together with distributed clocks, whose time would reach "
                         "half of a broken ring before the reference has given it; expected one of the two");
    if (config->second_interface[0] && cm1e_interface_is_same(config->second_interface, config->interface_name))
        return bus_wrong(check, "second_interface", "is %s like the first; expected the other end of the ring",
                         config->second_interface);
    if (config->virtual_time && !cm1e_interface_is_simulated(config->interface_name))
        return bus_wrong(check, "virtual_time", "is on with the interface %s; expected only with interface sim",
                         config->interface_name);
    if (config->sim_pdo_order != CM1E_PDO_ORDER_UG_4_4 && config->sim_pdo_order != CM1E_PDO_ORDER_UG_7_2)
        return bus_wrong(check, "sim_pdo_order", "is %d; expected one of the enumeration", (int)config->sim_pdo_order);
    if ((unsigned)config->sim_gaps > CM1E_SIM_IO_COUPLER)
        return bus_wrong(check, "sim_gaps", "is %d; expected one of the enumeration", (int)config->sim_gaps);
    if ((unsigned)config->control > CM1E_CONTROL_MAINTAIN)
        return bus_wrong(check, "control", "is %d; expected one of the enumeration", (int)config->control);
    return check_cycle_time(check) && check_times(check);
}

/* ---- what an axis is --------------------------------------------------------------------------------------------- */

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
        if (strcasecmp(other, check->name) == 0)
            return axis_wrong(check, "name", "is also the name of entry %u of the list; expected a name of its own",
                              i + 1);
    }
    return true;
}

/* ---- contradictions within an axis ------------------------------------------------------------------------------- */

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

/* Whether an input is a signal of another slave. */
static bool is_wired(const check_t *check, unsigned number)
{
    return number >= CM1E_WIRED_FIRST && number < CM1E_WIRED_FIRST + (unsigned)check->axis->wiring.input_count;
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
        if (is_wired(check, switches[i].number))
            continue;
        else if (switches[i].number > 4)
            return axis_wrong(check, switches[i].key, "is %u; expected 1 ... 4, or the name of a signal as in "
                              "\"switches.home\"", switches[i].number);
        else if (switches[i].number == 1 && !(drive_of(check)->signals.inputs & 1))
            return axis_wrong(check, switches[i].key, "is 1, through which a CM1 talks to the bridge; expected 2 ... "
                              "4");
    if (inputs->limit_negative && inputs->limit_negative == inputs->limit_positive)
        return axis_wrong(check, "inputs.limit_negative", "is %u, which is the input of the other limit switch too; "
                          "expected another input, so that the direction away from a switch "
                          "is known", inputs->limit_negative);
    return true;
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

/* ---- all together ------------------------------------------------------------------------------------------------ */

static bool check_coupling(const check_t *check)
{
    const unsigned points = check->axis->cam_points;
    if (points != 0 && (points < CM1E_CAM_POINTS_MINIMUM || points > CM1E_CAM_POINTS_MAXIMUM))
        return axis_wrong(check, "cam_points", "is %u; expected %d ... %d", points, CM1E_CAM_POINTS_MINIMUM,
                          CM1E_CAM_POINTS_MAXIMUM);
    if ((unsigned)check->axis->follows > CM1E_FOLLOWS_NOTHING)
        return axis_wrong(check, "follows", "is %d; expected one of the enumeration", (int)check->axis->follows);
    if (points != 0 && check->axis->follows != CM1E_FOLLOWS_ANY)
        return axis_wrong(check, "cam_points", "is given, and the axis follows no cams (follows: %s); expected one of "
                          "them", check->axis->follows == CM1E_FOLLOWS_GEARS ? "gears" : "nothing");
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
    if (!cm1e_config_check_device(check) || !cm1e_config_check_unit(check) || !check_coupling(check))
        return false;
    if ((unsigned)check->axis->mapping > CM1E_MAPPING_PROFILE)
        return axis_wrong(check, "mapping", "is %d; expected one of the enumeration", (int)check->axis->mapping);
    return check_motion(check) && cm1e_config_check_optional(check) && cm1e_config_check_numbers(check) &&
           check_homing(check) && check_inputs(check) && cm1e_config_check_wiring(check) && check_sim(check);
}

/* An address that is not stated is counted, so all are counted once: each axis is compared with those before it. */
static bool check_axes(check_t *check)
{
    for (uint32_t i = 0; i < check->config->axis_count; i++)
        check->addresses[i] = cm1e_axis_address(check->config, i);
    for (check->index = 0; check->index < check->config->axis_count; check->index++) {
        check->axis = &check->config->axes[check->index];
        if (!check_axis(check))
            return false;
    }
    return true;
}

bool cm1e_config_find_problem(const cm1e_bus_config_t *config, cm1e_config_problem_t *problem)
{
    check_t check = {.config = config, .problem = problem};
    if (config->axis_count > CM1E_MAX_AXES) { /* these two are not of a file, so they have no path */
        snprintf(problem->text, sizeof problem->text, "axis_count is %u; expected at most %d", config->axis_count,
                 CM1E_MAX_AXES);
        return false;
    }
    if (config->axis_count > 0 && !config->axes) {
        snprintf(problem->text, sizeof problem->text, "axis_count is %u, but there is no memory for axes; expected are "
                 "axes made with cm1e_bus_config_init() or cm1e_bus_config_add_axis()", config->axis_count);
        return false;
    }
    return check_bus(&check) && check_axes(&check) && cm1e_config_check_slaves(config, problem) &&
           check_overlap(&check);
}
