/*
 * A motor that has run ahead of its set-point (CSP).
 *
 * A drive without new targets holds its last one. If the load is heavy, the motor needs longer to stop than frames were
 * missing, and is beyond that target when the next one comes. If the motion began anew there, the servo would pull the
 * load back, even backwards, and the motor would exceed its maximum velocity while it catches up afterwards. So the
 * set-point first goes after the motor, never faster than before the silence or pause, and slower when it is near. The
 * motion begins anew where both meet. If the drive has turned the motor round already, the set-point meets it on its
 * way back: the motor would swing to and fro about one that is far behind it. A slave makes up its distance to its
 * master then, and slaves of the axis, which see another velocity of their master, catch up. An axis of a group comes
 * to rest, and goes back to its path, which waits.
 *
 * A slave, a motion made of several, and a path go on after one or two cycles instead.
 *
 * Stops and ramps of errors are such motions too. Where the bus is lost, no set-point follows: the drive has braked by
 * itself, and the motor is held near where it comes to rest.
 */
#include <math.h>

#include "axis/axis_backlash.h"
#include "axis/axis_extras.h"
#include "axis/axis_guard.h"
#include "axis/axis_hooks.h"
#include "axis/axis_lead.h"
#include "axis/axis_limits.h"
#include "axis/axis_pause.h"
#include "axis/axis_pursuit.h"
#include "axis/axis_setpoint.h"

/* The set-point goes as much faster than the motor as makes up the distance in this time. A servo with a bandwidth
 * above 1 / approach_s brakes the motor until both meet, and does not overshoot. */
static const double approach_s = 8e-3;
/* Of the way in a cycle before: so near, the servo makes up the rest. */
static const double near = 0.5;
/* Of that way: one that is no farther ahead follows its set-point. An axis leaves its path for more than that only. */
static const double farthest_ways = 1.25, farthest_ways_on_path = 2.0;
/* Of the velocity of the motor. */
static const double least_part = 0.5;
/* Counts: of the actual position. */
static const double position_noise = 2.0;
/* A motor that is not met by then is moved by its load. */
static const double longest_s = 0.25;
/* A motor that does not come to rest by then. */
static const double longest_hold_s = 2.0;
/* Until a target reaches the drive: what the drive has shown is as old. */
static const double delay_cycles = 2.0;

static void end(cm1e_axis_t *axis)
{
    axis->setpoint.pursuit = (pursuit_t){0};
    cm1e_axis_set_extra(axis, EXTRA_PURSUIT, false);
}

/* Without 0x606C the actual velocity is the mean one between two answers. The first one after a pause or silence
 * shows that of the whole pause. A pause ends anywhere in a cycle: the second answer may come so soon that it shows
 * no velocity. Only the third one shows how fast the motor is. So it is with the first answers after a silence, if
 * one of them came late. */
enum { WAITS_AFTER_PAUSE = 2, WAITS_AFTER_SILENCE = 1 };
static bool shows_velocity(const cm1e_axis_t *axis) { return axis->drive.image.in_velocity.bytes > 0; }

/* A slave stops at once when its master fails. */
static bool has_to_stop(cm1e_axis_t *axis)
{
    return axis->setpoint.pursuit.under_way && axis_follows(axis) && axis->coupling_hooks->sees_trouble(axis);
}

static bool may_pursue(const cm1e_axis_t *axis)
{
    return axis->mode != CM1E_MODE_CSV && !cm1e_drive_is_virtual(&axis->drive) && set_points_move(axis) &&
           (!axis_led(axis) || axis->leader->strays);
}

/* u/s, in the direction of the motion before. */
static double speed_of_motor(const cm1e_axis_t *axis)
{
    return copysign(1.0, axis->setpoint.pursuit.velocity) * axis_actual_velocity(axis) / axis->position.scale;
}

/* u; by how much the motor is farther than one that follows its set-point, which is a cycle behind it. */
static double lead_of_motor(const cm1e_axis_t *axis)
{
    const double ahead = cm1e_position_minus(axis_actual(axis), axis->setpoint.position) / axis->position.scale;
    return copysign(1.0, axis->setpoint.pursuit.velocity) * ahead + speed_of_motor(axis) * axis->cycle_s;
}

/* u; of the motion before. */
static double way_of_cycle(const cm1e_axis_t *axis) { return fabs(axis->setpoint.pursuit.velocity) * axis->cycle_s; }

/* Another pause or silence comes before the drive has shown where the motor is after the first one: the motor still has
 * the velocity from before that one, and the set-point, which began anew, has hardly any. */
static bool waits_for_motor(const cm1e_axis_t *axis)
{
    return axis_has_extra(axis, EXTRA_PURSUIT) && !axis->setpoint.pursuit.under_way &&
           fabs(axis->setpoint.pursuit.velocity) >= fabs(axis->setpoint.velocity);
}

static void prepare(cm1e_axis_t *axis, double unheard_s, uint8_t waits)
{
    if (may_pursue(axis) && waits_for_motor(axis)) {
        axis->setpoint.pursuit.unheard_s += unheard_s;
        axis->setpoint.pursuit.waits = waits;
        return;
    }
    if (!may_pursue(axis) || axis->setpoint.velocity == 0.0)
        return;
    const double v = axis->setpoint.velocity, gain = axis->setpoint.acceleration * 2.0 * axis->cycle_s;
    double speed = fabs(v) - fmax(0.0, v > 0.0 ? gain : -gain);
    if (axis->setpoint.pursuit.under_way) /* the motor is slower than the set-point that goes after it */
        speed = fmin(speed, speed_of_motor(axis));
    axis->setpoint.pursuit = (pursuit_t){.velocity = v, .speed = speed, .unheard_s = unheard_s, .waits = waits};
    cm1e_axis_set_extra(axis, EXTRA_PURSUIT, true);
}

void cm1e_axis_pursuit_prepare(cm1e_axis_t *axis, double unheard_s)
{
    prepare(axis, unheard_s, shows_velocity(axis) ? 0 : WAITS_AFTER_PAUSE);
}

/* What the drive hears after a rest of the set-point is no faster than if it had braked meanwhile. */
static void slow_down(cm1e_axis_t *axis, double time_s)
{
    double *velocity = &axis->setpoint.pursuit.velocity;
    *velocity = copysign(fmax(0.0, fabs(*velocity) - axis->limits.system.deceleration * time_s), *velocity);
}

/* An axis of a path rests until the drive has shown where the motor is. */
static void brake_meanwhile(cm1e_axis_t *axis, double time_s)
{
    if (axis_led(axis))
        slow_down(axis, time_s);
}

/* Whether a servo that brakes as hard as this one has braked would overshoot when it has pulled the motor back. It can
 * brake as hard as its axis may: what a motor that hardly turned has braked says nothing. */
static bool is_too_far(const cm1e_axis_t *axis)
{
    const pursuit_t *pursuit = &axis->setpoint.pursuit;
    const double braked = fmax(0.0, pursuit->speed - speed_of_motor(axis)) / pursuit->unheard_s;
    const double braking = fmax(braked, axis->limits.system.deceleration);
    const double noise = (position_noise + CM1E_AXIS_VELOCITY_NOISE * axis->cycle_s) / fabs(axis->position.scale);
    const double ways = axis_led(axis) ? farthest_ways_on_path : farthest_ways;
    return lead_of_motor(axis) > fmax(ways * way_of_cycle(axis), braking * approach_s * approach_s / 2.0) + noise;
}

/* A path that has just begun again is so slow that nothing is gained by going after a motor with its velocity. */
static bool is_too_slow(const cm1e_axis_t *axis)
{
    return axis_led(axis) && fabs(axis->setpoint.pursuit.velocity) < least_part * speed_of_motor(axis);
}

/* Whether the set-point goes to a motor that the drive has turned round already. That takes longer than the few cycles
 * after which a motor behind a bridge may seem to rest. An axis of a path and the ramp of an error do not, nor does a
 * homing, which may press. */
static bool meets_on_way_back(const cm1e_axis_t *axis)
{
    const bool stops = axis->state == CM1E_AXIS_STOPPING && axis_on_profile(axis) && !axis->homing_step.after_stop;
    const bool moves = axis->state == CM1E_AXIS_DISCRETE_MOTION || axis->state == CM1E_AXIS_CONTINUOUS_MOTION;
    const bool follows = axis->state == CM1E_AXIS_SYNCHRONIZED_MOTION && axis_follows(axis);
    const double longer_s = (CM1E_AXIS_RIDDEN_OUT_CYCLES + 1) * axis->cycle_s;
    return (stops || moves || follows) && axis->setpoint.pursuit.unheard_s > longer_s;
}

static bool begin(cm1e_axis_t *axis)
{
    const bool met = speed_of_motor(axis) > 0.0 || meets_on_way_back(axis);
    const bool ahead = met && is_too_far(axis) && !is_too_slow(axis);
    axis->setpoint.pursuit.under_way = ahead;
    axis->setpoint.pursuit.holds = !ahead && axis->state == CM1E_AXIS_ERROR_STOP; /* it may come back already */
    if (!ahead && !axis->setpoint.pursuit.holds)
        end(axis);
    return ahead;
}

/* About the cycles in which the motor has braked: those of this silence, and since earlier ones that still count. */
static double cycles_of_braking(const cm1e_axis_t *axis)
{
    const int silent = axis->silence.silent_before, earlier = axis->silence.shaken - silent * CM1E_SHAKEN_BY_SILENCE;
    return silent + fmax(0.0, earlier) / 3.0;
}

/* A slave stays with its master, and what is made of several motions would end, after a short silence, which both ride
 * out. */
static bool goes_on(const cm1e_axis_t *axis)
{
    if (axis_led(axis))
        return axis->leader->begins_anew && !axis->leader->begins_anew(axis->leader->context);
    return (axis_follows(axis) || axis->setpoint.source->is_composite || axis->superimposed.id) &&
           axis->silence.silent_before <= CM1E_AXIS_RIDDEN_OUT_CYCLES;
}

bool cm1e_axis_pursuit_begin(cm1e_axis_t *axis)
{
    if (!may_pursue(axis))
        return false;
    if (axis->setpoint.pursuit.under_way) /* it goes on, and ends by what the drive shows now */
        return true;
    if (goes_on(axis))
        return false;
    prepare(axis, cycles_of_braking(axis) * axis->cycle_s, shows_velocity(axis) ? 0 : WAITS_AFTER_SILENCE);
    return axis_has_extra(axis, EXTRA_PURSUIT) && shows_velocity(axis) && begin(axis);
}

/* A homing does not know its software limits. `velocity`: u/s. */
static bool runs_into_limit(const cm1e_axis_t *axis, double velocity)
{
    const cm1e_motion_state_t now = {0.0, velocity, 0.0};
    return axis->state != CM1E_AXIS_HOMING &&
           !cm1e_axis_limits_can_stop(axis, cm1e_axis_line(axis, axis->setpoint.position), now);
}

/* u/s, in the direction of the motion before; never more than in the cycle before. Where the set-point could no longer
 * stop before a software limit, it brakes on its way to the motor: it would run away from one that the drive has slowed
 * down. */
static double speed_of_pursuit(const cm1e_axis_t *axis)
{
    const double before = axis->setpoint.pursuit.cycles > 0 ? axis->setpoint.velocity : axis->setpoint.pursuit.velocity;
    const double brakes = runs_into_limit(axis, before) ? axis->limits.emergency.deceleration * axis->cycle_s : 0.0;
    return fmax(0.0, fmin(speed_of_motor(axis) + lead_of_motor(axis) / approach_s, fabs(before) - brakes));
}

static bool is_over(const cm1e_axis_t *axis, double speed)
{
    return speed == 0.0 || lead_of_motor(axis) <= near * way_of_cycle(axis) ||
           axis->setpoint.pursuit.cycles * axis->cycle_s > longest_s;
}

/* Called when the velocity has changed by a step, and before the set-point of the cycle is made. */
static void tell_slaves(cm1e_axis_t *axis)
{
    if (axis->coupling_hooks)
        axis->coupling_hooks->begin_slaves_anew(axis);
}

/* The set-point of this cycle. Where the pursuit is over, the next one is that of the motion that begins anew. */
static void go_after(cm1e_axis_t *axis)
{
    const double speed = speed_of_pursuit(axis), velocity = copysign(speed, axis->setpoint.pursuit.velocity);
    const bool over = is_over(axis, speed);
    if (axis_led(axis))
        axis->leader->strays(axis->leader->context, axis->leader->index, velocity);
    cm1e_axis_put_velocity(axis, velocity);
    cm1e_axis_set_reached(axis, false);
    tell_slaves(axis);
    cm1e_axis_shift_set_point(axis, velocity * axis->cycle_s * axis->position.scale);
    axis->setpoint.pursuit.cycles++;
    if (!over)
        return;
    end(axis);
    cm1e_axis_guard_renew(axis);
    if (!axis_led(axis))
        cm1e_axis_begin_anew(axis, velocity);
}

/* u/s; of the motor, no faster than the set-point that goes after it. */
static double velocity_of_motor(const cm1e_axis_t *axis)
{
    const double speed = fmax(0.0, fmin(speed_of_motor(axis), fabs(axis->setpoint.velocity)));
    return copysign(speed, axis->setpoint.pursuit.velocity);
}

/* Another motion has begun at the set-point, or there is none any more. A profile that began before must not go on, and
 * a slave must not begin with the velocity that was to meet the motor, which may be at rest. */
static void give_up(cm1e_axis_t *axis)
{
    const bool under_way = axis->setpoint.pursuit.under_way;
    const double left = velocity_of_motor(axis);
    end(axis);
    if (!under_way)
        return;
    cm1e_axis_guard_renew(axis);
    if (axis_on_profile(axis))
        cm1e_axis_begin_anew(axis, axis->setpoint.velocity);
    else if (axis_follows(axis))
        cm1e_axis_begin_anew(axis, left);
    else
        return;
    tell_slaves(axis);
}

/* A stop from rest, which ends at once: it must not be done while the motor may turn. */
static bool is_stop_from_rest(const cm1e_axis_t *axis)
{
    return axis_on_profile(axis) && axis->setpoint.velocity == 0.0 && axis->setpoint.profile.duration_s <= 0.0;
}

/* What the drive has shown is older than the pause or silence. true: there is no set-point before it has shown more. */
static bool wait(cm1e_axis_t *axis)
{
    if (axis->silence.resumed == RESUMED_FROM_SILENCE)
        brake_meanwhile(axis, (axis->silence.silent_before + 1) * axis->cycle_s);
    else if (!axis->silence.resumed)
        brake_meanwhile(axis, axis->cycle_s);
    if (!axis->silence.resumed)
        axis->setpoint.pursuit.waits--;
    return is_stop_from_rest(axis);
}

double cm1e_axis_pursuit_velocity(const cm1e_axis_t *axis)
{
    const bool waits = axis_has_extra(axis, EXTRA_PURSUIT) && !axis->setpoint.pursuit.under_way;
    return waits ? axis->setpoint.pursuit.velocity : axis->setpoint.velocity;
}

/* ---- a motor that nothing leads any more ------------------------------------------------------------------------- */

void cm1e_axis_pursuit_hold(cm1e_axis_t *axis)
{
    const double unheard_s = axis->silence.silent * axis->cycle_s;
    prepare(axis, unheard_s, 0);
    slow_down(axis, unheard_s + axis->cycle_s);
    axis->setpoint.pursuit.holds = axis_has_extra(axis, EXTRA_PURSUIT);
}

/* The set-point goes to the motor. true: it is there. No target that is heard late makes a larger step than one of an
 * axis that has braked since the bus was lost. */
static bool go_to_motor(cm1e_axis_t *axis)
{
    const double sign = copysign(1.0, axis->setpoint.pursuit.velocity), way = way_of_cycle(axis);
    const double ahead = sign * cm1e_position_minus(axis_actual(axis), axis->setpoint.position) / axis->position.scale;
    cm1e_axis_shift_set_point(axis, sign * fmax(0.0, fmin(ahead, way)) * axis->position.scale);
    cm1e_axis_hold_here(axis);
    return ahead <= way;
}

/* The drive brakes by itself, with all of its torque, towards the last target. Where its load has turned it on beyond
 * that, it would be pulled back as hard, to and fro. So it is held near the place where it comes to rest. */
static void hold_near_rest(cm1e_axis_t *axis)
{
    pursuit_t *pursuit = &axis->setpoint.pursuit;
    pursuit->unheard_s += axis->cycle_s;
    slow_down(axis, axis->cycle_s);
    if (axis->silence.silent > 0 || axis->silence.resumed) /* it is not heard, or what it has shown is older */
        return;
    const double speed = speed_of_motor(axis), lost = (pursuit->speed - speed) * axis->cycle_s / pursuit->unheard_s;
    /* Else the torque goes in this cycle, and the target stays. */
    const bool goes_on = axis_acts(axis) && axis_holds(axis) && pursuit->unheard_s < longest_hold_s;
    if (goes_on && !pursuit->under_way && fabs(speed) > delay_cycles * lost)
        return;
    pursuit->under_way |= is_too_far(axis);
    if (!goes_on || !pursuit->under_way || go_to_motor(axis))
        end(axis);
}

bool cm1e_axis_pursue(cm1e_axis_t *axis)
{
    if (axis->setpoint.pursuit.holds) {
        hold_near_rest(axis);
        return false;
    }
    if (!may_pursue(axis) || has_to_stop(axis)) {
        give_up(axis);
        return false;
    }
    pursuit_t *pursuit = &axis->setpoint.pursuit;
    if (!pursuit->under_way && (axis->silence.resumed || pursuit->waits > 0))
        return wait(axis);
    if (!pursuit->under_way && !begin(axis))
        return false;
    go_after(axis);
    return true;
}
