/* Where the load behind a gap is (backlash). */
#include <math.h>

#include "scenario_private.h"

#define RAMP_S 0.02 /* docs/FUNCTION-BLOCKS.md: until a crossing of backlash has its velocity */

double crossing_speed(const axis_spec_t *spec) { return spec->backlash > 0 ? spec->backlash_velocity : 0; }

double crossing_acceleration(const axis_spec_t *spec)
{
    return fmin(crossing_speed(spec) / RAMP_S, fmin(spec->acceleration, spec->deceleration));
}

/** Whether the crossing that the last reversal of the set velocity began is not over yet. Without torque the axis looks
 *  where its load is. */
static bool crosses(const run_t *run, machine_axis_t *axis)
{
    const axis_spec_t *spec = axis->spec;
    witness_t *seen = &axis->seen;
    const double set = axis->info.set_velocity, speed = crossing_speed(spec);
    const int heading = !axis->probe.torque_on ? 0 : set > 0 ? 1 : set < 0 ? -1 : seen->heading;
    if (heading != seen->heading)
        seen->turned_at = run->cycle;
    seen->heading = heading;
    if (spec->backlash <= 0)
        return false;
    const double time_s = spec->backlash / speed + speed / crossing_acceleration(spec);
    return (run->cycle - seen->turned_at) * run->scenario->cycle_us * 1e-6 < time_s;
}

void judge_move_load(const run_t *run, machine_axis_t *axis)
{
    witness_t *seen = &axis->seen;
    const double motor = axis->probe.position_counts * (axis->spec->invert != 0 ? -1 : 1), gap = axis->spec->backlash;
    const double load = fmax(motor, fmin(seen->load, motor + gap));
    const bool hidden = load != seen->load && (run->bad[axis->network] > 0 || !axis->info.online);
    /* MC_Power has ended a crossing, and may be back before the torque has gone: the axis shows the rest of it then. */
    const bool open = crosses(run, axis) || (load > motor && load < motor + gap);
    seen->cut = axis->probe.torque_on && (seen->cut || (open && axis->info.state == CM1E_AXIS_DISABLED));
    seen->unseen = seen->unseen || hidden;
    seen->load = load;
}
