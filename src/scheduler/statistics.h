/**
 * @file statistics.h
 * Numbers that the cycle writes and any thread may read: atomics with one writer. Each number is consistent, and so are
 * the numbers of a distribution among each other; others may be of neighbouring cycles.
 */
#ifndef CM1E_SCHEDULER_STATISTICS_H
#define CM1E_SCHEDULER_STATISTICS_H

#include <stdatomic.h>

#include "cm1e/scheduler.h"

typedef struct distribution_copy {
    _Atomic int64_t minimum_ns, maximum_ns, sum_ns;
    _Atomic uint64_t count;
    _Atomic uint64_t histogram[CM1E_HISTOGRAM_BUCKETS];
} distribution_copy_t;

/** Two copies, written one after the other: a reader takes the one that is not being written, so a cycle that stands
 *  still in the middle of its writing holds nobody up. */
typedef struct distribution {
    _Atomic uint64_t sequence; /**< even: the first copy is whole; odd: the second */
    distribution_copy_t copies[2];
} distribution_t;

/** What one bus has counted in this run. */
typedef struct bus_numbers {
    _Atomic uint64_t cycles, lost_frames, working_counter_errors, late_frames, mailbox_retries, unsent_frames,
        foreign_frames, sync_losses;
} bus_numbers_t;

typedef struct statistics {
    distribution_t cycle_time, wake_up_latency, execution_time;
    _Atomic uint64_t cycles, overruns;
    bus_numbers_t buses[CM1E_MAX_BUSES]; /**< zeros: the scheduler has fewer */
    _Atomic bool clocks_used;
    _Atomic uint64_t clock_reference;
    _Atomic int64_t clock_rate_ppb, clock_reference_ns, phase_error_ns, phase_mean_ns, phase_maximum_ns;
    char advice[sizeof((cm1e_scheduler_statistics_t *)0)->advice]; /**< written once, before `ready` */
    char control_socket[sizeof((cm1e_scheduler_statistics_t *)0)->control_socket]; /**< as advice, the next too */
    char control_advice[sizeof((cm1e_scheduler_statistics_t *)0)->control_advice];
    _Atomic bool realtime, ready;
} statistics_t;

/** @rt cycle */
void cm1e_distribution_add(distribution_t *distribution, int64_t time_ns);
/** Copies numbers of one moment. @rt any */
void cm1e_distribution_read(const distribution_t *distribution, cm1e_distribution_t *copy);
/** `number`: of the bus, below CM1E_MAX_BUSES. @rt cycle */
void cm1e_statistics_note_bus(statistics_t *statistics, uint32_t number, const cm1e_bus_counters_t *counters,
                              uint64_t sync_losses);
/** Those of the bus that leads. Without distributed clocks nothing is stored. @rt cycle */
void cm1e_statistics_note_clocks(statistics_t *statistics, const cm1e_bus_clocks_t *clocks);
/** Stores the result of requesting real time; called once, before the first cycle. */
void cm1e_statistics_publish_realtime(statistics_t *statistics, bool realtime, const char *advice);
/** What one bus has counted, and returns how often it lost synchronism. @rt any */
uint64_t cm1e_statistics_read_bus(const statistics_t *statistics, uint32_t number, cm1e_bus_counters_t *copy);
/** The counters are those of all buses together, but the cycles, which are those of the first one. @rt any */
void cm1e_statistics_read(const statistics_t *statistics, cm1e_scheduler_statistics_t *copy);

#endif
