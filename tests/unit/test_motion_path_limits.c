/* What the limits of the axes allow along a piece, against what the axes then have at many points of it. */
#include <string.h>

#include "motion/path_piece.h"
#include "motion_check.h"

enum { TRIALS = 2000, POINTS = 600, AXES = 4 };

static const cm1e_path_frame_t FRAME = {AXES, 3};
static const cm1e_path_share_t ALL = {1, 1};
static const cm1e_motion_limits_t UNLIMITED = {INFINITY, INFINITY, INFINITY, INFINITY};

/** Curves that turn nearly back change their bend so fast that a few lines of them are off by more than this. */
static const double BACK = -0.8, OVER = 1 + 1e-3;

/** What is left of the limits where it could be used, by the allowance between points and by the search. */
static const double USED = 0.97;

static cm1e_path_config_t config;
static cm1e_path_piece_t piece;
static double most_acceleration, most_jerk; /* of any axis, in parts of its limit */

void setUp(void)
{
    config = (cm1e_path_config_t){.axes = AXES, .space = 3, .cycle_s = 1e-3};
}

void tearDown(void) {}

static void at_most(double most, double value) { TEST_ASSERT_DOUBLE_WITHIN(most / 2, most / 2, value); }

static void random_axes(void)
{
    for (int i = 0; i < AXES; i++)
        config.axis[i] = (cm1e_path_axis_t){random_decade(0.3, 30), random_decade(0.3, 30), random_decade(0.3, 30),
                                            -INFINITY, INFINITY};
}

static void random_point(double *point)
{
    for (int i = 0; i < AXES; i++)
        point[i] = random_between(-1, 1);
}

static bool random_segment(cm1e_path_piece_t *segment, const double *from, const double *to)
{
    double border[CM1E_PATH_AXES] = {0};
    random_point(border);
    if (one_in(2))
        return cm1e_path_make_border_arc(segment, &FRAME, from, border, to);
    cm1e_path_make_line(segment, &FRAME, from, to);
    return true;
}

static double half_of(const cm1e_path_piece_t *segment)
{
    return segment->kind == CM1E_PATH_ARC ? fmin(segment->length / 2, 0.7 * segment->radius) : segment->length / 2;
}

static bool random_curve(void)
{
    double points[3][CM1E_PATH_AXES] = {{0}};
    cm1e_path_piece_t before = {0}, after = {0};
    cm1e_path_point_t end, begin;
    for (int i = 0; i < 3; i++)
        random_point(points[i]);
    if (!random_segment(&before, points[0], points[1]) || !random_segment(&after, points[1], points[2]))
        return false;
    cm1e_path_point_at(&before, AXES, before.length, &end);
    cm1e_path_point_at(&after, AXES, 0, &begin);
    double cosine = 0;
    for (int i = 0; i < FRAME.space; i++)
        cosine += end.tangent[i] * begin.tangent[i];
    const double reach = fmin(half_of(&before), half_of(&after)) * (one_in(2) ? 1 : random_decade(0.01, 1));
    if (cosine < BACK)
        return false;
    cm1e_path_make_curve(&piece, &FRAME, &before, reach, &after, reach);
    return true;
}

static bool random_arc(void)
{
    double points[3][CM1E_PATH_AXES] = {{0}};
    for (int i = 0; i < 3; i++)
        random_point(points[i]);
    memset(&piece, 0, sizeof piece);
    return cm1e_path_make_border_arc(&piece, &FRAME, points[0], points[1], points[2]);
}

/** What the axes have somewhere on the curve, with that much along the path, in either direction. */
static void see_on_curve(double velocity, double acceleration, double jerk)
{
    most_acceleration = most_jerk = 0;
    for (int k = 0; k <= POINTS; k++) {
        double by_length[3][CM1E_PATH_AXES] = {{0}};
        cm1e_path_curve_derivatives(&piece, AXES, (double)k / POINTS, by_length);
        for (int i = 0; i < AXES; i++) {
            const double square = velocity * velocity, turned = 3 * by_length[1][i] * velocity * acceleration;
            const double pushed = by_length[0][i] * jerk, bent = by_length[2][i] * square * velocity;
            most_acceleration = fmax(most_acceleration, (fabs(by_length[1][i] * square) +
                                                         fabs(by_length[0][i] * acceleration)) /
                                                            config.axis[i].acceleration);
            most_jerk = fmax(most_jerk, (fabs(pushed) + fabs(turned) + fabs(bent)) / config.axis[i].jerk);
        }
    }
}

static void test_in_a_transition_every_axis_keeps_its_limits_between_the_points_too(void)
{
    int full = 0, curves = 0;
    for (int trial = 0; trial < TRIALS; trial++) {
        cm1e_path_allowance_t allowance;
        random_axes();
        if (!random_curve())
            continue;
        cm1e_path_allow(&allowance, &piece, &config, &ALL, &UNLIMITED);
        see_on_curve(allowance.highest, allowance.limits.acceleration, allowance.limits.jerk);
        at_most(OVER, most_acceleration);
        at_most(OVER, most_jerk);
        curves++;
        full += most_acceleration > USED || most_jerk > USED;
    }
    TEST_ASSERT_GREATER_THAN_INT(TRIALS / 2, curves);
    TEST_ASSERT_GREATER_THAN_INT(curves * 9 / 10, full);
}

static void check_brake(const cm1e_path_brake_t *brake, void (*see)(double, double, double), int *full, int *levels)
{
    for (int level = 0; level < CM1E_PATH_LEVELS; level++)
        for (int w = 0; w < CM1E_PATH_BRAKES; w++) {
            const double share = brake->share[level] * cm1e_path_part(w);
            if (share == 0) /* the bend leaves nothing, so there is no jerk either */
                continue;
            see(cm1e_path_level(brake, level), share * brake->deceleration, brake->jerk_share[w][level] * brake->jerk);
            at_most(OVER, most_acceleration);
            at_most(OVER, most_jerk);
            *full += most_acceleration > USED || most_jerk > USED;
            ++*levels;
        }
}

static void test_a_stop_in_a_transition_takes_what_the_bend_leaves(void)
{
    int full = 0, levels = 0;
    for (int trial = 0; trial < TRIALS / 5; trial++) {
        cm1e_path_allowance_t allowance;
        random_axes();
        if (!random_curve())
            continue;
        cm1e_path_allow(&allowance, &piece, &config, &ALL, &UNLIMITED);
        check_brake(&allowance.brake, see_on_curve, &full, &levels);
    }
    TEST_ASSERT_GREATER_THAN_INT(levels * 8 / 10, full);
}

/** The terms along a circle and across it reach their maxima in different places, so the root of their squares
 *  counts. */
static void see_on_arc(double velocity, double acceleration, double jerk)
{
    most_acceleration = most_jerk = 0;
    for (int i = 0; i < AXES; i++) {
        const double round = i < FRAME.space ? hypot(piece.u[0][i], piece.v[0][i]) : 0, turn = velocity / piece.radius;
        const double first = round + fabs(piece.direction[i]);
        most_acceleration = fmax(most_acceleration, hypot(first * acceleration, round * turn * velocity) /
                                                        config.axis[i].acceleration);
        most_jerk = fmax(most_jerk, hypot(first * jerk + round * turn * turn * velocity,
                                          3 * round * turn * acceleration) / config.axis[i].jerk);
    }
}

static void test_on_an_arc_every_axis_keeps_its_limits(void)
{
    int full = 0, levels = 0;
    for (int trial = 0; trial < TRIALS / 5; trial++) {
        cm1e_path_allowance_t allowance;
        random_axes();
        if (!random_arc())
            continue;
        cm1e_path_allow(&allowance, &piece, &config, &ALL, &UNLIMITED);
        see_on_arc(allowance.highest, allowance.limits.acceleration, allowance.limits.jerk);
        at_most(1 + 1e-6, most_acceleration);
        at_most(1 + 1e-6, most_jerk);
        double fastest = 0;
        for (int i = 0; i < AXES; i++) {
            const double round = i < FRAME.space ? hypot(piece.u[0][i], piece.v[0][i]) : 0;
            fastest = fmax(fastest, (round + fabs(piece.direction[i])) * allowance.highest / config.axis[i].velocity);
        }
        at_most(1 + 1e-6, fastest);
        TEST_ASSERT_TRUE(fmax(fastest, fmax(most_acceleration, most_jerk)) > USED);
        check_brake(&allowance.brake, see_on_arc, &full, &levels);
    }
    TEST_ASSERT_GREATER_THAN_INT(levels * 8 / 10, full);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_in_a_transition_every_axis_keeps_its_limits_between_the_points_too);
    RUN_TEST(test_a_stop_in_a_transition_takes_what_the_bend_leaves);
    RUN_TEST(test_on_an_arc_every_axis_keeps_its_limits);
    return UNITY_END();
}
