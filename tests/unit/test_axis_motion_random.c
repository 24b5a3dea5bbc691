/* Random commands, faults and switching of power: every set-point keeps the limits of the axis. */
#include <math.h>

#include "../support/axis_bench.h"
#include "../support/chance.h"

static unsigned seed;

void setUp(void) {}
void tearDown(void)
{
    if (Unity.CurrentTestFailed)
        printf("CM1E_TEST_SEED=%u\n", seed);
    bench_end();
}

static cm1e_axis_command_t random_command(void)
{
    cm1e_axis_command_t c = {.kind = (cm1e_command_kind_t)(int)uniform(0, CM1E_COMMAND_HOME)};
    c.position = uniform(-6.0, 6.0);
    c.velocity = uniform(0.1, 40.0) * (c.kind == CM1E_COMMAND_MOVE_VELOCITY && uniform(0, 1) < 0.5 ? -1 : 1);
    c.acceleration = uniform(0, 1) < 0.3 ? 0 : uniform(1.0, 100.0);
    c.deceleration = uniform(0, 1) < 0.3 ? 0 : uniform(1.0, 100.0);
    c.jerk = uniform(0, 1) < 0.3 ? 0 : uniform(50.0, 2000.0);
    c.direction = (MC_DIRECTION)(int)uniform(0, 5);
    return c;
}

static void random_run(void)
{
    bench_enable_within(-5.0, 5.0);
    cm1e_command_id_t last = 0, stop = 0;
    double velocity_before = 0.0;
    for (int cycle = 0; cycle < 20000; cycle++) {
        bench_inputs();
        if (uniform(0, 1) < 0.02) {
            const cm1e_axis_command_t command = random_command();
            cm1e_command_id_t id;
            if (cm1e_axis_start(axis, &command, &id) == CM1E_OK) {
                if (last && bench_state_of(last) == CM1E_COMMAND_ACTIVE)
                    TEST_FAIL_MESSAGE("two commands are active");
                last = id;
                stop = command.kind == CM1E_COMMAND_STOP ? id : stop;
            }
        }
        if (uniform(0, 1) < 0.02)
            cm1e_axis_hold_stop(axis, stop, false);
        if (uniform(0, 1) < 0.002)
            bench_power(false);
        if (uniform(0, 1) < 0.02)
            bench_power(true);
        if (uniform(0, 1) < 0.02)
            cm1e_axis_reset(axis);
        if (uniform(0, 1) < 0.01) {
            const bool positive = uniform(0, 1) < 0.8, negative = uniform(0, 1) < 0.8;
            cm1e_axis_power(axis, &owner, axis->power.enable, positive, negative);
        }
        bench_outputs();
        const cm1e_axis_info_t info = bench_info();
        TEST_ASSERT_TRUE(info.set_position <= 5.0 + 1e-6 && info.set_position >= -5.0 - 1e-6);
        TEST_ASSERT_TRUE(fabs(info.set_velocity) <= 50.0 + 1e-6);
        if (!axis_free(axis)) {
            TEST_ASSERT_TRUE(fabs(info.set_acceleration) <= 100.0 + 1e-6);
            TEST_ASSERT_TRUE(fabs(info.set_velocity - velocity_before) <= 100.0 * 1e-3 + 1e-6);
        }
        velocity_before = info.set_velocity;
        if (info.error != CM1E_OK)
            TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, info.error);
        TEST_ASSERT_EQUAL_INT(info.state == CM1E_AXIS_ERROR_STOP, info.error != CM1E_OK);
        if (info.state == CM1E_AXIS_STANDSTILL)
            TEST_ASSERT_EQUAL_DOUBLE(0.0, info.set_velocity);
    }
    TEST_ASSERT_LESS_OR_EQUAL_INT64(2501, worst_step);
    TEST_ASSERT_LESS_OR_EQUAL_INT64(7, worst_change);
}

static void test_random_commands_keep_every_limit(void)
{
    for (int n = 0; n < seeds_of(30); n++) {
        chance_seed(seed = seed_of(n));
        bench_start();
        random_run();
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_random_commands_keep_every_limit);
    return UNITY_END();
}
