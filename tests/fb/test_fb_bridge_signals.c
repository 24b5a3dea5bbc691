/* The blocks of digital signals on motors behind the simulated bridge, a CM1 and a CM2 at a time: by SDO in csp, in the
 * words in CPIO, and what is refused outside of it (docs/FUNCTION-BLOCKS.md, "Motors behind a bridge"). */
#include "axis/axis_parts.h"
#include "axis/axis_signals.h"
#include "cm1e/plcopen.h"
#include "core/bytes.h"
#include "homing/homing_private.h"
#include "sim/bridge_app.h"

#include "axis_segment.h"
#undef axis /* there are four */

enum { AXES = CM1E_BRIDGE_AXES, CM2 = 2 };
enum { BY_SDO = 0, IN_WORDS, WAYS };

static AXIS_REF_t references[AXES];
static MC_Power_t power_of[AXES];

static cm1e_sim_bridge_t *bridge(void)
{
    return cm1e_sim_bridge_of(cm1e_sim_segment_slave(cm1e_bus_segment(bus), 1));
}

static cm1e_sim_bridge_axis_t *motor(int n) { return &bridge()->axes[n]; }

static WORD id(cm1e_error_t error) { return cm1e_error_id(error); }

static void scan(int count)
{
    while (count-- > 0) {
        inputs();
        for (int n = 0; n < AXES; n++)
            MC_Power(&power_of[n]);
        outputs();
    }
}

static void begin(void)
{
    cm1e_bus_config_free(&config);
    cm1e_bus_config_init(&config, "sim", AXES);
    config.virtual_time = true;
    config.cycle_time_ns = CM1E_BRIDGE_CYCLE_TIME_NS;
    for (int n = 0; n < AXES; n++) {
        config.axes[n] = (cm1e_axis_config_t){.address = 1, .channel = (uint8_t)(n + 1), .k37 = 10, .k37_stated = true};
        config.axes[n].inputs = (cm1e_input_config_t){.limit_positive = 2, .limit_negative = 3, .home = 4};
        config.axes[n].homing = (cm1e_homing_config_t){.method = 3, .velocity = 4.0, .acceleration = 40.0};
    }
    open_segment();
    for (int n = 0; n < AXES; n++) {
        references[n] = cm1e_axis_reference(axes[n]);
        power_of[n] = (MC_Power_t){.Axis = &references[n], .EnablePositive = TRUE, .EnableNegative = TRUE};
    }
    scan(50);
}

static void enable_axis(int n)
{
    power_of[n].Enable = TRUE;
    for (int i = 0; i < 3000 && !power_of[n].Status && !power_of[n].Error; i++)
        scan(1);
    ck_assert_msg(power_of[n].Status, "%s", text_of(n));
}

static void disable_axis(int n)
{
    power_of[n].Enable = FALSE;
    for (int i = 0; i < 3000 && power_of[n].Status; i++)
        scan(1);
    scan(20);
    ck_assert(!power_of[n].Status);
}

static void enter_cpio(int n)
{
    CM_SetMode_t set = {.Axis = &references[n], .Mode = cmCPIO, .Execute = TRUE};
    do {
        CM_SetMode(&set);
        scan(1);
    } while (set.Busy);
    ck_assert_msg(set.Done, "%s", text_of(n));
}

/* Enabled, and signals come by the way that is asked for. */
static void begin_enabled(int n, int way)
{
    begin();
    if (way == IN_WORDS)
        enter_cpio(n);
    enable_axis(n);
}

static void sensor(int n, int number, const char *to)
{
    char line[60];
    snprintf(line, sizeof line, "motor 1 %d sensor %d %s", n + 1, number, to);
    simulate(line);
}

static void told(int n, const char *words) { ck_assert_msg(strstr(text_of(n), words), "%s", text_of(n)); }

/* Every SDO answer of this object arrives as an abort. */
static cm1e_tap_verdict_t refuse_object(void *context, cm1e_tap_frame_t *frame)
{
    enum { COMMAND = 16, OFFSET = 20, MAILBOX = 26, READ = 4, ANSWERS_AT = 0x1080, ABORT = 0x80 };
    const uint16_t *index = context;
    uint8_t *mailbox = frame->bytes + MAILBOX;
    if (frame->length > 60 && frame->direction == CM1E_TAP_RECEIVED && frame->bytes[COMMAND] == READ &&
        cm1e_get_u16(frame->bytes + OFFSET) == ANSWERS_AT && cm1e_get_u16(mailbox + 9) == *index) {
        cm1e_put_u16(mailbox, 10);
        cm1e_put_u16(mailbox + 6, 2 << 12);
        mailbox[8] = ABORT;
        cm1e_put_u32(mailbox + 12, 0x08000021);
    }
    return CM1E_TAP_PASS;
}

/* ---- inputs ------------------------------------------------------------------------------------------------------ */

static bool has_input(int n, int way, int number)
{
    return n < CM2 ? number >= 2 && number <= 4 : number >= 1 && number <= (way == IN_WORDS ? 4 : 6);
}

/* Until the answer shows what is expected; how many cycles that took. */
static int read_until(MC_ReadDigitalInput_t *fb, BOOL expected)
{
    int taken = 0;
    for (; taken < 200 && !(fb->Valid && fb->Value == expected); taken++) {
        scan(1);
        MC_ReadDigitalInput(fb);
        ck_assert(fb->Busy && !fb->Error && (fb->Valid || !fb->Value));
    }
    ck_assert_int_lt(taken, 200);
    return taken;
}

START_TEST(test_read_digital_input)
{
    const int n = _i / WAYS, way = _i % WAYS;
    begin_enabled(n, way);
    MC_INPUT_REF input = {.Axis = references[n], .Number = 4};
    MC_ReadDigitalInput_t fb = {.Input = &input, .Enable = TRUE};
    for (INT number = -1; number <= 7; number++) {
        fb.InputNumber = number;
        MC_ReadDigitalInput(&fb);
        if (number == 0) /* the reference's */
            continue;
        if (!has_input(n, way, number)) {
            ck_assert_msg(fb.Error && !fb.Valid && fb.ErrorID == id(CM1E_ERROR_AXIS_SIGNAL), "input %d", number);
            continue;
        }
        ck_assert_msg(!fb.Error && fb.Busy, "input %d: %s", number, text_of(n));
        for (int on = 1; on >= 0; on--) {
            sensor(n, number, on ? "on" : "off");
            const int taken = read_until(&fb, on != 0);
            ck_assert_int_le(taken, way == IN_WORDS ? 4 : 60);
        }
    }
    fb.InputNumber = 0;
    sensor(n, 4, "on");
    read_until(&fb, TRUE);
    disable_axis(n);
    MC_ReadDigitalInput(&fb);
    if (way == IN_WORDS) /* the words have them in every state */
        ck_assert_msg(fb.Valid && fb.Value, "%s", text_of(n));
    else
        ck_assert(!fb.Valid && !fb.Value && fb.Error && fb.ErrorID == id(CM1E_ERROR_AXIS_NOT_POWERED));
    enable_axis(n);
    for (int i = 0; i < 100 && !fb.Valid; i++) { /* comes back by itself */
        scan(1);
        MC_ReadDigitalInput(&fb);
    }
    ck_assert(fb.Valid && fb.Value && !fb.Error);
    close_segment();
}
END_TEST

/* While nobody asks, no time passes. */
START_TEST(test_inputs_that_the_bridge_refuses)
{
    enum { TIMEOUT = 1000, PAUSE = 1500 };
    const int n = _i;
    uint16_t index = (uint16_t)(0x60FD + n * CM1E_BRIDGE_INDEX_INCREMENT);
    begin_enabled(n, BY_SDO);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), refuse_object, &index);
    MC_INPUT_REF input = {.Axis = references[n], .Number = 4};
    for (int round = 0; round < 2; round++) {
        scan(PAUSE);
        MC_ReadDigitalInput_t fb = {.Input = &input, .Enable = TRUE};
        int taken = 0;
        for (; taken < 2 * TIMEOUT && !fb.Error; taken++) {
            MC_ReadDigitalInput(&fb);
            ck_assert(!fb.Valid && !fb.Value);
            scan(1);
        }
        ck_assert_msg(fb.ErrorID == id(CM1E_ERROR_TIMEOUT), "%s", text_of(n));
        ck_assert_msg(taken >= TIMEOUT && taken < TIMEOUT + 10, "%d cycles", taken);
    }
    MC_ReadDigitalInput_t fb = {.Input = &input, .Enable = TRUE};
    cm1e_nic_set_tap(cm1e_bus_nic(bus), NULL, NULL);
    scan(PAUSE);
    sensor(n, 4, "on");
    read_until(&fb, TRUE);
    close_segment();
}
END_TEST

/* By SDO, they are not reached while the mode is hm. */
START_TEST(test_inputs_while_it_homes)
{
    const int n = _i;
    begin_enabled(n, BY_SDO);
    MC_INPUT_REF input = {.Axis = references[n], .Number = 4};
    MC_OUTPUT_REF output = {.Axis = references[n], .Number = 2};
    MC_ReadDigitalInput_t fb = {.Input = &input, .Enable = TRUE};
    MC_WriteDigitalOutput_t write = {.Output = &output, .Value = TRUE, .Execute = TRUE};
    MC_Home_t home = {.Axis = &references[n], .Execute = TRUE};
    MC_Home(&home);
    while (axes[n]->homing->drive.step != HOME_RUN && home.Busy) {
        scan(1);
        MC_Home(&home);
    }
    scan(10);
    MC_ReadDigitalInput(&fb);
    ck_assert(!fb.Valid && fb.Error && fb.ErrorID == id(CM1E_ERROR_AXIS_HOMING));
    MC_WriteDigitalOutput(&write);
    ck_assert(write.Error && write.ErrorID == id(CM1E_ERROR_AXIS_HOMING));
    ck_assert_int_eq(motor(n)->outputs, 0);
    for (int i = 0; i < 20000 && home.Busy; i++) {
        scan(1);
        MC_Home(&home);
    }
    ck_assert_msg(home.Done, "%s", text_of(n));
    MC_ReadDigitalInput(&fb);
    read_until(&fb, FALSE);
    close_segment();
}
END_TEST

/* ---- outputs ----------------------------------------------------------------------------------------------------- */

static bool has_output(int n, int number) { return n < CM2 ? number == 2 : number >= 1 && number <= 4; }

/* The cycles that it is Busy. */
static int write_output(int n, int number, BOOL value, cm1e_error_t expected)
{
    MC_OUTPUT_REF output = {.Axis = references[n], .Number = (INT)number};
    MC_WriteDigitalOutput_t fb = {.Output = &output, .Value = value, .Execute = TRUE};
    int taken = 0;
    MC_WriteDigitalOutput(&fb);
    for (; taken < 1000 && fb.Busy; taken++) {
        ck_assert(!fb.Done && !fb.Error);
        scan(1);
        MC_WriteDigitalOutput(&fb);
    }
    ck_assert_msg(fb.Done == (expected == CM1E_OK) && fb.Error == (expected != CM1E_OK) && fb.ErrorID == id(expected),
                  "output %d: %s: %s", number, cm1e_strerror(cm1e_error_from_id(fb.ErrorID)), text_of(n));
    return taken;
}

static bool shown(int n, int number, cm1e_error_t expected)
{
    MC_OUTPUT_REF output = {.Axis = references[n], .Number = (INT)number};
    MC_ReadDigitalOutput_t fb = {.Output = &output, .Enable = TRUE};
    MC_ReadDigitalOutput(&fb);
    ck_assert(fb.Valid == (expected == CM1E_OK) && fb.Busy && fb.ErrorID == id(expected) && (fb.Valid || !fb.Value));
    return fb.Value;
}

START_TEST(test_write_and_read_digital_output)
{
    const int n = _i / WAYS, way = _i % WAYS;
    begin_enabled(n, way);
    for (int number = -1; number <= 5; number++) {
        if (number == 0)
            continue;
        const cm1e_error_t expected = has_output(n, number) ? CM1E_OK : CM1E_ERROR_AXIS_SIGNAL;
        for (int on = 1; on >= 0; on--) {
            const int taken = write_output(n, number, on != 0, expected);
            if (expected == CM1E_OK && way == BY_SDO) { /* it is there when Done says so */
                ck_assert_int_ge(taken, 2);
                ck_assert_int_eq(motor(n)->outputs, on ? 1 << (number - 1) : 0);
            }
            ck_assert_int_eq(shown(n, number, expected), expected == CM1E_OK && on);
            scan(3);
            ck_assert_int_eq(motor(n)->outputs, expected == CM1E_OK && on ? 1 << (number - 1) : 0);
        }
        if (expected != CM1E_OK) {
            write_output(n, number, TRUE, expected);
            told(n, n < CM2 ? "output 2" : "outputs 1 ... 4");
        }
    }
    for (int other = 0; other < AXES; other++)
        ck_assert_int_eq(motor(other)->outputs, 0);
    close_segment();
}
END_TEST

START_TEST(test_an_output_without_torque)
{
    const int n = _i / WAYS, way = _i % WAYS;
    begin();
    if (way == IN_WORDS)
        enter_cpio(n);
    write_output(n, 2, TRUE, way == IN_WORDS ? CM1E_OK : CM1E_ERROR_AXIS_NOT_POWERED);
    scan(10);
    ck_assert_int_eq(motor(n)->outputs, way == IN_WORDS ? 2 : 0);
    if (way == BY_SDO) {
        told(n, "while the motor is enabled in csp");
        enable_axis(n);
        scan(100);
        ck_assert_int_eq(motor(n)->outputs, 0); /* what was refused does not come later */
    }
    close_segment();
}
END_TEST

START_TEST(test_an_output_that_the_bridge_refuses)
{
    const int n = _i;
    uint16_t index = (uint16_t)(0x60FE + n * CM1E_BRIDGE_INDEX_INCREMENT);
    begin_enabled(n, BY_SDO);
    scan(100);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), refuse_object, &index);
    write_output(n, 2, TRUE, CM1E_ERROR_BUS_MAILBOX);
    told(n, "digital output 2 was not written: mailbox error");
    ck_assert_int_eq(info_of(n).state, CM1E_AXIS_STANDSTILL);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), NULL, NULL);
    scan(500);
    write_output(n, 2, TRUE, CM1E_OK);
    ck_assert_int_eq(motor(n)->outputs, 2);
    write_output(n, 2, FALSE, CM1E_OK);
    ck_assert_int_eq(motor(n)->outputs, 0);
    close_segment();
}
END_TEST

START_TEST(test_outputs_go_off_at_the_end_of_a_run)
{
    const int n = _i / WAYS, way = _i % WAYS;
    begin_enabled(n, way);
    write_output(n, 2, TRUE, CM1E_OK);
    scan(5);
    ck_assert_int_eq(motor(n)->outputs, 2);
    bool off = false;
    for (int i = 0; i < 3000 && !off; i++) {
        inputs();
        off = cm1e_axis_shut_down(axes[n]);
        outputs();
        if (way == BY_SDO) /* before the torque: then nobody reaches them */
            ck_assert(!motor(n)->motor_free || motor(n)->outputs == 0);
    }
    cycles(5);
    ck_assert(off && motor(n)->motor_free);
    ck_assert_int_eq(motor(n)->outputs, 0);
    close_segment();
}
END_TEST

/* Whatever was asked of it last: the torque waits for it for a while, and goes then. */
START_TEST(test_an_output_that_cannot_go_off_does_not_keep_the_torque)
{
    const int n = _i / 2;
    uint16_t index = (uint16_t)(0x60FE + n * CM1E_BRIDGE_INDEX_INCREMENT);
    begin_enabled(n, BY_SDO);
    write_output(n, 2, TRUE, CM1E_OK);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), refuse_object, &index);
    if (_i % 2)
        ck_assert_int_eq(cm1e_axis_write_output(axes[n], 2, false), CM1E_OK);
    int taken = 0;
    for (bool off = false; taken < 1000 && !off; taken++) {
        inputs();
        off = cm1e_axis_shut_down(axes[n]);
        outputs();
    }
    ck_assert_msg(taken > 500 && taken < 1000, "%d cycles", taken);
    cycles(5);
    ck_assert(motor(n)->motor_free);
    close_segment();
}
END_TEST

/* As with a CM1-E: what hangs on it is the program's business. By SDO it is reached under torque only. */
START_TEST(test_an_output_stays_over_a_fault)
{
    const int n = _i / WAYS, way = _i % WAYS;
    char line[60];
    begin_enabled(n, way);
    write_output(n, 2, TRUE, CM1E_OK);
    snprintf(line, sizeof line, "motor 1 %d error overload", n + 1);
    simulate(line);
    scan(300);
    ck_assert_int_eq(info_of(n).state, CM1E_AXIS_ERROR_STOP);
    ck_assert(shown(n, 2, CM1E_OK));
    ck_assert_int_eq(motor(n)->outputs, 2);
    write_output(n, 2, FALSE, way == IN_WORDS ? CM1E_OK : CM1E_ERROR_AXIS_NOT_POWERED);
    scan(5);
    ck_assert_int_eq(motor(n)->outputs, way == IN_WORDS ? 0 : 2);
    if (way == BY_SDO) {
        MC_Reset_t reset = {.Axis = &references[n], .Execute = TRUE};
        do {
            MC_Reset(&reset);
            scan(1);
        } while (reset.Busy);
        ck_assert_msg(reset.Done, "%s", text_of(n));
        enable_axis(n);
        scan(50);
        ck_assert_int_eq(motor(n)->outputs, 2);
        write_output(n, 2, FALSE, CM1E_OK);
        ck_assert_int_eq(motor(n)->outputs, 0);
    }
    close_segment();
}
END_TEST

/* A bridge that was switched off and on begins with its outputs off, and they stay so. */
START_TEST(test_an_output_stays_off_after_its_bridge_was_away)
{
    const int n = _i / WAYS, way = _i % WAYS;
    begin_enabled(n, way);
    write_output(n, 2, TRUE, CM1E_OK);
    simulate("power-cycle 1 300");
    scan(4000);
    ck_assert(!shown(n, 2, CM1E_OK));
    for (int other = 0; other < AXES; other++) {
        MC_Reset_t reset = {.Axis = &references[other], .Execute = TRUE};
        do {
            MC_Reset(&reset);
            scan(1);
        } while (reset.Busy);
    }
    enable_axis(n);
    scan(100);
    ck_assert_int_eq(info_of(n).mode, CM1E_BRIDGE_MODE_CSP);
    ck_assert_int_eq(motor(n)->outputs, 0);
    write_output(n, 2, TRUE, CM1E_OK);
    ck_assert_int_eq(motor(n)->outputs, 2);
    close_segment();
}
END_TEST

/* ---- switches ---------------------------------------------------------------------------------------------------- */

START_TEST(test_read_axis_info)
{
    const int n = _i / WAYS, way = _i % WAYS;
    begin_enabled(n, way);
    MC_ReadAxisInfo_t fb = {.Axis = &references[n], .Enable = TRUE};
    MC_ReadAxisInfo(&fb);
    ck_assert(fb.Valid && fb.PowerOn && fb.CommunicationReady && fb.Simulation && !fb.AxisWarning);
    ck_assert(!fb.HomeAbsSwitch && !fb.LimitSwitchPos && !fb.LimitSwitchNeg);
    for (int number = 2; number <= 4; number++) {
        sensor(n, number, "on");
        for (int i = 0; i < (way == IN_WORDS ? 4 : 60); i++) {
            scan(1);
            MC_ReadAxisInfo(&fb);
        }
        ck_assert(fb.LimitSwitchPos == (number == 2) && fb.LimitSwitchNeg == (number == 3) &&
                  fb.HomeAbsSwitch == (number == 4) && fb.Valid && !fb.AxisWarning);
        if (number < 4)
            sensor(n, number, "off");
    }
    disable_axis(n);
    scan(10);
    MC_ReadAxisInfo(&fb);
    ck_assert(fb.Valid && !fb.PowerOn && !fb.AxisWarning);
    ck_assert_int_eq(fb.HomeAbsSwitch, way == IN_WORDS); /* by SDO it is not known any more */
    ck_assert(fb.ReadyForPowerOn);
    close_segment();
}
END_TEST

static void run_step(MC_StepAbsoluteSwitch_t *step, int most)
{
    MC_StepAbsoluteSwitch(step);
    while (step->Busy && most-- > 0) {
        scan(1);
        MC_StepAbsoluteSwitch(step);
    }
    ck_assert(!step->Busy);
}

/* The switch is sensor 2 of the simulated motor, from 150,000 counts on. */
START_TEST(test_step_to_a_switch)
{
    const int n = _i / WAYS, way = _i % WAYS;
    begin_enabled(n, way);
    MC_StepAbsoluteSwitch_t step = {.Axis = &references[n], .Execute = TRUE, .Direction = mcPositiveDirection,
                                    .SwitchMode = mcRisingEdge, .Velocity = 1.0, .SetPosition = 7.0,
                                    .ReferenceSignal = {.InputNumber = 2}};
    run_step(&step, 10000);
    if (way == BY_SDO) {
        ck_assert(step.Error && step.ErrorID == id(CM1E_ERROR_PDO_MAPPING));
        told(n, "CPIO");
        ck_assert_double_eq_tol(motor(n)->mechanics.position, 0.0, 5.0);
        MC_StepLimitSwitch_t limit = {.Axis = &references[n], .Execute = TRUE, .Direction = mcPositiveDirection,
                                      .Velocity = 1.0};
        MC_StepLimitSwitch(&limit);
        ck_assert(limit.Error && limit.ErrorID == id(CM1E_ERROR_PDO_MAPPING));
        close_segment();
        return;
    }
    ck_assert_msg(step.Done, "%s", text_of(n));
    const double zero = info_of(n).actual_position - motor(n)->mechanics.position / 50000.0;
    ck_assert_double_eq_tol(zero + 150000.0 / 50000.0, 7.0, 0.005); /* the edge, within what two samples tell */
    close_segment();
}
END_TEST

/* ---- what follows a position ------------------------------------------------------------------------------------- */

static void move(int n, double to, double velocity, MC_TouchProbe_t *probe, MC_DigitalCamSwitch_t *cam)
{
    MC_MoveAbsolute_t fb = {.Axis = &references[n], .Execute = TRUE, .Position = to, .Velocity = velocity};
    do {
        inputs();
        MC_Power(&power_of[n]);
        MC_MoveAbsolute(&fb);
        if (probe)
            MC_TouchProbe(probe);
        if (cam)
            MC_DigitalCamSwitch(cam);
        outputs();
        if (cam && fb.Busy) {
            const double at = motor(n)->mechanics.position / 50000.0;
            const bool on = motor(n)->outputs & 2, inside = at > 1.05 && at < 1.95, outside = at < 0.95 || at > 2.05;
            ck_assert_msg(!(inside && !on) && !(outside && on), "at %g the output is %d", at, on);
        }
    } while (fb.Busy);
    ck_assert_msg(fb.Done, "%s", text_of(n));
}

START_TEST(test_touch_probe)
{
    const int n = _i / WAYS, way = _i % WAYS;
    begin_enabled(n, way);
    const MC_TRIGGER_REF on = {.InputNumber = 2};
    MC_TouchProbe_t probe = {.Axis = &references[n], .TriggerInput = &on, .Execute = TRUE};
    MC_AbortTrigger_t cancel = {.Axis = &references[n], .TriggerInput = &on, .Execute = TRUE};
    MC_TouchProbe(&probe);
    if (way == BY_SDO) {
        ck_assert(probe.Error && probe.ErrorID == id(CM1E_ERROR_PDO_MAPPING));
        told(n, "CPIO");
        MC_AbortTrigger(&cancel);
        ck_assert(cancel.Error && cancel.ErrorID == id(CM1E_ERROR_PDO_MAPPING));
        close_segment();
        return;
    }
    ck_assert_msg(probe.Busy && !probe.Error, "%s", text_of(n));
    const double at = info_of(n).actual_position + (150000.0 - motor(n)->mechanics.position) / 50000.0;
    move(n, 4.0, 2.0, &probe, NULL);
    ck_assert_msg(probe.Done, "%s", text_of(n));
    ck_assert_double_eq_tol(probe.RecordedPosition, at, probe.Uncertainty + 0.004); /* two cycles on the way */
    probe.Execute = FALSE;
    MC_TouchProbe(&probe);
    probe.Execute = TRUE;
    MC_TouchProbe(&probe);
    MC_AbortTrigger(&cancel);
    ck_assert(cancel.Busy && !cancel.Error);
    MC_TouchProbe(&probe);
    ck_assert(probe.CommandAborted);
    close_segment();
}
END_TEST

START_TEST(test_digital_cam_switch_on_the_output_of_the_motor)
{
    const int n = _i / WAYS, way = _i % WAYS;
    begin_enabled(n, way);
    static MC_CAMSWITCH_REF cams = {.NumberOfSwitches = 1,
                                    .Switches = {{.TrackNumber = 1, .FirstOnPosition = 1.0, .LastOnPosition = 2.0}}};
    MC_OUTPUT_REF output = {.Axis = references[n], .Number = 2};
    MC_DigitalCamSwitch_t fb = {.Axis = &references[n], .Switches = &cams, .Outputs = &output, .Enable = TRUE,
                                .EnableMask = 1, .ValueSource = mcActualValue};
    if (way == BY_SDO) {
        scan(100);
        write_output(n, 2, TRUE, CM1E_OK);
        for (int i = 0; i < 100; i++) {
            MC_DigitalCamSwitch(&fb);
            scan(1);
        }
        ck_assert(fb.Error && fb.ErrorID == id(CM1E_ERROR_PDO_MAPPING));
        ck_assert_int_eq(motor(n)->outputs, 2); /* a refused block changes nothing */
        told(n, "digital output 2 was not written");
        close_segment();
        return;
    }
    move(n, 3.0, 2.0, NULL, &fb);
    move(n, 1.5, 2.0, NULL, &fb);
    ck_assert_int_eq(motor(n)->outputs, 2);
    cycles(110); /* nobody asks for it any more */
    ck_assert_int_eq(motor(n)->outputs, 0);
    close_segment();
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("signals behind a bridge");
    TCase *tcase = tcase_create("all");
    suite_add_tcase(suite, tcase);
    tcase_set_timeout(tcase, 60);
    tcase_add_loop_test(tcase, test_read_digital_input, 0, AXES * WAYS);
    tcase_add_loop_test(tcase, test_inputs_that_the_bridge_refuses, 0, AXES);
    tcase_add_loop_test(tcase, test_inputs_while_it_homes, 0, AXES);
    tcase_add_loop_test(tcase, test_write_and_read_digital_output, 0, AXES * WAYS);
    tcase_add_loop_test(tcase, test_an_output_without_torque, 0, AXES * WAYS);
    tcase_add_loop_test(tcase, test_an_output_that_the_bridge_refuses, 0, AXES);
    tcase_add_loop_test(tcase, test_outputs_go_off_at_the_end_of_a_run, 0, AXES * WAYS);
    tcase_add_loop_test(tcase, test_an_output_that_cannot_go_off_does_not_keep_the_torque, 0, 2 * AXES);
    tcase_add_loop_test(tcase, test_an_output_stays_over_a_fault, 0, AXES * WAYS);
    tcase_add_loop_test(tcase, test_an_output_stays_off_after_its_bridge_was_away, 0, AXES * WAYS);
    tcase_add_loop_test(tcase, test_read_axis_info, 0, AXES * WAYS);
    tcase_add_loop_test(tcase, test_step_to_a_switch, 0, AXES * WAYS);
    tcase_add_loop_test(tcase, test_touch_probe, 0, AXES * WAYS);
    tcase_add_loop_test(tcase, test_digital_cam_switch_on_the_output_of_the_motor, 0, AXES * WAYS);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
