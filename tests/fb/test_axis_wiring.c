/* Inputs and outputs of axes on the bits of other slaves: digital inputs and outputs, touch probes, cam switches, and
 * what is refused. */
#include "axis/axis_signals.h"
#include "cm1e/io.h"
#include "wired_machine.h"

/* ---- inputs and outputs ------------------------------------------------------------------------------------------ */

START_TEST(test_inputs_of_another_slave_are_read_by_their_number)
{
    begin();
    const MC_INPUT_REF input = {.Axis = motor, .Number = PART};
    MC_ReadDigitalInput_t fb = {.Input = &input, .Enable = TRUE};
    for (int number = HOME; number <= PART; number++)
        for (int on = 1; on >= 0; on--) {
            set_input(number - HOME + 1, on);
            cycles(3);
            fb.InputNumber = (INT)number;
            MC_ReadDigitalInput(&fb);
            ck_assert_msg(fb.Valid && !fb.Error && fb.Value == on, "input %d: %u", number, fb.ErrorID);
        }
    fb.InputNumber = PART + 1;
    MC_ReadDigitalInput(&fb);
    ck_assert(!fb.Valid && fb.Error && fb.ErrorID == id_of(CM1E_ERROR_AXIS_SIGNAL));
    fb.InputNumber = 1; /* that of the motor itself */
    MC_ReadDigitalInput(&fb);
    ck_assert(fb.Valid && !fb.Error);
    close_segment();
}
END_TEST

/* A frame that is lost keeps the value, a slave that is away is an error, and it comes back by itself. */
START_TEST(test_an_input_whose_slave_is_away_is_an_error_until_it_is_back)
{
    begin();
    const MC_INPUT_REF input = {.Axis = motor, .Number = HOME};
    MC_ReadDigitalInput_t fb = {.Input = &input, .Enable = TRUE};
    set_input(1, true);
    cycles(3);
    simulate("lose 1");
    for (int n = 0; n < 4; n++) {
        cycles(1);
        MC_ReadDigitalInput(&fb);
        ck_assert(fb.Valid && fb.Value);
    }
    take_away(SWITCHES, 50);
    int away = 0, first = -1;
    for (int n = 0; n < BACK; n++) {
        cycles(1);
        MC_ReadDigitalInput(&fb);
        ck_assert(fb.Valid != fb.Error);
        away += fb.Error;
        if (fb.Error && first < 0)
            first = n;
        ck_assert(!fb.Error || (fb.ErrorID == id_of(CM1E_ERROR_AXIS_SIGNAL_AWAY) && !fb.Value));
    }
    ck_assert_int_le(first, LOST_CYCLES + 2);
    ck_assert_int_gt(away, 40);
    ck_assert_int_lt(away, BACK - 10);
    ck_assert(fb.Valid && fb.Value);
    close_segment();
}
END_TEST

static void write(MC_WriteDigitalOutput_t *fb, BOOL value, cm1e_error_t expected)
{
    fb->Execute = FALSE;
    MC_WriteDigitalOutput(fb);
    fb->Value = value;
    fb->Execute = TRUE;
    MC_WriteDigitalOutput(fb);
    ck_assert_uint_eq(fb->ErrorID, id_of(expected));
    cycles(1);
    MC_WriteDigitalOutput(fb);
    ck_assert(fb->Done == (expected == CM1E_OK) && fb->Error == (expected != CM1E_OK));
}

/* A block that asks again and again has told once what is wrong. What it told goes when it can be done. */
START_TEST(test_what_was_wrong_with_a_number_is_not_told_any_more_when_it_is_right)
{
    begin();
    const MC_INPUT_REF input = {.Axis = motor};
    const MC_OUTPUT_REF output = {.Axis = motor};
    MC_ReadDigitalInput_t in = {.Input = &input, .Enable = TRUE};
    MC_ReadDigitalOutput_t out = {.Output = &output, .Enable = TRUE};
    for (int right = 0; right < 2; right++) {
        in.InputNumber = right ? PART : PART + 1;
        MC_ReadDigitalInput(&in);
        ck_assert_msg(in.Error == !right && (text_of(MOTOR)[0] == 0) == right, "input: %s", text_of(MOTOR));
    }
    for (int right = 0; right < 2; right++) {
        out.OutputNumber = right ? BLOWER : BLOWER + 1;
        MC_ReadDigitalOutput(&out);
        ck_assert_msg(out.Error == !right && (text_of(MOTOR)[0] == 0) == right, "output: %s", text_of(MOTOR));
    }
    close_segment();
}
END_TEST

START_TEST(test_outputs_of_another_slave_are_written_by_their_number)
{
    begin();
    const MC_OUTPUT_REF output = {.Axis = motor, .Number = BLOWER}, of_line = {.Axis = line, .Number = GLUE};
    MC_WriteDigitalOutput_t fb = {.Output = &output}, second = {.Output = &of_line};
    MC_ReadDigitalOutput_t shown = {.Output = &output, .Enable = TRUE};
    write(&fb, TRUE, CM1E_OK);
    write(&second, TRUE, CM1E_OK); /* an axis without a motor may have them too */
    ck_assert(sent("valves.output 2") && sent("valves.output 3") && !sent("valves.output 1"));
    MC_ReadDigitalOutput(&shown);
    ck_assert(shown.Valid && shown.Value);
    take_away(VALVES, 200);
    cycles(40); /* it has no inputs that would be missing, so only the supervision tells */
    write(&fb, TRUE, CM1E_ERROR_AXIS_SIGNAL_AWAY);
    ck_assert_msg(strstr(text_of(MOTOR), "valves.output 2"), "%s", text_of(MOTOR));
    MC_ReadDigitalOutput(&shown);
    ck_assert(!shown.Valid && shown.Error && shown.ErrorID == id_of(CM1E_ERROR_AXIS_SIGNAL_AWAY));
    cycles(BACK);
    MC_ReadDigitalOutput(&shown);
    ck_assert_msg(shown.Valid && !shown.Value, "it is safe behind the loss, and stays so");
    write(&fb, TRUE, CM1E_OK);
    fb.OutputNumber = BLOWER + 1;
    write(&fb, TRUE, CM1E_ERROR_AXIS_SIGNAL);
    close_segment();
}
END_TEST

/* ---- touch probes ------------------------------------------------------------------------------------------------ */

/* The edge is put in the middle of the two exchanges, so it is at most half a cycle's way from where the sensor was in
 * the frame before the one that brought it. */
START_TEST(test_a_touch_probe_on_another_slave_captures_the_position_of_its_exchange)
{
    begin();
    enable_motor();
    go(5.0);
    cycles(500);
    const MC_TRIGGER_REF trigger = {.InputNumber = PART, .FallingEdge = _i == 1};
    set_input(4, _i == 1);
    cycles(3);
    MC_TouchProbe_t fb = {.Axis = &motor, .TriggerInput = &trigger, .Execute = TRUE};
    MC_TouchProbe(&fb);
    cycles(20);
    MC_TouchProbe(&fb);
    ck_assert(fb.Busy && !fb.Done);
    set_input(4, _i == 0);
    const double before = info_of(MOTOR).actual_position;
    for (int n = 0; n < 5 && !fb.Done; n++) {
        cycles(1);
        MC_TouchProbe(&fb);
    }
    ck_assert(fb.Done);
    ck_assert_double_eq_tol(fb.Uncertainty, 0.0025, 2e-4);
    ck_assert_double_ge(fb.RecordedPosition, before);
    ck_assert_double_le(fb.RecordedPosition, before + 2.5 * 0.005);
    close_segment();
}
END_TEST

/* An edge while the slave was away has no position. One that comes later has. */
START_TEST(test_an_edge_while_the_slave_was_away_is_an_error)
{
    begin();
    enable_motor();
    go(1.0);
    const MC_TRIGGER_REF trigger = {.InputNumber = PART};
    MC_TouchProbe_t fb = {.Axis = &motor, .TriggerInput = &trigger, .Execute = TRUE};
    MC_TouchProbe(&fb);
    take_away(SWITCHES, 50);
    cycles(20);
    if (_i == 0)
        set_input(4, true);
    cycles(BACK);
    MC_TouchProbe(&fb);
    ck_assert(_i == 0 ? fb.Error && fb.ErrorID == id_of(CM1E_ERROR_AXIS_PROBE) : fb.Busy);
    set_input(4, true);
    cycles(5);
    MC_TouchProbe(&fb);
    ck_assert(_i == 0 ? fb.Error : fb.Done);
    take_away(SWITCHES, 50);
    cycles(10);
    MC_TouchProbe_t late = {.Axis = &motor, .TriggerInput = &trigger, .Execute = TRUE};
    MC_TouchProbe(&late);
    ck_assert(late.Error && late.ErrorID == id_of(CM1E_ERROR_AXIS_SIGNAL_AWAY));
    close_segment();
}
END_TEST

/* ---- cam switches ------------------------------------------------------------------------------------------------ */

START_TEST(test_a_cam_switch_writes_each_track_to_its_output)
{
    begin();
    enable_motor();
    const MC_CAMSWITCH_REF switches = {
        .NumberOfSwitches = 2,
        .Switches = {{.TrackNumber = 1, .FirstOnPosition = 1.0, .LastOnPosition = 2.0},
                     {.TrackNumber = 2, .FirstOnPosition = 1.5, .LastOnPosition = 3.0}}};
    MC_OUTPUT_REF outputs_of = {.Axis = motor, .Number = GLUE};
    MC_DigitalCamSwitch_t fb = {.Axis = &motor, .Switches = &switches, .Outputs = &outputs_of, .Enable = TRUE,
                                .EnableMask = 3, .ValueSource = mcSetValue};
    const double start = info_of(MOTOR).set_position;
    ck_assert_double_eq_tol(start, 0.0, 1e-3);
    go(2.0);
    for (int n = 0; n < 1800; n++) {
        inputs();
        MC_DigitalCamSwitch(&fb);
        ck_assert_msg(fb.InOperation, "%x", fb.ErrorID);
        ck_assert_uint_eq(sent("valves.output 1"), outputs_of.Values & 1);
        ck_assert_uint_eq(sent("valves.output 2"), outputs_of.Values >> 1 & 1);
        const double at = info_of(MOTOR).set_position;
        if (fabs(at - 1.7) < 0.1)
            ck_assert_uint_eq(outputs_of.Values, 3);
        outputs();
    }
    ck_assert_uint_eq(outputs_of.Values, 0);
    close_segment();
}
END_TEST

/* The outputs go off when the block is not called any more, and when one of them cannot be written. */
START_TEST(test_cam_outputs_go_off_without_calls_and_with_an_error)
{
    begin();
    enable_motor();
    const MC_CAMSWITCH_REF switches = {
        .NumberOfSwitches = 2,
        .Switches = {{.TrackNumber = 1, .FirstOnPosition = -1.0, .LastOnPosition = 2.0},
                     {.TrackNumber = (INT)(_i == 0 ? 2 : 3), .FirstOnPosition = -1.0, .LastOnPosition = 3.0}}};
    MC_OUTPUT_REF outputs_of = {.Axis = motor, .Number = GLUE};
    MC_DigitalCamSwitch_t fb = {.Axis = &motor, .Switches = &switches, .Outputs = &outputs_of, .Enable = TRUE,
                                .EnableMask = 7, .ValueSource = mcSetValue};
    for (int n = 0; n < 50; n++) {
        inputs();
        MC_DigitalCamSwitch(&fb);
        ck_assert_uint_eq(fb.ErrorID, _i == 0 ? 0 : id_of(CM1E_ERROR_AXIS_SIGNAL)); /* there is no output 13 */
        ck_assert_uint_eq(sent("valves.output 1"), _i == 0);
        ck_assert_uint_eq(sent("valves.output 2"), _i == 0);
        ck_assert_msg(_i == 0 || strstr(text_of(MOTOR), "digital output 13 was not written"), "%d: %s", n, text_of(MOTOR));
        outputs();
    }
    cycles(150);
    ck_assert(!sent("valves.output 1") && !sent("valves.output 2"));
    close_segment();
}
END_TEST

/* ---- what cannot be --------------------------------------------------------------------------------------------- */

static void expect_refused(const char *words)
{
    memset(&diag, 0, sizeof diag);
    cm1e_error_t error = cm1e_bus_open(&bus, &config, &diag);
    if (error == CM1E_OK) {
        ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
        for (uint32_t i = 0; i < config.axis_count && error == CM1E_OK; i++)
            error = cm1e_axis_create(&axes[i], bus, i, &diag);
        for (uint32_t i = 0; i < config.axis_count; i++) {
            cm1e_axis_destroy(axes[i]);
            axes[i] = NULL;
        }
        cm1e_bus_close(bus);
    }
    ck_assert(error != CM1E_OK);
    ck_assert_msg(strstr(diag.text, words), "%s", diag.text);
}

/* A signal without a type may have any number of bits. A count has at most 64. */
START_TEST(test_a_count_of_more_than_64_bits_is_refused)
{
    describe_machine();
    cm1e_slave_config_t *wide = add_slave("wide", CM1E_SIM_SLAVE_ANALOG, 8, 0);
    wide->signals[0] = (cm1e_signal_config_t){.name = "long", .type_stated = true, .type = CM1E_IO_BYTES, .bits = 65};
    wide->signal_count = 1;
    snprintf(config.axes[WHEEL].wiring.encoder, CM1E_SIGNAL_LENGTH, "wide.long");
    expect_refused("is no counter");
}
END_TEST

START_TEST(test_wrong_signals_are_refused_in_words)
{
    static const struct {
        int axis;
        enum { INPUT, OUTPUT, ENCODER } what;
        const char *name, *words;
    } wrong[] = {
        {MOTOR, INPUT, "switches.input 9", "has no signal \"input 9\""},
        {MOTOR, INPUT, "valves.output 4", "\"valves.output 4\" is an output of its slave"},
        {MOTOR, INPUT, "counter.input 1", "has more than one bit"},
        {MOTOR, OUTPUT, "switches.input 8", "\"switches.input 8\" is an input of its slave"},
        {WHEEL, ENCODER, "switches.input 8", "is no counter"},
        {LINE, OUTPUT, "VALVES.OUTPUT 1", "which axis 1 of the list has too"},
        {LINE, OUTPUT, "2.output 3", "expected the name of a slave of the list"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        describe_machine();
        cm1e_axis_config_t *of = &config.axes[wrong[i].axis];
        char *name = wrong[i].what == INPUT ? of->wiring.inputs[0]
                     : wrong[i].what == OUTPUT ? of->wiring.outputs[0] : of->wiring.encoder;
        snprintf(name, CM1E_SIGNAL_LENGTH, "%s", wrong[i].name);
        expect_refused(wrong[i].words);
    }
    describe_machine();
    config.axes[WHEEL].max_velocity = 0.0;
    expect_refused("encoder_signal needs limits.velocity");
    describe_machine();
    config.axes[MOTOR].inputs.home = PART + 1;
    expect_refused("inputs.home is 15");
}
END_TEST

/* As `cm1e io list` shows it: each signal of another slave with all axes that use it. */
START_TEST(test_the_use_of_each_signal_is_told)
{
    static const struct {
        unsigned slave, number;
        const char *use;
    } used[] = {
        {VALVES, 1, "axis1: output 11"}, {VALVES, 2, "axis1: output 12"}, {VALVES, 3, "axis3: output 11"},
        {SWITCHES, 1, "axis1: input 11, home switch"},
        {SWITCHES, 2, "axis1: input 12, positive limit switch (normally closed)"},
        {SWITCHES, 3, "axis1: input 13, negative limit switch (normally closed)"},
        {SWITCHES, 4, "axis1: input 14; axis3: input 11"}, {SWITCHES, 5, "axis2: input 11"},
        {COUNTER, 1, "axis2: encoder"},
    };
    enum { USED = sizeof used / sizeof used[0] };
    unsigned seen = 0;
    cm1e_io_info_t info;
    describe_machine();
    config.axes[MOTOR].inputs.limits_normally_closed = true;
    config.axes[LINE].wiring.input_count = 1;
    snprintf(config.axes[LINE].wiring.inputs[0], CM1E_SIGNAL_LENGTH, "switches.input 4");
    open_segment();
    for (uint32_t n = 0; cm1e_io_at(bus, n, &info); n++) {
        char use[100];
        const char *expected = "";
        for (size_t i = 0; i < USED; i++)
            if (info.position == used[i].slave && info.number == used[i].number) {
                expected = used[i].use;
                seen++;
            }
        ck_assert_int_eq(cm1e_io_use(bus, &info, use, sizeof use), expected[0] != '\0');
        ck_assert_str_eq(use, expected);
    }
    ck_assert_uint_eq(seen, USED);
    close_segment();
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("axis wiring");
    TCase *tests = tcase_create("wiring");
    tcase_set_timeout(tests, 120);
    tcase_add_test(tests, test_inputs_of_another_slave_are_read_by_their_number);
    tcase_add_test(tests, test_an_input_whose_slave_is_away_is_an_error_until_it_is_back);
    tcase_add_test(tests, test_what_was_wrong_with_a_number_is_not_told_any_more_when_it_is_right);
    tcase_add_test(tests, test_outputs_of_another_slave_are_written_by_their_number);
    tcase_add_loop_test(tests, test_a_touch_probe_on_another_slave_captures_the_position_of_its_exchange, 0, 2);
    tcase_add_loop_test(tests, test_an_edge_while_the_slave_was_away_is_an_error, 0, 2);
    tcase_add_test(tests, test_a_cam_switch_writes_each_track_to_its_output);
    tcase_add_loop_test(tests, test_cam_outputs_go_off_without_calls_and_with_an_error, 0, 2);
    tcase_add_test(tests, test_a_count_of_more_than_64_bits_is_refused);
    tcase_add_test(tests, test_wrong_signals_are_refused_in_words);
    tcase_add_test(tests, test_the_use_of_each_signal_is_told);
    suite_add_tcase(suite, tests);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_NORMAL);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
