/* Followers: what they see of their masters, in which order, how exactly, and when their commands begin and end. */
#include "unity.h"

#include "../support/axes_bench.h"
#include "axis/axis_parameters.h"

void setUp(void) {}
void tearDown(void) { axes_end(); }

static double set_of(int n) { return axes_info(n).set_position; }

static cm1e_coupling_master_t by_ratio(int n, int32_t numerator, uint32_t denominator)
{
    return (cm1e_coupling_master_t){.axis = axes_reference(n), .numerator = numerator, .denominator = denominator};
}

static cm1e_command_id_t buffered_gear(int n, int master, int32_t numerator)
{
    const cm1e_axis_coupling_t coupling = {.master = {by_ratio(master, numerator, 1)}};
    return axes_command(n, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_GEAR_IN, .buffer_mode = mcBuffered,
                                                  .coupling = &coupling});
}

static cm1e_command_state_t state_of(int n, cm1e_command_id_t id) { return axes_status(n, id).state; }

/* ---- masters ----------------------------------------------------------------------------------------------------- */

/* 4.12: each by its ratio, added and subtracted. */
static void test_two_masters_are_combined(void)
{
    for (int mode = mcAddAxes; mode <= mcSubAxes; mode++) {
        axes_begin(3);
        const cm1e_axis_coupling_t coupling = {.master = {by_ratio(0, 1, 2), by_ratio(1, 3, 4)},
                                               .combine = (MC_COMBINE_MODE)mode};
        axes_move_velocity(0, 4.0);
        axes_cycles(400);
        const cm1e_command_id_t id = axes_command(2, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_COMBINE_AXES,
                                                                            .coupling = &coupling});
        axes_wait_reached(2, id, 1000);
        const double sign = mode == mcAddAxes ? 1.0 : -1.0;
        const double first = set_of(0), second = set_of(1), slave = set_of(2);
        axes_command(1, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 5.0,
                                               .acceleration = 50.0, .jerk = 1000.0});
        axes_move_velocity(0, 2.0);
        for (int n = 0; n < 1000; n++) {
            axes_cycles(1);
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, (set_of(0) - first) / 2.0 + sign * 0.75 * (set_of(1) - second),
                                      set_of(2) - slave);
        }
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 1.0 + sign * 3.75, axes_info(2).set_velocity);
        axes_command(2, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_GEAR_OUT});
        axes_must_be(2, CM1E_AXIS_CONTINUOUS_MOTION);
    }
}

/* Four in a row, in every order of their outputs: none of them is a cycle late. */
static void test_a_chain_follows_within_the_cycle_in_every_order(void)
{
    for (int order = 0; order < 24; order++) {
        axes_begin(4);
        for (int i = 0, rest = order; i < 4; i++) { /* the order-th permutation */
            const int pick = rest % (4 - i), taken = axes_bench.order[i + pick];
            rest /= 4 - i;
            axes_bench.order[i + pick] = axes_bench.order[i];
            axes_bench.order[i] = taken;
        }
        axes_gear_in(2, 1, -1, 1);
        axes_gear_in(3, 2, 1, 2);
        axes_gear_in(1, 0, 1, 1);
        axes_cycles(1);
        axes_move_to(0, 3.0, 6.0);
        for (int n = 0; n < 1000; n++) {
            axes_cycles(1);
            TEST_ASSERT_DOUBLE_WITHIN(1e-12, set_of(0), set_of(1));
            TEST_ASSERT_DOUBLE_WITHIN(1e-12, -set_of(0), set_of(2));
            TEST_ASSERT_DOUBLE_WITHIN(1e-12, -set_of(0) / 2.0, set_of(3));
        }
        TEST_ASSERT_EQUAL_DOUBLE(-1.5, set_of(3));
    }
}

static void test_nobody_follows_itself_by_way_of_others(void)
{
    axes_begin(4);
    axes_gear_in(1, 0, 1, 1);
    axes_gear_in(2, 1, 1, 1);
    cm1e_axis_coupling_t coupling = {.master = {by_ratio(3, 1, 1), by_ratio(2, 1, 1)}};
    const cm1e_axis_command_t combine = {.kind = CM1E_COMMAND_COMBINE_AXES, .coupling = &coupling};
    axes_refused(0, &combine, CM1E_ERROR_AXIS_COUPLING_CYCLE);
    axes_told(0, "\"axis0\" cannot follow \"axis2\"");
    coupling.combine = (MC_COMBINE_MODE)7;
    axes_refused(0, &combine, CM1E_ERROR_INVALID_ARGUMENT);
    axes_told(0, "CombineMode is mcAddAxes or mcSubAxes");
    coupling.combine = mcAddAxes;
    coupling.master[1] = by_ratio(0, 1, 1);
    axes_refused(0, &combine, CM1E_ERROR_AXIS_COUPLING_CYCLE);
    axes_command(3, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_COMBINE_AXES,
                                           .coupling = &(cm1e_axis_coupling_t){
                                               .master = {by_ratio(2, 1, 1), by_ratio(0, 1, 1)}}});
    axes_command(1, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_GEAR_OUT}); /* the ring is open now */
    axes_gear_in(0, 2, 1, 1);
    axes_cycles(10);
    for (int n = 0; n < 4; n++)
        TEST_ASSERT_NOT_EQUAL_INT(CM1E_AXIS_ERROR_STOP, axes_state(n));
}

/* A gear that was to follow and was aborted before is no ring. */
static void test_a_gear_that_waits_no_longer_makes_no_ring(void)
{
    axes_begin(2);
    axes_move_to(1, 5.0, 1.0);
    const cm1e_command_id_t waiting = buffered_gear(1, 0, 1);
    axes_cycles(10);
    axes_move_to(1, 1.0, 1.0);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, state_of(1, waiting));
    axes_wait_reached(0, axes_gear_in(0, 1, 1, 1), 2000);
}

/* Two that wait for each other's end: the second one finds the ring when it is to begin. */
static void test_a_ring_that_comes_to_be_by_waiting_is_refused_then(void)
{
    axes_begin(2);
    axes_move_to(0, 0.5, 5.0);
    axes_move_to(1, 1.0, 5.0);
    const cm1e_command_id_t first = buffered_gear(0, 1, 1), second = buffered_gear(1, 0, 1);
    axes_cycles(2000);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, state_of(0, first));
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ERROR, state_of(1, second));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_COUPLING_CYCLE, axes_status(1, second).error);
    axes_must_be(1, CM1E_AXIS_STANDSTILL);
}

/* ---- how exactly ------------------------------------------------------------------------------------------------- */

/* Ratio, units and directions as fractions: after a million revolutions the slave is where integers say, to a count. The
 * axes alone, without a bus, at 100 Hz: 6 hours in a moment. */
static void test_a_million_revolutions_lose_no_count(void)
{
    axes_describe(2);
    axes_bench.cycle_ns = 10000000;
    axes_config(0)->units_per_revolution = 360.0;
    axes_config(0)->gear_numerator = 7;
    axes_config(0)->gear_denominator = 3;
    axes_config(1)->units_per_revolution = 25.4;
    axes_config(1)->invert = true;
    axes_make();
    axes_enable_all();
    axes_gear_in(1, 0, 17, 997);
    axes_cycles(1);
    const position_t master = axes_axis(0)->setpoint.position, slave = axes_axis(1)->setpoint.position;
    axes_move_velocity(0, axes_axis(0)->limits.maximum.velocity);
    int64_t counts = 0;
    while (counts < INT64_C(50000) * 1000000) {
        axes_axis(0)->advanced = axes_axis(1)->advanced = false;
        cm1e_axis_advance(axes_axis(1));
        counts = axes_axis(0)->setpoint.position.counts - master.counts;
    }
    axes_must_be(1, CM1E_AXIS_SYNCHRONIZED_MOTION);
    /* 1080 u of the master are 350000 counts, 127 u of the slave -250000. */
    __extension__ typedef __int128 wide_t;
    const wide_t exact = -(wide_t)counts * (1080 * 17 * INT64_C(250000)) / (350000 * INT64_C(997) * 127);
    TEST_ASSERT_INT64_WITHIN(1, (int64_t)exact, axes_axis(1)->setpoint.position.counts - slave.counts);
}

/* MC_SetPosition of master or slave is no motion: positions count from where the coupling began. */
static void test_other_coordinates_move_nobody(void)
{
    axes_begin(2);
    axes_config(0)->modulo_range = 0;
    axes_gear_in(1, 0, 2, 1);
    axes_move_velocity(0, 3.0);
    axes_cycles(500);
    const double velocity = axes_info(1).set_velocity;
    for (int n = 0; n < 2; n++) {
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_set_position(axes_axis(n), -1000.0, false));
        axes_cycles(20);
        TEST_ASSERT_EQUAL_DOUBLE(velocity, axes_info(1).set_velocity);
    }
}

/* Turns of modulo axes are no steps. */
static void test_modulo_axes_turn_on_and_on(void)
{
    axes_describe(2);
    for (int n = 0; n < 2; n++) {
        axes_config(n)->counts_per_unit = 50000.0 / 360.0;
        axes_config(n)->modulo_range = 360.0;
    }
    axes_make();
    axes_enable_all();
    axes_gear_in(1, 0, -1, 3);
    axes_move_velocity(0, 3000.0);
    axes_cycles(6000);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, -1000.0, axes_info(1).set_velocity);
    const double turned = cm1e_axis_line(axes_axis(0), axes_axis(0)->setpoint.position);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, fmod(-turned / 3.0, 360.0) + 360.0, set_of(1));
}

/* An axis whose motions are its drive's has no set-point: as a master it is seen where its motor is. */
static void test_an_axis_moved_by_its_drive_is_a_master_by_its_actual_value_and_no_slave(void)
{
    axes_describe(2);
    axes_config(0)->motion = CM1E_MOTION_DRIVE;
    axes_make();
    axes_power(1, true);
    axes_cycles(20);
    const cm1e_command_id_t id = axes_gear_in(1, 0, 1, 1); /* also of a Disabled one */
    axes_bench.witness[1].strictness = AXES_STEEP;
    for (int n = 0; n < 1000; n++) {
        axes_motor(0)->position += n < 100 ? n / 2 : 50;
        axes_cycles(1);
    }
    TEST_ASSERT_TRUE_MESSAGE(axes_status(1, id).reached, axes_text(1));
    TEST_ASSERT_DOUBLE_WITHIN(0.01, 1.0, axes_info(1).set_velocity);
    const cm1e_axis_coupling_t coupling = {.master = {by_ratio(1, 1, 1)}};
    axes_power(0, true);
    axes_cycles(20);
    axes_refused(0, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_GEAR_IN, .coupling = &coupling},
                 CM1E_ERROR_UNSUPPORTED);
    axes_told(0, "it needs `motion: host` in the bus file");
}

static void test_a_master_may_be_moved_by_a_profile_of_its_drive(void)
{
    axes_describe(2);
    axes_config(0)->motion = CM1E_MOTION_DRIVE;
    axes_make();
    axes_power(0, true);
    axes_power(1, true);
    axes_cycles(20);
    axes_bench.witness[0].strictness = AXES_UNWATCHED;
    axes_bench.witness[1].strictness = AXES_STEEP;
    const cm1e_command_id_t id = axes_gear_in(1, 0, 1, 1);
    axes_move_velocity(0, 1.0);
    for (int n = 0; n < 1000; n++) {
        axes_motor(0)->position += n < 100 ? n / 2 : 50;
        axes_cycles(1);
    }
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_CONTINUOUS_MOTION, axes_state(0));
    TEST_ASSERT_TRUE_MESSAGE(axes_status(1, id).reached, axes_text(1));
    TEST_ASSERT_DOUBLE_WITHIN(0.01, 1.0, axes_info(1).set_velocity);
}

static void test_dynamics_too_small_to_compute_with_are_refused(void)
{
    axes_begin(2);
    axes_move_velocity(0, 1.0);
    axes_cycles(1000);
    const cm1e_axis_coupling_t coupling = {.master = {by_ratio(0, 1, 1)}};
    axes_refused(1, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_GEAR_IN, .jerk = 1e-300, .coupling = &coupling},
                 CM1E_ERROR_AXIS_DYNAMICS_RANGE);
    axes_told(1, "too small to compute with");
}

static double shaft;

static void turn_shaft(void)
{
    shaft += axes_motor(1)->target_velocity_raw * 1e-3;
    axes_motor(1)->position = (int32_t)lround(shaft);
}

/* A mapping without target position; the slave's position loop is the axis's. */
static void test_a_slave_in_csv_keeps_up(void)
{
    axes_describe(2);
    fake_bus_init(axes_motor(1), CM1E_MAPPING_CSV, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    axes_motor(1)->mode = axes_motor(1)->sdo_mode = CM1E_MODE_CSV;
    axes_config(1)->mapping = CM1E_MAPPING_CSV;
    axes_make();
    TEST_ASSERT_EQUAL_INT(CM1E_MODE_CSV, axes_axis(1)->mode);
    axes_enable_all();
    shaft = axes_motor(1)->position;
    axes_bench.program = turn_shaft;
    axes_gear_in(1, 0, 1, 1);
    axes_wait(0, axes_move_to(0, 10.0, 8.0), 5000);
    axes_cycles(2000);
    TEST_ASSERT_EQUAL_DOUBLE(10.0, set_of(1));
    TEST_ASSERT_INT_WITHIN(3, 500000, axes_motor(1)->position);
}

/* ---- commands ---------------------------------------------------------------------------------------------------- */

/* Table 4: it waits for Done, and what waits behind it for InGear. */
static void test_a_gear_waits_and_others_wait_for_it(void)
{
    axes_begin(2);
    axes_move_velocity(0, 4.0);
    const cm1e_command_id_t move = axes_move_to(1, 1.0, 5.0), gear = buffered_gear(1, 0, 1);
    const cm1e_command_id_t back =
        axes_command(1, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = 0.0, .velocity = 5.0,
                                               .buffer_mode = mcBuffered});
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_BUFFERED, state_of(1, gear));
    axes_wait(1, move, 2000);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, state_of(1, move));
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, state_of(1, gear));
    axes_must_be(1, CM1E_AXIS_SYNCHRONIZED_MOTION);
    axes_wait(1, gear, 2000);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, state_of(1, gear)); /* InGear: the next has taken its place */
    TEST_ASSERT_EQUAL_DOUBLE(4.0, axes_info(1).set_velocity);
    axes_wait(1, back, 5000);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, state_of(1, back));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, set_of(1));
}

/* Behind a velocity: from InVelocity on, while it moves, at any moment within the cycle. */
static void test_a_gear_waits_for_a_velocity(void)
{
    for (int n = 0; n < 20; n++) {
        axes_begin(2);
        axes_move_velocity(0, 4.0);
        axes_move_velocity(1, 2.0 + 0.0137 * n);
        const cm1e_command_id_t gear = buffered_gear(1, 0, -2);
        axes_wait_reached(1, gear, 2000);
        TEST_ASSERT_EQUAL_DOUBLE(-8.0, axes_info(1).set_velocity);
    }
}

static void test_four_gears_that_wait_are_one_too_many(void)
{
    axes_begin(2);
    axes_move_to(1, 5.0, 1.0);
    for (int n = 0; n < 3; n++)
        (void)buffered_gear(1, 0, 1 + n);
    const cm1e_axis_coupling_t coupling = {.master = {by_ratio(0, 1, 1)}};
    const cm1e_axis_command_t fourth = {.kind = CM1E_COMMAND_GEAR_IN, .buffer_mode = mcBuffered, .coupling = &coupling};
    axes_refused(1, &fourth, CM1E_ERROR_FULL);
}

/* 2.4.6: a ratio that changes on and on, as a winder's. */
static void test_a_ratio_is_updated_without_a_step(void)
{
    axes_begin(2);
    axes_move_velocity(0, 4.0);
    axes_cycles(300);
    cm1e_axis_coupling_t coupling = {.master = {by_ratio(0, 1000, 1000)}};
    const cm1e_axis_command_t command = {.kind = CM1E_COMMAND_GEAR_IN, .coupling = &coupling};
    const cm1e_command_id_t id = axes_command(1, &command);
    axes_wait_reached(1, id, 2000);
    for (int n = 0; n < 1000; n++) {
        coupling.master[0].numerator = 1000 + n;
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_update(axes_axis(1), id, &command));
        axes_cycles(1);
    }
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_COMMAND_ACTIVE, state_of(1, id), axes_text(1));
    axes_wait_reached(1, id, 200);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 4.0 * 1.999, axes_info(1).set_velocity);
    coupling.master[0].denominator = 0; /* refused: it goes on as it was */
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_RATIO, cm1e_axis_update(axes_axis(1), id, &command));
    axes_told(1, "1999 / 0");
    axes_cycles(100);
    TEST_ASSERT_TRUE(axes_status(1, id).reached);
}

/* 2.4.6: also the numbers of a gear that waits, but not what it is. */
static void test_a_ratio_is_updated_while_the_gear_waits(void)
{
    axes_begin(2);
    axes_move_velocity(0, 4.0);
    const cm1e_command_id_t move = axes_move_to(1, 1.0, 5.0);
    cm1e_axis_coupling_t coupling = {.master = {by_ratio(0, 1, 1)}};
    cm1e_axis_command_t command = {.kind = CM1E_COMMAND_GEAR_IN, .buffer_mode = mcBuffered, .coupling = &coupling};
    const cm1e_command_id_t gear = axes_command(1, &command);
    coupling.master[0].numerator = 2;
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_update(axes_axis(1), gear, &command));
    coupling.master[0].numerator = 3;
    command.kind = CM1E_COMMAND_CAM_IN;
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_INVALID_ARGUMENT, cm1e_axis_update(axes_axis(1), gear, &command));
    axes_wait(1, move, 2000);
    axes_wait_reached(1, gear, 2000);
    TEST_ASSERT_EQUAL_DOUBLE(8.0, axes_info(1).set_velocity);
}

/* The first command waits for its master's place and stays as it is. The one behind it may change. */
static void test_a_ratio_is_updated_behind_a_gear_that_awaits_its_place(void)
{
    axes_begin(2);
    cm1e_axis_coupling_t coupling = {.master = {by_ratio(0, 1, 1)}, .master_sync_position = 8.0,
                                     .slave_sync_position = 2.0, .master_start_distance = 6.0};
    cm1e_axis_command_t command = {.kind = CM1E_COMMAND_GEAR_IN_POS, .velocity = 20.0, .coupling = &coupling};
    const cm1e_command_id_t first = axes_command(1, &command);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_INVALID_ARGUMENT, cm1e_axis_update(axes_axis(1), first, &command));
    command.kind = CM1E_COMMAND_GEAR_IN;
    command.buffer_mode = mcBuffered;
    const cm1e_command_id_t gear = axes_command(1, &command);
    coupling.master[0].numerator = 3;
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_update(axes_axis(1), gear, &command));
    axes_move_velocity(0, 4.0);
    AXES_UNTIL(state_of(1, first) == CM1E_COMMAND_ABORTED); /* InSync: the next has taken its place */
    axes_wait_reached(1, gear, 2000);
    TEST_ASSERT_EQUAL_DOUBLE(12.0, axes_info(1).set_velocity);
}

/* N6 */
static void test_override_does_not_act_on_a_follower(void)
{
    axes_begin(2);
    axes_gear_in(1, 0, 1, 1);
    axes_move_velocity(0, 4.0);
    axes_cycles(20);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_set_override(axes_axis(1), 0.0, 0.5, 0.5));
    axes_cycles(500);
    TEST_ASSERT_EQUAL_DOUBLE(4.0, axes_info(1).set_velocity);
    axes_command(1, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_GEAR_OUT}); /* it is no follower any more */
    axes_cycles(500);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, axes_info(1).set_velocity);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_CONTINUOUS_MOTION, axes_state(1));
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_set_override(axes_axis(1), 1.0, 1.0, 1.0));
    axes_cycles(500);
    TEST_ASSERT_EQUAL_DOUBLE(4.0, axes_info(1).set_velocity);
}

/* The velocity stays what it is; a smaller factor than that of this time reduces it, a larger one raises it no more. */
static void test_override_acts_on_the_velocity_that_was_kept(void)
{
    for (int fast = 0; fast < 2; fast++) {
        const double velocity = fast ? 30.0 : 4.0; /* of at most 50 */
        axes_begin(2);
        const cm1e_command_id_t gear = axes_gear_in(1, 0, 1, 1);
        axes_move_velocity(0, velocity);
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_set_override(axes_axis(1), 0.5, 1.0, 1.0));
        axes_cycles(2000);
        TEST_ASSERT_TRUE(axes_status(1, gear).reached);
        axes_command(1, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_GEAR_OUT});
        axes_cycles(500);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, velocity, axes_info(1).set_velocity);
        static const double factors[] = {0.25, 0.0, 0.1, 1.0};
        for (int i = 0; i < 4; i++) {
            TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_set_override(axes_axis(1), factors[i], 1.0, 1.0));
            axes_cycles(2000);
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, velocity * fmin(factors[i] / 0.5, 1.0), axes_info(1).set_velocity);
            TEST_ASSERT_EQUAL_INT(CM1E_AXIS_CONTINUOUS_MOTION, axes_state(1));
        }
        axes_end();
    }
}

/* It is VelFactor alone: the acceleration that the slave has ends with the whole jerk. */
static void test_a_small_jerk_factor_makes_no_slave_faster_that_leaves_its_master(void)
{
    double fastest[2] = {0.0, 0.0};
    for (int small = 0; small < 2; small++) {
        axes_begin(2);
        axes_gear_in(1, 0, 1, 1);
        axes_move_velocity(0, 40.0);
        axes_cycles(120);
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_set_override(axes_axis(1), 1.0, small ? 0.05 : 1.0, small ? 0.05 : 1.0));
        axes_command(1, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_GEAR_OUT});
        for (int n = 0; n < 2000; n++) {
            axes_cycles(1);
            fastest[small] = fmax(fastest[small], axes_info(1).set_velocity);
        }
        axes_end();
    }
    TEST_ASSERT_TRUE(fastest[0] < 20.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, fastest[0], fastest[1]);
}

/* 3.8: on top of what the master asks for. */
static void test_a_superimposed_motion_on_a_follower(void)
{
    axes_begin(2);
    axes_move_velocity(0, 4.0);
    const cm1e_command_id_t gear = axes_gear_in(1, 0, 1, 1);
    axes_wait_reached(1, gear, 2000);
    const double ahead = set_of(1) - set_of(0);
    const cm1e_command_id_t on_top = axes_command(1, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_SUPERIMPOSED,
                                                                            .position = 2.0, .velocity = 3.0});
    axes_wait(1, on_top, 5000);
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_COMMAND_DONE, state_of(1, on_top), axes_text(1));
    TEST_ASSERT_TRUE(axes_status(1, gear).reached);
    for (int n = 0; n < 200; n++) {
        axes_cycles(1);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, ahead + 2.0, set_of(1) - set_of(0));
    }
}

/* The superimposed motion has half of the slave's velocity for itself when the master gets faster than what is left. A
 * command that waited takes over there: within the limits of the axis (the witness sees every set-point), and both end
 * where they are to. */
static void test_a_command_takes_over_from_a_follower_that_left_the_superimposed_motion_no_room(void)
{
    int waited = 0;
    for (int when = 0; when < 400; when += 4) {
        axes_describe(2);
        for (int n = 0; n < 2; n++) {
            axes_config(n)->max_velocity = 20.0;
            axes_config(n)->max_acceleration = 100.0;
            axes_config(n)->max_jerk = 2000.0;
        }
        axes_make();
        axes_enable_all();
        const cm1e_axis_coupling_t coupling = {.master = {by_ratio(0, 1, 1)}};
        const cm1e_command_id_t gear = axes_command(1, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_GEAR_IN,
                                                                              .coupling = &coupling});
        axes_wait_reached(1, gear, 1000);
        const cm1e_command_id_t on_top = axes_command(1, &(cm1e_axis_command_t){
            .kind = CM1E_COMMAND_MOVE_SUPERIMPOSED, .position = 2.0, .velocity = 10.0, .acceleration = 2.0});
        axes_command(0, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 18.0,
                                               .acceleration = 90.0, .jerk = 1500.0});
        axes_cycles(when);
        const bool too_fast = axes_info(1).set_velocity > 10.0 && axes_status(1, on_top).state == CM1E_COMMAND_ACTIVE;
        const cm1e_command_id_t move = axes_command(1, &(cm1e_axis_command_t){
            .kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = 30.0, .velocity = 10.0, .buffer_mode = mcBuffered});
        axes_cycles(1);
        waited += too_fast && axes_status(1, on_top).state == CM1E_COMMAND_ACTIVE;
        axes_cycles(6000);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, state_of(1, move));
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, state_of(1, on_top));
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 32.0, set_of(1));
        axes_end();
    }
    TEST_ASSERT_TRUE(waited > 20);
}

/* A master about to be too fast for its slave: a halt of the slave in the last cycles keeps velocity and jerk. */
static void test_a_halt_just_before_the_maximum_velocity_keeps_the_jerk(void)
{
    int halted = 0, stopped = 0;
    for (int when = 0; when < 300; when++) {
        axes_describe(2);
        for (int n = 0; n < 2; n++) {
            axes_config(n)->max_velocity = n ? 8.0 : 20.0;
            axes_config(n)->max_acceleration = 100.0;
            axes_config(n)->max_jerk = 2000.0;
        }
        axes_make();
        axes_enable_all();
        const cm1e_command_id_t gear = axes_gear_in(1, 0, 1, 1);
        axes_wait_reached(1, gear, 1000);
        axes_move_velocity(0, 20.0);
        axes_cycles(when);
        if (axes_state(1) == CM1E_AXIS_SYNCHRONIZED_MOTION) {
            halted++;
            axes_command(1, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_HALT});
            axes_cycles(500);
            axes_must_be(1, CM1E_AXIS_STANDSTILL);
        } else {
            stopped++;
        }
        axes_end();
    }
    TEST_ASSERT_TRUE(halted > 50 && stopped > 50);
}

static void test_other_commands_take_over_from_a_follower(void)
{
    static const cm1e_axis_command_t commands[] = {
        {.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = 30.0, .velocity = 6.0},
        {.kind = CM1E_COMMAND_MOVE_RELATIVE, .position = -3.0, .velocity = 6.0},
        {.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = -2.0},
        {.kind = CM1E_COMMAND_HALT},
        {.kind = CM1E_COMMAND_STOP},
    };
    for (size_t i = 0; i < sizeof commands / sizeof commands[0]; i++) {
        axes_begin(2);
        const cm1e_command_id_t gear = axes_gear_in(1, 0, 1, 1);
        axes_move_velocity(0, 8.0);
        axes_cycles(60); /* in the middle of an acceleration */
        const cm1e_command_id_t id = axes_command(1, &commands[i]);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, state_of(1, gear));
        axes_cycles(300);
        TEST_ASSERT_NOT_EQUAL_INT(CM1E_AXIS_ERROR_STOP, axes_state(1));
        TEST_ASSERT_NOT_EQUAL_INT(CM1E_COMMAND_UNKNOWN, state_of(1, id));
    }
}

static void test_power_off_ends_it(void)
{
    axes_begin(2);
    const cm1e_command_id_t gear = axes_gear_in(1, 0, 1, 1);
    axes_move_velocity(0, 8.0);
    axes_cycles(300);
    axes_power(1, false);
    axes_cycles(1);
    axes_must_be(1, CM1E_AXIS_DISABLED);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, state_of(1, gear));
    axes_cycles(300);
    TEST_ASSERT_TRUE(axis_free(axes_axis(1)));
    TEST_ASSERT_EQUAL_DOUBLE(8.0, axes_info(0).set_velocity);
}

/* ---- pauses ------------------------------------------------------------------------------------------------------ */

/* Frames were not sent for a while: all that stand begin anew from rest, in step. */
static void test_after_a_pause_it_is_still_in_step(void)
{
    for (int order = 0; order < 2; order++) {
        axes_begin(2);
        axes_bench.order[0] = order;
        axes_bench.order[1] = 1 - order;
        const cm1e_command_id_t gear = axes_gear_in(1, 0, 1, 2);
        axes_move_velocity(0, 8.0);
        axes_cycles(300);
        axes_inputs();
        for (int n = 0; n < 2; n++) {
            axes_bench.witness[n].strictness = AXES_UNWATCHED; /* the set velocity falls to 0 */
            cm1e_axis_after_pause(axes_axis(axes_bench.order[n]), 100000000);
        }
        axes_outputs();
        for (int n = 0; n < 2; n++)
            axes_bench.witness[n].strictness = AXES_SMOOTH;
        for (int n = 0; n < 500; n++) {
            axes_cycles(1);
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, set_of(0) / 2.0, set_of(1));
        }
        TEST_ASSERT_TRUE(axes_status(1, gear).reached);
        TEST_ASSERT_EQUAL_DOUBLE(4.0, axes_info(1).set_velocity);
    }
}

static void allow(double velocity)
{
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_write_parameter(axes_axis(1), CM1E_PARAMETER_MAX_VELOCITY_APPL, velocity));
}

/* What the application allows at present bounds a follower too, also when it is lowered on the way; but not below what the
 * follower has then. */
static void test_a_follower_keeps_what_the_application_allows(void)
{
    for (int lowered = 0; lowered < 2; lowered++) {
        axes_begin(2);
        const cm1e_axis_coupling_t coupling = {.master = {by_ratio(0, 1, 1)}};
        if (!lowered)
            allow(2.0);
        axes_command(1, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_GEAR_IN, .coupling = &coupling});
        axes_move_velocity(0, 1.9);
        axes_cycles(1000);
        axes_must_be(1, CM1E_AXIS_SYNCHRONIZED_MOTION);
        if (lowered)
            allow(2.0);
        axes_move_velocity(0, 2.5);
        axes_cycles(20);
        while (axes_info(1).set_velocity != 0.0) {
            TEST_ASSERT_TRUE(axes_info(1).set_velocity <= (lowered ? 2.5 : 2.0) * (1.0 + 1e-6));
            axes_cycles(1);
        }
        axes_must_be(1, CM1E_AXIS_ERROR_STOP);
        axes_told(1, "up to 2 u/s is right");
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_two_masters_are_combined);
    RUN_TEST(test_a_chain_follows_within_the_cycle_in_every_order);
    RUN_TEST(test_nobody_follows_itself_by_way_of_others);
    RUN_TEST(test_a_gear_that_waits_no_longer_makes_no_ring);
    RUN_TEST(test_a_ring_that_comes_to_be_by_waiting_is_refused_then);
    RUN_TEST(test_a_million_revolutions_lose_no_count);
    RUN_TEST(test_other_coordinates_move_nobody);
    RUN_TEST(test_modulo_axes_turn_on_and_on);
    RUN_TEST(test_an_axis_moved_by_its_drive_is_a_master_by_its_actual_value_and_no_slave);
    RUN_TEST(test_a_master_may_be_moved_by_a_profile_of_its_drive);
    RUN_TEST(test_dynamics_too_small_to_compute_with_are_refused);
    RUN_TEST(test_a_slave_in_csv_keeps_up);
    RUN_TEST(test_a_gear_waits_and_others_wait_for_it);
    RUN_TEST(test_a_gear_waits_for_a_velocity);
    RUN_TEST(test_four_gears_that_wait_are_one_too_many);
    RUN_TEST(test_a_ratio_is_updated_without_a_step);
    RUN_TEST(test_a_ratio_is_updated_while_the_gear_waits);
    RUN_TEST(test_a_ratio_is_updated_behind_a_gear_that_awaits_its_place);
    RUN_TEST(test_override_does_not_act_on_a_follower);
    RUN_TEST(test_override_acts_on_the_velocity_that_was_kept);
    RUN_TEST(test_a_small_jerk_factor_makes_no_slave_faster_that_leaves_its_master);
    RUN_TEST(test_a_superimposed_motion_on_a_follower);
    RUN_TEST(test_a_command_takes_over_from_a_follower_that_left_the_superimposed_motion_no_room);
    RUN_TEST(test_a_halt_just_before_the_maximum_velocity_keeps_the_jerk);
    RUN_TEST(test_other_commands_take_over_from_a_follower);
    RUN_TEST(test_power_off_ends_it);
    RUN_TEST(test_after_a_pause_it_is_still_in_step);
    RUN_TEST(test_a_follower_keeps_what_the_application_allows);
    return UNITY_END();
}
