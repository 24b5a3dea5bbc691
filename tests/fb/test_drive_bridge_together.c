/* The four drives behind one bridge at the same time, through the real bus: they share one mailbox, and none of them
 * disturbs another one or waits without end. */
#include "bridge_drives.h"

enum { CSP = CM1E_BRIDGE_MODE_CSP, HM = CM1E_BRIDGE_MODE_HM, CML = CM1E_BRIDGE_MODE_CML, CMD = CM1E_BRIDGE_MODE_CMD,
       CPIO = CM1E_BRIDGE_MODE_CPIO };

static void command_all(int mode)
{
    for (int n = 0; n < DRIVES; n++)
        drives[n].command.mode = (cm1e_mode_t)mode;
}

/* Milliseconds until all show the mode. */
static int wait_all(int mode)
{
    int waited = 0;
    for (int n = 0; n < DRIVES; n++)
        for (; drives[n].feedback.mode != mode || motor(n)->mode != mode; waited++) {
            ck_assert_msg(drives[n].fault.error == CM1E_OK && waited < 2000, "%s", drive_text(n));
            cycles(1);
        }
    return waited;
}

START_TEST(test_four_switch_at_once)
{
    open_drives();
    static const int tour[] = {CML, CSP, HM, CSP, CPIO, CMD, CML};
    for (size_t i = 0; i < sizeof tour / sizeof tour[0]; i++) {
        command_all(tour[i]);
        ck_assert_int_lt(wait_all(tour[i]), 200); /* of the second that a switch may take */
        for (int n = 0; n < DRIVES; n++)
            ck_assert(motor(n)->motor_free == drives[n].feedback.motor_free || tour[i] == CPIO || tour[i] == CMD);
    }
    close_drives();
}
END_TEST

static int unknown_cycles;
static void read_inputs(void)
{
    for (int n = 0; n < DRIVES; n++) {
        cm1e_drive_want_inputs(&drives[n]);
        unknown_cycles += !drives[n].feedback.digital_known;
    }
}

START_TEST(test_inputs_of_four_stay_known_and_outputs_are_confirmed)
{
    open_drives();
    for (int n = 0; n < DRIVES; n++)
        enable_drive(n);
    each_cycle = read_inputs;
    cycles(50);
    unknown_cycles = 0;
    for (unsigned round = 0; round < 20; round++) {
        for (int n = 0; n < DRIVES; n++)
            drives[n].command.digital_outputs = round % 2 ? 0x0F : 0;
        cycles(60);
        for (int n = 0; n < DRIVES; n++) {
            ck_assert_int_eq(cm1e_drive_outputs(&drives[n]), CM1E_DRIVE_OUTPUTS_SET);
            ck_assert_uint_eq(motor(n)->outputs, round % 2 ? cm1e_drive_output_mask(&drives[n]) : 0);
        }
    }
    ck_assert_int_eq(unknown_cycles, 0);
    close_drives();
}
END_TEST

/* ID1 homes by CMD, ID2 is in CPIO, ID3 and ID4 follow in csp, and every one does what it is told. */
START_TEST(test_every_motor_has_a_mode_of_its_own)
{
    open_drives();
    reach_mode(0, CMD);
    reach_mode(1, CPIO);
    for (int n = 1; n < DRIVES; n++)
        enable_drive(n);
    ck_assert_int_eq(cm1e_drive_cmd_start(&drives[0], CM1E_DRIVE_CMD_MOTOR_ENABLE, 0), CM1E_OK);
    cycles(30);
    ck_assert_int_eq(cm1e_drive_cmd_state(&drives[0]), CM1E_DRIVE_CMD_DONE);
    ck_assert_int_eq(cm1e_drive_cmd_start(&drives[0], CM1E_DRIVE_CMD_ORIGIN_SEARCH, 0), CM1E_OK);
    for (int i = 0; i < 1000; i++) {
        for (int n = 1; n < DRIVES; n++) {
            drives[n].command.target_position += n;
            drives[n].command.digital_outputs = (uint16_t)(i / 100 % 2 * 2);
        }
        cycles(1);
        ck_assert(cm1e_drive_cmd_busy(cm1e_drive_cmd_state(&drives[0])));
    }
    cycles(100);
    for (int n = 1; n < DRIVES; n++) {
        ck_assert(drives[n].feedback.enabled);
        ck_assert_int_le(abs(drives[n].feedback.position - 1000 * n), 2);
        ck_assert_uint_eq(motor(n)->outputs, 2);
    }
    ck_assert_int_ne(drives[0].feedback.position, 0);
    while (!cm1e_drive_cmd_release(&drives[0]))
        cycles(1);
    ck_assert(motor(0)->motor_free && !motor(1)->motor_free);
    close_drives();
}
END_TEST

START_TEST(test_the_fault_of_one_is_not_that_of_another)
{
    for (int broken = 0; broken < DRIVES; broken++) {
        open_drives();
        for (int n = 0; n < DRIVES; n++)
            enable_drive(n);
        cm1e_sim_bridge_axis_error(motor(broken), BRIDGE_STATUS_OVERLOAD);
        cycles(50);
        for (int n = 0; n < DRIVES; n++) {
            ck_assert_int_eq(drives[n].fault.error, n == broken ? CM1E_ERROR_DRIVE_FAULT : CM1E_OK);
            ck_assert(drives[n].feedback.enabled == (n != broken));
        }
        ck_assert(drives[broken].fault.motor_status_known);
        ck_assert_ptr_nonnull(strstr(drive_text(broken), "overload"));
        close_drives();
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("four drives behind one bridge");
    TCase *tests = tcase_create("together");
    tcase_add_test(tests, test_four_switch_at_once);
    tcase_add_test(tests, test_inputs_of_four_stay_known_and_outputs_are_confirmed);
    tcase_add_test(tests, test_every_motor_has_a_mode_of_its_own);
    tcase_add_test(tests, test_the_fault_of_one_is_not_that_of_another);
    suite_add_tcase(suite, tests);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
