/** CSP, CSV, PP and PV of the simulated CM1-E on its axis (UG 6.2), and switching between them. */
#include <math.h>
#include <stdio.h>

#include "sim_cm1e_bench.h"

void setUp(void) {}
void tearDown(void) {}

enum { PP = 1, PV = 3, HM = 6, CSP = 8, CSV = 9 };
enum { BIT10 = 0x0400, BIT12 = 0x1000, BIT13 = 0x2000 };

static const char *const firmwares[] = {"1.2.0", "1.3.0", "1.3.2", "1.3.3", "1.3.4", "1.3.5"};
enum { FIRMWARES = 6 };

static void open_endless(bench_t *b, const char *firmware)
{
    cm1e_axis_config_t config = bench_firmware(firmware);
    config.sim.no_stops = config.sim.no_sensors = true;
    bench_open(b, &config, CM1E_PDO_ORDER_UG_4_4);
}

static double shaft(const bench_t *b) { return b->drive->mechanics.position; }
static double speed(const bench_t *b) { return b->drive->mechanics.velocity; }

/* ---- cyclic synchronous position ---------------------------------------------------------------------------------- */

static void test_csp_follows_with_a_small_lag_at_every_cycle_time(void)
{
    static const int64_t cycles[] = {200000, 250000, 500000, 1000000};
    for (int i = 0; i < 4; i++) {
        bench_t b;
        open_endless(&b, "1.3.5");
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
    open_endless(&b, "1.3.5");
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
    open_endless(&b, "1.3.5");
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
            open_endless(&b, firmwares[f]);
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
    open_endless(&b, "1.3.5");
    bench_enable(&b, CSP);
    b.target_position += 30000;
    bench_run(&b, 0.005);
    TEST_ASSERT_EQUAL(0, b.statusword & BIT12);
    TEST_ASSERT_EQUAL_HEX16(0x8611, b.error_code);
    bench_run(&b, 1);
    TEST_ASSERT_EQUAL(BIT12, b.statusword & BIT12);
    bench_close(&b);
}

/* ---- velocity modes ----------------------------------------------------------------------------------------------- */

/* UG 10.1: counts/ms before V1.3.3; below V1.3.0 a quarter in HM and PP. */
static void test_velocity_units_by_firmware(void)
{
    static const int8_t modes[] = {CSV, PV};
    for (int f = 0; f < FIRMWARES; f++)
        for (int m = 0; m < 2; m++) {
            const int32_t unit = f < CM1E_FIRMWARE_1_3_3 ? 1000 : 1;
            bench_t b;
            open_endless(&b, firmwares[f]);
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
        open_endless(&b, firmwares[f]);
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
    open_endless(&b, "1.3.5");
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
    open_endless(&b, "1.3.5");
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

static void test_over_speed_raises_7310_for_every_motor(void)
{
    for (int m = 0; m < 4; m++) {
        cm1e_axis_config_t config = {.sim.no_stops = true};
        strcpy(config.motor, cm1e_device_motors[m].name);
        bench_t b;
        bench_open(&b, &config, CM1E_PDO_ORDER_UG_4_4);
        bench_enable(&b, CSV);
        b.target_velocity = cm1e_device_motors[m].max_velocity_counts_per_s;
        bench_run(&b, 1);
        TEST_ASSERT_EQUAL_MESSAGE(OPERATION_ENABLED, bench_state(&b), "peak speed is allowed");
        b.target_velocity = (int32_t)(1.2 * b.target_velocity);
        bench_run(&b, 1);
        TEST_ASSERT_EQUAL_HEX16(0x7310, b.error_code);
        TEST_ASSERT_EQUAL(FAULT, bench_state(&b));
        bench_run(&b, 3);
        TEST_ASSERT_EQUAL_DOUBLE_MESSAGE(0, speed(&b), "it runs out without torque");
        bench_close(&b);
    }
}

/* "The deceleration value is only used when the target velocity is set to 0 or the halt bit is set" (UG 6.2.3). */
static void test_pv_ramps_with_acceleration_and_deceleration(void)
{
    bench_t b;
    open_endless(&b, "1.3.5");
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

/* ---- profile position --------------------------------------------------------------------------------------------- */

static void open_pp(bench_t *b, uint32_t velocity, uint32_t acceleration)
{
    open_endless(b, "1.3.5");
    bench_write(b, 0x6081, 0, velocity);
    bench_write(b, 0x6083, 0, acceleration);
    bench_enable(b, PP);
}

static void set_point(bench_t *b, int32_t target)
{
    b->target_position = target;
    b->controlword = 0x0F;
    bench_cycle(b);
    b->controlword = 0x1F;
    bench_cycle(b);
}

static void test_pp_handshake_of_the_set_point(void)
{
    bench_t b;
    open_pp(&b, 200000, 2000000);
    bench_run(&b, 0.1);
    TEST_ASSERT_EQUAL_HEX16_MESSAGE(BIT10, b.statusword & (BIT10 | BIT12 | BIT13), "stands where it is");
    b.target_position = 50000;
    bench_run(&b, 0.2);
    TEST_ASSERT_EQUAL_MESSAGE(0, b.position, "no edge, no motion");
    b.controlword = 0x1F;
    bench_cycle(&b);
    TEST_ASSERT_EQUAL_HEX16(BIT12, b.statusword & (BIT10 | BIT12));
    bench_run(&b, 0.1);
    TEST_ASSERT_EQUAL_HEX16_MESSAGE(BIT12, b.statusword & (BIT10 | BIT12), "acknowledged while bit 4 is set");
    b.target_position = 70000;
    bench_cycle(&b);
    b.controlword = 0x0F;
    bench_cycle(&b);
    TEST_ASSERT_EQUAL_HEX16(0, b.statusword & (BIT10 | BIT12));
    TEST_ASSERT_TRUE(bench_until(&b, BIT10, BIT10, 2));
    TEST_ASSERT_INT32_WITHIN(10, 50000, b.position);
    bench_run(&b, 0.5);
    TEST_ASSERT_INT32_WITHIN(1, 50000, b.position);
    bench_close(&b);
}

static void test_pp_reaches_any_target_without_overshoot(void)
{
    static const int32_t targets[] = {1, -3, 50, -49, 1000, 50000, -50001, 400000, -400000, 0};
    static const uint32_t velocities[] = {100, 20000, 2500000};
    static const uint32_t accelerations[] = {100000, 2000000, 32767000};
    for (int v = 0; v < 3; v++)
        for (int a = 0; a < 3; a++) {
            bench_t b;
            open_pp(&b, velocities[v], accelerations[a]);
            int32_t from = 0;
            for (size_t i = 0; i < sizeof targets / sizeof targets[0]; i++) {
                const double distance = fabs((double)targets[i] - from);
                if (distance / velocities[v] > 20)
                    continue;
                set_point(&b, targets[i]);
                double most = 0;
                const double time = distance / velocities[v] + 2 * sqrt(distance / accelerations[a]) + 1.5;
                for (int n = 0; n < (int)(time * 1000) && !(b.statusword & BIT10); n++) {
                    bench_cycle(&b);
                    const double past = targets[i] > from ? b.drive->servo.reference - targets[i]
                                                          : targets[i] - b.drive->servo.reference;
                    most = fmax(most, past);
                }
                TEST_ASSERT_TRUE_MESSAGE(b.statusword & BIT10, "not reached");
                TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(0.01, 0, most, "the profile ran past its target");
                TEST_ASSERT_TRUE(fabs(speed(&b)) < 2600000);
                from = targets[i];
            }
            bench_close(&b);
        }
}

static void test_pp_velocity_and_acceleration_are_kept(void)
{
    bench_t b;
    open_pp(&b, 300000, 1000400); /* kept as 1,000,000 */
    set_point(&b, 300000);
    double peak = 0, last = 0, steepest = 0;
    while (!(b.statusword & BIT10)) {
        bench_cycle(&b);
        peak = fmax(peak, b.drive->servo.reference_velocity);
        TEST_ASSERT_EQUAL_DOUBLE(1000000, b.drive->profile_acceleration);
        steepest = fmax(steepest, fabs(b.drive->servo.reference_velocity - last));
        last = b.drive->servo.reference_velocity;
    }
    TEST_ASSERT_EQUAL_DOUBLE(300000, peak);
    TEST_ASSERT_DOUBLE_WITHIN(260, 1000, steepest); /* per cycle of 1 ms; the last step lands */
    bench_close(&b);
}

/* Over the process data of 0x1603 nothing is checked or refused: the drive rounds when it uses the value. */
static void test_pp_values_over_the_process_data_are_rounded_and_limited(void)
{
    static const struct {
        uint32_t written;
        double used;
    } rows[] = {{0, 1000}, {1, 1000}, {1499, 1000}, {1500, 2000}, {1000400, 1000000}, {32767000, 32767000},
                {UINT32_MAX, 32767000}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        bench_t b;
        open_endless(&b, "1.3.5");
        b.drive->al_state = BENCH_PREOP;
        bench_write(&b, 0x1C12, 0, 0);
        bench_write(&b, 0x1C12, 1, 0x1603);
        bench_write(&b, 0x1C12, 0, 1);
        bench_to_op(&b);
        bench_enable(&b, PP);
        b.profile_acceleration = rows[i].written;
        b.profile_velocity = UINT32_MAX;
        set_point(&b, 1000);
        TEST_ASSERT_EQUAL_DOUBLE(rows[i].used, b.drive->profile_acceleration);
        TEST_ASSERT_EQUAL_DOUBLE(2500000, b.drive->profile_velocity);
        bench_close(&b);
    }
}

static void test_pp_smallest_acceleration_is_1000(void)
{
    bench_t b;
    open_pp(&b, 2000000, 0);
    set_point(&b, 1000000);
    bench_run(&b, 1);
    TEST_ASSERT_DOUBLE_WITHIN(20, 1000, b.drive->servo.reference_velocity);
    bench_close(&b);
}

static void test_pp_new_set_point_on_the_way_acts_at_once(void)
{
    bench_t b;
    open_pp(&b, 200000, 2000000);
    set_point(&b, 200000);
    bench_run(&b, 0.5);
    bench_write(&b, 0x6081, 0, 400000);
    bench_run(&b, 0.1);
    TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(100, 200000, b.drive->servo.reference_velocity, "a new value waits for its set-point");
    set_point(&b, -100000);
    TEST_ASSERT_TRUE(bench_until(&b, BIT10, BIT10, 5));
    TEST_ASSERT_INT32_WITHIN(10, -100000, b.position);
    TEST_ASSERT_DOUBLE_WITHIN(5000, 400000, b.drive->mechanics.peak_velocity);
    bench_close(&b);
}

static void test_pp_target_is_not_reached_while_running_over_it(void)
{
    bench_t b;
    open_pp(&b, 200000, 1000000);
    set_point(&b, 200000);
    bench_run(&b, 0.4);
    set_point(&b, b.position + 400); /* 20,000 counts are needed to stop */
    while (!(b.statusword & BIT10))
        bench_cycle(&b);
    TEST_ASSERT_TRUE(fabs(speed(&b)) < 5000);
    TEST_ASSERT_INT32_WITHIN(10, b.target_position, b.position);
    TEST_ASSERT_TRUE(b.drive->mechanics.travel > b.position + 30000);
    bench_close(&b);
}

static void test_pp_halt_stops_and_going_on_continues(void)
{
    bench_t b;
    open_pp(&b, 200000, 1000000);
    set_point(&b, 200000);
    bench_run(&b, 0.4);
    b.controlword = 0x11F;
    bench_cycle(&b);
    TEST_ASSERT_EQUAL(0, b.statusword & BIT10);
    TEST_ASSERT_TRUE(bench_until(&b, BIT10, BIT10, 0.5));
    const int32_t stopped = b.position;
    TEST_ASSERT_TRUE(stopped < 150000);
    bench_run(&b, 0.5);
    TEST_ASSERT_INT32_WITHIN(60, stopped, b.position);
    b.controlword = 0x1F;
    bench_cycle(&b);
    TEST_ASSERT_EQUAL(0, b.statusword & BIT10);
    TEST_ASSERT_TRUE(bench_until(&b, BIT10, BIT10, 3));
    TEST_ASSERT_INT32_WITHIN(10, 200000, b.position);
    bench_close(&b);
}

static void test_pp_following_error_bit_while_the_axis_is_held(void)
{
    bench_t b;
    open_pp(&b, 200000, 1000000);
    b.drive->mechanics.stop_positive = 0;
    set_point(&b, 30000);
    bench_run(&b, 0.1);
    TEST_ASSERT_EQUAL(BIT13, b.statusword & BIT13);
    TEST_ASSERT_TRUE_MESSAGE(bench_until(&b, 0x4F, 0x08, 3), "overload in the end");
    TEST_ASSERT_EQUAL_HEX16(0x2310, b.error_code);
    bench_close(&b);
}

static void test_pp_enabled_with_bit_4_set_starts_no_move(void)
{
    bench_t b;
    open_endless(&b, "1.3.5");
    bench_write(&b, 0x6081, 0, 100000);
    b.mode = PP;
    b.target_position = 50000;
    b.controlword = 0x16;
    bench_run(&b, 0.02);
    b.controlword = 0x1F; /* bit 4 rose before */
    bench_run(&b, 0.2);
    TEST_ASSERT_EQUAL(OPERATION_ENABLED, bench_state(&b));
    TEST_ASSERT_EQUAL(0, b.position);
    bench_close(&b);
}

/* ---- load --------------------------------------------------------------------------------------------------------- */

static void test_torque_is_shown_in_per_mille_of_rated(void)
{
    bench_t b;
    open_endless(&b, "1.3.5");
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
    open_endless(&b, "1.3.5");
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

/* ---- switching ---------------------------------------------------------------------------------------------------- */

static void test_mode_display_changes_after_a_while_and_the_old_mode_serves_meanwhile(void)
{
    static const int8_t modes[] = {PP, PV, HM, CSP, CSV};
    for (int from = 0; from < 5; from++)
        for (int to = 0; to < 5; to++) {
            if (from == to)
                continue;
            bench_t b;
            open_endless(&b, "1.3.5");
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
    open_endless(&b, "1.3.5");
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
    open_endless(&b, "1.3.5");
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
        open_endless(&b, "1.3.5");
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
    open_endless(&b, "1.3.5");
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
    RUN_TEST(test_over_speed_raises_7310_for_every_motor);
    RUN_TEST(test_pv_ramps_with_acceleration_and_deceleration);
    RUN_TEST(test_pp_handshake_of_the_set_point);
    RUN_TEST(test_pp_reaches_any_target_without_overshoot);
    RUN_TEST(test_pp_velocity_and_acceleration_are_kept);
    RUN_TEST(test_pp_smallest_acceleration_is_1000);
    RUN_TEST(test_pp_new_set_point_on_the_way_acts_at_once);
    RUN_TEST(test_pp_halt_stops_and_going_on_continues);
    RUN_TEST(test_pp_following_error_bit_while_the_axis_is_held);
    RUN_TEST(test_pp_enabled_with_bit_4_set_starts_no_move);
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
    RUN_TEST(test_pp_target_is_not_reached_while_running_over_it);
    RUN_TEST(test_pp_values_over_the_process_data_are_rounded_and_limited);
    return UNITY_END();
}
