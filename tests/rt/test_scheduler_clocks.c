/* A run that follows the reference clock of its bus: motors move as ever, time in the program is that of the reference,
 * and a loss of synchronism is told. */
#include <math.h>
#include <stdlib.h>

#include "cm1e/clocks.h"
#include "cm1e/log.h"
#include "cm1e/sim.h"
#include "machine.h"

enum { AXES = 2, MS = 1000000 };

typedef struct bench {
    cm1e_bus_t *bus;
    cm1e_scheduler_t *scheduler;
    AXIS_REF_t axis[AXES];
    MC_Power_t power[AXES];
    MC_MoveVelocity_t move[AXES];
    const char *order;   /* to the console, in cycle `when` */
    int64_t when, cycle;
    double slowest, fastest; /* of axis 0, once it is at its velocity */
    bool failed;
} bench_t;

static void simulate(bench_t *b, const char *line)
{
    char answer[200];
    ck_assert_msg(cm1e_bus_simulate(b->bus, line, answer, sizeof answer) == CM1E_OK, "%s: %s", line, answer);
}

/** A CM1-E, whose clock is the reference, and a drive that runs by SYNC0; clocks that drift, in any phase. */
static void open_bench(bench_t *b, bool clocks, const char *drift)
{
    static cm1e_bus_config_t config;
    cm1e_diag_t diag = {0};
    memset(b, 0, sizeof *b);
    ck_assert(cm1e_bus_config_init(&config, "sim", AXES) == CM1E_OK);
    config.virtual_time = true;
    for (int i = 0; i < AXES; i++)
        config.axes[i].sim.no_stops = true;
    strcpy(config.axes[1].device, "cia402");
    config.axes[1].counts_per_revolution = 50000;
    config.axes[1].max_speed_rpm = 3000;
    config.axes[1].dc.sync0_us = clocks ? 1000 : 0;
    ck_assert_msg(cm1e_bus_open(&b->bus, &config, &diag) == CM1E_OK, "%s", diag.text);
    cm1e_bus_config_free(&config);
    simulate(b, drift);
    ck_assert_msg(cm1e_bus_start(b->bus, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_msg(cm1e_scheduler_create(&b->scheduler, b->bus, NULL, &diag) == CM1E_OK, "%s", diag.text);
    for (uint32_t i = 0; i < AXES; i++)
        b->axis[i] = cm1e_scheduler_axis(b->scheduler, i);
}

static void program(void *context)
{
    bench_t *b = context;
    if (b->order && b->cycle++ == b->when)
        simulate(b, b->order);
    for (int i = 0; i < AXES; i++) {
        b->power[i].Enable = b->power[i].EnablePositive = b->power[i].EnableNegative = TRUE;
        b->power[i].Axis = b->move[i].Axis = &b->axis[i];
        MC_Power(&b->power[i]);
        b->move[i].Execute = b->power[i].Status;
        b->move[i].Velocity = 5;
        b->move[i].Acceleration = 100;
        MC_MoveVelocity(&b->move[i]);
        b->failed |= b->power[i].Error || b->move[i].Error;
    }
    cm1e_sim_probe_t probe;
    cm1e_sim_probe(cm1e_bus_segment(b->bus), 1, &probe);
    if (cm1e_scheduler_time_ns(b->scheduler) < 2000 * (int64_t)MS || !b->move[0].InVelocity)
        return;
    b->slowest = fmin(b->slowest, probe.velocity_counts_per_s);
    b->fastest = fmax(b->fastest, probe.velocity_counts_per_s);
}

static void run(bench_t *b, double seconds)
{
    cm1e_diag_t diag = {0};
    const cm1e_task_config_t task = {.name = "program", .program = program, .context = b};
    b->slowest = INFINITY;
    ck_assert_msg(cm1e_scheduler_add_task(b->scheduler, &task, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_msg(cm1e_scheduler_run(b->scheduler, (int64_t)(seconds * 1e9), &diag) == CM1E_OK, "%s", diag.text);
}

static void close_bench(bench_t *b)
{
    cm1e_scheduler_destroy(b->scheduler);
    cm1e_bus_close(b->bus);
}

static bool logged(const bench_t *b, const char *part)
{
    static cm1e_log_event_t events[CM1E_LOG_EVENTS];
    const size_t count = cm1e_log_read(b->scheduler, 0, events, CM1E_LOG_EVENTS, NULL);
    for (size_t i = 0; i < count; i++) {
        char text[512];
        cm1e_log_text(b->scheduler, &events[i], text, sizeof text);
        if (strstr(text, part))
            return true;
    }
    return false;
}

/** The clock of the reference is 200 ppm fast: its seconds are shorter, and so are those of the program. The shaft turns
 *  by the program's time, evenly. */
START_TEST(test_motors_turn_evenly_in_the_time_of_the_reference)
{
    bench_t b;
    open_bench(&b, true, "clock 1 drift 200");
    const int64_t begin_ns = cm1e_clock_now(cm1e_bus_clock(b.bus));
    run(&b, 20);
    const double took_s = (double)(cm1e_clock_now(cm1e_bus_clock(b.bus)) - begin_ns) * 1e-9;
    cm1e_scheduler_statistics_t statistics;
    cm1e_scheduler_statistics(b.scheduler, &statistics);
    ck_assert(!b.failed);
    ck_assert_uint_eq(statistics.overruns, 0);
    ck_assert(statistics.clocks.used);
    ck_assert_uint_eq(statistics.clocks.reference, 1);
    ck_assert_uint_eq(statistics.clocks.sync_losses, 0);
    ck_assert_msg(statistics.clocks.phase_maximum_ns < 20000, "%d ns", (int)statistics.clocks.phase_maximum_ns);
    ck_assert_msg(fabs(statistics.clocks.phase_mean_ns) < 10, "%g ns", statistics.clocks.phase_mean_ns);
    ck_assert_msg(fabs(statistics.clocks.rate_ppm + 200) < 0.5, "%g ppm", statistics.clocks.rate_ppm);
    /* 20 s of the reference, and the ramp down. */
    ck_assert_msg(took_s < 20.5 && took_s > 19.9, "%g s", took_s);
    /* 5 turns of 50,000 counts a second; a cycle without a target would brake by percents. */
    ck_assert_msg(b.slowest > 249800 && b.fastest < 250300, "%g ... %g counts/s", b.slowest, b.fastest);
    ck_assert(!logged(&b, "synchronism"));
    close_bench(&b);
}
END_TEST

START_TEST(test_a_clock_that_is_lost_is_in_log_and_statistics)
{
    bench_t b;
    open_bench(&b, true, "clock 1 drift -30");
    b.order = "clock 2 step 3000";
    b.when = 3000;
    run(&b, 5);
    cm1e_scheduler_statistics_t statistics;
    cm1e_scheduler_statistics(b.scheduler, &statistics);
    ck_assert(!b.failed);
    ck_assert_uint_eq(statistics.clocks.sync_losses, 1);
    ck_assert(logged(&b, "loss of synchronism"));
    close_bench(&b);
}
END_TEST

/** The drive leaves Operational by itself. Its clock is good, but its AL status code says what it misses. */
START_TEST(test_a_drive_whose_pulses_stop_has_lost_synchronism)
{
    bench_t b;
    open_bench(&b, true, "clock 1 drift 0");
    b.order = "clock 2 silent";
    b.when = 3000;
    run(&b, 4);
    ck_assert(b.failed);
    ck_assert(logged(&b, "axis2: ErrorStop"));
    ck_assert(logged(&b, "loss of synchronism"));
    close_bench(&b);
}
END_TEST

START_TEST(test_without_clocks_nothing_is_told_of_them)
{
    bench_t b;
    open_bench(&b, false, "clock 1 drift 200");
    run(&b, 1);
    cm1e_scheduler_statistics_t statistics;
    cm1e_scheduler_statistics(b.scheduler, &statistics);
    ck_assert(!statistics.clocks.used);
    ck_assert(statistics.clocks.rate_ppm == 0);
    close_bench(&b);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("scheduler clocks");
    TCase *all = tcase_create("all");
    tcase_add_test(all, test_motors_turn_evenly_in_the_time_of_the_reference);
    tcase_add_test(all, test_a_clock_that_is_lost_is_in_log_and_statistics);
    tcase_add_test(all, test_a_drive_whose_pulses_stop_has_lost_synchronism);
    tcase_add_test(all, test_without_clocks_nothing_is_told_of_them);
    suite_add_tcase(suite, all);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed != 0;
}
