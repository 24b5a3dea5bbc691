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

void data_prepare(const run_t *run, instance_t *block)
{
    const machine_axis_t *axis = &run->axes[(int)block->step->axis];
    const char *name = block->type->name;
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

void data_cycle(const run_t *run, instance_t *block)
{
    const machine_axis_t *axis = &run->axes[(int)block->step->axis];
    const step_t *step = block->step;
    if (!block->follows)
        return;
    if (run->cycle == (int)step->at)
        block->from = axis->info.set_position;
    const double age_ms = (run->cycle - step->at) * run->scenario->cycle_us * 1e-3;
    block_put(block, "Position", block->from + step->distance / axis->spec->counts_per_unit * swing(age_ms / step->period));
}
