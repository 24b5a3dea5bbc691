/* SDO information against a mailbox made by hand: lists in fragments, every lost frame, every lie of a slave; and what
 * is taken out of answers of any content. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unity.h>

#include "../support/mailbox_slave.h"
#include "bus/coe_client.h"
#include "bus/info_answer.h"

enum { STEP_NS = 100000, OBJECTS_MAX = 400 };
enum { BODY = 6 /* mailbox header */, DATA = 12 /* and that of the service */ };
enum { PER_FRAGMENT = (MAILBOX - DATA) / 2 };
enum { WAY_OK = 0, WAY_THERE, WAY_BACK };

static slave_t slave;
static cm1e_coe_client_t client;
static uint8_t buffer[4 * OBJECTS_MAX];
static int64_t now_ns;
static unsigned datagrams;
static int (*loss)(unsigned n);

/* ---- the server: a list of `objects` indexes from 0x2000 on, descriptions that repeat what was asked ------------ */

static unsigned objects, next_object;
static bool listing;
static uint16_t list_type;

static void send_information(slave_t *s, unsigned opcode, uint16_t left, const uint8_t *data, size_t size)
{
    uint8_t answer[MAILBOX] = {0};
    cm1e_put_u16(answer + BODY, 8 << 12);
    answer[BODY + 2] = (uint8_t)(opcode | (left ? 0x80 : 0));
    cm1e_put_u16(answer + BODY + 4, left);
    memcpy(answer + DATA, data, size);
    send_answer(s, answer, (uint16_t)(6 + size));
}

/** Words of the list: its type, then the indexes. */
static void send_fragment(slave_t *s)
{
    uint8_t data[2 * PER_FRAGMENT];
    const unsigned words = objects + 1, end = next_object + PER_FRAGMENT < words ? next_object + PER_FRAGMENT : words;
    size_t size = 0;
    for (; next_object < end; next_object++, size += 2)
        cm1e_put_u16(data + size, next_object == 0 ? list_type : (uint16_t)(0x2000 + next_object - 1));
    listing = end < words;
    send_information(s, 2, (uint16_t)((words - end + PER_FRAGMENT - 1) / PER_FRAGMENT), data, size);
}

static void send_more(slave_t *s)
{
    if (listing)
        send_fragment(s);
}

static void serve_information(slave_t *s, const uint8_t *request, uint16_t length)
{
    const uint16_t index = cm1e_get_u16(request + 6);
    uint8_t data[24] = {0};
    listing = false;
    cm1e_put_u16(data, index);
    if (index >= 0x5000) {
        cm1e_put_u32(data, 0x06020000);
        send_information(s, 7, 0, data, 4);
    } else if (request[2] == INFO_LIST) {
        TEST_ASSERT_EQUAL_UINT16(8, length);
        list_type = index;
        next_object = 0;
        send_fragment(s);
    } else if (request[2] == INFO_OBJECT) {
        TEST_ASSERT_EQUAL_UINT16(8, length);
        memcpy(data + 2, "\x07\x00\x02\x09Name", 8);
        send_information(s, 4, 0, data, 10);
    } else {
        TEST_ASSERT_EQUAL_UINT16(10, length);
        TEST_ASSERT_EQUAL_HEX8(INFO_ENTRY, request[2]);
        data[2] = request[8];
        data[3] = request[9];
        memcpy(data + 4, "\x06\x00\x10\x00\x3F\x00""abcdefName", 16);
        send_information(s, 6, 0, data, 20);
    }
}

/* ---- running ----------------------------------------------------------------------------------------------------- */

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

static void step(void)
{
    static cm1e_datagram_t d;
    now_ns += STEP_NS;
    if (!cm1e_coe_next(&client, &d, now_ns))
        return;
    const int way = loss(++datagrams);
    if (way != WAY_THERE)
        handle(&slave, &d);
    if (way != WAY_OK) {
        memset(d.data, 0xEE, MAILBOX);
        d.working_counter = DATAGRAM_LOST;
    }
    cm1e_coe_result(&client, &d, now_ns);
    TEST_ASSERT_TRUE_MESSAGE(datagrams < 60000, "endless");
}

static void run(cm1e_info_request_t *request)
{
    datagrams = 0;
    cm1e_coe_begin_info(&client, request, now_ns);
    while (!request->done)
        step();
    TEST_ASSERT_TRUE(cm1e_coe_idle(&client));
    TEST_ASSERT_EQUAL_size_t(request->error == CM1E_OK ? request->taken : 0, request->size);
}

static cm1e_info_request_t asking(cm1e_info_kind_t kind, uint16_t index)
{
    return (cm1e_info_request_t){.kind = kind, .index = index, .subindex = 3, .values = 0x10, .answer = buffer,
                                 .size = sizeof buffer};
}

void setUp(void)
{
    slave = (slave_t){.latency = 2, .size = 4, .serve_information = serve_information, .send_more = send_more};
    client = (cm1e_coe_client_t){.mailbox = {.station = STATION, .out_start = OUT, .out_length = MAILBOX,
                                             .in_start = IN, .in_length = MAILBOX}};
    objects = 5;
    listing = false;
    loss = no_loss;
    memset(buffer, 0xCC, sizeof buffer);
}
void tearDown(void) {}

static void check_list(const cm1e_info_request_t *request)
{
    TEST_ASSERT_EQUAL_INT(CM1E_OK, request->error);
    TEST_ASSERT_EQUAL_size_t(2 * (objects + 1), request->size);
    TEST_ASSERT_EQUAL_UINT16(1, cm1e_get_u16(buffer));
    for (unsigned i = 0; i < objects; i++)
        TEST_ASSERT_EQUAL_HEX16(0x2000 + i, cm1e_get_u16(buffer + 2 + 2 * i));
    TEST_ASSERT_EACH_EQUAL_HEX8(0xCC, buffer + request->size, 100);
}

/* ---- requests ---------------------------------------------------------------------------------------------------- */

static void test_lists_of_every_length_arrive_in_fragments(void)
{
    for (unsigned n = 0; n <= 300; n++) {
        setUp();
        objects = n;
        cm1e_info_request_t request = asking(INFO_LIST, 1);
        run(&request);
        check_list(&request);
    }
}

static void test_descriptions_are_those_that_were_asked_for(void)
{
    cm1e_info_request_t request = asking(INFO_OBJECT, 0x2345);
    run(&request);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, request.error);
    TEST_ASSERT_EQUAL_size_t(10, request.size);
    TEST_ASSERT_EQUAL_MEMORY("\x45\x23\x07\x00\x02\x09Name", buffer, 10);
    request = asking(INFO_ENTRY, 0x2345);
    run(&request);
    TEST_ASSERT_EQUAL_size_t(20, request.size);
    TEST_ASSERT_EQUAL_MEMORY("\x45\x23\x03\x10\x06", buffer, 5);
}

static void test_refusal_gives_its_code(void)
{
    cm1e_info_request_t request = asking(INFO_OBJECT, 0x5000);
    run(&request);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_SDO_ABORT, request.error);
    TEST_ASSERT_EQUAL_HEX32(0x06020000, request.abort_code);
    request = asking(INFO_LIST, 1); /* no fence needed: a refusal is an answer */
    run(&request);
    check_list(&request);
    TEST_ASSERT_EQUAL_UINT(2, slave.requests);
}

static void test_an_answer_larger_than_its_room_is_not_written_behind_it(void)
{
    objects = 60;
    for (size_t room = 0; room < 122; room++) {
        cm1e_info_request_t request = asking(INFO_LIST, 1);
        request.size = room;
        memset(buffer, 0xCC, sizeof buffer);
        run(&request);
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_INVALID_ARGUMENT, request.error);
        TEST_ASSERT_EACH_EQUAL_HEX8(0xCC, buffer + room, 200);
    }
}

static void test_a_mailbox_too_small_is_unsupported(void)
{
    client.mailbox.in_length = 15;
    cm1e_info_request_t request = asking(INFO_LIST, 1);
    run(&request);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_UNSUPPORTED, request.error);
}

static void test_a_slave_without_the_service_costs_three_seconds(void)
{
    slave.serve_information = NULL;
    cm1e_info_request_t request = asking(INFO_LIST, 1);
    const int64_t start_ns = now_ns;
    run(&request);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_TIMEOUT, request.error);
    TEST_ASSERT_TRUE(now_ns - start_ns <= INT64_C(3100000000));
}

static void test_cancel_and_reset_end_a_request(void)
{
    for (int how = 0; how < 2; how++) {
        setUp();
        cm1e_info_request_t request = asking(INFO_LIST, 1);
        cm1e_coe_begin_info(&client, &request, now_ns);
        step();
        if (how == 0)
            cm1e_coe_cancel(&client, CM1E_ERROR_CANCELLED);
        else
            cm1e_coe_reset(&client, CM1E_ERROR_CANCELLED);
        TEST_ASSERT_TRUE(request.done && request.error == CM1E_ERROR_CANCELLED && cm1e_coe_idle(&client));
        TEST_ASSERT_EQUAL(how == 0, client.doubtful);
    }
}

/* ---- frames that get lost ---------------------------------------------------------------------------------------- */

static void test_every_two_lost_frames_lose_nothing(void)
{
    objects = 60;
    for (lost_1 = 1; lost_1 <= 30; lost_1++)
        for (lost_2 = lost_1; lost_2 <= lost_1 + 6; lost_2++)
            for (int ways = 0; ways < 4; ways++) {
                setUp();
                objects = 60;
                way_1 = 1 + ways % 2;
                way_2 = 1 + ways / 2;
                loss = two_losses;
                cm1e_info_request_t request = asking(INFO_LIST, 1);
                run(&request);
                check_list(&request);
            }
}

static void test_a_third_of_all_frames_lost_gives_the_list_or_an_error(void)
{
    unsigned good = 0;
    for (unsigned seed = 1; seed <= 300; seed++) {
        setUp();
        srand(seed);
        objects = 60;
        loss = random_losses;
        cm1e_info_request_t request = asking(INFO_LIST, 1);
        run(&request);
        if (request.error != CM1E_OK)
            continue;
        good++;
        check_list(&request);
    }
    printf("%u of 300 lists arrive although a third of the frames is lost (seeds 1 ... 300)\n", good);
    TEST_ASSERT_TRUE(good > 250);
}

/* ---- lies -------------------------------------------------------------------------------------------------------- */

static bool lie_opcode(slave_t *s, uint8_t *answer)
{
    (void)s, answer[BODY + 2] ^= 0x07;
    return true;
}
static bool lie_index(slave_t *s, uint8_t *answer)
{
    (void)s, answer[DATA] ^= 1;
    return true;
}
static bool lie_subindex(slave_t *s, uint8_t *answer)
{
    (void)s, answer[DATA + 2] ^= 1;
    return true;
}
static bool lie_fragments_more(slave_t *s, uint8_t *answer)
{
    (void)s;
    cm1e_put_u16(answer + BODY + 4, 7);
    return true;
}
static bool lie_incomplete(slave_t *s, uint8_t *answer)
{
    (void)s;
    cm1e_put_u16(answer + BODY + 4, 0);
    answer[BODY + 2] |= 0x80;
    return true;
}
static bool lie_empty(slave_t *s, uint8_t *answer)
{
    (void)s, cm1e_put_u16(answer, 6);
    return true;
}
static bool lie_header_only(slave_t *s, uint8_t *answer)
{
    (void)s, cm1e_put_u16(answer, 5);
    return true;
}
static bool lie_too_long(slave_t *s, uint8_t *answer)
{
    (void)s, cm1e_put_u16(answer, MAILBOX);
    return true;
}
static bool lie_short_refusal(slave_t *s, uint8_t *answer)
{
    (void)s;
    answer[BODY + 2] = 7;
    cm1e_put_u16(answer, 9);
    return true;
}
static bool lie_service(slave_t *s, uint8_t *answer)
{
    (void)s, cm1e_put_u16(answer + BODY, 3 << 12);
    return true;
}
static bool lie_silence(slave_t *s, uint8_t *answer)
{
    (void)s, (void)answer;
    return false;
}

static const struct {
    lie_fn lie;
    cm1e_info_kind_t kind;
    unsigned from; /* answer */
    cm1e_error_t error;
} lies[] = {
    {lie_opcode, INFO_LIST, 1, CM1E_ERROR_TIMEOUT},
    {lie_index, INFO_LIST, 1, CM1E_ERROR_TIMEOUT},
    {lie_index, INFO_OBJECT, 1, CM1E_ERROR_TIMEOUT},
    {lie_index, INFO_ENTRY, 1, CM1E_ERROR_TIMEOUT},
    {lie_subindex, INFO_ENTRY, 1, CM1E_ERROR_TIMEOUT},
    {lie_service, INFO_LIST, 1, CM1E_ERROR_TIMEOUT},
    {lie_silence, INFO_LIST, 2, CM1E_ERROR_TIMEOUT},
    {lie_fragments_more, INFO_LIST, 2, CM1E_ERROR_BUS_MAILBOX},
    {lie_incomplete, INFO_LIST, 1, CM1E_ERROR_BUS_MAILBOX},
    {lie_incomplete, INFO_OBJECT, 1, CM1E_ERROR_BUS_MAILBOX},
    {lie_empty, INFO_LIST, 2, CM1E_ERROR_BUS_MAILBOX},
    {lie_header_only, INFO_LIST, 1, CM1E_ERROR_BUS_MAILBOX},
    {lie_too_long, INFO_LIST, 1, CM1E_ERROR_BUS_MAILBOX},
    {lie_short_refusal, INFO_OBJECT, 1, CM1E_ERROR_BUS_MAILBOX},
};

/** Afterwards the client is fit for an SDO and for the next request: what is still under way is passed over. */
static void test_every_lie_ends_in_its_error_and_spoils_nothing_after_it(void)
{
    for (size_t i = 0; i < sizeof lies / sizeof lies[0]; i++) {
        setUp();
        objects = 60;
        slave.lie = lies[i].lie;
        slave.lie_from = lies[i].from;
        cm1e_info_request_t request = asking(lies[i].kind, lies[i].kind == INFO_LIST ? 1 : 0x2000);
        run(&request);
        char which[32];
        snprintf(which, sizeof which, "lie %zu", i);
        TEST_ASSERT_EQUAL_INT_MESSAGE(lies[i].error, request.error, which);
        slave.lie = NULL;
        memset(buffer, 0xCC, sizeof buffer);
        request = asking(INFO_LIST, 1);
        run(&request);
        check_list(&request);
        uint8_t value[4];
        cm1e_sdo_t sdo = {.position = 1, .index = 0x2000, .subindex = 1, .data = value, .size = 4,
                          .state = CM1E_SDO_BUSY};
        cm1e_coe_begin(&client, &sdo, now_ns);
        while (cm1e_sdo_state(&sdo) == CM1E_SDO_BUSY)
            step();
        TEST_ASSERT_EQUAL_INT(CM1E_SDO_DONE, cm1e_sdo_state(&sdo));
    }
}

/** A slave that was slow: its list comes when the next request waits already. */
static void test_late_fragments_of_a_given_up_list_are_not_taken_for_the_next(void)
{
    objects = 60;
    cm1e_info_request_t request = asking(INFO_LIST, 1);
    cm1e_coe_begin_info(&client, &request, now_ns);
    for (int i = 0; i < 4; i++)
        step();
    cm1e_coe_cancel(&client, CM1E_ERROR_CANCELLED);
    request = asking(INFO_LIST, 1);
    slave.latency = 0;
    run(&request);
    check_list(&request);
}

static bool lie_at_random(slave_t *s, uint8_t *answer)
{
    (void)s;
    for (int n = rand() % 4; n > 0; n--)
        answer[rand() % (DATA + 8)] = (uint8_t)rand();
    return rand() % 8 > 0;
}

static void test_random_answers_end_in_bounded_time_within_the_room(void)
{
    const unsigned seed = (unsigned)time(NULL);
    printf("seed %u\n", seed);
    srand(seed);
    for (int i = 0; i < 400; i++) {
        setUp();
        objects = (unsigned)rand() % 100;
        slave.lie = lie_at_random;
        cm1e_info_request_t request = asking((cm1e_info_kind_t)(1 + 2 * (rand() % 3)), 1);
        request.size = (size_t)rand() % 300;
        const size_t room = request.size;
        run(&request);
        TEST_ASSERT_TRUE(request.size <= room);
        TEST_ASSERT_EACH_EQUAL_HEX8(0xCC, buffer + room, 100);
    }
}

/* ---- answers taken apart ----------------------------------------------------------------------------------------- */

static void test_an_entry_is_taken_apart_by_what_the_answer_says_it_holds(void)
{
    static const uint8_t full[] = {0x99, 0x60, 1,    0x78, 0x06, 0, 16, 0, 0x3F, 0,   0,  0,
                                   0xB4, 0,    0x10, 0x27, 1,    0, 2,  0, 'S',  0, 'x'};
    cm1e_entry_info_t info;
    TEST_ASSERT_TRUE(cm1e_info_take_entry(&info, full, sizeof full));
    TEST_ASSERT_EQUAL_HEX16(0x6099, info.index);
    TEST_ASSERT_EQUAL_UINT(1, info.subindex);
    TEST_ASSERT_EQUAL_UINT(6, info.data_type);
    TEST_ASSERT_EQUAL_UINT(16, info.bits);
    TEST_ASSERT_EQUAL_HEX16(0x3F, info.access);
    TEST_ASSERT_TRUE(info.unit_given);
    TEST_ASSERT_EQUAL_HEX32(0x00B40000, info.unit);
    TEST_ASSERT_EQUAL_UINT(2, info.default_value.size);
    TEST_ASSERT_EQUAL_UINT(10000, cm1e_get_u16(info.default_value.bytes));
    TEST_ASSERT_EQUAL_UINT(1, info.minimum.bytes[0]);
    TEST_ASSERT_EQUAL_UINT(2, info.maximum.bytes[0]);
    TEST_ASSERT_EQUAL_STRING("S", info.name);
    for (size_t size = 0; size < 20; size++) /* what it says does not fit in */
        TEST_ASSERT_FALSE(cm1e_info_take_entry(&info, full, size));
    uint8_t plain[sizeof full];
    memcpy(plain, full, sizeof full);
    plain[3] = 7; /* what every answer has: no values */
    TEST_ASSERT_TRUE(cm1e_info_take_entry(&info, plain, 10));
    TEST_ASSERT_EQUAL_STRING("", info.name);
    TEST_ASSERT_EQUAL_UINT(0, info.default_value.size);
    TEST_ASSERT_FALSE(info.unit_given);
    /* a long text as a default value is passed over */
    uint8_t text[10 + 20 + 3] = {8, 0x10, 0, 0x10, 9, 0, 160, 0, 7, 0};
    memcpy(text + 30, "abc", 3);
    TEST_ASSERT_TRUE(cm1e_info_take_entry(&info, text, sizeof text));
    TEST_ASSERT_EQUAL_UINT(0, info.default_value.size);
    TEST_ASSERT_EQUAL_STRING("abc", info.name);
}

/* As the ESI of the device has them: UTF-8 as it is, ISO 8859-1 brought to it. */
static void test_names_that_are_not_ascii_are_those_of_the_esi(void)
{
    static const char *const told[] = {"Gr\xC3\xB6\xC3\x9F" "e", "Gr\xF6\xDF" "e"};
    for (size_t i = 0; i < 2; i++) {
        uint8_t object[6 + 16] = {0x00, 0x10, 7, 0, 0, 7}, entry[10 + 16] = {0x00, 0x10, 0, 0, 7, 0, 32, 0};
        cm1e_object_info_t info;
        cm1e_entry_info_t entry_info;
        memcpy(object + 6, told[i], strlen(told[i]));
        memcpy(entry + 10, told[i], strlen(told[i]));
        TEST_ASSERT_TRUE(cm1e_info_take_object(&info, object, 6 + strlen(told[i])));
        TEST_ASSERT_EQUAL_STRING(told[0], info.name);
        TEST_ASSERT_TRUE(cm1e_info_take_entry(&entry_info, entry, 10 + strlen(told[i])));
        TEST_ASSERT_EQUAL_STRING(told[0], entry_info.name);
    }
}

static void test_names_are_cut_and_printable(void)
{
    uint8_t answer[6 + 200] = {0x00, 0x10, 7, 0, 0, 7};
    cm1e_object_info_t info;
    memset(answer + 6, 'n', 200);
    answer[8] = 0x1B;
    TEST_ASSERT_TRUE(cm1e_info_take_object(&info, answer, sizeof answer));
    TEST_ASSERT_EQUAL_size_t(CM1E_INFO_NAME - 1, strlen(info.name));
    TEST_ASSERT_EQUAL_CHAR('?', info.name[2]);
    for (size_t size = 0; size < 6; size++)
        TEST_ASSERT_FALSE(cm1e_info_take_object(&info, answer, size));
    static const uint8_t object[] = {0x18, 0x10, 0x23, 0x01, 4, 9, 'I', 'd'};
    for (size_t size = 6; size <= sizeof object; size++) {
        TEST_ASSERT_TRUE(cm1e_info_take_object(&info, object, size));
        TEST_ASSERT_EQUAL_HEX16(0x1018, info.index);
        TEST_ASSERT_EQUAL_HEX16(0x0123, info.data_type);
        TEST_ASSERT_EQUAL_UINT(4, info.highest_subindex);
        TEST_ASSERT_EQUAL_UINT(9, info.code);
        TEST_ASSERT_EQUAL_size_t(size - 6, strlen(info.name));
    }
}

/** The widest value that is kept, and one that fills the answer to its end. */
static void test_values_up_to_eight_bytes_are_kept(void)
{
    uint8_t answer[10 + 9] = {0x64, 0x60, 0, INFO_VALUE_DEFAULT, 0x15, 0, 0, 0, 7, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
    cm1e_entry_info_t info;
    for (unsigned bytes = 1; bytes <= 9; bytes++) {
        answer[6] = (uint8_t)(8 * bytes);
        TEST_ASSERT_TRUE(cm1e_info_take_entry(&info, answer, 10 + bytes));
        TEST_ASSERT_EQUAL_UINT(bytes <= 8 ? bytes : 0, info.default_value.size);
        if (bytes <= 8)
            TEST_ASSERT_EQUAL_HEX8_ARRAY(answer + 10, info.default_value.bytes, bytes);
        TEST_ASSERT_FALSE(cm1e_info_take_entry(&info, answer, 10 + bytes - 1));
    }
}

static void test_a_list_has_whole_indexes_and_fits(void)
{
    uint16_t indexes[4] = {0};
    size_t count;
    const uint8_t answer[] = {1, 0, 0x00, 0x10, 0x18, 0x10};
    TEST_ASSERT_TRUE(cm1e_info_take_list(indexes, 2, &count, answer, 6));
    TEST_ASSERT_EQUAL_size_t(2, count);
    TEST_ASSERT_EQUAL_HEX16(0x1000, indexes[0]);
    TEST_ASSERT_EQUAL_HEX16(0x1018, indexes[1]);
    TEST_ASSERT_TRUE(cm1e_info_take_list(indexes, 0, &count, answer, 2)); /* none */
    TEST_ASSERT_EQUAL_size_t(0, count);
    TEST_ASSERT_FALSE(cm1e_info_take_list(indexes, 1, &count, answer, 6));
    TEST_ASSERT_FALSE(cm1e_info_take_list(indexes, 4, &count, answer, 5));
    TEST_ASSERT_FALSE(cm1e_info_take_list(indexes, 4, &count, answer, 0));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_lists_of_every_length_arrive_in_fragments);
    RUN_TEST(test_descriptions_are_those_that_were_asked_for);
    RUN_TEST(test_refusal_gives_its_code);
    RUN_TEST(test_an_answer_larger_than_its_room_is_not_written_behind_it);
    RUN_TEST(test_a_mailbox_too_small_is_unsupported);
    RUN_TEST(test_a_slave_without_the_service_costs_three_seconds);
    RUN_TEST(test_cancel_and_reset_end_a_request);
    RUN_TEST(test_every_two_lost_frames_lose_nothing);
    RUN_TEST(test_a_third_of_all_frames_lost_gives_the_list_or_an_error);
    RUN_TEST(test_every_lie_ends_in_its_error_and_spoils_nothing_after_it);
    RUN_TEST(test_late_fragments_of_a_given_up_list_are_not_taken_for_the_next);
    RUN_TEST(test_random_answers_end_in_bounded_time_within_the_room);
    RUN_TEST(test_an_entry_is_taken_apart_by_what_the_answer_says_it_holds);
    RUN_TEST(test_values_up_to_eight_bytes_are_kept);
    RUN_TEST(test_names_are_cut_and_printable);
    RUN_TEST(test_names_that_are_not_ascii_are_those_of_the_esi);
    RUN_TEST(test_a_list_has_whole_indexes_and_fits);
    return UNITY_END();
}
