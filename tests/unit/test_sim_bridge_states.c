/* One axis of the simulated bridge: states and statusword (BR 6.1), csp, motor errors. */
#include "sim_bridge_bench.h"

enum { MOTOR_ERROR = 0x4000, MOTOR_FREE = 0x8000, REMOTE = 0x0200, FOLLOWS = 0x1000 };
enum { STATE_BITS = 0x4F };

static bench_t b;

void setUp(void) { bench_open(&b, CM1E_DEVICE_EB12); }
void tearDown(void) { bench_close(&b); }

/* BR 6.1.3's table. */
static const struct {
    cm1e_fsa_state_t state;
    uint16_t bits;
} table[] = {
    {NOT_READY_TO_SWITCH_ON, 0x00}, {SWITCH_ON_DISABLED, 0x40}, {READY_TO_SWITCH_ON, 0x01}, {SWITCHED_ON, 0x03},
    {OPERATION_ENABLED, 0x07},      {FAULT_REACTION_ACTIVE, 0x0F}, {FAULT, 0x08},
};
enum { STATES = sizeof table / sizeof table[0] };

static void check(int axis, cm1e_fsa_state_t state, bool motor_free)
{
    char where[60];
    snprintf(where, sizeof where, "axis %d, state %d", axis, (int)state);
    int row = 0;
    while (row < STATES && table[row].state != state)
        row++;
    TEST_ASSERT_LESS_THAN_INT(STATES, row);
    TEST_ASSERT_EQUAL_HEX16_MESSAGE(table[row].bits, b.axes[axis].statusword & STATE_BITS, where);
    TEST_ASSERT_EQUAL_HEX16_MESSAGE(0, b.axes[axis].statusword & 0x0180, where); /* bits 7 and 8 are fixed */
    TEST_ASSERT_EQUAL_HEX16_MESSAGE(REMOTE, b.axes[axis].statusword & REMOTE, where);
    TEST_ASSERT_EQUAL_MESSAGE(motor_free, (b.axes[axis].statusword & MOTOR_FREE) != 0, where);
}

static void command(int axis, uint16_t controlword)
{
    b.axes[axis].controlword = controlword;
    bench_cycle_after(&b, BENCH_MS);
    bench_wait(&b, BENCH_MS); /* on the serial line */
    bench_look(&b);
}

static void test_after_power_on_a_cm1_holds_and_a_cm2_is_free_unless_k68_says_otherwise(void)
{
    bench_cycles(&b, 1);
    for (int axis = 0; axis < CM1E_BRIDGE_AXES; axis++)
        check(axis, SWITCH_ON_DISABLED, axis >= 2);
    bench_write(&b, 0x70F6, 68 - 20, 1);
    b.ops->power_on(b.bridge, b.now_ns);
    bench_cycles(&b, 1);
    check(2, NOT_READY_TO_SWITCH_ON, false);
    check(3, NOT_READY_TO_SWITCH_ON, true);
    bench_cycles(&b, 60);
    check(2, SWITCH_ON_DISABLED, false);
}

/* "When transiting to state A from state B or C, Cool Muscle will be motor free": not within state A. */
static void test_within_state_a_a_cm1_keeps_its_torque_until_it_was_enabled_once(void)
{
    bench_cycles(&b, 60);
    for (int round = 0; round < 3; round++) {
        command(0, 0x06);
        check(0, READY_TO_SWITCH_ON, false);
        command(0, 0x00);
        check(0, SWITCH_ON_DISABLED, false);
    }
    command(0, 0x06);
    command(0, 0x07);
    check(0, SWITCHED_ON, false);
    command(0, 0x06);
    check(0, READY_TO_SWITCH_ON, true);
    command(0, 0x00);
    check(0, SWITCH_ON_DISABLED, true);
}

/* Every command in every state: the transitions of BR 6.1.1, one each cycle, and no others. */
static void test_every_command_in_every_state(void)
{
    enum { STAYS = -1 };
    static const struct {
        cm1e_fsa_state_t from;
        uint16_t controlword;
        int to;
    } rows[] = {
        {SWITCH_ON_DISABLED, 0x00, STAYS}, {SWITCH_ON_DISABLED, 0x06, READY_TO_SWITCH_ON},
        {SWITCH_ON_DISABLED, 0x07, STAYS}, {SWITCH_ON_DISABLED, 0x0F, STAYS}, {SWITCH_ON_DISABLED, 0x02, STAYS},
        {READY_TO_SWITCH_ON, 0x00, SWITCH_ON_DISABLED}, {READY_TO_SWITCH_ON, 0x06, STAYS},
        {READY_TO_SWITCH_ON, 0x07, SWITCHED_ON}, {READY_TO_SWITCH_ON, 0x0F, SWITCHED_ON},
        {READY_TO_SWITCH_ON, 0x02, STAYS},
        {SWITCHED_ON, 0x00, SWITCH_ON_DISABLED}, {SWITCHED_ON, 0x06, READY_TO_SWITCH_ON}, {SWITCHED_ON, 0x07, STAYS},
        {SWITCHED_ON, 0x0F, OPERATION_ENABLED}, {SWITCHED_ON, 0x02, STAYS}, {SWITCHED_ON, 0x0B, STAYS},
        {OPERATION_ENABLED, 0x00, SWITCH_ON_DISABLED}, {OPERATION_ENABLED, 0x06, READY_TO_SWITCH_ON},
        {OPERATION_ENABLED, 0x07, SWITCHED_ON}, {OPERATION_ENABLED, 0x0F, STAYS}, {OPERATION_ENABLED, 0x02, STAYS},
        {OPERATION_ENABLED, 0x0B, STAYS}, /* quick stop is ignored */
        {FAULT, 0x00, STAYS}, {FAULT, 0x06, STAYS}, {FAULT, 0x0F, STAYS}, {FAULT, 0x80, SWITCH_ON_DISABLED},
    };
    /* A CM2, which is free from the start: power is on in Switched on and Operation enabled only. */
    cm1e_sim_bridge_axis_t *axis = &b.bridge->axes[3];
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        static const uint16_t way[] = {0x06, 0x07, 0x0F};
        char where[60];
        snprintf(where, sizeof where, "from state %d with 0x%02X", (int)rows[i].from, rows[i].controlword);
        for (int step = 0; step < 3 && axis->state != rows[i].from; step++)
            command(3, way[step]);
        if (rows[i].from == FAULT) {
            cm1e_sim_bridge_axis_error(axis, BRIDGE_STATUS_OVERLOAD);
            command(3, 0x0F);
        }
        TEST_ASSERT_EQUAL_MESSAGE(rows[i].from, axis->state, where);
        command(3, rows[i].controlword);
        const cm1e_fsa_state_t to = rows[i].to == STAYS ? rows[i].from : (cm1e_fsa_state_t)rows[i].to;
        TEST_ASSERT_EQUAL_MESSAGE(to, axis->state, where);
        check(3, to, to != SWITCHED_ON && to != OPERATION_ENABLED);
        command(3, 0x80);
        command(3, 0x00);
    }
}

static void test_one_controlword_goes_through_switched_on(void)
{
    command(0, 0x06);
    command(0, 0x0F);
    check(0, SWITCHED_ON, false);
    command(0, 0x0F);
    check(0, OPERATION_ENABLED, false);
}

static void test_all_axes_follow_their_targets(void)
{
    for (int axis = 0; axis < CM1E_BRIDGE_AXES; axis++)
        bench_enable(&b, axis);
    for (int n = 0; n < 1000; n++) {
        for (int axis = 0; axis < CM1E_BRIDGE_AXES; axis++)
            b.axes[axis].target += 10 * (axis + 1) * (axis % 2 ? -1 : 1);
        bench_cycles(&b, 1);
        for (int axis = 0; axis < CM1E_BRIDGE_AXES; axis++)
            TEST_ASSERT_EQUAL_HEX16(FOLLOWS, b.axes[axis].statusword & FOLLOWS);
    }
    TEST_ASSERT_EQUAL(BRIDGE_STATUS_RUNNING, bench_read(&b, 0xF530, 5));
    bench_cycles(&b, 500);
    for (int axis = 0; axis < CM1E_BRIDGE_AXES; axis++) {
        TEST_ASSERT_INT32_WITHIN(1, 10000 * (axis + 1) * (axis % 2 ? -1 : 1), b.axes[axis].position);
        TEST_ASSERT_EQUAL(b.axes[axis].position, bench_read(&b, (uint16_t)(0x6064 + 0x800 * axis), 0));
        TEST_ASSERT_EQUAL(BRIDGE_STATUS_IN_POSITION, bench_read(&b, 0xF530, (uint8_t)(5 + axis)));
    }
}

/* Fixed parts of the statusword in csp: bits 10, 11 and 13 (BR 6.1.3). */
static void test_bits_without_a_meaning_in_csp_are_0(void)
{
    bench_enable(&b, 3);
    b.axes[3].target = 2000;
    for (int n = 0; n < 200; n++) {
        bench_cycles(&b, 1);
        TEST_ASSERT_EQUAL_HEX16(0, b.axes[3].statusword & 0x2C00);
    }
}

static void test_a_jump_of_the_target_is_a_motor_error_and_can_be_reset(void)
{
    bench_enable(&b, 2);
    b.axes[2].target = 240000;
    bench_cycles(&b, 20);
    check(2, FAULT, true);
    TEST_ASSERT_EQUAL_HEX16(MOTOR_ERROR, b.axes[2].statusword & MOTOR_ERROR);
    TEST_ASSERT_EQUAL(BRIDGE_STATUS_POSITION_OVERFLOW, bench_read(&b, 0xF530, 7));
    TEST_ASSERT_EQUAL(BRIDGE_STATUS_IN_POSITION, bench_read(&b, 0xF530, 6)); /* the others do not mind */
    bench_cycles(&b, 500);
    command(2, 0x80);
    check(2, SWITCH_ON_DISABLED, true);
    TEST_ASSERT_EQUAL_HEX16(0, b.axes[2].statusword & MOTOR_ERROR);
    TEST_ASSERT_EQUAL(BRIDGE_STATUS_MOTOR_FREE, bench_read(&b, 0xF530, 7));
    bench_enable(&b, 2);
}

static void test_pressing_against_a_stop_overloads_the_motor(void)
{
    bench_enable(&b, 0);
    for (int n = 0; n < 4000 && !b.bridge->axes[0].error; n++) {
        if (b.axes[0].target < 290000)
            b.axes[0].target += 200;
        bench_cycles(&b, 1);
    }
    TEST_ASSERT_EQUAL(BRIDGE_STATUS_OVERLOAD, bench_read(&b, 0xF530, 5));
    TEST_ASSERT_EQUAL_HEX16(MOTOR_ERROR, b.axes[0].statusword & MOTOR_ERROR);
}

/* BR appendix 5: K37 is 10, 999,999,999 pulses. */
static void test_targets_beyond_the_resolution_are_cut(void)
{
    bench_enable(&b, 0);
    b.bridge->axes[0].zero -= 999999000; /* as if it had come a long way */
    b.axes[0].target = (int32_t)cm1e_sim_bridge_position(&b.bridge->axes[0]);
    bench_cycles(&b, 2);
    command(0, 0x06);
    bench_enable(&b, 0);
    for (int n = 0; n < 300; n++) {
        b.axes[0].target += 10;
        bench_cycles(&b, 1);
    }
    bench_cycles(&b, 300);
    TEST_ASSERT_INT32_WITHIN(1, 999999999, b.axes[0].position);
}

static void test_a_watchdog_or_a_lower_state_lets_the_motors_go(void)
{
    for (int n = 0; n < 2; n++) {
        bench_enable(&b, 1);
        if (n == 0)
            b.ops->watchdog_expired(b.bridge);
        else
            b.ops->state_change(b.bridge, BENCH_OP, BENCH_SAFEOP);
        TEST_ASSERT_EQUAL(SWITCH_ON_DISABLED, b.bridge->axes[1].state);
        TEST_ASSERT_TRUE(b.bridge->axes[1].motor_free);
        b.ops->state_change(b.bridge, BENCH_SAFEOP, BENCH_OP);
    }
}

static void test_the_serial_lines_count_a_message_each_millisecond(void)
{
    const int64_t sent = bench_read(&b, 0xF530, 9), received = bench_read(&b, 0xF530, 16);
    bench_wait(&b, 100 * BENCH_MS);
    TEST_ASSERT_EQUAL(sent + 100, bench_read(&b, 0xF530, 9));
    TEST_ASSERT_EQUAL(received + 100, bench_read(&b, 0xF530, 16));
    TEST_ASSERT_EQUAL(0, bench_read(&b, 0xF530, 1));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_after_power_on_a_cm1_holds_and_a_cm2_is_free_unless_k68_says_otherwise);
    RUN_TEST(test_within_state_a_a_cm1_keeps_its_torque_until_it_was_enabled_once);
    RUN_TEST(test_every_command_in_every_state);
    RUN_TEST(test_one_controlword_goes_through_switched_on);
    RUN_TEST(test_all_axes_follow_their_targets);
    RUN_TEST(test_bits_without_a_meaning_in_csp_are_0);
    RUN_TEST(test_a_jump_of_the_target_is_a_motor_error_and_can_be_reset);
    RUN_TEST(test_pressing_against_a_stop_overloads_the_motor);
    RUN_TEST(test_targets_beyond_the_resolution_are_cut);
    RUN_TEST(test_a_watchdog_or_a_lower_state_lets_the_motors_go);
    RUN_TEST(test_the_serial_lines_count_a_message_each_millisecond);
    return UNITY_END();
}
