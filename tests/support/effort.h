/**
 * @file effort.h
 * How much of a long test runs: all of it in a plain build, a sample of it where sanitizers make it many times slower.
 * What a sample leaves out is repetition (further seeds, the moments between two moments), never a check; a plain build
 * judges all of it. CM1E_TEST_EFFORT=full in the environment runs all of it with sanitizers too. Where the whole is too
 * long for every day, a plain build runs a sample as well: CM1E_TEST_STRIDE=1 in the environment runs all moments.
 */
#ifndef CM1E_TESTS_EFFORT_H
#define CM1E_TESTS_EFFORT_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/** One of how many runs is made: 1 is all of them. */
static inline int slowness(void)
{
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    const char *effort = getenv("CM1E_TEST_EFFORT");
    return effort && strcmp(effort, "full") == 0 ? 1 : 12;
#else
    return 1;
#endif
}

/** CM1E_TEST_STRIDE; 0: not stated. A run by hand, as long as it takes. */
static inline int stated_stride(void)
{
    const char *stride = getenv("CM1E_TEST_STRIDE");
    return stride ? atoi(stride) : 0;
}

/** What a sweep that goes on by `full` in a plain build goes on by here. */
static inline int sweep_stride(int full, int sampled)
{
    return stated_stride() > 0 ? stated_stride() : slowness() > 1 ? sampled : full;
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
