/* The filter for a master's actual value: no lag, known noise, defined steps, lost samples, any number of counts. */
#include "motion/observer.h"
#include "motion_check.h"

static const double cycle_s = 1e-3, constant_s = 4e-3;

void setUp(void) {}
void tearDown(void) {}

static cm1e_observer_t observer;

static double estimate(double origin)
{
    const cm1e_observed_t now = cm1e_observer_now(&observer);
    return ((double)now.counts - origin) + now.offset;
}

/** Counts of a master in a motion of constant acceleration, whole ones. */
static double true_position(double velocity, double acceleration, double t)
{
    return velocity * t + acceleration * t * t / 2;
}

/** What errors of half a count in every sample can make at most, where each comes with the worst sign: the sum of what
 *  an error of one sample does from then on. */
static void worst_of_rounding(int delay, double *position, double *velocity)
{
    *position = *velocity = 0;
    cm1e_observer_init(&observer, cycle_s, constant_s, delay * cycle_s, 0);
    for (int i = 0; i < 400; i++) {
        cm1e_observer_step(&observer, i == 0, true);
        *position += fabs(estimate(0)) / 2;
        *velocity += fabs(cm1e_observer_now(&observer).velocity) / 2;
    }
}

/* A master in any motion of constant acceleration, its values some cycles old: the estimate has no lag, but for what
 * rounding to counts makes. */
static void test_no_lag_at_constant_acceleration(void)
{
    static const double velocities[] = {0, 3.7, -1234.5, 100000, -2.5e6}, accelerations[] = {0, 50, -10000, 1e6};
    for (int v = 0; v < 5; v++)
        for (int a = 0; a < 4; a++)
            for (int delay = 0; delay < 4; delay++) {
                double worst, fastest;
                worst_of_rounding(delay, &worst, &fastest);
                TEST_ASSERT_TRUE(worst < 2.5);
                cm1e_observer_init(&observer, cycle_s, constant_s, delay * cycle_s, 0);
                for (int i = 0; i < 400; i++) {
                    const double t = i * cycle_s;
                    const double old = true_position(velocities[v], accelerations[a], t - delay * cycle_s);
                    cm1e_observer_step(&observer, llround(old), true);
                    if (i < 300)
                        continue;
                    const double position = true_position(velocities[v], accelerations[a], t);
                    const double velocity = velocities[v] + accelerations[a] * t;
                    TEST_ASSERT_DOUBLE_WITHIN(worst + 1e-3, position, estimate(0));
                    TEST_ASSERT_DOUBLE_WITHIN(fastest + 1e-3, velocity, cm1e_observer_now(&observer).velocity);
                }
            }
}

/* Without rounding, at multiples of counts: exact. */
static void test_whole_counts_are_followed_exactly(void)
{
    cm1e_observer_init(&observer, cycle_s, constant_s, 2 * cycle_s, 1000);
    for (int64_t i = 0; i < 500; i++) { /* 7 i + i^2 counts after i cycles */
        cm1e_observer_step(&observer, 1000 + 7 * (i - 2) + (i - 2) * (i - 2), true);
        if (i < 300)
            continue;
        const cm1e_observed_t now = cm1e_observer_now(&observer);
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, (double)(7 * i + i * i), estimate(1000));
        TEST_ASSERT_DOUBLE_WITHIN(1e-2, (7 + 2 * (double)i) / cycle_s, now.velocity);
        TEST_ASSERT_DOUBLE_WITHIN(1, 2 / cycle_s / cycle_s, now.acceleration);
    }
}

static double measured_variance(double constant, bool of_velocity)
{
    enum { SAMPLED = 200000 };
    double sum = 0, squares = 0;
    cm1e_observer_init(&observer, cycle_s, constant, 0, 0);
    for (int i = 0; i < SAMPLED + 1000; i++) {
        const int64_t noise = (int64_t)(random_bits() % 20001) - 10000;
        cm1e_observer_step(&observer, noise, true);
        const double here = of_velocity ? cm1e_observer_now(&observer).velocity * cycle_s : estimate(0);
        if (i >= 1000) {
            sum += here;
            squares += here * here;
        }
    }
    const double mean = sum / SAMPLED, input = (20001.0 * 20001.0 - 1) / 12;
    return (squares / SAMPLED - mean * mean) / input;
}

/* What a fading memory of second degree makes of white noise is known in closed form: with t = exp(-cycle/constant)
 * the variance is (1-t)(1+6t+16t^2+24t^3+19t^4)/(1+t)^5 of the position, and of the velocity, in counts a cycle,
 * (1-t)^3 (13+50t+49t^2)/(2 (1+t)^5). */
static void test_noise_gain(void)
{
    static const double constants[] = {0, 2e-3, 4e-3, 20e-3};
    for (int i = 0; i < 4; i++) {
        const double t = constants[i] > 0 ? exp(-cycle_s / constants[i]) : 0, rest = 1 - t;
        const double position = rest * (1 + t * (6 + t * (16 + t * (24 + t * 19)))) / pow(1 + t, 5);
        const double velocity = rest * rest * rest * (13 + t * (50 + t * 49)) / (2 * pow(1 + t, 5));
        TEST_ASSERT_DOUBLE_WITHIN(0.04 * position, position, measured_variance(constants[i], false));
        TEST_ASSERT_DOUBLE_WITHIN(0.04 * velocity, velocity, measured_variance(constants[i], true));
    }
    /* 4 cycles: a little quieter than the samples in position */
    TEST_ASSERT_TRUE(measured_variance(4e-3, false) < 0.6);
}

/* A step of the position, which no master does: it is followed with a defined overshoot, and ends. */
static void test_a_step_of_position(void)
{
    double highest = 0;
    cm1e_observer_init(&observer, cycle_s, constant_s, 0, 0);
    for (int i = 0; i < 400; i++) {
        cm1e_observer_step(&observer, 1000, true);
        highest = fmax(highest, estimate(0));
        if (i >= 60) /* 15 time constants */
            TEST_ASSERT_DOUBLE_WITHIN(1, 1000, estimate(0));
    }
    TEST_ASSERT_TRUE(highest > 1100 && highest < 1300);
}

/* A step of velocity: once the filter has seen it, position and velocity are right again. */
static void test_a_step_of_velocity(void)
{
    double most = 0;
    cm1e_observer_init(&observer, cycle_s, constant_s, 0, 0);
    for (int i = 1; i < 400; i++) {
        cm1e_observer_step(&observer, 100 * i, true);
        most = fmax(most, fabs(100.0 * i - estimate(0)));
        if (i >= 80) {
            TEST_ASSERT_DOUBLE_WITHIN(0.1, 100.0 * i, estimate(0));
            TEST_ASSERT_DOUBLE_WITHIN(100, 100000, cm1e_observer_now(&observer).velocity);
        }
    }
    TEST_ASSERT_TRUE(most < 200);
}

static void test_lost_samples_cost_nothing_while_the_motion_goes_on(void)
{
    cm1e_observer_init(&observer, cycle_s, constant_s, cycle_s, 0);
    for (int64_t i = 0; i < 1000; i++) { /* 50 i + i^2 counts */
        const bool lost = i > 300 && (i % 7 < 3 || i % 50 < 10);
        cm1e_observer_step(&observer, lost ? -123456789 : 50 * (i - 1) + (i - 1) * (i - 1), !lost);
        if (i >= 300)
            TEST_ASSERT_DOUBLE_WITHIN(1e-4, (double)(50 * i + i * i), estimate(0));
    }
}

/* From rest at whole counts: at rest, exactly, and so it stays. */
static void test_rest_is_rest(void)
{
    cm1e_observer_init(&observer, cycle_s, constant_s, cycle_s, -77);
    for (int i = 0; i < 1000; i++) {
        cm1e_observer_step(&observer, -77, true);
        const cm1e_observed_t now = cm1e_observer_now(&observer);
        TEST_ASSERT_EQUAL_INT64(-77, now.counts);
        TEST_ASSERT_EQUAL_DOUBLE(0, now.offset);
        TEST_ASSERT_EQUAL_DOUBLE(0, now.velocity);
    }
    for (int i = 0; i < 200; i++) /* after a motion too */
        cm1e_observer_step(&observer, -77 + i, true);
    for (int i = 0; i < 400; i++)
        cm1e_observer_step(&observer, 122, true);
    const cm1e_observed_t now = cm1e_observer_now(&observer);
    TEST_ASSERT_EQUAL_INT64(122, now.counts);
    TEST_ASSERT_EQUAL_DOUBLE(0, now.offset);
    TEST_ASSERT_EQUAL_DOUBLE(0, now.velocity);
    TEST_ASSERT_EQUAL_DOUBLE(0, now.acceleration);
}

static void test_reset_forgets_everything_but_the_place(void)
{
    cm1e_observer_init(&observer, cycle_s, constant_s, cycle_s, 0);
    for (int i = 0; i < 100; i++)
        cm1e_observer_step(&observer, 1000 * i, true);
    cm1e_observer_reset(&observer, 5);
    TEST_ASSERT_EQUAL_DOUBLE(5, estimate(0));
    cm1e_observer_step(&observer, 5, true);
    TEST_ASSERT_EQUAL_DOUBLE(5, estimate(0));
    TEST_ASSERT_EQUAL_DOUBLE(0, cm1e_observer_now(&observer).velocity);
}

/* Two observers see the same motion, one of them 2^51 counts away: bit for bit the same. */
static void test_far_away_is_as_good_as_here(void)
{
    cm1e_observer_t far;
    const int64_t away = INT64_C(1) << 51;
    cm1e_observer_init(&observer, cycle_s, constant_s, cycle_s, 0);
    cm1e_observer_init(&far, cycle_s, constant_s, cycle_s, away);
    for (int i = 0; i < 20000; i++) {
        const int64_t counts = llround(20000 * sin(i * 0.001) + 33.3 * i);
        cm1e_observer_step(&observer, counts, true);
        cm1e_observer_step(&far, counts + away, true);
        const cm1e_observed_t a = cm1e_observer_now(&observer), b = cm1e_observer_now(&far);
        TEST_ASSERT_EQUAL_INT64(a.counts + away, b.counts);
        TEST_ASSERT_EQUAL_DOUBLE(a.offset, b.offset);
        TEST_ASSERT_EQUAL_DOUBLE(a.velocity, b.velocity);
    }
}

int main(void)
{
    UNITY_BEGIN();
    seed_random();
    RUN_TEST(test_no_lag_at_constant_acceleration);
    RUN_TEST(test_whole_counts_are_followed_exactly);
    RUN_TEST(test_noise_gain);
    RUN_TEST(test_a_step_of_position);
    RUN_TEST(test_a_step_of_velocity);
    RUN_TEST(test_lost_samples_cost_nothing_while_the_motion_goes_on);
    RUN_TEST(test_rest_is_rest);
    RUN_TEST(test_reset_forgets_everything_but_the_place);
    RUN_TEST(test_far_away_is_as_good_as_here);
    return UNITY_END();
}
