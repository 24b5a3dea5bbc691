/* CML without a cycle, as tools do it: cm1e_cml_exchange() and cm1e_cml_leave() on a simulated bridge that has only
 * been scanned. */
#include "cm1e/cml.h"
#include "nic/nic.h"
#include "sim/bridge_app.h"

#include "axis_segment.h"

static cm1e_cml_exchange_t exchange;

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

static void stop(void)
{
    cm1e_bus_close(bus);
    bus = NULL;
}

static const cm1e_sim_bridge_axis_t *motor(unsigned channel)
{
    cm1e_sim_slave_t *slave = cm1e_sim_segment_slave(cm1e_bus_segment(bus), 2);
    return &cm1e_sim_bridge_of(slave)->axes[channel - 1];
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

START_TEST(test_what_is_refused_reaches_no_motor)
{
    start();
    fails(CM1E_ERROR_CML_MOTION, send(1, "|.1", false), "allowed");
    fails(CM1E_ERROR_CML_STRING, send(1, "", true), "is empty");
    fails(CM1E_ERROR_CML_STRING, send(1, NULL, true), "is missing");
    fails_for_time(-1);
    fails_for_time(INT64_MAX);
    fails(CM1E_ERROR_INVALID_ARGUMENT, cm1e_cml_exchange(NULL, &exchange, &diag), "needs a bus");
    fails(CM1E_ERROR_INVALID_ARGUMENT, cm1e_cml_leave(NULL, 2, 1, false, &diag), "needs a bus");
    fails(CM1E_ERROR_CML_STRING, send(1, "?99.2", true), "another motor");
    fails(CM1E_ERROR_INVALID_ARGUMENT, send(0, "?99", false), "connector 0");
    fails(CM1E_ERROR_INVALID_ARGUMENT, send(5, "?99", false), "1 ... 4");
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

static int asked;
static bool after_a_while(void *context)
{
    return ++asked > *(int *)context;
}

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
    ck_assert_msg(cm1e_cml_leave(bus, 2, 1, true, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert(motor(1)->motor_free);
    stop();
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("cml_exchange");
    TCase *tests = tcase_create("exchange");
    tcase_add_test(tests, test_answers_and_the_way_back);
    tcase_add_test(tests, test_what_is_refused_reaches_no_motor);
    tcase_add_test(tests, test_a_motor_in_cmd_or_with_an_error_is_left_alone);
    tcase_add_test(tests, test_a_silent_and_a_broken_line);
    tcase_add_test(tests, test_a_search_that_is_cancelled_frees_the_motor);
    suite_add_tcase(suite, tests);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? 1 : 0;
}
