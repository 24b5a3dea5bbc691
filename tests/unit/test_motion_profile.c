/* Known durations, known answers, boundaries and bad input. */
#include "motion_check.h"

void setUp(void) {}
void tearDown(void) {}

static const cm1e_motion_limits_t usual = {300, 1500, 1500, 30000};
static const cm1e_motion_state_t at_zero = {0, 0, 0};

static cm1e_profile_t to_position(cm1e_motion_state_t start, double target, cm1e_motion_limits_t limits)
{
    cm1e_profile_t profile;
    const problem_t problem = {start, target, limits};
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, cm1e_profile_to_position(&profile, &start, target, &limits),
                              problem_text(&problem));
    CHECK(profile.end.position == target && profile.end.velocity == 0, &problem);
    CHECK(isfinite(profile.duration_s) && profile.duration_s >= 0, &problem);
    check_continuity(&profile, &problem);
    return profile;
}

static cm1e_motion_state_t sample(const cm1e_profile_t *profile, double time_s)
{
    cm1e_motion_state_t state;
    cm1e_profile_sample(profile, time_s, &state);
    return state;
}

static void test_moves_from_rest_take_the_optimal_time(void)
{
    const struct {
        double target;
        cm1e_motion_limits_t limits;
        double duration_s;
    } moves[] = {
        {250, {300, 1500, 1500, 30000}, 250.0 / 300 + 300.0 / 1500 + 1500.0 / 30000},
        {5, {300, 1500, 1500, 30000}, 4 * cbrt(5 / 60000.0)},
        {0.01, {300, 1500, 1500, 30000}, 4 * cbrt(0.01 / 60000)},
        {100, {300, 1000, 3000, 30000}, 0.6},
        {-100, {300, 1500, 1500, 30000}, 100.0 / 300 + 300.0 / 1500 + 1500.0 / 30000},
        {50, {300, 1500, 1500, 2000}, 4 * cbrt(50 / 4000.0)},
        {1e12, {300, 1500, 1500, 30000}, 1e12 / 300 + 0.25},
        {1e-12, {300, 1500, 1500, 30000}, 4 * cbrt(1e-12 / 60000)},
    };
    for (size_t i = 0; i < sizeof moves / sizeof moves[0]; i++) {
        const cm1e_profile_t profile = to_position(at_zero, moves[i].target, moves[i].limits);
        TEST_ASSERT_DOUBLE_WITHIN(1e-12 * moves[i].duration_s, moves[i].duration_s, profile.duration_s);
    }
}

/** The ten scenarios by which the peers were measured, and the shortest time that any of them takes, to the 0.1 ms in
 *  which it was measured. The second move begins on the way, `at_s` after the first. */
static void test_ten_scenarios_take_no_longer_than_the_best_peer(void)
{
    const cm1e_motion_limits_t late = {300, 1000, 3000, 30000}, soft = {300, 1500, 1500, 2000};
    const cm1e_motion_limits_t slow = {100, 1500, 1500, 30000};
    const struct {
        double first;
        cm1e_motion_limits_t first_limits;
        double at_s, second;
        cm1e_motion_limits_t second_limits;
        double best_s;
        bool overshoots;
    } scenarios[] = {
        {250, usual, 0, 250, usual, 1.0833, false},   {5, usual, 0, 5, usual, 0.1747, false},
        {0.01, usual, 0, 0.01, usual, 0.0220, false}, {100, late, 0, 100, late, 0.6000, false},
        {-100, usual, 0, -100, usual, 0.5833, false}, {100, usual, 0.20, 250, usual, 1.0833, false},
        {100, usual, 0.20, -50, usual, 1.1167, true}, {250, usual, 0.35, 250, slow, 2.0500, false},
        {250, usual, 0.20, 40, usual, 0.8096, true},  {50, soft, 0, 50, soft, 0.9283, false},
    };
    for (size_t i = 0; i < sizeof scenarios / sizeof scenarios[0]; i++) {
        const cm1e_profile_t first = to_position(at_zero, scenarios[i].first, scenarios[i].first_limits);
        const cm1e_motion_state_t middle = sample(&first, scenarios[i].at_s);
        const cm1e_profile_t second = to_position(middle, scenarios[i].second, scenarios[i].second_limits);
        TEST_ASSERT_DOUBLE_WITHIN(0.5e-4, scenarios[i].best_s, scenarios[i].at_s + second.duration_s);
        double low, high;
        cm1e_profile_extent(&second, &low, &high);
        TEST_ASSERT_EQUAL(scenarios[i].overshoots, low < fmin(middle.position, scenarios[i].second) ||
                                                       high > fmax(middle.position, scenarios[i].second));
    }
}

static void test_new_target_at_both_limits_needs_no_braking(void)
{
    /* a = amax and v + a2/2j = vmax: where rounding must not be read as a violation. */
    const cm1e_profile_t first = to_position(at_zero, 100, usual);
    const cm1e_motion_state_t middle = sample(&first, 0.2);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 1500, middle.acceleration);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 262.5, middle.velocity);
    TEST_ASSERT_DOUBLE_WITHIN(1e-7, 1.0 + 1 / 12.0 - 0.2, to_position(middle, 250, usual).duration_s);
    TEST_ASSERT_DOUBLE_WITHIN(1e-7, 1.0 + 7 / 60.0 - 0.2, to_position(middle, -50, usual).duration_s);
}

static void test_lower_velocity_on_the_way_is_reached_without_undershoot(void)
{
    const cm1e_profile_t first = to_position(at_zero, 250, usual);
    const cm1e_motion_state_t middle = sample(&first, 0.35);
    cm1e_motion_limits_t slow = usual;
    slow.velocity = 100;
    const cm1e_profile_t profile = to_position(middle, 250, slow);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 2.05 - 0.35, profile.duration_s);
    double low, high;
    cm1e_profile_extent(&profile, &low, &high);
    TEST_ASSERT_TRUE(low == middle.position && high == 250);
    for (double t = 0; t < 1.5; t += 0.001)
        TEST_ASSERT_TRUE(sample(&profile, t).velocity >= 100 - 1e-9);
}

static void test_target_just_passed_is_reached_by_way_of_the_stop(void)
{
    /* Cruising at 300, the axis stands after 0.225 s, 37.34375 u beyond, and has full acceleration back by then. */
    const cm1e_motion_state_t cruise = {40, 300, 0};
    const cm1e_profile_t profile = to_position(cruise, 40, usual);
    const cm1e_profile_t back = to_position(at_zero, 37.5, usual);
    double low, high;
    cm1e_profile_extent(&profile, &low, &high);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 40, low);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 77.34375, high);
    TEST_ASSERT_TRUE(profile.duration_s < 0.25 + back.duration_s - 0.04);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 37.34375, cm1e_profile_way_back(&profile, 1));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 37.34375, cm1e_profile_way_back(&profile, -1));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0, cm1e_profile_way_back(&back, 1));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 37.5, cm1e_profile_way_back(&back, -1));
}

static void test_stop_goes_its_shortest_way(void)
{
    static const struct {
        cm1e_motion_state_t start;
        double velocity, duration_s, displacement;
    } stops[] = {
        {{0, 300, 0}, 0, 0.25, 37.5},
        {{0, 300, -1500}, 0, 0.225, 300 * 0.175 - 1500 * 0.175 * 0.175 / 2 + 0.625},
        {{0, 0, 0}, 300, 0.25, 37.5},
        {{0, -300, 0}, 300, 0.45, 0}, /* through standstill without easing: 600 / 1500 + 1500 / 30000 */
        {{0, 100, 0}, 100, 0, 0},
        {{0, 0, 1500}, 37.5, 0.05, 1.25}, /* only the acceleration is eased: a3 / 3j2 */
    };
    for (size_t i = 0; i < sizeof stops / sizeof stops[0]; i++) {
        cm1e_profile_t profile;
        TEST_ASSERT_EQUAL(CM1E_OK, cm1e_profile_to_velocity(&profile, &stops[i].start, stops[i].velocity, &usual));
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, stops[i].duration_s, profile.duration_s);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, stops[i].displacement, profile.end.position);
        TEST_ASSERT_TRUE(profile.end.velocity == stops[i].velocity && profile.end.acceleration == 0);
    }
}

static void test_acceleration_and_deceleration_follow_the_speed_not_the_sign(void)
{
    const cm1e_motion_limits_t limits = {300, 1000, 3000, 1e6};
    static const double directions[] = {1, -1};
    for (int i = 0; i < 2; i++) {
        const cm1e_profile_t profile = to_position(at_zero, 100 * directions[i], limits);
        double most = 0, least = 0;
        for (int k = 0; k <= 1000; k++) {
            const double a = directions[i] * sample(&profile, profile.duration_s * k / 1000).acceleration;
            most = fmax(most, a);
            least = fmin(least, a);
        }
        TEST_ASSERT_EQUAL_DOUBLE(1000, most);
        TEST_ASSERT_EQUAL_DOUBLE(-3000, least);
        /* Reversal: deceleration until standstill, acceleration after it. */
        const cm1e_motion_state_t moving = {0, 200 * directions[i], 0};
        cm1e_profile_t reversal;
        TEST_ASSERT_EQUAL(CM1E_OK, cm1e_profile_to_velocity(&reversal, &moving, -200 * directions[i], &limits));
        for (int k = 0; k <= 1000; k++) {
            const cm1e_motion_state_t state = sample(&reversal, reversal.duration_s * k / 1000);
            TEST_ASSERT_TRUE(fabs(state.acceleration) <=
                             acceleration_limit(state.velocity, state.acceleration, &limits) * (1 + 1e-9));
        }
    }
}

static void test_infinite_jerk_gives_the_trapezoid(void)
{
    static const struct {
        cm1e_motion_state_t start;
        double target, v, a, d, duration_s;
    } moves[] = {
        {{0, 0, 0}, 250, 300, 1500, 1500, 250.0 / 300 + 0.2},
        {{0, 0, 0}, 6, 300, 1500, 1500, 0.12649110640673517},              /* 2 sqrt(6 / 1500) */
        {{0, 0, 0}, 6, 300, 1000, 3000, 0.12649110640673517},              /* sqrt(2 s (1/a + 1/d)) */
        {{0, 100, 0}, 250, 100, 1000, 500, 2.5 + 0.1},                     /* cruising already */
        {{0, 200, 0}, 250, 100, 1000, 500, 0.2 + (250 - 30) / 100.0 + 0.1}, /* too fast */
        {{0, 100, 0}, 10, 100, 500, 500, 0.2},                             /* stops there */
        {{0, 100, 0}, 0, 100, 1000, 500, 0.2 + 0.24494897427831780},       /* stop at 10, back: sqrt(20 (1/a + 1/d)) */
        {{0, 0, 0}, 0, 100, 1000, 500, 0},
        {{0, -100, 0}, -1000, 100, 1000, 500, 10 + 0.1},
    };
    for (size_t i = 0; i < sizeof moves / sizeof moves[0]; i++) {
        const cm1e_motion_limits_t limits = {moves[i].v, moves[i].a, moves[i].d, INFINITY};
        const cm1e_profile_t profile = to_position(moves[i].start, moves[i].target, limits);
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, moves[i].duration_s, profile.duration_s);
    }
    /* An infinite jerk is the limit of large ones. */
    const cm1e_profile_t sharp = to_position(at_zero, 6, (cm1e_motion_limits_t){300, 1000, 3000, 1e30});
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, moves[2].duration_s, sharp.duration_s);
}

static void test_no_distance_takes_no_time(void)
{
    const cm1e_motion_state_t far = {1e12, 0, 0};
    const cm1e_profile_t profile = to_position(far, 1e12, usual);
    TEST_ASSERT_EQUAL(0, profile.segment_count);
    TEST_ASSERT_TRUE(profile.duration_s == 0);
    for (double t = -1; t <= 1; t++)
        TEST_ASSERT_TRUE(sample(&profile, t).position == 1e12);
    double low, high;
    cm1e_profile_extent(&profile, &low, &high);
    TEST_ASSERT_TRUE(low == 1e12 && high == 1e12);
}

static void test_sample_outside_the_duration_holds_start_and_goes_on_at_the_end(void)
{
    cm1e_profile_t profile;
    const cm1e_motion_state_t start = {7, 10, 0};
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_profile_to_velocity(&profile, &start, -20, &usual));
    TEST_ASSERT_EQUAL_DOUBLE(7, sample(&profile, -1).position);
    TEST_ASSERT_EQUAL_DOUBLE(10, sample(&profile, -1).velocity);
    const cm1e_motion_state_t end = sample(&profile, profile.duration_s);
    TEST_ASSERT_TRUE(end.velocity == -20 && end.acceleration == 0);
    const cm1e_motion_state_t later = sample(&profile, profile.duration_s + 10);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, end.position - 200, later.position);
    TEST_ASSERT_TRUE(later.velocity == -20 && later.acceleration == 0);
}

static void test_velocity_beyond_the_limit_is_clamped(void)
{
    cm1e_profile_t profile;
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_profile_to_velocity(&profile, &at_zero, 1e9, &usual));
    TEST_ASSERT_TRUE(profile.end.velocity == 300);
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_profile_to_velocity(&profile, &at_zero, -301, &usual));
    TEST_ASSERT_TRUE(profile.end.velocity == -300);
}

static void test_start_outside_the_limits_is_brought_inside_and_stays_there(void)
{
    static const cm1e_motion_state_t starts[] = {
        {0, 900, 0}, {0, -900, 0}, {0, 0, 9000}, {0, 0, -9000}, {0, 299, 1500}, {0, 900, 9000}, {0, -900, 9000},
        {0, 900, -9000}, {0, 1, 3000}, {0, -1, 3000}, {0, -1, 1e5}, {0, 300, 1e-3},
    };
    static const double targets[] = {-1e4, -100, -1, 0, 1, 100, 1e4};
    const cm1e_motion_limits_t limits[] = {usual, {300, 700, 3000, 30000}, {300, 3000, 700, 30000}};
    for (size_t i = 0; i < sizeof starts / sizeof starts[0]; i++)
        for (size_t k = 0; k < sizeof targets / sizeof targets[0]; k++)
            for (size_t l = 0; l < sizeof limits / sizeof limits[0]; l++) {
                const cm1e_profile_t profile = to_position(starts[i], targets[k], limits[l]);
                const problem_t problem = {starts[i], targets[k], limits[l]};
                bool inside = false;
                for (int n = 0; n <= 2000; n++) {
                    const cm1e_motion_state_t state = sample(&profile, profile.duration_s * n / 2000);
                    if (inside)
                        CHECK(is_inside(&state, &limits[l], 1 + 1e-8), &problem);
                    else
                        inside = is_inside(&state, &limits[l], 1);
                }
                CHECK(inside, &problem);
            }
}

static void test_input_without_sense_is_refused(void)
{
    static const double bad[] = {NAN, INFINITY, -INFINITY};
    cm1e_profile_t profile;
    for (size_t i = 0; i < 3; i++) {
        const cm1e_motion_state_t starts[] = {{bad[i], 0, 0}, {0, bad[i], 0}, {0, 0, bad[i]}};
        for (size_t k = 0; k < 3; k++) {
            TEST_ASSERT_EQUAL(CM1E_ERROR_INVALID_ARGUMENT, cm1e_profile_to_position(&profile, &starts[k], 1, &usual));
            TEST_ASSERT_EQUAL(CM1E_ERROR_INVALID_ARGUMENT, cm1e_profile_to_velocity(&profile, &starts[k], 1, &usual));
        }
        TEST_ASSERT_EQUAL(CM1E_ERROR_INVALID_ARGUMENT, cm1e_profile_to_position(&profile, &at_zero, bad[i], &usual));
    }
    static const double limits[] = {0, -1, NAN, -INFINITY, INFINITY};
    for (size_t i = 0; i < 5; i++)
        for (size_t k = 0; k < 4; k++) {
            double values[] = {300, 1500, 1500, 30000};
            values[k] = limits[i];
            const cm1e_motion_limits_t wrong = {values[0], values[1], values[2], values[3]};
            const bool allowed = k == 3 && i == 4;
            const cm1e_error_t expected = allowed ? CM1E_OK : CM1E_ERROR_INVALID_ARGUMENT;
            TEST_ASSERT_EQUAL(expected, cm1e_profile_to_position(&profile, &at_zero, 1, &wrong));
            TEST_ASSERT_EQUAL(expected, cm1e_profile_to_velocity(&profile, &at_zero, 1, &wrong));
        }
    const cm1e_motion_state_t far = {-1.7e308, 0, 0};
    TEST_ASSERT_EQUAL(CM1E_ERROR_INVALID_ARGUMENT, cm1e_profile_to_position(&profile, &far, 1.7e308, &usual));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_moves_from_rest_take_the_optimal_time);
    RUN_TEST(test_ten_scenarios_take_no_longer_than_the_best_peer);
    RUN_TEST(test_new_target_at_both_limits_needs_no_braking);
    RUN_TEST(test_lower_velocity_on_the_way_is_reached_without_undershoot);
    RUN_TEST(test_target_just_passed_is_reached_by_way_of_the_stop);
    RUN_TEST(test_stop_goes_its_shortest_way);
    RUN_TEST(test_acceleration_and_deceleration_follow_the_speed_not_the_sign);
    RUN_TEST(test_infinite_jerk_gives_the_trapezoid);
    RUN_TEST(test_no_distance_takes_no_time);
    RUN_TEST(test_sample_outside_the_duration_holds_start_and_goes_on_at_the_end);
    RUN_TEST(test_velocity_beyond_the_limit_is_clamped);
    RUN_TEST(test_start_outside_the_limits_is_brought_inside_and_stays_there);
    RUN_TEST(test_input_without_sense_is_refused);
    return UNITY_END();
}
