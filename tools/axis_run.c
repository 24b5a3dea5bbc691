#include "axis_run.h"

#include <pthread.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "attach.h"

enum { WATCH_NS = 50000000, BAR = 30, SIM_PART = 100, DEFAULT_CYCLE_NS = 1000000 };

/* ---- timing ------------------------------------------------------------------------------------------------------ */

static cm1e_scheduler_statistics_t statistics; /* of the last run */

static double in_us(int64_t ns) { return (double)ns * 1e-3; }

json_t *timing_as_json(void)
{
    return json_pack("{s:I, s:I, s:I, s:f, s:f, s:b, s:s}", "cycles", (json_int_t)statistics.cycles, "overruns",
                     (json_int_t)statistics.overruns, "lost_frames", (json_int_t)statistics.bus.lost_frames,
                     "longest_cycle_us", in_us(statistics.cycle_time.maximum_ns), "longest_latency_us",
                     in_us(statistics.wake_up_latency.maximum_ns), "realtime", statistics.realtime, "advice",
                     statistics.advice);
}

/** What happened to the timing, if it mattered: cycles that ran over, frames lost, or half a cycle late. A simulated
 *  motor does not mind: there only one cycle of a hundred is worth a word. */
static void tell_timing(const cm1e_bus_config_t *config)
{
    const cm1e_scheduler_statistics_t *s = &statistics;
    const int64_t cycle_ns = config->cycle_time_ns ? config->cycle_time_ns : DEFAULT_CYCLE_NS;
    const bool mattered = is_simulated(config) ? s->overruns > s->cycles / SIM_PART
                                               : s->overruns > 0 || s->wake_up_latency.maximum_ns > cycle_ns / 2;
    if (!mattered && s->bus.lost_frames == 0)
        return;
    complain("timing: of %llu cycles %llu ran over, %llu frames were lost; the longest wake-up latency was %.0f us, "
             "the longest time between cycles %.0f us, at a cycle time of %.0f us", (unsigned long long)s->cycles,
             (unsigned long long)s->overruns, (unsigned long long)s->bus.lost_frames,
             in_us(s->wake_up_latency.maximum_ns), in_us(s->cycle_time.maximum_ns), in_us(cycle_ns));
    if (s->bus.lost_frames > s->overruns) /* more than a machine that was late can have lost */
        complain("advice: look at cables and connectors, at other programs on the interface, and at the settings of "
                 "the network card (docs/REALTIME.md)");
    if (s->overruns == 0 && s->bus.lost_frames > 0)
        return;
    complain("advice: %s", s->advice[0] ? s->advice : "give the machine a real-time kernel, or the cycle a processor of "
                                                      "its own (docs/REALTIME.md)");
}

/* ---- progress ---------------------------------------------------------------------------------------------------- */

void progress_show(progress_t *progress)
{
    if (!isatty(STDERR_FILENO))
        return;
    const double position = progress->position, seconds = progress->seconds, way = progress->to - progress->from;
    char bar[2 * BAR + 3] = "";
    static const char marks[] = "==============================", blanks[] = "                              ";
    if (way != 0) {
        const double part = (position - progress->from) / way;
        const int full = part < 0 ? 0 : part > 1 ? BAR : (int)(part * BAR + 0.5);
        snprintf(bar, sizeof bar, "[%s%s]", marks + BAR - full, blanks + full);
    }
    fprintf(stderr, "\r\033[K%s: %12.6g  %6.1f s  %s", progress->name, position, seconds, bar);
    fflush(stderr);
    progress->shown = true;
}

void progress_clear(progress_t *progress)
{
    if (progress->shown)
        fputs("\r\033[K", stderr);
    fflush(stderr);
}

/* ---- the axis ---------------------------------------------------------------------------------------------------- */

error_t parse_axis_word(char *arg, struct argp_state *state, const char **word)
{
    if (*word)
        argp_error(state, "one axis at a time; \"%s\" is too many", arg);
    *word = arg;
    return 0;
}

int load_one_axis(const common_options_t *options, const char *word, cm1e_bus_config_t *config, uint32_t *number)
{
    const int loaded = load_axes(options, config);
    if (loaded != EXIT_OK)
        return loaded;
    const int axis = find_axis(config, word ? word : "1");
    if (axis < 0)
        return EXIT_WRONG_USE;
    *number = (uint32_t)axis;
    return EXIT_OK;
}

void take_axis(cm1e_scheduler_t *scheduler, uint32_t number, AXIS_REF_t *axis, MC_Power_t *power, progress_t *progress)
{
    *axis = cm1e_scheduler_axis(scheduler, number);
    *power = (MC_Power_t){.Axis = axis, .EnablePositive = TRUE, .EnableNegative = TRUE};
    progress->name = cm1e_axis_name(*axis);
}

/* ---- the run ----------------------------------------------------------------------------------------------------- */

typedef struct watcher {
    const axis_run_t *run;
    atomic_bool end;
} watcher_t;

static void *watch(void *argument)
{
    watcher_t *watcher = argument;
    const struct timespec pause = {.tv_nsec = WATCH_NS};
    while (!watcher->end) {
        watcher->run->watch(watcher->run->context, false);
        nanosleep(&pause, NULL);
    }
    watcher->run->watch(watcher->run->context, true);
    return NULL;
}

static int run_cycles(const axis_run_t *run, cm1e_scheduler_t *scheduler, cm1e_diag_t *diag)
{
    const cm1e_task_config_t task = {.name = run->what, .program = run->program, .context = run->context};
    watcher_t watcher = {.run = run};
    pthread_t thread;
    run->prepare(scheduler, run->context);
    cm1e_scheduler_stop_on_signals(scheduler);
    if (cm1e_scheduler_add_task(scheduler, &task, diag) != CM1E_OK)
        return fail(diag);
    const bool watched = run->watch && pthread_create(&thread, NULL, watch, &watcher) == 0;
    const cm1e_error_t error = cm1e_scheduler_run(scheduler, 0, diag);
    watcher.end = true;
    if (watched)
        pthread_join(thread, NULL);
    cm1e_scheduler_statistics(scheduler, &statistics);
    return error == CM1E_OK ? EXIT_OK : fail(diag);
}

static int run_on_bus(const axis_run_t *run, const cm1e_bus_config_t *config, cm1e_bus_t *bus)
{
    cm1e_diag_t diag = {0};
    cm1e_scheduler_t *scheduler = NULL;
    if (cm1e_scheduler_create(&scheduler, bus, &run->settings, &diag) != CM1E_OK)
        return fail(&diag);
    int status = run_cycles(run, scheduler, &diag);
    const int reported = run->report(run->context);
    if (reported != EXIT_OK)
        status = reported;
    tell_timing(config);
    complain_of_control(scheduler);
    if (run->keep && !run->keep(scheduler, run->context))
        status = EXIT_FAILED;
    cm1e_scheduler_destroy(scheduler);
    return status;
}

int run_on_axes(const axis_run_t *run, const common_options_t *options, cm1e_bus_config_t *config)
{
    cm1e_diag_t diag = {0};
    cm1e_bus_t *bus = NULL;
    int status;
    config->virtual_time &= !run->by_person;
    const bool open = cm1e_bus_open(&bus, config, &diag) == CM1E_OK;
    const int ready = open && run->ready ? run->ready(bus, run->context) : EXIT_OK;
    if (ready != EXIT_OK)
        status = ready;
    else if (!open || cm1e_bus_start(bus, &diag) != CM1E_OK)
        status = fail(&diag);
    else
        status = run_on_bus(run, config, bus);
    return close_bus(bus, options, status);
}
