/**
 * The blocks of Part 5 on the simulated motor, with its sensors and its hard stops: sequences as a program makes them,
 * how well they find the reference, and a fault at every cycle of one.
 */
#include "axis_segment.h"
#include "cm1e/plcopen.h"

/* The shaft, in counts since power-on: home switch on IN2 from here on, a stop to either side. */
enum { SWITCH = 20000, POSITIVE_STOP = 50000, NEGATIVE_STOP = -50000 };
static const double unit = 50000.0;

static const struct {
    const char *firmware;
    cm1e_mapping_t mapping;
    cm1e_pdo_order_t order;
} devices[] = {
    {"1.3.5", CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4}, {"1.3.5", CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_7_2},
    {"1.2.0", CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4}, {"1.2.0", CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_7_2},
    {"1.3.5", CM1E_MAPPING_CSP, CM1E_PDO_ORDER_UG_4_4},     {"1.3.5", CM1E_MAPPING_CSV, CM1E_PDO_ORDER_UG_7_2},
};
enum { DEVICES = sizeof devices / sizeof devices[0] };

static AXIS_REF_t reference;

static void begin(int device)
{
    describe(devices[device].firmware, devices[device].mapping, devices[device].order, 1000000);
    cm1e_axis_config_t *c = &config.axes[0];
    c->sim = (cm1e_sim_axis_config_t){.sensor_input2 = SWITCH, .stop_positive = POSITIVE_STOP,
                                      .stop_negative = NEGATIVE_STOP};
    c->inputs.home = 2;
    c->max_acceleration = 20.0; /* u/s2: gentle, so that the torque of a start is no stop */
    open_segment();
    reference = cm1e_axis_reference(axis);
    enable();
}

/* ---- a program: one step after the other ------------------------------------------------------------------------- */

static struct sequence {
    int step;
    bool by_stop;               /* at the end the hard stop instead of the slow way off the switch */
    MC_StepAbsoluteSwitch_t fast, slow;
    MC_StepBlock_t block;
    MC_FinishHoming_t finish;
    BOOL error;
} program;

static void program_begin(bool by_stop)
{
    memset(&program, 0, sizeof program);
    program.by_stop = by_stop;
    program.fast = (MC_StepAbsoluteSwitch_t){.Axis = &reference, .Direction = mcPositiveDirection, .Velocity = 0.5,
                                             .SwitchMode = mcRisingEdge, .TimeLimit = 3000000000};
    program.slow = (MC_StepAbsoluteSwitch_t){.Axis = &reference, .Direction = mcNegativeDirection, .Velocity = 0.05,
                                             .SwitchMode = mcFallingEdge, .SetPosition = 2.0, .DistanceLimit = 0.5};
    program.block = (MC_StepBlock_t){.Axis = &reference, .Direction = mcNegativeDirection, .Velocity = 0.3,
                                     .TorqueLimit = 30.0, .SetPosition = -7.0, .TimeLimit = 9000000000};
    program.finish = (MC_FinishHoming_t){.Axis = &reference, .Distance = by_stop ? 0.25 : -0.25, .Velocity = 0.5};
}

/* TRUE: through. */
static bool program_scan(void)
{
    program.fast.Execute = program.step == 0;
    program.slow.Execute = program.step == 1 && !program.by_stop;
    program.block.Execute = program.step == 1 && program.by_stop;
    program.finish.Execute = program.step == 2;
    MC_StepAbsoluteSwitch(&program.fast);
    MC_StepAbsoluteSwitch(&program.slow);
    MC_StepBlock(&program.block);
    MC_FinishHoming(&program.finish);
    const BOOL done[] = {program.fast.Done, program.by_stop ? program.block.Done : program.slow.Done,
                         program.finish.Done};
    program.error |= program.fast.Error || program.slow.Error || program.block.Error || program.finish.Error;
    if (program.step < 3 && done[program.step])
        program.step++;
    return program.step == 3;
}

static bool program_cycle(void)
{
    inputs();
    const bool through = program_scan();
    outputs();
    return through;
}

/* Cycles that it took; 0: it did not end. */
static int program_run(int at_most)
{
    for (int n = 1; n <= at_most; n++)
        if (program_cycle())
            return n;
    return 0;
}

/* What the axis calls the place `counts` of the shaft. */
static double called(double counts) { return info().actual_position - (probe().position_counts - counts) / unit; }

START_TEST(test_switch_fast_then_slow_then_away)
{
    begin(_i);
    program_begin(false);
    ck_assert_msg(program_run(6000) > 0, "step %d, error %d, %s", program.step, program.error, text());
    ck_assert_int_eq(info().state, CM1E_AXIS_STANDSTILL);
    ck_assert(info().homed);
    cycles(200);
    /* Half the way of a cycle at 0.05 u/s is 1.25 counts; the motor's own rounding and motion since are another few. */
    const double error = (called(SWITCH) - 2.0) * unit;
    ck_assert_msg(fabs(error) < 6.0, "device %d: the flank is off by %.2f counts", _i, error);
    close_segment();
}
END_TEST

START_TEST(test_switch_then_hard_stop_then_away)
{
    begin(_i);
    program_begin(true);
    ck_assert_msg(program_run(9000) > 0, "step %d, error %d, %s", program.step, program.error, text());
    ck_assert(info().homed);
    cycles(200);
    const double error = (called(NEGATIVE_STOP) + 7.0) * unit;
    ck_assert_msg(fabs(error) < 4.0, "device %d: the stop is off by %.2f counts", _i, error);
    ck_assert_msg(fabs(probe().position_counts - (NEGATIVE_STOP + 0.25 * unit)) < 200.0, "%f", probe().position_counts);
    close_segment();
}
END_TEST

/* After the step the motor stands at the stop, with little torque in it. */
START_TEST(test_block_does_not_go_on_pushing)
{
    begin(_i);
    program_begin(true);
    MC_StepBlock_t *block = &program.block;
    double most = 0.0;
    block->Execute = TRUE;
    for (int n = 0; n < 9000 && !block->Done; n++) {
        inputs();
        MC_StepBlock(block);
        outputs();
        most = fmax(most, fabs(info().actual_torque));
        ck_assert_msg(!block->Error, "%x %s", block->ErrorID, text());
    }
    ck_assert(block->Done && info().state == CM1E_AXIS_HOMING);
    cycles(300);
    ck_assert_msg(fabs(info().actual_torque) < 15.0, "still %.1f %%", info().actual_torque);
    ck_assert_msg(most >= 30.0, "it found the stop without pressing, %.1f %%", most);
    ck_assert_msg(most < 110.0, "it pressed with %.1f %%", most);
    close_segment();
}
END_TEST

/* The motor presses with about TorqueLimit, hardly a count from its set-point. The block that ends the step is not done
 * before nothing presses: the drive would sum up more and more. */
START_TEST(test_end_of_a_step_that_presses_without_lag)
{
    for (int n = 0; n < 10; n++) {
        begin(_i);
        MC_StepBlock_t block = {.Axis = &reference, .Execute = TRUE, .Direction = mcNegativeDirection, .Velocity = 0.3,
                                .TorqueLimit = 30.0, .DetectionVelocityTime = 9000000000};
        MC_FinishHoming_t finish = {.Axis = &reference, .Velocity = 0.5};
        MC_HomeDirect_t direct = {.Axis = &reference};
        const int from = 4600 + 20 * n;
        for (int i = 0; i < from + 1000 && !finish.Done && !direct.Done; i++) {
            inputs();
            finish.Execute = i >= from && n % 2 == 0;
            direct.Execute = i >= from && n % 2 == 1;
            if (i == from)
                ck_assert_msg(info().actual_torque < -25.0, "it does not press: %.1f %%", info().actual_torque);
            MC_StepBlock(&block);
            MC_FinishHoming(&finish);
            MC_HomeDirect(&direct);
            outputs();
        }
        ck_assert(block.CommandAborted && (finish.Done || direct.Done));
        cycles(300);
        ck_assert_msg(fabs(info().actual_torque) < 15.0, "still %.1f %%", info().actual_torque);
        close_segment();
    }
}
END_TEST

START_TEST(test_mc_stop_ends_a_search_in_standstill_not_homed)
{
    begin(0);
    program_begin(false);
    for (int n = 0; n < 300; n++)
        program_cycle();
    MC_Stop_t stop = {.Axis = &reference, .Execute = TRUE};
    for (int n = 0; n < 300; n++) {
        inputs();
        MC_StepAbsoluteSwitch(&program.fast);
        MC_Stop(&stop);
        outputs();
    }
    ck_assert(program.fast.CommandAborted && stop.Done);
    stop.Execute = FALSE;
    inputs();
    MC_Stop(&stop);
    outputs();
    ck_assert_int_eq(info().state, CM1E_AXIS_STANDSTILL);
    ck_assert(!info().homed);
    close_segment();
}
END_TEST

/** The torque that carries a load does not press against anything, also where it is more than half of TorqueLimit. */
START_TEST(test_a_search_for_a_switch_that_ends_leaves_a_load_where_it_is)
{
    begin(_i / 2);
    simulate(_i % 2 ? "load 1 0.05" : "load 1 -0.05");
    cycles(500);
    MC_StepAbsoluteSwitch_t find = {.Axis = &reference, .Execute = TRUE, .Direction = mcPositiveDirection,
                                    .Velocity = 0.1, .SwitchMode = mcRisingEdge, .TorqueLimit = 90.0};
    MC_Stop_t stop = {.Axis = &reference, .Deceleration = 1.0};
    double from = NAN;
    for (int n = 0; n < 3000 && !stop.Done; n++) {
        inputs();
        MC_StepAbsoluteSwitch(&find);
        stop.Execute = n > 1000;
        MC_Stop(&stop);
        outputs();
        if (isnan(from) && n > 1000 && info().set_velocity == 0.0)
            from = info().set_position;
    }
    ck_assert_msg(stop.Done && find.CommandAborted, "%s", text());
    ck_assert_msg(fabs(info().actual_torque) > 45.0, "the load takes %.1f %%", info().actual_torque);
    cycles(300);
    ck_assert_msg(fabs(info().set_position - from) < 1e-9, "it went on by %g u", info().set_position - from);
    close_segment();
}
END_TEST

/** A search so slow that the motor hardly lags when its torque is above half of TorqueLimit at a stop: behind MC_Stop the
 *  drive would sum up more and more. The load that it carries does not count. */
START_TEST(test_a_slow_search_for_a_switch_that_ends_at_a_stop_does_not_press_on)
{
    for (int load = 0; load < 2; load++) {
        begin(_i);
        if (load)
            simulate("load 1 -0.01");
        MC_MoveAbsolute_t go = {.Axis = &reference, .Execute = TRUE, .Position = -0.9998, .Velocity = 1.0};
        for (int n = 0; n < 3000 && !go.Done; n++) {
            inputs();
            MC_MoveAbsolute(&go);
            outputs();
        }
        MC_StepAbsoluteSwitch_t find = {.Axis = &reference, .Execute = TRUE, .Direction = mcNegativeDirection,
                                        .Velocity = 0.0005, .SwitchMode = mcRisingEdge, .TorqueLimit = 90.0};
        MC_Stop_t stop = {.Axis = &reference};
        for (int n = 0; n < 3000 && !stop.Done; n++) {
            inputs();
            MC_StepAbsoluteSwitch(&find);
            stop.Execute |= info().actual_torque < -50.0;
            MC_Stop(&stop);
            outputs();
        }
        ck_assert_msg(stop.Done && find.CommandAborted, "%s", text());
        for (int n = 0; n < 1000; n++) {
            cycles(1);
            ck_assert_msg(fabs(info().actual_torque) < 25.0, "still %.1f %%", info().actual_torque);
        }
        close_segment();
    }
}
END_TEST

/** The motor is beside its set-point, by a load that has just come: what is actual in that cycle gets SetPosition. */
START_TEST(test_home_direct_gives_the_actual_position)
{
    begin(0);
    simulate("load 1 0.05");
    cycles(5);
    const double set = info().set_position;
    double lag = 0;
    MC_HomeDirect_t direct = {.Axis = &reference, .Execute = TRUE, .SetPosition = 42.0};
    for (int n = 0; n < 5 && !info().homed; n++) {
        inputs();
        lag = set - info().actual_position;
        MC_HomeDirect(&direct);
        outputs();
    }
    ck_assert(info().homed && !direct.Error);
    ck_assert_double_ge(fabs(lag), 1e-4);
    ck_assert_double_eq_tol(info().actual_position, 42.0, 1e-9);
    ck_assert_double_eq_tol(info().set_position, 42.0 + lag, 1e-9);
    close_segment();
}
END_TEST

START_TEST(test_home_direct_and_what_the_motor_cannot)
{
    begin(0);
    MC_HomeDirect_t direct = {.Axis = &reference, .Execute = TRUE, .SetPosition = 42.0};
    for (int n = 0; n < 5 && !direct.Done; n++) {
        inputs();
        MC_HomeDirect(&direct);
        outputs();
    }
    ck_assert(direct.Done && !direct.Error && info().homed);
    ck_assert_double_eq(info().set_position, 42.0);

#define CANNOT(TYPE, ERROR)                                                                                          \
    do {                                                                                                             \
        TYPE##_t fb = {.Axis = &reference, .Execute = TRUE};                                                         \
        TYPE(&fb);                                                                                                   \
        ck_assert_msg(fb.Error && !fb.Done && !fb.Busy && !fb.CommandAborted, #TYPE);                                \
        ck_assert_int_eq(fb.ErrorID, cm1e_error_id(ERROR));                                                          \
        ck_assert_msg(strstr(text(), cm1e_strerror(ERROR)) != NULL, "%s", text());                                   \
        fb.Execute = FALSE;                                                                                          \
        TYPE(&fb);                                                                                                   \
        ck_assert_msg(!fb.Error && fb.ErrorID == 0, #TYPE);                                                          \
    } while (0)
    CANNOT(MC_HomeAbsolute, CM1E_ERROR_AXIS_NO_SUCH_SIGNAL);
    CANNOT(MC_StepReferencePulse, CM1E_ERROR_AXIS_NO_SUCH_SIGNAL);
    CANNOT(MC_StepDistanceCoded, CM1E_ERROR_AXIS_NO_SUCH_SIGNAL);
    CANNOT(MC_StepReferenceFlyingRefPulse, CM1E_ERROR_AXIS_NO_SUCH_SIGNAL);
    CANNOT(MC_StepReferenceFlyingSwitch, CM1E_ERROR_UNSUPPORTED);
    CANNOT(MC_AbortPassiveHoming, CM1E_ERROR_UNSUPPORTED);
    CANNOT(MC_StepLimitSwitch, CM1E_ERROR_AXIS_STEP_SWITCH);
    ck_assert(info().homed && info().state == CM1E_AXIS_STANDSTILL);
    close_segment();
}
END_TEST

START_TEST(test_signal_of_another_axis_is_refused)
{
    begin(0);
    MC_StepAbsoluteSwitch_t fb = {.Axis = &reference, .Execute = TRUE, .Velocity = 0.5,
                                  .ReferenceSignal.Axis.Handle = (UINT)(reference.Handle + 1)};
    MC_StepAbsoluteSwitch(&fb);
    ck_assert(fb.Error && fb.ErrorID == cm1e_error_id(CM1E_ERROR_AXIS_STEP_INPUT));
    ck_assert_ptr_nonnull(strstr(text(), "ReferenceSignal.Axis is another axis"));
    close_segment();
}
END_TEST

/* ---- a fault at every cycle of the sequence ---------------------------------------------------------------------- */

static const char *const faults[] = {"power 1 off", "unplug 1", "error 1 2310", "lose 1000", "load 1 -0.02"};
enum { FAULTS = sizeof faults / sizeof faults[0], STRIDE = 97 };

/* It ends in ErrorStop without torque, or goes on and finds its reference; what it travels after the fault is bounded:
 * by the braking and the run-out, or by the sequence itself. */
static bool one_fault(int device, int fault, int cycle)
{
    begin(device);
    program_begin(true);
    for (int n = 0; n < cycle; n++)
        if (program_cycle()) {
            close_segment();
            return false;
        }
    simulate(faults[fault]);
    cm1e_sim_probe_reset(cm1e_bus_segment(bus), 1);
    bool through = false;
    for (int n = 0; n < 9000 && !through && info().state != CM1E_AXIS_ERROR_STOP; n++)
        through = program_cycle();
    for (int n = 0; n < 500; n++)
        program_cycle();
    const cm1e_sim_probe_t end = probe();
    ck_assert_msg(through || info().state == CM1E_AXIS_ERROR_STOP, "device %d, \"%s\" at %d: %s, step %d, %x %x %x",
                  device, faults[fault], cycle, cm1e_axis_state_name(info().state), program.step,
                  program.fast.ErrorID, program.block.ErrorID, program.finish.ErrorID);
    if (through && info().state != CM1E_AXIS_ERROR_STOP) {
        const double error = (called(NEGATIVE_STOP) + 7.0) * unit;
        ck_assert_msg(info().homed && fabs(error) < 20.0, "device %d, \"%s\" at %d: off by %.1f", device,
                      faults[fault], cycle, error);
    } else if (!through) {
        ck_assert_msg(!info().homed && !end.torque_on, "device %d, \"%s\" at %d", device, faults[fault], cycle);
        ck_assert_msg(program.error, "device %d, \"%s\" at %d: no block told", device, faults[fault], cycle);
    }
    ck_assert_msg(fabs(end.velocity_counts_per_s) < 1.0, "device %d, \"%s\" at %d: it still moves", device,
                  faults[fault], cycle);
    ck_assert_msg(end.peak_velocity_counts_per_s < 2.0 * 0.5 * unit, "device %d, \"%s\" at %d: %.0f counts/s", device,
                  faults[fault], cycle, end.peak_velocity_counts_per_s);
    close_segment();
    return true;
}

START_TEST(test_fault_at_every_cycle_ends_in_a_defined_state)
{
    int cycle = 1 + _i * 7; /* other cycles for each fault */
    while (one_fault(_i % 2 ? 1 : 3, _i, cycle))
        cycle += STRIDE;
    ck_assert_int_gt(cycle, 2000);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("fb_homing");
    TCase *tests = tcase_create("homing");
    tcase_set_timeout(tests, 300);
    tcase_add_loop_test(tests, test_switch_fast_then_slow_then_away, 0, DEVICES);
    tcase_add_loop_test(tests, test_switch_then_hard_stop_then_away, 0, DEVICES);
    tcase_add_loop_test(tests, test_block_does_not_go_on_pushing, 0, DEVICES);
    tcase_add_loop_test(tests, test_end_of_a_step_that_presses_without_lag, 0, DEVICES);
    tcase_add_loop_test(tests, test_a_search_for_a_switch_that_ends_leaves_a_load_where_it_is, 0, 2 * DEVICES);
    tcase_add_loop_test(tests, test_a_slow_search_for_a_switch_that_ends_at_a_stop_does_not_press_on, 0, DEVICES);
    tcase_add_test(tests, test_mc_stop_ends_a_search_in_standstill_not_homed);
    tcase_add_test(tests, test_home_direct_gives_the_actual_position);
    tcase_add_test(tests, test_home_direct_and_what_the_motor_cannot);
    tcase_add_test(tests, test_signal_of_another_axis_is_refused);
    tcase_add_loop_test(tests, test_fault_at_every_cycle_ends_in_a_defined_state, 0, FAULTS);
    suite_add_tcase(suite, tests);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
