/* Digital signals behind a bridge (BR 6.5): polled while somebody reads, known only while they are fresh; outputs
 * written when they change, with their mask once, and confirmed. */
#include "drive_bridge_bench.h"

void setUp(void) { bench_open(CM1E_DEVICE_EB12, 3); }
void tearDown(void) { bench_close(); }

static unsigned transfers(uint16_t first_index, int subindex, bool write)
{
    const uint16_t index = (uint16_t)(first_index + fake_bridge.axis * CM1E_BRIDGE_INDEX_INCREMENT);
    unsigned count = 0;
    for (unsigned i = 0; i < bus.sdo_count; i++)
        count += bus.sdo_log[i].index == index && bus.sdo_log[i].subindex == subindex && bus.sdo_log[i].write == write;
    return count;
}

/* ---- inputs ----------------------------------------------------------------------------------------------------- */

/* Beyond the sensor on the CW side: input 2. */
static void stand_on_switch(bool on)
{
    const int64_t position = on ? 200000 : 0;
    fake_bridge_axis()->zero += (int64_t)fake_bridge_axis()->mechanics.position - position;
    fake_bridge_axis()->mechanics.position = (double)position;
    cm1e_servo_catch(&fake_bridge_axis()->servo, &fake_bridge_axis()->mechanics);
}

static void test_nobody_reads_nobody_asks(void)
{
    bench_enable();
    bench_cycles(500);
    TEST_ASSERT_EQUAL_UINT(0, transfers(0x60FD, 0, false));
    TEST_ASSERT_FALSE(drive.feedback.digital_known);
}

static void test_inputs_are_polled_for_a_second_after_the_last_reading(void)
{
    for (unsigned channel = 1; channel <= 4; channel++) {
        bench_open(CM1E_DEVICE_EB12, channel);
        stand_on_switch(true);
        bench_enable();
        cm1e_drive_want_inputs(&drive);
        TEST_ASSERT_FALSE(drive.feedback.digital_known);
        bench_cycles(5);
        TEST_ASSERT_TRUE(drive.feedback.digital_known);
        TEST_ASSERT_EQUAL_HEX16(0x02, drive.feedback.digital_inputs);
        bus.sdo_count = 0;
        bench_cycles(100);
        TEST_ASSERT_TRUE(drive.feedback.digital_known);
        TEST_ASSERT_UINT_WITHIN(3, 8, transfers(0x60FD, 0, false)); /* leaves the mailbox to others */
        bench_cycles(1200);
        TEST_ASSERT_FALSE(drive.feedback.digital_known);
        bus.sdo_count = 0;
        bench_cycles(300);
        TEST_ASSERT_EQUAL_UINT(0, transfers(0x60FD, 0, false));
    }
}

static void test_inputs_are_not_known_without_torque_in_hm_or_off_the_bus(void)
{
    cm1e_drive_want_inputs(&drive);
    bench_cycles(100);
    TEST_ASSERT_FALSE(drive.feedback.digital_known); /* the bridge would answer 0 */
    TEST_ASSERT_EQUAL_UINT(0, transfers(0x60FD, 0, false));
    bench_enable();
    for (int what = 0; what < 3; what++) {
        cm1e_drive_want_inputs(&drive);
        bench_cycles(10);
        TEST_ASSERT_TRUE(drive.feedback.digital_known);
        drive.command.enable = what != 0;
        drive.command.mode = what == 1 ? CM1E_MODE_HM : CM1E_MODE_CSP;
        bus_ok = what != 2;
        for (int i = 0; i < 100 && drive.feedback.digital_known; i++)
            bench_cycle();
        TEST_ASSERT_FALSE(drive.feedback.digital_known);
        drive.command.mode = CM1E_MODE_CSP;
        bus_ok = true;
        TEST_ASSERT_TRUE(bench_mode(CM1E_MODE_CSP, 200));
        bench_enable();
    }
}

static void test_an_answer_that_stays_away_makes_inputs_unknown(void)
{
    bench_enable();
    cm1e_drive_want_inputs(&drive);
    bench_cycles(10);
    fake_bridge.broken_sdo = 1000;
    bench_cycles(120);
    TEST_ASSERT_FALSE(drive.feedback.digital_known);
    TEST_ASSERT_GREATER_THAN_UINT(995, fake_bridge.broken_sdo); /* and asked no faster for that */
    fake_bridge.broken_sdo = 0;
    bench_cycles(120);
    TEST_ASSERT_TRUE(drive.feedback.digital_known);
    bus.sdo_full = true;
    bench_cycles(120);
    TEST_ASSERT_FALSE(drive.feedback.digital_known);
    bus.sdo_full = false;
    bench_cycles(10);
    TEST_ASSERT_TRUE(drive.feedback.digital_known);
}

static void test_inputs_that_the_motor_has_not_are_never_shown(void)
{
    bench_open(CM1E_DEVICE_EB12, 1);
    TEST_ASSERT_EQUAL_HEX16(0x0E, cm1e_drive_input_mask(&drive));
    TEST_ASSERT_EQUAL_HEX16(0x02, cm1e_drive_output_mask(&drive));
    bench_open(CM1E_DEVICE_EB12, 4);
    TEST_ASSERT_EQUAL_HEX16(0x3F, cm1e_drive_input_mask(&drive));
    TEST_ASSERT_EQUAL_HEX16(0x0F, cm1e_drive_output_mask(&drive));
}

/* ---- outputs ---------------------------------------------------------------------------------------------------- */

static void test_outputs_are_written_with_their_mask_once_and_confirmed(void)
{
    bench_enable();
    bench_cycles(10);
    TEST_ASSERT_EQUAL_INT(CM1E_DRIVE_OUTPUTS_SET, cm1e_drive_outputs(&drive));
    TEST_ASSERT_EQUAL_UINT(1, transfers(0x60FE, 1, true)); /* off: what they were, nobody knows */
    for (unsigned outputs = 1; outputs < 0x10; outputs++) {
        bus.sdo_count = 0;
        bus.sdo_delay = outputs % 4;
        drive.command.digital_outputs = (uint16_t)outputs;
        TEST_ASSERT_EQUAL_INT(CM1E_DRIVE_OUTPUTS_UNDER_WAY, cm1e_drive_outputs(&drive));
        int cycles = 0;
        while (cm1e_drive_outputs(&drive) != CM1E_DRIVE_OUTPUTS_SET && cycles++ < 30) {
            TEST_ASSERT_EQUAL_INT(CM1E_DRIVE_OUTPUTS_UNDER_WAY, cm1e_drive_outputs(&drive));
            bench_cycle();
        }
        TEST_ASSERT_EQUAL_HEX8(outputs, fake_bridge_axis()->outputs);
        TEST_ASSERT_EQUAL_UINT(outputs == 1, transfers(0x60FE, 2, true));
        TEST_ASSERT_EQUAL_UINT(1, transfers(0x60FE, 1, true));
    }
    bus.sdo_count = 0;
    bench_cycles(300);
    TEST_ASSERT_EQUAL_UINT(0, bus.sdo_count);
}

static void test_outputs_of_no_motor_are_no_matter(void)
{
    bench_open(CM1E_DEVICE_EB12, 2);
    bench_enable();
    drive.command.digital_outputs = 0xFFFD; /* all but output 2 */
    bench_cycles(20);
    TEST_ASSERT_EQUAL_HEX8(0, fake_bridge_axis()->outputs);
    TEST_ASSERT_EQUAL_INT(CM1E_DRIVE_OUTPUTS_SET, cm1e_drive_outputs(&drive));
    drive.command.digital_outputs = 0xFFFF;
    bench_cycles(20);
    TEST_ASSERT_EQUAL_HEX8(2, fake_bridge_axis()->outputs);
}

static void test_without_torque_outputs_wait_and_are_written_anew(void)
{
    drive.command.digital_outputs = 3;
    bench_cycles(50);
    TEST_ASSERT_EQUAL_INT(CM1E_DRIVE_OUTPUTS_WAITING, cm1e_drive_outputs(&drive));
    TEST_ASSERT_EQUAL_UINT(0, bus.sdo_count - transfers(0x6061, 0, false));
    bench_enable();
    bench_cycles(20);
    TEST_ASSERT_EQUAL_HEX8(3, fake_bridge_axis()->outputs);
    drive.command.enable = false;
    bench_cycles(10);
    drive.command.digital_outputs = 0;
    TEST_ASSERT_EQUAL_INT(CM1E_DRIVE_OUTPUTS_WAITING, cm1e_drive_outputs(&drive));
    bench_enable();
    bench_cycles(20);
    TEST_ASSERT_EQUAL_HEX8(0, fake_bridge_axis()->outputs);
}

static void test_what_a_run_before_left_on_goes_off(void)
{
    bench_enable();
    drive.command.digital_outputs = 0x0F;
    bench_cycles(20);
    TEST_ASSERT_EQUAL_HEX8(0x0F, fake_bridge_axis()->outputs);
    bench_init();
    bench_cycles(30);
    bench_enable();
    bench_cycles(20);
    TEST_ASSERT_EQUAL_HEX8(0, fake_bridge_axis()->outputs);
}

/* 60FE:1 of another master behind a mask that let nothing through (BR 6.5.2): the mask comes after a 0. */
static void test_what_another_master_left_behind_the_mask_never_goes_on(void)
{
    for (unsigned channel = 1; channel <= 4; channel++) {
        bench_open(CM1E_DEVICE_EB12, channel);
        const unsigned axis = fake_bridge.axis;
        *cm1e_sim_bridge_value(fake_bridge.app, axis, 0x60FE, 1) = 0x0F;
        *cm1e_sim_bridge_value(fake_bridge.app, axis, 0x60FE, 2) = 0;
        drive.command.digital_outputs = channel > 2 ? 1 : 0;
        drive.command.enable = true;
        for (int i = 0; i < 100; i++) {
            bench_cycle();
            TEST_ASSERT_EQUAL_HEX8(0, fake_bridge_axis()->outputs & ~drive.command.digital_outputs);
        }
        TEST_ASSERT_EQUAL_HEX8(drive.command.digital_outputs, fake_bridge_axis()->outputs);
        drive.command.digital_outputs = 2;
        bench_cycles(20);
        TEST_ASSERT_EQUAL_HEX8(2, fake_bridge_axis()->outputs);
    }
}

static void test_a_transfer_that_fails_is_told_and_repeated(void)
{
    bench_enable();
    bench_cycles(10);
    fake_bridge.broken_sdo = 3;
    drive.command.digital_outputs = 1;
    bench_cycles(5);
    TEST_ASSERT_EQUAL_INT(CM1E_DRIVE_OUTPUTS_FAILED, cm1e_drive_outputs(&drive));
    bench_cycles(500);
    TEST_ASSERT_EQUAL_INT(CM1E_DRIVE_OUTPUTS_SET, cm1e_drive_outputs(&drive));
    TEST_ASSERT_EQUAL_HEX8(1, fake_bridge_axis()->outputs);
}

static void test_after_a_power_cycle_the_mask_is_written_again(void)
{
    bench_enable();
    drive.command.digital_outputs = 1;
    bench_cycles(20);
    cm1e_drive_fail(&drive, CM1E_ERROR_BUS_LOST);
    drive.command.enable = false;
    cm1e_sim_bridge_ops.power_on(fake_bridge.app, bus.clock.virtual_now_ns);
    cm1e_sim_bridge_ops.state_change(fake_bridge.app, CM1E_AL_INIT, CM1E_AL_OP);
    bench_cycles(100);
    TEST_ASSERT_TRUE(bench_reset(50));
    TEST_ASSERT_TRUE(bench_mode(CM1E_MODE_CSP, 50));
    bench_enable();
    bench_cycles(30);
    TEST_ASSERT_EQUAL_HEX8(1, fake_bridge_axis()->outputs);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_nobody_reads_nobody_asks);
    RUN_TEST(test_inputs_are_polled_for_a_second_after_the_last_reading);
    RUN_TEST(test_inputs_are_not_known_without_torque_in_hm_or_off_the_bus);
    RUN_TEST(test_an_answer_that_stays_away_makes_inputs_unknown);
    RUN_TEST(test_inputs_that_the_motor_has_not_are_never_shown);
    RUN_TEST(test_outputs_are_written_with_their_mask_once_and_confirmed);
    RUN_TEST(test_outputs_of_no_motor_are_no_matter);
    RUN_TEST(test_without_torque_outputs_wait_and_are_written_anew);
    RUN_TEST(test_what_a_run_before_left_on_goes_off);
    RUN_TEST(test_what_another_master_left_behind_the_mask_never_goes_on);
    RUN_TEST(test_a_transfer_that_fails_is_told_and_repeated);
    RUN_TEST(test_after_a_power_cycle_the_mask_is_written_again);
    return UNITY_END();
}
