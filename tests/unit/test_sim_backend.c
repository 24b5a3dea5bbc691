/* The backend "sim": opening, time of the wire, frame faults of the console, the ring; with the simulator's slaves. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <ethercat.h>
#include <unity.h>

#include "core/bytes.h"
#include "nic/nic.h"
#include "sim/segment_backend.h"
#include "sim/slave.h"

enum { N = 4, NS_PER_SLAVE = 1200, SHORT_FRAME_NS = (60 + 24) * 80, STATION = 0x1001, REGISTER_STATION = 0x0010,
       REGISTER_TYPE = 0x0000, REGISTER_AL_STATUS = 0x0130, RING = 2 };

static cm1e_bus_config_t config;
static cm1e_diag_t diag;
static cm1e_nic_t *nic;
static ecx_portt port;
static ecx_redportt red;

void setUp(void)
{
    cm1e_bus_config_free(&config);
    memset(&config, 0, sizeof config);
    memset(&diag, 0, sizeof diag);
    memset(&port, 0, sizeof port);
    config.virtual_time = true;
    nic = NULL;
}

void tearDown(void)
{
    cm1e_nic_close(nic);
    nic = NULL;
}

static int64_t now(void) { return cm1e_clock_now(cm1e_nic_clock(nic)); }

/** Opens "sim" and puts `slaves` I/O modules in the place of its segment. */
static void open_io_modules(int slaves, int ports)
{
    strcpy(config.second_interface, ports == RING ? "sim" : "");
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, cm1e_nic_open(&nic, &config, &diag), diag.text);
    cm1e_sim_segment_t *segment = cm1e_sim_segment_create_empty();
    TEST_ASSERT_NOT_NULL(segment);
    for (int i = 0; i < slaves; i++)
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_sim_segment_add(segment, cm1e_sim_io_module_create()));
    if (ports == RING)
        cm1e_sim_segment_close_ring(segment);
    cm1e_sim_replace_segment(nic, segment);
    port.nic = nic;
    if (ports == RING) {
        ecx_contextt context = {.port = &port};
        TEST_ASSERT_EQUAL_INT(1, ecx_init_redundant(&context, &red, "sim", (char[]){"sim"}));
    } else
        TEST_ASSERT_EQUAL_INT(1, ecx_setupnic(&port, "sim", FALSE));
}

static int broadcast(int timeout)
{
    uint16_t data = 0;
    return ecx_BRD(&port, 0, REGISTER_TYPE, 2, &data, timeout);
}

static void set_stations(void)
{
    for (int i = 0; i < N; i++)
        TEST_ASSERT_EQUAL_INT(1, ecx_APWRw(&port, (uint16)-i, REGISTER_STATION, (uint16)(STATION + i), EC_TIMEOUTRET));
}

static void console(const char *line)
{
    char answer[256];
    const cm1e_error_t error = cm1e_sim_console(cm1e_sim_segment_of(nic), line, answer, sizeof answer);
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, error, answer);
}

/* ---- opening ----------------------------------------------------------------------------------------------------- */

static void test_no_name_and_no_axes_is_one_cm1e(void)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, cm1e_nic_open(&nic, &config, &diag), diag.text);
    TEST_ASSERT_EQUAL_UINT32(1, cm1e_sim_segment_slave_count(cm1e_sim_segment_of(nic)));
    TEST_ASSERT_EQUAL_INT64(0, now());
}

static void test_the_axes_of_the_configuration_are_the_slaves(void)
{
    for (uint32_t axes = 1; axes <= 16; axes *= 4) {
        cm1e_bus_config_free(&config);
        cm1e_bus_config_init(&config, "sim", axes);
        config.virtual_time = true;
        TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, cm1e_nic_open(&nic, &config, &diag), diag.text);
        TEST_ASSERT_EQUAL_UINT32(axes, cm1e_sim_segment_slave_count(cm1e_sim_segment_of(nic)));
        tearDown();
    }
}

static void test_a_bus_file_describes_the_segment(void)
{
    const char *path = CM1E_TEST_OUTPUT "/test_nic_sim.yaml";
    FILE *f = fopen(path, "w");
    TEST_ASSERT_NOT_NULL(f);
    fputs("axes:\n  - name: x\n  - name: y\n  - name: z\n", f);
    fclose(f);
    if (strlen(path) + 5 > sizeof config.interface_name)
        TEST_IGNORE_MESSAGE("the build folder's name is too long for an interface name");
    snprintf(config.interface_name, sizeof config.interface_name, "sim:%s", path);
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, cm1e_nic_open(&nic, &config, &diag), diag.text);
    TEST_ASSERT_EQUAL_UINT32(3, cm1e_sim_segment_slave_count(cm1e_sim_segment_of(nic)));
}

static void test_a_bus_file_that_is_missing_is_named(void)
{
    strcpy(config.interface_name, "sim:/nowhere/bus.yaml");
    TEST_ASSERT_NOT_EQUAL(CM1E_OK, cm1e_nic_open(&nic, &config, &diag));
    TEST_ASSERT_NULL(nic);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, "/nowhere/bus.yaml"), diag.text);
}

static void test_a_network_interface_called_simple_is_not_the_simulator(void)
{
    strcpy(config.interface_name, "simple0");
    TEST_ASSERT_NOT_EQUAL(CM1E_OK, cm1e_nic_open(&nic, &config, &diag));
}

/* ---- time -------------------------------------------------------------------------------------------------------- */

static void test_an_exchange_costs_the_time_of_the_wire(void)
{
    static const int slaves[] = {1, 4, 16};
    for (size_t i = 0; i < sizeof slaves / sizeof slaves[0]; i++) {
        setUp();
        open_io_modules(slaves[i], 1);
        const int64_t before = now();
        TEST_ASSERT_EQUAL_INT(slaves[i], broadcast(EC_TIMEOUTRET));
        TEST_ASSERT_EQUAL_INT64(before + SHORT_FRAME_NS + slaves[i] * NS_PER_SLAVE, now());
        /* Two frames at once: the wire is one, the second waits for the first. */
        uint8 idx[2];
        uint16_t zero = 0;
        const int64_t second = now();
        for (int f = 0; f < 2; f++) {
            idx[f] = ecx_getindex(&port);
            ecx_setupdatagram(&port, &port.txbuf[idx[f]], EC_CMD_BRD, idx[f], 0, 0, 2, &zero);
            ecx_outframe_red(&port, idx[f]);
        }
        TEST_ASSERT_EQUAL_INT(slaves[i], ecx_waitinframe(&port, idx[1], 1000));
        TEST_ASSERT_EQUAL_INT64(second + 2 * SHORT_FRAME_NS + slaves[i] * NS_PER_SLAVE, now());
        TEST_ASSERT_EQUAL_INT(slaves[i], ecx_waitinframe(&port, idx[0], 0));
        tearDown();
    }
}

static void test_without_slaves_a_frame_costs_exactly_its_timeout(void)
{
    open_io_modules(0, 1);
    int64_t expected = now();
    for (int timeout = 1; timeout < 5000; timeout = timeout * 2 + 1) {
        const int wkc = broadcast(timeout);
        TEST_ASSERT_LESS_OR_EQUAL_INT(0, wkc);
        if (wkc == EC_NOFRAME)
            TEST_ASSERT_EQUAL_INT64(expected + timeout * 1000, now());
        expected = now();
    }
}

static void test_on_real_time_a_lost_frame_is_really_waited_for(void)
{
    config.virtual_time = false;
    open_io_modules(N, 1);
    TEST_ASSERT_EQUAL_PTR(cm1e_clock_monotonic(), cm1e_nic_clock(nic));
    TEST_ASSERT_EQUAL_INT(N, broadcast(EC_TIMEOUTRET));
    console("lose 1");
    const int64_t before = now();
    TEST_ASSERT_EQUAL_INT(EC_NOFRAME, broadcast(1500));
    TEST_ASSERT_GREATER_OR_EQUAL_INT64(1500000, now() - before);
}

static void test_answers_that_nobody_takes_do_not_pile_up(void)
{
    open_io_modules(N, 1);
    uint16_t zero = 0;
    for (int i = 0; i < 5000; i++) {
        const uint8 idx = ecx_getindex(&port);
        ecx_setupdatagram(&port, &port.txbuf[idx], EC_CMD_BRD, idx, 0, 0, 2, &zero);
        TEST_ASSERT_GREATER_THAN_INT(0, ecx_outframe_red(&port, idx));
        ecx_setbufstat(&port, idx, EC_BUF_EMPTY);
    }
    cm1e_clock_sleep_until(cm1e_nic_clock(nic), now() + 1000000000);
    for (int i = 0; i < 3; i++)
        TEST_ASSERT_EQUAL_INT(N, broadcast(EC_TIMEOUTRET));
    TEST_ASSERT_GREATER_THAN_UINT64(0, port.counters.late);
}

/* ---- faults of the console --------------------------------------------------------------------------------------- */

static void test_lost_corrupted_and_delayed_frames_of_the_console(void)
{
    open_io_modules(N, 1);
    console("lose 2");
    TEST_ASSERT_EQUAL_INT(EC_NOFRAME, broadcast(100));
    TEST_ASSERT_EQUAL_INT(EC_NOFRAME, broadcast(100));
    TEST_ASSERT_EQUAL_INT(N, broadcast(100));
    console("corrupt 2");
    TEST_ASSERT_EQUAL_INT(EC_NOFRAME, broadcast(100));
    TEST_ASSERT_EQUAL_INT(EC_NOFRAME, broadcast(100));
    TEST_ASSERT_EQUAL_INT(N, broadcast(100));
    TEST_ASSERT_EQUAL_UINT64(2, port.counters.malformed);
    console("delay 1 500");
    const int64_t before = now();
    TEST_ASSERT_EQUAL_INT(N, broadcast(EC_TIMEOUTRET));
    TEST_ASSERT_EQUAL_INT64(before + 500000 + SHORT_FRAME_NS + N * NS_PER_SLAVE, now());
    TEST_ASSERT_EQUAL_INT(N, broadcast(100));
}

/* ---- ring -------------------------------------------------------------------------------------------------------- */

static void check_ring(const char *message)
{
    for (int i = 0; i < 3; i++)
        TEST_ASSERT_EQUAL_INT_MESSAGE(N, broadcast(EC_TIMEOUTRET), message);
    set_stations();
    for (int i = 0; i < N; i++) {
        uint16_t station = 0;
        TEST_ASSERT_EQUAL_INT_MESSAGE(
            1, ecx_FPRD(&port, (uint16)(STATION + i), REGISTER_STATION, 2, &station, EC_TIMEOUTRET), message);
        TEST_ASSERT_EQUAL_HEX16_MESSAGE(STATION + i, station, message);
        station = 0;
        TEST_ASSERT_EQUAL_INT_MESSAGE(1, ecx_APRD(&port, (uint16)-i, REGISTER_STATION, 2, &station, EC_TIMEOUTRET),
                                      message);
        TEST_ASSERT_EQUAL_HEX16_MESSAGE(STATION + i, station, message);
    }
    int64_t before = now();
    TEST_ASSERT_EQUAL_INT_MESSAGE(N, broadcast(EC_TIMEOUTRET), message);
    TEST_ASSERT_LESS_OR_EQUAL_INT64_MESSAGE(SHORT_FRAME_NS + N * NS_PER_SLAVE, now() - before, message);
}

static void test_the_ring_works_with_any_cable_cut_and_after_mending(void)
{
    open_io_modules(N, RING);
    check_ring("intact");
    for (uint32_t place = 1; place <= N + 1; place++) {
        char message[40];
        snprintf(message, sizeof message, "cut before slave %u", place);
        cm1e_sim_segment_cut(cm1e_sim_segment_of(nic), place, true);
        check_ring(message);
        cm1e_sim_segment_cut(cm1e_sim_segment_of(nic), place, false);
        snprintf(message, sizeof message, "mended before slave %u", place);
        check_ring(message);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_no_name_and_no_axes_is_one_cm1e);
    RUN_TEST(test_the_axes_of_the_configuration_are_the_slaves);
    RUN_TEST(test_a_bus_file_describes_the_segment);
    RUN_TEST(test_a_bus_file_that_is_missing_is_named);
    RUN_TEST(test_a_network_interface_called_simple_is_not_the_simulator);
    RUN_TEST(test_an_exchange_costs_the_time_of_the_wire);
    RUN_TEST(test_without_slaves_a_frame_costs_exactly_its_timeout);
    RUN_TEST(test_on_real_time_a_lost_frame_is_really_waited_for);
    RUN_TEST(test_answers_that_nobody_takes_do_not_pile_up);
    RUN_TEST(test_lost_corrupted_and_delayed_frames_of_the_console);
    RUN_TEST(test_the_ring_works_with_any_cable_cut_and_after_mending);
    return UNITY_END();
}
