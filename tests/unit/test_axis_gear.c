/* MC_GearIn and MC_GearOut, Part 1 4.5 and 4.6: into step, in step, and out again. */
#include "unity.h"

#include "../support/axes_bench.h"

void setUp(void) { axes_begin(2); }
void tearDown(void) { axes_end(); }

enum { MASTER = 0, SLAVE = 1 };

static double set_of(int n) { return axes_info(n).set_position; }

/* 4.5, note 1: it ramps up to the ratio of the velocities and locks in; lost distance is not caught up. */
static void test_it_gets_into_step_with_a_master_that_moves(void)
{
    axes_move_velocity(MASTER, 4.0);
    axes_cycles(500);
    const cm1e_command_id_t gear = axes_gear_in(SLAVE, MASTER, 3, 2);
    axes_must_be(SLAVE, CM1E_AXIS_SYNCHRONIZED_MOTION);
    axes_cycles(1);
    TEST_ASSERT_FALSE(axes_status(SLAVE, gear).reached);
    axes_wait_reached(SLAVE, gear, 1000);
    TEST_ASSERT_EQUAL_DOUBLE(6.0, axes_info(SLAVE).set_velocity);
    const double master = set_of(MASTER), slave = set_of(SLAVE);
    for (int n = 0; n < 1000; n++) {
        axes_cycles(1);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 1.5 * (set_of(MASTER) - master), set_of(SLAVE) - slave);
    }
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, axes_status(SLAVE, gear).state);
    TEST_ASSERT_TRUE(axes_status(SLAVE, gear).reached);
}

/* The slave is before its master in the bus file, or behind it: no cycle of delay either way. */
static void test_it_follows_within_the_cycle_in_either_order(void)
{
    for (int slave = 0; slave < 2; slave++) {
        axes_begin(2);
        const int master = 1 - slave;
        const cm1e_command_id_t gear = axes_gear_in(slave, master, -1, 2);
        axes_cycles(1);
        TEST_ASSERT_TRUE(axes_status(slave, gear).reached);
        axes_move_to(master, 10.0, 5.0);
        for (int n = 0; n < 4000; n++) {
            axes_cycles(1);
            TEST_ASSERT_DOUBLE_WITHIN(1e-12, -0.5 * set_of(master), set_of(slave));
            TEST_ASSERT_DOUBLE_WITHIN(1e-12, -0.5 * axes_info(master).set_velocity, axes_info(slave).set_velocity);
        }
        TEST_ASSERT_EQUAL_DOUBLE(-5.0, set_of(slave));
    }
}

/* Whatever the master does on the way: the sum keeps the slave's limits (the bench watches), in a definite time. */
static void test_it_gets_into_step_with_a_master_that_accelerates(void)
{
    for (int delay = 0; delay < 120; delay += 7) {
        axes_begin(2);
        axes_move_velocity(MASTER, 10.0);
        axes_cycles(delay);
        const cm1e_command_id_t gear = axes_gear_in(SLAVE, MASTER, 1, 1);
        axes_cycles(30);
        axes_move_velocity(MASTER, 3.0);
        axes_wait_reached(SLAVE, gear, 2000);
        axes_cycles(1000);
        TEST_ASSERT_EQUAL_DOUBLE(3.0, axes_info(SLAVE).set_velocity);
    }
}

/* 4.6: Done at once; the last velocity is kept. */
static void test_out_of_gear_it_keeps_its_velocity(void)
{
    const cm1e_axis_command_t gently = {.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 4.0, .acceleration = 40.0,
                                        .jerk = 900.0};
    axes_command(MASTER, &gently);
    axes_gear_in(SLAVE, MASTER, 2, 1);
    axes_cycles(1500);
    const cm1e_axis_command_t out = {.kind = CM1E_COMMAND_GEAR_OUT};
    const cm1e_command_id_t id = axes_command(SLAVE, &out);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, axes_status(SLAVE, id).state);
    axes_must_be(SLAVE, CM1E_AXIS_CONTINUOUS_MOTION);
    axes_move_velocity(MASTER, 1.0);
    axes_cycles(500);
    TEST_ASSERT_EQUAL_DOUBLE(8.0, axes_info(SLAVE).set_velocity);
    axes_refused(SLAVE, &out, CM1E_ERROR_AXIS_NOT_COUPLED);
    axes_wait(SLAVE, axes_move_to(SLAVE, 0.0, 10.0), 20000);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, set_of(SLAVE));
}

/* In the middle of an acceleration, which is brought to an end, and back to the velocity. */
static void test_out_of_gear_while_it_accelerates(void)
{
    axes_gear_in(SLAVE, MASTER, 1, 1);
    axes_move_velocity(MASTER, 10.0);
    axes_cycles(60);
    const double velocity = axes_info(SLAVE).set_velocity;
    TEST_ASSERT_TRUE(axes_info(SLAVE).set_acceleration > 50.0);
    axes_command(SLAVE, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_GEAR_OUT});
    axes_cycles(500);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, velocity, axes_info(SLAVE).set_velocity);
}

/* Table 4: what waits behind begins at Done, but not in the middle of an acceleration. */
static void test_what_waits_behind_the_way_out_begins_when_the_velocity_is_there(void)
{
    const cm1e_axis_command_t behind = {.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 1.0, .buffer_mode = mcBuffered};
    for (int accelerating = 0; accelerating < 2; accelerating++) {
        if (accelerating)
            axes_end(), axes_begin(2);
        axes_gear_in(SLAVE, MASTER, 1, 1);
        axes_move_velocity(MASTER, 10.0);
        axes_cycles(accelerating ? 60 : 2000);
        const double velocity = axes_info(SLAVE).set_velocity;
        axes_command(SLAVE, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_GEAR_OUT});
        const cm1e_command_id_t id = axes_command(SLAVE, &behind);
        int waited = 0;
        while (axes_status(SLAVE, id).state == CM1E_COMMAND_BUFFERED) {
            axes_cycles(1);
            waited++;
        }
        TEST_ASSERT_EQUAL(accelerating, waited > 1);
        TEST_ASSERT_TRUE(waited < 500);
        TEST_ASSERT_DOUBLE_WITHIN(1.0, velocity, axes_info(SLAVE).set_velocity);
        axes_wait_reached(SLAVE, id, 2000);
        TEST_ASSERT_EQUAL_DOUBLE(1.0, axes_info(SLAVE).set_velocity);
    }
}

static void test_gear_out_does_not_end_a_cam_nor_anything_else(void)
{
    const cm1e_axis_command_t gear_out = {.kind = CM1E_COMMAND_GEAR_OUT}, cam_out = {.kind = CM1E_COMMAND_CAM_OUT};
    axes_refused(SLAVE, &gear_out, CM1E_ERROR_AXIS_NOT_COUPLED);
    axes_move_velocity(SLAVE, 1.0);
    axes_cycles(10);
    axes_refused(SLAVE, &gear_out, CM1E_ERROR_AXIS_NOT_COUPLED);
    axes_gear_in(SLAVE, MASTER, 1, 1);
    axes_refused(SLAVE, &cam_out, CM1E_ERROR_AXIS_NOT_COUPLED);
}

/* 4.5, note 2. */
static void test_another_ratio_takes_over_without_a_step(void)
{
    axes_move_velocity(MASTER, 4.0);
    const cm1e_command_id_t first = axes_gear_in(SLAVE, MASTER, 1, 1);
    axes_cycles(1000);
    const cm1e_command_id_t second = axes_gear_in(SLAVE, MASTER, -2, 1);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, axes_status(SLAVE, first).state);
    axes_cycles(1);
    TEST_ASSERT_FALSE(axes_status(SLAVE, second).reached);
    axes_wait_reached(SLAVE, second, 1000);
    TEST_ASSERT_EQUAL_DOUBLE(-8.0, axes_info(SLAVE).set_velocity);
}

/* ContinuousUpdate: InGear is FALSE at once, not from the next set-point on. */
static void test_another_ratio_of_the_same_command_is_reached_anew(void)
{
    const cm1e_axis_coupling_t twice = {.master = {{.axis = axes_reference(MASTER), .source = mcSetValue,
                                                    .numerator = 2, .denominator = 1}}};
    const cm1e_axis_coupling_t once = {.master = {{.axis = axes_reference(MASTER), .source = mcSetValue,
                                                   .numerator = 1, .denominator = 1}}};
    const cm1e_axis_command_t command = {.kind = CM1E_COMMAND_GEAR_IN, .coupling = &twice};
    const cm1e_axis_command_t as_it_began = {.kind = CM1E_COMMAND_GEAR_IN, .coupling = &once};
    axes_move_velocity(MASTER, 4.0);
    const cm1e_command_id_t gear = axes_gear_in(SLAVE, MASTER, 1, 1);
    axes_cycles(1000);
    TEST_ASSERT_TRUE(axes_status(SLAVE, gear).reached);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_update(axes_axis(SLAVE), gear, &as_it_began));
    TEST_ASSERT_TRUE(axes_status(SLAVE, gear).reached);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_update(axes_axis(SLAVE), gear, &command));
    TEST_ASSERT_FALSE(axes_status(SLAVE, gear).reached);
    axes_wait_reached(SLAVE, gear, 2000);
    TEST_ASSERT_EQUAL_DOUBLE(8.0, axes_info(SLAVE).set_velocity);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_update(axes_axis(SLAVE), gear, &command));
    TEST_ASSERT_TRUE(axes_status(SLAVE, gear).reached);
}

static void test_what_cannot_be_followed_is_refused(void)
{
    cm1e_axis_coupling_t coupling = {.master = {{.axis = axes_reference(SLAVE), .numerator = 1, .denominator = 1}}};
    const cm1e_axis_command_t command = {.kind = CM1E_COMMAND_GEAR_IN, .coupling = &coupling};
    axes_refused(SLAVE, &command, CM1E_ERROR_AXIS_COUPLING_CYCLE);
    coupling.master[0].axis.Handle ^= 0x5500;
    axes_refused(SLAVE, &command, CM1E_ERROR_AXIS_MASTER);
    axes_told(SLAVE, "Master names no axis of its scheduler; expected the AXIS_REF of another axis");
    coupling.master[0].axis = axes_reference(MASTER);
    coupling.master[0].numerator = 0;
    axes_refused(SLAVE, &command, CM1E_ERROR_AXIS_RATIO);
    coupling.master[0].numerator = 1;
    coupling.master[0].denominator = 0;
    axes_refused(SLAVE, &command, CM1E_ERROR_AXIS_RATIO);
    coupling.master[0].denominator = 1;
    axes_power(MASTER, false);
    axes_cycles(20);
    axes_refused(SLAVE, &command, CM1E_ERROR_AXIS_MASTER_LOST);
    axes_must_be(SLAVE, CM1E_AXIS_STANDSTILL);
}

/* A homing step may leave the set-point where the motor is not. With power back before its ramp has ended, the master's
 * set-point goes back to the motor. That is no motion to be followed, not even by a part of a count. */
static void test_it_does_not_follow_a_master_whose_set_point_goes_back_to_its_motor(void)
{
    static const cm1e_homing_step_t block = {.kind = CM1E_STEP_BLOCK, .detection_ns = 5000 * MS_IN_NS};
    for (int gap = 1; gap < 10; gap++) {
        axes_describe(2);
        axes_config(MASTER)->max_position_lag = 1.0;
        axes_make();
        axes_enable_all();
        axes_bench.witness[MASTER].strictness = AXES_UNWATCHED; /* it presses */
        axes_command(MASTER, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_HOMING_STEP, .step = &block, .velocity = 2.0});
        axes_cycles(100);
        axes_motor(MASTER)->blocked = true;
        axes_cycles(200);
        axes_power(MASTER, false);
        axes_cycles(gap);
        axes_must_be(MASTER, CM1E_AXIS_DISABLED);
        axes_gear_in(SLAVE, MASTER, 1, 1);
        axes_power(MASTER, true);
        axes_cycles(100);
        axes_must_be(MASTER, CM1E_AXIS_STANDSTILL);
        axes_must_be(SLAVE, CM1E_AXIS_ERROR_STOP);
        axes_told(SLAVE, "jump");
        TEST_ASSERT_EQUAL_DOUBLE(0.0, axes_bench.witness[SLAVE].lowest);
        TEST_ASSERT_EQUAL_DOUBLE(0.0, axes_bench.witness[SLAVE].highest);
    }
}

/* A command reaches its velocity inside a cycle, and the slave follows from the end of that cycle on, as fast. There it
 * must still be able to stop before its software limit. */
static void test_it_does_not_take_over_where_it_can_no_longer_stop(void)
{
    const double a = 100.0, jerk = 2000.0, cycle_s = 0.001; /* as an axis has them by default */
    for (int i = 0; i < 40; i++) {
        const double v = 10.0 + i * 0.013, reached_s = v / a + a / jerk, way = v * reached_s / 2.0;
        const double late_s = cycle_s * ceil(reached_s / cycle_s) - reached_s;
        const double limit = way + v * v / (2.0 * a) + v * late_s / 2.0;
        axes_describe(2);
        axes_config(SLAVE)->software_limit_negative = -100.0;
        axes_config(SLAVE)->software_limit_positive = limit;
        axes_make();
        axes_enable_all();
        const cm1e_axis_coupling_t coupling = {.master = {{.axis = axes_reference(MASTER), .source = mcSetValue,
                                                           .numerator = 1, .denominator = 1}}};
        axes_move_velocity(SLAVE, v);
        axes_command(SLAVE, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_GEAR_IN, .buffer_mode = mcBuffered,
                                                   .coupling = &coupling});
        axes_cycles(400);
        axes_must_be(SLAVE, CM1E_AXIS_ERROR_STOP);
        AXES_MUST(axes_bench.witness[SLAVE].highest <= limit + 1e-6, "%.9g u/s: at %.9g u, with a limit at %.9g u", v,
                  axes_bench.witness[SLAVE].highest, limit);
    }
}

/* The catch-up is planned with the jerk that the master leaves, and takes 228 cycles here. With less jerk it takes more
 * than 300. */
static void test_the_way_into_step_uses_the_jerk_that_the_master_leaves(void)
{
    axes_begin(2);
    (void)axes_command(MASTER, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 20,
                                                      .acceleration = 50, .jerk = 500});
    axes_cycles(200);
    const cm1e_command_id_t id = axes_gear_in(SLAVE, MASTER, 1, 1);
    int cycles = 0;
    for (; !axes_status(SLAVE, id).reached && cycles < 5000; cycles++)
        axes_cycles(1);
    TEST_ASSERT_LESS_THAN_INT(260, cycles);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_it_does_not_take_over_where_it_can_no_longer_stop);
    RUN_TEST(test_it_does_not_follow_a_master_whose_set_point_goes_back_to_its_motor);
    RUN_TEST(test_it_gets_into_step_with_a_master_that_moves);
    RUN_TEST(test_it_follows_within_the_cycle_in_either_order);
    RUN_TEST(test_it_gets_into_step_with_a_master_that_accelerates);
    RUN_TEST(test_out_of_gear_it_keeps_its_velocity);
    RUN_TEST(test_out_of_gear_while_it_accelerates);
    RUN_TEST(test_what_waits_behind_the_way_out_begins_when_the_velocity_is_there);
    RUN_TEST(test_gear_out_does_not_end_a_cam_nor_anything_else);
    RUN_TEST(test_another_ratio_takes_over_without_a_step);
    RUN_TEST(test_another_ratio_of_the_same_command_is_reached_anew);
    RUN_TEST(test_what_cannot_be_followed_is_refused);
    RUN_TEST(test_the_way_into_step_uses_the_jerk_that_the_master_leaves);
    return UNITY_END();
}
