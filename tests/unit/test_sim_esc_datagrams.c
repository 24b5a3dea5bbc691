/* Datagram commands, addressing and working counters of the simulated slave controller. */
#include "sim_fake_app.h"

enum { SLAVES = 3, RAM = 0x2000 };

static bench_t b;

void setUp(void)
{
    bench_open(&b, SLAVES);
    for (unsigned i = 0; i < SLAVES; i++)
        TEST_ASSERT_EQUAL_INT(1, write_u16(&b, i, 0x10, (uint16_t)(STATION + i)));
}
void tearDown(void) { bench_close(&b); }

static void fill(unsigned slave, uint32_t value)
{
    uint8_t data[4];
    cm1e_put_u32(data, value);
    TEST_ASSERT_EQUAL_INT(1, write_bytes(&b, slave, RAM, data, 4));
}

static const uint32_t contents[SLAVES] = {0x11000001, 0x22000002, 0x44000004};
enum { SENT = 0x08A50800 };

/* For every command: the working counter, what comes back, and what is in the slaves afterwards (0: as before). */
static const struct row {
    uint8_t command;
    uint16_t adp;
    int counter;
    uint32_t returned;
    uint32_t kept[SLAVES];
    uint16_t adp_after;
} rows[] = {
    {COMMAND_NOP, 0, 0, SENT, {0, 0, 0}, 0},
    {APRD, 0, 1, 0x11000001, {0, 0, 0}, 3},
    {APRD, (uint16_t)-1, 1, 0x22000002, {0, 0, 0}, 2},
    {APRD, (uint16_t)-2, 1, 0x44000004, {0, 0, 0}, 1},
    {APRD, (uint16_t)-3, 0, SENT, {0, 0, 0}, 0},
    {APRD, 1, 0, SENT, {0, 0, 0}, 4},
    {APWR, (uint16_t)-1, 1, SENT, {0, SENT, 0}, 2},
    {APWR, 7, 0, SENT, {0, 0, 0}, 10},
    {APRW, (uint16_t)-2, 3, 0x44000004, {0, 0, SENT}, 1},
    {FPRD, STATION + 1, 1, 0x22000002, {0, 0, 0}, STATION + 1},
    {FPRD, 0x4711, 0, SENT, {0, 0, 0}, 0x4711}, /* the alias is not listened to yet */
    {FPRD, 0x0999, 0, SENT, {0, 0, 0}, 0x0999},
    {FPWR, STATION, 1, SENT, {SENT, 0, 0}, STATION},
    {FPRW, STATION + 2, 3, 0x44000004, {0, 0, SENT}, STATION + 2},
    {BRD, 0, 3, 0x77000007 | SENT, {0, 0, 0}, 3},
    {BRD, 0xFFFF, 3, 0x77000007 | SENT, {0, 0, 0}, 2},
    {BWR, 0, 3, SENT, {SENT, SENT, SENT}, 3},
    {ARMW, 0, 3, 0x11000001, {0, 0x11000001, 0x11000001}, 3},
    {ARMW, (uint16_t)-1, 3, 0x22000002, {SENT, 0, 0x22000002}, 2},
    {ARMW, 5, 3, SENT, {SENT, SENT, SENT}, 8},
    {FRMW, STATION + 1, 3, 0x22000002, {SENT, 0, 0x22000002}, STATION + 1},
    {FRMW, STATION, 3, 0x11000001, {0, 0x11000001, 0x11000001}, STATION},
    {15, 0, 0, SENT, {0, 0, 0}, 0},
    {16, STATION, 0, SENT, {0, 0, 0}, STATION},
    {255, 0, 0, SENT, {0, 0, 0}, 0},
};

static void test_every_command_counts_returns_and_keeps_as_the_standard_says(void)
{
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        const struct row *row = &rows[i];
        char text[64];
        snprintf(text, sizeof text, "row %u: command %u, address 0x%04X", i, row->command, row->adp);
        for (unsigned s = 0; s < SLAVES; s++)
            fill(s, contents[s]);
        uint8_t data[4];
        cm1e_put_u32(data, SENT);
        TEST_ASSERT_EQUAL_INT_MESSAGE(row->counter, send_to(&b, row->command, row->adp, RAM, data, 4), text);
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(row->returned, cm1e_get_u32(data), text);
        TEST_ASSERT_EQUAL_HEX16_MESSAGE(row->adp_after, b.position, text);
        for (unsigned s = 0; s < SLAVES; s++)
            TEST_ASSERT_EQUAL_HEX32_MESSAGE(row->kept[s] ? row->kept[s] : contents[s], read_u32(&b, s, RAM), text);
    }
}

/* Every slave puts its content into the same datagram and takes what the ones before it left there. */
static void test_broadcast_read_write_counts_three_per_slave(void)
{
    for (unsigned s = 0; s < SLAVES; s++)
        fill(s, contents[s]);
    uint8_t data[4] = {0};
    TEST_ASSERT_EQUAL_INT(9, send_to(&b, BRW, 0, RAM, data, 4));
    TEST_ASSERT_EQUAL_HEX32(0x77000007, cm1e_get_u32(data));
    TEST_ASSERT_EQUAL_HEX32(0, read_u32(&b, 0, RAM));
    TEST_ASSERT_EQUAL_HEX32(0x11000001, read_u32(&b, 1, RAM));
    TEST_ASSERT_EQUAL_HEX32(0x33000003, read_u32(&b, 2, RAM));
}

static void test_alias_answers_once_it_is_switched_on(void)
{
    uint8_t data[4] = {0};
    TEST_ASSERT_EQUAL_INT(0, send_to(&b, FPRD, 0x4711, RAM, data, 4));
    write_u8(&b, 1, 0x0103, 1);
    fill(1, 0xCAFE);
    TEST_ASSERT_EQUAL_INT(1, send_to(&b, FPRD, 0x4711, RAM, data, 4));
    TEST_ASSERT_EQUAL_HEX32(0xCAFE, cm1e_get_u32(data));
    TEST_ASSERT_EQUAL_INT(1, send_to(&b, FPRD, STATION + 1, RAM, data, 4));
}

static void test_working_counter_adds_to_what_it_was_and_wraps(void)
{
    uint8_t frame[FRAME_MAX], data[4] = {0};
    const size_t end = frame_add(frame, frame_begin(frame), BRD, RAM << 16, data, 4);
    cm1e_put_u16(frame + end - 2, 0xFFFE);
    TEST_ASSERT_EQUAL_INT(CM1E_SIM_PORT_PRIMARY, cm1e_sim_segment_process(b.segment, 0, frame, end, b.now_ns));
    TEST_ASSERT_EQUAL_HEX16(1, cm1e_get_u16(frame + end - 2));
}

static void test_several_datagrams_in_a_frame_are_each_counted(void)
{
    uint8_t frame[FRAME_MAX], data[4] = {1, 2, 3, 4}, long_data[1000] = {0};
    size_t at = frame_begin(frame), ends[5];
    at = ends[0] = frame_add(frame, at, BWR, RAM << 16, data, 4);
    at = ends[1] = frame_add(frame, at, APRD, (uint16_t)-1 | RAM << 16, data, 4);
    at = ends[2] = frame_add(frame, at, COMMAND_NOP, 0, long_data, 0);
    at = ends[3] = frame_add(frame, at, FPRD, 0x999 | RAM << 16, long_data, sizeof long_data);
    at = ends[4] = frame_add(frame, at, BRD, 0x130 << 16, data, 2);
    const uint16_t counters[] = {3, 1, 0, 0, 3};
    TEST_ASSERT_EQUAL_INT(CM1E_SIM_PORT_PRIMARY, cm1e_sim_segment_process(b.segment, 0, frame, at, b.now_ns));
    for (unsigned i = 0; i < 5; i++)
        TEST_ASSERT_EQUAL_UINT16(counters[i], cm1e_get_u16(frame + ends[i] - 2));
}

static void test_slaves_mark_the_source_address(void)
{
    uint8_t frame[FRAME_MAX], data[2] = {0};
    const size_t end = frame_add(frame, frame_begin(frame), COMMAND_NOP, 0, data, 2);
    cm1e_sim_segment_process(b.segment, 0, frame, end, b.now_ns);
    TEST_ASSERT_EQUAL_HEX8(0x03, frame[6]);
    TEST_ASSERT_EQUAL_HEX8(0x01, frame[7]);
}

static void test_index_and_header_come_back_unchanged(void)
{
    uint8_t frame[FRAME_MAX], data[4] = {0};
    const size_t end = frame_add(frame, frame_begin(frame), FPRD, STATION | RAM << 16, data, 4);
    cm1e_sim_segment_process(b.segment, 0, frame, end, b.now_ns);
    TEST_ASSERT_EQUAL_HEX8(FPRD, frame[16]);
    TEST_ASSERT_EQUAL_HEX8(0x55, frame[17]);
    TEST_ASSERT_EQUAL_HEX16(STATION, cm1e_get_u16(frame + 18));
    TEST_ASSERT_EQUAL_HEX16(RAM, cm1e_get_u16(frame + 20));
    TEST_ASSERT_EQUAL_HEX16(4, cm1e_get_u16(frame + 22));
}

/* SOEM sends its first datagram, one byte, as a frame of 29 bytes; other masters pad to 60. */
static void test_short_frames_come_unpadded_or_padded(void)
{
    for (size_t length = 29; length <= 60; length++) {
        uint8_t frame[FRAME_MAX], data[1] = {0};
        const size_t end = frame_add(frame, frame_begin(frame), BRD, 0, data, 1);
        TEST_ASSERT_EQUAL_UINT(29, end);
        TEST_ASSERT_EQUAL_INT(CM1E_SIM_PORT_PRIMARY, cm1e_sim_segment_process(b.segment, 0, frame, length, b.now_ns));
        TEST_ASSERT_EQUAL_UINT16(SLAVES, cm1e_get_u16(frame + 27));
    }
}

/* A frame cut anywhere: the datagrams that are whole are processed or the frame is lost, and nothing behind the end is
 * touched (the buffer is exactly as long, for the address sanitizer). */
static void test_truncated_frames_are_never_read_beyond_their_end(void)
{
    uint8_t whole[FRAME_MAX], data[8] = {0};
    size_t at = frame_add(whole, frame_begin(whole), BRD, 0, data, 8);
    at = frame_add(whole, at, BRD, 0x130 << 16, data, 2);
    for (size_t length = 0; length < at; length++) {
        uint8_t *frame = malloc(length + 1);
        memcpy(frame, whole, length);
        TEST_ASSERT_EQUAL_INT(CM1E_SIM_PORT_LOST, cm1e_sim_segment_process(b.segment, 0, frame, length, b.now_ns));
        free(frame);
    }
    TEST_ASSERT_GREATER_THAN_UINT8(0, read_u8(&b, 0, 0x30C)); /* the processing unit counted them */
}

static void test_datagram_longer_than_the_frame_is_ignored_with_the_rest(void)
{
    uint8_t frame[FRAME_MAX], data[8] = {0};
    const size_t first = frame_add(frame, frame_begin(frame), BRD, 0, data, 8);
    const size_t end = frame_add(frame, first, BRD, 0, data, 8);
    for (unsigned length = 9; length < 0x800; length++) {
        uint8_t copy[FRAME_MAX];
        memcpy(copy, frame, sizeof copy);
        cm1e_put_u16(copy + first + 6, (uint16_t)length);
        TEST_ASSERT_EQUAL_INT(CM1E_SIM_PORT_PRIMARY, cm1e_sim_segment_process(b.segment, 0, copy, end, b.now_ns));
        TEST_ASSERT_EQUAL_UINT16(SLAVES, cm1e_get_u16(copy + first - 2));
        TEST_ASSERT_EQUAL_UINT16(0, cm1e_get_u16(copy + end - 2));
    }
}

static void test_frames_of_others_are_lost(void)
{
    static const struct {
        size_t at;
        uint8_t value;
    } changes[] = {{12, 0x08}, {13, 0x00}, {15, 0x40}, {15, 0x50}, {15, 0x00}};
    for (unsigned i = 0; i < sizeof changes / sizeof changes[0]; i++) {
        uint8_t frame[FRAME_MAX], data[8] = {0};
        const size_t end = frame_add(frame, frame_begin(frame), BRD, 0, data, 8);
        frame[changes[i].at] = changes[i].value;
        TEST_ASSERT_EQUAL_INT(CM1E_SIM_PORT_LOST, cm1e_sim_segment_process(b.segment, 0, frame, end, b.now_ns));
    }
}

static void test_events_show_in_the_datagram_where_the_mask_lets_them(void)
{
    uint8_t data[2] = {0};
    write_u16(&b, 0, 0x120, 0x0008); /* refused, so the AL status changes */
    bench_wait(&b, 1000000);
    send_to(&b, BRD, 0, RAM, data, 2);
    TEST_ASSERT_EQUAL_HEX16(0, b.events);
    write_u16(&b, 0, 0x200, 0x0008);
    send_to(&b, BRD, 0, RAM, data, 2);
    TEST_ASSERT_EQUAL_HEX16(0x0008, b.events);
    read_u16(&b, 0, 0x130); /* reading AL status clears it */
    send_to(&b, BRD, 0, RAM, data, 2);
    TEST_ASSERT_EQUAL_HEX16(0, b.events);
}

static void test_memory_that_is_not_there_is_not_counted(void)
{
    uint8_t data[16] = {0};
    TEST_ASSERT_EQUAL_INT(1, send_to(&b, APRD, 0, 0x2FFF, data, 1));
    TEST_ASSERT_EQUAL_INT(0, send_to(&b, APRD, 0, 0x3000, data, 1));
    TEST_ASSERT_EQUAL_INT(0, send_to(&b, APWR, 0, 0xFFFF, data, 16));
    TEST_ASSERT_EQUAL_INT(1, send_to(&b, APWR, 0, 0x2FF8, data, 16)); /* the first half is */
    TEST_ASSERT_EQUAL_INT(0, send_to(&b, APRD, 0, RAM, data, 0));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_command_counts_returns_and_keeps_as_the_standard_says);
    RUN_TEST(test_broadcast_read_write_counts_three_per_slave);
    RUN_TEST(test_alias_answers_once_it_is_switched_on);
    RUN_TEST(test_working_counter_adds_to_what_it_was_and_wraps);
    RUN_TEST(test_several_datagrams_in_a_frame_are_each_counted);
    RUN_TEST(test_slaves_mark_the_source_address);
    RUN_TEST(test_index_and_header_come_back_unchanged);
    RUN_TEST(test_short_frames_come_unpadded_or_padded);
    RUN_TEST(test_truncated_frames_are_never_read_beyond_their_end);
    RUN_TEST(test_datagram_longer_than_the_frame_is_ignored_with_the_rest);
    RUN_TEST(test_frames_of_others_are_lost);
    RUN_TEST(test_events_show_in_the_datagram_where_the_mask_lets_them);
    RUN_TEST(test_memory_that_is_not_there_is_not_counted);
    return UNITY_END();
}
