/**
 * @file clock.h
 * All time in the library, SOEM's included, comes from this interface: the monotonic clock of the machine, or a virtual
 * clock that advances only when a thread waits on it. Times are int64_t nanoseconds.
 */
#ifndef CM1E_CORE_CLOCK_H
#define CM1E_CORE_CLOCK_H

#include <stdint.h>

#include "core/guest_api.h"

#define US_IN_NS INT64_C(1000)
#define MS_IN_NS INT64_C(1000000)
#define S_IN_NS INT64_C(1000000000)

typedef struct cm1e_clock cm1e_clock_t;

typedef struct cm1e_clock_ops {
    int64_t (*now_ns)(const cm1e_clock_t *clock);
    void (*sleep_until_ns)(cm1e_clock_t *clock, int64_t time_ns); /**< absolute time; returns at once if it is past */
} cm1e_clock_ops_t;

struct cm1e_clock {
    const cm1e_clock_ops_t *ops;
    int64_t virtual_now_ns; /**< virtual clock only */
};

static inline int64_t cm1e_clock_now(const cm1e_clock_t *clock) { return clock->ops->now_ns(clock); }
static inline void cm1e_clock_sleep_until(cm1e_clock_t *clock, int64_t time_ns)
{
    clock->ops->sleep_until_ns(clock, time_ns);
}

/** CLOCK_BOOTTIME, with absolute sleeps: it is monotonic, and goes on while the machine is suspended. Shared, never
 *  freed.
 *  @rt any */
CM1E_GUEST_API cm1e_clock_t *cm1e_clock_monotonic(void);
/** Makes a clock that starts at `start_ns` and is advanced only by cm1e_clock_sleep_until(). @rt any */
CM1E_GUEST_API void cm1e_clock_init_virtual(cm1e_clock_t *clock, int64_t start_ns);

/** The time as people tell it: since 1970 (UTC). On a virtual clock, its own time. @rt cycle */
CM1E_GUEST_API int64_t cm1e_clock_wall(const cm1e_clock_t *clock);

/** The clock of the calling thread: what SOEM's osal functions use. Default: monotonic. Thread local. @rt cycle */
cm1e_clock_t *cm1e_clock_current(void);
void cm1e_clock_make_current(cm1e_clock_t *clock);

#endif
