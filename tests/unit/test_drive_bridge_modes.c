/* Modes of operation behind a bridge (BR 6, appendix 3): every way there is and every one there is not, each of them
 * only at rest and without an error, never two writes within 5 ms, and what a switch that is not confirmed leaves. */
#include <stdlib.h>

#include "drive_bridge_bench.h"

enum { CSP = CM1E_BRIDGE_MODE_CSP, HM = CM1E_BRIDGE_MODE_HM, CML = CM1E_BRIDGE_MODE_CML, CMD = CM1E_BRIDGE_MODE_CMD,
       CPIO = CM1E_BRIDGE_MODE_CPIO };
static const int modes[] = {CSP, HM, CML, CMD, CPIO};
enum { MODES = sizeof modes / sizeof modes[0] };

void setUp(void) { bench_open(CM1E_DEVICE_EB12, 3); }
void tearDown(void)
{
    TEST_ASSERT_GREATER_THAN_INT64(5000000, fake_bridge.shortest_mode_interval_ns);
    bench_close();
}

/* The drawing of BR 6: three arrows into CMD, CML and CPIO each, two into csp, one into hm. */
static bool leads(int from, int to)
{
    switch (to) {
    case HM: return from == CSP;
    case CSP: return from == HM || from == CML;
    default: return from != HM;
    }
}

static void go_to(int mode)
{
    TEST_ASSERT_TRUE_MESSAGE(bench_mode(mode, 100), cm1e_device_mode(drive.kind, (int8_t)mode)->abbreviation);
    TEST_ASSERT_EQUAL_INT8(mode, fake_bridge_axis()->mode);
}

static unsigned writes_of_mode(void)
{
    unsigned count = 0;
    for (unsigned i = 0; i < bus.sdo_count; i++)
        count += bus.sdo_log[i].write && (bus.sdo_log[i].index & 0x07FF) == (OBJ_6060_MODES_OF_OPERATION & 0x07FF);
    return count;
}

static void test_every_way_of_the_drawing_and_no_other(void)
{
    unsigned ways = 0;
    for (int from = 0; from < MODES; from++)
        for (int to = 0; to < MODES; to++) {
            if (from == to)
                continue;
            bench_open(CM1E_DEVICE_EB12, (unsigned)(1 + to % 4));
            if (modes[from] != CSP)
                go_to(modes[from]);
            bus.sdo_count = 0;
            const char *why;
            const cm1e_error_t error = cm1e_drive_mode_check(&drive, (cm1e_mode_t)modes[to], true, &why);
            const bool open = leads(modes[from], modes[to]);
            TEST_ASSERT_EQUAL_INT(open ? CM1E_OK : CM1E_ERROR_STATE, error);
            TEST_ASSERT_EQUAL_INT(open, why == NULL);
            drive.command.mode_insist = true;
            TEST_ASSERT_EQUAL_INT(open, bench_mode(modes[to], 300));
            TEST_ASSERT_EQUAL_UINT(open, writes_of_mode()); /* a way that does not exist is not even tried */
            TEST_ASSERT_EQUAL_INT8(modes[open ? to : from], fake_bridge_axis()->mode);
            TEST_ASSERT_EQUAL_INT(CM1E_OK, drive.fault.error);
            ways += open;
        }
    TEST_ASSERT_EQUAL_UINT(3 * 3 + 2 + 1, ways);
}

static void test_what_is_no_mode_is_not_commanded(void)
{
    static const int none[] = {0, 1, 3, 9, 10, -1, 77, 102};
    for (size_t i = 0; i < sizeof none / sizeof none[0]; i++) {
        const char *why;
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_UNSUPPORTED, cm1e_drive_mode_check(&drive, (cm1e_mode_t)none[i], true, &why));
        TEST_ASSERT_NOT_NULL(why);
        drive.command.mode = (cm1e_mode_t)none[i];
        bench_cycles(50);
        TEST_ASSERT_EQUAL_INT8(CSP, drive.feedback.mode);
    }
    TEST_ASSERT_EQUAL_UINT(0, writes_of_mode());
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_drive_mode_check(&drive, CM1E_MODE_CSP, false, NULL));
    TEST_ASSERT_FALSE(cm1e_drive_supports(&drive, CM1E_MODE_CSV));
    TEST_ASSERT_TRUE(cm1e_drive_supports(&drive, CM1E_MODE_HM));
}

static void test_after_cmd_or_cpio_the_way_by_cml_is_for_who_insists(void)
{
    static const int dead_ends[] = {CMD, CPIO};
    for (int i = 0; i < 2; i++) {
        bench_open(CM1E_DEVICE_EB12, 1);
        go_to(dead_ends[i]);
        go_to(CML);
        const char *why;
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_STATE, cm1e_drive_mode_check(&drive, CM1E_MODE_CSP, false, &why));
        TEST_ASSERT_NOT_NULL(strstr(why, "abnormal"));
        TEST_ASSERT_FALSE(bench_mode(CSP, 500));
        TEST_ASSERT_EQUAL_INT8(CML, fake_bridge_axis()->mode);
        drive.command.mode_insist = true;
        go_to(CSP);
        drive.command.mode_insist = false; /* it was told once; homing is not refused for it */
        go_to(HM);
        go_to(CSP);
        go_to(CML);
        TEST_ASSERT_FALSE(bench_mode(CSP, 100)); /* and that was once */
    }
}

/* After power-off the bridge is in csp, and nothing is abnormal any more. */
static void test_power_off_makes_a_dead_end_normal(void)
{
    go_to(CMD);
    drive.command.mode = CM1E_MODE_CSP;
    bench_cycles(10);
    cm1e_drive_fail(&drive, CM1E_ERROR_BUS_LOST);
    cm1e_sim_bridge_ops.power_on(fake_bridge.app, bus.clock.virtual_now_ns);
    cm1e_sim_bridge_ops.state_change(fake_bridge.app, CM1E_AL_INIT, CM1E_AL_OP);
    bench_cycles(100);
    TEST_ASSERT_TRUE(bench_reset(50));
    TEST_ASSERT_TRUE(bench_mode(CSP, 100));
    TEST_ASSERT_EQUAL_UINT(1, writes_of_mode()); /* that to CMD: csp was found */
    go_to(CML);
    go_to(CSP);
    bench_enable();
}

/* ---- when ------------------------------------------------------------------------------------------------------- */

static void test_words_of_another_coding_wait_until_the_torque_is_gone(void)
{
    static const int others[] = {CML, CMD, CPIO};
    for (int i = 0; i < 3; i++) {
        bench_open(CM1E_DEVICE_EB12, 2);
        bench_enable();
        drive.command.mode = (cm1e_mode_t)others[i];
        bench_cycles(100);
        TEST_ASSERT_TRUE(drive.feedback.enabled);
        TEST_ASSERT_EQUAL_UINT(0, writes_of_mode());
        drive.command.enable = false;
        int silent = 0;
        for (int n = 0; n < 100 && drive.feedback.mode != others[i]; n++) {
            const unsigned before = writes_of_mode();
            bench_cycle();
            if (before == 0 && writes_of_mode() == 1)
                TEST_ASSERT_GREATER_OR_EQUAL_INT(5, silent); /* BR appendix 2: 0000h for five cycles */
            silent = bench_word() == 0 ? silent + 1 : 0;
        }
        TEST_ASSERT_EQUAL_INT8(others[i], fake_bridge_axis()->mode);
        TEST_ASSERT_TRUE(fake_bridge_axis()->motor_free);
        if (others[i] != CPIO) { /* and nothing brings torque there */
            drive.command.enable = true;
            for (int n = 0; n < 100; n++) {
                bench_cycle();
                TEST_ASSERT_EQUAL_HEX16(0, bench_word());
            }
        }
    }
}

static void test_a_switch_waits_for_rest(void)
{
    bench_enable();
    drive.command.target_position = 500; /* the last set-point before; the motor is still on its way */
    bench_cycle();
    drive.command.mode = CM1E_MODE_HM;
    bench_cycle();
    int64_t moved_ns = 0;
    int32_t before = drive.feedback.position;
    for (int i = 0; i < 300 && writes_of_mode() == 0; i++) {
        if (labs(drive.feedback.position - before) > 3) {
            before = drive.feedback.position;
            moved_ns = bus.clock.virtual_now_ns;
        }
        bench_cycle();
    }
    TEST_ASSERT_GREATER_THAN_INT64(0, moved_ns);
    TEST_ASSERT_GREATER_OR_EQUAL_INT64(20 * CYCLE_NS, bus.clock.virtual_now_ns - moved_ns);
    TEST_ASSERT_TRUE(bench_mode(HM, 50));
}

static void test_a_motor_that_never_rests_ends_in_a_timeout_without_a_write(void)
{
    drive.command.mode = (cm1e_mode_t)CML;
    for (int i = 0; i < 1200; i++) {
        fake_bridge_axis()->zero += 10;
        bench_cycle();
    }
    TEST_ASSERT_EQUAL_UINT(0, writes_of_mode());
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_DRIVE_MODE_TIMEOUT, drive.fault.error);
    bench_text_has("101 (CML) commanded, 8 (CSP) shown");
    bench_text_has("The motor turned, so the mode was not written. Let it come to rest");
    bench_text_has("at standstill");
    fake_bridge.shortest_mode_interval_ns = INT64_MAX;
}

/* CML is written, and 0x6061 goes on to show csp. */
static void write_cml_unseen(void)
{
    fake_bridge.mode_shown = CSP;
    drive.command.mode = (cm1e_mode_t)CML;
    while (writes_of_mode() == 0)
        bench_cycle();
}

/* A write that arrived may take effect late: 0x6061 is read also while a motor that moves keeps the next write back. */
static void test_a_late_switch_is_seen_while_the_motor_moves(void)
{
    write_cml_unseen();
    for (int i = 0; i < 300; i++) {
        fake_bridge_axis()->zero += 10;
        fake_bridge.mode_shown = i < 150 ? CSP : -1;
        bench_cycle();
    }
    TEST_ASSERT_EQUAL_UINT(1, writes_of_mode());
    TEST_ASSERT_EQUAL_INT8(CML, drive.feedback.mode);
}

/* Also if a read fails meanwhile, or finds the queue full. */
static void test_a_late_switch_is_seen_after_a_read_that_failed(void)
{
    for (int full = 0; full < 2; full++) {
        bench_open(CM1E_DEVICE_EB12, 3);
        write_cml_unseen();
        for (int i = 0; i < 300; i++) {
            fake_bridge_axis()->zero += 10;
            fake_bridge.mode_shown = i < 150 ? CSP : -1;
            bus.sdo_full = full && i >= 2 && i < 100;
            fake_bridge.broken_sdo = !full && i >= 2 && i < 100;
            bench_cycle();
        }
        TEST_ASSERT_EQUAL_UINT(1, writes_of_mode());
        TEST_ASSERT_EQUAL_INT8(CML, drive.feedback.mode);
    }
}

/* 200 pulses in a revolution and a tenth of it a second: in 20 ms that is not half a pulse. */
static void test_a_coarse_resolution_does_not_hide_that_the_motor_turns(void)
{
    static const uint8_t k37s[] = {0, 1, 3, 4, 6, 7, 10, 40, 45, 50};
    for (size_t i = 0; i < sizeof k37s; i++) {
        bench_open(CM1E_DEVICE_EB01, 1);
        bus.config.axes[0].k37 = k37s[i];
        bench_init();
        fake_bridge_axis()->scale = cm1e_bridge_counts_per_revolution(k37s[i]) / (double)CM1E_COUNTS_PER_REVOLUTION;
        for (int n = 0; n < 1600; n++) {
            if (n == 400)
                drive.command.mode = (cm1e_mode_t)CML;
            fake_bridge_axis()->zero += 5;
            bench_cycle();
        }
        TEST_ASSERT_EQUAL_UINT(0, writes_of_mode());
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_DRIVE_MODE_TIMEOUT, drive.fault.error);
        bench_open(CM1E_DEVICE_EB01, 1);
        bus.config.axes[0].k37 = k37s[i];
        bench_init();
        TEST_ASSERT_TRUE(bench_mode(CML, 300)); /* and one that stands is no longer waited for than that */
    }
}

static void test_an_error_of_the_motor_keeps_every_mode_but_cmd_shut(void)
{
    for (int to = 1; to < MODES; to++) {
        bench_open(CM1E_DEVICE_EB12, 4);
        cm1e_sim_bridge_axis_error(fake_bridge_axis(), BRIDGE_STATUS_OVERLOAD);
        bench_cycles(20);
        TEST_ASSERT_EQUAL_INT(modes[to] == CMD, bench_mode(modes[to], 300)); /* BR appendix 3.4 asks for nothing */
        TEST_ASSERT_EQUAL_UINT(modes[to] == CMD, writes_of_mode());
    }
}

/* In CMD the statusword says nothing of it: F530 does. The error may come at any cycle of a switch. */
static void test_an_error_of_the_motor_in_cmd_keeps_it_there(void)
{
    static const int ways[] = {CML, CPIO};
    for (int to = 0; to < 2; to++)
        for (int cycle = 0; cycle < 60; cycle++) {
            bench_open(CM1E_DEVICE_EB12, (unsigned)(1 + cycle % 4));
            go_to(CMD);
            bus.sdo_count = 0;
            drive.command.mode = (cm1e_mode_t)ways[to];
            bench_cycles(cycle);
            const bool written = writes_of_mode() > 0;
            cm1e_sim_bridge_axis_error(fake_bridge_axis(), BRIDGE_STATUS_OVERLOAD);
            fake_bridge_axis()->broken_rules = 0;
            bench_cycles(2000);
            if (cycle == 0)
                TEST_ASSERT_EQUAL_UINT(0, writes_of_mode());
            if (!written && writes_of_mode() == 0)
                TEST_ASSERT_EQUAL_INT(CM1E_ERROR_DRIVE_MODE_TIMEOUT, drive.fault.error);
            /* An answer holds for 3 ms, and a write takes its time: the error may come in between. */
            if (writes_of_mode() > 0 && !written)
                TEST_ASSERT_EQUAL_INT(CM1E_SIM_MODE_IN_ERROR, fake_bridge_axis()->broken_rules);
            TEST_ASSERT_TRUE(cycle < 50 || written);
        }
}

/* A switch that the error came before is not tried again while the motor is in error, whatever the words of the next mode
 * are. Only the write that was on its way when the error came is not held back. */
static void test_an_error_during_a_switch_ends_the_tries(void)
{
    static const int ways[][2] = {{CSP, HM}, {CSP, CML}, {CSP, CPIO}, {HM, CSP}, {CML, CSP}, {CML, CPIO}, {CPIO, CML}};
    enum { WAYS = sizeof ways / sizeof ways[0], ON_ITS_WAY = 5 };
    for (int way = 0; way < WAYS; way++)
        for (int cycle = 0; cycle < 60; cycle++) {
            bench_open(CM1E_DEVICE_EB12, (unsigned)(1 + cycle % 4));
            if (ways[way][0] != CSP)
                go_to(ways[way][0]);
            drive.command.mode = (cm1e_mode_t)ways[way][1];
            bench_cycles(cycle);
            cm1e_sim_bridge_axis_error(fake_bridge_axis(), BRIDGE_STATUS_OVERLOAD);
            bench_cycles(ON_ITS_WAY);
            fake_bridge_axis()->broken_rules = 0;
            bench_cycles(500);
            char text[80];
            snprintf(text, sizeof text, "%d to %d, error in cycle %d", ways[way][0], ways[way][1], cycle);
            TEST_ASSERT_EQUAL_HEX_MESSAGE(0, fake_bridge_axis()->broken_rules, text);
        }
}

/* ---- not confirmed ---------------------------------------------------------------------------------------------- */

static void test_a_switch_that_is_not_confirmed_is_a_fault_that_says_what_is_shown(void)
{
    for (int to = 1; to < MODES; to++) {
        bench_open(CM1E_DEVICE_EB12, 1);
        fake_bridge.mode_shown = CSP;
        fake_bridge_axis()->mode_due_ns = INT64_MAX;
        drive.command.mode = (cm1e_mode_t)modes[to];
        for (int i = 0; i < 1100; i++)
            bench_cycle();
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_DRIVE_MODE_TIMEOUT, drive.fault.error);
        TEST_ASSERT_EQUAL_INT8(CSP, drive.fault.mode_shown);
        bench_text_has("8 (CSP) shown");
        bench_text_has("cm1e status");
        const unsigned writes = writes_of_mode();
        TEST_ASSERT_GREATER_THAN_UINT(1, writes);
        bench_cycles(500); /* given up: nothing is tried any more */
        TEST_ASSERT_EQUAL_UINT(writes, writes_of_mode());
    }
}

static void test_after_a_refused_switch_csp_works_on(void)
{
    fake_bridge.mode_shown = CSP;
    drive.command.mode = (cm1e_mode_t)CML;
    bench_cycles(1100);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_DRIVE_MODE_TIMEOUT, drive.fault.error);
    fake_bridge_axis()->mode = CSP;
    fake_bridge.mode_shown = -1;
    drive.command.mode = CM1E_MODE_CSP;
    bench_cycles(5);
    TEST_ASSERT_TRUE(bench_reset(50));
    TEST_ASSERT_TRUE(bench_mode(CSP, 50));
    bench_enable();
}

static void test_a_switch_survives_broken_transfers_and_lost_frames(void)
{
    for (unsigned broken = 0; broken < 6; broken++) {
        bench_open(CM1E_DEVICE_EB02, 2);
        bus.sdo_delay = broken * 3;
        fake_bridge.broken_sdo = broken;
        TEST_ASSERT_TRUE(bench_mode(CML, 900));
        fake_bridge.broken_sdo = broken;
        TEST_ASSERT_TRUE(bench_mode(CSP, 900));
        TEST_ASSERT_EQUAL_INT(CM1E_OK, drive.fault.error);
    }
    for (int lost = 0; lost < 80; lost++) {
        bench_open(CM1E_DEVICE_EB02, 2);
        drive.command.mode = (cm1e_mode_t)CPIO;
        for (int i = 0; i < 150; i++) {
            fake_bridge.lost = i == lost;
            bench_cycle();
        }
        TEST_ASSERT_EQUAL_INT8(CPIO, drive.feedback.mode);
        TEST_ASSERT_EQUAL_INT(CM1E_OK, drive.fault.error);
    }
}

static void test_a_full_queue_is_waited_for(void)
{
    bus.sdo_full = true;
    drive.command.mode = (cm1e_mode_t)CML;
    bench_cycles(300);
    TEST_ASSERT_EQUAL_INT8(CSP, drive.feedback.mode);
    bus.sdo_full = false;
    TEST_ASSERT_TRUE(bench_mode(CML, 200));
}

/* What fails is tried again every 50 ms: the write, and, if the writes arrive, the read behind it. */
static void test_failed_transfers_are_not_repeated_at_once(void)
{
    for (int reads = 0; reads < 2; reads++) {
        bench_open(CM1E_DEVICE_EB12, 1);
        drive.command.mode = (cm1e_mode_t)CML;
        fake_bridge.mode_shown = CSP;
        for (int i = 0; i < 300; i++) {
            fake_bridge.broken_sdo = !reads || !drive.change.sdo.write;
            bench_cycle();
        }
        TEST_ASSERT_GREATER_THAN_UINT(4, writes_of_mode());
        TEST_ASSERT_LESS_THAN_UINT(8, writes_of_mode());
    }
}

static void leave_operational(int cycles)
{
    bus.watch.al_state = CM1E_AL_SAFE_OP;
    bench_cycles(cycles);
    bus.watch.al_state = CM1E_AL_OP;
}

/* The time in which a bridge is away is none in which it could have switched. */
static void test_a_switch_has_its_time_anew_after_an_absence(void)
{
    fake_bridge.mode_shown = CSP;
    drive.command.mode = (cm1e_mode_t)CML;
    bench_cycles(500);
    leave_operational(1000);
    fake_bridge_axis()->mode = CSP;
    fake_bridge.mode_shown = -1;
    TEST_ASSERT_TRUE(bench_mode(CML, 300));
    TEST_ASSERT_EQUAL_INT(CM1E_OK, drive.fault.error);
}

/* It comes back in the same mode: it was not switched off. */
static void test_an_absence_alone_makes_no_dead_end_normal(void)
{
    go_to(CMD);
    go_to(CML);
    leave_operational(20);
    bench_cycles(100);
    TEST_ASSERT_EQUAL_INT8(CML, drive.feedback.mode);
    TEST_ASSERT_TRUE(drive.change.abnormal);
    TEST_ASSERT_FALSE(bench_mode(CSP, 500));
}

/* Another tool may have led it there, so the refusal says what to do if it was switched off. */
static void test_power_off_in_cml_is_not_seen_and_that_is_said(void)
{
    const char *why = NULL;
    go_to(CMD);
    go_to(CML);
    bus.watch.al_state = CM1E_AL_SAFE_OP;
    bench_cycles(20);
    cm1e_sim_bridge_ops.power_on(fake_bridge.app, bus.clock.virtual_now_ns);
    cm1e_sim_bridge_ops.state_change(fake_bridge.app, CM1E_AL_INIT, CM1E_AL_OP);
    bus.watch.al_state = CM1E_AL_OP;
    bench_cycles(100);
    go_to(CML);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_STATE, cm1e_drive_mode_check(&drive, CM1E_MODE_CSP, false, &why));
    TEST_ASSERT_NOT_NULL(strstr(why, "not seen: use Insist"));
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_drive_mode_check(&drive, CM1E_MODE_CSP, true, &why));
}

/* The slave is away, and in csp when it is back, as it was commanded meanwhile. Nothing is written. */
static void expect_csp_after_an_absence(void)
{
    bus.watch.al_state = CM1E_AL_SAFE_OP;
    bench_cycles(20);
    fake_bridge_axis()->mode = CSP;
    drive.command.mode = CM1E_MODE_CSP;
    bus.watch.al_state = CM1E_AL_OP;
    const unsigned before = writes_of_mode();
    bench_cycles(200);
    TEST_ASSERT_EQUAL_UINT(before, writes_of_mode());
    TEST_ASSERT_EQUAL_INT8(CSP, drive.feedback.mode);
}

/* Another tool may have switched it meanwhile, and a switch of before is not gone on with. */
static void test_after_an_absence_the_mode_that_is_found_counts(void)
{
    leave_operational(20);
    fake_bridge_axis()->mode = CMD;
    bench_cycles(100);
    TEST_ASSERT_TRUE(drive.change.abnormal);

    bench_open(CM1E_DEVICE_EB12, 3);
    write_cml_unseen();
    bench_cycles(3);
    expect_csp_after_an_absence();
}

/* A write whose answer comes during the absence proves nothing either. */
static void test_after_an_absence_a_write_that_was_under_way_is_not_repeated(void)
{
    fake_bridge.mode_shown = CSP;
    bus.sdo_delay = 10;
    drive.command.mode = (cm1e_mode_t)CML;
    while (drive.change.sdo.index == 0 || !drive.change.sdo.write)
        bench_cycle();
    expect_csp_after_an_absence();
}

/* Nor is one that was waited for, if the read of the mode fails meanwhile. */
static void test_after_an_absence_a_write_that_was_not_confirmed_is_not_repeated(void)
{
    fake_bridge.mode_shown = CSP;
    bus.sdo_delay = 10;
    drive.command.mode = (cm1e_mode_t)CML;
    while (writes_of_mode() == 0 || drive.change.sdo.write)
        bench_cycle();
    fake_bridge.broken_sdo = true;
    bus.watch.al_state = CM1E_AL_SAFE_OP;
    bench_cycles(20);
    fake_bridge.broken_sdo = false;
    expect_csp_after_an_absence();
}

/* Which mode the motor is in is unknown until 0x6061 shows the one that was written. */
static void test_a_switch_is_not_overtaken_by_the_next_one(void)
{
    const unsigned before = bus.sdo_count;
    write_cml_unseen();
    TEST_ASSERT_TRUE(bus.sdo_log[before].write); /* the mode was read at the start */
    drive.command.mode = (cm1e_mode_t)CPIO;
    for (int i = 0; i < 100; i++) {
        bench_cycle();
        TEST_ASSERT_EQUAL_INT(CML, drive.mode.commanded);
    }
    fake_bridge.mode_shown = -1;
    TEST_ASSERT_TRUE(bench_mode(CPIO, 200));
}

static void test_after_a_switch_that_was_given_up_another_mode_can_be_commanded(void)
{
    fake_bridge.mode_shown = CSP;
    drive.command.mode = (cm1e_mode_t)CML;
    bench_cycles(1100);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_DRIVE_MODE_TIMEOUT, drive.fault.error);
    fake_bridge_axis()->mode = CSP;
    fake_bridge.mode_shown = -1;
    TEST_ASSERT_TRUE(bench_mode(CPIO, 200));
}

/* A write of CMD or CPIO may have arrived, whatever comes of it. */
static void test_a_dead_end_counts_from_its_write_on(void)
{
    bus.sdo_delay = 20;
    drive.command.mode = (cm1e_mode_t)CMD;
    bench_cycles(15);
    TEST_ASSERT_EQUAL_INT8(CSP, fake_bridge_axis()->mode);
    TEST_ASSERT_TRUE(drive.change.abnormal);
}

/* Words of another coding wait for a state without torque, though nobody requests torque any more. */
static void test_a_state_with_torque_keeps_words_of_another_coding_away(void)
{
    static const int with_torque[] = {0x0233, 0x0237}; /* Switched on, Operation enabled */
    for (int i = 0; i < 2; i++) {
        bench_open(CM1E_DEVICE_EB12, 3);
        fake_bridge.statusword = with_torque[i];
        bench_cycles(3);
        TEST_ASSERT_EQUAL_INT(i == 0 ? SWITCHED_ON : OPERATION_ENABLED, drive.feedback.state);
        drive.command.mode = (cm1e_mode_t)CML;
        bench_cycles(100);
        TEST_ASSERT_EQUAL_UINT(0, writes_of_mode());
        TEST_ASSERT_EQUAL_INT(CSP, drive.mode.commanded);
        fake_bridge.statusword = -1;
        go_to(CML);
    }
}

/* ---- with torque ------------------------------------------------------------------------------------------------ */

static void test_hm_and_back_with_torque_never_jumps(void)
{
    bench_enable();
    for (int round = 0; round < 3; round++) {
        drive.command.mode = CM1E_MODE_HM;
        for (int i = 0; i < 200 && !(drive.feedback.enabled && drive.feedback.mode == HM); i++) {
            bench_cycle();
            char text[600];
            cm1e_drive_fault_text(&drive, text, sizeof text);
            TEST_ASSERT_EQUAL_HEX16_MESSAGE(0x000F, bench_word(), text);
        }
        TEST_ASSERT_TRUE(drive.feedback.enabled);
        fake_bridge_axis()->zero += 100000; /* homing gave the position another name */
        bench_cycles(30);
        drive.command.mode = CM1E_MODE_CSP;
        fake_bridge.largest_step = 0;
        for (int i = 0; i < 200 && !(drive.feedback.enabled && drive.feedback.mode == CSP); i++)
            bench_cycle();
        TEST_ASSERT_TRUE(drive.feedback.enabled);
        TEST_ASSERT_EQUAL_INT64(0, fake_bridge.largest_step);
        drive.command.target_position = drive.feedback.position;
        TEST_ASSERT_EQUAL_INT(CM1E_OK, drive.fault.error);
    }
}

/* Its words have another coding: 0000h for 10 ms before them, also in the first cycles of a run. */
static void test_a_bridge_found_in_cml_gets_zeros_before_the_switch(void)
{
    fake_bridge_open(&bus, CM1E_DEVICE_EB12, 3);
    fake_bridge_axis()->mode = CML;
    bench_init();
    drive.command.mode = CM1E_MODE_CSP;
    for (int i = 0; i < 5; i++) {
        bench_cycle();
        TEST_ASSERT_EQUAL_UINT(0, writes_of_mode());
        TEST_ASSERT_EQUAL_HEX16(0, bench_word());
    }
    TEST_ASSERT_TRUE(bench_mode(CSP, 100));
}

static void test_homing_starts_by_bit_4_in_hm_alone(void)
{
    bench_enable();
    drive.command.mode = CM1E_MODE_HM;
    drive.command.homing_start = true;
    for (int i = 0; i < 300 && !(bench_word() & CONTROLWORD_HOMING_START); i++) {
        if (drive.feedback.mode != HM)
            TEST_ASSERT_EQUAL_HEX16(0x000F, bench_word());
        bench_cycle();
    }
    bench_cycles(3);
    TEST_ASSERT_TRUE(cm1e_sim_search_running(&fake_bridge_axis()->search));
    drive.command.halt = true; /* the bridge has no such bit */
    bench_cycle();
    TEST_ASSERT_EQUAL_HEX16(0x001F, bench_word());
    drive.command.enable = false;
    bench_cycles(3);
    TEST_ASSERT_FALSE(cm1e_sim_search_running(&fake_bridge_axis()->search));
}

static void test_a_refused_way_to_hm_takes_the_torque(void)
{
    bench_enable();
    fake_bridge.mode_shown = CSP;
    drive.command.mode = CM1E_MODE_HM;
    bench_cycles(1100);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_DRIVE_MODE_TIMEOUT, drive.fault.error);
    TEST_ASSERT_EQUAL_HEX16(0x0006, bench_word());
    TEST_ASSERT_EQUAL_INT64(0, fake_bridge.largest_step);
}

static void test_torque_that_no_mode_gives_is_an_error(void)
{
    go_to(CMD);
    drive.command.enable = true;
    bench_cycles(1900);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, drive.fault.error);
    bench_cycles(200);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_DRIVE_ENABLE_TIMEOUT, drive.fault.error);
    TEST_ASSERT_EQUAL_HEX16(0, bench_word());
}

static void test_power_from_cml_goes_by_csp(void)
{
    go_to(CML);
    drive.command.enable = true;
    drive.command.mode = CM1E_MODE_CSP;
    for (int i = 0; i < 200 && !drive.feedback.enabled; i++) {
        bench_cycle();
        if (fake_bridge_axis()->mode != CSP)
            TEST_ASSERT_EQUAL_HEX16(0, bench_word());
    }
    TEST_ASSERT_TRUE(drive.feedback.enabled);
    TEST_ASSERT_EQUAL_INT64(0, fake_bridge.largest_step);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_way_of_the_drawing_and_no_other);
    RUN_TEST(test_what_is_no_mode_is_not_commanded);
    RUN_TEST(test_after_cmd_or_cpio_the_way_by_cml_is_for_who_insists);
    RUN_TEST(test_power_off_makes_a_dead_end_normal);
    RUN_TEST(test_words_of_another_coding_wait_until_the_torque_is_gone);
    RUN_TEST(test_a_switch_waits_for_rest);
    RUN_TEST(test_a_motor_that_never_rests_ends_in_a_timeout_without_a_write);
    RUN_TEST(test_a_late_switch_is_seen_while_the_motor_moves);
    RUN_TEST(test_a_late_switch_is_seen_after_a_read_that_failed);
    RUN_TEST(test_a_coarse_resolution_does_not_hide_that_the_motor_turns);
    RUN_TEST(test_an_error_of_the_motor_keeps_every_mode_but_cmd_shut);
    RUN_TEST(test_an_error_of_the_motor_in_cmd_keeps_it_there);
    RUN_TEST(test_an_error_during_a_switch_ends_the_tries);
    RUN_TEST(test_a_switch_that_is_not_confirmed_is_a_fault_that_says_what_is_shown);
    RUN_TEST(test_after_a_refused_switch_csp_works_on);
    RUN_TEST(test_a_switch_survives_broken_transfers_and_lost_frames);
    RUN_TEST(test_a_full_queue_is_waited_for);
    RUN_TEST(test_hm_and_back_with_torque_never_jumps);
    RUN_TEST(test_failed_transfers_are_not_repeated_at_once);
    RUN_TEST(test_a_switch_has_its_time_anew_after_an_absence);
    RUN_TEST(test_an_absence_alone_makes_no_dead_end_normal);
    RUN_TEST(test_power_off_in_cml_is_not_seen_and_that_is_said);
    RUN_TEST(test_after_an_absence_the_mode_that_is_found_counts);
    RUN_TEST(test_after_an_absence_a_write_that_was_under_way_is_not_repeated);
    RUN_TEST(test_after_an_absence_a_write_that_was_not_confirmed_is_not_repeated);
    RUN_TEST(test_a_switch_is_not_overtaken_by_the_next_one);
    RUN_TEST(test_after_a_switch_that_was_given_up_another_mode_can_be_commanded);
    RUN_TEST(test_a_dead_end_counts_from_its_write_on);
    RUN_TEST(test_a_state_with_torque_keeps_words_of_another_coding_away);
    RUN_TEST(test_a_bridge_found_in_cml_gets_zeros_before_the_switch);
    RUN_TEST(test_homing_starts_by_bit_4_in_hm_alone);
    RUN_TEST(test_a_refused_way_to_hm_takes_the_torque);
    RUN_TEST(test_torque_that_no_mode_gives_is_an_error);
    RUN_TEST(test_power_from_cml_goes_by_csp);
    return UNITY_END();
}
