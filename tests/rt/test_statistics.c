/**
 * A distribution of the statistics, read while the cycle adds to it: what is read is of one moment.
 */
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>

#include "quick_check.h"
#include "scheduler/statistics.h"

enum { MOMENTS = 500, PAUSE = 100 };

static distribution_t distribution;
static atomic_bool seen_enough;

/** Each time is its own number, so count, sum, largest and smallest belong together. */
static void *add(void *unused)
{
    (void)unused;
    for (int64_t n = 1; !atomic_load(&seen_enough); n++) {
        cm1e_distribution_add(&distribution, n);
        for (volatile int i = 0; i < PAUSE; i++)
            ; /* so that a reader finds both: an adding and none */
    }
    return NULL;
}

START_TEST(test_a_reader_beside_the_writer_sees_one_moment)
{
    static statistics_t statistics;
    cm1e_scheduler_statistics_t seen;
    pthread_t writer;
    ck_assert_int_eq(pthread_create(&writer, NULL, add, NULL), 0);
    uint64_t last = 0;
    for (int moments = 0; moments < MOMENTS;) {
        cm1e_distribution_read(&distribution, &seen.cycle_time);
        const cm1e_distribution_t *copy = &seen.cycle_time;
        uint64_t counted = 0;
        for (unsigned i = 0; i < CM1E_HISTOGRAM_BUCKETS; i++)
            counted += copy->histogram[i];
        ck_assert_uint_eq(counted, copy->count);
        ck_assert_uint_ge(copy->count, last);
        ck_assert_int_eq(copy->sum_ns, (int64_t)(copy->count * (copy->count + 1) / 2));
        ck_assert_int_eq(copy->maximum_ns, (int64_t)copy->count);
        ck_assert_int_eq(copy->minimum_ns, copy->count > 0);
        moments += copy->count != last;
        last = copy->count;
    }
    atomic_store(&seen_enough, true);
    pthread_join(writer, NULL);
    printf("%d moments of %lu seen\n", MOMENTS, (unsigned long)last);
    cm1e_statistics_read(&statistics, &seen);
    ck_assert_uint_eq(seen.cycle_time.count, 0);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("statistics");
    TCase *tcase = tcase_create("statistics");
    tcase_add_test(tcase, test_a_reader_beside_the_writer_sees_one_moment);
    suite_add_tcase(suite, tcase);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
