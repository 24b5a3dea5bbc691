/* How hard a master may brake whose slave is on a cam: dense samples of the way until it stands confirm the bound. */
#include "motion/cam.h"

#include "motion_check.h"

enum { MOST = 24, WAYS = 4000, DENSE = 3000 };

void setUp(void) {}
void tearDown(void) {}

static cm1e_cam_t cam;
static cm1e_cam_knot_t knots[4096];
static MC_CAM_POINT points[4096];

static void compile(int count, MC_CAM_CURVE curve, bool periodic)
{
    const MC_CAM_REF table = {points, (UINT)count, curve};
    int at = -1;
    TEST_ASSERT_EQUAL_INT(CM1E_CAM_GOOD, cm1e_cam_compile(&cam, knots, 4096, &table, periodic, &at));
}

/* Some points are at the height of the one before, without slope: the cam rests there. */
static void random_cam(void)
{
    const int count = 2 + (int)(random_bits() % (MOST - 1));
    double master = random_between(-5, 5), slave = random_between(-1, 1);
    for (int i = 0; i < count; i++) {
        if (!one_in(3))
            slave += random_between(-1, 1);
        points[i] = (MC_CAM_POINT){master, slave, one_in(2) ? 0 : random_between(-1, 1), 0};
        master += one_in(4) ? 0.1 : random_between(0.2, 5);
    }
    compile(count, (MC_CAM_CURVE)(random_bits() % 3), one_in(2));
}

static double steepest(void) { return fmax(fabs(cam.extremes.least_slope), fabs(cam.extremes.most_slope)); }

/* The hardest deceleration of the slave between the cycles, while its master brakes with `a`. */
static double slave_brakes_with(const cm1e_cam_braking_t *asked, double a, double first)
{
    const double v0 = asked->velocity, sign = v0 > 0 ? 1 : -1, t = asked->cycle_s;
    cm1e_cam_place_t place = {0};
    double hardest = 0, before = 0, time = first;
    for (int i = 0; i < DENSE; i++, time += t) {
        const double braked = fmin(time, fabs(v0) / a), v = v0 - sign * a * braked;
        cm1e_cam_sample_t here;
        cm1e_cam_sample(&cam, &place, asked->master + (v0 + v) / 2 * braked, &here);
        const double of_slave = here.point.slope * v;
        if (i > 0 && fabs(of_slave) < fabs(before) && of_slave * before >= 0)
            hardest = fmax(hardest, (fabs(before) - fabs(of_slave)) / t);
        before = of_slave;
        if (v * sign <= 0)
            return hardest;
    }
    return hardest;
}

static cm1e_cam_braking_t random_braking(void)
{
    const double own = random_decade(1, 100), hard = random_decade(1, 1000);
    return (cm1e_cam_braking_t){.master = cam.start + cam.length * random_between(-0.5, 1.5),
                                .velocity = random_between(-1, 1) * random_decade(0.1, 10), .own = own,
                                .gentle = fmin(hard, own / steepest()), .hard = hard, .cycle_s = 1e-3};
}

static double hardest(cm1e_cam_braking_t asked)
{
    int steps = CM1E_CAM_BRAKING_STEPS;
    asked.steps = &steps;
    return cm1e_cam_hardest_braking(&cam, &asked);
}

/* Harder than the steepest place of all allows, but never so that the slave brakes harder than it may. */
static void test_the_slave_never_brakes_harder_than_it_may(void)
{
    int harder = 0;
    for (int run = 0; run < WAYS; run++) {
        random_cam();
        for (int i = 0; i < 5; i++) {
            const cm1e_cam_braking_t asked = random_braking();
            const double a = hardest(asked);
            TEST_ASSERT_TRUE(a >= asked.gentle && a <= asked.hard);
            if (!(a > asked.gentle))
                continue;
            harder++;
            const double worst = slave_brakes_with(&asked, a, random_between(0, asked.cycle_s));
            char text[200];
            snprintf(text, sizeof text, "run %d.%d: %.9g above %.9g, master at %g with %g brakes with %.9g, gentle %g",
                     run, i, worst, asked.own, asked.master, asked.velocity, a, asked.gentle);
            TEST_ASSERT_TRUE_MESSAGE(worst <= asked.own * (1 + 1e-6) + 1e-6, text);
        }
    }
    printf("%d of %d harder\n", harder, 5 * WAYS);
    TEST_ASSERT_GREATER_THAN_INT(WAYS / 2, harder);
}

/* A stretch of slope 1 of 100 u, and then 1 u of slope 20. */
static double over_stretch(double place, double velocity, double hard)
{
    points[0] = (MC_CAM_POINT){0, 0, 1, 0};
    points[1] = (MC_CAM_POINT){100, 100, 1, 0};
    points[2] = (MC_CAM_POINT){101, 120, 1, 0};
    compile(3, mcCamPolynomial5, true);
    const cm1e_cam_braking_t asked = {.master = place, .velocity = velocity, .own = 50, .gentle = 50 / steepest(),
                                      .hard = hard, .cycle_s = 1e-3};
    return hardest(asked);
}

static void test_the_way_that_is_left_counts(void)
{
    const double gentle = 50 / (over_stretch(10, 10, 1000), steepest());
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 50, over_stretch(10, 10, 1000)); /* 1 u of way */
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 20, over_stretch(10, 10, 20));
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 50, over_stretch(2, -10, 1000)); /* backwards */
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 50, over_stretch(202 * 5 + 10, 10, 1000)); /* some periods on */
    TEST_ASSERT_EQUAL_DOUBLE(gentle, over_stretch(99.5, 10, 1000));
    TEST_ASSERT_EQUAL_DOUBLE(gentle, over_stretch(0.5, -10, 1000));
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 50, over_stretch(98.5, 10, 1000));
}

/* Beside a single-shot cam the slave stands. Before it, the master comes onto it. */
static void test_beside_a_single_shot_cam_the_master_brakes_as_it_can(void)
{
    points[0] = (MC_CAM_POINT){0, 0, 0, 0};
    points[1] = (MC_CAM_POINT){1, 10, 0, 0};
    compile(2, mcCamPolynomial5, false);
    cm1e_cam_braking_t asked = {.master = 2, .velocity = 5, .own = 50, .gentle = 50 / steepest(), .hard = 100,
                                .cycle_s = 1e-3};
    TEST_ASSERT_EQUAL_DOUBLE(100, hardest(asked));
    asked.master = -3; /* 0.125 u are enough to stand */
    TEST_ASSERT_EQUAL_DOUBLE(100, hardest(asked));
    asked.master = -0.1;
    asked.velocity = 10; /* 0.5 u */
    TEST_ASSERT_TRUE(hardest(asked) >= asked.gentle);
    TEST_ASSERT_TRUE(hardest(asked) < 50);
}

/* More points than it looks at. */
static void test_a_way_over_too_many_points_is_braked_gently(void)
{
    for (int i = 0; i < 4096; i++)
        points[i] = (MC_CAM_POINT){i * 0.001, sin(i * 0.001), 0, 0};
    compile(4096, mcCamCubicSpline, true);
    cm1e_cam_braking_t asked = {.master = 0.5, .velocity = 2, .own = 50, .gentle = 1, .hard = 1.1, .cycle_s = 1e-5};
    TEST_ASSERT_EQUAL_DOUBLE(1, hardest(asked));
    asked.velocity = 1;
    asked.hard = 40;
    TEST_ASSERT_TRUE(hardest(asked) > 30);
}

/* What several slaves of a master ask in a cycle. */
static void test_all_who_ask_in_a_cycle_share_its_steps(void)
{
    int steps = CM1E_CAM_BRAKING_STEPS;
    cm1e_cam_braking_t asked = {.master = 10, .velocity = 10, .own = 50, .hard = 1000, .cycle_s = 1e-3, .steps = &steps};
    (void)over_stretch(10, 10, 1000);
    asked.gentle = 50 / steepest();
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 50, cm1e_cam_hardest_braking(&cam, &asked));
    TEST_ASSERT_INT_WITHIN(CM1E_CAM_BRAKING_STEPS / 4, CM1E_CAM_BRAKING_STEPS * 3 / 4, steps);
    for (int n = 0; n < 100; n++)
        (void)cm1e_cam_hardest_braking(&cam, &asked);
    TEST_ASSERT_EQUAL_INT(0, steps);
    TEST_ASSERT_EQUAL_DOUBLE(asked.gentle, cm1e_cam_hardest_braking(&cam, &asked));
}

int main(void)
{
    UNITY_BEGIN();
    seed_random();
    RUN_TEST(test_the_slave_never_brakes_harder_than_it_may);
    RUN_TEST(test_the_way_that_is_left_counts);
    RUN_TEST(test_beside_a_single_shot_cam_the_master_brakes_as_it_can);
    RUN_TEST(test_a_way_over_too_many_points_is_braked_gently);
    RUN_TEST(test_all_who_ask_in_a_cycle_share_its_steps);
    return UNITY_END();
}
