/* When an axis may be on whose motor turned when it got its torque. */
#include <math.h>

#include "cia402/cia402.h"
#include "device/bridge_facts.h"
#include "scenario_private.h"

#define RESTS_S 3e-3            /* docs/SAFETY.md: of the deceleration of the axis, */
#define RESTS_COUNTS 3000.0     /* counts/s of a CM1-E, */
#define RESTS_PER_CYCLE 2.0     /* or counts in a cycle */
#define MOST 1.5                /* the servo goes on until its master hears of it */

/** A torque from outside acts on it. */
static bool is_loaded(const run_t *run, const machine_axis_t *axis)
{
    for (int i = 0; i < run->scenario->fault_count; i++) {
        const fault_t *fault = &run->scenario->faults[i];
        if (fault->kind == FAULT_LOAD && (int)fault->axis == axis->number && fault->at <= run->cycle + 1 &&
            fault->at + fault->length + 2 >= run->cycle)
            return true;
    }
    return false;
}

/** In the other modes of a bridge its motor gets no set-points: it holds by itself (docs/SAFETY.md). */
static bool has_set_points(const machine_axis_t *axis)
{
    const int mode = (int)axis->info.mode;
    return mode == CM1E_MODE_CSP || mode == CM1E_MODE_CSV || mode == CM1E_BRIDGE_MODE_CPIO;
}

double signed_speed(const machine_axis_t *axis)
{
    return (axis->spec->invert != 0 ? -1 : 1) * axis->probe.velocity_counts_per_s;
}

bool is_braked_first(const machine_axis_t *axis, double velocity)
{
    const double *before = axis->seen.shaft, now = signed_speed(axis);
    /* What the drive has shown is a cycle older, and it may brake already, or turn the motor round. Where no frame came, the
     * simulator has not moved the shaft: the cycle before that counts. */
    const double shown = before[now == before[0]];
    /* A bridge shows no velocity: it is the mean one since the last answer, of a cycle, or of a silence. */
    const bool silent = axis->seen.quiet < 3 || axis->seen.rung < 3;
    const double mean = axis->channel == 0 ? shown : silent ? before[2] : (before[0] + before[1]) / 2;
    const double least = fmin(now, fmin(shown, mean)), most = fmax(now, fmax(shown, mean));
    const bool disabled = axis->info.state == CM1E_AXIS_DISABLED || axis->seen.fails_off;
    return is_motor(axis) && disabled && axis->seen.set_velocity == 0 &&
           (velocity > 0 ? most > 0 && velocity < 1.02 * most + SERVO_SPEED_COUNTS
                         : least < 0 && velocity > 1.02 * least - SERVO_SPEED_COUNTS);
}

void judge_enable(run_t *run, machine_axis_t *axis)
{
    const axis_spec_t *spec = axis->spec;
    const double cycle_s = run->scenario->cycle_us * 1e-6, count = spec->kind == AXIS_CIA402 ? 131072 / 50000.0 : 1;
    const double rests = spec->deceleration * RESTS_S + fmax(RESTS_COUNTS * count, RESTS_PER_CYCLE / cycle_s);
    const double speed = fabs(axis->probe.velocity_counts_per_s);
    if (axis->power.Status && !axis->seen.was_on && has_set_points(axis) && !is_loaded(run, axis) && axis->info.state == CM1E_AXIS_STANDSTILL &&
        speed > MOST * rests)
        scenario_fail(run, "on", "%s: MC_Power.Status is TRUE, and the shaft turns at %.0f counts/s; at rest it is below "
                      "%.0f", axis->name, speed, rests);
    axis->seen.was_on = axis->power.Status;
}
