#include <string.h>

#include "bus/kept.h"
#include "cm1e/scan_time.h"
#include "core/clock.h"
#include "core/in_task.h"
#include "core/output.h"
#include "core/sized.h"
#include "scheduler/realtime.h"
#include "scheduler/scheduler_private.h"
#include "scheduler/signals.h"

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

cm1e_bus_t *cm1e_scheduler_bus_at(const cm1e_scheduler_t *scheduler, uint32_t index)
{
    return index < scheduler->member_count ? scheduler->members[index].bus : NULL;
}

uint64_t cm1e_scheduler_counted(const cm1e_scheduler_t *scheduler, uint32_t bus, cm1e_bus_counters_t *counters)
{
    return cm1e_statistics_read_bus(&scheduler->statistics, bus, counters);
}

const char *cm1e_scheduler_task_name(const cm1e_scheduler_t *scheduler, uint32_t index)
{
    return index < scheduler->tasks.count ? scheduler->tasks.tasks[index].name : "";
}

bool cm1e_scheduler_is_ending(const cm1e_scheduler_t *scheduler) { return scheduler->shutting_down; }

bool cm1e_scheduler_ran_its_time(const cm1e_scheduler_t *scheduler) { return scheduler->ran_its_time; }

bool cm1e_scheduler_is_virtual(const cm1e_scheduler_t *scheduler)
{
    return scheduler->clock != cm1e_clock_monotonic();
}

size_t cm1e_log_read(const cm1e_scheduler_t *scheduler, uint64_t after, cm1e_log_event_t *events, size_t room,
                     uint64_t *lost)
{
    if (scheduler && (events || room == 0))
        return cm1e_log_copy(&scheduler->log, after, events, room, lost);
    if (lost)
        *lost = 0;
    return 0;
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
static int64_t cycle_of(const cm1e_scheduler_t *s, int64_t time_ns)
{
    return (time_ns - s->start_ns) / s->cycle_time_ns;
}

static const int64_t watchdog_ns = 100 * MS_IN_NS, longest_late_ns = 2000 * MS_IN_NS;

/** After a few missed cycles the motor has hardly slowed down; after more it is at rest (CSP). After the time of the
 *  watchdogs no motion begins again by itself, whether a drive has one or not: somebody may have resumed a program that
 *  was suspended for hours. Nor does one go on for ever that gets no further, because every cycle is late. */
static void after_missed(cm1e_scheduler_t *s, cm1e_axis_t *axis, int64_t missed, int64_t silence_ns)
{
    if (missed > CM1E_AXIS_RIDDEN_OUT_CYCLES)
        cm1e_axis_after_pause(axis, missed * s->cycle_time_ns);
    else
        cm1e_axis_hold_cycle(axis, missed);
    if (silence_ns >= watchdog_ns)
        cm1e_axis_stood_still(axis, silence_ns, s->sent_ns);
    if (s->late_ns >= longest_late_ns)
        cm1e_axis_ran_late(axis, s->late_ns);
}

static void set_outputs(cm1e_scheduler_t *s)
{
    const int64_t now_ns = cm1e_clock_now(s->clock), silence_ns = now_ns - s->sent_ns - s->cycle_time_ns;
    const int64_t missed = cycle_of(s, now_ns) - cycle_of(s, s->sent_ns) - 1; /* cycles in which no frame was sent */
    /* However long a single pause is, it does not count for more than a stand-still. */
    s->late_ns = missed > 0 ? s->late_ns + (silence_ns < watchdog_ns ? now_ns - s->sent_ns : watchdog_ns) : 0;
    s->sent_ns = now_ns;
    for (uint32_t i = 0; i < s->axis_count && missed > 0; i++)
        after_missed(s, s->axes[i], missed, silence_ns);
    if (s->heard_apart)
        cm1e_axis_meet(s->axes, s->axis_count);
    for (uint32_t i = 0; i < s->axis_count; i++)
        cm1e_axis_outputs(s->axes[i]);
}

/** A task did not return in time. What it began goes on in no axis, since nobody would end it. */
static void stop_without(cm1e_scheduler_t *s, const task_t *task)
{
    if (!s->ended)
        s->ended = task;
    cm1e_log_task(&s->log, (uint32_t)(task - s->tasks.tasks), task->limit_ns, cm1e_scheduler_time_ns(s));
    for (uint32_t i = 0; i < s->axis_count; i++)
        cm1e_axis_lose_program(s->axes[i], task->name, task->limit_ns);
    if (s->tasks.ended == s->tasks.count)
        cm1e_scheduler_stop(s);
}

/** A task called a function that would free what it runs on: the run ends in order instead. */
static void run_tasks(cm1e_scheduler_t *s)
{
    cm1e_in_task_begin();
    const task_t *over = cm1e_tasks_run(&s->tasks, s->number);
    cm1e_in_task_end();
    if (over)
        stop_without(s, over);
    const char *function = cm1e_in_task_noted();
    if (!function)
        return;
    s->refused = s->refused ? s->refused : function;
    cm1e_scheduler_stop(s);
}

/** Another thread called a function that would end a bus under the cycle: the run ends in order instead, too. */
static void look_for_refused(cm1e_scheduler_t *s)
{
    for (uint32_t i = 0; i < s->member_count && !s->refused; i++) {
        s->refused = cm1e_bus_refused_end(s->members[i].bus);
        if (s->refused)
            cm1e_scheduler_stop(s);
    }
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
    look_for_refused(s);
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
 *  burst. The frame of a late cycle was sent in the time of the cycle in which it ends. */
static void end_cycle(cm1e_scheduler_t *s)
{
    const int64_t end_ns = cm1e_clock_now(s->clock);
    cm1e_distribution_add(&s->statistics.execution_time, end_ns - s->begin_ns);
    for (uint32_t i = 0; i < s->member_count; i++)
        cm1e_statistics_note_bus(&s->statistics, i, &s->members[i].counters, s->members[i].sync_losses);
    s->trace.timing.execution_time_us = (double)(end_ns - s->begin_ns) * 1e-3;
    atomic_fetch_add_explicit(&s->statistics.cycles, 1, memory_order_relaxed);
    s->number++;
    if (end_ns <= planned_ns(s, s->number))
        return;
    count_overrun(s);
    s->number = cycle_of(s, end_ns) + 1;
}

/** What a bus counted before, in its start and in other runs, is not of this run. */
static void count_bus(member_t *member)
{
    const cm1e_bus_counters_t *now = cm1e_bus_counters(member->bus), *before = &member->counters_before;
    member->counters = (cm1e_bus_counters_t){
        .cycles = now->cycles - before->cycles,
        .lost_frames = now->lost_frames - before->lost_frames,
        .working_counter_errors = now->working_counter_errors - before->working_counter_errors,
        .late_frames = now->late_frames - before->late_frames,
        .foreign_frames = now->foreign_frames - before->foreign_frames,
        .unsent_frames = now->unsent_frames - before->unsent_frames,
        .mailbox_retries = now->mailbox_retries - before->mailbox_retries,
    };
}

static void look_at_clocks(cm1e_scheduler_t *s)
{
    cm1e_bus_clocks_t clocks;
    for (uint32_t i = 0; i < s->member_count; i++) {
        cm1e_bus_clocks(s->members[i].bus, &clocks);
        s->members[i].sync_losses = clocks.sync_losses;
        if (s->members[i].bus == clock_team_leader(&s->clocks))
            cm1e_statistics_note_clocks(&s->statistics, &clocks);
    }
}

static void log_news(cm1e_scheduler_t *s)
{
    const uint64_t overruns = atomic_load_explicit(&s->statistics.overruns, memory_order_relaxed);
    const int64_t now_ns = cm1e_scheduler_time_ns(s);
    cm1e_log_look(&s->log, s->axes, s->axis_count, overruns, now_ns);
    for (uint32_t i = 0; i < s->member_count; i++) {
        cm1e_log_bus(&s->log, &s->members[i].counters, s->members[i].sync_losses, i, now_ns);
        cm1e_log_emergencies(&s->log, s->members[i].bus, i, now_ns);
        cm1e_log_ports(&s->log, s->members[i].bus, i, now_ns);
        cm1e_log_ring(&s->log, s->members[i].bus, i, now_ns);
        cm1e_log_presence(&s->log, s->members[i].bus, i, now_ns);
    }
}

/** What others see of a cycle. */
static void show(cm1e_scheduler_t *s)
{
    look_at_clocks(s);
    s->trace.timing.lost_frames = 0;
    for (uint32_t i = 0; i < s->member_count; i++) {
        count_bus(&s->members[i]);
        s->trace.timing.lost_frames += s->members[i].counters.lost_frames;
    }
    cm1e_trace_record(&s->trace, s->axes, cm1e_scheduler_time_ns(s));
    log_news(s);
    for (uint32_t bus = 0; bus < s->member_count; bus++)
        for (int i = 0; i < CM1E_WINDOWS; i++)
            if (s->windows[bus][i])
                kinds[i]->cycle(s->windows[bus][i]);
}

/** What waited for the next record of its kind, and the end. */
static void log_end(cm1e_scheduler_t *s)
{
    look_at_clocks(s);
    cm1e_log_wait_no_longer(&s->log);
    log_news(s);
    cm1e_log_run(&s->log, false, cm1e_scheduler_time_ns(s));
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

static bool any_swings(const cm1e_scheduler_t *s)
{
    for (uint32_t i = 0; i < s->axis_count; i++)
        if (cm1e_axis_swings(s->axes[i]))
            return true;
    return false;
}

/* Whether the stop may go on, `time_ns` after its begin. The stop timeout is for the ramps: behind them a motor that a
 * load still turns keeps its torque until it rests, and a drive gets the time to take it off. */
static bool may_go_on(const cm1e_scheduler_t *s, int64_t time_ns, int64_t *swing_ns)
{
    static const int64_t longest_ns = CM1E_AXIS_LONGEST_SWING_MS * MS_IN_NS, least_off_ns = 100 * MS_IN_NS;
    const int64_t ten_ns = 10 * s->cycle_time_ns, off_ns = ten_ns > least_off_ns ? ten_ns : least_off_ns;
    const int64_t over_ns = time_ns - s->config.stop_timeout_ns;
    if (any_swings(s))
        *swing_ns = time_ns;
    return over_ns <= 0 || (over_ns <= longest_ns + off_ns && time_ns - *swing_ns <= off_ns);
}

static cm1e_error_t shut_down(cm1e_scheduler_t *s, cm1e_diag_t *diag)
{
    const int64_t begin_ns = cm1e_scheduler_time_ns(s);
    int64_t swing_ns = INT64_MIN / 2; /* never */
    s->shutting_down = true;
    while (!s->shut_down && may_go_on(s, cm1e_scheduler_time_ns(s) - begin_ns, &swing_ns))
        cycle(s);
    if (s->shut_down && s->refused)
        return cm1e_diag_set(diag, CM1E_ERROR_STATE, 0,
                             "%s was called in a task or in another thread, where it is refused, because it frees or "
                             "stops what the cycle uses. The run was ended in order instead; use cm1e_scheduler_stop() "
                             "there.",
                             s->refused);
    if (s->shut_down && s->ended)
        return cm1e_diag_set(diag, CM1E_ERROR_PROGRAM, 0,
                             "Task \"%s\" did not return within %g ms, so it was ended, and all axes were stopped. "
                             "Look for an endless loop, or for a call that waits, in its program; then start it again.",
                             s->ended->name, (double)s->ended->limit_ns * 1e-6);
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
    if (realtime->fifo)
        cm1e_task_watch_raise(&s->watch, s->config.realtime_priority);
    cm1e_statistics_publish_realtime(&s->statistics, in_force, advice);
    if (s->config.realtime_required && advice[0])
        return cm1e_diag_set(diag, CM1E_ERROR_PERMISSION, 0, "%s", advice);
    return CM1E_OK;
}

/** On virtual time nothing shows how long a task takes, and no motor waits for it. */
static cm1e_error_t watch_tasks(cm1e_scheduler_t *s, cm1e_diag_t *diag)
{
    return cm1e_scheduler_is_virtual(s) ? CM1E_OK : cm1e_task_watch_begin(&s->watch, &s->tasks, diag);
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
    cm1e_error_t error = cm1e_trace_begin(&s->trace, diag);
    open_windows(s);
    if (error == CM1E_OK)
        error = watch_tasks(s, diag);
    if (error == CM1E_OK)
        error = take_real_time(s, &realtime, diag);
    for (uint32_t i = 0; i < s->member_count && error == CM1E_OK; i++)
        error = cm1e_bus_resume(s->members[i].bus, diag);
    if (error == CM1E_OK) {
        s->start_ns = s->sent_ns = cm1e_bus_next_start(clock_team_leader(&s->clocks), cm1e_clock_now(s->clock));
        for (uint32_t i = 0; i < s->member_count; i++)
            s->members[i].counters_before = *cm1e_bus_counters(s->members[i].bus);
        cm1e_log_run(&s->log, true, 0);
        while (!stop_asked(s) && (duration_ns == 0 || cm1e_scheduler_time_ns(s) < duration_ns))
            cycle(s);
        s->ran_its_time = duration_ns > 0 && cm1e_scheduler_time_ns(s) >= duration_ns;
        error = shut_down(s, diag);
        log_end(s);
    }
    for (uint32_t i = 0; i < s->member_count; i++)
        cm1e_bus_stop(s->members[i].bus);
    drive_buses(s, false);
    cm1e_task_watch_end(&s->watch);
    cm1e_realtime_end(&realtime);
    close_windows(s);
    return error;
}

cm1e_error_t cm1e_scheduler_run(cm1e_scheduler_t *scheduler, int64_t duration_ns, cm1e_diag_t *diag)
{
    if (cm1e_in_task())
        return cm1e_in_task_refuse("cm1e_scheduler_run()", "", diag);
    if (!scheduler)
        return cm1e_scheduler_missing(diag);
    if (duration_ns < 0)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "The duration of the run is negative; expected 0 "
                             "(no end) or above.");
    if (scheduler->run)
        return cm1e_diag_set(diag, CM1E_ERROR_STATE, 0,
                             "A scheduler runs once; start the bus again and make a new one.");
    for (uint32_t i = 0; i < scheduler->member_count; i++) {
        const cm1e_error_t other_operation = cm1e_scheduler_check_operation(&scheduler->members[i], diag);
        if (other_operation != CM1E_OK)
            return other_operation;
    }
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
    if (scheduler)
        atomic_store_explicit(&scheduler->stop, true, memory_order_relaxed);
}

void cm1e_scheduler_stop_on_signals(cm1e_scheduler_t *scheduler)
{
    if (scheduler) /* else the signals would do nothing any more */
        cm1e_signals_attach(scheduler);
}

int64_t cm1e_scheduler_time_ns(const cm1e_scheduler_t *scheduler)
{
    return scheduler ? scheduler->number * scheduler->cycle_time_ns : 0;
}

void cm1e_scheduler_mark(cm1e_scheduler_t *scheduler, const char *text)
{
    if (scheduler && text)
        cm1e_trace_mark(&scheduler->trace, text, cm1e_scheduler_time_ns(scheduler));
}

void cm1e_scheduler_statistics_sized(const cm1e_scheduler_t *scheduler, cm1e_scheduler_statistics_t *statistics,
                                     size_t size)
{
    cm1e_scheduler_statistics_t copy = {0};
    if (scheduler)
        cm1e_statistics_read(&scheduler->statistics, &copy);
    if (statistics)
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
    return cm1e_trace_write_csv(cm1e_scheduler_trace(scheduler), path, diag);
}

cm1e_error_t cm1e_scheduler_write_npy(const cm1e_scheduler_t *scheduler, const char *path, cm1e_diag_t *diag)
{
    if (cm1e_in_task())
        return cm1e_in_task_refuse("cm1e_scheduler_write_npy()", "", diag);
    return cm1e_trace_write_npy(cm1e_scheduler_trace(scheduler), path, diag);
}

const trace_t *cm1e_scheduler_trace(const cm1e_scheduler_t *scheduler)
{
    return scheduler ? &scheduler->trace : NULL;
}

forcing_t *cm1e_scheduler_forcing(cm1e_scheduler_t *s) { return &s->forcing; }

forcing_parts_t cm1e_scheduler_forcing_parts(cm1e_scheduler_t *s)
{
    return (forcing_parts_t){&s->forcing, &s->log, cm1e_scheduler_time_ns(s), s->shutting_down};
}
