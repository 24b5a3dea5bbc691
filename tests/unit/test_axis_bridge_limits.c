/* Where the counts of a motor behind a bridge end (BR appendix 5): no target beyond, whatever positions are called. */
#include <math.h>
#include <stdlib.h>

#include "../support/fake_bridge.h"
#include "axis/axis_parameters.h"
#include "axis/axis_signals.h"

#include "../support/axis_bench.h"

enum { LIMIT = 999999999, COUNTS_PER_U = 50000 }; /* K37 = 10 */

static int64_t farthest; /* amount of the targets that went out with torque */

static void follow(int n)
{
    while (n-- > 0) {
        bench_cycles(1);
        const cm1e_sim_bridge_axis_t *motor = fake_bridge_axis();
        const int64_t target = llabs((int64_t)motor->target_position);
        if (motor->state == OPERATION_ENABLED && target > farthest)
            farthest = target;
    }
    TEST_ASSERT_LESS_OR_EQUAL_INT64(LIMIT, farthest);
}

static void follow_while_active(cm1e_command_id_t id, int at_most)
{
    while (bench_state_of(id) == CM1E_COMMAND_ACTIVE && at_most-- > 0)
        follow(1);
    TEST_ASSERT_GREATER_THAN_INT(0, at_most);
}

/* The motor at connector `channel` of an EB12, enabled, so many counts before one end of its counts. */
static void open_before(unsigned channel, int64_t counts, const cm1e_axis_config_t *differs)
{
    farthest = 0;
    bench_end();
    fake_bridge_open(&bus, CM1E_DEVICE_EB12, channel);
    bus.config.axes[0].invert = differs && differs->invert;
    bus.config.axes[0].modulo_range = differs ? differs->modulo_range : 0.0;
    bus.config.axes[0].backlash = differs ? differs->backlash : 0.0;
    bus.config.axes[0].software_limit_positive = differs ? differs->software_limit_positive : 0.0;
    bus.config.axes[0].software_limit_negative = differs ? differs->software_limit_negative : 0.0;
    fake_bridge_axis()->zero -= LIMIT - counts;
    fake_bridge_inputs(&bus);
    bench_create();
    bench_power(true);
    follow(300);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
}

void setUp(void) { open_before(3, 2 * COUNTS_PER_U, NULL); }
void tearDown(void)
{
    bench_end();
    fake_bridge_close();
}

static void refused(const cm1e_axis_command_t *command)
{
    cm1e_command_id_t id;
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, cm1e_axis_start(axis, command, &id));
    bench_told("K37 = 10");
    bench_told("999999999");
}

static void test_the_last_count_is_reached_and_no_more(void)
{
    static const unsigned channels[] = {1, 2, 3, 4};
    for (int i = 0; i < 8; i++) {
        const cm1e_axis_config_t differs = {.invert = i >= 4};
        open_before(channels[i % 4], 2 * COUNTS_PER_U, &differs);
        const double way = differs.invert ? -2.0 : 2.0, over = way > 0 ? 0.0001 : -0.0001;
        refused(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_RELATIVE, .position = way + over, .velocity = 5.0});
        refused(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .velocity = 5.0,
                                       .position = bench_info().set_position + way + over});
        follow_while_active(bench_start_command(&(cm1e_axis_command_t){
            .kind = CM1E_COMMAND_MOVE_RELATIVE, .position = way, .velocity = 5.0}), 5000);
        TEST_ASSERT_EQUAL_INT64(LIMIT, farthest);
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
    }
}

static void test_a_velocity_is_braked_before(void)
{
    follow_while_active(bench_move_velocity(10.0), 5000);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_ERROR_STOP, bench_info().state);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, bench_info().error);
    bench_told("K37 = 10");
    follow(2000);
    TEST_ASSERT_INT64_WITHIN(50, LIMIT, farthest);
}

/* What a position is called changes nothing of where the counts end. */
static void test_they_stay_where_they_are_when_the_position_is_set(void)
{
    static const double positions[] = {0.0, 1e6, -12345.678};
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_set_position(axis, positions[i], false));
        refused(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = positions[i] + 2.001,
                                       .velocity = 5.0});
        const cm1e_axis_measures_t measures = cm1e_axis_measures(axis);
        TEST_ASSERT_DOUBLE_WITHIN(2e-3, positions[i] + 2.0, measures.upper);
        TEST_ASSERT_DOUBLE_WITHIN(2e-3, positions[i] + 2.0 - 2.0 * LIMIT / COUNTS_PER_U, measures.lower);
    }
    bench_move_velocity(-3.0);
    follow(500);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_CONTINUOUS_MOTION, bench_info().state); /* away from it */
}

static void test_a_modulo_axis_stops_there_too(void)
{
    const cm1e_axis_config_t differs = {.modulo_range = 1.0};
    open_before(3, 5 * COUNTS_PER_U, &differs);
    const cm1e_axis_measures_t measures = cm1e_axis_measures(axis);
    TEST_ASSERT_TRUE(isinf(measures.lower) && isinf(measures.upper));
    follow_while_active(bench_start_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_RELATIVE, .position = 3.5,
                                                                   .velocity = 5.0}), 5000);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_set_position(axis, 0.25, false));
    refused(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_RELATIVE, .position = 1.6, .velocity = 5.0});
    follow_while_active(bench_move_velocity(10.0), 5000);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_ERROR_STOP, bench_info().state);
    bench_told("turns counted");
    follow(2000);
    TEST_ASSERT_INT64_WITHIN(50, LIMIT, farthest);
}

static void test_a_backlash_stays_inside(void)
{
    const cm1e_axis_config_t differs = {.backlash = 0.01};
    open_before(3, 2 * COUNTS_PER_U, &differs);
    refused(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_RELATIVE, .position = 2.0, .velocity = 5.0});
    follow_while_active(bench_start_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_RELATIVE,
                                                                   .position = 1.98, .velocity = 5.0}), 5000);
    follow_while_active(bench_move_velocity(10.0), 5000);
    follow(1000);
}

/* Software limits hold as ever, and writing them does not widen the others. */
static void test_software_limits_hold_beside_them(void)
{
    const double end = (double)LIMIT / COUNTS_PER_U;
    const cm1e_axis_config_t differs = {.software_limit_positive = end - 1.0, .software_limit_negative = -10.0};
    open_before(3, 2 * COUNTS_PER_U, &differs);
    cm1e_command_id_t id;
    const cm1e_axis_command_t over = {.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = end - 0.5, .velocity = 5.0};
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, cm1e_axis_start(axis, &over, &id));
    bench_told("software limits");
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_write_parameter(axis, CM1E_PARAMETER_SW_LIMIT_POS, end + 5.0));
    follow_while_active(bench_move_to(end - 0.5, 5.0), 5000);
    refused(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = end + 1.0, .velocity = 5.0});
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_write_parameter(axis, CM1E_PARAMETER_ENABLE_LIMIT_POS, 0.0));
    refused(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = end + 1.0, .velocity = 5.0});
}

static void test_a_step_of_a_homing_ends_there(void)
{
    const cm1e_homing_step_t step = {.kind = CM1E_STEP_BLOCK, .direction = mcPositiveDirection};
    const cm1e_command_id_t id = bench_start_command(&(cm1e_axis_command_t){
        .kind = CM1E_COMMAND_HOMING_STEP, .position = NAN, .velocity = 8.0, .step = &step});
    follow_while_active(id, 5000);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, cm1e_axis_command_status(axis, id).error);
    bench_told("K37 = 10");
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_HOMING, bench_info().state);
    TEST_ASSERT_INT64_WITHIN(1000, LIMIT, farthest);
}

/* 0.02 revolutions/s2 and 0.00002 revolutions/s, however many counts that is. */
static void test_the_least_parameters_are_parts_of_a_revolution(void)
{
    static const struct {
        int number;
        double least;
        const char *words;
    } rows[] = {{CM1E_PARAMETER_MAX_VELOCITY_APPL, 2e-5, "; 2e-05 ... 50 is right"},
                {CM1E_PARAMETER_MAX_ACCELERATION_APPL, 0.02, "; 0.02 ... 100 is right"},
                {CM1E_PARAMETER_MAX_DECELERATION_APPL, 0.02, "; 0.02 ... 100 is right"},
                {CM1E_PARAMETER_MAX_JERK_APPL, 0.02, "; 0.02 ... 2000 is right"}};
    static const uint8_t k37[] = {10, 0, 20, 3};
    for (size_t k = 0; k < sizeof k37; k++) {
        bench_end();
        fake_bridge_open(&bus, CM1E_DEVICE_EB12, 3);
        bus.config.axes[0].k37 = k37[k];
        bench_create();
        for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
            TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_PARAMETER_RANGE,
                                  cm1e_axis_write_parameter(axis, rows[i].number, 0.999 * rows[i].least));
            bench_told(rows[i].words);
            TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_write_parameter(axis, rows[i].number, rows[i].least));
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_last_count_is_reached_and_no_more);
    RUN_TEST(test_a_velocity_is_braked_before);
    RUN_TEST(test_they_stay_where_they_are_when_the_position_is_set);
    RUN_TEST(test_a_modulo_axis_stops_there_too);
    RUN_TEST(test_a_backlash_stays_inside);
    RUN_TEST(test_software_limits_hold_beside_them);
    RUN_TEST(test_a_step_of_a_homing_ends_there);
    RUN_TEST(test_the_least_parameters_are_parts_of_a_revolution);
    return UNITY_END();
}
