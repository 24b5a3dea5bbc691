/* The bench on which a scenario runs, and the recording. */
#include "trace.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "axes_described.h"
#include "bus/bus_image.h"
#include "cm1e/scan_time.h"
#include "core/clock.h"

bench_t bench;
static trace_t trace;
static cm1e_bus_t *bus;
static cm1e_axis_t *axis;
static int64_t start_ns, number;
static double set_position, set_velocity;
static void (*configure_next)(cm1e_axis_config_t *config);

static void require(bool condition, const char *what)
{
    if (!condition) {
        fprintf(stderr, "%s: %s\n", trace.block, what);
        exit(EXIT_FAILURE);
    }
}

void simulate(const char *line)
{
    char answer[160];
    require(cm1e_bus_simulate(bus, line, answer, sizeof answer) == CM1E_OK, answer);
}

/* ---- the bench ------------------------------------------------------------------------------------------------- */

static void inputs(void)
{
    const int64_t planned_ns = start_ns + number++ * 1000000;
    cm1e_scan_time_set(planned_ns);
    if (!axis)
        return;
    cm1e_clock_sleep_until(cm1e_bus_clock(bus), planned_ns);
    const cm1e_error_t received = cm1e_bus_receive(bus);
    cm1e_axis_inputs(axis, received, cm1e_bus_health(bus), planned_ns);
}

static void outputs(void)
{
    if (!axis)
        return;
    cm1e_axis_outputs(axis);
    cm1e_bus_send(bus);
    cm1e_axis_get(axis, &bench.info);
    set_position = bench.info.set_position;
    set_velocity = bench.info.set_velocity;
}

void trace_configure(void (*configure)(cm1e_axis_config_t *config)) { configure_next = configure; }

static void open_axis(void)
{
    static cm1e_bus_config_t config;
    cm1e_diag_t diag = {0};
    describe_axes(&config, 1);
    config.axes[0].max_acceleration = config.axes[0].max_deceleration = 200;
    config.axes[0].max_jerk = 4000;
    if (configure_next)
        configure_next(&config.axes[0]);
    configure_next = NULL;
    require(cm1e_bus_open(&bus, &config, &diag) == CM1E_OK, diag.text);
    require(cm1e_bus_start(bus, &diag) == CM1E_OK, diag.text);
    require(cm1e_axis_create(&axis, bus, 0, &diag) == CM1E_OK, diag.text);
    bench.axis = cm1e_axis_reference(axis);
    start_ns = cm1e_clock_now(cm1e_bus_clock(bus));
}

static void close_axis(void)
{
    if (!axis)
        return;
    cm1e_bus_stop(bus);
    cm1e_axis_destroy(axis);
    cm1e_bus_close(bus);
    axis = NULL;
    bus = NULL;
}

/* ---- the recording --------------------------------------------------------------------------------------------- */

static trace_curve_t *add_curve(const char *name, const char *unit, block_type_t type, const void *source)
{
    require(trace.curve_count < TRACE_CURVES, "too many curves");
    trace_curve_t *curve = &trace.curves[trace.curve_count++];
    snprintf(curve->name, sizeof curve->name, "%s", name);
    curve->unit = unit;
    curve->type = type;
    curve->source = source;
    return curve;
}

static trace_lane_t *add_lane(const char *name, const BOOL *source)
{
    require(trace.lane_count < TRACE_LANES, "too many lanes");
    trace_lane_t *lane = &trace.lanes[trace.lane_count++];
    *lane = (trace_lane_t){.name = name, .source = source};
    return lane;
}

static const block_t *find_block(const char *type)
{
    for (size_t i = 0; i < block_count; i++)
        if (strcmp(block_table[i].name, type) == 0)
            return &block_table[i];
    require(false, type);
    return NULL;
}

void trace_block(const char *type, const char *title, const void *fb)
{
    const block_t *block = find_block(type);
    const char *next_title = title;
    for (size_t i = 0; i < block->member_count; i++) {
        const block_member_t *member = &block->members[i];
        if (member->type != BLOCK_BOOL)
            continue;
        trace_lane_t *lane = add_lane(member->name, (const BOOL *)fb + member->offset);
        lane->is_input = member->section != BLOCK_OUTPUT;
        lane->title = next_title;
        next_title = NULL;
    }
}

void trace_value(const char *type, const void *fb, const char *name, const char *unit)
{
    const block_t *block = find_block(type);
    for (size_t i = 0; i < block->member_count; i++)
        if (strcmp(block->members[i].name, name) == 0) {
            add_curve(name, unit, block->members[i].type, (const char *)fb + block->members[i].offset);
            return;
        }
    require(false, name);
}

void trace_signal(const char *name, const BOOL *signal) { add_lane(name, signal); }

void trace_curves(bool position, bool velocity)
{
    if (velocity)
        add_curve("set velocity", "u/s", BLOCK_LREAL, &set_velocity);
    if (position)
        add_curve("set position", "u", BLOCK_LREAL, &set_position);
}

static double value_of(const trace_curve_t *curve)
{
    switch (curve->type) {
    case BLOCK_INT: return *(const INT *)curve->source;
    case BLOCK_WORD: return *(const WORD *)curve->source;
    case BLOCK_DWORD: return *(const DWORD *)curve->source;
    case BLOCK_TIME: return (double)*(const TIME *)curve->source * 1e-6;
    case BLOCK_LREAL: return *(const LREAL *)curve->source;
    default: require(false, curve->name); return 0;
    }
}

static void record(void)
{
    require(trace.count < TRACE_SCANS, "the scenario takes too long");
    const int n = trace.count++;
    for (int i = 0; i < trace.lane_count; i++) {
        trace.lanes[i].values[n] = *trace.lanes[i].source;
        trace.lanes[i].ever = trace.lanes[i].ever || *trace.lanes[i].source;
    }
    for (int i = 0; i < trace.curve_count; i++)
        trace.curves[i].values[n] = value_of(&trace.curves[i]);
    trace.states[n] = (unsigned char)bench.info.state;
}

/* ---- a scenario ------------------------------------------------------------------------------------------------ */

void trace_begin_without_axis(const char *block, const char *about)
{
    memset(&trace, 0, sizeof trace);
    memset(&bench, 0, sizeof bench);
    trace.block = block;
    trace.about = about;
    start_ns = number = 0;
    inputs();
}

void trace_begin_disabled(const char *block, const char *about)
{
    trace_begin_without_axis(block, about);
    trace.has_axis = true;
    open_axis();
    for (int i = 0; i < 50; i++) {
        inputs();
        outputs();
    }
    inputs();
}

void trace_begin(const char *block, const char *about)
{
    trace_begin_disabled(block, about);
    bench.power = (MC_Power_t){.Axis = &bench.axis, .Enable = TRUE, .EnablePositive = TRUE, .EnableNegative = TRUE};
    for (int i = 0; i < 5000 && (!bench.power.Status || i < 300); i++) {
        MC_Power(&bench.power);
        outputs();
        inputs();
    }
    require(bench.power.Status, "the axis does not come on");
    MC_Power(&bench.power);
}

void trace_scan(void)
{
    outputs();
    record();
    bench.scan++;
    inputs();
    if (bench.power.Axis)
        MC_Power(&bench.power);
}

static const char *folder;

void trace_end(void)
{
    outputs();
    require(trace_draw(&trace, folder), "its diagram cannot be written");
    close_axis();
}

int main(int argument_count, char **arguments)
{
    const scenario_t *const files[] = {motion_scenarios, administrative_scenarios, homing_scenarios,
                                       bridge_scenarios, standard_scenarios};
    if (argument_count < 2) {
        fprintf(stderr, "usage: %s FOLDER [BLOCK]\nDraws the timing diagrams of docs/blocks/ there.\n", *arguments);
        return EXIT_FAILURE;
    }
    folder = arguments[1];
    for (size_t i = 0; i < sizeof files / sizeof *files; i++)
        for (const scenario_t *scenario = files[i]; scenario->name; scenario++)
            if (argument_count < 3 || strcmp(arguments[2], scenario->name) == 0)
                scenario->run();
    return EXIT_SUCCESS;
}
