/**
 * What a program in Structured Text costs in a cycle, beside its twin in C: the three-axis machine of the example 03, on
 * the simulated segment and on virtual time. Each task is timed alone, the clock included in both; the two programs run in
 * turns, and the median of the ratios is printed.
 *
 *     bench_st EXAMPLES-FOLDER PROGRAM.so
 */
int example_main(int argc, char **argv);
#define main example_main
#include "../examples/03_plc_program.c"
#undef main

#include <dlfcn.h>
#include <strings.h>
#include <time.h>

#include "sort.h"
#include "st/st_program.h"

enum { TURNS = 15 };
#define RUN_NS (INT64_C(7000) * MS) /* the fault of the C twin comes later */

typedef struct timed {
    void (*run)(void *context);
    void *context;
    int64_t sum_ns;
    uint64_t calls;
} timed_t;

static int64_t clock_ns(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return t.tv_sec * INT64_C(1000000000) + t.tv_nsec;
}

static void timed_task(void *context)
{
    timed_t *timed = context;
    const int64_t begin = clock_ns();
    timed->run(timed->context);
    timed->sum_ns += clock_ns() - begin;
    timed->calls++;
}

static const st_program_t *st;
static void run_st(void *context)
{
    (void)context;
    st->tasks[0].run();
}

static void die(const char *text)
{
    fprintf(stderr, "%s\n", text);
    exit(1);
}

static void bind_axes(void)
{
    for (uint32_t i = 0; i < st->axes.count; i++)
        for (uint32_t k = 0; k < MAX_UNITS; k++) {
            const AXIS_REF_t axis = cm1e_scheduler_axis(m.scheduler, k);
            if (strcasecmp(cm1e_axis_name(axis), st->axes.first[i].name) == 0)
                *(AXIS_REF_t *)st->axes.first[i].data = axis;
        }
}

/** Nanoseconds of the task in a cycle, in one run. */
static double run_one(const char *bus_file, bool in_st)
{
    const options_t options = {.bus_file = bus_file, .interface_name = "sim", .virtual_time = true, .seconds = 100};
    cm1e_diag_t why = {0};
    timed_t timed = {.run = in_st ? run_st : motion_program};
    m = (struct machine){0};
    const cm1e_task_config_t task = {.name = "motion", .program = timed_task, .context = &timed};
    cm1e_bus_config_t config = {0};
    if (describe(&config, &options, &why) != CM1E_OK || cm1e_bus_open(&m.bus, &config, &why) != CM1E_OK ||
        cm1e_bus_start(m.bus, &why) != CM1E_OK || cm1e_scheduler_create(&m.scheduler, m.bus, NULL, &why) != CM1E_OK)
        die(why.text);
    cm1e_bus_config_free(&config);
    make_machine(cm1e_bus_configuration(m.bus), options.seconds);
    st->begin();
    bind_axes();
    if (cm1e_scheduler_add_task(m.scheduler, &task, &why) != CM1E_OK ||
        cm1e_scheduler_run(m.scheduler, RUN_NS, &why) != CM1E_OK)
        die(why.text);
    cm1e_scheduler_destroy(m.scheduler);
    cm1e_bus_close(m.bus);
    return (double)timed.sum_ns / (double)timed.calls;
}

static double median(double *values)
{
    sort_values(values, TURNS);
    return values[TURNS / 2];
}

int main(int argc, char **argv)
{
    char bus_file[4096];
    double c[TURNS], in_st[TURNS], ratios[TURNS];
    void *library = argc == 3 ? dlopen(argv[2], RTLD_NOW) : NULL;
    st = library ? dlsym(library, "cm1e_st_program") : NULL;
    if (!st)
        die(argc == 3 ? dlerror() : "bench_st EXAMPLES-FOLDER PROGRAM.so");
    snprintf(bus_file, sizeof bus_file, "%s/three_axes.yaml", argv[1]);
    for (int i = 0; i < TURNS; i++) {
        c[i] = run_one(bus_file, false);
        in_st[i] = run_one(bus_file, true);
        ratios[i] = in_st[i] / c[i];
    }
    const double ratio = median(ratios);
    printf("three axes, ns per cycle of the program: C %.0f, Structured Text %.0f; ratio %.2f (at most 1.5)\n", median(c),
           median(in_st), ratio);
    return ratio <= 1.5 ? EXIT_SUCCESS : EXIT_FAILURE;
}
