/**
 * Motions that the drive does by itself (`motion: drive`), on the simulated segment: both orders of the process data,
 * firmware before and after 1.3.0, both mappings that have the profile modes.
 */
#include "axis_segment.h"

static void describe_drive(int variant)
{
    describe(variant & 1 ? "1.2.0" : "1.3.5", variant & 4 ? CM1E_MAPPING_PROFILE : CM1E_MAPPING_DYNAMIC,
             variant & 2 ? CM1E_PDO_ORDER_UG_7_2 : CM1E_PDO_ORDER_UG_4_4, 1000000);
    config.axes[0].counts_per_unit = 1000;
    config.axes[0].motion = CM1E_MOTION_DRIVE;
    config.axes[0].sim.no_stops = true;
}

static void begin(int variant)
{
    describe_drive(variant);
    open_segment();
    enable();
}

static cm1e_command_status_t status(cm1e_command_id_t id) { return cm1e_axis_command_status(axis, id); }

static cm1e_command_id_t drive_to(double position, double velocity, double acceleration)
{
    return command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = position,
                                          .velocity = velocity, .acceleration = acceleration});
}

static cm1e_command_id_t turn(double velocity)
{
    return command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = velocity,
                                          .acceleration = 500, .deceleration = 1000});
}

static cm1e_error_t refusal(cm1e_axis_command_t c)
{
    cm1e_command_id_t id;
    c.velocity = c.velocity == 0 ? 10 : c.velocity;
    const cm1e_error_t error = cm1e_axis_start(axis, &c, &id);
    ck_assert(error != CM1E_OK && id == 0);
    return error;
}

/* It stands, and goes on standing, in the axis's own mode. */
static void expect_standstill(void)
{
    ck_assert_int_eq(info().state, CM1E_AXIS_STANDSTILL);
    const double position = info().actual_position;
    for (int n = 0; n < 430; n++) {
        cycles(1);
        ck_assert_double_le(fabs(probe().velocity_counts_per_s), 3000); /* it settles */
    }
    ck_assert_double_eq_tol(info().actual_position, position, 0.04);
    ck_assert_double_eq_tol(info().position_lag, 0, 0.003);
    ck_assert_int_eq(info().mode, CM1E_MODE_CSP);
    ck_assert_int_eq(info().state, CM1E_AXIS_STANDSTILL);
}

START_TEST(moves_go_to_their_target_in_profile_position_mode)
{
    for (int variant = 0; variant < 8; variant++) {
        begin(variant);
        const double from = info().actual_position;
        cm1e_command_id_t id = drive_to(from + 80, 200, 1000);
        ck_assert_int_eq(info().state, CM1E_AXIS_DISCRETE_MOTION);
        double fastest = 0;
        bool profile_position = false;
        for (int n = 0; n < 3000 && status(id).state == CM1E_COMMAND_ACTIVE; n++) {
            cycles(1);
            fastest = fmax(fastest, fabs(probe().velocity_counts_per_s));
            profile_position |= info().mode == CM1E_MODE_PP;
        }
        ck_assert_msg(status(id).state == CM1E_COMMAND_DONE, "variant %d: %s", variant, text());
        ck_assert(profile_position);
        ck_assert_double_eq_tol(fastest, 200e3, 10e3);
        ck_assert_double_eq_tol(info().set_position, from + 80, 1e-9); /* no drift */
        expect_standstill();
        ck_assert_double_eq_tol(info().actual_position, from + 80, 0.002);
        id = command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_RELATIVE, .position = -30, .velocity = 100});
        await(id, 3);
        ck_assert_int_eq(status(id).state, CM1E_COMMAND_DONE);
        ck_assert_double_eq_tol(info().set_position, from + 50, 1e-9);
        id = drive_to(from + 50, 100, 0); /* it is there, or nearly */
        await(id, 3);
        ck_assert_int_eq(status(id).state, CM1E_COMMAND_DONE);
        expect_standstill();
        close_segment();
    }
}
END_TEST

START_TEST(velocities_turn_in_profile_velocity_mode_until_they_are_ended)
{
    for (int variant = 0; variant < 8; variant++)
        for (int stop = 0; stop < 2; stop++) {
            begin(variant);
            const double velocity = stop ? -50 : 50;
            const cm1e_command_id_t id = turn(velocity);
            for (int n = 0; n < 3000 && !status(id).reached; n++)
                cycles(1);
            ck_assert_msg(status(id).reached, "variant %d: %s", variant, text());
            ck_assert_double_eq_tol(probe().velocity_counts_per_s, velocity * 1000, 3000); /* not before */
            ck_assert_int_eq(info().state, CM1E_AXIS_CONTINUOUS_MOTION);
            ck_assert_int_eq(info().mode, CM1E_MODE_PV);
            cycles(100);
            ck_assert_double_eq_tol(probe().velocity_counts_per_s, velocity * 1000, 2000);
            const cm1e_command_id_t end =
                command(&(cm1e_axis_command_t){.kind = stop ? CM1E_COMMAND_STOP : CM1E_COMMAND_HALT});
            ck_assert_int_eq(status(id).state, CM1E_COMMAND_ABORTED);
            ck_assert_int_eq(info().state, stop ? CM1E_AXIS_STOPPING : CM1E_AXIS_DISCRETE_MOTION);
            await(end, 3);
            ck_assert_int_eq(status(end).state, CM1E_COMMAND_DONE);
            cm1e_axis_hold_stop(axis, end, false);
            cycles(2);
            expect_standstill();
            close_segment();
        }
}
END_TEST

START_TEST(what_the_drive_does_not_do_is_refused)
{
    begin(0);
    ck_assert_int_eq(refusal((cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_RELATIVE, .position = 1, .jerk = 100}),
                     CM1E_ERROR_UNSUPPORTED);
    ck_assert_int_eq(refusal((cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_RELATIVE, .position = 1,
                                                   .acceleration = 100, .deceleration = 200}), CM1E_ERROR_UNSUPPORTED);
    ck_assert_int_eq(refusal((cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_CONTINUOUS_RELATIVE, .position = 1}),
                     CM1E_ERROR_UNSUPPORTED);
    ck_assert_int_eq(refusal((cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .velocity = 2501}),
                     CM1E_ERROR_AXIS_VELOCITY_RANGE);
    for (int turns = 0; turns < 2; turns++) { /* the drive would take 0, and never arrive */
        const cm1e_axis_command_t slow = {.kind = turns ? CM1E_COMMAND_MOVE_VELOCITY : CM1E_COMMAND_MOVE_RELATIVE,
                                          .position = turns ? 0 : 1, .velocity = turns ? -0.00049 : 0.00049};
        ck_assert_int_eq(refusal(slow), CM1E_ERROR_AXIS_VELOCITY_RANGE);
        ck_assert_ptr_nonnull(strstr(text(), "which its drive rounds to 0 counts/s; from 0.0005 u/s on is right"));
    }
    /* beyond the drive's 32 bits it would turn the other way round */
    ck_assert_int_eq(refusal((cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_RELATIVE, .position = 2147484}),
                     CM1E_ERROR_AXIS_POSITION_RANGE);
    ck_assert_int_eq(info().state, CM1E_AXIS_STANDSTILL);
    ck_assert_int_eq(cm1e_axis_set_override(axis, 0.5, 1, 1), CM1E_ERROR_UNSUPPORTED);
    const double from = info().actual_position;
    const cm1e_command_id_t id = drive_to(from + 100, 100, 0);
    cycles(300);
    ck_assert_int_eq(refusal((cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_RELATIVE, .position = 1}),
                     CM1E_ERROR_AXIS_STATE);
    ck_assert_int_eq(refusal((cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_RELATIVE, .position = 1,
                                                   .buffer_mode = mcBuffered}), CM1E_ERROR_AXIS_BUFFER_MODE);
    await(id, 5);
    ck_assert_int_eq(status(id).state, CM1E_COMMAND_DONE);
    ck_assert_double_eq_tol(info().actual_position, from + 100, 0.06);
    const cm1e_command_id_t next = command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_RELATIVE, .position = 1,
                                                                  .velocity = 10, .buffer_mode = mcBuffered});
    await(next, 5); /* nothing to wait for: it begins at once */
    ck_assert_int_eq(status(next).state, CM1E_COMMAND_DONE);
    close_segment();
}
END_TEST

/* A halt at any moment, of the parameters, the switch of modes, the handshake, the motion and the way back. */
/* Nothing moves, the text names the object, and the next command goes. */
START_TEST(parameter_that_the_drive_refuses_ends_the_command)
{
    static const char *const objects[2][2] = {{"6081", "6083"}, {"6083", "6084"}};
    for (int n = 0; n < 4; n++) {
        const int velocity_mode = n / 2;
        const char *object = objects[velocity_mode][n % 2];
        char order[40];
        begin(0);
        const double from = info().actual_position;
        snprintf(order, sizeof order, "refuse 1 %s:0", object);
        simulate(order);
        cm1e_command_id_t id = velocity_mode ? turn(50) : drive_to(from + 30, 100, 400);
        for (int i = 0; i < 3000 && status(id).state == CM1E_COMMAND_ACTIVE; i++)
            cycles(1);
        ck_assert_int_eq(status(id).state, CM1E_COMMAND_ERROR);
        ck_assert_int_eq(status(id).error, CM1E_ERROR_SDO_ABORT);
        ck_assert_msg(strstr(text(), object), "%s: %s", object, text());
        expect_standstill();
        ck_assert_double_eq_tol(info().actual_position, from, 0.04);
        simulate("refuse 1 nothing");
        id = drive_to(from + 30, 200, 1000);
        await(id, 3);
        ck_assert_int_eq(status(id).state, CM1E_COMMAND_DONE);
        expect_standstill();
        close_segment();
    }
}
END_TEST

START_TEST(halt_at_any_cycle_ends_in_standstill)
{
    for (int after = 0; after < 260; after += after < 40 ? 1 : 9)
        for (int kind = 0; kind < 2; kind++) {
            begin(after % 8);
            const cm1e_command_id_t id = kind ? turn(100) : drive_to(info().actual_position + 15, 200, 2000);
            cycles(after);
            const bool ended = status(id).state == CM1E_COMMAND_DONE;
            const cm1e_command_id_t halt = command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_HALT});
            await(halt, 4);
            ck_assert_msg(status(halt).state == CM1E_COMMAND_DONE, "after %d: %s", after, text());
            ck_assert(ended || status(id).state == CM1E_COMMAND_ABORTED);
            expect_standstill();
            if (after < 40) { /* also where its parameters were on their way */
                const cm1e_command_id_t next = drive_to(info().actual_position + 1, 100, 0);
                await(next, 3);
                ck_assert_msg(status(next).state == CM1E_COMMAND_DONE, "after %d: %s", after, text());
            }
            close_segment();
        }
}
END_TEST

/* The drive halts because power was taken away, and meanwhile power is wanted again. With torque the drive would go on
 * with its motion when the halt bit goes, or jump to the target of that motion in the mode of the axis. */
START_TEST(power_that_is_wanted_again_while_the_drive_halts_moves_nothing)
{
    for (int pause = 1; pause < 400; pause += pause < 10 ? 1 : 23) {
        begin(0);
        const cm1e_command_id_t id = _i ? turn(20) : drive_to(info().actual_position + 150, 20, 100);
        cycles(150);
        power(false);
        cycles(pause);
        power(true);
        double way = 0;
        for (int i = 0; i < 1500; i++) {
            const double before = probe().position_counts;
            cycles(1);
            if (info().state == CM1E_AXIS_STANDSTILL)
                way += fabs(probe().position_counts - before);
        }
        ck_assert_msg(info().state == CM1E_AXIS_STANDSTILL, "pause %d: %s", pause, text());
        ck_assert(status(id).state == CM1E_COMMAND_ABORTED);
        ck_assert_msg(way < 10, "pause %d: the motor has moved by %.0f counts in Standstill", pause, way);
        close_segment();
    }
}
END_TEST

/* Power taken away, motor power lost, and a frame-less time: the motor stands and has no torque; and after a reset and
 * a new MC_Power nothing of the old motion is left. */
START_TEST(ends_by_force_leave_a_motor_that_stands)
{
    for (int kind = 0; kind < 3; kind++)
        for (int after = 1; after < 330; after += 23)
            for (int velocity_mode = 0; velocity_mode < 2; velocity_mode++) {
                begin(after % 8);
                if (velocity_mode)
                    turn(100);
                else
                    drive_to(info().actual_position + 60, 200, 2000);
                cycles(after);
                if (kind == 0)
                    power(false);
                else
                    simulate(kind == 1 ? "power 1 off" : "lose 30");
                cycles(1500);
                ck_assert_double_eq_tol(probe().velocity_counts_per_s, 0, 1);
                ck_assert_int_eq(info().state, kind == 0 ? CM1E_AXIS_DISABLED : CM1E_AXIS_ERROR_STOP);
                ck_assert(!info().powered);
                if (kind == 1)
                    simulate("power 1 on");
                power(false);
                cycles(50);
                if (kind)
                    ck_assert_int_eq(cm1e_axis_reset(axis), CM1E_OK);
                cycles(3000);
                ck_assert_msg(info().state == CM1E_AXIS_DISABLED, "%s", text());
                enable();
                expect_standstill();
                close_segment();
            }
}
END_TEST

/* The cable: nobody can brake it, and from firmware 1.3.0 on the watchdog takes the torque away. */
START_TEST(drive_that_hears_nothing_is_left_to_its_watchdog)
{
    for (int variant = 0; variant < 8; variant += 2) {
        begin(variant);
        turn(100);
        cycles(400);
        simulate("unplug 1");
        cycles(1500);
        ck_assert_int_eq(info().state, CM1E_AXIS_ERROR_STOP);
        ck_assert_int_eq(info().error, CM1E_ERROR_BUS_LOST);
        ck_assert(!info().powered);
        ck_assert_double_lt(fabs(probe().velocity_counts_per_s), 50e3); /* it runs out */
        close_segment();
    }
}
END_TEST

START_TEST(software_limits_hold)
{
    for (int variant = 0; variant < 8; variant++) {
        describe_drive(variant);
        config.axes[0].software_limit_positive = 40;
        config.axes[0].software_limit_negative = -40;
        open_segment();
        enable();
        ck_assert_int_eq(refusal((cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = 40.1}),
                         CM1E_ERROR_AXIS_POSITION_RANGE);
        turn(variant & 1 ? -150 : 150);
        ck_assert_int_eq(cm1e_axis_set_position(axis, 0, false), CM1E_ERROR_AXIS_STATE);
        cycles(3000);
        ck_assert_int_eq(info().state, CM1E_AXIS_ERROR_STOP);
        ck_assert_int_eq(info().error, CM1E_ERROR_AXIS_POSITION_RANGE);
        ck_assert_double_le(fabs(info().actual_position), 40);
        ck_assert_double_ge(fabs(info().actual_position), 35);
        close_segment();
    }
}
END_TEST

/* The drive goes on to accelerate until it has the halt. */
START_TEST(software_limits_hold_while_the_drive_accelerates)
{
    for (int sign = -1; sign <= 1; sign += 2) {
        describe_drive(0);
        config.axes[0].software_limit_positive = 40;
        config.axes[0].software_limit_negative = -40;
        open_segment();
        enable();
        command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = sign * 300.0,
                                       .acceleration = 3000, .deceleration = 1000});
        double fastest = 0;
        for (int n = 0; n < 2000; n++) {
            cycles(1);
            fastest = fmax(fastest, fabs(info().actual_velocity));
        }
        ck_assert_double_lt(fastest, 250); /* it has never had its velocity */
        ck_assert_int_eq(info().error, CM1E_ERROR_AXIS_POSITION_RANGE);
        ck_assert_double_le(fabs(info().actual_position), 40);
        ck_assert_double_ge(fabs(info().actual_position), 35);
        close_segment();
    }
}
END_TEST

START_TEST(direction_taken_away_ends_the_motion)
{
    for (int velocity_mode = 0; velocity_mode < 2; velocity_mode++) {
        begin(0);
        const cm1e_command_id_t id = velocity_mode ? turn(100) : drive_to(info().actual_position + 100, 100, 0);
        cycles(400);
        ck_assert_int_eq(cm1e_axis_power(axis, &owner, true, true, false), CM1E_OK);
        cycles(5);
        ck_assert_int_eq(status(id).state, CM1E_COMMAND_ACTIVE); /* the other one */
        ck_assert_int_eq(cm1e_axis_power(axis, &owner, true, false, false), CM1E_OK);
        ck_assert_int_eq(status(id).state, CM1E_COMMAND_ERROR);
        ck_assert_int_eq(status(id).error, CM1E_ERROR_AXIS_DIRECTION_DISABLED);
        cycles(1500);
        expect_standstill();
        ck_assert_int_eq(refusal((cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_RELATIVE, .position = 1}),
                         CM1E_ERROR_AXIS_DIRECTION_DISABLED);
        close_segment();
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("drive profiles");
    TCase *tests = tcase_create("motions");
    tcase_add_test(tests, moves_go_to_their_target_in_profile_position_mode);
    tcase_add_test(tests, velocities_turn_in_profile_velocity_mode_until_they_are_ended);
    tcase_add_test(tests, what_the_drive_does_not_do_is_refused);
    tcase_add_test(tests, parameter_that_the_drive_refuses_ends_the_command);
    tcase_add_test(tests, halt_at_any_cycle_ends_in_standstill);
    tcase_add_loop_test(tests, power_that_is_wanted_again_while_the_drive_halts_moves_nothing, 0, 2);
    tcase_add_test(tests, ends_by_force_leave_a_motor_that_stands);
    tcase_add_test(tests, drive_that_hears_nothing_is_left_to_its_watchdog);
    tcase_add_test(tests, software_limits_hold);
    tcase_add_test(tests, software_limits_hold_while_the_drive_accelerates);
    tcase_add_test(tests, direction_taken_away_ends_the_motion);
    suite_add_tcase(suite, tests);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? 1 : 0;
}
