/**
 * @file effort.h
 * How much of a long test runs. CM1E_TEST_EFFORT=full in the environment, which `scripts/test --all` sets: all of it.
 * Else every fourth run of a sweep, a quarter of the seeds: what a person waits for every day. With sanitizers, many
 * times slower, a twelfth. What a sample leaves out is repetition (further seeds, the moments between two moments), never
 * a check; only what all seeds together must have reached is judged where all of them run. CM1E_TEST_STRIDE=1 in the
 * environment runs every moment of a sweep, also of one that is a sample with full effort.
 */
#ifndef CM1E_TESTS_EFFORT_H
#define CM1E_TESTS_EFFORT_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { EFFORT_FULL = 1, EFFORT_EVERYDAY = 4, EFFORT_SANITIZED = 12 };

/** One of how many runs is made. */
static inline int slowness(void)
{
    const char *effort = getenv("CM1E_TEST_EFFORT");
    if (effort && strcmp(effort, "full") == 0)
        return EFFORT_FULL;
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    return EFFORT_SANITIZED;
#else
    return EFFORT_EVERYDAY;
#endif
}

/** CM1E_TEST_STRIDE; 0: not stated. A run by hand, as long as it takes. */
static inline int stated_stride(void)
{
    const char *stride = getenv("CM1E_TEST_STRIDE");
    return stride ? atoi(stride) : 0;
}

/** What a sweep goes on by here that goes on by `full` with full effort, and by at most `sampled`. */
static inline int sweep_stride(int full, int sampled)
{
    const int stride = full * slowness();
    if (stated_stride() > 0)
        return stated_stride();
    return slowness() == EFFORT_SANITIZED || stride > sampled ? sampled : stride;
}

/** Where the sweep number `number` of several over the same moments begins, so that they meet different ones. */
static inline int sweep_first(int number, int stride)
{
    const int first = number % stride;
    if (stride > 1)
        printf("a sample: from %d on, every %d. (CM1E_TEST_EFFORT=full: all)\n", first, stride);
    return first;
}

#endif
