/**
 * @file effort.h
 * How much of a long test runs. CM1E_TEST_EFFORT=full in the environment, which `scripts/test --all` sets: all of it.
 * Else every twelfth run of a sweep, a twelfth of the seeds: what a person waits for every day. With sanitizers, many
 * times slower, a sixteenth. What a sample leaves out is repetition (further seeds, the moments between two moments), never
 * a check; only what all seeds together must have reached is judged where all of them run. CM1E_TEST_STRIDE=1 in the
 * environment runs every moment of a sweep, also of one that is a sample with full effort.
 */
#ifndef CM1E_TESTS_EFFORT_H
#define CM1E_TESTS_EFFORT_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { EFFORT_FULL = 1, EFFORT_EVERYDAY = 12, EFFORT_SANITIZED = 16 };

/** One of how many runs is made. */
int slowness(void);

/** CM1E_TEST_STRIDE; 0: not stated. A run by hand, as long as it takes. */
int stated_stride(void);

/** What a sweep goes on by here that goes on by `full` with full effort, and by at most `sampled`. */
int sweep_stride(int full, int sampled);

/** As sweep_stride(), where the everyday run has a stride of its own, because a twelfth would take too long. */
int sweep_stride_everyday(int full, int everyday, int sampled);

/** Where the sweep number `number` of several over the same moments begins, so that they meet different ones. */
int sweep_first(int number, int stride);

#endif
