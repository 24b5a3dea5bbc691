/* Table profiles on the axis: along the points, checked as a whole before, buffered, interrupted at every cycle. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../support/axis_bench.h"

typedef struct pair {
    TIME delta_ns;
    LREAL value;
} pair_t;

static const TIME second = 1000000000;

static void read_pair(const void *reference, int index, TIME *delta_ns, LREAL *value)
{
    *delta_ns = ((const pair_t *)reference)[index].delta_ns;
    *value = ((const pair_t *)reference)[index].value;
}

static cm1e_axis_table_t table;

static cm1e_axis_command_t command_of(cm1e_command_kind_t kind, const pair_t *pairs, int count)
{
    table = (cm1e_axis_table_t){.read = read_pair, .reference = pairs, .count = count};
    return (cm1e_axis_command_t){.kind = kind, .table = &table};
}

static cm1e_command_id_t start(cm1e_command_kind_t kind, const pair_t *pairs, int count)
{
    const cm1e_axis_command_t command = command_of(kind, pairs, count);
    return bench_start_command(&command);
}

static void expect_refused(cm1e_error_t error, const cm1e_axis_command_t *command)
{
    const cm1e_axis_info_t was = bench_info();
    const cm1e_command_id_t active = axis->commands.active;
    cm1e_command_id_t id = 99;
    const cm1e_error_t got = cm1e_axis_start(axis, command, &id);
    TEST_ASSERT_EQUAL_STRING(cm1e_strerror(error), cm1e_strerror(got));
    const cm1e_axis_info_t is = bench_info();
    TEST_ASSERT_EQUAL_UINT32(0, id);
    TEST_ASSERT_EQUAL_UINT32(active, axis->commands.active);
    TEST_ASSERT_EQUAL_INT(was.state, is.state);
    TEST_ASSERT_EQUAL_DOUBLE(was.set_position, is.set_position);
    TEST_ASSERT_EQUAL_DOUBLE(was.set_velocity, is.set_velocity);
}

static void expect_refusal(cm1e_error_t error, cm1e_command_kind_t kind, const pair_t *pairs, int count)
{
    const cm1e_axis_command_t command = command_of(kind, pairs, count);
    expect_refused(error, &command);
}

/* Why the table was refused. */
static void expect_said(const char *words)
{
    char text[512];
    cm1e_axis_error_text(cm1e_axis_reference(axis), text, sizeof text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, words), text);
}

static void expect_refusal_saying(const char *words, cm1e_command_kind_t kind, const pair_t *pairs, int count)
{
    expect_refusal(CM1E_ERROR_AXIS_TABLE, kind, pairs, count);
    expect_said(words);
}

static void expect(cm1e_command_id_t id, cm1e_command_state_t state, cm1e_error_t error)
{
    const cm1e_command_status_t status = cm1e_axis_command_status(axis, id);
    TEST_ASSERT_EQUAL_INT_MESSAGE(state, status.state, cm1e_strerror(status.error));
    TEST_ASSERT_EQUAL_STRING(cm1e_strerror(error), cm1e_strerror(status.error));
}

static const pair_t positions[] = {{500000000, 1.0}, {500000000, 3.0}, {1000000000, 3.5}, {500000000, 2.0}};
static const pair_t velocities[] = {{1000000000, 2.0}, {500000000, 2.0}, {1000000000, -1.0}};
static const pair_t accelerations[] = {{500000000, 4.0}, {1000000000, 4.0}, {1000000000, -2.0}, {500000000, -2.0}};
#define COUNT(pairs) ((int)(sizeof(pairs) / sizeof(pairs)[0]))

void setUp(void)
{
    fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    bus.config.axes[0].table_profiles = true;
    bench_create();
    bench_enable();
    bench_forget_steps();
}

void tearDown(void) { bench_end(); }

/* Every set-point keeps the limits of the axis, and follows from the one before. */
static void cycles_within_limits(int n)
{
    while (n-- > 0) {
        const cm1e_axis_info_t was = bench_info();
        bench_cycles(1);
        const cm1e_axis_info_t is = bench_info();
        const double t = axis->cycle_s, way = is.set_position - was.set_position;
        TEST_ASSERT_TRUE(fabs(is.set_velocity) <= axis->limits.maximum.velocity * (1.0 + 1e-9));
        TEST_ASSERT_TRUE(fabs(is.set_velocity - was.set_velocity) <= axis->limits.maximum.acceleration * t *
                         (1.0 + 1e-6));
        TEST_ASSERT_DOUBLE_WITHIN(axis->limits.maximum.acceleration * t * t + 1e-9,
                                  0.5 * (is.set_velocity + was.set_velocity) * t, way);
    }
}

/* ---- along the points -------------------------------------------------------------------------------------------- */

static void test_positions_are_passed_at_their_times_and_the_last_one_is_the_end(void)
{
    const cm1e_command_id_t id = start(CM1E_COMMAND_POSITION_PROFILE, positions, COUNT(positions));
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_DISCRETE_MOTION, bench_info().state);
    for (int i = 0; i < COUNT(positions); i++) {
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(id));
        cycles_within_limits((int)(positions[i].delta_ns / cycle_ns));
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, positions[i].value, bench_info().set_position);
    }
    expect(id, CM1E_COMMAND_DONE, CM1E_OK);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
    TEST_ASSERT_EQUAL_DOUBLE(2.0, bench_info().set_position);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, bench_info().set_velocity);
}

static void test_absolute_and_relative_positions(void)
{
    bench_wait(bench_move_to(-1.0, 2.0), 10000);
    const cm1e_command_id_t relative = start(CM1E_COMMAND_POSITION_PROFILE, positions, COUNT(positions));
    bench_wait(relative, 10000);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 1.0, bench_info().set_position);
    cm1e_axis_command_t command = command_of(CM1E_COMMAND_POSITION_PROFILE, positions, COUNT(positions));
    table.absolute = true;
    const cm1e_command_id_t absolute = bench_start_command(&command);
    bench_wait(absolute, 10000);
    TEST_ASSERT_EQUAL_DOUBLE(2.0, bench_info().set_position);
}

static void test_velocities_are_reached_at_their_times_and_the_last_one_is_kept(void)
{
    const cm1e_command_id_t id = start(CM1E_COMMAND_VELOCITY_PROFILE, velocities, COUNT(velocities));
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_CONTINUOUS_MOTION, bench_info().state);
    for (int i = 0; i < COUNT(velocities); i++) {
        TEST_ASSERT_FALSE(cm1e_axis_command_status(axis, id).reached);
        cycles_within_limits((int)(velocities[i].delta_ns / cycle_ns));
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, velocities[i].value, bench_info().set_velocity);
    }
    TEST_ASSERT_TRUE(cm1e_axis_command_status(axis, id).reached);
    cycles_within_limits(500);
    TEST_ASSERT_EQUAL_DOUBLE(-1.0, bench_info().set_velocity);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, bench_info().set_acceleration);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_CONTINUOUS_MOTION, bench_info().state);
    expect(id, CM1E_COMMAND_ACTIVE, CM1E_OK);
}

/* The area under the accelerations is the velocity at the end: 1 + 4 + 1 - 1, and a little more while it goes to 0. */
static void test_accelerations_and_the_velocity_that_they_make(void)
{
    const cm1e_command_id_t id = start(CM1E_COMMAND_ACCELERATION_PROFILE, accelerations, COUNT(accelerations));
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_CONTINUOUS_MOTION, bench_info().state);
    for (int i = 0; i < COUNT(accelerations); i++) {
        cycles_within_limits((int)(accelerations[i].delta_ns / cycle_ns));
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, accelerations[i].value, bench_info().set_acceleration);
    }
    cycles_within_limits(10);
    TEST_ASSERT_TRUE(cm1e_axis_command_status(axis, id).reached);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, bench_info().set_acceleration);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 5.0 - 2.0 * 2.0 / (2.0 * axis->limits.maximum.jerk), bench_info().set_velocity);
}

static void test_scales_and_offset(void)
{
    cm1e_axis_command_t command = command_of(CM1E_COMMAND_POSITION_PROFILE, positions, COUNT(positions));
    table.time_scale = 2.0;
    table.scale = -0.5;
    table.offset = 0.25;
    bench_start_command(&command);
    for (int i = 0; i < COUNT(positions); i++) {
        cycles_within_limits(2 * (int)(positions[i].delta_ns / cycle_ns));
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.25 - 0.5 * positions[i].value, bench_info().set_position);
    }
    command = command_of(CM1E_COMMAND_VELOCITY_PROFILE, velocities, COUNT(velocities));
    table.offset = 0.5;
    table.absolute = true;
    bench_start_command(&command);
    cycles_within_limits(1000);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 2.5, bench_info().set_velocity);
}

/* From a motion the table starts without a step, whatever the kind. */
static void test_start_in_motion_is_smooth(void)
{
    const struct {
        cm1e_command_kind_t kind;
        const pair_t *pairs;
        int count;
    } starts[] = {
        {CM1E_COMMAND_POSITION_PROFILE, positions, COUNT(positions)},
        {CM1E_COMMAND_VELOCITY_PROFILE, velocities, COUNT(velocities)},
        {CM1E_COMMAND_ACCELERATION_PROFILE, accelerations, COUNT(accelerations)},
    };
    for (size_t i = 0; i < sizeof starts / sizeof starts[0]; i++) {
        const cm1e_command_id_t before = bench_start_command(&(cm1e_axis_command_t){
            .kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 1.0, .acceleration = 2.0, .jerk = 20.0});
        cycles_within_limits(200); /* while it still accelerates */
        start(starts[i].kind, starts[i].pairs, starts[i].count);
        expect(before, CM1E_COMMAND_ABORTED, CM1E_OK);
        cycles_within_limits(1000);
        bench_wait(bench_start_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_HALT}), 10000);
    }
}

static void test_modulo_axis_follows_positions_over_its_end(void)
{
    bench_end();
    bus.config.axes[0].modulo_range = 2.0;
    bench_create();
    bench_enable();
    const cm1e_command_id_t id = start(CM1E_COMMAND_POSITION_PROFILE, positions, COUNT(positions));
    bench_cycles(1000);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 1.0, bench_info().set_position); /* 3 u */
    bench_wait(id, 10000);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0.0, fmod(bench_info().set_position + 1e-9, 2.0));
}

/* ---- refused ----------------------------------------------------------------------------------------------------- */

static void test_tables_that_are_none(void)
{
    static pair_t many[65];
    for (int i = 0; i < 65; i++)
        many[i] = (pair_t){second, 0.01 * i};
    const pair_t zero[] = {{second, 1.0}, {0, 2.0}}, back[] = {{second, 1.0}, {-1, 2.0}}, first_back[] = {{-1, 1.0}};
    const pair_t nan_value[] = {{second, NAN}}, inf_value[] = {{second, INFINITY}};
    const pair_t elsewhere[] = {{0, 0.5}, {second, 1.0}}, only_now[] = {{0, 0.0}};
    const cm1e_command_kind_t kind = CM1E_COMMAND_POSITION_PROFILE;
    expect_refusal_saying("has 65 points; 1 ... 64 are right", kind, many, 65);
    expect_refusal_saying("has 0 points", kind, many, 0);
    expect_refusal_saying("has -1 points", kind, many, -1);
    expect_refusal_saying("point 2 of the table comes 0 s after the one before; 1e-12 s or more is right.", kind,
                          zero, 2);
    expect_refusal_saying("point 2 of the table comes -1e-09 s", kind, back, 2);
    expect_refusal_saying("point 1 of the table comes -1e-09 s after the start; 1e-12 s or more is right, or 0.", kind,
                          first_back, 1);
    expect_refusal_saying("the position of point 1 of the table is nan", kind, nan_value, 1);
    expect_refusal_saying("the velocity of point 1 of the table is inf", CM1E_COMMAND_VELOCITY_PROFILE, inf_value, 1);
    expect_refusal_saying("the acceleration of point 1 of the table is inf", CM1E_COMMAND_ACCELERATION_PROFILE, inf_value, 1);
    expect_refusal_saying("begins with a jump: its first point, at time 0, has the position 0.5, and the axis has 0.", kind,
                          elsewhere, 2);
    expect_refusal_saying("has the velocity 0.5, and the axis has 0.", CM1E_COMMAND_VELOCITY_PROFILE, elsewhere, 2);
    expect_refusal_saying("the only point of the table is at time 0", kind, only_now, 1);
    const pair_t beyond[] = {{second, 1e300}, {second, -1e300}};
    expect_refusal_saying("the velocity of point 1 of the table is 1e+300; a number between -1e30 and 1e30",
                          CM1E_COMMAND_VELOCITY_PROFILE, beyond, 2);
    static const struct {
        double time_scale, scale, offset;
        const char *words;
    } factors[] = {
        {-1.0, 1.0, 0.0, "TimeScale is -1; above 0 is right, or 0"},
        {NAN, 1.0, 0.0, "TimeScale is nan"},
        {INFINITY, 1.0, 0.0, "TimeScale is inf"},
        {1e-12, 1.0, 0.0, "point 1 of the table comes 5e-13 s after the start; 1e-12 s or more is right"},
        {1e300, 1.0, 0.0, "the numbers of the table are so large"},
        {1.0, NAN, 0.0, "the factor of all values is nan"},
        {1.0, 1.0, INFINITY, "Offset is inf"},
    };
    for (size_t i = 0; i < sizeof factors / sizeof factors[0]; i++) {
        const cm1e_axis_command_t command = command_of(kind, positions, COUNT(positions));
        table.time_scale = factors[i].time_scale;
        table.scale = factors[i].scale;
        table.offset = factors[i].offset;
        expect_refused(CM1E_ERROR_AXIS_TABLE, &command);
        expect_said(factors[i].words);
    }
    const pair_t begins_here[] = {{0, 0.0}, {1, 1.0}};
    const cm1e_axis_command_t too_close = command_of(kind, begins_here, 2);
    table.time_scale = 1e-6;
    expect_refused(CM1E_ERROR_AXIS_TABLE, &too_close);
    expect_said("point 2 of the table comes 1e-15 s after the one before");
    const cm1e_axis_table_t unread = {.count = 1};
    const cm1e_axis_command_t none = {.kind = kind}, no_reader = {.kind = kind, .table = &unread};
    expect_refused(CM1E_ERROR_AXIS_TABLE, &none);
    expect_said("no table was given");
    expect_refused(CM1E_ERROR_AXIS_TABLE, &no_reader);
    TEST_ASSERT_EQUAL_INT(64, CM1E_TABLE_POINTS_MAX);
    const cm1e_command_id_t id = start(kind, many, 64);
    bench_cycles(2000);
    expect(id, CM1E_COMMAND_ACTIVE, CM1E_OK);
}

static void test_limits_are_checked_over_the_whole_table(void)
{
    const pair_t fast[] = {{second, 20.0}, {second, 100.0}, {second, 120.0}};
    const pair_t fast_velocity[] = {{10 * second, 49.0}, {10 * second, 51.0}};
    const pair_t steep[] = {{second, 0.0}, {100000000, 20.0}};
    const pair_t step_of_acceleration[] = {{0, 1.0}, {second, 1.0}}; /* an infinite jerk */
    expect_refusal(CM1E_ERROR_AXIS_VELOCITY_RANGE, CM1E_COMMAND_POSITION_PROFILE, fast, 3);
    expect_refusal(CM1E_ERROR_AXIS_VELOCITY_RANGE, CM1E_COMMAND_VELOCITY_PROFILE, fast_velocity, 2); /* of the motor */
    expect_refusal(CM1E_ERROR_AXIS_DYNAMICS_RANGE, CM1E_COMMAND_VELOCITY_PROFILE, steep, 2);
    expect_refusal(CM1E_ERROR_AXIS_DYNAMICS_RANGE, CM1E_COMMAND_ACCELERATION_PROFILE, step_of_acceleration, 2);
    char text[512];
    expect_refusal(CM1E_ERROR_AXIS_VELOCITY_RANGE, CM1E_COMMAND_VELOCITY_PROFILE, fast_velocity, 2);
    cm1e_axis_error_text(cm1e_axis_reference(axis), text, sizeof text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, "velocity 5"), text); /* a spline goes a little beyond its points */
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, "up to 50 u/s"), text);
}

static void with_software_limits(double negative, double positive)
{
    bench_end();
    bus.state = READY_TO_SWITCH_ON;
    bus.position = bus.velocity_raw = 0;
    bus.config.axes[0].software_limit_negative = negative;
    bus.config.axes[0].software_limit_positive = positive;
    bench_create();
    bench_enable();
}

static void test_software_limits(void)
{
    with_software_limits(-1.0, 3.49); /* the way to 3.5 */
    expect_refusal(CM1E_ERROR_AXIS_POSITION_RANGE, CM1E_COMMAND_POSITION_PROFILE, positions, COUNT(positions));
    with_software_limits(-1.0, 5.0);
    const cm1e_command_id_t id = start(CM1E_COMMAND_POSITION_PROFILE, positions, COUNT(positions));
    bench_wait(id, 10000);
    expect(id, CM1E_COMMAND_DONE, CM1E_OK);
    /* A velocity that is kept meets the limit in the end, as MC_MoveVelocity does. */
    const pair_t away[] = {{second, 0.5}};
    const cm1e_command_id_t endless = start(CM1E_COMMAND_VELOCITY_PROFILE, away, 1);
    bench_cycles(8000);
    expect(endless, CM1E_COMMAND_ERROR, CM1E_ERROR_AXIS_ERROR_STOP);
    TEST_ASSERT_TRUE(bench_info().set_position <= 5.0 + 1e-6);
}

static void test_directions(void)
{
    const pair_t out_and_back[] = {{second, 1.0}, {second, 0.5}}, out[] = {{second, 1.0}, {second, 2.0}};
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_power(axis, &owner, true, true, false));
    expect_refusal(CM1E_ERROR_AXIS_DIRECTION_DISABLED, CM1E_COMMAND_POSITION_PROFILE, out_and_back, 2);
    cm1e_axis_command_t command = command_of(CM1E_COMMAND_POSITION_PROFILE, out, 2);
    table.scale = -1.0;
    expect_refused(CM1E_ERROR_AXIS_DIRECTION_DISABLED, &command);
    const cm1e_command_id_t id = start(CM1E_COMMAND_POSITION_PROFILE, out, 2);
    bench_wait(id, 10000);
    expect(id, CM1E_COMMAND_DONE, CM1E_OK);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_power(axis, &owner, true, false, true));
    expect_refusal(CM1E_ERROR_AXIS_DIRECTION_DISABLED, CM1E_COMMAND_VELOCITY_PROFILE, velocities, COUNT(velocities));

    /* Taken away on the way: it fails only where it still goes there. */
    for (int after_ms = 100; after_ms < 2000; after_ms += 190) {
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_power(axis, &owner, true, true, true));
        const cm1e_command_id_t moving = start(CM1E_COMMAND_POSITION_PROFILE, out_and_back, 2);
        bench_cycles(after_ms);
        const bool went_back = bench_info().set_velocity < 0.0;
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_power(axis, &owner, true, false, true));
        bench_wait(moving, 10000);
        expect(moving, went_back ? CM1E_COMMAND_DONE : CM1E_COMMAND_ERROR,
               went_back ? CM1E_OK : CM1E_ERROR_AXIS_DIRECTION_DISABLED);
        bench_cycles(300);
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
    }
}

/* A motion that is locked to time knows no override, neither one from before nor one that comes on the way. */
static void test_override_does_not_act(void)
{
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_set_override(axis, 0.5, 0.5, 0.5));
    start(CM1E_COMMAND_POSITION_PROFILE, positions, COUNT(positions));
    for (int i = 0; i < COUNT(positions); i++) {
        cycles_within_limits((int)(positions[i].delta_ns / cycle_ns));
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_set_override(axis, 0.1 * i, 1.0, 1.0));
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, positions[i].value, bench_info().set_position);
    }
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_set_override(axis, 1.0, 1.0, 1.0));
}

/* A move that an override of 0 holds is aborted as any other. */
static void test_table_takes_over_from_a_move_that_waits_for_its_override(void)
{
    const cm1e_command_id_t move = bench_move_to(5.0, 1.0);
    bench_cycles(300);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_set_override(axis, 0.0, 1.0, 1.0));
    bench_cycles(500);
    const double from = bench_info().set_position;
    const cm1e_command_id_t id = start(CM1E_COMMAND_POSITION_PROFILE, positions, COUNT(positions));
    expect(move, CM1E_COMMAND_ABORTED, CM1E_OK);
    bench_wait(id, 10000);
    expect(id, CM1E_COMMAND_DONE, CM1E_OK);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, from + 2.0, bench_info().set_position);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_set_override(axis, 1.0, 1.0, 1.0));
}

/* ---- buffered ---------------------------------------------------------------------------------------------------- */

static cm1e_command_id_t buffered(cm1e_command_kind_t kind, const pair_t *pairs, int count)
{
    cm1e_axis_command_t command = command_of(kind, pairs, count);
    command.buffer_mode = mcBuffered;
    return bench_start_command(&command);
}

static void test_table_waits_behind_a_move_and_a_move_behind_a_table(void)
{
    const cm1e_command_id_t move = bench_move_to(1.0, 2.0);
    pair_t changed[COUNT(positions)];
    memcpy(changed, positions, sizeof changed);
    const cm1e_command_id_t along = buffered(CM1E_COMMAND_POSITION_PROFILE, changed, COUNT(positions));
    memset(changed, 0, sizeof changed); /* the table was copied */
    const cm1e_command_id_t back = bench_start_command(&(cm1e_axis_command_t){
        .kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = 0.0, .velocity = 2.0, .buffer_mode = mcBuffered});
    expect(along, CM1E_COMMAND_BUFFERED, CM1E_OK);
    bench_wait(move, 10000);
    expect(along, CM1E_COMMAND_ACTIVE, CM1E_OK);
    bench_wait(along, 10000);
    expect(along, CM1E_COMMAND_DONE, CM1E_OK);
    TEST_ASSERT_DOUBLE_WITHIN(0.01, 3.0, bench_info().set_position);
    bench_wait(back, 10000);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, bench_info().set_position);
}

static void test_next_command_begins_when_the_velocities_are_through(void)
{
    const cm1e_command_id_t along = start(CM1E_COMMAND_VELOCITY_PROFILE, velocities, COUNT(velocities));
    const cm1e_command_id_t next = buffered(CM1E_COMMAND_ACCELERATION_PROFILE, accelerations, COUNT(accelerations));
    cycles_within_limits(2490);
    expect(next, CM1E_COMMAND_BUFFERED, CM1E_OK);
    cycles_within_limits(20);
    expect(along, CM1E_COMMAND_ABORTED, CM1E_OK);
    expect(next, CM1E_COMMAND_ACTIVE, CM1E_OK);
    cycles_within_limits(3500);
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, 4.0, bench_info().set_velocity);
}

static void test_what_cannot_wait_is_refused(void)
{
    cm1e_axis_command_t command = command_of(CM1E_COMMAND_POSITION_PROFILE, positions, COUNT(positions));
    bench_move_velocity(1.0);
    for (int mode = mcBlendingLow; mode <= mcBlendingHigh; mode++) {
        command.buffer_mode = (MC_BUFFER_MODE)mode;
        expect_refused(CM1E_ERROR_AXIS_BUFFER_MODE, &command);
    }
    bench_move_to(20.0, 1.0);
    const pair_t bad[] = {{-1, 0.0}};
    command = command_of(CM1E_COMMAND_POSITION_PROFILE, bad, 1);
    command.buffer_mode = mcBuffered;
    expect_refused(CM1E_ERROR_AXIS_TABLE, &command);
    buffered(CM1E_COMMAND_POSITION_PROFILE, positions, COUNT(positions));
    command = command_of(CM1E_COMMAND_POSITION_PROFILE, positions, COUNT(positions));
    command.buffer_mode = mcBuffered;
    expect_refused(CM1E_ERROR_FULL, &command); /* one at a time */
    bench_end();
    bus.config.axes[0].table_profiles = false;
    bench_create();
    bench_enable();
    bench_move_to(50.0, 1.0);
    expect_refused(CM1E_ERROR_AXIS_NO_TABLES, &command);
    command.buffer_mode = mcAborting;
    expect_refused(CM1E_ERROR_AXIS_NO_TABLES, &command);
}

/* Limits that the axis does not keep at the moment of the start show then. */
static void test_waiting_table_that_does_not_fit_fails_when_its_turn_comes(void)
{
    with_software_limits(-10.0, 10.0);
    const cm1e_command_id_t move = bench_move_to(8.0, 5.0);
    const cm1e_command_id_t along = buffered(CM1E_COMMAND_POSITION_PROFILE, positions, COUNT(positions));
    bench_wait(move, 10000);
    expect(along, CM1E_COMMAND_ERROR, CM1E_ERROR_AXIS_POSITION_RANGE);
    bench_cycles(10);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
    TEST_ASSERT_EQUAL_DOUBLE(8.0, bench_info().set_position);
}

/* ---- interruptions ----------------------------------------------------------------------------------------------- */

static void test_move_stop_and_power_off_at_every_cycle(void)
{
    for (int n = 1; n < 2500; n += 61)
        for (int what = 0; what < 3; what++) {
            setUp();
            const cm1e_command_id_t id = start(CM1E_COMMAND_POSITION_PROFILE, positions, COUNT(positions));
            cycles_within_limits(n);
            expect(id, CM1E_COMMAND_ACTIVE, CM1E_OK);
            if (what == 0)
                bench_move_to(0.0, 3.0);
            else if (what == 1)
                cm1e_axis_hold_stop(axis, bench_start_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_STOP}),
                                    false);
            else
                bench_power(false);
            expect(id, CM1E_COMMAND_ABORTED, CM1E_OK);
            cycles_within_limits(3000);
            TEST_ASSERT_EQUAL_INT(what == 2 ? CM1E_AXIS_DISABLED : CM1E_AXIS_STANDSTILL, bench_info().state);
            TEST_ASSERT_EQUAL_DOUBLE(0.0, bench_info().set_velocity);
        }
}

static void test_bus_lost_on_the_way_brakes(void)
{
    const cm1e_command_id_t id = start(CM1E_COMMAND_VELOCITY_PROFILE, velocities, COUNT(velocities));
    bench_cycles(900);
    received = health = CM1E_ERROR_BUS_LOST;
    bench_cycles(300);
    expect(id, CM1E_COMMAND_ERROR, CM1E_ERROR_AXIS_ERROR_STOP);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_ERROR_STOP, bench_info().state);
    TEST_ASSERT_NOT_EQUAL_INT(OPERATION_ENABLED, bus.state);
}

/* The motor was near its maximum velocity, and gets back to its speed with what is left below that: the time of the table
 * runs slower for a while. Its way stays, and it arrives a little later. */
static void test_a_short_silence_makes_a_fast_table_later_and_nothing_else(void)
{
    pair_t pairs[] = {{second, 1.0}, {second, 2.0}};
    int arrived[3], fastest_at = 0;
    double fastest = 0.0;
    (void)start(CM1E_COMMAND_POSITION_PROFILE, pairs, COUNT(pairs));
    for (int n = 1; n <= 2000; n++) {
        bench_cycles(1);
        fastest_at = bench_info().set_velocity > fastest ? n : fastest_at;
        fastest = fmax(fastest, bench_info().set_velocity);
    }
    const double most = axis->limits.maximum.velocity;
    for (int i = 0; i < COUNT(pairs); i++)
        pairs[i].value *= 0.99 * most / fastest;
    for (int silent = 0; silent <= 2; silent++) {
        bench_end();
        setUp();
        const cm1e_command_id_t id = start(CM1E_COMMAND_POSITION_PROFILE, pairs, COUNT(pairs));
        cycles_within_limits(fastest_at);
        received = CM1E_ERROR_TIMEOUT;
        bench_cycles(silent);
        received = CM1E_OK;
        const double before = bench_info().set_position;
        bench_cycles(1);
        TEST_ASSERT_DOUBLE_WITHIN(0.01 * most * axis->cycle_s, bench_info().set_velocity * axis->cycle_s,
                                  bench_info().set_position - before);
        TEST_ASSERT_DOUBLE_WITHIN(0.01 * most, (silent ? 1.0 - 0.08 * silent : 0.99) * most, bench_info().set_velocity);
        for (arrived[silent] = fastest_at + 1; bench_state_of(id) == CM1E_COMMAND_ACTIVE && arrived[silent] < 3000;
             arrived[silent]++)
            cycles_within_limits(1);
        expect(id, CM1E_COMMAND_DONE, CM1E_OK);
        TEST_ASSERT_EQUAL_DOUBLE(0.0, bench_info().set_velocity);
        TEST_ASSERT_EQUAL_DOUBLE(pairs[1].value, bench_info().set_position);
    }
    TEST_ASSERT_EQUAL_INT(2000, arrived[0]);
    TEST_ASSERT_TRUE(arrived[1] > arrived[0] && arrived[1] < arrived[0] + 50);
    TEST_ASSERT_TRUE(arrived[2] > arrived[1] && arrived[2] < arrived[0] + 100);
}

/* ---- random ------------------------------------------------------------------------------------------------------ */

static uint32_t seed;

static double random_between(double low, double high)
{
    seed = seed * 1664525u + 1013904223u;
    return low + (high - low) * (double)(seed >> 8) / (double)(1u << 24);
}

static void test_random_tables_are_refused_or_kept_to_at_every_sample(void)
{
    int taken = 0, refused = 0;
    for (uint32_t first = 1; first <= 300; first++) {
        seed = first;
        with_software_limits(-30.0, 30.0);
        pair_t pairs[20];
        const int count = 1 + (int)random_between(0, 19.99);
        const cm1e_command_kind_t kind = (cm1e_command_kind_t)(CM1E_COMMAND_POSITION_PROFILE + first % 3);
        const double size = pow(10.0, random_between(-1.0, 1.3));
        for (int i = 0; i < count; i++)
            pairs[i] = (pair_t){(TIME)random_between(1e7, 4e8), random_between(-size, size)};
        if (first % 2) {
            bench_move_velocity(random_between(0.1, 5.0));
            bench_cycles((int)random_between(1, 400));
        }
        const cm1e_axis_command_t command = command_of(kind, pairs, count);
        table.absolute = first % 5 == 0;
        cm1e_command_id_t id;
        char what[32];
        snprintf(what, sizeof what, "seed %u", (unsigned)first);
        if (cm1e_axis_start(axis, &command, &id) != CM1E_OK) {
            refused++;
            continue;
        }
        taken++;
        while (bench_state_of(id) == CM1E_COMMAND_ACTIVE && !cm1e_axis_command_status(axis, id).reached) {
            cycles_within_limits(1);
            const double position = bench_info().set_position;
            TEST_ASSERT_TRUE_MESSAGE(position < 30.0 + 1e-6 && position > -30.0 - 1e-6, what);
        }
        TEST_ASSERT_TRUE_MESSAGE(bench_state_of(id) == CM1E_COMMAND_DONE || axis->setpoint.reached, what);
    }
    TEST_ASSERT_GREATER_THAN_INT(30, taken);
    TEST_ASSERT_GREATER_THAN_INT(30, refused);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_positions_are_passed_at_their_times_and_the_last_one_is_the_end);
    RUN_TEST(test_absolute_and_relative_positions);
    RUN_TEST(test_velocities_are_reached_at_their_times_and_the_last_one_is_kept);
    RUN_TEST(test_accelerations_and_the_velocity_that_they_make);
    RUN_TEST(test_scales_and_offset);
    RUN_TEST(test_start_in_motion_is_smooth);
    RUN_TEST(test_modulo_axis_follows_positions_over_its_end);
    RUN_TEST(test_tables_that_are_none);
    RUN_TEST(test_limits_are_checked_over_the_whole_table);
    RUN_TEST(test_software_limits);
    RUN_TEST(test_directions);
    RUN_TEST(test_override_does_not_act);
    RUN_TEST(test_table_takes_over_from_a_move_that_waits_for_its_override);
    RUN_TEST(test_table_waits_behind_a_move_and_a_move_behind_a_table);
    RUN_TEST(test_next_command_begins_when_the_velocities_are_through);
    RUN_TEST(test_what_cannot_wait_is_refused);
    RUN_TEST(test_waiting_table_that_does_not_fit_fails_when_its_turn_comes);
    RUN_TEST(test_move_stop_and_power_off_at_every_cycle);
    RUN_TEST(test_bus_lost_on_the_way_brakes);
    RUN_TEST(test_a_short_silence_makes_a_fast_table_later_and_nothing_else);
    RUN_TEST(test_random_tables_are_refused_or_kept_to_at_every_sample);
    return UNITY_END();
}
