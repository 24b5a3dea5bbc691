/* The blocks of inputs, outputs, switches, torque, motion state and touch probes on the simulated segment. */
#include "../support/axis_segment.h"

static AXIS_REF_t reference, nothing;

static void begin(void)
{
    describe("1.3.5", CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, 1000000);
    config.axes[0].sim.sensor_input2 = 100000; /* 2 u from where the motor stands at power-on */
    config.axes[0].sim.no_stops = true;
    config.axes[0].inputs = (cm1e_input_config_t){.limit_positive = 2, .limit_negative = 3, .home = 1};
    open_segment();
    reference = cm1e_axis_reference(axis);
    cycles(300);
}

static void switch_input(int number, const char *to)
{
    char line[40];
    snprintf(line, sizeof line, "sensor 1 %d %s", number, to);
    simulate(line);
    cycles(3);
}

static WORD id(cm1e_error_t error) { return cm1e_error_id(error); }

static void told(const char *words)
{
    char text[512];
    cm1e_axis_error_text(reference, text, sizeof text);
    ck_assert_msg(strstr(text, words) != NULL, "\"%s\" is not in: %s", words, text);
}

/** What is wrong with a number that a block reads in every call is told once, so that a later refusal is told too. */
START_TEST(test_a_number_that_is_wrong_is_told_with_those_that_are_right)
{
    begin();
    MC_INPUT_REF input = {.Axis = reference};
    MC_OUTPUT_REF output = {.Axis = reference};
    MC_ReadDigitalInput_t reads = {.Input = &input, .Enable = TRUE, .InputNumber = 77};
    MC_ReadDigitalInput(&reads);
    told("digital input 77 was not read");
    told("Right is 1 ... 4.");
    reads.InputNumber = -3;
    MC_ReadDigitalInput(&reads);
    told("digital input -3 was not read");
    MC_Stop_t stop = {.Axis = &reference, .Execute = TRUE, .Deceleration = -1.0};
    MC_Stop(&stop); /* in Disabled */
    MC_ReadDigitalInput(&reads);
    told("Disabled");
    MC_ReadDigitalOutput_t shows = {.Output = &output, .Enable = TRUE, .OutputNumber = 5};
    MC_ReadDigitalOutput(&shows);
    told("digital output 5 was not read");
    told("Right is 1.");
    MC_WriteDigitalOutput_t writes = {.Output = &output, .Execute = TRUE, .OutputNumber = 3};
    MC_WriteDigitalOutput(&writes);
    told("digital output 3 was not written");
    told("Right is 1.");
    MC_DigitalCamSwitch_t cams = {.Axis = &reference, .Outputs = &output, .Enable = TRUE};
    cams.ValueSource = (MC_SOURCE)2;
    MC_DigitalCamSwitch(&cams);
    ck_assert(cams.Error && cams.ErrorID == id(CM1E_ERROR_INVALID_ARGUMENT));
    told("MC_DigitalCamSwitch: ValueSource is 2; 0 (mcSetValue) or 1 (mcActualValue) is right");
    cams.Outputs = NULL;
    cams.Enable = FALSE;
    MC_DigitalCamSwitch(&cams);
    cams.Enable = TRUE;
    MC_DigitalCamSwitch(&cams);
    told("MC_DigitalCamSwitch: Outputs is 0");
    MC_ReadMotionState_t state = {.Axis = &reference, .Enable = TRUE, .Source = (MC_SOURCE)-1};
    MC_ReadMotionState(&state);
    told("MC_ReadMotionState: Source is -1; 0 (mcSetValue)");
    MC_ReadParameter_t reader = {.Axis = &reference, .Enable = TRUE, .ParameterNumber = 99};
    MC_ReadParameter(&reader);
    told("MC_ReadParameter: ParameterNumber is 99; 1 ... 17, 1800 ... 1804, or");
    MC_ReadBoolParameter_t bool_reader = {.Axis = &reference, .Enable = TRUE, .ParameterNumber = 9};
    MC_ReadBoolParameter(&bool_reader);
    told("MC_ReadBoolParameter: ParameterNumber is 9; 4, 5, 6, 1800 or 1804 is right");
    MC_ReadParameter(&reader);
    told("MC_ReadBoolParameter");
    MC_WriteParameter_t writer = {.Axis = &reference, .Execute = TRUE, .ParameterNumber = 1999};
    MC_WriteParameter(&writer);
    told("parameter 1999");
    told("Right is 1 ... 17");
    close_segment();
}
END_TEST

/** Of two blocks with wrong numbers one is told, however often both are called; when that is right, or off, the other one. */
START_TEST(test_a_wrong_number_is_told_when_another_one_is_right)
{
    for (int off = 0; off < 2; off++)
        for (int first = 0; first < 2; first++)
            for (int object = 0; object < 2; object++) {
                begin();
                MC_INPUT_REF input = {.Axis = reference};
                MC_ReadDigitalInput_t reads = {.Input = &input, .Enable = TRUE, .InputNumber = 77};
                MC_ReadParameter_t reader = {.Axis = &reference, .Enable = TRUE, .ParameterNumber = object ? 1199 : 99};
                const char *const words[] = {"digital input 77", object ? "parameter 1199" : "ParameterNumber is 99"};
                for (int n = 0; n < 30; n++) {
                    if (n == 10 && first)
                        off ? (void)(reads.Enable = FALSE) : (void)(reads.InputNumber = 1);
                    if (n == 10 && !first)
                        off ? (void)(reader.Enable = FALSE) : (void)(reader.ParameterNumber = 1);
                    MC_ReadDigitalInput(&reads);
                    MC_ReadParameter(&reader);
                    cycles(1);
                    if (n < 10)
                        told(words[1]);
                    else if (n > 10)
                        told(words[first]);
                }
                ck_assert(reads.Error == !first && reader.Error == first);
                close_segment();
            }
}
END_TEST

/** A block that is refused says why, also where another block was refused in the same way before. */
START_TEST(test_what_is_refused_is_told_in_words)
{
    begin();
    MC_OUTPUT_REF output = {.Axis = reference, .Number = 5};
    MC_CAMSWITCH_REF switches = {.NumberOfSwitches = 1, .Switches = {{.TrackNumber = 1, .LastOnPosition = 1.0}}};
    MC_DigitalCamSwitch_t cams = {.Axis = &reference, .Outputs = &output, .Switches = &switches, .Enable = TRUE,
                                  .EnableMask = 1};
    MC_DigitalCamSwitch(&cams);
    ck_assert(cams.Error && cams.ErrorID == id(CM1E_ERROR_AXIS_SIGNAL));
    told("digital output 5 was not written");
    MC_TRIGGER_REF trigger = {.InputNumber = 7};
    MC_AbortTrigger_t aborts = {.Axis = &reference, .TriggerInput = &trigger, .Execute = TRUE};
    MC_AbortTrigger(&aborts);
    ck_assert(aborts.Error && aborts.ErrorID == id(CM1E_ERROR_AXIS_SIGNAL));
    told("no touch probe at input 7");
    MC_DigitalCamSwitch(&cams); /* what it said once does not hide what others say */
    told("no touch probe at input 7");
    trigger.Axis.Handle = 99;
    MC_TouchProbe_t probe = {.Axis = &reference, .TriggerInput = &trigger, .Execute = TRUE};
    MC_TouchProbe(&probe);
    told("TriggerInput.Axis is 99; the Axis of the block, or a Handle of 0, is right.");
    trigger.Axis.Handle = 0;
    for (int i = 0; i < 2; i++) {
        MC_SetOverride_t override = {.Axis = &reference, .Enable = TRUE, .VelFactor = -1, .AccFactor = 1, .JerkFactor = 1};
        MC_SetOverride(&override);
        ck_assert(override.Error && override.ErrorID == id(CM1E_ERROR_AXIS_OVERRIDE));
        told("MC_SetOverride to VelFactor -1");
        aborts.Execute = FALSE;
        MC_AbortTrigger(&aborts);
        aborts.Execute = TRUE;
        MC_AbortTrigger(&aborts);
        told("no touch probe at input 7");
    }
    close_segment();
}
END_TEST

/* ---- inputs and outputs ------------------------------------------------------------------------------------------ */

START_TEST(test_read_digital_input)
{
    begin();
    MC_INPUT_REF input = {.Axis = reference, .Number = 4};
    MC_ReadDigitalInput_t fb = {.Input = &input};
    MC_ReadDigitalInput(&fb);
    ck_assert(!fb.Valid && !fb.Busy && !fb.Error);
    fb.Enable = TRUE;
    for (INT n = 0; n <= 4; n++) {
        const int number = n ? n : 4;
        fb.InputNumber = n;
        switch_input(number, "on");
        MC_ReadDigitalInput(&fb);
        ck_assert(fb.Valid && fb.Busy && !fb.Error && fb.Value);
        switch_input(number, "off");
        MC_ReadDigitalInput(&fb);
        ck_assert(fb.Valid && !fb.Value);
    }
    static const INT wrong[] = {5, -1, 32767, -32768};
    for (int i = 0; i < 4; i++) {
        fb.InputNumber = wrong[i];
        MC_ReadDigitalInput(&fb);
        ck_assert(!fb.Valid && fb.Busy && fb.Error && fb.ErrorID == id(CM1E_ERROR_AXIS_SIGNAL));
        fb.InputNumber = 1; /* 2.2.3: it comes back by itself */
        MC_ReadDigitalInput(&fb);
        ck_assert(fb.Valid && !fb.Error);
    }
    switch_input(1, "on");
    simulate("lose 1");
    cycles(2);
    MC_ReadDigitalInput(&fb);
    ck_assert(!fb.Valid && fb.Error && fb.ErrorID == id(CM1E_ERROR_AXIS_OFFLINE) && !fb.Value);
    cycles(2);
    MC_ReadDigitalInput(&fb);
    ck_assert(fb.Valid && fb.Value);
    fb.Enable = FALSE;
    MC_ReadDigitalInput(&fb);
    ck_assert(!fb.Valid && !fb.Busy && !fb.Error && !fb.Value);
    fb.Enable = TRUE;
    fb.Input = NULL;
    MC_ReadDigitalInput(&fb);
    ck_assert(!fb.Busy && fb.Error && fb.ErrorID == id(CM1E_ERROR_FB_AXIS_REF));
    close_segment();
}
END_TEST

static void write_output(MC_WriteDigitalOutput_t *fb, BOOL value, cm1e_error_t expected)
{
    fb->Value = value;
    fb->Execute = TRUE;
    MC_WriteDigitalOutput(fb);
    ck_assert(fb->Busy == (expected == CM1E_OK) && fb->Error == (expected != CM1E_OK) &&
              fb->ErrorID == id(expected) && !fb->Done);
    cycles(1);
    fb->Value = !value; /* not an edge */
    MC_WriteDigitalOutput(fb);
    ck_assert(fb->Done == (expected == CM1E_OK) && !fb->Busy);
    cycles(3);
    MC_WriteDigitalOutput(fb);
    ck_assert(fb->Done == (expected == CM1E_OK));
    fb->Execute = FALSE;
    MC_WriteDigitalOutput(fb);
    ck_assert(!fb->Done && !fb->Busy && !fb->Error);
}

START_TEST(test_write_and_read_digital_output)
{
    begin();
    MC_OUTPUT_REF output = {.Axis = reference, .Number = 1};
    MC_WriteDigitalOutput_t write = {.Output = &output};
    MC_ReadDigitalOutput_t read = {.Output = &output, .Enable = TRUE};
    for (int i = 0; i < 4; i++) {
        write.OutputNumber = (INT)(i / 2); /* 0: the reference's */
        write_output(&write, !(i % 2), CM1E_OK);
        ck_assert_uint_eq(probe().digital_outputs, !(i % 2));
        MC_ReadDigitalOutput(&read);
        ck_assert(read.Valid && read.Busy && read.Value == !(i % 2));
    }
    write_output(&write, TRUE, CM1E_OK);
    write.OutputNumber = 2; /* the motor's own (K34) */
    write_output(&write, FALSE, CM1E_ERROR_AXIS_SIGNAL);
    write.OutputNumber = 1;
    write.ExecutionMode = mcQueued;
    write_output(&write, FALSE, CM1E_ERROR_UNSUPPORTED);
    write.ExecutionMode = (MC_EXECUTION_MODE)9;
    write_output(&write, FALSE, CM1E_ERROR_UNSUPPORTED);
    output.Axis = nothing;
    write_output(&write, FALSE, CM1E_ERROR_FB_AXIS_REF);
    ck_assert_uint_eq(probe().digital_outputs, 1);
    output.Axis = reference;
    read.Enable = FALSE;
    MC_ReadDigitalOutput(&read);
    read.Enable = TRUE;
    read.OutputNumber = 2;
    MC_ReadDigitalOutput(&read);
    ck_assert(!read.Valid && read.Busy && read.Error && read.ErrorID == id(CM1E_ERROR_AXIS_SIGNAL) && !read.Value);
    close_segment();
}
END_TEST

/* The slave falls out of Operational and is brought back: its output must not come on by itself. */
START_TEST(test_output_stays_off_after_its_motor_was_away)
{
    begin();
    MC_OUTPUT_REF output = {.Axis = reference, .Number = 1};
    MC_WriteDigitalOutput_t write = {.Output = &output};
    MC_ReadDigitalOutput_t read = {.Output = &output, .Enable = TRUE};
    write_output(&write, TRUE, CM1E_OK);
    simulate("power-cycle 1 300");
    cycles(1500);
    ck_assert_int_eq(cm1e_axis_power(axis, &owner, true, true, true), CM1E_OK);
    cycles(2500);
    ck_assert_int_eq(cm1e_axis_reset(axis), CM1E_OK);
    for (int i = 0; i < 12000 && !info().online; i++)
        cycles(1);
    ck_assert(info().online);
    cycles(100);
    MC_ReadDigitalOutput(&read);
    ck_assert(read.Valid && !read.Value);
    ck_assert_uint_eq(probe().digital_outputs, 0);
    write_output(&write, TRUE, CM1E_OK);
    ck_assert_uint_eq(probe().digital_outputs, 1);
    close_segment();
}
END_TEST

/* ---- what the axis shows ----------------------------------------------------------------------------------------- */

START_TEST(test_read_axis_info)
{
    begin();
    MC_ReadAxisInfo_t fb = {.Axis = &reference};
    MC_ReadAxisInfo(&fb);
    ck_assert(!fb.Valid && !fb.Simulation && !fb.CommunicationReady);
    fb.Enable = TRUE;
    MC_ReadAxisInfo(&fb);
    ck_assert(fb.Valid && fb.Busy && fb.Simulation && fb.CommunicationReady && fb.ReadyForPowerOn && !fb.PowerOn);
    ck_assert(!fb.IsHomed && !fb.AxisWarning && !fb.HomeAbsSwitch && !fb.LimitSwitchPos && !fb.LimitSwitchNeg);
    for (int n = 1; n <= 3; n++) {
        switch_input(n, "on");
        MC_ReadAxisInfo(&fb);
        ck_assert(fb.HomeAbsSwitch == (n == 1) && fb.LimitSwitchPos == (n == 2) && fb.LimitSwitchNeg == (n == 3));
        switch_input(n, n == 1 ? "off" : "auto");
    }
    simulate("power 1 off");
    cycles(3);
    MC_ReadAxisInfo(&fb);
    ck_assert(fb.CommunicationReady && !fb.ReadyForPowerOn);
    simulate("power 1 on");
    enable();
    cycles(20);
    MC_ReadAxisInfo(&fb);
    ck_assert(!fb.AxisWarning);
    simulate("error 1 8611"); /* no fault */
    cycles(3);
    MC_ReadAxisInfo(&fb);
    ck_assert(fb.AxisWarning && fb.PowerOn);
    simulate("error 1 clear");
    cycles(3);
    MC_ReadAxisInfo(&fb);
    ck_assert(fb.PowerOn && !fb.ReadyForPowerOn && !fb.IsHomed);
    await(command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_HOME,
                                         .homing = &(cm1e_homing_config_t){.method = -3}}), 60.0);
    MC_ReadAxisInfo(&fb);
    ck_assert(fb.IsHomed);
    switch_input(1, "on");
    simulate("unplug 1");
    cycles(20);
    MC_ReadAxisInfo(&fb);
    ck_assert(fb.Valid && !fb.CommunicationReady && !fb.ReadyForPowerOn && fb.HomeAbsSwitch); /* last seen */
    fb.Axis = &nothing;
    MC_ReadAxisInfo(&fb);
    ck_assert(!fb.Valid && !fb.Busy && fb.Error && fb.ErrorID == id(CM1E_ERROR_FB_AXIS_CHANGED) && !fb.Simulation);
    close_segment();
}
END_TEST

START_TEST(test_read_actual_torque)
{
    begin();
    MC_ReadActualTorque_t fb = {.Axis = &reference, .Enable = TRUE};
    enable();
    cycles(200);
    MC_ReadActualTorque(&fb);
    ck_assert(fb.Valid && fb.Busy && !fb.Error);
    const double before = fb.Torque;
    simulate("load 1 0.05"); /* drives CW: the motor holds against it */
    cycles(500);
    MC_ReadActualTorque(&fb);
    ck_assert_msg(fb.Torque < before - 5.0, "%g, then %g", before, fb.Torque);
    ck_assert_double_eq(fb.Torque, info().actual_torque);
    simulate("lose 1");
    cycles(2);
    MC_ReadActualTorque(&fb);
    ck_assert(!fb.Valid && fb.Busy && fb.Error && fb.ErrorID == id(CM1E_ERROR_AXIS_OFFLINE) && fb.Torque == 0.0);
    cycles(2);
    MC_ReadActualTorque(&fb);
    ck_assert(fb.Valid && !fb.Error);
    close_segment();
}
END_TEST

START_TEST(test_torque_control_says_that_there_is_no_torque_mode)
{
    begin();
    MC_TorqueControl_t fb = {.Axis = &reference, .Torque = 10.0, .Velocity = 1.0};
    for (int i = 0; i < 2; i++) {
        fb.Execute = TRUE;
        MC_TorqueControl(&fb);
        ck_assert(fb.Error && fb.ErrorID == id(CM1E_ERROR_AXIS_NO_TORQUE_MODE));
        ck_assert(!fb.Busy && !fb.Active && !fb.InTorque && !fb.CommandAborted);
        cycles(10);
        MC_TorqueControl(&fb);
        ck_assert(fb.Error);
        fb.Execute = FALSE;
        MC_TorqueControl(&fb);
        ck_assert(!fb.Error && fb.ErrorID == 0);
        enable();
        cycles(10);
    }
    ck_assert_int_eq(info().state, CM1E_AXIS_STANDSTILL);
    close_segment();
}
END_TEST

static MC_ReadMotionState_t motion[3]; /* by MC_SOURCE */

static void read_motion(void)
{
    for (int i = 0; i < 3; i++) {
        MC_ReadMotionState_t *fb = &motion[i];
        fb->Axis = &reference;
        fb->Enable = TRUE;
        fb->Source = (MC_SOURCE)i;
        MC_ReadMotionState(fb);
        if (!fb->Valid || fb->ConstantVelocity + fb->Accelerating + fb->Decelerating != 1 ||
            fb->DirectionPositive + fb->DirectionNegative > 1)
            ck_abort_msg("source %d", i);
    }
}

/* A move there and back: each phase of each source, and how late the measured one is. */
START_TEST(test_read_motion_state)
{
    begin();
    enable();
    memset(motion, 0, sizeof motion);
    const cm1e_axis_command_t move = {.kind = CM1E_COMMAND_MOVE_RELATIVE, .velocity = 20.0, .acceleration = 100.0};
    for (int sign = 1; sign >= -1; sign -= 2) {
        cm1e_axis_command_t there = move;
        there.position = sign * 30.0;
        const cm1e_command_id_t moving = command(&there);
        int phases = 0, late = 0, wrong = 0;
        char before = ' ';
        while (cm1e_axis_command_status(axis, moving).state == CM1E_COMMAND_ACTIVE) {
            cycles(1);
            read_motion();
            const MC_ReadMotionState_t *set = &motion[mcSetValue], *actual = &motion[mcActualValue];
            const char phase = set->Accelerating ? 'a' : set->Decelerating ? 'd' : 'c';
            const char measured = actual->Accelerating ? 'a' : actual->Decelerating ? 'd' : 'c';
            ck_assert(set->Accelerating == motion[mcCommandedValue].Accelerating);
            phases += phase != before;
            late = phase != before ? 0 : late + 1;
            wrong += late > 100 && measured != phase;
            before = phase;
            if (info().set_velocity != 0.0)
                ck_assert(set->DirectionPositive == (sign > 0) && set->DirectionNegative == (sign < 0));
            if (late > 100 && fabs(info().set_velocity) > 1.0)
                ck_assert(actual->DirectionPositive == (sign > 0) && actual->DirectionNegative == (sign < 0));
        }
        ck_assert_msg(phases == 4 && wrong == 0, "%d phases, %d wrong", phases, wrong);
        for (int i = 0; i < 300; i++) {
            cycles(1);
            read_motion();
        }
        for (int i = 0; i < 3; i++) /* a motor that stands */
            ck_assert(motion[i].ConstantVelocity && !motion[i].DirectionPositive && !motion[i].DirectionNegative);
    }
    motion[0].Source = (MC_SOURCE)5;
    MC_ReadMotionState(&motion[0]);
    ck_assert(!motion[0].Valid && motion[0].Error && motion[0].ErrorID == id(CM1E_ERROR_INVALID_ARGUMENT));
    ck_assert(!motion[0].ConstantVelocity);
    simulate("lose 1");
    cycles(2);
    MC_ReadMotionState(&motion[1]);
    ck_assert(!motion[1].Valid && motion[1].Busy && motion[1].ErrorID == id(CM1E_ERROR_AXIS_OFFLINE));
    MC_ReadMotionState(&motion[2]);
    ck_assert(motion[2].Valid); /* the set-point is the axis's own */
    close_segment();
}
END_TEST

/* ---- touch probes ------------------------------------------------------------------------------------------------ */

static MC_TouchProbe_t probe_fb;

static void arm(const MC_TRIGGER_REF *trigger)
{
    probe_fb = (MC_TouchProbe_t){.Axis = &reference, .TriggerInput = trigger};
    MC_TouchProbe(&probe_fb);
    probe_fb.Execute = TRUE;
    MC_TouchProbe(&probe_fb);
    ck_assert(probe_fb.Busy && !probe_fb.Error && !probe_fb.Done);
}

static void cycles_with_probe(int n)
{
    while (n-- > 0) {
        inputs();
        MC_TouchProbe(&probe_fb);
        outputs();
    }
}

/* The simulated switch is exact to the count: where is it said to be? */
START_TEST(test_touch_probe_finds_a_switch_within_its_uncertainty)
{
    begin();
    enable();
    const MC_TRIGGER_REF on = {.InputNumber = 2}, off = {.Axis = reference, .InputNumber = 2, .FallingEdge = TRUE};
    const double at = 100000.0 - probe().position_counts + info().actual_position * 50000.0; /* in its coordinates */
    static const double velocities[] = {0.2, 1.0, 5.0, 20.0, 45.0};
    for (int i = 0; i < 10; i++) {
        const double velocity = velocities[i / 2];
        const bool ahead = i % 2 == 0;
        const cm1e_command_id_t move = command(&(cm1e_axis_command_t){
            .kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = ahead ? 4.0 : 0.0, .velocity = velocity});
        arm(ahead ? &on : &off);
        while (cm1e_axis_command_status(axis, move).state == CM1E_COMMAND_ACTIVE)
            cycles_with_probe(1);
        ck_assert(probe_fb.Done && !probe_fb.Busy);
        const double error = fabs(probe_fb.RecordedPosition * 50000.0 - at), said = probe_fb.Uncertainty * 50000.0;
        /* Half the way of a cycle; the input is of the same moment as the position in the simulator. */
        ck_assert_msg(said <= velocity * 50000.0 * 0.0005 + 2.0, "%g u/s: +-%g counts", velocity, said);
        ck_assert_msg(error <= said + 2.0, "%g u/s: %g counts away, +-%g said", velocity, error, said);
        MC_TouchProbe(&probe_fb);
        ck_assert(probe_fb.Done);
        probe_fb.Execute = FALSE;
        MC_TouchProbe(&probe_fb);
        ck_assert(!probe_fb.Done);
    }
    close_segment();
}
END_TEST

START_TEST(test_touch_probe_goes_on_when_it_is_not_called)
{
    begin();
    enable();
    const MC_TRIGGER_REF on = {.InputNumber = 2};
    arm(&on);
    probe_fb.Execute = FALSE;
    move_to(4.0, 10.0);
    move_to(0.0, 10.0);
    move_to(4.0, 2.0);
    MC_TouchProbe(&probe_fb);
    ck_assert(probe_fb.Done); /* for one call */
    ck_assert_double_gt(probe_fb.Uncertainty * 50000.0, 150.0); /* of the first, fast, pass */
    MC_TouchProbe(&probe_fb);
    ck_assert(!probe_fb.Done);
    close_segment();
}
END_TEST

static void abort_trigger(const MC_TRIGGER_REF *trigger, cm1e_error_t expected)
{
    MC_AbortTrigger_t fb = {.Axis = &reference, .TriggerInput = trigger, .Execute = TRUE};
    MC_AbortTrigger(&fb);
    ck_assert(fb.Busy == (expected == CM1E_OK) && fb.Error == (expected != CM1E_OK) && fb.ErrorID == id(expected));
    MC_AbortTrigger(&fb);
    ck_assert(fb.Done == (expected == CM1E_OK) && !fb.Busy);
    fb.Execute = FALSE;
    MC_AbortTrigger(&fb);
    ck_assert(!fb.Done && !fb.Error);
}

START_TEST(test_abort_and_a_second_block_show_command_aborted)
{
    begin();
    const MC_TRIGGER_REF on = {.InputNumber = 4}, off = {.InputNumber = 4, .FallingEdge = TRUE};
    arm(&on);
    abort_trigger(&off, CM1E_OK); /* another trigger, and nobody waits for it */
    cycles_with_probe(1);
    ck_assert(probe_fb.Busy);
    abort_trigger(&on, CM1E_OK);
    cycles_with_probe(1);
    ck_assert(probe_fb.CommandAborted && !probe_fb.Busy && !probe_fb.Done);
    switch_input(4, "on");
    cycles_with_probe(1);
    ck_assert(probe_fb.CommandAborted);
    switch_input(4, "off");
    arm(&on);
    MC_TouchProbe_t second = {.Axis = &reference, .TriggerInput = &on, .Execute = TRUE};
    MC_TouchProbe(&second);
    cycles_with_probe(1);
    ck_assert(probe_fb.CommandAborted);
    switch_input(4, "on");
    MC_TouchProbe(&second);
    ck_assert(second.Done);
    close_segment();
}
END_TEST

START_TEST(test_triggers_and_windows_that_cannot_be_are_refused)
{
    begin();
    const MC_TRIGGER_REF wrong = {.InputNumber = 5}, other = {.Axis = {.Handle = 77}, .InputNumber = 1};
    MC_TouchProbe_t fb = {.Axis = &reference, .TriggerInput = &wrong, .Execute = TRUE};
    MC_TouchProbe(&fb);
    ck_assert(fb.Error && fb.ErrorID == id(CM1E_ERROR_AXIS_SIGNAL));
    fb = (MC_TouchProbe_t){.Axis = &reference, .TriggerInput = &other, .Execute = TRUE};
    MC_TouchProbe(&fb);
    ck_assert(fb.Error && fb.ErrorID == id(CM1E_ERROR_UNSUPPORTED));
    told("TriggerInput.Axis is 77; the Axis of the block, or a Handle of 0, is right.");
    fb = (MC_TouchProbe_t){.Axis = &reference, .Execute = TRUE, .WindowOnly = TRUE, .FirstPosition = 1.0};
    MC_TouchProbe(&fb);
    ck_assert(fb.Error && fb.ErrorID == id(CM1E_ERROR_AXIS_POSITION_RANGE));
    fb = (MC_TouchProbe_t){.Axis = &reference, .Execute = TRUE, .FirstPosition = 1.0}; /* no window */
    MC_TouchProbe(&fb);
    ck_assert(fb.Busy);
    fb.Axis = &nothing;
    MC_TouchProbe(&fb);
    ck_assert(fb.Error && fb.ErrorID == id(CM1E_ERROR_FB_AXIS_CHANGED));
    abort_trigger(&wrong, CM1E_ERROR_AXIS_SIGNAL);
    abort_trigger(&other, CM1E_ERROR_UNSUPPORTED);
    close_segment();
}
END_TEST

START_TEST(test_a_trigger_while_the_bus_is_away_is_an_error)
{
    begin();
    const MC_TRIGGER_REF on = {.InputNumber = 4};
    arm(&on);
    simulate("lose 2");
    simulate("sensor 1 4 on");
    cycles_with_probe(4);
    ck_assert(probe_fb.Done); /* two frames are ridden out */
    switch_input(4, "off");
    arm(&on);
    simulate("lose 40");
    simulate("sensor 1 4 on");
    cycles_with_probe(45);
    ck_assert(probe_fb.Error && probe_fb.ErrorID == id(CM1E_ERROR_AXIS_PROBE) && probe_fb.RecordedPosition == 0.0);
    close_segment();
}
END_TEST

/* ---- cam switches on the motor's output -------------------------------------------------------------------------- */

START_TEST(test_digital_cam_switch_drives_the_output_of_the_motor)
{
    begin();
    enable();
    static MC_CAMSWITCH_REF cams = {.NumberOfSwitches = 1,
                                    .Switches = {{.TrackNumber = 1, .FirstOnPosition = 1.0, .LastOnPosition = 2.5}}};
    MC_OUTPUT_REF output = {.Axis = reference};
    MC_DigitalCamSwitch_t fb = {.Axis = &reference, .Switches = &cams, .Outputs = &output, .Enable = TRUE,
                                .EnableMask = 1, .ValueSource = mcActualValue};
    const double zero = probe().position_counts / 50000.0 - info().actual_position;
    int changes = 0;
    for (int way = 0; way < 2; way++) {
        const cm1e_command_id_t move = command(&(cm1e_axis_command_t){
            .kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = way ? 0.0 : 4.0, .velocity = 4.0});
        bool before = false;
        while (cm1e_axis_command_status(axis, move).state == CM1E_COMMAND_ACTIVE) {
            inputs();
            MC_DigitalCamSwitch(&fb);
            outputs();
            const cm1e_sim_probe_t now = probe();
            const double p = now.position_counts / 50000.0 - zero;
            changes += (now.digital_outputs & 1) != before;
            before = now.digital_outputs & 1;
            if ((p > 1.02 && p < 2.48 && !before) || ((p < 0.98 || p > 2.52) && before))
                ck_abort_msg("at %g the output is %d", p, before);
        }
    }
    ck_assert_int_eq(changes, 4);
    move_to(2.0, 10.0);
    for (int i = 0; i < 50; i++) {
        inputs();
        MC_DigitalCamSwitch(&fb);
        outputs();
    }
    ck_assert_uint_eq(probe().digital_outputs, 1);
    cycles(98); /* nobody asks for it any more */
    ck_assert_uint_eq(probe().digital_outputs, 1);
    cycles(5);
    ck_assert_uint_eq(probe().digital_outputs, 0);
    close_segment();
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("signals");
    TCase *tcase = tcase_create("signals");
    tcase_add_test(tcase, test_a_number_that_is_wrong_is_told_with_those_that_are_right);
    tcase_add_test(tcase, test_a_wrong_number_is_told_when_another_one_is_right);
    tcase_add_test(tcase, test_what_is_refused_is_told_in_words);
    tcase_add_test(tcase, test_read_digital_input);
    tcase_add_test(tcase, test_write_and_read_digital_output);
    tcase_add_test(tcase, test_output_stays_off_after_its_motor_was_away);
    tcase_add_test(tcase, test_read_axis_info);
    tcase_add_test(tcase, test_read_actual_torque);
    tcase_add_test(tcase, test_torque_control_says_that_there_is_no_torque_mode);
    tcase_add_test(tcase, test_read_motion_state);
    tcase_add_test(tcase, test_touch_probe_finds_a_switch_within_its_uncertainty);
    tcase_add_test(tcase, test_touch_probe_goes_on_when_it_is_not_called);
    tcase_add_test(tcase, test_abort_and_a_second_block_show_command_aborted);
    tcase_add_test(tcase, test_triggers_and_windows_that_cannot_be_are_refused);
    tcase_add_test(tcase, test_a_trigger_while_the_bus_is_away_is_an_error);
    tcase_add_test(tcase, test_digital_cam_switch_drives_the_output_of_the_motor);
    suite_add_tcase(suite, tcase);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed != 0;
}
