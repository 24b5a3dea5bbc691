/**
 * @file lease.h
 * How long an axis goes on with what a block has to want in every call (MC_Jog, MC_DigitalCamSwitch) when the block is
 * no longer called: four times the time between its last two calls, so that a late task is no reason to stop, at least
 * 100 ms, at most 1 s; 1 s where there was no call before.
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
