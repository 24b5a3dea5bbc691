/* A motion whose time runs slower for a while keeps its limits and its way, and arrives later. */
#include "motion/slow_time.h"
#include "path_check.h"

void setUp(void) {}
void tearDown(void) {}

static const cm1e_motion_limits_t LIMITS[] = {
    {20, 200, 200, 4000}, {20, 200, 50, 1e5}, {1, 1000, 1000, 1e5}, {300, 10, 400, 30}, {20, 200, 200, INFINITY}};
static const double FACTORS[] = {0.5, 0.9, 0.95, 0.9999};
enum { LIMIT_SETS = sizeof LIMITS / sizeof LIMITS[0], FACTOR_COUNT = sizeof FACTORS / sizeof FACTORS[0] };

static cm1e_motion_state_t at(const cm1e_profile_t *profile, const cm1e_slow_time_t *slow, double time_s)
{
    cm1e_motion_state_t state;
    cm1e_profile_sample(profile, time_s, &state);
    cm1e_slow_time_apply(slow, &state);
    return state;
}

/* A profile that uses all of its limits, slowed at `from_s`, then once more shortly after it. */
static void slow_profile(const cm1e_profile_t *profile, const cm1e_motion_limits_t *limits, double from_s, double factor)
{
    const double step_s = profile->duration_s / 3000;
    cm1e_slow_time_t slow = {0, 0};
    double time_s = from_s, late_s = 0, longest_s = 0;
    cm1e_motion_state_t before = at(profile, &slow, time_s);
    for (int i = 0; i < 1000000 && (slow.missing > 0 || i < 500); i++) {
        if (i == 0 || i == 400) {
            cm1e_slow_time_begin(&slow, factor);
            cm1e_slow_time_keep(&slow, limits);
            const cm1e_motion_state_t slower = at(profile, &slow, time_s);
            TEST_ASSERT_DOUBLE_WITHIN(1e-9 * limits->velocity, factor * before.velocity, slower.velocity);
            before = slower;
            longest_s += slow.missing / slow.rate;
        }
        const double advance_s = cm1e_slow_time_step(&slow, step_s);
        TEST_ASSERT_TRUE(advance_s > 0 && advance_s <= step_s);
        late_s += step_s - advance_s;
        time_s += advance_s;
        const cm1e_motion_state_t now = at(profile, &slow, time_s);
        const double most_a = now.velocity * now.acceleration > 0 ? limits->acceleration
                                                                  : fmax(limits->acceleration, limits->deceleration);
        TEST_ASSERT_TRUE(fabs(now.velocity) <= limits->velocity * (1 + 1e-9));
        TEST_ASSERT_TRUE(fabs(now.acceleration) <= most_a * (1 + 1e-9));
        TEST_ASSERT_TRUE(fabs(now.acceleration - before.acceleration) <=
                         limits->jerk * step_s * (1 + 1e-6) + 1e-9 * most_a);
        if (isfinite(limits->jerk)) /* what is shown is one motion */
            TEST_ASSERT_DOUBLE_WITHIN(limits->jerk * step_s * step_s * step_s + 1e-8 * limits->velocity * step_s,
                                      (now.velocity + before.velocity) / 2 * step_s, now.position - before.position);
        before = now;
    }
    TEST_ASSERT_EQUAL_DOUBLE(0, slow.missing);
    TEST_ASSERT_TRUE(late_s <= longest_s * (1 + 1e-9));
}

static void test_velocity_acceleration_and_jerk_keep_their_limits(void)
{
    for (int l = 0; l < LIMIT_SETS; l++)
        for (int f = 0; f < FACTOR_COUNT; f++) {
            const cm1e_motion_limits_t *limits = &LIMITS[l];
            const double way = limits->velocity * limits->velocity / limits->deceleration + limits->velocity * 2;
            cm1e_profile_t profile;
            TEST_ASSERT_EQUAL(CM1E_OK, cm1e_profile_to_position(&profile, &(cm1e_motion_state_t){0, 0, 0}, -way, limits));
            for (int i = 0; i < 60; i++)
                slow_profile(&profile, limits, profile.duration_s * i / 60, FACTORS[f]);
        }
}

static void test_full_pace_costs_nothing(void)
{
    cm1e_slow_time_t slow = {0, 0};
    cm1e_motion_state_t state = {1, 2, 3};
    TEST_ASSERT_EQUAL_DOUBLE(1e-3, cm1e_slow_time_step(&slow, 1e-3));
    cm1e_slow_time_apply(&slow, &state);
    TEST_ASSERT_EQUAL_DOUBLE(2, state.velocity);
    TEST_ASSERT_EQUAL_DOUBLE(3, state.acceleration);
}

/* ---- a path ------------------------------------------------------------------------------------------------------ */

static const double ORIGIN[CM1E_PATH_AXES];

/* A line, a corner, and half a circle around (20, 20). */
static void begin_around(void)
{
    cm1e_path_config_t config = plain_config(3, 2, 100, 800, 20000);
    config.axis[1].velocity = 80;
    config.axis[2].acceleration = 300;
    begin_path(&config, ORIGIN);
    cm1e_path_command_t command = command_of(0, 0, 0, CM1E_PATH_STOP, 0);
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_path_append_line(&driven.path, (double[]){30, 0, 5}, &command, NULL));
    command = command_of(90, 700, 15000, CM1E_PATH_CORNER_DEVIATION, 2);
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_path_append_line(&driven.path, (double[]){30, 20, 5}, &command, NULL));
    command = command_of(0, 0, 0, CM1E_PATH_EXACT, 0);
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_path_append_arc_centre(&driven.path, (double[]){20, 20, 5}, (double[]){10, 20, 0},
                                                           CM1E_PATH_COUNTER_CLOCKWISE, &command, NULL));
}

static void step_on_path(void)
{
    step_path();
    if (driven.now.active == 3 && driven.now.position[1] > 20)
        CHECK_PATH(fabs(hypot(driven.now.position[0] - 20, driven.now.position[1] - 20) - 10) < 1e-9);
    CHECK_PATH(driven.now.position[0] <= 30 + 1e-9 && driven.now.position[1] >= -1e-9);
}

/* TRUE: the path has ended before that cycle. `disturb` does something else to it shortly after it. */
static bool slowed_in(int cycle, double full_s, void (*disturb)(void))
{
    begin_around();
    for (int i = 0; i < cycle; i++)
        step_on_path();
    if (driven.now.phase == CM1E_PATH_IDLE)
        return true;
    for (int again = 0; again < 2; again++) {
        cm1e_path_slow(&driven.path, 0.9, &driven.now);
        for (int i = 0; i < 3; i++)
            step_on_path();
    }
    if (disturb)
        disturb();
    for (int i = 0; driven.now.phase != CM1E_PATH_IDLE; i++) {
        step_on_path();
        if (i == 60)
            cm1e_path_go_on(&driven.path);
        TEST_ASSERT_TRUE(i < 10000);
    }
    TEST_ASSERT_EQUAL_DOUBLE(10, driven.now.position[0]);
    TEST_ASSERT_EQUAL_DOUBLE(20, driven.now.position[1]);
    TEST_ASSERT_EQUAL(4, driven.done_tag);
    CHECK_PATH(disturb || driven.time_s < full_s + 0.1);
    return false;
}

static void stop(void) { cm1e_path_stop(&driven.path, 500, 0); }
static void override(void) { cm1e_path_override(&driven.path, 0.6); }
static void pause_path(void)
{
    cm1e_path_pause(&driven.path);
    for (int i = 0; i < driven.path.config.axes; i++)
        driven.now.velocity[i] = driven.now.acceleration[i] = 0;
}

static void test_a_path_keeps_its_way_and_its_limits(void)
{
    void (*const disturbances[])(void) = {NULL, stop, override, pause_path};
    begin_around();
    const double full_s = run_path();
    for (int d = 0; d < 4; d++)
        for (int cycle = 1; !slowed_in(cycle, full_s, disturbances[d]); cycle++)
            ;
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_velocity_acceleration_and_jerk_keep_their_limits);
    RUN_TEST(test_full_pace_costs_nothing);
    RUN_TEST(test_a_path_keeps_its_way_and_its_limits);
    return UNITY_END();
}
