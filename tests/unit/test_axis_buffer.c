/* Commands that wait (2.4.2, table 4): who is active when, what ends them, what is refused. */
#include "../support/axis_bench.h"
#include "../support/axis_witness.h"

void setUp(void)
{
    fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    bus.config.axes[0].max_acceleration = 100.0;
    bus.config.axes[0].max_deceleration = 100.0;
    bus.config.axes[0].max_jerk = 2000.0;
    bench_create();
    bench_enable();
    watch_begin();
}
void tearDown(void) { bench_end(); }

static cm1e_command_id_t post(cm1e_command_kind_t kind, double position, double velocity, MC_BUFFER_MODE mode)
{
    return bench_start_command(&(cm1e_axis_command_t){.kind = kind, .position = position, .velocity = velocity,
                                                      .end_velocity = 2.0, .buffer_mode = mode});
}

static cm1e_error_t refused(const cm1e_axis_command_t *command)
{
    cm1e_command_id_t id = 1;
    const cm1e_error_t error = cm1e_axis_start(axis, command, &id);
    TEST_ASSERT_EQUAL_UINT32(error == CM1E_OK, id != 0);
    return error;
}

static const cm1e_command_kind_t kinds[] = {
    CM1E_COMMAND_MOVE_ABSOLUTE, CM1E_COMMAND_MOVE_RELATIVE, CM1E_COMMAND_MOVE_ADDITIVE, CM1E_COMMAND_MOVE_VELOCITY,
    CM1E_COMMAND_MOVE_CONTINUOUS_ABSOLUTE, CM1E_COMMAND_MOVE_CONTINUOUS_RELATIVE, CM1E_COMMAND_HALT,
};
enum { KINDS = sizeof kinds / sizeof kinds[0] };

static bool endless(cm1e_command_kind_t kind) { return kind_row(kind)->is_endless; }

/* One pair: until the second has ended, or reached what it can reach. */
static void run_pair(cm1e_command_kind_t first_kind, cm1e_command_kind_t second_kind, MC_BUFFER_MODE mode, int wait)
{
    char where[80];
    snprintf(where, sizeof where, "kind %d, then %d in mode %d after %d", first_kind, second_kind, mode, wait);
    watch.run = where;
    const cm1e_command_id_t first = post(first_kind, 3.0, 5.0, mcAborting);
    watch_cycles(wait);
    const bool first_over = bench_state_of(first) != CM1E_COMMAND_ACTIVE;
    const bool reached = cm1e_axis_command_status(axis, first).reached;
    const cm1e_command_id_t second = post(second_kind, 8.0, 4.0, mode);
    const bool waits = mode != mcAborting && !first_over && !reached;
    TEST_ASSERT_EQUAL_INT_MESSAGE(waits ? CM1E_COMMAND_BUFFERED : CM1E_COMMAND_ACTIVE, bench_state_of(second), where);
    bool handed_over = !waits;
    for (int i = 0; i < 8000; i++) {
        const cm1e_command_status_t a = cm1e_axis_command_status(axis, first), b = cm1e_axis_command_status(axis, second);
        handed_over |= b.state != CM1E_COMMAND_BUFFERED;
        TEST_ASSERT_EQUAL_INT_MESSAGE(!handed_over, a.state == CM1E_COMMAND_ACTIVE, where);
        if (handed_over && !first_over)
            TEST_ASSERT_EQUAL_INT_MESSAGE(mode == mcAborting || endless(first_kind) ? CM1E_COMMAND_ABORTED
                                                                                    : CM1E_COMMAND_DONE, a.state, where);
        if (!handed_over)
            TEST_ASSERT_FALSE_MESSAGE(a.reached, where);
        if (b.state == CM1E_COMMAND_ACTIVE)
            TEST_ASSERT_EQUAL_INT_MESSAGE(endless(second_kind) ? CM1E_AXIS_CONTINUOUS_MOTION
                                                               : CM1E_AXIS_DISCRETE_MOTION, bench_info().state, where);
        if (b.state == CM1E_COMMAND_DONE || b.reached)
            return;
        watch_cycles(1);
    }
    TEST_FAIL_MESSAGE(where);
}

static void test_every_pair_in_every_mode(void)
{
    static const int waits[] = {0, 1, 60, 300, 1500};
    for (int first = 0; first < KINDS; first++)
        for (int second = 0; second < KINDS; second++)
            for (int mode = mcAborting; mode <= mcBlendingHigh; mode++)
                for (int w = 0; w < 5; w++) {
                    setUp();
                    run_pair(kinds[first], kinds[second], (MC_BUFFER_MODE)mode, waits[w]);
                }
}

static void test_each_of_a_full_buffer_has_its_turn(void)
{
    cm1e_command_id_t ids[CM1E_AXIS_BUFFER_DEPTH + 1];
    for (int i = 0; i <= CM1E_AXIS_BUFFER_DEPTH; i++)
        ids[i] = post(CM1E_COMMAND_MOVE_RELATIVE, i % 2 ? -1.0 : 2.0, 5.0, mcBuffered);
    const cm1e_axis_command_t more = {.kind = CM1E_COMMAND_MOVE_RELATIVE, .position = 1.0, .velocity = 1.0,
                                      .buffer_mode = mcBuffered};
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_FULL, refused(&more));
    double expected = 0.0;
    for (int i = 0; i <= CM1E_AXIS_BUFFER_DEPTH; i++) {
        for (int k = i + 1; k <= CM1E_AXIS_BUFFER_DEPTH; k++)
            TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_BUFFERED, bench_state_of(ids[k]));
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(ids[i]));
        while (bench_state_of(ids[i]) == CM1E_COMMAND_ACTIVE)
            watch_cycles(1);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(ids[i]));
        expected += i % 2 ? -1.0 : 2.0;
        TEST_ASSERT_DOUBLE_WITHIN(2e-4, expected, bench_info().set_position); /* a fraction of a cycle into the next */
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 6.0, bench_info().set_position);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
}

static void test_an_aborting_command_clears_the_buffer(void)
{
    const cm1e_command_id_t first = post(CM1E_COMMAND_MOVE_ABSOLUTE, 5.0, 2.0, mcAborting);
    const cm1e_command_id_t second = post(CM1E_COMMAND_MOVE_ABSOLUTE, 6.0, 2.0, mcBuffered);
    const cm1e_command_id_t third = post(CM1E_COMMAND_MOVE_VELOCITY, 0.0, 2.0, mcBlendingNext);
    watch_cycles(100);
    const cm1e_axis_command_t bad = {.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = 1.0, .velocity = -1.0};
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_VELOCITY_RANGE, refused(&bad)); /* changes nothing */
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_BUFFERED, bench_state_of(third));
    const cm1e_command_id_t last = post(CM1E_COMMAND_MOVE_ABSOLUTE, 1.0, 2.0, mcAborting);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, bench_state_of(first));
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, bench_state_of(second));
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, bench_state_of(third));
    watch_cycles(3000);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(last));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 1.0, bench_info().set_position);
}

static void fill(cm1e_command_id_t ids[4])
{
    ids[0] = post(CM1E_COMMAND_MOVE_ABSOLUTE, 5.0, 5.0, mcAborting);
    ids[1] = post(CM1E_COMMAND_MOVE_ABSOLUTE, 9.0, 5.0, mcBlendingHigh);
    ids[2] = post(CM1E_COMMAND_HALT, 0.0, 0.0, mcBuffered);
    ids[3] = post(CM1E_COMMAND_MOVE_RELATIVE, 3.0, 5.0, mcBuffered);
}

static void test_an_error_ends_all_with_an_error(void)
{
    cm1e_command_id_t ids[4];
    fill(ids);
    watch_cycles(200);
    fake_bus_fault(&bus, 0x2310);
    bench_cycles(2);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_ERROR_STOP, bench_info().state);
    for (int i = 0; i < 4; i++) {
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ERROR, bench_state_of(ids[i]));
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_ERROR_STOP, cm1e_axis_command_status(axis, ids[i]).error);
    }
}

static void test_power_off_and_stop_abort_all(void)
{
    for (int stop = 0; stop < 2; stop++) {
        setUp();
        cm1e_command_id_t ids[4];
        fill(ids);
        watch_cycles(200);
        if (stop)
            post(CM1E_COMMAND_STOP, 0.0, 0.0, mcBuffered); /* has no buffer mode */
        else
            bench_power(false);
        for (int i = 0; i < 4; i++)
            TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, bench_state_of(ids[i]));
        watch_cycles(1000);
        TEST_ASSERT_EQUAL_INT(stop ? CM1E_AXIS_STOPPING : CM1E_AXIS_DISABLED, bench_info().state);
        TEST_ASSERT_EQUAL_DOUBLE(0.0, bench_info().set_velocity);
        const cm1e_axis_command_t behind = {.kind = CM1E_COMMAND_MOVE_RELATIVE, .position = 1.0, .velocity = 1.0,
                                            .buffer_mode = mcBuffered};
        TEST_ASSERT_EQUAL_INT(stop ? CM1E_ERROR_AXIS_STOPPING : CM1E_ERROR_AXIS_NOT_POWERED, refused(&behind));
    }
}

/* 2.2.2, case 2 */
static void test_when_the_active_one_fails_the_next_begins_at_once(void)
{
    const cm1e_command_id_t first = post(CM1E_COMMAND_MOVE_ABSOLUTE, 5.0, 5.0, mcAborting);
    const cm1e_command_id_t second = post(CM1E_COMMAND_MOVE_ABSOLUTE, 9.0, 5.0, mcBuffered); /* fails as well */
    const cm1e_command_id_t third = post(CM1E_COMMAND_MOVE_ABSOLUTE, -1.0, 5.0, mcBuffered);
    watch_cycles(200);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_power(axis, &owner, true, false, true));
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ERROR, bench_state_of(first));
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ERROR, bench_state_of(second));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_DIRECTION_DISABLED, cm1e_axis_command_status(axis, second).error);
    bench_told("MC_MoveAbsolute, running or waiting, was ended: motion in this direction is disabled");
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(third));
    watch_cycles(3000);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(third));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, -1.0, bench_info().set_position);
}

static void test_a_velocity_goes_on_when_the_next_one_cannot_begin(void)
{
    const cm1e_command_id_t first = post(CM1E_COMMAND_MOVE_VELOCITY, 0.0, 5.0, mcAborting);
    const cm1e_command_id_t second = bench_start_command(&(cm1e_axis_command_t){
        .kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 5.0, .direction = mcNegativeDirection,
        .buffer_mode = mcBuffered});
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_power(axis, &owner, true, true, false));
    watch_cycles(400);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ERROR, bench_state_of(second));
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(first));
    TEST_ASSERT_TRUE(cm1e_axis_command_status(axis, first).reached);
    TEST_ASSERT_EQUAL_DOUBLE(5.0, bench_info().set_velocity);
}

static void test_what_can_be_known_is_refused_at_once(void)
{
    tearDown();
    bus.config.axes[0].software_limit_negative = -10.0;
    bus.config.axes[0].software_limit_positive = 10.0;
    bench_create();
    bench_enable();
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_power(axis, &owner, true, true, false));
    post(CM1E_COMMAND_MOVE_ABSOLUTE, 6.0, 5.0, mcAborting);
    static const struct {
        cm1e_axis_command_t command;
        cm1e_error_t error;
    } rows[] = {
        {{.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = 10.5, .velocity = 1}, CM1E_ERROR_AXIS_POSITION_RANGE},
        {{.kind = CM1E_COMMAND_MOVE_RELATIVE, .position = 4.5, .velocity = 1}, CM1E_ERROR_AXIS_POSITION_RANGE},
        {{.kind = CM1E_COMMAND_MOVE_ADDITIVE, .position = NAN, .velocity = 1}, CM1E_ERROR_AXIS_POSITION_RANGE},
        {{.kind = CM1E_COMMAND_MOVE_RELATIVE, .position = -1, .velocity = 1}, CM1E_ERROR_AXIS_DIRECTION_DISABLED},
        {{.kind = CM1E_COMMAND_MOVE_RELATIVE, .position = 1, .velocity = 0}, CM1E_ERROR_AXIS_VELOCITY_RANGE},
        {{.kind = CM1E_COMMAND_MOVE_CONTINUOUS_RELATIVE, .position = 1, .velocity = 1, .end_velocity = 1e3},
         CM1E_ERROR_AXIS_VELOCITY_RANGE},
        {{.kind = CM1E_COMMAND_MOVE_CONTINUOUS_RELATIVE, .position = 1, .velocity = 1, .end_velocity = NAN},
         CM1E_ERROR_AXIS_VELOCITY_RANGE},
        {{.kind = CM1E_COMMAND_MOVE_RELATIVE, .position = 1, .velocity = 1, .acceleration = 1e6},
         CM1E_ERROR_AXIS_DYNAMICS_RANGE},
        {{.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 1, .direction = mcShortestWay}, CM1E_ERROR_AXIS_DIRECTION},
        {{.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = -1}, CM1E_ERROR_AXIS_DIRECTION_DISABLED},
        {{.kind = CM1E_COMMAND_HALT, .deceleration = -1}, CM1E_ERROR_AXIS_DYNAMICS_RANGE},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
        for (int mode = mcBuffered; mode <= mcBlendingHigh; mode++) {
            cm1e_axis_command_t command = rows[i].command;
            command.buffer_mode = (MC_BUFFER_MODE)mode;
            char where[32];
            snprintf(where, sizeof where, "row %d, mode %d", (int)i, mode);
            TEST_ASSERT_EQUAL_INT_MESSAGE(rows[i].error, refused(&command), where);
        }
    bench_cycles(3000);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state); /* nothing waited */
}

static void test_homing_waits_for_standstill_and_moves_wait_for_homing(void)
{
    static const cm1e_homing_config_t hard_stop = {.method = -1};
    const cm1e_command_id_t move = post(CM1E_COMMAND_MOVE_ABSOLUTE, 1.0, 5.0, mcAborting);
    const cm1e_axis_command_t home = {.kind = CM1E_COMMAND_HOME, .homing = &hard_stop, .buffer_mode = mcBlendingHigh};
    const cm1e_command_id_t homing = bench_start_command(&home);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_BUSY, refused(&home)); /* one at a time */
    const cm1e_command_id_t after = post(CM1E_COMMAND_MOVE_RELATIVE, 2.0, 5.0, mcBlendingHigh);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_BUFFERED, bench_state_of(homing));
    while (bench_state_of(move) == CM1E_COMMAND_ACTIVE)
        watch_cycles(1);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(homing));
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_HOMING, bench_info().state);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 1.0, bench_info().set_position);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, bench_info().set_velocity);
    bench_cycles(20);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_BUFFERED, bench_state_of(after));
    for (int i = 0; i < 500 && bench_state_of(homing) == CM1E_COMMAND_ACTIVE; i++) {
        bus.mode_status = (uint16_t)(bus.mode == CM1E_MODE_HM && i > 100 ? 0x1400 : 0); /* completed */
        bench_cycles(1);
    }
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(homing));
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(after));
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_DISCRETE_MOTION, bench_info().state);
    watch.ours = false;
    watch_cycles(3000);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(after));
}

static void test_homing_behind_a_velocity_is_refused(void)
{
    static const cm1e_homing_config_t hard_stop = {.method = -1};
    post(CM1E_COMMAND_MOVE_VELOCITY, 0.0, 1.0, mcAborting);
    const cm1e_axis_command_t home = {.kind = CM1E_COMMAND_HOME, .homing = &hard_stop, .buffer_mode = mcBuffered};
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_STATE, refused(&home));
}

/* 3.6, 3.7: what relative and additional ones count from. */
static void test_relative_and_additive_count_from_the_right_place(void)
{
    post(CM1E_COMMAND_MOVE_ABSOLUTE, 6.0, 3.0, mcAborting); /* figure 20, right */
    watch_cycles(1000);
    TEST_ASSERT_TRUE(bench_info().set_position > 1.0 && bench_info().set_position < 5.0);
    post(CM1E_COMMAND_MOVE_ADDITIVE, 4.0, 2.0, mcAborting);
    watch_cycles(8000);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 10.0, bench_info().set_position);
    post(CM1E_COMMAND_MOVE_ADDITIVE, 1.0, 2.0, mcAborting); /* from standstill */
    post(CM1E_COMMAND_MOVE_ADDITIVE, 1.0, 2.0, mcBuffered);
    post(CM1E_COMMAND_MOVE_RELATIVE, 1.0, 2.0, mcBlendingLow);
    watch_cycles(3000);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 13.0, bench_info().set_position);
    post(CM1E_COMMAND_MOVE_VELOCITY, 0.0, 3.0, mcAborting);
    watch_cycles(500);
    const double now = bench_info().set_position;
    post(CM1E_COMMAND_MOVE_ADDITIVE, 4.0, 3.0, mcAborting); /* continuous motion: from the set position */
    watch_cycles(5000);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, now + 4.0, bench_info().set_position);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_pair_in_every_mode);
    RUN_TEST(test_each_of_a_full_buffer_has_its_turn);
    RUN_TEST(test_an_aborting_command_clears_the_buffer);
    RUN_TEST(test_an_error_ends_all_with_an_error);
    RUN_TEST(test_power_off_and_stop_abort_all);
    RUN_TEST(test_when_the_active_one_fails_the_next_begins_at_once);
    RUN_TEST(test_a_velocity_goes_on_when_the_next_one_cannot_begin);
    RUN_TEST(test_what_can_be_known_is_refused_at_once);
    RUN_TEST(test_homing_waits_for_standstill_and_moves_wait_for_homing);
    RUN_TEST(test_homing_behind_a_velocity_is_refused);
    RUN_TEST(test_relative_and_additive_count_from_the_right_place);
    return UNITY_END();
}
