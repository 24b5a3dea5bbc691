/**
 * Faults of axes that follow each other, on the simulated segment with the real frames: one fault at every moment of
 * getting in step, of being in step and of leaving, for each kind of coupling and each `coupling_stop`. The master is a
 * CM1-E, its slave a CM2 behind a bridge; a CM1 there follows the same master by another gear, another CM1-E is the
 * second master of a combination.
 *
 * What is sent is judged in every cycle by the witness of safety_bench.h: no step, no limit exceeded. Each run ends
 * with every axis where the fault leads it, with its text, at rest; the fault heals, MC_Reset enables again, and no
 * shaft moves by it.
 */
#include "safety_bench.h"

enum { MASTER = 0, SLAVE, BESIDE, OTHER, AXES };
enum { ENABLED = 300, COUPLED = 40, SECOND = 340, TURN = 440, LEAVE = 600, OVER = 680 }; /* from ENABLED on, the rest */
enum { FAULT_CYCLES = 250, SETTLED = 500, HEALED = 520, RESET = 1700, AGAIN = 1900, END = 2300 };
enum { STRIDE = 149, SAMPLED_STRIDE = 601 };

/* ---- the program ------------------------------------------------------------------------------------------------- */

static bench_t bench;
static MC_Power_t power[AXES];
static MC_Reset_t reset[AXES];
static MC_Stop_t stop[AXES];
static MC_MoveVelocity_t drive, drive_other;
static MC_GearIn_t gear, gear_second, gear_beside;
static MC_CombineAxes_t combine, combine_second;
static MC_GearInPos_t in_pos;
static MC_CamTableSelect_t cam_select;
static MC_CamIn_t cam_in;
static MC_PhasingRelative_t phasing;
static MC_GearOut_t gear_out;
static const MC_CAM_POINT cam_points[] = {{0, 0, 0, 0}, {20, 5, 0, 0}, {40, 0, 0, 0}};
static const MC_CAM_REF cam_table = {.Points = cam_points, .NumberOfPoints = 3};

typedef enum kind { A_GEAR = 0, A_COMBINATION, A_GEAR_IN_POS, A_CAM, A_PHASED_GEAR, KINDS } kind_t;
static const char *const kind_names[KINDS] = {"MC_GearIn", "MC_CombineAxes", "MC_GearInPos", "MC_CamIn",
                                              "MC_PhasingRelative"};
static kind_t kind;
static cm1e_coupling_stop_t mode;

static void couple(void)
{
    gear.Execute = kind == A_GEAR || kind == A_PHASED_GEAR;
    combine.Execute = kind == A_COMBINATION;
    cam_in.Execute = kind == A_CAM;
    cam_in.CamTableID = cam_select.CamTableID;
    if (kind == A_GEAR_IN_POS) { /* the master accelerates still */
        in_pos.MasterSyncPosition = bench_info(&bench, MASTER).set_position + 40;
        in_pos.SlaveSyncPosition = bench_info(&bench, SLAVE).set_position + 12;
        in_pos.MasterStartDistance = 30;
        in_pos.Execute = TRUE;
    }
}

/** While it runs another one takes over. */
static void second(void)
{
    gear_second.Execute = kind == A_GEAR || kind == A_GEAR_IN_POS || kind == A_CAM;
    combine_second.Execute = kind == A_COMBINATION;
    phasing.Execute = kind == A_PHASED_GEAR;
}

static void leave(void) { gear_out.Execute = kind != A_COMBINATION; }

static void call_blocks(void)
{
    for (int n = 0; n < AXES; n++) {
        MC_Power(&power[n]);
        MC_Reset(&reset[n]);
        MC_Stop(&stop[n]);
    }
    MC_MoveVelocity(&drive);
    MC_MoveVelocity(&drive_other);
    MC_GearIn(&gear_beside);
    MC_GearIn(&gear);
    MC_GearIn(&gear_second);
    MC_CombineAxes(&combine);
    MC_CombineAxes(&combine_second);
    MC_GearInPos(&in_pos);
    MC_CamTableSelect(&cam_select);
    MC_CamIn(&cam_in);
    MC_PhasingRelative(&phasing);
    MC_GearOut(&gear_out);
}

static bool coupled(void)
{
    return gear.Busy || gear_second.Busy || combine.Busy || combine_second.Busy || in_pos.Busy ||
           cam_in.Busy;
}
static bool in_step(void) { return gear.InGear || combine.InSync || in_pos.InSync || cam_in.InSync; }

/* ---- faults ------------------------------------------------------------------------------------------------------ */

typedef enum fault_kind {
    FAULT_NONE = 0,
    FAULT_FRAME_LOST, FAULT_FRAMES_LOST, FAULT_WORKING_COUNTERS, FAULT_BRIDGE_GONE, FAULT_MASTER_GONE,
    FAULT_MASTER_ERROR, FAULT_SLAVE_ERROR, FAULT_SLAVE_UNPLUGGED, FAULT_MASTER_POWER, FAULT_MASTER_OFF, FAULT_SLAVE_OFF,
    FAULT_MASTER_STOP, FAULT_SLAVE_STOP, FAULT_SHORT_STALL, FAULT_LONG_STALL,
    FAULT_COUNT,
} fault_kind_t;

/** Who is concerned: in ErrorStop at the end, for that error or for being coupled. */
enum { ALL = 0xF, M = 1 << MASTER, S = 1 << SLAVE, B = 1 << BESIDE, O = 1 << OTHER };

static const struct {
    const char *name;
    const char *console, *heal;
    unsigned fails;        /**< these axes do */
    unsigned must_not;     /**< these do not, with CM1E_COUPLING_STOP_THIS */
} faults[FAULT_COUNT] = {
    [FAULT_NONE] = {"none", NULL, NULL, 0, ALL},
    [FAULT_FRAME_LOST] = {"a frame lost", NULL, NULL, 0, ALL},
    [FAULT_FRAMES_LOST] = {"all frames lost", NULL, NULL, ALL, 0},
    [FAULT_WORKING_COUNTERS] = {"all working counters wrong", NULL, NULL, ALL, 0},
    [FAULT_BRIDGE_GONE] = {"cable to the bridge unplugged", "unplug 2", "replug 2", ALL, 0},
    [FAULT_MASTER_GONE] = {"cable to the master unplugged", "unplug 1", "replug 1", ALL, 0},
    [FAULT_MASTER_ERROR] = {"drive error of the master", "error 1 2310", NULL, M | B, O},
    [FAULT_SLAVE_ERROR] = {"overload of the slave", "motor 2 3 error overload", NULL, S, M | B | O},
    [FAULT_SLAVE_UNPLUGGED] = {"cable to the slave's motor unplugged", "motor 2 3 unplug", "motor 2 3 replug", S,
                               M | B | O},
    [FAULT_MASTER_POWER] = {"motor power of the master off", "power 1 off", "power 1 on", M | B, O},
    [FAULT_MASTER_OFF] = {"MC_Power of the master off", NULL, NULL, B, O},
    [FAULT_SLAVE_OFF] = {"MC_Power of the slave off", NULL, NULL, 0, M | B | O},
    [FAULT_MASTER_STOP] = {"MC_Stop of the master", NULL, NULL, 0, ALL},
    [FAULT_SLAVE_STOP] = {"MC_Stop of the slave", NULL, NULL, 0, ALL},
    [FAULT_SHORT_STALL] = {"a pause of 20 ms", NULL, NULL, 0, 0},
    [FAULT_LONG_STALL] = {"a pause of 150 ms", NULL, NULL, 0, 0},
};

static fault_kind_t fault;
static int fault_cycle, armed_cycles, over_cycle;
static bool coupled_then;
static cm1e_axis_info_t settled[AXES];
static char text[AXES][1024];
static double travel_settled[AXES];

static bool in_error(uint32_t n) { return bench_info(&bench, n).state == CM1E_AXIS_ERROR_STOP; }

static cm1e_tap_verdict_t sweep_tap(void *context, cm1e_tap_frame_t *frame)
{
    const bool received = frame->direction == CM1E_TAP_RECEIVED, data = is_process_data(&bench, frame);
    if (armed_cycles > 0 && received) {
        if (fault == FAULT_FRAMES_LOST || (fault == FAULT_FRAME_LOST && data)) {
            armed_cycles = fault == FAULT_FRAME_LOST ? 0 : armed_cycles;
            return CM1E_TAP_DROP;
        }
        if (fault == FAULT_WORKING_COUNTERS && data)
            cm1e_frame_change_working_counter(frame->bytes, frame->length, 0, -1);
    }
    return bench_tap(context, frame);
}

static void stall(bench_t *b, int ms)
{
    cm1e_clock_t *clock = cm1e_bus_clock(b->bus);
    cm1e_clock_sleep_until(clock, cm1e_clock_now(clock) + ms * INT64_C(1000000));
    b->paused = true;
}

static void inject(bench_t *b)
{
    armed_cycles = FAULT_CYCLES;
    coupled_then = coupled() && fault_cycle < LEAVE;
    for (uint32_t n = 0; n < AXES; n++)
        bench_probe_reset(b, n);
    if (faults[fault].console)
        bench_console(b, "%s", faults[fault].console);
    switch (fault) {
    case FAULT_MASTER_OFF: power[MASTER].Enable = FALSE; break;
    case FAULT_SLAVE_OFF: power[SLAVE].Enable = FALSE; break;
    case FAULT_MASTER_STOP: stop[MASTER].Execute = TRUE; break;
    case FAULT_SLAVE_STOP: stop[SLAVE].Execute = TRUE; break;
    case FAULT_SHORT_STALL: stall(b, 20); break;
    case FAULT_LONG_STALL: stall(b, 150); break;
    default: break;
    }
}

/* ---- a run ------------------------------------------------------------------------------------------------------- */

static bool is_coupling_error(cm1e_error_t error)
{
    return error == CM1E_ERROR_AXIS_MASTER_LOST || error == CM1E_ERROR_AXIS_COUPLED;
}

/** What each axis has become, when everything has settled. */
static void judge_settled(bench_t *b)
{
    const bool together = mode != CM1E_COUPLING_STOP_THIS && coupled_then;
    for (uint32_t n = 0; n < AXES; n++) {
        settled[n] = bench_info(b, n);
        cm1e_axis_error_text(b->axis[n], text[n], sizeof text[n]);
        travel_settled[n] = bench_probe(b, n).travel_counts;
        const bool failed = settled[n].state == CM1E_AXIS_ERROR_STOP;
        MUST(b, failed || !(faults[fault].fails & 1u << n), "axis %u did not notice, %s", n,
             cm1e_axis_state_name(settled[n].state));
        MUST(b, !failed || together || !(faults[fault].must_not & 1u << n), "axis %u failed: %s", n, text[n]);
        MUST(b, !failed || settled[n].error != CM1E_OK, "axis %u failed without an error", n);
        MUST(b, !failed || strlen(text[n]) > 40, "axis %u: \"%s\"", n, text[n]);
        MUST(b, !failed || settled[n].set_velocity == 0, "axis %u: %g u/s in ErrorStop", n, settled[n].set_velocity);
    }
    const bool master_failed = faults[fault].fails & M || fault == FAULT_MASTER_OFF;
    const bool waited = in_pos.Error && settled[SLAVE].state == CM1E_AXIS_STANDSTILL; /* for its StartSync */
    if (coupled_then && master_failed && faults[fault].fails != ALL && !waited)
        MUST(b, settled[SLAVE].state == CM1E_AXIS_ERROR_STOP && is_coupling_error(settled[SLAVE].error),
             "the slave of a master that failed: %s, %s", cm1e_axis_state_name(settled[SLAVE].state), text[SLAVE]);
    MUST(b, settled[SLAVE].state != CM1E_AXIS_ERROR_STOP || !coupled(), "the slave failed, and its block is Busy");
}

static void recover(bench_t *b)
{
    const int since = b->cycle - over_cycle;
    if (since == SETTLED)
        judge_settled(b);
    if (since == HEALED) {
        if (faults[fault].heal)
            bench_console(b, "%s", faults[fault].heal);
        drive.Execute = drive_other.Execute = gear.Execute = gear_beside.Execute = combine.Execute = FALSE;
        gear_second.Execute = combine_second.Execute = in_pos.Execute = cam_in.Execute = FALSE;
        for (int n = 0; n < AXES; n++) { /* whoever still moves is stopped */
            stop[n].Execute = TRUE;
            power[n].Enable = TRUE;
        }
    }
    if (since == RESET)
        for (uint32_t n = 0; n < AXES; n++) {
            stop[n].Execute = FALSE;
            travel_settled[n] = bench_probe(b, n).travel_counts;
            reset[n].Execute = TRUE;
        }
    for (uint32_t n = 0; (since == AGAIN || since == AGAIN + 1) && n < AXES; n++)
        reset[n].Execute = since == AGAIN + 1 && in_error(n);
    if (since < END)
        return;
    for (uint32_t n = 0; n < AXES; n++) {
        cm1e_axis_error_text(b->axis[n], text[n], sizeof text[n]);
        MUST(b, bench_info(b, n).state == CM1E_AXIS_STANDSTILL && power[n].Status, "axis %u after MC_Reset: %s, %s", n,
             cm1e_axis_state_name(bench_info(b, n).state), text[n]);
        const double moved = bench_probe(b, n).travel_counts - travel_settled[n];
        MUST(b, moved < 60, "axis %u moved by %.0f counts when it was reset", n, moved);
    }
    cm1e_scheduler_stop(b->scheduler);
}

static void play(int since)
{
    if (since == 0)
        drive.Execute = drive_other.Execute = gear_beside.Execute = TRUE;
    else if (since == COUPLED)
        couple();
    else if (since == SECOND)
        second();
    else if (since == TURN && fault != FAULT_MASTER_STOP)
        drive.Execute = FALSE;
    else if (since == TURN + 1) {
        drive.Direction = mcNegativeDirection;
        drive.Execute = armed_cycles == 0;
    } else if (since == LEAVE)
        leave();
}

static void program(bench_t *b)
{
    const int since = b->cycle - ENABLED;
    if (since == fault_cycle)
        inject(b);
    else if (armed_cycles > 0)
        armed_cycles--;
    if (over_cycle < 0 && since <= OVER && (since <= fault_cycle || fault == FAULT_NONE || fault == FAULT_FRAME_LOST))
        play(since);
    call_blocks();
    if (since == 0)
        for (uint32_t n = 0; n < AXES; n++) {
            cm1e_axis_error_text(b->axis[n], text[n], sizeof text[n]);
            MUST(b, power[n].Status, "axis %u is not enabled: %s", n, text[n]);
        }
    const bool clean = fault == FAULT_NONE || fault == FAULT_FRAME_LOST;
    if (clean && kind != A_GEAR_IN_POS && since > COUPLED + 260 && since < SECOND)
        MUST(b, in_step(), "not in step, %s", cm1e_axis_state_name(bench_info(b, SLAVE).state));
    if (over_cycle < 0 && (clean ? since == OVER : since == fault_cycle + FAULT_CYCLES))
        over_cycle = b->cycle;
    if (over_cycle >= 0)
        recover(b);
}

static void describe_axes(void)
{
    bench_describe(&bench, AXES);
    for (int n = 0; n < AXES; n++) {
        cm1e_axis_config_t *axis = &bench.config.axes[n];
        const bool bridged = n == SLAVE || n == BESIDE;
        axis->address = n == MASTER ? 1 : n == OTHER ? 3 : 2;
        axis->channel = n == SLAVE ? 3 : n == BESIDE ? 1 : 0;
        axis->k37 = 10;
        axis->k37_stated = bridged;
        axis->sim.no_stops = true;
        axis->max_jerk = n == SLAVE ? 40000 : 20000; /* it can follow the ramps of its master */
        axis->max_acceleration = n == SLAVE ? 2000 : 1000;
        axis->max_velocity = 400; /* u of 1000 counts */
        axis->homing.method = 0;
        if (bridged)
            strcpy(axis->motor, n == SLAVE ? "CM2" : "CM1");
    }
    bench.config.axes[SLAVE].coupling_stop = mode;
    bench.config.axes[SLAVE].invert = true;
}

static void start(void)
{
    static const char *const modes[] = {"this_axis", "coupled_axes", "keep_ratio"};
    cm1e_bus_config_free(&bench.config);
    memset(&bench, 0, sizeof bench);
    describe_axes();
    bench.program = program;
    snprintf(bench.scene, sizeof bench.scene, "%s, %s, %s at cycle %d", kind_names[kind], modes[mode],
             faults[fault].name, fault_cycle);
    armed_cycles = 0;
    over_cycle = -1;
    AXIS_REF_t *const axis = bench.axis;
    for (int n = 0; n < AXES; n++) {
        power[n] = (MC_Power_t){.Axis = &axis[n], .Enable = TRUE, .EnablePositive = TRUE, .EnableNegative = TRUE};
        reset[n] = (MC_Reset_t){.Axis = &axis[n]};
        stop[n] = (MC_Stop_t){.Axis = &axis[n], .Deceleration = 600, .Jerk = 12000};
    }
    drive = (MC_MoveVelocity_t){.Axis = &axis[MASTER], .Velocity = 100, .Acceleration = 500, .Deceleration = 500,
                                .Jerk = 10000};
    drive_other = (MC_MoveVelocity_t){.Axis = &axis[OTHER], .Velocity = 40, .Acceleration = 300, .Jerk = 8000};
    gear = (MC_GearIn_t){.Master = &axis[MASTER], .Slave = &axis[SLAVE], .RatioNumerator = 5, .RatioDenominator = 4,
                         .Acceleration = 300, .Deceleration = 300, .Jerk = 15000};
    gear_beside = (MC_GearIn_t){.Master = &axis[MASTER], .Slave = &axis[BESIDE], .RatioNumerator = -1,
                                .RatioDenominator = 2};
    combine = (MC_CombineAxes_t){.Master1 = &axis[MASTER], .Master2 = &axis[OTHER], .Slave = &axis[SLAVE],
                                 MC_COMBINEAXES_DEFAULTS};
    gear_second = gear;
    gear_second.RatioNumerator = -3;
    combine_second = combine;
    combine_second.CombineMode = mcSubAxes;
    in_pos = (MC_GearInPos_t){.Master = &axis[MASTER], .Slave = &axis[SLAVE], MC_GEARINPOS_DEFAULTS, .Velocity = 400};
    cam_select = (MC_CamTableSelect_t){.Master = &axis[MASTER], .Slave = &axis[SLAVE], .CamTable = &cam_table,
                                       .Execute = TRUE, .Periodic = TRUE};
    cam_in = (MC_CamIn_t){.Master = &axis[MASTER], .Slave = &axis[SLAVE], .StartMode = mcRampIn, .SlaveOffset = 1};
    phasing = (MC_PhasingRelative_t){.Master = &axis[MASTER], .Slave = &axis[SLAVE], .PhaseShift = -3, .Velocity = 40,
                                     .Acceleration = 300, .Deceleration = 300, .Jerk = 6000};
    gear_out = (MC_GearOut_t){.Slave = &axis[SLAVE]};
    bench_open(&bench);
    cm1e_nic_set_tap(cm1e_bus_nic(bench.bus), sweep_tap, &bench);
    bench_start(&bench);
}

static void run(void)
{
    cm1e_diag_t diag = {0};
    start();
    const cm1e_error_t error = bench_run(&bench, &diag);
    MUST(&bench, error == CM1E_OK, "%s", diag.text);
    bench_close(&bench);
}

START_TEST(test_fault_of_coupled_axes_at_every_moment_ends_defined)
{
    const int stride = sweep_stride(STRIDE, SAMPLED_STRIDE);
    int runs = 0;
    fault = (fault_kind_t)_i;
    for (int k = 0; k < KINDS; k++)
        for (int m = 0; m < 3; m++) {
            kind = (kind_t)k;
            mode = (cm1e_coupling_stop_t)m;
            const int first = 1 + (_i * 11 + k * 5 + m * 17) % stride;
            for (fault_cycle = first; fault_cycle < OVER; fault_cycle += stride, runs++)
                run();
        }
    printf("%-40s %4d runs\n", faults[fault].name, runs);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("fault sweep, coupled axes");
    TCase *all = tcase_create("all");
    tcase_set_timeout(all, 280);
    tcase_add_loop_test(all, test_fault_of_coupled_axes_at_every_moment_ends_defined, FAULT_NONE, FAULT_COUNT);
    suite_add_tcase(suite, all);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
