/**
 * The bounds of a scheduler: how many buses and axes it may have, no memory, and the numbers of a task. What is refused
 * changes nothing.
 */
#include <stdlib.h>
#include <string.h>

#include "cm1e/sim.h"
#include "cm1e/trace.h"
#include "scheduler/scheduler_window.h"
#include "scheduler/trace_recorder.h"
#include "two_buses.h"

/** A bus that is started, with a motor and virtual axes: X1, X2 ... */
static cm1e_bus_t *start_bus(const char *name, uint32_t count)
{
    cm1e_bus_config_t config;
    cm1e_bus_t *bus;
    cm1e_bus_config_init(&config, "sim", count);
    for (uint32_t i = 0; i < count; i++) {
        if (i > 0)
            config.axes[i] = (cm1e_axis_config_t){.type = CM1E_AXIS_VIRTUAL, .counts_per_unit = 1000};
        snprintf(config.axes[i].name, sizeof config.axes[i].name, "%s%u", name, i + 1);
    }
    config.virtual_time = true;
    must(cm1e_bus_open(&bus, &config, &diag));
    cm1e_bus_config_free(&config);
    must(cm1e_bus_start(bus, &diag));
    return bus;
}

/** The fifth one notes of the others how many cycles they had before. */
static void start_many(cm1e_bus_t *many[CM1E_MAX_BUSES + 1], uint64_t cycles[CM1E_MAX_BUSES])
{
    for (int i = 0; i <= CM1E_MAX_BUSES; i++) {
        char name[8];
        snprintf(name, sizeof name, "N%d_", i);
        for (int other = 0; other < i && i == CM1E_MAX_BUSES; other++)
            cycles[other] = cm1e_bus_counters(many[other])->cycles;
        many[i] = start_bus(name, 1);
    }
}

static void refuse(cm1e_bus_t *bus, const char *says)
{
    ck_assert_int_eq(cm1e_scheduler_add_bus(scheduler, bus, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_msg(strstr(diag.text, says), "%s", diag.text);
}

/* ---- buses and axes ---------------------------------------------------------------------------------------------- */

START_TEST(test_four_buses_and_no_more)
{
    cm1e_bus_t *many[CM1E_MAX_BUSES + 1];
    uint64_t unused[CM1E_MAX_BUSES];
    start_many(many, unused);
    must(cm1e_scheduler_create(&scheduler, many[0], NULL, &diag));
    for (int i = 1; i < CM1E_MAX_BUSES; i++)
        must(cm1e_scheduler_add_bus(scheduler, many[i], &diag));
    refuse(many[CM1E_MAX_BUSES], "at most four buses");
    must(cm1e_scheduler_run(scheduler, 100 * MS_IN_NS, &diag));
    cm1e_scheduler_destroy(scheduler);
    for (int i = 0; i <= CM1E_MAX_BUSES; i++)
        cm1e_bus_close(many[i]);
}
END_TEST

/** They get their cycles meanwhile; a run before changes nothing of that. */
START_TEST(test_four_buses_stay_operational_while_a_fifth_starts)
{
    uint64_t cycles[CM1E_MAX_BUSES];
    cm1e_bus_t *many[CM1E_MAX_BUSES + 1], *before = start_bus("X", 1);
    must(cm1e_scheduler_create(&scheduler, before, NULL, &diag));
    must(cm1e_scheduler_run(scheduler, 10 * MS_IN_NS, &diag));
    cm1e_scheduler_destroy(scheduler);
    cm1e_bus_close(before);
    start_many(many, cycles);
    for (int i = 0; i < CM1E_MAX_BUSES; i++) {
        char answer[200];
        ck_assert_uint_gt(cm1e_bus_counters(many[i])->cycles, cycles[i] + 3);
        must(cm1e_bus_simulate(many[i], "status 1", answer, sizeof answer));
        ck_assert_msg(strstr(answer, ", OP,"), "bus %d: %s", i, answer);
    }
    for (int i = 0; i <= CM1E_MAX_BUSES; i++)
        cm1e_bus_close(many[i]);
}
END_TEST

START_TEST(test_as_many_axes_as_there_may_be_and_no_more)
{
    enum { OTHERS = 200 };
    cm1e_bus_t *first = start_bus("X", CM1E_MAX_AXES - OTHERS), *second = start_bus("Y", OTHERS),
               *third = start_bus("Z", 1);
    must(cm1e_scheduler_create(&scheduler, first, NULL, &diag));
    must(cm1e_scheduler_add_bus(scheduler, second, &diag));
    ck_assert_uint_ne(cm1e_scheduler_axis(scheduler, CM1E_MAX_AXES - 1).Handle, 0);
    ck_assert_uint_ne(cm1e_scheduler_axis_by_name(scheduler, "Y200").Handle, 0);
    ck_assert_uint_eq(cm1e_scheduler_axis(scheduler, CM1E_MAX_AXES).Handle, 0);
    refuse(third, "at most 512 axes");
    must(cm1e_scheduler_run(scheduler, 5 * MS_IN_NS, &diag));
    cm1e_scheduler_destroy(scheduler);
    cm1e_bus_close(first);
    cm1e_bus_close(second);
    cm1e_bus_close(third);
}
END_TEST

/* ---- no memory --------------------------------------------------------------------------------------------------- */

void *__real_calloc(size_t count, size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__real_malloc(size_t size);
void *__wrap_malloc(size_t size);
void *__real_aligned_alloc(size_t alignment, size_t size);
void *__wrap_aligned_alloc(size_t alignment, size_t size);
void __real_free(void *memory);
void __wrap_free(void *memory);
static int countdown; /* the allocation that fails; 0: none */
static int held;      /* allocations that were not given back */

static bool fails(void) { return countdown > 0 && --countdown == 0; }

static void *hold(void *memory)
{
    held += memory != NULL;
    return memory;
}

void *__wrap_calloc(size_t count, size_t size) { return fails() ? NULL : hold(__real_calloc(count, size)); }

void *__wrap_malloc(size_t size) { return fails() ? NULL : hold(__real_malloc(size)); }

void *__wrap_aligned_alloc(size_t alignment, size_t size)
{
    return fails() ? NULL : hold(__real_aligned_alloc(alignment, size));
}

void __wrap_free(void *memory)
{
    held -= memory != NULL;
    __real_free(memory);
}

/* Whatever allocation fails, the scheduler is as it was: it has its axes and the columns of its trace, and runs. */
START_TEST(test_a_bus_for_which_there_is_no_memory_changes_nothing)
{
    static const double variable = 1.0;
    const cm1e_scheduler_config_t config = {.trace_capacity = 10};
    buses[A] = start_bus("X", 1);
    buses[B] = start_bus("Y", 1);
    must(cm1e_scheduler_create(&scheduler, buses[A], &config, &diag));
    bool failed = true;
    int failures = 0;
    for (; failed; failures += failed) {
        countdown = failures + 1;
        const cm1e_error_t error = cm1e_scheduler_add_bus(scheduler, buses[B], &diag);
        failed = countdown == 0;
        countdown = 0;
        ck_assert_int_eq(error, failed ? CM1E_ERROR_NO_MEMORY : CM1E_OK);
        ck_assert_uint_eq(cm1e_scheduler_axis(scheduler, 1).Handle != 0, !failed);
        const trace_t *trace = cm1e_scheduler_trace(scheduler);
        ck_assert_uint_eq(trace->axes, failed ? 1 : 2);
        ck_assert_str_eq(trace->columns[0].name, "X1 state");
    }
    ck_assert_int_gt(failures, 4);
    must(cm1e_scheduler_trace_variable(scheduler, "v", "", CM1E_TRACE_LREAL, &variable, &diag));
    must(cm1e_scheduler_run(scheduler, 20 * MS_IN_NS, &diag));
    ck_assert_uint_eq(cm1e_scheduler_trace(scheduler)->used, 10);
    close_all();
}
END_TEST

/** Whatever allocation fails: it is told, and what was allocated before is given back. */
START_TEST(test_a_scheduler_for_which_there_is_no_memory_is_refused)
{
    const cm1e_scheduler_config_t config = {.trace_capacity = 10};
    cm1e_bus_t *bus = start_bus("X", 1);
    countdown = 1000;
    must(cm1e_scheduler_create(&scheduler, bus, &config, &diag));
    const int allocations = 1000 - countdown;
    countdown = 0;
    cm1e_scheduler_destroy(scheduler);
    ck_assert_int_gt(allocations, 5); /* the scheduler, the axis, the trace, the log */
    for (int which = 1; which <= allocations; which++) {
        const int before = held;
        countdown = which;
        const cm1e_error_t error = cm1e_scheduler_create(&scheduler, bus, &config, &diag);
        const int more = held - before;
        ck_assert_int_eq(error, CM1E_ERROR_NO_MEMORY);
        ck_assert(countdown == 0 && !scheduler && strstr(diag.text, "memory"));
        ck_assert_int_eq(more, 0);
    }
    must(cm1e_scheduler_create(&scheduler, bus, &config, &diag));
    must(cm1e_scheduler_run(scheduler, 20 * MS_IN_NS, &diag));
    cm1e_scheduler_destroy(scheduler);
    cm1e_bus_close(bus);
}
END_TEST

/* ---- numbers ----------------------------------------------------------------------------------------------------- */

static void do_nothing(void *context) { (void)context; }

START_TEST(test_numbers_of_a_task_are_refused_outside_of_their_bounds)
{
    static const struct {
        int64_t interval_ns;
        int32_t watchdog_cycles;
        cm1e_error_t error;
    } rows[] = {
        {0, -1, CM1E_OK}, {0, 0, CM1E_OK}, {0, 1, CM1E_OK}, {0, INT32_MAX, CM1E_OK},
        {0, -2, CM1E_ERROR_INVALID_ARGUMENT}, {0, INT32_MIN, CM1E_ERROR_INVALID_ARGUMENT},
        {MS_IN_NS, 0, CM1E_OK}, {3 * MS_IN_NS, 0, CM1E_OK}, {-MS_IN_NS, 0, CM1E_ERROR_CONFIG},
        {1, 0, CM1E_ERROR_CONFIG}, {MS_IN_NS + 1, 0, CM1E_ERROR_CONFIG}, {MS_IN_NS / 2, 0, CM1E_ERROR_CONFIG},
    };
    cm1e_bus_t *bus = start_bus("X", 1);
    must(cm1e_scheduler_create(&scheduler, bus, NULL, &diag));
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        const cm1e_task_config_t task = {.name = "t", .program = do_nothing, .interval_ns = rows[i].interval_ns,
                                         .watchdog_cycles = rows[i].watchdog_cycles};
        ck_assert_msg(cm1e_scheduler_add_task(scheduler, &task, &diag) == rows[i].error, "row %zu", i);
    }
    cm1e_scheduler_destroy(scheduler);
    cm1e_bus_close(bus);
}
END_TEST

static void stop_in_the_tenth(void *context)
{
    int *cycles = context;
    if (++*cycles == 10)
        cm1e_scheduler_stop(scheduler);
}

/** A run that was stopped has not run its time, and one without an end has none. */
START_TEST(test_whether_a_run_ran_its_time)
{
    static const struct {
        int64_t duration_ns;
        bool stops, ran;
    } rows[] = {{20 * MS_IN_NS, false, true}, {20 * MS_IN_NS + 1, false, true}, {1, false, true}, {20 * MS_IN_NS, true, false},
                {10 * MS_IN_NS, true, true}, {0, true, false}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        int cycles = 0;
        cm1e_bus_t *bus = start_bus("X", 1);
        const cm1e_task_config_t task = {.name = "t", .program = stop_in_the_tenth, .context = &cycles};
        must(cm1e_scheduler_create(&scheduler, bus, NULL, &diag));
        if (rows[i].stops)
            must(cm1e_scheduler_add_task(scheduler, &task, &diag));
        must(cm1e_scheduler_run(scheduler, rows[i].duration_ns, &diag));
        ck_assert_msg(cm1e_scheduler_ran_its_time(scheduler) == rows[i].ran, "row %zu", i);
        cm1e_scheduler_destroy(scheduler);
        cm1e_bus_close(bus);
    }
}
END_TEST

/** Also the least and the largest one that are taken. */
START_TEST(test_numbers_of_a_scheduler_are_refused_outside_of_their_bounds)
{
    static const struct {
        cm1e_scheduler_config_t config;
        const char *says; /* "": it is taken */
    } rows[] = {
        {{.realtime_priority = 0}, ""}, {{.realtime_priority = -1}, ""}, {{.realtime_priority = 98}, ""},
        {{.realtime_priority = -2}, "priority is -2"}, {{.realtime_priority = 99}, "priority is 99"},
        {{.cpu = 0}, ""}, {{.cpu = 1}, ""}, {{.cpu = -1}, "CPU or the stop timeout is negative"},
        {{.stop_timeout_ns = 1}, ""}, {{.stop_timeout_ns = -1}, "CPU or the stop timeout is negative"},
    };
    cm1e_bus_t *bus = start_bus("X", 1);
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        const cm1e_error_t error = cm1e_scheduler_create(&scheduler, bus, &rows[i].config, &diag);
        ck_assert_msg(error == (rows[i].says[0] ? CM1E_ERROR_INVALID_ARGUMENT : CM1E_OK), "row %zu", i);
        ck_assert(error == CM1E_OK || (!scheduler && strstr(diag.text, rows[i].says)));
        cm1e_scheduler_destroy(scheduler);
    }
    cm1e_bus_close(bus);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bounds of a scheduler");
    TCase *all = tcase_create("bounds");
    tcase_add_test(all, test_four_buses_and_no_more);
    tcase_add_test(all, test_four_buses_stay_operational_while_a_fifth_starts);
    tcase_add_test(all, test_as_many_axes_as_there_may_be_and_no_more);
    tcase_add_test(all, test_a_bus_for_which_there_is_no_memory_changes_nothing);
    tcase_add_test(all, test_a_scheduler_for_which_there_is_no_memory_is_refused);
    tcase_add_test(all, test_numbers_of_a_task_are_refused_outside_of_their_bounds);
    tcase_add_test(all, test_whether_a_run_ran_its_time);
    tcase_add_test(all, test_numbers_of_a_scheduler_are_refused_outside_of_their_bounds);
    suite_add_tcase(suite, all);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
