/* MC_GroupInterrupt and MC_GroupContinue (Part 4, 9.27 and 9.28): at every moment of a path with blended and exact
 * corners, and together with everything else that a group does. The witness of axes_bench.h looks at every limit. */
#include <math.h>
#include <stdlib.h>

#include "unity.h"

#include "../support/effort.h"
#include "../support/group_bench.h"

void setUp(void) { group_begin(2); }
void tearDown(void) { group_end(); }

static void again(void)
{
    group_end();
    group_begin(2);
}

static cm1e_command_id_t interrupt(double deceleration)
{
    return group_command(&(cm1e_group_command_t){.kind = CM1E_GROUP_INTERRUPT, .deceleration = deceleration});
}

static void go_on(void) { TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_continue(group)); }

static void nothing_goes_on(cm1e_error_t why)
{
    TEST_ASSERT_EQUAL_INT(why, cm1e_group_continue(group));
    group_told("Nothing is interrupted that could go on");
}

static void must_rest(int cycles)
{
    const double x = group_at(0), y = group_at(1);
    for (int i = 0; i < cycles; i++) {
        axes_cycles(1);
        AXES_MUST(group_at(0) == x && group_at(1) == y, "after %d cycles of rest it moves by (%.3g, %.3g)", i, group_at(0) - x, group_at(1) - y);
    }
}

static void interrupted_at_rest(void)
{
    group_done(interrupt(0.0));
    TEST_ASSERT_TRUE(group_info().interrupted);
    group_must_be(CM1E_GROUP_MOVING);
    must_rest(20);
}

/* ---- at every moment of a path ----------------------------------------------------------------------------------- */

enum { PARTS = 5, MOMENTS = 8000 };

static cm1e_command_id_t parts[PARTS];

/* A line, a blended corner, an arc that goes on from it exactly, a line behind a stop, a blended corner, a line. */
static void start_path(void)
{
    cm1e_group_command_t c = {.kind = CM1E_GROUP_LINEAR_ABSOLUTE, .position = {1.0, 0.0}, .velocity = 5.0};
    parts[0] = group_command(&c);
    c = (cm1e_group_command_t){.kind = CM1E_GROUP_LINEAR_ABSOLUTE, .position = {1.0, 1.0}, .velocity = 3.0,
                               .buffer_mode = mcBlendingHigh, .transition = mcTMCornerDistance,
                               .transition_parameter = 0.2};
    parts[1] = group_command(&c);
    c = (cm1e_group_command_t){.kind = CM1E_GROUP_CIRCULAR_ABSOLUTE, .circ_mode = mcCenter, .position = {2.0, 2.0},
                               .auxiliary = {2.0, 1.0}, .velocity = 4.0, .buffer_mode = mcBlendingLow};
    parts[2] = group_command(&c);
    c = (cm1e_group_command_t){.kind = CM1E_GROUP_LINEAR_ABSOLUTE, .position = {2.0, 1.0}, .velocity = 5.0,
                               .acceleration = 30.0, .deceleration = 30.0, .buffer_mode = mcBuffered};
    parts[3] = group_command(&c);
    c = (cm1e_group_command_t){.kind = CM1E_GROUP_LINEAR_RELATIVE, .position = {-2.0, -1.0}, .velocity = 5.0,
                               .buffer_mode = mcBlendingNext, .transition = mcTMMaxCornerDeviation,
                               .transition_parameter = 0.05};
    parts[4] = group_command(&c);
}

/* Where the path goes: its set-points without an interruption. */
static struct {
    int moments, at;
    double x[MOMENTS], y[MOMENTS];
} way;

static void learn_the_way(void)
{
    again();
    start_path();
    for (way.moments = 0; group_info().state == CM1E_GROUP_MOVING; way.moments++) {
        TEST_ASSERT_TRUE(way.moments < MOMENTS);
        axes_cycles(1);
        way.x[way.moments] = group_at(0);
        way.y[way.moments] = group_at(1);
    }
}

static double off_chord(int i)
{
    const double dx = way.x[i + 1] - way.x[i], dy = way.y[i + 1] - way.y[i], square = dx * dx + dy * dy;
    const double x = group_at(0) - way.x[i], y = group_at(1) - way.y[i];
    const double part = square > 0.0 ? fmin(fmax((x * dx + y * dy) / square, 0.0), 1.0) : 0.0;
    return hypot(x - part * dx, y - part * dy);
}

/* It is on the way, and not before where it was. A chord is off the way by at most a / 8 in a cycle. */
static void must_be_on_the_way(void)
{
    static const double most = 100.0 * 1e-6 / 8.0 * 1.5;
    int nearest = way.at;
    for (int i = way.at; i < way.moments - 1 && i < way.at + 50; i++)
        if (off_chord(i) < off_chord(nearest))
            nearest = i;
    AXES_MUST(way.moments == 0 || off_chord(nearest) < most, "%.3g u off the way at (%.6f, %.6f)", off_chord(nearest),
              group_at(0), group_at(1));
    way.at = nearest;
}

static void cycle_on_the_way(void)
{
    axes_cycles(1);
    must_be_on_the_way();
}

static cm1e_command_state_t before[PARTS];

static void remember_states(void)
{
    for (int i = 0; i < PARTS; i++)
        before[i] = group_state_of(parts[i]);
}

/* What was Done stays so; all others wait. */
static void all_wait(void)
{
    for (int i = 0; i < PARTS; i++)
        TEST_ASSERT_EQUAL_INT(before[i] == CM1E_COMMAND_DONE ? CM1E_COMMAND_DONE : CM1E_COMMAND_BUFFERED,
                              group_state_of(parts[i]));
}

static void interrupt_on_the_way(double deceleration)
{
    remember_states();
    const cm1e_command_id_t id = interrupt(deceleration);
    int cycles = 0;
    for (; group_state_of(id) == CM1E_COMMAND_ACTIVE && cycles < 8000; cycles++) {
        all_wait();
        cycle_on_the_way();
    }
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, group_state_of(id));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, group->sample.path_velocity);
    group_must_be(CM1E_GROUP_MOVING);
    must_rest(30);
    all_wait();
}

/* The first that is not Done is Active at once. */
static void go_on_at_once(void)
{
    go_on();
    bool first = true;
    for (int i = 0; i < PARTS; i++)
        if (before[i] != CM1E_COMMAND_DONE) {
            TEST_ASSERT_EQUAL_INT(first ? CM1E_COMMAND_ACTIVE : CM1E_COMMAND_BUFFERED, group_state_of(parts[i]));
            first = false;
        }
}

static void until_the_end_of_the_way(void)
{
    for (int i = 0; group_info().state == CM1E_GROUP_MOVING && i < MOMENTS; i++)
        cycle_on_the_way();
    group_must_be(CM1E_GROUP_STANDBY);
    for (int i = 0; i < PARTS; i++)
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, group_state_of(parts[i]));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, group_at(0));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, group_at(1));
}

/* So many cycles of the path, from its beginning. */
static void go_along_the_way(const char *run, int cycles)
{
    again();
    axes_bench.run = run;
    start_path();
    way.at = 0;
    for (int i = 0; i < cycles; i++)
        cycle_on_the_way();
}

static void test_at_every_moment_it_rests_on_the_path_and_goes_on(void)
{
    static const double decelerations[] = {0.0, 40.0, 5.0};
    char run[80];
    learn_the_way();
    const int stride = sweep_stride(3, 37), moments = way.moments;
    for (int d = 0; d < 3; d++)
        for (int at = sweep_first(d, stride); at < moments - 1; at += stride) {
            snprintf(run, sizeof run, "interrupted after %d of %d cycles, deceleration %g", at, moments,
                     decelerations[d]);
            go_along_the_way(run, at);
            interrupt_on_the_way(decelerations[d]);
            go_on_at_once();
            until_the_end_of_the_way();
        }
}

static void test_again_and_again_on_one_path(void)
{
    char run[80];
    learn_the_way();
    for (int every = 7; every < 200; every = every * 2 + 3) {
        snprintf(run, sizeof run, "interrupted every %d cycles", every);
        again();
        axes_bench.run = run;
        start_path();
        way.at = 0;
        for (int i = 0; i < 50 && group_info().state == CM1E_GROUP_MOVING; i++) {
            interrupt_on_the_way(i % 2 ? 0.0 : 30.0);
            go_on_at_once();
            for (int k = 0; k < every && group_info().state == CM1E_GROUP_MOVING; k++)
                cycle_on_the_way();
        }
        until_the_end_of_the_way();
    }
}

/* MC_GroupContinue before it rests: it goes on from its velocity. */
static void test_it_goes_on_while_it_still_brakes(void)
{
    char run[80];
    learn_the_way();
    const int stride = sweep_stride(5, 61), moments = way.moments;
    for (int braked = 0; braked < 60; braked += 19)
        for (int at = sweep_first(braked, stride); at < moments - 1; at += stride) {
            snprintf(run, sizeof run, "interrupted after %d cycles for %d", at, braked);
            go_along_the_way(run, at);
            remember_states();
            const cm1e_command_id_t id = interrupt(10.0);
            for (int i = 0; i < braked; i++)
                cycle_on_the_way();
            const bool rests = group_state_of(id) == CM1E_COMMAND_DONE;
            go_on_at_once();
            TEST_ASSERT_EQUAL_INT(rests ? CM1E_COMMAND_DONE : CM1E_COMMAND_ABORTED, group_state_of(id));
            until_the_end_of_the_way();
        }
}

/* ---- with everything else ---------------------------------------------------------------------------------------- */

static void test_what_is_not_interrupted_does_not_go_on(void)
{
    nothing_goes_on(CM1E_ERROR_GROUP_STATE);
    group_refused(&(cm1e_group_command_t){.kind = CM1E_GROUP_INTERRUPT}, CM1E_ERROR_GROUP_STATE);
    group_told("It does not move: there is nothing to interrupt");
    const cm1e_command_id_t line = group_line(1.0, 1.0, 5.0, mcAborting);
    axes_cycles(100);
    nothing_goes_on(CM1E_ERROR_GROUP_STATE);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, group_state_of(line));
    interrupted_at_rest();
    go_on();
    TEST_ASSERT_EQUAL_STRING("", group_text());
    TEST_ASSERT_FALSE(group_info().interrupted);
    nothing_goes_on(CM1E_ERROR_GROUP_STATE);
    group_done(line);
    axes_cycles(1);
    nothing_goes_on(CM1E_ERROR_GROUP_STATE);
    group_refused(&(cm1e_group_command_t){.kind = CM1E_GROUP_INTERRUPT, .deceleration = -1.0},
                  CM1E_ERROR_GROUP_STATE);
}

static void test_numbers_that_are_none_do_not_interrupt(void)
{
    const cm1e_command_id_t line = group_line(1.0, 1.0, 5.0, mcAborting);
    axes_cycles(100);
    group_refused(&(cm1e_group_command_t){.kind = CM1E_GROUP_INTERRUPT, .deceleration = -1.0},
                  CM1E_ERROR_AXIS_DYNAMICS_RANGE);
    group_refused(&(cm1e_group_command_t){.kind = CM1E_GROUP_INTERRUPT, .jerk = NAN}, CM1E_ERROR_AXIS_DYNAMICS_RANGE);
    TEST_ASSERT_FALSE(group_info().interrupted);
    group_done(line);
}

/* Before the first step, and in the cycle in which it goes on. */
static void test_interrupted_before_it_moves(void)
{
    const cm1e_command_id_t line = group_line(1.0, 1.0, 5.0, mcAborting);
    interrupted_at_rest();
    TEST_ASSERT_EQUAL_DOUBLE(0.0, group_at(0));
    go_on();
    const cm1e_command_id_t id = interrupt(0.0);
    must_rest(5);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, group_state_of(id));
    go_on();
    group_done(line);
}

static void test_interrupted_again(void)
{
    const cm1e_command_id_t line = group_line(5.0, 5.0, 5.0, mcAborting);
    axes_cycles(300);
    const cm1e_command_id_t first = interrupt(3.0);
    axes_cycles(20);
    const cm1e_command_id_t second = interrupt(0.0);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, group_state_of(first));
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, group_state_of(second));
    group_done(second);
    interrupted_at_rest();
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_BUFFERED, group_state_of(line));
    go_on();
    group_done(line);
}

/* The group keeps all of it until it goes on, and the last command is Done only then. */
static void test_braking_that_ends_where_the_path_ends_keeps_the_last_command(void)
{
    const cm1e_command_id_t line = group_line(1.0, 0.0, 5.0, mcAborting);
    while (group_at(0) < 0.99)
        axes_cycles(1);
    const cm1e_command_id_t id = interrupt(0.1);
    group_done(id);
    TEST_ASSERT_EQUAL_DOUBLE(1.0, group_at(0));
    axes_cycles(100);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_BUFFERED, group_state_of(line));
    group_must_be(CM1E_GROUP_MOVING);
    const cm1e_command_id_t next = group_line(0.0, 0.0, 5.0, mcBlendingHigh), other = group_line(0.0, 1.0, 5.0, mcBuffered);
    must_rest(100);
    go_on();
    axes_cycles(2);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, group_state_of(line));
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, group_state_of(next));
    group_done(other);
    TEST_ASSERT_EQUAL_DOUBLE(1.0, group_at(1));
}

static void test_commands_wait_behind_it(void)
{
    for (int braking = 0; braking < 2; braking++)
        for (int mode = mcBuffered; mode <= mcBlendingHigh; mode++) {
            again();
            const cm1e_command_id_t line = group_line(2.0, 0.0, 5.0, mcAborting);
            axes_cycles(200);
            const cm1e_command_id_t id = interrupt(braking ? 5.0 : 0.0);
            if (!braking)
                group_done(id);
            const cm1e_command_id_t next = group_command(&(cm1e_group_command_t){
                .kind = CM1E_GROUP_LINEAR_RELATIVE, .position = {0.0, 1.0}, .velocity = 5.0,
                .buffer_mode = (MC_BUFFER_MODE)mode, .transition = mcTMCornerDistance, .transition_parameter = 0.2});
            const cm1e_command_id_t halt =
                group_command(&(cm1e_group_command_t){.kind = CM1E_GROUP_HALT, .buffer_mode = mcBuffered});
            group_done(id);
            must_rest(50);
            TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_BUFFERED, group_state_of(next));
            go_on();
            TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, group_state_of(line));
            group_done(halt);
            TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, group_state_of(next));
            TEST_ASSERT_EQUAL_DOUBLE(2.0, group_at(0));
            TEST_ASSERT_EQUAL_DOUBLE(1.0, group_at(1));
        }
}

static void test_a_halt_that_is_interrupted_is_done_when_it_goes_on(void)
{
    for (int follows = 0; follows < 2; follows++)
        for (int braked = 0; braked < 2; braked++) {
            again();
            (void)group_line(5.0, 0.0, 5.0, mcAborting);
            axes_cycles(300);
            const cm1e_command_id_t halt = group_command(&(cm1e_group_command_t){.kind = CM1E_GROUP_HALT,
                                                                                 .deceleration = 20.0});
            axes_cycles(10);
            const cm1e_command_id_t next = follows ? group_line(0.0, 0.0, 5.0, mcBuffered) : 0;
            const cm1e_command_id_t id = interrupt(0.0);
            if (braked) {
                group_done(id);
                must_rest(50);
            }
            TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_BUFFERED, group_state_of(halt));
            go_on();
            TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, group_state_of(halt));
            group_done(halt);
            if (follows)
                group_done(next);
            axes_cycles(2);
            group_must_be(CM1E_GROUP_STANDBY);
        }
}

static void test_the_braking_of_a_new_command_is_interrupted(void)
{
    for (int braked = 1; braked < 200; braked += 7) {
        again();
        (void)group_line(5.0, 0.0, 5.0, mcAborting);
        axes_cycles(300);
        const cm1e_command_id_t next = group_line(0.0, 2.0, 5.0, mcAborting);
        axes_cycles(braked);
        interrupted_at_rest();
        go_on();
        group_done(next);
        TEST_ASSERT_EQUAL_DOUBLE(2.0, group_at(1));
    }
}

static void test_the_override_acts_when_it_goes_on(void)
{
    static const double overrides[] = {0.0, 0.3, 1.0};
    for (int early = 0; early < 2; early++)
        for (size_t from = 0; from < 3; from++)
            for (size_t to = 0; to < 3; to++) {
                again();
                const cm1e_command_id_t line = group_line(5.0, 0.0, 5.0, mcAborting);
                axes_cycles(200);
                cm1e_group_set_override(group, overrides[from]);
                axes_cycles(20);
                const cm1e_command_id_t id = interrupt(0.0);
                axes_cycles(early ? 3 : 300);
                cm1e_group_set_override(group, overrides[to]);
                group_done(id);
                must_rest(30);
                go_on();
                axes_cycles(300);
                TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, group_state_of(line));
                if (overrides[to] > 0.0)
                    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 5.0 * overrides[to], group->sample.path_velocity);
                else
                    must_rest(30);
                cm1e_group_set_override(group, 1.0);
                group_done(line);
            }
}

/* A corner comes too soon for it to rest before: it is passed, and the stop begins behind it. */
static double rest_behind_a_corner(bool override)
{
    group_end();
    group_begin(3);
    group_command(&(cm1e_group_command_t){.kind = CM1E_GROUP_LINEAR_ABSOLUTE, .position = {-1.4, 0.5, 0.9},
                                          .acceleration = 65.0, .deceleration = 33.0});
    axes_cycles(90);
    group_command(&(cm1e_group_command_t){.kind = CM1E_GROUP_LINEAR_RELATIVE, .position = {-1.5, -0.15, -1.2},
                                          .velocity = 1.0, .buffer_mode = mcBlendingPrevious,
                                          .transition = mcTMMaxCornerDeviation, .transition_parameter = 0.02});
    axes_cycles(45);
    const cm1e_command_id_t id = interrupt(0.25);
    TEST_ASSERT_FALSE(group->path.stopping);
    if (override)
        cm1e_group_set_override(group, 0.0);
    for (int i = 0; i < 8000 && group_state_of(id) == CM1E_COMMAND_ACTIVE; i++)
        axes_cycles(1);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, group_state_of(id));
    return group_at(0);
}

static void test_before_it_brakes_an_override_of_0_leaves_its_deceleration(void)
{
    const double rest = rest_behind_a_corner(false);
    TEST_ASSERT_TRUE(rest < -1.5);
    TEST_ASSERT_EQUAL_DOUBLE(rest, rest_behind_a_corner(true));
}

/* MC_GroupContinue takes the gentle deceleration back: VelFactor 0 brakes as it does without an interruption. */
static void test_gone_on_with_an_override_of_0_it_brakes_as_that_does(void)
{
    for (int braked = 0; braked < 60; braked += 20) {
        again();
        const cm1e_command_id_t line = group_line(50.0, 0.0, 5.0, mcAborting);
        axes_cycles(500);
        interrupt(0.2);
        axes_cycles(braked);
        cm1e_group_set_override(group, 0.0);
        go_on();
        axes_cycles(200);
        must_rest(30);
        cm1e_group_set_override(group, 1.0);
        axes_cycles(300);
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, 5.0, group->sample.path_velocity);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, group_state_of(line));
    }
}

/* ---- what ends it ------------------------------------------------------------------------------------------------ */

typedef enum ending { ABORTING, HALTED, STOPPED, DISABLED, UNGROUPED, BY_FAULT, BY_POWER, BY_AXIS, ENDINGS } ending_t;

static void end_by(ending_t ending)
{
    switch (ending) {
    case ABORTING: group_line(0.5, -1.0, 5.0, mcAborting); break;
    case HALTED: group_command(&(cm1e_group_command_t){.kind = CM1E_GROUP_HALT}); break;
    case STOPPED: cm1e_group_hold_stop(group, group_stop(), false); break;
    case DISABLED: TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_disable(group)); break;
    case UNGROUPED: TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_ungroup(group)); break;
    case BY_FAULT: fake_bus_fault(axes_motor(1), 0x2310); break;
    case BY_POWER: axes_power(1, false); break;
    default: axes_command(1, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_STOP}); break;
    }
}

static const cm1e_group_state_t states_then[ENDINGS] = {
    [ABORTING] = CM1E_GROUP_MOVING,     [HALTED] = CM1E_GROUP_STANDBY,     [STOPPED] = CM1E_GROUP_STANDBY,
    [DISABLED] = CM1E_GROUP_DISABLED,   [UNGROUPED] = CM1E_GROUP_DISABLED, [BY_FAULT] = CM1E_GROUP_ERROR_STOP,
    [BY_POWER] = CM1E_GROUP_ERROR_STOP,    [BY_AXIS] = CM1E_GROUP_ERROR_STOP,
};

static const cm1e_error_t refusals_then[CM1E_GROUP_STATE_COUNT] = {
    [CM1E_GROUP_DISABLED] = CM1E_ERROR_GROUP_DISABLED,
    [CM1E_GROUP_STANDBY] = CM1E_ERROR_GROUP_STATE,
    [CM1E_GROUP_MOVING] = CM1E_ERROR_GROUP_STATE,
    [CM1E_GROUP_ERROR_STOP] = CM1E_ERROR_GROUP_ERROR_STOP,
};

/* Then the path is forgotten: nothing moves by MC_GroupContinue, nor by itself after a reset. */
static void test_what_ends_the_commands_ends_the_interruption(void)
{
    char run[80];
    for (int ending = 0; ending < ENDINGS; ending++)
        for (int braked = 0; braked < 200; braked += 40) {
            snprintf(run, sizeof run, "ending %d, after %d cycles", ending, braked);
            again();
            axes_bench.run = run;
            const cm1e_command_id_t line = group_line(3.0, 3.0, 5.0, mcAborting);
            const cm1e_command_id_t next = group_line(0.0, 3.0, 5.0, mcBuffered);
            axes_cycles(300);
            const cm1e_command_id_t id = interrupt(20.0);
            axes_cycles(braked);
            const bool rests = group_state_of(id) == CM1E_COMMAND_DONE, fails = ending >= BY_FAULT;
            end_by((ending_t)ending);
            axes_cycles(fails ? 5 : 1);
            const cm1e_command_state_t ended = fails ? CM1E_COMMAND_ERROR : CM1E_COMMAND_ABORTED;
            TEST_ASSERT_EQUAL_INT(ended, group_state_of(line));
            TEST_ASSERT_EQUAL_INT(ended, group_state_of(next));
            TEST_ASSERT_EQUAL_INT(rests ? CM1E_COMMAND_DONE : ended, group_state_of(id));
            TEST_ASSERT_FALSE(group_info().interrupted);
            axes_cycles(ending == ABORTING ? 20 : 400);
            group_must_be(states_then[ending]);
            TEST_ASSERT_EQUAL_INT(refusals_then[states_then[ending]], cm1e_group_continue(group));
            if (ending == ABORTING) {
                axes_cycles(3000);
                TEST_ASSERT_EQUAL_DOUBLE(-1.0, group_at(1));
            }
            cm1e_group_reset(group);
            must_rest(300);
        }
}

static void test_its_axes_are_led_as_long_as_it_lasts(void)
{
    const cm1e_command_id_t line = group_line(5.0, 5.0, 5.0, mcAborting);
    axes_cycles(300);
    interrupted_at_rest();
    for (int n = 0; n < 2; n++) {
        axes_must_be(n, CM1E_AXIS_SYNCHRONIZED_MOTION);
        axes_refused(n, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 1.0},
                     CM1E_ERROR_AXIS_IN_GROUP);
    }
    go_on();
    group_done(line);
}

static void test_after_a_pause_of_the_pc_it_rests(void)
{
    for (int rests = 0; rests < 2; rests++) {
        again();
        const cm1e_command_id_t line = group_line(5.0, 0.0, 5.0, mcAborting);
        axes_cycles(300);
        const cm1e_command_id_t id = interrupt(10.0);
        axes_cycles(rests ? 600 : 50);
        axes_inputs();
        for (int n = 0; n < 2; n++) {
            cm1e_axis_after_pause(axes_axis(n), 5000000);
            axes_bench.witness[n].ours = false; /* the velocity is gone, and so it is meant */
        }
        axes_outputs();
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, group_state_of(id));
        must_rest(50);
        go_on();
        group_done(line);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_at_every_moment_it_rests_on_the_path_and_goes_on);
    RUN_TEST(test_again_and_again_on_one_path);
    RUN_TEST(test_it_goes_on_while_it_still_brakes);
    RUN_TEST(test_what_is_not_interrupted_does_not_go_on);
    RUN_TEST(test_numbers_that_are_none_do_not_interrupt);
    RUN_TEST(test_interrupted_before_it_moves);
    RUN_TEST(test_interrupted_again);
    RUN_TEST(test_braking_that_ends_where_the_path_ends_keeps_the_last_command);
    RUN_TEST(test_commands_wait_behind_it);
    RUN_TEST(test_a_halt_that_is_interrupted_is_done_when_it_goes_on);
    RUN_TEST(test_the_braking_of_a_new_command_is_interrupted);
    RUN_TEST(test_the_override_acts_when_it_goes_on);
    RUN_TEST(test_before_it_brakes_an_override_of_0_leaves_its_deceleration);
    RUN_TEST(test_gone_on_with_an_override_of_0_it_brakes_as_that_does);
    RUN_TEST(test_what_ends_the_commands_ends_the_interruption);
    RUN_TEST(test_its_axes_are_led_as_long_as_it_lasts);
    RUN_TEST(test_after_a_pause_of_the_pc_it_rests);
    return UNITY_END();
}
