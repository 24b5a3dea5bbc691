/** When the event log writes a record of a bus, of its slaves, and of devices that are none of them; what is in it; and that
 *  nothing is lost of what waits for the next record. */
#include <stdlib.h>
#include <string.h>

#include "bus/bus_internal.h"
#include "scheduler/event_log.h"
#include "unity.h"

#define MS INT64_C(1000000)
enum { NUMBER = 2, BURST = 8 }; /* of the bus; records of one kind that may follow each other at once */

enum { SLAVES = 3 };

static cm1e_bus_t *bus;
static log_t the_log;
static cm1e_log_event_t records[CM1E_LOG_EVENTS];
static size_t count;

void setUp(void)
{
    bus = calloc(1, sizeof *bus);
    bus->slaves = calloc(SLAVES, sizeof *bus->slaves);
    bus->slave_count = SLAVES;
    memset(&the_log, 0, sizeof the_log);
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_log_init(&the_log, cm1e_clock_monotonic(), NULL));
}

void tearDown(void)
{
    cm1e_log_free(&the_log);
    free(bus->slaves);
    free(bus);
}

static void look(int64_t run_ns)
{
    cm1e_log_presence(&the_log, bus, NUMBER, run_ns);
    cm1e_log_ports(&the_log, bus, NUMBER, run_ns);
    count = cm1e_log_copy(&the_log, 0, records, CM1E_LOG_EVENTS, NULL);
}

/* ---- counters ---------------------------------------------------------------------------------------------------- */

/** They grow in every cycle: one record at once, then one in 100 ms with what came meanwhile, and the rest at the end. */
static void test_counters_are_told_every_100_ms_and_at_the_end(void)
{
    enum { CYCLES = 250 };
    static const cm1e_log_kind_t kinds[] = {CM1E_LOG_LOST_FRAMES, CM1E_LOG_WORKING_COUNTER, CM1E_LOG_UNSENT_FRAMES,
                                            CM1E_LOG_OTHER_MASTER, CM1E_LOG_SYNC_LOST};
    enum { KINDS = sizeof kinds / sizeof kinds[0], RECORDS = 4 };
    static const uint32_t cycles[RECORDS] = {1, 101, 201, CYCLES};
    for (uint32_t n = 1; n <= CYCLES + 1; n++) {
        const uint32_t total = n < CYCLES ? n : CYCLES;
        const cm1e_bus_counters_t counters = {.lost_frames = 2 * total, .working_counter_errors = 3 * total,
                                              .unsent_frames = 4 * total, .foreign_frames = 5 * total};
        if (n == CYCLES + 1)
            cm1e_log_wait_no_longer(&the_log);
        cm1e_log_bus(&the_log, &counters, 6 * total, NUMBER, n * MS);
    }
    count = cm1e_log_copy(&the_log, 0, records, CM1E_LOG_EVENTS, NULL);
    TEST_ASSERT_EQUAL_size_t(KINDS * RECORDS, count);
    for (uint32_t i = 0; i < RECORDS; i++)
        for (uint32_t k = 0; k < KINDS; k++) {
            const cm1e_log_event_t *record = &records[i * KINDS + k];
            TEST_ASSERT_EQUAL(kinds[k], record->kind);
            TEST_ASSERT_EQUAL_INT64((cycles[i] + (i == RECORDS - 1)) * MS, record->run_ns);
            TEST_ASSERT_EQUAL_UINT32((k + 2) * cycles[i], record->detail);
            TEST_ASSERT_EQUAL_INT32((k + 2) * (cycles[i] - (i ? cycles[i - 1] : 0)), record->code);
            TEST_ASSERT_EQUAL_DOUBLE(NUMBER, record->value);
        }
}

/* ---- slaves ------------------------------------------------------------------------------------------------------ */

/** Of every port of every slave, each kind of fault by itself: at once, after a second, at the end. */
static void test_faults_of_ports_are_told_every_second_and_at_the_end(void)
{
    enum { CYCLES = 1500, PLACES = SLAVES * CM1E_PORTS * CM1E_PORT_FAULTS };
    for (int n = 0; n <= CYCLES; n++) {
        for (uint32_t place = 0; n < CYCLES && place < PLACES; place++)
            bus->slaves[place / CM1E_PORT_FAULTS / CM1E_PORTS].ports.total[place / CM1E_PORT_FAULTS % CM1E_PORTS]
                [place % CM1E_PORT_FAULTS] += 1 + place;
        bus->supervised.ports.news += n < CYCLES;
        if (n == CYCLES)
            cm1e_log_wait_no_longer(&the_log);
        look(n * MS);
    }
    TEST_ASSERT_EQUAL_size_t(3 * PLACES, count);
    for (uint32_t i = 0; i < count; i++) {
        static const int32_t at_ms[] = {0, 1000, CYCLES}, of_cycles[] = {1, 1000, CYCLES - 1001};
        const uint32_t place = i % PLACES, fault = place % CM1E_PORT_FAULTS, port = place / CM1E_PORT_FAULTS;
        TEST_ASSERT_EQUAL(CM1E_LOG_PORT, records[i].kind);
        TEST_ASSERT_EQUAL_INT64(at_ms[i / PLACES] * MS, records[i].run_ns);
        TEST_ASSERT_EQUAL_INT32((int32_t)(1 + place) * of_cycles[i / PLACES], records[i].code);
        TEST_ASSERT_EQUAL_HEX32(fault << 24 | NUMBER << 20 | port % CM1E_PORTS << 16 | (1 + port / CM1E_PORTS),
                                records[i].detail);
    }
}

/** The last slave comes or goes in every cycle: eight records at once, then one in a second with the number of changes. */
static void test_of_a_slave_that_comes_and_goes_all_changes_are_counted(void)
{
    enum { CYCLES = 3500, RECORDS = BURST + CYCLES / 1000 };
    for (int n = 0; n < CYCLES; n++) {
        bus->slaves[SLAVES - 1].hot.presence = n % 2 ? CM1E_PRESENCE_THERE : CM1E_PRESENCE_ABSENT;
        bus->search.news++;
        look(n * MS);
    }
    TEST_ASSERT_EQUAL_size_t(RECORDS, count);
    for (int i = 0; i < RECORDS; i++) {
        const int n = i < BURST ? i : (i - BURST + 1) * 1000;
        TEST_ASSERT_EQUAL(CM1E_LOG_SLAVE, records[i].kind);
        TEST_ASSERT_EQUAL_INT64(n * MS, records[i].run_ns);
        TEST_ASSERT_EQUAL(n % 2 ? CM1E_PRESENCE_THERE : CM1E_PRESENCE_ABSENT, records[i].code);
        TEST_ASSERT_EQUAL_HEX32(NUMBER << 24 | SLAVES, records[i].detail);
        TEST_ASSERT_EQUAL_DOUBLE(i < BURST ? 0 : i == BURST ? 1000 - BURST : 999, records[i].bound);
    }
    cm1e_log_wait_no_longer(&the_log);
    look(CYCLES * MS);
    TEST_ASSERT_EQUAL_size_t(RECORDS + 1, count);
    TEST_ASSERT_EQUAL_DOUBLE(CYCLES - 3001 - 1, records[RECORDS].bound);
}

/* ---- strangers --------------------------------------------------------------------------------------------------- */

/** Every number of it differs. */
static cm1e_stranger_t stranger_of(uint32_t n)
{
    return (cm1e_stranger_t){.place = (uint16_t)(n + 1), .alias = (uint16_t)(n + 2), .explicit_id = (uint16_t)(n + 3),
                             .vendor_id = 0xF0000000u + n, .product_code = 0xE0000000u + n};
}

static void set(const cm1e_stranger_t *strangers, uint32_t of_them)
{
    bus->search.news += cm1e_strangers_set(&bus->search.strangers, strangers, of_them);
}

static void test_each_stranger_is_told_once_with_its_numbers(void)
{
    cm1e_stranger_t both[2] = {stranger_of(10), stranger_of(20)};
    set(both, 2);
    for (int cycle = 1; cycle < 5; cycle++)
        look(cycle * MS);
    TEST_ASSERT_EQUAL_size_t(2, count);
    for (uint32_t i = 0; i < 2; i++) {
        TEST_ASSERT_EQUAL(CM1E_LOG_STRANGER, records[i].kind);
        TEST_ASSERT_EQUAL(-1, records[i].axis);
        TEST_ASSERT_EQUAL_INT64(MS, records[i].run_ns);
        TEST_ASSERT_EQUAL_HEX32(both[i].product_code, (uint32_t)records[i].code);
        TEST_ASSERT_EQUAL_HEX32(NUMBER << 24 | both[i].place, records[i].detail);
        TEST_ASSERT_EQUAL_DOUBLE(both[i].vendor_id, records[i].value);
        TEST_ASSERT_EQUAL_DOUBLE(both[i].explicit_id * 65536.0 + both[i].alias, records[i].bound);
    }
    set(both + 1, 1); /* the first one goes, */
    look(10 * MS);
    set(both, 2); /* and comes back */
    look(20 * MS);
    TEST_ASSERT_EQUAL_size_t(3, count);
    TEST_ASSERT_EQUAL_HEX32(both[0].product_code, (uint32_t)records[2].code);
    both[1].serial_number++; /* another one at the same place */
    set(both, 2);
    look(30 * MS);
    TEST_ASSERT_EQUAL_size_t(4, count);
}

/** Another one in every cycle: eight at once, then one in a second, of those that are there then. */
static void test_of_strangers_that_come_and_go_few_are_told(void)
{
    enum { CYCLES = 4500 };
    for (uint32_t n = 0; n < CYCLES; n++) {
        const cm1e_stranger_t one = stranger_of(n);
        set(&one, 1);
        look(n * MS);
    }
    TEST_ASSERT_EQUAL_size_t(BURST + CYCLES / 1000, count);
    for (size_t i = 0; i < count; i++) {
        const uint32_t n = (uint32_t)(i < BURST ? i : (i - BURST + 1) * 1000);
        TEST_ASSERT_EQUAL_INT64(n * MS, records[i].run_ns);
        TEST_ASSERT_EQUAL_HEX32(0xE0000000u + n, (uint32_t)records[i].code);
    }
    cm1e_log_wait_no_longer(&the_log); /* at the end of the run the last one is told */
    look(CYCLES * MS);
    TEST_ASSERT_EQUAL_size_t(BURST + CYCLES / 1000 + 1, count);
    TEST_ASSERT_EQUAL_HEX32(0xE0000000u + CYCLES - 1, (uint32_t)records[count - 1].code);
}

/** It is told as soon as there may be a record, without other news; not if it is gone by then. */
static void test_a_stranger_that_waits_is_told_if_it_is_still_there(void)
{
    for (int stays = 0; stays < 2; stays++) {
        tearDown();
        setUp();
        for (uint32_t n = 0; n <= BURST; n++) { /* the last one waits */
            const cm1e_stranger_t one = stranger_of(n);
            set(&one, 1);
            look(0);
        }
        TEST_ASSERT_EQUAL_size_t(BURST, count);
        if (!stays)
            set(NULL, 0);
        look(999 * MS);
        TEST_ASSERT_EQUAL_size_t(BURST, count);
        look(1000 * MS);
        TEST_ASSERT_EQUAL_size_t(BURST + (size_t)stays, count);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_counters_are_told_every_100_ms_and_at_the_end);
    RUN_TEST(test_faults_of_ports_are_told_every_second_and_at_the_end);
    RUN_TEST(test_of_a_slave_that_comes_and_goes_all_changes_are_counted);
    RUN_TEST(test_each_stranger_is_told_once_with_its_numbers);
    RUN_TEST(test_of_strangers_that_come_and_go_few_are_told);
    RUN_TEST(test_a_stranger_that_waits_is_told_if_it_is_still_there);
    return UNITY_END();
}
