/* Configuration, networks and scheduler of a scenario. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scenario_private.h"

enum { CIA402_COUNTS = 131072, CIA402_SPEED_RPM = 3000, CM1_K37 = 10 };

bool is_motor(const machine_axis_t *axis) { return axis->position > 0; }

static bool is_optional(const axis_spec_t *spec) { return spec->kind == AXIS_CM1E && spec->optional != 0; }

static bool is_bridged(const axis_spec_t *spec) { return spec->kind >= AXIS_EB01 && spec->kind <= AXIS_EB12; }

/** An axis behind a bridge that the axis before it has too. */
static bool shares_bridge(const scenario_t *scenario, int n)
{
    const axis_spec_t *spec = &scenario->axes[n], *before = spec - 1;
    return n > 0 && is_bridged(spec) && before->kind == spec->kind && before->network == spec->network &&
           before->channel < spec->channel;
}

static void describe_device(cm1e_axis_config_t *axis, const machine_axis_t *machine)
{
    static const char *const firmwares[] = {"1.3.5", "1.2.0", "1.3.0", "1.3.2", "1.3.3", "1.3.4"};
    const axis_spec_t *spec = machine->spec;
    axis->address = (uint16_t)machine->position;
    axis->channel = (uint8_t)machine->channel;
    if (spec->kind == AXIS_VIRTUAL)
        axis->type = CM1E_AXIS_VIRTUAL;
    axis->optional = is_optional(spec);
    if (is_optional(spec) || spec->identified != 0) {
        axis->address_kind = CM1E_ADDRESS_EXPLICIT_ID;
        axis->address = (uint16_t)(FIRST_ID + machine->number);
    }
    if (spec->kind == AXIS_CM1E) {
        snprintf(axis->firmware, sizeof axis->firmware, "%s", firmwares[(int)spec->firmware]);
        axis->mapping = (cm1e_mapping_t)spec->mapping;
        axis->motion = (cm1e_motion_backend_t)spec->motion;
    }
    if (is_bridged(spec)) {
        const bool cm2 = spec->kind == AXIS_EB02 || (spec->kind == AXIS_EB12 && spec->channel > 2);
        snprintf(axis->motor, sizeof axis->motor, "%s", cm2 ? "CM2" : "CM1");
        axis->k37 = CM1_K37;
        axis->k37_stated = true;
    }
    if (spec->kind == AXIS_CIA402) {
        snprintf(axis->device, sizeof axis->device, "cia402");
        axis->counts_per_revolution = CIA402_COUNTS;
        axis->max_speed_rpm = CIA402_SPEED_RPM;
    }
}

static void describe_axis(const scenario_t *scenario, cm1e_axis_config_t *axis, const machine_axis_t *machine)
{
    const axis_spec_t *spec = machine->spec;
    const double unit = spec->counts_per_unit;
    snprintf(axis->name, sizeof axis->name, "%s", machine->name);
    describe_device(axis, machine);
    axis->counts_per_unit = unit;
    axis->invert = spec->invert != 0;
    axis->max_velocity = spec->velocity / unit;
    axis->max_acceleration = spec->acceleration / unit;
    axis->max_deceleration = spec->deceleration / unit;
    axis->max_jerk = spec->jerk / unit;
    axis->software_limit_negative = spec->limit_negative / unit;
    axis->software_limit_positive = spec->limit_positive / unit;
    axis->modulo_range = spec->modulo / unit;
    axis->backlash = spec->backlash / unit;
    axis->backlash_velocity = crossing_speed(spec) / unit;
    axis->in_position_done_waits = spec->done_waits != 0 && spec->kind != AXIS_VIRTUAL;
    axis->coupling_stop = (cm1e_coupling_stop_t)spec->coupling_stop;
    if (spec->wired != 0) {
        axis->wiring.input_count = (uint8_t)(spec->switched != 0 ? WIRED + SWITCHES : WIRED);
        axis->wiring.output_count = WIRED;
        for (int i = 0; i < axis->wiring.input_count; i++)
            snprintf(axis->wiring.inputs[i], sizeof axis->wiring.inputs[i], "io%d0.input %d", machine->network, i + 1);
        for (int i = 0; i < WIRED; i++)
            snprintf(axis->wiring.outputs[i], sizeof axis->wiring.outputs[i], "io%d0.output %d", machine->network, i + 1);
    }
    axis->table_profiles = program_has(scenario, machine->number, table_blocks);
    if (spec->kind == AXIS_VIRTUAL)
        return;
    axis->sim.load_inertia = spec->load_inertia;
    axis->sim.friction = spec->friction;
    axis->sim.no_stops = axis->sim.no_sensors = spec->stops == 0;
    if (spec->stops != 0 && program_has(scenario, machine->number, step_homings))
        axis->inputs = (cm1e_input_config_t){.limit_positive = spec->invert != 0 ? 3 : 2,
                                             .limit_negative = spec->invert != 0 ? 2 : 3, .home = 2};
    if (spec->switched != 0)
        axis->inputs = (cm1e_input_config_t){.limit_positive = CM1E_WIRED_FIRST + WIRED,
                                             .limit_negative = CM1E_WIRED_FIRST + WIRED + 1, .home = CM1E_WIRED_FIRST + WIRED};
    if (spec->kind == AXIS_CM1E)
        axis->homing = (cm1e_homing_config_t){.method = -2, .velocity = 100000 / unit, .acceleration = 2000000 / unit,
                                              .torque = 30, .timeout_s = 3};
}

static int terminals_of(const run_t *run, int network, uint32_t motors)
{
    return network == 0 ? (int)run->scenario->io + (run->scenario->analog > 0) : motors == 0;
}

/** Optional slaves are behind all others. */
static void place_optional(run_t *run, uint32_t slaves[])
{
    for (int i = 0; i < SCENARIO_NETWORKS; i++) {
        run->fixed_motors[i] = slaves[i];
        slaves[i] += (uint32_t)terminals_of(run, i, slaves[i]);
    }
    for (int n = 0; n < run->scenario->axis_count; n++)
        if (is_optional(run->axes[n].spec))
            run->axes[n].position = ++slaves[run->axes[n].network];
}

/** Which slave an axis is, in the order of the list. */
static void place_axes(run_t *run)
{
    const scenario_t *scenario = run->scenario;
    uint32_t slaves[SCENARIO_NETWORKS] = {0};
    run->networks = 1;
    for (int n = 0; n < scenario->axis_count; n++) {
        machine_axis_t *axis = &run->axes[n];
        axis->spec = &scenario->axes[n];
        axis->number = n;
        axis->network = axis->spec->network != 0;
        axis->channel = is_bridged(axis->spec) ? (unsigned)axis->spec->channel : 0;
        if (axis->spec->kind != AXIS_VIRTUAL && !is_optional(axis->spec))
            axis->position = shares_bridge(scenario, n) ? slaves[axis->network] : ++slaves[axis->network];
        snprintf(axis->name, sizeof axis->name, "X%d", n);
        if (axis->network == 1)
            run->networks = SCENARIO_NETWORKS;
    }
    place_optional(run, slaves);
}

static bool add_axes(const run_t *run, cm1e_bus_config_t *config, int network)
{
    for (int n = 0; n < run->scenario->axis_count; n++) {
        if (run->axes[n].network != network)
            continue;
        cm1e_axis_config_t *axis = cm1e_bus_config_add_axis(config, run->axes[n].name);
        if (!axis)
            return false;
        describe_axis(run->scenario, axis, &run->axes[n]);
    }
    return true;
}

/** Digital terminals behind the motors of the first network, and an analog one behind them. false: no memory. */
static bool add_terminals(const run_t *run, cm1e_bus_config_t *config, int network)
{
    const int terminals = terminals_of(run, network, run->fixed_motors[network]);
    for (int i = 0; i < terminals; i++) {
        char name[16];
        snprintf(name, sizeof name, "io%d%d", network, i);
        cm1e_slave_config_t *slave = cm1e_bus_config_add_slave(config, name);
        if (!slave)
            return false;
        slave->address = (uint16_t)(run->fixed_motors[network] + 1 + (uint32_t)i);
        const bool analog = network == 0 && i == (int)run->scenario->io;
        slave->sim.kind = analog ? CM1E_SIM_SLAVE_ANALOG : CM1E_SIM_SLAVE_DIGITAL;
        slave->sim.outputs = slave->sim.inputs = (uint8_t)(analog ? run->scenario->analog : 4);
    }
    return true;
}

static cm1e_error_t open_network(run_t *run, int network, cm1e_diag_t *diag)
{
    cm1e_bus_config_t config;
    const scenario_t *scenario = run->scenario;
    cm1e_error_t error = cm1e_bus_config_init(&config, "sim", 0);
    if (error != CM1E_OK || !add_axes(run, &config, network) || !add_terminals(run, &config, network)) {
        cm1e_bus_config_free(&config);
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "no memory for the configuration");
    }
    config.virtual_time = true;
    config.cycle_time_ns = (int64_t)scenario->cycle_us * 1000;
    config.lost_cycles_limit = (uint32_t)scenario->lost_limit;
    config.distributed_clocks = scenario->clocks != 0;
    config.overlap = scenario->overlap != 0;
    if (scenario->ring != 0)
        snprintf(config.second_interface, sizeof config.second_interface, "sim-second");
    snprintf(config.name, sizeof config.name, network ? "second" : "first");
    error = cm1e_bus_open(&run->buses[network], &config, diag);
    cm1e_bus_config_free(&config);
    if (error != CM1E_OK)
        return error;
    run->segments[network] = cm1e_bus_segment(run->buses[network]);
    return cm1e_bus_start(run->buses[network], diag);
}

static cm1e_error_t make_scheduler(run_t *run, cm1e_program_t program, cm1e_diag_t *diag)
{
    const cm1e_task_config_t task = {.program = program, .context = run};
    cm1e_error_t error = cm1e_scheduler_create(&run->scheduler, run->buses[0], NULL, diag);
    for (int i = 1; error == CM1E_OK && i < run->networks; i++)
        error = cm1e_scheduler_add_bus(run->scheduler, run->buses[i], diag);
    return error == CM1E_OK ? cm1e_scheduler_add_task(run->scheduler, &task, diag) : error;
}

bool scenario_open(run_t *run, cm1e_program_t program)
{
    cm1e_diag_t diag = {0};
    cm1e_error_t error = CM1E_OK;
    place_axes(run);
    for (int i = 0; error == CM1E_OK && i < run->networks; i++)
        error = open_network(run, i, &diag);
    if (error == CM1E_OK)
        error = make_scheduler(run, program, &diag);
    if (error == CM1E_OK)
        error = cm1e_group_create(&run->group, NULL, &diag);
    if (error != CM1E_OK) {
        scenario_fail(run, "start", "%s", diag.text);
        return false;
    }
    for (int n = 0; n < run->scenario->axis_count; n++)
        run->axes[n].reference = cm1e_scheduler_axis_by_name(run->scheduler, run->axes[n].name);
    wire_attach(run);
    return true;
}

void scenario_close(run_t *run)
{
    cm1e_scheduler_destroy(run->scheduler);
    cm1e_group_destroy(run->group);
    for (int i = 0; i < SCENARIO_NETWORKS; i++)
        cm1e_bus_close(run->buses[i]);
}
