/* Limit switches and home switches of an axis on the bits of other slaves, which go away and come back. */
#include "axis/axis_signals.h"
#include "effort.h"
#include "wired_machine.h"

/* ---- switches ---------------------------------------------------------------------------------------------------- */

static MC_ReadAxisInfo_t axis_info(void)
{
    MC_ReadAxisInfo_t fb = {.Axis = &motor, .Enable = TRUE};
    MC_ReadAxisInfo(&fb);
    ck_assert(fb.Valid);
    return fb;
}

START_TEST(test_a_limit_switch_whose_slave_is_away_is_pressed_a_home_switch_is_not)
{
    begin();
    MC_ReadAxisInfo_t fb = axis_info();
    ck_assert(!fb.HomeAbsSwitch && !fb.LimitSwitchPos && !fb.LimitSwitchNeg);
    for (int n = 1; n <= 3; n++)
        set_input(n, true);
    cycles(3);
    fb = axis_info();
    ck_assert(fb.HomeAbsSwitch && fb.LimitSwitchPos && fb.LimitSwitchNeg);
    for (int n = 1; n <= 3; n++)
        set_input(n, false);
    cycles(3);
    take_away(SWITCHES, 50);
    cycles(LOST_CYCLES + 3);
    fb = axis_info();
    ck_assert(!fb.HomeAbsSwitch && fb.LimitSwitchPos && fb.LimitSwitchNeg);
    cycles(BACK);
    fb = axis_info();
    ck_assert(!fb.HomeAbsSwitch && !fb.LimitSwitchPos && !fb.LimitSwitchNeg);
    close_segment();
}
END_TEST

static MC_StepAbsoluteSwitch_t search(void)
{
    return (MC_StepAbsoluteSwitch_t){.Axis = &motor, .Direction = mcPositiveDirection, .SwitchMode = mcRisingEdge,
                                     .Velocity = 2.0, .SetPosition = 10.0};
}

/* u, of the simulated motor itself. */
static double shaft(void) { return probe_of(MOTOR).position_counts / 50000.0; }

/* The switch is 1 u from the start. It is found there, to the way of a few cycles: that of the frame and of the
 * terminal. */
START_TEST(test_homing_by_a_switch_of_another_slave)
{
    const double place = 1.0;
    begin();
    enable_motor();
    MC_StepAbsoluteSwitch_t fb = search();
    fb.Execute = TRUE;
    const double start = shaft();
    double at = NAN;
    for (int n = 0; n < 3000 && !fb.Done; n++) {
        const double way = shaft() - start;
        if (isnan(at) && way >= place)
            at = way;
        set_input(1, way >= place);
        MC_StepAbsoluteSwitch(&fb);
        ck_assert_msg(!fb.Error, "%s", text_of(MOTOR));
        cycles(1);
    }
    ck_assert(fb.Done);
    const double now = shaft() - start;
    ck_assert_double_eq_tol(info_of(MOTOR).actual_position - 10.0, now - place, 2.0 * 0.004);
    close_segment();
}
END_TEST

static double most_step(double *before)
{
    const double velocity = info_of(MOTOR).set_velocity, step = fabs(velocity - *before);
    *before = velocity;
    return step;
}

/* A search at which the terminal goes away in cycle `at`. It ends with an error, and at rest, by a ramp. */
static void search_without(MC_StepAbsoluteSwitch_t *fb, int at, bool off)
{
    double before = info_of(MOTOR).set_velocity;
    fb->Execute = TRUE;
    for (int n = 0; n < 1500 && !fb->Error; n++) {
        if (n == at && off)
            take_away(SWITCHES, 50);
        else if (n == at)
            fall_back(SWITCHES);
        MC_StepAbsoluteSwitch(fb);
        ck_assert(!fb->Done);
        cycles(1);
        const double step = most_step(&before);
        ck_assert(off || step <= 0.101); /* 5,000,000 counts/s2 are 0.1 u/s a cycle */
        ck_assert_double_ge(before, 0.0);
        ck_assert_double_le(before, 2.0 + 1e-9);
    }
    for (int n = 0; n < 100; n++) {
        cycles(1);
        const double step = most_step(&before);
        ck_assert(off || step <= 0.101);
    }
    ck_assert_double_eq(before, 0.0);
}

/* Wherever the terminal leaves Operational, the search stops with its own ramp and an error in words. */
START_TEST(test_homing_stops_when_the_slave_of_its_switch_leaves_operational)
{
    const int stride = sweep_stride(40, 80);
    for (int at = sweep_first(1, stride); at < 400; at += stride) {
        begin();
        enable_motor();
        MC_StepAbsoluteSwitch_t fb = search();
        search_without(&fb, at, false);
        ck_assert_uint_eq(fb.ErrorID, id_of(CM1E_ERROR_AXIS_SIGNAL_AWAY));
        ck_assert_int_eq(info_of(MOTOR).state, CM1E_AXIS_HOMING);
        ck_assert_msg(strstr(text_of(MOTOR), "switches.input 1") && strstr(text_of(MOTOR), "switches.input 2"), "%s",
                      text_of(MOTOR));
        close_segment();
    }
}
END_TEST

/* It does not begin while the slave is away. When the slave is back, it does. */
START_TEST(test_homing_does_not_begin_without_its_switch)
{
    begin();
    enable_motor();
    fall_back(SWITCHES);
    cycles(7);
    MC_StepAbsoluteSwitch_t fb = search();
    fb.Execute = TRUE;
    MC_StepAbsoluteSwitch(&fb);
    ck_assert_uint_eq(fb.ErrorID, id_of(CM1E_ERROR_AXIS_SIGNAL_AWAY));
    ck_assert_msg(strstr(text_of(MOTOR), "switches.input 1"), "%s", text_of(MOTOR));
    ck_assert_int_eq(info_of(MOTOR).state, CM1E_AXIS_STANDSTILL);
    fb.Execute = FALSE;
    MC_StepAbsoluteSwitch(&fb);
    cycles(BACK);
    fb.Execute = TRUE;
    MC_StepAbsoluteSwitch(&fb);
    ck_assert_msg(fb.Busy && !fb.Error, "%s", text_of(MOTOR));
    close_segment();
}
END_TEST

/* Without power it takes no part in the working counter, which is an error of all axes with torque. Their time stops in
 * the cycles before that (SAFETY.md). */
START_TEST(test_homing_stops_when_the_slave_of_its_switch_is_switched_off)
{
    begin();
    enable_motor();
    MC_StepAbsoluteSwitch_t fb = search();
    search_without(&fb, 100, true);
    ck_assert_int_eq(info_of(MOTOR).state, CM1E_AXIS_ERROR_STOP);
    ck_assert_msg(strstr(text_of(MOTOR), "working counter"), "%s", text_of(MOTOR));
    close_segment();
}
END_TEST

/* A limit switch ahead that goes away ends the search for the home switch, too. It does not turn it round. */
START_TEST(test_homing_stops_when_only_the_limit_switch_goes_away)
{
    describe_machine();
    snprintf(config.axes[MOTOR].wiring.inputs[0], CM1E_SIGNAL_LENGTH, "more.input 1");
    add_slave("more", CM1E_SIM_SLAVE_DIGITAL, 1, 0);
    open_segment();
    take_references();
    cycles(300);
    enable_motor();
    MC_StepAbsoluteSwitch_t fb = search();
    search_without(&fb, 100, false);
    ck_assert_uint_eq(fb.ErrorID, id_of(CM1E_ERROR_AXIS_SIGNAL_AWAY));
    close_segment();
}
END_TEST

/* An optional terminal that is not plugged in: the axis moves, a homing by its switch does not begin. Without power it
 * stops only that homing, and no other axis fails. */
START_TEST(test_homing_by_a_switch_of_an_optional_slave)
{
    describe_machine();
    cm1e_slave_config_t *more = add_slave("more", CM1E_SIM_SLAVE_DIGITAL, 1, 0);
    more->signals[more->signal_count++] = (cm1e_signal_config_t){.name = "home", .bits = 1};
    snprintf(config.axes[MOTOR].wiring.inputs[0], CM1E_SIGNAL_LENGTH, "more.home");
    more->address_kind = CM1E_ADDRESS_ALIAS;
    more->address = 1001;
    more->vendor = 0x12;
    more->product = 0xD0001;
    more->optional = true;
    more->sim_absent = _i == 0;
    open_segment();
    take_references();
    cycles(300);
    enable_motor();
    MC_StepAbsoluteSwitch_t fb = search();
    fb.Execute = TRUE;
    double before = 0.0;
    for (int n = 0; n < 1000 && !fb.Error; n++) {
        if (n == 100)
            take_away(COUNTER + 1, 500);
        MC_StepAbsoluteSwitch(&fb);
        cycles(1);
        ck_assert_double_le(most_step(&before), 0.101);
    }
    ck_assert_uint_eq(fb.ErrorID, id_of(CM1E_ERROR_AXIS_SIGNAL_AWAY));
    ck_assert_msg(strstr(text_of(MOTOR), "more.home"), "%s", text_of(MOTOR));
    ck_assert_int_eq(info_of(MOTOR).state, _i == 0 ? CM1E_AXIS_STANDSTILL : CM1E_AXIS_HOMING);
    close_segment();
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("switches of other slaves");
    TCase *tests = tcase_create("wiring");
    tcase_set_timeout(tests, 120);
    tcase_add_test(tests, test_a_limit_switch_whose_slave_is_away_is_pressed_a_home_switch_is_not);
    tcase_add_test(tests, test_homing_by_a_switch_of_another_slave);
    tcase_add_test(tests, test_homing_stops_when_the_slave_of_its_switch_leaves_operational);
    tcase_add_test(tests, test_homing_does_not_begin_without_its_switch);
    tcase_add_test(tests, test_homing_stops_when_the_slave_of_its_switch_is_switched_off);
    tcase_add_test(tests, test_homing_stops_when_only_the_limit_switch_goes_away);
    tcase_add_loop_test(tests, test_homing_by_a_switch_of_an_optional_slave, 0, 2);
    suite_add_tcase(suite, tests);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_NORMAL);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
