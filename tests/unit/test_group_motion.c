/* Motion of an axes group: lines and arcs against what was programmed, buffering and transitions, what is refused. The
 * witness of axes_bench.h looks at every set-point of every axis. */
#include <stdlib.h>

#include "unity.h"

#include "../support/group_bench.h"
#include "../support/ordinary_witness.h"
#include "axis/axis_parameters.h"

/* u; a count is 2e-5. */
static const double exact = 1e-9;

void setUp(void) { group_begin(3); }
void tearDown(void) { group_end(); }

static cm1e_group_command_t line_to(double x, double y, double velocity)
{
    return (cm1e_group_command_t){.kind = CM1E_GROUP_LINEAR_ABSOLUTE, .position = {x, y}, .velocity = velocity};
}

/* ---- geometry ---------------------------------------------------------------------------------------------------- */

static void test_a_line_is_straight_and_ends_where_it_should(void)
{
    cm1e_group_command_t command = line_to(3.0, -1.5, 4.0);
    command.position[2] = 0.75;
    const cm1e_command_id_t id = group_command(&command);
    double fastest = 0.0;
    while (group_state_of(id) == CM1E_COMMAND_ACTIVE) {
        axes_cycles(1);
        const double part = group_at(0) / 3.0, way = sqrt(9.0 + 2.25 + 0.5625);
        TEST_ASSERT_DOUBLE_WITHIN(exact * way, -1.5 * part, group_at(1));
        TEST_ASSERT_DOUBLE_WITHIN(exact * way, 0.75 * part, group_at(2));
        fastest = fmax(fastest, group->sample.path_velocity);
    }
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, group_state_of(id));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 4.0, fastest);
    TEST_ASSERT_EQUAL_DOUBLE(3.0, group_at(0));
    TEST_ASSERT_EQUAL_DOUBLE(-1.5, group_at(1));
    TEST_ASSERT_EQUAL_DOUBLE(0.75, group_at(2));
    group_must_be(CM1E_GROUP_STANDBY); /* in the cycle in which it is done */
    for (int n = 0; n < 3; n++) {
        axes_must_be(n, CM1E_AXIS_STANDSTILL);
        TEST_ASSERT_EQUAL_INT32(lround(group_at(n) * 50000.0),
                                (int32_t)fake_output(axes_motor(n), OBJ_607A_TARGET_POSITION, 0));
    }
}

static void test_without_dynamics_it_goes_as_the_axes_allow(void)
{
    const cm1e_command_id_t id = group_command(&(cm1e_group_command_t){.kind = CM1E_GROUP_LINEAR_ABSOLUTE,
                                                                       .position = {60.0, 20.0}});
    double fastest = 0.0, steepest = 0.0;
    while (group_state_of(id) == CM1E_COMMAND_ACTIVE) {
        axes_cycles(1);
        fastest = fmax(fastest, axes_info(0).set_velocity);
        steepest = fmax(steepest, axes_info(0).set_acceleration);
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, axes_axis(0)->limits.maximum.velocity, fastest);
    TEST_ASSERT_DOUBLE_WITHIN(2.1, axes_axis(0)->limits.maximum.acceleration, steepest);
}

static void test_arcs_by_border_and_by_centre(void)
{
    static const struct {
        MC_CIRC_MODE mode;
        MC_CIRC_PATHCHOICE choice;
        double auxiliary[2], end[2], centre[2], radius;
        double passes[2]; /* a place that it comes by */
    } cases[] = {
        {mcBorder, mcClockwise, {1.0, 1.0}, {2.0, 0.0}, {1.0, 0.0}, 1.0, {1.0, 1.0}},
        {mcBorder, mcClockwise, {1.0, -1.0}, {2.0, 0.0}, {1.0, 0.0}, 1.0, {1.0, -1.0}},
        {mcCenter, mcCounterClockwise, {0.0, 2.0}, {2.0, 2.0}, {0.0, 2.0}, 2.0, {1.41421356237, 0.58578643763}},
        {mcCenter, mcClockwise, {0.0, 2.0}, {2.0, 2.0}, {0.0, 2.0}, 2.0, {-2.0, 2.0}},
        {mcCenter, mcCounterClockwise, {0.0, 1.0}, {0.0, 0.0}, {0.0, 1.0}, 1.0, {0.0, 2.0}}, /* all the way round */
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        group_end();
        group_begin(3);
        const cm1e_command_id_t id = group_command(&(cm1e_group_command_t){
            .kind = i % 2 ? CM1E_GROUP_CIRCULAR_RELATIVE : CM1E_GROUP_CIRCULAR_ABSOLUTE,
            .circ_mode = cases[i].mode, .path_choice = cases[i].choice,
            .auxiliary = {cases[i].auxiliary[0], cases[i].auxiliary[1]},
            .position = {cases[i].end[0], cases[i].end[1]}, .velocity = 1.0});
        double nearest = 1e9;
        while (group_state_of(id) == CM1E_COMMAND_ACTIVE) {
            axes_cycles(1);
            TEST_ASSERT_TRUE(group_off_circle(cases[i].centre[0], cases[i].centre[1], cases[i].radius) < exact);
            nearest = fmin(nearest, hypot(group_at(0) - cases[i].passes[0], group_at(1) - cases[i].passes[1]));
        }
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, group_state_of(id));
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, cases[i].end[0], group_at(0));
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, cases[i].end[1], group_at(1));
        TEST_ASSERT_TRUE(nearest < 1e-3);
    }
}

static void test_further_axes_go_along(void)
{
    group_end();
    group_begin(4);
    const cm1e_command_id_t id = group_command(&(cm1e_group_command_t){.kind = CM1E_GROUP_LINEAR_ABSOLUTE,
                                                                       .position = {1.0, 1.0, 1.0, 7.0}});
    while (group_state_of(id) == CM1E_COMMAND_ACTIVE) {
        axes_cycles(1);
        TEST_ASSERT_DOUBLE_WITHIN(7.0 * exact, 7.0 * group_at(0), group_at(3));
    }
    group_done(id);
    group_done(group_command(&(cm1e_group_command_t){.kind = CM1E_GROUP_LINEAR_RELATIVE, .position = {0, 0, 0, -2.0}}));
    TEST_ASSERT_EQUAL_DOUBLE(5.0, group_at(3));
}

static void test_one_axis_is_a_group_too(void)
{
    group_end();
    group_begin(1);
    group_done(group_command(&(cm1e_group_command_t){.kind = CM1E_GROUP_LINEAR_ABSOLUTE, .position = {2.0}}));
    TEST_ASSERT_EQUAL_DOUBLE(2.0, group_at(0));
    group_refused(&(cm1e_group_command_t){.kind = CM1E_GROUP_CIRCULAR_ABSOLUTE, .auxiliary = {3.0}, .position = {4.0}},
                  CM1E_ERROR_GROUP_PATH);
    group_told("at least two axes");
}

static void test_modulo_and_inverted_axes(void)
{
    group_end();
    axes_describe(2);
    axes_config(0)->modulo_range = 1.0;
    axes_config(1)->invert = true;
    axes_make();
    axes_enable_all();
    group_form();
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_enable(group));
    group_done(group_command(&(cm1e_group_command_t){.kind = CM1E_GROUP_LINEAR_RELATIVE, .position = {5.25, 2.0}}));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.25, axes_info(0).set_position);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 2.0, axes_info(1).set_position);
    group_done(group_command(&(cm1e_group_command_t){.kind = CM1E_GROUP_LINEAR_ABSOLUTE, .position = {0.9, 1.0}}));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 4.9, group_at(0)); /* back: the shorter way */
    group_refused(&(cm1e_group_command_t){.kind = CM1E_GROUP_LINEAR_ABSOLUTE, .position = {1.0, 1.0}},
                  CM1E_ERROR_GROUP_PATH);
    group_told("range of this modulo axis");
    group_refused(&(cm1e_group_command_t){.kind = CM1E_GROUP_CIRCULAR_RELATIVE, .auxiliary = {1, 1},
                                          .position = {2, 0}}, CM1E_ERROR_GROUP_PATH);
    group_told("A circle needs linear axes");
}

static void test_a_smaller_deceleration_of_one_axis_is_kept(void)
{
    group_end();
    axes_describe(2);
    axes_config(1)->max_deceleration = 20.0;
    axes_make();
    axes_enable_all();
    group_form();
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_enable(group));
    const cm1e_command_id_t id = group_command(&(cm1e_group_command_t){.kind = CM1E_GROUP_LINEAR_ABSOLUTE,
                                                                       .position = {3.0, 3.0}});
    double steepest = 0.0;
    while (group_state_of(id) == CM1E_COMMAND_ACTIVE) {
        axes_cycles(1);
        steepest = fmin(steepest, axes_info(1).set_acceleration);
    }
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, group_state_of(id));
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, -20.0, steepest);
}

/* ---- one behind the other ---------------------------------------------------------------------------------------- */

static void test_buffered_lines_come_to_rest_between(void)
{
    const cm1e_command_id_t first = group_line(1.0, 0.0, 2.0, mcAborting);
    const cm1e_command_id_t second = group_line(1.0, 1.0, 2.0, mcBuffered);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, group_state_of(first));
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_BUFFERED, group_state_of(second));
    double corner = 1e9;
    while (group_state_of(second) != CM1E_COMMAND_DONE) {
        axes_cycles(1);
        TEST_ASSERT_TRUE(fmin(group_off_line(0, 0, 1, 0), group_off_line(1, 0, 1, 1)) < exact);
        corner = fmin(corner, hypot(group_at(0) - 1.0, group_at(1)));
        TEST_ASSERT_TRUE(group_state_of(first) == CM1E_COMMAND_DONE || group_state_of(second) == CM1E_COMMAND_BUFFERED);
    }
    TEST_ASSERT_TRUE(corner < 1e-6);
}

/* Slowest path velocity between the two commands, and the nearest that it comes to the corner (1, 0). */
static void over_the_corner(const cm1e_group_command_t *second, double *slowest, double *nearest)
{
    group_line(1.0, 0.0, 2.0, mcAborting);
    axes_cycles(5);
    const cm1e_command_id_t id = group_command(second);
    *slowest = *nearest = 1e9;
    while (group_state_of(id) != CM1E_COMMAND_DONE) {
        axes_cycles(1);
        *nearest = fmin(*nearest, hypot(group_at(0) - 1.0, group_at(1)));
        if (group_at(0) > 0.5 && group_at(0) < 1.5 && group_at(1) < 0.5)
            *slowest = fmin(*slowest, group->sample.path_velocity);
    }
}

static void test_transitions_do_not_stop_and_keep_their_tolerance(void)
{
    double slowest, nearest;
    cm1e_group_command_t up = line_to(1.0, 1.0, 2.0);
    up.buffer_mode = mcBlendingPrevious;
    up.transition = mcTMMaxCornerDeviation;
    up.transition_parameter = 0.05;
    over_the_corner(&up, &slowest, &nearest);
    TEST_ASSERT_TRUE(slowest > 0.3);
    TEST_ASSERT_TRUE(nearest <= 0.05 + 1e-9);
    TEST_ASSERT_TRUE(nearest > 1e-3);
    group_end();
    group_begin(3);
    up.transition = mcTMCornerDistance;
    up.transition_parameter = 0.2;
    over_the_corner(&up, &slowest, &nearest);
    TEST_ASSERT_TRUE(slowest > 0.3);
    TEST_ASSERT_TRUE(nearest < 0.2);
    TEST_ASSERT_TRUE(nearest > 1e-3);
}

static void test_exactly_along_both_it_stops_where_the_direction_breaks_only(void)
{
    double slowest, nearest;
    cm1e_group_command_t next = line_to(1.0, 1.0, 2.0);
    next.buffer_mode = mcBlendingLow;
    over_the_corner(&next, &slowest, &nearest);
    TEST_ASSERT_TRUE(nearest < 1e-6);
    group_end();
    group_begin(3);
    next = line_to(2.0, 0.0, 2.0); /* straight on */
    next.buffer_mode = mcBlendingLow;
    over_the_corner(&next, &slowest, &nearest);
    TEST_ASSERT_TRUE(slowest > 0.5);
}

/* Figure 12 of Part 1, on a path that goes straight on: the velocity with which the end of the first line is passed. */
static void test_the_buffer_mode_chooses_the_velocity_between_two_lines(void)
{
    static const MC_BUFFER_MODE modes[] = {mcBlendingLow, mcBlendingPrevious, mcBlendingNext, mcBlendingHigh};
    static const double velocities[][2] = {{4.0, 2.0}, {2.0, 4.0}};
    static const double expected[][4] = {{2.0, 4.0, 2.0, 4.0}, {2.0, 2.0, 4.0, 4.0}};
    for (int i = 0; i < 8; i++) {
        const double *v = velocities[i / 4];
        group_end();
        group_begin(3);
        group_line(2.0, 0.0, v[0], mcAborting);
        group_line(4.0, 0.0, v[1], modes[i % 4]);
        double before = 0.0;
        while (group_at(0) < 2.0) {
            before = group_at(0);
            axes_cycles(1);
        }
        TEST_ASSERT_DOUBLE_WITHIN(0.05, expected[i / 4][i % 4], (group_at(0) - before) * 1e3);
    }
}

static void test_aborting_it_leaves_the_path_at_rest_only(void)
{
    const cm1e_command_id_t first = group_line(5.0, 0.0, 2.0, mcAborting);
    axes_cycles(800);
    const double x = group_at(0);
    const cm1e_command_id_t second = group_command(&(cm1e_group_command_t){
        .kind = CM1E_GROUP_LINEAR_RELATIVE, .position = {0.0, 2.0}, .velocity = 1.0});
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, group_state_of(first));
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, group_state_of(second));
    double farthest = 0.0;
    while (group_at(1) == 0.0) {
        axes_cycles(1);
        farthest = fmax(farthest, group_at(0));
    }
    while (group_state_of(second) == CM1E_COMMAND_ACTIVE) {
        axes_cycles(1);
        TEST_ASSERT_TRUE(group_off_line(farthest, 0.0, x, 2.0) < 1e-6);
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, x, group_at(0)); /* it counts from where it began */
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 2.0, group_at(1));
}

static void test_what_is_refused_in_motion_changes_nothing(void)
{
    const cm1e_command_id_t first = group_line(3.0, 1.0, 2.0, mcAborting);
    const cm1e_command_id_t waiting = group_line(3.0, 2.0, 2.0, mcBuffered);
    axes_cycles(400);
    cm1e_group_command_t bad = line_to(NAN, 0.0, 1.0);
    group_refused(&bad, CM1E_ERROR_GROUP_PATH);
    group_told("not a finite number");
    bad = (cm1e_group_command_t){.kind = CM1E_GROUP_CIRCULAR_ABSOLUTE, .auxiliary = {4.0, 1.0}, .position = {4.0, 1.0}};
    group_refused(&bad, CM1E_ERROR_GROUP_PATH);
    group_told("neither coincide");
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, group_state_of(first));
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_BUFFERED, group_state_of(waiting));
    while (group_state_of(first) == CM1E_COMMAND_ACTIVE) {
        axes_cycles(1);
        TEST_ASSERT_TRUE(fmin(group_off_line(0, 0, 3, 1), group_off_line(3, 1, 3, 2)) < 3e-9);
    }
    group_done(waiting);
}

/* ---- refused ----------------------------------------------------------------------------------------------------- */

/* Its text names no number, because none was wrong. */
static void refused_without_a_number(const cm1e_group_command_t *command, cm1e_error_t error)
{
    group_refused(command, error);
    TEST_ASSERT_NULL_MESSAGE(strstr(group_text(), "was given"), group_text());
}

static void test_modes_and_numbers_that_are_none(void)
{
    cm1e_group_command_t c = line_to(1.0, 1.0, -1.0);
    group_refused(&c, CM1E_ERROR_AXIS_VELOCITY_RANGE);
    c.velocity = INFINITY;
    group_refused(&c, CM1E_ERROR_AXIS_VELOCITY_RANGE);
    c = line_to(1.0, 1.0, 1.0);
    c.jerk = NAN;
    group_refused(&c, CM1E_ERROR_AXIS_DYNAMICS_RANGE);
    c = line_to(1.0, 1.0, 1.0);
    c.acceleration = -1.0;
    group_refused(&c, CM1E_ERROR_AXIS_DYNAMICS_RANGE);
    group_refused(&(cm1e_group_command_t){.kind = CM1E_GROUP_STOP, .deceleration = -1.0},
                  CM1E_ERROR_AXIS_DYNAMICS_RANGE);
    c = line_to(1.0, 1.0, 1.0);
    c.buffer_mode = (MC_BUFFER_MODE)6;
    refused_without_a_number(&c, CM1E_ERROR_AXIS_BUFFER_MODE);
    group_told("BufferMode is 0 (mcAborting) ... 5 (mcBlendingHigh).");
    c = (cm1e_group_command_t){.kind = CM1E_GROUP_HALT, .buffer_mode = mcBlendingLow};
    refused_without_a_number(&c, CM1E_ERROR_AXIS_BUFFER_MODE);
    group_told("MC_GroupHalt supports only mcAborting and mcBuffered.");
    c = line_to(1.0, 1.0, 1.0);
    c.coordinates = mcMCS;
    refused_without_a_number(&c, CM1E_ERROR_GROUP_COORD_SYSTEM);
    c = line_to(1.0, 1.0, 1.0);
    c.transition = mcTMConstantVelocity;
    refused_without_a_number(&c, CM1E_ERROR_GROUP_TRANSITION);
    c.transition = (MC_TRANSITION_MODE)-1;
    refused_without_a_number(&c, CM1E_ERROR_GROUP_TRANSITION);
    c.transition = mcTMCornerDistance;
    c.buffer_mode = mcBlendingHigh;
    group_refused(&c, CM1E_ERROR_GROUP_TRANSITION);
    group_told("above 0");
    c.transition_parameter = NAN;
    group_refused(&c, CM1E_ERROR_GROUP_TRANSITION);
    c = (cm1e_group_command_t){.kind = CM1E_GROUP_CIRCULAR_ABSOLUTE, .circ_mode = mcRadius};
    group_refused(&c, CM1E_ERROR_UNSUPPORTED);
    c.circ_mode = mcCenter;
    c.path_choice = (MC_CIRC_PATHCHOICE)2;
    group_refused(&c, CM1E_ERROR_INVALID_ARGUMENT);
    group_must_be(CM1E_GROUP_STANDBY);
    for (int n = 0; n < 3; n++)
        axes_must_be(n, CM1E_AXIS_STANDSTILL);
}

static void test_axes_have_to_stand_and_to_be_powered(void)
{
    axes_move_velocity(1, 1.0);
    const cm1e_group_command_t command = line_to(1.0, 1.0, 1.0);
    group_refused(&command, CM1E_ERROR_GROUP_AXIS);
    group_told("\"axis1\" (IdentInGroup 2) is in ContinuousMotion");
    axes_must_be(0, CM1E_AXIS_STANDSTILL); /* taken, and let go again */
    axes_command(1, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_HALT});
    axes_cycles(500);
    const cm1e_axis_coupling_t in_pos = {
        .master = {{.axis = axes_reference(0), .numerator = 1, .denominator = 1}},
        .master_sync_position = 50.0, .slave_sync_position = 10.0, .master_start_distance = 20.0,
    };
    axes_command(1, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_GEAR_IN_POS, .velocity = 1.0, .coupling = &in_pos});
    group_refused(&command, CM1E_ERROR_GROUP_AXIS);
    group_told("is in Standstill, but waits for a master");
    axes_command(1, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_HALT});
    axes_cycles(10);
    axes_power(2, false);
    axes_cycles(50);
    group_refused(&command, CM1E_ERROR_GROUP_AXIS);
    group_told("is in Disabled");
    axes_power(2, true);
    axes_cycles(50);
    group_done(group_command(&command));
}

static void test_software_limits_and_directions(void)
{
    group_end();
    axes_describe(2);
    axes_config(0)->software_limit_negative = -1.0;
    axes_config(0)->software_limit_positive = 2.0;
    axes_make();
    axes_enable_all();
    group_form();
    cm1e_group_enable(group);
    cm1e_group_command_t c = line_to(2.1, 0.0, 1.0);
    group_refused(&c, CM1E_ERROR_GROUP_PATH);
    group_told("would reach 2.1 u; its software limits are -1 ... 2 u");
    c = (cm1e_group_command_t){.kind = CM1E_GROUP_CIRCULAR_ABSOLUTE, .auxiliary = {2.5, 0.5}, .position = {0.0, 1.0}};
    group_refused(&c, CM1E_ERROR_GROUP_PATH); /* it bulges over it */
    c = line_to(2.0, 1.0, 0.0);
    group_done(group_command(&c));
    axes_bench.negative[0] = false;
    axes_cycles(2);
    c = line_to(1.0, 1.0, 1.0);
    group_refused(&c, CM1E_ERROR_AXIS_DIRECTION_DISABLED);
    group_told("disabled by MC_Power: its EnableNegative is FALSE. Axis \"axis0\"");
    c = line_to(2.0, 0.0, 1.0);
    group_done(group_command(&c));
}

/* ---- on the way -------------------------------------------------------------------------------------------------- */

static void test_single_axis_commands(void)
{
    const cm1e_axis_command_t velocity = {.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 1.0};
    group_line(3.0, 1.0, 2.0, mcAborting);
    axes_cycles(10);
    for (int n = 0; n < 3; n++) {
        axes_refused(n, &velocity, CM1E_ERROR_AXIS_IN_GROUP);
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_IN_GROUP, cm1e_axis_set_position(axes_axis(n), 1.0, false));
    }
    axes_cycles(3000);
    group_must_be(CM1E_GROUP_STANDBY);
    const cm1e_command_id_t id = axes_move_to(1, 2.5, 1.0); /* the group stands: they may */
    axes_wait(1, id, 5000);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_set_position(axes_axis(1), 0.0, false));
    group_done(group_line(0.0, 1.0, 2.0, mcAborting)); /* from there, in the new coordinates */
    TEST_ASSERT_EQUAL_DOUBLE(1.0, group_at(1));
}

static void test_override(void)
{
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_OVERRIDE, cm1e_group_set_override(group, 1.1));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_OVERRIDE, cm1e_group_set_override(group, NAN));
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_set_override(group, 0.5));
    const cm1e_command_id_t id = group_line(3.0, 4.0, 2.0, mcAborting);
    axes_cycles(700);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 1.0, group_info().path_velocity);
    cm1e_group_set_override(group, 0.0);
    axes_cycles(700);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, group_info().path_velocity);
    group_must_be(CM1E_GROUP_MOVING);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, group_state_of(id));
    cm1e_group_set_override(group, 1.0);
    axes_cycles(500);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 2.0, group_info().path_velocity);
    TEST_ASSERT_TRUE(group_off_line(0, 0, 3, 4) < 5e-9);
    group_done(id);
}

static void test_what_it_shows(void)
{
    double position[CM1E_GROUP_AXES], velocity[CM1E_GROUP_AXES], path;
    group_line(3.0, 4.0, 2.0, mcAborting);
    axes_cycles(1000);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_values(group, mcSetValue, position, velocity, &path));
    TEST_ASSERT_EQUAL_DOUBLE(group_at(1), position[1]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 1.6, velocity[1]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 2.0, path);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, position[5]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 5.0 - hypot(group_at(0), group_at(1)), group_info().path_left);
    TEST_ASSERT_EQUAL_INT(1, group_info().commands);
    for (int i = 0; i < CM1E_GROUP_AXES; i++)
        TEST_ASSERT_EQUAL_UINT32(i < 3 ? axes_reference(i).Handle : 0, group_info().axis[i].Handle);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_values(group, mcActualValue, position, velocity, &path));
    TEST_ASSERT_DOUBLE_WITHIN(0.01, group_at(1), position[1]);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_UNSUPPORTED,
                          cm1e_group_values(group, mcCommandedValue, position, velocity, &path));
    axes_axis(1)->drive.feedback.online = false;
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_OFFLINE, cm1e_group_values(group, mcActualValue, position, velocity, &path));
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_values(group, mcSetValue, position, velocity, &path));
    axes_axis(1)->drive.feedback.online = true;
    axes_cycles(5000);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_values(group, mcSetValue, position, velocity, &path));
    TEST_ASSERT_EQUAL_DOUBLE(4.0, position[1]);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, path);
}

/* The path waits for an axis that is not on it, whatever the override, and goes on as fast as that says then. */
static void test_an_override_acts_when_all_axes_are_on_the_path(void)
{
    static const double factors[] = {0.5, 1.0, 0.25};
    const cm1e_command_id_t id = group_line(6.0, 8.0, 2.0, mcAborting);
    axes_cycles(800);
    cm1e_group_stray(group, 0);
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_set_override(group, factors[i]));
        TEST_ASSERT_EQUAL_DOUBLE(0.0, group->path.override);
    }
    int waited = 0;
    for (; group->apart.off != 0 && waited < 2000; waited++) {
        axes_cycles(1);
        TEST_ASSERT_TRUE(group->apart.off == 0 || group->path.override == 0.0);
    }
    TEST_ASSERT_TRUE(waited > 0 && waited < 2000);
    axes_cycles(1000);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.5, group_info().path_velocity);
    group_done(id);
    TEST_ASSERT_EQUAL_DOUBLE(8.0, group_at(1));
}

/* Frames that were never sent: the motors stand at their last targets, and the path goes on from there. */
static void test_after_a_pause_it_goes_on_along_the_path_from_rest(void)
{
    for (int cycle = 1; cycle < 1600; cycle += 97) {
        group_end();
        group_begin(3);
        const cm1e_command_id_t id = group_line(2.0, 1.0, 2.0, mcAborting);
        axes_cycles(cycle);
        axes_inputs();
        for (int n = 0; n < 3; n++) {
            cm1e_axis_after_pause(axes_axis(n), 5000000);
            axes_bench.witness[n].ours = false; /* the velocity is gone, and so it is meant */
        }
        TEST_ASSERT_EQUAL_UINT(0, group->apart.off); /* none has left the path */
        axes_outputs();
        while (group_state_of(id) == CM1E_COMMAND_ACTIVE) {
            axes_cycles(1);
            TEST_ASSERT_TRUE(group_off_line(0, 0, 2, 1) < 3e-9);
        }
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, group_state_of(id));
    }
}

/* After silence the path begins anew for all its axes in the same cycle, also where one that stands goes first. */
static void test_after_silence_the_path_begins_anew_at_once_for_all(void)
{
    static const int orders[][2] = {{0, 1}, {1, 0}};
    for (size_t i = 0; i < sizeof orders / sizeof orders[0]; i++)
        for (int silence = 3; silence <= 8; silence++) {
            group_end();
            group_begin(2);
            memcpy(axes_bench.order, orders[i], sizeof orders[i]);
            const cm1e_command_id_t id = group_line(2.0, 0.0, 2.0, mcAborting);
            axes_cycles(700);
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, 2.0, axes_axis(0)->setpoint.velocity);
            axes_bench.received = CM1E_ERROR_BUS_LOST;
            axes_cycles(silence);
            const double stood = group_at(0);
            axes_bench.received = CM1E_OK;
            axes_cycles(1);
            TEST_ASSERT_DOUBLE_WITHIN(0.01, 0.0, axes_axis(0)->setpoint.velocity);
            TEST_ASSERT_DOUBLE_WITHIN(1e-5, stood, group_at(0));
            group_done(id);
        }
}

/* A motor at its maximum velocity cannot catch up while it goes on as fast. So the whole path is slower, and stays
 * straight, whichever axis it is and whichever goes first. */
static void test_after_a_short_silence_the_path_is_as_slow_as_its_slowest_motor(void)
{
    for (int fast = 0; fast < 2; fast++)
        for (int first = 0; first < 2; first++) {
            group_end();
            group_begin(2);
            axes_bench.order[0] = first;
            axes_bench.order[1] = 1 - first;
            const double x = fast == 0 ? 40.0 : 10.0, y = 50.0 - x, most = 49.99;
            const cm1e_command_id_t id = group_line(x, y, most / 40.0 * hypot(x, y), mcAborting);
            while (axes_info(fast).set_velocity < most - 1e-6)
                axes_cycles(1);
            axes_bench.received = CM1E_ERROR_BUS_LOST;
            axes_cycles(2);
            axes_bench.received = CM1E_OK;
            axes_cycles(1);
            TEST_ASSERT_TRUE(axes_info(fast).set_velocity < 0.9 * most);
            TEST_ASSERT_TRUE(axes_info(fast).set_velocity > 0.1 * most);
            for (int n = 0; n < 300; n++) {
                TEST_ASSERT_TRUE(group_off_line(0, 0, x, y) < 1e-7);
                axes_cycles(1);
            }
            group_done(id);
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, x, group_at(0));
        }
}

/* The order in which the scheduler lets the axes go is of no matter. */
static void test_in_every_order_of_the_axes(void)
{
    static const int orders[][3] = {{0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    for (size_t i = 0; i < sizeof orders / sizeof orders[0]; i++) {
        group_end();
        group_begin(3);
        memcpy(axes_bench.order, orders[i], sizeof orders[i]);
        cm1e_group_command_t c = line_to(2.0, 1.0, 2.0);
        c.position[2] = -1.0;
        const cm1e_command_id_t id = group_command(&c);
        while (group_state_of(id) == CM1E_COMMAND_ACTIVE) {
            axes_cycles(1);
            TEST_ASSERT_TRUE(group_off_line(0, 0, 2, 1) < 3e-9);
            TEST_ASSERT_DOUBLE_WITHIN(3e-9, -group_at(1), group_at(2));
        }
        group_done(id);
    }
}

/* ---- random paths ------------------------------------------------------------------------------------------------ */

static uint64_t chance_state;

static double chance(double from, double to)
{
    chance_state = chance_state * 6364136223846793005u + 1442695040888963407u;
    return from + (to - from) * (double)(chance_state >> 11) * 0x1p-53;
}

static cm1e_group_command_t random_command(void)
{
    cm1e_group_command_t c = {
        .kind = (cm1e_group_kind_t)chance(0.0, 4.999),
        .position = {chance(-2, 2), chance(-2, 2), chance(-2, 2)},
        .auxiliary = {chance(-2, 2), chance(-2, 2), chance(-2, 2)},
        .velocity = chance(0, 1) < 0.2 ? 0.0 : chance(1.0, 6.0),
        .acceleration = chance(0, 1) < 0.5 ? 0.0 : chance(1, 80),
        .deceleration = chance(0, 1) < 0.5 ? 0.0 : chance(1, 80),
        .jerk = chance(0, 1) < 0.5 ? 0.0 : chance(50, 2000),
        .buffer_mode = (MC_BUFFER_MODE)chance(0.0, 5.999),
        .transition_parameter = chance(0.001, 0.3),
    };
    if (chance(0, 1) < 0.08)
        c.kind = CM1E_GROUP_INTERRUPT;
    static const MC_TRANSITION_MODE modes[] = {mcTMNone, mcTMCornerDistance, mcTMMaxCornerDeviation};
    c.transition = modes[(int)chance(0.0, 2.999)];
    if (chance(0, 1) < 0.02) /* what has to be refused, whatever runs */
        c.position[1] = 1e18;
    if (c.kind == CM1E_GROUP_HALT)
        c.buffer_mode = chance(0, 1) < 0.5 ? mcAborting : mcBuffered;
    return c;
}

static void test_random_paths_keep_every_limit(void)
{
    char run[64];
    const char *asked = getenv("CM1E_TEST_SEED");
    const uint64_t seed = asked ? strtoull(asked, NULL, 0) : 20260101;
    chance_state = seed;
    snprintf(run, sizeof run, "CM1E_TEST_SEED=%llu", (unsigned long long)seed);
    axes_bench.run = run;
    int taken = 0, refused = 0;
    for (int i = 0; i < 400; i++) {
        const cm1e_group_command_t c = random_command();
        cm1e_command_id_t id;
        if (cm1e_group_start(group, &c, &id) == CM1E_OK)
            taken++;
        else
            refused++;
        if (chance(0, 1) < 0.05)
            cm1e_group_set_override(group, chance(0, 1) < 0.2 ? 0.0 : chance(0.1, 1));
        if (chance(0, 1) < 0.15)
            (void)cm1e_group_continue(group);
        axes_cycles((int)chance(1.0, 400.0));
        AXES_MUST(!group_info().interrupted || group_info().state == CM1E_GROUP_MOVING, "%s", group_text());
        AXES_MUST(group_info().state == CM1E_GROUP_MOVING || group_info().state == CM1E_GROUP_STANDBY, "%s",
                  group_text());
    }
    cm1e_group_set_override(group, 1.0);
    (void)cm1e_group_continue(group);
    for (int i = 0; i < 1000000 && group_info().state == CM1E_GROUP_MOVING; i++)
        axes_cycles(1);
    group_must_be(CM1E_GROUP_STANDBY);
    TEST_ASSERT_TRUE(taken > 50); /* while the override is 0 the queue fills */
    TEST_ASSERT_TRUE(asked || refused > 0);
}

/* Of the tests above: else the witness saw nothing of it. */
static void test_many_set_points_were_decided_ahead(void)
{
    printf("%llu of %llu cycles of axes of a group were decided ahead\n", cycles_led_ordinary, cycles_led);
    TEST_ASSERT_TRUE(cycles_led_ordinary > cycles_led / 10);
    TEST_ASSERT_TRUE(cycles_led_short > cycles_led / led_compared_every / 20);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_line_is_straight_and_ends_where_it_should);
    RUN_TEST(test_without_dynamics_it_goes_as_the_axes_allow);
    RUN_TEST(test_arcs_by_border_and_by_centre);
    RUN_TEST(test_further_axes_go_along);
    RUN_TEST(test_one_axis_is_a_group_too);
    RUN_TEST(test_modulo_and_inverted_axes);
    RUN_TEST(test_a_smaller_deceleration_of_one_axis_is_kept);
    RUN_TEST(test_buffered_lines_come_to_rest_between);
    RUN_TEST(test_transitions_do_not_stop_and_keep_their_tolerance);
    RUN_TEST(test_exactly_along_both_it_stops_where_the_direction_breaks_only);
    RUN_TEST(test_the_buffer_mode_chooses_the_velocity_between_two_lines);
    RUN_TEST(test_aborting_it_leaves_the_path_at_rest_only);
    RUN_TEST(test_what_is_refused_in_motion_changes_nothing);
    RUN_TEST(test_modes_and_numbers_that_are_none);
    RUN_TEST(test_axes_have_to_stand_and_to_be_powered);
    RUN_TEST(test_software_limits_and_directions);
    RUN_TEST(test_single_axis_commands);
    RUN_TEST(test_override);
    RUN_TEST(test_what_it_shows);
    RUN_TEST(test_an_override_acts_when_all_axes_are_on_the_path);
    RUN_TEST(test_after_a_pause_it_goes_on_along_the_path_from_rest);
    RUN_TEST(test_after_silence_the_path_begins_anew_at_once_for_all);
    RUN_TEST(test_after_a_short_silence_the_path_is_as_slow_as_its_slowest_motor);
    RUN_TEST(test_in_every_order_of_the_axes);
    RUN_TEST(test_random_paths_keep_every_limit);
    RUN_TEST(test_many_set_points_were_decided_ahead);
    return UNITY_END();
}
