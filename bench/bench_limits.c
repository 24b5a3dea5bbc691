/**
 * What a cycle of the library costs in instructions, which do not depend on the load of the machine: the work of
 * bench_blocks, with the axes of one set. scripts/limits runs it under callgrind and compares the counts with those of
 * bench/limits. All that is counted runs in measured_run(), of which callgrind writes a count for each call.
 *
 *     bench_limits [ROW]      a line for each call (of the starts of one command there are several): the row, the number of axis-cycles in it, bytes taken from the heap
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "blocks_cm1e.h"
#include "motion/path.h"

enum { CYCLES = 100, WARM = 60, STARTS = 31 };

#define MEASURED __attribute__((noinline, noclone, used)) void
MEASURED measured_run(const blocks_subject_t *subject, unsigned axes, unsigned cycles);

/* The one function that is counted. The result of `run` keeps it from becoming a jump. */
MEASURED measured_run(const blocks_subject_t *subject, unsigned axes, unsigned cycles)
{
    subject->run(axes, cycles);
    __asm__ volatile("" ::: "memory");
}

static void fail(const char *why)
{
    fprintf(stderr, "bench_limits: %s\n", why);
    exit(1);
}

static const blocks_move_t there = {BLOCKS_FAR, BLOCKS_VELOCITY, BLOCKS_ACCELERATION / 2, BLOCKS_ACCELERATION / 2,
                                    BLOCKS_JERK / 2};
static const blocks_move_t home = {0, BLOCKS_VELOCITY, BLOCKS_ACCELERATION, BLOCKS_ACCELERATION, BLOCKS_JERK};

static void run_to_the_end(const blocks_subject_t *subject, unsigned axes)
{
    for (unsigned i = 0; i < axes; i++)
        for (int cycles = 0; !subject->done(i); cycles++) {
            if (subject->failed(i) || cycles > 100000)
                fail("a move was not done");
            subject->run(axes, 1);
        }
}

static void give(const blocks_subject_t *subject, unsigned axes, const blocks_move_t *move)
{
    for (unsigned i = 0; i < axes; i++)
        subject->give(i, move);
}

/* A row: what was counted, in how many axes and cycles. The script divides. */
static void told(const char *name, unsigned parts, size_t heap_before)
{
    printf("%s %u %zu\n", name, parts, blocks_heap_bytes() - heap_before);
}

static void measure(const char *name, const blocks_subject_t *subject, blocks_work_t work, unsigned axes)
{
    if (!subject->begin(work, axes))
        fail("the work cannot begin");
    give(subject, axes, &there);
    subject->run(axes, WARM);
    const size_t before = blocks_heap_bytes();
    measured_run(subject, axes, CYCLES);
    told(name, axes * CYCLES, before);
    run_to_the_end(subject, axes);
    subject->end();
    give(subject, axes, &home);
    subject->run(axes, 1);
    run_to_the_end(subject, axes);
}

/* The cycles in which all axes start: from rest, and on the way back. */
static void measure_starts(const blocks_subject_t *subject, unsigned axes)
{
    give(subject, axes, &there);
    const size_t before = blocks_heap_bytes();
    measured_run(subject, axes, 1);
    told("start-from-rest", axes, before);
    subject->run(axes, WARM);
    give(subject, axes, &home);
    const size_t before_next = blocks_heap_bytes();
    measured_run(subject, axes, 1);
    told("start-on-the-way", axes, before_next);
    run_to_the_end(subject, axes);
}

/* Random commands as in bench_blocks: a count for each of the cycles in which one starts, its master included. */
static void measure_commands(const char *name, const blocks_subject_t *subject, blocks_work_t work, bool on_the_way)
{
    const bool follows = blocks_follows(work, 1);
    const unsigned count = follows ? 2 : BLOCKS_MEMBERS;
    uint64_t random = 1;
    if (!subject->begin(work, follows && !on_the_way ? 0 : count))
        fail("the work cannot begin");
    for (unsigned i = 0; i < STARTS; i++) {
        if (follows) {
            const blocks_move_t way = blocks_random_move(&random);
            subject->give(0, &way);
            subject->run(2, (unsigned)blocks_random(&random, 1, 200));
        }
        const blocks_move_t move = blocks_random_move(&random);
        subject->start(follows, &move);
        const size_t before = blocks_heap_bytes();
        measured_run(subject, count, 1);
        told(name, 1, before);
        if (on_the_way) {
            subject->run(count, (unsigned)blocks_random(&random, 1, 500));
        } else if (follows) {
            subject->end();
            give(subject, 2, &home);
            subject->run(2, 1);
            run_to_the_end(subject, 2);
            subject->begin(work, 0);
        } else if (!subject->failed(0)) {
            run_to_the_end(subject, count);
        }
    }
    subject->end();
    subject->run(count, CYCLES * 10); /* a group that moved comes to rest first */
    give(subject, count, &home);
    subject->run(count, 1);
    run_to_the_end(subject, count);
}

/* System calls that were made since the last count belong to the next one: to this one, which is left out. */
static void begin_counting(void)
{
    measured_run(&blocks_cm1e, BLOCKS_SET, 0);
    told("begin", 1, blocks_heap_bytes());
}

/* The stop of a path that is as long as one can be, of short segments of which none is like the one before. */
static cm1e_path_t long_path;

static void stop_long_path(unsigned axes, unsigned cycles)
{
    (void)axes, (void)cycles;
    cm1e_path_stop(&long_path, 0, 0);
}

static void measure_stop(void)
{
    static const blocks_subject_t subject = {.run = stop_long_path};
    const double origin[2] = {0};
    cm1e_path_config_t config = {.axes = 2, .space = 2, .cycle_s = 1e-3};
    for (int i = 0; i < 2; i++)
        config.axis[i] = (cm1e_path_axis_t){BLOCKS_VELOCITY, BLOCKS_ACCELERATION, BLOCKS_JERK, -INFINITY, INFINITY};
    if (cm1e_path_begin(&long_path, &config, origin) != CM1E_OK)
        fail("no path");
    for (unsigned i = 0; long_path.segment_count < CM1E_PATH_SEGMENTS; i++) {
        const double end[2] = {1.0 * (i + 1), i % 2 ? 0.0 : 0.3};
        const cm1e_path_command_t command = {.limits = {30 + i % 7, 0, 0, 0}, .blend = CM1E_PATH_BLEND_LOW, .tag = i + 1,
                                             .junction = CM1E_PATH_CORNER_DEVIATION, .parameter = 0.05};
        if (cm1e_path_append_line(&long_path, end, &command, NULL) != CM1E_OK)
            fail("a line was refused");
    }
    cm1e_path_sample_t sample;
    for (int i = 0; i < 60; i++)
        cm1e_path_step(&long_path, &sample);
    const size_t before = blocks_heap_bytes();
    measured_run(&subject, 1, 1);
    told("stop-path", 1, before);
}

/* Whole cycles of both buses with all axes at rest under torque, simulated motors included: a count for each cycle. */
static void measure_cycle(void)
{
    blocks_cm1e_cycle.run(BLOCKS_MAX_AXES, WARM);
    begin_counting();
    const size_t before = blocks_heap_bytes();
    measured_run(&blocks_cm1e_cycle, BLOCKS_MAX_AXES, CYCLES);
    told("cycle", CYCLES, before);
}

int main(int argc, char **argv)
{
    const char *only = argc > 1 ? argv[1] : NULL; /* the name of a row: it alone */
    static const struct {
        const char *name;
        const blocks_subject_t *subject;
        blocks_work_t work;
        unsigned axes;
    } rows[] = {
        {"a-move", &blocks_cm1e, BLOCKS_MOVE, BLOCKS_SET},
        {"ab-move", &blocks_cm1e_whole, BLOCKS_MOVE, BLOCKS_SET},
        {"a-gear", &blocks_cm1e, BLOCKS_GEAR, BLOCKS_SET},
        {"ab-gear", &blocks_cm1e_whole, BLOCKS_GEAR, BLOCKS_SET},
        {"a-cam-linear", &blocks_cm1e, BLOCKS_CAM_LINEAR, BLOCKS_SET},
        {"a-cam-cubic", &blocks_cm1e, BLOCKS_CAM_CUBIC, BLOCKS_SET},
        {"ab-cam-cubic", &blocks_cm1e_whole, BLOCKS_CAM_CUBIC, BLOCKS_SET},
        {"a-group", &blocks_cm1e, BLOCKS_GROUP, BLOCKS_MEMBERS},
        {"ab-group", &blocks_cm1e_whole, BLOCKS_GROUP, BLOCKS_MEMBERS},
    };
    static const struct {
        const char *name[2]; /* from rest, on the way */
        blocks_work_t work;
    } starts[] = {
        {{"start-gear", "start-gear-way"}, BLOCKS_GEAR},
        {{"start-linear", "start-linear-way"}, BLOCKS_CAM_LINEAR},
        {{"start-cubic", "start-cubic-way"}, BLOCKS_CAM_CUBIC},
        {{"start-line", "start-line-way"}, BLOCKS_GROUP},
    };
    if (!blocks_cm1e.make(BLOCKS_MAX_AXES))
        fail("the axes are not powered");
    begin_counting();
    if (!only)
        measure_cycle();
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
        if (!only || !strcmp(only, rows[i].name))
            measure(rows[i].name, rows[i].subject, rows[i].work, rows[i].axes);
    if (!only || !strcmp(only, "stop-path"))
        measure_stop();
    if (!only)
        measure_starts(&blocks_cm1e, BLOCKS_SET);
    for (size_t i = 0; i < sizeof starts / sizeof starts[0]; i++)
        for (int way = 0; way < 2; way++)
            if (!only || !strcmp(only, starts[i].name[way]))
                measure_commands(starts[i].name[way], &blocks_cm1e, starts[i].work, way);
    return 0;
}
