/* CML without a cycle, as tools do it: cm1e_cml_exchange() and cm1e_cml_leave() on a simulated bridge that has only
 * been scanned. */
#include "cm1e/cml.h"
#include "drive/drive_cml.h"
#include "nic/nic.h"
#include "sim/bridge_app.h"

#include "bridge_wire.h"
#include "axis_segment.h"

static cm1e_cml_exchange_t exchange;

static cm1e_sim_bridge_axis_t *motor(unsigned channel)
{
    cm1e_sim_slave_t *slave = cm1e_sim_segment_slave(cm1e_bus_segment(bus), 2);
    return &cm1e_sim_bridge_of(slave)->axes[channel - 1];
}

static void start(void)
{
    describe("1.3.5", CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, 1000000);
    describe_up_to(3);
    config.axes[0].address = 1;
    for (uint8_t i = 1; i < 3; i++) {
        config.axes[i] = (cm1e_axis_config_t){.address = 2, .channel = i, .k37 = 10, .k37_stated = true};
        strcpy(config.axes[i].motor, "CM1");
        config.axes[i].sim.no_stops = i == 2;
    }
    memset(&diag, 0, sizeof diag);
    ck_assert_msg(cm1e_bus_open(&bus, &config, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK, "%s", diag.text);
}

/* From now on all transfers are seen (bridge_wire.h). */
static void watch_wire(void)
{
    wire_forget();
    cm1e_nic_set_tap(cm1e_bus_nic(bus), wire_tap, NULL);
}

static void stop(void)
{
    cm1e_bus_close(bus);
    bus = NULL;
}

static cm1e_error_t send(uint8_t channel, const char *string, bool allow_motion)
{
    memset(&exchange, 0, sizeof exchange);
    memset(&diag, 0, sizeof diag);
    exchange.position = 2;
    exchange.channel = channel;
    exchange.text = string;
    exchange.allow_motion = allow_motion;
    return cm1e_cml_exchange(bus, &exchange, &diag);
}

static void fails(cm1e_error_t wanted, cm1e_error_t error, const char *words)
{
    ck_assert_msg(error == wanted, "%s: %s", cm1e_strerror(error), diag.text);
    ck_assert_msg(strstr(diag.text, words), "%s", diag.text);
    ck_assert_msg(diag.foreign_code == 0, "foreign code %lld: %s", (long long)diag.foreign_code, diag.text);
}

static uint16_t object_of(unsigned channel, uint16_t index)
{
    return (uint16_t)(index + (channel - 1) * CM1E_BRIDGE_INDEX_INCREMENT);
}

/* The modes that were written to a motor since wire_forget(), "8 101" for example. */
static const char *modes_written(unsigned channel)
{
    static char modes[64];
    size_t used = 0;
    int number = -1;
    modes[0] = '\0';
    for (const sdo_seen_t *sdo; (sdo = find_sdo(number + 1, true, object_of(channel, 0x6060), &number));)
        used += (size_t)snprintf(modes + used, sizeof modes - used, "%s%d", used > 0 ? " " : "", sdo->data[0]);
    return modes;
}

/* To which no time can be added. */
static void fails_for_time(int64_t timeout_ns)
{
    memset(&diag, 0, sizeof diag);
    exchange = (cm1e_cml_exchange_t){.position = 2, .channel = 1, .text = "?99", .timeout_ns = timeout_ns};
    fails(CM1E_ERROR_INVALID_ARGUMENT, cm1e_cml_exchange(bus, &exchange, &diag), "a timeout of");
}

START_TEST(test_answers_and_the_way_back)
{
    start();
    ck_assert_msg(send(1, "K53.1,?99", false) == CM1E_OK, "%s", diag.text);
    ck_assert_uint_eq(exchange.count, 2);
    exchange.timeout_ns = CM1E_DRIVE_LONGEST_NS;
    ck_assert_msg(cm1e_cml_exchange(bus, &exchange, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_str_eq(exchange.lines[0], "K53.1=0");
    ck_assert_int_eq(motor(1)->mode, CM1E_BRIDGE_MODE_CML);
    ck_assert_int_eq(motor(2)->mode, CM1E_BRIDGE_MODE_CSP);
    ck_assert_msg(send(1, "?90", false) == CM1E_OK, "%s", diag.text);
    ck_assert_uint_ge(exchange.count, 40);
    ck_assert_int_eq(cm1e_cml_leave(bus, 2, 1, false, &diag), CM1E_OK);
    ck_assert_int_eq(motor(1)->mode, CM1E_BRIDGE_MODE_CSP);
    ck_assert_int_eq(cm1e_cml_leave(bus, 2, 1, false, &diag), CM1E_OK); /* it is there */
    stop();
}
END_TEST

/* A motor in CML mode stays there; one in csp goes there at once, one in another mode through csp. */
START_TEST(test_only_modes_that_are_needed_are_written)
{
    start();
    watch_wire();
    ck_assert_msg(send(1, "?99.1", false) == CM1E_OK, "%s", diag.text);
    ck_assert_str_eq(modes_written(1), "101");
    ck_assert_msg(send(1, "?99.1", false) == CM1E_OK, "%s", diag.text);
    ck_assert_str_eq(modes_written(1), "101");
    const int8_t homing = 6;
    ck_assert_int_eq(cm1e_sdo_write(bus, 2, object_of(2, 0x6060), 0, &homing, 1, &diag), CM1E_OK);
    cm1e_clock_sleep_until(cm1e_bus_clock(bus), cm1e_clock_now(cm1e_bus_clock(bus)) + 20000000);
    wire_forget();
    ck_assert_msg(send(2, "?99.2", false) == CM1E_OK, "%s", diag.text);
    ck_assert_str_eq(modes_written(2), "8 101");
    int written = -1;
    const sdo_seen_t *write = find_sdo(0, true, object_of(2, 0x6060), &written);
    const sdo_seen_t *read = find_sdo(written, false, object_of(2, 0x6061), NULL);
    ck_assert_int_ge(read->sent_ns - write->answered_ns, CM1E_BRIDGE_MODE_INTERVAL_NS);
    ck_assert_uint_eq(motor(1)->broken_rules | motor(2)->broken_rules, 0);
    stop();
}
END_TEST

/* Who wrote a mode before, and when, is not known. */
START_TEST(test_a_mode_is_not_written_at_once)
{
    const int8_t csp = CM1E_BRIDGE_MODE_CSP;
    start();
    watch_wire();
    ck_assert_int_eq(cm1e_sdo_write(bus, 2, 0x6060, 0, &csp, 1, &diag), CM1E_OK);
    ck_assert_msg(send(1, "?99.1", false) == CM1E_OK, "%s", diag.text);
    int written = -1;
    const sdo_seen_t *first = find_sdo(0, true, 0x6060, &written);
    const sdo_seen_t *second = find_sdo(written + 1, true, 0x6060, NULL);
    ck_assert_int_ge(second->sent_ns - first->answered_ns, CM1E_BRIDGE_MODE_INTERVAL_NS);
    ck_assert_uint_eq(motor(1)->broken_rules, 0);
    stop();
}
END_TEST

static uint16_t forged_index;
static void answer_without_data(const sdo_seen_t *sdo, uint8_t *value)
{
    if (sdo->index != forged_index)
        return;
    value[-4] = 0x41; /* an upload that is not expedited, with its size */
    memset(value, 0, 4);
}

START_TEST(test_a_mode_that_cannot_be_read_is_an_error)
{
    start();
    watch_wire();
    bridge_wire.forge_answer = answer_without_data;
    forged_index = 0x6061;
    fails(CM1E_ERROR_BUS_MAILBOX, send(1, "?99.1", false), "0 bytes instead of 1");
    fails(CM1E_ERROR_BUS_MAILBOX, cm1e_cml_leave(bus, 2, 1, false, &diag), "0 bytes instead of 1");
    ck_assert_str_eq(modes_written(1), "");
    forged_index = 0xF530;
    simulate("motor 2 2 error overload");
    fails(CM1E_ERROR_DRIVE_MODE_TIMEOUT, send(2, "?99.2", false), "its status is: unknown.");
    stop();
}
END_TEST

static int asked;
static bool after_a_while(void *context)
{
    return ++asked > *(int *)context;
}

/* The answer to a string that was cancelled is no answer to the next one. */
START_TEST(test_an_answer_that_comes_too_late_is_shown_as_stray)
{
    int most = 2;
    start();
    watch_wire();
    ck_assert_msg(send(1, "?99.1", false) == CM1E_OK, "%s", diag.text);
    asked = 0;
    exchange = (cm1e_cml_exchange_t){.position = 2, .channel = 1, .text = "K53.1", .cancelled = after_a_while,
                                     .context = &most, .count = 7, .lost = 7, .strays = 7};
    fails(CM1E_ERROR_CANCELLED, cm1e_cml_exchange(bus, &exchange, &diag), "cancelled");
    ck_assert_uint_eq(exchange.count + exchange.lost + exchange.strays, 0);
    ck_assert_ptr_nonnull(find_sdo(0, true, 0xF581, NULL));
    cm1e_clock_sleep_until(cm1e_bus_clock(bus), cm1e_clock_now(cm1e_bus_clock(bus)) + 500000000);
    ck_assert_msg(send(1, "?99.1", false) == CM1E_OK, "%s", diag.text);
    ck_assert_uint_eq(exchange.count, 1);
    ck_assert_uint_eq(exchange.strays, 1);
    ck_assert_str_eq(exchange.stray, "K53.1=0");
    exchange.text = NULL;
    fails(CM1E_ERROR_CML_STRING, cm1e_cml_exchange(bus, &exchange, &diag), "is missing");
    ck_assert_uint_eq(exchange.count + exchange.lost + exchange.strays, 0); /* of no earlier string */
    stop();
}
END_TEST

START_TEST(test_what_is_refused_reaches_no_motor)
{
    start();
    fails(CM1E_ERROR_CML_MOTION, send(1, "|.1", false), "allowed");
    fails(CM1E_ERROR_CML_STRING, send(1, "", true), "is empty");
    fails(CM1E_ERROR_CML_STRING, send(1, NULL, true), "is missing");
    fails_for_time(-1);
    fails_for_time(CM1E_DRIVE_LONGEST_NS + 1);
    fails_for_time(INT64_MAX);
    fails(CM1E_ERROR_INVALID_ARGUMENT, cm1e_cml_exchange(NULL, &exchange, &diag), "needs a bus");
    fails(CM1E_ERROR_INVALID_ARGUMENT, cm1e_cml_leave(NULL, 2, 1, false, &diag), "needs a bus");
    fails(CM1E_ERROR_CML_STRING, send(1, "?99.2", true), "another motor");
    fails(CM1E_ERROR_INVALID_ARGUMENT, send(0, "?99", false), "connector 0");
    fails(CM1E_ERROR_INVALID_ARGUMENT, send(5, "?99", false), "1 ... 4");
    ck_assert_int_ne(send(4, "?99", false), CM1E_ERROR_INVALID_ARGUMENT); /* nothing is plugged in there */
    exchange = (cm1e_cml_exchange_t){.position = 1, .channel = 1, .text = "?99"};
    fails(CM1E_ERROR_CM_NO_BRIDGE, cm1e_cml_exchange(bus, &exchange, &diag), "no EtherCAT Cool MUSCLE Bridge");
    exchange.position = 7;
    fails(CM1E_ERROR_INVALID_ARGUMENT, cm1e_cml_exchange(bus, &exchange, &diag), "no slave 7");
    ck_assert_int_eq(cm1e_cml_exchange(NULL, &exchange, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(cm1e_cml_leave(NULL, 2, 1, false, NULL), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(motor(1)->mode, CM1E_BRIDGE_MODE_CSP);
    stop();
}
END_TEST

START_TEST(test_a_motor_in_cmd_or_with_an_error_is_left_alone)
{
    start();
    const int8_t cmd = CM1E_BRIDGE_MODE_CMD;
    ck_assert_int_eq(cm1e_sdo_write(bus, 2, 0x6060, 0, &cmd, 1, &diag), CM1E_OK);
    cm1e_clock_sleep_until(cm1e_bus_clock(bus), cm1e_clock_now(cm1e_bus_clock(bus)) + 20000000);
    fails(CM1E_ERROR_CM_MODE, send(1, "?99.1", false), "off and on");
    ck_assert_int_eq(cm1e_cml_leave(bus, 2, 1, false, &diag), CM1E_OK); /* not ours to leave */
    ck_assert_int_eq(motor(1)->mode, CM1E_BRIDGE_MODE_CMD);
    simulate("motor 2 2 error overload");
    fails(CM1E_ERROR_DRIVE_MODE_TIMEOUT, send(2, "?99.2", false), "overload");
    simulate("motor 2 2 error position");
    fails(CM1E_ERROR_DRIVE_MODE_TIMEOUT, send(2, "?99.2", false), "counter overflow"); /* as a CM1 has it */
    stop();
}
END_TEST

START_TEST(test_a_silent_and_a_broken_line)
{
    start();
    ck_assert_int_eq(send(1, "?99.1", false), CM1E_OK);
    exchange.timeout_ns = 50000000;
    exchange.text = "?1234.1";
    fails(CM1E_ERROR_CML_TIMEOUT, cm1e_cml_exchange(bus, &exchange, &diag), "within 50 ms");
    simulate("unplug 2");
    const cm1e_error_t error = send(1, "?99.1", false);
    ck_assert(error != CM1E_OK);
    ck_assert_int_gt(strlen(diag.text), 20);
    stop();
}
END_TEST

static const char *event;
static bool something_happens(void *context)
{
    if (++asked == *(int *)context)
        simulate(event);
    return false;
}

/* The end of a line is missing: it was cut on its way. */
static bool answer_is_cut(void *context)
{
    cm1e_sim_cml_t *cml = &motor(1)->cml;
    (void)context;
    if (cml->count > 0)
        strcpy(cml->lines[cml->first].text, "Ux.1=");
    return false;
}

START_TEST(test_a_transfer_that_fails_ends_the_string)
{
    int calls = 4;
    start();
    ck_assert_msg(send(1, "?99.1", false) == CM1E_OK, "%s", diag.text);
    asked = 0;
    event = "unplug 2";
    exchange = (cm1e_cml_exchange_t){.position = 2, .channel = 1, .text = "?99.1", .cancelled = something_happens,
                                     .context = &calls};
    ck_assert_int_eq(cm1e_cml_exchange(bus, &exchange, &diag), CM1E_ERROR_TIMEOUT);
    ck_assert_msg(strstr(diag.text, "did not read object 0xF591"), "%s", diag.text);
    stop();
}
END_TEST

/* The motor tells its list several times: at its last line it begins anew. */
static int list_begins;
static bool list_begins_again(void *context)
{
    cm1e_sim_cml_t *cml = &motor(1)->cml;
    (void)context;
    if (list_begins > 0 && cml->list_next > 60) {
        cml->list_next = 20;
        list_begins--;
    }
    return false;
}

START_TEST(test_lines_that_find_no_room_are_counted)
{
    start();
    ck_assert_msg(send(1, "?90.1", false) == CM1E_OK, "%s", diag.text);
    const unsigned lines = exchange.count;
    ck_assert_uint_eq(exchange.lost, 0);
    list_begins = 3;
    exchange.cancelled = list_begins_again;
    ck_assert_msg(cm1e_cml_exchange(bus, &exchange, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_uint_eq(exchange.count, CM1E_CML_LINES);
    ck_assert_uint_ge(exchange.count + exchange.lost, 3 * lines);
    stop();
}
END_TEST

START_TEST(test_a_search_without_origin_and_a_damaged_answer_are_told)
{
    int calls = 300;
    start();
    ck_assert_msg(send(2, "(.2", true) == CM1E_OK, "%s", diag.text);
    asked = 0;
    event = "motor 2 2 error overload";
    exchange = (cm1e_cml_exchange_t){.position = 2, .channel = 2, .text = "|.2", .allow_motion = true,
                                     .cancelled = something_happens, .context = &calls};
    fails(CM1E_ERROR_CM_SEARCH, cm1e_cml_exchange(bus, &exchange, &diag), "the motor says \"Ux.2=");
    ck_assert(motor(2)->motor_free);
    ck_assert_msg(send(1, "?99.1", false) == CM1E_OK, "%s", diag.text);
    exchange.cancelled = answer_is_cut;
    fails(CM1E_ERROR_CML_ANSWER, cm1e_cml_exchange(bus, &exchange, &diag), "damaged: \"Ux.1=\"");
    stop();
}
END_TEST

/* Whoever interrupts an origin search has a motor without torque, and a bridge that goes back to csp. */
START_TEST(test_a_search_that_is_cancelled_frees_the_motor)
{
    start();
    ck_assert_msg(send(2, "(.2", true) == CM1E_OK, "%s", diag.text);
    ck_assert(!motor(2)->motor_free);
    int most = 300;
    asked = 0;
    exchange = (cm1e_cml_exchange_t){.position = 2, .channel = 2, .text = "|.2", .allow_motion = true,
                                     .cancelled = after_a_while, .context = &most};
    fails(CM1E_ERROR_CANCELLED, cm1e_cml_exchange(bus, &exchange, &diag), "cancelled");
    ck_assert(motor(2)->motor_free);
    ck_assert(!cm1e_sim_search_running(&motor(2)->search));
    ck_assert_msg(cm1e_cml_leave(bus, 2, 2, true, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_msg(send(1, "(.1", true) == CM1E_OK && send(1, "|.1", true) == CM1E_OK, "%s", diag.text);
    ck_assert_str_eq(exchange.lines[0], "Origin.1=0");
    ck_assert(!motor(1)->motor_free);
    watch_wire();
    ck_assert_msg(cm1e_cml_leave(bus, 2, 1, true, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert(motor(1)->motor_free);
    const sdo_seen_t *freed = find_sdo(0, true, 0xF581, NULL), *mode = find_sdo(0, true, 0x6060, NULL);
    ck_assert_str_eq(freed->data, ").1");
    ck_assert_int_ge(mode->sent_ns - freed->answered_ns, 3 * CM1E_BRIDGE_MODE_INTERVAL_NS); /* it arrives before */
    stop();
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("cml_exchange");
    TCase *tests = tcase_create("exchange");
    tcase_add_test(tests, test_answers_and_the_way_back);
    tcase_add_test(tests, test_only_modes_that_are_needed_are_written);
    tcase_add_test(tests, test_a_mode_is_not_written_at_once);
    tcase_add_test(tests, test_a_mode_that_cannot_be_read_is_an_error);
    tcase_add_test(tests, test_an_answer_that_comes_too_late_is_shown_as_stray);
    tcase_add_test(tests, test_what_is_refused_reaches_no_motor);
    tcase_add_test(tests, test_a_motor_in_cmd_or_with_an_error_is_left_alone);
    tcase_add_test(tests, test_a_silent_and_a_broken_line);
    tcase_add_test(tests, test_a_search_that_is_cancelled_frees_the_motor);
    tcase_add_test(tests, test_a_transfer_that_fails_ends_the_string);
    tcase_add_test(tests, test_lines_that_find_no_room_are_counted);
    tcase_add_test(tests, test_a_search_without_origin_and_a_damaged_answer_are_told);
    suite_add_tcase(suite, tests);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? 1 : 0;
}
