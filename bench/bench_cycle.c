/**
 * What one cycle costs in this process: SOEM's core, our port, the simulated segment behind it, and on top of that
 * axes with function blocks moving. Virtual time, so nothing sleeps; the figures are processor time.
 */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "bus/bus_image.h"
#include "cm1e/plcopen.h"
#include "cm1e/scheduler.h"
#include "sort.h"

enum { BATCHES = 20, BATCH_CYCLES = 5000, MOTION_SECONDS = 20 };

static double now_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + (double)t.tv_nsec * 1e-9;
}

static cm1e_bus_t *start_bus(uint32_t axes, int64_t cycle_ns)
{
    cm1e_bus_config_t config;
    cm1e_diag_t diag = {0};
    cm1e_bus_t *bus = NULL;
    cm1e_bus_config_init(&config, "sim", axes);
    config.virtual_time = true;
    config.cycle_time_ns = cycle_ns;
    for (uint32_t i = 0; i < axes; i++)
        config.axes[i].sim.no_stops = config.axes[i].sim.no_sensors = true;
    if (cm1e_bus_open(&bus, &config, &diag) != CM1E_OK || cm1e_bus_start(bus, &diag) != CM1E_OK) {
        fprintf(stderr, "%s\n", diag.text);
        exit(1);
    }
    cm1e_bus_config_free(&config);
    return bus;
}

/** Bus alone: receive and send at the cycle time, drives disabled. Median of the batches, us per cycle. */
static double bench_bus(uint32_t axes, int64_t cycle_ns)
{
    cm1e_bus_t *bus = start_bus(axes, cycle_ns);
    cm1e_clock_t *clock = cm1e_bus_clock(bus);
    int64_t next = cm1e_clock_now(clock);
    double batches[BATCHES];
    for (int batch = 0; batch < BATCHES; batch++) {
        const double start = now_s();
        for (int i = 0; i < BATCH_CYCLES; i++) {
            next += cycle_ns;
            cm1e_clock_sleep_until(clock, next);
            if (cm1e_bus_receive(bus) != CM1E_OK) {
                fprintf(stderr, "a cycle failed\n");
                exit(1);
            }
            cm1e_bus_send(bus);
        }
        batches[batch] = (now_s() - start) / BATCH_CYCLES * 1e6;
    }
    cm1e_bus_close(bus);
    sort_values(batches, BATCHES);
    return batches[BATCHES / 2];
}

enum { MAX_BENCH_AXES = 16 };
static AXIS_REF_t axes[MAX_BENCH_AXES];
static MC_Power_t powers[MAX_BENCH_AXES];
static MC_MoveVelocity_t moves[MAX_BENCH_AXES];
static uint32_t axis_count;

static void program(void *context)
{
    (void)context;
    for (uint32_t i = 0; i < axis_count; i++) {
        powers[i].Enable = TRUE;
        MC_Power(&powers[i]);
        moves[i].Execute = powers[i].Status;
        MC_MoveVelocity(&moves[i]);
    }
}

/** The whole cycle: scheduler, blocks, axes, drives, bus, segment; every axis turns. us per cycle. */
static double bench_motion(uint32_t count, int64_t cycle_ns)
{
    cm1e_bus_t *bus = start_bus(count, cycle_ns);
    cm1e_diag_t diag = {0};
    cm1e_scheduler_t *scheduler = NULL;
    const cm1e_task_config_t task = {.program = program};
    if (cm1e_scheduler_create(&scheduler, bus, NULL, &diag) != CM1E_OK
        || cm1e_scheduler_add_task(scheduler, &task, &diag) != CM1E_OK) {
        fprintf(stderr, "%s\n", diag.text);
        exit(1);
    }
    axis_count = count;
    for (uint32_t i = 0; i < count; i++) {
        axes[i] = cm1e_scheduler_axis(scheduler, i);
        powers[i] = (MC_Power_t){.Axis = &axes[i], .EnablePositive = TRUE, .EnableNegative = TRUE};
        moves[i] = (MC_MoveVelocity_t){.Axis = &axes[i], .Velocity = 5.0};
    }
    const double start = now_s();
    cm1e_scheduler_run(scheduler, MOTION_SECONDS * INT64_C(1000000000), &diag);
    const double seconds = now_s() - start;
    cm1e_scheduler_statistics_t statistics;
    cm1e_scheduler_statistics(scheduler, &statistics);
    cm1e_scheduler_destroy(scheduler);
    cm1e_bus_close(bus);
    return seconds / (double)statistics.cycles * 1e6;
}

int main(void)
{
    static const uint32_t counts[] = {1, 4, 16};
    printf("%-8s %-10s %14s %20s\n", "axes", "cycle us", "bus us/cycle", "all us/cycle");
    for (int c = 0; c < 2; c++)
        for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++) {
            const int64_t cycle_ns = c ? 250000 : 1000000;
            const double bus = bench_bus(counts[i], cycle_ns);
            const double all = bench_motion(counts[i], cycle_ns);
            printf("%-8u %-10d %14.2f %20.2f\n", counts[i], (int)(cycle_ns / 1000), bus, all);
        }
    return 0;
}
