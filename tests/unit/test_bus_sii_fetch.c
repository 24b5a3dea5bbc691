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

/* A look counts as 5 ms at most, and the memory has 60 ms. */
static void test_a_slow_master_gives_up_too(void)
{
    TEST_ASSERT_EQUAL(60 / 5, fetch_words(1000 * ms, 1000000 * ms));
    TEST_ASSERT_TRUE(fetch.failed && !fetch.lost);
}

/* It answers: that its interface refuses says nothing of its power. */
static void test_a_slave_that_refuses_requests_is_not_lost(void)
{
    refuses = true;
    fetch_words(50 * us, 0);
    TEST_ASSERT_TRUE(fetch.failed && !fetch.lost);
}

/* ---- an interface as a controller has it, with a memory in which each word is another one -------------------------- */

static struct {
    unsigned group;              /* bytes that it reads at once */
    bool errors;                 /* of an earlier command: it takes no command before they are cleared */
    unsigned nacks;              /* so many commands are not acknowledged */
    unsigned lose_from, lose;    /* so many datagrams from this one on are not answered */
    bool accepted;               /* those that are not answered have been accepted */
    unsigned lose_asks;          /* so many requests to read are not answered */
    unsigned datagrams, asks, clears;
    uint32_t word;
    bool nack;
    int64_t nacked_ns;
} chip;

static uint16_t word_of_chip(uint32_t word) { return (uint16_t)(0x1234 + 7 * word); }

static void command(const cm1e_datagram_t *d)
{
    const uint16_t value = cm1e_get_u16(d->data);
    if (d->length == 2) {
        TEST_ASSERT_EQUAL_HEX16(EEPROM_NOP, value);
        chip.errors = chip.nack = false;
        chip.clears++;
        return;
    }
    TEST_ASSERT_EQUAL(EEPROM_GROUP_AT, d->length);
    TEST_ASSERT_EQUAL_HEX16(EEPROM_READ, value);
    TEST_ASSERT_FALSE(chip.errors || chip.nack);
    TEST_ASSERT_TRUE(chip.nacked_ns == 0 || now_ns >= chip.nacked_ns + 1 * ms);
    chip.asks++;
    chip.word = cm1e_get_u32(d->data + 2);
    chip.nack = chip.nacks > 0;
    if (chip.nack) {
        chip.nacks--;
        chip.nacked_ns = now_ns;
    }
}

static void serve(cm1e_datagram_t *d)
{
    const unsigned n = chip.datagrams++;
    const bool asks = d->command == COMMAND_FPWR && d->length > 2;
    bool lost = n >= chip.lose_from && n < chip.lose_from + chip.lose;
    if (asks && chip.lose_asks > 0) {
        chip.lose_asks--;
        lost = true;
    }
    TEST_ASSERT_EQUAL_HEX16(STATION, d->address);
    TEST_ASSERT_EQUAL_HEX16(REG_EEPROM_CONTROL, d->offset);
    d->working_counter = lost ? 0 : 1;
    if (d->command == COMMAND_FPWR && (!lost || chip.accepted))
        command(d);
    if (d->command == COMMAND_FPWR || lost)
        return;
    TEST_ASSERT_EQUAL(EEPROM_GROUP_AT + 8, d->length); /* the registers of the interface, and none behind them */
    memset(d->data, 0xEE, d->length);
    cm1e_put_u16(d->data, (uint16_t)((chip.group == 8 ? EEPROM_READS_8 : 0) | (chip.nack ? EEPROM_NACK : 0) |
                                     (chip.errors ? EEPROM_NOT_ENABLED : 0)));
    for (unsigned i = 0; i < chip.group / 2; i++)
        cm1e_put_u16(d->data + EEPROM_GROUP_AT + 2 * i, word_of_chip(chip.word + i));
}

/* Whether these words came; then they are the right ones. */
static bool fetched(uint16_t word, uint16_t count)
{
    uint8_t bytes[2 * 32];
    memset(bytes, 0, sizeof bytes);
    while (!cm1e_sii_fetched(&fetch, word, count, bytes)) {
        if (cm1e_sii_fetch_idle(&fetch))
            return false;
        while (!cm1e_sii_fetch_idle(&fetch)) {
            cm1e_datagram_t d;
            memset(&d, 0x55, sizeof d);
            now_ns += 50 * us;
            if (!cm1e_sii_fetch_next(&fetch, &d, now_ns))
                continue;
            serve(&d);
            cm1e_sii_fetch_result(&fetch, &d, now_ns);
        }
        cm1e_datagram_t none;
        TEST_ASSERT_FALSE(cm1e_sii_fetch_next(&fetch, &none, now_ns));
    }
    for (unsigned i = 0; i < count; i++)
        TEST_ASSERT_EQUAL_HEX16(word_of_chip(word + i), cm1e_get_u16(bytes + 2 * i));
    return true;
}

static void begin(unsigned group)
{
    setUp();
    memset(&chip, 0, sizeof chip);
    chip.group = group;
}

/* No word is asked for twice, and none behind the last. */
static void test_any_words_come_as_they_are(void)
{
    for (unsigned group = 4; group <= 8; group += 4) {
        for (unsigned n = 0; n < 32 * 2; n++) {
            const unsigned count = 1 + n / 2, each = group / 2, all = (count + each - 1) / each;
            const uint16_t word = n % 2 ? (uint16_t)(CM1E_FETCH_WORDS - count) : 0x0B;
            begin(group);
            TEST_ASSERT_TRUE(fetched(word, (uint16_t)count));
            TEST_ASSERT_EQUAL(all, chip.asks);
            TEST_ASSERT_TRUE(fetched(word, (uint16_t)count));
            TEST_ASSERT_EQUAL(all, chip.asks);
            if (n % 2 == 0)
                TEST_ASSERT_TRUE(fetched(word - 3, 4));
            TEST_ASSERT_FALSE(fetched((uint16_t)(CM1E_FETCH_WORDS - count + 1), (uint16_t)count));
        }
    }
}

/* Two datagrams in a row may be lost anywhere; with the third one the slave is lost. */
static void test_lost_datagrams_are_repeated(void)
{
    enum { SENT = 6 }; /* the status, the command that clears, and two for each group */
    for (unsigned n = 0; n < 2 * 4 * 12; n++) {
        begin(8);
        chip.errors = true; /* also the command that clears them may be lost */
        chip.accepted = n % 2;
        chip.lose = 1 + n / 2 % 4;
        chip.lose_from = n / 8;
        TEST_ASSERT_EQUAL(chip.lose < 3 || chip.lose_from >= SENT, fetched(0x40, 8));
        TEST_ASSERT_EQUAL(chip.lose >= 3 && chip.lose_from < SENT, fetch.failed);
        TEST_ASSERT_EQUAL(fetch.failed, fetch.lost);
        TEST_ASSERT_EQUAL(!fetch.failed, fetched(0x40, 8));
    }
    for (unsigned asks = 1; asks < 5; asks++) { /* each request to read, while all else is answered: it is not lost */
        begin(8);
        chip.lose_asks = asks;
        TEST_ASSERT_EQUAL(asks < 3, fetched(0x40, 4));
        TEST_ASSERT_EQUAL(asks >= 3, fetch.failed);
        TEST_ASSERT_FALSE(fetch.lost);
    }
    begin(8);
    chip.lose_asks = 2;
    TEST_ASSERT_TRUE(fetched(0x40, 4));
    chip.lose_asks = 2; /* each group has its own tries */
    TEST_ASSERT_TRUE(fetched(0x60, 4));
}

/* A memory that is busy itself does not acknowledge. It gets a pause, and is asked three times. */
static void test_words_that_were_not_acknowledged_are_read_again(void)
{
    for (unsigned nacks = 0; nacks < 6; nacks++) {
        begin(4);
        chip.nacks = nacks;
        TEST_ASSERT_EQUAL(nacks < 3, fetched(0x40, 2));
        TEST_ASSERT_EQUAL(nacks < 3 ? nacks + 1 : 3, chip.asks);
        TEST_ASSERT_EQUAL(nacks >= 3, fetch.failed);
        TEST_ASSERT_FALSE(fetch.lost);
    }
    begin(4);
    chip.errors = true;
    TEST_ASSERT_TRUE(fetched(0x40, 2));
    TEST_ASSERT_EQUAL(1, chip.clears);
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
    RUN_TEST(test_any_words_come_as_they_are);
    RUN_TEST(test_lost_datagrams_are_repeated);
    RUN_TEST(test_words_that_were_not_acknowledged_are_read_again);
    return UNITY_END();
}
