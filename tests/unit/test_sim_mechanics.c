/** The axis behind a simulated motor: physics that must hold for any load, torque and step length. */
#include <math.h>
#include <stdio.h>

#include "sim/servo.h"
#include "sim/mechanics.h"
#include "unity.h"

#define ROTOR_INERTIA 3.5e-6
#define STEP_S 250e-6

void setUp(void) {}
void tearDown(void) {}

static uint64_t random_state;

static double random_between(double low, double high)
{
    random_state = random_state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return low + (high - low) * (double)(random_state >> 11) / (double)(UINT64_C(1) << 53);
}

static cm1e_mechanics_t standard(void)
{
    cm1e_mechanics_t m;
    cm1e_mechanics_init(&m, &(cm1e_sim_axis_config_t){0}, ROTOR_INERTIA);
    return m;
}

static void run(cm1e_mechanics_t *m, double torque, double seconds)
{
    for (int i = 0; i < (int)(seconds / STEP_S + 0.5); i++)
        cm1e_mechanics_step(m, torque, STEP_S);
}

static void test_zeroed_configuration_gives_the_documented_axis(void)
{
    const cm1e_mechanics_t m = standard();
    TEST_ASSERT_EQUAL_DOUBLE(250000, m.stop_positive);
    TEST_ASSERT_EQUAL_DOUBLE(-250000, m.stop_negative);
    TEST_ASSERT_EQUAL_DOUBLE(0.005, m.friction);
    TEST_ASSERT_DOUBLE_WITHIN(1, CM1E_COUNTS_PER_RADIAN / (ROTOR_INERTIA + 2e-6), m.gain);
    TEST_ASSERT_EQUAL_DOUBLE(0, m.position);
}

static void test_torque_below_friction_moves_nothing(void)
{
    cm1e_mechanics_t m = standard();
    run(&m, 0.0049, 10);
    TEST_ASSERT_EQUAL_DOUBLE(0, m.position);
    TEST_ASSERT_TRUE(cm1e_mechanics_at_rest(&m));
    m.load_torque = 0.0051;
    TEST_ASSERT_FALSE(cm1e_mechanics_at_rest(&m));
    run(&m, 0, 1);
    TEST_ASSERT_TRUE(m.position > 100);
}

static void test_free_acceleration_is_that_of_the_inertia(void)
{
    cm1e_mechanics_t m;
    cm1e_mechanics_init(&m, &(cm1e_sim_axis_config_t){.friction = 1e-12, .viscous_friction = 1e-12, .no_stops = true},
                        ROTOR_INERTIA);
    run(&m, 0.01, 0.1);
    const double acceleration = 0.01 / (ROTOR_INERTIA + 2e-6) * CM1E_COUNTS_PER_RADIAN;
    TEST_ASSERT_DOUBLE_WITHIN(acceleration * 1e-6, acceleration * 0.1, m.velocity);
    TEST_ASSERT_DOUBLE_WITHIN(acceleration * 0.005 * 0.01, acceleration * 0.1 * 0.1 / 2, m.position);
}

static void test_viscous_friction_sets_the_highest_speed(void)
{
    cm1e_mechanics_t m;
    cm1e_mechanics_init(&m, &(cm1e_sim_axis_config_t){.viscous_friction = 1e-3, .no_stops = true}, ROTOR_INERTIA);
    run(&m, 0.1, 2);
    const double highest = (0.1 - 0.005) / 1e-3 * CM1E_COUNTS_PER_RADIAN;
    TEST_ASSERT_DOUBLE_WITHIN(highest * 0.01, highest, m.velocity);
}

static void test_a_shaft_left_alone_slows_down_and_stays(void)
{
    cm1e_mechanics_t m = standard();
    m.stop_positive = INFINITY;
    m.velocity = 2500000;
    double before = m.velocity;
    for (int i = 0; i < 8000; i++) {
        cm1e_mechanics_step(&m, 0, STEP_S);
        TEST_ASSERT_TRUE(m.velocity >= 0 && m.velocity <= before);
        before = m.velocity;
    }
    TEST_ASSERT_EQUAL_DOUBLE(0, m.velocity);
    const double end = m.position;
    run(&m, 0, 1);
    TEST_ASSERT_EQUAL_DOUBLE(end, m.position);
}

static void test_a_stop_is_never_passed_and_never_throws_back(void)
{
    for (double velocity = 1000; velocity < 1e9; velocity *= 3) {
        cm1e_mechanics_t m = standard();
        m.velocity = velocity;
        for (int i = 0; i < 4000; i++) {
            cm1e_mechanics_step(&m, 0.02, STEP_S);
            TEST_ASSERT_TRUE(m.position <= 250000);
            TEST_ASSERT_TRUE(m.velocity >= 0);
        }
        TEST_ASSERT_EQUAL_DOUBLE(250000, m.position);
        TEST_ASSERT_TRUE(cm1e_mechanics_at_stop(&m));
        run(&m, -0.02, 0.1);
        TEST_ASSERT_TRUE(m.position < 249000);
    }
}

/* Whatever happens, the kinetic energy grows by no more than the torque's work. */
static void test_random_torque_and_steps_never_gain_energy(void)
{
    random_state = 20250328;
    const double inertia = ROTOR_INERTIA + 2e-6;
    for (int trial = 0; trial < 200; trial++) {
        cm1e_mechanics_t m = standard();
        m.load_torque = random_between(-0.05, 0.05);
        double energy = 0;
        for (int i = 0; i < 500; i++) {
            const double torque = random_between(-0.2, 0.2), step_s = random_between(1e-9, 250e-6);
            cm1e_mechanics_step(&m, torque, step_s);
            const double speed = m.velocity / CM1E_COUNTS_PER_RADIAN;
            const double next = inertia * speed * speed / 2;
            const double work = (torque + m.load_torque) * speed * step_s;
            TEST_ASSERT_TRUE(isfinite(m.position) && isfinite(m.velocity));
            TEST_ASSERT_TRUE_MESSAGE(next <= energy + fmax(work, 0) + 1e-12, "energy out of nothing (seed 20250328)");
            energy = next;
        }
    }
}

static void test_probe_values_follow_the_shaft(void)
{
    cm1e_mechanics_t m = standard();
    run(&m, 0.02, 0.02);
    run(&m, -0.02, 0.1);
    TEST_ASSERT_TRUE(m.travel > fabs(m.position));
    TEST_ASSERT_TRUE(m.peak_velocity >= fabs(m.velocity));
    TEST_ASSERT_TRUE(m.peak_velocity > 0);
}

/* ---- the position servo on it ----------------------------------------------------------------------------------- */

static cm1e_servo_t servo_on(const cm1e_mechanics_t *m)
{
    cm1e_servo_t servo;
    cm1e_servo_init(&servo, m);
    servo.torque_limit = 0.117;
    cm1e_servo_catch(&servo, m);
    return servo;
}

static void servo_run(cm1e_servo_t *servo, cm1e_mechanics_t *m, double velocity, double seconds, double step_s)
{
    servo->reference_velocity = velocity;
    for (int i = 0; i < (int)(seconds / step_s + 0.5); i++) {
        servo->reference += velocity * step_s;
        cm1e_mechanics_step(m, cm1e_servo_step(servo, m, step_s), step_s);
    }
}

static void test_servo_settles_within_a_count_for_any_step_and_load(void)
{
    static const double steps[] = {1e-6, 20e-6, 100e-6, 200e-6, 250e-6};
    static const double loads[] = {0, 0.004, -0.02, 0.05, -0.08};
    static const double inertias[] = {1e-7, 2e-6, 5e-5, 1e-3};
    for (size_t s = 0; s < 5; s++)
        for (size_t l = 0; l < 5; l++)
            for (size_t k = 0; k < 4; k++) {
                cm1e_mechanics_t m;
                cm1e_mechanics_init(&m, &(cm1e_sim_axis_config_t){.load_inertia = inertias[k]}, ROTOR_INERTIA);
                m.load_torque = loads[l];
                cm1e_servo_t servo = servo_on(&m);
                servo.reference = 100;
                servo_run(&servo, &m, 0, 2, steps[s]);
                TEST_ASSERT_DOUBLE_WITHIN(1, 100, m.position);
            }
}

static void test_servo_lags_by_some_counts_at_speed(void)
{
    cm1e_mechanics_t m = standard();
    m.stop_positive = INFINITY;
    cm1e_servo_t servo = servo_on(&m);
    for (double velocity = 0; velocity < 2000000; velocity += 5000)
        servo_run(&servo, &m, velocity, STEP_S * 4, STEP_S);
    servo_run(&servo, &m, 2000000, 0.5, STEP_S);
    const double lag = servo.reference - m.position;
    TEST_ASSERT_TRUE_MESSAGE(lag > 5 && lag < 200, "lag");
    TEST_ASSERT_DOUBLE_WITHIN(100, 2000000, m.velocity);
}

static void test_servo_torque_stays_within_its_limit(void)
{
    cm1e_mechanics_t m = standard();
    cm1e_servo_t servo = servo_on(&m);
    random_state = 7;
    for (int i = 0; i < 20000; i++) {
        servo.reference = random_between(-300000, 300000);
        servo.reference_velocity = random_between(-3e6, 3e6);
        servo.torque_limit = random_between(0.001, 0.117);
        const double torque = cm1e_servo_step(&servo, &m, STEP_S);
        TEST_ASSERT_TRUE(fabs(torque) <= servo.torque_limit);
        cm1e_mechanics_step(&m, torque, STEP_S);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_zeroed_configuration_gives_the_documented_axis);
    RUN_TEST(test_torque_below_friction_moves_nothing);
    RUN_TEST(test_free_acceleration_is_that_of_the_inertia);
    RUN_TEST(test_a_shaft_left_alone_slows_down_and_stays);
    RUN_TEST(test_a_stop_is_never_passed_and_never_throws_back);
    RUN_TEST(test_random_torque_and_steps_never_gain_energy);
    RUN_TEST(test_probe_values_follow_the_shaft);
    RUN_TEST(test_servo_settles_within_a_count_for_any_step_and_load);
    RUN_TEST(test_servo_lags_by_some_counts_at_speed);
    RUN_TEST(test_servo_torque_stays_within_its_limit);
    RUN_TEST(test_viscous_friction_sets_the_highest_speed);
    return UNITY_END();
}
