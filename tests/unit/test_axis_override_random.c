/*
 * MC_SetOverride at random moments with random factors, over single moves and chains that go one way. The page says
 * what holds: no change of a factor leads beyond a target, nor back. The set position of every cycle is judged.
 * CM1E_TEST_SEED=<n> repeats one run, CM1E_TEST_SEEDS=<count> as many from there on.
 */
#include "../support/axis_bench.h"
#include "../support/axis_witness.h"
#include "../support/chance.h"

enum { RUNS = 1500, CYCLES = 1500, CHAIN_MOST = 4 };

/* A set-point is sent in whole counts; a hundredth of one is what the axis takes for the same place. */
static const double rounding_counts = 0.01;

static char run_name[32];
static unsigned long long changes;

void setUp(void) {}
void tearDown(void) { bench_end(); }

static void begin(unsigned seed)
{
    chance_seed(seed);
    bench_end();
    fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    bus.config.axes[0].max_acceleration = uniform(50.0, 200.0);
    bus.config.axes[0].max_deceleration = one_in(2) ? 0.0 : uniform(50.0, 200.0);
    bus.config.axes[0].max_jerk = uniform(500.0, 5000.0);
    bus.config.axes[0].invert = one_in(2);
    bench_create();
    bench_enable();
    watch_begin();
    snprintf(run_name, sizeof run_name, "of CM1E_TEST_SEED=%u", seed);
    watch.run = run_name;
}

static double part_of(double most) { return one_in(3) ? 0.0 : uniform(0.1, 1.0) * most; }

/* A chain of moves in the direction of `sign`; where it ends. */
static double start_chain(double sign, cm1e_command_id_t *last)
{
    const int count = one_in(2) ? 1 : 1 + pick(CHAIN_MOST);
    double end = 0.0;
    for (int i = 0; i < count; i++) {
        const bool relative = i == 0 && one_in(3);
        end += sign * (one_in(4) ? uniform(0.001, 0.3) : uniform(0.3, 12.0));
        *last = bench_start_command(&(cm1e_axis_command_t){
            .kind = relative ? CM1E_COMMAND_MOVE_RELATIVE : CM1E_COMMAND_MOVE_ABSOLUTE, .position = end,
            .velocity = uniform(3.0, 25.0), .acceleration = part_of(axis->limits.maximum.acceleration),
            .deceleration = part_of(axis->limits.maximum.deceleration), .jerk = part_of(axis->limits.maximum.jerk),
            .buffer_mode = i ? (MC_BUFFER_MODE)(mcBuffered + pick(5)) : mcAborting});
    }
    return end;
}

static double factor(void) { return one_in(3) ? 1.0 : uniform(0.02, 1.0); }

static void change_override(void)
{
    const double velocity = one_in(4) ? 0.0 : factor(), acceleration = factor(), jerk = factor();
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_set_override(axis, velocity, acceleration, jerk));
    changes++;
}

static void judge(double sign, double before, double now, double end)
{
    const double rounding = rounding_counts / fabs(axis->position.scale);
    WATCH(sign * (now - end) <= rounding, "%.6g counts beyond the target %.9g",
          sign * (now - end) * fabs(axis->position.scale), end);
    WATCH(sign * (now - before) >= -rounding, "%.6g counts back, at %.9g on the way to %.9g",
          sign * (before - now) * fabs(axis->position.scale), now, end);
}

/* What is still to be done goes on with all factors 1. */
static void let_it_end(int i)
{
    if (i == CYCLES)
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_set_override(axis, 1.0, 1.0, 1.0));
}

static void run_chain(unsigned seed)
{
    begin(seed);
    const double sign = one_in(2) ? 1.0 : -1.0;
    const unsigned rareness = 3 + (unsigned)pick(200);
    cm1e_command_id_t last;
    const double end = start_chain(sign, &last);
    double before = bench_info().set_position;
    for (int i = 0; i < 20 * CYCLES && bench_state_of(last) != CM1E_COMMAND_DONE; i++) {
        if (i < CYCLES && one_in(rareness))
            change_override();
        let_it_end(i);
        watch_cycles(1);
        judge(sign, before, bench_info().set_position, end);
        before = bench_info().set_position;
    }
    WATCH(bench_state_of(last) == CM1E_COMMAND_DONE, "the last move is not done at %.9g", before);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, end, before);
}

/* A second motion on top, the same way: the sum of both ends. */
static void run_superimposed(unsigned seed)
{
    begin(seed);
    const double sign = one_in(2) ? 1.0 : -1.0, first = sign * uniform(0.1, 12.0), more = sign * uniform(0.01, 3.0);
    const unsigned rareness = 3 + (unsigned)pick(100);
    const int when = pick(800);
    const cm1e_command_id_t move = bench_move_to(first, uniform(3.0, 20.0));
    cm1e_command_id_t on_top = 0;
    double before = bench_info().set_position, end = first;
    for (int i = 0; i < 20 * CYCLES && bench_info().state != CM1E_AXIS_STANDSTILL; i++) {
        const cm1e_axis_command_t command = {.kind = CM1E_COMMAND_MOVE_SUPERIMPOSED, .position = more,
                                             .velocity = uniform(1.0, 10.0),
                                             .acceleration = part_of(axis->limits.maximum.acceleration),
                                             .jerk = part_of(axis->limits.maximum.jerk)};
        if (i == when && bench_state_of(move) == CM1E_COMMAND_ACTIVE &&
            cm1e_axis_start(axis, &command, &on_top) == CM1E_OK)
            end += more;
        if (i < CYCLES && one_in(rareness))
            change_override();
        let_it_end(i);
        watch_cycles(1);
        judge(sign, before, bench_info().set_position, end);
        before = bench_info().set_position;
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, end, before);
}

/* Without a target there is none to pass, but the axis goes on in its direction: no change of a factor turns it. */
static void run_velocity(unsigned seed)
{
    begin(seed);
    const double sign = one_in(2) ? 1.0 : -1.0;
    const unsigned rareness = 3 + (unsigned)pick(200);
    double before = bench_info().set_position;
    for (int i = 0; i < CYCLES; i++) {
        const cm1e_command_kind_t kind = one_in(4) ? CM1E_COMMAND_HALT : CM1E_COMMAND_MOVE_VELOCITY;
        if (i == 0 || one_in(150))
            bench_start_command(&(cm1e_axis_command_t){.kind = kind, .velocity = sign * uniform(0.5, 20.0)});
        if (one_in(rareness))
            change_override();
        watch_cycles(1);
        judge(sign, before, bench_info().set_position, sign * INFINITY);
        before = bench_info().set_position;
    }
}

static void run_all(void (*run)(unsigned seed))
{
    const int runs = seed_count(RUNS);
    changes = 0;
    for (int i = 0; i < runs; i++)
        run(seed_of(i));
    printf("%d runs, %llu changes\n", runs, changes);
}

static void test_no_change_leads_beyond_the_target_or_back(void) { run_all(run_chain); }
static void test_no_change_leads_a_superimposed_motion_beyond_or_back(void) { run_all(run_superimposed); }
static void test_no_change_turns_a_velocity_round(void) { run_all(run_velocity); }

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_no_change_leads_beyond_the_target_or_back);
    RUN_TEST(test_no_change_leads_a_superimposed_motion_beyond_or_back);
    RUN_TEST(test_no_change_turns_a_velocity_round);
    return UNITY_END();
}
