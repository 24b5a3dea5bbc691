/* A firmware update that goes wrong: the slave is lost at every frame, refuses a state or is late, has no files or no
 * Bootstrap. Each ends in an error that names the slave, the state that is told is that of the slave, and the next update
 * brings the slave back. */
#include "cm1e/foe.h" /* before the global `diag` of the tests */

#include "bus/datagram.h"
#include "bus/firmware_update.h"
#include "bus_support.h"
#include "description/sii_image.h"
#include "sim/cm1e_app.h"
#include "sim/esc_chip.h"

enum { MOTOR = 2, SLAVES = 2, FILE_BYTES = 600 };
enum { COMMAND_AT = 16, OFFSET_AT = 20, DATA_OF_FRAME = 26 };
static const char image[FILE_BYTES] = "CM1-E simulated firmware 1.3.4, 600 bytes\n";
static cm1e_firmware_state_t state;

static cm1e_bus_t *opened(void)
{
    sim_config(SLAVES);
    state = CM1E_FIRMWARE_WRITTEN;
    return open_bus();
}

static cm1e_sim_slave_t *motor(cm1e_bus_t *bus) { return cm1e_sim_segment_slave(segment_of(bus), MOTOR); }

static cm1e_error_t update(cm1e_bus_t *bus)
{
    const cm1e_firmware_file_t file = {.name = "x.bin", .bytes = (const uint8_t *)image, .size = sizeof image};
    return cm1e_firmware_update(bus, MOTOR, &file, &state, &diag);
}

static void let_pass(cm1e_bus_t *bus, int64_t time_ns) { cm1e_clock_sleep_until(cm1e_bus_clock(bus), now_of(bus) + time_ns); }

/** The slave has the new firmware, and says so in Pre-Operational. */
static void check_new_firmware(cm1e_bus_t *bus)
{
    ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_str_eq(cm1e_bus_slave(bus, MOTOR)->software_version, "1.3.4");
}

static void check_update_works(cm1e_bus_t *bus)
{
    ck_assert_msg(update(bus) == CM1E_OK, "%s", diag.text);
    ck_assert_int_eq(state, CM1E_FIRMWARE_WRITTEN);
    check_new_firmware(bus);
}

static void check_text(const char *expected) { ck_assert_msg(strstr(diag.text, expected) != NULL, "%s", diag.text); }

/* ---- lost on the way -------------------------------------------------------------------------------------------- */

/** What happens with frame number `at` that is sent; `first_state` is the number of the first request of a state. */
typedef struct strike {
    cm1e_bus_t *bus;
    const char *order;
    unsigned at, seen, first_state;
} strike_t;

static cm1e_tap_verdict_t strike(void *context, cm1e_tap_frame_t *frame)
{
    strike_t *fault = context;
    if (frame->direction != CM1E_TAP_SENT)
        return CM1E_TAP_PASS;
    fault->seen++;
    if (!fault->first_state && cm1e_get_u16(frame->bytes + OFFSET_AT) == REG_AL_CONTROL)
        fault->first_state = fault->seen;
    if (fault->seen == fault->at)
        simulate(fault->bus, fault->order);
    return CM1E_TAP_PASS;
}

static const struct loss {
    const char *order, *cure;
} losses[] = {{"unplug 2", "replug 2"}, {"power-cycle 2 300", NULL}, {"detach 2 powered", "attach 2"}};
enum { LOSSES = sizeof losses / sizeof losses[0] };

/** What is told agrees with the memory of the motor. */
static void check_told(cm1e_bus_t *bus, const strike_t *fault, cm1e_error_t error)
{
    const int memory = (int)cm1e_sim_cm1e_of(motor(bus))->update.memory;
    const bool old = memory == FIRMWARE_WHOLE && !cm1e_sim_cm1e_of(motor(bus))->update.firmware;
    const char *place = "slave lost at frame";
    ck_assert_msg(error == CM1E_ERROR_BUS_LOST || (fault->at == 1 && error == CM1E_ERROR_INVALID_ARGUMENT),
                  "%s %u: %s: %s", place, fault->at, cm1e_strerror(error), diag.text);
    ck_assert_msg(strstr(diag.text, "lave 2") != NULL, "%s %u: %s", place, fault->at, diag.text);
    ck_assert_msg(strstr(diag.text, error == CM1E_ERROR_BUS_LOST ? "stopped answering" : "1 answer") != NULL,
                  "%s %u: %s", place, fault->at, diag.text);
    ck_assert_msg(state != CM1E_FIRMWARE_UNTOUCHED || old, "%s %u: untouched, memory %d", place, fault->at, memory);
    ck_assert_msg(state != CM1E_FIRMWARE_WRITTEN || memory == FIRMWARE_NEW || !old, "%s %u: written, memory %d", place,
                  fault->at, memory);
}

/** The EEPROM is read with many equal frames, of which some are enough. */
START_TEST(a_slave_that_is_lost_at_any_frame_is_named_and_can_be_updated_again)
{
    const struct loss *loss = &losses[_i];
    unsigned seen[3] = {0}, step = 1;
    strike_t fault = {.order = loss->order};
    for (bool struck = true; struck; fault.at += step) {
        cm1e_bus_t *bus = fault.bus = opened();
        fault.seen = 0;
        cm1e_nic_set_tap(cm1e_bus_nic(bus), strike, &fault);
        const cm1e_error_t error = update(bus);
        cm1e_nic_set_tap(cm1e_bus_nic(bus), NULL, NULL);
        struck = fault.at == 0 || fault.seen >= fault.at;
        step = fault.at + 120 < fault.first_state ? 97 : 1;
        if (fault.at > 0 && struck && error != CM1E_OK)
            check_told(bus, &fault, error);
        seen[state] += error != CM1E_OK;
        if (loss->cure)
            simulate(bus, loss->cure);
        let_pass(bus, INT64_C(1000000000));
        if (error != CM1E_OK && state != CM1E_FIRMWARE_WRITTEN)
            check_update_works(bus);
        else
            check_new_firmware(bus);
        cm1e_bus_close(bus);
    }
    ck_assert(seen[CM1E_FIRMWARE_UNTOUCHED] > 20 && seen[CM1E_FIRMWARE_PARTLY] > 5);
    /* One that starts anew after the whole file has done what it should: it is in Init, without a station address. */
    ck_assert_int_eq(seen[CM1E_FIRMWARE_WRITTEN] == 0, loss->cure == NULL);
}
END_TEST

/* ---- states ----------------------------------------------------------------------------------------------------- */

enum { EARLIER_CODE = 0x001B };
static unsigned slow_answers;

/** The slave reads the request late: the next answers to a question for its state are still those of before. */
static cm1e_tap_verdict_t answer_slowly(void *context, cm1e_tap_frame_t *frame)
{
    static const uint8_t before[] = {CM1E_AL_PRE_OP | CM1E_AL_ERROR, 0, 0, 0, EARLIER_CODE, 0};
    (void)context;
    const bool status = frame->bytes[COMMAND_AT] == COMMAND_FPRD &&
                        cm1e_get_u16(frame->bytes + OFFSET_AT) == REG_AL_STATUS;
    if (frame->direction == CM1E_TAP_RECEIVED && status && slow_answers > 0) {
        memcpy(frame->bytes + DATA_OF_FRAME, before, sizeof before);
        slow_answers--;
    }
    return CM1E_TAP_PASS;
}

static cm1e_bus_t *with_an_earlier_error(unsigned answers)
{
    cm1e_bus_t *bus = opened();
    ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK, "%s", diag.text);
    cm1e_sim_slave_fall_back(motor(bus), CM1E_AL_PRE_OP, EARLIER_CODE);
    slow_answers = answers;
    cm1e_nic_set_tap(cm1e_bus_nic(bus), answer_slowly, NULL);
    return bus;
}

/** The error is that of something before, and not a refusal of the request that acknowledges it. */
START_TEST(an_earlier_error_of_a_slow_slave_is_no_refusal)
{
    cm1e_bus_t *bus = with_an_earlier_error((unsigned)_i);
    check_update_works(bus);
    ck_assert_uint_eq(slow_answers, 0);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(an_error_that_no_request_acknowledges_ends_the_update_in_time)
{
    cm1e_bus_t *bus = with_an_earlier_error(1000000);
    const int64_t begun_ns = now_of(bus);
    ck_assert_int_eq(update(bus), CM1E_ERROR_BUS_STATE);
    check_text("Slave 2 refuses INIT: AL status 0x001B, ");
    ck_assert_uint_eq(diag.foreign_code, EARLIER_CODE);
    ck_assert_int_eq(state, CM1E_FIRMWARE_UNTOUCHED);
    ck_assert_int_lt(now_of(bus) - begun_ns, INT64_C(12000000000));
    cm1e_nic_set_tap(cm1e_bus_nic(bus), NULL, NULL);
    check_update_works(bus);
    cm1e_bus_close(bus);
}
END_TEST

/** Without a valid SII the processor of the slave does not run. */
START_TEST(a_slave_that_does_not_reach_bootstrap_is_given_up)
{
    cm1e_bus_t *bus = opened();
    simulate(bus, "quirk 2 wrong-checksum");
    const int64_t begun_ns = now_of(bus);
    ck_assert_int_eq(update(bus), CM1E_ERROR_BUS_STATE);
    check_text("Slave 2 did not reach BOOT in time; it is in INIT.");
    ck_assert_uint_eq(diag.foreign_code, 0);
    ck_assert_int_eq(state, CM1E_FIRMWARE_UNTOUCHED);
    ck_assert_int_lt(now_of(bus) - begun_ns, INT64_C(12000000000));
    simulate(bus, "quirk 2 wrong-checksum"); /* the other way */
    check_update_works(bus);
    cm1e_bus_close(bus);
}
END_TEST

/* ---- what the SII states ---------------------------------------------------------------------------------------- */

static const struct statement {
    size_t place;
    uint16_t word;
    cm1e_error_t error;
    const char *words;
} statements[] = {
    {CM1E_SII_PROTOCOLS, 0x0004, CM1E_ERROR_UNSUPPORTED, "Slave 2 takes no files: its SII announces no FoE. A CM1-E "
     "does from firmware 1.2.0 on"},
    {CM1E_SII_BOOTSTRAP, 0, CM1E_ERROR_UNSUPPORTED, "Slave 2 has no Bootstrap: its SII states no mailbox for it (words "
     "0x14-0x17)."},
    {CM1E_SII_BOOTSTRAP + 2, 31, CM1E_ERROR_UNSUPPORTED, "no mailbox for it"},
    {CM1E_SII_BOOTSTRAP + 4, 0x0FFF, CM1E_ERROR_UNSUPPORTED, "no mailbox for it"},
    {CM1E_SII_BOOTSTRAP + 6, 0xFFFF, CM1E_ERROR_UNSUPPORTED, "no mailbox for it"},
    {CM1E_SII_BOOTSTRAP + 4, 0xFFF0, CM1E_ERROR_BUS_STATE, "Slave 2 refuses BOOT: AL status 0x0015, invalid mailbox "
     "configuration (bootstrap)."},
};
enum { STATEMENTS = sizeof statements / sizeof statements[0] };

START_TEST(a_slave_whose_sii_has_no_good_mailbox_for_files_keeps_its_firmware)
{
    const struct statement *statement = &statements[_i];
    cm1e_bus_t *bus = opened();
    uint8_t *place = motor(bus)->sii + statement->place;
    const uint16_t right = cm1e_get_u16(place);
    cm1e_put_u16(place, statement->word);
    ck_assert_int_eq(update(bus), statement->error);
    check_text(statement->words);
    ck_assert_int_eq(state, CM1E_FIRMWARE_UNTOUCHED);
    cm1e_put_u16(place, right);
    ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_str_eq(cm1e_bus_slave(bus, MOTOR)->software_version, tested_firmware());
    check_update_works(bus);
    cm1e_bus_close(bus);
}
END_TEST

/** A bus that is configured runs its slaves. */
START_TEST(an_update_needs_a_bus_that_is_not_configured)
{
    cm1e_bus_t *bus = opened();
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_int_eq(update(bus), CM1E_ERROR_STATE);
    check_text("needs a bus of its own, before its start");
    ck_assert_int_eq(state, CM1E_FIRMWARE_UNTOUCHED);
    cycles(bus, 20);
    cm1e_bus_close(bus);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bus_firmware");
    TCase *tests = tcase_create("firmware");
    tcase_add_loop_test(tests, a_slave_that_is_lost_at_any_frame_is_named_and_can_be_updated_again, 0, LOSSES);
    tcase_add_loop_test(tests, an_earlier_error_of_a_slow_slave_is_no_refusal, 1, 6);
    tcase_add_test(tests, an_error_that_no_request_acknowledges_ends_the_update_in_time);
    tcase_add_test(tests, a_slave_that_does_not_reach_bootstrap_is_given_up);
    tcase_add_loop_test(tests, a_slave_whose_sii_has_no_good_mailbox_for_files_keeps_its_firmware, 0, STATEMENTS);
    tcase_add_test(tests, an_update_needs_a_bus_that_is_not_configured);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
