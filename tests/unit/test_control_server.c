/* Control sockets of several schedulers of one program, which begin and end at the same time: each has a socket of its own,
 * and keeps it. And a request that finds no memory for its reply. */
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <unity.h>

#include "cm1e/control.h"
#include "cm1e/scheduler.h"
#include "cm1e/sim.h"
#include "control/record_request.h"
#include "control/runtime_dir.h"
#include "control/server.h"
#include "control/view.h"

enum { THREADS = 8, TIMES = 60, PATH = 112 };

static cm1e_bus_t *bus;
static cm1e_scheduler_t *scheduler;
static cm1e_bus_config_t config;
static cm1e_diag_t diag;
static char directory[] = "/tmp/cm1e-test-XXXXXX", paths[THREADS][PATH];
static pthread_barrier_t meet;

void setUp(void) {}
void tearDown(void) {}

static bool is_served(const char *path)
{
    cm1e_control_t *control;
    const cm1e_error_t error = cm1e_control_connect(&control, path, NULL, NULL);
    cm1e_control_close(control);
    return error == CM1E_OK;
}

/** Returns how often something was wrong. */
static void *begin_together(void *context)
{
    char *path = context;
    unsigned long faults = 0;
    for (int n = 0; n < TIMES; n++) {
        cm1e_control_server_t *server;
        pthread_barrier_wait(&meet);
        const cm1e_error_t error = cm1e_control_server_start(&server, scheduler, 0, path, PATH, NULL);
        pthread_barrier_wait(&meet);
        for (int i = 0; i < THREADS; i++)
            faults += paths[i] != path && strcmp(paths[i], path) == 0;
        pthread_barrier_wait(&meet);
        if (error == CM1E_OK)
            cm1e_control_server_stop(server);
        faults += error != CM1E_OK;
    }
    return (void *)faults;
}

static void *begin_while_others_end(void *context)
{
    char *path = context;
    unsigned long faults = 0;
    for (int n = 0; n < TIMES; n++) {
        cm1e_control_server_t *server;
        const cm1e_error_t error = cm1e_control_server_start(&server, scheduler, 0, path, PATH, NULL);
        faults += error != CM1E_OK || !is_served(path);
        if (error == CM1E_OK)
            cm1e_control_server_stop(server);
    }
    return (void *)faults;
}

static void run(void *(*program)(void *))
{
    pthread_t threads[THREADS];
    pthread_barrier_init(&meet, NULL, THREADS);
    for (int i = 0; i < THREADS; i++)
        TEST_ASSERT_EQUAL_INT(0, pthread_create(&threads[i], NULL, program, paths[i]));
    unsigned long faults = 0;
    for (int i = 0; i < THREADS; i++) {
        void *found;
        pthread_join(threads[i], &found);
        faults += (unsigned long)found;
    }
    pthread_barrier_destroy(&meet);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(0, faults, "a socket was given twice, or is gone");
}

static void test_those_that_begin_together_have_different_sockets(void) { run(begin_together); }
static void test_one_that_ends_leaves_those_of_others_alone(void) { run(begin_while_others_end); }

/* One more than there are numbers for is refused, and takes the socket of nobody. */
static void test_one_too_many_is_refused_and_removes_no_socket(void)
{
    cm1e_control_server_t *servers[CM1E_SOCKETS_OF_PROCESS], *more;
    char last[PATH], none[PATH];
    for (int i = 0; i < CM1E_SOCKETS_OF_PROCESS; i++)
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_control_server_start(&servers[i], scheduler, 0, last, PATH, NULL));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_IO, cm1e_control_server_start(&more, scheduler, 0, none, PATH, &diag));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, "has 16 control sockets already"), diag.text);
    TEST_ASSERT_TRUE(is_served(last));
    for (int i = 0; i < CM1E_SOCKETS_OF_PROCESS; i++)
        cm1e_control_server_stop(servers[i]);
}

/* ---- no memory --------------------------------------------------------------------------------------------------- */

static int countdown; /* the allocation of the texts of replies that fails; 0: none */
static void *allocate(size_t size) { return countdown > 0 && --countdown == 0 ? NULL : malloc(size); }

/* A recording is told whole, or it does not begin: then the connection can ask for it again. */
static void test_a_recording_whose_description_finds_no_memory_does_not_begin(void)
{
    static control_run_t control_run;
    control_request_t request = {.client = 1};
    json_t *message = json_object(), *whole = NULL;
    int refused = 0;
    json_set_alloc_funcs(allocate, free);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_view_init(&control_run.view, scheduler, 0));
    for (int n = 0; n == 0 || countdown == 0; n++) { /* 0: as it is; the last one needs none that fails */
        countdown = n;
        json_t *reply = cm1e_record_begin(&request, &control_run, message);
        const bool begun = json_is_true(json_object_get(reply, "ok"));
        TEST_ASSERT_EQUAL_INT(begun, control_run.view.recorders[1] != NULL);
        whole = whole ? whole : json_incref(reply);
        TEST_ASSERT_TRUE(!begun || json_equal(reply, whole));
        TEST_ASSERT_TRUE(cm1e_recorder_end(&control_run.view, 1, true));
        refused += !begun;
        json_decref(reply);
    }
    TEST_ASSERT_GREATER_THAN_INT(10, refused);
    countdown = 0;
    json_decref(whole);
    json_decref(message);
    cm1e_view_free(&control_run.view);
    json_set_alloc_funcs(malloc, free);
}

/* The order of a list of signals is handed in for each part of the list. */
static void test_an_order_that_was_decided_waits_when_it_is_handed_in_again(void)
{
    static view_t view;
    view_order_t order = {.decided = true}, other = {0};
    TEST_ASSERT_TRUE(cm1e_view_submit(&view, &order));
    TEST_ASSERT_FALSE(order.decided);
    TEST_ASSERT_FALSE(cm1e_view_submit(&view, &other));
    TEST_ASSERT_TRUE(cm1e_view_withdraw(&view, &order));
    TEST_ASSERT_FALSE(cm1e_view_withdraw(&view, &order));
}

int main(void)
{
    UNITY_BEGIN();
    cm1e_bus_config_init(&config, "sim", 1);
    config.virtual_time = true;
    if (!mkdtemp(directory) || setenv("CM1E_RUNTIME_DIR", directory, 1) != 0 ||
        cm1e_bus_open(&bus, &config, &diag) != CM1E_OK || cm1e_bus_start(bus, &diag) != CM1E_OK ||
        cm1e_scheduler_create(&scheduler, bus, NULL, &diag) != CM1E_OK) {
        printf("%s\n", diag.text);
        return 1;
    }
    RUN_TEST(test_those_that_begin_together_have_different_sockets);
    RUN_TEST(test_one_that_ends_leaves_those_of_others_alone);
    RUN_TEST(test_one_too_many_is_refused_and_removes_no_socket);
    RUN_TEST(test_a_recording_whose_description_finds_no_memory_does_not_begin);
    RUN_TEST(test_an_order_that_was_decided_waits_when_it_is_handed_in_again);
    cm1e_scheduler_destroy(scheduler);
    cm1e_bus_close(bus);
    rmdir(directory);
    return UNITY_END();
}
