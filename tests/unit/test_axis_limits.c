/* Software limits, and directions that MC_Power enables: what is refused, and how a motion is braked before them. */
#include <math.h>

#include "axis/axis_pause.h" /* first, as the bench has a global `axis` */

#include "../support/axis_bench.h"
#include "axis/axis_limits.h"
#include "axis/axis_parameters.h"

void setUp(void) { bench_start(); }
void tearDown(void) { bench_end(); }

/* ---- software limits --------------------------------------------------------------------------------------------- */

static void test_targets_outside_the_limits_are_refused_inside_accepted(void)
{
    bench_enable_within(-2.0, 3.0);
    static const struct {
        double target;
        cm1e_error_t error;
    } rows[] = {{3.0, CM1E_OK}, {-2.0, CM1E_OK}, {3.0001, CM1E_ERROR_AXIS_POSITION_RANGE},
                {-2.0001, CM1E_ERROR_AXIS_POSITION_RANGE}, {1e9, CM1E_ERROR_AXIS_POSITION_RANGE}, {0.0, CM1E_OK}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        const cm1e_axis_command_t command = {.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = rows[i].target,
                                             .velocity = 20.0};
        TEST_ASSERT_EQUAL_INT(rows[i].error, bench_try_command(&command));
        bench_cycles(3000);
    }
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE,
                          bench_try_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_RELATIVE, .position = 3.01,
                                                             .velocity = 1.0}));
}

/* In doubles 0.1 + 0.1 + 0.1 is more than 0.3. */
static void test_a_limit_is_reached_in_steps_that_are_rounded(void)
{
    static const double steps[] = {0.1, 0.7, 1.1, 1e-3, 1.0 / 3.0};
    for (size_t i = 0; i < sizeof steps / sizeof steps[0]; i++)
        for (int sign = -1; sign <= 1; sign += 2) {
            bench_end();
            bench_start();
            bench_enable_within(-7.0 * steps[i], 7.0 * steps[i]);
            for (int n = 0; n < 7; n++) {
                const cm1e_axis_command_t step = {.kind = CM1E_COMMAND_MOVE_RELATIVE, .position = sign * steps[i],
                                                  .velocity = 20.0};
                TEST_ASSERT_EQUAL_INT(CM1E_OK, bench_try_command(&step));
                bench_cycles(700);
            }
        }
}

static void test_a_retarget_that_would_overshoot_a_limit_is_refused(void)
{
    bench_enable_within(-2.0, 10.0);
    const cm1e_command_id_t running = bench_move_to(9.9, 20.0);
    while (bench_info().set_position < 7.0)
        bench_cycles(1);
    /* turning round with a low deceleration would run far beyond 10 */
    const cm1e_axis_command_t soft = {.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = 0.0, .velocity = 20.0,
                                      .deceleration = 5.0};
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, bench_try_command(&soft));
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(running));
    /* but a stop is never refused for that: it brakes harder than it was asked to */
    const cm1e_command_id_t halt = bench_start_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_HALT,
                                                                              .deceleration = 1.0});
    bench_wait(halt, 5000);
    TEST_ASSERT_TRUE(bench_info().set_position <= 10.0);
}

static void test_velocity_into_a_limit_is_braked_before_it(void)
{
    static const double velocities[] = {0.5, 5.0, 20.0, 49.0};
    for (int sign = -1; sign <= 1; sign += 2)
        for (size_t i = 0; i < 4; i++) {
            fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
            bench_enable_within(-20.0, 20.0);
            const cm1e_command_id_t id = bench_move_velocity(sign * velocities[i]);
            bench_wait(id, 100000);
            const cm1e_command_status_t status = cm1e_axis_command_status(axis, id);
            TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ERROR, status.state);
            TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, bench_info().error);
            char text[512];
            cm1e_axis_error_text(cm1e_axis_reference(axis), text, sizeof text);
            TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, sign > 0 ? "limit at 20" : "limit at -20"), text);
            bench_cycles(2000);
            TEST_ASSERT_FALSE(cm1e_axis_powered(axis));
            const double reached = sign * bench_info().actual_position;
            TEST_ASSERT_TRUE(reached <= 20.0 + 1e-5);
            TEST_ASSERT_TRUE(reached > 20.0 - 0.2 - velocities[i] * 0.002);
            TEST_ASSERT_LESS_OR_EQUAL_INT64(8, worst_change);
        }
}

/* It would be beyond the point from which it can stop a cycle later. */
static void test_a_velocity_from_which_no_stop_is_possible_is_refused(void)
{
    for (int sign = -1; sign <= 1; sign += 2) {
        fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
        bus.config.axes[0].max_jerk = 1e6;
        bench_enable_within(-20.0, 20.0);
        const cm1e_command_id_t running = bench_move_to(20.0 * sign, 20.0);
        while (fabs(bench_info().set_position) < 19.5)
            bench_cycles(1);
        const cm1e_axis_command_t on = {.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 10.0 * sign};
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, bench_try_command(&on));
        bench_wait(running, 1000);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(running));
    }
}

/** Fast towards a limit, with so little jerk that a stop there has to do without a limit of jerk. */
static void brake_hard_for(int cycles)
{
    fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    bus.config.axes[0].max_velocity = 20.0;
    bus.config.axes[0].max_jerk = 300.0;
    bus.config.axes[0].software_limit_negative = -30.0;
    bus.config.axes[0].software_limit_positive = 22.0;
    bench_create();
    bench_enable();
    bench_move_velocity(20.0);
    while (bench_info().set_position < 19.0)
        bench_cycles(1);
    bench_start_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_HALT});
    bench_cycles(1 + cycles);
    TEST_ASSERT_EQUAL_DOUBLE(-100.0, bench_info().set_acceleration);
}

/** What takes over from a ramp without limit of jerk does not carry its acceleration through standstill and back. */
static void test_a_stop_without_limit_of_jerk_never_swings_back(void)
{
    for (int cycles = 0; cycles < 190; cycles += 3)
        for (int way = 0; way < 4; way++) {
            brake_hard_for(cycles);
            if (way < 2)
                bench_start_command(&(cm1e_axis_command_t){.kind = way ? CM1E_COMMAND_STOP : CM1E_COMMAND_HALT});
            else if (way == 2)
                TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_set_override(axis, 0.9, 0.9, 0.9));
            cm1e_command_id_t id;
            if (way == 3) /* refused where only the present ramp is short enough */
                (void)cm1e_axis_start(axis, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 0.1},
                                      &id);
            for (int n = 0; n < 1500; n++) {
                bench_cycles(1);
                TEST_ASSERT_TRUE(bench_info().set_velocity >= 0.0 && bench_info().set_position <= 22.0 + 1e-6);
            }
            bench_end();
        }
}

/** A stop without limit of jerk that has not begun yet is none: what takes over in the same cycle makes no step. */
static void test_a_stop_that_is_taken_over_at_once_makes_no_step(void)
{
    for (int cycles = 0; cycles < 100; cycles++) {
        fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
        bus.config.axes[0].max_jerk = 300.0;
        bus.config.axes[0].software_limit_positive = 20.0;
        bus.config.axes[0].software_limit_negative = -30.0;
        bench_create();
        bench_enable();
        bench_move_to(2.95, 20.0);
        bench_cycles(400 + cycles);
        const double before = bench_info().set_acceleration;
        bench_start_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_HALT, .deceleration = 0.1});
        bench_move_to(2.95, 20.0);
        bench_cycles(1);
        TEST_ASSERT_DOUBLE_WITHIN(0.3 * (1 + 1e-6), before, bench_info().set_acceleration);
        bench_end();
    }
}

/** It is on its way there. */
static void test_a_move_back_inside_is_taken_while_braking_without_limit_of_jerk(void)
{
    for (int cycles = 0; cycles < 190; cycles += 3) {
        brake_hard_for(cycles);
        const cm1e_command_id_t id = bench_move_to(0.0, 20.0);
        bench_wait(id, 9000);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(id));
    }
}

static void test_an_axis_outside_its_limits_may_only_come_back(void)
{
    bus.position = 500000; /* 10 u */
    bench_enable_within(-2.0, 3.0);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE,
                          bench_try_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = 10.1,
                                                             .velocity = 1.0}));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE,
                          bench_try_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 1.0}));
    const cm1e_command_id_t id = bench_move_to(5.0, 10.0); /* still outside, but nearer */
    bench_wait(id, 3000);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(id));
    const cm1e_command_id_t velocity = bench_move_velocity(-1.0);
    bench_cycles(3000);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(velocity));
    TEST_ASSERT_EQUAL_INT(CM1E_OK, bench_info().error);
}

/* At the limit itself nothing is left to brake in, however slow the motion would be. */
static void test_an_axis_at_its_limit_may_not_go_on(void)
{
    bench_enable_within(-2.0, 3.0);
    for (int i = 0; i < 2; i++) {
        const double limit = i == 0 ? 3.0 : -2.0, outwards = i == 0 ? 1.0 : -1.0;
        const cm1e_command_id_t id = bench_move_to(limit, 10.0);
        bench_wait(id, 3000);
        for (double speed = 0.01; speed < 20.0; speed *= 5.0) {
            const cm1e_axis_command_t out = {.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = speed * outwards};
            TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, bench_try_command(&out));
        }
        const cm1e_axis_command_t back = {.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = -0.01 * outwards};
        TEST_ASSERT_EQUAL_INT(CM1E_OK, bench_try_command(&back));
        bench_cycles(100);
        TEST_ASSERT_EQUAL_INT(CM1E_OK, bench_info().error);
    }
}

/* ---- enabled directions ------------------------------------------------------------------------------------------ */

static void test_motion_in_a_disabled_direction_is_refused(void)
{
    bench_enable();
    static const double signs[] = {1.0, -1.0};
    for (int i = 0; i < 2; i++) {
        cm1e_axis_power(axis, &owner, true, i == 1, i == 0);
        const double bad = signs[i];
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_DIRECTION_DISABLED,
                              bench_try_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_RELATIVE, .position = bad,
                                                                 .velocity = 1.0}));
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_DIRECTION_DISABLED,
                              bench_try_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY,
                                                                 .velocity = bad}));
        const cm1e_command_id_t good = bench_move_by(-bad, 5.0);
        bench_wait(good, 2000);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(good));
    }
}

/* Behind a velocity nobody knows where a command begins, but the direction of a distance is known. */
static void test_a_distance_in_a_disabled_direction_is_refused_also_behind_a_velocity(void)
{
    for (int sign = -1; sign <= 1; sign += 2) {
        bench_start();
        bench_enable();
        cm1e_axis_power(axis, &owner, true, sign > 0, sign < 0);
        bench_move_velocity(1.0 * sign);
        bench_cycles(100);
        const cm1e_axis_command_t back = {.kind = CM1E_COMMAND_MOVE_RELATIVE, .position = -1.0 * sign, .velocity = 1.0,
                                          .buffer_mode = mcBuffered};
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_DIRECTION_DISABLED, bench_try_command(&back));
        const cm1e_axis_command_t to = {.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = -9.0 * sign, .velocity = 1.0,
                                        .buffer_mode = mcBuffered};
        TEST_ASSERT_EQUAL_INT(CM1E_OK, bench_try_command(&to));
    }
}

static void test_refused_numbers_are_told_as_they_are_judged(void)
{
    bench_enable();
    cm1e_command_id_t id;
    const cm1e_axis_command_t fast = {.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = -1e9};
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_VELOCITY_RANGE, cm1e_axis_start(axis, &fast, &id));
    bench_told("velocity -1e+09 was commanded; -");
    bench_told("u/s is right, but not 0");
    static const cm1e_axis_command_t wrong[] = {
        {.kind = CM1E_COMMAND_MOVE_SUPERIMPOSED, .position = 1.0, .velocity = -1.0},
        {.kind = CM1E_COMMAND_MOVE_SUPERIMPOSED, .position = 1.0, .velocity = 1e9},
        {.kind = CM1E_COMMAND_MOVE_CONTINUOUS_ABSOLUTE, .position = 1.0, .velocity = -1.0, .end_velocity = 1.0},
        {.kind = CM1E_COMMAND_MOVE_CONTINUOUS_ABSOLUTE, .position = 1.0, .velocity = 1e9, .end_velocity = 1.0},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_VELOCITY_RANGE, cm1e_axis_start(axis, &wrong[i], &id));
        bench_told("was commanded; above 0, up to");
    }
}

/** The input that is too small to compute with is named, in every kind of motion, and what can be computed with. */
static void test_inputs_of_next_to_nothing_are_named(void)
{
    static const struct {
        cm1e_axis_command_t command;
        cm1e_error_t error;
        const char *told;
    } small[] = {
        {{.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = 1.0, .velocity = 1e-300}, CM1E_ERROR_AXIS_VELOCITY_RANGE,
         "Velocity 1e-300 was commanded, which is too small to compute with; from 2e-07 u/s on is right"},
        {{.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = 1.0, .velocity = 5e-324}, CM1E_ERROR_AXIS_VELOCITY_RANGE,
         "Velocity 4.94066e-324 was commanded"},
        {{.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = 1.0, .velocity = 1.0, .acceleration = 1e-300},
         CM1E_ERROR_AXIS_DYNAMICS_RANGE,
         "Acceleration 1e-300 was commanded, which is too small to compute with; 0 (the maximum), or from 2e-07 u/s2 on"},
        {{.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = 1.0, .velocity = 1.0, .deceleration = 1e-310},
         CM1E_ERROR_AXIS_DYNAMICS_RANGE, "Deceleration 1e-310 was commanded"},
        {{.kind = CM1E_COMMAND_MOVE_RELATIVE, .position = 1.0, .velocity = 1.0, .jerk = 1e-300},
         CM1E_ERROR_AXIS_DYNAMICS_RANGE, "Jerk 1e-300 was commanded"},
        {{.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = -1e-300}, CM1E_ERROR_AXIS_VELOCITY_RANGE,
         "Velocity -1e-300 was commanded"},
        {{.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 1.0, .acceleration = 1e-300}, CM1E_ERROR_AXIS_DYNAMICS_RANGE,
         "Acceleration 1e-300 was commanded"},
        {{.kind = CM1E_COMMAND_MOVE_CONTINUOUS_ABSOLUTE, .position = 1.0, .velocity = 1.0, .deceleration = 1e-300},
         CM1E_ERROR_AXIS_DYNAMICS_RANGE, "Deceleration 1e-300 was commanded"},
        {{.kind = CM1E_COMMAND_HALT, .jerk = 1e-300}, CM1E_ERROR_AXIS_DYNAMICS_RANGE, "Jerk 1e-300 was commanded"},
    };
    for (int modulo = 0; modulo < 2; modulo++) {
        fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
        bus.config.axes[0].modulo_range = modulo ? 360.0 : 0.0;
        bench_create();
        bench_enable();
        for (size_t i = 0; i < sizeof small / sizeof small[0]; i++) {
            TEST_ASSERT_EQUAL_INT(small[i].error, bench_try_command(&small[i].command));
            bench_told(small[i].told);
        }
        bench_end();
    }
}

/** The stop before a position on a modulo axis is so long that it has no end: the deceleration is told, not the position. */
static void test_a_stop_without_an_end_names_its_deceleration(void)
{
    fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    bus.config.axes[0].modulo_range = 360.0;
    bench_create();
    bench_enable();
    bench_move_velocity(5.0);
    bench_cycles(500);
    const cm1e_axis_command_t slow = {.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = 1.0, .velocity = 5.0,
                                      .deceleration = 1e-10};
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_DYNAMICS_RANGE, bench_try_command(&slow));
    bench_told("Deceleration 1e-10 was commanded");
}

/** A distance of next to nothing is none. */
static void test_a_distance_of_next_to_nothing_is_none(void)
{
    bench_enable();
    for (int e = -323; e < -290; e++) {
        const cm1e_command_id_t id = bench_move_by(pow(10.0, e), 1.0);
        bench_wait(id, 5);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(id));
    }
}

/** The text says which input of MC_Power is missing: both are FALSE where a program leaves them out. */
static void test_direction_that_is_disabled_is_told_with_its_inputs(void)
{
    static const struct { bool positive, negative; double target; const char *told; } cases[] = {
        {false, false, 1.0, ": its EnablePositive and EnableNegative are FALSE."},
        {false, true, 1.0, ": its EnablePositive is FALSE."}, {true, false, -1.0, ": its EnableNegative is FALSE."},
    };
    bench_enable();
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        cm1e_command_id_t id;
        cm1e_axis_power(axis, &owner, true, cases[i].positive, cases[i].negative);
        const cm1e_axis_command_t move = {.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = cases[i].target, .velocity = 1.0};
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_DIRECTION_DISABLED, cm1e_axis_start(axis, &move, &id));
        bench_told("Standstill: motion in this direction is disabled by MC_Power: its ");
        bench_told(cases[i].told);
    }
    cm1e_command_id_t id;
    const cm1e_axis_command_t nowhere = {.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = NAN, .velocity = 1.0};
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, cm1e_axis_start(axis, &nowhere, &id));
    bench_told("a position or distance of nan was commanded; a finite number is right.");
}

static void test_direction_disabled_while_running_stops_the_motion(void)
{
    bench_enable();
    const cm1e_command_id_t id = bench_move_velocity(10.0);
    bench_cycles(400);
    cm1e_axis_power(axis, &owner, true, false, true);
    const cm1e_command_status_t status = cm1e_axis_command_status(axis, id);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ERROR, status.state);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_DIRECTION_DISABLED, status.error);
    bench_told("MC_MoveVelocity, running or waiting, was ended: motion in this direction is disabled by "
               "MC_Power: its EnablePositive is FALSE.");
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_DISCRETE_MOTION, bench_info().state);
    bench_cycles(20);
    const cm1e_command_id_t back = bench_move_by(-3.0, 10.0); /* while it still brakes */
    while (bench_state_of(back) == CM1E_COMMAND_ACTIVE) {
        cm1e_axis_power(axis, &owner, true, false, true);
        bench_cycles(1);
    }
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(back));
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
    TEST_ASSERT_LESS_OR_EQUAL_INT64(7, worst_change);
}

static void test_a_reversal_into_a_direction_disabled_meanwhile_is_stopped(void)
{
    for (int position = 0; position < 2; position++) {
        bench_start();
        bench_enable();
        bench_move_velocity(10.0);
        bench_cycles(400);
        const cm1e_command_id_t back = position ? bench_move_to(-5.0, 10.0) : bench_move_velocity(-10.0);
        bench_cycles(10);
        cm1e_axis_power(axis, &owner, true, true, false); /* it still goes the other way, but would turn round */
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ERROR, bench_state_of(back));
        double farthest = bench_info().set_position;
        for (int i = 0; i < 500; i++) {
            bench_cycles(1);
            TEST_ASSERT_TRUE(bench_info().set_position >= farthest - 1e-9);
            farthest = bench_info().set_position;
        }
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
        TEST_ASSERT_LESS_OR_EQUAL_INT64(7, worst_change);
    }
}

static void test_a_direction_that_a_motion_does_not_need_may_be_disabled(void)
{
    bench_enable();
    const cm1e_command_id_t move = bench_move_to(5.0, 10.0);
    bench_cycles(300);
    cm1e_axis_power(axis, &owner, true, true, false);
    bench_wait(move, 3000);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(move));
    cm1e_axis_power(axis, &owner, true, true, true);
    const cm1e_command_id_t back = bench_move_to(2.0, 10.0);
    bench_cycles(50);
    cm1e_axis_power(axis, &owner, true, false, true);
    bench_wait(back, 3000);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(back));
}

/* A limit in the direction `sign` at `refused` would be overrun by the motion that runs; one at `taken` would not. */
static void expect_limit_between(int sign, double refused, double taken)
{
    const unsigned limit = sign > 0 ? CM1E_PARAMETER_SW_LIMIT_POS : CM1E_PARAMETER_SW_LIMIT_NEG;
    const unsigned enable = sign > 0 ? CM1E_PARAMETER_ENABLE_LIMIT_POS : CM1E_PARAMETER_ENABLE_LIMIT_NEG;
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_write_parameter(axis, limit, refused));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, cm1e_axis_write_parameter(axis, enable, 1.0));
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_write_parameter(axis, limit, taken));
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_write_parameter(axis, enable, 1.0));
}

/* It is at 20 u/s after 2.5 u, and needs 2 u to brake from there. */
static void test_a_limit_that_the_end_of_an_acceleration_would_overrun_is_refused(void)
{
    for (int sign = -1; sign <= 1; sign += 2) {
        bench_end();
        bench_start();
        bench_enable();
        const double begin = bench_info().set_position;
        bench_move_velocity(20.0 * sign);
        bench_cycles(20);
        expect_limit_between(sign, begin + 4.4 * sign, begin + 4.6 * sign);
    }
}

/* On its way back the axis goes on by 4 u first, softly. A limit in between is one that it would overrun. */
static void test_a_limit_that_a_reversal_would_overrun_is_refused(void)
{
    for (int sign = -1; sign <= 1; sign += 2) {
        bench_end();
        bench_start();
        bench_enable();
        bench_move_velocity(20.0 * sign);
        bench_cycles(600);
        const double turned = bench_info().set_position;
        bench_start_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = 0.0,
                                                   .velocity = 20.0, .deceleration = 50.0});
        bench_cycles(5);
        expect_limit_between(sign, turned + 3.8 * sign, turned + 5.0 * sign);
    }
}

/* ---- the maximum of the application ------------------------------------------------------------------------------ */

/* Accelerates to the lowered maximum, and is given a tenth of the jerk after `moment` cycles. The acceleration then
 * needs all the room that is left below that maximum. */
static double fastest_with_a_smaller_jerk_from(int moment)
{
    bench_start();
    bench_enable();
    const double most = 20.0;
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_write_parameter(axis, CM1E_PARAMETER_MAX_VELOCITY_APPL, most));
    bench_move_velocity(most);
    bench_cycles(moment);
    const cm1e_axis_command_t softly = {.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = most,
                                        .jerk = axis->limits.maximum.jerk / 10.0};
    bench_start_command(&softly);
    double fastest = 0.0;
    for (int n = 0; n < 800; n++) {
        bench_cycles(1);
        fastest = fmax(fastest, bench_info().set_velocity);
    }
    bench_end();
    return fastest / most;
}

static void test_a_smaller_jerk_keeps_the_maximum_of_the_application(void)
{
    for (int moment = 1; moment < 250; moment += 3) {
        const double fastest = fastest_with_a_smaller_jerk_from(moment);
        char text[60];
        snprintf(text, sizeof text, "moment %d: %.12f times", moment, fastest);
        TEST_ASSERT_TRUE_MESSAGE(fastest > 0.999 && fastest < 1.0 + 1e-6, text);
    }
    bench_start();
}

/* The application lowers its maximum so far that an acceleration under way overshoots it with the largest jerk too. The
 * jerk is then the one that was asked for. */
static void test_a_maximum_lowered_too_far_does_not_raise_the_jerk(void)
{
    bench_enable();
    bench_move_velocity(40.0);
    bench_cycles(150);
    const double a = bench_info().set_acceleration, jerk = axis->limits.maximum.jerk / 4.0;
    const double most = bench_info().set_velocity + a * a / (4.0 * axis->limits.maximum.jerk);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_write_parameter(axis, CM1E_PARAMETER_MAX_VELOCITY_APPL, most));
    bench_start_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = most, .jerk = jerk});
    double before = a;
    for (int n = 0; n < 100; n++) {
        bench_cycles(1);
        TEST_ASSERT_DOUBLE_WITHIN(jerk * 0.001 * (1.0 + 1e-6), before, bench_info().set_acceleration);
        before = bench_info().set_acceleration;
    }
}

/* An acceleration that the largest jerk ends too late gets the jerk that ends it at the maximum velocity. */
static void test_an_acceleration_near_the_maximum_ends_at_the_maximum(void)
{
    bench_enable();
    const cm1e_motion_limits_t *most = &axis->limits.maximum;
    const double a = most->acceleration, room = a * a / (2.0 * most->jerk) / 3.0;
    for (int sign = -1; sign <= 1; sign += 2) {
        const from_t from = {.velocity = sign * (most->velocity - room), .acceleration = sign * a};
        cm1e_motion_limits_t limits = {.jerk = most->jerk / 10.0};
        cm1e_axis_keep_below_maximum(axis, &from, &limits);
        TEST_ASSERT_DOUBLE_WITHIN(1e-6 * most->jerk, 3.0 * most->jerk, limits.jerk);
    }
}

/* A move of each kind at 20 u/s, and the application then allows less than it was told. */
static cm1e_command_id_t lowered_in_a_move(int number, cm1e_command_kind_t kind)
{
    static const double allowed[] = {[CM1E_PARAMETER_MAX_VELOCITY_APPL] = 5.0, [CM1E_PARAMETER_MAX_ACCELERATION_APPL] = 10.0,
                                     [CM1E_PARAMETER_MAX_DECELERATION_APPL] = 10.0, [CM1E_PARAMETER_MAX_JERK_APPL] = 100.0};
    bench_start();
    bench_enable();
    const cm1e_command_id_t id = bench_start_command(&(cm1e_axis_command_t){
        .kind = kind, .position = 200.0, .velocity = 20.0, .end_velocity = 20.0, .acceleration = 50.0, .deceleration = 50.0,
        .jerk = 1000.0});
    bench_cycles(1000);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_write_parameter(axis, number, allowed[number]));
    bench_cycles(50);
    TEST_ASSERT_EQUAL_DOUBLE(20.0, bench_info().set_velocity); /* a motion that runs is not changed */
    return id;
}

static const int appl[] = {CM1E_PARAMETER_MAX_VELOCITY_APPL, CM1E_PARAMETER_MAX_ACCELERATION_APPL,
                           CM1E_PARAMETER_MAX_DECELERATION_APPL, CM1E_PARAMETER_MAX_JERK_APPL};
static const cm1e_command_kind_t moves[] = {CM1E_COMMAND_MOVE_VELOCITY, CM1E_COMMAND_MOVE_RELATIVE,
                                            CM1E_COMMAND_MOVE_CONTINUOUS_RELATIVE};

/** It was accepted: a pause of the host, and frames that were lost, are no reason to refuse it afterwards. */
static void test_a_maximum_that_was_lowered_is_no_error_of_a_motion_that_begins_anew(void)
{
    for (int n = 0; n < 4 * 3 * 2; n++) {
        const int number = appl[n / 6];
        const cm1e_command_id_t id = lowered_in_a_move(number, moves[n / 2 % 3]);
        if (n % 2) {
            bench_inputs();
            cm1e_axis_after_pause(axis, 10000000);
            bench_outputs();
        } else {
            received = CM1E_ERROR_BUS_LOST;
            bench_cycles(4);
            received = CM1E_OK;
        }
        bench_cycles(4000);
        TEST_ASSERT_EQUAL_INT(CM1E_OK, bench_info().error);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(id));
        TEST_ASSERT_EQUAL_DOUBLE(number == CM1E_PARAMETER_MAX_VELOCITY_APPL ? 5.0 : 20.0, bench_info().set_velocity);
        bench_end();
    }
    bench_start();
}

/** A VelFactor acts on a motion that runs, also if that was told more than is allowed now; 0 stops it. */
static void test_an_override_acts_on_a_motion_that_has_more_than_is_allowed_now(void)
{
    for (int n = 0; n < 4 * 3 * 2; n++) {
        const int number = appl[n / 6];
        const double factor = n % 2 ? 0.0 : 0.5;
        const cm1e_command_id_t id = lowered_in_a_move(number, moves[n / 2 % 3]);
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_set_override(axis, factor, 1.0, 1.0));
        bench_cycles(2500);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(id));
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, factor * (number == CM1E_PARAMETER_MAX_VELOCITY_APPL ? 5.0 : 20.0),
                                  bench_info().set_velocity);
        bench_end();
    }
    bench_start();
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_targets_outside_the_limits_are_refused_inside_accepted);
    RUN_TEST(test_a_limit_is_reached_in_steps_that_are_rounded);
    RUN_TEST(test_a_retarget_that_would_overshoot_a_limit_is_refused);
    RUN_TEST(test_velocity_into_a_limit_is_braked_before_it);
    RUN_TEST(test_a_velocity_from_which_no_stop_is_possible_is_refused);
    RUN_TEST(test_a_stop_without_limit_of_jerk_never_swings_back);
    RUN_TEST(test_a_stop_that_is_taken_over_at_once_makes_no_step);
    RUN_TEST(test_a_move_back_inside_is_taken_while_braking_without_limit_of_jerk);
    RUN_TEST(test_an_axis_outside_its_limits_may_only_come_back);
    RUN_TEST(test_an_axis_at_its_limit_may_not_go_on);
    RUN_TEST(test_motion_in_a_disabled_direction_is_refused);
    RUN_TEST(test_a_distance_in_a_disabled_direction_is_refused_also_behind_a_velocity);
    RUN_TEST(test_refused_numbers_are_told_as_they_are_judged);
    RUN_TEST(test_inputs_of_next_to_nothing_are_named);
    RUN_TEST(test_a_stop_without_an_end_names_its_deceleration);
    RUN_TEST(test_a_distance_of_next_to_nothing_is_none);
    RUN_TEST(test_direction_that_is_disabled_is_told_with_its_inputs);
    RUN_TEST(test_direction_disabled_while_running_stops_the_motion);
    RUN_TEST(test_a_reversal_into_a_direction_disabled_meanwhile_is_stopped);
    RUN_TEST(test_a_direction_that_a_motion_does_not_need_may_be_disabled);
    RUN_TEST(test_a_limit_that_the_end_of_an_acceleration_would_overrun_is_refused);
    RUN_TEST(test_a_limit_that_a_reversal_would_overrun_is_refused);
    RUN_TEST(test_a_smaller_jerk_keeps_the_maximum_of_the_application);
    RUN_TEST(test_a_maximum_lowered_too_far_does_not_raise_the_jerk);
    RUN_TEST(test_an_acceleration_near_the_maximum_ends_at_the_maximum);
    RUN_TEST(test_a_maximum_that_was_lowered_is_no_error_of_a_motion_that_begins_anew);
    RUN_TEST(test_an_override_acts_on_a_motion_that_has_more_than_is_allowed_now);
    return UNITY_END();
}
