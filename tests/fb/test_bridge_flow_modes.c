/**
 * The flow charts of appendix 3 of the bridge's guide, ways between modes of operation, on every motor of a bridge:
 * each branch of each chart is taken. What counts is what was on the wire: 0x6060 is written once the motor is in
 * position and without an error, 0x6061 is read until it shows the mode, with 5 ms between.
 */
#include "bridge_drives.h"

enum { HM = CM1E_BRIDGE_MODE_HM, CSP = CM1E_BRIDGE_MODE_CSP, CML = CM1E_BRIDGE_MODE_CML, CMD = CM1E_BRIDGE_MODE_CMD,
       CPIO = CM1E_BRIDGE_MODE_CPIO };
enum { PAUSE_MS = 5, PAUSE_NS = PAUSE_MS * 1000000 };

typedef enum way {
    TO_HM_SHOWN, TO_HM_NOT_YET, TO_HM_MOVING, TO_HM_ERROR,
    TO_CML_SHOWN, TO_CML_NOT_YET, TO_CML_MOVING, TO_CML_ERROR,
    TO_CSP_SHOWN, TO_CSP_NOT_YET, TO_CSP_MOVING, TO_CSP_ERROR, TO_CSP_TARGET,
    TO_CMD_SHOWN, TO_CMD_NOT_YET,
    TO_CPIO_SHOWN, TO_CPIO_NOT_YET, TO_CPIO_MOVING, TO_CPIO_ERROR,
} way_t;

#define IN_POSITION "motor is in position"
#define NO_ERROR "no error"
static branch_t branches[] = {
    [TO_HM_SHOWN] = {"3.1", "6061h = 6", "yes: complete", 0},
    [TO_HM_NOT_YET] = {"3.1", "6061h = 6", "no: wait 5 ms, read again", 0},
    [TO_HM_MOVING] = {"3.1", IN_POSITION, "no: nothing is written before it is", 0},
    [TO_HM_ERROR] = {"3.1", NO_ERROR, "no: nothing is written", 0},
    [TO_CML_SHOWN] = {"3.2", "6061h = 101", "yes: complete", 0},
    [TO_CML_NOT_YET] = {"3.2", "6061h = 101", "no: wait 5 ms, read again", 0},
    [TO_CML_MOVING] = {"3.2", IN_POSITION, "no: nothing is written before it is", 0},
    [TO_CML_ERROR] = {"3.2", NO_ERROR, "no: nothing is written", 0},
    [TO_CSP_SHOWN] = {"3.3", "6061h = 8", "yes: complete", 0},
    [TO_CSP_NOT_YET] = {"3.3", "6061h = 8", "no: wait 5 ms, read again", 0},
    [TO_CSP_MOVING] = {"3.3", IN_POSITION, "no: nothing is written before it is", 0},
    [TO_CSP_ERROR] = {"3.3", NO_ERROR, "no: nothing is written", 0},
    [TO_CSP_TARGET] = {"3.3", "actual position follows target position", "the target is where the motor is", 0},
    [TO_CMD_SHOWN] = {"3.4", "6061h = 120", "yes: complete", 0},
    [TO_CMD_NOT_YET] = {"3.4", "6061h = 120", "no: wait 5 ms, read again", 0},
    [TO_CPIO_SHOWN] = {"3.5", "6061h = 121", "yes: complete", 0},
    [TO_CPIO_NOT_YET] = {"3.5", "6061h = 121", "no: wait 5 ms, read again", 0},
    [TO_CPIO_MOVING] = {"3.5", IN_POSITION, "no: nothing is written before it is", 0},
    [TO_CPIO_ERROR] = {"3.5", NO_ERROR, "no: nothing is written", 0},
};

/** The charts; a mode from which each is begun here, and how that one is reached from csp. */
static const struct chart {
    int to, from;
    way_t shown;
    bool confirms; /**< "Confirm motor is in position, confirm no error occurs": all but that to CMD */
} charts[] = {
    {HM, CSP, TO_HM_SHOWN, true},    {CML, CSP, TO_CML_SHOWN, true}, {CSP, CML, TO_CSP_SHOWN, true},
    {CSP, HM, TO_CSP_SHOWN, true},   {CMD, CSP, TO_CMD_SHOWN, false}, {CMD, CML, TO_CMD_SHOWN, false},
    {CPIO, CSP, TO_CPIO_SHOWN, true}, {CPIO, CML, TO_CPIO_SHOWN, true},
};
enum { CHARTS = sizeof charts / sizeof charts[0] };

/* ---- what is forged ---------------------------------------------------------------------------------------------- */

enum { TURN_COUNTS = 20, MOTOR_ERROR = 0x4000 };
static int victim;          /* number of the motor */
static int old_answers;     /* so many reads of 0x6061 show the mode that was before; < 0: all */
static int old_mode;
static bool turned, in_error;
static int32_t turned_by;

static void forge_mode(const sdo_seen_t *sdo, uint8_t *value)
{
    const bool written = find_sdo(0, true, cm1e_drive_index(&drives[victim], 0x6060), NULL) != NULL;
    if (sdo->index != cm1e_drive_index(&drives[victim], 0x6061) || !written || old_answers == 0)
        return;
    old_answers -= old_answers > 0;
    value[0] = (uint8_t)old_mode;
}

/* Somebody turns the shaft; or the motor shows an error. */
static void forge_motor(unsigned axis, uint8_t *inputs)
{
    if ((int)axis != victim)
        return;
    turned_by += turned ? TURN_COUNTS : 0;
    cm1e_put_u32(inputs + 2, cm1e_get_u32(inputs + 2) + (uint32_t)turned_by);
    if (in_error)
        cm1e_put_u16(inputs, cm1e_get_u16(inputs) | MOTOR_ERROR);
}

static void forge(int n, int answers, int mode)
{
    wire_forget();
    victim = n;
    old_answers = answers;
    old_mode = mode;
    turned = in_error = false;
    turned_by = 0;
    bridge_wire.forge_answer = forge_mode;
    bridge_wire.forge_inputs = forge_motor;
}

/* ---- what is judged ---------------------------------------------------------------------------------------------- */

static uint16_t on_wire(int n, uint16_t index) { return cm1e_drive_index(&drives[n], index); }

static bool switched(int n, int mode)
{
    for (int i = 0; i < 500 && drives[n].feedback.mode != mode; i++)
        cycles(1);
    return drives[n].feedback.mode == mode;
}

/** 0x6060 once with the mode, then 0x6061 until it shows it; times between. Returns how often it did not. */
static int check_requests(int n, const struct chart *chart)
{
    int number = 0, not_yet = 0;
    const sdo_seen_t *written = find_sdo(0, true, on_wire(n, 0x6060), &number), *before = written;
    ck_assert_msg(written && written->data[0] == (char)chart->to, "ID%d: mode %d was not written", n + 1, chart->to);
    ck_assert_int_eq(count_sdos(true, on_wire(n, 0x6060)), 1);
    for (const sdo_seen_t *read; (read = find_sdo(number + 1, false, on_wire(n, 0x6061), &number)); before = read) {
        if (before != written)
            ck_assert_msg(read->sent_ns - before->answered_ns >= PAUSE_NS, "ID%d: 6061h is read again after %.1f ms",
                          n + 1, (double)(read->sent_ns - before->answered_ns) * 1e-6);
        not_yet += read->data[0] != (char)chart->to;
    }
    ck_assert_msg(before != written && before->data[0] == (char)chart->to, "ID%d: 6061h has not shown mode %d", n + 1,
                  chart->to);
    return not_yet;
}

static void open_in(int n, int mode)
{
    open_drives();
    cycles(100);
    if (mode != CSP)
        reach_mode(n, mode);
    cycles(30);
}

static void must_not_have_moved(int n, double position)
{
    ck_assert_msg(fabs(motor(n)->mechanics.position - position) < 3, "ID%d moved by %.0f counts while its mode was "
                  "switched", n + 1, motor(n)->mechanics.position - position);
}

/* ---- tests ------------------------------------------------------------------------------------------------------- */

START_TEST(test_mode_is_written_and_read_until_it_is_shown)
{
    const struct chart *chart = &charts[_i % CHARTS];
    const int n = _i / CHARTS;
    open_in(n, chart->from);
    const double position = motor(n)->mechanics.position;
    forge(n, 3, chart->from);
    drives[n].command.mode = (cm1e_mode_t)chart->to;
    ck_assert_msg(switched(n, chart->to), "ID%d: from %d to %d: %s", n + 1, chart->from, chart->to, drive_text(n));
    ck_assert_int_eq(check_requests(n, chart), 3);
    branches[chart->shown].taken++;
    branches[chart->shown + 1].taken++;
    ck_assert_int_eq(motor(n)->mode, chart->to);
    cycles(20);
    must_not_have_moved(n, position);
    if (chart->to == CSP) {
        ck_assert_msg(bridge_wire.target[n] == bridge_wire.position[n], "ID%d in csp: target %d, position %d", n + 1,
                      bridge_wire.target[n], bridge_wire.position[n]);
        branches[TO_CSP_TARGET].taken++;
    }
    close_drives();
}
END_TEST

/** A motor that moves, or shows an error: nothing is written, and what comes of it is told by the charts. To CMD there
 *  is no such condition (3.4). */
START_TEST(test_mode_is_not_written_in_motion_nor_with_an_error)
{
    const struct chart *chart = &charts[_i / 2 % CHARTS];
    const int n = _i / 2 / CHARTS;
    const bool error = _i % 2 == 1;
    open_in(n, chart->from);
    forge(n, 0, chart->from);
    turned = !error;
    in_error = error;
    cycles(30);
    drives[n].command.mode = (cm1e_mode_t)chart->to;
    cycles(200);
    ck_assert_msg((count_sdos(true, on_wire(n, 0x6060)) == 0) == chart->confirms, "ID%d, %s: from %d to %d, 6060h was "
                  "%swritten", n + 1, error ? "an error" : "in motion", chart->from, chart->to,
                  chart->confirms ? "" : "not ");
    turned = in_error = false;
    ck_assert_msg(switched(n, chart->to), "ID%d: from %d to %d: %s", n + 1, chart->from, chart->to, drive_text(n));
    check_requests(n, chart);
    if (chart->confirms)
        branches[chart->shown + (error ? 3 : 2)].taken++;
    close_drives();
}
END_TEST

/** hm is reached under torque, too: MC_Home begins so. */
START_TEST(test_hm_is_reached_under_torque_once_the_motor_stands)
{
    const int n = _i;
    open_in(n, CSP);
    enable_drive(n);
    forge(n, 0, CSP);
    turned = true;
    cycles(30);
    drives[n].command.mode = (cm1e_mode_t)HM;
    cycles(200);
    ck_assert_msg(count_sdos(true, on_wire(n, 0x6060)) == 0, "ID%d: 6060h is written in motion", n + 1);
    branches[TO_HM_MOVING].taken++;
    turned = false;
    ck_assert_msg(switched(n, HM), "ID%d: %s", n + 1, drive_text(n));
    ck_assert(drives[n].feedback.state == OPERATION_ENABLED && drives[n].fault.error == CM1E_OK);
    close_drives();
}
END_TEST

/** What 0x6061 never shows is an error that says so, and no torque comes. */
START_TEST(test_switch_that_is_never_confirmed_is_an_error)
{
    const struct chart *chart = &charts[_i % CHARTS];
    const int n = _i / CHARTS;
    open_in(n, chart->from);
    forge(n, -1, chart->from);
    drives[n].command.mode = (cm1e_mode_t)chart->to;
    cycles(1500);
    ck_assert_msg(drives[n].fault.error == CM1E_ERROR_DRIVE_MODE_TIMEOUT, "ID%d: from %d to %d: error %s", n + 1,
                  chart->from, chart->to, cm1e_strerror(drives[n].fault.error));
    ck_assert_msg(strlen(drive_text(n)) > 60, "ID%d: %s", n + 1, drive_text(n));
    ck_assert(!drives[n].feedback.enabled);
    close_drives();
}
END_TEST

/** The drawing of BR 6: what leads where, by the tables and on the wire. */
START_TEST(test_no_mode_is_written_that_no_way_leads_to)
{
    static const int modes[] = {CSP, HM, CML, CMD, CPIO};
    static const bool leads[5][5] = {
        /* to csp  hm     CML    CMD    CPIO */
        {true, true, true, true, true},
        {true, true, false, false, false},
        {true, false, true, true, true},
        {false, false, true, true, true},
        {false, false, true, true, true},
    };
    const int from = _i % 5, n = _i / 5;
    for (int to = 0; to < 5; to++) {
        const char *why = NULL;
        open_in(n, modes[from]);
        forge(n, 0, modes[from]);
        const cm1e_error_t error = cm1e_drive_mode_check(&drives[n], (cm1e_mode_t)modes[to], false, &why);
        ck_assert_msg((error == CM1E_OK) == leads[from][to], "ID%d: from %d to %d: %s", n + 1, modes[from], modes[to],
                      cm1e_strerror(error));
        ck_assert(leads[from][to] || (why && strlen(why) > 40));
        drives[n].command.mode = (cm1e_mode_t)modes[to];
        cycles(150);
        ck_assert_msg(leads[from][to] || count_sdos(true, on_wire(n, 0x6060)) == 0, "ID%d: from %d, %d is written",
                      n + 1, modes[from], modes[to]);
        ck_assert_int_eq(motor(n)->mode, modes[leads[from][to] ? to : from]);
        close_drives();
    }
}
END_TEST

/** BR 6 note 2: csp by way of CML after CMD or CPIO is for who insists. */
START_TEST(test_csp_after_cmd_is_for_who_insists)
{
    const int n = _i / 2, expanded = _i % 2 ? CMD : CPIO;
    const char *why = NULL;
    open_in(n, expanded);
    reach_mode(n, CML);
    forge(n, 0, CML);
    ck_assert_int_eq(cm1e_drive_mode_check(&drives[n], (cm1e_mode_t)CSP, false, &why), CM1E_ERROR_STATE);
    ck_assert_msg(why && strstr(why, "abnormal"), "%s", why ? why : "");
    drives[n].command.mode = (cm1e_mode_t)CSP;
    cycles(150);
    ck_assert_int_eq(count_sdos(true, on_wire(n, 0x6060)), 0);
    drives[n].command.mode_insist = true;
    ck_assert_int_eq(cm1e_drive_mode_check(&drives[n], (cm1e_mode_t)CSP, true, NULL), CM1E_OK);
    ck_assert_msg(switched(n, CSP), "ID%d: %s", n + 1, drive_text(n));
    close_drives();
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("flow charts of appendix 3");
    TCase *all = tcase_create("all");
    tcase_set_timeout(all, 60);
    tcase_add_loop_test(all, test_mode_is_written_and_read_until_it_is_shown, 0, CHARTS * DRIVES);
    tcase_add_loop_test(all, test_mode_is_not_written_in_motion_nor_with_an_error, 0, 2 * CHARTS * DRIVES);
    tcase_add_loop_test(all, test_hm_is_reached_under_torque_once_the_motor_stands, 0, DRIVES);
    tcase_add_loop_test(all, test_switch_that_is_never_confirmed_is_an_error, 0, CHARTS * DRIVES);
    tcase_add_loop_test(all, test_no_mode_is_written_that_no_way_leads_to, 0, 5 * DRIVES);
    tcase_add_loop_test(all, test_csp_after_cmd_is_for_who_insists, 0, 2 * DRIVES);
    suite_add_tcase(suite, all);
    return run_flows(suite, branches, sizeof branches / sizeof branches[0]);
}
