/* Scenarios of mc_motion.h. */
#include <math.h>

#include "diagram.h"

static void power(void)
{
    MC_Power_t power = {AXIS, .EnablePositive = TRUE, .EnableNegative = TRUE};
    MC_MoveVelocity_t turn = {AXIS, .Velocity = 4};
    trace_begin_disabled("MC_Power",
                         "Enable, a motion, Enable taken away in motion: Disabled at once, the motor is ramped "
                         "down and\n"
                         "only then loses its torque; Status says so.");
    trace_block("MC_Power", "MC_Power", &power);
    trace_block("MC_MoveVelocity", "MC_MoveVelocity", &turn);
    trace_curves(false, true);
    UNTIL(600) {
        power.Enable = during(30, 450);
        turn.Execute = during(250, 600);
        MC_Power(&power);
        MC_MoveVelocity(&turn);
    }
    trace_end();
}

static void home(void)
{
    MC_Home_t home = {AXIS, .Position = 1};
    trace_begin("MC_Home", "The motor's own routine against the negative hard stop; the axis has position 1 there.");
    trace_block("MC_Home", "", &home);
    trace_curves(true, false);
    UNTIL(600) {
        home.Execute = during(50, 500);
        MC_Home(&home);
    }
    trace_end();
}

static void stop(void)
{
    MC_MoveVelocity_t turn = {AXIS, .Velocity = 4};
    MC_Stop_t stop = {AXIS, .Deceleration = 20};
    trace_begin("MC_Stop",
                "Done when the axis stands; it stays in Stopping until Execute falls. A command meanwhile "
                "is\n"
                "refused, one after it is taken.");
    trace_block("MC_MoveVelocity", "MC_MoveVelocity", &turn);
    trace_block("MC_Stop", "MC_Stop", &stop);
    trace_curves(false, true);
    UNTIL(1000) {
        turn.Execute = during(20, 400) || during(550, 620) || during(800, 1000);
        stop.Execute = during(250, 700);
        MC_MoveVelocity(&turn);
        MC_Stop(&stop);
    }
    trace_end();
}

static void halt(void)
{
    MC_MoveVelocity_t turn = {AXIS, .Velocity = 4, .Acceleration = 40};
    MC_Halt_t halt = {AXIS, .Deceleration = 20};
    trace_begin("MC_Halt", "Halted to standstill; then a halt that another motion aborts on its way.");
    trace_block("MC_MoveVelocity", "MC_MoveVelocity", &turn);
    trace_block("MC_Halt", "MC_Halt", &halt);
    trace_curves(false, true);
    UNTIL(1000) {
        turn.Execute = during(20, 150) || during(550, 650) || during(800, 1000);
        halt.Execute = during(200, 500) || during(720, 900);
        MC_MoveVelocity(&turn);
        MC_Halt(&halt);
    }
    trace_end();
}

static void move_absolute(void)
{
    MC_MoveAbsolute_t first = {AXIS, .Position = 3, .Velocity = 10}, second = {AXIS, .Position = 1, .Velocity = 10};
    trace_begin("MC_MoveAbsolute", "To 3 u; a second instance takes over on the way and goes to 1 u.");
    trace_block("MC_MoveAbsolute", "first", &first);
    trace_block("MC_MoveAbsolute", "second", &second);
    trace_curves(true, true);
    UNTIL(800) {
        first.Execute = during(20, 750);
        second.Execute = during(250, 750);
        MC_MoveAbsolute(&first);
        MC_MoveAbsolute(&second);
    }
    trace_end();
}

static void move_relative(void)
{
    MC_MoveRelative_t first = {AXIS, .Distance = 2, .Velocity = 10};
    MC_MoveRelative_t second = {AXIS, .Distance = 2, .Velocity = 5, .BufferMode = mcBuffered};
    trace_begin("MC_MoveRelative", "By 2 u; the second one is given at once and waits (mcBuffered).");
    trace_block("MC_MoveRelative", "first", &first);
    trace_block("MC_MoveRelative", "second", &second);
    trace_curves(true, true);
    UNTIL(1000) {
        first.Execute = during(20, 600);
        second.Execute = during(60, 950);
        MC_MoveRelative(&first);
        MC_MoveRelative(&second);
    }
    trace_end();
}

static void move_additive(void)
{
    MC_MoveAbsolute_t move = {AXIS, .Position = 3, .Velocity = 10};
    MC_MoveAdditive_t add = {AXIS, .Distance = 2, .Velocity = 10};
    trace_begin("MC_MoveAdditive", "2 u more than the 3 u that were commanded, given on the way: the end is at 5 u.");
    trace_block("MC_MoveAbsolute", "MC_MoveAbsolute", &move);
    trace_block("MC_MoveAdditive", "MC_MoveAdditive", &add);
    trace_curves(true, true);
    UNTIL(800) {
        move.Execute = during(20, 750);
        add.Execute = during(250, 750);
        MC_MoveAbsolute(&move);
        MC_MoveAdditive(&add);
    }
    trace_end();
}

static void move_superimposed(void)
{
    MC_MoveVelocity_t turn = {AXIS, .Velocity = 4, .Acceleration = 100};
    MC_MoveSuperimposed_t add = {AXIS, .Distance = 1, .VelocityDiff = 4};
    trace_begin("MC_MoveSuperimposed",
                "1 u more while the axis turns at 4 u/s: InVelocity looks at its own part only.");
    trace_block("MC_MoveVelocity", "MC_MoveVelocity", &turn);
    trace_block("MC_MoveSuperimposed", "MC_MoveSuperimposed", &add);
    trace_curves(false, true);
    trace_value("MC_MoveSuperimposed", &add, "CoveredDistance", "u");
    UNTIL(800) {
        turn.Execute = during(20, 800);
        add.Execute = during(200, 700);
        MC_MoveVelocity(&turn);
        MC_MoveSuperimposed(&add);
    }
    trace_end();
}

static void halt_superimposed(void)
{
    MC_MoveVelocity_t turn = {AXIS, .Velocity = 4, .Acceleration = 100};
    MC_MoveSuperimposed_t add = {AXIS, .Distance = 3, .VelocityDiff = 4};
    MC_HaltSuperimposed_t halt = {AXIS};
    trace_begin("MC_HaltSuperimposed", "Takes the added motion away; the one below it goes on.");
    trace_block("MC_MoveVelocity", "MC_MoveVelocity", &turn);
    trace_block("MC_MoveSuperimposed", "MC_MoveSuperimposed", &add);
    trace_block("MC_HaltSuperimposed", "MC_HaltSuperimposed", &halt);
    trace_curves(false, true);
    UNTIL(800) {
        turn.Execute = during(20, 800);
        add.Execute = during(200, 700);
        halt.Execute = during(450, 700);
        MC_MoveVelocity(&turn);
        MC_MoveSuperimposed(&add);
        MC_HaltSuperimposed(&halt);
    }
    trace_end();
}

static void move_velocity(void)
{
    MC_MoveVelocity_t turn = {AXIS, .Velocity = 4, .Acceleration = 40};
    trace_begin("MC_MoveVelocity", "4 u/s; Execute falls and nothing changes; a new edge with -2 u/s.");
    trace_block("MC_MoveVelocity", "", &turn);
    trace_curves(false, true);
    UNTIL(1000) {
        turn.Execute = during(20, 300) || during(450, 900);
        turn.Velocity = bench.scan < 400 ? 4 : -2;
        MC_MoveVelocity(&turn);
    }
    trace_end();
}

static void move_continuous_absolute(void)
{
    MC_MoveContinuousAbsolute_t move = {AXIS, .Position = 3, .EndVelocity = 3, .Velocity = 10};
    trace_begin("MC_MoveContinuousAbsolute", "Passes 3 u with 3 u/s and goes on with it.");
    trace_block("MC_MoveContinuousAbsolute", "", &move);
    trace_curves(true, true);
    UNTIL(800) {
        move.Execute = during(20, 700);
        MC_MoveContinuousAbsolute(&move);
    }
    trace_end();
}

static void move_continuous_relative(void)
{
    MC_MoveContinuousRelative_t move = {AXIS, .Distance = 2, .EndVelocity = -3, .Velocity = 10};
    trace_begin("MC_MoveContinuousRelative", "2 u further with -3 u/s: it goes beyond, turns round and passes there.");
    trace_block("MC_MoveContinuousRelative", "", &move);
    trace_curves(true, true);
    UNTIL(800) {
        move.Execute = during(20, 700);
        MC_MoveContinuousRelative(&move);
    }
    trace_end();
}

static void torque_control(void)
{
    MC_TorqueControl_t torque = {AXIS, .Torque = 20, .TorqueRamp = 100, .Velocity = 5};
    trace_begin("MC_TorqueControl", "The CM1-E has no torque mode: refused, and nothing moves.");
    trace_block("MC_TorqueControl", "", &torque);
    trace_value("MC_TorqueControl", &torque, "ErrorID", "");
    UNTIL(200) {
        torque.Execute = during(20, 150);
        MC_TorqueControl(&torque);
    }
    trace_end();
}

enum { MS = 1000000 };

static void position_profile(void)
{
    static const MC_TP_REF points = {.NumberOfPairs = 4, .IsAbsolute = TRUE,
                                     .MC_TP_Array = {{300 * MS, 1}, {300 * MS, 2}, {300 * MS, 2.5}, {300 * MS, 2}}};
    MC_PositionProfile_t profile = {AXIS, .TimePosition = &points};
    trace_begin("MC_PositionProfile", "Every 300 ms a point: 1, 2, 2.5, 2 u.");
    trace_block("MC_PositionProfile", "", &profile);
    trace_curves(true, true);
    UNTIL(1400) {
        profile.Execute = during(20, 1350);
        MC_PositionProfile(&profile);
    }
    trace_end();
}

static void velocity_profile(void)
{
    static const MC_TV_REF points = {.NumberOfPairs = 4, .IsAbsolute = TRUE,
                                     .MC_TV_Array = {{200 * MS, 4}, {200 * MS, 4}, {200 * MS, -2}, {200 * MS, 1}}};
    MC_VelocityProfile_t profile = {AXIS, .TimeVelocity = &points};
    trace_begin("MC_VelocityProfile", "Every 200 ms a point: 4, 4, -2, 1 u/s; the last one is kept.");
    trace_block("MC_VelocityProfile", "", &profile);
    trace_curves(false, true);
    UNTIL(1000) {
        profile.Execute = during(20, 950);
        MC_VelocityProfile(&profile);
    }
    trace_end();
}

static void acceleration_profile(void)
{
    static const MC_TA_REF points = {.NumberOfPairs = 4, .IsAbsolute = TRUE,
                                     .MC_TA_Array = {{100 * MS, 20}, {100 * MS, 20}, {200 * MS, -20}, {100 * MS, 0}}};
    MC_AccelerationProfile_t profile = {AXIS, .TimeAcceleration = &points};
    trace_begin("MC_AccelerationProfile",
                "20 u/s2 after 100 ms, kept for 100 ms, then down to -20 u/s2 and to 0; the velocity reached is "
                "kept.");
    trace_block("MC_AccelerationProfile", "", &profile);
    trace_curves(false, true);
    UNTIL(800) {
        profile.Execute = during(20, 750);
        MC_AccelerationProfile(&profile);
    }
    trace_end();
}

static void jog(void)
{
    MC_Jog_t jog = {AXIS, .Mode = MC_JOGMODE_CONTINOUS, .Velocity = 4, .Position = 0.5};
    trace_begin("MC_Jog",
                "MC_JOGMODE_CONTINOUS: as long as the button is pressed; then MC_JOGMODE_INCHING: a step of 0.5 u "
                "an edge.");
    trace_block("MC_Jog", "", &jog);
    trace_curves(true, true);
    UNTIL(1800) {
        jog.Mode = bench.scan < 1000 ? MC_JOGMODE_CONTINOUS : MC_JOGMODE_INCHING;
        jog.JogForward = during(50, 350) || during(1050, 1350) || during(1450, 1500);
        jog.JogBackwards = during(600, 800);
        MC_Jog(&jog);
    }
    trace_end();
}

static void follow_position(void)
{
    static const double tau = 6.283185307179586;
    CM_FollowPosition_t follow = {AXIS};
    trace_begin("CM_FollowPosition",
                "Positions of a program: one swing of 1.5 u in 1.2 s that begins and ends at rest; then the program no "
                "longer calls the block.");
    trace_block("CM_FollowPosition", "", &follow);
    trace_curves(true, true);
    UNTIL(1700) {
        const double swing = bench.scan < 100 ? 0.0 : fmin((bench.scan - 100) / 1200.0, 1.0);
        follow.Execute = during(50, 1400);
        follow.Position = 0.75 - 0.75 * cos(tau * swing);
        if (bench.scan < 1500)
            CM_FollowPosition(&follow);
    }
    trace_end();
}

const scenario_t motion_scenarios[] = {
    {"MC_Power", power},
    {"MC_Home", home},
    {"MC_Stop", stop},
    {"MC_Halt", halt},
    {"MC_MoveAbsolute", move_absolute},
    {"MC_MoveRelative", move_relative},
    {"MC_MoveAdditive", move_additive},
    {"MC_MoveSuperimposed", move_superimposed},
    {"MC_HaltSuperimposed", halt_superimposed},
    {"MC_MoveVelocity", move_velocity},
    {"MC_MoveContinuousAbsolute", move_continuous_absolute},
    {"MC_MoveContinuousRelative", move_continuous_relative},
    {"MC_TorqueControl", torque_control},
    {"MC_PositionProfile", position_profile},
    {"MC_VelocityProfile", velocity_profile},
    {"MC_AccelerationProfile", acceleration_profile},
    {"MC_Jog", jog},
    {"CM_FollowPosition", follow_position},
    {NULL, NULL},
};
