/*
 * Backlash. Between the motor and its load is a gap of `gap` counts. A motor that pushes in the positive direction of
 * the axis is at the position of the load. One that pushes in the negative direction is a gap before it. `offset`, -gap
 * ... 0, is the position of the motor relative to the load. At a reversal the offset is ramped from one flank to the
 * other, in addition to the motion of the axis, whose maximum velocity leaves room for the ramp. Until the ramp ends,
 * the load is not where the set-point has it: it rests until the motor reaches the flank. Without our set-points (no
 * torque, homing by the drive) the offset is the one that the positions of the motor say: a ramp that ended on its way
 * has not moved the load. So it is while a motor that turned when it got its torque is brought to rest: that ramp is
 * one of the motor, wherever it is in its gap. At the start the offset is unknown, and the positive flank is assumed to
 * be closed.
 *
 * All other parts of the axis know only the load: its set-point, its actual position, its lag.
 */
#include <math.h>

#include "axis/axis_backlash.h"
#include "axis/axis_extras.h"
#include "axis/axis_power.h"
#include "axis/axis_setpoint.h"

/* The compensation reaches its velocity in this time. */
static const double ramp_s = 0.02;
/* Counts: tolerance of the end of a ramp. */
static const double rounding = 1e-6;
/* Counts/s: below this the sign of a set velocity is rounding. */
static const double least_velocity = 1e-3;

void cm1e_axis_backlash_init(cm1e_axis_t *axis)
{
    const cm1e_axis_config_t *c = axis->config;
    backlash_t *b = &axis->backlash;
    const double scale = fabs(axis->position.scale);
    b->gap = c->backlash * scale;
    cm1e_axis_set_extra(axis, EXTRA_BACKLASH, b->gap > 0.0);
    if (b->gap == 0.0)
        return;
    b->velocity = c->backlash_velocity > 0.0 ? c->backlash_velocity * scale : cm1e_unit_backlash_velocity(c);
    const cm1e_motion_limits_t *most = &axis->limits.maximum;
    b->acceleration = fmin(b->velocity / ramp_s, fmin(most->acceleration, most->deceleration) * scale);
}

static double sign(const cm1e_axis_t *axis) { return axis->position.scale < 0.0 ? -1.0 : 1.0; }

double cm1e_axis_backlash_offset(const cm1e_axis_t *axis) { return sign(axis) * axis->backlash.offset; }

double cm1e_axis_backlash_velocity(const cm1e_axis_t *axis) { return sign(axis) * axis->backlash.offset_velocity; }

/* Whether the motor has torque, and is not taken over yet: its target is that of a motor that comes to rest. */
static bool waits_to_be_taken_over(const cm1e_axis_t *axis)
{
    return !axis->power.energized && !axis_free(axis) && !drive_moves(axis);
}

/* Whether the motor does not follow set-points of the load. */
static bool foreign(const cm1e_axis_t *axis)
{
    return axis_free(axis) || waits_to_be_taken_over(axis) || (drive_homes(axis) && axis->homing_hooks->is_away(axis));
}

double cm1e_axis_backlash_slip(const cm1e_axis_t *axis) { return sign(axis) * axis->backlash.slip; }

bool cm1e_axis_backlash_at_rest(const cm1e_axis_t *axis) { return axis->backlash.offset_velocity == 0.0; }

bool cm1e_axis_backlash_is_seen(const cm1e_axis_t *axis) { return axis->backlash.offset == axis->backlash.seen; }

static double in_gap(const backlash_t *b, double place) { return fmax(-b->gap, fmin(place, 0.0)); }

/* What the set-points had made of the offset is taken back at once, or where slaves follow the actual position, no
 * faster than they may cross the gap. */
void cm1e_axis_backlash_track(cm1e_axis_t *axis, int32_t moved_counts)
{
    backlash_t *b = &axis->backlash;
    const double step = axis->observed ? b->velocity * axis->cycle_s : b->gap, off = b->offset - b->seen;
    const double before = b->offset;
    b->seen = in_gap(b, b->seen + sign(axis) * moved_counts);
    b->slip = 0.0;
    if (!foreign(axis))
        return;
    b->target = b->offset = in_gap(b, b->seen + fmax(off - step, fmin(0.0, off + step)));
    b->slip = b->offset - before;
    if (waits_to_be_taken_over(axis) && b->slip != 0.0) /* the target of the motor stays where it is */
        cm1e_axis_shift_motion(axis, -cm1e_axis_backlash_slip(axis));
}

/* Moves the offset on by a cycle: as fast as allowed, and slow enough to stop at its target. */
static void ramp(backlash_t *b, double cycle_s)
{
    const double rest = b->target - b->offset, way = rest < 0.0 ? -1.0 : 1.0;
    const double before = way * b->offset_velocity, change = b->acceleration * cycle_s;
    const double left = fabs(rest) - before * cycle_s / 2.0; /* the way that is left after this cycle */
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
    if (!cm1e_axis_wants_enable(axis)) /* the torque is about to be taken away: it only brakes */
        b->target = b->offset + b->offset_velocity * fabs(b->offset_velocity) / (2.0 * b->acceleration);
    else if (velocity > least_velocity)
        b->target = 0.0;
    else if (velocity < -least_velocity)
        b->target = -b->gap;
    ramp(b, axis->cycle_s);
}
