/** The controller of the cycle, without a bus: convergence, limits, noise, outliers, lost frames. */
#include <math.h>
#include <stdlib.h>

#include "bus/dc_pace.h"
#include "unity.h"

enum { CYCLE = 1000000 };

static cm1e_dc_pace_t pace;
static double planned_ns, drift, noise_ns;
static uint32_t chance;

void setUp(void)
{
    pace = (cm1e_dc_pace_t){0};
    cm1e_dc_pace_begin(&pace, CYCLE);
    planned_ns = drift = noise_ns = 0;
    chance = 1;
}
void tearDown(void) {}

static double random_part(void) { return (double)((chance = chance * 1664525u + 1013904223u) >> 8) / (1 << 24); }

/* Time of the reference clock when the frame of this cycle passes it. */
static int64_t reference(double late_ns)
{
    return (int64_t)floor((planned_ns + late_ns) * (1 + drift) + 0.5);
}

static int64_t cycle(void)
{
    const int64_t later = cm1e_dc_pace_step(&pace, reference(noise_ns * random_part()));
    planned_ns += CYCLE + (double)later;
    return later;
}

/* What is left out is at most half a nanosecond, and comes later. */
static void test_whole_nanoseconds_lose_nothing(void)
{
    double wanted_ns = 0, given_ns = 0;
    pace.rate_ns = 0.3;
    for (int i = 1; i < 1000; i++) {
        wanted_ns += 0.3;
        given_ns += (double)cm1e_dc_pace_coast(&pace);
        TEST_ASSERT_TRUE(fabs(wanted_ns - given_ns) <= 0.5 + 1e-6);
    }
}

static void test_the_phase_is_that_of_the_nearest_raster(void)
{
    static const int64_t rows[][3] = {
        {0, 1000, 0}, {1, 1000, 1}, {499, 1000, 499}, {500, 1000, 500}, {501, 1000, -499}, {999, 1000, -1},
        {1000, 1000, 0}, {7400, 1000, 400}, {7600, 1000, -400}, {-1, 1000, -1}, {-500, 1000, -500}, {-501, 1000, 499},
        {-999, 1000, 1}, {-7600, 1000, 400}, {2, 5, 2}, {3, 5, -2}, {-2, 5, -2}, {-3, 5, 2},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
        TEST_ASSERT_EQUAL_INT64(rows[i][2], cm1e_dc_phase(rows[i][0], rows[i][1]));
}

static void run(unsigned n)
{
    for (unsigned i = 0; i < n; i++)
        cycle();
}

static double phase(void) { return (double)cm1e_dc_phase(reference(0), CYCLE); }

static void test_every_phase_is_reached_from_every_other(void)
{
    for (int begin = -490; begin <= 490; begin += 70) {
        setUp();
        planned_ns = begin * 1000;
        drift = 80e-6;
        unsigned cycles = 0;
        for (; !cm1e_dc_pace_settled(&pace); cycles++)
            cycle();
        TEST_ASSERT_LESS_THAN_UINT(4000, cycles);
        run(3000);
        TEST_ASSERT_DOUBLE_WITHIN(2, 0, phase());
    }
}

static void test_no_cycle_is_much_longer_or_shorter(void)
{
    planned_ns = 400000;
    drift = 500e-6;
    for (int i = 0; i < 10000; i++)
        TEST_ASSERT_LESS_OR_EQUAL_INT64(CYCLE / CM1E_PACE_STEP, llabs(cycle()));
    TEST_ASSERT_DOUBLE_WITHIN(3, 0, phase());
}

static void test_it_never_learns_more_than_a_crystal_can_differ(void)
{
    drift = 900e-6;
    for (int i = 0; i < 20000; i++) {
        cycle();
        TEST_ASSERT_TRUE(fabs(pace.rate_ns) <= CYCLE / CM1E_PACE_RATE + 1e-9);
    }
}

/* An ordinary kernel wakes up to 40 us late, at random. */
static void test_wake_up_latency_is_averaged_out(void)
{
    drift = 50e-6;
    noise_ns = 15000;
    run(20000);
    double sum = 0, worst = 0;
    for (int i = 0; i < 20000; i++) {
        const double later = (double)cycle() + 50;
        sum += phase();
        worst = fmax(worst, fabs(later));
    }
    TEST_ASSERT_DOUBLE_WITHIN(200, -7500, sum / 20000); /* the mean of the latency is compensated */
    TEST_ASSERT_TRUE(worst < 300);                      /* 300 ppm of jitter of a cycle, of 15000 ppm latency */
}

static void test_single_late_frames_change_nothing(void)
{
    drift = 50e-6;
    run(20000);
    const double rate = pace.rate_ns;
    for (int i = 0; i < 100; i++) {
        const int64_t later = cm1e_dc_pace_step(&pace, reference(250000));
        planned_ns += CYCLE + (double)later;
        run(50);
        TEST_ASSERT_DOUBLE_WITHIN(2, 0, phase());
    }
    TEST_ASSERT_DOUBLE_WITHIN(0.1, rate, pace.rate_ns);
}

static void test_the_learnt_rate_bridges_lost_frames(void)
{
    drift = -120e-6;
    run(20000);
    for (int i = 0; i < 10000; i++)
        planned_ns += CYCLE + (double)cm1e_dc_pace_coast(&pace);
    TEST_ASSERT_DOUBLE_WITHIN(200, 0, phase()); /* after 10 s */
}

static void test_a_new_beginning_keeps_the_rate_of_the_same_cycle_time(void)
{
    drift = 100e-6;
    run(20000);
    cm1e_dc_pace_begin(&pace, CYCLE);
    TEST_ASSERT_DOUBLE_WITHIN(0.5, -100, pace.rate_ns);
    cm1e_dc_pace_begin(&pace, CYCLE / 4);
    TEST_ASSERT_TRUE(pace.rate_ns == 0);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_whole_nanoseconds_lose_nothing);
    RUN_TEST(test_the_phase_is_that_of_the_nearest_raster);
    RUN_TEST(test_every_phase_is_reached_from_every_other);
    RUN_TEST(test_no_cycle_is_much_longer_or_shorter);
    RUN_TEST(test_it_never_learns_more_than_a_crystal_can_differ);
    RUN_TEST(test_wake_up_latency_is_averaged_out);
    RUN_TEST(test_single_late_frames_change_nothing);
    RUN_TEST(test_the_learnt_rate_bridges_lost_frames);
    RUN_TEST(test_a_new_beginning_keeps_the_rate_of_the_same_cycle_time);
    return UNITY_END();
}
