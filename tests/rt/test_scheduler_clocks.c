/* A run that follows the reference clock of its bus: motors move as ever, time in the program is that of the reference,
 * and a loss of synchronism is told. */
#include <math.h>
#include <stdlib.h>

#include "cm1e/clocks.h"
#include "cm1e/log.h"
#include "cm1e/sim.h"
#include "machine.h"
#include "scheduler/scheduler_window.h"

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

/* ---- several buses ------------------------------------------------------------------------------------------------ */

enum { FIRST = 0, SECOND, BUSES, DRIVE = 2 };

typedef struct pair {
    cm1e_bus_t *buses[BUSES];
    cm1e_scheduler_t *scheduler;
    int64_t cycle, silent_from, silent_to; /* cycles in which the first bus gets no frame */
    int64_t stepped;                       /* cycle in which the second bus loses five frames and a clock; 0: none */
    int64_t lossy_from, lossy_to;          /* cycles in which the second bus loses frames now and then */
    double worst_ns;                       /* of the reference clocks against each other */
    double settled_ns, phase_ns;           /* the same after 5 s; then the largest mean phase of the second bus */
    uint64_t losses[BUSES];
    bool led[BUSES], left[BUSES];          /* `left`: the drive was not in Operational */
} pair_t;

/** A CM1-E, whose clock is the reference, and a drive by SYNC0. */
static cm1e_bus_t *start_one(const char *name, const char *reference, const char *drive)
{
    cm1e_bus_t *bus;
    cm1e_diag_t diag = {0};
    cm1e_bus_config_t config;
    char answer[200];
    ck_assert(cm1e_bus_config_init(&config, "sim", AXES) == CM1E_OK);
    config.virtual_time = true;
    snprintf(config.name, sizeof config.name, "%s", name);
    for (int i = 0; i < AXES; i++)
        snprintf(config.axes[i].name, sizeof config.axes[i].name, "%s%d", name, i + 1);
    strcpy(config.axes[1].device, "cia402");
    config.axes[1].counts_per_revolution = 50000;
    config.axes[1].max_speed_rpm = 3000;
    config.axes[1].dc.sync0_us = 1000;
    ck_assert_msg(cm1e_bus_open(&bus, &config, &diag) == CM1E_OK, "%s", diag.text);
    cm1e_bus_config_free(&config);
    ck_assert(cm1e_bus_simulate(bus, reference, answer, sizeof answer) == CM1E_OK);
    ck_assert(cm1e_bus_simulate(bus, drive, answer, sizeof answer) == CM1E_OK);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    return bus;
}

static void start_pair(pair_t *p)
{
    *p = (pair_t){.silent_from = -1, .lossy_from = -1, .lossy_to = -10000};
    p->buses[FIRST] = start_one("A", "clock 1 drift 40", "clock 2 drift -20");
    p->buses[SECOND] = start_one("B", "clock 1 drift -50", "clock 2 drift 30");
}

/** What the reference clock of the second bus is really ahead of that of the first one. */
static double ahead_ns(const pair_t *p)
{
    cm1e_sim_clock_t clocks[BUSES];
    for (int i = 0; i < BUSES; i++) {
        cm1e_sim_segment_advance(cm1e_bus_segment(p->buses[i]), cm1e_clock_now(cm1e_bus_clock(p->buses[i])));
        cm1e_sim_segment_clock(cm1e_bus_segment(p->buses[i]), 1, &clocks[i]);
    }
    return (double)(clocks[SECOND].system_ns - clocks[FIRST].system_ns) -
           (double)(clocks[SECOND].time_ns - clocks[FIRST].time_ns);
}

static void watch_clocks(void *context)
{
    pair_t *p = context;
    char answer[200];
    if (p->cycle == p->silent_from)
        cm1e_bus_simulate(p->buses[FIRST], "unplug 1", answer, sizeof answer);
    if (p->cycle == p->silent_to)
        cm1e_bus_simulate(p->buses[FIRST], "replug 1", answer, sizeof answer);
    if (p->cycle >= p->lossy_from && p->cycle < p->lossy_to && p->cycle % 97 == 0)
        cm1e_bus_simulate(p->buses[SECOND], p->cycle % 2 ? "lose 2" : "lose 5", answer, sizeof answer);
    if (p->stepped > 0 && p->cycle == p->stepped) {
        cm1e_bus_simulate(p->buses[SECOND], "lose 5", answer, sizeof answer);
        cm1e_bus_simulate(p->buses[SECOND], "clock 2 step 3000", answer, sizeof answer);
    }
    const bool settled = p->cycle > 5000;
    if (p->cycle++ % 50 == 0) {
        const double apart_ns = fabs(ahead_ns(p));
        p->worst_ns = fmax(p->worst_ns, apart_ns);
        p->settled_ns = fmax(p->settled_ns, settled ? apart_ns : 0);
    }
    for (int i = 0; i < BUSES; i++) {
        cm1e_bus_clocks_t clocks;
        cm1e_bus_clocks(p->buses[i], &clocks);
        p->losses[i] = clocks.sync_losses;
        p->led[i] = clocks.led;
        p->left[i] |= cm1e_bus_slave_watch(p->buses[i], DRIVE).al_state != CM1E_AL_OP;
        /* waiting for a lost frame delays the next one */
        const bool delayed = p->cycle >= p->lossy_from && p->cycle < p->lossy_to + 2000;
        p->phase_ns = fmax(p->phase_ns, settled && !delayed && i == SECOND ? fabs(clocks.phase_mean_ns) : 0);
    }
}

/** The scheduler is made for the bus `made_for`. */
static void run_pair(pair_t *p, int made_for, double seconds)
{
    cm1e_diag_t diag = {0};
    const cm1e_task_config_t task = {.name = "program", .program = watch_clocks, .context = p};
    ck_assert_msg(cm1e_scheduler_create(&p->scheduler, p->buses[made_for], NULL, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_msg(cm1e_scheduler_add_bus(p->scheduler, p->buses[1 - made_for], &diag) == CM1E_OK, "%s", diag.text);
    ck_assert(cm1e_scheduler_add_task(p->scheduler, &task, &diag) == CM1E_OK);
    ck_assert_msg(cm1e_scheduler_run(p->scheduler, (int64_t)(seconds * 1e9), &diag) == CM1E_OK, "%s", diag.text);
}

static void close_pair(pair_t *p)
{
    cm1e_scheduler_destroy(p->scheduler);
    for (int i = 0; i < BUSES; i++)
        cm1e_bus_close(p->buses[i]);
}

/** The clocks of the bus that was started first lead, whichever bus the scheduler was made for. Both buses have their
 *  frames at a constant phase of their own reference, and their drives stay in Operational. */
START_TEST(test_the_clocks_of_a_second_bus_follow_those_of_the_first)
{
    pair_t p;
    start_pair(&p);
    ck_assert_msg(fabs(ahead_ns(&p)) < 1000, "after the start: %g ns", ahead_ns(&p));
    run_pair(&p, _i, 20);
    ck_assert_msg(p.worst_ns < 1000, "%g ns", p.worst_ns);
    printf("references at most %.0f ns apart; after 5 s %.0f ns, phase of the second bus %.0f ns\n", p.worst_ns,
           p.settled_ns, p.phase_ns);
    ck_assert_msg(p.settled_ns < 150 && p.phase_ns < 200, "%g ns, %g ns", p.settled_ns, p.phase_ns);
    ck_assert(!p.led[FIRST] && p.led[SECOND] && !p.left[FIRST] && !p.left[SECOND]);
    ck_assert_msg(p.losses[FIRST] + p.losses[SECOND] == 0, "%d, %d", (int)p.losses[FIRST], (int)p.losses[SECOND]);
    cm1e_scheduler_statistics_t statistics;
    cm1e_scheduler_statistics(p.scheduler, &statistics);
    ck_assert(statistics.clocks.used && !statistics.clocks.led);
    ck_assert_msg(fabs(statistics.clocks.rate_ppm + 40) < 1, "%g ppm", statistics.clocks.rate_ppm);
    ck_assert_uint_eq(statistics.overruns, 0);
    close_pair(&p);
}
END_TEST

/** Its clocks followed those of the other one when it was started, but nobody keeps these. */
START_TEST(test_a_bus_that_runs_without_the_one_that_it_followed_leads_itself)
{
    pair_t p;
    cm1e_diag_t diag = {0};
    cm1e_bus_clocks_t clocks;
    start_pair(&p);
    cm1e_bus_clocks(p.buses[SECOND], &clocks);
    ck_assert(clocks.led);
    const cm1e_task_config_t task = {.name = "program", .program = watch_clocks, .context = &p};
    ck_assert_msg(cm1e_scheduler_create(&p.scheduler, p.buses[SECOND], NULL, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert(cm1e_scheduler_add_task(p.scheduler, &task, &diag) == CM1E_OK);
    ck_assert_msg(cm1e_scheduler_run(p.scheduler, 2 * INT64_C(1000000000), &diag) == CM1E_OK, "%s", diag.text);
    ck_assert(!p.led[SECOND] && !p.left[SECOND] && p.losses[SECOND] == 0);
    close_pair(&p);
}
END_TEST

/** The bus that leads gets no frame for two seconds: the other one goes on by the rate that the cycle has learnt. */
START_TEST(test_the_second_bus_keeps_the_time_of_a_first_one_that_is_silent)
{
    pair_t p;
    start_pair(&p);
    p.silent_from = 8000;
    p.silent_to = 10000;
    run_pair(&p, FIRST, 14);
    ck_assert(p.left[FIRST] && !p.left[SECOND]);
    ck_assert_uint_eq(p.losses[SECOND], 0);
    ck_assert_msg(p.worst_ns < 1000, "%g ns", p.worst_ns);
    close_pair(&p);
}
END_TEST

/** Also of the frames that tell its reference the time: each is given up when the next one leaves. */
START_TEST(test_the_second_bus_follows_although_it_loses_frames)
{
    pair_t p;
    start_pair(&p);
    p.lossy_from = 6000;
    p.lossy_to = 15000;
    run_pair(&p, FIRST, 20);
    ck_assert(p.led[SECOND] && !p.left[FIRST] && !p.left[SECOND]);
    ck_assert_uint_eq(p.losses[FIRST] + p.losses[SECOND], 0);
    ck_assert_msg(p.settled_ns < 150 && p.phase_ns < 200, "%g ns, %g ns", p.settled_ns, p.phase_ns);
    close_pair(&p);
}
END_TEST

/** A clock of the bus that leads none is lost: the record and the numbers are of that bus. */
START_TEST(test_a_clock_that_is_lost_is_told_of_its_own_bus)
{
    pair_t p;
    start_pair(&p);
    p.stepped = 6000;
    run_pair(&p, FIRST, 8);
    static cm1e_log_event_t events[CM1E_LOG_EVENTS];
    const size_t count = cm1e_log_read(p.scheduler, 0, events, CM1E_LOG_EVENTS, NULL);
    unsigned told = 0;
    for (size_t i = 0; i < count; i++) {
        char text[512];
        if (events[i].kind != CM1E_LOG_SYNC_LOST)
            continue;
        cm1e_log_text(p.scheduler, &events[i], text, sizeof text);
        ck_assert_msg(events[i].value == SECOND && strstr(text, "network B") == text, "%s", text);
        told += (unsigned)events[i].code;
    }
    cm1e_bus_counters_t counters;
    cm1e_scheduler_statistics_t statistics;
    cm1e_scheduler_statistics(p.scheduler, &statistics);
    ck_assert_uint_eq(told, 1);
    ck_assert_uint_eq(cm1e_scheduler_counted(p.scheduler, FIRST, &counters), 0);
    ck_assert_uint_eq(counters.lost_frames, 0);
    ck_assert_uint_eq(cm1e_scheduler_counted(p.scheduler, SECOND, &counters), 1);
    ck_assert_uint_gt(counters.lost_frames, 0);
    ck_assert_uint_eq(statistics.bus.lost_frames, counters.lost_frames);
    ck_assert_uint_eq(statistics.clocks.sync_losses, 1);
    close_pair(&p);
}
END_TEST

START_TEST(test_clocks_that_follow_no_common_one_are_refused)
{
    pair_t p;
    cm1e_diag_t diag = {0};
    start_pair(&p);
    cm1e_bus_clocks_t clocks;
    cm1e_bus_clocks(p.buses[SECOND], &clocks);
    ck_assert(clocks.led);
    cm1e_bus_follow_clock(p.buses[SECOND], NULL); /* as if another thread had started it */
    ck_assert(cm1e_scheduler_create(&p.scheduler, p.buses[FIRST], NULL, &diag) == CM1E_OK);
    ck_assert_int_eq(cm1e_scheduler_add_bus(p.scheduler, p.buses[SECOND], &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_msg(strstr(diag.text, "do not follow each other: start the buses in one thread") != NULL, "%s", diag.text);
    close_pair(&p);
}
END_TEST

/** The bus that led is stopped: the other one leads itself, and leads the first one when that is started again. */
START_TEST(test_the_lead_goes_over_when_a_bus_stops)
{
    pair_t p;
    cm1e_diag_t diag = {0};
    cm1e_bus_clocks_t clocks;
    start_pair(&p);
    cm1e_bus_stop(p.buses[FIRST]);
    cm1e_bus_clocks(p.buses[SECOND], &clocks);
    ck_assert(clocks.used && !clocks.led);
    ck_assert_msg(cm1e_bus_start(p.buses[FIRST], &diag) == CM1E_OK, "%s", diag.text);
    cm1e_bus_clocks(p.buses[FIRST], &clocks);
    ck_assert(clocks.used && clocks.led);
    run_pair(&p, FIRST, 5);
    ck_assert_msg(p.worst_ns < 1000, "%g ns", p.worst_ns);
    close_pair(&p);
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
    tcase_add_loop_test(all, test_the_clocks_of_a_second_bus_follow_those_of_the_first, 0, BUSES);
    tcase_add_test(all, test_a_bus_that_runs_without_the_one_that_it_followed_leads_itself);
    tcase_add_test(all, test_the_second_bus_keeps_the_time_of_a_first_one_that_is_silent);
    tcase_add_test(all, test_the_second_bus_follows_although_it_loses_frames);
    tcase_add_test(all, test_a_clock_that_is_lost_is_told_of_its_own_bus);
    tcase_add_test(all, test_clocks_that_follow_no_common_one_are_refused);
    tcase_add_test(all, test_the_lead_goes_over_when_a_bus_stops);
    suite_add_tcase(suite, all);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed != 0;
}
