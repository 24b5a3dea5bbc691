#include "bus/dc.h"
#include "core/bytes.h"

/** ns; from the setting of SYNC0 to its first pulse. The pulse must not have passed when the slave gets its start
 *  time. */
#define PULSE_LEAD_NS INT64_C(20000000)

/** Pulses of all slaves have one phase: a multiple of all periods, and the shift. */
static uint64_t first_pulse(const cm1e_dc_t *dc, const cm1e_slave_clock_t *clock, int64_t now_ns)
{
    int64_t period = dc->pace.cycle_ns;
    const int64_t sync1 = ((int64_t)clock->sync1_ns / clock->sync0_ns + 1) * clock->sync0_ns;
    period = sync1 > period ? sync1 : period;
    const int64_t after = now_ns + PULSE_LEAD_NS + (clock->shift_ns < 0 ? -clock->shift_ns : 0);
    return (uint64_t)((after / period + 1) * period + clock->shift_ns);
}

void cm1e_dc_put_pulses(const cm1e_dc_t *dc, const cm1e_slave_clock_t *clock, int64_t now_ns, uint8_t start[8],
                        uint8_t cycles[8])
{
    cm1e_put_u64(start, first_pulse(dc, clock, now_ns));
    cm1e_put_u32(cycles, clock->sync0_ns);
    cm1e_put_u32(cycles + 4, clock->sync1_ns);
}
