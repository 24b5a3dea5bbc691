/* Errors between the simulated bridge and its motors (BR 7.4), and the console commands that make them. */
#include "sim_bridge_bench.h"

enum { MOTOR_ERROR = 0x4000, STATE_BITS = 0x4F, FAULT_BITS = 0x08 };

static cm1e_sim_segment_t *segment; /* a bridge, then an I/O module */
static bench_t b;
static char answer[1024];

void setUp(void)
{
    segment = cm1e_sim_segment_create_empty();
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_sim_segment_add(segment, cm1e_sim_bridge_create(CM1E_DEVICE_EB12, NULL, 0)));
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_sim_segment_add(segment, cm1e_sim_io_module_create()));
    b = (bench_t){.bridge = cm1e_sim_bridge_of(cm1e_sim_segment_slave(segment, 1)), .ops = &cm1e_sim_bridge_ops};
    b.now_ns = 1000 * (int64_t)BENCH_MS;
    cm1e_sim_segment_advance(segment, b.now_ns);
    bench_wait(&b, 100 * BENCH_MS);
    b.ops->state_change(b.bridge, BENCH_SAFEOP, BENCH_OP);
}
void tearDown(void) { cm1e_sim_segment_destroy(segment); }

static cm1e_error_t say(const char *line) { return cm1e_sim_console(segment, line, answer, sizeof answer); }
static void accept(const char *line) { TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, say(line), line); }

static void refuse(const char *line, const char *word)
{
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_ERROR_INVALID_ARGUMENT, say(line), line);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(answer, word), answer);
}

static void test_wrong_lines_are_refused_in_words(void)
{
    refuse("motor 1 0 unplug", "1 to 4");
    refuse("motor 1 5 unplug", "1 to 4");
    refuse("motor 1 x unplug", "1 to 4");
    refuse("motor 1 1 burn", "unplug, replug, broken, error, sensor or load");
    refuse("motor 1 1 unplug now", "too much");
    refuse("motor 1 1 broken", "number of answers");
    refuse("motor 1 1 broken -1", "number of answers");
    refuse("motor 1 1 error", "expected position");
    refuse("motor 1 1 error cold", "expected position");
    refuse("motor 1 1 broken 5 6", "too much");
    refuse("motor 1 1 sensor", "expected an input, 2 to 4");
    refuse("motor 1 2 sensor 1 on", "expected an input, 2 to 4"); /* a CM1's is the serial line */
    refuse("motor 1 3 sensor 7 on", "expected an input, 1 to 6");
    refuse("motor 1 3 sensor 2 up", "on, off or auto");
    refuse("motor 1 3 load heavy", "torque in Nm");
    refuse("motor 1 3 load 11", "torque in Nm");
    refuse("motor 1 3 load 1 2", "too much");
    refuse("motor 1 1", "usage");
    refuse("motor 2 1 unplug", "not a bridge");
    refuse("power 1 off", "not a CM1-E");
    bench_cycles(&b, 50);
    for (int axis = 0; axis < CM1E_BRIDGE_AXES; axis++)
        TEST_ASSERT_EQUAL_HEX16(0x40, b.axes[axis].statusword & STATE_BITS);
}

static void test_status_tells_of_every_motor(void)
{
    accept("status");
    TEST_ASSERT_NOT_NULL(strstr(answer, "1: EB12"));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(answer, "ID1 Switch on disabled, mode 8, position 0, motor 0x08"), answer);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(answer, "ID4 Switch on disabled, mode 8, position 0, motor 0x10"), answer);
    TEST_ASSERT_NOT_NULL(strstr(answer, "\n2: not a CM1-E"));
}

static void test_a_few_broken_answers_are_counted_and_no_more(void)
{
    bench_enable(&b, 1);
    accept("motor 1 2 broken 9");
    bench_cycles(&b, 50);
    TEST_ASSERT_EQUAL(9, bench_read(&b, 0xF530, 2));
    TEST_ASSERT_EQUAL(0, bench_read(&b, 0xF530, 1));
    TEST_ASSERT_EQUAL_HEX16(0x07, b.axes[1].statusword & STATE_BITS);
    TEST_ASSERT_EQUAL(bench_read(&b, 0xF530, 10) - 9, bench_read(&b, 0xF530, 14));
}

static void test_many_broken_answers_are_an_error_of_the_line(void)
{
    bench_enable(&b, 1);
    accept("motor 1 2 broken 10");
    bench_cycles(&b, 20);
    TEST_ASSERT_EQUAL(BRIDGE_STATUS_SERIAL_ERROR, bench_read(&b, 0xF530, 6));
    TEST_ASSERT_EQUAL_HEX16(FAULT_BITS, b.axes[1].statusword & STATE_BITS);
    b.axes[1].controlword = 0x80;
    bench_cycles(&b, 2);
    TEST_ASSERT_EQUAL(BRIDGE_STATUS_MOTOR_FREE, bench_read(&b, 0xF530, 6));
    bench_enable(&b, 1);
}

static void test_an_unplugged_motor_stands_and_is_not_heard_of(void)
{
    bench_enable(&b, 0);
    bench_enable(&b, 2);
    for (int n = 0; n < 200; n++) {
        b.axes[0].target += 20;
        if (n == 100)
            accept("motor 1 1 unplug");
        bench_cycles(&b, 1);
    }
    const int32_t shown = b.axes[0].position;
    TEST_ASSERT_EQUAL(BRIDGE_STATUS_SERIAL_ERROR, bench_read(&b, 0xF530, 5));
    TEST_ASSERT_EQUAL_HEX16(FAULT_BITS, b.axes[0].statusword & STATE_BITS);
    TEST_ASSERT_EQUAL_HEX16(MOTOR_ERROR, b.axes[0].statusword & MOTOR_ERROR);
    TEST_ASSERT_INT32_WITHIN(100, 2000, shown);
    TEST_ASSERT_EQUAL(shown, bench_read(&b, 0x6064, 0));
    bench_cycles(&b, 300);
    TEST_ASSERT_EQUAL_INT32(shown, b.axes[0].position);
    TEST_ASSERT_TRUE(bench_read(&b, 0xF530, 1) >= 390);
    TEST_ASSERT_EQUAL(0, bench_read(&b, 0xF530, 3));
    TEST_ASSERT_EQUAL_HEX16(0x07, b.axes[2].statusword & STATE_BITS); /* the others go on */

    b.axes[0].controlword = 0x80; /* a reset does not help as long as it is unplugged */
    bench_cycles(&b, 20);
    TEST_ASSERT_EQUAL_HEX16(FAULT_BITS, b.axes[0].statusword & STATE_BITS);
    accept("motor 1 1 replug");
    b.axes[0].controlword = 0;
    bench_cycles(&b, 20);
    TEST_ASSERT_EQUAL_HEX16(FAULT_BITS, b.axes[0].statusword & STATE_BITS);
    b.axes[0].controlword = 0x80;
    bench_cycles(&b, 2);
    bench_enable(&b, 0);
    TEST_ASSERT_INT32_WITHIN(100, shown, b.axes[0].position); /* it came to the last target that it heard */
    accept("motor 1 1 unplug");
    accept("motor 1 1 replug"); /* shorter than the bridge notices */
    bench_cycles(&b, 20);
    TEST_ASSERT_EQUAL_HEX16(0x07, b.axes[0].statusword & STATE_BITS);
}

static void test_errors_of_the_motor(void)
{
    static const struct {
        const char *name;
        uint8_t status;
    } rows[] = {{"position", 0x01}, {"over-speed", 0x02}, {"overload", 0x04}, {"temperature", 0x80}};
    refuse("motor 1 2 error over-current", "over-current of a CM2");
    accept("motor 1 3 error over-current");
    bench_wait(&b, 2 * BENCH_MS); /* no process data needed */
    TEST_ASSERT_EQUAL_HEX8(0x40, bench_read(&b, 0xF530, 7));
    TEST_ASSERT_EQUAL_HEX16(FAULT_BITS, bench_read(&b, 0x7041, 0) & STATE_BITS);
    b.axes[2].controlword = 0x80;
    bench_cycles(&b, 2);
    for (int i = 0; i < 4; i++) {
        char line[60];
        bench_enable(&b, i);
        snprintf(line, sizeof line, "motor 1 %d error %s", i + 1, rows[i].name);
        accept(line);
        bench_cycles(&b, 3);
        TEST_ASSERT_EQUAL_HEX8(rows[i].status, bench_read(&b, 0xF530, (uint8_t)(5 + i)));
        TEST_ASSERT_EQUAL_HEX16(MOTOR_ERROR, b.axes[i].statusword & MOTOR_ERROR);
        TEST_ASSERT_EQUAL_HEX16(FAULT_BITS, b.axes[i].statusword & STATE_BITS);
    }
}

static cm1e_sim_probe_t probe(unsigned channel)
{
    cm1e_sim_probe_t now;
    cm1e_sim_probe_channel(segment, 1, channel, &now);
    return now;
}

static void test_inputs_are_held_and_follow_the_axis_again(void)
{
    static const char *const how[] = {"on", "off", "auto"};
    for (int input = 1; input <= 6; input++)
        for (int n = 0; n < 3; n++) {
            char line[40];
            snprintf(line, sizeof line, "motor 1 4 sensor %d %s", input, how[n]);
            accept(line);
            TEST_ASSERT_EQUAL_HEX16(n == 0 ? 1u << (input - 1) : 0, probe(4).digital_inputs);
            TEST_ASSERT_EQUAL_HEX16(0, probe(3).digital_inputs);
        }
    b.bridge->axes[3].sensors.held = b.bridge->axes[3].sensors.values = 0xFF;
    TEST_ASSERT_EQUAL_HEX16(0x3F, probe(4).digital_inputs);
    b.bridge->axes[0].sensors.held = b.bridge->axes[0].sensors.values = 0xFF;
    TEST_ASSERT_EQUAL_HEX16(0x0E, probe(1).digital_inputs);
}

static void test_a_load_pulls_at_the_shaft(void)
{
    accept("motor 1 4 load 0.02"); /* a CM2 is free after power-on */
    bench_wait(&b, 200 * BENCH_MS);
    TEST_ASSERT_TRUE(probe(4).position_counts > 1000);
    TEST_ASSERT_TRUE(probe(4).travel_counts > 1000);
    TEST_ASSERT_FALSE(probe(4).torque_on);
    accept("motor 1 4 load 0");
    accept("motor 1 1 load -0.02"); /* a CM1 holds */
    bench_wait(&b, 200 * BENCH_MS);
    TEST_ASSERT_DOUBLE_WITHIN(2, 0, probe(1).position_counts);
    TEST_ASSERT_DOUBLE_WITHIN(0.006, 0.02, probe(1).torque_nm); /* friction takes its part */
}

/* Its target is the last position that was heard: the bridge may say that it is enabled, but the motor begins nothing. */
static void test_a_turning_motor_that_is_unplugged_begins_no_motion(void)
{
    static const uint16_t words[] = {0x06, 0x07, 0x0F};
    accept("motor 1 4 load 0.02"); /* a CM2 is free after power-on */
    bench_cycles(&b, 20);
    accept("motor 1 4 unplug");
    for (int i = 0; i < 3; i++) {
        b.axes[3].target = b.axes[3].position;
        b.axes[3].controlword = words[i];
        bench_cycles(&b, 2);
    }
    TEST_ASSERT_EQUAL_HEX16(0x07, b.axes[3].statusword & STATE_BITS);
    TEST_ASSERT_TRUE(probe(4).position_counts - b.axes[3].position > 100);
    TEST_ASSERT_FALSE(probe(4).torque_on);
    TEST_ASSERT_EQUAL_HEX(0, probe(4).broken_rules);
}

static void test_a_probe_tells_what_a_motor_really_does(void)
{
    bench_enable(&b, 1);
    for (int n = 0; n < 100; n++) {
        b.axes[1].target -= 50;
        bench_cycles(&b, 1);
    }
    cm1e_sim_probe_t now = probe(2);
    TEST_ASSERT_DOUBLE_WITHIN(200, -5000, now.position_counts);
    TEST_ASSERT_DOUBLE_WITHIN(1000, -50000, now.velocity_counts_per_s);
    TEST_ASSERT_TRUE(now.peak_velocity_counts_per_s > 49000);
    TEST_ASSERT_DOUBLE_WITHIN(20, -now.position_counts, now.travel_counts);
    TEST_ASSERT_TRUE(now.torque_on);
    TEST_ASSERT_EQUAL_HEX16(0x0F, now.controlword);
    TEST_ASSERT_EQUAL_HEX16(b.axes[1].statusword, now.statusword);
    TEST_ASSERT_EQUAL(8, now.mode);
    bench_cycles(&b, 200);
    cm1e_sim_probe_reset_channel(segment, 1, 2);
    TEST_ASSERT_EQUAL_DOUBLE(0, probe(2).travel_counts);
    accept("motor 1 2 error temperature");
    TEST_ASSERT_EQUAL_HEX16(BRIDGE_STATUS_TEMPERATURE, probe(2).error_code);
    for (unsigned channel = 0; channel < 6; channel += 5) { /* not there */
        now = probe(channel);
        TEST_ASSERT_EQUAL_HEX16(0, now.statusword);
        cm1e_sim_probe_reset_channel(segment, 1, channel);
    }
    cm1e_sim_probe_channel(NULL, 1, 1, &now);
    cm1e_sim_probe_channel(segment, 1, 1, NULL);
    cm1e_sim_probe_channel(segment, 2, 1, &now);
    TEST_ASSERT_EQUAL_HEX16(0, now.statusword);
}

static void test_no_cml_goes_to_an_unplugged_motor(void)
{
    uint8_t text[64];
    size_t size = sizeof text;
    bench_cycles(&b, 6);
    bench_write(&b, 0x6060, 0, 101);
    bench_cycles(&b, 6);
    accept("motor 1 1 unplug");
    TEST_ASSERT_EQUAL_HEX32(0, b.ops->sdo_write(b.bridge, 0xF581, 0, BENCH_OP, (const uint8_t *)"?99.1", 5));
    bench_cycles(&b, 9);
    TEST_ASSERT_EQUAL_HEX32(0, b.ops->sdo_read(b.bridge, 0xF591, 0, BENCH_OP, text, &size));
    TEST_ASSERT_EQUAL_MEMORY("Null\r\n", text, 6);
}

/* The data of a cycle are a millisecond on their way, to the nanosecond, whatever the steps of the simulation are. */
static void test_frames_that_come_a_little_early_do_not_jolt_a_motor(void)
{
    enum { STEP = 400, EARLY_NS = BENCH_MS - 1000 };
    bench_enable(&b, 1);
    for (int n = 0; n < STEP / 2; n++) {
        b.axes[1].target += n < STEP / 4 ? 4 * n : STEP;
        bench_cycles(&b, 1);
    }
    for (int n = 0; n < 100; n++) {
        b.axes[1].target += STEP;
        bench_cycle_after(&b, EARLY_NS);
        TEST_ASSERT_DOUBLE_WITHIN(0.005 * STEP * 1000, STEP * 1000, b.bridge->axes[1].mechanics.velocity);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_wrong_lines_are_refused_in_words);
    RUN_TEST(test_status_tells_of_every_motor);
    RUN_TEST(test_a_few_broken_answers_are_counted_and_no_more);
    RUN_TEST(test_many_broken_answers_are_an_error_of_the_line);
    RUN_TEST(test_an_unplugged_motor_stands_and_is_not_heard_of);
    RUN_TEST(test_errors_of_the_motor);
    RUN_TEST(test_no_cml_goes_to_an_unplugged_motor);
    RUN_TEST(test_inputs_are_held_and_follow_the_axis_again);
    RUN_TEST(test_a_load_pulls_at_the_shaft);
    RUN_TEST(test_a_turning_motor_that_is_unplugged_begins_no_motion);
    RUN_TEST(test_a_probe_tells_what_a_motor_really_does);
    RUN_TEST(test_frames_that_come_a_little_early_do_not_jolt_a_motor);
    return UNITY_END();
}
