/* Cable redundancy on a ring of very simple slaves: data, working counter and cost in virtual time for every place
 * where the ring may be broken, for every kind of frame, and for changes from any such state to any other. */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include <ethercat.h>
#include <unity.h>

#include "../support/fake_wire.h"
#include "nic/ring.h"

enum { N = WIRE_SLAVES, INTACT = 0, FIRST_DEAD = 1, SECOND_DEAD = N + 1, PLACES = N + 2 };

static ecx_portt port;
static ecx_redportt red;
static ecx_contextt context;
static cm1e_nic_t *nic;

void setUp(void)
{
    memset(&port, 0, sizeof port);
    nic = port.nic = wire_start(true);
    context.port = &port;
    TEST_ASSERT_EQUAL_INT(1, ecx_init_redundant(&context, &red, "wire", (char[]){"second"}));
    TEST_ASSERT_TRUE(port.redundant);
}

void tearDown(void)
{
    ecx_closenic(&port);
    cm1e_nic_close(nic);
}

static int64_t now(void) { return cm1e_clock_now(cm1e_nic_clock(nic)); }

/** Breaks the ring at one place: cable 1 is the first interface's, N + 1 the second's, 0: nowhere. */
static void break_at(int place)
{
    for (int i = 1; i <= N + 1; i++)
        wire.cut[i] = i == place;
}

/** Time of a trip through so many slaves and back. */
static int64_t trip(int slaves) { return WIRE_BASE_NS + slaves * WIRE_SLAVE_NS; }

/** One trip of what the slaves do in a ring broken at `place`: the longer half. */
static int64_t one_trip(int place)
{
    if (place <= FIRST_DEAD || place == SECOND_DEAD)
        return trip(N);
    const int first = place - 1, second = N - first;
    return trip(first > second ? first : second);
}

/* ---- the frames that are exchanged ------------------------------------------------------------------------------- */

static uint8_t round_number;

static int cyclic(void)
{
    uint8_t image[2 * N + 3], sent[2 * N + 3]; /* three bytes are nobody's */
    round_number++;
    for (size_t i = N; i < sizeof image; i++)
        image[i] = (uint8_t)rand();
    for (int i = 0; i < N; i++) {
        image[i] = (uint8_t)(round_number * 3 + i);
        wire.slave[i + 1].input = (uint8_t)rand();
    }
    memcpy(sent, image, sizeof image);
    const int wkc = ecx_LRW(&port, 0, sizeof image, image, 250);
    if (wkc > 0)
        TEST_ASSERT_EQUAL_MEMORY(sent + 2 * N, image + 2 * N, 3);
    if (wkc == 3 * N)
        for (int i = 0; i < N; i++) {
            TEST_ASSERT_EQUAL_HEX8(wire.slave[i + 1].input, image[N + i]);
            TEST_ASSERT_EQUAL_HEX8(sent[i], wire.slave[i + 1].output);
            TEST_ASSERT_EQUAL_HEX8(sent[i], image[i]);
        }
    return wkc;
}

static int broadcast(void)
{
    uint8_t data[2] = {0};
    const int wkc = ecx_BRD(&port, 0, 0, 2, data, EC_TIMEOUTRET);
    if (wkc == N)
        TEST_ASSERT_EQUAL_HEX8(0x10 | 0x20 | 0x30 | 0x40, data[0]);
    return wkc == N ? N : -wkc;
}

static int read_each(void)
{
    int wkc = 0;
    for (int i = 1; i <= N; i++) {
        uint8_t data[4] = {0};
        wkc += ecx_FPRD(&port, (uint16)(WIRE_STATION + i - 1), 4, 4, data, EC_TIMEOUTRET) == 1;
        TEST_ASSERT_EQUAL_HEX8(i * 16 + 4, data[0]);
        TEST_ASSERT_EQUAL_HEX8(i * 16 + 7, data[3]);
    }
    return wkc;
}

static int write_each_by_position(void)
{
    int wkc = 0;
    for (int i = 1; i <= N; i++)
        wire.slave[i].writes = 0;
    for (int i = 1; i <= N; i++) {
        uint8_t data[2] = {(uint8_t)(0x80 + i), ++round_number};
        wkc += ecx_APWR(&port, (uint16)(1 - i), 20, 2, data, EC_TIMEOUTRET) == 1;
        TEST_ASSERT_EQUAL_HEX8(data[0], wire.slave[i].registers[20]);
        TEST_ASSERT_EQUAL_HEX8(data[1], wire.slave[i].registers[21]);
    }
    for (int i = 1; i <= N; i++)
        TEST_ASSERT_EQUAL_INT_MESSAGE(1, wire.slave[i].writes, "written by a frame for another position");
    return wkc;
}

/** FRMW: what slave 1 has must arrive in the others, never what the frame held when it left. */
static int distribute_time(void)
{
    uint8_t data[8] = {0xDE, 0xAD, 0xDE, 0xAD, 0xDE, 0xAD, 0xDE, 0xAD};
    round_number++;
    for (int i = 0; i < 8; i++)
        wire.slave[1].registers[24 + i] = (uint8_t)(round_number + i);
    const int wkc = ecx_FRMW(&port, WIRE_STATION, 24, 8, data, EC_TIMEOUTRET);
    for (int i = 2; i <= N; i++)
        TEST_ASSERT_EQUAL_MEMORY(wire.slave[1].registers + 24, wire.slave[i].registers + 24, 8);
    TEST_ASSERT_EQUAL_MEMORY(wire.slave[1].registers + 24, data, 8);
    return wkc;
}

static const struct {
    const char *name;
    int (*exchange)(void);
    int wkc, frames;
    bool any_order;
} exchanges[] = {
    {"LRW", cyclic, 3 * N, 1, true},
    {"BRD", broadcast, N, 1, true},
    {"FPRD", read_each, N, N, true},
    {"APWR", write_each_by_position, N, N, false},
    {"FRMW", distribute_time, N, 1, false},
};
enum { EXCHANGES = sizeof exchanges / sizeof exchanges[0] };

/* ---- cases ------------------------------------------------------------------------------------------------------- */

static void test_every_exchange_is_right_and_cheap_in_every_state_of_the_ring(void)
{
    char message[100];
    for (int place = 0; place < PLACES; place++)
        for (int e = 0; e < EXCHANGES; e++) {
            tearDown();
            setUp();
            TEST_ASSERT_EQUAL_INT(N, broadcast());
            break_at(place);
            const int64_t before_first = now();
            snprintf(message, sizeof message, "%s, broken at %d, first", exchanges[e].name, place);
            TEST_ASSERT_EQUAL_INT_MESSAGE(exchanges[e].wkc, exchanges[e].exchange(), message);
            /* Once: the wait for the other half, and a second trip. */
            TEST_ASSERT_LESS_OR_EQUAL_INT64_MESSAGE(
                RING_HALF_WAIT_NS + 2 * (exchanges[e].frames + 1) * trip(N), now() - before_first, message);
            for (int i = 0; i < 20; i++) {
                snprintf(message, sizeof message, "%s, broken at %d, repetition %d", exchanges[e].name, place, i);
                const int64_t before = now();
                TEST_ASSERT_EQUAL_INT_MESSAGE(exchanges[e].wkc, exchanges[e].exchange(), message);
                const int64_t cost = (now() - before) / exchanges[e].frames;
                if (exchanges[e].any_order || place == INTACT || place == SECOND_DEAD)
                    TEST_ASSERT_EQUAL_INT64_MESSAGE(one_trip(place), cost, message);
                else
                    TEST_ASSERT_LESS_OR_EQUAL_INT64_MESSAGE(2 * trip(N), cost, message);
            }
        }
}

static void test_any_change_of_the_ring_is_learned_within_two_cycles(void)
{
    char message[100];
    for (int from = 0; from < PLACES; from++)
        for (int to = 0; to < PLACES; to++) {
            tearDown();
            setUp();
            TEST_ASSERT_EQUAL_INT(N, broadcast());
            break_at(from);
            for (int i = 0; i < 5; i++)
                cyclic();
            snprintf(message, sizeof message, "broken at %d, then at %d", from, to);
            TEST_ASSERT_EQUAL_INT_MESSAGE(3 * N, cyclic(), message);
            break_at(to);
            int bad = 0;
            for (int i = 0; i < 8; i++) {
                const int64_t before = now();
                if (cyclic() != 3 * N)
                    bad = i + 1;
                TEST_ASSERT_LESS_OR_EQUAL_INT64_MESSAGE(250000, now() - before, message);
            }
            TEST_ASSERT_LESS_OR_EQUAL_INT_MESSAGE(2, bad, message);
            const int64_t before = now();
            TEST_ASSERT_EQUAL_INT_MESSAGE(3 * N, cyclic(), message);
            TEST_ASSERT_EQUAL_INT64_MESSAGE(one_trip(to), now() - before, message);
            for (int e = 0; e < EXCHANGES; e++)
                TEST_ASSERT_EQUAL_INT_MESSAGE(exchanges[e].wkc, exchanges[e].exchange(), message);
        }
}

/** As the scheduler does it: send now, take in a cycle later with a short timeout. */
static void test_in_the_cycle_a_break_costs_no_waiting_once_it_is_known(void)
{
    for (int place = 0; place < PLACES; place++) {
        tearDown();
        setUp();
        TEST_ASSERT_EQUAL_INT(N, broadcast());
        int bad = 0;
        for (int cycle = 0; cycle < 50; cycle++) {
            if (cycle == 10)
                break_at(place);
            uint8_t image[2 * N] = {0};
            const uint8 idx = ecx_getindex(&port);
            ecx_setupdatagram(&port, &port.txbuf[idx], EC_CMD_LRW, idx, 0, 0, sizeof image, image);
            ecx_outframe_red(&port, idx);
            cm1e_clock_sleep_until(cm1e_nic_clock(nic), (now() / 250000 + 1) * 250000);
            const int64_t before = now();
            if (ecx_waitinframe(&port, idx, 62) != 3 * N)
                bad++;
            if (cycle < 10 || cycle > 12)
                TEST_ASSERT_EQUAL_INT64(before, now());
            ecx_setbufstat(&port, idx, EC_BUF_EMPTY);
        }
        TEST_ASSERT_LESS_OR_EQUAL_INT(1, bad);
        TEST_ASSERT_EQUAL_UINT64(0, port.counters.late + port.counters.malformed + port.counters.index_reused);
    }
}

static void test_polling_with_timeout_zero_also_gets_the_whole_answer(void)
{
    for (int place = 0; place < PLACES; place++) {
        tearDown();
        setUp();
        TEST_ASSERT_EQUAL_INT(N, broadcast());
        break_at(place);
        for (int cycle = 0; cycle < 10; cycle++) {
            uint8_t image[2 * N] = {0};
            const uint8 idx = ecx_getindex(&port);
            ecx_setupdatagram(&port, &port.txbuf[idx], EC_CMD_LRW, idx, 0, 0, sizeof image, image);
            ecx_outframe_red(&port, idx);
            int wkc = EC_NOFRAME;
            for (int us = 0; us < 1000 && wkc == EC_NOFRAME; us++) {
                cm1e_clock_sleep_until(cm1e_nic_clock(nic), now() + 1000);
                const int64_t before = now();
                wkc = ecx_waitinframe(&port, idx, 0);
                TEST_ASSERT_EQUAL_INT64(before, now());
            }
            TEST_ASSERT_EQUAL_INT(3 * N, wkc);
            ecx_setbufstat(&port, idx, EC_BUF_EMPTY);
        }
    }
}

static void test_two_breaks_give_the_reachable_slaves_and_a_short_working_counter(void)
{
    for (int a = 1; a <= N + 1; a++)
        for (int b = a + 1; b <= N + 1; b++) {
            tearDown();
            setUp();
            TEST_ASSERT_EQUAL_INT(N, broadcast());
            wire.cut[a] = wire.cut[b] = true;
            const int reachable = (a - 1) + (N + 1 - b);
            int wkc = 0;
            for (int i = 0; i < 6; i++) {
                const int64_t before = now();
                wkc = cyclic();
                TEST_ASSERT_LESS_OR_EQUAL_INT64(250000, now() - before);
            }
            TEST_ASSERT_EQUAL_INT(reachable > 0 ? 3 * reachable : EC_NOFRAME, wkc);
            /* No frame by position may reach a slave that is not meant, also after a broadcast counted fewer slaves. */
            broadcast();
            for (int i = 1; i <= N; i++)
                wire.slave[i].writes = 0;
            uint8_t data[2] = {1, 2};
            for (int i = 1; i <= N; i++) {
                ecx_APWR(&port, (uint16)(1 - i), 20, 2, data, EC_TIMEOUTRET);
                for (int j = 1; j <= N; j++)
                    TEST_ASSERT_TRUE_MESSAGE(j == i || wire.slave[j].writes == 0, "wrong slave written");
                wire.slave[i].writes = 0;
            }
        }
}

/** The count of slaves behind the break is only as good as the frame that brought it: here slave 3 is where slave 2
 *  was, and its half answers last. */
static void test_a_second_break_between_two_frames_by_position_is_noticed(void)
{
    TEST_ASSERT_EQUAL_INT(N, broadcast());
    break_at(2);
    TEST_ASSERT_EQUAL_INT(N, write_each_by_position());
    wire.cut[3] = true;
    const int writes = wire.slave[3].writes;
    uint8_t data[2] = {1, 2};
    TEST_ASSERT_NOT_EQUAL(1, ecx_APWR(&port, (uint16)-1, 20, 2, data, EC_TIMEOUTRET));
    TEST_ASSERT_EQUAL_INT(writes, wire.slave[3].writes);
}

/** A copy of FRMW is right while all slaves are behind the second interface. When they are not any more, half of them
 *  got the time too early: the working counter must not say that all is well. */
static void test_an_ordered_frame_that_both_halves_processed_is_not_called_complete(void)
{
    TEST_ASSERT_EQUAL_INT(N, broadcast());
    break_at(FIRST_DEAD);
    for (int i = 0; i < 3; i++)
        TEST_ASSERT_EQUAL_INT(N, distribute_time());
    break_at(3);
    uint8_t data[8] = {0};
    TEST_ASSERT_NOT_EQUAL(N, ecx_FRMW(&port, WIRE_STATION, 24, 8, data, EC_TIMEOUTRET));
    TEST_ASSERT_EQUAL_INT(N, distribute_time());
}

static cm1e_tap_verdict_t delay_through(void *unused, cm1e_tap_frame_t *frame)
{
    (void)unused;
    if (frame->direction == CM1E_TAP_RECEIVED && frame->port == 0 && frame->bytes[8] == 4)
        frame->delay_ns = 300000; /* until after the break is learned */
    return CM1E_TAP_PASS;
}

static void test_frames_from_before_a_break_do_not_unteach_it(void)
{
    for (int place = FIRST_DEAD; place < PLACES; place++) {
        tearDown();
        setUp();
        cm1e_nic_set_tap(nic, delay_through, NULL);
        for (int i = 0; i < 5; i++)
            TEST_ASSERT_EQUAL_INT(3 * N, cyclic());
        break_at(place);
        TEST_ASSERT_EQUAL_INT(3 * N, cyclic());
        for (int i = 0; i < 10; i++) {
            const int64_t before = now();
            TEST_ASSERT_EQUAL_INT(3 * N, cyclic());
            TEST_ASSERT_EQUAL_INT64(one_trip(place), now() - before);
        }
    }
}

/** One look a cycle, shorter than the wait for the other half: what a release finds unfinished is learned from, too. */
static void test_one_look_a_cycle_without_waiting_is_enough_to_learn(void)
{
    for (int place = 0; place < PLACES; place++) {
        tearDown();
        setUp();
        TEST_ASSERT_EQUAL_INT(N, broadcast());
        break_at(place);
        int good = 0;
        for (int cycle = 0; cycle < 10; cycle++) {
            uint8_t image[2 * N] = {0};
            const uint8 idx = ecx_getindex(&port);
            ecx_setupdatagram(&port, &port.txbuf[idx], EC_CMD_LRW, idx, 0, 0, sizeof image, image);
            ecx_outframe_red(&port, idx);
            cm1e_clock_sleep_until(cm1e_nic_clock(nic), now() + 250000);
            good += ecx_waitinframe(&port, idx, 0) == 3 * N;
            ecx_setbufstat(&port, idx, EC_BUF_EMPTY);
        }
        TEST_ASSERT_GREATER_OR_EQUAL_INT(9, good);
    }
}

static unsigned loss_percent;

static cm1e_tap_verdict_t lose_some(void *unused, cm1e_tap_frame_t *frame)
{
    (void)unused;
    (void)frame;
    return (unsigned)(rand() % 100) < loss_percent ? CM1E_TAP_DROP : CM1E_TAP_PASS;
}

/** With frames lost at random and cables cut and mended at random: whatever answers with the full working counter has
 *  the right data (cyclic() checks it), no wait exceeds its timeout, and afterwards all is well. */
static void test_random_losses_and_breaks_never_give_wrong_data(void)
{
    const unsigned seed = (unsigned)time(NULL);
    printf("seed %u\n", seed);
    srand(seed);
    cm1e_nic_set_tap(nic, lose_some, NULL);
    TEST_ASSERT_EQUAL_INT(N, broadcast());
    int good = 0;
    for (int i = 0; i < 30000; i++) {
        if (i % 10 == 0)
            loss_percent = (unsigned)(rand() % 4) * 5;
        if (rand() % 20 == 0)
            break_at(rand() % PLACES);
        const int64_t before = now();
        good += cyclic() == 3 * N;
        TEST_ASSERT_LESS_OR_EQUAL_INT64(250000, now() - before);
    }
    TEST_ASSERT_GREATER_THAN_INT(20000, good);
    loss_percent = 0;
    for (int place = 0; place < PLACES; place++) {
        break_at(place);
        for (int i = 0; i < 5; i++)
            cyclic();
        for (int e = 0; e < EXCHANGES; e++)
            TEST_ASSERT_EQUAL_INT(exchanges[e].wkc, exchanges[e].exchange());
    }
}

static void test_one_lost_half_in_a_cut_ring_costs_one_cycle(void)
{
    break_at(3);
    TEST_ASSERT_EQUAL_INT(3 * N, cyclic());
    TEST_ASSERT_EQUAL_INT(3 * N, cyclic());
    for (int lost = 1; lost <= 2; lost++) {
        /* The cable that the half would take is out for one frame. */
        wire.cut[lost == 1 ? FIRST_DEAD : SECOND_DEAD] = true;
        TEST_ASSERT_EQUAL_INT(3 * N / 2, cyclic());
        break_at(3);
        const int64_t before = now();
        TEST_ASSERT_EQUAL_INT(3 * N, cyclic());
        TEST_ASSERT_EQUAL_INT64(one_trip(3), now() - before);
    }
}

/** 2^31 frames pass while the ring is broken: 25 days with one in a ms. Then it is mended, and that is learned at once. */
static void test_a_break_of_months_is_forgotten_when_the_ring_is_mended(void)
{
    char message[40];
    for (int place = FIRST_DEAD; place < PLACES; place++)
        for (int times = 1; times <= 3; times++) {
            snprintf(message, sizeof message, "broken at %d, %d times 2^31 frames", place, times);
            tearDown();
            setUp();
            TEST_ASSERT_EQUAL_INT(N, broadcast());
            break_at(place);
            for (int part = 0; part < 4 * times; part++) {
                for (int i = 0; i < 5; i++)
                    cyclic();
                port.transmissions += UINT32_C(1) << 29;
            }
            for (int i = 0; i < 5; i++)
                cyclic();
            break_at(INTACT);
            cyclic();
            cyclic();
            TEST_ASSERT_EQUAL_INT_MESSAGE(RING_INTACT, port.ring.state, message);
        }
}

static void test_without_a_second_interface_set_up_fails(void)
{
    ecx_portt single = {.nic = wire_start(false)};
    ecx_redportt second;
    TEST_ASSERT_EQUAL_INT(1, ecx_setupnic(&single, "wire", FALSE));
    TEST_ASSERT_EQUAL_INT(0, ecx_setupnic(&single, "second", TRUE)); /* no redport */
    single.redport = &second;
    TEST_ASSERT_EQUAL_INT(0, ecx_setupnic(&single, "second", TRUE)); /* one interface only */
    cm1e_nic_close(single.nic);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_exchange_is_right_and_cheap_in_every_state_of_the_ring);
    RUN_TEST(test_any_change_of_the_ring_is_learned_within_two_cycles);
    RUN_TEST(test_in_the_cycle_a_break_costs_no_waiting_once_it_is_known);
    RUN_TEST(test_polling_with_timeout_zero_also_gets_the_whole_answer);
    RUN_TEST(test_two_breaks_give_the_reachable_slaves_and_a_short_working_counter);
    RUN_TEST(test_a_second_break_between_two_frames_by_position_is_noticed);
    RUN_TEST(test_an_ordered_frame_that_both_halves_processed_is_not_called_complete);
    RUN_TEST(test_frames_from_before_a_break_do_not_unteach_it);
    RUN_TEST(test_one_look_a_cycle_without_waiting_is_enough_to_learn);
    RUN_TEST(test_random_losses_and_breaks_never_give_wrong_data);
    RUN_TEST(test_one_lost_half_in_a_cut_ring_costs_one_cycle);
    RUN_TEST(test_a_break_of_months_is_forgotten_when_the_ring_is_mended);
    RUN_TEST(test_without_a_second_interface_set_up_fails);
    return UNITY_END();
}
