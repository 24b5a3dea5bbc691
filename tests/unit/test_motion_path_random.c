/* Random paths: every sample keeps the programmed geometry, the limits of the axes and those of the commands. */
#include "motion/path_private.h"
#include "path_check.h"

enum { PATHS = 80, SEGMENTS_MAX = 24 };

/** What was programmed, reckoned apart from the code under test. */
typedef struct {
    bool arc;
    double from[CM1E_PATH_AXES], to[CM1E_PATH_AXES];
    double centre[3], normal[3], radius;
    double length, reach; /**< how far from its ends a transition may be */
    cm1e_path_command_t command;
} shape_t;

static shape_t shape[SEGMENTS_MAX + 1];
static int shape_count, axes, space;

void setUp(void) {}
void tearDown(void) {}

static double distance_between(const double *a, const double *b, int count)
{
    double square = 0;
    for (int i = 0; i < count; i++)
        square += (a[i] - b[i]) * (a[i] - b[i]);
    return sqrt(square);
}

static bool is_spatial(const shape_t *s) { return distance_between(s->from, s->to, space) > 0 || s->arc; }

static double shape_length(const shape_t *s)
{
    return distance_between(s->from, s->to, is_spatial(s) ? space : axes);
}

static double distance_from_line(const shape_t *s, const double *p, int count)
{
    double along = 0, square = 0, length = distance_between(s->from, s->to, count);
    if (length == 0)
        return distance_between(s->from, p, count);
    for (int i = 0; i < count; i++)
        along += (p[i] - s->from[i]) * (s->to[i] - s->from[i]) / length;
    along = fmin(fmax(along, 0), length);
    for (int i = 0; i < count; i++) {
        const double d = p[i] - s->from[i] - along * (s->to[i] - s->from[i]) / length;
        square += d * d;
    }
    return sqrt(square);
}

static double distance_from_arc(const shape_t *s, const double *p)
{
    double height = 0, square = 0;
    for (int i = 0; i < space; i++) {
        height += (p[i] - s->centre[i]) * s->normal[i];
        square += (p[i] - s->centre[i]) * (p[i] - s->centre[i]);
    }
    return hypot(sqrt(fmax(0, square - height * height)) - s->radius, height);
}

/** Over so many axes. */
static double distance_from(const shape_t *s, const double *p, int count)
{
    return s->arc ? distance_from_arc(s, p) : distance_from_line(s, p, count);
}

static cm1e_path_config_t random_config(void)
{
    axes = 2 + (int)(random_bits() % 7);
    space = axes < 3 || one_in(4) ? 2 : 3;
    cm1e_path_config_t config = {.axes = axes, .space = space, .cycle_s = one_in(3) ? 2.5e-4 : 1e-3};
    for (int i = 0; i < axes; i++) {
        const double v = random_decade(30, 1000), a = v * random_decade(2, 30);
        config.axis[i] = (cm1e_path_axis_t){v, a, a * random_decade(5, 100), -INFINITY, INFINITY};
    }
    return config;
}

static cm1e_path_command_t random_command(void)
{
    cm1e_path_command_t command = {.tag = driven.next_tag++};
    command.limits.velocity = one_in(4) ? 0 : random_decade(20, 500);
    command.limits.acceleration = one_in(3) ? 0 : random_decade(50, 5000);
    command.limits.deceleration = one_in(3) ? 0 : random_decade(50, 5000);
    command.limits.jerk = one_in(3) ? 0 : random_decade(1000, 100000);
    command.junction = (cm1e_path_junction_t)(random_bits() % 4);
    command.blend = (cm1e_path_blend_t)(random_bits() % 4);
    command.parameter = random_decade(0.01, 5);
    return command;
}

static void random_line(shape_t *s, const double *direction_before)
{
    const double size = one_in(6) ? random_decade(1e-6, 1e-2) : one_in(12) ? 300 : random_decade(0.1, 100);
    s->arc = false;
    for (int i = 0; i < axes; i++) {
        double d = random_between(-1, 1);
        if (one_in(3))
            d = 0;
        s->to[i] = s->from[i] + size * d;
    }
    if (direction_before && one_in(3)) /* straight on */
        for (int i = 0; i < axes; i++)
            s->to[i] = s->from[i] + size * direction_before[i];
    if (direction_before && one_in(12)) /* nearly back */
        for (int i = 0; i < axes; i++)
            s->to[i] = s->from[i] - size * direction_before[i] * random_between(0.999, 1);
    if (one_in(30))
        memcpy(s->to, s->from, sizeof s->to);
}

/** A circle through `from` with a random plane. */
static bool random_arc(shape_t *s, double border[3], bool *by_centre, cm1e_path_way_t *way)
{
    double u[3] = {0}, v[3] = {0};
    const double radius = one_in(5) ? random_decade(100, 1e5) : random_decade(0.5, 50);
    double angle = random_between(0.05, 6.2);
    if (radius > 100)
        angle = random_between(1, 100) / radius;
    const double turn = random_between(0, 6.28);
    u[0] = cos(turn), u[1] = sin(turn);
    v[0] = -sin(turn), v[1] = cos(turn);
    if (space == 3 && one_in(2)) {
        const double tilt = random_between(-1.5, 1.5);
        v[0] *= cos(tilt), v[1] *= cos(tilt), v[2] = sin(tilt);
    }
    *by_centre = one_in(2);
    if (*by_centre && one_in(3) && v[2] == 0 && radius <= 100)
        angle = 6.283185307179586;
    s->arc = true;
    s->radius = radius;
    for (int i = 0; i < space; i++) {
        s->centre[i] = s->from[i] - radius * u[i];
        s->to[i] = angle > 6.28 ? s->from[i] : s->centre[i] + radius * (u[i] * cos(angle) + v[i] * sin(angle));
        border[i] = s->centre[i] + radius * (u[i] * cos(angle / 2) + v[i] * sin(angle / 2));
    }
    s->normal[0] = u[1] * v[2] - u[2] * v[1];
    s->normal[1] = u[2] * v[0] - u[0] * v[2];
    s->normal[2] = u[0] * v[1] - u[1] * v[0];
    *way = s->normal[2] > 0 ? CM1E_PATH_COUNTER_CLOCKWISE : CM1E_PATH_CLOCKWISE;
    for (int i = space; i < axes; i++)
        s->to[i] = s->from[i] + random_between(-20, 20);
    s->length = radius * angle;
    return fabs(angle - 3.14159) > 0.03; /* a tilted half circle has no plane by its centre */
}

static void append_random(void)
{
    shape_t *s = &shape[shape_count], *before = shape_count ? &shape[shape_count - 1] : NULL;
    double border[3], direction[CM1E_PATH_AXES];
    bool by_centre;
    cm1e_path_way_t way;
    if (before)
        memcpy(s->from, before->to, sizeof s->from);
    s->command = random_command();
    cm1e_path_problem_t problem;
    cm1e_error_t error;
    if (one_in(3) && random_arc(s, border, &by_centre, &way)) {
        error = by_centre ? cm1e_path_append_arc_centre(&driven.path, s->centre, s->to, way, &s->command, &problem)
                          : cm1e_path_append_arc_border(&driven.path, border, s->to, &s->command, &problem);
    } else {
        const bool straight_on = before && !before->arc && before->length > 0;
        for (int i = 0; straight_on && i < axes; i++)
            direction[i] = (before->to[i] - before->from[i]) / before->length;
        random_line(s, straight_on ? direction : NULL);
        s->length = shape_length(s);
        error = cm1e_path_append_line(&driven.path, s->to, &s->command, &problem);
    }
    TEST_ASSERT_EQUAL(CM1E_OK, error);
    shape_count++;
}

static void check_sample(void)
{
    if (driven.now.active == 0)
        return;
    const int index = (int)driven.now.active - 1;
    const shape_t *s = &shape[index];
    const double *p = driven.now.position;
    double whole = 0;
    for (int i = 0; i < axes; i++)
        whole = fmax(whole, fabs(p[i]));
    const double tolerance = 1e-9 * s->length + 1e-13 * whole + 1e-15 * (s->arc ? s->radius : 0);
    double distance = distance_from(s, p, axes);
    if (distance <= tolerance)
        return;
    const bool transition = s->command.junction >= CM1E_PATH_CORNER_DISTANCE && index > 0;
    CHECK_PATH(transition);
    /* In space; where nothing moves there, and with a tolerance for every further axis, of all. */
    const bool spatial = is_spatial(s);
    const int count = spatial ? space : axes;
    distance = fmin(distance_from(s, p, count), distance_from(&shape[index - 1], p, count));
    CHECK_PATH(distance <= s->command.parameter * (spatial ? 1 : sqrt(axes)));
}

/** The limits of the command along the path; a segment is entered with the velocity of the one before. One that was
 *  appended too late to be entered as slowly as it says is braked in as soon as that can be (path.h). */
static void check_command(bool at_once)
{
    if (driven.now.active == 0 || driven.before.active == 0)
        return;
    double velocity = 0, acceleration = 0, jerk = 0;
    for (uint32_t tag = driven.before.active; tag <= driven.now.active; tag++) {
        const cm1e_motion_limits_t *limits = &shape[tag - 1].command.limits;
        velocity = fmax(velocity, limits->velocity ? limits->velocity : INFINITY);
        acceleration = fmax(acceleration, limits->acceleration ? limits->acceleration : INFINITY);
        acceleration = fmax(acceleration, limits->deceleration ? limits->deceleration : INFINITY);
        jerk = fmax(jerk, limits->jerk ? limits->jerk : INFINITY);
    }
    const cm1e_path_command_t *command = &shape[driven.now.active - 1].command;
    const double a = fabs(driven.now.path_acceleration);
    const double step = fabs(driven.now.path_acceleration - driven.before.path_acceleration);
    if (driven.now.active > 1 && command->junction != CM1E_PATH_STOP && command->blend != CM1E_PATH_BLEND_LOW)
        velocity = INFINITY;
    if ((int)driven.now.active < shape_count && shape[driven.now.active].command.blend != CM1E_PATH_BLEND_LOW)
        velocity = INFINITY;
    const bool braked_in = !at_once && driven.now.path_acceleration < 0;
    CHECK_PATH(driven.now.path_velocity <= velocity * (1 + 1e-9) || braked_in);
    CHECK_PATH(a <= acceleration * (1 + 1e-9));
    CHECK_PATH(step <= jerk * driven.path.config.cycle_s * (1 + 1e-6) + 1e-9 * a);
}

/** Samples after which it has to be at its end, whatever was done to it meanwhile: twice what all segments take at the
 *  velocities of axes and commands (an axis beside the path may have a way of an hour), and time to start and stop. */
static long samples_at_most(void)
{
    double time_s = 0;
    for (int k = 0; k < shape_count; k++) {
        const shape_t *s = &shape[k];
        const double velocity = s->command.limits.velocity;
        double slowest_s = velocity > 0 ? s->length / velocity : 0;
        for (int i = 0; i < axes; i++) {
            const double way = s->arc && i < space ? s->length : fabs(s->to[i] - s->from[i]);
            slowest_s = fmax(slowest_s, way / driven.path.config.axis[i].velocity);
        }
        time_s += slowest_s;
    }
    return 3000000 + (long)(2 * time_s / driven.path.config.cycle_s);
}

static void drive_one(bool at_once)
{
    const cm1e_path_config_t config = random_config();
    const double origin[CM1E_PATH_AXES] = {0};
    begin_path(&config, origin);
    memset(shape, 0, sizeof shape);
    shape_count = 0;
    const int count = 2 + (int)(random_bits() % (SEGMENTS_MAX - 2));
    if (at_once)
        while (shape_count < count)
            append_random();
    else
        append_random();
    long most = samples_at_most();
    for (long i = 0; i < most; i++) {
        const int shapes = shape_count;
        if (!at_once && shape_count < count && one_in(100))
            append_random();
        step_path();
        check_sample();
        check_command(at_once);
        if (driven.now.phase == CM1E_PATH_IDLE) {
            if (shape_count == count)
                break;
            append_random();
        }
        if (shape_count > shapes)
            most = samples_at_most();
    }
    CHECK_PATH(driven.now.phase == CM1E_PATH_IDLE);
    TEST_ASSERT_EQUAL_UINT32((uint32_t)count + 1, driven.done_tag);
    for (int i = 0; i < axes; i++)
        TEST_ASSERT_EQUAL_DOUBLE(shape[count - 1].to[i], driven.now.position[i]);
}

static void test_paths_that_are_appended_at_once(void)
{
    for (int i = 0; i < PATHS; i++)
        drive_one(true);
}

static void test_paths_that_are_appended_on_the_way(void)
{
    for (int i = 0; i < PATHS; i++)
        drive_one(false);
}

/** Whatever is left ends with the motion under way, or as soon as it can stop with the lowest limits that are left. */
static void check_cut(void)
{
    cm1e_path_t *path = &driven.path;
    double v = path->profile.end.velocity, deceleration = INFINITY, jerk = INFINITY;
    for (int i = 0; i < path->element_count; i++) {
        const cm1e_path_element_t *element = cm1e_path_element(path, i);
        v = i > 0 ? fmax(v, element->hard_entry) : v;
        deceleration = fmin(deceleration, element->limits.deceleration);
        jerk = fmin(jerk, element->limits.jerk);
    }
    const double way = v / 2 * (v / deceleration + deceleration / jerk) + v * sqrt(v / jerk);
    CHECK_PATH(path->element_count == 0 ||
               cm1e_path_left(path) <= (path->profile.end.position - path->along.position + way) * (1 + 1e-6));
}

/** Whatever the owner does, the path is kept, and nothing steps. */
static void stop_slow_and_cut(int paths)
{
    for (int k = 0; k < paths; k++) {
        const cm1e_path_config_t config = random_config();
        const double origin[CM1E_PATH_AXES] = {0};
        begin_path(&config, origin);
        memset(shape, 0, sizeof shape);
        shape_count = 0;
        append_random();
        bool stopped = false;
        for (long i = 0; i < 20000; i++) {
            if (shape_count < SEGMENTS_MAX && one_in(100))
                append_random();
            if (one_in(300)) {
                cm1e_path_stop(&driven.path, one_in(3) ? 0 : random_decade(10, 10000),
                               one_in(3) ? 0 : random_decade(100, 1e6));
                stopped = true;
            }
            if (stopped && one_in(200)) {
                cm1e_path_go_on(&driven.path);
                stopped = false;
            }
            if (one_in(500))
                cm1e_path_override(&driven.path, one_in(4) ? 0 : one_in(3) ? 1 : random_between(0, 1.5));
            if (one_in(1000)) {
                cm1e_path_clear(&driven.path);
                check_cut();
                break;
            }
            step_path();
            check_sample();
        }
        cm1e_path_override(&driven.path, 1);
        cm1e_path_go_on(&driven.path);
        double end[CM1E_PATH_AXES];
        cm1e_path_end(&driven.path, end);
        long left = samples_at_most();
        do {
            step_path();
            check_sample();
        } while (driven.now.phase != CM1E_PATH_IDLE && left-- > 0);
        CHECK_PATH(driven.now.phase == CM1E_PATH_IDLE);
        for (int i = 0; i < axes; i++)
            TEST_ASSERT_EQUAL_DOUBLE(end[i], driven.now.position[i]);
        TEST_ASSERT_EQUAL(0, driven.path.segment_count);
    }
}

static void test_paths_that_are_stopped_slowed_and_cut(void) { stop_slow_and_cut(PATHS); }

/** Most cannot stop any more before a run with other limits; the last one is cut off in its last segment. */
static void test_paths_that_are_cut_where_they_cannot_stop_on_the_run(void)
{
    static const uint64_t states[] = {12446217520451855312u, 11307107647782443808u, 5419314360734579674u,
                                      5236463589177559819u, 275665088565781429u, 17530126831957359872u};
    for (size_t i = 0; i < sizeof states / sizeof states[0]; i++) {
        random_state = states[i];
        stop_slow_and_cut(1);
    }
}

static void begin_too_fast(int paths)
{
    for (int k = 0; k < paths; k++) {
        const cm1e_path_config_t config = random_config();
        begin_path(&config, (double[CM1E_PATH_AXES]){0});
        memset(shape, 0, sizeof shape);
        shape_count = 0;
        while (shape_count < SEGMENTS_MAX)
            append_random();
        const double excess = one_in(2) ? random_decade(1e-10, 1e-8) : random_decade(1e-8, 0.3);
        bool excessive = false;
        cm1e_path_t *path = &driven.path;
        step_path();
        for (long i = samples_at_most(); i > 0 && driven.now.phase != CM1E_PATH_IDLE; i--) {
            if (path->time_s + config.cycle_s >= path->profile.duration_s && path->profile.end.velocity > 0 && one_in(2)) {
                path->profile.end.velocity *= 1 + excess;
                excessive = true;
            }
            if (!excessive) {
                step_path();
            } else {
                driven.before = driven.now;
                cm1e_path_step(path, &driven.now);
            }
            check_sample();
            CHECK_PATH(driven.now.path_velocity >= -1e-6);
            for (int n = 0; n < axes; n++) {
                const cm1e_path_axis_t *axis = &config.axis[n];
                const double way = fabs(driven.now.position[n] - driven.before.position[n]);
                CHECK_PATH(way <= axis->velocity * config.cycle_s * 1.5 + 1e-12);
                CHECK_PATH(excess > 1e-8 || fabs(driven.now.acceleration[n]) <= axis->acceleration * (1 + 1e-4));
            }
        }
        CHECK_PATH(driven.now.phase == CM1E_PATH_IDLE);
        for (int i = 0; i < axes; i++)
            TEST_ASSERT_EQUAL_DOUBLE(shape[SEGMENTS_MAX - 1].to[i], driven.now.position[i]);
    }
}

/** No plan is known that begins a run faster than it may be begun, but for rounding. Should there be one, the path is kept
 *  all the same: never back, never past its end, and with the limits of the axes as far as that is possible. */
static void test_a_run_that_is_begun_too_fast_is_braked_in_on_the_path(void) { begin_too_fast(PATHS); }

/** Some can only come down from their velocity over more than themselves. */
static void test_a_run_that_is_begun_too_fast_is_braked_in_over_more_than_one(void)
{
    random_state = 345;
    begin_too_fast(1);
}

/** Two transitions may leave nothing of a segment: nothing to brake in there. */
static void test_a_segment_without_length_that_is_begun_too_fast_is_passed(void)
{
    random_state = 13163837031273866584u;
    begin_too_fast(1);
}

static void run_tests(void)
{
    RUN_TEST(test_paths_that_are_appended_at_once);
    RUN_TEST(test_paths_that_are_appended_on_the_way);
    RUN_TEST(test_paths_that_are_stopped_slowed_and_cut);
    RUN_TEST(test_paths_that_are_cut_where_they_cannot_stop_on_the_run);
    RUN_TEST(test_a_run_that_is_begun_too_fast_is_braked_in_on_the_path);
    RUN_TEST(test_a_run_that_is_begun_too_fast_is_braked_in_over_more_than_one);
    RUN_TEST(test_a_segment_without_length_that_is_begun_too_fast_is_passed);
}

int main(void)
{
    UNITY_BEGIN();
    run_seeds(run_tests);
    return UNITY_END();
}
