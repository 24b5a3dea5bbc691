/* A modulo axis: positions within a turn for ever, and the way to a position by every direction (3.5, 2.4.2). */
#include <math.h>
#include <stdlib.h>

#include "../support/axis_bench.h"
#include "../support/xorshift.h"

__extension__ typedef __int128 wide_t;

static uint64_t seed;

static uint64_t draw(uint64_t below)
{
    return (xorshift(&seed) >> 11) % below;
}

static double uniform(double low, double high) { return low + (high - low) * (double)draw(1 << 30) / (1 << 30); }

/* 360 degrees behind 7:3: a turn is 350,000/3 counts. */
static void table(bool invert)
{
    fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    cm1e_axis_config_t *config = &bus.config.axes[0];
    config->gear_numerator = 7;
    config->gear_denominator = 3;
    config->units_per_revolution = 360;
    config->modulo_range = 360;
    config->invert = invert;
    bench_create();
}

void setUp(void)
{
    const char *given = getenv("CM1E_TEST_SEED");
    seed = given ? strtoull(given, NULL, 0) : 0x5EED0002;
    table(false);
}
void tearDown(void)
{
    if (Unity.CurrentTestFailed)
        printf("CM1E_TEST_SEED=0x%llx\n", (unsigned long long)seed);
    bench_end();
}

/* ---- where it is ------------------------------------------------------------------------------------------------- */

/* u within a turn, from whole numbers: counts in the direction of u, a turn of numerator/denominator counts. */
static double exactly(int64_t counts, int64_t numerator, int64_t denominator, double range)
{
    wide_t rest = (wide_t)counts * denominator % numerator;
    if (rest < 0)
        rest += numerator;
    return (double)(int64_t)rest * (range / (double)numerator);
}

static void expect_at(int64_t counts)
{
    const double position = bench_info().actual_position;
    TEST_ASSERT_TRUE(position >= 0.0 && position < 360.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-10, exactly(counts, 350000, 3, 360), position);
}

/* A billion turns with the motor, in jumps just below half of the drive's range. */
static void test_billion_turns_and_back_are_exact(void)
{
    for (int invert = 0; invert < 2; invert++) {
        table(invert);
        const int64_t start = axis->position.actual_counts, jump = 2147483646;
        const int jumps = 54400;
        for (int way = 1; way >= -1; way -= 2)
            for (int n = 1; n <= jumps; n++) {
                bus.position = (int32_t)((uint32_t)bus.position + (uint32_t)(way * jump));
                fake_bus_show(&bus);
                cm1e_axis_inputs(axis, CM1E_OK, CM1E_OK, bus.clock.virtual_now_ns);
                if (n % 1000 == 0)
                    expect_at(invert ? start - axis->position.actual_counts : axis->position.actual_counts - start);
                if (n == jumps && way == 1)
                    TEST_ASSERT_TRUE(axis->position.actual_counts * 3 / 350000 >= 1000000000);
            }
        TEST_ASSERT_EQUAL_INT64(start, axis->position.actual_counts);
        TEST_ASSERT_EQUAL_DOUBLE(0.0, bench_info().actual_position);
    }
}

static void test_turns_begin_at_their_multiple_of_a_fraction(void)
{
    for (int n = 0; n < 100000; n++) {
        const int64_t turn = (int64_t)draw(UINT64_C(20000000000)) - INT64_C(10000000000);
        wide_t begin = (wide_t)turn * 350000 / 3, rest = (wide_t)turn * 350000 % 3;
        begin -= rest < 0;
        rest = rest < 0 ? rest + 3 : rest;
        axis->position.actual_counts = (int64_t)begin + (rest > 0); /* the first whole count in the turn */
        const double first = bench_info().actual_position;
        axis->position.actual_counts--;
        const double last = bench_info().actual_position;
        TEST_ASSERT_DOUBLE_WITHIN(1e-10, (rest > 0 ? (double)(3 - rest) / 3 : 0.0) * 360 * 3 / 350000, first);
        TEST_ASSERT_TRUE(last > 359.99 && last < 360.0);
    }
}

/* Whatever the gear, the range and its decimals. */
static void test_random_turns_are_exact(void)
{
    for (int n = 0; n < 300; n++) {
        fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
        cm1e_axis_config_t *config = &bus.config.axes[0];
        config->gear_numerator = (uint32_t)draw(1000) + 1;
        config->gear_denominator = (uint32_t)draw(1000) + 1;
        const int tenths = (int)draw(100000) + 1, range = (int)draw(100000) + 1; /* of a unit */
        config->units_per_revolution = tenths / 10.0;
        config->modulo_range = range / 10.0;
        const double counts = 50000.0 * range / tenths * config->gear_numerator / config->gear_denominator;
        if (counts < 1000 || counts > 1e12)
            continue;
        bench_create();
        const int64_t numerator = INT64_C(50000) * config->gear_numerator * range;
        const int64_t denominator = (int64_t)config->gear_denominator * tenths;
        TEST_ASSERT_TRUE((wide_t)axis->position.turn.numerator * denominator ==
                         (wide_t)axis->position.turn.denominator * numerator);
        for (int k = 0; k < 300; k++) {
            const int64_t at = (int64_t)((double)(INT64_C(1) << draw(52)) * uniform(-1, 1));
            axis->position.actual_counts = at;
            const double position = bench_info().actual_position;
            TEST_ASSERT_TRUE(position >= 0.0 && position < config->modulo_range);
            TEST_ASSERT_DOUBLE_WITHIN(1e-12 * config->modulo_range + 1e-9 * config->modulo_range / counts,
                                      exactly(at, numerator, denominator, config->modulo_range), position);
        }
    }
}

/* ---- the way to a position --------------------------------------------------------------------------------------- */

static const MC_DIRECTION directions[] = {(MC_DIRECTION)0, mcPositiveDirection, mcNegativeDirection, mcShortestWay,
                                          mcCurrentDirection};

static bool goes_positive(MC_DIRECTION direction, double velocity, double way)
{
    if (direction == mcShortestWay || direction == 0) {
        if (fabs(remainder(way, 360.0)) < 0.5 * 360 * 3 / 350000)
            return velocity >= 0.0; /* it is there */
        while (way > 180.0)
            way -= 360.0;
        while (way <= -180.0)
            way += 360.0;
        return way >= 0.0;
    }
    if (direction == mcCurrentDirection)
        return velocity != 0.0 ? velocity > 0.0 : axis->setpoint.positive_before;
    return direction != mcNegativeDirection;
}

/* The position asked for, in the direction asked for as seen from the point of the stop, and the first such. */
static void test_target_is_the_first_repetition_beyond_the_stop(void)
{
    const double count = 360.0 * 3 / 350000;
    for (int n = 0; n < 300000; n++) {
        if (n % 100000 == 0)
            table(n % 200000 == 0);
        const MC_DIRECTION direction = directions[draw(5)];
        const position_t from = {(int64_t)uniform(-1e14, 1e14), draw(2) ? uniform(0, 1) : 0.0};
        const double start = cm1e_axis_units(axis, from);
        const double position = draw(10) ? uniform(0, 359.999) : start;
        const double velocity = draw(3) ? uniform(-1000, 1000) : 0.0, stop = velocity * uniform(0.0, 1.0);
        axis->setpoint.positive_before = draw(2);
        position_t target;
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_resolve_target(axis, position, direction, from, velocity, stop,
                                                                &target));
        const double shown = cm1e_axis_units(axis, target), error = fabs(shown - position);
        TEST_ASSERT_TRUE(error < 1e-9 || error > 360.0 - 1e-9);
        const double way = cm1e_position_minus(target, from) / axis->position.scale;
        const double beyond = way - stop;
        if (goes_positive(direction, velocity, position - start)) {
            TEST_ASSERT_TRUE(beyond > -0.6 * count);
            TEST_ASSERT_TRUE(beyond - 360.0 < -0.4 * count);
        } else {
            TEST_ASSERT_TRUE(beyond < 0.6 * count);
            TEST_ASSERT_TRUE(beyond + 360.0 > 0.4 * count);
        }
    }
}

/* Half a turn away, however the numbers of counts and degrees round. */
static void test_half_a_turn_away_the_shortest_way_is_positive(void)
{
    static const uint32_t gears[][2] = {{1, 1}, {3, 1}, {7, 3}, {1, 7}};
    for (size_t n = 0; n < 2 * sizeof gears / sizeof gears[0]; n++) {
        fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
        cm1e_axis_config_t *config = &bus.config.axes[0];
        config->gear_numerator = gears[n / 2][0];
        config->gear_denominator = gears[n / 2][1];
        config->units_per_revolution = config->modulo_range = 360;
        config->invert = n % 2;
        bench_create();
        for (int from = 0; from < 360; from++) {
            position_t at, target;
            TEST_ASSERT_TRUE(cm1e_axis_position_from_units(axis, from, &at));
            TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_resolve_target(axis, (from + 180) % 360, mcShortestWay, at, 0.0,
                                                                    0.0, &target));
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, 180.0, cm1e_position_minus(target, at) / axis->position.scale);
        }
    }
}

static void test_positions_outside_a_turn_and_wrong_directions_are_refused(void)
{
    static const double wrong[] = {360.0, 360.0001, -1e-12, -1.0, 720.0, NAN, INFINITY, -INFINITY, 1e300};
    bench_enable();
    cm1e_command_id_t id;
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        const cm1e_axis_command_t command = {.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = wrong[i], .velocity = 10,
                                             .direction = mcShortestWay};
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, cm1e_axis_start(axis, &command, &id));
    }
    const cm1e_axis_command_t command = {.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = 10, .velocity = 10,
                                         .direction = (MC_DIRECTION)5};
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_DIRECTION, cm1e_axis_start(axis, &command, &id));
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
}

static cm1e_command_id_t move(double position, MC_DIRECTION direction)
{
    return bench_start_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = position,
                                                      .velocity = 5000, .direction = direction});
}

/* Way in u that the move took, by the motor. */
static double moved(double position, MC_DIRECTION direction)
{
    const int64_t before = axis->position.actual_counts;
    bench_wait(move(position, direction), 20000);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, position, bench_info().set_position);
    return (double)(axis->position.actual_counts - before) / axis->position.scale;
}

static void test_every_direction_takes_its_way(void)
{
    for (int invert = 0; invert < 2; invert++) {
        table(invert);
        bench_enable();
        const double count = 0.0031;
        TEST_ASSERT_DOUBLE_WITHIN(count, 90, moved(90, mcPositiveDirection));
        TEST_ASSERT_DOUBLE_WITHIN(count, 0, moved(90, mcPositiveDirection)); /* it is there */
        TEST_ASSERT_DOUBLE_WITHIN(count, 0, moved(90, mcNegativeDirection));
        TEST_ASSERT_DOUBLE_WITHIN(count, -340, moved(110, mcNegativeDirection));
        TEST_ASSERT_DOUBLE_WITHIN(count, 180, moved(290, mcShortestWay)); /* both equal: positive */
        TEST_ASSERT_DOUBLE_WITHIN(count, 80, moved(10, mcShortestWay));
        TEST_ASSERT_DOUBLE_WITHIN(count, -20, moved(350, mcShortestWay));
        TEST_ASSERT_DOUBLE_WITHIN(count, -340, moved(10, mcCurrentDirection)); /* as it last moved */
        TEST_ASSERT_DOUBLE_WITHIN(count, 350, moved(0, mcPositiveDirection));
        TEST_ASSERT_DOUBLE_WITHIN(count, 359, moved(359, mcCurrentDirection));
        TEST_ASSERT_DOUBLE_WITHIN(count, 1, moved(0, (MC_DIRECTION)0));
    }
}

/* Too late to stop there, the axis goes on to the next repetition in the direction asked for and never turns back. */
static void test_insufficient_braking_distance_goes_on_to_the_next_repetition(void)
{
    table(false);
    bench_enable();
    const int64_t before = axis->position.actual_counts;
    bench_move_velocity(2000);
    while (bench_info().set_velocity < 1999 || bench_info().actual_position < 80 || bench_info().actual_position > 88)
        bench_cycles(1);
    const cm1e_command_id_t id = bench_start_command(&(cm1e_axis_command_t){
        .kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = 90, .velocity = 2000, .deceleration = 10000,
        .direction = mcPositiveDirection}); /* stops in some 200 degrees */
    const int64_t there = axis->position.actual_counts;
    int64_t last = there;
    while (bench_state_of(id) == CM1E_COMMAND_ACTIVE) {
        bench_cycles(1);
        TEST_ASSERT_TRUE(axis->position.actual_counts >= last);
        last = axis->position.actual_counts;
    }
    TEST_ASSERT_TRUE(there > before);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 90, bench_info().set_position);
    TEST_ASSERT_DOUBLE_WITHIN(10, 360, (double)(last - there) / axis->position.scale);
}

static void test_asked_to_turn_round_it_brakes_first(void)
{
    bench_enable();
    bench_move_velocity(2000);
    bench_cycles(1000);
    const int64_t there = axis->position.actual_counts;
    const double from = bench_info().set_position;
    bench_wait(move(fmod(from + 1.0, 360.0), mcNegativeDirection), 20000);
    /* beyond the braking distance it comes back to the first repetition: that one degree ahead, or those after it */
    const double way = (double)(axis->position.actual_counts - there) / axis->position.scale;
    TEST_ASSERT_TRUE(way >= 0.99);
    TEST_ASSERT_DOUBLE_WITHIN(2.1, 1.0, fmod(way, 360.0)); /* the motor is a cycle behind */
    TEST_ASSERT_LESS_OR_EQUAL_INT64((int64_t)(2500000.0 * axis->cycle_s) + 1, worst_step);
}

/* ---- what is shown ----------------------------------------------------------------------------------------------- */

/* Within the turn, also as a trace prints it, and beside each other where the motor is at the set-point. */
static void expect_shown(void)
{
    const double range = axis->position.modulo_range, count = 1.0 / fabs(axis->position.scale);
    const cm1e_axis_info_t info = bench_info();
    const double shown[] = {info.set_position, info.actual_position};
    for (int i = 0; i < 2; i++) {
        char text[32];
        snprintf(text, sizeof text, "%.9g", shown[i]);
        TEST_ASSERT_TRUE(shown[i] >= 0.0 && shown[i] < range);
        TEST_ASSERT_TRUE_MESSAGE(i == 1 || info.set_velocity != 0.0 || strtod(text, NULL) < range, text);
    }
    if (info.set_velocity == 0.0 && fabs(cm1e_position_minus(axis->setpoint.position, axis_actual(axis))) <= 0.5)
        TEST_ASSERT_DOUBLE_WITHIN(0.5 * count + 1e-9 * range, info.set_position, info.actual_position);
}

static void random_table(void)
{
    double counts;
    do {
        fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
        cm1e_axis_config_t *config = &bus.config.axes[0];
        config->gear_numerator = (uint32_t)draw(50) + 1;
        config->gear_denominator = (uint32_t)draw(50) + 1;
        config->units_per_revolution = draw(2) ? 360.0 : (double)(draw(9999) + 1) / 10.0;
        config->modulo_range = config->units_per_revolution;
        config->invert = draw(2);
        counts = 50000.0 * config->gear_numerator / config->gear_denominator;
    } while (counts < 10000.0 || counts > 500000.0);
    bench_create();
    bench_enable();
}

static void test_a_move_to_0_shows_0_on_the_set_and_on_the_actual_side(void)
{
    for (int n = 0; n < 150; n++) {
        random_table();
        for (int k = 0; k < 6; k++) {
            const double range = axis->position.modulo_range, away = uniform(-0.3, 0.3) * range;
            const double velocity = uniform(0.5, 1.0) * fmin(axis->limits.maximum.velocity, 20.0 * range);
            bench_wait(bench_start_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_RELATIVE, .position = away,
                                                                  .velocity = velocity}), 20000);
            const MC_DIRECTION direction = directions[draw(5)];
            const cm1e_command_id_t id = bench_start_command(&(cm1e_axis_command_t){
                .kind = CM1E_COMMAND_MOVE_ABSOLUTE, .velocity = velocity, .direction = direction});
            while (bench_state_of(id) == CM1E_COMMAND_ACTIVE) {
                bench_cycles(1);
                expect_shown();
            }
            bench_cycles(2);
            TEST_ASSERT_DOUBLE_WITHIN(1e-9 * range, 0.0, bench_info().set_position);
            expect_shown();
        }
    }
}

/* At rest at any part of a count on both sides of the beginning of a turn. */
static void test_set_and_actual_position_are_shown_on_the_same_side_of_a_turn(void)
{
    for (int n = 0; n < 100; n++) {
        random_table();
        for (int k = 0; k < 40; k++) {
            const double near = (k % 4 == 0 ? uniform(-1e-9, 1e-9) : uniform(-2.0, 2.0)) / fabs(axis->position.scale);
            const int turns = (int)draw(3);
            const double to = near - cm1e_axis_line(axis, axis->setpoint.position) + axis->position.modulo_range *
                              turns;
            bench_wait(bench_start_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_RELATIVE, .position = to,
                                                                  .velocity = axis->limits.maximum.velocity}), 20000);
            bench_cycles(2);
            expect_shown();
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_move_to_0_shows_0_on_the_set_and_on_the_actual_side);
    RUN_TEST(test_set_and_actual_position_are_shown_on_the_same_side_of_a_turn);
    RUN_TEST(test_billion_turns_and_back_are_exact);
    RUN_TEST(test_turns_begin_at_their_multiple_of_a_fraction);
    RUN_TEST(test_random_turns_are_exact);
    RUN_TEST(test_target_is_the_first_repetition_beyond_the_stop);
    RUN_TEST(test_half_a_turn_away_the_shortest_way_is_positive);
    RUN_TEST(test_positions_outside_a_turn_and_wrong_directions_are_refused);
    RUN_TEST(test_every_direction_takes_its_way);
    RUN_TEST(test_insufficient_braking_distance_goes_on_to_the_next_repetition);
    RUN_TEST(test_asked_to_turn_round_it_brakes_first);
    return UNITY_END();
}
