/** The power drive system of the simulated CM1-E: all states under all controlwords, power, errors (UG 6.1, 7.3.1). */
#include <math.h>
#include <stdio.h>

#include "sim_cm1e_bench.h"

void setUp(void) {}
void tearDown(void) {}

enum { FAULT_BIT = 0x0008, VOLTAGE_BIT = 0x0010 };

static void to_fault(bench_t *b)
{
    cm1e_sim_fsa_error(b->drive, 0xFF04);
    TEST_ASSERT_TRUE(bench_until(b, 0x4F, 0x08, 0.1));
}

/* Brings the drive into a state by the ways of the guide. */
static void to_state(bench_t *b, cm1e_fsa_state_t state)
{
    static const uint16_t controlwords[CM1E_FSA_STATE_COUNT] = {
        [READY_TO_SWITCH_ON] = 0x06, [SWITCHED_ON] = 0x07, [OPERATION_ENABLED] = 0x0F, [FAULT] = 0x06};
    if (b->drive->fsa.state == FAULT) {
        b->controlword = 0;
        bench_cycle(b);
        b->controlword = 0x86;
        bench_cycle(b);
    }
    b->mode = state == NOT_READY_TO_SWITCH_ON ? 0 : 8;
    b->target_position = b->position;
    b->controlword = controlwords[state];
    for (int i = 0; i < 40 && (bench_state(b) != state || b->mode_display != b->mode); i++) {
        bench_cycle(b);
        if (state == FAULT && b->mode_display == 8)
            to_fault(b);
    }
    TEST_ASSERT_EQUAL_STRING(cm1e_fsa_name(state), cm1e_fsa_name(bench_state(b)));
}

/* UG 6.1, restated: where a controlword leads to that comes after the one that the state needs. */
static cm1e_fsa_state_t expected_state(cm1e_fsa_state_t from, uint16_t controlword)
{
    const bool on = controlword & 1, voltage = controlword & 2, enable = controlword & 8, reset = controlword & 0x80;
    if (from == NOT_READY_TO_SWITCH_ON)
        return from;
    if (from == FAULT)
        return reset ? READY_TO_SWITCH_ON : FAULT;
    if (reset) /* "0" in every other row of UG 6.1.2's table */
        return from;
    if (!voltage || !on)
        return READY_TO_SWITCH_ON;
    return enable ? OPERATION_ENABLED : SWITCHED_ON;
}

static void check_every_controlword(cm1e_fsa_state_t from)
{
    bench_t b;
    bench_open(&b, NULL, CM1E_PDO_ORDER_UG_4_4);
    for (uint32_t controlword = 0; controlword <= 0xFFFF; controlword++) {
        to_state(&b, from);
        b.controlword = (uint16_t)controlword;
        for (int i = 0; i < 3; i++)
            bench_cycle(&b);
        const cm1e_fsa_state_t expected = expected_state(from, (uint16_t)controlword);
        if (bench_state(&b) != expected) {
            char text[120];
            snprintf(text, sizeof text, "%s under %04X: %s, expected %s", cm1e_fsa_name(from), controlword,
                     cm1e_fsa_name(bench_state(&b)), cm1e_fsa_name(expected));
            TEST_FAIL_MESSAGE(text);
        }
        TEST_ASSERT_TRUE(b.statusword & STATUSWORD_REMOTE);
        TEST_ASSERT_TRUE(expected == OPERATION_ENABLED || b.drive->servo.torque == 0);
        TEST_ASSERT_EQUAL_MESSAGE(0, b.position, "nothing may move");
    }
    bench_close(&b);
}

static void test_not_ready_under_every_controlword(void) { check_every_controlword(NOT_READY_TO_SWITCH_ON); }
static void test_ready_under_every_controlword(void) { check_every_controlword(READY_TO_SWITCH_ON); }
static void test_switched_on_under_every_controlword(void) { check_every_controlword(SWITCHED_ON); }
static void test_operation_enabled_under_every_controlword(void) { check_every_controlword(OPERATION_ENABLED); }
static void test_fault_under_every_controlword(void) { check_every_controlword(FAULT); }

static void test_power_on_is_as_the_screenshot_of_the_guide(void)
{
    bench_t b;
    bench_open(&b, NULL, CM1E_PDO_ORDER_UG_4_4);
    bench_get_inputs(&b);
    TEST_ASSERT_EQUAL_HEX16(0x0230, b.statusword); /* UG 7.5 */
    TEST_ASSERT_EQUAL_HEX16(0x4502, b.error_code);
    TEST_ASSERT_EQUAL(0, b.mode_display);
    TEST_ASSERT_EQUAL(0, bench_read(&b, 0x1001, 0));
    bench_close(&b);
}

static void test_choosing_a_mode_passes_switch_on_disabled_and_ends_ready(void)
{
    static const int8_t modes[] = {1, 3, 6, 8, 9};
    for (int i = 0; i < 5; i++) {
        bench_t b;
        bench_open(&b, NULL, CM1E_PDO_ORDER_UG_4_4);
        b.cycle_ns = 250000;
        b.mode = modes[i];
        bool passed = false;
        for (int n = 0; n < 100 && bench_state(&b) != READY_TO_SWITCH_ON; n++) {
            bench_cycle(&b);
            passed |= (b.statusword & 0x7F) == 0x40;
        }
        TEST_ASSERT_TRUE(passed);
        TEST_ASSERT_EQUAL(READY_TO_SWITCH_ON, bench_state(&b));
        TEST_ASSERT_EQUAL(modes[i], b.mode_display);
        bench_close(&b);
    }
}

static void test_a_mode_that_does_not_exist_changes_nothing(void)
{
    bench_t b;
    bench_open(&b, NULL, CM1E_PDO_ORDER_UG_4_4);
    bench_enable(&b, 8);
    for (int mode = -128; mode <= 127; mode++) {
        if (mode == 0 || cm1e_mode_find((int8_t)mode))
            continue;
        b.mode = (int8_t)mode;
        bench_run(&b, 0.01);
        TEST_ASSERT_EQUAL(8, b.mode_display);
        TEST_ASSERT_EQUAL(OPERATION_ENABLED, bench_state(&b));
    }
    bench_close(&b);
}

static void test_mode_zero_takes_the_torque_away(void)
{
    bench_t b;
    bench_open(&b, NULL, CM1E_PDO_ORDER_UG_4_4);
    bench_enable(&b, 8);
    b.mode = 0;
    bench_run(&b, 0.01);
    TEST_ASSERT_EQUAL(NOT_READY_TO_SWITCH_ON, bench_state(&b));
    TEST_ASSERT_EQUAL_HEX16(0x4502, b.error_code);
    TEST_ASSERT_EQUAL_DOUBLE(0, b.drive->servo.torque);
    bench_close(&b);
}

static void test_the_jump_to_operation_enabled_is_allowed(void)
{
    bench_t b;
    bench_open(&b, NULL, CM1E_PDO_ORDER_UG_4_4);
    to_state(&b, READY_TO_SWITCH_ON);
    b.controlword = 0x0B; /* quick stop bit 0: ignored */
    bench_cycle(&b);
    TEST_ASSERT_EQUAL(OPERATION_ENABLED, bench_state(&b));
    bench_close(&b);
}

static void test_fault_reset_needs_an_edge(void)
{
    bench_t b;
    bench_open(&b, NULL, CM1E_PDO_ORDER_UG_4_4);
    to_state(&b, OPERATION_ENABLED);
    b.controlword = 0x8F;
    bench_cycle(&b);
    to_fault(&b);
    bench_run(&b, 0.1);
    TEST_ASSERT_EQUAL_MESSAGE(FAULT, bench_state(&b), "bit 7 was set before the fault");
    b.controlword = 0x0F;
    bench_run(&b, 0.1);
    TEST_ASSERT_EQUAL(FAULT, bench_state(&b));
    b.controlword = 0x8F;
    bench_run(&b, 0.1);
    TEST_ASSERT_EQUAL(READY_TO_SWITCH_ON, bench_state(&b));
    b.controlword = 0x0F;
    b.target_position = b.position;
    bench_cycle(&b);
    TEST_ASSERT_EQUAL_MESSAGE(OPERATION_ENABLED, bench_state(&b), "nothing in the device forbids it");
    bench_close(&b);
}

/* ---- motor power ------------------------------------------------------------------------------------------------ */

static void test_power_off_in_each_state(void)
{
    static const struct {
        cm1e_fsa_state_t before, after;
        bool fault;
    } rows[] = {
        {NOT_READY_TO_SWITCH_ON, NOT_READY_TO_SWITCH_ON, false}, {READY_TO_SWITCH_ON, READY_TO_SWITCH_ON, false},
        {SWITCHED_ON, READY_TO_SWITCH_ON, false}, {OPERATION_ENABLED, FAULT, true}, {FAULT, FAULT, true},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        bench_t b;
        bench_open(&b, NULL, CM1E_PDO_ORDER_UG_4_4);
        to_state(&b, rows[i].before);
        cm1e_sim_fsa_motor_power(b.drive, false);
        bench_run(&b, 0.01);
        TEST_ASSERT_EQUAL_STRING(cm1e_fsa_name(rows[i].after), cm1e_fsa_name(bench_state(&b)));
        TEST_ASSERT_EQUAL(rows[i].fault, (b.statusword & FAULT_BIT) != 0);
        TEST_ASSERT_EQUAL(0, b.statusword & VOLTAGE_BIT);
        TEST_ASSERT_EQUAL_HEX16(rows[i].before == FAULT ? 0xFF04 : 0xFF05, b.error_code);
        TEST_ASSERT_EQUAL(0, b.dc_link);
        b.controlword = 0;
        bench_cycle(&b);
        b.controlword = 0x80;
        bench_cycle(&b);
        b.controlword = 0x0F;
        bench_run(&b, 0.02);
        TEST_ASSERT_TRUE_MESSAGE(bench_state(&b) <= READY_TO_SWITCH_ON, "no way up without motor power");
        TEST_ASSERT_EQUAL_HEX16(0xFF05, b.error_code);
        TEST_ASSERT_EQUAL_HEX8(0x11, bench_read(&b, 0x1001, 0));
        cm1e_sim_fsa_motor_power(b.drive, true);
        bench_run(&b, 0.01);
        TEST_ASSERT_EQUAL(VOLTAGE_BIT, b.statusword & VOLTAGE_BIT);
        TEST_ASSERT_EQUAL(b.mode ? OPERATION_ENABLED : NOT_READY_TO_SWITCH_ON, bench_state(&b));
        bench_close(&b);
    }
}

/* ---- errors (UG 7.3.1) ------------------------------------------------------------------------------------------ */

/* The guide's table, restated. */
static const struct {
    uint16_t code;
    uint8_t error_register;
    bool fault;
} error_rows[] = {
    {0x2310, 0x03, true}, {0x4310, 0x09, true}, {0x4502, 0x00, false}, {0x7310, 0x81, true}, {0x7320, 0x81, true},
    {0x7500, 0x11, true}, {0x7510, 0x11, true}, {0x8611, 0x00, false}, {0xFF01, 0x00, false}, {0xFF04, 0x81, true},
    {0xFF05, 0x11, true},
};

static void test_every_error_sets_code_register_and_fault_bit(void)
{
    for (size_t i = 0; i < sizeof error_rows / sizeof error_rows[0]; i++) {
        bench_t b;
        bench_open(&b, NULL, CM1E_PDO_ORDER_UG_4_4);
        b.cycle_ns = 250000;
        to_state(&b, OPERATION_ENABLED);
        cm1e_sim_fsa_error(b.drive, error_rows[i].code);
        bench_get_inputs(&b);
        if (!error_rows[i].fault) {
            TEST_ASSERT_EQUAL(OPERATION_ENABLED, bench_state(&b));
            bench_close(&b);
            continue;
        }
        TEST_ASSERT_EQUAL_MESSAGE(FAULT_REACTION_ACTIVE, bench_state(&b), "passed through");
        TEST_ASSERT_EQUAL_DOUBLE(0, b.drive->servo.torque);
        bench_run(&b, 0.002);
        TEST_ASSERT_EQUAL(FAULT, bench_state(&b));
        TEST_ASSERT_EQUAL_HEX16(error_rows[i].code, b.error_code);
        TEST_ASSERT_EQUAL_HEX8(error_rows[i].error_register, bench_read(&b, 0x1001, 0));
        b.controlword = 0x86;
        bench_cycle(&b);
        TEST_ASSERT_EQUAL(READY_TO_SWITCH_ON, bench_state(&b));
        TEST_ASSERT_EQUAL(0, bench_read(&b, 0x1001, 0));
        TEST_ASSERT_EQUAL_HEX16(0x8611, b.error_code);
        bench_close(&b);
    }
}

static void test_the_first_of_two_errors_stays(void)
{
    bench_t b;
    bench_open(&b, NULL, CM1E_PDO_ORDER_UG_4_4);
    to_state(&b, OPERATION_ENABLED);
    cm1e_sim_fsa_error(b.drive, 0x7320);
    cm1e_sim_fsa_error(b.drive, 0x2310);
    bench_run(&b, 0.01);
    cm1e_sim_fsa_error(b.drive, 0x7310);
    bench_run(&b, 0.01);
    TEST_ASSERT_EQUAL_HEX16(0x7320, b.error_code);
    bench_close(&b);
}

static void test_a_cause_that_stays_raises_the_fault_again(void)
{
    bench_t b;
    bench_open(&b, NULL, CM1E_PDO_ORDER_UG_4_4);
    to_state(&b, READY_TO_SWITCH_ON);
    cm1e_sim_fsa_temperature(b.drive, 90);
    bench_run(&b, 0.01);
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL_HEX16(0x4310, b.error_code);
        TEST_ASSERT_EQUAL(FAULT, bench_state(&b));
        TEST_ASSERT_EQUAL(90, b.temperature);
        b.controlword = 0x86;
        bench_cycle(&b);
        b.controlword = 0x06;
        bench_run(&b, 0.01);
    }
    cm1e_sim_fsa_temperature(b.drive, 60);
    bench_run(&b, 0.01);
    TEST_ASSERT_EQUAL_MESSAGE(FAULT, bench_state(&b), "latched");
    b.controlword = 0x86;
    bench_cycle(&b);
    TEST_ASSERT_EQUAL(READY_TO_SWITCH_ON, bench_state(&b));
    bench_close(&b);
}

static void test_codes_that_are_no_errors_tell_why_the_motor_stands(void)
{
    bench_t b;
    bench_open(&b, NULL, CM1E_PDO_ORDER_UG_4_4);
    to_state(&b, READY_TO_SWITCH_ON);
    TEST_ASSERT_EQUAL_HEX16(0x8611, b.error_code);
    to_state(&b, OPERATION_ENABLED);
    bench_cycle(&b);
    TEST_ASSERT_EQUAL_HEX16(0, b.error_code);
    b.controlword = 0x06;
    bench_cycle(&b);
    TEST_ASSERT_EQUAL_HEX16(0xFF01, b.error_code);
    TEST_ASSERT_EQUAL(0, bench_read(&b, 0x1001, 0));
    bench_close(&b);
}

/* 0x7510 at power-up, UG 10.1. */
static void test_power_up_fault_by_firmware(void)
{
    static const char *const firmwares[] = {"1.2.0", "1.3.0", "1.3.4", "1.3.5"};
    for (int i = 0; i < 4; i++) {
        const bool newest = i == 3;
        const cm1e_axis_config_t config = bench_firmware(firmwares[i]);
        bench_t b;
        bench_open(&b, &config, CM1E_PDO_ORDER_UG_4_4);
        b.drive->troubles.failing_power_ups = 2;
        b.ops->power_on(b.drive, b.now_ns);
        bench_to_op(&b);
        b.mode = 8;
        b.controlword = 0x0F;
        bench_run(&b, 0.02);
        TEST_ASSERT_EQUAL_HEX16(0x7510, b.error_code);
        TEST_ASSERT_EQUAL(newest, (b.statusword & FAULT_BIT) != 0);
        TEST_ASSERT_NOT_EQUAL(OPERATION_ENABLED, bench_state(&b));
        for (int attempt = 0; attempt < 2; attempt++) {
            TEST_ASSERT_EQUAL_HEX16(0x7510, b.error_code);
            b.controlword = 0x06;
            bench_cycle(&b);
            b.controlword = 0x86;
            bench_cycle(&b);
            if (newest) {
                TEST_ASSERT_EQUAL_MESSAGE(BENCH_INIT, b.drive->al_state, "the device starts anew");
                bench_to_op(&b);
            }
            b.controlword = 0x06;
            bench_run(&b, 0.02);
        }
        TEST_ASSERT_EQUAL(READY_TO_SWITCH_ON, bench_state(&b));
        TEST_ASSERT_NOT_EQUAL(0x7510, b.error_code);
        bench_close(&b);
    }
}

static void test_power_up_fault_resets_again_while_the_bit_stays_set(void)
{
    bench_t b;
    bench_open(&b, NULL, CM1E_PDO_ORDER_UG_4_4);
    b.drive->troubles.failing_power_ups = 100;
    b.ops->power_on(b.drive, b.now_ns);
    b.controlword = 0x86;
    for (int i = 0; i < 10; i++) {
        bench_to_op(&b);
        bench_cycle(&b);
        TEST_ASSERT_EQUAL(BENCH_INIT, b.drive->al_state);
        TEST_ASSERT_EQUAL(98 - i, b.drive->troubles.failing_power_ups);
    }
    bench_close(&b);
}

static void test_7510_while_running_is_cleared_without_a_restart(void)
{
    bench_t b;
    bench_open(&b, NULL, CM1E_PDO_ORDER_UG_4_4);
    to_state(&b, OPERATION_ENABLED);
    cm1e_sim_fsa_error(b.drive, 0x7510);
    bench_run(&b, 0.01);
    TEST_ASSERT_EQUAL(FAULT, bench_state(&b));
    b.controlword = 0x86;
    bench_cycle(&b);
    TEST_ASSERT_EQUAL(BENCH_OP, b.drive->al_state);
    TEST_ASSERT_EQUAL(READY_TO_SWITCH_ON, bench_state(&b));
    bench_close(&b);
}

/* ---- EtherCAT states, watchdog, identification ------------------------------------------------------------------ */

static void test_leaving_op_takes_the_torque_away(void)
{
    static const uint8_t lower[] = {BENCH_INIT, BENCH_PREOP, BENCH_SAFEOP};
    for (int i = 0; i < 3; i++) {
        bench_t b;
        bench_open(&b, NULL, CM1E_PDO_ORDER_UG_4_4);
        to_state(&b, OPERATION_ENABLED);
        TEST_ASSERT_EQUAL_HEX16(0, b.ops->state_change(b.drive, BENCH_OP, lower[i]));
        bench_get_inputs(&b);
        TEST_ASSERT_EQUAL(READY_TO_SWITCH_ON, bench_state(&b));
        TEST_ASSERT_EQUAL_HEX16(0xFF01, b.error_code);
        bench_close(&b);
    }
}

/* What a controlword was before OP was left does not count: bits that are set when OP is back have risen. */
static void test_controlword_starts_anew_in_op(void)
{
    bench_t b;
    bench_open(&b, NULL, CM1E_PDO_ORDER_UG_4_4);
    to_state(&b, FAULT);
    b.controlword = 0x86;
    bench_cycle(&b);
    TEST_ASSERT_EQUAL(READY_TO_SWITCH_ON, bench_state(&b));
    TEST_ASSERT_EQUAL_HEX16(0, b.ops->state_change(b.drive, BENCH_OP, BENCH_SAFEOP));
    cm1e_sim_fsa_error(b.drive, 0x7500);
    b.ops->advance(b.drive, b.now_ns += 10 * BENCH_MS);
    TEST_ASSERT_EQUAL(FAULT, b.drive->fsa.state);
    TEST_ASSERT_EQUAL_HEX16(0, b.ops->state_change(b.drive, BENCH_SAFEOP, BENCH_OP));
    bench_cycle(&b);
    TEST_ASSERT_EQUAL(READY_TO_SWITCH_ON, bench_state(&b));
    bench_close(&b);
}

static void test_watchdog_disables_the_motor_since_1_3_0(void)
{
    static const char *const firmwares[] = {"1.2.0", "1.3.0", "1.3.5"};
    for (int i = 0; i < 3; i++) {
        const cm1e_axis_config_t config = bench_firmware(firmwares[i]);
        bench_t b;
        bench_open(&b, &config, CM1E_PDO_ORDER_UG_4_4);
        TEST_ASSERT_EQUAL(i > 0, b.ops->watchdog_expired != NULL);
        if (i > 0) {
            to_state(&b, OPERATION_ENABLED);
            b.ops->watchdog_expired(b.drive);
            bench_get_inputs(&b);
            TEST_ASSERT_EQUAL(READY_TO_SWITCH_ON, bench_state(&b));
        }
        bench_close(&b);
    }
}

static void test_explicit_id_and_alias(void)
{
    for (unsigned switches = 0; switches <= 0xFF; switches++) {
        const cm1e_axis_config_t config = {0};
        cm1e_sim_cm1e_t *drive = cm1e_sim_cm1e_create_app(&config, CM1E_PDO_ORDER_UG_4_4, 0, (uint8_t)switches);
        const cm1e_sim_app_ops_t *ops = cm1e_sim_cm1e_ops(drive);
        const unsigned id = switches == 0xFF ? 0 : switches; /* UG 4.2.3 */
        TEST_ASSERT_EQUAL(id, ops->explicit_device_id(drive));
        TEST_ASSERT_EQUAL_HEX16(0, ops->state_change(drive, BENCH_INIT, BENCH_PREOP));
        drive->alias = 7; /* UG 4.2.4 */
        TEST_ASSERT_EQUAL(id != 0, ops->state_change(drive, BENCH_INIT, BENCH_PREOP) != 0);
        ops->destroy(drive);
    }
}

static void test_user_variable_bits_show_in_the_statusword_since_1_3_4(void)
{
    static const char *const firmwares[] = {"1.3.3", "1.3.4", "1.3.5"};
    for (int i = 0; i < 3; i++) {
        const cm1e_axis_config_t config = bench_firmware(firmwares[i]);
        bench_t b;
        bench_open(&b, &config, CM1E_PDO_ORDER_UG_4_4);
        if (i == 0) {
            TEST_ASSERT_EQUAL_HEX32(SDO_ABORT_NO_OBJECT, bench_try_write(&b, 0x2201, 1, 0xC000));
        } else {
            for (uint32_t bits = 0; bits < 4; bits++) {
                bench_write(&b, 0x2201, 1, (int32_t)(0xFFFF3FFFu | bits << 14));
                bench_get_inputs(&b);
                TEST_ASSERT_EQUAL_HEX16(bits << 14, b.statusword & 0xC000);
                TEST_ASSERT_EQUAL_HEX16(0x0230, b.statusword & 0x3FFF);
            }
        }
        bench_close(&b);
    }
}

static void test_unknown_motor_or_firmware_gives_no_drive(void)
{
    cm1e_axis_config_t config = {.motor = "CM1-E-99"};
    TEST_ASSERT_NULL(cm1e_sim_cm1e_create_app(&config, CM1E_PDO_ORDER_UG_4_4, 0, 0));
    config = bench_firmware("one");
    TEST_ASSERT_NULL(cm1e_sim_cm1e_create_app(&config, CM1E_PDO_ORDER_UG_4_4, 0, 0));
}

static void test_a_long_pause_is_caught_up_within_bounds(void)
{
    bench_t b;
    bench_open(&b, NULL, CM1E_PDO_ORDER_UG_4_4);
    to_state(&b, OPERATION_ENABLED);
    b.now_ns += INT64_C(1000000000) * 86400 * 365;
    bench_cycle(&b);
    TEST_ASSERT_EQUAL(OPERATION_ENABLED, bench_state(&b));
    TEST_ASSERT_EQUAL(0, b.position);
    b.controlword = 0x06;
    bench_cycle(&b);
    b.drive->mechanics.velocity = 500000; /* runs out within a second, of which nothing may get lost */
    b.now_ns += INT64_C(1000000000) * 3600;
    bench_cycle(&b);
    TEST_ASSERT_INT32_WITHIN(2000, 17000, b.position);
    TEST_ASSERT_EQUAL(0, b.velocity);
    b.ops->advance(b.drive, b.now_ns - BENCH_MS);
    TEST_ASSERT_EQUAL_MESSAGE(b.now_ns, b.drive->now_ns, "time does not run backwards");
    bench_close(&b);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_not_ready_under_every_controlword);
    RUN_TEST(test_ready_under_every_controlword);
    RUN_TEST(test_switched_on_under_every_controlword);
    RUN_TEST(test_operation_enabled_under_every_controlword);
    RUN_TEST(test_fault_under_every_controlword);
    RUN_TEST(test_power_on_is_as_the_screenshot_of_the_guide);
    RUN_TEST(test_choosing_a_mode_passes_switch_on_disabled_and_ends_ready);
    RUN_TEST(test_a_mode_that_does_not_exist_changes_nothing);
    RUN_TEST(test_mode_zero_takes_the_torque_away);
    RUN_TEST(test_the_jump_to_operation_enabled_is_allowed);
    RUN_TEST(test_fault_reset_needs_an_edge);
    RUN_TEST(test_power_off_in_each_state);
    RUN_TEST(test_every_error_sets_code_register_and_fault_bit);
    RUN_TEST(test_the_first_of_two_errors_stays);
    RUN_TEST(test_a_cause_that_stays_raises_the_fault_again);
    RUN_TEST(test_codes_that_are_no_errors_tell_why_the_motor_stands);
    RUN_TEST(test_power_up_fault_by_firmware);
    RUN_TEST(test_power_up_fault_resets_again_while_the_bit_stays_set);
    RUN_TEST(test_7510_while_running_is_cleared_without_a_restart);
    RUN_TEST(test_leaving_op_takes_the_torque_away);
    RUN_TEST(test_watchdog_disables_the_motor_since_1_3_0);
    RUN_TEST(test_explicit_id_and_alias);
    RUN_TEST(test_user_variable_bits_show_in_the_statusword_since_1_3_4);
    RUN_TEST(test_unknown_motor_or_firmware_gives_no_drive);
    RUN_TEST(test_a_long_pause_is_caught_up_within_bounds);
    RUN_TEST(test_controlword_starts_anew_in_op);
    return UNITY_END();
}
