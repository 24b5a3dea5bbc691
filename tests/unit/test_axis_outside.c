/* Positions from outside: where they begin, how they are followed, and everything that a planner can do wrong. */
#include <math.h>

#include "axis/axis_outside.h"

#include "../support/axis_bench.h"

static const double cycle_s = 1e-3;

/* A planner without a limit of jerk, as many controls have one. */
static double position, velocity, acceleration;
static cm1e_command_id_t follow;
static int64_t most_step; /* counts */

void setUp(void)
{
    bench_start();
    most_step = 101; /* 2 u/s are 100 counts a cycle */
}
void tearDown(void) { bench_end(); }

static cm1e_error_t try_follow(double at)
{
    const cm1e_axis_command_t command = {.kind = CM1E_COMMAND_FOLLOW_POSITION, .position = at};
    return cm1e_axis_start(axis, &command, &follow);
}

static void feed(double at)
{
    bench_inputs();
    cm1e_axis_feed(cm1e_axis_reference(axis), follow, at);
    bench_outputs();
}

static void plan(int cycles)
{
    while (cycles-- > 0) {
        velocity += acceleration * cycle_s;
        position += velocity * cycle_s;
        feed(position);
    }
}

static void begin(void)
{
    bench_enable();
    position = cm1e_axis_place(axis, false);
    velocity = acceleration = 0.0;
    TEST_ASSERT_EQUAL_INT(CM1E_OK, try_follow(position));
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_SYNCHRONIZED_MOTION, bench_info().state);
    feed(position);
    bench_forget_steps();
}

/* 2 u/s after 100 ms. */
static void begin_in_motion(void)
{
    begin();
    acceleration = 20.0;
    plan(100);
    acceleration = 0.0;
    plan(20);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 2.0, bench_info().set_velocity);
}

/* The ramp of an error may change the step of a cycle by its deceleration. */
static void braked_softly(void)
{
    const double most = axis->limits.emergency.deceleration * fabs(axis->position.scale) * cycle_s * cycle_s;
    TEST_ASSERT_LESS_OR_EQUAL_INT64((int64_t)most + 2, worst_change);
}

static void failed_with(cm1e_error_t error, const char *words)
{
    TEST_ASSERT_EQUAL_STRING("ErrorStop", cm1e_axis_state_name(bench_info().state));
    TEST_ASSERT_EQUAL_STRING(cm1e_strerror(error), cm1e_strerror(bench_info().error));
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ERROR, bench_state_of(follow));
    TEST_ASSERT_EQUAL_INT(error, cm1e_axis_command_status(axis, follow).error);
    bench_told(words);
    for (int n = 0; n < 2000 && bench_info().set_velocity != 0.0; n++)
        bench_cycles(1);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, bench_info().set_velocity);
    bench_cycles(100);
    TEST_ASSERT_FALSE(bench_info().powered);
    TEST_ASSERT_LESS_OR_EQUAL_INT64(most_step, worst_step);
}

static void test_the_motor_goes_where_the_planner_says(void)
{
    begin_in_motion();
    TEST_ASSERT_TRUE(axis_from_outside(axis));
    for (int n = 0; n < 300; n++) {
        plan(1);
        TEST_ASSERT_DOUBLE_WITHIN(0.5 + 1e-6, position * axis->position.scale,
                                  (double)(int32_t)fake_output(&bus, OBJ_607A_TARGET_POSITION, 0));
    }
    acceleration = -20.0;
    plan(100);
    velocity = acceleration = 0.0;
    plan(10);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, bench_info().set_velocity);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, position, bench_info().set_position);
    TEST_ASSERT_LESS_OR_EQUAL_INT64(101, worst_step);
    TEST_ASSERT_LESS_OR_EQUAL_INT64(2, worst_change); /* 20 u/s2 are one count */
}

static void test_a_stop_takes_over_at_any_velocity(void)
{
    static const cm1e_command_kind_t kinds[] = {CM1E_COMMAND_HALT, CM1E_COMMAND_STOP, CM1E_COMMAND_MOVE_ABSOLUTE};
    for (unsigned i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        bench_start();
        begin_in_motion();
        const cm1e_command_id_t id =
            bench_start_command(&(cm1e_axis_command_t){.kind = kinds[i], .position = 3.0, .velocity = 1.0});
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, bench_state_of(follow));
        plan(1); /* what still comes is not used */
        bench_wait(id, 20000);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(id));
        TEST_ASSERT_LESS_OR_EQUAL_INT64(101, worst_step);
        bench_end();
    }
    bench_start();
}

static void test_it_begins_only_where_the_axis_stands(void)
{
    bench_enable();
    const double at = cm1e_axis_place(axis, false);
    static const double wrong[] = {0.5, -0.5, INFINITY, NAN, 1e30};
    for (unsigned i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_SET_POINT_JUMP, try_follow(at + wrong[i]));
        bench_told("it would jump");
        bench_cycles(5);
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
    }
    TEST_ASSERT_EQUAL_INT64(0, worst_step);
    bench_move_velocity(1.0);
    bench_cycles(50);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_STATE, try_follow(cm1e_axis_place(axis, false)));
    bench_told("ContinuousMotion: CM_FollowPosition was refused: it begins in Standstill. End the motion first, with MC_Halt.");
}

static void test_a_missing_position_stops_the_axis(void)
{
    begin_in_motion();
    bench_cycles(1);
    failed_with(CM1E_ERROR_AXIS_SET_POINT_MISSING, "for one cycle none was given");
    braked_softly();
}

static void test_a_missing_position_ends_a_rest_too(void)
{
    begin();
    bench_cycles(1);
    failed_with(CM1E_ERROR_AXIS_SET_POINT_MISSING, "at 0 u/s");
}

static void test_a_position_out_of_reach_is_not_sent(void)
{
    static const struct {
        double jump;
        const char *words;
    } cases[] = {{0.5, "a velocity of"}, {-0.5, "a velocity of"}, {0.02, "an acceleration of"}, {NAN, "not a finite"},
                 {INFINITY, "not a finite"}, {0.0, "a deceleration of"}};
    for (unsigned i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        bench_start();
        begin_in_motion();
        feed(position + cases[i].jump);
        failed_with(CM1E_ERROR_AXIS_SET_POINT_LIMIT, cases[i].words);
        bench_told("a set-point from outside commanded");
        braked_softly();
        bench_end();
    }
    bench_start();
}

static void test_it_stops_before_a_software_limit(void)
{
    bench_end();
    bench_enable_within(-1.0, 1.0);
    position = cm1e_axis_place(axis, false);
    velocity = 0.0;
    TEST_ASSERT_EQUAL_INT(CM1E_OK, try_follow(position));
    bench_forget_steps();
    acceleration = 20.0;
    plan(100);
    acceleration = 0.0;
    for (int n = 0; n < 1000 && bench_info().state == CM1E_AXIS_SYNCHRONIZED_MOTION; n++)
        plan(1);
    failed_with(CM1E_ERROR_AXIS_SET_POINT_LIMIT, "the software limit at 1 u");
    TEST_ASSERT_TRUE(bench_info().set_position <= 1.0 + 1e-9);
}

static void test_a_disabled_direction_is_kept(void)
{
    begin_in_motion();
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_power(axis, &owner, true, false, true));
    plan(1);
    failed_with(CM1E_ERROR_AXIS_SET_POINT_LIMIT, "MC_Power does not enable");
}

static void test_power_off_ends_it(void)
{
    begin_in_motion();
    bench_power(false);
    plan(1);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, bench_state_of(follow));
    bench_cycles(1000);
    TEST_ASSERT_FALSE(bench_info().powered);
    TEST_ASSERT_LESS_OR_EQUAL_INT64(101, worst_step);
}

static void test_a_drive_fault_ends_it(void)
{
    begin_in_motion();
    fake_bus_fault(&bus, 0x2310);
    plan(2);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_ERROR_STOP, bench_info().state);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ERROR, bench_state_of(follow));
}

/* No answer for so many cycles: the planner goes on, the axis does not, and then it goes the whole way. */
static void silent(int cycles)
{
    received = CM1E_ERROR_TIMEOUT;
    plan(cycles);
    received = CM1E_OK;
}

static void test_a_short_silence_delays_it(void)
{
    for (int cycles = 1; cycles <= CM1E_AXIS_RIDDEN_OUT_CYCLES; cycles++) {
        bench_start();
        begin_in_motion();
        silent(cycles);
        plan(50);
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_SYNCHRONIZED_MOTION, bench_info().state);
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, position - cycles * 2.0 * cycle_s, bench_info().set_position);
        acceleration = -20.0;
        plan(100);
        velocity = acceleration = 0.0;
        plan(10);
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, position, bench_info().set_position);
        TEST_ASSERT_EQUAL_UINT8(0, axis->outside.count);
        bench_end();
    }
    bench_start();
}

/* At nearly the maximum velocity the motor would exceed it on its way back to its place, and a planner does not slow
 * down: the axis stops then. Slower, it goes on. */
static void test_a_short_silence_near_the_maximum_velocity_stops_it(void)
{
    most_step = 2500; /* of the maximum velocity */
    for (int cycles = 1; cycles <= CM1E_AXIS_RIDDEN_OUT_CYCLES; cycles++) {
        for (int fast = 0; fast <= 1; fast++) {
            bench_start();
            begin();
            acceleration = axis->limits.system.acceleration / 4.0;
            while (velocity < axis->limits.system.velocity * (fast ? 0.999 : 0.5))
                plan(1);
            acceleration = 0.0;
            plan(100);
            silent(cycles);
            plan(2);
            if (fast)
                failed_with(CM1E_ERROR_AXIS_SET_POINT_LIMIT, "the bus paused or was silent");
            else
                TEST_ASSERT_EQUAL_INT(CM1E_AXIS_SYNCHRONIZED_MOTION, bench_info().state);
            bench_end();
        }
    }
    bench_start();
}

static void test_a_long_silence_stops_it(void)
{
    begin_in_motion();
    silent(CM1E_AXIS_RIDDEN_OUT_CYCLES + 1);
    plan(2);
    failed_with(CM1E_ERROR_AXIS_SET_POINT_LIMIT, "the bus paused or was silent");
}

static void test_more_positions_than_can_wait_are_not_lost_in_silence(void)
{
    begin();
    acceleration = 20.0; /* it begins to move while nobody answers */
    silent(OUTSIDE_WAITING + 1);
    plan(1);
    failed_with(CM1E_ERROR_AXIS_SET_POINT_LIMIT, "the bus paused or was silent");
    TEST_ASSERT_EQUAL_INT64(0, worst_step);
}

static void test_silence_does_not_matter_at_rest(void)
{
    begin();
    silent(OUTSIDE_WAITING * 2);
    plan(5);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_SYNCHRONIZED_MOTION, bench_info().state);
    cm1e_axis_after_pause(axis, 20000000);
    plan(5);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_SYNCHRONIZED_MOTION, bench_info().state);
    TEST_ASSERT_EQUAL_INT64(0, worst_step);
}

static void test_a_pause_in_motion_stops_it(void)
{
    begin_in_motion();
    cm1e_axis_after_pause(axis, 20000000);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_ERROR_STOP, bench_info().state);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_SET_POINT_LIMIT, bench_info().error);
}

static void test_positions_of_another_command_are_not_used(void)
{
    begin();
    const cm1e_command_id_t ours = follow;
    bench_inputs();
    cm1e_axis_feed(cm1e_axis_reference(axis), ours + 1, position + 100.0);
    cm1e_axis_feed(cm1e_axis_reference(axis), 0, position + 100.0);
    cm1e_axis_feed((AXIS_REF_t){0}, ours, position + 100.0);
    cm1e_axis_feed(cm1e_axis_reference(axis), ours, position);
    bench_outputs();
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_SYNCHRONIZED_MOTION, bench_info().state);
}

/* Software limits that are written meanwhile: nobody knows whether the planner keeps them. */
static void test_no_limit_is_known_to_be_kept(void)
{
    begin();
    TEST_ASSERT_TRUE(cm1e_source_outside.keeps(axis, -INFINITY, INFINITY));
    TEST_ASSERT_FALSE(cm1e_source_outside.keeps(axis, -INFINITY, 100.0));
    TEST_ASSERT_FALSE(cm1e_source_outside.keeps(axis, -100.0, INFINITY));
}

static void test_nothing_waits_behind_it(void)
{
    begin();
    const cm1e_axis_command_t move = {.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = 1.0, .velocity = 1.0,
                                      .buffer_mode = mcBuffered};
    const cm1e_axis_command_t more = {.kind = CM1E_COMMAND_MOVE_SUPERIMPOSED, .position = 1.0, .velocity = 1.0};
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_BUFFER_MODE, bench_try_command(&move));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_STATE, bench_try_command(&more));
    bench_told("MC_MoveSuperimposed was refused: it cannot be added to CM_FollowPosition. End that first, with MC_Halt.");
    plan(5);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_SYNCHRONIZED_MOTION, bench_info().state);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_motor_goes_where_the_planner_says);
    RUN_TEST(test_a_stop_takes_over_at_any_velocity);
    RUN_TEST(test_it_begins_only_where_the_axis_stands);
    RUN_TEST(test_a_missing_position_stops_the_axis);
    RUN_TEST(test_a_missing_position_ends_a_rest_too);
    RUN_TEST(test_a_position_out_of_reach_is_not_sent);
    RUN_TEST(test_it_stops_before_a_software_limit);
    RUN_TEST(test_a_disabled_direction_is_kept);
    RUN_TEST(test_power_off_ends_it);
    RUN_TEST(test_a_drive_fault_ends_it);
    RUN_TEST(test_a_short_silence_delays_it);
    RUN_TEST(test_a_short_silence_near_the_maximum_velocity_stops_it);
    RUN_TEST(test_a_long_silence_stops_it);
    RUN_TEST(test_more_positions_than_can_wait_are_not_lost_in_silence);
    RUN_TEST(test_silence_does_not_matter_at_rest);
    RUN_TEST(test_a_pause_in_motion_stops_it);
    RUN_TEST(test_positions_of_another_command_are_not_used);
    RUN_TEST(test_no_limit_is_known_to_be_kept);
    RUN_TEST(test_nothing_waits_behind_it);
    return UNITY_END();
}
