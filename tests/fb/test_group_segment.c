/*
 * An axes group on the simulated segment, with SOEM and real frames: a CM1-E, a CM1 behind a bridge, and a virtual axis
 * in one group. What reaches the motors is compared with what was programmed, cycle by cycle.
 */
#include "axis/axis_position.h"
#include "core/bytes.h"
#include "device/bridge_facts.h"
#include "group/group_api.h"

#include "../support/axis_segment.h" /* behind the others: it makes a macro of `axis` */

enum { MOTOR = 0, BRIDGED, VIRTUAL, AXES };
static int owners[AXES];
static AXES_GROUP_REF_t reference;
static cm1e_group_t *group;

static void open_mixed(void)
{
    cm1e_diag_t said = {0};
    cm1e_bus_config_free(&config);
    cm1e_bus_config_init(&config, "sim", AXES);
    config.virtual_time = true;
    config.cycle_time_ns = CM1E_BRIDGE_CYCLE_TIME_NS;
    config.axes[MOTOR].address = 1;
    config.axes[BRIDGED].address = 2;
    config.axes[BRIDGED].channel = 1;
    snprintf(config.axes[BRIDGED].motor, sizeof config.axes[BRIDGED].motor, "CM1");
    config.axes[BRIDGED].k37 = 10;
    config.axes[BRIDGED].k37_stated = true;
    config.axes[VIRTUAL].type = CM1E_AXIS_VIRTUAL;
    for (int n = 0; n < AXES; n++) {
        config.axes[n].max_velocity = 20.0;
        config.axes[n].max_acceleration = config.axes[n].max_deceleration = 200.0;
        config.axes[n].max_jerk = 4000.0;
    }
    open_segment();
    for (int n = 0; n < AXES; n++)
        ck_assert_int_eq(cm1e_axis_power(axes[n], &owners[n], true, true, true), CM1E_OK);
    cycles(800);
    ck_assert_msg(cm1e_group_create(&reference, NULL, &said) == CM1E_OK, "%s", said.text);
    group = cm1e_group_from_reference(&reference);
    for (int n = 0; n < AXES; n++) {
        ck_assert_msg(info_of(n).state == CM1E_AXIS_STANDSTILL, "axis %d: %s", n, text_of(n));
        ck_assert_int_eq(cm1e_axis_set_position(axes[n], 0.0, false), CM1E_OK);
        ck_assert_int_eq(cm1e_group_add(group, cm1e_axis_reference(axes[n]), 0), CM1E_OK);
    }
    ck_assert_int_eq(cm1e_group_enable(group), CM1E_OK);
}

static void close_mixed(void)
{
    close_segment();
    ck_assert_int_eq(cm1e_group_destroy(reference), CM1E_OK);
}

static const char *group_text(void)
{
    static char words[CM1E_GROUP_ERROR_TEXT_BYTES];
    cm1e_group_error_text(reference, words, sizeof words);
    return words;
}

/* u; the target that the last frame had for a motor. */
static double target_of(int n)
{
    if (n == VIRTUAL)
        return cm1e_axis_place(axes[n], false);
    const cm1e_image_slot_t slot = cm1e_bus_find_output(bus, (uint16_t)(n + 1), OBJ_607A_TARGET_POSITION, 0);
    ck_assert_uint_eq(slot.bytes, 4);
    const int32_t target = (int32_t)cm1e_get_u32(cm1e_bus_outputs(bus) + slot.offset);
    return cm1e_axis_line(axes[n], (position_t){target, 0.0});
}

static cm1e_command_id_t start(const cm1e_group_command_t *command)
{
    cm1e_command_id_t id;
    const cm1e_error_t error = cm1e_group_start(group, command, &id);
    ck_assert_msg(error == CM1E_OK, "%s: %s", cm1e_strerror(error), group_text());
    return id;
}

static cm1e_command_state_t state_of(cm1e_command_id_t id) { return cm1e_group_command_status(group, id).state; }

/* Half a count of the coarsest motor. */
static double half_a_count(void)
{
    return 0.51 / fmin(fabs(axes[MOTOR]->position.scale), fabs(axes[BRIDGED]->position.scale));
}

START_TEST(test_targets_of_a_line_are_on_it)
{
    open_mixed();
    const cm1e_command_id_t id = start(&(cm1e_group_command_t){
        .kind = CM1E_GROUP_LINEAR_ABSOLUTE, .position = {4.0, 2.0, -1.0}, .velocity = 6.0});
    const double half = half_a_count();
    int moved = 0;
    while (state_of(id) == CM1E_COMMAND_ACTIVE) {
        cycles(1);
        const double z = target_of(VIRTUAL);
        ck_assert_double_eq_tol(target_of(MOTOR), -4.0 * z, half);
        ck_assert_double_eq_tol(target_of(BRIDGED), -2.0 * z, half);
        moved += info_of(MOTOR).actual_velocity > 1.0 && info_of(BRIDGED).actual_velocity > 0.5;
    }
    ck_assert_msg(state_of(id) == CM1E_COMMAND_DONE, "%s", group_text());
    ck_assert_int_gt(moved, 300);
    cycles(300);
    ck_assert_double_eq_tol(info_of(MOTOR).actual_position, 4.0, 0.01);
    ck_assert_double_eq_tol(info_of(BRIDGED).actual_position, 2.0, 0.02);
    close_mixed();
}
END_TEST

START_TEST(test_targets_of_a_circle_are_on_it)
{
    open_mixed();
    const cm1e_command_id_t id = start(&(cm1e_group_command_t){
        .kind = CM1E_GROUP_CIRCULAR_ABSOLUTE, .circ_mode = mcCenter, .path_choice = mcCounterClockwise,
        .auxiliary = {0.0, 1.5, 0.0}, .velocity = 5.0});
    double farthest = 0.0;
    while (state_of(id) == CM1E_COMMAND_ACTIVE) {
        cycles(1);
        const double radius = hypot(target_of(MOTOR), target_of(BRIDGED) - 1.5);
        ck_assert_double_eq_tol(radius, 1.5, 1.5 * half_a_count());
        farthest = fmax(farthest, target_of(BRIDGED));
    }
    ck_assert_msg(state_of(id) == CM1E_COMMAND_DONE, "%s", group_text());
    ck_assert_double_eq_tol(farthest, 3.0, 1e-3);
    close_mixed();
}
END_TEST

/* A fault of any of them, in any cycle: the others' targets stay on the line. */
START_TEST(test_a_fault_in_any_cycle_leaves_the_others_on_the_line)
{
    static const int moments[] = {1, 2, 3, 4, 10, 60, 150, 300, 450, 600};
    for (size_t i = 0; i < sizeof moments / sizeof *moments; i++) {
        open_mixed();
        const cm1e_command_id_t id = start(&(cm1e_group_command_t){
            .kind = CM1E_GROUP_LINEAR_ABSOLUTE, .position = {4.0, 2.0, -1.0}, .velocity = 6.0});
        cycles(moments[i]);
        if (_i == MOTOR)
            simulate("error 1 2310");
        else
            ck_assert_int_eq(cm1e_axis_power(axes[_i], &owners[_i], false, true, true), CM1E_OK);
        for (int n = 0; n < 600; n++) {
            cycles(1);
            const double a = target_of(_i == MOTOR ? BRIDGED : MOTOR) / (_i == MOTOR ? 2.0 : 4.0);
            const double b = _i == VIRTUAL ? target_of(BRIDGED) / 2.0 : -target_of(VIRTUAL);
            ck_assert_double_eq_tol(a, b, half_a_count());
        }
        cm1e_group_info_t shown;
        ck_assert_int_eq(cm1e_group_read(reference, &shown), CM1E_OK);
        ck_assert_msg(shown.state == CM1E_GROUP_ERROR_STOP, "%s", cm1e_group_state_name(shown.state));
        ck_assert_int_eq(state_of(id), CM1E_COMMAND_ERROR);
        for (int n = 0; n < AXES; n++)
            ck_assert_msg(n == _i || info_of(n).state == CM1E_AXIS_STANDSTILL, "axis %d: %s", n, text_of(n));
        close_mixed();
    }
}
END_TEST

START_TEST(test_a_bus_that_is_lost_stops_all_and_comes_back)
{
    open_mixed();
    start(&(cm1e_group_command_t){.kind = CM1E_GROUP_LINEAR_ABSOLUTE, .position = {4.0, 2.0, -1.0}, .velocity = 6.0});
    cycles(300);
    simulate("lose 10");
    cycles(1500);
    cm1e_group_info_t shown;
    cm1e_group_read(reference, &shown);
    ck_assert_int_eq(shown.state, CM1E_GROUP_ERROR_STOP);
    ck_assert_int_eq(cm1e_group_reset(group), CM1E_OK);
    for (int n = 0; n < 15000 && cm1e_group_reset_state(group, NULL) == CM1E_COMMAND_ACTIVE; n++)
        cycles(1);
    ck_assert_msg(cm1e_group_reset_state(group, NULL) == CM1E_COMMAND_DONE, "%s", group_text());
    for (int n = 0; n < AXES; n++)
        ck_assert_int_eq(cm1e_axis_power(axes[n], &owners[n], true, true, true), CM1E_OK);
    cycles(800);
    const cm1e_command_id_t id = start(&(cm1e_group_command_t){.kind = CM1E_GROUP_LINEAR_ABSOLUTE, .velocity = 6.0});
    for (int n = 0; n < 5000 && state_of(id) == CM1E_COMMAND_ACTIVE; n++)
        cycles(1);
    ck_assert_msg(state_of(id) == CM1E_COMMAND_DONE, "%s", group_text());
    close_mixed();
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("groups on the segment");
    TCase *all = tcase_create("all");
    tcase_set_timeout(all, 60);
    tcase_add_test(all, test_targets_of_a_line_are_on_it);
    tcase_add_test(all, test_targets_of_a_circle_are_on_it);
    tcase_add_loop_test(all, test_a_fault_in_any_cycle_leaves_the_others_on_the_line, 0, AXES);
    tcase_add_test(all, test_a_bus_that_is_lost_stops_all_and_comes_back);
    suite_add_tcase(suite, all);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
