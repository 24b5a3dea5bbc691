/* Homing of the simulated bridge by the flow of BR appendix 4, bits of BR 6.4.2, units of BR 6.4.1. */
#include <math.h>

#include "sim_bridge_bench.h"

enum { HM = 6, REACHED = 0x0400, ATTAINED = 0x1000, ERROR = 0x2000, BITS = 0x3400 };

static bench_t b;

void setUp(void) { bench_open(&b, CM1E_DEVICE_EB12); }
void tearDown(void) { bench_close(&b); }

static void prepare(int axis, int method)
{
    const uint16_t offset = (uint16_t)(0x800 * axis);
    bench_enable(&b, axis);
    bench_cycles(&b, 6);
    bench_write(&b, (uint16_t)(0x6060 + offset), 0, HM);
    bench_cycles(&b, 6);
    TEST_ASSERT_EQUAL(HM, bench_read(&b, (uint16_t)(0x6061 + offset), 0));
    TEST_ASSERT_EQUAL_HEX16(REACHED, b.axes[axis].statusword & BITS); /* not started */
    bench_write(&b, (uint16_t)(0x6098 + offset), 0, method);
    bench_write(&b, (uint16_t)(0x6099 + offset), 1, 1000); /* 100,000 pulses/s */
    bench_write(&b, (uint16_t)(0x609A + offset), 0, 1000);
}

/* TRUE: bit 12 came; FALSE: bit 13, or nothing. */
static bool monitor(int axis, int ms)
{
    b.axes[axis].controlword = 0x1F;
    bench_cycles(&b, 2);
    for (int n = 0; n < ms; n++) {
        if (b.axes[axis].statusword & (ATTAINED | ERROR))
            break;
        TEST_ASSERT_EQUAL_HEX16(0, b.axes[axis].statusword & BITS); /* during homing */
        bench_cycles(&b, 1);
    }
    const bool attained = (b.axes[axis].statusword & BITS) == (ATTAINED | REACHED);
    b.axes[axis].controlword = 0x0F;
    bench_cycles(&b, 2);
    return attained;
}

/* A profile of a device may have values of 0x6098 that no SDO may write. */
static void test_a_method_that_is_none_starts_no_search(void)
{
    static const int64_t none[] = {0, 5, 254, -1};
    for (size_t i = 0; i < sizeof none / sizeof none[0]; i++) {
        tearDown();
        setUp();
        prepare(0, 1);
        const double before = b.bridge->axes[0].mechanics.position;
        *cm1e_sim_bridge_value(b.bridge, 0, 0x6098, 0) = none[i];
        b.axes[0].controlword = 0x1F;
        bench_cycles(&b, 100);
        TEST_ASSERT_EQUAL_HEX16(ERROR | REACHED, b.axes[0].statusword & BITS);
        TEST_ASSERT_DOUBLE_WITHIN(1.0, before, b.bridge->axes[0].mechanics.position);
    }
}

static double shaft(int axis) { return b.bridge->axes[axis].mechanics.position; }

static void test_the_four_methods_with_both_kinds_of_motor(void)
{
    /* stops at 250,000, sensors at 150,000; from a stop it goes back to the second tooth */
    static const struct {
        int method;
        double least, most;
    } rows[] = {{1, 247000, 249999}, {2, -249999, -247000}, {3, 149999, 150001}, {4, -150001, -149999}};
    for (int axis = 0; axis < CM1E_BRIDGE_AXES; axis += 3)
        for (int i = 0; i < 4; i++) {
            tearDown();
            setUp();
            prepare(axis, rows[i].method);
            TEST_ASSERT_TRUE(monitor(axis, 10000));
            TEST_ASSERT_TRUE(shaft(axis) >= rows[i].least && shaft(axis) <= rows[i].most);
            TEST_ASSERT_EQUAL_INT32(0, b.axes[axis].position);
            TEST_ASSERT_EQUAL_HEX16(ATTAINED | REACHED, b.axes[axis].statusword & BITS);
        }
}

/* K48 in hundreds; on a CM2 the second digit of K45 makes it tens or ones. */
static void test_the_offset_has_the_unit_of_the_motor(void)
{
    static const struct {
        int axis, k45;
        double pulses;
    } rows[] = {{0, 0, 1200}, {0, 10, 1200}, {2, 0, 1200}, {2, 10, 120}, {2, 21, 12}, {2, 30, 1200}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        const uint16_t offset = (uint16_t)(0x800 * rows[i].axis);
        tearDown();
        setUp();
        prepare(rows[i].axis, 3);
        bench_write(&b, (uint16_t)(0x607C + offset), 0, -12);
        bench_write(&b, (uint16_t)(0x60F6 + offset), 45 - 20, rows[i].k45);
        TEST_ASSERT_TRUE(monitor(rows[i].axis, 10000));
        TEST_ASSERT_DOUBLE_WITHIN(1, 150000 - rows[i].pulses, shaft(rows[i].axis));
        TEST_ASSERT_EQUAL_INT32(0, b.axes[rows[i].axis].position);
    }
}

static void test_the_speed_is_that_of_k42(void)
{
    prepare(1, 3);
    bench_write(&b, 0x6899, 2, 300); /* the same parameter as sub-index 1 */
    b.axes[1].controlword = 0x1F;
    bench_cycles(&b, 500);
    TEST_ASSERT_DOUBLE_WITHIN(300, 30000, b.bridge->axes[1].mechanics.velocity);
}

static void test_a_start_is_an_edge_in_operation_enabled(void)
{
    prepare(0, 1);
    b.axes[0].controlword = 0x17; /* Switched on */
    bench_cycles(&b, 3);
    b.axes[0].controlword = 0x1F;
    bench_cycles(&b, 50);
    TEST_ASSERT_EQUAL_HEX16(REACHED, b.axes[0].statusword & BITS);
    b.axes[0].controlword = 0x0F;
    bench_cycles(&b, 2);
    b.axes[0].controlword = 0x1F;
    bench_cycles(&b, 3);
    TEST_ASSERT_EQUAL_HEX16(0, b.axes[0].statusword & BITS);
}

/* Bit 4 says "search", so 0 says "do not": the motor stands, and homing is neither attained nor failed. */
static void test_without_bit_4_a_search_ends(void)
{
    prepare(0, 1);
    b.axes[0].controlword = 0x1F;
    bench_cycles(&b, 200);
    TEST_ASSERT_TRUE(b.bridge->axes[0].mechanics.velocity > 50000);
    b.axes[0].controlword = 0x0F;
    bench_cycles(&b, 50);
    TEST_ASSERT_EQUAL_HEX16(REACHED, b.axes[0].statusword & BITS);
    TEST_ASSERT_FALSE(b.bridge->axes[0].motor_free);
    const double stopped = shaft(0);
    b.axes[0].controlword = 0x0F;
    bench_cycles(&b, 100);
    TEST_ASSERT_DOUBLE_WITHIN(30, stopped, shaft(0));
    TEST_ASSERT_TRUE(monitor(0, 8000)); /* and it can begin again */
}

static void test_without_power_a_search_ends(void)
{
    prepare(0, 1);
    b.axes[0].controlword = 0x1F;
    bench_cycles(&b, 100);
    b.axes[0].controlword = 0x06;
    bench_cycles(&b, 2);
    TEST_ASSERT_EQUAL_HEX16(REACHED, b.axes[0].statusword & BITS);
    TEST_ASSERT_TRUE(b.bridge->axes[0].motor_free);
}

static void test_what_is_not_found_in_time_is_a_homing_error(void)
{
    prepare(1, 3);
    bench_write(&b, 0x6899, 1, 1); /* 100 pulses/s */
    TEST_ASSERT_FALSE(monitor(1, 60100));
    TEST_ASSERT_EQUAL_HEX16(ERROR | REACHED, b.axes[1].statusword & BITS);
    TEST_ASSERT_EQUAL_HEX16(0x07, b.axes[1].statusword & 0x4F); /* and no fault */
    bench_write(&b, 0x6899, 1, 1000);
    TEST_ASSERT_TRUE(monitor(1, 8000));
}

static void test_an_error_of_the_motor_is_a_homing_error(void)
{
    prepare(3, 2);
    b.axes[3].controlword = 0x1F;
    bench_cycles(&b, 100);
    cm1e_sim_bridge_axis_error(&b.bridge->axes[3], BRIDGE_STATUS_OVER_SPEED);
    TEST_ASSERT_FALSE(monitor(3, 10));
    TEST_ASSERT_EQUAL_HEX16(ERROR | REACHED, b.axes[3].statusword & BITS);
}

static void test_no_other_mode_while_searching(void)
{
    prepare(0, 1);
    b.axes[0].controlword = 0x1F;
    bench_cycles(&b, 20);
    bench_write(&b, 0x6060, 0, 8);
    bench_cycles(&b, 20);
    TEST_ASSERT_EQUAL(HM, bench_read(&b, 0x6061, 0));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_four_methods_with_both_kinds_of_motor);
    RUN_TEST(test_a_method_that_is_none_starts_no_search);
    RUN_TEST(test_the_offset_has_the_unit_of_the_motor);
    RUN_TEST(test_the_speed_is_that_of_k42);
    RUN_TEST(test_a_start_is_an_edge_in_operation_enabled);
    RUN_TEST(test_without_bit_4_a_search_ends);
    RUN_TEST(test_without_power_a_search_ends);
    RUN_TEST(test_what_is_not_found_in_time_is_a_homing_error);
    RUN_TEST(test_an_error_of_the_motor_is_a_homing_error);
    RUN_TEST(test_no_other_mode_while_searching);
    return UNITY_END();
}
