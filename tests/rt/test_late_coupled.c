/**
 * A slave and its master, of which one or both are in CSV or virtual, and a host that pauses, or frames that do not come
 * back, at every phase of a motion. A motor in CSV goes on meanwhile, one in CSP and a virtual axis wait. Whichever did what:
 * the slave is in step again, at its old distance, without an error, and hardly faster than its master needs.
 */
#include <math.h>
#include <stdlib.h>

#include "cm1e/sim.h"
#include "effort.h"
#include "machine.h"
#include "nic/nic.h"

typedef enum loss { PAUSE = 0, LOST_OUT, LOST_BACK, LOSSES } loss_t;
static const char *const loss_names[LOSSES] = {"pause", "frames lost on the way out", "frames lost on the way back"};

/** Master, slave. */
typedef enum kind { VIRTUAL = 0, CSP, CSV, PROFILE } kind_t;
static const kind_t pairs[][2] = {{VIRTUAL, CSV}, {CSP, CSV}, {CSV, CSP}, {CSV, CSV}, {VIRTUAL, CSP}, {CSP, CSP},
                                  {PROFILE, CSP}, {PROFILE, CSV}}; /* the last two by their actual value only */
enum { PAIRS = sizeof pairs / sizeof pairs[0], PAIRS_BY_SET_VALUE = PAIRS - 2 };

enum { MASTER = 0, SLAVE, AXES, IN_GEAR = 90, TURNED = 100, BACK = 500, HALTED = 900, END = 2600 };
static const int64_t cycle_ns = 1000000;
static const double unit = 1000, limit_u = 400, speed_u = 150, acceleration_u = 3285, jerk_u = 127965;
static const double part = 0.4; /* of its limits, with which the master accelerates */

typedef struct run {
    machine_t machine;
    kind_t kind[AXES];
    MC_SOURCE source;
    loss_t loss;
    int cycles, at, cycle; /**< cycles: of the loss, which begins in cycle `at` */
    int64_t pause_ns;      /**< 0: these cycles */
    int more, every;       /**< more pauses, with so many cycles between their beginnings */
    MC_Power_t power[AXES];
    MC_GearIn_t gear;
    MC_MoveVelocity_t turn, back;
    MC_Halt_t halt;
    double apart, fastest; /**< u; u/s of the slave */
    int latest, turned;    /**< cycle; turned: in which the master has its velocity backwards */
} run_t;

static cm1e_axis_info_t info_of(const run_t *run, int n)
{
    cm1e_axis_info_t info = {0};
    cm1e_axis_read(run->machine.axis[n], &info);
    return info;
}

static void call_blocks(run_t *run)
{
    for (int n = 0; n < AXES; n++) {
        run->power[n].Enable = TRUE;
        MC_Power(&run->power[n]);
    }
    run->gear.Execute = run->cycle >= IN_GEAR - 10;
    run->turn.Execute = run->cycle >= TURNED;
    run->back.Execute = run->cycle >= BACK;
    run->halt.Execute = run->cycle >= HALTED;
    MC_GearIn(&run->gear);
    MC_MoveVelocity(&run->turn);
    MC_MoveVelocity(&run->back);
    MC_Halt(&run->halt);
}

static double apart(const run_t *run)
{
    const cm1e_axis_info_t master = info_of(run, MASTER);
    return info_of(run, SLAVE).set_position -
           (run->source == mcActualValue ? master.actual_position : master.set_position);
}

static void judge(const run_t *run)
{
    char scene[160], text[CM1E_AXIS_ERROR_TEXT_BYTES];
    snprintf(scene, sizeof scene, "master %d, slave %d, source %d, %s, %d cycles or %g ms in cycle %d, %d more", run->kind[MASTER],
             run->kind[SLAVE], run->source, loss_names[run->loss], run->cycles, (double)run->pause_ns * 1e-6, run->at, run->more);
    cm1e_axis_error_text(run->machine.axis[SLAVE], text, sizeof text);
    ck_assert_msg(!run->gear.Error && info_of(run, SLAVE).state == CM1E_AXIS_SYNCHRONIZED_MOTION, "%s: %s", scene, text);
    const double rounding = run->source == mcActualValue ? 0.06 : 1e-6; /* a motor in CSV rests where friction holds it */
    const double slip = apart(run) - run->apart;
    ck_assert_msg(run->gear.InGear && fabs(slip) < rounding, "%s: InGear %d, slip of %g u", scene, run->gear.InGear, slip);
    const double most = speed_u + 0.1 * (limit_u - speed_u); /* it makes up distance with a tenth of what is left */
    ck_assert_msg(!run->latest || run->turned <= run->latest, "%s: it turns round until cycle %d", scene, run->turned);
    ck_assert_msg(run->fastest < 1.05 * most, "%s: the slave has %g u/s", scene, run->fastest);
}

static bool is_paused(const run_t *run)
{
    const int since = run->cycle - run->at;
    return run->loss == PAUSE && (since == 0 || (since > 0 && since <= run->more * run->every && since % run->every == 0));
}

static void program(void *context)
{
    run_t *run = context;
    cm1e_sim_probe_t probe;
    call_blocks(run);
    cm1e_sim_probe(cm1e_bus_segment(run->machine.bus), run->kind[MASTER] == VIRTUAL ? 1 : 2, &probe);
    if (run->turned == 0 && run->back.InVelocity)
        run->turned = run->cycle;
    run->fastest = fmax(run->fastest, probe.peak_velocity_counts_per_s / unit);
    if (run->cycle == IN_GEAR)
        run->apart = apart(run);
    if (is_paused(run)) {
        cm1e_clock_t *clock = cm1e_bus_clock(run->machine.bus);
        cm1e_clock_sleep_until(clock, cm1e_clock_now(clock) + (run->pause_ns ? run->pause_ns : run->cycles * cycle_ns));
    }
    if (run->cycle++ == END) {
        judge(run);
        cm1e_scheduler_stop(run->machine.scheduler);
    }
}

static cm1e_tap_verdict_t lose(void *context, cm1e_tap_frame_t *frame)
{
    const run_t *run = context;
    const bool now = run->loss != PAUSE && run->cycle >= run->at && run->cycle < run->at + run->cycles;
    return now && (frame->direction == CM1E_TAP_SENT) == (run->loss == LOST_OUT) ? CM1E_TAP_DROP : CM1E_TAP_PASS;
}

static void describe(const run_t *run, cm1e_bus_config_t *config)
{
    cm1e_bus_config_free(config);
    ck_assert(cm1e_bus_config_init(config, "sim", AXES) == CM1E_OK);
    config->virtual_time = true;
    config->cycle_time_ns = cycle_ns;
    config->lost_cycles_limit = 40;
    for (int n = 0; n < AXES; n++) {
        cm1e_axis_config_t *axis = &config->axes[n];
        axis->counts_per_unit = unit;
        axis->max_velocity = limit_u;
        axis->max_acceleration = axis->max_deceleration = acceleration_u;
        axis->max_jerk = jerk_u;
        axis->type = run->kind[n] == VIRTUAL ? CM1E_AXIS_VIRTUAL : CM1E_AXIS_MOTOR;
        axis->mapping = run->kind[n] == CSV ? CM1E_MAPPING_CSV : CM1E_MAPPING_DYNAMIC;
        if (run->kind[n] == PROFILE) {
            axis->mapping = CM1E_MAPPING_PROFILE;
            axis->motion = CM1E_MOTION_DRIVE;
        }
        if (n == SLAVE && run->kind[MASTER] == PROFILE) /* a drive uses all of its acceleration to turn round */
            axis->max_acceleration = axis->max_deceleration = 2 * acceleration_u;
        axis->sim.no_stops = run->kind[n] != VIRTUAL;
    }
}

static void make_blocks(run_t *run)
{
    AXIS_REF_t *axis = run->machine.axis;
    const double a = part * acceleration_u, j = run->kind[MASTER] == PROFILE ? 0 : part * jerk_u;
    for (int n = 0; n < AXES; n++)
        run->power[n] = (MC_Power_t){.Axis = &axis[n], .EnablePositive = TRUE, .EnableNegative = TRUE};
    run->gear = (MC_GearIn_t){.Master = &axis[MASTER], .Slave = &axis[SLAVE], .MasterValueSource = run->source,
                              .RatioNumerator = 1, .RatioDenominator = 1};
    run->turn = (MC_MoveVelocity_t){.Axis = &axis[MASTER], .Velocity = speed_u, .Acceleration = a, .Jerk = j};
    run->back = run->turn;
    run->back.Direction = mcNegativeDirection;
    run->back.Velocity = speed_u / 2;
    run->back.Deceleration = a;
    run->halt = (MC_Halt_t){.Axis = &axis[MASTER], .Deceleration = a, .Jerk = j};
}

static void play(run_t run)
{
    static cm1e_bus_config_t config;
    cm1e_diag_t diag = {0};
    machine_t *m = &run.machine;
    describe(&run, &config);
    ck_assert_msg(cm1e_bus_open(&m->bus, &config, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_msg(cm1e_bus_start(m->bus, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_msg(cm1e_scheduler_create(&m->scheduler, m->bus, NULL, &diag) == CM1E_OK, "%s", diag.text);
    cm1e_nic_set_tap(cm1e_bus_nic(m->bus), lose, &run);
    for (uint32_t n = 0; n < AXES; n++)
        m->axis[n] = cm1e_scheduler_axis(m->scheduler, n);
    make_blocks(&run);
    machine_add(m, "turn", 0, 0, program, &run);
    machine_run(m, 0);
    machine_close(m);
}

static void at_every_phase(MC_SOURCE source)
{
    static const int lengths[] = {1, 2, 3, 7, 30};
    enum { LENGTHS = 5 };
    int number = source == mcActualValue;
    const int stride = sweep_stride(29, 389), last = source == mcActualValue ? PAIRS : PAIRS_BY_SET_VALUE;
    for (int pair = 0; pair < last; pair++)
        for (int loss = 0; loss < LOSSES; loss++)
            for (int l = 0; l < LENGTHS; l++, number++)
                for (int at = TURNED + 1 + number * 67 % stride; at < HALTED + 200; at += stride)
                    play((run_t){.kind = {pairs[pair][0], pairs[pair][1]}, .source = source, .loss = (loss_t)loss,
                                 .cycles = lengths[l], .at = at});
}

START_TEST(test_a_slave_is_in_step_again_at_its_old_distance)
{
    at_every_phase(mcSetValue);
}
END_TEST

START_TEST(test_a_slave_of_an_actual_value_rides_it_out)
{
    at_every_phase(mcActualValue);
}
END_TEST

/** With one or two missed cycles each, also while the master turns round: there its motor swings round a set-point that
 *  hardly moves, and was followed as one that a load has turned on. */
START_TEST(test_a_host_that_is_late_again_and_again_neither_ends_a_gear_nor_holds_its_master)
{
    static const int percent[] = {102, 151, 250, 298}, every[] = {2, 3, 10};
    enum { PERCENTS = 4, EVERIES = 3, PAUSES = 20, TURN = 197 };
    int number = 0;
    const int stride = sweep_stride(7, 61);
    for (int pair = 0; pair < PAIRS_BY_SET_VALUE; pair++)
        for (int p = 0; p < PERCENTS; p++)
            for (int e = 0; e < EVERIES; e++, number++)
                for (int at = BACK - PAUSES * every[e] + number * 17 % stride; at < BACK + 200; at += stride)
                    play((run_t){.kind = {pairs[pair][0], pairs[pair][1]}, .at = at, .more = PAUSES - 1,
                                 .every = every[e], .pause_ns = percent[p] * cycle_ns / 100,
                                 .latest = at + PAUSES * every[e] + TURN + 40});
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("followers, and cycles that are late or lost");
    TCase *cases = tcase_create("late");
    tcase_set_timeout(cases, 300);
    tcase_add_test(cases, test_a_slave_is_in_step_again_at_its_old_distance);
    tcase_add_test(cases, test_a_slave_of_an_actual_value_rides_it_out);
    tcase_add_test(cases, test_a_host_that_is_late_again_and_again_neither_ends_a_gear_nor_holds_its_master);
    suite_add_tcase(suite, cases);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
