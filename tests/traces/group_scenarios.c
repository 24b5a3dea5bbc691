/* Scenarios of mc_group.h, on a group of two axes, X and Y. */
#include "diagram.h"

static void add_axis(void)
{
    MC_GroupReadStatus_t status = {GROUP, .Enable = TRUE};
    MC_GroupDisable_t disable = {GROUP};
    MC_RemoveAxisFromGroup_t remove = {GROUP, .IdentInGroup = 2};
    MC_AddAxisToGroup_t add = {GROUP, MASTER, .IdentInGroup = 2};
    trace_begin_with_group("MC_AddAxisToGroup",
                           "Refused in GroupStandby; in GroupDisabled, at a free place, the axis becomes a member.");
    trace_block("MC_AddAxisToGroup", "MC_AddAxisToGroup", &add);
    trace_block("MC_GroupReadStatus", "MC_GroupReadStatus", &status);
    UNTIL(200) {
        disable.Execute = during(80, 200);
        remove.Execute = during(100, 200);
        add.Execute = during(20, 60) || during(130, 170);
        MC_GroupDisable(&disable);
        MC_RemoveAxisFromGroup(&remove);
        MC_AddAxisToGroup(&add);
        MC_GroupReadStatus(&status);
    }
    trace_end();
}

static void remove_axis(void)
{
    MC_GroupDisable_t disable = {GROUP};
    MC_RemoveAxisFromGroup_t remove = {GROUP, .IdentInGroup = 2};
    trace_begin_with_group("MC_RemoveAxisFromGroup", "Refused in GroupStandby, done in GroupDisabled.");
    trace_block("MC_GroupDisable", "MC_GroupDisable", &disable);
    trace_block("MC_RemoveAxisFromGroup", "MC_RemoveAxisFromGroup", &remove);
    UNTIL(200) {
        disable.Execute = during(90, 200);
        remove.Execute = during(20, 60) || during(120, 170);
        MC_GroupDisable(&disable);
        MC_RemoveAxisFromGroup(&remove);
    }
    trace_end();
}

/* A line that most scenarios are about. */
#define LINE {GROUP, .Position = {2, 1}, .Velocity = 8}

static void ungroup(void)
{
    MC_MoveLinearAbsolute_t line = LINE;
    MC_UngroupAllAxes_t ungroup = {GROUP};
    MC_GroupReadConfiguration_t read = {GROUP, .Enable = TRUE, .IdentInGroup = 1};
    trace_begin_with_group("MC_UngroupAllAxes",
                           "In the middle of a line: the axes come to rest along it, and then are no members.");
    trace_block("MC_MoveLinearAbsolute", "MC_MoveLinearAbsolute", &line);
    trace_block("MC_UngroupAllAxes", "MC_UngroupAllAxes", &ungroup);
    trace_block("MC_GroupReadConfiguration", "MC_GroupReadConfiguration", &read);
    trace_curves(false, true);
    trace_master_curves(0, false, true);
    UNTIL(500) {
        line.Execute = during(20, 400);
        ungroup.Execute = during(200, 300);
        MC_MoveLinearAbsolute(&line);
        MC_UngroupAllAxes(&ungroup);
        MC_GroupReadConfiguration(&read);
    }
    trace_end();
}

static void read_configuration(void)
{
    MC_GroupReadConfiguration_t read = {GROUP};
    trace_begin_with_group("MC_GroupReadConfiguration", "Places 1, 2 and 3, where there is no axis.");
    trace_block("MC_GroupReadConfiguration", "", &read);
    UNTIL(200) {
        read.Enable = during(20, 180);
        read.IdentInGroup = (MC_IDENT_IN_GROUP)(bench.scan < 80 ? 1 : bench.scan < 130 ? 2 : 3);
        MC_GroupReadConfiguration(&read);
    }
    trace_end();
}

static void enable(void)
{
    MC_GroupDisable_t disable = {GROUP};
    MC_GroupEnable_t enable = {GROUP};
    MC_MoveLinearAbsolute_t line = LINE;
    trace_begin_with_group("MC_GroupEnable", "A line is refused until the group is enabled.");
    trace_block("MC_GroupDisable", "MC_GroupDisable", &disable);
    trace_block("MC_GroupEnable", "MC_GroupEnable", &enable);
    trace_block("MC_MoveLinearAbsolute", "MC_MoveLinearAbsolute", &line);
    trace_curves(false, true);
    UNTIL(700) {
        disable.Execute = during(10, 50);
        line.Execute = during(60, 110) || during(180, 650);
        enable.Execute = during(140, 250);
        MC_GroupDisable(&disable);
        MC_GroupEnable(&enable);
        MC_MoveLinearAbsolute(&line);
    }
    trace_end();
}

static void disable(void)
{
    MC_GroupDisable_t disable = {GROUP};
    MC_MoveLinearAbsolute_t line = LINE;
    MC_GroupReadStatus_t status = {GROUP, .Enable = TRUE};
    trace_begin_with_group("MC_GroupDisable",
                           "In the middle of a line: GroupDisabled at once, the axes stop along it.");
    trace_block("MC_MoveLinearAbsolute", "MC_MoveLinearAbsolute", &line);
    trace_block("MC_GroupDisable", "MC_GroupDisable", &disable);
    trace_block("MC_GroupReadStatus", "MC_GroupReadStatus", &status);
    trace_curves(false, true);
    trace_master_curves(0, false, true);
    UNTIL(500) {
        line.Execute = during(20, 400);
        disable.Execute = during(200, 300);
        MC_MoveLinearAbsolute(&line);
        MC_GroupDisable(&disable);
        MC_GroupReadStatus(&status);
    }
    trace_end();
}

/* The motor of Y reports an error in the middle of a line. */
static void fault_in_a_line(void)
{
    if (bench.scan == 200)
        simulate("error 2 2310");
}

static void reset(void)
{
    MC_MoveLinearAbsolute_t line = LINE;
    MC_GroupReset_t reset = {GROUP};
    trace_begin_with_group("MC_GroupReset",
                           "The motor of Y fails: X stops along the line. MC_GroupReset resets group and axes.");
    trace_block("MC_MoveLinearAbsolute", "MC_MoveLinearAbsolute", &line);
    trace_block("MC_GroupReset", "MC_GroupReset", &reset);
    trace_curves(false, true);
    trace_master_curves(0, false, true);
    UNTIL(1500) {
        fault_in_a_line();
        line.Execute = during(20, 400) || during(900, 1400);
        reset.Execute = during(500, 850);
        MC_MoveLinearAbsolute(&line);
        MC_GroupReset(&reset);
    }
    trace_end();
}

static void read_status(void)
{
    MC_MoveLinearAbsolute_t line = LINE;
    MC_GroupStop_t stop = {GROUP};
    MC_GroupReadStatus_t status = {GROUP};
    trace_begin_with_group("MC_GroupReadStatus", "A line, MC_GroupStop, and a motor that fails in another line.");
    trace_block("MC_GroupReadStatus", "", &status);
    trace_curves(false, true);
    UNTIL(1100) {
        if (bench.scan == 850)
            simulate("error 2 2310");
        line.Execute = during(50, 250) || during(700, 1000);
        stop.Execute = during(250, 600);
        status.Enable = during(20, 1080);
        MC_MoveLinearAbsolute(&line);
        MC_GroupStop(&stop);
        MC_GroupReadStatus(&status);
    }
    trace_end();
}

static void read_error(void)
{
    MC_MoveLinearAbsolute_t line = LINE;
    MC_GroupReset_t reset = {GROUP};
    MC_GroupReadError_t read = {GROUP};
    trace_begin_with_group("MC_GroupReadError", "The motor of Y fails, and is reset.");
    trace_block("MC_GroupReset", "MC_GroupReset", &reset);
    trace_block("MC_GroupReadError", "MC_GroupReadError", &read);
    trace_value("MC_GroupReadError", &read, "GroupErrorID", "");
    UNTIL(1000) {
        fault_in_a_line();
        line.Execute = during(20, 400);
        reset.Execute = during(500, 900);
        read.Enable = during(10, 980);
        MC_MoveLinearAbsolute(&line);
        MC_GroupReset(&reset);
        MC_GroupReadError(&read);
    }
    trace_end();
}

static void stop(void)
{
    MC_MoveLinearAbsolute_t line = LINE, other = {GROUP, .Position = {0, 0}, .Velocity = 8};
    MC_GroupStop_t stop = {GROUP, .Deceleration = 100};
    trace_begin_with_group("MC_GroupStop",
                           "The group stays in GroupStopping while Execute is TRUE, and refuses another line.");
    trace_block("MC_MoveLinearAbsolute", "a line", &line);
    trace_block("MC_GroupStop", "MC_GroupStop", &stop);
    trace_block("MC_MoveLinearAbsolute", "another line", &other);
    trace_curves(false, true);
    trace_master_curves(0, false, true);
    UNTIL(1300) {
        line.Execute = during(20, 300);
        stop.Execute = during(220, 600);
        other.Execute = during(450, 550) || during(700, 1250);
        MC_MoveLinearAbsolute(&line);
        MC_GroupStop(&stop);
        MC_MoveLinearAbsolute(&other);
    }
    trace_end();
}

static void halt(void)
{
    MC_MoveLinearAbsolute_t line = LINE, back = {GROUP, .Position = {0, 0}, .Velocity = 8, .BufferMode = mcBuffered};
    MC_GroupHalt_t halt = {GROUP, .Deceleration = 60};
    trace_begin_with_group("MC_GroupHalt", "A line is halted; another one waits until the group stands.");
    trace_block("MC_MoveLinearAbsolute", "a line", &line);
    trace_block("MC_GroupHalt", "MC_GroupHalt", &halt);
    trace_block("MC_MoveLinearAbsolute", "the way back, buffered", &back);
    trace_curves(false, true);
    trace_master_curves(0, false, true);
    UNTIL(1000) {
        line.Execute = during(20, 300);
        halt.Execute = during(200, 400);
        back.Execute = during(230, 950);
        MC_MoveLinearAbsolute(&line);
        MC_GroupHalt(&halt);
        MC_MoveLinearAbsolute(&back);
    }
    trace_end();
}

/* Over a corner that is blended. */
static void draw_interruption(const char *about, const char *text, MC_GroupInterrupt_t *interrupt,
                              MC_GroupContinue_t *go_on, int end, int continued)
{
    MC_MoveLinearAbsolute_t first = LINE;
    MC_MoveLinearAbsolute_t second = {GROUP, .Position = {0, 2}, .Velocity = 8, .BufferMode = mcBlendingHigh,
                                      .TransitionMode = mcTMCornerDistance, .TransitionParameter = 0.5};
    trace_begin_with_group(about, text);
    trace_block("MC_MoveLinearAbsolute", "a line", &first);
    trace_block("MC_MoveLinearAbsolute", "another one, blended", &second);
    trace_block("MC_GroupInterrupt", "MC_GroupInterrupt", interrupt);
    trace_block("MC_GroupContinue", "MC_GroupContinue", go_on);
    trace_curves(true, true);
    trace_master_curves(0, true, true);
    UNTIL(end) {
        first.Execute = second.Execute = during(20, end - 50);
        interrupt->Execute = during(200, 300);
        go_on->Execute = during(continued, continued + 100) || during(end - 200, end - 150);
        MC_MoveLinearAbsolute(&first);
        MC_MoveLinearAbsolute(&second);
        MC_GroupInterrupt(interrupt);
        MC_GroupContinue(go_on);
    }
    trace_end();
}

static void interrupt(void)
{
    MC_GroupInterrupt_t interrupt = {GROUP, .Deceleration = 60};
    MC_GroupContinue_t go_on = {GROUP};
    draw_interruption("MC_GroupInterrupt", "Two lines are interrupted in the first one. They are Busy until they go on.",
                      &interrupt, &go_on, 1500, 700);
}

static void go_on(void)
{
    MC_GroupInterrupt_t interrupt = {GROUP, .Deceleration = 60};
    MC_GroupContinue_t go_on = {GROUP};
    draw_interruption("MC_GroupContinue",
                      "It makes two lines go on while the group still brakes; then nothing is interrupted any more.",
                      &interrupt, &go_on, 1200, 250);
}

static void linear_absolute(void)
{
    MC_MoveLinearAbsolute_t first = {GROUP, .Position = {2, 0}, .Velocity = 8};
    MC_MoveLinearAbsolute_t second = {GROUP, .Position = {2, 1.5}, .Velocity = 8, .BufferMode = mcBlendingHigh,
                                      .TransitionMode = mcTMMaxCornerDeviation, .TransitionParameter = 0.1};
    MC_MoveLinearAbsolute_t third = {GROUP, .Position = {0, 0}, .Velocity = 8, .BufferMode = mcBuffered};
    trace_begin_with_group("MC_MoveLinearAbsolute",
                           "Three lines: over the first corner with a transition that keeps within 0.1 u of it, "
                           "to rest in the second one.");
    trace_block("MC_MoveLinearAbsolute", "to (2, 0)", &first);
    trace_block("MC_MoveLinearAbsolute", "to (2, 1.5), blended", &second);
    trace_block("MC_MoveLinearAbsolute", "to (0, 0), buffered", &third);
    trace_curves(true, true);
    trace_master_curves(0, true, true);
    UNTIL(1400) {
        first.Execute = during(20, 1300);
        second.Execute = during(60, 1300);
        third.Execute = during(100, 1300);
        MC_MoveLinearAbsolute(&first);
        MC_MoveLinearAbsolute(&second);
        MC_MoveLinearAbsolute(&third);
    }
    trace_end();
}

static void linear_relative(void)
{
    MC_MoveLinearRelative_t line = {GROUP, .Distance = {1, 0.5}, .Velocity = 8};
    trace_begin_with_group("MC_MoveLinearRelative",
                           "Triggered again on the way: it stops, and Distance counts from where the axes were then.");
    trace_block("MC_MoveLinearRelative", "", &line);
    trace_curves(true, true);
    trace_master_curves(0, true, true);
    UNTIL(800) {
        line.Execute = during(20, 100) || during(150, 700);
        MC_MoveLinearRelative(&line);
    }
    trace_end();
}

static void direct_absolute(void)
{
    MC_MoveDirectAbsolute_t to = {GROUP, .Position = {2, 0.5}};
    MC_MoveLinearAbsolute_t back = {GROUP, .Position = {0, 0}, .Velocity = 8, .BufferMode = mcBuffered};
    trace_begin_with_group("MC_MoveDirectAbsolute",
                           "To (2, 0.5) as fast as the axes can, and back along a line with a velocity of 8 u/s.");
    trace_block("MC_MoveDirectAbsolute", "", &to);
    trace_block("MC_MoveLinearAbsolute", "MC_MoveLinearAbsolute, buffered", &back);
    trace_curves(true, true);
    trace_master_curves(0, true, true);
    UNTIL(800) {
        to.Execute = during(20, 700);
        back.Execute = during(60, 700);
        MC_MoveDirectAbsolute(&to);
        MC_MoveLinearAbsolute(&back);
    }
    trace_end();
}

static void direct_relative(void)
{
    MC_MoveDirectRelative_t there = {GROUP, .Distance = {1, 2}};
    MC_MoveDirectRelative_t back = {GROUP, .Distance = {-1, -2}, .BufferMode = mcBuffered};
    trace_begin_with_group("MC_MoveDirectRelative",
                           "Twice: the second Distance counts from the end of the first motion.");
    trace_block("MC_MoveDirectRelative", "by (1, 2)", &there);
    trace_block("MC_MoveDirectRelative", "by (-1, -2), buffered", &back);
    trace_curves(true, true);
    trace_master_curves(0, true, true);
    UNTIL(800) {
        there.Execute = during(20, 700);
        back.Execute = during(60, 700);
        MC_MoveDirectRelative(&there);
        MC_MoveDirectRelative(&back);
    }
    trace_end();
}

static void circular_absolute(void)
{
    MC_MoveCircularAbsolute_t circle = {GROUP, .CircMode = mcCenter, .AuxPoint = {0, 1}, .EndPoint = {0, 0},
                                        .PathChoice = mcCounterClockwise, .Velocity = 6};
    trace_begin_with_group("MC_MoveCircularAbsolute", "A full circle around (0, 1).");
    trace_block("MC_MoveCircularAbsolute", "", &circle);
    trace_curves(true, true);
    trace_master_curves(0, true, true);
    UNTIL(1400) {
        circle.Execute = during(20, 1350);
        MC_MoveCircularAbsolute(&circle);
    }
    trace_end();
}

static void circular_relative(void)
{
    MC_MoveCircularRelative_t arc = {GROUP, .CircMode = mcBorder, .AuxPoint = {1, 1}, .EndPoint = {2, 0},
                                     .Velocity = 6};
    MC_MoveLinearRelative_t line = {GROUP, .Distance = {0, -1}, .Velocity = 6, .BufferMode = mcBlendingLow};
    trace_begin_with_group("MC_MoveCircularRelative",
                           "A half circle by way of (1, 1), and a line in its direction: no stop between them.");
    trace_block("MC_MoveCircularRelative", "MC_MoveCircularRelative", &arc);
    trace_block("MC_MoveLinearRelative", "MC_MoveLinearRelative, blended", &line);
    trace_curves(true, true);
    trace_master_curves(0, true, true);
    UNTIL(1200) {
        arc.Execute = during(20, 1100);
        line.Execute = during(60, 1150);
        MC_MoveCircularRelative(&arc);
        MC_MoveLinearRelative(&line);
    }
    trace_end();
}

static void read_position(void)
{
    MC_MoveLinearAbsolute_t line = LINE;
    MC_GroupReadPosition_t read = {GROUP, .Source = mcActualValue};
    trace_begin_with_group("MC_GroupReadPosition", "Valid while Enable is TRUE.");
    trace_block("MC_GroupReadPosition", "", &read);
    trace_value("MC_GroupReadPosition", &read, "Position", "u");
    UNTIL(700) {
        line.Execute = during(50, 650);
        read.Enable = during(20, 600);
        MC_MoveLinearAbsolute(&line);
        MC_GroupReadPosition(&read);
    }
    trace_end();
}

static void read_velocity(void)
{
    MC_MoveLinearAbsolute_t line = LINE;
    MC_GroupReadVelocity_t read = {GROUP, .Source = mcSetValue};
    trace_begin_with_group("MC_GroupReadVelocity", "The velocity along a line, and those of the axes.");
    trace_block("MC_GroupReadVelocity", "", &read);
    trace_value("MC_GroupReadVelocity", &read, "PathVelocity", "u/s");
    trace_curves(false, true);
    trace_master_curves(0, false, true);
    UNTIL(700) {
        line.Execute = during(50, 650);
        read.Enable = during(20, 600);
        MC_MoveLinearAbsolute(&line);
        MC_GroupReadVelocity(&read);
    }
    trace_end();
}

static void set_override(void)
{
    MC_MoveLinearAbsolute_t line = {GROUP, .Position = {4, 2}, .Velocity = 8};
    MC_GroupSetOverride_t override = {GROUP, MC_GROUPSETOVERRIDE_DEFAULTS};
    trace_begin_with_group("MC_GroupSetOverride", "VelFactor 1, 0.5, 0 and 1 again in a line.");
    trace_block("MC_MoveLinearAbsolute", "MC_MoveLinearAbsolute", &line);
    trace_block("MC_GroupSetOverride", "MC_GroupSetOverride", &override);
    trace_value("MC_GroupSetOverride", &override, "VelFactor", "");
    trace_curves(false, true);
    trace_master_curves(0, false, true);
    UNTIL(1500) {
        const int now = bench.scan;
        line.Execute = during(20, 1450);
        override.Enable = during(10, 1400);
        override.VelFactor = now < 250 ? 1 : now < 400 ? 0.5 : now < 650 ? 0 : 1;
        MC_MoveLinearAbsolute(&line);
        MC_GroupSetOverride(&override);
    }
    trace_end();
}

const scenario_t group_scenarios[] = {
    {"MC_AddAxisToGroup", add_axis},
    {"MC_RemoveAxisFromGroup", remove_axis},
    {"MC_UngroupAllAxes", ungroup},
    {"MC_GroupReadConfiguration", read_configuration},
    {"MC_GroupEnable", enable},
    {"MC_GroupDisable", disable},
    {"MC_GroupReset", reset},
    {"MC_GroupReadStatus", read_status},
    {"MC_GroupReadError", read_error},
    {"MC_GroupStop", stop},
    {"MC_GroupHalt", halt},
    {"MC_GroupInterrupt", interrupt},
    {"MC_GroupContinue", go_on},
    {"MC_MoveLinearAbsolute", linear_absolute},
    {"MC_MoveLinearRelative", linear_relative},
    {"MC_MoveCircularAbsolute", circular_absolute},
    {"MC_MoveCircularRelative", circular_relative},
    {"MC_MoveDirectAbsolute", direct_absolute},
    {"MC_MoveDirectRelative", direct_relative},
    {"MC_GroupReadPosition", read_position},
    {"MC_GroupReadVelocity", read_velocity},
    {"MC_GroupSetOverride", set_override},
    {0},
};
