/* Scenarios of mc_administrative.h. */
#include "diagram.h"

static void set_position(void)
{
    MC_MoveRelative_t move = {AXIS, .Distance = 2, .Velocity = 5};
    MC_SetPosition_t set = {AXIS, .Position = 10, .Relative = TRUE};
    trace_begin("MC_SetPosition", "10 u are added in the middle of a motion: the position jumps, the motor does not.");
    trace_block("MC_MoveRelative", "MC_MoveRelative", &move);
    trace_block("MC_SetPosition", "MC_SetPosition", &set);
    trace_curves(true, true);
    UNTIL(700) {
        move.Execute = during(20, 600);
        set.Execute = during(250, 400);
        MC_MoveRelative(&move);
        MC_SetPosition(&set);
    }
    trace_end();
}

static void set_override(void)
{
    MC_MoveVelocity_t turn = {AXIS, .Velocity = 4, .Acceleration = 40};
    MC_SetOverride_t override = {AXIS, MC_SETOVERRIDE_DEFAULTS};
    trace_begin("MC_SetOverride",
                "VelFactor 1, 0.5, 0 and 1 again while the axis turns; Enable falls and the last one stays.");
    trace_block("MC_MoveVelocity", "MC_MoveVelocity", &turn);
    trace_block("MC_SetOverride", "MC_SetOverride", &override);
    trace_value("MC_SetOverride", &override, "VelFactor", "");
    trace_curves(false, true);
    UNTIL(1200) {
        const int now = bench.scan;
        turn.Execute = during(20, 1200);
        override.Enable = during(200, 1000);
        override.VelFactor = now < 300 ? 1 : now < 500 ? 0.5 : now < 750 ? 0 : 1;
        MC_MoveVelocity(&turn);
        MC_SetOverride(&override);
    }
    trace_end();
}

static void read_parameter(void)
{
    MC_MoveRelative_t move = {AXIS, .Distance = 1, .Velocity = 5};
    MC_ReadParameter_t read = {AXIS, .ParameterNumber = 11};
    trace_begin("MC_ReadParameter", "Parameter 11, the commanded velocity, during a move.");
    trace_block("MC_MoveRelative", "MC_MoveRelative", &move);
    trace_block("MC_ReadParameter", "MC_ReadParameter", &read);
    trace_value("MC_ReadParameter", &read, "Value", "u/s");
    UNTIL(500) {
        move.Execute = during(50, 450);
        read.Enable = during(20, 400);
        MC_MoveRelative(&move);
        MC_ReadParameter(&read);
    }
    trace_end();
}

static void read_bool_parameter(void)
{
    MC_WriteBoolParameter_t write = {AXIS, .ParameterNumber = 6, .Value = FALSE};
    MC_ReadBoolParameter_t read = {AXIS, .ParameterNumber = 6};
    trace_begin("MC_ReadBoolParameter",
                "Parameter 6, monitoring of the position lag, which MC_WriteBoolParameter switches off.");
    trace_block("MC_WriteBoolParameter", "MC_WriteBoolParameter", &write);
    trace_block("MC_ReadBoolParameter", "MC_ReadBoolParameter", &read);
    UNTIL(100) {
        write.Execute = during(50, 70);
        read.Enable = during(20, 90);
        MC_WriteBoolParameter(&write);
        MC_ReadBoolParameter(&read);
    }
    trace_end();
}

static void write_parameter(void)
{
    MC_WriteParameter_t write = {AXIS, .ParameterNumber = 9, .Value = 2};
    MC_MoveVelocity_t turn = {AXIS, .Velocity = 4};
    trace_begin("MC_WriteParameter",
                "Parameter 9, the maximum velocity of the application, becomes 2 u/s: 4 u/s are refused from then "
                "on,\n"
                "and 12 is a number that may not be written.");
    trace_block("MC_WriteParameter", "MC_WriteParameter", &write);
    trace_block("MC_MoveVelocity", "MC_MoveVelocity", &turn);
    UNTIL(300) {
        write.Execute = during(20, 50) || during(200, 250);
        write.ParameterNumber = bench.scan < 100 ? 9 : 12;
        turn.Execute = during(80, 150);
        MC_WriteParameter(&write);
        MC_MoveVelocity(&turn);
    }
    trace_end();
}

static void limits(cm1e_axis_config_t *config)
{
    config->software_limit_positive = 5;
    config->software_limit_negative = -5;
}

static void write_bool_parameter(void)
{
    MC_WriteBoolParameter_t write = {AXIS, .ParameterNumber = 4, .Value = FALSE};
    MC_MoveAbsolute_t move = {AXIS, .Position = 6, .Velocity = 20};
    trace_configure(limits);
    trace_begin("MC_WriteBoolParameter",
                "A move beyond the software limit at 5 u is refused; parameter 4 FALSE takes the limit away, and "
                "it is taken.");
    trace_block("MC_WriteBoolParameter", "MC_WriteBoolParameter", &write);
    trace_block("MC_MoveAbsolute", "MC_MoveAbsolute", &move);
    trace_curves(true, false);
    UNTIL(800) {
        write.Execute = during(100, 150);
        move.Execute = during(20, 80) || during(200, 750);
        MC_WriteBoolParameter(&write);
        MC_MoveAbsolute(&move);
    }
    trace_end();
}

/* ---- signals --------------------------------------------------------------------------------------------------- */

static void sensor(cm1e_axis_config_t *config) { config->sim.sensor_input2 = 2000; }

static void read_digital_input(void)
{
    MC_INPUT_REF input = {0};
    MC_MoveAbsolute_t first = {AXIS, .Position = 3, .Velocity = 10}, second = {AXIS, .Velocity = 10};
    MC_ReadDigitalInput_t read = {.Input = &input, .InputNumber = 2};
    trace_configure(sensor);
    trace_begin("MC_ReadDigitalInput", "IN2 is a switch beyond 2 u.");
    input.Axis = bench.axis;
    trace_block("MC_ReadDigitalInput", "", &read);
    trace_curves(true, false);
    UNTIL(1000) {
        first.Execute = during(50, 450);
        second.Execute = during(500, 900);
        read.Enable = during(20, 950);
        MC_MoveAbsolute(&first);
        MC_MoveAbsolute(&second);
        MC_ReadDigitalInput(&read);
    }
    trace_end();
}

static void digital_output(const char *name)
{
    MC_OUTPUT_REF output;
    MC_WriteDigitalOutput_t write = {.Output = &output, .OutputNumber = 1};
    MC_ReadDigitalOutput_t read = {.Output = &output, .OutputNumber = 1};
    trace_begin(name, "Output 1 on, and off again.");
    output = (MC_OUTPUT_REF){.Axis = bench.axis};
    trace_block("MC_WriteDigitalOutput", "MC_WriteDigitalOutput", &write);
    trace_block("MC_ReadDigitalOutput", "MC_ReadDigitalOutput", &read);
    UNTIL(100) {
        write.Value = bench.scan < 50;
        write.Execute = during(25, 40) || during(60, 75);
        read.Enable = during(10, 90);
        MC_WriteDigitalOutput(&write);
        MC_ReadDigitalOutput(&read);
    }
    trace_end();
}

static void read_digital_output(void) { digital_output("MC_ReadDigitalOutput"); }
static void write_digital_output(void) { digital_output("MC_WriteDigitalOutput"); }

static BOOL tracks[2];

static void digital_cam_switch(void)
{
    static const MC_CAMSWITCH_REF cams = {.NumberOfSwitches = 3,
        .Switches = {{.TrackNumber = 1, .FirstOnPosition = 0.5, .LastOnPosition = 1},
                     {.TrackNumber = 1, .FirstOnPosition = 1.5, .LastOnPosition = 2, .AxisDirection = 1},
                     {.TrackNumber = 2, .FirstOnPosition = 1, .CamSwitchMode = 1, .Duration = 100000000}}};
    MC_OUTPUT_REF outputs = {0};
    MC_MoveAbsolute_t move = {AXIS, .Position = 2.5, .Velocity = 5};
    MC_MoveAbsolute_t back = {AXIS, .Position = 0, .Velocity = 5};
    MC_DigitalCamSwitch_t cam = {AXIS, .Switches = &cams, .Outputs = &outputs, .EnableMask = 3};
    trace_begin("MC_DigitalCamSwitch",
                "Track 1: on from 0.5 to 1 u, and from 1.5 to 2 u in positive direction only. Track 2: 100 ms from "
                "1 u on.");
    trace_block("MC_DigitalCamSwitch", "", &cam);
    trace_signal("track 1", &tracks[0]);
    trace_signal("track 2", &tracks[1]);
    trace_curves(true, false);
    UNTIL(1600) {
        cam.Enable = during(20, 1550);
        move.Execute = during(50, 700);
        back.Execute = during(800, 1500);
        MC_MoveAbsolute(&move);
        MC_MoveAbsolute(&back);
        MC_DigitalCamSwitch(&cam);
        tracks[0] = (outputs.Values & 1) != 0;
        tracks[1] = (outputs.Values & 2) != 0;
    }
    trace_end();
}

static void touch_probe(void)
{
    static const MC_TRIGGER_REF trigger = {.InputNumber = 2};
    MC_MoveAbsolute_t move = {AXIS, .Position = 3, .Velocity = 10};
    MC_TouchProbe_t probe = {AXIS, .TriggerInput = &trigger};
    trace_configure(sensor);
    trace_begin("MC_TouchProbe", "IN2 goes on at 2 u: that position is recorded.");
    trace_block("MC_MoveAbsolute", "MC_MoveAbsolute", &move);
    trace_block("MC_TouchProbe", "MC_TouchProbe", &probe);
    trace_curves(true, false);
    trace_value("MC_TouchProbe", &probe, "RecordedPosition", "u");
    UNTIL(600) {
        move.Execute = during(50, 550);
        probe.Execute = during(20, 500);
        MC_MoveAbsolute(&move);
        MC_TouchProbe(&probe);
    }
    trace_end();
}

static void abort_trigger(void)
{
    static const MC_TRIGGER_REF trigger = {.InputNumber = 2};
    MC_TouchProbe_t probe = {AXIS, .TriggerInput = &trigger};
    MC_AbortTrigger_t abort = {AXIS, .TriggerInput = &trigger};
    trace_begin("MC_AbortTrigger", "Nobody waits any more.");
    trace_block("MC_TouchProbe", "MC_TouchProbe", &probe);
    trace_block("MC_AbortTrigger", "MC_AbortTrigger", &abort);
    UNTIL(100) {
        probe.Execute = during(10, 80);
        abort.Execute = during(50, 70);
        MC_TouchProbe(&probe);
        MC_AbortTrigger(&abort);
    }
    trace_end();
}

/* ---- what the axis shows --------------------------------------------------------------------------------------- */

static MC_MoveRelative_t there, back;

static void go_there_and_back(void)
{
    if (!there.Axis) {
        there = (MC_MoveRelative_t){AXIS, .Distance = 2, .Velocity = 8};
        back = (MC_MoveRelative_t){AXIS, .Distance = -2, .Velocity = 8};
    }
    there.Execute = during(50, 500);
    back.Execute = during(550, 900);
    MC_MoveRelative(&there);
    MC_MoveRelative(&back);
}

#define READS(TYPE, MEMBER, UNIT, ABOUT)                                                                             \
    static void read_##MEMBER(void)                                                                                  \
    {                                                                                                                \
        MC_##TYPE##_t read = {AXIS};                                                                                 \
        there.Axis = NULL;                                                                                           \
        trace_begin("MC_" #TYPE, ABOUT);                                                                             \
        trace_block("MC_" #TYPE, "", &read);                                                                         \
        trace_value("MC_" #TYPE, &read, #MEMBER, UNIT);                                                              \
        UNTIL(1000) {                                                                                                \
            read.Enable = during(20, 930);                                                                           \
            go_there_and_back();                                                                                     \
            MC_##TYPE(&read);                                                                                        \
        }                                                                                                            \
        trace_end();                                                                                                 \
    }
READS(ReadActualPosition, Position, "u", "There and back by 2 u.")
READS(ReadActualVelocity, Velocity, "u/s", "There and back by 2 u.")
READS(ReadActualTorque, Torque, "% of rated", "There and back by 2 u: friction both ways, as the load is light.")

static void read_status(void)
{
    MC_ReadStatus_t status = {AXIS, .Enable = TRUE};
    MC_MoveAbsolute_t move = {AXIS, .Position = 1, .Velocity = 10};
    MC_MoveVelocity_t turn = {AXIS, .Velocity = 4};
    MC_Stop_t stop = {AXIS, .Deceleration = 40};
    trace_begin("MC_ReadStatus", "A move, a motion without end, MC_Stop, and a fault of the drive.");
    trace_block("MC_ReadStatus", "", &status);
    trace_curves(false, true);
    UNTIL(1000) {
        move.Execute = during(50, 300);
        turn.Execute = during(350, 500);
        stop.Execute = during(550, 750);
        if (bench.scan == 850)
            simulate("error 1 2310");
        MC_MoveAbsolute(&move);
        MC_MoveVelocity(&turn);
        MC_Stop(&stop);
        MC_ReadStatus(&status);
    }
    trace_end();
}

static void read_motion_state(void)
{
    MC_ReadMotionState_t state = {AXIS};
    there.Axis = NULL;
    trace_begin("MC_ReadMotionState", "There and back by 2 u; Source is mcSetValue.");
    trace_block("MC_ReadMotionState", "", &state);
    trace_curves(false, true);
    UNTIL(1000) {
        state.Enable = during(20, 950);
        go_there_and_back();
        MC_ReadMotionState(&state);
    }
    trace_end();
}

static void switches(cm1e_axis_config_t *config)
{
    config->sim.sensor_input2 = 2000;
    config->sim.sensor_input3 = -9000;
    config->inputs = (cm1e_input_config_t){.limit_positive = 2, .limit_negative = 3, .home = 4};
}

static void read_axis_info(void)
{
    MC_ReadAxisInfo_t info = {AXIS};
    MC_MoveAbsolute_t move = {AXIS, .Position = 3, .Velocity = 10};
    trace_configure(switches);
    trace_begin("MC_ReadAxisInfo",
                "The positive limit switch is at IN2 and on beyond 2 u; motor power is off at the end.");
    trace_block("MC_ReadAxisInfo", "", &info);
    trace_curves(true, false);
    UNTIL(700) {
        info.Enable = during(20, 680);
        move.Execute = during(50, 500);
        if (bench.scan == 600)
            simulate("power 1 off");
        MC_MoveAbsolute(&move);
        MC_ReadAxisInfo(&info);
    }
    trace_end();
}

static void read_axis_error(void)
{
    MC_MoveVelocity_t turn = {AXIS, .Velocity = 4};
    MC_ReadAxisError_t error = {AXIS, .Enable = TRUE};
    trace_begin("MC_ReadAxisError", "A fault of the drive in motion: torque overload.");
    trace_block("MC_MoveVelocity", "MC_MoveVelocity", &turn);
    trace_block("MC_ReadAxisError", "MC_ReadAxisError", &error);
    trace_value("MC_ReadAxisError", &error, "AxisErrorID", "");
    trace_value("MC_ReadAxisError", &error, "DeviceErrorCode", "");
    UNTIL(300) {
        turn.Execute = during(20, 280);
        if (bench.scan == 150)
            simulate("error 1 2310");
        MC_MoveVelocity(&turn);
        MC_ReadAxisError(&error);
    }
    trace_end();
}

static void reset(void)
{
    MC_MoveVelocity_t turn = {AXIS, .Velocity = 4};
    MC_Reset_t reset = {AXIS};
    trace_begin("MC_Reset",
                "A fault of the drive in motion, and its reset; MC_Power stays on, so the axis comes back to "
                "Standstill.");
    trace_block("MC_MoveVelocity", "MC_MoveVelocity", &turn);
    trace_block("MC_Reset", "MC_Reset", &reset);
    trace_curves(false, true);
    UNTIL(600) {
        turn.Execute = during(20, 300);
        reset.Execute = during(350, 550);
        if (bench.scan == 150)
            simulate("error 1 2310");
        MC_MoveVelocity(&turn);
        MC_Reset(&reset);
    }
    trace_end();
}

const scenario_t administrative_scenarios[] = {
    {"MC_SetPosition", set_position},
    {"MC_SetOverride", set_override},
    {"MC_ReadParameter", read_parameter},
    {"MC_ReadBoolParameter", read_bool_parameter},
    {"MC_WriteParameter", write_parameter},
    {"MC_WriteBoolParameter", write_bool_parameter},
    {"MC_ReadDigitalInput", read_digital_input},
    {"MC_ReadDigitalOutput", read_digital_output},
    {"MC_WriteDigitalOutput", write_digital_output},
    {"MC_ReadActualPosition", read_Position},
    {"MC_ReadActualVelocity", read_Velocity},
    {"MC_ReadActualTorque", read_Torque},
    {"MC_ReadStatus", read_status},
    {"MC_ReadMotionState", read_motion_state},
    {"MC_ReadAxisInfo", read_axis_info},
    {"MC_ReadAxisError", read_axis_error},
    {"MC_Reset", reset},
    {"MC_DigitalCamSwitch", digital_cam_switch},
    {"MC_TouchProbe", touch_probe},
    {"MC_AbortTrigger", abort_trigger},
    {NULL, NULL},
};
