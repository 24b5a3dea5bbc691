/** cm1e run: runs a program that `cm1e st build` has translated from Structured Text. */
#include <errno.h>
#include <inttypes.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "attach.h"
#include "cm1e/log.h"
#include "cm1e/plot.h"
#include "command.h"
#include "core/json_text.h"
#include "scheduler/scheduler_window.h"
#include "service_notify.h"
#include "st_loaded.h"
#include "trace_file.h"

enum { KEY_VIRTUAL_TIME = 0x800, KEY_CSV, KEY_SVG, KEY_HTML, KEY_LOOPS, KEY_RETAIN, KEY_COLD, KEY_VARIABLE, FILES = TRACE_HTML + 1, SAMPLES = 120000, PATHS = 64 };

typedef struct run_options {
    common_options_t common;
    const char *program, *retain;
    const char *files[FILES];
    const char *paths[PATHS];
    int path_count;
    double seconds;
    long long loops;
    bool virtual_time, cold;
} run_options_t;

static bool simulated(const char *interface_name)
{
    return strcmp(interface_name, "sim") == 0 || strncmp(interface_name, "sim:", 4) == 0;
}

static error_t parse(int key, char *arg, struct argp_state *state)
{
    run_options_t *options = state->input;
    switch (key) {
    case ARGP_KEY_INIT: return give_options(state, &options->common);
    case 's': return parse_seconds(arg, 86400, &options->seconds) ? 0 : EINVAL;
    case KEY_RETAIN:
        if (!arg[0])
            argp_error(state, "--retain needs a name; it is empty");
        options->retain = arg;
        return 0;
    case KEY_VARIABLE:
        if (options->path_count == PATHS)
            argp_error(state, "at most %d --variable", PATHS);
        options->paths[options->path_count++] = arg;
        return 0;
    case KEY_COLD: options->cold = true; return 0;
    case KEY_VIRTUAL_TIME: options->virtual_time = true; return 0;
    case KEY_LOOPS:
        return parse_number(arg, "the number of passes", 1, 1000000000, &options->loops) ? 0 : EINVAL;
    case KEY_CSV:
    case KEY_SVG:
    case KEY_HTML: options->files[key - KEY_CSV] = arg; return 0;
    case ARGP_KEY_ARG:
        if (options->program)
            argp_error(state, "one program at a time; \"%s\" is too many", arg);
        options->program = arg;
        return 0;
    case ARGP_KEY_END:
        if (!options->program)
            argp_error(state, "which program? `cm1e st build machine.st` makes machine.so");
        need_trace_files(state, options->files, FILES);
        return 0;
    default: return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_option table[] = {
    {"seconds", 's', "N", 0, "End the run after N seconds (default: Ctrl-C ends it)", 0},
    {"virtual-time", KEY_VIRTUAL_TIME, NULL, 0, "sim only: do not wait, run as fast as the machine can", 0},
    {"loop-limit", KEY_LOOPS, "N", 0, "A task that passes through loops more often in one call is stopped (1000000)", 0},
    {"retain", KEY_RETAIN, "FILE", 0, "File of the RETAIN variables (default: the program with .retain)", 0},
    {"cold-start", KEY_COLD, NULL, 0, "Begin with initial values, and replace the file of the RETAIN variables", 0},
    {"variable", KEY_VARIABLE, "NAME", 0, "A trace records this variable, or all of this instance or structure; again "
     "for more (default: the first 128)", 0},
    {"csv", KEY_CSV, "FILE", 0, "Write what the axes and variables did as CSV", 0},
    {"svg", KEY_SVG, "FILE", 0, "Write it as a plot", 0},
    {"html", KEY_HTML, "FILE", 0, "Write it as a page for a browser", 0},
    {0},
};
const struct argp argp_run = {
    table, parse, "PROGRAM.so",
    "Runs a program that `cm1e st build` has translated, on the network of the bus file. A variable of type AXIS_REF is "
    "the axis of its name. \"-i sim\" without a bus file simulates a machine with the axes of the program, whose units are "
    "revolutions. Meanwhile `cm1e monitor`, `cm1e trace` and `cm1e log` show axes and variables; errors of axes are told "
    "when they occur. An error of the "
    "program while it runs, as an index outside an array, ends the run: the axes ramp down, and are disabled.",
    common_children, NULL, NULL};

static bool is_traced(const run_options_t *options)
{
    return options->files[0] || options->files[1] || options->files[2];
}

static cm1e_error_t write_files(const cm1e_scheduler_t *scheduler, const run_options_t *options, cm1e_diag_t *diag)
{
    /* cppcheck-suppress uninitvar ; they are the three functions */
    cm1e_error_t (*const writers[FILES])(const cm1e_scheduler_t *, const char *, cm1e_diag_t *) = {
        cm1e_scheduler_write_csv, cm1e_scheduler_write_svg, cm1e_scheduler_write_html};
    cm1e_error_t error = CM1E_OK;
    for (int i = 0; i < FILES && error == CM1E_OK; i++)
        if (options->files[i])
            error = writers[i](scheduler, options->files[i], diag);
    return error;
}

/* ---- errors of axes, while the program runs ---------------------------------------------------------------------- */

/** A program that resets its axes at once could fill a disk. */
enum { TOLD_MAX = 100, LOOK_NS = 100000000 };

typedef struct teller {
    const cm1e_scheduler_t *scheduler;
    atomic_bool end;
    pthread_t thread;
    bool started;
} teller_t;

/** Tells the errors behind the record `after`, and returns the last one that was looked at. `*missed` counts those that
 *  were overwritten before. */
static uint64_t tell_errors(const cm1e_scheduler_t *scheduler, uint64_t after, unsigned *told, uint64_t *missed)
{
    cm1e_log_event_t events[16];
    size_t count;
    uint64_t lost = 0;
    while ((count = cm1e_log_read(scheduler, after, events, sizeof events / sizeof events[0], &lost)) > 0) {
        *missed += lost;
        for (size_t i = 0; i < count; i++) {
            char text[512];
            if (events[i].kind != CM1E_LOG_ERROR || *told > TOLD_MAX)
                continue;
            cm1e_log_text(scheduler, &events[i], text, sizeof text);
            fprintf(stderr, "%s: %s\n", program_invocation_name,
                    (*told)++ < TOLD_MAX ? text : "further errors of axes are not told here: `cm1e log` shows them");
        }
        after = events[count - 1].number;
    }
    return after;
}

static void *tell(void *argument)
{
    teller_t *teller = argument;
    const struct timespec pause = {.tv_nsec = LOOK_NS};
    uint64_t after = 0, missed = 0;
    unsigned told = 0;
    for (bool end = false; !end;) {
        end = atomic_load(&teller->end);
        after = tell_errors(teller->scheduler, after, &told, &missed);
        if (!end)
            nanosleep(&pause, NULL);
    }
    if (missed > 0 && told <= TOLD_MAX) /* on virtual time a moment has many cycles */
        complain("%" PRIu64 " records of the event log were overwritten before they were looked at: errors of axes among "
                 "them are not told", missed);
    return NULL;
}

/** Before the run, so that its thread does not have the priority of the cycle. */
static void begin_telling(teller_t *teller, const cm1e_scheduler_t *scheduler)
{
    sigset_t all, before;
    teller->scheduler = scheduler;
    sigfillset(&all); /* signals are for the thread that runs the cycle */
    pthread_sigmask(SIG_SETMASK, &all, &before);
    teller->started = pthread_create(&teller->thread, NULL, tell, teller) == 0;
    pthread_sigmask(SIG_SETMASK, &before, NULL);
}

static void end_telling(teller_t *teller)
{
    atomic_store(&teller->end, true);
    if (teller->started)
        pthread_join(teller->thread, NULL);
}

/* ---- the run ----------------------------------------------------------------------------------------------------- */

/** A good end in words: how long, and what ended it. */
static void tell_end(const cm1e_scheduler_t *scheduler, const run_options_t *options, const cm1e_bus_config_t *config)
{
    cm1e_scheduler_statistics_t statistics;
    cm1e_scheduler_statistics(scheduler, &statistics);
    const double ran = (double)cm1e_scheduler_time_ns(scheduler) * 1e-9;
    const bool over = cm1e_scheduler_ran_its_time(scheduler); /* the ramp of a run that a signal ended may last longer */
    if (options->common.json) {
        print_json(json_pack("{s:o, s:b, s:f, s:I, s:I, s:s}", "program", cm1e_json_text(options->program), "simulated",
                             is_simulated(config), "seconds", ran, "cycles", (json_int_t)statistics.cycles, "overruns",
                             (json_int_t)statistics.overruns, "end", over ? "time" : "signal"));
        return;
    }
    printf("%s%s ran for %.3f s, %llu cycles, %llu overruns; %s. The axes are disabled.\n", options->program,
           simulated_mark(config), ran, (unsigned long long)statistics.cycles, (unsigned long long)statistics.overruns,
           over ? "its time was over" : "a signal ended it");
}

static int run_scheduler(st_loaded_t *loaded, cm1e_scheduler_t *scheduler, const run_options_t *options,
                         const cm1e_bus_config_t *config)
{
    char text[400];
    cm1e_diag_t diag = {0};
    cm1e_scheduler_stop_on_signals(scheduler);
    teller_t teller = {.started = false};
    begin_telling(&teller, scheduler);
    service_notify("READY=1\nSTATUS=in operation");
    const cm1e_error_t ran = cm1e_scheduler_run(scheduler, (int64_t)(options->seconds * 1e9), &diag);
    service_notify("STOPPING=1");
    end_telling(&teller);
    const bool failed = ran != CM1E_OK;
    if (failed)
        fail(&diag);
    st_fault_text(loaded, text, sizeof text);
    if (text[0])
        complain("the program was stopped, and the axes with it: %s", text);
    complain_of_control(scheduler);
    const bool written = write_files(scheduler, options, &diag) == CM1E_OK;
    if (!written)
        fail(&diag);
    else if (is_traced(options))
        tell_missing_cycles(scheduler, SAMPLES);
    if (failed || text[0] || !written)
        return EXIT_FAILED;
    tell_end(scheduler, options, config);
    return EXIT_OK;
}

static int run_program(st_loaded_t *loaded, cm1e_bus_t *bus, const run_options_t *options)
{
    loaded->paths = options->paths;
    loaded->path_count = options->path_count;
    cm1e_diag_t diag = {0};
    cm1e_scheduler_t *scheduler = NULL;
    const bool traced = is_traced(options);
    const cm1e_scheduler_config_t config = {.trace_capacity = traced ? SAMPLES : 0};
    cm1e_error_t error = cm1e_scheduler_create(&scheduler, bus, &config, &diag);
    if (error == CM1E_OK)
        error = st_attach(loaded, scheduler, bus, &diag);
    if (error == CM1E_OK && loaded->untraced > 0 && traced)
        complain("the files have the first %d variables of the program; --variable NAME chooses others",
                 CM1E_TRACE_VARIABLES / 2);
    if (error == CM1E_OK && loaded->program->unlisted > 0)
        complain("others see %u variables of the program; %llu more are not listed: `cm1e st build --variables N` lists "
                 "more", loaded->program->variables.count, (unsigned long long)loaded->program->unlisted);
    const int status = error == CM1E_OK ? run_scheduler(loaded, scheduler, options, cm1e_bus_configuration(bus))
                                        : fail(&diag);
    cm1e_scheduler_destroy(scheduler);
    return status;
}

static int begin_program(st_loaded_t *loaded, const run_options_t *options)
{
    char path[4096];
    cm1e_diag_t diag = {0};
    const size_t length = strlen(options->program), ending = length > 3 && strcmp(options->program + length - 3, ".so") == 0;
    snprintf(path, sizeof path, "%.*s.retain", (int)(length - 3 * ending), options->program);
    const cm1e_error_t error = st_begin(loaded, options->retain ? options->retain : path, options->cold, &diag);
    if (error == CM1E_OK && options->retain && loaded->program->retained.count == 0)
        complain("--retain: the program has no RETAIN variables, and %s is not used", options->retain);
    if (error == CM1E_OK)
        return EXIT_OK;
    fail(&diag);
    st_retain_end(&loaded->retain, &diag);
    return EXIT_FAILED;
}

/** The network of the bus file; without one a simulated machine that has the axes of the program. */
static bool load_machine(const st_loaded_t *loaded, const run_options_t *options, cm1e_bus_config_t *config)
{
    if (!options->common.bus_file && !(options->common.interface_name && simulated(options->common.interface_name))) {
        complain("-b BUS-FILE is needed: it says which axes there are. \"-i sim\" alone simulates a machine with the axes "
                 "of the program");
        return false;
    }
    if (!load_configuration(&options->common, config))
        return false;
    if (options->common.bus_file)
        return true;
    cm1e_diag_t diag = {0};
    const bool made = st_simulated_machine(loaded, config, &diag) == CM1E_OK;
    if (!made)
        fail(&diag);
    return made;
}

static int run_on_network(st_loaded_t *loaded, const run_options_t *options)
{
    static cm1e_bus_config_t config;
    cm1e_diag_t diag = {0};
    cm1e_bus_t *bus = NULL;
    if (!load_machine(loaded, options, &config))
        return EXIT_WRONG_USE;
    if (options->virtual_time && !is_simulated(&config)) {
        complain("--virtual-time is for the simulated network; a real one needs real time");
        return EXIT_WRONG_USE;
    }
    config.virtual_time |= options->virtual_time;
    if (options->loops > 0)
        *loaded->program->loop_limit = options->loops;
    int status = begin_program(loaded, options);
    if (status != EXIT_OK) {
        cm1e_bus_config_free(&config);
        return status;
    }
    if (cm1e_bus_open(&bus, &config, &diag) != CM1E_OK || cm1e_bus_start(bus, &diag) != CM1E_OK)
        status = fail(&diag);
    else
        status = run_program(loaded, bus, options);
    cm1e_bus_config_free(&config);
    if (st_retain_end(&loaded->retain, &diag) != CM1E_OK)
        status = fail(&diag);
    return close_bus(bus, &options->common, status);
}

int command_run(int argc, char **argv)
{
    run_options_t options = {0};
    st_loaded_t loaded;
    cm1e_diag_t diag = {0};
    if (parse_options(&argp_run, argc, argv, &options))
        return EXIT_WRONG_USE;
    int status = check_trace_files(options.files, FILES);
    if (status != EXIT_OK)
        return status;
    status = st_load(&loaded, options.program, &diag) == CM1E_OK ? run_on_network(&loaded, &options) : fail_at_once(&diag);
    st_unload(&loaded);
    return status;
}
