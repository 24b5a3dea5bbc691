/* Motion of the axis: enabling, positions without loss, wrap-around, directions, refused numbers, velocity mapping. */
#include <math.h>
#include <stdlib.h>

#include "../support/axis_bench.h"
#include "device/unit.h"

void setUp(void) { bench_start(); }
void tearDown(void) { bench_end(); }

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

static int world_cycle, untrue_cycle, untrue_counts;
static bool untrue_stays;

/* In one cycle the motor shows a position where it is not, or is shifted, as if it had turned fast. */
static void show_untrue(cm1e_bus_t *motor)
{
    const bool back = world_cycle == untrue_cycle + 1 && !untrue_stays;
    if (world_cycle == untrue_cycle || back)
        motor->position += back ? -untrue_counts : untrue_counts;
    const int per_s = cm1e_firmware_info(motor->firmware)->velocity_in_counts_per_ms ? 1 : 1000;
    motor->velocity_raw = world_cycle == untrue_cycle ? untrue_counts * per_s : back ? -untrue_counts * per_s : 0;
    world_cycle++;
}

/* A motor that turns is braked from its velocity; a velocity of one cycle is none. */
static void test_one_untrue_position_while_it_is_enabled_turns_nothing(void)
{
    for (int mapping = CM1E_MAPPING_DYNAMIC; mapping <= CM1E_MAPPING_PROFILE; mapping++)
        for (int run = 0; run < 2 * 2 * 12; run++) {
            fake_bus_init(&bus, (cm1e_mapping_t)mapping, CM1E_PDO_ORDER_UG_7_2, CM1E_FIRMWARE_1_3_5);
            bench_create();
            untrue_counts = run % 2 ? 900 : -900;
            untrue_stays = run / 2 % 2;
            untrue_cycle = run / 4;
            world_cycle = 0;
            bus.world = show_untrue;
            bench_power(true);
            for (int i = 0; i < 40; i++) {
                bench_cycles(1);
                TEST_ASSERT_EQUAL_DOUBLE(0.0, bench_info().set_velocity);
            }
            TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
            TEST_ASSERT_LESS_OR_EQUAL_INT64(900, bus.torque_step);
            bus.world = NULL;
        }
}

static void test_enable_after_the_shaft_was_turned_while_disabled(void)
{
    bench_enable();
    bench_wait(bench_move_to(3.0, 5.0), 3000);
    for (int round = 0; round < 5; round++) {
        bench_power(false);
        bench_cycles(20);
        const int per_s = cm1e_firmware_info(bus.firmware)->velocity_in_counts_per_ms ? 1 : 1000;
        const int turn = 3000 * (round % 2 ? -1 : 1);
        bus.velocity_raw = turn * per_s;
        for (int i = 0; i < 100; i++) { /* by hand, several turns */
            bus.position += turn;
            bench_cycles(1);
        }
        bus.velocity_raw = 0;
        const double there = bench_info().actual_position;
        bench_cycles(10); /* it is to rest for 20 ms */
        bench_enable();
        TEST_ASSERT_EQUAL_DOUBLE(there, bench_info().set_position);
    }
    TEST_ASSERT_LESS_OR_EQUAL_INT64(251, bus.torque_step); /* of the move alone: 5 u/s */
}

/* MC_Power asks this in every cycle, and does nothing more where it is true. Whatever changes the power ends it. */
static bool settled(void) { return cm1e_axis_power_settled(cm1e_axis_reference(axis), &owner, 7); }

static void settle(void)
{
    cm1e_axis_power_settle(axis, &owner, 7);
    TEST_ASSERT_TRUE(settled());
}

static void test_power_is_settled_only_as_long_as_nothing_changes(void)
{
    const AXIS_REF_t reference = cm1e_axis_reference(axis);
    const int other = 0;
    cm1e_axis_power_settle(axis, &owner, 7); /* it has no power */
    TEST_ASSERT_FALSE(settled());
    bench_enable();
    TEST_ASSERT_FALSE(settled());
    settle();
    bench_cycles(10);
    TEST_ASSERT_TRUE(settled());
    TEST_ASSERT_FALSE(cm1e_axis_power_settled(reference, &owner, 8));
    TEST_ASSERT_FALSE(cm1e_axis_power_settled(reference, &other, 7));
    TEST_ASSERT_FALSE(cm1e_axis_power_settled((AXIS_REF_t){0}, &owner, 7));
    cm1e_axis_power_settle(axis, &other, 8);
    TEST_ASSERT_TRUE(settled());
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_axis_power(axis, &owner, true, true, false));
    TEST_ASSERT_FALSE(settled());
    settle();
    bench_power(false);
    TEST_ASSERT_FALSE(settled());
    bench_cycles(50);
    cm1e_axis_power_settle(axis, &owner, 7);
    TEST_ASSERT_FALSE(settled());
    bench_enable();
    settle();
    (void)cm1e_axis_shut_down(axis);
    TEST_ASSERT_FALSE(settled());
}

static void test_power_is_settled_no_longer_without_torque(void)
{
    bench_enable();
    settle();
    bus.power = false;
    bench_cycles(5);
    TEST_ASSERT_FALSE(settled());
    bus.power = true;
    bench_cycles(5);
    TEST_ASSERT_FALSE(settled());
}

static void test_power_is_settled_no_longer_without_program(void)
{
    bench_enable();
    settle();
    cm1e_axis_lose_program(axis, "fast", 5000000);
    TEST_ASSERT_FALSE(settled());
    bench_told("task \"fast\" did not return within 5 ms");
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
        const cm1e_command_id_t id = bench_move_by(1.0 / 150000.0, 10.0);
        bench_wait(id, 200);
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 3000.0 / 150000.0, bench_info().set_position);
    for (int i = 0; i < 500; i++)
        bench_wait(bench_move_by(i % 2 ? -0.777777777 : 0.777777777, 49.0), 500);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 3000.0 / 150000.0, bench_info().set_position);
}

static void test_relative_adds_to_the_set_position_at_execution(void)
{
    bench_enable();
    bench_move_to(10.0, 10.0);
    bench_cycles(600);
    const double set = bench_info().set_position;
    TEST_ASSERT_TRUE(set > 1.0 && set < 9.0);
    bench_wait(bench_move_by(4.0, 10.0), 5000);
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
    bench_wait(bench_move_by(-1.0, 50.0), 10000);
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
                TEST_ASSERT_NOT_EQUAL_INT(CM1E_OK, bench_try_command(&rows[r]));
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
            TEST_ASSERT_EQUAL_INT(rows[r].error, bench_try_command(&command));
        }
    }
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(running));
    TEST_ASSERT_EQUAL_DOUBLE(5.0, bench_info().set_velocity);
}

static void test_maximum_values_are_accepted_as_zero_is(void)
{
    bench_enable();
    TEST_ASSERT_EQUAL_INT(CM1E_OK, bench_try_command(&(cm1e_axis_command_t){
                                       .kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = 5.0, .velocity = 50.0,
                                       .acceleration = 100.0, .deceleration = 100.0, .jerk = 2000.0}));
    TEST_ASSERT_EQUAL_INT(CM1E_OK, bench_try_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY,
                                                                     .velocity = -50.0}));
}

static void test_stops_take_the_maximum_where_more_is_asked(void)
{
    bench_enable();
    bench_move_velocity(10.0);
    bench_cycles(400);
    const cm1e_axis_command_t bad = {.kind = CM1E_COMMAND_HALT, .deceleration = NAN};
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_DYNAMICS_RANGE, bench_try_command(&bad));
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

static double shaft;

static void cycle_with_shaft(void)
{
    shaft += bus.target_velocity_raw * 1e-3;
    bus.position = (int32_t)lround(shaft);
    bench_cycles(1);
}

/* After lost frames the target changes by what the largest acceleration changes it in a cycle, until it is the commanded
 * one again: a jump is as wrong as a target that stays behind. */
static void test_csv_target_comes_back_with_the_largest_acceleration_after_lost_frames(void)
{
    fake_bus_init(&bus, CM1E_MAPPING_CSV, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    bus.mode = bus.sdo_mode = CM1E_MODE_CSV;
    bench_create();
    bench_enable();
    shaft = bus.position;
    bench_start_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 20.0,
                                               .acceleration = 50.0});
    for (int i = 0; i < 200; i++)
        cycle_with_shaft();
    received = CM1E_ERROR_BUS_LOST;
    for (int i = 0; i < 2; i++)
        cycle_with_shaft();
    received = CM1E_OK;
    const double most = axis->limits.system.acceleration * 1e-3 * axis->position.scale;
    for (int i = 0; i < 60; i++) {
        const int32_t before = bus.target_velocity_raw;
        cycle_with_shaft();
        TEST_ASSERT_LESS_OR_EQUAL_INT32((int32_t)ceil(most), abs(bus.target_velocity_raw - before));
    }
    TEST_ASSERT_INT_WITHIN(most, lround(bench_info().set_velocity * axis->position.scale), bus.target_velocity_raw);
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
    bus.config.axes[0].software_limit_positive = 2.0;
    bus.config.axes[0].modulo_range = 0.5;
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_CONFIG, cm1e_axis_create(&made, &bus, 0, &diag));
    TEST_ASSERT_NOT_NULL(strstr(diag.text, "modulo axis"));
}

/* The compensation may need the motor's whole speed, and then nothing is left for a motion. */
static void test_a_compensation_of_backlash_at_the_motors_peak_speed_is_refused(void)
{
    cm1e_axis_t *made;
    cm1e_diag_t diag;
    fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    cm1e_axis_config_t *c = &bus.config.axes[0];
    c->backlash = 0.01;
    c->backlash_velocity = cm1e_unit_peak_velocity(c) / cm1e_unit_scale(c);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_CONFIG, cm1e_axis_create(&made, &bus, 0, &diag));
    TEST_ASSERT_NOT_NULL(strstr(diag.text, "backlash velocity"));
    c->backlash_velocity *= 0.99;
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_create(&made, &bus, 0, &diag));
    cm1e_axis_destroy(made);
}

/** A ramp that ends farther away than an axis can count: it ends ahead of the motor, and a motion after it takes over. */
static void test_halt_without_an_end_lies_ahead(void)
{
    static const double slow[] = {1e-9, 1e-18, 1e-25};
    for (size_t i = 0; i < sizeof slow / sizeof slow[0]; i++)
        for (int sign = -1; sign <= 1; sign += 2) {
            bench_end();
            setUp();
            bench_enable();
            bench_move_velocity(sign * 5.0);
            bench_cycles(500);
            bench_start_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_HALT, .deceleration = slow[i]});
            const double way = cm1e_position_minus(axis->setpoint.target, axis->setpoint.position);
            TEST_ASSERT_TRUE_MESSAGE(isfinite(way) && way * sign > 1e6, "the halt does not end ahead");
            bench_cycles(100);
            const cm1e_command_id_t id = bench_start_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_HALT});
            bench_wait(id, 2000);
            TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
        }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_enable_never_moves_also_with_a_turning_shaft);
    RUN_TEST(test_one_untrue_position_while_it_is_enabled_turns_nothing);
    RUN_TEST(test_enable_after_the_shaft_was_turned_while_disabled);
    RUN_TEST(test_power_is_settled_only_as_long_as_nothing_changes);
    RUN_TEST(test_power_is_settled_no_longer_without_torque);
    RUN_TEST(test_power_is_settled_no_longer_without_program);
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
    RUN_TEST(test_csv_mapping_moves_to_positions_with_a_loop_of_ours);
    RUN_TEST(test_csv_target_comes_back_with_the_largest_acceleration_after_lost_frames);
    RUN_TEST(test_configurations_that_contradict_themselves_are_refused);
    RUN_TEST(test_a_compensation_of_backlash_at_the_motors_peak_speed_is_refused);
    RUN_TEST(test_halt_without_an_end_lies_ahead);
    return UNITY_END();
}
