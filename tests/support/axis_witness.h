/**
 * @file axis_witness.h
 * A witness of the set-points of axis_bench.h: after every cycle the position, velocity and acceleration must follow
 * from those before within the axis's limits, by what a jerk within them can do in a cycle. Call watch_begin() once the
 * axis is there, and watch_cycles() in place of bench_cycles().
 */
#ifndef CM1E_TESTS_AXIS_WITNESS_H
#define CM1E_TESTS_AXIS_WITNESS_H

#include "axis_bench.h"

typedef struct watch {
    position_t position;
    double velocity, acceleration;
    bool ours;                 /**< the cycle before was a set-point of ours */
    double lowest, highest;    /**< u, of the set position since watch_begin() */
    double stretch;            /**< how much of a limit of acceleration may be used where two motions add up: 1 */
    unsigned cycles;
    const char *run;           /**< what to say of a failure */
} watch_t;

extern watch_t watch;

void watch_begin(void);

#define WATCH(condition, ...)                                                                                        \
    do                                                                                                               \
        if (!(condition)) {                                                                                          \
            char said[200], text[400];                                                                               \
            snprintf(said, sizeof said, __VA_ARGS__);                                                                \
            snprintf(text, sizeof text, "cycle %u %s: %s (%s)", watch.cycles, watch.run, said,                       \
                     cm1e_axis_state_name(axis->state));                                                             \
            TEST_FAIL_MESSAGE(text);                                                                                 \
        }                                                                                                            \
    while (0)

void watch_cycles(int n);

#endif
