/**
 * @file scheduler.h
 * The scheduler runs the cycle: receive -> inputs -> programs -> axes -> outputs -> send, on a real-time thread or on
 * virtual time. IEC 61131-3 tasks (interval, priority) run their programs in it, highest priority first, never in
 * parallel. The thread that owns the bus makes and runs the scheduler.
 *
 * Without a scheduler (NULL), and where something else that a function needs is NULL, it does nothing and returns
 * CM1E_ERROR_INVALID_ARGUMENT, an empty reference or 0.
 */
#ifndef CM1E_SCHEDULER_H
#define CM1E_SCHEDULER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "cm1e/api.h"
#include "cm1e/axis.h"
#include "cm1e/bus.h"
#include "cm1e/clocks.h"
#include "cm1e/error.h"

#ifdef __cplusplus
extern "C" {
#endif

/** The cycle of one or more networks, with its tasks and axes. */
typedef struct cm1e_scheduler cm1e_scheduler_t;

/** A program. It is called in the cycle: it must return soon, and must neither allocate nor wait. Functions that wait
 *  for slaves or files (cm1e_sdo_read() ...) are refused in it with CM1E_ERROR_STATE. */
typedef void (*cm1e_program_t)(void *context);

/** A task: which program runs in the cycle, and how often. */
typedef struct cm1e_task_config {
    const char *name;       /**< copied; "" selects "task<n>" */
    int64_t interval_ns;    /**< a multiple of the bus cycle; 0 selects every cycle */
    uint32_t priority;      /**< IEC 61131-3: 0 = highest; tasks of equal priority run in the order of their addition */
    cm1e_program_t program;
    void *context;
    int32_t watchdog_cycles; /**< bus cycles that one call may compute or wait; 0 selects 50 ms; -1: no limit. A longer
                                  call is ended: see cm1e_scheduler_run() */
} cm1e_task_config_t;

/** Configuration of a scheduler. A zero in any field selects the default. */
typedef struct cm1e_scheduler_config {
    int realtime_priority;      /**< SCHED_FIFO priority 1 ... 98; 0 selects 80; -1: no real time. The memory of the
                                     process stays locked after the run (docs/REALTIME.md) */
    int cpu;                    /**< CPU to which the thread is bound (1 = first); 0: any */
    bool realtime_required;     /**< true: a missing privilege is an error; false: `advice` in the statistics */
    int64_t stop_timeout_ns;    /**< maximum time of the ramp-down at the end; 0 selects 10 s. Behind its ramp a motor
                                     that a load still turns keeps its torque, for about 2 s more at most */
    uint32_t trace_capacity;    /**< number of cycles that the trace keeps per axis; 0: it keeps none */
    uint32_t trace_every;       /**< n: every n-th cycle is recorded; 0 selects 1 */
} cm1e_scheduler_config_t;

enum { CM1E_MAX_TASKS = 16, CM1E_HISTOGRAM_BUCKETS = 32 };

/** Distribution of a time in ns. Bucket n counts times from 2^(n-1) us to below 2^n us. The first bucket counts all
 *  times below 1 us, the last one all longer times. */
typedef struct cm1e_distribution {
    int64_t minimum_ns, maximum_ns, sum_ns;
    uint64_t count;
    uint64_t histogram[CM1E_HISTOGRAM_BUCKETS];
} cm1e_distribution_t;

/** Statistics of a run: times of its cycles, counters, and whether it has real time and a control socket. */
typedef struct cm1e_scheduler_statistics_t {
    cm1e_distribution_t cycle_time, wake_up_latency, execution_time;
    uint64_t cycles, overruns;   /**< overruns: cycles whose work ended after the start of the next one */
    cm1e_bus_counters_t bus;     /**< of this run, of all buses together, but its cycles are those of the first one;
                                      cm1e_bus_counters() has those of a bus since it was opened */
    bool realtime;               /**< true: SCHED_FIFO and locked memory are in force */
    char advice[512];            /**< what to do about a missing privilege; "": none is missing */
    char control_socket[112];    /**< path at which other programs can watch this run (docs/CONTROL.md); "": none */
    char control_advice[400];    /**< why there is none although it is configured, and the cure; "": there is one, or
                                      none is wanted */
    cm1e_bus_clocks_t clocks;    /**< distributed clocks, where they are used: of the bus that leads the others, but the
                                      losses are those of all; cm1e_bus_clocks() has those of a bus */
} cm1e_scheduler_statistics_t;

/* The structs of this header may grow at their ends in later versions. The functions ..._sized() are told the size that
 * the program was compiled with. */

/** Does the work of cm1e_scheduler_create(), for a program with this size of the configuration. @rt init */
CM1E_API cm1e_error_t cm1e_scheduler_create_sized(cm1e_scheduler_t **scheduler, cm1e_bus_t *bus,
                                                  const cm1e_scheduler_config_t *config, size_t size,
                                                  cm1e_diag_t *diag);
/** Makes a scheduler for a bus in Operational (otherwise CM1E_ERROR_STATE), with one axis per configured axis. `config`
 *  may be NULL. The bus must outlive the scheduler; free it with cm1e_scheduler_destroy(). The watchdog of the slaves
 *  runs already, so add the tasks and run soon; slaves that it took out of Operational by then are brought back before
 *  the first cycle. @rt init */
static inline cm1e_error_t cm1e_scheduler_create(cm1e_scheduler_t **scheduler, cm1e_bus_t *bus,
                                                 const cm1e_scheduler_config_t *config, cm1e_diag_t *diag)
{
    return cm1e_scheduler_create_sized(scheduler, bus, config, sizeof(cm1e_scheduler_config_t), diag);
}
/** Adds another bus in Operational, with its axes behind those of the buses before, before the scheduler runs. All
 *  buses are exchanged in the same cycle: the frames of all are sent before the first answer is waited for. Their
 *  axes are in the same program, and a lost bus concerns its own axes only. A slave axis whose master is on another
 *  bus rides out what either bus loses up to its `lost_cycles_limit`, and so does a group with axes on several. Each
 *  bus has a control socket of its own (docs/CONTROL.md). A bus that was started waits for its scheduler without harm
 *  while its thread starts another one. The bus must outlive the scheduler. CM1E_ERROR_INVALID_ARGUMENT: another cycle
 *  time, another clock (`virtual_time`), distributed clocks that follow no clock of the buses before because the bus
 *  was not started in the same thread while one of them was in operation, more than CM1E_MAX_BUSES buses or
 *  CM1E_MAX_AXES axes, or a name that another axis has. CM1E_ERROR_STATE: the bus is not in operation, the
 *  scheduler ran, or its trace has variables, objects or a trigger already. @rt init */
CM1E_API cm1e_error_t cm1e_scheduler_add_bus(cm1e_scheduler_t *scheduler, cm1e_bus_t *bus, cm1e_diag_t *diag);
/** Frees a scheduler that does not run. NULL is allowed. In a task it is refused, and the run ends in order with an
 *  error. @rt init */
CM1E_API void cm1e_scheduler_destroy(cm1e_scheduler_t *scheduler);
/** Does the work of cm1e_scheduler_add_task(), for a program with this size of a task. @rt init */
CM1E_API cm1e_error_t cm1e_scheduler_add_task_sized(cm1e_scheduler_t *scheduler, const cm1e_task_config_t *task,
                                                    size_t size, cm1e_diag_t *diag);
/** Adds a task, before the scheduler runs. `task` is copied. The interval must be a multiple of the bus cycle.
 *  @rt init */
static inline cm1e_error_t cm1e_scheduler_add_task(cm1e_scheduler_t *scheduler, const cm1e_task_config_t *task,
                                                   cm1e_diag_t *diag)
{
    return cm1e_scheduler_add_task_sized(scheduler, task, sizeof(cm1e_task_config_t), diag);
}
/** The reference of the configured axis `index` (0 = first); Handle 0 if there is none. @rt any */
CM1E_API AXIS_REF_t cm1e_scheduler_axis(const cm1e_scheduler_t *scheduler, uint32_t index);
/** The reference of the axis with this name; Handle 0 if there is none. @rt any */
CM1E_API AXIS_REF_t cm1e_scheduler_axis_by_name(const cm1e_scheduler_t *scheduler, const char *name);

/** Runs the cycle in the calling thread for `duration_ns` (0: until cm1e_scheduler_stop()), then stops in order: axes
 *  ramp down, drives are disabled, slaves go to Safe-Operational and Init. A scheduler runs once. A missed cycle is
 *  skipped, never executed later. A lost bus does not end the run: the axes are in ErrorStop, programs see it, and
 *  slaves that come back can be reset. Errors:
 *  CM1E_ERROR_STATE: the scheduler ran before; the bus was stopped or started again since it was made; or a task called
 *  cm1e_scheduler_destroy(), cm1e_bus_close() or cm1e_bus_stop(), or another thread one of the last two, which was
 *  refused and ended the run.
 *  CM1E_ERROR_PERMISSION: real time is required and not permitted; no cycle was run.
 *  CM1E_ERROR_NO_MEMORY: for the trace, or for the watch over the tasks; no cycle was run.
 *  CM1E_ERROR_BUS_STATE and other errors of a start: a slave left Operational before the first cycle and does not come
 *  back; no cycle was run.
 *  CM1E_ERROR_TIMEOUT: an axis was not disabled within the stop timeout.
 *  CM1E_ERROR_PROGRAM: a task did not return within its `watchdog_cycles` (an endless loop, or it waits). The call is
 *  ended where it is, as by longjmp(), and the task is not called again. All axes are in ErrorStop with this error and
 *  brake, while the cycle goes on. Other tasks are called on; without any the run ends in order. This is judged in real
 *  time only, not on virtual time. A signal ends the call, SIGRTMAX - 3, which the program must not use meanwhile. What
 *  the call held (locks, memory) stays as it is: end the process after the run.
 *  After cycles were run, and where an error came before the first one, the bus is stopped. A call that is refused
 *  (CM1E_ERROR_STATE, or CM1E_ERROR_INVALID_ARGUMENT: a negative duration) leaves it as it is. @rt init */
CM1E_API cm1e_error_t cm1e_scheduler_run(cm1e_scheduler_t *scheduler, int64_t duration_ns, cm1e_diag_t *diag);
/** Ends the run in order. Any thread, program or signal handler may call it. @rt any */
CM1E_API void cm1e_scheduler_stop(cm1e_scheduler_t *scheduler);
/** Lets these signals stop this scheduler in order, until it is destroyed: SIGINT, SIGTERM, SIGHUP (terminal closed),
 *  SIGQUIT, SIGTSTP (Ctrl-Z), SIGPIPE, SIGXCPU, SIGXFSZ. A second signal changes nothing, nor does any further one: the
 *  ramp-down is not shortened. It is bounded by `stop_timeout_ns`, and only SIGKILL ends it before. A signal that the
 *  program ignores stays ignored (SIGHUP under nohup), except SIGINT and SIGTERM. Handlers of the program are replaced,
 *  and act again afterwards. Only one scheduler per process may use it. @rt init */
CM1E_API void cm1e_scheduler_stop_on_signals(cm1e_scheduler_t *scheduler);
/** Planned time of this cycle since the first one, in ns; it is constant during a scan. @rt cycle */
CM1E_API int64_t cm1e_scheduler_time_ns(const cm1e_scheduler_t *scheduler);
/** Marks this cycle with a text that the plot of the trace shows (the last 64 are kept). `text` must live until the
 *  scheduler is destroyed. Call it in a program. @rt cycle */
CM1E_API void cm1e_scheduler_mark(cm1e_scheduler_t *scheduler, const char *text);
/** Does the work of cm1e_scheduler_statistics(), for a program with this size of the statistics. @rt any */
CM1E_API void cm1e_scheduler_statistics_sized(const cm1e_scheduler_t *scheduler,
                                              cm1e_scheduler_statistics_t *statistics, size_t size);
/** Copies the statistics, before, during or after the run, from any thread. The numbers of one distribution are all of
 *  the same cycle; during the run other numbers may be of a cycle before or after it. @rt any */
static inline void cm1e_scheduler_statistics(const cm1e_scheduler_t *scheduler,
                                             cm1e_scheduler_statistics_t *statistics)
{
    cm1e_scheduler_statistics_sized(scheduler, statistics, sizeof(cm1e_scheduler_statistics_t));
}

/** Checks before the run whether cm1e_scheduler_write_csv() and cm1e_scheduler_write_svg() can write `path`. Returns
 *  CM1E_ERROR_IO if not; `diag` has the reason. Leaves no file behind. @rt block */
CM1E_API cm1e_error_t cm1e_scheduler_check_path(const char *path, cm1e_diag_t *diag);
/** Writes the trace as CSV after the run: time, and per axis state, set and actual position and velocity, torque. It
 *  writes a new file beside `path` and renames it when it is complete. Returns CM1E_ERROR_STATE without a trace.
 *  @rt block */
CM1E_API cm1e_error_t cm1e_scheduler_write_csv(const cm1e_scheduler_t *scheduler, const char *path, cm1e_diag_t *diag);

#ifdef __cplusplus
}
#endif
#endif
