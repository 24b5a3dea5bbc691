/** Homing of the simulated CM1-E on its axis: every method from many places, bit by bit (UG 6.2.4). */
#include <math.h>
#include <stdio.h>

#include "sim_cm1e_bench.h"

void setUp(void) {}
void tearDown(void) {}

enum { HM = 6, CSP = 8 };
enum { BIT10 = 0x0400, BIT12 = 0x1000, BIT13 = 0x2000, BITS = BIT10 | BIT12 | BIT13 };
enum { IN_PROGRESS = 0, INTERRUPTED = BIT10, ATTAINED = BIT12, DONE = BIT10 | BIT12, ERROR_MOVING = BIT13,
       ERROR_STANDING = BIT10 | BIT13, ERROR_AFTER_HOMING = BIT10 | BIT12 | BIT13 };

typedef struct place {
    int method;
    double sensor; /* counts; 0: hard stop */
    double direction;
} place_t;

/* Both sensors on the side that the method searches towards. */
static const place_t places[] = {
    {-1, 0, 1}, {-2, 0, -1}, {-3, 150000, 1}, {-4, -120000, -1}, {-5, 130000, 1}, {-6, -150000, -1},
};
enum { PLACES = 6 };

static cm1e_axis_config_t axis_for(const place_t *place)
{
    cm1e_axis_config_t config = {0};
    if (place->method == -3 || place->method == -4)
        config.sim.sensor_input2 = place->sensor;
    if (place->method == -5 || place->method == -6)
        config.sim.sensor_input3 = place->sensor;
    return config;
}

static void open_at(bench_t *b, const place_t *place, double start)
{
    const cm1e_axis_config_t config = axis_for(place);
    bench_open(b, &config, CM1E_PDO_ORDER_UG_4_4);
    b->drive->mechanics.position = start;
    bench_write(b, 0x6098, 0, place->method);
    bench_enable(b, HM);
}

static double shaft(const bench_t *b) { return b->drive->mechanics.position; }

static void begin(bench_t *b)
{
    b->controlword = 0x0F;
    bench_cycle(b);
    b->controlword = 0x1F;
    bench_cycle(b);
}

static bool home(bench_t *b)
{
    begin(b);
    return bench_until(b, BIT10, BIT10, 60) && (b->statusword & BITS) == DONE;
}

/* Where 0 must be: at the sensor's edge, or one to two encoder teeth before the stop. */
static void check_place(const bench_t *b, const place_t *place)
{
    if (place->sensor != 0) {
        TEST_ASSERT_DOUBLE_WITHIN(1, place->sensor, shaft(b) - b->position);
        return;
    }
    const double before_stop = 250000 - place->direction * (shaft(b) - b->position);
    TEST_ASSERT_TRUE(before_stop > 999 && before_stop < 2001);
}

static void test_every_method_from_everywhere_ends_at_its_place(void)
{
    static const double starts[] = {0, 1, -777, 60000, -60000, 119000, -119000, 149999, -149999, 160000, -160000,
                                    200000, -200000, 240000, -240000, 249900, -249900};
    for (int m = 0; m < PLACES; m++) {
        double zero = NAN;
        for (size_t s = 0; s < sizeof starts / sizeof starts[0]; s++) {
            bench_t b;
            open_at(&b, &places[m], starts[s]);
            char text[80];
            snprintf(text, sizeof text, "method %d from %g", places[m].method, starts[s]);
            TEST_ASSERT_TRUE_MESSAGE(home(&b), text);
            TEST_ASSERT_EQUAL_MESSAGE(0, b.position, text);
            check_place(&b, &places[m]);
            TEST_ASSERT_TRUE_MESSAGE(isnan(zero) || fabs(shaft(&b) - zero) <= 1, "not repeatable");
            zero = shaft(&b);
            bench_close(&b);
        }
    }
}

static void test_any_speed_acceleration_and_cycle_time_finds_the_same_place(void)
{
    static const int32_t speeds[] = {20000, 50000, 200000, 500000};
    static const int32_t accelerations[] = {50000, 500000, 5000000};
    static const int64_t cycles[] = {200000, 1000000};
    for (int m = 0; m < PLACES; m++) {
        double zero = NAN;
        for (int v = 0; v < 4; v++)
            for (int a = 0; a < 3; a++)
                for (int c = 0; c < 2; c++) {
                    /* Too fast to stop between sensor and stop is the configuration's mistake. */
                    const double top = fmin(speeds[v], sqrt(2.0 * accelerations[a] * 150000));
                    if (places[m].sensor != 0 && top * top / (2.0 * accelerations[a]) > 90000)
                        continue;
                    bench_t b;
                    open_at(&b, &places[m], 0);
                    b.cycle_ns = cycles[c];
                    bench_write(&b, 0x6099, 1, speeds[v]);
                    bench_write(&b, 0x609A, 0, accelerations[a]);
                    bench_write(&b, 0x60F6, 0x1B, 60);
                    TEST_ASSERT_TRUE(home(&b));
                    TEST_ASSERT_EQUAL(0, b.position);
                    check_place(&b, &places[m]);
                    TEST_ASSERT_TRUE_MESSAGE(isnan(zero) || fabs(shaft(&b) - zero) <= 1, "not repeatable");
                    zero = shaft(&b);
                    bench_close(&b);
                }
    }
}

static void test_every_motor_finds_its_stops(void)
{
    for (int motor = 0; motor < 4; motor++)
        for (int m = 0; m < 2; m++) {
            cm1e_axis_config_t config = {0};
            strcpy(config.motor, cm1e_device_motors[motor].name);
            bench_t b;
            bench_open(&b, &config, CM1E_PDO_ORDER_UG_7_2);
            bench_write(&b, 0x6098, 0, places[m].method);
            bench_enable(&b, HM);
            TEST_ASSERT_TRUE(home(&b));
            check_place(&b, &places[m]);
            bench_close(&b);
        }
}

static void test_offset_moves_on_and_is_zero_at_its_end(void)
{
    static const int32_t offsets[] = {100, -100, 5000, -5000, 100000, -100000};
    for (int m = 0; m < PLACES; m++)
        for (int i = 0; i < 6; i++) {
            if (places[m].sensor == 0 && offsets[i] * places[m].direction > 0)
                continue; /* "care should be taken": into the stop */
            bench_t b;
            open_at(&b, &places[m], 0);
            TEST_ASSERT_TRUE(home(&b));
            const double reference = shaft(&b);
            bench_write(&b, 0x607C, 0, offsets[i]);
            TEST_ASSERT_TRUE(home(&b));
            TEST_ASSERT_EQUAL(0, b.position);
            TEST_ASSERT_DOUBLE_WITHIN(1, reference + offsets[i], shaft(&b));
            bench_close(&b);
        }
}

/* The table of UG 6.2.4, row by row, in the order of a homing with offset. */
static void test_bits_in_the_order_of_the_guide(void)
{
    for (int m = 0; m < PLACES; m++) {
        bench_t b;
        open_at(&b, &places[m], 0);
        bench_write(&b, 0x607C, 0, (int64_t)(-20000 * places[m].direction));
        TEST_ASSERT_EQUAL_HEX16(INTERRUPTED, b.statusword & BITS);
        begin(&b);
        TEST_ASSERT_EQUAL_HEX16(IN_PROGRESS, b.statusword & BITS);
        while ((b.statusword & BITS) == IN_PROGRESS)
            bench_cycle(&b);
        TEST_ASSERT_EQUAL_HEX16(ATTAINED, b.statusword & BITS);
        while ((b.statusword & BITS) == ATTAINED)
            bench_cycle(&b);
        TEST_ASSERT_EQUAL_HEX16(DONE, b.statusword & BITS);
        TEST_ASSERT_EQUAL(0, b.position);
        bench_run(&b, 1);
        TEST_ASSERT_EQUAL_HEX16_MESSAGE(DONE, b.statusword & BITS, "stays");
        b.controlword = 0x06;
        bench_run(&b, 0.1);
        TEST_ASSERT_EQUAL_HEX16_MESSAGE(DONE, b.statusword & BITS, "disabled");
        b.controlword = 0x0F;
        bench_run(&b, 0.1);
        begin(&b);
        TEST_ASSERT_EQUAL_HEX16_MESSAGE(IN_PROGRESS, b.statusword & BITS, "reset to 0 by a new home routine");
        bench_close(&b);
    }
}

static void test_method_0_starts_nothing(void)
{
    bench_t b;
    bench_open(&b, NULL, CM1E_PDO_ORDER_UG_4_4);
    bench_enable(&b, HM);
    begin(&b);
    bench_run(&b, 0.5);
    TEST_ASSERT_EQUAL_HEX16(INTERRUPTED, b.statusword & BITS);
    TEST_ASSERT_EQUAL(0, b.position);
    bench_close(&b);
}

static void test_start_needs_an_edge_while_enabled(void)
{
    bench_t b;
    bench_open(&b, NULL, CM1E_PDO_ORDER_UG_4_4);
    bench_write(&b, 0x6098, 0, -1);
    b.mode = HM;
    b.controlword = 0x16;
    bench_run(&b, 0.02);
    b.controlword = 0x1F;
    bench_run(&b, 0.2);
    TEST_ASSERT_EQUAL(OPERATION_ENABLED, bench_state(&b));
    TEST_ASSERT_EQUAL_HEX16(INTERRUPTED, b.statusword & BITS);
    TEST_ASSERT_EQUAL(0, b.position);
    b.controlword = 0x10F;
    bench_cycle(&b);
    b.controlword = 0x11F; /* "enable bit 4" needs halt at 0 */
    bench_run(&b, 0.1);
    TEST_ASSERT_EQUAL(SEARCH_IDLE, b.drive->homing.search.phase);
    begin(&b);
    TEST_ASSERT_EQUAL_HEX16(IN_PROGRESS, b.statusword & BITS);
    bench_close(&b);
}

static void test_bit_4_falling_changes_nothing(void)
{
    bench_t b;
    open_at(&b, &places[0], 0);
    begin(&b);
    b.controlword = 0x0F;
    TEST_ASSERT_TRUE(bench_until(&b, BITS, DONE, 60));
    bench_close(&b);
}

/* Halt at any moment stops with 0x609A; a new edge goes on to the same end. */
static void test_halt_anywhere_stops_and_a_new_start_continues(void)
{
    for (int m = 0; m < PLACES; m++)
        for (int ms = 10; ms < 6000; ms += 330) {
            bench_t b;
            open_at(&b, &places[m], 0);
            bench_write(&b, 0x607C, 0, (int64_t)(-10000 * places[m].direction));
            begin(&b);
            bench_run(&b, ms * 1e-3);
            if ((b.statusword & BITS) == DONE) {
                bench_close(&b);
                break;
            }
            b.controlword = 0x11F;
            TEST_ASSERT_TRUE(bench_until(&b, BITS, INTERRUPTED, 2));
            bench_run(&b, 0.2);
            const double stopped = shaft(&b);
            b.controlword = 0x10F;
            bench_run(&b, 0.1);
            b.controlword = 0x11F; /* bit 4 is not enabled while halted */
            bench_run(&b, 0.2);
            TEST_ASSERT_EQUAL_HEX16(INTERRUPTED, b.statusword & BITS);
            b.controlword = 0x0F;
            bench_run(&b, 0.2);
            TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(100, stopped, shaft(&b), "only bit 4 goes on");
            TEST_ASSERT_TRUE(home(&b));
            TEST_ASSERT_EQUAL(0, b.position);
            TEST_ASSERT_DOUBLE_WITHIN(1, b.drive->homing.search.target, shaft(&b));
            bench_close(&b);
        }
}

static void test_disabling_on_the_way_aborts(void)
{
    for (int m = 0; m < PLACES; m++)
        for (int ms = 10; ms < 6000; ms += 330) {
            bench_t b;
            open_at(&b, &places[m], 0);
            begin(&b);
            bench_run(&b, ms * 1e-3);
            if ((b.statusword & BITS) == DONE) {
                bench_close(&b);
                break;
            }
            b.controlword = 0x06;
            bench_run(&b, 0.5);
            TEST_ASSERT_EQUAL_HEX16(INTERRUPTED, b.statusword & BITS);
            b.controlword = 0x0F;
            bench_run(&b, 0.5);
            TEST_ASSERT_EQUAL_HEX16(INTERRUPTED, b.statusword & BITS);
            TEST_ASSERT_EQUAL_DOUBLE_MESSAGE(0, floor(fabs(b.drive->mechanics.velocity) / 100), "it does not go on");
            TEST_ASSERT_TRUE(home(&b));
            check_place(&b, &places[m]);
            bench_close(&b);
        }
}

static void test_motor_errors_show_as_homing_errors(void)
{
    bench_t b;
    open_at(&b, &places[0], 0);
    bench_write(&b, 0x6099, 1, 500000);
    bench_write(&b, 0x609A, 0, 5000000);
    begin(&b);
    bench_run(&b, 0.2);
    cm1e_sim_fsa_error(b.drive, 0x7310);
    bench_cycle(&b);
    TEST_ASSERT_EQUAL_HEX16(ERROR_MOVING, b.statusword & BITS);
    bench_run(&b, 1);
    TEST_ASSERT_EQUAL_HEX16(ERROR_STANDING, b.statusword & BITS);
    b.controlword = 0x86;
    bench_cycle(&b);
    b.controlword = 0x0F;
    bench_run(&b, 0.1);
    TEST_ASSERT_EQUAL_HEX16(INTERRUPTED, b.statusword & BITS);
    TEST_ASSERT_TRUE(home(&b));
    cm1e_sim_fsa_error(b.drive, 0xFF04);
    bench_run(&b, 0.1);
    TEST_ASSERT_EQUAL_HEX16(ERROR_AFTER_HOMING, b.statusword & BITS);
    bench_close(&b);
}

static void test_power_lost_on_the_way_is_an_error(void)
{
    bench_t b;
    open_at(&b, &places[2], 0);
    begin(&b);
    bench_run(&b, 0.5);
    cm1e_sim_fsa_motor_power(b.drive, false);
    bench_run(&b, 0.5);
    TEST_ASSERT_EQUAL_HEX16(ERROR_STANDING, b.statusword & BITS);
    TEST_ASSERT_EQUAL_HEX16(0xFF05, b.error_code);
    bench_close(&b);
}

/* The wrong way round: the axis runs into its stop, the sensor never comes, the motor loses its position. */
static void test_a_sensor_that_never_comes_ends_in_a_position_error(void)
{
    static const place_t wrong[] = {{-4, 150000, -1}, {-5, -150000, 1}};
    for (int i = 0; i < 2; i++)
        for (int start = -1; start <= 1; start++) {
            bench_t b;
            open_at(&b, &wrong[i], start * 200000.0);
            TEST_ASSERT_FALSE(home(&b));
            TEST_ASSERT_EQUAL_HEX16(0x7320, b.error_code);
            TEST_ASSERT_EQUAL_HEX16(ERROR_STANDING, b.statusword & BITS);
            bench_close(&b);
        }
}

static void test_a_sensor_held_off_or_on_by_hand(void)
{
    bench_t b;
    open_at(&b, &places[2], 0);
    b.drive->sensors.held = 0x2;
    begin(&b);
    bench_run(&b, 1);
    TEST_ASSERT_EQUAL_HEX16(IN_PROGRESS, b.statusword & BITS);
    b.drive->sensors.values = 0x2;
    const double here = shaft(&b);
    TEST_ASSERT_TRUE(bench_until(&b, BIT12, BIT12, 0.01));
    TEST_ASSERT_TRUE(bench_until(&b, BITS, DONE, 10));
    TEST_ASSERT_DOUBLE_WITHIN(300, here, shaft(&b));
    TEST_ASSERT_EQUAL_HEX16(0x2, b.digital_inputs);
    begin(&b); /* stands on it, and it never goes off: to the other stop */
    TEST_ASSERT_TRUE(bench_until(&b, BITS, ERROR_STANDING, 60));
    TEST_ASSERT_TRUE(shaft(&b) < -249000);
    bench_close(&b);
}

static void test_homing_torque_limits_and_decides(void)
{
    bench_t b;
    open_at(&b, &places[0], 0);
    bench_write(&b, 0x60F6, 0x1B, 20);
    begin(&b);
    double most = 0;
    while (!(b.statusword & BIT10)) {
        bench_cycle(&b);
        most = fmax(most, fabs((double)b.torque));
    }
    TEST_ASSERT_DOUBLE_WITHIN(1, 200, most);
    TEST_ASSERT_EQUAL_DOUBLE_MESSAGE(b.drive->motor->peak_torque_nm, b.drive->servo.torque_limit, "only during it");
    bench_close(&b);

    open_at(&b, &places[0], 0); /* friction that needs more torque than K47 allows looks like a stop */
    b.drive->mechanics.friction = 0.05;
    begin(&b);
    TEST_ASSERT_TRUE(bench_until(&b, BIT12, BIT12, 2));
    TEST_ASSERT_EQUAL_DOUBLE(0, shaft(&b));
    bench_close(&b);
}

static void test_endless_axis_never_finds_a_stop(void)
{
    cm1e_axis_config_t config = {.sim.no_stops = true, .sim.no_sensors = true};
    bench_t b;
    bench_open(&b, &config, CM1E_PDO_ORDER_UG_4_4);
    bench_write(&b, 0x6098, 0, -1);
    bench_enable(&b, HM);
    begin(&b);
    TEST_ASSERT_FALSE(bench_until(&b, BIT10, BIT10, 20));
    TEST_ASSERT_TRUE(shaft(&b) > 900000);
    bench_close(&b);
}

/* ---- leaving the mode ------------------------------------------------------------------------------------------- */

static void test_leaving_the_mode_on_the_way_stops_first(void)
{
    bench_t b;
    open_at(&b, &places[0], 0);
    bench_write(&b, 0x6099, 1, 200000);
    bench_write(&b, 0x609A, 0, 1000000);
    begin(&b);
    bench_run(&b, 0.3);
    b.mode = 3;
    b.controlword = 0x10F;
    bench_run(&b, 0.1);
    TEST_ASSERT_EQUAL_MESSAGE(HM, b.mode_display, "still slowing down");
    bench_run(&b, 0.15);
    TEST_ASSERT_EQUAL(3, b.mode_display);
    TEST_ASSERT_EQUAL_DOUBLE(b.drive->motor->peak_torque_nm, b.drive->servo.torque_limit);
    TEST_ASSERT_DOUBLE_WITHIN(1000, 0, b.drive->mechanics.velocity);
    b.mode = HM;
    b.controlword = 0x0F;
    bench_run(&b, 0.1);
    TEST_ASSERT_EQUAL_HEX16(INTERRUPTED, b.statusword & BITS);
    bench_close(&b);
}

/* UG 10.1: before V1.3.0 the halt bit did not halt the motor when the mode was switched at the same time. */
static void test_halt_with_a_mode_switch_is_ignored_before_1_3_0(void)
{
    cm1e_axis_config_t config = bench_firmware("1.2.0");
    bench_t b;
    bench_open(&b, &config, CM1E_PDO_ORDER_UG_4_4);
    bench_write(&b, 0x6098, 0, -1);
    bench_enable(&b, HM);
    begin(&b);
    bench_run(&b, 0.5);
    b.mode = CSP;
    b.target_position = b.position;
    b.controlword = 0x10F;
    bench_run(&b, 0.5);
    TEST_ASSERT_EQUAL(CSP, b.mode_display);
    TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(5000, 50000, b.drive->mechanics.velocity, "it runs on");
    bench_close(&b);

    bench_open(&b, &config, CM1E_PDO_ORDER_UG_4_4); /* halt first, then the mode: halts */
    bench_write(&b, 0x6098, 0, -1);
    bench_enable(&b, HM);
    begin(&b);
    bench_run(&b, 0.5);
    b.controlword = 0x11F;
    TEST_ASSERT_TRUE(bench_until(&b, BITS, INTERRUPTED, 2));
    bench_close(&b);
}

static void test_position_after_homing_serves_csp(void)
{
    for (int m = 0; m < PLACES; m++) {
        bench_t b;
        open_at(&b, &places[m], 0);
        TEST_ASSERT_TRUE(home(&b));
        const double zero = shaft(&b);
        b.target_position = 0;
        b.mode = CSP;
        bench_run(&b, 0.2);
        TEST_ASSERT_DOUBLE_WITHIN(1, zero, shaft(&b));
        for (int i = 0; i < 300; i++) {
            b.target_position -= (int32_t)(50 * places[m].direction);
            bench_cycle(&b);
        }
        bench_run(&b, 0.3);
        TEST_ASSERT_DOUBLE_WITHIN(1, zero - 15000 * places[m].direction, shaft(&b));
        bench_close(&b);
    }
}

static void test_power_cycle_forgets_position_and_homing(void)
{
    bench_t b;
    open_at(&b, &places[0], 0);
    TEST_ASSERT_TRUE(home(&b));
    b.ops->power_on(b.drive, b.now_ns);
    bench_to_op(&b);
    b.controlword = 0;
    bench_run(&b, 0.02);
    TEST_ASSERT_EQUAL(0, b.position);
    TEST_ASSERT_EQUAL(0, b.statusword & BIT12);
    TEST_ASSERT_TRUE(shaft(&b) > 240000);
    bench_close(&b);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_method_from_everywhere_ends_at_its_place);
    RUN_TEST(test_any_speed_acceleration_and_cycle_time_finds_the_same_place);
    RUN_TEST(test_every_motor_finds_its_stops);
    RUN_TEST(test_offset_moves_on_and_is_zero_at_its_end);
    RUN_TEST(test_bits_in_the_order_of_the_guide);
    RUN_TEST(test_method_0_starts_nothing);
    RUN_TEST(test_start_needs_an_edge_while_enabled);
    RUN_TEST(test_bit_4_falling_changes_nothing);
    RUN_TEST(test_halt_anywhere_stops_and_a_new_start_continues);
    RUN_TEST(test_disabling_on_the_way_aborts);
    RUN_TEST(test_motor_errors_show_as_homing_errors);
    RUN_TEST(test_power_lost_on_the_way_is_an_error);
    RUN_TEST(test_a_sensor_that_never_comes_ends_in_a_position_error);
    RUN_TEST(test_a_sensor_held_off_or_on_by_hand);
    RUN_TEST(test_homing_torque_limits_and_decides);
    RUN_TEST(test_endless_axis_never_finds_a_stop);
    RUN_TEST(test_leaving_the_mode_on_the_way_stops_first);
    RUN_TEST(test_halt_with_a_mode_switch_is_ignored_before_1_3_0);
    RUN_TEST(test_position_after_homing_serves_csp);
    RUN_TEST(test_power_cycle_forgets_position_and_homing);
    return UNITY_END();
}
