/*
 * MC_SetOverride (3.18): factors on the dynamics of all commands except MC_Stop and homings. After a change the motion
 * is planned anew at once, from the present set-point. A velocity factor of 0 brakes the command to standstill. There
 * it stays active, in its state of the diagram, and goes on when the factor is larger again.
 */
#include <string.h>

#include "axis/axis_commands.h"
#include "axis/axis_events.h"
#include "axis/axis_plan.h"
#include "axis/axis_setpoint.h"
#include "axis/axis_superimpose.h"
#include "axis/axis_text.h"

static bool is_factor(double value) { return value > 0.0 && value <= 1.0; }

/* Ends a command that cannot go on after a pause with that error, and begins the next one (2.2.2, case 2). */
static void resume_failed(cm1e_axis_t *axis, cm1e_error_t error)
{
    const from_t from = from_base(axis);
    cm1e_axis_command_end(axis, CM1E_COMMAND_ERROR, error);
    cm1e_axis_go(axis, ON_BROKEN_OFF);
    if (!cm1e_axis_begin_waiting(axis, &from, 0.0))
        cm1e_axis_ramp_down(axis, &axis->limits.maximum);
}

cm1e_error_t cm1e_axis_set_override(cm1e_axis_t *axis, double velocity, double acceleration, double jerk)
{
    const override_t before = axis->override;
    if (!(velocity >= 0.0 && velocity <= 1.0) || !is_factor(acceleration) || !is_factor(jerk))
        return CM1E_ERROR_AXIS_OVERRIDE;
    if (velocity == before.velocity && acceleration == before.acceleration && jerk == before.jerk)
        return CM1E_OK;
    if (drive_profiles(axis)) /* the drive would have to accept new values in motion */
        return CM1E_ERROR_UNSUPPORTED;
    axis->override = (override_t){velocity, acceleration, jerk};
    const bool paused = axis->setpoint.paused;
    cm1e_axis_superimposed_replan(axis);
    const cm1e_error_t error = cm1e_axis_replan(axis);
    if (error != CM1E_OK && paused && velocity > 0.0)
        resume_failed(axis, error);
    return CM1E_OK;
}

void cm1e_axis_refuse_override(cm1e_axis_t *axis, cm1e_error_t error, double velocity, double acceleration, double jerk,
                               bool begins)
{
    const override_t asked = {velocity, acceleration, jerk};
    /* NOLINTNEXTLINE(bugprone-suspicious-memory-comparison,cert-exp42-c,cert-flp37-c): a refused NaN is the same NaN */
    const bool another = axis->not_set.error != CM1E_OK && axis->not_set.what == NOT_SET_OVERRIDE &&
                         memcmp(&asked, &axis->override_refused, sizeof asked) != 0;
    axis->override_refused = asked;
    cm1e_axis_remember_repeated(axis, (not_set_t){.error = error, .what = NOT_SET_OVERRIDE}, begins || another);
}
