/* What a master may do with a motor behind a bridge, and when such a motor may move by itself. */
#include <math.h>

#include "scenario_private.h"

const char *const own_motions[] = {"CM_SendCML", "CM_Command", NULL};
static const char *const mode_switches[] = {"CM_SetMode", NULL};

bool moves_by_itself(const machine_axis_t *axis)
{
    return axis->seen.by_itself && (axis->info.mode == MODE_CML || axis->info.mode == MODE_CMD);
}

/* Counts/s. The library takes a motor for one at rest whose positions change by no more than 3 counts within 20 ms. One that
 * breaks loose from its friction, and creeps to its target, gets so fast meanwhile. */
#define CREEPING 500.0
enum { LATE_CYCLES = 4000, TRANSFER_CYCLES = 60 /* of a write */, SOON = 5 };

/** Rules of the bridge's guide (cm1e/sim.h). An output may be written when the motor has lost its power; a motor that still
 *  turns gets a target that goes with it; one that stands behind its set-point by more than position_lag gets its own
 *  position; a write of the mode may be on its way when the motor fails; one that creeps stands as far as its counts show; and
 *  CM_SetMode may insist on a way that the guide warns of. */
static void judge_rules(run_t *run, machine_axis_t *axis)
{
    const unsigned turns = is_caught(run, axis) ? CM1E_SIM_STEP_AT_START : 0u;
    /* It is caught where it is, if the host stood still as it began to follow its targets (docs/SAFETY.md). */
    const bool far = is_caught(run, axis) && axis->info.state == CM1E_AXIS_DISABLED && axis->seen.stalled < SOON;
    const unsigned leaves = far ? CM1E_SIM_STEP_IN_CYCLE : 0u;
    const unsigned lags = axis->info.error == CM1E_ERROR_AXIS_LAG ? CM1E_SIM_STEP_IN_CYCLE : 0u;
    const unsigned insists = program_has(run->scenario, axis->number, mode_switches) ? CM1E_SIM_MODE_NO_WAY : 0u;
    const unsigned fails = fault_explains(run, axis, false) ? CM1E_SIM_MODE_IN_ERROR : 0u;
    /* The master saw it at rest when it wrote the mode, and somebody has shoved it since then. */
    const int on_its_way = fault_slows_mailbox(run, axis) ? LATE_CYCLES : TRANSFER_CYCLES;
    const bool shoved = run->cycle - axis->seen.shoved_at < on_its_way;
    const bool creeps = fabs(axis->probe.velocity_counts_per_s) < CREEPING;
    const unsigned stands = creeps || shoved ? axis->probe.broken_rules & CM1E_SIM_MODE_IN_MOTION : 0u; /* in this cycle */
    axis->seen.excused |= CM1E_SIM_OUTPUT_IN_VAIN | turns | leaves | lags | insists | fails | stands;
    if ((axis->probe.broken_rules & ~axis->seen.excused) != 0)
        scenario_fail(run, "rules", "%s (%s): rules of the bridge's guide are broken: 0x%03X", axis->name,
                      cm1e_axis_state_name(axis->info.state), axis->probe.broken_rules);
}

/** It has other limits than its axis, and gets another origin. */
static void judge_own_motion(run_t *run, machine_axis_t *axis)
{
    if (!moves_by_itself(axis))
        return;
    axis->seen.kept = false;
    if (axis->probe.torque_on)
        axis->seen.pushed_until = run->cycle;
    if (axis->power.Status || axis->info.powered)
        scenario_fail(run, "own-motion", "%s (%s) is in a mode in which its motor moves by itself, and shows power",
                      axis->name, cm1e_axis_state_name(axis->info.state));
}

void judge_bridge(run_t *run, machine_axis_t *axis)
{
    judge_rules(run, axis);
    judge_own_motion(run, axis);
}
