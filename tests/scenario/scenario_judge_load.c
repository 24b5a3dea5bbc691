/* Where the load behind a gap is (backlash). */
#include <math.h>

#include "scenario_private.h"

void judge_move_load(const run_t *run, machine_axis_t *axis)
{
    witness_t *seen = &axis->seen;
    const double motor = axis->probe.position_counts * (axis->spec->invert != 0 ? -1 : 1), gap = axis->spec->backlash;
    const double load = fmax(motor, fmin(seen->load, motor + gap));
    const bool hidden = load != seen->load && (run->bad[axis->network] > 0 || !axis->info.online);
    /* MC_Power has ended a crossing, and may be back before the torque has gone: the axis shows the rest of it then. */
    const bool cut = axis->info.state == CM1E_AXIS_DISABLED && axis->probe.torque_on && load > motor && load < motor + gap;
    seen->unseen = seen->unseen || hidden || cut;
    seen->load = load;
}
