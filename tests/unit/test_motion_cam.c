/* Cams: through their points, as smooth as promised, periods without drift, extremes that dense sampling confirms. */
#include "motion/cam.h"
#include <string.h>

#include "motion_check.h"

enum { MOST = 64, CAMS = 4000, DENSE = 400 };

void setUp(void) {}
void tearDown(void) {}

static cm1e_cam_t cam;
static cm1e_cam_knot_t knots[4096];
static cm1e_cam_place_t place;

typedef struct {
    MC_CAM_POINT points[MOST];
    MC_CAM_REF table;
    bool periodic;
} random_cam_t;

static const char *cam_text(const random_cam_t *random)
{
    static char text[6000];
    int length = snprintf(text, sizeof text, "curve %d periodic %d", (int)random->table.Curve, random->periodic);
    for (int i = 0; i < random->table.NumberOfPoints && length < 5800; i++)
        length += snprintf(text + length, sizeof text - (size_t)length, " (%.17g, %.17g, %.17g, %.17g)",
                           random->points[i].Master, random->points[i].Slave, random->points[i].Velocity,
                           random->points[i].Acceleration);
    return text;
}

#define CHECK_CAM(condition, random) TEST_ASSERT_TRUE_MESSAGE(condition, cam_text(random))

static void random_cam(random_cam_t *random)
{
    const double size = random_decade(0.01, 1e4), step = random_decade(0.01, 100);
    double master = random_between(-1, 1) * random_decade(0.1, 1000);
    *random = (random_cam_t){.periodic = one_in(2)};
    random->table = (MC_CAM_REF){random->points, (UINT)(2 + random_bits() % (MOST - 1)),
                                 (MC_CAM_CURVE)(random_bits() % 3)};
    for (int i = 0; i < random->table.NumberOfPoints; i++) {
        random->points[i] = (MC_CAM_POINT){master, size * random_between(-1, 1), size / step * random_between(-1, 1),
                                           size / step / step * random_between(-1, 1)};
        if (one_in(3))
            random->points[i].Velocity = random->points[i].Acceleration = 0;
        master += step * (one_in(2) ? 1 : random_between(0.2, 5));
    }
}

static void compile(const MC_CAM_REF *table, bool periodic)
{
    int at = -1;
    place = (cm1e_cam_place_t){0};
    TEST_ASSERT_EQUAL_INT(CM1E_CAM_GOOD, cm1e_cam_compile(&cam, knots, 4096, table, periodic, &at));
}

static cm1e_cam_sample_t at(double master)
{
    cm1e_cam_sample_t sample;
    cm1e_cam_sample(&cam, &place, master, &sample);
    return sample;
}

static double total(const cm1e_cam_sample_t *sample)
{
    return sample->point.position + (cam.periodic ? sample->turn * cam.advance : 0);
}

static double size_of(const cm1e_cam_t *c)
{
    return fmax(fabs(c->extremes.lowest), fabs(c->extremes.highest));
}

static void test_a_cam_goes_through_its_points_with_their_slopes(void)
{
    for (int n = 0; n < CAMS; n++) {
        random_cam_t random;
        random_cam(&random);
        compile(&random.table, random.periodic);
        const int count = random.table.NumberOfPoints;
        const double slack = 1e-11 * size_of(&cam) + 1e-14;
        for (int i = 0; i < count; i++) {
            const MC_CAM_POINT *point = &random.points[i];
            const cm1e_cam_sample_t here = at(point->Master);
            CHECK_CAM(fabs(total(&here) - point->Slave) <= slack, &random);
            if (random.table.Curve != mcCamPolynomial5 || i == 0 || i == count - 1)
                continue;
            const double steepest = fmax(fabs(cam.extremes.least_slope), fabs(cam.extremes.most_slope));
            CHECK_CAM(fabs(here.point.slope - point->Velocity) <= 1e-9 * steepest, &random);
            CHECK_CAM(fabs(here.point.curvature - point->Acceleration) <= 1e-9 * cam.extremes.curvature, &random);
        }
    }
}

/* What is just before a point and what is just behind it, also over the end of a period. */
static void test_splines_and_polynomials_have_no_step_of_slope_or_curvature(void)
{
    for (int n = 0; n < CAMS; n++) {
        random_cam_t random;
        random_cam(&random);
        if (random.table.Curve == mcCamLinear)
            random.table.Curve = mcCamCubicSpline;
        const int count = random.table.NumberOfPoints;
        random.points[count - 1].Velocity = random.points[0].Velocity;
        random.points[count - 1].Acceleration = random.points[0].Acceleration;
        compile(&random.table, random.periodic);
        for (int i = random.periodic ? 0 : 1; i + 1 < count; i++) {
            const double master = random.points[i].Master, tick = 1e-9 * cam.length;
            const cm1e_cam_sample_t before = at(master - tick), behind = at(master + tick);
            const cm1e_curve_extremes_t *e = &cam.extremes;
            const double slope = fmax(fabs(e->least_slope), fabs(e->most_slope));
            CHECK_CAM(fabs(total(&behind) - total(&before)) <= 3 * tick * slope + 1e-12 * size_of(&cam), &random);
            CHECK_CAM(fabs(behind.point.slope - before.point.slope) <= 3 * tick * e->curvature + 1e-10 * slope,
                      &random);
            const double bend = fabs(behind.point.curvature - before.point.curvature);
            CHECK_CAM(bend <= 3 * tick * e->third + 1e-9 * e->curvature, &random);
        }
    }
}

static void test_a_natural_spline_ends_straight(void)
{
    MC_CAM_POINT points[] = {{0, 0, 9, 9}, {1, 1, 9, 9}, {3, 0, 9, 9}, {4, -2, 9, 9}};
    const MC_CAM_REF table = {points, 4, mcCamCubicSpline};
    compile(&table, false);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0, at(1e-12).point.curvature);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0, at(4 - 1e-12).point.curvature);
    TEST_ASSERT_TRUE(fabs(at(2).point.curvature) > 0.1);
}

/* A sine by 65 points: a periodic spline is near to it everywhere, also at its ends. */
static void test_a_periodic_spline_is_as_good_at_its_ends_as_elsewhere(void)
{
    MC_CAM_POINT points[65] = {{0}};
    for (int i = 0; i <= 64; i++)
        points[i] = (MC_CAM_POINT){360.0 * i / 64, 10 * cos(2 * M_PI * i / 64) + 1.25 * i, 0, 0};
    const MC_CAM_REF table = {points, 65, mcCamCubicSpline};
    compile(&table, true);
    for (int i = -3000; i < 3000; i++) {
        const double master = i * 0.37, angle = master * M_PI / 180;
        const cm1e_cam_sample_t here = at(master);
        TEST_ASSERT_DOUBLE_WITHIN(3e-6, 10 * cos(angle) + 80 * master / 360, total(&here));
        TEST_ASSERT_DOUBLE_WITHIN(2e-6, -10 * sin(angle) * M_PI / 180 + 80.0 / 360, here.point.slope);
        TEST_ASSERT_DOUBLE_WITHIN(3e-6, -10 * cos(angle) * M_PI / 180 * M_PI / 180, here.point.curvature);
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 80, cam.advance);
}

static void test_small_splines(void)
{
    for (int count = 2; count <= 4; count++)
        for (int periodic = 0; periodic < 2; periodic++) {
            MC_CAM_POINT points[] = {{0, 0, 0, 0}, {1, 3, 0, 0}, {3, 1, 0, 0}, {4, 2, 0, 0}};
            const MC_CAM_REF table = {points, (UINT)count, mcCamCubicSpline};
            compile(&table, periodic != 0);
            const cm1e_cam_sample_t first = at(1e-13), last = at(cam.length - 1e-13);
            if (periodic) {
                TEST_ASSERT_DOUBLE_WITHIN(1e-11, first.point.slope, last.point.slope);
                TEST_ASSERT_DOUBLE_WITHIN(1e-11, first.point.curvature, last.point.curvature);
            }
            if (count == 2)
                TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1.5, at(0.5).point.position);
        }
}

static void test_straight_lines_are_straight(void)
{
    MC_CAM_POINT points[] = {{10, 5, NAN, NAN}, {20, 10, NAN, NAN}, {40, -10, NAN, NAN}};
    const MC_CAM_REF table = {points, 3, mcCamLinear};
    compile(&table, true);
    for (int i = 0; i < 300; i++) {
        const double phase = 0.1 * i;
        const cm1e_cam_sample_t here = at(10 + phase);
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, phase < 10 ? 5 + phase / 2 : 20 - phase, here.point.position);
        TEST_ASSERT_DOUBLE_WITHIN(1e-13, phase < 10 ? 0.5 : -1, here.point.slope);
        TEST_ASSERT_DOUBLE_WITHIN(1e-13, 0, here.point.curvature);
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, -10, cam.extremes.lowest);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 10, cam.extremes.highest);
}

/* The slave's place after n periods is n times the advance farther, to the last bits, forwards and backwards, whatever
 * the way there was. */
static void test_a_million_periods_drift_by_nothing(void)
{
    MC_CAM_POINT points[] = {{0, 0, 0.5, 0}, {100, 70, 0, 0}, {360, 100, 0.5, 0}};
    const MC_CAM_REF table = {points, 3, mcCamPolynomial5};
    compile(&table, true);
    double worst = 0;
    for (int64_t n = -1000000; n <= 1000000; n += 333) {
        const double phase = (double)((n + 2000000) % 360);
        const cm1e_cam_sample_t here = at((double)n * 360 + phase);
        TEST_ASSERT_EQUAL_DOUBLE((double)n, here.turn);
        TEST_ASSERT_EQUAL_DOUBLE(phase, here.phase);
        cm1e_cam_place_t fresh = {0};
        cm1e_cam_sample_t home;
        cm1e_cam_sample(&cam, &fresh, phase, &home);
        TEST_ASSERT_EQUAL_DOUBLE(0, home.turn);
        worst = fmax(worst, fabs(here.point.position - home.point.position));
        worst = fmax(worst, fabs(total(&here) - home.point.position - (double)n * 100));
    }
    TEST_ASSERT_TRUE(worst < 1e-7); /* 1e8 u away a double has 1.5e-8 u */
}

static void test_a_period_that_no_double_holds_loses_no_turn(void)
{
    MC_CAM_POINT points[] = {{0.1, 0, 0, 0}, {0.4, 0.7, 0, 0}};
    const MC_CAM_REF table = {points, 2, mcCamPolynomial5};
    compile(&table, true);
    for (int i = -200000; i <= 200000; i++)
        for (int k = -2; k <= 2; k++) { /* near the borders, from below and from above: the slave stands there */
            const cm1e_cam_sample_t here = at(0.1 + i * cam.length + k * 1e-15 * (1 + fabs((double)i)));
            TEST_ASSERT_TRUE(here.phase >= 0 && here.phase < cam.length);
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, i * cam.advance, total(&here));
        }
}

static void test_single_shot_keeps_its_ends(void)
{
    MC_CAM_POINT points[] = {{10, 5, 0, 0}, {20, 7, 0, 0}, {30, 6, 0, 0}};
    const MC_CAM_REF table = {points, 3, mcCamPolynomial5};
    compile(&table, false);
    const struct { double master, position, turn; } outside[] = {
        {-1e9, 5, -1}, {9.999, 5, -1}, {10, 5, -1}, {30, 6, 1}, {30.001, 6, 1}, {1e9, 6, 1}};
    for (int i = 0; i < 6; i++) {
        const cm1e_cam_sample_t here = at(outside[i].master);
        TEST_ASSERT_EQUAL_DOUBLE(outside[i].position, here.point.position);
        TEST_ASSERT_EQUAL_DOUBLE(outside[i].turn, here.turn);
        TEST_ASSERT_EQUAL_DOUBLE(0, here.point.slope);
        TEST_ASSERT_EQUAL_DOUBLE(0, here.point.curvature);
    }
    TEST_ASSERT_EQUAL_DOUBLE(0, at(10.001).turn);
    TEST_ASSERT_EQUAL_DOUBLE(0, at(29.999).turn);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 7, at(20).point.position);
}

/* The extremes are reached (within a little) and never exceeded; `third` is a bound only. */
static void test_extremes_are_those_of_dense_samples(void)
{
    for (int n = 0; n < CAMS / 4; n++) {
        random_cam_t random;
        random_cam(&random);
        compile(&random.table, random.periodic);
        const cm1e_curve_extremes_t *e = &cam.extremes;
        const double width = e->highest - e->lowest, slopes = e->most_slope - e->least_slope;
        double low = INFINITY, high = -INFINITY, least = INFINITY, most = -INFINITY, curvature = 0;
        for (int i = 0; i + 1 < cam.count; i++)
            for (int k = 0; k < DENSE; k++) {
                const double h = knots[i + 1].master - knots[i].master;
                const cm1e_cam_sample_t here = at(knots[i].master + h * k / DENSE + 1e-9 * h);
                low = fmin(low, here.point.position);
                high = fmax(high, here.point.position);
                least = fmin(least, here.point.slope);
                most = fmax(most, here.point.slope);
                curvature = fmax(curvature, fabs(here.point.curvature));
                CHECK_CAM(fabs(here.point.third) <= e->third * (1 + 1e-9), &random);
            }
        CHECK_CAM(low >= e->lowest - 1e-9 * width && low <= e->lowest + 2e-2 * width, &random);
        CHECK_CAM(high <= e->highest + 1e-9 * width && high >= e->highest - 2e-2 * width, &random);
        CHECK_CAM(least >= e->least_slope - 1e-8 * slopes && least <= e->least_slope + 2e-2 * slopes, &random);
        CHECK_CAM(most <= e->most_slope + 1e-8 * slopes && most >= e->most_slope - 2e-2 * slopes, &random);
        CHECK_CAM(curvature <= e->curvature * (1 + 1e-8) + 1e-9, &random);
        if (random.table.Curve != mcCamLinear)
            CHECK_CAM(curvature >= e->curvature * 0.95, &random);
    }
}

/* Of these cams only one extreme is between two points, in their last interval, and the other ones are at points. */
static void test_an_extreme_between_points_is_found_also_where_it_is_the_only_one(void)
{
    static const MC_CAM_POINT position[] = {{0, 0, 0, 100}, {0.01, 0.002, 0.3, 0}, {0.5, 0.3205, 1, 0},
                                            {1.5, 0.3205, -1, 0}};
    static const MC_CAM_POINT slope[] = {{0, 0, 0, 100}, {0.01, 0.002, 0.3, 0}, {0.5, 0.01, 0, 0}, {1.5, 1, 0, 0}};
    static const MC_CAM_POINT curvature[] = {{9, 90, 10, 0}, {10, 100, 10, 0}, {11, 110 - 1.7 / 6, 9.15, -1.7},
                                             {12, 118.15 - 1.7 / 6, 7.15, -1.7}};
    static const double sizes[] = {1, -1, 1e-6, -1e-6, 1e6};
    const MC_CAM_POINT *const cams[] = {position, slope, curvature};
    for (int c = 0; c < 3; c++)
        for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
            MC_CAM_POINT points[4];
            for (int i = 0; i < 4; i++)
                points[i] = (MC_CAM_POINT){cams[c][i].Master, sizes[k] * cams[c][i].Slave,
                                           sizes[k] * cams[c][i].Velocity, sizes[k] * cams[c][i].Acceleration};
            const MC_CAM_REF table = {points, 4, mcCamPolynomial5};
            compile(&table, false);
            const double least = 1 - 1e-12;
            for (int i = 1; i < 1000; i++) {
                const double way = points[3].Master - points[2].Master;
                const cm1e_curve_point_t here = at(points[2].Master + i * way / 1000).point;
                TEST_ASSERT_TRUE(fabs(here.position) * least <= size_of(&cam));
                TEST_ASSERT_TRUE(fabs(here.slope) * least <= fmax(fabs(cam.extremes.least_slope),
                                                                  fabs(cam.extremes.most_slope)));
                TEST_ASSERT_TRUE(fabs(here.curvature) * least <= cam.extremes.curvature);
            }
        }
}

/* The place of the sample before is only a help. */
static void test_the_place_changes_nothing(void)
{
    for (int n = 0; n < CAMS / 4; n++) {
        random_cam_t random;
        random_cam(&random);
        compile(&random.table, random.periodic);
        double master = cam.start;
        for (int i = 0; i < 100; i++) {
            master += cam.length * (one_in(5) ? random_between(-2, 2) : random_between(-0.05, 0.05));
            cm1e_cam_place_t fresh = {0};
            cm1e_cam_sample_t expected;
            cm1e_cam_sample(&cam, &fresh, master, &expected);
            const cm1e_cam_sample_t here = at(master);
            CHECK_CAM(memcmp(&here, &expected, sizeof here) == 0, &random);
        }
    }
}

static void test_what_is_no_cam_is_refused(void)
{
    static MC_CAM_POINT points[10];
    static const struct { cm1e_cam_fault_t fault; int at; int count; MC_CAM_CURVE curve; } cases[] = {
        {CM1E_CAM_TOO_FEW, 0, 0, mcCamPolynomial5},    {CM1E_CAM_TOO_FEW, 0, 1, mcCamPolynomial5},
        {CM1E_CAM_TOO_MANY, 8, 9, mcCamLinear},        {CM1E_CAM_CURVE, 0, 4, (MC_CAM_CURVE)3},
        {CM1E_CAM_CURVE, 0, 4, (MC_CAM_CURVE)-1},      {CM1E_CAM_GOOD, 0, 8, mcCamCubicSpline},
    };
    for (int i = 0; i < 10; i++)
        points[i] = (MC_CAM_POINT){i, i % 3, 0, 0};
    for (int i = 0; i < 6; i++) {
        int wrong = -1;
        const MC_CAM_REF table = {points, (UINT)cases[i].count, cases[i].curve};
        TEST_ASSERT_EQUAL_INT(cases[i].fault, cm1e_cam_compile(&cam, knots, 8, &table, false, &wrong));
        TEST_ASSERT_EQUAL_INT(cases[i].at, wrong);
    }
    int wrong = -1;
    const MC_CAM_REF none = {NULL, 5, mcCamLinear};
    TEST_ASSERT_EQUAL_INT(CM1E_CAM_TOO_FEW, cm1e_cam_compile(&cam, knots, 8, &none, false, &wrong));
}

static void test_every_wrong_number_is_found_and_named(void)
{
    static const double bad[] = {NAN, INFINITY, -1.01e30};
    for (int curve = mcCamPolynomial5; curve <= (int)mcCamLinear; curve++)
        for (int i = 0; i < 6; i++)
            for (int field = 0; field < 5; field++)
                for (int b = 0; b < 3; b++) {
                    MC_CAM_POINT points[6];
                    for (int k = 0; k < 6; k++)
                        points[k] = (MC_CAM_POINT){k, k % 2, 0, 0};
                    double *fields[] = {&points[i].Master, &points[i].Slave, &points[i].Velocity,
                                        &points[i].Acceleration};
                    if (field < 4)
                        *fields[field] = bad[b];
                    else if (i > 0)
                        points[i].Master = points[i - 1].Master - b * 1e-9;
                    const bool ignored = field == 4 ? i == 0 : field >= 2 && curve != (int)mcCamPolynomial5;
                    const MC_CAM_REF table = {points, 6, (MC_CAM_CURVE)curve};
                    int wrong = -1;
                    const cm1e_cam_fault_t fault = cm1e_cam_compile(&cam, knots, 8, &table, b == 0, &wrong);
                    TEST_ASSERT_EQUAL_INT(ignored      ? CM1E_CAM_GOOD
                                          : field == 4 ? CM1E_CAM_NOT_RISING
                                                       : CM1E_CAM_NO_NUMBER,
                                          fault);
                    if (!ignored)
                        TEST_ASSERT_EQUAL_INT(i, wrong);
                }
}

/* Numbers at the ends of what doubles can hold: refused, or finite everywhere. */
static void test_extreme_numbers_never_become_infinite(void)
{
    static const double sizes[] = {2e-317, 1e-300, 1e-100, 1e-12, 1, 1e12, 1e100, 1e300};
    for (int m = 0; m < 8; m++)
        for (int s = 0; s < 8; s++)
            for (int curve = mcCamPolynomial5; curve <= (int)mcCamLinear; curve++) {
                MC_CAM_POINT points[5];
                for (int k = 0; k < 5; k++)
                    points[k] = (MC_CAM_POINT){k * sizes[m], (k % 3) * sizes[s], 0, 0};
                const MC_CAM_REF table = {points, 5, (MC_CAM_CURVE)curve};
                int wrong = -1;
                const cm1e_cam_fault_t fault = cm1e_cam_compile(&cam, knots, 8, &table, true, &wrong);
                place = (cm1e_cam_place_t){0};
                if (fault != CM1E_CAM_GOOD) {
                    TEST_ASSERT_EQUAL_INT(fmax(sizes[m], sizes[s]) > 1e30 ? CM1E_CAM_NO_NUMBER : CM1E_CAM_STEEP, fault);
                    continue;
                }
                for (int i = 0; i < 100; i++) { /* near its points, and where machines are */
                    const cm1e_cam_sample_t here = at((i < 50 ? cam.length : 1e6) * (i % 50 * 0.13 - 2));
                    TEST_ASSERT_TRUE(isfinite(total(&here)) && isfinite(here.point.slope) &&
                                     isfinite(here.point.curvature) && isfinite(here.point.third));
                }
            }
    TEST_ASSERT_EQUAL_INT(32, sizeof(cm1e_cam_knot_t));
}

/* Between two points the slave goes five times through 0: all there is room for. */
static void test_a_curve_with_five_zeros_has_its_extremes(void)
{
    double c[6] = {1};
    for (int r = 0; r < 5; r++) /* times (x - 0.1), (x - 0.3) ... (x - 0.9) */
        for (int i = r + 1; i >= 0; i--)
            c[i] = (i > 0 ? c[i - 1] : 0) - (0.1 + 0.2 * r) * c[i];
    double slave = 0, slope = 0, curvature = 0;
    for (int i = 0; i <= 5; i++) {
        slave += c[i];
        slope += i * c[i];
        curvature += i * (i - 1) * c[i];
    }
    const MC_CAM_POINT points[] = {{0, c[0], c[1], 2 * c[2]}, {1, slave, slope, curvature}};
    compile(&(MC_CAM_REF){points, 2, mcCamPolynomial5}, false);
    int zeros = 0;
    double lowest = INFINITY, highest = -INFINITY, before = c[0];
    for (int i = 1; i < 10000; i++) {
        const double here = at(i * 1e-4).point.position;
        zeros += here * before < 0;
        before = here;
        lowest = fmin(lowest, here);
        highest = fmax(highest, here);
    }
    TEST_ASSERT_EQUAL_INT(5, zeros);
    TEST_ASSERT_DOUBLE_WITHIN(1e-5, fmin(lowest, c[0]), cam.extremes.lowest);
    TEST_ASSERT_DOUBLE_WITHIN(1e-5, fmax(highest, slave), cam.extremes.highest);
}

/* Points that differ, but not by their distances from the first one. */
static void test_points_that_rounding_puts_together_are_refused(void)
{
    const MC_CAM_POINT points[] = {{-0x1p53, 0, 0, 0}, {0.25, 1, 1, 0}, {0.5, 2, 1, 0}, {0x1p53, 3, 0, 0}};
    for (int curve = mcCamPolynomial5; curve <= (int)mcCamLinear; curve++) {
        int wrong = -1;
        const MC_CAM_REF table = {points, 4, (MC_CAM_CURVE)curve};
        TEST_ASSERT_EQUAL_INT(CM1E_CAM_STEEP, cm1e_cam_compile(&cam, knots, 8, &table, true, &wrong));
        TEST_ASSERT_EQUAL_INT(1, wrong);
    }
}

/* So far away that doubles do not tell the place in the period: still a place of the cam. */
static void test_masters_too_far_away_for_periods_stay_on_the_cam(void)
{
    static const double lengths[] = {1e-25, 1e-9, 0.3, 360, 1e25};
    for (int l = 0; l < 5; l++)
        for (int curve = mcCamPolynomial5; curve <= (int)mcCamLinear; curve++) {
            const double h = lengths[l];
            MC_CAM_POINT points[] = {{0, 0, 0, 0}, {0.3 * h, 1, 0, 0}, {0.7 * h, 0.5, 0, 0}, {h, 0, 0, 0}};
            const MC_CAM_REF table = {points, 4, (MC_CAM_CURVE)curve};
            compile(&table, true);
            for (int i = 0; i < 1000; i++) {
                const double master = random_between(-1, 1) * random_decade(1e-9, 1e30);
                const cm1e_cam_sample_t here = at(master);
                TEST_ASSERT_TRUE(here.phase >= 0 && here.phase < cam.length && isfinite(here.turn));
                TEST_ASSERT_TRUE(here.point.position >= cam.extremes.lowest - 1e-9 &&
                                 here.point.position <= cam.extremes.highest + 1e-9);
            }
        }
}

/* A full table: the last point too, and samples in any order. */
static void test_4096_points(void)
{
    static MC_CAM_POINT points[4096];
    for (int i = 0; i < 4096; i++)
        points[i] = (MC_CAM_POINT){i * 0.25, sin(i * 2 * M_PI / 4095), 0, 0};
    for (int curve = mcCamCubicSpline; curve <= (int)mcCamLinear; curve++) {
        const MC_CAM_REF table = {points, 4096, (MC_CAM_CURVE)curve};
        compile(&table, true);
        for (int i = 0; i < 20000; i++) {
            const double master = one_in(2) ? random_between(0, cam.length) : i * 0.07;
            const cm1e_cam_sample_t here = at(master);
            TEST_ASSERT_DOUBLE_WITHIN(1e-6, sin(master / cam.length * 2 * M_PI), total(&here));
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    seed_random();
    RUN_TEST(test_a_cam_goes_through_its_points_with_their_slopes);
    RUN_TEST(test_splines_and_polynomials_have_no_step_of_slope_or_curvature);
    RUN_TEST(test_a_natural_spline_ends_straight);
    RUN_TEST(test_a_periodic_spline_is_as_good_at_its_ends_as_elsewhere);
    RUN_TEST(test_small_splines);
    RUN_TEST(test_straight_lines_are_straight);
    RUN_TEST(test_a_million_periods_drift_by_nothing);
    RUN_TEST(test_a_period_that_no_double_holds_loses_no_turn);
    RUN_TEST(test_single_shot_keeps_its_ends);
    RUN_TEST(test_extremes_are_those_of_dense_samples);
    RUN_TEST(test_an_extreme_between_points_is_found_also_where_it_is_the_only_one);
    RUN_TEST(test_the_place_changes_nothing);
    RUN_TEST(test_what_is_no_cam_is_refused);
    RUN_TEST(test_every_wrong_number_is_found_and_named);
    RUN_TEST(test_extreme_numbers_never_become_infinite);
    RUN_TEST(test_a_curve_with_five_zeros_has_its_extremes);
    RUN_TEST(test_points_that_rounding_puts_together_are_refused);
    RUN_TEST(test_masters_too_far_away_for_periods_stay_on_the_cam);
    RUN_TEST(test_4096_points);
    return UNITY_END();
}
