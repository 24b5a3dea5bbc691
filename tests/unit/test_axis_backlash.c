/* The gap between motor and load: taken up at reversals by a ramp, unseen in the positions of the axis. */
#include <math.h>
#include <stdlib.h>

#include "../support/axis_bench.h"
#include "../support/xorshift.h"

enum { GAP = 600 }; /* counts */

static uint64_t seed;

static uint64_t draw(uint64_t below)
{
    return (xorshift(&seed) >> 11) % below;
}

static double uniform(double low, double high) { return low + (high - low) * (double)draw(1 << 30) / (1 << 30); }

/* ---- the gap itself ---------------------------------------------------------------------------------------------- */

static int32_t gap_low, gap_high; /* where the motor touches the load's flanks, counts; the load is at gap_low + GAP */
static bool inverted;

static void gap_begin(void)
{
    gap_high = inverted ? bus.position + GAP : bus.position; /* the positive flank of the axis is closed */
    gap_low = gap_high - GAP;
}

/* The motor takes the load along. */
static void gap_follow(void)
{
    if (bus.position > gap_high)
        gap_high = bus.position;
    else if (bus.position < gap_low)
        gap_high = bus.position + GAP;
    gap_low = gap_high - GAP;
}

static double load_units(void) { return (inverted ? gap_low : gap_high) / axis->position.scale; }

static void cycles(int n)
{
    while (n-- > 0) {
        bench_inputs();
        gap_follow();
        bench_outputs();
    }
}

static void begin_with(cm1e_mapping_t mapping, bool invert)
{
    fake_bus_init(&bus, mapping, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    bus.config.axes[0].invert = inverted = invert;
    bus.config.axes[0].backlash = GAP / 50000.0;
    bench_create();
    gap_begin();
}

void setUp(void)
{
    const char *given = getenv("CM1E_TEST_SEED");
    seed = given ? strtoull(given, NULL, 0) : 0x5EED0003;
    begin_with(CM1E_MAPPING_DYNAMIC, false);
}
void tearDown(void)
{
    if (Unity.CurrentTestFailed)
        printf("CM1E_TEST_SEED=0x%llx\n", (unsigned long long)seed);
    bench_end();
}

static void move_to(double position)
{
    const cm1e_command_id_t id = bench_move_to(position, 10);
    while (bench_state_of(id) == CM1E_COMMAND_ACTIVE)
        cycles(1);
    cycles(60);
}

/* Of position and acceleration of the motor; counts a cycle, rounding to whole counts included. */
static void expect_smooth(void)
{
    const double most = 2500000.0 * axis->cycle_s, ramp = 2.5e6, cycle_s = axis->cycle_s;
    const double change = (axis->limits.emergency.deceleration * fabs(axis->position.scale) + ramp) * cycle_s * cycle_s;
    TEST_ASSERT_TRUE(worst_step <= (int64_t)most + 1);
    TEST_ASSERT_TRUE(worst_change <= (int64_t)change + 3);
}

/* ---- tests ------------------------------------------------------------------------------------------------------- */

static void test_load_arrives_from_both_sides(void)
{
    for (int invert = 0; invert < 2; invert++) {
        begin_with(CM1E_MAPPING_DYNAMIC, invert);
        bench_power(true);
        cycles(20);
        for (int n = 0; n < 50; n++) {
            const double position = uniform(-3, 3);
            move_to(position);
            TEST_ASSERT_DOUBLE_WITHIN(1.01 / 50000, position, load_units());
            TEST_ASSERT_DOUBLE_WITHIN(1.01 / 50000, position, bench_info().actual_position);
            TEST_ASSERT_DOUBLE_WITHIN(1.01 / 50000, 0.0, bench_info().position_lag);
        }
        expect_smooth();
    }
}

static void test_nothing_moves_without_a_reversal(void)
{
    bench_power(true);
    cycles(20);
    TEST_ASSERT_EQUAL_INT64(0, bus.torque_step);
    for (int n = 1; n < 5; n++) {
        move_to(n);
        TEST_ASSERT_EQUAL_DOUBLE(0.0, axis->backlash.offset);
        TEST_ASSERT_EQUAL_INT32(50000 * n, bus.position);
    }
    move_to(3.5);
    TEST_ASSERT_EQUAL_INT32(175000 - GAP, bus.position);
    move_to(2);
    TEST_ASSERT_EQUAL_INT32(100000 - GAP, bus.position);
    cycles(100);
    TEST_ASSERT_EQUAL_INT32(100000 - GAP, bus.position);
}

/* Commands that turn round at any moment, up to the peak speed: the sum keeps the motor's maximum and never jumps. */
static void test_reversals_at_any_time_keep_the_motors_limits(void)
{
    for (int run = 0; run < 200; run++) {
        begin_with(CM1E_MAPPING_DYNAMIC, run & 1);
        bus.config.axes[0].backlash_velocity = run % 3 ? 0.0 : uniform(0.01, 1.0);
        bench_create();
        bench_power(true);
        cycles(20);
        bench_forget_steps();
        const unsigned pace = 1u << draw(9);
        for (int n = 0; n < 3000; n++) {
            if (draw(pace) == 0) {
                cm1e_command_id_t id;
                const double most = axis->limits.maximum.velocity;
                const cm1e_axis_command_t command = {
                    .kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = uniform(0.001, 1) * (draw(3) ? most : 0.1),
                    .direction = draw(2) ? mcPositiveDirection : mcNegativeDirection};
                TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_start(axis, &command, &id));
            }
            if (draw(4 * pace) == 0) { /* on top of it, or slower: refused or not, the sum is bounded */
                cm1e_command_id_t id;
                const cm1e_axis_command_t command = {.kind = CM1E_COMMAND_MOVE_SUPERIMPOSED, .position = uniform(-5, 5),
                                                     .velocity = uniform(0.1, 50)};
                (void)cm1e_axis_start(axis, &command, &id);
                (void)cm1e_axis_set_override(axis, uniform(0, 1), uniform(0.1, 1), uniform(0.1, 1));
            }
            cycles(1);
            TEST_ASSERT_TRUE(axis->backlash.offset <= 1e-6 && axis->backlash.offset >= -GAP - 1e-6);
            TEST_ASSERT_TRUE(fabs(axis->setpoint.velocity * axis->position.scale) +
                             fabs(axis->backlash.offset_velocity) <= 2500000.0 * (1 + 1e-9));
        }
        expect_smooth();
        TEST_ASSERT_NOT_EQUAL_INT(CM1E_AXIS_ERROR_STOP, bench_info().state);
    }
}

/* Turned by hand, the load is shown, not the motor; and enabling in the middle of the gap moves nothing. */
static void test_without_torque_the_load_is_shown(void)
{
    for (int run = 0; run < 40; run++) {
        begin_with(CM1E_MAPPING_DYNAMIC, run & 1);
        for (int n = 0; n < 60; n++) {
            bus.position += (int32_t)draw(801) - 400;
            gap_follow();
            bench_cycles(1);
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, load_units(), bench_info().actual_position);
            TEST_ASSERT_EQUAL_DOUBLE(bench_info().actual_position, bench_info().set_position);
        }
        bus.torque_step = 0;
        bench_power(true);
        cycles(200);
        TEST_ASSERT_EQUAL_INT64(0, bus.torque_step);
        const double position = bench_info().actual_position + (draw(2) ? 1 : -1);
        move_to(position);
        TEST_ASSERT_DOUBLE_WITHIN(1.01 / 50000, position, load_units());
    }
}

/* The compensation is braked before the torque goes, at whatever moment that is. */
static void test_power_taken_away_or_an_error_in_the_middle_of_it(void)
{
    for (int after = 0; after < 45; after++)
        for (int error = 0; error < 2; error++) {
            begin_with(CM1E_MAPPING_DYNAMIC, after & 1);
            bench_power(true);
            cycles(20);
            bench_move_to(-1, 0.5);
            cycles(after);
            if (error)
                cm1e_axis_fail(axis, CM1E_ERROR_AXIS_POSITION_RANGE, 0, 0);
            else
                bench_power(false);
            int32_t before = bus.position;
            for (int n = 0; !axis_free(axis); n++) {
                TEST_ASSERT_TRUE(n < 500);
                before = bus.position;
                cycles(1);
            }
            TEST_ASSERT_INT32_WITHIN(3, before, bus.position); /* it stood */
            TEST_ASSERT_EQUAL_DOUBLE(0.0, axis->backlash.offset_velocity);
            expect_smooth();
            cycles(5); /* a crossing that ended on its way has not moved the load */
            TEST_ASSERT_DOUBLE_WITHIN(1.01 / 50000, load_units(), bench_info().actual_position);
        }
}

/* Goes on until the motor crosses the gap at full velocity, with the set-point at rest or not. */
static void cross(bool at_rest)
{
    begin_with(CM1E_MAPPING_DYNAMIC, false);
    bus.config.axes[0].backlash_velocity = 0.1; /* slow, so that the set-point rests long before the end */
    bench_create();
    bench_power(true);
    cycles(20);
    const cm1e_command_id_t id = at_rest ? bench_move_to(-0.0001, 10) : bench_move_to(-1, 0.5);
    for (int n = 0; n < 25 || (at_rest && bench_state_of(id) == CM1E_COMMAND_ACTIVE); n++)
        cycles(1);
    TEST_ASSERT_EQUAL_DOUBLE(-axis->backlash.velocity, axis->backlash.offset_velocity);
}

/* The motor has stopped at its last target meanwhile: the crossing begins anew, as motions do. */
static void test_silence_in_the_middle_of_it_begins_it_anew(void)
{
    for (int silent = CM1E_AXIS_RIDDEN_OUT_CYCLES + 1; silent < 20; silent++)
        for (int at_rest = 0; at_rest < 2; at_rest++) {
            cross(at_rest);
            received = CM1E_ERROR_BUS_LOST;
            cycles(silent);
            received = CM1E_OK;
            TEST_ASSERT_EQUAL_DOUBLE(-axis->backlash.velocity, axis->backlash.offset_velocity);
            cycles(1);
            TEST_ASSERT_TRUE(fabs(axis->backlash.offset_velocity) <=
                             axis->backlash.acceleration * axis->cycle_s * (1.0 + 1e-9));
            cycles(2000);
            TEST_ASSERT_EQUAL_DOUBLE(-GAP, axis->backlash.offset);
            TEST_ASSERT_DOUBLE_WITHIN(1.01 / 50000, load_units(), bench_info().actual_position);
        }
}

/* A drive stops at the same place whether it still receives frames or not, and keeps its torque until it has. */
static void test_bus_that_is_lost_in_the_middle_of_it_ends_it(void)
{
    for (int after_error = -1; after_error < 3; after_error++) {
        cross(after_error >= 0);
        if (after_error >= 0) { /* the set-point rests, and the crossing brakes */
            cm1e_axis_fail(axis, CM1E_ERROR_AXIS_POSITION_RANGE, 0, 0);
            cycles(after_error);
        }
        const double offset = axis->backlash.offset;
        TEST_ASSERT_TRUE(axis->backlash.offset_velocity < 0.0);
        received = health = CM1E_ERROR_BUS_LOST;
        cycles(19);
        TEST_ASSERT_TRUE(axis->drive.command.enable);
        cycles(200);
        TEST_ASSERT_FALSE(axis->drive.command.enable);
        TEST_ASSERT_EQUAL_DOUBLE(offset, axis->backlash.offset);
    }
}

/* A jammed motor: the set-point of the load falls back to where the load is, the offset goes no farther. */
static void test_motor_that_does_not_follow_the_compensation(void)
{
    bus.config.axes[0].max_position_lag = 300.0 / 50000;
    bench_create();
    bench_power(true);
    cycles(20);
    bus.blocked = true;
    bench_move_to(-1, 1);
    cycles(200);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_ERROR_STOP, bench_info().state);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_LAG, bench_info().error);
    TEST_ASSERT_TRUE(axis_free(axis));
}

/* In CSV the velocity of the compensation is in the target, and the motor's maximum holds. */
static void test_velocity_mode_has_the_compensation_in_its_target(void)
{
    begin_with(CM1E_MAPPING_CSV, false);
    bench_power(true);
    cycles(20);
    bench_start_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 0.2,
                                               .direction = mcNegativeDirection});
    int64_t travelled = 0, worst = 0;
    int32_t before = 0;
    for (int n = 0; n < 200; n++) {
        cycles(1);
        const int32_t target = bus.target_velocity_raw;
        const int32_t change = target > before ? target - before : before - target;
        worst = change > worst ? change : worst;
        before = target;
        travelled += target;
        bus.position = (int32_t)(travelled / 1000);
    }
    /* 0.2 u/s for 0.2 s less the start, and the gap */
    TEST_ASSERT_INT64_WITHIN(120, -2000 - GAP, bus.position);
    TEST_ASSERT_TRUE(worst <= 5000 + 2500 + 200);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_load_arrives_from_both_sides);
    RUN_TEST(test_nothing_moves_without_a_reversal);
    RUN_TEST(test_reversals_at_any_time_keep_the_motors_limits);
    RUN_TEST(test_without_torque_the_load_is_shown);
    RUN_TEST(test_power_taken_away_or_an_error_in_the_middle_of_it);
    RUN_TEST(test_silence_in_the_middle_of_it_begins_it_anew);
    RUN_TEST(test_bus_that_is_lost_in_the_middle_of_it_ends_it);
    RUN_TEST(test_motor_that_does_not_follow_the_compensation);
    RUN_TEST(test_velocity_mode_has_the_compensation_in_its_target);
    return UNITY_END();
}
