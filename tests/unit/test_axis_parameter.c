/* Parameters of table 5, and MC_SetPosition. */
#include "axis/axis_parameters.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../support/axis_bench.h"
#include "../support/xorshift.h"

static uint64_t seed;

static uint64_t draw(uint64_t below)
{
    return (xorshift(&seed) >> 11) % below;
}

static double uniform(double low, double high) { return low + (high - low) * (double)draw(1 << 30) / (1 << 30); }

void setUp(void)
{
    const char *given = getenv("CM1E_TEST_SEED");
    seed = given ? strtoull(given, NULL, 0) : 0x5EED0004;
    bench_start();
}
void tearDown(void)
{
    if (Unity.CurrentTestFailed)
        printf("CM1E_TEST_SEED=0x%llx\n", (unsigned long long)seed);
    bench_end();
}

static double parameter(int number)
{
    double value;
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_read_parameter(axis, number, &value));
    return value;
}

static void set(int number, double value)
{
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_write_parameter(axis, number, value));
    TEST_ASSERT_EQUAL_DOUBLE(value, parameter(number));
}

/* Refused, said why, and nothing changed. */
static void refused(int number, double value, cm1e_error_t error)
{
    double before, after;
    (void)cm1e_axis_read_parameter(axis, number, &before);
    TEST_ASSERT_EQUAL_INT(error, cm1e_axis_write_parameter(axis, number, value));
    (void)cm1e_axis_read_parameter(axis, number, &after);
    TEST_ASSERT_EQUAL_DOUBLE(before, after);
    char text[300];
    cm1e_axis_error_text(cm1e_axis_reference(axis), text, sizeof text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, "parameter "), text);
}

static cm1e_error_t start(const cm1e_axis_command_t *command)
{
    cm1e_command_id_t id;
    return cm1e_axis_start(axis, command, &id);
}

/* ---- table 5 ----------------------------------------------------------------------------------------------------- */

static void test_limits_that_are_not_set_are_0(void)
{
    TEST_ASSERT_EQUAL_DOUBLE(0.0, parameter(CM1E_PARAMETER_SW_LIMIT_POS));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, parameter(CM1E_PARAMETER_SW_LIMIT_NEG));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, parameter(CM1E_PARAMETER_ENABLE_LIMIT_POS));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, parameter(CM1E_PARAMETER_ENABLE_LIMIT_NEG));
}

static void test_every_number_of_the_table_can_be_read_and_no_other(void)
{
    double value;
    for (int number = -40; number < 1000; number++) {
        const bool there = number >= 1 && number <= 17;
        TEST_ASSERT_EQUAL_INT(there ? CM1E_OK : CM1E_ERROR_AXIS_PARAMETER,
                              cm1e_axis_read_parameter(axis, number, &value));
        TEST_ASSERT_EQUAL_INT(number >= 4 && number <= 6, cm1e_axis_parameter_is_bool(number));
        if (!there)
            refused(number, 1, CM1E_ERROR_AXIS_PARAMETER);
    }
    TEST_ASSERT_EQUAL_DOUBLE(50, parameter(8));
    TEST_ASSERT_EQUAL_DOUBLE(50, parameter(9));
    TEST_ASSERT_EQUAL_DOUBLE(100, parameter(12));
    TEST_ASSERT_EQUAL_DOUBLE(2000, parameter(16));
    TEST_ASSERT_EQUAL_DOUBLE(0.5, parameter(7));
    TEST_ASSERT_EQUAL_DOUBLE(0, parameter(4));
    TEST_ASSERT_EQUAL_DOUBLE(1, parameter(6));
}

static void test_in_position_by_number(void)
{
    double value;
    for (int number = 1790; number < 1810; number++) {
        const bool there = number >= 1800 && number <= 1804;
        TEST_ASSERT_EQUAL_INT(there ? CM1E_OK : CM1E_ERROR_AXIS_PARAMETER,
                              cm1e_axis_read_parameter(axis, number, &value));
        TEST_ASSERT_EQUAL_INT(number == 1800 || number == 1804, cm1e_axis_parameter_is_bool(number));
        TEST_ASSERT_EQUAL_INT(!there, cm1e_axis_parameter_is_object(number));
    }
    TEST_ASSERT_EQUAL_DOUBLE(0, parameter(1800));
    bench_enable();
    bench_cycles(30);
    TEST_ASSERT_EQUAL_DOUBLE(1, parameter(1800));
    TEST_ASSERT_EQUAL_DOUBLE(0.0002, parameter(1801));
    TEST_ASSERT_EQUAL_DOUBLE(0.02, parameter(1802));
    TEST_ASSERT_EQUAL_DOUBLE(2, parameter(1803));
    TEST_ASSERT_EQUAL_DOUBLE(0, parameter(1804));
    refused(1801, 1e-6, CM1E_ERROR_AXIS_PARAMETER_RANGE);
    refused(1802, 2, CM1E_ERROR_AXIS_PARAMETER_RANGE); /* the timeout */
    bench_told("0.001 ... 2 s is right");
    refused(1802, NAN, CM1E_ERROR_AXIS_PARAMETER_RANGE);
    refused(1803, 0.02, CM1E_ERROR_AXIS_PARAMETER_RANGE); /* the time */
    refused(1803, 3601, CM1E_ERROR_AXIS_PARAMETER_RANGE);
    bench_told("InPositionTimeout");
    refused(1804, 0.5, CM1E_ERROR_AXIS_PARAMETER_RANGE);
    set(1803, 3600);
    set(1802, 10);
    set(1802, 0.1);
    set(1803, 0.5);
    set(1801, 0.01);
    set(1804, 1);
    bus.blocked = true;
    const cm1e_command_id_t id = bench_move_to(0.011, 5);
    bench_cycles(300);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(id));
    set(1801, 0.011);
    bench_cycles(102);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(id));
    const cm1e_command_id_t next = bench_move_to(0.1, 5);
    bench_cycles(300);
    set(1804, 0); /* waits no longer */
    bench_cycles(1);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(next));
}

static void test_what_only_can_be_read_is_not_written(void)
{
    static const int numbers[] = {1, 8, 10, 11, 12, 14, 16, 1800};
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++)
        refused(numbers[i], 1, CM1E_ERROR_AXIS_PARAMETER_READ_ONLY);
}

static void test_position_and_velocities_follow_the_axis(void)
{
    bench_enable();
    bench_move_velocity(-3);
    bench_cycles(200);
    const cm1e_axis_info_t info = bench_info();
    TEST_ASSERT_EQUAL_DOUBLE(info.set_position, parameter(1));
    TEST_ASSERT_EQUAL_DOUBLE(-3, parameter(11));
    bus.velocity_raw = -150000;
    bench_cycles(2);
    TEST_ASSERT_EQUAL_DOUBLE(-3, parameter(10));
    received = health = CM1E_ERROR_BUS_LOST;
    bench_cycles(1);
    double value;
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_OFFLINE, cm1e_axis_read_parameter(axis, 10, &value));
}

static void test_values_out_of_range_are_refused(void)
{
    static const double nonsense[] = {NAN, INFINITY, -INFINITY, -1, 1e300, -1e300};
    static const int numbers[] = {7, 9, 13, 15, 17};
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        const int number = numbers[i];
        for (size_t k = 0; k < sizeof nonsense / sizeof nonsense[0]; k++)
            refused(number, nonsense[k], CM1E_ERROR_AXIS_PARAMETER_RANGE);
        refused(number, 0, CM1E_ERROR_AXIS_PARAMETER_RANGE);
        if (number != 7)
            refused(number, parameter(number - 1) * 1.000001, CM1E_ERROR_AXIS_PARAMETER_RANGE);
        set(number, parameter(number) / 2);
        set(number, parameter(number) * 2);
    }
    for (int number = 2; number <= 3; number++)
        for (int k = 0; k < 3; k++)
            refused(number, nonsense[k], CM1E_ERROR_AXIS_PARAMETER_RANGE);
    for (int number = 4; number <= 6; number++) {
        refused(number, 0.5, CM1E_ERROR_AXIS_PARAMETER_RANGE);
        refused(number, NAN, CM1E_ERROR_AXIS_PARAMETER_RANGE);
        refused(number, 2, CM1E_ERROR_AXIS_PARAMETER_RANGE);
        bench_told(": 2 was given; 0 or 1 is right.");
    }
}

static void test_maxima_of_the_application_bound_the_next_commands(void)
{
    bench_enable();
    bench_move_velocity(20);
    bench_cycles(600);
    set(9, 5);
    set(13, 10);
    set(15, 10);
    set(17, 200);
    bench_cycles(20);
    TEST_ASSERT_EQUAL_DOUBLE(20, bench_info().set_velocity); /* what runs goes on */
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_VELOCITY_RANGE,
                          start(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_RELATIVE, .velocity = 5.1}));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_DYNAMICS_RANGE, start(&(cm1e_axis_command_t){
        .kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 5, .deceleration = 11}));
    const cm1e_command_id_t id = bench_move_velocity(5);
    double before = bench_info().set_velocity;
    while (!cm1e_axis_command_status(axis, id).reached) {
        bench_cycles(1);
        TEST_ASSERT_TRUE(before - bench_info().set_velocity <= 10 * axis->cycle_s * (1 + 1e-9));
        before = bench_info().set_velocity;
    }
    TEST_ASSERT_EQUAL_DOUBLE(50, parameter(8));
    TEST_ASSERT_EQUAL_DOUBLE(100, parameter(14));
    TEST_ASSERT_EQUAL_DOUBLE(100, axis->limits.emergency.deceleration); /* an error brakes as before */
}

/* ---- software limits --------------------------------------------------------------------------------------------- */

static void test_each_software_limit_works_alone(void)
{
    bench_enable();
    set(2, 3);
    set(3, -2);
    cm1e_axis_command_t command = {.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = 4, .velocity = 10};
    set(4, 1);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, start(&command));
    command.position = -4;
    TEST_ASSERT_EQUAL_INT(CM1E_OK, start(&command));
    bench_cycles(2000);
    set(5, 1); /* it stands outside: it may come back and go no farther */
    command.position = -5;
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, start(&command));
    command.position = 1;
    TEST_ASSERT_EQUAL_INT(CM1E_OK, start(&command));
    bench_cycles(2000);
    set(4, 0);
    command.position = -3;
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, start(&command));
    command.position = 20;
    TEST_ASSERT_EQUAL_INT(CM1E_OK, start(&command));
    bench_cycles(4000);
    TEST_ASSERT_EQUAL_DOUBLE(20, bench_info().set_position);
    set(5, 0);
    command.position = -20;
    TEST_ASSERT_EQUAL_INT(CM1E_OK, start(&command));
}

static void test_limits_in_the_wrong_order_are_refused(void)
{
    set(2, -1);
    set(3, 1);
    set(4, 1);
    refused(5, 1, CM1E_ERROR_AXIS_PARAMETER_RANGE);
    bench_told("has to be below SWLimitPos");
    set(3, -2);
    set(5, 1);
    refused(3, -1, CM1E_ERROR_AXIS_PARAMETER_RANGE);
    refused(2, -2, CM1E_ERROR_AXIS_PARAMETER_RANGE);
}

static void test_configured_limits_show_as_parameters(void)
{
    bus.config.axes[0].software_limit_positive = 5;
    bus.config.axes[0].software_limit_negative = -INFINITY;
    bench_create();
    TEST_ASSERT_EQUAL_DOUBLE(5, parameter(2));
    TEST_ASSERT_EQUAL_DOUBLE(1, parameter(4));
    TEST_ASSERT_EQUAL_DOUBLE(0, parameter(5));
}

static void test_limit_inside_the_way_of_a_motion_is_refused(void)
{
    bench_enable();
    set(4, 1 * (parameter(2) > 0)); /* nothing yet */
    set(2, 100);
    set(4, 1);
    const cm1e_command_id_t id = bench_move_to(10, 5);
    bench_cycles(500);
    refused(2, 9.9, CM1E_ERROR_AXIS_POSITION_RANGE);
    refused(2, 1, CM1E_ERROR_AXIS_POSITION_RANGE);
    set(2, 10);
    bench_wait(id, 5000);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(id));
    /* a velocity has no end: refused only where it is too late to brake, then it brakes before the limit */
    set(4, 0);
    bench_move_velocity(20);
    bench_cycles(600);
    const double now = bench_info().set_position;
    set(2, now + 1);
    refused(4, 1, CM1E_ERROR_AXIS_POSITION_RANGE);
    set(2, now + 3);
    set(4, 1);
    bench_cycles(500);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_ERROR_STOP, bench_info().state);
    TEST_ASSERT_TRUE(axis->setpoint.velocity == 0 && bench_info().actual_position <= now + 3);
}

static void test_modulo_axis_takes_no_limits(void)
{
    bus.config.axes[0].modulo_range = 1;
    bench_create();
    set(2, 0.5);
    refused(4, 1, CM1E_ERROR_UNSUPPORTED);
    refused(5, 1, CM1E_ERROR_UNSUPPORTED);
}

/* Whatever is written while whatever moves: no set-point beyond the limits in force, unless it was there before. */
static void test_random_limits_are_kept_by_random_motions(void)
{
    unsigned accepted = 0;
    for (int run = 0; run < 30; run++) {
        bench_start();
        bench_enable();
        for (int n = 0; n < 4000; n++) {
            if (draw(20) == 0) {
                static const cm1e_command_kind_t kinds[] = {
                    CM1E_COMMAND_MOVE_ABSOLUTE, CM1E_COMMAND_MOVE_RELATIVE, CM1E_COMMAND_MOVE_ADDITIVE,
                    CM1E_COMMAND_MOVE_CONTINUOUS_ABSOLUTE, CM1E_COMMAND_MOVE_VELOCITY, CM1E_COMMAND_HALT};
                const cm1e_axis_command_t command = {
                    .kind = kinds[draw(6)], .position = uniform(-4, 4), .velocity = uniform(0.1, 30),
                    .end_velocity = uniform(-5, 5), .buffer_mode = (MC_BUFFER_MODE)draw(6),
                    .direction = draw(2) ? mcPositiveDirection : mcNegativeDirection,
                    .deceleration = draw(2) ? 0 : uniform(5, 100)};
                (void)start(&command);
            }
            if (draw(30) == 0) {
                const int number = 2 + (int)draw(4);
                const double value = number == 2 ? uniform(-1, 4) : number == 3 ? uniform(-4, 1) : (double)draw(2);
                accepted += cm1e_axis_write_parameter(axis, number, value) == CM1E_OK;
            }
            if (draw(100) == 0)
                (void)cm1e_axis_set_position(axis, uniform(-1, 1), draw(2));
            const double before = bench_info().set_position;
            bench_cycles(1);
            const double now = bench_info().set_position;
            const double count = 1.0 / 50000; /* without torque the set-point is the motor, in whole counts */
            TEST_ASSERT_TRUE(now <= fmax(axis->limits.upper, before) + count &&
                             now >= fmin(axis->limits.lower, before) - count);
            if (bench_info().state == CM1E_AXIS_ERROR_STOP && axis_free(axis)) {
                TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, bench_info().error);
                (void)cm1e_axis_reset(axis);
            }
        }
    }
    TEST_ASSERT_TRUE(accepted > 1000);
}

/* ---- position lag ------------------------------------------------------------------------------------------------ */

static void test_lag_is_monitored_as_the_parameters_say(void)
{
    bench_enable();
    set(7, 0.2);
    set(6, 0);
    bus.blocked = true;
    bench_move_to(3, 5);
    bench_cycles(1000);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
    TEST_ASSERT_EQUAL_DOUBLE(3, bench_info().position_lag);
    set(6, 1);
    bench_cycles(2);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_LAG, bench_info().error);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.2, axis->fault.bound);
}

/* ---- MC_SetPosition ---------------------------------------------------------------------------------------------- */

static void test_set_position_moves_nothing_and_keeps_the_lag(void)
{
    for (int invert = 0; invert < 2; invert++) {
        fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
        bus.config.axes[0].invert = invert;
        bench_create();
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_set_position(axis, 42.5, false)); /* Disabled too */
        TEST_ASSERT_EQUAL_DOUBLE(42.5, bench_info().actual_position);
        bench_enable();
        bus.blocked = true;
        bench_move_to(42.6, 1);
        bench_cycles(300);
        const double lag = bench_info().position_lag;
        const int32_t target = bus.target_position;
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.1, lag);
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_set_position(axis, -7, false));
        TEST_ASSERT_EQUAL_DOUBLE(-7, bench_info().actual_position);
        TEST_ASSERT_EQUAL_DOUBLE(lag, bench_info().position_lag);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, -7 + lag, bench_info().set_position);
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_set_position(axis, 2, true));
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, -5, bench_info().actual_position);
        bench_cycles(5);
        TEST_ASSERT_EQUAL_INT32(target, bus.target_position);
    }
}

/* The motion is equal with and without it, to the count. */
static void test_set_position_in_motion_leaves_the_motion_as_it_is(void)
{
    enum { CYCLES = 900 };
    static int32_t plain[CYCLES];
    for (int modulo = 0; modulo < 2; modulo++)
        for (int shift = 0; shift < 2; shift++) {
            fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
            bus.config.axes[0].modulo_range = modulo ? 1.5 : 0;
            bench_create();
            bench_enable();
            const cm1e_command_id_t id = bench_start_command(&(cm1e_axis_command_t){
                .kind = CM1E_COMMAND_MOVE_RELATIVE, .position = 5.25, .velocity = 8});
            double shifted = 0.0;
            for (int n = 0; n < CYCLES; n++) {
                bench_cycles(1);
                if (shift && n % 90 == 7) {
                    const double before = bench_info().actual_position, to = uniform(0, 1.4);
                    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_set_position(axis, to, n % 180 == 7));
                    shifted += n % 180 == 7 ? to : to - before;
                }
                if (shift)
                    TEST_ASSERT_EQUAL_INT32(plain[n], bus.target_position);
                plain[n] = bus.target_position;
            }
            TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(id));
            const double expected = 5.25 + shifted, error = bench_info().set_position - expected;
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0, modulo ? remainder(error, 1.5) : error);
        }
}

static void test_target_after_set_position_is_in_the_new_coordinates(void)
{
    bench_enable();
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_set_position(axis, 100, false));
    bench_wait(bench_move_to(101, 10), 2000);
    TEST_ASSERT_INT32_WITHIN(1, 50000, bus.position);
    TEST_ASSERT_EQUAL_DOUBLE(101, bench_info().set_position);
}

static void test_set_position_is_refused_where_it_makes_no_sense(void)
{
    static const double wrong[] = {NAN, INFINITY, -INFINITY, 1e300, 1e12};
    for (int relative = 0; relative < 2; relative++)
        for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++)
            TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, cm1e_axis_set_position(axis, wrong[i], relative));
    char text[300];
    cm1e_axis_error_text(cm1e_axis_reference(axis), text, sizeof text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, "MC_SetPosition Relative by 1e+12 u: positions are within +-"), text);
    set(2, 10);
    set(3, -10);
    set(4, 1);
    set(5, 1);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, cm1e_axis_set_position(axis, 10.1, false));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, cm1e_axis_set_position(axis, -10.1, true));
    bench_told("Relative by -10.1 u would bring the axis, its running motion or one that waits outside the software limits "
               "-10 ... 10 u.");
    static const double right[] = {10, -10, 9}; /* the limits themselves too */
    for (int i = 0; i < 3; i++)
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_set_position(axis, right[i], false));
    bench_enable();
    bench_move_to(0, 5); /* to the limit, in the coordinates after the next line, and no farther */
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, cm1e_axis_set_position(axis, -1.1, false));
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_set_position(axis, -1, false));
    bench_cycles(4000);
    TEST_ASSERT_EQUAL_DOUBLE(-10, bench_info().set_position);
    received = health = CM1E_ERROR_BUS_LOST;
    bench_cycles(1);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_OFFLINE, cm1e_axis_set_position(axis, 0, false));
}

static void test_the_text_is_of_what_was_refused_last(void)
{
    bench_enable();
    cm1e_command_id_t id;
    const cm1e_axis_command_t move = {.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .velocity = 1e9};
    for (int i = 0; i < 2; i++) {
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_VELOCITY_RANGE, cm1e_axis_start(axis, &move, &id));
        bench_told("velocity 1e+09 was commanded");
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, cm1e_axis_set_position(axis, NAN, false));
        bench_told("MC_SetPosition to nan u: a finite number is right.");
        TEST_ASSERT_NOT_EQUAL_INT(CM1E_OK, cm1e_axis_write_parameter(axis, 99, 5.0));
        bench_told("parameter 99");
    }
    const cm1e_axis_command_t fast = {.kind = CM1E_COMMAND_MOVE_CONTINUOUS_ABSOLUTE, .position = 1.0, .velocity = 1.0,
                                      .end_velocity = -1e9};
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_VELOCITY_RANGE, cm1e_axis_start(axis, &fast, &id));
    bench_told("end velocity -1e+09 was commanded");
}

static void test_modulo_position_is_set_within_a_turn(void)
{
    bus.config.axes[0].modulo_range = 360;
    bus.config.axes[0].units_per_revolution = 360;
    bench_create();
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, cm1e_axis_set_position(axis, 360, false));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, cm1e_axis_set_position(axis, -1, false));
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_set_position(axis, 350, false));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 350, bench_info().actual_position);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_set_position(axis, 25 + 720, true));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 15, bench_info().actual_position);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_set_position(axis, -30, true));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 345, bench_info().actual_position);
    bench_enable();
    bench_wait(bench_start_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = 15,
                                                          .velocity = 90, .direction = mcShortestWay}), 5000);
    TEST_ASSERT_INT32_WITHIN(1, 50000 * 30 / 360, bus.position);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_number_of_the_table_can_be_read_and_no_other);
    RUN_TEST(test_limits_that_are_not_set_are_0);
    RUN_TEST(test_in_position_by_number);
    RUN_TEST(test_what_only_can_be_read_is_not_written);
    RUN_TEST(test_position_and_velocities_follow_the_axis);
    RUN_TEST(test_values_out_of_range_are_refused);
    RUN_TEST(test_maxima_of_the_application_bound_the_next_commands);
    RUN_TEST(test_each_software_limit_works_alone);
    RUN_TEST(test_limits_in_the_wrong_order_are_refused);
    RUN_TEST(test_configured_limits_show_as_parameters);
    RUN_TEST(test_limit_inside_the_way_of_a_motion_is_refused);
    RUN_TEST(test_modulo_axis_takes_no_limits);
    RUN_TEST(test_random_limits_are_kept_by_random_motions);
    RUN_TEST(test_lag_is_monitored_as_the_parameters_say);
    RUN_TEST(test_set_position_moves_nothing_and_keeps_the_lag);
    RUN_TEST(test_set_position_in_motion_leaves_the_motion_as_it_is);
    RUN_TEST(test_target_after_set_position_is_in_the_new_coordinates);
    RUN_TEST(test_set_position_is_refused_where_it_makes_no_sense);
    RUN_TEST(test_the_text_is_of_what_was_refused_last);
    RUN_TEST(test_modulo_position_is_set_within_a_turn);
    return UNITY_END();
}
