/* Homing in steps (Part 5): the block. What takes over from a motor that presses neither jumps nor goes on pushing. */
#include "../support/homing_bench.h"

static void find_block(int sign, double torque, int32_t from)
{
    step = block(sign, torque);
    begin_at(from);
    const cm1e_command_id_t id = start(0.2, sign * 3.0);
    bench_wait(id, 20000);
    expect(id, CM1E_COMMAND_DONE, CM1E_OK);
    expect_called(sign * STOP, sign * 3.0, 0.0);
    expect_smooth(0.2);
    expect_standing(); /* with the set-point where the motor is: it no longer pushes */
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_HOMING, bench_info().state);
}

static void test_block_by_torque_and_by_lag_from_afar_and_from_the_stop_itself(void)
{
    limits_there = false;
    for (int sign = -1; sign <= 1; sign += 2) {
        find_block(sign, 30.0, 0);
        find_block(sign, 30.0, sign * STOP);
        find_block(sign, 0.0, 0);
        find_block(sign, 0.0, sign * STOP);
    }
}

/* The set-point stops soon after the torque limit, however low that is: the force does not grow while the time passes. */
static void test_block_presses_no_harder_than_the_torque_limit_and_the_ramp_need(void)
{
    static const struct {
        double torque;
        int64_t detection_ms;
    } limits[] = {{20.0, 500}, {5.0, 500}, {0.9, 1}};
    limits_there = false;
    for (int i = 0; i < 3; i++) {
        step = block(1, limits[i].torque);
        step.detection_ns = limits[i].detection_ms * MS_IN_NS;
        begin_at(59000);
        const cm1e_command_id_t id = start(0.2, 0.0);
        int most = 0;
        while (bench_state_of(id) == CM1E_COMMAND_ACTIVE) {
            bench_cycles(1);
            most = bus.torque > most ? bus.torque : most;
        }
        expect(id, CM1E_COMMAND_DONE, CM1E_OK);
        const int least = (int)(10.0 * limits[i].torque);
        TEST_ASSERT_GREATER_OR_EQUAL_INT(least, most);
        TEST_ASSERT_LESS_OR_EQUAL_INT(least + 150, most); /* 10 counts a cycle for the cycles that stopping takes */
    }
}

static bool gives_way;

static void soft_world(cm1e_bus_t *b)
{
    world(b);
    const bool held = !gives_way && b->target_position > 20000;
    if (held) {
        b->position = 20000;
        b->velocity_raw = 0;
        b->torque = 500;
    }
}

/* Something that gives way before the time is over is no stop. */
static void test_block_goes_on_when_the_motor_comes_free(void)
{
    limits_there = false;
    gives_way = false;
    step = block(1, 30.0);
    step.detection_ns = 200 * MS_IN_NS;
    begin_at(19000);
    bus.world = soft_world;
    const cm1e_command_id_t id = start(0.2, 0.0);
    while (bus.torque < 500)
        bench_cycles(1);
    bench_cycles(100);
    gives_way = true;
    bench_wait(id, 20000);
    gives_way = false;
    bus.world = world;
    expect(id, CM1E_COMMAND_DONE, CM1E_OK);
    expect_called(STOP, 0.0, 0.0);
}

enum { COMES_FREE, MC_STOP, DIRECTION_OFF, OTHER_STEP, TAKE_OVERS };

static void take_over(int how)
{
    if (how == COMES_FREE) {
        gives_way = true;
    } else if (how == MC_STOP) {
        cm1e_axis_hold_stop(axis, bench_start_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_STOP}), false);
    } else if (how == DIRECTION_OFF) {
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_power(axis, &owner, true, false, true));
    } else {
        step = (cm1e_homing_step_t){.mode = mcRisingEdge};
        start(0.2, 0.0);
    }
}

/* A set-point that presses has no limit of jerk. What takes over, at the axis's jerk, does not take its acceleration
 * along: to take that back would need a velocity far beyond all limits. */
static void test_what_takes_over_from_pressing_does_not_run_away(void)
{
    limits_there = false;
    bus.config.axes[0].max_jerk = 20.0;
    for (int n = 0; n < 20 * TAKE_OVERS; n++) {
        gives_way = false;
        step = block(1, 30.0);
        begin_at(18000);
        bus.world = soft_world;
        start(0.2, 0.0);
        while (bus.torque < 500)
            bench_cycles(1);
        bench_cycles(n / TAKE_OVERS);
        take_over(n % TAKE_OVERS);
        bench_cycles(500);
        TEST_ASSERT_LESS_OR_EQUAL_INT64(11, worst_step); /* 0.2 u/s */
    }
}

static void test_block_ends_at_a_limit_switch(void)
{
    step = block(1, 30.0);
    begin_at(0);
    const cm1e_command_id_t id = start(0.2, 0.0);
    bench_wait(id, 20000);
    expect(id, CM1E_COMMAND_ERROR, CM1E_ERROR_AXIS_STEP_LIMIT_SWITCH);
}

static int still_cycles;

/* Nothing is in the way of the motor. Friction catches it 30 counts short of a set-point that has come to rest, until
 * its controller has summed up enough to go there. */
static void sticky_world(cm1e_bus_t *b)
{
    static int32_t target_before_this;
    enum { SHORT = 30, CAUGHT_CYCLES = 12, PACE = 2 };
    const int32_t target = b->target_position, missing = target - before;
    still_cycles = target == target_before_this ? still_cycles + 1 : 0;
    target_before_this = target;
    if (still_cycles < CAUGHT_CYCLES)
        b->position = missing > SHORT ? target - SHORT : before;
    else
        b->position = missing > PACE ? before + PACE : target;
    world(b);
}

/* Cycles until the command has ended; the set-point never goes back. */
static void wait_for_the_motor(cm1e_command_id_t id)
{
    int32_t farthest = bus.target_position;
    for (int i = 0; i < 20000 && bench_state_of(id) == CM1E_COMMAND_ACTIVE; i++) {
        bench_cycles(1);
        TEST_ASSERT_GREATER_OR_EQUAL_INT32(farthest, bus.target_position);
        farthest = bus.target_position;
    }
    TEST_ASSERT_INT32_WITHIN(20, bus.target_position, bus.position);
    expect_smooth(0.5);
}

/* A motor that comes late is not held up: a step that gives up, and MC_Stop, wait for it instead of going back. */
static void test_free_motor_that_comes_late_is_waited_for_and_not_relieved(void)
{
    stops_there = false;
    step = block(1, 30.0);
    begin_at(0);
    bus.world = sticky_world;
    const cm1e_command_id_t id = start(0.5, 0.0);
    wait_for_the_motor(id);
    expect(id, CM1E_COMMAND_ERROR, CM1E_ERROR_AXIS_STEP_LIMIT_SWITCH);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_HOMING, bench_info().state);

    begin_at(0);
    bus.world = sticky_world;
    start(0.5, 0.0);
    bench_cycles(500);
    const cm1e_command_id_t stop = bench_start_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_STOP});
    cm1e_axis_hold_stop(axis, stop, false);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STOPPING, bench_info().state);
    wait_for_the_motor(stop);
    expect(stop, CM1E_COMMAND_DONE, CM1E_OK);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
}

/* No torque limit, and a lag so small that a free motor could have it: that the motor does not come shows the stop. */
static void test_motor_held_up_with_a_small_lag_is_relieved(void)
{
    switch_there = limits_there = false;
    step = (cm1e_homing_step_t){.mode = mcRisingEdge, .distance_limit = 0.022};
    begin_at(59000);
    const cm1e_command_id_t id = start(0.2, 0.0);
    int32_t most = 0;
    while (bench_state_of(id) == CM1E_COMMAND_ACTIVE) {
        bench_cycles(1);
        most = bus.target_position > most ? bus.target_position : most;
    }
    expect(id, CM1E_COMMAND_ERROR, CM1E_ERROR_AXIS_STEP_DISTANCE);
    TEST_ASSERT_INT32_WITHIN(100, STOP + 120, most);
    expect_standing();
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_block_by_torque_and_by_lag_from_afar_and_from_the_stop_itself);
    RUN_TEST(test_block_presses_no_harder_than_the_torque_limit_and_the_ramp_need);
    RUN_TEST(test_block_goes_on_when_the_motor_comes_free);
    RUN_TEST(test_what_takes_over_from_pressing_does_not_run_away);
    RUN_TEST(test_block_ends_at_a_limit_switch);
    RUN_TEST(test_free_motor_that_comes_late_is_waited_for_and_not_relieved);
    RUN_TEST(test_motor_held_up_with_a_small_lag_is_relieved);
    return UNITY_END();
}
