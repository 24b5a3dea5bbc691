/* Paths: what a user sees of one, by examples. */
#include "motion/path_private.h"
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
    TEST_ASSERT_TRUE(driven.decided > 0.8 * 3 * driven.steps);
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

static const double NO_LIMIT = INFINITY;

static void expect_refused(cm1e_error_t error, const cm1e_path_problem_t *problem, cm1e_error_t expected,
                           cm1e_path_refusal_t refusal)
{
    TEST_ASSERT_EQUAL(expected, error);
    TEST_ASSERT_EQUAL(refusal, problem->refusal);
    TEST_ASSERT_EQUAL(0, driven.path.segment_count);
}

static void test_what_makes_no_sense_is_refused(void)
{
    cm1e_path_config_t config = plain_config(3, 2, 1000, 2000, 1e5);
    cm1e_path_problem_t problem;
    begin_path(&config, ORIGIN);
    cm1e_path_command_t fine = command_of(100, 1000, 20000, CM1E_PATH_STOP, 0), command;
    const double end[] = {10, 0, 0}, odd[] = {10, NAN, 0};
    expect_refused(cm1e_path_append_line(&driven.path, odd, &fine, &problem), &problem, CM1E_ERROR_INVALID_ARGUMENT,
                   CM1E_PATH_NO_NUMBER);
    command = fine, command.tag = 0;
    expect_refused(cm1e_path_append_line(&driven.path, end, &command, &problem), &problem,
                   CM1E_ERROR_INVALID_ARGUMENT, CM1E_PATH_NO_NUMBER);
    command = fine, command.limits.jerk = -1;
    expect_refused(cm1e_path_append_line(&driven.path, end, &command, &problem), &problem,
                   CM1E_ERROR_INVALID_ARGUMENT, CM1E_PATH_NO_NUMBER);
    command = fine, command.junction = CM1E_PATH_CORNER_DISTANCE;
    expect_refused(cm1e_path_append_line(&driven.path, end, &command, &problem), &problem,
                   CM1E_ERROR_INVALID_ARGUMENT, CM1E_PATH_NO_TRANSITION);
    expect_refused(cm1e_path_append_arc_border(&driven.path, (double[]){5, 0}, end, &fine, &problem), &problem,
                   CM1E_ERROR_INVALID_ARGUMENT, CM1E_PATH_NO_ARC);
    expect_refused(cm1e_path_append_arc_border(&driven.path, (double[]){5, 5}, ORIGIN, &fine, &problem), &problem,
                   CM1E_ERROR_INVALID_ARGUMENT, CM1E_PATH_NO_ARC);
    expect_refused(cm1e_path_append_arc_centre(&driven.path, (double[]){5.1, 0}, end, CM1E_PATH_CLOCKWISE, &fine,
                                               &problem), &problem, CM1E_ERROR_INVALID_ARGUMENT, CM1E_PATH_NO_ARC);
}

/** Of 1 to 8 axes, of which 1 to 3 make up the space. */
static void test_a_path_begins_with_axes_a_space_and_a_cycle_that_there_are(void)
{
    static const struct { int axes, space; double cycle_s; bool possible; } rows[] = {
        {1, 1, 1e-3, true},  {2, 2, 1e-3, true},   {3, 3, 1e-3, true},   {8, 3, 1e-3, true},   {8, 1, 1e-3, true},
        {0, 0, 1e-3, false}, {0, 1, 1e-3, false},  {-1, 1, 1e-3, false}, {9, 3, 1e-3, false},  {3, 0, 1e-3, false},
        {3, -1, 1e-3, false}, {8, 4, 1e-3, false}, {2, 3, 1e-3, false},  {1, 2, 1e-3, false},  {3, 2, 0, false},
        {3, 2, -1e-3, false}, {3, 2, NAN, false},  {3, 2, INFINITY, false},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        cm1e_path_config_t config = plain_config(CM1E_PATH_AXES, 1, 1000, 2000, 1e5);
        config.axes = rows[i].axes, config.space = rows[i].space, config.cycle_s = rows[i].cycle_s;
        TEST_ASSERT_EQUAL(rows[i].possible ? CM1E_OK : CM1E_ERROR_INVALID_ARGUMENT,
                          cm1e_path_begin(&driven.path, &config, ORIGIN));
    }
    cm1e_path_config_t config = plain_config(3, 2, 1000, 2000, 1e5);
    config.axis[1].acceleration = NO_LIMIT;
    TEST_ASSERT_EQUAL(CM1E_ERROR_INVALID_ARGUMENT, cm1e_path_begin(&driven.path, &config, ORIGIN));
}

static void test_an_arc_that_bulges_over_a_bound_is_refused(void)
{
    cm1e_path_config_t config = plain_config(2, 2, 1000, 2000, 1e5);
    config.axis[1].highest = 4.9;
    begin_path(&config, ORIGIN);
    cm1e_path_problem_t problem;
    const cm1e_path_command_t command = command_of(100, 1000, 20000, CM1E_PATH_STOP, 0);
    const double centre[] = {5, 0}, end[] = {10, 0};
    expect_refused(cm1e_path_append_arc_centre(&driven.path, centre, end, CM1E_PATH_CLOCKWISE, &command, &problem),
                   &problem, CM1E_ERROR_AXIS_POSITION_RANGE, CM1E_PATH_OUT_OF_BOUNDS);
    TEST_ASSERT_EQUAL(1, problem.axis);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 5, problem.position);
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_path_append_arc_centre(&driven.path, centre, end, CM1E_PATH_COUNTER_CLOCKWISE,
                                                           &command, &problem));
    double lowest = 0;
    do {
        step_path();
        lowest = fmin(lowest, driven.now.position[1]);
    } while (driven.now.phase != CM1E_PATH_IDLE);
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, -5, lowest);
}

static void test_from_outside_the_bounds_only_back(void)
{
    cm1e_path_config_t config = plain_config(1, 1, 1000, 2000, 1e5);
    config.axis[0].highest = 10;
    begin_path(&config, (double[]){12});
    cm1e_path_problem_t problem;
    const cm1e_path_command_t command = command_of(100, 1000, 20000, CM1E_PATH_STOP, 0);
    expect_refused(cm1e_path_append_line(&driven.path, (double[]){12.5}, &command, &problem), &problem,
                   CM1E_ERROR_AXIS_POSITION_RANGE, CM1E_PATH_OUT_OF_BOUNDS);
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_path_append_line(&driven.path, (double[]){9}, &command, &problem));
}

static void test_a_line_into_an_arc_is_passed_without_a_stop(void)
{
    const cm1e_path_config_t config = plain_config(2, 2, 1000, 3000, 1e5);
    begin_path(&config, ORIGIN);
    line((double[]){50, 0}, 100, CM1E_PATH_STOP, 0);
    const cm1e_path_command_t command = command_of(100, 1000, 20000, CM1E_PATH_EXACT, 0);
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_path_append_arc_centre(&driven.path, (double[]){50, 20}, (double[]){70, 20},
                                                           CM1E_PATH_COUNTER_CLOCKWISE, &command, NULL));
    double slowest = INFINITY;
    do {
        step_path();
        if (driven.now.position[0] > 40 && driven.now.position[0] < 60)
            slowest = fmin(slowest, driven.now.path_velocity);
    } while (driven.now.phase != CM1E_PATH_IDLE);
    /* The step of the acceleration is half of what the jerk allows in a cycle: v2 / 20 = 1e5 * 1e-3 / 2. */
    TEST_ASSERT_DOUBLE_WITHIN(0.5, sqrt(20 * 50), slowest);
}

static void test_the_velocity_at_a_junction_is_that_of_its_mode(void)
{
    static const double first[] = {60, 120}, second[] = {120, 60};
    for (int k = 0; k < 2; k++)
        for (int blend = CM1E_PATH_BLEND_LOW; blend <= CM1E_PATH_BLEND_HIGH; blend++) {
            const double expected[] = {60, first[k], second[k], 120};
            const cm1e_path_config_t config = plain_config(2, 2, 1000, 10000, 1e6);
            begin_path(&config, ORIGIN);
            line((double[]){100, 0}, first[k], CM1E_PATH_STOP, 0);
            cm1e_path_command_t command = command_of(second[k], 1000, 20000, CM1E_PATH_EXACT, 0);
            command.blend = (cm1e_path_blend_t)blend;
            TEST_ASSERT_EQUAL(CM1E_OK, cm1e_path_append_line(&driven.path, (double[]){200, 0}, &command, NULL));
            do
                step_path();
            while (driven.now.done == 0);
            TEST_ASSERT_DOUBLE_WITHIN(0.1, expected[blend], driven.now.path_velocity);
            (void)run_path();
        }
}

static void test_many_short_segments_keep_the_velocity(void)
{
    const cm1e_path_config_t config = plain_config(3, 3, 1000, 20000, 1e6);
    begin_path(&config, ORIGIN);
    int appended = 0;
    double at_pace = 0;
    do { /* an outline of chords of 1 mm of a circle of 300 mm, a few at a time */
        while (appended < 1000 && driven.path.segment_count < CM1E_PATH_SEGMENTS) {
            const double angle = ++appended / 300.0;
            line((double[]){300 * sin(angle), 300 - 300 * cos(angle), 0}, 100, CM1E_PATH_CORNER_DEVIATION, 0.01);
        }
        step_path();
        at_pace += driven.now.path_velocity >= 99.9 ? driven.path.config.cycle_s : 0;
    } while (driven.now.phase != CM1E_PATH_IDLE);
    TEST_ASSERT_EQUAL(1001, driven.done_tag);
    TEST_ASSERT_TRUE(at_pace > 9.5);
    TEST_ASSERT_TRUE(driven.time_s < 10.3);
}

/** Targets that should be equal may differ by rounding: a line of one unit in the last place, and back. */
static void test_a_line_of_rounding_is_no_corner_without_room(void)
{
    const double at[] = {0.3, 1000.3, -91832.378705665717};
    const double ways[][2] = {{0, 0}, {-50, 0}, {-50, 80}, {3, 80}};
    for (size_t k = 0; k < sizeof at / sizeof *at * 8; k++) {
        const cm1e_path_config_t config = plain_config(2, 2, 1000, 2000, 1e5);
        const double x = at[k / 8], *way = ways[k / 2 % 4], start[CM1E_PATH_AXES] = {x - 30};
        const cm1e_path_junction_t junction = k % 2 ? CM1E_PATH_CORNER_DISTANCE : CM1E_PATH_CORNER_DEVIATION;
        begin_path(&config, start);
        memcpy(driven.now.position, start, sizeof start);
        line((double[]){x, 0}, 100, CM1E_PATH_STOP, 0);
        line((double[]){nextafter(x, INFINITY), 0}, 100, junction, 1);
        line((double[]){nextafter(nextafter(x, INFINITY), INFINITY), 0}, 100, junction, 1);
        line((double[]){x + way[0], way[1]}, 100, junction, 1);
        (void)run_path();
        TEST_ASSERT_EQUAL_DOUBLE(way[1], driven.now.position[1]);
    }
}

/** What is known of the way ahead is what the elements are now. */
static void check_look_ahead(void)
{
    static cm1e_path_t anew;
    cm1e_path_copy(&anew, &driven.path);
    const int first = cm1e_path_run(&anew, 0, anew.element_count).count;
    (void)cm1e_path_plan(&anew, 0);
    for (int i = first; i < anew.element_count; i++) {
        const cm1e_path_element_t *is = cm1e_path_element(&driven.path, i), *right = cm1e_path_element(&anew, i);
        CHECK_PATH(is->entry == right->entry && is->hard_entry == right->hard_entry);
    }
}

/** A transition that comes too late for the velocity of the path is tried with ever shorter ways, then given up. */
static void test_a_transition_that_is_given_up_leaves_the_way_ahead_as_it_was(void)
{
    const cm1e_path_config_t config = plain_config(2, 2, 1000, 2000, 1e5);
    for (double n = 0.5; n < 20; n *= 1.3)
        for (int at = 150;; at++) {
            begin_path(&config, (double[CM1E_PATH_AXES]){0});
            line((double[]){50, 0}, 0, CM1E_PATH_STOP, 0);
            line((double[]){50 + n, n / 20}, 0, CM1E_PATH_CORNER_DISTANCE, 1);
            for (int i = 0; i < at; i++)
                step_path();
            if (driven.now.active != 1)
                break;
            line((double[]){50 + n, n}, 0, CM1E_PATH_CORNER_DISTANCE, 5);
            check_look_ahead();
            (void)run_path();
        }
}

static void test_override_slows_pauses_and_goes_on(void)
{
    const cm1e_path_config_t config = plain_config(2, 2, 1000, 10000, 1e6);
    begin_path(&config, ORIGIN);
    line((double[]){200, 0}, 100, CM1E_PATH_STOP, 0);
    static const struct {
        double factor, velocity;
    } steps[] = {{1, 100}, {0.5, 50}, {0, 0}, {1.5, 150}};
    for (int k = 0; k < 4; k++) {
        cm1e_path_override(&driven.path, steps[k].factor);
        for (int i = 0; i < 400; i++)
            step_path();
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, steps[k].velocity, driven.now.path_velocity);
        TEST_ASSERT_EQUAL(CM1E_PATH_MOVING, driven.now.phase);
    }
    (void)run_path();
    TEST_ASSERT_EQUAL_DOUBLE(200, driven.now.position[0]);
}

/** Slower than numbers can say how long it lasts: it hardly moves, and does not jump to its end. */
static void test_absurdly_slow_commands_do_not_jump(void)
{
    static const cm1e_motion_limits_t slow[] = {
        {1e-300, 0, 0, 0}, {1e-60, 0, 0, 0}, {100, 1e-300, 1e-300, 0}, {100, 0, 1e-300, 0}, {0, 0, 0, 1e-300},
        {1e-300, 1e-300, 1e-300, 1e-300}};
    const cm1e_path_config_t config = plain_config(2, 2, 1000, 10000, 1e6);
    for (size_t k = 0; k < sizeof slow / sizeof slow[0]; k++) {
        begin_path(&config, ORIGIN);
        const cm1e_path_command_t command = {.limits = slow[k], .junction = CM1E_PATH_STOP, .tag = 1};
        TEST_ASSERT_EQUAL(CM1E_OK, cm1e_path_append_line(&driven.path, (double[]){200, 100}, &command, NULL));
        for (int i = 0; i < 20; i++)
            step_path();
        TEST_ASSERT_EQUAL(CM1E_PATH_MOVING, driven.now.phase);
        TEST_ASSERT_TRUE(driven.now.position[0] < 2);
        cm1e_path_stop(&driven.path, 1e-300, 1e-300);
        cm1e_path_override(&driven.path, 1e-300);
        for (int i = 0; i < 20; i++)
            step_path();
        TEST_ASSERT_TRUE(driven.now.position[0] < 10);
    }
}

/* By the times of its pieces, also where it turns or ends in the middle of one. */
static void test_the_extremes_of_the_velocity_are_those_of_a_search(void)
{
    enum { STEPS = 400 };
    for (int n = 0; n < 2000; n++) {
        cm1e_profile_t profile = {.segment_count = 1 + (int)(random_bits() % CM1E_PROFILE_MAX_SEGMENTS)};
        cm1e_motion_state_t at = {0, random_between(-1, 1), random_between(-1, 1)};
        double low = at.velocity, high = at.velocity, coarse = 0;
        for (int i = 0; i < profile.segment_count; i++) {
            const double duration_s = random_between(0.01, 1), jerk = one_in(4) ? 0 : random_between(-3, 3);
            profile.segments[i] = (cm1e_profile_segment_t){profile.duration_s, jerk, at};
            for (int k = 1; k <= STEPS; k++) {
                const double t = duration_s * k / STEPS, v = at.velocity + t * (at.acceleration + t * jerk / 2);
                low = fmin(low, v);
                high = fmax(high, v);
            }
            coarse = fmax(coarse, fabs(jerk) * pow(duration_s / STEPS, 2));
            at.velocity += duration_s * (at.acceleration + duration_s * jerk / 2);
            at.acceleration += duration_s * jerk;
            profile.duration_s += duration_s;
        }
        profile.end = at;
        double lowest, highest;
        cm1e_path_velocities(&profile, &lowest, &highest);
        TEST_ASSERT_TRUE(lowest <= low + 1e-12 && lowest >= low - coarse - 1e-12);
        TEST_ASSERT_TRUE(highest >= high - 1e-12 && highest <= high + coarse + 1e-12);
    }
}

static void test_what_is_cut_off_is_not_done_and_the_path_goes_on_from_there(void)
{
    const cm1e_path_config_t config = plain_config(2, 2, 1000, 10000, 1e6);
    begin_path(&config, ORIGIN);
    line((double[]){100, 0}, 100, CM1E_PATH_STOP, 0);
    line((double[]){200, 0}, 100, CM1E_PATH_EXACT, 0);
    for (int i = 0; i < 500; i++)
        step_path();
    cm1e_path_clear(&driven.path);
    double end[2];
    cm1e_path_end(&driven.path, end);
    TEST_ASSERT_TRUE(end[0] > driven.now.position[0] && end[0] < 60);
    TEST_ASSERT_EQUAL(1, driven.path.segment_count);
    driven.done_tag = 3; /* of the next one */
    line((double[]){0, 50}, 100, CM1E_PATH_EXACT, 0);
    double reached = 0;
    do {
        step_path();
        reached = fmax(reached, driven.now.position[0]);
    } while (driven.now.phase != CM1E_PATH_IDLE);
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, end[0], reached);
    TEST_ASSERT_EQUAL_DOUBLE(50, driven.now.position[1]);
    TEST_ASSERT_EQUAL(4, driven.done_tag);
}

/* The last stop is as it was told; what comes behind it has the other override. */
static void test_an_override_during_the_last_stop_acts_behind_it(void)
{
    const cm1e_path_config_t config = plain_config(2, 2, 1000, 10000, 1e6);
    for (int goes_on = 0; goes_on < 2; goes_on++) {
        begin_path(&config, ORIGIN);
        line((double[]){100, 0}, 100, CM1E_PATH_STOP, 0);
        for (int i = 0; i < 500; i++)
            step_path();
        cm1e_path_clear(&driven.path);
        cm1e_path_override(&driven.path, 0.5);
        driven.done_tag = 2; /* of the next one */
        if (!goes_on)
            (void)run_path();
        line((double[]){0, 50}, 100, CM1E_PATH_STOP, 0);
        while (driven.now.active != 2)
            step_path();
        driven.fastest = 0;
        (void)run_path();
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 50, driven.fastest);
    }
}

/* The second segment is to be begun from rest. Wherever the first one is cut off, also where it comes to rest as soon as
 * it can in any case, only a part of it is left, and the path ends where it says. */
static void test_a_segment_that_comes_to_rest_in_any_case_is_the_last_one(void)
{
    for (int k = 0; k < 3000; k++) {
        const double velocity = random_decade(20, 500), length = random_decade(0.01, 5);
        const cm1e_path_config_t config = plain_config(2, 2, velocity, velocity * random_decade(2, 30), 1e4);
        begin_path(&config, ORIGIN);
        line((double[]){length, 0}, 500, CM1E_PATH_STOP, 0);
        line((double[]){length, 30}, 500, CM1E_PATH_STOP, 0);
        const int at = 1 + (int)(random_bits() % 60);
        for (int i = 0; i < at; i++)
            step_path();
        if (driven.now.active != 1)
            continue;
        cm1e_path_clear(&driven.path);
        double end[2];
        cm1e_path_end(&driven.path, end);
        TEST_ASSERT_EQUAL(1, driven.path.segment_count);
        (void)run_path();
        TEST_ASSERT_EQUAL_UINT32(1, driven.done_tag); /* what was cut off is not done */
        TEST_ASSERT_EQUAL_DOUBLE(end[0], driven.now.position[0]);
        TEST_ASSERT_TRUE(end[0] <= length && end[1] == 0 && driven.now.position[1] == 0);
    }
}

/* A stop that ends in the second segment is cut off there. If the master pauses before, it ends where the pause finds it;
 * with another segment behind it, it begins again from rest with most of the way still before it, and the end of the cut
 * is not run over, nor met at speed. */
static void test_a_path_that_was_cut_off_ends_there_also_after_a_pause(void)
{
    const cm1e_path_config_t config = plain_config(2, 2, 1000, 10000, 1e6);
    for (int at = 100; at < 300; at++) {
        begin_path(&config, ORIGIN);
        line((double[]){100, 0}, 100, CM1E_PATH_EXACT, 0);
        line((double[]){110, 0}, 50, CM1E_PATH_EXACT, 0);
        for (int i = 0; i < at; i++)
            step_path();
        cm1e_path_stop(&driven.path, 60, 1e6);
        cm1e_path_clear(&driven.path);
        double end[2];
        cm1e_path_end(&driven.path, end);
        const bool goes_on = at % 2 == 0;
        driven.next_tag = end[0] > 100 ? 2 : 1; /* those that were cut off are not done */
        if (goes_on)
            line((double[]){end[0], 40}, 50, CM1E_PATH_STOP, 0);
        step_path();
        cm1e_path_pause(&driven.path);
        const double paused_at = driven.now.position[0];
        driven.now.path_velocity = 0;
        for (int i = 0; i < 2; i++)
            driven.now.velocity[i] = driven.now.acceleration[i] = 0;
        run_path(); /* position and velocity of every step fit together */
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, goes_on ? end[0] : paused_at, driven.now.position[0]);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, goes_on ? 40 : 0, driven.now.position[1]);
        TEST_ASSERT_TRUE(goes_on || paused_at < end[0] - 1);
    }
}

static void test_a_stop_keeps_its_deceleration_and_comes_to_an_end_in_corners(void)
{
    const cm1e_path_config_t config = plain_config(2, 2, 1000, 10000, 1e6);
    for (int at = 1; at < 900; at += 7) { /* wherever it is asked for */
        begin_path(&config, ORIGIN);
        line((double[]){30, 0}, 100, CM1E_PATH_STOP, 0);
        line((double[]){30, 30}, 100, CM1E_PATH_CORNER_DISTANCE, 3);
        line((double[]){0, 30}, 100, CM1E_PATH_CORNER_DISTANCE, 3);
        for (int i = 0; i < at; i++)
            step_path();
        cm1e_path_stop(&driven.path, 500, 10000);
        for (int i = 0; i < 1500; i++)
            step_path();
        TEST_ASSERT_EQUAL_DOUBLE(0, driven.now.path_velocity);
        TEST_ASSERT_TRUE(driven.now.phase == CM1E_PATH_STOPPED || driven.now.phase == CM1E_PATH_IDLE);
        cm1e_path_go_on(&driven.path);
        (void)run_path();
        TEST_ASSERT_EQUAL_DOUBLE(30, driven.now.position[1]);
        TEST_ASSERT_EQUAL(4, driven.done_tag);
    }
}

/** With a deceleration that does not fit into what is left of the path: not with that of the command at once. */
static void test_a_stop_too_gentle_for_the_way_is_as_gentle_as_fits(void)
{
    const cm1e_path_config_t config = plain_config(2, 2, 1000, 10000, 1e6);
    for (int corner = 0; corner < 2; corner++)
        for (double left = 2; left < 60; left *= 1.3) {
            begin_path(&config, ORIGIN);
            line((double[]){100, 0}, 100, CM1E_PATH_STOP, 0);
            if (corner)
                line((double[]){100, 100}, 100, CM1E_PATH_STOP, 0);
            while (driven.now.position[0] < 100 - left)
                step_path();
            const double v = driven.now.path_velocity;
            cm1e_path_stop(&driven.path, 1, 0);
            double most = 0;
            do {
                step_path();
                most = fmax(most, -driven.now.path_acceleration);
            } while (driven.now.phase == CM1E_PATH_STOPPING);
            TEST_ASSERT_DOUBLE_WITHIN(0.06 * left, 100, driven.now.position[0]);
            TEST_ASSERT_TRUE(most <= 1.3 * v * v / 2 / left);
            TEST_ASSERT_EQUAL_DOUBLE(0, driven.now.position[1]);
        }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_line_takes_the_time_of_one_axis);
    RUN_TEST(test_a_line_in_pieces_takes_the_time_of_one);
    RUN_TEST(test_a_stop_and_on);
    RUN_TEST(test_a_corner_with_a_transition_is_not_stopped_at);
    RUN_TEST(test_a_circle);
    RUN_TEST(test_what_makes_no_sense_is_refused);
    RUN_TEST(test_a_path_begins_with_axes_a_space_and_a_cycle_that_there_are);
    RUN_TEST(test_an_arc_that_bulges_over_a_bound_is_refused);
    RUN_TEST(test_from_outside_the_bounds_only_back);
    RUN_TEST(test_a_line_into_an_arc_is_passed_without_a_stop);
    RUN_TEST(test_the_velocity_at_a_junction_is_that_of_its_mode);
    RUN_TEST(test_many_short_segments_keep_the_velocity);
    RUN_TEST(test_a_line_of_rounding_is_no_corner_without_room);
    RUN_TEST(test_a_transition_that_is_given_up_leaves_the_way_ahead_as_it_was);
    RUN_TEST(test_override_slows_pauses_and_goes_on);
    RUN_TEST(test_absurdly_slow_commands_do_not_jump);
    RUN_TEST(test_an_override_during_the_last_stop_acts_behind_it);
    RUN_TEST(test_a_segment_that_comes_to_rest_in_any_case_is_the_last_one);
    RUN_TEST(test_the_extremes_of_the_velocity_are_those_of_a_search);
    RUN_TEST(test_what_is_cut_off_is_not_done_and_the_path_goes_on_from_there);
    RUN_TEST(test_a_path_that_was_cut_off_ends_there_also_after_a_pause);
    RUN_TEST(test_a_stop_keeps_its_deceleration_and_comes_to_an_end_in_corners);
    RUN_TEST(test_a_stop_too_gentle_for_the_way_is_as_gentle_as_fits);
    return UNITY_END();
}
