/* Where the memory for a run or an object is missing, a function of the scheduler does nothing and says so. */
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "cm1e/log.h"
#include "cm1e/sim.h"
#include "cm1e/trace.h"
#include "machine.h"

#define MS INT64_C(1000000)

static void nothing(void *context) { (void)context; }

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
enum { MEMORY_CAN_BE_LIMITED = false };
#else
enum { MEMORY_CAN_BE_LIMITED = true };
#endif

START_TEST(test_without_memory_for_the_trace_no_cycle_is_run_and_the_bus_is_stopped)
{
    machine_t machine = {.axis_count = 1, .config = {.trace_capacity = 20 * 1000 * 1000}};
    cm1e_diag_t diag = {0};
    char answer[200];
    struct rlimit before, small;
    if (!MEMORY_CAN_BE_LIMITED)
        return;
    machine_open(&machine);
    ck_assert_int_eq(getrlimit(RLIMIT_AS, &before), 0);
    small = (struct rlimit){1 << 30, before.rlim_max};
    ck_assert_int_eq(setrlimit(RLIMIT_AS, &small), 0);
    const cm1e_error_t error = cm1e_scheduler_run(machine.scheduler, 10 * MS, &diag);
    ck_assert_int_eq(setrlimit(RLIMIT_AS, &before), 0);
    ck_assert_msg(error == CM1E_ERROR_NO_MEMORY && strstr(diag.text, "No memory for a trace"), "%d %s", error, diag.text);
    ck_assert_int_eq(cm1e_scheduler_time_ns(machine.scheduler), 0);
    cm1e_bus_simulate(machine.bus, "status 1", answer, sizeof answer);
    ck_assert_msg(strstr(answer, "INIT") != NULL, "%s", answer);
    machine_close(&machine);
}
END_TEST

/** A program that did not look at the error of cm1e_scheduler_create() gets words, and no crash. */
START_TEST(test_nothing_is_done_where_something_is_missing)
{
    machine_t machine = {.axis_count = 1};
    cm1e_diag_t diag = {0};
    cm1e_scheduler_statistics_t statistics = {.cycles = 1};
    const cm1e_log_event_t event = {0};
    uint64_t lost = 1;
    char text[100] = "x";
    machine_open(&machine);
    cm1e_scheduler_t *s = machine.scheduler;
    const cm1e_task_config_t task = {.name = "t", .program = nothing};
    const cm1e_trace_trigger_t trigger = {0};
    ck_assert_int_eq(cm1e_scheduler_create(NULL, machine.bus, NULL, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(cm1e_scheduler_add_task(NULL, &task, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(cm1e_scheduler_add_task(s, NULL, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(cm1e_scheduler_run(NULL, MS, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_str_eq(diag.text, "A scheduler is missing.");
    ck_assert_int_eq(cm1e_scheduler_write_csv(NULL, "never.csv", &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(cm1e_scheduler_write_npy(NULL, "never.npy", &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(cm1e_scheduler_trace_variable(NULL, "x", "", CM1E_TRACE_LREAL, &lost, &diag),
                     CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(cm1e_scheduler_trace_object(NULL, cm1e_scheduler_axis(s, 0), 0x6041, 0, &diag),
                     CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(cm1e_scheduler_trace_trigger(NULL, &trigger, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert(cm1e_scheduler_axis(NULL, 0).Handle == 0 && cm1e_scheduler_axis_by_name(NULL, "axis1").Handle == 0 &&
              cm1e_scheduler_axis_by_name(s, NULL).Handle == 0 && cm1e_scheduler_time_ns(NULL) == 0);
    struct sigaction before, after;
    cm1e_scheduler_stop(NULL);
    sigaction(SIGTERM, NULL, &before);
    cm1e_scheduler_stop_on_signals(NULL);
    sigaction(SIGTERM, NULL, &after);
    ck_assert(before.sa_handler == after.sa_handler); /* the signal is not swallowed */
    cm1e_scheduler_mark(NULL, "x");
    cm1e_scheduler_statistics(s, NULL);
    cm1e_scheduler_statistics(NULL, &statistics);
    ck_assert_uint_eq(statistics.cycles, 0);
    ck_assert(cm1e_log_read(NULL, 0, NULL, 1, &lost) == 0 && lost == 0);
    cm1e_log_text(NULL, &event, text, sizeof text);
    cm1e_log_text(s, NULL, text, sizeof text);
    ck_assert_str_eq(text, "");
    ck_assert_ptr_null(cm1e_bus_segment(NULL));
    ck_assert_int_eq(cm1e_bus_simulate(NULL, "status", text, sizeof text), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(cm1e_bus_simulate(machine.bus, NULL, NULL, 1), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(cm1e_bus_simulate(machine.bus, "status", NULL, 10), CM1E_OK);
    ck_assert_ptr_null(cm1e_sim_segment_create(NULL, &diag));
    machine_close(&machine);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("scheduler missing");
    TCase *all = tcase_create("virtual time");
    tcase_add_test(all, test_without_memory_for_the_trace_no_cycle_is_run_and_the_bus_is_stopped);
    tcase_add_test(all, test_nothing_is_done_where_something_is_missing);
    suite_add_tcase(suite, all);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
