/* The pieces of a path: lines, arcs and curves over their length, against what they are by definition. */
#include <string.h>

#include "motion/path_piece.h"
#include "motion_check.h"

enum { TRIALS = 3000 };

static const cm1e_path_frame_t FRAME = {5, 3};
static double from[CM1E_PATH_AXES], to[CM1E_PATH_AXES];

void setUp(void) {}
void tearDown(void) {}

static void random_point(double *point, double size)
{
    for (int i = 0; i < FRAME.axes; i++)
        point[i] = random_between(-size, size);
}

/** A random line or arc that begins at `from`; FALSE: none that is well enough defined. */
static bool random_piece(cm1e_path_piece_t *piece)
{
    double border[CM1E_PATH_AXES];
    random_point(to, random_decade(1, 100));
    random_point(border, 50);
    if (!one_in(3)) {
        cm1e_path_make_line(piece, &FRAME, from, to);
        return true;
    }
    return cm1e_path_make_border_arc(piece, &FRAME, from, border, to) && piece->radius < 1e4;
}

static double measured_norm(const double *vector)
{
    return sqrt(vector[0] * vector[0] + vector[1] * vector[1] + vector[2] * vector[2]);
}

/** The derivatives are those of the positions, and the length is the length. */
static void check_derivatives(const cm1e_path_piece_t *piece)
{
    const double h = piece->length * 1e-4;
    for (int k = 1; k < 20; k++) {
        cm1e_path_point_t before, here, after;
        const double l = piece->length * k / 20;
        cm1e_path_point_at(piece, FRAME.axes, l - h, &before);
        cm1e_path_point_at(piece, FRAME.axes, l, &here);
        cm1e_path_point_at(piece, FRAME.axes, l + h, &after);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 1, measured_norm(here.tangent));
        double steepest = 1, sharpest = 0;
        for (int i = 0; i < FRAME.axes; i++) {
            steepest = fmax(steepest, fabs(here.tangent[i]));
            sharpest = fmax(sharpest, fabs(here.curvature[i]));
        }
        for (int i = 0; i < FRAME.axes; i++) {
            const double slope = (after.position[i] - before.position[i]) / (2 * h);
            const double bend = (after.tangent[i] - before.tangent[i]) / (2 * h);
            TEST_ASSERT_DOUBLE_WITHIN(1e-4 * steepest, slope, here.tangent[i]);
            TEST_ASSERT_DOUBLE_WITHIN(1e-3 * sharpest + 1e-6 / piece->length, bend, here.curvature[i]);
        }
    }
}

static void check_same(const cm1e_path_point_t *a, const cm1e_path_point_t *b)
{
    for (int i = 0; i < FRAME.axes; i++) {
        TEST_ASSERT_DOUBLE_WITHIN(1e-11 * (100 + fabs(a->position[i])), a->position[i], b->position[i]);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9 * (1 + fabs(a->tangent[i])), a->tangent[i], b->tangent[i]);
        TEST_ASSERT_DOUBLE_WITHIN(1e-8 * (1 + fabs(a->curvature[i])), a->curvature[i], b->curvature[i]);
    }
}

static void test_a_curve_meets_both_pieces_with_tangent_and_curvature(void)
{
    int curves = 0;
    for (int i = 0; i < TRIALS; i++) {
        cm1e_path_piece_t before, after, curve;
        random_point(from, 50);
        if (!random_piece(&before))
            continue;
        memcpy(from, before.to, sizeof from);
        if (!random_piece(&after))
            continue;
        cm1e_path_point_t end, begin, on_path, on_curve;
        cm1e_path_point_at(&before, FRAME.axes, before.length, &end);
        cm1e_path_point_at(&after, FRAME.axes, 0, &begin);
        const double *a = end.tangent, *b = begin.tangent;
        if (a[0] * b[0] + a[1] * b[1] + a[2] * b[2] < -0.9)
            continue;
        const double reach = random_between(0.01, 0.4) * fmin(before.length, after.length);
        cm1e_path_make_curve(&curve, &FRAME, &before, reach, &after, reach);
        cm1e_path_point_at(&before, FRAME.axes, before.length - reach, &on_path);
        cm1e_path_point_at(&curve, FRAME.axes, 0, &on_curve);
        check_same(&on_path, &on_curve);
        cm1e_path_point_at(&after, FRAME.axes, reach, &on_path);
        cm1e_path_point_at(&curve, FRAME.axes, curve.length, &on_curve);
        check_same(&on_path, &on_curve);
        if (before.kind == CM1E_PATH_LINE && after.kind == CM1E_PATH_LINE)
            check_derivatives(&curve);
        curves++;
    }
    TEST_ASSERT_GREATER_THAN(TRIALS / 4, curves);
}

static void test_arcs_are_round_however_far_their_centre_is(void)
{
    for (int i = 0; i < TRIALS; i++) {
        /* A chord along X; the border is high over its middle: radius = (c2 / 4 + h2) / (2 h). */
        const double c = random_decade(0.1, 100), h = c * random_decade(1e-8, 0.4);
        const double radius = (c * c / 4 + h * h) / (2 * h);
        const double start[CM1E_PATH_AXES] = {0}, end[CM1E_PATH_AXES] = {c, 0, 0, 1, 2}, border[] = {c / 2, h, 0};
        cm1e_path_piece_t arc;
        TEST_ASSERT_TRUE(cm1e_path_make_border_arc(&arc, &FRAME, start, border, end));
        TEST_ASSERT_DOUBLE_WITHIN(1e-12 * radius, radius, arc.radius);
        for (int k = 0; k <= 20; k++) {
            cm1e_path_point_t point;
            cm1e_path_point_at(&arc, FRAME.axes, arc.length * k / 20, &point);
            /* On the circle: x (c - x) = y (2 (radius - h) + y), which has no large differences. */
            const double x = point.position[0], y = point.position[1];
            TEST_ASSERT_DOUBLE_WITHIN(1e-13 * c, 0, (x * (c - x) - y * (2 * (radius - h) + y)) / (2 * radius));
            TEST_ASSERT_DOUBLE_WITHIN(1e-14, k / 20.0, point.position[3]);
        }
        check_derivatives(&arc);
    }
}

static void test_the_way_round_a_centre(void)
{
    static const struct {
        cm1e_path_way_t way;
        double end[3], angle;
    } cases[] = {
        {CM1E_PATH_COUNTER_CLOCKWISE, {0, 10, 0}, 90}, {CM1E_PATH_CLOCKWISE, {0, 10, 0}, 270},
        {CM1E_PATH_COUNTER_CLOCKWISE, {-10, 0, 0}, 180}, {CM1E_PATH_CLOCKWISE, {-10, 0, 0}, 180},
        {CM1E_PATH_COUNTER_CLOCKWISE, {10, 0, 0}, 360}, {CM1E_PATH_CLOCKWISE, {10, 0, 0}, 360},
        {CM1E_PATH_COUNTER_CLOCKWISE, {0, -10, 0}, 270}, {CM1E_PATH_CLOCKWISE, {0, -10, 0}, 90},
        {CM1E_PATH_CLOCKWISE, {0, 0, 10}, 90}, {CM1E_PATH_COUNTER_CLOCKWISE, {0, 0, 10}, 270}, /* seen from +Y */
    };
    static const double centre[3] = {0}, start[CM1E_PATH_AXES] = {10};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        double end[CM1E_PATH_AXES] = {cases[i].end[0], cases[i].end[1], cases[i].end[2]};
        cm1e_path_piece_t arc;
        TEST_ASSERT_TRUE(cm1e_path_make_centre_arc(&arc, &FRAME, start, centre, cases[i].way, end));
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, cases[i].angle, arc.length / 10 * 57.29577951308232);
    }
    const double upright[CM1E_PATH_AXES] = {10, 0, 5}, high[] = {0, 0, 0};
    cm1e_path_piece_t arc;
    TEST_ASSERT_FALSE(cm1e_path_make_centre_arc(&arc, &FRAME, upright, high, CM1E_PATH_CLOCKWISE, upright));
}

/** What its end is out of round is distributed along an arc, so it must be little in comparison with its length. */
static void test_an_arc_is_round_by_its_own_length(void)
{
    int arcs = 0;
    for (int i = 0; i < TRIALS; i++) {
        const double radius = random_decade(0.1, 1e4), angle = random_decade(1e-9, 6), out = random_decade(1e-9, 1e-6);
        const double far = radius * (1 + (i % 2 ? out : -out)), centre[3] = {0};
        const double start[CM1E_PATH_AXES] = {radius};
        const double end[CM1E_PATH_AXES] = {far * cos(angle), far * sin(angle)};
        cm1e_path_piece_t arc;
        if (!cm1e_path_make_centre_arc(&arc, &FRAME, start, centre, CM1E_PATH_COUNTER_CLOCKWISE, end)) {
            TEST_ASSERT_TRUE(out > 0.5e-3 * angle || out > 0.99e-6);
            continue;
        }
        cm1e_path_point_t before, after;
        arcs++;
        for (int k = 1; k < 20; k++) {
            const double l = arc.length * k / 20, h = arc.length * 1e-3;
            cm1e_path_point_t here;
            cm1e_path_point_at(&arc, FRAME.axes, l - h, &before);
            cm1e_path_point_at(&arc, FRAME.axes, l, &here);
            cm1e_path_point_at(&arc, FRAME.axes, l + h, &after);
            const double way = hypot(after.position[0] - before.position[0], after.position[1] - before.position[1]);
            const double rounding = 1e-15 * radius / h;
            TEST_ASSERT_DOUBLE_WITHIN(1e-5 + rounding, 1, way / (2 * h));
            for (int axis = 0; axis < 2; axis++)
                TEST_ASSERT_DOUBLE_WITHIN(1e-5 + rounding, (after.position[axis] - before.position[axis]) / (2 * h),
                                          here.tangent[axis]);
        }
    }
    TEST_ASSERT_GREATER_THAN(TRIALS / 4, arcs);
}

/** A third axis that is a count beside must not turn a half or a full circle upright. */
static void test_a_half_or_full_circle_keeps_its_height(void)
{
    static const double ends[][3] = {{-10, 0}, {-10, 1e-7}, {-9.99995, 0.01}, {-9.99995, -0.01}, {10, 0}, {10, 1e-7},
                                     {9.99995, -0.01}};
    const double centre[3] = {0, 0, 5};
    for (size_t i = 0; i < sizeof ends / sizeof *ends; i++)
        for (double off = 1e-8; off < 0.05; off *= 3)
            for (int way = 0; way < 4; way++) {
                const double start[CM1E_PATH_AXES] = {10, 0, 5 + (way & 1 ? off : 0)};
                const double end[CM1E_PATH_AXES] = {ends[i][0], ends[i][1], 5 - (way & 1 ? 0 : off)};
                double lowest, highest;
                cm1e_path_piece_t arc;
                if (!cm1e_path_make_centre_arc(&arc, &FRAME, start, centre, (cm1e_path_way_t)(way / 2), end))
                    continue;
                cm1e_path_extent(&arc, &FRAME, 2, &lowest, &highest);
                TEST_ASSERT_DOUBLE_WITHIN(2 * off, 5, lowest);
                TEST_ASSERT_DOUBLE_WITHIN(2 * off, 5, highest);
            }
    const double start[CM1E_PATH_AXES] = {10, 0, 5}, half[CM1E_PATH_AXES] = {-10, 0, 5};
    cm1e_path_piece_t arc;
    TEST_ASSERT_TRUE(cm1e_path_make_centre_arc(&arc, &FRAME, start, centre, CM1E_PATH_CLOCKWISE, half));
    TEST_ASSERT_TRUE(cm1e_path_make_centre_arc(&arc, &FRAME, start, centre, CM1E_PATH_CLOCKWISE, start));
    /* An arc in an upright plane that is short in comparison with its radius is well defined. */
    const double small[CM1E_PATH_AXES] = {10 * cos(1e-4), 0, 5 + 10 * sin(1e-4)};
    TEST_ASSERT_TRUE(cm1e_path_make_centre_arc(&arc, &FRAME, start, centre, CM1E_PATH_CLOCKWISE, small));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 1e-3, arc.length);
}

static void test_the_extent_of_an_arc_is_that_of_its_points(void)
{
    for (int i = 0; i < TRIALS; i++) {
        double border[CM1E_PATH_AXES];
        random_point(from, 10);
        random_point(to, 10);
        random_point(border, 10);
        cm1e_path_piece_t arc;
        if (!cm1e_path_make_border_arc(&arc, &FRAME, from, border, to))
            continue;
        double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
        for (int k = 0; k <= 200; k++) {
            cm1e_path_point_t point;
            cm1e_path_point_at(&arc, FRAME.axes, arc.length * k / 200, &point);
            for (int axis = 0; axis < 3; axis++) {
                low[axis] = fmin(low[axis], point.position[axis]);
                high[axis] = fmax(high[axis], point.position[axis]);
            }
        }
        for (int axis = 0; axis < 3; axis++) {
            double lowest, highest;
            cm1e_path_extent(&arc, &FRAME, axis, &lowest, &highest);
            TEST_ASSERT_TRUE(lowest <= low[axis] + 1e-9 * arc.radius && highest >= high[axis] - 1e-9 * arc.radius);
            TEST_ASSERT_DOUBLE_WITHIN(2e-3 * arc.radius, low[axis], lowest);
            TEST_ASSERT_DOUBLE_WITHIN(2e-3 * arc.radius, high[axis], highest);
        }
    }
}

/** A curve is within the hull of its points, which of a power of the way are between 0 and 1. */
static void test_the_extent_of_a_curve_has_all_of_it(void)
{
    double lowest, highest;
    for (int k = 0; k < TRIALS; k++) {
        cm1e_path_piece_t curve = {.kind = CM1E_PATH_CURVE};
        const int alone = k < 5 ? k + 1 : 0;
        for (int j = 0; j <= 5; j++)
            curve.power[j][0] = alone ? j == alone : random_between(-10, 10);
        cm1e_path_extent(&curve, &FRAME, 0, &lowest, &highest);
        for (int n = 0; n <= 50; n++) {
            double at = 0;
            for (int j = 5; j >= 0; j--)
                at = curve.power[j][0] + n / 50.0 * at;
            TEST_ASSERT_TRUE(lowest <= at + 1e-9 && highest >= at - 1e-9);
        }
        if (!alone)
            continue;
        TEST_ASSERT_EQUAL_DOUBLE(0, lowest);
        TEST_ASSERT_EQUAL_DOUBLE(1, highest);
    }
}

int main(void)
{
    seed_random();
    UNITY_BEGIN();
    RUN_TEST(test_a_curve_meets_both_pieces_with_tangent_and_curvature);
    RUN_TEST(test_arcs_are_round_however_far_their_centre_is);
    RUN_TEST(test_the_way_round_a_centre);
    RUN_TEST(test_an_arc_is_round_by_its_own_length);
    RUN_TEST(test_a_half_or_full_circle_keeps_its_height);
    RUN_TEST(test_the_extent_of_an_arc_is_that_of_its_points);
    RUN_TEST(test_the_extent_of_a_curve_has_all_of_it);
    return UNITY_END();
}
