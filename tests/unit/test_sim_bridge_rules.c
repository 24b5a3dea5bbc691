/* What the simulated bridge does to a master that breaks a rule of the guide or goes away: visible, and defined. */
#include <math.h>

#include "sim_bridge_bench.h"

enum { HM = 6, CSP = 8, CML = 101, CMD = 120, CPIO = 121, FIVE_CYCLES = 5 };

static bench_t b;

void setUp(void) { bench_open(&b, CM1E_DEVICE_EB12); }
void tearDown(void) { bench_close(&b); }

static void want_mode(int axis, int8_t mode) { bench_write(&b, (uint16_t)(0x6060 + 0x800 * axis), 0, mode); }

static void enter(int axis, int8_t mode)
{
    bench_cycles(&b, 6);
    want_mode(axis, mode);
    bench_cycles(&b, 6);
    TEST_ASSERT_EQUAL(mode, bench_read(&b, (uint16_t)(0x6061 + 0x800 * axis), 0));
}

static void send_cml(int axis, const char *text)
{
    TEST_ASSERT_EQUAL_HEX32(0, b.ops->sdo_write(b.bridge, (uint16_t)(0xF581 + axis), 0, BENCH_OP,
                                                (const uint8_t *)text, strlen(text)));
}

static unsigned broken(int axis)
{
    const unsigned rules = b.bridge->axes[axis].broken_rules;
    b.bridge->axes[axis].broken_rules = 0;
    return rules;
}

/* ---- on the way over the serial line ---------------------------------------------------------------------------- */

static void test_process_data_is_with_the_motor_a_millisecond_later(void)
{
    bench_enable(&b, 3);
    const uint32_t before = b.bridge->axes[3].state;
    b.axes[3].controlword = 0x06;
    bench_cycle_after(&b, BENCH_MS);
    bench_wait(&b, BENCH_MS - 1000);
    TEST_ASSERT_EQUAL(before, b.bridge->axes[3].state);
    TEST_ASSERT_FALSE(b.bridge->axes[3].motor_free);
    bench_wait(&b, 1000);
    TEST_ASSERT_EQUAL(READY_TO_SWITCH_ON, b.bridge->axes[3].state);
    TEST_ASSERT_TRUE(b.bridge->axes[3].motor_free);
}

/* Cycles that come a little early and a little late arrive each once, in order. */
static void test_no_cycle_is_lost_or_doubled_on_the_way(void)
{
    bench_enable(&b, 0);
    for (int n = 0; n < 400; n++) {
        b.axes[0].target += 20;
        bench_cycle_after(&b, n % 2 ? 1250000 : 750000);
        TEST_ASSERT_TRUE(fabs(b.bridge->axes[0].mechanics.velocity) < 24000);
        if (n > 100)
            TEST_ASSERT_DOUBLE_WITHIN(3000, 20000, b.bridge->axes[0].mechanics.velocity);
    }
    TEST_ASSERT_EQUAL_HEX32(0, broken(0));
}

/* ---- K37 -------------------------------------------------------------------------------------------------------- */

static void test_a_revolution_has_the_pulses_of_k37(void)
{
    enter(2, CML);
    bench_cycles(&b, FIVE_CYCLES);
    send_cml(2, "K37.3=3");
    bench_cycles(&b, 10);
    send_cml(2, "K37.3=9"); /* no resolution: not taken */
    bench_cycles(&b, 10);
    TEST_ASSERT_EQUAL_INT64(3, *cm1e_sim_bridge_k(b.bridge, 2, 37));
    TEST_ASSERT_EQUAL_DOUBLE(1, b.bridge->axes[2].scale); /* until it is switched on again */
    b.ops->power_on(b.bridge, b.now_ns);
    bench_cycles(&b, 100);
    bench_enable(&b, 2);
    for (int n = 0; n < 500; n++) {
        b.axes[2].target += 2; /* a revolution of 1000 pulses */
        bench_cycles(&b, 1);
    }
    bench_cycles(&b, 300);
    TEST_ASSERT_DOUBLE_WITHIN(51, 50000, b.bridge->axes[2].mechanics.position);
    TEST_ASSERT_EQUAL_INT32(1000, b.axes[2].position);
    b.axes[2].target = 0;
    for (int n = 0; n < 500; n++) {
        b.axes[2].target = 1000 - 2 * n;
        bench_cycles(&b, 1);
    }
    TEST_ASSERT_EQUAL_HEX32(0, broken(2));
}

static void test_the_search_turns_by_the_pulses_of_k37(void)
{
    *cm1e_sim_bridge_k(b.bridge, 0, 37) = 3;
    b.ops->power_on(b.bridge, b.now_ns);
    bench_cycles(&b, 100);
    bench_enable(&b, 0);
    enter(0, HM);
    bench_write(&b, 0x6098, 0, 3);
    bench_write(&b, 0x6099, 1, 10); /* 1000 pulses/s: a revolution a second */
    bench_write(&b, 0x609A, 0, 10);
    bench_write(&b, 0x607C, 0, -5); /* half a revolution */
    b.axes[0].controlword = 0x1F;
    bench_cycles(&b, 500);
    TEST_ASSERT_DOUBLE_WITHIN(1000, 50000, b.bridge->axes[0].mechanics.velocity);
    bench_cycles(&b, 4500);
    TEST_ASSERT_EQUAL_HEX16(0x1400, b.axes[0].statusword & 0x3400);
    TEST_ASSERT_DOUBLE_WITHIN(2, 150000 - 25000, b.bridge->axes[0].mechanics.position);
    TEST_ASSERT_EQUAL_INT32(0, b.axes[0].position);
}

/* ---- the master goes away --------------------------------------------------------------------------------------- */

typedef struct departure {
    const char *name;
    int8_t mode;
    const char *cml;
    uint16_t words[3];
    bool free_then; /* the motor is without torque afterwards: it was on by the state machine */
} departure_t;

static const departure_t departures[] = {
    {"csp, moving", CSP, NULL, {0}, true},
    {"hm, searching", HM, NULL, {0x0F, 0x1F, 0}, true},
    {"CMD, searching", CMD, NULL, {0x0007, 0xF307, 0}, false},
    {"CPIO, moving", CPIO, NULL, {0xC006, 0xC007, 0xC00F}, true},
    {"CML, searching", CML, "|.1", {0x0000, 0, 0}, false},
};

static void begin(const departure_t *departure)
{
    cm1e_sim_bridge_axis_t *axis = &b.bridge->axes[0];
    if (departure->mode == CSP || departure->mode == HM)
        bench_enable(&b, 0);
    if (departure->mode != CSP)
        enter(0, departure->mode);
    bench_write(&b, 0x6099, 1, 500);
    bench_cycles(&b, 100);
    for (int i = 0; i < 3 && departure->words[i]; i++) {
        b.axes[0].controlword = departure->words[i];
        bench_cycles(&b, FIVE_CYCLES);
    }
    if (departure->cml)
        send_cml(0, departure->cml);
    for (int n = 0; n < 300; n++) {
        b.axes[0].target += 50;
        bench_cycles(&b, 1);
    }
    TEST_ASSERT_TRUE_MESSAGE(fabs(axis->mechanics.velocity) > 20000, departure->name);
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(0, broken(0), departure->name);
}

/* In every mode: it stands, a search has ended, nothing moves when the master comes back, 0x6061 stays. */
static void test_without_process_data_the_motor_stops_in_every_mode(void)
{
    for (size_t i = 0; i < sizeof departures / sizeof departures[0]; i++)
        for (int lowered = 0; lowered < 2; lowered++) {
            const departure_t *departure = &departures[i];
            bench_close(&b);
            bench_open(&b, CM1E_DEVICE_EB01);
            begin(departure);
            cm1e_sim_bridge_axis_t *axis = &b.bridge->axes[0];
            if (!lowered)
                b.ops->watchdog_expired(b.bridge);
            b.ops->state_change(b.bridge, BENCH_OP, BENCH_SAFEOP);
            bench_wait(&b, 1000 * BENCH_MS);
            TEST_ASSERT_TRUE_MESSAGE(fabs(axis->mechanics.velocity) < 1, departure->name);
            TEST_ASSERT_FALSE_MESSAGE(cm1e_sim_search_running(&axis->search), departure->name);
            TEST_ASSERT_EQUAL_MESSAGE(SWITCH_ON_DISABLED, axis->state, departure->name);
            TEST_ASSERT_EQUAL_MESSAGE(departure->free_then, axis->motor_free, departure->name);
            TEST_ASSERT_EQUAL_MESSAGE(departure->mode, bench_read(&b, 0x6061, 0), departure->name);
            const double stopped = axis->mechanics.position;
            b.ops->state_change(b.bridge, BENCH_SAFEOP, BENCH_OP);
            b.axes[0].controlword = 0;
            bench_cycles(&b, 100);
            TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1, stopped, axis->mechanics.position, departure->name);
        }
}

/* ---- rules ------------------------------------------------------------------------------------------------------ */

static void test_a_target_elsewhere_makes_an_enabled_motor_jump(void)
{
    static const uint16_t words[] = {0x06, 0x07, 0x0F};
    for (int i = 0; i < 3; i++) {
        b.axes[2].target = 5000;
        b.axes[2].controlword = words[i];
        bench_cycles(&b, 2);
    }
    bench_cycles(&b, 10);
    TEST_ASSERT_EQUAL_HEX32(CM1E_SIM_STEP_AT_START, broken(2));
    TEST_ASSERT_TRUE(b.bridge->axes[2].mechanics.peak_velocity > 200000);
    TEST_ASSERT_INT32_WITHIN(500, 5000, b.axes[2].position);
    b.axes[2].target += 2700; /* as far as the fastest motor goes */
    bench_cycles(&b, 2);
    TEST_ASSERT_EQUAL_HEX32(0, broken(2));
    b.axes[2].target += 2800;
    bench_cycles(&b, 2);
    TEST_ASSERT_EQUAL_HEX32(CM1E_SIM_STEP_IN_CYCLE, broken(2));
}

static void test_switches_of_mode_against_the_rules(void)
{
    enter(0, HM);
    want_mode(0, CSP);
    TEST_ASSERT_EQUAL_HEX32(0, broken(0)); /* enter() waited */
    want_mode(0, HM);
    TEST_ASSERT_EQUAL_HEX32(CM1E_SIM_MODE_TOO_SOON, broken(0));
    bench_cycles(&b, 6);
    enter(0, CSP);
    bench_enable(&b, 1);
    for (int n = 0; n < 50; n++) {
        b.axes[1].target += 100;
        bench_cycles(&b, 1);
    }
    want_mode(1, HM);
    TEST_ASSERT_EQUAL_HEX32(CM1E_SIM_MODE_IN_MOTION, broken(1));
    cm1e_sim_bridge_axis_error(&b.bridge->axes[3], BRIDGE_STATUS_OVERLOAD);
    want_mode(3, CML);
    TEST_ASSERT_EQUAL_HEX32(CM1E_SIM_MODE_IN_ERROR, broken(3));
    enter(2, CMD);
    want_mode(2, CSP);
    TEST_ASSERT_EQUAL_HEX32(CM1E_SIM_MODE_NO_WAY, broken(2));
    enter(2, CML);
    enter(2, CSP);
    TEST_ASSERT_EQUAL_HEX32(0, broken(2));
    bench_enable(&b, 2); /* "It will possibly result in operating abnormal" */
    TEST_ASSERT_EQUAL_HEX32(CM1E_SIM_MODE_NO_WAY, broken(2));
}

static void test_strings_against_the_rules(void)
{
    enter(0, CML);
    bench_cycles(&b, FIVE_CYCLES);
    send_cml(0, "?99.1");
    TEST_ASSERT_EQUAL_HEX32(0, broken(0));
    send_cml(0, "?99.1");
    TEST_ASSERT_EQUAL_HEX32(CM1E_SIM_CML_TOO_SOON, broken(0));
    bench_cycles(&b, 10);
    send_cml(0, "?99.1\r\n");
    TEST_ASSERT_EQUAL_HEX32(CM1E_SIM_CML_LINE_END, broken(0));
    b.axes[0].controlword = 0x06;
    bench_cycles(&b, 10);
    send_cml(0, "?99.1");
    TEST_ASSERT_EQUAL_HEX32(CM1E_SIM_CML_LINE_BUSY, broken(0));
}

/* "Wait 100msec (Until setting is done)" */
static void test_a_search_right_behind_its_settings(void)
{
    bench_enable(&b, 0);
    enter(0, HM);
    bench_cycles(&b, 100);
    for (int wait_ms = 97; wait_ms <= 100; wait_ms += 3) {
        bench_write(&b, 0x6098, 0, 2);
        bench_cycles(&b, wait_ms);
        b.axes[0].controlword = 0x1F;
        bench_cycles(&b, 2);
        TEST_ASSERT_EQUAL_HEX32(wait_ms < 100 ? CM1E_SIM_HOMING_TOO_SOON : 0, broken(0));
        b.axes[0].controlword = 0x0F;
        bench_cycles(&b, 2);
    }
}

static void test_words_and_outputs_against_the_rules(void)
{
    bench_write(&b, 0x60FE, 2, 2);
    TEST_ASSERT_EQUAL_HEX32(0, broken(0));
    bench_write(&b, 0x60FE, 1, 2);
    TEST_ASSERT_EQUAL_HEX32(CM1E_SIM_OUTPUT_IN_VAIN, broken(0));
    bench_enable(&b, 0);
    bench_write(&b, 0x60FE, 1, 2);
    TEST_ASSERT_EQUAL_HEX32(0, broken(0));
    b.axes[0].controlword = 0x0B;
    bench_cycles(&b, 2);
    TEST_ASSERT_EQUAL_HEX32(CM1E_SIM_QUICK_STOP, broken(0));
    TEST_ASSERT_EQUAL(OPERATION_ENABLED, b.bridge->axes[0].state);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_process_data_is_with_the_motor_a_millisecond_later);
    RUN_TEST(test_no_cycle_is_lost_or_doubled_on_the_way);
    RUN_TEST(test_a_revolution_has_the_pulses_of_k37);
    RUN_TEST(test_the_search_turns_by_the_pulses_of_k37);
    RUN_TEST(test_without_process_data_the_motor_stops_in_every_mode);
    RUN_TEST(test_a_target_elsewhere_makes_an_enabled_motor_jump);
    RUN_TEST(test_switches_of_mode_against_the_rules);
    RUN_TEST(test_strings_against_the_rules);
    RUN_TEST(test_a_search_right_behind_its_settings);
    RUN_TEST(test_words_and_outputs_against_the_rules);
    return UNITY_END();
}
