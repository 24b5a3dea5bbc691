/* Motions along tables: through their points, as smooth as promised, with extremes that dense sampling confirms. */
#include "motion/table_profile.h"
#include "motion_check.h"

enum { TABLES = 12000, DENSE = 2000 };

void setUp(void) {}
void tearDown(void) {}

typedef struct {
    cm1e_table_kind_t kind;
    cm1e_motion_state_t start;
    cm1e_table_point_t points[CM1E_TABLE_POINTS_MAX + 1];
    int count;
    double jerk;
} random_table_t;

/** What TEST_FAIL says of a random table. */
static const char *table_text(const random_table_t *table)
{
    static char text[4000];
    int length = snprintf(text, sizeof text, "kind %d start {%.17g, %.17g, %.17g} jerk %g", (int)table->kind,
                          table->start.position, table->start.velocity, table->start.acceleration, table->jerk);
    for (int i = 0; i < table->count && length < 3900; i++)
        length += snprintf(text + length, sizeof text - (size_t)length, " (%.17g, %.17g)", table->points[i].time_s,
                           table->points[i].value);
    return text;
}

#define CHECK_TABLE(condition, table) TEST_ASSERT_TRUE_MESSAGE(condition, table_text(table))

static random_table_t random_table(cm1e_table_kind_t kind)
{
    random_table_t table = {
        .kind = kind, .count = 1 + (int)(random_bits() % CM1E_TABLE_POINTS_MAX),
        .jerk = one_in(3) ? INFINITY : random_decade(1, 1e4),
    };
    if (one_in(2))
        table.start = (cm1e_motion_state_t){random_between(-100, 100), random_between(-10, 10),
                                            one_in(2) ? 0 : random_between(-10, 10)};
    const double size = random_decade(0.01, 100), step_s = random_decade(0.01, 1);
    double time_s = 0;
    for (int i = 0; i < table.count; i++) {
        if (i > 0 || table.count == 1 || one_in(2))
            time_s += step_s * (one_in(2) ? 1 : random_between(0.2, 5));
        const double at_start = kind == CM1E_TABLE_POSITION ? table.start.position
                                : kind == CM1E_TABLE_VELOCITY ? table.start.velocity
                                                              : table.start.acceleration;
        table.points[i].time_s = time_s;
        table.points[i].value = i == 0 && time_s == 0 ? at_start : at_start + size * random_between(-1, 1);
        if (kind == CM1E_TABLE_ACCELERATION && (i + 1 == table.count || one_in(8)))
            table.points[i].value = one_in(2) ? 0 : table.points[i].value;
    }
    return table;
}

static double value_of(cm1e_table_kind_t kind, const cm1e_motion_state_t *state)
{
    return kind == CM1E_TABLE_POSITION ? state->position
           : kind == CM1E_TABLE_VELOCITY ? state->velocity
                                         : state->acceleration;
}

static cm1e_table_profile_t build(const random_table_t *table, cm1e_table_extremes_t *extremes)
{
    cm1e_table_profile_t profile;
    CHECK_TABLE(cm1e_table_profile(&profile, table->kind, &table->start, table->points, table->count, table->jerk,
                                   extremes) == CM1E_OK,
                table);
    return profile;
}

/** The range over which rounding errors of the profile are judged. */
typedef struct {
    double position, velocity, acceleration;
} size_range_t;

static size_range_t ranges(const cm1e_table_profile_t *profile, const cm1e_table_extremes_t *extremes)
{
    return (size_range_t){
        .position = 1 + fabs(extremes->lowest) + fabs(extremes->highest) + extremes->velocity * profile->duration_s,
        .velocity = 1 + extremes->velocity,
        .acceleration = 1 + extremes->acceleration + extremes->deceleration,
    };
}

static void check_points(const random_table_t *table)
{
    cm1e_table_extremes_t extremes;
    cm1e_table_profile_t profile = build(table, &extremes);
    const size_range_t range = ranges(&profile, &extremes);
    const double noise = 1e-10 * (table->kind == CM1E_TABLE_POSITION ? range.position
                                  : table->kind == CM1E_TABLE_VELOCITY ? range.velocity
                                                                       : range.acceleration);
    cm1e_motion_state_t state;
    cm1e_table_profile_sample(&profile, 0, &state);
    CHECK_TABLE(state.position == table->start.position && state.velocity == table->start.velocity &&
                    state.acceleration == table->start.acceleration,
                table);
    for (int i = table->count - 1; i >= 0; i--) { /* also backwards */
        if (table->points[i].time_s == 0 || (table->kind == CM1E_TABLE_ACCELERATION && i + 1 == table->count))
            continue;
        cm1e_table_profile_sample(&profile, table->points[i].time_s, &state);
        CHECK_TABLE(fabs(value_of(table->kind, &state) - table->points[i].value) <= noise, table);
    }
    const cm1e_table_point_t *last = &table->points[table->count - 1];
    CHECK_TABLE(profile.end.acceleration == 0, table);
    if (table->kind == CM1E_TABLE_POSITION)
        CHECK_TABLE(profile.end.position == last->value && profile.end.velocity == 0, table);
    if (table->kind == CM1E_TABLE_VELOCITY)
        CHECK_TABLE(profile.end.velocity == last->value, table);
    const double ramp_s = table->kind == CM1E_TABLE_ACCELERATION ? fabs(last->value) / table->jerk : 0;
    TEST_ASSERT_EQUAL_DOUBLE(last->time_s + ramp_s, profile.duration_s);
    cm1e_table_profile_sample(&profile, profile.duration_s + 2, &state);
    state.position -= profile.end.position + 2 * profile.end.velocity;
    CHECK_TABLE(fabs(state.position) <= 1e-12 * range.position, table);
}

/** Between two samples, each value changes by what the extreme of the next one allows; none is beyond its extreme; and
 *  the extremes are not much beyond what is seen. */
static void check_extremes(const random_table_t *table)
{
    cm1e_table_extremes_t extremes, seen = {.lowest = INFINITY, .highest = -INFINITY};
    cm1e_table_profile_t profile = build(table, &extremes);
    const size_range_t range = ranges(&profile, &extremes);
    const double step_s = profile.duration_s / DENSE;
    const double steepest = fmax(extremes.acceleration, extremes.deceleration);
    cm1e_motion_state_t before = table->start, state = before;
    for (int i = 1; i <= DENSE; i++, before = state) {
        cm1e_table_profile_sample(&profile, i * step_s, &state);
        CHECK_TABLE(fabs(state.position - before.position) <= extremes.velocity * step_s + 1e-10 * range.position,
                    table);
        CHECK_TABLE(fabs(state.velocity - before.velocity) <= steepest * step_s + 1e-10 * range.velocity, table);
        CHECK_TABLE(isinf(extremes.jerk) || fabs(state.acceleration - before.acceleration) <=
                                                extremes.jerk * step_s + 1e-9 * range.acceleration,
                    table);
        seen.lowest = fmin(seen.lowest, state.position);
        seen.highest = fmax(seen.highest, state.position);
        seen.velocity = fmax(seen.velocity, fabs(state.velocity));
        double *limit = state.velocity * state.acceleration >= 0 ? &seen.acceleration : &seen.deceleration;
        if (fabs(state.velocity) > 1e-9 * range.velocity)
            *limit = fmax(*limit, fabs(state.acceleration));
    }
    const double p = 1e-10 * range.position, v = 1e-10 * range.velocity, a = 1e-9 * range.acceleration;
    CHECK_TABLE(seen.lowest >= extremes.lowest - p && seen.highest <= extremes.highest + p, table);
    CHECK_TABLE(seen.velocity <= extremes.velocity + v, table);
    CHECK_TABLE(seen.acceleration <= extremes.acceleration + a, table);
    CHECK_TABLE(seen.deceleration <= extremes.deceleration + a, table);
    CHECK_TABLE(seen.lowest <= extremes.lowest + extremes.velocity * step_s + p, table);
    CHECK_TABLE(seen.highest >= extremes.highest - extremes.velocity * step_s - p, table);
    CHECK_TABLE(seen.velocity >= extremes.velocity - steepest * step_s - v, table);
    if (isfinite(extremes.jerk)) {
        const double slack = 2 * extremes.jerk * step_s + a; /* a sign may change within a step */
        CHECK_TABLE(fmax(seen.acceleration, seen.deceleration) >= steepest - slack, table);
    }
}

static void test_motion_goes_through_the_points_from_the_start_to_rest_or_a_velocity(void)
{
    for (int i = 0; i < TABLES; i++) {
        const random_table_t table = random_table((cm1e_table_kind_t)(i % 3));
        check_points(&table);
    }
}

static void test_extremes_are_those_of_dense_sampling(void)
{
    for (int i = 0; i < TABLES / 3; i++) {
        const random_table_t table = random_table((cm1e_table_kind_t)(i % 3));
        check_extremes(&table);
    }
}

/** Samples of a smooth motion give that motion: the error falls with the fourth power of the step, of the velocities
 *  with the third. */
static void test_points_of_a_smooth_motion_give_that_motion(void)
{
    double worst[2][2] = {{0}}; /* by kind and step */
    for (int kind = 0; kind < 2; kind++)
        for (int fine = 0; fine < 2; fine++) {
            const int count = fine ? 64 : 32;
            const double length_s = 2, turns = 2 * 3.14159265358979 / length_s;
            cm1e_table_point_t points[64];
            for (int i = 0; i < count; i++) {
                const double t = length_s * (i + 1) / count;
                points[i] = (cm1e_table_point_t){t, kind ? 1 - cos(turns * t) : t - sin(turns * t) / turns};
            }
            cm1e_table_profile_t profile;
            const cm1e_motion_state_t start = {0, 0, 0};
            TEST_ASSERT_EQUAL(CM1E_OK, cm1e_table_profile(&profile, (cm1e_table_kind_t)kind, &start, points, count,
                                                          INFINITY, NULL));
            for (int i = 0; i <= 1000; i++) {
                const double t = length_s * i / 1000;
                cm1e_motion_state_t state;
                cm1e_table_profile_sample(&profile, t, &state);
                const double error = kind ? state.velocity - (1 - cos(turns * t))
                                          : state.position - (t - sin(turns * t) / turns);
                worst[kind][fine] = fmax(worst[kind][fine], fabs(error));
            }
        }
    printf("position: %g %g, velocity: %g %g\n", worst[0][0], worst[0][1], worst[1][0], worst[1][1]);
    TEST_ASSERT_TRUE(worst[0][1] < 3e-5 && worst[0][1] < worst[0][0] / 12);
    TEST_ASSERT_TRUE(worst[1][1] < 3e-4 && worst[1][1] < worst[1][0] / 6);
}

static void test_one_point_is_a_move_of_that_duration(void)
{
    const cm1e_motion_state_t start = {5, 1, -2};
    const cm1e_table_point_t point = {2, 9};
    cm1e_table_profile_t profile;
    cm1e_table_extremes_t extremes;
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_table_profile(&profile, CM1E_TABLE_POSITION, &start, &point, 1, 100, &extremes));
    cm1e_motion_state_t state;
    cm1e_table_profile_sample(&profile, nextafter(2, 0), &state);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 9, state.position);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0, state.velocity);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0, state.acceleration);
}

static void test_steps_of_acceleration_have_infinite_jerk_and_ramps_do_not(void)
{
    const cm1e_motion_state_t rest = {0, 0, 0};
    const cm1e_table_point_t steps[] = {{0, 10}, {1, 10}};
    cm1e_table_profile_t profile;
    cm1e_table_extremes_t extremes;
    TEST_ASSERT_EQUAL(CM1E_OK,
                      cm1e_table_profile(&profile, CM1E_TABLE_ACCELERATION, &rest, steps, 2, INFINITY, &extremes));
    TEST_ASSERT_TRUE(isinf(extremes.jerk) && profile.end.velocity == 10 && profile.end.position == 5);
    const cm1e_table_point_t ramps[] = {{0.5, 10}, {1, 10}};
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_table_profile(&profile, CM1E_TABLE_ACCELERATION, &rest, ramps, 2, 20, &extremes));
    TEST_ASSERT_EQUAL_DOUBLE(20, extremes.jerk);
    TEST_ASSERT_EQUAL_DOUBLE(1.5, profile.duration_s);
    TEST_ASSERT_EQUAL_DOUBLE(10, profile.end.velocity);
    TEST_ASSERT_EQUAL_DOUBLE(10, extremes.velocity);
    TEST_ASSERT_EQUAL_DOUBLE(0, extremes.deceleration);
}

static void test_tables_without_sense_are_refused(void)
{
    const cm1e_motion_state_t start = {1, 2, 0};
    cm1e_table_point_t many[CM1E_TABLE_POINTS_MAX + 1];
    for (int i = 0; i <= CM1E_TABLE_POINTS_MAX; i++)
        many[i] = (cm1e_table_point_t){i + 1, 0};
    const struct {
        int count;
        cm1e_table_point_t points[3];
        bool of_velocities_too;
    } bad[] = {
        {0, {{1, 1}}, true},
        {-1, {{1, 1}}, true},
        {1, {{0, 1}}, false},                 /* nothing after the start */
        {2, {{1, 1}, {1, 2}}, true},          /* no time between */
        {3, {{1, 1}, {3, 2}, {2, 1}}, true},  /* back in time */
        {1, {{-1, 1}}, true},
        {1, {{NAN, 1}}, true},
        {1, {{INFINITY, 1}}, true},
        {2, {{1, 1}, {2, NAN}}, true},
        {2, {{1, 1}, {2, -INFINITY}}, true},
        {2, {{1, 1}, {2, 1.1e30}}, true},
        {1, {{1.1e30, 1}}, true},
        {2, {{1e-317, 1}, {2e-317, 2}}, true}, /* below 1 ps */
        {2, {{1, 1}, {1 + 0.9e-12, 2}}, true},
        {2, {{0, 1.1}, {1, 2}}, true},        /* the axis is not there */
    };
    cm1e_table_profile_t profile;
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++)
        for (int kind = CM1E_TABLE_POSITION; kind <= CM1E_TABLE_VELOCITY; kind++)
            if (kind == CM1E_TABLE_POSITION || bad[i].of_velocities_too)
                TEST_ASSERT_EQUAL(CM1E_ERROR_INVALID_ARGUMENT,
                                  cm1e_table_profile(&profile, (cm1e_table_kind_t)kind, &start, bad[i].points,
                                                     bad[i].count, 1, NULL));
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_table_profile(&profile, CM1E_TABLE_POSITION, &start, many, CM1E_TABLE_POINTS_MAX, 1,
                                                  NULL));
    TEST_ASSERT_EQUAL(CM1E_ERROR_INVALID_ARGUMENT,
                      cm1e_table_profile(&profile, CM1E_TABLE_POSITION, &start, many, CM1E_TABLE_POINTS_MAX + 1, 1,
                                         NULL));
    const cm1e_motion_state_t nowhere = {NAN, 0, 0};
    TEST_ASSERT_EQUAL(CM1E_ERROR_INVALID_ARGUMENT,
                      cm1e_table_profile(&profile, CM1E_TABLE_POSITION, &nowhere, many, 3, 1, NULL));
    TEST_ASSERT_EQUAL(CM1E_ERROR_INVALID_ARGUMENT,
                      cm1e_table_profile(&profile, CM1E_TABLE_ACCELERATION, &start, many, 3, 0, NULL));
}

int main(void)
{
    seed_random();
    UNITY_BEGIN();
    RUN_TEST(test_motion_goes_through_the_points_from_the_start_to_rest_or_a_velocity);
    RUN_TEST(test_extremes_are_those_of_dense_sampling);
    RUN_TEST(test_points_of_a_smooth_motion_give_that_motion);
    RUN_TEST(test_one_point_is_a_move_of_that_duration);
    RUN_TEST(test_steps_of_acceleration_have_infinite_jerk_and_ramps_do_not);
    RUN_TEST(test_tables_without_sense_are_refused);
    return UNITY_END();
}
