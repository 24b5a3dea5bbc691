/* MC_MoveContinuousAbsolute, MC_MoveContinuousRelative (3.11, 3.12): through a position with a velocity, and on. */
#include "../support/axis_bench.h"
#include "../support/axis_witness.h"

static void begin_with_limits(double negative, double positive)
{
    bench_end();
    fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    bus.config.axes[0].max_acceleration = 100.0;
    bus.config.axes[0].max_deceleration = 80.0;
    bus.config.axes[0].max_jerk = 2000.0;
    bus.config.axes[0].software_limit_negative = negative;
    bus.config.axes[0].software_limit_positive = positive;
    bench_create();
    bench_enable();
    watch_begin();
}

void setUp(void) { begin_with_limits(0.0, 0.0); }
void tearDown(void) { bench_end(); }

static cm1e_command_id_t pass(double position, double velocity, double end_velocity)
{
    return bench_start_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_CONTINUOUS_ABSOLUTE,
                                                      .position = position, .velocity = velocity,
                                                      .end_velocity = end_velocity});
}

/* Until InEndVelocity; the cycles that took. */
static int wait_reached(cm1e_command_id_t id)
{
    for (int n = 0; n < 20000; n++) {
        watch_cycles(1);
        if (cm1e_axis_command_status(axis, id).reached)
            return n;
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(id));
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_CONTINUOUS_MOTION, bench_info().state);
    }
    TEST_FAIL_MESSAGE("never reached");
    return 0;
}

static void test_in_end_velocity_at_the_position_and_on(void)
{
    static const struct {
        double position, velocity, end;
    } rows[] = {{5, 4, 2}, {5, 4, 4}, {5, 4, 9}, {-5, 4, -3}, {-5, 4, -9}, {5, 4, -2}, {5, 4, -9}, {-5, 3, 6}, {0, 4, 3}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        char where[32];
        snprintf(where, sizeof where, "row %d", (int)i);
        watch.run = where;
        const cm1e_command_id_t id = pass(rows[i].position, rows[i].velocity, rows[i].end);
        wait_reached(id);
        /* it was passed inside this cycle, exactly */
        const double late = (bench_info().set_position - rows[i].position) / rows[i].end;
        TEST_ASSERT_TRUE_MESSAGE(late >= -1e-8 && late <= 1e-3 + 1e-8, where);
        TEST_ASSERT_EQUAL_DOUBLE(rows[i].end, axis->setpoint.velocity);
        const double at = bench_info().set_position;
        watch_cycles(500);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, at + 0.5 * rows[i].end, bench_info().set_position);
        TEST_ASSERT_TRUE(cm1e_axis_command_status(axis, id).reached);
    }
}

/* 3.12, figure 28: with an end velocity against the way, over the position, and back through it. */
static void test_against_the_way_from_behind_the_position(void)
{
    const cm1e_command_id_t id = pass(3.0, 4.0, -5.0);
    wait_reached(id);
    TEST_ASSERT_TRUE(watch.highest > 3.1);
    TEST_ASSERT_TRUE(watch.lowest > -1e-9);
}

/* Too short a way to get to the end velocity: passed as fast as possible, without backing up, and reached later. */
static void test_too_short_a_way_never_backs_up(void)
{
    static const double ends[] = {9.0, -9.0}, ways[] = {1e-6, 0.01, 0.3, 0.6};
    for (int e = 0; e < 2; e++)
        for (int w = 0; w < 4; w++) {
            setUp();
            const double sign = ends[e] > 0 ? 1.0 : -1.0;
            const cm1e_command_id_t id = pass(sign * ways[w], 9.0, ends[e]);
            wait_reached(id);
            TEST_ASSERT_TRUE(sign > 0 ? watch.lowest >= -1e-9 : watch.highest <= 1e-9);
            TEST_ASSERT_EQUAL_DOUBLE(ends[e], axis->setpoint.velocity);
            TEST_ASSERT_TRUE(fabs(bench_info().set_position) > 0.6);
        }
    setUp(); /* the same with too short a way to slow down */
    bench_move_velocity(10.0);
    watch_cycles(500);
    const double now = bench_info().set_position;
    const cm1e_command_id_t id = pass(now + 0.05, 5.0, 1.0);
    wait_reached(id);
    TEST_ASSERT_TRUE(bench_info().set_position > now + 0.5);
    TEST_ASSERT_EQUAL_DOUBLE(1.0, axis->setpoint.velocity);
}

static void test_a_position_behind_is_gone_back_for(void)
{
    bench_move_velocity(5.0);
    watch_cycles(500);
    const double now = bench_info().set_position;
    const cm1e_command_id_t id = pass(now - 1.0, 5.0, 5.0);
    wait_reached(id);
    TEST_ASSERT_DOUBLE_WITHIN(5.1e-3, now - 1.0, bench_info().set_position);
    TEST_ASSERT_EQUAL_DOUBLE(5.0, axis->setpoint.velocity);
}

static void test_relative_counts_from_the_set_position(void)
{
    bench_move_velocity(2.0);
    watch_cycles(500);
    const double now = bench_info().set_position;
    const cm1e_command_id_t id = bench_start_command(&(cm1e_axis_command_t){
        .kind = CM1E_COMMAND_MOVE_CONTINUOUS_RELATIVE, .position = 4.0, .velocity = 6.0, .end_velocity = 1.0});
    wait_reached(id);
    TEST_ASSERT_DOUBLE_WITHIN(1.1e-3, now + 4.0, bench_info().set_position);
}

/* What is buffered behind begins where the end velocity is reached. */
static void test_the_next_one_begins_at_in_end_velocity(void)
{
    pass(5.0, 8.0, 3.0);
    const cm1e_command_id_t next = bench_start_command(&(cm1e_axis_command_t){
        .kind = CM1E_COMMAND_MOVE_RELATIVE, .position = 2.0, .velocity = 3.0, .buffer_mode = mcBuffered});
    while (bench_state_of(next) == CM1E_COMMAND_BUFFERED)
        watch_cycles(1);
    TEST_ASSERT_DOUBLE_WITHIN(3.1e-3, 5.0, bench_info().set_position);
    watch_cycles(2000);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 7.0, bench_info().set_position);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(next));
}

static void test_end_velocity_zero_is_a_stop_there(void)
{
    const cm1e_command_id_t id = pass(2.0, 5.0, 0.0);
    wait_reached(id);
    watch_cycles(50);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 2.0, bench_info().set_position);
    TEST_ASSERT_TRUE(cm1e_axis_command_status(axis, id).reached);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_CONTINUOUS_MOTION, bench_info().state);
}

static cm1e_error_t refusal(double position, double velocity, double end)
{
    const cm1e_axis_command_t command = {.kind = CM1E_COMMAND_MOVE_CONTINUOUS_ABSOLUTE, .position = position,
                                         .velocity = velocity, .end_velocity = end};
    cm1e_command_id_t id;
    return cm1e_axis_start(axis, &command, &id);
}

/* It turns back behind its position: it is entered no faster than it can stand there, in metres too. */
static void test_a_short_way_to_an_end_velocity_back_is_entered_slowly(void)
{
    for (double way = 0.02; way < 0.5; way += 0.02) {
        bench_end();
        fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
        cm1e_axis_config_t *config = &bus.config.axes[0];
        config->counts_per_unit *= 1000.0;
        config->max_velocity = 0.02;
        config->max_acceleration = 0.1;
        config->max_deceleration = 0.08;
        config->max_jerk = 2.0;
        bench_create();
        bench_enable();
        watch_begin();
        bench_move_to(5.0e-3, 8.0e-3);
        const cm1e_command_id_t id = bench_start_command(&(cm1e_axis_command_t){
            .kind = CM1E_COMMAND_MOVE_CONTINUOUS_ABSOLUTE, .position = (5.0 + way) * 1e-3, .velocity = 8.0e-3,
            .end_velocity = -2.0e-3, .buffer_mode = mcBlendingHigh});
        double farthest = 0.0;
        for (int n = 0; n < 20000 && !cm1e_axis_command_status(axis, id).reached; n++) {
            watch_cycles(1);
            farthest = fmax(farthest, bench_info().set_position);
        }
        TEST_ASSERT_TRUE(farthest <= (5.0 + way + 0.065) * 1e-3);
    }
}

static void test_limits(void)
{
    begin_with_limits(-10.0, 10.0);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, refusal(11.0, 5.0, 1.0));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, refusal(10.0, 5.0, -5.0)); /* it would have to turn beyond */
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_VELOCITY_RANGE, refusal(5.0, 5.0, 1e3));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_VELOCITY_RANGE, refusal(5.0, 0.0, 1.0));
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_power(axis, &owner, true, true, false));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_DIRECTION_DISABLED, refusal(5.0, 5.0, -1.0));
    const cm1e_command_id_t id = pass(9.0, 20.0, 5.0); /* runs into the limit behind it */
    bench_cycles(5000);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ERROR, bench_state_of(id));
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_ERROR_STOP, bench_info().state);
    TEST_ASSERT_TRUE(bench_info().actual_position <= 10.0 + 1e-4);
    TEST_ASSERT_TRUE(bench_info().actual_position > 9.9);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_in_end_velocity_at_the_position_and_on);
    RUN_TEST(test_against_the_way_from_behind_the_position);
    RUN_TEST(test_too_short_a_way_never_backs_up);
    RUN_TEST(test_a_position_behind_is_gone_back_for);
    RUN_TEST(test_relative_counts_from_the_set_position);
    RUN_TEST(test_the_next_one_begins_at_in_end_velocity);
    RUN_TEST(test_end_velocity_zero_is_a_stop_there);
    RUN_TEST(test_a_short_way_to_an_end_velocity_back_is_entered_slowly);
    RUN_TEST(test_limits);
    return UNITY_END();
}
