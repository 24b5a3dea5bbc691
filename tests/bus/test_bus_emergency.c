/* Emergencies: they are taken from the mailboxes while the cycle runs, kept for each slave, and told in words. */
#include <pthread.h>
#include <stdatomic.h>

#include "bus/bus_internal.h"
#include "bus/emergency_ring.h"
#include "bus_support.h"
#include "core/bytes.h"

static cm1e_emergency_t all[CM1E_EMERGENCIES];

static size_t emergencies_of(const cm1e_bus_t *bus, uint16_t position)
{
    return cm1e_bus_emergencies(bus, position, 0, all, CM1E_EMERGENCIES, NULL);
}

static void expect_text(const cm1e_bus_t *bus, uint16_t position, const cm1e_emergency_t *emergency, const char *words)
{
    char text[CM1E_EMERGENCY_TEXT_BYTES];
    cm1e_emergency_text(bus, position, emergency, text, sizeof text);
    ck_assert_msg(strstr(text, words) != NULL, "\"%s\" is not in: %s", words, text);
}

START_TEST(an_emergency_arrives_without_any_transfer)
{
    sim_config(2);
    cm1e_bus_t *bus = start_bus();
    cycles(bus, 20);
    ck_assert_uint_eq(emergencies_of(bus, 1), 0);
    simulate(bus, "emergency 2 8611 21 7f");
    const int64_t sent_ns = now_of(bus);
    cycles(bus, 2 * 5 + 5);
    ck_assert_uint_eq(emergencies_of(bus, 1), 0);
    ck_assert_uint_eq(emergencies_of(bus, 2), 1);
    ck_assert_uint_eq(all[0].number, 1);
    ck_assert_uint_eq(all[0].code, 0x8611);
    ck_assert_uint_eq(all[0].error_register, 0x21);
    ck_assert_uint_eq(all[0].data[0], 0x7F);
    ck_assert(all[0].time_ns >= sent_ns && all[0].time_ns <= now_of(bus));
    ck_assert_uint_eq(bus->counters.lost_frames + bus->counters.mailbox_retries, 0);
    cm1e_bus_close(bus);
}
END_TEST

/** A device has its own text for a code; another slave gets that of the standard; an unknown code that of its class. */
START_TEST(texts_are_those_of_the_device_or_of_the_class)
{
    sim_config(1);
    cm1e_bus_t *bus = start_bus();
    expect_text(bus, 1, &(cm1e_emergency_t){.code = 0xFF05, .error_register = 0x81},
                cm1e_device_error(0xFF05)->text);
    expect_text(bus, 1, &(cm1e_emergency_t){.code = 0xFF05, .error_register = 0x81}, "0x81: generic error, maker's own");
    expect_text(bus, 1, &(cm1e_emergency_t){.code = 0x3299}, "0x3299, voltage inside the device. Error register 0x00.");
    expect_text(bus, 1, &(cm1e_emergency_t){.code = 0x3999}, "0x3999, voltage.");
    expect_text(bus, 1, &(cm1e_emergency_t){.code = 0x3220}, "DC link under voltage");
    expect_text(bus, 1, &(cm1e_emergency_t){.code = 0xA001}, "from Safe-Operational to Operational failed");
    expect_text(bus, 1, &(cm1e_emergency_t){.code = 0xB000}, "no standard has");
    expect_text(bus, 1, &(cm1e_emergency_t){.code = 0, .data = {1, 0, 0xAB}}, "no error any more. Data: 01 00 AB 00 00");
    expect_text(bus, 1, &(cm1e_emergency_t){.code = 0x2310}, "Cure: ");
    cm1e_bus_close(bus);
}
END_TEST

/** A new scan may have found fewer slaves than the one that an emergency came from. */
START_TEST(a_sentence_names_the_slave_or_says_that_it_is_gone)
{
    char text[CM1E_EMERGENCY_TEXT_BYTES] = "unchanged";
    const cm1e_emergency_t emergency = {.code = 0x3999};
    sim_config(1);
    cm1e_bus_t *bus = start_bus();
    cm1e_emergency_text(bus, 1, &emergency, text, 0);
    ck_assert_str_eq(text, "unchanged");
    cm1e_emergency_text(bus, 1, &emergency, NULL, sizeof text);
    cm1e_emergency_text(bus, 1, &emergency, text, 10);
    ck_assert_str_eq(text, "emergency");
    cm1e_emergency_sentence(bus, 1, &emergency, text, sizeof text);
    ck_assert_msg(strstr(text, "lave 1") && strstr(text, ": emergency 0x3999, voltage."), "%s", text);
    cm1e_emergency_sentence(bus, 2, &emergency, text, sizeof text);
    ck_assert_str_eq(text, "A slave that is gone: emergency 0x3999, voltage. Error register 0x00.");
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(an_error_of_a_drive_arrives_once)
{
    sim_config(1);
    cm1e_bus_t *bus = start_bus();
    simulate(bus, "error 1 2310");
    cycles(bus, 20);
    ck_assert_uint_eq(emergencies_of(bus, 1), 1);
    ck_assert_uint_eq(all[0].code, 0x2310);
    cycles(bus, 100);
    ck_assert_uint_eq(emergencies_of(bus, 1), 1);
    cm1e_bus_close(bus);
}
END_TEST

/** More than are kept: the oldest are gone and counted; a reader goes on where it was. */
START_TEST(the_last_ones_are_kept)
{
    sim_config(1);
    cm1e_bus_t *bus = start_bus();
    for (unsigned i = 0; i < CM1E_EMERGENCIES + 5; i++) {
        char line[40];
        snprintf(line, sizeof line, "emergency 1 %x", 0x1000 + i);
        simulate(bus, line);
        cycles(bus, 10);
    }
    uint64_t lost = 0;
    ck_assert_uint_eq(cm1e_bus_emergencies(bus, 1, 0, all, CM1E_EMERGENCIES, &lost), CM1E_EMERGENCIES);
    ck_assert_uint_eq(lost, 5);
    for (unsigned i = 0; i < CM1E_EMERGENCIES; i++) {
        ck_assert_uint_eq(all[i].number, i + 6);
        ck_assert_uint_eq(all[i].code, 0x1005 + i);
    }
    ck_assert_uint_eq(cm1e_bus_emergencies(bus, 1, all[0].number, all, 3, &lost), 3);
    ck_assert_uint_eq(all[0].number, 7);
    ck_assert_uint_eq(lost, 0);
    ck_assert_uint_eq(cm1e_bus_emergencies(bus, 1, CM1E_EMERGENCIES + 5, all, 3, &lost), 0);
    lost = 7;
    ck_assert_uint_eq(cm1e_bus_emergencies(bus, 9, 0, all, 3, &lost), 0);
    ck_assert_uint_eq(lost, 0);
    ck_assert_uint_eq(cm1e_bus_emergencies(bus, 9, 0, all, 3, NULL), 0);
    cm1e_bus_close(bus);
}
END_TEST

/** Emergencies and SDO transfers share the mailbox: nothing is lost, and every transfer has its own answer. */
START_TEST(transfers_and_emergencies_do_not_disturb_each_other)
{
    sim_config(1);
    cm1e_bus_t *bus = start_bus();
    unsigned sent = 0;
    for (unsigned i = 0; i < 200; i++) {
        uint8_t data[4] = {0};
        cm1e_sdo_t sdo = {.position = 1, .index = 0x1018, .subindex = 1, .data = data, .size = sizeof data};
        if (i % 3 == 0) {
            simulate(bus, "emergency 1 1000");
            sent++;
        }
        if (i % 7 == 0)
            simulate(bus, "lose 1");
        ck_assert_int_eq(cm1e_sdo_submit(bus, &sdo), CM1E_OK);
        finish_sdo(bus, &sdo);
        ck_assert_int_eq(cm1e_sdo_state(&sdo), CM1E_SDO_DONE);
        ck_assert_uint_eq(cm1e_get_u32(data), cm1e_bus_slave(bus, 1)->vendor_id);
        cycles(bus, i % 5);
    }
    cycles(bus, 50);
    emergencies_of(bus, 1);
    ck_assert_uint_eq(cm1e_history_last(bus->slaves[0].emergencies), sent);
    cm1e_bus_close(bus);
}
END_TEST

/** A slave that has a new message every eight cycles keeps no transfer waiting. */
START_TEST(a_flood_keeps_no_transfer_waiting)
{
    sim_config(1);
    cm1e_bus_t *bus = start_bus();
    uint8_t data[4];
    cm1e_sdo_t sdo = {.position = 1, .index = 0x1018, .subindex = 1, .data = data, .size = sizeof data};
    for (unsigned i = 0; i < 100; i++) {
        char answer[100];
        cm1e_bus_simulate(bus, "emergency 1 1000", answer, sizeof answer); /* refused where eight wait */
        cycles(bus, 1);
    }
    ck_assert_int_eq(cm1e_sdo_submit(bus, &sdo), CM1E_OK);
    unsigned n = 0;
    for (; n < 200 && cm1e_sdo_state(&sdo) == CM1E_SDO_BUSY; n++) {
        char answer[100];
        if (n % 8 == 0)
            cm1e_bus_simulate(bus, "emergency 1 1000", answer, sizeof answer);
        cycles(bus, 1);
    }
    ck_assert_int_eq(cm1e_sdo_state(&sdo), CM1E_SDO_DONE);
    ck_assert_uint_lt(n, 100);
    cm1e_bus_close(bus);
}
END_TEST

/** Messages of a slave that is brought back, which its recovery fetches with the answers to its own questions: each is
 *  kept once, when it comes. */
START_TEST(those_of_a_slave_that_is_brought_back_are_kept_once_each)
{
    sim_config(1);
    cm1e_bus_t *bus = start_bus();
    char line[40], answer[100];
    unsigned sent = 0, n = 0;
    simulate(bus, "power-cycle 1 200");
    while (!cm1e_bus_slave_watch(bus, 1).lost)
        cycle(bus);
    cm1e_bus_request_recovery(bus, 1);
    for (; cm1e_bus_slave_watch(bus, 1).al_state != CM1E_AL_OP && n < 20000; n++) {
        snprintf(line, sizeof line, "emergency 1 %x", 0x1001 + sent);
        if (sent < 3 && cm1e_bus_simulate(bus, line, answer, sizeof answer) == CM1E_OK)
            sent++;
        cycle(bus);
    }
    ck_assert_uint_lt(n, 20000);
    ck_assert_uint_eq(emergencies_of(bus, 1), 3);
    cycles(bus, 20);
    simulate(bus, "emergency 1 1004");
    cycles(bus, 200);
    ck_assert_uint_eq(emergencies_of(bus, 1), 4);
    for (unsigned i = 0; i < 4; i++)
        ck_assert_uint_eq(all[i].code, 0x1001 + i);
    ck_assert_uint_eq(cm1e_bus_emergency_count(bus), 4);
    cm1e_bus_close(bus);
}
END_TEST

/** A slave without CoE, and one that is away, are not asked; the others still are. */
START_TEST(slaves_without_a_mailbox_are_passed_over)
{
    sim_config(2);
    config.axes[1].address = 3; /* in the gap is an I/O module */
    cm1e_bus_t *bus = start_bus();
    char answer[200];
    ck_assert_int_eq(cm1e_bus_simulate(bus, "emergency 2 1000", answer, sizeof answer), CM1E_ERROR_INVALID_ARGUMENT);
    simulate(bus, "emergency 3 1000");
    cycles(bus, 20);
    ck_assert_uint_eq(emergencies_of(bus, 3), 1);
    ck_assert_uint_eq(emergencies_of(bus, 2), 0);
    cm1e_bus_close(bus);
}
END_TEST

/* ---- looks on the wire ------------------------------------------------------------------------------------------ */

enum { LRW = 12, COMMAND_AT = 16 };

/** Frames as they are sent, and one that is lost. */
typedef struct wire {
    unsigned frames, looks, alone; /**< sent; looks into mailboxes; looks without process data */
    unsigned of[4];                /**< looks by slave */
    cm1e_tap_direction_t direction;
    int lose;                      /**< this frame from now on; negative: none */
    bool lost_process_data, no_process_data; /**< none come back */
} wire_t;

static void note_look(wire_t *wire, const cm1e_tap_frame_t *frame)
{
    uint16_t station;
    wire->frames++;
    if (find_read(frame, REG_SM1, &station) < 0)
        return;
    wire->looks++;
    wire->alone += frame->bytes[COMMAND_AT] != LRW;
    wire->of[station & 3]++;
}

static cm1e_tap_verdict_t watch_wire(void *context, cm1e_tap_frame_t *frame)
{
    wire_t *wire = context;
    if (frame->direction == CM1E_TAP_SENT)
        note_look(wire, frame);
    if (wire->no_process_data && frame->direction == CM1E_TAP_RECEIVED && frame->bytes[COMMAND_AT] == LRW)
        return CM1E_TAP_DROP;
    if (frame->direction != wire->direction || wire->lose < 0 || wire->lose-- > 0)
        return CM1E_TAP_PASS;
    wire->lost_process_data = frame->bytes[COMMAND_AT] == LRW;
    return CM1E_TAP_DROP;
}

/** Every slave has its look in its turn, and while no message waits there is one frame in a cycle. */
START_TEST(looks_ride_with_the_process_data)
{
    sim_config(3);
    cm1e_bus_t *bus = start_bus();
    wire_t wire = {.lose = -1};
    cycles(bus, 50);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), watch_wire, &wire);
    cycles(bus, 60);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), NULL, NULL);
    ck_assert_uint_eq(wire.frames, 60);
    ck_assert_uint_eq(wire.looks, 12);
    for (int slave = 1; slave <= 3; slave++)
        ck_assert_uint_eq(wire.of[slave], 4);
    cm1e_bus_close(bus);
}
END_TEST

/** 43 motors leave 20 bytes of the frame: room for an AL status, but not for a look, which has a frame of its own, and
 *  hears. Every 20 ms it is the other way round, because port counters have no room either. */
START_TEST(a_look_without_room_has_a_frame_of_its_own)
{
    sim_config(43);
    cm1e_bus_t *bus = start_bus();
    wire_t wire = {.lose = -1};
    cycles(bus, 50);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), watch_wire, &wire);
    cycles(bus, 50);
    ck_assert_uint_eq(wire.looks, 10);
    ck_assert_uint_ge(wire.alone, 7);
    ck_assert_uint_eq(wire.frames, 50 + 10);
    simulate(bus, "emergency 40 1000");
    cycles(bus, 43 * 5 + 5);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), NULL, NULL);
    ck_assert_uint_eq(emergencies_of(bus, 40), 1);
    cm1e_bus_close(bus);
}
END_TEST

/** Cycles from an emergency until it is known. */
static unsigned cycles_until_heard(cm1e_bus_t *bus, uint16_t position)
{
    char line[40];
    const uint64_t before = cm1e_history_last(bus->slaves[position - 1].emergencies);
    unsigned n = 0;
    snprintf(line, sizeof line, "emergency %u 1000", (unsigned)position);
    simulate(bus, line);
    for (; n < 100 && cm1e_history_last(bus->slaves[position - 1].emergencies) == before; n++)
        cycle(bus);
    return n;
}

/** Looks ride whatever the process data are: with places of their own, overlapped, with the clocks behind them, and in a
 *  ring, whole or cut. Each slave is heard, and no working counter is wrong. */
START_TEST(looks_ride_in_every_kind_of_frame)
{
    enum { SEPARATE, OVERLAPPED, CLOCKS, RING, CUT_RING };
    sim_config(3);
    config.overlap = _i == OVERLAPPED;
    config.distributed_clocks = _i == CLOCKS;
    if (_i >= RING)
        strcpy(config.second_interface, "sim-second");
    cm1e_bus_t *bus = start_bus();
    wire_t wire = {.lose = -1};
    cycles(bus, 50);
    cm1e_sim_segment_cut(segment_of(bus), 2, _i == CUT_RING);
    for (int n = 0; n < 50; n++) /* the cut is learned */
        cycle(bus);
    const cm1e_bus_counters_t before = bus->counters;
    cm1e_nic_set_tap(cm1e_bus_nic(bus), watch_wire, &wire);
    cycles(bus, 3 * 5);
    ck_assert_uint_ge(wire.looks, 3);
    ck_assert_uint_eq(wire.alone, 0);
    for (uint16_t position = 1; position <= 3; position++) {
        ck_assert_uint_le(cycles_until_heard(bus, position), 3 * 5 + 2);
        cycles(bus, 10);
    }
    cm1e_nic_set_tap(cm1e_bus_nic(bus), NULL, NULL);
    ck_assert_uint_eq(bus->counters.lost_frames - before.lost_frames, 0);
    ck_assert_uint_eq(bus->counters.working_counter_errors - before.working_counter_errors, 0);
    ck_assert_uint_eq(cm1e_bus_emergency_count(bus), 3);
    cm1e_bus_close(bus);
}
END_TEST

/** Whichever frame is lost on its way out or back, every message is heard once. Lost process data cost two cycles, also
 *  where the look was among them; the lost frame of a message costs 2 ms and the request to repeat it. */
START_TEST(a_lost_frame_neither_loses_nor_delays_a_message)
{
    enum { SLAVES = 3, ROUND = SLAVES * 5, FETCH = 2, REPEATED = 6 };
    sim_config(SLAVES);
    cm1e_bus_t *bus = start_bus();
    wire_t wire = {.direction = _i ? CM1E_TAP_RECEIVED : CM1E_TAP_SENT, .lose = -1};
    unsigned messages = 0;
    cycles(bus, 50);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), watch_wire, &wire);
    for (int lose = -1; lose < 24; lose++)
        for (uint16_t position = 1; position <= SLAVES; position++) {
            wire.lose = lose;
            wire.lost_process_data = false;
            const unsigned took = cycles_until_heard(bus, position);
            const bool lost = lose >= 0 && wire.lose < 0;
            const unsigned more = !lost ? 0 : wire.lost_process_data ? 2 : REPEATED;
            ck_assert_msg(took <= ROUND + FETCH + more, "slave %u, frame %d lost: heard after %u cycles", position,
                          lose, took);
            messages++;
            wire.lose = -1;
            for (int n = 0; n < 20; n++)
                cycle(bus);
        }
    cm1e_nic_set_tap(cm1e_bus_nic(bus), NULL, NULL);
    ck_assert_uint_eq(cm1e_bus_emergency_count(bus), messages);
    cm1e_bus_close(bus);
}
END_TEST

/** While no process data come back, the looks have frames of their own, and hear. */
START_TEST(messages_are_heard_without_process_data)
{
    sim_config(2);
    cm1e_bus_t *bus = start_bus();
    wire_t wire = {.lose = -1, .no_process_data = true};
    cycles(bus, 50);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), watch_wire, &wire);
    for (uint16_t position = 1; position <= 2; position++)
        ck_assert_uint_le(cycles_until_heard(bus, position), 2 * 5 + 5);
    ck_assert_int_eq(cm1e_bus_health(bus), CM1E_ERROR_BUS_LOST);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), NULL, NULL);
    cm1e_bus_close(bus);
}
END_TEST

/** The looks of the others go on in their turn while a slave is away, and it is heard again when it is back. */
START_TEST(a_slave_that_disappears_delays_no_other)
{
    enum { ROUND = 3 * 5, FETCH = 2 };
    sim_config(3);
    cm1e_bus_t *bus = start_bus();
    cycles(bus, 50);
    simulate(bus, "power 3 off");
    for (int n = 0; n < 40; n++) {
        const uint16_t position = (uint16_t)(1 + n % 2);
        const unsigned took = cycles_until_heard(bus, position);
        ck_assert_msg(took <= ROUND + FETCH, "slave %u heard after %u cycles", position, took);
    }
    simulate(bus, "power 3 on");
    for (int n = 0; n < 4000 && cm1e_bus_slave_watch(bus, 3).al_state != CM1E_AL_OP; n++) {
        cm1e_bus_request_recovery(bus, 3);
        cycle(bus);
    }
    ck_assert_uint_le(cycles_until_heard(bus, 3), ROUND + FETCH);
    cm1e_bus_close(bus);
}
END_TEST

/* ---- a reader beside the writer --------------------------------------------------------------------------------- */

static cm1e_emergency_ring_t ring;
static _Atomic bool ready;

static void *write_many(void *context)
{
    (void)context;
    for (uint32_t i = 1; i <= 200000; i++) {
        cm1e_emergency_t one = {.time_ns = i, .code = (uint16_t)i, .error_register = (uint8_t)i};
        memset(one.data, (uint8_t)i, sizeof one.data);
        cm1e_history_add(ring, CM1E_EMERGENCY_SHAPE, &one);
    }
    ready = true;
    return NULL;
}

START_TEST(a_reader_in_another_thread_sees_whole_emergencies_in_order)
{
    pthread_t thread;
    uint64_t after = 0;
    memset(&ring, 0, sizeof ring);
    ready = false;
    ck_assert_int_eq(pthread_create(&thread, NULL, write_many, NULL), 0);
    for (bool last = false; !last;) {
        cm1e_emergency_t got[CM1E_EMERGENCIES];
        uint64_t lost = 0;
        last = ready;
        const size_t count = cm1e_history_copy(ring, CM1E_EMERGENCY_SHAPE, after, got, CM1E_EMERGENCIES, &lost);
        for (size_t i = 0; i < count; i++) {
            ck_assert_uint_eq(got[i].number, after + lost + 1 + i);
            ck_assert_int_eq(got[i].time_ns, (int64_t)got[i].number);
            ck_assert_uint_eq(got[i].code, (uint16_t)got[i].number);
            ck_assert_uint_eq(got[i].data[4], (uint8_t)got[i].number);
        }
        after = count ? got[count - 1].number : after;
    }
    pthread_join(thread, NULL);
    ck_assert_uint_eq(after, 200000);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("emergencies");
    TCase *tests = tcase_create("emergencies");
    tcase_set_timeout(tests, 60);
    tcase_add_test(tests, an_emergency_arrives_without_any_transfer);
    tcase_add_test(tests, texts_are_those_of_the_device_or_of_the_class);
    tcase_add_test(tests, a_sentence_names_the_slave_or_says_that_it_is_gone);
    tcase_add_test(tests, an_error_of_a_drive_arrives_once);
    tcase_add_test(tests, the_last_ones_are_kept);
    tcase_add_test(tests, transfers_and_emergencies_do_not_disturb_each_other);
    tcase_add_test(tests, a_flood_keeps_no_transfer_waiting);
    tcase_add_test(tests, those_of_a_slave_that_is_brought_back_are_kept_once_each);
    tcase_add_test(tests, slaves_without_a_mailbox_are_passed_over);
    tcase_add_test(tests, looks_ride_with_the_process_data);
    tcase_add_loop_test(tests, looks_ride_in_every_kind_of_frame, 0, 5);
    tcase_add_test(tests, a_look_without_room_has_a_frame_of_its_own);
    tcase_add_loop_test(tests, a_lost_frame_neither_loses_nor_delays_a_message, 0, 2);
    tcase_add_test(tests, messages_are_heard_without_process_data);
    tcase_add_test(tests, a_slave_that_disappears_delays_no_other);
    tcase_add_test(tests, a_reader_in_another_thread_sees_whole_emergencies_in_order);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
