#include "cm1e/scheduler.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "assembly/assembly.h"
#include "axis/axis_api.h"
#include "bus/bus_image.h"
#include "bus/kept.h"
#include "cm1e/scan_time.h"
#include "core/in_task.h"
#include "core/output.h"
#include "core/sized.h"
#include "scheduler/clock_team.h"
#include "scheduler/event_log.h"
#include "scheduler/forcing.h"
#include "scheduler/realtime.h"
#include "scheduler/scheduler_window.h"
#include "scheduler/signals.h"
#include "scheduler/statistics.h"
#include "scheduler/tasks.h"
#include "scheduler/trace_recorder.h"

#define DEFAULT_STOP_TIMEOUT_NS INT64_C(10000000000)

/** A bus of the scheduler, and its axes. */
typedef struct member {
    cm1e_bus_t *bus;
    uint32_t operation;     /**< start number of the bus for which the axes were made */
    uint32_t first, end;    /**< its axes: axes[first] ... axes[end - 1] */
    cm1e_error_t received;  /**< in this cycle */
} member_t;

struct cm1e_scheduler {
    member_t members[CM1E_MAX_BUSES];
    uint32_t member_count;  /**< at least 1; members[0] is the bus that the scheduler was made for */
    clock_team_t clocks;    /**< of these buses, in their order */
    cm1e_clock_t *clock;
    cm1e_scheduler_config_t config;
    int64_t cycle_time_ns;
    cm1e_axis_t *axes[CM1E_MAX_AXES];
    uint32_t axis_count;
    task_list_t tasks;
    trace_t trace;
    forcing_t forcing;
    log_t log;
    void *windows[CM1E_MAX_BUSES][CM1E_WINDOWS]; /**< of this run, by bus and kind; NULL: it has none */
    statistics_t statistics;
    cm1e_bus_counters_t counters; /**< of all buses together, after this cycle */
    atomic_bool stop;      /**< a stop was requested */
    bool run;              /**< cm1e_scheduler_run() was called */
    bool shutting_down;    /**< programs no longer run */
    const char *refused;   /**< function that a task called and that would have freed what the cycle uses; NULL: none */
    bool shut_down;        /**< every drive is disabled or offline */
    int64_t start_ns;      /**< of cycle 0 */
    int64_t number;        /**< number of this cycle; skipped cycles count */
    int64_t begin_ns;      /**< actual start of this cycle */
    int64_t sent_ns;       /**< time of the outputs of the last cycle */
};

/* ---- windows --------------------------------------------------------------------------------------------------- */

static const cm1e_window_t *kinds[CM1E_WINDOWS];

bool cm1e_scheduler_register_window(const cm1e_window_t *window)
{
    for (int i = 0; i < CM1E_WINDOWS; i++) {
        if (!kinds[i])
            kinds[i] = window;
        if (kinds[i] == window)
            return true;
    }
    return false;
}

static void open_windows(cm1e_scheduler_t *s)
{
    statistics_t *statistics = &s->statistics;
    cm1e_window_told_t told = {.socket = statistics->control_socket, .socket_size = sizeof statistics->control_socket,
                               .advice = statistics->control_advice, .advice_size = sizeof statistics->control_advice};
    char path[sizeof statistics->control_socket], advice[sizeof statistics->control_advice];
    cm1e_window_told_t untold = {path, advice, sizeof path, sizeof advice}; /* the statistics have the first socket */
    for (uint32_t bus = 0; bus < s->member_count; bus++)
        for (int i = 0; i < CM1E_WINDOWS; i++)
            s->windows[bus][i] = kinds[i] ? kinds[i]->open(s, bus, bus ? &untold : &told) : NULL;
}

static void close_windows(cm1e_scheduler_t *s)
{
    for (uint32_t bus = 0; bus < s->member_count; bus++)
        for (int i = 0; i < CM1E_WINDOWS; i++)
            if (s->windows[bus][i])
                kinds[i]->close(s->windows[bus][i]);
    memset(s->windows, 0, sizeof s->windows);
}

cm1e_axis_t *const *cm1e_scheduler_axes(const cm1e_scheduler_t *scheduler, uint32_t *count)
{
    *count = scheduler->axis_count;
    return scheduler->axes;
}

cm1e_axis_t *const *cm1e_scheduler_axes_at(const cm1e_scheduler_t *scheduler, uint32_t bus, uint32_t *first,
                                           uint32_t *count)
{
    const member_t *member = &scheduler->members[bus];
    *first = member->first;
    *count = member->end - member->first;
    return scheduler->axes + member->first;
}

cm1e_bus_t *cm1e_scheduler_bus(const cm1e_scheduler_t *scheduler) { return scheduler->members[0].bus; }

cm1e_bus_t *cm1e_scheduler_bus_at(const cm1e_scheduler_t *scheduler, uint32_t index)
{
    return index < scheduler->member_count ? scheduler->members[index].bus : NULL;
}

bool cm1e_scheduler_is_ending(const cm1e_scheduler_t *scheduler) { return scheduler->shutting_down; }

bool cm1e_scheduler_is_virtual(const cm1e_scheduler_t *scheduler)
{
    return scheduler->clock != cm1e_clock_monotonic();
}

size_t cm1e_log_read(const cm1e_scheduler_t *scheduler, uint64_t after, cm1e_log_event_t *events, size_t room,
                     uint64_t *lost)
{
    return cm1e_log_copy(&scheduler->log, after, events, room, lost);
}

/* ---- the cycle ------------------------------------------------------------------------------------------------- */

static int64_t planned_ns(const cm1e_scheduler_t *s, int64_t number) { return s->start_ns + number * s->cycle_time_ns; }

static void take_inputs(cm1e_scheduler_t *s, const member_t *member)
{
    const cm1e_error_t health = cm1e_bus_health(member->bus);
    for (uint32_t i = member->first; i < member->end; i++)
        cm1e_axis_inputs(s->axes[i], member->received, health, planned_ns(s, s->number));
}

/** The frames of all buses were sent before the first of them is waited for. */
static void receive_all(cm1e_scheduler_t *s)
{
    for (uint32_t i = 0; i < s->member_count; i++)
        s->members[i].received = cm1e_bus_receive(s->members[i].bus);
    for (uint32_t i = 0; i < s->member_count; i++)
        take_inputs(s, &s->members[i]);
}

static void send_all(cm1e_scheduler_t *s)
{
    for (uint32_t i = 0; i < s->member_count; i++)
        cm1e_bus_send(s->members[i].bus);
}

static void shut_down_axes(cm1e_scheduler_t *s)
{
    s->shut_down = true;
    for (uint32_t i = 0; i < s->member_count; i++)
        cm1e_bus_release_outputs(s->members[i].bus);
    for (uint32_t i = 0; i < s->axis_count; i++)
        s->shut_down &= cm1e_axis_shut_down(s->axes[i]);
}

/** Number of the cycle to whose time a moment belongs. */
static int64_t cycle_of(const cm1e_scheduler_t *s, int64_t time_ns) { return (time_ns - s->start_ns) / s->cycle_time_ns; }

/** After a few missed cycles the motor has hardly slowed down; after more it is at rest (CSP). */
static void after_missed(cm1e_axis_t *axis, int64_t missed, int64_t silence_ns)
{
    if (missed > CM1E_AXIS_RIDDEN_OUT_CYCLES)
        cm1e_axis_after_pause(axis, silence_ns);
    else
        cm1e_axis_hold_cycle(axis, missed);
}

static void set_outputs(cm1e_scheduler_t *s)
{
    const int64_t now_ns = cm1e_clock_now(s->clock), silence_ns = now_ns - s->sent_ns - s->cycle_time_ns;
    const int64_t missed = cycle_of(s, now_ns) - cycle_of(s, s->sent_ns) - 1; /* cycles in which no frame was sent */
    s->sent_ns = now_ns;
    for (uint32_t i = 0; i < s->axis_count && missed > 0; i++)
        after_missed(s->axes[i], missed, silence_ns);
    if (s->member_count > 1)
        cm1e_axis_meet(s->axes, s->axis_count);
    for (uint32_t i = 0; i < s->axis_count; i++)
        cm1e_axis_outputs(s->axes[i]);
}

/** A task called a function that would free what it runs on: the run ends in order instead. */
static void run_tasks(cm1e_scheduler_t *s)
{
    cm1e_in_task_begin();
    cm1e_tasks_run(&s->tasks, s->number);
    cm1e_in_task_end();
    const char *function = cm1e_in_task_noted();
    if (!function)
        return;
    s->refused = s->refused ? s->refused : function;
    cm1e_scheduler_stop(s);
}

/** The plan follows the reference clock of one bus, and what was planned before moves with it. */
static void follow_clock(cm1e_scheduler_t *s)
{
    const int64_t later_ns = cm1e_clock_team_pace(&s->clocks);
    s->start_ns += later_ns;
    s->sent_ns += later_ns;
}

/** receive -> inputs -> programs -> axes -> outputs -> send. At the end of a run the shut-down of the axes replaces the
 *  programs. */
static void scan(cm1e_scheduler_t *s)
{
    receive_all(s);
    cm1e_scan_time_set(planned_ns(s, s->number));
    if (s->shutting_down)
        shut_down_axes(s);
    else
        run_tasks(s);
    set_outputs(s);
    send_all(s);
    follow_clock(s);
}

static void count_overrun(cm1e_scheduler_t *s)
{
    atomic_fetch_add_explicit(&s->statistics.overruns, 1, memory_order_relaxed);
    s->trace.timing.overruns++;
}

/** Waits for the planned start. A thread that wakes up one cycle late or more continues with the present cycle. */
static void wait_for_start(cm1e_scheduler_t *s)
{
    cm1e_clock_sleep_until(s->clock, planned_ns(s, s->number));
    const int64_t now_ns = cm1e_clock_now(s->clock);
    const int64_t missed = (now_ns - planned_ns(s, s->number)) / s->cycle_time_ns;
    if (s->statistics.cycles > 0)
        cm1e_distribution_add(&s->statistics.cycle_time, now_ns - s->begin_ns);
    cm1e_distribution_add(&s->statistics.wake_up_latency, now_ns - planned_ns(s, s->number));
    s->trace.timing.wake_up_latency_us = (double)(now_ns - planned_ns(s, s->number)) * 1e-3;
    s->begin_ns = now_ns;
    if (missed > 0) {
        s->number += missed;
        count_overrun(s);
    }
}

/** The next cycle is the first one whose start is in the future: missed cycles are skipped, never executed in a
 *  burst. */
static void end_cycle(cm1e_scheduler_t *s)
{
    const int64_t end_ns = cm1e_clock_now(s->clock);
    cm1e_distribution_add(&s->statistics.execution_time, end_ns - s->begin_ns);
    cm1e_statistics_note_bus(&s->statistics, &s->counters);
    s->trace.timing.execution_time_us = (double)(end_ns - s->begin_ns) * 1e-3;
    atomic_fetch_add_explicit(&s->statistics.cycles, 1, memory_order_relaxed);
    s->number++;
    if (end_ns <= planned_ns(s, s->number))
        return;
    count_overrun(s);
    s->number = (end_ns - s->start_ns + s->cycle_time_ns - 1) / s->cycle_time_ns;
}

/** Of all buses together. */
static void add_up_counters(cm1e_scheduler_t *s)
{
    s->counters = *cm1e_bus_counters(s->members[0].bus);
    for (uint32_t i = 1; i < s->member_count; i++) {
        const cm1e_bus_counters_t *more = cm1e_bus_counters(s->members[i].bus);
        s->counters.lost_frames += more->lost_frames;
        s->counters.working_counter_errors += more->working_counter_errors;
        s->counters.late_frames += more->late_frames;
        s->counters.foreign_frames += more->foreign_frames;
        s->counters.unsent_frames += more->unsent_frames;
        s->counters.mailbox_retries += more->mailbox_retries;
    }
}

/** What others see of a cycle. */
static void show(cm1e_scheduler_t *s)
{
    const uint64_t overruns = atomic_load_explicit(&s->statistics.overruns, memory_order_relaxed);
    cm1e_bus_clocks_t clocks;
    cm1e_clock_team_look(&s->clocks, &clocks);
    cm1e_statistics_note_clocks(&s->statistics, &clocks);
    add_up_counters(s);
    s->trace.timing.lost_frames = s->counters.lost_frames;
    cm1e_trace_record(&s->trace, s->axes, cm1e_scheduler_time_ns(s));
    cm1e_log_look(&s->log, s->axes, s->axis_count, overruns, &s->counters, clocks.sync_losses,
                  cm1e_scheduler_time_ns(s));
    for (uint32_t i = 0; i < s->member_count; i++) {
        cm1e_log_emergencies(&s->log, s->members[i].bus, i, cm1e_scheduler_time_ns(s));
        cm1e_log_ports(&s->log, s->members[i].bus, i, cm1e_scheduler_time_ns(s));
        cm1e_log_ring(&s->log, s->members[i].bus, i, cm1e_scheduler_time_ns(s));
        cm1e_log_presence(&s->log, s->members[i].bus, i, cm1e_scheduler_time_ns(s));
    }
    for (uint32_t bus = 0; bus < s->member_count; bus++)
        for (int i = 0; i < CM1E_WINDOWS; i++)
            if (s->windows[bus][i])
                kinds[i]->cycle(s->windows[bus][i]);
}

static void cycle(cm1e_scheduler_t *s)
{
    wait_for_start(s);
    scan(s);
    show(s);
    end_cycle(s);
}

/* ---- a run ----------------------------------------------------------------------------------------------------- */

static bool stop_asked(const cm1e_scheduler_t *s) { return atomic_load_explicit(&s->stop, memory_order_relaxed); }

static cm1e_error_t shut_down(cm1e_scheduler_t *s, cm1e_diag_t *diag)
{
    const int64_t begin_ns = cm1e_scheduler_time_ns(s);
    s->shutting_down = true;
    while (!s->shut_down && cm1e_scheduler_time_ns(s) - begin_ns <= s->config.stop_timeout_ns)
        cycle(s);
    if (s->shut_down && s->refused)
        return cm1e_diag_set(diag, CM1E_ERROR_STATE, 0,
                             "%s was called in a task, where it is refused, because it frees or stops what the cycle "
                             "uses. The run was ended in order instead; use cm1e_scheduler_stop() in a task.",
                             s->refused);
    if (s->shut_down)
        return CM1E_OK;
    return cm1e_diag_set(diag, CM1E_ERROR_TIMEOUT, 0,
                         "The axes were not at rest and disabled within %.1f s after the stop; the bus was stopped "
                         "nevertheless.", (double)s->config.stop_timeout_ns * 1e-9);
}

static cm1e_error_t take_real_time(cm1e_scheduler_t *s, realtime_t *realtime, cm1e_diag_t *diag)
{
    char advice[sizeof s->statistics.advice] = "";
    const bool is_virtual = s->clock != cm1e_clock_monotonic();
    const bool in_force = !is_virtual && cm1e_realtime_begin(realtime, &s->config, advice, sizeof advice);
    cm1e_statistics_publish_realtime(&s->statistics, in_force, advice);
    if (s->config.realtime_required && advice[0])
        return cm1e_diag_set(diag, CM1E_ERROR_PERMISSION, 0, "%s", advice);
    return CM1E_OK;
}

/** From now on (`on`) other threads that wait for a bus leave its cycles to this one. */
static void drive_buses(cm1e_scheduler_t *s, bool on)
{
    for (uint32_t i = 0; i < s->member_count; i++)
        cm1e_bus_drive(s->members[i].bus, on);
}

static cm1e_error_t run(cm1e_scheduler_t *s, int64_t duration_ns, cm1e_diag_t *diag)
{
    realtime_t realtime = {0};
    cm1e_clock_team_begin(&s->clocks);
    drive_buses(s, true);
    open_windows(s);
    cm1e_error_t error = take_real_time(s, &realtime, diag);
    if (error == CM1E_OK) {
        s->start_ns = s->sent_ns = cm1e_bus_next_start(clock_team_leader(&s->clocks), cm1e_clock_now(s->clock));
        cm1e_log_run(&s->log, true, 0);
        while (!stop_asked(s) && (duration_ns == 0 || cm1e_scheduler_time_ns(s) < duration_ns))
            cycle(s);
        error = shut_down(s, diag);
        cm1e_log_run(&s->log, false, cm1e_scheduler_time_ns(s));
    }
    for (uint32_t i = 0; i < s->member_count; i++)
        cm1e_bus_stop(s->members[i].bus);
    drive_buses(s, false);
    cm1e_realtime_end(&realtime);
    close_windows(s);
    return error;
}

/** Without this check the cycles of a stopped bus would pass without a frame and without an error. The cycles of a
 *  restarted bus would write to the old place of the process data. */
static cm1e_error_t check_operation(const member_t *member, cm1e_diag_t *diag)
{
    const uint32_t present = cm1e_bus_operation(member->bus);
    if (present == 0)
        return cm1e_diag_set(diag, CM1E_ERROR_STATE, 0, "The bus is not in operation: call cm1e_bus_start() first.");
    if (present != member->operation)
        return cm1e_diag_set(diag, CM1E_ERROR_STATE, 0,
                             "The bus was started again since this scheduler was made: make a new one.");
    return CM1E_OK;
}

cm1e_error_t cm1e_scheduler_run(cm1e_scheduler_t *scheduler, int64_t duration_ns, cm1e_diag_t *diag)
{
    if (cm1e_in_task())
        return cm1e_in_task_refuse("cm1e_scheduler_run()", "", diag);
    if (duration_ns < 0)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "The duration of the run is negative; expected 0 "
                             "(no end) or above.");
    if (scheduler->run)
        return cm1e_diag_set(diag, CM1E_ERROR_STATE, 0,
                             "A scheduler runs once; start the bus again and make a new one.");
    for (uint32_t i = 0; i < scheduler->member_count; i++) {
        const cm1e_error_t other_operation = check_operation(&scheduler->members[i], diag);
        if (other_operation != CM1E_OK)
            return other_operation;
    }
    const cm1e_error_t no_memory = cm1e_trace_begin(&scheduler->trace, diag);
    if (no_memory != CM1E_OK)
        return no_memory;
    scheduler->run = true;
    cm1e_clock_t *clock_before = cm1e_clock_current();
    cm1e_clock_make_current(scheduler->clock); /* this thread may differ from the one that opened the bus */
    for (uint32_t i = 0; i < scheduler->member_count; i++)
        cm1e_bus_unkeep(scheduler->members[i].bus);
    cm1e_bus_keep_none(true);
    const cm1e_error_t error = run(scheduler, duration_ns, diag);
    cm1e_bus_keep_none(false);
    cm1e_clock_make_current(clock_before);
    return error;
}

void cm1e_scheduler_stop(cm1e_scheduler_t *scheduler)
{
    atomic_store_explicit(&scheduler->stop, true, memory_order_relaxed);
}

void cm1e_scheduler_stop_on_signals(cm1e_scheduler_t *scheduler) { cm1e_signals_attach(scheduler); }

int64_t cm1e_scheduler_time_ns(const cm1e_scheduler_t *scheduler)
{
    return scheduler->number * scheduler->cycle_time_ns;
}

void cm1e_scheduler_mark(cm1e_scheduler_t *scheduler, const char *text)
{
    if (text)
        cm1e_trace_mark(&scheduler->trace, text, cm1e_scheduler_time_ns(scheduler));
}

void cm1e_scheduler_statistics_sized(const cm1e_scheduler_t *scheduler, cm1e_scheduler_statistics_t *statistics,
                                     size_t size)
{
    cm1e_scheduler_statistics_t copy;
    cm1e_statistics_read(&scheduler->statistics, &copy);
    cm1e_copy_sized(statistics, size, &copy, sizeof copy);
}

cm1e_error_t cm1e_scheduler_check_path(const char *path, cm1e_diag_t *diag)
{
    if (cm1e_in_task())
        return cm1e_in_task_refuse("cm1e_scheduler_check_path()", "", diag);
    return cm1e_output_check(path, diag);
}

cm1e_error_t cm1e_scheduler_write_csv(const cm1e_scheduler_t *scheduler, const char *path, cm1e_diag_t *diag)
{
    if (cm1e_in_task())
        return cm1e_in_task_refuse("cm1e_scheduler_write_csv()", "", diag);
    return cm1e_trace_write_csv(&scheduler->trace, path, diag);
}

cm1e_error_t cm1e_scheduler_write_npy(const cm1e_scheduler_t *scheduler, const char *path, cm1e_diag_t *diag)
{
    if (cm1e_in_task())
        return cm1e_in_task_refuse("cm1e_scheduler_write_npy()", "", diag);
    return cm1e_trace_write_npy(&scheduler->trace, path, diag);
}

const trace_t *cm1e_scheduler_trace(const cm1e_scheduler_t *scheduler) { return &scheduler->trace; }

forcing_parts_t cm1e_scheduler_forcing_parts(cm1e_scheduler_t *s)
{
    return (forcing_parts_t){&s->forcing, &s->log, cm1e_scheduler_time_ns(s), s->shutting_down};
}

/* ---- before and after ------------------------------------------------------------------------------------------ */

static cm1e_error_t take_config(cm1e_scheduler_t *s, const cm1e_scheduler_config_t *config, size_t size,
                                cm1e_diag_t *diag)
{
    if (config)
        cm1e_copy_sized(&s->config, sizeof s->config, config, size);
    if (s->config.realtime_priority == 0)
        s->config.realtime_priority = REALTIME_DEFAULT_PRIORITY;
    if (s->config.stop_timeout_ns == 0)
        s->config.stop_timeout_ns = DEFAULT_STOP_TIMEOUT_NS;
    if (s->config.realtime_priority < -1 || s->config.realtime_priority > 98)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0,
                             "The real-time priority is %d; expected 1 ... 98, 0 (the default) or -1 (none).",
                             s->config.realtime_priority);
    if (s->config.cpu < 0 || s->config.stop_timeout_ns < 0)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "The CPU or the stop timeout is negative; expected "
                             "0 or above.");
    return CM1E_OK;
}

static cm1e_error_t make_axes(cm1e_scheduler_t *s, member_t *member, cm1e_diag_t *diag)
{
    const uint32_t count = cm1e_bus_configuration(member->bus)->axis_count;
    member->first = member->end = s->axis_count;
    for (uint32_t i = 0; i < count && s->axis_count < CM1E_MAX_AXES; i++) {
        const cm1e_error_t error = cm1e_axis_create(&s->axes[s->axis_count], member->bus, i, diag);
        if (error != CM1E_OK)
            return error;
        cm1e_axis_share_cycle(s->axes[s->axis_count], s);
        member->end = ++s->axis_count;
    }
    return CM1E_OK;
}

/** Makes the bus a member, with its axes. */
static cm1e_error_t join(cm1e_scheduler_t *s, cm1e_bus_t *bus, cm1e_diag_t *diag)
{
    member_t *member = &s->members[s->member_count];
    *member = (member_t){.bus = bus, .operation = cm1e_bus_operation(bus)};
    const cm1e_error_t error = check_operation(member, diag);
    if (error != CM1E_OK)
        return error;
    s->member_count++;
    cm1e_clock_team_add(&s->clocks, bus);
    return make_axes(s, member, diag);
}

static cm1e_error_t make_trace(cm1e_scheduler_t *s, cm1e_diag_t *diag)
{
    const char *names[CM1E_MAX_AXES];
    for (uint32_t i = 0; i < s->axis_count; i++)
        names[i] = cm1e_axis_name(cm1e_axis_reference(s->axes[i]));
    return cm1e_trace_init(&s->trace, names, s->axis_count, s->config.trace_capacity, s->config.trace_every, diag);
}

cm1e_error_t cm1e_scheduler_create_sized(cm1e_scheduler_t **scheduler, cm1e_bus_t *bus,
                                         const cm1e_scheduler_config_t *config, size_t size, cm1e_diag_t *diag)
{
    *scheduler = NULL;
    if (cm1e_in_task())
        return cm1e_in_task_refuse("cm1e_scheduler_create()", "", diag);
    if (!bus)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "A scheduler needs a bus.");
    cm1e_scheduler_t *s = calloc(1, sizeof *s);
    if (!s)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "No memory for the scheduler.");
    s->clock = cm1e_bus_clock(bus);
    s->cycle_time_ns = cm1e_bus_configuration(bus)->cycle_time_ns;
    cm1e_error_t error = take_config(s, config, size, diag);
    if (error == CM1E_OK)
        error = join(s, bus, diag);
    if (error == CM1E_OK)
        error = make_trace(s, diag);
    if (error == CM1E_OK)
        error = cm1e_log_init(&s->log, s->clock, diag);
    if (error != CM1E_OK) {
        cm1e_scheduler_destroy(s);
        return error;
    }
    *scheduler = s;
    return CM1E_OK;
}

/** Why a bus cannot be run beside the others; "": it can. */
static const char *other_bus_refused(const cm1e_scheduler_t *s, cm1e_bus_t *bus)
{
    for (uint32_t i = 0; i < s->member_count; i++)
        if (s->members[i].bus == bus)
            return "it is in this scheduler already";
    if (s->member_count == CM1E_MAX_BUSES)
        return "a scheduler has at most four buses";
    if (cm1e_bus_clock(bus) != s->clock)
        return "it runs on another time: either all buses of a scheduler have virtual_time and were opened in one thread, "
               "or none has it";
    if (cm1e_bus_configuration(bus)->cycle_time_ns != s->cycle_time_ns)
        return "its cycle_time_us differs from that of the first bus";
    if (!cm1e_bus_follow_one_clock(clock_team_leader(&s->clocks), bus))
        return "its distributed clocks and those of another bus do not follow each other: start the buses in one thread, "
               "each while those before it are in operation";
    if (s->axis_count + cm1e_bus_configuration(bus)->axis_count > CM1E_MAX_AXES)
        return "a scheduler has at most 128 axes";
    return "";
}

/** NULL: every axis of the bus has a name of its own. */
static const char *name_taken(const cm1e_scheduler_t *s, cm1e_bus_t *bus)
{
    const cm1e_bus_config_t *config = cm1e_bus_configuration(bus);
    for (uint32_t i = 0; i < config->axis_count; i++)
        if (cm1e_scheduler_axis_by_name(s, config->axes[i].name).Handle != 0)
            return config->axes[i].name;
    return NULL;
}

cm1e_error_t cm1e_scheduler_add_bus(cm1e_scheduler_t *scheduler, cm1e_bus_t *bus, cm1e_diag_t *diag)
{
    if (cm1e_in_task())
        return cm1e_in_task_refuse("cm1e_scheduler_add_bus()", "", diag);
    if (!scheduler || !bus)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "A scheduler or a bus is missing.");
    if (scheduler->run)
        return cm1e_diag_set(diag, CM1E_ERROR_STATE, 0, "Buses are added before the scheduler runs.");
    const char *refused = other_bus_refused(scheduler, bus), *taken = name_taken(scheduler, bus);
    if (refused[0])
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "The bus on \"%s\" cannot be added to the scheduler: "
                             "%s.", cm1e_bus_configuration(bus)->interface_name, refused);
    if (taken)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "Two buses have an axis with the name \"%s\": give "
                             "each axis of a program a name of its own.", taken);
    const member_t before = {.first = scheduler->axis_count, .end = scheduler->member_count};
    cm1e_error_t error = join(scheduler, bus, diag);
    if (error == CM1E_OK) {
        cm1e_trace_free(&scheduler->trace);
        error = make_trace(scheduler, diag);
    }
    if (error == CM1E_OK)
        return error;
    while (scheduler->axis_count > before.first) {
        cm1e_axis_destroy(scheduler->axes[--scheduler->axis_count]);
        scheduler->axes[scheduler->axis_count] = NULL;
    }
    scheduler->member_count = before.end;
    cm1e_clock_team_cut(&scheduler->clocks, before.end);
    return error;
}

void cm1e_scheduler_destroy(cm1e_scheduler_t *scheduler)
{
    if (!scheduler || cm1e_in_task_note("cm1e_scheduler_destroy()"))
        return;
    cm1e_signals_detach(scheduler);
    cm1e_trace_free(&scheduler->trace);
    cm1e_log_free(&scheduler->log);
    for (uint32_t i = 0; i < scheduler->axis_count; i++)
        cm1e_axis_destroy(scheduler->axes[i]);
    free(scheduler);
}

cm1e_error_t cm1e_scheduler_add_task_sized(cm1e_scheduler_t *scheduler, const cm1e_task_config_t *task, size_t size,
                                           cm1e_diag_t *diag)
{
    cm1e_task_config_t own;
    cm1e_copy_sized(&own, sizeof own, task, size);
    if (scheduler->run)
        return cm1e_diag_set(diag, CM1E_ERROR_STATE, 0, "Tasks are added before the scheduler runs.");
    return cm1e_tasks_add(&scheduler->tasks, &own, scheduler->cycle_time_ns, diag);
}

/* ---- what the trace records beside the axes ---------------------------------------------------------------------- */

cm1e_error_t cm1e_scheduler_trace_variable(cm1e_scheduler_t *scheduler, const char *name, const char *unit,
                                           cm1e_trace_type_t type, const void *variable, cm1e_diag_t *diag)
{
    trace_column_t column = {.type = type, .value = variable};
    column.kind = type == CM1E_TRACE_BOOL ? TRACE_KIND_FLAG : TRACE_KIND_NUMBER;
    if ((name && strlen(name) >= sizeof column.name) || (unit && strlen(unit) >= sizeof column.unit))
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0,
                             "The name of a signal has at most %zu bytes, and its unit %zu.", sizeof column.name - 1,
                             sizeof column.unit - 1);
    snprintf(column.name, sizeof column.name, "%s", name ? name : "");
    snprintf(column.unit, sizeof column.unit, "%s", unit ? unit : "");
    return cm1e_trace_add(&scheduler->trace, &column, diag);
}

static cm1e_error_t trace_object_of(cm1e_scheduler_t *s, uint32_t axis, uint16_t index, uint8_t subindex,
                                    cm1e_diag_t *diag)
{
    const member_t *member = s->members;
    while (axis >= member->end)
        member++;
    return cm1e_trace_add_object(&s->trace, member->bus, cm1e_bus_axis_position(member->bus, axis - member->first),
                                 cm1e_axis_name(cm1e_axis_reference(s->axes[axis])), index, subindex, diag);
}

cm1e_error_t cm1e_scheduler_trace_object(cm1e_scheduler_t *scheduler, AXIS_REF_t axis, uint16_t index, uint8_t subindex,
                                         cm1e_diag_t *diag)
{
    for (uint32_t i = 0; i < scheduler->axis_count; i++)
        if (axis.Handle != 0 && cm1e_axis_reference(scheduler->axes[i]).Handle == axis.Handle)
            return trace_object_of(scheduler, i, index, subindex, diag);
    return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "The axis does not belong to this scheduler.");
}

cm1e_error_t cm1e_scheduler_trace_trigger(cm1e_scheduler_t *scheduler, const cm1e_trace_trigger_t *trigger,
                                          cm1e_diag_t *diag)
{
    if (!trigger)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "A trigger is missing.");
    return cm1e_trace_set_trigger(&scheduler->trace, trigger, diag);
}

AXIS_REF_t cm1e_scheduler_axis(const cm1e_scheduler_t *scheduler, uint32_t index)
{
    return index < scheduler->axis_count ? cm1e_axis_reference(scheduler->axes[index]) : (AXIS_REF_t){0};
}

AXIS_REF_t cm1e_scheduler_axis_by_name(const cm1e_scheduler_t *scheduler, const char *name)
{
    for (uint32_t i = 0; i < scheduler->axis_count; i++) {
        const AXIS_REF_t reference = cm1e_axis_reference(scheduler->axes[i]);
        if (strcmp(cm1e_axis_name(reference), name) == 0)
            return reference;
    }
    return (AXIS_REF_t){0};
}
