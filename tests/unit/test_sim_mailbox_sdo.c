/* The CoE server: SDO transfers of every kind, complete access, abort codes. */
#include "sim_fake_app.h"

static bench_t b;
static uint16_t length;

void setUp(void)
{
    bench_open(&b, 1);
    bring_to(&b, 0, CM1E_AL_PRE_OP);
}
void tearDown(void) { bench_close(&b); }

/* Sends an SDO request (CoE header added) and expects a CoE answer. */
static void ask(const uint8_t *sdo, uint16_t bytes)
{
    uint8_t data[122] = {0x00, 0x20};
    memcpy(data + 2, sdo, bytes);
    TEST_ASSERT_EQUAL_INT(3, mailbox_ask(&b, 3, data, (uint16_t)(2 + bytes), &length));
}
static void ask_init(uint8_t command, uint16_t index, uint8_t subindex, uint32_t value)
{
    uint8_t sdo[8] = {command};
    cm1e_put_u16(sdo + 1, index);
    sdo[3] = subindex;
    cm1e_put_u32(sdo + 4, value);
    ask(sdo, sizeof sdo);
}

static void expect_abort(uint32_t code, uint16_t index, uint8_t subindex)
{
    TEST_ASSERT_EQUAL_UINT16(10, length);
    TEST_ASSERT_EQUAL_HEX16(0x2000, cm1e_get_u16(b.answer)); /* travels as a request */
    TEST_ASSERT_EQUAL_HEX8(0x80, b.answer[2]);
    TEST_ASSERT_EQUAL_HEX32(code, cm1e_get_u32(b.answer + 6));
    TEST_ASSERT_EQUAL_HEX16(index, cm1e_get_u16(b.answer + 3));
    TEST_ASSERT_EQUAL_HEX8(subindex, b.answer[5]);
}
static void expect_response(uint8_t command, uint16_t index, uint8_t subindex)
{
    TEST_ASSERT_EQUAL_HEX16(0x3000, cm1e_get_u16(b.answer));
    TEST_ASSERT_EQUAL_HEX8(command, b.answer[2]);
    TEST_ASSERT_EQUAL_HEX16(index, cm1e_get_u16(b.answer + 3));
    TEST_ASSERT_EQUAL_HEX8(subindex, b.answer[5]);
}

/* Uploads by whatever transfer the server chooses; bytes read. */
static size_t upload(uint16_t index, uint8_t subindex, bool complete, uint8_t *value)
{
    ask_init(complete ? 0x50 : 0x40, index, subindex, 0);
    const uint8_t command = b.answer[2];
    expect_response(command, index, subindex);
    TEST_ASSERT_EQUAL_HEX8(complete ? 0x51 : 0x41, command & 0xF1);
    if (command & 0x02) {
        const size_t n = 4u - (command >> 2 & 3);
        memcpy(value, b.answer + 6, n);
        return n;
    }
    const size_t size = cm1e_get_u32(b.answer + 6);
    size_t done = length - 10u;
    memcpy(value, b.answer + 10, done);
    for (uint8_t toggle = 0; done < size; toggle ^= 0x10) {
        ask_init(0x60 | toggle, 0, 0, 0);
        TEST_ASSERT_EQUAL_HEX16(0x3000, cm1e_get_u16(b.answer));
        TEST_ASSERT_EQUAL_HEX8(toggle, b.answer[2] & 0xF0);
        size_t n = length - 3u;
        if (n == 7)
            n -= b.answer[2] >> 1 & 7;
        TEST_ASSERT_LESS_OR_EQUAL_UINT(size - done, n);
        memcpy(value + done, b.answer + 3, n);
        done += n;
        TEST_ASSERT_EQUAL_HEX8(done == size, b.answer[2] & 0x01);
    }
    return done;
}

/* Downloads `size` bytes, `first` of them with the first message, then segments; the abort code. */
static uint32_t download(uint16_t index, uint8_t subindex, bool complete, const uint8_t *value, size_t size,
                         size_t first)
{
    uint8_t sdo[120] = {complete ? 0x31 : 0x21};
    cm1e_put_u16(sdo + 1, index);
    sdo[3] = subindex;
    cm1e_put_u32(sdo + 4, (uint32_t)size);
    memcpy(sdo + 8, value, first);
    ask(sdo, (uint16_t)(8 + first));
    size_t done = first;
    for (uint8_t toggle = 0; b.answer[2] != 0x80 && done < size; toggle ^= 0x10) {
        const size_t n = size - done < 119 ? size - done : 119;
        uint8_t segment[120] = {toggle};
        if (n == size - done)
            segment[0] |= 0x01;
        if (n < 7)
            segment[0] |= (uint8_t)((7 - n) << 1);
        memcpy(segment + 1, value + done, n);
        ask(segment, (uint16_t)(1 + (n < 7 ? 7 : n)));
        if (b.answer[2] != 0x80)
            TEST_ASSERT_EQUAL_HEX8(0x20 | toggle, b.answer[2]);
        done += n;
    }
    return b.answer[2] == 0x80 ? cm1e_get_u32(b.answer + 6) : 0;
}

/* ---- upload ---------------------------------------------------------------------------------------------------- */

static void test_values_up_to_four_bytes_come_expedited(void)
{
    ask_init(0x40, 0x2000, 0, 0);
    expect_response(0x4F, 0x2000, 0);
    TEST_ASSERT_EQUAL_HEX32(17, cm1e_get_u32(b.answer + 6));
    ask_init(0x40, 0x2010, 4, 0);
    expect_response(0x4B, 0x2010, 4);
    TEST_ASSERT_EQUAL_HEX32(0x4444, cm1e_get_u32(b.answer + 6));
    ask_init(0x40, 0x2001, 0, 0);
    expect_response(0x43, 0x2001, 0);
    TEST_ASSERT_EQUAL_HEX32(0x12345678, cm1e_get_u32(b.answer + 6));
    TEST_ASSERT_EQUAL_UINT16(10, length);
}

static void test_longer_values_come_in_one_message(void)
{
    uint8_t value[700];
    ask_init(0x40, 0x1008, 0, 0);
    expect_response(0x41, 0x1008, 0);
    TEST_ASSERT_EQUAL_HEX32(5, cm1e_get_u32(b.answer + 6));
    TEST_ASSERT_EQUAL_UINT16(15, length);
    TEST_ASSERT_EQUAL_MEMORY("CM1-E", b.answer + 10, 5);
    TEST_ASSERT_EQUAL_UINT(5, upload(0x1008, 0, false, value));
}

/* Every length around the borders of messages and segments. */
static void test_every_length_can_be_read_and_written(void)
{
    uint8_t value[700], got[700];
    for (size_t size = 0; size <= 600; size += size < 400 ? 1 : 7) {
        for (size_t i = 0; i < size; i++)
            value[i] = (uint8_t)(i * 7 + size);
        const size_t first = size < 112 ? size : 112;
        TEST_ASSERT_EQUAL_HEX32(0, download(0x1009, 0, false, value, size, first));
        TEST_ASSERT_EQUAL_UINT(size, fake_value(b.apps[0], 0x1009, 0)->size);
        TEST_ASSERT_EQUAL_INT(0, memcmp(value, fake_value(b.apps[0], 0x1009, 0)->bytes, size));
        TEST_ASSERT_EQUAL_UINT(size, upload(0x1009, 0, false, got));
        TEST_ASSERT_EQUAL_INT(0, memcmp(value, got, size));
    }
}

static void test_the_first_message_may_hold_less_than_it_could(void)
{
    uint8_t value[300];
    for (unsigned i = 0; i < sizeof value; i++)
        value[i] = (uint8_t)i;
    for (size_t first = 0; first <= 112; first += 7) {
        TEST_ASSERT_EQUAL_HEX32(0, download(0x1009, 0, false, value, sizeof value, first));
        TEST_ASSERT_EQUAL_MEMORY(value, fake_value(b.apps[0], 0x1009, 0)->bytes, sizeof value);
    }
}

/* ---- download -------------------------------------------------------------------------------------------------- */

static void test_expedited_download_says_its_size_or_takes_the_entrys(void)
{
    ask_init(0x2F, 0x2000, 0, 0x42);
    expect_response(0x60, 0x2000, 0);
    TEST_ASSERT_EQUAL_HEX8(0x42, fake_value(b.apps[0], 0x2000, 0)->bytes[0]);
    ask_init(0x22, 0x2000, 0, 0x43);
    expect_response(0x60, 0x2000, 0);
    TEST_ASSERT_EQUAL_HEX8(0x43, fake_value(b.apps[0], 0x2000, 0)->bytes[0]);
    ask_init(0x23, 0x2001, 0, 0xCAFEBABE);
    expect_response(0x60, 0x2001, 0);
    TEST_ASSERT_EQUAL_HEX32(0xCAFEBABE, cm1e_get_u32(fake_value(b.apps[0], 0x2001, 0)->bytes));
    /* a short value may come by a normal transfer as well */
    const uint8_t value[4] = {1, 2, 3, 4};
    TEST_ASSERT_EQUAL_HEX32(0, download(0x2001, 0, false, value, 4, 4));
    TEST_ASSERT_EQUAL_HEX32(0x04030201, cm1e_get_u32(fake_value(b.apps[0], 0x2001, 0)->bytes));
}

static void test_wrong_requests_are_aborted_with_the_right_code(void)
{
    static const struct {
        uint8_t command;
        uint16_t index;
        uint8_t subindex;
        uint32_t value, code;
    } rows[] = {
        {0x40, 0x5555, 0, 0, SDO_ABORT_NO_OBJECT},       {0x23, 0x5555, 0, 0, SDO_ABORT_NO_OBJECT},
        {0x40, 0x2010, 3, 0, SDO_ABORT_NO_SUBINDEX},     {0x2F, 0x2010, 6, 0, SDO_ABORT_NO_SUBINDEX},
        {0x40, 0x2003, 0, 0, SDO_ABORT_WRITE_ONLY},      {0x23, 0x1000, 0, 0, SDO_ABORT_READ_ONLY},
        {0x23, 0x2000, 0, 0, SDO_ABORT_TOO_LONG},        {0x2F, 0x2001, 0, 0, SDO_ABORT_TOO_SHORT},
        {0x50, 0x5555, 0, 0, SDO_ABORT_NO_OBJECT},       {0x50, 0x1000, 0, 0, SDO_ABORT_COMPLETE_ACCESS},
        {0x50, 0x2010, 2, 0, SDO_ABORT_NO_SUBINDEX},     {0x21, 0x5555, 0, 300, SDO_ABORT_NO_OBJECT},
        {0x21, 0x2010, 9, 300, SDO_ABORT_NO_SUBINDEX},   {0x21, 0x1008, 0, 300, SDO_ABORT_READ_ONLY},
        {0x21, 0x2001, 0, 300, SDO_ABORT_TOO_LONG},      {0x21, 0x1009, 0, 5000, SDO_ABORT_MEMORY},
        {0x21, 0x1009, 0, UINT32_MAX, SDO_ABORT_MEMORY}, {0x31, 0x1000, 0, 300, SDO_ABORT_COMPLETE_ACCESS},
        {0x60, 0x2000, 0, 0, SDO_ABORT_COMMAND},         {0x00, 0x2000, 0, 0, SDO_ABORT_COMMAND},
        {0xA0, 0x2000, 0, 0, SDO_ABORT_COMMAND},         {0xC0, 0x2000, 0, 0, SDO_ABORT_COMMAND},
        {0xE0, 0x2000, 0, 0, SDO_ABORT_COMMAND},
    };
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        ask_init(rows[i].command, rows[i].index, rows[i].subindex, rows[i].value);
        /* a segment without a transfer does not say what it belongs to */
        const bool segment = rows[i].command == 0x60 || rows[i].command == 0x00;
        expect_abort(rows[i].code, segment ? 0 : rows[i].index, segment ? 0 : rows[i].subindex);
    }
}

static void test_an_abort_by_the_master_ends_the_transfer_silently(void)
{
    uint8_t value[300] = {0};
    uint8_t data[122] = {0x00, 0x20, 0x80, 0x09, 0x10};
    ask_init(0x40, 0x1009, 0, 0);
    TEST_ASSERT_EQUAL_INT(-1, mailbox_ask(&b, 3, data, 10, &length));
    ask_init(0x60, 0, 0, 0);
    expect_abort(SDO_ABORT_COMMAND, 0, 0);
    TEST_ASSERT_EQUAL_HEX32(0, download(0x1009, 0, false, value, 300, 10));
}

static void test_toggle_is_checked_in_both_directions(void)
{
    ask_init(0x40, 0x1009, 0, 0);
    ask_init(0x70, 0, 0, 0);
    expect_abort(SDO_ABORT_TOGGLE, 0x1009, 0);
    ask_init(0x60, 0, 0, 0);
    expect_abort(SDO_ABORT_COMMAND, 0, 0); /* the transfer is over */
    ask_init(0x40, 0x1009, 0, 0);
    ask_init(0x60, 0, 0, 0);
    ask_init(0x60, 0, 0, 0);
    expect_abort(SDO_ABORT_TOGGLE, 0x1009, 0);

    ask_init(0x21, 0x1009, 0, 300);
    ask_init(0x10, 0, 0, 0);
    expect_abort(SDO_ABORT_TOGGLE, 0x1009, 0);
    ask_init(0x21, 0x1009, 0, 300);
    ask_init(0x00, 0, 0, 0);
    TEST_ASSERT_EQUAL_HEX8(0x20, b.answer[2]);
    ask_init(0x00, 0, 0, 0);
    expect_abort(SDO_ABORT_TOGGLE, 0x1009, 0);
    TEST_ASSERT_EQUAL_UINT(0, b.apps[0]->sdo_writes);
}

static void test_segments_of_another_length_than_announced_are_aborted(void)
{
    uint8_t segment[120] = {0x00};
    ask_init(0x21, 0x1009, 0, 20);
    ask(segment, 31); /* 30 bytes */
    expect_abort(SDO_ABORT_TOO_LONG, 0x1009, 0);
    ask_init(0x21, 0x1009, 0, 20);
    segment[0] = 0x01;
    ask(segment, 11); /* 10 bytes, and the last */
    expect_abort(SDO_ABORT_TOO_SHORT, 0x1009, 0);
    TEST_ASSERT_EQUAL_UINT(0, b.apps[0]->sdo_writes);
}

static void test_a_new_request_ends_a_transfer_under_way(void)
{
    uint8_t value[700];
    ask_init(0x40, 0x1009, 0, 0);
    TEST_ASSERT_EQUAL_UINT(4, upload(0x2001, 0, false, value));
    ask_init(0x60, 0, 0, 0);
    expect_abort(SDO_ABORT_COMMAND, 0, 0);
}

/* ---- complete access ------------------------------------------------------------------------------------------- */

static void test_complete_access_reads_the_row_of_entries(void)
{
    /* sub-index 0 as 16 bits, the gap at 3 left out, what can only be written as zero */
    static const uint8_t row[] = {5, 0, 0x11, 0x22, 0x22, 0x22, 0x22, 0x44, 0x44, 0, 0};
    uint8_t value[700];
    TEST_ASSERT_EQUAL_UINT(sizeof row, upload(0x2010, 0, true, value));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(row, value, sizeof row);
    TEST_ASSERT_EQUAL_UINT(sizeof row - 2, upload(0x2010, 1, true, value));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(row + 2, value, sizeof row - 2);
}

static void test_complete_access_to_a_large_array_is_segmented(void)
{
    uint8_t value[700];
    TEST_ASSERT_EQUAL_UINT(402, upload(0x2011, 0, true, value));
    for (unsigned sub = 1; sub <= 100; sub++)
        TEST_ASSERT_EQUAL_HEX32(sub * 0x01010101u, cm1e_get_u32(value + 2 + 4 * (sub - 1)));
    for (unsigned i = 2; i < 402; i++)
        value[i] = (uint8_t)i;
    TEST_ASSERT_EQUAL_HEX32(0, download(0x2011, 0, true, value, 402, 100));
    TEST_ASSERT_EQUAL_HEX32(0x91908F8E, cm1e_get_u32(fake_value(b.apps[0], 0x2011, 100)->bytes));
}

static void test_complete_access_writes_entries_and_number_in_the_right_order(void)
{
    static const uint8_t assignment[] = {2, 0, 0x03, 0x16, 0x02, 0x16};
    TEST_ASSERT_EQUAL_HEX32(0, download(0x2012, 0, true, assignment, sizeof assignment, sizeof assignment));
    TEST_ASSERT_EQUAL_HEX8(2, fake_value(b.apps[0], 0x2012, 0)->bytes[0]);
    TEST_ASSERT_EQUAL_HEX16(0x1603, cm1e_get_u16(fake_value(b.apps[0], 0x2012, 1)->bytes));
    TEST_ASSERT_EQUAL_HEX16(0x1602, cm1e_get_u16(fake_value(b.apps[0], 0x2012, 2)->bytes));
    TEST_ASSERT_EQUAL_UINT(4, b.apps[0]->sdo_writes); /* 0, two entries, 2 */
    static const uint8_t none[] = {0, 0};
    TEST_ASSERT_EQUAL_HEX32(0, download(0x2012, 0, true, none, 2, 2));
    TEST_ASSERT_EQUAL_HEX8(0, fake_value(b.apps[0], 0x2012, 0)->bytes[0]);
}

static void test_complete_access_refuses_what_does_not_fit(void)
{
    static const uint8_t row[] = {5, 0, 0x31, 0x32, 0x32, 0x32, 0x32, 0x44, 0x44, 0x55, 0x55, 0x66, 0x66};
    TEST_ASSERT_EQUAL_HEX32(0, download(0x2010, 0, true, row, 11, 11));
    TEST_ASSERT_EQUAL_HEX8(0x31, fake_value(b.apps[0], 0x2010, 1)->bytes[0]);
    TEST_ASSERT_EQUAL_HEX32(SDO_ABORT_TYPE_LENGTH, download(0x2010, 0, true, row, 12, 12));
    TEST_ASSERT_EQUAL_HEX32(SDO_ABORT_TYPE_LENGTH, download(0x2010, 0, true, row, 13, 13));
    TEST_ASSERT_EQUAL_HEX32(SDO_ABORT_TYPE_LENGTH, download(0x2010, 0, true, row, 5, 5));
    TEST_ASSERT_EQUAL_HEX32(SDO_ABORT_TYPE_LENGTH, download(0x2010, 0, true, row, 1, 1));
    /* a read-only entry with another value, another number of entries */
    static const uint8_t other[] = {5, 0, 0x31, 0x32, 0x32, 0x32, 0x32, 0x45, 0x44, 0x55, 0x55};
    TEST_ASSERT_EQUAL_HEX32(SDO_ABORT_READ_ONLY, download(0x2010, 0, true, other, 11, 11));
    static const uint8_t number[] = {4, 0, 0x31};
    TEST_ASSERT_EQUAL_HEX32(SDO_ABORT_READ_ONLY, download(0x2010, 0, true, number, 3, 3));
}

/* ---- SDO information ------------------------------------------------------------------------------------------- */

static void ask_information(uint8_t opcode, const uint8_t *data, uint16_t bytes)
{
    uint8_t message[40] = {0x00, 0x80, opcode};
    memcpy(message + 6, data, bytes);
    TEST_ASSERT_EQUAL_INT(3, mailbox_ask(&b, 3, message, (uint16_t)(6 + bytes), &length));
    TEST_ASSERT_EQUAL_HEX16(0x8000, cm1e_get_u16(b.answer));
}

/* Reads a list by fragments; number of indices. */
static unsigned read_list(uint16_t type, uint16_t *indices)
{
    uint8_t data[2];
    unsigned count = 0;
    cm1e_put_u16(data, type);
    ask_information(1, data, 2);
    uint16_t left = cm1e_get_u16(b.answer + 4);
    TEST_ASSERT_EQUAL_UINT16(type, cm1e_get_u16(b.answer + 6));
    for (uint16_t at = 8;; at = 6) {
        TEST_ASSERT_EQUAL_HEX8(0x02 | (left ? 0x80 : 0), b.answer[2]);
        TEST_ASSERT_EQUAL_UINT16(left, cm1e_get_u16(b.answer + 4));
        for (; at < length; at += 2)
            indices[count++] = cm1e_get_u16(b.answer + at);
        if (left == 0)
            return count;
        left--;
        TEST_ASSERT_EQUAL_INT(3, mailbox_get(&b, &length) & 0x0F);
    }
}

static void test_the_list_of_all_objects_comes_in_fragments(void)
{
    uint16_t indices[FAKE_OBJECTS + 60];
    TEST_ASSERT_EQUAL_UINT(FAKE_OBJECTS, read_list(1, indices));
    for (unsigned i = 0; i < FAKE_OBJECTS; i++)
        TEST_ASSERT_EQUAL_HEX16(b.apps[0]->objects[i].index, indices[i]);
    TEST_ASSERT_EQUAL_INT(-1, mailbox_get(&b, &length));
}

static void test_the_other_lists_are_parts_of_it(void)
{
    uint16_t indices[FAKE_OBJECTS + 60];
    TEST_ASSERT_EQUAL_UINT(1, read_list(2, indices));
    TEST_ASSERT_EQUAL_HEX16(0x2000, indices[0]);
    TEST_ASSERT_EQUAL_UINT(1, read_list(3, indices));
    TEST_ASSERT_EQUAL_HEX16(0x2001, indices[0]);
    TEST_ASSERT_EQUAL_UINT(0, read_list(4, indices));
    TEST_ASSERT_EQUAL_UINT(0, read_list(5, indices));
    TEST_ASSERT_EQUAL_UINT(5, read_list(0, indices));
    static const uint16_t lengths[] = {FAKE_OBJECTS, 1, 1, 0, 0};
    TEST_ASSERT_EQUAL_UINT16_ARRAY(lengths, indices, 5);
}

/* The list fits exactly into one, two, three messages, and one more or less. */
static void test_lists_of_every_length_are_whole(void)
{
    uint16_t indices[FAKE_OBJECTS + 60];
    for (unsigned count = 1; count <= FAKE_OBJECTS; count++) {
        b.apps[0]->object_count = count;
        TEST_ASSERT_EQUAL_UINT(count, read_list(1, indices));
    }
}

static void test_a_request_ends_a_list_under_way(void)
{
    static const uint8_t all[2] = {1, 0};
    uint8_t value[16];
    ask_information(1, all, 2);
    TEST_ASSERT_EQUAL_HEX8(0x82, b.answer[2]);
    TEST_ASSERT_EQUAL_UINT(4, upload(0x2001, 0, false, value));
    TEST_ASSERT_EQUAL_INT(-1, mailbox_get(&b, &length));
}

static void test_objects_are_described(void)
{
    static const uint8_t variable[2] = {0x01, 0x20}, array[2] = {0x11, 0x20}, none[2] = {0x55, 0x55};
    ask_information(3, variable, 2);
    static const uint8_t expected[] = {0x04, 0, 0, 0, 0x01, 0x20, 0x07, 0x00, 0, 7};
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, b.answer + 2, sizeof expected);
    TEST_ASSERT_EQUAL_UINT16(12 + 11, length);
    TEST_ASSERT_EQUAL_MEMORY("Double word", b.answer + 12, 11);
    ask_information(3, array, 2);
    static const uint8_t expected_array[] = {0x04, 0, 0, 0, 0x11, 0x20, 0x07, 0x00, 100, 8};
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected_array, b.answer + 2, sizeof expected_array);
    ask_information(3, none, 2);
    TEST_ASSERT_EQUAL_HEX8(0x07, b.answer[2]);
    TEST_ASSERT_EQUAL_HEX32(SDO_ABORT_NO_OBJECT, cm1e_get_u32(b.answer + 6));
}

static void test_entries_are_described(void)
{
    static const uint8_t request[4] = {0x10, 0x20, 2, 0x07};
    ask_information(5, request, 4);
    static const uint8_t expected[] = {0x06, 0, 0, 0, 0x10, 0x20, 2, 7, 0x07, 0, 32, 0, 0x3F, 0};
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, b.answer + 2, sizeof expected);
    TEST_ASSERT_EQUAL_UINT16(16 + 5, length);
    TEST_ASSERT_EQUAL_MEMORY("entry", b.answer + 16, 5);
    /* default, minimum, maximum on request */
    static const uint8_t values[4] = {0x00, 0x20, 0, 0x7F};
    ask_information(5, values, 4);
    static const uint8_t expected_values[] = {0x06, 0, 0, 0, 0x00, 0x20, 0, 0x77, 0x05, 0, 8, 0, 0x7F, 0, 17, 0xFB, 7};
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected_values, b.answer + 2, sizeof expected_values);
    static const uint8_t gap[4] = {0x10, 0x20, 3, 7}, none[4] = {0x55, 0x55, 0, 7};
    ask_information(5, gap, 4);
    TEST_ASSERT_EQUAL_HEX32(SDO_ABORT_NO_SUBINDEX, cm1e_get_u32(b.answer + 6));
    ask_information(5, none, 4);
    TEST_ASSERT_EQUAL_HEX32(SDO_ABORT_NO_OBJECT, cm1e_get_u32(b.answer + 6));
}

static void test_wrong_information_requests_are_answered_by_an_error(void)
{
    static const uint8_t six[2] = {6, 0}, nothing[1] = {0};
    ask_information(1, six, 2);
    TEST_ASSERT_EQUAL_HEX8(0x07, b.answer[2]);
    ask_information(1, nothing, 0);
    TEST_ASSERT_EQUAL_HEX8(0x07, b.answer[2]);
    ask_information(3, nothing, 1);
    TEST_ASSERT_EQUAL_HEX8(0x07, b.answer[2]);
    ask_information(5, six, 2);
    TEST_ASSERT_EQUAL_HEX8(0x07, b.answer[2]);
    for (uint8_t opcode = 0; opcode < 128; opcode++) {
        if (opcode == 1 || opcode == 3 || opcode == 5)
            continue;
        ask_information(opcode, six, 2);
        TEST_ASSERT_EQUAL_HEX8(0x07, b.answer[2]);
        TEST_ASSERT_EQUAL_HEX32(SDO_ABORT_UNSUPPORTED_ACCESS, cm1e_get_u32(b.answer + 6));
    }
}

/* A name longer than the mailbox is cut, whatever the mailbox size. */
static void test_long_names_are_cut(void)
{
    char name[300];
    memset(name, 'n', sizeof name - 1);
    name[sizeof name - 1] = 0;
    b.apps[0]->objects[0].name = name;
    static const uint8_t request[2] = {0x00, 0x10};
    ask_information(3, request, 2);
    TEST_ASSERT_EQUAL_UINT16(122, length);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_values_up_to_four_bytes_come_expedited);
    RUN_TEST(test_longer_values_come_in_one_message);
    RUN_TEST(test_every_length_can_be_read_and_written);
    RUN_TEST(test_the_first_message_may_hold_less_than_it_could);
    RUN_TEST(test_expedited_download_says_its_size_or_takes_the_entrys);
    RUN_TEST(test_wrong_requests_are_aborted_with_the_right_code);
    RUN_TEST(test_an_abort_by_the_master_ends_the_transfer_silently);
    RUN_TEST(test_toggle_is_checked_in_both_directions);
    RUN_TEST(test_segments_of_another_length_than_announced_are_aborted);
    RUN_TEST(test_a_new_request_ends_a_transfer_under_way);
    RUN_TEST(test_complete_access_reads_the_row_of_entries);
    RUN_TEST(test_complete_access_to_a_large_array_is_segmented);
    RUN_TEST(test_complete_access_writes_entries_and_number_in_the_right_order);
    RUN_TEST(test_complete_access_refuses_what_does_not_fit);
    RUN_TEST(test_the_list_of_all_objects_comes_in_fragments);
    RUN_TEST(test_the_other_lists_are_parts_of_it);
    RUN_TEST(test_lists_of_every_length_are_whole);
    RUN_TEST(test_a_request_ends_a_list_under_way);
    RUN_TEST(test_objects_are_described);
    RUN_TEST(test_entries_are_described);
    RUN_TEST(test_wrong_information_requests_are_answered_by_an_error);
    RUN_TEST(test_long_names_are_cut);
    return UNITY_END();
}
