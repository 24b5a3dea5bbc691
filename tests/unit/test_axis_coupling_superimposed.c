/* A superimposed motion on a slave whose master takes all of the slave's dynamics meanwhile: halts, other velocities, a
 * reversal. The superimposed part keeps its velocity, also one that is halted, replaced or slowed, the sum keeps velocity
 * and acceleration of the axis, the slave goes on following, and the distance is right in the end. A master that asks for
 * more jerk than the slave has is refused as without a superimposed motion. */
#include "unity.h"

#include "axis/axis_parameters.h"

#include "../support/axes_bench.h"
#include "../support/chance.h"

enum { MASTER, SLAVE, WAITS = 30000 };
#define MOST_VELOCITY 20.0
#define MOST_ACCELERATION 100.0
#define MOST_JERK 2000.0

void setUp(void) {}
void tearDown(void) { axes_end(); }

static double sign(void) { return one_in(2) ? 1.0 : -1.0; }

/* Of the slave. The master has the smaller one of acceleration and deceleration for both. */
static double slave_deceleration = MOST_ACCELERATION;

static void make_two(void)
{
    axes_describe(2);
    for (int n = 0; n < 2; n++) {
        axes_config(n)->max_velocity = MOST_VELOCITY;
        axes_config(n)->max_acceleration = n == SLAVE ? MOST_ACCELERATION : fmin(MOST_ACCELERATION, slave_deceleration);
        axes_config(n)->max_deceleration = n == SLAVE ? slave_deceleration : axes_config(n)->max_acceleration;
        axes_config(n)->max_jerk = MOST_JERK;
    }
    axes_make();
    axes_enable_all();
}

static void move_master(double velocity)
{
    axes_command(MASTER, &(cm1e_axis_command_t){.kind = velocity == 0.0 ? CM1E_COMMAND_HALT : CM1E_COMMAND_MOVE_VELOCITY,
                                                .velocity = velocity});
}

typedef struct on_top {
    double distance, velocity;
    cm1e_command_id_t id;
    double farthest; /* u; of what was covered, in the direction of the distance */
} on_top_t;

static void begin_on_top(on_top_t *on_top)
{
    on_top->farthest = 0.0;
    on_top->id = axes_command(SLAVE, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_SUPERIMPOSED,
                                                            .position = on_top->distance, .velocity = on_top->velocity});
}

/* Cycles with the judge; the witness of the bench looks at every set-point besides. */
static void watch(on_top_t *on_top, cm1e_command_id_t following, int count)
{
    for (int n = 0; n < count; n++) {
        axes_cycles(1);
        const double part = axes_axis(SLAVE)->superimposed.now.velocity;
        const double covered = axes_axis(SLAVE)->superimposed.now.position;
        AXES_MUST(axes_state(SLAVE) == CM1E_AXIS_SYNCHRONIZED_MOTION, "%s", axes_text(SLAVE));
        AXES_MUST(axes_status(SLAVE, following).state == CM1E_COMMAND_ACTIVE, "the coupling has ended");
        AXES_MUST(fabs(part) <= on_top->velocity * (1.0 + 1e-4), "%.12g u/s on top, VelocityDiff %.12g", part, on_top->velocity);
        on_top->farthest = fmax(on_top->farthest, on_top->distance > 0.0 ? covered : -covered);
    }
}

/* Until the superimposed motion has ended. */
static void wait_for_end(on_top_t *on_top, cm1e_command_id_t following)
{
    int cycles = 0;
    while (axes_status(SLAVE, on_top->id).state == CM1E_COMMAND_ACTIVE && cycles++ < WAITS)
        watch(on_top, following, 1);
    AXES_MUST(axes_status(SLAVE, on_top->id).state == CM1E_COMMAND_DONE, "it does not end");
}

static double ahead(void)
{
    return axes_info(SLAVE).set_position - axes_info(MASTER).set_position;
}

/* The case that was found: the slave came to 19.8 u/s with VelocityDiff 3, while its master stood. */
static void test_a_master_that_halts_leaves_the_superimposed_motion_as_it_was_asked_for(void)
{
    for (int when = 0; when < 260; when += sweep_stride(1, 13)) {
        on_top_t on_top = {.distance = 1.25, .velocity = 3.0};
        make_two();
        const cm1e_command_id_t gear = axes_gear_in(SLAVE, MASTER, 1, 1);
        axes_wait_reached(SLAVE, gear, 100);
        move_master(2.0);
        axes_cycles(400);
        const double before = ahead();
        begin_on_top(&on_top);
        watch(&on_top, gear, when);
        move_master(0.0);
        wait_for_end(&on_top, gear);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, before + on_top.distance, ahead());
        TEST_ASSERT_TRUE_MESSAGE(on_top.farthest <= on_top.distance + 1e-9, "it passes its target");
        axes_end();
    }
}

/* At most the distance that the slave covers with VelocityDiff while its coupling takes all of its acceleration. */
static void check_farthest(const on_top_t *on_top, double change)
{
    const double masters = axes_axis(MASTER)->limits.maximum.acceleration;
    const double longest_s = change / masters + 2.0 * MOST_ACCELERATION / MOST_JERK;
    AXES_MUST(on_top->farthest <= fabs(on_top->distance) + on_top->velocity * longest_s, "%.9g u covered of %.9g u",
              on_top->farthest, fabs(on_top->distance));
}

static void random_changes(int runs)
{
    static char text[60];
    for (int run = 0; run < seed_count(runs); run++) {
        chance_seed(seed_of(run));
        snprintf(text, sizeof text, "deceleration %g, seed %u", slave_deceleration, seed_of(run));
        const double from = uniform(0.5, 9.0) * sign(), to = one_in(3) ? 0.0 : uniform(0.5, 9.0) * sign();
        on_top_t on_top = {.distance = uniform(0.1, 3.0) * sign(), .velocity = uniform(0.5, 8.0)};
        const int change = pick(4); /* 0 halt, 1 another one that is slower, 2 override, 3 none */
        make_two();
        axes_bench.run = text;
        const cm1e_command_id_t gear = axes_gear_in(SLAVE, MASTER, 1, 1);
        axes_wait_reached(SLAVE, gear, 100);
        move_master(from);
        axes_cycles(600);
        const double before = ahead();
        begin_on_top(&on_top);
        watch(&on_top, gear, pick(200));
        move_master(to);
        watch(&on_top, gear, pick(100));
        const bool goes_on = axes_status(SLAVE, on_top.id).state == CM1E_COMMAND_ACTIVE;
        if (goes_on && change == 0)
            on_top.id = axes_command(SLAVE, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_HALT_SUPERIMPOSED});
        else if (goes_on && change == 1)
            on_top.id = axes_command(SLAVE, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_SUPERIMPOSED, .position = 0.5,
                                                                   .velocity = on_top.velocity / 8.0});
        else if (goes_on && change == 2)
            TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_set_override(axes_axis(SLAVE), 0.3, 1.0, 1.0));
        wait_for_end(&on_top, gear);
        if (!goes_on || change > 1)
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, before + on_top.distance, ahead());
        if (!goes_on || change != 1)
            check_farthest(&on_top, fabs(to - from));
        axes_end();
    }
}

static void test_random_changes_of_the_master(void) { random_changes(4000); }

/* The sum turns round elsewhere than the master: what it may have before, it may not have behind. */
static void test_random_changes_where_the_deceleration_differs(void)
{
    static const double decelerations[] = {50.0, 80.0, 120.0, 200.0, 400.0};
    for (int i = 0; i < 5; i++) {
        slave_deceleration = decelerations[i];
        random_changes(2000);
    }
    slave_deceleration = MOST_ACCELERATION;
}

/* One of both limits of acceleration is lowered while the superimposed motion accelerates or brakes: more than the smaller one
 * of both is no reason for an error, or for a jump of the sum, as long as it does not turn round. */
static void test_a_lowered_maximum_does_not_disturb_a_superimposed_motion(void)
{
    static const int numbers[] = {CM1E_PARAMETER_MAX_ACCELERATION_APPL, CM1E_PARAMETER_MAX_DECELERATION_APPL};
    for (int i = 0; i < 4; i++)
        for (int when = 1; when < 250; when += sweep_stride(1, 9)) {
            on_top_t on_top = {.distance = i < 2 ? 1.25 : -1.25, .velocity = 3.0};
            make_two();
            const cm1e_command_id_t gear = axes_gear_in(SLAVE, MASTER, 1, 1);
            axes_wait_reached(SLAVE, gear, 100);
            move_master(6.0);
            axes_cycles(600);
            const double before = ahead();
            begin_on_top(&on_top);
            watch(&on_top, gear, when);
            const double a = axes_axis(SLAVE)->superimposed.now.acceleration;
            const double value = fmax(1.0, 0.6 * fabs(a));
            const cm1e_error_t error = cm1e_axis_write_parameter(axes_axis(SLAVE), numbers[i % 2], value);
            AXES_MUST(error == CM1E_OK || (i % 2 == 0) == (a > 0.0), "refused at %g u/s2: %s", a, axes_text(SLAVE));
            wait_for_end(&on_top, gear);
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, before + on_top.distance, ahead());
            axes_end();
        }
}

/* The maximum velocity is lowered below VelocityDiff before the superimposed motion has come to that. */
static void test_a_lowered_maximum_velocity_holds_for_a_superimposed_motion(void)
{
    on_top_t on_top = {.distance = 1.25, .velocity = 3.0};
    make_two();
    const cm1e_command_id_t gear = axes_gear_in(SLAVE, MASTER, 1, 1);
    axes_wait_reached(SLAVE, gear, 100);
    const double before = ahead();
    begin_on_top(&on_top);
    watch(&on_top, gear, 10);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_write_parameter(axes_axis(SLAVE), CM1E_PARAMETER_MAX_VELOCITY_APPL, 2.0));
    on_top.velocity = 2.0;
    wait_for_end(&on_top, gear);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, before + on_top.distance, ahead());
}

/* The jerk of the master alone is more than the slave has, by the master's own limits or by the ratio. */
static void test_a_master_with_more_jerk_than_the_slave_is_an_error_as_ever(void)
{
    for (int by_ratio = 0; by_ratio < 2; by_ratio++)
        for (int when = 20; when < 200; when += 20) {
            on_top_t on_top = {.distance = 2.0, .velocity = 3.0};
            make_two();
            axes_config(MASTER)->max_jerk = by_ratio ? MOST_JERK : 50.0 * MOST_JERK;
            axes_make();
            axes_enable_all();
            const cm1e_command_id_t gear = axes_gear_in(SLAVE, MASTER, by_ratio ? 2 : 1, 1);
            axes_wait_reached(SLAVE, gear, 100);
            axes_command(MASTER, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 2.0,
                                                        .acceleration = 20.0, .jerk = 500.0});
            axes_cycles(600);
            begin_on_top(&on_top);
            watch(&on_top, gear, when);
            axes_command(MASTER, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_HALT, .deceleration = 20.0});
            axes_cycles(50);
            axes_must_be(SLAVE, CM1E_AXIS_ERROR_STOP);
            axes_told(SLAVE, "jerk");
            axes_end();
        }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_master_with_more_jerk_than_the_slave_is_an_error_as_ever);
    RUN_TEST(test_a_master_that_halts_leaves_the_superimposed_motion_as_it_was_asked_for);
    RUN_TEST(test_random_changes_of_the_master);
    RUN_TEST(test_random_changes_where_the_deceleration_differs);
    RUN_TEST(test_a_lowered_maximum_does_not_disturb_a_superimposed_motion);
    RUN_TEST(test_a_lowered_maximum_velocity_holds_for_a_superimposed_motion);
    return UNITY_END();
}
