/* How soon paths are through: against the soonest way, which without a limit of jerk is known. */
#include "path_check.h"

enum { PATHS = 12, SEGMENTS = 24, PARTS = 20000, OTHER_LIMITS = 1500 };

void setUp(void) {}
void tearDown(void) {}

/** Forwards and backwards over the velocities that every element allows: the soonest way with its accelerations. */
static double soonest(void)
{
    static double velocity[PARTS + 1], faster[PARTS + 1], slower[PARTS + 1];
    const cm1e_path_t *path = &driven.path;
    const double part = cm1e_path_left(path) / PARTS;
    double end = path->element[0].length;
    int on = 0;
    for (int i = 0; i <= PARTS; i++) {
        bool stops = i == 0 || i == PARTS;
        while (i * part >= end && on < path->element_count - 1) {
            end += path->element[++on].length;
            stops = stops || path->element[on].passed == 0;
        }
        const cm1e_path_element_t *element = &path->element[on];
        velocity[i] = stops ? 0 : fmin(element->limits.velocity, element->highest);
        faster[i] = element->limits.acceleration;
        slower[i] = element->limits.deceleration;
    }
    for (int i = 1; i <= PARTS; i++)
        velocity[i] = fmin(velocity[i], sqrt(velocity[i - 1] * velocity[i - 1] + 2 * faster[i] * part));
    double time = 0;
    for (int i = PARTS - 1; i >= 0; i--) {
        velocity[i] = fmin(velocity[i], sqrt(velocity[i + 1] * velocity[i + 1] + 2 * slower[i] * part));
        time += 2 * part / (velocity[i] + velocity[i + 1]);
    }
    return time;
}

/** Lines of these lengths and turns, with arcs between them or without. */
static void append_outline(double shortest, double longest, double turn_most, bool arcs, double jerk)
{
    double x = 0, y = 0, heading = 0;
    for (int i = 0; i < SEGMENTS; i++) {
        cm1e_path_command_t command = command_of(random_between(100, 300), random_between(1000, 4000), jerk,
                                                 CM1E_PATH_CORNER_DEVIATION, 0.1);
        const double before[] = {x, y, 0}, radius = random_between(5, 30), turn = random_between(0.3, 2);
        if (arcs && i % 2) {
            const double centre[] = {x - radius * sin(heading), y + radius * cos(heading), 0};
            heading += turn;
            x = centre[0] + radius * sin(heading), y = centre[1] - radius * cos(heading);
            TEST_ASSERT_EQUAL(CM1E_OK, cm1e_path_append_arc_centre(&driven.path, centre, (double[]){x, y, 0},
                                                                   CM1E_PATH_COUNTER_CLOCKWISE, &command, NULL));
            continue;
        }
        const double length = random_between(shortest, longest);
        heading += arcs ? 0 : random_between(-turn_most, turn_most);
        x = before[0] + length * cos(heading), y = before[1] + length * sin(heading);
        TEST_ASSERT_EQUAL(CM1E_OK, cm1e_path_append_line(&driven.path, (double[]){x, y, 0}, &command, NULL));
    }
}

static void compare(double shortest, double longest, double turn_most, bool arcs)
{
    for (int i = 0; i < PATHS; i++) {
        cm1e_path_config_t config = plain_config(3, 3, 500, 3000, INFINITY);
        config.axis[1].acceleration = 1500;
        begin_path(&config, (double[CM1E_PATH_AXES]){0});
        append_outline(shortest, longest, turn_most, arcs, INFINITY);
        const double bound = soonest(), time = run_path();
        CHECK_PATH(time >= bound * 0.99);
        CHECK_PATH(time <= bound * 1.02 + config.cycle_s);
    }
}

static void test_long_lines_and_corners(void) { compare(20, 50, 2, false); }
static void test_short_lines_and_corners(void) { compare(1, 3, 1.5, false); }
static void test_short_lines_that_hardly_turn(void) { compare(0.5, 2, 0.05, false); }
static void test_lines_and_arcs(void) { compare(5, 30, 0, true); }

/** With jerk, what is joined is not worse for a piece with less acceleration, nor for one that may go slower only. */
static void test_a_piece_with_other_limits_costs_what_it_must(void)
{
    const cm1e_path_config_t config = plain_config(2, 2, 500, 3000, 60000);
    double time[3];
    for (int other = 0; other < 3; other++) {
        begin_path(&config, (double[CM1E_PATH_AXES]){0});
        for (int i = 1; i <= 20; i++) {
            cm1e_path_command_t command = command_of(200, 2000, 20000, CM1E_PATH_EXACT, 0);
            if (i == 10 && other == 1)
                command.limits.acceleration = command.limits.deceleration = 1000;
            if (i == 10 && other == 2)
                command.limits.velocity = 150;
            TEST_ASSERT_EQUAL(CM1E_OK, cm1e_path_append_line(&driven.path, (double[]){10 * i, 0}, &command, NULL));
        }
        time[other] = run_path();
    }
    TEST_ASSERT_TRUE(time[1] <= time[0] * 1.01);
    /* 10 mm more slowly, and two changes by 50 mm/s, which take 0.1 s each, at 175 in the mean. */
    TEST_ASSERT_TRUE(time[2] <= time[0] + 10 / 150.0 - 10 / 200.0 + 2 * 0.1 * 25 / 200 + 0.005);
}

/** Until it is at rest. */
static double stopped_after(void)
{
    const double start = driven.time_s;
    cm1e_path_stop(&driven.path, 0, 0);
    do
        step_path();
    while (driven.now.phase == CM1E_PATH_STOPPING);
    return driven.time_s - start;
}

/** On a circle without a limit of jerk the deceleration may be sqrt(A2 - (v2 / r)2) at every velocity. */
static void test_a_stop_on_a_circle_brakes_harder_the_slower_it_is(void)
{
    enum { PARTS_OF_STOP = 2000 };
    for (double radius = 0.3; radius < 50; radius *= 1.7) {
        const cm1e_path_config_t config = plain_config(2, 2, 500, 1000, INFINITY);
        begin_path(&config, (double[CM1E_PATH_AXES]){0});
        const cm1e_path_command_t command = command_of(0, 0, 0, CM1E_PATH_STOP, 0);
        TEST_ASSERT_EQUAL(CM1E_OK, cm1e_path_append_arc_centre(&driven.path, (double[]){radius, 0}, (double[]){0, 0},
                                                               CM1E_PATH_CLOCKWISE, &command, NULL));
        double v = 0;
        do {
            v = driven.now.path_velocity;
            step_path();
        } while (driven.now.path_velocity > v);
        double soonest_s = 0;
        for (int i = 0; i < PARTS_OF_STOP; i++) {
            const double u = v * (i + 0.5) / PARTS_OF_STOP, across = u * u / radius / 1000;
            soonest_s += v / PARTS_OF_STOP / 1000 / sqrt(1 - across * across);
        }
        const double time_s = stopped_after();
        CHECK_PATH(time_s >= soonest_s - 1e-9);
        CHECK_PATH(time_s <= soonest_s * 1.12 + 2 * config.cycle_s);
    }
}

/** s; that a stop takes from here. The path goes on as before. */
static double time_of_stop(void)
{
    static driven_t moment;
    moment = driven;
    const double time_s = stopped_after();
    driven = moment;
    return time_s;
}

/** At all moments of paths with many bends, with the time that the weakest axis would need on a line. */
static void test_stops_in_bends_take_little_longer_than_on_a_line(void)
{
    double stops_s = 0, lines_s = 0;
    for (int i = 0; i < PATHS; i++) {
        cm1e_path_config_t config = plain_config(3, 3, 500, 3000, 60000);
        config.axis[1].acceleration = 1500;
        begin_path(&config, (double[CM1E_PATH_AXES]){0});
        append_outline(0.5, 4, 1.8, i % 2, 0);
        do {
            for (int k = 0; k < 7 && driven.now.phase == CM1E_PATH_MOVING; k++)
                step_path();
            const cm1e_motion_state_t start = {0, driven.now.path_velocity, driven.now.path_acceleration};
            cm1e_profile_t line;
            TEST_ASSERT_EQUAL(CM1E_OK, cm1e_profile_to_velocity(
                                           &line, &start, 0, &(cm1e_motion_limits_t){500, 1500, 1500, 60000}));
            stops_s += time_of_stop();
            lines_s += line.duration_s;
            step_path();
        } while (driven.now.phase == CM1E_PATH_MOVING);
    }
    printf("stops in bends take %.3f times as long as on a line\n", stops_s / lines_s);
    TEST_ASSERT_TRUE(stops_s <= 1.15 * lines_s);
}

/** Lines straight on, each with limits of its own: so long, with so much of the velocity, and of the acceleration. */
typedef struct {
    double length, velocity, acceleration;
} stretch_t;

static cm1e_motion_limits_t limits_of(const stretch_t *stretch)
{
    const double a = 2000 * stretch->acceleration;
    return (cm1e_motion_limits_t){200 * stretch->velocity, a, a, 20000};
}

/** With acceleration 0 at each junction. */
static double one_by_one(const stretch_t *stretches, int count)
{
    double passed[SEGMENTS + 1] = {0}, time = 0;
    for (int i = count - 1; i > 0; i--) {
        const cm1e_motion_limits_t limits = limits_of(&stretches[i]), before = limits_of(&stretches[i - 1]);
        passed[i] = cm1e_profile_entry_velocity(stretches[i].length, fmin(limits.velocity, before.velocity),
                                                passed[i + 1], &limits);
    }
    for (int i = 0; i < count; i++) {
        const cm1e_motion_limits_t limits = limits_of(&stretches[i]);
        const cm1e_motion_state_t start = {0, passed[i], 0};
        cm1e_profile_t profile;
        if (i + 1 < count)
            passed[i + 1] = cm1e_profile_passing_velocity(&start, stretches[i].length, passed[i + 1], &limits);
        TEST_ASSERT_EQUAL(CM1E_OK, cm1e_profile_to_state(&profile, &start, stretches[i].length, passed[i + 1],
                                                         &limits));
        time += profile.duration_s;
    }
    return time;
}

/** As one line with the lowest of their limits. */
static double all_in_one(const stretch_t *stretches, int count)
{
    stretch_t whole = {0, INFINITY, INFINITY};
    for (int i = 0; i < count; i++) {
        whole.length += stretches[i].length;
        whole.velocity = fmin(whole.velocity, stretches[i].velocity);
        whole.acceleration = fmin(whole.acceleration, stretches[i].acceleration);
    }
    const cm1e_motion_limits_t limits = limits_of(&whole);
    cm1e_profile_t profile;
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_profile_to_position(&profile, &(cm1e_motion_state_t){0, 0, 0}, whole.length,
                                                        &limits));
    return profile.duration_s;
}

static double along(const stretch_t *stretches, int count)
{
    const cm1e_path_config_t config = plain_config(2, 2, 500, 5000, 60000);
    double x = 0;
    begin_path(&config, (double[CM1E_PATH_AXES]){0});
    for (int i = 0; i < count; i++) {
        const cm1e_motion_limits_t limits = limits_of(&stretches[i]);
        cm1e_path_command_t command = command_of(limits.velocity, limits.acceleration, limits.jerk, CM1E_PATH_EXACT, 0);
        x += stretches[i].length;
        TEST_ASSERT_EQUAL(CM1E_OK, cm1e_path_append_line(&driven.path, (double[]){x, 0}, &command, NULL));
    }
    return run_path();
}

static void random_stretches(stretch_t *stretches, int count)
{
    const double spread = random_decade(0.001, 2), weaker = random_decade(0.001, 2), size = random_decade(0.5, 100);
    const bool all_differ = one_in(2);
    for (int i = 0; i < count; i++) {
        stretches[i] = (stretch_t){size * random_decade(0.3, 3), 1, 1};
        if (!all_differ && i != count / 2)
            continue;
        stretches[i].velocity = exp(-spread * random_between(0, 1));
        stretches[i].acceleration = exp(-weaker * random_between(0, 1));
    }
}

/** To plan several in one costs their limits, to plan each by itself the acceleration between them. */
static void test_lines_with_other_limits_take_hardly_longer_than_the_better_of_two_ways(void)
{
    double times = 0, better = 0;
    for (int i = 0; i < OTHER_LIMITS; i++) {
        stretch_t stretches[SEGMENTS];
        const int count = 2 + (int)(random_bits() % 8);
        random_stretches(stretches, count);
        const double one = one_by_one(stretches, count), all = all_in_one(stretches, count);
        const double time = along(stretches, count);
        CHECK_PATH(time <= fmin(one, all) * 1.1 + driven.path.config.cycle_s);
        times += time;
        better += fmin(one, all);
    }
    printf("lines with other limits take %.5f times as long as the better of two ways\n", times / better);
    TEST_ASSERT_TRUE(times <= better);
}

/** With much jerk a stop in arcs may be of more stages than a profile has room for: the best of them are found. */
static void test_stops_of_many_stages_take_little_longer_than_on_a_line(void)
{
    int stops = 0, slow = 0;
    for (int i = 0; i < PATHS; i++) {
        cm1e_path_config_t config = plain_config(3, 3, 500, 3000, 1e6);
        config.axis[1].acceleration = 1500;
        begin_path(&config, (double[CM1E_PATH_AXES]){0});
        append_outline(5, 20, 0, true, 0);
        do {
            for (int k = 0; k < 3 && driven.now.phase == CM1E_PATH_MOVING; k++)
                step_path();
            const double line_s = driven.now.path_velocity / 1500 + 1500 / 1e6;
            slow += time_of_stop() > 1.3 * line_s + 2 * config.cycle_s;
            stops++;
            step_path();
        } while (driven.now.phase == CM1E_PATH_MOVING);
    }
    TEST_ASSERT_LESS_THAN_INT(stops / 500, slow);
}

/** A segment with other limits, appended while the run is under way, does not slow what is before it. */
static void test_what_is_appended_does_not_slow_the_run_under_way(void)
{
    for (double slower = 100; slower < 200; slower += 1) {
        const cm1e_path_config_t config = plain_config(2, 2, 500, 3000, 60000);
        begin_path(&config, (double[CM1E_PATH_AXES]){0});
        cm1e_path_command_t command = command_of(200, 0, 0, CM1E_PATH_EXACT, 0);
        TEST_ASSERT_EQUAL(CM1E_OK, cm1e_path_append_line(&driven.path, (double[]){100, 0}, &command, NULL));
        command.tag = driven.next_tag++;
        TEST_ASSERT_EQUAL(CM1E_OK, cm1e_path_append_line(&driven.path, (double[]){101, 0}, &command, NULL));
        while (driven.now.position[0] < 40)
            step_path();
        command = command_of(slower, 0, 0, CM1E_PATH_EXACT, 0);
        TEST_ASSERT_EQUAL(CM1E_OK, cm1e_path_append_line(&driven.path, (double[]){200, 0}, &command, NULL));
        while (driven.now.position[0] < 80) {
            step_path();
            CHECK_PATH(driven.now.path_velocity == 200);
        }
    }
}

/** Lines that hardly turn, so that they are passed exactly, with steps of the velocities of the axes. */
static void test_next_to_a_break_of_the_tangent_the_acceleration_is_lower(void)
{
    for (int i = 0; i < PATHS; i++) {
        const cm1e_path_config_t config = plain_config(2, 2, 500, 1000, 1e9);
        double x = 0, y = 0, heading = random_between(0, 6);
        begin_path(&config, (double[CM1E_PATH_AXES]){0});
        for (int k = 0; k < SEGMENTS; k++) {
            const cm1e_path_command_t command = command_of(0, 0, 0, CM1E_PATH_EXACT, 0);
            const double length = random_between(2, 10);
            heading += random_between(-0.001, 0.001);
            x += length * cos(heading), y += length * sin(heading);
            TEST_ASSERT_EQUAL(CM1E_OK, cm1e_path_append_line(&driven.path, (double[]){x, y}, &command, NULL));
        }
        run_path();
        CHECK_PATH(driven.fastest > 50);
    }
}

/** At an arc, what a transition deviates is found by trying. */
static void test_a_transition_at_an_arc_uses_its_deviation(void)
{
    for (double radius = 1; radius < 50; radius *= 1.2) {
        const cm1e_path_config_t config = plain_config(2, 2, 500, 3000, 60000);
        begin_path(&config, (double[CM1E_PATH_AXES]){0});
        cm1e_path_command_t command = command_of(0, 0, 0, CM1E_PATH_CORNER_DEVIATION, 0.01 * radius);
        const double corner[] = {2 * radius, 0}, end[] = {4 * radius, radius};
        TEST_ASSERT_EQUAL(CM1E_OK, cm1e_path_append_arc_centre(&driven.path, (double[]){radius, 0}, corner,
                                                               CM1E_PATH_COUNTER_CLOCKWISE, &command, NULL));
        command.tag = driven.next_tag++;
        TEST_ASSERT_EQUAL(CM1E_OK, cm1e_path_append_line(&driven.path, end, &command, NULL));
        double nearest = INFINITY;
        do {
            step_path();
            nearest = fmin(nearest, hypot(driven.now.position[0] - corner[0], driven.now.position[1]));
        } while (driven.now.phase != CM1E_PATH_IDLE);
        TEST_ASSERT_DOUBLE_WITHIN(0.025, 0.975, nearest / command.parameter);
    }
}

/** Powers of two, so that nothing is rounded otherwise. */
static double in_length, in_time;

static cm1e_path_command_t command_in_units(double velocity, double acceleration, double jerk,
                                            cm1e_path_junction_t junction)
{
    const double speed = in_length / in_time, change = speed / in_time;
    return command_of(velocity * speed, acceleration * change, jerk * change / in_time, junction, 0.1 * in_length);
}

/** Lines and arcs with corners and transitions, and runs with other limits. */
static void append_in_units(void)
{
    double x = 0, y = 0, heading = 0;
    for (int i = 0; i < SEGMENTS; i++) {
        static const cm1e_path_junction_t junctions[] = {CM1E_PATH_EXACT, CM1E_PATH_CORNER_DISTANCE,
                                                         CM1E_PATH_CORNER_DEVIATION, CM1E_PATH_CORNER_DEVIATION};
        const double radius = random_between(0.5, 20), turn = random_between(0.1, 2), length = random_decade(0.01, 20);
        const cm1e_path_command_t command = command_in_units(random_between(50, 300), random_between(500, 4000),
                                                             random_between(5000, 80000), junctions[random_bits() % 4]);
        if (one_in(3)) {
            const double centre[] = {x - radius * sin(heading), y + radius * cos(heading), 0};
            heading += turn;
            x = centre[0] + radius * sin(heading), y = centre[1] - radius * cos(heading);
            const double scaled[] = {centre[0] * in_length, centre[1] * in_length, 0};
            TEST_ASSERT_EQUAL(CM1E_OK, cm1e_path_append_arc_centre(
                                           &driven.path, scaled, (double[]){x * in_length, y * in_length, 0},
                                           CM1E_PATH_COUNTER_CLOCKWISE, &command, NULL));
            continue;
        }
        heading += one_in(3) ? 0 : random_between(-1.5, 1.5);
        x += length * cos(heading), y += length * sin(heading);
        TEST_ASSERT_EQUAL(CM1E_OK, cm1e_path_append_line(
                                       &driven.path, (double[]){x * in_length, y * in_length, 0}, &command, NULL));
    }
}

/** With stops on the way; the number of cycles. */
static int drive_in_units(void)
{
    const double speed = in_length / in_time, change = speed / in_time;
    cm1e_path_config_t config = plain_config(3, 3, 500 * speed, 3000 * change, 60000 * change / in_time);
    config.axis[1].acceleration /= 2;
    config.cycle_s = 1e-3 * in_time;
    begin_path(&config, (double[CM1E_PATH_AXES]){0});
    append_in_units();
    int steps = 0;
    do {
        cm1e_path_step(&driven.path, &driven.now);
        if (steps % 150 == 75)
            cm1e_path_stop(&driven.path, one_in(2) ? 0 : random_decade(300, 3000) * change,
                           one_in(2) ? 0 : random_decade(3000, 90000) * change / in_time);
        if (driven.now.phase == CM1E_PATH_STOPPED)
            cm1e_path_go_on(&driven.path);
        TEST_ASSERT_LESS_THAN_INT(PARTS, ++steps);
    } while (driven.now.phase != CM1E_PATH_IDLE);
    return steps;
}

/** To within a hundredth: cbrt() rounds small numbers otherwise, and then two stops may change places that take as
 *  long. */
static void test_no_path_depends_on_the_units_of_length_and_time(void)
{
    static const double units[][2] = {{1, 1}, {0x1p-18, 1}, {0x1p18, 1}, {1, 0x1p6}, {0x1p-12, 0x1p-6}};
    for (int path = 0; path < PATHS; path++) {
        const uint64_t state = random_state;
        int steps = 0;
        for (size_t k = 0; k < sizeof units / sizeof units[0]; k++) {
            random_state = state;
            in_length = units[k][0], in_time = units[k][1];
            const int took = drive_in_units();
            steps = k ? steps : took;
            TEST_ASSERT_INT_WITHIN(steps / 100, steps, took);
        }
    }
}

int main(void)
{
    seed_random();
    UNITY_BEGIN();
    RUN_TEST(test_long_lines_and_corners);
    RUN_TEST(test_short_lines_and_corners);
    RUN_TEST(test_short_lines_that_hardly_turn);
    RUN_TEST(test_lines_and_arcs);
    RUN_TEST(test_a_piece_with_other_limits_costs_what_it_must);
    RUN_TEST(test_lines_with_other_limits_take_hardly_longer_than_the_better_of_two_ways);
    RUN_TEST(test_a_stop_on_a_circle_brakes_harder_the_slower_it_is);
    RUN_TEST(test_stops_in_bends_take_little_longer_than_on_a_line);
    RUN_TEST(test_stops_of_many_stages_take_little_longer_than_on_a_line);
    RUN_TEST(test_what_is_appended_does_not_slow_the_run_under_way);
    RUN_TEST(test_next_to_a_break_of_the_tangent_the_acceleration_is_lower);
    RUN_TEST(test_a_transition_at_an_arc_uses_its_deviation);
    RUN_TEST(test_no_path_depends_on_the_units_of_length_and_time);
    return UNITY_END();
}
