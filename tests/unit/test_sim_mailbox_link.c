/* The mailbox below the protocols: counters, repetition, errors, emergencies. */
#include "sim_fake_app.h"

static bench_t b;
static uint16_t length;

void setUp(void)
{
    bench_open(&b, 1);
    bring_to(&b, 0, CM1E_AL_PRE_OP);
}
void tearDown(void) { bench_close(&b); }

static cm1e_sim_slave_t *slave(void) { return cm1e_sim_segment_slave(b.segment, 1); }

/* SDO download of a byte to 0x2000. */
static const uint8_t download[] = {0x00, 0x20, 0x2F, 0x00, 0x20, 0x00, 0x33, 0, 0, 0};
/* SDO upload of 0x2001. */
static const uint8_t upload[] = {0x00, 0x20, 0x40, 0x01, 0x20, 0x00, 0, 0, 0, 0};

static void test_answers_count_from_1_to_7(void)
{
    for (unsigned i = 0; i < 16; i++) {
        TEST_ASSERT_EQUAL_INT(1, mailbox_put(&b, 3, (uint8_t)(i % 7 + 1), upload, sizeof upload));
        TEST_ASSERT_EQUAL_HEX8(3 | (i % 7 + 1) << 4, mailbox_get(&b, &length));
        TEST_ASSERT_EQUAL_HEX8(0x43, b.answer[2]);
    }
}

static void test_an_answer_takes_time(void)
{
    mailbox_put(&b, 3, 1, upload, sizeof upload);
    TEST_ASSERT_EQUAL_HEX8(0, read_u8(&b, 0, 0x080D) & 0x08);
    bench_wait(&b, 199999);
    TEST_ASSERT_EQUAL_HEX8(0, read_u8(&b, 0, 0x080D) & 0x08);
    bench_wait(&b, 1);
    TEST_ASSERT_EQUAL_HEX8(0x08, read_u8(&b, 0, 0x080D) & 0x08);
}

/* The master resends a request because the frame with the working counter was lost. */
static void test_a_repeated_counter_is_not_executed_twice(void)
{
    mailbox_put(&b, 3, 3, download, sizeof download);
    TEST_ASSERT_NOT_EQUAL(-1, mailbox_get(&b, &length));
    TEST_ASSERT_EQUAL_UINT(1, b.apps[0]->sdo_writes);
    TEST_ASSERT_EQUAL_INT(1, mailbox_put(&b, 3, 3, download, sizeof download));
    TEST_ASSERT_EQUAL_INT(-1, mailbox_get(&b, &length));
    TEST_ASSERT_EQUAL_UINT(1, b.apps[0]->sdo_writes);
    TEST_ASSERT_EQUAL_HEX8(0, read_u8(&b, 0, 0x0805) & 0x08); /* taken all the same */
    mailbox_put(&b, 3, 4, download, sizeof download);
    TEST_ASSERT_NOT_EQUAL(-1, mailbox_get(&b, &length));
    TEST_ASSERT_EQUAL_UINT(2, b.apps[0]->sdo_writes);
}

static void test_counter_0_says_nothing_about_repetition(void)
{
    for (unsigned i = 1; i <= 3; i++) {
        mailbox_put(&b, 3, 0, download, sizeof download);
        TEST_ASSERT_NOT_EQUAL(-1, mailbox_get(&b, &length));
        TEST_ASSERT_EQUAL_UINT(i, b.apps[0]->sdo_writes);
    }
}

/* Toggles the repeat request and waits for the acknowledgement. */
static void ask_repetition(void)
{
    const uint8_t activate = read_u8(&b, 0, 0x080E) ^ 0x02;
    TEST_ASSERT_EQUAL_INT(1, write_u8(&b, 0, 0x080E, activate));
    for (int i = 0; i < 10 && (read_u8(&b, 0, 0x080F) & 0x02) != (activate & 0x02); i++)
        bench_wait(&b, 100000);
    TEST_ASSERT_EQUAL_HEX8(activate & 0x02, read_u8(&b, 0, 0x080F) & 0x02);
}

static void test_a_lost_answer_comes_again_on_request(void)
{
    mailbox_put(&b, 3, 1, upload, sizeof upload);
    const int first = mailbox_get(&b, &length);
    for (int i = 0; i < 3; i++) {
        ask_repetition();
        memset(b.answer, 0, sizeof b.answer);
        TEST_ASSERT_EQUAL_INT(first, mailbox_get(&b, &length));
        TEST_ASSERT_EQUAL_UINT16(10, length);
        TEST_ASSERT_EQUAL_HEX32(0x12345678, cm1e_get_u32(b.answer + 6));
    }
    TEST_ASSERT_EQUAL_INT(-1, mailbox_get(&b, &length));
}

static void test_a_repetition_with_nothing_sent_is_acknowledged_only(void)
{
    ask_repetition();
    TEST_ASSERT_EQUAL_INT(-1, mailbox_get(&b, &length));
    ask_repetition();
    TEST_ASSERT_EQUAL_INT(-1, mailbox_get(&b, &length));
}

/* The answer was lost, and an emergency is in the mailbox already: first the answer again, then the emergency. */
static void test_a_repetition_goes_before_what_was_loaded_meanwhile(void)
{
    static const uint8_t more[5] = {1, 2, 3, 4, 5};
    mailbox_put(&b, 3, 1, upload, sizeof upload);
    const int answer = mailbox_get(&b, &length);
    TEST_ASSERT_TRUE(cm1e_sim_slave_emergency(slave(), 0x7510, 0x10, more));
    bench_wait(&b, 1000000);
    TEST_ASSERT_EQUAL_HEX8(0x08, read_u8(&b, 0, 0x080D) & 0x08);
    ask_repetition();
    TEST_ASSERT_EQUAL_INT(answer, mailbox_get(&b, &length));
    TEST_ASSERT_EQUAL_HEX8(0x43, b.answer[2]);
    TEST_ASSERT_EQUAL_HEX8(0x23, mailbox_get(&b, &length));
    TEST_ASSERT_EQUAL_HEX16(0x7510, cm1e_get_u16(b.answer + 2));
    TEST_ASSERT_EQUAL_INT(-1, mailbox_get(&b, &length));
}

static void test_emergencies_are_queued_and_come_in_order(void)
{
    static const uint8_t more[5] = {9, 8, 7, 6, 5};
    for (uint16_t i = 0; i < 8; i++)
        TEST_ASSERT_TRUE(cm1e_sim_slave_emergency(slave(), 0x1000 + i, (uint8_t)i, more));
    TEST_ASSERT_FALSE(cm1e_sim_slave_emergency(slave(), 0x2000, 0, more));
    for (uint16_t i = 0; i < 8; i++) {
        TEST_ASSERT_EQUAL_HEX8(3, mailbox_get(&b, &length) & 0x0F);
        TEST_ASSERT_EQUAL_UINT16(10, length);
        TEST_ASSERT_EQUAL_HEX16(0x1000, cm1e_get_u16(b.answer));
        TEST_ASSERT_EQUAL_HEX16(0x1000 + i, cm1e_get_u16(b.answer + 2));
        TEST_ASSERT_EQUAL_HEX8(i, b.answer[4]);
        TEST_ASSERT_EQUAL_HEX8_ARRAY(more, b.answer + 5, 5);
    }
    TEST_ASSERT_EQUAL_INT(-1, mailbox_get(&b, &length));
    TEST_ASSERT_TRUE(cm1e_sim_slave_emergency(slave(), 0x2000, 0, more));
}

static void test_no_emergency_in_init(void)
{
    static const uint8_t more[5] = {0};
    request_state(&b, 0, CM1E_AL_INIT);
    TEST_ASSERT_FALSE(cm1e_sim_slave_emergency(slave(), 0x2000, 0, more));
}

/* A request while the answer to the last one has not been read waits in the write mailbox. */
static void test_requests_wait_for_room(void)
{
    mailbox_put(&b, 3, 1, upload, sizeof upload);
    bench_wait(&b, 1000000);
    TEST_ASSERT_EQUAL_INT(1, mailbox_put(&b, 3, 2, download, sizeof download));
    bench_wait(&b, 1000000);
    TEST_ASSERT_EQUAL_INT(1, mailbox_put(&b, 3, 3, upload, sizeof upload));
    bench_wait(&b, 10000000);
    TEST_ASSERT_EQUAL_HEX8(0x08, read_u8(&b, 0, 0x0805) & 0x08);
    TEST_ASSERT_EQUAL_INT(0, mailbox_put(&b, 3, 4, upload, sizeof upload));
    static const uint8_t commands[] = {0x43, 0x60, 0x43};
    for (unsigned i = 0; i < 3; i++) {
        TEST_ASSERT_NOT_EQUAL(-1, mailbox_get(&b, &length));
        TEST_ASSERT_EQUAL_HEX8(commands[i], b.answer[2]);
    }
}

/* type, length in the header, bytes, detail of the mailbox error (0: no answer) */
static void test_what_is_wrong_with_a_message_is_told(void)
{
    static const struct {
        uint8_t type;
        uint16_t length;
        uint8_t data[10];
        uint16_t detail;
    } rows[] = {
        {1, 10, {0}, 0x02}, {2, 10, {0}, 0x02}, {5, 10, {0}, 0x02}, {6, 10, {0}, 0x02}, {15, 10, {0}, 0x02},
        {0, 10, {0}, 0},                                 /* an error is not answered */
        {3, 123, {0}, 0x08}, {3, 0xFFFF, {0}, 0x08}, {15, 123, {0}, 0x08},
        {3, 0, {0}, 0x06}, {3, 1, {0}, 0x06},
        {3, 9, {0x00, 0x20}, 0x06},                      /* SDO request */
        {3, 5, {0x00, 0x80}, 0x06},                      /* SDO information */
        {3, 10, {0x00, 0x00}, 0x05}, {3, 10, {0x00, 0x90}, 0x05}, {3, 10, {0x00, 0xF0}, 0x05},
        {3, 10, {0x00, 0x10}, 0x04}, {3, 10, {0x00, 0x30}, 0x04}, {3, 10, {0x00, 0x40}, 0x04},
        {3, 10, {0x00, 0x50}, 0x04}, {3, 10, {0x00, 0x60}, 0x04}, {3, 10, {0x00, 0x70}, 0x04},
    };
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        char text[32];
        snprintf(text, sizeof text, "row %u", i);
        uint8_t box[128] = {0};
        cm1e_put_u16(box, rows[i].length);
        box[5] = (uint8_t)(rows[i].type | (i % 7 + 1) << 4);
        memcpy(box + 6, rows[i].data, 10);
        TEST_ASSERT_EQUAL_INT(1, write_bytes(&b, 0, 0x1000, box, sizeof box));
        const int type = mailbox_get(&b, &length);
        if (rows[i].detail == 0) {
            TEST_ASSERT_EQUAL_INT_MESSAGE(-1, type, text);
            continue;
        }
        TEST_ASSERT_EQUAL_INT_MESSAGE(0, type & 0x0F, text);
        TEST_ASSERT_EQUAL_UINT16_MESSAGE(4, length, text);
        TEST_ASSERT_EQUAL_HEX16_MESSAGE(1, cm1e_get_u16(b.answer), text);
        TEST_ASSERT_EQUAL_HEX16_MESSAGE(rows[i].detail, cm1e_get_u16(b.answer + 2), text);
    }
}

static void test_files_are_taken_in_bootstrap_only(void)
{
    static const uint8_t write_request[] = {2, 0, 0, 0, 0, 0, 'a'};
    TEST_ASSERT_EQUAL_INT(4, mailbox_ask(&b, 4, write_request, sizeof write_request, &length));
    TEST_ASSERT_EQUAL_HEX8(5, b.answer[0]);
    TEST_ASSERT_EQUAL_HEX32(0x8008, cm1e_get_u32(b.answer + 2));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_answers_count_from_1_to_7);
    RUN_TEST(test_an_answer_takes_time);
    RUN_TEST(test_a_repeated_counter_is_not_executed_twice);
    RUN_TEST(test_counter_0_says_nothing_about_repetition);
    RUN_TEST(test_a_lost_answer_comes_again_on_request);
    RUN_TEST(test_a_repetition_with_nothing_sent_is_acknowledged_only);
    RUN_TEST(test_a_repetition_goes_before_what_was_loaded_meanwhile);
    RUN_TEST(test_emergencies_are_queued_and_come_in_order);
    RUN_TEST(test_no_emergency_in_init);
    RUN_TEST(test_requests_wait_for_room);
    RUN_TEST(test_what_is_wrong_with_a_message_is_told);
    RUN_TEST(test_files_are_taken_in_bootstrap_only);
    return UNITY_END();
}
