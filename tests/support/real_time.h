/**
 * @file real_time.h
 * For tests that measure real time. They run above other programs where that is allowed, so that a busy machine disturbs
 * nothing. Where it is not allowed and no processor is free, the test says so and judges nothing.
 */
#ifndef CM1E_TESTS_REAL_TIME_H
#define CM1E_TESTS_REAL_TIME_H

#include <sched.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include "quick_check.h"

/** Below the cycle (80) and the programs of the wire tests (50, 60). */
enum { TEST_PRIORITY = 10 };

/** This thread, and what it starts, above (true) or among other programs. */
bool run_above_others(bool above);

/** First thing in main(). */
void need_real_time(void);

/** Runs suites that mostly wait at the same time, each in a process of its own; returns the exit status of main().
 *  `make` makes the suite of a part, 0 ... parts - 1. */
int run_parts(Suite *(*make)(int part), int parts);

#endif
