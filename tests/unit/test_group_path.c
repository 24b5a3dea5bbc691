/* What a group promises of every path: the limits of its axes, the geometry and the braking that were commanded, also where
 * they are hard to keep. */
#include <math.h>

#include "unity.h"

#include "../support/group_bench.h"

void setUp(void) { group_begin(3); }
void tearDown(void) { group_end(); }

static cm1e_group_command_t line_to(double x, double y, double velocity)
{
    return (cm1e_group_command_t){.kind = CM1E_GROUP_LINEAR_ABSOLUTE, .position = {x, y}, .velocity = velocity};
}

/* A break of the direction too small to stop for steps the velocity of an axis. Where the axis brakes as hard as it may,
 * both together are more than it may. */
static void test_nearly_straight_on_an_axis_that_brakes_keeps_its_limit(void)
{
    for (int i = 0; i < 8; i++)
        for (double rest = 0.15; rest < 1.0; rest *= 1.5) {
            const double bend = 1e-5 * pow(1.8, i);
            group_end();
            group_begin(2);
            for (int n = 0; n < 2; n++) /* it takes the break for jerk: the guard of the axis judges, and group_done() */
                axes_bench.witness[n].strictness = AXES_UNWATCHED;
            cm1e_group_command_t c = line_to(3.0, 3.0, 0.0);
            (void)group_command(&c);
            c = line_to(3.0 + rest * cos(0.785398163 + bend), 3.0 + rest * sin(0.785398163 + bend), 0.0);
            c.buffer_mode = mcBlendingHigh;
            const cm1e_command_id_t id = group_command(&c);
            double slowest = INFINITY;
            while (group_at(0) < 2.99)
                axes_cycles(1);
            for (; group_at(0) < 3.01; axes_cycles(1))
                slowest = fmin(slowest, group->sample.path_velocity);
            TEST_ASSERT_TRUE(slowest > 1.0);
            group_done(id);
        }
}

static void test_a_half_circle_is_not_turned_by_a_count_of_the_third_axis(void)
{
    cm1e_group_command_t c = line_to(2.0, 0.0, 0.0);
    c.position[2] = -2e-5;
    group_done(group_command(&c));
    c = (cm1e_group_command_t){.kind = CM1E_GROUP_CIRCULAR_ABSOLUTE, .circ_mode = mcCenter, .position = {-2.0}};
    group_refused(&c, CM1E_ERROR_GROUP_PATH);
    group_told("needs begin, centre and end at the same Z");
    c.kind = CM1E_GROUP_CIRCULAR_RELATIVE;
    c.position[0] = -4.0;
    c.auxiliary[0] = -2.0;
    const cm1e_command_id_t id = group_command(&c);
    while (group_state_of(id) == CM1E_COMMAND_ACTIVE) {
        axes_cycles(1);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, -2e-5, group_at(2));
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 2.0, hypot(group_at(0), group_at(1)));
    }
    group_done(id);
}

/* An axis needs the directions in which the arc moves it: none where it lies across, one where it does not turn back. */
static void test_an_arc_needs_only_the_directions_in_which_it_moves_an_axis(void)
{
    axes_bench.positive[2] = false;
    axes_bench.negative[0] = axes_bench.positive[1] = false;
    axes_cycles(2);
    const cm1e_group_command_t quarter = {.kind = CM1E_GROUP_CIRCULAR_RELATIVE, .circ_mode = mcCenter,
                                          .path_choice = mcClockwise, .position = {1.0, -1.0}, .auxiliary = {0.0, -1.0}};
    cm1e_command_id_t id = group_command(&quarter);
    while (group_state_of(id) == CM1E_COMMAND_ACTIVE) {
        axes_cycles(1);
        TEST_ASSERT_EQUAL_DOUBLE(0.0, group_at(2));
    }
    group_done(id);
    cm1e_group_command_t c = quarter; /* round to the other side: X goes on, Y turns back */
    c.position[0] = 0.0;
    c.position[1] = -2.0;
    group_refused(&c, CM1E_ERROR_AXIS_DIRECTION_DISABLED);
    c = (cm1e_group_command_t){.kind = CM1E_GROUP_CIRCULAR_RELATIVE, .circ_mode = mcBorder, .auxiliary = {0.5, -0.5, 0.4},
                               .position = {1.0, -1.0, 0.0}}; /* Z goes up and down */
    group_refused(&c, CM1E_ERROR_AXIS_DIRECTION_DISABLED);
    axes_bench.positive[2] = true;
    axes_cycles(2);
    id = group_command(&c);
    group_done(id);
}

/* Over corners that are not stopped at, where the velocity was planned before the group stood. */
static void test_an_override_after_0_acts_at_all_corners(void)
{
    static const double then[] = {0.2, 0.7, 1.0};
    for (size_t i = 0; i < sizeof then / sizeof then[0]; i++)
        for (int soon = 0; soon < 2; soon++) {
            group_end();
            group_begin(2);
            cm1e_group_command_t c = line_to(10.0, 0.0, 5.0);
            (void)group_command(&c);
            c = line_to(10.0, 10.0, 5.0);
            c.buffer_mode = mcBlendingLow;
            c.transition = mcTMCornerDistance;
            c.transition_parameter = 3.0;
            (void)group_command(&c);
            c.position[0] = 20.0;
            const cm1e_command_id_t id = group_command(&c);
            axes_cycles(500);
            cm1e_group_set_override(group, 0.0);
            axes_cycles(soon ? 5 : 1000); /* soon: it does not stand yet */
            cm1e_group_set_override(group, then[i]);
            if (soon)
                axes_cycles(1000);
            double fastest = 0.0;
            for (; group_state_of(id) == CM1E_COMMAND_BUFFERED; axes_cycles(1))
                fastest = fmax(fastest, group->sample.path_velocity);
            TEST_ASSERT_DOUBLE_WITHIN(1e-6, 5.0 * then[i], fastest);
            group_done(id);
        }
}

/* Whatever the override does meanwhile, and whatever is to follow. */
static void test_the_group_brakes_with_what_it_was_told(void)
{
    static const double overrides[] = {1.0, 0.9, 0.1, 0.0};
    static const cm1e_group_command_t stops[] = {
        {.kind = CM1E_GROUP_STOP, .deceleration = 1.0},
        {.kind = CM1E_GROUP_HALT, .deceleration = 1.0},
        {.kind = CM1E_GROUP_LINEAR_ABSOLUTE, .position = {0.0, 5.0}, .velocity = 5.0, .deceleration = 1.0},
        {.kind = CM1E_GROUP_LINEAR_RELATIVE, .position = {-5.0, 5.0}, .velocity = 5.0, .deceleration = 1.0},
    };
    for (size_t i = 0; i < sizeof stops / sizeof stops[0]; i++)
        for (size_t k = 0; k < sizeof overrides / sizeof overrides[0]; k++) {
            group_end();
            group_begin(2);
            (void)group_line(100.0, 0.0, 5.0, mcAborting);
            axes_cycles(2000);
            const double from = group_at(0);
            const cm1e_command_id_t id = group_command(&stops[i]);
            double before = group->sample.path_velocity;
            for (int n = 0; n < 4990; n++) {
                axes_cycles(1);
                if (n == 3000)
                    cm1e_group_set_override(group, overrides[k]);
                TEST_ASSERT_TRUE(group->sample.path_velocity <= before);
                if (n > 5)
                    TEST_ASSERT_DOUBLE_WITHIN(1e-5, 1e-3, before - group->sample.path_velocity);
                before = group->sample.path_velocity;
            }
            axes_cycles(15);
            TEST_ASSERT_DOUBLE_WITHIN(0.01, 12.5, group_at(0) - from);
            cm1e_group_set_override(group, 1.0);
            group_done(id);
        }
}

/* A stop that is told again, as by MC_GroupStop behind MC_GroupHalt or for a command that waits behind the halt. */
static void test_a_stop_that_is_told_again_brakes_on(void)
{
    static const double decelerations[] = {0.3, 0.7, 1.0, 3.0};
    for (size_t i = 0; i < sizeof decelerations / sizeof decelerations[0]; i++)
        for (int again = 0; again < 3; again++)
            for (double less = 1.0; less > 0.3; less /= 2.0) {
                const double deceleration = decelerations[i];
                group_end();
                group_begin(2);
                (void)group_line(1000.0, 300.0, 5.0, mcAborting);
                axes_cycles(1000);
                const cm1e_group_command_t halt = {.kind = CM1E_GROUP_HALT, .deceleration = deceleration};
                (void)group_command(&halt);
                double before = group->sample.path_velocity;
                for (int n = 0; group->sample.path_velocity > 0.0 && n < 1000 + 5000.0 / deceleration; n++) {
                    axes_cycles(1);
                    const double braked = before - group->sample.path_velocity;
                    TEST_ASSERT_TRUE(braked >= 0.0 && braked <= deceleration * 1.01e-3);
                    before = group->sample.path_velocity;
                    if (n != 300)
                        continue;
                    const cm1e_group_command_t stop = {.kind = again == 1 ? CM1E_GROUP_HALT : CM1E_GROUP_STOP,
                                                       .deceleration = less * deceleration};
                    (void)(again ? group_command(&stop) : group_line(0.0, 0.0, 5.0, mcBuffered));
                }
                TEST_ASSERT_EQUAL_DOUBLE(0.0, before);
            }
}

/* Whenever it is asked for. It may take five times as long as the axes would need on a line: a bend takes most of their
 * limits. */
static void test_a_stop_begins_at_once_also_while_it_gets_faster(void)
{
    static const cm1e_group_command_t ways[] = {
        {.kind = CM1E_GROUP_CIRCULAR_ABSOLUTE, .circ_mode = mcCenter, .auxiliary = {3.0}, .velocity = 5.0},
        {.kind = CM1E_GROUP_LINEAR_ABSOLUTE, .position = {20.0, 20.0}, .velocity = 5.0},
    };
    for (size_t i = 0; i < sizeof ways / sizeof ways[0]; i++)
        for (int overrides = 0; overrides < 2; overrides++)
            for (int at = 1; at < 200; at += 3) {
                group_end();
                group_begin(2);
                (void)group_command(&ways[i]);
                axes_cycles(at);
                if (overrides)
                    cm1e_group_set_override(group, 0.2);
                const double v = group->sample.path_velocity, fastest = fmin(v + 2.5, 5.0 * (1.0 + 1e-9));
                const cm1e_command_id_t id = group_stop();
                int cycles = 0;
                for (; group->sample.path_velocity > 0.0 || cycles < 2; cycles++) {
                    axes_cycles(1);
                    TEST_ASSERT_TRUE(group->sample.path_velocity <= fastest);
                    TEST_ASSERT_TRUE(cycles < 5 * (fastest / 100.0 + 100.0 / 2000.0) * 1000.0);
                }
                group_done(id);
            }
}

/* A wide bend takes little of the limits of its axes, so a stop there is not much longer than on a line. */
static void test_a_stop_in_a_wide_bend_is_nearly_as_short_as_on_a_line(void)
{
    for (double radius = 3.0; radius < 300.0; radius *= 2.0)
        for (double v = 1.0; v < 6.0; v *= 1.5) {
            group_end();
            group_begin(2);
            (void)group_command(&(cm1e_group_command_t){.kind = CM1E_GROUP_CIRCULAR_ABSOLUTE, .circ_mode = mcCenter,
                                                        .auxiliary = {radius}, .velocity = v});
            while (group->sample.path_velocity < v)
                axes_cycles(1);
            axes_cycles(2);
            const cm1e_command_id_t id = group_stop();
            int cycles = 0;
            for (; group->sample.path_velocity > 0.0; cycles++)
                axes_cycles(1);
            const double on_a_line_s = v > 5.0 ? v / 100.0 + 100.0 / 2000.0 : 2.0 * sqrt(v / 2000.0);
            TEST_ASSERT_TRUE(cycles < 1.35 * on_a_line_s * 1000.0);
            group_done(id);
        }
}

/* That of the first three axes, which are the space; where none of them moves, that of the others. */
static void test_the_velocity_of_the_path_is_that_in_space(void)
{
    static const double ways[][4] = {{1.0, 2.0, 2.0, 0.5}, {0.0, 0.0, 2.0, 3.0}, {0.0, 0.0, 0.0, -2.0}};
    for (int i = 0; i < 3; i++) {
        double position[CM1E_GROUP_AXES], velocity[CM1E_GROUP_AXES], path;
        group_end();
        group_begin(4);
        cm1e_group_command_t c = line_to(ways[i][0], ways[i][1], 0.0);
        c.position[2] = ways[i][2];
        c.position[3] = ways[i][3];
        const cm1e_command_id_t id = group_command(&c);
        axes_cycles(100);
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_values(group, mcSetValue, position, velocity, &path));
        const double in_space = hypot(hypot(velocity[0], velocity[1]), velocity[2]);
        TEST_ASSERT_TRUE(fabs(velocity[3]) > 0.0);
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, in_space > 0.0 ? in_space : fabs(velocity[3]), path);
        group_done(id);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_nearly_straight_on_an_axis_that_brakes_keeps_its_limit);
    RUN_TEST(test_an_arc_needs_only_the_directions_in_which_it_moves_an_axis);
    RUN_TEST(test_a_half_circle_is_not_turned_by_a_count_of_the_third_axis);
    RUN_TEST(test_an_override_after_0_acts_at_all_corners);
    RUN_TEST(test_the_group_brakes_with_what_it_was_told);
    RUN_TEST(test_a_stop_that_is_told_again_brakes_on);
    RUN_TEST(test_a_stop_begins_at_once_also_while_it_gets_faster);
    RUN_TEST(test_a_stop_in_a_wide_bend_is_nearly_as_short_as_on_a_line);
    RUN_TEST(test_the_velocity_of_the_path_is_that_in_space);
    return UNITY_END();
}
