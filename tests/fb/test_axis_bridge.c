/* Axes behind the simulated bridge, an EB12: power, moves, errors of one motor that are none of the others, signals by
 * SDO, parameters. */
#include "axis/axis_parameters.h"
#include "axis/axis_signals.h"

#include "../support/axes_behind_bridge.h" /* behind the others: it makes a macro of `axis` */

/* ---- power and moves --------------------------------------------------------------------------------------------- */

START_TEST(test_four_motors_are_enabled_and_moved_side_by_side)
{
    describe_bridge();
    open_segment();
    cycles(50);
    double before[AXES];
    for (int n = 0; n < AXES; n++)
        before[n] = shaft(n);
    enable_all();
    for (int n = 0; n < AXES; n++)
        ck_assert_double_eq_tol(shaft(n), before[n], 2.0);
    cm1e_command_id_t ids[AXES];
    for (int n = 0; n < AXES; n++)
        ids[n] = move_of(n, n % 2 ? -1.0 - n : 1.0 + n, 10.0);
    for (int n = 0; n < AXES; n++)
        finish(n, ids[n], 5.0);
    cycles(300);
    for (int n = 0; n < AXES; n++) {
        ck_assert_double_eq_tol(shaft(n), 50000.0 * (n % 2 ? -1.0 - n : 1.0 + n), 60.0);
        ck_assert_double_eq_tol(info_of(n).actual_position, info_of(n).set_position, 0.01);
        power_of(n, false);
    }
    cycles(100);
    for (int n = 0; n < AXES; n++) {
        ck_assert_int_eq(info_of(n).state, CM1E_AXIS_DISABLED);
        ck_assert(motor(n)->motor_free);
    }
    close_segment();
}
END_TEST

/* ---- errors of one motor ----------------------------------------------------------------------------------------- */

START_TEST(test_an_error_of_one_motor_stops_that_axis_alone)
{
    const int n = _i % 2 ? CM2 : CM1, fault = _i / 2;
    describe_bridge();
    open_enabled();
    cm1e_command_id_t ids[AXES];
    for (int other = 0; other < AXES; other++)
        ids[other] = move_of(other, 3.0, 2.0);
    cycles(500);
    fault_of(n, fault);
    cycles(100);
    ck_assert_int_eq(info_of(n).state, CM1E_AXIS_ERROR_STOP);
    ck_assert_int_eq(status_of(n, ids[n]).state, CM1E_COMMAND_ERROR);
    for (int other = 0; other < AXES; other++)
        if (other != n) {
            finish(other, ids[other], 5.0);
            ck_assert_int_eq(info_of(other).error, CM1E_OK);
        }
    repair(n, fault);
    const double there = shaft(n);
    cycles(100);
    ck_assert_double_eq_tol(shaft(n), there, 3.0);
    finish(n, move_of(n, info_of(n).actual_position + 0.5, 2.0), 5.0);
    close_segment();
}
END_TEST

START_TEST(test_a_bridge_that_is_lost_stops_all_its_axes)
{
    describe_bridge();
    open_enabled();
    for (int n = 0; n < AXES; n++)
        move_of(n, 3.0, 2.0);
    cycles(300);
    simulate("unplug 1");
    cycles(500);
    for (int n = 0; n < AXES; n++) {
        ck_assert_int_eq(info_of(n).state, CM1E_AXIS_ERROR_STOP);
        ck_assert(!info_of(n).homed);
        ck_assert(motor(n)->motor_free);
    }
    close_segment();
}
END_TEST

/* ---- signals ----------------------------------------------------------------------------------------------------- */

static cm1e_error_t input_of(int n, int number, bool *value)
{
    cm1e_error_t error = cm1e_axis_read_input(axes[n], number, value);
    for (int i = 0; i < 200 && error == CM1E_ERROR_BUSY; i++) {
        cycles(1);
        error = cm1e_axis_read_input(axes[n], number, value);
    }
    return error;
}

START_TEST(test_inputs_come_by_sdo_while_somebody_reads_them)
{
    describe_bridge();
    open_enabled();
    for (int n = 0; n < AXES; n++)
        for (int number = 0; number <= 7; number++) {
            const bool there = n < CM2 ? number >= 2 && number <= 4 : number >= 1 && number <= 6;
            bool value;
            ck_assert_int_eq(input_of(n, number, &value), there ? CM1E_OK : CM1E_ERROR_AXIS_SIGNAL);
            ck_assert(!value);
        }
    finish(CM1, move_of(CM1, 3.1, 10.0), 5.0);
    cycles(300);
    bool value;
    ck_assert_int_eq(input_of(CM1, 2, &value), CM1E_OK);
    ck_assert(value); /* beyond 150,000 counts */
    ck_assert(info_of(CM1).digital_known);
    cycles(1500);
    ck_assert(!info_of(CM1).digital_known);
    power_of(CM1, false);
    cycles(200);
    ck_assert_int_eq(cm1e_axis_read_input(axes[CM1], 2, &value), CM1E_ERROR_AXIS_NOT_POWERED);
    close_segment();
}
END_TEST

static cm1e_error_t write_output(int n, int number, bool value)
{
    cm1e_error_t error = cm1e_axis_write_output(axes[n], number, value);
    cm1e_command_state_t state = CM1E_COMMAND_ACTIVE;
    for (int i = 0; i < 200 && error == CM1E_OK && state == CM1E_COMMAND_ACTIVE; i++) {
        cycles(1);
        state = cm1e_axis_output_state(axes[n], number, &error);
    }
    ck_assert(error != CM1E_OK || state == CM1E_COMMAND_DONE);
    return error;
}

START_TEST(test_outputs_go_by_sdo_and_are_done_when_they_are_there)
{
    describe_bridge();
    open_enabled();
    for (int n = 0; n < AXES; n++)
        for (int number = 0; number <= 5; number++) {
            const bool there = n < CM2 ? number == 2 : number >= 1 && number <= 4;
            for (int on = 1; on >= 0; on--) {
                ck_assert_int_eq(write_output(n, number, on), there ? CM1E_OK : CM1E_ERROR_AXIS_SIGNAL);
                ck_assert_int_eq(motor(n)->outputs, there && on ? 1 << (number - 1) : 0);
            }
            if (!there)
                told(n, n < CM2 ? "output 2" : "outputs 1 ... 4");
        }
    ck_assert_int_eq(write_output(CM2, 3, true), CM1E_OK);
    for (int i = 0; i < 1000; i++) { /* the end of a run: off before the torque goes */
        inputs();
        for (int n = 0; n < AXES; n++)
            (void)cm1e_axis_shut_down(axes[n]);
        outputs();
        ck_assert(!motor(CM2)->motor_free || motor(CM2)->outputs == 0);
    }
    ck_assert(motor(CM2)->motor_free);
    ck_assert_int_eq(cm1e_axis_write_output(axes[CM2], 1, true), CM1E_ERROR_AXIS_NOT_POWERED);
    told(CM2, "while the motor is enabled in csp");
    close_segment();
}
END_TEST

START_TEST(test_what_needs_signals_in_the_cycle_is_refused)
{
    describe_bridge();
    for (int n = 0; n < AXES; n++)
        config.axes[n].inputs = (cm1e_input_config_t){.limit_positive = 2, .limit_negative = 3, .home = 4};
    open_enabled();
    for (int n = 0; n < AXES; n++) {
        uint32_t id;
        double torque;
        const cm1e_axis_trigger_t trigger = {.input = 2};
        ck_assert_int_eq(cm1e_axis_probe(axes[n], trigger, false, 0, 0, &id), CM1E_ERROR_PDO_MAPPING);
        told(n, "CPIO");
        ck_assert_int_eq(cm1e_axis_hold_output(axes[n], 2, true, 1000), CM1E_ERROR_PDO_MAPPING);
        ck_assert_int_eq(cm1e_axis_read_torque(axes[n], &torque), CM1E_ERROR_PDO_MAPPING);
        ck_assert(!info_of(n).torque_known && !info_of(n).temperature_known && !info_of(n).dc_link_known);
        const cm1e_homing_step_t steps[] = {
            {.kind = CM1E_STEP_ABSOLUTE_SWITCH, .direction = mcPositiveDirection},
            {.kind = CM1E_STEP_LIMIT_SWITCH, .direction = mcPositiveDirection},
            {.kind = CM1E_STEP_BLOCK, .direction = mcPositiveDirection, .torque_limit = 30.0},
        };
        for (size_t i = 0; i < sizeof steps / sizeof steps[0]; i++) {
            cm1e_command_id_t unused;
            const cm1e_axis_command_t c = {.kind = CM1E_COMMAND_HOMING_STEP, .velocity = 1.0, .step = &steps[i]};
            ck_assert_int_eq(cm1e_axis_start(axes[n], &c, &unused), CM1E_ERROR_PDO_MAPPING);
            told(n, "CPIO");
        }
    }
    close_segment();
}
END_TEST

/* By lag: without torque, against the stop at 250,000 counts. */
START_TEST(test_a_step_against_a_stop_needs_no_signal)
{
    describe_bridge();
    config.axes[CM2].max_position_lag = 0.2;
    open_enabled();
    const cm1e_homing_step_t step = {.kind = CM1E_STEP_BLOCK, .direction = mcPositiveDirection,
                                       .time_limit_ns = 20000000000};
    finish(CM2, start_of(CM2, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_HOMING_STEP, .position = 4.0, .velocity = 1.0,
                                                      .step = &step}), 20.0);
    ck_assert_double_eq_tol(shaft(CM2), 250000.0, 3000.0);
    const cm1e_homing_step_t last = {.kind = CM1E_STEP_FINISH};
    finish(CM2, start_of(CM2, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_HOMING_STEP, .position = -1.0,
                                                     .velocity = 1.0, .step = &last}), 20.0);
    ck_assert_double_eq_tol(info_of(CM2).actual_position, 3.0, 0.1);
    ck_assert(info_of(CM2).homed);
    close_segment();
}
END_TEST

/* ---- parameters -------------------------------------------------------------------------------------------------- */

static cm1e_error_t transfer(int n, int number, bool write, double *value)
{
    uint32_t ticket;
    cm1e_error_t error = cm1e_axis_object_start(axes[n], number, write, *value, &ticket);
    while (error == CM1E_OK && cm1e_axis_object_state(axes[n], ticket, value, &error) < CM1E_COMMAND_DONE)
        cycles(1);
    return error;
}

/* Whatever has a number is read, or is not there in the dictionary of the motor; then the words say so. */
START_TEST(test_every_number_is_an_object_of_the_motor_or_lacks_in_words)
{
    describe_bridge();
    open_enabled();
    for (int n = CM1; n <= CM2; n += CM2)
        for (int number = 1000; number < 1800; number++) {
            double value = 0.0;
            const cm1e_error_t error = transfer(n, number, false, &value);
            ck_assert_msg(error == CM1E_OK || error == CM1E_ERROR_UNSUPPORTED || error == CM1E_ERROR_AXIS_PARAMETER,
                          "%d: %s: %s", number, cm1e_strerror(error), text_of(n));
            if (error == CM1E_ERROR_UNSUPPORTED)
                told(n, n < CM2 ? "behind the bridge a CM1 has no " : "behind the bridge a CM2 has no ");
        }
    double value = 0.0;
    ck_assert_int_eq(transfer(CM1, 1062, false, &value), CM1E_ERROR_UNSUPPORTED);
    told(CM1, "a CM1 has no K62");
    ck_assert_int_eq(transfer(CM1, 1200, false, &value), CM1E_ERROR_UNSUPPORTED);
    ck_assert_int_eq(transfer(CM1, 1502, false, &value), CM1E_ERROR_UNSUPPORTED);
    told(CM1, "no object 0x6077");
    value = 7.0;
    ck_assert_int_eq(transfer(CM2, 1200, true, &value), CM1E_OK);
    value = 0.0;
    ck_assert_int_eq(transfer(CM2, 1200, false, &value), CM1E_OK);
    ck_assert_double_eq(value, 7.0);
    value = 6000.0;
    ck_assert_int_eq(transfer(CM1, 1042, true, &value), CM1E_ERROR_AXIS_PARAMETER_RANGE);
    told(CM1, "1 ... 5000");
    value = 6000.0;
    ck_assert_int_eq(transfer(CM2, 1042, true, &value), CM1E_OK); /* its own object, not that of the first motor */
    ck_assert_int_eq(transfer(CM2, 1402, false, &value), CM1E_OK);
    ck_assert_double_eq(value, 6000.0);
    value = 1.0;
    ck_assert_int_eq(transfer(CM2, 1510, true, &value), CM1E_ERROR_AXIS_PARAMETER_READ_ONLY);
    close_segment();
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("axes behind a bridge");
    TCase *tcase = tcase_create("all");
    suite_add_tcase(suite, tcase);
    tcase_set_timeout(tcase, 120);
    tcase_add_test(tcase, test_four_motors_are_enabled_and_moved_side_by_side);
    tcase_add_loop_test(tcase, test_an_error_of_one_motor_stops_that_axis_alone, 0, 2 * FAULTS);
    tcase_add_test(tcase, test_a_bridge_that_is_lost_stops_all_its_axes);
    tcase_add_test(tcase, test_inputs_come_by_sdo_while_somebody_reads_them);
    tcase_add_test(tcase, test_outputs_go_by_sdo_and_are_done_when_they_are_there);
    tcase_add_test(tcase, test_what_needs_signals_in_the_cycle_is_refused);
    tcase_add_test(tcase, test_a_step_against_a_stop_needs_no_signal);
    tcase_add_test(tcase, test_every_number_is_an_object_of_the_motor_or_lacks_in_words);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
