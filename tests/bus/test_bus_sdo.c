/* SDO transfers with the simulated CM1-E: every object, before and in the cycle, many at once, from another thread. */
#include <pthread.h>
#include <signal.h>
#include <ucontext.h>

#include "bus/bus_internal.h"
#include "bus_support.h"

typedef void (*entry_fn)(cm1e_bus_t *bus, const cm1e_entry_t *entry);

static unsigned for_each_entry(cm1e_bus_t *bus, entry_fn function)
{
    size_t count;
    unsigned entries = 0;
    const cm1e_object_t *objects = cm1e_device_objects(&count);
    for (size_t i = 0; i < count; i++) {
        for (unsigned n = 0; n < objects[i].entry_count; n++, entries++)
            function(bus, &objects[i].entries[n]);
    }
    return entries;
}

/** What the tested firmware does not have yet (UG 10.1): entries of later objects, the mode in the profile mapping. */
static bool is_absent(const cm1e_entry_t *entry)
{
    const cm1e_firmware_info_t *firmware = cm1e_firmware_from_version(tested_firmware());
    const bool mode_of_profile = (entry->index == 0x1603 && entry->subindex == 7)
                                 || (entry->index == 0x1A03 && entry->subindex == 9);
    return entry->since > firmware->firmware || (mode_of_profile && !firmware->mode_in_profile_pdo);
}

static void check_read(cm1e_bus_t *bus, const cm1e_entry_t *entry)
{
    uint8_t data[128];
    size_t size = sizeof data;
    const cm1e_error_t error = cm1e_sdo_read(bus, 1, entry->index, entry->subindex, data, &size, &diag);
    if (is_absent(entry)) {
        ck_assert_int_eq(error, CM1E_ERROR_SDO_ABORT);
        ck_assert(diag.foreign_code == SDO_ABORT_NO_OBJECT || diag.foreign_code == SDO_ABORT_NO_SUBINDEX);
        return;
    }
    if (!(entry->access & CM1E_ACCESS_READ)) {
        ck_assert_int_eq(error, CM1E_ERROR_SDO_ABORT);
        ck_assert_uint_eq(diag.foreign_code, SDO_ABORT_WRITE_ONLY);
        return;
    }
    ck_assert_msg(error == CM1E_OK, "%04X:%02X %s", entry->index, entry->subindex, diag.text);
    if (entry->type != CM1E_TYPE_STRING)
        ck_assert_msg(size == entry->bits / 8u, "%04X:%02X has %zu bytes", entry->index, entry->subindex, size);
    else if (entry->default_string && entry->default_string[0])
        ck_assert_uint_gt(size, 0);
}

START_TEST(every_entry_of_the_dictionary_is_read)
{
    cm1e_bus_t *bus = open_scanned_bus(1);
    ck_assert_uint_gt(for_each_entry(bus, check_read), 150);
    cm1e_bus_close(bus);
}
END_TEST

/** Writes back what was read: a value that the device itself gave is one that it takes. */
static void check_write(cm1e_bus_t *bus, const cm1e_entry_t *entry)
{
    uint8_t data[128], again[128];
    size_t size = sizeof data, size_again = sizeof again;
    if (!(entry->access & CM1E_ACCESS_READ) || is_absent(entry))
        return;
    ck_assert_int_eq(cm1e_sdo_read(bus, 1, entry->index, entry->subindex, data, &size, &diag), CM1E_OK);
    const cm1e_error_t error = cm1e_sdo_write(bus, 1, entry->index, entry->subindex, data, size, &diag);
    if (!(entry->access & CM1E_ACCESS_WRITE)) {
        ck_assert_msg(error == CM1E_ERROR_SDO_ABORT, "%04X:%02X", entry->index, entry->subindex);
        ck_assert_uint_eq(diag.foreign_code, SDO_ABORT_READ_ONLY);
        ck_assert_ptr_nonnull(strstr(diag.text, "read-only"));
        return;
    }
    /* An assigned PDO cannot be changed while the number of PDOs is not 0. */
    if (error != CM1E_OK)
        ck_assert_msg(entry->subindex > 0 && entry->access & CM1E_ACCESS_WRITE_PREOP_ONLY, "%04X:%02X %s",
                      entry->index, entry->subindex, diag.text);
    ck_assert_int_eq(cm1e_sdo_read(bus, 1, entry->index, entry->subindex, again, &size_again, &diag), CM1E_OK);
    ck_assert_uint_eq(size, size_again);
    if (entry->kept_minimum == 0) /* 0 means another value there (UG 6.2.2) */
        ck_assert_msg(!memcmp(data, again, size), "%04X:%02X", entry->index, entry->subindex);
}

START_TEST(every_entry_is_written_or_refused_by_its_access)
{
    cm1e_bus_t *bus = open_scanned_bus(1);
    for_each_entry(bus, check_write);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(abort_names_the_slave_the_object_and_the_reason)
{
    static const struct {
        uint16_t index;
        uint8_t subindex;
        uint32_t abort;
        const char *text;
    } cases[] = {
        {0x5FFF, 0, SDO_ABORT_NO_OBJECT, "does not exist"},
        {0x1018, 9, SDO_ABORT_NO_SUBINDEX, "sub-index"},
    };
    uint8_t data[64];
    cm1e_bus_t *bus = open_scanned_bus(2);
    for (unsigned i = 0; i < 2; i++) {
        size_t size = sizeof data;
        ck_assert_int_eq(cm1e_sdo_read(bus, 2, cases[i].index, cases[i].subindex, data, &size, &diag),
                         CM1E_ERROR_SDO_ABORT);
        ck_assert_uint_eq(diag.foreign_code, cases[i].abort);
        char object[16];
        snprintf(object, sizeof object, "0x%04X:%02X", cases[i].index, cases[i].subindex);
        ck_assert_msg(strstr(diag.text, "slave 2") && strstr(diag.text, object) && strstr(diag.text, cases[i].text),
                      "%s", diag.text);
    }
    const uint8_t high[300] = {0xFF, 0xFF, 0xFF, 0x7F};
    ck_assert_int_eq(cm1e_sdo_write(bus, 1, 0x609A, 0, high, 4, &diag), CM1E_ERROR_SDO_ABORT);
    ck_assert_int_eq(cm1e_sdo_write(bus, 1, 0x609A, 0, high, 3, &diag), CM1E_ERROR_SDO_ABORT);
    ck_assert_int_eq(cm1e_sdo_write(bus, 1, 0x609A, 0, high, 64, &diag), CM1E_ERROR_SDO_ABORT);
    ck_assert_int_eq(cm1e_sdo_write(bus, 1, 0x609A, 0, high, sizeof high, &diag), CM1E_ERROR_SDO_ABORT);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(wrong_arguments_are_refused_at_once)
{
    uint8_t data[4];
    size_t size = 4;
    cm1e_bus_t *bus = open_scanned_bus(2);
    ck_assert_int_eq(cm1e_sdo_read(bus, 0, 0x1000, 0, data, &size, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(cm1e_sdo_read(bus, 3, 0x1000, 0, data, &size, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_msg(strstr(diag.text, "no slave 3") && strstr(diag.text, "2"), "%s", diag.text);
    ck_assert_int_eq(cm1e_sdo_read(bus, 1, 0x1000, 0, NULL, &size, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(cm1e_sdo_read(bus, 1, 0x1000, 0, data, NULL, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(cm1e_sdo_write(bus, 1, 0x1000, 0, NULL, 4, NULL), CM1E_ERROR_INVALID_ARGUMENT);
    size = 2;
    ck_assert_int_eq(cm1e_sdo_read(bus, 1, 0x1000, 0, data, &size, NULL), CM1E_ERROR_INVALID_ARGUMENT);
    cm1e_sdo_t sdo = {.position = 9, .index = 0x1000, .data = data, .size = 4};
    ck_assert_int_eq(cm1e_sdo_submit(bus, &sdo), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(cm1e_sdo_state(&sdo), CM1E_SDO_ERROR);
    ck_assert_int_eq(sdo.error, CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(cm1e_sdo_submit(bus, NULL), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(cm1e_sdo_submit(NULL, &sdo), CM1E_ERROR_INVALID_ARGUMENT);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(a_request_that_was_refused_can_be_used_again)
{
    uint8_t data[4];
    cm1e_bus_t *bus = start_bus();
    cm1e_sdo_t sdo = {.position = 1, .index = 0x5FFF, .data = data, .size = sizeof data};
    ck_assert_int_eq(cm1e_sdo_submit(bus, &sdo), CM1E_OK);
    finish_sdo(bus, &sdo);
    ck_assert_int_eq(sdo.error, CM1E_ERROR_SDO_ABORT);
    ck_assert_uint_ne(sdo.abort_code, 0);
    sdo.index = 0x1000;
    sdo.size = sizeof data;
    ck_assert_int_eq(cm1e_sdo_submit(bus, &sdo), CM1E_OK);
    finish_sdo(bus, &sdo);
    ck_assert_int_eq(sdo.error, CM1E_OK);
    ck_assert_uint_eq(sdo.abort_code, 0);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(complete_access_reads_what_the_single_reads_read)
{
    static const uint16_t indices[] = {0x1018, 0x1C00, 0x1C12, 0x1600, 0x1A00, 0x60F6};
    cm1e_bus_t *bus = start_bus();
    for (unsigned i = 0; i < sizeof indices / sizeof indices[0]; i++) {
        static uint8_t whole[1024];
        cm1e_sdo_t sdo = {.position = 1, .index = indices[i], .complete_access = true, .data = whole,
                          .size = sizeof whole};
        ck_assert_int_eq(cm1e_sdo_submit(bus, &sdo), CM1E_OK);
        finish_sdo(bus, &sdo);
        if (sdo.error == CM1E_ERROR_SDO_ABORT) { /* a device may refuse it, but only with this reason */
            ck_assert_uint_eq(sdo.abort_code, SDO_ABORT_COMPLETE_ACCESS);
            continue;
        }
        ck_assert_msg(sdo.error == CM1E_OK, "%04X: %s", indices[i], cm1e_strerror(sdo.error));
        size_t place = 2; /* sub-index 0 takes two bytes (ETG.1000.6 5.6.2) */
        for (unsigned subindex = 1; subindex <= whole[0]; subindex++) {
            uint8_t one[4];
            size_t size = sizeof one;
            const cm1e_error_t error =
                cm1e_sdo_read(bus, 1, indices[i], (uint8_t)subindex, one, &size, &diag);
            if (error != CM1E_OK)
                break;
            ck_assert_uint_le(place + size, sdo.size);
            ck_assert_msg(!memcmp(whole + place, one, size), "%04X:%02X", indices[i], subindex);
            place += size;
        }
    }
    cm1e_bus_close(bus);
}
END_TEST

/* ---- in the cycle ---------------------------------------------------------------------------------------------- */

START_TEST(transfers_ride_in_the_cycle_without_disturbing_it)
{
    enum { SLAVES = 8, ROUNDS = 20 };
    sim_config(SLAVES);
    cm1e_bus_t *bus = start_bus();
    for (int round = 0; round < ROUNDS; round++) {
        uint8_t data[SLAVES][16];
        cm1e_sdo_t sdos[SLAVES];
        for (uint16_t i = 0; i < SLAVES; i++) {
            sdos[i] = (cm1e_sdo_t){.position = (uint16_t)(i + 1), .index = 0x1008, .data = data[i], .size = 16};
            ck_assert_int_eq(cm1e_sdo_submit(bus, &sdos[i]), CM1E_OK);
            ck_assert_int_eq(cm1e_sdo_submit(bus, &sdos[i]), CM1E_ERROR_BUSY);
        }
        for (int n = 0, busy = 1; busy; n++) {
            ck_assert_int_eq(cycle(bus), CM1E_OK);
            ck_assert_int_lt(n, 100); /* all at once, not one after the other */
            busy = 0;
            for (int i = 0; i < SLAVES; i++)
                busy += cm1e_sdo_state(&sdos[i]) == CM1E_SDO_BUSY;
        }
        for (int i = 0; i < SLAVES; i++) {
            ck_assert_int_eq(cm1e_sdo_state(&sdos[i]), CM1E_SDO_DONE);
            ck_assert_uint_ge(sdos[i].size, 5);
            ck_assert(!memcmp(data[i], "CM1-E", 5));
        }
    }
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(queue_takes_64_and_refuses_the_65th)
{
    static cm1e_sdo_t sdos[66];
    static uint8_t data[66][4];
    cm1e_bus_t *bus = open_scanned_bus(1);
    for (int round = 0; round < 3; round++) {
        for (int i = 0; i < 66; i++) {
            sdos[i] = (cm1e_sdo_t){.position = 1, .index = 0x1000, .data = data[i], .size = 4};
            ck_assert_int_eq(cm1e_sdo_submit(bus, &sdos[i]), i < 64 ? CM1E_OK : CM1E_ERROR_FULL);
            ck_assert_int_eq(cm1e_sdo_state(&sdos[i]), i < 64 ? CM1E_SDO_BUSY : CM1E_SDO_IDLE);
        }
        uint8_t own[4];
        size_t size = 4;
        ck_assert_int_eq(cm1e_sdo_read(bus, 1, 0x1001, 0, own, &size, &diag), CM1E_ERROR_FULL);
        if (round == 2)
            break;
        if (round == 0)
            ck_assert_int_eq(cm1e_bus_start(bus, &diag), CM1E_OK); /* the scan ends them all */
        else
            for (int i = 0; i < 64; i++)
                finish_sdo(bus, &sdos[i]);
        for (int i = 0; i < 64; i++)
            ck_assert_int_ne(cm1e_sdo_state(&sdos[i]), CM1E_SDO_BUSY);
    }
    cm1e_bus_stop(bus);
    for (int i = 0; i < 64; i++) {
        ck_assert_int_eq(cm1e_sdo_state(&sdos[i]), CM1E_SDO_ERROR);
        ck_assert_int_eq(sdos[i].error, CM1E_ERROR_CANCELLED);
    }
    ck_assert_int_eq(cm1e_sdo_submit(bus, &sdos[0]), CM1E_ERROR_STATE);
    ck_assert_int_eq(cm1e_sdo_state(&sdos[0]), CM1E_SDO_ERROR);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(blocking_transfer_in_operation_keeps_the_cycle_going)
{
    sim_config(2);
    cm1e_bus_t *bus = start_bus();
    const uint64_t before = cm1e_bus_counters(bus)->cycles;
    for (int n = 0; n < 200; n++) {
        uint8_t data[64];
        size_t size = sizeof data;
        ck_assert_int_eq(cm1e_sdo_read(bus, 1u + (unsigned)n % 2, 0x1008, 0, data, &size, &diag), CM1E_OK);
    }
    ck_assert_uint_gt(cm1e_bus_counters(bus)->cycles, before + 200);
    ck_assert_uint_eq(cm1e_bus_counters(bus)->working_counter_errors, 0);
    cycles(bus, 50);
    ck_assert_uint_eq(cm1e_bus_slave_watch(bus, 1).al_state, CM1E_AL_OP);
    cm1e_bus_close(bus);
}
END_TEST

typedef struct other_thread {
    cm1e_bus_t *bus;
    int done;
    unsigned good, refused;
} other_thread_t;

static void *submit_many(void *context)
{
    other_thread_t *other = context;
    for (int n = 0; n < 300; n++) {
        uint8_t data[2][4];
        cm1e_sdo_t sdos[2];
        for (int i = 0; i < 2; i++) {
            sdos[i] = (cm1e_sdo_t){.position = (uint16_t)(1 + i), .index = 0x1018, .subindex = 2, .data = data[i],
                                   .size = 4};
            if (cm1e_sdo_submit(other->bus, &sdos[i]) != CM1E_OK)
                other->refused++;
        }
        for (int i = 0; i < 2; i++) {
            while (cm1e_sdo_state(&sdos[i]) == CM1E_SDO_BUSY)
                sched_yield();
            other->good += cm1e_sdo_state(&sdos[i]) == CM1E_SDO_DONE && cm1e_get_u32(data[i]) == CM1E_PRODUCT_CODE;
        }
    }
    __atomic_store_n(&other->done, 1, __ATOMIC_RELEASE);
    return NULL;
}

START_TEST(another_thread_submits_while_the_cycle_runs)
{
    sim_config(2);
    other_thread_t other = {.bus = start_bus()};
    pthread_t thread;
    ck_assert_int_eq(pthread_create(&thread, NULL, submit_many, &other), 0);
    while (!__atomic_load_n(&other.done, __ATOMIC_ACQUIRE))
        ck_assert_int_eq(cycle(other.bus), CM1E_OK);
    pthread_join(thread, NULL);
    ck_assert_uint_eq(other.refused, 0);
    ck_assert_uint_eq(other.good, 600);
    cm1e_bus_close(other.bus);
}
END_TEST

enum { SUBMITTERS = 3, STOPS = 2000 };

/** A thread that submits and waits for the end, until it is told to end. */
typedef struct submitter {
    cm1e_bus_t *bus;
    pthread_t thread;
    int end;
    unsigned refused; /**< because the bus was stopped; only grows */
} submitter_t;

static void *submit_until_told(void *context)
{
    submitter_t *s = context;
    uint8_t data[4];
    cm1e_sdo_t sdo = {.position = 1, .index = 0x1018, .subindex = 2, .data = data, .size = sizeof data};
    while (!__atomic_load_n(&s->end, __ATOMIC_ACQUIRE)) {
        if (cm1e_sdo_submit(s->bus, &sdo) == CM1E_ERROR_STATE) {
            __atomic_fetch_add(&s->refused, 1, __ATOMIC_RELEASE);
            sched_yield();
        }
        while (cm1e_sdo_state(&sdo) == CM1E_SDO_BUSY && !__atomic_load_n(&s->end, __ATOMIC_ACQUIRE))
            sched_yield();
    }
    return NULL;
}

/** FALSE: a submitter still waits for a transfer that nobody will end. */
static bool all_are_refused(const submitter_t *submitters)
{
    unsigned before[SUBMITTERS];
    for (int i = 0; i < SUBMITTERS; i++)
        before[i] = __atomic_load_n(&submitters[i].refused, __ATOMIC_ACQUIRE);
    const int64_t deadline_ns = cm1e_clock_now(cm1e_clock_monotonic()) + 5000000000;
    for (int i = 0; i < SUBMITTERS; i++)
        while (__atomic_load_n(&submitters[i].refused, __ATOMIC_ACQUIRE) == before[i]) {
            if (cm1e_clock_now(cm1e_clock_monotonic()) > deadline_ns)
                return false;
            sched_yield();
        }
    return true;
}

/** What cm1e_bus_stop() does to the queue, many times, without the time that a start takes. */
START_TEST(transfer_submitted_while_the_bus_stops_ends)
{
    sim_config(1);
    cm1e_bus_t *bus = start_bus();
    submitter_t submitters[SUBMITTERS];
    for (int i = 0; i < SUBMITTERS; i++) {
        submitters[i] = (submitter_t){.bus = bus};
        ck_assert_int_eq(pthread_create(&submitters[i].thread, NULL, submit_until_told, &submitters[i]), 0);
    }
    bool ended = true;
    for (int n = 0; n < STOPS && ended; n++) {
        cm1e_bus_set_phase(bus, BUS_SCANNED);
        while (__atomic_load_n(&bus->queue.waiting, __ATOMIC_ACQUIRE) < 1u + (unsigned)n % SUBMITTERS)
            ; /* without a yield: they shall be at it when the bus stops */
        cm1e_bus_set_phase(bus, BUS_OPEN);
        cm1e_sdo_queue_cancel(bus, CM1E_ERROR_CANCELLED);
        ended = all_are_refused(submitters);
    }
    for (int i = 0; i < SUBMITTERS; i++)
        __atomic_store_n(&submitters[i].end, 1, __ATOMIC_RELEASE);
    for (int i = 0; i < SUBMITTERS; i++)
        pthread_join(submitters[i].thread, NULL);
    ck_assert_msg(ended, "a transfer is busy for ever");
    cm1e_sdo_queue_cancel(bus, CM1E_ERROR_CANCELLED);
    ck_assert_uint_eq(bus->queue.waiting, 0); /* no place is lost */
    cm1e_bus_close(bus);
}
END_TEST

/* Single steps by a flag of the processor. ThreadSanitizer would be stopped within its own locks. */
#if defined(__x86_64__) && !defined(__SANITIZE_THREAD__)
#define HAS_STEPS

/** A thread that is stopped within cm1e_sdo_submit(), behind its instruction number `at`: what others do meanwhile, and
 *  what the bus does, is done there by the handler of the trap. */
static struct {
    cm1e_bus_t *bus;
    long at, step;
    volatile bool over;                 /**< the function has returned before */
    bool stopped, bus_stops, finished;
    cm1e_sdo_t other;
} still;

enum { FLAG_SINGLE_STEP = 0x100 };

static void begin_steps(int number, siginfo_t *info, void *context)
{
    (void)number, (void)info;
    ((ucontext_t *)context)->uc_mcontext.gregs[REG_EFL] |= FLAG_SINGLE_STEP;
}

static void others_go_on(void)
{
    still.stopped = true;
    if (cm1e_sdo_submit(still.bus, &still.other) != CM1E_OK)
        return;
    if (still.bus_stops) {
        cm1e_bus_set_phase(still.bus, BUS_OPEN);
        cm1e_sdo_queue_cancel(still.bus, CM1E_ERROR_CANCELLED);
    }
    for (int n = 0; n < 2000 && cm1e_sdo_state(&still.other) == CM1E_SDO_BUSY; n++)
        cycle(still.bus);
    still.finished = cm1e_sdo_state(&still.other) == (still.bus_stops ? CM1E_SDO_ERROR : CM1E_SDO_DONE);
}

static void on_step(int number, siginfo_t *info, void *context)
{
    (void)number, (void)info;
    if (!still.over && still.step++ < still.at)
        return;
    ((ucontext_t *)context)->uc_mcontext.gregs[REG_EFL] &= ~(greg_t)FLAG_SINGLE_STEP;
    if (!still.over)
        others_go_on();
}

/** At each of its instructions, so also between two of them that belong together. Returns how many there were. */
static long stop_at_each_instruction(bool bus_stops)
{
    uint8_t data[4], others_data[4];
    struct sigaction begin = {.sa_sigaction = begin_steps, .sa_flags = SA_SIGINFO};
    struct sigaction step = {.sa_sigaction = on_step, .sa_flags = SA_SIGINFO};
    sigaction(SIGUSR1, &begin, NULL);
    sigaction(SIGTRAP, &step, NULL);
    sim_config(1);
    still.bus = start_bus();
    still.bus_stops = bus_stops;
    for (still.at = 0, still.stopped = true; still.stopped; still.at++) {
        cm1e_sdo_t sdo = {.position = 1, .index = 0x1018, .subindex = 2, .data = data, .size = sizeof data};
        still.other = sdo;
        still.other.data = others_data;
        still.step = 0;
        still.stopped = still.finished = still.over = false;
        raise(SIGUSR1);
        const cm1e_error_t error = cm1e_sdo_submit(still.bus, &sdo);
        still.over = true;
        ck_assert_msg(!still.stopped || still.finished, "instruction %ld holds back a transfer behind it", still.at);
        if (bus_stops && still.stopped) {
            ck_assert_msg(cm1e_sdo_state(&sdo) == CM1E_SDO_ERROR, "busy for ever at instruction %ld", still.at);
            cm1e_bus_set_phase(still.bus, BUS_OPERATING);
            cm1e_sdo_queue_cancel(still.bus, CM1E_ERROR_CANCELLED);
        } else {
            ck_assert_int_eq(error, CM1E_OK);
            finish_sdo(still.bus, &sdo);
            ck_assert_int_eq(cm1e_sdo_state(&sdo), CM1E_SDO_DONE);
        }
        ck_assert_uint_eq(still.bus->queue.waiting, 0); /* no place is lost */
    }
    cm1e_bus_close(still.bus);
    return still.at;
}

START_TEST(thread_that_stands_still_in_a_submit_holds_back_nobody)
{
    ck_assert_int_gt(stop_at_each_instruction(false), 50);
}
END_TEST

START_TEST(thread_that_stands_still_in_a_submit_while_the_bus_stops_leaves_nothing_busy)
{
    ck_assert_int_gt(stop_at_each_instruction(true), 50);
}
END_TEST

#endif

START_TEST(order_of_transfers_is_that_of_their_submits_round_after_round)
{
    enum { EACH = 5 };
    sim_config(1);
    cm1e_bus_t *bus = start_bus();
    uint8_t data[EACH][4];
    for (int round = 0; round < 100; round++) {
        cm1e_sdo_t sdos[EACH];
        for (int i = 0; i < EACH; i++) {
            sdos[i] = (cm1e_sdo_t){.position = 1, .index = 0x1018, .subindex = 2, .data = data[i], .size = 4};
            ck_assert_int_eq(cm1e_sdo_submit(bus, &sdos[i]), CM1E_OK);
        }
        for (int i = 0; i < EACH; i++) {
            finish_sdo(bus, &sdos[i]);
            ck_assert_int_eq(cm1e_sdo_state(&sdos[i]), CM1E_SDO_DONE);
            for (int later = i + 1; later < EACH; later++)
                ck_assert_int_eq(cm1e_sdo_state(&sdos[later]), CM1E_SDO_BUSY);
        }
    }
    ck_assert_uint_eq(bus->queue.waiting, 0);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(texts_exist_for_every_code)
{
    static const uint32_t aborts[] = {
        0x05030000, 0x05040000, 0x05040001, 0x05040005, 0x06010000, 0x06010001, 0x06010002, 0x06010004, 0x06020000,
        0x06040041, 0x06070010, 0x06070012, 0x06070013, 0x06090011, 0x06090030, 0x06090031, 0x06090032, 0x08000000,
        0x08000021, 0x08000022,
    };
    static const uint16_t states[] = {0x11, 0x12, 0x13, 0x15, 0x16, 0x17, 0x18, 0x19, 0x1A, 0x1B, 0x1D, 0x1E, 0x1F};
    const char *unknown_abort = cm1e_sdo_abort_text(0x12345678), *unknown_state = cm1e_al_status_text(0xABCD);
    ck_assert_str_ne(unknown_abort, "");
    ck_assert_str_ne(unknown_state, "");
    for (size_t i = 0; i < sizeof aborts / sizeof aborts[0]; i++)
        ck_assert_str_ne(cm1e_sdo_abort_text(aborts[i]), unknown_abort);
    for (size_t i = 0; i < sizeof states / sizeof states[0]; i++)
        ck_assert_str_ne(cm1e_al_status_text(states[i]), unknown_state);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bus_sdo");
    TCase *tests = tcase_create("sdo");
    tcase_set_timeout(tests, 60);
    tcase_add_test(tests, every_entry_of_the_dictionary_is_read);
    tcase_add_test(tests, every_entry_is_written_or_refused_by_its_access);
    tcase_add_test(tests, abort_names_the_slave_the_object_and_the_reason);
    tcase_add_test(tests, wrong_arguments_are_refused_at_once);
    tcase_add_test(tests, a_request_that_was_refused_can_be_used_again);
    tcase_add_test(tests, complete_access_reads_what_the_single_reads_read);
    tcase_add_test(tests, transfers_ride_in_the_cycle_without_disturbing_it);
    tcase_add_test(tests, queue_takes_64_and_refuses_the_65th);
    tcase_add_test(tests, blocking_transfer_in_operation_keeps_the_cycle_going);
    tcase_add_test(tests, another_thread_submits_while_the_cycle_runs);
    tcase_add_test(tests, texts_exist_for_every_code);
    tcase_add_test(tests, transfer_submitted_while_the_bus_stops_ends);
#ifdef HAS_STEPS
    tcase_add_test(tests, thread_that_stands_still_in_a_submit_holds_back_nobody);
    tcase_add_test(tests, thread_that_stands_still_in_a_submit_while_the_bus_stops_leaves_nothing_busy);
#endif
    tcase_add_test(tests, order_of_transfers_is_that_of_their_submits_round_after_round);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
