/* The ring of the last records: numbers, what is lost, and a reader beside the writer. */
#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <string.h>

#include "core/history.h"
#include "unity.h"

enum { KEPT = 4, SEEN = 5000, PARTS = 128 };

/** Long, so that the writer often comes past while a reader copies it. */
typedef struct record {
    uint64_t number;
    uint32_t parts[PARTS];
} record_t;

static const cm1e_history_shape_t shape = {KEPT, sizeof(record_t) / sizeof(uint64_t)};
static uint64_t ring[CM1E_HISTORY_WORDS(KEPT, record_t)];
static record_t got[KEPT];

void setUp(void) { memset(ring, 0, sizeof ring); }
void tearDown(void) {}

static void add(uint32_t n)
{
    record_t record = {.number = 77};
    for (uint32_t i = 0; i < PARTS; i++)
        record.parts[i] = n + i;
    cm1e_history_add(ring, shape, &record);
}

static void check_whole(const record_t *record, uint64_t number)
{
    TEST_ASSERT_EQUAL_UINT64(number, record->number);
    for (uint32_t i = 0; i < PARTS; i++)
        TEST_ASSERT_EQUAL_UINT32(number + i, record->parts[i]);
}

static size_t copy(uint64_t after, size_t room, uint64_t *lost)
{
    return cm1e_history_copy(ring, shape, after, got, room, lost);
}

static void test_an_empty_ring_has_nothing(void)
{
    uint64_t lost = 9;
    TEST_ASSERT_EQUAL_size_t(0, copy(0, KEPT, &lost));
    TEST_ASSERT_EQUAL_UINT64(0, lost);
    TEST_ASSERT_EQUAL_UINT64(0, cm1e_history_last(ring));
}

static void test_the_ring_counts_and_says_what_is_no_longer_kept(void)
{
    uint64_t lost;
    for (uint32_t n = 1; n <= 3; n++)
        add(n);
    TEST_ASSERT_EQUAL_size_t(2, copy(1, KEPT, &lost));
    TEST_ASSERT_EQUAL_UINT64(0, lost);
    TEST_ASSERT_EQUAL_UINT64(2, got[0].number);
    for (uint32_t n = 4; n <= KEPT + 5; n++)
        add(n);
    TEST_ASSERT_EQUAL_size_t(KEPT, copy(2, KEPT, &lost));
    TEST_ASSERT_EQUAL_UINT64(3, lost);
    for (uint32_t i = 0; i < KEPT; i++)
        check_whole(&got[i], 6 + i);
    TEST_ASSERT_EQUAL_size_t(2, copy(7, 2, NULL));
    TEST_ASSERT_EQUAL_UINT64(8, got[0].number);
    TEST_ASSERT_EQUAL_size_t(0, copy(KEPT + 5, KEPT, &lost));
    TEST_ASSERT_EQUAL_size_t(0, copy(KEPT + 50, KEPT, &lost));
}

static void test_numbers_go_on_where_they_are_told(void)
{
    cm1e_history_go_on_after(ring, 1000);
    add(1);
    TEST_ASSERT_EQUAL_size_t(1, copy(1000, KEPT, NULL));
    TEST_ASSERT_EQUAL_UINT64(1001, got[0].number);
    TEST_ASSERT_EQUAL_UINT64(1001, cm1e_history_last(ring));
}

static atomic_bool enough;

/** Returns how many it wrote. */
static void *write_on(void *unused)
{
    uintptr_t n = 0;
    (void)unused;
    while (!atomic_load(&enough))
        add((uint32_t)++n);
    return (void *)n;
}

static void test_a_reader_beside_the_writer_gets_whole_records_in_a_row(void)
{
    pthread_t writer;
    uint64_t after = 0, seen = 0, missed = 0, lost;
    void *written;
    atomic_store(&enough, false);
    TEST_ASSERT_EQUAL_INT(0, pthread_create(&writer, NULL, write_on, NULL));
    for (bool last = false; !last;) {
        if (seen >= SEEN && !atomic_exchange(&enough, true))
            pthread_join(writer, &written);
        last = atomic_load(&enough);
        const size_t count = copy(after, KEPT, &lost);
        for (size_t i = 0; i < count; i++)
            check_whole(&got[i], after + lost + 1 + i);
        seen += count;
        missed += count ? lost : 0;
        after = count ? got[count - 1].number : after;
    }
    TEST_ASSERT_EQUAL_UINT64((uintptr_t)written, seen + missed);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_an_empty_ring_has_nothing);
    RUN_TEST(test_the_ring_counts_and_says_what_is_no_longer_kept);
    RUN_TEST(test_numbers_go_on_where_they_are_told);
    RUN_TEST(test_a_reader_beside_the_writer_gets_whole_records_in_a_row);
    return UNITY_END();
}
