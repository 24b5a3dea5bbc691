/**
 * A task that does not return: the cycle goes on without it, all axes stop in a defined way, and texts name the task. In
 * real time, because on virtual time nothing shows how long a task takes.
 */
#include <dirent.h>
#include <fcntl.h>
#include <math.h>
#include <pthread.h>
#include <signal.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "cm1e/log.h"
#include "cm1e/sim.h"
#include "machine.h"
#include "real_time.h"

#define MS INT64_C(1000000)
#define COUNTS 1000.0 /* per u */

static const double velocity = 10, acceleration = 200; /* u/s, u/s2: the ramp takes 50 ms */

/** What the task does instead of returning. */
typedef enum hang {
    NO_HANG = 0,
    COMPUTES,       /**< an endless loop that calls nothing */
    CALLS_BLOCK,    /**< it calls a block until that is Done, as beginners do */
    CALLS_POWER,    /**< it calls MC_Power for ever, with inputs that change */
    SLEEPS,
    LOCKS,          /**< a mutex that is held already */
    RETURNS_LATE,   /**< it computes for 120 ms */
    LATE_ONCE,      /**< once it computes for 60 ms */
    IN_TIME,        /**< it computes for 5 ms */
    HANGS,
} hang_t;

static const char *const names[HANGS] = {"none", "computes", "calls a block", "calls MC_Power", "sleeps", "locks",
                                         "returns late", "late once", "in time"};

/** What the task that lives has seen of the axis. */
typedef struct seen {
    unsigned calls, calls_after;  /**< of it; since ErrorStop */
    double speed_before;          /**< u/s, of the shaft before ErrorStop */
    double position, last;        /**< u, of the shaft at ErrorStop and at the end */
    int64_t moved_ns;             /**< since ErrorStop until the shaft was last seen moving */
    cm1e_error_t error;
    char text[CM1E_AXIS_ERROR_TEXT_BYTES];
} seen_t;

static struct {
    machine_t machine;
    hang_t hang;
    unsigned calls;               /**< of the task that hangs */
    MC_Power_t power;
    MC_MoveVelocity_t turn;
    MC_MoveAbsolute_t move;
    MC_Reset_t reset;
    pthread_mutex_t mutex;
    seen_t seen;
    int64_t error_ns;
    bool late;
    double speed_at_hang;         /**< u/s, of the shaft, at least the commanded one */
    BOOL resets;                  /**< the living task resets the axis afterwards */
    cm1e_error_t result;
    cm1e_diag_t diag;
} t;

static int64_t now_ns(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec * INT64_C(1000000000) + now.tv_nsec;
}

static void compute(int64_t ns)
{
    const int64_t end_ns = now_ns() + ns;
    while (now_ns() < end_ns)
        ;
}

static volatile uint64_t counted; /* so that the loop stays */

static void hang(void)
{
    switch (t.hang) {
    case COMPUTES:
        for (;;)
            counted++;
    case CALLS_BLOCK:
        while (!t.move.Done) {
            t.move.Execute = TRUE;
            MC_MoveAbsolute(&t.move);
        }
        break;
    case CALLS_POWER:
        for (;;) {
            t.power.EnableNegative = !t.power.EnableNegative;
            MC_Power(&t.power);
        }
    case SLEEPS: sleep(100); break;
    case LOCKS: pthread_mutex_lock(&t.mutex); break;
    case RETURNS_LATE: compute(120 * MS); break;
    case LATE_ONCE:
        compute(t.late ? 0 : 60 * MS);
        t.late = true;
        break;
    case IN_TIME: compute(5 * MS); break;
    default: break;
    }
}

static cm1e_sim_probe_t shaft(void)
{
    cm1e_sim_probe_t probe;
    cm1e_sim_probe(cm1e_bus_segment(t.machine.bus), 1, &probe);
    return probe;
}

/** Turns the motor, and hangs 100 ms after it has reached its velocity. */
static void hanging_program(void *context)
{
    static unsigned in_velocity;
    (void)context;
    t.calls++;
    t.power.Enable = TRUE;
    MC_Power(&t.power);
    t.turn.Execute = t.power.Status;
    MC_MoveVelocity(&t.turn);
    in_velocity = t.turn.InVelocity ? in_velocity + 1 : 0;
    if (in_velocity < 100)
        return;
    if (in_velocity == 100) { /* what a busy machine did to the motor before is not judged */
        cm1e_sim_probe_reset(cm1e_bus_segment(t.machine.bus), 1);
        t.speed_at_hang = fmax(velocity, fabs(shaft().velocity_counts_per_s) / COUNTS);
    }
    hang();
}

static void note_end(const cm1e_axis_info_t *info)
{
    t.seen.position = shaft().position_counts / COUNTS;
    t.seen.error = info->error;
    t.error_ns = now_ns();
    cm1e_axis_error_text(t.machine.axis[0], t.seen.text, sizeof t.seen.text);
}

static void living_program(void *context)
{
    cm1e_axis_info_t info;
    (void)context;
    t.seen.calls++;
    cm1e_axis_read(t.machine.axis[0], &info);
    const double speed = fabs(shaft().velocity_counts_per_s) / COUNTS;
    if (info.state == CM1E_AXIS_ERROR_STOP && t.error_ns == 0)
        note_end(&info);
    if (t.error_ns == 0) {
        t.seen.speed_before = speed;
        return;
    }
    t.seen.calls_after++;
    t.seen.last = shaft().position_counts / COUNTS;
    if (speed > 0.01)
        t.seen.moved_ns = now_ns() - t.error_ns;
    t.reset.Execute = t.resets && t.seen.calls_after > 200;
    MC_Reset(&t.reset);
}

/** `cycles`: watchdog_cycles of the task that hangs. */
static void prepare(hang_t hang, cm1e_mapping_t mapping, int32_t cycles)
{
    cm1e_diag_t diag = {0};
    memset(&t, 0, sizeof t);
    t.hang = hang;
    t.machine = (machine_t){.axis_count = 2, .real_time = true, .mapping = mapping};
    machine_open(&t.machine);
    t.power = (MC_Power_t){.Axis = &t.machine.axis[0], .EnablePositive = TRUE, .EnableNegative = TRUE};
    t.turn = (MC_MoveVelocity_t){.Axis = &t.machine.axis[0], .Velocity = velocity, .Acceleration = acceleration,
                                 .Deceleration = acceleration};
    t.move = (MC_MoveAbsolute_t){.Axis = &t.machine.axis[0], .Position = 1000, .Velocity = velocity};
    t.reset = (MC_Reset_t){.Axis = &t.machine.axis[0]};
    pthread_mutex_init(&t.mutex, NULL);
    pthread_mutex_lock(&t.mutex);
    const cm1e_task_config_t task = {.name = "press", .program = hanging_program, .watchdog_cycles = cycles};
    ck_assert_msg(cm1e_scheduler_add_task(t.machine.scheduler, &task, &diag) == CM1E_OK, "%s", diag.text);
}

static void run(int64_t duration_ns)
{
    t.result = cm1e_scheduler_run(t.machine.scheduler, duration_ns, &t.diag);
}

static bool log_names(const char *words)
{
    static cm1e_log_event_t events[CM1E_LOG_EVENTS];
    const size_t count = cm1e_log_read(t.machine.scheduler, 0, events, CM1E_LOG_EVENTS, NULL);
    char text[512];
    for (size_t i = 0; i < count; i++) {
        cm1e_log_text(t.machine.scheduler, &events[i], text, sizeof text);
        if (strstr(text, words))
            return true;
    }
    return false;
}

static void judge_texts(double limit_ms)
{
    char words[80];
    snprintf(words, sizeof words, "task \"press\" did not return within %g ms", limit_ms);
    ck_assert_msg(t.seen.error == CM1E_ERROR_PROGRAM, "%s: %s", names[t.hang], cm1e_strerror(t.seen.error));
    ck_assert_msg(strstr(t.seen.text, words) && strstr(t.seen.text, "endless loop"), "%s", t.seen.text);
    ck_assert_msg(log_names(words), "the log does not name the task");
    ck_assert_int_eq(t.result, CM1E_ERROR_PROGRAM);
    ck_assert_msg(strstr(t.diag.text, "\"press\" did not return"), "%s", t.diag.text);
}

/** The motor brakes within its ramp (50 ms), no faster than before, and stays. */
static void judge_motor(void)
{
    ck_assert_msg(t.seen.speed_before > 0.95 * velocity, "%s: %g u/s before", names[t.hang], t.seen.speed_before);
    const double fastest = shaft().peak_velocity_counts_per_s / COUNTS;
    ck_assert_msg(fastest <= 1.05 * t.speed_at_hang, "%s: %g u/s since then", names[t.hang], fastest);
    ck_assert_msg(t.seen.moved_ns < 80 * MS, "%s: still moving %g ms later", names[t.hang], (double)t.seen.moved_ns / MS);
    ck_assert_msg(t.seen.calls_after > 250, "%s: the other task was called %u times", names[t.hang], t.seen.calls_after);
    ck_assert_msg(fabs(t.seen.last - t.seen.position) < velocity * 0.05, "%s: %g u", names[t.hang],
                  t.seen.last - t.seen.position);
}

static const struct {
    hang_t hang;
    cm1e_mapping_t mapping;
    int32_t cycles;
} hangs[] = {
    {COMPUTES, CM1E_MAPPING_DYNAMIC, 0}, {COMPUTES, CM1E_MAPPING_CSV, 0}, {COMPUTES, CM1E_MAPPING_CSV, 3},
    {CALLS_BLOCK, CM1E_MAPPING_DYNAMIC, 20}, {CALLS_POWER, CM1E_MAPPING_DYNAMIC, 20}, {SLEEPS, CM1E_MAPPING_DYNAMIC, 20},
    {LOCKS, CM1E_MAPPING_CSV, 20}, {RETURNS_LATE, CM1E_MAPPING_DYNAMIC, 0},
};
enum { HANG_CASES = sizeof hangs / sizeof hangs[0] };

START_TEST(test_task_that_does_not_return_is_ended_and_all_axes_stop_while_the_cycle_goes_on)
{
    const double limit_ms = hangs[_i].cycles ? hangs[_i].cycles : 50;
    prepare(hangs[_i].hang, hangs[_i].mapping, hangs[_i].cycles);
    machine_add(&t.machine, "watcher", 0, 1, living_program, NULL);
    run(1000 * MS);
    const unsigned calls = t.calls;
    judge_texts(limit_ms);
    judge_motor();
    cm1e_scheduler_statistics_t statistics;
    cm1e_scheduler_statistics(t.machine.scheduler, &statistics);
    /* The drive never came to miss its frames for 100 ms: it would say so itself. */
    ck_assert_uint_eq(statistics.bus.lost_frames, 0);
    ck_assert_msg(calls + t.seen.calls_after >= t.seen.calls - 1 && t.seen.calls_after + calls <= t.seen.calls + 2,
                  "it was called again: %u calls, the other task %u, %u of them later", calls, t.seen.calls,
                  t.seen.calls_after);
    machine_close(&t.machine);
}
END_TEST

START_TEST(test_without_another_task_the_run_ends_in_order_with_an_error)
{
    prepare(COMPUTES, CM1E_MAPPING_DYNAMIC, 0);
    run(0);
    ck_assert_int_eq(t.result, CM1E_ERROR_PROGRAM);
    ck_assert_msg(strstr(t.diag.text, "\"press\" did not return within 50 ms"), "%s", t.diag.text);
    cm1e_axis_info_t info;
    cm1e_axis_read(t.machine.axis[0], &info);
    ck_assert_int_eq(info.state, CM1E_AXIS_ERROR_STOP);
    ck_assert(!info.powered);
    machine_close(&t.machine);
}
END_TEST

/** The MC_Power of the task that was ended still has Enable TRUE. */
START_TEST(test_after_a_reset_only_a_living_task_gives_the_axis_power)
{
    prepare(COMPUTES, CM1E_MAPPING_DYNAMIC, 0);
    t.resets = TRUE;
    machine_add(&t.machine, "watcher", 0, 1, living_program, NULL);
    run(1000 * MS);
    cm1e_axis_info_t info;
    cm1e_axis_read(t.machine.axis[0], &info);
    ck_assert_msg(t.reset.Done, "the axis was not reset");
    ck_assert_int_eq(info.state, CM1E_AXIS_DISABLED);
    judge_motor();
    machine_close(&t.machine);
}
END_TEST

/** In CSV the position that the drive told before the pause is old: it must not drive the position loop. */
START_TEST(test_without_a_limit_and_within_it_a_task_goes_on)
{
    prepare(_i ? LATE_ONCE : IN_TIME, CM1E_MAPPING_CSV, _i ? -1 : 0);
    machine_add(&t.machine, "watcher", 0, 1, living_program, NULL);
    run(500 * MS);
    ck_assert_msg(t.result == CM1E_OK, "%s", t.diag.text);
    ck_assert_msg(t.seen.error == CM1E_OK, "%s", t.seen.text);
    ck_assert_uint_ge(t.calls, t.seen.calls);
    const double fastest = shaft().peak_velocity_counts_per_s / COUNTS;
    ck_assert_msg(fastest > 0.95 * velocity && fastest < 1.05 * t.speed_at_hang, "%s: %g u/s", names[t.hang], fastest);
    machine_close(&t.machine);
}
END_TEST

/** Suspends this process again and again, also while its task computes. */
static pid_t suspend_again_and_again(void)
{
    const pid_t parent = getpid(), child = fork();
    if (child != 0)
        return child;
    for (int i = 0; i < 4; i++) {
        usleep(150000 + 1700 * i);
        kill(parent, SIGSTOP);
        usleep(90000);
        kill(parent, SIGCONT);
    }
    _exit(0);
}

START_TEST(test_a_task_is_not_blamed_for_a_suspended_process)
{
    prepare(IN_TIME, CM1E_MAPPING_DYNAMIC, 20);
    const pid_t child = suspend_again_and_again();
    run(1200 * MS);
    waitpid(child, NULL, 0);
    ck_assert_msg(t.result == CM1E_OK, "%s", t.diag.text);
    machine_close(&t.machine);
}
END_TEST

/** The signal of the watch belongs to the program again after the run, with its handler and its place in the mask. */
START_TEST(test_the_signal_is_as_it_was_after_the_run)
{
    const int number = SIGRTMAX - 3;
    sigset_t blocked, now;
    struct sigaction action;
    for (int how = SIG_BLOCK;; how = SIG_UNBLOCK) {
        sigemptyset(&blocked);
        sigaddset(&blocked, number);
        pthread_sigmask(how, &blocked, NULL);
        prepare(IN_TIME, CM1E_MAPPING_DYNAMIC, 20);
        run(50 * MS);
        machine_close(&t.machine);
        pthread_sigmask(SIG_BLOCK, NULL, &now);
        ck_assert_int_eq(sigismember(&now, number), how == SIG_BLOCK);
        sigaction(number, NULL, &action);
        ck_assert(action.sa_handler == SIG_DFL);
        if (how == SIG_UNBLOCK)
            return;
    }
}
END_TEST

/** How many other threads there are, and of how many of them signals of the program may take the processor. */
static void count_threads(void *context)
{
    int *counts = context;
    DIR *threads = opendir("/proc/self/task");
    counts[0] = counts[1] = 0;
    for (const struct dirent *entry; (entry = readdir(threads));) {
        char path[sizeof entry->d_name + 32], line[128];
        snprintf(path, sizeof path, "/proc/self/task/%s/status", entry->d_name);
        FILE *status = atol(entry->d_name) != gettid() && entry->d_name[0] != '.' ? fopen(path, "r") : NULL;
        counts[0] += status != NULL;
        while (status && fgets(line, sizeof line, status)) {
            const uint64_t all = 1u << (SIGINT - 1) | 1u << (SIGTERM - 1) | 1u << (SIGALRM - 1);
            if (strncmp(line, "SigBlk:", 7) == 0)
                counts[1] += (strtoull(line + 7, NULL, 16) & all) != all;
        }
        if (status)
            fclose(status);
    }
    closedir(threads);
}

/** In the thread of the watch a handler of the program would make it look late. */
START_TEST(test_signals_of_the_program_are_for_its_own_threads)
{
    int counts[2] = {0};
    memset(&t, 0, sizeof t);
    t.machine = (machine_t){.axis_count = 1, .real_time = true};
    machine_open(&t.machine);
    machine_add(&t.machine, "", 0, 0, count_threads, counts);
    const cm1e_task_config_t unwatched = {.name = "free", .program = living_program, .watchdog_cycles = -1, .priority = 1};
    ck_assert_int_eq(cm1e_scheduler_add_task(t.machine.scheduler, &unwatched, NULL), CM1E_OK);
    const int input = dup(STDIN_FILENO);
    close(STDIN_FILENO); /* the next file that is opened gets its number, and is closed all the same */
    machine_run(&t.machine, 50 * MS);
    ck_assert_int_eq(fcntl(STDIN_FILENO, F_GETFD), -1);
    dup2(input, STDIN_FILENO);
    close(input);
    ck_assert_int_ge(counts[0], 1);
    ck_assert_int_eq(counts[1], 0);
    machine_close(&t.machine);
}
END_TEST

START_TEST(test_a_limit_that_is_no_number_of_cycles_is_refused)
{
    cm1e_diag_t diag = {0};
    t.machine = (machine_t){.axis_count = 1};
    machine_open(&t.machine);
    const cm1e_task_config_t task = {.name = "press", .program = living_program, .watchdog_cycles = -2};
    ck_assert_int_eq(cm1e_scheduler_add_task(t.machine.scheduler, &task, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_msg(strstr(diag.text, "\"press\" has -2 cycles"), "%s", diag.text);
    machine_close(&t.machine);
}
END_TEST

static Suite *make_suite(int part)
{
    Suite *suite = suite_create("watch over the tasks");
    TCase *all = tcase_create("all");
    tcase_set_timeout(all, 60);
    if (part == 0) {
        tcase_add_loop_test(all, test_task_that_does_not_return_is_ended_and_all_axes_stop_while_the_cycle_goes_on, 0,
                            HANG_CASES);
    } else {
        tcase_add_test(all, test_without_another_task_the_run_ends_in_order_with_an_error);
        tcase_add_test(all, test_after_a_reset_only_a_living_task_gives_the_axis_power);
        tcase_add_loop_test(all, test_without_a_limit_and_within_it_a_task_goes_on, 0, 2);
        tcase_add_test(all, test_a_task_is_not_blamed_for_a_suspended_process);
        tcase_add_test(all, test_the_signal_is_as_it_was_after_the_run);
        tcase_add_test(all, test_signals_of_the_program_are_for_its_own_threads);
        tcase_add_test(all, test_a_limit_that_is_no_number_of_cycles_is_refused);
    }
    suite_add_tcase(suite, all);
    return suite;
}

int main(void)
{
    need_real_time();
    return run_parts(make_suite, 2);
}
