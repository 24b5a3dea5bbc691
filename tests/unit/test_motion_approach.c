/* The curve of degree 5, what it asks of a slave, and which turn of a modulo slave it goes to. */
#include "motion/approach.h"
#include "motion_check.h"

enum { CURVES = 20000, DENSE = 500 };

void setUp(void) {}
void tearDown(void) {}

static cm1e_curve_point_t random_point(double size, double length)
{
    return (cm1e_curve_point_t){size * random_between(-1, 1), one_in(4) ? 0 : size / length * random_between(-1, 1),
                                one_in(3) ? 0 : size / length / length * random_between(-1, 1), 0};
}

static void test_a_curve_meets_both_ends_in_either_order(void)
{
    for (int n = 0; n < CURVES; n++) {
        const double from = random_between(-1, 1) * random_decade(1, 1e6), length = random_decade(1e-2, 1e5);
        const double size = random_decade(1e-2, 1e5), to = one_in(2) ? from + length : from - length;
        const cm1e_curve_point_t first = random_point(size, length), last = random_point(size, length);
        cm1e_curve_t curve;
        TEST_ASSERT_TRUE(cm1e_curve_between(&curve, from, &first, to, &last));
        TEST_ASSERT_TRUE(curve.from == fmin(from, to));
        const cm1e_curve_point_t ends[] = {cm1e_curve_at(&curve, from), cm1e_curve_at(&curve, to)};
        for (int i = 0; i < 2; i++) {
            const cm1e_curve_point_t *wanted = i ? &last : &first;
            TEST_ASSERT_DOUBLE_WITHIN(1e-11 * size, wanted->position, ends[i].position);
            TEST_ASSERT_DOUBLE_WITHIN(1e-9 * size / length, wanted->slope, ends[i].slope);
            TEST_ASSERT_DOUBLE_WITHIN(1e-7 * size / length / length, wanted->curvature, ends[i].curvature);
        }
    }
}

/* Slope, curvature and third derivative are those of the position. */
static void test_derivatives_are_differences(void)
{
    const cm1e_curve_point_t first = {1, 2, -3, 0}, last = {5, -1, 4, 0};
    cm1e_curve_t curve;
    TEST_ASSERT_TRUE(cm1e_curve_between(&curve, 10, &first, 12, &last));
    for (int i = 0; i <= 100; i++) {
        const double x = 10 + 0.02 * i, d = 1e-5;
        const cm1e_curve_point_t before = cm1e_curve_at(&curve, x - d), here = cm1e_curve_at(&curve, x);
        const cm1e_curve_point_t behind = cm1e_curve_at(&curve, x + d);
        TEST_ASSERT_DOUBLE_WITHIN(1e-7, (behind.position - before.position) / (2 * d), here.slope);
        TEST_ASSERT_DOUBLE_WITHIN(1e-7, (behind.slope - before.slope) / (2 * d), here.curvature);
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, (behind.curvature - before.curvature) / (2 * d), here.third);
    }
}

static void test_extremes_are_those_of_dense_samples(void)
{
    for (int n = 0; n < CURVES / 10; n++) {
        const double length = random_decade(1e-2, 1e4), size = random_decade(1e-2, 1e4);
        const cm1e_curve_point_t first = random_point(size, length), last = random_point(size, length);
        cm1e_curve_t curve;
        cm1e_curve_extremes_t e, seen = {INFINITY, -INFINITY, INFINITY, -INFINITY, 0, 0};
        TEST_ASSERT_TRUE(cm1e_curve_between(&curve, -3, &first, length - 3, &last));
        cm1e_curve_extremes(&curve, &e);
        for (int i = 0; i <= DENSE; i++) {
            const cm1e_curve_point_t here = cm1e_curve_at(&curve, -3 + length * i / DENSE);
            seen.lowest = fmin(seen.lowest, here.position);
            seen.highest = fmax(seen.highest, here.position);
            seen.least_slope = fmin(seen.least_slope, here.slope);
            seen.most_slope = fmax(seen.most_slope, here.slope);
            seen.curvature = fmax(seen.curvature, fabs(here.curvature));
            seen.third = fmax(seen.third, fabs(here.third));
        }
        /* Between two samples a parabola rises by an eighth of its bend; the fifth power is never steeper than this. */
        const double near = 1e-3, none = 1e-9;
        const double slopes = size / length, bends = slopes / length, thirds = bends / length;
        TEST_ASSERT_TRUE(seen.lowest >= e.lowest - none * size && seen.lowest <= e.lowest + near * size);
        TEST_ASSERT_TRUE(seen.highest <= e.highest + none * size && seen.highest >= e.highest - near * size);
        TEST_ASSERT_TRUE(seen.least_slope >= e.least_slope - none * slopes &&
                         seen.least_slope <= e.least_slope + near * slopes);
        TEST_ASSERT_TRUE(seen.most_slope <= e.most_slope + none * slopes &&
                         seen.most_slope >= e.most_slope - near * slopes);
        TEST_ASSERT_TRUE(seen.curvature <= e.curvature + 1e-7 * bends &&
                         seen.curvature >= e.curvature - 10 * near * bends);
        TEST_ASSERT_TRUE(seen.third <= e.third + 1e-7 * thirds && seen.third >= e.third - 100 * near * thirds);
    }
}

/* Known ones: the slope is 15/8 of the mean one, the curvature 10/sqrt(3), the third derivative 60. */
static void test_from_rest_to_rest(void)
{
    const cm1e_curve_point_t first = {0}, last = {100, 0, 0, 0};
    cm1e_curve_t curve;
    cm1e_curve_extremes_t e;
    cm1e_motion_limits_t demand;
    TEST_ASSERT_TRUE(cm1e_curve_between(&curve, 50, &first, 0, &last)); /* the master goes backwards */
    cm1e_curve_extremes(&curve, &e);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0, e.lowest);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 100, e.highest);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, -15.0 / 8 * 2, e.least_slope);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0, e.most_slope);
    cm1e_approach_demand(&e, -10, &demand);
    TEST_ASSERT_DOUBLE_WITHIN(1e-8, 37.5, demand.velocity);
    TEST_ASSERT_DOUBLE_WITHIN(1e-8, 10 / sqrt(3) * 100 / 2500 * 100, demand.acceleration);
    TEST_ASSERT_EQUAL_DOUBLE(demand.acceleration, demand.deceleration);
    TEST_ASSERT_DOUBLE_WITHIN(1e-8, 60.0 * 100 / 125000 * 1000, demand.jerk);
}

/* A slave along a curve, its master in any motion: velocity, acceleration and jerk are those of its position, and the
 * point is found again from the motion. */
static void test_the_motion_of_a_slave(void)
{
    const cm1e_curve_point_t first = {0, 0.5, 0, 0}, last = {40, 2, 0, 0};
    cm1e_curve_t curve;
    TEST_ASSERT_TRUE(cm1e_curve_between(&curve, 0, &first, 30, &last));
    for (int i = 0; i < 1000; i++) {
        const double t = 1 + 0.001 * i, d = 1e-5;
        double position[3], velocity[3], acceleration[3];
        cm1e_motion_state_t slave = {0};
        cm1e_curve_point_t here = {0};
        for (int k = 0; k < 3; k++) { /* master: 3 + 5 t + 2 sin t */
            const double s = t + (k - 1) * d, v = 5 + 2 * cos(s), a = -2 * sin(s);
            const cm1e_curve_point_t point = cm1e_curve_at(&curve, 3 + 5 * s + 2 * sin(s));
            const cm1e_motion_state_t motion = cm1e_curve_motion(&point, v, a);
            position[k] = motion.position;
            velocity[k] = motion.velocity;
            acceleration[k] = motion.acceleration;
            if (k == 1) {
                slave = motion;
                here = point;
            }
        }
        const double v = 5 + 2 * cos(t), a = -2 * sin(t), j = -2 * cos(t);
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, (position[2] - position[0]) / (2 * d), velocity[1]);
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, (velocity[2] - velocity[0]) / (2 * d), acceleration[1]);
        TEST_ASSERT_DOUBLE_WITHIN(1e-5, (acceleration[2] - acceleration[0]) / (2 * d), cm1e_curve_jerk(&here, v, a, j));
        cm1e_curve_point_t found;
        TEST_ASSERT_TRUE(cm1e_curve_point_of(&found, &slave, v, a));
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, here.slope, found.slope);
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, here.curvature, found.curvature);
    }
}

static void test_a_point_of_a_slave_whose_master_stands(void)
{
    cm1e_curve_point_t point;
    TEST_ASSERT_TRUE(cm1e_curve_point_of(&point, &(cm1e_motion_state_t){7, 0, 0}, 0, 0));
    TEST_ASSERT_EQUAL_DOUBLE(7, point.position);
    TEST_ASSERT_EQUAL_DOUBLE(0, point.slope);
    TEST_ASSERT_FALSE(cm1e_curve_point_of(&point, &(cm1e_motion_state_t){7, 1, 0}, 0, 0));
    TEST_ASSERT_FALSE(cm1e_curve_point_of(&point, &(cm1e_motion_state_t){7, 0, 1}, 0, 0));
    TEST_ASSERT_FALSE(cm1e_curve_point_of(&point, &(cm1e_motion_state_t){7, 1, 0}, 1e-300, 0));
    cm1e_curve_t curve;
    TEST_ASSERT_FALSE(cm1e_curve_between(&curve, 5, &point, 5, &point));
    const cm1e_curve_point_t first = {0}, last = {1, 0, 0, 0};
    TEST_ASSERT_FALSE(cm1e_curve_between(&curve, 0, &first, 1e-200, &last));
    TEST_ASSERT_FALSE(cm1e_curve_between(&curve, NAN, &first, 5, &last));
}

/* Of the turns on either side of the chosen one, none is better, and the chosen one is on the right side. */
static void test_the_turn_of_every_mode(void)
{
    for (int n = 0; n < CURVES; n++) {
        const double turn = random_decade(0.1, 1000), start = random_between(-100, 100) * turn;
        const double ratio = random_decade(0.01, 100) * (one_in(2) ? 1 : -1);
        const double slope = one_in(3) ? 0 : ratio * random_between(-2, 3);
        const double way = turn * random_decade(0.1, 10) * (one_in(2) ? 1 : -1), end = random_between(0, turn);
        const double in_step = start + ratio * way;
        const double up = cm1e_approach_end(mcCatchUp, start, slope, end, ratio, way, turn);
        const double down = cm1e_approach_end(mcSlowDown, start, slope, end, ratio, way, turn);
        const double nearest = cm1e_approach_end(mcShortest, start, slope, end, ratio, way, turn);
        const double side = ratio * way > 0 ? 1 : -1, slack = 1e-8 * fabs(turn) + 1e-12 * fabs(in_step);
        TEST_ASSERT_TRUE((up - in_step) * side >= -slack && (up - in_step) * side < turn + slack);
        TEST_ASSERT_TRUE((down - in_step) * side <= slack && (down - in_step) * side > -turn - slack);
        TEST_ASSERT_DOUBLE_WITHIN(turn / 2 + slack, start + (slope + ratio) / 2 * way, nearest);
        const double ends[] = {up, down, nearest};
        for (int i = 0; i < 3; i++) {
            const double turns = (ends[i] - end) / turn;
            TEST_ASSERT_DOUBLE_WITHIN(1e-9 * (1 + fabs(turns)), round(turns), turns);
        }
    }
}

static void test_a_slave_in_step_stays_there_in_every_mode(void)
{
    for (int mode = mcShortest; mode <= (int)mcSlowDown; mode++) {
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 740, cm1e_approach_end((MC_SYNC_MODE)mode, 540 - 1e-8, 2, 20, 2, 100, 360));
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 740, cm1e_approach_end((MC_SYNC_MODE)mode, 540 + 1e-8, 2, 20, 2, 100, 360));
        TEST_ASSERT_EQUAL_DOUBLE(20, cm1e_approach_end((MC_SYNC_MODE)mode, 540, 2, 20, 2, 100, 0)); /* linear */
    }
}

int main(void)
{
    UNITY_BEGIN();
    seed_random();
    RUN_TEST(test_a_curve_meets_both_ends_in_either_order);
    RUN_TEST(test_derivatives_are_differences);
    RUN_TEST(test_extremes_are_those_of_dense_samples);
    RUN_TEST(test_from_rest_to_rest);
    RUN_TEST(test_the_motion_of_a_slave);
    RUN_TEST(test_a_point_of_a_slave_whose_master_stands);
    RUN_TEST(test_the_turn_of_every_mode);
    RUN_TEST(test_a_slave_in_step_stays_there_in_every_mode);
    return UNITY_END();
}
