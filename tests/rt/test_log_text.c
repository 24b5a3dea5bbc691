/**
 * Sentences of the event log about variables and tasks: a value is as a program writes it, with all of its digits, and a
 * sentence that is cut off ends where its room ends.
 */
#include <float.h>
#include <stdlib.h>

#include "cm1e/log.h"
#include "machine.h"
#include "scheduler/event_log.h"
#include "scheduler/forcing.h"

#define MS INT64_C(1000000)

static machine_t machine;

/* ---- variables --------------------------------------------------------------------------------------------------- */

static const char *const modes[] = {"OFF", "SLOW"};
static const int64_t mode_values[] = {-1, INT64_MAX};

static union {
    uint8_t bytes[64];
    int8_t sint;
    int16_t i;
    int64_t lint;
    uint64_t ulint;
    float real;
    double lreal;
} data; /* of all rows */

#define ROW(path, u, t, size) {.name = path, .unit = u, .declared = "", .type = t, .data = &data, .bytes = size}

static const variable_t rows[] = {
    ROW("Main.lamp", "V", CM1E_TRACE_BOOL, 1),
    ROW("Main.small", "", CM1E_TRACE_SINT, 1),
    ROW("Main.count", "mm", CM1E_TRACE_INT, 2),
    ROW("Main.big", "ms", CM1E_TRACE_LINT, 8),
    ROW("Main.most", "ms", CM1E_TRACE_ULINT, 8),
    ROW("Main.share", "%", CM1E_TRACE_REAL, 4),
    ROW("Main.goal", "u", CM1E_TRACE_LREAL, 8),
    {.name = "Main.mode", .unit = "", .declared = "E", .type = CM1E_TRACE_LINT, .data = &data, .bytes = 8,
     .names = modes, .values = mode_values, .name_count = 2},
    {.name = "Main.text", .unit = "", .declared = "STRING", .form = VARIABLE_STRING, .data = &data, .bytes = 8},
};
enum { LAMP, SMALL, COUNT, BIG, MOST, SHARE, GOAL, MODE, TEXT, ROWS };

#define INTEGER(v) {.lint = v}
static const struct {
    uint32_t row;
    union { int64_t lint; float real; double lreal; } value; /* little-endian: its first bytes are those of a shorter one */
    const char *text;
} cases[] = {
    {LAMP, INTEGER(1), "TRUE"}, {LAMP, INTEGER(0), "FALSE"},
    {SMALL, INTEGER(-128), "-128"}, {COUNT, INTEGER(-32768), "-32768 mm"},
    {BIG, INTEGER(INT64_MIN), "-9223372036854775808 ms"}, {BIG, INTEGER(INT64_MAX), "9223372036854775807 ms"},
    {BIG, INTEGER(-9007199254740993), "-9007199254740993 ms"}, {BIG, INTEGER(0), "0 ms"},
    {MOST, INTEGER(-1), "18446744073709551615 ms"}, {MOST, INTEGER(9007199254740993), "9007199254740993 ms"},
    {SHARE, {.real = 0.1f}, "0.1 %"}, {SHARE, {.real = FLT_MAX}, "3.4028235e+38 %"},
    {GOAL, {.lreal = 0.1}, "0.1 u"}, {GOAL, {.lreal = -1234567.25}, "-1234567.25 u"},
    {MODE, INTEGER(-1), "OFF"}, {MODE, INTEGER(INT64_MAX), "SLOW"}, {MODE, INTEGER(7), "7"},
    {TEXT, INTEGER('a'), "a text"},
};
enum { CASES = sizeof cases / sizeof cases[0] };

static cm1e_log_event_t newest(void)
{
    static cm1e_log_event_t events[CM1E_LOG_EVENTS];
    const size_t count = cm1e_log_read(machine.scheduler, 0, events, CM1E_LOG_EVENTS, NULL);
    ck_assert_uint_gt(count, 0);
    return events[count - 1];
}

/** The newest record, also where there is less room for it. */
static void expect_text(const char *words)
{
    const cm1e_log_event_t event = newest();
    char text[256], part[256];
    cm1e_log_text(machine.scheduler, &event, text, sizeof text);
    ck_assert_str_eq(text, words);
    for (size_t size = 1; size <= strlen(words) + 1; size++) {
        memset(part, '~', sizeof part);
        cm1e_log_text(machine.scheduler, &event, part, size);
        ck_assert(strncmp(part, words, size - 1) == 0 && part[size - 1] == '\0' && part[size] == '~');
    }
}

static void expect_value(int n, const char *before, const char *behind)
{
    char words[256];
    snprintf(words, sizeof words, "%s %s %s%s", rows[cases[n].row].name, before, cases[n].text, behind);
    expect_text(words);
}

static void write_and_force(void *context)
{
    (void)context;
    for (int n = 0; n < CASES; n++) {
        static const int owner;
        forced_t forced = {.owner = &owner, .variable = cases[n].row, .until_ns = INT64_MAX};
        memcpy(forced.value.bytes, &cases[n].value, sizeof cases[n].value);
        ck_assert_int_eq(cm1e_scheduler_write(machine.scheduler, cases[n].row, &forced.value), FORCING_DONE);
        expect_value(n, "was set to", " from outside");
        ck_assert_int_eq(cm1e_scheduler_force(machine.scheduler, &forced), FORCING_DONE);
        expect_value(n, "was forced to", " from outside");
        ck_assert_int_eq(memcmp(data.bytes, &cases[n].value, rows[cases[n].row].bytes), 0);
        cm1e_scheduler_release(machine.scheduler, &forced);
        expect_value(n, "is no longer forced to", "");
    }
    cm1e_scheduler_stop(machine.scheduler);
}

START_TEST(test_a_value_from_outside_is_told_as_a_program_writes_it)
{
    machine = (machine_t){.axis_count = 1};
    machine_open(&machine);
    cm1e_scheduler_set_variables(machine.scheduler, rows, ROWS);
    machine_add(&machine, "", 0, 0, write_and_force, NULL);
    machine_run(&machine, 0);
    const cm1e_log_event_t unknown = {.kind = CM1E_LOG_VARIABLE, .axis = -1, .code = 1, .detail = ROWS, .value = 0.5};
    char text[100];
    cm1e_log_text(machine.scheduler, &unknown, text, sizeof text);
    ck_assert_str_eq(text, "a variable was forced to 0.5 from outside");
    machine_close(&machine);
}
END_TEST

/* ---- tasks ------------------------------------------------------------------------------------------------------- */

static void do_nothing(void *context) { (void)context; }

START_TEST(test_a_task_that_was_ended_is_told_with_its_limit)
{
    log_t log = {0};
    cm1e_log_event_t event;
    char text[128];
    machine = (machine_t){.axis_count = 1};
    machine_open(&machine);
    machine_add(&machine, "first", 0, 1, do_nothing, NULL);
    machine_add(&machine, "second", 0, 2, do_nothing, NULL);
    ck_assert(cm1e_log_init(&log, cm1e_clock_monotonic(), NULL) == CM1E_OK);
    cm1e_log_task(&log, 1, 12500 * MS / 1000, 77 * MS);
    ck_assert_uint_eq(cm1e_log_copy(&log, 0, &event, 1, NULL), 1);
    ck_assert_int_eq(event.axis, -1);
    ck_assert_int_eq(event.run_ns, 77 * MS);
    cm1e_log_text(machine.scheduler, &event, text, sizeof text);
    ck_assert_str_eq(text, "task \"second\" did not return within 12.5 ms and was ended; all axes were stopped");
    event.code = 2;
    cm1e_log_text(machine.scheduler, &event, text, sizeof text);
    ck_assert_msg(strncmp(text, "task \"\" did", 11) == 0, "%s", text);
    cm1e_log_free(&log);
    machine_close(&machine);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("log text");
    TCase *tests = tcase_create("log text");
    tcase_add_test(tests, test_a_value_from_outside_is_told_as_a_program_writes_it);
    tcase_add_test(tests, test_a_task_that_was_ended_is_told_with_its_limit);
    suite_add_tcase(suite, tests);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
