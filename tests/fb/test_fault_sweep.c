/**
 * One fault at every cycle of start-up, enabling, homing and a move, on virtual time: each run ends in a defined state
 * with a right error text, and no run moves the simulated motor after the fault beyond its stopping ramp.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bus/bus_image.h"
#include "cm1e/plcopen.h"
#include "cm1e/scheduler.h"
#include "cm1e/sim.h"
#include "effort.h"
#include "nic/nic.h"
#include "quick_check.h"

enum { CYCLE_NS = 1000000, SETTLE_CYCLES = 400, MAX_CYCLES = 4000 };

/* Every sweep runs on each of these. */
static const struct {
    cm1e_pdo_order_t pdo_order;
    const char *firmware;
    bool watchdog; /* UG 10.1: since V1.3.0 the motor stops by itself when process data stay away */
} devices[] = {
    {CM1E_PDO_ORDER_UG_4_4, "1.3.5", true},
    {CM1E_PDO_ORDER_UG_7_2, "1.3.5", true},
    {CM1E_PDO_ORDER_UG_4_4, "1.2.0", false},
    {CM1E_PDO_ORDER_UG_7_2, "1.2.0", false},
};
enum { DEVICE_COUNT = sizeof devices / sizeof devices[0] };
static int device;

/* ---- faults ------------------------------------------------------------------------------------------------------- */

typedef enum fault_kind {
    FAULT_NONE = 0,
    FAULT_FRAME_LOST,        /**< one frame does not come back */
    FAULT_FRAMES_LOST,       /**< none comes back any more */
    FAULT_WORKING_COUNTER,   /**< one frame comes back with a wrong working counter */
    FAULT_WORKING_COUNTERS,  /**< all do from then on */
    FAULT_POWER_OFF,         /**< motor power is switched off */
    FAULT_SLAVE_GONE,        /**< the slave's cable is pulled */
    FAULT_COUNT,
} fault_kind_t;

/** How a run may end, and what its text must say then. */
static const struct {
    const char *name;
    bool must_fail;       /**< FALSE: the run may also succeed (a single bad frame is ridden out) */
    bool must_succeed;
    const char *console;  /**< acts through the segment's console; NULL: through the tap */
    cm1e_error_t errors[6];
    const char *word;     /**< in the text of the error */
} faults[FAULT_COUNT] = {
    [FAULT_NONE] = {"none", false, true, NULL, {0}, ""},
    [FAULT_FRAME_LOST] = {"a frame lost", false, true, NULL, {0}, ""},
    [FAULT_FRAMES_LOST] = {"all frames lost", true, false, NULL, {CM1E_ERROR_BUS_LOST}, "frame"},
    [FAULT_WORKING_COUNTER] = {"a working counter wrong", false, true, NULL, {0}, ""},
    [FAULT_WORKING_COUNTERS] = {"all working counters wrong", true, false, NULL, {CM1E_ERROR_BUS_WORKING_COUNTER},
                                "working counter"},
    [FAULT_POWER_OFF] = {"motor power off", true, false, "power 1 off",
                         {CM1E_ERROR_DRIVE_POWER, CM1E_ERROR_DRIVE_FAULT}, "power"},
    [FAULT_SLAVE_GONE] = {"slave gone", true, false, "unplug 1",
                          {CM1E_ERROR_BUS_LOST, CM1E_ERROR_BUS_WORKING_COUNTER, CM1E_ERROR_AXIS_OFFLINE}, ""},
};

/** Process data frames start with an LRW datagram. */
static bool is_process_data(const cm1e_tap_frame_t *frame) { return frame->length > 16 && frame->bytes[16] == 12; }

typedef struct tap_fault {
    fault_kind_t kind;
    bool armed;
} tap_fault_t;

static cm1e_tap_verdict_t tap(void *context, cm1e_tap_frame_t *frame)
{
    tap_fault_t *fault = context;
    if (!fault->armed || frame->direction != CM1E_TAP_RECEIVED)
        return CM1E_TAP_PASS;
    switch (fault->kind) {
    case FAULT_FRAME_LOST:
        if (is_process_data(frame)) {
            fault->armed = false;
            return CM1E_TAP_DROP;
        }
        return CM1E_TAP_PASS;
    case FAULT_FRAMES_LOST:
        return CM1E_TAP_DROP;
    case FAULT_WORKING_COUNTER:
    case FAULT_WORKING_COUNTERS:
        if (is_process_data(frame)) {
            cm1e_frame_change_working_counter(frame->bytes, frame->length, 0, -1);
            fault->armed = fault->kind == FAULT_WORKING_COUNTERS;
        }
        return CM1E_TAP_PASS;
    default:
        return CM1E_TAP_PASS;
    }
}

/* ---- the program -------------------------------------------------------------------------------------------------- */

typedef enum phase { PHASE_ENABLE, PHASE_HOME, PHASE_MOVE, PHASE_DONE, PHASE_COUNT } phase_t;
static const char *const phase_names[] = {"enable", "homing", "move", "after the move"};

typedef struct run {
    fault_kind_t kind;
    int fault_cycle;
    cm1e_bus_t *bus;
    cm1e_scheduler_t *scheduler;
    AXIS_REF_t axis;
    MC_Power_t power;
    MC_Home_t home;
    MC_MoveAbsolute_t move;
    tap_fault_t tap_fault;
    int cycle, end_cycle;
    phase_t phase, fault_phase;
    cm1e_sim_probe_t at_fault, settled, at_end;
    cm1e_axis_info_t info;
    char text[512];
} run_t;

static cm1e_sim_segment_t *segment(const run_t *run) { return cm1e_bus_segment(run->bus); }

static void inject(run_t *run)
{
    char answer[256];
    run->fault_phase = run->phase;
    cm1e_sim_probe(segment(run), 1, &run->at_fault);
    cm1e_sim_probe_reset(segment(run), 1);
    run->tap_fault = (tap_fault_t){run->kind, true};
    if (faults[run->kind].console)
        ck_assert_msg(cm1e_bus_simulate(run->bus, faults[run->kind].console, answer, sizeof answer) == CM1E_OK, "%s",
                      answer);
}

static void check_outputs(const run_t *run)
{
    ck_assert_int_le(run->home.Done + run->home.Busy + run->home.CommandAborted + run->home.Error, 1);
    ck_assert_int_le(run->move.Done + run->move.Busy + run->move.CommandAborted + run->move.Error, 1);
    if (run->home.Execute)
        ck_assert_int_eq(run->home.Done + run->home.Busy + run->home.CommandAborted + run->home.Error, 1);
    if (run->move.Execute)
        ck_assert_int_eq(run->move.Done + run->move.Busy + run->move.CommandAborted + run->move.Error, 1);
}

static void program(void *context)
{
    run_t *run = context;
    if (run->cycle == run->fault_cycle)
        inject(run);
    run->power.Enable = TRUE;
    MC_Power(&run->power);
    run->home.Execute = run->phase >= PHASE_HOME;
    MC_Home(&run->home);
    run->move.Execute = run->phase >= PHASE_MOVE;
    MC_MoveAbsolute(&run->move);
    check_outputs(run);
    cm1e_axis_read(run->axis, &run->info);
    if (run->phase == PHASE_ENABLE && run->power.Status)
        run->phase = PHASE_HOME;
    else if (run->phase == PHASE_HOME && run->home.Done)
        run->phase = PHASE_MOVE;
    else if (run->phase == PHASE_MOVE && run->move.Done)
        run->phase = PHASE_DONE;
    const bool over = run->phase == PHASE_DONE || run->info.state == CM1E_AXIS_ERROR_STOP;
    if (over && run->cycle > run->fault_cycle && run->end_cycle == 0)
        run->end_cycle = run->cycle + SETTLE_CYCLES;
    if (run->end_cycle && run->cycle == run->end_cycle - SETTLE_CYCLES / 4) {
        cm1e_sim_probe(segment(run), 1, &run->settled);
        cm1e_axis_error_text(run->axis, run->text, sizeof run->text);
    }
    if (run->cycle++ == MAX_CYCLES || (run->end_cycle && run->cycle == run->end_cycle)) {
        cm1e_sim_probe(segment(run), 1, &run->at_end);
        cm1e_scheduler_stop(run->scheduler);
    }
}

/* ---- one run ------------------------------------------------------------------------------------------------------ */

static void describe(cm1e_bus_config_t *config)
{
    cm1e_bus_config_free(config);
    cm1e_bus_config_init(config, "sim", 1);
    config->virtual_time = true;
    config->cycle_time_ns = CYCLE_NS;
    config->overlap = getenv("CM1E_TEST_OVERLAP") != NULL;
    config->sim_pdo_order = devices[device].pdo_order;
    cm1e_axis_config_t *axis = &config->axes[0];
    snprintf(axis->firmware, sizeof axis->firmware, "%s", devices[device].firmware);
    axis->counts_per_unit = 1000;
    axis->homing = (cm1e_homing_config_t){.method = -2, .velocity = 100, .acceleration = 2000, .torque = 30};
    axis->sim.stop_negative = -3000;
}

static void start(run_t *run, fault_kind_t kind, int fault_cycle)
{
    static cm1e_bus_config_t config;
    cm1e_diag_t diag = {0};
    *run = (run_t){.kind = kind, .fault_cycle = fault_cycle};
    describe(&config);
    ck_assert_msg(cm1e_bus_open(&run->bus, &config, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_msg(cm1e_bus_start(run->bus, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_msg(cm1e_scheduler_create(&run->scheduler, run->bus, NULL, &diag) == CM1E_OK, "%s", diag.text);
    const cm1e_task_config_t task = {.program = program, .context = run};
    ck_assert(cm1e_scheduler_add_task(run->scheduler, &task, &diag) == CM1E_OK);
    run->axis = cm1e_scheduler_axis(run->scheduler, 0);
    run->power = (MC_Power_t){.Axis = &run->axis, .EnablePositive = TRUE, .EnableNegative = TRUE};
    run->home = (MC_Home_t){.Axis = &run->axis};
    run->move = (MC_MoveAbsolute_t){.Axis = &run->axis, .Position = 8, .Velocity = 100, .Acceleration = 2000};
    cm1e_nic_set_tap(cm1e_bus_nic(run->bus), tap, &run->tap_fault);
}

/** Counts that the shaft may travel after the fault: while the fault is noticed, on the ramp, or coasting without
 *  torque, and for homing, which is the drive's own, until its process data watchdog stops it. */
static double allowed_travel(const run_t *run)
{
    const double notice_s = 0.010, watchdog_s = 0.110, top_speed = 100000.0;
    const double speed = run->fault_phase == PHASE_ENABLE ? 0 : top_speed;
    const bool drive_goes_on = run->fault_phase == PHASE_HOME || run->kind == FAULT_FRAMES_LOST
                               || run->kind == FAULT_SLAVE_GONE;
    const double inertia = 2e-6 + 5e-6, friction = 0.005, rad_per_s = top_speed / 50000.0 * 6.2832;
    /* A ramp from top speed that the axis's jerk (1e8 counts/s3) rules: twice sqrt(v / j) long, at half the speed. */
    const double ramp = speed * sqrt(speed / 1e8);
    const double coast = inertia * rad_per_s * rad_per_s / (2 * friction) / 6.2832 * 50000.0;
    return 50 + speed * (drive_goes_on ? watchdog_s : notice_s) + (speed > 0 ? coast + ramp : 0);
}

static void check_end(const run_t *run)
{
    const char *name = faults[run->kind].name, *phase = phase_names[run->fault_phase];
    const bool failed = run->info.state == CM1E_AXIS_ERROR_STOP;
    ck_assert_msg(run->cycle <= MAX_CYCLES, "%s at cycle %d (%s): the run did not end", name, run->fault_cycle, phase);
    ck_assert_msg(!(failed && faults[run->kind].must_succeed), "%s at cycle %d (%s): failed: %s", name,
                  run->fault_cycle, phase, run->text);
    ck_assert_msg(failed || !faults[run->kind].must_fail, "%s at cycle %d (%s): not noticed, state %s", name,
                  run->fault_cycle, phase, cm1e_axis_state_name(run->info.state));
    if (!failed) {
        ck_assert_msg(fabs(run->at_end.velocity_counts_per_s) < 500, "%s at cycle %d: still moving", name,
                      run->fault_cycle);
        ck_assert_double_eq_tol(run->info.actual_position, 8.0, 0.05);
        return;
    }
    bool right = false;
    for (int i = 0; faults[run->kind].errors[i] != CM1E_OK; i++)
        right = right || run->info.error == faults[run->kind].errors[i];
    ck_assert_msg(right && strstr(run->text, faults[run->kind].word) && strlen(run->text) > 20,
                  "%s at cycle %d (%s): error %d, text \"%s\"", name, run->fault_cycle, phase, run->info.error,
                  run->text);
    /* Nothing reaches the drive any more, and it has no watchdog: it goes on with what it was told last. */
    if ((run->kind == FAULT_FRAMES_LOST || run->kind == FAULT_SLAVE_GONE) && !devices[device].watchdog)
        return;
    ck_assert_msg(run->at_end.travel_counts <= allowed_travel(run), "%s at cycle %d (%s): travelled %.0f of %.0f", name,
                  run->fault_cycle, phase, run->at_end.travel_counts, allowed_travel(run));
    ck_assert_msg(run->at_end.travel_counts - run->settled.travel_counts < 20,
                  "%s at cycle %d (%s): moves on after it stopped, %.0f counts", name, run->fault_cycle, phase,
                  run->at_end.travel_counts - run->settled.travel_counts);
    ck_assert_msg(!run->at_end.torque_on, "%s at cycle %d (%s): torque is still on", name, run->fault_cycle, phase);
}

static void finish(run_t *run)
{
    cm1e_diag_t diag = {0};
    cm1e_scheduler_run(run->scheduler, 0, &diag);
    check_end(run);
    cm1e_scheduler_destroy(run->scheduler);
    cm1e_bus_close(run->bus);
}

/** Cycles that a run without a fault takes. */
static int clean_run_cycles(void)
{
    static run_t run;
    start(&run, FAULT_NONE, 0);
    finish(&run);
    ck_assert_int_eq(run.phase, PHASE_DONE);
    return run.end_cycle - SETTLE_CYCLES;
}

static void sweep(fault_kind_t kind)
{
    static run_t run;
    int phases[PHASE_COUNT] = {0};
    const int cycles = clean_run_cycles();
    const int stride = slowness(), first = sweep_first(device * 3 + (int)kind, stride);
    int runs = 0;
    phase_t phase = PHASE_ENABLE; /* so short that none of its cycles is left out */
    for (int cycle = 0; cycle < cycles; cycle++) {
        if (phase != PHASE_ENABLE && cycle % stride != first)
            continue;
        start(&run, kind, cycle);
        finish(&run);
        phase = run.fault_phase;
        phases[phase]++;
        runs++;
    }
    printf("%s, order %d, %-28s %4d runs: %d in enable, %d in homing, %d in the move\n",
           devices[device].firmware, devices[device].pdo_order, faults[kind].name, runs,
           phases[PHASE_ENABLE], phases[PHASE_HOME], phases[PHASE_MOVE]);
    ck_assert_int_gt(phases[PHASE_ENABLE], 0);
    ck_assert_int_gt(phases[PHASE_HOME], 0);
    ck_assert_int_gt(phases[PHASE_MOVE], 0);
}

START_TEST(test_fault_at_every_cycle_ends_defined)
{
    device = _i / FAULT_COUNT;
    sweep((fault_kind_t)(_i % FAULT_COUNT));
}
END_TEST

/* ---- start-up ----------------------------------------------------------------------------------------------------- */

typedef struct start_fault {
    fault_kind_t kind;
    uint64_t frame;
    cm1e_bus_t *bus;
    bool console_done;
    uint64_t frames;
} start_fault_t;

static cm1e_tap_verdict_t start_tap(void *context, cm1e_tap_frame_t *frame)
{
    start_fault_t *fault = context;
    if (frame->direction != CM1E_TAP_RECEIVED)
        return CM1E_TAP_PASS;
    const uint64_t number = fault->frames++;
    char answer[256];
    if (faults[fault->kind].console && number == fault->frame && !fault->console_done) {
        fault->console_done = true;
        cm1e_bus_simulate(fault->bus, faults[fault->kind].console, answer, sizeof answer);
    }
    switch (fault->kind) {
    case FAULT_FRAME_LOST: return number == fault->frame ? CM1E_TAP_DROP : CM1E_TAP_PASS;
    case FAULT_FRAMES_LOST: return number >= fault->frame ? CM1E_TAP_DROP : CM1E_TAP_PASS;
    case FAULT_WORKING_COUNTER:
    case FAULT_WORKING_COUNTERS:
        if (number == fault->frame || (number > fault->frame && fault->kind == FAULT_WORKING_COUNTERS))
            cm1e_frame_change_working_counter(frame->bytes, frame->length, 0, 1);
        return CM1E_TAP_PASS;
    default: return CM1E_TAP_PASS;
    }
}

/** Starts the bus with a fault at one frame; returns the frames that came back meanwhile. */
static uint64_t start_with_fault(fault_kind_t kind, uint64_t frame)
{
    static cm1e_bus_config_t config;
    start_fault_t fault = {.kind = kind, .frame = frame};
    cm1e_diag_t diag = {0};
    describe(&config);
    ck_assert(cm1e_bus_open(&fault.bus, &config, &diag) == CM1E_OK);
    cm1e_nic_set_tap(cm1e_bus_nic(fault.bus), start_tap, &fault);
    const int64_t begin = cm1e_clock_now(cm1e_bus_clock(fault.bus));
    const cm1e_error_t error = cm1e_bus_start(fault.bus, &diag);
    const int64_t took_ns = cm1e_clock_now(cm1e_bus_clock(fault.bus)) - begin;
    ck_assert_msg(took_ns < INT64_C(20) * 1000000000, "%s at frame %llu: start-up took %.1f s", faults[kind].name,
                  (unsigned long long)frame, (double)took_ns * 1e-9);
    if (error != CM1E_OK)
        ck_assert_msg(strlen(diag.text) > 20, "%s at frame %llu: error %d without a sentence: \"%s\"", faults[kind].name,
                      (unsigned long long)frame, error, diag.text);
    const bool power_is_irrelevant = kind == FAULT_POWER_OFF || kind == FAULT_NONE;
    if (power_is_irrelevant || kind == FAULT_FRAME_LOST)
        ck_assert_msg(error == CM1E_OK, "%s at frame %llu: %s", faults[kind].name, (unsigned long long)frame, diag.text);
    if (kind == FAULT_FRAMES_LOST || kind == FAULT_SLAVE_GONE)
        ck_assert_msg(error != CM1E_OK, "%s at frame %llu was not noticed", faults[kind].name,
                      (unsigned long long)frame);
    cm1e_sim_probe_t probe;
    cm1e_sim_probe(cm1e_bus_segment(fault.bus), 1, &probe);
    ck_assert(!probe.torque_on && probe.travel_counts < 1);
    cm1e_nic_set_tap(cm1e_bus_nic(fault.bus), NULL, NULL);
    cm1e_bus_close(fault.bus);
    return fault.frames;
}

START_TEST(test_fault_at_every_frame_of_start_up_ends_defined)
{
    const fault_kind_t kind = (fault_kind_t)(_i % FAULT_COUNT);
    device = _i / FAULT_COUNT;
    const uint64_t frames = start_with_fault(FAULT_NONE, 0);
    printf("start-up: %llu frames, %s at each\n", (unsigned long long)frames, faults[kind].name);
    ck_assert_uint_gt(frames, 50);
    /* A fault at the very last frames is left to the cycle to notice. */
    const int stride = slowness();
    for (uint64_t frame = (uint64_t)sweep_first(device * 3 + (int)kind, stride); frame + 6 < frames; frame += (uint64_t)stride)
        start_with_fault(kind, frame);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("fault sweep");
    TCase *cyclic = tcase_create("cyclic"), *start_up = tcase_create("start-up");
    tcase_set_timeout(cyclic, 280);
    tcase_set_timeout(start_up, 280);
    tcase_add_loop_test(cyclic, test_fault_at_every_cycle_ends_defined, FAULT_NONE, DEVICE_COUNT * FAULT_COUNT);
    tcase_add_loop_test(start_up, test_fault_at_every_frame_of_start_up_ends_defined, FAULT_NONE,
                        DEVICE_COUNT * FAULT_COUNT);
    suite_add_tcase(suite, start_up);
    suite_add_tcase(suite, cyclic);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
