/* ContinuousUpdate (2.4.6): new inputs of a command that runs or waits. */
#include <string.h>

#include "../support/axis_bench.h"
#include "../support/axis_witness.h"
#include "../support/xorshift.h"

void setUp(void)
{
    fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    bus.config.axes[0].max_acceleration = 100.0;
    bus.config.axes[0].max_deceleration = 80.0;
    bus.config.axes[0].max_jerk = 2000.0;
    bus.config.axes[0].software_limit_negative = -20.0;
    bus.config.axes[0].software_limit_positive = 200.0;
    bench_create();
    bench_enable();
    watch_begin();
}
void tearDown(void) { bench_end(); }

static cm1e_axis_command_t inputs(cm1e_command_kind_t kind, double position, double velocity)
{
    return (cm1e_axis_command_t){.kind = kind, .position = position, .velocity = velocity};
}

static cm1e_error_t update(cm1e_command_id_t id, cm1e_axis_command_t command)
{
    return cm1e_axis_update(axis, id, &command);
}

static void wait_end(cm1e_command_id_t id)
{
    for (int i = 0; i < 60000 && bench_state_of(id) == CM1E_COMMAND_ACTIVE; i++)
        watch_cycles(1);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(id));
}

/* The example of 2.4.6 itself. */
static void test_relative_counts_from_where_it_began(void)
{
    static const cm1e_command_kind_t kinds[] = {CM1E_COMMAND_MOVE_RELATIVE, CM1E_COMMAND_MOVE_ADDITIVE};
    for (int k = 0; k < 2; k++) {
        setUp();
        const cm1e_axis_command_t first = inputs(kinds[k], 100.0, 10.0);
        const cm1e_command_id_t id = bench_start_command(&first);
        while (bench_info().set_position < 50.0)
            watch_cycles(1);
        double fastest = 0.0;
        for (int i = 0; i < 60000 && bench_state_of(id) == CM1E_COMMAND_ACTIVE; i++) {
            TEST_ASSERT_EQUAL_INT(CM1E_OK, update(id, inputs(kinds[k], 130.0, 20.0))); /* as a block */
            watch_cycles(1);
            fastest = fmax(fastest, axis->setpoint.velocity);
        }
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 20.0, fastest);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(id));
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 130.0, bench_info().set_position);
        TEST_ASSERT_EQUAL_INT(CM1E_OK, update(id, inputs(kinds[k], 50.0, 20.0))); /* regains nothing */
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
        watch_cycles(10);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 130.0, bench_info().set_position);
    }
}

static void test_unchanged_inputs_leave_the_profile_alone(void)
{
    const cm1e_axis_command_t command = inputs(CM1E_COMMAND_MOVE_ABSOLUTE, 10.0, 5.0);
    const cm1e_command_id_t id = bench_start_command(&command);
    watch_cycles(20);
    const int64_t cycles = axis->setpoint.profile_cycles;
    TEST_ASSERT_EQUAL_INT(CM1E_OK, update(id, command));
    TEST_ASSERT_EQUAL_INT64(cycles, axis->setpoint.profile_cycles);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, update(id, inputs(CM1E_COMMAND_MOVE_ABSOLUTE, 10.0, 6.0)));
    TEST_ASSERT_EQUAL_INT64(0, axis->setpoint.profile_cycles);
}

static void test_a_velocity_follows_its_input(void)
{
    const cm1e_axis_command_t first = inputs(CM1E_COMMAND_MOVE_VELOCITY, 0.0, 5.0);
    const cm1e_command_id_t id = bench_start_command(&first);
    watch_cycles(500);
    TEST_ASSERT_TRUE(cm1e_axis_command_status(axis, id).reached);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, update(id, inputs(CM1E_COMMAND_MOVE_VELOCITY, 0.0, 8.0)));
    TEST_ASSERT_FALSE(cm1e_axis_command_status(axis, id).reached); /* 2.4.1: they are unequal now */
    watch_cycles(1);
    TEST_ASSERT_FALSE(cm1e_axis_command_status(axis, id).reached);
    watch_cycles(500);
    TEST_ASSERT_TRUE(cm1e_axis_command_status(axis, id).reached);
    TEST_ASSERT_EQUAL_DOUBLE(8.0, axis->setpoint.velocity);
    cm1e_axis_command_t back = inputs(CM1E_COMMAND_MOVE_VELOCITY, 0.0, 2.0);
    back.direction = mcNegativeDirection;
    TEST_ASSERT_EQUAL_INT(CM1E_OK, update(id, back));
    watch_cycles(1000);
    TEST_ASSERT_EQUAL_DOUBLE(-2.0, axis->setpoint.velocity);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(id));
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_CONTINUOUS_MOTION, bench_info().state);
}

static void test_a_continuous_move_gets_another_end(void)
{
    cm1e_axis_command_t command = inputs(CM1E_COMMAND_MOVE_CONTINUOUS_ABSOLUTE, 10.0, 8.0);
    command.end_velocity = 2.0;
    const cm1e_command_id_t id = bench_start_command(&command);
    watch_cycles(500);
    command.position = 20.0;
    TEST_ASSERT_EQUAL_INT(CM1E_OK, update(id, command));
    while (!cm1e_axis_command_status(axis, id).reached)
        watch_cycles(1);
    TEST_ASSERT_DOUBLE_WITHIN(2.1e-3, 20.0, bench_info().set_position);
    command.end_velocity = 3.0; /* behind the position: only a velocity is left to be changed */
    TEST_ASSERT_EQUAL_INT(CM1E_OK, update(id, command));
    watch_cycles(500);
    TEST_ASSERT_EQUAL_DOUBLE(3.0, axis->setpoint.velocity);
    TEST_ASSERT_TRUE(bench_info().set_position > 21.0);
    command.position = 30.0; /* and a new one ahead is passed as well */
    command.end_velocity = 1.0;
    TEST_ASSERT_EQUAL_INT(CM1E_OK, update(id, command));
    watch_cycles(1);
    while (!cm1e_axis_command_status(axis, id).reached)
        watch_cycles(1);
    TEST_ASSERT_DOUBLE_WITHIN(1.1e-3, 30.0, bench_info().set_position);
}

static void test_a_refused_update_changes_nothing(void)
{
    const cm1e_axis_command_t good = inputs(CM1E_COMMAND_MOVE_ABSOLUTE, 10.0, 5.0);
    const cm1e_command_id_t id = bench_start_command(&good);
    watch_cycles(200);
    cm1e_axis_command_t bad = good;
    bad.acceleration = -1.0;
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, update(id, inputs(good.kind, 201.0, 5.0)));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, update(id, inputs(good.kind, NAN, 5.0)));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_VELOCITY_RANGE, update(id, inputs(good.kind, 10.0, -5.0)));
    char text[300];
    cm1e_axis_error_text(cm1e_axis_reference(axis), text, sizeof text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, "velocity -5 was commanded"), text);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_VELOCITY_RANGE, update(id, inputs(good.kind, 10.0, NAN)));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_DYNAMICS_RANGE, update(id, bad));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_INVALID_ARGUMENT, update(id, inputs(CM1E_COMMAND_MOVE_RELATIVE, 1.0, 5.0)));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_INVALID_ARGUMENT, update(0, good));
    TEST_ASSERT_EQUAL_INT64(200, axis->setpoint.profile_cycles);
    wait_end(id);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 10.0, bench_info().set_position);
}

static void test_a_waiting_command_is_updated_too(void)
{
    const cm1e_axis_command_t first = inputs(CM1E_COMMAND_MOVE_ABSOLUTE, 10.0, 5.0);
    cm1e_axis_command_t second = inputs(CM1E_COMMAND_MOVE_RELATIVE, 10.0, 5.0);
    second.buffer_mode = mcBlendingNext;
    const cm1e_command_id_t id1 = bench_start_command(&first), id2 = bench_start_command(&second);
    watch_cycles(100);
    second.velocity = 9.0;
    second.position = 15.0;
    second.buffer_mode = mcBuffered; /* too late to change */
    TEST_ASSERT_EQUAL_INT(CM1E_OK, update(id2, second));
    second.position = 1000.0;
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, update(id2, second));
    second.position = 15.0;
    while (bench_state_of(id1) == CM1E_COMMAND_ACTIVE)
        watch_cycles(1);
    TEST_ASSERT_DOUBLE_WITHIN(1e-2, 9.0, axis->setpoint.velocity); /* the junction has followed */
    watch_cycles(100);
    second.position = 16.0; /* from where it began, now that it is active */
    TEST_ASSERT_EQUAL_INT(CM1E_OK, update(id2, second));
    wait_end(id2);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 26.0, bench_info().set_position);
}

static uint64_t seed;

static double draw(double low, double high)
{
    return xorshift_between(&seed, low, high);
}

static cm1e_axis_command_t random_inputs(const cm1e_axis_command_t *before)
{
    cm1e_axis_command_t next = *before;
    next.position = draw(-25.0, 60.0);
    next.velocity = draw(0, 1) < 0.1 ? -1.0 : draw(5.0, 40.0);
    next.end_velocity = draw(-5.0, 5.0);
    next.acceleration = draw(0, 1) < 0.3 ? 0.0 : draw(5.0, 100.0);
    next.deceleration = draw(0, 1) < 0.3 ? 0.0 : draw(5.0, 80.0);
    next.jerk = draw(0, 1) < 0.3 ? 0.0 : draw(100.0, 2000.0);
    return next;
}

/* Any inputs in any cycle: limits hold, and the end is where the last good ones say. */
static void test_random_updates_keep_the_limits(void)
{
    static const cm1e_command_kind_t kinds[] = {CM1E_COMMAND_MOVE_ABSOLUTE, CM1E_COMMAND_MOVE_RELATIVE,
                                                CM1E_COMMAND_MOVE_VELOCITY, CM1E_COMMAND_MOVE_CONTINUOUS_ABSOLUTE};
    for (unsigned run = 0; run < 200; run++) {
        setUp();
        char name[32];
        snprintf(name, sizeof name, "of run %u", run);
        watch.run = name;
        seed = 0x9E3779B97F4A7C15u * (run + 1);
        cm1e_axis_command_t command = inputs(kinds[run % 4], draw(-15.0, 15.0), draw(5.0, 40.0));
        command.end_velocity = draw(-2.0, 2.0);
        cm1e_command_id_t id;
        if (cm1e_axis_start(axis, &command, &id) != CM1E_OK)
            continue;
        for (int i = 0; i < 1500 && axis->state != CM1E_AXIS_ERROR_STOP; i++) {
            const cm1e_axis_command_t next = random_inputs(&command);
            if (draw(0, 1) < 0.05 && update(id, next) == CM1E_OK && bench_state_of(id) == CM1E_COMMAND_ACTIVE)
                command = next;
            watch_cycles(1);
            WATCH(watch.lowest >= -20.0 - 1e-6 && watch.highest <= 200.0 + 1e-6, "outside at %g",
                  bench_info().set_position);
        }
        if (run % 4 < 2) {
            watch_cycles(20000);
            TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(id));
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, command.position, bench_info().set_position);
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_relative_counts_from_where_it_began);
    RUN_TEST(test_unchanged_inputs_leave_the_profile_alone);
    RUN_TEST(test_a_velocity_follows_its_input);
    RUN_TEST(test_a_continuous_move_gets_another_end);
    RUN_TEST(test_a_refused_update_changes_nothing);
    RUN_TEST(test_a_waiting_command_is_updated_too);
    RUN_TEST(test_random_updates_keep_the_limits);
    return UNITY_END();
}
