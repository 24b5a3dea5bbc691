/* Scenarios of mc_homing.h. */
#include <math.h>

#include "diagram.h"

static void switches(cm1e_axis_config_t *config)
{
    config->sim.sensor_input2 = 2000;
    config->sim.sensor_input3 = -3000;
    config->inputs = (cm1e_input_config_t){.home = 2, .limit_negative = 3};
}

static MC_StepAbsoluteSwitch_t fast, slow;
static MC_FinishHoming_t finish;

static void sequence(const char *block, const char *about)
{
    fast = (MC_StepAbsoluteSwitch_t){AXIS, .Velocity = 8, .SwitchMode = mcRisingEdge, .SetPosition = NAN};
    slow = (MC_StepAbsoluteSwitch_t){AXIS, .Direction = mcNegativeDirection, .Velocity = 1, .SwitchMode = mcFallingEdge,
                                     .SetPosition = 5};
    finish = (MC_FinishHoming_t){AXIS, .Distance = -1, .Velocity = 8};
    trace_configure(switches);
    trace_begin(block, about);
}

static void call_sequence(int end)
{
    UNTIL(end) {
        fast.Execute = bench.scan >= 20 && bench.scan < end - 50;
        slow.Execute = fast.Done && fast.Execute;
        finish.Execute = slow.Done && fast.Execute;
        MC_StepAbsoluteSwitch(&fast);
        MC_StepAbsoluteSwitch(&slow);
        MC_FinishHoming(&finish);
    }
    trace_end();
}

static void absolute_switch(void)
{
    sequence("MC_StepAbsoluteSwitch",
             "The switch is on beyond a place: found fast, then left slowly. There the axis has position 5.");
    trace_block("MC_StepAbsoluteSwitch", "fast", &fast);
    trace_block("MC_StepAbsoluteSwitch", "slow", &slow);
    trace_curves(true, true);
    call_sequence(1500);
}

static void finish_homing(void)
{
    sequence("MC_FinishHoming",
             "After two steps the axis goes 1 u away from the reference and is in Standstill, homed.");
    trace_block("MC_StepAbsoluteSwitch", "slow step", &slow);
    trace_block("MC_FinishHoming", "MC_FinishHoming", &finish);
    trace_curves(true, true);
    call_sequence(1500);
}

static void limit_switch(void)
{
    MC_StepLimitSwitch_t step = {AXIS, .Direction = mcNegativeDirection, .Velocity = 5, .LimitSwitchMode = mcRisingEdge,
                                 .SetPosition = -3};
    trace_configure(switches);
    trace_begin("MC_StepLimitSwitch",
                "Runs onto the negative limit switch and stops; the switch's place is -3. The axis stays in Homing "
                "for\n"
                "the next step.");
    trace_block("MC_StepLimitSwitch", "", &step);
    trace_curves(true, true);
    UNTIL(1000) {
        step.Execute = during(20, 950);
        MC_StepLimitSwitch(&step);
    }
    trace_end();
}

static void block(void)
{
    MC_StepBlock_t step = {AXIS, .Direction = mcNegativeDirection, .Velocity = 20, .TorqueLimit = 30,
                           .SetPosition = -10};
    trace_begin("MC_StepBlock", "Against the negative hard stop, seen by torque without velocity; that place is -10.");
    trace_block("MC_StepBlock", "", &step);
    trace_curves(true, true);
    UNTIL(1200) {
        step.Execute = during(20, 1150);
        MC_StepBlock(&step);
    }
    trace_end();
}

static void home_direct(void)
{
    MC_HomeDirect_t home = {AXIS, .SetPosition = 3};
    trace_begin("MC_HomeDirect", "The axis stands, and has position 3 from now on.");
    trace_block("MC_HomeDirect", "", &home);
    trace_curves(true, false);
    UNTIL(100) {
        home.Execute = during(20, 80);
        MC_HomeDirect(&home);
    }
    trace_end();
}

#define REFUSED(TYPE, MEMBER, ABOUT)                                                                                 \
    static void MEMBER(void)                                                                                         \
    {                                                                                                                \
        MC_##TYPE##_t fb = {AXIS};                                                                                   \
        trace_begin("MC_" #TYPE, ABOUT);                                                                             \
        trace_block("MC_" #TYPE, "", &fb);                                                                           \
        trace_value("MC_" #TYPE, &fb, "ErrorID", "");                                                                \
        UNTIL(100) {                                                                                                 \
            fb.Execute = during(20, 80);                                                                             \
            MC_##TYPE(&fb);                                                                                          \
        }                                                                                                            \
        trace_end();                                                                                                 \
    }
REFUSED(StepReferencePulse, reference_pulse, "The motor shows no reference pulse: refused, and nothing moves.")
REFUSED(StepDistanceCoded, distance_coded, "The motor's encoder is not distance coded: refused, and nothing moves.")
REFUSED(HomeAbsolute, home_absolute, "The motor's encoder is not absolute: refused.")
REFUSED(StepReferenceFlyingSwitch, flying_switch, "Refused: homing in motion is not supported.")
REFUSED(StepReferenceFlyingRefPulse, flying_pulse, "Refused: the motor shows no reference pulse.")
REFUSED(AbortPassiveHoming, abort_passive, "Refused: homing in motion is not supported.")

const scenario_t homing_scenarios[] = {
    {"MC_StepAbsoluteSwitch", absolute_switch},
    {"MC_StepLimitSwitch", limit_switch},
    {"MC_StepBlock", block},
    {"MC_StepReferencePulse", reference_pulse},
    {"MC_StepDistanceCoded", distance_coded},
    {"MC_HomeDirect", home_direct},
    {"MC_HomeAbsolute", home_absolute},
    {"MC_FinishHoming", finish_homing},
    {"MC_StepReferenceFlyingSwitch", flying_switch},
    {"MC_StepReferenceFlyingRefPulse", flying_pulse},
    {"MC_AbortPassiveHoming", abort_passive},
    {NULL, NULL},
};
