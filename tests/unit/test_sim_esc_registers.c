/* Registers of the simulated slave controller: what they say, who may write them, the sync managers behind them. */
#include "sim_fake_app.h"

static bench_t b;

void setUp(void) { bench_open(&b, 1); }
void tearDown(void) { bench_close(&b); }

static void test_controller_describes_itself(void)
{
    TEST_ASSERT_EQUAL_HEX8(8, read_u8(&b, 0, 0x0004));
    TEST_ASSERT_EQUAL_HEX8(4, read_u8(&b, 0, 0x0005));
    TEST_ASSERT_EQUAL_HEX8(8, read_u8(&b, 0, 0x0006));
    TEST_ASSERT_EQUAL_HEX8(0x0F, read_u8(&b, 0, 0x0007));
    TEST_ASSERT_EQUAL_HEX16(0x0004, read_u16(&b, 0, 0x0008) & 0x0004); /* distributed clocks */
    TEST_ASSERT_EQUAL_HEX16(0x0000, read_u16(&b, 0, 0x0008) & 0x0001); /* FMMUs to the bit */
    TEST_ASSERT_EQUAL_HEX16(0x0000, read_u16(&b, 0, 0x0010));
    TEST_ASSERT_EQUAL_HEX16(0x4711, read_u16(&b, 0, 0x0012));
    TEST_ASSERT_EQUAL_HEX16(0x0001, read_u16(&b, 0, 0x0130));
    TEST_ASSERT_EQUAL_HEX16(0x0005, read_u16(&b, 0, 0x0140));
    TEST_ASSERT_EQUAL_HEX16(0x09C2, read_u16(&b, 0, 0x0400));
    TEST_ASSERT_EQUAL_HEX16(0x03E8, read_u16(&b, 0, 0x0420));
}

/* The registers that the description says are read-only for EtherCAT: a write is not counted and changes nothing. */
static void test_read_only_registers_refuse_writes(void)
{
    static const uint16_t addresses[] = {0x0000, 0x0004, 0x0008, 0x0012, 0x0110, 0x0130, 0x0134, 0x0140, 0x0210, 0x0220,
                                         0x0440, 0x0501, 0x0805, 0x0807, 0x0918, 0x092C, 0x0982, 0x0E00};
    for (unsigned i = 0; i < sizeof addresses / sizeof addresses[0]; i++) {
        char text[32];
        snprintf(text, sizeof text, "register 0x%04X", addresses[i]);
        const uint8_t before = read_u8(&b, 0, addresses[i]);
        TEST_ASSERT_EQUAL_INT_MESSAGE(0, write_u8(&b, 0, addresses[i], (uint8_t)~before), text);
        TEST_ASSERT_EQUAL_HEX8_MESSAGE(before, read_u8(&b, 0, addresses[i]), text);
    }
}

static void test_a_write_over_both_kinds_counts_and_changes_the_writable_ones(void)
{
    uint8_t data[4] = {0x34, 0x12, 0x99, 0x99};
    TEST_ASSERT_EQUAL_INT(1, write_bytes(&b, 0, 0x0010, data, 4));
    TEST_ASSERT_EQUAL_HEX16(0x1234, read_u16(&b, 0, 0x0010));
    TEST_ASSERT_EQUAL_HEX16(0x4711, read_u16(&b, 0, 0x0012));
}

static void test_error_counters_are_cleared_by_any_write(void)
{
    uint8_t bad[20] = {0};
    memset(bad, 0xFF, 12);
    bad[12] = 0x88;
    bad[13] = 0xA4;
    bad[15] = 0x10;
    for (int i = 0; i < 300; i++)
        cm1e_sim_segment_process(b.segment, 0, bad, sizeof bad, b.now_ns);
    TEST_ASSERT_EQUAL_HEX8(0xFF, read_u8(&b, 0, 0x030C)); /* and does not wrap */
    TEST_ASSERT_EQUAL_INT(1, write_u8(&b, 0, 0x030C, 0x55));
    TEST_ASSERT_EQUAL_HEX8(0, read_u8(&b, 0, 0x030C));
}

/* ---- sync managers --------------------------------------------------------------------------------------------- */

static void test_a_sync_manager_can_only_be_changed_while_it_is_off(void)
{
    write_sm(&b, 0, 2, 0x1100, 13, 0x64, 1);
    uint8_t other[8] = {0x00, 0x12, 0x20, 0x00, 0x20, 0, 1, 0};
    TEST_ASSERT_EQUAL_INT(1, write_bytes(&b, 0, 0x0810, other, 8)); /* the activate byte is written */
    TEST_ASSERT_EQUAL_HEX16(0x1100, read_u16(&b, 0, 0x0810));
    TEST_ASSERT_EQUAL_INT(0, write_bytes(&b, 0, 0x0810, other, 5));
    TEST_ASSERT_EQUAL_INT(1, write_u8(&b, 0, 0x0816, 0));
    TEST_ASSERT_EQUAL_INT(1, write_bytes(&b, 0, 0x0810, other, 8));
    TEST_ASSERT_EQUAL_HEX16(0x1200, read_u16(&b, 0, 0x0810));
    TEST_ASSERT_EQUAL_HEX16(0x20, read_u16(&b, 0, 0x0812));
}

/* All in one frame as SOEM writes them, off and rewritten. */
static void test_switching_off_takes_effect_with_the_next_frame(void)
{
    write_sm(&b, 0, 2, 0x1100, 13, 0x64, 1);
    uint8_t zero[8] = {0};
    TEST_ASSERT_EQUAL_INT(1, write_bytes(&b, 0, 0x0810, zero, 8));
    TEST_ASSERT_EQUAL_HEX16(0x1100, read_u16(&b, 0, 0x0810));
    TEST_ASSERT_EQUAL_INT(1, write_bytes(&b, 0, 0x0810, zero, 8));
    TEST_ASSERT_EQUAL_HEX16(0x0000, read_u16(&b, 0, 0x0810));
}

static void test_mailbox_in_init_is_not_accessible(void)
{
    uint8_t box[128] = {0};
    configure_mailboxes(&b, 0);
    TEST_ASSERT_EQUAL_INT(0, write_bytes(&b, 0, 0x1000, box, 128));
    TEST_ASSERT_EQUAL_INT(0, send_to(&b, APRD, 0, 0x1080, box, 128));
    TEST_ASSERT_EQUAL_HEX8(0x01, read_u8(&b, 0, 0x0807) & 0x01);
}

static void test_write_mailbox_takes_one_message_until_the_slave_has_read_it(void)
{
    uint8_t box[128] = {0};
    bring_to(&b, 0, CM1E_AL_PRE_OP);
    box[5] = 0x0F; /* a protocol that does not exist */
    TEST_ASSERT_EQUAL_HEX8(0, read_u8(&b, 0, 0x0805) & 0x08);
    TEST_ASSERT_EQUAL_INT(1, write_bytes(&b, 0, 0x1000, box, 127));
    TEST_ASSERT_EQUAL_HEX8(0, read_u8(&b, 0, 0x0805) & 0x08); /* the last byte is missing */
    TEST_ASSERT_EQUAL_INT(1, write_u8(&b, 0, 0x107F, 0));
    TEST_ASSERT_EQUAL_HEX8(0x08, read_u8(&b, 0, 0x0805) & 0x08);
    TEST_ASSERT_EQUAL_INT(0, write_bytes(&b, 0, 0x1000, box, 128));
    TEST_ASSERT_EQUAL_INT(0, send_to(&b, APRD, 0, 0x1000, box, 128)); /* the wrong direction */
    bench_wait(&b, 1000000);
    TEST_ASSERT_EQUAL_HEX8(0, read_u8(&b, 0, 0x0805) & 0x08);
}

static void test_write_in_the_middle_of_a_closed_mailbox_is_refused(void)
{
    uint8_t box[128] = {0};
    bring_to(&b, 0, CM1E_AL_PRE_OP);
    TEST_ASSERT_EQUAL_INT(0, write_bytes(&b, 0, 0x1001, box, 127));
    TEST_ASSERT_EQUAL_INT(0, write_u8(&b, 0, 0x107F, 0));
    TEST_ASSERT_EQUAL_HEX8(0, read_u8(&b, 0, 0x0805) & 0x08);
}

static void test_read_mailbox_empties_with_its_last_byte(void)
{
    uint8_t box[128] = {0}, junk[1] = {0};
    uint16_t length;
    bring_to(&b, 0, CM1E_AL_PRE_OP);
    TEST_ASSERT_EQUAL_INT(0, send_to(&b, APRD, 0, 0x1080, box, 128));
    TEST_ASSERT_EQUAL_INT(1, mailbox_put(&b, 0x0F, 1, junk, 1));
    bench_wait(&b, 1000000);
    TEST_ASSERT_EQUAL_HEX8(0x08, read_u8(&b, 0, 0x080D) & 0x08);
    TEST_ASSERT_EQUAL_INT(0, send_to(&b, APRD, 0, 0x1090, box, 8)); /* not opened yet */
    TEST_ASSERT_EQUAL_INT(1, send_to(&b, APRD, 0, 0x1080, box, 100));
    TEST_ASSERT_EQUAL_HEX8(0x08, read_u8(&b, 0, 0x080D) & 0x08);
    TEST_ASSERT_EQUAL_INT(1, send_to(&b, APRD, 0, 0x1080 + 100, box + 100, 28));
    TEST_ASSERT_EQUAL_HEX8(0, read_u8(&b, 0, 0x080D) & 0x08);
    TEST_ASSERT_EQUAL_UINT16(4, cm1e_get_u16(box));
    TEST_ASSERT_EQUAL_INT(0, send_to(&b, APRD, 0, 0x1080, box, 128));
    TEST_ASSERT_EQUAL_INT(-1, mailbox_get(&b, &length));
}

static void test_process_data_is_accessible_from_safe_operational_on(void)
{
    uint8_t out[13] = {1, 2, 3}, in[21] = {0};
    bring_to(&b, 0, CM1E_AL_PRE_OP);
    configure_process_data(&b, 0);
    TEST_ASSERT_EQUAL_INT(0, write_bytes(&b, 0, 0x1100, out, 13));
    TEST_ASSERT_EQUAL_INT(0, send_to(&b, APRD, 0, 0x1400, in, 21));
    TEST_ASSERT_EQUAL_HEX16(CM1E_AL_SAFE_OP, request_state(&b, 0, CM1E_AL_SAFE_OP));
    b.apps[0]->inputs[0] = 0x5A;
    b.apps[0]->inputs[20] = 0xA5;
    TEST_ASSERT_EQUAL_INT(1, write_bytes(&b, 0, 0x1100, out, 13));
    TEST_ASSERT_EQUAL_UINT(0, b.apps[0]->outputs_taken); /* not before Operational */
    TEST_ASSERT_EQUAL_INT(1, send_to(&b, APRD, 0, 0x1400, in, 21));
    TEST_ASSERT_EQUAL_HEX8(0x5A, in[0]);
    TEST_ASSERT_EQUAL_HEX8(0xA5, in[20]);
    TEST_ASSERT_EQUAL_HEX16(CM1E_AL_OP, request_state(&b, 0, CM1E_AL_OP));
    TEST_ASSERT_EQUAL_INT(1, write_bytes(&b, 0, 0x1100, out, 13));
    TEST_ASSERT_EQUAL_UINT(1, b.apps[0]->outputs_taken);
    TEST_ASSERT_EQUAL_UINT16(13, b.apps[0]->outputs_size);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(out, b.apps[0]->outputs, 13);
}

static void test_slave_takes_complete_outputs_only(void)
{
    uint8_t first[13], second[13];
    memset(first, 1, sizeof first);
    memset(second, 2, sizeof second);
    bring_to(&b, 0, CM1E_AL_OP);
    TEST_ASSERT_EQUAL_INT(1, write_bytes(&b, 0, 0x1100, first, 12));
    TEST_ASSERT_EQUAL_UINT(0, b.apps[0]->outputs_taken);
    TEST_ASSERT_EQUAL_INT(1, write_bytes(&b, 0, 0x110C, first, 1));
    TEST_ASSERT_EQUAL_UINT(1, b.apps[0]->outputs_taken);
    TEST_ASSERT_EQUAL_INT(0, write_bytes(&b, 0, 0x1101, second, 12));
    TEST_ASSERT_EQUAL_UINT(1, b.apps[0]->outputs_taken);
    /* a whole one and the begin of the next in the same frame */
    uint8_t frame[FRAME_MAX];
    size_t end = frame_add(frame, frame_begin(frame), APWR, 0x1100u << 16, second, 13);
    end = frame_add(frame, end, APWR, 0x1100u << 16, first, 5);
    /* both address slave 0: it counts the second address only when it passes */
    cm1e_sim_segment_process(b.segment, 0, frame, end, b.now_ns);
    TEST_ASSERT_EQUAL_UINT(2, b.apps[0]->outputs_taken);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(second, b.apps[0]->outputs, 13);
}

/* Inputs are those from before the outputs of the same frame, as a drive in SM-synchronous mode has them. */
static void test_inputs_are_read_once_a_frame(void)
{
    uint8_t in[21] = {0};
    bring_to(&b, 0, CM1E_AL_OP);
    b.apps[0]->inputs[0] = 1;
    b.now_ns += 1000;
    TEST_ASSERT_EQUAL_INT(1, send_to(&b, APRD, 0, 0x1400, in, 10)); /* opened */
    b.apps[0]->inputs[15] = 9;
    b.now_ns += 1000;
    TEST_ASSERT_EQUAL_INT(1, send_to(&b, APRD, 0, 0x1400 + 10, in + 10, 11));
    TEST_ASSERT_EQUAL_HEX8(1, in[0]);
    TEST_ASSERT_EQUAL_HEX8(0, in[15]); /* of the same buffer */
    TEST_ASSERT_EQUAL_INT(1, send_to(&b, APRD, 0, 0x1400, in, 21));
    TEST_ASSERT_EQUAL_HEX8(9, in[15]);
}

static void test_buffers_take_turns(void)
{
    uint8_t out[13] = {0};
    bring_to(&b, 0, CM1E_AL_OP);
    TEST_ASSERT_EQUAL_HEX8(0x30, read_u8(&b, 0, 0x0815) & 0x30); /* nothing written yet */
    for (unsigned i = 0; i < 7; i++) {
        write_bytes(&b, 0, 0x1100, out, 13);
        TEST_ASSERT_EQUAL_HEX8(i % 3 << 4, read_u8(&b, 0, 0x0815) & 0x30);
    }
}

/* ---- watchdog -------------------------------------------------------------------------------------------------- */

static void test_watchdog_expires_after_its_time_and_not_before(void)
{
    uint8_t out[13] = {0};
    bring_to(&b, 0, CM1E_AL_OP);
    for (int i = 0; i < 20; i++) {
        write_bytes(&b, 0, 0x1100, out, 13);
        bench_wait(&b, 99000000);
        TEST_ASSERT_EQUAL_HEX8(1, read_u8(&b, 0, 0x0440));
    }
    TEST_ASSERT_EQUAL_HEX16(CM1E_AL_OP, read_u16(&b, 0, 0x0130));
    TEST_ASSERT_EQUAL_UINT(0, b.apps[0]->watchdogs);
    bench_wait(&b, 1000000);
    TEST_ASSERT_EQUAL_HEX16(CM1E_AL_SAFE_OP | CM1E_AL_ERROR, read_u16(&b, 0, 0x0130));
    TEST_ASSERT_EQUAL_HEX16(AL_CODE_SM_WATCHDOG, read_u16(&b, 0, 0x0134));
    TEST_ASSERT_EQUAL_UINT(1, b.apps[0]->watchdogs);
    TEST_ASSERT_EQUAL_HEX8(0, read_u8(&b, 0, 0x0440));
    TEST_ASSERT_EQUAL_HEX8(1, read_u8(&b, 0, 0x0442));
    TEST_ASSERT_EQUAL_INT(1, write_u8(&b, 0, 0x0442, 0));
    TEST_ASSERT_EQUAL_HEX8(0, read_u8(&b, 0, 0x0442));
}

/* divider, time, expected period in ns */
static void test_watchdog_time_is_what_the_registers_say(void)
{
    static const struct {
        uint16_t divider, time;
        int64_t period_ns;
    } rows[] = {{2498, 1, 100000}, {2498, 50, 5000000}, {0, 1000, 80000}, {65535, 10, 26214800}};
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        tearDown();
        setUp();
        uint8_t out[13] = {0};
        bring_to(&b, 0, CM1E_AL_SAFE_OP);
        write_u16(&b, 0, 0x0400, rows[i].divider);
        write_u16(&b, 0, 0x0420, rows[i].time);
        write_bytes(&b, 0, 0x1100, out, 13);
        bench_wait(&b, rows[i].period_ns - 1);
        TEST_ASSERT_EQUAL_HEX8(1, read_u8(&b, 0, 0x0440));
        bench_wait(&b, 1);
        TEST_ASSERT_EQUAL_HEX8(0, read_u8(&b, 0, 0x0440));
        TEST_ASSERT_EQUAL_HEX16(CM1E_AL_SAFE_OP, read_u16(&b, 0, 0x0130)); /* of no consequence here */
    }
}

static void test_watchdog_time_zero_switches_it_off(void)
{
    bring_to(&b, 0, CM1E_AL_OP);
    write_u16(&b, 0, 0x0420, 0);
    bench_wait(&b, 10000000000);
    TEST_ASSERT_EQUAL_HEX16(CM1E_AL_OP, read_u16(&b, 0, 0x0130));
    TEST_ASSERT_EQUAL_HEX8(0, read_u8(&b, 0, 0x0442));
}

static void test_outputs_without_trigger_bit_do_not_serve_the_watchdog(void)
{
    uint8_t out[13] = {0};
    bring_to(&b, 0, CM1E_AL_PRE_OP);
    write_sm(&b, 0, 2, 0x1100, 13, 0x24, 1);
    write_sm(&b, 0, 3, 0x1400, 21, 0x20, 1);
    request_state(&b, 0, CM1E_AL_SAFE_OP);
    TEST_ASSERT_EQUAL_HEX16(CM1E_AL_OP, request_state(&b, 0, CM1E_AL_OP));
    for (int i = 0; i < 120; i++) {
        write_bytes(&b, 0, 0x1100, out, 13);
        bench_wait(&b, 1000000);
    }
    TEST_ASSERT_EQUAL_HEX16(CM1E_AL_SAFE_OP | CM1E_AL_ERROR, read_u16(&b, 0, 0x0130));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_controller_describes_itself);
    RUN_TEST(test_read_only_registers_refuse_writes);
    RUN_TEST(test_a_write_over_both_kinds_counts_and_changes_the_writable_ones);
    RUN_TEST(test_error_counters_are_cleared_by_any_write);
    RUN_TEST(test_a_sync_manager_can_only_be_changed_while_it_is_off);
    RUN_TEST(test_switching_off_takes_effect_with_the_next_frame);
    RUN_TEST(test_mailbox_in_init_is_not_accessible);
    RUN_TEST(test_write_mailbox_takes_one_message_until_the_slave_has_read_it);
    RUN_TEST(test_write_in_the_middle_of_a_closed_mailbox_is_refused);
    RUN_TEST(test_read_mailbox_empties_with_its_last_byte);
    RUN_TEST(test_process_data_is_accessible_from_safe_operational_on);
    RUN_TEST(test_slave_takes_complete_outputs_only);
    RUN_TEST(test_inputs_are_read_once_a_frame);
    RUN_TEST(test_buffers_take_turns);
    RUN_TEST(test_watchdog_expires_after_its_time_and_not_before);
    RUN_TEST(test_watchdog_time_is_what_the_registers_say);
    RUN_TEST(test_watchdog_time_zero_switches_it_off);
    RUN_TEST(test_outputs_without_trigger_bit_do_not_serve_the_watchdog);
    return UNITY_END();
}
