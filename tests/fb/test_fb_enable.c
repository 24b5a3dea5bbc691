/**
 * MC_Power and the reading blocks on axes without anything behind them, call by call (PLCopen Part 1 v2.0, 2.2.3, 3.1).
 */
#include <stdlib.h>

#include "fake_axis.h"
#include "quick_check.h"

static AXIS_REF_t x = {1}, y = {2}, nothing = {0}, stranger = {99};
static cm1e_axis_t *const axis_x = &fake_axes[0], *const axis_y = &fake_axes[1];
static WORD id(cm1e_error_t error) { return cm1e_error_id(error); }

/* ---- MC_Power -------------------------------------------------------------------------------------------------- */

static MC_Power_t power;

static void call_power(AXIS_REF_t *axis, BOOL enable)
{
    power.Axis = axis;
    power.Enable = enable;
    MC_Power(&power);
}

static void fresh(void)
{
    fake_reset();
    power = (MC_Power_t){.EnablePositive = TRUE, .EnableNegative = TRUE};
}

#define EXPECT_POWER(status, valid, error)                                                                             \
    do {                                                                                                               \
        ck_assert_int_eq(power.Status, status);                                                                        \
        ck_assert_int_eq(power.Valid, valid);                                                                          \
        ck_assert_int_eq(power.Error, (error) != CM1E_OK);                                                             \
        ck_assert_uint_eq(power.ErrorID, id(error));                                                                   \
    } while (0)

START_TEST(test_power_follows_enable_and_shows_the_stage)
{
    fresh();
    call_power(&x, FALSE);
    EXPECT_POWER(FALSE, FALSE, CM1E_OK);
    ck_assert_uint_eq(axis_x->power_calls, 0);
    call_power(&x, TRUE);
    EXPECT_POWER(FALSE, TRUE, CM1E_OK);
    ck_assert(axis_x->enable && axis_x->positive && axis_x->negative);
    axis_x->powered = true;
    call_power(&x, TRUE);
    EXPECT_POWER(TRUE, TRUE, CM1E_OK);
    call_power(&x, FALSE);
    EXPECT_POWER(TRUE, FALSE, CM1E_OK); /* the stage is still on */
    ck_assert(!axis_x->enable);
    call_power(&x, FALSE);
    EXPECT_POWER(TRUE, FALSE, CM1E_OK);
    axis_x->powered = false;
    call_power(&x, FALSE);
    EXPECT_POWER(FALSE, FALSE, CM1E_OK);
    const unsigned calls = axis_x->power_calls;
    call_power(&x, FALSE);
    ck_assert_uint_eq(axis_x->power_calls, calls); /* off: somebody else may have the axis */
}
END_TEST

START_TEST(test_power_passes_the_directions_as_levels)
{
    fresh();
    for (int i = 0; i < 4; i++) {
        power.EnablePositive = (BOOL)(i & 1);
        power.EnableNegative = (BOOL)(i >> 1);
        call_power(&x, TRUE);
        ck_assert_int_eq(axis_x->positive, i & 1);
        ck_assert_int_eq(axis_x->negative, i >> 1);
    }
}
END_TEST

START_TEST(test_power_without_axis_is_an_error_until_a_new_edge)
{
    AXIS_REF_t *const references[] = {NULL, &nothing, &stranger};
    for (int i = 0; i < 3; i++) {
        fresh();
        call_power(references[i], TRUE);
        EXPECT_POWER(FALSE, FALSE, CM1E_ERROR_FB_AXIS_REF);
        call_power(&x, TRUE);
        EXPECT_POWER(FALSE, FALSE, CM1E_ERROR_FB_AXIS_REF);
        ck_assert_uint_eq(axis_x->power_calls, 0);
        call_power(&x, FALSE);
        EXPECT_POWER(FALSE, FALSE, CM1E_OK);
        call_power(&x, TRUE);
        EXPECT_POWER(FALSE, TRUE, CM1E_OK);
    }
}
END_TEST

START_TEST(test_power_answers_for_its_axis_after_it_was_changed)
{
    fresh();
    axis_x->powered = true;
    call_power(&x, TRUE);
    call_power(&y, TRUE);
    EXPECT_POWER(TRUE, FALSE, CM1E_ERROR_FB_AXIS_CHANGED);
    ck_assert(axis_x->enable);
    ck_assert_uint_eq(axis_y->power_calls, 0);
    call_power(&x, TRUE);
    EXPECT_POWER(TRUE, FALSE, CM1E_ERROR_FB_AXIS_CHANGED);
    call_power(&y, FALSE); /* switches off the axis that it switched on */
    ck_assert(!axis_x->enable);
    EXPECT_POWER(TRUE, FALSE, CM1E_OK);
    axis_x->powered = false;
    call_power(&y, FALSE);
    EXPECT_POWER(FALSE, FALSE, CM1E_OK);
    call_power(&y, TRUE);
    EXPECT_POWER(FALSE, TRUE, CM1E_OK);
    ck_assert(axis_y->enable && !axis_x->enable);
}
END_TEST

START_TEST(test_second_power_is_an_error_and_leaves_the_first_alone)
{
    static MC_Power_t first;
    fresh();
    first = (MC_Power_t){.Axis = &x, .Enable = TRUE, .EnablePositive = TRUE};
    axis_x->powered = true;
    MC_Power(&first);
    call_power(&x, TRUE);
    EXPECT_POWER(FALSE, FALSE, CM1E_ERROR_FB_SECOND_POWER);
    MC_Power(&first);
    ck_assert(first.Status && first.Valid && !first.Error && axis_x->enable);
    call_power(&x, FALSE);
    EXPECT_POWER(FALSE, FALSE, CM1E_OK);
    ck_assert(axis_x->enable); /* Enable FALSE of the second one switches nothing off */
    call_power(&x, TRUE);
    EXPECT_POWER(FALSE, FALSE, CM1E_ERROR_FB_SECOND_POWER);
    first.Enable = FALSE;
    axis_x->powered = false;
    MC_Power(&first);
    call_power(&x, TRUE);
    EXPECT_POWER(FALSE, FALSE, CM1E_ERROR_FB_SECOND_POWER); /* never enabled by surprise: a new edge is needed */
    ck_assert(!axis_x->enable);
    call_power(&x, FALSE);
    call_power(&x, TRUE);
    EXPECT_POWER(FALSE, TRUE, CM1E_OK);
}
END_TEST

START_TEST(test_power_shows_why_the_stage_stays_off_and_recovers)
{
    fresh();
    call_power(&x, TRUE);
    axis_x->info.state = CM1E_AXIS_ERROR_STOP;
    axis_x->info.error = CM1E_ERROR_DRIVE_POWER;
    call_power(&x, TRUE);
    EXPECT_POWER(FALSE, FALSE, CM1E_ERROR_DRIVE_POWER);
    axis_x->info.state = CM1E_AXIS_DISABLED;
    axis_x->info.error = CM1E_OK;
    call_power(&x, TRUE);
    EXPECT_POWER(FALSE, TRUE, CM1E_OK);
    axis_x->powered = true;
    axis_x->info.state = CM1E_AXIS_ERROR_STOP; /* still decelerating under power: the axis's error, not the block's */
    axis_x->info.error = CM1E_ERROR_AXIS_LAG;
    call_power(&x, TRUE);
    EXPECT_POWER(TRUE, TRUE, CM1E_OK);
    axis_x->power_error = CM1E_ERROR_AXIS_OFFLINE;
    call_power(&x, TRUE);
    EXPECT_POWER(TRUE, FALSE, CM1E_ERROR_AXIS_OFFLINE);
    call_power(&x, FALSE);
    EXPECT_POWER(TRUE, FALSE, CM1E_OK);
}
END_TEST

/* ---- reading blocks -------------------------------------------------------------------------------------------- */

typedef struct outputs {
    BOOL valid, busy, error;
    WORD error_id;
} outputs_t;

#define READ_BLOCK(TYPE)                                                                                               \
    static TYPE##_t instance_##TYPE;                                                                                   \
    static outputs_t call_##TYPE(AXIS_REF_t *axis, BOOL enable)                                                        \
    {                                                                                                                  \
        TYPE##_t *fb = &instance_##TYPE;                                                                               \
        fb->Axis = axis;                                                                                               \
        fb->Enable = enable;                                                                                           \
        TYPE(fb);                                                                                                      \
        return (outputs_t){fb->Valid, fb->Busy, fb->Error, fb->ErrorID};                                               \
    }                                                                                                                  \
    static void clear_##TYPE(void) { instance_##TYPE = (TYPE##_t){0}; }

READ_BLOCK(MC_ReadStatus)
READ_BLOCK(MC_ReadActualPosition)
READ_BLOCK(MC_ReadActualVelocity)
READ_BLOCK(MC_ReadAxisError)

static const struct {
    outputs_t (*call)(AXIS_REF_t *axis, BOOL enable);
    void (*clear)(void);
    bool needs_bus; /**< what it reads is the drive's */
} readers[] = {
    {call_MC_ReadStatus, clear_MC_ReadStatus, false},
    {call_MC_ReadActualPosition, clear_MC_ReadActualPosition, true},
    {call_MC_ReadActualVelocity, clear_MC_ReadActualVelocity, true},
    {call_MC_ReadAxisError, clear_MC_ReadAxisError, false},
};
enum { READERS = sizeof readers / sizeof readers[0] };

#define EXPECT_READ(out, is_valid, is_busy, has_error)                                                                 \
    do {                                                                                                               \
        const outputs_t o = (out);                                                                                     \
        ck_assert_int_eq(o.valid, is_valid);                                                                           \
        ck_assert_int_eq(o.busy, is_busy);                                                                             \
        ck_assert_int_eq(o.error, (has_error) != CM1E_OK);                                                             \
        ck_assert_uint_eq(o.error_id, id(has_error));                                                                  \
    } while (0)

START_TEST(test_reader_is_valid_while_enabled)
{
    fake_reset();
    readers[_i].clear();
    EXPECT_READ(readers[_i].call(&x, FALSE), FALSE, FALSE, CM1E_OK);
    for (int i = 0; i < 3; i++)
        EXPECT_READ(readers[_i].call(&x, TRUE), TRUE, TRUE, CM1E_OK);
    EXPECT_READ(readers[_i].call(&x, FALSE), FALSE, FALSE, CM1E_OK);
    EXPECT_READ(readers[_i].call(NULL, FALSE), FALSE, FALSE, CM1E_OK);
    EXPECT_READ(readers[_i].call(&y, TRUE), TRUE, TRUE, CM1E_OK);
}
END_TEST

START_TEST(test_reader_without_axis_needs_a_new_edge)
{
    AXIS_REF_t *const references[] = {NULL, &nothing, &stranger};
    for (int i = 0; i < 3; i++) {
        fake_reset();
        readers[_i].clear();
        EXPECT_READ(readers[_i].call(references[i], TRUE), FALSE, FALSE, CM1E_ERROR_FB_AXIS_REF);
        EXPECT_READ(readers[_i].call(&x, TRUE), FALSE, FALSE, CM1E_ERROR_FB_AXIS_REF);
        EXPECT_READ(readers[_i].call(&x, FALSE), FALSE, FALSE, CM1E_OK);
        EXPECT_READ(readers[_i].call(&x, TRUE), TRUE, TRUE, CM1E_OK);
    }
}
END_TEST

START_TEST(test_reader_whose_axis_was_changed_needs_a_new_edge)
{
    AXIS_REF_t *const others[] = {&y, NULL, &nothing, &stranger};
    for (int i = 0; i < 4; i++) {
        fake_reset();
        readers[_i].clear();
        EXPECT_READ(readers[_i].call(&x, TRUE), TRUE, TRUE, CM1E_OK);
        EXPECT_READ(readers[_i].call(others[i], TRUE), FALSE, FALSE, CM1E_ERROR_FB_AXIS_CHANGED);
        EXPECT_READ(readers[_i].call(&x, TRUE), FALSE, FALSE, CM1E_ERROR_FB_AXIS_CHANGED);
        EXPECT_READ(readers[_i].call(&y, FALSE), FALSE, FALSE, CM1E_OK);
        EXPECT_READ(readers[_i].call(&y, TRUE), TRUE, TRUE, CM1E_OK);
    }
}
END_TEST

START_TEST(test_reader_of_an_axis_off_the_bus_recovers_by_itself)
{
    const bool needs_bus = readers[_i].needs_bus;
    fake_reset();
    readers[_i].clear();
    EXPECT_READ(readers[_i].call(&x, TRUE), TRUE, TRUE, CM1E_OK);
    axis_x->info.online = false;
    for (int i = 0; i < 3; i++)
        EXPECT_READ(readers[_i].call(&x, TRUE), !needs_bus, TRUE, needs_bus ? CM1E_ERROR_AXIS_OFFLINE : CM1E_OK);
    axis_x->info.online = true;
    EXPECT_READ(readers[_i].call(&x, TRUE), TRUE, TRUE, CM1E_OK);
    axis_x->info.online = false;
    EXPECT_READ(readers[_i].call(&x, FALSE), FALSE, FALSE, CM1E_OK);
}
END_TEST

START_TEST(test_status_shows_exactly_the_state_of_the_axis)
{
    fake_reset();
    MC_ReadStatus_t fb = {.Axis = &x};
    for (int state = 0; state < CM1E_AXIS_STATE_COUNT; state++)
        for (BOOL enable = FALSE; enable <= TRUE; enable++) {
            axis_x->info.state = (cm1e_axis_state_t)state;
            fb.Enable = enable;
            MC_ReadStatus(&fb);
            const BOOL shown[CM1E_AXIS_STATE_COUNT] = {
                [CM1E_AXIS_DISABLED] = fb.Disabled,
                [CM1E_AXIS_STANDSTILL] = fb.Standstill,
                [CM1E_AXIS_HOMING] = fb.Homing,
                [CM1E_AXIS_DISCRETE_MOTION] = fb.DiscreteMotion,
                [CM1E_AXIS_CONTINUOUS_MOTION] = fb.ContinuousMotion,
                [CM1E_AXIS_SYNCHRONIZED_MOTION] = fb.SynchronizedMotion,
                [CM1E_AXIS_STOPPING] = fb.Stopping,
                [CM1E_AXIS_ERROR_STOP] = fb.ErrorStop,
            };
            for (int other = 0; other < CM1E_AXIS_STATE_COUNT; other++)
                ck_assert_int_eq(shown[other], enable && other == state);
        }
}
END_TEST

START_TEST(test_values_are_the_axis_s_and_0_while_not_valid)
{
    fake_reset();
    axis_x->info.actual_position = 12.5;
    axis_x->info.actual_velocity = -3.25;
    axis_x->info.error = CM1E_ERROR_DRIVE_FAULT;
    axis_x->info.device_error = 0x7500;
    MC_ReadActualPosition_t position = {.Axis = &x, .Enable = TRUE};
    MC_ReadActualVelocity_t velocity = {.Axis = &x, .Enable = TRUE};
    MC_ReadAxisError_t error = {.Axis = &x, .Enable = TRUE};
    MC_ReadActualPosition(&position);
    MC_ReadActualVelocity(&velocity);
    MC_ReadAxisError(&error);
    ck_assert_double_eq(position.Position, 12.5);
    ck_assert_double_eq(velocity.Velocity, -3.25);
    ck_assert_uint_eq(error.AxisErrorID, id(CM1E_ERROR_DRIVE_FAULT));
    ck_assert_uint_eq(error.DeviceErrorCode, 0x7500);
    position.Enable = velocity.Enable = error.Enable = FALSE;
    MC_ReadActualPosition(&position);
    MC_ReadActualVelocity(&velocity);
    MC_ReadAxisError(&error);
    ck_assert(position.Position == 0 && velocity.Velocity == 0);
    ck_assert(error.AxisErrorID == 0 && error.DeviceErrorCode == 0);
}
END_TEST

/* ---- MC_SetOverride -------------------------------------------------------------------------------------------- */

START_TEST(test_override_is_written_while_enabled_and_kept)
{
    fake_reset();
    MC_SetOverride_t fb = {.Axis = &x, .VelFactor = 0.5, .AccFactor = 0.25, .JerkFactor = 0.75};
    MC_SetOverride(&fb);
    ck_assert(!fb.Enabled && !fb.Busy && !fb.Error && axis_x->override[0] == 0.0);
    fb.Enable = TRUE;
    MC_SetOverride(&fb);
    ck_assert(fb.Enabled && fb.Busy && !fb.Error);
    ck_assert(axis_x->override[0] == 0.5 && axis_x->override[1] == 0.25 && axis_x->override[2] == 0.75);
    fb.VelFactor = 0.0;
    fb.AccFactor = 0.0; /* figure 36, 4: nothing changes, and it passes */
    MC_SetOverride(&fb);
    ck_assert(!fb.Enabled && fb.Busy && fb.Error && fb.ErrorID == id(CM1E_ERROR_AXIS_OVERRIDE));
    ck_assert(axis_x->override[0] == 0.5);
    fb.AccFactor = 1.0;
    MC_SetOverride(&fb);
    ck_assert(fb.Enabled && fb.Busy && !fb.Error && fb.ErrorID == 0 && axis_x->override[0] == 0.0);
    fb.Enable = FALSE;
    fb.VelFactor = 1.0;
    MC_SetOverride(&fb);
    ck_assert(!fb.Enabled && !fb.Busy && !fb.Error && axis_x->override[0] == 0.0);
    fb.Enable = TRUE;
    MC_SetOverride(&fb);
    fb.Axis = &y;
    MC_SetOverride(&fb);
    ck_assert(!fb.Enabled && !fb.Busy && fb.Error && fb.ErrorID == id(CM1E_ERROR_FB_AXIS_CHANGED));
    ck_assert(axis_y->override[0] == 0.0);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("Enable");
    TCase *powers = tcase_create("MC_Power"), *reads = tcase_create("readers");
    const TTest *const power_tests[] = {
        test_power_follows_enable_and_shows_the_stage,
        test_power_passes_the_directions_as_levels,
        test_power_without_axis_is_an_error_until_a_new_edge,
        test_power_answers_for_its_axis_after_it_was_changed,
        test_second_power_is_an_error_and_leaves_the_first_alone,
        test_power_shows_why_the_stage_stays_off_and_recovers,
        test_status_shows_exactly_the_state_of_the_axis,
        test_values_are_the_axis_s_and_0_while_not_valid,
    };
    const TTest *const reader_tests[] = {
        test_reader_is_valid_while_enabled,
        test_reader_without_axis_needs_a_new_edge,
        test_reader_whose_axis_was_changed_needs_a_new_edge,
        test_reader_of_an_axis_off_the_bus_recovers_by_itself,
    };
    for (size_t i = 0; i < sizeof power_tests / sizeof power_tests[0]; i++)
        tcase_add_test(powers, power_tests[i]);
    for (size_t i = 0; i < sizeof reader_tests / sizeof reader_tests[0]; i++)
        tcase_add_loop_test(reads, reader_tests[i], 0, READERS);
    tcase_add_test(powers, test_override_is_written_while_enabled_and_kept);
    suite_add_tcase(suite, powers);
    suite_add_tcase(suite, reads);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
