/**
 * Every signal that would end or suspend a program, in the middle of a motion: the axis ramps down with its own
 * deceleration, however many signals follow, and the drive is disabled. Signals that the program ignores stay ignored.
 */
#include <errno.h>
#include <math.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "cm1e/plcopen.h"
#include "cm1e/scheduler.h"
#include "quick_check.h"
#include "real_time.h"

#define MS INT64_C(1000000)

static const double velocity = 10, deceleration = 20, cycle_s = 0.001; /* u/s, u/s2: the ramp takes half a second */

static const struct {
    int number;
    bool also_ignored; /* it is a stop even where the program ignored it before */
} signals[] = {{SIGINT, true}, {SIGTERM, true}, {SIGHUP, false}, {SIGQUIT, false}, {SIGPIPE, false}, {SIGTSTP, false},
               {SIGXCPU, false}, {SIGXFSZ, false}};
enum { SIGNALS = sizeof signals / sizeof signals[0], PARTS = 4, ATTEMPTS = 10 };

/* ---- an axis that turns ------------------------------------------------------------------------------------------ */

typedef struct turning {
    cm1e_bus_t *bus;
    cm1e_scheduler_t *scheduler;
    AXIS_REF_t axis;
    MC_Power_t power;
    MC_MoveVelocity_t turn;
    atomic_bool turns;
    atomic_int calls; /**< of the program: none in the stop */
    pthread_t thread;
    cm1e_error_t error;
    cm1e_diag_t diag;
} turning_t;

static void program(void *context)
{
    turning_t *t = context;
    atomic_fetch_add(&t->calls, 1);
    t->power.Enable = TRUE;
    MC_Power(&t->power);
    t->turn.Execute = t->power.Status;
    MC_MoveVelocity(&t->turn);
    atomic_store(&t->turns, t->turn.InVelocity);
}

static void *run_thread(void *context)
{
    turning_t *t = context;
    t->error = cm1e_scheduler_run(t->scheduler, 0, &t->diag);
    return NULL;
}

static void sleep_ms(int64_t ms)
{
    const struct timespec time = {.tv_sec = ms / 1000, .tv_nsec = ms % 1000 * MS};
    nanosleep(&time, NULL);
}

static void check_done(const turning_t *t, cm1e_error_t error) { ck_assert_msg(error == CM1E_OK, "%s", t->diag.text); }

/** Returns while the axis turns with its velocity. */
static void start(turning_t *t)
{
    static cm1e_bus_config_t config;
    const cm1e_scheduler_config_t settings = {.trace_capacity = 20000};
    const cm1e_task_config_t task = {.program = program, .context = t};
    cm1e_bus_config_free(&config);
    cm1e_bus_config_init(&config, "sim", 1);
    config.axes[0].max_deceleration = deceleration;
    config.axes[0].sim.no_stops = true;
    check_done(t, cm1e_bus_open(&t->bus, &config, &t->diag));
    check_done(t, cm1e_bus_start(t->bus, &t->diag));
    check_done(t, cm1e_scheduler_create(&t->scheduler, t->bus, &settings, &t->diag));
    check_done(t, cm1e_scheduler_add_task(t->scheduler, &task, &t->diag));
    t->axis = cm1e_scheduler_axis(t->scheduler, 0);
    t->power = (MC_Power_t){.Axis = &t->axis, .EnablePositive = TRUE, .EnableNegative = TRUE};
    t->turn = (MC_MoveVelocity_t){.Axis = &t->axis, .Velocity = velocity};
    cm1e_scheduler_stop_on_signals(t->scheduler);
    ck_assert_int_eq(pthread_create(&t->thread, NULL, run_thread, t), 0);
    for (int i = 0; i < 5000 && !atomic_load(&t->turns); i++)
        sleep_ms(1);
    ck_assert(atomic_load(&t->turns));
}

static void end(turning_t *t)
{
    cm1e_scheduler_destroy(t->scheduler);
    cm1e_bus_close(t->bus);
}

/* ---- the ramp ---------------------------------------------------------------------------------------------------- */

/** No step on the way is beyond the deceleration, and the motor is at rest when its torque goes. False: the machine
 *  paused, after which a motion begins anew (docs/SAFETY.md), so nothing can be said of the ramp. */
static bool check_ramp(const turning_t *t, int number)
{
    char path[256], state[32];
    snprintf(path, sizeof path, "%s/signal_%d.csv", CM1E_TEST_OUTPUT, number);
    ck_assert_int_eq(cm1e_scheduler_write_csv(t->scheduler, path, NULL), CM1E_OK);
    FILE *file = fopen(path, "r");
    ck_assert_ptr_nonnull(file);
    ck_assert_int_ge(fscanf(file, "%*[^\n]\n"), 0);
    double time_s, set, actual, before = 0, before_s = 0, longest_s = 0, steepest = 0, began_s = 0, ended_s = 0;
    while (fscanf(file, "%lf,%31[^,],%*f,%*f,%lf,%lf,%*[^\n]\n", &time_s, state, &set, &actual) == 4) {
        ck_assert_str_ne(state, "ErrorStop");
        steepest = fmax(steepest, before - set);
        longest_s = fmax(longest_s, time_s - before_s);
        before_s = time_s;
        began_s = set > 0.999 * velocity ? time_s : began_s;
        ended_s = set > 0 ? time_s : ended_s;
        before = set;
    }
    fclose(file);
    ck_assert_msg(set == 0 && fabs(actual) < 0.01, "signal %d: the torque goes at %g u/s", number, actual);
    if (longest_s > 1.5 * cycle_s)
        return false;
    ck_assert_msg(steepest <= deceleration * cycle_s * (1 + 1e-9), "signal %d: braked with %g u/s2", number,
                  steepest / cycle_s);
    ck_assert_msg(ended_s - began_s > 0.9 * velocity / deceleration, "signal %d: at rest after %g s", number,
                  ended_s - began_s);
    return true;
}

static void check_end(const turning_t *t)
{
    cm1e_axis_info_t info;
    check_done(t, t->error);
    cm1e_axis_read(t->axis, &info);
    ck_assert_int_eq(info.state, CM1E_AXIS_DISABLED);
    ck_assert_int_eq(cm1e_bus_slave(t->bus, 1)->al_state, CM1E_AL_INIT);
}

/** True: the ramp was judged. */
static bool stop_by(int number)
{
    static turning_t t;
    t = (turning_t){0};
    start(&t);
    kill(getpid(), number);
    for (int i = 0; i < 20; i++) { /* the same again, and all the others, while the ramp lasts */
        sleep_ms(20);
        kill(getpid(), i % 3 == 0 ? number : signals[i % SIGNALS].number);
    }
    pthread_join(t.thread, NULL);
    check_end(&t);
    const bool judged = check_ramp(&t, number);
    end(&t);
    return judged;
}

START_TEST(test_every_signal_ramps_down_and_more_of_them_change_nothing)
{
    for (int i = 0; i < ATTEMPTS; i++)
        if (stop_by(signals[_i].number))
            return;
    ck_abort_msg("the machine paused in every one of %d ramps", ATTEMPTS);
}
END_TEST

/* ---- what the program wants of a signal by itself ---------------------------------------------------------------- */

START_TEST(test_an_ignored_signal_stays_ignored_but_for_those_that_ask_for_an_end)
{
    static turning_t t;
    const int number = signals[_i].number;
    signal(number, SIG_IGN); /* as nohup does with SIGHUP */
    start(&t);
    kill(getpid(), number);
    sleep_ms(200);
    const int calls = atomic_load(&t.calls);
    sleep_ms(50);
    const bool stops = atomic_load(&t.calls) == calls;
    ck_assert_msg(stops == signals[_i].also_ignored, "signal %d: the program is %s", number,
                  stops ? "no longer called" : "still called");
    cm1e_scheduler_stop(t.scheduler);
    pthread_join(t.thread, NULL);
    check_end(&t);
    end(&t);
    struct sigaction after;
    sigaction(number, NULL, &after);
    ck_assert(after.sa_handler == SIG_IGN);
}
END_TEST

START_TEST(test_a_pipe_that_breaks_in_the_cycle_stops_in_order)
{
    static turning_t t;
    int ends[2];
    ck_assert_int_eq(pipe(ends), 0);
    start(&t);
    close(ends[0]);
    ck_assert_int_eq(write(ends[1], "x", 1), -1); /* SIGPIPE: whoever reads our output is gone */
    ck_assert_int_eq(errno, EPIPE);
    pthread_join(t.thread, NULL);
    check_end(&t);
    check_ramp(&t, 0);
    close(ends[1]);
    end(&t);
}
END_TEST

/* ---- a handler that is late --------------------------------------------------------------------------------------- */

static atomic_bool is_slow, has_begun, has_ended;

void __real_cm1e_scheduler_stop(cm1e_scheduler_t *scheduler);
void __wrap_cm1e_scheduler_stop(cm1e_scheduler_t *scheduler);

void __wrap_cm1e_scheduler_stop(cm1e_scheduler_t *scheduler)
{
    if (atomic_load(&is_slow)) {
        atomic_store(&has_begun, true);
        sleep_ms(100); /* its thread does not get a processor */
    }
    __real_cm1e_scheduler_stop(scheduler);
    atomic_store(&has_ended, true);
}

static void *be_signalled(void *context)
{
    (void)context;
    pthread_kill(pthread_self(), SIGTERM);
    return NULL;
}

/** _i == 1: another scheduler has replaced it meanwhile. */
START_TEST(test_a_scheduler_lives_until_the_handler_of_another_thread_has_ended)
{
    cm1e_bus_config_t config;
    cm1e_bus_t *buses[2];
    cm1e_scheduler_t *schedulers[2];
    pthread_t thread;
    cm1e_bus_config_init(&config, "sim", 1);
    for (int i = 0; i < 2; i++) {
        ck_assert_int_eq(cm1e_bus_open(&buses[i], &config, NULL), CM1E_OK);
        ck_assert_int_eq(cm1e_bus_start(buses[i], NULL), CM1E_OK);
        ck_assert_int_eq(cm1e_scheduler_create(&schedulers[i], buses[i], NULL, NULL), CM1E_OK);
    }
    cm1e_scheduler_stop_on_signals(schedulers[0]);
    atomic_store(&is_slow, true);
    ck_assert_int_eq(pthread_create(&thread, NULL, be_signalled, NULL), 0);
    while (!atomic_load(&has_begun))
        sleep_ms(1);
    if (_i == 1)
        cm1e_scheduler_stop_on_signals(schedulers[1]);
    cm1e_scheduler_destroy(schedulers[0]);
    ck_assert(atomic_load(&has_ended));
    pthread_join(thread, NULL);
    cm1e_scheduler_destroy(schedulers[1]);
    for (int i = 0; i < 2; i++)
        cm1e_bus_close(buses[i]);
    cm1e_bus_config_free(&config);
}
END_TEST

/** The signals in PARTS parts. */
static Suite *make_suite(int part)
{
    const int first = part * SIGNALS / PARTS, end = (part + 1) * SIGNALS / PARTS;
    Suite *suite = suite_create("signals");
    TCase *all = tcase_create("all");
    tcase_set_timeout(all, 60);
    tcase_add_loop_test(all, test_every_signal_ramps_down_and_more_of_them_change_nothing, first, end);
    tcase_add_loop_test(all, test_an_ignored_signal_stays_ignored_but_for_those_that_ask_for_an_end, first, end);
    if (part == 0) {
        tcase_add_test(all, test_a_pipe_that_breaks_in_the_cycle_stops_in_order);
        tcase_add_loop_test(all, test_a_scheduler_lives_until_the_handler_of_another_thread_has_ended, 0, 2);
    }
    suite_add_tcase(suite, all);
    return suite;
}

int main(void)
{
    need_real_time();
    return run_parts(make_suite, PARTS);
}
