/* CM_SendCML, CM_SetMode, CM_Command on a simulated bridge with four motors: what they ask for happens, what they must
 * not do is refused, nothing jumps, and everything that can go wrong meanwhile ends in a word. */
#include "bridge/cool_muscle.h"
#include "axis/axis_parts.h"
#include "cm1e/plcopen.h"
#include "drive/drive_bridge.h"
#include "sim/bridge_app.h"

#include "axis_segment.h"

enum { AXES = 4 };
static AXIS_REF_t references[AXES];
static CM_SendCML_t cml[AXES];
static CM_SetMode_t set_mode[AXES];
static CM_Command_t command_of[AXES];
static MC_Power_t power_of[AXES];
static MC_MoveVelocity_t turning[AXES];

static void scan(int count)
{
    while (count-- > 0) {
        inputs();
        for (int i = 0; i < AXES; i++) {
            MC_Power(&power_of[i]);
            CM_SendCML(&cml[i]);
            CM_SetMode(&set_mode[i]);
            CM_Command(&command_of[i]);
            MC_MoveVelocity(&turning[i]);
        }
        outputs();
    }
}

static void start(void)
{
    describe("", CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, 1000000);
    describe_up_to(AXES);
    for (int i = 0; i < AXES; i++) {
        config.axes[i] = (cm1e_axis_config_t){.address = 1, .channel = (uint8_t)(i + 1), .k37 = 10, .k37_stated = true};
        snprintf(config.axes[i].motor, sizeof config.axes[i].motor, "%s", i < 2 ? "CM1" : "CM2");
        config.axes[i].sim.no_stops = i > 0;
    }
    open_segment();
    for (int i = 0; i < AXES; i++) {
        references[i] = cm1e_axis_reference(axes[i]);
        cml[i] = (CM_SendCML_t){.Axis = &references[i]};
        set_mode[i] = (CM_SetMode_t){.Axis = &references[i]};
        command_of[i] = (CM_Command_t){.Axis = &references[i]};
        power_of[i] = (MC_Power_t){.Axis = &references[i], .EnablePositive = TRUE, .EnableNegative = TRUE};
        turning[i] = (MC_MoveVelocity_t){.Axis = &references[i], .Velocity = 2.0};
    }
    scan(50);
}

static cm1e_sim_bridge_axis_t *motor(int n)
{
    cm1e_sim_slave_t *slave = cm1e_sim_segment_slave(cm1e_bus_segment(bus), 1);
    return &cm1e_sim_bridge_of(slave)->axes[n];
}

static void begin(int n, const char *text, BOOL allow_motion)
{
    cml[n].Execute = FALSE;
    scan(1);
    snprintf(cml[n].Command, sizeof cml[n].Command, "%s", text);
    cml[n].AllowMotion = allow_motion;
    cml[n].Execute = TRUE;
    scan(1);
}

static void wait_for(const BOOL *busy, int most)
{
    while (*busy && most-- > 0)
        scan(1);
    ck_assert_msg(!*busy, "still busy: %s", text());
}

static void send(int n, const char *text, BOOL allow_motion)
{
    begin(n, text, allow_motion);
    wait_for(&cml[n].Busy, 100000);
}

#define ERROR_OF(FB) cm1e_error_from_id((FB).ErrorID)
static void sends(int n, const char *string, const char *response)
{
    send(n, string, FALSE);
    ck_assert_msg(cml[n].Done, "%s: %s %s", string, cm1e_strerror(ERROR_OF(cml[n])), text_of(n));
    ck_assert_str_eq(cml[n].Response, response);
}

static void fails(int n, const char *string, BOOL allow_motion, cm1e_error_t error, const char *words)
{
    send(n, string, allow_motion);
    ck_assert_msg(ERROR_OF(cml[n]) == error, "%s: %s", string, cm1e_strerror(ERROR_OF(cml[n])));
    ck_assert_msg(!words || strstr(text_of(n), words), "%s: %s", string, text_of(n));
}

static void switch_mode(int n, CM_MODE mode, BOOL insist)
{
    set_mode[n].Execute = FALSE;
    scan(1);
    set_mode[n].Mode = mode;
    set_mode[n].Insist = insist;
    set_mode[n].Execute = TRUE;
    scan(1);
    wait_for(&set_mode[n].Busy, 3000);
}

static void do_command(int n, CM_COMMAND what, TIME timeout)
{
    command_of[n].Execute = FALSE;
    scan(1);
    command_of[n].Command = what;
    command_of[n].Timeout = timeout;
    command_of[n].Execute = TRUE;
    scan(1);
}

static void enable_axis(int n)
{
    power_of[n].Enable = TRUE;
    for (int i = 0; i < 3000 && !power_of[n].Status && !power_of[n].Error; i++)
        scan(1);
    ck_assert_msg(power_of[n].Status, "%s", text_of(n));
}

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
    Suite *suite = suite_create("cm_bridge");
    TCase *tests = tcase_create("blocks");
    tcase_add_test(tests, test_queries_parameters_and_outputs);
    tcase_add_test(tests, test_a_list_is_read_line_by_line);
    tcase_add_test(tests, test_what_is_refused_says_why_and_sends_nothing);
    tcase_add_test(tests, test_a_cm1e_has_none_of_this);
    tcase_add_test(tests, test_a_query_while_the_others_move);
    tcase_add_test(tests, test_mc_power_leaves_cml_and_nothing_jumps);
    tcase_add_test(tests, test_mc_power_ends_a_string_under_way);
    tcase_add_test(tests, test_an_origin_search_is_ended_when_power_or_the_end_of_the_run_comes);
    tcase_add_test(tests, test_an_origin_search_to_a_stop_is_done);
    tcase_add_test(tests, test_a_motor_that_is_unplugged_or_broken_is_a_word);
    tcase_add_test(tests, test_slave_lost_at_every_cycle_of_a_string);
    tcase_add_test(tests, test_fault_at_every_cycle_of_a_string);
    tcase_add_test(tests, test_modes_and_their_dead_ends);
    tcase_add_test(tests, test_cpio_moves_as_csp_but_does_not_home);
    tcase_add_test(tests, test_a_switch_that_another_one_replaces_is_cancelled);
    tcase_add_test(tests, test_a_switch_that_ends_otherwise_has_a_text);
    tcase_add_test(tests, test_a_bridge_that_was_switched_off_and_on_is_in_csp);
    tcase_add_test(tests, test_a_bridge_that_restarts_alone_gets_no_request_for_torque);
    tcase_add_test(tests, test_nothing_leads_back_into_a_dead_end);
    tcase_add_test(tests, test_mc_power_does_not_wait_for_ever_for_a_bridge_that_is_not_in_operational);
    tcase_add_test(tests, test_a_string_that_a_switch_overtakes_is_cancelled);
    tcase_add_test(tests, test_a_block_that_comes_too_late_for_its_answer_is_told_so);
    tcase_add_test(tests, test_commands_of_cmd);
    tcase_add_test(tests, test_a_search_in_cmd_that_lasts_too_long_is_ended);
    suite_add_tcase(suite, tests);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? 1 : 0;
}
