/* Several axes on one bus: what happens to one concerns the others only where it has to. */
#include "axis_segment.h"

enum { AXES = 3 };
static int owners[AXES];

static void start(void)
{
    describe("1.3.5", CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, 1000000);
    describe_up_to(AXES);
    for (int i = 0; i < AXES; i++)
        config.axes[i].mapping = (cm1e_mapping_t)(i % 2);
    open_segment();
}

static void enable_all(void)
{
    for (int i = 0; i < AXES; i++)
        ck_assert_int_eq(cm1e_axis_power(axes[i], &owners[i], true, true, true), CM1E_OK);
    cycles(200);
    for (int i = 0; i < AXES; i++)
        ck_assert_msg(info_of(i).state == CM1E_AXIS_STANDSTILL, "%s", text_of(i));
}

static void reset_all(void)
{
    for (int i = 0; i < AXES; i++)
        cm1e_axis_reset(axes[i]);
    for (int n = 0; n < 15000; n++) {
        bool ready = true;
        for (int i = 0; i < AXES; i++)
            ready = ready && info_of(i).state == CM1E_AXIS_STANDSTILL;
        if (ready)
            return;
        cycles(1);
    }
    ck_abort_msg("%s | %s | %s", text_of(0), text_of(1), text_of(2));
}

static cm1e_command_id_t turn(int n, double velocity)
{
    cm1e_command_id_t id;
    const cm1e_axis_command_t c = {.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = velocity};
    ck_assert_int_eq(cm1e_axis_start(axes[n], &c, &id), CM1E_OK);
    return id;
}

START_TEST(test_fault_of_one_axis_leaves_the_others_alone)
{
    start();
    enable_all();
    cm1e_command_id_t ids[AXES];
    for (int i = 0; i < AXES; i++)
        ids[i] = turn(i, 1.0 + i);
    cycles(300);
    simulate("error 2 2310");
    cycles(300);
    ck_assert_int_eq(info_of(1).state, CM1E_AXIS_ERROR_STOP);
    ck_assert_msg(strstr(text_of(1), config.axes[1].name[0] ? config.axes[1].name : "axis2"), "%s", text_of(1));
    for (int i = 0; i < AXES; i += 2) {
        ck_assert_int_eq(info_of(i).state, CM1E_AXIS_CONTINUOUS_MOTION);
        ck_assert(cm1e_axis_command_status(axes[i], ids[i]).reached);
        ck_assert_double_eq_tol(probe_of(i).velocity_counts_per_s, (1.0 + i) * 50000.0, 2500.0);
    }
    cm1e_axis_reset(axes[1]);
    cycles(200);
    ck_assert_msg(info_of(1).state == CM1E_AXIS_STANDSTILL, "%s", text_of(1));
    ck_assert_int_eq(info_of(2).state, CM1E_AXIS_CONTINUOUS_MOTION);
    close_segment();
}
END_TEST

/* The working counter of the one frame tells that somebody is missing: all stop, and each says what it knows. */
START_TEST(test_slave_without_power_stops_all_and_all_come_back)
{
    start();
    enable_all();
    double at[AXES];
    for (int i = 0; i < AXES; i++)
        turn(i, 3.0);
    cycles(300);
    simulate("power-cycle 2 2000");
    for (int i = 0; i < AXES; i++)
        at[i] = probe_of(i).position_counts;
    cycles(1000);
    for (int i = 0; i < AXES; i++) {
        ck_assert_int_eq(info_of(i).state, CM1E_AXIS_ERROR_STOP);
        ck_assert(!probe_of(i).torque_on);
        ck_assert_msg(strlen(text_of(i)) > 40, "%s", text_of(i));
        /* 150,000 counts/s at 5,000,000 counts/s2: 2,250 counts, the cycles until it is seen, or coasting */
        ck_assert_msg(fabs(probe_of(i).position_counts - at[i]) < (i == 1 ? 20000.0 : 4000.0), "axis %d: %.0f", i,
                      probe_of(i).position_counts - at[i]);
    }
    ck_assert_msg(strstr(text_of(1), "does not answer"), "%s", text_of(1));
    ck_assert(!info_of(1).homed);
    cycles(2000);
    for (int i = 0; i < AXES; i++)
        at[i] = probe_of(i).position_counts;
    reset_all();
    for (int i = 0; i < AXES; i++)
        ck_assert_double_eq_tol(probe_of(i).position_counts, at[i], 40.0);
    close_segment();
}
END_TEST

START_TEST(test_axes_home_at_the_same_time_over_one_mailbox_queue)
{
    start();
    enable_all();
    cm1e_command_id_t ids[AXES];
    static const int8_t methods[AXES] = {-1, -3, -6};
    for (int i = 0; i < AXES; i++) {
        const cm1e_homing_config_t homing = {.method = methods[i], .velocity = 3.0, .acceleration = 60.0};
        const cm1e_axis_command_t c = {.kind = CM1E_COMMAND_HOME, .position = i, .homing = &homing};
        ck_assert_int_eq(cm1e_axis_start(axes[i], &c, &ids[i]), CM1E_OK);
    }
    cycles(8000);
    for (int i = 0; i < AXES; i++) {
        ck_assert_msg(cm1e_axis_command_status(axes[i], ids[i]).state == CM1E_COMMAND_DONE, "%d: %s", i, text_of(i));
        ck_assert_double_eq_tol(info_of(i).actual_position, i, 0.01);
        ck_assert(info_of(i).homed);
    }
    close_segment();
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("several axes");
    TCase *cases = tcase_create("axes");
    tcase_set_timeout(cases, 120);
    tcase_add_test(cases, test_fault_of_one_axis_leaves_the_others_alone);
    tcase_add_test(cases, test_slave_without_power_stops_all_and_all_come_back);
    tcase_add_test(cases, test_axes_home_at_the_same_time_over_one_mailbox_queue);
    suite_add_tcase(suite, cases);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
