/* Registers and states of one slave, requested as they are (cm1e/esc.h). */
#include "bus_support.h"
#include "cm1e/esc.h"

#define TIMEOUT_NS INT64_C(500000000)

START_TEST(registers_are_read_and_written)
{
    enum { WATCHDOG_DATA = 0x0420, AL_STATUS = 0x0130 };
    cm1e_bus_t *bus = open_scanned_bus(2);
    uint8_t value[2] = {0}, wanted[2] = {0x34, 0x12};
    ck_assert_int_eq(cm1e_esc_write(bus, 2, WATCHDOG_DATA, wanted, sizeof wanted, &diag), CM1E_OK);
    ck_assert_int_eq(cm1e_esc_read(bus, 2, WATCHDOG_DATA, value, sizeof value, &diag), CM1E_OK);
    ck_assert_mem_eq(value, wanted, sizeof value);
    ck_assert_int_eq(cm1e_esc_read(bus, 1, WATCHDOG_DATA, value, sizeof value, &diag), CM1E_OK);
    ck_assert_int_eq(value[0] | value[1] << 8, 0x03E8);
    ck_assert_int_eq(cm1e_esc_read(bus, 0, AL_STATUS, value, sizeof value, &diag), CM1E_OK);
    ck_assert_int_eq(value[0], CM1E_AL_PRE_OP);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(states_are_requested_as_they_are)
{
    cm1e_bus_t *bus = open_scanned_bus(2);
    cm1e_al_answer_t answer;
    ck_assert_int_eq(cm1e_esc_request_state(bus, 1, CM1E_AL_OP, TIMEOUT_NS, &answer, &diag), CM1E_OK);
    ck_assert_int_eq(answer.state, CM1E_AL_PRE_OP | CM1E_AL_ERROR);
    ck_assert_int_eq(answer.code, 0x0011);
    ck_assert_int_eq(cm1e_esc_request_state(bus, 1, 5, TIMEOUT_NS, &answer, &diag), CM1E_OK);
    ck_assert_int_eq(answer.code, 0x0012);
    ck_assert_int_eq(cm1e_esc_request_state(bus, 1, CM1E_AL_INIT, TIMEOUT_NS, &answer, &diag), CM1E_OK);
    ck_assert_int_eq(answer.state, CM1E_AL_INIT);
    ck_assert_int_eq(answer.code, 0);
    ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK, "%s", diag.text);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(what_cannot_be_meant_is_refused_in_words)
{
    cm1e_bus_t *bus = open_scanned_bus(2);
    uint8_t value[2] = {0};
    cm1e_al_answer_t answer;
    ck_assert_int_eq(cm1e_esc_read(bus, 3, 0, value, 2, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_ptr_nonnull(strstr(diag.text, "no slave 3"));
    ck_assert_int_eq(cm1e_esc_read(bus, 1, 0, value, 0, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(cm1e_esc_write(bus, 0, 0, value, 2, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(cm1e_esc_request_state(bus, 1, 0, 1, &answer, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(cm1e_esc_request_state(bus, 0, 1, 1, &answer, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    for (int64_t none = -1; none <= 0; none++) {
        ck_assert_int_eq(cm1e_esc_request_state(bus, 1, 2, none, &answer, &diag), CM1E_ERROR_INVALID_ARGUMENT);
        ck_assert_ptr_nonnull(strstr(diag.text, "The time limit for a state is"));
    }
    ck_assert_int_eq(cm1e_esc_request_state(bus, 1, CM1E_AL_INIT, INT64_MAX, &answer, &diag), CM1E_OK);
    ck_assert_int_eq(cm1e_esc_request_state(bus, 1, CM1E_AL_INIT, 1, NULL, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(cm1e_esc_read(bus, 1, 0, NULL, 2, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(cm1e_esc_write(bus, 1, 0, NULL, 2, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_int_eq(cm1e_esc_read(bus, 1, 0, value, 2, &diag), CM1E_ERROR_STATE);
    cm1e_bus_close(bus);
}
END_TEST

/** Its neighbour still answers. */
START_TEST(a_slave_that_is_gone_is_named_with_the_register)
{
    cm1e_bus_t *bus = open_scanned_bus(2);
    uint8_t value[2] = {0};
    cm1e_al_answer_t answer = {0};
    simulate(bus, "unplug 2");
    ck_assert_int_eq(cm1e_esc_read(bus, 2, 0x0130, value, 2, &diag), CM1E_ERROR_TIMEOUT);
    ck_assert_str_eq(diag.text, "Slave 2 does not answer at register 0x0130.");
    ck_assert_int_eq(cm1e_esc_write(bus, 2, 0x0420, value, 2, &diag), CM1E_ERROR_TIMEOUT);
    ck_assert_str_eq(diag.text, "Slave 2 does not answer at register 0x0420.");
    ck_assert_int_eq(cm1e_esc_request_state(bus, 2, CM1E_AL_INIT, TIMEOUT_NS, &answer, &diag), CM1E_ERROR_TIMEOUT);
    ck_assert_msg(strstr(diag.text, "lave 2") && strstr(diag.text, "answer"), "%s", diag.text);
    ck_assert_int_eq(cm1e_esc_read(bus, 1, 0x0130, value, 2, &diag), CM1E_OK);
    simulate(bus, "replug 2");
    ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_int_eq(cm1e_esc_read(bus, 2, 0x0130, value, 2, &diag), CM1E_OK);
    ck_assert_int_eq(value[0], CM1E_AL_PRE_OP);
    cm1e_bus_close(bus);
}
END_TEST

/** Without a valid SII the processor of a slave does not run, so nobody reads the request. */
START_TEST(a_slave_that_neither_goes_nor_refuses_is_told_with_its_present_state)
{
    cm1e_bus_t *bus = open_scanned_bus(2);
    cm1e_al_answer_t answer = {0};
    simulate(bus, "quirk 2 wrong-checksum");
    const int64_t begun_ns = now_of(bus);
    ck_assert_int_eq(cm1e_esc_request_state(bus, 2, CM1E_AL_INIT, TIMEOUT_NS, &answer, &diag), CM1E_ERROR_TIMEOUT);
    ck_assert_int_lt(now_of(bus) - begun_ns, 2 * TIMEOUT_NS);
    ck_assert_int_eq(answer.state, CM1E_AL_PRE_OP);
    ck_assert_int_eq(answer.code, 0);
    ck_assert_msg(strstr(diag.text, "lave 2") && strstr(diag.text, "PRE-OP"), "%s", diag.text);
    simulate(bus, "quirk 2 wrong-checksum"); /* right again */
    ck_assert_int_eq(cm1e_esc_request_state(bus, 2, CM1E_AL_INIT, TIMEOUT_NS, &answer, &diag), CM1E_OK);
    ck_assert_int_eq(answer.state, CM1E_AL_INIT);
    cm1e_bus_close(bus);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bus_esc");
    TCase *tests = tcase_create("esc");
    tcase_add_test(tests, registers_are_read_and_written);
    tcase_add_test(tests, states_are_requested_as_they_are);
    tcase_add_test(tests, what_cannot_be_meant_is_refused_in_words);
    tcase_add_test(tests, a_slave_that_is_gone_is_named_with_the_register);
    tcase_add_test(tests, a_slave_that_neither_goes_nor_refuses_is_told_with_its_present_state);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
