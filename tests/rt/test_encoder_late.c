/* An axis that follows an encoder terminal, where cycles begin late and are left out, as on a machine without a
 * real-time kernel, and where frames are lost. The encoder turns on meanwhile: that is no unevenness of its motion, and
 * what the axis has lost of its way is made up. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bus/bus_image.h"
#include "cm1e/plcopen.h"
#include "cm1e/scheduler.h"
#include "cm1e/sim.h"
#include "quick_check.h"
#include "xorshift.h"

#define MS INT64_C(1000000)

enum { BELT = 0, FEEDER, AXES };
static const double counts_per_s = 30720, counts_per_mm = 204.8; /* 150 mm/s */
static const int64_t coupled_ns = 1000 * MS, disturbed_ns = 1500 * MS, calm_ns = 2000 * MS, made_up_ns = 2300 * MS;
static const int64_t end_ns = 2500 * MS;

static struct {
    cm1e_bus_config_t config;
    cm1e_bus_t *bus;
    cm1e_scheduler_t *scheduler;
    AXIS_REF_t axis[AXES];
    MC_Power_t power;
    MC_GearIn_t gear;
    uint64_t seed;
    double distance_before, distance_behind, fastest;
    int64_t takes_ns; /* once; 0: each cycle by chance */
    int lost_frames;
    double sync0_us; /* the terminal takes its counts with it; 0: when the frame passes */
} machine;

static void describe(void)
{
    ck_assert_int_eq(cm1e_bus_config_init(&machine.config, "sim", AXES), CM1E_OK);
    machine.config.virtual_time = true;
    machine.config.axes[BELT] = (cm1e_axis_config_t){.name = "belt", .type = CM1E_AXIS_ENCODER, .max_velocity = 1500,
                                                     .counts_per_unit = counts_per_mm, .encoder_filter_s = 0.02,
                                                     .wiring.encoder = "counter.position"};
    machine.config.axes[FEEDER] = (cm1e_axis_config_t){
        .name = "feeder", .address = 2, .counts_per_unit = 5000, .max_velocity = 400, .max_acceleration = 2000,
        .max_deceleration = 2000, .max_jerk = 100000, .max_position_lag = 20, .sim.no_stops = true};
    cm1e_slave_config_t *counter = cm1e_bus_config_add_slave(&machine.config, "counter");
    ck_assert_ptr_nonnull(counter);
    counter->address = 1;
    counter->signals[0] = (cm1e_signal_config_t){.name = "position", .index = 0x6000, .subindex = 0x11,
                                                 .type_stated = true, .type = CM1E_IO_UDINT};
    counter->signal_count = 1;
    counter->dc.sync0_us = machine.sync0_us;
    counter->sim = (cm1e_sim_slave_config_t){.kind = CM1E_SIM_SLAVE_ENCODER, .inputs = 1,
                                             .counts_per_s = counts_per_s};
}

static void program(void *context)
{
    (void)context;
    const int64_t now_ns = cm1e_scheduler_time_ns(machine.scheduler);
    cm1e_axis_info_t belt, feeder;
    char text[300];
    machine.power.Enable = TRUE;
    MC_Power(&machine.power);
    machine.gear.Execute = now_ns >= 300 * MS && machine.power.Status;
    MC_GearIn(&machine.gear);
    cm1e_axis_read(machine.axis[BELT], &belt);
    cm1e_axis_read(machine.axis[FEEDER], &feeder);
    cm1e_axis_error_text(machine.axis[FEEDER], text, sizeof text);
    const bool in_gear = now_ns < coupled_ns || (now_ns > disturbed_ns && now_ns < made_up_ns) || machine.gear.InGear;
    ck_assert_msg(in_gear, "%lld ms", (long long)(now_ns / MS));
    ck_assert_msg(feeder.state != CM1E_AXIS_ERROR_STOP, "%lld ms: %s", (long long)(now_ns / MS), text);
    const double distance = feeder.set_position - belt.actual_position;
    if (now_ns <= disturbed_ns)
        machine.distance_before = distance;
    else
        machine.fastest = fmax(machine.fastest, fabs(belt.actual_velocity - 150));
    machine.distance_behind = distance;
}

/** Below the program: the frame is sent late by what it takes. */
static void disturb(void *context)
{
    (void)context;
    const int64_t now_ns = cm1e_scheduler_time_ns(machine.scheduler);
    cm1e_clock_t *clock = cm1e_bus_clock(machine.bus);
    char command[20], answer[80];
    int64_t passes_ns = machine.takes_ns;
    if (now_ns <= disturbed_ns || now_ns >= calm_ns)
        return;
    if (passes_ns == 0 && machine.lost_frames == 0)
        passes_ns = (int64_t)(xorshift_between(&machine.seed, 0, 0.7) * (double)MS);
    else if (now_ns != disturbed_ns + MS)
        return;
    snprintf(command, sizeof command, "lose %d", machine.lost_frames);
    if (machine.lost_frames > 0)
        cm1e_bus_simulate(machine.bus, command, answer, sizeof answer);
    if (passes_ns > 0)
        cm1e_clock_sleep_until(clock, cm1e_clock_now(clock) + passes_ns);
}

static void run(int64_t takes_ns, int lost_frames, double sync0_us)
{
    cm1e_diag_t diag = {0};
    memset(&machine, 0, sizeof machine);
    machine.seed = 4711;
    machine.takes_ns = takes_ns;
    machine.lost_frames = lost_frames;
    machine.sync0_us = sync0_us;
    describe();
    ck_assert_msg(cm1e_bus_open(&machine.bus, &machine.config, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_msg(cm1e_bus_start(machine.bus, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_int_eq(cm1e_scheduler_create(&machine.scheduler, machine.bus, NULL, &diag), CM1E_OK);
    for (uint32_t i = 0; i < AXES; i++)
        machine.axis[i] = cm1e_scheduler_axis(machine.scheduler, i);
    machine.power = (MC_Power_t){.Axis = &machine.axis[FEEDER], .EnablePositive = TRUE, .EnableNegative = TRUE};
    machine.gear = (MC_GearIn_t){.Master = &machine.axis[BELT], .Slave = &machine.axis[FEEDER], .RatioNumerator = 1,
                                 .RatioDenominator = 1, .MasterValueSource = mcActualValue};
    const cm1e_task_config_t tasks[] = {{.name = "program", .program = program},
                                        {.name = "disturb", .priority = 9, .program = disturb}};
    for (int i = 0; i < 2; i++)
        ck_assert_int_eq(cm1e_scheduler_add_task(machine.scheduler, &tasks[i], &diag), CM1E_OK);
    ck_assert_msg(cm1e_scheduler_run(machine.scheduler, end_ns, &diag) == CM1E_OK, "%s", diag.text);
    cm1e_scheduler_destroy(machine.scheduler);
    cm1e_bus_close(machine.bus);
    cm1e_bus_config_free(&machine.config);
}

/* The velocity that followers see: without the times of the frames it was 50 mm/s wrong. */
START_TEST(test_late_frames_are_no_motion_of_the_encoder)
{
    static const double sync0_us[] = {0, 1000, 500};
    run(0, 0, sync0_us[_i]);
    ck_assert_double_le(machine.fastest, 3);
    ck_assert_double_eq_tol(machine.distance_behind, machine.distance_before, 0.02);
}
END_TEST

START_TEST(test_what_is_lost_of_the_way_of_an_encoder_is_made_up)
{
    static const struct {
        int64_t takes_ns;
        int lost_frames;
    } cases[] = {{MS + MS / 2, 0}, {2 * MS + MS / 2, 0}, {3 * MS + MS / 2, 0}, {0, 1}, {0, 2}};
    const double sync0_us = _i % 2 ? 1000 : 0;
    run(cases[_i / 2].takes_ns, cases[_i / 2].lost_frames, sync0_us);
    ck_assert_double_le(machine.fastest, 3);
    ck_assert_double_eq_tol(machine.distance_behind, machine.distance_before, 0.02);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("encoder where cycles are late");
    TCase *tests = tcase_create("virtual time");
    tcase_add_loop_test(tests, test_late_frames_are_no_motion_of_the_encoder, 0, 3);
    tcase_add_loop_test(tests, test_what_is_lost_of_the_way_of_an_encoder_is_made_up, 0, 10);
    suite_add_tcase(suite, tests);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
