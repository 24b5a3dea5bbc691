/* Enable never moves: every mode, mapping, order of objects and position, also while somebody turns the shaft. */
#include <stdlib.h>

#include "drive/drive.h"
#include "unity.h"

#include "../support/fake_bus.h"

static const int64_t cycle_ns = 1000000;
static cm1e_bus_t bus;
static cm1e_drive_t drive;
static cm1e_diag_t diag;

void setUp(void) {}
void tearDown(void) {}

static void start(cm1e_mapping_t mapping, cm1e_pdo_order_t order, cm1e_firmware_t firmware, int32_t position)
{
    fake_bus_init(&bus, mapping, order, firmware);
    bus.position = position;
    diag.text[0] = '\0';
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, cm1e_drive_init(&drive, &bus, 0, &diag), diag.text);
    fake_bus_show(&bus);
}

static void cycle(void)
{
    fake_bus_cycle(&bus, cycle_ns);
    cm1e_drive_read(&drive, true, bus.clock.virtual_now_ns);
}

static const int32_t positions[] = {0, 1, -1, 123456789, -123456789, INT32_MAX, INT32_MIN, INT32_MAX - 1,
                                    INT32_MIN + 1};
static const cm1e_mode_t modes[] = {CM1E_MODE_PP, CM1E_MODE_PV, CM1E_MODE_HM, CM1E_MODE_CSP, CM1E_MODE_CSV};

/* The caller asks for wild targets from the beginning: none of them may reach the wire before `enabled`. */
static void enable_with_turning_shaft(cm1e_mode_t mode, int32_t turn_per_cycle)
{
    if (!cm1e_drive_supports(&drive, mode))
        return;
    const bool has_position = drive.image.out_position.bytes, has_velocity = drive.image.out_velocity.bytes;
    drive.command = (cm1e_drive_command_t){.enable = true, .mode = mode, .target_position = 1000000007,
                                           .target_velocity = 2000000, .homing_start = true};
    unsigned n = 0;
    for (; n < 200; n++) {
        const int32_t shown = bus.position;
        cm1e_drive_read(&drive, true, bus.clock.virtual_now_ns);
        if (drive.feedback.enabled)
            break;
        cm1e_drive_write(&drive);
        if (has_position)
            TEST_ASSERT_EQUAL_INT32(shown, (int32_t)fake_output(&bus, 0x607A, 0));
        if (has_velocity)
            TEST_ASSERT_EQUAL_INT32(0, (int32_t)fake_output(&bus, 0x60FF, 0));
        const uint32_t word = fake_output(&bus, 0x6040, 0);
        TEST_ASSERT_EQUAL_HEX16(0, word & 0x0190); /* no start bit, reset or halt */
        if ((word & 0x000F) == 0x000F)
            TEST_ASSERT_EQUAL_INT8(mode, bus.mode); /* never torque in another mode */
        if (bus.state != OPERATION_ENABLED) /* else the fake drive holds the shaft */
            bus.position = (int32_t)((uint32_t)bus.position + (uint32_t)turn_per_cycle);
        fake_bus_cycle(&bus, cycle_ns);
    }
    TEST_ASSERT_TRUE(drive.feedback.enabled);
    TEST_ASSERT_EQUAL_INT(OPERATION_ENABLED, drive.feedback.state);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, drive.fault.error);
    TEST_ASSERT_LESS_OR_EQUAL_INT64(labs(turn_per_cycle), bus.torque_step); /* one cycle of the turning at most */
}

static void test_enable_in_every_mode_mapping_and_order_never_moves(void)
{
    static const int32_t turns[] = {0, 3, -3, 2500, -2500};
    for (int mapping = CM1E_MAPPING_DYNAMIC; mapping <= CM1E_MAPPING_PROFILE; mapping++)
        for (int order = CM1E_PDO_ORDER_UG_4_4; order <= CM1E_PDO_ORDER_UG_7_2; order++)
            for (int firmware = 0; firmware < CM1E_FIRMWARE_COUNT; firmware++)
                for (size_t m = 0; m < sizeof modes / sizeof modes[0]; m++)
                    for (size_t p = 0; p < sizeof positions / sizeof positions[0]; p++)
                        for (size_t t = 0; t < sizeof turns / sizeof turns[0]; t++) {
                            start((cm1e_mapping_t)mapping, (cm1e_pdo_order_t)order, (cm1e_firmware_t)firmware,
                                  positions[p]);
                            enable_with_turning_shaft(modes[m], turns[t]);
                        }
}

static void test_enable_goes_one_command_a_cycle(void)
{
    start(CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5, 0);
    static const uint16_t words[] = {0x06, 0x07, 0x0F, 0x0F};
    cm1e_drive_read(&drive, true, 0);
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
        cm1e_drive_write(&drive);
        TEST_ASSERT_EQUAL_HEX16(words[i], fake_output(&bus, 0x6040, 0));
        drive.command.enable = true;
        cycle();
    }
    TEST_ASSERT_TRUE(drive.feedback.enabled);
}

static void test_targets_pass_only_while_enabled_in_the_commanded_mode(void)
{
    start(CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5, 500);
    enable_with_turning_shaft(CM1E_MODE_CSP, 0);
    drive.command.target_position = 510;
    drive.command.target_velocity = 77;
    cm1e_drive_write(&drive);
    TEST_ASSERT_EQUAL_INT32(510, fake_output(&bus, 0x607A, 0));
    cycle();
    /* A switch: the old target is held, velocity 0, until the new mode is shown. */
    bus.mode_delay = 5;
    bus.mode_wait = 5;
    drive.command.mode = CM1E_MODE_CSV;
    drive.command.target_position = 99999;
    unsigned waited = 0;
    while (!drive.feedback.enabled || drive.feedback.mode != CM1E_MODE_CSV) {
        TEST_ASSERT_LESS_THAN_UINT(20, waited++);
        cm1e_drive_write(&drive);
        TEST_ASSERT_EQUAL_INT32(510, fake_output(&bus, 0x607A, 0));
        TEST_ASSERT_EQUAL_INT32(0, fake_output(&bus, 0x60FF, 1));
        TEST_ASSERT_EQUAL_HEX16(0x000F, fake_output(&bus, 0x6040, 0));
        cycle();
    }
    TEST_ASSERT_GREATER_THAN_UINT(4, waited);
    cm1e_drive_write(&drive);
    TEST_ASSERT_EQUAL_INT32(77, fake_output(&bus, 0x60FF, 0));
    TEST_ASSERT_EQUAL_INT(CM1E_OK, drive.fault.error);
}

static void test_disable_takes_torque_at_once_and_follows_the_shaft(void)
{
    start(CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5, 500);
    enable_with_turning_shaft(CM1E_MODE_CSP, 0);
    drive.command.enable = false;
    cm1e_drive_write(&drive);
    TEST_ASSERT_EQUAL_HEX16(0x0006, fake_output(&bus, 0x6040, 0));
    TEST_ASSERT_FALSE(drive.feedback.enabled);
    cycle();
    bus.position = -1234;
    cycle();
    cm1e_drive_write(&drive);
    TEST_ASSERT_EQUAL_INT32(-1234, fake_output(&bus, 0x607A, 0));
    TEST_ASSERT_EQUAL_INT(CM1E_OK, drive.fault.error);
}

static void test_enable_dropped_for_one_cycle_is_no_fault_and_does_not_jump(void)
{
    start(CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5, 500);
    enable_with_turning_shaft(CM1E_MODE_CSP, 0);
    drive.command.enable = false;
    cm1e_drive_write(&drive);
    drive.command.enable = true;
    for (int i = 0; i < 60; i++) {
        cycle();
        cm1e_drive_write(&drive);
        drive.command.target_position = drive.feedback.position;
    }
    TEST_ASSERT_TRUE(drive.feedback.enabled);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, drive.fault.error);
    TEST_ASSERT_EQUAL_INT64(0, bus.torque_step);
}

static void test_drive_found_enabled_at_start_is_disabled_first(void)
{
    start(CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5, 500);
    bus.state = OPERATION_ENABLED;
    drive.command.enable = true;
    drive.command.target_position = 4000;
    cycle();
    cm1e_drive_write(&drive);
    TEST_ASSERT_EQUAL_HEX16(0x0006, fake_output(&bus, 0x6040, 0));
    TEST_ASSERT_FALSE(drive.feedback.enabled);
}

static void test_no_step_towards_torque_before_inputs_or_without_fresh_ones(void)
{
    start(CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5, 500);
    drive.command.enable = true;
    for (int i = 0; i < 10; i++) {
        cm1e_drive_read(&drive, false, i * cycle_ns);
        cm1e_drive_write(&drive);
        TEST_ASSERT_EQUAL_HEX16(0x0006, fake_output(&bus, 0x6040, 0));
    }
    cm1e_drive_read(&drive, true, 11 * cycle_ns);
    cm1e_drive_write(&drive);
    TEST_ASSERT_EQUAL_HEX16(0x0007, fake_output(&bus, 0x6040, 0));
    cm1e_drive_read(&drive, false, 12 * cycle_ns);
    cm1e_drive_write(&drive);
    TEST_ASSERT_EQUAL_HEX16(0x0006, fake_output(&bus, 0x6040, 0));
}

static void test_lost_frames_while_enabled_keep_the_targets(void)
{
    start(CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5, 500);
    enable_with_turning_shaft(CM1E_MODE_CSP, 0);
    drive.command.target_position = 520;
    cm1e_drive_read(&drive, false, bus.clock.virtual_now_ns + cycle_ns);
    cm1e_drive_write(&drive);
    TEST_ASSERT_TRUE(drive.feedback.enabled);
    TEST_ASSERT_FALSE(drive.feedback.online);
    TEST_ASSERT_EQUAL_HEX16(0x000F, fake_output(&bus, 0x6040, 0));
    TEST_ASSERT_EQUAL_INT32(500, fake_output(&bus, 0x607A, 0)); /* nobody knows which target the drive has */
    cm1e_drive_read(&drive, true, bus.clock.virtual_now_ns + 2 * cycle_ns);
    cm1e_drive_write(&drive);
    TEST_ASSERT_EQUAL_INT32(520, fake_output(&bus, 0x607A, 0));
}

static void test_profile_position_announces_each_set_point_once(void)
{
    start(CM1E_MAPPING_PROFILE, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5, 500);
    enable_with_turning_shaft(CM1E_MODE_PP, 0);
    drive.command.target_position = 500; /* where it stands: nothing to announce */
    drive.command.homing_start = false;
    cm1e_drive_write(&drive);
    TEST_ASSERT_EQUAL_HEX16(0x000F, fake_output(&bus, 0x6040, 0));
    unsigned edges = 0;
    uint16_t before = 0x000F;
    for (int i = 0; i < 60; i++) {
        if (i == 5 || i == 30)
            drive.command.target_position += 1000;
        cycle();
        cm1e_drive_write(&drive);
        const uint16_t word = (uint16_t)fake_output(&bus, 0x6040, 0);
        edges += (word & 0x10) && !(before & 0x10);
        before = word;
        bus.mode_status = word & 0x10 ? STATUSWORD_SET_POINT_ACKNOWLEDGE : 0;
    }
    TEST_ASSERT_EQUAL_UINT(2, edges);
    TEST_ASSERT_EQUAL_HEX16(0x000F, before);
}

/* Also when frames return: nobody knows which velocity the drive had meanwhile. */
static void test_after_lost_frames_the_velocity_changes_in_steps(void)
{
    start(CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5, 500);
    enable_with_turning_shaft(CM1E_MODE_CSV, 0);
    drive.command.target_velocity = 0;
    drive.command.velocity_step = 100;
    for (int i = 0; i < 12; i++) {
        fake_bus_cycle(&bus, cycle_ns);
        cm1e_drive_read(&drive, i != 1 && i != 2, bus.clock.virtual_now_ns);
        cm1e_drive_write(&drive);
        const int expected = i == 0 ? 0 : i < 10 ? 100 * i : i == 10 ? 1000 : 5000; /* in step again: no bound */
        TEST_ASSERT_EQUAL_INT32(expected, fake_output(&bus, 0x60FF, 0));
        drive.command.target_velocity = i < 10 ? 1000 : 5000;
    }
}

/* Else the edge would come by itself with the next torque. */
static void test_a_set_point_without_an_answer_is_forgotten_with_the_torque(void)
{
    start(CM1E_MAPPING_PROFILE, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5, 500);
    enable_with_turning_shaft(CM1E_MODE_PP, 0);
    bus.blocked = true;
    drive.command.target_position = 1500;
    cm1e_drive_write(&drive);
    TEST_ASSERT_EQUAL_HEX16(0x001F, fake_output(&bus, 0x6040, 0));
    for (int i = 0; i < 100; i++) {
        drive.command.enable = i >= 50;
        cycle();
        drive.command.target_position = drive.feedback.position;
        cm1e_drive_write(&drive);
        TEST_ASSERT_EQUAL_HEX16(0, fake_output(&bus, 0x6040, 0) & 0x0010);
    }
    TEST_ASSERT_TRUE(drive.feedback.enabled);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_enable_in_every_mode_mapping_and_order_never_moves);
    RUN_TEST(test_enable_goes_one_command_a_cycle);
    RUN_TEST(test_targets_pass_only_while_enabled_in_the_commanded_mode);
    RUN_TEST(test_disable_takes_torque_at_once_and_follows_the_shaft);
    RUN_TEST(test_enable_dropped_for_one_cycle_is_no_fault_and_does_not_jump);
    RUN_TEST(test_drive_found_enabled_at_start_is_disabled_first);
    RUN_TEST(test_no_step_towards_torque_before_inputs_or_without_fresh_ones);
    RUN_TEST(test_lost_frames_while_enabled_keep_the_targets);
    RUN_TEST(test_profile_position_announces_each_set_point_once);
    RUN_TEST(test_after_lost_frames_the_velocity_changes_in_steps);
    RUN_TEST(test_a_set_point_without_an_answer_is_forgotten_with_the_torque);
    return UNITY_END();
}
