/**
 * @file scheduler_private.h
 * A scheduler from within: scheduler.c runs it, scheduler_make.c makes it.
 */
#ifndef CM1E_SCHEDULER_SCHEDULER_PRIVATE_H
#define CM1E_SCHEDULER_SCHEDULER_PRIVATE_H

#include <stdatomic.h>

#include "axis/axis_api.h"
#include "bus/bus_image.h"
#include "cm1e/scheduler.h"
#include "scheduler/clock_team.h"
#include "scheduler/event_log.h"
#include "scheduler/forcing.h"
#include "scheduler/scheduler_window.h"
#include "scheduler/statistics.h"
#include "scheduler/task_watch.h"
#include "scheduler/tasks.h"
#include "scheduler/trace_recorder.h"

/** A bus of the scheduler, and its axes. */
typedef struct member {
    cm1e_bus_t *bus;
    uint32_t operation;     /**< start number of the bus for which the axes were made */
    uint32_t first, end;    /**< its axes: axes[first] ... axes[end - 1] */
    cm1e_error_t received;  /**< in this cycle */
    cm1e_bus_counters_t counters, counters_before; /**< of this run, after this cycle; before it */
    uint64_t sync_losses;   /**< after this cycle */
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
    bool heard_apart;         /**< one axis may be silent while another one is not (cm1e_axis_meet()) */
    task_list_t tasks;
    task_watch_t watch;
    const task_t *ended;   /**< the first task that did not return in time; NULL: none */
    trace_t trace;
    forcing_t forcing;
    log_t log;
    void *windows[CM1E_MAX_BUSES][CM1E_WINDOWS]; /**< of this run, by bus and kind; NULL: it has none */
    statistics_t statistics;
    atomic_bool stop;      /**< a stop was requested */
    bool run;              /**< cm1e_scheduler_run() was called */
    bool shutting_down;    /**< programs no longer run */
    bool ran_its_time;     /**< they ran for the whole duration */
    const char *refused;   /**< function that a task, or another thread, called and that would have freed what the cycle
                                uses; NULL: none */
    bool shut_down;        /**< every drive is disabled or offline */
    int64_t start_ns;      /**< of cycle 0 */
    int64_t number;        /**< number of this cycle; skipped cycles count */
    int64_t begin_ns;      /**< actual start of this cycle */
    int64_t sent_ns;       /**< time of the outputs of the last cycle */
    int64_t late_ns;       /**< for so long every cycle was late */
};

/** The error of a function that got no scheduler. */
cm1e_error_t cm1e_scheduler_missing(cm1e_diag_t *diag);
/** Without this check the cycles of a stopped bus would pass without a frame and without an error. The cycles of a
 *  restarted bus would write to the old place of the process data. */
cm1e_error_t cm1e_scheduler_check_operation(const member_t *member, cm1e_diag_t *diag);

#endif
