/* CMD and CPIO of the simulated bridge (BR 7.1) by the flows of BR appendix 1. */
#include "sim_bridge_bench.h"

enum { CMD = 120, CPIO = 121, FIVE_CYCLES = 5 };

static bench_t b;

static void enter(int axis, int8_t mode)
{
    bench_cycles(&b, 6);
    bench_write(&b, (uint16_t)(0x6060 + 0x800 * axis), 0, mode);
    bench_cycles(&b, 6);
    TEST_ASSERT_EQUAL(mode, bench_read(&b, (uint16_t)(0x6061 + 0x800 * axis), 0));
}

void setUp(void) { bench_open(&b, CM1E_DEVICE_EB12); }
void tearDown(void) { bench_close(&b); }

static void send(int axis, uint16_t word, int cycles)
{
    b.axes[axis].controlword = word;
    bench_cycles(&b, cycles);
}

/* The flow that the five have in common, up to the answer. */
static unsigned answer_to(int axis, uint16_t word)
{
    send(axis, 0x0007, FIVE_CYCLES);
    send(axis, word, FIVE_CYCLES);
    return b.axes[axis].statusword >> 8;
}

static void test_motor_free_and_enable(void)
{
    cm1e_sim_bridge_axis_t *axis = &b.bridge->axes[1];
    enter(1, CMD);
    TEST_ASSERT_EQUAL_HEX8(0xF1, answer_to(1, 0xF107));
    TEST_ASSERT_TRUE(axis->motor_free);
    TEST_ASSERT_EQUAL_HEX8(0xF2, answer_to(1, 0xF207));
    TEST_ASSERT_FALSE(axis->motor_free);
    TEST_ASSERT_EQUAL_HEX8(0xF1, answer_to(1, 0xF100)); /* as its bits stand in BR 7.1.2 */
    send(1, 0x0007, FIVE_CYCLES);
    TEST_ASSERT_EQUAL_HEX16(0, b.axes[1].statusword); /* "Command Process Completed" */
    TEST_ASSERT_FALSE(b.bridge->axes[0].motor_free);
}

static void test_motor_enable_ends_an_error(void)
{
    cm1e_sim_bridge_axis_error(&b.bridge->axes[2], BRIDGE_STATUS_OVERLOAD);
    enter(2, CMD);
    TEST_ASSERT_EQUAL_HEX8(0xF2, answer_to(2, 0xF207));
    TEST_ASSERT_EQUAL(BRIDGE_STATUS_IN_POSITION, bench_read(&b, 0xF530, 7));
}

/* "Controlword Sending Error Process" */
static void test_what_is_not_sent_long_enough_or_not_after_0007h_has_no_answer(void)
{
    enter(0, CMD);
    send(0, 0x0007, 2);
    send(0, 0xF107, FIVE_CYCLES);
    TEST_ASSERT_EQUAL_HEX16(0, b.axes[0].statusword);
    send(0, 0x0007, FIVE_CYCLES);
    send(0, 0xF107, 2);
    TEST_ASSERT_EQUAL_HEX16(0, b.axes[0].statusword);
    TEST_ASSERT_EQUAL_HEX8(0, answer_to(0, 0xF507)); /* no command */
    TEST_ASSERT_EQUAL_HEX8(0, answer_to(0, 0xF200));
    TEST_ASSERT_EQUAL_HEX8(0, answer_to(0, 0xF10F));
    TEST_ASSERT_FALSE(b.bridge->axes[0].motor_free);
    TEST_ASSERT_EQUAL_HEX8(0xF1, answer_to(0, 0xF107)); /* "Back to Command Start" */
    send(0, 0xF207, FIVE_CYCLES);                       /* without 0007h between them */
    TEST_ASSERT_EQUAL_HEX8(0xF1, b.axes[0].statusword >> 8);
}

static void test_an_unplugged_motor_does_not_answer(void)
{
    static const uint16_t words[] = {0xF107, 0xF207, 0xF307, 0xF407, 0xF607};
    enter(0, CMD);
    cm1e_sim_bridge_axis_plug(&b.bridge->axes[0], false);
    for (int i = 0; i < 5; i++)
        TEST_ASSERT_EQUAL_HEX8(0, answer_to(0, words[i]));
    cm1e_sim_bridge_axis_plug(&b.bridge->axes[0], true);
    TEST_ASSERT_EQUAL_HEX8(0xF1, answer_to(0, 0xF107));
}

static void test_reset_counter(void)
{
    bench_enable(&b, 0);
    for (int n = 0; n < 100; n++) {
        b.axes[0].target += 20;
        bench_cycles(&b, 1);
    }
    bench_cycles(&b, 200);
    enter(0, CMD);
    TEST_ASSERT_INT32_WITHIN(1, 2000, b.axes[0].position);
    TEST_ASSERT_EQUAL_HEX8(0xF4, answer_to(0, 0xF407));
    TEST_ASSERT_EQUAL_INT32(0, b.axes[0].position);
}

static void prepare_search(int method)
{
    bench_write(&b, 0x6098, 0, method);
    bench_write(&b, 0x6099, 1, 1000);
    bench_write(&b, 0x609A, 0, 1000);
    enter(0, CMD);
}

static void test_origin_search_completes(void)
{
    prepare_search(2);
    TEST_ASSERT_EQUAL_HEX8(0xF3, answer_to(0, 0xF307));
    int cycles = 0;
    for (; cycles < 10000 && b.axes[0].statusword >> 8 == 0xF3; cycles++)
        bench_cycles(&b, 1);
    TEST_ASSERT_EQUAL_HEX8(0xF8, b.axes[0].statusword >> 8);
    TEST_ASSERT_EQUAL_INT32(0, b.axes[0].position);
    TEST_ASSERT_DOUBLE_WITHIN(2000, -248500, b.bridge->axes[0].mechanics.position);
    send(0, 0x0007, FIVE_CYCLES);
    TEST_ASSERT_EQUAL_HEX16(0, b.axes[0].statusword);
}

static void test_origin_search_times_out(void)
{
    prepare_search(1);
    bench_write(&b, 0x6099, 1, 1);
    TEST_ASSERT_EQUAL_HEX8(0xF3, answer_to(0, 0xF307));
    bench_cycles(&b, 59000);
    TEST_ASSERT_EQUAL_HEX8(0xF3, b.axes[0].statusword >> 8);
    bench_cycles(&b, 1100);
    TEST_ASSERT_EQUAL_HEX8(0xF9, b.axes[0].statusword >> 8);
    TEST_ASSERT_EQUAL_HEX8(0xF3, answer_to(0, 0xF307)); /* "Back to Origin Search Start" */
}

static void test_origin_search_fails_with_the_motor(void)
{
    prepare_search(1);
    TEST_ASSERT_EQUAL_HEX8(0xF3, answer_to(0, 0xF307));
    cm1e_sim_bridge_axis_error(&b.bridge->axes[0], BRIDGE_STATUS_OVER_SPEED);
    bench_cycles(&b, 2);
    TEST_ASSERT_EQUAL_HEX8(0xF9, b.axes[0].statusword >> 8);
}

static void test_a_free_motor_searches_nothing(void)
{
    prepare_search(1);
    TEST_ASSERT_EQUAL_HEX8(0xF1, answer_to(0, 0xF107));
    TEST_ASSERT_EQUAL_HEX8(0, answer_to(0, 0xF307));
}

static void test_origin_search_abort(void)
{
    prepare_search(1);
    TEST_ASSERT_EQUAL_HEX8(0xF3, answer_to(0, 0xF307));
    bench_cycles(&b, 200);
    send(0, 0x0007, FIVE_CYCLES);
    TEST_ASSERT_EQUAL_HEX8(0xF3, b.axes[0].statusword >> 8); /* it goes on */
    TEST_ASSERT_EQUAL_HEX8(0xF6, answer_to(0, 0xF607));
    bench_cycles(&b, 300);
    const double stopped = b.bridge->axes[0].mechanics.position;
    bench_cycles(&b, 100);
    TEST_ASSERT_DOUBLE_WITHIN(1, stopped, b.bridge->axes[0].mechanics.position);
    TEST_ASSERT_FALSE(b.bridge->axes[0].motor_free);
}

/* ---- CPIO ------------------------------------------------------------------------------------------------------- */

static void test_cpio_moves_and_sets_outputs(void)
{
    for (int axis = 0; axis < CM1E_BRIDGE_AXES; axis += 3) {
        bench_enable(&b, axis);
        enter(axis, CPIO);
        send(axis, 0xC05F, 3);
        TEST_ASSERT_EQUAL_HEX8(axis == 0 ? 0 : 0x05, b.bridge->axes[axis].outputs);
        send(axis, 0xC0FF, 3);
        TEST_ASSERT_EQUAL_HEX8(axis == 0 ? 0x02 : 0x0F, b.bridge->axes[axis].outputs);
        TEST_ASSERT_EQUAL_HEX16(0xC807, b.axes[axis].statusword); /* in position */
        for (int n = 0; n < 300; n++) {
            b.axes[axis].target += 30;
            bench_cycles(&b, 1);
        }
        TEST_ASSERT_EQUAL_HEX16(0xC007, b.axes[axis].statusword); /* running */
        bench_cycles(&b, 500);
        TEST_ASSERT_INT32_WITHIN(1, b.axes[axis].target, b.axes[axis].position);
    }
}

static void test_cpio_shows_inputs_and_errors(void)
{
    b.bridge->axes[2].mechanics.position = 160000;
    bench_enable(&b, 2);
    enter(2, CPIO);
    send(2, 0xC00F, 3);
    TEST_ASSERT_EQUAL_HEX16(0xC827, b.axes[2].statusword); /* input 2 */
    send(2, 0x0006, 3);
    TEST_ASSERT_EQUAL(OPERATION_ENABLED, b.bridge->axes[2].state); /* no word of this mode */
    cm1e_sim_bridge_axis_error(&b.bridge->axes[2], BRIDGE_STATUS_OVERLOAD);
    send(2, 0xC00F, 3);
    TEST_ASSERT_EQUAL_HEX16(0xC428, b.axes[2].statusword);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_motor_free_and_enable);
    RUN_TEST(test_motor_enable_ends_an_error);
    RUN_TEST(test_what_is_not_sent_long_enough_or_not_after_0007h_has_no_answer);
    RUN_TEST(test_an_unplugged_motor_does_not_answer);
    RUN_TEST(test_reset_counter);
    RUN_TEST(test_origin_search_completes);
    RUN_TEST(test_origin_search_times_out);
    RUN_TEST(test_origin_search_fails_with_the_motor);
    RUN_TEST(test_a_free_motor_searches_nothing);
    RUN_TEST(test_origin_search_abort);
    RUN_TEST(test_cpio_moves_and_sets_outputs);
    RUN_TEST(test_cpio_shows_inputs_and_errors);
    return UNITY_END();
}
