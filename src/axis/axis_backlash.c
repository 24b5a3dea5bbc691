/*
 * Backlash. Between the motor and its load is a gap of `gap` counts. Pushed in the positive direction of the axis the
 * motor stands where the load is, pushed in the negative direction it stands a gap before it; `offset`, -gap ... 0, is
 * where the motor is as seen from the load. At a reversal the offset is ramped from one flank to the other, on top of
 * the axis's own motion, whose maximum velocity leaves room for it. Without set-points of ours (no torque, homing by
 * the drive) the offset follows the motor as the gap does: the load moves only when a flank is reached. At the start,
 * when nobody knows, the positive flank is taken for closed.
 *
 * Everything else of the axis knows the load alone: its set-point, its actual position, its lag.
 */
#include <math.h>

#include "axis/axis_backlash.h"
#include "axis/axis_power.h"
#include "axis/axis_setpoint.h"

/* The ramp of the compensation: its velocity within this time. */
static const double ramp_s = 0.02;
/* Counts; of what is left of a ramp. */
static const double rounding = 1e-6;
/* Below this the sign of a set velocity is rounding; counts/s. */
static const double least_velocity = 1e-3;

void cm1e_axis_backlash_init(cm1e_axis_t *axis)
{
    const cm1e_axis_config_t *c = axis->config;
    backlash_t *b = &axis->backlash;
    const double scale = fabs(axis->position.scale);
    b->gap = c->backlash * scale;
    if (b->gap == 0.0)
        return;
    b->velocity = c->backlash_velocity > 0.0 ? c->backlash_velocity * scale : cm1e_unit_backlash_velocity(c);
    const cm1e_motion_limits_t *most = &axis->limits.maximum;
    b->acceleration = fmin(b->velocity / ramp_s, fmin(most->acceleration, most->deceleration) * scale);
}

static double sign(const cm1e_axis_t *axis) { return axis->position.scale < 0.0 ? -1.0 : 1.0; }

double cm1e_axis_backlash_offset(const cm1e_axis_t *axis) { return sign(axis) * axis->backlash.offset; }

double cm1e_axis_backlash_velocity(const cm1e_axis_t *axis) { return sign(axis) * axis->backlash.offset_velocity; }

bool cm1e_axis_backlash_at_rest(const cm1e_axis_t *axis) { return axis->backlash.offset_velocity == 0.0; }

/* The motor goes where the drive, or nobody, wants it. */
static bool foreign(const cm1e_axis_t *axis)
{
    return axis_free(axis) || (drive_homes(axis) && axis->homing_hooks->is_away(axis));
}

void cm1e_axis_backlash_track(cm1e_axis_t *axis, int32_t moved_counts)
{
    backlash_t *b = &axis->backlash;
    if (foreign(axis))
        b->offset = fmax(-b->gap, fmin(b->offset + sign(axis) * moved_counts, 0.0));
}

/* One cycle towards the target: as fast as it may, and so that it can still stop there. */
static void ramp(backlash_t *b, double cycle_s)
{
    const double rest = b->target - b->offset, way = rest < 0.0 ? -1.0 : 1.0;
    const double before = way * b->offset_velocity, change = b->acceleration * cycle_s;
    const double left = fabs(rest) - before * cycle_s / 2.0; /* if it stopped at the end of this cycle */
    if (left <= rounding && fabs(before) <= change * (1.0 + rounding)) {
        b->offset = b->target;
        b->offset_velocity = 0.0;
        return;
    }
    const double half = cycle_s / 2.0;
    double velocity = left > 0.0 ? b->acceleration * (sqrt(half * half + 2.0 * left / b->acceleration) - half) : 0.0;
    velocity = fmin(velocity, b->velocity);
    velocity = fmax(before - change, fmin(velocity, before + change));
    b->offset += way * (before + velocity) * half;
    b->offset_velocity = way * velocity;
}

void cm1e_axis_backlash_step(cm1e_axis_t *axis)
{
    backlash_t *b = &axis->backlash;
    if (foreign(axis)) {
        b->target = b->offset;
        b->offset_velocity = 0.0;
        return;
    }
    const double velocity = axis->setpoint.velocity * fabs(axis->position.scale);
    if (!cm1e_axis_wants_enable(axis)) /* about to lose its torque: no more than braking */
        b->target = b->offset + b->offset_velocity * fabs(b->offset_velocity) / (2.0 * b->acceleration);
    else if (velocity > least_velocity)
        b->target = 0.0;
    else if (velocity < -least_velocity)
        b->target = -b->gap;
    ramp(b, axis->cycle_s);
}
