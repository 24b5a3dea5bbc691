/* Answers to a transfer of a file that are wrong: they end it with the words for it, no file is taken for whole that is
 * not, and the next transfer is right. And what is refused before it begins. */
#include "cm1e/foe.h" /* before the global `diag` of the tests */

#include "bus/bus_internal.h"
#include "bus_support.h"
#include "core/bytes.h"
#include "sim/cia402_app.h"

enum { PACKETS = 9, FILE_MAX = 4096 };
enum { COMMAND_AT = 16, MESSAGE_AT = 26, TYPE = 5, SERVICE = 6, NUMBER = 8, FOE_DATA = 3, FOE_ACK = 4 };
static uint8_t written[FILE_MAX], got[FILE_MAX];

static cm1e_bus_config_t *drive(void)
{
    sim_config(1);
    strcpy(config.axes[0].device, "cia402");
    config.axes[0].firmware[0] = 0;
    config.axes[0].counts_per_revolution = 10000;
    config.axes[0].max_speed_rpm = 3000;
    for (size_t i = 0; i < sizeof written; i++)
        written[i] = (uint8_t)(i * 7 + i / 251);
    return &config;
}

/** A drive that keeps files, in Pre-Operational. */
static cm1e_bus_t *scanned(void)
{
    drive();
    cm1e_bus_t *bus = open_bus();
    ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK, "%s", diag.text);
    return bus;
}

static size_t packet(cm1e_bus_t *bus) { return bus->slaves[0].facts.mailbox_in_length - 12u; }

static cm1e_error_t write_file(cm1e_bus_t *bus, size_t size)
{
    return cm1e_foe_write(bus, 1, "a file.bin", written, size, NULL, &diag);
}

/** Reads the file; `*size` is what has come of it. */
static cm1e_error_t read_file(cm1e_bus_t *bus, size_t *size)
{
    *size = sizeof got;
    memset(got, 0xEE, sizeof got);
    return cm1e_foe_read(bus, 1, "a file.bin", got, size, NULL, &diag);
}

static void check_next_transfer(cm1e_bus_t *bus, size_t size)
{
    size_t read;
    cm1e_nic_set_tap(cm1e_bus_nic(bus), NULL, NULL);
    ck_assert_msg(write_file(bus, size) == CM1E_OK, "%s", diag.text);
    ck_assert_msg(read_file(bus, &read) == CM1E_OK, "%s", diag.text);
    ck_assert_uint_eq(read, size);
    ck_assert_mem_eq(got, written, size);
}

/* ---- answers ---------------------------------------------------------------------------------------------------- */

/** The message of FoE in a frame that comes from the slave, or goes to it; NULL: there is none. */
static uint8_t *message_in(cm1e_tap_frame_t *frame, cm1e_tap_direction_t direction)
{
    uint8_t *message = frame->bytes + MESSAGE_AT;
    const uint8_t command = direction == CM1E_TAP_RECEIVED ? COMMAND_FPRD : COMMAND_FPWR;
    const bool mailbox = frame->direction == direction && frame->bytes[COMMAND_AT] == command && frame->length > 100;
    return mailbox && (message[TYPE] & 0x0F) == MAILBOX_TYPE_FOE ? message : NULL;
}

typedef struct wrong {
    unsigned at, seen;
    uint32_t shown, real; /* number of the packet that always comes; number that the slave gave it */
} wrong_t;

static cm1e_tap_verdict_t refuse_foe(void *context, cm1e_tap_frame_t *frame)
{
    wrong_t *wrong = context;
    uint8_t *message = message_in(frame, CM1E_TAP_RECEIVED);
    if (message && ++wrong->seen == wrong->at)
        message[TYPE] = (uint8_t)((message[TYPE] & 0xF0) | MAILBOX_TYPE_ERROR);
    return CM1E_TAP_PASS;
}

/** Both directions, at every answer. */
START_TEST(a_mailbox_that_refuses_foe_ends_the_transfer)
{
    cm1e_bus_t *bus = scanned();
    const size_t size = 3 * packet(bus) + 1;
    size_t read;
    for (unsigned writes = 0; writes < 2; writes++)
        for (unsigned at = 1; at <= 4; at++) {
            wrong_t wrong = {.at = at};
            check_next_transfer(bus, size);
            cm1e_nic_set_tap(cm1e_bus_nic(bus), refuse_foe, &wrong);
            const cm1e_error_t error = writes ? write_file(bus, size) : read_file(bus, &read);
            ck_assert_msg(error == CM1E_ERROR_BUS_MAILBOX, "answer %u: %s", at, diag.text);
            ck_assert_str_eq(diag.text, "Slave 1 refuses FoE in its mailbox.");
        }
    check_next_transfer(bus, size);
    cm1e_bus_close(bus);
}
END_TEST

static cm1e_tap_verdict_t hide_foe(void *unused, cm1e_tap_frame_t *frame)
{
    (void)unused;
    uint8_t *message = message_in(frame, CM1E_TAP_RECEIVED);
    if (message)
        message[TYPE] |= 0x0F; /* of no protocol */
    return CM1E_TAP_PASS;
}

/** Whoever breaks it off does not wait for the time of the answer, and the mailbox serves others. */
START_TEST(a_file_without_an_answer_is_broken_off_within_half_a_second)
{
    enum { BEFORE = 50, MOST = 500 };
    drive();
    cm1e_bus_t *bus = start_bus();
    for (unsigned writes = 0; writes < 2; writes++) {
        cm1e_foe_t foe = {.position = 1, .writing = writes, .name = "a file.bin", .from = written, .to = got,
                          .size = writes ? 100 : 0, .room = sizeof got, .options.answer_ns = INT64_C(600000000000)};
        check_next_transfer(bus, 100);
        cm1e_nic_set_tap(cm1e_bus_nic(bus), hide_foe, NULL);
        ck_assert_int_eq(cm1e_foe_submit(bus, &foe, &diag), CM1E_OK);
        for (unsigned n = 0; n < BEFORE; n++)
            ck_assert_int_eq(cycle(bus), CM1E_OK);
        ck_assert(!cm1e_foe_done(&foe));
        cm1e_foe_cancel(&foe);
        for (unsigned n = 0; !cm1e_foe_done(&foe); n++) {
            ck_assert_int_eq(cycle(bus), CM1E_OK);
            ck_assert_uint_lt(n, MOST);
        }
        ck_assert_int_eq(cm1e_foe_result_of(&foe, &diag), CM1E_ERROR_CANCELLED);
    }
    check_next_transfer(bus, 100);
    cm1e_bus_close(bus);
}
END_TEST

/** From packet `shown` on the slave repeats itself: the acknowledgements come to it as if for what it has sent. */
static cm1e_tap_verdict_t repeat_packet(void *context, cm1e_tap_frame_t *frame)
{
    wrong_t *wrong = context;
    uint8_t *message = message_in(frame, CM1E_TAP_RECEIVED);
    if (message && message[SERVICE] == FOE_DATA && cm1e_get_u32(message + NUMBER) >= wrong->shown) {
        wrong->real = cm1e_get_u32(message + NUMBER);
        cm1e_put_u32(message + NUMBER, wrong->shown);
        wrong->seen++;
    }
    message = message_in(frame, CM1E_TAP_SENT);
    if (message && message[SERVICE] == FOE_ACK && wrong->real)
        cm1e_put_u32(message + NUMBER, wrong->real);
    return CM1E_TAP_PASS;
}

START_TEST(a_packet_that_comes_again_and_again_ends_the_transfer)
{
    char words[80];
    wrong_t wrong = {.shown = (uint32_t)_i};
    cm1e_bus_t *bus = scanned();
    const size_t size = PACKETS * packet(bus);
    size_t read;
    check_next_transfer(bus, size);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), repeat_packet, &wrong);
    ck_assert_int_eq(read_file(bus, &read), CM1E_ERROR_BUS_MAILBOX);
    snprintf(words, sizeof words, "Slave 1 sends packet %d again and again.", _i);
    ck_assert_str_eq(diag.text, words);
    ck_assert_uint_eq(read, (size_t)_i * packet(bus));
    ck_assert_mem_eq(got, written, read);
    ck_assert_uint_eq(wrong.seen, 5); /* the first time, and three times that are acknowledged again */
    check_next_transfer(bus, size);
    cm1e_bus_close(bus);
}
END_TEST

/** Packet `at` has the number of the one before. */
static cm1e_tap_verdict_t number_wrongly(void *context, cm1e_tap_frame_t *frame)
{
    const wrong_t *wrong = context;
    uint8_t *message = message_in(frame, CM1E_TAP_RECEIVED);
    if (message && message[SERVICE] == FOE_DATA && cm1e_get_u32(message + NUMBER) == wrong->at)
        cm1e_put_u32(message + NUMBER, wrong->at - 1);
    return CM1E_TAP_PASS;
}

/** The last packet is shorter than the others: taken for the one before it, it must not end the file. */
START_TEST(a_file_without_one_of_its_packets_is_no_whole_file)
{
    const wrong_t wrong = {.at = (unsigned)_i};
    cm1e_bus_t *bus = scanned();
    const size_t size = 3 * packet(bus) + 20;
    size_t read;
    check_next_transfer(bus, size);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), number_wrongly, (void *)(uintptr_t)&wrong);
    const cm1e_error_t error = read_file(bus, &read);
    ck_assert_msg(error == CM1E_ERROR_BUS_MAILBOX, "%zu of %zu bytes: %s", read, size, diag.text);
    ck_assert_uint_eq(read, (wrong.at - 1) * packet(bus));
    check_next_transfer(bus, size);
    cm1e_bus_close(bus);
}
END_TEST

/** Packet `at`, or its acknowledgement, has another number. */
static cm1e_tap_verdict_t skip_numbers(void *context, cm1e_tap_frame_t *frame)
{
    const wrong_t *wrong = context;
    uint8_t *message = message_in(frame, CM1E_TAP_RECEIVED);
    if (message && (message[SERVICE] == FOE_DATA || message[SERVICE] == FOE_ACK) &&
        cm1e_get_u32(message + NUMBER) == wrong->at)
        cm1e_put_u32(message + NUMBER, wrong->at + 7);
    return CM1E_TAP_PASS;
}

START_TEST(a_packet_that_was_not_expected_is_told_with_both_numbers)
{
    const wrong_t wrong = {.at = (unsigned)_i};
    char words[90];
    cm1e_bus_t *bus = scanned();
    const size_t size = 3 * packet(bus) + 20;
    size_t read;
    check_next_transfer(bus, size);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), skip_numbers, (void *)(uintptr_t)&wrong);
    ck_assert_int_eq(read_file(bus, &read), CM1E_ERROR_BUS_MAILBOX);
    snprintf(words, sizeof words, "Slave 1 sends packet %d of the file, packet %d was expected.", _i + 7, _i);
    ck_assert_str_eq(diag.text, words);
    ck_assert_int_eq(write_file(bus, size), CM1E_ERROR_BUS_MAILBOX);
    snprintf(words, sizeof words, "Slave 1 acknowledges packet %d of the file, packet %d was sent.", _i + 7, _i);
    ck_assert_str_eq(diag.text, words);
    check_next_transfer(bus, size);
    cm1e_bus_close(bus);
}
END_TEST

/* ---- before it begins ------------------------------------------------------------------------------------------- */

START_TEST(a_transfer_without_a_name_a_buffer_or_a_running_bus_is_refused)
{
    size_t size = 10;
    cm1e_bus_t *bus = scanned();
    cm1e_foe_t foe = {.position = 1, .writing = true, .name = "f", .from = written, .size = 10};
    ck_assert_int_eq(cm1e_foe_read(bus, 1, NULL, got, &size, NULL, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_str_eq(diag.text, "cm1e_foe_read() needs a name and a buffer.");
    ck_assert_int_eq(cm1e_foe_read(bus, 1, "f", got, NULL, NULL, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(cm1e_foe_write(bus, 1, "f", NULL, 10, NULL, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_str_eq(diag.text, "cm1e_foe_write() needs a name and a buffer.");
    ck_assert_int_eq(cm1e_foe_submit(bus, &foe, &diag), CM1E_ERROR_STATE);
    ck_assert_str_eq(diag.text, "The bus does not operate.");
    cm1e_bus_close(bus);
    drive();
    bus = start_bus();
    foe.name = NULL;
    ck_assert_int_eq(cm1e_foe_submit(bus, &foe, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_str_eq(diag.text, "A file needs a name and a buffer.");
    foe = (cm1e_foe_t){.position = 1, .name = "f", .room = 10};
    ck_assert_int_eq(cm1e_foe_submit(bus, &foe, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    check_next_transfer(bus, 100);
    cm1e_bus_close(bus);
}
END_TEST

/** The SII is not trusted: what it states may be too small for a message, or larger than a frame. The simulated slave
 *  refuses Pre-Operational with such a mailbox; another one may take it. */
START_TEST(a_mailbox_of_no_good_size_has_no_files)
{
    static const uint16_t sizes[] = {31, 1487};
    char words[40];
    cm1e_bus_t *bus = scanned();
    cm1e_mailbox_t *mailbox = &bus->slaves[0].coe.mailbox;
    const cm1e_mailbox_t right = *mailbox;
    for (unsigned n = 0; n < 4; n++, *mailbox = right) {
        *(n < 2 ? &mailbox->out_length : &mailbox->in_length) = sizes[n % 2];
        ck_assert_int_eq(write_file(bus, 10), CM1E_ERROR_UNSUPPORTED);
        snprintf(words, sizeof words, n < 2 ? "%u bytes to it" : "%u from it", sizes[n % 2]);
        ck_assert_msg(strstr(diag.text, words) != NULL, "%s", diag.text);
        ck_assert_msg(strstr(diag.text, "expected are 32 to 1486") != NULL, "%s", diag.text);
    }
    check_next_transfer(bus, 100);
    cm1e_bus_close(bus);
}
END_TEST

/** The time for an answer that is not given is 5 s, also where the cycle has the transfer. */
START_TEST(a_slave_that_is_busy_for_ever_is_given_up_after_the_default_time)
{
    drive();
    cm1e_bus_t *bus = start_bus();
    cm1e_sim_files_t *files = &cm1e_sim_cia402_of(cm1e_sim_segment_slave(segment_of(bus), 1))->files;
    cm1e_foe_t foe = {.position = 1, .writing = true, .name = "f", .from = written, .size = 10};
    files->busy = 1000000;
    const int64_t begun_ns = now_of(bus);
    ck_assert_int_eq(cm1e_foe_submit(bus, &foe, &diag), CM1E_OK);
    while (!cm1e_foe_done(&foe) && now_of(bus) - begun_ns < INT64_C(10000000000))
        ck_assert_int_eq(cycle(bus), CM1E_OK);
    ck_assert_int_eq(cm1e_foe_result_of(&foe, &diag), CM1E_ERROR_TIMEOUT);
    ck_assert_str_eq(diag.text, "Slave 1 says for 5 s that it is busy, after 0 of 10 bytes.");
    ck_assert_int_ge(now_of(bus) - begun_ns, INT64_C(5000000000));
    ck_assert_int_lt(now_of(bus) - begun_ns, INT64_C(6000000000));
    files->busy = 0;
    check_next_transfer(bus, 100);
    cm1e_bus_close(bus);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bus_foe_wrong");
    TCase *tests = tcase_create("foe_wrong");
    tcase_add_test(tests, a_mailbox_that_refuses_foe_ends_the_transfer);
    tcase_add_test(tests, a_file_without_an_answer_is_broken_off_within_half_a_second);
    tcase_add_loop_test(tests, a_packet_that_comes_again_and_again_ends_the_transfer, 1, 5);
    tcase_add_loop_test(tests, a_file_without_one_of_its_packets_is_no_whole_file, 2, 5);
    tcase_add_loop_test(tests, a_packet_that_was_not_expected_is_told_with_both_numbers, 1, 5);
    tcase_add_test(tests, a_transfer_without_a_name_a_buffer_or_a_running_bus_is_refused);
    tcase_add_test(tests, a_mailbox_of_no_good_size_has_no_files);
    tcase_add_test(tests, a_slave_that_is_busy_for_ever_is_given_up_after_the_default_time);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
