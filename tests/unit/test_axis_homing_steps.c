/* Homing in steps (Part 5): the limits of a step, its refusals, the order of steps and the end of a homing. */
#include <math.h>

#include "../support/homing_bench.h"
#include "homing/homing_private.h"

/* ---- limits of a step -------------------------------------------------------------------------------------------- */

static void expect_limit(cm1e_error_t error, double velocity)
{
    begin_at(-20000);
    const cm1e_command_id_t id = start(velocity, 0.0);
    bench_wait(id, 30000);
    expect(id, CM1E_COMMAND_ERROR, error);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_HOMING, bench_info().state);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, bench_info().error);
    TEST_ASSERT_FALSE(bench_info().homed);
    expect_smooth(velocity);
    expect_standing();
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, bus.position / 50000.0, bench_info().actual_position); /* nothing was set */
}

static void test_limits_of_time_distance_and_torque(void)
{
    switch_there = limits_there = stops_there = false;
    step = (cm1e_homing_step_t){.mode = mcRisingEdge, .time_limit_ns = 300 * MS_IN_NS};
    expect_limit(CM1E_ERROR_AXIS_STEP_TIME, 0.5);
    TEST_ASSERT_INT32_WITHIN(1500, -20000 + 7500, bus.position);

    step = (cm1e_homing_step_t){.mode = mcRisingEdge, .distance_limit = 0.3};
    expect_limit(CM1E_ERROR_AXIS_STEP_DISTANCE, 0.5);
    TEST_ASSERT_INT32_WITHIN(1000, -20000 + 15000, bus.position);

    step = (cm1e_homing_step_t){.mode = mcRisingEdge}; /* none given: the configured timeout */
    bus.config.axes[0].homing.timeout_s = 2.0;
    expect_limit(CM1E_ERROR_AXIS_STEP_TIME, 0.5);
    TEST_ASSERT_INT32_WITHIN(1500, -20000 + 50000, bus.position);

    bus.config.axes[0].homing.timeout_s = 10.0;
    stops_there = true; /* it runs into a stop, and does not go on pushing */
    step = (cm1e_homing_step_t){.mode = mcRisingEdge, .torque_limit = 25.0};
    expect_limit(CM1E_ERROR_AXIS_STEP_TORQUE, 0.5);
    TEST_ASSERT_INT32_WITHIN(50, STOP, bus.position);

    step = block(1, 90.0);
    step.time_limit_ns = 300 * MS_IN_NS;
    expect_limit(CM1E_ERROR_AXIS_STEP_TIME, 0.5);
    step = block(1, 90.0);
    step.distance_limit = 0.5;
    expect_limit(CM1E_ERROR_AXIS_STEP_DISTANCE, 0.5);
}

static void test_distance_counts_both_ways_together(void)
{
    switch_there = false;
    step = (cm1e_homing_step_t){.mode = mcRisingEdge, .distance_limit = 1.0};
    begin_at(20000); /* 0.4 u to the limit switch, and 0.6 u back */
    const cm1e_command_id_t id = start(0.5, 0.0);
    bench_wait(id, 30000);
    expect(id, CM1E_COMMAND_ERROR, CM1E_ERROR_AXIS_STEP_DISTANCE);
    TEST_ASSERT_INT32_WITHIN(3000, 40000 - 30000, bus.position);
}

static void test_wrong_inputs_are_refused_and_change_nothing(void)
{
    begin_at(0);
    const struct {
        cm1e_homing_step_t step;
        double velocity, position;
        cm1e_error_t error;
        const char *named; /**< in the text */
    } wrong[] = {
        {{.mode = (MC_SWITCH_MODE)6}, 1.0, 0.0, CM1E_ERROR_AXIS_STEP_INPUT, ": SwitchMode is 6; 0 ... 5"},
        {{.kind = CM1E_STEP_LIMIT_SWITCH, .mode = mcEdgeSwitchPositive}, 1.0, 0.0,
         CM1E_ERROR_AXIS_STEP_INPUT, "LimitSwitchMode is 4; 0 ... 3"},
        {{.direction = mcShortestWay}, 1.0, 0.0, CM1E_ERROR_AXIS_DIRECTION, "Direction is 2; 1, 3, 5 or 7"},
        {{.direction = (MC_HOME_DIRECTION)8}, 1.0, 0.0, CM1E_ERROR_AXIS_DIRECTION, "Direction is 8"},
        {{.kind = CM1E_STEP_BLOCK, .direction = mcSwitchPositive}, 1.0, 0.0,
         CM1E_ERROR_AXIS_DIRECTION, "Direction is 5; 1 or 3"},
        {{.kind = CM1E_STEP_LIMIT_SWITCH, .direction = mcSwitchNegative}, 1.0, 0.0,
         CM1E_ERROR_AXIS_DIRECTION, "Direction is 7; 1 or 3"},
        {{.input = 5}, 1.0, 0.0, CM1E_ERROR_AXIS_STEP_INPUT, "InputNumber is 5"},
        {{.input = -1}, 1.0, 0.0, CM1E_ERROR_AXIS_STEP_INPUT, "InputNumber is -1"},
        {{.torque_limit = -1.0}, 1.0, 0.0, CM1E_ERROR_AXIS_STEP_INPUT, "TorqueLimit is -1"},
        {{.torque_limit = NAN}, 1.0, 0.0, CM1E_ERROR_AXIS_STEP_INPUT, "TorqueLimit is nan"},
        {{.distance_limit = -1.0}, 1.0, 0.0, CM1E_ERROR_AXIS_STEP_INPUT, "DistanceLimit is -1"},
        {{.distance_limit = INFINITY}, 1.0, 0.0, CM1E_ERROR_AXIS_STEP_INPUT, "DistanceLimit is inf"},
        {{.time_limit_ns = -1}, 1.0, 0.0, CM1E_ERROR_AXIS_STEP_INPUT, "TimeLimit in ms is -1e-06"},
        {{.kind = CM1E_STEP_BLOCK, .detection_velocity = -1.0}, 1.0, 0.0,
         CM1E_ERROR_AXIS_STEP_INPUT, "DetectionVelocityLimit is -1"},
        {{.kind = CM1E_STEP_BLOCK, .detection_ns = -1}, 1.0, 0.0,
         CM1E_ERROR_AXIS_STEP_INPUT, "DetectionVelocityTime in ms is"},
        {{0}, 0.0, 0.0, CM1E_ERROR_AXIS_VELOCITY_RANGE, NULL},
        {{0}, -1.0, 0.0, CM1E_ERROR_AXIS_VELOCITY_RANGE, NULL},
        {{0}, 1000.0, 0.0, CM1E_ERROR_AXIS_VELOCITY_RANGE, NULL},
        {{0}, NAN, 0.0, CM1E_ERROR_AXIS_VELOCITY_RANGE, NULL},
        {{0}, 1.0, INFINITY, CM1E_ERROR_AXIS_POSITION_RANGE, NULL},
        {{0}, 1.0, 1e300, CM1E_ERROR_AXIS_POSITION_RANGE, NULL},
        {{.kind = CM1E_STEP_DIRECT}, 0.0, NAN, CM1E_ERROR_AXIS_POSITION_RANGE, NULL},
        {{.kind = CM1E_STEP_DIRECT}, 0.0, -INFINITY, CM1E_ERROR_AXIS_POSITION_RANGE, NULL},
        {{.kind = CM1E_STEP_FINISH}, 1.0, NAN, CM1E_ERROR_AXIS_POSITION_RANGE, NULL},
        {{.kind = CM1E_STEP_FINISH}, 1.0, 0.1, CM1E_ERROR_AXIS_STATE, NULL}, /* there is no homing to finish */
        {{.kind = (cm1e_homing_step_kind_t)5}, 1.0, 0.0, CM1E_ERROR_INVALID_ARGUMENT, NULL},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        step = wrong[i].step;
        TEST_ASSERT_EQUAL_STRING(cm1e_strerror(wrong[i].error),
                                 cm1e_strerror(refusal(wrong[i].velocity, wrong[i].position)));
        if (wrong[i].named)
            bench_told(wrong[i].named);
    }
    const cm1e_axis_command_t none = {.kind = CM1E_COMMAND_HOMING_STEP, .velocity = 1.0};
    cm1e_command_id_t id;
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_INVALID_ARGUMENT, cm1e_axis_start(axis, &none, &id));
}

static void test_switches_that_are_not_configured_are_an_error(void)
{
    bus.config.axes[0].inputs = (cm1e_input_config_t){0};
    begin_at(0);
    step = (cm1e_homing_step_t){0};
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_STEP_SWITCH, refusal(1.0, 0.0));
    for (int sign = -1; sign <= 1; sign += 2) {
        step = (cm1e_homing_step_t){.kind = CM1E_STEP_LIMIT_SWITCH,
                                    .direction = sign > 0 ? mcPositiveDirection : mcNegativeDirection};
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_STEP_SWITCH, refusal(1.0, 0.0));
    }
}

static void test_steps_are_refused_in_every_other_state(void)
{
    static const struct {
        cm1e_axis_state_t state;
        cm1e_error_t error;
    } states[] = {
        {CM1E_AXIS_DISABLED, CM1E_ERROR_AXIS_NOT_POWERED},  {CM1E_AXIS_DISCRETE_MOTION, CM1E_ERROR_AXIS_STATE},
        {CM1E_AXIS_CONTINUOUS_MOTION, CM1E_ERROR_AXIS_STATE}, {CM1E_AXIS_STOPPING, CM1E_ERROR_AXIS_STOPPING},
        {CM1E_AXIS_ERROR_STOP, CM1E_ERROR_AXIS_ERROR_STOP},
    };
    begin_at(0);
    for (size_t i = 0; i < sizeof states / sizeof states[0]; i++)
        for (int kind = CM1E_STEP_ABSOLUTE_SWITCH; kind <= CM1E_STEP_FINISH; kind++) {
            axis->state = states[i].state;
            step = (cm1e_homing_step_t){.kind = (cm1e_homing_step_kind_t)kind};
            TEST_ASSERT_EQUAL_STRING(cm1e_strerror(states[i].error), cm1e_strerror(refusal(1.0, 0.0)));
        }
    axis->state = CM1E_AXIS_HOMING; /* the drive's own homing is under way */
    axis->setpoint.source = &cm1e_source_homing;
    step = (cm1e_homing_step_t){.kind = CM1E_STEP_DIRECT};
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_HOMING, refusal(1.0, 0.0));
}

/* ---- the end of a homing ----------------------------------------------------------------------------------------- */

static void test_finish_moves_away_and_ends_in_standstill_homed(void)
{
    begin_at(-20000);
    find_left_flank(0.0);
    TEST_ASSERT_FALSE(bench_info().homed);
    const double from = bench_info().set_position;
    step = (cm1e_homing_step_t){.kind = CM1E_STEP_FINISH};
    const cm1e_command_id_t id = start(0.5, -0.75);
    bench_wait(id, 20000);
    expect(id, CM1E_COMMAND_DONE, CM1E_OK);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
    TEST_ASSERT_TRUE(bench_info().homed);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, from - 0.75, bench_info().set_position);
    expect_called(LEFT_FLANK, 0.0, 1.0);
    bench_wait(bench_move_to(0.25, 1.0), 10000); /* and moves are taken again */
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0.25, bench_info().set_position);
}

static void test_finish_in_the_middle_of_a_search_stops_smoothly_and_is_not_homed(void)
{
    begin_at(-30000);
    find_left_flank(0.0);
    step = (cm1e_homing_step_t){.mode = mcFallingEdge};
    const cm1e_command_id_t search = start(1.0, 0.0);
    bench_cycles(40);
    step = (cm1e_homing_step_t){.kind = CM1E_STEP_FINISH};
    const cm1e_command_id_t id = start(0.0, 0.0);
    expect(search, CM1E_COMMAND_ABORTED, CM1E_OK);
    bench_wait(id, 1000);
    expect(id, CM1E_COMMAND_DONE, CM1E_OK);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
    TEST_ASSERT_FALSE(bench_info().homed); /* what the last step was to find it did not */
    expect_smooth(1.0);
    expect_standing();
}

static void test_direct_sets_the_position_without_motion_and_ends_the_homing(void)
{
    begin_at(12345);
    step = (cm1e_homing_step_t){.kind = CM1E_STEP_DIRECT};
    cm1e_command_id_t id = start(0.0, 100.0);
    bench_wait(id, 10);
    expect(id, CM1E_COMMAND_DONE, CM1E_OK);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
    TEST_ASSERT_TRUE(bench_info().homed);
    TEST_ASSERT_EQUAL_DOUBLE(100.0, bench_info().set_position);
    TEST_ASSERT_EQUAL_INT32(12345, bus.position);
    TEST_ASSERT_EQUAL_INT64(0, worst_step);

    step = (cm1e_homing_step_t){.mode = mcRisingEdge}; /* in the middle of a search it stops first */
    const cm1e_command_id_t search = start(1.0, 0.0);
    TEST_ASSERT_FALSE(bench_info().homed);
    bench_cycles(50);
    step = (cm1e_homing_step_t){.kind = CM1E_STEP_DIRECT};
    id = start(0.0, -2.0);
    expect(search, CM1E_COMMAND_ABORTED, CM1E_OK);
    bench_wait(id, 1000);
    expect(id, CM1E_COMMAND_DONE, CM1E_OK);
    TEST_ASSERT_EQUAL_DOUBLE(-2.0, bench_info().set_position);
    TEST_ASSERT_TRUE(bench_info().homed);
    expect_smooth(1.0);
}

static void test_step_over_a_running_step_takes_over_smoothly(void)
{
    begin_at(-20000);
    step = (cm1e_homing_step_t){.mode = mcRisingEdge};
    const cm1e_command_id_t first = start(1.0, 0.0);
    bench_cycles(100);
    step = (cm1e_homing_step_t){.kind = CM1E_STEP_LIMIT_SWITCH, .direction = mcNegativeDirection};
    const cm1e_command_id_t second = start(0.6, -1.0);
    expect(first, CM1E_COMMAND_ABORTED, CM1E_OK);
    bench_wait(second, 20000);
    expect(second, CM1E_COMMAND_DONE, CM1E_OK);
    expect_called(-LIMIT_SWITCH, -1.0, 0.6);
    expect_smooth(1.0);
}

static cm1e_command_id_t buffer(cm1e_homing_step_t what, double velocity, double position)
{
    cm1e_axis_command_t command = command_of(velocity, position);
    step = what;
    command.buffer_mode = mcBuffered;
    return bench_start_command(&command);
}

static void test_a_whole_homing_may_wait_in_the_buffer(void)
{
    begin_at(-30000);
    const cm1e_command_id_t move = bench_move_to(-0.5, 1.0);
    const cm1e_command_id_t ids[] = {
        buffer((cm1e_homing_step_t){.mode = mcRisingEdge}, 1.0, 5.0),
        buffer((cm1e_homing_step_t){.mode = mcFallingEdge, .direction = mcSwitchNegative}, 0.1, 0.0),
        buffer((cm1e_homing_step_t){.kind = CM1E_STEP_FINISH}, 0.5, 0.25),
    };
    cm1e_axis_command_t one_more = command_of(1.0, 0.0);
    one_more.buffer_mode = mcBuffered;
    cm1e_command_id_t id;
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_FULL, cm1e_axis_start(axis, &one_more, &id));
    const cm1e_command_id_t last = bench_start_command(&(cm1e_axis_command_t){
        .kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = 1.0, .velocity = 1.0, .buffer_mode = mcBuffered});
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_BUFFERED, bench_state_of(ids[0]));
    bench_wait(move, 20000);
    for (size_t i = 0; i < sizeof ids / sizeof ids[0]; i++) {
        bench_wait(ids[i], 20000);
        expect(ids[i], CM1E_COMMAND_DONE, CM1E_OK);
    }
    TEST_ASSERT_TRUE(bench_info().homed);
    expect_called(LEFT_FLANK, 0.0, 0.1);
    bench_wait(last, 20000);
    expect(last, CM1E_COMMAND_DONE, CM1E_OK);
    TEST_ASSERT_EQUAL_DOUBLE(1.0, bench_info().set_position);
    expect_smooth(1.0);
}

static void test_what_waits_behind_a_step_that_fails_is_aborted(void)
{
    switch_there = false;
    begin_at(0);
    step = (cm1e_homing_step_t){.mode = mcRisingEdge, .distance_limit = 0.2};
    const cm1e_command_id_t search = start(1.0, 0.0);
    const cm1e_command_id_t next = buffer((cm1e_homing_step_t){.kind = CM1E_STEP_FINISH}, 1.0, 1.0);
    bench_wait(search, 20000);
    expect(search, CM1E_COMMAND_ERROR, CM1E_ERROR_AXIS_STEP_DISTANCE);
    expect(next, CM1E_COMMAND_ABORTED, CM1E_OK);
    expect_standing();
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_HOMING, bench_info().state);
}

static void test_blending_with_a_step_is_refused_and_a_move_that_blends_behind_one_waits(void)
{
    begin_at(-20000);
    cm1e_axis_command_t command = command_of(1.0, 0.0);
    cm1e_command_id_t id;
    for (int mode = mcBlendingLow; mode <= mcBlendingHigh; mode++) {
        command.buffer_mode = (MC_BUFFER_MODE)mode;
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_BUFFER_MODE, cm1e_axis_start(axis, &command, &id));
    }
    step = (cm1e_homing_step_t){.mode = mcRisingEdge};
    const cm1e_command_id_t search = start(1.0, 0.0);
    bench_cycles(20);
    const cm1e_command_id_t move = bench_start_command(&(cm1e_axis_command_t){
        .kind = CM1E_COMMAND_MOVE_RELATIVE, .position = 1.0, .velocity = 1.0, .buffer_mode = mcBlendingHigh});
    bench_wait(search, 20000);
    expect(search, CM1E_COMMAND_DONE, CM1E_OK);
    bench_cycles(3);
    expect(move, CM1E_COMMAND_ERROR, CM1E_ERROR_AXIS_HOMING); /* a step ends in Homing: no move begins there */
    expect_smooth(1.0);
}

static void test_a_step_does_not_wait_behind_a_velocity(void)
{
    begin_at(-20000);
    step = (cm1e_homing_step_t){.mode = mcRisingEdge};
    start(1.0, 0.0);
    bench_cycles(20);
    (void)bench_start_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 1.0,
                                                     .buffer_mode = mcBuffered});
    cm1e_axis_command_t command = command_of(1.0, 0.0);
    command.buffer_mode = mcBuffered;
    cm1e_command_id_t id;
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_STATE, cm1e_axis_start(axis, &command, &id));
    bench_told("Homing: a step of a homing was refused: it cannot wait behind a motion that does not end by itself.");
}

static void test_homing_takes_no_move_between_its_steps(void)
{
    begin_at(-20000);
    find_left_flank(0.0);
    for (int kind = CM1E_COMMAND_MOVE_ABSOLUTE; kind <= CM1E_COMMAND_HOME; kind++) {
        if (kind == CM1E_COMMAND_STOP)
            continue;
        cm1e_command_id_t id;
        const cm1e_axis_command_t move = {.kind = (cm1e_command_kind_t)kind, .velocity = 1.0, .position = 1.0};
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_HOMING, cm1e_axis_start(axis, &move, &id));
    }
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_HOMING, bench_info().state);
}

/* Positions mean nothing before the reference is found: the way to it may lead out of the software limits, the move of
 * MC_FinishHoming not. */
static void test_software_limits_hold_for_the_last_move_only(void)
{
    bus.config.axes[0].software_limit_positive = 0.1;
    bus.config.axes[0].software_limit_negative = -0.35;
    begin_at(-17000); /* -0.34 u */
    step = (cm1e_homing_step_t){.kind = CM1E_STEP_LIMIT_SWITCH};
    const cm1e_command_id_t id = start(0.5, 0.0);
    bench_wait(id, 20000);
    expect(id, CM1E_COMMAND_DONE, CM1E_OK);
    expect_called(LIMIT_SWITCH, 0.0, 0.5);
    step = (cm1e_homing_step_t){.kind = CM1E_STEP_FINISH};
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, refusal(0.5, -0.5));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, refusal(0.5, 0.2));
    const cm1e_command_id_t last = start(0.5, -0.2);
    bench_wait(last, 20000);
    expect(last, CM1E_COMMAND_DONE, CM1E_OK);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_limits_of_time_distance_and_torque);
    RUN_TEST(test_distance_counts_both_ways_together);
    RUN_TEST(test_wrong_inputs_are_refused_and_change_nothing);
    RUN_TEST(test_switches_that_are_not_configured_are_an_error);
    RUN_TEST(test_steps_are_refused_in_every_other_state);
    RUN_TEST(test_finish_moves_away_and_ends_in_standstill_homed);
    RUN_TEST(test_finish_in_the_middle_of_a_search_stops_smoothly_and_is_not_homed);
    RUN_TEST(test_direct_sets_the_position_without_motion_and_ends_the_homing);
    RUN_TEST(test_step_over_a_running_step_takes_over_smoothly);
    RUN_TEST(test_a_whole_homing_may_wait_in_the_buffer);
    RUN_TEST(test_what_waits_behind_a_step_that_fails_is_aborted);
    RUN_TEST(test_blending_with_a_step_is_refused_and_a_move_that_blends_behind_one_waits);
    RUN_TEST(test_a_step_does_not_wait_behind_a_velocity);
    RUN_TEST(test_homing_takes_no_move_between_its_steps);
    RUN_TEST(test_software_limits_hold_for_the_last_move_only);
    return UNITY_END();
}
