/** CSP, CSV and PV of the simulated CM1-E on its axis (UG 6.2), load, and switching between modes. */
#include <math.h>
#include <stdio.h>

#include "sim_cm1e_bench.h"

void setUp(void) {}
void tearDown(void) {}

enum { PP = 1, PV = 3, HM = 6, CSP = 8, CSV = 9 };
enum { BIT10 = 0x0400, BIT12 = 0x1000, BIT13 = 0x2000 };

static const char *const firmwares[] = {"1.2.0", "1.3.0", "1.3.2", "1.3.3", "1.3.4", "1.3.5"};
enum { FIRMWARES = 6 };

static double shaft(const bench_t *b) { return b->drive->mechanics.position; }
static double speed(const bench_t *b) { return b->drive->mechanics.velocity; }

/* ---- cyclic synchronous position -------------------------------------------------------------------------------- */

static void test_csp_follows_with_a_small_lag_at_every_cycle_time(void)
{
    static const int64_t cycles[] = {200000, 250000, 500000, 1000000};
    for (int i = 0; i < 4; i++) {
        bench_t b;
        bench_open_endless(&b, "1.3.5");
        b.cycle_ns = cycles[i];
        bench_enable(&b, CSP);
        const double end_s = 1, top = 2000000;
        double worst = 0;
        const int64_t start_ns = b.now_ns;
        for (double t = 0; t < end_s; t = (double)(b.now_ns - start_ns) * 1e-9) {
            b.target_position = (int32_t)(top * (t / 2 - sin(6.283185307179586 * t) / 12.566370614359172));
            bench_cycle(&b);
            worst = fmax(worst, fabs(b.target_position - shaft(&b)));
        }
        TEST_ASSERT_TRUE_MESSAGE(worst < 400 + top * (double)cycles[i] * 1e-9, "one cycle and a little behind");
        bench_run(&b, 0.5);
        TEST_ASSERT_INT32_WITHIN(1, b.target_position, b.position);
        TEST_ASSERT_TRUE(b.statusword & BIT12);
        bench_close(&b);
    }
}

/* The hazard that a driver must be proof against: the device does not protect it. */
static void test_csp_enabled_with_another_target_jumps_with_full_torque(void)
{
    bench_t b;
    bench_open(&b, NULL, CM1E_PDO_ORDER_UG_4_4);
    b.mode = CSP;
    b.controlword = 0x06;
    bench_run(&b, 0.02);
    b.target_position = 20000;
    b.controlword = 0x0F;
    double torque = 0;
    for (int i = 0; i < 20; i++) {
        bench_cycle(&b);
        torque = fmax(torque, fabs(b.drive->servo.torque));
    }
    TEST_ASSERT_EQUAL_DOUBLE(b.drive->motor->peak_torque_nm, torque);
    TEST_ASSERT_TRUE(b.drive->mechanics.peak_velocity > 1000000);
    bench_run(&b, 1);
    TEST_ASSERT_INT32_WITHIN(1, 20000, b.position);
    bench_close(&b);
}

static void test_csp_far_target_raises_position_error_overflow(void)
{
    bench_t b;
    bench_open_endless(&b, "1.3.5");
    bench_enable(&b, CSP);
    b.target_position = 200000;
    bench_run(&b, 0.1);
    TEST_ASSERT_EQUAL(FAULT, bench_state(&b));
    TEST_ASSERT_EQUAL_HEX16(0x7320, b.error_code);
    bench_close(&b);
}

static void test_csp_position_wraps_at_32_bits(void)
{
    bench_t b;
    bench_open_endless(&b, "1.3.5");
    b.drive->zero = -INT64_C(2147483600); /* actual position 47 counts below the wrap */
    bench_enable(&b, CSP);
    TEST_ASSERT_EQUAL_INT32(2147483600, b.position);
    for (int i = 0; i < 100; i++) {
        b.target_position = (int32_t)((uint32_t)b.target_position + 10u);
        bench_cycle(&b);
    }
    bench_run(&b, 0.5);
    TEST_ASSERT_EQUAL_INT32(b.target_position, b.position);
    TEST_ASSERT_TRUE(b.position < 0);
    TEST_ASSERT_DOUBLE_WITHIN(2, 1000, shaft(&b));
    bench_close(&b);
}

static void test_following_bit_exists_since_1_3_0_and_only_while_following(void)
{
    for (int f = 0; f < FIRMWARES; f++)
        for (int mode = CSP; mode <= CSV; mode++) {
            bench_t b;
            bench_open_endless(&b, firmwares[f]);
            bench_enable(&b, (int8_t)mode);
            bench_run(&b, 0.01);
            TEST_ASSERT_EQUAL(f >= CM1E_FIRMWARE_1_3_0, (b.statusword & BIT12) != 0);
            TEST_ASSERT_EQUAL_HEX16(0, b.error_code);
            b.controlword = 0x06;
            bench_cycle(&b);
            TEST_ASSERT_EQUAL(0, b.statusword & BIT12);
            bench_close(&b);
        }
    bench_t b;
    bench_open_endless(&b, "1.3.5");
    bench_enable(&b, CSP);
    b.target_position += 30000;
    bench_run(&b, 0.005);
    TEST_ASSERT_EQUAL(0, b.statusword & BIT12);
    TEST_ASSERT_EQUAL_HEX16(0x8611, b.error_code);
    bench_run(&b, 1);
    TEST_ASSERT_EQUAL(BIT12, b.statusword & BIT12);
    bench_close(&b);
}

/* ---- velocity modes --------------------------------------------------------------------------------------------- */

/* UG 10.1: counts/ms before V1.3.3; below V1.3.0 a quarter in HM and PP. */
static void test_velocity_units_by_firmware(void)
{
    static const int8_t modes[] = {CSV, PV};
    for (int f = 0; f < FIRMWARES; f++)
        for (int m = 0; m < 2; m++) {
            const int32_t unit = f < CM1E_FIRMWARE_1_3_3 ? 1000 : 1;
            bench_t b;
            bench_open_endless(&b, firmwares[f]);
            bench_write(&b, 0x6083, 0, 5000000);
            bench_enable(&b, modes[m]);
            b.target_velocity = 300000 / unit;
            bench_run(&b, 1);
            TEST_ASSERT_DOUBLE_WITHIN(200, 300000, speed(&b));
            TEST_ASSERT_INT32_WITHIN(200 / unit + 1, 300000 / unit, b.velocity);
            bench_close(&b);
        }
}

static void test_shown_velocity_is_a_quarter_in_pp_below_1_3_0(void)
{
    for (int f = 0; f < FIRMWARES; f++) {
        bench_t b;
        bench_open_endless(&b, firmwares[f]);
        bench_write(&b, 0x6081, 0, 400000);
        bench_write(&b, 0x6083, 0, 5000000);
        bench_enable(&b, PP);
        b.target_position = 1000000;
        b.controlword = 0x1F;
        bench_run(&b, 0.5);
        TEST_ASSERT_DOUBLE_WITHIN(500, 400000, speed(&b));
        const double shown = speed(&b) / (f < CM1E_FIRMWARE_1_3_0 ? 4 : 1) / (f < CM1E_FIRMWARE_1_3_3 ? 1000 : 1);
        TEST_ASSERT_DOUBLE_WITHIN(1, shown, b.velocity);
        bench_close(&b);
    }
}

static void test_csv_goes_to_its_target_at_once(void)
{
    bench_t b;
    bench_open_endless(&b, "1.3.5");
    bench_enable(&b, CSV);
    b.target_velocity = 1000000;
    bench_run(&b, 0.004);
    TEST_ASSERT_EQUAL_MESSAGE(0, b.statusword & BIT12, "at its torque limit it does not follow");
    bench_run(&b, 0.026);
    TEST_ASSERT_DOUBLE_WITHIN(20000, 1000000, speed(&b));
    bench_run(&b, 0.2);
    TEST_ASSERT_DOUBLE_WITHIN(100, 1000000, speed(&b));
    b.target_velocity = -1000000;
    bench_run(&b, 0.3);
    TEST_ASSERT_DOUBLE_WITHIN(100, -1000000, speed(&b));
    b.target_velocity = 0;
    bench_run(&b, 0.3);
    TEST_ASSERT_EQUAL_DOUBLE(0, floor(fabs(speed(&b)) / 100));
    bench_close(&b);
}

static void test_csv_enabled_with_a_target_velocity_runs_at_once(void)
{
    bench_t b;
    bench_open_endless(&b, "1.3.5");
    b.mode = CSV;
    b.target_velocity = 500000;
    b.controlword = 0x06;
    bench_run(&b, 0.02);
    TEST_ASSERT_EQUAL_DOUBLE(0, speed(&b));
    b.controlword = 0x0F;
    bench_run(&b, 0.03);
    TEST_ASSERT_TRUE(speed(&b) > 400000);
    bench_close(&b);
}

static void open_motor(bench_t *b, int m)
{
    cm1e_axis_config_t config = {.sim.no_stops = true};
    strcpy(config.motor, cm1e_device_motors[m].name);
    bench_open(b, &config, CM1E_PDO_ORDER_UG_4_4);
}

/* The greatest values of 0x60FF are the motor's peak speeds (UG 6.2.6, 6.3): more is not run, and is no error. */
static void test_velocities_above_the_peak_are_cut_to_it_in_csv_and_pv(void)
{
    static const int8_t modes[] = {CSV, PV};
    for (int m = 0; m < 4; m++)
        for (int i = 0; i < 2 * 4; i++) {
            const double peak = cm1e_device_motors[m].max_velocity_counts_per_s, sign = i & 1 ? -1 : 1;
            bench_t b;
            open_motor(&b, m);
            bench_write(&b, 0x6083, 0, 10000000);
            bench_enable(&b, modes[i / 4]);
            b.target_velocity = (int32_t)(sign * (i & 2 ? 5000000 : peak * 1.2));
            bench_run(&b, 2);
            TEST_ASSERT_EQUAL_HEX16(0, b.error_code);
            TEST_ASSERT_EQUAL(OPERATION_ENABLED, bench_state(&b));
            TEST_ASSERT_DOUBLE_WITHIN(2500, sign * peak, speed(&b));
            TEST_ASSERT_TRUE(b.drive->mechanics.peak_velocity < 1.05 * peak);
            bench_close(&b);
        }
}

static void test_over_speed_raises_7310_for_every_motor(void)
{
    for (int m = 0; m < 4; m++) {
        bench_t b;
        open_motor(&b, m);
        bench_enable(&b, CSV);
        b.target_velocity = cm1e_device_motors[m].max_velocity_counts_per_s;
        bench_run(&b, 1);
        TEST_ASSERT_EQUAL_MESSAGE(OPERATION_ENABLED, bench_state(&b), "peak speed is allowed");
        b.drive->mechanics.load_torque = 5 * b.drive->motor->peak_torque_nm; /* something drives it faster */
        bench_run(&b, 0.2);
        b.drive->mechanics.load_torque = 0;
        TEST_ASSERT_EQUAL_HEX16(0x7310, b.error_code);
        TEST_ASSERT_EQUAL(FAULT, bench_state(&b));
        bench_run(&b, 20);
        TEST_ASSERT_EQUAL_DOUBLE_MESSAGE(0, speed(&b), "it runs out without torque");
        bench_close(&b);
    }
}

/* "The deceleration value is only used when the target velocity is set to 0 or the halt bit is set" (UG 6.2.3). */
static void test_pv_ramps_with_acceleration_and_deceleration(void)
{
    bench_t b;
    bench_open_endless(&b, "1.3.5");
    bench_write(&b, 0x6083, 0, 1000000);
    bench_write(&b, 0x6084, 0, 4000000);
    bench_enable(&b, PV);
    TEST_ASSERT_EQUAL_HEX16(BIT10 | BIT12, b.statusword & (BIT10 | BIT12));
    b.target_velocity = 1000000;
    bench_run(&b, 0.5);
    TEST_ASSERT_DOUBLE_WITHIN(10000, 500000, speed(&b));
    TEST_ASSERT_EQUAL_HEX16(0, b.statusword & (BIT10 | BIT12));
    bench_run(&b, 0.6);
    TEST_ASSERT_EQUAL_HEX16(BIT10, b.statusword & (BIT10 | BIT12));
    b.target_velocity = 500000; /* slower, but not 0: acceleration */
    bench_run(&b, 0.25);
    TEST_ASSERT_DOUBLE_WITHIN(10000, 750000, speed(&b));
    bench_run(&b, 0.5);
    b.controlword = 0x10F; /* halt: deceleration */
    bench_run(&b, 0.0625);
    TEST_ASSERT_DOUBLE_WITHIN(20000, 250000, speed(&b));
    TEST_ASSERT_EQUAL_HEX16(0, b.statusword & (BIT10 | BIT12));
    bench_run(&b, 0.2);
    TEST_ASSERT_EQUAL_HEX16(BIT10 | BIT12, b.statusword & (BIT10 | BIT12));
    b.controlword = 0x0F;
    bench_run(&b, 1);
    TEST_ASSERT_DOUBLE_WITHIN(100, 500000, speed(&b));
    b.target_velocity = 0;
    bench_run(&b, 0.0625);
    TEST_ASSERT_DOUBLE_WITHIN(20000, 250000, speed(&b));
    bench_close(&b);
}

/* ---- coming to rest --------------------------------------------------------------------------------------------- */

/* How often bits of the statusword change within a time, and how far the shaft moves after they were last set. Frames
 * come with jitter, as on a wire. */
typedef struct settling {
    int changes_of_bit_10, changes_of_bit_12;
    int32_t way_after_reached;
} settling_t;

static settling_t settle(bench_t *b, double seconds)
{
    settling_t s = {0};
    int32_t reached_at = b->position;
    for (int i = 0; i < seconds * 1000; i++) {
        const uint16_t before = b->statusword;
        b->cycle_ns = BENCH_MS + (i % 7 - 3) * 40000;
        bench_cycle(b);
        s.changes_of_bit_10 += ((b->statusword ^ before) & BIT10) != 0;
        s.changes_of_bit_12 += ((b->statusword ^ before) & BIT12) != 0;
        if ((b->statusword & BIT10) && !(before & BIT10)) {
            reached_at = b->position;
            s.way_after_reached = 0;
        }
        const int32_t way = b->position < reached_at ? reached_at - b->position : b->position - reached_at;
        s.way_after_reached = (b->statusword & BIT10) && way > s.way_after_reached ? way : s.way_after_reached;
    }
    return s;
}

static const double frictions[] = {0, 0.001, 0.02}; /* Nm; 0: 0.005 */
static const double loads[] = {0, 0.03, -0.03};
static const int32_t accelerations[] = {100000, 1000000, 10000000};

static void open_loaded(bench_t *b, int n, char *text, size_t size)
{
    cm1e_axis_config_t config = {.sim = {.no_stops = true, .friction = frictions[n / 4 % 3]}};
    strcpy(config.motor, cm1e_device_motors[n % 4].name);
    bench_open(b, &config, CM1E_PDO_ORDER_UG_4_4);
    snprintf(text, size, "%s, friction %g Nm, load %g Nm, %d counts/s2", config.motor, frictions[n / 4 % 3],
             loads[n / 12 % 3], accelerations[n / 36]);
    bench_write(b, 0x6083, 0, accelerations[n / 36]);
    bench_write(b, 0x6084, 0, accelerations[n / 36]);
    bench_write(b, 0x60F6, 0x1B, 100);
    bench_write(b, 0x609A, 0, accelerations[n / 36] < 5000000 ? accelerations[n / 36] : 5000000);
}

/* "Target reached", "speed is equal to 0" (UG 6.2.3) come once, and then the shaft stands: it does not hunt. */
static void test_pv_comes_to_its_velocity_and_to_rest_once(void)
{
    for (int n = 0; n < 2 * 108; n++) {
        bench_t b;
        char text[96];
        open_loaded(&b, n % 108, text, sizeof text);
        bench_enable(&b, PV);
        b.drive->mechanics.load_torque = loads[n % 108 / 12 % 3];
        bench_run(&b, 1);
        b.target_velocity = 200000;
        settling_t s = settle(&b, 4);
        TEST_ASSERT_EQUAL_HEX16_MESSAGE(BIT10, b.statusword & (BIT10 | BIT12), text);
        TEST_ASSERT_EQUAL_INT_MESSAGE(2, s.changes_of_bit_10, text);
        TEST_ASSERT_EQUAL_INT_MESSAGE(1, s.changes_of_bit_12, text);
        if (n < 108)
            b.target_velocity = 0;
        else
            b.controlword = 0x10F; /* halt */
        s = settle(&b, 6);
        TEST_ASSERT_EQUAL_HEX16_MESSAGE(BIT10 | BIT12, b.statusword & (BIT10 | BIT12), text);
        TEST_ASSERT_EQUAL_INT_MESSAGE(2, s.changes_of_bit_10, text);
        TEST_ASSERT_EQUAL_INT_MESSAGE(1, s.changes_of_bit_12, text);
        TEST_ASSERT_LESS_OR_EQUAL_INT32_MESSAGE(1, s.way_after_reached, text);
        bench_close(&b);
    }
}

/* A search that is halted shows bit 10 once (UG 6.2.4). */
static void test_a_halted_homing_comes_to_rest_once(void)
{
    for (int n = 0; n < 108; n++) {
        bench_t b;
        char text[96];
        open_loaded(&b, n, text, sizeof text);
        bench_write(&b, 0x6098, 0, -3);
        bench_write(&b, 0x6099, 1, 40000);
        bench_enable(&b, HM);
        b.drive->mechanics.load_torque = loads[n / 12 % 3];
        b.controlword = 0x1F;
        bench_run(&b, 1);
        TEST_ASSERT_EQUAL_HEX16_MESSAGE(0, b.statusword & (BIT10 | BIT12), text);
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(400, 40000, speed(&b), text);
        b.controlword = 0x11F;
        const settling_t s = settle(&b, 4);
        TEST_ASSERT_EQUAL_HEX16_MESSAGE(BIT10, b.statusword & (BIT10 | BIT12), text);
        TEST_ASSERT_EQUAL_INT_MESSAGE(1, s.changes_of_bit_10, text);
        TEST_ASSERT_LESS_OR_EQUAL_INT32_MESSAGE(1, s.way_after_reached, text);
        bench_close(&b);
    }
}

/* What `cm1e sim` sleeps by. */
static void test_a_motor_moves_until_it_rests_without_torque(void)
{
    bench_t b;
    bench_open_endless(&b, "1.3.5");
    bench_run(&b, 1);
    TEST_ASSERT_EQUAL_INT64(INT64_MAX, b.ops->due(b.drive));
    bench_enable(&b, CSV);
    bench_run(&b, 1);
    TEST_ASSERT_EQUAL_INT64_MESSAGE(INT64_MIN, b.ops->due(b.drive), "it is held by torque");
    b.target_velocity = 200000;
    bench_run(&b, 1);
    b.ops->watchdog_expired(b.drive);
    TEST_ASSERT_EQUAL_INT64_MESSAGE(INT64_MIN, b.ops->due(b.drive), "it runs out");
    for (int i = 0; i < 10000 && b.drive->mechanics.velocity != 0; i++)
        b.ops->advance(b.drive, b.now_ns += BENCH_MS);
    TEST_ASSERT_EQUAL_INT64(INT64_MAX, b.ops->due(b.drive));
    b.drive->mechanics.load_torque = 0.05;
    TEST_ASSERT_EQUAL_INT64_MESSAGE(INT64_MIN, b.ops->due(b.drive), "a load turns it");
    bench_close(&b);
}

/* ---- load ------------------------------------------------------------------------------------------------------- */

static void test_torque_is_shown_in_per_mille_of_rated(void)
{
    bench_t b;
    bench_open_endless(&b, "1.3.5");
    bench_enable(&b, CSP);
    b.drive->mechanics.load_torque = -0.05;
    bench_run(&b, 2);
    TEST_ASSERT_INT32_WITHIN(1, 0, b.position);
    const double rated = b.drive->motor->peak_torque_nm / 1.25;
    TEST_ASSERT_DOUBLE_WITHIN(1, b.drive->servo.torque / rated * 1000, b.torque);
    TEST_ASSERT_DOUBLE_WITHIN(0.006, 0.05, b.drive->servo.torque);
    bench_close(&b);
}

static void test_overload_raises_2310_and_rated_load_does_not(void)
{
    bench_t b;
    bench_open_endless(&b, "1.3.5");
    bench_enable(&b, CSP);
    b.drive->mechanics.load_torque = 0.09; /* friction helps: below rated */
    bench_run(&b, 5);
    TEST_ASSERT_EQUAL(OPERATION_ENABLED, bench_state(&b));
    b.drive->mechanics.load_torque = 0.110;
    TEST_ASSERT_TRUE(bench_until(&b, 0x4F, 0x08, 5));
    TEST_ASSERT_EQUAL_HEX16(0x2310, b.error_code);
    b.controlword = 0x86; /* a reset forgives what was: the same load is carried as long again */
    bench_cycle(&b);
    b.target_position = b.position;
    b.controlword = 0x0F;
    b.drive->mechanics.load_torque = 0.110;
    bench_run(&b, 0.3);
    TEST_ASSERT_EQUAL(OPERATION_ENABLED, bench_state(&b));
    bench_close(&b);
}

static void test_pressing_against_a_stop_ends_in_a_fault(void)
{
    bench_t b;
    bench_open(&b, NULL, CM1E_PDO_ORDER_UG_4_4);
    bench_enable(&b, CSV);
    b.target_velocity = 500000;
    TEST_ASSERT_TRUE(bench_until(&b, 0x4F, 0x08, 5));
    TEST_ASSERT_EQUAL_HEX16(0x2310, b.error_code);
    TEST_ASSERT_EQUAL(250000, b.position);
    bench_close(&b);
}

static void test_standing_without_torque_stays_for_ever(void)
{
    bench_t b;
    bench_open(&b, NULL, CM1E_PDO_ORDER_UG_4_4);
    b.drive->mechanics.load_torque = 0.004;
    bench_run(&b, 5);
    TEST_ASSERT_EQUAL_DOUBLE(0, shaft(&b));
    bench_close(&b);
}

/* ---- switching -------------------------------------------------------------------------------------------------- */

static void test_mode_display_changes_after_a_while_and_the_old_mode_serves_meanwhile(void)
{
    static const int8_t modes[] = {PP, PV, HM, CSP, CSV};
    for (int from = 0; from < 5; from++)
        for (int to = 0; to < 5; to++) {
            if (from == to)
                continue;
            bench_t b;
            bench_open_endless(&b, "1.3.5");
            bench_enable(&b, modes[from]);
            b.mode = modes[to];
            bench_cycle(&b);
            TEST_ASSERT_EQUAL(modes[from], b.mode_display);
            for (int i = 0; i < 10 && b.mode_display != modes[to]; i++)
                bench_cycle(&b);
            TEST_ASSERT_EQUAL(modes[to], b.mode_display);
            bench_run(&b, 0.2);
            TEST_ASSERT_EQUAL(OPERATION_ENABLED, bench_state(&b));
            TEST_ASSERT_EQUAL_MESSAGE(0, b.position, "a switch at rest moves nothing");
            bench_close(&b);
        }
}

static void test_mode_changed_back_in_time_never_shows(void)
{
    bench_t b;
    bench_open_endless(&b, "1.3.5");
    bench_enable(&b, CSP);
    b.mode = PV;
    bench_cycle(&b);
    b.mode = CSP;
    for (int i = 0; i < 20; i++) {
        bench_cycle(&b);
        TEST_ASSERT_EQUAL(CSP, b.mode_display);
    }
    bench_close(&b);
}

static void test_switching_to_csp_with_an_old_target_jumps(void)
{
    bench_t b;
    bench_open_endless(&b, "1.3.5");
    bench_write(&b, 0x6083, 0, 5000000);
    bench_write(&b, 0x6084, 0, 5000000);
    bench_enable(&b, PV);
    b.target_position = 0;
    b.target_velocity = 80000;
    bench_run(&b, 0.2);
    b.target_velocity = 0;
    bench_run(&b, 0.3);
    TEST_ASSERT_TRUE(b.position > 10000);
    b.mode = CSP;
    bench_run(&b, 1);
    TEST_ASSERT_INT32_WITHIN(1, 0, b.position);
    TEST_ASSERT_TRUE(b.drive->mechanics.peak_velocity > 500000);
    bench_close(&b);
}

static void test_switching_from_motion_to_pp_or_hm_stops_in_a_ramp(void)
{
    static const int8_t modes[] = {PP, HM};
    for (int i = 0; i < 2; i++) {
        bench_t b;
        bench_open_endless(&b, "1.3.5");
        bench_write(&b, 0x6083, 0, 2000000);
        bench_write(&b, 0x609A, 0, 2000000);
        bench_enable(&b, CSV);
        b.target_velocity = 400000;
        bench_run(&b, 0.3);
        const double from = shaft(&b);
        b.mode = modes[i];
        bench_run(&b, 1);
        TEST_ASSERT_DOUBLE_WITHIN(200, 0, speed(&b));
        TEST_ASSERT_DOUBLE_WITHIN(3000, from + 400000.0 * 400000 / (2 * 2000000.0), shaft(&b));
        bench_close(&b);
    }
}

static void test_losing_torque_at_speed_runs_out(void)
{
    bench_t b;
    bench_open_endless(&b, "1.3.5");
    bench_enable(&b, CSV);
    b.target_velocity = 1000000;
    bench_run(&b, 0.3);
    cm1e_sim_fsa_motor_power(b.drive, false);
    bench_run(&b, 0.02);
    TEST_ASSERT_TRUE(speed(&b) > 500000 && speed(&b) < 1000000);
    TEST_ASSERT_EQUAL(0, b.torque);
    bench_run(&b, 2);
    TEST_ASSERT_EQUAL_DOUBLE(0, speed(&b));
    bench_close(&b);
}

static void test_the_same_run_repeats_exactly(void)
{
    double ends[2];
    for (int run = 0; run < 2; run++) {
        bench_t b;
        bench_open(&b, NULL, CM1E_PDO_ORDER_UG_4_4);
        bench_enable(&b, CSP);
        for (int i = 0; i < 2000; i++) {
            b.target_position += (i * 7919) % 101 - 50;
            bench_cycle(&b);
        }
        ends[run] = shaft(&b) + b.drive->mechanics.travel;
        bench_close(&b);
    }
    TEST_ASSERT_TRUE(ends[0] == ends[1]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_csp_follows_with_a_small_lag_at_every_cycle_time);
    RUN_TEST(test_csp_enabled_with_another_target_jumps_with_full_torque);
    RUN_TEST(test_csp_far_target_raises_position_error_overflow);
    RUN_TEST(test_csp_position_wraps_at_32_bits);
    RUN_TEST(test_following_bit_exists_since_1_3_0_and_only_while_following);
    RUN_TEST(test_velocity_units_by_firmware);
    RUN_TEST(test_shown_velocity_is_a_quarter_in_pp_below_1_3_0);
    RUN_TEST(test_csv_goes_to_its_target_at_once);
    RUN_TEST(test_csv_enabled_with_a_target_velocity_runs_at_once);
    RUN_TEST(test_velocities_above_the_peak_are_cut_to_it_in_csv_and_pv);
    RUN_TEST(test_over_speed_raises_7310_for_every_motor);
    RUN_TEST(test_pv_ramps_with_acceleration_and_deceleration);
    RUN_TEST(test_pv_comes_to_its_velocity_and_to_rest_once);
    RUN_TEST(test_a_halted_homing_comes_to_rest_once);
    RUN_TEST(test_a_motor_moves_until_it_rests_without_torque);
    RUN_TEST(test_torque_is_shown_in_per_mille_of_rated);
    RUN_TEST(test_overload_raises_2310_and_rated_load_does_not);
    RUN_TEST(test_pressing_against_a_stop_ends_in_a_fault);
    RUN_TEST(test_standing_without_torque_stays_for_ever);
    RUN_TEST(test_mode_display_changes_after_a_while_and_the_old_mode_serves_meanwhile);
    RUN_TEST(test_mode_changed_back_in_time_never_shows);
    RUN_TEST(test_switching_to_csp_with_an_old_target_jumps);
    RUN_TEST(test_switching_from_motion_to_pp_or_hm_stops_in_a_ramp);
    RUN_TEST(test_losing_torque_at_speed_runs_out);
    RUN_TEST(test_the_same_run_repeats_exactly);
    return UNITY_END();
}
