/* MC_PhasingAbsolute and MC_PhasingRelative, Part 1 4.8 and 4.9: the slave sees its master shifted. The bench watches
 * every set-point: position, velocity and acceleration go on without a step within the limits of the axes. */
#include "unity.h"

#include "../support/phasing_bench.h"
#include "coupling/coupling_private.h"

void setUp(void) { axes_begin(3); }
void tearDown(void) { axes_end(); }

static cm1e_command_id_t then_shift(bool relative, double position, double velocity)
{
    cm1e_axis_command_t c = shift(relative, position, velocity);
    c.buffer_mode = mcBuffered;
    return axes_command(SLAVE, &c);
}

/* ---- against the ideal ------------------------------------------------------------------------------------------- */

/* A shift of its own against one that the test makes with the same numbers, sample by sample. */
static void check_against_the_ideal(double from, double to, const cm1e_axis_command_t *c)
{
    const cm1e_motion_limits_t limits = {c->velocity, c->acceleration, c->deceleration, c->jerk};
    const cm1e_motion_state_t start = {.position = from};
    cm1e_profile_t ideal;
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_profile_to_position(&ideal, &start, to, &limits));
    const cm1e_command_id_t id = axes_command(SLAVE, c);
    const int cycles = (int)(ideal.duration_s * 1000.0) + 50;
    for (int n = 1; n <= cycles; n++) {
        cm1e_motion_state_t now;
        axes_cycles(1);
        cm1e_profile_sample(&ideal, n * 1e-3, &now);
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1.0, 0.0, off(now.position), axes_text(SLAVE));
        TEST_ASSERT_DOUBLE_WITHIN(1e-9 * fmax(1.0, fabs(to)),
                                  now.position - (c->kind == CM1E_COMMAND_PHASING_RELATIVE ? from : 0.0),
                                  axes_status(SLAVE, id).covered);
    }
    TEST_ASSERT_EQUAL(CM1E_COMMAND_DONE, state_of(id));
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, 0.0, off(to));
}

static void test_shift_is_the_ideal_one_at_every_sample_in_both_directions(void)
{
    static const struct {
        int32_t numerator;
        uint32_t denominator;
        double master;
    } cases[] = {{1, 1, 0.0}, {1, 1, 5.0}, {-3, 2, 4.0}, {2, 7, -10.0}, {-1, 1, -8.0}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        axes_begin(3);
        if (cases[i].master != 0.0)
            axes_move_velocity(MASTER, cases[i].master);
        axes_cycles(1000);
        in_step(cases[i].numerator, cases[i].denominator);
        cm1e_axis_command_t c = shift(false, 2.5, 3.0);
        c.acceleration = 20.0;
        c.deceleration = 12.0;
        c.jerk = 400.0;
        check_against_the_ideal(0.0, 2.5, &c);
        c = shift(true, -4.0, 2.0);
        c.acceleration = 10.0;
        c.deceleration = 15.0;
        c.jerk = 300.0;
        check_against_the_ideal(2.5, -1.5, &c);
        c = shift(false, 0.0, 2.0);
        c.acceleration = c.deceleration = 10.0;
        c.jerk = 300.0;
        check_against_the_ideal(-1.5, 0.0, &c);
    }
}

static void test_shift_of_axes_with_other_units_and_a_way_round(void)
{
    axes_describe(3);
    axes_config(MASTER)->counts_per_unit = 500.0;
    axes_config(MASTER)->modulo_range = 360.0;
    axes_config(SLAVE)->invert = true;
    axes_config(SLAVE)->counts_per_unit = 1234.5;
    axes_make();
    axes_enable_all();
    axes_move_velocity(MASTER, 300.0);
    axes_cycles(1500);
    in_step(1, 20);
    cm1e_axis_command_t c = shift(false, 90.0, 60.0);
    c.acceleration = c.deceleration = 100.0;
    c.jerk = 2000.0;
    check_against_the_ideal(0.0, 90.0, &c);
    axes_cycles(2000);
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, 0.0, off(90.0));
}

/* The master turns round meanwhile, and comes again. */
static void test_shift_adds_to_a_master_whatever_that_does(void)
{
    axes_move_velocity(MASTER, 5.0);
    axes_cycles(800);
    in_step(1, 2);
    const cm1e_command_id_t id = to_shift(6.0, 4.0);
    for (int n = 0; n < 3000; n++) {
        if (n == 300)
            axes_move_velocity(MASTER, -5.0);
        if (n == 900)
            axes_move_to(MASTER, 2.0, 8.0);
        axes_cycles(1);
        TEST_ASSERT_DOUBLE_WITHIN(1.0, 0.0, off(n < 2999 && state_of(id) == CM1E_COMMAND_ACTIVE
                                                    ? axes_status(SLAVE, id).covered : 6.0));
    }
    TEST_ASSERT_EQUAL(CM1E_COMMAND_DONE, state_of(id));
    axes_must_be(SLAVE, CM1E_AXIS_SYNCHRONIZED_MOTION);
}

/* 3.17 and here: coordinates are no motion. */
static void test_set_positions_of_both_leave_a_shift_under_way_alone(void)
{
    axes_move_velocity(MASTER, 2.0);
    axes_cycles(500);
    in_step(1, 1);
    const cm1e_command_id_t id = to_shift(3.0, 2.0);
    axes_cycles(400);
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_axis_set_position(axes_axis(MASTER), 100.0, false));
    axes_cycles(100);
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_axis_set_position(axes_axis(SLAVE), -7.0, true));
    axes_wait(SLAVE, id, 5000);
    TEST_ASSERT_EQUAL(CM1E_COMMAND_DONE, state_of(id));
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, 0.0, off(3.0));
}

/* ---- one and another --------------------------------------------------------------------------------------------- */

static void test_relative_shifts_add_and_an_absolute_one_leads_back(void)
{
    in_step(1, 1);
    cm1e_command_id_t id = by_shift(1.0, 5.0);
    axes_wait(SLAVE, id, 3000);
    TEST_ASSERT_EQUAL_DOUBLE(1.0, axes_status(SLAVE, id).covered);
    id = by_shift(0.5, 5.0);
    axes_wait(SLAVE, id, 3000);
    TEST_ASSERT_EQUAL_DOUBLE(0.5, axes_status(SLAVE, id).covered);
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, 0.0, off(1.5));
    id = to_shift(1.5, 5.0); /* it is there */
    axes_wait(SLAVE, id, 3000);
    TEST_ASSERT_EQUAL(CM1E_COMMAND_DONE, state_of(id));
    TEST_ASSERT_EQUAL_DOUBLE(1.5, axes_status(SLAVE, id).covered);
    id = to_shift(-0.25, 5.0);
    axes_wait(SLAVE, id, 3000);
    TEST_ASSERT_EQUAL_DOUBLE(-0.25, axes_status(SLAVE, id).covered);
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, 0.0, off(-0.25));
}

/* From any moment of the first: it goes on from its present velocity and acceleration. */
static void test_another_phasing_takes_over_at_any_moment(void)
{
    for (int at = 1; at < 900; at += 61) {
        axes_begin(3);
        axes_move_velocity(MASTER, -3.0);
        axes_cycles(300);
        in_step(2, 1);
        const cm1e_command_id_t first = to_shift(2.0, 4.0);
        axes_cycles(at);
        const bool was_active = state_of(first) == CM1E_COMMAND_ACTIVE;
        const double present = was_active ? axes_status(SLAVE, first).covered : 2.0;
        const cm1e_command_id_t second = by_shift(-1.0, 3.0);
        TEST_ASSERT_EQUAL(was_active ? CM1E_COMMAND_ABORTED : CM1E_COMMAND_DONE, state_of(first));
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, present, axes_status(SLAVE, first).covered);
        axes_wait(SLAVE, second, 3000);
        TEST_ASSERT_EQUAL(CM1E_COMMAND_DONE, state_of(second));
        TEST_ASSERT_DOUBLE_WITHIN(1e-3, 0.0, off(present - 1.0));
    }
}

static void test_buffered_ones_begin_one_after_the_other(void)
{
    in_step(1, 1);
    const cm1e_command_id_t first = to_shift(1.0, 5.0);
    const cm1e_command_id_t second = then_shift(true, 1.0, 2.0), third = then_shift(false, 0.5, 3.0),
                            fourth = then_shift(true, 0.1, 3.0);
    cm1e_axis_command_t fifth = shift(true, 0.1, 3.0);
    fifth.buffer_mode = mcBlendingHigh;
    axes_refused(SLAVE, &fifth, CM1E_ERROR_FULL);
    TEST_ASSERT_EQUAL(CM1E_COMMAND_BUFFERED, state_of(second));
    axes_wait(SLAVE, first, 3000);
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, 0.0, off(1.0));
    TEST_ASSERT_EQUAL(CM1E_COMMAND_ACTIVE, state_of(second));
    TEST_ASSERT_EQUAL(CM1E_COMMAND_BUFFERED, state_of(third));
    axes_wait(SLAVE, second, 3000);
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, 0.0, off(2.0));
    TEST_ASSERT_EQUAL_DOUBLE(1.0, axes_status(SLAVE, second).covered);
    axes_wait(SLAVE, third, 3000);
    axes_wait(SLAVE, fourth, 3000);
    TEST_ASSERT_EQUAL(CM1E_COMMAND_DONE, state_of(fourth));
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, 0.0, off(0.6));
}

static void test_an_aborting_one_forgets_those_that_wait(void)
{
    in_step(1, 1);
    const cm1e_command_id_t first = to_shift(1.0, 5.0), second = then_shift(true, 1.0, 2.0);
    axes_cycles(50);
    const cm1e_command_id_t third = to_shift(0.5, 2.0);
    TEST_ASSERT_EQUAL(CM1E_COMMAND_ABORTED, state_of(first));
    TEST_ASSERT_EQUAL(CM1E_COMMAND_ABORTED, state_of(second));
    axes_wait(SLAVE, third, 3000);
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, 0.0, off(0.5));
}

/* 2.2.2, case 2: a waiting one that cannot begin by then fails alone. */
static void test_a_waiting_one_that_does_not_fit_any_more_fails_alone(void)
{
    in_step(1, 1);
    const cm1e_command_id_t first = to_shift(1.0, 5.0), second = then_shift(true, 60.0, 45.0),
                            third = then_shift(true, 1.0, 2.0);
    axes_command(MASTER, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 40.0, .jerk = 900.0,
                                                .acceleration = 45.0});
    axes_wait(SLAVE, first, 3000);
    axes_must_be(SLAVE, CM1E_AXIS_SYNCHRONIZED_MOTION);
    TEST_ASSERT_EQUAL(CM1E_COMMAND_ERROR, state_of(second));
    TEST_ASSERT_EQUAL(CM1E_ERROR_AXIS_VELOCITY_RANGE, axes_status(SLAVE, second).error);
    axes_told(SLAVE, "MC_PhasingRelative");
    TEST_ASSERT_EQUAL(CM1E_COMMAND_ACTIVE, state_of(third));
}

/* ---- beside the coupling ----------------------------------------------------------------------------------------- */

static void test_it_runs_while_the_slave_gets_into_step(void)
{
    axes_move_velocity(MASTER, 20.0);
    axes_cycles(1000);
    const cm1e_command_id_t gear = axes_gear_in(SLAVE, MASTER, 1, 1);
    axes_cycles(20);
    const cm1e_command_id_t id = to_shift(3.0, 5.0);
    axes_cycles(1);
    TEST_ASSERT_FALSE(axes_status(SLAVE, gear).reached);
    axes_wait(SLAVE, id, 5000);
    TEST_ASSERT_EQUAL(CM1E_COMMAND_DONE, state_of(id));
    axes_wait_reached(SLAVE, gear, 3000);
    TEST_ASSERT_EQUAL(CM1E_COMMAND_ACTIVE, axes_status(SLAVE, gear).state);
    TEST_ASSERT_EQUAL_DOUBLE(20.0, axes_info(SLAVE).set_velocity);
}

/* Another ratio, at any moment: the shift goes on, and stays. */
static void test_it_goes_on_through_a_change_of_ratio(void)
{
    for (int at = 10; at < 1000; at += 90) {
        axes_begin(3);
        axes_move_velocity(MASTER, 6.0);
        axes_cycles(500);
        in_step(1, 1);
        const cm1e_command_id_t id = to_shift(4.0, 5.0);
        axes_cycles(at);
        const cm1e_command_id_t gear = axes_gear_in(SLAVE, MASTER, -1, 2);
        axes_wait(SLAVE, id, 5000);
        TEST_ASSERT_EQUAL(CM1E_COMMAND_DONE, state_of(id));
        axes_wait_reached(SLAVE, gear, 3000);
        TEST_ASSERT_EQUAL_DOUBLE(-3.0, axes_info(SLAVE).set_velocity);
        const cm1e_command_id_t back = to_shift(4.0, 5.0); /* where it is */
        axes_cycles(2);
        TEST_ASSERT_EQUAL(CM1E_COMMAND_DONE, state_of(back));
    }
}

/* Changes by ContinuousUpdate (2.4.6), in every hundredth cycle. */
static void test_it_goes_on_while_the_ratio_is_updated_again_and_again(void)
{
    axes_move_velocity(MASTER, 6.0);
    axes_cycles(500);
    cm1e_axis_coupling_t coupling = {.master = {{.axis = axes_reference(MASTER), .numerator = 100,
                                                 .denominator = 100}}};
    const cm1e_axis_command_t c = {.kind = CM1E_COMMAND_GEAR_IN, .coupling = &coupling};
    const cm1e_command_id_t gear = axes_command(SLAVE, &c);
    axes_wait_reached(SLAVE, gear, 2000);
    const cm1e_command_id_t id = to_shift(-6.0, 4.0);
    for (int n = 0; n < 2000; n++) {
        if (n % 100 == 0)
            coupling.master[0].numerator -= 7;
        TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, cm1e_axis_update(axes_axis(SLAVE), gear, &c), axes_text(SLAVE));
        axes_cycles(1);
    }
    TEST_ASSERT_EQUAL(CM1E_COMMAND_DONE, state_of(id));
    TEST_ASSERT_EQUAL_DOUBLE(-6.0, axes_status(SLAVE, id).covered);
    axes_wait_reached(SLAVE, gear, 2000);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 6.0 * -0.4, axes_info(SLAVE).set_velocity);
}

/* Frames were not sent for a while: the slave begins anew in step, and the shift stays where it was. */
static void test_a_pause_ends_it(void)
{
    axes_move_velocity(MASTER, 5.0);
    axes_cycles(1000);
    in_step(1, 1);
    const cm1e_command_id_t id = by_shift(5.0, 1.0);
    axes_cycles(500);
    const double shifted = axes_status(SLAVE, id).covered;
    TEST_ASSERT_TRUE(shifted > 0.1 && shifted < 4.0);
    axes_inputs();
    for (int n = 0; n < 3; n++) {
        axes_bench.witness[n].strictness = AXES_UNWATCHED; /* the set velocity falls to 0 */
        cm1e_axis_after_pause(axes_axis(n), 100000000);
    }
    axes_outputs();
    TEST_ASSERT_EQUAL(CM1E_COMMAND_ABORTED, state_of(id));
    for (int n = 0; n < 3; n++)
        axes_bench.witness[n].strictness = AXES_SMOOTH;
    axes_cycles(1500);
    TEST_ASSERT_DOUBLE_WITHIN(1.0, 0.0, off(shifted));
    TEST_ASSERT_EQUAL_DOUBLE(5.0, axes_info(SLAVE).set_velocity);
}

static void test_another_master_ends_it(void)
{
    axes_move_velocity(MASTER, 6.0);
    axes_move_velocity(OTHER, 4.0);
    axes_cycles(500);
    in_step(1, 1);
    const cm1e_command_id_t id = to_shift(4.0, 5.0), waits = then_shift(true, 1.0, 1.0);
    axes_cycles(300);
    const cm1e_command_id_t gear = axes_gear_in(SLAVE, OTHER, 1, 1);
    TEST_ASSERT_EQUAL(CM1E_COMMAND_ABORTED, state_of(id));
    TEST_ASSERT_EQUAL(CM1E_COMMAND_ABORTED, state_of(waits));
    axes_wait_reached(SLAVE, gear, 3000);
    TEST_ASSERT_EQUAL_DOUBLE(4.0, axes_info(SLAVE).set_velocity);
    const cm1e_axis_command_t c = shift(true, 1.0, 1.0);
    axes_refused(SLAVE, &c, CM1E_ERROR_AXIS_MASTER);
}

static void end_by_move(void) { axes_move_to(SLAVE, 0.0, 5.0); }
static void end_by_stop(void) { axes_command(SLAVE, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_STOP}); }
static void end_by_gear_out(void) { axes_command(SLAVE, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_GEAR_OUT}); }
static void end_by_power(void)
{
    axes_power(SLAVE, false);
    axes_cycles(1);
}
static void end_by_waiting_move(void)
{
    axes_command(SLAVE, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = 100.0, .velocity = 5.0,
                                               .buffer_mode = mcBuffered});
    axes_cycles(1);
}
static void end_by_fault(void)
{
    fake_bus_fault(axes_motor(SLAVE), 0x2310);
    axes_cycles(3);
}
static void end_by_master(void)
{
    fake_bus_fault(axes_motor(MASTER), 0x2310);
    axes_cycles(3);
}

static void test_it_ends_with_the_coupling(void)
{
    static const struct {
        void (*end)(void);
        cm1e_command_state_t state;
    } ways[] = {{end_by_move, CM1E_COMMAND_ABORTED},     {end_by_stop, CM1E_COMMAND_ABORTED},
                {end_by_gear_out, CM1E_COMMAND_ABORTED}, {end_by_power, CM1E_COMMAND_ABORTED},
                {end_by_waiting_move, CM1E_COMMAND_ABORTED}, {end_by_fault, CM1E_COMMAND_ERROR},
                {end_by_master, CM1E_COMMAND_ERROR}};
    for (size_t i = 0; i < sizeof ways / sizeof ways[0]; i++) {
        axes_begin(3);
        axes_move_velocity(MASTER, 6.0);
        axes_cycles(500);
        in_step(1, 1);
        const cm1e_command_id_t id = to_shift(4.0, 5.0), waits = then_shift(true, 1.0, 1.0);
        axes_cycles(200);
        ways[i].end();
        char which[16];
        snprintf(which, sizeof which, "way %d", (int)i);
        TEST_ASSERT_EQUAL_MESSAGE(ways[i].state, state_of(id), which);
        TEST_ASSERT_EQUAL_MESSAGE(ways[i].state, state_of(waits), which);
        if (ways[i].state == CM1E_COMMAND_ERROR)
            TEST_ASSERT_EQUAL(CM1E_ERROR_AXIS_ERROR_STOP, axes_status(SLAVE, id).error);
        TEST_ASSERT_NOT_EQUAL(CM1E_AXIS_SYNCHRONIZED_MOTION, axes_state(SLAVE));
        axes_cycles(500);
        const cm1e_axis_command_t c = shift(true, 1.0, 1.0);
        cm1e_command_id_t refused;
        TEST_ASSERT_NOT_EQUAL(CM1E_OK, cm1e_axis_start(axes_axis(SLAVE), &c, &refused));
    }
}

/* keep_ratio: the slave follows a master that brakes, and the shift comes to rest on the way. */
static void test_a_shift_comes_to_rest_while_the_ratio_is_kept_to_the_end(void)
{
    axes_describe(3);
    axes_config(MASTER)->software_limit_negative = -100.0;
    axes_config(MASTER)->software_limit_positive = 10.0;
    axes_config(MASTER)->max_deceleration = 30.0;
    axes_config(SLAVE)->coupling_stop = CM1E_COUPLING_STOP_KEEP_RATIO;
    axes_make();
    axes_enable_all();
    in_step(1, 1);
    axes_move_velocity(MASTER, 5.0);
    axes_cycles(1000);
    const cm1e_command_id_t id = to_shift(30.0, 3.0), waits = then_shift(true, 1.0, 1.0);
    AXES_UNTIL(axes_state(MASTER) == CM1E_AXIS_ERROR_STOP);
    axes_cycles(1);
    axes_must_be(SLAVE, CM1E_AXIS_ERROR_STOP);
    TEST_ASSERT_EQUAL(CM1E_ERROR_AXIS_MASTER_LOST, axes_info(SLAVE).error);
    TEST_ASSERT_EQUAL(CM1E_COMMAND_ERROR, state_of(id));
    TEST_ASSERT_EQUAL(CM1E_COMMAND_ERROR, state_of(waits));
    const double covered = axes_status(SLAVE, id).covered;
    while (axis_follows(axes_axis(SLAVE))) {
        TEST_ASSERT_DOUBLE_WITHIN(1e-3, 0.0, off(axes_axis(SLAVE)->coupling->phase.position));
        TEST_ASSERT_TRUE(axes_axis(SLAVE)->coupling->phase.position >= covered - 1e-9);
        axes_cycles(1);
    }
    TEST_ASSERT_EQUAL_DOUBLE(0.0, axes_info(SLAVE).set_velocity);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, axes_info(MASTER).set_velocity);
    TEST_ASSERT_TRUE(axes_info(SLAVE).set_position - axes_info(MASTER).set_position > covered);
}

/* A new coupling begins without the shift of the one before. */
static void test_a_shift_does_not_outlive_its_coupling(void)
{
    in_step(1, 1);
    cm1e_command_id_t id = to_shift(2.0, 5.0);
    axes_wait(SLAVE, id, 3000);
    axes_command(SLAVE, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_HALT});
    axes_cycles(100);
    in_step(1, 1);
    id = to_shift(2.0, 5.0);
    axes_cycles(2);
    TEST_ASSERT_EQUAL(CM1E_COMMAND_ACTIVE, state_of(id));
    axes_wait(SLAVE, id, 3000);
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, 0.0, off(2.0));
}

/* The first master of MC_CombineAxes is the one that is shifted. */
static void test_of_two_masters_the_first_is_shifted(void)
{
    const cm1e_axis_coupling_t both = {
        .combine = mcAddAxes,
        .master = {{.axis = axes_reference(MASTER), .numerator = 1, .denominator = 1},
                   {.axis = axes_reference(OTHER), .numerator = 1, .denominator = 1}},
    };
    axes_move_velocity(MASTER, 2.0);
    axes_move_velocity(OTHER, 3.0);
    axes_cycles(500);
    const cm1e_command_id_t combined =
        axes_command(SLAVE, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_COMBINE_AXES, .coupling = &both});
    axes_wait_reached(SLAVE, combined, 3000);
    cm1e_axis_command_t c = shift(true, 1.0, 1.0);
    seen.master[0].axis = axes_reference(OTHER);
    axes_refused(SLAVE, &c, CM1E_ERROR_AXIS_MASTER);
    const double before = axes_info(SLAVE).set_position - axes_info(MASTER).set_position -
                          axes_info(OTHER).set_position;
    const cm1e_command_id_t id = by_shift(1.0, 1.0);
    axes_wait(SLAVE, id, 3000);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, before + 1.0, axes_info(SLAVE).set_position - axes_info(MASTER).set_position -
                                                      axes_info(OTHER).set_position);
}

/* ---- cams -------------------------------------------------------------------------------------------------------- */

enum { POINTS = 41 };
static MC_CAM_POINT points[2][POINTS];
static cm1e_cam_knot_t knots[2][POINTS];
static cm1e_cam_t cams[2];
static MC_CAM_ID ids[2];

/* Two waves on 10 u of the master, of another height and place; the axis has them, and the test for itself. */
static void begin_with_cams(void)
{
    axes_begin(3);
    for (int cam = 0; cam < 2; cam++) {
        int at;
        for (int i = 0; i < POINTS; i++)
            points[cam][i] = (MC_CAM_POINT){.Master = i * 10.0 / (POINTS - 1), .Slave = (1.0 + cam) *
                                            sin(6.283185307179586 * (i % (POINTS - 1)) / (POINTS - 1) + cam)};
        const MC_CAM_REF table = {points[cam], POINTS, mcCamCubicSpline};
        TEST_ASSERT_EQUAL(CM1E_CAM_GOOD, cm1e_cam_compile(&cams[cam], knots[cam], POINTS, &table, true, &at));
        TEST_ASSERT_EQUAL(CM1E_OK, cm1e_axis_cam_select(axes_axis(SLAVE), &table, true, true, true, &ids[cam]));
    }
    axes_command(MASTER, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 3.0, .jerk = 100.0,
                                                .acceleration = 20.0});
}

static cm1e_command_id_t cam_in(int cam)
{
    const cm1e_axis_coupling_t coupling = {.master = {{.axis = axes_reference(MASTER), .numerator = 1,
                                                       .denominator = 1}}, .cam = ids[cam], .start_mode = mcRampIn};
    return axes_command(SLAVE, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_CAM_IN, .coupling = &coupling});
}

/* Counts between where the slave is and where the cam has it for the master at `shifted` more. */
static double off_cam(int cam, double shifted)
{
    static cm1e_cam_place_t place[2];
    cm1e_cam_sample_t sample;
    cm1e_cam_sample(&cams[cam], &place[cam], axes_info(MASTER).set_position + shifted, &sample);
    return (axes_info(SLAVE).set_position - sample.point.position) * 50000.0;
}

static void test_a_cam_is_followed_with_the_ideal_shift_at_every_sample(void)
{
    static const double shifts[] = {2.5, -3.25, 14.0};
    begin_with_cams();
    axes_wait_reached(SLAVE, cam_in(0), 5000);
    double from = 0.0;
    for (int i = 0; i < 3; i++) {
        cm1e_axis_command_t c = shift(false, shifts[i], 2.0);
        const cm1e_motion_limits_t limits = {c.velocity, c.acceleration = 8.0, c.deceleration = 6.0, c.jerk = 100.0};
        const cm1e_motion_state_t start = {.position = from};
        cm1e_profile_t ideal;
        TEST_ASSERT_EQUAL(CM1E_OK, cm1e_profile_to_position(&ideal, &start, shifts[i], &limits));
        const cm1e_command_id_t id = axes_command(SLAVE, &c);
        for (int n = 1; n <= (int)(ideal.duration_s * 1000.0) + 500; n++) {
            cm1e_motion_state_t now;
            axes_cycles(1);
            cm1e_profile_sample(&ideal, n * 1e-3, &now);
            TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1.0, 0.0, off_cam(0, now.position), axes_text(SLAVE));
        }
        TEST_ASSERT_EQUAL(CM1E_COMMAND_DONE, state_of(id));
        from = shifts[i];
    }
}

/* Another cam, at any moment: the shift goes on, and the new cam has it. */
static void test_a_shift_goes_on_through_a_change_of_cam(void)
{
    for (int at = 10; at < 1500; at += 150) {
        begin_with_cams();
        axes_wait_reached(SLAVE, cam_in(0), 5000);
        const cm1e_command_id_t id = to_shift(2.5, 2.0);
        axes_cycles(at);
        const cm1e_command_id_t other = cam_in(1);
        axes_wait(SLAVE, id, 5000);
        TEST_ASSERT_EQUAL(CM1E_COMMAND_DONE, state_of(id));
        axes_wait_reached(SLAVE, other, 5000);
        for (int n = 0; n < 500; n++) {
            axes_cycles(1);
            TEST_ASSERT_DOUBLE_WITHIN(1.0, 0.0, off_cam(1, 2.5));
        }
    }
}

/* A cam that counts from where its master is begins at 0 of the cam: the slave sees the master there, shifted or not. */
static void test_a_relative_cam_begins_where_the_slave_sees_its_master(void)
{
    begin_with_cams();
    const MC_CAM_REF table = {points[0], POINTS, mcCamCubicSpline};
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_axis_cam_select(axes_axis(SLAVE), &table, true, false, false, &ids[0]));
    axes_command(MASTER, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_HALT});
    axes_cycles(500);
    in_step(1, 1);
    axes_wait(SLAVE, to_shift(2.5, 2.0), 5000);
    const double master = axes_info(MASTER).set_position, slave = axes_info(SLAVE).set_position;
    axes_wait_reached(SLAVE, cam_in(0), 2000);
    axes_move_to(MASTER, master + 8.0, 2.0);
    const double below = off_cam(0, -master); /* counts */
    for (int n = 0; n < 6000; n++) {
        axes_cycles(1);
        TEST_ASSERT_DOUBLE_WITHIN(1.0, below, off_cam(0, -master));
    }
    TEST_ASSERT_DOUBLE_WITHIN(1.0, slave * 50000.0, below + points[0][0].Slave * 50000.0);
    TEST_ASSERT_EQUAL_DOUBLE(master + 8.0, axes_info(MASTER).set_position);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_shift_is_the_ideal_one_at_every_sample_in_both_directions);
    RUN_TEST(test_shift_of_axes_with_other_units_and_a_way_round);
    RUN_TEST(test_shift_adds_to_a_master_whatever_that_does);
    RUN_TEST(test_set_positions_of_both_leave_a_shift_under_way_alone);
    RUN_TEST(test_relative_shifts_add_and_an_absolute_one_leads_back);
    RUN_TEST(test_another_phasing_takes_over_at_any_moment);
    RUN_TEST(test_buffered_ones_begin_one_after_the_other);
    RUN_TEST(test_an_aborting_one_forgets_those_that_wait);
    RUN_TEST(test_a_waiting_one_that_does_not_fit_any_more_fails_alone);
    RUN_TEST(test_it_runs_while_the_slave_gets_into_step);
    RUN_TEST(test_it_goes_on_through_a_change_of_ratio);
    RUN_TEST(test_it_goes_on_while_the_ratio_is_updated_again_and_again);
    RUN_TEST(test_a_pause_ends_it);
    RUN_TEST(test_another_master_ends_it);
    RUN_TEST(test_it_ends_with_the_coupling);
    RUN_TEST(test_a_shift_comes_to_rest_while_the_ratio_is_kept_to_the_end);
    RUN_TEST(test_a_shift_does_not_outlive_its_coupling);
    RUN_TEST(test_of_two_masters_the_first_is_shifted);
    RUN_TEST(test_a_cam_is_followed_with_the_ideal_shift_at_every_sample);
    RUN_TEST(test_a_shift_goes_on_through_a_change_of_cam);
    RUN_TEST(test_a_relative_cam_begins_where_the_slave_sees_its_master);
    return UNITY_END();
}
