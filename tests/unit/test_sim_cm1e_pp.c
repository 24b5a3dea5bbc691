/** Profile position mode of the simulated CM1-E on its axis (UG 6.2.2). */
#include <math.h>

#include "sim_cm1e_bench.h"

void setUp(void) {}
void tearDown(void) {}

enum { PP = 1 };
enum { BIT10 = 0x0400, BIT12 = 0x1000, BIT13 = 0x2000 };

static double speed(const bench_t *b) { return b->drive->mechanics.velocity; }

static void open_pp(bench_t *b, uint32_t velocity, uint32_t acceleration)
{
    bench_open_endless(b, "1.3.5");
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
        TEST_ASSERT_EQUAL_DOUBLE(1000000, b.drive->motion.profile_acceleration);
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
        bench_open_endless(&b, "1.3.5");
        b.drive->al_state = BENCH_PREOP;
        bench_write(&b, 0x1C12, 0, 0);
        bench_write(&b, 0x1C12, 1, 0x1603);
        bench_write(&b, 0x1C12, 0, 1);
        bench_to_op(&b);
        bench_enable(&b, PP);
        b.profile_acceleration = rows[i].written;
        b.profile_velocity = UINT32_MAX;
        set_point(&b, 1000);
        TEST_ASSERT_EQUAL_DOUBLE(rows[i].used, b.drive->motion.profile_acceleration);
        TEST_ASSERT_EQUAL_DOUBLE(2500000, b.drive->motion.profile_velocity);
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
    TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(100, 200000, b.drive->servo.reference_velocity,
                                      "a new value waits for its set-point");
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
    bench_open_endless(&b, "1.3.5");
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

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_pp_handshake_of_the_set_point);
    RUN_TEST(test_pp_reaches_any_target_without_overshoot);
    RUN_TEST(test_pp_velocity_and_acceleration_are_kept);
    RUN_TEST(test_pp_values_over_the_process_data_are_rounded_and_limited);
    RUN_TEST(test_pp_smallest_acceleration_is_1000);
    RUN_TEST(test_pp_new_set_point_on_the_way_acts_at_once);
    RUN_TEST(test_pp_target_is_not_reached_while_running_over_it);
    RUN_TEST(test_pp_halt_stops_and_going_on_continues);
    RUN_TEST(test_pp_following_error_bit_while_the_axis_is_held);
    RUN_TEST(test_pp_enabled_with_bit_4_set_starts_no_move);
    return UNITY_END();
}
