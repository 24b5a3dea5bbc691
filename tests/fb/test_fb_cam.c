/* MC_DigitalCamSwitch on an axis that is where the test says (PLCopen Part 1 v2.0, 3.32 with figures 37 to 39): when
 * its tracks are on. Enable, outputs and errors: test_fb_cam_outputs. */
#include <stdio.h>
#include <stdlib.h>

#include "cam_bench.h"

/* ---- positions, directions, times -------------------------------------------------------------------------------- */

/* On a modulo axis a switch may be stated beyond the range on either side. */
START_TEST(test_a_switch_over_the_end_of_a_turn_may_be_stated_in_any_turn)
{
    static const double ends[][2] = {{-10.0, 10.0}, {350.0, 370.0}, {350.0, 10.0}, {710.0, 730.0}};
    for (int i = 0; i < 8; i++) {
        const double degree = i < 4 ? 1.0 : 1.0 / 512.0; /* exact; a turn is less than 1 u then */
        const double *const of = ends[i % 4];
        fresh(360.0 * degree);
        add(1, of[0] * degree, of[1] * degree);
        for (int place = 0; place < 360; place++) {
            at(place * degree, 0.0);
            ck_assert_msg(fb.InOperation && outputs.Values == (place <= 10 || place >= 350), "%g ... %g at %d", of[0],
                          of[1], place);
        }
    }
}
END_TEST

/* The standard's own example: a modulo axis of 5000 u, tracks 1 and 2. */
START_TEST(test_the_example_of_the_standard_in_both_directions)
{
    for (int source = 0; source < 2; source++)
        for (int sign = 1; sign >= -1; sign -= 2) {
            fresh(5000.0);
            fb.ValueSource = source ? mcActualValue : mcSetValue;
            add(1, 2000.0, 3000.0)->AxisDirection = 1;
            add(1, 2500.0, 3000.0)->AxisDirection = 2;
            add(1, 4000.0, 1000.0);
            MC_CAMSWITCH *timed = add(2, 3000.0, 0.0);
            timed->CamSwitchMode = 1;
            timed->Duration = 1350 * MS;
            position = 1200.25;
            velocity = sign * 1000.0;
            TIME crossed = -2000 * MS;
            for (int n = 0; n < 30000; n++) {
                const double before = position - floor(position / 5000.0) * 5000.0;
                const DWORD values = step();
                const double p = position - floor(position / 5000.0) * 5000.0;
                if (n > 0 && (sign > 0 ? before < 3000.0 && p >= 3000.0 : before > 3000.0 && p <= 3000.0))
                    crossed = now_ns;
                const bool own = sign > 0 ? p >= 2000.0 && p <= 3000.0 : p >= 2500.0 && p <= 3000.0;
                const bool one = (n > 30 && own) || p >= 4000.0 || p <= 1000.0, two = now_ns - crossed < 1350 * MS;
                if (values != (DWORD)(one | two << 1))
                    ck_abort_msg("source %d, sign %d, at %g: %X, not %d %d", source, sign, p, values, one, two);
            }
        }
}
END_TEST

START_TEST(test_ends_are_included_and_a_standing_axis_is_judged_at_once)
{
    fresh(0.0);
    add(3, -10.0, 10.0);
    static const double inside[] = {-10.0, 10.0, 0.0}, outside[] = {-10.001, 10.001, 1e6, -1e6};
    for (int i = 0; i < 7; i++) {
        fb.Enable = FALSE;
        call();
        ck_assert(!fb.InOperation && !fb.Busy);
        fb.Enable = TRUE;
        at(i < 3 ? inside[i] : outside[i - 3], 0.0);
        ck_assert(fb.InOperation && fb.Busy);
        ck_assert_uint_eq(outputs.Values, i < 3 ? 4 : 0);
    }
}
END_TEST

START_TEST(test_a_switch_of_one_direction_needs_a_motion_in_it)
{
    fresh(0.0);
    add(1, -100.0, 100.0)->AxisDirection = 1;
    add(2, -100.0, 100.0)->AxisDirection = 2;
    at(0.0, 0.0);
    ck_assert_uint_eq(outputs.Values, 0); /* nobody knows */
    at(1.0, 10.0);
    ck_assert_uint_eq(outputs.Values, 1);
    at(1.0, 0.0);
    ck_assert_uint_eq(outputs.Values, 1); /* stands: as it came */
    at(0.5, -10.0);
    ck_assert_uint_eq(outputs.Values, 2);
    fb.ValueSource = mcActualValue; /* a motor that trembles has not turned round */
    for (int i = 0; i < 100; i++) {
        at(0.5 + (i % 2 ? 0.004 : 0.0), i % 2 ? 4.0 : -4.0);
        ck_assert_uint_eq(outputs.Values, 2);
    }
    at(0.6, 4.0);
    ck_assert_uint_eq(outputs.Values, 1);
}
END_TEST

START_TEST(test_what_is_shorter_than_the_way_of_a_call_is_on_for_one)
{
    fresh(0.0);
    add(1, 5.2, 5.4);
    add(2, 5.3, 5.3);
    MC_CAMSWITCH *timed = add(3, 5.3, 0.0);
    timed->CamSwitchMode = 1;
    timed->Duration = 3 * MS;
    for (int sign = 1; sign >= -1; sign -= 2) {
        velocity = sign * 1000.0;
        for (int n = 0; n < 12; n++) {
            const DWORD values = step();
            const double p = position, passed = sign > 0 ? 6.0 : 5.0;
            ck_assert_msg((values & 3) == (p == passed ? 3u : 0u), "at %g: %X", p, values);
            const double since = (p - passed) * sign;
            ck_assert_msg(!!(values & 4) == (since >= 0.0 && since < 3.0), "at %g: %X", p, values);
        }
    }
}
END_TEST

/* ---- compensation ------------------------------------------------------------------------------------------------ */

/* Figure 38 with every sign, at constant velocity: a line of both ends in time. */
START_TEST(test_compensations_move_the_ends_in_time)
{
    static const TIME shifts[] = {-125 * MS, -40 * MS, 0, 40 * MS, 250 * MS};
    for (int on = 0; on < 5; on++)
        for (int off = 0; off < 5; off++)
            for (int speed = -2; speed <= 2; speed++) {
                if (speed == 0)
                    continue;
                fresh(0.0);
                add(1, 2000.0, 3000.0);
                tracks.Tracks[0] = (MC_TRACK){.OnCompensation = shifts[on], .OffCompensation = shifts[off]};
                velocity = speed * 1000.0;
                position = speed > 0 ? 1000.5 : 4000.5;
                const TIME start = now_ns, way = 1000 * MS / abs(speed);
                const TIME first = start + way + shifts[on], last = start + 2 * way + shifts[off];
                int wrong = 0, count = 0;
                for (int n = 0; n < 4000; n++) {
                    const bool is = step() & 1, should = now_ns >= first && now_ns < last;
                    wrong += is != should;
                    count += is;
                }
                ck_assert_msg(wrong <= 4, "on %d off %d ms, %d u/s: %d ms wrong", (int)(shifts[on] / MS),
                              (int)(shifts[off] / MS), speed * 1000, wrong);
                ck_assert_int_gt(count, 100);
            }
}
END_TEST

START_TEST(test_a_delay_goes_on_when_the_axis_stops)
{
    fresh(0.0);
    add(1, 10.0, 20.0);
    tracks.Tracks[0] = (MC_TRACK){.OnCompensation = 100 * MS, .OffCompensation = 250 * MS};
    at(9.0, 1000.0);
    for (int n = 0; n < 3; n++)
        step();
    velocity = 0.0; /* at 12 */
    for (int n = 0; n < 400; n++)
        ck_assert_uint_eq(step(), n >= 97); /* since 10 was reached */
    velocity = 1000.0;
    for (int n = 0; n < 9; n++)
        step();
    velocity = 0.0; /* at 21 */
    for (int n = 0; n < 400; n++)
        ck_assert_uint_eq(step(), n < 249);
}
END_TEST

START_TEST(test_what_was_switched_ahead_is_right_when_the_axis_stops_before)
{
    fresh(0.0);
    add(1, 100.0, 200.0);
    tracks.Tracks[0] = (MC_TRACK){.OnCompensation = -50 * MS, .OffCompensation = -50 * MS};
    at(0.0, 1000.0);
    for (int n = 0; n < 60; n++)
        step();
    ck_assert_uint_eq(outputs.Values, 1); /* at 60, 40 ms before */
    velocity = 0.0;
    ck_assert_uint_eq(step(), 0);
    velocity = 1000.0;
    for (int n = 0; n < 100; n++)
        step();
    ck_assert_uint_eq(outputs.Values, 0); /* at 160, 40 ms before the end */
    velocity = 0.0;
    ck_assert_uint_eq(step(), 1);
}
END_TEST

START_TEST(test_a_time_switch_can_be_ahead_and_late)
{
    for (int i = 0; i < 2; i++) {
        fresh(0.0);
        MC_CAMSWITCH *cam = add(1, 1000.0, 0.0);
        cam->CamSwitchMode = 1;
        cam->Duration = 300 * MS;
        tracks.Tracks[0] = (MC_TRACK){.OnCompensation = i ? 100 * MS : -100 * MS, .OffCompensation = 77 * MS};
        velocity = 1000.0;
        position = 0.5;
        const TIME first = now_ns + 1000 * MS + tracks.Tracks[0].OnCompensation;
        int wrong = 0;
        for (int n = 0; n < 2000; n++) {
            const bool should = step() & 1;
            wrong += should != (now_ns >= first && now_ns < first + 300 * MS);
        }
        ck_assert_int_le(wrong, 3);
    }
}
END_TEST

START_TEST(test_a_duration_without_end_has_none)
{
    fresh(0.0);
    MC_CAMSWITCH *cam = add(1, 10.0, 0.0);
    cam->CamSwitchMode = 1;
    cam->Duration = INT64_MAX;
    at(9.0, 1000.0);
    for (int n = 0; n < 1000; n++)
        ck_assert_uint_eq(step(), 1);
    cam->Duration = 0; /* from the next passing on: nothing */
    at(10.5, -1000.0);
    at(9.5, -1000.0);
    ck_assert_uint_eq(outputs.Values, 0);
}
END_TEST

/* ---- hysteresis -------------------------------------------------------------------------------------------------- */

START_TEST(test_hysteresis_switches_once_until_it_is_left)
{
    fresh(0.0);
    add(1, 10.0, 20.0);
    tracks.Tracks[0].Hysteresis = 0.5;
    at(9.0, 10.0);
    at(10.1, 10.0);
    ck_assert_uint_eq(outputs.Values, 1); /* at once */
    for (int i = 0; i < 100; i++) {
        at(10.0 + 0.4 * sin(i), 4.0);
        ck_assert_uint_eq(outputs.Values, 1);
    }
    at(9.6, -10.0);
    ck_assert_uint_eq(outputs.Values, 1);
    at(9.4, -10.0); /* left, on the wrong side */
    ck_assert_uint_eq(outputs.Values, 0);
    at(10.2, 10.0); /* 9.4 was outside of the area: a new one begins at the point itself */
    ck_assert_uint_eq(outputs.Values, 0);
    at(10.6, 10.0);
    ck_assert_uint_eq(outputs.Values, 1);
    at(20.3, 10.0); /* the other end has an area of its own */
    ck_assert_uint_eq(outputs.Values, 0);
    at(19.8, -10.0);
    ck_assert_uint_eq(outputs.Values, 0);
    at(19.4, -10.0);
    ck_assert_uint_eq(outputs.Values, 1);
}
END_TEST

/* ---- any motion -------------------------------------------------------------------------------------------------- */

/** What a switch would have passed before it was there, or while it was not, it has not passed. */
START_TEST(test_a_switch_that_is_added_has_passed_nothing)
{
    for (int away = 0; away < 2; away++) {
        fresh(0.0);
        add(1, 100.0, 101.0);
        add(2, 5.0, 5.5);
        MC_CAMSWITCH *by_time = add(3, 5.0, 0.0);
        by_time->CamSwitchMode = 1;
        by_time->Duration = 500 * MS;
        cams.NumberOfSwitches = away ? 3 : 1;
        at(1.0, 0.0);
        cams.NumberOfSwitches = 1;
        for (int n = 2; n <= 8; n++)
            at(n, 1000.0);
        cams.NumberOfSwitches = 3;
        at(8.0, 0.0);
        ck_assert_uint_eq(outputs.Values, 0);
        at(6.0, -1000.0);
        ck_assert_uint_eq(outputs.Values, 0);
        at(4.0, -2000.0);
        ck_assert_uint_eq(outputs.Values, 6); /* now it has passed them */
    }
}
END_TEST

START_TEST(test_random_motion_over_random_switches)
{
    const char *given = getenv("CM1E_TEST_SEED");
    const unsigned seed = given ? (unsigned)strtoul(given, NULL, 10) : 332u;
    printf("seed %u\n", seed);
    srand(seed);
    for (int run = 0; run < 40; run++) {
        fresh(run % 2 ? 360.0 : 0.0);
        TIME until[32] = {0};
        for (int i = 0; i < 32; i++) {
            const double a = rand() % 3600 / 10.0, b = rand() % 3600 / 10.0;
            MC_CAMSWITCH *cam = run % 2 ? add(i + 1, a, b) : add(i + 1, fmin(a, b), fmax(a, b) + 2.0);
            cam->CamSwitchMode = rand() % 3 == 0;
            cam->Duration = rand() % 200 * MS;
        }
        at(180.0, 0.0);
        for (int n = 0; n < 5000; n++) {
            velocity += (rand() % 201 - 100) * 2.0 - 0.2 * (position - 180.0);
            velocity = fmax(-1500.0, fmin(velocity, 1500.0));
            const double before = position;
            const DWORD values = step();
            for (int i = 0; i < 32; i++) {
                const MC_CAMSWITCH *cam = &cams.Switches[i];
                const double range = measures.modulo_range, first = cam->FirstOnPosition;
                /* the nearest repetition of the switching point that may have been passed */
                const double place = range > 0.0 ? first + range * round((position - first) / range) : first;
                const double p = range > 0.0 ? position - floor(position / range) * range : position;
                const double edge = fmin(fabs(p - first), fabs(p - cam->LastOnPosition));
                if ((before < place && place <= position) || (before > place && place >= position))
                    until[i] = now_ns + cam->Duration;
                const bool over = first > cam->LastOnPosition;
                const bool in = over ? p >= first || p <= cam->LastOnPosition
                                     : p >= first && p <= cam->LastOnPosition;
                const bool should = cam->CamSwitchMode ? now_ns < until[i] : in;
                const bool narrow = fabs(cam->LastOnPosition - first) < 2.0; /* on for a call when it is passed */
                if (!!(values >> i & 1) != should && edge > 2e-5 && !(narrow && !cam->CamSwitchMode))
                    ck_abort_msg("seed %u, run %d, call %d, switch %d (%g ... %g, mode %d), %g to %g: %d", seed, run, n,
                                 i, first, cam->LastOnPosition, cam->CamSwitchMode, before, position, should);
            }
        }
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("MC_DigitalCamSwitch");
    TCase *tcase = tcase_create("cams");
    tcase_add_test(tcase, test_a_switch_over_the_end_of_a_turn_may_be_stated_in_any_turn);
    tcase_add_test(tcase, test_the_example_of_the_standard_in_both_directions);
    tcase_add_test(tcase, test_ends_are_included_and_a_standing_axis_is_judged_at_once);
    tcase_add_test(tcase, test_a_switch_of_one_direction_needs_a_motion_in_it);
    tcase_add_test(tcase, test_what_is_shorter_than_the_way_of_a_call_is_on_for_one);
    tcase_add_test(tcase, test_compensations_move_the_ends_in_time);
    tcase_add_test(tcase, test_a_delay_goes_on_when_the_axis_stops);
    tcase_add_test(tcase, test_what_was_switched_ahead_is_right_when_the_axis_stops_before);
    tcase_add_test(tcase, test_a_time_switch_can_be_ahead_and_late);
    tcase_add_test(tcase, test_a_duration_without_end_has_none);
    tcase_add_test(tcase, test_hysteresis_switches_once_until_it_is_left);
    tcase_add_test(tcase, test_a_switch_that_is_added_has_passed_nothing);
    tcase_add_test(tcase, test_random_motion_over_random_switches);
    suite_add_tcase(suite, tcase);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed != 0;
}
