/* CMD behind a bridge: the flows of BR appendix 1 with each of their branches (answer, none, F8h, F9h), the end of a
 * search that nobody waits for any more, and the bus lost in each cycle of them. */
#include "drive_bridge_bench.h"

enum { FREE = CM1E_DRIVE_CMD_MOTOR_FREE, ENABLE = CM1E_DRIVE_CMD_MOTOR_ENABLE, SEARCH = CM1E_DRIVE_CMD_ORIGIN_SEARCH,
       RESET = CM1E_DRIVE_CMD_RESET_COUNTER, ABORT = CM1E_DRIVE_CMD_ORIGIN_SEARCH_ABORT };
static const int commands[] = {FREE, ENABLE, SEARCH, RESET, ABORT};

static void open_in_cmd(void)
{
    bench_open(CM1E_DEVICE_EB12, 3);
    TEST_ASSERT_TRUE(bench_mode(CM1E_BRIDGE_MODE_CMD, 100));
}

void setUp(void) { open_in_cmd(); }
void tearDown(void) { bench_close(); }

static void start(int command)
{
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_drive_cmd_start(&drive, (cm1e_drive_cmd_t)command, 0));
    TEST_ASSERT_EQUAL_INT(CM1E_DRIVE_CMD_SENDING, cm1e_drive_cmd_state(&drive));
}

static cm1e_drive_cmd_state_t finish(int at_most)
{
    while (cm1e_drive_cmd_busy(cm1e_drive_cmd_state(&drive)) && at_most-- > 0)
        bench_cycle();
    return cm1e_drive_cmd_state(&drive);
}

static cm1e_drive_cmd_state_t execute(int command)
{
    start(command);
    return finish(200);
}

static bool searches(void) { return cm1e_sim_search_running(&fake_bridge_axis()->search); }

/* A search that takes its time: the switch is far away. */
static void begin_search(void)
{
    TEST_ASSERT_EQUAL_INT(CM1E_DRIVE_CMD_DONE, execute(ENABLE));
    *cm1e_sim_bridge_k(fake_bridge.app, fake_bridge.axis, 42) = 10;
    start(SEARCH);
    for (int i = 0; i < 50 && cm1e_drive_cmd_state(&drive) == CM1E_DRIVE_CMD_SENDING; i++)
        bench_cycle();
    TEST_ASSERT_EQUAL_INT(CM1E_DRIVE_CMD_SEARCHING, cm1e_drive_cmd_state(&drive));
    TEST_ASSERT_TRUE(searches());
}

/* ---- the flows -------------------------------------------------------------------------------------------------- */

static void test_nothing_is_on_the_wire_before_the_first_command(void)
{
    for (int i = 0; i < 100; i++) {
        bench_cycle();
        TEST_ASSERT_EQUAL_HEX16(0, bench_word());
    }
    TEST_ASSERT_EQUAL_INT(CM1E_DRIVE_CMD_IDLE, cm1e_drive_cmd_state(&drive));
}

static void test_five_cycles_of_0007_then_five_of_the_command_then_the_answer(void)
{
    for (size_t i = 0; i < sizeof commands / sizeof commands[0]; i++) {
        open_in_cmd();
        fake_bridge.statusword = 0;
        start(commands[i]);
        cm1e_drive_write(&drive);
        for (int n = 0; n < 5; n++) {
            TEST_ASSERT_EQUAL_HEX16(0x0007, bench_word());
            bench_cycle();
        }
        for (int n = 0; n < 4; n++) {
            TEST_ASSERT_EQUAL_HEX16(commands[i] << 8 | 7, bench_word());
            bench_cycle();
        }
        TEST_ASSERT_EQUAL_HEX16(commands[i] << 8 | 7, bench_word());
        TEST_ASSERT_EQUAL_INT(CM1E_DRIVE_CMD_SENDING, cm1e_drive_cmd_state(&drive));
        fake_bridge.statusword = commands[i] << 8 | 0x5A; /* the low byte is nothing */
        bench_cycle();
        if (commands[i] == SEARCH) {
            TEST_ASSERT_EQUAL_INT(CM1E_DRIVE_CMD_SEARCHING, cm1e_drive_cmd_state(&drive));
            TEST_ASSERT_EQUAL_HEX16(0xF307, bench_word());
            continue;
        }
        TEST_ASSERT_EQUAL_INT(CM1E_DRIVE_CMD_DONE, cm1e_drive_cmd_state(&drive));
        bench_cycles(3);
        TEST_ASSERT_EQUAL_HEX16(0x0007, bench_word());
    }
}

static void test_an_early_answer_does_not_cut_the_five_cycles(void)
{
    fake_bridge.statusword = FREE << 8;
    start(FREE);
    int cycles = 0;
    while (cm1e_drive_cmd_busy(cm1e_drive_cmd_state(&drive)) && cycles++ < 100)
        bench_cycle();
    TEST_ASSERT_EQUAL_INT(10, cycles);
}

static void test_the_commands_do_on_the_motor_what_they_say(void)
{
    TEST_ASSERT_EQUAL_INT(CM1E_DRIVE_CMD_DONE, execute(ENABLE));
    TEST_ASSERT_FALSE(fake_bridge_axis()->motor_free);
    fake_bridge_axis()->zero = -5000;
    TEST_ASSERT_EQUAL_INT(CM1E_DRIVE_CMD_DONE, execute(RESET));
    bench_cycle();
    TEST_ASSERT_EQUAL_INT32(0, drive.feedback.position);
    TEST_ASSERT_EQUAL_INT(CM1E_DRIVE_CMD_DONE, execute(FREE));
    TEST_ASSERT_TRUE(fake_bridge_axis()->motor_free);
    TEST_ASSERT_EQUAL_INT(CM1E_DRIVE_CMD_DONE, execute(FREE)); /* again, with its answer still standing */
}

static void test_no_answer_is_a_sending_error_in_time(void)
{
    for (size_t i = 0; i < sizeof commands / sizeof commands[0]; i++) {
        open_in_cmd();
        fake_bridge.statusword = 0xF500;
        start(commands[i]);
        int cycles = 0;
        while (cm1e_drive_cmd_busy(cm1e_drive_cmd_state(&drive)) && cycles++ < 1000)
            bench_cycle();
        TEST_ASSERT_EQUAL_INT(CM1E_DRIVE_CMD_NOT_SENT, cm1e_drive_cmd_state(&drive));
        TEST_ASSERT_LESS_THAN_INT(120, cycles);
        if (commands[i] == SEARCH)
            continue;
        bench_cycles(3);
        TEST_ASSERT_EQUAL_HEX16(0x0007, bench_word());
        fake_bridge.statusword = -1; /* "Back to Command Start (in case of retry)" */
        TEST_ASSERT_EQUAL_INT(CM1E_DRIVE_CMD_DONE, execute(commands[i]));
    }
}

static void test_a_free_motor_does_not_answer_to_a_search(void)
{
    TEST_ASSERT_EQUAL_INT(CM1E_DRIVE_CMD_NOT_SENT, execute(SEARCH));
}

static void test_a_late_answer_counts(void)
{
    fake_bridge.statusword = 0;
    start(ENABLE);
    bench_cycles(60);
    fake_bridge.statusword = ENABLE << 8;
    TEST_ASSERT_EQUAL_INT(CM1E_DRIVE_CMD_DONE, finish(2));
}

/* ---- origin search ---------------------------------------------------------------------------------------------- */

static void test_a_search_that_finds_is_done_by_f8(void)
{
    TEST_ASSERT_EQUAL_INT(CM1E_DRIVE_CMD_DONE, execute(ENABLE));
    *cm1e_sim_bridge_k(fake_bridge.app, fake_bridge.axis, 42) = 500;
    TEST_ASSERT_EQUAL_INT(0, bench_sdo(OBJ_6098_HOMING_METHOD, 0, 3)); /* switch CW */
    start(SEARCH);
    TEST_ASSERT_EQUAL_INT(CM1E_DRIVE_CMD_DONE, finish(20000));
    TEST_ASSERT_FALSE(searches());
    bench_cycles(3);
    TEST_ASSERT_EQUAL_HEX16(0x0007, bench_word());
    start(SEARCH); /* the F8h of before is not the answer to this one */
    bench_cycles(30);
    TEST_ASSERT_EQUAL_INT(CM1E_DRIVE_CMD_SEARCHING, cm1e_drive_cmd_state(&drive));
}

static void test_an_old_f8_is_no_answer_and_a_new_one_is(void)
{
    for (int old = 0xF8; old <= 0xF9; old++)
        for (int now = 0xF8; now <= 0xF9; now++) {
            open_in_cmd();
            fake_bridge.statusword = old << 8;
            start(SEARCH);
            bench_cycles(30);
            TEST_ASSERT_EQUAL_INT(CM1E_DRIVE_CMD_SENDING, cm1e_drive_cmd_state(&drive));
            fake_bridge.statusword = now << 8;
            bench_cycle();
            if (old == now)
                TEST_ASSERT_EQUAL_INT(CM1E_DRIVE_CMD_NOT_SENT, finish(200));
            else
                TEST_ASSERT_EQUAL_INT(now == 0xF8 ? CM1E_DRIVE_CMD_DONE : CM1E_DRIVE_CMD_SEARCH_TIME_OUT,
                                      cm1e_drive_cmd_state(&drive));
        }
}

static void test_f9_is_a_search_time_out(void)
{
    begin_search();
    fake_bridge.statusword = 0xF900;
    bench_cycle();
    TEST_ASSERT_EQUAL_INT(CM1E_DRIVE_CMD_SEARCH_TIME_OUT, cm1e_drive_cmd_state(&drive));
    bench_cycles(50);
    TEST_ASSERT_EQUAL_HEX16(0x0007, bench_word()); /* it says itself that it is over: nothing is to abort */
}

static void test_a_search_takes_no_other_command_but_those_that_end_it(void)
{
    for (size_t i = 0; i < sizeof commands / sizeof commands[0]; i++) {
        open_in_cmd();
        begin_search();
        const bool ends = commands[i] == FREE || commands[i] == ABORT;
        TEST_ASSERT_EQUAL_INT(ends ? CM1E_OK : CM1E_ERROR_BUSY,
                              cm1e_drive_cmd_start(&drive, (cm1e_drive_cmd_t)commands[i], 0));
        bench_cycles(20);
        TEST_ASSERT_EQUAL_INT(!ends, searches());
        TEST_ASSERT_EQUAL_INT(ends ? CM1E_DRIVE_CMD_DONE : CM1E_DRIVE_CMD_SEARCHING, cm1e_drive_cmd_state(&drive));
        TEST_ASSERT_EQUAL_INT(commands[i] == FREE, fake_bridge_axis()->motor_free);
    }
}

static void test_the_own_time_of_a_search_ends_it_on_the_motor_too(void)
{
    TEST_ASSERT_EQUAL_INT(CM1E_DRIVE_CMD_DONE, execute(ENABLE));
    *cm1e_sim_bridge_k(fake_bridge.app, fake_bridge.axis, 42) = 10;
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_drive_cmd_start(&drive, CM1E_DRIVE_CMD_ORIGIN_SEARCH, 200 * CYCLE_NS));
    TEST_ASSERT_EQUAL_INT(CM1E_DRIVE_CMD_GIVEN_UP, finish(300));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_BUSY, cm1e_drive_cmd_start(&drive, CM1E_DRIVE_CMD_ORIGIN_SEARCH, 0));
    bench_cycles(20);
    TEST_ASSERT_FALSE(searches());
    TEST_ASSERT_FALSE(fake_bridge_axis()->motor_free); /* F607h was enough */
    TEST_ASSERT_EQUAL_INT(CM1E_DRIVE_CMD_GIVEN_UP, cm1e_drive_cmd_state(&drive));
}

static void test_a_search_that_is_not_known_to_be_heard_is_ended(void)
{
    TEST_ASSERT_EQUAL_INT(CM1E_DRIVE_CMD_DONE, execute(ENABLE));
    fake_bridge.statusword = 0; /* the motor hears, its answers do not arrive */
    TEST_ASSERT_EQUAL_INT(CM1E_DRIVE_CMD_NOT_SENT, execute(SEARCH));
    TEST_ASSERT_TRUE(searches());
    bench_cycles(12);
    TEST_ASSERT_FALSE(searches());
    bench_cycles(120);
    TEST_ASSERT_TRUE(fake_bridge_axis()->motor_free); /* F607h had no answer: F107h */
    bench_cycles(500);
    TEST_ASSERT_EQUAL_HEX16(0x0007, bench_word()); /* bounded */
    TEST_ASSERT_EQUAL_INT(CM1E_DRIVE_CMD_NOT_SENT, cm1e_drive_cmd_state(&drive));
}

/* ---- refused ---------------------------------------------------------------------------------------------------- */

static void test_what_is_no_command_or_no_time_for_one(void)
{
    for (int word = 0; word < 0x100; word++) {
        const bool known = word == FREE || word == ENABLE || word == SEARCH || word == RESET || word == ABORT;
        if (!known)
            TEST_ASSERT_EQUAL_INT(CM1E_ERROR_INVALID_ARGUMENT,
                                  cm1e_drive_cmd_start(&drive, (cm1e_drive_cmd_t)word, 0));
    }
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_INVALID_ARGUMENT, cm1e_drive_cmd_start(&drive, CM1E_DRIVE_CMD_ORIGIN_SEARCH, -1));
    start(ENABLE);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_BUSY, cm1e_drive_cmd_start(&drive, CM1E_DRIVE_CMD_RESET_COUNTER, 0));
    finish(100);
    fake_bridge.lost = true;
    bench_cycles(2);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_OFFLINE, cm1e_drive_cmd_start(&drive, CM1E_DRIVE_CMD_MOTOR_ENABLE, 0));
}

static void test_no_command_reaches_the_wire_in_another_mode(void)
{
    static const int others[] = {CM1E_BRIDGE_MODE_CSP, CM1E_BRIDGE_MODE_HM, CM1E_BRIDGE_MODE_CML,
                                 CM1E_BRIDGE_MODE_CPIO};
    for (int i = 0; i < 4; i++) {
        bench_open(CM1E_DEVICE_EB12, 1);
        if (others[i] != CM1E_BRIDGE_MODE_CSP)
            TEST_ASSERT_TRUE(bench_mode(others[i], 100));
        for (size_t k = 0; k < sizeof commands / sizeof commands[0]; k++)
            TEST_ASSERT_EQUAL_INT(CM1E_ERROR_STATE, cm1e_drive_cmd_start(&drive, (cm1e_drive_cmd_t)commands[k], 0));
        bench_cycles(20);
        TEST_ASSERT_EQUAL_HEX8(0, bench_word() >> 8 & 0x3F);
        TEST_ASSERT_TRUE(cm1e_drive_cmd_release(&drive));
    }
    cm1e_drive_t other = {0}; /* a CM1-E has none of this */
    static cm1e_bus_t own;
    fake_bus_init(&own, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_drive_init(&other, &own, 0, &diag));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_STATE, cm1e_drive_cmd_start(&other, CM1E_DRIVE_CMD_MOTOR_FREE, 0));
    TEST_ASSERT_EQUAL_INT(CM1E_DRIVE_CMD_IDLE, cm1e_drive_cmd_state(&other));
    TEST_ASSERT_TRUE(cm1e_drive_cmd_release(&other));
}

static void test_cmd_is_not_left_while_something_moves(void)
{
    begin_search();
    TEST_ASSERT_FALSE(bench_mode(CM1E_BRIDGE_MODE_CML, 200));
    TEST_ASSERT_TRUE(searches());
    start(ABORT);
    finish(100);
    TEST_ASSERT_TRUE(bench_mode(CM1E_BRIDGE_MODE_CML, 200));
    TEST_ASSERT_EQUAL_HEX16(0, bench_word());
}

/* ---- the bus is away -------------------------------------------------------------------------------------------- */

/* The watchdog of the bridge, where the frames stay away: it ends every motion. */
static void bridge_falls_silent(void)
{
    fake_bridge.lost = true;
    for (int i = 0; i < 150; i++) {
        if (i == 100)
            cm1e_sim_bridge_ops.watchdog_expired(fake_bridge.app);
        bench_cycle();
    }
}

static void test_a_bus_lost_in_any_cycle_is_told_and_leaves_no_search(void)
{
    for (size_t k = 0; k < sizeof commands / sizeof commands[0]; k++)
        for (int at = 0; at < 16; at++)
            for (int watchdog = 0; watchdog < 2; watchdog++) {
                open_in_cmd();
                TEST_ASSERT_EQUAL_INT(CM1E_DRIVE_CMD_DONE, execute(ENABLE));
                *cm1e_sim_bridge_k(fake_bridge.app, fake_bridge.axis, 42) = 10;
                start(commands[k]);
                bench_cycles(at);
                const bool busy = cm1e_drive_cmd_busy(cm1e_drive_cmd_state(&drive));
                fake_bridge.lost = true;
                if (watchdog)
                    bridge_falls_silent();
                else
                    bench_cycles(120);
                TEST_ASSERT_EQUAL_INT(busy ? CM1E_DRIVE_CMD_LOST : CM1E_DRIVE_CMD_DONE,
                                      cm1e_drive_cmd_state(&drive));
                fake_bridge.lost = false;
                bench_cycles(30);
                TEST_ASSERT_FALSE(searches());
                TEST_ASSERT_EQUAL_HEX16(0x0007, bench_word());
            }
}

static void test_frames_lost_now_and_then_change_nothing(void)
{
    for (int at = 0; at < 20; at++)
        for (int count = 1; count < 8; count++) {
            open_in_cmd();
            start(ENABLE);
            for (int i = 0; i < 60; i++) {
                fake_bridge.lost = i >= at && i < at + count;
                bench_cycle();
            }
            TEST_ASSERT_EQUAL_INT(CM1E_DRIVE_CMD_DONE, cm1e_drive_cmd_state(&drive));
            TEST_ASSERT_FALSE(fake_bridge_axis()->motor_free);
        }
}

static void test_a_slave_that_left_operational_is_told_at_once(void)
{
    begin_search();
    bus.watch.al_state = CM1E_AL_SAFE_OP;
    bench_cycle();
    TEST_ASSERT_EQUAL_INT(CM1E_DRIVE_CMD_LOST, cm1e_drive_cmd_state(&drive));
    TEST_ASSERT_TRUE(cm1e_drive_cmd_release(&drive));
    bench_cycles(20); /* it may come back from a power-off, in csp, where 0007h is Switch on */
    TEST_ASSERT_EQUAL_HEX16(0, bench_word());
    bus.watch.al_state = CM1E_AL_OP; /* but it does not: the search is still under way */
    TEST_ASSERT_TRUE(searches());
    bench_cycles(40);
    TEST_ASSERT_FALSE(searches());
}

static void test_a_bridge_that_was_switched_off_has_forgotten_the_search(void)
{
    begin_search();
    fake_bridge.lost = true;
    bench_cycles(150);
    cm1e_sim_bridge_ops.power_on(fake_bridge.app, bus.clock.virtual_now_ns);
    cm1e_sim_bridge_ops.state_change(fake_bridge.app, CM1E_AL_INIT, CM1E_AL_OP);
    cm1e_drive_fail(&drive, CM1E_ERROR_BUS_LOST);
    fake_bridge.lost = false;
    bus.watch.al_state = CM1E_AL_SAFE_OP; /* until it is recovered nothing of ours reaches it */
    bench_cycles(60);
    bus.watch.al_state = CM1E_AL_OP;
    drive.command.mode = CM1E_MODE_CSP;
    TEST_ASSERT_TRUE(bench_reset(500));
    TEST_ASSERT_TRUE(bench_mode(CM1E_BRIDGE_MODE_CSP, 100));
    bench_cycles(10);
    TEST_ASSERT_FALSE(cm1e_drive_cmd_busy(cm1e_drive_cmd_state(&drive)));
    TEST_ASSERT_FALSE(drive.behind->cmd.may_search);
    bench_enable();
}

/* ---- the end of a run ------------------------------------------------------------------------------------------- */

static int release(void)
{
    int cycles = 0;
    while (!cm1e_drive_cmd_release(&drive) && cycles++ < 5000)
        bench_cycle();
    return cycles;
}

static void test_release_from_every_cycle_of_a_search_frees_the_motor(void)
{
    for (int at = 0; at < 40; at++) {
        open_in_cmd();
        TEST_ASSERT_EQUAL_INT(CM1E_DRIVE_CMD_DONE, execute(ENABLE));
        *cm1e_sim_bridge_k(fake_bridge.app, fake_bridge.axis, 42) = 10;
        start(SEARCH);
        bench_cycles(at);
        TEST_ASSERT_LESS_THAN_INT(60, release());
        TEST_ASSERT_FALSE(searches());
        TEST_ASSERT_TRUE(fake_bridge_axis()->motor_free);
        TEST_ASSERT_EQUAL_INT(0, release());
    }
}

static void test_release_ends_in_time_without_answers(void)
{
    begin_search();
    fake_bridge.statusword = 0;
    TEST_ASSERT_LESS_OR_EQUAL_INT(2001, release());
    TEST_ASSERT_FALSE(searches());
    TEST_ASSERT_TRUE(fake_bridge_axis()->motor_free);
    open_in_cmd();
    TEST_ASSERT_EQUAL_INT(0, release()); /* nothing was commanded */
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_nothing_is_on_the_wire_before_the_first_command);
    RUN_TEST(test_five_cycles_of_0007_then_five_of_the_command_then_the_answer);
    RUN_TEST(test_an_early_answer_does_not_cut_the_five_cycles);
    RUN_TEST(test_the_commands_do_on_the_motor_what_they_say);
    RUN_TEST(test_no_answer_is_a_sending_error_in_time);
    RUN_TEST(test_a_free_motor_does_not_answer_to_a_search);
    RUN_TEST(test_a_late_answer_counts);
    RUN_TEST(test_a_search_that_finds_is_done_by_f8);
    RUN_TEST(test_an_old_f8_is_no_answer_and_a_new_one_is);
    RUN_TEST(test_f9_is_a_search_time_out);
    RUN_TEST(test_a_search_takes_no_other_command_but_those_that_end_it);
    RUN_TEST(test_the_own_time_of_a_search_ends_it_on_the_motor_too);
    RUN_TEST(test_a_search_that_is_not_known_to_be_heard_is_ended);
    RUN_TEST(test_what_is_no_command_or_no_time_for_one);
    RUN_TEST(test_no_command_reaches_the_wire_in_another_mode);
    RUN_TEST(test_cmd_is_not_left_while_something_moves);
    RUN_TEST(test_a_bus_lost_in_any_cycle_is_told_and_leaves_no_search);
    RUN_TEST(test_frames_lost_now_and_then_change_nothing);
    RUN_TEST(test_a_slave_that_left_operational_is_told_at_once);
    RUN_TEST(test_a_bridge_that_was_switched_off_has_forgotten_the_search);
    RUN_TEST(test_release_from_every_cycle_of_a_search_frees_the_motor);
    RUN_TEST(test_release_ends_in_time_without_answers);
    return UNITY_END();
}
