/**
 * The thread that owns the bus of a Python program (bindings/python/glue/), without Python: threads that use a session
 * in every way get values until another one ends the run and closes the bus, and CM1E_ERROR_STATE from then on. On
 * virtual time a grant is kept to the cycle, and ends with the block that is waited for. The everyday run shows that
 * nobody hangs; ThreadSanitizer, that nothing is used without order.
 */
#include <pthread.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "cm1e/plcopen.h"
#include "py_session.h"
#include "quick_check.h"

enum { THREADS = 7, ROUNDS = 4 };

static cm1e_py_session_t *session;
static cm1e_diag_t diag;
static AXIS_REF_t axes[2];
static cm1e_axis_info_t infos[2];
static MC_ReadStatus_t status;
static MC_Power_t power;
static uint32_t valid_at, status_at;
static cm1e_py_block_t reading, powering;

void (*cm1e_py_call_of(const char *type))(void *fb)
{
    (void)type;
    return NULL;
}

static void call_status(void *fb) { MC_ReadStatus(fb); }
static void call_power(void *fb) { MC_Power(fb); }

static void begin(bool virtual_time)
{
    const cm1e_scheduler_config_t settings = {.realtime_priority = -1, .trace_capacity = 1000};
    cm1e_bus_config_t config;
    uint32_t count = 2;
    ck_assert_int_eq(cm1e_bus_config_init(&config, "sim", 2), CM1E_OK);
    config.virtual_time = virtual_time;
    ck_assert_msg(cm1e_py_open(&session, &config, &diag) == CM1E_OK, "%s", diag.text);
    cm1e_bus_config_free(&config);
    ck_assert_msg(cm1e_py_begin(session, &settings, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_int_eq(cm1e_py_axes(session, axes, infos, &count), CM1E_OK);
    ck_assert_uint_eq(count, 2);
    status = (MC_ReadStatus_t){.Axis = &axes[0], .Enable = TRUE};
    power = (MC_Power_t){.Axis = &axes[1], .Enable = TRUE, .EnablePositive = TRUE, .EnableNegative = TRUE};
    valid_at = offsetof(MC_ReadStatus_t, Valid);
    status_at = offsetof(MC_Power_t, Status);
    reading = (cm1e_py_block_t){.call = call_status, .fb = &status, .ends = &valid_at, .end_count = 1};
    powering = (cm1e_py_block_t){.call = call_power, .fb = &power, .ends = &status_at, .end_count = 1};
    ck_assert_int_eq(cm1e_py_block_add(session, &reading), CM1E_OK);
}

/* ---- what threads do until the bus is closed ---------------------------------------------------------------------- */

static cm1e_error_t use_axes(void)
{
    AXIS_REF_t references[2];
    cm1e_axis_info_t values[2];
    uint32_t count = 2;
    return cm1e_py_axes(session, references, values, &count);
}

static cm1e_error_t use_log(void)
{
    cm1e_log_event_t event;
    char text[512];
    const cm1e_error_t error = cm1e_py_log(session, 0, &event, text, sizeof text);
    return error == CM1E_ERROR_NOT_FOUND ? CM1E_OK : error;
}

static cm1e_error_t use_block(void)
{
    MC_ReadStatus_t seen;
    const cm1e_py_copy_t copy = {.to = &seen, .from = &status, .size = sizeof seen};
    cm1e_py_wait(session, &reading, 300000);
    return cm1e_py_transfer(session, &copy, 1, &reading);
}

static cm1e_error_t use_sdo(void)
{
    uint8_t data[8];
    cm1e_diag_t why;
    cm1e_sdo_t sdo = {.position = 1, .index = 0x6041, .data = data, .size = sizeof data};
    return cm1e_py_sdo(session, &sdo, &why);
}

static cm1e_error_t use_statistics(void)
{
    cm1e_scheduler_statistics_t statistics;
    return cm1e_py_statistics(session, &statistics);
}

static cm1e_error_t use_time(void)
{
    uint64_t advanced;
    int64_t time_ns;
    cm1e_py_advance(session, 5, &reading, &advanced);
    return cm1e_py_time(session, &time_ns);
}

static cm1e_error_t use_text(void)
{
    char text[CM1E_AXIS_ERROR_TEXT_BYTES];
    int64_t time_ns;
    cm1e_py_error_text(session, axes[0], (AXES_GROUP_REF_t){0}, text, sizeof text);
    return cm1e_py_time(session, &time_ns);
}

typedef cm1e_error_t (*use_t)(void);
static const use_t uses[THREADS] = {use_axes, use_log, use_block, use_sdo, use_statistics, use_time, use_text};

static void *go_on(void *use)
{
    cm1e_error_t error = CM1E_OK;
    while (error == CM1E_OK)
        error = (*(const use_t *)use)();
    return (void *)(intptr_t)error;
}

/** A transfer that waits while the run ends is cancelled. */
static void expect_end(pthread_t thread)
{
    void *error;
    pthread_join(thread, &error);
    const cm1e_error_t ended = (cm1e_error_t)(intptr_t)error;
    ck_assert_msg(ended == CM1E_ERROR_STATE || ended == CM1E_ERROR_CANCELLED, "%s", cm1e_strerror(ended));
}

START_TEST(test_threads_use_a_session_until_it_is_closed)
{
    const struct timespec while_they_do = {.tv_nsec = 50000000};
    pthread_t threads[THREADS];
    begin(_i % 2 == 0);
    for (int i = 0; i < THREADS; i++)
        ck_assert_int_eq(pthread_create(&threads[i], NULL, go_on, (void *)(uintptr_t)&uses[i]), 0);
    nanosleep(&while_they_do, NULL);
    if (_i >= ROUNDS / 2)
        ck_assert_int_eq(cm1e_py_end(session, &diag), CM1E_OK);
    ck_assert_int_eq(cm1e_py_close(session, &diag), CM1E_OK);
    for (int i = 0; i < THREADS; i++)
        expect_end(threads[i]);
    ck_assert(!cm1e_py_runs(session));
    cm1e_py_free(session);
}
END_TEST

START_TEST(test_a_grant_is_kept_to_the_cycle_and_ends_with_a_block)
{
    int64_t time_ns;
    uint64_t advanced;
    begin(true);
    ck_assert_int_eq(cm1e_py_advance(session, 7, NULL, &advanced), CM1E_OK);
    ck_assert_int_eq(cm1e_py_time(session, &time_ns), CM1E_OK);
    ck_assert_int_eq(time_ns, 7000000);
    ck_assert_int_eq(cm1e_py_block_add(session, &powering), CM1E_OK);
    ck_assert_int_eq(cm1e_py_advance(session, 1000, &powering, &advanced), CM1E_OK);
    ck_assert(cm1e_py_block_ended(&powering) && power.Status);
    ck_assert(advanced > 1 && advanced < 100);
    ck_assert_int_eq(cm1e_py_block_remove(session, &powering), CM1E_OK);
    ck_assert_int_eq(cm1e_py_close(session, &diag), CM1E_OK);
    ck_assert_int_eq(cm1e_py_advance(session, 1, NULL, &advanced), CM1E_ERROR_STATE);
    ck_assert_int_eq(cm1e_py_block_add(session, &powering), CM1E_ERROR_STATE);
    cm1e_py_free(session);
}
END_TEST

/* ---- beside a cycle ------------------------------------------------------------------------------------------------ */

static atomic_bool within;

/** A cycle that lasts. */
static void call_slowly(void *fb)
{
    const struct timespec while_it_does = {.tv_nsec = 20000000};
    (void)fb;
    atomic_store(&within, true);
    nanosleep(&while_it_does, NULL);
    atomic_store(&within, false);
}

static void *advance_one(void *unused)
{
    uint64_t advanced;
    (void)unused;
    return (void *)(intptr_t)cm1e_py_advance(session, 1, NULL, &advanced);
}

/** Within a cycle an axis may be changing what its text tells. */
START_TEST(test_the_text_of_an_error_is_read_between_two_cycles)
{
    char text[CM1E_AXIS_ERROR_TEXT_BYTES];
    cm1e_py_block_t slow = {.call = call_slowly};
    pthread_t thread;
    begin(true);
    ck_assert_int_eq(cm1e_py_block_add(session, &slow), CM1E_OK);
    ck_assert_int_eq(pthread_create(&thread, NULL, advance_one, NULL), 0);
    while (!atomic_load(&within))
        nanosleep(&(struct timespec){.tv_nsec = 100000}, NULL);
    cm1e_py_error_text(session, axes[0], (AXES_GROUP_REF_t){0}, text, sizeof text);
    ck_assert_msg(!atomic_load(&within), "the text was read within a cycle");
    pthread_join(thread, NULL);
    ck_assert_int_eq(cm1e_py_close(session, &diag), CM1E_OK);
    cm1e_py_free(session);
}
END_TEST

START_TEST(test_a_session_that_cannot_be_opened_leaves_nothing)
{
    cm1e_bus_config_t config;
    ck_assert_int_eq(cm1e_bus_config_init(&config, "no-such-one", 1), CM1E_OK);
    ck_assert_int_ne(cm1e_py_open(&session, &config, &diag), CM1E_OK);
    ck_assert_ptr_null(session);
    ck_assert_msg(strstr(diag.text, "no-such-one") != NULL, "%s", diag.text);
    cm1e_bus_config_free(&config);
    cm1e_py_free(session);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("py_owner");
    TCase *cases = tcase_create("py_owner");
    tcase_add_loop_test(cases, test_threads_use_a_session_until_it_is_closed, 0, ROUNDS);
    tcase_add_test(cases, test_a_grant_is_kept_to_the_cycle_and_ends_with_a_block);
    tcase_add_test(cases, test_the_text_of_an_error_is_read_between_two_cycles);
    tcase_add_test(cases, test_a_session_that_cannot_be_opened_leaves_nothing);
    suite_add_tcase(suite, cases);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
