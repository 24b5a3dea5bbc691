/* The CoE client, message by message (ETG.1000.6): what each request and each abort is on the wire, to the byte; what
 * ends a transfer, and when its time is over. */
#include <string.h>

#include "bus/coe_client.h"
#include "core/bytes.h"
#include "unity.h"

enum { STATION = 0x1003, OUT = 0x1000, IN = 0x1080, LENGTH = 32, ROOM = LENGTH - 6 - 10, STEP_NS = 1000 };
enum { INDEX = 0x2345, SUB = 7 };

static cm1e_coe_client_t client;
static cm1e_sdo_t sdo;
static uint8_t data[64], asked[LENGTH], answers[8][LENGTH];
static unsigned put, taken, requests; /* answers; messages of the client */
static uint8_t counter;
static int64_t now_ns;

void setUp(void)
{
    client = (cm1e_coe_client_t){.mailbox = {.station = STATION, .out_start = OUT, .out_length = LENGTH, .in_start = IN,
                                             .in_length = LENGTH}};
    for (unsigned i = 0; i < sizeof data; i++)
        data[i] = (uint8_t)(0x81 + i);
    put = taken = requests = 0;
    counter = 0;
    now_ns = 5000;
}
void tearDown(void) {}

/* ---- the slave: its mailbox takes everything, and gives the answers in their order ------------------------------- */

static void message(uint8_t type, const void *body, size_t size)
{
    uint8_t *answer = answers[put++ % 8];
    memset(answer, 0, LENGTH);
    cm1e_put_u16(answer, (uint16_t)size);
    counter = (uint8_t)(counter % 7 + 1);
    answer[5] = (uint8_t)(type | counter << 4);
    memcpy(answer + 6, body, size < LENGTH - 6 ? size : LENGTH - 6);
}

/** An SDO answer: command, object, four bytes, and more. */
static void answer(unsigned command, uint32_t value, const void *more, size_t size)
{
    uint8_t body[LENGTH] = {0, 0x30, (uint8_t)command, INDEX & 0xFF, INDEX >> 8, SUB};
    cm1e_put_u32(body + 6, value);
    if (size)
        memcpy(body + 10, more, size);
    message(MAILBOX_TYPE_COE, body, 10 + size);
}

static void segment(unsigned command, const void *bytes, size_t size)
{
    uint8_t body[LENGTH] = {0, 0x30, (uint8_t)command};
    memcpy(body + 3, bytes, size);
    message(MAILBOX_TYPE_COE, body, 3 + (size < 7 ? 7 : size));
}

static void serve(cm1e_datagram_t *d)
{
    TEST_ASSERT_EQUAL_HEX16(STATION, d->address);
    d->working_counter = 1;
    if (d->command == COMMAND_FPWR && d->offset == OUT) {
        memcpy(asked, d->data, LENGTH);
        requests++;
    } else if (d->command == COMMAND_FPRD && d->offset == IN) {
        memcpy(d->data, answers[taken++ % 8], LENGTH);
    } else {
        memset(d->data, 0, d->length);
        d->data[(d->offset == REG_SM0 ? 8 : 0) + 5] = taken < put ? SM_STATUS_FULL : 0;
    }
}

/** One datagram; false: the client has none. */
static bool step(void)
{
    cm1e_datagram_t d = {0};
    now_ns += STEP_NS;
    if (!cm1e_coe_next(&client, &d, now_ns))
        return false;
    serve(&d);
    cm1e_coe_result(&client, &d, now_ns);
    return true;
}

static void run_until_request(unsigned number)
{
    for (int n = 0; requests < number && n < 50; n++)
        step();
    TEST_ASSERT_EQUAL(number, requests);
}

/** Takes the answers that are there. */
static void take_all(void)
{
    for (int n = 0; n < 400 && taken < put && step(); n++) {}
}

static void begin(bool write, size_t size, bool complete)
{
    sdo = (cm1e_sdo_t){.position = 1, .index = INDEX, .subindex = SUB, .write = write, .data = data, .size = size,
                       .complete_access = complete, .state = CM1E_SDO_BUSY};
    cm1e_coe_begin(&client, &sdo, now_ns);
}

static void expect_asked(const uint8_t *body, size_t size)
{
    TEST_ASSERT_EQUAL(size, cm1e_get_u16(asked));
    TEST_ASSERT_EQUAL(MAILBOX_TYPE_COE, asked[5] & 0x0F);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(body, asked + 6, size);
    for (size_t i = 6 + size; i < LENGTH; i++)
        TEST_ASSERT_EQUAL_HEX8(0, asked[i]);
}

static void expect_end(cm1e_error_t error, uint32_t code)
{
    TEST_ASSERT_TRUE(cm1e_coe_idle(&client));
    TEST_ASSERT_EQUAL_INT(error, sdo.error);
    TEST_ASSERT_EQUAL_HEX32(code, sdo.abort_code);
    TEST_ASSERT_EQUAL_INT(error == CM1E_OK ? CM1E_SDO_DONE : CM1E_SDO_ERROR, cm1e_sdo_state(&sdo));
}

static void expect_abort(unsigned number, uint32_t code)
{
    uint8_t body[10] = {0, 0x20, 0x80, INDEX & 0xFF, INDEX >> 8, SUB};
    cm1e_put_u32(body + 6, code);
    run_until_request(number);
    expect_asked(body, sizeof body);
}

/* ---- requests ---------------------------------------------------------------------------------------------------- */

static void test_requests_are_those_of_the_standard(void)
{
    static const struct {
        bool write, complete;
        size_t size;
        uint8_t command; /* and behind the object: the data, or their size and the first of them */
    } rows[] = {
        {false, false, 4, 0x40}, {false, true, 4, 0x50}, {false, false, 0, 0x40},
        {true, false, 1, 0x2F}, {true, false, 2, 0x2B}, {true, false, 3, 0x27}, {true, false, 4, 0x23},
        {true, true, 2, 0x3B}, {true, false, 0, 0x21}, {true, false, 5, 0x21}, {true, true, 5, 0x31},
        {true, false, ROOM, 0x21}, {true, false, ROOM + 1, 0x21},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        const bool expedited = rows[i].size >= 1 && rows[i].size <= 4;
        const size_t first = !rows[i].write || expedited ? 0 : rows[i].size < ROOM ? rows[i].size : ROOM;
        uint8_t body[LENGTH] = {0, 0x20, rows[i].command, INDEX & 0xFF, INDEX >> 8, SUB};
        if (rows[i].write && expedited)
            memcpy(body + 6, data, rows[i].size);
        else if (rows[i].write)
            cm1e_put_u32(body + 6, (uint32_t)rows[i].size);
        memcpy(body + 10, data, first);
        begin(rows[i].write, rows[i].size, rows[i].complete);
        run_until_request(1);
        expect_asked(body, 10 + first);
        if (!rows[i].write || first < rows[i].size * !expedited)
            continue;
        answer(0x60, 0, NULL, 0);
        take_all();
        expect_end(CM1E_OK, 0);
    }
}

/** The toggle bit changes with each segment, and begins with 0 in each transfer. The last one says so, and how much of
 *  its seven bytes is not used. */
static void test_segments_are_those_of_the_standard(void)
{
    for (unsigned last = 1; last <= 9; last++) {
        setUp();
        for (int again = 0; again < 2; again++) {
            const unsigned before = requests, full = LENGTH - 6 - 3;
            const size_t size = ROOM + full + last;
            begin(true, size, false);
            run_until_request(before + 1);
            answer(0x60, 0, NULL, 0);
            run_until_request(before + 2);
            uint8_t body[LENGTH] = {0, 0x20, 0x00};
            memcpy(body + 3, data + ROOM, full);
            expect_asked(body, 3 + full);
            segment(0x20, "", 0);
            run_until_request(before + 3);
            memset(body + 3, 0, sizeof body - 3);
            body[2] = (uint8_t)(0x11 | (last < 7 ? 7 - last : 0) << 1);
            memcpy(body + 3, data + ROOM + full, last);
            expect_asked(body, 3 + (last < 7 ? 7 : last));
            segment(0x30, "", 0);
            take_all();
            expect_end(CM1E_OK, 0);
        }
    }
}

static void test_an_upload_in_segments_is_put_together(void)
{
    for (unsigned last = 0; last <= 9; last++) {
        setUp();
        for (int again = 0; again < 2; again++) {
            const unsigned before = requests;
            uint8_t all[ROOM + 8 + 9];
            for (unsigned i = 0; i < sizeof all; i++)
                all[i] = (uint8_t)(i * 5 + 1);
            begin(false, sizeof data, false);
            run_until_request(before + 1);
            answer(0x41, ROOM + 8 + last, all, ROOM);
            run_until_request(before + 2);
            expect_asked((const uint8_t[10]){0, 0x20, 0x60}, 10);
            segment(0x00, all + ROOM, 8);
            run_until_request(before + 3);
            expect_asked((const uint8_t[10]){0, 0x20, 0x70}, 10);
            segment(0x11 | (last < 7 ? 7 - last : 0) << 1, all + ROOM + 8, last);
            take_all();
            expect_end(CM1E_OK, 0);
            TEST_ASSERT_EQUAL(ROOM + 8 + last, sdo.size);
            TEST_ASSERT_EQUAL_HEX8_ARRAY(all, data, sdo.size);
        }
    }
}

/** One that fits into the first answer needs no segment. */
static void test_an_upload_in_one_message_ends_with_it(void)
{
    for (uint32_t size = 0; size <= ROOM; size++) {
        setUp();
        begin(false, sizeof data, false);
        run_until_request(1);
        answer(0x41, size, "0123456789abcdef", ROOM);
        take_all();
        expect_end(CM1E_OK, 0);
        TEST_ASSERT_EQUAL(size, sdo.size);
        TEST_ASSERT_EQUAL_INT(0, memcmp("0123456789abcdef", data, size));
        TEST_ASSERT_EQUAL_HEX8(0x81 + size, data[size]);
        TEST_ASSERT_EQUAL(1, requests);
    }
}

/** What a slave that does not say how many bytes are valid means: as many as were asked for, four at most. */
static void test_expedited_answers_give_their_bytes(void)
{
    static const struct {
        uint8_t command;
        size_t room, size; /* 0: it does not fit */
    } rows[] = {{0x43, 4, 4}, {0x47, 4, 3}, {0x4B, 4, 2}, {0x4F, 4, 1}, {0x4F, 1, 1}, {0x4B, 1, 0}, {0x43, 3, 0},
                {0x42, 2, 2}, {0x42, 9, 4}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        begin(false, rows[i].room, false);
        run_until_request(1);
        answer(rows[i].command, 0x44332211, NULL, 0);
        take_all();
        expect_end(rows[i].size ? CM1E_OK : CM1E_ERROR_INVALID_ARGUMENT, 0);
        for (size_t n = 0; n < sizeof data; n++)
            TEST_ASSERT_EQUAL_HEX8(n < rows[i].size ? 0x11 * (n + 1) : 0x81 + n, data[n]);
        TEST_ASSERT_EQUAL(rows[i].size ? rows[i].size : rows[i].room, sdo.size);
    }
}

/* ---- what ends a transfer ---------------------------------------------------------------------------------------- */

typedef enum phase { UPLOAD, UPLOAD_SEGMENT, DOWNLOAD, DOWNLOAD_SEGMENT } phase_t;

/** Brings a transfer into a phase; returns the number of requests so far. */
static unsigned begin_phase(phase_t phase)
{
    setUp();
    begin(phase >= DOWNLOAD, phase == DOWNLOAD ? 5 : ROOM + 9, false);
    run_until_request(1);
    if (phase == UPLOAD || phase == DOWNLOAD)
        return 1;
    answer(phase == UPLOAD_SEGMENT ? 0x41 : 0x60, ROOM + 9, data, phase == UPLOAD_SEGMENT ? ROOM : 0);
    run_until_request(2);
    return 2;
}

/** The slave is told by an abort with the right code, as it may hold the transfer open. */
static void test_wrong_answers_are_aborted_with_their_code(void)
{
    static const struct {
        phase_t phase;
        uint8_t command;
        uint32_t value; /* of the first answer; number of bytes of a segment */
        cm1e_error_t error;
        uint32_t code;
    } rows[] = {
        {UPLOAD, 0x60, 0, CM1E_ERROR_BUS_MAILBOX, 0x05040001},
        {UPLOAD, 0x41, ROOM + 10, CM1E_ERROR_INVALID_ARGUMENT, 0x05040005},
        {DOWNLOAD, 0x40, 0, CM1E_ERROR_BUS_MAILBOX, 0x05040001},
        {UPLOAD_SEGMENT, 0x10, 9, CM1E_ERROR_BUS_MAILBOX, 0x05030000},
        {UPLOAD_SEGMENT, 0x20, 9, CM1E_ERROR_BUS_MAILBOX, 0x05040001},
        {UPLOAD_SEGMENT, 0x01, 10, CM1E_ERROR_BUS_MAILBOX, 0x05040001},
        {UPLOAD_SEGMENT, 0x0E, 0, CM1E_ERROR_BUS_MAILBOX, 0x05040001},
        {UPLOAD_SEGMENT, 0x01, 8, CM1E_ERROR_BUS_MAILBOX, 0x08000000},
        {DOWNLOAD_SEGMENT, 0x30, 0, CM1E_ERROR_BUS_MAILBOX, 0x05030000},
        {DOWNLOAD_SEGMENT, 0x00, 0, CM1E_ERROR_BUS_MAILBOX, 0x05040001},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        const unsigned before = begin_phase(rows[i].phase);
        if (rows[i].phase == UPLOAD || rows[i].phase == DOWNLOAD)
            answer(rows[i].command, rows[i].value, NULL, 0);
        else
            segment(rows[i].command, data, rows[i].value);
        expect_abort(before + 1, rows[i].code);
        take_all();
        for (int n = 0; n < 5; n++)
            step();
        expect_end(rows[i].error, 0);
    }
}

static void test_a_refusal_ends_a_transfer_with_its_code(void)
{
    for (int phase = UPLOAD; phase <= DOWNLOAD_SEGMENT; phase++) {
        const unsigned before = begin_phase((phase_t)phase);
        answer(0x80, 0x06090030, NULL, 0);
        take_all();
        expect_end(CM1E_ERROR_SDO_ABORT, 0x06090030);
        TEST_ASSERT_EQUAL(before, requests);
        begin(false, 4, false); /* and the next one begins at once */
        run_until_request(before + 1);
        TEST_ASSERT_EQUAL_HEX8(0x40, asked[6 + 2]);
    }
}

/** The answer to another object is of an earlier transfer, and so are messages of other kinds; the 64th ends it. */
static void test_other_messages_are_passed_over(void)
{
    for (unsigned others = 62; others < 65; others++) {
        for (int kind = 0; kind < 5; kind++) {
            begin_phase(UPLOAD);
            for (unsigned n = 0; n < others; n++) {
                uint8_t body[10] = {0, 0x30, 0x43, INDEX & 0xFF, INDEX >> 8, SUB};
                body[3] ^= kind == 0;
                body[5] ^= kind == 1;
                if (kind == 2) /* an emergency */
                    body[1] = 0x10;
                if (kind == 3) /* a request */
                    body[1] = 0x20;
                message(kind == 4 ? MAILBOX_TYPE_FOE : MAILBOX_TYPE_COE, body, sizeof body);
                take_all();
            }
            if (others < 64) {
                answer(0x43, 1, NULL, 0);
                take_all();
            }
            TEST_ASSERT_EQUAL_INT(others < 64 ? CM1E_OK : CM1E_ERROR_BUS_MAILBOX, sdo.error);
            TEST_ASSERT_TRUE(cm1e_coe_idle(&client));
            TEST_ASSERT_EQUAL(kind == 2 ? others : 0, client.emergency.number);
        }
    }
}

/** The link layer of the slave refuses a message; its detail is kept for the diagnosis. */
static void test_a_mailbox_error_ends_a_transfer_with_its_detail(void)
{
    static const uint8_t body[] = {1, 0, 0x07, 0x01};
    for (int phase = UPLOAD; phase <= DOWNLOAD_SEGMENT; phase++) {
        for (size_t size = 2; size <= 4; size += 2) {
            const unsigned before = begin_phase((phase_t)phase);
            client.mailbox_error = 0x5555;
            message(MAILBOX_TYPE_ERROR, body, size);
            take_all();
            if (phase == UPLOAD_SEGMENT || phase == DOWNLOAD_SEGMENT)
                expect_abort(before + 1, 0x08000000);
            for (int n = 0; n < 5; n++)
                step();
            expect_end(CM1E_ERROR_BUS_MAILBOX, 0);
            TEST_ASSERT_EQUAL_HEX16(size == 4 ? 0x0107 : 0, client.mailbox_error);
        }
    }
}

/** What has ended a transfer stays its result, although the abort does not arrive in time; the next one owes it. */
static void test_a_transfer_that_failed_does_not_become_one_that_took_too_long(void)
{
    for (int begun = 0; begun < 2; begun++) {
        cm1e_datagram_t d;
        begin_phase(UPLOAD);
        answer(0x60, 0, NULL, 0);
        for (int n = 0; n < 20 && client.phase != COE_ABORT; n++)
            step();
        cm1e_coe_cancel(&client, CM1E_ERROR_TIMEOUT);
        expect_end(CM1E_ERROR_BUS_MAILBOX, 0);
        begin(false, 4, false);
        if (begun == 0)
            continue;
        while (cm1e_coe_next(&client, &d, now_ns)) { /* this one has not begun before the abort was delivered */
            d.working_counter = DATAGRAM_LOST;
            const uint32_t lost = client.lost_frames;
            cm1e_coe_result(&client, &d, now_ns);
            TEST_ASSERT_EQUAL_UINT32(lost + 1, client.lost_frames);
            now_ns += 1000000;
        }
        expect_end(CM1E_ERROR_TIMEOUT, 0);
    }
}

/** After a transfer that was given up: its abort, which a slave may refuse, then a question that every slave answers,
 *  each time another one, and not the one given up. All that comes before its answer is of before. */
static void test_a_transfer_that_was_given_up_is_over_before_the_next_begins(void)
{
    static const uint8_t fences[][3] = {{0x18, 0x10, 0}, {0x18, 0x10, 1}, {0x18, 0x10, 2}, {0x18, 0x10, 3},
                                        {0x00, 0x10, 0}};
    unsigned sent = begin_phase(UPLOAD);
    for (unsigned n = 0; n < 7; n++) {
        cm1e_coe_cancel(&client, CM1E_ERROR_CANCELLED);
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_CANCELLED, sdo.error);
        begin(false, 4, false);
        expect_abort(++sent, 0x08000000);
        if (n % 2) {
            message(MAILBOX_TYPE_ERROR, (const uint8_t[]){1, 0, 7, 0}, 4); /* refuses the abort */
            answer(0x43, 0xBAD, NULL, 0);                                  /* the late answer */
        }
        run_until_request(++sent);
        const uint8_t *fence = fences[n % 5];
        expect_asked((const uint8_t[10]){0, 0x20, 0x40, fence[0], fence[1], fence[2]}, 10);
        if (n % 2 == 0) /* the refusal of the abort comes late */
            message(MAILBOX_TYPE_ERROR, (const uint8_t[]){1, 0, 7, 0}, 4);
        take_all();
        TEST_ASSERT_FALSE(cm1e_coe_idle(&client));
        const bool abort = n % 3 == 0; /* which is an answer, too */
        message(MAILBOX_TYPE_COE, (const uint8_t[10]){0, abort ? 0x20 : 0x30, abort ? 0x80 : 0x43, fence[0], fence[1],
                                                      fence[2]}, 10);
        run_until_request(++sent);
        TEST_ASSERT_EQUAL_HEX16(INDEX, cm1e_get_u16(asked + 6 + 3));
    }
    answer(0x43, 1, NULL, 0);
    take_all();
    expect_end(CM1E_OK, 0);
    begin(false, 4, false); /* and now there is nothing to wait for */
    run_until_request(++sent);
    TEST_ASSERT_EQUAL_HEX16(INDEX, cm1e_get_u16(asked + 6 + 3));
    cm1e_coe_cancel(&client, CM1E_ERROR_CANCELLED);
    begin(false, 4, false);
    expect_abort(++sent, 0x08000000);
    run_until_request(++sent);
    for (int n = 0; n < 2; n++) { /* an abort is refused once; the second refusal is that of the question */
        TEST_ASSERT_FALSE(cm1e_coe_idle(&client));
        message(MAILBOX_TYPE_ERROR, (const uint8_t[]){1, 0, 7, 0}, 4);
        take_all();
    }
    expect_end(CM1E_ERROR_BUS_MAILBOX, 0);
}

/* ---- time -------------------------------------------------------------------------------------------------------- */

static void test_a_transfer_ends_when_its_time_is_over(void)
{
    static const struct {
        int64_t timeout_ns, ends_ns;
    } rows[] = {{0, 1000000000}, {-5, 1000000000}, {1, 1}, {777, 777}};
    cm1e_datagram_t d;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        sdo = (cm1e_sdo_t){.index = INDEX, .subindex = SUB, .data = data, .size = 4, .timeout_ns = rows[i].timeout_ns,
                           .state = CM1E_SDO_BUSY};
        cm1e_coe_begin(&client, &sdo, now_ns);
        TEST_ASSERT_TRUE(cm1e_coe_next(&client, &d, now_ns + rows[i].ends_ns - 1));
        d.working_counter = DATAGRAM_LOST;
        cm1e_coe_result(&client, &d, now_ns + rows[i].ends_ns - 1);
        TEST_ASSERT_FALSE(cm1e_coe_idle(&client));
        if (i % 2) /* also where the answer comes back too late */
            cm1e_coe_result(&client, &d, now_ns + rows[i].ends_ns);
        else
            TEST_ASSERT_FALSE(cm1e_coe_next(&client, &d, now_ns + rows[i].ends_ns));
        expect_end(CM1E_ERROR_TIMEOUT, 0);
        now_ns += 2000000000;
        begin(false, 4, false); /* the slave may hold it open */
        expect_abort(1, 0x05040000);
    }
    setUp();
    sdo = (cm1e_sdo_t){.index = INDEX, .data = data, .size = 4, .timeout_ns = INT64_MAX, .state = CM1E_SDO_BUSY};
    cm1e_coe_begin(&client, &sdo, now_ns);
    TEST_ASSERT_TRUE(cm1e_coe_next(&client, &d, INT64_MAX - 1));
}

static void test_information_has_three_seconds(void)
{
    cm1e_datagram_t d;
    cm1e_info_request_t info = {.kind = INFO_ENTRY, .index = INDEX, .subindex = SUB, .values = 0x78, .answer = data,
                                .size = sizeof data, .taken = 99};
    const int64_t begun_ns = now_ns;
    cm1e_coe_begin_info(&client, &info, now_ns);
    run_until_request(1);
    expect_asked((const uint8_t[]){0, 0x80, 5, 0, 0, 0, INDEX & 0xFF, INDEX >> 8, SUB, 0x78}, 10);
    TEST_ASSERT_TRUE(cm1e_coe_next(&client, &d, begun_ns + 2999999999));
    TEST_ASSERT_FALSE(info.done);
    TEST_ASSERT_FALSE(cm1e_coe_next(&client, &d, begun_ns + 3000000000));
    TEST_ASSERT_TRUE(info.done && info.error == CM1E_ERROR_TIMEOUT && info.size == 0);
    setUp();
    info = (cm1e_info_request_t){.kind = INFO_OBJECT, .index = INDEX, .answer = data, .size = sizeof data};
    cm1e_coe_begin_info(&client, &info, now_ns);
    run_until_request(1);
    expect_asked((const uint8_t[]){0, 0x80, 3, 0, 0, 0, INDEX & 0xFF, INDEX >> 8}, 8);
}

/** An answer of information may fill its room to the last byte. */
static void test_information_fits_or_is_refused(void)
{
    for (size_t room = 9; room <= 11; room++) {
        setUp();
        cm1e_info_request_t info = {.kind = INFO_OBJECT, .index = INDEX, .answer = data, .size = room};
        cm1e_coe_begin_info(&client, &info, now_ns);
        run_until_request(1);
        static const uint8_t body[] = {0, 0x80, 4, 0, 0, 0, INDEX & 0xFF, INDEX >> 8, 7, 0, 1, 7, 'n', 'a', 'm', 'e'};
        message(MAILBOX_TYPE_COE, body, sizeof body);
        take_all();
        TEST_ASSERT_TRUE(info.done);
        TEST_ASSERT_EQUAL_INT(room < 10 ? CM1E_ERROR_INVALID_ARGUMENT : CM1E_OK, info.error);
        TEST_ASSERT_EQUAL(room < 10 ? 0 : 10, info.size);
    }
}

/* ---- a look without a question ----------------------------------------------------------------------------------- */

static void put_emergency(uint16_t code)
{
    uint8_t body[10] = {0, 0x10, 0, 0, 0x81, 1, 2, 3, 4, 5};
    cm1e_put_u16(body + 2, code);
    message(MAILBOX_TYPE_COE, body, sizeof body);
}

/** Four messages at one look, and none where the mailbox is empty; it ends after 100 ms in any case. */
static void test_listening_takes_four_messages_at_most(void)
{
    for (unsigned count = 0; count < 7; count++) {
        setUp();
        for (unsigned n = 0; n < count; n++)
            put_emergency((uint16_t)(0x5000 + n));
        cm1e_coe_listen(&client, now_ns);
        while (!cm1e_coe_idle(&client))
            TEST_ASSERT_TRUE(step());
        const unsigned heard = count < 4 ? count : 4;
        TEST_ASSERT_EQUAL(heard, taken);
        TEST_ASSERT_EQUAL(heard, client.emergency.number);
        if (heard == 0)
            continue;
        TEST_ASSERT_EQUAL_HEX16(0x5000 + heard - 1, client.emergency.code);
        TEST_ASSERT_EQUAL_HEX8(0x81, client.emergency.error_register);
        TEST_ASSERT_EQUAL_HEX8_ARRAY(((const uint8_t[]){1, 2, 3, 4, 5}), client.emergency.data, 5);
    }
    cm1e_datagram_t d;
    setUp();
    const int64_t begun_ns = now_ns;
    cm1e_coe_listen(&client, now_ns);
    TEST_ASSERT_TRUE(cm1e_coe_next(&client, &d, begun_ns + 99999999));
    TEST_ASSERT_FALSE(cm1e_coe_next(&client, &d, begun_ns + 100000000));
    TEST_ASSERT_TRUE(cm1e_coe_idle(&client));
}

/** A message that others have found: only an emergency is taken, and only a whole one counts. */
static void test_an_emergency_that_others_found_is_taken(void)
{
    static const struct {
        uint8_t type, service;
        size_t size;
        bool is_one, counts;
    } rows[] = {{MAILBOX_TYPE_COE, 1, 10, true, true}, {MAILBOX_TYPE_COE, 1, 9, true, false},
                {MAILBOX_TYPE_COE, 1, 2, true, false}, {MAILBOX_TYPE_COE, 1, 1, false, false},
                {MAILBOX_TYPE_COE, 3, 10, false, false}, {MAILBOX_TYPE_FOE, 1, 10, false, false}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        const uint8_t body[10] = {0, (uint8_t)(rows[i].service << 4), 0x10, 0x23, 4, 9, 8, 7, 6, 5};
        setUp();
        message(rows[i].type, body, rows[i].size);
        if (rows[i].size == 1)
            answers[0][7] = 0x10;
        TEST_ASSERT_EQUAL(rows[i].is_one, cm1e_coe_take_emergency(&client, answers[0]));
        TEST_ASSERT_EQUAL(rows[i].counts, client.emergency.number);
        if (rows[i].counts)
            TEST_ASSERT_TRUE(client.emergency.code == 0x2310 && client.emergency.data[4] == 5);
    }
}

/** From the smallest mailbox that holds an SDO message up to what a datagram carries, in each direction. */
static void test_a_mailbox_has_room_for_an_sdo_message(void)
{
    static const struct {
        uint16_t length;
        bool right;
    } rows[] = {{0, false}, {15, false}, {16, true}, {CM1E_DATAGRAM_MAX, true}, {CM1E_DATAGRAM_MAX + 1, false}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        for (int in = 0; in < 2; in++) {
            cm1e_datagram_t d;
            setUp();
            *(in ? &client.mailbox.in_length : &client.mailbox.out_length) = rows[i].length;
            TEST_ASSERT_EQUAL(rows[i].right, cm1e_coe_look(&client, &d));
            begin(false, 4, false);
            TEST_ASSERT_EQUAL(rows[i].right, !cm1e_coe_idle(&client));
            TEST_ASSERT_EQUAL_INT(rows[i].right ? CM1E_OK : CM1E_ERROR_UNSUPPORTED, sdo.error);
            cm1e_coe_reset(&client, CM1E_ERROR_CANCELLED);
            cm1e_coe_listen(&client, now_ns);
            TEST_ASSERT_EQUAL(rows[i].right, !cm1e_coe_idle(&client));
        }
    }
}

static void test_mail_is_seen_in_an_answered_look_only(void)
{
    cm1e_datagram_t d = {.data = {[5] = SM_STATUS_FULL}};
    for (d.working_counter = DATAGRAM_LOST; d.working_counter < 3; d.working_counter++)
        TEST_ASSERT_EQUAL(d.working_counter == 1, cm1e_coe_has_mail(&d));
    d = (cm1e_datagram_t){.working_counter = 1};
    TEST_ASSERT_FALSE(cm1e_coe_has_mail(&d));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_requests_are_those_of_the_standard);
    RUN_TEST(test_segments_are_those_of_the_standard);
    RUN_TEST(test_an_upload_in_segments_is_put_together);
    RUN_TEST(test_an_upload_in_one_message_ends_with_it);
    RUN_TEST(test_expedited_answers_give_their_bytes);
    RUN_TEST(test_wrong_answers_are_aborted_with_their_code);
    RUN_TEST(test_a_refusal_ends_a_transfer_with_its_code);
    RUN_TEST(test_other_messages_are_passed_over);
    RUN_TEST(test_a_mailbox_error_ends_a_transfer_with_its_detail);
    RUN_TEST(test_a_transfer_that_failed_does_not_become_one_that_took_too_long);
    RUN_TEST(test_a_transfer_that_was_given_up_is_over_before_the_next_begins);
    RUN_TEST(test_a_transfer_ends_when_its_time_is_over);
    RUN_TEST(test_information_has_three_seconds);
    RUN_TEST(test_information_fits_or_is_refused);
    RUN_TEST(test_listening_takes_four_messages_at_most);
    RUN_TEST(test_an_emergency_that_others_found_is_taken);
    RUN_TEST(test_a_mailbox_has_room_for_an_sdo_message);
    RUN_TEST(test_mail_is_seen_in_an_answered_look_only);
    return UNITY_END();
}
