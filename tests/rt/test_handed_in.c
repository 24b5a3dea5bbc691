/**
 * Errands and files that a thread hands in while the bus stops, or in the moment at which another one ends. A thread that
 * is refused may free what it has handed in: the bus does not write to it any more. None is judged by another one's time.
 * Two threads meet; the bus is the errands, the file and one slave that answers at once.
 */
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "bus/bus_internal.h"
#include "machine.h"

enum { REFUSED = 0xA5 };
#ifdef __SANITIZE_THREAD__ /* which sees every meeting, and is slow */
enum { ROUNDS = 10000, ERRANDS = 20000 };
#else
enum { ROUNDS = 60000, ERRANDS = 200000 };
#endif

typedef struct kind {
    cm1e_error_t (*submit)(void *transfer);
    bool (*is_done)(const void *transfer);
    void (*stop)(cm1e_bus_t *bus);
    size_t bytes;
} kind_t;

static cm1e_bus_t *bus;
static const kind_t *kind;
static int over;

/* ---- while the bus stops ----------------------------------------------------------------------------------------- */

static cm1e_error_t submit_file(void *transfer)
{
    *(cm1e_foe_t *)transfer = (cm1e_foe_t){.position = 1, .writing = true, .name = "x", .from = (const uint8_t *)"abc", .size = 3};
    return cm1e_foe_submit(bus, transfer, NULL);
}

static bool is_file_done(const void *transfer) { return cm1e_foe_done(transfer); }

static cm1e_error_t submit_errand(void *transfer)
{
    *(cm1e_errand_t *)transfer = (cm1e_errand_t){.kind = ERRAND_REGISTERS, .position = 1, .place = 0x110, .size = 2};
    return cm1e_errand_submit(bus, transfer);
}

static bool is_errand_done(const void *transfer) { return cm1e_errand_done(transfer); }

static const kind_t kinds[] = {
    {submit_errand, is_errand_done, cm1e_errand_cancel, sizeof(cm1e_errand_t)},
    {submit_file, is_file_done, cm1e_foe_job_cancel, sizeof(cm1e_foe_t)},
};

static bool is_over(void) { return __atomic_load_n(&over, __ATOMIC_ACQUIRE); }

/** Hands in one after the other. Of what was refused every byte is marked, and looked at after the next one. */
static void *hand_in(void *unused)
{
    (void)unused;
    union { cm1e_errand_t errand; cm1e_foe_t file; uint8_t bytes[1]; } places[2];
    memset(places, REFUSED, sizeof places);
    uintptr_t spoilt = 0;
    for (unsigned n = 0; !is_over(); n++) {
        const cm1e_error_t error = kind->submit(&places[n % 2]);
        while (error == CM1E_OK && !kind->is_done(&places[n % 2]))
            ;
        memset(&places[n % 2], REFUSED, sizeof places[0]);
        for (size_t i = 0; i < kind->bytes; i++)
            spoilt += places[(n + 1) % 2].bytes[i] != REFUSED;
    }
    return (void *)spoilt; // NOLINT(performance-no-int-to-ptr): a number
}

static void make_bus(void)
{
    bus = calloc(1, sizeof *bus);
    ck_assert_ptr_nonnull(bus);
    bus->slaves = calloc(1, sizeof *bus->slaves);
    ck_assert_ptr_nonnull(bus->slaves);
    bus->slave_count = 1;
    bus->slaves[0].facts.foe = bus->slaves[0].facts.coe = true;
    bus->slaves[0].coe.mailbox.out_length = bus->slaves[0].coe.mailbox.in_length = 128;
    over = 0;
}

static void free_bus(void)
{
    free(bus->slaves);
    free(bus);
}

START_TEST(what_was_refused_is_not_touched_any_more)
{
    pthread_t thread;
    void *spoilt;
    make_bus();
    kind = &kinds[_i];
    ck_assert_int_eq(pthread_create(&thread, NULL, hand_in, NULL), 0);
    for (unsigned n = 0; n < ROUNDS; n++) {
        cm1e_bus_set_phase(bus, BUS_OPERATING);
        for (volatile unsigned i = 0; i < n % 97; i++)
            ;
        cm1e_bus_set_phase(bus, BUS_OPEN); /* as cm1e_bus_stop() does: the phase, then what is on its way */
        kind->stop(bus);
    }
    __atomic_store_n(&over, 1, __ATOMIC_RELEASE);
    kind->stop(bus);
    pthread_join(thread, &spoilt);
    ck_assert_uint_eq((uintptr_t)spoilt, 0);
    free_bus();
}
END_TEST

/* ---- in the moment at which another one ends --------------------------------------------------------------------- */

static unsigned good, timeouts;

static void *read_words(void *unused)
{
    (void)unused;
    while (!is_over()) {
        cm1e_errand_t errand = {.kind = ERRAND_SII, .position = 1, .place = 0, .size = 2};
        while (cm1e_errand_submit(bus, &errand) != CM1E_OK)
            if (is_over())
                return NULL;
        while (!cm1e_errand_done(&errand))
            ;
        __atomic_fetch_add(errand.error == CM1E_ERROR_TIMEOUT ? &timeouts : &good, 1, __ATOMIC_RELAXED);
    }
    return NULL;
}

static void serve_errands(int64_t now_ns)
{
    cm1e_bus_slave_t *slave = &bus->slaves[0];
    cm1e_errand_serve(bus, now_ns);
    if (!cm1e_errand_next(bus, slave))
        return;
    memset(slave->datagram.data, 0, 32);
    slave->datagram.working_counter = 1;
    cm1e_errand_result(bus, slave, now_ns);
}

START_TEST(no_errand_is_judged_by_the_time_of_another_one)
{
    pthread_t threads[2];
    make_bus();
    good = timeouts = 0;
    cm1e_bus_set_phase(bus, BUS_OPERATING);
    for (size_t i = 0; i < 2; i++)
        ck_assert_int_eq(pthread_create(&threads[i], NULL, read_words, NULL), 0);
    int64_t now_ns = 1000000000; /* a us for each round: none of them takes 2 s */
    while (__atomic_load_n(&good, __ATOMIC_RELAXED) + __atomic_load_n(&timeouts, __ATOMIC_RELAXED) < ERRANDS)
        serve_errands(now_ns += 1000);
    __atomic_store_n(&over, 1, __ATOMIC_RELEASE);
    cm1e_bus_set_phase(bus, BUS_OPEN);
    cm1e_errand_cancel(bus);
    for (size_t i = 0; i < 2; i++)
        pthread_join(threads[i], NULL);
    ck_assert_uint_eq(timeouts, 0);
    free_bus();
}
END_TEST

int main(void)
{
    TCase *all = tcase_create("handed in");
    tcase_set_timeout(all, 60);
    tcase_add_loop_test(all, what_was_refused_is_not_touched_any_more, 0, sizeof kinds / sizeof *kinds);
    tcase_add_test(all, no_errand_is_judged_by_the_time_of_another_one);
    Suite *suite = suite_create("handed in");
    suite_add_tcase(suite, all);
    SRunner *runner_of_all = srunner_create(suite);
    srunner_run_all(runner_of_all, CK_ENV);
    const int failed = srunner_ntests_failed(runner_of_all);
    srunner_free(runner_of_all);
    return failed == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
