/* A motor that does not follow, and a bus that goes: ErrorStop, the ramp, and how long the torque stays. */
#include <limits.h>
#include <math.h>
#include <stdlib.h>

#include "axis/axis_pause.h" /* first, as the bench has a global `axis` */

#include "../support/axis_bench.h"
#include "axis/axis_parameters.h"

void setUp(void) { bench_start(); }
void tearDown(void) { bench_end(); }

/* ---- lag --------------------------------------------------------------------------------------------------------- */

static void test_a_motor_that_does_not_follow_ends_in_error_stop(void)
{
    bench_enable();
    bench_move_velocity(10.0);
    bench_cycles(400);
    bus.blocked = true;
    bench_cycles(200);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_LAG, bench_info().error);
    char text[512];
    cm1e_axis_error_text(cm1e_axis_reference(axis), text, sizeof text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, "allowed are 0.5 u"), text);
    bench_cycles(400);
    TEST_ASSERT_NOT_EQUAL_INT(OPERATION_ENABLED, bus.state);
}

/** Milliseconds for which the torque stays from now on. */
static int torque_left(void)
{
    int cycles = 0;
    while (bus.state == OPERATION_ENABLED && cycles < 1000) {
        bench_cycles(1);
        cycles++;
    }
    return cycles;
}

/** The axis brakes from where the motor is. A motor that stands there has no ramp, and what its feedback shows is old:
 *  it keeps the torque for 20 ms all the same. */
static void test_a_motor_that_does_not_follow_has_20_ms_to_brake(void)
{
    bench_enable();
    bench_move_velocity(10.0);
    bench_cycles(400);
    bus.blocked = true;
    while (bench_info().state != CM1E_AXIS_ERROR_STOP)
        bench_cycles(1);
    const int torque_ms = torque_left();
    TEST_ASSERT_GREATER_OR_EQUAL_INT(20, torque_ms);
    TEST_ASSERT_LESS_OR_EQUAL_INT(23, torque_ms); /* the word to the drive and its answer */
}

/** The ramp begins with the velocity of the motor. It is never faster than the set-point nor in the other direction. */
static void test_an_axis_brakes_from_the_velocity_of_its_motor(void)
{
    static const double of_set_point[] = {-0.5, 0.0, 0.5, 1.0, 1.5}, expected[] = {0.0, 0.0, 0.5, 1.0, 1.0};
    static const double velocities[] = {-10.0, -0.1, 0.1, 10.0};
    for (int n = 0; n < 4; n++)
        for (int i = 0; i < 5; i++) {
            bench_start();
            bench_enable();
            bench_move_velocity(velocities[n]);
            bench_cycles(400);
            axis->drive.feedback.velocity = of_set_point[i] * velocities[n] * 50000.0;
            cm1e_axis_brake_from_actual(axis);
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, expected[i] * velocities[n], axis->setpoint.velocity);
        }
}

/** MC_Power.Enable FALSE, a motor that does not follow the ramp, and TRUE again in any cycle: the lag is told. */
static void test_lag_in_the_ramp_to_disabled_is_an_error_whenever_power_comes_again(void)
{
    for (int again = 0; again < 150; again++) {
        bench_start();
        bench_enable();
        bench_move_velocity(20.0);
        bench_cycles(500);
        bus.blocked = true;
        bench_power(false);
        bench_cycles(again);
        bench_inputs(); /* Enable comes between inputs and outputs of a cycle */
        bench_power(true);
        bench_outputs();
        bench_cycles(200);
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_ERROR_STOP, bench_info().state);
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_LAG, bench_info().error);
        TEST_ASSERT_NOT_EQUAL_INT(OPERATION_ENABLED, bus.state);
        cm1e_axis_reset(axis);
        bus.blocked = false;
        bench_cycles(50);
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
    }
}

/* ---- the bus goes ------------------------------------------------------------------------------------------------ */

/** The axis is in ErrorStop in that cycle, and later without torque. With the bus back nothing moves by itself. */
static void lose_the_bus(cm1e_error_t error, bool back_early, cm1e_command_id_t id)
{
    received = error;
    bench_cycles(2); /* two lost frames are nothing */
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_CONTINUOUS_MOTION, bench_info().state);
    health = error;
    bench_cycles(1);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_ERROR_STOP, bench_info().state);
    TEST_ASSERT_EQUAL_INT(error, bench_info().error);
    bench_told(error == CM1E_ERROR_BUS_LOST ? "Check cable, network interface" : "Look for a slave without power");
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ERROR, bench_state_of(id));
    bench_cycles(50);
    TEST_ASSERT_EQUAL_INT(OPERATION_ENABLED, bus.state); /* for the motor to stop by its torque */
    if (back_early)
        health = received = CM1E_OK;
    bench_cycles(300);
    TEST_ASSERT_NOT_EQUAL_INT(OPERATION_ENABLED, bus.state);
    health = received = CM1E_OK;
    bench_cycles(100); /* nothing by itself */
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_ERROR_STOP, bench_info().state);
    TEST_ASSERT_NOT_EQUAL_INT(OPERATION_ENABLED, bus.state);
    cm1e_axis_reset(axis);
    bench_cycles(50);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
}

static void test_bus_trouble_while_moving_holds_the_target_then_disables(void)
{
    static const cm1e_error_t errors[] = {CM1E_ERROR_BUS_LOST, CM1E_ERROR_BUS_WORKING_COUNTER};
    for (int e = 0; e < 2; e++)
        for (int back = 0; back < 2; back++) {
            bench_start();
            bench_enable();
            const cm1e_command_id_t id = bench_move_velocity(10.0);
            bench_cycles(500);
            const int32_t target = (int32_t)fake_output(&bus, OBJ_607A_TARGET_POSITION, 0);
            bench_forget_steps();
            lose_the_bus(errors[e], back, id);
            TEST_ASSERT_EQUAL_INT64(0, worst_step);
            TEST_ASSERT_EQUAL_INT32(target, bus.position);
        }
}

/** docs/SAFETY.md: torque off after speed / deceleration + 20 ms. */
static void test_a_lost_bus_leaves_the_torque_for_the_ramp_and_20_ms(void)
{
    static const double speeds[] = {0.1, 1.0, 10.0};
    for (size_t n = 0; n < sizeof speeds / sizeof speeds[0]; n++) {
        bench_start();
        bench_enable();
        bench_move_velocity(speeds[n]);
        bench_cycles(500);
        received = health = CM1E_ERROR_BUS_LOST;
        bench_cycles(1);
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_ERROR_STOP, bench_info().state);
        const int bound_ms = (int)(speeds[n] / axis->limits.emergency.deceleration * 1e3) + 20;
        const int torque_ms = torque_left();
        TEST_ASSERT_GREATER_OR_EQUAL_INT(bound_ms, torque_ms);
        TEST_ASSERT_LESS_OR_EQUAL_INT(bound_ms + 3, torque_ms);
    }
}

/** After a silent cycle the motor gets back to its speed with the 8 % that are left above the set velocity, to which
 *  belongs what the set velocity grows meanwhile: 16 cycles. */
static void test_a_silence_slows_an_axis_only_near_its_maximum_velocity(void)
{
    bench_start();
    bench_enable();
    const double most = axis->limits.system.velocity, highest = 0.92 * most, a = 100.0, gain = 16 * a * axis->cycle_s;
    const struct {
        double velocity, acceleration, part;
    } rows[] = {
        {0.0, 0.0, 1.0}, {1.0, 0.0, 1.0}, {1.0, a, 1.0}, {most, 0.0, 0.92}, {most, a, 0.92},
        {highest - 0.5 * gain, 0.0, 1.0}, {highest - 0.5 * gain, -a, 1.0},
        {highest - 0.5 * gain, a, highest / (highest + 0.5 * gain)},
    };
    axis->silence.shaken = CM1E_SHAKEN_BY_SILENCE;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
        for (int sign = -1; sign <= 1; sign += 2) {
            axis->setpoint.velocity = sign * rows[i].velocity;
            axis->setpoint.acceleration = sign * rows[i].acceleration;
            TEST_ASSERT_DOUBLE_WITHIN(1e-12, rows[i].part, cm1e_axis_part_left(axis));
        }
}

static double csv_shaft;
static int32_t csv_worst_change, csv_velocity_before;

/* The fake drive's shaft turns by the target velocity. */
static void turn(cm1e_bus_t *motor)
{
    const int32_t change = motor->target_velocity_raw - csv_velocity_before;
    csv_worst_change = change > csv_worst_change ? change : -change > csv_worst_change ? -change : csv_worst_change;
    csv_velocity_before = motor->velocity_raw = motor->target_velocity_raw;
    csv_shaft += motor->target_velocity_raw * 1e-3;
    motor->position = (int32_t)lround(csv_shaft);
}

/* In CSV; 0: without software limits. */
static void by_velocity_within(double limit)
{
    fake_bus_init(&bus, CM1E_MAPPING_CSV, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    bus.config.axes[0].software_limit_negative = -limit;
    bus.config.axes[0].software_limit_positive = limit;
    bus.mode = bus.sdo_mode = CM1E_MODE_CSV;
    bus.world = turn;
    csv_shaft = csv_worst_change = csv_velocity_before = 0;
    bench_create();
    bench_enable();
}

static void test_bus_trouble_while_moving_by_velocity_ramps_down_blindly(void)
{
    for (int back = 0; back < 2; back++) {
        by_velocity_within(0.0);
        const cm1e_command_id_t id = bench_move_velocity(10.0);
        bench_cycles(500);
        TEST_ASSERT_INT32_WITHIN(1000, 500000, bus.target_velocity_raw);
        lose_the_bus(CM1E_ERROR_BUS_LOST, back, id);
        TEST_ASSERT_LESS_OR_EQUAL_INT32(5200, csv_worst_change); /* 5,000,000 counts/s2, and the position loop */
    }
}

/** The bus comes back at the end of the ramp of ErrorStop. A motor that is more than 50 counts farther away than one
 *  that follows the ramp was offline, and brakes from where it is. A smaller lag is that of its control. */
static void test_a_motor_that_was_offline_in_the_ramp_brakes_from_where_it_is(void)
{
    static const int lags[] = {-190, -60, -40, 40, 60, 190};
    for (size_t n = 0; n < sizeof lags / sizeof lags[0]; n++) {
        by_velocity_within(0.0);
        bench_move_velocity(10.0);
        bench_cycles(500);
        received = health = CM1E_ERROR_BUS_LOST;
        for (int i = 0; i < 1000 && bench_info().set_velocity > 0.35; i++)
            bench_cycles(1);
        const double way = bench_info().set_velocity * 50000.0 * 1e-3; /* counts, of a cycle */
        TEST_ASSERT_TRUE(way > 1.0);
        const double lag = lags[n] + copysign(2.0 * way, lags[n]);
        csv_shaft = bench_info().set_position * 50000.0 - lag - bus.target_velocity_raw * 1e-3;
        received = health = CM1E_OK;
        bench_cycles(1);
        const double left = fabs(bench_info().set_position * 50000.0 - bus.position);
        if (abs(lags[n]) > 50)
            TEST_ASSERT_TRUE(left <= way + 1.0);
        else
            TEST_ASSERT_TRUE(left >= fabs(lag) - 2.0 * way);
    }
}

/** In CSV the motor goes on through a silence, and its motion from where it is then. */
static void test_a_motion_by_velocity_goes_on_evenly_after_a_silence(void)
{
    for (int silent = CM1E_AXIS_RIDDEN_OUT_CYCLES + 1; silent <= 40; silent++) {
        by_velocity_within(0.0);
        const cm1e_command_id_t id = bench_move_to(20.0, 10.0);
        bench_cycles(500);
        received = CM1E_ERROR_TIMEOUT;
        bench_cycles(silent);
        received = CM1E_OK;
        csv_worst_change = 0;
        bench_cycles(50);
        TEST_ASSERT_LESS_OR_EQUAL_INT32(50, csv_worst_change); /* 0.001 u/s */
        TEST_ASSERT_DOUBLE_WITHIN(0.01, 10.0, bench_info().set_velocity);
        bench_cycles(3000);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(id));
        TEST_ASSERT_DOUBLE_WITHIN(1e-4, 20.0, bench_info().actual_position);
        bench_end();
    }
    bench_start();
}

/** In CSV the motor goes on while the cycle pauses, here beyond its software limit. */
static void test_motion_that_a_pause_takes_beyond_a_limit_names_that_limit(void)
{
    static const double velocities[] = {-10.0, -0.5, 0.5, 10.0};
    for (size_t n = 0; n < sizeof velocities / sizeof velocities[0]; n++) {
        by_velocity_within(25.0);
        bench_move_to(copysign(25.0, velocities[n]), fabs(velocities[n]));
        bench_cycles(1000);
        TEST_ASSERT_EQUAL_DOUBLE(velocities[n], bench_info().set_velocity);
        cm1e_axis_after_pause(axis, 60000000000);
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, bench_info().error);
        bench_told(velocities[n] > 0.0 ? " 25" : "-25");
    }
}

/** A motor 50 counts ahead of its set-point turns slower by 1000 counts/s; after a long pause that is no reason for more. */
static void test_correction_by_velocity_does_not_grow_with_the_pause(void)
{
    for (int64_t pause_ns = 4000000; pause_ns <= 40000000000; pause_ns *= 10) {
        by_velocity_within(0.0);
        bench_move_velocity(2.0);
        bench_cycles(1000);
        for (int n = 0; n < 10; n++) {
            csv_shaft += 5; /* gently, as no contradiction to its velocity */
            bench_cycles(1);
        }
        TEST_ASSERT_INT32_WITHIN(200, 99200, bus.target_velocity_raw);
        bench_inputs();
        cm1e_axis_after_pause(axis, pause_ns);
        bench_outputs();
        bench_inputs(); /* the bus takes the outputs */
        TEST_ASSERT_INT32_WITHIN(1100, 100000, bus.target_velocity_raw);
    }
}

static void turn_slowly(cm1e_bus_t *motor) { motor->velocity_raw = 10000; } /* 0.2 u/s */

/** After a pause in an acceleration, in CSP. The motor is two cycles behind the set-point: of a set-point with 2.025 u/s
 *  and 90 u/s2 it had 1.845 u/s. As hard as it has braked since then, it would be pulled back without an overshoot from
 *  (1.845 - 0.2) / 4 ms * (8 ms)^2 / 2, which is 658 counts. From farther away the set-point goes after it. */
static void test_motor_ahead_after_a_pause_is_judged_by_the_speed_that_it_had(void)
{
    static const int ahead[] = {600, 700};
    for (int n = 0; n < 2; n++) {
        bench_start();
        bench_enable();
        bench_move_velocity(10.0);
        while (bench_info().set_velocity < 2.0)
            bench_cycles(1);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 2.025, axis->setpoint.velocity);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 90.0, axis->setpoint.acceleration);
        cm1e_axis_after_pause(axis, 4000000);
        bus.blocked = true;
        bus.position = (int32_t)lround(bench_info().set_position * 50000.0) + ahead[n];
        bus.world = turn_slowly;
        bench_cycles(1);
        TEST_ASSERT_EQUAL_INT(ahead[n] > 658, bench_info().set_velocity > 0.2);
    }
}

static void test_bus_trouble_while_disabled_is_no_error_until_enable(void)
{
    health = received = CM1E_ERROR_BUS_LOST;
    bench_cycles(10);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_DISABLED, bench_info().state);
    TEST_ASSERT_FALSE(bench_info().online);
    bench_power(true);
    bench_cycles(2);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_ERROR_STOP, bench_info().state);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_BUS_LOST, bench_info().error);
}

static void test_a_slave_that_was_away_is_no_longer_homed(void)
{
    axis->position.homed = true;
    bus.watch.lost = true;
    bench_cycles(1);
    TEST_ASSERT_FALSE(bench_info().homed);
}

/* ---- a motor that turns behind the end of its ramp --------------------------------------------------------------- */

static int swings; /* cycles that are left */

/** To and fro around the target: amplitude 600 counts, at most 60,000 counts/s. */
static void swing(cm1e_bus_t *motor)
{
    if (swings <= 0)
        return;
    swings--;
    const double phase = 0.1 * swings;
    motor->position = motor->target_position + (int32_t)(600.0 * cos(phase));
    motor->velocity_raw = (int32_t)(60000.0 * sin(phase));
}

/** At rest, 0.1 u beside the target. */
static void hang(cm1e_bus_t *motor)
{
    motor->position = motor->target_position - 5000;
    motor->velocity_raw = 0;
}

/** Ends the power, or fails: milliseconds until the torque goes. */
static int torque_lasts(bool by_error)
{
    if (by_error)
        cm1e_axis_fail(axis, CM1E_ERROR_PROGRAM, 0.0, 0.0);
    else
        bench_power(false);
    int lasted = 0;
    while (bus.state == OPERATION_ENABLED && lasted < 5000) {
        bench_cycles(1);
        lasted++;
    }
    return lasted;
}

/** Ends the power, or fails, with a motor that turns for so long. Milliseconds until the torque goes. */
static int torque_behind(void (*world)(cm1e_bus_t *motor), int cycles, bool by_error)
{
    bench_start();
    bench_enable();
    bench_cycles(50);
    bus.world = world;
    swings = cycles;
    const int lasted = torque_lasts(by_error);
    bus.world = NULL;
    return lasted;
}

/** Whatever way the torque ends: it brakes a load that swings, and goes when the motor rests, or after two seconds. */
static void test_torque_stays_while_the_motor_turns_for_two_seconds_at_most(void)
{
    for (int by_error = 0; by_error < 2; by_error++) {
        TEST_ASSERT_INT_WITHIN(3, 3, torque_behind(NULL, 0, by_error));
        for (int cycles = 30; cycles <= 900; cycles += 29) /* it ends in any phase */
            TEST_ASSERT_INT_WITHIN(18, cycles + 12, torque_behind(swing, cycles, by_error));
        TEST_ASSERT_INT_WITHIN(15, 2010, torque_behind(swing, INT_MAX, by_error));
        TEST_ASSERT_INT_WITHIN(3, 22, torque_behind(hang, 0, by_error));
    }
}

/** It turns away from its target, by itself. */
static double run_velocity, run_acceleration, run_position; /* counts and ms */

static void run_away(cm1e_bus_t *motor)
{
    run_velocity += run_acceleration;
    run_position += run_velocity;
    motor->position = (int32_t)run_position;
    motor->velocity_raw = (int32_t)(1000.0 * run_velocity);
}

/** A motor that runs away, getting faster or as fast as it can, is let go: also where nobody monitors its lag. It had 20 ms
 *  to brake, or the way of a lag. */
static void test_a_motor_that_runs_away_loses_its_torque(void)
{
    for (int n = 0; n < 16; n++) {
        const bool by_error = n & 1, steady = n & 2, back = n & 4;
        bench_start();
        bench_enable();
        bench_cycles(50);
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_write_parameter(axis, CM1E_PARAMETER_ENABLE_POS_LAG_MONITORING, n >= 8));
        bus.blocked = true;
        bus.world = run_away;
        run_velocity = (back ? -1.0 : 1.0) * (steady ? 400.0 : 22.0);
        run_acceleration = steady ? 0.0 : back ? -0.5 : 0.5;
        run_position = bus.position;
        const int32_t from = bus.position;
        bench_cycles(1);
        const int lasted = torque_lasts(by_error);
        TEST_ASSERT_LESS_THAN_INT_MESSAGE(steady ? 160 : 80, lasted, by_error ? "error" : "power");
        TEST_ASSERT_LESS_THAN_INT(steady ? 64000 : 4500, abs(bus.position - from));
    }
}

/** A motor that turns when it gets its torque, and never rests, or runs away: the axis is never on. */
static void test_a_motor_that_does_not_rest_when_it_gets_its_torque_is_let_go(void)
{
    for (int n = 0; n < 4; n++) {
        const bool runs = n & 1, monitored = n & 2;
        bench_start();
        bench_cycles(5);
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_write_parameter(axis, CM1E_PARAMETER_ENABLE_POS_LAG_MONITORING,
                                                                 monitored));
        bus.blocked = runs;
        bus.world = runs ? run_away : swing;
        swings = INT_MAX;
        run_velocity = 400.0;
        run_acceleration = 0.5;
        run_position = bus.position;
        bench_power(true);
        int with_torque = 0;
        while (bench_info().state == CM1E_AXIS_DISABLED && with_torque < 3000) {
            bench_cycles(1);
            TEST_ASSERT_FALSE(cm1e_axis_powered(axis));
            with_torque += bus.state == OPERATION_ENABLED;
        }
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_ERROR_STOP, bench_info().state);
        TEST_ASSERT_EQUAL_INT(runs && monitored ? CM1E_ERROR_AXIS_LAG : CM1E_ERROR_AXIS_NOT_AT_REST, bench_info().error);
        TEST_ASSERT_LESS_THAN_INT(runs && monitored ? 500 : 2150, with_torque);
        bench_cycles(runs ? 80 : 5);
        TEST_ASSERT_NOT_EQUAL_INT(OPERATION_ENABLED, bus.state);
        bus.world = NULL;
    }
}

static double load_position, load_velocity; /* counts and ms */

/** A load that is so heavy that all of the torque takes 300 ms for what it has; the servo is damped. */
static void heavy_load(cm1e_bus_t *motor)
{
    const double most = 3.0, pull = 0.05 * (motor->target_position - load_position) - 0.4 * load_velocity;
    if (motor->state == OPERATION_ENABLED)
        load_velocity += fmax(-most, fmin(pull, most));
    load_position += load_velocity;
    motor->position = (int32_t)load_position;
    motor->velocity_raw = (int32_t)(1000.0 * load_velocity);
}

/** A motor that its load turns faster than its axis may be, or too fast for its ramp: its servo brakes it as hard as it
 *  can, and does not pull it back so. */
static void test_a_motor_that_is_too_fast_to_be_caught_is_held_where_it_turns_round(void)
{
    for (int n = 0; n < 8; n++) {
        const double sign = n & 1 ? -1.0 : 1.0;
        bench_start();
        bench_cycles(5);
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_write_parameter(axis, CM1E_PARAMETER_ENABLE_POS_LAG_MONITORING, false));
        load_position = bus.position;
        const double speed = 600.0 + 100.0 * n;
        load_velocity = sign * speed;
        bus.world = heavy_load;
        bench_power(true);
        int cycles = 0;
        double back = 0.0;
        while (!cm1e_axis_powered(axis) && cycles++ < 3000) {
            bench_cycles(1);
            back = fmin(back, sign * load_velocity);
        }
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
        TEST_ASSERT_TRUE(back > -0.25 * speed);
        TEST_ASSERT_LESS_THAN_INT(1000, cycles);
        bus.world = NULL;
    }
}

/** The motor would go on with its last velocity. */
static void test_the_ramp_of_an_error_by_velocity_ends_also_where_every_cycle_is_late(void)
{
    by_velocity_within(50.0);
    bench_move_velocity(10.0);
    bench_cycles(400);
    cm1e_axis_fail(axis, CM1E_ERROR_PROGRAM, 0.0, 0.0);
    int cycles = 0, velocity = 0;
    for (; cycles < 1000 && bus.state == OPERATION_ENABLED; cycles++) {
        velocity = bus.velocity_raw;
        bench_inputs();
        cm1e_axis_hold_cycle(axis, 1);
        bench_outputs();
    }
    TEST_ASSERT_LESS_THAN_INT(300, cycles);
    TEST_ASSERT_INT_WITHIN(5000, 0, velocity); /* while it had its torque */
}

/** No torque comes by a frame that is late, and the error says so. */
static void test_where_every_cycle_is_late_no_drive_gets_its_torque(void)
{
    bench_start();
    bench_power(true);
    for (int n = 0; n < 2100 && bench_info().state == CM1E_AXIS_DISABLED; n++) {
        bench_inputs();
        cm1e_axis_after_pause(axis, 4000000);
        bench_outputs();
        TEST_ASSERT_NOT_EQUAL_INT(OPERATION_ENABLED, bus.state);
    }
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_ERROR_STOP, bench_info().state);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_DRIVE_ENABLE_TIMEOUT, bench_info().error);
    bench_told("every cycle was too late to command it");
}

/** A pause took the set velocity away, and the torque was to stay until the motor has had time to brake. A drive that
 *  ends it meanwhile ends that time too: a motor that rests does not wait for it when it gets its torque again. */
static void test_the_time_to_brake_ends_with_the_torque(void)
{
    bench_enable();
    bench_move_velocity(10.0);
    bench_cycles(400);
    bench_start_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_STOP});
    bench_inputs();
    cm1e_axis_after_pause(axis, 8 * cycle_ns);
    bench_outputs();
    bench_cycles(10);
    fake_bus_fault(&bus, 0x2310);
    bench_cycles(5);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_DRIVE_FAULT, bench_info().error);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_reset(axis));
    bench_cycles(30);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_motor_that_does_not_follow_ends_in_error_stop);
    RUN_TEST(test_a_motor_that_does_not_follow_has_20_ms_to_brake);
    RUN_TEST(test_an_axis_brakes_from_the_velocity_of_its_motor);
    RUN_TEST(test_lag_in_the_ramp_to_disabled_is_an_error_whenever_power_comes_again);
    RUN_TEST(test_a_lost_bus_leaves_the_torque_for_the_ramp_and_20_ms);
    RUN_TEST(test_a_silence_slows_an_axis_only_near_its_maximum_velocity);
    RUN_TEST(test_a_motor_that_does_not_rest_when_it_gets_its_torque_is_let_go);
    RUN_TEST(test_where_every_cycle_is_late_no_drive_gets_its_torque);
    RUN_TEST(test_the_ramp_of_an_error_by_velocity_ends_also_where_every_cycle_is_late);
    RUN_TEST(test_a_motor_that_is_too_fast_to_be_caught_is_held_where_it_turns_round);
    RUN_TEST(test_bus_trouble_while_moving_holds_the_target_then_disables);
    RUN_TEST(test_a_motor_that_runs_away_loses_its_torque);
    RUN_TEST(test_bus_trouble_while_moving_by_velocity_ramps_down_blindly);
    RUN_TEST(test_a_motor_that_was_offline_in_the_ramp_brakes_from_where_it_is);
    RUN_TEST(test_a_motion_by_velocity_goes_on_evenly_after_a_silence);
    RUN_TEST(test_correction_by_velocity_does_not_grow_with_the_pause);
    RUN_TEST(test_motion_that_a_pause_takes_beyond_a_limit_names_that_limit);
    RUN_TEST(test_motor_ahead_after_a_pause_is_judged_by_the_speed_that_it_had);
    RUN_TEST(test_the_time_to_brake_ends_with_the_torque);
    RUN_TEST(test_torque_stays_while_the_motor_turns_for_two_seconds_at_most);
    RUN_TEST(test_bus_trouble_while_disabled_is_no_error_until_enable);
    RUN_TEST(test_a_slave_that_was_away_is_no_longer_homed);
    return UNITY_END();
}
