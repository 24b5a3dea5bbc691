/**
 * @file statistics.h
 * Numbers that the cycle writes and any thread may read: relaxed atomics with one writer. Each number is consistent;
 * two numbers may be of neighbouring cycles.
 */
#ifndef CM1E_SCHEDULER_STATISTICS_H
#define CM1E_SCHEDULER_STATISTICS_H

#include <stdatomic.h>

#include "cm1e/scheduler.h"

typedef struct distribution {
    _Atomic int64_t minimum_ns, maximum_ns, sum_ns;
    _Atomic uint64_t count;
    _Atomic uint64_t histogram[CM1E_HISTOGRAM_BUCKETS];
} distribution_t;

typedef struct statistics {
    distribution_t cycle_time, wake_up_latency, execution_time;
    _Atomic uint64_t cycles, overruns;
    _Atomic uint64_t bus_cycles, lost_frames, working_counter_errors, late_frames, mailbox_retries, unsent_frames,
        foreign_frames;
    _Atomic bool clocks_used;
    _Atomic uint64_t clock_reference, sync_losses;
    _Atomic int64_t clock_rate_ppb, clock_reference_ns, phase_error_ns, phase_mean_ns, phase_maximum_ns;
    char advice[sizeof((cm1e_scheduler_statistics_t *)0)->advice]; /**< written once, before `ready` */
    char control_socket[sizeof((cm1e_scheduler_statistics_t *)0)->control_socket]; /**< as advice, the next too */
    char control_advice[sizeof((cm1e_scheduler_statistics_t *)0)->control_advice];
    _Atomic bool realtime, ready;
} statistics_t;

/** @rt cycle */
void cm1e_distribution_add(distribution_t *distribution, int64_t time_ns);
/** @rt cycle */
void cm1e_statistics_note_bus(statistics_t *statistics, const cm1e_bus_counters_t *counters);
/** Without distributed clocks nothing is stored. @rt cycle */
void cm1e_statistics_note_clocks(statistics_t *statistics, const cm1e_bus_clocks_t *clocks);
/** Stores the result of requesting real time; called once, before the first cycle. */
void cm1e_statistics_publish_realtime(statistics_t *statistics, bool realtime, const char *advice);
/** @rt any */
void cm1e_statistics_read(const statistics_t *statistics, cm1e_scheduler_statistics_t *copy);

#endif
