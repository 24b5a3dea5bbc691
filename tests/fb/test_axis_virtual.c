/* Axes without a motor beside one with a motor, on the simulated segment with SOEM: a virtual one goes through the
 * state diagram as any axis does and is where its set-point is, an encoder shows what the program writes. */
#include "bridge/cool_muscle.h"
#include "axis/axis_parameters.h"
#include "axis/axis_signals.h"
#include "axis_segment.h"
#include "device/devices.h"
#undef axis /* it is a member here */

enum { LINE = 0, MOTOR, ENCODER, AXES };
static int owners[AXES];

/* Virtual, a CM1-E, which is the only slave, and an encoder. */
static void start(void)
{
    describe("1.3.5", CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, 1000000);
    describe_up_to(AXES);
    snprintf(config.axes[LINE].name, sizeof config.axes[LINE].name, "line");
    config.axes[LINE].type = CM1E_AXIS_VIRTUAL;
    config.axes[LINE].firmware[0] = '\0';
    config.axes[ENCODER].type = CM1E_AXIS_ENCODER;
    config.axes[ENCODER].counts_per_unit = 1000.0;
    open_segment();
    ck_assert_uint_eq(cm1e_bus_slave_count(bus), 1);
    ck_assert_uint_eq(cm1e_bus_axis_position(bus, MOTOR), 1);
    ck_assert_uint_eq(cm1e_bus_axis_position(bus, LINE), 0);
}

static cm1e_error_t try_power(int n, bool on) { return cm1e_axis_power(axes[n], &owners[n], on, true, true); }

static void enable_both(void)
{
    for (int n = LINE; n <= MOTOR; n++)
        ck_assert_int_eq(try_power(n, true), CM1E_OK);
    cycles(200);
    for (int n = LINE; n <= MOTOR; n++)
        ck_assert_msg(info_of(n).state == CM1E_AXIS_STANDSTILL, "%s", text_of(n));
}

static cm1e_command_id_t go(int n, cm1e_command_kind_t kind, double position, double velocity)
{
    cm1e_command_id_t id;
    const cm1e_axis_command_t c = {.kind = kind, .position = position, .velocity = velocity};
    const cm1e_error_t error = cm1e_axis_start(axes[n], &c, &id);
    ck_assert_msg(error == CM1E_OK, "%s: %s", cm1e_strerror(error), text_of(n));
    return id;
}

static cm1e_error_t refused(int n, const cm1e_axis_command_t *c)
{
    cm1e_command_id_t id;
    return cm1e_axis_start(axes[n], c, &id);
}

/* ---- virtual ----------------------------------------------------------------------------------------------------- */

START_TEST(test_virtual_axis_moves_beside_a_motor_and_has_no_lag)
{
    start();
    enable_both();
    const cm1e_command_id_t ids[] = {go(LINE, CM1E_COMMAND_MOVE_ABSOLUTE, 12.25, 7.0),
                                     go(MOTOR, CM1E_COMMAND_MOVE_ABSOLUTE, 3.0, 7.0)};
    double velocity = 0.0;
    for (int i = 0; i < 3000; i++) {
        inputs();
        const cm1e_axis_info_t shown = info_of(LINE);
        ck_assert_double_eq_tol(shown.position_lag, 0.0, 1.0 / 50000.0);
        ck_assert_double_eq_tol(shown.actual_velocity, shown.set_velocity, 1.0 / 50000.0);
        ck_assert(shown.online && !shown.torque_known && !shown.digital_known);
        velocity = fmax(velocity, shown.actual_velocity);
        outputs();
    }
    for (int n = LINE; n <= MOTOR; n++)
        ck_assert_msg(cm1e_axis_command_status(axes[n], ids[n]).state == CM1E_COMMAND_DONE, "%s", text_of(n));
    ck_assert_double_eq_tol(velocity, 7.0, 1e-4);
    ck_assert_double_eq(info_of(LINE).set_position, 12.25);
    ck_assert_double_eq(info_of(LINE).actual_position, 12.25);
    close_segment();
}
END_TEST

START_TEST(test_virtual_axis_ramps_down_when_it_is_stopped_and_when_its_power_goes)
{
    start();
    enable_both();
    go(LINE, CM1E_COMMAND_MOVE_VELOCITY, 0.0, 20.0);
    cycles(1000);
    const cm1e_command_id_t stop = go(LINE, CM1E_COMMAND_STOP, 0.0, 0.0);
    ck_assert_int_eq(info_of(LINE).state, CM1E_AXIS_STOPPING);
    cm1e_axis_hold_stop(axes[LINE], stop, false);
    cycles(1000);
    ck_assert_int_eq(info_of(LINE).state, CM1E_AXIS_STANDSTILL);
    go(LINE, CM1E_COMMAND_MOVE_VELOCITY, 0.0, 20.0);
    cycles(1000);
    ck_assert_int_eq(try_power(LINE, false), CM1E_OK);
    ck_assert_int_eq(info_of(LINE).state, CM1E_AXIS_DISABLED);
    double before = info_of(LINE).actual_velocity;
    for (int i = 0; i < 1000; i++) {
        cycles(1);
        ck_assert_double_le(fabs(info_of(LINE).actual_velocity - before), 100.0 * 1e-3 + 1e-4);
        before = info_of(LINE).actual_velocity;
    }
    ck_assert(!info_of(LINE).powered);
    ck_assert_double_eq(before, 0.0);
    const double rest = info_of(LINE).actual_position;
    ck_assert_int_eq(try_power(LINE, true), CM1E_OK);
    cycles(10);
    ck_assert_int_eq(info_of(LINE).state, CM1E_AXIS_STANDSTILL);
    ck_assert_double_eq(info_of(LINE).actual_position, rest);
    close_segment();
}
END_TEST

START_TEST(test_virtual_axis_fails_at_its_limits_and_is_reset)
{
    describe("1.3.5", CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, 1000000);
    describe_up_to(2);
    config.axes[LINE].type = CM1E_AXIS_VIRTUAL;
    config.axes[LINE].firmware[0] = '\0';
    config.axes[LINE].software_limit_negative = -1.0;
    config.axes[LINE].software_limit_positive = 5.0;
    open_segment();
    enable_both();
    ck_assert_int_eq(refused(LINE, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = 5.1,
                                                          .velocity = 1.0}), CM1E_ERROR_AXIS_POSITION_RANGE);
    go(LINE, CM1E_COMMAND_MOVE_VELOCITY, 0.0, 10.0);
    cycles(2000);
    ck_assert_int_eq(info_of(LINE).state, CM1E_AXIS_ERROR_STOP);
    ck_assert_int_eq(info_of(LINE).error, CM1E_ERROR_AXIS_POSITION_RANGE);
    ck_assert_double_le(info_of(LINE).actual_position, 5.0 + 1e-4);
    ck_assert_int_eq(info_of(MOTOR).state, CM1E_AXIS_STANDSTILL);
    cm1e_axis_reset(axes[LINE]);
    cycles(10);
    ck_assert_msg(info_of(LINE).state == CM1E_AXIS_STANDSTILL, "%s", text_of(LINE));
    close_segment();
}
END_TEST

/* The bus is no business of an axis that is not on it. */
START_TEST(test_virtual_axis_goes_on_when_the_motor_is_lost)
{
    start();
    enable_both();
    for (int n = LINE; n <= MOTOR; n++)
        go(n, CM1E_COMMAND_MOVE_VELOCITY, 0.0, 4.0);
    cycles(500);
    simulate("power 1 off");
    cycles(500);
    ck_assert_int_eq(info_of(MOTOR).state, CM1E_AXIS_ERROR_STOP);
    ck_assert_int_eq(info_of(LINE).state, CM1E_AXIS_CONTINUOUS_MOTION);
    ck_assert_double_eq_tol(info_of(LINE).actual_velocity, 4.0, 1e-4);
    close_segment();
}
END_TEST

START_TEST(test_positions_of_a_virtual_axis_are_set)
{
    start();
    enable_both();
    const cm1e_homing_step_t direct = {.kind = CM1E_STEP_DIRECT};
    cm1e_command_id_t id;
    ck_assert(!info_of(LINE).homed);
    ck_assert_int_eq(cm1e_axis_start(axes[LINE], &(cm1e_axis_command_t){.kind = CM1E_COMMAND_HOMING_STEP,
                                                                        .position = 3.5, .step = &direct}, &id),
                     CM1E_OK);
    cycles(20);
    ck_assert_msg(cm1e_axis_command_status(axes[LINE], id).state == CM1E_COMMAND_DONE, "%s", text_of(LINE));
    ck_assert(info_of(LINE).homed);
    ck_assert_double_eq(info_of(LINE).actual_position, 3.5);
    ck_assert_int_eq(cm1e_axis_set_position(axes[LINE], -1.0, true), CM1E_OK);
    ck_assert_double_eq(info_of(LINE).set_position, 2.5);
    ck_assert_double_eq(info_of(LINE).actual_position, 2.5);
    close_segment();
}
END_TEST

START_TEST(test_what_needs_a_motor_is_refused_in_words)
{
    start();
    enable_both();
    const cm1e_homing_config_t homing = {.method = -1};
    const cm1e_homing_step_t steps[] = {{.kind = CM1E_STEP_ABSOLUTE_SWITCH, .direction = mcPositiveDirection},
                                        {.kind = CM1E_STEP_LIMIT_SWITCH, .direction = mcPositiveDirection},
                                        {.kind = CM1E_STEP_BLOCK, .direction = mcPositiveDirection}};
    ck_assert_int_eq(refused(LINE, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_HOME, .homing = &homing}),
                     CM1E_ERROR_AXIS_VIRTUAL);
    ck_assert_msg(strstr(text_of(LINE), "\"line\" is virtual") && strstr(text_of(LINE), "MC_HomeDirect"), "%s",
                  text_of(LINE));
    for (int i = 0; i < 3; i++)
        ck_assert_int_eq(refused(LINE, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_HOMING_STEP, .velocity = 1.0,
                                                              .step = &steps[i]}), CM1E_ERROR_AXIS_VIRTUAL);
    for (int n = LINE; n < AXES; n += ENCODER - LINE) {
        bool on;
        double value;
        uint32_t id;
        ck_assert_int_eq(cm1e_axis_read_input(axes[n], 1, &on), CM1E_ERROR_AXIS_VIRTUAL);
        ck_assert_int_eq(cm1e_axis_write_output(axes[n], 1, true), CM1E_ERROR_AXIS_VIRTUAL);
        ck_assert_int_eq(cm1e_axis_read_output(axes[n], 1, &on), CM1E_ERROR_AXIS_VIRTUAL);
        ck_assert_int_eq(cm1e_axis_hold_output(axes[n], 1, true, 1000000), CM1E_ERROR_AXIS_VIRTUAL);
        ck_assert_int_eq(cm1e_axis_read_torque(axes[n], &value), CM1E_ERROR_AXIS_VIRTUAL);
        ck_assert_int_eq(cm1e_axis_probe(axes[n], (cm1e_axis_trigger_t){.input = 1}, false, 0.0, 0.0, &id),
                         CM1E_ERROR_AXIS_VIRTUAL);
        ck_assert_int_eq(cm1e_axis_object_start(axes[n], 1500, false, 0.0, &id), CM1E_ERROR_AXIS_VIRTUAL);
        ck_assert_int_eq(cm1e_axis_object_start(axes[n], 1400, true, 0.0, &id), CM1E_ERROR_AXIS_VIRTUAL);
        ck_assert_int_eq(cm1e_axis_cml_send(axes[n], "?96.1", 5, 0, false, &id), CM1E_ERROR_AXIS_VIRTUAL);
        ck_assert(!cm1e_axis_sees_input(axes[n], 1));
        ck_assert(!cm1e_axis_has_switch(axes[n], CM1E_SWITCH_HOME));
    }
    cycles(100);
    ck_assert_int_eq(info_of(LINE).state, CM1E_AXIS_STANDSTILL);
    close_segment();
}
END_TEST

/* Frames need somebody to pass: an I/O module stands in the segment. */
START_TEST(test_a_segment_of_virtual_axes_only_runs)
{
    cm1e_bus_config_free(&config);
    cm1e_bus_config_init(&config, "sim", 2);
    config.virtual_time = true;
    config.cycle_time_ns = 1000000;
    for (int n = 0; n < 2; n++)
        config.axes[n].type = CM1E_AXIS_VIRTUAL;
    open_segment();
    ck_assert_uint_eq(cm1e_bus_slave_count(bus), 1);
    ck_assert(cm1e_bus_slave(bus, 1)->device != &cm1e_device_cm1e);
    enable_both();
    const cm1e_command_id_t id = go(LINE, CM1E_COMMAND_MOVE_RELATIVE, -2.0, 5.0);
    cycles(1500);
    ck_assert_int_eq(cm1e_axis_command_status(axes[LINE], id).state, CM1E_COMMAND_DONE);
    ck_assert_double_eq(info_of(LINE).actual_position, -2.0);
    close_segment();
}
END_TEST

START_TEST(test_fast_virtual_axis_passes_the_end_of_32_bits)
{
    cm1e_bus_config_free(&config);
    cm1e_bus_config_init(&config, "sim", 1);
    config.virtual_time = true;
    config.cycle_time_ns = 1000000;
    config.axes[LINE].type = CM1E_AXIS_VIRTUAL;
    config.axes[LINE].max_velocity = 20000.0; /* 1e9 counts/s */
    config.axes[LINE].max_acceleration = 40000.0;
    config.axes[LINE].max_jerk = 1e6;
    open_segment();
    ck_assert_int_eq(try_power(LINE, true), CM1E_OK);
    cycles(10);
    const cm1e_command_id_t id = go(LINE, CM1E_COMMAND_MOVE_ABSOLUTE, -100000.0, 20000.0); /* 5e9 counts */
    double worst = 0.0;
    for (int i = 0; i < 8000; i++) {
        inputs();
        worst = fmax(worst, fabs(info_of(LINE).position_lag));
        outputs();
    }
    ck_assert_msg(cm1e_axis_command_status(axes[LINE], id).state == CM1E_COMMAND_DONE, "%s", text_of(LINE));
    ck_assert_double_eq(info_of(LINE).actual_position, -100000.0);
    ck_assert_double_le(worst, 1.0 / 50000.0);
    close_segment();
}
END_TEST

/* ---- encoder ----------------------------------------------------------------------------------------------------- */

static void write_counts(int64_t counts, bool valid)
{
    inputs();
    ck_assert_int_eq(cm1e_axis_write_encoder(cm1e_axis_reference(axes[ENCODER]), (uint32_t)(uint64_t)counts, valid),
                     CM1E_OK);
    outputs();
}

START_TEST(test_encoder_is_where_the_program_says_over_the_end_of_its_counter)
{
    start();
    const int64_t first = INT64_C(0xFFFFFF00);
    ck_assert(!info_of(ENCODER).online);
    write_counts(first, true);
    inputs();
    ck_assert(info_of(ENCODER).online);
    ck_assert_int_eq(cm1e_axis_set_position(axes[ENCODER], 0.0, false), CM1E_OK);
    outputs();
    int64_t counts = first;
    for (int i = 0; i < 400; i++) {
        counts += i < 200 ? 12 : -7;
        write_counts(counts, true);
        inputs(); /* a cycle later */
        ck_assert_double_eq_tol(info_of(ENCODER).actual_position, (double)(counts - first) / 1000.0, 1e-9);
        outputs();
        ck_assert_double_eq_tol(info_of(ENCODER).set_position, info_of(ENCODER).actual_position, 1e-9);
    }
    ck_assert_int_eq(info_of(ENCODER).state, CM1E_AXIS_DISABLED);
    close_segment();
}
END_TEST

START_TEST(test_encoder_that_is_not_written_is_offline_and_comes_back_where_it_is)
{
    for (int lost = 1; lost <= 10; lost++) {
        start();
        int64_t counts = 5000;
        for (int i = 0; i < 20; i++)
            write_counts(counts += 10, true);
        inputs();
        ck_assert(info_of(ENCODER).online);
        const double before = info_of(ENCODER).actual_position;
        ck_assert_double_eq_tol(info_of(ENCODER).actual_velocity, 10.0, 1e-9);
        outputs();
        for (int i = 1; i < lost; i++) {
            counts += 10;
            if (i % 2)
                write_counts(77, false);
            else
                cycles(1);
            ck_assert(!info_of(ENCODER).online);
            ck_assert_double_eq(info_of(ENCODER).actual_position, before);
        }
        write_counts(counts += 20, true); /* two cycles beside those lost: the first was read above */
        inputs();
        ck_assert(info_of(ENCODER).online);
        ck_assert_double_eq_tol(info_of(ENCODER).actual_position - before, (lost + 1) * 10 / 1000.0, 1e-9);
        ck_assert_double_eq_tol(info_of(ENCODER).actual_velocity, 10.0, 1e-9);
        outputs();
        close_segment();
    }
}
END_TEST

START_TEST(test_encoder_is_never_enabled_nor_moved)
{
    start();
    write_counts(0, true);
    ck_assert_int_eq(try_power(ENCODER, true), CM1E_ERROR_AXIS_VIRTUAL);
    ck_assert_msg(strstr(text_of(ENCODER), "is an encoder"), "%s", text_of(ENCODER));
    for (int i = 0; i < 50; i++)
        write_counts(0, true);
    ck_assert_int_eq(info_of(ENCODER).state, CM1E_AXIS_DISABLED);
    ck_assert(!info_of(ENCODER).powered);
    ck_assert(!cm1e_axis_condition(axes[ENCODER]).ready_for_power_on);
    ck_assert_int_eq(try_power(ENCODER, false), CM1E_OK);
    const cm1e_axis_coupling_t gear = {
        .master = {{.axis = cm1e_axis_reference(axes[LINE]), .numerator = 1, .denominator = 1}}};
    ck_assert_int_eq(refused(ENCODER, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 1.0}),
                     CM1E_ERROR_AXIS_NOT_POWERED);
    ck_assert_int_eq(refused(ENCODER, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_GEAR_IN, .coupling = &gear}),
                     CM1E_ERROR_AXIS_NOT_POWERED);
    ck_assert_int_eq(cm1e_axis_write_encoder(cm1e_axis_reference(axes[LINE]), 0, true), CM1E_ERROR_UNSUPPORTED);
    ck_assert_int_eq(cm1e_axis_write_encoder((AXIS_REF_t){0}, 0, true), CM1E_ERROR_FB_AXIS_REF);
    close_segment();
}
END_TEST

/* ---- as masters -------------------------------------------------------------------------------------------------- */

static cm1e_command_id_t gear_in(int slave, int master, int32_t numerator, uint32_t denominator)
{
    cm1e_command_id_t id;
    const cm1e_axis_coupling_t coupling = {.master = {{.axis = cm1e_axis_reference(axes[master]),
                                                       .numerator = numerator, .denominator = denominator}}};
    const cm1e_axis_command_t c = {.kind = CM1E_COMMAND_GEAR_IN, .coupling = &coupling};
    const cm1e_error_t error = cm1e_axis_start(axes[slave], &c, &id);
    ck_assert_msg(error == CM1E_OK, "%s: %s", cm1e_strerror(error), text_of(slave));
    return id;
}

/* A motor at a line shaft that is not there, and the shaft stopped by the motor's failure. */
START_TEST(test_motor_follows_a_virtual_axis)
{
    start();
    enable_both();
    gear_in(MOTOR, LINE, -1, 2);
    const cm1e_command_id_t id = go(LINE, CM1E_COMMAND_MOVE_ABSOLUTE, 8.0, 6.0);
    for (int i = 0; i < 3000; i++) {
        cycles(1);
        ck_assert_double_eq_tol(info_of(MOTOR).set_position, -0.5 * info_of(LINE).set_position, 1e-9);
    }
    ck_assert_int_eq(cm1e_axis_command_status(axes[LINE], id).state, CM1E_COMMAND_DONE);
    ck_assert_double_eq_tol(probe_of(0).position_counts, -4.0 * 50000.0, 100.0);
    go(LINE, CM1E_COMMAND_MOVE_VELOCITY, 0.0, 6.0);
    cycles(500);
    simulate("error 1 2310");
    cycles(100);
    ck_assert_int_eq(info_of(MOTOR).state, CM1E_AXIS_ERROR_STOP);
    ck_assert_int_eq(info_of(LINE).state, CM1E_AXIS_CONTINUOUS_MOTION); /* a master is not influenced */
    close_segment();
}
END_TEST

START_TEST(test_motor_follows_an_encoder_that_is_lost_for_some_cycles)
{
    for (int lost = 1; lost <= 5; lost++) {
        start();
        enable_both();
        int64_t counts = 0;
        for (int i = 0; i < 100; i++)
            write_counts(counts, true);
        gear_in(MOTOR, ENCODER, 1, 50);
        for (int i = 0; i < 2000; i++) /* an even start */
            write_counts(counts += i / 200, true);
        ck_assert_msg(info_of(MOTOR).state == CM1E_AXIS_SYNCHRONIZED_MOTION, "%s", text_of(MOTOR));
        for (int i = 0; i < lost; i++) {
            counts += 9;
            write_counts(7, false);
        }
        for (int i = 0; i < 2; i++)
            write_counts(counts += 9, true);
        const bool ridden_out = lost <= 3; /* lost_cycles_limit */
        ck_assert_msg(info_of(MOTOR).state == (ridden_out ? CM1E_AXIS_SYNCHRONIZED_MOTION : CM1E_AXIS_ERROR_STOP),
                      "%d: %s", lost, text_of(MOTOR));
        for (int i = 0; i < 1500; i++)
            write_counts(counts += i < 900 ? 9 - i / 100 : 0, true);
        if (ridden_out)
            ck_assert_double_eq_tol(info_of(MOTOR).set_position, (double)counts / 1000.0 / 50.0, 2.0 / 1000.0 / 50.0);
        else
            ck_assert_int_eq(info_of(MOTOR).error, CM1E_ERROR_AXIS_MASTER_LOST);
        close_segment();
    }
}
END_TEST

START_TEST(test_shut_down_waits_for_none_of_them)
{
    start();
    enable_both();
    go(LINE, CM1E_COMMAND_MOVE_VELOCITY, 0.0, 10.0);
    cycles(500);
    int n = 0;
    for (bool down = false; !down && n < 2000; n++) {
        inputs();
        down = true;
        for (int i = 0; i < AXES; i++)
            down &= cm1e_axis_shut_down(axes[i]);
        outputs();
    }
    ck_assert_int_lt(n, 1000);
    ck_assert_double_eq(info_of(LINE).actual_velocity, 0.0);
    close_segment();
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("axes without a motor");
    TCase *cases = tcase_create("axes");
    tcase_set_timeout(cases, 120);
    tcase_add_test(cases, test_virtual_axis_moves_beside_a_motor_and_has_no_lag);
    tcase_add_test(cases, test_virtual_axis_ramps_down_when_it_is_stopped_and_when_its_power_goes);
    tcase_add_test(cases, test_virtual_axis_fails_at_its_limits_and_is_reset);
    tcase_add_test(cases, test_virtual_axis_goes_on_when_the_motor_is_lost);
    tcase_add_test(cases, test_positions_of_a_virtual_axis_are_set);
    tcase_add_test(cases, test_what_needs_a_motor_is_refused_in_words);
    tcase_add_test(cases, test_a_segment_of_virtual_axes_only_runs);
    tcase_add_test(cases, test_fast_virtual_axis_passes_the_end_of_32_bits);
    tcase_add_test(cases, test_encoder_is_where_the_program_says_over_the_end_of_its_counter);
    tcase_add_test(cases, test_encoder_that_is_not_written_is_offline_and_comes_back_where_it_is);
    tcase_add_test(cases, test_encoder_is_never_enabled_nor_moved);
    tcase_add_test(cases, test_motor_follows_a_virtual_axis);
    tcase_add_test(cases, test_motor_follows_an_encoder_that_is_lost_for_some_cycles);
    tcase_add_test(cases, test_shut_down_waits_for_none_of_them);
    suite_add_tcase(suite, cases);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
