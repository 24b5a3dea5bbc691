/*
 * An axis that follows masters has a short way through a cycle too. The same random program runs twice with the same
 * axes: once as it is, once with every axis in the long way. All set-points must have the same bits, in every cycle.
 * CM1E_TEST_SEED=<n> repeats one run, CM1E_TEST_SEEDS=<count> as many from there on.
 */
#include "unity.h"

#include "axis/axis_parameters.h"

#include "../support/axes_bench.h"
#include "../support/chance.h"

enum { AXES = 4, RUNS = 120, CYCLES = 2500 };

/* No function knows this bit of cm1e_axis_t.extras, but an axis that has one takes the long way. */
static const uint8_t always_something = 0x80;

typedef struct seen {
    position_t position;
    double velocity, acceleration;
    cm1e_axis_state_t state;
    bool reached, brakes_hard, in_position;
} seen_t;

static seen_t seen[2][CYCLES][AXES];
static unsigned long long led_cycles;

void setUp(void) {}
void tearDown(void) { axes_end(); }

static void begin(unsigned seed, bool long_way)
{
    chance_seed(seed);
    axes_describe(AXES);
    for (int n = 0; n < AXES; n++) {
        axes_config(n)->max_jerk = one_in(3) ? 0.0 : uniform(2000.0, 20000.0);
        axes_config(n)->invert = one_in(3);
    }
    axes_make();
    for (int n = 0; n < AXES; n++)
        axes_axis(n)->extras |= long_way ? always_something : 0;
    axes_enable_all();
    for (int n = 0; n < AXES; n++) /* programs without order break limits of slaves */
        axes_bench.witness[n].strictness = AXES_UNWATCHED;
}

static void follow(int n)
{
    const int master = pick(n), other = pick(n);
    const cm1e_axis_coupling_t coupling = {
        .master = {{.axis = axes_reference(master), .source = one_in(5) ? mcActualValue : mcSetValue,
                    .numerator = 1 + pick(3), .denominator = 2 + (uint32_t)pick(4)},
                   {.axis = axes_reference(other), .source = mcSetValue, .numerator = 1, .denominator = 4}},
        .master_sync_position = uniform(-3.0, 3.0), .slave_sync_position = uniform(-3.0, 3.0)};
    static const cm1e_command_kind_t kinds[] = {CM1E_COMMAND_GEAR_IN, CM1E_COMMAND_GEAR_IN, CM1E_COMMAND_COMBINE_AXES,
                                                CM1E_COMMAND_GEAR_IN_POS};
    cm1e_command_id_t id;
    (void)cm1e_axis_start(axes_axis(n), &(cm1e_axis_command_t){.kind = kinds[pick(4)], .coupling = &coupling,
                          .buffer_mode = one_in(4) ? mcBuffered : mcAborting}, &id);
}

static void move(int n)
{
    static const cm1e_command_kind_t kinds[] = {
        CM1E_COMMAND_MOVE_ABSOLUTE, CM1E_COMMAND_MOVE_VELOCITY, CM1E_COMMAND_MOVE_RELATIVE, CM1E_COMMAND_HALT,
        CM1E_COMMAND_MOVE_SUPERIMPOSED, CM1E_COMMAND_GEAR_OUT, CM1E_COMMAND_PHASING_RELATIVE};
    const cm1e_axis_coupling_t coupling = {.master = {{.axis = axes_reference(n ? pick(n) : 1)}}};
    cm1e_command_id_t id;
    (void)cm1e_axis_start(axes_axis(n), &(cm1e_axis_command_t){
        .kind = kinds[pick(n ? 7 : 3)], .position = uniform(-10.0, 10.0), .velocity = uniform(0.5, 10.0),
        .acceleration = uniform(5.0, 50.0), .coupling = &coupling}, &id);
}

static void anything(void)
{
    const int n = pick(AXES);
    axes_bench.received = one_in(30) ? CM1E_ERROR_BUS_LOST : CM1E_OK;
    if (one_in(40))
        (void)cm1e_axis_write_parameter(axes_axis(n), 2, uniform(1.0, 50.0)); /* SWLimitPos */
    if (one_in(40))
        axes_power(n, !axes_bench.on[n]);
    else if (one_in(10))
        (void)cm1e_axis_reset(axes_axis(n));
    else if (n > 0 && one_in(2))
        follow(n);
    else
        move(n);
}

static void run(unsigned seed, int side)
{
    begin(seed, side == 1);
    for (int i = 0; i < CYCLES; i++) {
        axes_inputs();
        axes_bench.received = CM1E_OK;
        if (one_in(60))
            anything();
        axes_outputs();
        for (int n = 0; n < AXES; n++) {
            const setpoint_t *s = &axes_axis(n)->setpoint;
            seen_t *now = &seen[side][i][n];
            memset(now, 0, sizeof *now);
            now->position = s->position;
            now->velocity = s->velocity;
            now->acceleration = s->acceleration;
            now->state = axes_state(n);
            now->reached = s->reached;
            now->brakes_hard = s->brakes_hard;
            now->in_position = axes_axis(n)->in_position.inside;
            led_cycles += axes_state(n) == CM1E_AXIS_SYNCHRONIZED_MOTION;
        }
    }
}

static void test_slaves_side_by_side(void)
{
    const int runs = seed_count(RUNS);
    for (int i = 0; i < runs; i++) {
        run(seed_of(i), 0);
        run(seed_of(i), 1);
        for (int k = 0; k < CYCLES; k++)
            for (int n = 0; n < AXES; n++)
                AXES_MUST(memcmp(&seen[0][k][n], &seen[1][k][n], sizeof seen[0][k][n]) == 0,
                          "seed %u: axis %d in cycle %d is at %.17g u/s instead of %.17g", seed_of(i), n, k,
                          seen[0][k][n].velocity, seen[1][k][n].velocity);
    }
    printf("%llu cycles of slaves\n", led_cycles);
    TEST_ASSERT_TRUE(seeds_given() || led_cycles > (unsigned long long)runs * CYCLES / 4);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_slaves_side_by_side);
    return UNITY_END();
}
