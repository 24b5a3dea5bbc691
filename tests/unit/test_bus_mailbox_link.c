/* The link layer of a mailbox, datagram by datagram: what goes over the wire after each answer, and after each that is lost. */
#include <stddef.h>
#include <string.h>

#include "bus/mailbox_link.h"
#include "core/bytes.h"
#include "unity.h"

enum { STATION = 0x1007, OUT = 0x1000, OUT_BYTES = 40, IN = 0x1100, IN_BYTES = 48 };
enum { OUT_FULL = 1, IN_FULL = 2, ACKNOWLEDGED = 4 }; /* what the sync managers show */

static cm1e_mailbox_t mailbox;
static cm1e_datagram_t datagram;

void setUp(void)
{
    memset(&mailbox, 0xFF, sizeof mailbox); /* whatever was before */
    mailbox.station = STATION;
    mailbox.out_start = OUT;
    mailbox.out_length = OUT_BYTES;
    mailbox.in_start = IN;
    mailbox.in_length = IN_BYTES;
    cm1e_mailbox_reset(&mailbox);
}
void tearDown(void) {}

static void send(uint8_t type, uint8_t size)
{
    for (uint8_t i = 0; i < size; i++)
        cm1e_mailbox_body(&mailbox)[i] = (uint8_t)(0xC0 + i);
    cm1e_mailbox_send(&mailbox, type, size);
}

static void expect(cm1e_command_t command, unsigned offset, unsigned length)
{
    memset(&datagram, 0x55, sizeof datagram);
    TEST_ASSERT_TRUE(cm1e_mailbox_next(&mailbox, &datagram));
    TEST_ASSERT_EQUAL(command, datagram.command);
    TEST_ASSERT_EQUAL_HEX16(STATION, datagram.address);
    TEST_ASSERT_EQUAL_HEX16(offset, datagram.offset);
    TEST_ASSERT_EQUAL(length, datagram.length);
}

static void give(int working_counter)
{
    datagram.working_counter = working_counter;
    TEST_ASSERT_FALSE(cm1e_mailbox_result(&mailbox, &datagram));
}

/** The whole mailbox is written, which makes it full; behind the message are zeros. */
static void message(unsigned counter, uint8_t type, uint8_t size, int working_counter)
{
    expect(COMMAND_FPWR, OUT, OUT_BYTES);
    uint8_t wanted[OUT_BYTES] = {size, 0, 0, 0, 0, (uint8_t)(type | counter << 4)};
    for (uint8_t i = 0; i < size; i++)
        wanted[6 + i] = (uint8_t)(0xC0 + i);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(wanted, datagram.data, OUT_BYTES);
    give(working_counter);
}

/** A look at SM1, or at both. */
static void poll(bool both, unsigned shown)
{
    expect(COMMAND_FPRD, both ? REG_SM0 : REG_SM1, both ? 16 : 8);
    memset(datagram.data, 0, 16);
    uint8_t *in = datagram.data + (both ? 8 : 0);
    if (both)
        datagram.data[5] = shown & OUT_FULL ? 0x08 : 0;
    in[5] = shown & IN_FULL ? 0x08 : 0;
    in[7] = shown & ACKNOWLEDGED ? 0x02 : 0;
    TEST_ASSERT_EQUAL(!both && shown & IN_FULL, !both && cm1e_mailbox_is_full(&datagram));
    give(1);
}

static void poll_lost(bool both)
{
    expect(COMMAND_FPRD, both ? REG_SM0 : REG_SM1, both ? 16 : 8);
    memset(datagram.data, 0xFF, 16);
    give(DATAGRAM_LOST);
}

static void answer(unsigned counter, bool is_new)
{
    expect(COMMAND_FPRD, IN, IN_BYTES);
    memset(datagram.data, 0, IN_BYTES);
    datagram.data[5] = (uint8_t)(MAILBOX_TYPE_COE | counter << 4);
    datagram.working_counter = 1;
    TEST_ASSERT_EQUAL(is_new, cm1e_mailbox_result(&mailbox, &datagram));
}

static void answer_lost(int working_counter)
{
    expect(COMMAND_FPRD, IN, IN_BYTES);
    give(working_counter);
}

static void repeat(bool bit, int working_counter)
{
    expect(COMMAND_FPWR, REG_SM1 + 6, 1);
    TEST_ASSERT_EQUAL_HEX8(bit ? 3 : 1, datagram.data[0]);
    give(working_counter);
}

static void expect_nothing(void) { TEST_ASSERT_FALSE(cm1e_mailbox_next(&mailbox, &datagram)); }

static void test_messages_and_answers_have_their_turn(void)
{
    expect_nothing();
    for (unsigned n = 0; n < 16; n++) {
        const uint8_t type = n % 2 ? MAILBOX_TYPE_FOE : MAILBOX_TYPE_COE, size = (uint8_t)(10 + n);
        send(type, size);
        TEST_ASSERT_FALSE(cm1e_mailbox_delivered(&mailbox));
        message(n % 7 + 1, type, size, 1);
        TEST_ASSERT_TRUE(cm1e_mailbox_delivered(&mailbox) && cm1e_mailbox_drained(&mailbox));
        poll(false, 0);
        poll_lost(false);
        poll(false, IN_FULL);
        TEST_ASSERT_FALSE(cm1e_mailbox_delivered(&mailbox));
        answer(n % 7 + 1, true);
        poll(false, 0);
        cm1e_mailbox_stop(&mailbox);
        expect_nothing();
        give(1); /* too late */
        expect_nothing();
    }
}

static void test_the_room_is_what_the_header_leaves(void)
{
    static const uint16_t rooms[][2] = {{0, 0}, {5, 0}, {6, 0}, {7, 1}, {40, 34}, {1486, 1480}};
    for (size_t i = 0; i < sizeof rooms / sizeof rooms[0]; i++) {
        mailbox.out_length = rooms[i][0];
        TEST_ASSERT_EQUAL(rooms[i][1], cm1e_mailbox_room(&mailbox));
    }
}

/** A mailbox that is full takes no message: the same one comes again. */
static void test_a_message_that_is_refused_comes_again(void)
{
    send(MAILBOX_TYPE_COE, 10);
    for (int n = 0; n < 30; n++)
        message(1, MAILBOX_TYPE_COE, 10, 0);
    message(1, MAILBOX_TYPE_COE, 10, 1);
    poll(false, 0);
}

/** Whether a lost message has arrived is seen in the mailbox; it comes again, with its number, when three looks do not show
 *  it, and the slave is not asked for it any more when they do. */
static void test_a_lost_message_comes_again_unless_it_is_there(void)
{
    for (int looks = 0; looks <= 3; looks++) {
        setUp();
        send(MAILBOX_TYPE_COE, 10);
        message(1, MAILBOX_TYPE_COE, 10, DATAGRAM_LOST);
        TEST_ASSERT_FALSE(cm1e_mailbox_delivered(&mailbox));
        for (int n = 0; n < looks; n++)
            poll(true, 0);
        if (looks == 3) {
            message(1, MAILBOX_TYPE_COE, 10, DATAGRAM_LOST);
            for (int n = 0; n < 3; n++) {
                poll_lost(true);
                poll(true, 0);
            }
            message(1, MAILBOX_TYPE_COE, 10, 0); /* refused: perhaps it is full with this message */
        }
        poll(true, OUT_FULL);
        TEST_ASSERT_TRUE(cm1e_mailbox_delivered(&mailbox));
        poll(false, 0);
    }
}

/** An answer proves nothing: it may be an emergency, or one of before. */
static void test_an_answer_does_not_show_that_a_lost_message_has_arrived(void)
{
    send(MAILBOX_TYPE_COE, 10);
    message(1, MAILBOX_TYPE_COE, 10, DATAGRAM_LOST);
    poll(true, IN_FULL);
    answer(1, true);
    for (int n = 0; n < 3; n++)
        poll(true, 0);
    message(1, MAILBOX_TYPE_COE, 10, 1);
    TEST_ASSERT_TRUE(cm1e_mailbox_delivered(&mailbox));
    poll(false, IN_FULL);
}

/** A new message, and listening, forget what was in doubt. */
static void test_what_was_in_doubt_ends_with_the_next_message(void)
{
    for (int how = 0; how < 3; how++) {
        setUp();
        send(MAILBOX_TYPE_COE, 10);
        message(1, MAILBOX_TYPE_COE, 10, DATAGRAM_LOST);
        poll(true, 0);
        poll(true, 0);
        if (how == 0) {
            send(MAILBOX_TYPE_COE, 12);
            message(2, MAILBOX_TYPE_COE, 12, 1);
        } else if (how == 1) {
            cm1e_mailbox_listen(&mailbox);
        } else {
            cm1e_mailbox_drain(&mailbox);
            poll(true, 0);
        }
        TEST_ASSERT_TRUE(cm1e_mailbox_delivered(&mailbox) && cm1e_mailbox_drained(&mailbox));
        for (int n = 0; n < 30; n++)
            poll(false, 0);
    }
}

/** Until the slave has read what is in its mailbox; answers are fetched meanwhile. */
static void test_draining_ends_when_the_slave_has_read_its_mailbox(void)
{
    cm1e_mailbox_drain(&mailbox);
    for (int n = 0; n < 30; n++) {
        TEST_ASSERT_FALSE(cm1e_mailbox_drained(&mailbox));
        poll(true, OUT_FULL);
    }
    poll(true, OUT_FULL | IN_FULL);
    answer(1, true);
    poll_lost(true);
    TEST_ASSERT_FALSE(cm1e_mailbox_drained(&mailbox));
    poll(true, 0);
    TEST_ASSERT_TRUE(cm1e_mailbox_drained(&mailbox));
    poll(false, 0);
    for (int how = 0; how < 2; how++) {
        cm1e_mailbox_drain(&mailbox);
        poll(true, OUT_FULL);
        if (how == 0) {
            cm1e_mailbox_listen(&mailbox);
        } else {
            send(MAILBOX_TYPE_COE, 10);
            message(1, MAILBOX_TYPE_COE, 10, 1);
        }
        TEST_ASSERT_TRUE(cm1e_mailbox_drained(&mailbox));
        poll(false, 0);
    }
}

/** A lost answer is asked for by the repeat bit, which changes each time, until the slave has seen it; one that never shows
 *  that it has is looked at 20 times. */
static void test_a_lost_answer_is_asked_for_again(void)
{
    send(MAILBOX_TYPE_COE, 10);
    message(1, MAILBOX_TYPE_COE, 10, 1);
    for (unsigned n = 0; n < 6; n++) {
        const bool bit = n % 2 == 0;
        const unsigned before = bit ? 0 : ACKNOWLEDGED, after = bit ? ACKNOWLEDGED : 0;
        poll(false, IN_FULL | before);
        answer_lost(n < 3 ? DATAGRAM_LOST : 0);
        for (unsigned i = 0; i < n; i++)
            repeat(bit, i % 2 ? DATAGRAM_LOST : 0);
        repeat(bit, 1);
        TEST_ASSERT_FALSE(cm1e_mailbox_delivered(&mailbox));
        for (unsigned i = 0; i < (n == 5 ? 20 : n); i++)
            poll(false, IN_FULL | before);
        if (n > 0 && n < 5) {
            poll_lost(false);
        }
        if (n < 5)
            poll(false, IN_FULL | after);
        TEST_ASSERT_TRUE(cm1e_mailbox_delivered(&mailbox));
        poll(false, IN_FULL);
        answer(n + 1, true);
    }
}

/** Which of several answers are new, by their numbers; 'L' before a number: the answer was lost first, and asked for. */
static void test_repeated_answers_are_taken_once(void)
{
    static const struct {
        const char *numbers, *taken;
    } rows[] = {
        {"1234567123", "yyyyyyyyyy"},
        {"1233445566", "yyynynynyn"}, /* it numbers its answers, so one with the last number is a repetition */
        {"11111", "yyyyy"},           /* it does not */
        {"00000", "yyyyy"},           /* nor this one */
        {"1L11111", "ynnyyy"},        /* asked for again: two may be repetitions, the next ones are not */
        {"1L2", "yy"},
        {"L111", "yny"},
        {"L122", "yyn"},
        {"L12L2", "yyn"},
        {"0L0", "yy"},
        {"11L1", "yyy"},              /* known to give every answer the same number */
        {"121", "yyy"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        bool bit = false;
        unsigned n = 0;
        cm1e_mailbox_listen(&mailbox);
        for (const char *c = rows[i].numbers; *c; c++) {
            poll(false, IN_FULL);
            if (*c == 'L') {
                answer_lost(DATAGRAM_LOST);
                bit = !bit;
                repeat(bit, 1);
                poll(false, bit ? ACKNOWLEDGED : 0);
                continue;
            }
            answer((unsigned)(*c - '0'), rows[i].taken[n++] == 'y');
        }
    }
}

/** Nothing of before is left after a reset, as in a slave that comes from Init. */
static void test_after_a_reset_it_is_as_new(void)
{
    static cm1e_mailbox_t fresh;
    fresh = (cm1e_mailbox_t){.station = STATION, .out_start = OUT, .out_length = OUT_BYTES, .in_start = IN,
                             .in_length = IN_BYTES};
    memset(&mailbox, 0, sizeof mailbox);
    memcpy(&mailbox, &fresh, offsetof(cm1e_mailbox_t, message));
    for (int history = 0; history < 4; history++) {
        send(MAILBOX_TYPE_COE, 10);
        message(1, MAILBOX_TYPE_COE, 10, history == 1 ? DATAGRAM_LOST : 1);
        if (history == 1)
            poll(true, 0);
        if (history >= 2) {
            poll(false, IN_FULL);
            answer(3, true);
            poll(false, IN_FULL);
            answer_lost(DATAGRAM_LOST);
            repeat(true, history == 2 ? 0 : 1);
            cm1e_mailbox_drain(&mailbox);
        }
        cm1e_mailbox_reset(&mailbox);
        expect_nothing();
        TEST_ASSERT_EQUAL_MEMORY(&fresh, &mailbox, offsetof(cm1e_mailbox_t, message));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_messages_and_answers_have_their_turn);
    RUN_TEST(test_the_room_is_what_the_header_leaves);
    RUN_TEST(test_a_message_that_is_refused_comes_again);
    RUN_TEST(test_a_lost_message_comes_again_unless_it_is_there);
    RUN_TEST(test_an_answer_does_not_show_that_a_lost_message_has_arrived);
    RUN_TEST(test_what_was_in_doubt_ends_with_the_next_message);
    RUN_TEST(test_draining_ends_when_the_slave_has_read_its_mailbox);
    RUN_TEST(test_a_lost_answer_is_asked_for_again);
    RUN_TEST(test_repeated_answers_are_taken_once);
    RUN_TEST(test_after_a_reset_it_is_as_new);
    return UNITY_END();
}
