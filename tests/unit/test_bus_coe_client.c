/* The CoE client against a mailbox made by hand: every size, every lost frame, every lie of a slave. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unity.h>

#include "../support/mailbox_slave.h"
#include "bus/coe_client.h"

enum { STEP_NS = 100000 };
/** On which way a frame is lost. */
enum { WAY_OK = 0, WAY_THERE, WAY_BACK };

static slave_t slave;
static cm1e_coe_client_t client;
static uint8_t buffer[STORE];
static int64_t now_ns;

/* ---- running --------------------------------------------------------------------------------------------------- */

/** Which datagrams get lost, and on which way. */
static int (*loss)(unsigned n);
static unsigned datagrams;

static int no_loss(unsigned n)
{
    (void)n;
    return WAY_OK;
}

static unsigned lost_1, lost_2;
static int way_1, way_2;
static int two_losses(unsigned n) { return n == lost_1 ? way_1 : n == lost_2 ? way_2 : WAY_OK; }
static int random_losses(unsigned n)
{
    (void)n;
    return rand() % 10 < 3 ? 1 + rand() % 2 : WAY_OK;
}

/** Runs until the transfer ends; every run must. */
static void run(cm1e_sdo_t *sdo)
{
    static cm1e_datagram_t d;
    datagrams = 0;
    sdo->state = CM1E_SDO_BUSY;
    cm1e_coe_begin(&client, sdo, now_ns);
    while (cm1e_sdo_state(sdo) == CM1E_SDO_BUSY) {
        now_ns += STEP_NS;
        if (!cm1e_coe_next(&client, &d, now_ns))
            continue;
        const int way = loss(++datagrams);
        if (way != WAY_THERE)
            handle(&slave, &d);
        if (way != WAY_OK) {
            memset(d.data, 0xEE, MAILBOX);
            d.working_counter = DATAGRAM_LOST;
        }
        cm1e_coe_result(&client, &d, now_ns);
        TEST_ASSERT_TRUE_MESSAGE(datagrams < 20000, "endless");
    }
    TEST_ASSERT_TRUE(cm1e_coe_idle(&client));
}

static void fill(uint8_t *bytes, size_t size, unsigned seed)
{
    for (size_t i = 0; i < size; i++)
        bytes[i] = (uint8_t)(seed + i * 7 + i / 251);
}

void setUp(void)
{
    slave = (slave_t){.latency = 2, .size = 4};
    fill(slave.store, STORE, 1);
    client = (cm1e_coe_client_t){.mailbox = {.station = STATION, .out_start = OUT, .out_length = MAILBOX,
                                             .in_start = IN, .in_length = MAILBOX}};
    loss = no_loss;
    memset(buffer, 0xCC, sizeof buffer);
}
void tearDown(void) {}

static cm1e_sdo_t reading(size_t room)
{
    return (cm1e_sdo_t){.position = 1, .index = 0x2000, .subindex = 1, .data = buffer, .size = room};
}
static cm1e_sdo_t writing(size_t size)
{
    return (cm1e_sdo_t){.position = 1, .index = 0x2000, .subindex = 1, .write = true, .data = buffer, .size = size};
}

/* ---- transfers ------------------------------------------------------------------------------------------------- */

static void test_read_of_every_size_gives_the_bytes_of_the_slave(void)
{
    for (size_t size = 0; size <= 400; size++) {
        setUp();
        slave.size = size;
        cm1e_sdo_t sdo = reading(sizeof buffer);
        run(&sdo);
        TEST_ASSERT_EQUAL_INT(CM1E_SDO_DONE, cm1e_sdo_state(&sdo));
        TEST_ASSERT_EQUAL_size_t(size, sdo.size);
        TEST_ASSERT_EQUAL_INT(0, memcmp(slave.store, buffer, size));
        TEST_ASSERT_EACH_EQUAL_HEX8(0xCC, buffer + size, 100);
    }
}

static void test_write_of_every_size_arrives_once(void)
{
    for (size_t size = 0; size <= 400; size++) {
        setUp();
        fill(buffer, size, 77);
        cm1e_sdo_t sdo = writing(size);
        run(&sdo);
        TEST_ASSERT_EQUAL_INT(CM1E_SDO_DONE, cm1e_sdo_state(&sdo));
        TEST_ASSERT_EQUAL_UINT(1, slave.writes);
        TEST_ASSERT_EQUAL_size_t(size, slave.size);
        TEST_ASSERT_EQUAL_INT(0, memcmp(slave.store, buffer, size));
    }
}

static void test_read_into_a_buffer_that_just_fits_or_is_a_byte_too_small(void)
{
    static const size_t sizes[] = {1, 2, 3, 4, 5, 48, 49, 200};
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        setUp();
        slave.size = sizes[i];
        cm1e_sdo_t sdo = reading(sizes[i]);
        run(&sdo);
        TEST_ASSERT_EQUAL_INT(CM1E_SDO_DONE, cm1e_sdo_state(&sdo));
        sdo = reading(sizes[i] - 1);
        memset(buffer, 0xCC, sizeof buffer);
        run(&sdo);
        TEST_ASSERT_EQUAL_INT(CM1E_SDO_ERROR, cm1e_sdo_state(&sdo));
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_INVALID_ARGUMENT, sdo.error);
        TEST_ASSERT_EACH_EQUAL_HEX8(0xCC, buffer + sizes[i] - 1, 50);
        /* and the client is fit for the next */
        slave.size = 4;
        sdo = reading(4);
        run(&sdo);
        TEST_ASSERT_EQUAL_INT(CM1E_SDO_DONE, cm1e_sdo_state(&sdo));
    }
}

static void test_abort_gives_its_code(void)
{
    cm1e_sdo_t sdo = reading(4);
    sdo.index = 0x3000;
    run(&sdo);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_SDO_ABORT, sdo.error);
    TEST_ASSERT_EQUAL_HEX32(0x06020000, sdo.abort_code);
}

static void test_emergency_in_between_is_taken_and_does_not_disturb(void)
{
    slave.emergency_before = 1;
    slave.size = 200;
    cm1e_sdo_t sdo = reading(200);
    run(&sdo);
    TEST_ASSERT_EQUAL_INT(CM1E_SDO_DONE, cm1e_sdo_state(&sdo));
    TEST_ASSERT_EQUAL_INT(0, memcmp(slave.store, buffer, 200));
    TEST_ASSERT_EQUAL_UINT(slave.requests, client.emergency.number);
    TEST_ASSERT_EQUAL_HEX16(0xFF05, client.emergency.code);
    TEST_ASSERT_EQUAL_HEX8(0x81, client.emergency.error_register);
}

/* ---- lost frames ----------------------------------------------------------------------------------------------- */

static void check_with_losses(bool write, size_t size, const char *where)
{
    setUp();
    if (write) {
        fill(buffer, size, 77);
        cm1e_sdo_t sdo = writing(size);
        loss = two_losses;
        run(&sdo);
        TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, sdo.error, where);
        TEST_ASSERT_EQUAL_UINT_MESSAGE(1, slave.writes, where);
        TEST_ASSERT_EQUAL_INT_MESSAGE(0, memcmp(slave.store, buffer, size), where);
    } else {
        slave.size = size;
        cm1e_sdo_t sdo = reading(sizeof buffer);
        loss = two_losses;
        run(&sdo);
        TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, sdo.error, where);
        TEST_ASSERT_EQUAL_size_t(size, sdo.size);
        TEST_ASSERT_EQUAL_INT_MESSAGE(0, memcmp(slave.store, buffer, size), where);
    }
}

static void test_any_two_lost_frames_neither_lose_nor_double_a_transfer(void)
{
    static const size_t sizes[] = {4, 30, 150};
    for (int write = 0; write < 2; write++) {
        for (size_t i = 0; i < 3; i++) {
            lost_1 = lost_2 = 0;
            check_with_losses(write, sizes[i], "no loss");
            const unsigned last = datagrams;
            TEST_ASSERT_TRUE(last >= 4);
            for (lost_1 = 1; lost_1 <= last; lost_1++) {
                for (lost_2 = lost_1 + 1; lost_2 <= last + 8; lost_2++) {
                    for (way_1 = WAY_THERE; way_1 <= WAY_BACK; way_1++) {
                        for (way_2 = WAY_OK; way_2 <= WAY_BACK; way_2++) {
                            char where[80];
                            snprintf(where, sizeof where, "write %d, %zu bytes, lost %u (%d) and %u (%d)", write,
                                     sizes[i], lost_1, way_1, lost_2, way_2);
                            check_with_losses(write, sizes[i], where);
                        }
                    }
                }
            }
        }
    }
}

static void test_three_in_ten_frames_lost_is_slow_but_right(void)
{
    const unsigned seed = 20250301;
    printf("seed %u\n", seed);
    srand(seed);
    unsigned timeouts = 0;
    for (int round = 0; round < 2000; round++) {
        const size_t size = (size_t)(rand() % 300);
        const bool write = rand() % 2;
        const unsigned writes = slave.writes;
        slave.latency = (unsigned)(rand() % 5);
        loss = random_losses;
        cm1e_sdo_t sdo = write ? writing(size) : reading(sizeof buffer);
        if (write) {
            fill(buffer, size, (unsigned)round);
        } else {
            slave.size = size;
            fill(slave.store, size, (unsigned)round);
        }
        sdo.timeout_ns = 200 * STEP_NS;
        run(&sdo);
        if (sdo.error != CM1E_OK) {
            TEST_ASSERT_EQUAL_INT(CM1E_ERROR_TIMEOUT, sdo.error);
            timeouts++;
            continue;
        }
        TEST_ASSERT_EQUAL_UINT(writes + (write ? 1 : 0), slave.writes);
        TEST_ASSERT_EQUAL_size_t(size, slave.size);
        TEST_ASSERT_EQUAL_INT(0, memcmp(slave.store, buffer, size));
    }
    TEST_ASSERT_TRUE(timeouts < 5);
}

/* ---- time ------------------------------------------------------------------------------------------------------ */

static bool say_nothing(slave_t *s, uint8_t *answer)
{
    (void)s, (void)answer;
    return false;
}

static uint8_t kept_answer[MAILBOX];
static bool keep_back(slave_t *s, uint8_t *answer)
{
    if (s->lies > 1)
        return true;
    memcpy(kept_answer, answer, MAILBOX);
    return false;
}

static void test_silent_slave_ends_at_the_timeout(void)
{
    slave.lie = say_nothing;
    slave.lie_from = 1;
    const int64_t begin_ns = now_ns;
    cm1e_sdo_t sdo = reading(4);
    sdo.timeout_ns = 50 * STEP_NS;
    run(&sdo);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_TIMEOUT, sdo.error);
    TEST_ASSERT_EQUAL_INT64(50 * STEP_NS, now_ns - begin_ns);
    sdo = reading(4);
    const int64_t again_ns = now_ns;
    run(&sdo);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_TIMEOUT, sdo.error);
    TEST_ASSERT_EQUAL_INT64(1000000000, now_ns - again_ns); /* the default */
}

static void test_longest_timeout_is_no_short_one(void)
{
    now_ns += 1000000000;
    cm1e_sdo_t sdo = reading(4);
    sdo.timeout_ns = INT64_MAX;
    run(&sdo);
    TEST_ASSERT_EQUAL_INT(CM1E_SDO_DONE, cm1e_sdo_state(&sdo));
}

static bool keep_the_size_secret(slave_t *s, uint8_t *answer)
{
    (void)s;
    answer[8] &= 0xFE;
    return true;
}

/** The caller's room decides then; without any there is no buffer either. */
static void test_value_of_unknown_size_fills_the_room_there_is(void)
{
    slave.lie = keep_the_size_secret;
    slave.lie_from = 1;
    for (size_t room = 0; room <= 5; room++) {
        cm1e_sdo_t sdo = reading(room);
        if (room == 0)
            sdo.data = NULL;
        memset(buffer, 0xCC, sizeof buffer);
        run(&sdo);
        TEST_ASSERT_EQUAL_INT(CM1E_SDO_DONE, cm1e_sdo_state(&sdo));
        TEST_ASSERT_EQUAL_INT(room < 4 ? room : 4, sdo.size);
        TEST_ASSERT_EQUAL_INT(0, memcmp(slave.store, buffer, sdo.size));
        TEST_ASSERT_EQUAL_HEX8(0xCC, buffer[sdo.size]);
    }
}

static void test_answer_after_the_timeout_is_not_taken_for_the_next_one(void)
{
    slave.lie = keep_back;
    slave.lie_from = 1;
    fill(slave.store, 4, 1);
    cm1e_sdo_t sdo = reading(4);
    sdo.timeout_ns = 50 * STEP_NS;
    run(&sdo);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_TIMEOUT, sdo.error);
    /* The value changes, then the old answer comes, to the very same question. */
    fill(slave.store, 4, 99);
    put_in(&slave, kept_answer);
    sdo = reading(4);
    run(&sdo);
    TEST_ASSERT_EQUAL_INT(CM1E_SDO_DONE, cm1e_sdo_state(&sdo));
    TEST_ASSERT_EQUAL_INT(0, memcmp(slave.store, buffer, 4));
}

static void test_reset_ends_the_transfer_and_starts_the_counters_anew(void)
{
    static cm1e_datagram_t d;
    cm1e_sdo_t sdo = reading(4);
    sdo.state = CM1E_SDO_BUSY;
    cm1e_coe_begin(&client, &sdo, now_ns);
    TEST_ASSERT_TRUE(cm1e_coe_next(&client, &d, now_ns));
    cm1e_coe_reset(&client, CM1E_ERROR_BUS_LOST);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_BUS_LOST, sdo.error);
    d.working_counter = 1;
    cm1e_coe_result(&client, &d, now_ns); /* comes late, must not matter */
    slave.seen_counter = 0;
    sdo = reading(4);
    run(&sdo);
    TEST_ASSERT_EQUAL_INT(CM1E_SDO_DONE, cm1e_sdo_state(&sdo));
    TEST_ASSERT_EQUAL_HEX8(1, slave.seen_counter);
}

/* A device that was off counts its answers from 1 again, as before. If the frame with its first answer is lost, the
 * repeated answer is none of those from before the reset. */
static void test_reset_forgets_the_number_of_the_last_answer(void)
{
    for (unsigned n = 1; n <= 6; n++) {
        setUp();
        cm1e_sdo_t sdo = reading(4);
        run(&sdo);
        TEST_ASSERT_EQUAL_INT(CM1E_SDO_DONE, cm1e_sdo_state(&sdo));
        TEST_ASSERT_EQUAL_HEX8(1, slave.counter);
        cm1e_coe_reset(&client, CM1E_ERROR_BUS_LOST);
        slave = (slave_t){.latency = 2, .size = 4};
        fill(slave.store, 4, 99);
        loss = two_losses;
        lost_1 = n;
        way_1 = WAY_BACK;
        lost_2 = 0;
        sdo = reading(4);
        run(&sdo);
        TEST_ASSERT_EQUAL_INT(CM1E_SDO_DONE, cm1e_sdo_state(&sdo));
        TEST_ASSERT_EQUAL_INT(0, memcmp(slave.store, buffer, 4));
    }
}

static void test_mailbox_that_is_too_small_is_unsupported(void)
{
    static const uint16_t sizes[] = {0, 6, 15, 1487};
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        setUp();
        client.mailbox.in_length = sizes[i];
        cm1e_sdo_t sdo = reading(4);
        run(&sdo);
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_UNSUPPORTED, sdo.error);
        setUp();
        client.mailbox.out_length = sizes[i];
        sdo = reading(4);
        run(&sdo);
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_UNSUPPORTED, sdo.error);
    }
}

static bool do_not_count(slave_t *s, uint8_t *answer)
{
    (void)s;
    answer[5] = 3 | 1 << 4;
    return true;
}

static void test_slave_that_does_not_count_its_answers_is_understood(void)
{
    slave.lie = do_not_count;
    slave.lie_from = 1;
    for (int n = 0; n < 50; n++) {
        fill(slave.store, 4, (unsigned)n);
        cm1e_sdo_t sdo = reading(4);
        run(&sdo);
        TEST_ASSERT_EQUAL_INT(CM1E_SDO_DONE, cm1e_sdo_state(&sdo));
        TEST_ASSERT_EQUAL_INT(0, memcmp(slave.store, buffer, 4));
    }
}

/* ---- lies ------------------------------------------------------------------------------------------------------ */

#define LIE(name, change)                                                                                              \
    static bool name(slave_t *s, uint8_t *a)                                                                           \
    {                                                                                                                  \
        (void)s;                                                                                                       \
        change;                                                                                                        \
        return true;                                                                                                   \
    }
LIE(lie_index, a[9] ^= 1)
LIE(lie_subindex, a[11] ^= 1)
LIE(lie_type, a[5] = (uint8_t)((a[5] & 0xF0) | 2))
LIE(lie_error_reply, (a[5] &= 0xF0, cm1e_put_u16(a, 4), cm1e_put_u16(a + 6, 1), cm1e_put_u16(a + 8, 5)))
LIE(lie_service, a[7] = 0x50)
LIE(lie_as_request, a[7] = 0x20)
LIE(lie_command_7, a[8] |= 0xE0)
LIE(lie_command_other, a[8] ^= 0x20)
LIE(lie_toggle, a[8] ^= 0x10)
LIE(lie_length_0, cm1e_put_u16(a, 0))
LIE(lie_length_1, cm1e_put_u16(a, 1))
LIE(lie_length_2, cm1e_put_u16(a, 2))
LIE(lie_length_3, cm1e_put_u16(a, 3))
LIE(lie_length_9, cm1e_put_u16(a, 9))
LIE(lie_length_huge, cm1e_put_u16(a, 0xFFFF))
LIE(lie_length_one_too_many, cm1e_put_u16(a, MAILBOX - 5))
LIE(lie_total_huge, cm1e_put_u32(a + 12, 0xFFFFFFFF))
LIE(lie_total_more, cm1e_put_u32(a + 12, cm1e_get_u32(a + 12) + 1))
LIE(lie_total_less, cm1e_put_u32(a + 12, cm1e_get_u32(a + 12) - 1))
LIE(lie_never_last, a[8] &= 0xFE)
LIE(lie_last_at_once, a[8] |= 1)
LIE(lie_empty_segment, (cm1e_put_u16(a, 10), a[8] = (uint8_t)((a[8] & 0xF0) | 7 << 1)))
LIE(lie_everything_zero, memset(a, 0, MAILBOX))
LIE(lie_everything_ff, memset(a, 0xFF, MAILBOX))

typedef struct lie_case {
    const char *name;
    lie_fn lie;
    bool write;
    size_t size;
    unsigned from;      /* which answer, from 1 */
    cm1e_error_t error; /* expected */
} lie_case_t;

static const lie_case_t lies[] = {
    {"read: index", lie_index, false, 4, 1, CM1E_ERROR_TIMEOUT},
    {"read: subindex", lie_subindex, false, 4, 1, CM1E_ERROR_TIMEOUT},
    {"read: mailbox type", lie_type, false, 4, 1, CM1E_ERROR_TIMEOUT},
    {"read: mailbox error", lie_error_reply, false, 4, 1, CM1E_ERROR_BUS_MAILBOX},
    {"read: service", lie_service, false, 4, 1, CM1E_ERROR_TIMEOUT},
    {"read: answer as a request", lie_as_request, false, 4, 1, CM1E_ERROR_TIMEOUT},
    {"read: command 7", lie_command_7, false, 4, 1, CM1E_ERROR_BUS_MAILBOX},
    {"read: answered as a write", lie_command_other, false, 4, 1, CM1E_ERROR_BUS_MAILBOX},
    {"read: length 0", lie_length_0, false, 4, 1, CM1E_ERROR_TIMEOUT},
    {"read: length 1", lie_length_1, false, 4, 1, CM1E_ERROR_TIMEOUT},
    {"read: length 2", lie_length_2, false, 4, 1, CM1E_ERROR_BUS_MAILBOX},
    {"read: length 3", lie_length_3, false, 4, 1, CM1E_ERROR_BUS_MAILBOX},
    {"read: length 9", lie_length_9, false, 4, 1, CM1E_ERROR_BUS_MAILBOX},
    {"read: length 65535", lie_length_huge, false, 4, 1, CM1E_ERROR_BUS_MAILBOX},
    {"read: length beyond the mailbox", lie_length_one_too_many, false, 4, 1, CM1E_ERROR_BUS_MAILBOX},
    {"read: zeros", lie_everything_zero, false, 4, 1, CM1E_ERROR_BUS_MAILBOX},
    {"read: ones", lie_everything_ff, false, 4, 1, CM1E_ERROR_BUS_MAILBOX},
    {"segmented read: huge total", lie_total_huge, false, 150, 1, CM1E_ERROR_INVALID_ARGUMENT},
    {"segmented read: total one more", lie_total_more, false, 150, 1, CM1E_ERROR_BUS_MAILBOX},
    {"segmented read: total one less", lie_total_less, false, 150, 1, CM1E_ERROR_BUS_MAILBOX},
    {"segmented read: toggle 1", lie_toggle, false, 150, 2, CM1E_ERROR_BUS_MAILBOX},
    {"segmented read: toggle 2", lie_toggle, false, 150, 3, CM1E_ERROR_BUS_MAILBOX},
    {"segmented read: command", lie_command_other, false, 150, 2, CM1E_ERROR_BUS_MAILBOX},
    {"segmented read: length 0", lie_length_0, false, 150, 2, CM1E_ERROR_TIMEOUT},
    {"segmented read: length 2", lie_length_2, false, 150, 2, CM1E_ERROR_BUS_MAILBOX},
    {"segmented read: length 3", lie_length_3, false, 150, 2, CM1E_ERROR_BUS_MAILBOX},
    {"segmented read: length 65535", lie_length_huge, false, 150, 2, CM1E_ERROR_BUS_MAILBOX},
    {"segmented read: never the last", lie_never_last, false, 150, 2, CM1E_ERROR_BUS_MAILBOX},
    {"segmented read: last at once", lie_last_at_once, false, 150, 2, CM1E_ERROR_BUS_MAILBOX},
    {"segmented read: empty segments", lie_empty_segment, false, 150, 2, CM1E_ERROR_BUS_MAILBOX},
    {"segmented read: mailbox error", lie_error_reply, false, 150, 3, CM1E_ERROR_BUS_MAILBOX},
    {"write: index", lie_index, true, 4, 1, CM1E_ERROR_TIMEOUT},
    {"write: subindex", lie_subindex, true, 4, 1, CM1E_ERROR_TIMEOUT},
    {"write: answered as a read", lie_command_other, true, 4, 1, CM1E_ERROR_BUS_MAILBOX},
    {"write: length 9", lie_length_9, true, 4, 1, CM1E_ERROR_BUS_MAILBOX},
    {"segmented write: toggle", lie_toggle, true, 150, 2, CM1E_ERROR_BUS_MAILBOX},
    {"segmented write: command", lie_command_other, true, 150, 2, CM1E_ERROR_BUS_MAILBOX},
    {"segmented write: mailbox error", lie_error_reply, true, 150, 2, CM1E_ERROR_BUS_MAILBOX},
};

static void test_lies_of_a_slave_are_refused_with_the_right_error(void)
{
    for (size_t i = 0; i < sizeof lies / sizeof lies[0]; i++) {
        const lie_case_t *c = &lies[i];
        setUp();
        slave.size = c->size;
        slave.lie = c->lie;
        slave.lie_from = c->from;
        cm1e_sdo_t sdo = c->write ? writing(c->size) : reading(400);
        run(&sdo);
        TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_SDO_ERROR, cm1e_sdo_state(&sdo), c->name);
        TEST_ASSERT_EQUAL_INT_MESSAGE(c->error, sdo.error, c->name);
        TEST_ASSERT_EACH_EQUAL_HEX8_MESSAGE(0xCC, buffer + 400, 100, c->name);
        /* A slave that comes to its senses is believed again, and nothing old is taken for new. */
        slave.lie = NULL;
        slave.size = 4;
        fill(slave.store, 4, 200);
        sdo = reading(4);
        run(&sdo);
        TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, sdo.error, c->name);
        TEST_ASSERT_EQUAL_INT_MESSAGE(0, memcmp(slave.store, buffer, 4), c->name);
    }
}

/* What is in the slave's mailbox gets read. */
static void let_slave_work(void)
{
    static cm1e_datagram_t d;
    for (int n = 0; n < 5; n++) {
        cm1e_datagram_set(&d, COMMAND_FPRD, STATION, REG_SM1, SYNC_MANAGER_BYTES);
        handle(&slave, &d);
    }
}

/* A slave that has room for one transfer, and holds it open until its end or an abort. */
static void test_slave_is_told_of_a_transfer_that_is_given_up(void)
{
    for (size_t i = 0; i < sizeof lies / sizeof lies[0]; i++) {
        const lie_case_t *c = &lies[i];
        for (int rejects = 0; rejects <= 1; rejects++) {
            setUp();
            slave.strict = true;
            slave.rejects_aborts = rejects;
            slave.size = c->size;
            slave.lie = c->lie;
            slave.lie_from = c->from;
            cm1e_sdo_t sdo = c->write ? writing(c->size) : reading(400);
            run(&sdo);
            TEST_ASSERT_EQUAL_INT_MESSAGE(c->error, sdo.error, c->name);
            let_slave_work();
            const bool can_tell = c->error != CM1E_ERROR_TIMEOUT && c->lie != lie_error_reply;
            TEST_ASSERT_FALSE_MESSAGE(can_tell && slave.open, c->name); /* at once */
            slave.lie = NULL;
            slave.size = 4;
            sdo = reading(4);
            run(&sdo);
            TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, sdo.error, c->name);
            const bool never_began = (c->lie == lie_error_reply || c->lie == lie_everything_zero) && c->from == 1;
            TEST_ASSERT_EQUAL_UINT_MESSAGE(never_began ? 0 : 1, slave.aborts, c->name);
            TEST_ASSERT_TRUE_MESSAGE(slave.aborts == 0 || slave.abort_index == 0x2000, c->name);
        }
    }
}

static void test_value_too_large_for_the_buffer_is_aborted_as_such(void)
{
    slave.strict = true;
    slave.size = 150;
    cm1e_sdo_t sdo = reading(100);
    run(&sdo);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_INVALID_ARGUMENT, sdo.error);
    let_slave_work();
    TEST_ASSERT_EQUAL_UINT(1, slave.aborts);
    TEST_ASSERT_EQUAL_HEX32(0x05040005, slave.abort_code); /* out of memory */
    sdo = reading(150);
    run(&sdo);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, sdo.error);
    TEST_ASSERT_EQUAL_UINT(1, slave.aborts);
}

static bool say_nothing_more(slave_t *s, uint8_t *answer)
{
    (void)s;
    (void)answer;
    return false;
}

/* Time over, or cancelled: the transfer ends at once, and the next one begins with the abort, whichever frames are lost. */
static void test_abort_that_could_not_be_sent_comes_before_the_next_transfer(void)
{
    for (lost_1 = 1; lost_1 <= 20; lost_1++)
        for (int way = WAY_OK; way <= WAY_BACK; way++) {
            setUp();
            slave.strict = true;
            slave.size = 150;
            slave.lie = say_nothing_more;
            slave.lie_from = 2;
            cm1e_sdo_t sdo = reading(400);
            sdo.timeout_ns = 100 * STEP_NS;
            const int64_t begin_ns = now_ns;
            run(&sdo);
            TEST_ASSERT_EQUAL_INT(CM1E_ERROR_TIMEOUT, sdo.error);
            TEST_ASSERT_EQUAL_INT64(100 * STEP_NS, now_ns - begin_ns);
            TEST_ASSERT_TRUE(slave.open);
            slave.lie = NULL;
            loss = two_losses;
            way_1 = way;
            lost_2 = 0;
            sdo = reading(400);
            run(&sdo);
            TEST_ASSERT_EQUAL_INT(CM1E_OK, sdo.error);
            TEST_ASSERT_EQUAL_UINT(1, slave.aborts);
            TEST_ASSERT_EQUAL_HEX32(0x05040000, slave.abort_code); /* time out */
            TEST_ASSERT_EQUAL_INT(0, memcmp(slave.store, buffer, 150));
        }
}

static bool lie_at_random(slave_t *s, uint8_t *a)
{
    (void)s;
    for (int n = 1 + rand() % 3; n > 0; n--)
        a[rand() % 16] = (uint8_t)rand();
    return rand() % 8 != 0;
}

static void test_random_answers_never_overrun_nor_hang(void)
{
    const unsigned seed = 20250302;
    printf("seed %u\n", seed);
    srand(seed);
    for (int round = 0; round < 20000; round++) {
        setUp();
        slave.size = (size_t)(rand() % 200);
        slave.lie = lie_at_random;
        slave.lie_from = 1u + (unsigned)(rand() % 4);
        const size_t room = (size_t)(rand() % 200);
        cm1e_sdo_t sdo = reading(room);
        sdo.timeout_ns = 40 * STEP_NS;
        run(&sdo);
        TEST_ASSERT_EACH_EQUAL_HEX8(0xCC, buffer + room, 64);
        if (sdo.error == CM1E_OK)
            TEST_ASSERT_TRUE(sdo.size <= room);
    }
}

static bool chatter(slave_t *s, uint8_t *a)
{
    a[9] ^= 1;
    memcpy(s->queued, a, MAILBOX);
    s->queued_valid = true;
    return true;
}

static void test_slave_that_never_stops_talking_is_given_up(void)
{
    cm1e_sdo_t sdo = reading(4);
    static cm1e_datagram_t d;
    slave.lie = chatter;
    slave.lie_from = 1;
    sdo.state = CM1E_SDO_BUSY;
    cm1e_coe_begin(&client, &sdo, now_ns);
    unsigned n = 0;
    while (cm1e_sdo_state(&sdo) == CM1E_SDO_BUSY) { /* time stands still: the number of messages is the bound */
        TEST_ASSERT_TRUE(cm1e_coe_next(&client, &d, now_ns));
        if (slave.lies)
            slave.queued_valid = true;
        handle(&slave, &d);
        cm1e_coe_result(&client, &d, now_ns);
        TEST_ASSERT_TRUE(++n < 1000);
    }
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_BUS_MAILBOX, sdo.error);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_read_of_every_size_gives_the_bytes_of_the_slave);
    RUN_TEST(test_write_of_every_size_arrives_once);
    RUN_TEST(test_read_into_a_buffer_that_just_fits_or_is_a_byte_too_small);
    RUN_TEST(test_abort_gives_its_code);
    RUN_TEST(test_emergency_in_between_is_taken_and_does_not_disturb);
    RUN_TEST(test_any_two_lost_frames_neither_lose_nor_double_a_transfer);
    RUN_TEST(test_three_in_ten_frames_lost_is_slow_but_right);
    RUN_TEST(test_silent_slave_ends_at_the_timeout);
    RUN_TEST(test_longest_timeout_is_no_short_one);
    RUN_TEST(test_value_of_unknown_size_fills_the_room_there_is);
    RUN_TEST(test_answer_after_the_timeout_is_not_taken_for_the_next_one);
    RUN_TEST(test_reset_ends_the_transfer_and_starts_the_counters_anew);
    RUN_TEST(test_reset_forgets_the_number_of_the_last_answer);
    RUN_TEST(test_slave_that_does_not_count_its_answers_is_understood);
    RUN_TEST(test_mailbox_that_is_too_small_is_unsupported);
    RUN_TEST(test_lies_of_a_slave_are_refused_with_the_right_error);
    RUN_TEST(test_slave_is_told_of_a_transfer_that_is_given_up);
    RUN_TEST(test_value_too_large_for_the_buffer_is_aborted_as_such);
    RUN_TEST(test_abort_that_could_not_be_sent_comes_before_the_next_transfer);
    RUN_TEST(test_random_answers_never_overrun_nor_hang);
    RUN_TEST(test_slave_that_never_stops_talking_is_given_up);
    return UNITY_END();
}
