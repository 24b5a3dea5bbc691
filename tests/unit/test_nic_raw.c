/* The ways to the frames of a network interface, on a veth pair of the test's own network namespace (skipped where that is
 * not allowed), and what the packet socket says when it cannot be opened. */
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <ethercat.h>
#include <oshw.h>
#include <unity.h>

#include "../support/real_time.h"
#include "../support/veth.h"
#include "nic/nic_private.h"
#include "nic/raw_socket.h"

static bool have_wire;
static const char *way = ""; /* ",xdp": AF_XDP */
static cm1e_bus_config_t config;
static cm1e_diag_t diag;

void setUp(void)
{
    memset(&config, 0, sizeof config);
    memset(&diag, 0, sizeof diag);
    snprintf(config.interface_name, sizeof config.interface_name, "wire0%s", way);
}

void tearDown(void) {}

static void need_wire(void)
{
    if (!have_wire)
        TEST_IGNORE_MESSAGE("needs root or user namespaces, and ip from iproute2");
}

static int64_t cpu_ns(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (int64_t)t.tv_sec * 1000000000 + t.tv_nsec;
}

static int64_t now(void) { return cm1e_clock_now(cm1e_clock_monotonic()); }

/* ---- the far end: gives every frame back with working counter 1 -------------------------------------------------- */

static struct {
    pthread_t thread;
    cm1e_raw_socket_t socket;
    atomic_bool stop, mute;
    atomic_uint frames;
} echo;

static void *run_echo(void *unused)
{
    (void)unused;
    uint8_t frame[CM1E_FRAME_MAX];
    while (!atomic_load(&echo.stop)) {
        const int n = cm1e_raw_socket_receive(echo.socket.fd, frame, sizeof frame);
        if (n <= 0) {
            usleep(20);
            continue;
        }
        atomic_fetch_add(&echo.frames, 1);
        if (atomic_load(&echo.mute))
            continue;
        const int body = (frame[14] | frame[15] << 8) & 0x7FF;
        frame[6] |= 2;
        frame[16 + body - 2]++;
        send(echo.socket.fd, frame, (size_t)n, 0);
    }
    return NULL;
}

static void start_echo(bool mute)
{
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_raw_socket_open(&echo.socket, "wire1", &diag));
    atomic_store(&echo.stop, false);
    atomic_store(&echo.mute, mute);
    atomic_store(&echo.frames, 0);
    TEST_ASSERT_EQUAL_INT(0, pthread_create(&echo.thread, NULL, run_echo, NULL));
}

static void stop_echo(void)
{
    atomic_store(&echo.stop, true);
    pthread_join(echo.thread, NULL);
    cm1e_raw_socket_close(&echo.socket);
}

/* ---- exchange ---------------------------------------------------------------------------------------------------- */

static void test_frames_go_out_and_come_back(void)
{
    need_wire();
    start_echo(false);
    static ecx_portt port;
    TEST_ASSERT_EQUAL_INT(1, ecx_setupnic(&port, config.interface_name, FALSE)); /* opened by the port itself */
    for (int i = 0; i < 200; i++) {
        uint16_t data = 0;
        TEST_ASSERT_EQUAL_INT(1, ecx_BRD(&port, 0, 0, 2, &data, 200000));
    }
    /* Our own frames are not received; each answer is, repetitions on a busy machine excepted. */
    TEST_ASSERT_EQUAL_UINT64(0, port.counters.malformed);
    TEST_ASSERT_EQUAL_UINT64(port.counters.received, 200 + port.counters.late + port.counters.duplicates);
    stop_echo();
    TEST_ASSERT_EQUAL_INT(0, ecx_closenic(&port));
    TEST_ASSERT_NULL(port.nic);
}

static void test_our_own_frames_are_not_received(void)
{
    need_wire();
    cm1e_nic_t *nic = NULL;
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_nic_open(&nic, &config, &diag));
    uint8_t frame[CM1E_FRAME_MAX] = {255, 255, 255, 255, 255, 255, 1, 1, 1, 1, 1, 1, 0x88, 0xA4};
    for (int i = 0; i < 10; i++)
        TEST_ASSERT_TRUE(cm1e_nic_send(nic, 0, frame, 60));
    int port;
    TEST_ASSERT_EQUAL_UINT(0, cm1e_nic_receive(nic, &port, frame, now() + 5000000));
    TEST_ASSERT_EQUAL_PTR(&cm1e_backend_raw, nic->backend);
    TEST_ASSERT_EQUAL_PTR(cm1e_clock_monotonic(), cm1e_nic_clock(nic));
    TEST_ASSERT_FALSE(cm1e_nic_send(nic, 1, frame, 60)); /* there is no second port */
    cm1e_nic_close(nic);
}

static void test_frames_from_before_the_opening_are_not_received(void)
{
    need_wire();
    cm1e_raw_socket_t other;
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_raw_socket_open(&other, "wire1", &diag));
    uint8_t frame[60] = {255, 255, 255, 255, 255, 255, 1, 1, 1, 1, 1, 1, 0x88, 0xA4};
    for (int i = 0; i < 50; i++)
        send(other.fd, frame, sizeof frame, 0);
    cm1e_nic_t *nic = NULL;
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_nic_open(&nic, &config, &diag));
    int port;
    TEST_ASSERT_EQUAL_UINT(0, cm1e_nic_receive(nic, &port, frame, now() + 2000000));
    /* Other protocols are none of ours either. */
    frame[13] = 0xA5;
    send(other.fd, frame, sizeof frame, 0);
    TEST_ASSERT_EQUAL_UINT(0, cm1e_nic_receive(nic, &port, frame, now() + 2000000));
    cm1e_raw_socket_close(&other);
    cm1e_nic_close(nic);
}

/** How late the best quarter of 41 waits of one length ends: a busy machine delays some, also most; a wait of whole
 *  jiffies would delay all, as each begins right behind the tick that ended the last one. */
static int64_t usual_overshoot(cm1e_nic_t *nic, int64_t wait_ns)
{
    enum { WAITS = 41 };
    int64_t over[WAITS];
    uint8_t frame[CM1E_FRAME_MAX];
    int port;
    for (int i = 0; i < WAITS; i++) {
        const int64_t deadline = now() + wait_ns;
        TEST_ASSERT_EQUAL_UINT(0, cm1e_nic_receive(nic, &port, frame, deadline));
        int64_t late = now() - deadline;
        TEST_ASSERT_GREATER_OR_EQUAL_INT64(0, late);
        int at = i;
        for (; at > 0 && over[at - 1] > late; at--)
            over[at] = over[at - 1];
        over[at] = late;
    }
    return over[WAITS / 4];
}

static void test_waits_end_at_the_deadline_and_use_no_cpu(void)
{
    need_wire();
    cm1e_nic_t *nic = NULL;
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_nic_open(&nic, &config, &diag));
    static const int64_t waits[] = {20000, 62500, 250000, 2000000};
    for (size_t i = 0; i < sizeof waits / sizeof waits[0]; i++) {
        const int64_t over = usual_overshoot(nic, waits[i]);
        printf("wait of %d us: ends %d us late (best quarter of 41)\n", (int)(waits[i] / 1000), (int)(over / 1000));
        TEST_ASSERT_LESS_THAN_INT64(1000000, over);
    }
    const int64_t before = cpu_ns();
    uint8_t frame[CM1E_FRAME_MAX];
    int port;
    cm1e_nic_receive(nic, &port, frame, now() + 200000000);
    TEST_ASSERT_LESS_THAN_INT64(50000000, cpu_ns() - before);
    cm1e_nic_close(nic);
}

static void test_a_lost_frame_costs_the_timeout(void)
{
    need_wire();
    start_echo(true);
    static ecx_portt port;
    TEST_ASSERT_EQUAL_INT(1, ecx_setupnic(&port, config.interface_name, FALSE));
    int64_t best = INT64_MAX;
    for (int i = 0; i < 20; i++) {
        uint16_t data = 0;
        const int64_t before = now();
        TEST_ASSERT_EQUAL_INT(EC_NOFRAME, ecx_BRD(&port, 0, 0, 2, &data, EC_TIMEOUTRET));
        const int64_t cost = now() - before;
        TEST_ASSERT_GREATER_OR_EQUAL_INT64(2000000, cost);
        best = cost < best ? cost : best;
    }
    TEST_ASSERT_LESS_THAN_INT64(3000000, best);
    stop_echo();
    ecx_closenic(&port);
}

static void test_an_interface_that_goes_away_is_no_busy_loop(void)
{
    need_wire();
    cm1e_nic_t *nic = NULL;
    TEST_ASSERT_EQUAL_INT(0, system("ip link add gone0 type veth peer name gone1 && ip link set gone0 up && "
                                   "ip link set gone1 up"));
    snprintf(config.interface_name, sizeof config.interface_name, "gone0%s", way);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_nic_open(&nic, &config, &diag));
    uint8_t frame[CM1E_FRAME_MAX] = {255, 255, 255, 255, 255, 255, 1, 1, 1, 1, 1, 1, 0x88, 0xA4};
    int port;
    TEST_ASSERT_EQUAL_INT(0, system("ip link set gone0 down"));
    TEST_ASSERT_FALSE(cm1e_nic_send(nic, 0, frame, 60));
    for (int gone = 0; gone < 2; gone++) {
        const int64_t cpu = cpu_ns(), deadline = now() + 100000000;
        TEST_ASSERT_EQUAL_UINT(0, cm1e_nic_receive(nic, &port, frame, deadline));
        TEST_ASSERT_GREATER_OR_EQUAL_INT64(deadline, now());
        TEST_ASSERT_LESS_THAN_INT64(30000000, cpu_ns() - cpu);
        if (!gone)
            TEST_ASSERT_EQUAL_INT(0, system("ip link del gone0"));
    }
    TEST_ASSERT_FALSE(cm1e_nic_send(nic, 0, frame, 60));
    cm1e_nic_close(nic);
}

/* ---- redundant ring on two real interfaces ----------------------------------------------------------------------- */

static void test_two_interfaces_make_a_ring(void)
{
    need_wire();
    /* The two ends of the pair face each other: an intact ring without slaves. */
    static ecx_portt port;
    static ecx_redportt red;
    ecx_contextt context = {.port = &port};
    char second[16];
    snprintf(second, sizeof second, "wire1%s", way);
    TEST_ASSERT_EQUAL_INT(1, ecx_init_redundant(&context, &red, config.interface_name, second));
    for (int i = 0; i < 50; i++) {
        uint16_t data = 0;
        TEST_ASSERT_EQUAL_INT(0, ecx_BRD(&port, 0, 0, 2, &data, 100000));
    }
    ecx_closenic(&port);
    strcpy(config.second_interface, "wire0");
    cm1e_nic_t *nic = NULL;
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_CONFIG, cm1e_nic_open(&nic, &config, &diag));
    TEST_ASSERT_NULL(nic);
}

/* ---- the thread that opens ---------------------------------------------------------------------------------------- */

/** In either order of the closing. */
static void test_the_timer_slack_of_the_thread_comes_back(void)
{
    need_wire();
    char second[16];
    run_above_others(false); /* a real-time thread has no timer slack */
    prctl(PR_SET_TIMERSLACK, 40000UL, 0UL, 0UL, 0UL);
    snprintf(second, sizeof second, "wire1%s", way);
    for (int turn = 0; turn < 2; turn++) {
        cm1e_nic_t *nics[2] = {NULL, NULL};
        setUp();
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_nic_open(&nics[0], &config, &diag));
        strcpy(config.interface_name, second);
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_nic_open(&nics[1], &config, &diag));
        TEST_ASSERT_EQUAL_INT(1, prctl(PR_GET_TIMERSLACK));
        cm1e_nic_close(nics[turn]);
        TEST_ASSERT_EQUAL_INT(1, prctl(PR_GET_TIMERSLACK)); /* the other one needs it */
        cm1e_nic_close(nics[1 - turn]);
        TEST_ASSERT_EQUAL_INT(40000, prctl(PR_GET_TIMERSLACK));
    }
    prctl(PR_SET_TIMERSLACK, 0UL, 0UL, 0UL, 0UL); /* that of the process */
    run_above_others(true);
}

/* ---- what it says ------------------------------------------------------------------------------------------------ */

static void expect_failure(const char *interface_name, cm1e_error_t error, const char *a, const char *b)
{
    cm1e_nic_t *nic = NULL;
    strcpy(config.interface_name, interface_name);
    TEST_ASSERT_EQUAL_INT(error, cm1e_nic_open(&nic, &config, &diag));
    TEST_ASSERT_NULL(nic);
    TEST_ASSERT_EQUAL_INT(error, diag.error);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, a), diag.text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, b), diag.text);
}

static void test_an_unknown_interface_is_named_with_those_that_exist(void)
{
    need_wire();
    expect_failure("eth77", CM1E_ERROR_NOT_FOUND, "\"eth77\"", "wire0");
    expect_failure("a-name-that-is-much-longer-than-any-interface-name", CM1E_ERROR_NOT_FOUND, "much-longer", "wire1");
    static ecx_portt port;
    TEST_ASSERT_EQUAL_INT(0, ecx_setupnic(&port, "eth77", FALSE));
    TEST_ASSERT_NULL(port.nic);
}

static void test_an_interface_that_is_down_is_diagnosed_with_the_cure(void)
{
    need_wire();
    TEST_ASSERT_EQUAL_INT(0, system("ip link add down0 type veth peer name down1"));
    expect_failure("down0", CM1E_ERROR_IO, "down", "sudo ip link set down0 up");
}

static void test_the_loopback_interface_is_refused(void)
{
    need_wire();
    expect_failure("lo", CM1E_ERROR_INVALID_ARGUMENT, "\"lo\"", "Ethernet");
}

static void test_a_missing_privilege_is_diagnosed_with_the_cure(void)
{
    strcpy(config.interface_name, "lo"); /* is on every machine */
    fflush(stdout);
    const pid_t child = fork();
    TEST_ASSERT_GREATER_OR_EQUAL_INT(0, child);
    if (child == 0) {
        if (geteuid() == 0 && (setgid(65534) != 0 || setuid(65534) != 0))
            _exit(2);
        cm1e_nic_t *nic = NULL;
        const cm1e_error_t error = cm1e_nic_open(&nic, &config, &diag);
        const bool said = strstr(diag.text, "sudo") && strstr(diag.text, "setcap cap_net_raw") && !nic;
        _exit(error == CM1E_ERROR_PERMISSION && said ? 0 : error == CM1E_OK ? 3 : 1);
    }
    int status = 0;
    TEST_ASSERT_EQUAL_INT(child, waitpid(child, &status, 0));
    TEST_ASSERT_TRUE(WIFEXITED(status));
    if (WEXITSTATUS(status) == 2 || WEXITSTATUS(status) == 3)
        TEST_IGNORE_MESSAGE("the privilege cannot be given up here");
    TEST_ASSERT_EQUAL_INT(0, WEXITSTATUS(status));
}

static void test_adapters_are_listed(void)
{
    ec_adaptert *all = oshw_find_adapters();
    bool found = !have_wire;
    for (const ec_adaptert *a = all; a; a = a->next)
        found = found || strcmp(a->name, "wire0") == 0;
    TEST_ASSERT_TRUE(found);
    oshw_free_adapters(all);
    oshw_free_adapters(NULL);
    TEST_ASSERT_EQUAL_HEX16(0xA488, oshw_htons(0x88A4));
    TEST_ASSERT_EQUAL_HEX16(0x88A4, oshw_ntohs(0xA488));
}

static void run_way(const char *stated)
{
    way = stated;
    RUN_TEST(test_frames_go_out_and_come_back);
    RUN_TEST(test_our_own_frames_are_not_received);
    RUN_TEST(test_frames_from_before_the_opening_are_not_received);
    RUN_TEST(test_waits_end_at_the_deadline_and_use_no_cpu);
    RUN_TEST(test_a_lost_frame_costs_the_timeout);
    RUN_TEST(test_an_interface_that_goes_away_is_no_busy_loop);
    RUN_TEST(test_two_interfaces_make_a_ring);
    RUN_TEST(test_the_timer_slack_of_the_thread_comes_back);
    way = "";
}

static bool have_xdp(void)
{
    cm1e_nic_t *nic = NULL;
    cm1e_bus_config_t probe = {.interface_name = "wire0,xdp"};
    const cm1e_error_t error = have_wire ? cm1e_nic_open(&nic, &probe, &diag) : CM1E_OK;
    if (error != CM1E_OK)
        printf("SKIPPED: AF_XDP: %s\n", diag.text);
    cm1e_nic_close(nic);
    return have_wire && error != CM1E_ERROR_PERMISSION && error != CM1E_ERROR_UNSUPPORTED;
}

int main(void)
{
    need_real_time();
    have_wire = veth_make();
    UNITY_BEGIN();
    run_way("");
    if (have_xdp())
        run_way(",xdp");
    RUN_TEST(test_an_unknown_interface_is_named_with_those_that_exist);
    RUN_TEST(test_an_interface_that_is_down_is_diagnosed_with_the_cure);
    RUN_TEST(test_the_loopback_interface_is_refused);
    RUN_TEST(test_a_missing_privilege_is_diagnosed_with_the_cure);
    RUN_TEST(test_adapters_are_listed);
    return UNITY_END();
}
