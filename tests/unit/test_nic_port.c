/* SOEM's port contract on a wire of the test's own: indices, answers in and out of order, hostile answers, exact
 * waits. */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include <ethercat.h>
#include <unity.h>

#include "../support/fake_wire.h"

enum { RTT_NS = WIRE_BASE_NS + WIRE_SLAVES * WIRE_SLAVE_NS };

static ecx_portt port;
static cm1e_nic_t *nic;

void setUp(void)
{
    memset(&port, 0, sizeof port);
    nic = port.nic = wire_start(false);
    TEST_ASSERT_NOT_NULL(nic);
    TEST_ASSERT_EQUAL_INT(1, ecx_setupnic(&port, "wire", FALSE));
}

void tearDown(void)
{
    ecx_closenic(&port);
    cm1e_nic_close(nic);
}

static int64_t now(void) { return cm1e_clock_now(cm1e_nic_clock(nic)); }

/** Sends a read of 2 bytes of one slave; its index. */
static uint8 send_read(int slave)
{
    uint16_t zero = 0;
    const uint8 idx = ecx_getindex(&port);
    ecx_setupdatagram(&port, &port.txbuf[idx], EC_CMD_FPRD, idx, (uint16)(WIRE_STATION + slave - 1), 2, 2, &zero);
    TEST_ASSERT_GREATER_THAN_INT(0, ecx_outframe_red(&port, idx));
    return idx;
}

static void expect_slave(uint8 idx, int slave)
{
    TEST_ASSERT_EQUAL_HEX8(slave * 16 + 2, port.rxbuf[idx][EC_HEADERSIZE]);
    TEST_ASSERT_EQUAL_HEX8(slave * 16 + 3, port.rxbuf[idx][EC_HEADERSIZE + 1]);
}

/* ---- the plain contract ------------------------------------------------------------------------------------------ */

static void test_headers_are_prepared_in_all_buffers(void)
{
    static const uint8_t header[14] = {255, 255, 255, 255, 255, 255, 1, 1, 1, 1, 1, 1, 0x88, 0xA4};
    for (int i = 0; i < EC_MAXBUF; i++)
        TEST_ASSERT_EQUAL_MEMORY(header, port.txbuf[i], 14);
    TEST_ASSERT_EQUAL_MEMORY(header, port.txbuf2, 14);
}

static void test_soem_primitives_read_and_write_slaves(void)
{
    uint16_t value = 0;
    TEST_ASSERT_EQUAL_INT(WIRE_SLAVES, ecx_BRD(&port, 0, 0, 2, &value, EC_TIMEOUTRET));
    TEST_ASSERT_EQUAL_INT(1, ecx_FPRD(&port, WIRE_STATION + 2, 4, 2, &value, EC_TIMEOUTRET));
    TEST_ASSERT_EQUAL_HEX16(0x3534, value);
    value = 0xBEEF;
    TEST_ASSERT_EQUAL_INT(1, ecx_APWR(&port, (uint16)-1, 6, 2, &value, EC_TIMEOUTRET));
    TEST_ASSERT_EQUAL_HEX8(0xEF, wire.slave[2].registers[6]);
    TEST_ASSERT_EQUAL_INT(0, ecx_FPRD(&port, 0x2000, 4, 2, &value, EC_TIMEOUTRET));
    TEST_ASSERT_EQUAL_INT64(1000000 + 4 * RTT_NS, now());
    TEST_ASSERT_EQUAL_UINT64(4, port.counters.sent);
    TEST_ASSERT_EQUAL_UINT64(4, port.counters.received);
}

static void test_working_counter_is_that_of_the_last_datagram(void)
{
    uint8_t image[2 * WIRE_SLAVES] = {1, 2, 3, 4};
    int64 time = 0;
    TEST_ASSERT_EQUAL_INT(3 * WIRE_SLAVES, ecx_LRW(&port, 0, sizeof image, image, EC_TIMEOUTRET));
    TEST_ASSERT_EQUAL_HEX8(0xA3, image[WIRE_SLAVES + 2]);
    TEST_ASSERT_EQUAL_UINT8(4, wire.slave[4].output);
    /* FRMW behind it: read of slave 1 and written to the three others counts 4 here. */
    const uint8 idx = ecx_getindex(&port);
    ecx_setupdatagram(&port, &port.txbuf[idx], EC_CMD_LRW, idx, 0, 0, sizeof image, image);
    ecx_adddatagram(&port, &port.txbuf[idx], EC_CMD_FRMW, idx, FALSE, WIRE_STATION, 16, 8, &time);
    TEST_ASSERT_EQUAL_INT(4, ecx_srconfirm(&port, idx, EC_TIMEOUTRET));
    ecx_setbufstat(&port, idx, EC_BUF_EMPTY);
}

static void test_answers_are_found_in_any_order_of_asking(void)
{
    uint8 idx[EC_MAXBUF];
    for (int i = 0; i < EC_MAXBUF; i++)
        idx[i] = send_read(1 + i % WIRE_SLAVES);
    for (int i = EC_MAXBUF - 1; i >= 0; i--) {
        TEST_ASSERT_EQUAL_INT(1, ecx_waitinframe(&port, idx[i], 100));
        expect_slave(idx[i], 1 + i % WIRE_SLAVES);
        ecx_setbufstat(&port, idx[i], EC_BUF_EMPTY);
    }
    TEST_ASSERT_EQUAL_INT64(1000000 + RTT_NS, now());
    TEST_ASSERT_EQUAL_UINT64(0, port.counters.late + port.counters.duplicates + port.counters.malformed);
}

static void test_a_failed_send_is_reported_and_waited_for_no_longer_than_asked(void)
{
    wire.refuse = true;
    const uint8 idx = ecx_getindex(&port);
    uint16_t zero = 0;
    ecx_setupdatagram(&port, &port.txbuf[idx], EC_CMD_BRD, idx, 0, 0, 2, &zero);
    TEST_ASSERT_EQUAL_INT(-1, ecx_outframe_red(&port, idx));
    TEST_ASSERT_EQUAL_INT(EC_NOFRAME, ecx_srconfirm(&port, idx, 5000));
    TEST_ASSERT_EQUAL_INT64(1000000 + 5000000, now());
    TEST_ASSERT_EQUAL_UINT64(1 + 3, port.counters.send_failed);
}

static void test_lengths_and_indices_out_of_range_are_refused(void)
{
    static const int lengths[] = {-1, 0, 14, 27, EC_BUFSIZE + 1, 1 << 20};
    for (size_t i = 0; i < sizeof lengths / sizeof lengths[0]; i++) {
        port.txbuflength[3] = lengths[i];
        TEST_ASSERT_EQUAL_INT(-1, ecx_outframe_red(&port, 3));
        TEST_ASSERT_EQUAL_INT(EC_NOFRAME, ecx_srconfirm(&port, 3, 100));
    }
    for (int idx = EC_MAXBUF; idx < 256; idx++) {
        TEST_ASSERT_EQUAL_INT(-1, ecx_outframe_red(&port, (uint8)idx));
        TEST_ASSERT_EQUAL_INT(EC_NOFRAME, ecx_waitinframe(&port, (uint8)idx, 0));
        ecx_setbufstat(&port, (uint8)idx, EC_BUF_EMPTY);
    }
    TEST_ASSERT_EQUAL_INT(0, wire.sent[0]);
}

static void test_without_a_nic_nothing_works_and_nothing_crashes(void)
{
    static ecx_portt none;
    none.txbuflength[0] = 60;
    TEST_ASSERT_EQUAL_INT(-1, ecx_outframe_red(&none, 0));
    TEST_ASSERT_EQUAL_INT(EC_NOFRAME, ecx_waitinframe(&none, 0, 1000));
    TEST_ASSERT_EQUAL_INT(EC_NOFRAME, ecx_srconfirm(&none, 0, 1000));
    TEST_ASSERT_EQUAL_INT(0, ecx_setupnic(&none, "eth", TRUE));
    TEST_ASSERT_EQUAL_INT(0, ecx_closenic(&none));
}

/* ---- indices ----------------------------------------------------------------------------------------------------- */

static void test_indices_are_given_once_each_until_released(void)
{
    bool given[EC_MAXBUF] = {false};
    for (int i = 0; i < EC_MAXBUF; i++) {
        const uint8 idx = ecx_getindex(&port);
        TEST_ASSERT_LESS_THAN_UINT8(EC_MAXBUF, idx);
        TEST_ASSERT_FALSE(given[idx]);
        given[idx] = true;
    }
    TEST_ASSERT_EQUAL_UINT64(0, port.counters.index_reused);
    ecx_setbufstat(&port, 11, EC_BUF_EMPTY);
    TEST_ASSERT_EQUAL_UINT8(11, ecx_getindex(&port));
    TEST_ASSERT_EQUAL_UINT64(0, port.counters.index_reused);
}

static void test_with_all_indices_in_use_the_least_missed_is_taken_and_counted(void)
{
    uint8 idx[EC_MAXBUF];
    for (int i = 0; i < EC_MAXBUF - 2; i++)
        idx[i] = send_read(1);
    idx[14] = ecx_getindex(&port);
    idx[15] = ecx_getindex(&port);
    /* All others are received meanwhile, or on the way. */
    TEST_ASSERT_EQUAL_INT(1, ecx_waitinframe(&port, idx[9], 100));
    TEST_ASSERT_EQUAL_UINT8(idx[9], ecx_getindex(&port));
    TEST_ASSERT_EQUAL_UINT64(1, port.counters.index_reused);
    /* Now nothing is complete: the oldest received one goes. */
    TEST_ASSERT_EQUAL_UINT8(idx[0], ecx_getindex(&port));
    TEST_ASSERT_EQUAL_UINT64(2, port.counters.index_reused);
    /* Thousands of leaked indices never give one outside the buffers and always count. */
    for (int i = 0; i < 5000; i++)
        TEST_ASSERT_LESS_THAN_UINT8(EC_MAXBUF, ecx_getindex(&port));
    TEST_ASSERT_EQUAL_UINT64(5002, port.counters.index_reused);
}

/* ---- late, doubled, foreign -------------------------------------------------------------------------------------- */

static void test_an_answer_to_a_released_index_is_dropped_and_counted(void)
{
    const uint8 idx = send_read(2);
    TEST_ASSERT_EQUAL_INT(EC_NOFRAME, ecx_waitinframe(&port, idx, 0));
    ecx_setbufstat(&port, idx, EC_BUF_EMPTY);
    uint16_t value = 0;
    TEST_ASSERT_EQUAL_INT(1, ecx_FPRD(&port, WIRE_STATION, 2, 2, &value, EC_TIMEOUTRET));
    TEST_ASSERT_EQUAL_HEX16(0x1312, value);
    TEST_ASSERT_EQUAL_UINT64(1, port.counters.late);
}

static void test_a_late_answer_is_not_taken_for_the_next_use_of_its_index(void)
{
    /* Same index, same command, same length: only the stamp of the transmission tells them apart. */
    const uint8 idx = ecx_getindex(&port);
    uint16_t zero = 0;
    for (int slave = 1; slave <= 2; slave++) {
        ecx_setupdatagram(&port, &port.txbuf[idx], EC_CMD_FPRD, idx, (uint16)(WIRE_STATION + slave - 1), 2, 2, &zero);
        ecx_outframe_red(&port, idx);
    }
    TEST_ASSERT_EQUAL_INT(1, ecx_waitinframe(&port, idx, 1000));
    expect_slave(idx, 2);
    TEST_ASSERT_EQUAL_UINT64(1, port.counters.late);
}

static cm1e_tap_verdict_t double_answers(void *context, cm1e_tap_frame_t *frame)
{
    (void)context;
    if (frame->direction == CM1E_TAP_RECEIVED)
        frame->copies = 3;
    return CM1E_TAP_PASS;
}

static void test_doubled_answers_are_counted_and_do_no_harm(void)
{
    cm1e_nic_set_tap(nic, double_answers, NULL);
    for (int i = 0; i < 100; i++) {
        uint16_t value = 0;
        TEST_ASSERT_EQUAL_INT(1, ecx_FPRD(&port, WIRE_STATION + 1, 2, 2, &value, EC_TIMEOUTRET));
        TEST_ASSERT_EQUAL_HEX16(0x2322, value);
    }
    TEST_ASSERT_EQUAL_UINT64(2 * 99, port.counters.late + port.counters.duplicates);
}

/** A good answer to the frame of `idx`, as the segment gives it. */
static size_t good_answer(uint8 idx, uint8_t *frame)
{
    memcpy(frame, port.txbuf[idx], (size_t)port.txbuflength[idx]);
    frame[6] |= 2;
    frame[28] = 1;
    return (size_t)port.txbuflength[idx];
}

static uint8 send_unanswered(void)
{
    wire.mute = true;
    return send_read(1);
}

static void test_every_single_damaged_header_byte_is_noticed(void)
{
    static const struct { int from, to; } checked[] = {{12, 16}, {16, 18}, {22, 24}};
    const uint8 idx = send_unanswered();
    uint8_t good[CM1E_FRAME_MAX], bad[CM1E_FRAME_MAX];
    const size_t length = good_answer(idx, good);
    uint64_t expected = 0;
    for (size_t c = 0; c < sizeof checked / sizeof checked[0]; c++)
        for (int at = checked[c].from; at < checked[c].to; at++)
            for (int bit = 0; bit < 8; bit++) {
                if ((at == 23 && bit >= 3 && bit <= 6) || (at == 15 && bit == 3))
                    continue; /* reserved, and the circulating bit */
                memcpy(bad, good, length);
                bad[at] ^= (uint8_t)(1 << bit);
                TEST_ASSERT_TRUE(cm1e_nic_inject(nic, 0, bad, length, 0));
                TEST_ASSERT_EQUAL_INT_MESSAGE(EC_NOFRAME, ecx_waitinframe(&port, idx, 0), "taken although damaged");
                expected++;
            }
    TEST_ASSERT_EQUAL_UINT64(expected, port.counters.malformed + port.counters.late);
    TEST_ASSERT_TRUE(cm1e_nic_inject(nic, 0, good, length, 0));
    TEST_ASSERT_EQUAL_INT(1, ecx_waitinframe(&port, idx, 0));
}

static void test_truncated_answers_are_dropped_and_padded_ones_taken(void)
{
    const uint8 idx = send_unanswered();
    uint8_t frame[CM1E_FRAME_MAX] = {0};
    const size_t length = good_answer(idx, frame);
    for (size_t n = 1; n < length; n++) {
        cm1e_nic_inject(nic, 0, frame, n, 0);
        TEST_ASSERT_EQUAL_INT(EC_NOFRAME, ecx_waitinframe(&port, idx, 0));
    }
    TEST_ASSERT_EQUAL_UINT64(length - 1, port.counters.malformed);
    cm1e_nic_inject(nic, 0, frame, 60, 0);
    TEST_ASSERT_EQUAL_INT(1, ecx_waitinframe(&port, idx, 0));
}

/** A datagram without data makes the shortest frame that there is. */
static void test_the_shortest_frame_is_known_as_ours(void)
{
    const uint8 idx = ecx_getindex(&port);
    uint8_t frame[CM1E_FRAME_MAX] = {0};
    wire.mute = true;
    ecx_setupdatagram(&port, &port.txbuf[idx], EC_CMD_NOP, idx, 0, 0, 0, NULL);
    TEST_ASSERT_GREATER_THAN_INT(0, ecx_outframe_red(&port, idx));
    const size_t length = good_answer(idx, frame);
    TEST_ASSERT_EQUAL_size_t(28, length);
    cm1e_nic_inject(nic, 0, frame, length, 0);
    TEST_ASSERT_GREATER_THAN_INT(EC_NOFRAME, ecx_waitinframe(&port, idx, 0));
    cm1e_nic_inject(nic, 0, frame, length, 0);
    TEST_ASSERT_EQUAL_INT(EC_NOFRAME, ecx_waitinframe(&port, send_unanswered(), 0));
    TEST_ASSERT_EQUAL_UINT64(1, port.counters.duplicates + port.counters.late);
    TEST_ASSERT_EQUAL_UINT64(0, port.counters.malformed);
}

static void test_a_foreign_source_address_is_taken_without_a_ring(void)
{
    const uint8 idx = send_unanswered();
    uint8_t frame[CM1E_FRAME_MAX] = {0};
    const size_t length = good_answer(idx, frame);
    memcpy(frame + 6, "\x02\x11\x22\x33\x44\x55", 6);
    cm1e_nic_inject(nic, 0, frame, length, 0);
    TEST_ASSERT_EQUAL_INT(1, ecx_waitinframe(&port, idx, 0));
}

static void expect_foreign(const uint8_t *frame, size_t length, uint64_t foreign, uint64_t others)
{
    const cm1e_port_counters_t *c = &port.counters;
    TEST_ASSERT_TRUE(cm1e_nic_inject(nic, 0, frame, length, 0));
    const uint8 idx = send_unanswered();
    TEST_ASSERT_EQUAL_INT(EC_NOFRAME, ecx_waitinframe(&port, idx, 0));
    ecx_setbufstat(&port, idx, EC_BUF_EMPTY);
    TEST_ASSERT_EQUAL_UINT64(foreign, c->foreign);
    TEST_ASSERT_EQUAL_UINT64(others, c->late + c->duplicates + c->malformed);
}

static void test_frames_of_another_master_are_counted_apart(void)
{
    nic->link.identity = 0x7A5C; /* as of a packet socket */
    uint8_t frame[CM1E_FRAME_MAX] = {0};
    const uint8 idx = send_unanswered();
    const size_t length = good_answer(idx, frame);
    ecx_setbufstat(&port, idx, EC_BUF_EMPTY);
    expect_foreign(frame, length, 0, 1); /* our own, too late */
    frame[7] = frame[10] = 0x01;
    expect_foreign(frame, length, 1, 1); /* SOEM's */
    frame[10] = 0x5D;
    expect_foreign(frame, length, 2, 1); /* another program's with this library */
    memcpy(frame + 6, "\x00\x1b\x21\x3c\x9d\xf8", 6);
    expect_foreign(frame, length, 3, 1); /* one that uses the address of the network card */
    frame[14] ^= 1;
    expect_foreign(frame, length, 3, 2); /* damaged: nobody's */
    frame[14] ^= 1;
    frame[12] = 0x08;
    expect_foreign(frame, length, 3, 3); /* not EtherCAT */
}

static void test_an_answer_of_another_soem_is_never_taken_for_ours(void)
{
    nic->link.identity = 0x7A5C;
    uint8_t frame[CM1E_FRAME_MAX] = {0};
    const uint8 idx = send_unanswered();
    const size_t length = good_answer(idx, frame);
    memset(frame + 6, 0x01, 6);
    cm1e_nic_inject(nic, 0, frame, length, 0);
    TEST_ASSERT_EQUAL_INT(EC_NOFRAME, ecx_waitinframe(&port, idx, 0));
    TEST_ASSERT_EQUAL_UINT64(1, port.counters.foreign);
}

static void test_nothing_is_written_beyond_what_was_sent(void)
{
    const uint8 idx = send_unanswered();
    uint8_t frame[CM1E_FRAME_MAX];
    memset(frame, 0x77, sizeof frame);
    good_answer(idx, frame);
    memset(port.rxbuf[idx], 0xEE, sizeof port.rxbuf[idx]);
    cm1e_nic_inject(nic, 0, frame, sizeof frame, 0);
    TEST_ASSERT_EQUAL_INT(1, ecx_waitinframe(&port, idx, 0));
    const int body = port.txbuflength[idx] - 14;
    TEST_ASSERT_EQUAL_HEX8(0, port.rxbuf[idx][body - 1]);
    TEST_ASSERT_EACH_EQUAL_HEX8(0xEE, port.rxbuf[idx] + body, EC_BUFSIZE - body);
}

static void test_random_frames_neither_crash_nor_answer(void)
{
    const unsigned seed = (unsigned)time(NULL);
    printf("seed %u\n", seed);
    srand(seed);
    const uint8 idx = send_unanswered();
    uint8_t good[CM1E_FRAME_MAX], frame[CM1E_FRAME_MAX];
    const size_t length = good_answer(idx, good);
    for (int i = 0; i < 200000; i++) {
        const size_t n = 1 + (size_t)(rand() % (i % 2 ? CM1E_FRAME_MAX : 80));
        for (size_t b = 0; b < n; b++)
            frame[b] = (uint8_t)rand();
        /* Half of them look like ours up to a random place before the length of the first datagram ends. */
        if (i % 2 == 0)
            memcpy(frame, good, (size_t)(rand() % 23) < n ? (size_t)(rand() % 23) : n);
        cm1e_nic_inject(nic, 0, frame, n, 0);
        const int wkc = ecx_waitinframe(&port, idx, 0);
        if (wkc != EC_NOFRAME) {
            /* Only a frame with our whole structure may have come so far. */
            TEST_ASSERT_EQUAL_MEMORY(good + 12, frame + 12, 6);
            port.slots[idx].state = EC_BUF_TX;
            port.slots[idx].answers = 0;
        }
    }
    cm1e_nic_inject(nic, 0, good, length, 0);
    TEST_ASSERT_EQUAL_INT(1, ecx_waitinframe(&port, idx, 0));
}

static void test_a_flood_does_not_hold_the_caller_beyond_its_deadline(void)
{
    const uint8 idx = send_unanswered();
    const uint8_t junk[64] = {0};
    for (int i = 0; i < FRAME_QUEUE_PLACES; i++)
        cm1e_nic_inject(nic, 0, junk, sizeof junk, 0);
    const int64_t before = now();
    TEST_ASSERT_EQUAL_INT(EC_NOFRAME, ecx_waitinframe(&port, idx, 50));
    TEST_ASSERT_EQUAL_INT64(before + 50000, now());
}

/* ---- time -------------------------------------------------------------------------------------------------------- */

static void test_a_lost_frame_costs_the_timeout_and_nothing_more(void)
{
    static const int timeouts[] = {0, 1, 50, 62, 250, 1999, 2000, 2001, 5000, 20000};
    for (size_t i = 0; i < sizeof timeouts / sizeof timeouts[0]; i++) {
        const uint8 idx = send_unanswered();
        int64_t before = now();
        TEST_ASSERT_EQUAL_INT(EC_NOFRAME, ecx_waitinframe(&port, idx, timeouts[i]));
        TEST_ASSERT_EQUAL_INT64(before + timeouts[i] * 1000, now());
        before = now();
        const int sent = wire.sent[0];
        TEST_ASSERT_EQUAL_INT(EC_NOFRAME, ecx_srconfirm(&port, idx, timeouts[i]));
        TEST_ASSERT_EQUAL_INT64(before + timeouts[i] * 1000, now());
        const int tries = timeouts[i] <= EC_TIMEOUTRET ? 1 : (timeouts[i] + EC_TIMEOUTRET - 1) / EC_TIMEOUTRET;
        TEST_ASSERT_EQUAL_INT(tries, wire.sent[0] - sent);
        ecx_setbufstat(&port, idx, EC_BUF_EMPTY);
    }
}

static cm1e_tap_verdict_t delay_first(void *context, cm1e_tap_frame_t *frame)
{
    const int64_t *delay = context;
    if (frame->direction == CM1E_TAP_RECEIVED && frame->number == 0)
        frame->delay_ns = *delay;
    return CM1E_TAP_PASS;
}

static void test_an_answer_to_the_first_try_serves_the_second(void)
{
    int64_t delay = 2000000 - RTT_NS + 5000; /* 5 us into the second try */
    cm1e_nic_set_tap(nic, delay_first, &delay);
    const uint8 idx = ecx_getindex(&port);
    uint16_t zero = 0;
    ecx_setupdatagram(&port, &port.txbuf[idx], EC_CMD_FPRD, idx, WIRE_STATION, 2, 2, &zero);
    TEST_ASSERT_EQUAL_INT(1, ecx_srconfirm(&port, idx, 10000));
    TEST_ASSERT_EQUAL_INT64(1000000 + 2000000 + 5000, now());
    expect_slave(idx, 1);
}

static void test_timeout_zero_takes_what_is_here(void)
{
    const uint8 idx = send_read(3);
    TEST_ASSERT_EQUAL_INT(EC_NOFRAME, ecx_waitinframe(&port, idx, 0));
    TEST_ASSERT_EQUAL_INT64(1000000, now());
    cm1e_clock_sleep_until(cm1e_nic_clock(nic), now() + RTT_NS);
    TEST_ASSERT_EQUAL_INT(1, ecx_inframe(&port, idx, 0));
    TEST_ASSERT_EQUAL_INT(EC_NOFRAME, ecx_inframe(&port, idx, 0));
}

static void test_osal_time_is_the_threads_clock(void)
{
    cm1e_clock_make_current(cm1e_nic_clock(nic));
    osal_timert timer;
    const ec_timet start = osal_current_time();
    osal_timer_start(&timer, 1500000);
    TEST_ASSERT_FALSE(osal_timer_is_expired(&timer));
    osal_usleep(1499999);
    TEST_ASSERT_FALSE(osal_timer_is_expired(&timer));
    osal_usleep(1);
    TEST_ASSERT_TRUE(osal_timer_is_expired(&timer));
    ec_timet end = osal_current_time(), from = start, diff;
    osal_time_diff(&from, &end, &diff);
    TEST_ASSERT_EQUAL_UINT32(1, diff.sec);
    TEST_ASSERT_EQUAL_UINT32(500000, diff.usec);
    cm1e_clock_make_current(NULL);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_headers_are_prepared_in_all_buffers);
    RUN_TEST(test_soem_primitives_read_and_write_slaves);
    RUN_TEST(test_working_counter_is_that_of_the_last_datagram);
    RUN_TEST(test_answers_are_found_in_any_order_of_asking);
    RUN_TEST(test_a_failed_send_is_reported_and_waited_for_no_longer_than_asked);
    RUN_TEST(test_lengths_and_indices_out_of_range_are_refused);
    RUN_TEST(test_without_a_nic_nothing_works_and_nothing_crashes);
    RUN_TEST(test_indices_are_given_once_each_until_released);
    RUN_TEST(test_with_all_indices_in_use_the_least_missed_is_taken_and_counted);
    RUN_TEST(test_an_answer_to_a_released_index_is_dropped_and_counted);
    RUN_TEST(test_a_late_answer_is_not_taken_for_the_next_use_of_its_index);
    RUN_TEST(test_doubled_answers_are_counted_and_do_no_harm);
    RUN_TEST(test_every_single_damaged_header_byte_is_noticed);
    RUN_TEST(test_truncated_answers_are_dropped_and_padded_ones_taken);
    RUN_TEST(test_the_shortest_frame_is_known_as_ours);
    RUN_TEST(test_a_foreign_source_address_is_taken_without_a_ring);
    RUN_TEST(test_frames_of_another_master_are_counted_apart);
    RUN_TEST(test_an_answer_of_another_soem_is_never_taken_for_ours);
    RUN_TEST(test_nothing_is_written_beyond_what_was_sent);
    RUN_TEST(test_random_frames_neither_crash_nor_answer);
    RUN_TEST(test_a_flood_does_not_hold_the_caller_beyond_its_deadline);
    RUN_TEST(test_a_lost_frame_costs_the_timeout_and_nothing_more);
    RUN_TEST(test_an_answer_to_the_first_try_serves_the_second);
    RUN_TEST(test_timeout_zero_takes_what_is_here);
    RUN_TEST(test_osal_time_is_the_threads_clock);
    return UNITY_END();
}
