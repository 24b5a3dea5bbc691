/**
 * The event log: what a run leaves in it, what of it survives a reset, and readers beside the writer.
 */
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>

#include "cm1e/log.h"
#include "cm1e/sim.h"
#include "machine.h"
#include "scheduler/event_log.h"

#define MS INT64_C(1000000)

static cm1e_log_event_t events[CM1E_LOG_EVENTS + 8];

/* ---- a run ------------------------------------------------------------------------------------------------------ */

typedef struct program {
    machine_t *machine;
    MC_Power_t power;
    MC_MoveAbsolute_t move;
    MC_Reset_t reset;
} program_t;

static void simulate(const program_t *p, const char *line)
{
    char answer[128];
    ck_assert_msg(cm1e_bus_simulate(p->machine->bus, line, answer, sizeof answer) == CM1E_OK, "%s: %s", line, answer);
}

/** Enables, moves, gets a fault, loses frames, resets. */
static void program(void *context)
{
    program_t *p = context;
    p->power.Axis = p->move.Axis = p->reset.Axis = &p->machine->axis[0];
    const int64_t now = cm1e_scheduler_time_ns(p->machine->scheduler);
    p->power.Enable = p->power.EnablePositive = p->power.EnableNegative = TRUE;
    MC_Power(&p->power);
    p->move.Execute = p->power.Status;
    p->move.Position = 3.0;
    p->move.Velocity = 2.0;
    MC_MoveAbsolute(&p->move);
    p->reset.Execute = now >= 1500 * MS;
    MC_Reset(&p->reset);
    if (now == 900 * MS)
        simulate(p, "over-torque 1");
    if (now == 1200 * MS)
        simulate(p, "lose 6");
    if (now == 1350 * MS)
        simulate(p, "lose 1");
    if (now == 1450 * MS)
        simulate(p, "damage 1 2");
    if (now == 1400 * MS)
        simulate(p, "emergency 1 9007 80 fe");
}

static const cm1e_log_event_t *find(size_t count, cm1e_log_kind_t kind, int code)
{
    for (size_t i = 0; i < count; i++)
        if (events[i].kind == kind && (code < -1000 || events[i].code == code))
            return &events[i];
    return NULL;
}

static void expect_text(const cm1e_scheduler_t *scheduler, const cm1e_log_event_t *event, const char *words)
{
    char text[512];
    ck_assert_msg(event != NULL, "no record for \"%s\"", words);
    cm1e_log_text(scheduler, event, text, sizeof text);
    ck_assert_msg(strstr(text, words) != NULL, "\"%s\" is not in: %s", words, text);
}

START_TEST(test_a_run_leaves_what_happened_and_a_reset_takes_nothing_away)
{
    machine_t machine = {.axis_count = 1};
    program_t p = {.machine = &machine};
    machine_open(&machine);
    machine_add(&machine, "", 0, 0, program, &p);
    machine_run(&machine, 2000 * MS);
    uint64_t lost = 77;
    const cm1e_scheduler_t *s = machine.scheduler;
    const size_t n = cm1e_log_read(s, 0, events, CM1E_LOG_EVENTS, &lost);
    ck_assert_uint_eq(lost, 0);
    for (size_t i = 0; i < n; i++) {
        char text[512];
        cm1e_log_text(s, &events[i], text, sizeof text);
        printf("%4d ms %-15s %s\n", (int)(events[i].run_ns / MS), cm1e_log_kind_name(events[i].kind), text);
        ck_assert_uint_eq(events[i].number, i + 1);
        ck_assert(text[0] && (i == 0 || events[i].run_ns >= events[i - 1].run_ns));
    }
    ck_assert(p.reset.Done && !p.reset.Error);
    ck_assert_int_eq(events[0].kind, CM1E_LOG_RUN);
    expect_text(s, &events[0], "the run began");
    expect_text(s, &events[n - 1], "the run ended");
    expect_text(s, find(n, CM1E_LOG_STATE, CM1E_AXIS_STANDSTILL), "axis1: Standstill (was Disabled)");
    expect_text(s, find(n, CM1E_LOG_COMMAND, CM1E_COMMAND_MOVE_ABSOLUTE), "MC_MoveAbsolute, position 3 u, velocity 2");
    expect_text(s, find(n, CM1E_LOG_STATE, CM1E_AXIS_ERROR_STOP), "ErrorStop (was DiscreteMotion)");
    expect_text(s, find(n, CM1E_LOG_ERROR, CM1E_ERROR_DRIVE_FAULT), "Device error 0x2310");
    expect_text(s, find(n, CM1E_LOG_ERROR, CM1E_ERROR_DRIVE_FAULT), "Cure: ");
    expect_text(s, find(n, CM1E_LOG_EMERGENCY, 0x2310), "Slave 1 (\"axis1\", ");
    expect_text(s, find(n, CM1E_LOG_EMERGENCY, 0x2310), "emergency 0x2310, Continuous over current");
    expect_text(s, find(n, CM1E_LOG_EMERGENCY, 0x2310), "Error register 0x03: generic error, current.");
    expect_text(s, find(n, CM1E_LOG_EMERGENCY, 0), "no error any more");
    expect_text(s, find(n, CM1E_LOG_PORT, 2),
                "Slave 1 counts 2 damaged frames more: between this computer and slave 1 (port 0, IN).");
    expect_text(s, find(n, CM1E_LOG_EMERGENCY, 0x9007), "external error. Error register 0x80: maker's own. Data: FE");
    const cm1e_log_event_t *frames = find(n, CM1E_LOG_LOST_FRAMES, -2000);
    expect_text(s, frames, "frames were lost");
    ck_assert_int_eq(frames->run_ns / MS / 10, 120);
    /* Of a burst the first is told at once, the others with the next record of the counter. */
    const uint64_t lost_frames = cm1e_bus_counters(machine.bus)->lost_frames;
    ck_assert_uint_ge(lost_frames, 3);
    uint32_t told = 0;
    for (size_t i = 0; i < n; i++)
        if (events[i].kind == CM1E_LOG_LOST_FRAMES)
            told += (uint32_t)events[i].code;
    ck_assert_uint_eq(told, lost_frames);
    machine_close(&machine);
}
END_TEST

/* ---- a slave that sends many ------------------------------------------------------------------------------------- */

enum { FLOOD_BEGINS_MS = 500, FLOOD_MS = 3000 };
static uint64_t flooded;

static void flood(void *context)
{
    machine_t *machine = context;
    char line[40], answer[100];
    const int64_t ms = cm1e_scheduler_time_ns(machine->scheduler) / MS;
    if (ms < FLOOD_BEGINS_MS || ms >= FLOOD_BEGINS_MS + FLOOD_MS)
        return;
    snprintf(line, sizeof line, "emergency 2 %d 80", 9000 + (int)(ms - FLOOD_BEGINS_MS) % 100);
    flooded += cm1e_bus_simulate(machine->bus, line, answer, sizeof answer) == CM1E_OK;
}

/** It does not push out what others have to tell. All are counted, and the last one is told. */
START_TEST(test_a_flood_of_emergencies_of_one_slave_takes_few_records)
{
    machine_t machine = {.axis_count = 2};
    machine_open(&machine);
    machine_add(&machine, "", 0, 0, flood, &machine);
    const int64_t goes_on_ms = _i == 0 ? FLOOD_MS / 2 : FLOOD_MS + 3000; /* it ends in the flood, or behind it */
    machine_run(&machine, (FLOOD_BEGINS_MS + goes_on_ms) * MS);
    const size_t n = cm1e_log_read(machine.scheduler, 0, events, CM1E_LOG_EVENTS, NULL);
    cm1e_emergency_t newest[CM1E_EMERGENCIES];
    const size_t kept = cm1e_bus_emergencies(machine.bus, 2, 0, newest, CM1E_EMERGENCIES, NULL);
    ck_assert_uint_eq(kept, CM1E_EMERGENCIES);
    uint64_t told = 0, records = 0;
    const cm1e_log_event_t *last = NULL;
    for (size_t i = 0; i < n; i++)
        if (events[i].kind == CM1E_LOG_EMERGENCY) {
            ck_assert_uint_eq(events[i].detail & 0xFFFF, 2);
            told += 1 + (uint64_t)events[i].bound;
            records++;
            last = &events[i];
        }
    ck_assert_uint_gt(told, 100);
    ck_assert_uint_eq(told, newest[kept - 1].number);
    ck_assert_uint_le(records, 8 + FLOOD_MS / 1000 + 2);
    ck_assert_uint_ge(records, 8 + (unsigned)(goes_on_ms < FLOOD_MS ? goes_on_ms : FLOOD_MS) / 1000 - 2);
    ck_assert(last && last->code == newest[kept - 1].code);
    if (last->bound > 0.0)
        expect_text(machine.scheduler, last, " more since its last record are not shown.");
    ck_assert_uint_ge(flooded, told);
    machine_close(&machine);
}
END_TEST

enum { FLAP_MS = 100, REST_MS = 2000 };
static struct {
    int64_t count;
    cm1e_presence_t presence;
    uint64_t changes;
} flaps;

/** A loose contact, so many times. */
static void let_it_flap(void *context)
{
    machine_t *machine = context;
    char answer[100];
    const int64_t ms = cm1e_scheduler_time_ns(machine->scheduler) / MS - FLOOD_BEGINS_MS;
    if (ms >= 0 && ms < flaps.count * FLAP_MS && ms % FLAP_MS == 0)
        cm1e_bus_simulate(machine->bus, "unplug 2", answer, sizeof answer);
    if (ms >= 0 && ms % FLAP_MS == 20)
        cm1e_bus_simulate(machine->bus, "replug 2", answer, sizeof answer);
    const cm1e_presence_t now = cm1e_bus_presence(machine->bus, 2);
    flaps.changes += now != flaps.presence;
    flaps.presence = now;
}

/** All changes are told or counted in a record, also if it ends as it was told last: behind the flaps, or at the end of the
 *  run. */
START_TEST(test_a_slave_that_comes_and_goes_takes_few_records)
{
    machine_t machine = {.axis_count = 2};
    flaps.count = 200 + _i / 2;
    flaps.changes = 0;
    const int64_t flaps_ms = flaps.count * FLAP_MS;
    machine_open(&machine);
    flaps.presence = cm1e_bus_presence(machine.bus, 2);
    machine_add(&machine, "", 0, 0, let_it_flap, &machine);
    machine_run(&machine, (FLOOD_BEGINS_MS + flaps_ms + (_i % 2 ? REST_MS : 0)) * MS);
    const size_t n = cm1e_log_read(machine.scheduler, 0, events, CM1E_LOG_EVENTS, NULL);
    uint64_t told = 0, records = 0;
    const cm1e_log_event_t *last = NULL;
    for (size_t i = 0; i < n; i++)
        if (events[i].kind == CM1E_LOG_SLAVE) {
            told += 1 + (uint64_t)events[i].bound;
            records++;
            last = events[i].bound > 0.0 ? &events[i] : last;
        }
    ck_assert_uint_gt(told, 200);
    ck_assert_uint_eq(told, flaps.changes);
    ck_assert_uint_le(records, 8 + (unsigned)flaps_ms / 1000 + 2);
    ck_assert_uint_ge(records, 8 + (unsigned)flaps_ms / 1000 - 2);
    expect_text(machine.scheduler, last, last->bound == 1.0 ? " 1 more change since its last record is not shown."
                                                            : " more changes since its last record are not shown.");
    machine_close(&machine);
}
END_TEST

/* ---- whose the numbers are --------------------------------------------------------------------------------------- */

/** Loses a frame and, while no further record of the counter may follow, four more; 20 ms before the end. */
static void lose_late(void *context)
{
    const machine_t *machine = context;
    char answer[100];
    const int64_t now = cm1e_scheduler_time_ns(machine->scheduler);
    if (now == 180 * MS || now == 184 * MS)
        cm1e_bus_simulate(machine->bus, now == 180 * MS ? "lose 1" : "lose 4", answer, sizeof answer);
}

static uint32_t told_lost(const cm1e_scheduler_t *scheduler)
{
    uint32_t told = 0;
    const size_t n = cm1e_log_read(scheduler, 0, events, CM1E_LOG_EVENTS, NULL);
    for (size_t i = 0; i < n; i++)
        if (events[i].kind == CM1E_LOG_LOST_FRAMES) {
            told += (uint32_t)events[i].code;
            ck_assert_uint_eq(events[i].detail, told);
        }
    ck_assert_int_eq(events[n - 1].kind, CM1E_LOG_RUN);
    return told;
}

START_TEST(test_a_run_tells_all_that_it_lost_and_nothing_of_the_run_before)
{
    machine_t machine = {.axis_count = 1};
    cm1e_scheduler_statistics_t statistics;
    cm1e_diag_t diag = {0};
    machine_open(&machine);
    machine_add(&machine, "", 0, 0, lose_late, &machine);
    machine_run(&machine, 200 * MS);
    const uint64_t lost = cm1e_bus_counters(machine.bus)->lost_frames;
    ck_assert_uint_ge(lost, 3);
    ck_assert_uint_eq(told_lost(machine.scheduler), lost);
    cm1e_scheduler_destroy(machine.scheduler);
    ck_assert_msg(cm1e_bus_start(machine.bus, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_msg(cm1e_scheduler_create(&machine.scheduler, machine.bus, NULL, &diag) == CM1E_OK, "%s", diag.text);
    machine_run(&machine, 200 * MS);
    ck_assert_uint_eq(told_lost(machine.scheduler), 0);
    cm1e_scheduler_statistics(machine.scheduler, &statistics);
    ck_assert_uint_eq(statistics.bus.lost_frames, 0);
    ck_assert_uint_eq(statistics.bus.cycles, statistics.cycles);
    ck_assert_uint_eq(cm1e_bus_counters(machine.bus)->lost_frames, lost);
    machine_close(&machine);
}
END_TEST

/* ---- a redundant ring -------------------------------------------------------------------------------------------- */

/** A cable is broken for 300 ms; another one for a cycle only. */
static void break_cables(void *context)
{
    const machine_t *machine = context;
    cm1e_sim_segment_t *segment = cm1e_bus_segment(machine->bus);
    const int64_t now = cm1e_scheduler_time_ns(machine->scheduler);
    if (now == 500 * MS || now == 800 * MS)
        cm1e_sim_segment_cut(segment, 2, now == 500 * MS);
    if (now == 1000 * MS || now == 1001 * MS)
        cm1e_sim_segment_cut(segment, 1, now == 1000 * MS);
}

/** Records of every kind that a simulated machine does not bring by itself. Numbers of 32 bits keep all of them. */
START_TEST(test_a_record_is_a_sentence_with_its_numbers)
{
    static const struct {
        cm1e_log_event_t event;
        const char *words;
    } rows[] = {
        {{.kind = CM1E_LOG_ERROR, .axis = 0, .code = CM1E_ERROR_BUS_LOST}, "axis1: "},
        {{.kind = CM1E_LOG_ERROR, .axis = 0, .code = CM1E_ERROR_BUS_LOST, .value = 12.5, .bound = -3.25},
         ": 12.5 u, allowed are -3.25 u."},
        {{.kind = CM1E_LOG_ERROR, .axis = 0, .code = CM1E_ERROR_AXIS_SET_POINT_LIMIT, .value = 20797.5, .bound = 100},
         ": 20797.5, allowed are 100."},
        {{.kind = CM1E_LOG_ERROR, .axis = 0, .code = CM1E_ERROR_BUS_LOST, .detail = 0xEEEE},
         " Device error 0xEEEE: not a code of the manual."},
        {{.kind = CM1E_LOG_STRANGER, .axis = -1, .code = (int32_t)0x89ABCDEF, .detail = 3u << 24 | 0x0102,
          .value = 0xFEDCBA98, .bound = 65536.0 * 0xFFFE + 0xFFFD}, "258"},
        {{.kind = CM1E_LOG_STRANGER, .axis = -1, .code = (int32_t)0x89ABCDEF, .detail = 3u << 24 | 0x0102,
          .value = 0xFEDCBA98}, "0xFEDCBA98"},
        {{.kind = CM1E_LOG_STRANGER, .axis = -1, .code = (int32_t)0x89ABCDEF, .detail = 3u << 24 | 0x0102,
          .value = 0xFEDCBA98}, "0x89ABCDEF"},
        {{.kind = CM1E_LOG_RUN, .axis = -1}, "the run ended"},
        {{.kind = CM1E_LOG_COMMAND, .axis = 0, .code = CM1E_COMMAND_MOVE_ABSOLUTE, .value = -1234567.25,
          .bound = 2500000.5}, "MC_MoveAbsolute, position -1234567.25 u, velocity 2500000.5 u/s"},
        {{.kind = CM1E_LOG_RING, .axis = -1, .code = 1, .detail = 3u << 24, .value = 1, .bound = 2}, "ring was broken"},
    };
    char text[20] = "unchanged";
    machine_t machine = {.axis_count = 1};
    machine_open(&machine);
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
        expect_text(machine.scheduler, &rows[i].event, rows[i].words);
    cm1e_log_text(machine.scheduler, &rows[0].event, NULL, sizeof text);
    cm1e_log_text(machine.scheduler, &rows[0].event, text, 0);
    ck_assert_str_eq(text, "unchanged");
    cm1e_log_text(machine.scheduler, &rows[0].event, text, 7);
    ck_assert_str_eq(text, "axis1:");
    machine_close(&machine);
}
END_TEST

START_TEST(test_a_ring_that_breaks_is_told_with_its_place)
{
    static const struct {
        int ms, code;
        const char *words;
    } expected[] = {
        {502, 1, "The ring is broken between slave 1 (\"axis1\", CM1-E) and slave 2 (\"axis2\", CM1-E). All slaves"},
        {801, 0, "The ring is whole again."},
        {1002, 1, "The ring was broken for a moment, too short to see where"},
        {1002, 0, "The ring is whole again."},
    };
    machine_t machine = {.axis_count = 2, .ring = true};
    machine_open(&machine);
    machine_add(&machine, "", 0, 0, break_cables, &machine);
    machine_run(&machine, 1500 * MS);
    const size_t n = cm1e_log_read(machine.scheduler, 0, events, CM1E_LOG_EVENTS, NULL);
    size_t told = 0;
    for (size_t i = 0; i < n; i++) {
        ck_assert_int_ne(events[i].kind, CM1E_LOG_LOST_FRAMES);
        ck_assert_int_ne(events[i].kind, CM1E_LOG_WORKING_COUNTER);
        if (events[i].kind != CM1E_LOG_RING)
            continue;
        ck_assert_uint_lt(told, sizeof expected / sizeof *expected);
        ck_assert_int_eq(events[i].code, expected[told].code);
        ck_assert_int_le(labs(events[i].run_ns / MS - expected[told].ms), 2);
        expect_text(machine.scheduler, &events[i], expected[told++].words);
    }
    ck_assert_uint_eq(told, sizeof expected / sizeof *expected);
    ck_assert_str_eq(cm1e_log_kind_name(CM1E_LOG_RING), "ring");
    machine_close(&machine);
}
END_TEST

START_TEST(test_a_reader_goes_on_where_it_was)
{
    machine_t machine = {.axis_count = 1};
    program_t p = {.machine = &machine};
    machine_open(&machine);
    machine_add(&machine, "", 0, 0, program, &p);
    machine_run(&machine, 1000 * MS);
    const size_t all = cm1e_log_read(machine.scheduler, 0, events, CM1E_LOG_EVENTS, NULL);
    ck_assert_uint_gt(all, 3);
    ck_assert_uint_eq(cm1e_log_read(machine.scheduler, 0, events, 2, NULL), 2);
    ck_assert_uint_eq(cm1e_log_read(machine.scheduler, events[1].number, events, CM1E_LOG_EVENTS, NULL), all - 2);
    ck_assert_uint_eq(events[0].number, 3);
    ck_assert_uint_eq(cm1e_log_read(machine.scheduler, all, events, CM1E_LOG_EVENTS, NULL), 0);
    ck_assert_uint_eq(cm1e_log_read(machine.scheduler, all + 1000, events, CM1E_LOG_EVENTS, NULL), 0);
    ck_assert_uint_eq(cm1e_log_read(machine.scheduler, UINT64_MAX, events, CM1E_LOG_EVENTS, NULL), 0);
    machine_close(&machine);
}
END_TEST

/* ---- the ring alone --------------------------------------------------------------------------------------------- */

static void write_many(log_t *ring, uint64_t count)
{
    for (uint64_t i = 1; i <= count; i++) /* one record each: 200 ms lie between them */
        cm1e_log_look(ring, NULL, 0, i, (int64_t)i * 200 * MS);
}

START_TEST(test_a_full_ring_keeps_the_newest_and_counts_the_others)
{
    log_t ring = {0};
    uint64_t lost;
    ck_assert(cm1e_log_init(&ring, cm1e_clock_monotonic(), NULL) == CM1E_OK);
    write_many(&ring, CM1E_LOG_EVENTS + 10);
    ck_assert_uint_eq(cm1e_log_copy(&ring, 0, events, CM1E_LOG_EVENTS + 8, &lost), CM1E_LOG_EVENTS);
    ck_assert_uint_eq(lost, 10);
    ck_assert_uint_eq(events[0].number, 11);
    ck_assert_uint_eq(cm1e_log_copy(&ring, 4, events, 5, &lost), 5);
    ck_assert_uint_eq(lost, 6);
    ck_assert_uint_eq(events[4].number, 15);
    cm1e_log_free(&ring);
}
END_TEST

static log_t shared;
static atomic_bool written;

static void *write_beside(void *unused)
{
    (void)unused;
    write_many(&shared, 300000);
    atomic_store(&written, true);
    return NULL;
}

START_TEST(test_a_reader_beside_the_writer_gets_whole_records_in_a_row)
{
    pthread_t writer;
    uint64_t next = 0, seen = 0, gaps = 0;
    ck_assert(cm1e_log_init(&shared, cm1e_clock_monotonic(), NULL) == CM1E_OK);
    atomic_store(&written, false);
    ck_assert(pthread_create(&writer, NULL, write_beside, NULL) == 0);
    for (bool last = false; !last || next < 300000;) {
        last = atomic_load(&written);
        uint64_t lost;
        const size_t n = cm1e_log_copy(&shared, next, events, CM1E_LOG_EVENTS, &lost);
        for (size_t i = 0; i < n; i++) {
            ck_assert_uint_eq(events[i].number, next + lost + 1 + i);
            ck_assert_uint_eq(events[i].detail, events[i].number);
            ck_assert_int_eq(events[i].run_ns, (int64_t)events[i].number * 200 * MS);
        }
        next = n ? events[n - 1].number : next;
        seen += n;
        gaps += n ? lost : 0;
    }
    pthread_join(writer, NULL);
    ck_assert_uint_eq(seen + gaps, 300000);
    printf("%d of 300000 records seen, the others counted\n", (int)seen);
    cm1e_log_free(&shared);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("log");
    TCase *tcase = tcase_create("log");
    tcase_add_test(tcase, test_a_run_leaves_what_happened_and_a_reset_takes_nothing_away);
    tcase_add_loop_test(tcase, test_a_flood_of_emergencies_of_one_slave_takes_few_records, 0, 2);
    tcase_add_loop_test(tcase, test_a_slave_that_comes_and_goes_takes_few_records, 0, 24);
    tcase_add_test(tcase, test_a_run_tells_all_that_it_lost_and_nothing_of_the_run_before);
    tcase_add_test(tcase, test_a_record_is_a_sentence_with_its_numbers);
    tcase_add_test(tcase, test_a_ring_that_breaks_is_told_with_its_place);
    tcase_add_test(tcase, test_a_reader_goes_on_where_it_was);
    tcase_add_test(tcase, test_a_full_ring_keeps_the_newest_and_counts_the_others);
    tcase_add_test(tcase, test_a_reader_beside_the_writer_gets_whole_records_in_a_row);
    suite_add_tcase(suite, tcase);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
