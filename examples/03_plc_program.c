/*
 * A machine of up to three axes as a PLC would run it: two tasks, function blocks, a step sequence.
 *
 *     03_plc_program                                       three simulated axes
 *     03_plc_program -b three_axes.yaml --svg trace.svg    the axes of a bus file, and a plot of what they did
 *     03_plc_program -i eth1 -b three_axes.yaml            the same on the wire; the motors turn!
 *
 * The axes are homed, then travel back and forth together, then run at constant speed and halt. On the simulated
 * segment the motor power of one of them is switched off in the middle of a move: the sequence stops the others, resets
 * the error and goes on. On a wire nothing is broken on purpose, but whatever happens is handled in the same way.
 */
#include <argp.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cm1e/plcopen.h>
#include <cm1e/plot.h>
#include <cm1e/scheduler.h>
#include <cm1e/sim.h>
#include <cm1e/trace.h>

enum { MAX_UNITS = 3, VICTIM = 1, MAX_RESETS = 5, GUARD_S = 30, TRACE_SAMPLES = 120000 };
#define MS INT64_C(1000000) /* in ns */

/* ---- the machine ----------------------------------------------------------------------------------------------- */

typedef enum step {
    STEP_POWER = 0,
    STEP_HOME,
    STEP_OUT,
    STEP_BACK,
    STEP_TURN,  /* constant speed for a while */
    STEP_HALT,
    STEP_STOP,  /* an axis is in ErrorStop: the others stop */
    STEP_RESET,
    STEP_OFF,
    STEP_END,
} step_t;

/* One axis with its blocks, and its results for the end. */
typedef struct unit {
    AXIS_REF_t axis;
    MC_Power_t power;
    MC_ReadStatus_t status;
    MC_Home_t home;
    MC_MoveAbsolute_t out, back;
    MC_MoveVelocity_t turn;
    MC_Halt_t halt;
    MC_Stop_t stop;
    MC_Reset_t reset;

    double homed_after_s, max_velocity, max_lag;
    unsigned moves, errors;
    BOOL in_error;
    cm1e_error_t last_error;
    uint16_t last_device_error;
} unit_t;

static struct machine {
    cm1e_bus_t *bus;
    cm1e_scheduler_t *scheduler;
    unit_t units[MAX_UNITS];
    uint32_t unit_count;
    step_t step;
    int64_t step_begin_ns, end_ns;
    unsigned rounds, resets;
    BOOL homed;
    WORD refusal; /* ErrorID of a block that an axis without an error refused */
    BOOL fault_raised, fault_handled;
    char power_off[32], power_on[32]; /* lines for the simulated segment */
} m;

/* Every block is called in every cycle; the step says which of them executes. */
static void call_blocks(unit_t *u)
{
    u->power.Enable = m.step < STEP_OFF;
    u->home.Execute = m.step == STEP_HOME;
    u->out.Execute = m.step == STEP_OUT;
    u->back.Execute = m.step == STEP_BACK;
    u->turn.Execute = m.step == STEP_TURN;
    u->halt.Execute = m.step == STEP_HALT;
    u->reset.Execute = m.step == STEP_RESET;

    MC_Power(&u->power);
    MC_ReadStatus(&u->status);
    u->stop.Execute = m.step == STEP_STOP && !u->status.ErrorStop && !u->status.Disabled;

    MC_Home(&u->home);
    MC_MoveAbsolute(&u->out);
    MC_MoveAbsolute(&u->back);
    MC_MoveVelocity(&u->turn);
    MC_Halt(&u->halt);
    MC_Stop(&u->stop);
    MC_Reset(&u->reset);
}

/* ---- conditions of the sequence -------------------------------------------------------------------------------- */

typedef BOOL (*condition_t)(const unit_t *u);

static BOOL is_ready(const unit_t *u) { return u->power.Status && u->status.Standstill; }
static BOOL is_homed(const unit_t *u) { return u->home.Done; }
static BOOL is_out(const unit_t *u) { return u->out.Done; }
static BOOL is_back(const unit_t *u) { return u->back.Done; }
static BOOL is_in_velocity(const unit_t *u) { return u->turn.InVelocity; }
static BOOL is_halted(const unit_t *u) { return u->halt.Done; }
static BOOL is_in_error_stop(const unit_t *u) { return u->status.ErrorStop; }
static BOOL is_stopped(const unit_t *u) { return u->stop.Done || u->status.ErrorStop || u->status.Disabled; }
static BOOL is_reset(const unit_t *u) { return u->reset.Done || u->reset.Error; }
static BOOL is_off(const unit_t *u) { return !u->power.Status; }

static BOOL all(condition_t condition)
{
    for (uint32_t i = 0; i < m.unit_count; i++)
        if (!condition(&m.units[i]))
            return FALSE;
    return TRUE;
}

static BOOL any(condition_t condition)
{
    for (uint32_t i = 0; i < m.unit_count; i++)
        if (condition(&m.units[i]))
            return TRUE;
    return FALSE;
}

static int64_t now_ns(void) { return cm1e_scheduler_time_ns(m.scheduler); }

static BOOL step_lasts(int64_t time_ns) { return now_ns() - m.step_begin_ns >= time_ns; }

/* ---- the sequence ---------------------------------------------------------------------------------------------- */

static void go_to(step_t step)
{
    m.step = step;
    m.step_begin_ns = now_ns();
}

static void move_is_done(step_t next)
{
    for (uint32_t i = 0; i < m.unit_count; i++)
        m.units[i].moves++;
    go_to(next);
}

static void round_is_done(void)
{
    m.rounds++;
    const BOOL time_is_over = now_ns() >= m.end_ns;
    move_is_done(time_is_over ? STEP_OFF : m.rounds % 3 == 2 ? STEP_TURN : STEP_OUT);
}

static void watch_homing(void)
{
    for (uint32_t i = 0; i < m.unit_count; i++)
        if (m.units[i].home.Done && m.units[i].homed_after_s == 0)
            m.units[i].homed_after_s = (double)now_ns() * 1e-9;
    m.homed = all(is_homed);
    if (m.homed)
        go_to(STEP_OUT);
}

static void reset_is_done(void)
{
    m.resets++;
    m.fault_handled = m.fault_raised && !any(is_in_error_stop);
    go_to(m.resets < MAX_RESETS ? STEP_POWER : STEP_OFF);
}

static void run_step(void)
{
    switch (m.step) {
    case STEP_POWER:
        if (all(is_ready))
            go_to(m.homed ? STEP_BACK : STEP_HOME);
        break;
    case STEP_HOME:
        watch_homing();
        break;
    case STEP_OUT:
        if (all(is_out))
            move_is_done(STEP_BACK);
        break;
    case STEP_BACK:
        if (all(is_back))
            round_is_done();
        break;
    case STEP_TURN:
        if (all(is_in_velocity) && step_lasts(800 * MS))
            go_to(STEP_HALT);
        break;
    case STEP_HALT:
        if (all(is_halted))
            move_is_done(STEP_BACK);
        break;
    case STEP_STOP:
        if (all(is_stopped) && step_lasts(600 * MS))
            go_to(STEP_RESET);
        break;
    case STEP_RESET:
        if (all(is_reset))
            reset_is_done();
        break;
    case STEP_OFF:
        if (all(is_off))
            go_to(STEP_END);
        break;
    case STEP_END:
        cm1e_scheduler_stop(m.scheduler);
        break;
    }
}

/* A block that fails on an axis without an error had inputs that the axis cannot execute. */
static WORD refusal_of(const unit_t *u)
{
    if (u->status.ErrorStop)
        return 0;
    return u->home.ErrorID | u->out.ErrorID | u->back.ErrorID | u->turn.ErrorID | u->halt.ErrorID;
}

static void watch_errors(void)
{
    for (uint32_t i = 0; i < m.unit_count && m.refusal == 0; i++)
        m.refusal = refusal_of(&m.units[i]);
    if (m.refusal != 0 && m.step < STEP_OFF)
        go_to(STEP_OFF);
    else if (any(is_in_error_stop) && m.step < STEP_STOP)
        go_to(STEP_STOP);
}

/* Task "motion", every cycle. */
static void motion_program(void *context)
{
    (void)context;
    for (uint32_t i = 0; i < m.unit_count; i++)
        call_blocks(&m.units[i]);
    run_step();
    watch_errors();
}

/* ---- supervision ----------------------------------------------------------------------------------------------- */

static void watch_unit(unit_t *u)
{
    cm1e_axis_info_t info;
    if (cm1e_axis_read(u->axis, &info) != CM1E_OK)
        return;
    u->max_velocity = fmax(u->max_velocity, fabs(info.actual_velocity));
    if (info.state != CM1E_AXIS_HOMING) /* during homing the drive moves the axis and sets a new zero */
        u->max_lag = fmax(u->max_lag, fabs(info.position_lag));
    if (info.state == CM1E_AXIS_ERROR_STOP && !u->in_error) {
        u->errors++;
        u->last_error = info.error;
        u->last_device_error = info.device_error;
    }
    u->in_error = info.state == CM1E_AXIS_ERROR_STOP;
}

/* Switches the motor power of one axis off in the middle of a move, and on again before the reset. Only a simulated
 * segment can do that; the commands are those of `cm1e sim`. */
static void play_fault(void)
{
    char answer[128];
    if (m.unit_count <= VICTIM)
        return;
    if (!m.fault_raised && m.rounds == 3 && m.step == STEP_OUT && step_lasts(250 * MS))
        m.fault_raised = cm1e_bus_simulate(m.bus, m.power_off, answer, sizeof answer) == CM1E_OK;
    if (m.fault_raised && m.step == STEP_STOP && step_lasts(300 * MS))
        cm1e_bus_simulate(m.bus, m.power_on, answer, sizeof answer);
}

/* Task "supervision", every 10 ms. */
static void supervision_program(void *context)
{
    (void)context;
    for (uint32_t i = 0; i < m.unit_count; i++)
        watch_unit(&m.units[i]);
    play_fault();
}

/* ---- before the run -------------------------------------------------------------------------------------------- */

typedef struct options {
    const char *interface_name, *bus_file, *csv_file, *svg_file, *html_file;
    double seconds;
    bool virtual_time;
} options_t;

enum { KEY_CSV = 0x100, KEY_SVG, KEY_HTML, KEY_VIRTUAL_TIME };
static const struct argp_option option_list[] = {
    {"interface", 'i', "INTERFACE", 0, "Network interface, or sim (default: the bus file's)", 0},
    {"bus", 'b', "FILE", 0, "Bus file; needed on a network interface", 0},
    {"seconds", 's', "N", 0, "Begin no new round after N seconds (12)", 0},
    {"virtual-time", KEY_VIRTUAL_TIME, NULL, 0, "sim only: do not wait, run as fast as the machine can", 0},
    {"csv", KEY_CSV, "FILE", 0, "Write what the axes did as CSV", 0},
    {"svg", KEY_SVG, "FILE", 0, "Write what the axes did as a plot", 0},
    {"html", KEY_HTML, "FILE", 0, "Write what the axes did as a page for a browser, with the steps of the program", 0},
    {0},
};

static error_t parse_option(int key, char *arg, struct argp_state *state)
{
    options_t *options = state->input;
    char *end = NULL;
    switch (key) {
    case 'i': options->interface_name = arg; break;
    case 'b': options->bus_file = arg; break;
    case KEY_CSV: options->csv_file = arg; break;
    case KEY_SVG: options->svg_file = arg; break;
    case KEY_HTML: options->html_file = arg; break;
    case KEY_VIRTUAL_TIME: options->virtual_time = true; break;
    case 's':
        options->seconds = strtod(arg, &end);
        if (*end != '\0' || !(options->seconds > 0 && options->seconds <= 86400))
            argp_error(state, "--seconds takes a number above 0, up to 86400; found \"%s\"", arg);
        break;
    case ARGP_KEY_END:
        if (options->interface_name && !options->interface_name[0])
            argp_error(state, "-i needs a name; it is empty");
        if (options->interface_name && strcmp(options->interface_name, "sim") != 0 && !options->bus_file)
            argp_error(state, "a network interface needs a bus file: -b FILE says which motors hang there");
        break;
    case ARGP_KEY_ARG: argp_usage(state); break;
    default: return ARGP_ERR_UNKNOWN;
    }
    return 0;
}

/* Without a bus file: three linear axes in mm, homed in three ways. */
static cm1e_error_t describe_default(cm1e_bus_config_t *config, cm1e_diag_t *why)
{
    static const cm1e_homing_config_t homing[MAX_UNITS] = {
        {.method = -2, .offset = 10, .velocity = 20, .acceleration = 400}, /* hard stop, CCW */
        {.method = -6, .offset = 5, .velocity = 20, .acceleration = 400},  /* sensor at input 3, CCW */
        {.method = -3, .offset = -5, .velocity = 20, .acceleration = 400}, /* sensor at input 2, CW */
    };
    const cm1e_error_t error = cm1e_bus_config_init(config, "sim", MAX_UNITS);
    if (error != CM1E_OK)
        return cm1e_diag_set(why, error, 0, "%s", cm1e_strerror(error));
    for (uint32_t i = 0; i < MAX_UNITS; i++) {
        snprintf(config->axes[i].name, sizeof config->axes[i].name, "%c", "XYZ"[i]);
        config->axes[i].counts_per_unit = 5000;
        config->axes[i].homing = homing[i];
    }
    return CM1E_OK;
}

static cm1e_error_t describe(cm1e_bus_config_t *config, const options_t *options, cm1e_diag_t *why)
{
    const cm1e_error_t error = options->bus_file ? cm1e_bus_config_load(config, options->bus_file, why)
                                                 : describe_default(config, why);
    if (error != CM1E_OK)
        return error;
    if (options->interface_name)
        snprintf(config->interface_name, sizeof config->interface_name, "%s", options->interface_name);
    config->virtual_time = config->virtual_time || options->virtual_time;
    for (uint32_t i = 0; i < config->axis_count && i < MAX_UNITS; i++)
        if (config->axes[i].homing.method == 0)
            return cm1e_diag_set(why, CM1E_ERROR_CONFIG, 0, "Axis %u has no homing.method in the bus file.", i + 1);
    return CM1E_OK;
}

/* The distances differ, the times do not: dynamics in proportion to the distance let all axes arrive together. */
static void make_unit(unit_t *u, const cm1e_axis_config_t *config, double counts)
{
    const double counts_per_unit = config->counts_per_unit > 0 ? config->counts_per_unit : 50000;
    const BOOL homes_clockwise = config->homing.method % 2 != 0;
    const double way = counts / counts_per_unit; /* away from the end at which the axis was homed */
    const double target = homes_clockwise == (config->invert ? TRUE : FALSE) ? way : -way;
    const MC_MoveAbsolute_t move = {.Axis = &u->axis, .Velocity = 2 * way, .Acceleration = 16 * way,
                                    .Deceleration = 16 * way, .Jerk = 300 * way};
    u->power = (MC_Power_t){.Axis = &u->axis, .EnablePositive = TRUE, .EnableNegative = TRUE};
    u->status = (MC_ReadStatus_t){.Axis = &u->axis, .Enable = TRUE};
    u->home = (MC_Home_t){.Axis = &u->axis};
    u->out = u->back = move;
    u->out.Position = target;
    u->back.Position = 0;
    u->turn = (MC_MoveVelocity_t){.Axis = &u->axis, .Velocity = target / 2};
    u->halt = (MC_Halt_t){.Axis = &u->axis};
    u->stop = (MC_Stop_t){.Axis = &u->axis};
    u->reset = (MC_Reset_t){.Axis = &u->axis};
}

static void make_machine(const cm1e_bus_config_t *config, double seconds)
{
    static const double counts[MAX_UNITS] = {200000, 150000, 100000};
    m.unit_count = config->axis_count < MAX_UNITS ? config->axis_count : MAX_UNITS;
    m.end_ns = (int64_t)(seconds * 1e9);
    for (uint32_t i = 0; i < m.unit_count; i++) {
        m.units[i].axis = cm1e_scheduler_axis(m.scheduler, i);
        make_unit(&m.units[i], &config->axes[i], counts[i]);
    }
    const unsigned position = cm1e_bus_axis_position(m.bus, VICTIM);
    snprintf(m.power_off, sizeof m.power_off, "power %u off", position);
    snprintf(m.power_on, sizeof m.power_on, "power %u on", position);
}

static cm1e_error_t add_tasks(cm1e_diag_t *why)
{
    const cm1e_task_config_t motion = {.name = "motion", .priority = 0, .program = motion_program};
    const cm1e_task_config_t supervision = {
        .name = "supervision", .priority = 1, .interval_ns = 10 * MS, .program = supervision_program};
    const cm1e_error_t error = cm1e_scheduler_add_task(m.scheduler, &motion, why);
    return error == CM1E_OK ? cm1e_scheduler_add_task(m.scheduler, &supervision, why) : error;
}

/* Before anything moves. */
static cm1e_error_t check_files(const options_t *options, cm1e_diag_t *why)
{
    const char *const files[] = {options->csv_file, options->svg_file, options->html_file};
    cm1e_error_t error = CM1E_OK;
    for (int i = 0; i < 3 && error == CM1E_OK; i++)
        if (files[i])
            error = cm1e_scheduler_check_path(files[i], why);
    return error;
}

/* What a trace has of the program beside the axes: its own, and that of `cm1e trace` while it runs. */
static cm1e_error_t trace_variables(cm1e_diag_t *why)
{
    cm1e_error_t error = cm1e_scheduler_trace_variable(m.scheduler, "step", "", CM1E_TRACE_UDINT, &m.step, why);
    if (error == CM1E_OK)
        error = cm1e_scheduler_trace_variable(m.scheduler, "homed", "", CM1E_TRACE_BOOL, &m.homed, why);
    return error;
}

static cm1e_error_t start(const options_t *options, cm1e_diag_t *why)
{
    cm1e_bus_config_t config = {0};
    cm1e_error_t error = check_files(options, why);
    if (error == CM1E_OK)
        error = describe(&config, options, why);
    if (error == CM1E_OK)
        error = cm1e_bus_open(&m.bus, &config, why);
    cm1e_bus_config_free(&config); /* the bus has a copy */
    if (error == CM1E_OK)
        error = cm1e_bus_start(m.bus, why);
    if (error != CM1E_OK)
        return error;
    const double cycles = (options->seconds + GUARD_S) * 1e9 / (double)cm1e_bus_configuration(m.bus)->cycle_time_ns;
    const cm1e_scheduler_config_t scheduler = {
        .trace_capacity = options->csv_file || options->svg_file || options->html_file ? TRACE_SAMPLES : 0,
        .trace_every = 1 + (uint32_t)(cycles / TRACE_SAMPLES),
    };
    error = cm1e_scheduler_create(&m.scheduler, m.bus, &scheduler, why);
    if (error != CM1E_OK)
        return error;
    make_machine(cm1e_bus_configuration(m.bus), options->seconds);
    error = trace_variables(why);
    return error == CM1E_OK ? add_tasks(why) : error;
}

/* ---- after the run --------------------------------------------------------------------------------------------- */

static void print_unit(const unit_t *u)
{
    cm1e_axis_info_t info = {0};
    char error[160] = "-", homed[24] = "no";
    cm1e_axis_read(u->axis, &info);
    if (u->homed_after_s > 0)
        snprintf(homed, sizeof homed, "after %.2f s", u->homed_after_s);
    if (u->errors > 0)
        snprintf(error, sizeof error, "%s (0x%04X)", cm1e_strerror(u->last_error), u->last_device_error);
    printf("%-10s %-14s %5u %12.2f %10.3f %10.3f  %-11s %6u  %s\n", cm1e_axis_name(u->axis), homed, u->moves,
           u->max_velocity, u->max_lag, info.actual_position, cm1e_axis_state_name(info.state), u->errors, error);
}

static void print_distribution(const char *name, const cm1e_distribution_t *d)
{
    const double average_us = d->count ? (double)d->sum_ns / (double)d->count * 1e-3 : 0;
    printf("%-16s %9.1f %9.1f %9.1f us\n", name, (double)d->minimum_ns * 1e-3, average_us,
           (double)d->maximum_ns * 1e-3);
}

static void print_report(void)
{
    cm1e_scheduler_statistics_t s;
    cm1e_scheduler_statistics(m.scheduler, &s);
    printf("%-10s %-14s %5s %12s %10s %10s  %-11s %6s  %s\n", "axis", "homed", "moves", "max u/s", "max lag u", "at u",
           "state", "errors", "last error");
    for (uint32_t i = 0; i < m.unit_count; i++)
        print_unit(&m.units[i]);
    if (m.fault_raised)
        printf("\nThe motor power of %s was switched off in a move: %s.\n", cm1e_axis_name(m.units[VICTIM].axis),
               m.fault_handled ? "noticed, the others stopped, reset, went on" : "not reset");
    if (m.refusal != 0)
        printf("\nA block was refused: %s.\n", cm1e_strerror(cm1e_error_from_id(m.refusal)));
    printf("\n%-16s %9s %9s %9s\n", "", "minimum", "average", "maximum");
    print_distribution("cycle time", &s.cycle_time);
    print_distribution("wake-up latency", &s.wake_up_latency);
    print_distribution("execution time", &s.execution_time);
    printf("%llu cycles, %llu overruns, %llu frames lost, %llu working counter errors%s\n",
           (unsigned long long)s.cycles, (unsigned long long)s.overruns, (unsigned long long)s.bus.lost_frames,
           (unsigned long long)s.bus.working_counter_errors, s.realtime ? ", in real time" : "");
    if (s.advice[0])
        printf("%s\n", s.advice);
}

/* Whether everything went as intended. */
static BOOL machine_did_well(void)
{
    for (uint32_t i = 0; i < m.unit_count; i++)
        if (m.units[i].errors != (i == VICTIM && m.fault_raised ? 1u : 0u))
            return FALSE;
    return m.homed && m.rounds > 0 && m.refusal == 0 && m.fault_handled == m.fault_raised && m.step == STEP_END;
}

static cm1e_error_t write_trace(const options_t *options, cm1e_diag_t *why)
{
    cm1e_error_t error = CM1E_OK;
    if (options->csv_file)
        error = cm1e_scheduler_write_csv(m.scheduler, options->csv_file, why);
    if (error == CM1E_OK && options->svg_file)
        error = cm1e_scheduler_write_svg(m.scheduler, options->svg_file, why);
    if (error == CM1E_OK && options->html_file)
        error = cm1e_scheduler_write_html(m.scheduler, options->html_file, why);
    return error;
}

static cm1e_error_t run(const options_t *options, cm1e_diag_t *why)
{
    cm1e_error_t error = start(options, why);
    if (error != CM1E_OK)
        return error;
    cm1e_scheduler_stop_on_signals(m.scheduler); /* Ctrl-C ramps down and disables */
    error = cm1e_scheduler_run(m.scheduler, m.end_ns + GUARD_S * 1000 * MS, why);
    print_report();
    return error == CM1E_OK ? write_trace(options, why) : error;
}

int main(int argc, char **argv)
{
    static const struct argp argp = {option_list, parse_option, NULL,
                                     "Three axes as a PLC would run them: home, move, meet a fault, go on.", NULL, NULL,
                                     NULL};
    options_t options = {.seconds = 12};
    cm1e_diag_t why = {0};
    argp_parse(&argp, argc, argv, 0, NULL, &options);
    const cm1e_error_t error = run(&options, &why);
    if (error != CM1E_OK)
        fprintf(stderr, "%s\n", why.text);
    else if (m.step != STEP_END)
        fprintf(stderr, "Interrupted before its end.\n");
    cm1e_scheduler_destroy(m.scheduler);
    cm1e_bus_close(m.bus);
    return error == CM1E_OK && machine_did_well() ? EXIT_SUCCESS : EXIT_FAILURE;
}
