/* The tap: every verdict on a fake wire, injected frames, the pcap file byte by byte, the frame queue, opening. */
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <ethercat.h>
#include <unity.h>

#include "../support/fake_wire.h"
#include "core/bytes.h"
#include "nic/frame.h"
#include "nic/pcap.h"

enum { RTT_NS = WIRE_BASE_NS + WIRE_SLAVES * WIRE_SLAVE_NS };

static ecx_portt port;
static cm1e_nic_t *nic;

/** What the tap does, and what it saw. */
static struct {
    void (*act)(cm1e_tap_frame_t *frame);
    cm1e_tap_verdict_t verdict;
    cm1e_tap_direction_t direction;
    unsigned seen[2];
    uint64_t last_number[2];
    int64_t last_time_ns[2];
} tap;

static cm1e_tap_verdict_t tap_function(void *context, cm1e_tap_frame_t *frame)
{
    TEST_ASSERT_EQUAL_PTR(&tap, context);
    TEST_ASSERT_EQUAL_UINT(1, frame->copies);
    TEST_ASSERT_EQUAL_INT64(0, frame->delay_ns);
    tap.seen[frame->direction]++;
    tap.last_number[frame->direction] = frame->number;
    tap.last_time_ns[frame->direction] = frame->time_ns;
    if (frame->direction != tap.direction)
        return CM1E_TAP_PASS;
    if (tap.act)
        tap.act(frame);
    return tap.verdict;
}

void setUp(void)
{
    memset(&port, 0, sizeof port);
    memset(&tap, 0, sizeof tap);
    nic = port.nic = wire_start(false);
    ecx_setupnic(&port, "wire", FALSE);
    cm1e_nic_set_tap(nic, tap_function, &tap);
}

void tearDown(void) { cm1e_nic_close(nic); }

static int64_t now(void) { return cm1e_clock_now(cm1e_nic_clock(nic)); }

static int broadcast(int timeout)
{
    uint16_t data = 0;
    return ecx_BRD(&port, 0, 0, 2, &data, timeout);
}

static void test_every_frame_is_seen_in_both_directions_with_number_and_time(void)
{
    for (unsigned i = 0; i < 10; i++) {
        TEST_ASSERT_EQUAL_INT(WIRE_SLAVES, broadcast(EC_TIMEOUTRET));
        TEST_ASSERT_EQUAL_UINT(i + 1, tap.seen[CM1E_TAP_SENT]);
        TEST_ASSERT_EQUAL_UINT(i + 1, tap.seen[CM1E_TAP_RECEIVED]);
        TEST_ASSERT_EQUAL_UINT64(i, tap.last_number[CM1E_TAP_SENT]);
        TEST_ASSERT_EQUAL_UINT64(i, tap.last_number[CM1E_TAP_RECEIVED]);
        TEST_ASSERT_EQUAL_INT64(RTT_NS, tap.last_time_ns[1] - tap.last_time_ns[0]);
    }
    cm1e_nic_set_tap(nic, NULL, NULL);
    TEST_ASSERT_EQUAL_INT(WIRE_SLAVES, broadcast(EC_TIMEOUTRET));
    TEST_ASSERT_EQUAL_UINT(10, tap.seen[CM1E_TAP_SENT]);
}

static void test_a_dropped_frame_is_lost_before_or_after_the_slaves(void)
{
    tap.verdict = CM1E_TAP_DROP;
    for (int direction = 0; direction < 2; direction++) {
        tap.direction = (cm1e_tap_direction_t)direction;
        const int processed = wire.slave[1].frames;
        const int64_t before = now();
        TEST_ASSERT_EQUAL_INT(EC_NOFRAME, broadcast(700));
        TEST_ASSERT_EQUAL_INT64(before + 700000, now());
        TEST_ASSERT_EQUAL_INT(direction, wire.slave[1].frames - processed);
    }
}

static int64_t delay_ns;
static void delay(cm1e_tap_frame_t *frame) { frame->delay_ns = delay_ns; }

static void test_a_delayed_answer_comes_exactly_that_much_later(void)
{
    tap.direction = CM1E_TAP_RECEIVED;
    tap.act = delay;
    for (delay_ns = 1; delay_ns < 1500000; delay_ns = delay_ns * 3 + 1) {
        const int64_t before = now();
        TEST_ASSERT_EQUAL_INT(WIRE_SLAVES, broadcast(EC_TIMEOUTRET));
        TEST_ASSERT_EQUAL_INT64(before + RTT_NS + delay_ns, now());
    }
}

static void delay_even(cm1e_tap_frame_t *frame) { frame->delay_ns = frame->number % 2 == 0 ? 50000 : 0; }

static void test_delayed_answers_are_overtaken_and_still_find_their_index(void)
{
    tap.direction = CM1E_TAP_RECEIVED;
    tap.act = delay_even;
    uint8 idx[8];
    uint16_t zero = 0;
    for (int i = 0; i < 8; i++) {
        idx[i] = ecx_getindex(&port);
        ecx_setupdatagram(&port, &port.txbuf[idx[i]], EC_CMD_FPRD, idx[i], (uint16)(WIRE_STATION + i % 4), 2, 2, &zero);
        ecx_outframe_red(&port, idx[i]);
    }
    const int64_t start = now();
    TEST_ASSERT_EQUAL_INT(1, ecx_waitinframe(&port, idx[1], 1000));
    TEST_ASSERT_EQUAL_INT64(start + RTT_NS, now());
    TEST_ASSERT_EQUAL_INT(1, ecx_waitinframe(&port, idx[0], 1000));
    TEST_ASSERT_EQUAL_INT64(start + RTT_NS + 50000, now());
    for (int i = 0; i < 8; i++) {
        if (i > 1)
            TEST_ASSERT_EQUAL_INT(1, ecx_waitinframe(&port, idx[i], 1000));
        TEST_ASSERT_EQUAL_HEX8((i % 4 + 1) * 16 + 2, port.rxbuf[idx[i]][EC_HEADERSIZE]);
    }
    TEST_ASSERT_EQUAL_UINT64(0, port.counters.late + port.counters.duplicates);
}

static void twice(cm1e_tap_frame_t *frame) { frame->copies = 2; }

static void test_a_doubled_request_reaches_the_slaves_twice(void)
{
    tap.direction = CM1E_TAP_SENT;
    tap.act = twice;
    TEST_ASSERT_EQUAL_INT(WIRE_SLAVES, broadcast(EC_TIMEOUTRET));
    TEST_ASSERT_EQUAL_INT(2, wire.slave[1].frames);
}

static void truncate_to_20(cm1e_tap_frame_t *frame) { frame->length = 20; }
static void lengthen(cm1e_tap_frame_t *frame) { frame->length = SIZE_MAX; }
static void no_length(cm1e_tap_frame_t *frame) { frame->length = 0; }
static void no_copy(cm1e_tap_frame_t *frame) { frame->copies = 0; }
static void other_command(cm1e_tap_frame_t *frame) { frame->bytes[FRAME_HEADER] ^= 1; }

static void test_what_the_tap_makes_of_a_frame_is_what_arrives(void)
{
    static const struct {
        void (*act)(cm1e_tap_frame_t *);
        bool taken;
        unsigned malformed;
    } cases[] = {{truncate_to_20, false, 1}, {other_command, false, 1}, {no_length, false, 0}, {no_copy, false, 0},
                 {lengthen, true, 0}, {twice, true, 0}};
    tap.direction = CM1E_TAP_RECEIVED;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        tap.act = cases[i].act;
        const uint64_t malformed = port.counters.malformed;
        TEST_ASSERT_EQUAL_INT(cases[i].taken ? WIRE_SLAVES : EC_NOFRAME, broadcast(100));
        TEST_ASSERT_EQUAL_UINT64(malformed + cases[i].malformed, port.counters.malformed);
    }
}

static int counter_delta;
static void change_counter(cm1e_tap_frame_t *frame)
{
    TEST_ASSERT_TRUE(cm1e_frame_change_working_counter(frame->bytes, frame->length, 0, counter_delta));
    TEST_ASSERT_FALSE(cm1e_frame_change_working_counter(frame->bytes, frame->length, 1, counter_delta));
}

static void test_a_changed_working_counter_is_what_the_master_sees(void)
{
    tap.direction = CM1E_TAP_RECEIVED;
    tap.act = change_counter;
    for (counter_delta = -WIRE_SLAVES; counter_delta < 10; counter_delta++)
        TEST_ASSERT_EQUAL_INT(WIRE_SLAVES + counter_delta, broadcast(100));
}

static void test_the_working_counter_of_any_datagram_is_found_and_of_no_broken_frame(void)
{
    uint8_t data[40] = {0};
    const uint8 idx = ecx_getindex(&port);
    ecx_setupdatagram(&port, &port.txbuf[idx], EC_CMD_LRW, idx, 0, 0, 40, data);
    ecx_adddatagram(&port, &port.txbuf[idx], EC_CMD_FRMW, idx, TRUE, 0x1001, 0x910, 8, data);
    ecx_adddatagram(&port, &port.txbuf[idx], EC_CMD_BRD, idx, FALSE, 0, 0x130, 2, data);
    uint8_t *frame = port.txbuf[idx];
    const size_t length = (size_t)port.txbuflength[idx];
    static const size_t places[] = {16 + 10 + 40, 16 + 52 + 10 + 8, 16 + 52 + 20 + 10 + 2};
    for (unsigned n = 0; n < 3; n++) {
        TEST_ASSERT_TRUE(cm1e_frame_change_working_counter(frame, length, n, 0x0102 + (int)n));
        TEST_ASSERT_EQUAL_HEX8(2 + n, frame[places[n]]);
        TEST_ASSERT_EQUAL_HEX8(1, frame[places[n] + 1]);
    }
    TEST_ASSERT_FALSE(cm1e_frame_change_working_counter(frame, length, 3, 1));
    for (size_t n = 0; n < length; n++) {
        uint8_t *cut = malloc(n + 1); /* exact size: a read beyond it is found by the sanitizer */
        memcpy(cut, frame, n);
        TEST_ASSERT_FALSE(cm1e_frame_change_working_counter(cut, n, 2, 1));
        free(cut);
    }
}

static void test_injected_frames_come_at_their_time_and_pass_the_tap(void)
{
    wire.mute = true;
    const uint8 idx = ecx_getindex(&port);
    uint16_t zero = 0;
    ecx_setupdatagram(&port, &port.txbuf[idx], EC_CMD_BRD, idx, 0, 0, 2, &zero);
    ecx_outframe_red(&port, idx);
    uint8_t answer[64] = {0};
    memcpy(answer, port.txbuf[idx], 30);
    answer[28] = 9;
    TEST_ASSERT_TRUE(cm1e_nic_inject(nic, 0, answer, 60, now() + 300000));
    TEST_ASSERT_EQUAL_INT(EC_NOFRAME, ecx_waitinframe(&port, idx, 299));
    TEST_ASSERT_EQUAL_INT(9, ecx_waitinframe(&port, idx, 5));
    TEST_ASSERT_EQUAL_INT64(1000000 + 300000, now());
    TEST_ASSERT_EQUAL_UINT(1, tap.seen[CM1E_TAP_RECEIVED]);
}

static void test_injection_refuses_what_does_not_fit(void)
{
    uint8_t frame[CM1E_FRAME_MAX + 1] = {0};
    TEST_ASSERT_FALSE(cm1e_nic_inject(nic, 0, frame, 0, 0));
    TEST_ASSERT_FALSE(cm1e_nic_inject(nic, 0, frame, CM1E_FRAME_MAX + 1, 0));
    TEST_ASSERT_FALSE(cm1e_nic_inject(nic, -1, frame, 60, 0));
    TEST_ASSERT_FALSE(cm1e_nic_inject(nic, CM1E_NIC_PORTS, frame, 60, 0));
    for (int i = 0; i < FRAME_QUEUE_PLACES; i++)
        TEST_ASSERT_TRUE(cm1e_nic_inject(nic, 0, frame, CM1E_FRAME_MAX, 0));
    TEST_ASSERT_FALSE(cm1e_nic_inject(nic, 0, frame, 60, 0));
    broadcast(100);
    TEST_ASSERT_TRUE(cm1e_nic_inject(nic, 0, frame, 60, 0));
}

static void test_frames_of_every_length_are_sent_and_no_others(void)
{
    const uint8_t frame[CM1E_FRAME_MAX + 1] = {0};
    cm1e_nic_set_tap(nic, NULL, NULL);
    for (size_t length = 0; length <= CM1E_FRAME_MAX + 1; length++)
        TEST_ASSERT_EQUAL(length > 0 && length <= CM1E_FRAME_MAX, cm1e_nic_send(nic, 0, frame, length));
    TEST_ASSERT_EQUAL_INT(CM1E_FRAME_MAX, wire.sent[0]);
    TEST_ASSERT_FALSE(cm1e_nic_send(nic, 1, frame, 60)); /* a line has one port */
}

/* ---- frame queue ------------------------------------------------------------------------------------------------- */

static void test_the_frame_queue_sorts_by_time_and_keeps_the_order_of_equals(void)
{
    static frame_queue_t queue;
    const unsigned seed = (unsigned)time(NULL);
    printf("seed %u\n", seed);
    srand(seed);
    unsigned number = 0, inside = 0;
    for (int i = 0; i < 100000; i++) {
        if (rand() % 2 && inside < FRAME_QUEUE_PLACES) {
            queued_frame_t *f = cm1e_frame_queue_place(&queue);
            TEST_ASSERT_NOT_NULL(f);
            f->length = ++number;
            cm1e_frame_queue_insert(&queue, f, rand() % 8);
            inside++;
        } else if (inside > 0) {
            const queued_frame_t first = *frame_queue_first(&queue);
            cm1e_frame_queue_remove_first(&queue);
            inside--;
            const queued_frame_t *next = frame_queue_first(&queue);
            TEST_ASSERT_EQUAL(inside > 0, next != NULL);
            if (next)
                TEST_ASSERT_TRUE(next->ready_ns > first.ready_ns ||
                                 (next->ready_ns == first.ready_ns && next->length > first.length));
        }
        TEST_ASSERT_EQUAL_UINT(inside, queue.count);
    }
    while (inside++ < FRAME_QUEUE_PLACES)
        cm1e_frame_queue_insert(&queue, cm1e_frame_queue_place(&queue), 0);
    TEST_ASSERT_NULL(cm1e_frame_queue_place(&queue));
}

/* ---- pcap -------------------------------------------------------------------------------------------------------- */

static uint32_t u32(const uint8_t *p) { return cm1e_get_u32(p); }

static void test_the_pcap_file_holds_every_frame_after_the_tap(void)
{
    const char *path = CM1E_TEST_OUTPUT "/test_nic_tap.pcap";
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_nic_pcap(nic, path, NULL));
    const int64_t start = now();
    TEST_ASSERT_EQUAL_INT(WIRE_SLAVES, broadcast(EC_TIMEOUTRET));
    tap.direction = CM1E_TAP_RECEIVED;
    tap.verdict = CM1E_TAP_DROP;
    broadcast(100);
    cm1e_nic_close(nic);
    nic = NULL;

    static uint8_t file[4096];
    FILE *f = fopen(path, "rb");
    TEST_ASSERT_NOT_NULL(f);
    const size_t size = fread(file, 1, sizeof file, f);
    fclose(f);
    /* Two requests, one answer: the second answer was dropped. */
    TEST_ASSERT_EQUAL_UINT(24 + 3 * (16 + 30), size);
    static const uint8_t header[24] = {0x4D, 0x3C, 0xB2, 0xA1, 2, 0, 4, 0, [16] = 0xFF, 0xFF, 0, 0, 1, 0, 0, 0};
    TEST_ASSERT_EQUAL_MEMORY(header, file, sizeof header);
    const int64_t times[3] = {start, start + RTT_NS, start + RTT_NS};
    for (int i = 0; i < 3; i++) {
        const uint8_t *record = file + 24 + i * (16 + 30);
        TEST_ASSERT_EQUAL_INT64(times[i], (int64_t)u32(record) * 1000000000 + u32(record + 4));
        TEST_ASSERT_EQUAL_UINT32(30, u32(record + 8));
        TEST_ASSERT_EQUAL_UINT32(30, u32(record + 12));
        TEST_ASSERT_EQUAL_HEX8(0x88, record[16 + 12]);
        TEST_ASSERT_EQUAL_UINT8(i == 1 ? WIRE_SLAVES : 0, record[16 + 28]);
    }
}

/* Two networks with one file: the second is told, and the records of the first stay whole. */
static void test_a_pcap_file_has_one_writer(void)
{
    const char *path = CM1E_TEST_OUTPUT "/test_nic_tap_twice.pcap";
    pcap_file_t *first, *second;
    static uint8_t frame[60];
    struct stat found;
    cm1e_diag_t diag;
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_pcap_open(&first, path, NULL));
    cm1e_pcap_write(first, 1, frame, sizeof frame);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_pcap_check(first, path, NULL));
    const int next = dup(0);
    close(next);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_IO, cm1e_pcap_open(&second, path, &diag));
    TEST_ASSERT_EQUAL_INT(next, dup(0)); /* what was refused has nothing open */
    close(next);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, "is being written already, for another network"), diag.text);
    TEST_ASSERT_NULL(second);
    TEST_ASSERT_EQUAL_INT(0, stat(path, &found));
    TEST_ASSERT_EQUAL_INT(24 + 16 + sizeof frame, found.st_size);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_pcap_close(first));
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_pcap_open(&second, path, NULL)); /* and a later one begins anew */
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_pcap_close(second));
    TEST_ASSERT_EQUAL_INT(0, stat(path, &found));
    TEST_ASSERT_EQUAL_INT(24, found.st_size);
    for (int i = 0; i < 2; i++) /* no file */
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_pcap_open(i ? &second : &first, "/dev/null", NULL));
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_pcap_close(first));
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_pcap_close(second));
}

/* A child that was forked meanwhile, as by a program that starts another one, has the file open too. */
static void test_a_pcap_file_that_is_closed_is_free_whoever_was_forked(void)
{
    const char *path = CM1E_TEST_OUTPUT "/test_nic_tap_fork.pcap";
    pcap_file_t *file;
    cm1e_diag_t diag = {0};
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_pcap_open(&file, path, NULL));
    const pid_t child = fork();
    if (child == 0)
        for (;;)
            pause();
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_pcap_close(file));
    const cm1e_error_t error = cm1e_pcap_open(&file, path, &diag);
    kill(child, SIGKILL);
    waitpid(child, NULL, 0);
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, error, diag.text);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_pcap_close(file));
}

static void test_a_pcap_file_that_cannot_be_written_is_diagnosed(void)
{
    cm1e_diag_t diag = {0};
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_IO, cm1e_nic_pcap(nic, "/nowhere/at/all.pcap", &diag));
    TEST_ASSERT_NOT_NULL(strstr(diag.text, "/nowhere/at/all.pcap"));
    TEST_ASSERT_EQUAL_INT(WIRE_SLAVES, broadcast(100));
    if (access("/dev/full", W_OK) == 0) {
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_nic_pcap(nic, "/dev/full", &diag));
        for (int i = 0; i < 50000; i++)
            TEST_ASSERT_EQUAL_INT(WIRE_SLAVES, broadcast(100));
    }
}

static void test_closing_leaves_no_virtual_clock_behind(void)
{
    cm1e_clock_make_current(cm1e_nic_clock(nic));
    cm1e_nic_close(nic);
    nic = NULL;
    TEST_ASSERT_EQUAL_PTR(cm1e_clock_monotonic(), cm1e_clock_current());
    cm1e_nic_close(NULL);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_frame_is_seen_in_both_directions_with_number_and_time);
    RUN_TEST(test_a_dropped_frame_is_lost_before_or_after_the_slaves);
    RUN_TEST(test_a_delayed_answer_comes_exactly_that_much_later);
    RUN_TEST(test_delayed_answers_are_overtaken_and_still_find_their_index);
    RUN_TEST(test_a_doubled_request_reaches_the_slaves_twice);
    RUN_TEST(test_what_the_tap_makes_of_a_frame_is_what_arrives);
    RUN_TEST(test_a_changed_working_counter_is_what_the_master_sees);
    RUN_TEST(test_the_working_counter_of_any_datagram_is_found_and_of_no_broken_frame);
    RUN_TEST(test_injected_frames_come_at_their_time_and_pass_the_tap);
    RUN_TEST(test_frames_of_every_length_are_sent_and_no_others);
    RUN_TEST(test_injection_refuses_what_does_not_fit);
    RUN_TEST(test_the_frame_queue_sorts_by_time_and_keeps_the_order_of_equals);
    RUN_TEST(test_the_pcap_file_holds_every_frame_after_the_tap);
    RUN_TEST(test_a_pcap_file_has_one_writer);
    RUN_TEST(test_a_pcap_file_that_is_closed_is_free_whoever_was_forked);
    RUN_TEST(test_a_pcap_file_that_cannot_be_written_is_diagnosed);
    RUN_TEST(test_closing_leaves_no_virtual_clock_behind);
    return UNITY_END();
}
