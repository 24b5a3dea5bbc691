/**
 * Tasks, time, overruns, statistics and ends of a run, on virtual time: what happens when is exact.
 */
#include <pthread.h>
#include <stdlib.h>
#include <unistd.h>

#include "cm1e/iec.h"
#include "cm1e/scan_time.h"
#include "cm1e/sim.h"
#include "machine.h"

#define MS INT64_C(1000000)

/* ---- tasks ----------------------------------------------------------------------------------------------------- */

enum { LOG_SIZE = 4096 };
static struct {
    char letter;
    int64_t time_ns;
} task_log[LOG_SIZE];
static unsigned logged;

typedef struct logger {
    char letter;
    cm1e_scheduler_t *scheduler;
} logger_t;

static void log_program(void *context)
{
    const logger_t *logger = context;
    ck_assert_uint_lt(logged, LOG_SIZE);
    task_log[logged].letter = logger->letter;
    task_log[logged++].time_ns = cm1e_scheduler_time_ns(logger->scheduler);
}

START_TEST(test_tasks_run_by_priority_and_interval_from_the_first_cycle_on)
{
    machine_t machine = {.axis_count = 1};
    machine_open(&machine);
    logger_t a = {'a', machine.scheduler}, b = {'b', machine.scheduler}, c = {'c', machine.scheduler},
             d = {'d', machine.scheduler};
    logged = 0;
    machine_add(&machine, "slow", 4 * MS, 7, log_program, &a);
    machine_add(&machine, "", 0, 3, log_program, &b);
    machine_add(&machine, NULL, 2 * MS, 7, log_program, &c);
    machine_add(&machine, "first", 1 * MS, 0, log_program, &d);
    machine_run(&machine, 9 * MS);
    static const char expected[] = "dbac" "db" "dbc" "db" "dbac" "db" "dbc" "db" "dbac";
    static const int64_t cycles[] = {4, 2, 3, 2, 4, 2, 3, 2, 4};
    ck_assert_uint_eq(logged, sizeof expected - 1);
    unsigned n = 0;
    for (int cycle = 0; cycle < 9; cycle++)
        for (int64_t i = 0; i < cycles[cycle]; i++, n++) {
            ck_assert_int_eq(task_log[n].letter, expected[n]);
            ck_assert_int_eq(task_log[n].time_ns, cycle * MS);
        }
    machine_close(&machine);
}
END_TEST

/* Structs of a program that was compiled with fewer members than the library; what lies behind them is not its own. */
static void count_calls(void *context) { ++*(int *)context; }

START_TEST(test_an_older_program_has_shorter_structs)
{
    enum { OLD_CONFIG = offsetof(cm1e_scheduler_config_t, trace_every),
           OLD_STATISTICS = offsetof(cm1e_scheduler_statistics_t, advice) };
    machine_t machine = {.axis_count = 1};
    cm1e_diag_t diag;
    int calls = 0;
    machine_open(&machine);
    cm1e_scheduler_destroy(machine.scheduler);
    cm1e_scheduler_config_t config;
    memset(&config, 0x5A, sizeof config);
    memset(&config, 0, OLD_CONFIG);
    ck_assert_msg(cm1e_scheduler_create_sized(&machine.scheduler, machine.bus, &config, OLD_CONFIG, &diag) == CM1E_OK,
                  "%s", diag.text);
    const struct { cm1e_task_config_t task; int more; } newer = {{.program = count_calls, .context = &calls}, 0x5A5A};
    ck_assert_int_eq(cm1e_scheduler_add_task_sized(machine.scheduler, &newer.task, sizeof newer, &diag), CM1E_OK);
    ck_assert_int_eq(cm1e_scheduler_run(machine.scheduler, 9 * MS, &diag), CM1E_OK);
    cm1e_scheduler_statistics_t statistics;
    memset(&statistics, 0x5A, sizeof statistics);
    cm1e_scheduler_statistics_sized(machine.scheduler, &statistics, OLD_STATISTICS);
    ck_assert_int_eq(calls, 9);
    ck_assert_uint_ge(statistics.cycles, 9);
    ck_assert_int_eq(statistics.advice[0], 0x5A);
    machine_close(&machine);
}
END_TEST

/* What timers in a task see: the planned time of its cycle, the same for all of them. */
static struct {
    TON_t ton;
    int64_t calls, times_ns[64], on_at_ns;
} timed[2];

static void timer_program(void *context)
{
    const int task = *(const int *)context;
    timed[task].ton.IN = TRUE;
    timed[task].ton.PT = 5 * MS / 2;
    for (int i = 0; i < 3; i++) { /* time does not pass within a scan */
        TON(&timed[task].ton);
        usleep(task ? 10 : 0);
    }
    timed[task].times_ns[timed[task].calls++] = cm1e_scan_time();
    if (timed[task].ton.Q && timed[task].on_at_ns == 0)
        timed[task].on_at_ns = cm1e_scan_time();
}

START_TEST(test_timers_see_the_planned_time_of_their_task_s_cycle)
{
    static int tasks[] = {0, 1};
    machine_t machine = {.axis_count = 1};
    memset(timed, 0, sizeof timed);
    machine_open(&machine);
    machine_add(&machine, "fast", 0, 1, timer_program, &tasks[0]);
    machine_add(&machine, "slow", 2 * MS, 2, timer_program, &tasks[1]);
    machine_run(&machine, 20 * MS);
    const int64_t begin_ns = timed[0].times_ns[0];
    ck_assert_int_eq(timed[0].calls, 20);
    ck_assert_int_eq(timed[1].calls, 10);
    for (int i = 0; i < 20; i++)
        ck_assert_int_eq(timed[0].times_ns[i], begin_ns + i * MS);
    for (int i = 0; i < 10; i++)
        ck_assert_int_eq(timed[1].times_ns[i], begin_ns + 2 * i * MS);
    /* 2.5 ms after the first scan: in the first scan of each task that comes then or later */
    ck_assert_int_eq(timed[0].on_at_ns - begin_ns, 3 * MS);
    ck_assert_int_eq(timed[1].on_at_ns - begin_ns, 4 * MS);
    machine_close(&machine);
}
END_TEST

START_TEST(test_interval_that_is_no_multiple_of_the_cycle_names_both)
{
    static const int64_t wrong[] = {1, 999999, 1000001, 1500000, 10 * MS + 1, -MS, INT64_MAX, INT64_MIN};
    machine_t machine = {.axis_count = 1};
    machine_open(&machine);
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        cm1e_diag_t diag = {0};
        char number[32];
        const cm1e_task_config_t task = {.name = "odd one", .interval_ns = wrong[i], .program = log_program};
        ck_assert_int_eq(cm1e_scheduler_add_task(machine.scheduler, &task, &diag), CM1E_ERROR_CONFIG);
        ck_assert_int_eq(diag.error, CM1E_ERROR_CONFIG);
        snprintf(number, sizeof number, "%lld ns", (long long)wrong[i]);
        ck_assert_msg(strstr(diag.text, number) && strstr(diag.text, "1000000 ns") && strstr(diag.text, "odd one"),
                      "%s", diag.text);
    }
    machine_close(&machine);
}
END_TEST

START_TEST(test_wrong_tasks_and_times_of_adding_are_refused)
{
    machine_t machine = {.axis_count = 1};
    cm1e_diag_t diag = {0};
    logger_t a = {'a', NULL};
    machine_open(&machine);
    a.scheduler = machine.scheduler;
    const cm1e_task_config_t nothing = {.name = "empty"}, good = {.program = log_program, .context = &a};
    ck_assert_int_eq(cm1e_scheduler_add_task(machine.scheduler, &nothing, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    for (int i = 0; i < CM1E_MAX_TASKS; i++)
        ck_assert_int_eq(cm1e_scheduler_add_task(machine.scheduler, &good, NULL), CM1E_OK);
    ck_assert_int_eq(cm1e_scheduler_add_task(machine.scheduler, &good, &diag), CM1E_ERROR_FULL);
    logged = 0;
    ck_assert_int_eq(cm1e_scheduler_run(machine.scheduler, -1, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    machine_run(&machine, 3 * MS);
    ck_assert_uint_eq(logged, 3 * CM1E_MAX_TASKS);
    ck_assert_int_eq(cm1e_scheduler_add_task(machine.scheduler, &good, &diag), CM1E_ERROR_STATE);
    ck_assert_int_eq(cm1e_scheduler_run(machine.scheduler, MS, &diag), CM1E_ERROR_STATE);
    ck_assert_uint_eq(logged, 3 * CM1E_MAX_TASKS);
    machine_close(&machine);
}
END_TEST

START_TEST(test_wrong_configurations_are_refused)
{
    static const cm1e_scheduler_config_t wrong[] = {
        {.realtime_priority = 99}, {.realtime_priority = -2}, {.cpu = -1}, {.stop_timeout_ns = -1}};
    machine_t machine = {.axis_count = 1};
    machine_open(&machine);
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        cm1e_scheduler_t *none = machine.scheduler;
        cm1e_diag_t diag = {0};
        ck_assert_int_eq(cm1e_scheduler_create(&none, machine.bus, &wrong[i], &diag), CM1E_ERROR_INVALID_ARGUMENT);
        ck_assert_ptr_null(none);
        ck_assert_uint_gt(strlen(diag.text), 20);
    }
    cm1e_scheduler_t *none = machine.scheduler;
    ck_assert_int_eq(cm1e_scheduler_create(&none, NULL, NULL, NULL), CM1E_ERROR_INVALID_ARGUMENT);
    cm1e_scheduler_destroy(NULL);
    machine_close(&machine);
}
END_TEST

START_TEST(test_axes_are_found_by_index_and_name)
{
    machine_t machine = {.axis_count = 3};
    machine_open(&machine);
    for (uint32_t i = 0; i < 3; i++) {
        const char *name = cm1e_axis_name(machine.axis[i]);
        ck_assert_uint_eq(cm1e_scheduler_axis_by_name(machine.scheduler, name).Handle, machine.axis[i].Handle);
        for (uint32_t other = 0; other < i; other++)
            ck_assert_uint_ne(machine.axis[i].Handle, machine.axis[other].Handle);
    }
    ck_assert_uint_eq(cm1e_scheduler_axis(machine.scheduler, 3).Handle, 0);
    ck_assert_uint_eq(cm1e_scheduler_axis_by_name(machine.scheduler, "nobody").Handle, 0);
    machine_close(&machine);
}
END_TEST

/* ---- overruns -------------------------------------------------------------------------------------------------- */

typedef struct glutton {
    machine_t *machine;
    int64_t at_ns, takes_ns;
} glutton_t;

/** Needs far too long in one cycle. */
static void gluttonous_program(void *context)
{
    const glutton_t *glutton = context;
    cm1e_clock_t *clock = cm1e_bus_clock(glutton->machine->bus);
    if (cm1e_scheduler_time_ns(glutton->machine->scheduler) == glutton->at_ns)
        cm1e_clock_sleep_until(clock, cm1e_clock_now(clock) + glutton->takes_ns);
}

START_TEST(test_overrun_leaves_cycles_out_keeps_the_phase_and_is_counted)
{
    machine_t machine = {.axis_count = 1};
    machine_open(&machine);
    glutton_t glutton = {&machine, 5 * MS, 3 * MS + MS / 2};
    logger_t fast = {'f', machine.scheduler}, slow = {'s', machine.scheduler};
    logged = 0;
    machine_add(&machine, "glutton", 0, 9, gluttonous_program, &glutton);
    machine_add(&machine, "fast", 0, 0, log_program, &fast);
    machine_add(&machine, "slow", 4 * MS, 1, log_program, &slow);
    machine_run(&machine, 16 * MS);
    /* Cycle 5 ends at 8.5 ms: cycles 6, 7, 8 are left out; the slow task, due in 8, runs once, in 9. */
    static const struct {
        char letter;
        int64_t ms;
    } expected[] = {{'f', 0}, {'s', 0}, {'f', 1}, {'f', 2}, {'f', 3}, {'f', 4}, {'s', 4}, {'f', 5}, {'f', 9}, {'s', 9},
                    {'f', 10}, {'f', 11}, {'f', 12}, {'s', 12}, {'f', 13}, {'f', 14}, {'f', 15}};
    ck_assert_uint_eq(logged, sizeof expected / sizeof expected[0]);
    for (unsigned i = 0; i < logged; i++) {
        ck_assert_int_eq(task_log[i].letter, expected[i].letter);
        ck_assert_int_eq(task_log[i].time_ns, expected[i].ms * MS);
    }
    cm1e_scheduler_statistics_t statistics;
    cm1e_scheduler_statistics(machine.scheduler, &statistics);
    ck_assert_uint_eq(statistics.overruns, 1);
    ck_assert_int_eq(statistics.cycle_time.maximum_ns, 4 * MS);
    ck_assert_int_eq(statistics.cycle_time.minimum_ns, 1 * MS);
    ck_assert_int_eq(statistics.execution_time.maximum_ns, glutton.takes_ns);
    machine_close(&machine);
}
END_TEST

START_TEST(test_work_that_just_fits_is_no_overrun)
{
    for (int late = 0; late <= 1; late++) {
        machine_t machine = {.axis_count = 1};
        machine_open(&machine);
        glutton_t glutton = {&machine, 5 * MS, MS + late};
        machine_add(&machine, "glutton", 0, 0, gluttonous_program, &glutton);
        machine_run(&machine, 10 * MS);
        cm1e_scheduler_statistics_t statistics;
        cm1e_scheduler_statistics(machine.scheduler, &statistics);
        ck_assert_uint_eq(statistics.overruns, late);
        ck_assert_int_eq(statistics.cycle_time.maximum_ns, (1 + late) * MS);
        machine_close(&machine);
    }
}
END_TEST

/* ---- statistics ------------------------------------------------------------------------------------------------ */

static void check_distribution(const cm1e_distribution_t *d, uint64_t count)
{
    uint64_t sum = 0;
    ck_assert_uint_eq(d->count, count);
    for (int i = 0; i < CM1E_HISTOGRAM_BUCKETS; i++)
        sum += d->histogram[i];
    ck_assert_uint_eq(sum, count);
    ck_assert_int_le(d->minimum_ns, d->maximum_ns);
    ck_assert_int_ge(d->sum_ns, d->minimum_ns * (int64_t)count);
    ck_assert_int_le(d->sum_ns, d->maximum_ns * (int64_t)count);
}

START_TEST(test_statistics_count_every_cycle_once_in_the_right_bucket)
{
    machine_t machine = {.axis_count = 2};
    cm1e_scheduler_statistics_t s;
    machine_open(&machine);
    cm1e_scheduler_statistics(machine.scheduler, &s);
    ck_assert(s.cycles == 0 && s.cycle_time.count == 0 && s.advice[0] == '\0' && !s.realtime);
    machine_run(&machine, 100 * MS);
    cm1e_scheduler_statistics(machine.scheduler, &s);
    ck_assert_uint_ge(s.cycles, 101); /* and those of the shut-down */
    ck_assert_uint_le(s.cycles, 110);
    check_distribution(&s.cycle_time, s.cycles - 1);
    check_distribution(&s.wake_up_latency, s.cycles);
    check_distribution(&s.execution_time, s.cycles);
    ck_assert_uint_eq(s.cycle_time.histogram[10], s.cycles - 1); /* 1 ms: from 512 us to below 1024 us */
    ck_assert_uint_eq(s.wake_up_latency.histogram[0], s.cycles);
    ck_assert_uint_eq(s.overruns, 0);
    ck_assert_uint_eq(s.bus.lost_frames + s.bus.working_counter_errors, 0);
    ck_assert_uint_ge(s.bus.cycles, 100);
    ck_assert(!s.realtime && s.advice[0] == '\0'); /* virtual time asks for no privilege */
    machine_close(&machine);
}
END_TEST

/* ---- ends of a run --------------------------------------------------------------------------------------------- */

typedef struct mover {
    machine_t *machine;
    MC_Power_t power;
    MC_MoveVelocity_t turn;
    int64_t stop_at_ns;
    cm1e_axis_info_t info;
    unsigned calls;
    const char *console; /* line for the segment at `stop_at_ns`, before the stop */
} mover_t;

static void moving_program(void *context)
{
    mover_t *mover = context;
    char answer[128];
    mover->calls++;
    mover->power.Enable = TRUE;
    MC_Power(&mover->power);
    mover->turn.Execute = mover->power.Status;
    MC_MoveVelocity(&mover->turn);
    cm1e_axis_read(mover->machine->axis[0], &mover->info);
    if (mover->stop_at_ns && cm1e_scheduler_time_ns(mover->machine->scheduler) == mover->stop_at_ns) {
        if (mover->console)
            ck_assert_int_eq(cm1e_bus_simulate(mover->machine->bus, mover->console, answer, sizeof answer), CM1E_OK);
        cm1e_scheduler_stop(mover->machine->scheduler);
    }
}

static mover_t make_mover(machine_t *machine, int64_t stop_at_ns)
{
    AXIS_REF_t *axis = &machine->axis[0];
    return (mover_t){
        .machine = machine,
        .power = {.Axis = axis, .EnablePositive = TRUE, .EnableNegative = TRUE},
        .turn = {.Axis = axis, .Velocity = 20, .Acceleration = 1000, .Deceleration = 200},
        .stop_at_ns = stop_at_ns,
    };
}

static void expect_all_at_rest(const machine_t *machine)
{
    cm1e_axis_info_t info;
    ck_assert_int_eq(cm1e_axis_read(machine->axis[0], &info), CM1E_OK);
    ck_assert_int_eq(info.state, CM1E_AXIS_DISABLED);
    ck_assert(!info.powered);
    const cm1e_slave_watch_t watch = cm1e_bus_slave_watch(machine->bus, 1);
    ck_assert_int_eq(watch.al_state, CM1E_AL_INIT);
}

START_TEST(test_stop_in_a_move_ramps_down_disables_and_leaves_the_bus_in_init)
{
    machine_t machine = {.axis_count = 1, .config = {.trace_capacity = 10000}};
    machine_open(&machine);
    mover_t mover = make_mover(&machine, 300 * MS);
    machine_add(&machine, "", 0, 0, moving_program, &mover);
    machine_run(&machine, 0);
    ck_assert_double_eq_tol(mover.info.actual_velocity, 20, 0.5);
    ck_assert_uint_eq(mover.calls, 301); /* not once more in the shut-down */
    expect_all_at_rest(&machine);
    cm1e_axis_info_t end;
    cm1e_axis_read(machine.axis[0], &end);
    ck_assert_double_eq_tol(end.actual_velocity, 0, 0.5);
    machine_close(&machine);
}
END_TEST

START_TEST(test_duration_ends_the_run_in_the_same_order)
{
    machine_t machine = {.axis_count = 1};
    machine_open(&machine);
    mover_t mover = make_mover(&machine, 0);
    machine_add(&machine, "", 0, 0, moving_program, &mover);
    machine_run(&machine, 250 * MS + 1);
    ck_assert_uint_eq(mover.calls, 251);
    expect_all_at_rest(&machine);
    machine_close(&machine);
}
END_TEST

START_TEST(test_stop_before_the_run_calls_no_program)
{
    machine_t machine = {.axis_count = 1};
    machine_open(&machine);
    mover_t mover = make_mover(&machine, 0);
    machine_add(&machine, "", 0, 0, moving_program, &mover);
    cm1e_scheduler_stop(machine.scheduler);
    machine_run(&machine, 0);
    ck_assert_uint_eq(mover.calls, 0);
    expect_all_at_rest(&machine);
    machine_close(&machine);
}
END_TEST

/** Whatever has happened to the segment, a stop ends the run in bounded time. */
START_TEST(test_stop_with_a_broken_segment_ends)
{
    static const char *const consoles[] = {"unplug 1", "lose 1000000", "corrupt 1000000", "power 1 off",
                                           "power-cycle 1 50", "over-torque 1", "delay 1000000 900"};
    machine_t machine = {.axis_count = 2, .config = {.stop_timeout_ns = 3000 * MS}};
    machine_open(&machine);
    mover_t mover = make_mover(&machine, 300 * MS);
    mover.console = consoles[_i];
    machine_add(&machine, "", 0, 0, moving_program, &mover);
    cm1e_diag_t diag = {0};
    const cm1e_error_t error = cm1e_scheduler_run(machine.scheduler, 0, &diag);
    ck_assert_msg(error == CM1E_OK || error == CM1E_ERROR_TIMEOUT, "%s: %s", consoles[_i], diag.text);
    ck_assert_int_lt(cm1e_scheduler_time_ns(machine.scheduler), 300 * MS + 3000 * MS + 20 * MS);
    machine_close(&machine);
}
END_TEST

/** A lost bus does not end the run: the axis is in ErrorStop, programs go on and see it, a duration ends it. */
START_TEST(test_lost_bus_keeps_the_programs_running)
{
    machine_t machine = {.axis_count = 1};
    machine_open(&machine);
    mover_t mover = make_mover(&machine, 0);
    machine_add(&machine, "", 0, 0, moving_program, &mover);
    char answer[128];
    ck_assert_int_eq(cm1e_bus_simulate(machine.bus, "lose 1000000", answer, sizeof answer), CM1E_OK);
    cm1e_scheduler_run(machine.scheduler, 5000 * MS, NULL);
    ck_assert_uint_eq(mover.calls, 5000);
    cm1e_scheduler_statistics_t statistics;
    cm1e_scheduler_statistics(machine.scheduler, &statistics);
    ck_assert_uint_ge(statistics.bus.lost_frames, 4990);
    machine_close(&machine);
}
END_TEST

/** Its cycles would pass without a frame and without an error. */
START_TEST(test_scheduler_of_a_bus_that_does_not_operate_is_refused)
{
    machine_t machine = {.axis_count = (uint32_t)_i};
    machine_open(&machine);
    cm1e_diag_t diag = {0};
    cm1e_scheduler_t *second = NULL;
    cm1e_bus_stop(machine.bus);
    ck_assert_int_eq(cm1e_scheduler_run(machine.scheduler, 10 * MS, &diag), CM1E_ERROR_STATE);
    ck_assert_ptr_nonnull(strstr(diag.text, "cm1e_bus_start"));
    ck_assert_int_eq(cm1e_scheduler_create(&second, machine.bus, NULL, &diag), CM1E_ERROR_STATE);
    ck_assert_ptr_null(second);
    ck_assert_int_eq(cm1e_bus_scan(machine.bus, &diag), CM1E_OK);
    ck_assert_int_eq(cm1e_bus_identify(machine.bus, &diag), CM1E_OK);
    ck_assert_int_eq(cm1e_bus_configure(machine.bus, &diag), CM1E_OK);
    ck_assert_int_eq(cm1e_scheduler_create(&second, machine.bus, NULL, &diag), CM1E_ERROR_STATE);
    machine_close(&machine);
}
END_TEST

/** The slaves may stand elsewhere since, and with them the process data of the axes. */
START_TEST(test_scheduler_of_an_earlier_operation_is_refused)
{
    machine_t machine = {.axis_count = 1};
    machine_open(&machine);
    cm1e_diag_t diag = {0};
    cm1e_bus_stop(machine.bus);
    ck_assert_int_eq(cm1e_bus_start(machine.bus, &diag), CM1E_OK);
    ck_assert_int_eq(cm1e_scheduler_run(machine.scheduler, 10 * MS, &diag), CM1E_ERROR_STATE);
    ck_assert_ptr_nonnull(strstr(diag.text, "new"));
    cm1e_scheduler_destroy(machine.scheduler);
    ck_assert_int_eq(cm1e_scheduler_create(&machine.scheduler, machine.bus, NULL, &diag), CM1E_OK);
    machine_run(&machine, 10 * MS);
    machine_close(&machine);
}
END_TEST

/** A busy machine let the program wait between the start of the bus and the first cycle: the watchdogs of the slaves ended
 *  Operational. That is mended, because no motor has torque yet. */
START_TEST(test_a_late_first_cycle_finds_the_slaves_in_operational)
{
    static const int64_t waits_ms[] = {10, 50, 99, 101, 150, 5000};
    machine_t machine = {.axis_count = 3, .bridged = _i % 2};
    machine_open(&machine);
    mover_t mover = make_mover(&machine, 0);
    machine_add(&machine, "", 0, 0, moving_program, &mover);
    cm1e_clock_t *clock = cm1e_bus_clock(machine.bus);
    cm1e_clock_sleep_until(clock, cm1e_clock_now(clock) + waits_ms[_i / 2] * MS);
    machine_run(&machine, 400 * MS);
    ck_assert_msg(mover.power.Status, "after %d ms the axis gets no power: %s", (int)waits_ms[_i / 2],
                  cm1e_strerror(mover.info.error));
    machine_close(&machine);
}
END_TEST

START_TEST(test_a_late_first_cycle_without_a_slave_is_an_error_in_words)
{
    machine_t machine = {.axis_count = 2};
    machine_open(&machine);
    mover_t mover = make_mover(&machine, 0);
    machine_add(&machine, "", 0, 0, moving_program, &mover);
    cm1e_clock_t *clock = cm1e_bus_clock(machine.bus);
    char answer[128];
    cm1e_diag_t diag = {0};
    ck_assert_int_eq(cm1e_bus_simulate(machine.bus, "unplug 2", answer, sizeof answer), CM1E_OK);
    cm1e_clock_sleep_until(clock, cm1e_clock_now(clock) + 150 * MS);
    ck_assert_int_ne(cm1e_scheduler_run(machine.scheduler, 400 * MS, &diag), CM1E_OK);
    ck_assert_msg(strstr(diag.text, "Slave 2"), "%s", diag.text);
    ck_assert_uint_eq(mover.calls, 0);
    machine_close(&machine);
}
END_TEST

/** Too short for the ramp, or for the drive to be disabled: the bus is stopped, and the run says so. */
START_TEST(test_stop_timeout_that_is_too_short_is_told)
{
    unsigned late = 0, in_time = 0;
    for (int64_t timeout_ns = MS; in_time < 3; timeout_ns += 2 * MS) {
        machine_t machine = {.axis_count = 1, .config = {.stop_timeout_ns = timeout_ns}};
        machine_open(&machine);
        mover_t mover = make_mover(&machine, 300 * MS);
        machine_add(&machine, "", 0, 0, moving_program, &mover);
        cm1e_diag_t diag = {0};
        const cm1e_error_t error = cm1e_scheduler_run(machine.scheduler, 0, &diag);
        ck_assert_int_eq(error, in_time > 0 || error == CM1E_OK ? CM1E_OK : CM1E_ERROR_TIMEOUT);
        ck_assert_msg(error == CM1E_OK || strstr(diag.text, "were not at rest and disabled within"), "%s", diag.text);
        ck_assert_int_le(cm1e_scheduler_time_ns(machine.scheduler), 300 * MS + timeout_ns + 5 * MS);
        ck_assert_int_eq(cm1e_bus_slave_watch(machine.bus, 1).al_state, CM1E_AL_INIT);
        late += error != CM1E_OK;
        in_time += error == CM1E_OK;
        machine_close(&machine);
    }
    ck_assert_uint_gt(late, 8); /* the ramp takes 20 ms */
}
END_TEST

/** A heavy load swings behind the end of the ramp, longer than the timeout: the torque stays until it rests, and the run has
 *  no error. */
START_TEST(test_stop_timeout_ends_no_torque_that_a_load_needs)
{
    for (int64_t timeout_ns = 40 * MS; timeout_ns <= 220 * MS; timeout_ns += 20 * MS) {
        machine_t machine = {.axis_count = 1, .load_inertia = 0.01, .config = {.stop_timeout_ns = timeout_ns}};
        machine_open(&machine);
        mover_t mover = make_mover(&machine, 300 * MS);
        mover.turn.Acceleration = 0; /* the most that there is: the load swings */
        machine_add(&machine, "", 0, 0, moving_program, &mover);
        cm1e_diag_t diag = {0};
        ck_assert_msg(cm1e_scheduler_run(machine.scheduler, 0, &diag) == CM1E_OK, "%s", diag.text);
        ck_assert_int_gt(cm1e_scheduler_time_ns(machine.scheduler), 300 * MS + 200 * MS);
        expect_all_at_rest(&machine);
        machine_close(&machine);
    }
}
END_TEST

START_TEST(test_longest_stop_timeout_is_no_short_one)
{
    machine_t machine = {.axis_count = 1, .config = {.stop_timeout_ns = INT64_MAX}};
    machine_open(&machine);
    mover_t mover = make_mover(&machine, 0);
    machine_add(&machine, "", 0, 0, moving_program, &mover);
    machine_run(&machine, 250 * MS);
    expect_all_at_rest(&machine);
    machine_close(&machine);
}
END_TEST

START_TEST(test_fifty_starts_and_stops)
{
    for (int i = 0; i < 50; i++) {
        machine_t machine = {.axis_count = 1 + (uint32_t)i % 3, .config = {.trace_capacity = 100}};
        machine_open(&machine);
        mover_t mover = make_mover(&machine, (20 + i) * MS);
        machine_add(&machine, "", 0, 0, moving_program, &mover);
        machine_run(&machine, 0);
        expect_all_at_rest(&machine);
        machine_close(&machine);
    }
}
END_TEST

/* ---- the same run twice ---------------------------------------------------------------------------------------- */

static void traced_run(const char *path)
{
    machine_t machine = {.axis_count = 2, .config = {.trace_capacity = 5000}};
    machine_open(&machine);
    mover_t mover = make_mover(&machine, 900 * MS);
    machine_add(&machine, "", 0, 0, moving_program, &mover);
    machine_run(&machine, 0);
    cm1e_diag_t diag = {0};
    ck_assert_msg(cm1e_scheduler_write_csv(machine.scheduler, path, &diag) == CM1E_OK, "%s", diag.text);
    machine_close(&machine);
}

START_TEST(test_two_runs_on_virtual_time_leave_the_same_trace)
{
    static const char *const paths[] = {CM1E_TEST_OUTPUT "/repeat-1.csv", CM1E_TEST_OUTPUT "/repeat-2.csv"};
    FILE *files[2];
    for (int i = 0; i < 2; i++) {
        traced_run(paths[i]);
        files[i] = fopen(paths[i], "r");
        ck_assert_ptr_nonnull(files[i]);
    }
    long length = 0;
    for (int a, b; (a = fgetc(files[0])) != EOF; length++) {
        b = fgetc(files[1]);
        ck_assert_msg(a == b, "the traces differ at byte %ld", length);
    }
    ck_assert_int_eq(fgetc(files[1]), EOF);
    ck_assert_int_gt(length, 50000);
    fclose(files[0]);
    fclose(files[1]);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("scheduler");
    TCase *all = tcase_create("virtual time");
    const TTest *const tests[] = {
        test_tasks_run_by_priority_and_interval_from_the_first_cycle_on,
        test_timers_see_the_planned_time_of_their_task_s_cycle,
        test_interval_that_is_no_multiple_of_the_cycle_names_both,
        test_wrong_tasks_and_times_of_adding_are_refused,
        test_wrong_configurations_are_refused,
        test_axes_are_found_by_index_and_name,
        test_overrun_leaves_cycles_out_keeps_the_phase_and_is_counted,
        test_work_that_just_fits_is_no_overrun,
        test_statistics_count_every_cycle_once_in_the_right_bucket,
        test_stop_in_a_move_ramps_down_disables_and_leaves_the_bus_in_init,
        test_duration_ends_the_run_in_the_same_order,
        test_stop_before_the_run_calls_no_program,
        test_lost_bus_keeps_the_programs_running,
        test_fifty_starts_and_stops,
        test_two_runs_on_virtual_time_leave_the_same_trace,
    };
    tcase_set_timeout(all, 60);
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tcase_add_test(all, tests[i]);
    tcase_add_loop_test(all, test_stop_with_a_broken_segment_ends, 0, 7);
    tcase_add_loop_test(all, test_scheduler_of_a_bus_that_does_not_operate_is_refused, 0, 2);
    tcase_add_test(all, test_an_older_program_has_shorter_structs);
    tcase_add_test(all, test_scheduler_of_an_earlier_operation_is_refused);
    tcase_add_test(all, test_stop_timeout_that_is_too_short_is_told);
    tcase_add_test(all, test_stop_timeout_ends_no_torque_that_a_load_needs);
    tcase_add_test(all, test_longest_stop_timeout_is_no_short_one);
    tcase_add_loop_test(all, test_a_late_first_cycle_finds_the_slaves_in_operational, 0, 12);
    tcase_add_test(all, test_a_late_first_cycle_without_a_slave_is_an_error_in_words);
    suite_add_tcase(suite, all);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
