/* What goes wrong with one axis of a group, in every phase of a motion: the others come to rest along the path, without
 * a step, and say why; afterwards the group can be brought back. */
#include "unity.h"

#include "../support/group_bench.h"
#include "../support/ordinary_witness.h"

void setUp(void) {}
void tearDown(void) { group_end(); }

typedef enum harm { A_FAULT = 0, POWER_OFF, STOPPED, TORQUE_LOST, BLOCKED, DIRECTION, HARMS } harm_t;

static const char *const harm_names[] = {"fault", "power off", "MC_Stop", "torque lost", "blocked", "direction"};

static void do_harm(harm_t harm, int victim)
{
    cm1e_command_id_t id;
    switch (harm) {
    case A_FAULT: fake_bus_fault(axes_motor(victim), 0x2310); break;
    case POWER_OFF: axes_power(victim, false); break;
    case STOPPED:
        (void)cm1e_axis_start(axes_axis(victim), &(cm1e_axis_command_t){.kind = CM1E_COMMAND_STOP}, &id);
        cm1e_axis_hold_stop(axes_axis(victim), id, false);
        break;
    case TORQUE_LOST: axes_motor(victim)->state = SWITCH_ON_DISABLED; break;
    case BLOCKED: axes_motor(victim)->blocked = true; break;
    case DIRECTION: axes_bench.positive[victim] = false; break;
    default: break;
    }
}

static void undo_harm(harm_t harm, int victim)
{
    switch (harm) {
    case POWER_OFF: axes_power(victim, true); break;
    case BLOCKED: axes_motor(victim)->blocked = false; break;
    case DIRECTION: axes_bench.positive[victim] = true; break;
    default: break;
    }
}

/* The two axes that are left, against the line that all three were on: (0, 0, 0) to (3, 1.5, 0.75). */
static void stay_on_the_line(int victim)
{
    static const double way[] = {3.0, 1.5, 0.75};
    const int a = victim == 0 ? 1 : 0, b = victim == 2 ? 1 : 2;
    const double off = group_at(a) * way[b] - group_at(b) * way[a];
    AXES_MUST(fabs(off) < 3e-9, "axis %d at %.12g, axis %d at %.12g: %.3g beside the path", a, group_at(a), b,
              group_at(b), off);
}

/* `when` cycles into a line of three axes. */
static void harm_in_motion(harm_t harm, int victim, int when)
{
    char run[80];
    snprintf(run, sizeof run, "%s of axis %d in cycle %d", harm_names[harm], victim, when);
    group_begin(3);
    axes_bench.run = run;
    if (harm == BLOCKED) /* the motor's own set-points are judged, not where it is braked from */
        axes_bench.witness[victim].strictness = AXES_UNWATCHED;
    const cm1e_command_id_t id = group_command(&(cm1e_group_command_t){
        .kind = CM1E_GROUP_LINEAR_ABSOLUTE, .position = {3.0, 1.5, 0.75}, .velocity = 4.0});
    axes_cycles(when);
    do_harm(harm, victim);
    int waited = 0;
    while (group_info().state == CM1E_GROUP_MOVING && waited++ < 3000) {
        axes_cycles(1);
        stay_on_the_line(victim);
    }
    if (group_info().state == CM1E_GROUP_STANDBY) /* done before the harm was felt */
        return;
    group_must_be(CM1E_GROUP_ERROR_STOP);
    const cm1e_command_status_t status = cm1e_group_command_status(group, id);
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_COMMAND_ERROR, status.state, run);
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_ERROR_GROUP_ERROR_STOP, status.error, run);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE((unsigned)victim + 1, group->culprit, run);
    for (waited = 0; group->led && waited < 2000; waited++) {
        axes_cycles(1);
        stay_on_the_line(victim);
    }
    TEST_ASSERT_LESS_THAN_INT_MESSAGE(150, waited, run); /* 4 u/s by 100 u/s2 and 2000 u/s3 */
    for (int n = 0; n < 3; n++)
        if (n != victim)
            axes_must_be(n, CM1E_AXIS_STANDSTILL);
    undo_harm(harm, victim);
    axes_cycles(300); /* the victim comes to rest too */
    cm1e_group_reset(group);
    for (waited = 0; cm1e_group_reset_state(group, NULL) == CM1E_COMMAND_ACTIVE && waited < 1000; waited++)
        axes_cycles(1);
    axes_cycles(100);
    group_must_be(CM1E_GROUP_STANDBY);
    group_done(group_command(&(cm1e_group_command_t){.kind = CM1E_GROUP_LINEAR_ABSOLUTE,
                                                     .position = {0.5, 0.5, 0.5}, .velocity = 10.0}));
}

static void sweep(harm_t harm)
{
    for (int victim = 0; victim < 3; victim++)
        for (int when = 1; when < 1400; when += when < 12 ? 1 : 67)
            harm_in_motion(harm, victim, when);
}

static void test_a_fault_at_every_moment(void) { sweep(A_FAULT); }
static void test_power_off_at_every_moment(void) { sweep(POWER_OFF); }
static void test_a_stop_of_one_axis_at_every_moment(void) { sweep(STOPPED); }
static void test_torque_lost_at_every_moment(void) { sweep(TORQUE_LOST); }
static void test_a_blocked_motor_at_every_moment(void) { sweep(BLOCKED); }
static void test_a_direction_taken_away_at_every_moment(void) { sweep(DIRECTION); }

/* In other phases: while it stops, while it halts, over a corner, while it stands held. */
static void test_a_fault_while_it_comes_to_rest(void)
{
    for (int kind = CM1E_GROUP_HALT; kind <= CM1E_GROUP_STOP; kind++)
        for (int when = 0; when < 260; when += 13) {
            group_begin(3);
            group_line(5.0, 2.0, 4.0, mcAborting);
            axes_cycles(500);
            const cm1e_command_id_t id = group_command(&(cm1e_group_command_t){.kind = (cm1e_group_kind_t)kind});
            axes_cycles(when);
            const bool ended = group_info().state == CM1E_GROUP_STANDBY, done = group_state_of(id) == CM1E_COMMAND_DONE;
            fake_bus_fault(axes_motor(0), 0x2310);
            axes_cycles(3);
            group_must_be(CM1E_GROUP_ERROR_STOP);
            TEST_ASSERT_EQUAL_INT(ended || done ? CM1E_COMMAND_DONE : CM1E_COMMAND_ERROR, group_state_of(id));
            axes_cycles(1000);
            axes_must_be(1, CM1E_AXIS_STANDSTILL);
            group_end();
        }
}

static void test_a_fault_over_a_corner(void)
{
    for (int when = 350; when < 750; when += 7) {
        group_begin(3);
        group_line(1.0, 0.0, 2.0, mcAborting);
        cm1e_group_command_t up = {.kind = CM1E_GROUP_LINEAR_ABSOLUTE, .position = {1.0, 1.0}, .velocity = 2.0,
                                   .buffer_mode = mcBlendingHigh, .transition = mcTMMaxCornerDeviation,
                                   .transition_parameter = 0.1};
        const cm1e_command_id_t id = group_command(&up);
        axes_cycles(when);
        fake_bus_fault(axes_motor(2), 0x2310);
        axes_cycles(600);
        group_must_be(CM1E_GROUP_ERROR_STOP);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ERROR, group_state_of(id));
        const double off = fmin(group_off_line(0, 0, 1, 0), group_off_line(1, 0, 1, 1));
        TEST_ASSERT_TRUE(off <= 0.1);
        group_end();
    }
}

/* Two at once, and all of them. */
static void test_several_axes_fail_together(void)
{
    for (int victims = 2; victims <= 3; victims++) {
        group_begin(3);
        group_line(3.0, 1.0, 3.0, mcAborting);
        axes_cycles(400);
        for (int n = 0; n < victims; n++)
            fake_bus_fault(axes_motor(n), 0x2310);
        axes_cycles(800);
        group_must_be(CM1E_GROUP_ERROR_STOP);
        TEST_ASSERT_EQUAL_UINT(0, group->led);
        TEST_ASSERT_EQUAL_UINT32(1, group->culprit);
        cm1e_group_reset(group);
        axes_cycles(200);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, cm1e_group_reset_state(group, NULL));
        group_done(group_line(0.0, 0.0, 3.0, mcAborting));
        group_end();
    }
}

/* From a path of one direction all stop at one point of it, whether their drives have heard the last frames or not. */
static void test_a_bus_that_is_lost_holds_every_axis_on_the_path(void)
{
    for (int cycle = 1; cycle < 900; cycle += 7) {
        group_begin(3);
        group_line(3.0, 1.0, 1.5, mcAborting);
        axes_cycles(cycle);
        double at[3];
        for (int n = 0; n < 3; n++)
            at[n] = axes_info(n).set_position;
        axes_bench.received = CM1E_ERROR_BUS_LOST;
        axes_cycles(2);
        axes_bench.health = CM1E_ERROR_BUS_LOST;
        axes_cycles(1);
        for (int n = 0; n < 3; n++)
            axes_must_be(n, CM1E_AXIS_ERROR_STOP);
        axes_bench.received = axes_bench.health = CM1E_OK;
        axes_cycles(500);
        group_must_be(CM1E_GROUP_ERROR_STOP);
        for (int n = 0; n < 3; n++) {
            axes_must_be(n, CM1E_AXIS_ERROR_STOP);
            TEST_ASSERT_DOUBLE_WITHIN(1.0 / 50000, at[n], axes_info(n).actual_position);
        }
    }
}

static double shaft[3];

/* The fake drives' shafts turn by their target velocities. */
static void turn(cm1e_bus_t *motor)
{
    double *at = &shaft[motor == axes_motor(0) ? 0 : motor == axes_motor(1) ? 1 : 2];
    *at += motor->target_velocity_raw * 1e-3;
    motor->velocity_raw = motor->target_velocity_raw;
    motor->position = (int32_t)lround(*at);
}

static void begin_by_velocity_from(int first)
{
    group_end();
    axes_describe(3);
    for (int n = first; n < 3; n++) {
        axes_config(n)->mapping = CM1E_MAPPING_CSV;
        cm1e_device_pdo(&axes_motor(n)->rx, CM1E_MAPPING_CSV, false, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
        cm1e_device_pdo(&axes_motor(n)->tx, CM1E_MAPPING_CSV, true, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
        axes_motor(n)->mode = axes_motor(n)->sdo_mode = CM1E_MODE_CSV;
        axes_motor(n)->world = turn;
        shaft[n] = axes_motor(n)->position;
    }
    axes_config(1)->max_deceleration = 60; /* it needs the longest */
    axes_make();
    axes_enable_all();
    group_form();
    AXES_MUST(cm1e_group_enable(group) == CM1E_OK, "%s", group_text());
}

static void begin_by_velocity(void) { begin_by_velocity_from(0); }

/* In CSV the axes go on: all with one ramp, in step along the line. */
static void test_a_bus_that_is_lost_brakes_the_axes_in_step_in_csv(void)
{
    begin_by_velocity();
    group_line(3.0, 2.0, 3.0, mcAborting);
    axes_cycles(500);
    double at[3], before[3];
    for (int n = 0; n < 3; n++) {
        at[n] = axes_axis(n)->setpoint.velocity;
        before[n] = cm1e_axis_line(axes_axis(n), axes_axis(n)->setpoint.position);
    }
    TEST_ASSERT_TRUE(fabs(at[0]) > 0.5 && fabs(at[1]) > 0.3);
    int longest_ms = 0; /* docs/SAFETY.md: length of the longest ramp */
    for (int n = 0; n < 3; n++)
        longest_ms = (int)fmax(longest_ms, ceil(fabs(at[n]) / axes_axis(n)->limits.maximum.deceleration * 1e3));
    axes_bench.received = CM1E_ERROR_BUS_LOST;
    axes_bench.health = CM1E_ERROR_BUS_LOST;
    for (int i = 0; i < 200; i++) {
        axes_cycles(1);
        for (int n = 1; n < 3; n++) {
            const double way = cm1e_axis_line(axes_axis(n), axes_axis(n)->setpoint.position) - before[n];
            const double first = cm1e_axis_line(axes_axis(0), axes_axis(0)->setpoint.position) - before[0];
            if (axis_on_profile(axes_axis(0)) && axis_on_profile(axes_axis(n)))
                TEST_ASSERT_DOUBLE_WITHIN(2.0 / 50000, first * at[n] / at[0], way);
        }
        for (int n = 0; n < 3 && i > longest_ms; n++)
            TEST_ASSERT_EQUAL_DOUBLE(0.0, axes_axis(n)->setpoint.velocity);
    }
    for (int n = 0; n < 3; n++)
        axes_must_be(n, CM1E_AXIS_ERROR_STOP);
}

/* Single lost frames shortly one after the other: a path with an axis in CSP begins anew from rest. An axis in CSV is
 * still on its way then, and fails; however slow it is, its velocity does not jump (the bench watches). */
static void test_an_axis_by_velocity_does_not_jump_where_the_path_begins_anew(void)
{
    for (int order = 0; order < 2; order++) {
        begin_by_velocity_from(1);
        for (int n = 0; n < 3; n++)
            axes_bench.order[n] = order ? 2 - n : n;
        group_line(1.0, 1.0, 0.08, mcAborting);
        axes_cycles(500);
        for (int i = 0; i < 4; i++) {
            axes_bench.received = CM1E_ERROR_BUS_LOST;
            axes_cycles(1);
            axes_bench.received = CM1E_OK;
            axes_cycles(2);
        }
        axes_must_be(1, CM1E_AXIS_ERROR_STOP);
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_COUPLING_LIMIT, axes_axis(1)->fault.error);
        axes_told(1, "pause");
        axes_cycles(500);
        group_must_be(CM1E_GROUP_ERROR_STOP);
        TEST_ASSERT_EQUAL_DOUBLE(0.0, axes_axis(0)->setpoint.velocity);
    }
}

static void test_the_end_of_a_run_shuts_all_axes_down(void)
{
    group_begin(3);
    group_line(3.0, 1.0, 3.0, mcAborting);
    axes_cycles(400);
    bool down = false;
    for (int i = 0; i < 2000 && !down; i++) {
        fake_bus_cycle(&axes_bench.bus, axes_bench.cycle_ns);
        down = true;
        for (int n = 0; n < 3; n++)
            ordinary_inputs(axes_axis(n), CM1E_OK, CM1E_OK, axes_bench.bus.clock.virtual_now_ns);
        for (int n = 0; n < 3; n++)
            down = cm1e_axis_shut_down(axes_axis(n)) && down;
        axes_outputs();
    }
    TEST_ASSERT_TRUE(down);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_destroy(group_reference));
}

/* Nobody asks the group what became of it: the others brake along the path all the same. */
static void test_an_axis_that_is_destroyed_on_the_way(void)
{
    group_begin(3);
    group_line(3.0, 1.0, 3.0, mcAborting);
    axes_cycles(400);
    cm1e_axis_destroy(axes_bench.axes[1]);
    axes_bench.axes[1] = NULL;
    TEST_ASSERT_EQUAL_INT(CM1E_GROUP_ERROR_STOP, group->state);
    TEST_ASSERT_EQUAL_UINT(1u << 0 | 1u << 2, group->led);
    for (int i = 0; i < 2000 && group->led; i++)
        for (int n = 0; n < 3; n += 2) {
            ordinary_inputs(axes_axis(n), CM1E_OK, CM1E_OK, axes_bench.bus.clock.virtual_now_ns);
            ordinary_outputs(axes_axis(n));
        }
    TEST_ASSERT_EQUAL_DOUBLE(0.0, axes_axis(0)->setpoint.velocity);
    group_must_be(CM1E_GROUP_ERROR_STOP);
    group_told("does not exist any more");
}

/* The last look of the axis: a path that asks for too much stops all. */
static void test_a_limit_that_is_lowered_on_the_way_stops_it(void)
{
    group_begin(3);
    group_line(3.0, 1.0, 3.0, mcAborting);
    axes_cycles(400);
    axes_axis(1)->limits.positive = group_at(1) + 0.05;
    axes_axis(1)->limits.positive_enabled = true;
    cm1e_axis_apply_limits(axes_axis(1));
    axes_cycles(800);
    group_must_be(CM1E_GROUP_ERROR_STOP);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_COUPLING_LIMIT, axes_info(1).error);
    group_told("cannot stop before the software limit");
    TEST_ASSERT_TRUE(group_at(1) <= axes_axis(1)->limits.positive + 1e-6);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_fault_at_every_moment);
    RUN_TEST(test_power_off_at_every_moment);
    RUN_TEST(test_a_stop_of_one_axis_at_every_moment);
    RUN_TEST(test_torque_lost_at_every_moment);
    RUN_TEST(test_a_blocked_motor_at_every_moment);
    RUN_TEST(test_a_direction_taken_away_at_every_moment);
    RUN_TEST(test_a_fault_while_it_comes_to_rest);
    RUN_TEST(test_a_fault_over_a_corner);
    RUN_TEST(test_several_axes_fail_together);
    RUN_TEST(test_a_bus_that_is_lost_holds_every_axis_on_the_path);
    RUN_TEST(test_a_bus_that_is_lost_brakes_the_axes_in_step_in_csv);
    RUN_TEST(test_an_axis_by_velocity_does_not_jump_where_the_path_begins_anew);
    RUN_TEST(test_the_end_of_a_run_shuts_all_axes_down);
    RUN_TEST(test_an_axis_that_is_destroyed_on_the_way);
    RUN_TEST(test_a_limit_that_is_lowered_on_the_way_stops_it);
    return UNITY_END();
}
