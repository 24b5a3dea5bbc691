/* Axes behind the simulated bridge, an EB12: homing by every method, with what may go wrong in it. */
#include "axis/axis_parameters.h"
#include "axis/axis_parts.h"
#include "homing/homing_private.h"

#include "../support/axes_behind_bridge.h" /* behind the others: it makes a macro of `axis` */

/* ---- homing ------------------------------------------------------------------------------------------------------ */

/* Stops at 250,000 counts to either side, switches at 150,000; a stop is left by two teeth. */
static const struct {
    int8_t method;
    double reference, tolerance;
} methods[] = {{1, 248500, 1500}, {2, -248500, 1500}, {3, 150000, 30}, {4, -150000, 30}};
enum { METHODS = 4 };

START_TEST(test_every_method_homes_both_kinds_of_motor)
{
    const int n = _i / METHODS % 2 ? CM2 + 1 : CM1 + 1, method = _i % METHODS;
    const bool invert = _i >= 2 * METHODS;
    describe_bridge();
    config.axes[n].invert = invert;
    open_enabled();
    const double there = shaft(n);
    const cm1e_homing_config_t homing = {.method = methods[method].method, .velocity = 2.0, .acceleration = 40.0,
                                         .torque = 50.0};
    for (int round = 0; round < 2; round++) {
        finish(n, home_of(n, 33.0, &homing), 20.0);
        ck_assert(info_of(n).homed && info_of(n).powered);
        ck_assert_int_eq(info_of(n).state, CM1E_AXIS_STANDSTILL);
        ck_assert_int_eq(info_of(n).mode, CM1E_MODE_CSP);
        ck_assert_double_eq_tol(info_of(n).actual_position, 33.0, 0.01);
        cycles(200);
        ck_assert_msg(fabs(shaft(n) - methods[method].reference) <= methods[method].tolerance, "the shaft is at %.0f",
                      shaft(n));
        ck_assert_int_le(llabs(cm1e_sim_bridge_position(motor(n))), 10); /* "the drive's end position is 0" */
    }
    const double reference = shaft(n), way = there > reference ? 1.0 : -1.0;
    finish(n, move_of(n, 33.0 + (invert ? -way : way), 2.0), 5.0);
    cycles(200);
    ck_assert_double_eq_tol(shaft(n), reference + way * 50000.0, 60.0);
    for (int other = 0; other < AXES; other++)
        if (other != n)
            ck_assert_double_eq_tol(shaft(other), 0.0, 2.0);
    close_segment();
}
END_TEST

/* K42 in 100 pulses/s, K43 in 1000 pulses/s2, by the sub-index of the method; defaults by the motor. */
START_TEST(test_parameters_are_written_in_the_units_of_the_motor)
{
    static const struct {
        int axis_number;
        cm1e_homing_config_t homing;
        int64_t speed, acceleration, torque, offset;
    } rows[] = {
        {CM1, {.method = 3}, 100, 100, 30, 0},
        {CM2, {.method = 1}, 10, 100, 30, 0},
        {CM1, {.method = 2, .velocity = 2.0, .acceleration = 20.0, .torque = 55.0, .offset = 0.5}, 1000, 1000, 55, 250},
        {CM2, {.method = 4, .velocity = 1.0012, .acceleration = 30.009, .offset = 0.1}, 501, 1500, 30, 50},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        const int n = rows[i].axis_number;
        describe_bridge();
        open_enabled();
        const cm1e_command_id_t id = home_of(n, 0.0, &rows[i].homing);
        while (status_of(n, id).state == CM1E_COMMAND_ACTIVE && axes[n]->homing->drive.step != HOME_RUN)
            cycles(1);
        ck_assert_msg(axes[n]->homing->drive.step == HOME_RUN, "%s", text_of(n));
        const cm1e_sim_bridge_t *bridge = cm1e_sim_bridge_of(
            cm1e_sim_segment_slave(cm1e_bus_segment(bus), 1));
        ck_assert_int_eq(*cm1e_sim_bridge_value(bridge, (unsigned)n, 0x6098, 0), rows[i].homing.method);
        ck_assert_int_eq(*cm1e_sim_bridge_k(bridge, (unsigned)n, 42), rows[i].speed);
        ck_assert_int_eq(*cm1e_sim_bridge_k(bridge, (unsigned)n, 43), rows[i].acceleration);
        ck_assert_int_eq(*cm1e_sim_bridge_k(bridge, (unsigned)n, 47), rows[i].torque);
        ck_assert_int_eq(*cm1e_sim_bridge_k(bridge, (unsigned)n, 48), rows[i].offset);
        close_segment();
    }
}
END_TEST

/* With K37 = 0 a revolution of a CM1 has 200 pulses, with 3 it has 1000: K42's default would be 50 and 10 of them a
 * second. */
START_TEST(test_a_homing_speed_by_default_is_no_more_than_a_revolution_a_second)
{
    static const struct { uint8_t k37; int64_t speed; } rows[] = {{0, 2}, {3, 10}, {10, 100}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        describe_bridge();
        config.axes[CM1].k37 = rows[i].k37;
        open_enabled();
        const cm1e_command_id_t id = home_of(CM1, 0.0, &(cm1e_homing_config_t){.method = 1});
        while (status_of(CM1, id).state == CM1E_COMMAND_ACTIVE && axes[CM1]->homing->drive.step != HOME_RUN)
            cycles(1);
        const cm1e_sim_bridge_t *bridge = cm1e_sim_bridge_of(
            cm1e_sim_segment_slave(cm1e_bus_segment(bus), 1));
        ck_assert_int_eq(*cm1e_sim_bridge_k(bridge, (unsigned)CM1, 42), rows[i].speed);
        close_segment();
    }
}
END_TEST

static void set_k45(int n, double value)
{
    uint32_t ticket;
    cm1e_error_t error = cm1e_axis_object_start(axes[n], 1045, true, value, &ticket);
    ck_assert_int_eq(error, CM1E_OK);
    double written;
    while (cm1e_axis_object_state(axes[n], ticket, &written, &error) < CM1E_COMMAND_DONE)
        cycles(1);
    ck_assert_int_eq(error, CM1E_OK);
}

/* The offset of a CM2 counts in 100, 10 or 1 pulses by the second digit of its K45; a CM1's always in 100. */
START_TEST(test_the_offset_goes_by_k45_of_a_cm2)
{
    static const struct {
        int axis_number;
        double k45, asked, moved; /* counts */
    } rows[] = {{CM1, 0, -1249, -1200}, {CM1, 10, -1249, -1200}, {CM2, 0, -1249, -1200}, {CM2, 11, -1249, -1250},
                {CM2, 120, -1249, -1249}, {CM2, 30, 0, 0}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        const int n = rows[i].axis_number;
        describe_bridge();
        open_enabled();
        set_k45(n, rows[i].k45);
        cm1e_homing_config_t homing = config.axes[n].homing;
        homing.offset = rows[i].asked / 50000.0;
        finish(n, home_of(n, 0.0, &homing), 20.0);
        ck_assert_double_eq_tol(shaft(n), 150000.0 + rows[i].moved, 6.0);
        close_segment();
    }
}
END_TEST

static void refused_homing(int n, cm1e_homing_config_t homing, cm1e_error_t error, const char *words)
{
    cm1e_command_id_t id;
    const cm1e_axis_command_t command = {.kind = CM1E_COMMAND_HOME, .homing = &homing};
    ck_assert_int_eq(cm1e_axis_start(axes[n], &command, &id), error);
    told(n, words);
    ck_assert_int_eq(info_of(n).state, CM1E_AXIS_STANDSTILL);
}

START_TEST(test_what_is_wrong_with_a_homing_is_told_before_it_begins)
{
    describe_bridge();
    open_enabled();
    for (int n = 0; n < AXES; n++) {
        refused_homing(n, (cm1e_homing_config_t){.method = 0}, CM1E_ERROR_AXIS_HOMING_METHOD, "1 ... 4 is right");
        refused_homing(n, (cm1e_homing_config_t){.method = -1}, CM1E_ERROR_AXIS_HOMING_METHOD, "1 ... 4 is right");
        refused_homing(n, (cm1e_homing_config_t){.method = 5}, CM1E_ERROR_AXIS_HOMING_METHOD, "1 ... 4 is right");
        refused_homing(n, (cm1e_homing_config_t){.method = 1, .torque = 101.0}, CM1E_ERROR_AXIS_HOMING_PARAMETER,
                       "10 ... 100 %");
        refused_homing(n, (cm1e_homing_config_t){.method = 1, .velocity = 0.0009}, CM1E_ERROR_AXIS_HOMING_PARAMETER,
                       "0.002 ... ");
        refused_homing(n, (cm1e_homing_config_t){.method = 1, .acceleration = 0.009},
                       CM1E_ERROR_AXIS_HOMING_PARAMETER, "0.02 ... ");
        refused_homing(n, (cm1e_homing_config_t){.method = 1, .offset = 65.6}, CM1E_ERROR_AXIS_HOMING_PARAMETER,
                       "-65.534 ... 65.534 u");
    }
    /* 5000 and 32767 times 100 pulses/s and 1000 pulses/s2 */
    refused_homing(CM1, (cm1e_homing_config_t){.method = 1, .velocity = 10.01}, CM1E_ERROR_AXIS_HOMING_PARAMETER,
                   "0.002 ... 10 u/s");
    refused_homing(CM2, (cm1e_homing_config_t){.method = 1, .velocity = 65.6}, CM1E_ERROR_AXIS_HOMING_PARAMETER,
                   "0.002 ... 65.534 u/s");
    refused_homing(CM1, (cm1e_homing_config_t){.method = 1, .acceleration = 100.1},
                   CM1E_ERROR_AXIS_HOMING_PARAMETER, "0.02 ... 100 u/s2");
    refused_homing(CM2, (cm1e_homing_config_t){.method = 1, .acceleration = 656.0},
                   CM1E_ERROR_AXIS_HOMING_PARAMETER, "0.02 ... 655.34 u/s2");
    for (int n = 0; n < AXES; n++)
        ck_assert_double_eq_tol(shaft(n), 0.0, 2.0);
    close_segment();
}
END_TEST

/* What K45 says is known only when it has been read: the homing ends in an error, without having left csp. */
START_TEST(test_an_offset_that_k45_does_not_allow_ends_the_homing)
{
    static const struct {
        double k45, offset;
        const char *words;
    } rows[] = {{20, 1.0, "-0.65534 ... 0.65534 u"}, {10, 7.0, "-6.5534 ... 6.5534 u"}, {30, 1.0, "K45 = 30"}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        describe_bridge();
        open_enabled();
        set_k45(CM2, rows[i].k45);
        cm1e_homing_config_t homing = config.axes[CM2].homing;
        homing.offset = rows[i].offset;
        const cm1e_command_status_t end = wait_for(CM2, home_of(CM2, 0.0, &homing), 5.0);
        ck_assert_int_eq(end.state, CM1E_COMMAND_ERROR);
        ck_assert_int_eq(end.error, CM1E_ERROR_AXIS_HOMING_PARAMETER);
        told(CM2, rows[i].words);
        ck_assert_int_eq(info_of(CM2).state, CM1E_AXIS_STANDSTILL);
        ck_assert_double_eq_tol(shaft(CM2), 0.0, 2.0);
        finish(CM2, home_of(CM2, 0.0, NULL), 20.0); /* and is no reason not to home without it */
        close_segment();
    }
}
END_TEST

/* A load that swings the motor: the mode is not switched, and the text tells what to look for. */
START_TEST(test_a_motor_that_does_not_come_to_rest_is_not_homed)
{
    describe_bridge();
    open_enabled();
    const cm1e_command_id_t id = home_of(CM2, 0.0, NULL);
    char order[40];
    for (int i = 0; i < 20000 && status_of(CM2, id).state == CM1E_COMMAND_ACTIVE; i++) {
        snprintf(order, sizeof order, "motor 1 %d load %s", CM2 + 1, i / 20 % 2 ? "0.05" : "-0.05");
        if (i % 20 == 0)
            simulate(order);
        cycles(1);
    }
    ck_assert_int_eq(status_of(CM2, id).state, CM1E_COMMAND_ERROR);
    ck_assert_int_eq(status_of(CM2, id).error, CM1E_ERROR_AXIS_NOT_AT_REST);
    told(CM2, "the mode is switched at rest: look for a load that moves the motor");
    ck_assert_int_eq(info_of(CM2).state, CM1E_AXIS_STANDSTILL);
    snprintf(order, sizeof order, "motor 1 %d load 0", CM2 + 1);
    simulate(order);
    cycles(300);
    finish(CM2, home_of(CM2, 0.0, NULL), 20.0);
    close_segment();
}
END_TEST

/* ---- the end of a homing, at any time ---------------------------------------------------------------------------- */

enum ending { BY_STOP = 0, BY_POWER, BY_DIRECTION, BY_SHUT_DOWN, ENDINGS };

static void end_homing(int n, int ending)
{
    cm1e_command_id_t stop;
    switch (ending) {
    case BY_STOP:
        stop = start_of(n, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_STOP});
        finish(n, stop, 3.0);
        cm1e_axis_hold_stop(axes[n], stop, false);
        cycles(3);
        break;
    case BY_POWER:
        power_of(n, false);
        cycles(1500);
        ck_assert_int_eq(info_of(n).state, CM1E_AXIS_DISABLED);
        power_of(n, true);
        cycles(300);
        break;
    case BY_DIRECTION:
        ck_assert_int_eq(cm1e_axis_power(axes[n], &owner, true, true, false), CM1E_OK);
        cycles(1500);
        power_of(n, true);
        cycles(300);
        break;
    default:
        for (int i = 0; i < 2000; i++) {
            inputs();
            (void)cm1e_axis_shut_down(axes[n]);
            outputs();
        }
        ck_assert(cm1e_axis_shut_down(axes[n]));
        ck_assert(motor(n)->motor_free);
        power_of(n, true);
        cycles(300);
        break;
    }
}

/* Every part of the sequence is hit: transfers, switches, the search at speed, its end, the way back. */
START_TEST(test_a_homing_is_ended_at_every_moment)
{
    const int ending = _i % ENDINGS, n = _i / ENDINGS ? CM2 : CM1;
    describe_bridge();
    open_enabled();
    bool seen[HOME_RETURN + 1] = {0};
    const cm1e_homing_config_t homing = {.method = 3, .velocity = 8.0, .acceleration = 90.0};
    for (int after = 0; after < 900; after += after < 300 ? 2 : 29) {
        finish(n, move_of(n, info_of(n).actual_position + (100000.0 - shaft(n)) / 50000.0, 10.0), 10.0);
        cycles(100);
        const cm1e_command_id_t id = home_of(n, 5.0, &homing);
        for (int i = 0; i < after && status_of(n, id).state == CM1E_COMMAND_ACTIVE; i++)
            cycles(1);
        const bool ended = status_of(n, id).state != CM1E_COMMAND_ACTIVE;
        seen[axes[n]->homing->drive.step] = true;
        end_homing(n, ending);
        ck_assert_msg(info_of(n).state == CM1E_AXIS_STANDSTILL, "after %d: %s %s", after,
                      cm1e_axis_state_name(info_of(n).state), text_of(n));
        ck_assert(ended || status_of(n, id).state != CM1E_COMMAND_DONE);
        const double before = shaft(n);
        cycles(60);
        ck_assert_msg(fabs(shaft(n) - before) < 5.0, "after %d it moves on from %.0f to %.0f", after, before, shaft(n));
        ck_assert_int_eq(info_of(n).mode, CM1E_MODE_CSP);
        ck_assert_double_eq_tol(info_of(n).set_position, info_of(n).actual_position, 0.01);
    }
    for (int step = n == CM2 ? HOME_READ : HOME_REST; step <= HOME_RUN; step++)
        ck_assert_msg(seen[step], "step %d was not hit", step);
    close_segment();
}
END_TEST

START_TEST(test_an_error_of_the_motor_ends_its_homing_at_any_time)
{
    const int n = _i % 2 ? CM2 : CM1, fault = _i / 2;
    describe_bridge();
    open_enabled();
    for (int after = 1; after < 700; after += 41) {
        const cm1e_command_id_t move = move_of(AXES - 1 - n, after % 2 ? 2.0 : 0.0, 1.0);
        const cm1e_command_id_t id = home_of(n, 0.0, NULL);
        for (int i = 0; i < after && status_of(n, id).state == CM1E_COMMAND_ACTIVE; i++)
            cycles(1);
        fault_of(n, fault);
        cycles(200);
        ck_assert_msg(info_of(n).state == CM1E_AXIS_ERROR_STOP, "after %d", after);
        ck_assert(status_of(n, id).state != CM1E_COMMAND_ACTIVE);
        finish(AXES - 1 - n, move, 5.0);
        repair(n, fault);
        const double there = shaft(n);
        cycles(50);
        ck_assert_double_eq_tol(shaft(n), there, 3.0);
        finish(n, move_of(n, info_of(n).actual_position + (0.0 - there) / 50000.0, 10.0), 10.0);
    }
    close_segment();
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("homing of axes behind a bridge");
    TCase *tcase = tcase_create("all");
    suite_add_tcase(suite, tcase);
    tcase_set_timeout(tcase, 120);
    tcase_add_loop_test(tcase, test_every_method_homes_both_kinds_of_motor, 0, 4 * METHODS);
    tcase_add_test(tcase, test_parameters_are_written_in_the_units_of_the_motor);
    tcase_add_test(tcase, test_a_homing_speed_by_default_is_no_more_than_a_revolution_a_second);
    tcase_add_test(tcase, test_the_offset_goes_by_k45_of_a_cm2);
    tcase_add_test(tcase, test_what_is_wrong_with_a_homing_is_told_before_it_begins);
    tcase_add_test(tcase, test_an_offset_that_k45_does_not_allow_ends_the_homing);
    tcase_add_test(tcase, test_a_motor_that_does_not_come_to_rest_is_not_homed);
    tcase_add_loop_test(tcase, test_a_homing_is_ended_at_every_moment, 0, 2 * ENDINGS);
    tcase_add_loop_test(tcase, test_an_error_of_the_motor_ends_its_homing_at_any_time, 0, 2 * FAULTS);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
