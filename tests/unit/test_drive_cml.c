/* CML strings as steps, on a mailbox that a test fills: the flows of BR appendix 2, each of their branches, and what
 * else can come between. One step is a millisecond. */
#include <stdio.h>
#include <string.h>
#include <unity.h>

#include "chance.h"
#include "device/bridge_facts.h"
#include "drive/drive_cml.h"

#define MS INT64_C(1000000)

enum { CHANNEL = 2, ANSWERS = 256, STRINGS = 9, LOG = 512 };

static cm1e_drive_cml_t cml;
static int64_t now_ns;

/* The device: answers that have come wait in the order of the list. */
static struct mailbox {
    cm1e_sdo_t *sdo;
    unsigned delay;               /* steps of a transfer */
    unsigned wait;
    bool full, silent;            /* no transfer is taken; one never ends */
    unsigned fail_at;             /* this transfer (from 1) ends with `failure` */
    cm1e_error_t failure;
    unsigned transfers;
    char sent[STRINGS][CM1E_CML_BYTES + 1];
    int64_t sent_ns[STRINGS];
    unsigned sent_count, reads_behind; /* reads since the last string */
    int64_t first_read_ns, read_ns[LOG];
    struct {
        const char *text;
        unsigned behind;          /* strings that must be sent before */
        int64_t after_ns;         /* time since then */
    } answers[ANSWERS];
    unsigned answer_count, answer_next;
} box;

static cm1e_error_t submit(void *context, cm1e_sdo_t *sdo)
{
    struct mailbox *b = context;
    TEST_ASSERT_NULL_MESSAGE(b->sdo, "a second transfer beside the first");
    if (b->full)
        return CM1E_ERROR_FULL;
    TEST_ASSERT_EQUAL_HEX16((sdo->write ? 0xF581 : 0xF591) + CHANNEL - 1, sdo->index);
    TEST_ASSERT_EQUAL(3, sdo->position);
    sdo->state = CM1E_SDO_BUSY;
    b->sdo = sdo;
    b->wait = b->delay;
    return CM1E_OK;
}

static void answers(const char *text, unsigned behind, int after_ms)
{
    TEST_ASSERT_TRUE(box.answer_count < ANSWERS);
    box.answers[box.answer_count].text = text;
    box.answers[box.answer_count].behind = behind;
    box.answers[box.answer_count++].after_ns = after_ms * MS;
}

static void take_string(const cm1e_sdo_t *sdo)
{
    TEST_ASSERT_TRUE(box.sent_count < STRINGS && sdo->size <= CM1E_CML_BYTES);
    memcpy(box.sent[box.sent_count], sdo->data, sdo->size);
    box.sent_ns[box.sent_count++] = now_ns;
    box.reads_behind = 0;
    box.first_read_ns = 0;
}

static void give_answer(cm1e_sdo_t *sdo)
{
    const char *text = "Null\r\n";
    if (box.answer_next < box.answer_count) {
        const unsigned behind = box.answers[box.answer_next].behind;
        const int64_t from_ns = behind == 0 ? 0 : box.sent_ns[behind - 1];
        if (behind <= box.sent_count && now_ns >= from_ns + box.answers[box.answer_next].after_ns)
            text = box.answers[box.answer_next++].text;
    }
    const size_t size = strlen(text);
    sdo->size = size < sdo->size ? size : sdo->size;
    memcpy(sdo->data, text, sdo->size);
    if (box.reads_behind < LOG)
        box.read_ns[box.reads_behind] = now_ns;
    if (box.reads_behind++ == 0)
        box.first_read_ns = now_ns;
}

static void device(void)
{
    cm1e_sdo_t *sdo = box.sdo;
    if (!sdo || box.silent || box.wait-- > 0)
        return;
    box.sdo = NULL;
    box.transfers++;
    if (box.transfers == box.fail_at) {
        sdo->error = box.failure;
        sdo->state = CM1E_SDO_ERROR;
        return;
    }
    if (sdo->write)
        take_string(sdo);
    else
        give_answer(sdo);
    sdo->state = CM1E_SDO_DONE;
}

static void steps(int count, bool ready)
{
    for (int i = 0; i < count; i++) {
        now_ns += MS;
        cm1e_drive_cml_step(&cml, now_ns, ready);
        device();
    }
}

static uint32_t send(const char *text)
{
    uint32_t ticket;
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, cm1e_drive_cml_send(&cml, text, 0, &ticket), text);
    return ticket;
}

static const cm1e_drive_cml_request_t *finish(uint32_t ticket)
{
    for (int i = 0; i < 100000 && cm1e_drive_cml_request(&cml, ticket)->state < CM1E_DRIVE_CML_DONE; i++)
        steps(1, true);
    const cm1e_drive_cml_request_t *request = cm1e_drive_cml_request(&cml, ticket);
    TEST_ASSERT_TRUE(request->state == CM1E_DRIVE_CML_DONE || request->state == CM1E_DRIVE_CML_ERROR);
    TEST_ASSERT_EQUAL(request->state == CM1E_DRIVE_CML_ERROR, request->error != CM1E_OK);
    return request;
}

void setUp(void)
{
    memset(&box, 0, sizeof box);
    now_ns = 0;
    cm1e_drive_cml_init(&cml, 3, CHANNEL, submit, &box);
}
void tearDown(void) {}

/* ---- appendix 2.1, 2.3: a query ---------------------------------------------------------------------------------- */

static void test_a_query_waits_for_its_answer(void)
{
    answers("K53.2=100\r\n", 1, 30);
    const uint32_t ticket = send("K53.2");
    const cm1e_drive_cml_request_t *request = finish(ticket);
    TEST_ASSERT_EQUAL(CM1E_DRIVE_CML_DONE, request->state);
    TEST_ASSERT_EQUAL(1, request->lines);
    TEST_ASSERT_EQUAL_STRING("K53.2=100", cm1e_drive_cml_line(&cml, ticket, 0));
    TEST_ASSERT_NULL(cm1e_drive_cml_line(&cml, ticket, 1));
    TEST_ASSERT_EQUAL_STRING("K53.2", box.sent[0]);
    TEST_ASSERT_TRUE(box.reads_behind > 3); /* "Null" several times before */
    TEST_ASSERT_EQUAL_INT64(3 * MS, box.first_read_ns - box.sent_ns[0]); /* taken in after 1 ms, and 2 ms then */
    TEST_ASSERT_TRUE(cm1e_drive_cml_idle(&cml));
}

static void test_nothing_goes_out_before_mode_and_controlword_are_right(void)
{
    const uint32_t ticket = send("?99.2");
    answers("Ux.2=8\r\n", 1, 4);
    steps(500, false);
    TEST_ASSERT_EQUAL(0, box.transfers);
    TEST_ASSERT_EQUAL(CM1E_DRIVE_CML_ACTIVE, cm1e_drive_cml_request(&cml, ticket)->state);
    TEST_ASSERT_EQUAL(CM1E_DRIVE_CML_DONE, finish(ticket)->state);
    const uint32_t late = send("?99.2");
    steps(2000, false);
    TEST_ASSERT_EQUAL(CM1E_DRIVE_CML_ACTIVE, cm1e_drive_cml_request(&cml, late)->state);
    steps(1, false);
    TEST_ASSERT_EQUAL(CM1E_ERROR_DRIVE_MODE_TIMEOUT, cm1e_drive_cml_request(&cml, late)->error);
    TEST_ASSERT_FALSE(cm1e_drive_cml_request(&cml, late)->sent);
}

static void test_answers_to_earlier_queries_are_set_aside(void)
{
    answers("K54.2=7\r\n", 1, 4);
    answers("Ux.2=8\r\n", 1, 5);
    answers("K53.1=1\r\n", 1, 6); /* of another motor */
    answers("K53.2=100\r\n", 1, 20);
    const uint32_t ticket = send("K53.2");
    const cm1e_drive_cml_request_t *request = finish(ticket);
    TEST_ASSERT_EQUAL(CM1E_DRIVE_CML_DONE, request->state);
    TEST_ASSERT_EQUAL_STRING("K53.2=100", request->first);
    TEST_ASSERT_EQUAL(3, request->strays);
    TEST_ASSERT_EQUAL_STRING("K53.1=1", cml.stray);
}

static void test_what_waited_before_the_query_is_no_answer_to_it(void)
{
    answers("Ux.2=1\r\n", 0, 0);
    answers("Ux.2=2\r\n", 0, 0);
    answers("Ux.2=8\r\n", 1, 4);
    const uint32_t ticket = send("?99.2");
    const cm1e_drive_cml_request_t *request = finish(ticket);
    TEST_ASSERT_EQUAL_STRING("Ux.2=8", request->first);
    TEST_ASSERT_EQUAL(1, request->lines);
    TEST_ASSERT_EQUAL(2, request->strays);
}

static void test_a_mailbox_that_never_is_empty_does_not_hold_up_for_ever(void)
{
    for (int i = 0; i < ANSWERS; i++)
        answers("Ux.2=8\r\n", 0, 0);
    const uint32_t ticket = send("K53.2");
    while (box.sent_count == 0)
        steps(1, true);
    TEST_ASSERT_EQUAL(64, box.answer_next); /* read before the string */
    TEST_ASSERT_EQUAL(CM1E_ERROR_CML_TIMEOUT, finish(ticket)->error);
    TEST_ASSERT_EQUAL(1, box.sent_count);
}

/* A line that was cut has no end of its own. Characters that are not printable ASCII are shown as "?". */
static void test_a_stray_is_shown_alone_and_printable_until_the_next_string(void)
{
    answers("K54.2=123456789\r\n", 0, 0);
    answers("Ux.2=8", 0, 0);
    answers("K53.2=1\r\n", 1, 4);
    TEST_ASSERT_EQUAL(2, finish(send("K53.2"))->strays);
    TEST_ASSERT_EQUAL_STRING("Ux.2=8", cml.stray);
    answers("K53.2=1\r\n", 2, 4);
    TEST_ASSERT_EQUAL(0, finish(send("K53.2"))->strays);
    TEST_ASSERT_EQUAL_STRING("", cml.stray);
    answers("a ~\x7f\x01\xe4" "b\r\n", 2, 0);
    answers("K53.2=1\r\n", 3, 4);
    TEST_ASSERT_EQUAL(1, finish(send("K53.2"))->strays);
    TEST_ASSERT_EQUAL_STRING("a ~???b", cml.stray);
}

static void test_no_answer_is_a_time_out(void)
{
    answers("K54.2=7\r\n", 1, 4);
    const uint32_t ticket = send("K53.2");
    TEST_ASSERT_EQUAL(CM1E_ERROR_CML_TIMEOUT, finish(ticket)->error);
    TEST_ASSERT_EQUAL_INT64(1000 * MS, cm1e_drive_cml_request(&cml, ticket)->timeout_ns);
    TEST_ASSERT_INT64_WITHIN(20 * MS, 1000 * MS, now_ns - box.sent_ns[0]);
    uint32_t other;
    TEST_ASSERT_EQUAL(CM1E_ERROR_INVALID_ARGUMENT, cm1e_drive_cml_send(&cml, "K53.2", -1, &other));
    TEST_ASSERT_EQUAL(CM1E_ERROR_INVALID_ARGUMENT,
                      cm1e_drive_cml_send(&cml, "K53.2", CM1E_DRIVE_LONGEST_NS + 1, &other));
    TEST_ASSERT_EQUAL(0, other);
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_drive_cml_send(&cml, "K53.2", 50 * MS, &other));
    finish(other);
    TEST_ASSERT_INT64_WITHIN(10 * MS, 50 * MS, now_ns - box.sent_ns[1]);
    TEST_ASSERT_EQUAL(2, box.sent_count); /* never sent again */
}

static void test_several_queries_in_one_string(void)
{
    answers("K54.2=4\r\n", 1, 4);
    answers("K53.2=3\r\nUx.2=8\r\n", 1, 8); /* two lines in one mailbox */
    const uint32_t ticket = send("K53.2,?99.2,K54.2");
    TEST_ASSERT_EQUAL(CM1E_DRIVE_CML_DONE, finish(ticket)->state);
    TEST_ASSERT_EQUAL_STRING("K54.2=4", cm1e_drive_cml_line(&cml, ticket, 0));
    TEST_ASSERT_EQUAL_STRING("K53.2=3", cm1e_drive_cml_line(&cml, ticket, 1));
    TEST_ASSERT_EQUAL_STRING("Ux.2=8", cm1e_drive_cml_line(&cml, ticket, 2));
    answers("K53.2=3\r\n", 2, 4); /* half of them */
    TEST_ASSERT_EQUAL(CM1E_ERROR_CML_TIMEOUT, finish(send("K53.2,K54.2"))->error);
}

/* Not every line that is as long as the string is its echo. */
static void test_an_answer_as_long_as_its_string_is_an_answer(void)
{
    answers("Ux.2=128\r\n", 1, 4);
    const cm1e_drive_cml_request_t *request = finish(send("?99.2,O1"));
    TEST_ASSERT_EQUAL(CM1E_DRIVE_CML_DONE, request->state);
    TEST_ASSERT_EQUAL_STRING("Ux.2=128", request->first);
}

static void test_an_echo_is_no_stray(void)
{
    answers("?99.2\r\n", 1, 4);
    answers("Ux.2=8\r\n", 1, 4);
    const cm1e_drive_cml_request_t *request = finish(send("?99.2"));
    TEST_ASSERT_EQUAL_STRING("Ux.2=8", request->first);
    TEST_ASSERT_EQUAL(0, request->strays);
}

/* ---- appendix 2.2, 2.6: without an answer ------------------------------------------------------------------------ */

static void test_a_write_is_done_when_it_is_sent(void)
{
    static const char *const texts[] = {"K53.2=100", "O1.2,O2.2,F3.2,O4.2", ").2"};
    for (unsigned i = 0; i < 3; i++) {
        const cm1e_drive_cml_request_t *request = finish(send(texts[i]));
        TEST_ASSERT_EQUAL(CM1E_DRIVE_CML_DONE, request->state);
        TEST_ASSERT_EQUAL(0, request->lines);
        TEST_ASSERT_EQUAL(0, box.reads_behind);
        TEST_ASSERT_EQUAL_STRING(texts[i], box.sent[i]);
    }
}

/* ---- appendix 2.4: origin search --------------------------------------------------------------------------------- */

static void test_a_search_ends_with_origin_or_fails_with_the_state(void)
{
    answers("Ux.2=0\r\n", 1, 4); /* "it moves", told by itself */
    answers("Origin.2=12\r\n", 1, 3000);
    const cm1e_drive_cml_request_t *request = finish(send("|.2"));
    TEST_ASSERT_EQUAL(CM1E_DRIVE_CML_DONE, request->state);
    TEST_ASSERT_EQUAL_STRING("Origin.2=12", request->first);
    TEST_ASSERT_EQUAL(1, request->strays);
    answers("Ux.2=4\r\n", 2, 500);
    request = finish(send("|.2"));
    TEST_ASSERT_EQUAL(CM1E_ERROR_CM_SEARCH, request->error);
    TEST_ASSERT_EQUAL_STRING("Ux.2=4", request->first);
    request = finish(send("|.2"));
    TEST_ASSERT_EQUAL(CM1E_ERROR_CM_SEARCH_TIMEOUT, request->error);
    TEST_ASSERT_EQUAL_INT64(70000 * MS, request->timeout_ns);
    TEST_ASSERT_INT64_WITHIN(20 * MS, 70000 * MS, now_ns - box.sent_ns[2]);
}

/* ---- appendix 2.5: several lines --------------------------------------------------------------------------------- */

static void test_a_list_is_read_every_10_ms_until_it_is_empty(void)
{
    static char lines[79][16];
    for (int i = 0; i < 79; i++) {
        snprintf(lines[i], sizeof lines[i], "K%d.2=%d\r\n", 21 + i, i);
        answers(lines[i], 1, 4 + 8 * i);
    }
    const uint32_t ticket = send("?90.2");
    const cm1e_drive_cml_request_t *request = finish(ticket);
    TEST_ASSERT_EQUAL(CM1E_DRIVE_CML_DONE, request->state);
    TEST_ASSERT_EQUAL(79, request->lines);
    TEST_ASSERT_EQUAL_STRING("K99.2=78", cm1e_drive_cml_line(&cml, ticket, 78));
    for (unsigned i = box.reads_behind - 79; i < box.reads_behind; i++)
        TEST_ASSERT_TRUE(box.read_ns[i] - box.read_ns[i - 1] >= 10 * MS);
}

/* A list is looked for every 2 ms until it begins. */
static void test_a_list_of_one_line_ends_behind_it(void)
{
    answers("K53.2=1\r\n", 1, 30);
    const cm1e_drive_cml_request_t *request = finish(send("?90.2"));
    TEST_ASSERT_EQUAL(CM1E_DRIVE_CML_DONE, request->state);
    TEST_ASSERT_EQUAL(1, request->lines);
    for (unsigned i = 1; i + 2 < box.reads_behind; i++)
        TEST_ASSERT_EQUAL_INT64(3 * MS, box.read_ns[i] - box.read_ns[i - 1]);
}

static void test_lines_beyond_the_most_are_counted_and_other_kinds_set_aside(void)
{
    for (int i = 0; i < CM1E_CML_LINES + 5; i++)
        answers("K53.2=1\r\n", 1, 4);
    answers("Ux.2=8\r\n", 1, 4);
    const cm1e_drive_cml_request_t *request = finish(send("?90.2"));
    TEST_ASSERT_EQUAL(CM1E_CML_LINES, request->lines);
    TEST_ASSERT_EQUAL(5, request->lost);
    TEST_ASSERT_EQUAL(1, request->strays);
}

static void test_an_empty_list_is_a_time_out_and_an_unknown_command_may_be_silent(void)
{
    TEST_ASSERT_EQUAL(CM1E_ERROR_CML_TIMEOUT, finish(send("?90.2"))->error);
    TEST_ASSERT_EQUAL(CM1E_DRIVE_CML_DONE, finish(send("^.2"))->state);
    TEST_ASSERT_EQUAL(1, box.reads_behind);
    TEST_ASSERT_EQUAL_INT64(51 * MS, box.first_read_ns - box.sent_ns[1]);
    answers("H0=1\r\n", 3, 20);
    answers("H1=2\r\n", 3, 28);
    const cm1e_drive_cml_request_t *request = finish(send("%87"));
    TEST_ASSERT_EQUAL(2, request->lines);
}

/* ---- times between strings --------------------------------------------------------------------------------------- */

static void test_strings_keep_their_distance(void)
{
    const char *const longer = "K53.2=1,K54.2=1,K55.2=1,K56.2=1,"; /* and one more: 39 bytes */
    char text[65];
    snprintf(text, sizeof text, "%s%s", longer, "K57.2=1");
    send("K53.2=1");
    send("K53.2=2");
    send(text);
    finish(send("K53.2=3"));
    TEST_ASSERT_EQUAL(4, box.sent_count);
    TEST_ASSERT_TRUE(box.sent_ns[1] - box.sent_ns[0] >= 4 * MS);
    TEST_ASSERT_TRUE(box.sent_ns[2] - box.sent_ns[1] >= 4 * MS);
    TEST_ASSERT_TRUE(box.sent_ns[3] - box.sent_ns[2] >= 8 * MS);
}

static void test_a_string_of_exactly_32_bytes_counts_as_long(void)
{
    const char *text = "K53.2=1000,K54.2=1000,K55.2=1000";
    TEST_ASSERT_EQUAL(32, strlen(text));
    send(text);
    finish(send("K53.2=3"));
    TEST_ASSERT_TRUE(box.sent_ns[1] - box.sent_ns[0] >= 8 * MS);
}

/* Whether a transfer that was under way arrives is not known: what comes next keeps the longer distance from its end. */
static void test_a_string_that_is_cancelled_on_its_way_keeps_its_distance(void)
{
    box.delay = 10;
    const uint32_t first = send("O2.2");
    while (!box.sdo || !box.sdo->write)
        steps(1, true);
    cm1e_drive_cml_cancel(&cml, first, CM1E_ERROR_CANCELLED);
    box.delay = 0;
    finish(send("F2.2"));
    TEST_ASSERT_EQUAL(2, box.sent_count);
    TEST_ASSERT_INT64_WITHIN(MS, 10 * MS, box.sent_ns[1] - box.sent_ns[0]); /* 8 ms, from the step that sees the end */
}

/* ---- the queue --------------------------------------------------------------------------------------------------- */

static void test_the_queue_is_bounded_and_forgets_the_oldest(void)
{
    uint32_t tickets[CM1E_DRIVE_CML_QUEUE], one_more;
    for (int i = 0; i < CM1E_DRIVE_CML_QUEUE; i++)
        tickets[i] = send("O2.2");
    TEST_ASSERT_EQUAL(CM1E_ERROR_FULL, cm1e_drive_cml_send(&cml, "O2.2", 0, &one_more));
    TEST_ASSERT_EQUAL(0, one_more);
    finish(tickets[CM1E_DRIVE_CML_QUEUE - 1]);
    finish(send("F2.2"));
    TEST_ASSERT_NULL(cm1e_drive_cml_request(&cml, tickets[0]));
    TEST_ASSERT_NOT_NULL(cm1e_drive_cml_request(&cml, tickets[1]));
    TEST_ASSERT_NULL(cm1e_drive_cml_request(&cml, 0));
    TEST_ASSERT_EQUAL(CM1E_ERROR_CML_STRING, cm1e_drive_cml_send(&cml, "K53.1", 0, &one_more)); /* another motor */
}

static void test_the_lines_of_a_list_stay_until_the_next_string_the_first_longer(void)
{
    answers("K21.2=1\r\n", 1, 4);
    answers("K22.2=2\r\n", 1, 4);
    const uint32_t list = send("?90.2");
    finish(list);
    TEST_ASSERT_EQUAL_STRING("K22.2=2", cm1e_drive_cml_line(&cml, list, 1));
    finish(send("O2.2"));
    TEST_ASSERT_NULL(cm1e_drive_cml_line(&cml, list, 1));
    TEST_ASSERT_EQUAL_STRING("K21.2=1", cm1e_drive_cml_line(&cml, list, 0));
}

/* ---- what goes wrong --------------------------------------------------------------------------------------------- */

static void test_a_damaged_answer_is_an_error(void)
{
    static const char *const lines[] = {"K53.2=10", "K53.2=1\x02\r\n", "K53.2=\r\n",
                                        "12345678901234567890123456789012345678901234567890123456789012345\r\n"};
    for (unsigned i = 0; i < 4; i++) {
        answers(lines[i], i + 1, 4);
        TEST_ASSERT_EQUAL_MESSAGE(CM1E_ERROR_CML_ANSWER, finish(send("K53.2"))->error, lines[i]);
    }
    answers("K53.2=1\r\n", 5, 4); /* and the next one is well */
    TEST_ASSERT_EQUAL(CM1E_DRIVE_CML_DONE, finish(send("K53.2"))->state);
}

/* The slave is lost in each of the transfers: the request ends with that error, and the next one works. */
static void test_every_transfer_may_fail(void)
{
    unsigned failures = 0;
    for (unsigned at = 1; at < 20; at++) {
        setUp();
        box.fail_at = at;
        box.failure = at % 2 ? CM1E_ERROR_BUS_LOST : CM1E_ERROR_SDO_ABORT;
        answers("K21.2=1\r\n", 1, 4);
        answers("K22.2=1\r\n", 1, 12);
        answers("K23.2=1\r\n", 1, 20);
        const cm1e_drive_cml_request_t *request = finish(send("?90.2"));
        failures += request->error == box.failure;
        TEST_ASSERT_TRUE(request->error == CM1E_OK || request->error == box.failure);
        TEST_ASSERT_TRUE(cm1e_drive_cml_idle(&cml));
        box.answer_next = box.answer_count;
        box.fail_at = 0;
        TEST_ASSERT_EQUAL(CM1E_DRIVE_CML_DONE, finish(send("O2.2"))->state);
    }
    TEST_ASSERT_TRUE(failures >= 5);
}

static void test_mode_lost_or_cancelled_at_every_step(void)
{
    for (int cancel = 0; cancel < 2; cancel++)
        for (int at = 1; at < 60; at++) {
            setUp();
            box.delay = (unsigned)at % 4;
            answers("K53.2=1\r\n", 1, 20);
            const uint32_t ticket = send("K53.2");
            steps(at, true);
            const bool before = cm1e_drive_cml_request(&cml, ticket)->state == CM1E_DRIVE_CML_DONE;
            if (cancel)
                cm1e_drive_cml_cancel(&cml, ticket, CM1E_ERROR_CANCELLED);
            steps(2100, !!cancel);
            const cm1e_drive_cml_request_t *request = cm1e_drive_cml_request(&cml, ticket);
            if (before)
                TEST_ASSERT_EQUAL(CM1E_OK, request->error);
            else if (cancel)
                TEST_ASSERT_EQUAL(CM1E_ERROR_CANCELLED, request->error);
            else if (request->error != CM1E_OK) /* or the answer had just come */
                TEST_ASSERT_TRUE(request->error == CM1E_ERROR_DRIVE_MODE_LOST ||
                                 request->error == CM1E_ERROR_DRIVE_MODE_TIMEOUT);
            TEST_ASSERT_TRUE(request->error != CM1E_OK || request->lines == 1);
            TEST_ASSERT_TRUE(cm1e_drive_cml_idle(&cml));
            answers("K54.2=2\r\n", box.sent_count + 1, 4);
            request = finish(send("K54.2"));
            TEST_ASSERT_EQUAL_STRING("K54.2=2", request->first);
        }
}

static void test_a_waiting_string_can_be_cancelled_and_all(void)
{
    const uint32_t first = send("?99.2"), second = send("O2.2"), third = send("F2.2");
    steps(3, true);
    cm1e_drive_cml_cancel(&cml, second, CM1E_ERROR_CANCELLED);
    answers("Ux.2=8\r\n", 1, 4);
    finish(third);
    TEST_ASSERT_EQUAL(CM1E_DRIVE_CML_DONE, cm1e_drive_cml_request(&cml, first)->state);
    TEST_ASSERT_EQUAL(CM1E_ERROR_CANCELLED, cm1e_drive_cml_request(&cml, second)->error);
    TEST_ASSERT_EQUAL(2, box.sent_count);
    const uint32_t fourth = send("?99.2"), fifth = send("?99.2");
    steps(5, true);
    cm1e_drive_cml_cancel_all(&cml, CM1E_ERROR_BUS_LOST);
    TEST_ASSERT_EQUAL(CM1E_ERROR_BUS_LOST, cm1e_drive_cml_request(&cml, fourth)->error);
    TEST_ASSERT_EQUAL(CM1E_ERROR_BUS_LOST, cm1e_drive_cml_request(&cml, fifth)->error);
    steps(10, true);
    TEST_ASSERT_TRUE(cm1e_drive_cml_idle(&cml));
    cm1e_drive_cml_cancel(&cml, first, CM1E_ERROR_CANCELLED); /* ended: stays what it was */
    TEST_ASSERT_EQUAL(0, cm1e_drive_cml_request(&cml, 0) != NULL);
}

static void test_who_cancels_an_unknown_string_cancels_none(void)
{
    const uint32_t ticket = send("O2.2");
    for (uint32_t other = 0; other < 3 * CM1E_DRIVE_CML_QUEUE; other++)
        if (other != ticket)
            cm1e_drive_cml_cancel(&cml, other, CM1E_ERROR_CANCELLED);
    TEST_ASSERT_EQUAL(CM1E_DRIVE_CML_DONE, finish(ticket)->state);
    TEST_ASSERT_TRUE(cm1e_drive_cml_idle(&cml)); /* in the same step */
}

/* After 4 billion strings the numbers begin anew. */
static void test_no_string_has_the_ticket_0(void)
{
    cml.head = cml.next = UINT32_MAX - 5;
    for (int i = 0; i < 3; i++) {
        uint32_t tickets[3];
        for (int k = 0; k < 3; k++)
            tickets[k] = send("O2.2");
        for (int k = 0; k < 3; k++) {
            TEST_ASSERT_NOT_EQUAL_UINT32(0, tickets[k]);
            TEST_ASSERT_EQUAL(CM1E_DRIVE_CML_DONE, finish(tickets[k])->state);
        }
    }
    TEST_ASSERT_EQUAL(STRINGS, box.sent_count);
}

static void test_a_full_queue_of_transfers_is_waited_for_but_not_for_ever(void)
{
    box.full = true;
    const uint32_t ticket = send("O2.2");
    steps(2000, true);
    TEST_ASSERT_EQUAL(CM1E_DRIVE_CML_ACTIVE, cm1e_drive_cml_request(&cml, ticket)->state);
    steps(1, true);
    TEST_ASSERT_EQUAL(CM1E_ERROR_FULL, cm1e_drive_cml_request(&cml, ticket)->error);
    box.full = false;
    TEST_ASSERT_EQUAL(CM1E_DRIVE_CML_DONE, finish(send("O2.2"))->state);
}

/* Whatever the mailbox holds, every string ends, and no line is longer than it may be. */
static void test_random_mailboxes_do_no_harm(void)
{
    static const char *const parts[] = {"K53.2=1\r\n", "Ux.2=8\r\n", "Ux.2=0\r\n", "Origin.2=1\r\n", "Null\r\n", "\r\n",
                                        "K53.2", "Hello\r\n", "\x01\x02", "K21.2=1\r\nK22.2=2\r\nNull\r\n", "=.\r\n"};
    static const char *const texts[] = {"K53.2", "?90.2", "|.2", "^.2", "O2.2", "K53.2,?99.2", "?99.2,|.2,?1000",
                                        "%87"};
    static char lines[64][96];
    for (int run = 0; run < seed_count(400); run++) {
        chance_seed(seed_of(run));
        setUp();
        box.delay = (unsigned)pick(5);
        for (int i = 0; i < 60; i++) {
            snprintf(lines[i], sizeof lines[i], "%s%s%s", parts[pick(11)], one_in(3) ? parts[pick(11)] : "",
                     one_in(20) ? "0123456789012345678901234567890123456789" : "");
            answers(lines[i], (unsigned)pick(4), pick(40));
        }
        for (int i = 0; i < 6; i++) {
            uint32_t ticket;
            TEST_ASSERT_EQUAL(CM1E_OK, cm1e_drive_cml_send(&cml, texts[pick(8)], (1 + pick(200)) * MS, &ticket));
            if (one_in(5)) {
                steps(pick(30), true);
                cm1e_drive_cml_cancel(&cml, ticket, CM1E_ERROR_CANCELLED);
            }
            const cm1e_drive_cml_request_t *request = finish(ticket);
            for (unsigned n = 0; n < request->lines; n++)
                TEST_ASSERT_TRUE(strlen(cm1e_drive_cml_line(&cml, ticket, n)) <= CM1E_CML_BYTES);
        }
        steps(10, true);
        TEST_ASSERT_TRUE(cm1e_drive_cml_idle(&cml));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_query_waits_for_its_answer);
    RUN_TEST(test_nothing_goes_out_before_mode_and_controlword_are_right);
    RUN_TEST(test_answers_to_earlier_queries_are_set_aside);
    RUN_TEST(test_what_waited_before_the_query_is_no_answer_to_it);
    RUN_TEST(test_a_mailbox_that_never_is_empty_does_not_hold_up_for_ever);
    RUN_TEST(test_no_answer_is_a_time_out);
    RUN_TEST(test_several_queries_in_one_string);
    RUN_TEST(test_a_stray_is_shown_alone_and_printable_until_the_next_string);
    RUN_TEST(test_an_answer_as_long_as_its_string_is_an_answer);
    RUN_TEST(test_an_echo_is_no_stray);
    RUN_TEST(test_a_list_of_one_line_ends_behind_it);
    RUN_TEST(test_a_string_that_is_cancelled_on_its_way_keeps_its_distance);
    RUN_TEST(test_who_cancels_an_unknown_string_cancels_none);
    RUN_TEST(test_no_string_has_the_ticket_0);
    RUN_TEST(test_a_write_is_done_when_it_is_sent);
    RUN_TEST(test_a_search_ends_with_origin_or_fails_with_the_state);
    RUN_TEST(test_a_list_is_read_every_10_ms_until_it_is_empty);
    RUN_TEST(test_lines_beyond_the_most_are_counted_and_other_kinds_set_aside);
    RUN_TEST(test_an_empty_list_is_a_time_out_and_an_unknown_command_may_be_silent);
    RUN_TEST(test_strings_keep_their_distance);
    RUN_TEST(test_a_string_of_exactly_32_bytes_counts_as_long);
    RUN_TEST(test_the_queue_is_bounded_and_forgets_the_oldest);
    RUN_TEST(test_the_lines_of_a_list_stay_until_the_next_string_the_first_longer);
    RUN_TEST(test_a_damaged_answer_is_an_error);
    RUN_TEST(test_every_transfer_may_fail);
    RUN_TEST(test_mode_lost_or_cancelled_at_every_step);
    RUN_TEST(test_a_waiting_string_can_be_cancelled_and_all);
    RUN_TEST(test_a_full_queue_of_transfers_is_waited_for_but_not_for_ever);
    RUN_TEST(test_random_mailboxes_do_no_harm);
    return UNITY_END();
}
