/* Cams against what their tables mean, computed in long double (ideal_cam.h): random tables of each curve. */
#include "unity.h"

#include "motion/cam.h"

#include "../support/chance.h"
#include "../support/ideal_cam.h"

#include <stdio.h>

enum { CAMS = 400, SAMPLES = 2000 };

void setUp(void) {}
void tearDown(void) {}

/** Far from 0 too; the points close together and far apart. */
static void random_points(MC_CAM_POINT *points, int count, bool periodic)
{
    double at = one_in(2) ? 0 : uniform(-1e4, 1e4);
    for (int i = 0; i < count; i++) {
        points[i] = (MC_CAM_POINT){at, uniform(-10, 10), uniform(-3, 3), uniform(-9, 9)};
        at += one_in(4) ? uniform(0.05, 0.2) : uniform(0.5, 5);
    }
    if (periodic && one_in(2))
        points[count - 1].Slave = points[0].Slave;
}

static void test_cam_is_what_its_table_means(void)
{
    double worst = 0;
    const int runs = seed_count(CAMS);
    for (int run = 0; run < runs; run++) {
        chance_seed(seed_of(run));
        MC_CAM_POINT points[IDEAL_POINTS];
        cm1e_cam_knot_t knots[IDEAL_POINTS];
        MC_CAM_REF table = {.Points = points, .NumberOfPoints = (UINT)(2 + pick(IDEAL_POINTS - 1)),
                            .Curve = (MC_CAM_CURVE)pick(3)};
        const bool periodic = one_in(2);
        ideal_cam_t ideal;
        cm1e_cam_t cam;
        cm1e_cam_place_t place = {0};
        int at;
        random_points(points, table.NumberOfPoints, periodic);
        ideal_cam_init(&ideal, &table, periodic);
        TEST_ASSERT_EQUAL_INT(CM1E_CAM_GOOD, cm1e_cam_compile(&cam, knots, IDEAL_POINTS, &table, periodic, &at));
        const double length = points[table.NumberOfPoints - 1].Master - points[0].Master;
        double x = points[0].Master;
        for (int i = 0; i < SAMPLES; i++) {
            x = one_in(20) ? points[0].Master + length * uniform(-3, 4) : x + length * uniform(-0.01, 0.02);
            cm1e_cam_sample_t sample;
            cm1e_cam_sample(&cam, &place, x, &sample);
            const long double turns = periodic ? (long double)sample.turn * (long double)cam.advance : 0;
            const long double is = (long double)sample.point.position + turns;
            const double off = (double)fabsl(is - ideal_cam_at(&ideal, x)), allowed = 1e-9 * (1 + fabs(x) * 1e-3);
            worst = fmax(worst, off);
            if (off > allowed) {
                char words[200];
                snprintf(words, sizeof words, "seed %u, curve %d, periodic %d, %d points: at %.17g %.17Lg, not %.17Lg",
                         seed_of(run), table.Curve, periodic, table.NumberOfPoints, x, is, ideal_cam_at(&ideal, x));
                TEST_FAIL_MESSAGE(words);
            }
        }
    }
    printf("%d cams, largest error %g\n", runs, worst);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_cam_is_what_its_table_means);
    return UNITY_END();
}
