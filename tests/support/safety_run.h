/**
 * @file safety_run.h
 * A run of safety_bench.h from its first frame to its last, and the main() of a program of such runs. Include it in
 * place of safety_bench.h.
 */
#ifndef CM1E_TESTS_SAFETY_RUN_H
#define CM1E_TESTS_SAFETY_RUN_H

#include "effort.h"
#include "safety_bench.h"

/** Axes without end stops that nobody homes, with this mapping and firmware. */
void bench_free_axes(bench_t *bench, uint32_t axes, cm1e_mapping_t mapping, const char *firmware);

/** The limits of every axis; units of `counts`. */
void bench_limit_axes(bench_t *bench, double counts, double velocity, double acceleration, double jerk);

/** From start-up until the program ends it. */
void bench_play(bench_t *bench);

typedef struct bench_test {
    const TTest *test;
    int count; /**< `_i` is 0 ... count - 1 */
} bench_test_t;

/** A test case for `_i` from `from` to below `to`, within so many seconds; with a stride that is stated, as long as it
 *  takes. CK_RUN_CASE=name in the environment runs one of them. */
void bench_add(Suite *suite, const char *name, double limit_s, const TTest *test, int from, int to);

/** The result of main(). */
int bench_run_suite(Suite *suite);

/** The tests, up to one without a name. */
int bench_main(const char *about, double limit_s, const bench_test_t *tests);

#endif
