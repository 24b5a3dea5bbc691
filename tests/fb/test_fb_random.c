/**
 * Random programs on one axis, millions of cycles: every block of the table with random inputs, nonsense among them, at
 * any time and in any order; power, directions, faults of the drive, lost frames. What must hold after every cycle:
 *
 *  - position, velocity, acceleration and jerk of the set-point keep the axis's limits, and fit together;
 *  - the motor follows: the drive is sent the set-point, and only under torque;
 *  - outputs of every block as PLCopen 2.4.1 says, one block Active at most (superimposed motions beside it);
 *  - the state goes only the ways of figure 2; a refused command changes nothing;
 *  - a move that is Done has arrived where it was to; nothing stands still for ever that should move;
 *  - in Standstill nothing moves, and without MC_Power or in ErrorStop the torque ends in time.
 *
 * CM1E_TEST_SEED=<n> repeats one run, CM1E_TEST_RUNS=<n> makes more of them.
 */
#include "block_bench.h"
#include "random_program.h"

enum { CYCLES = 20000, RUNS = 520, BATCHES = 8 };

static void prepare(unsigned seed)
{
    snprintf(judged.scene, sizeof judged.scene, "seed %u", seed);
    chance_seed(seed);
    bench_describe();
    fake_bus_init(&bench.bus, one_in(4) ? (cm1e_mapping_t)pick(4) : CM1E_MAPPING_DYNAMIC, (cm1e_pdo_order_t)pick(2),
                  (cm1e_firmware_t)pick(CM1E_FIRMWARE_COUNT));
    bench.bus.config.cycle_time_ns = judged.cycle_ns = one_in(3) ? cm1e_device_cycle_times_ns[pick(4)] : 1000000;
    bench.homing_cycles = 1 + pick(200);
    random_axis(&bench.bus.config.axes[0]);
    bench_make_axis();
    begin_program();
}

/* ---- faults -------------------------------------------------------------------------------------------------- */

static void act_on_device(void)
{
    cm1e_bus_t *bus = &bench.bus;
    bench.received = one_in(200) ? CM1E_ERROR_BUS_LOST : CM1E_OK;
    if (bench.health ? one_in(30) : one_in(15000))
        bench.health = bench.health ? CM1E_OK : CM1E_ERROR_BUS_LOST;
    if (bench.health)
        bench.received = bench.health;
    if (one_in(12000))
        fake_bus_fault(bus, cm1e_device_errors[(size_t)pick((int)cm1e_device_error_count)].code);
    if (bus->power ? one_in(15000) : one_in(60))
        bus->power = !bus->power;
    if (bus->blocked ? one_in(50) : one_in(15000))
        bus->blocked = !bus->blocked;
    if (one_in(300))
        bus->digital_inputs = (uint16_t)pick(16);
    if (bus->state != OPERATION_ENABLED && one_in(1000))
        bus->position += pick(20001) - 10000; /* somebody turns the shaft */
}

/* ---- what must hold after every cycle ---------------------------------------------------------------------------- */

static void time_passes(int64_t time_ns)
{
    for (int64_t left = time_ns; left > 0; left -= judged.cycle_ns)
        turn_shaft();
}

static bool has_torque(void) { return bench.bus.state == OPERATION_ENABLED; }
static bool is_deaf(void) { return bench.health != CM1E_OK; }

/** Under torque in its own mode the drive has what the axis wants; without, it has its own position. */
static void judge_motor(void)
{
    const cm1e_bus_t *bus = &bench.bus;
    const bool holding = bus->state == OPERATION_ENABLED && bus->mode == CM1E_MODE_CSP &&
                         fake_find(&bus->rx, OBJ_607A_TARGET_POSITION).bytes;
    if (!holding || bus->blocked)
        return;
    const double fastest = judged.axis->maximum.velocity * fabs(judged.axis->scale) * (double)judged.cycle_ns * 1e-9;
    const uint32_t target = fake_output(bus, OBJ_607A_TARGET_POSITION, 0);
    const double off = (double)(int32_t)(target - (uint32_t)bus->position);
    MUST(fabs(off) <= fastest + 1.01 + judged.axis->max_lag * fabs(judged.axis->scale),
         "the target is %.0f counts from the motor", off);
}

static void run(unsigned seed)
{
    prepare(seed);
    const int length = CYCLES / 2 + pick(CYCLES);
    for (int i = 0; i < length; i++)
        one_cycle();
    cycles_total += (unsigned long long)length;
}

START_TEST(test_random_programs_keep_every_rule)
{
    const char *more = getenv("CM1E_TEST_RUNS");
    const int runs = more ? atoi(more) : seed_count(RUNS);
    for (int i = _i; i < runs; i += BATCHES)
        run(seed_of(i));

    printf("batch %d: %llu cycles, %llu of them moving, %llu edges, %llu times Done\n", _i, cycles_total, watched.moving,
           edges_total, done_total);
    if (getenv("CM1E_TEST_SEED"))
        return;
    MUST(watched.moving > cycles_total / 8, "too wild to test anything");
    for (int state = 0; state < CM1E_AXIS_STATE_COUNT; state++)
        MUST(seen[state] > 0 || state == CM1E_AXIS_SYNCHRONIZED_MOTION, "never in %s",
             cm1e_axis_state_name((cm1e_axis_state_t)state));
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("random programs");
    TCase *all = tcase_create("all");
    tcase_set_timeout(all, 250);
    tcase_add_loop_test(all, test_random_programs_keep_every_rule, 0, getenv("CM1E_TEST_SEED") ? 1 : BATCHES);
    suite_add_tcase(suite, all);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
