/* The list of strangers: one thread changes it, another one reads it. */
#include <pthread.h>
#include <sched.h>
#include <stdlib.h>
#include <string.h>

#include "bus/bus_internal.h"
#include "unity.h"

static cm1e_bus_t *bus;
static int over;

void setUp(void)
{
    bus = calloc(1, sizeof *bus);
    over = 0;
}

void tearDown(void) { free(bus); }

/** All of its numbers are alike, so one that is made of two shows. */
static cm1e_stranger_t stranger_of(uint16_t n)
{
    return (cm1e_stranger_t){.place = n, .alias = n, .explicit_id = n, .vendor_id = n, .product_code = n, .revision = n,
                             .serial_number = n};
}

/** Lists of one to eight, all of the same number. */
static void *change(void *context)
{
    (void)context;
    for (uint16_t n = 1; !__atomic_load_n(&over, __ATOMIC_RELAXED); n++) {
        cm1e_stranger_t strangers[CM1E_STRANGERS];
        const uint32_t count = 1 + n % CM1E_STRANGERS;
        for (uint32_t i = 0; i < count; i++)
            strangers[i] = stranger_of(n);
        cm1e_strangers_set(&bus->search.strangers, strangers, count);
    }
    return NULL;
}

static void test_a_reader_beside_the_writer_gets_one_list(void)
{
    pthread_t thread;
    unsigned lists = 0;
    TEST_ASSERT_EQUAL_INT(0, pthread_create(&thread, NULL, change, NULL));
    while (cm1e_strangers_count(&bus->search.strangers) == 0) /* on a busy machine the thread begins late */
        sched_yield();
    for (unsigned n = 0; n < 2000000; n++) {
        cm1e_stranger_t strangers[CM1E_STRANGERS];
        const size_t count = cm1e_bus_strangers(bus, strangers, CM1E_STRANGERS);
        lists += count > 0;
        for (size_t i = 0; i < count; i++) {
            const cm1e_stranger_t whole = stranger_of(strangers[0].place);
            TEST_ASSERT_EQUAL_MEMORY(&whole, &strangers[i], sizeof whole);
        }
        if (count > 0)
            TEST_ASSERT_EQUAL_UINT(1u + strangers[0].place % CM1E_STRANGERS, count);
    }
    __atomic_store_n(&over, 1, __ATOMIC_RELAXED);
    pthread_join(thread, NULL);
    TEST_ASSERT_GREATER_THAN(0, lists);
}

static void test_only_another_list_is_news(void)
{
    const cm1e_stranger_t two[2] = {stranger_of(3), stranger_of(4)};
    cm1e_stranger_t read[CM1E_STRANGERS];
    TEST_ASSERT_TRUE(cm1e_strangers_set(&bus->search.strangers, two, 2));
    TEST_ASSERT_FALSE(cm1e_strangers_set(&bus->search.strangers, two, 2));
    TEST_ASSERT_EQUAL_UINT(1, cm1e_bus_strangers(bus, read, 1));
    TEST_ASSERT_EQUAL_UINT(2, cm1e_bus_strangers(bus, read, CM1E_STRANGERS));
    TEST_ASSERT_EQUAL_MEMORY(two, read, sizeof two);
    TEST_ASSERT_TRUE(cm1e_strangers_set(&bus->search.strangers, two, 1));
    TEST_ASSERT_TRUE(cm1e_strangers_set(&bus->search.strangers, NULL, 0));
    TEST_ASSERT_EQUAL_UINT(0, cm1e_bus_strangers(bus, read, CM1E_STRANGERS));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_reader_beside_the_writer_gets_one_list);
    RUN_TEST(test_only_another_list_is_news);
    return UNITY_END();
}
