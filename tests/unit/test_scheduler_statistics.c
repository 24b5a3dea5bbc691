/** The statistics: how times are counted, and whose numbers those of all buses are. */
#include <string.h>

#include "scheduler/statistics.h"
#include "unity.h"

static statistics_t statistics;
static cm1e_scheduler_statistics_t seen;

void setUp(void)
{
    statistics = (statistics_t){0};
    memset(&seen, 0xA5, sizeof seen); /* a caller may give any memory */
}

void tearDown(void) {}

/* ---- times ------------------------------------------------------------------------------------------------------- */

static void test_the_buckets_begin_at_powers_of_two(void)
{
    distribution_t distribution = {0};
    cm1e_distribution_t copy;
    int64_t count = 0, sum_ns = 0;
    for (unsigned bucket = 0; bucket < CM1E_HISTOGRAM_BUCKETS + 2; bucket++) {
        const int64_t from_ns = bucket ? (INT64_C(1000) << (bucket - 1)) : 0, to_ns = (INT64_C(1000) << bucket) - 1;
        cm1e_distribution_add(&distribution, from_ns);
        cm1e_distribution_add(&distribution, to_ns);
        sum_ns += from_ns + to_ns;
        count += 2;
        cm1e_distribution_read(&distribution, &copy);
        TEST_ASSERT_EQUAL_UINT64(count, copy.count);
        TEST_ASSERT_EQUAL_INT64(sum_ns, copy.sum_ns);
        TEST_ASSERT_EQUAL_INT64(to_ns, copy.maximum_ns);
        TEST_ASSERT_EQUAL_INT64(0, copy.minimum_ns);
        for (unsigned i = 0; i < CM1E_HISTOGRAM_BUCKETS; i++) /* the last one has all that are longer */
            TEST_ASSERT_EQUAL_UINT64(i < CM1E_HISTOGRAM_BUCKETS - 1 || bucket < i ? (i <= bucket ? 2 : 0)
                                                                                  : 2 * (bucket - i + 1),
                                     copy.histogram[i]);
    }
}

static void test_the_first_time_is_minimum_and_maximum(void)
{
    static const int64_t times_ns[] = {5000, -3, 7000, 6000};
    static const int64_t minimum_ns[] = {5000, -3, -3, -3}, maximum_ns[] = {5000, 5000, 7000, 7000};
    distribution_t distribution = {0};
    cm1e_distribution_t copy;
    for (int i = 0; i < 4; i++) {
        cm1e_distribution_add(&distribution, times_ns[i]);
        cm1e_distribution_read(&distribution, &copy);
        TEST_ASSERT_EQUAL_INT64(minimum_ns[i], copy.minimum_ns);
        TEST_ASSERT_EQUAL_INT64(maximum_ns[i], copy.maximum_ns);
    }
}

/* ---- buses ------------------------------------------------------------------------------------------------------- */

/** Bus n has 10^n times the numbers of the first one. */
static void test_the_numbers_of_all_buses_are_summed_and_the_cycles_are_those_of_the_first(void)
{
    static const cm1e_bus_counters_t first = {1, 2, 3, 4, 5, 6, 7}, all = {1, 2222, 3333, 4444, 5555, 6666, 7777};
    for (uint32_t n = 0, scale = 1; n < CM1E_MAX_BUSES; n++, scale *= 10) {
        const cm1e_bus_counters_t numbers = {
            .cycles = first.cycles * scale,
            .lost_frames = first.lost_frames * scale,
            .working_counter_errors = first.working_counter_errors * scale,
            .late_frames = first.late_frames * scale,
            .foreign_frames = first.foreign_frames * scale,
            .unsent_frames = first.unsent_frames * scale,
            .mailbox_retries = first.mailbox_retries * scale,
        };
        cm1e_bus_counters_t own;
        cm1e_statistics_note_bus(&statistics, n, &numbers, 8 * scale);
        TEST_ASSERT_EQUAL_UINT64(8 * scale, cm1e_statistics_read_bus(&statistics, n, &own));
        TEST_ASSERT_EQUAL_MEMORY(&numbers, &own, sizeof own);
    }
    cm1e_statistics_read(&statistics, &seen);
    TEST_ASSERT_EQUAL_MEMORY(&all, &seen.bus, sizeof all);
    TEST_ASSERT_EQUAL_UINT64(8888, seen.clocks.sync_losses);
}

static void test_clocks_are_those_of_a_bus_that_has_some(void)
{
    const cm1e_bus_clocks_t clocks = {.used = true, .reference = 3, .reference_ns = INT64_MAX - 1, .rate_ppm = -12.345,
                                      .phase_error_ns = -17, .phase_mean_ns = -4, .phase_maximum_ns = 900},
                            none = {.reference = 7, .reference_ns = 1};
    cm1e_statistics_note_clocks(&statistics, &none);
    cm1e_statistics_read(&statistics, &seen);
    TEST_ASSERT_FALSE(seen.clocks.used);
    TEST_ASSERT_EQUAL(0, seen.clocks.reference);
    cm1e_statistics_note_clocks(&statistics, &clocks);
    cm1e_statistics_note_clocks(&statistics, &none);
    cm1e_statistics_read(&statistics, &seen);
    TEST_ASSERT_TRUE(seen.clocks.used);
    TEST_ASSERT_EQUAL(clocks.reference, seen.clocks.reference);
    TEST_ASSERT_EQUAL_INT64(clocks.reference_ns, seen.clocks.reference_ns);
    TEST_ASSERT_EQUAL_DOUBLE(clocks.rate_ppm, seen.clocks.rate_ppm);
    TEST_ASSERT_EQUAL_INT64(clocks.phase_error_ns, seen.clocks.phase_error_ns);
    TEST_ASSERT_EQUAL_DOUBLE(clocks.phase_mean_ns, seen.clocks.phase_mean_ns);
    TEST_ASSERT_EQUAL_INT64(clocks.phase_maximum_ns, seen.clocks.phase_maximum_ns);
}

/* ---- real time --------------------------------------------------------------------------------------------------- */

static void test_texts_are_shown_when_they_are_complete(void)
{
    strcpy(statistics.control_socket, "socket");
    strcpy(statistics.control_advice, "advice of the socket");
    cm1e_statistics_read(&statistics, &seen);
    TEST_ASSERT_EQUAL_STRING("", seen.advice);
    TEST_ASSERT_EQUAL_STRING("", seen.control_socket);
    TEST_ASSERT_EQUAL_STRING("", seen.control_advice);
    TEST_ASSERT_FALSE(seen.realtime);
    cm1e_statistics_publish_realtime(&statistics, true, "advice");
    cm1e_statistics_read(&statistics, &seen);
    TEST_ASSERT_EQUAL_STRING("advice", seen.advice);
    TEST_ASSERT_EQUAL_STRING("socket", seen.control_socket);
    TEST_ASSERT_EQUAL_STRING("advice of the socket", seen.control_advice);
    TEST_ASSERT_TRUE(seen.realtime);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_buckets_begin_at_powers_of_two);
    RUN_TEST(test_the_first_time_is_minimum_and_maximum);
    RUN_TEST(test_the_numbers_of_all_buses_are_summed_and_the_cycles_are_those_of_the_first);
    RUN_TEST(test_clocks_are_those_of_a_bus_that_has_some);
    RUN_TEST(test_texts_are_shown_when_they_are_complete);
    return UNITY_END();
}
