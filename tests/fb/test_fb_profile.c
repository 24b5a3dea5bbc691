/**
 * MC_PositionProfile, MC_VelocityProfile, MC_AccelerationProfile on the simulated motor: what the blocks show, and that
 * the motor follows.
 */
#include "axis_segment.h"
#include "cm1e/plcopen.h"

static const struct {
    const char *firmware;
    cm1e_mapping_t mapping;
    cm1e_pdo_order_t order;
} devices[] = {
    {"1.3.5", CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4},
    {"1.2.0", CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_7_2},
    {"1.3.5", CM1E_MAPPING_CSV, CM1E_PDO_ORDER_UG_7_2},
};
enum { DEVICES = sizeof devices / sizeof devices[0] };

static AXIS_REF_t reference;
static double worst_lag;

static void begin(int device)
{
    describe(devices[device].firmware, devices[device].mapping, devices[device].order, 1000000);
    config.axes[0].sim.no_stops = true;
    config.axes[0].table_profiles = true;
    open_segment();
    reference = cm1e_axis_reference(axis);
    enable();
    worst_lag = 0.0;
}

#define SCAN(TYPE, fb)                                                                                               \
    do {                                                                                                             \
        inputs();                                                                                                    \
        TYPE(fb);                                                                                                    \
        outputs();                                                                                                   \
        worst_lag = fmax(worst_lag, fabs(info().position_lag));                                                      \
    } while (0)

static const TIME half_second = 500000000;

static MC_TP_REF lift(void)
{
    return (MC_TP_REF){.NumberOfPairs = 3, .MC_TP_Array = {{half_second, 0.5}, {half_second, 1.5}, {half_second, 2.0}}};
}

START_TEST(test_position_profile_is_done_where_the_table_ends)
{
    begin(_i);
    const MC_TP_REF table = lift();
    MC_PositionProfile_t fb = {.Axis = &reference, .TimePosition = &table, .Execute = TRUE, .Offset = 0.25,
                               .PositionScale = -1.0, .TimeScale = 0.5};
    for (int n = 0; n < 749; n++) {
        SCAN(MC_PositionProfile, &fb);
        ck_assert_msg(fb.Busy && fb.Active && !fb.Done && !fb.Error, "%d: %x %s", n, fb.ErrorID, text());
        ck_assert_int_eq(info().state, CM1E_AXIS_DISCRETE_MOTION);
        if (n == 498)
            ck_assert_msg(fabs(info().set_position + 1.25) < 0.01, "%f", info().set_position);
    }
    SCAN(MC_PositionProfile, &fb);
    SCAN(MC_PositionProfile, &fb);
    ck_assert(fb.Done && !fb.Busy && !fb.Active);
    ck_assert_int_eq(info().state, CM1E_AXIS_STANDSTILL);
    ck_assert_msg(fabs(info().set_position + 1.75) < 1e-9, "%.12f", info().set_position);
    cycles(100);
    /* In CSV the position loop is ours, and no integral of it holds against friction. */
    const double exact = devices[_i].mapping == CM1E_MAPPING_CSV ? 60.0 : 3.0;
    ck_assert_msg(fabs(probe().position_counts + 1.75 * 50000.0) < exact, "%f", probe().position_counts);
    ck_assert_msg(worst_lag < 0.1, "the motor was %f u behind", worst_lag);
    fb.Execute = FALSE;
    SCAN(MC_PositionProfile, &fb);
    ck_assert(!fb.Done);
    close_segment();
}
END_TEST

START_TEST(test_velocity_profile_stays_busy_with_its_last_velocity)
{
    begin(_i);
    const MC_TV_REF table = {.NumberOfPairs = 2, .MC_TV_Array = {{half_second, 3.0}, {half_second, 2.0}}};
    MC_VelocityProfile_t fb = {.Axis = &reference, .TimeVelocity = &table, .Execute = TRUE};
    for (int n = 0; n < 2000; n++) {
        SCAN(MC_VelocityProfile, &fb);
        ck_assert_msg(fb.Busy && fb.Active && !fb.Error, "%d: %x %s", n, fb.ErrorID, text());
        ck_assert_msg(fb.ProfileCompleted == (n >= 1000), "cycle %d", n);
        ck_assert_int_eq(info().state, CM1E_AXIS_CONTINUOUS_MOTION);
    }
    ck_assert_msg(fabs(info().set_velocity - 2.0) < 1e-9, "%f", info().set_velocity);
    ck_assert_msg(fabs(probe().velocity_counts_per_s - 100000.0) < 1000.0, "%f", probe().velocity_counts_per_s);
    MC_Halt_t halt = {.Axis = &reference, .Execute = TRUE};
    for (int n = 0; n < 300; n++) {
        SCAN(MC_Halt, &halt);
        MC_VelocityProfile(&fb);
    }
    ck_assert(fb.CommandAborted && !fb.Busy && !fb.ProfileCompleted && halt.Done);
    close_segment();
}
END_TEST

START_TEST(test_acceleration_profile)
{
    begin(_i);
    const MC_TA_REF table = {.NumberOfPairs = 3, .MC_TA_Array = {{half_second, 4.0}, {half_second, 4.0},
                                                                {half_second, 0.0}}};
    MC_AccelerationProfile_t fb = {.Axis = &reference, .TimeAcceleration = &table, .Execute = TRUE,
                                   .AccelerationScale = 0.5};
    for (int n = 0; n < 1600; n++)
        SCAN(MC_AccelerationProfile, &fb);
    ck_assert_msg(fb.ProfileCompleted && fb.Active, "%x %s", fb.ErrorID, text());
    ck_assert_msg(fabs(info().set_velocity - 2.0) < 1e-9, "%f", info().set_velocity);
    close_segment();
}
END_TEST

START_TEST(test_a_profile_that_waits_is_busy_and_not_active)
{
    begin(0);
    MC_TP_REF table = lift();
    MC_MoveAbsolute_t move = {.Axis = &reference, .Execute = TRUE, .Position = 1.0, .Velocity = 2.0};
    MC_PositionProfile_t fb = {.Axis = &reference, .TimePosition = &table, .BufferMode = mcBuffered};
    SCAN(MC_MoveAbsolute, &move);
    fb.Execute = TRUE;
    SCAN(MC_PositionProfile, &fb);
    ck_assert(fb.Busy && !fb.Active && !fb.Error);
    table.NumberOfPairs = 0; /* copied at the edge */
    for (int n = 0; n < 3000 && !fb.Done; n++) {
        inputs();
        MC_MoveAbsolute(&move);
        MC_PositionProfile(&fb);
        outputs();
        ck_assert(!(fb.Active && move.Active));
    }
    ck_assert(fb.Done && move.Done);
    ck_assert_msg(fabs(info().set_position - 3.0) < 1e-9, "%f", info().set_position);
    close_segment();
}
END_TEST

START_TEST(test_refusals)
{
    begin(0);
    MC_TP_REF table = lift();
    const struct {
        MC_PositionProfile_t fb;
        cm1e_error_t error;
    } wrong[] = {
        {{.Axis = &reference, .TimePosition = &table, .ContinuousUpdate = TRUE}, CM1E_ERROR_UNSUPPORTED},
        {{.Axis = &reference}, CM1E_ERROR_AXIS_TABLE},
        {{.Axis = &reference, .TimePosition = &table, .TimeScale = -1.0}, CM1E_ERROR_AXIS_TABLE},
        {{.Axis = &reference, .TimePosition = &table, .PositionScale = 1000.0}, CM1E_ERROR_AXIS_VELOCITY_RANGE},
        {{.Axis = &reference, .TimePosition = &table, .BufferMode = (MC_BUFFER_MODE)6}, CM1E_ERROR_AXIS_BUFFER_MODE},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        MC_PositionProfile_t fb = wrong[i].fb;
        fb.Execute = TRUE;
        SCAN(MC_PositionProfile, &fb);
        ck_assert_msg(fb.Error && !fb.Busy && fb.ErrorID == cm1e_error_id(wrong[i].error), "%zu: %x", i, fb.ErrorID);
        ck_assert_int_eq(info().state, CM1E_AXIS_STANDSTILL);
    }
    close_segment();
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("fb_profile");
    TCase *tests = tcase_create("profile");
    tcase_set_timeout(tests, 60);
    tcase_add_loop_test(tests, test_position_profile_is_done_where_the_table_ends, 0, DEVICES);
    tcase_add_loop_test(tests, test_velocity_profile_stays_busy_with_its_last_velocity, 0, DEVICES);
    tcase_add_loop_test(tests, test_acceleration_profile, 0, DEVICES);
    tcase_add_test(tests, test_a_profile_that_waits_is_busy_and_not_active);
    tcase_add_test(tests, test_refusals);
    suite_add_tcase(suite, tests);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
