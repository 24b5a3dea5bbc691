#include "core/clock.h"

#include <errno.h>
#include <stddef.h>
#include <time.h>

/* CLOCK_MONOTONIC stands still while the machine is suspended: a cycle that goes on after hours would not see that its
 * motors were without set-points. */
#define CLOCK_OF_MACHINE CLOCK_BOOTTIME

static int64_t monotonic_now_ns(const cm1e_clock_t *clock)
{
    (void)clock;
    struct timespec t;
    clock_gettime(CLOCK_OF_MACHINE, &t);
    return (int64_t)t.tv_sec * S_IN_NS + t.tv_nsec;
}

static void monotonic_sleep_until_ns(cm1e_clock_t *clock, int64_t time_ns)
{
    /* A time in the past costs tens of microseconds, because the kernel arms a timer even then. */
    if (time_ns <= monotonic_now_ns(clock))
        return;
    const struct timespec t = {.tv_sec = time_ns / S_IN_NS, .tv_nsec = time_ns % S_IN_NS};
    while (clock_nanosleep(CLOCK_OF_MACHINE, TIMER_ABSTIME, &t, NULL) == EINTR)
        ;
}

static int64_t virtual_now_ns(const cm1e_clock_t *clock) { return clock->virtual_now_ns; }

static void virtual_sleep_until_ns(cm1e_clock_t *clock, int64_t time_ns)
{
    if (time_ns > clock->virtual_now_ns)
        clock->virtual_now_ns = time_ns;
}

static const cm1e_clock_ops_t monotonic_ops = {monotonic_now_ns, monotonic_sleep_until_ns};
static const cm1e_clock_ops_t virtual_ops = {virtual_now_ns, virtual_sleep_until_ns};

static cm1e_clock_t monotonic_clock = {.ops = &monotonic_ops};
static _Thread_local cm1e_clock_t *current_clock;

cm1e_clock_t *cm1e_clock_monotonic(void) { return &monotonic_clock; }

void cm1e_clock_init_virtual(cm1e_clock_t *clock, int64_t start_ns)
{
    *clock = (cm1e_clock_t){.ops = &virtual_ops, .virtual_now_ns = start_ns};
}

int64_t cm1e_clock_wall(const cm1e_clock_t *clock)
{
    struct timespec now;
    if (clock != &monotonic_clock)
        return cm1e_clock_now(clock);
    clock_gettime(CLOCK_REALTIME, &now);
    return (int64_t)now.tv_sec * S_IN_NS + now.tv_nsec;
}

cm1e_clock_t *cm1e_clock_current(void) { return current_clock ? current_clock : &monotonic_clock; }

void cm1e_clock_make_current(cm1e_clock_t *clock) { current_clock = clock; }
