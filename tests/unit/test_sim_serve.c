/* Serving a simulated segment on one end of a veth pair, a master of SOEM's at the other, a console beside it. */
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include <ethercat.h>
#include <unity.h>

#include "../support/veth.h"
#include "nic/nic.h"
#include "sim/segment.h"
#include "sim/slave.h"

enum { N = 3, PATIENCE_US = 500000 };

static bool have_wire;
static cm1e_sim_segment_t *segment;
static volatile int stop;
static int console_in[2], console_out[2];
static pthread_t server;
static cm1e_error_t served;
static ecx_portt port;

static void *run_server(void *unused)
{
    (void)unused;
    const cm1e_sim_streams_t console = {console_in[0], console_out[1], console_out[1]};
    cm1e_sim_server_t *s;
    served = cm1e_sim_server_open(&s, segment, "wire1", NULL);
    if (!served)
        cm1e_sim_server_run(s, &console, &stop);
    cm1e_sim_server_close(s);
    return NULL;
}

void setUp(void)
{
    if (!have_wire)
        TEST_IGNORE_MESSAGE("needs root or user namespaces, and ip from iproute2");
    segment = cm1e_sim_segment_create_empty();
    for (int i = 0; i < N; i++)
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_sim_segment_add(segment, cm1e_sim_io_module_create()));
    TEST_ASSERT_EQUAL_INT(0, pipe(console_in));
    TEST_ASSERT_EQUAL_INT(0, pipe(console_out));
    stop = 0;
    served = CM1E_ERROR_STATE;
    memset(&port, 0, sizeof port);
    TEST_ASSERT_EQUAL_INT(1, ecx_setupnic(&port, "wire0", FALSE));
    TEST_ASSERT_EQUAL_INT(0, pthread_create(&server, NULL, run_server, NULL));
}

static void stop_server(void)
{
    if (stop)
        return;
    stop = 1;
    pthread_join(server, NULL);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, served);
}

void tearDown(void)
{
    if (!have_wire)
        return;
    stop_server();
    ecx_closenic(&port);
    for (int i = 0; i < 2; i++) {
        close(console_in[i]);
        close(console_out[i]);
    }
    cm1e_sim_segment_destroy(segment);
}

static int broadcast(int timeout)
{
    uint16_t data = 0;
    return ecx_BRD(&port, 0, 0, 2, &data, timeout);
}

/** Waits until the server is there. */
static void expect_slaves(void) { TEST_ASSERT_EQUAL_INT(N, broadcast(PATIENCE_US)); }

/** One answer line of the console. */
static void read_line(char *line, size_t size)
{
    size_t n = 0;
    while (n + 1 < size && read(console_out[0], line + n, 1) == 1 && line[n] != '\n')
        n++;
    line[n] = 0;
}

static void type(const char *text) { TEST_ASSERT_EQUAL_INT(strlen(text), write(console_in[1], text, strlen(text))); }

static void expect_answer(const char *part)
{
    char line[400];
    read_line(line, sizeof line);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(line, part), line);
}

static void test_a_master_on_the_other_end_finds_the_slaves(void)
{
    expect_slaves();
    for (int i = 0; i < N; i++) {
        TEST_ASSERT_EQUAL_INT(1, ecx_APWRw(&port, (uint16)-i, 0x0010, (uint16)(0x1001 + i), PATIENCE_US));
        uint16_t station = 0;
        TEST_ASSERT_EQUAL_INT(1, ecx_FPRD(&port, (uint16)(0x1001 + i), 0x0010, 2, &station, PATIENCE_US));
        TEST_ASSERT_EQUAL_HEX16(0x1001 + i, station);
    }
    TEST_ASSERT_EQUAL_UINT64(0, port.counters.malformed);
}

static void test_console_lines_act_and_are_answered(void)
{
    expect_slaves();
    type("status\n");
    for (int i = 0; i < N; i++)
        expect_answer("not a CM1-E");
    type("lose 3\r\n");
    expect_answer("lost");
    TEST_ASSERT_EQUAL_INT(EC_NOFRAME, broadcast(EC_TIMEOUTRET));
    expect_slaves();
    type("status 1\ncorrupt 1\n"); /* two lines in one piece */
    expect_answer("1: not a CM1-E");
    expect_answer("corrupted");
    TEST_ASSERT_EQUAL_INT(EC_NOFRAME, broadcast(EC_TIMEOUTRET));
    TEST_ASSERT_EQUAL_UINT64(1, port.counters.malformed);
    expect_slaves();
}

static void test_delayed_answers_come_later(void)
{
    expect_slaves();
    type("delay 1 30000\n");
    expect_answer("30000");
    const int64_t before = cm1e_clock_now(cm1e_clock_monotonic());
    const uint8 idx = ecx_getindex(&port);
    uint16_t zero = 0;
    ecx_setupdatagram(&port, &port.txbuf[idx], EC_CMD_BRD, idx, 0, 0, 2, &zero);
    ecx_outframe_red(&port, idx);
    TEST_ASSERT_EQUAL_INT(N, ecx_waitinframe(&port, idx, PATIENCE_US));
    TEST_ASSERT_GREATER_OR_EQUAL_INT64(30000000, cm1e_clock_now(cm1e_clock_monotonic()) - before);
}

static void test_lines_in_pieces_too_long_or_of_rubbish_do_no_harm(void)
{
    expect_slaves();
    type("sta");
    usleep(3000);
    type("tus 1\n");
    expect_answer("1: not a CM1-E");
    char text[3000];
    memset(text, 'x', sizeof text);
    text[sizeof text - 1] = 0;
    type(text);
    type("\n\n\n");
    expect_answer("too long");
    for (int i = 0; i < 2000; i++)
        text[i] = (char)(1 + (i * 37) % 255);
    text[2000] = 0;
    type(text);
    type("\nstatus 2\n");
    char line[400];
    for (int i = 0; i < 100; i++) {
        read_line(line, sizeof line);
        if (strstr(line, "2: not a CM1-E"))
            break;
    }
    TEST_ASSERT_NOT_NULL(strstr(line, "2: not a CM1-E"));
    expect_slaves();
}

static void test_the_end_of_the_console_is_not_the_end_of_the_segment(void)
{
    expect_slaves();
    type("status 3"); /* the last line may lack its end */
    close(console_in[1]);
    console_in[1] = dup(0);
    expect_answer("3: not a CM1-E");
    usleep(5000);
    expect_slaves();
}

static void test_answers_that_nobody_reads_do_not_stop_the_segment(void)
{
    expect_slaves();
    for (int i = 0; i < 200; i++)
        type("help\n"); /* far more than a pipe holds */
    expect_slaves();
    close(console_out[0]);
    console_out[0] = dup(0);
    signal(SIGPIPE, SIG_DFL);
    type("help\n");
    usleep(5000);
    expect_slaves();
}

static void test_stop_ends_it_within_a_few_ticks(void)
{
    expect_slaves();
    const int64_t before = cm1e_clock_now(cm1e_clock_monotonic());
    stop_server();
    TEST_ASSERT_LESS_THAN_INT64(500000000, cm1e_clock_now(cm1e_clock_monotonic()) - before);
    TEST_ASSERT_EQUAL_INT(EC_NOFRAME, broadcast(EC_TIMEOUTRET));
}

static void test_an_interface_that_is_missing_is_named(void)
{
    cm1e_diag_t diag = {0};
    cm1e_sim_server_t *s;
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_NOT_FOUND, cm1e_sim_server_open(&s, segment, "eth77", &diag));
    TEST_ASSERT_NULL(s);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, "eth77"), diag.text);
}

int main(void)
{
    have_wire = veth_make();
    UNITY_BEGIN();
    RUN_TEST(test_a_master_on_the_other_end_finds_the_slaves);
    RUN_TEST(test_console_lines_act_and_are_answered);
    RUN_TEST(test_delayed_answers_come_later);
    RUN_TEST(test_lines_in_pieces_too_long_or_of_rubbish_do_no_harm);
    RUN_TEST(test_the_end_of_the_console_is_not_the_end_of_the_segment);
    RUN_TEST(test_answers_that_nobody_reads_do_not_stop_the_segment);
    RUN_TEST(test_stop_ends_it_within_a_few_ticks);
    RUN_TEST(test_an_interface_that_is_missing_is_named);
    return UNITY_END();
}
