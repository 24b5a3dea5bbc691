/* Motion of the axis: positions without loss, wrap-around, limits, directions, lag, enabling, and random commands. */
#include <math.h>
#include <stdlib.h>

#include "../support/axis_bench.h"

static uint64_t run, seed;

void setUp(void)
{
    run = 0;
    bench_start();
}

void tearDown(void)
{
    if (Unity.CurrentTestFailed && run)
        printf("it was run %llu\n", (unsigned long long)run);
    bench_end();
}

static cm1e_error_t try_command(const cm1e_axis_command_t *command)
{
    cm1e_command_id_t id;
    return cm1e_axis_start(axis, command, &id);
}

static cm1e_command_id_t move_by(double distance, double velocity)
{
    return bench_start_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_RELATIVE, .position = distance,
                                                      .velocity = velocity});
}

/* ---- enabling ---------------------------------------------------------------------------------------------------- */

static void test_enable_never_moves_also_with_a_turning_shaft(void)
{
    static const int32_t positions[] = {0, 123456, INT32_MAX, INT32_MIN, INT32_MAX - 5, INT32_MIN + 5};
    static const int turns[] = {0, 40, -40, 2000, -2000};
    for (int mapping = CM1E_MAPPING_DYNAMIC; mapping <= CM1E_MAPPING_PROFILE; mapping++)
        for (size_t p = 0; p < 6; p++)
            for (size_t t = 0; t < 5; t++) {
                fake_bus_init(&bus, (cm1e_mapping_t)mapping, CM1E_PDO_ORDER_UG_7_2, CM1E_FIRMWARE_1_3_5);
                bus.position = positions[p];
                bench_create();
                bench_power(true);
                for (int i = 0; i < 40; i++) {
                    if (bus.state != OPERATION_ENABLED)
                        bus.position = (int32_t)((uint32_t)bus.position + (uint32_t)turns[t]);
                    bench_cycles(1);
                    if (mapping == CM1E_MAPPING_CSV && bus.state != OPERATION_ENABLED)
                        TEST_ASSERT_EQUAL_INT32(0, bus.target_velocity_raw);
                }
                TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
                TEST_ASSERT_LESS_OR_EQUAL_INT64(abs(turns[t]), bus.torque_step);
                TEST_ASSERT_EQUAL_DOUBLE(0.0, bench_info().set_velocity);
                TEST_ASSERT_EQUAL_DOUBLE(bench_info().actual_position, bench_info().set_position);
            }
}

static void test_enable_after_the_shaft_was_turned_while_disabled(void)
{
    bench_enable();
    bench_wait(bench_move_to(3.0, 5.0), 3000);
    for (int round = 0; round < 5; round++) {
        bench_power(false);
        bench_cycles(20);
        for (int i = 0; i < 100; i++) { /* by hand, several turns */
            bus.position += 3000 * (round % 2 ? -1 : 1);
            bench_cycles(1);
        }
        const double there = bench_info().actual_position;
        bench_enable();
        TEST_ASSERT_EQUAL_DOUBLE(there, bench_info().set_position);
    }
    TEST_ASSERT_LESS_OR_EQUAL_INT64(251, bus.torque_step); /* of the move alone: 5 u/s */
}

static void test_enable_waits_without_motor_power_and_ends_in_words(void)
{
    bus.power = false;
    bench_power(true);
    bench_cycles(2100);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_ERROR_STOP, bench_info().state);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_DRIVE_POWER, bench_info().error);
    char text[512];
    cm1e_axis_error_text(cm1e_axis_reference(axis), text, sizeof text);
    TEST_ASSERT_NOT_NULL(strstr(text, "24 V"));
}

/* ---- positions --------------------------------------------------------------------------------------------------- */

static void test_moves_end_exactly_and_in_time(void)
{
    bench_enable();
    static const double targets[] = {1.0, -1.0, 0.00002, 0.33333333333, 20.0, 20.0, 0.0};
    for (size_t i = 0; i < sizeof targets / sizeof targets[0]; i++) {
        const cm1e_command_id_t id = bench_move_to(targets[i], 10.0);
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_DISCRETE_MOTION, bench_info().state);
        bench_wait(id, 10000);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(id));
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, targets[i], bench_info().set_position);
        TEST_ASSERT_EQUAL_DOUBLE(0.0, bench_info().set_velocity);
        bench_cycles(1);
        TEST_ASSERT_EQUAL_INT32(lround(targets[i] * 50000.0), bus.position);
    }
    TEST_ASSERT_LESS_OR_EQUAL_INT64(501, worst_step);
}

static void test_relative_moves_do_not_drift(void)
{
    bench_enable();
    for (int i = 0; i < 3000; i++) { /* a third of a count is left over each time */
        const cm1e_command_id_t id = move_by(1.0 / 150000.0, 10.0);
        bench_wait(id, 200);
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 3000.0 / 150000.0, bench_info().set_position);
    for (int i = 0; i < 500; i++)
        bench_wait(move_by(i % 2 ? -0.777777777 : 0.777777777, 49.0), 500);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 3000.0 / 150000.0, bench_info().set_position);
}

static void test_relative_adds_to_the_set_position_at_execution(void)
{
    bench_enable();
    bench_move_to(10.0, 10.0);
    bench_cycles(600);
    const double set = bench_info().set_position;
    TEST_ASSERT_TRUE(set > 1.0 && set < 9.0);
    bench_wait(move_by(4.0, 10.0), 5000);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, set + 4.0, bench_info().set_position);
    TEST_ASSERT_LESS_OR_EQUAL_INT64(7, worst_change);
}

static void test_counts_wrap_in_both_directions(void)
{
    for (int sign = -1; sign <= 1; sign += 2) {
        fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
        bus.position = sign > 0 ? INT32_MAX - 60000 : INT32_MIN + 60000;
        bench_create();
        bench_enable();
        const double start = bench_info().set_position;
        bench_wait(bench_move_to(start + sign * 5.0, 20.0), 5000);
        TEST_ASSERT_EQUAL_INT(CM1E_OK, bench_info().error);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, start + sign * 5.0, bench_info().actual_position);
        TEST_ASSERT_TRUE(sign > 0 ? bus.position < 0 : bus.position > 0); /* the device's did wrap */
        bench_wait(bench_move_to(start, 20.0), 5000);
        TEST_ASSERT_EQUAL_INT32(sign > 0 ? INT32_MAX - 60000 : INT32_MIN + 60000, bus.position);
        TEST_ASSERT_LESS_OR_EQUAL_INT64(1001, worst_step);
        TEST_ASSERT_LESS_OR_EQUAL_INT64(8, worst_change);
    }
}

static void test_turning_for_ever_passes_the_range_of_the_device_many_times(void)
{
    bench_enable();
    const cm1e_command_id_t id = bench_move_velocity(50.0);
    bench_cycles(4000); /* the range of 2^32 counts takes half an hour: everything is put forward by 30 days instead */
    const int64_t counts = INT64_C(86400) * 30 * 2500000;
    axis->setpoint.profile_cycles += INT64_C(86400000) * 30;
    axis->setpoint.profile_next_s += 86400.0 * 30;
    axis->setpoint.position.counts += counts;
    axis->position.actual_counts += counts;
    axis->drive.target.position = (int32_t)((uint32_t)axis->drive.target.position + (uint32_t)(uint64_t)counts);
    axis->drive.feedback.position = (int32_t)((uint32_t)axis->drive.feedback.position + (uint32_t)(uint64_t)counts);
    axis->position.raw = bus.position = (int32_t)((uint32_t)bus.position + (uint32_t)(uint64_t)counts);
    const cm1e_image_slot_t target = fake_find(&bus.rx, OBJ_607A_TARGET_POSITION);
    cm1e_put_u32(bus.outputs + target.offset, (uint32_t)(uint64_t)axis->setpoint.position.counts);
    bench_cycles(1);
    bench_forget_steps();
    bench_cycles(5000);
    TEST_ASSERT_EQUAL_INT64(2500, worst_step); /* exactly 2,500,000 counts/s, no jitter after 30 days */
    TEST_ASSERT_TRUE(cm1e_axis_command_status(axis, id).reached);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, bench_info().error);
    const double there = bench_info().set_position;
    bench_wait(move_by(-1.0, 50.0), 10000);
    TEST_ASSERT_DOUBLE_WITHIN(1e-7, there - 1.0, bench_info().set_position);
}

static void test_units_and_inverted_direction(void)
{
    bus.config.axes[0].counts_per_unit = 1234.5; /* mm, say */
    bus.config.axes[0].invert = true;
    bench_create();
    bench_enable();
    bench_wait(bench_move_to(100.0, 200.0), 10000);
    bench_cycles(1);
    TEST_ASSERT_EQUAL_INT32(-123450, bus.position);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 100.0, bench_info().actual_position);
    bus.velocity_raw = -12345;
    bench_cycles(1);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 10.0, bench_info().actual_velocity);
    bench_move_velocity(10.0);
    bench_cycles(500);
    TEST_ASSERT_TRUE(bus.position < -123450);
    TEST_ASSERT_EQUAL_DOUBLE(10.0, bench_info().set_velocity);
}

/* ---- refusals ---------------------------------------------------------------------------------------------------- */

static void test_bad_numbers_are_refused_and_change_nothing(void)
{
    bench_enable();
    const cm1e_command_id_t running = bench_move_velocity(5.0);
    bench_cycles(300);
    static const cm1e_command_kind_t kinds[] = {CM1E_COMMAND_MOVE_ABSOLUTE, CM1E_COMMAND_MOVE_RELATIVE,
                                                CM1E_COMMAND_MOVE_VELOCITY};
    static const double bad[] = {NAN, INFINITY, -INFINITY};
    for (int k = 0; k < 3; k++) {
        const bool velocity = kinds[k] == CM1E_COMMAND_MOVE_VELOCITY;
        for (int i = 0; i < 3; i++) {
            const cm1e_axis_command_t rows[] = {
                {.kind = kinds[k], .position = velocity ? 0.0 : bad[i], .velocity = velocity ? bad[i] : 1.0},
                {.kind = kinds[k], .velocity = bad[i]},
                {.kind = kinds[k], .velocity = 1.0, .acceleration = bad[i]},
                {.kind = kinds[k], .velocity = 1.0, .deceleration = bad[i]},
                {.kind = kinds[k], .velocity = 1.0, .jerk = bad[i]},
            };
            for (int r = 0; r < 5; r++)
                TEST_ASSERT_NOT_EQUAL_INT(CM1E_OK, try_command(&rows[r]));
        }
        const struct {
            cm1e_axis_command_t command;
            cm1e_error_t error;
        } rows[] = {
            {{.velocity = 0.0}, CM1E_ERROR_AXIS_VELOCITY_RANGE},
            {{.velocity = 50.001}, CM1E_ERROR_AXIS_VELOCITY_RANGE},
            {{.velocity = -1.0}, velocity ? CM1E_OK : CM1E_ERROR_AXIS_VELOCITY_RANGE},
            {{.velocity = 1.0, .acceleration = -1.0}, CM1E_ERROR_AXIS_DYNAMICS_RANGE},
            {{.velocity = 1.0, .acceleration = 100.01}, CM1E_ERROR_AXIS_DYNAMICS_RANGE},
            {{.velocity = 1.0, .deceleration = 100.01}, CM1E_ERROR_AXIS_DYNAMICS_RANGE},
            {{.velocity = 1.0, .jerk = 2000.1}, CM1E_ERROR_AXIS_DYNAMICS_RANGE},
            {{.velocity = 1.0, .direction = mcShortestWay}, velocity ? CM1E_ERROR_AXIS_DIRECTION : CM1E_OK},
            {{.velocity = 1.0, .direction = (MC_DIRECTION)9}, velocity ? CM1E_ERROR_AXIS_DIRECTION : CM1E_OK},
            {{.velocity = 1.0, .position = 1e12}, velocity ? CM1E_OK : CM1E_ERROR_AXIS_POSITION_RANGE},
            {{.velocity = 1.0, .position = -1e300}, velocity ? CM1E_OK : CM1E_ERROR_AXIS_POSITION_RANGE},
        };
        for (size_t r = 0; r < sizeof rows / sizeof rows[0]; r++) {
            if (rows[r].error == CM1E_OK)
                continue;
            cm1e_axis_command_t command = rows[r].command;
            command.kind = kinds[k];
            TEST_ASSERT_EQUAL_INT(rows[r].error, try_command(&command));
        }
    }
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(running));
    TEST_ASSERT_EQUAL_DOUBLE(5.0, bench_info().set_velocity);
}

static void test_maximum_values_are_accepted_as_zero_is(void)
{
    bench_enable();
    TEST_ASSERT_EQUAL_INT(CM1E_OK, try_command(&(cm1e_axis_command_t){
                                       .kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = 5.0, .velocity = 50.0,
                                       .acceleration = 100.0, .deceleration = 100.0, .jerk = 2000.0}));
    TEST_ASSERT_EQUAL_INT(CM1E_OK, try_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY,
                                                                     .velocity = -50.0}));
}

static void test_stops_take_the_maximum_where_more_is_asked(void)
{
    bench_enable();
    bench_move_velocity(10.0);
    bench_cycles(400);
    const cm1e_axis_command_t bad = {.kind = CM1E_COMMAND_HALT, .deceleration = NAN};
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_DYNAMICS_RANGE, try_command(&bad));
    const cm1e_command_id_t id = bench_start_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_HALT,
                                                                            .deceleration = 1e9, .jerk = 1e9});
    const int n = bench_wait(id, 1000);
    TEST_ASSERT_INT_WITHIN(5, 150, n); /* 10/100 s and the jerk's 100/2000 s */
    TEST_ASSERT_LESS_OR_EQUAL_INT64(7, worst_change);
}

/* ---- velocity ---------------------------------------------------------------------------------------------------- */

static void test_velocity_signs_and_directions(void)
{
    static const struct {
        MC_DIRECTION direction;
        double velocity, expected;
    } rows[] = {
        {(MC_DIRECTION)0, 3.0, 3.0},       {mcPositiveDirection, 3.0, 3.0},  {mcPositiveDirection, -3.0, -3.0},
        {mcNegativeDirection, 3.0, -3.0},  {mcNegativeDirection, -3.0, 3.0}, {mcCurrentDirection, 2.0, 2.0},
        {mcNegativeDirection, 3.0, -3.0},  {mcCurrentDirection, 2.0, -2.0},
    };
    bench_enable();
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        const cm1e_command_id_t id = bench_start_command(&(cm1e_axis_command_t){
            .kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = rows[i].velocity, .direction = rows[i].direction});
        TEST_ASSERT_FALSE(cm1e_axis_command_status(axis, id).reached);
        bench_cycles(500);
        const cm1e_command_status_t status = cm1e_axis_command_status(axis, id);
        TEST_ASSERT_TRUE(status.reached);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, status.state);
        TEST_ASSERT_EQUAL_DOUBLE(rows[i].expected, bench_info().set_velocity);
        TEST_ASSERT_EQUAL_DOUBLE(0.0, bench_info().set_acceleration);
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_CONTINUOUS_MOTION, bench_info().state);
    }
    TEST_ASSERT_LESS_OR_EQUAL_INT64(7, worst_change);
}

/* ---- software limits --------------------------------------------------------------------------------------------- */

static void with_limits(double negative, double positive)
{
    bus.config.axes[0].software_limit_negative = negative;
    bus.config.axes[0].software_limit_positive = positive;
    bench_create();
    bench_enable();
}

static void test_targets_outside_the_limits_are_refused_inside_accepted(void)
{
    with_limits(-2.0, 3.0);
    static const struct {
        double target;
        cm1e_error_t error;
    } rows[] = {{3.0, CM1E_OK}, {-2.0, CM1E_OK}, {3.0001, CM1E_ERROR_AXIS_POSITION_RANGE},
                {-2.0001, CM1E_ERROR_AXIS_POSITION_RANGE}, {1e9, CM1E_ERROR_AXIS_POSITION_RANGE}, {0.0, CM1E_OK}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        const cm1e_axis_command_t command = {.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = rows[i].target,
                                             .velocity = 20.0};
        TEST_ASSERT_EQUAL_INT(rows[i].error, try_command(&command));
        bench_cycles(3000);
    }
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE,
                          try_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_RELATIVE, .position = 3.01,
                                                             .velocity = 1.0}));
}

static void test_a_retarget_that_would_overshoot_a_limit_is_refused(void)
{
    with_limits(-2.0, 10.0);
    const cm1e_command_id_t running = bench_move_to(9.9, 20.0);
    while (bench_info().set_position < 7.0)
        bench_cycles(1);
    /* turning round with a low deceleration would run far beyond 10 */
    const cm1e_axis_command_t soft = {.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = 0.0, .velocity = 20.0,
                                      .deceleration = 5.0};
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, try_command(&soft));
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
            with_limits(-20.0, 20.0);
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
    with_limits(-2.0, 3.0);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE,
                          try_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = 10.1,
                                                             .velocity = 1.0}));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE,
                          try_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 1.0}));
    const cm1e_command_id_t id = bench_move_to(5.0, 10.0); /* still outside, but nearer */
    bench_wait(id, 3000);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(id));
    const cm1e_command_id_t velocity = bench_move_velocity(-1.0);
    bench_cycles(3000);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(velocity));
    TEST_ASSERT_EQUAL_INT(CM1E_OK, bench_info().error);
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
                              try_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_RELATIVE, .position = bad,
                                                                 .velocity = 1.0}));
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_DIRECTION_DISABLED,
                              try_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY,
                                                                 .velocity = bad}));
        const cm1e_command_id_t good = move_by(-bad, 5.0);
        bench_wait(good, 2000);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(good));
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
    static const cm1e_axis_command_t small[] = {
        {.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = 1.0, .velocity = 1e-300},
        {.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = 1.0, .velocity = 1.0, .acceleration = 1e-300},
        {.kind = CM1E_COMMAND_MOVE_RELATIVE, .position = 1.0, .velocity = 1.0, .jerk = 1e-300},
        {.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 1.0, .acceleration = 1e-300},
    };
    for (size_t i = 0; i < sizeof small / sizeof small[0]; i++) {
        TEST_ASSERT_NOT_EQUAL_INT(CM1E_OK, cm1e_axis_start(axis, &small[i], &id));
        bench_told("too small to compute with");
    }
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
    bench_told("MC_MoveVelocity, running or waiting, was ended: motion in this direction is disabled");
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_DISCRETE_MOTION, bench_info().state);
    bench_cycles(20);
    const cm1e_command_id_t back = move_by(-3.0, 10.0); /* while it still brakes */
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

/** In the cycle the axis is in ErrorStop, and a while later without torque; with the bus back nothing moves by itself. */
static void lose_the_bus(cm1e_error_t error, bool back_early, cm1e_command_id_t id)
{
    received = error;
    bench_cycles(2); /* two lost frames are nothing */
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_CONTINUOUS_MOTION, bench_info().state);
    health = error;
    bench_cycles(1);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_ERROR_STOP, bench_info().state);
    TEST_ASSERT_EQUAL_INT(error, bench_info().error);
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

static void test_bus_trouble_while_moving_by_velocity_ramps_down_blindly(void)
{
    for (int back = 0; back < 2; back++) {
        fake_bus_init(&bus, CM1E_MAPPING_CSV, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
        bus.mode = bus.sdo_mode = CM1E_MODE_CSV;
        bus.world = turn;
        csv_shaft = csv_worst_change = csv_velocity_before = 0;
        bench_create();
        bench_enable();
        const cm1e_command_id_t id = bench_move_velocity(10.0);
        bench_cycles(500);
        TEST_ASSERT_INT32_WITHIN(1000, 500000, bus.target_velocity_raw);
        lose_the_bus(CM1E_ERROR_BUS_LOST, back, id);
        TEST_ASSERT_LESS_OR_EQUAL_INT32(5200, csv_worst_change); /* 5,000,000 counts/s2, and the position loop */
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

/* ---- velocity mapping -------------------------------------------------------------------------------------------- */

static void test_csv_mapping_moves_to_positions_with_a_loop_of_ours(void)
{
    fake_bus_init(&bus, CM1E_MAPPING_CSV, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    bus.mode = bus.sdo_mode = CM1E_MODE_CSV;
    bench_create();
    bench_enable();
    double shaft = bus.position;
    const cm1e_command_id_t id = bench_move_to(4.0, 10.0);
    for (int i = 0; i < 3000; i++) {
        shaft += bus.target_velocity_raw * 1e-3;
        bus.position = (int32_t)lround(shaft);
        bench_cycles(1);
    }
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(id));
    TEST_ASSERT_INT_WITHIN(2, 200000, bus.position);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, bench_info().error);
}

/* ---- configuration ----------------------------------------------------------------------------------------------- */

static void test_configurations_that_contradict_themselves_are_refused(void)
{
    cm1e_axis_t *made;
    cm1e_diag_t diag;
    const double bad[] = {-1.0, NAN, INFINITY};
    for (int i = 0; i < 3; i++)
        for (int field = 0; field < 9; field++) {
            fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
            cm1e_axis_config_t *c = &bus.config.axes[0];
            double *fields[] = {&c->counts_per_unit, &c->max_velocity, &c->max_acceleration, &c->max_deceleration,
                                &c->max_jerk, &c->max_position_lag, &c->in_position_window, &c->in_position_time_s,
                                &c->in_position_timeout_s};
            *fields[field] = bad[i];
            TEST_ASSERT_EQUAL_INT(CM1E_ERROR_CONFIG, cm1e_axis_create(&made, &bus, 0, &diag));
            TEST_ASSERT_NULL(made);
        }
    fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    bus.config.axes[0].software_limit_negative = 1.0;
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_CONFIG, cm1e_axis_create(&made, &bus, 0, &diag));
    TEST_ASSERT_NOT_NULL(strstr(diag.text, "software limit"));
}

/* ---- random commands --------------------------------------------------------------------------------------------- */

static double uniform(double low, double high)
{
    seed ^= seed << 13;
    seed ^= seed >> 7;
    seed ^= seed << 17;
    return low + (high - low) * (double)(seed >> 11) / 9007199254740992.0;
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
    with_limits(-5.0, 5.0);
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
    for (run = 1; run <= 30; run++) {
        seed = run * UINT64_C(0x9E3779B97F4A7C15);
        bench_start();
        random_run();
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_enable_never_moves_also_with_a_turning_shaft);
    RUN_TEST(test_enable_after_the_shaft_was_turned_while_disabled);
    RUN_TEST(test_enable_waits_without_motor_power_and_ends_in_words);
    RUN_TEST(test_moves_end_exactly_and_in_time);
    RUN_TEST(test_relative_moves_do_not_drift);
    RUN_TEST(test_relative_adds_to_the_set_position_at_execution);
    RUN_TEST(test_counts_wrap_in_both_directions);
    RUN_TEST(test_turning_for_ever_passes_the_range_of_the_device_many_times);
    RUN_TEST(test_units_and_inverted_direction);
    RUN_TEST(test_bad_numbers_are_refused_and_change_nothing);
    RUN_TEST(test_maximum_values_are_accepted_as_zero_is);
    RUN_TEST(test_stops_take_the_maximum_where_more_is_asked);
    RUN_TEST(test_velocity_signs_and_directions);
    RUN_TEST(test_targets_outside_the_limits_are_refused_inside_accepted);
    RUN_TEST(test_a_retarget_that_would_overshoot_a_limit_is_refused);
    RUN_TEST(test_velocity_into_a_limit_is_braked_before_it);
    RUN_TEST(test_a_stop_without_limit_of_jerk_never_swings_back);
    RUN_TEST(test_a_stop_that_is_taken_over_at_once_makes_no_step);
    RUN_TEST(test_a_move_back_inside_is_taken_while_braking_without_limit_of_jerk);
    RUN_TEST(test_an_axis_outside_its_limits_may_only_come_back);
    RUN_TEST(test_motion_in_a_disabled_direction_is_refused);
    RUN_TEST(test_refused_numbers_are_told_as_they_are_judged);
    RUN_TEST(test_direction_disabled_while_running_stops_the_motion);
    RUN_TEST(test_a_reversal_into_a_direction_disabled_meanwhile_is_stopped);
    RUN_TEST(test_a_direction_that_a_motion_does_not_need_may_be_disabled);
    RUN_TEST(test_a_motor_that_does_not_follow_ends_in_error_stop);
    RUN_TEST(test_a_motor_that_does_not_follow_has_20_ms_to_brake);
    RUN_TEST(test_lag_in_the_ramp_to_disabled_is_an_error_whenever_power_comes_again);
    RUN_TEST(test_a_lost_bus_leaves_the_torque_for_the_ramp_and_20_ms);
    RUN_TEST(test_bus_trouble_while_moving_holds_the_target_then_disables);
    RUN_TEST(test_bus_trouble_while_moving_by_velocity_ramps_down_blindly);
    RUN_TEST(test_bus_trouble_while_disabled_is_no_error_until_enable);
    RUN_TEST(test_a_slave_that_was_away_is_no_longer_homed);
    RUN_TEST(test_csv_mapping_moves_to_positions_with_a_loop_of_ours);
    RUN_TEST(test_configurations_that_contradict_themselves_are_refused);
    RUN_TEST(test_random_commands_keep_every_limit);
    return UNITY_END();
}
