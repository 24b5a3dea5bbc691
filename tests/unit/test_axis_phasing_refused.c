/* What MC_PhasingAbsolute and MC_PhasingRelative (Part 1 4.8 and 4.9) refuse, the numbers that they take where the caller
 * gives none, and what guards a slave whose master becomes too fast. */
#include "unity.h"

#include "../support/phasing_bench.h"

void setUp(void) { axes_begin(3); }
void tearDown(void) { axes_end(); }

static void test_it_needs_a_slave_and_its_master(void)
{
    cm1e_axis_command_t c = shift(false, 1.0, 1.0);
    axes_refused(SLAVE, &c, CM1E_ERROR_AXIS_NOT_COUPLED);
    axes_move_velocity(SLAVE, 1.0);
    axes_refused(SLAVE, &c, CM1E_ERROR_AXIS_NOT_COUPLED);
    in_step(1, 1);
    seen.master[0].axis = axes_reference(OTHER);
    axes_refused(SLAVE, &c, CM1E_ERROR_AXIS_MASTER);
    seen.master[0].axis = axes_reference(SLAVE);
    axes_refused(SLAVE, &c, CM1E_ERROR_AXIS_MASTER);
    seen.master[0].axis = (AXIS_REF_t){0};
    axes_refused(SLAVE, &c, CM1E_ERROR_AXIS_MASTER);
    c.coupling = NULL;
    axes_refused(SLAVE, &c, CM1E_ERROR_AXIS_MASTER);
    c = shift(false, 1.0, 1.0);
    c.buffer_mode = (MC_BUFFER_MODE)6;
    axes_refused(SLAVE, &c, CM1E_ERROR_AXIS_BUFFER_MODE);
    axes_must_be(SLAVE, CM1E_AXIS_SYNCHRONIZED_MOTION);
}

static void test_numbers_that_the_slave_cannot_follow_are_refused_in_words(void)
{
    in_step(2, 1); /* of the slave's 50 u/s, 100 u/s2, 2000 u/s3 the master has half */
    const double velocities[] = {0.0, -1.0, NAN, INFINITY, 25.1}, positions[] = {NAN, INFINITY, 1e15};
    cm1e_axis_command_t c;
    for (size_t i = 0; i < sizeof velocities / sizeof velocities[0]; i++) {
        c = shift(true, 100.0, velocities[i]);
        axes_refused(SLAVE, &c, CM1E_ERROR_AXIS_VELOCITY_RANGE);
        axes_told(SLAVE, "not above 25 u/s");
    }
    for (size_t i = 0; i < sizeof positions / sizeof positions[0]; i++) {
        c = shift(false, positions[i], 1.0);
        axes_refused(SLAVE, &c, CM1E_ERROR_AXIS_POSITION_RANGE);
    }
    c = shift(false, 1.0, 1.0);
    c.acceleration = 50.1;
    axes_refused(SLAVE, &c, CM1E_ERROR_AXIS_DYNAMICS_RANGE);
    axes_told(SLAVE, "50 u/s2");
    c.acceleration = 0.0;
    c.deceleration = -1.0;
    axes_refused(SLAVE, &c, CM1E_ERROR_AXIS_DYNAMICS_RANGE);
    c.deceleration = 0.0;
    c.jerk = 1000.1;
    axes_refused(SLAVE, &c, CM1E_ERROR_AXIS_DYNAMICS_RANGE);
    axes_told(SLAVE, "1000 u/s3");
    axes_cycles(100);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, off(0.0));
}

/* 0: half of what the slave can do, so that its master may accelerate meanwhile. */
static void test_without_numbers_half_of_the_limits_are_the_shifts(void)
{
    in_step(2, 1);
    cm1e_axis_command_t c = shift(false, 3.0, 10.0);
    const cm1e_command_id_t id = axes_command(SLAVE, &c);
    axes_bench.witness[SLAVE].worst_gain = axes_bench.witness[SLAVE].worst_jerk = 0.0;
    axes_wait(SLAVE, id, 3000);
    TEST_ASSERT_DOUBLE_WITHIN(1.5, 50.0, axes_bench.witness[SLAVE].worst_gain);
    TEST_ASSERT_DOUBLE_WITHIN(1.0, 1000.0, axes_bench.witness[SLAVE].worst_jerk);
}

/* With the master's present velocity it would be too fast: refused, but for the way back. */
static void test_it_is_refused_where_it_is_too_fast_beside_the_master(void)
{
    axes_move_velocity(MASTER, 40.0);
    axes_cycles(2000);
    in_step(1, 1);
    cm1e_axis_command_t c = shift(true, 20.0, 12.0);
    axes_refused(SLAVE, &c, CM1E_ERROR_AXIS_VELOCITY_RANGE);
    axes_told(SLAVE, "40 now");
    by_shift(-20.0, 12.0);
    axes_cycles(200);
    c = shift(true, 0.01, 12.0); /* never comes to be so fast */
    axes_command(SLAVE, &c);
    axes_cycles(1000);
    axes_must_be(SLAVE, CM1E_AXIS_SYNCHRONIZED_MOTION);
}

/* While a shift moves, the slave sees the master with the velocity of that shift. What counts is the master itself. */
static void test_beside_a_shift_that_moves_only_the_velocity_of_the_master_counts(void)
{
    for (int sign = -1; sign <= 1; sign += 2) {
        axes_begin(3);
        axes_move_velocity(MASTER, 30.0);
        axes_cycles(2000);
        in_step(1, 1);
        by_shift(100.0 * sign, 15.0);
        axes_cycles(1000);
        TEST_ASSERT_EQUAL_DOUBLE(30.0 + 15.0 * sign, axes_info(SLAVE).set_velocity);
        cm1e_axis_command_t c = shift(true, 100.0, 21.0);
        axes_refused(SLAVE, &c, CM1E_ERROR_AXIS_VELOCITY_RANGE);
        axes_told(SLAVE, "30 now");
        by_shift(100.0, 19.0);
        axes_cycles(1000);
        TEST_ASSERT_EQUAL_DOUBLE(49.0, axes_info(SLAVE).set_velocity);
    }
}

/* The guard: a master that becomes too fast while the shift runs. No set-point beyond the limits is given out. */
static void test_a_master_that_becomes_too_fast_beside_it_stops_the_slave(void)
{
    axes_move_velocity(MASTER, 30.0);
    axes_cycles(2000);
    in_step(1, 1);
    const cm1e_command_id_t id = by_shift(100.0, 15.0);
    axes_cycles(500);
    axes_move_velocity(MASTER, 49.0);
    AXES_UNTIL(axes_state(SLAVE) == CM1E_AXIS_ERROR_STOP);
    TEST_ASSERT_EQUAL(CM1E_ERROR_AXIS_COUPLING_LIMIT, axes_info(SLAVE).error);
    TEST_ASSERT_EQUAL(CM1E_COMMAND_ERROR, state_of(id));
    axes_must_be(MASTER, CM1E_AXIS_CONTINUOUS_MOTION);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_it_needs_a_slave_and_its_master);
    RUN_TEST(test_numbers_that_the_slave_cannot_follow_are_refused_in_words);
    RUN_TEST(test_without_numbers_half_of_the_limits_are_the_shifts);
    RUN_TEST(test_it_is_refused_where_it_is_too_fast_beside_the_master);
    RUN_TEST(test_beside_a_shift_that_moves_only_the_velocity_of_the_master_counts);
    RUN_TEST(test_a_master_that_becomes_too_fast_beside_it_stops_the_slave);
    return UNITY_END();
}
