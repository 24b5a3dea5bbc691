/* Files of a slave: every size around a packet, busy, lost frames, refusals, and a mailbox that is shared with SDO. */
#include "cm1e/foe.h" /* before the global `diag` of the tests */

#include "bus/bus_internal.h"
#include "bus/firmware_update.h"
#include "bus_support.h"
#include "cm1e/emergency.h"
#include "core/bytes.h"
#include "sim/cia402_app.h"

enum { FILE_MAX = CM1E_SIM_FILE_BYTES };
static uint8_t written[FILE_MAX + 1], got[FILE_MAX + 1];

/** A bus with a drive that keeps files, in Pre-Operational. */
static cm1e_bus_t *scanned(void)
{
    sim_config(1);
    strcpy(config.axes[0].device, "cia402");
    config.axes[0].firmware[0] = 0;
    config.axes[0].counts_per_revolution = 10000;
    config.axes[0].max_speed_rpm = 3000;
    cm1e_bus_t *bus = open_bus();
    ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK, "%s", diag.text);
    for (size_t i = 0; i < sizeof written; i++)
        written[i] = (uint8_t)(i * 7 + i / 251);
    return bus;
}

static cm1e_sim_files_t *files_of(cm1e_bus_t *bus)
{
    return &cm1e_sim_cia402_of(cm1e_sim_segment_slave(segment_of(bus), 1))->files;
}

/** Bytes of a file in one packet. */
static size_t packet(cm1e_bus_t *bus) { return bus->slaves[0].facts.mailbox_in_length - 12u; }

static void write_and_read(cm1e_bus_t *bus, size_t size, const cm1e_foe_options_t *options)
{
    size_t room = FILE_MAX;
    memset(got, 0xEE, sizeof got);
    ck_assert_msg(cm1e_foe_write(bus, 1, "a file.bin", written, size, options, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_uint_eq(files_of(bus)->size, size);
    ck_assert_msg(cm1e_foe_read(bus, 1, "a file.bin", got, &room, options, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_uint_eq(room, size);
    ck_assert_int_eq(memcmp(got, written, size), 0);
}

START_TEST(files_of_every_size_around_a_packet)
{
    cm1e_bus_t *bus = scanned();
    const size_t p = packet(bus), sizes[] = {0, 1, p - 1, p, p + 1, 2 * p, 5 * p - 1, 20 * p, 12345, FILE_MAX};
    const cm1e_foe_options_t no_hurry = {.answer_ns = INT64_MAX};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        write_and_read(bus, sizes[i], NULL);
    write_and_read(bus, 100, &no_hurry);
    cm1e_bus_close(bus);
}
END_TEST

/** Busy at the request, at a packet, many times: it is asked again; for longer than an answer may take: given up. */
START_TEST(a_busy_slave_is_asked_again_for_a_bounded_time)
{
    cm1e_bus_t *bus = scanned();
    const cm1e_foe_options_t short_time = {.answer_ns = 300000000};
    size_t room = FILE_MAX;
    for (unsigned busy = 1; busy < 9; busy++) {
        files_of(bus)->busy = busy;
        write_and_read(bus, 3 * packet(bus), &short_time);
    }
    ck_assert_int_eq(cm1e_foe_write(bus, 1, "a file.bin", written, 1000, NULL, &diag), CM1E_OK);
    files_of(bus)->busy = 1;
    ck_assert_msg(cm1e_foe_read(bus, 1, "a file.bin", got, &room, NULL, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_uint_eq(files_of(bus)->busy, 0);
    files_of(bus)->busy = 1000000;
    const int64_t begun_ns = now_of(bus);
    ck_assert_int_eq(cm1e_foe_read(bus, 1, "a file.bin", got, &room, &short_time, &diag), CM1E_ERROR_TIMEOUT);
    ck_assert_ptr_nonnull(strstr(diag.text, "busy, after 0 bytes"));
    ck_assert_int_lt(now_of(bus) - begun_ns, 1000000000);
    ck_assert_int_eq(cm1e_foe_write(bus, 1, "x", written, 10, &short_time, &diag), CM1E_ERROR_TIMEOUT);
    files_of(bus)->busy = 0;
    write_and_read(bus, 100, NULL);
    cm1e_bus_close(bus);
}
END_TEST

static unsigned frames[2], lost_first, lost_count;
static cm1e_tap_direction_t lost_way;

static cm1e_tap_verdict_t lose(void *context, cm1e_tap_frame_t *frame)
{
    (void)context;
    const unsigned n = ++frames[frame->direction == lost_way];
    const bool lost = frame->direction == lost_way && n >= lost_first && n < lost_first + lost_count;
    return lost ? CM1E_TAP_DROP : CM1E_TAP_PASS;
}

/** Every frame of a transfer, on either way, is lost once, and then three in a row: the file is whole. */
START_TEST(lost_frames_lose_no_byte)
{
    static const cm1e_tap_direction_t ways[] = {CM1E_TAP_SENT, CM1E_TAP_RECEIVED};
    cm1e_bus_t *bus = scanned();
    unsigned runs = 0;
    cm1e_nic_set_tap(cm1e_bus_nic(bus), lose, NULL);
    for (int way = 0; way < 2; way++)
        for (lost_count = 1; lost_count <= 3; lost_count += 2)
            for (lost_first = 1, frames[1] = UINT32_MAX; lost_first <= frames[1]; lost_first++, runs++) {
                lost_way = ways[way];
                frames[0] = frames[1] = 0;
                write_and_read(bus, packet(bus) + 20, NULL);
            }
    ck_assert_uint_gt(runs, 60);
    cm1e_bus_close(bus);
}
END_TEST

static unsigned random_state;
static unsigned next_random(unsigned below)
{
    random_state = random_state * 1103515245u + 12345u;
    return random_state / 65536u % below;
}

/** In every fifth answer of FoE a byte of its length, service, number or data is another one. */
static cm1e_tap_verdict_t lie(void *context, cm1e_tap_frame_t *frame)
{
    (void)context;
    uint8_t *message = frame->bytes + 26; /* Ethernet, EtherCAT and datagram header */
    const bool mailbox = frame->direction == CM1E_TAP_RECEIVED && frame->bytes[16] == 4 && frame->length > 100;
    static const uint8_t places[] = {0, 0, 1, 6, 6, 8, 9, 11, 12, 13};
    if (mailbox && (message[5] & 0x0F) == 4 && next_random(5) == 0)
        message[places[next_random(sizeof places)]] = (uint8_t)next_random(256);
    return CM1E_TAP_PASS;
}

/** Whatever a slave answers: the transfer ends in time, nothing is written behind the room, and the next one is right. */
START_TEST(lies_end_in_time_and_overrun_nothing)
{
    const cm1e_foe_options_t options = {.answer_ns = 100000000};
    cm1e_bus_t *bus = scanned();
    unsigned runs = 0, failed = 0;
    for (random_state = 1; runs < 400; runs++) {
        const size_t size = next_random(6) * packet(bus) + next_random(3);
        size_t room = size + next_random(40);
        const size_t end = room;
        const int64_t begun_ns = now_of(bus);
        cm1e_nic_set_tap(cm1e_bus_nic(bus), lie, NULL);
        failed += cm1e_foe_write(bus, 1, "a file.bin", written, size, &options, &diag) != CM1E_OK;
        got[end] = 0xEE;
        (void)cm1e_foe_read(bus, 1, "a file.bin", got, &room, &options, &diag);
        ck_assert_uint_eq(got[end], 0xEE);
        ck_assert_uint_le(room, end);
        ck_assert_int_lt(now_of(bus) - begun_ns, INT64_C(3000000000));
        cm1e_nic_set_tap(cm1e_bus_nic(bus), NULL, NULL);
        (void)cm1e_foe_read(bus, 1, "x", got, &room, &options, &diag); /* may meet what is left of the one before */
        write_and_read(bus, size, &options);
    }
    ck_assert(failed > 50 && failed < 350);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(refusals_have_code_and_text)
{
    cm1e_bus_t *bus = scanned();
    size_t room = FILE_MAX;
    char name[1500];
    ck_assert_int_eq(cm1e_foe_read(bus, 1, "nothing", got, &room, NULL, &diag), CM1E_ERROR_BUS_MAILBOX);
    ck_assert_uint_eq(diag.foreign_code, 0x8001);
    ck_assert_ptr_nonnull(strstr(diag.text, "FoE error 0x8001, file not found (\"no such file\")"));
    ck_assert_uint_eq(room, 0);
    ck_assert_int_eq(cm1e_foe_write(bus, 1, "large", written, FILE_MAX + 1, NULL, &diag), CM1E_ERROR_BUS_MAILBOX);
    ck_assert_uint_eq(diag.foreign_code, 0x8003);
    ck_assert_msg(strstr(diag.text, " of 65537 bytes") != NULL, "%s", diag.text);
    memset(name, 'n', sizeof name);
    name[sizeof name - 1] = 0;
    ck_assert_int_eq(cm1e_foe_write(bus, 1, name, written, 1, NULL, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(cm1e_foe_write(bus, 1, "", written, 1, NULL, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    diag.foreign_code = 1;
    ck_assert_int_eq(cm1e_foe_write(bus, 2, "n", written, 1, NULL, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_uint_eq(diag.foreign_code, 0);
    ck_assert_str_eq(cm1e_foe_error_text(0x8008), "in Bootstrap only");
    ck_assert_str_eq(cm1e_foe_error_text(7), "unknown");
    cm1e_bus_close(bus);
}
END_TEST

/** A file that is larger than the room: the slave is told, and does not wait for the rest. */
START_TEST(a_file_that_is_too_large_ends_in_both)
{
    cm1e_bus_t *bus = scanned();
    size_t room = 3 * packet(bus) - 1;
    write_and_read(bus, 3 * packet(bus), NULL);
    got[room] = 0xEE;
    ck_assert_int_eq(cm1e_foe_read(bus, 1, "a file.bin", got, &room, NULL, &diag), CM1E_ERROR_FULL);
    ck_assert_uint_eq(got[3 * packet(bus) - 1], 0xEE);
    write_and_read(bus, 10, NULL); /* the simulated slave refuses a request while another file is open, as SOES does */
    cm1e_bus_close(bus);
}
END_TEST

static unsigned calls, cancel_at;
static size_t last_done, last_size;

static bool count(void *context, size_t done, size_t size)
{
    ck_assert_ptr_eq(context, &calls);
    ck_assert_uint_ge(done, last_done);
    last_done = done;
    last_size = size;
    return ++calls != cancel_at;
}

START_TEST(progress_is_told_and_may_break_off)
{
    cm1e_bus_t *bus = scanned();
    const cm1e_foe_options_t options = {.progress = count, .context = &calls};
    const size_t size = 4 * packet(bus) + 1;
    size_t room = FILE_MAX;
    ck_assert_int_eq(cm1e_foe_write(bus, 1, "f", written, size, &options, &diag), CM1E_OK);
    ck_assert(calls == 6 && last_done == size && last_size == size);
    calls = 0, last_done = 0;
    ck_assert_int_eq(cm1e_foe_read(bus, 1, "f", got, &room, &options, &diag), CM1E_OK);
    ck_assert(calls == 5 && last_done == size && last_size == 0);
    for (cancel_at = 1; cancel_at < 5; cancel_at++) {
        calls = 0, last_done = 0, room = FILE_MAX;
        ck_assert_int_eq(cm1e_foe_read(bus, 1, "f", got, &room, &options, &diag), CM1E_ERROR_CANCELLED);
    }
    calls = 0, last_done = 0, cancel_at = 3;
    ck_assert_int_eq(cm1e_foe_write(bus, 1, "f", written, size, &options, &diag), CM1E_ERROR_CANCELLED);
    cancel_at = 0, last_done = 0;
    write_and_read(bus, size, NULL);
    cm1e_bus_close(bus);
}
END_TEST

/** SDO transfers before and after count the same mailbox; an emergency in between is kept. */
START_TEST(the_mailbox_is_shared)
{
    cm1e_bus_t *bus = scanned();
    for (unsigned i = 0; i < 20; i++) {
        uint8_t data[4];
        size_t size = sizeof data;
        ck_assert_msg(cm1e_sdo_read(bus, 1, 0x1018, 1, data, &size, &diag) == CM1E_OK, "%s", diag.text);
        simulate(bus, "emergency 1 5000");
        write_and_read(bus, 100 * i, NULL);
    }
    cm1e_emergency_t all[CM1E_EMERGENCIES];
    ck_assert_uint_eq(cm1e_bus_emergencies(bus, 1, 0, all, CM1E_EMERGENCIES, NULL), CM1E_EMERGENCIES);
    ck_assert_uint_eq(all[CM1E_EMERGENCIES - 1].number, 20);
    cm1e_bus_close(bus);
}
END_TEST

/** A CM1-E takes its firmware in Bootstrap only, and says so elsewhere. Another device has no files at all. */
START_TEST(bootstrap_and_slaves_without_files)
{
    static const char image[] = "CM1-E simulated firmware 1.3.4, 2000 bytes\n";
    const cm1e_foe_options_t in_bootstrap = {.bootstrap = true};
    size_t room = FILE_MAX;
    sim_config(2);
    config.axes[1].address = 3; /* in the gap is an I/O module */
    cm1e_bus_t *bus = open_bus();
    ck_assert_int_eq(cm1e_bus_scan(bus, &diag), CM1E_OK);
    memcpy(written, image, sizeof image);
    ck_assert_int_eq(cm1e_foe_write(bus, 1, "x.bin", written, 2000, NULL, &diag), CM1E_ERROR_BUS_MAILBOX);
    ck_assert_uint_eq(diag.foreign_code, 0x8008);
    ck_assert_int_eq(cm1e_foe_read(bus, 2, "x", got, &room, NULL, &diag), CM1E_ERROR_UNSUPPORTED);
    ck_assert_ptr_nonnull(strstr(diag.text, "announces no FoE"));
    room = FILE_MAX;
    ck_assert_int_eq(cm1e_foe_read(bus, 1, "x.bin", got, &room, &in_bootstrap, &diag), CM1E_ERROR_BUS_MAILBOX);
    ck_assert_uint_eq(diag.foreign_code, 0x8001);
    diag.foreign_code = 1;
    ck_assert_int_eq(cm1e_foe_write(bus, 1, "x.bin", written, 2000, &in_bootstrap, &diag), CM1E_ERROR_STATE);
    ck_assert_uint_eq(diag.foreign_code, 0);
    ck_assert_int_eq(cm1e_bus_scan(bus, &diag), CM1E_OK);
    ck_assert_msg(cm1e_foe_write(bus, 1, "x.bin", written, 2000, &in_bootstrap, &diag) == CM1E_OK, "%s", diag.text);
    simulate(bus, "power-cycle 1 100"); /* the simulated device starts its new firmware */
    cm1e_clock_sleep_until(bus->clock, now_of(bus) + INT64_C(1000000000));
    ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_str_eq(cm1e_bus_slave(bus, 1)->software_version, "1.3.4");
    cm1e_bus_close(bus);
}
END_TEST

static unsigned wrong_answer, answers, switched_off;

/** Answer number `wrong_answer` of FoE has a service that there is not. Counts the sync managers that are switched off. */
static cm1e_tap_verdict_t answer_wrongly(void *context, cm1e_tap_frame_t *frame)
{
    (void)context;
    uint8_t *message = frame->bytes + 26;
    const unsigned offset = cm1e_get_u16(frame->bytes + 20), bytes = cm1e_get_u16(frame->bytes + 22) & 0x7FF;
    if (frame->direction == CM1E_TAP_SENT && (offset == 0x0806 || offset == 0x080E) && bytes == 1 && message[0] == 0)
        switched_off++;
    const bool mailbox = frame->direction == CM1E_TAP_RECEIVED && frame->bytes[16] == 4 && frame->length > 100;
    if (mailbox && (message[5] & 0x0F) == 4 &&
        ++answers == wrong_answer)
        message[6] = 0x7F;
    return CM1E_TAP_PASS;
}

/** What an update that failed has left: before its first packet the old firmware, then a part of the new one. */
START_TEST(an_update_that_fails_tells_what_the_slave_has)
{
    static const char image[] = "CM1-E simulated firmware 1.3.4, 2000 bytes\n";
    static const cm1e_firmware_state_t states[] = {CM1E_FIRMWARE_WRITTEN, CM1E_FIRMWARE_UNTOUCHED,
                                                   CM1E_FIRMWARE_PARTLY, CM1E_FIRMWARE_PARTLY};
    memcpy(written, image, sizeof image);
    for (wrong_answer = 0; wrong_answer < 4; wrong_answer++) {
        sim_config(1);
        cm1e_bus_t *bus = open_bus();
        cm1e_nic_set_tap(cm1e_bus_nic(bus), answer_wrongly, NULL);
        answers = switched_off = 0;
        const cm1e_firmware_file_t file = {.name = "x.bin", .bytes = written, .size = 2000,
                                           .options = {.answer_ns = 1000000000}};
        cm1e_firmware_state_t state = CM1E_FIRMWARE_WRITTEN;
        const cm1e_error_t error = cm1e_firmware_update(bus, 1, &file, &state, &diag);
        ck_assert_msg((error == CM1E_OK) == (wrong_answer == 0), "answer %u: %s", wrong_answer, diag.text);
        ck_assert_msg(state == states[wrong_answer], "answer %u: state %d", wrong_answer, (int)state);
        ck_assert_msg(!wrong_answer || strstr(diag.text, "127"), "%s", diag.text);
        ck_assert_uint_eq(switched_off, 2); /* before they get another place */
        cm1e_bus_close(bus);
    }
}
END_TEST

/* ---- while the bus operates ------------------------------------------------------------------------------------- */

/** A drive that keeps files, and a CM1-E; both in Operational. */
static cm1e_bus_t *operating(void)
{
    sim_config(2);
    strcpy(config.axes[0].device, "cia402");
    config.axes[0].firmware[0] = 0;
    config.axes[0].counts_per_revolution = 10000;
    config.axes[0].max_speed_rpm = 3000;
    for (size_t i = 0; i < sizeof written; i++)
        written[i] = (uint8_t)(i * 7 + i / 251);
    return start_bus();
}

static void check_cycles(cm1e_bus_t *bus)
{
    ck_assert_uint_eq(cm1e_bus_counters(bus)->lost_frames, 0);
    ck_assert_uint_eq(cm1e_bus_counters(bus)->working_counter_errors, 0);
    ck_assert_int_eq(cm1e_bus_slave_watch(bus, 1).al_state, CM1E_AL_OP);
    ck_assert_int_eq(cm1e_bus_slave_watch(bus, 2).al_state, CM1E_AL_OP);
}

START_TEST(files_go_beside_the_process_data)
{
    cm1e_bus_t *bus = operating();
    const size_t p = packet(bus), sizes[] = {0, 1, p - 1, p, p + 1, 3 * p, 12345, FILE_MAX};
    const cm1e_foe_options_t options = {.progress = count, .context = &calls};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        files_of(bus)->busy = (unsigned)i;
        write_and_read(bus, sizes[i], NULL);
        check_cycles(bus);
    }
    const int64_t begun_ns = now_of(bus);
    const uint64_t cycles = cm1e_bus_counters(bus)->cycles;
    write_and_read(bus, 12345, NULL);
    const uint64_t made = cm1e_bus_counters(bus)->cycles - cycles;
    ck_assert_int_le(llabs((int64_t)made * bus->config.cycle_time_ns - (now_of(bus) - begun_ns)),
                     2 * bus->config.cycle_time_ns);
    for (cancel_at = 1; cancel_at < 5; cancel_at++) {
        calls = 0, last_done = 0;
        ck_assert_int_eq(cm1e_foe_write(bus, 1, "f", written, 4 * p, &options, &diag), CM1E_ERROR_CANCELLED);
    }
    cancel_at = 0, last_done = 0;
    write_and_read(bus, 100, NULL);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(refusals_in_operation)
{
    cm1e_bus_t *bus = operating();
    const cm1e_foe_options_t in_bootstrap = {.bootstrap = true}, short_time = {.answer_ns = 300000000};
    size_t room = 10;
    ck_assert_int_eq(cm1e_foe_write(bus, 2, "x.bin", written, 1, &in_bootstrap, &diag), CM1E_ERROR_STATE);
    ck_assert_ptr_nonnull(strstr(diag.text, "Bootstrap"));
    ck_assert_int_eq(cm1e_foe_write(bus, 2, "x.bin", written, 1, NULL, &diag), CM1E_ERROR_BUS_MAILBOX);
    ck_assert_uint_eq(diag.foreign_code, 0x8008);
    ck_assert_int_eq(cm1e_foe_write(bus, 1, "", written, 1, NULL, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(cm1e_foe_write(bus, 3, "n", written, 1, NULL, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(cm1e_foe_read(bus, 1, "nothing", got, &room, NULL, &diag), CM1E_ERROR_BUS_MAILBOX);
    ck_assert_ptr_nonnull(strstr(diag.text, "file not found (\"no such file\")"));
    ck_assert_int_eq(cm1e_foe_write(bus, 1, "a", written, 100, NULL, &diag), CM1E_OK);
    room = 10;
    ck_assert_int_eq(cm1e_foe_read(bus, 1, "a", got, &room, NULL, &diag), CM1E_ERROR_FULL);
    files_of(bus)->busy = 1000000;
    ck_assert_int_eq(cm1e_foe_write(bus, 1, "a", written, 100, &short_time, &diag), CM1E_ERROR_TIMEOUT);
    files_of(bus)->busy = 0;
    write_and_read(bus, 100, NULL);
    check_cycles(bus);
    cm1e_bus_close(bus);
}
END_TEST

/** Both get their turn: no SDO transfer waits for a whole file, and no file for an end of the SDO transfers. */
START_TEST(files_and_sdo_transfers_take_turns)
{
    cm1e_bus_t *bus = operating();
    uint8_t data[4];
    cm1e_sdo_t sdo = {0};
    cm1e_foe_t foe = {.position = 1, .writing = true, .name = "turns", .from = written, .size = 20 * packet(bus)};
    cm1e_foe_t second = foe;
    unsigned transfers = 0;
    ck_assert_int_eq(cm1e_foe_submit(bus, &foe, &diag), CM1E_OK);
    ck_assert_int_eq(cm1e_foe_submit(bus, &second, &diag), CM1E_ERROR_BUSY);
    while (!cm1e_foe_done(&foe)) {
        if (cm1e_sdo_state(&sdo) != CM1E_SDO_BUSY) {
            ck_assert_int_eq(cm1e_sdo_state(&sdo) == CM1E_SDO_ERROR, false);
            sdo = (cm1e_sdo_t){.position = 1, .index = 0x1018, .subindex = 1, .data = data, .size = sizeof data};
            ck_assert_int_eq(cm1e_sdo_submit(bus, &sdo), CM1E_OK);
            transfers++;
        }
        cm1e_bus_pump(bus);
    }
    ck_assert_msg(cm1e_foe_result_of(&foe, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_msg(transfers >= 15 && transfers <= 30, "%u transfers beside 21 packets", transfers);
    check_cycles(bus);
    cm1e_bus_close(bus);
}
END_TEST

/** The slave is gone, or the bus ends, at every moment of a transfer: it ends, and the others go on. */
START_TEST(the_end_of_a_slave_ends_its_file)
{
    for (int at = 0; at < 60; at += 3) {
        cm1e_bus_t *bus = operating();
        cm1e_foe_t foe = {.position = 1, .writing = at % 2, .name = "f", .from = written, .size = 5000, .to = got,
                          .room = FILE_MAX, .options.answer_ns = 300000000};
        ck_assert_int_eq(cm1e_foe_write(bus, 1, "f", written, 5000, NULL, &diag), CM1E_OK);
        ck_assert_int_eq(cm1e_foe_submit(bus, &foe, &diag), CM1E_OK);
        for (int i = 0; i < at; i++)
            cm1e_bus_pump(bus);
        if (at < 30)
            simulate(bus, at % 2 ? "unplug 1" : "power-cycle 1 100");
        else
            cm1e_bus_stop(bus);
        for (int i = 0; i < 2000 && !cm1e_foe_done(&foe) && at < 30; i++)
            cm1e_bus_pump(bus);
        ck_assert_msg(cm1e_foe_done(&foe), "at cycle %d", at);
        const cm1e_error_t error = cm1e_foe_result_of(&foe, &diag);
        ck_assert_msg(at >= 30 ? error == CM1E_ERROR_CANCELLED
                               : error == CM1E_ERROR_BUS_LOST || error == CM1E_ERROR_TIMEOUT, "%s", diag.text);
        cm1e_bus_close(bus);
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("foe");
    TCase *tests = tcase_create("foe");
    tcase_set_timeout(tests, 60);
    tcase_add_test(tests, files_of_every_size_around_a_packet);
    tcase_add_test(tests, a_busy_slave_is_asked_again_for_a_bounded_time);
    tcase_add_test(tests, lost_frames_lose_no_byte);
    tcase_add_test(tests, lies_end_in_time_and_overrun_nothing);
    tcase_add_test(tests, refusals_have_code_and_text);
    tcase_add_test(tests, a_file_that_is_too_large_ends_in_both);
    tcase_add_test(tests, progress_is_told_and_may_break_off);
    tcase_add_test(tests, the_mailbox_is_shared);
    tcase_add_test(tests, bootstrap_and_slaves_without_files);
    tcase_add_test(tests, an_update_that_fails_tells_what_the_slave_has);
    tcase_add_test(tests, files_go_beside_the_process_data);
    tcase_add_test(tests, refusals_in_operation);
    tcase_add_test(tests, files_and_sdo_transfers_take_turns);
    tcase_add_test(tests, the_end_of_a_slave_ends_its_file);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
