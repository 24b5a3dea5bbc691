/**
 * What the blocks of a slave and its masters have of their own (PLCopen Part 1 v2.0, 4.2 ... 4.10), on axes without
 * anything behind them: the masters that are latched, the outputs that come and go, and which inputs reach the axis.
 * What they share with all blocks of the Execute type: test_fb_execute.
 */
#include <stdlib.h>

#include "execute_blocks.h"

static AXIS_REF_t nothing = {0};

static cm1e_command_status_t *status_of(cm1e_axis_t *axis) { return &axis->status[axis->id % FAKE_COMMANDS]; }

/* ---- masters ----------------------------------------------------------------------------------------------------- */

/** A block with the places of its masters. */
typedef struct follower {
    const char *name;
    void (*call)(void *fb);
    AXIS_REF_t **slave, **masters[2];
    BOOL *execute, *busy, *error;
    WORD *error_id;
    void *fb;
} follower_t;

static MC_GearIn_t gear_in;
static MC_GearInPos_t gear_in_pos;
static MC_CamIn_t cam_in;
static MC_CombineAxes_t combine;
static MC_PhasingAbsolute_t phasing_absolute;
static MC_PhasingRelative_t phasing_relative;

#define FOLLOWER(TYPE, FB)                                                                                             \
    static void follow_##FB(void *fb) { TYPE(fb); }
FOLLOWER(MC_GearIn, gear_in)
FOLLOWER(MC_GearInPos, gear_in_pos)
FOLLOWER(MC_CamIn, cam_in)
FOLLOWER(MC_CombineAxes, combine)
FOLLOWER(MC_PhasingAbsolute, phasing_absolute)
FOLLOWER(MC_PhasingRelative, phasing_relative)

#define ROW(FB, MASTER, SECOND)                                                                                        \
    {#FB, follow_##FB, &FB.Slave, {&FB.MASTER, SECOND}, &FB.Execute, &FB.Busy, &FB.Error, &FB.ErrorID, &FB}
static const follower_t followers[] = {
    ROW(gear_in, Master, NULL),          ROW(gear_in_pos, Master, NULL),      ROW(cam_in, Master, NULL),
    ROW(combine, Master1, &combine.Master2), ROW(phasing_absolute, Master, NULL), ROW(phasing_relative, Master, NULL),
};
enum { FOLLOWERS = sizeof followers / sizeof *followers };

static void clear_followers(void)
{
    fake_reset();
    gear_in = (MC_GearIn_t){.Slave = &x, .Master = &y, MC_GEARIN_DEFAULTS};
    gear_in_pos = (MC_GearInPos_t){.Slave = &x, .Master = &y, MC_GEARINPOS_DEFAULTS};
    cam_in = (MC_CamIn_t){.Slave = &x, .Master = &y};
    combine = (MC_CombineAxes_t){.Slave = &x, .Master1 = &y, .Master2 = &y, MC_COMBINEAXES_DEFAULTS};
    phasing_absolute = (MC_PhasingAbsolute_t){.Slave = &x, .Master = &y};
    phasing_relative = (MC_PhasingRelative_t){.Slave = &x, .Master = &y};
}

static void call(const follower_t *f, BOOL execute)
{
    *f->execute = execute;
    f->call(f->fb);
}

static void expect_changed(const follower_t *f, const char *what)
{
    ck_assert_msg(*f->error && !*f->busy && *f->error_id == cm1e_error_id(CM1E_ERROR_FB_AXIS_CHANGED),
                  "%s, %s: Busy %d, Error %d, ErrorID %#x", f->name, what, *f->busy, *f->error, *f->error_id);
}

START_TEST(test_another_master_while_busy_is_an_error_and_touches_no_axis)
{
    const follower_t *f = &followers[_i];
    for (int m = 0; m < 2; m++)
        for (int at = 0; at < 4; at++) { /* in the call that it falls, later, with another edge, by no axis at all */
            clear_followers();
            if (!f->masters[m])
                continue;
            call(f, TRUE);
            ck_assert(*f->busy);
            call(f, at < 2 ? TRUE : FALSE);
            *f->masters[m] = at == 3 ? NULL : &x;
            call(f, at == 1 || at == 2);
            expect_changed(f, "another master");
            ck_assert_uint_eq(axis_x->starts, 1);
            ck_assert_uint_eq(axis_y->starts, 0);
            ck_assert_int_eq(status_of(axis_x)->state, CM1E_COMMAND_ACTIVE);
            *f->masters[m] = &y;
            call(f, *f->execute);
            ck_assert(!*f->busy && *f->error == *f->execute); /* what it was is no longer its own */
            call(f, FALSE);
            ck_assert(!*f->error);
            call(f, TRUE);
            ck_assert(*f->busy);
            ck_assert_uint_eq(axis_x->starts, 2);
        }
}
END_TEST

START_TEST(test_another_slave_while_busy_is_an_error_and_touches_no_axis)
{
    const follower_t *f = &followers[_i];
    clear_followers();
    call(f, TRUE);
    *f->slave = &y;
    call(f, TRUE);
    expect_changed(f, "another slave");
    ck_assert_uint_eq(axis_x->starts, 1);
    ck_assert_uint_eq(axis_y->starts, 0);
}
END_TEST

START_TEST(test_master_may_be_another_one_at_the_next_edge)
{
    const follower_t *f = &followers[_i];
    static AXIS_REF_t copy = {2}, third = {3};
    clear_followers();
    call(f, TRUE);
    *f->masters[0] = &copy; /* the same axis */
    call(f, TRUE);
    ck_assert(*f->busy);
    fake_finish(axis_x, CM1E_COMMAND_ERROR, CM1E_ERROR_AXIS_ERROR_STOP);
    call(f, TRUE);
    *f->masters[0] = &third; /* over: no error of this block */
    call(f, TRUE);
    ck_assert_uint_eq(*f->error_id, cm1e_error_id(CM1E_ERROR_AXIS_ERROR_STOP));
    call(f, FALSE);
    call(f, TRUE);
    ck_assert(*f->busy);
    ck_assert_uint_eq(axis_x->coupling.master[0].axis.Handle, 3);
}
END_TEST

/** What is wrong with a master the axis says: the block hands it on as it is. */
START_TEST(test_master_that_is_none_reaches_the_axis_as_none)
{
    const follower_t *f = &followers[_i];
    for (int n = 0; n < 2; n++) {
        clear_followers();
        *f->masters[0] = n ? &nothing : NULL;
        call(f, TRUE);
        ck_assert_uint_eq(axis_x->coupling.master[0].axis.Handle, 0);
        clear_followers();
        *f->masters[0] = n ? &nothing : NULL;
        axis_x->start_error = CM1E_ERROR_AXIS_MASTER;
        call(f, TRUE);
        ck_assert_uint_eq(*f->error_id, cm1e_error_id(CM1E_ERROR_AXIS_MASTER));
    }
}
END_TEST

/* ---- outputs ----------------------------------------------------------------------------------------------------- */

START_TEST(test_outputs_in_step_come_and_go_in_every_kind_of_call)
{
    clear_followers();
    gear_in.Execute = gear_in_pos.Execute = cam_in.Execute = combine.Execute = TRUE;
    for (BOOL update = FALSE; update <= TRUE; update++)
        for (unsigned n = 0; n < 16; n++) {
            gear_in.ContinuousUpdate = cam_in.ContinuousUpdate = combine.ContinuousUpdate = update;
            gear_in_pos.Execute = n % 3 != 0; /* a new edge now and then */
            const cm1e_command_status_t now = {.state = CM1E_COMMAND_ACTIVE, .reached = n & 1, .synchronizing = n & 2,
                                               .ends = n / 3};
            MC_GearIn(&gear_in);
            *status_of(axis_x) = now;
            MC_GearIn(&gear_in);
            ck_assert(gear_in.Busy && gear_in.Active && gear_in.InGear == now.reached);
            MC_GearInPos(&gear_in_pos);
            *status_of(axis_x) = now;
            MC_GearInPos(&gear_in_pos);
            ck_assert(!gear_in_pos.Busy || (gear_in_pos.Active && gear_in_pos.InSync == now.reached &&
                                            gear_in_pos.StartSync == now.synchronizing));
            MC_CamIn(&cam_in);
            ck_assert(!cam_in.EndOfProfile);
            *status_of(axis_x) = now;
            MC_CamIn(&cam_in);
            ck_assert(cam_in.InSync == now.reached && cam_in.EndOfProfile == (now.ends > 0));
            MC_CamIn(&cam_in);
            ck_assert(!cam_in.EndOfProfile); /* shown once, */
            status_of(axis_x)->ends += 2;    /* however many there were between two calls */
            MC_CamIn(&cam_in);
            ck_assert(cam_in.EndOfProfile);
            MC_CombineAxes(&combine);
            *status_of(axis_x) = now;
            MC_CombineAxes(&combine);
            ck_assert(combine.InSync == now.reached);
            fake_reset();
            gear_in.Execute = cam_in.Execute = combine.Execute = FALSE;
            MC_GearIn(&gear_in);
            MC_GearInPos(&gear_in_pos);
            MC_CamIn(&cam_in);
            MC_CombineAxes(&combine);
            gear_in.Execute = cam_in.Execute = combine.Execute = TRUE;
        }
}
END_TEST

START_TEST(test_outputs_in_step_fall_with_the_command)
{
    static const cm1e_command_state_t ends[] = {CM1E_COMMAND_ABORTED, CM1E_COMMAND_ERROR, CM1E_COMMAND_BUFFERED};
    for (size_t i = 0; i < 3; i++) {
        clear_followers();
        gear_in_pos.Execute = cam_in.Execute = TRUE;
        MC_GearInPos(&gear_in_pos);
        *status_of(axis_x) = (cm1e_command_status_t){.state = CM1E_COMMAND_ACTIVE, .reached = true,
                                                     .synchronizing = true};
        MC_GearInPos(&gear_in_pos);
        ck_assert(gear_in_pos.InSync && gear_in_pos.StartSync);
        status_of(axis_x)->state = ends[i];
        status_of(axis_x)->error = CM1E_ERROR_AXIS_MASTER_LOST;
        MC_GearInPos(&gear_in_pos);
        ck_assert(!gear_in_pos.InSync && !gear_in_pos.StartSync && !gear_in_pos.Active);
        ck_assert(gear_in_pos.Busy == (ends[i] == CM1E_COMMAND_BUFFERED));
    }
}
END_TEST

START_TEST(test_phase_shift_is_shown_while_busy_and_kept)
{
    clear_followers();
    phasing_absolute.Execute = phasing_relative.Execute = TRUE;
    for (double at = 0; at <= 3; at++) {
        MC_PhasingAbsolute(&phasing_absolute);
        status_of(axis_x)->covered = at;
        MC_PhasingAbsolute(&phasing_absolute);
        ck_assert_double_eq(phasing_absolute.AbsolutePhaseShift, at);
    }
    fake_finish(axis_x, CM1E_COMMAND_DONE, CM1E_OK);
    status_of(axis_x)->covered = 4;
    for (int n = 0; n < 3; n++) {
        MC_PhasingAbsolute(&phasing_absolute);
        ck_assert(phasing_absolute.Done && !phasing_absolute.Active && phasing_absolute.AbsolutePhaseShift == 4);
    }
    MC_PhasingRelative(&phasing_relative);
    status_of(axis_x)->covered = -2;
    MC_PhasingRelative(&phasing_relative);
    ck_assert_double_eq(phasing_relative.CoveredPhaseShift, -2);
    ck_assert(phasing_relative.Busy && phasing_relative.Active);
}
END_TEST

/* ---- inputs ------------------------------------------------------------------------------------------------------ */

static void expect_master(const cm1e_coupling_master_t *got, UINT handle, MC_SOURCE source, int32_t numerator,
                          uint32_t denominator)
{
    ck_assert_uint_eq(got->axis.Handle, handle);
    ck_assert_int_eq(got->source, source);
    ck_assert_int_eq(got->numerator, numerator);
    ck_assert_uint_eq(got->denominator, denominator);
}

static void expect_dynamics(cm1e_command_kind_t kind, double position, double velocity, MC_BUFFER_MODE mode)
{
    const cm1e_axis_command_t *got = &axis_x->command;
    ck_assert_int_eq(got->kind, kind);
    ck_assert_double_eq(got->position, position);
    ck_assert_double_eq(got->velocity, velocity);
    ck_assert_double_eq(got->acceleration, 3);
    ck_assert_double_eq(got->deceleration, 4);
    ck_assert_double_eq(got->jerk, 5);
    ck_assert_int_eq(got->buffer_mode, mode);
}

START_TEST(test_inputs_reach_the_axis_at_the_edge_and_not_later)
{
    const cm1e_axis_coupling_t *got = &axis_x->coupling;
    clear_followers();
    MC_GearIn_t gear = {.Slave = &x, .Master = &y, .Execute = TRUE, .RatioNumerator = -7,
                        .RatioDenominator = 4000000000, .MasterValueSource = mcActualValue, .Acceleration = 3,
                        .Deceleration = 4, .Jerk = 5, .BufferMode = mcBuffered};
    MC_GearIn(&gear);
    expect_dynamics(CM1E_COMMAND_GEAR_IN, 0, 0, mcBuffered);
    expect_master(&got->master[0], 2, mcActualValue, -7, 4000000000);
    gear.RatioNumerator = 9;
    MC_GearIn(&gear);
    ck_assert_uint_eq(axis_x->starts, 1);
    ck_assert_uint_eq(axis_x->updates, 0);

    MC_GearInPos_t pos = {.Slave = &x, .Master = &y, .Execute = TRUE, .RatioNumerator = 2, .RatioDenominator = 3,
                          .MasterSyncPosition = 11, .SlaveSyncPosition = 12, .SyncMode = mcSlowDown,
                          .MasterStartDistance = 13, .Velocity = 2, .Acceleration = 3, .Deceleration = 4, .Jerk = 5,
                          .BufferMode = mcBlendingHigh};
    MC_GearInPos(&pos);
    expect_dynamics(CM1E_COMMAND_GEAR_IN_POS, 0, 2, mcBlendingHigh);
    expect_master(&got->master[0], 2, mcSetValue, 2, 3);
    ck_assert(got->master_sync_position == 11 && got->slave_sync_position == 12 && got->master_start_distance == 13);
    ck_assert_int_eq(got->sync_mode, mcSlowDown);

    MC_CamIn_t cam = {.Slave = &x, .Master = &y, .Execute = TRUE, .MasterOffset = 1, .SlaveOffset = 2,
                      .MasterScaling = 3, .SlaveScaling = 4, .MasterStartDistance = 5, .MasterSyncPosition = 6,
                      .StartMode = mcRampIn, .MasterValueSource = mcActualValue, .CamTableID = 7,
                      .BufferMode = mcBuffered};
    MC_CamIn(&cam);
    ck_assert_int_eq(axis_x->command.kind, CM1E_COMMAND_CAM_IN);
    ck_assert_int_eq(axis_x->command.buffer_mode, mcBuffered);
    ck_assert(got->master_offset == 1 && got->slave_offset == 2 && got->master_scaling == 3 && got->slave_scaling == 4);
    ck_assert(got->master_start_distance == 5 && got->master_sync_position == 6);
    ck_assert(got->start_mode == mcRampIn && got->cam == 7 && got->master[0].source == mcActualValue);

    MC_PhasingAbsolute_t absolute = {.Slave = &x, .Master = &y, .Execute = TRUE, .PhaseShift = 1, .Velocity = 2,
                                     .Acceleration = 3, .Deceleration = 4, .Jerk = 5, .BufferMode = mcBuffered};
    MC_PhasingAbsolute(&absolute);
    expect_dynamics(CM1E_COMMAND_PHASING_ABSOLUTE, 1, 2, mcBuffered);
    ck_assert_uint_eq(got->master[0].axis.Handle, 2);
    MC_PhasingRelative_t relative = {.Slave = &x, .Master = &y, .Execute = TRUE, .PhaseShift = -1, .Velocity = 2,
                                     .Acceleration = 3, .Deceleration = 4, .Jerk = 5};
    MC_PhasingRelative(&relative);
    expect_dynamics(CM1E_COMMAND_PHASING_RELATIVE, -1, 2, mcAborting);
}
END_TEST

START_TEST(test_ratios_of_combined_axes_keep_their_signs)
{
    static const struct {
        DINT numerator, denominator;
        int32_t asked;
        uint32_t of;
    } ratios[] = {{1, 2, 1, 2}, {-1, 2, -1, 2}, {1, -2, -1, 2}, {-3, -2, 3, 2}, {0, 5, 0, 5}, {5, 0, 5, 0},
                  {INT32_MIN, 1, INT32_MIN, 1}, {INT32_MIN, -1, 0, 1}, {INT32_MAX, INT32_MIN, -INT32_MAX, 2147483648},
                  {1, INT32_MIN, -1, 2147483648}};
    for (size_t i = 0; i < sizeof ratios / sizeof *ratios; i++) {
        clear_followers();
        combine.CombineMode = mcSubAxes;
        combine.Master2 = &x;
        combine.MasterValueSourceM2 = mcActualValue;
        combine.GearRatioNumeratorM2 = ratios[i].numerator;
        combine.GearRatioDenominatorM2 = ratios[i].denominator;
        combine.Execute = TRUE;
        MC_CombineAxes(&combine);
        expect_master(&axis_x->coupling.master[0], 2, mcSetValue, 1, 1);
        expect_master(&axis_x->coupling.master[1], 1, mcActualValue, ratios[i].asked, ratios[i].of);
        ck_assert_int_eq(axis_x->coupling.combine, mcSubAxes);
    }
}
END_TEST

START_TEST(test_continuous_update_hands_on_ratio_and_offsets)
{
    clear_followers();
    gear_in.Execute = gear_in.ContinuousUpdate = TRUE;
    MC_GearIn(&gear_in);
    gear_in.RatioNumerator = 3;
    MC_GearIn(&gear_in);
    ck_assert_uint_eq(axis_x->updates, 1);
    ck_assert_int_eq(axis_x->coupling.master[0].numerator, 3);
    gear_in.ContinuousUpdate = FALSE;
    gear_in.RatioNumerator = 4;
    for (int n = 0; n < 3; n++)
        MC_GearIn(&gear_in);
    ck_assert_uint_eq(axis_x->updates, 1);
    cam_in.Execute = cam_in.ContinuousUpdate = TRUE;
    MC_CamIn(&cam_in);
    cam_in.SlaveOffset = 8;
    MC_CamIn(&cam_in);
    ck_assert_double_eq(axis_x->coupling.slave_offset, 8);
    axis_x->update_error = CM1E_ERROR_AXIS_RATIO;
    MC_CamIn(&cam_in);
    ck_assert(cam_in.Error && !cam_in.Busy && !cam_in.InSync);
}
END_TEST

/* ---- MC_CamTableSelect ------------------------------------------------------------------------------------------- */

START_TEST(test_cam_is_selected_at_the_edge_and_its_number_stays)
{
    fake_reset();
    const MC_CAM_POINT points[2] = {{.Master = 0}, {.Master = 1}};
    MC_CAM_REF table = {.Points = points, .NumberOfPoints = 2, .Curve = mcCamLinear};
    MC_CamTableSelect_t fb = {.Slave = &x, .CamTable = &table, .Execute = TRUE, .Periodic = 7, .SlaveAbsolute = TRUE};
    MC_CamTableSelect(&fb);
    ck_assert(fb.Busy && !fb.Done && !fb.Error);
    ck_assert(axis_x->cam.Points == points && axis_x->cam.NumberOfPoints == 2 && axis_x->cam.Curve == mcCamLinear);
    ck_assert(axis_x->cam_flags[0] && !axis_x->cam_flags[1] && axis_x->cam_flags[2]);
    MC_CamTableSelect(&fb);
    ck_assert(fb.Done && !fb.Busy && fb.CamTableID == 1);
    fb.Execute = FALSE;
    MC_CamTableSelect(&fb);
    ck_assert(!fb.Done && fb.CamTableID == 1);
    ck_assert_uint_eq(axis_x->starts, 1);
    fb.Execute = TRUE;
    fb.Master = &y; /* may be named, and is not needed */
    MC_CamTableSelect(&fb);
    ck_assert(fb.Busy && fb.CamTableID == 2);
    ck_assert_uint_eq(axis_y->starts, 0);
    fb.Slave = &y;
    MC_CamTableSelect(&fb);
    ck_assert_uint_eq(fb.ErrorID, cm1e_error_id(CM1E_ERROR_FB_AXIS_CHANGED));
}
END_TEST

START_TEST(test_cam_that_is_refused_has_no_number)
{
    const MC_CAM_REF table = {.NumberOfPoints = 2};
    for (int n = 0; n < 3; n++) {
        fake_reset();
        MC_CamTableSelect_t fb = {.Slave = &x, .CamTable = n == 0 ? NULL : &table, .CamTableID = 5, .Execute = TRUE};
        static const cm1e_error_t expected[] = {CM1E_ERROR_AXIS_CAM_TABLE, CM1E_ERROR_FULL, CM1E_ERROR_UNSUPPORTED};
        if (n == 1)
            axis_x->start_error = CM1E_ERROR_FULL;
        if (n == 2)
            fb.ExecutionMode = mcQueued;
        MC_CamTableSelect(&fb);
        ck_assert(fb.Error && !fb.Busy && fb.CamTableID == 0);
        ck_assert_uint_eq(fb.ErrorID, cm1e_error_id(expected[n]));
        ck_assert_uint_eq(axis_x->starts, n == 1);
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("slaves and masters");
    TCase *cases = tcase_create("slaves and masters");
    tcase_add_loop_test(cases, test_another_master_while_busy_is_an_error_and_touches_no_axis, 0, FOLLOWERS);
    tcase_add_loop_test(cases, test_another_slave_while_busy_is_an_error_and_touches_no_axis, 0, FOLLOWERS);
    tcase_add_loop_test(cases, test_master_may_be_another_one_at_the_next_edge, 0, FOLLOWERS);
    tcase_add_loop_test(cases, test_master_that_is_none_reaches_the_axis_as_none, 0, FOLLOWERS);
    const TTest *const single[] = {
        test_outputs_in_step_come_and_go_in_every_kind_of_call,
        test_outputs_in_step_fall_with_the_command,
        test_phase_shift_is_shown_while_busy_and_kept,
        test_inputs_reach_the_axis_at_the_edge_and_not_later,
        test_ratios_of_combined_axes_keep_their_signs,
        test_continuous_update_hands_on_ratio_and_offsets,
        test_cam_is_selected_at_the_edge_and_its_number_stays,
        test_cam_that_is_refused_has_no_number,
    };
    for (size_t i = 0; i < sizeof single / sizeof single[0]; i++)
        tcase_add_test(cases, single[i]);
    suite_add_tcase(suite, cases);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
