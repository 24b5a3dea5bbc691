/*
 * Done that waits for the motor, on the simulated segment: the blocks against stops, loads and friction, with every
 * mapping and firmware, by set-points of the host and by profiles of the drive, and behind a bridge.
 */
#include "axis_segment.h"
#include "device/unit.h"

static const char *const firmwares[] = {"1.2.0", "1.3.0", "1.3.3", "1.3.5"};
enum { FIRMWARES = 4, MAPPINGS = 4, VARIANTS = FIRMWARES * MAPPINGS };

static AXIS_REF_t reference;
static MC_MoveAbsolute_t absolute;
static MC_MoveRelative_t relative;
static MC_MoveAdditive_t additive;
static MC_Home_t home;

static void begin(void)
{
    config.axes[0].in_position_done_waits = true;
    open_segment();
    reference = cm1e_axis_reference(axis);
    absolute = (MC_MoveAbsolute_t){.Axis = &reference, .Velocity = 5.0};
    relative = (MC_MoveRelative_t){.Axis = &reference, .Velocity = 5.0};
    additive = (MC_MoveAdditive_t){.Axis = &reference, .Velocity = 5.0};
    home = (MC_Home_t){.Axis = &reference};
    enable();
}

static void scan(void)
{
    inputs();
    MC_MoveAbsolute(&absolute);
    MC_MoveRelative(&relative);
    MC_MoveAdditive(&additive);
    MC_Home(&home);
    outputs();
}

/* u; how far a motor that is in position may be from its set-point, by docs/BUS-FILE.md. */
static double window(void)
{
    const bool coarse = config.axes[0].mapping == CM1E_MAPPING_CSV && strcmp(config.axes[0].firmware, "1.3.3") < 0;
    return coarse ? 30.0 / 50000.0 : 10.0 / 50000.0;
}

/* Until the block is Done, with the motor where it was to go. */
#define MOVE(BLOCK, VARIABLE, BY, TARGET)                                                                            \
    do {                                                                                                             \
        (BLOCK).VARIABLE = (BY);                                                                                     \
        (BLOCK).Execute = TRUE;                                                                                      \
        for (int n_ = 0; n_ < 60000 && !(BLOCK).Done && !(BLOCK).Error; n_++) {                                      \
            scan();                                                                                                  \
            ck_assert((BLOCK).Done || (BLOCK).Error || ((BLOCK).Busy && (BLOCK).Active));                            \
        }                                                                                                            \
        ck_assert_msg((BLOCK).Done, "%s", text());                                                                   \
        ck_assert_msg(fabs(info().actual_position - (TARGET)) <= window(), "at %.6f instead of %.6f, %s",            \
                      info().actual_position, (TARGET), firmwares[_i % FIRMWARES]);                                  \
        ck_assert(info().in_position);                                                                               \
        ck_assert_int_eq(info().state, CM1E_AXIS_STANDSTILL);                                                        \
        (BLOCK).Execute = FALSE;                                                                                     \
        scan();                                                                                                      \
    } while (0)

static void describe_variant(int variant)
{
    describe(firmwares[variant % FIRMWARES], (cm1e_mapping_t)(variant / FIRMWARES), CM1E_PDO_ORDER_UG_4_4, 1000000);
    config.axes[0].homing = (cm1e_homing_config_t){.method = -3, .velocity = 2.0, .acceleration = 40.0};
}

START_TEST(done_means_the_motor_is_there)
{
    describe_variant(_i);
    begin();
    MOVE(absolute, Position, 1.0, 1.0);
    MOVE(relative, Distance, 0.001, 1.001);
    MOVE(additive, Distance, -2.5, -1.499);
    MOVE(relative, Distance, 0.0, -1.499);
    home.Position = 7.0;
    home.Execute = TRUE;
    for (int n = 0; n < 30000 && !home.Done && !home.Error; n++)
        scan();
    ck_assert_msg(home.Done, "%s", text());
    ck_assert(info().in_position && info().homed);
    ck_assert_double_le(fabs(info().position_lag), window());
    ck_assert_double_eq_tol(info().actual_position, 7.0, 0.005);
    MOVE(absolute, Position, 6.5, 6.5);
    close_segment();
}
END_TEST

START_TEST(load_and_friction_only_take_longer)
{
    describe_variant(_i);
    config.axes[0].sim.load_inertia = 2e-5;
    config.axes[0].sim.friction = 0.02;
    begin();
    simulate("load 1 0.05");
    MOVE(absolute, Position, 2.0, 2.0);
    simulate("load 1 -0.05");
    MOVE(relative, Distance, -0.01, 1.99);
    close_segment();
}
END_TEST

/* The hard stop of the simulated mechanics is 5 revolutions away; limits.position_lag is half a revolution. */
START_TEST(a_stop_before_the_target_is_an_error_in_words)
{
    describe_variant(_i % VARIANTS);
    config.axes[0].in_position_timeout_s = _i / VARIANTS ? 0.4 : 0;
    begin();
    absolute.Position = 5.4;
    absolute.Execute = TRUE;
    for (int n = 0; n < 10000 && !absolute.Error; n++) {
        ck_assert(!absolute.Done);
        scan();
    }
    ck_assert(absolute.Error && !absolute.Busy);
    ck_assert_int_eq(info().state, CM1E_AXIS_ERROR_STOP);
    /* At peak torque the drive says so first, by its own overload: then its text says where the motor was, too. */
    ck_assert_int_eq(info().error, _i / VARIANTS ? CM1E_ERROR_AXIS_NOT_IN_POSITION : CM1E_ERROR_DRIVE_FAULT);
    ck_assert_int_eq(absolute.ErrorID, cm1e_error_id(_i / VARIANTS ? CM1E_ERROR_AXIS_NOT_IN_POSITION
                                                                   : CM1E_ERROR_AXIS_ERROR_STOP));
    const char *const words[] = {_i / VARIANTS ? "in time, which is 0.4 s" : "torque overload", "stood at 5.4 u",
                                 "below it, with", "The motor pushes", "mechanical stop", "MC_Reset"};
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++)
        ck_assert_msg(strstr(text(), words[i]), "%s: %s", words[i], text());
    ck_assert_double_eq_tol(info().actual_position, 5.0, 0.01);
    for (int n = 0; n < 100; n++)
        scan();
    ck_assert(!probe().torque_on);
    close_segment();
}
END_TEST

/* Once the load is too heavy for the motor, with the set-point at rest already. */
START_TEST(a_load_that_comes_meanwhile_is_an_error_too)
{
    describe("1.3.5", CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, 1000000);
    config.axes[0].max_position_lag = 1000.0;
    begin();
    relative.Distance = 1.0;
    relative.Execute = TRUE;
    while (info().set_position < 1.0)
        scan();
    simulate("load 1 -5");
    int n = 0;
    for (; n < 5000 && !relative.Error; n++)
        scan();
    ck_assert(relative.Error && !relative.Done);
    ck_assert(info().error == CM1E_ERROR_AXIS_NOT_IN_POSITION || info().error == CM1E_ERROR_DRIVE_FAULT);
    close_segment();
}
END_TEST

/* Profiles of the drive end with its "target reached", then the axis looks itself. */
START_TEST(so_it_is_with_profiles_of_the_drive)
{
    describe(_i ? "1.3.5" : "1.2.0", CM1E_MAPPING_PROFILE, CM1E_PDO_ORDER_UG_7_2, 1000000);
    config.axes[0].motion = CM1E_MOTION_DRIVE;
    begin();
    MOVE(absolute, Position, 1.0, 1.0);
    MOVE(relative, Distance, 0.001, 1.001);
    MOVE(additive, Distance, -2.5, -1.499);
    close_segment();
}
END_TEST

/* There the drive is the first to see it, in its own motion; its text had a lag below "its limit". */
START_TEST(a_stop_before_the_target_of_the_drive_is_told_by_the_drive)
{
    describe(_i ? "1.3.5" : "1.2.0", CM1E_MAPPING_PROFILE, CM1E_PDO_ORDER_UG_7_2, 1000000);
    config.axes[0].motion = CM1E_MOTION_DRIVE;
    begin();
    absolute.Position = 5.4;
    absolute.Execute = TRUE;
    for (int n = 0; n < 20000 && !absolute.Error; n++) {
        ck_assert(!absolute.Done);
        scan();
    }
    ck_assert(absolute.Error);
    ck_assert_int_eq(info().error, CM1E_ERROR_AXIS_LAG);
    ck_assert_msg(strstr(text(), "the drive reports a following error") && strstr(text(), "mechanical stop") &&
                  strstr(text(), "0.4 u away") && !strstr(text(), "allowed"), "%s", text());
    close_segment();
}
END_TEST

START_TEST(behind_a_bridge_too)
{
    static const char *const motors[] = {"CM1", "CM2"};
    static const uint8_t k37s[] = {10, 3, 0};
    describe("", CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, 1000000);
    config.axes[0].channel = 1;
    config.axes[0].k37 = k37s[_i / 2];
    config.axes[0].k37_stated = true;
    snprintf(config.axes[0].motor, sizeof config.axes[0].motor, "%s", motors[_i % 2]);
    begin();
    relative.Distance = 1.5;
    relative.Execute = TRUE;
    for (int n = 0; n < 10000 && !relative.Done && !relative.Error; n++)
        scan();
    ck_assert_msg(relative.Done, "%s", text());
    const double most = fmax(10.0 / 50000.0, 2.0 / cm1e_unit_scale(&config.axes[0]));
    ck_assert_double_eq_tol(info().actual_position, 1.5, most * 1.000001);
    close_segment();
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("in position");
    TCase *cases = tcase_create("in position");
    tcase_set_timeout(cases, 120);
    tcase_add_loop_test(cases, done_means_the_motor_is_there, 0, VARIANTS);
    tcase_add_loop_test(cases, load_and_friction_only_take_longer, 0, VARIANTS);
    tcase_add_loop_test(cases, a_stop_before_the_target_is_an_error_in_words, 0, 2 * VARIANTS);
    tcase_add_test(cases, a_load_that_comes_meanwhile_is_an_error_too);
    tcase_add_loop_test(cases, so_it_is_with_profiles_of_the_drive, 0, 2);
    tcase_add_loop_test(cases, a_stop_before_the_target_of_the_drive_is_told_by_the_drive, 0, 2);
    tcase_add_loop_test(cases, behind_a_bridge_too, 0, 6);
    suite_add_tcase(suite, cases);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
