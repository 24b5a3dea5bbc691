/** The console of the simulated segment: every command, every kind of wrong line, and what a test measures behind. */
#include <locale.h>
#include <stdio.h>
#include <string.h>

#include "sim/cm1e_app.h"
#include "unity.h"

enum { SLAVES = 4, MS = 1000000 }; /* three CM1-E, then an I/O module */

static cm1e_sim_segment_t *segment;
static char answer[4096];
static int64_t now_ns;

void setUp(void)
{
    static const cm1e_axis_config_t config;
    segment = cm1e_sim_segment_create_empty();
    for (int i = 1; i < SLAVES; i++)
        TEST_ASSERT_EQUAL(CM1E_OK, cm1e_sim_segment_add(
                                       segment, cm1e_sim_cm1e_create(&config, CM1E_PDO_ORDER_UG_4_4, 0, 0)));
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_sim_segment_add(segment, cm1e_sim_io_module_create()));
    now_ns = 1000 * (int64_t)MS;
    cm1e_sim_segment_advance(segment, now_ns);
}

void tearDown(void) { cm1e_sim_segment_destroy(segment); }

static cm1e_sim_cm1e_t *drive(uint32_t position) { return cm1e_sim_cm1e_of(cm1e_sim_segment_slave(segment, position)); }

static void pass(double ms)
{
    for (const int64_t end_ns = now_ns + (int64_t)(ms * MS); now_ns < end_ns;)
        cm1e_sim_segment_advance(segment, now_ns += MS);
}

static cm1e_error_t say(const char *line)
{
    memset(answer, '#', sizeof answer);
    const cm1e_error_t error = cm1e_sim_console(segment, line, answer, sizeof answer);
    TEST_ASSERT_NOT_NULL_MESSAGE(memchr(answer, 0, sizeof answer), "the answer has no end");
    TEST_ASSERT_TRUE_MESSAGE(answer[0] != '\0', "every line is answered");
    TEST_ASSERT_TRUE_MESSAGE(answer[strlen(answer) - 1] != '\n', "no trailing newline");
    return error;
}

static void accept(const char *line) { TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, say(line), line); }

static void test_help_lists_every_command(void)
{
    static const char *const words[] = {"help", "status", "show", "power", "switches", "sensor", "load", "over-torque",
                                        "temperature", "error", "power-up-fault", "motor", "power-cycle", "unplug",
                                        "replug", "input", "clock", "lose", "corrupt", "delay"};
    accept("help");
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++)
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(answer, words[i]), words[i]);
    for (const char *line = answer; line; line = strchr(line + 1, '\n'))
        TEST_ASSERT_TRUE(strcspn(line + 1, "\n") < 120);
}

/* What the answer must say, so that the user knows what was expected. */
static void test_wrong_lines_are_refused_in_words(void)
{
    static const struct {
        const char *line, *words;
    } rows[] = {
        {"", "empty"}, {"   \t ", "empty"}, {"hello", "\"hello\" is not a command"}, {"POWER 1 off", "not a command"},
        {"power", "slave is missing"}, {"power 0 off", "1 to 4"}, {"power 5 off", "1 to 4"}, {"power -1 off", "1 to 4"},
        {"power 1x off", "1 to 4"}, {"power x off", "1 to 4"}, {"power 99999999999999999999 off", "1 to 4"},
        {"power 1", "usage: power <slave> on|off"}, {"power 1 maybe", "on or off"}, {"power 1 off now", "too much"},
        {"input 1 1 on", "no simulated inputs"}, {"input 1 1", "usage"}, {"input 9 1 on", "1 to 4"},
        {"power 4 off", "not a CM1-E"}, {"power off 1", "1 to 4"},
        {"switches 1 100", "00 to FF"}, {"switches 1 G1", "00 to FF"}, {"switches 1 -1", "00 to FF"},
        {"switches 1 0x", "00 to FF"}, {"switches 1 0x-1", "00 to FF"}, {"switches 1 B5 B6", "too much"},
        {"sensor 1 0 on", "1 to 4"}, {"sensor 1 5 on", "1 to 4"}, {"sensor 1 2 up", "on, off or auto"},
        {"sensor 1 2", "usage"}, {"load 1 heavy", "Nm"}, {"load 1 nan", "Nm"}, {"load 1 inf", "Nm"},
        {"load 1 11", "-10 to 10"}, {"load 1 0.1Nm", "Nm"}, {"load 1", "usage"}, {"over-torque 1 5", "too much"},
        {"temperature 1 hot", "degrees"}, {"temperature 1 201", "200"}, {"temperature 1 20.5", "degrees"},
        {"error 1", "usage"}, {"error 1 1234", "2310 4310"}, {"error 1 7310 forever", "expected hold"},
        {"error 1 clear hold", "clear"}, {"error 1 73100", "7310"}, {"error 1 7310 hold on", "too much"},
        {"power-up-fault 1 never", "always"}, {"power-up-fault 1 -1", "0 to 1000"}, {"power-up-fault 1", "usage"},
        {"power-cycle 1 0", "1 to 60000"}, {"power-cycle 1 60001", "1 to 60000"}, {"power-cycle", "slave is missing"},
        {"unplug", "slave is missing"}, {"unplug 1 2", "expected \"behind\""}, {"unplug 1 behind it", "too much"}, {"replug 9", "1 to 4"},
        {"lose", "usage"}, {"lose many", "frames"}, {"lose -1", "frames"}, {"lose 1000001", "1000000"},
        {"clock 1", "usage"}, {"clock 1 fast", "drift, temperature"}, {"clock 1 drift", "ppm, -500 to 500"},
        {"clock 1 drift 501", "ppm, -500 to 500"}, {"clock 1 free 3", "too much behind free"},
        {"lose 1 2", "too much"}, {"corrupt", "usage"}, {"delay 1", "usage"}, {"delay 1 0", "1 to 1000000"},
        {"delay 1 x", "microseconds"}, {"status 9", "1 to 4"}, {"status 1 2", "too much"}, {"show", "slave is missing"},
        {"show 4", "not a CM1-E"}, {"help me", "too much"}, {"1 2 3 4 5 6 7 8", "help"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        TEST_ASSERT_EQUAL_MESSAGE(CM1E_ERROR_INVALID_ARGUMENT, say(rows[i].line), rows[i].line);
        if (!strstr(answer, rows[i].words)) {
            char text[300];
            snprintf(text, sizeof text, "\"%s\" answered \"%.150s\", without \"%s\"", rows[i].line, answer,
                     rows[i].words);
            TEST_FAIL_MESSAGE(text);
        }
        TEST_ASSERT_NULL_MESSAGE(strchr(answer, '#'), rows[i].line);
    }
    pass(10);
    for (uint32_t i = 1; i < SLAVES; i++) {
        TEST_ASSERT_TRUE_MESSAGE(drive(i)->motor_power, "a refused line acted");
        TEST_ASSERT_EQUAL_HEX16_MESSAGE(0, drive(i)->fsa.fault_code, "a refused line acted");
    }
}

static void test_motor_power(void)
{
    accept("power 2 off");
    TEST_ASSERT_TRUE(drive(1)->motor_power);
    TEST_ASSERT_FALSE(drive(2)->motor_power);
    cm1e_sim_probe_t probe;
    cm1e_sim_probe(segment, 2, &probe);
    TEST_ASSERT_EQUAL_HEX16(0xFF05, probe.error_code);
    TEST_ASSERT_EQUAL(0, probe.statusword & 0x10);
    accept("  power\t2  on \r\n");
    TEST_ASSERT_TRUE(drive(2)->motor_power);
}

static void test_rotary_switches(void)
{
    accept("switches 1 B5");
    TEST_ASSERT_EQUAL_HEX8(0xB5, drive(1)->rotary_switches);
    accept("switches 1 0xfe");
    TEST_ASSERT_EQUAL_HEX8(0xFE, drive(1)->rotary_switches);
    accept("switches 1 FF");
    TEST_ASSERT_NOT_NULL(strstr(answer, "reserved"));
    accept("switches 1 0");
    TEST_ASSERT_EQUAL_HEX8(0, drive(1)->rotary_switches);
}

static void test_sensors(void)
{
    for (int input = 1; input <= 4; input++) {
        char line[40];
        snprintf(line, sizeof line, "sensor 3 %d on", input);
        accept(line);
        TEST_ASSERT_EQUAL_HEX16(1 << (input - 1), cm1e_sim_digital_inputs(drive(3)));
        snprintf(line, sizeof line, "sensor 3 %d auto", input);
        accept(line);
        TEST_ASSERT_EQUAL_HEX16(0, cm1e_sim_digital_inputs(drive(3)));
    }
    drive(3)->mechanics.position = 200000;
    TEST_ASSERT_EQUAL_HEX16(2, cm1e_sim_digital_inputs(drive(3)));
    accept("sensor 3 2 off");
    TEST_ASSERT_EQUAL_HEX16(0, cm1e_sim_digital_inputs(drive(3)));
    accept("sensor 3 2 auto");
    TEST_ASSERT_EQUAL_HEX16(2, cm1e_sim_digital_inputs(drive(3)));
}

static void test_load_drives_a_motor_without_torque(void)
{
    accept("load 1 -0.02");
    pass(2000);
    cm1e_sim_probe_t probe;
    cm1e_sim_probe(segment, 1, &probe);
    TEST_ASSERT_EQUAL_DOUBLE(-250000, probe.position_counts);
    TEST_ASSERT_EQUAL_DOUBLE(250000, probe.travel_counts);
    TEST_ASSERT_TRUE(probe.peak_velocity_counts_per_s > 100000);
    accept("load 1 0");
    cm1e_sim_probe_reset(segment, 1);
    pass(100);
    cm1e_sim_probe(segment, 1, &probe);
    TEST_ASSERT_EQUAL_DOUBLE(0, probe.travel_counts);
    TEST_ASSERT_EQUAL_DOUBLE(0, probe.peak_velocity_counts_per_s);
}

/* Every code of UG 7.3.1 can be had, and goes again. */
static void test_every_error_code(void)
{
    for (size_t i = 0; i < cm1e_device_error_count; i++) {
        const cm1e_device_error_t *error = &cm1e_device_errors[i];
        if (error->code == 0)
            continue;
        char line[40];
        snprintf(line, sizeof line, "error 1 %04X", error->code);
        accept(line);
        TEST_ASSERT_TRUE(strstr(answer, error->text) || strstr(answer, "motor power off (0xFF05)"));
        pass(5);
        cm1e_sim_probe_t probe;
        cm1e_sim_probe(segment, 1, &probe);
        TEST_ASSERT_EQUAL_HEX16(error->code, probe.error_code);
        TEST_ASSERT_EQUAL(error->fault && !error->fault_only_when_enabled, (probe.statusword & 8) != 0);
        accept("error 1 clear");
        accept("power 1 on");
        accept("power-cycle 1 1");
        pass(5);
        cm1e_sim_probe(segment, 1, &probe);
        TEST_ASSERT_EQUAL_HEX16(0x4502, probe.error_code);
    }
}

static void test_a_held_error_outlives_a_power_cycle(void)
{
    accept("error 1 FF04 hold");
    accept("power-cycle 1 10");
    pass(50);
    cm1e_sim_probe_t probe;
    cm1e_sim_probe(segment, 1, &probe);
    TEST_ASSERT_EQUAL_HEX16(0xFF04, probe.error_code);
    accept("error 1 clear");
    accept("power-cycle 1 10");
    pass(50);
    cm1e_sim_probe(segment, 1, &probe);
    TEST_ASSERT_EQUAL_HEX16(0x4502, probe.error_code);
}

static void test_overload_and_temperature(void)
{
    cm1e_sim_probe_t probe;
    accept("over-torque 1");
    cm1e_sim_probe(segment, 1, &probe);
    TEST_ASSERT_EQUAL_HEX16(0x2310, probe.error_code);
    accept("temperature 2 84");
    cm1e_sim_probe(segment, 2, &probe);
    TEST_ASSERT_EQUAL_HEX16(0x4502, probe.error_code);
    accept("temperature 2 85");
    cm1e_sim_probe(segment, 2, &probe);
    TEST_ASSERT_EQUAL_HEX16(0x4310, probe.error_code);
}

static void test_power_up_fault(void)
{
    accept("power-up-fault 1 1");
    TEST_ASSERT_EQUAL_HEX16(0, drive(1)->fsa.fault_code);
    accept("power-cycle 1 10");
    pass(50);
    TEST_ASSERT_EQUAL_HEX16(0x7510, drive(1)->fsa.fault_code);
    accept("power-cycle 1 10");
    pass(50);
    TEST_ASSERT_EQUAL_HEX16(0, drive(1)->fsa.fault_code);
    accept("power-up-fault 1 always");
    for (int i = 0; i < 3; i++) {
        accept("power-cycle 1 10");
        pass(50);
        TEST_ASSERT_EQUAL_HEX16(0x7510, drive(1)->fsa.fault_code);
    }
}

static void test_power_cycle_stops_torque_and_lets_the_axis_run_out(void)
{
    cm1e_sim_cm1e_t *d = drive(1);
    d->mechanics.velocity = 500000;
    accept("power-cycle 1 400");
    TEST_ASSERT_FALSE(d->fsa.state == OPERATION_ENABLED);
    pass(500);
    TEST_ASSERT_DOUBLE_WITHIN(2000, 17000, d->mechanics.position);
    TEST_ASSERT_EQUAL_DOUBLE(0, d->mechanics.velocity);
    const cm1e_sim_app_ops_t *ops = cm1e_sim_cm1e_ops(d);
    for (int i = 0; i < 20; i++) {
        uint8_t image[13] = {0x0F, [12] = CM1E_MODE_CSP};
        pass(1);
        ops->outputs(d, image, sizeof image, now_ns);
    }
    cm1e_sim_probe_t probe;
    cm1e_sim_probe(segment, 1, &probe);
    TEST_ASSERT_TRUE(probe.torque_on);
    accept("power-cycle 1");
    cm1e_sim_probe(segment, 1, &probe);
    TEST_ASSERT_FALSE(probe.torque_on);
    accept("power-cycle 4");
    TEST_ASSERT_NOT_NULL(strstr(answer, "500 ms"));
}

static void test_frame_faults_are_taken_one_by_one(void)
{
    static const struct {
        const char *line;
        cm1e_frame_fault_t kind;
        int64_t delay_ns;
    } rows[] = {{"lose 3", CM1E_FRAME_LOSE, 0}, {"corrupt 3", CM1E_FRAME_CORRUPT, 0},
                {"delay 3 250", CM1E_FRAME_DELAY, 250000}};
    for (int i = 0; i < 3; i++) {
        accept(rows[i].line);
        for (int n = 0; n < 3; n++) {
            int64_t delay_ns = 0;
            TEST_ASSERT_EQUAL(rows[i].kind, cm1e_sim_segment_next_frame_fault(segment, &delay_ns));
            if (rows[i].kind == CM1E_FRAME_DELAY)
                TEST_ASSERT_EQUAL_INT64(rows[i].delay_ns, delay_ns);
        }
        int64_t delay_ns = 0;
        TEST_ASSERT_EQUAL(CM1E_FRAME_OK, cm1e_sim_segment_next_frame_fault(segment, &delay_ns));
    }
    accept("lose 5");
    accept("lose 0");
    int64_t delay_ns;
    TEST_ASSERT_EQUAL(CM1E_FRAME_OK, cm1e_sim_segment_next_frame_fault(segment, &delay_ns));
}

/* A BRD of the AL status counts who is there: 14 bytes Ethernet, 2 EtherCAT, 10 datagram, data, working counter. */
static int slaves_that_answer(void)
{
    uint8_t frame[60] = {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 1, 1, 1, 1, 1, 1, 0x88, 0xA4, 14, 0x10,
                         7, 0, 0, 0, 0x30, 0x01, 2, 0, 0, 0};
    now_ns += MS;
    if (cm1e_sim_segment_process(segment, CM1E_SIM_PORT_PRIMARY, frame, sizeof frame, now_ns) != CM1E_SIM_PORT_PRIMARY)
        return -1;
    return frame[28] | frame[29] << 8;
}

static void test_unplugged_and_power_cycled_slaves_are_gone_and_come_back(void)
{
    TEST_ASSERT_EQUAL(4, slaves_that_answer());
    accept("unplug 3");
    TEST_ASSERT_EQUAL(2, slaves_that_answer());
    accept("replug 3");
    pass(10);
    TEST_ASSERT_EQUAL(4, slaves_that_answer());
    accept("power-cycle 2 20");
    TEST_ASSERT_EQUAL(1, slaves_that_answer());
    pass(50);
    TEST_ASSERT_EQUAL(4, slaves_that_answer());
}

static void test_numbers_have_a_point_in_every_locale(void)
{
    if (!setlocale(LC_ALL, "de_DE.UTF-8"))
        TEST_IGNORE_MESSAGE("there is no locale with a decimal comma on this machine");
    accept("load 1 0.25");
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(answer, "0.25 Nm"), answer);
    TEST_ASSERT_TRUE(say("load 1 0,25") != CM1E_OK);
    accept("clock 1 drift 1.5");
    TEST_ASSERT_EQUAL_STRING("de_DE.UTF-8", setlocale(LC_ALL, NULL));
    TEST_ASSERT_EQUAL_STRING(",", localeconv()->decimal_point); /* that of the caller is back */
    setlocale(LC_ALL, "C");
}

static void test_status_and_show(void)
{
    accept("status");
    TEST_ASSERT_NOT_NULL(strstr(answer, "1: CM1-E-17S30D V1.3.5, INIT, Not ready to switch on, no mode"));
    TEST_ASSERT_NOT_NULL(strstr(answer, "4: not a CM1-E"));
    accept("status 2");
    TEST_ASSERT_NULL(strchr(answer, '\n'));
    accept("show 2");
    TEST_ASSERT_NOT_NULL(strstr(answer, "No mode selected"));
}

static void test_answers_never_leave_their_room(void)
{
    static const char *const lines[] = {"help", "status", "show 1", "power 1 off", "error 1 9999", "nonsense", ""};
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++)
        for (size_t size = 0; size < 300; size++) {
            char room[301];
            memset(room, '#', sizeof room);
            cm1e_sim_console(segment, lines[i], room, size);
            TEST_ASSERT_EQUAL('#', room[size]);
            if (size > 0)
                TEST_ASSERT_NOT_NULL(memchr(room, 0, size));
            if (size > 4 && i == 0) /* help is longer than any of these */
                TEST_ASSERT_EQUAL_STRING("...", room + size - 4);
        }
}

static void test_random_lines_do_no_harm(void)
{
    static const char *const words[] = {"power", "error", "1", "2", "4", "on", "off", "clear", "hold", "7510", "FF05",
                                        "sensor", "load", "-0.1", "1e300", "power-cycle", "unplug", "replug", "lose",
                                        "delay", "status", "show", "help", "always", "power-up-fault", "temperature",
                                        "%s%n", "\x01\xFF", "999999999999999999999999"};
    uint64_t seed = 20250328;
    for (int i = 0; i < 20000; i++) {
        char line[400] = "";
        seed = seed * UINT64_C(6364136223846793005) + 1442695040888963407u;
        const unsigned count = (unsigned)(seed >> 60);
        for (unsigned n = 0; n < count; n++) {
            seed = seed * UINT64_C(6364136223846793005) + 1442695040888963407u;
            strncat(line, words[(seed >> 33) % (sizeof words / sizeof words[0])], 30);
            strcat(line, seed >> 62 ? " " : "");
        }
        say(line);
        if (i % 50 == 0)
            pass(2);
    }
    static char endless[100000];
    memset(endless, 'a', sizeof endless - 1);
    TEST_ASSERT_EQUAL(CM1E_ERROR_INVALID_ARGUMENT, say(endless));
}

static void test_probe_of_nothing_is_zero(void)
{
    cm1e_sim_probe_t probe;
    static const cm1e_sim_probe_t zero;
    const uint32_t positions[] = {0, 4, 5, UINT32_MAX};
    for (int i = 0; i < 4; i++) {
        memset(&probe, 0x55, sizeof probe);
        cm1e_sim_probe(segment, positions[i], &probe);
        TEST_ASSERT_EQUAL_DOUBLE(zero.position_counts, probe.position_counts);
        TEST_ASSERT_EQUAL(0, probe.statusword);
        cm1e_sim_probe_reset(segment, positions[i]);
    }
    cm1e_sim_probe(NULL, 1, &probe);
    TEST_ASSERT_FALSE(probe.torque_on);
    cm1e_sim_probe(segment, 1, NULL);
    cm1e_sim_probe_reset(NULL, 1);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_help_lists_every_command);
    RUN_TEST(test_wrong_lines_are_refused_in_words);
    RUN_TEST(test_motor_power);
    RUN_TEST(test_rotary_switches);
    RUN_TEST(test_sensors);
    RUN_TEST(test_load_drives_a_motor_without_torque);
    RUN_TEST(test_every_error_code);
    RUN_TEST(test_a_held_error_outlives_a_power_cycle);
    RUN_TEST(test_overload_and_temperature);
    RUN_TEST(test_power_up_fault);
    RUN_TEST(test_power_cycle_stops_torque_and_lets_the_axis_run_out);
    RUN_TEST(test_frame_faults_are_taken_one_by_one);
    RUN_TEST(test_unplugged_and_power_cycled_slaves_are_gone_and_come_back);
    RUN_TEST(test_numbers_have_a_point_in_every_locale);
    RUN_TEST(test_status_and_show);
    RUN_TEST(test_answers_never_leave_their_room);
    RUN_TEST(test_random_lines_do_no_harm);
    RUN_TEST(test_probe_of_nothing_is_zero);
    return UNITY_END();
}
