/* An axis that follows a control (bindings/stream): enabling without a jump, faults and how they are acknowledged,
 * homing by the drive, and a control that falls silent. */
#include "stream_axis.h"

#include "../support/axis_segment.h"

static stream_axis_t stream;
static stream_axis_state_t state;
static stream_wish_t wish;
static struct {
    double velocity, acceleration; /**< the largest of the set-point since forget() */
    double position_before, velocity_before;
    int cycles;
} seen;
static const double tolerance = 0.05;

static void forget(void) { memset(&seen, 0, sizeof seen); }

static void watch(void)
{
    const double velocity = (state.set_position - seen.position_before) / 1e-3;
    if ((state.flags & STREAM_ENABLED) && seen.cycles > 2) {
        seen.velocity = fmax(seen.velocity, fabs(velocity));
        seen.acceleration = fmax(seen.acceleration, fabs(velocity - seen.velocity_before) / 1e-3);
    }
    seen.position_before = state.set_position;
    seen.velocity_before = velocity;
    seen.cycles = state.flags & STREAM_ENABLED ? seen.cycles + 1 : 0;
}

static void scan(void)
{
    inputs();
    stream_axis_step(&stream, &wish, &state);
    watch();
    outputs();
}

static void scans(int n)
{
    while (n-- > 0)
        scan();
}

static bool has(uint32_t flag) { return (state.flags & flag) != 0; }

static void begin(void)
{
    describe("1.3.5", CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, 1000000);
    config.axes[0].max_velocity = 40.0;
    config.axes[0].max_acceleration = 400.0;
    config.axes[0].homing = (cm1e_homing_config_t){.method = -2, .offset = 1.0, .velocity = 10.0, .acceleration = 100.0,
                                                   .torque = 30.0, .timeout_s = 20};
    open_segment();
    stream_axis_init(&stream, cm1e_axis_reference(axis), tolerance, 1e-3, 1);
    wish = (stream_wish_t){.alive = true, .rests = true, .position = info().actual_position};
    forget();
    scans(10);
}

static void begin_following(void)
{
    begin();
    wish.enable = true;
    scans(500);
    ck_assert_msg(has(STREAM_ENABLED), "%s", text());
    forget();
}

/* A motion of the control: up to 20 u/s, at 200 u/s2. */
static void begin_moving(void)
{
    begin_following();
    wish.rests = false;
    for (int n = 0; n < 200; n++) {
        wish.position += 20.0 * fmin((n + 1) / 100.0, 1.0) * 1e-3;
        scan();
    }
    ck_assert_double_eq_tol(info().set_velocity, 20.0, 1e-6);
}

static void ends_without_torque(stream_reason_t reason)
{
    scans(1000);
    ck_assert(has(STREAM_FAULT));
    ck_assert(!has(STREAM_ENABLED));
    ck_assert(!has(STREAM_POWERED));
    ck_assert_int_eq(stream.notice.reason, reason);
    ck_assert(seen.acceleration <= 400.0 * 1.001);
}

START_TEST(test_it_follows_the_control_and_stops_with_it)
{
    begin_moving();
    ck_assert_double_eq_tol(info().set_position, wish.position, 1e-6);
    wish.enable = false;
    scans(1000);
    ck_assert(!has(STREAM_POWERED) && !has(STREAM_FAULT));
    ck_assert(seen.velocity < 20.01 && seen.acceleration < 201.0);
    close_segment();
}
END_TEST

START_TEST(test_a_small_distance_is_made_up_without_a_step)
{
    static const double offsets[] = {0.049, -0.049, 0.0};
    for (size_t i = 0; i < 3; i++) {
        begin();
        wish.position += offsets[i];
        wish.enable = true;
        scans(1000);
        ck_assert(has(STREAM_ENABLED));
        ck_assert_double_eq_tol(state.set_position, wish.position, 1e-9);
        ck_assert(seen.velocity < 0.2 && seen.acceleration < 1.5);
        close_segment();
    }
}
END_TEST

START_TEST(test_a_control_that_is_elsewhere_gets_no_axis)
{
    static const double offsets[] = {0.051, -0.051, 5.0, NAN, INFINITY};
    for (size_t i = 0; i < sizeof offsets / sizeof offsets[0]; i++) {
        char words[2000];
        begin();
        const double at = info().actual_position;
        wish.position += offsets[i];
        wish.enable = true;
        ends_without_torque(STREAM_AWAY);
        ck_assert_double_eq_tol(info().actual_position, at, 0.01);
        stream_notice_text(&stream.notice, "x", words, sizeof words);
        ck_assert_ptr_nonnull(strstr(words, "It would jump"));
        wish.position = info().actual_position; /* nothing happens until it is acknowledged */
        scans(500);
        ck_assert(!has(STREAM_POWERED) && has(STREAM_FAULT));
        wish.enable = false;
        scans(10);
        wish.enable = true;
        scans(500);
        ck_assert(has(STREAM_ENABLED) && !has(STREAM_FAULT));
        close_segment();
    }
}
END_TEST

START_TEST(test_a_control_that_moves_is_waited_for)
{
    begin();
    wish.enable = true;
    wish.rests = false;
    scans(500);
    ck_assert(has(STREAM_POWERED) && !has(STREAM_ENABLED) && !has(STREAM_FAULT));
    wish.rests = true;
    scans(2);
    ck_assert(has(STREAM_ENABLED));
    close_segment();
}
END_TEST

START_TEST(test_a_jump_stops_it_and_a_new_edge_resets)
{
    begin_moving();
    wish.position += 1.0;
    scan();
    ends_without_torque(STREAM_REFUSED);
    ck_assert_int_eq(stream.notice.error, CM1E_ERROR_AXIS_SET_POINT_LIMIT);
    ck_assert_ptr_nonnull(strstr(text(), "a set-point from outside commanded"));
    const double at = info().actual_position;
    wish = (stream_wish_t){.alive = true, .rests = true, .position = at};
    scans(50);
    ck_assert(has(STREAM_FAULT));
    wish.enable = true;
    scans(3000);
    ck_assert_msg(has(STREAM_ENABLED) && !has(STREAM_FAULT), "%s", text());
    ck_assert_double_eq_tol(info().actual_position, at, 0.01);
    close_segment();
}
END_TEST

START_TEST(test_reset_alone_gives_no_torque)
{
    begin_moving();
    simulate("error 1 2310");
    ends_without_torque(STREAM_REFUSED);
    wish.enable = false;
    scans(10);
    wish.reset = true;
    scans(3000);
    ck_assert(!has(STREAM_FAULT) && !has(STREAM_POWERED));
    close_segment();
}
END_TEST

START_TEST(test_a_fault_that_stays_is_told_again)
{
    char words[2000];
    begin_moving();
    simulate("error 1 2310 hold");
    ends_without_torque(STREAM_REFUSED);
    wish.enable = false;
    scans(10);
    wish.position = info().actual_position;
    wish.rests = wish.enable = true;
    scans(5000);
    ends_without_torque(STREAM_NOT_RESET);
    stream_notice_text(&stream.notice, "x", words, sizeof words);
    ck_assert_ptr_nonnull(strstr(words, "x was not reset."));
    close_segment();
}
END_TEST

START_TEST(test_a_silent_control_stops_it)
{
    begin_moving();
    wish.alive = false;
    scan();
    ends_without_torque(STREAM_SILENT);
    wish.alive = true; /* it is back, and does not get the axis by that */
    scans(500);
    ck_assert(has(STREAM_FAULT) && !has(STREAM_POWERED));
    close_segment();
}
END_TEST

START_TEST(test_a_silent_control_gets_no_torque)
{
    begin();
    wish.alive = false;
    wish.enable = true;
    scans(500);
    ck_assert(!has(STREAM_POWERED));
    close_segment();
}
END_TEST

START_TEST(test_the_drive_homes_while_it_is_not_enabled)
{
    begin();
    wish.home = true;
    scans(50);
    ck_assert(has(STREAM_HOMING));
    for (int n = 0; n < 20000 && has(STREAM_HOMING); n++)
        scan();
    ck_assert_msg(has(STREAM_HOMED) && !has(STREAM_FAULT), "%s", text());
    scans(500);
    ck_assert(!has(STREAM_POWERED));
    const double at = info().actual_position;
    wish = (stream_wish_t){.alive = true, .rests = true, .enable = true, .position = at};
    scans(500);
    ck_assert(has(STREAM_ENABLED));
    ck_assert_double_eq_tol(info().actual_position, at, 0.01);
    close_segment();
}
END_TEST

START_TEST(test_a_homing_ends_with_the_control_and_with_machine_on)
{
    for (int by_enable = 0; by_enable <= 1; by_enable++) {
        begin();
        wish.home = true;
        scans(400);
        ck_assert(has(STREAM_HOMING) && has(STREAM_POWERED));
        if (by_enable)
            wish.enable = true;
        else
            wish.alive = false;
        scans(3000);
        ck_assert(!has(STREAM_HOMING));
        const double at = info().actual_position;
        scans(500);
        ck_assert_double_eq_tol(info().actual_position, at, 0.02);
        close_segment();
    }
}
END_TEST

START_TEST(test_a_homing_that_fails_is_a_fault)
{
    char words[2000];
    begin();
    close_segment();
    config.axes[0].sim.no_stops = true;
    config.axes[0].homing.timeout_s = 1.0;
    open_segment();
    stream_axis_init(&stream, cm1e_axis_reference(axis), tolerance, 1e-3, 1);
    wish = (stream_wish_t){.alive = true, .rests = true, .home = true};
    for (int n = 0; n < 6000 && !has(STREAM_FAULT); n++)
        scan();
    ends_without_torque(STREAM_NOT_HOMED);
    stream_notice_text(&stream.notice, "x", words, sizeof words);
    ck_assert_ptr_nonnull(strstr(words, "x was not homed."));
    close_segment();
}
END_TEST

/* Faults before the motor has the torque for its homing: a reset must not begin it again. */
START_TEST(test_a_homing_that_a_fault_has_ended_does_not_begin_after_the_reset)
{
    static const char *const faults[] = {"power 1 off", "error 1 0x2310", "lose 500"};
    char words[2000];
    for (size_t i = 0; i < sizeof faults / sizeof *faults; i++)
        for (int home_stays = 0; home_stays <= 1; home_stays++) {
            begin();
            wish.home = true;
            scans(i == 0 ? 0 : 3);
            simulate(faults[i]);
            for (int n = 0; n < 20000 && !has(STREAM_FAULT); n++)
                scan();
            ck_assert_msg(has(STREAM_FAULT) && !has(STREAM_HOMING), "%s", faults[i]);
            stream_notice_text(&stream.notice, "x", words, sizeof words);
            ck_assert_ptr_nonnull(strstr(words, "x was not homed."));
            wish.home = home_stays;
            if (i == 0)
                simulate("power 1 on");
            scans(2000);
            const double at = probe().position_counts;
            wish.reset = true;
            for (int n = 0; n < 5000; n++) {
                scan();
                ck_assert_msg(!has(STREAM_POWERED | STREAM_HOMING), "%s: after %d cycles", faults[i], n);
            }
            ck_assert_msg(!has(STREAM_FAULT), "%s: %s", faults[i], text());
            ck_assert_double_eq_tol(probe().position_counts, at, 1.0);
            close_segment();
        }
}
END_TEST

/* As soon as there is no fault flag, also while the reset is under way. */
START_TEST(test_a_homing_may_be_asked_for_with_the_reset)
{
    char words[2000];
    for (int later = 0; later < 80; later += 3) {
        begin();
        simulate("error 1 0x2310");
        scans(50);
        ck_assert(has(STREAM_FAULT));
        wish.reset = true;
        scans(later);
        ck_assert(later == 0 || !has(STREAM_FAULT));
        wish.home = true;
        scan();
        for (int n = 0; n < 20000 && !has(STREAM_HOMED | STREAM_FAULT); n++)
            scan();
        stream_notice_text(&stream.notice, "x", words, sizeof words);
        ck_assert_msg(has(STREAM_HOMED), "%d cycles later: %s", later, words);
        close_segment();
    }
}
END_TEST

START_TEST(test_an_emergency_stop_ends_a_homing)
{
    begin();
    wish.home = true;
    scans(400);
    ck_assert(has(STREAM_HOMING) && has(STREAM_POWERED));
    wish.stop = true;
    scans(3000);
    ck_assert(!has(STREAM_HOMING | STREAM_POWERED | STREAM_HOMED));
    const double at = probe().position_counts;
    wish.stop = false; /* `home` is still TRUE: that is no edge */
    scans(3000);
    ck_assert(!has(STREAM_HOMING) && !has(STREAM_POWERED));
    ck_assert_double_eq_tol(probe().position_counts, at, 1.0);
    wish.home = false;
    wish.stop = true;
    scans(10);
    wish.home = true; /* an edge meanwhile does not count */
    scans(10);
    wish.stop = false;
    scans(3000);
    ck_assert(!has(STREAM_HOMING) && !has(STREAM_POWERED));
    close_segment();
}
END_TEST

START_TEST(test_an_enabled_axis_is_not_homed)
{
    begin_following();
    wish.home = true;
    scans(500);
    ck_assert(has(STREAM_ENABLED) && !has(STREAM_HOMING));
    close_segment();
}
END_TEST

START_TEST(test_the_output_of_the_motor_follows)
{
    begin_following();
    wish.digital = 1;
    scans(50);
    ck_assert(stream.outputs[0].Value && !stream.outputs[0].Error && !stream.outputs[0].Execute);
    ck_assert(probe().digital_outputs & 1);
    wish.digital = 0;
    scans(50);
    ck_assert(!(probe().digital_outputs & 1));
    close_segment();
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("an axis that follows a control");
    TCase *tcase = tcase_create("stream");
    tcase_add_test(tcase, test_it_follows_the_control_and_stops_with_it);
    tcase_add_test(tcase, test_a_small_distance_is_made_up_without_a_step);
    tcase_add_test(tcase, test_a_control_that_is_elsewhere_gets_no_axis);
    tcase_add_test(tcase, test_a_control_that_moves_is_waited_for);
    tcase_add_test(tcase, test_a_jump_stops_it_and_a_new_edge_resets);
    tcase_add_test(tcase, test_reset_alone_gives_no_torque);
    tcase_add_test(tcase, test_a_fault_that_stays_is_told_again);
    tcase_add_test(tcase, test_a_silent_control_stops_it);
    tcase_add_test(tcase, test_a_silent_control_gets_no_torque);
    tcase_add_test(tcase, test_the_drive_homes_while_it_is_not_enabled);
    tcase_add_test(tcase, test_a_homing_ends_with_the_control_and_with_machine_on);
    tcase_add_test(tcase, test_a_homing_that_fails_is_a_fault);
    tcase_add_test(tcase, test_a_homing_that_a_fault_has_ended_does_not_begin_after_the_reset);
    tcase_add_test(tcase, test_a_homing_may_be_asked_for_with_the_reset);
    tcase_add_test(tcase, test_an_emergency_stop_ends_a_homing);
    tcase_add_test(tcase, test_an_enabled_axis_is_not_homed);
    tcase_add_test(tcase, test_the_output_of_the_motor_follows);
    suite_add_tcase(suite, tcase);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_NORMAL);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed != 0;
}
