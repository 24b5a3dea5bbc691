/**
 * The scheduler on a thread of its own in real time: other threads submit SDO transfers and read statistics, signals
 * end the run, missing privileges are told. Also the test that ThreadSanitizer looks at.
 */
#include <errno.h>
#include <linux/capability.h>
#include <pthread.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include "core/bytes.h"
#include "machine.h"
#include "real_time.h"

#define MS INT64_C(1000000)

static void sleep_ms(int64_t ms)
{
    const struct timespec t = {.tv_sec = ms / 1000, .tv_nsec = ms % 1000 * MS};
    nanosleep(&t, NULL);
}

/* ---- a machine on a thread of its own -------------------------------------------------------------------------- */

typedef struct shuttle {
    MC_Power_t power;
    MC_Home_t home;
    MC_MoveAbsolute_t out, back;
    unsigned homings, moves;
} shuttle_t;

typedef struct plant {
    machine_t machine;
    shuttle_t shuttles[MACHINE_AXES];
    pthread_t thread;
    cm1e_error_t error;
    cm1e_diag_t diag;
    BOOL home_for_ever; /* so that the cycle itself submits SDO transfers all the time */
} plant_t;

static void run_shuttle(plant_t *plant, shuttle_t *s)
{
    s->power.Enable = TRUE;
    MC_Power(&s->power);
    s->home.Execute = s->power.Status && !(plant->home_for_ever && s->home.Done);
    MC_Home(&s->home);
    s->homings += s->home.Done && plant->home_for_ever;
    if (!plant->home_for_ever) {
        s->out.Execute = s->home.Done && !s->back.Done && (s->out.Execute || !s->back.Busy);
        MC_MoveAbsolute(&s->out);
        s->back.Execute = s->out.Done;
        MC_MoveAbsolute(&s->back);
        s->moves += s->back.Done;
    }
}

static void shuttle_program(void *context)
{
    plant_t *plant = context;
    for (uint32_t i = 0; i < plant->machine.axis_count; i++)
        run_shuttle(plant, &plant->shuttles[i]);
}

static void *run_thread(void *context)
{
    plant_t *plant = context;
    plant->error = cm1e_scheduler_run(plant->machine.scheduler, 0, &plant->diag);
    return NULL;
}

static void plant_open(plant_t *plant)
{
    machine_open(&plant->machine);
    for (uint32_t i = 0; i < plant->machine.axis_count; i++) {
        AXIS_REF_t *axis = &plant->machine.axis[i];
        plant->shuttles[i] = (shuttle_t){
            .power = {.Axis = axis, .EnablePositive = TRUE, .EnableNegative = TRUE},
            .home = {.Axis = axis},
            .out = {.Axis = axis, .Position = 5, .Velocity = 100, .Acceleration = 3000},
            .back = {.Axis = axis, .Position = 1, .Velocity = 100, .Acceleration = 3000},
        };
    }
    machine_add(&plant->machine, "shuttle", 0, 0, shuttle_program, plant);
}

static void plant_start(plant_t *plant)
{
    ck_assert_int_eq(pthread_create(&plant->thread, NULL, run_thread, plant), 0);
}

static void plant_join(plant_t *plant)
{
    pthread_join(plant->thread, NULL);
    ck_assert_msg(plant->error == CM1E_OK, "%s", plant->diag.text);
}

/* ---- threads --------------------------------------------------------------------------------------------------- */

static cm1e_sdo_state_t wait_for(const cm1e_sdo_t *sdo)
{
    for (int i = 0; i < 5000 && cm1e_sdo_state(sdo) == CM1E_SDO_BUSY; i++)
        sleep_ms(1);
    return cm1e_sdo_state(sdo);
}

/** Writes a parameter and reads it back: what comes back must be what this thread wrote. */
static void write_and_read(cm1e_bus_t *bus, uint16_t position, uint32_t value)
{
    uint8_t out[4], in[4] = {0};
    cm1e_put_u32(out, value);
    cm1e_sdo_t write = {.position = position, .index = 0x6081, .write = true, .data = out, .size = 4};
    cm1e_sdo_t read = {.position = position, .index = 0x6081, .data = in, .size = 4};
    ck_assert_int_eq(cm1e_sdo_submit(bus, &write), CM1E_OK);
    ck_assert_int_eq(wait_for(&write), CM1E_SDO_DONE);
    ck_assert_int_eq(cm1e_sdo_submit(bus, &read), CM1E_OK);
    ck_assert_int_eq(wait_for(&read), CM1E_SDO_DONE);
    ck_assert_uint_eq(read.size, 4);
    ck_assert_uint_eq(cm1e_get_u32(in), value);
}

static void check_statistics(const cm1e_scheduler_t *scheduler, uint64_t *cycles)
{
    cm1e_scheduler_statistics_t s;
    cm1e_scheduler_statistics(scheduler, &s);
    ck_assert_uint_ge(s.cycles, *cycles);
    ck_assert_int_le(s.execution_time.minimum_ns, s.execution_time.maximum_ns);
    *cycles = s.cycles;
}

START_TEST(test_other_thread_submits_transfers_and_reads_statistics_while_the_cycle_runs)
{
    static plant_t plant;
    plant = (plant_t){.machine = {.axis_count = 3, .real_time = true}, .home_for_ever = (BOOL)_i};
    uint64_t cycles = 0;
    plant_open(&plant);
    plant_start(&plant);
    for (uint32_t n = 0; n < 100; n++) {
        write_and_read(plant.machine.bus, (uint16_t)(1 + n % 3), 1000 + 100 * n);
        check_statistics(plant.machine.scheduler, &cycles);
    }
    while (cycles < 2000) {
        sleep_ms(20);
        check_statistics(plant.machine.scheduler, &cycles);
    }
    cm1e_scheduler_stop(plant.machine.scheduler);
    plant_join(&plant);
    for (int i = 0; i < 3; i++)
        ck_assert_uint_ge(plant.home_for_ever ? plant.shuttles[i].homings : plant.shuttles[i].moves, 1);
    machine_close(&plant.machine);
}
END_TEST

START_TEST(test_start_and_stop_from_another_thread_at_any_time)
{
    for (int i = 0; i < 10; i++) {
        static plant_t plant;
        plant = (plant_t){.machine = {.axis_count = 2, .real_time = true}};
        plant_open(&plant);
        plant_start(&plant);
        sleep_ms(i * 17);
        cm1e_scheduler_stop(plant.machine.scheduler);
        plant_join(&plant);
        for (int axis = 0; axis < 2; axis++) {
            cm1e_axis_info_t info;
            ck_assert_int_eq(cm1e_axis_read(plant.machine.axis[axis], &info), CM1E_OK);
            ck_assert_int_eq(info.state, CM1E_AXIS_DISABLED);
        }
        machine_close(&plant.machine);
    }
}
END_TEST

/* ---- signals --------------------------------------------------------------------------------------------------- */

static volatile sig_atomic_t own_handler_ran;
static void own_handler(int number)
{
    (void)number;
    own_handler_ran = 1;
}

START_TEST(test_signal_stops_in_order_and_means_again_what_it_did_before)
{
    static const int signals[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE};
    const int number = signals[_i];
    static plant_t plant;
    plant = (plant_t){.machine = {.axis_count = 1, .real_time = true}};
    signal(number, own_handler);
    plant_open(&plant);
    cm1e_scheduler_stop_on_signals(plant.machine.scheduler);
    plant_start(&plant);
    sleep_ms(300);
    kill(getpid(), number);
    plant_join(&plant);
    cm1e_axis_info_t info;
    cm1e_axis_read(plant.machine.axis[0], &info);
    ck_assert_int_eq(info.state, CM1E_AXIS_DISABLED);
    ck_assert_int_eq(cm1e_bus_slave_watch(plant.machine.bus, 1).al_state, CM1E_AL_INIT);
    ck_assert_int_eq(own_handler_ran, 0);
    machine_close(&plant.machine);
    kill(getpid(), number);
    ck_assert_int_eq(own_handler_ran, 1);
}
END_TEST

/* ---- privileges ------------------------------------------------------------------------------------------------ */

/** No limit of the user allows anything, and of the capabilities these stay. false: this process does not have them. */
static bool keep_capabilities(uint32_t kept)
{
    const struct rlimit none = {0, 0};
    struct __user_cap_header_struct header = {.version = _LINUX_CAPABILITY_VERSION_3};
    struct __user_cap_data_struct data[_LINUX_CAPABILITY_U32S_3] = {{.effective = kept, .permitted = kept}};
    return setrlimit(RLIMIT_RTPRIO, &none) == 0 && setrlimit(RLIMIT_MEMLOCK, &none) == 0 &&
           syscall(SYS_capset, &header, data) == 0;
}

static void drop_privileges(void) { ck_assert(keep_capabilities(0)); }

/** In a container that lacks a privilege, setcap does harm. */
static const char *cure(void)
{
    const bool permitted = prctl(PR_CAPBSET_READ, CAP_SYS_NICE) && prctl(PR_CAPBSET_READ, CAP_IPC_LOCK);
    return permitted ? "cap_sys_nice,cap_ipc_lock+ep /" : "Not even root has cap_";
}

static void stop_in_cycle_20(void *scheduler)
{
    static int cycle;
    if (++cycle == 20)
        cm1e_scheduler_stop(scheduler);
}

/** How many cycles a thread without priority misses, the load of the machine decides: the run ends by their number. */
START_TEST(test_missing_privilege_is_advice_that_says_what_to_do)
{
    machine_t machine = {.axis_count = 1, .real_time = true};
    machine_open(&machine);
    machine_add(&machine, "", 0, 0, stop_in_cycle_20, machine.scheduler);
    drop_privileges();
    machine_run(&machine, 0);
    cm1e_scheduler_statistics_t s;
    cm1e_scheduler_statistics(machine.scheduler, &s);
    ck_assert(!s.realtime);
    const char *const parts[] = {"SCHED_FIFO", cure(), "/etc/security/limits.conf", "ulimit -r"};
    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++)
        ck_assert_msg(strstr(s.advice, parts[i]), "\"%s\" is not in \"%s\"", parts[i], s.advice);
    ck_assert_msg(s.advice[strlen(s.advice) - 1] == '.', "cut off: %s", s.advice);
    ck_assert_uint_ge(s.cycles, 20);
    machine_close(&machine);
}
END_TEST

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
enum { REFUSALS = 1 }; /* their memory is not locked (realtime.c): that is never refused */
#else
enum { REFUSALS = 3 };
#endif

/** One of both is granted: the advice is about the other one, by its name. */
START_TEST(test_advice_is_about_what_was_refused)
{
    static const struct {
        uint32_t kept;
        const char *refused;
    } rows[] = {
        {1u << CAP_IPC_LOCK, "Not real time: SCHED_FIFO refused."},
        {1u << CAP_SYS_NICE, "Not real time: locked memory refused."},
        {0, "Not real time: SCHED_FIFO and locked memory refused."},
    };
    machine_t machine = {.axis_count = 1, .real_time = true};
    machine_open(&machine);
    machine_add(&machine, "", 0, 0, stop_in_cycle_20, machine.scheduler);
    if (keep_capabilities(rows[_i].kept)) {
        machine_run(&machine, 0);
        cm1e_scheduler_statistics_t s;
        cm1e_scheduler_statistics(machine.scheduler, &s);
        ck_assert_msg(strstr(s.advice, rows[_i].refused) == s.advice, "\"%s\"", s.advice);
        ck_assert_msg(strstr(s.advice, cure()) && !strstr(s.advice, "has  in"), "\"%s\"", s.advice);
    }
    machine_close(&machine);
}
END_TEST

START_TEST(test_required_real_time_without_privilege_is_an_error_before_the_first_cycle)
{
    machine_t machine = {.axis_count = 1, .real_time = true, .config = {.realtime_required = true}};
    cm1e_diag_t diag = {0};
    machine_open(&machine);
    drop_privileges();
    ck_assert_int_eq(cm1e_scheduler_run(machine.scheduler, 50 * MS, &diag), CM1E_ERROR_PERMISSION);
    ck_assert_msg(strstr(diag.text, cure()), "%s", diag.text);
    cm1e_scheduler_statistics_t s;
    cm1e_scheduler_statistics(machine.scheduler, &s);
    ck_assert_uint_eq(s.cycles, 0);
    ck_assert_int_eq(cm1e_bus_slave_watch(machine.bus, 1).al_state, CM1E_AL_INIT);
    machine_close(&machine);
}
END_TEST

START_TEST(test_no_real_time_asked_is_no_advice)
{
    machine_t machine = {.axis_count = 1, .real_time = true, .config = {.realtime_priority = -1}};
    machine_open(&machine);
    drop_privileges();
    machine_run(&machine, 20 * MS);
    cm1e_scheduler_statistics_t s;
    cm1e_scheduler_statistics(machine.scheduler, &s);
    ck_assert(!s.realtime && s.advice[0] == '\0');
    machine_close(&machine);
}
END_TEST

START_TEST(test_cpu_that_the_machine_lacks_is_told_and_one_it_has_is_used)
{
    for (int cpu = 1; cpu <= 1024; cpu += 1023) {
        machine_t machine = {.axis_count = 1, .real_time = true, .config = {.realtime_priority = -1, .cpu = cpu}};
        machine_open(&machine);
        machine_run(&machine, 20 * MS);
        cm1e_scheduler_statistics_t s;
        cm1e_scheduler_statistics(machine.scheduler, &s);
        ck_assert_msg((cpu == 1) == (s.advice[0] == '\0'), "CPU %d: \"%s\"", cpu, s.advice);
        machine_close(&machine);
    }
}
END_TEST

static void remember_policy(void *context)
{
    struct sched_param parameters;
    pthread_getschedparam(pthread_self(), (int *)context, &parameters);
}

START_TEST(test_thread_is_as_before_after_the_run)
{
    int before = -1, inside = -1, after = -1;
    machine_t machine = {.axis_count = 1, .real_time = true};
    machine_open(&machine);
    machine_add(&machine, "", 0, 0, remember_policy, &inside);
    run_above_others(false);
    remember_policy(&before);
    machine_run(&machine, 20 * MS);
    remember_policy(&after);
    cm1e_scheduler_statistics_t s;
    cm1e_scheduler_statistics(machine.scheduler, &s);
    ck_assert_int_eq(inside, s.realtime ? SCHED_FIFO : inside);
    ck_assert_int_eq(before, SCHED_OTHER);
    ck_assert_int_eq(after, before);
    machine_close(&machine);
}
END_TEST

/* ---- processors that stay awake ---------------------------------------------------------------------------------- */

/** Times that this process has the file open that keeps processors awake. */
static int awake_files(void)
{
    char path[32], target[64];
    int found = 0;
    for (int fd = 0; fd < 256; fd++) {
        snprintf(path, sizeof path, "/proc/self/fd/%d", fd);
        const ssize_t length = readlink(path, target, sizeof target - 1);
        target[length > 0 ? length : 0] = '\0';
        found += strcmp(target, "/dev/cpu_dma_latency") == 0;
    }
    return found;
}

static void count_awake_files(void *context) { *(int *)context = awake_files(); }

START_TEST(test_processors_stay_awake_during_a_run_in_real_time_and_no_longer)
{
    if (access("/dev/cpu_dma_latency", W_OK) != 0) {
        printf("SKIPPED: processors that stay awake: /dev/cpu_dma_latency cannot be written here\n");
        return;
    }
    for (int priority = -1; priority <= 0; priority++) {
        int inside = -1;
        machine_t machine = {.axis_count = 1, .real_time = true, .config = {.realtime_priority = priority}};
        machine_open(&machine);
        machine_add(&machine, "", 0, 0, count_awake_files, &inside);
        machine_run(&machine, 20 * MS);
        ck_assert_int_eq(inside, priority < 0 ? 0 : 1);
        ck_assert_int_eq(awake_files(), 0);
        machine_close(&machine);
    }
}
END_TEST

/* ---- the begin of a run ------------------------------------------------------------------------------------------ */

static int policy_of_locking = -1;

int mlockall(int flags)
{
    remember_policy(&policy_of_locking);
    return (int)syscall(SYS_mlockall, flags);
}

/** The slaves wait for the first cycle in Operational, with watchdogs of 100 ms. Locking the memory of a large program
 *  takes tens of milliseconds of computing, and many times that at an ordinary priority on a busy machine. */
START_TEST(test_memory_is_locked_with_the_priority_of_the_cycle)
{
    machine_t machine = {.axis_count = 1, .real_time = true};
    run_above_others(false);
    machine_open(&machine);
    machine_run(&machine, 20 * MS);
    cm1e_scheduler_statistics_t s;
    cm1e_scheduler_statistics(machine.scheduler, &s);
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    ck_assert_int_eq(policy_of_locking, -1); /* their shadow memory cannot be locked: realtime.c */
#else
    ck_assert_int_eq(policy_of_locking, s.realtime ? SCHED_FIFO : policy_of_locking);
#endif
    machine_close(&machine);
}
END_TEST

static void add_short_tests(TCase *all)
{
    const TTest *const tests[] = {
        test_start_and_stop_from_another_thread_at_any_time,
        test_missing_privilege_is_advice_that_says_what_to_do,
        test_required_real_time_without_privilege_is_an_error_before_the_first_cycle,
        test_no_real_time_asked_is_no_advice,
        test_cpu_that_the_machine_lacks_is_told_and_one_it_has_is_used,
        test_thread_is_as_before_after_the_run,
        test_processors_stay_awake_during_a_run_in_real_time_and_no_longer,
        test_memory_is_locked_with_the_priority_of_the_cycle,
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tcase_add_test(all, tests[i]);
    tcase_add_loop_test(all, test_advice_is_about_what_was_refused, 0, REFUSALS);
}

static Suite *make_suite(int part)
{
    Suite *suite = suite_create("real time");
    TCase *all = tcase_create("all");
    tcase_set_timeout(all, 60);
    if (part < 2)
        tcase_add_loop_test(all, test_other_thread_submits_transfers_and_reads_statistics_while_the_cycle_runs, part,
                            part + 1);
    else if (part == 2)
        tcase_add_loop_test(all, test_signal_stops_in_order_and_means_again_what_it_did_before, 0, 5);
    else
        add_short_tests(all);
    suite_add_tcase(suite, all);
    return suite;
}

int main(void)
{
    need_real_time();
    return run_parts(make_suite, 4);
}
