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

/** Below the cycle (80) and the programs of the wire tests (50, 60). */
enum { TEST_PRIORITY = 10 };

/** Somebody waited for a processor in nearly all of the last ten seconds. False where the kernel does not tell. */
static inline bool no_processor_is_free(void)
{
    double share = 0.0;
    FILE *pressure = fopen("/proc/pressure/cpu", "r");
    if (!pressure)
        return false;
    const bool told = fscanf(pressure, "some avg10=%lf", &share) == 1;
    fclose(pressure);
    return told && share > 80.0;
}

/** This thread, and what it starts, above (true) or among other programs. */
static inline bool run_above_others(bool above)
{
    const struct sched_param parameters = {.sched_priority = above ? TEST_PRIORITY : 0};
    return sched_setscheduler(0, above ? SCHED_FIFO : SCHED_OTHER, &parameters) == 0;
}

/** First thing in main(). */
static inline void need_real_time(void)
{
    if (run_above_others(true) || !no_processor_is_free())
        return;
    printf("SKIPPED: this machine has no free processor, and SCHED_FIFO is not allowed: no time is judged\n");
    exit(EXIT_SUCCESS);
}

#endif
