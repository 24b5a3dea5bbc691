/* Fetching words of the SII: how long a memory may take, and what the time of the master has to do with it. */
#include <string.h>

#include "bus/eeprom_interface.h"
#include "bus/sii_fetch.h"
#include "core/bytes.h"
#include "unity.h"

enum { STATION = 0x1001, WORD = 0x10, WORDS = 4 };
static const int64_t ms = 1000000, us = 1000;

static cm1e_sii_fetch_t fetch;
static int64_t now_ns;
static bool refuses;       /* its interface accepts no request */
static int stand_still_at; /* number of the exchange before which the master stands still; -1: never */

void setUp(void)
{
    memset(&fetch, 0, sizeof fetch);
    fetch.station = STATION;
    now_ns = 5 * ms;
    stand_still_at = -1;
    refuses = false;
}

void tearDown(void) {}

/* A memory that is busy until a time, and then has the same byte everywhere. */
static void answer(cm1e_datagram_t *d, int64_t busy_until_ns)
{
    d->working_counter = refuses && d->command != COMMAND_FPRD ? 0 : 1;
    if (d->command != COMMAND_FPRD)
        return;
    memset(d->data, 0x5A, d->length);
    cm1e_put_u16(d->data, (uint16_t)(EEPROM_READS_8 | (fetch.step == FETCH_TAKE && now_ns < busy_until_ns ? EEPROM_BUSY : 0)));
}

/* One exchange takes this long. Returns the exchanges until the words have come, or the fetch has failed. */
static int fetch_words(int64_t each_ns, int64_t busy_ns)
{
    const int64_t busy_until_ns = now_ns + busy_ns;
    uint8_t bytes[2 * WORDS];
    int exchanges = 0;
    while (!cm1e_sii_fetched(&fetch, WORD, WORDS, bytes) && !fetch.failed)
        while (!cm1e_sii_fetch_idle(&fetch)) {
            cm1e_datagram_t d = {0};
            now_ns += each_ns + (exchanges == stand_still_at ? 1000 * ms : 0);
            if (!cm1e_sii_fetch_next(&fetch, &d, now_ns))
                continue;
            answer(&d, busy_until_ns);
            cm1e_sii_fetch_result(&fetch, &d, now_ns);
            exchanges++;
        }
    return exchanges;
}

static void test_words_come_from_a_memory_that_takes_its_time(void)
{
    TEST_ASSERT_LESS_THAN(60, fetch_words(50 * us, 1 * ms));
    TEST_ASSERT_FALSE(fetch.failed);
}

static void test_a_memory_that_stays_busy_is_given_up(void)
{
    const int64_t before_ns = now_ns;
    fetch_words(50 * us, 1000000 * ms);
    TEST_ASSERT_TRUE(fetch.failed && !fetch.lost);
    TEST_ASSERT_INT64_WITHIN(2 * ms, before_ns + 60 * ms, now_ns);
}

/* The machine gave the master no processor for a second each time: the memory was ready all along. */
static void test_a_master_that_stands_still_does_not_give_up(void)
{
    fetch_words(1000 * ms, 1 * ms);
    TEST_ASSERT_FALSE(fetch.failed);
}

/* ... nor where that happens once, after it has looked many times at a memory that takes its time. */
static void test_a_master_that_stood_still_once_looks_again(void)
{
    for (int at = 0; at < 40; at++) {
        setUp();
        stand_still_at = at;
        fetch_words(50 * us, 3 * ms);
        TEST_ASSERT_FALSE(fetch.failed);
    }
}

static void test_a_slow_master_gives_up_too(void)
{
    TEST_ASSERT_LESS_THAN(16, fetch_words(1000 * ms, 1000000 * ms));
    TEST_ASSERT_TRUE(fetch.failed && !fetch.lost);
}

/* It answers: that its interface refuses says nothing of its power. */
static void test_a_slave_that_refuses_requests_is_not_lost(void)
{
    refuses = true;
    fetch_words(50 * us, 0);
    TEST_ASSERT_TRUE(fetch.failed && !fetch.lost);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_words_come_from_a_memory_that_takes_its_time);
    RUN_TEST(test_a_memory_that_stays_busy_is_given_up);
    RUN_TEST(test_a_master_that_stands_still_does_not_give_up);
    RUN_TEST(test_a_master_that_stood_still_once_looks_again);
    RUN_TEST(test_a_slow_master_gives_up_too);
    RUN_TEST(test_a_slave_that_refuses_requests_is_not_lost);
    return UNITY_END();
}
