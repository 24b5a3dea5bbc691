/* Somebody beside the program acts on an axis: the program has precedence, whatever a guest has begun. */
#include "axis/axis_guest.h"
#include "axis_segment.h"
#include "cm1e/plcopen.h"

static MC_Power_t block;
static AXIS_REF_t reference;

static void start(uint32_t count)
{
    describe("1.3.5", CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_7_2, 1000000);
    describe_up_to(count);
    open_segment();
    reference = cm1e_axis_reference(axis);
    block = (MC_Power_t){.Axis = &reference, .EnablePositive = TRUE, .EnableNegative = TRUE};
}

static void enable_by_guest(int n)
{
    ck_assert_int_eq(cm1e_axis_guest_power(axes[n], true), CM1E_GUEST_MAY);
    cycles(200);
    ck_assert_int_eq(info_of(n).state, CM1E_AXIS_STANDSTILL);
    ck_assert(cm1e_axis_guest_powers(axes[n]));
}

static cm1e_command_id_t jog(int n, double velocity)
{
    cm1e_command_id_t id;
    ck_assert_int_eq(cm1e_axis_guest_jog(axes[n], velocity, 0.0, &id), CM1E_OK);
    cycles(300);
    ck_assert(cm1e_axis_guest_runs(axes[n], id));
    return id;
}

START_TEST(test_command_of_the_program_takes_the_axis_from_a_guest)
{
    start(1);
    enable_by_guest(0);
    cm1e_command_id_t guests = jog(0, 1.0), id;
    const cm1e_axis_command_t move = {.kind = CM1E_COMMAND_MOVE_RELATIVE, .position = -1.0, .velocity = 2.0};
    ck_assert_int_eq(cm1e_axis_start(axis, &move, &id), CM1E_OK);
    ck_assert(!cm1e_axis_guest_runs(axis, guests));
    ck_assert_int_eq(cm1e_axis_guest_may(axis, guests), CM1E_GUEST_COMMANDED);
    cm1e_axis_guest_end(axis, 0.0, &guests); /* too late: the program's command goes on */
    ck_assert_uint_eq(guests, 0);
    cycles(2000);
    ck_assert_int_eq(cm1e_axis_command_status(axis, id).state, CM1E_COMMAND_DONE);
    close_segment();
}
END_TEST

START_TEST(test_power_block_takes_the_axis_from_a_guest)
{
    start(1);
    enable_by_guest(0);
    block.Enable = TRUE;
    for (int i = 0; i < 10; i++) {
        MC_Power(&block);
        cycles(1);
        ck_assert(block.Status && !block.Error);
    }
    ck_assert(!cm1e_axis_guest_powers(axis));
    ck_assert_int_eq(cm1e_axis_guest_power(axis, false), CM1E_GUEST_POWER); /* it is not theirs any more */
    cycles(200);
    ck_assert_int_eq(info_of(0).state, CM1E_AXIS_STANDSTILL);
    block.Enable = FALSE;
    MC_Power(&block);
    cycles(200);
    ck_assert_int_eq(info_of(0).state, CM1E_AXIS_DISABLED);
    ck_assert_int_eq(cm1e_axis_guest_power(axis, true), CM1E_GUEST_POWER);
    close_segment();
}
END_TEST

/* Enable FALSE is a command too: an emergency stop may stand behind it. */
START_TEST(test_power_block_that_does_not_enable_takes_the_power_from_a_guest)
{
    start(1);
    enable_by_guest(0);
    jog(0, 1.0);
    MC_Power(&block);
    cycles(500);
    ck_assert_int_eq(info_of(0).state, CM1E_AXIS_DISABLED);
    ck_assert(!info_of(0).powered);
    ck_assert_int_eq(cm1e_axis_guest_power(axis, true), CM1E_GUEST_POWER);
    close_segment();
}
END_TEST

START_TEST(test_guest_ends_what_it_began_whatever_the_deceleration)
{
    static const double decelerations[] = {0.0, 5.0, -1.0, 1e30, NAN};
    start(1);
    enable_by_guest(0);
    for (size_t i = 0; i < sizeof decelerations / sizeof decelerations[0]; i++) {
        cm1e_command_id_t id = jog(0, i % 2 ? -1.0 : 1.0);
        cm1e_axis_guest_end(axis, decelerations[i], &id);
        ck_assert_uint_ne(id, 0);
        cycles(1000);
        ck_assert_msg(info_of(0).state == CM1E_AXIS_STANDSTILL, "%g: %s", decelerations[i], text_of(0));
    }
    close_segment();
}
END_TEST

/* While it stops, MC_Halt is refused, and the stop that nobody holds goes on all the same. */
START_TEST(test_guest_ends_a_stop_that_is_under_way)
{
    start(1);
    enable_by_guest(0);
    cm1e_command_id_t id = jog(0, 1.0);
    const cm1e_axis_command_t stop = {.kind = CM1E_COMMAND_STOP, .deceleration = 5.0};
    ck_assert_int_eq(cm1e_axis_start(axis, &stop, &id), CM1E_OK);
    cm1e_axis_hold_stop(axis, id, false);
    cycles(50);
    ck_assert_int_eq(info_of(0).state, CM1E_AXIS_STOPPING);
    cm1e_axis_guest_end(axis, 5.0, &id);
    ck_assert(cm1e_axis_guest_runs(axis, id));
    cycles(1000);
    ck_assert_msg(info_of(0).state == CM1E_AXIS_STANDSTILL, "%s", text_of(0));
    close_segment();
}
END_TEST

START_TEST(test_master_of_another_axis_is_not_a_guests)
{
    start(2);
    enable_by_guest(0);
    enable_by_guest(1);
    cm1e_command_id_t id;
    const cm1e_axis_coupling_t gear = {.master[0] = {reference, mcSetValue, 1, 1}};
    const cm1e_axis_command_t in = {.kind = CM1E_COMMAND_GEAR_IN, .coupling = &gear};
    ck_assert_int_eq(cm1e_axis_start(axes[1], &in, &id), CM1E_OK);
    cycles(100);
    ck_assert_int_eq(cm1e_axis_guest_may(axes[0], 0), CM1E_GUEST_FOLLOWED);
    ck_assert_int_eq(cm1e_axis_guest_may(axes[1], 0), CM1E_GUEST_COMMANDED);
    ck_assert_int_eq(cm1e_axis_start(axes[1], &(cm1e_axis_command_t){.kind = CM1E_COMMAND_HALT}, &id), CM1E_OK);
    cycles(500);
    ck_assert_int_eq(cm1e_axis_guest_may(axes[0], 0), CM1E_GUEST_MAY);
    ck_assert_int_eq(cm1e_axis_guest_may(axes[1], 0), CM1E_GUEST_MAY);
    close_segment();
}
END_TEST

START_TEST(test_axis_of_a_group_is_not_a_guests)
{
    static int group;
    start(1);
    ck_assert(cm1e_axis_join(axis, &group));
    ck_assert_int_eq(cm1e_axis_guest_may(axis, 0), CM1E_GUEST_GROUPED);
    cm1e_axis_leave(axis, &group);
    ck_assert_int_eq(cm1e_axis_guest_may(axis, 0), CM1E_GUEST_MAY);
    close_segment();
}
END_TEST

START_TEST(test_reset_does_not_bring_back_the_power_of_a_guest_that_let_go)
{
    start(1);
    enable_by_guest(0);
    jog(0, 1.0);
    simulate("error 1 2310");
    cycles(300);
    ck_assert_int_eq(info_of(0).state, CM1E_AXIS_ERROR_STOP);
    ck_assert_int_eq(cm1e_axis_guest_may(axis, 0), CM1E_GUEST_MAY);
    cm1e_axis_guest_power(axis, false);
    cm1e_axis_guest_reset(axis);
    cycles(12000);
    ck_assert_msg(info_of(0).state == CM1E_AXIS_DISABLED, "%s", text_of(0));
    ck_assert(!info_of(0).powered);
    close_segment();
}
END_TEST

int main(void)
{
    TCase *tests = tcase_create("guest");
    tcase_add_test(tests, test_command_of_the_program_takes_the_axis_from_a_guest);
    tcase_add_test(tests, test_power_block_takes_the_axis_from_a_guest);
    tcase_add_test(tests, test_power_block_that_does_not_enable_takes_the_power_from_a_guest);
    tcase_add_test(tests, test_guest_ends_what_it_began_whatever_the_deceleration);
    tcase_add_test(tests, test_guest_ends_a_stop_that_is_under_way);
    tcase_add_test(tests, test_master_of_another_axis_is_not_a_guests);
    tcase_add_test(tests, test_axis_of_a_group_is_not_a_guests);
    tcase_add_test(tests, test_reset_does_not_bring_back_the_power_of_a_guest_that_let_go);
    Suite *suite = suite_create("axis_guest");
    suite_add_tcase(suite, tests);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_NORMAL);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed == 0 ? 0 : 1;
}
