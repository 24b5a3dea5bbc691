#include "scheduler/statistics.h"

#include <stdio.h>
#include <string.h>

#define READ(number) atomic_load_explicit(&(number), memory_order_relaxed)
#define WRITE(number, value) atomic_store_explicit(&(number), (value), memory_order_relaxed)
/* Of a distribution: what is written after its sequence, and read before the sequence is read again. */
#define READ_BEFORE(number) atomic_load_explicit(&(number), memory_order_acquire)
#define WRITE_AFTER(number, value) atomic_store_explicit(&(number), (value), memory_order_release)

/** Bucket n holds times from 2^(n-1) us to below 2^n us, the first all below 1 us, the last all that are longer. */
static unsigned bucket_of(int64_t time_ns)
{
    unsigned bucket = 0;
    for (int64_t us = time_ns / 1000; us > 0 && bucket < CM1E_HISTOGRAM_BUCKETS - 1; us >>= 1)
        bucket++;
    return bucket;
}

static void add_to(distribution_copy_t *copy, int64_t time_ns)
{
    const uint64_t count = READ(copy->count);
    _Atomic uint64_t *bucket = &copy->histogram[bucket_of(time_ns)];
    if (count == 0 || time_ns < READ(copy->minimum_ns))
        WRITE_AFTER(copy->minimum_ns, time_ns);
    if (count == 0 || time_ns > READ(copy->maximum_ns))
        WRITE_AFTER(copy->maximum_ns, time_ns);
    WRITE_AFTER(copy->sum_ns, READ(copy->sum_ns) + time_ns);
    WRITE_AFTER(*bucket, READ(*bucket) + 1);
    WRITE_AFTER(copy->count, count + 1);
}

void cm1e_distribution_add(distribution_t *distribution, int64_t time_ns)
{
    const uint64_t sequence = READ(distribution->sequence);
    for (unsigned i = 0; i < 2; i++) {
        WRITE_AFTER(distribution->sequence, sequence + 1 + i); /* readers take the other copy */
        add_to(&distribution->copies[i], time_ns);
    }
}

void cm1e_statistics_note_bus(statistics_t *statistics, uint32_t number, const cm1e_bus_counters_t *counters,
                              uint64_t sync_losses)
{
    bus_numbers_t *numbers = &statistics->buses[number];
    WRITE(numbers->cycles, counters->cycles);
    WRITE(numbers->lost_frames, counters->lost_frames);
    WRITE(numbers->working_counter_errors, counters->working_counter_errors);
    WRITE(numbers->late_frames, counters->late_frames);
    WRITE(numbers->foreign_frames, counters->foreign_frames);
    WRITE(numbers->unsent_frames, counters->unsent_frames);
    WRITE(numbers->mailbox_retries, counters->mailbox_retries);
    WRITE(numbers->sync_losses, sync_losses);
}

void cm1e_statistics_note_clocks(statistics_t *statistics, const cm1e_bus_clocks_t *clocks)
{
    if (!clocks->used)
        return;
    WRITE(statistics->clocks_used, true);
    WRITE(statistics->clock_reference, clocks->reference);
    WRITE(statistics->clock_reference_ns, clocks->reference_ns);
    WRITE(statistics->clock_rate_ppb, (int64_t)(clocks->rate_ppm * 1000));
    WRITE(statistics->phase_error_ns, clocks->phase_error_ns);
    WRITE(statistics->phase_mean_ns, (int64_t)clocks->phase_mean_ns);
    WRITE(statistics->phase_maximum_ns, clocks->phase_maximum_ns);
}

static cm1e_bus_clocks_t read_clocks(const statistics_t *statistics)
{
    return (cm1e_bus_clocks_t){
        .used = READ(statistics->clocks_used),
        .reference = (uint16_t)READ(statistics->clock_reference),
        .reference_ns = READ(statistics->clock_reference_ns),
        .rate_ppm = (double)READ(statistics->clock_rate_ppb) * 1e-3,
        .phase_error_ns = READ(statistics->phase_error_ns),
        .phase_mean_ns = (double)READ(statistics->phase_mean_ns),
        .phase_maximum_ns = READ(statistics->phase_maximum_ns),
    };
}

void cm1e_statistics_publish_realtime(statistics_t *statistics, bool realtime, const char *advice)
{
    snprintf(statistics->advice, sizeof statistics->advice, "%s", advice);
    WRITE(statistics->realtime, realtime);
    atomic_store_explicit(&statistics->ready, true, memory_order_release);
}

/** False: a time was added meanwhile. */
static bool read_between(const distribution_t *distribution, cm1e_distribution_t *copy)
{
    const uint64_t sequence = READ_BEFORE(distribution->sequence);
    const distribution_copy_t *whole = &distribution->copies[sequence & 1];
    copy->count = READ_BEFORE(whole->count);
    copy->minimum_ns = READ_BEFORE(whole->minimum_ns);
    copy->maximum_ns = READ_BEFORE(whole->maximum_ns);
    copy->sum_ns = READ_BEFORE(whole->sum_ns);
    for (unsigned i = 0; i < CM1E_HISTOGRAM_BUCKETS; i++)
        copy->histogram[i] = READ_BEFORE(whole->histogram[i]);
    return READ(distribution->sequence) == sequence;
}

void cm1e_distribution_read(const distribution_t *distribution, cm1e_distribution_t *copy)
{
    while (!read_between(distribution, copy))
        ;
}

uint64_t cm1e_statistics_read_bus(const statistics_t *statistics, uint32_t number, cm1e_bus_counters_t *copy)
{
    const bus_numbers_t *numbers = &statistics->buses[number];
    *copy = (cm1e_bus_counters_t){
        .cycles = READ(numbers->cycles),
        .lost_frames = READ(numbers->lost_frames),
        .working_counter_errors = READ(numbers->working_counter_errors),
        .late_frames = READ(numbers->late_frames),
        .foreign_frames = READ(numbers->foreign_frames),
        .unsent_frames = READ(numbers->unsent_frames),
        .mailbox_retries = READ(numbers->mailbox_retries),
    };
    return READ(numbers->sync_losses);
}

static void read_all_buses(const statistics_t *statistics, cm1e_bus_counters_t *all, uint64_t *sync_losses)
{
    *sync_losses = cm1e_statistics_read_bus(statistics, 0, all);
    for (uint32_t number = 1; number < CM1E_MAX_BUSES; number++) {
        cm1e_bus_counters_t more;
        *sync_losses += cm1e_statistics_read_bus(statistics, number, &more);
        all->lost_frames += more.lost_frames;
        all->working_counter_errors += more.working_counter_errors;
        all->late_frames += more.late_frames;
        all->foreign_frames += more.foreign_frames;
        all->unsent_frames += more.unsent_frames;
        all->mailbox_retries += more.mailbox_retries;
    }
}

void cm1e_statistics_read(const statistics_t *statistics, cm1e_scheduler_statistics_t *copy)
{
    *copy = (cm1e_scheduler_statistics_t){0};
    cm1e_distribution_read(&statistics->cycle_time, &copy->cycle_time);
    cm1e_distribution_read(&statistics->wake_up_latency, &copy->wake_up_latency);
    cm1e_distribution_read(&statistics->execution_time, &copy->execution_time);
    copy->cycles = READ(statistics->cycles);
    copy->overruns = READ(statistics->overruns);
    copy->clocks = read_clocks(statistics);
    read_all_buses(statistics, &copy->bus, &copy->clocks.sync_losses);
    if (atomic_load_explicit(&statistics->ready, memory_order_acquire)) {
        copy->realtime = READ(statistics->realtime);
        memcpy(copy->advice, statistics->advice, sizeof copy->advice);
        memcpy(copy->control_socket, statistics->control_socket, sizeof copy->control_socket);
        memcpy(copy->control_advice, statistics->control_advice, sizeof copy->control_advice);
    }
}
