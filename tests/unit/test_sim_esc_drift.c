/* Distributed clocks that drift: the control loop against the definition of its registers, SYNC0 and SYNC1. */
#include <math.h>

#include "sim/segment.h"
#include "sim_fake_app.h"

enum { SLAVES = 3, MS = 1000000, HOP_NS = 700 };

static bench_t b;

static void console(const char *line)
{
    char answer[200];
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, cm1e_sim_console(b.segment, line, answer, sizeof answer), answer);
}

/* Delays and offsets as a master measures and writes them; slaves 1 and 2 follow slave 0. */
static void align(void)
{
    for (unsigned i = 0; i < SLAVES; i++) {
        uint8_t delay[4], offset[8] = {0}, zero[4] = {0}, local[8];
        write_u16(&b, i, 0x0010, (uint16_t)(STATION + i));
        TEST_ASSERT_EQUAL_INT(SLAVES, send_to(&b, BWR, 0, 0x0900, zero, 4));
        send_to(&b, APRD, (uint16_t)-i, 0x0918, local, 8);
        const uint64_t own = cm1e_get_u64(local);
        send_to(&b, APRD, 0, 0x0918, local, 8);
        cm1e_put_u64(offset, cm1e_get_u64(local) + i * HOP_NS - own);
        write_bytes(&b, i, 0x0920, offset, 8);
        cm1e_put_u32(delay, i * HOP_NS);
        write_bytes(&b, i, 0x0928, delay, 4);
    }
}

void setUp(void)
{
    bench_open(&b, SLAVES);
    b.now_ns += MS;
    align();
}
void tearDown(void) { bench_close(&b); }

static void distribute(int cycles, int64_t cycle_ns)
{
    for (int i = 0; i < cycles; i++) {
        uint8_t time[8] = {0};
        b.now_ns += cycle_ns;
        TEST_ASSERT_EQUAL_INT(SLAVES, send_to(&b, FRMW, STATION, 0x0910, time, 8));
    }
}

static double deviation_ns(unsigned slave)
{
    cm1e_sim_clock_t reference, other;
    cm1e_sim_segment_advance(b.segment, b.now_ns);
    cm1e_sim_segment_clock(b.segment, 1, &reference);
    cm1e_sim_segment_clock(b.segment, slave + 1, &other);
    return (double)(other.system_ns - reference.system_ns) - (double)(other.time_ns - reference.time_ns);
}

static int32_t difference(unsigned slave)
{
    const uint32_t value = read_u32(&b, slave, 0x092C);
    return (int32_t)(value & 0x7FFFFFFF) * (value >> 31 ? -1 : 1);
}

static void test_a_crystal_drifts_as_stated(void)
{
    console("clock 2 drift 50");
    const double before = deviation_ns(1);
    b.now_ns += 1000 * (int64_t)MS;
    TEST_ASSERT_DOUBLE_WITHIN(2, 50000, deviation_ns(1) - before);
}

static void test_offset_and_delay_make_all_clocks_one(void)
{
    console("clock 3 step 400000");
    align();
    for (unsigned i = 1; i < SLAVES; i++)
        TEST_ASSERT_DOUBLE_WITHIN(2, 0, deviation_ns(i));
}

/* 0x0910 as a master reads it is the time at which the frame passed the reference clock. */
static void test_every_slave_gives_the_time_of_the_reference_clock(void)
{
    uint8_t first[8], other[8];
    send_to(&b, APRD, 0, 0x0910, first, 8);
    send_to(&b, APRD, (uint16_t)-2, 0x0910, other, 8);
    TEST_ASSERT_UINT64_WITHIN(2, cm1e_get_u64(first), cm1e_get_u64(other));
}

static void test_the_loop_removes_a_step_and_a_drift(void)
{
    console("clock 2 drift 80");
    console("clock 3 drift -80");
    console("clock 3 step 5000");
    distribute(1, MS);
    TEST_ASSERT_INT_WITHIN(100, 80, difference(1));
    TEST_ASSERT_INT_WITHIN(100, 4920, difference(2));
    distribute(30000, MS);
    for (unsigned i = 1; i < SLAVES; i++) {
        TEST_ASSERT_INT_WITHIN(2, 0, difference(i));
        TEST_ASSERT_DOUBLE_WITHIN(90, 0, deviation_ns(i)); /* between two frames the clock runs by its own speed */
    }
}

/* Deviation = diff / (5 (start + diff + 2) (start - diff + 2)), the formula of the register description. */
static void test_speed_counter_diff_states_the_deviation_by_its_formula(void)
{
    static const double ppm[] = {3, 40, -75, 250};
    for (unsigned i = 0; i < 4; i++) {
        char line[40];
        snprintf(line, sizeof line, "clock 2 drift %g", ppm[i]);
        console(line);
        write_u16(&b, 1, 0x0930, 0x1000);
        write_u8(&b, 1, 0x0935, 6);
        distribute(1000, MS);
        const double start = 0x1000, diff = (int16_t)read_u16(&b, 1, 0x0932);
        const double stated = diff / (5 * (start + diff + 2) * (start - diff + 2));
        TEST_ASSERT_DOUBLE_WITHIN(0.05 + fabs(ppm[i]) * 0.002, ppm[i], stated * 1e6); /* whole counts */
    }
}

static void test_speed_counter_diff_stays_in_its_range(void)
{
    console("clock 2 drift 500");
    write_u16(&b, 1, 0x0930, 0x0100);
    write_u8(&b, 1, 0x0935, 0);
    distribute(10, MS);
    const int diff = (int16_t)read_u16(&b, 1, 0x0932);
    TEST_ASSERT_INT_WITHIN(0x100 - 0x7F, 0, diff);
    TEST_ASSERT_NOT_EQUAL_INT(0, diff);
}

static void test_writing_speed_counter_start_begins_anew(void)
{
    console("clock 2 drift 100");
    write_u8(&b, 1, 0x0934, 4);
    distribute(500, MS);
    TEST_ASSERT_NOT_EQUAL_UINT32(0, read_u16(&b, 1, 0x0932));
    TEST_ASSERT_NOT_EQUAL_INT(0, difference(1));
    write_u16(&b, 1, 0x0930, 0x1000);
    TEST_ASSERT_EQUAL_UINT32(0, read_u16(&b, 1, 0x0932));
    TEST_ASSERT_EQUAL_INT(0, difference(1));
}

static void test_the_difference_is_a_mean_over_its_filter(void)
{
    write_u8(&b, 1, 0x0934, 4); /* a sixteenth of each */
    write_u16(&b, 1, 0x0930, 0x1000);
    console("clock 2 step 16000");
    distribute(1, MS);
    TEST_ASSERT_INT_WITHIN(3, 1000, difference(1));
}

static void test_a_clock_set_free_runs_away_and_says_so(void)
{
    console("clock 2 drift 20");
    distribute(20000, MS);
    console("clock 2 free");
    distribute(1000, MS);
    TEST_ASSERT_INT_WITHIN(200, 20000, difference(1));
    console("clock 2 follow");
    distribute(20000, MS);
    TEST_ASSERT_INT_WITHIN(3, 0, difference(1));
}

static void test_a_temperature_comes_slowly_and_is_followed(void)
{
    cm1e_sim_clock_t clock;
    console("clock 2 temperature 40"); /* 20 ppm in the end */
    distribute(1000, MS);
    cm1e_sim_segment_clock(b.segment, 2, &clock);
    TEST_ASSERT_DOUBLE_WITHIN(0.1, 20 * (1 - exp(-1.0 / 30)), clock.drift_ppm);
    for (int s = 0; s < 200; s++) {
        distribute(1000, MS);
        TEST_ASSERT_INT_WITHIN(20, 0, difference(1));
    }
    cm1e_sim_segment_clock(b.segment, 2, &clock);
    TEST_ASSERT_DOUBLE_WITHIN(0.1, 20, clock.drift_ppm);
}

static void test_jitter_moves_the_time_stamps_to_both_sides(void)
{
    int least = 0, most = 0;
    console("clock 2 jitter 30");
    for (int i = 0; i < 500; i++) {
        distribute(1, MS);
        least = difference(1) < least ? difference(1) : least;
        most = difference(1) > most ? difference(1) : most;
    }
    TEST_ASSERT_TRUE(least < -10 && least > -70);
    TEST_ASSERT_TRUE(most > 10 && most < 70);
}

/* ---- pulses ------------------------------------------------------------------------------------------------------ */

static uint64_t system_now(void)
{
    cm1e_sim_clock_t clock;
    cm1e_sim_segment_advance(b.segment, b.now_ns);
    cm1e_sim_segment_clock(b.segment, 1, &clock);
    return (uint64_t)clock.system_ns;
}

static void start_pulses(uint64_t start, uint32_t cycle_0, uint32_t cycle_1, uint8_t activation)
{
    uint8_t data[8];
    write_u8(&b, 0, 0x0981, 0);
    cm1e_put_u64(data, start);
    TEST_ASSERT_EQUAL_INT(1, write_bytes(&b, 0, 0x0990, data, 8));
    cm1e_put_u32(data, cycle_0);
    cm1e_put_u32(data + 4, cycle_1);
    TEST_ASSERT_EQUAL_INT(1, write_bytes(&b, 0, 0x09A0, data, 8));
    TEST_ASSERT_EQUAL_INT(1, write_u8(&b, 0, 0x0981, activation));
}

static cm1e_sim_clock_t at(int64_t ns)
{
    cm1e_sim_clock_t clock;
    b.now_ns += ns;
    cm1e_sim_segment_advance(b.segment, b.now_ns);
    cm1e_sim_segment_clock(b.segment, 1, &clock);
    return clock;
}

static void test_sync0_begins_at_its_start_time_and_repeats(void)
{
    const uint64_t start = system_now() + 10 * MS;
    start_pulses(start, MS, 0, 3);
    TEST_ASSERT_EQUAL_HEX8(1, read_u8(&b, 0, 0x0984)); /* pending */
    TEST_ASSERT_EQUAL_UINT64(0, at(10 * MS - 1).sync0_pulses);
    TEST_ASSERT_EQUAL_UINT64(1, at(1).sync0_pulses);
    TEST_ASSERT_EQUAL_HEX8(0, read_u8(&b, 0, 0x0984));
    TEST_ASSERT_EQUAL_UINT64(8, at(7 * MS).sync0_pulses);
    TEST_ASSERT_EQUAL_UINT64(start + 8 * MS, (uint64_t)at(0).next_sync0_ns);
    uint8_t next[8];
    send_to(&b, APRD, 0, 0x0990, next, 8);
    TEST_ASSERT_EQUAL_UINT64(start + 8 * MS, cm1e_get_u64(next));
    console("clock 1 silent");
    TEST_ASSERT_EQUAL_UINT64(8, at(5 * MS).sync0_pulses);
}

static void test_a_start_time_that_is_past_never_comes(void)
{
    start_pulses(system_now() - MS, MS, 0, 3);
    TEST_ASSERT_EQUAL_UINT64(0, at(100 * MS).sync0_pulses);
}

static void test_a_cycle_of_0_is_one_pulse(void)
{
    start_pulses(system_now() + MS, 0, 0, 3);
    TEST_ASSERT_EQUAL_UINT64(1, at(100 * MS).sync0_pulses);
}

static void test_sync1_comes_behind_sync0_and_waits_for_the_next_one(void)
{
    static const struct { uint32_t cycle_1; uint64_t in_20_cycles; } rows[] = {
        {MS / 4, 20}, {0, 20}, {MS + MS / 4, 10}, {3 * MS, 5},
    };
    for (unsigned i = 0; i < 4; i++) {
        start_pulses(system_now() + MS, MS, rows[i].cycle_1, 7);
        TEST_ASSERT_EQUAL_UINT64(20, at(20 * MS + MS / 2).sync0_pulses);
        const uint64_t found = at(0).sync1_pulses;
        TEST_ASSERT_EQUAL_UINT64(rows[i].in_20_cycles, found);
    }
}

static void test_a_controller_without_clocks_has_no_such_registers(void)
{
    uint8_t zero[4] = {0};
    console("clock 2 none");
    TEST_ASSERT_EQUAL_HEX16(0, read_u16(&b, 1, 0x0008) & 0x0004);
    TEST_ASSERT_EQUAL_INT(SLAVES - 1, send_to(&b, BWR, 0, 0x0900, zero, 4));
    console("clock 2 fitted");
    TEST_ASSERT_EQUAL_INT(SLAVES, send_to(&b, BWR, 0, 0x0900, zero, 4));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_crystal_drifts_as_stated);
    RUN_TEST(test_offset_and_delay_make_all_clocks_one);
    RUN_TEST(test_every_slave_gives_the_time_of_the_reference_clock);
    RUN_TEST(test_the_loop_removes_a_step_and_a_drift);
    RUN_TEST(test_speed_counter_diff_states_the_deviation_by_its_formula);
    RUN_TEST(test_speed_counter_diff_stays_in_its_range);
    RUN_TEST(test_writing_speed_counter_start_begins_anew);
    RUN_TEST(test_the_difference_is_a_mean_over_its_filter);
    RUN_TEST(test_a_clock_set_free_runs_away_and_says_so);
    RUN_TEST(test_a_temperature_comes_slowly_and_is_followed);
    RUN_TEST(test_jitter_moves_the_time_stamps_to_both_sides);
    RUN_TEST(test_sync0_begins_at_its_start_time_and_repeats);
    RUN_TEST(test_a_start_time_that_is_past_never_comes);
    RUN_TEST(test_a_cycle_of_0_is_one_pulse);
    RUN_TEST(test_sync1_comes_behind_sync0_and_waits_for_the_next_one);
    RUN_TEST(test_a_controller_without_clocks_has_no_such_registers);
    return UNITY_END();
}
