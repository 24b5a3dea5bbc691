/* A datagram that rides in SOEM's process data: SOEM gets what it would get without it, in a line and in every state of a
 * ring; it comes back or is lost with its frame. */
#include <ethercat.h>
#include <unity.h>

#include "../support/fake_wire.h"
#include "nic/rider.h"

enum { N = WIRE_SLAVES, READ_BYTES = 6, BYTES = 10 + READ_BYTES + 2, FRAME_END = 1514, FULL = FRAME_END - 28 };

static ecx_portt port;
static ecx_redportt red;
static ecx_contextt context;
static cm1e_nic_t *nic;
static uint8_t image[EC_BUFSIZE];

static void start(bool ring)
{
    memset(&port, 0, sizeof port);
    nic = port.nic = wire_start(ring);
    context.port = &port;
    if (ring)
        TEST_ASSERT_EQUAL_INT(1, ecx_init_redundant(&context, &red, "wire", (char[]){"second"}));
    else
        TEST_ASSERT_EQUAL_INT(1, ecx_setupnic(&port, "wire", FALSE));
}

void setUp(void) { start(false); }

void tearDown(void)
{
    ecx_closenic(&port);
    cm1e_nic_close(nic);
}

/** A read of six bytes of one slave waits for a frame. */
static void offer_seat(int seat, int slave)
{
    const uint8_t datagram[BYTES] = {EC_CMD_FPRD, 0xEE, (uint8_t)(WIRE_STATION + slave - 1), WIRE_STATION >> 8, 2, 0,
                                     READ_BYTES};
    memcpy(port.riders[seat].datagram, datagram, BYTES);
    port.riders[seat].bytes = BYTES;
    port.riders[seat].state = RIDER_WAITS;
}

static void offer(int slave) { offer_seat(0, slave); }

static void expect_answer_of(int seat, int slave)
{
    TEST_ASSERT_EQUAL_UINT8(RIDER_BACK, port.riders[seat].state);
    for (int i = 0; i < READ_BYTES; i++)
        TEST_ASSERT_EQUAL_HEX8(slave * 16 + 2 + i, port.riders[seat].datagram[10 + i]);
    TEST_ASSERT_EQUAL_UINT8(1, port.riders[seat].datagram[10 + READ_BYTES]);
}

static void expect_answer(int slave) { expect_answer_of(0, slave); }

/** Process data of so many bytes, with the time of slave 1 behind them if `time`, as SOEM sends them. */
static uint8 send_image(uint16_t bytes, bool time)
{
    int64 zero = 0;
    const uint8 idx = ecx_getindex(&port);
    for (int i = 0; i < N; i++) {
        image[i] = (uint8_t)(0x51 + i);
        wire.slave[i + 1].input = (uint8_t)(0x91 + i);
    }
    ecx_setupdatagram(&port, &port.txbuf[idx], EC_CMD_LRW, idx, 0, 0, bytes, image);
    if (time)
        ecx_adddatagram(&port, &port.txbuf[idx], EC_CMD_FRMW, idx, FALSE, WIRE_STATION, 16, 8, &zero);
    TEST_ASSERT_GREATER_THAN_INT(0, ecx_outframe_red(&port, idx));
    return idx;
}

static void expect_image(uint8 idx)
{
    for (int i = 0; i < N; i++) {
        TEST_ASSERT_EQUAL_HEX8(0x51 + i, wire.slave[i + 1].output);
        TEST_ASSERT_EQUAL_HEX8(0x91 + i, port.rxbuf[idx][EC_HEADERSIZE + N + i]);
    }
    ecx_setbufstat(&port, idx, EC_BUF_EMPTY);
}

static void test_soem_gets_what_it_gets_without_a_rider(void)
{
    for (int slave = 1; slave <= N; slave++)
        for (int time = 0; time < 2; time++) {
            offer(slave);
            const int before = wire.sent[0];
            const uint8 idx = send_image(2 * N, time);
            TEST_ASSERT_EQUAL_UINT8(RIDER_ABOARD, port.riders[0].state);
            TEST_ASSERT_EQUAL_INT(time ? N : 3 * N, ecx_waitinframe(&port, idx, 250));
            TEST_ASSERT_EQUAL_INT(before + 1, wire.sent[0]);
            expect_answer(slave);
            expect_image(idx);
            TEST_ASSERT_EQUAL_UINT8(RIDER_BACK, port.riders[0].state); /* a released frame does not take it away */
        }
    TEST_ASSERT_EQUAL_UINT64(0, port.counters.malformed);
}

static void test_a_rider_waits_for_a_frame_that_can_be_sent(void)
{
    const uint8 idx = ecx_getindex(&port);
    ecx_setupdatagram(&port, &port.txbuf[idx], EC_CMD_LRW, idx, 0, 0, 2 * N, image);
    offer(1);
    port.nic = NULL;
    TEST_ASSERT_EQUAL_INT(-1, ecx_outframe_red(&port, idx));
    TEST_ASSERT_EQUAL_UINT8(RIDER_WAITS, port.riders[0].state);
    port.nic = nic;
    ecx_setbufstat(&port, idx, EC_BUF_EMPTY);
    expect_image((uint8)(ecx_waitinframe(&port, send_image(2 * N, false), 250) ? port.riders[0].index : EC_MAXBUF));
    expect_answer(1);
}

static void test_a_slave_that_does_not_answer_counts_nothing(void)
{
    offer(N + 7);
    const uint8 idx = send_image(2 * N, false);
    TEST_ASSERT_EQUAL_INT(3 * N, ecx_waitinframe(&port, idx, 250));
    TEST_ASSERT_EQUAL_UINT8(RIDER_BACK, port.riders[0].state);
    TEST_ASSERT_EQUAL_UINT8(0, port.riders[0].datagram[10 + READ_BYTES]);
    expect_image(idx);
}

static void test_it_takes_the_first_frame_of_process_data_with_room(void)
{
    uint16_t value = 0;
    offer(2);
    TEST_ASSERT_EQUAL_INT(1, ecx_FPRD(&port, WIRE_STATION, 4, 2, &value, EC_TIMEOUTRET));
    TEST_ASSERT_EQUAL_UINT8(RIDER_WAITS, port.riders[0].state);
    const uint8 full = send_image(FULL - BYTES + 1, false);
    TEST_ASSERT_EQUAL_UINT8(RIDER_WAITS, port.riders[0].state);
    const uint8 next = send_image(FULL - BYTES, false), last = send_image(2 * N, false);
    TEST_ASSERT_EQUAL_INT(FRAME_END, port.txbuflength[next]);
    TEST_ASSERT_EQUAL_INT(28 + 2 * N, port.txbuflength[last]);
    TEST_ASSERT_EQUAL_INT(3 * N, ecx_waitinframe(&port, full, 500));
    TEST_ASSERT_EQUAL_UINT8(RIDER_ABOARD, port.riders[0].state);
    TEST_ASSERT_EQUAL_INT(3 * N, ecx_waitinframe(&port, last, 500));
    TEST_ASSERT_EQUAL_INT(3 * N, ecx_waitinframe(&port, next, 500));
    expect_answer(2);
    expect_image(full);
    expect_image(next);
    expect_image(last);
}

static void test_two_ride_in_one_frame(void)
{
    for (int time = 0; time < 2; time++) {
        offer_seat(0, 2);
        offer_seat(1, 3);
        const int before = wire.sent[0];
        const uint8 idx = send_image(2 * N, time);
        TEST_ASSERT_EQUAL_INT(time ? N : 3 * N, ecx_waitinframe(&port, idx, 250));
        TEST_ASSERT_EQUAL_INT(before + 1, wire.sent[0]);
        expect_answer_of(0, 2);
        expect_answer_of(1, 3);
        expect_image(idx);
    }
    TEST_ASSERT_EQUAL_UINT64(0, port.counters.malformed);
}

static void test_the_second_waits_where_only_one_has_room(void)
{
    offer_seat(0, 2);
    offer_seat(1, 3);
    const uint8 full = send_image(FULL - 2 * BYTES + 1, false);
    TEST_ASSERT_EQUAL_UINT8(RIDER_ABOARD, port.riders[0].state);
    TEST_ASSERT_EQUAL_UINT8(RIDER_WAITS, port.riders[1].state);
    const uint8 next = send_image(2 * N, false);
    TEST_ASSERT_EQUAL_UINT8(RIDER_ABOARD, port.riders[1].state);
    TEST_ASSERT_EQUAL_INT(3 * N, ecx_waitinframe(&port, next, 500));
    TEST_ASSERT_EQUAL_UINT8(RIDER_ABOARD, port.riders[0].state); /* the frames come back in any order */
    expect_answer_of(1, 3);
    TEST_ASSERT_EQUAL_INT(3 * N, ecx_waitinframe(&port, full, 500));
    expect_answer_of(0, 2);
    expect_image(full);
    expect_image(next);
}

static void test_it_is_lost_with_its_frame(void)
{
    wire.mute = true;
    offer(3);
    const uint8 idx = send_image(2 * N, false);
    TEST_ASSERT_EQUAL_INT(EC_NOFRAME, ecx_waitinframe(&port, idx, 250));
    TEST_ASSERT_EQUAL_UINT8(RIDER_ABOARD, port.riders[0].state);
    ecx_setbufstat(&port, idx, EC_BUF_EMPTY);
    TEST_ASSERT_EQUAL_UINT8(RIDER_LOST, port.riders[0].state);
    wire.mute = false;
    TEST_ASSERT_EQUAL_INT(3 * N, ecx_LRW(&port, 0, 2 * N, image, 250)); /* the next frame has nothing of it */
    TEST_ASSERT_EQUAL_UINT8(RIDER_LOST, port.riders[0].state);
}

static void test_an_index_that_is_taken_away_loses_it(void)
{
    offer(3);
    send_image(2 * N, false);
    for (int i = 0; i < EC_MAXBUF; i++)
        ecx_getindex(&port);
    TEST_ASSERT_EQUAL_UINT8(RIDER_LOST, port.riders[0].state);
}

/** Its owner may forget it: the frame still is SOEM's. */
static void test_a_frame_with_a_forgotten_rider_is_soems(void)
{
    offer(3);
    const uint8 idx = send_image(2 * N, false);
    port.riders[0].state = RIDER_NONE;
    TEST_ASSERT_EQUAL_INT(3 * N, ecx_waitinframe(&port, idx, 250));
    TEST_ASSERT_EQUAL_UINT8(RIDER_NONE, port.riders[0].state);
    expect_image(idx);
}

static void test_a_ring_in_any_state_brings_both(void)
{
    tearDown();
    start(true);
    for (int place = 0; place <= N + 1; place++) {
        for (int i = 1; i <= N + 1; i++)
            wire.cut[i] = i == place;
        for (int round = 0; round < 6; round++) {
            const int slave = 1 + round % N;
            offer(slave);
            offer_seat(1, N + 1 - slave);
            const uint8 idx = send_image(2 * N, round % 2);
            TEST_ASSERT_EQUAL_UINT8(RIDER_ABOARD, port.riders[0].state);
            const int counted = ecx_waitinframe(&port, idx, 3000);
            if (round < 2) { /* the change is learned */
                ecx_setbufstat(&port, idx, EC_BUF_EMPTY);
                continue;
            }
            TEST_ASSERT_EQUAL_INT(round % 2 ? N : 3 * N, counted);
            expect_answer(slave);
            expect_answer_of(1, N + 1 - slave);
            expect_image(idx);
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_soem_gets_what_it_gets_without_a_rider);
    RUN_TEST(test_a_rider_waits_for_a_frame_that_can_be_sent);
    RUN_TEST(test_a_slave_that_does_not_answer_counts_nothing);
    RUN_TEST(test_it_takes_the_first_frame_of_process_data_with_room);
    RUN_TEST(test_two_ride_in_one_frame);
    RUN_TEST(test_the_second_waits_where_only_one_has_room);
    RUN_TEST(test_it_is_lost_with_its_frame);
    RUN_TEST(test_an_index_that_is_taken_away_loses_it);
    RUN_TEST(test_a_frame_with_a_forgotten_rider_is_soems);
    RUN_TEST(test_a_ring_in_any_state_brings_both);
    return UNITY_END();
}
