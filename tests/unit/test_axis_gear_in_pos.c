/* MC_GearInPos (Part 1, 4.7), and the way of MC_CamIn into step: both over the master's position. */
#include "unity.h"

#include "../support/axes_bench.h"
#include "motion_check.h"

void setUp(void) {}
void tearDown(void) { axes_end(); }

enum { MASTER = 0, SLAVE = 1 };

static double set_of(int n) { return axes_info(n).set_position; }

static cm1e_axis_coupling_t meet(double master, double slave, double distance)
{
    return (cm1e_axis_coupling_t){.master = {{.axis = axes_reference(MASTER), .numerator = 1, .denominator = 1}},
                                  .master_sync_position = master, .slave_sync_position = slave,
                                  .master_start_distance = distance};
}

static cm1e_axis_command_t in_pos(const cm1e_axis_coupling_t *coupling)
{
    return (cm1e_axis_command_t){.kind = CM1E_COMMAND_GEAR_IN_POS, .velocity = 20, .coupling = coupling};
}

static cm1e_command_id_t gear_in_pos(const cm1e_axis_coupling_t *coupling)
{
    const cm1e_axis_command_t command = in_pos(coupling);
    return axes_command(SLAVE, &command);
}

static void gear_refused(const cm1e_axis_coupling_t *coupling, cm1e_error_t expected)
{
    const cm1e_axis_command_t command = in_pos(coupling);
    axes_refused(SLAVE, &command, expected);
}

/* In the phases of figure 44: Busy, StartSync, InSync. */
static void must_show(cm1e_command_id_t id, cm1e_command_state_t state, bool start_sync, bool in_sync)
{
    const cm1e_command_status_t status = axes_status(SLAVE, id);
    AXES_MUST(status.state == state && status.synchronizing == start_sync && status.reached == in_sync,
              "state %d StartSync %d InSync %d, master %.9g", (int)status.state, status.synchronizing, status.reached,
              set_of(MASTER));
}

/* The master goes on; when it comes over its place, the slave is at its own, and in step ever after. */
static void meets(cm1e_command_id_t id, double master, double slave, double ratio, int cycles)
{
    bool met = false;
    for (int i = 0; i < cycles; i++) {
        axes_cycles(1);
        met = met || axes_status(SLAVE, id).reached;
        if (met)
            TEST_ASSERT_DOUBLE_WITHIN(2e-8, slave + ratio * (set_of(MASTER) - master), set_of(SLAVE));
    }
    TEST_ASSERT_TRUE(met);
    must_show(id, CM1E_COMMAND_ACTIVE, false, true);
    axes_must_be(SLAVE, CM1E_AXIS_SYNCHRONIZED_MOTION);
}

static void test_figure_44(void)
{
    axes_begin(2);
    cm1e_axis_coupling_t coupling = meet(20, 7, 8);
    coupling.master[0].numerator = 3;
    coupling.master[0].denominator = 2;
    const cm1e_command_id_t id = gear_in_pos(&coupling);
    axes_move_velocity(MASTER, 5);
    while (set_of(MASTER) < 12) {
        must_show(id, CM1E_COMMAND_BUFFERED, false, false);
        axes_must_be(SLAVE, CM1E_AXIS_STANDSTILL);
        TEST_ASSERT_EQUAL_DOUBLE(0, set_of(SLAVE));
        axes_cycles(1);
    }
    while (set_of(MASTER) < 20) {
        must_show(id, CM1E_COMMAND_ACTIVE, true, false);
        axes_must_be(SLAVE, CM1E_AXIS_SYNCHRONIZED_MOTION);
        axes_cycles(1);
    }
    must_show(id, CM1E_COMMAND_ACTIVE, false, true);
    meets(id, 20, 7, 1.5, 2000);
}

/* The curve is the one of degree 5 over the master's position, at every sample: from rest at the start into the ratio,
 * both without curvature. */
static void test_the_way_is_the_polynomial_over_the_master(void)
{
    axes_begin(2);
    axes_move_velocity(MASTER, 4);
    axes_cycles(2);
    const cm1e_axis_coupling_t coupling = meet(20, 6, 10);
    const cm1e_command_id_t id = gear_in_pos(&coupling);
    while (!axes_status(SLAVE, id).synchronizing)
        axes_cycles(1);
    const double begin = set_of(MASTER), way = 20 - begin;
    while (axes_status(SLAVE, id).synchronizing) {
        const double t = (set_of(MASTER) - begin) / way, h = 6, s = way;
        const double ideal = t * t * t * (10 * h - 4 * s + t * (-15 * h + 7 * s + t * (6 * h - 3 * s)));
        TEST_ASSERT_DOUBLE_WITHIN(2e-8, ideal, set_of(SLAVE));
        axes_cycles(1);
    }
}

/* 4.7, note 1: whatever the slave does goes on until StartSync, also to its end, and its block is told. */
static void test_the_motion_before_goes_on_until_start_sync(void)
{
    axes_begin(2);
    axes_move_velocity(MASTER, 4);
    const cm1e_command_id_t runs = axes_move_velocity(SLAVE, 3);
    axes_cycles(500);
    const cm1e_axis_coupling_t coupling = meet(set_of(MASTER) + 20, set_of(SLAVE) + 16, 10);
    const cm1e_command_id_t id = gear_in_pos(&coupling);
    while (!axes_status(SLAVE, id).synchronizing) {
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, axes_status(SLAVE, runs).state);
        TEST_ASSERT_TRUE(axes_status(SLAVE, runs).reached);
        TEST_ASSERT_EQUAL_DOUBLE(3, axes_info(SLAVE).set_velocity);
        axes_must_be(SLAVE, CM1E_AXIS_CONTINUOUS_MOTION);
        axes_cycles(1);
    }
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, axes_status(SLAVE, runs).state);
    meets(id, coupling.master_sync_position, coupling.slave_sync_position, 1, 5000);

    axes_begin(2); /* a move ends on the way */
    axes_move_velocity(MASTER, 4);
    const cm1e_command_id_t move = axes_move_to(SLAVE, 2, 10);
    const cm1e_axis_coupling_t next = meet(20, 9, 10);
    const cm1e_command_id_t later = gear_in_pos(&next);
    axes_wait(SLAVE, move, 3000);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, axes_status(SLAVE, move).state);
    axes_must_be(SLAVE, CM1E_AXIS_STANDSTILL);
    must_show(later, CM1E_COMMAND_BUFFERED, false, false);
    meets(later, 20, 9, 1, 8000);
}

/* From a gear, without a step (the bench checks that). */
static void test_from_one_gear_into_another(void)
{
    axes_begin(2);
    const cm1e_command_id_t gear = axes_gear_in(SLAVE, MASTER, 1, 2);
    axes_move_velocity(MASTER, 6);
    axes_cycles(1000);
    const double ahead = set_of(MASTER) + 30;
    const cm1e_axis_coupling_t coupling = meet(ahead, set_of(SLAVE) + 20, 20);
    const cm1e_command_id_t id = gear_in_pos(&coupling);
    axes_cycles(500);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, axes_status(SLAVE, gear).state);
    meets(id, ahead, coupling.slave_sync_position, 1, 8000);
}

static void test_a_stop_before_start_sync_inhibits_it(void)
{
    for (int stop = 0; stop < 3; stop++) {
        axes_begin(2);
        axes_move_velocity(MASTER, 4);
        const cm1e_axis_coupling_t coupling = meet(20, 6, 10);
        const cm1e_command_id_t id = gear_in_pos(&coupling);
        axes_cycles(1000);
        if (stop == 2)
            axes_power(SLAVE, false);
        else
            axes_command(SLAVE, &(cm1e_axis_command_t){.kind = stop ? CM1E_COMMAND_STOP : CM1E_COMMAND_HALT});
        axes_cycles(5);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, axes_status(SLAVE, id).state);
        axes_cycles(8000);
        TEST_ASSERT_TRUE(fabs(set_of(SLAVE)) < 1e-3);
        TEST_ASSERT_TRUE(axes_state(SLAVE) != CM1E_AXIS_SYNCHRONIZED_MOTION);
    }
}

/* A master that turns round on the way is followed back along the same curve; before its beginning the slave stands as
 * it did. */
static void test_a_master_that_turns_round_on_the_way(void)
{
    axes_begin(2);
    axes_move_velocity(MASTER, 4);
    const cm1e_axis_coupling_t coupling = meet(20, 6, 10);
    const cm1e_command_id_t id = gear_in_pos(&coupling);
    while (set_of(MASTER) < 15)
        axes_cycles(1);
    const cm1e_command_id_t back = axes_move_to(MASTER, 2, 6);
    axes_wait(MASTER, back, 20000);
    must_show(id, CM1E_COMMAND_ACTIVE, true, false);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0, set_of(SLAVE));
    axes_move_velocity(MASTER, 5);
    meets(id, 20, 6, 1, 10000);
    axes_move_velocity(MASTER, -5); /* from the point of synchronisation on it is the gear that holds */
    meets(id, 20, 6, 1, 10000);
    TEST_ASSERT_TRUE(set_of(MASTER) < 10);
}

static void master_goes(double velocity)
{
    axes_command(MASTER, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = velocity,
                                                .acceleration = 5, .deceleration = 5, .jerk = 100});
}

/* The master accelerates where the approach begins, so the curve begins with a curvature: of 3 u/s2 at 5 u/s, which are
 * 6 cycles of the slave's jerk. The bench watches the slave while the master goes over the beginning and back. */
static void over_the_beginning(double velocity, double distance, double slave)
{
    axes_describe(2);
    axes_config(SLAVE)->max_jerk = 500;
    axes_make();
    axes_enable_all();
    axes_wait_reached(SLAVE, axes_move_velocity(SLAVE, 3), 2000);
    master_goes(velocity);
    AXES_UNTIL(fabs(axes_info(MASTER).set_velocity) > 5);
    const double begin = set_of(MASTER);
    const cm1e_axis_coupling_t coupling = meet(begin + 10, set_of(SLAVE) + slave, distance);
    const cm1e_command_id_t id = gear_in_pos(&coupling);
    axes_cycles(50);
    must_show(id, CM1E_COMMAND_ACTIVE, true, false);
    master_goes(-4);
    AXES_UNTIL(set_of(MASTER) < begin - 1);
    must_show(id, CM1E_COMMAND_ACTIVE, true, false);
    master_goes(4);
    meets(id, coupling.master_sync_position, coupling.slave_sync_position, 1, 10000);
}

static void test_a_master_that_turns_round_over_the_beginning(void) { over_the_beginning(8, 0, 8); }

static void test_a_master_that_goes_away_from_the_first_cycle_on(void) { over_the_beginning(-8, 15, 2); }

static void test_in_the_other_direction(void)
{
    axes_begin(2);
    axes_move_velocity(MASTER, 4);
    const cm1e_axis_coupling_t coupling = meet(5, 3, -6);
    const cm1e_command_id_t id = gear_in_pos(&coupling);
    AXES_UNTIL(set_of(MASTER) > 14);
    must_show(id, CM1E_COMMAND_BUFFERED, false, false); /* it came over the place, but not in that direction */
    axes_move_velocity(MASTER, -5);
    meets(id, 5, 3, 1, 8000);
}

/* Without a MasterStartDistance it begins at once, if the master moves towards its place, or as soon as it does. */
static void test_without_a_distance_the_whole_way_is_used(void)
{
    axes_begin(2);
    axes_move_velocity(MASTER, 4);
    axes_cycles(500);
    cm1e_axis_coupling_t coupling = meet(20, 9, 0);
    cm1e_command_id_t id = gear_in_pos(&coupling);
    axes_cycles(1);
    must_show(id, CM1E_COMMAND_ACTIVE, true, false);
    meets(id, 20, 9, 1, 8000);

    axes_begin(2); /* at rest; then away from it; then towards it */
    coupling = meet(10, 9, 0);
    id = gear_in_pos(&coupling);
    axes_cycles(100);
    must_show(id, CM1E_COMMAND_BUFFERED, false, false);
    axes_move_velocity(MASTER, -3);
    axes_cycles(1000);
    must_show(id, CM1E_COMMAND_BUFFERED, false, false);
    axes_move_velocity(MASTER, 3);
    meets(id, 10, 9, 1, 8000);
}

static void test_who_stands_in_step_is_in_step(void)
{
    axes_begin(2);
    const cm1e_axis_coupling_t coupling = meet(0, 0, 0);
    const cm1e_command_id_t id = gear_in_pos(&coupling);
    axes_cycles(1);
    must_show(id, CM1E_COMMAND_ACTIVE, false, true);
    axes_move_velocity(MASTER, -3);
    meets(id, 0, 0, 1, 3000);
}

/* Of all the turns of both, by every mode: in step at the place, and on the side that the mode says. */
static void test_modulo_axes_by_every_mode(void)
{
    for (int mode = mcShortest; mode <= (int)mcSlowDown; mode++)
        for (int n = 0; n < 12; n++) {
            axes_describe(2);
            for (int k = 0; k < 2; k++) {
                axes_config(k)->units_per_revolution = 360;
                axes_config(k)->modulo_range = k ? 100 : 360;
            }
            axes_make();
            axes_enable_all();
            axes_move_velocity(MASTER, n % 2 ? -700 : 700);
            axes_cycles(1000 + 37 * n);
            cm1e_axis_coupling_t coupling = meet(90, 20, n % 3 ? (n % 2 ? -200 : 200) : 0);
            coupling.sync_mode = (MC_SYNC_MODE)mode;
            cm1e_axis_command_t command = in_pos(&coupling);
            command.velocity = 3000;
            const cm1e_command_id_t id = axes_command(SLAVE, &command);
            while (!axes_status(SLAVE, id).synchronizing)
                axes_cycles(1);
            const double begin = cm1e_axis_line(axes_axis(SLAVE), axes_axis(SLAVE)->setpoint.position);
            const double master = cm1e_axis_line(axes_axis(MASTER), axes_axis(MASTER)->setpoint.position);
            axes_wait_reached(SLAVE, id, 20000);
            const double way = fabs(cm1e_axis_line(axes_axis(MASTER), axes_axis(MASTER)->setpoint.position) - master);
            /* The first place that the slave can reach: the one that is 79 degrees ahead is too near, and so is the one that
             * is 132 degrees ahead for a slave that has to catch up. */
            const bool too_near = n == 9 || (n == 0 && mode == mcCatchUp);
            TEST_ASSERT_TRUE(too_near ? way > 360 && way < 720 : way < 360);
            for (int i = 0; i < 1000; i++) {
                TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0, remainder(set_of(SLAVE) - 20 - (set_of(MASTER) - 90), 20));
                axes_cycles(1);
                if (i)
                    continue;
                const double mean = (cm1e_axis_line(axes_axis(SLAVE), axes_axis(SLAVE)->setpoint.position) - begin) /
                                    (cm1e_axis_line(axes_axis(MASTER), axes_axis(MASTER)->setpoint.position) - master);
                TEST_ASSERT_TRUE(mode == mcCatchUp ? mean >= 1 - 1e-9 : mode == mcSlowDown ? mean <= 1 + 1e-9 : true);
            }
        }
}

/* Where the way asks for too much it is refused, in numbers, and what runs goes on; or the command that waited fails. */
static void test_a_way_that_asks_for_too_much(void)
{
    axes_begin(2);
    axes_move_velocity(MASTER, 10);
    axes_cycles(500);
    const cm1e_command_id_t runs = axes_move_velocity(SLAVE, 2);
    axes_cycles(100);
    cm1e_axis_coupling_t coupling = meet(set_of(MASTER) + 2, 300, 0);
    gear_refused(&coupling, CM1E_ERROR_AXIS_SYNC_WAY);
    axes_told(SLAVE, "needs a velocity of");
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, axes_status(SLAVE, runs).state);
    coupling = meet(set_of(MASTER) + 10, set_of(SLAVE) + 100, 3);
    const cm1e_command_id_t id = gear_in_pos(&coupling);
    AXES_UNTIL(axes_status(SLAVE, id).state == CM1E_COMMAND_ERROR);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_SYNC_WAY, axes_status(SLAVE, id).error);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, axes_status(SLAVE, runs).state);
    axes_must_be(SLAVE, CM1E_AXIS_CONTINUOUS_MOTION);
}

static void test_a_way_beyond_a_software_limit_is_refused(void)
{
    axes_describe(2);
    axes_config(SLAVE)->software_limit_negative = -1;
    axes_config(SLAVE)->software_limit_positive = 10;
    axes_make();
    axes_enable_all();
    axes_move_velocity(MASTER, 2);
    axes_cycles(100);
    const cm1e_axis_coupling_t behind = meet(20, 1, 0); /* back for a run-up of 4 u */
    gear_refused(&behind, CM1E_ERROR_AXIS_POSITION_RANGE);
    const cm1e_axis_coupling_t good = meet(20, 9, 0);
    (void)gear_in_pos(&good);
}

static void test_a_lost_master_ends_what_waits_and_nothing_else(void)
{
    axes_begin(2);
    axes_move_velocity(MASTER, 4);
    const cm1e_command_id_t runs = axes_move_velocity(SLAVE, 2);
    const cm1e_axis_coupling_t coupling = meet(100, 60, 10);
    const cm1e_command_id_t id = gear_in_pos(&coupling);
    axes_cycles(500);
    axes_power(MASTER, false);
    axes_cycles(3000);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ERROR, axes_status(SLAVE, id).state);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_MASTER_LOST, axes_status(SLAVE, id).error);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, axes_status(SLAVE, runs).state);
    axes_must_be(SLAVE, CM1E_AXIS_CONTINUOUS_MOTION);
}

/* What comes behind it waits until InSync; another command takes its place while it waits itself. */
static void test_buffered_behind_and_aborted_by_others(void)
{
    axes_begin(2);
    axes_move_velocity(MASTER, 4);
    const cm1e_axis_coupling_t coupling = meet(20, 9, 10);
    const cm1e_command_id_t id = gear_in_pos(&coupling);
    const cm1e_axis_command_t behind = {.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 1, .buffer_mode = mcBuffered};
    const cm1e_command_id_t next = axes_command(SLAVE, &behind);
    while (set_of(MASTER) < 19.9) {
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_BUFFERED, axes_status(SLAVE, next).state);
        axes_cycles(1);
    }
    axes_cycles(200);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, axes_status(SLAVE, id).state);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, axes_status(SLAVE, next).state);

    const cm1e_axis_coupling_t far = meet(1000, 9, 10);
    const cm1e_command_id_t waits = gear_in_pos(&far);
    const cm1e_command_id_t gear = axes_gear_in(SLAVE, MASTER, 1, 1);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, axes_status(SLAVE, waits).state);
    axes_wait_reached(SLAVE, gear, 3000);
}

/* A slave that waits for its master no longer can be the master of that axis. */
static void test_aborted_while_it_waits_it_makes_no_ring(void)
{
    axes_begin(2);
    axes_move_velocity(MASTER, 4);
    const cm1e_axis_coupling_t far = meet(1000, 9, 10);
    const cm1e_command_id_t waits = gear_in_pos(&far);
    axes_cycles(10);
    axes_move_velocity(SLAVE, 1);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, axes_status(SLAVE, waits).state);
    axes_wait_reached(MASTER, axes_gear_in(MASTER, SLAVE, 1, 1), 3000);
}

/* It waits behind a move, and then for its master. */
static void test_buffered_itself(void)
{
    axes_begin(2);
    axes_move_velocity(MASTER, 4);
    const cm1e_command_id_t move = axes_move_to(SLAVE, 2, 10);
    const cm1e_axis_coupling_t coupling = meet(20, 9, 10);
    cm1e_axis_command_t command = in_pos(&coupling);
    command.buffer_mode = mcBuffered;
    const cm1e_command_id_t id = axes_command(SLAVE, &command);
    axes_wait(SLAVE, move, 3000);
    axes_cycles(10);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, axes_status(SLAVE, move).state);
    must_show(id, CM1E_COMMAND_BUFFERED, false, false);
    axes_must_be(SLAVE, CM1E_AXIS_STANDSTILL);
    meets(id, 20, 9, 1, 8000);
}

static void test_wrong_inputs_are_refused(void)
{
    axes_begin(2);
    static const double bad[] = {NAN, INFINITY, 1e300};
    for (int i = 0; i < 3; i++) {
        cm1e_axis_coupling_t coupling = meet(bad[i], 0, 0);
        gear_refused(&coupling, CM1E_ERROR_AXIS_POSITION_RANGE);
        coupling = meet(0, bad[i], 0);
        gear_refused(&coupling, CM1E_ERROR_AXIS_POSITION_RANGE);
        coupling = meet(0, 0, bad[i]);
        gear_refused(&coupling, CM1E_ERROR_AXIS_POSITION_RANGE);
    }
    cm1e_axis_coupling_t coupling = meet(10, 10, 0);
    coupling.sync_mode = (MC_SYNC_MODE)3;
    gear_refused(&coupling, CM1E_ERROR_INVALID_ARGUMENT);
    coupling.sync_mode = mcShortest;
    coupling.master[0].numerator = 0;
    gear_refused(&coupling, CM1E_ERROR_AXIS_RATIO);
    coupling.master[0] = (cm1e_coupling_master_t){.axis = axes_reference(SLAVE), .numerator = 1, .denominator = 1};
    gear_refused(&coupling, CM1E_ERROR_AXIS_COUPLING_CYCLE);
    coupling = meet(10, 10, 0);
    cm1e_axis_command_t command = in_pos(&coupling);
    command.velocity = 0;
    axes_refused(SLAVE, &command, CM1E_ERROR_AXIS_VELOCITY_RANGE);
}

/* An axis that only waits to follow is its master's follower already: no cycle may come of it. */
static void test_two_that_wait_for_each_other_are_refused(void)
{
    axes_begin(2);
    const cm1e_axis_coupling_t coupling = meet(10, 10, 5);
    (void)gear_in_pos(&coupling);
    const cm1e_axis_coupling_t back = {
        .master = {{.axis = axes_reference(SLAVE), .numerator = 1, .denominator = 1}}};
    axes_refused(MASTER, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_GEAR_IN, .coupling = &back},
                 CM1E_ERROR_AXIS_COUPLING_CYCLE);
}

/* Whatever both do: a way that is taken is gone to its end, within the slave's limits (the bench watches), while the
 * master keeps its velocity. */
static void test_random_ways_that_begin_come_to_their_end(void)
{
    int begun = 0, refused = 0;
    for (int n = 0; n < 300; n++) {
        axes_begin(2);
        const double direction = one_in(2) ? 1 : -1, velocity = direction * random_decade(0.5, 12);
        axes_move_velocity(MASTER, velocity);
        axes_cycles(500);
        if (!one_in(3))
            axes_move_velocity(SLAVE, random_between(-12, 12));
        axes_cycles((int)random_between(1, 1200));
        const double way = direction * random_decade(0.3, 30), start = one_in(3) ? 0 : way * random_between(0.1, 1);
        const double slave = set_of(SLAVE) + random_between(-2, 2) * way;
        cm1e_axis_coupling_t coupling = meet(set_of(MASTER) + way, slave, start);
        coupling.master[0].numerator = one_in(2) ? 1 : -2;
        coupling.master[0].denominator = one_in(2) ? 1 : 3;
        const cm1e_axis_command_t command = in_pos(&coupling);
        cm1e_command_id_t id;
        const cm1e_error_t error = cm1e_axis_start(axes_axis(SLAVE), &command, &id);
        if (error != CM1E_OK) {
            TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_SYNC_WAY, error);
            refused++;
            continue;
        }
        int cycles = 0;
        while (axes_status(SLAVE, id).state <= CM1E_COMMAND_ACTIVE && !axes_status(SLAVE, id).reached) {
            axes_cycles(1);
            AXES_MUST(++cycles < 100000, "run %d: never InSync", n);
        }
        const cm1e_command_status_t status = axes_status(SLAVE, id);
        if (status.state == CM1E_COMMAND_ERROR && status.error == CM1E_ERROR_AXIS_SYNC_WAY) {
            refused++;
            continue;
        }
        AXES_MUST(status.reached, "run %d: %s", n, axes_text(SLAVE));
        begun++;
        const double ratio = (double)coupling.master[0].numerator / coupling.master[0].denominator;
        meets(id, coupling.master_sync_position, coupling.slave_sync_position, ratio, 300);
    }
    printf("%d ways gone, %d refused\n", begun, refused);
    TEST_ASSERT_TRUE(begun > 50 && refused > 20);
}

/* ---- MC_CamIn by way --------------------------------------------------------------------------------------------- */

static double smooth_step(double t) { return t * t * t * (10 + t * (-15 + t * 6)); }

/* From 0 to 1 over 10 u, then on: every period is 1 u farther. */
static double stairs(double x) { return floor(x / 10) + smooth_step(x / 10 - floor(x / 10)); }

static cm1e_axis_coupling_t by_stairs(double sync, double distance, MC_START_MODE mode, bool absolute)
{
    MC_CAM_POINT points[] = {{0, 0, 0, 0}, {10, 1, 0, 0}};
    const MC_CAM_REF table = {points, 2, mcCamPolynomial5};
    cm1e_axis_coupling_t coupling = {.master = {{.axis = axes_reference(MASTER), .numerator = 1, .denominator = 1}},
                                     .master_sync_position = sync, .master_start_distance = distance,
                                     .start_mode = mode};
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_cam_select(axes_axis(SLAVE), &table, true, absolute, absolute,
                                                        &coupling.cam));
    return coupling;
}

static void test_a_cam_by_way_is_in_step_at_its_place(void)
{
    for (int back = 0; back < 2; back++)
        for (int mode = mcAbsolute; mode <= (int)mcRampIn; mode += 2) {
            axes_begin(2);
            axes_wait(SLAVE, axes_move_to(SLAVE, 0.3, 10), 3000);
            axes_move_velocity(MASTER, back ? -4 : 4);
            axes_cycles(5000);
            const cm1e_axis_coupling_t coupling = by_stairs(3, back ? -6 : 6, (MC_START_MODE)mode, true);
            const cm1e_command_id_t id =
                axes_command(SLAVE, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_CAM_IN, .coupling = &coupling});
            bool begun = false, met = false;
            for (int i = 0; i < 15000; i++) {
                axes_cycles(1);
                const cm1e_command_status_t status = axes_status(SLAVE, id);
                const double master = set_of(MASTER), phase = master - 10 * floor(master / 10);
                if (status.state == CM1E_COMMAND_ACTIVE && !begun) /* 3 - 6 + 10, or 3 + 6 */
                    TEST_ASSERT_DOUBLE_WITHIN(0.005, back ? 9 : 7, phase);
                begun = status.state == CM1E_COMMAND_ACTIVE;
                if (status.reached && !met)
                    TEST_ASSERT_DOUBLE_WITHIN(0.005, 3, phase);
                met = status.reached;
                if (met)
                    TEST_ASSERT_DOUBLE_WITHIN(2e-8, stairs(master), set_of(SLAVE));
            }
            TEST_ASSERT_TRUE(met);
        }
}

/* Of the turns of a modulo slave the one in which its slope changes least, also where another one is nearer now. */
static void test_a_cam_by_way_on_a_modulo_slave(void)
{
    axes_describe(2);
    axes_config(SLAVE)->modulo_range = 1;
    axes_make();
    axes_enable_all();
    axes_move_velocity(MASTER, 4);
    axes_move_velocity(SLAVE, 6);
    axes_cycles(3210);
    const cm1e_axis_coupling_t coupling = by_stairs(3, 6, mcRampIn, true);
    const cm1e_command_id_t id =
        axes_command(SLAVE, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_CAM_IN, .coupling = &coupling});
    axes_wait_reached(SLAVE, id, 20000);
    for (int n = 0; n < 6000; n++) {
        axes_cycles(1);
        TEST_ASSERT_DOUBLE_WITHIN(2e-8, 0, remainder(set_of(SLAVE) - stairs(set_of(MASTER)), 1));
    }
    axes_must_be(SLAVE, CM1E_AXIS_SYNCHRONIZED_MOTION);
}

/* In step with a cam that is run once, from 0 to 4 u on 10 u of the master, by a way of 5 u before it. */
static void into_single_shot(double slope_at_begin)
{
    axes_begin(2);
    const MC_CAM_POINT points[] = {{0, 0, slope_at_begin, 0}, {10, 4, 0, 0}};
    const MC_CAM_REF table = {points, 2, mcCamPolynomial5};
    cm1e_axis_coupling_t coupling = {.master = {{.axis = axes_reference(MASTER), .numerator = 1, .denominator = 1}},
                                     .master_start_distance = 5, .start_mode = mcRampIn};
    axes_wait(MASTER, axes_move_to(MASTER, -10, 10), 5000);
    axes_wait(SLAVE, axes_move_to(SLAVE, -3, 10), 5000);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_cam_select(axes_axis(SLAVE), &table, false, true, true, &coupling.cam));
    const cm1e_command_id_t id =
        axes_command(SLAVE, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_CAM_IN, .coupling = &coupling});
    axes_move_velocity(MASTER, 4);
    axes_wait_reached(SLAVE, id, 8000);
}

/* A cam that is run once, and rises from its first point on: that is where the way ends when nothing else is said. */
static void test_a_single_shot_that_begins_with_a_slope(void)
{
    into_single_shot(1);
    TEST_ASSERT_DOUBLE_WITHIN(0.005, 0, set_of(MASTER));
    AXES_UNTIL(set_of(MASTER) > 12);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 4, set_of(SLAVE));
    axes_must_be(SLAVE, CM1E_AXIS_SYNCHRONIZED_MOTION);
}

/* It is run once, but not over before the master was through: a little to and fro at its beginning does not end it. */
static void test_a_single_shot_whose_master_hesitates_at_its_beginning(void)
{
    into_single_shot(0);
    static const struct { double master, slave; } moves[] = {{-0.5, 0}, {5, 2}, {-0.5, 0}, {12, 4}, {5, 4}, {-3, 4}};
    for (int i = 0; i < 6; i++) {
        axes_wait(MASTER, axes_move_to(MASTER, moves[i].master, 4), 8000);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, moves[i].slave, set_of(SLAVE));
    }
    axes_must_be(SLAVE, CM1E_AXIS_SYNCHRONIZED_MOTION);
}

/* ContinuousUpdate on the way: a new offset counts from the end of the approach on, which itself goes on as planned. */
static void test_an_offset_that_changes_on_the_way_counts_from_its_end_on(void)
{
    double on_the_way[2];
    for (int changes = 0; changes < 2; changes++) {
        axes_begin(2);
        const MC_CAM_POINT points[] = {{0, 0, 0, 0}, {10, 4, 0, 0}};
        const MC_CAM_REF table = {points, 2, mcCamPolynomial5};
        cm1e_axis_coupling_t coupling = {.master = {{.axis = axes_reference(MASTER), .numerator = 1, .denominator = 1}},
                                         .master_start_distance = 5, .start_mode = mcRampIn};
        axes_wait(MASTER, axes_move_to(MASTER, -10, 10), 5000);
        axes_wait(SLAVE, axes_move_to(SLAVE, -3, 10), 5000);
        TEST_ASSERT_EQUAL_INT(CM1E_OK,
                              cm1e_axis_cam_select(axes_axis(SLAVE), &table, false, true, true, &coupling.cam));
        const cm1e_axis_command_t command = {.kind = CM1E_COMMAND_CAM_IN, .coupling = &coupling};
        const cm1e_command_id_t id = axes_command(SLAVE, &command);
        axes_move_velocity(MASTER, 4);
        AXES_UNTIL(set_of(MASTER) > -3);
        coupling.slave_offset = changes ? 0.3 : 0;
        for (int cycles = 0; set_of(MASTER) < 12; cycles++) {
            TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_update(axes_axis(SLAVE), id, &command));
            axes_cycles(1);
            if (cycles == 500)
                on_the_way[changes] = set_of(SLAVE); /* the master is at about -1 */
        }
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, changes ? 4.3 : 4, set_of(SLAVE));
    }
    TEST_ASSERT_EQUAL_DOUBLE(on_the_way[0], on_the_way[1]);
}

/* After the first cycle of StartSync the master goes at another velocity. */
static double way_off(double masters_velocity)
{
    axes_begin(2);
    const cm1e_axis_coupling_t coupling = meet(20, 4.5, 8);
    const cm1e_command_id_t id = gear_in_pos(&coupling);
    axes_move_velocity(MASTER, 8);
    AXES_UNTIL(axes_status(SLAVE, id).synchronizing);
    axes_move_velocity(MASTER, masters_velocity);
    AXES_UNTIL(set_of(MASTER) >= 20);
    axes_must_be(SLAVE, CM1E_AXIS_SYNCHRONIZED_MOTION);
    const double off = 4.5 + set_of(MASTER) - 20 - set_of(SLAVE);
    must_show(id, CM1E_COMMAND_ACTIVE, fabs(off) > 1e-6, fabs(off) <= 1e-6);
    AXES_UNTIL(axes_status(SLAVE, id).reached || !axes_status(SLAVE, id).synchronizing);
    must_show(id, CM1E_COMMAND_ACTIVE, false, true);
    TEST_ASSERT_DOUBLE_WITHIN(2e-8, 4.5 + set_of(MASTER) - 20, set_of(SLAVE));
    return off;
}

static void test_a_slave_whose_master_becomes_too_fast_is_late(void)
{
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0.0, way_off(8));
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0.0, way_off(5));
    TEST_ASSERT_TRUE(way_off(24) > 0.01);
}

int main(void)
{
    UNITY_BEGIN();
    seed_random();
    RUN_TEST(test_figure_44);
    RUN_TEST(test_the_way_is_the_polynomial_over_the_master);
    RUN_TEST(test_the_motion_before_goes_on_until_start_sync);
    RUN_TEST(test_from_one_gear_into_another);
    RUN_TEST(test_a_stop_before_start_sync_inhibits_it);
    RUN_TEST(test_a_master_that_turns_round_on_the_way);
    RUN_TEST(test_a_master_that_turns_round_over_the_beginning);
    RUN_TEST(test_a_master_that_goes_away_from_the_first_cycle_on);
    RUN_TEST(test_in_the_other_direction);
    RUN_TEST(test_without_a_distance_the_whole_way_is_used);
    RUN_TEST(test_who_stands_in_step_is_in_step);
    RUN_TEST(test_modulo_axes_by_every_mode);
    RUN_TEST(test_a_way_that_asks_for_too_much);
    RUN_TEST(test_a_way_beyond_a_software_limit_is_refused);
    RUN_TEST(test_a_lost_master_ends_what_waits_and_nothing_else);
    RUN_TEST(test_buffered_behind_and_aborted_by_others);
    RUN_TEST(test_aborted_while_it_waits_it_makes_no_ring);
    RUN_TEST(test_buffered_itself);
    RUN_TEST(test_wrong_inputs_are_refused);
    RUN_TEST(test_two_that_wait_for_each_other_are_refused);
    RUN_TEST(test_random_ways_that_begin_come_to_their_end);
    RUN_TEST(test_a_cam_by_way_on_a_modulo_slave);
    RUN_TEST(test_a_cam_by_way_is_in_step_at_its_place);
    RUN_TEST(test_a_single_shot_that_begins_with_a_slope);
    RUN_TEST(test_a_single_shot_whose_master_hesitates_at_its_beginning);
    RUN_TEST(test_a_slave_whose_master_becomes_too_fast_is_late);
    RUN_TEST(test_an_offset_that_changes_on_the_way_counts_from_its_end_on);
    return UNITY_END();
}
