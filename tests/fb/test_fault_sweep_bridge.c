/**
 * One fault at every moment of enabling, homing, moving, a CML query and enabling again of two motors behind a bridge,
 * beside a CM1-E, on virtual time. Each run ends in a defined state with a right error text; the fault heals, MC_Reset
 * enables again, and no shaft moves by it. What is sent is judged in every cycle by the witness of safety_bench.h: no
 * target but where the motor is before it is enabled, no word that means another thing in the mode of the bridge.
 */
#include "cm1e/cm_bridge.h"
#include "safety_bench.h"

enum { A = 0, B, C, AXES }; /* CM1 at ID1, CM2 at ID3, CM1-E behind the bridge */
enum { FAULT_CYCLES = 250, SETTLED = 400, HEALED = 450, RESET = 1700, AGAIN = 1900, END = 2400, MAX_CYCLES = 6000 };
enum { FIRST_CYCLES = 15, STRIDE = 7, SAMPLED_STRIDE = 61 };

/* ---- faults ------------------------------------------------------------------------------------------------------ */

typedef enum fault_kind {
    FAULT_NONE = 0,
    FAULT_FRAME_LOST, FAULT_FRAMES_LOST, FAULT_WORKING_COUNTER, FAULT_WORKING_COUNTERS, FAULT_SLAVE_GONE,
    FAULT_POWER_CYCLE, FAULT_MOTOR_UNPLUGGED, FAULT_MOTOR_ERROR, FAULT_ANSWER_BROKEN, FAULT_ANSWERS_BROKEN,
    FAULT_SDO_ABORT, FAULT_SHORT_STALL, FAULT_LONG_STALL,
    FAULT_COUNT,
} fault_kind_t;

typedef enum must { MUST_SUCCEED = 0, MUST_FAIL, MAY_FAIL } must_t;

static const struct {
    const char *name;
    must_t must;
    const char *console, *heal;
    bool one_motor;          /**< A alone fails */
    cm1e_error_t errors[6];  /**< of A */
    const char *word;        /**< in the text of the error */
} faults[FAULT_COUNT] = {
    [FAULT_NONE] = {"none", MUST_SUCCEED, NULL, NULL, false, {0}, ""},
    [FAULT_FRAME_LOST] = {"a frame lost", MUST_SUCCEED, NULL, NULL, false, {0}, ""},
    [FAULT_FRAMES_LOST] = {"all frames lost", MUST_FAIL, NULL, NULL, false, {CM1E_ERROR_BUS_LOST}, "frame"},
    [FAULT_WORKING_COUNTER] = {"a working counter wrong", MUST_SUCCEED, NULL, NULL, false, {0}, ""},
    [FAULT_WORKING_COUNTERS] = {"all working counters wrong", MUST_FAIL, NULL, NULL, false,
                                {CM1E_ERROR_BUS_WORKING_COUNTER}, "working counter"},
    [FAULT_SLAVE_GONE] = {"cable to the bridge unplugged", MUST_FAIL, "unplug 1", "replug 1", false,
                          {CM1E_ERROR_BUS_LOST, CM1E_ERROR_BUS_WORKING_COUNTER, CM1E_ERROR_AXIS_OFFLINE}, ""},
    [FAULT_POWER_CYCLE] = {"control power of the bridge off and on", MUST_FAIL, "power-cycle 1 150", NULL, false,
                           {CM1E_ERROR_BUS_LOST, CM1E_ERROR_BUS_WORKING_COUNTER, CM1E_ERROR_AXIS_OFFLINE}, ""},
    [FAULT_MOTOR_UNPLUGGED] = {"cable to a motor unplugged", MUST_FAIL, "motor 1 1 unplug", "motor 1 1 replug", true,
                               {CM1E_ERROR_DRIVE_FAULT, CM1E_ERROR_DRIVE_MODE_TIMEOUT}, "erial"},
    [FAULT_MOTOR_ERROR] = {"overload", MUST_FAIL, "motor 1 1 error overload", NULL, true,
                           {CM1E_ERROR_DRIVE_FAULT, CM1E_ERROR_DRIVE_MODE_TIMEOUT},
                           "verload"},
    [FAULT_ANSWER_BROKEN] = {"some answers broken", MUST_SUCCEED, "motor 1 1 broken 4", NULL, true, {0}, ""},
    [FAULT_ANSWERS_BROKEN] = {"many answers broken", MUST_FAIL, "motor 1 1 broken 40", NULL, true,
                              {CM1E_ERROR_DRIVE_FAULT, CM1E_ERROR_DRIVE_MODE_TIMEOUT}, "erial"},
    [FAULT_SDO_ABORT] = {"SDOs aborted", MAY_FAIL, NULL, NULL, false,
                         {CM1E_ERROR_DRIVE_MODE_TIMEOUT, CM1E_ERROR_DRIVE_MODE_LOST, CM1E_ERROR_SDO_ABORT}, ""},
    [FAULT_SHORT_STALL] = {"a pause of 20 ms", MUST_SUCCEED, NULL, NULL, false, {0}, ""},
    [FAULT_LONG_STALL] = {"a pause of 150 ms", MUST_FAIL, NULL, NULL, false,
                          {CM1E_ERROR_PROGRAM, CM1E_ERROR_BUS_STATE /* it had no torque */}, ""},
};

/* ---- a run ------------------------------------------------------------------------------------------------------- */

typedef enum phase {
    PHASE_ENABLE, PHASE_HOME, PHASE_MOVE, PHASE_OFF, PHASE_CML, PHASE_AGAIN, PHASE_DONE, PHASE_COUNT,
} phase_t;
static const char *const phase_names[] = {"enable", "home", "move", "off", "CML", "enable again", "at rest"};

static bench_t bench;
static fault_kind_t kind;
static int fault_cycle, armed_cycles, failed_cycle, over_cycle, off_cycle;
static phase_t phase, fault_phase;
static MC_Power_t power[AXES];
static MC_Reset_t reset[AXES];
static MC_Home_t home;
static CM_SendCML_t query; /* leads A to CML, MC_Power leads it back */
static MC_MoveAbsolute_t move[AXES];
static cm1e_axis_info_t at_failure[AXES];
static bool asked_at_failure[AXES]; /* for torque */
static char text[AXES][1024];
static double travel_settled[AXES], travel_after[AXES];

static bool in_error(const bench_t *b, uint32_t n) { return bench_info(b, n).state == CM1E_AXIS_ERROR_STOP; }

/* ---- the fault --------------------------------------------------------------------------------------------------- */

enum { FPRD = 4, MAILBOX_IN = 0x1080, COE_SERVICE = 7, SDO_COMMAND = 8, SDO_INDEX = 9, SDO_CODE = 12,
       SDO_ABORT = 0x80 };
enum { REQUEST_SERVICE = 0x20, RESPONSE_SERVICE = 0x30, ABORT_BYTES = 10, ABORT_STATE = 0x08000022 };

/** Answers about modes and homing become aborts. */
static void abort_sdos(const cm1e_tap_frame_t *frame)
{
    uint8_t *at = frame->bytes + 16, *end = frame->bytes + frame->length;
    for (bool more = true; more && at + 12 <= end;) {
        const uint16_t length = word_at(at, 6) & 0x7FF;
        uint8_t *message = at + 10;
        more = (word_at(at, 6) & 0x8000) != 0;
        const uint16_t index = length > SDO_CODE ? word_at(message, SDO_INDEX) & 0xE7FF : 0;
        if (at[0] == FPRD && word_at(at, 4) == MAILBOX_IN && message + length + 2 <= end && word_at(message, length) &&
            (message[COE_SERVICE] & 0xF0) == RESPONSE_SERVICE && index >= 0x6060 && index <= 0x60F6) {
            message[0] = ABORT_BYTES;
            message[COE_SERVICE] = REQUEST_SERVICE;
            message[SDO_COMMAND] = SDO_ABORT;
            memcpy(message + SDO_CODE, (uint8_t[]){0x22, 0, 0, 0x08}, 4);
        }
        at += 10 + length + 2;
    }
}

static cm1e_tap_verdict_t sweep_tap(void *context, cm1e_tap_frame_t *frame)
{
    const bool received = frame->direction == CM1E_TAP_RECEIVED, data = is_process_data(&bench, frame);
    if (armed_cycles > 0 && received) {
        if (kind == FAULT_FRAMES_LOST || (kind == FAULT_FRAME_LOST && data)) {
            armed_cycles = kind == FAULT_FRAME_LOST ? 0 : armed_cycles;
            return CM1E_TAP_DROP;
        }
        if (kind == FAULT_WORKING_COUNTERS || (kind == FAULT_WORKING_COUNTER && data)) {
            armed_cycles = kind == FAULT_WORKING_COUNTER ? 0 : armed_cycles;
            if (data)
                cm1e_frame_change_working_counter(frame->bytes, frame->length, 0, -1);
        }
        if (kind == FAULT_SDO_ABORT)
            abort_sdos(frame);
    }
    return bench_tap(context, frame);
}

static void stall(bench_t *b, int ms)
{
    cm1e_clock_t *clock = cm1e_bus_clock(b->bus);
    cm1e_clock_sleep_until(clock, cm1e_clock_now(clock) + ms * INT64_C(1000000));
    b->paused = true;
}

/** The bridge survives what its guide forbids, a motor might not. An SDO on its way when a fault comes cannot be held
 *  back. */
static void judge_rules(const bench_t *b)
{
    const unsigned allowed = (kind == FAULT_NONE ? 0u : CM1E_SIM_OUTPUT_IN_VAIN) |
                             (faults[kind].one_motor ? CM1E_SIM_MODE_IN_ERROR : 0u);
    for (uint32_t n = 0; n < AXES; n++)
        MUST(b, (bench_probe(b, n).broken_rules & ~allowed) == 0, "%s: axis %u: rules of the guide are broken: 0x%03X",
             phase_names[fault_phase], n, bench_probe(b, n).broken_rules);
}

static void inject(bench_t *b)
{
    judge_rules(b);
    fault_phase = phase;
    armed_cycles = FAULT_CYCLES;
    for (uint32_t n = 0; n < AXES; n++)
        bench_probe_reset(b, n);
    if (faults[kind].console)
        bench_console(b, "%s", faults[kind].console);
    if (kind == FAULT_SHORT_STALL)
        stall(b, 20);
    else if (kind == FAULT_LONG_STALL)
        stall(b, 150);
}

/* ---- the program ------------------------------------------------------------------------------------------------- */

static void call_blocks(void)
{
    for (int n = 0; n < AXES; n++) {
        MC_Power(&power[n]);
        MC_Reset(&reset[n]);
    }
    MC_Home(&home);
    CM_SendCML(&query);
    for (int n = 0; n < AXES; n++)
        MC_MoveAbsolute(&move[n]);
}

static bool all_powered(void) { return power[A].Status && power[B].Status && power[C].Status; }

static void next_phase(void)
{
    const phase_t before = phase;
    if (phase == PHASE_ENABLE && all_powered())
        phase = PHASE_HOME;
    else if (phase == PHASE_HOME && home.Done && move[B].Done && move[C].Done)
        phase = PHASE_MOVE;
    else if (phase == PHASE_MOVE && move[A].Done)
        phase = PHASE_OFF;
    else if (phase == PHASE_OFF && !power[A].Status)
        phase = PHASE_CML;
    else if (phase == PHASE_CML && query.Done)
        phase = PHASE_AGAIN;
    else if (phase == PHASE_AGAIN && power[A].Status)
        phase = PHASE_DONE;
    if (phase == before)
        return;
    if (phase == PHASE_OFF)
        off_cycle = bench.cycle;
    home.Execute = phase == PHASE_HOME;
    move[B].Execute = move[C].Execute = phase == PHASE_HOME;
    move[A].Execute = phase == PHASE_MOVE;
    query.Execute = phase == PHASE_CML;
    power[A].Enable = phase != PHASE_OFF && phase != PHASE_CML;
}

static void remember_failure(bench_t *b)
{
    bool failed = home.Error || query.Error;
    for (uint32_t n = 0; n < AXES; n++)
        failed = failed || in_error(b, n);
    if (!failed || failed_cycle >= 0)
        return;
    MUST(b, faults[kind].must != MUST_SUCCEED, "%s: failed, MC_Home 0x%04X, CM_SendCML 0x%04X", phase_names[phase],
         home.ErrorID, query.ErrorID);
    failed_cycle = b->cycle;
}

/** A CM1 holds from power-on, without a master (BR 6.1.1), and one that hears nothing goes on to hold. */
static bool torque_of_its_own(const bench_t *b, uint32_t n)
{
    const cm1e_sim_bridge_axis_t *motor = bench_motor(b, n);
    const bool off = motor && motor->state != OPERATION_ENABLED && motor->state != SWITCHED_ON;
    const bool never_enabled = b->witness[n].enablings == 0;
    const bool out_of_reach = kind == FAULT_SLAVE_GONE || kind == FAULT_POWER_CYCLE || kind == FAULT_MOTOR_UNPLUGGED;
    return motor && motor->motor == CM1E_BRIDGE_CM1 && off && (never_enabled || out_of_reach);
}

static void remember_texts(bench_t *b)
{
    for (uint32_t n = 0; n < AXES; n++) {
        at_failure[n] = bench_info(b, n);
        asked_at_failure[n] = power[n].Enable;
        cm1e_axis_error_text(b->axis[n], text[n], sizeof text[n]);
        travel_settled[n] = bench_probe(b, n).travel_counts;
        MUST(b, !in_error(b, n) || !bench_probe(b, n).torque_on || torque_of_its_own(b, n),
             "axis %u: torque is on in ErrorStop", n);
    }
}

/** After the fault: it settles, heals, and is reset; what was under way never goes on. */
static void recover(bench_t *b)
{
    const int since = b->cycle - over_cycle;
    if (since == SETTLED)
        remember_texts(b);
    if (since == HEALED && faults[kind].heal)
        bench_console(b, "%s", faults[kind].heal);
    /* In CML there is no fault reset, and the text says so: the bridge is switched off and on. */
    if (since == HEALED + 1 && bench_motor(b, A)->mode == CM1E_BRIDGE_MODE_CML && bench_motor(b, A)->error) {
        MUST(b, strstr(text[A], "off and on"), "in CML: %s", text[A]);
        bench_console(b, "power-cycle 1 150");
    }
    if (since == RESET)
        for (int n = 0; n < AXES; n++) {
            home.Execute = query.Execute = move[n].Execute = FALSE;
            power[n].Enable = TRUE;
            reset[n].Execute = TRUE;
        }
    /* An axis that was off meanwhile learns of it when it is enabled: its reset had nothing to do. */
    for (uint32_t n = 0; (since == AGAIN || since == AGAIN + 1) && n < AXES; n++)
        reset[n].Execute = since == AGAIN + 1 && in_error(b, n);
    for (uint32_t n = 0; since > SETTLED && n < AXES; n++)
        travel_after[n] = bench_probe(b, n).travel_counts - travel_settled[n];
    if (since == END)
        cm1e_scheduler_stop(b->scheduler);
}

static void program(bench_t *b)
{
    if (b->cycle == fault_cycle)
        inject(b);
    else if (armed_cycles > 0)
        armed_cycles--;
    call_blocks();
    remember_failure(b);
    if (over_cycle < 0 && failed_cycle < 0)
        next_phase();
    const bool seen = b->cycle > fault_cycle + 50 && armed_cycles == 0;
    const bool waits_for_nothing = seen && phase == PHASE_DONE;
    if (over_cycle < 0 && (failed_cycle >= 0 || waits_for_nothing))
        over_cycle = b->cycle;
    if (over_cycle >= 0)
        recover(b);
    MUST(b, b->cycle < MAX_CYCLES, "the run does not end: phase %s, A %s, home %d, B %d C %d", phase_names[phase],
         cm1e_axis_state_name(bench_info(b, A).state), home.Done, move[B].Done, move[C].Done);
}

/* ---- one run ----------------------------------------------------------------------------------------------------- */

static void describe_axes(void)
{
    bench_describe(&bench, AXES);
    for (int n = 0; n < AXES; n++) {
        cm1e_axis_config_t *axis = &bench.config.axes[n];
        axis->address = n == C ? 2 : 1;
        axis->channel = n == A ? 1 : n == B ? 3 : 0;
        axis->k37 = 10;
        axis->k37_stated = n != C;
        if (n == C)
            continue;
        strcpy(axis->motor, n == A ? "CM1" : "CM2");
        axis->homing.method = 2;
    }
    bench.config.axes[A].sim.stop_negative = -3000;
}

static void start(void)
{
    cm1e_bus_config_free(&bench.config);
    memset(&bench, 0, sizeof bench);
    describe_axes();
    bench.program = program;
    snprintf(bench.scene, sizeof bench.scene, "%s at cycle %d", faults[kind].name, fault_cycle);
    phase = fault_phase = PHASE_ENABLE;
    armed_cycles = 0;
    failed_cycle = over_cycle = -1;
    for (int n = 0; n < AXES; n++) {
        power[n] = (MC_Power_t){.Axis = &bench.axis[n], .Enable = TRUE, .EnablePositive = TRUE, .EnableNegative = TRUE};
        reset[n] = (MC_Reset_t){.Axis = &bench.axis[n]};
        move[n] = (MC_MoveAbsolute_t){.Axis = &bench.axis[n], .Position = n == A ? 6 : 10 * n, .Velocity = 100,
                                      .Acceleration = 2000};
        travel_after[n] = 0;
    }
    home = (MC_Home_t){.Axis = &bench.axis[A]};
    query = (CM_SendCML_t){.Axis = &bench.axis[A], .Command = "?99.1"};
    bench_open(&bench);
    cm1e_nic_set_tap(cm1e_bus_nic(bench.bus), sweep_tap, &bench);
    bench_start(&bench);
}

/** Counts that a shaft may travel after the fault; see test_fault_sweep.c. */
static double allowed_travel(void)
{
    const double top_speed = 100000.0, ramp = top_speed * sqrt(top_speed / 1e8), coast = 15000.0;
    const double way_to_go = 13000.0; /* where nothing failed that axis goes on */
    return 50 + top_speed * 0.160 + ramp + coast + way_to_go;
}

static void judge_axis(uint32_t n)
{
    const bool failed = at_failure[n].state == CM1E_AXIS_ERROR_STOP;
    const bool concerned = n == A || (!faults[kind].one_motor && (n == B || kind != FAULT_SDO_ABORT));
    const bool on_its_way = n == A && fault_phase >= PHASE_MOVE && at_failure[n].state == CM1E_AXIS_DISABLED;
    MUST(&bench, failed || faults[kind].must != MUST_FAIL || !concerned || !asked_at_failure[n] || on_its_way,
         "%s: axis %u did not notice, %s", phase_names[fault_phase], n, cm1e_axis_state_name(at_failure[n].state));
    MUST(&bench, !failed || (faults[kind].must != MUST_SUCCEED && concerned), "%s: axis %u failed: %s",
         phase_names[fault_phase], n, text[n]);
    if (failed && n == A) {
        bool right = false;
        for (int i = 0; faults[kind].errors[i] != CM1E_OK; i++)
            right = right || at_failure[n].error == faults[kind].errors[i];
        MUST(&bench, right && strstr(text[n], faults[kind].word), "%s: error %s, text \"%s\"", phase_names[fault_phase],
             cm1e_strerror(at_failure[n].error), text[n]);
    }
    MUST(&bench, !failed || strlen(text[n]) > 40, "axis %u: \"%s\"", n, text[n]);
    MUST(&bench, travel_settled[n] <= allowed_travel(), "%s: axis %u travelled %.0f counts", phase_names[fault_phase],
         n, travel_settled[n]);
    MUST(&bench, travel_after[n] < 60, "%s: axis %u moved by %.0f counts after it had stopped",
         phase_names[fault_phase], n, travel_after[n]);
    const cm1e_axis_info_t info = bench_info(&bench, n);
    cm1e_axis_error_text(bench.axis[n], text[n], sizeof text[n]);
    MUST(&bench, info.state == CM1E_AXIS_STANDSTILL && power[n].Status, "%s: axis %u after MC_Reset: %s, %s",
         phase_names[fault_phase], n, cm1e_axis_state_name(info.state), text[n]);
}

static bool judged_at_end;

/** The last cycle of the program: after it the scheduler shuts down. */
static void program_and_judge(bench_t *b)
{
    program(b);
    if (over_cycle < 0 || b->cycle - over_cycle != END)
        return;
    for (uint32_t n = 0; n < AXES; n++)
        judge_axis(n);
    judge_rules(b);
    cm1e_sim_bridge_t *bridge = cm1e_sim_bridge_of(cm1e_sim_segment_slave(b->segment, 1));
    for (int id = 1; id < CM1E_BRIDGE_AXES; id += 2)
        MUST(b, bridge->axes[id].mechanics.travel < 5, "ID%d moved by %.0f, and nobody uses it", id + 1,
             bridge->axes[id].mechanics.travel);
    judged_at_end = true;
}

static void run(void)
{
    cm1e_diag_t diag = {0};
    start();
    bench.program = program_and_judge;
    judged_at_end = false;
    const cm1e_error_t error = bench_run(&bench, &diag);
    MUST(&bench, error == CM1E_OK && judged_at_end, "%s", diag.text);
    for (uint32_t n = 0; n < 2; n++)
        MUST(&bench, !bench_probe(&bench, n).torque_on, "axis %u: torque after the end", n);
    bench_close(&bench);
}

START_TEST(test_fault_at_every_moment_ends_defined)
{
    int phases[PHASE_COUNT] = {0}, runs = 0;
    kind = FAULT_NONE;
    fault_cycle = 0;
    run();
    const int end = over_cycle, off = off_cycle, stride = sweep_stride(STRIDE, SAMPLED_STRIDE);
    kind = (fault_kind_t)_i;
    for (fault_cycle = 0; fault_cycle < end; runs++) {
        const bool every_cycle = slowness() == 1 && (fault_cycle < FIRST_CYCLES || fault_cycle >= off);
        run();
        phases[fault_phase]++;
        fault_cycle += every_cycle ? 1 : fault_cycle == 0 ? 1 + (int)kind * 5 % stride : stride;
    }
    printf("%-40s %4d runs:", faults[kind].name, runs);
    for (int i = 0; i < PHASE_DONE; i++)
        printf(" %d in %s%s", phases[i], phase_names[i], i + 1 < PHASE_DONE ? "," : "\n");
    for (int i = 0; i < PHASE_OFF; i++)
        ck_assert_int_gt(phases[i], 0);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("fault sweep, bridge");
    TCase *all = tcase_create("all");
    tcase_set_timeout(all, 280);
    tcase_add_loop_test(all, test_fault_at_every_moment_ends_defined, FAULT_NONE + 1, FAULT_COUNT);
    suite_add_tcase(suite, all);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
