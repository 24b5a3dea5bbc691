/* SOEM's time functions (osal.h) on the clock of the calling thread, which may be a virtual one. */
#include <stdbool.h>

#include "core/clock.h"
#include "osal.h"

enum { US_PER_S = 1000000 };

/** SOEM's distributed clocks start at 2000-01-01 and get there by subtracting this from the time of day. What counts
 *  for them is that time is monotonic and starts after it. */
enum { EPOCH_2000_S = 946684800 };

static ec_timet from_us(int64_t us)
{
    return (ec_timet){.sec = (uint32)(us / US_PER_S), .usec = (uint32)(us % US_PER_S)};
}

static int64_t now_us(void) { return cm1e_clock_now(cm1e_clock_current()) / US_IN_NS; }

ec_timet osal_current_time(void)
{
    ec_timet t = from_us(now_us());
    t.sec += EPOCH_2000_S;
    return t;
}

void osal_time_diff(ec_timet *start, ec_timet *end, ec_timet *diff)
{
    const bool borrow = end->usec < start->usec;
    diff->sec = end->sec - start->sec - (borrow ? 1 : 0);
    diff->usec = end->usec + (borrow ? US_PER_S : 0) - start->usec;
}

void osal_timer_start(osal_timert *self, uint32 timeout_us) { self->stop_time = from_us(now_us() + timeout_us); }

boolean osal_timer_is_expired(osal_timert *self)
{
    return now_us() >= (int64_t)self->stop_time.sec * US_PER_S + self->stop_time.usec;
}

int osal_usleep(uint32 usec)
{
    cm1e_clock_t *clock = cm1e_clock_current();
    cm1e_clock_sleep_until(clock, cm1e_clock_now(clock) + (int64_t)usec * US_IN_NS);
    return 0;
}
