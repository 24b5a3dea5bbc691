/* Paths: what a user sees of one, by examples. */
#include "path_check.h"

void setUp(void) {}
void tearDown(void) {}

static const double ORIGIN[CM1E_PATH_AXES];

static void line(const double *end, double velocity, cm1e_path_junction_t junction, double parameter)
{
    const cm1e_path_command_t command = command_of(velocity, 1000, 20000, junction, parameter);
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_path_append_line(&driven.path, end, &command, NULL));
}

static void test_a_line_takes_the_time_of_one_axis(void)
{
    const cm1e_path_config_t config = plain_config(3, 3, 1000, 10000, 1e6);
    begin_path(&config, ORIGIN);
    line((double[]){30, 40, 0}, 100, CM1E_PATH_STOP, 0);
    const double time = run_path();
    cm1e_profile_t profile;
    cm1e_profile_to_position(&profile, &(cm1e_motion_state_t){0, 0, 0}, 50,
                             &(cm1e_motion_limits_t){100, 1000, 1000, 20000});
    TEST_ASSERT_DOUBLE_WITHIN(0.0011, profile.duration_s, time);
    TEST_ASSERT_EQUAL_DOUBLE(30, driven.now.position[0]);
    TEST_ASSERT_EQUAL_DOUBLE(40, driven.now.position[1]);
    TEST_ASSERT_EQUAL(2, driven.done_tag);
}

static void test_a_line_in_pieces_takes_the_time_of_one(void)
{
    const cm1e_path_config_t config = plain_config(3, 3, 1000, 10000, 1e6);
    begin_path(&config, ORIGIN);
    line((double[]){100, 50, 20}, 100, CM1E_PATH_EXACT, 0);
    const double one = run_path();
    begin_path(&config, ORIGIN);
    for (int i = 1; i <= 20; i++)
        line((double[]){5 * i, 2.5 * i, i}, 100, CM1E_PATH_EXACT, 0);
    TEST_ASSERT_DOUBLE_WITHIN(0.001, one, run_path());
    begin_path(&config, ORIGIN);
    for (int i = 1; i <= 20; i++) { /* appended on the way, one every 10 cycles */
        line((double[]){5 * i, 2.5 * i, i}, 100, CM1E_PATH_EXACT, 0);
        for (int k = 0; k < 10 && i < 20; k++)
            step_path();
    }
    (void)run_path();
    TEST_ASSERT_DOUBLE_WITHIN(0.001, one, driven.time_s);
}

static void test_a_stop_and_on(void)
{
    const cm1e_path_config_t config = plain_config(3, 3, 1000, 10000, 1e6);
    begin_path(&config, ORIGIN);
    line((double[]){100, 50, 20}, 100, CM1E_PATH_EXACT, 0);
    line((double[]){100, 150, 20}, 100, CM1E_PATH_EXACT, 0);
    for (int i = 0; i < 400; i++)
        step_path();
    cm1e_path_stop(&driven.path, 2000, 0);
    for (int i = 0; i < 400; i++)
        step_path();
    TEST_ASSERT_EQUAL(CM1E_PATH_STOPPED, driven.now.phase);
    cm1e_path_go_on(&driven.path);
    (void)run_path();
    TEST_ASSERT_EQUAL_DOUBLE(150, driven.now.position[1]);
    TEST_ASSERT_EQUAL(3, driven.done_tag);
}

static void test_a_corner_with_a_transition_is_not_stopped_at(void)
{
    const cm1e_path_config_t config = plain_config(3, 3, 1000, 2000, 1e5);
    begin_path(&config, ORIGIN);
    line((double[]){100, 0, 0}, 100, CM1E_PATH_EXACT, 0);
    line((double[]){100, 100, 0}, 100, CM1E_PATH_CORNER_DISTANCE, 5);
    double slowest = INFINITY, nearest = INFINITY;
    do {
        step_path();
        if (driven.time_s > 0.5 && driven.time_s < 1.7)
            slowest = fmin(slowest, driven.now.path_velocity);
        nearest = fmin(nearest, hypot(driven.now.position[0] - 100, driven.now.position[1]));
    } while (driven.now.phase != CM1E_PATH_IDLE);
    TEST_ASSERT_TRUE(slowest > 80);
    TEST_ASSERT_TRUE(nearest > 1 && nearest < 3);
}

static void test_a_circle(void)
{
    const cm1e_path_config_t config = plain_config(3, 3, 1000, 2000, 1e5);
    begin_path(&config, ORIGIN);
    const cm1e_path_command_t command = command_of(100, 1000, 20000, CM1E_PATH_STOP, 0);
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_path_append_arc_centre(&driven.path, (double[]){10, 0, 0}, (double[]){0, 0, 0},
                                                           CM1E_PATH_CLOCKWISE, &command, NULL));
    do {
        step_path();
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, 10, hypot(driven.now.position[0] - 10, driven.now.position[1]));
    } while (driven.now.phase != CM1E_PATH_IDLE);
    TEST_ASSERT_EQUAL_DOUBLE(0, driven.now.position[0]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_line_takes_the_time_of_one_axis);
    RUN_TEST(test_a_line_in_pieces_takes_the_time_of_one);
    RUN_TEST(test_a_stop_and_on);
    RUN_TEST(test_a_corner_with_a_transition_is_not_stopped_at);
    RUN_TEST(test_a_circle);
    return UNITY_END();
}
