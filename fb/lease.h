/**
 * @file lease.h
 * The time after which an axis ends the action of a block that must be called in every cycle (MC_Jog,
 * MC_DigitalCamSwitch) and is no longer called. It is four times the time between the last two calls, so that a late
 * task does not end it, at least 100 ms and at most 1 s. Before the second call it is 1 s.
 */
#ifndef CM1E_FB_LEASE_H
#define CM1E_FB_LEASE_H

#include <stdint.h>

static inline int64_t fb_lease_ns(int64_t now_ns, int64_t called_ns)
{
    const int64_t ms = 1000000, between = now_ns - called_ns;
    if (called_ns == 0 || between < 0 || between > 250 * ms)
        return 1000 * ms;
    return between < 25 * ms ? 100 * ms : 4 * between;
}

#endif
