/*
 * The short way of an ordinary cycle gives the same bits as the long way. The benches compare both in every cycle
 * (ordinary_witness.h); here are random motions with all that could make a cycle extraordinary, and most cycles are
 * ordinary all the same. CM1E_TEST_SEED=<n> repeats one run, CM1E_TEST_SEEDS=<count> as many from there on.
 */
#include "axis/axis_parameters.h"
#include "axis/axis_signals.h"

#include "../support/axis_bench.h"
#include "../support/chance.h"
#include "../support/ordinary_witness.h"

enum { RUNS = 600, CYCLES = 3000 };

void setUp(void) {}
void tearDown(void) { bench_end(); }

static void begin(unsigned seed)
{
    chance_seed(seed);
    bench_end();
    fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    cm1e_axis_config_t *config = &bus.config.axes[0];
    config->max_acceleration = uniform(50.0, 500.0);
    config->max_jerk = one_in(4) ? 0.0 : uniform(500.0, 50000.0);
    config->invert = one_in(2);
    config->modulo_range = one_in(4) ? 3.0 : 0.0;
    config->backlash = one_in(8) ? 0.01 : 0.0;
    if (config->modulo_range == 0.0 && one_in(2)) {
        config->software_limit_negative = -uniform(1.0, 20.0);
        config->software_limit_positive = uniform(1.0, 20.0);
    }
    bench_create();
    if (one_in(3)) { /* it has been going on and on */
        axis->position.actual_counts += (pick(1000) - 500) * (INT64_C(1) << 32);
        bench_cycles(1);
    }
    bench_enable();
}

/* ---- what could happen ------------------------------------------------------------------------------------------- */

static void start(void)
{
    static const cm1e_command_kind_t kinds[] = {
        CM1E_COMMAND_MOVE_ABSOLUTE, CM1E_COMMAND_MOVE_RELATIVE, CM1E_COMMAND_MOVE_ADDITIVE, CM1E_COMMAND_MOVE_VELOCITY,
        CM1E_COMMAND_MOVE_VELOCITY, CM1E_COMMAND_MOVE_CONTINUOUS_ABSOLUTE, CM1E_COMMAND_MOVE_CONTINUOUS_RELATIVE,
        CM1E_COMMAND_MOVE_SUPERIMPOSED, CM1E_COMMAND_HALT};
    const cm1e_axis_command_t command = {
        .kind = kinds[pick((int)(sizeof kinds / sizeof kinds[0]))], .position = uniform(-15.0, 15.0),
        .velocity = uniform(0.5, 30.0), .end_velocity = uniform(-5.0, 5.0),
        .buffer_mode = one_in(3) ? (MC_BUFFER_MODE)pick(6) : mcAborting};
    cm1e_command_id_t id;
    (void)cm1e_axis_start(axis, &command, &id);
    if (one_in(10))
        cm1e_axis_keep(axis, id, uniform(1.0, 300.0) * 1e6, 0.0, 0.0);
}

static void change_override(void)
{
    (void)cm1e_axis_set_override(axis, one_in(4) ? 0.0 : uniform(0.1, 1.0), uniform(0.1, 1.0), 1.0);
}

static void shift_coordinates(void) { (void)cm1e_axis_set_position(axis, uniform(-2.0, 2.0), one_in(2)); }

static void write_limits(void)
{
    static const int flags[] = {4, 5};  /* EnableLimitPos, EnableLimitNeg */
    (void)cm1e_axis_write_parameter(axis, flags[pick(2)], one_in(2) ? 1.0 : 0.0);
    const double now = bench_info().set_position;
    (void)cm1e_axis_write_parameter(axis, 2, now + uniform(0.1, 10.0)); /* SWLimitPos */
    (void)cm1e_axis_write_parameter(axis, 3, now - uniform(0.1, 10.0)); /* SWLimitNeg */
}

static void toggle_output(void) { (void)cm1e_axis_write_output(axis, 1, one_in(2)); }

static void change_directions(void)
{
    (void)cm1e_axis_power(axis, &owner, true, !one_in(3), !one_in(3));
}

static void lose_power(void) { bench_power(false); }

static void lose_a_frame(void) { received = CM1E_ERROR_BUS_LOST; }

static void come_back(void)
{
    (void)cm1e_axis_set_override(axis, 1.0, 1.0, 1.0);
    (void)cm1e_axis_write_output(axis, 1, false);
    (void)cm1e_axis_reset(axis);
    bench_power(true);
}

static void anything(void)
{
    static void (*const events[])(void) = {start, start, start, start, start, start, change_override,
                                           shift_coordinates, write_limits, toggle_output, change_directions,
                                           lose_power, lose_a_frame, come_back, come_back, come_back};
    events[pick((int)(sizeof events / sizeof events[0]))]();
}

static void test_random_motions(void)
{
    const int runs = seed_count(RUNS);
    cycles_advanced = cycles_ordinary = inputs_seen = inputs_ordinary = 0;
    for (int run = 0; run < runs; run++) {
        begin(seed_of(run));
        const unsigned rareness = one_in(3) ? 5 : 100;
        for (int i = 0; i < CYCLES; i++) {
            bench_inputs();
            received = CM1E_OK;
            if (one_in(rareness))
                anything();
            bench_outputs();
        }
    }
    printf("%llu of %llu cycles were ordinary, %llu of %llu inputs\n", cycles_ordinary, cycles_advanced,
           inputs_ordinary, inputs_seen);
    TEST_ASSERT_TRUE(seeds_given() || (cycles_ordinary > cycles_advanced / 3 && inputs_ordinary > inputs_seen / 3));
}

/* ---- where the short way must end ----------------------------------------------------------------------------- */

/* Counts cycles of a motion in the short way. */
static unsigned long long ordinary_in(int cycles)
{
    const unsigned long long before = cycles_ordinary;
    bench_cycles(cycles);
    return cycles_ordinary - before;
}

static void test_move_is_ordinary_but_for_its_stretches(void)
{
    bench_start();
    bench_enable();
    bench_move_to(100.0, 20.0);
    const unsigned long long most = ordinary_in(1000);
    TEST_ASSERT_TRUE(most > 980 && most < 1000); /* 7 stretches at most, found in the long way */
}

static void test_limit_written_on_the_way_is_seen_at_once(void)
{
    bench_start();
    bench_enable();
    bench_move_velocity(20.0);
    bench_cycles(500);
    TEST_ASSERT_EQUAL_UINT64(50, ordinary_in(50));
    /* within the time that was looked ahead; accepted, as the axis can still be stopped before it */
    const double limit = bench_info().set_position + 20.0 * 20.0 * axis->limits.emergency_way + 1.0;
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_write_parameter(axis, 2, limit));
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_write_parameter(axis, 4, 1.0));
    bench_cycles(3000);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_ERROR_STOP, bench_info().state);
    TEST_ASSERT_TRUE(bench_info().set_position <= limit + 1e-6);
}

static void test_silent_cycle_is_not_ordinary(void)
{
    bench_start();
    bench_enable();
    bench_move_velocity(5.0);
    bench_cycles(500);
    received = CM1E_ERROR_BUS_LOST;
    TEST_ASSERT_EQUAL_UINT64(0, ordinary_in(1));
    received = CM1E_OK;
    TEST_ASSERT_EQUAL_UINT64(0, ordinary_in(1));
    TEST_ASSERT_EQUAL_UINT64(10, ordinary_in(10));
}

int main(void)
{
    axes_compared_every = 1;
    UNITY_BEGIN();
    RUN_TEST(test_random_motions);
    RUN_TEST(test_move_is_ordinary_but_for_its_stretches);
    RUN_TEST(test_limit_written_on_the_way_is_seen_at_once);
    RUN_TEST(test_silent_cycle_is_not_ordinary);
    return UNITY_END();
}
