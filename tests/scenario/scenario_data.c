/* What blocks take by reference: tables over time, cam switches; and positions from outside, which change every cycle. */
#include <math.h>
#include <string.h>

#include "scenario_private.h"

#define TURN 6.283185307179586
enum { CAM_TRACKS = 2, MS_IN_NS = 1000000 };

/** From 0 at `part` 0 to 1 at a half, and back. */
static double swing(double part) { return (1 - cos(TURN * part)) / 2; }

static TIME time_of(const step_t *step, int point)
{
    return point == 0 ? 0 : (TIME)(step->period / (step->points - 1) * MS_IN_NS);
}

/** `size` in units for positions, in units/s for velocities; a table of accelerations ends at rest too. */
static void make_table(instance_t *block, double size)
{
    const step_t *step = block->step;
    const double period_s = step->period * 1e-3;
    const WORD count = (WORD)step->points;
    block->data.positions.NumberOfPairs = block->data.velocities.NumberOfPairs = count;
    block->data.accelerations.NumberOfPairs = count;
    for (int i = 0; i < count; i++) {
        const double part = i < count - 1 ? i / (step->points - 1) : 0; /* it ends exactly at rest */
        if (strcmp(block->type->name, "MC_PositionProfile") == 0)
            block->data.positions.MC_TP_Array[i] = (MC_TP){time_of(step, i), size * swing(part)};
        else if (strcmp(block->type->name, "MC_VelocityProfile") == 0)
            block->data.velocities.MC_TV_Array[i] = (MC_TV){time_of(step, i), size / period_s * swing(part)};
        else
            block->data.accelerations.MC_TA_Array[i] =
                (MC_TA){time_of(step, i), size / period_s / period_s * TURN * sin(TURN * part)};
    }
}

static void make_switches(instance_t *block, double unit)
{
    block->data.switches.NumberOfSwitches = CAM_TRACKS;
    for (int i = 0; i < CAM_TRACKS; i++)
        block->data.switches.Switches[i] = (MC_CAMSWITCH){
            .TrackNumber = 1, .FirstOnPosition = block->step->position / unit * (i + 1),
            .LastOnPosition = (block->step->position * (i + 1) + fabs(block->step->distance)) / unit,
            .CamSwitchMode = i, .Duration = (TIME)(block->step->period * MS_IN_NS)};
}

/** Another cam than the one of the start. */
static void make_cam(instance_t *block, double unit)
{
    const step_t *step = block->step;
    const double master = fmax(fabs(step->x), 1000) / unit, slave = step->distance * 0.1 / unit;
    const MC_CAM_POINT points[3] = {{0}, {.Master = master / 2, .Slave = slave}, {.Master = master}};
    memcpy(block->cam_points, points, sizeof points);
    block->cam = (MC_CAM_REF){.Points = block->cam_points, .NumberOfPoints = 3, .Curve = (MC_CAM_CURVE)step->mode};
    block_point(block, "CamTable", &block->cam);
    block_put(block, "Periodic", step->value);
}

/** What a motor behind a bridge is told. Where AllowMotion is FALSE, what may move it is refused. */
static void make_string(instance_t *block)
{
    static const char *const strings[] = {"?99.1", "K53=100", "?96", "(", "^", "P1=1000", "", "?37"};
    static const char *const motions[] = {"(,|", "|", ")", "(", "K42=100,(,|", "?99", "?90"};
    const block_member_t *member = block_member(block->type, "Command");
    const unsigned which = (unsigned)(block->step->mode + block->step->parameter);
    if (member && member->type == BLOCK_STRING)
        snprintf((char *)block->memory + member->offset, member->size, "%s",
                 block->step->allow != 0 ? motions[which % (sizeof motions / sizeof motions[0])]
                                         : strings[which % (sizeof strings / sizeof strings[0])]);
}

/** An input or output of the motor, or of a terminal. */
static void make_signal(instance_t *block, const machine_axis_t *axis)
{
    const INT number = (INT)block->step->mode;
    block->input = (MC_INPUT_REF){.Axis = axis->reference, .Number = number};
    block->trigger = (MC_TRIGGER_REF){.Axis = axis->reference, .InputNumber = number, .FallingEdge = block->step->value != 0};
    block_point(block, "Input", &block->input);
    if (number > 0)
        block_point(block, "TriggerInput", &block->trigger);
}

void data_prepare(const run_t *run, instance_t *block)
{
    const machine_axis_t *axis = &run->axes[(int)block->step->axis];
    const char *name = block->type->name;
    make_string(block);
    make_signal(block, axis);
    if (block_member(block->type, "CamTable"))
        make_cam(block, axis->spec->counts_per_unit);
    if (block_member(block->type, "Switches")) {
        make_switches(block, axis->spec->counts_per_unit);
        block->output = (MC_OUTPUT_REF){.Axis = axis->reference, .Number = 1};
        block_put(block, "EnableMask", 1);
    } else if (block->step->points > 1) {
        make_table(block, block->step->distance / axis->spec->counts_per_unit);
    }
    block->follows = strcmp(name, "CM_FollowPosition") == 0;
    block_point(block, "Switches", &block->data);
    block_point(block, "Outputs", &block->output);
    block_point(block, "TimePosition", &block->data);
    block_point(block, "TimeVelocity", &block->data);
    block_point(block, "TimeAcceleration", &block->data);
}

/** The inputs that change while a block is at work: with ContinuousUpdate they act at once, else with the next edge. */
static void change(const run_t *run, instance_t *block)
{
    static const char *const names[] = {"Position", "Distance", "Velocity", "PhaseShift", "VelFactor"};
    const step_t *step = block->step;
    if (step->change == 0 || run->cycle != (int)(step->at + step->change_after))
        return;
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        const block_member_t *member = block_member(block->type, names[i]);
        if (member && member->section == BLOCK_INPUT)
            block_put(block, names[i], block_number(block, names[i]) * step->change);
    }
}

void data_cycle(const run_t *run, instance_t *block)
{
    const machine_axis_t *axis = &run->axes[(int)block->step->axis];
    const step_t *step = block->step;
    change(run, block);
    if (!block->follows)
        return;
    if (run->cycle == (int)step->at)
        block->from = axis->info.set_position;
    const double age_ms = (run->cycle - step->at) * run->scenario->cycle_us * 1e-3;
    block_put(block, "Position", block->from + step->distance / axis->spec->counts_per_unit * swing(age_ms / step->period));
}
