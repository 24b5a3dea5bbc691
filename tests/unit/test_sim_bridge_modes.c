/* Modes of operation of the simulated bridge, switched by SDO (BR 6, 6.2.2, appendix 3), and digital inputs and outputs
 * in csp (BR 6.5). */
#include "sim_bridge_bench.h"

enum { HM = 6, CSP = 8, CML = 101, CMD = 120, CPIO = 121 };

static bench_t b;

void setUp(void) { bench_open(&b, CM1E_DEVICE_EB12); }
void tearDown(void) { bench_close(&b); }

static int64_t shown(int axis) { return bench_read(&b, (uint16_t)(0x6061 + 0x800 * axis), 0); }

/* Appendix 3: what 0x6061 shows after a wait of 5 ms. */
static int64_t switched(int axis, int8_t mode)
{
    bench_cycles(&b, 6);
    bench_write(&b, (uint16_t)(0x6060 + 0x800 * axis), 0, mode);
    bench_cycles(&b, 5);
    return shown(axis);
}

static void test_every_axis_starts_in_csp_and_switches_alone(void)
{
    for (int axis = 0; axis < CM1E_BRIDGE_AXES; axis++)
        TEST_ASSERT_EQUAL(CSP, shown(axis));
    TEST_ASSERT_EQUAL(HM, switched(2, HM));
    TEST_ASSERT_EQUAL(CMD, switched(1, CMD));
    TEST_ASSERT_EQUAL(CSP, shown(0));
    TEST_ASSERT_EQUAL(CSP, shown(3));
    b.ops->power_on(b.bridge, b.now_ns);
    TEST_ASSERT_EQUAL(CSP, shown(1));
    TEST_ASSERT_EQUAL(CSP, bench_read(&b, 0x6860, 0));
}

/* The drawing of BR 6: from the row's mode to the column's. */
static void test_the_ways_between_the_modes(void)
{
    static const int8_t modes[] = {CSP, HM, CML, CMD, CPIO};
    static const bool leads[5][5] = {
        {1, 1, 1, 1, 1}, {1, 1, 0, 0, 0}, {1, 0, 1, 1, 1}, {0, 0, 1, 1, 1}, {0, 0, 1, 1, 1}};
    for (int from = 0; from < 5; from++)
        for (int to = 0; to < 5; to++) {
            char where[40];
            snprintf(where, sizeof where, "%d to %d", modes[from], modes[to]);
            tearDown();
            setUp();
            TEST_ASSERT_EQUAL_MESSAGE(modes[from], switched(0, modes[from]), where);
            TEST_ASSERT_EQUAL_MESSAGE(modes[leads[from][to] ? to : from], switched(0, modes[to]), where);
        }
}

static void test_what_is_no_mode_becomes_csp(void)
{
    static const int8_t values[] = {0, 1, 3, 9, -1, 7, 122};
    for (size_t i = 0; i < sizeof values; i++) {
        TEST_ASSERT_EQUAL(HM, switched(0, HM));
        TEST_ASSERT_EQUAL(CSP, switched(0, values[i]));
    }
    TEST_ASSERT_EQUAL(CPIO, switched(0, CPIO));
    TEST_ASSERT_EQUAL(CPIO, switched(0, 1)); /* csp cannot be reached from here */
}

static void test_a_switch_takes_a_while_and_5_ms_lie_between_two(void)
{
    bench_cycles(&b, 6);
    bench_write(&b, 0x6060, 0, HM);
    bench_cycles(&b, 1);
    TEST_ASSERT_EQUAL(CSP, shown(0));
    bench_cycles(&b, 3);
    TEST_ASSERT_EQUAL(HM, shown(0));
    bench_write(&b, 0x6060, 0, CSP); /* 4 ms after the first */
    bench_cycles(&b, 20);
    TEST_ASSERT_EQUAL(HM, shown(0));
    TEST_ASSERT_EQUAL(CSP, switched(0, CSP));
}

static void test_no_switch_in_motion(void)
{
    bench_enable(&b, 1);
    for (int i = 0; i < 100; i++) {
        b.axes[1].target += 20;
        bench_cycles(&b, 1);
        if (i == 50)
            bench_write(&b, 0x6860, 0, HM);
    }
    TEST_ASSERT_EQUAL(CSP, shown(1));
    bench_cycles(&b, 100);
    TEST_ASSERT_EQUAL(HM, switched(1, HM));
}

/* Appendix 3.4 does not ask for a motor without an error, all others do. */
static void test_no_switch_with_an_error_except_to_cmd(void)
{
    cm1e_sim_bridge_axis_error(&b.bridge->axes[0], BRIDGE_STATUS_OVERLOAD);
    TEST_ASSERT_EQUAL(CSP, switched(0, HM));
    TEST_ASSERT_EQUAL(CSP, switched(0, CPIO));
    TEST_ASSERT_EQUAL(CMD, switched(0, CMD));
}

static void test_back_in_csp_the_target_holds_again(void)
{
    bench_enable(&b, 0);
    TEST_ASSERT_EQUAL(HM, switched(0, HM));
    b.axes[0].target += 5000; /* not followed in hm */
    bench_cycles(&b, 100);
    TEST_ASSERT_INT32_WITHIN(1, 0, b.axes[0].position);
    b.axes[0].target = b.axes[0].position;
    TEST_ASSERT_EQUAL(CSP, switched(0, CSP));
    for (int i = 0; i < 100; i++) {
        b.axes[0].target += 10;
        bench_cycles(&b, 1);
    }
    bench_cycles(&b, 200);
    TEST_ASSERT_INT32_WITHIN(1, b.axes[0].target, b.axes[0].position);
}

/* ---- digital inputs and outputs --------------------------------------------------------------------------------- */

static void test_outputs_are_set_through_the_mask_in_csp_with_power_only(void)
{
    bench_write(&b, 0x70FE, 2, 0x0D);
    bench_write(&b, 0x70FE, 1, 0xFF);
    TEST_ASSERT_EQUAL_HEX8(0, b.bridge->axes[2].outputs); /* motor free */
    bench_enable(&b, 2);
    bench_write(&b, 0x70FE, 1, 0x07);
    TEST_ASSERT_EQUAL_HEX8(0x05, b.bridge->axes[2].outputs);
    bench_write(&b, 0x70FE, 2, 0x01);
    TEST_ASSERT_EQUAL_HEX8(0x01, b.bridge->axes[2].outputs);
    bench_enable(&b, 0); /* a CM1 has output 2 alone */
    bench_write(&b, 0x60FE, 2, 0xFFFFFFFF);
    bench_write(&b, 0x60FE, 1, 0xFFFFFFFF);
    TEST_ASSERT_EQUAL_HEX8(0x02, b.bridge->axes[0].outputs);
    TEST_ASSERT_EQUAL(HM, switched(0, HM));
    bench_write(&b, 0x60FE, 1, 0);
    TEST_ASSERT_EQUAL_HEX8(0x02, b.bridge->axes[0].outputs);
}

/* "Outputs status identified by Cool Muscle's CPU is indicated" (BR 6.5.2): what is written where it does nothing, or
 * does not pass the mask, does not read back as if it were on. */
static void test_outputs_read_back_as_the_motor_has_them(void)
{
    bench_write(&b, 0x70FE, 2, 0x0F);
    bench_write(&b, 0x70FE, 1, 0x03);
    TEST_ASSERT_EQUAL_HEX32(0, bench_read(&b, 0x70FE, 1)); /* state A */
    bench_enable(&b, 2);
    TEST_ASSERT_EQUAL_HEX32(0, bench_read(&b, 0x70FE, 1));
    bench_write(&b, 0x70FE, 1, 0xF3);
    TEST_ASSERT_EQUAL_HEX32(0x03, bench_read(&b, 0x70FE, 1)); /* a motor has four outputs */
    bench_write(&b, 0x70FE, 2, 0x01);
    TEST_ASSERT_EQUAL_HEX32(0x01, bench_read(&b, 0x70FE, 1));
    TEST_ASSERT_EQUAL_HEX32(0x01, bench_read(&b, 0x70FE, 2));
    TEST_ASSERT_EQUAL(HM, switched(2, HM));
    bench_write(&b, 0x70FE, 1, 0);
    TEST_ASSERT_EQUAL_HEX32(0x01, bench_read(&b, 0x70FE, 1));
}

static void test_inputs_are_shown_in_csp_with_power_only(void)
{
    cm1e_sim_bridge_axis_t *axis = &b.bridge->axes[3];
    axis->mechanics.position = 160000;
    TEST_ASSERT_EQUAL_HEX32(0, bench_read(&b, 0x78FD, 0));
    bench_enable(&b, 3);
    TEST_ASSERT_EQUAL_HEX32(0x02, bench_read(&b, 0x78FD, 0)); /* beyond the CW sensor */
    TEST_ASSERT_EQUAL(HM, switched(3, HM));
    TEST_ASSERT_EQUAL_HEX32(0, bench_read(&b, 0x78FD, 0));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_axis_starts_in_csp_and_switches_alone);
    RUN_TEST(test_the_ways_between_the_modes);
    RUN_TEST(test_what_is_no_mode_becomes_csp);
    RUN_TEST(test_a_switch_takes_a_while_and_5_ms_lie_between_two);
    RUN_TEST(test_no_switch_in_motion);
    RUN_TEST(test_no_switch_with_an_error_except_to_cmd);
    RUN_TEST(test_back_in_csp_the_target_holds_again);
    RUN_TEST(test_outputs_are_set_through_the_mask_in_csp_with_power_only);
    RUN_TEST(test_outputs_read_back_as_the_motor_has_them);
    RUN_TEST(test_inputs_are_shown_in_csp_with_power_only);
    return UNITY_END();
}
