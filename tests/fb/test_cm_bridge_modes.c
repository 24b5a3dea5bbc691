/* CM_SetMode and CM_Command on a simulated bridge with four motors: modes and the ways between them, what ends a switch,
 * a bridge that comes back in another mode, and the commands of CMD. */
#include "cm_bridge_bench.h"

/* ---- modes ------------------------------------------------------------------------------------------------------- */

START_TEST(test_modes_and_their_dead_ends)
{
    start();
    switch_mode(0, cmCML, FALSE);
    ck_assert_msg(set_mode[0].Done, "%s", text_of(0));
    ck_assert_int_eq(info_of(0).mode, CM1E_BRIDGE_MODE_CML);
    switch_mode(0, cmCSP, FALSE);
    ck_assert(set_mode[0].Done);
    switch_mode(0, cmCMD, FALSE);
    ck_assert(set_mode[0].Done);
    ck_assert_int_eq(info_of(0).mode, CM1E_BRIDGE_MODE_CMD);
    switch_mode(0, cmCSP, FALSE);
    ck_assert_int_eq(ERROR_OF(set_mode[0]), CM1E_ERROR_CM_MODE);
    ck_assert_msg(strstr(text_of(0), "off and on"), "%s", text_of(0));
    fails(0, "?99.1", FALSE, CM1E_ERROR_CM_MODE, "Insist");
    power_of[0].Enable = TRUE;
    scan(50);
    ck_assert(power_of[0].Error && !power_of[0].Status);
    ck_assert_int_eq(ERROR_OF(power_of[0]), CM1E_ERROR_CM_MODE);
    power_of[0].Enable = FALSE;
    scan(2);
    switch_mode(0, cmCML, FALSE);
    ck_assert_msg(set_mode[0].Done, "%s", text_of(0));
    sends(0, "?99.1", "Ux.1=8");
    power_of[0].Enable = TRUE; /* by way of CML only where that was insisted on */
    scan(50);
    ck_assert_int_eq(ERROR_OF(power_of[0]), CM1E_ERROR_CM_MODE);
    power_of[0].Enable = FALSE;
    scan(2);
    switch_mode(0, cmCSP, TRUE);
    ck_assert_msg(set_mode[0].Done, "%s", text_of(0));
    switch_mode(0, (CM_MODE)7, FALSE);
    ck_assert_int_eq(ERROR_OF(set_mode[0]), CM1E_ERROR_INVALID_ARGUMENT);
    close_segment();
}
END_TEST

START_TEST(test_cpio_moves_as_csp_but_does_not_home)
{
    start();
    switch_mode(1, cmCPIO, FALSE);
    ck_assert_msg(set_mode[1].Done, "%s", text_of(1));
    const double at = info_of(1).actual_position;
    enable_axis(1);
    ck_assert_double_eq_tol(info_of(1).actual_position, at, 0.001);
    MC_Home_t home = {.Axis = &references[1], .Execute = TRUE};
    MC_Home(&home);
    ck_assert_int_eq(ERROR_OF(home), CM1E_ERROR_CM_MODE);
    ck_assert_msg(strstr(text_of(1), "home first"), "%s", text_of(1));
    turning[1].Execute = TRUE;
    scan(600);
    ck_assert_msg(turning[1].InVelocity, "%s", text_of(1));
    close_segment();
}
END_TEST

START_TEST(test_a_switch_that_another_one_replaces_is_cancelled)
{
    start();
    set_mode[0].Mode = cmCML;
    set_mode[0].Execute = TRUE;
    scan(3);
    ck_assert(set_mode[0].Busy);
    power_of[0].Enable = TRUE;
    scan(2);
    ck_assert_int_eq(ERROR_OF(set_mode[0]), CM1E_ERROR_CANCELLED);
    enable_axis(0);
    close_segment();
}
END_TEST

/* What ends a switch of the mode says so, and not only MC_Power. */
START_TEST(test_a_switch_that_ends_otherwise_has_a_text)
{
    start();
    switch_mode(0, cmCML, FALSE);
    CM_SetMode_t back = {.Axis = &references[0], .Execute = TRUE, .Mode = cmCSP};
    CM_SetMode(&back);
    begin(0, "?99.1", FALSE);
    CM_SetMode(&back);
    ck_assert_int_eq(ERROR_OF(back), CM1E_ERROR_CANCELLED);
    ck_assert_msg(strstr(text_of(0), "\"CM_SetMode\" was cancelled"), "by a string: %s", text_of(0));
    CM_SetMode_t first = {.Axis = &references[1], .Execute = TRUE, .Mode = cmCML};
    CM_SetMode(&first);
    scan(1);
    set_mode[1].Execute = TRUE;
    scan(1);
    CM_SetMode(&first);
    ck_assert_int_eq(ERROR_OF(first), CM1E_ERROR_CANCELLED);
    ck_assert_msg(strstr(text_of(1), "\"CM_SetMode\" was cancelled"), "by another one: %s", text_of(1));
    close_segment();
}
END_TEST

/* The way out of a dead end, as MC_Power tells it: the bridge is switched off and on, and found in CSP. Nothing leads it
 * back, and no motor has torque that MC_Power does not tell of. */
static void power_cycle_in(CM_MODE mode, bool enabled)
{
    start();
    switch_mode(2, mode, FALSE);
    ck_assert_msg(set_mode[2].Done, "%s", text_of(2));
    if (enabled) {
        power_of[2].Enable = TRUE;
        scan(300);
        ck_assert(power_of[2].Status == (mode != cmCMD));
    }
    simulate("power-cycle 1 300");
    scan(1000);
    power_of[2].Enable = TRUE;
    scan(10);
    ck_assert_int_eq(info_of(2).state, CM1E_AXIS_ERROR_STOP);
    MC_Reset_t reset = {.Axis = &references[2], .Execute = TRUE};
    MC_Reset(&reset);
    for (int i = 0; i < 3000 && reset.Busy; i++) {
        scan(1);
        MC_Reset(&reset);
    }
    ck_assert_msg(reset.Done, "%s", text_of(2));
    enable_axis(2);
    ck_assert_int_eq(info_of(2).mode, CM1E_BRIDGE_MODE_CSP);
    turning[2].Execute = TRUE;
    scan(600);
    ck_assert_msg(turning[2].InVelocity, "%s", text_of(2));
    close_segment();
}

START_TEST(test_a_bridge_that_was_switched_off_and_on_is_in_csp)
{
    for (int mode = cmCSP; mode <= cmCPIO; mode++) {
        power_cycle_in((CM_MODE)mode, false);
        power_cycle_in((CM_MODE)mode, true);
    }
}
END_TEST

/* Whatever a bridge was doing, and however short it is away: only MC_Power leads a motor out of state A again (BR 6.1.1),
 * and after the error not before MC_Reset. */
START_TEST(test_a_bridge_that_restarts_alone_gets_no_request_for_torque)
{
    static const int away_ms[] = {1, 2, 3, 5, 20, 300};
    for (int i = 0; i < (int)(sizeof away_ms / sizeof away_ms[0]) * 4; i++) {
        char line[40];
        start();
        power_of[1].Enable = i % 4 > 0;
        scan(i % 4 == 1 ? 5 : 400); /* free, on its way to torque, at rest, turning */
        turning[1].Execute = i % 4 == 3;
        scan(100);
        snprintf(line, sizeof line, "power-cycle 1 %d", away_ms[i / 4]);
        simulate(line);
        scan(away_ms[i / 4] + 1);
        for (int n = 0; n < 3000; n++) {
            for (int k = 0; k < AXES; k++)
                ck_assert_msg(motor(k)->state != SWITCHED_ON && motor(k)->state != OPERATION_ENABLED,
                              "%d ms, %d: motor %d after %d cycles", away_ms[i / 4], i % 4, k, n);
            scan(1);
        }
        ck_assert_int_eq(info_of(1).state, power_of[1].Enable ? CM1E_AXIS_ERROR_STOP : CM1E_AXIS_DISABLED);
        close_segment();
    }
}
END_TEST

/* Another axis resets the bridge; this one, in CMD before, was asked nothing and stays where the bridge begins. */
START_TEST(test_nothing_leads_back_into_a_dead_end)
{
    start();
    switch_mode(2, cmCMD, FALSE);
    power_of[3].Enable = TRUE;
    scan(300);
    set_mode[1].Mode = cmCML; /* under way when the bridge goes */
    set_mode[1].Execute = TRUE;
    scan(3);
    ck_assert(set_mode[1].Busy);
    simulate("power-cycle 1 300");
    scan(1000);
    MC_Reset_t reset = {.Axis = &references[3], .Execute = TRUE};
    MC_Reset(&reset);
    for (int i = 0; i < 3000 && reset.Busy; i++) {
        scan(1);
        MC_Reset(&reset);
    }
    ck_assert_msg(reset.Done, "%s", text_of(3));
    scan(500);
    ck_assert_int_eq(ERROR_OF(set_mode[1]), CM1E_ERROR_AXIS_OFFLINE);
    ck_assert_msg(strstr(text_of(1), cm1e_strerror(CM1E_ERROR_AXIS_OFFLINE)), "%s", text_of(1));
    ck_assert_int_eq(info_of(2).state, CM1E_AXIS_DISABLED);
    ck_assert_int_eq(info_of(2).mode, CM1E_BRIDGE_MODE_CSP);
    enable_axis(2);
    close_segment();
}
END_TEST

/* A cable that was away for a moment while nobody asked for torque: the frames are good again, the bridge is not in
 * Operational. MC_Power says so. */
START_TEST(test_mc_power_does_not_wait_for_ever_for_a_bridge_that_is_not_in_operational)
{
    for (int mode = cmCSP; mode <= cmCPIO; mode++) {
        start();
        switch_mode(2, (CM_MODE)mode, FALSE);
        simulate("unplug 1");
        scan(300);
        simulate("replug 1");
        scan(300);
        ck_assert_int_eq(info_of(2).state, CM1E_AXIS_DISABLED);
        power_of[2].Enable = TRUE;
        scan(10);
        ck_assert_int_eq(info_of(2).state, CM1E_AXIS_ERROR_STOP);
        ck_assert_int_eq(ERROR_OF(power_of[2]), CM1E_ERROR_BUS_STATE);
        ck_assert_msg(strstr(text_of(2), "MC_Reset"), "%s", text_of(2));
        close_segment();
    }
}
END_TEST

START_TEST(test_a_string_that_a_switch_overtakes_is_cancelled)
{
    start();
    snprintf(cml[0].Command, sizeof cml[0].Command, "?99.1");
    cml[0].Execute = TRUE;
    set_mode[0].Mode = cmCMD;
    set_mode[0].Execute = TRUE;
    scan(3);
    ck_assert_int_eq(ERROR_OF(cml[0]), CM1E_ERROR_CANCELLED);
    ck_assert_msg(strstr(text_of(0), "\"?99.1\" was cancelled by MC_Power, by CM_SetMode"), "%s", text_of(0));
    wait_for(&set_mode[0].Busy, 1000);
    ck_assert(set_mode[0].Done);
    close_segment();
}
END_TEST

/* ---- CMD --------------------------------------------------------------------------------------------------------- */

START_TEST(test_commands_of_cmd)
{
    start();
    do_command(0, cmMotorEnable, 0);
    ck_assert_int_eq(ERROR_OF(command_of[0]), CM1E_ERROR_CM_MODE);
    switch_mode(0, cmCMD, FALSE);
    for (int what = cmMotorFree; what <= cmOriginSearchAbort; what++) {
        do_command(0, (CM_COMMAND)what, 0);
        wait_for(&command_of[0].Busy, 100000);
        ck_assert_msg(command_of[0].Done, "%d: %s", what, text_of(0));
    }
    ck_assert(!info_of(0).homed);
    do_command(0, (CM_COMMAND)9, 0);
    ck_assert_int_eq(ERROR_OF(command_of[0]), CM1E_ERROR_INVALID_ARGUMENT);
    do_command(0, cmOriginSearch, INT64_MAX);
    ck_assert_int_eq(ERROR_OF(command_of[0]), CM1E_ERROR_INVALID_ARGUMENT);
    close_segment();
}
END_TEST

START_TEST(test_a_search_in_cmd_that_lasts_too_long_is_ended)
{
    start();
    switch_mode(1, cmCMD, FALSE);
    do_command(1, cmMotorEnable, 0);
    wait_for(&command_of[1].Busy, 1000);
    do_command(1, cmOriginSearch, (TIME)500000000);
    wait_for(&command_of[1].Busy, 5000);
    ck_assert_int_eq(ERROR_OF(command_of[1]), CM1E_ERROR_CM_SEARCH_TIMEOUT);
    ck_assert_msg(strstr(text_of(1), cm1e_strerror(CM1E_ERROR_CM_SEARCH_TIMEOUT)), "%s", text_of(1));
    scan(1000);
    ck_assert(!cm1e_sim_search_running(&motor(1)->search));
    do_command(1, cmMotorEnable, 0);
    wait_for(&command_of[1].Busy, 1000);
    do_command(1, cmOriginSearch, 0);
    scan(500);
    ck_assert(cm1e_sim_search_running(&motor(1)->search));
    int n = 0;
    for (bool off = false; !off; n++) {
        ck_assert_int_lt(n, 3000);
        inputs();
        off = cm1e_axis_shut_down(axes[1]);
        outputs();
    }
    ck_assert(!cm1e_sim_search_running(&motor(1)->search));
    ck_assert(motor(1)->motor_free);
    close_segment();
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("cm_bridge_modes");
    TCase *tests = tcase_create("blocks");
    tcase_add_test(tests, test_modes_and_their_dead_ends);
    tcase_add_test(tests, test_cpio_moves_as_csp_but_does_not_home);
    tcase_add_test(tests, test_a_switch_that_another_one_replaces_is_cancelled);
    tcase_add_test(tests, test_a_switch_that_ends_otherwise_has_a_text);
    tcase_add_test(tests, test_a_bridge_that_was_switched_off_and_on_is_in_csp);
    tcase_add_test(tests, test_a_bridge_that_restarts_alone_gets_no_request_for_torque);
    tcase_add_test(tests, test_nothing_leads_back_into_a_dead_end);
    tcase_add_test(tests, test_mc_power_does_not_wait_for_ever_for_a_bridge_that_is_not_in_operational);
    tcase_add_test(tests, test_a_string_that_a_switch_overtakes_is_cancelled);
    tcase_add_test(tests, test_commands_of_cmd);
    tcase_add_test(tests, test_a_search_in_cmd_that_lasts_too_long_is_ended);
    suite_add_tcase(suite, tests);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? 1 : 0;
}
