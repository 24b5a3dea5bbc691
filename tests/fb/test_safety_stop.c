/**
 * The end of a run at every cycle of enabling, homing and a move: asked for (cm1e_scheduler_stop), asked for and then
 * disturbed, or not asked for: the master stands still for a while, or dies and is started again. The motor comes to
 * rest within its ramp, loses its torque in bounded time, and nothing moves by itself afterwards.
 */
#include <setjmp.h>

#include "core/in_task.h"
#include "safety_bench.h"

enum { AXIS = 0, LONGEST_RUN = 4000, AFTERWARDS_MS = 1000, WATCHDOG_MS = 100 };
static const double speed_u = 200, unit = 1000, homing_speed_u = 100, acceleration_u = 2000, jerk_u = 50000;

typedef struct variant {
    cm1e_mapping_t mapping;
    cm1e_pdo_order_t order;
    const char *firmware;
} variant_t;
static const variant_t variants[] = {
    {CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, "1.3.5"}, {CM1E_MAPPING_CSP, CM1E_PDO_ORDER_UG_7_2, "1.3.0"},
    {CM1E_MAPPING_CSV, CM1E_PDO_ORDER_UG_4_4, "1.3.3"},     {CM1E_MAPPING_PROFILE, CM1E_PDO_ORDER_UG_7_2, "1.3.2"},
    {CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_7_2, "1.2.0"},
};
enum { VARIANTS = sizeof variants / sizeof variants[0] };

static bench_t bench;

/* ---- the program: enable, home, move there and back -------------------------------------------------------------- */

static MC_Power_t power;
static MC_Home_t home;
static MC_MoveAbsolute_t there, back;
static bool finished;
static int event_cycle;
static void (*event)(void);   /* in that cycle, after the blocks */

static void program(bench_t *b)
{
    power.Enable = TRUE;
    MC_Power(&power);
    home.Execute = home.Execute || power.Status;
    MC_Home(&home);
    there.Execute = there.Execute || home.Done;
    MC_MoveAbsolute(&there);
    back.Execute = back.Execute || there.Done;
    MC_MoveAbsolute(&back);
    finished = finished || back.Done;
    if (b->cycle == event_cycle || finished || b->cycle == LONGEST_RUN)
        event();
}

static void prepare(const variant_t *variant, int cycle, void (*what)(void))
{
    cm1e_bus_config_free(&bench.config);
    memset(&bench, 0, sizeof bench);
    bench_describe(&bench, 1);
    cm1e_axis_config_t *axis = &bench.config.axes[AXIS];
    bench.config.sim_pdo_order = variant->order;
    axis->mapping = variant->mapping;
    axis->max_acceleration = acceleration_u;
    axis->max_jerk = jerk_u;
    axis->sim.stop_negative = -3000;
    axis->homing = (cm1e_homing_config_t){.method = -2, .velocity = homing_speed_u,
                                          .acceleration = acceleration_u, .torque = 30};
    snprintf(axis->firmware, sizeof axis->firmware, "%s", variant->firmware);
    power = (MC_Power_t){.Axis = &bench.axis[AXIS], .EnablePositive = TRUE, .EnableNegative = TRUE};
    home = (MC_Home_t){.Axis = &bench.axis[AXIS]};
    there = (MC_MoveAbsolute_t){.Axis = &bench.axis[AXIS], .Position = 30, .Velocity = speed_u};
    back = (MC_MoveAbsolute_t){.Axis = &bench.axis[AXIS], .Position = 5, .Velocity = speed_u};
    finished = false;
    event_cycle = cycle;
    event = what;
    bench.program = program;
    snprintf(bench.scene, sizeof bench.scene, "mapping %d, firmware %s, event at %d", (int)variant->mapping,
             variant->firmware, cycle);
}

static cm1e_clock_t *bench_clock(void) { return cm1e_bus_clock(bench.bus); }

/* ---- an orderly stop --------------------------------------------------------------------------------------------- */

static int64_t stop_ns;
static cm1e_sim_probe_t at_stop;
static uint64_t frames_at_stop;

static void stop(void)
{
    stop_ns = cm1e_clock_now(bench_clock());
    at_stop = bench_probe(&bench, AXIS);
    cm1e_sim_probe_reset(bench.segment, 1);
    frames_at_stop = bench.process_frames;
    cm1e_scheduler_stop(bench.scheduler);
}

/** A second passes: whatever is left to move would. */
static void judge_rest(const char *when)
{
    const cm1e_sim_probe_t before = bench_probe(&bench, AXIS);
    MUST(&bench, !before.torque_on, "%s: torque", when);
    cm1e_sim_segment_advance(bench.segment, cm1e_clock_now(bench_clock()) + AFTERWARDS_MS * INT64_C(1000000));
    const cm1e_sim_probe_t after = bench_probe(&bench, AXIS);
    MUST(&bench, !after.torque_on, "%s: torque came back", when);
    MUST(&bench, fabs(before.velocity_counts_per_s) > 0 || after.position_counts == before.position_counts,
         "%s: moved by itself", when);
}

/** Counts from there to rest: the ramp with its jerk (twice its bare length), or the drive's own; and some cycles. */
static double stopping_way(double speed)
{
    const double deceleration = acceleration_u * unit, jerk = jerk_u * unit;
    return speed * speed / (2 * deceleration) * 2 + speed * (deceleration / jerk + 0.06) + 200;
}

static void judge_stop(cm1e_error_t error, const cm1e_diag_t *diag)
{
    const double took_s = (double)(cm1e_clock_now(bench_clock()) - stop_ns) * 1e-9;
    const cm1e_sim_probe_t probe = bench_probe(&bench, AXIS);
    const double speed = fabs(at_stop.velocity_counts_per_s);
    MUST(&bench, error == CM1E_OK, "%s", diag->text);
    MUST(&bench, took_s < 2.5, "the stop took %.3f s", took_s);
    MUST(&bench, !bench.witness[AXIS].enabling, "the bus was stopped before the drive");
    /* An acceleration ends at the axis's jerk, and set-points are ahead of the motor by some cycles. */
    const double more = (acceleration_u * acceleration_u / (2 * jerk_u) + 0.006 * acceleration_u) * unit;
    MUST(&bench, probe.peak_velocity_counts_per_s <= speed * 1.1 + more, "%.0f counts/s after the stop, %.0f before",
         probe.peak_velocity_counts_per_s, speed);
    MUST(&bench, probe.travel_counts <= stopping_way(probe.peak_velocity_counts_per_s), "%.0f counts after the stop",
         probe.travel_counts);
    MUST(&bench, cm1e_sim_slave_al_state(cm1e_sim_segment_slave(bench.segment, 1)) == CM1E_AL_INIT, "not in Init");
    judge_rest("after the stop");
}

static cm1e_error_t run(cm1e_diag_t *diag)
{
    bench_open(&bench);
    bench_start(&bench);
    return bench_run(&bench, diag);
}

START_TEST(test_stop_at_every_cycle_ramps_down_and_disables)
{
    int runs = 0;
    const int stride = sweep_stride(_i ? 3 : 1, 29);
    for (int cycle = 0; !finished || runs == 0; cycle += stride, runs++) {
        cm1e_diag_t diag = {0};
        prepare(&variants[_i], cycle, stop);
        judge_stop(run(&diag), &diag);
        MUST(&bench, bench.cycle < LONGEST_RUN, "the program did not come to its end");
        bench_close(&bench);
    }
    printf("mapping %d, firmware %s: stopped at %d cycles\n", (int)variants[_i].mapping, variants[_i].firmware, runs);
}
END_TEST

/* ---- an orderly stop with disorder ------------------------------------------------------------------------------- */

typedef enum disorder { ONE_FRAME = 0, SOME_FRAMES, ALL_FRAMES, SOME_COUNTERS, POWER_OFF, DRIVE_ERROR, UNPLUGGED,
                        POWER_CYCLED, DISORDERS } disorder_t;
static disorder_t disorder;
static uint64_t disorder_frame;
static bool disorder_done;

static cm1e_tap_verdict_t disturb(bench_t *b, cm1e_tap_frame_t *frame)
{
    static const char *const lines[DISORDERS] = {[POWER_OFF] = "power 1 off", [DRIVE_ERROR] = "error 1 2310",
                                                 [UNPLUGGED] = "unplug 1", [POWER_CYCLED] = "power-cycle 1 30"};
    static const uint64_t lengths[DISORDERS] = {[ONE_FRAME] = 1, [SOME_FRAMES] = 12, [SOME_COUNTERS] = 12,
                                                [ALL_FRAMES] = UINT64_MAX};
    if (frames_at_stop == 0 || b->process_frames < frames_at_stop + disorder_frame)
        return CM1E_TAP_PASS;
    if (lines[disorder] && !disorder_done)
        bench_console(b, "%s", lines[disorder]);
    disorder_done = true;
    if (frame->direction == CM1E_TAP_SENT || b->process_frames - frames_at_stop - disorder_frame >= lengths[disorder])
        return CM1E_TAP_PASS;
    if (disorder == SOME_COUNTERS)
        cm1e_frame_change_working_counter(frame->bytes, frame->length, 0, -1);
    return disorder == SOME_COUNTERS ? CM1E_TAP_PASS : CM1E_TAP_DROP;
}

static void judge_disturbed(cm1e_error_t error, const cm1e_diag_t *diag, bool watchdog)
{
    const double took_s = (double)(cm1e_clock_now(bench_clock()) - stop_ns) * 1e-9;
    const cm1e_sim_probe_t probe = bench_probe(&bench, AXIS);
    const double speed = fabs(at_stop.velocity_counts_per_s), coast = 30000;
    MUST(&bench, error == CM1E_OK, "%s", diag->text);
    MUST(&bench, took_s < 4.0, "the stop took %.3f s", took_s);
    const double more = home.Busy ? homing_speed_u * unit : 0.6 * speed + 2500; /* deaf, it goes on with its homing */
    MUST(&bench, probe.peak_velocity_counts_per_s <= speed * 1.1 + more, "%.0f counts/s after the stop, %.0f before",
         probe.peak_velocity_counts_per_s, speed);
    MUST(&bench, probe.travel_counts <= stopping_way(probe.peak_velocity_counts_per_s) + coast,
         "%.0f counts after the stop", probe.travel_counts);
    if (disorder == UNPLUGGED && !watchdog)
        return; /* UG 10.1: nothing stops this one */
    cm1e_sim_segment_advance(bench.segment, cm1e_clock_now(bench_clock()) + 2 * WATCHDOG_MS * INT64_C(1000000));
    judge_rest("after the disturbed stop");
}

START_TEST(test_disturbed_stop_still_ends_without_torque)
{
    const variant_t *variant = &variants[_i / DISORDERS];
    const bool watchdog = strcmp(variant->firmware, "1.2.0") != 0;
    const int stride = sweep_stride(3, 23);
    disorder = (disorder_t)(_i % DISORDERS);
    for (int phase = 0; phase < 2; phase++) /* in the middle of homing, and of the move */
        for (disorder_frame = 0; disorder_frame < 160; disorder_frame += (uint64_t)stride) {
            cm1e_diag_t diag = {0};
            prepare(variant, phase ? 480 : 90, stop);
            bench.fault = disturb;
            frames_at_stop = 0;
            disorder_done = false;
            const size_t used = strlen(bench.scene);
            snprintf(bench.scene + used, sizeof bench.scene - used, ", disorder %d after %u frames", (int)disorder,
                     (unsigned)disorder_frame);
            judge_disturbed(run(&diag), &diag, watchdog);
            bench_close(&bench);
        }
}
END_TEST

/* ---- a master that stands still for a while ---------------------------------------------------------------------- */

static int64_t stall_ns;
static double fastest_after, speed_before;
static int stalled_at;
static cm1e_sim_probe_t after_stall, settled;

static void watch_after_stall(bench_t *b)
{
    if (stalled_at < 0) {
        program(b);
        return;
    }
    const cm1e_sim_probe_t probe = bench_probe(b, AXIS);
    fastest_after = fmax(fastest_after, fabs(probe.velocity_counts_per_s));
    program(b);
    if (b->cycle == stalled_at + 500)
        settled = probe;
    if (b->cycle == stalled_at + 700)
        cm1e_scheduler_stop(b->scheduler);
}

static void stall(void)
{
    if (stalled_at >= 0)
        return;
    stalled_at = bench.cycle;
    speed_before = fabs(bench_probe(&bench, AXIS).velocity_counts_per_s);
    bench_miss(&bench, stall_ns);
    cm1e_sim_segment_advance(bench.segment, cm1e_clock_now(bench_clock()));
    after_stall = bench_probe(&bench, AXIS);
    fastest_after = fabs(after_stall.velocity_counts_per_s);
}

static void judge_stall(bool watchdog)
{
    const cm1e_axis_info_t info = bench_info(&bench, AXIS);
    const cm1e_sim_probe_t probe = bench_probe(&bench, AXIS);
    char text[512];
    const bool expired = watchdog && stall_ns > (WATCHDOG_MS + 2) * INT64_C(1000000);
    MUST(&bench, !expired || !after_stall.torque_on, "torque although the watchdog's time is over");
    const double allowed = 1.1;
    MUST(&bench, fastest_after <= fmax(speed_u * unit * allowed, speed_before * 1.2) + 3000,
         "%.0f counts/s after the stall, %.0f before", fastest_after, speed_before);
    if (info.state != CM1E_AXIS_ERROR_STOP)
        return;
    cm1e_axis_error_text(bench.axis[AXIS], text, sizeof text);
    MUST(&bench, strlen(text) > 60 && strstr(text, cm1e_axis_name(bench.axis[AXIS])), "\"%s\"", text);
    MUST(&bench, !probe.torque_on && fabs(probe.position_counts - settled.position_counts) < 1,
         "ErrorStop, but torque %d, moved by %.1f counts", probe.torque_on,
         probe.position_counts - settled.position_counts);
}

START_TEST(test_master_that_stands_still_for_a_while_makes_nothing_jump)
{
    static const int64_t stalls_ms[] = {2, 7, 40, 98, 105, 150, 600, 5000};
    const variant_t *variant = &variants[_i];
    const int stride = sweep_stride(17, 101);
    for (size_t s = 0; s < sizeof stalls_ms / sizeof stalls_ms[0]; s++)
        for (int cycle = 3 + (int)s; cycle < 900; cycle += stride) {
            cm1e_diag_t diag = {0};
            prepare(variant, cycle, stall);
            bench.program = watch_after_stall;
            stall_ns = stalls_ms[s] * 1000000;
            stalled_at = -1;
            const size_t used = strlen(bench.scene);
            snprintf(bench.scene + used, sizeof bench.scene - used, ", %d ms", (int)stalls_ms[s]);
            const cm1e_error_t error = run(&diag);
            MUST(&bench, error == CM1E_OK, "%s", diag.text);
            judge_stall(strcmp(variant->firmware, "1.2.0") != 0);
            judge_rest("after the stall");
            bench_close(&bench);
        }
}
END_TEST

/* ---- a master that dies, and the next one ------------------------------------------------------------------------ */

static jmp_buf death;

static void die(void) { longjmp(death, 1); }

/** The dead master's segment, which the next one finds. */
static struct {
    cm1e_sim_segment_t *segment;
    int64_t offset_ns;
} wire;

/** The second master's own segment is by-passed: its frames go to the first one's. */
static cm1e_tap_verdict_t bypass(void *context, cm1e_tap_frame_t *frame)
{
    bench_t *b = context;
    if (frame->direction == CM1E_TAP_RECEIVED)
        return bench_tap(context, frame);
    if (bench_tap(context, frame) == CM1E_TAP_DROP)
        return CM1E_TAP_DROP;
    cm1e_nic_t *nic = cm1e_bus_nic(b->bus);
    const int64_t now_ns = cm1e_clock_now(cm1e_nic_clock(nic));
    if (cm1e_sim_segment_process(wire.segment, 0, frame->bytes, frame->length, wire.offset_ns + now_ns) == 0)
        cm1e_nic_inject(nic, 0, frame->bytes, frame->length, now_ns + 20000);
    return CM1E_TAP_DROP;
}

static void judge_death(bool watchdog)
{
    const int64_t now_ns = cm1e_clock_now(bench_clock()), ms = 1000000;
    cm1e_sim_segment_advance(bench.segment, now_ns + (WATCHDOG_MS + 2) * ms);
    MUST(&bench, !watchdog || !bench_probe(&bench, AXIS).torque_on, "torque after the watchdog's time");
    cm1e_sim_segment_advance(bench.segment, now_ns + 900 * ms);
    wire.offset_ns = now_ns + 900 * ms;
    wire.segment = bench.segment;
}

/** Starts, enables and moves as if nothing had been; before its own Enable nothing moves. */
static void next_master_program(bench_t *b)
{
    const cm1e_sim_probe_t probe = bench_probe(b, AXIS);
    power.Enable = b->cycle >= 100;
    MC_Power(&power);
    there.Execute = there.Execute || (power.Status && b->cycle > 200);
    MC_MoveAbsolute(&there);
    if (b->cycle == 99)
        cm1e_sim_probe_reset(b->segment, 1);
    MUST(b, b->cycle > 99 || !probe.torque_on, "the next master: torque before Enable");
    MUST(b, there.Execute || b->cycle < 100 || probe.travel_counts < 3, "the next master: moved by %.1f counts",
         probe.travel_counts);
    MUST(b, b->cycle < 1500, "the next master: did not come to its end: state %s",
         cm1e_axis_state_name(bench_info(b, AXIS).state));
    if (there.Done)
        cm1e_scheduler_stop(b->scheduler);
}

static void start_next_master(void)
{
    cm1e_diag_t diag = {0};
    bench.program = next_master_program;
    power = (MC_Power_t){.Axis = &bench.axis[AXIS], .EnablePositive = TRUE, .EnableNegative = TRUE};
    there = (MC_MoveAbsolute_t){.Axis = &bench.axis[AXIS], .Velocity = speed_u};
    bench_open(&bench);
    bench.segment = wire.segment;
    cm1e_nic_set_tap(cm1e_bus_nic(bench.bus), bypass, &bench);
    bench_start(&bench);
    there.Position = bench_info(&bench, AXIS).actual_position + 5;
    const cm1e_error_t error = bench_run(&bench, &diag);
    MUST(&bench, error == CM1E_OK, "the next master: %s", diag.text);
    MUST(&bench, !bench_probe(&bench, AXIS).torque_on, "the next master: torque at the end");
    bench_close(&bench);
}

/** Comes back by longjmp(), which leaves nothing sure of variables beside it. */
static void run_until_death(void)
{
    cm1e_diag_t diag = {0};
    if (setjmp(death) == 0) {
        run(&diag);
        bench_fail(&bench, "came to an end: %s", diag.text);
    }
    cm1e_in_task_end(); /* of the task that it died in; the next master is another process */
}

START_TEST(test_master_dies_at_every_cycle_and_the_next_one_starts)
{
    const variant_t *variant = &variants[_i];
    const int stride = sweep_stride(5, 67);
    for (int cycle = 0; cycle < 900; cycle += stride) {
        prepare(variant, cycle, die);
        run_until_death();
        cm1e_bus_t *const dead = bench.bus;
        judge_death(strcmp(variant->firmware, "1.2.0") != 0);
        cm1e_scheduler_t *const dead_scheduler = bench.scheduler;
        start_next_master();
        cm1e_bus_close(dead); /* and with it the segment, and the transfers that lie in the axes */
        cm1e_scheduler_destroy(dead_scheduler);
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("ends of a run");
    TCase *cases = tcase_create("stop");
    tcase_set_timeout(cases, 250);
    tcase_add_loop_test(cases, test_stop_at_every_cycle_ramps_down_and_disables, 0, VARIANTS);
    tcase_add_loop_test(cases, test_disturbed_stop_still_ends_without_torque, 0, VARIANTS * DISORDERS);
    tcase_add_loop_test(cases, test_master_that_stands_still_for_a_while_makes_nothing_jump, 0, VARIANTS);
    tcase_add_loop_test(cases, test_master_dies_at_every_cycle_and_the_next_one_starts, 0, VARIANTS);
    suite_add_tcase(suite, cases);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int count = srunner_ntests_failed(runner);
    srunner_free(runner);
    return count ? EXIT_FAILURE : EXIT_SUCCESS;
}
