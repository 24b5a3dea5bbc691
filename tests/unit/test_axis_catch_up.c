/* A slave that is not in gear yet, or makes up distance after a pause, while its master changes with all the dynamics that
 * the slave has: the slave keeps its limits and comes into gear. */
#include "unity.h"

#include "../support/axes_bench.h"
#include "../support/chance.h"

enum { MASTER, SLAVE, WAITS = 60000 };

void setUp(void) {}
void tearDown(void) { axes_end(); }

static double fastest; /* u/s; of the master */

static double any_velocity(double most)
{
    return uniform(0.02, one_in(3) ? 0.98 : 0.5) * most * (one_in(2) ? 1.0 : -1.0);
}

/* The master has what the slave can follow, at times all of it. */
static void make_two(int numerator, uint32_t denominator)
{
    const double most[] = {uniform(5.0, 25.0), uniform(20.0, 300.0), one_in(2) ? 1.0 : uniform(0.3, 3.0),
                           uniform(300.0, 8000.0)};
    const double part = one_in(2) ? 1.0 : uniform(0.2, 1.0);
    axes_describe(2);
    for (int n = 0; n < 2; n++) {
        const double scale = n == MASTER ? part * denominator / numerator : 1.0;
        cm1e_axis_config_t *config = axes_config(n);
        config->max_velocity = fmin(most[0] * scale, 49.0);
        config->max_acceleration = most[1] * scale;
        config->max_deceleration = most[1] * most[2] * scale;
        config->max_jerk = most[3] * scale;
    }
    fastest = axes_config(MASTER)->max_velocity;
    axes_make();
    axes_enable_all();
}

static void move_master(double velocity)
{
    axes_command(MASTER, &(cm1e_axis_command_t){.kind = velocity == 0.0 ? CM1E_COMMAND_HALT : CM1E_COMMAND_MOVE_VELOCITY,
                                                .velocity = velocity});
}

static void watch(cm1e_command_id_t gear, int count)
{
    for (int n = 0; n < count; n++) {
        axes_cycles(1);
        AXES_MUST(axes_state(SLAVE) == CM1E_AXIS_SYNCHRONIZED_MOTION, "%s", axes_text(SLAVE));
        AXES_MUST(axes_status(SLAVE, gear).state == CM1E_COMMAND_ACTIVE, "the coupling has ended");
    }
}

/* The bus is silent for some cycles: then the slave has distance to make up. */
static void pause_for(cm1e_command_id_t gear, int cycles)
{
    axes_bench.received = CM1E_ERROR_TIMEOUT;
    watch(gear, cycles);
    axes_bench.received = CM1E_OK;
}

static void check(int run, bool pauses)
{
    static char text[40];
    const int numerator = 1 + pick(3);
    const uint32_t denominator = 1 + (uint32_t)pick(3);
    snprintf(text, sizeof text, "seed %u", seed_of(run));
    make_two(numerator, denominator);
    axes_bench.run = text;
    if (one_in(2))
        axes_move_velocity(SLAVE, any_velocity(axes_config(SLAVE)->max_velocity));
    move_master(any_velocity(fastest));
    axes_cycles(one_in(2) ? 600 : pick(300));
    const cm1e_command_id_t gear = axes_gear_in(SLAVE, MASTER, numerator, denominator);
    if (pauses)
        axes_wait_reached(SLAVE, gear, WAITS);
    for (int n = pick(4); n >= 0; n--) {
        watch(gear, pick(pauses ? 60 : 300));
        move_master(one_in(3) ? 0.0 : any_velocity(fastest));
        if (pauses) {
            watch(gear, pick(100));
            pause_for(gear, 1 + pick(8));
        }
    }
    axes_wait_reached(SLAVE, gear, WAITS);
    axes_end();
}

static void test_random_changes_of_the_master_before_the_slave_is_in_gear(void)
{
    for (int run = 0; run < seed_count(4000); run++) {
        chance_seed(seed_of(run));
        check(run, false);
    }
}

static void test_random_changes_of_the_master_about_a_pause(void)
{
    for (int run = 0; run < seed_count(4000); run++) {
        chance_seed(seed_of(run));
        check(run, true);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_random_changes_of_the_master_before_the_slave_is_in_gear);
    RUN_TEST(test_random_changes_of_the_master_about_a_pause);
    return UNITY_END();
}
