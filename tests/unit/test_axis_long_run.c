/*
 * A velocity that goes on for months: a billion turns of the motor, in jumps of the time. The set-point is where exact
 * arithmetic says, its steps from cycle to cycle stay as even as in the first minute, and what follows is exact.
 */
#include "../support/axis_bench.h"
#include "device/device.h"

#include <math.h>

static const double counts_per_turn = CM1E_COUNTS_PER_REVOLUTION;

void setUp(void)
{
    fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    bus.config.axes[0].counts_per_unit = CM1E_COUNTS_PER_REVOLUTION;
    bench_create();
    bench_enable();
}
void tearDown(void) { bench_end(); }

/** Counts that the set-point has gone since another one. */
static long double way(position_t from)
{
    return (long double)(axis->setpoint.position.counts - from.counts) + (long double)axis->setpoint.position.fraction -
           (long double)from.fraction;
}

/** Cycles pass that nobody reckons. */
static void let_pass(int64_t cycles)
{
    axis->setpoint.profile_cycles += cycles;
    axis->setpoint.profile_next_s = axis->setpoint.profile_offset_s + (double)(axis->setpoint.profile_cycles + 1) *
                                    axis->cycle_s;
}

static void test_a_billion_turns_lose_nothing(void)
{
    static const double velocities[] = {50.0, -47.123456789, 0.7};
    const int64_t jump = 997001; /* cycles, of a millisecond */
    for (int i = 0; i < 3; i++) {
        setUp();
        const double velocity = velocities[i], turns = fabs(velocity) < 1.0 ? 1e7 : 1e9;
        const cm1e_command_id_t id = bench_move_velocity(velocity);
        bench_cycles(2000);
        TEST_ASSERT_TRUE(cm1e_axis_command_status(axis, id).reached);
        const long double step = (long double)velocity * (long double)axis->cycle_s * (long double)axis->position.scale;
        const position_t begin = axis->setpoint.position;
        int64_t cycles = 0;
        while (fabsl(way(begin)) < (long double)(turns * counts_per_turn)) {
            let_pass(jump - 1);
            cm1e_axis_motion_step(axis);
            cycles += jump;
        }
        TEST_ASSERT_TRUE(fabsl(way(begin) - step * (long double)cycles) < 1e-4L);
        for (int n = 0; n < 10000; n++) {
            const position_t before = axis->setpoint.position;
            cm1e_axis_motion_step(axis);
            TEST_ASSERT_TRUE(fabsl(way(before) - step) < 2e-6L);
            TEST_ASSERT_EQUAL_DOUBLE(velocity, axis->setpoint.velocity);
        }
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(id));
        TEST_ASSERT_TRUE(cm1e_axis_command_status(axis, id).reached);
    }
}

/** The stop, and a way back to a position by its number. */
static void test_what_follows_is_exact(void)
{
    bench_move_velocity(50.0);
    bench_cycles(2000);
    while (axis->setpoint.position.counts < INT64_C(1000000000) * CM1E_COUNTS_PER_REVOLUTION) {
        let_pass(999983);
        cm1e_axis_motion_step(axis);
    }
    const cm1e_axis_command_t halt = {.kind = CM1E_COMMAND_HALT};
    bench_start_command(&halt);
    for (int n = 0; n < 5000; n++)
        cm1e_axis_motion_step(axis);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, axis->state);
    const double target = 1000000012.25;
    bench_move_to(target, 50.0);
    for (int n = 0; n < 1000000 && axis->state != CM1E_AXIS_STANDSTILL; n++)
        cm1e_axis_motion_step(axis);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, axis->state);
    TEST_ASSERT_EQUAL_DOUBLE(target, cm1e_axis_units(axis, axis->setpoint.position));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_billion_turns_lose_nothing);
    RUN_TEST(test_what_follows_is_exact);
    return UNITY_END();
}
