/**
 * The random programs of test_fb_random.c on the simulated segment, with real frames and a simulated drive behind them:
 * the same rules, and the simulated motor follows the set-point. Faults come from the simulator's console and are those
 * that test_safety_random.c makes, which judges what is sent to the drives.
 *
 * CM1E_TEST_SEED=<n> repeats one run, CM1E_TEST_RUNS=<n> makes more of them.
 */
#include "block_judge.h"
#include "bus/bus_image.h"
#include "nic/nic.h"

static struct bench {
    cm1e_bus_t *bus;
    MC_Power_t power;
    cm1e_sim_segment_t *segment;
    cm1e_axis_info_t info;
    int64_t start_ns, disturbed_until;
    bool faulty;                    /**< a fault has not been healed yet */
} bench;

static void cycle_begin(void)
{
    const int64_t planned_ns = bench.start_ns + judged.number * judged.cycle_ns;
    cm1e_clock_sleep_until(cm1e_bus_clock(bench.bus), planned_ns);
    const cm1e_error_t received = cm1e_bus_receive(bench.bus);
    cm1e_axis_inputs(judged.axis, received, cm1e_bus_health(bench.bus), planned_ns);
    judge_cycle();
    MC_Power(&bench.power);
    judged.state = judged.axis->state;
}

static void cycle_end(void)
{
    cm1e_axis_outputs(judged.axis);
    cm1e_bus_send(bench.bus);
    judge_cycle();
    watch_set_point();
    cm1e_axis_get(judged.axis, &bench.info);
    judged.number++;
}

#include "random_program.h"

enum { CYCLES = 20000, RUNS = 32, BATCHES = 4 };

static cm1e_sim_probe_t probe(void)
{
    cm1e_sim_probe_t now;
    cm1e_sim_probe(bench.segment, 1, &now);
    return now;
}

static void time_passes(int64_t time_ns)
{
    cm1e_clock_t *clock = cm1e_bus_clock(bench.bus);
    bench.start_ns += time_ns;
    cm1e_clock_sleep_until(clock, cm1e_clock_now(clock) + time_ns);
}

static bool has_torque(void) { return probe().torque_on; }
static bool is_deaf(void) { return cm1e_bus_health(bench.bus) != CM1E_OK; }

/* ---- faults ------------------------------------------------------------------------------------------------------ */

__attribute__((format(printf, 1, 2))) static void console(const char *format, ...)
{
    char line[96], answer[256] = "";
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    MUST(cm1e_bus_simulate(bench.bus, line, answer, sizeof answer) == CM1E_OK, "%s: %s", line, answer);
}

static void make_fault(void)
{
    switch (pick(7)) {
    case 0: console("power 1 off"); break;
    case 1: console("error 1 %04X", cm1e_device_errors[(size_t)pick((int)cm1e_device_error_count)].code); break;
    case 2: console("over-torque 1"); break;
    case 3: console("load 1 %g", uniform(-0.5, 0.5)); break;
    case 4: console("lose %d", 1 + pick(3)); break;
    case 5: console("sensor 1 %d on", 1 + pick(4)); break;
    default: console("unplug 1"); break;
    }
}

static void heal(void)
{
    console("power 1 on");
    console("error 1 clear");
    console("load 1 0");
    console("replug 1");
    for (int input = 1; input <= 4; input++)
        console("sensor 1 %d auto", input);
}

static void act_on_device(void)
{
    if (one_in(4000)) {
        make_fault();
        bench.faulty = true;
    }
    if (bench.faulty)
        bench.disturbed_until = judged.number + 1000;
    if (one_in(400)) {
        heal();
        bench.faulty = false;
    }
}

/* ---- what must hold ---------------------------------------------------------------------------------------------- */

/** A motor that nobody disturbs follows closely: what the servo lags by at its acceleration, and two cycles of way. */
static void judge_motor(void)
{
    const bool moved_by_us = set_point_is_ours() && cm1e_axis_powered(judged.axis) && bench.info.mode == CM1E_MODE_CSP;
    const int64_t soon = judged.number + 200;
    if ((!moved_by_us || judged.axis->state == CM1E_AXIS_ERROR_STOP) && bench.disturbed_until < soon)
        bench.disturbed_until = soon;
    if (judged.number < bench.disturbed_until)
        return;
    const double counts = fabs(judged.axis->scale), cycle_s = (double)judged.cycle_ns * 1e-9;
    const double allowed = 300 + 4 * watch.most.velocity * counts * cycle_s;
    MUST(fabs(bench.info.position_lag) * counts <= allowed, "%s: the motor lags by %.0f counts, %.0f allowed",
         cm1e_axis_state_name(judged.axis->state), bench.info.position_lag * counts, allowed);
}

/* ---- a run ------------------------------------------------------------------------------------------------------- */

static void prepare(unsigned seed)
{
    static cm1e_bus_config_t config;
    cm1e_diag_t diag = {0};
    snprintf(judged.scene, sizeof judged.scene, "seed %u", seed);
    chance_seed(seed);
    memset(&bench, 0, sizeof bench);
    cm1e_bus_config_init(&config, "sim", 1);
    config.virtual_time = true;
    config.sim_pdo_order = (cm1e_pdo_order_t)pick(2);
    config.cycle_time_ns = judged.cycle_ns = one_in(3) ? cm1e_device_cycle_times_ns[pick(4)] : 1000000;
    cm1e_axis_config_t *axis = &config.axes[0];
    random_axis(axis);
    const double counts = axis->counts_per_unit > 0
                              ? axis->counts_per_unit
                              : CM1E_COUNTS_PER_REVOLUTION / 360.0 * axis->gear_numerator / axis->gear_denominator;
    axis->max_velocity = 1e6 / counts;
    axis->max_acceleration = axis->max_deceleration = 0; /* 5e6 counts/s2, which every motor can do */
    axis->sim.no_stops = true;
    MUST(cm1e_bus_open(&bench.bus, &config, &diag) == CM1E_OK, "%s", diag.text);
    MUST(cm1e_bus_start(bench.bus, &diag) == CM1E_OK, "%s", diag.text);
    MUST(cm1e_axis_create(&judged.axis, bench.bus, 0, &diag) == CM1E_OK, "%s", diag.text);
    bench.segment = cm1e_nic_segment(cm1e_bus_nic(bench.bus));
    judged.reference = cm1e_axis_reference(judged.axis);
    judged.state = CM1E_AXIS_DISABLED;
    judged.reset_asked = false;
    judged.number = 0;
    watch.ours = false;
    bench.power = (MC_Power_t){.Axis = &judged.reference, .EnablePositive = TRUE, .EnableNegative = TRUE};
    bench.start_ns = cm1e_clock_now(cm1e_bus_clock(bench.bus));
    begin_blocks();
    begin_program();
}

static void run(unsigned seed)
{
    prepare(seed);
    const int length = CYCLES / 2 + pick(CYCLES);
    for (int i = 0; i < length; i++)
        one_cycle();
    cycles_total += (unsigned long long)length;
    cm1e_bus_stop(bench.bus);
    MUST(!has_torque() || judged.number < bench.disturbed_until, "torque after the end");
    cm1e_axis_destroy(judged.axis);
    cm1e_bus_close(bench.bus);
}

START_TEST(test_random_programs_on_the_segment_keep_every_rule)
{
    const char *more = getenv("CM1E_TEST_RUNS");
    const int runs = more ? atoi(more) : seed_count(RUNS);
    for (int i = _i; i < runs; i += BATCHES)
        run(seed_of(i));
    printf("batch %d: %llu cycles, %llu of them moving, %llu edges, %llu times Done\n", _i, cycles_total, watch.moving,
           edges_total, done_total);
    if (!getenv("CM1E_TEST_SEED") && runs >= RUNS)
        MUST(watch.moving > cycles_total / 8, "too wild to test anything");
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("random programs on the segment");
    TCase *all = tcase_create("all");
    tcase_set_timeout(all, 250);
    tcase_add_loop_test(all, test_random_programs_on_the_segment_keep_every_rule, 0,
                        getenv("CM1E_TEST_SEED") ? 1 : BATCHES);
    suite_add_tcase(suite, all);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
