/** The first pulse of a slave with distributed clocks (ETG.1000.4, 6.1.3; ETG.1020): pulses of all slaves have one phase. */
#include <stdlib.h>

#include "unity.h"

#include "bus/dc.h"
#include "core/bytes.h"

void setUp(void) {}
void tearDown(void) {}

#define MS INT64_C(1000000)
#define LEAD_NS (20 * MS)

static uint64_t first_pulse(int64_t cycle_ns, const cm1e_slave_clock_t *clock, int64_t now_ns)
{
    cm1e_dc_t dc = {.pace.cycle_ns = cycle_ns};
    uint8_t start[8], cycles[8];
    cm1e_dc_put_pulses(&dc, clock, now_ns, start, cycles);
    TEST_ASSERT_EQUAL_UINT32(clock->sync0_ns, cm1e_get_u32(cycles));
    TEST_ASSERT_EQUAL_UINT32(clock->sync1_ns, cm1e_get_u32(cycles + 4));
    return cm1e_get_u64(start);
}

/* SYNC1 comes its time after every so many SYNC0: all of them are one period, which begins with the first pulse. */
static void test_first_pulse_begins_a_period_of_all_pulses(void)
{
    static const struct {
        int64_t cycle_ns, sync0_ns, sync1_ns, period_ns;
    } rows[] = {
        {MS, MS, 0, MS},              {MS, MS / 2, 0, MS},          {MS, 2 * MS, 0, 2 * MS},     {MS, MS, MS / 4, MS},
        {MS, MS, MS, 2 * MS},         {MS, MS / 2, MS / 2, MS},     {MS, MS / 2, 3 * MS / 2, 2 * MS},
        {MS, MS, 2 * MS + 1, 3 * MS}, {4 * MS, MS, 2 * MS, 4 * MS}, {MS / 4, MS / 4, 7 * MS / 4, 2 * MS},
    };
    static const int64_t shifts_ns[] = {0, 300000, -250000, 1, -1};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
        for (size_t s = 0; s < sizeof shifts_ns / sizeof shifts_ns[0]; s++)
            for (int64_t now_ns = 700 * MS - 3; now_ns < 712 * MS; now_ns += 77777) {
                const cm1e_slave_clock_t clock = {.has_clock = true, .sync0_ns = (uint32_t)rows[i].sync0_ns,
                                                  .sync1_ns = (uint32_t)rows[i].sync1_ns,
                                                  .shift_ns = (int32_t)shifts_ns[s]};
                const int64_t start_ns = (int64_t)first_pulse(rows[i].cycle_ns, &clock, now_ns);
                TEST_ASSERT_EQUAL_INT64(0, (start_ns - shifts_ns[s]) % rows[i].period_ns);
                TEST_ASSERT_TRUE(start_ns > now_ns + LEAD_NS);
                TEST_ASSERT_TRUE(start_ns <= now_ns + LEAD_NS + rows[i].period_ns + llabs(shifts_ns[s]));
            }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_first_pulse_begins_a_period_of_all_pulses);
    return UNITY_END();
}
