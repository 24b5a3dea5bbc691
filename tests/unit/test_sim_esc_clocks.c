/* Distributed clocks: port times, system time, offset, delay, control loop. */
#include "sim_fake_app.h"

enum { SLAVES = 3 };

static bench_t b;

void setUp(void) { bench_open(&b, SLAVES); }
void tearDown(void) { bench_close(&b); }

static uint64_t read_u64(unsigned slave, uint16_t ado)
{
    uint8_t data[8] = {0};
    TEST_ASSERT_EQUAL_INT(1, send_to(&b, APRD, (uint16_t)-slave, ado, data, 8));
    return cm1e_get_u64(data);
}

static void latch(void)
{
    uint8_t zero[4] = {0};
    TEST_ASSERT_EQUAL_INT(SLAVES, send_to(&b, BWR, 0, 0x0900, zero, 4));
}

static void test_port_times_give_the_same_delay_between_any_two_neighbours(void)
{
    latch();
    uint32_t round_trip[SLAVES];
    for (unsigned i = 0; i < SLAVES; i++)
        round_trip[i] = read_u32(&b, i, 0x0904) - read_u32(&b, i, 0x0900);
    /* what the frame needed behind a slave, less what it needed behind the next one, is there and back */
    const uint32_t first = round_trip[0] - round_trip[1];
    TEST_ASSERT_GREATER_THAN_UINT32(100, first);
    TEST_ASSERT_LESS_THAN_UINT32(10000, first);
    TEST_ASSERT_EQUAL_UINT32(first, round_trip[1]);
    TEST_ASSERT_EQUAL_HEX32(0, read_u32(&b, SLAVES - 1, 0x0904)); /* nothing comes back at the end */
}

static void test_unit_time_has_64_bits_of_port_0(void)
{
    b.now_ns = INT64_C(0x123456789AB);
    latch();
    TEST_ASSERT_EQUAL_HEX32(read_u32(&b, 1, 0x0900), (uint32_t)read_u64(1, 0x0918));
    TEST_ASSERT_EQUAL_HEX32(0x123, (uint32_t)(read_u64(1, 0x0918) >> 32));
}

static void test_system_time_is_local_time_and_offset_and_runs(void)
{
    uint8_t offset[8];
    const uint64_t local = read_u64(0, 0x0910);
    cm1e_put_u64(offset, UINT64_C(1000000000000000));
    TEST_ASSERT_EQUAL_INT(1, write_bytes(&b, 0, 0x0920, offset, 8));
    TEST_ASSERT_EQUAL_UINT64(local + UINT64_C(1000000000000000), read_u64(0, 0x0910));
    b.now_ns += 12345;
    TEST_ASSERT_EQUAL_UINT64(local + UINT64_C(1000000000012345), read_u64(0, 0x0910));
}

/* As a master does it: offset and delay written, then the time of the first slave is distributed every cycle. */
static void test_slaves_follow_the_reference_clock(void)
{
    for (unsigned i = 0; i < SLAVES; i++)
        write_u16(&b, i, 0x0010, (uint16_t)(STATION + i));
    latch();
    const uint32_t hop = (read_u32(&b, 1, 0x0904) - read_u32(&b, 1, 0x0900)) / 2;
    for (unsigned i = 1; i < SLAVES; i++) {
        uint8_t delay[4], offset[8];
        cm1e_put_u32(delay, i * hop);
        write_bytes(&b, i, 0x0928, delay, 4);
        cm1e_put_u64(offset, 3000 * i); /* not quite right */
        write_bytes(&b, i, 0x0920, offset, 8);
    }
    uint8_t time[8] = {0};
    TEST_ASSERT_EQUAL_INT(SLAVES, send_to(&b, FRMW, STATION, 0x0910, time, 8));
    TEST_ASSERT_EQUAL_HEX32(3000, read_u32(&b, 1, 0x092C)); /* ahead */
    for (int i = 0; i < 1000; i++) {
        b.now_ns += 1000000;
        TEST_ASSERT_EQUAL_INT(SLAVES, send_to(&b, FRMW, STATION, 0x0910, time, 8));
    }
    for (unsigned i = 1; i < SLAVES; i++)
        TEST_ASSERT_EQUAL_HEX32(0, read_u32(&b, i, 0x092C) & 0x7FFFFFFF);
    TEST_ASSERT_EQUAL_HEX32(0, read_u32(&b, 0, 0x092C));
}

static void test_difference_of_a_slave_behind_has_the_sign_bit(void)
{
    uint8_t time[4];
    cm1e_put_u32(time, read_u32(&b, 0, 0x0910) + 500);
    TEST_ASSERT_EQUAL_INT(1, write_bytes(&b, 0, 0x0910, time, 4));
    TEST_ASSERT_EQUAL_HEX32(0x80000000u | 500, read_u32(&b, 0, 0x092C));
}

static void test_sync0_registers_keep_what_the_master_writes(void)
{
    uint8_t start[8] = {1, 2, 3, 4, 5, 6, 7, 8}, got[8] = {0};
    TEST_ASSERT_EQUAL_INT(1, write_bytes(&b, 0, 0x0990, start, 8));
    TEST_ASSERT_EQUAL_INT(1, write_bytes(&b, 0, 0x09A0, start, 4));
    TEST_ASSERT_EQUAL_INT(1, write_u8(&b, 0, 0x0981, 3));
    TEST_ASSERT_EQUAL_INT(1, send_to(&b, APRD, 0, 0x0990, got, 8));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(start, got, 8);
    TEST_ASSERT_EQUAL_HEX32(0x04030201, read_u32(&b, 0, 0x09A0));
    TEST_ASSERT_EQUAL_HEX8(3, read_u8(&b, 0, 0x0981));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_port_times_give_the_same_delay_between_any_two_neighbours);
    RUN_TEST(test_unit_time_has_64_bits_of_port_0);
    RUN_TEST(test_system_time_is_local_time_and_offset_and_runs);
    RUN_TEST(test_slaves_follow_the_reference_clock);
    RUN_TEST(test_difference_of_a_slave_behind_has_the_sign_bit);
    RUN_TEST(test_sync0_registers_keep_what_the_master_writes);
    return UNITY_END();
}
