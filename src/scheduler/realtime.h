/**
 * @file realtime.h
 * What the operating system can do for the thread that runs the cycle: SCHED_FIFO, locked memory, a touched stack, one
 * CPU, exact timers, processors that do not sleep deeply. The advice about a missing privilege says what to do.
 */
#ifndef CM1E_SCHEDULER_REALTIME_H
#define CM1E_SCHEDULER_REALTIME_H

#include <sched.h>
#include <stdbool.h>
#include <stddef.h>

#include "cm1e/error.h"
#include "cm1e/scheduler.h"

enum { REALTIME_DEFAULT_PRIORITY = 80 };

/** State of the thread before, to be restored. */
typedef struct realtime {
    bool fifo, bound, awake;
    int policy, timer_slack_ns;
    int awake_fd;              /**< processors stay awake while it is open; valid if `awake` */
    struct sched_param parameters;
    cpu_set_t cpus;
} realtime_t;

/** Requests real time for the calling thread. Returns true if it is in force. Otherwise `advice` says what is missing,
 *  "" if nothing was requested. */
bool cm1e_realtime_begin(realtime_t *realtime, const cm1e_scheduler_config_t *config, char *advice, size_t size);
/** Restores the thread. Locked memory stays locked. */
void cm1e_realtime_end(const realtime_t *realtime);

#endif
