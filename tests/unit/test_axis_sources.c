/* The sources of set-points: what each of them has to be able to do. */
#include "../support/axis_bench.h"
#include "coupling/coupling_private.h"
#include "homing/homing_private.h"

void setUp(void) { bench_start(); }

void tearDown(void) { bench_end(); }

static const source_t *const sources[] = {
    &cm1e_source_free,  &cm1e_source_hold,     &cm1e_source_profile, &cm1e_source_table,
    &cm1e_source_drive, &cm1e_source_homing,   &cm1e_source_leader,  &cm1e_source_coupling,
    &cm1e_source_outside,
};
enum { SOURCES = sizeof sources / sizeof sources[0] };

static void test_every_source_can_do_what_it_is_asked(void)
{
    for (int i = 0; i < SOURCES; i++) {
        const source_t *source = sources[i];
        char where[16];
        snprintf(where, sizeof where, "source %d", i);
        TEST_ASSERT_TRUE_MESSAGE(source->step && source->stop, where);
        TEST_ASSERT_TRUE_MESSAGE(!source->moves || source->find_stretch || source->begin_anew, where);
        TEST_ASSERT_FALSE_MESSAGE(source->moves && source->by_drive, where);
        TEST_ASSERT_TRUE_MESSAGE(!source->homes || source->by_drive, where);
        TEST_ASSERT_TRUE_MESSAGE(!source->moves || source->keeps, where); /* else a limit would be taken that it leaves */
        TEST_ASSERT_TRUE_MESSAGE(!source->find_stretch || (source->moves && source->goes), where);
    }
}

static int left;

static void count_leave(cm1e_axis_t *one)
{
    (void)one;
    left++;
}

static void test_a_source_is_left_once(void)
{
    source_t source = cm1e_source_profile;
    source.leave = count_leave;
    left = 0;
    cm1e_axis_set_source(axis, &source);
    cm1e_axis_set_source(axis, &source);
    TEST_ASSERT_EQUAL_INT(0, left);
    cm1e_axis_set_source(axis, &cm1e_source_free);
    cm1e_axis_set_source(axis, &cm1e_source_free);
    TEST_ASSERT_EQUAL_INT(1, left);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_source_can_do_what_it_is_asked);
    RUN_TEST(test_a_source_is_left_once);
    return UNITY_END();
}
