/* A slave that is not in gear yet, or makes up distance after a pause, while its master changes with all the dynamics that
 * the slave has: the slave keeps its limits and comes into gear. */
#include "unity.h"

#include "../support/axes_bench.h"
#include "../support/chance.h"

enum { MASTER, SLAVE, THIRD, WAITS = 60000 };

void setUp(void) {}
void tearDown(void) { axes_end(); }

static double fastest; /* u/s; of the master */
static char run_text[40];

static double any_velocity(double most)
{
    return uniform(0.02, one_in(3) ? 0.98 : 0.5) * most * (one_in(2) ? 1.0 : -1.0);
}

/* Axes with the same limits; the master has so much of them, at times all of what the slave can follow. `equal`: they brake
 * as they accelerate. */
static void make(int count, double masters_part, bool equal)
{
    const double most[] = {uniform(5.0, 25.0), uniform(20.0, 300.0), equal || one_in(2) ? 1.0 : uniform(0.3, 3.0),
                           uniform(300.0, 8000.0)};
    axes_describe(count);
    for (int n = 0; n < count; n++) {
        const double scale = n == MASTER ? masters_part : 1.0;
        cm1e_axis_config_t *config = axes_config(n);
        config->max_velocity = fmin(most[0] * scale, 49.0);
        config->max_acceleration = most[1] * scale;
        config->max_deceleration = most[1] * most[2] * scale;
        config->max_jerk = most[3] * scale;
    }
    fastest = axes_config(MASTER)->max_velocity;
    axes_make();
    axes_bench.run = run_text;
    axes_enable_all();
}

static void move_master(double velocity)
{
    axes_command(MASTER, &(cm1e_axis_command_t){.kind = velocity == 0.0 ? CM1E_COMMAND_HALT : CM1E_COMMAND_MOVE_VELOCITY,
                                                .velocity = velocity});
}

static void watch(int slave, cm1e_command_id_t gear, int count)
{
    for (int n = 0; n < count; n++) {
        axes_cycles(1);
        AXES_MUST(axes_state(slave) == CM1E_AXIS_SYNCHRONIZED_MOTION, "%s", axes_text(slave));
        AXES_MUST(axes_status(slave, gear).state == CM1E_COMMAND_ACTIVE, "the coupling has ended");
    }
}

/* The bus is silent for some cycles: then the slave has distance to make up. */
static void pause_for(cm1e_command_id_t gear, int cycles)
{
    axes_bench.received = CM1E_ERROR_TIMEOUT;
    watch(SLAVE, gear, cycles);
    axes_bench.received = CM1E_OK;
}

static void begin_run(int run)
{
    chance_seed(seed_of(run));
    snprintf(run_text, sizeof run_text, "seed %u", seed_of(run));
}

static void let_them_move(int last)
{
    for (int n = SLAVE; n <= last; n++)
        if (one_in(2))
            axes_move_velocity(n, any_velocity(axes_config(n)->max_velocity));
    move_master(any_velocity(fastest));
    axes_cycles(one_in(2) ? 600 : pick(300));
}

static void check(int run, bool pauses)
{
    begin_run(run);
    const int numerator = 1 + pick(3);
    const uint32_t denominator = 1 + (uint32_t)pick(3);
    make(2, (one_in(2) ? 1.0 : uniform(0.2, 1.0)) * denominator / numerator, false);
    let_them_move(SLAVE);
    const cm1e_command_id_t gear = axes_gear_in(SLAVE, MASTER, numerator, denominator);
    if (pauses)
        axes_wait_reached(SLAVE, gear, WAITS);
    for (int n = pick(4); n >= 0; n--) {
        watch(SLAVE, gear, pick(pauses ? 60 : 300));
        move_master(one_in(3) ? 0.0 : any_velocity(fastest));
        if (pauses) {
            watch(SLAVE, gear, pick(100));
            pause_for(gear, 1 + pick(8));
        }
    }
    axes_wait_reached(SLAVE, gear, WAITS);
    axes_end();
}

static void test_random_changes_of_the_master_before_the_slave_is_in_gear(void)
{
    for (int run = 0; run < seed_count(4000); run++)
        check(run, false);
}

static void test_random_changes_of_the_master_about_a_pause(void)
{
    for (int run = 0; run < seed_count(4000); run++)
        check(run, true);
}

/* A superimposed motion on top of the way into gear keeps its velocity and its distance (the bench judges the former). It
 * is refused where master and slave leave it no velocity. With another deceleration than acceleration a slave that the sum
 * turns round can end in ErrorStop (MC_MoveSuperimposed says so). */
static void test_random_changes_of_the_master_below_a_superimposed_motion(void)
{
    for (int run = 0; run < seed_count(4000); run++) {
        cm1e_command_id_t on_top = 0;
        begin_run(run);
        make(2, uniform(0.2, 0.6), true);
        let_them_move(SLAVE);
        const cm1e_command_id_t gear = axes_gear_in(SLAVE, MASTER, 1, 1);
        watch(SLAVE, gear, pick(100));
        const cm1e_axis_command_t command = {.kind = CM1E_COMMAND_MOVE_SUPERIMPOSED, .position = uniform(-3.0, 3.0),
                                             .velocity = uniform(0.02, 0.4) * axes_config(SLAVE)->max_velocity};
        const bool begun = cm1e_axis_start(axes_axis(SLAVE), &command, &on_top) == CM1E_OK;
        for (int n = pick(4); n >= 0; n--) {
            watch(SLAVE, gear, pick(200));
            move_master(one_in(3) ? 0.0 : any_velocity(fastest));
        }
        for (int n = 0; begun && n < WAITS && axes_status(SLAVE, on_top).state == CM1E_COMMAND_ACTIVE; n++)
            watch(SLAVE, gear, 1);
        if (begun)
            AXES_MUST(axes_status(SLAVE, on_top).state == CM1E_COMMAND_DONE &&
                          fabs(axes_status(SLAVE, on_top).covered - command.position) < 1e-9,
                      "%.12g of %.12g u are covered", axes_status(SLAVE, on_top).covered, command.position);
        axes_wait_reached(SLAVE, gear, WAITS);
        axes_end();
    }
}

/* Another ratio makes the coupling function's velocity and acceleration jump. The slave of a slave gets what that has on
 * its way into gear. */
static void test_random_ratios_in_a_chain_of_slaves(void)
{
    for (int run = 0; run < seed_count(4000); run++) {
        begin_run(run);
        make(3, 1.0, false);
        let_them_move(THIRD);
        cm1e_command_id_t gear[] = {[SLAVE] = axes_gear_in(SLAVE, MASTER, 1, 1),
                                    [THIRD] = axes_gear_in(THIRD, SLAVE, one_in(2) ? 1 : -1, 1)};
        for (int n = pick(6); n >= 0; n--) {
            for (int left = pick(300); left > 0; left--) {
                watch(SLAVE, gear[SLAVE], 1);
                AXES_MUST(axes_state(THIRD) == CM1E_AXIS_SYNCHRONIZED_MOTION, "%s", axes_text(THIRD));
            }
            const int slave = one_in(2) ? MASTER : one_in(2) ? SLAVE : THIRD;
            if (slave == MASTER)
                move_master(one_in(3) ? 0.0 : any_velocity(fastest));
            else
                gear[slave] = axes_gear_in(slave, slave - 1, (one_in(2) ? 1 : -1) * (1 + pick(2)), 2);
        }
        axes_wait_reached(SLAVE, gear[SLAVE], WAITS);
        axes_wait_reached(THIRD, gear[THIRD], WAITS);
        axes_end();
    }
}

/* A master followed by its actual value, which has no jerk here: its steps are whole counts. Often it is faster than the
 * slave may be. What is left to do is the slave's own motion, so that ends its acceleration with the jerk of the axis. */
static void test_the_way_to_an_actual_value_ends_with_the_jerk_of_the_axis(void)
{
    for (int run = 0; run < seed_count(1200); run++) {
        begin_run(run);
        make(2, 1.0, false);
        axes_bench.witness[SLAVE].strictness = AXES_STEEP;
        if (one_in(2))
            axes_move_velocity(SLAVE, any_velocity(fastest));
        move_master(floor(any_velocity(fastest) * 50.0) / 50.0 + 0.02);
        axes_cycles(1500);
        const cm1e_axis_coupling_t coupling = {.master = {{.axis = axes_reference(MASTER), .source = mcActualValue,
                                                           .numerator = 1 + pick(4), .denominator = 1}}};
        const cm1e_command_id_t gear = axes_command(SLAVE, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_GEAR_IN,
                                                                                  .coupling = &coupling});
        const double most = axes_config(SLAVE)->max_jerk * 1e-3 * 1.01;
        for (int n = 0; n < 2000; n++) {
            const double before = axes_axis(SLAVE)->setpoint.acceleration;
            watch(SLAVE, gear, 1);
            const double step = fabs(axes_axis(SLAVE)->setpoint.acceleration - before);
            AXES_MUST(step <= most, "the acceleration changes by %.6g u/s2 in a cycle, not %.6g", step, most);
        }
        axes_end();
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_random_changes_of_the_master_before_the_slave_is_in_gear);
    RUN_TEST(test_random_changes_of_the_master_about_a_pause);
    RUN_TEST(test_random_changes_of_the_master_below_a_superimposed_motion);
    RUN_TEST(test_random_ratios_in_a_chain_of_slaves);
    RUN_TEST(test_the_way_to_an_actual_value_ends_with_the_jerk_of_the_axis);
    return UNITY_END();
}
