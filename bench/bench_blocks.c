/**
 * What an axis costs in the cycle, without the frames: its function blocks, its state machine and its trajectory (a),
 * and with the drive below it, scaling, lag monitoring and the process image (a+b); and what the cycle costs in which
 * a command starts. With --peer LIBRARY the same moves are done by another implementation, in turn with ours, in the
 * same process on the same CPU (see bench/blocks).
 *
 * On a machine that others use too, single times say little. So the work is timed in many short pieces, in many rounds:
 * the best time of a piece over all rounds is what the work costs ("cost"), all times together are what was seen here
 * and now ("seen").
 */
#include <dlfcn.h>
#include <sched.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "axis/axis_private.h"
#include "blocks_subject.h"
#include "cm1e/plcopen.h"

enum {
    BUSES = 2, BUS_AXES = BLOCKS_MAX_AXES / BUSES,
    CYCLES = 1000,        /* timed of each move; the shortest move takes a little longer */
    PIECE = 256,          /* axis cycles that are timed together */
    MAX_ROUNDS = 200, STARTS = 5000, SUBJECTS = 3,
};
#define CYCLE_NS INT64_C(1000000)

static double now_ns(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e9 + (double)t.tv_nsec;
}

/* ---- the heap, seen at link time (CMakeLists.txt) ---------------------------------------------------------------- */

static size_t heap;
void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *memory, size_t size);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *memory, size_t size);

void *__wrap_malloc(size_t size)
{
    heap += size;
    return __real_malloc(size);
}
void *__wrap_calloc(size_t count, size_t size)
{
    heap += count * size;
    return __real_calloc(count, size);
}
void *__wrap_realloc(void *memory, size_t size)
{
    heap += size;
    return __real_realloc(memory, size);
}
static size_t heap_bytes(void) { return heap; }

/* ---- this library as a subject ----------------------------------------------------------------------------------- */

static cm1e_bus_t *buses[BUSES];
static cm1e_axis_t *axes[BLOCKS_MAX_AXES];
static AXIS_REF_t references[BLOCKS_MAX_AXES];
static MC_Power_t powers[BLOCKS_MAX_AXES];
static MC_MoveAbsolute_t moves[BLOCKS_MAX_AXES];
static int64_t cycle_now_ns;

static void fail(const char *why)
{
    fprintf(stderr, "%s\n", why);
    exit(1);
}

/* The process image stands still while the bench runs, so the lag grows with the set-point and must be allowed. */
static cm1e_bus_t *start_bus(void)
{
    static cm1e_bus_config_t config;
    cm1e_bus_config_init(&config, "sim", BUS_AXES);
    config.virtual_time = true;
    config.cycle_time_ns = CYCLE_NS;
    for (uint32_t i = 0; i < BUS_AXES; i++) {
        cm1e_axis_config_t *axis = &config.axes[i];
        axis->counts_per_unit = 500;
        axis->max_velocity = BLOCKS_VELOCITY;
        axis->max_acceleration = axis->max_deceleration = BLOCKS_ACCELERATION;
        axis->max_jerk = BLOCKS_JERK;
        axis->software_limit_negative = -1000;
        axis->software_limit_positive = 1000;
        axis->max_position_lag = 1e6;
    }
    cm1e_diag_t diag = {0};
    cm1e_bus_t *bus = NULL;
    if (cm1e_bus_open(&bus, &config, &diag) || cm1e_bus_start(bus, &diag))
        fail(diag.text);
    return bus;
}

/* (a): the programs and what the axis does for them. */
static void run_blocks(unsigned count, unsigned cycles)
{
    while (cycles-- > 0)
        for (unsigned i = 0; i < count; i++) {
            MC_Power(&powers[i]);
            MC_MoveAbsolute(&moves[i]);
            cm1e_axis_advance(axes[i]);
        }
}

/* (a+b): the same in the scheduler's order: inputs of all axes, programs, outputs of all axes. */
static void run_whole(unsigned count, unsigned cycles)
{
    while (cycles-- > 0) {
        cycle_now_ns += CYCLE_NS;
        for (unsigned i = 0; i < count; i++)
            cm1e_axis_inputs(axes[i], CM1E_OK, CM1E_OK, cycle_now_ns);
        for (unsigned i = 0; i < count; i++) {
            MC_Power(&powers[i]);
            MC_MoveAbsolute(&moves[i]);
        }
        for (unsigned i = 0; i < count; i++)
            cm1e_axis_outputs(axes[i]);
    }
}

static bool make(unsigned count)
{
    cm1e_diag_t diag = {0};
    if (axes[0])
        return true; /* our two subjects work on the same axes */
    for (unsigned i = 0; i < BUSES; i++)
        buses[i] = start_bus();
    for (unsigned i = 0; i < count; i++) {
        if (cm1e_axis_create(&axes[i], buses[i / BUS_AXES], i % BUS_AXES, &diag))
            fail(diag.text);
        references[i] = cm1e_axis_reference(axes[i]);
        powers[i] = (MC_Power_t){.Axis = &references[i], .Enable = TRUE, .EnablePositive = TRUE,
                                 .EnableNegative = TRUE};
        moves[i].Axis = &references[i];
    }
    cycle_now_ns = cm1e_clock_now(cm1e_bus_clock(buses[0]));
    for (int cycle = 0; cycle < 200; cycle++) { /* the way to Operation enabled needs the frames */
        for (unsigned i = 0; i < BUSES; i++) {
            cm1e_clock_sleep_until(cm1e_bus_clock(buses[i]), cycle_now_ns + CYCLE_NS);
            if (cm1e_bus_receive(buses[i]))
                return false;
        }
        run_whole(count, 1);
        for (unsigned i = 0; i < BUSES; i++)
            cm1e_bus_send(buses[i]);
    }
    bool powered = true;
    for (unsigned i = 0; i < count; i++)
        powered &= powers[i].Status;
    return powered;
}

static void give(unsigned i, const blocks_move_t *move)
{
    moves[i].Execute = FALSE;
    MC_MoveAbsolute(&moves[i]);
    moves[i].Position = move->position;
    moves[i].Velocity = move->velocity;
    moves[i].Acceleration = move->acceleration;
    moves[i].Deceleration = move->deceleration;
    moves[i].Jerk = move->jerk;
    moves[i].Execute = TRUE;
}

static bool done(unsigned i) { return moves[i].Done; }
static bool failed(unsigned i) { return moves[i].Error || moves[i].CommandAborted; }

#define OUR_BYTES sizeof(struct cm1e_axis), sizeof(MC_Power_t), sizeof(MC_MoveAbsolute_t)
static const blocks_subject_t our_blocks = {"cm1e (a)", make, give, run_blocks, done, failed, heap_bytes, OUR_BYTES};
static const blocks_subject_t our_whole = {"cm1e (a+b)", make, give, run_whole, done, failed, heap_bytes, OUR_BYTES};

/* ---- statistics -------------------------------------------------------------------------------------------------- */

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double quantile(double *values, unsigned count, double part)
{
    qsort(values, count, sizeof values[0], compare);
    return values[(unsigned)(part * (count - 1))];
}

static double clock_ns; /* what one pair of readings costs: subtracted everywhere */

static void time_the_clock(void)
{
    clock_ns = 1e9;
    for (int i = 0; i < 100000; i++) {
        const double begin = now_ns(), spent = now_ns() - begin;
        clock_ns = spent < clock_ns ? spent : clock_ns;
    }
}

static double time_run(const blocks_subject_t *subject, unsigned count, unsigned cycles)
{
    const double begin = now_ns();
    subject->run(count, cycles);
    return now_ns() - begin - clock_ns;
}

/* ---- the steady state and simultaneous starts -------------------------------------------------------------------- */

/** Of one subject and one number of axes; times in ns. */
typedef struct series {
    unsigned pieces, rounds;
    double cost[CYCLES];                /* of a piece of the move, per axis and cycle: the best of all rounds */
    double seen[MAX_ROUNDS * CYCLES];
    double starts[MAX_ROUNDS];          /* of the cycle in which all axes start */
    bool far;                           /* where the axes stand */
    size_t heap_bytes;                  /* taken meanwhile */
} series_t;

static series_t series[SUBJECTS];

static void run_to_the_end(const blocks_subject_t *subject, unsigned count)
{
    for (unsigned i = 0; i < count; i++)
        for (int cycles = 0; !subject->done(i); cycles++) {
            if (subject->failed(i) || cycles > 100000)
                fail("a move was not done");
            subject->run(count, 1);
        }
}

/* All axes go 250 units there or back, each at its own velocity, so that they are not all in the same phase. */
static void one_round(const blocks_subject_t *subject, unsigned count, series_t *s)
{
    s->far = !s->far;
    for (unsigned i = 0; i < count; i++) {
        const blocks_move_t move = {s->far ? 250 : 0, BLOCKS_VELOCITY * (1 - 0.3 * i / BLOCKS_MAX_AXES),
                                    BLOCKS_ACCELERATION / 2, BLOCKS_ACCELERATION / 2, BLOCKS_JERK / 2};
        subject->give(i, &move);
    }
    const size_t heap_before = subject->heap_bytes();
    s->starts[s->rounds] = time_run(subject, count, 1);
    const unsigned cycles = PIECE / count;
    s->pieces = CYCLES / cycles;
    for (unsigned p = 0; p < s->pieces; p++) {
        const double spent = time_run(subject, count, cycles) / (count * cycles);
        s->cost[p] = s->rounds == 0 || spent < s->cost[p] ? spent : s->cost[p];
        s->seen[s->rounds * s->pieces + p] = spent;
    }
    s->heap_bytes += subject->heap_bytes() - heap_before;
    s->rounds++;
    for (unsigned i = 0; i < count; i++)
        if (subject->done(i))
            fail("a move ended while it was timed");
    run_to_the_end(subject, count);
}

static void report_series(const blocks_subject_t *subject, unsigned count, series_t *s, double ours)
{
    const double median = quantile(s->cost, s->pieces, 0.5), worst = s->cost[s->pieces - 1];
    const unsigned samples = s->pieces * s->rounds;
    const double seen = quantile(s->seen, samples, 0.5), seen_worst = s->seen[samples - 1];
    printf("%4u  %-18s %7.1f %7.1f   %7.1f %9.0f", count, subject->name, median, worst, seen, seen_worst);
    if (ours > 0)
        printf("   %5.2f x (a)", median / ours);
    printf("\n");
}

static double steady_state(const blocks_subject_t *const *subjects, unsigned subject_count, unsigned count,
                           unsigned rounds)
{
    memset(series, 0, sizeof series);
    series[1].far = true; /* our two share their axes: there by the one, back by the other */
    for (unsigned round = 0; round < rounds; round++)
        for (unsigned i = 0; i < subject_count; i++) {
            const unsigned k = round % 2 ? subject_count - 1 - i : i;
            one_round(subjects[k], count, &series[k]);
        }
    double ours = 0;
    for (unsigned i = 0; i < subject_count; i++) {
        report_series(subjects[i], count, &series[i], ours);
        if (i == 0)
            ours = series[0].cost[series[0].pieces / 2];
    }
    return ours;
}

static void report_simultaneous(const blocks_subject_t *const *subjects, unsigned subject_count)
{
    printf("\nus of the cycle in which %d axes start at once\n%24s %7s %7s %7s\n", BLOCKS_MAX_AXES, "", "best",
           "median", "worst");
    for (unsigned i = 0; i < subject_count; i++) {
        series_t *s = &series[i];
        const double median = quantile(s->starts, s->rounds, 0.5);
        printf("      %-18s %7.1f %7.1f %7.1f\n", subjects[i]->name, s->starts[0] / 1e3, median / 1e3,
               s->starts[s->rounds - 1] / 1e3);
    }
    printf("\nbytes of heap taken in all cycles of %d axes, and bytes of an axis, its MC_Power, its MC_MoveAbsolute\n",
           BLOCKS_MAX_AXES);
    for (unsigned i = 0; i < subject_count; i++)
        printf("      %-18s %7zu  %7zu %7zu %7zu\n", subjects[i]->name, series[i].heap_bytes, subjects[i]->axis_bytes,
               subjects[i]->power_bytes, subjects[i]->move_bytes);
}

/* ---- the cycle in which one command starts ----------------------------------------------------------------------- */

static uint64_t random_state;

static double random_between(double low, double high) /* splitmix64 */
{
    uint64_t z = random_state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return low + (high - low) * ((double)((z ^ (z >> 31)) >> 11) * 0x1p-53);
}

static blocks_move_t random_move(void)
{
    return (blocks_move_t){
        .position = random_between(-200, 200),
        .velocity = random_between(0.1, 1) * BLOCKS_VELOCITY,
        .acceleration = random_between(0.1, 1) * BLOCKS_ACCELERATION,
        .deceleration = random_between(0.1, 1) * BLOCKS_ACCELERATION,
        .jerk = random_between(0.1, 1) * BLOCKS_JERK,
    };
}

/* Each problem once, from rest or in the middle of the move before. */
static void report_starts(const blocks_subject_t *subject, bool on_the_way)
{
    static double spent[STARTS];
    unsigned refused = 0;
    random_state = 1;
    for (unsigned i = 0; i < STARTS; i++) {
        const blocks_move_t move = random_move();
        subject->give(0, &move);
        spent[i] = time_run(subject, 1, 1);
        const unsigned cycles = (unsigned)random_between(1, 500);
        if (subject->failed(0))
            refused++;
        else if (on_the_way)
            subject->run(1, cycles);
        else
            run_to_the_end(subject, 1);
    }
    const double median = quantile(spent, STARTS, 0.5);
    printf("      %-18s %-12s %7.0f %7.0f %9.0f   refused %u of %d\n", subject->name,
           on_the_way ? "on the way" : "from rest", median, quantile(spent, STARTS, 0.99), spent[STARTS - 1], refused,
           STARTS);
}

/* ---- the program ------------------------------------------------------------------------------------------------- */

static const blocks_subject_t *load_peer(const char *path)
{
    void *library = dlopen(path, RTLD_NOW);
    const blocks_subject_t *peer = library ? dlsym(library, "blocks_subject") : NULL;
    if (!peer)
        fail(dlerror());
    return peer;
}

/* One CPU for all that is compared. */
static int stay_on_this_cpu(void)
{
    const int cpu = sched_getcpu();
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET((unsigned)cpu, &set);
    return sched_setaffinity(0, sizeof set, &set) ? -1 : cpu;
}

static void print_machine(int cpu, unsigned rounds)
{
    char line[256], *name = NULL;
    FILE *file = fopen("/proc/cpuinfo", "r");
    while (file && !name && fgets(line, sizeof line, file))
        name = strncmp(line, "model name", 10) ? NULL : strchr(line, ':');
    if (file)
        fclose(file);
    printf("%s; %s; compiled by %s; pinned: %s; %u rounds; the clock's own %.0f ns are subtracted\n",
           name ? strtok(name + 2, "\n") : "unknown CPU", sizeof(void *) == 8 ? "64 bit" : "32 bit", __VERSION__,
           cpu >= 0 ? "yes" : "no", rounds, clock_ns);
}

int main(int argc, char **argv)
{
    static const unsigned counts[] = {1, 8, 64, BLOCKS_MAX_AXES};
    const blocks_subject_t *subjects[SUBJECTS] = {&our_blocks, &our_whole};
    unsigned subject_count = 2, rounds = 50;
    for (int i = 1; i + 1 < argc; i += 2)
        if (!strcmp(argv[i], "--peer"))
            subjects[subject_count++] = load_peer(argv[i + 1]);
        else if (!strcmp(argv[i], "--rounds"))
            rounds = (unsigned)strtoul(argv[i + 1], NULL, 10);
    if (argc % 2 == 0 || rounds < 1 || rounds > MAX_ROUNDS)
        fail("bench_blocks [--rounds 1 ... 200] [--peer LIBRARY]");
    const int cpu = stay_on_this_cpu();
    time_the_clock();
    for (unsigned i = 0; i < subject_count; i++)
        if (!subjects[i]->make(BLOCKS_MAX_AXES))
            fail("the axes are not powered");
    print_machine(cpu, rounds);
    printf("\nns per axis and cycle, all axes in a move of MC_MoveAbsolute\n%4s  %-18s %15s   %17s\n", "axes", "",
           "cost: median, worst", "seen: median, worst");
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++)
        steady_state(subjects, subject_count, counts[i], rounds);
    report_simultaneous(subjects, subject_count);
    printf("\nns of the cycle in which one command starts\n%37s %7s %7s %9s\n", "", "median", "p99", "worst");
    for (unsigned i = 0; i < subject_count; i++)
        for (int on_the_way = 0; on_the_way < 2; on_the_way++) {
            run_to_the_end(subjects[i], 1);
            report_starts(subjects[i], on_the_way);
        }
    return 0;
}
