/* What a motion and a homing of the drive have in common: the modes, standstill, and the time that a halt may take. */
#include <math.h>
#include <stdlib.h>

#include "axis/axis_driving.h"
#include "axis/axis_position.h"
#include "core/clock.h"

static const int64_t longest_halt_ns = 10000 * MS_IN_NS;
static const int64_t standstill_ns = 50 * MS_IN_NS;
static const double standstill_counts = 10.0; /* tolerance, in counts of a CM1-E */

bool cm1e_axis_acts_in(const cm1e_axis_t *axis, cm1e_mode_t mode)
{
    return axis->drive.feedback.enabled && axis->drive.feedback.mode == (int8_t)mode;
}

/* By the frames that bring the positions: around a pause of the cycle two of them may be 50 cycles apart, by number,
 * and come from nearly the same moment. */
int64_t cm1e_axis_stood(const cm1e_axis_t *axis, const standstill_t *standstill)
{
    return cm1e_drive_sent_ns(&axis->drive) - standstill->since_ns;
}

void cm1e_axis_watch_standstill(const cm1e_axis_t *axis, standstill_t *standstill)
{
    *standstill = (standstill_t){cm1e_drive_sent_ns(&axis->drive), axis->position.raw};
}

bool cm1e_axis_is_at_standstill(const cm1e_axis_t *axis, standstill_t *standstill)
{
    const int32_t moved = (int32_t)((uint32_t)axis->position.raw - (uint32_t)standstill->position);
    if (!axis->drive.feedback.online || (double)llabs(moved) > cm1e_axis_tolerance_counts(axis, standstill_counts))
        cm1e_axis_watch_standstill(axis, standstill);
    return cm1e_axis_stood(axis, standstill) >= standstill_ns;
}

int64_t cm1e_axis_halt_bound_ns(const cm1e_axis_t *axis, double braking_s, bool has_halt)
{
    const int64_t braking_ns = (int64_t)(1e9 * fmin(braking_s, 1e-9 * (double)longest_halt_ns));
    const bool offline = axis->drive.fault.error != CM1E_OK;
    const int64_t bound_ns = offline    ? braking_ns + standstill_ns
                             : has_halt ? 2 * braking_ns + 1000 * MS_IN_NS : braking_ns + 3 * standstill_ns;
    return bound_ns < longest_halt_ns ? bound_ns : longest_halt_ns;
}

bool cm1e_axis_has_lost_torque(const cm1e_axis_t *axis, home_goal_t goal)
{
    return !axis->drive.feedback.enabled && goal == HOME_GOAL_OFF && axis->drive.fault.error != CM1E_OK;
}
