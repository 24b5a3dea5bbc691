/**
 * A jog into a software limit, with less deceleration and jerk than the axis has, and frames that do not come back, or a
 * host that pauses, at every phase of its braking. The motor has lost speed then, and its motion begins anew, without the
 * acceleration that it had: it ends at the limit all the same, and not beyond.
 */
#include <math.h>
#include <stdlib.h>

#include "cm1e/sim.h"
#include "effort.h"
#include "machine.h"
#include "nic/nic.h"

typedef enum loss { PAUSE = 0, LOST_OUT, LOST_BACK, LOSSES } loss_t;
enum { PRESSED = 60, RELEASED = 500, END = 600, BRAKES = 240, RESTS = 380 };
static const int64_t cycle_ns = 1000000;
static const double limit_u = 25, count_u = 1e-3, rounding_u = 1e-6;

typedef struct run {
    machine_t machine;
    loss_t loss;
    int cycles, at, cycle; /**< cycles: of the loss, which begins in cycle `at` */
    MC_Power_t power;
    MC_Jog_t jog;
    double farthest;
} run_t;

static void judge(const run_t *run, const cm1e_axis_info_t *info)
{
    char text[CM1E_AXIS_ERROR_TEXT_BYTES];
    cm1e_axis_error_text(run->machine.axis[0], text, sizeof text);
    ck_assert_msg(info->state == CM1E_AXIS_STANDSTILL && fabs(info->set_position - limit_u) < rounding_u &&
                  run->farthest < limit_u + count_u,
                  "loss %d, %d cycles in cycle %d: %s at %.7f u, farthest %.7f u. %s", run->loss, run->cycles, run->at,
                  cm1e_axis_state_name(info->state), info->set_position, run->farthest, text);
}

static void program(void *context)
{
    run_t *run = context;
    cm1e_axis_info_t info = {0};
    cm1e_axis_read(run->machine.axis[0], &info);
    run->farthest = fmax(run->farthest, info.set_position);
    run->power.Enable = TRUE;
    MC_Power(&run->power);
    run->jog.JogForward = run->cycle >= PRESSED && run->cycle < RELEASED;
    MC_Jog(&run->jog);
    if (run->loss == PAUSE && run->cycle == run->at) {
        cm1e_clock_t *clock = cm1e_bus_clock(run->machine.bus);
        cm1e_clock_sleep_until(clock, cm1e_clock_now(clock) + run->cycles * cycle_ns + cycle_ns / 2);
    }
    if (run->cycle++ < END)
        return;
    judge(run, &info);
    cm1e_scheduler_stop(run->machine.scheduler);
}

static cm1e_tap_verdict_t lose(void *context, cm1e_tap_frame_t *frame)
{
    const run_t *run = context;
    const bool now = run->loss != PAUSE && run->cycle >= run->at && run->cycle < run->at + run->cycles;
    return now && (frame->direction == CM1E_TAP_SENT) == (run->loss == LOST_OUT) ? CM1E_TAP_DROP : CM1E_TAP_PASS;
}

static void play(run_t run)
{
    static cm1e_bus_config_t config;
    cm1e_diag_t diag = {0};
    machine_t *m = &run.machine;
    cm1e_bus_config_free(&config);
    ck_assert(cm1e_bus_config_init(&config, "sim", 1) == CM1E_OK);
    config.virtual_time = true;
    config.cycle_time_ns = cycle_ns;
    config.lost_cycles_limit = 40;
    config.axes[0] = (cm1e_axis_config_t){.counts_per_unit = 1000, .max_velocity = 400, .max_acceleration = 3285,
                                          .max_deceleration = 3285, .max_jerk = 127965, .sim.no_stops = true,
                                          .software_limit_negative = -limit_u, .software_limit_positive = limit_u};
    ck_assert_msg(cm1e_bus_open(&m->bus, &config, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_msg(cm1e_bus_start(m->bus, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_msg(cm1e_scheduler_create(&m->scheduler, m->bus, NULL, &diag) == CM1E_OK, "%s", diag.text);
    cm1e_nic_set_tap(cm1e_bus_nic(m->bus), lose, &run);
    m->axis[0] = cm1e_scheduler_axis(m->scheduler, 0);
    run.power = (MC_Power_t){.Axis = &m->axis[0], .EnablePositive = TRUE, .EnableNegative = TRUE};
    run.jog = (MC_Jog_t){.Axis = &m->axis[0], .Mode = MC_JOGMODE_CONTINOUS, .Velocity = 150, .Acceleration = 1300,
                         .Deceleration = 2500, .Jerk = 30000};
    machine_add(m, "jog", 0, 0, program, &run);
    machine_run(m, 0);
    machine_close(m);
}

START_TEST(test_a_jog_ends_at_its_limit_also_behind_lost_frames_and_pauses)
{
    static const int lengths[] = {1, 2, 3, 8};
    for (int loss = 0; loss < LOSSES; loss++)
        for (int l = 0; l < 4; l++)
            for (int at = BRAKES + sweep_first(l, sweep_stride(1, 3)); at < RESTS; at += sweep_stride(1, 3))
                play((run_t){.loss = (loss_t)loss, .cycles = lengths[l], .at = at});
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("a software limit, and cycles that are late or lost");
    TCase *cases = tcase_create("late");
    tcase_set_timeout(cases, 120);
    tcase_add_test(cases, test_a_jog_ends_at_its_limit_also_behind_lost_frames_and_pauses);
    suite_add_tcase(suite, cases);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
