/* The text of an axis is made of a copy while the axis goes on: nothing of it may come from the axis itself. Here all that
 * rooms keep of the axis is overwritten while the text is made. */
#include "axis/axis_parts.h"
#include "axis/axis_watch.h"
#include "core/cache_line.h"
#include "coupling/coupling_private.h"
#include "homing/homing_private.h"
/* Last, because it defines the macro `axis`. */
#include "axis_segment.h"

#undef axis /* the name of a member too */

enum { MASTER = 0, SLAVE = 1 };
static int owners[2];

static void start(void)
{
    describe("1.3.5", CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_7_2, 1000000);
    describe_up_to(2);
    open_segment();
    for (int i = 0; i < 2; i++)
        ck_assert_int_eq(cm1e_axis_power(axes[i], &owners[i], true, true, true), CM1E_OK);
    cycles(200);
}

static cm1e_error_t order(cm1e_command_kind_t kind, cm1e_axis_command_t command, cm1e_axis_coupling_t coupling)
{
    cm1e_command_id_t id;
    coupling.master[0].axis = cm1e_axis_reference(axes[MASTER]);
    command.kind = kind;
    command.coupling = &coupling;
    return cm1e_axis_start(axes[SLAVE], &command, &id);
}

/** The text of a copy while the coupling, the cams and the homing of the axis are rubbish. */
static void check(const char *words)
{
    static char text[CM1E_AXIS_ERROR_TEXT_BYTES], from_copy[CM1E_AXIS_ERROR_TEXT_BYTES];
    static unsigned char coupling[sizeof(coupling_t)], followed[sizeof(followed_t)], cams[sizeof(cams_t)],
        homing[sizeof(homing_t)];
    cm1e_axis_t *const slave = axes[SLAVE];
    cams_t *const its_cams = slave->coupling->cams;
    void *copy = cm1e_cache_lines(cm1e_axis_copy_bytes(slave));
    cm1e_axis_text(slave, text, sizeof text);
    ck_assert_msg(strstr(text, words), "\"%s\" lacks \"%s\"", text, words);
    cm1e_axis_copy(slave, copy);
    memcpy(coupling, slave->coupling, sizeof coupling);
    memcpy(followed, slave->followed, sizeof followed);
    memcpy(cams, its_cams, sizeof cams);
    memcpy(homing, slave->homing, sizeof homing);
    memset(slave->coupling, 0x5A, sizeof coupling);
    memset(slave->followed, 0x5A, sizeof followed);
    memset(its_cams, 0x5A, sizeof cams);
    memset(slave->homing, 0x5A, sizeof homing);
    cm1e_axis_text(copy, from_copy, sizeof from_copy);
    memcpy(slave->coupling, coupling, sizeof coupling);
    memcpy(slave->followed, followed, sizeof followed);
    memcpy(its_cams, cams, sizeof cams);
    memcpy(slave->homing, homing, sizeof homing);
    free(copy);
    ck_assert_str_eq(from_copy, text);
}

START_TEST(test_text_of_a_copy_needs_nothing_of_the_axis)
{
    start();
    ck_assert_int_eq(order(CM1E_COMMAND_GEAR_IN, (cm1e_axis_command_t){0},
                           (cm1e_axis_coupling_t){.master[0] = {.numerator = 0, .denominator = 7}}),
                     CM1E_ERROR_AXIS_RATIO);
    check("the ratio 0 / 7 was commanded");
    ck_assert_int_eq(order(CM1E_COMMAND_CAM_IN, (cm1e_axis_command_t){0}, (cm1e_axis_coupling_t){.cam = 77}),
                     CM1E_ERROR_AXIS_CAM_ID);
    check("now: none");
    ck_assert_int_eq(order(CM1E_COMMAND_GEAR_IN, (cm1e_axis_command_t){0},
                           (cm1e_axis_coupling_t){.master[0] = {.numerator = 1, .denominator = 1}}), CM1E_OK);
    cycles(100);
    ck_assert_int_eq(order(CM1E_COMMAND_PHASING_ABSOLUTE, (cm1e_axis_command_t){.position = 1, .velocity = 1e9},
                           (cm1e_axis_coupling_t){0}), CM1E_ERROR_AXIS_VELOCITY_RANGE);
    check("a phase shift of 1 with velocity 1e+09");
    close_segment();
}
END_TEST

START_TEST(test_text_of_a_copy_of_a_cam_and_of_a_homing)
{
    static const MC_CAM_POINT points[] = {{0, 0, 0, 0}, {1.5, 0.4, 0, 0}, {3, 0, 0, 0}};
    const MC_CAM_REF table = {.Points = points, .NumberOfPoints = 3};
    MC_CAM_ID cam = 0;
    cm1e_command_id_t id;
    start();
    const cm1e_homing_config_t wrong = {.method = -3, .velocity = 1e6};
    ck_assert_int_eq(cm1e_axis_start(axes[SLAVE], &(cm1e_axis_command_t){.kind = CM1E_COMMAND_HOME, .homing = &wrong},
                                     &id), CM1E_ERROR_AXIS_HOMING_PARAMETER);
    check("velocity is 1e+06");
    ck_assert_int_eq(cm1e_axis_cam_select(axes[SLAVE], &table, true, false, false, &cam), CM1E_OK);
    ck_assert_int_eq(order(CM1E_COMMAND_CAM_IN, (cm1e_axis_command_t){0},
                           (cm1e_axis_coupling_t){.cam = cam, .start_mode = mcRampIn}), CM1E_OK);
    cycles(300);
    ck_assert_int_eq(order(CM1E_COMMAND_PHASING_ABSOLUTE, (cm1e_axis_command_t){.position = 1, .velocity = 1e9},
                           (cm1e_axis_coupling_t){0}), CM1E_ERROR_AXIS_VELOCITY_RANGE);
    check("a phase shift of 1 with velocity 1e+09");
    close_segment();
}
END_TEST

/* Its error names the master, whose name is in the coupling. */
START_TEST(test_text_of_a_copy_of_a_slave_that_lost_its_master)
{
    start();
    ck_assert_int_eq(order(CM1E_COMMAND_GEAR_IN, (cm1e_axis_command_t){0},
                           (cm1e_axis_coupling_t){.master[0] = {.numerator = 1, .denominator = 1}}), CM1E_OK);
    cycles(100);
    simulate("error 1 2310");
    cycles(300);
    ck_assert_int_eq(info_of(SLAVE).state, CM1E_AXIS_ERROR_STOP);
    check("its master \"axis1\"");
    close_segment();
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("copy of an axis");
    TCase *cases = tcase_create("copy");
    tcase_add_test(cases, test_text_of_a_copy_needs_nothing_of_the_axis);
    tcase_add_test(cases, test_text_of_a_copy_of_a_cam_and_of_a_homing);
    tcase_add_test(cases, test_text_of_a_copy_of_a_slave_that_lost_its_master);
    suite_add_tcase(suite, cases);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
