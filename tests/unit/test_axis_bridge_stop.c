/* A homing behind a bridge that is to stop, by a motor that takes no notice of bit 4 (the guide does not promise it). */
#include "../support/fake_bridge.h"
#include "cia402/cia402.h"

#include "../support/axis_bench.h"
#include "homing/homing_private.h"

/* Once bit 4 has come, the motor does not hear that it goes, nor of the words that keep the torque on. */
static bool started;

static void deaf_to_bit_4(cm1e_bus_t *b)
{
    uint8_t *word = b->outputs + fake_bridge.axis * FAKE_BRIDGE_AXIS_BYTES;
    const unsigned controlword = cm1e_get_u16(word);
    started = (started || (controlword & CONTROLWORD_HOMING_START)) && (controlword & 0x0F) == 0x0F;
    if (started)
        cm1e_put_u16(word, (uint16_t)(controlword | CONTROLWORD_HOMING_START));
    fake_bridge_cycle(b);
}

static cm1e_command_id_t home(void)
{
    static const cm1e_homing_config_t homing = {.method = 3, .velocity = 2.0, .acceleration = 20.0};
    return bench_start_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_HOME, .homing = &homing});
}

static cm1e_command_id_t running;

void setUp(void)
{
    started = false;
    fake_bridge_open(&bus, CM1E_DEVICE_EB12, 2);
    bus.device_cycle = deaf_to_bit_4;
    bench_create();
    bench_power(true);
    bench_cycles(300);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
    running = home();
    bench_cycles(600);
    TEST_ASSERT_EQUAL_INT(HOME_RUN, axis->homing->drive.step);
}
void tearDown(void)
{
    bench_end();
    fake_bridge_close();
}

/* 2 u/s and 20 u/s2: 100 ms of braking, and 150 more. */
static void free_in_time(void)
{
    bench_cycles(235);
    TEST_ASSERT_FALSE(fake_bridge_axis()->motor_free);
    bench_cycles(30);
    TEST_ASSERT_TRUE(fake_bridge_axis()->motor_free);
}

static void test_mc_stop_ends_in_error_stop_without_torque(void)
{
    const cm1e_command_id_t stop = bench_start_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_STOP});
    free_in_time();
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, bench_state_of(running));
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ERROR, bench_state_of(stop));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_HOMING_FAILED, cm1e_axis_command_status(axis, stop).error);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_ERROR_STOP, bench_info().state);
    bench_told("its torque was taken away");
    TEST_ASSERT_FALSE(bench_info().homed);
}

static void test_power_off_and_shut_down_end_without_torque_and_without_an_error(void)
{
    bench_power(false);
    free_in_time();
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_DISABLED, bench_info().state);
    tearDown();
    setUp();
    for (int i = 0; i < 300; i++) {
        bench_inputs();
        (void)cm1e_axis_shut_down(axis);
        bench_outputs();
    }
    TEST_ASSERT_TRUE(cm1e_axis_shut_down(axis));
    TEST_ASSERT_TRUE(fake_bridge_axis()->motor_free);
}

static void test_a_direction_that_is_taken_away_ends_in_error_stop_without_torque(void)
{
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_power(axis, &owner, true, false, true));
    free_in_time();
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_ERROR_STOP, bench_info().state);
}

/* Standing, while bit 10 says "during homing", is no end: the search may go on at any moment. */
static void test_a_search_that_stands_for_a_moment_is_not_over(void)
{
    fake_bridge.statusword = 0x0207; /* the motor waits, as at a turn */
    fake_bridge_axis()->search.speed = 0.0;
    bench_cycles(400);
    const cm1e_command_id_t stop = bench_start_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_STOP});
    bench_cycles(150);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(stop));
    bench_cycles(150);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ERROR, bench_state_of(stop));
    TEST_ASSERT_TRUE(fake_bridge_axis()->motor_free);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_mc_stop_ends_in_error_stop_without_torque);
    RUN_TEST(test_power_off_and_shut_down_end_without_torque_and_without_an_error);
    RUN_TEST(test_a_direction_that_is_taken_away_ends_in_error_stop_without_torque);
    RUN_TEST(test_a_search_that_stands_for_a_moment_is_not_over);
    return UNITY_END();
}
