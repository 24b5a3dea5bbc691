/**
 * What an axis costs in the cycle, without the frames: its function blocks, its state machine and its trajectory (a),
 * and with the drive below it, scaling, lag monitoring and the process image (a+b); axes that move by themselves, that
 * follow a master by a gear or a cam, and groups of axes on a path; and what the cycle costs in which a command starts.
 * With --peer LIBRARY the same work is done by another implementation, in turn with ours, in the same process on the
 * same CPU (see bench/blocks).
 *
 * On a machine that others use too, single times say little. So the work is timed in many short pieces, in many rounds:
 * the best time of a piece over all rounds is what the work costs ("cost"), all times together are what was seen here
 * and now ("seen").
 */
#include <dlfcn.h>
#include <math.h>
#include <sched.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "blocks_cm1e.h"
#include "sort.h"

enum {
    CYCLES = 1000,        /* timed of each move; the shortest move takes a little longer */
    PIECE = 256,          /* axis cycles that are timed together */
    MAX_ROUNDS = 200, STARTS = 5000, SUBJECTS = 3, ROWS = 4,
};

typedef struct work {
    const char *title;
    unsigned axes[ROWS]; /* 0: no further row */
} work_t;

static const work_t works[BLOCKS_WORKS] = {
    [BLOCKS_MOVE] = {"all axes in a move of MC_MoveAbsolute", {1, 16, 64, BLOCKS_MAX_AXES}},
    [BLOCKS_GEAR] = {"every eighth axis so, the others in gear with it (MC_GearIn)", {2, 16, 64, BLOCKS_MAX_AXES}},
    [BLOCKS_CAM_LINEAR] = {"the others by a cam (MC_CamIn): straight lines", {2, 16, 64, BLOCKS_MAX_AXES}},
    [BLOCKS_CAM_CUBIC] = {"by a cam: cubic spline", {2, 16, 64, BLOCKS_MAX_AXES}},
    [BLOCKS_CAM_POLYNOMIAL] = {"by a cam: polynomials of degree 5", {2, 16, 64, BLOCKS_MAX_AXES}},
    [BLOCKS_GROUP] = {"groups of three axes on a path of lines and arcs",
                      {BLOCKS_MEMBERS, 8 * BLOCKS_MEMBERS, BLOCKS_GROUPS * BLOCKS_MEMBERS}},
};

static void fail(const char *why)
{
    fprintf(stderr, "%s\n", why);
    exit(1);
}

static double now_ns(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e9 + (double)t.tv_nsec;
}

/* ---- statistics -------------------------------------------------------------------------------------------------- */

static double quantile(double *values, unsigned count, double part)
{
    sort_values(values, count);
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
            if (subject->failed(i) || cycles > 100000) {
                fprintf(stderr, "%s, axis %u at %g: ", subject->name, i, subject->position(i));
                fail("a move was not done");
            }
            subject->run(count, 1);
        }
}

/* All axes at 0, each for itself. */
static void go_home(const blocks_subject_t *subject, unsigned count)
{
    const blocks_move_t home = {0, BLOCKS_VELOCITY, BLOCKS_ACCELERATION, BLOCKS_ACCELERATION, BLOCKS_JERK};
    subject->end();
    for (unsigned i = 0; i < count; i++)
        subject->give(i, &home);
    subject->run(count, 1);
    run_to_the_end(subject, count);
}

static double end_position(blocks_work_t work, unsigned axis, bool far)
{
    const blocks_piece_t last = blocks_path(far, BLOCKS_PIECES - 1);
    if (work == BLOCKS_GROUP)
        return last.end[axis % BLOCKS_MEMBERS];
    if (!blocks_follows(work, axis))
        return far ? BLOCKS_FAR : 0;
    return !far ? 0 : work == BLOCKS_GEAR ? BLOCKS_RATIO * BLOCKS_FAR : BLOCKS_CAM_HEIGHT;
}

/* All axes go there or back, each that is by itself at its own velocity, so that they are not all in the same phase. */
static void one_round(const blocks_subject_t *subject, blocks_work_t work, unsigned count, series_t *s)
{
    s->far = !s->far;
    for (unsigned i = 0; i < count; i++) {
        const blocks_move_t move = {s->far ? BLOCKS_FAR : 0, BLOCKS_VELOCITY * (1 - 0.3 * i / BLOCKS_MAX_AXES),
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
    if (subject->done(0))
        fail("a move ended while it was timed");
    run_to_the_end(subject, count);
    for (unsigned i = 0; i < count; i++)
        if (subject->failed(i) || fabs(subject->position(i) - end_position(work, i, s->far)) > 1e-3)
            fail("an axis is not where it should be");
}

/* Of one row: the cost of each subject (median), 0 where it has nothing like that. */
static void measure_row(const blocks_subject_t *const *subjects, unsigned subject_count, blocks_work_t work,
                        unsigned count, unsigned rounds, double *cost)
{
    bool there[SUBJECTS];
    memset(series, 0, sizeof series);
    for (unsigned i = 0; i < subject_count; i++)
        there[i] = i == 1 ? there[0] : subjects[i]->begin(work, count);
    series[1].far = true; /* our two share their axes: there by the one, back by the other */
    for (unsigned round = 0; round < rounds; round++)
        for (unsigned i = 0; i < subject_count; i++) {
            const unsigned k = round % 2 ? subject_count - 1 - i : i;
            if (there[k])
                one_round(subjects[k], work, count, &series[k]);
        }
    for (unsigned i = 0; i < subject_count; i++) {
        series_t *s = &series[i];
        cost[i] = there[i] ? quantile(s->cost, s->pieces, 0.5) : 0;
        if (i != 0) /* with the second of our two */
            go_home(subjects[i], count);
    }
}

static void print_row(const blocks_subject_t *const *subjects, unsigned subject_count, blocks_work_t work,
                      unsigned count, const double *cost, const double *moving)
{
    for (unsigned i = 0; i < subject_count; i++) {
        series_t *s = &series[i];
        const unsigned samples = s->pieces * s->rounds;
        if (!samples)
            continue;
        const double seen = quantile(s->seen, samples, 0.5);
        printf("%4u  %-18s %7.1f %7.1f   %7.1f %9.0f", count, subjects[i]->name, cost[i], s->cost[s->pieces - 1], seen,
               s->seen[samples - 1]);
        if (i > 0 && cost[0] > 0)
            printf("   %5.2f x (a)", cost[i] / cost[0]);
        if (blocks_follows(work, 1) && moving[i] > 0) {
            const unsigned masters = (count + BLOCKS_SET - 1) / BLOCKS_SET;
            printf("   a slave %6.1f", (cost[i] * count - moving[i] * masters) / (count - masters));
        }
        if (s->heap_bytes)
            printf("   heap %zu bytes", s->heap_bytes);
        printf("\n");
    }
}

static void report_simultaneous(const blocks_subject_t *const *subjects, unsigned subject_count)
{
    printf("us of the cycle in which %d axes start at once\n%24s %7s %7s %7s\n", BLOCKS_MAX_AXES, "", "best",
           "median", "worst");
    for (unsigned i = 0; i < subject_count; i++) {
        series_t *s = &series[i];
        const double median = quantile(s->starts, s->rounds, 0.5);
        printf("      %-18s %7.1f %7.1f %7.1f\n", subjects[i]->name, s->starts[0] / 1e3, median / 1e3,
               s->starts[s->rounds - 1] / 1e3);
    }
}

static void report_work(const blocks_subject_t *const *subjects, unsigned subject_count, blocks_work_t work,
                        unsigned rounds)
{
    static double moving[ROWS][SUBJECTS];
    printf("\nns per axis and cycle, %s\n%4s  %-18s %15s   %17s\n", works[work].title, "axes", "",
           "cost: median, worst", "seen: median, worst");
    for (unsigned row = 0; row < ROWS && works[work].axes[row]; row++) {
        double cost[SUBJECTS];
        const unsigned count = works[work].axes[row];
        measure_row(subjects, subject_count, work, count, rounds, cost);
        print_row(subjects, subject_count, work, count, cost, moving[row]);
        if (work == BLOCKS_MOVE)
            memcpy(moving[row], cost, sizeof cost);
    }
    if (work == BLOCKS_MOVE)
        report_simultaneous(subjects, subject_count);
}

/* ---- the cycle in which one command starts ----------------------------------------------------------------------- */

static uint64_t random_state;

/* Each problem once, from rest or in the middle of the motion before. A slave starts while its master moves. */
static void time_starts(const blocks_subject_t *subject, blocks_work_t work, bool on_the_way)
{
    static double spent[STARTS];
    unsigned refused = 0;
    const bool follows = blocks_follows(work, 1);
    const unsigned count = follows ? 2 : work == BLOCKS_GROUP ? BLOCKS_MEMBERS : 1;
    random_state = 1;
    if (!subject->begin(work, follows && !on_the_way ? 0 : count))
        return;
    for (unsigned i = 0; i < STARTS; i++) {
        if (follows) {
            const blocks_move_t way = blocks_random_move(&random_state);
            subject->give(0, &way);
            subject->run(2, (unsigned)blocks_random(&random_state, 1, 200));
        }
        const blocks_move_t move = blocks_random_move(&random_state);
        if (work == BLOCKS_MOVE)
            subject->give(0, &move);
        else
            subject->start(follows, &move);
        spent[i] = time_run(subject, count, 1);
        refused += subject->failed(follows);
        if (on_the_way) {
            subject->run(count, (unsigned)blocks_random(&random_state, 1, 500));
        } else if (follows) {
            go_home(subject, 2);
            subject->begin(work, 0);
        } else if (!subject->failed(0)) {
            run_to_the_end(subject, count);
        }
    }
    const double median = quantile(spent, STARTS, 0.5);
    printf("      %-18s %-12s %7.0f %7.0f %9.0f   refused %u of %d\n", subject->name,
           on_the_way ? "on the way" : "from rest", median, quantile(spent, STARTS, 0.99), spent[STARTS - 1], refused,
           STARTS);
    go_home(subject, count);
}

static void report_starts(const blocks_subject_t *const *subjects, unsigned subject_count)
{
    static const char *const titles[BLOCKS_WORKS] = {
        [BLOCKS_MOVE] = "MC_MoveAbsolute",
        [BLOCKS_GEAR] = "MC_GearIn, with its master",
        [BLOCKS_CAM_LINEAR] = "MC_CamIn, straight lines, with its master",
        [BLOCKS_CAM_CUBIC] = "MC_CamIn, cubic spline, with its master",
        [BLOCKS_CAM_POLYNOMIAL] = "MC_CamIn, polynomials of degree 5, with its master",
        [BLOCKS_GROUP] = "MC_MoveLinearAbsolute of three axes",
    };
    for (unsigned work = 0; work < BLOCKS_WORKS; work++) {
        printf("\nns of the cycle in which one command starts: %s\n%37s %7s %7s %9s\n", titles[work], "", "median",
               "p99", "worst");
        for (unsigned i = 0; i < subject_count; i++)
            for (int on_the_way = 0; on_the_way < 2; on_the_way++)
                time_starts(subjects[i], work, on_the_way);
    }
}

static void report_bytes(const blocks_subject_t *subject)
{
    printf("\nbytes of %s\n", subject->name);
    for (const blocks_bytes_t *b = subject->bytes(); b->what; b++)
        printf("      %-48s %7zu\n", b->what, b->bytes);
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

static bool chosen(const char *names, const char *name) { return !names || strstr(names, name); }

int main(int argc, char **argv)
{
    static const char *const names[BLOCKS_WORKS] = {"move", "gear", "linear", "cubic", "polynomial", "group"};
    const blocks_subject_t *subjects[SUBJECTS] = {&blocks_cm1e, &blocks_cm1e_whole};
    unsigned subject_count = 2, rounds = 50;
    const char *only = NULL;
    for (int i = 1; i + 1 < argc; i += 2)
        if (!strcmp(argv[i], "--peer"))
            subjects[subject_count++] = load_peer(argv[i + 1]);
        else if (!strcmp(argv[i], "--rounds"))
            rounds = (unsigned)strtoul(argv[i + 1], NULL, 10);
        else if (!strcmp(argv[i], "--only"))
            only = argv[i + 1];
    if (argc % 2 == 0 || rounds < 1 || rounds > MAX_ROUNDS)
        fail("bench_blocks [--rounds 1 ... 200] [--peer LIBRARY]\n"
             "             [--only move,gear,linear,cubic,polynomial,group,starts]");
    const int cpu = stay_on_this_cpu();
    time_the_clock();
    for (unsigned i = 0; i < subject_count; i++)
        if (!subjects[i]->make(BLOCKS_MAX_AXES))
            fail("the axes are not powered");
    print_machine(cpu, rounds);
    for (unsigned work = 0; work < BLOCKS_WORKS; work++)
        if (chosen(only, names[work]))
            report_work(subjects, subject_count, work, rounds);
    if (chosen(only, "starts"))
        report_starts(subjects, subject_count);
    for (unsigned i = 0; i < subject_count; i += 2)
        report_bytes(subjects[i]);
    return 0;
}
