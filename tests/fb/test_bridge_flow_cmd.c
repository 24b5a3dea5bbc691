/**
 * The flow charts of appendix 1 of the bridge's guide, commands in CMD mode, on every motor of a bridge: each branch of
 * each chart is taken, by the simulated bridge itself where it would take it, else by what the tap makes of its answer.
 * What counts is what was on the wire: 0007h for five cycles, the command for five cycles, 0007h at the end.
 */
#include "bridge_drives.h"

enum { READY = 0x0007, PDO_CYCLES = 5 };

typedef enum way {
    SEARCH_SENT, SEARCH_NOT_SENT, SEARCH_RETRY, SEARCH_COMPLETED, SEARCH_NOT_COMPLETED, SEARCH_TIMED_OUT,
    SEARCH_NOT_TIMED_OUT,
    FREE_ANSWERED, FREE_NOT_SENT, FREE_RETRY,
    RESET_ANSWERED, RESET_NOT_SENT, RESET_RETRY,
    ENABLE_ANSWERED, ENABLE_NOT_SENT, ENABLE_RETRY,
    ABORT_ANSWERED, ABORT_NOT_SENT, ABORT_RETRY,
} way_t;

static branch_t branches[] = {
    [SEARCH_SENT] = {"1.1", "statusword F3??h", "yes", 0},
    [SEARCH_NOT_SENT] = {"1.1", "statusword F3??h", "no: sending error", 0},
    [SEARCH_RETRY] = {"1.1", "after a sending error", "back to the start", 0},
    [SEARCH_COMPLETED] = {"1.1", "statusword F8??h", "yes: completed", 0},
    [SEARCH_NOT_COMPLETED] = {"1.1", "statusword F8??h", "no: wait", 0},
    [SEARCH_TIMED_OUT] = {"1.1", "statusword F9??h", "yes: time-out", 0},
    [SEARCH_NOT_TIMED_OUT] = {"1.1", "statusword F9??h", "no: wait", 0},
    [FREE_ANSWERED] = {"1.2", "statusword F1??h", "yes: completed", 0},
    [FREE_NOT_SENT] = {"1.2", "statusword F1??h", "no: sending error", 0},
    [FREE_RETRY] = {"1.2", "after a sending error", "back to the start", 0},
    [RESET_ANSWERED] = {"1.3", "statusword F4??h", "yes: completed", 0},
    [RESET_NOT_SENT] = {"1.3", "statusword F4??h", "no: sending error", 0},
    [RESET_RETRY] = {"1.3", "after a sending error", "back to the start", 0},
    [ENABLE_ANSWERED] = {"1.4", "statusword F2??h", "yes: completed", 0},
    [ENABLE_NOT_SENT] = {"1.4", "statusword F2??h", "no: sending error", 0},
    [ENABLE_RETRY] = {"1.4", "after a sending error", "back to the start", 0},
    [ABORT_ANSWERED] = {"1.5", "statusword F6??h", "yes: completed", 0},
    [ABORT_NOT_SENT] = {"1.5", "statusword F6??h", "no: sending error", 0},
    [ABORT_RETRY] = {"1.5", "after a sending error", "back to the start", 0},
};

/* ---- steps ------------------------------------------------------------------------------------------------------- */

static int mute; /* number of the motor whose answers the tap takes out; -1: none */

static void take_answer_out(unsigned axis, uint8_t *inputs)
{
    if ((int)axis == mute)
        inputs[1] = 0;
}

static void open_in_cmd(int n)
{
    mute = -1;
    open_drives();
    bridge_wire.forge_inputs = take_answer_out;
    cycles(100);
    reach_mode(n, CM1E_BRIDGE_MODE_CMD);
}

static int run_before; /* the last controlword before the command */
static int starting;
static cm1e_drive_cmd_t to_start;

/* Where a program of the cycle would do it: behind the inputs, before the outputs. */
static void start_now(void)
{
    const cm1e_error_t error = cm1e_drive_cmd_start(&drives[starting], to_start, 0);
    ck_assert_msg(error == CM1E_OK, "ID%d, command %02Xh: %s", starting + 1, to_start, cm1e_strerror(error));
    each_cycle = NULL;
}

static void start(int n, cm1e_drive_cmd_t command)
{
    run_before = bridge_wire.word_count[n] - 1;
    starting = n;
    to_start = command;
    each_cycle = start_now;
    cycles(1);
}

static cm1e_drive_cmd_state_t finish(int n, int most)
{
    while (most-- > 0 && cm1e_drive_cmd_busy(cm1e_drive_cmd_state(&drives[n])))
        cycles(1);
    return cm1e_drive_cmd_state(&drives[n]);
}

/** 0007h for five cycles, the command for five, and 0007h again at the end. */
static void check_words(int n, cm1e_drive_cmd_t command)
{
    cycles(2 * PDO_CYCLES);
    const int at = find_word((unsigned)n, run_before + 1, (uint16_t)(command << 8 | READY));
    const char *seen = words_seen((unsigned)n);
    const word_run_t *words = bridge_wire.words[n];
    ck_assert_msg(at > 0, "ID%d: %02X07h does not come behind 0007h:%s", n + 1, command, seen);
    ck_assert_msg(words[at - 1].word == READY && words[at - 1].cycles >= PDO_CYCLES,
                  "ID%d: 0007h does not stand for five cycles before %02X07h:%s", n + 1, command, seen);
    ck_assert_msg(words[at].cycles >= PDO_CYCLES, "ID%d: %02X07h does not stand for five cycles:%s", n + 1, command,
                  seen);
    ck_assert_msg(words[bridge_wire.word_count[n] - 1].word == READY, "ID%d: 0007h is not the last word:%s", n + 1,
                  seen);
}

/** Charts 1.2 to 1.4 have one form: the answer comes, or a sending error and another attempt. */
static void run_chart(int n, cm1e_drive_cmd_t command, way_t answered)
{
    start(n, command);
    mute = n;
    cm1e_drive_cmd_state_t state = finish(n, 1000);
    ck_assert_msg(state == CM1E_DRIVE_CMD_NOT_SENT, "ID%d, %02X07h without an answer: state %d", n + 1, command, state);
    check_words(n, command);
    branches[answered + 1].taken++;
    mute = -1;
    start(n, command);
    state = finish(n, 1000);
    ck_assert_msg(state == CM1E_DRIVE_CMD_DONE, "ID%d, %02X07h: state %d, statusword %04Xh", n + 1, command, state,
                  bridge_wire.status[n]);
    check_words(n, command);
    branches[answered].taken++;
    branches[answered + 2].taken++;
}

static void must_be_done(int n, cm1e_drive_cmd_t command)
{
    start(n, command);
    const cm1e_drive_cmd_state_t state = finish(n, 1000);
    ck_assert_msg(state == CM1E_DRIVE_CMD_DONE, "ID%d, %02X07h: state %d", n + 1, command, state);
    check_words(n, command);
}

/* So slow that a search lasts, or so fast that it ends soon. */
static void set_search_speed(int n, int units)
{
    cm1e_diag_t diag = {0};
    const uint32_t value = (uint32_t)units;
    const uint16_t index = cm1e_drive_index(&drives[n], OBJ_6099_HOMING_SPEEDS);
    for (uint8_t subindex = 1; subindex <= 2; subindex++)
        ck_assert_msg(cm1e_sdo_write(bus, 1, index, subindex, &value, sizeof value, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_msg(cm1e_sdo_write(bus, 1, cm1e_drive_index(&drives[n], OBJ_609A_HOMING_ACCELERATION), 0,
                                 &(uint32_t){5000}, 4, &diag) == CM1E_OK, "%s", diag.text);
}

static void must_stand(int n)
{
    cycles(200);
    const double position = motor(n)->mechanics.position;
    cycles(100);
    ck_assert_msg(fabs(motor(n)->mechanics.position - position) < 3, "ID%d moves on: from %.0f to %.0f", n + 1,
                  position, motor(n)->mechanics.position);
}

/* ---- appendix 1.1 ------------------------------------------------------------------------------------------------ */

START_TEST(test_origin_search_takes_every_branch)
{
    const int n = _i;
    open_in_cmd(n);
    set_search_speed(n, 5000);
    must_be_done(n, CM1E_DRIVE_CMD_MOTOR_ENABLE);

    start(n, CM1E_DRIVE_CMD_ORIGIN_SEARCH);
    mute = n;
    cm1e_drive_cmd_state_t state = finish(n, 2000);
    ck_assert_msg(state == CM1E_DRIVE_CMD_NOT_SENT, "ID%d, F307h without an answer: state %d", n + 1, state);
    branches[SEARCH_NOT_SENT].taken++;
    ck_assert(find_word((unsigned)n, run_before + 1, 0xF307) > 0);
    cycles(200);
    mute = -1;
    /* The search was under way all the same: it does not go on behind anybody's back. */
    cycles(200);
    ck_assert_msg(!cm1e_sim_search_running(&motor(n)->search), "ID%d: searches on after a sending error", n + 1);
    must_stand(n);

    must_be_done(n, CM1E_DRIVE_CMD_MOTOR_ENABLE);
    start(n, CM1E_DRIVE_CMD_ORIGIN_SEARCH);
    branches[SEARCH_RETRY].taken++;
    int waited = 0;
    for (int i = 0; i < 5000 && cm1e_drive_cmd_busy(cm1e_drive_cmd_state(&drives[n])); i++) {
        cycles(1);
        waited += bridge_wire.status[n] >> 8 == 0xF3 && cm1e_drive_cmd_state(&drives[n]) == CM1E_DRIVE_CMD_SEARCHING;
    }
    state = cm1e_drive_cmd_state(&drives[n]);
    ck_assert_msg(waited > PDO_CYCLES, "ID%d: the search was not waited for", n + 1);
    branches[SEARCH_SENT].taken++;
    branches[SEARCH_NOT_COMPLETED].taken++;
    branches[SEARCH_NOT_TIMED_OUT].taken++;
    ck_assert_msg(state == CM1E_DRIVE_CMD_DONE && bridge_wire.status[n] >> 8 == 0xF8, "ID%d: state %d, statusword "
                  "%04Xh", n + 1, state, bridge_wire.status[n]);
    branches[SEARCH_COMPLETED].taken++;
    check_words(n, CM1E_DRIVE_CMD_ORIGIN_SEARCH);
    ck_assert_msg(abs(bridge_wire.position[n]) < 20, "ID%d: at %d after its search", n + 1, bridge_wire.position[n]);
    close_drives();
}
END_TEST

START_TEST(test_origin_search_that_finds_nothing)
{
    const int n = _i;
    open_in_cmd(n);
    set_search_speed(n, 100);
    must_be_done(n, CM1E_DRIVE_CMD_MOTOR_ENABLE);
    start(n, CM1E_DRIVE_CMD_ORIGIN_SEARCH);
    cycles(300);
    ck_assert_int_eq(cm1e_drive_cmd_state(&drives[n]), CM1E_DRIVE_CMD_SEARCHING);
    simulate("motor 1 %d error overload", n);
    const cm1e_drive_cmd_state_t state = finish(n, 1000);
    ck_assert_msg(state == CM1E_DRIVE_CMD_SEARCH_TIME_OUT && bridge_wire.status[n] >> 8 == 0xF9,
                  "ID%d: state %d, statusword %04Xh", n + 1, state, bridge_wire.status[n]);
    branches[SEARCH_TIMED_OUT].taken++;
    check_words(n, CM1E_DRIVE_CMD_ORIGIN_SEARCH);
    must_stand(n);
    close_drives();
}
END_TEST

/** A free motor has nothing to search with, and gives no answer: the sending error of the device itself. */
START_TEST(test_origin_search_of_a_free_motor_is_a_sending_error)
{
    const int n = _i;
    open_in_cmd(n);
    must_be_done(n, CM1E_DRIVE_CMD_MOTOR_FREE);
    start(n, CM1E_DRIVE_CMD_ORIGIN_SEARCH);
    const cm1e_drive_cmd_state_t state = finish(n, 2000);
    ck_assert_msg(state == CM1E_DRIVE_CMD_NOT_SENT, "ID%d: state %d", n + 1, state);
    branches[SEARCH_NOT_SENT].taken++;
    must_stand(n);
    close_drives();
}
END_TEST

/* ---- appendix 1.2 ... 1.5 ---------------------------------------------------------------------------------------- */

START_TEST(test_motor_enable_and_motor_free)
{
    const int n = _i;
    open_in_cmd(n);
    const double position = motor(n)->mechanics.position;
    must_be_done(n, CM1E_DRIVE_CMD_MOTOR_FREE);
    run_chart(n, CM1E_DRIVE_CMD_MOTOR_ENABLE, ENABLE_ANSWERED);
    ck_assert_msg(!motor(n)->motor_free, "ID%d is free after Motor enable", n + 1);
    ck_assert_double_eq_tol(motor(n)->mechanics.position, position, 2.0);
    run_chart(n, CM1E_DRIVE_CMD_MOTOR_FREE, FREE_ANSWERED);
    ck_assert_msg(motor(n)->motor_free, "ID%d is not free after Motor free", n + 1);
    close_drives();
}
END_TEST

START_TEST(test_reset_counter)
{
    const int n = _i;
    open_in_cmd(n);
    motor(n)->zero -= 1234;
    run_chart(n, CM1E_DRIVE_CMD_RESET_COUNTER, RESET_ANSWERED);
    ck_assert_msg(abs(bridge_wire.position[n]) <= 2, "ID%d: at %d after Reset counter", n + 1, bridge_wire.position[n]);
    close_drives();
}
END_TEST

static void begin_search(int n)
{
    must_be_done(n, CM1E_DRIVE_CMD_MOTOR_ENABLE);
    start(n, CM1E_DRIVE_CMD_ORIGIN_SEARCH);
    cycles(300);
    ck_assert_msg(cm1e_sim_search_running(&motor(n)->search), "ID%d does not search", n + 1);
}

/** An abort without an answer is the one command that the drive repeats by itself: a motor must not search on. */
START_TEST(test_origin_search_abort)
{
    const int n = _i;
    open_in_cmd(n);
    set_search_speed(n, 100);
    begin_search(n);
    must_be_done(n, CM1E_DRIVE_CMD_ORIGIN_SEARCH_ABORT);
    branches[ABORT_ANSWERED].taken++;
    ck_assert_msg(!cm1e_sim_search_running(&motor(n)->search), "ID%d searches after an abort", n + 1);
    must_stand(n);

    begin_search(n);
    start(n, CM1E_DRIVE_CMD_ORIGIN_SEARCH_ABORT);
    mute = n;
    const cm1e_drive_cmd_state_t state = finish(n, 1000);
    ck_assert_msg(state == CM1E_DRIVE_CMD_NOT_SENT, "ID%d, F607h without an answer: state %d", n + 1, state);
    branches[ABORT_NOT_SENT].taken++;
    mute = -1;
    cycles(50);
    const int first = find_word((unsigned)n, run_before + 1, 0xF607), again = find_word((unsigned)n, first + 1, 0xF607);
    ck_assert_msg(again > first && bridge_wire.words[n][again - 1].word == READY, "ID%d: F607h is not repeated:%s",
                  n + 1, words_seen((unsigned)n));
    branches[ABORT_RETRY].taken++;
    ck_assert_int_eq(bridge_wire.words[n][bridge_wire.word_count[n] - 1].word, READY);
    must_stand(n);
    close_drives();
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("flow charts of appendix 1");
    TCase *all = tcase_create("all");
    tcase_set_timeout(all, 60);
    tcase_add_loop_test(all, test_origin_search_takes_every_branch, 0, DRIVES);
    tcase_add_loop_test(all, test_origin_search_that_finds_nothing, 0, DRIVES);
    tcase_add_loop_test(all, test_origin_search_of_a_free_motor_is_a_sending_error, 0, DRIVES);
    tcase_add_loop_test(all, test_motor_enable_and_motor_free, 0, DRIVES);
    tcase_add_loop_test(all, test_reset_counter, 0, DRIVES);
    tcase_add_loop_test(all, test_origin_search_abort, 0, DRIVES);
    suite_add_tcase(suite, all);
    return run_flows(suite, branches, sizeof branches / sizeof branches[0]);
}
