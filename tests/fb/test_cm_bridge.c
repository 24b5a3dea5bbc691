/* CM_SendCML on a simulated bridge with four motors: what a string asks for happens, what it must not do is refused,
 * nothing jumps, and everything that can go wrong meanwhile ends in a word. */
#include "cm_bridge_bench.h"

/* ---- CML --------------------------------------------------------------------------------------------------------- */

START_TEST(test_queries_parameters_and_outputs)
{
    start();
    sends(0, "K53.1", "K53.1=0");
    sends(0, "K53.1=100", "");
    sends(0, "K53", "K53.1=100");
    sends(0, "?99.1", "Ux.1=8");
    sends(2, "?96.3", "Px.3=0");
    sends(0, "O2.1", "");
    ck_assert_int_eq(motor(0)->outputs, 2);
    sends(0, "K53,?99,?96", "K53.1=100");
    ck_assert_int_eq(cml[0].Lines, 3);
    cml[0].Line = 3;
    scan(1);
    ck_assert_str_eq(cml[0].Response, "Px.1=0");
    cml[0].Line = 4;
    scan(1);
    ck_assert_str_eq(cml[0].Response, "");
    cml[0].Execute = FALSE;
    scan(1);
    ck_assert(cml[0].Lines == 0 && !cml[0].Done);
    ck_assert_int_eq(info_of(0).state, CM1E_AXIS_DISABLED);
    ck_assert_int_eq(info_of(0).mode, CM1E_BRIDGE_MODE_CML);
    close_segment();
}
END_TEST

START_TEST(test_a_list_is_read_line_by_line)
{
    start();
    send(3, "?90.4", FALSE);
    ck_assert_msg(cml[3].Done, "%s", text_of(3));
    ck_assert_int_ge(cml[3].Lines, 50);
    ck_assert_str_eq(cml[3].Response, "K21.4=0");
    for (INT line = 1; line <= cml[3].Lines; line++) {
        cml[3].Line = line;
        scan(1);
        ck_assert_msg(cml[3].Response[0] == 'K' && strstr(cml[3].Response, ".4="), "line %d: %s", line,
                      cml[3].Response);
    }
    close_segment();
}
END_TEST

START_TEST(test_what_is_refused_says_why_and_sends_nothing)
{
    start();
    fails(0, "^.1", FALSE, CM1E_ERROR_CML_MOTION, "AllowMotion");
    fails(0, "K27.1=3", FALSE, CM1E_ERROR_CML_MOTION, "AllowMotion");
    fails(0, "K37.1=3", TRUE, CM1E_ERROR_CML_STRING, "bus file");
    fails(0, "", FALSE, CM1E_ERROR_CML_STRING, "is empty");
    fails(0, "?99.2", FALSE, CM1E_ERROR_CML_STRING, "another motor");
    fails(0, "?99.1\r\n", FALSE, CM1E_ERROR_CML_STRING, "CR or LF");
    fails(0, "12345678901234567890123456789012345678901234567890123456789012345", FALSE, CM1E_ERROR_CML_STRING, "64");
    memset(cml[0].Command, 'K', sizeof cml[0].Command); /* no end at all */
    cml[0].Execute = FALSE;
    scan(1);
    cml[0].Execute = TRUE;
    scan(1);
    ck_assert_int_eq(ERROR_OF(cml[0]), CM1E_ERROR_CML_STRING);
    cml[0].Timeout = -1;
    fails(0, "?99.1", FALSE, CM1E_ERROR_INVALID_ARGUMENT, NULL);
    cml[0].Timeout = 0;
    ck_assert_int_eq(info_of(0).mode, CM1E_BRIDGE_MODE_CSP);
    enable_axis(0);
    fails(0, "?99.1", FALSE, CM1E_ERROR_CM_NOT_DISABLED, "MC_Power.Enable");
    switch_mode(0, cmCML, FALSE);
    ck_assert_int_eq(ERROR_OF(set_mode[0]), CM1E_ERROR_CM_NOT_DISABLED);
    ck_assert_int_eq(info_of(0).state, CM1E_AXIS_STANDSTILL);
    close_segment();
}
END_TEST

/* An axis keeps the answers to its last strings only. */
START_TEST(test_a_block_that_comes_too_late_for_its_answer_is_told_so)
{
    start();
    CM_SendCML_t late = {.Axis = &references[0], .Execute = TRUE, .Command = "?99.1"};
    CM_SendCML(&late);
    ck_assert(late.Busy && !late.Error);
    for (int i = 0; i < CM1E_DRIVE_CML_QUEUE; i++)
        sends(0, "K53", "K53.1=0");
    CM_SendCML(&late);
    ck_assert_int_eq(ERROR_OF(late), CM1E_ERROR_CANCELLED);
    ck_assert(!late.Busy && !late.Done && late.Lines == 0 && !late.Response[0]);
    close_segment();
}
END_TEST

/* A string that was answered leaves its place to the next one in the cycle in which its block is Done. */
START_TEST(test_as_many_strings_wait_as_there_are_places)
{
    start();
    sends(0, "K53", "K53.1=0");
    CM_SendCML_t some[CM1E_DRIVE_CML_QUEUE];
    for (int i = 0; i < CM1E_DRIVE_CML_QUEUE; i++)
        some[i] = (CM_SendCML_t){.Axis = &references[0], .Execute = TRUE, .Command = "K53"};
    for (int cycle = 0, done = 0; done < 20; cycle++) {
        ck_assert_int_lt(cycle, 2000);
        inputs();
        for (int i = 0; i < CM1E_DRIVE_CML_QUEUE; i++) {
            CM_SendCML(&some[i]);
            ck_assert_msg(!some[i].Error, "string %d: %X", done, (unsigned)ERROR_OF(some[i]));
            if (!some[i].Done)
                continue;
            done++;
            some[i].Execute = FALSE;
            CM_SendCML(&some[i]);
            some[i].Execute = TRUE;
            CM_SendCML(&some[i]);
            ck_assert_msg(some[i].Busy, "string %d: %X", done, (unsigned)ERROR_OF(some[i]));
        }
        outputs();
    }
    close_segment();
}
END_TEST

START_TEST(test_a_cm1e_has_none_of_this)
{
    describe("1.3.5", CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, 1000000);
    open_segment();
    references[0] = cm1e_axis_reference(axes[0]);
    cycles(20);
    CM_SendCML_t one = {.Axis = &references[0], .Execute = TRUE, .Command = "?99.1"};
    CM_SetMode_t two = {.Axis = &references[0], .Execute = TRUE, .Mode = cmCML};
    CM_Command_t three = {.Axis = &references[0], .Execute = TRUE};
    CM_SendCML(&one);
    CM_SetMode(&two);
    CM_Command(&three);
    ck_assert(one.Error && two.Error && three.Error);
    ck_assert_int_eq(ERROR_OF(one), CM1E_ERROR_CM_NO_BRIDGE);
    ck_assert_int_eq(ERROR_OF(two), CM1E_ERROR_CM_NO_BRIDGE);
    ck_assert_int_eq(ERROR_OF(three), CM1E_ERROR_CM_NO_BRIDGE);
    enable();
    close_segment();
}
END_TEST

/* The query goes over the one mailbox of the bridge while three motors turn by process data. */
START_TEST(test_a_query_while_the_others_move)
{
    start();
    for (int i = 1; i < AXES; i++) {
        enable_axis(i);
        turning[i].Execute = TRUE;
    }
    scan(500);
    for (int round = 0; round < 20; round++) {
        sends(0, "?99.1", "Ux.1=8");
        for (int i = 1; i < AXES; i++) {
            ck_assert_int_eq(info_of(i).state, CM1E_AXIS_CONTINUOUS_MOTION);
            ck_assert(turning[i].InVelocity);
            ck_assert_double_lt(fabs(info_of(i).position_lag), 0.05);
        }
    }
    close_segment();
}
END_TEST

/* A CM1 has torque from its power-on (BR 6.1.1), and keeps it on the way to CML, until it was enabled once. */
START_TEST(test_mc_power_leaves_cml_and_nothing_jumps)
{
    start();
    sends(0, "?99.1", "Ux.1=8");
    ck_assert(!motor(0)->motor_free);
    const double at = info_of(0).actual_position;
    enable_axis(0);
    ck_assert_int_eq(info_of(0).mode, CM1E_BRIDGE_MODE_CSP);
    scan(100);
    ck_assert_double_eq_tol(info_of(0).actual_position, at, 0.001);
    turning[0].Execute = TRUE;
    scan(500);
    ck_assert_msg(turning[0].InVelocity, "%s", text_of(0));
    power_of[0].Enable = FALSE;
    scan(2000);
    sends(0, "?99.1", "Ux.1=16");
    ck_assert(motor(0)->motor_free);
    close_segment();
}
END_TEST

START_TEST(test_mc_power_ends_a_string_under_way)
{
    start();
    cml[0].Timeout = 20 * (TIME)1000000000;
    begin(0, "?1234.1", FALSE); /* has no answer */
    scan(200);
    ck_assert(cml[0].Busy);
    enable_axis(0);
    ck_assert_int_eq(ERROR_OF(cml[0]), CM1E_ERROR_CANCELLED);
    close_segment();
}
END_TEST

START_TEST(test_an_origin_search_is_ended_when_power_or_the_end_of_the_run_comes)
{
    for (int how = 0; how < 2; how++) {
        start();
        send(1, "(.2", TRUE);
        ck_assert_msg(cml[1].Done, "%s", text_of(1));
        ck_assert(!info_of(1).homed);
        begin(1, "|.2", TRUE); /* no stop anywhere: it turns */
        scan(500);
        ck_assert(cml[1].Busy);
        const double at = info_of(1).actual_position;
        scan(200);
        ck_assert_double_gt(fabs(info_of(1).actual_position - at), 0.01);
        if (how == 0) {
            power_of[1].Enable = TRUE;
            scan(2500);
            ck_assert(!cml[1].Busy);
            ck_assert_int_eq(ERROR_OF(cml[1]), CM1E_ERROR_CANCELLED);
            ck_assert_msg(power_of[1].Status || info_of(1).state == CM1E_AXIS_ERROR_STOP, "%s", text_of(1));
        } else {
            int n = 0;
            for (bool off = false; !off; n++) {
                ck_assert_int_lt(n, 3000);
                inputs();
                off = cm1e_axis_shut_down(axes[1]);
                outputs();
            }
            ck_assert(motor(1)->motor_free);
        }
        ck_assert(!cm1e_sim_search_running(&motor(1)->search));
        const double stood = info_of(1).actual_position;
        cycles(500);
        ck_assert_double_eq_tol(info_of(1).actual_position, stood, how ? 0.3 : 0.01);
        close_segment();
    }
}
END_TEST

/* A string that was sent while the string before it was ended, and its motor freed, is ended like any other. */
START_TEST(test_a_search_behind_one_that_has_failed_is_ended_by_the_end_of_the_run)
{
    start();
    CM_SendCML_t enable = {.Axis = &references[1], .Execute = TRUE, .AllowMotion = TRUE, .Command = "(.2"};
    CM_SendCML_t again = {.Axis = &references[1], .Execute = TRUE, .AllowMotion = TRUE, .Command = "|.2"};
    send(1, "(.2", TRUE);
    cml[1].Timeout = 300 * (TIME)1000000;
    send(1, "|.2", TRUE);
    ck_assert_int_eq(ERROR_OF(cml[1]), CM1E_ERROR_CM_SEARCH_TIMEOUT);
    CM_SendCML(&enable);
    CM_SendCML(&again);
    scan(500);
    ck_assert(cm1e_sim_search_running(&motor(1)->search));
    bool off = false;
    for (int n = 0; !off; n++) {
        ck_assert_int_lt(n, 3000);
        inputs();
        off = cm1e_axis_shut_down(axes[1]);
        outputs();
    }
    ck_assert(motor(1)->motor_free);
    ck_assert(!cm1e_sim_search_running(&motor(1)->search));
    close_segment();
}
END_TEST

START_TEST(test_an_origin_search_to_a_stop_is_done)
{
    start();
    send(0, "(.1", TRUE);
    send(0, "|.1", TRUE);
    ck_assert_msg(cml[0].Done, "%s", text_of(0));
    ck_assert_str_eq(cml[0].Response, "Origin.1=0");
    enable_axis(0);
    close_segment();
}
END_TEST

START_TEST(test_a_motor_that_is_unplugged_or_broken_is_a_word)
{
    start();
    sends(0, "?99.1", "Ux.1=8");
    simulate("motor 1 1 unplug");
    send(0, "?99.1", FALSE);
    ck_assert(cml[0].Error);
    ck_assert_msg(ERROR_OF(cml[0]) == CM1E_ERROR_CML_TIMEOUT || ERROR_OF(cml[0]) == CM1E_ERROR_DRIVE_FAULT ||
                  ERROR_OF(cml[0]) == CM1E_ERROR_AXIS_ERROR_STOP, "%s", cm1e_strerror(ERROR_OF(cml[0])));
    ck_assert_int_gt(strlen(text_of(0)), 30);
    close_segment();
}
END_TEST

/* The slave goes in cycle 1, 2, 3 ...: the block ends with an error, and nothing is left under way. */
START_TEST(test_slave_lost_at_every_cycle_of_a_string)
{
    int lost = 0;
    for (int at = 0; at < 60; at++) {
        start();
        begin(2, at % 2 ? "K53.3" : "?90.3", FALSE);
        scan(at);
        simulate("unplug 1");
        wait_for(&cml[2].Busy, 8000);
        ck_assert_msg(cml[2].Error || cml[2].Done, "cycle %d", at);
        lost += cml[2].Error;
        scan(200);
        ck_assert(cm1e_drive_cml_idle(&axes[2]->drive.behind->cml));
        ck_assert(!cml[2].Busy);
        close_segment();
    }
    ck_assert_int_gt(lost, 40);
}
END_TEST

/* A fault of the motor in cycle 1, 2, 3 ... of strings and switches: ErrorStop or a result, never a hang. */
START_TEST(test_fault_at_every_cycle_of_a_string)
{
    for (int at = 0; at < 40; at++) {
        start();
        begin(2, "?99.3", FALSE);
        scan(at);
        simulate("motor 1 3 error overload");
        wait_for(&cml[2].Busy, 8000);
        scan(50);
        ck_assert_msg(info_of(2).state == CM1E_AXIS_ERROR_STOP || info_of(2).state == CM1E_AXIS_DISABLED, "cycle %d",
                      at);
        ck_assert_msg(cml[2].Done || cml[2].Error, "cycle %d", at);
        close_segment();
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("cm_bridge");
    TCase *tests = tcase_create("blocks");
    tcase_add_test(tests, test_queries_parameters_and_outputs);
    tcase_add_test(tests, test_a_list_is_read_line_by_line);
    tcase_add_test(tests, test_what_is_refused_says_why_and_sends_nothing);
    tcase_add_test(tests, test_as_many_strings_wait_as_there_are_places);
    tcase_add_test(tests, test_a_cm1e_has_none_of_this);
    tcase_add_test(tests, test_a_query_while_the_others_move);
    tcase_add_test(tests, test_mc_power_leaves_cml_and_nothing_jumps);
    tcase_add_test(tests, test_mc_power_ends_a_string_under_way);
    tcase_add_test(tests, test_an_origin_search_is_ended_when_power_or_the_end_of_the_run_comes);
    tcase_add_test(tests, test_a_search_behind_one_that_has_failed_is_ended_by_the_end_of_the_run);
    tcase_add_test(tests, test_an_origin_search_to_a_stop_is_done);
    tcase_add_test(tests, test_a_motor_that_is_unplugged_or_broken_is_a_word);
    tcase_add_test(tests, test_slave_lost_at_every_cycle_of_a_string);
    tcase_add_test(tests, test_fault_at_every_cycle_of_a_string);
    tcase_add_test(tests, test_a_block_that_comes_too_late_for_its_answer_is_told_so);
    suite_add_tcase(suite, tests);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? 1 : 0;
}
