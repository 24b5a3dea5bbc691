/* MC_DigitalCamSwitch (PLCopen Part 1 v2.0, 3.32): its enable, mask, outputs and errors. When its tracks are on:
 * test_fb_cam. */
#include "cam_bench.h"

static void expect_error(cm1e_error_t error)
{
    ck_assert_msg(fb.Error && fb.ErrorID == cm1e_error_id(error) && !fb.InOperation && outputs.Values == 0,
                  "0x%04X, not 0x%04X", fb.ErrorID, cm1e_error_id(error));
}

/* ---- enable, mask, outputs --------------------------------------------------------------------------------------- */

START_TEST(test_the_mask_takes_tracks_away_and_gives_them_back_at_once)
{
    fresh(0.0);
    for (int track = 1; track <= 32; track++)
        add(track, -1.0, 1.0);
    at(0.0, 0.0);
    ck_assert_uint_eq(outputs.Values, 0xFFFFFFFF);
    fb.EnableMask = 0x80000005;
    at(0.0, 0.0);
    ck_assert_uint_eq(outputs.Values, 0x80000005);
    fb.EnableMask = 0;
    at(0.0, 0.0);
    ck_assert(fb.InOperation && outputs.Values == 0);
    fb.EnableMask = 0x00000100;
    at(0.0, 0.0);
    ck_assert_uint_eq(outputs.Values, 0x100);
    at(2.0, 0.0);
    ck_assert_uint_eq(outputs.Values, 0);
}
END_TEST

START_TEST(test_enable_that_falls_switches_everything_off_and_forgets)
{
    fresh(0.0);
    outputs.Axis = (AXIS_REF_t){2};
    add(1, 0.0, 10.0);
    MC_CAMSWITCH *cam = add(2, 5.0, 0.0);
    cam->CamSwitchMode = 1;
    cam->Duration = 10000 * MS;
    tracks.Tracks[0].OffCompensation = 10000 * MS;
    at(4.0, 1000.0);
    at(6.0, 1000.0);
    ck_assert_uint_eq(outputs.Values, 3);
    ck_assert(output.axis == 1 && output.number == 1 && output.value);
    fb.Enable = FALSE;
    at(20.0, 0.0);
    ck_assert(!fb.InOperation && !fb.Busy && outputs.Values == 0 && !output.value);
    const unsigned writes = output.writes;
    at(20.0, 0.0);
    ck_assert_uint_eq(output.writes, writes); /* somebody else may write it now */
    fb.Enable = TRUE;
    at(20.0, 0.0);
    ck_assert(fb.InOperation && outputs.Values == 0);
}
END_TEST

START_TEST(test_another_axis_of_the_output_loses_only_what_was_written_to_it)
{
    fresh(0.0);
    add(1, 0.0, 10.0);
    outputs = (MC_OUTPUT_REF){.Axis = {1}, .Number = 1};
    at(4.0, 0.0);
    outputs = (MC_OUTPUT_REF){.Axis = {2}, .Number = 2};
    at(4.0, 0.0);
    ck_assert(output.axis == 1 && output.number == 2 && output.value);
    const unsigned writes = output.writes;
    fb.Enable = FALSE;
    at(4.0, 0.0);
    ck_assert(output.axis == 1 && output.number == 2 && !output.value);
    ck_assert_uint_eq(output.writes, writes + 1); /* output 1 of this axis may be another one's */
}
END_TEST

START_TEST(test_the_output_of_track_1_is_lent_for_a_while_only)
{
    fresh(0.0);
    outputs.Axis = (AXIS_REF_t){1};
    outputs.Number = 1;
    add(1, 0.0, 10.0);
    add(2, 0.0, 20.0);
    for (int n = 0; n < 20; n++) {
        position = n;
        now_ns += (n < 10 ? 1 : 100) * MS;
        call();
        ck_assert(output.axis == 0 && output.number == 1 && output.value == (n <= 10));
        ck_assert_int_eq(output.keep_ns / MS, n == 0 ? 1000 : n < 10 ? 100 : 400);
    }
    const unsigned writes = output.writes;
    outputs.Axis.Handle = 0; /* shown only */
    fb.Enable = FALSE;
    call();
    fb.Enable = TRUE;
    at(5.0, 0.0);
    ck_assert_uint_eq(outputs.Values, 3);
    ck_assert_uint_eq(output.writes, writes + 1); /* off, when Enable fell */
}
END_TEST

START_TEST(test_an_output_that_cannot_be_written_is_an_error_that_passes)
{
    static const cm1e_error_t errors[] = {CM1E_ERROR_AXIS_SIGNAL, CM1E_ERROR_PDO_MAPPING, CM1E_ERROR_AXIS_OFFLINE};
    fresh(0.0);
    outputs.Axis = (AXIS_REF_t){1};
    add(1, 0.0, 10.0);
    for (int i = 0; i < 3; i++) {
        output.error = errors[i];
        at(5.0, 0.0);
        expect_error(errors[i]);
        ck_assert(output.told == errors[i] && output.told_number == 1);
        output.told = CM1E_ERROR_TIMEOUT;
        at(5.0, 0.0);
        ck_assert_int_eq(output.told, CM1E_ERROR_TIMEOUT); /* once */
        output.error = CM1E_OK;
        at(5.0, 0.0);
        ck_assert_int_eq(output.told, CM1E_OK);
        ck_assert(fb.InOperation && outputs.Values == 1 && output.value);
    }
    outputs.Axis.Handle = 99;
    at(5.0, 0.0);
    expect_error(CM1E_ERROR_FB_AXIS_REF);
}
END_TEST

START_TEST(test_switches_and_tracks_that_cannot_be)
{
    const TIME day = INT64_C(86400000) * MS;
    static const MC_CAMSWITCH good = {.TrackNumber = 1, .FirstOnPosition = 1.0, .LastOnPosition = 2.0};
    for (int i = 0; i < 20; i++) {
        cm1e_cam_switch_input_t input = CM1E_CAM_SWITCH_COUNT;
        int number = 2;
        fresh(i < 18 ? 0.0 : 360.0);
        add(2, 0.0, 10.0);
        MC_CAMSWITCH *cam = add(1, 1.0, 2.0);
        at(5.0, 0.0);
        ck_assert_uint_eq(outputs.Values, 2);
        switch (i) {
        case 0: cam->TrackNumber = 0, input = CM1E_CAM_SWITCH_TRACK; break;
        case 1: cam->TrackNumber = 33, input = CM1E_CAM_SWITCH_TRACK; break;
        case 2: cam->TrackNumber = -1, input = CM1E_CAM_SWITCH_TRACK; break;
        case 3: cam->FirstOnPosition = NAN, input = CM1E_CAM_SWITCH_FIRST_ON; break;
        case 4: cam->LastOnPosition = INFINITY, input = CM1E_CAM_SWITCH_LAST_ON; break;
        case 5: cam->LastOnPosition = 0.5, input = CM1E_CAM_SWITCH_FIRST_ON; break;
        case 6: cam->AxisDirection = 3, input = CM1E_CAM_SWITCH_DIRECTION; break;
        case 7: cam->AxisDirection = -1, input = CM1E_CAM_SWITCH_DIRECTION; break;
        case 8: cam->CamSwitchMode = 2, input = CM1E_CAM_SWITCH_MODE; break;
        case 9: cam->CamSwitchMode = 1, cam->Duration = -1, input = CM1E_CAM_SWITCH_DURATION; break;
        case 10: tracks.Tracks[0].Hysteresis = -0.1, input = CM1E_CAM_SWITCH_HYSTERESIS; break;
        case 11: tracks.Tracks[0].Hysteresis = NAN, input = CM1E_CAM_SWITCH_HYSTERESIS; break;
        case 12: tracks.Tracks[0].OnCompensation = -day, input = CM1E_CAM_SWITCH_ON_COMPENSATION; break;
        case 13: tracks.Tracks[0].OffCompensation = INT64_MAX, input = CM1E_CAM_SWITCH_OFF_COMPENSATION; break;
        case 14: tracks.Tracks[0].OffCompensation = INT64_MIN, input = CM1E_CAM_SWITCH_OFF_COMPENSATION; break;
        case 15: cams.NumberOfSwitches = 0, number = 0; break;
        case 16: cams.NumberOfSwitches = 33, number = 0; break;
        case 17: fb.Switches = NULL, number = 0; break;
        case 18: cam->LastOnPosition = 361.0, input = CM1E_CAM_SWITCH_LAST_ON; break;
        case 19: cam->LastOnPosition = NAN, input = CM1E_CAM_SWITCH_LAST_ON; break;
        }
        at(5.0, 0.0);
        expect_error(CM1E_ERROR_FB_CAM_SWITCH);
        ck_assert(refused.input == input && refused.number == number);
        const unsigned count = refused.count, right = refused.right;
        at(5.0, 0.0);
        ck_assert(refused.count == count && refused.right == right); /* it is told once */
        *cam = good;
        memset(&tracks, 0, sizeof tracks);
        cams.NumberOfSwitches = 2;
        fb.Switches = &cams;
        at(5.0, 0.0);
        ck_assert(fb.InOperation && outputs.Values == 2 && refused.right == right + 1);
    }
    fb.ValueSource = mcCommandedValue;
    at(5.0, 0.0);
    expect_error(CM1E_ERROR_INVALID_ARGUMENT);
    fb.ValueSource = (MC_SOURCE)7;
    at(5.0, 0.0);
    expect_error(CM1E_ERROR_INVALID_ARGUMENT);
    fb.ValueSource = mcSetValue;
    fb.Outputs = NULL;
    now_ns += MS;
    MC_DigitalCamSwitch(&fb);
    ck_assert(fb.Error && fb.ErrorID == cm1e_error_id(CM1E_ERROR_INVALID_ARGUMENT) && !fb.InOperation);
    fb.Outputs = &outputs;
    fb.TrackOptions = NULL; /* none are needed */
    at(5.0, 0.0);
    ck_assert(fb.InOperation && outputs.Values == 2);
}
END_TEST

/* ---- an axis that is not seen, or is called something else ------------------------------------------------------- */

START_TEST(test_a_position_that_is_unknown_for_long_switches_off)
{
    fresh(0.0);
    fb.ValueSource = mcActualValue;
    add(1, 0.0, 10.0);
    at(5.0, 0.0);
    fake_axes[0].info.online = false;
    for (int n = 1; n <= 20; n++) {
        at(5.0, 0.0);
        ck_assert(fb.InOperation && outputs.Values == 1);
    }
    at(5.0, 0.0);
    expect_error(CM1E_ERROR_AXIS_OFFLINE);
    ck_assert(fb.Busy);
    fake_axes[0].info.online = true;
    at(5.0, 0.0);
    ck_assert(fb.InOperation && outputs.Values == 1);
    fake_axes[0].info.online = false;
    fb.ValueSource = mcSetValue; /* the set-point is the axis's own */
    for (int n = 0; n < 100; n++)
        at(5.0, 0.0);
    ck_assert(fb.InOperation && outputs.Values == 1);
}
END_TEST

START_TEST(test_coordinates_that_are_shifted_pass_nothing)
{
    fresh(0.0);
    MC_CAMSWITCH *cam = add(1, 500.0, 0.0);
    cam->CamSwitchMode = 1;
    cam->Duration = 100 * MS;
    add(2, 500.0, 501.0);
    add(3, 1000.0, 2000.0);
    at(0.0, 0.0);
    at(1500.0, 0.0);
    ck_assert_uint_eq(outputs.Values, 4); /* where it is now, and nothing of the way there */
    at(0.0, 0.0);
    ck_assert_uint_eq(outputs.Values, 0);
}
END_TEST

START_TEST(test_the_axis_is_latched)
{
    AXIS_REF_t other = {2}, nothing = {0};
    fresh(0.0);
    add(1, -1.0, 1.0);
    at(0.0, 0.0);
    fb.Axis = &other;
    at(0.0, 0.0);
    expect_error(CM1E_ERROR_FB_AXIS_CHANGED);
    ck_assert(!fb.Busy);
    fb.Enable = FALSE;
    call();
    fb.Enable = TRUE;
    fb.Axis = &nothing;
    call();
    expect_error(CM1E_ERROR_FB_AXIS_REF);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("MC_DigitalCamSwitch, outputs");
    TCase *tcase = tcase_create("outputs");
    tcase_add_test(tcase, test_the_mask_takes_tracks_away_and_gives_them_back_at_once);
    tcase_add_test(tcase, test_another_axis_of_the_output_loses_only_what_was_written_to_it);
    tcase_add_test(tcase, test_enable_that_falls_switches_everything_off_and_forgets);
    tcase_add_test(tcase, test_the_output_of_track_1_is_lent_for_a_while_only);
    tcase_add_test(tcase, test_an_output_that_cannot_be_written_is_an_error_that_passes);
    tcase_add_test(tcase, test_switches_and_tracks_that_cannot_be);
    tcase_add_test(tcase, test_a_position_that_is_unknown_for_long_switches_off);
    tcase_add_test(tcase, test_coordinates_that_are_shifted_pass_nothing);
    tcase_add_test(tcase, test_the_axis_is_latched);
    suite_add_tcase(suite, tcase);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed != 0;
}
