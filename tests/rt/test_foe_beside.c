/**
 * Files of a slave, by threads of a program whose scheduler runs: several at a time, beside SDO transfers, with progress,
 * broken off, and ended by the end of the run. In real time, so that ThreadSanitizer sees the threads meet.
 */
#include <pthread.h>
#include <stdlib.h>

#include "cm1e/foe.h"
#include "cm1e/sim.h"
#include "machine.h"

enum { THREADS = 3, FILE_BYTES = 3000, POSITION = 1 };

static cm1e_bus_t *bus;
static cm1e_scheduler_t *scheduler;

static cm1e_error_t open_all(cm1e_diag_t *why)
{
    cm1e_bus_config_t config;
    cm1e_bus_config_init(&config, "sim", 1);
    strcpy(config.axes[0].device, "cia402");
    config.axes[0].firmware[0] = 0;
    config.axes[0].counts_per_revolution = 10000;
    config.axes[0].max_speed_rpm = 3000;
    config.lost_cycles_limit = 50;
    cm1e_error_t error = cm1e_bus_open(&bus, &config, why);
    cm1e_bus_config_free(&config);
    if (error == CM1E_OK)
        error = cm1e_bus_start(bus, why);
    return error == CM1E_OK ? cm1e_scheduler_create(&scheduler, bus, NULL, why) : error;
}

static void *run(void *result)
{
    cm1e_diag_t why;
    *(cm1e_error_t *)result = cm1e_scheduler_run(scheduler, 0, &why);
    return NULL;
}

static cm1e_error_t ran;
static pthread_t runner;

static void begin(void)
{
    cm1e_diag_t why = {0};
    cm1e_scheduler_statistics_t statistics;
    ck_assert_msg(open_all(&why) == CM1E_OK, "%s", why.text);
    ck_assert_int_eq(pthread_create(&runner, NULL, run, &ran), 0);
    do { /* it runs once it has made a cycle */
        cm1e_scheduler_statistics(scheduler, &statistics);
    } while (statistics.cycles == 0);
}

static void end(void)
{
    cm1e_scheduler_stop(scheduler);
    pthread_join(runner, NULL);
    ck_assert_int_eq(ran, CM1E_OK);
    cm1e_scheduler_destroy(scheduler);
    cm1e_bus_close(bus);
}

/* ---- several threads --------------------------------------------------------------------------------------------- */

typedef struct worker {
    pthread_t thread;
    uint8_t seed;
    unsigned refused;      /**< because another file was on its way */
    size_t told, of;       /**< the progress that it saw */
    cm1e_error_t error;
    bool same, again;      /**< a progress was told twice */
} worker_t;

static bool tell(void *context, size_t done, size_t size)
{
    worker_t *worker = context;
    worker->again |= done == worker->told;
    worker->told = done;
    worker->of = size;
    return true;
}

static cm1e_error_t transfer(worker_t *worker, bool reads, uint8_t *bytes, size_t *size)
{
    const cm1e_foe_options_t options = {.progress = tell, .context = worker};
    cm1e_error_t error;
    do {
        cm1e_diag_t why;
        worker->told = 0;
        error = reads ? cm1e_foe_read(bus, POSITION, "a.bin", bytes, size, &options, &why)
                      : cm1e_foe_write(bus, POSITION, "a.bin", bytes, *size, &options, &why);
        worker->refused += error == CM1E_ERROR_BUSY;
    } while (error == CM1E_ERROR_BUSY);
    return error;
}

/* The drive has one file: a thread reads what one of them wrote, whole. */
static void *work(void *context)
{
    worker_t *worker = context;
    uint8_t bytes[FILE_BYTES];
    size_t size = sizeof bytes;
    memset(bytes, worker->seed, sizeof bytes);
    worker->error = transfer(worker, false, bytes, &size);
    if (worker->error == CM1E_OK)
        worker->error = transfer(worker, true, bytes, &size);
    worker->same = size == sizeof bytes;
    for (size_t i = 0; i < size; i++)
        worker->same &= bytes[i] == bytes[0] && bytes[0] >= 1 && bytes[0] <= THREADS;
    return NULL;
}

START_TEST(test_threads_beside_the_cycle_transfer_files)
{
    worker_t workers[THREADS] = {0};
    cm1e_scheduler_statistics_t statistics;
    begin();
    for (int i = 0; i < THREADS; i++) {
        workers[i].seed = (uint8_t)(i + 1);
        ck_assert_int_eq(pthread_create(&workers[i].thread, NULL, work, &workers[i]), 0);
    }
    for (int i = 0; i < THREADS; i++) {
        pthread_join(workers[i].thread, NULL);
        ck_assert_int_eq(workers[i].error, CM1E_OK);
        ck_assert(workers[i].same && !workers[i].again && workers[i].told > 0 && workers[i].told <= FILE_BYTES && workers[i].of == 0);
    }
    cm1e_scheduler_statistics(scheduler, &statistics);
    ck_assert_uint_eq(statistics.bus.lost_frames + statistics.bus.working_counter_errors, 0);
    end();
}
END_TEST

/* ---- early ends -------------------------------------------------------------------------------------------------- */

static bool break_off(void *context, size_t done, size_t size)
{
    *(size_t *)context = done;
    return done == 0 && size == 0;
}

START_TEST(test_a_file_is_broken_off_by_the_thread_that_waits)
{
    static uint8_t bytes[60000];
    size_t done = 0;
    cm1e_diag_t why;
    begin();
    const cm1e_foe_options_t options = {.progress = break_off, .context = &done};
    ck_assert_int_eq(cm1e_foe_write(bus, POSITION, "a.bin", bytes, sizeof bytes, &options, &why), CM1E_ERROR_CANCELLED);
    ck_assert_uint_gt(done, 0);
    ck_assert_uint_lt(done, sizeof bytes);
    const cm1e_foe_options_t in_bootstrap = {.bootstrap = true};
    ck_assert_int_eq(cm1e_foe_write(bus, POSITION, "a.bin", bytes, 10, &in_bootstrap, &why), CM1E_ERROR_STATE);
    ck_assert_int_eq(cm1e_foe_write(bus, 7, "a.bin", bytes, 10, NULL, &why), CM1E_ERROR_INVALID_ARGUMENT);
    end();
}
END_TEST

static void *write_long(void *result)
{
    static uint8_t bytes[60000];
    cm1e_diag_t why;
    *(cm1e_error_t *)result = cm1e_foe_write(bus, POSITION, "a.bin", bytes, sizeof bytes, NULL, &why);
    return NULL;
}

START_TEST(test_the_end_of_the_run_ends_a_file)
{
    cm1e_error_t error = CM1E_OK;
    pthread_t writer;
    begin();
    ck_assert_int_eq(pthread_create(&writer, NULL, write_long, &error), 0);
    cm1e_clock_sleep_until(cm1e_clock_monotonic(), cm1e_clock_now(cm1e_clock_monotonic()) + 50 * MS_IN_NS);
    cm1e_scheduler_stop(scheduler);
    pthread_join(writer, NULL);
    ck_assert_int_eq(error, CM1E_ERROR_CANCELLED);
    end();
}
END_TEST

int main(void)
{
    TCase *all = tcase_create("foe beside");
    tcase_set_timeout(all, 60);
    tcase_add_test(all, test_threads_beside_the_cycle_transfer_files);
    tcase_add_test(all, test_a_file_is_broken_off_by_the_thread_that_waits);
    tcase_add_test(all, test_the_end_of_the_run_ends_a_file);
    Suite *suite = suite_create("files beside the cycle");
    suite_add_tcase(suite, all);
    SRunner *runner_of_all = srunner_create(suite);
    srunner_run_all(runner_of_all, CK_ENV);
    const int failed = srunner_ntests_failed(runner_of_all);
    srunner_free(runner_of_all);
    return failed == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
