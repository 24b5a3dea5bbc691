/**
 * How late the thread of the cycle wakes up: the scheduler itself, with one simulated drive in this process, so that no
 * network interface has a part in it. scripts/bench runs it and cyclictest in turns.
 *
 *     bench_wakeup [CPU [CYCLES]]    CPU: 1 = first, 0 (default): any; 5000 cycles of 1 ms
 */
#include <stdio.h>
#include <stdlib.h>

#include "cm1e/scheduler.h"
#include "scheduler/trace_recorder.h"
#include "sort.h"

enum { WARM = 100, USUAL_CYCLES = 5000 };

static cm1e_scheduler_t *scheduler;
static double *late_us;
static long seen, wanted;

static void fail(const char *why)
{
    fprintf(stderr, "bench_wakeup: %s\n", why);
    exit(1);
}

static void note(void *context)
{
    (void)context;
    const long n = seen++ - WARM;
    if (n >= 0 && n < wanted)
        late_us[n] = cm1e_scheduler_trace(scheduler)->timing.wake_up_latency_us;
    if (n == wanted)
        cm1e_scheduler_stop(scheduler);
}

static void run(int cpu)
{
    cm1e_bus_config_t config;
    cm1e_bus_t *bus;
    cm1e_diag_t diag = {0};
    const cm1e_scheduler_config_t how = {.cpu = cpu, .realtime_required = true};
    const cm1e_task_config_t task = {.program = note};
    cm1e_bus_config_init(&config, "sim", 1);
    config.lost_cycles_limit = 50;
    if (cm1e_bus_open(&bus, &config, &diag) != CM1E_OK || cm1e_bus_start(bus, &diag) != CM1E_OK ||
        cm1e_scheduler_create(&scheduler, bus, &how, &diag) != CM1E_OK ||
        cm1e_scheduler_add_task(scheduler, &task, &diag) != CM1E_OK ||
        cm1e_scheduler_run(scheduler, 0, &diag) != CM1E_OK)
        fail(diag.text);
    cm1e_scheduler_destroy(scheduler);
    cm1e_bus_close(bus);
    cm1e_bus_config_free(&config);
}

int main(int words, char **word)
{
    const int cpu = words > 1 ? atoi(word[1]) : 0;
    wanted = words > 2 ? atol(word[2]) : USUAL_CYCLES;
    if (cpu < 0 || wanted < 1)
        fail("bench_wakeup [CPU [CYCLES]]: a processor from 1 on, or 0, and at least one cycle");
    late_us = calloc((size_t)wanted, sizeof *late_us);
    if (!late_us)
        fail("no memory");
    run(cpu);
    sort_values(late_us, (size_t)wanted);
    printf("us late: median %.2f, 99.9 %% %.2f, worst %.2f, of %ld cycles\n", late_us[wanted / 2],
           late_us[wanted * 999 / 1000], late_us[wanted - 1], wanted);
    free(late_us);
    return 0;
}
