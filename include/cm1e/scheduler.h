/**
 * @file scheduler.h
 * The cycle: receive -> inputs -> programs -> axes -> outputs -> send, on a real-time thread or on virtual time.
 * IEC 61131-3 tasks (interval, priority) run their programs in it, highest priority first, never in parallel.
 */
#ifndef CM1E_SCHEDULER_H
#define CM1E_SCHEDULER_H

#include <stdbool.h>
#include <stdint.h>

#include "cm1e/api.h"
#include "cm1e/axis.h"
#include "cm1e/bus.h"
#include "cm1e/error.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct cm1e_scheduler cm1e_scheduler_t;

/** A program: called in the cycle; must return soon, allocate nothing, wait for nothing. Functions that wait for slaves
 *  or files (cm1e_sdo_read() ...) are refused in it with CM1E_ERROR_STATE. */
typedef void (*cm1e_program_t)(void *context);

typedef struct cm1e_task_config {
    const char *name;       /**< "": "task<n>"; copied */
    int64_t interval_ns;    /**< a multiple of the bus cycle; 0: every cycle */
    uint32_t priority;      /**< IEC 61131-3: 0 = highest; equal ones run in the order they were added */
    cm1e_program_t program;
    void *context;
} cm1e_task_config_t;

/** A zero means the default. */
typedef struct cm1e_scheduler_config {
    int realtime_priority;      /**< SCHED_FIFO priority 1 ... 98; 0: 80; -1: do not ask for real time */
    int cpu;                    /**< bind to this CPU (1 = first); 0: any */
    bool realtime_required;     /**< TRUE: a missing privilege is an error; FALSE: a warning in the statistics */
    int64_t stop_timeout_ns;    /**< longest ramp-down at the end; 0: 10 s */
    uint32_t trace_capacity;    /**< cycles that the trace keeps per axis; 0: no trace */
    uint32_t trace_every;       /**< record every n-th cycle; 0: 1 */
} cm1e_scheduler_config_t;

enum { CM1E_MAX_TASKS = 16, CM1E_HISTOGRAM_BUCKETS = 32 };

/** Distribution of a time in ns. Bucket n counts times from 2^(n-1) us to below 2^n us; the first one all below 1 us,
 *  the last one all that are longer. */
typedef struct cm1e_distribution {
    int64_t minimum_ns, maximum_ns, sum_ns;
    uint64_t count;
    uint64_t histogram[CM1E_HISTOGRAM_BUCKETS];
} cm1e_distribution_t;

typedef struct cm1e_scheduler_statistics {
    cm1e_distribution_t cycle_time, wake_up_latency, execution_time;
    uint64_t cycles, overruns;   /**< overrun: the work of a cycle ended after the next one's start */
    cm1e_bus_counters_t bus;
    bool realtime;               /**< SCHED_FIFO and locked memory are in force */
    char advice[512];            /**< what to do where a privilege is missing; "" if none is */
} cm1e_scheduler_statistics_t;

/** For a bus in Operational (else CM1E_ERROR_STATE); makes one axis per configured axis. `config` NULL: defaults. The
 *  bus must outlive it. The slaves' watchdog is running: add the tasks and run soon. @rt init */
CM1E_API cm1e_error_t cm1e_scheduler_create(cm1e_scheduler_t **scheduler, cm1e_bus_t *bus,
                                            const cm1e_scheduler_config_t *config, cm1e_diag_t *diag);
/** NULL is allowed. Not while it runs: in a task it is refused, and the run ends in order with an error. @rt init */
CM1E_API void cm1e_scheduler_destroy(cm1e_scheduler_t *scheduler);
/** Before the scheduler runs. The interval must be a multiple of the bus cycle. @rt init */
CM1E_API cm1e_error_t cm1e_scheduler_add_task(cm1e_scheduler_t *scheduler, const cm1e_task_config_t *task,
                                              cm1e_diag_t *diag);
/** The reference of configured axis `index` (0 = first); Handle 0: none. @rt any */
CM1E_API AXIS_REF_t cm1e_scheduler_axis(const cm1e_scheduler_t *scheduler, uint32_t index);
/** The reference of the axis called `name`; Handle 0: none. @rt any */
CM1E_API AXIS_REF_t cm1e_scheduler_axis_by_name(const cm1e_scheduler_t *scheduler, const char *name);

/** Runs the cycle in the calling thread for `duration_ns` (0: until cm1e_scheduler_stop()), then stops in order: axes
 *  ramp down, drives are disabled, slaves go to Safe-Operational and Init. Once per scheduler. A missed cycle is left
 *  out, never caught up. A lost bus does not end the run: the axes are in ErrorStop, programs see it, and what comes
 *  back can be reset. CM1E_ERROR_STATE: it ran before, or the bus was stopped or started again since it was made;
 *  CM1E_ERROR_PERMISSION: real time is required and refused, no cycle was run; CM1E_ERROR_TIMEOUT: an axis was not
 *  disabled within the stop timeout. Also CM1E_ERROR_STATE: a task called cm1e_scheduler_destroy(), cm1e_bus_close() or
 *  cm1e_bus_stop(), which was refused and ended the run. Where cycles were run, and after CM1E_ERROR_PERMISSION, the
 *  bus is stopped. @rt init */
CM1E_API cm1e_error_t cm1e_scheduler_run(cm1e_scheduler_t *scheduler, int64_t duration_ns, cm1e_diag_t *diag);
/** Asks the run to end in order. Any thread, any program, any signal handler. @rt any */
CM1E_API void cm1e_scheduler_stop(cm1e_scheduler_t *scheduler);
/** Signals that would end or suspend the program stop this scheduler in order, until it is destroyed: SIGINT, SIGTERM,
 *  SIGHUP (terminal closed), SIGQUIT, SIGTSTP (Ctrl-Z), SIGPIPE, SIGXCPU, SIGXFSZ. A second and every further signal
 *  changes nothing: the ramp is not shortened, and is bounded by `stop_timeout_ns`; only SIGKILL ends it. A signal that
 *  the program ignores stays ignored (SIGHUP under nohup), but for SIGINT and SIGTERM; handlers of the program are
 *  replaced, and act again afterwards. One scheduler per process. @rt init */
CM1E_API void cm1e_scheduler_stop_on_signals(cm1e_scheduler_t *scheduler);
/** Planned time of this cycle since the first one, the same for a whole scan. @rt cycle */
CM1E_API int64_t cm1e_scheduler_time_ns(const cm1e_scheduler_t *scheduler);
/** Gives this cycle a name that the plot of the trace shows (the last 64 are kept). `text` must live until the
 *  scheduler is destroyed. Call it in a program. @rt cycle */
CM1E_API void cm1e_scheduler_mark(cm1e_scheduler_t *scheduler, const char *text);
/** Before, during and after the run, from any thread. Each number is right; while it runs, two of them may be of
 *  neighbouring cycles. @rt any */
CM1E_API void cm1e_scheduler_statistics(const cm1e_scheduler_t *scheduler, cm1e_scheduler_statistics_t *statistics);

/** Whether cm1e_scheduler_write_csv() and its like can write `path`, before the run: CM1E_ERROR_IO and why not. Leaves
 *  nothing behind. @rt block */
CM1E_API cm1e_error_t cm1e_scheduler_check_path(const char *path, cm1e_diag_t *diag);
/** Writes the trace (time; per axis: state, set and actual position and velocity, torque) as CSV, into a new
 *  file beside `path` that is renamed when it is whole. After the run. CM1E_ERROR_STATE without a trace. @rt block */
CM1E_API cm1e_error_t cm1e_scheduler_write_csv(const cm1e_scheduler_t *scheduler, const char *path, cm1e_diag_t *diag);
/** Writes the trace as a plot that a person can read: panels per axis. As cm1e_scheduler_write_csv(). @rt block */
CM1E_API cm1e_error_t cm1e_scheduler_write_svg(const cm1e_scheduler_t *scheduler, const char *path, cm1e_diag_t *diag);

#ifdef __cplusplus
}
#endif
#endif
