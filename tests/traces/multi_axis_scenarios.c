/* Scenarios of mc_multi_axis.h. */
#include "diagram.h"

/** Out and back while the master goes by 4 u; at rest at both ends. */
static const MC_CAM_POINT out_and_back[] = {{0, 0, 0, 0}, {2, 1, 0, 0}, {4, 0, 0, 0}};
static const MC_CAM_REF cam = {.Points = out_and_back, .NumberOfPoints = 3};

static void cam_table_select(void)
{
    MC_MoveVelocity_t turn = {MASTER, .Velocity = 8};
    MC_CamTableSelect_t select = {MASTER_AND_SLAVE, .CamTable = &cam, .Periodic = TRUE};
    MC_CamIn_t in = {MASTER_AND_SLAVE, .StartMode = mcRelative};
    trace_begin_with_masters("MC_CamTableSelect", "A cam is made ready; its CamTableID is used when Done is there.", 1);
    trace_block("MC_CamTableSelect", "MC_CamTableSelect", &select);
    trace_block("MC_CamIn", "MC_CamIn", &in);
    trace_master_curves(0, true, false);
    trace_curves(true, false);
    UNTIL(1200) {
        turn.Execute = during(300, 1200);
        select.Execute = during(50, 150);
        MC_MoveVelocity(&turn);
        MC_CamTableSelect(&select);
        in.CamTableID = select.CamTableID;
        in.Execute = in.Execute || select.Done;
        MC_CamIn(&in);
    }
    trace_end();
}

static void cam_in(void)
{
    MC_MoveVelocity_t turn = {MASTER, .Velocity = 5};
    MC_CamTableSelect_t select = {MASTER_AND_SLAVE, .CamTable = &cam, .Periodic = TRUE, .MasterAbsolute = TRUE,
                                  .SlaveAbsolute = TRUE};
    MC_CamIn_t in = {MASTER_AND_SLAVE, .StartMode = mcRampIn};
    trace_begin_with_masters("MC_CamIn",
                             "mcRampIn while the master goes: the slave gets into a periodic cam, and is InSync from "
                             "then on.\nEndOfProfile shows each turn of it.",
                             1);
    trace_block("MC_CamIn", "", &in);
    trace_master_curves(0, true, false);
    trace_curves(true, true);
    UNTIL(2500) {
        turn.Execute = during(10, 2500);
        select.Execute = TRUE;
        in.Execute = during(600, 2000);
        MC_MoveVelocity(&turn);
        MC_CamTableSelect(&select);
        in.CamTableID = select.CamTableID;
        MC_CamIn(&in);
    }
    trace_end();
}

static void cam_out(void)
{
    MC_MoveVelocity_t turn = {MASTER, .Velocity = 8};
    MC_CamTableSelect_t select = {MASTER_AND_SLAVE, .CamTable = &cam, .Periodic = TRUE};
    MC_CamIn_t in = {MASTER_AND_SLAVE, .StartMode = mcRelative};
    MC_CamOut_t out = {SLAVE};
    MC_Halt_t halt = {AXIS, .Deceleration = 20};
    trace_begin_with_masters("MC_CamOut",
                             "In the middle of a cam: the slave keeps the velocity that it has, until MC_Halt.", 1);
    trace_block("MC_CamIn", "MC_CamIn", &in);
    trace_block("MC_CamOut", "MC_CamOut", &out);
    trace_block("MC_Halt", "MC_Halt", &halt);
    trace_curves(true, true);
    UNTIL(1500) {
        turn.Execute = during(50, 1500);
        select.Execute = TRUE;
        in.Execute = during(30, 1400);
        out.Execute = during(750, 850);
        halt.Execute = during(1000, 1400);
        MC_MoveVelocity(&turn);
        MC_CamTableSelect(&select);
        in.CamTableID = select.CamTableID;
        MC_CamIn(&in);
        MC_CamOut(&out);
        MC_Halt(&halt);
    }
    trace_end();
}

static void gear_in(void)
{
    MC_MoveVelocity_t forth = {MASTER, .Velocity = 6, .Acceleration = 40}, back = forth;
    MC_GearIn_t first = {MASTER_AND_SLAVE, .RatioNumerator = 1, .RatioDenominator = 2, .Acceleration = 20};
    MC_GearIn_t second = {MASTER_AND_SLAVE, .RatioNumerator = -1, .RatioDenominator = 4, .Acceleration = 20};
    back.Velocity = -6;
    trace_begin_with_masters("MC_GearIn",
                             "Half as fast as the master, which turns round meanwhile; a second instance changes the "
                             "ratio to -1 : 4.",
                             1);
    trace_block("MC_GearIn", "first", &first);
    trace_block("MC_GearIn", "second", &second);
    trace_master_curves(0, false, true);
    trace_curves(false, true);
    UNTIL(2000) {
        forth.Execute = during(10, 2000);
        back.Execute = during(900, 2000);
        first.Execute = during(300, 1500);
        second.Execute = during(1500, 2000);
        MC_MoveVelocity(&forth);
        MC_MoveVelocity(&back);
        MC_GearIn(&first);
        MC_GearIn(&second);
    }
    trace_end();
}

static void gear_out(void)
{
    MC_MoveVelocity_t turn = {MASTER, .Velocity = 6};
    MC_GearIn_t in = {MASTER_AND_SLAVE, .RatioNumerator = 1, .RatioDenominator = 2};
    MC_GearOut_t out = {SLAVE};
    MC_Halt_t halt = {AXIS, .Deceleration = 20};
    trace_begin_with_masters("MC_GearOut", "The slave keeps the velocity that it has, until MC_Halt.", 1);
    trace_block("MC_GearIn", "MC_GearIn", &in);
    trace_block("MC_GearOut", "MC_GearOut", &out);
    trace_block("MC_Halt", "MC_Halt", &halt);
    trace_master_curves(0, false, true);
    trace_curves(false, true);
    UNTIL(1400) {
        turn.Execute = during(10, 1400);
        in.Execute = during(200, 1300);
        out.Execute = during(600, 700);
        halt.Execute = during(900, 1300);
        MC_MoveVelocity(&turn);
        MC_GearIn(&in);
        MC_GearOut(&out);
        MC_Halt(&halt);
    }
    trace_end();
}

static void gear_in_pos(void)
{
    MC_MoveVelocity_t turn = {MASTER, .Velocity = 5};
    MC_GearInPos_t in = {MASTER_AND_SLAVE, .RatioNumerator = 1, .RatioDenominator = 1, .MasterSyncPosition = 5,
                         .SlaveSyncPosition = 1, .MasterStartDistance = 2, .Velocity = 20};
    trace_begin_with_masters("MC_GearInPos",
                             "The slave begins when the master is 2 u before 5 u, and is at 1 u when the master is at "
                             "5 u;\nfrom there on it goes like the master.",
                             1);
    trace_block("MC_GearInPos", "", &in);
    trace_master_curves(0, true, false);
    trace_curves(true, true);
    UNTIL(1700) {
        turn.Execute = during(10, 1700);
        in.Execute = during(200, 1500);
        MC_MoveVelocity(&turn);
        MC_GearInPos(&in);
    }
    trace_end();
}

static void phasing_absolute(void)
{
    MC_MoveVelocity_t turn = {MASTER, .Velocity = 3};
    MC_GearIn_t in = {MASTER_AND_SLAVE, .RatioNumerator = 1, .RatioDenominator = 1};
    MC_PhasingAbsolute_t there = {MASTER_AND_SLAVE, .PhaseShift = 1, .Velocity = 4, .Acceleration = 40};
    MC_PhasingAbsolute_t back = {MASTER_AND_SLAVE, .Velocity = 4, .Acceleration = 40};
    trace_begin_with_masters("MC_PhasingAbsolute", "A phase shift of 1 u to a slave in gear, and back to 0.", 1);
    trace_block("MC_GearIn", "MC_GearIn", &in);
    trace_block("MC_PhasingAbsolute", "to 1 u", &there);
    trace_block("MC_PhasingAbsolute", "to 0", &back);
    trace_value("MC_PhasingAbsolute", &there, "AbsolutePhaseShift", "u");
    trace_value("MC_PhasingAbsolute", &back, "AbsolutePhaseShift", "u");
    trace_curves(false, true);
    UNTIL(2000) {
        turn.Execute = during(10, 2000);
        in.Execute = during(150, 2000);
        there.Execute = during(500, 1100);
        back.Execute = during(1300, 1900);
        MC_MoveVelocity(&turn);
        MC_GearIn(&in);
        MC_PhasingAbsolute(&there);
        MC_PhasingAbsolute(&back);
    }
    trace_end();
}

static void phasing_relative(void)
{
    MC_MoveVelocity_t turn = {MASTER, .Velocity = 3};
    MC_GearIn_t in = {MASTER_AND_SLAVE, .RatioNumerator = 1, .RatioDenominator = 1};
    MC_PhasingRelative_t first = {MASTER_AND_SLAVE, .PhaseShift = 0.5, .Velocity = 4, .Acceleration = 40};
    MC_PhasingRelative_t second = {MASTER_AND_SLAVE, .PhaseShift = 0.5, .Velocity = 4, .Acceleration = 40,
                                   .BufferMode = mcBuffered};
    trace_begin_with_masters("MC_PhasingRelative", "By 0.5 u, and by 0.5 u more, which waits until then (mcBuffered).",
                             1);
    trace_block("MC_GearIn", "MC_GearIn", &in);
    trace_block("MC_PhasingRelative", "first", &first);
    trace_block("MC_PhasingRelative", "second", &second);
    trace_value("MC_PhasingRelative", &first, "CoveredPhaseShift", "u");
    trace_value("MC_PhasingRelative", &second, "CoveredPhaseShift", "u");
    trace_curves(false, true);
    UNTIL(1600) {
        turn.Execute = during(10, 1600);
        in.Execute = during(150, 1600);
        first.Execute = during(500, 1500);
        second.Execute = during(550, 1500);
        MC_MoveVelocity(&turn);
        MC_GearIn(&in);
        MC_PhasingRelative(&first);
        MC_PhasingRelative(&second);
    }
    trace_end();
}

static void combine_axes(void)
{
    MC_MoveVelocity_t turn = {MASTER, .Velocity = 4};
    MC_MoveRelative_t more = {.Axis = &bench.masters[1], .Distance = 2, .Velocity = 4, .Acceleration = 40};
    MC_CombineAxes_t in = {.Master1 = &bench.masters[0], .Master2 = &bench.masters[1], SLAVE, MC_COMBINEAXES_DEFAULTS};
    trace_begin_with_masters("MC_CombineAxes", "The slave goes as the sum of its masters does.", 2);
    trace_block("MC_CombineAxes", "", &in);
    trace_master_curves(0, false, true);
    trace_master_curves(1, false, true);
    trace_curves(false, true);
    UNTIL(2000) {
        turn.Execute = during(400, 2000);
        more.Execute = during(900, 1800);
        in.Execute = during(200, 1800);
        MC_MoveVelocity(&turn);
        MC_MoveRelative(&more);
        MC_CombineAxes(&in);
    }
    trace_end();
}

const scenario_t multi_axis_scenarios[] = {
    {"MC_CamTableSelect", cam_table_select},
    {"MC_CamIn", cam_in},
    {"MC_CamOut", cam_out},
    {"MC_GearIn", gear_in},
    {"MC_GearOut", gear_out},
    {"MC_GearInPos", gear_in_pos},
    {"MC_PhasingAbsolute", phasing_absolute},
    {"MC_PhasingRelative", phasing_relative},
    {"MC_CombineAxes", combine_axes},
    {NULL, NULL},
};
