/* MC_Jog on the simulated segment: buttons, limits, steps, and a block that is no longer called. */
#include "../support/axis_segment.h"

static MC_Jog_t jog;
static AXIS_REF_t reference;
static BOOL forward, backwards;
static bool called = true;
static struct {
    int done, aborted, error;
} seen;

/* One scan; what 2.4.1 says of the outputs is checked in every one. */
static void scan(void)
{
    inputs();
    if (called) {
        const MC_Jog_t before = jog;
        jog.JogForward = forward;
        jog.JogBackwards = backwards;
        MC_Jog(&jog);
        const int results = jog.Done + jog.CommandAborted + jog.Error;
        if (jog.Busy + results > 1 || jog.Error != (jog.ErrorID != 0) || (jog.Active && !jog.Busy) ||
            (before.Busy && !jog.Busy && !results))
            ck_abort_msg("D%d B%d A%d C%d E%d", jog.Done, jog.Busy, jog.Active, jog.CommandAborted, jog.Error);
        seen.done += jog.Done;
        seen.aborted += jog.CommandAborted;
        seen.error += jog.Error;
    }
    outputs();
}

static void scans(int n)
{
    while (n-- > 0)
        scan();
}

static void press(BOOL f, BOOL b)
{
    forward = f;
    backwards = b;
}

static void begin(double lower, double upper)
{
    describe("1.3.5", CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, 1000000);
    config.axes[0].software_limit_negative = lower;
    config.axes[0].software_limit_positive = upper;
    config.axes[0].max_velocity = 40.0;
    config.axes[0].max_acceleration = 400.0;
    config.axes[0].sim.no_stops = config.axes[0].sim.no_sensors = true;
    open_segment();
    reference = cm1e_axis_reference(axis);
    jog = (MC_Jog_t){.Axis = &reference, .Velocity = 12.0, .Acceleration = 200.0, .Deceleration = 100.0,
                     .Position = 1.5};
    press(FALSE, FALSE);
    called = true;
    memset(&seen, 0, sizeof seen);
    scan();
    ck_assert(!jog.Busy && !jog.Done && !jog.Error);
    enable();
}

static double speed(void) { return info().set_velocity; }
static double at(void) { return info().set_position; }

static void expect_standing(void)
{
    ck_assert_msg(info().state == CM1E_AXIS_STANDSTILL, "%s", cm1e_axis_state_name(info().state));
    ck_assert_double_eq(speed(), 0.0);
}

/* ---- holding ----------------------------------------------------------------------------------------------------- */

START_TEST(test_each_mode_of_holding_has_its_velocity_and_ends_with_its_button)
{
    static const struct {
        E_JogMode mode;
        double velocity;
    } modes[] = {{MC_JOGMODE_STANDARD_SLOW, 2.0}, {MC_JOGMODE_STANDARD_FAST, 10.0}, {MC_JOGMODE_CONTINOUS, 12.0}};
    begin(0, 0);
    for (int i = 0; i < 6; i++) {
        const double sign = i % 2 ? -1.0 : 1.0;
        jog.Mode = modes[i / 2].mode;
        memset(&seen, 0, sizeof seen);
        press(sign > 0, sign < 0);
        scans(1000);
        ck_assert(jog.Busy && jog.Active);
        ck_assert_double_eq_tol(speed(), sign * modes[i / 2].velocity, 1e-9);
        ck_assert_int_eq(info().state, CM1E_AXIS_CONTINUOUS_MOTION);
        press(FALSE, FALSE);
        scan();
        ck_assert(jog.Busy);
        scans(1000);
        expect_standing();
        ck_assert_int_eq(seen.done, 1); /* for one call */
        ck_assert(seen.aborted == 0 && seen.error == 0);
    }
    close_segment();
}
END_TEST

START_TEST(test_the_modes_of_the_axis_take_its_configured_velocities)
{
    begin(0, 0);
    close_segment();
    config.axes[0].jog_slow = 0.5;
    config.axes[0].jog_fast = 33.0;
    open_segment();
    reference = cm1e_axis_reference(axis);
    enable();
    press(TRUE, FALSE);
    scans(500);
    ck_assert_double_eq_tol(speed(), 0.5, 1e-9);
    press(FALSE, FALSE);
    scans(500);
    jog.Mode = MC_JOGMODE_STANDARD_FAST;
    press(TRUE, FALSE);
    scans(1000);
    ck_assert_double_eq_tol(speed(), 33.0, 1e-9);
    close_segment();
}
END_TEST

START_TEST(test_releasing_brakes_with_the_deceleration_of_the_edge)
{
    begin(0, 0);
    jog.Mode = MC_JOGMODE_CONTINOUS;
    press(TRUE, FALSE);
    scans(1000);
    jog.Deceleration = 400.0; /* too late */
    press(FALSE, FALSE);
    int n = 0;
    do {
        scan();
        ck_assert_double_ge(info().set_acceleration, -100.0 * (1 + 1e-9));
    } while (jog.Busy && n++ < 2000);
    ck_assert_int_gt(n, 120); /* 12 u/s at 100 u/s2 */
    ck_assert_int_lt(n, 250);
    close_segment();
}
END_TEST

START_TEST(test_both_buttons_stop_and_one_of_them_alone_does_not_start_again)
{
    begin(0, 0);
    for (int i = 0; i < 2; i++) {
        press(!i, i);
        scans(300);
        ck_assert(jog.Busy);
        press(TRUE, TRUE);
        scans(1000);
        expect_standing();
        ck_assert(jog.Done && !jog.Busy); /* as long as a button is pressed */
        press(i, !i);
        scans(300);
        expect_standing();
        press(FALSE, FALSE);
        scan();
        ck_assert(!jog.Done);
        press(TRUE, TRUE); /* at once */
        scans(300);
        expect_standing();
        ck_assert(!jog.Busy && !jog.Done && !jog.Error);
        press(FALSE, FALSE);
        scan();
    }
    close_segment();
}
END_TEST

START_TEST(test_changing_over_between_two_calls_reverses)
{
    begin(0, 0);
    press(TRUE, FALSE);
    scans(500);
    press(FALSE, TRUE);
    scans(500);
    ck_assert(jog.Busy && jog.Active);
    ck_assert_double_eq_tol(speed(), -2.0, 1e-9);
    press(FALSE, FALSE);
    scans(5);
    press(TRUE, FALSE); /* while it still brakes */
    scans(500);
    ck_assert_double_eq_tol(speed(), 2.0, 1e-9);
    press(FALSE, FALSE);
    scans(500);
    expect_standing();
    ck_assert(seen.done == 1 && seen.aborted == 0 && seen.error == 0);
    close_segment();
}
END_TEST

START_TEST(test_the_software_limit_ends_a_jog_without_an_error)
{
    begin(-1.5, 2.0);
    jog.Mode = MC_JOGMODE_CONTINOUS;
    for (int i = 0; i < 2; i++) {
        press(!i, i);
        scans(3000);
        ck_assert(jog.Busy && !jog.Active);
        expect_standing();
        ck_assert_double_eq_tol(at(), i ? -1.5 : 2.0, 1e-9);
        press(FALSE, FALSE);
        scan();
        ck_assert(jog.Done && !jog.Error);
        scan();
        press(!i, i); /* once more, where there is no way left */
        scans(300);
        ck_assert(jog.Busy && !jog.Active);
        ck_assert_double_eq_tol(at(), i ? -1.5 : 2.0, 1e-9);
        press(TRUE, TRUE);
        scan();
        ck_assert(jog.Done);
        press(FALSE, FALSE);
        scan();
    }
    ck_assert_int_eq(seen.error + seen.aborted, 0);
    close_segment();
}
END_TEST

/* 0: the axis fails; 1: another command moves it away; 2: its power is taken. */
START_TEST(test_a_jog_that_waits_at_its_limit_ends_with_the_axis)
{
    begin(-1.5, 2.0);
    jog.Mode = MC_JOGMODE_CONTINOUS;
    press(TRUE, FALSE);
    scans(3000);
    ck_assert(jog.Busy && !jog.Active);
    expect_standing();
    if (_i == 0)
        simulate("error 1 2310");
    else if (_i == 1)
        command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .velocity = 3.0});
    else
        power(false);
    scans(300);
    ck_assert(!jog.Busy);
    ck_assert_int_eq(jog.Error, _i == 0);
    ck_assert_int_eq(jog.CommandAborted, _i != 0);
    ck_assert(_i != 0 || jog.ErrorID == cm1e_error_id(CM1E_ERROR_AXIS_ERROR_STOP));
    close_segment();
}
END_TEST

START_TEST(test_a_limit_on_one_side_leaves_the_other_open)
{
    begin(-INFINITY, 1.0);
    press(FALSE, TRUE);
    scans(1000);
    ck_assert_int_eq(info().state, CM1E_AXIS_CONTINUOUS_MOTION);
    press(TRUE, FALSE);
    scans(5000);
    ck_assert_double_eq_tol(at(), 1.0, 1e-9);
    expect_standing();
    close_segment();
}
END_TEST

/* ---- inching ----------------------------------------------------------------------------------------------------- */

START_TEST(test_inching_is_one_step_whatever_becomes_of_the_button)
{
    begin(-4.0, 4.0);
    jog.Mode = MC_JOGMODE_INCHING;
    const double from = at();
    press(TRUE, FALSE);
    scan();
    press(FALSE, FALSE);
    scans(1000);
    expect_standing();
    ck_assert_double_eq_tol(at(), from + 1.5, 1e-9);
    ck_assert_int_eq(seen.done, 1);
    press(FALSE, TRUE);
    scans(2000);
    ck_assert(jog.Done); /* as long as the button is pressed; no second step */
    ck_assert_double_eq_tol(at(), from, 1e-9);
    press(FALSE, FALSE);
    scan();
    for (int i = 0; i < 5; i++) { /* up to the limit */
        press(TRUE, FALSE);
        scans(1000);
        press(FALSE, FALSE);
        scans(2);
    }
    ck_assert_double_eq_tol(at(), 4.0, 1e-9);
    press(FALSE, TRUE);
    scans(20);
    press(TRUE, TRUE);
    scans(1000);
    expect_standing();
    ck_assert_double_gt(at(), 2.6); /* both stop a step too */
    ck_assert_int_eq(seen.error + seen.aborted, 0);
    close_segment();
}
END_TEST

START_TEST(test_inching_modulo_goes_to_multiples_of_the_step)
{
    begin(0, 0);
    jog.Mode = MC_JOGMODE_INCHING_MODULO;
    move_to(2.0, 10.0);
    static const struct {
        BOOL ahead;
        double to;
    } steps[] = {{TRUE, 3.0}, {TRUE, 4.5}, {FALSE, 3.0}, {FALSE, 1.5}, {FALSE, 0.0}, {FALSE, -1.5}, {TRUE, 0.0}};
    for (size_t i = 0; i < sizeof steps / sizeof steps[0]; i++) {
        press(steps[i].ahead, !steps[i].ahead);
        scans(1000);
        ck_assert(jog.Done);
        ck_assert_double_eq_tol(at(), steps[i].to, 1e-9);
        press(FALSE, FALSE);
        scan();
    }
    close_segment();
}
END_TEST

START_TEST(test_a_step_that_numbers_cannot_tell_from_none_moves_nothing)
{
    static const double tiny[] = {5e-324, 1e-300, 1e-20, 1e-12};
    begin(0, 0);
    move_to(3.0, 10.0);
    for (int i = 0; i < 16; i++) {
        jog.Mode = i & 1 ? MC_JOGMODE_INCHING_MODULO : MC_JOGMODE_INCHING;
        jog.Position = tiny[i / 4];
        press(i & 2, !(i & 2));
        scans(300);
        ck_assert(jog.Done || jog.ErrorID == cm1e_error_id(CM1E_ERROR_AXIS_POSITION_RANGE));
        expect_standing();
        ck_assert_double_eq_tol(at(), 3.0, 1e-9);
        press(FALSE, FALSE);
        scan();
    }
    close_segment();
}
END_TEST

/* A table of 360 u: over its end and back, by steps and by holding. */
START_TEST(test_a_modulo_axis_is_jogged_over_its_end)
{
    begin(0, 0);
    close_segment();
    config.axes[0].units_per_revolution = config.axes[0].modulo_range = 360.0;
    config.axes[0].max_velocity = 3600.0;
    config.axes[0].max_acceleration = 36000.0;
    open_segment();
    reference = cm1e_axis_reference(axis);
    enable();
    jog.Mode = MC_JOGMODE_INCHING_MODULO;
    jog.Velocity = 900.0;
    jog.Acceleration = jog.Deceleration = 0.0;
    jog.Position = 90.0;
    const double from = at();
    static const double ahead[] = {90.0, 180.0, 270.0, 0.0, 90.0}, back[] = {0.0, 270.0, 180.0};
    for (int i = 0; i < 8; i++) {
        press(i < 5, i >= 5);
        scans(800);
        ck_assert(jog.Done);
        const double to = i < 5 ? ahead[i] : back[i - 5];
        ck_assert_msg(fabs(remainder(at() - to, 360.0)) < 1e-6, "step %d from %g: at %g, not %g", i, from, at(), to);
        press(FALSE, FALSE);
        scan();
    }
    jog.Mode = MC_JOGMODE_INCHING; /* two turns and a bit */
    jog.Position = 730.0;
    press(TRUE, FALSE);
    scans(3000);
    ck_assert(jog.Done);
    ck_assert_double_eq_tol(at(), 190.0, 1e-6);
    press(FALSE, FALSE);
    scan();
    jog.Mode = MC_JOGMODE_STANDARD_FAST; /* a quarter of 3600 */
    press(FALSE, TRUE);
    scans(2000);
    ck_assert_double_eq_tol(speed(), -900.0, 1e-6);
    ck_assert(at() >= 0.0 && at() < 360.0);
    close_segment();
}
END_TEST

/* ---- what else may happen ---------------------------------------------------------------------------------------- */

START_TEST(test_another_command_takes_over_and_the_button_no_longer_counts)
{
    begin(0, 0);
    press(TRUE, FALSE);
    scans(300);
    const cm1e_command_id_t other = command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = 9.0,
                                                                   .velocity = 3.0});
    scan();
    ck_assert(jog.CommandAborted && !jog.Busy);
    scans(100);
    ck_assert(jog.CommandAborted);
    press(FALSE, FALSE);
    scan();
    ck_assert(!jog.CommandAborted);
    while (cm1e_axis_command_status(axis, other).state == CM1E_COMMAND_ACTIVE)
        scan();
    ck_assert_double_eq_tol(at(), 9.0, 1e-9);
    ck_assert_int_eq(cm1e_axis_command_status(axis, other).state, CM1E_COMMAND_DONE);
    close_segment();
}
END_TEST

START_TEST(test_a_block_that_is_no_longer_called_stops_its_axis)
{
    static const int every[] = {1, 10, 50, 100, 200}; /* ms, interval of the task */
    for (int i = 0; i < 5; i++) {
        begin(0, 0);
        jog.Mode = MC_JOGMODE_STANDARD_FAST;
        press(TRUE, FALSE);
        for (int n = 0; n < 3000; n++) {
            called = n % every[i] == 0;
            scan();
        }
        ck_assert_double_eq_tol(speed(), 10.0, 1e-9);
        called = false;
        const int longest = every[i] < 25 ? 100 : 4 * every[i];
        int n = 0;
        while (speed() == 10.0 && n++ < 5000)
            scan();
        ck_assert_msg(n >= longest - every[i] && n <= longest + 1, "%d of %d ms", n, longest);
        scans(500);
        expect_standing();
        called = true; /* it comes back with its button pressed */
        scans(500);
        expect_standing();
        ck_assert(jog.CommandAborted);
        press(FALSE, FALSE);
        scan();
        press(TRUE, FALSE);
        scans(500);
        ck_assert_double_eq_tol(speed(), 10.0, 1e-9);
        close_segment();
    }
}
END_TEST

START_TEST(test_a_step_ends_also_when_the_block_is_not_called)
{
    begin(0, 0);
    jog.Mode = MC_JOGMODE_INCHING;
    jog.Velocity = 0.5; /* 3 s */
    const double from = at();
    press(TRUE, FALSE);
    scan();
    called = false;
    scans(4000);
    expect_standing();
    ck_assert_double_eq_tol(at(), from + 1.5, 1e-9);
    called = true;
    scan();
    ck_assert(jog.Done);
    close_segment();
}
END_TEST

static void expect_refused(cm1e_error_t error, const char *told)
{
    const double from = at();
    press(TRUE, FALSE);
    scan();
    ck_assert_msg(jog.Error && jog.ErrorID == cm1e_error_id(error), "0x%04X, not 0x%04X", jog.ErrorID,
                  cm1e_error_id(error));
    ck_assert_msg(strstr(text(), told) != NULL, "%s", text());
    scans(50);
    ck_assert(jog.Error);
    ck_assert_double_eq(at(), from);
    press(FALSE, FALSE);
    scan();
    ck_assert(!jog.Error);
}

START_TEST(test_what_cannot_be_is_refused_and_moves_nothing)
{
    static const double no_velocity[] = {0.0, -1.0, 40.1, NAN, INFINITY}, no_step[] = {0.0, -1.0, NAN, INFINITY};
    AXIS_REF_t nothing = {0};
    begin(0, 0);
    jog.Mode = MC_JOGMODE_CONTINOUS;
    for (int i = 0; i < 5; i++) {
        jog.Velocity = no_velocity[i];
        expect_refused(CM1E_ERROR_AXIS_VELOCITY_RANGE, "elocity");
    }
    jog.Velocity = 5.0;
    jog.Acceleration = -1.0;
    expect_refused(CM1E_ERROR_AXIS_DYNAMICS_RANGE, "acceleration -1");
    jog.Acceleration = 0.0;
    for (int i = 0; i < 4; i++) {
        jog.Mode = i % 2 ? MC_JOGMODE_INCHING : MC_JOGMODE_INCHING_MODULO;
        jog.Position = no_step[i];
        expect_refused(CM1E_ERROR_AXIS_POSITION_RANGE, "MC_Jog: Position is");
    }
    jog.Mode = MC_JOGMODE_INCHING;
    jog.Position = 1e300;
    expect_refused(CM1E_ERROR_AXIS_POSITION_RANGE, "1e+300");
    jog.Mode = (E_JogMode)7;
    expect_refused(CM1E_ERROR_INVALID_ARGUMENT, "MC_Jog: Mode is 7; 0 ... 4 is right");
    jog.Mode = (E_JogMode)-1;
    expect_refused(CM1E_ERROR_INVALID_ARGUMENT, "MC_Jog: Mode is -1");
    jog.Mode = MC_JOGMODE_STANDARD_SLOW;
    jog.Axis = &nothing;
    expect_refused(CM1E_ERROR_FB_AXIS_REF, ""); /* of no axis */
    jog.Axis = NULL;
    expect_refused(CM1E_ERROR_FB_AXIS_REF, ""); /* of no axis */
    jog.Axis = &reference;
    ck_assert_int_eq(cm1e_axis_power(axis, &owner, true, false, true), CM1E_OK);
    expect_refused(CM1E_ERROR_AXIS_DIRECTION_DISABLED, "direction");
    power(false);
    scans(100);
    expect_refused(CM1E_ERROR_AXIS_NOT_POWERED, "MC_Power");
    close_segment();
}
END_TEST

START_TEST(test_an_error_of_the_axis_shows_and_a_button_held_over_the_reset_does_nothing)
{
    begin(0, 0);
    press(TRUE, FALSE);
    scans(300);
    simulate("error 1 2310");
    scans(500);
    ck_assert(jog.Error && jog.ErrorID == cm1e_error_id(CM1E_ERROR_AXIS_ERROR_STOP));
    ck_assert_int_eq(info().state, CM1E_AXIS_ERROR_STOP);
    simulate("error 1 clear");
    ck_assert_int_eq(cm1e_axis_reset(axis), CM1E_OK);
    scans(1500);
    expect_standing();
    ck_assert(jog.Error);
    close_segment();
}
END_TEST

/* ---- any buttons ------------------------------------------------------------------------------------------------- */

START_TEST(test_random_buttons)
{
    const char *given = getenv("CM1E_TEST_SEED");
    const unsigned seed = given ? (unsigned)strtoul(given, NULL, 10) : 60309u;
    printf("seed %u\n", seed);
    srand(seed);
    begin(-3.0, 3.0);
    int idle = 0;
    double travel = 0.0;
    for (int n = 0; n < 60000; n++) {
        if (rand() % 60 == 0)
            press(rand() % 3 == 0, rand() % 3 == 0);
        if (rand() % 200 == 0 && !jog.Busy)
            jog.Mode = (E_JogMode)(rand() % 5);
        if (rand() % 500 == 0)
            called = rand() % 4 != 0;
        scan();
        const cm1e_axis_info_t now = info();
        travel += fabs(now.set_velocity) * 1e-3;
        if (now.set_position > 3.0 + 1e-9 || now.set_position < -3.0 - 1e-9 || now.state == CM1E_AXIS_ERROR_STOP)
            ck_abort_msg("seed %u, scan %d: at %g, %s", seed, n, now.set_position, text());
        const bool holding = jog.Mode <= MC_JOGMODE_CONTINOUS;
        const bool wanted = called && (forward != backwards) && holding;
        idle = wanted || !holding ? 0 : idle + 1;
        if (idle > 1500 && now.set_velocity != 0.0)
            ck_abort_msg("seed %u, scan %d: nobody wants this motion", seed, n);
    }
    ck_assert_double_gt(travel, 30.0);
    ck_assert_int_gt(seen.done, 100);
    ck_assert_int_eq(seen.error, 0);
    close_segment();
}
END_TEST

/* Random jogs with faults, resets and lost power: nothing moves without a button. */
START_TEST(test_random_buttons_and_faults)
{
    static const char *const faults[] = {"lose 1", "lose 2", "lose 30", "power 1 off", "error 1 2310", "error 1 7500",
                                         "corrupt 3", "delay 2 400"};
    const char *given = getenv("CM1E_TEST_SEED");
    const unsigned seed = given ? (unsigned)strtoul(given, NULL, 10) : 99171u;
    printf("seed %u\n", seed);
    srand(seed);
    begin(-3.0, 3.0);
    jog.Mode = MC_JOGMODE_STANDARD_FAST;
    int idle = 0, nothing = 0, stopped = 0, started = 0;
    for (int n = 0; n < 60000; n++) {
        if (rand() % 80 == 0)
            press(rand() % 2, rand() % 3 == 0);
        if (rand() % 1500 == 0)
            simulate(faults[rand() % 8]);
        if (rand() % 2000 == 0)
            power(rand() % 2);
        if (rand() % 700 == 0) {
            simulate("power 1 on");
            simulate("error 1 clear");
            power(true);
            cm1e_axis_reset(axis);
        }
        const bool busy_before = jog.Busy;
        scan();
        const cm1e_axis_info_t now = info();
        stopped += now.state == CM1E_AXIS_ERROR_STOP;
        started += jog.Busy && !busy_before;
        idle = jog.Busy ? 0 : idle + 1;
        if (idle > 500 && now.set_velocity != 0.0 && now.powered)
            ck_abort_msg("seed %u, scan %d: nobody wants this motion, %s", seed, n, cm1e_axis_state_name(now.state));
        nothing = jog.Busy && !forward && !backwards && now.state == CM1E_AXIS_STANDSTILL ? nothing + 1 : 0;
        if (nothing > 1) /* the call after shows that it has ended */
            ck_abort_msg("seed %u, scan %d: busy with nothing", seed, n);
    }
    ck_assert_int_gt(stopped, 1000);
    ck_assert_int_gt(started, 50);
    close_segment();
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("MC_Jog");
    TCase *tcase = tcase_create("jog");
    tcase_add_test(tcase, test_each_mode_of_holding_has_its_velocity_and_ends_with_its_button);
    tcase_add_test(tcase, test_the_modes_of_the_axis_take_its_configured_velocities);
    tcase_add_test(tcase, test_releasing_brakes_with_the_deceleration_of_the_edge);
    tcase_add_test(tcase, test_both_buttons_stop_and_one_of_them_alone_does_not_start_again);
    tcase_add_test(tcase, test_changing_over_between_two_calls_reverses);
    tcase_add_test(tcase, test_the_software_limit_ends_a_jog_without_an_error);
    tcase_add_loop_test(tcase, test_a_jog_that_waits_at_its_limit_ends_with_the_axis, 0, 3);
    tcase_add_test(tcase, test_a_limit_on_one_side_leaves_the_other_open);
    tcase_add_test(tcase, test_inching_is_one_step_whatever_becomes_of_the_button);
    tcase_add_test(tcase, test_inching_modulo_goes_to_multiples_of_the_step);
    tcase_add_test(tcase, test_a_step_that_numbers_cannot_tell_from_none_moves_nothing);
    tcase_add_test(tcase, test_a_modulo_axis_is_jogged_over_its_end);
    tcase_add_test(tcase, test_another_command_takes_over_and_the_button_no_longer_counts);
    tcase_add_test(tcase, test_a_block_that_is_no_longer_called_stops_its_axis);
    tcase_add_test(tcase, test_a_step_ends_also_when_the_block_is_not_called);
    tcase_add_test(tcase, test_what_cannot_be_is_refused_and_moves_nothing);
    tcase_add_test(tcase, test_an_error_of_the_axis_shows_and_a_button_held_over_the_reset_does_nothing);
    tcase_add_test(tcase, test_random_buttons);
    tcase_add_test(tcase, test_random_buttons_and_faults);
    suite_add_tcase(suite, tcase);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed != 0;
}
