/* Inputs and outputs of axes on other slaves' bits, and an encoder whose counts a terminal brings: on the simulated
 * segment, with terminals beside the motor that go away and come back. */
#include "axis/axis_signals.h"
#include "axis_segment.h"
#include "cm1e/io.h"
#include "cm1e/plcopen.h"
#include "effort.h"
#include "sim/esc_chip.h"
#include "sim/segment.h"
#undef axis

enum { MOTOR = 0, WHEEL, LINE, AXES };                         /* axes */
enum { SLAVE_MOTOR = 1, VALVES, SWITCHES, COUNTS, COUNTER };   /* slaves */
enum { HOME = 11, LIMIT_POSITIVE, LIMIT_NEGATIVE, PART };      /* inputs of the motor's axis */
enum { GLUE = 11, BLOWER };                                    /* its outputs */
enum { LOST_CYCLES = 3, BACK = 3000 };

static AXIS_REF_t motor, wheel, line;

static cm1e_slave_config_t *add_slave(const char *name, cm1e_sim_slave_kind_t kind, unsigned in, unsigned out)
{
    cm1e_slave_config_t *slave = cm1e_bus_config_add_slave(&config, name);
    slave->address = (uint16_t)(SLAVE_MOTOR + config.slave_count);
    slave->sim = (cm1e_sim_slave_config_t){.kind = kind, .inputs = (uint8_t)in, .outputs = (uint8_t)out};
    return slave;
}

static void name_input(cm1e_axis_config_t *of, const char *name)
{
    snprintf(of->wiring.inputs[of->wiring.input_count++], CM1E_SIGNAL_LENGTH, "%s", name);
}

static void name_output(cm1e_axis_config_t *of, const char *name)
{
    snprintf(of->wiring.outputs[of->wiring.output_count++], CM1E_SIGNAL_LENGTH, "%s", name);
}

static void describe_machine(void)
{
    describe("1.3.5", CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, 1000000);
    config.lost_cycles_limit = LOST_CYCLES;
    describe_up_to(AXES);
    cm1e_axis_config_t *of = &config.axes[MOTOR];
    of->address = SLAVE_MOTOR;
    of->sim.no_stops = of->sim.no_sensors = true;
    for (int n = 1; n <= 4; n++) {
        char name[CM1E_SIGNAL_LENGTH];
        snprintf(name, sizeof name, "switches.input %d", n);
        name_input(of, name);
    }
    name_output(of, "valves.output 1");
    name_output(of, "valves.output 2");
    of->inputs = (cm1e_input_config_t){.home = HOME, .limit_positive = LIMIT_POSITIVE,
                                       .limit_negative = LIMIT_NEGATIVE};
    config.axes[WHEEL].type = CM1E_AXIS_ENCODER;
    config.axes[WHEEL].counts_per_unit = 1000.0;
    config.axes[WHEEL].max_velocity = 200.0; /* 200 counts in a cycle */
    snprintf(config.axes[WHEEL].wiring.encoder, CM1E_SIGNAL_LENGTH, "counter.input 1");
    name_input(&config.axes[WHEEL], "switches.input 5");
    config.axes[LINE].type = CM1E_AXIS_VIRTUAL;
    name_output(&config.axes[LINE], "valves.output 3");
    add_slave("valves", CM1E_SIM_SLAVE_DIGITAL, 0, 4);
    add_slave("switches", CM1E_SIM_SLAVE_DIGITAL, 8, 0);
    add_slave("counts", CM1E_SIM_SLAVE_ANALOG, 0, 1);
    cm1e_slave_config_t *counter = add_slave("counter", CM1E_SIM_SLAVE_ANALOG, 1, 0);
    counter->inputs_pdos[0] = 0x1A01; /* the value alone: 16 bits */
    counter->inputs_pdo_count = 1;
    snprintf(counter->sim.wired_to, sizeof counter->sim.wired_to, "counts");
}

static void take_references(void)
{
    motor = cm1e_axis_reference(axes[MOTOR]);
    wheel = cm1e_axis_reference(axes[WHEEL]);
    line = cm1e_axis_reference(axes[LINE]);
}

static void begin(void)
{
    describe_machine();
    open_segment();
    take_references();
    cycles(300);
}

static void enable_motor(void)
{
    ck_assert_int_eq(cm1e_axis_power(axes[MOTOR], &owner, true, true, true), CM1E_OK);
    cycles(300);
    ck_assert_msg(info_of(MOTOR).state == CM1E_AXIS_STANDSTILL, "%s", text_of(MOTOR));
}

static void set_input(int number, bool on)
{
    char words[40];
    snprintf(words, sizeof words, "input %d %d %s", SWITCHES, number, on ? "on" : "off");
    simulate(words);
}

/* The terminal is switched off and comes back by itself. */
static void take_away(unsigned slave, unsigned ms)
{
    char words[40];
    snprintf(words, sizeof words, "power-cycle %u %u", slave, ms);
    simulate(words);
}

/* The slave falls back to Safe-Operational, where its inputs go on to come. They are those of a slave that is not what
 * the program expects: they count as away. The bus brings it back. A terminal with device emulation does it by a stray
 * request alone. */
static void fall_back(unsigned position)
{
    static const uint8_t safe_op[] = {CM1E_AL_SAFE_OP, 0};
    cm1e_sim_slave_t *slave = cm1e_sim_segment_slave(cm1e_bus_segment(bus), position);
    if (position == SWITCHES)
        ck_assert(cm1e_sim_esc_write(slave, ESC_AL_CONTROL, safe_op, sizeof safe_op));
    else
        cm1e_sim_slave_fall_back(slave, CM1E_AL_SAFE_OP, 0x001B);
}

static WORD id_of(cm1e_error_t error) { return cm1e_error_id(error); }

static bool sent(const char *name)
{
    cm1e_io_t io;
    ck_assert_msg(cm1e_io_find(bus, name, &io, &diag) == CM1E_OK, "%s", diag.text);
    return cm1e_io_bool(&io);
}

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

/* ---- switches ---------------------------------------------------------------------------------------------------- */

static MC_ReadAxisInfo_t axis_info(void)
{
    MC_ReadAxisInfo_t fb = {.Axis = &motor, .Enable = TRUE};
    MC_ReadAxisInfo(&fb);
    ck_assert(fb.Valid);
    return fb;
}

START_TEST(test_a_limit_switch_whose_slave_is_away_is_pressed_a_home_switch_is_not)
{
    begin();
    MC_ReadAxisInfo_t fb = axis_info();
    ck_assert(!fb.HomeAbsSwitch && !fb.LimitSwitchPos && !fb.LimitSwitchNeg);
    for (int n = 1; n <= 3; n++)
        set_input(n, true);
    cycles(3);
    fb = axis_info();
    ck_assert(fb.HomeAbsSwitch && fb.LimitSwitchPos && fb.LimitSwitchNeg);
    for (int n = 1; n <= 3; n++)
        set_input(n, false);
    cycles(3);
    take_away(SWITCHES, 50);
    cycles(LOST_CYCLES + 3);
    fb = axis_info();
    ck_assert(!fb.HomeAbsSwitch && fb.LimitSwitchPos && fb.LimitSwitchNeg);
    cycles(BACK);
    fb = axis_info();
    ck_assert(!fb.HomeAbsSwitch && !fb.LimitSwitchPos && !fb.LimitSwitchNeg);
    close_segment();
}
END_TEST

static MC_StepAbsoluteSwitch_t search(void)
{
    return (MC_StepAbsoluteSwitch_t){.Axis = &motor, .Direction = mcPositiveDirection, .SwitchMode = mcRisingEdge,
                                     .Velocity = 2.0, .SetPosition = 10.0};
}

/* u, of the simulated motor itself. */
static double shaft(void) { return probe_of(MOTOR).position_counts / 50000.0; }

/* The switch is 1 u from the start. It is found there, to the way of a few cycles: that of the frame and of the
 * terminal. */
START_TEST(test_homing_by_a_switch_of_another_slave)
{
    const double place = 1.0;
    begin();
    enable_motor();
    MC_StepAbsoluteSwitch_t fb = search();
    fb.Execute = TRUE;
    const double start = shaft();
    double at = NAN;
    for (int n = 0; n < 3000 && !fb.Done; n++) {
        const double way = shaft() - start;
        if (isnan(at) && way >= place)
            at = way;
        set_input(1, way >= place);
        MC_StepAbsoluteSwitch(&fb);
        ck_assert_msg(!fb.Error, "%s", text_of(MOTOR));
        cycles(1);
    }
    ck_assert(fb.Done);
    const double now = shaft() - start;
    ck_assert_double_eq_tol(info_of(MOTOR).actual_position - 10.0, now - place, 2.0 * 0.004);
    close_segment();
}
END_TEST

static double most_step(double *before)
{
    const double velocity = info_of(MOTOR).set_velocity, step = fabs(velocity - *before);
    *before = velocity;
    return step;
}

/* A search at which the terminal goes away in cycle `at`. It ends with an error, and at rest, by a ramp. */
static void search_without(MC_StepAbsoluteSwitch_t *fb, int at, bool off)
{
    double before = info_of(MOTOR).set_velocity;
    fb->Execute = TRUE;
    for (int n = 0; n < 1500 && !fb->Error; n++) {
        if (n == at && off)
            take_away(SWITCHES, 50);
        else if (n == at)
            fall_back(SWITCHES);
        MC_StepAbsoluteSwitch(fb);
        ck_assert(!fb->Done);
        cycles(1);
        const double step = most_step(&before);
        ck_assert(off || step <= 0.101); /* 5,000,000 counts/s2 are 0.1 u/s a cycle */
        ck_assert_double_ge(before, 0.0);
        ck_assert_double_le(before, 2.0 + 1e-9);
    }
    for (int n = 0; n < 100; n++) {
        cycles(1);
        const double step = most_step(&before);
        ck_assert(off || step <= 0.101);
    }
    ck_assert_double_eq(before, 0.0);
}

/* Wherever the terminal leaves Operational, the search stops with its own ramp and an error in words. */
START_TEST(test_homing_stops_when_the_slave_of_its_switch_leaves_operational)
{
    const int stride = sweep_stride(40, 80);
    for (int at = sweep_first(1, stride); at < 400; at += stride) {
        begin();
        enable_motor();
        MC_StepAbsoluteSwitch_t fb = search();
        search_without(&fb, at, false);
        ck_assert_uint_eq(fb.ErrorID, id_of(CM1E_ERROR_AXIS_SIGNAL_AWAY));
        ck_assert_int_eq(info_of(MOTOR).state, CM1E_AXIS_HOMING);
        ck_assert_msg(strstr(text_of(MOTOR), "switches.input 1") && strstr(text_of(MOTOR), "switches.input 2"), "%s",
                      text_of(MOTOR));
        close_segment();
    }
}
END_TEST

/* It does not begin while the slave is away. When the slave is back, it does. */
START_TEST(test_homing_does_not_begin_without_its_switch)
{
    begin();
    enable_motor();
    fall_back(SWITCHES);
    cycles(7);
    MC_StepAbsoluteSwitch_t fb = search();
    fb.Execute = TRUE;
    MC_StepAbsoluteSwitch(&fb);
    ck_assert_uint_eq(fb.ErrorID, id_of(CM1E_ERROR_AXIS_SIGNAL_AWAY));
    ck_assert_msg(strstr(text_of(MOTOR), "switches.input 1"), "%s", text_of(MOTOR));
    ck_assert_int_eq(info_of(MOTOR).state, CM1E_AXIS_STANDSTILL);
    fb.Execute = FALSE;
    MC_StepAbsoluteSwitch(&fb);
    cycles(BACK);
    fb.Execute = TRUE;
    MC_StepAbsoluteSwitch(&fb);
    ck_assert_msg(fb.Busy && !fb.Error, "%s", text_of(MOTOR));
    close_segment();
}
END_TEST

/* Without power it takes no part in the working counter, which is an error of all axes with torque. Their time stops in
 * the cycles before that (SAFETY.md). */
START_TEST(test_homing_stops_when_the_slave_of_its_switch_is_switched_off)
{
    begin();
    enable_motor();
    MC_StepAbsoluteSwitch_t fb = search();
    search_without(&fb, 100, true);
    ck_assert_int_eq(info_of(MOTOR).state, CM1E_AXIS_ERROR_STOP);
    ck_assert_msg(strstr(text_of(MOTOR), "working counter"), "%s", text_of(MOTOR));
    close_segment();
}
END_TEST

/* A limit switch ahead that goes away ends the search for the home switch, too. It does not turn it round. */
START_TEST(test_homing_stops_when_only_the_limit_switch_goes_away)
{
    describe_machine();
    snprintf(config.axes[MOTOR].wiring.inputs[0], CM1E_SIGNAL_LENGTH, "more.input 1");
    add_slave("more", CM1E_SIM_SLAVE_DIGITAL, 1, 0);
    open_segment();
    take_references();
    cycles(300);
    enable_motor();
    MC_StepAbsoluteSwitch_t fb = search();
    search_without(&fb, 100, false);
    ck_assert_uint_eq(fb.ErrorID, id_of(CM1E_ERROR_AXIS_SIGNAL_AWAY));
    close_segment();
}
END_TEST

/* An optional terminal that is not plugged in: the axis moves, a homing by its switch does not begin. Without power it
 * stops only that homing, and no other axis fails. */
START_TEST(test_homing_by_a_switch_of_an_optional_slave)
{
    describe_machine();
    cm1e_slave_config_t *more = add_slave("more", CM1E_SIM_SLAVE_DIGITAL, 1, 0);
    more->signals[more->signal_count++] = (cm1e_signal_config_t){.name = "home", .bits = 1};
    snprintf(config.axes[MOTOR].wiring.inputs[0], CM1E_SIGNAL_LENGTH, "more.home");
    more->address_kind = CM1E_ADDRESS_ALIAS;
    more->address = 1001;
    more->vendor = 0x12;
    more->product = 0xD0001;
    more->optional = true;
    more->sim_absent = _i == 0;
    open_segment();
    take_references();
    cycles(300);
    enable_motor();
    MC_StepAbsoluteSwitch_t fb = search();
    fb.Execute = TRUE;
    double before = 0.0;
    for (int n = 0; n < 1000 && !fb.Error; n++) {
        if (n == 100)
            take_away(COUNTER + 1, 500);
        MC_StepAbsoluteSwitch(&fb);
        cycles(1);
        ck_assert_double_le(most_step(&before), 0.101);
    }
    ck_assert_uint_eq(fb.ErrorID, id_of(CM1E_ERROR_AXIS_SIGNAL_AWAY));
    ck_assert_msg(strstr(text_of(MOTOR), "more.home"), "%s", text_of(MOTOR));
    ck_assert_int_eq(info_of(MOTOR).state, _i == 0 ? CM1E_AXIS_STANDSTILL : CM1E_AXIS_HOMING);
    close_segment();
}
END_TEST

/* ---- touch probes ------------------------------------------------------------------------------------------------ */

static cm1e_command_id_t go(double velocity)
{
    cm1e_command_id_t id;
    const cm1e_axis_command_t c = {.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = velocity};
    ck_assert_msg(cm1e_axis_start(axes[MOTOR], &c, &id) == CM1E_OK, "%s", text_of(MOTOR));
    return id;
}

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
        outputs();
    }
    cycles(150);
    ck_assert(!sent("valves.output 1") && !sent("valves.output 2"));
    close_segment();
}
END_TEST

/* ---- an encoder terminal ----------------------------------------------------------------------------------------- */

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

START_TEST(test_wrong_signals_are_refused_in_words)
{
    describe_machine();
    snprintf(config.axes[MOTOR].wiring.inputs[1], CM1E_SIGNAL_LENGTH, "switches.input 9");
    expect_refused("has no signal \"input 9\"");
    describe_machine();
    snprintf(config.axes[MOTOR].wiring.inputs[1], CM1E_SIGNAL_LENGTH, "valves.output 4");
    expect_refused("\"valves.output 4\" is an output of its slave");
    describe_machine();
    snprintf(config.axes[MOTOR].wiring.outputs[1], CM1E_SIGNAL_LENGTH, "switches.input 8");
    expect_refused("\"switches.input 8\" is an input of its slave");
    describe_machine();
    snprintf(config.axes[MOTOR].wiring.inputs[1], CM1E_SIGNAL_LENGTH, "counter.input 1");
    expect_refused("has more than one bit");
    describe_machine();
    snprintf(config.axes[WHEEL].wiring.encoder, CM1E_SIGNAL_LENGTH, "switches.input 8");
    expect_refused("is no counter");
    describe_machine();
    config.axes[WHEEL].max_velocity = 0.0;
    expect_refused("encoder_signal needs limits.velocity");
    describe_machine();
    snprintf(config.axes[LINE].wiring.outputs[0], CM1E_SIGNAL_LENGTH, "VALVES.OUTPUT 1");
    expect_refused("which axis 1 of the list has too");
    describe_machine();
    snprintf(config.axes[LINE].wiring.outputs[0], CM1E_SIGNAL_LENGTH, "2.output 3");
    expect_refused("expected the name of a slave of the list");
    describe_machine();
    config.axes[MOTOR].inputs.home = PART + 1;
    expect_refused("inputs.home is 15");
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("axis wiring");
    TCase *tests = tcase_create("wiring");
    tcase_set_timeout(tests, 120);
    tcase_add_test(tests, test_inputs_of_another_slave_are_read_by_their_number);
    tcase_add_test(tests, test_an_input_whose_slave_is_away_is_an_error_until_it_is_back);
    tcase_add_test(tests, test_outputs_of_another_slave_are_written_by_their_number);
    tcase_add_test(tests, test_a_limit_switch_whose_slave_is_away_is_pressed_a_home_switch_is_not);
    tcase_add_test(tests, test_homing_by_a_switch_of_another_slave);
    tcase_add_test(tests, test_homing_stops_when_the_slave_of_its_switch_leaves_operational);
    tcase_add_test(tests, test_homing_does_not_begin_without_its_switch);
    tcase_add_test(tests, test_homing_stops_when_the_slave_of_its_switch_is_switched_off);
    tcase_add_test(tests, test_homing_stops_when_only_the_limit_switch_goes_away);
    tcase_add_loop_test(tests, test_homing_by_a_switch_of_an_optional_slave, 0, 2);
    tcase_add_loop_test(tests, test_a_touch_probe_on_another_slave_captures_the_position_of_its_exchange, 0, 2);
    tcase_add_loop_test(tests, test_an_edge_while_the_slave_was_away_is_an_error, 0, 2);
    tcase_add_test(tests, test_a_cam_switch_writes_each_track_to_its_output);
    tcase_add_loop_test(tests, test_cam_outputs_go_off_without_calls_and_with_an_error, 0, 2);
    tcase_add_loop_test(tests, test_an_encoder_terminal_counts_over_the_end_of_its_bits, 0, 2);
    tcase_add_test(tests, test_the_velocity_of_an_encoder_terminal_is_smooth);
    tcase_add_test(tests, test_a_motor_follows_an_encoder_terminal);
    tcase_add_loop_test(tests, test_a_jump_of_the_counts_stops_the_slave_and_never_moves_it, 0, 4);
    tcase_add_test(tests, test_a_touch_probe_and_a_cam_switch_of_an_encoder);
    tcase_add_test(tests, test_wrong_signals_are_refused_in_words);
    suite_add_tcase(suite, tests);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_NORMAL);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
