/* Which actual positions the drive room believes, when a drive contradicts itself, and how far a target goes in a cycle. */
#include "drive/drive.h"
#include "unity.h"

#include "../support/fake_bus.h"

static const int64_t cycle_ns = 1000000;
static cm1e_bus_t bus;
static cm1e_drive_t drive;
static cm1e_diag_t diag;

/* What the device shows, in place of the fake one's shaft. */
static int32_t shown_position, shown_velocity;

static void show(cm1e_bus_t *device)
{
    device->position = shown_position;
    device->velocity_raw = shown_velocity;
}

static void cycle(void)
{
    fake_bus_cycle(&bus, cycle_ns);
    cm1e_drive_read(&drive, true, bus.clock.virtual_now_ns);
    cm1e_drive_write(&drive);
}

static void cycles(int n)
{
    while (n-- > 0)
        cycle();
}

void setUp(void)
{
    fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    shown_position = shown_velocity = 0;
    bus.world = show;
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_drive_init(&drive, &bus, 0, &diag));
    fake_bus_show(&bus);
    cycles(5);
}

void tearDown(void) {}

static void enable(void)
{
    drive.command.enable = true;
    cycles(10);
    TEST_ASSERT_TRUE(drive.feedback.enabled);
}

/** Counts that the motor can have gone at most since the last good position, so many cycles ago: the position may be
 *  2 ms old beside that. */
static int32_t farthest(int cycles_ago) { return (int32_t)(drive.range.velocity_possible * (cycles_ago + 2) / 1000); }

static void expect_position(int32_t position, bool fresh)
{
    cycle();
    TEST_ASSERT_EQUAL_INT32(position, drive.feedback.position);
    TEST_ASSERT_EQUAL_INT(fresh, drive.feedback.fresh);
}

static void test_under_torque_a_position_is_believed_up_to_what_the_motor_can_do(void)
{
    for (int sign = -1; sign <= 1; sign += 2) {
        setUp();
        enable();
        shown_position = sign * farthest(1);
        expect_position(sign * farthest(1), true);
        const int32_t before = shown_position;
        shown_position += sign * (farthest(1) + 1);
        expect_position(before, false);
        expect_position(before + sign * (farthest(1) + 1), true); /* a cycle later it can be there */
    }
}

/** Of motors with fine encoders too, after any time without an answer. */
static void test_after_hours_a_position_is_believed(void)
{
    static const int64_t hours[] = {1, 3, 6, 24, 10000};
    for (size_t i = 0; i < sizeof hours / sizeof hours[0]; i++) {
        setUp();
        enable();
        drive.range.velocity_possible = 100000000;
        shown_velocity = 5000000;
        cycle();
        bus.clock.virtual_now_ns += hours[i] * 3600 * INT64_C(1000000000);
        shown_position += 10;
        expect_position(shown_position, true);
    }
}

/** docs/SAFETY.md: an error after lost_cycles_limit of them in a row, and not sooner. */
static void test_positions_that_cannot_be_are_an_error_after_the_limit(void)
{
    const int limit = 3;
    bus.config.lost_cycles_limit = limit;
    enable();
    for (int run = 1; run <= limit; run++) {
        const int32_t before = shown_position;
        for (int n = 0; n < run; n++) {
            TEST_ASSERT_EQUAL_INT(CM1E_OK, drive.fault.error);
            shown_position = before + 10 * farthest(1);
            expect_position(before, false);
        }
        shown_position = before;
        if (run < limit)
            expect_position(before, true);
    }
    TEST_ASSERT_EQUAL_HEX16(0x1E2F, (uint16_t)(0x1E00 - drive.fault.error));
}

static void test_without_torque_a_jump_is_a_new_origin_that_needs_three_good_positions(void)
{
    drive.command.enable = false;
    shown_position = 10 * farthest(1);
    expect_position(shown_position, true);
    drive.command.enable = true;
    for (int n = 0; n < 3; n++) {
        TEST_ASSERT_EQUAL_HEX16(0x0006, fake_output(&bus, OBJ_6040_CONTROLWORD, 0));
        cycle();
    }
    cycles(10);
    TEST_ASSERT_TRUE(drive.feedback.enabled);
    TEST_ASSERT_EQUAL_INT32(shown_position, drive.feedback.position);
}

/** Turns with `told` counts a second, while the position moves with `real`. */
static void turn(int32_t told, int32_t real, int n)
{
    shown_velocity = told;
    while (n-- > 0) {
        shown_position += real / 1000;
        cycle();
    }
}

static void test_a_drive_contradicts_itself_where_position_and_velocity_go_apart(void)
{
    const int32_t fast = 500000; /* 10 rev/s */
    for (int sign = -1; sign <= 1; sign += 2) {
        setUp();
        enable();
        turn(sign * fast, sign * fast, 50);
        TEST_ASSERT_FALSE(cm1e_drive_contradicts_itself(&drive));
        turn(sign * fast, sign * fast * 6 / 10, 50); /* a jitter of up to half a cycle */
        TEST_ASSERT_FALSE(cm1e_drive_contradicts_itself(&drive));
        turn(sign * fast, 0, 2);
        TEST_ASSERT_FALSE(cm1e_drive_contradicts_itself(&drive));
        turn(sign * fast, 0, 1);
        TEST_ASSERT_TRUE(cm1e_drive_contradicts_itself(&drive));
        turn(sign * fast, sign * fast, 1); /* what goes together again takes one of them back */
        TEST_ASSERT_FALSE(cm1e_drive_contradicts_itself(&drive));
    }
}

static void test_standing_is_no_contradiction(void)
{
    enable();
    turn(0, 0, 100);
    TEST_ASSERT_FALSE(cm1e_drive_contradicts_itself(&drive));
    turn(1000, 0, 100); /* noise: below a hundredth of what is possible */
    TEST_ASSERT_FALSE(cm1e_drive_contradicts_itself(&drive));
}

/* ---- targets ----------------------------------------------------------------------------------------------------- */

static int32_t target(void) { return (int32_t)fake_output(&bus, OBJ_607A_TARGET_POSITION, 0); }

/** In CSP a target goes a step from the last one, or anywhere within a step of a motor that is seen. */
static void test_a_target_is_within_a_step_of_the_last_one_or_of_the_motor(void)
{
    for (int sign = -1; sign <= 1; sign += 2) {
        setUp();
        enable();
        drive.command.position_step = 100;
        drive.command.target_position = sign * 1000;
        for (int n = 1; n <= 3; n++) {
            cycle();
            TEST_ASSERT_EQUAL_INT32(sign * n * 100, target());
        }
        shown_position = sign * 900;
        cycle();
        TEST_ASSERT_EQUAL_INT32(sign * 1000, target());
        drive.command.target_position = sign * 1101; /* as far from the last target, farther from the motor */
        cycle();
        TEST_ASSERT_EQUAL_INT32(sign * 1100, target());
        drive.command.position_step = 0; /* no limit */
        drive.command.target_position = 0;
        cycle();
        TEST_ASSERT_EQUAL_INT32(0, target());
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_under_torque_a_position_is_believed_up_to_what_the_motor_can_do);
    RUN_TEST(test_after_hours_a_position_is_believed);
    RUN_TEST(test_positions_that_cannot_be_are_an_error_after_the_limit);
    RUN_TEST(test_without_torque_a_jump_is_a_new_origin_that_needs_three_good_positions);
    RUN_TEST(test_a_drive_contradicts_itself_where_position_and_velocity_go_apart);
    RUN_TEST(test_standing_is_no_contradiction);
    RUN_TEST(test_a_target_is_within_a_step_of_the_last_one_or_of_the_motor);
    return UNITY_END();
}
