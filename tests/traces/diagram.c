/* The bench on which a scenario runs, and the recording. */
#include "diagram.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "assembly/assembly.h"
#include "axes_described.h"
#include "bus/bus_image.h"
#include "cm1e/scan_time.h"
#include "cm1e/sim.h"
#include "core/clock.h"

bench_t bench;
static trace_t trace;
static cm1e_bus_t *bus;
enum { AXES = 1 + TRACE_MASTERS };
static cm1e_axis_t *axes[AXES]; /* the axis, then its masters */
static int axis_count;
static int64_t start_ns, number;
static double set_position[AXES], set_velocity[AXES];
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
    if (axis_count == 0)
        return;
    cm1e_clock_sleep_until(cm1e_bus_clock(bus), planned_ns);
    const cm1e_error_t received = cm1e_bus_receive(bus);
    for (int i = 0; i < axis_count; i++)
        cm1e_axis_inputs(axes[i], received, cm1e_bus_health(bus), planned_ns);
}

static void outputs(void)
{
    if (axis_count == 0)
        return;
    for (int i = 0; i < axis_count; i++)
        cm1e_axis_outputs(axes[i]);
    cm1e_bus_send(bus);
    for (int i = axis_count - 1; i >= 0; i--) {
        cm1e_axis_get(axes[i], &bench.info);
        set_position[i] = bench.info.set_position;
        set_velocity[i] = bench.info.set_velocity;
    }
}

void trace_configure(void (*configure)(cm1e_axis_config_t *config)) { configure_next = configure; }

static void open_axes(int count)
{
    static cm1e_bus_config_t config;
    cm1e_diag_t diag = {0};
    describe_axes(&config, (uint32_t)count);
    for (int i = 0; i < count; i++) {
        config.axes[i].max_acceleration = config.axes[i].max_deceleration = 200;
        config.axes[i].max_jerk = 4000;
        if (i > 0)
            config.axes[i].sim.stop_negative = config.axes[i].sim.stop_positive = 0;
    }
    if (configure_next)
        configure_next(&config.axes[0]);
    configure_next = NULL;
    require(cm1e_bus_open(&bus, &config, &diag) == CM1E_OK, diag.text);
    require(cm1e_bus_start(bus, &diag) == CM1E_OK, diag.text);
    for (axis_count = 0; axis_count < count; axis_count++)
        require(cm1e_axis_create(&axes[axis_count], bus, (uint32_t)axis_count, &diag) == CM1E_OK, diag.text);
    bench.axis = cm1e_axis_reference(axes[0]);
    for (int i = 1; i < count; i++)
        bench.masters[i - 1] = cm1e_axis_reference(axes[i]);
    start_ns = cm1e_clock_now(cm1e_bus_clock(bus));
}

static void close_axes(void)
{
    if (axis_count == 0)
        return;
    cm1e_bus_stop(bus);
    while (axis_count > 0)
        cm1e_axis_destroy(axes[--axis_count]);
    cm1e_bus_close(bus);
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

static void add_curves(const char *whose, int of, bool position, bool velocity)
{
    char name[48];
    snprintf(name, sizeof name, "%s velocity", whose);
    if (velocity)
        add_curve(name, "u/s", BLOCK_LREAL, &set_velocity[of]);
    snprintf(name, sizeof name, "%s position", whose);
    if (position)
        add_curve(name, "u", BLOCK_LREAL, &set_position[of]);
}

void trace_curves(bool position, bool velocity)
{
    const char *alone = axis_count > 1 ? "slave" : "set";
    add_curves(bench.group.Handle ? "X" : alone, 0, position, velocity);
}

void trace_master_curves(int master, bool position, bool velocity)
{
    static const char *const names[TRACE_MASTERS] = {"master 1", "master 2"};
    add_curves(bench.group.Handle ? "Y" : axis_count > 2 ? names[master] : "master", 1 + master, position, velocity);
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

static void begin_disabled(const char *block, const char *about, int count)
{
    trace_begin_without_axis(block, about);
    trace.has_axis = true;
    open_axes(count);
    for (int i = 0; i < 50; i++) {
        inputs();
        outputs();
    }
    inputs();
}

void trace_begin_disabled(const char *block, const char *about) { begin_disabled(block, about, 1); }

static void call_power(void)
{
    if (bench.power.Axis)
        MC_Power(&bench.power);
    for (int i = 0; i < TRACE_MASTERS; i++)
        if (bench.master_power[i].Axis)
            MC_Power(&bench.master_power[i]);
}

void trace_begin_with_masters(const char *block, const char *about, int masters)
{
    begin_disabled(block, about, 1 + masters);
    bench.power = (MC_Power_t){.Axis = &bench.axis, .Enable = TRUE, .EnablePositive = TRUE, .EnableNegative = TRUE};
    for (int i = 0; i < masters; i++) {
        bench.master_power[i] = bench.power;
        bench.master_power[i].Axis = &bench.masters[i];
    }
    for (int i = 0; i < 5000 && (!bench.power.Status || i < 300); i++) {
        call_power();
        outputs();
        inputs();
    }
    require(bench.power.Status, "the axis does not come on");
    call_power();
}

void trace_begin_with_group(const char *block, const char *about)
{
    cm1e_diag_t diag = {0};
    trace_begin_with_masters(block, about, 1);
    require(cm1e_group_create(&bench.group, NULL, &diag) == CM1E_OK, diag.text);
    MC_AddAxisToGroup_t x = {GROUP, AXIS, .Execute = TRUE}, y = {GROUP, MASTER, .Execute = TRUE};
    MC_GroupEnable_t enable = {GROUP, .Execute = TRUE};
    MC_AddAxisToGroup(&x);
    MC_AddAxisToGroup(&y);
    MC_GroupEnable(&enable);
    require(x.Done && y.Done && enable.Done, "the group is not enabled");
}

void trace_begin(const char *block, const char *about) { trace_begin_with_masters(block, about, 0); }

void trace_scan(void)
{
    outputs();
    record();
    bench.scan++;
    inputs();
    call_power();
}

static const char *folder;

void trace_end(void)
{
    outputs();
    require(trace_draw(&trace, folder), "its diagram cannot be written");
    close_axes();
    if (bench.group.Handle)
        require(cm1e_group_destroy(bench.group) == CM1E_OK, "the group still moves");
}

int main(int argument_count, char **arguments)
{
    const scenario_t *const files[] = {motion_scenarios, multi_axis_scenarios, group_scenarios,
                                       administrative_scenarios, homing_scenarios, bridge_scenarios,
                                       standard_scenarios};
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
