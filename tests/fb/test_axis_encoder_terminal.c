/* An encoder whose counts a terminal brings, as master of a motor. */
#include "axis/axis_signals.h"
#include "cm1e/io.h"
#include "wired_machine.h"

static int64_t counted;

static void count_on(int64_t by)
{
    cm1e_io_t io;
    ck_assert_int_eq(cm1e_io_find(bus, "counts.output 1", &io, &diag), CM1E_OK);
    counted += by;
    ck_assert_int_eq(cm1e_io_set_integer(&io, (int16_t)(uint16_t)counted), CM1E_OK);
    cycles(1);
}

/* 16 bits wrap every 655 turns of this loop; the axis counts on. */
START_TEST(test_an_encoder_terminal_counts_over_the_end_of_its_bits)
{
    begin();
    counted = 0;
    const double start = info_of(WHEEL).actual_position;
    const int way = _i == 0 ? 100 : -100;
    for (int n = 0; n < 2000; n++)
        count_on(way);
    count_on(0);
    cycles(10);
    ck_assert(info_of(WHEEL).online);
    ck_assert_double_eq_tol(info_of(WHEEL).actual_position - start, 2000.0 * way / 1000.0, 1e-9);
    ck_assert_int_eq(cm1e_axis_power(axes[WHEEL], &owner, true, true, true), CM1E_ERROR_AXIS_VIRTUAL);
    ck_assert_int_eq(cm1e_axis_write_encoder(wheel, 0, true), CM1E_ERROR_UNSUPPORTED);
    close_segment();
}
END_TEST

/* The counts come in steps of a whole one, twice in three cycles; the velocity shown is even. */
START_TEST(test_the_velocity_of_an_encoder_terminal_is_smooth)
{
    begin();
    counted = 0;
    double least = INFINITY, most = -INFINITY;
    for (int n = 0; n < 600; n++) {
        count_on(n % 3 == 0 ? 0 : 1);
        if (n < 300)
            continue;
        least = fmin(least, info_of(WHEEL).actual_velocity);
        most = fmax(most, info_of(WHEEL).actual_velocity);
    }
    const double middle = 2.0 / 3.0;
    ck_assert_double_le(most - least, 0.35 * middle); /* the differences of counts are 0 and 1 u/s */
    ck_assert_double_eq_tol(0.5 * (most + least), middle, 0.05 * middle);
    close_segment();
}
END_TEST

static void couple(void)
{
    cm1e_command_id_t id;
    const cm1e_axis_coupling_t gear = {
        .master = {{.axis = wheel, .source = mcActualValue, .numerator = 1, .denominator = 10}}};
    const cm1e_axis_command_t c = {.kind = CM1E_COMMAND_GEAR_IN, .coupling = &gear};
    ck_assert_msg(cm1e_axis_start(axes[MOTOR], &c, &id) == CM1E_OK, "%s", text_of(MOTOR));
}

START_TEST(test_a_motor_follows_an_encoder_terminal)
{
    begin();
    enable_motor();
    counted = 0;
    count_on(0);
    couple();
    double before = 0.0, start_wheel = 0.0, start_motor = 0.0;
    for (int n = 0; n < 2000; n++) {
        count_on(n < 1000 ? n / 20 : 50);
        const double velocity = info_of(MOTOR).set_velocity;
        ck_assert_msg(info_of(MOTOR).state == CM1E_AXIS_SYNCHRONIZED_MOTION, "%d: %s", n, text_of(MOTOR));
        ck_assert_double_le(fabs(velocity - before), 0.05);
        before = velocity;
        if (n == 1500) {
            start_wheel = info_of(WHEEL).actual_position;
            start_motor = info_of(MOTOR).set_position;
        }
    }
    ck_assert_double_eq_tol(before, 5.0, 1e-3);
    ck_assert_double_eq_tol(info_of(MOTOR).set_position - start_motor,
                            (info_of(WHEEL).actual_position - start_wheel) / 10.0, 2e-3);
    close_segment();
}
END_TEST

/* A jump of the counts, and a terminal that is away, are no motion of the master: its slave stops with its own ramp. */
START_TEST(test_a_jump_of_the_counts_stops_the_slave_and_never_moves_it)
{
    static const int jumps[] = {5000, -5000, 30000, 0};
    begin();
    enable_motor();
    counted = 0;
    count_on(0);
    couple();
    for (int n = 0; n < 1000; n++)
        count_on(n < 400 ? n / 20 : 20);
    double before = info_of(MOTOR).set_velocity;
    ck_assert_msg(fabs(before - 2.0) < 0.05, "%s", text_of(MOTOR));
    if (jumps[_i] == 0)
        fall_back(COUNTER);
    for (int n = 0; n < BACK; n++) {
        count_on(n == 0 && jumps[_i] ? jumps[_i] : 20);
        const double velocity = info_of(MOTOR).set_velocity;
        ck_assert_msg(fabs(velocity - before) <= 0.101, "cycle %d: %f after %f", n, velocity, before);
        ck_assert_double_le(velocity, 2.2);
        ck_assert_double_ge(velocity, -0.2);
        before = velocity;
    }
    ck_assert_int_eq(info_of(MOTOR).state, CM1E_AXIS_ERROR_STOP);
    ck_assert_int_eq(info_of(MOTOR).error, CM1E_ERROR_AXIS_MASTER_LOST);
    ck_assert_double_eq(before, 0.0);
    ck_assert(info_of(WHEEL).online); /* it counts on from where it is */
    const double from = info_of(WHEEL).actual_position;
    for (int n = 0; n < 100; n++)
        count_on(20);
    ck_assert_double_eq_tol(info_of(WHEEL).actual_position - from, 2.0, 0.05);
    close_segment();
}
END_TEST

/* A touch probe of the encoder itself, on a bit of a terminal; and a cam switch by it. */
START_TEST(test_a_touch_probe_and_a_cam_switch_of_an_encoder)
{
    begin();
    counted = 0;
    for (int n = 0; n < 100; n++)
        count_on(10);
    const double start = info_of(WHEEL).actual_position;
    const MC_TRIGGER_REF trigger = {.InputNumber = 11};
    MC_TouchProbe_t fb = {.Axis = &wheel, .TriggerInput = &trigger, .Execute = TRUE};
    const MC_CAMSWITCH_REF switches = {
        .NumberOfSwitches = 1,
        .Switches = {{.TrackNumber = 1, .FirstOnPosition = start + 0.5, .LastOnPosition = start + 1.5}}};
    MC_OUTPUT_REF outputs_of = {.Axis = line, .Number = GLUE};
    MC_DigitalCamSwitch_t cam = {.Axis = &wheel, .Switches = &switches, .Outputs = &outputs_of, .Enable = TRUE,
                                 .EnableMask = 1, .ValueSource = mcActualValue};
    int on = 0;
    for (int n = 0; n < 300; n++) {
        MC_TouchProbe(&fb);
        MC_DigitalCamSwitch(&cam);
        ck_assert(cam.InOperation);
        on += sent("valves.output 3");
        if (n == 200)
            set_input(5, true);
        count_on(10);
    }
    ck_assert(fb.Done);
    ck_assert_double_eq_tol(fb.RecordedPosition, start + 2.0, 0.04);
    ck_assert_int_ge(on, 98);
    ck_assert_int_le(on, 102);
    close_segment();
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("encoder terminal");
    TCase *tests = tcase_create("wiring");
    tcase_set_timeout(tests, 120);
    tcase_add_loop_test(tests, test_an_encoder_terminal_counts_over_the_end_of_its_bits, 0, 2);
    tcase_add_test(tests, test_the_velocity_of_an_encoder_terminal_is_smooth);
    tcase_add_test(tests, test_a_motor_follows_an_encoder_terminal);
    tcase_add_loop_test(tests, test_a_jump_of_the_counts_stops_the_slave_and_never_moves_it, 0, 4);
    tcase_add_test(tests, test_a_touch_probe_and_a_cam_switch_of_an_encoder);
    suite_add_tcase(suite, tests);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_NORMAL);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
