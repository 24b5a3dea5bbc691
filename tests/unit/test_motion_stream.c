/* What joins a control and the bus: the rings between them, and the spline over its positions. */
#include <math.h>
#include <string.h>

#include "stream_curve.h"
#include "stream_link.h"
#include "unity.h"

void setUp(void) {}
void tearDown(void) {}

static stream_link_t shared;
static curve_t curve;

static void test_commands_come_in_order_and_none_twice(void)
{
    stream_command_t command = {.enable = 0};
    stream_link_init(&shared, 1000000);
    TEST_ASSERT_FALSE(stream_take_command(&shared, &command));
    for (uint32_t n = 0; n < 3 * STREAM_DEPTH; n++) {
        TEST_ASSERT_TRUE(stream_put_command(&shared, &(stream_command_t){.enable = n}));
        if (n % 2 == 0)
            continue;
        for (uint32_t k = n - 1; k <= n; k++) {
            TEST_ASSERT_TRUE(stream_take_command(&shared, &command));
            TEST_ASSERT_EQUAL_UINT32(k, command.enable);
        }
        TEST_ASSERT_FALSE(stream_take_command(&shared, &command));
    }
}

static void test_a_full_ring_refuses_and_counts(void)
{
    stream_command_t command;
    stream_link_init(&shared, 1000000);
    for (uint32_t n = 0; n < STREAM_DEPTH; n++)
        TEST_ASSERT_TRUE(stream_put_command(&shared, &(stream_command_t){.enable = n}));
    TEST_ASSERT_FALSE(stream_put_command(&shared, &(stream_command_t){.enable = 77}));
    TEST_ASSERT_EQUAL_UINT32(1, shared.command_ends.refused);
    TEST_ASSERT_TRUE(stream_take_command(&shared, &command));
    TEST_ASSERT_EQUAL_UINT32(0, command.enable);
    TEST_ASSERT_TRUE(stream_put_command(&shared, &(stream_command_t){.enable = 78}));
}

static void test_the_newest_state_is_taken(void)
{
    stream_state_t state;
    stream_link_init(&shared, 1000000);
    TEST_ASSERT_FALSE(stream_take_state(&shared, &state));
    for (uint64_t n = 1; n <= 5; n++)
        TEST_ASSERT_TRUE(stream_put_state(&shared, &(stream_state_t){.cycles = n}));
    TEST_ASSERT_TRUE(stream_take_state(&shared, &state));
    TEST_ASSERT_EQUAL_UINT64(5, state.cycles);
    TEST_ASSERT_FALSE(stream_take_state(&shared, &state));
}

/* ---- the spline -------------------------------------------------------------------------------------------------- */

static const double most_acceleration = 500.0;
static double planned_position, planned_velocity;

/* A control without a limit of jerk: a ramp up, a way at 80 u/s, a ramp down, a rest, and back. */
static double plan(double period_s)
{
    static const double speed = 80.0;
    static double time_s;
    time_s += period_s;
    if (planned_position == 0.0 && planned_velocity == 0.0)
        time_s = 0.0;
    const double phase = fmod(time_s, 2.0), goal = phase < 0.8 ? speed : phase < 1.0 ? 0.0 : phase < 1.8 ? -speed : 0.0;
    const double step = most_acceleration * period_s;
    planned_velocity += fmax(-step, fmin(goal - planned_velocity, step));
    planned_position += planned_velocity * period_s;
    return planned_position;
}

static void begin(double per_cycle, double delay)
{
    planned_position = planned_velocity = 0.0;
    curve_init(&curve, 1, per_cycle, delay);
    for (int n = 0; n < 40; n++)
        curve_add(&curve, &(double){0.0});
}

typedef struct seen {
    double acceleration, velocity, beside;
    int broken, cycles;
} seen_t;

/* Runs both clocks: the control with `period_s`, late by up to `late_s`, the bus with a cycle of 1 ms times `drift`. */
static seen_t run(double period_s, double drift, double late_s, double delay, double seconds)
{
    seen_t seen = {0};
    const double cycle_s = 1e-3 * drift;
    double before = 0.0, velocity = 0.0, next_s = period_s;
    unsigned chance = 12345;
    begin(1e-3 / period_s, delay);
    for (double now_s = cycle_s; now_s < seconds; now_s += cycle_s, seen.cycles++) {
        for (; next_s <= now_s; next_s += period_s) {
            chance = chance * 1103515245u + 12345u;
            if (next_s + late_s * (double)(chance >> 16 & 255) / 255.0 > now_s && now_s - next_s < late_s)
                break;
            const double position = plan(period_s);
            curve_add(&curve, &position);
        }
        const curve_step_t step = curve_step(&curve);
        seen.broken += step != CURVE_GOES_ON;
        const double at = curve_at(&curve, 0), speed = (at - before) / 1e-3;
        seen.acceleration = fmax(seen.acceleration, fabs(speed - velocity) / 1e-3);
        seen.velocity = fmax(seen.velocity, fabs(speed));
        seen.beside = fmax(seen.beside, fabs(at - planned_position));
        before = at;
        velocity = speed;
    }
    return seen;
}

static void test_the_spline_asks_for_no_more_than_was_planned(void)
{
    static const double periods[] = {1e-3, 0.5e-3, 2e-3, 0.73e-3, 1.37e-3};
    for (unsigned i = 0; i < sizeof periods / sizeof periods[0]; i++) {
        const seen_t seen = run(periods[i], 1.0, 0.0, 5.0, 5.0);
        TEST_ASSERT_EQUAL_INT(0, seen.broken);
        TEST_ASSERT_TRUE_MESSAGE(seen.acceleration < most_acceleration * 1.01 + 0.5, "more acceleration than planned");
        TEST_ASSERT_TRUE(seen.velocity < 80.0 * 1.0011);
        TEST_ASSERT_TRUE_MESSAGE(seen.beside < 80.0 * 7.5 * fmax(periods[i], 1e-3), "it lags behind by more than the delay");
    }
}

static void test_clocks_that_drift_are_followed(void)
{
    static const double drifts[] = {1.0002, 0.9998};
    for (unsigned i = 0; i < 2; i++) {
        const seen_t seen = run(1e-3, drifts[i], 0.4e-3, 6.0, 60.0);
        TEST_ASSERT_EQUAL_INT(0, seen.broken);
        TEST_ASSERT_TRUE(seen.acceleration < most_acceleration * 1.01 + 0.5);
        TEST_ASSERT_TRUE_MESSAGE(seen.beside < 80.0 * 7.6e-3, "the distance to the newest position grows");
    }
}

/* It rests when the spline has left the last position that moved, and not before. */
static void test_a_motion_that_has_just_ended_is_no_rest(void)
{
    begin(1.0, 4.0);
    for (int n = 0; n < 5; n++) {
        const double position = plan(1e-3);
        curve_add(&curve, &position);
        (void)curve_step(&curve);
    }
    double before = curve_at(&curve, 0);
    for (int n = 0; n < 20; n++) {
        curve_add(&curve, &planned_position);
        TEST_ASSERT_EQUAL_INT(CURVE_GOES_ON, curve_step(&curve));
        const bool rests = curve_rests(&curve, 0);
        const double at = curve_at(&curve, 0);
        TEST_ASSERT_TRUE_MESSAGE(!rests || at == planned_position, "it is said to rest, and is not there");
        TEST_ASSERT_TRUE(rests || n < 8);
        before = at;
    }
    TEST_ASSERT_EQUAL_DOUBLE(planned_position, before);
}

static void test_it_waits_at_rest_and_breaks_in_motion(void)
{
    begin(1.0, 4.0);
    for (int n = 0; n < 100; n++)
        TEST_ASSERT_EQUAL_INT(CURVE_GOES_ON, curve_step(&curve));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, curve_at(&curve, 0));
    begin(1.0, 4.0);
    int steps = 0;
    for (int n = 0; n < 20; n++) {
        const double position = plan(1e-3);
        curve_add(&curve, &position);
        (void)curve_step(&curve);
    }
    while (curve_step(&curve) == CURVE_GOES_ON)
        steps++;
    TEST_ASSERT_EQUAL_INT(CURVE_BROKEN, curve_step(&curve));
    TEST_ASSERT_INT_WITHIN(2, 3, steps);
}

static void test_it_is_empty_until_enough_positions_came(void)
{
    curve_init(&curve, 2, 1.0, 4.0);
    for (int n = 0; n < 7; n++) {
        TEST_ASSERT_EQUAL_INT(CURVE_EMPTY, curve_step(&curve));
        curve_add(&curve, (double[]){1.5, -2.5});
    }
    curve_add(&curve, (double[]){1.5, -2.5});
    TEST_ASSERT_EQUAL_INT(CURVE_GOES_ON, curve_step(&curve));
    TEST_ASSERT_EQUAL_DOUBLE(1.5, curve_at(&curve, 0));
    TEST_ASSERT_EQUAL_DOUBLE(-2.5, curve_at(&curve, 1));
    TEST_ASSERT_TRUE(curve_rests(&curve, 0));
    curve_add(&curve, (double[]){1.5, -2.4});
    TEST_ASSERT_TRUE(curve_rests(&curve, 0));
    TEST_ASSERT_FALSE(curve_rests(&curve, 1));
}

static void test_more_positions_than_it_keeps_break_it(void)
{
    begin(1.0, 4.0);
    TEST_ASSERT_EQUAL_INT(CURVE_GOES_ON, curve_step(&curve));
    for (int n = 0; n < CURVE_SAMPLES; n++) {
        const double position = plan(1e-3);
        curve_add(&curve, &position);
    }
    TEST_ASSERT_EQUAL_INT(CURVE_BROKEN, curve_step(&curve));
    for (int n = 0; n < 20; n++) { /* and then it goes on from the newest ones */
        curve_add(&curve, &planned_position);
        TEST_ASSERT_EQUAL_INT(CURVE_GOES_ON, curve_step(&curve));
    }
    TEST_ASSERT_EQUAL_DOUBLE(planned_position, curve_at(&curve, 0));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_commands_come_in_order_and_none_twice);
    RUN_TEST(test_a_full_ring_refuses_and_counts);
    RUN_TEST(test_the_newest_state_is_taken);
    RUN_TEST(test_the_spline_asks_for_no_more_than_was_planned);
    RUN_TEST(test_clocks_that_drift_are_followed);
    RUN_TEST(test_a_motion_that_has_just_ended_is_no_rest);
    RUN_TEST(test_it_waits_at_rest_and_breaks_in_motion);
    RUN_TEST(test_it_is_empty_until_enough_positions_came);
    RUN_TEST(test_more_positions_than_it_keeps_break_it);
    return UNITY_END();
}
