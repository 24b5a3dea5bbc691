/*
 * Power, errors and their reset: the transitions of figure 2 that no motion command makes.
 *
 * If MC_Power.Enable becomes FALSE while the axis moves, the commands are aborted and the state is Disabled at once
 * (note 2). The motor is ramped down with the axis's deceleration, and loses its torque only then; until then
 * MC_Power.Status is TRUE. ErrorStop ramps down without a limit of jerk and ends without torque too. So MC_Reset leads
 * to Disabled (note 3), and from there to Standstill if MC_Power.Enable is TRUE.
 *
 * The end of a ramp is the end of its set-points. A heavy load that a pause has let swing still turns the motor then,
 * and only the torque can stop it. So the torque stays until the motor rests too, or for two seconds if it never does.
 * It does not stay for a motor that runs away.
 */
#include <math.h>

#include "axis/axis_power.h"
#include "axis/axis_backlash.h"
#include "axis/axis_commands.h"
#include "axis/axis_device.h"
#include "axis/axis_guest.h"
#include "axis/axis_events.h"
#include "axis/axis_handle.h"
#include "axis/axis_lead.h"
#include "axis/axis_limits.h"
#include "axis/axis_pause.h"
#include "axis/axis_position.h"
#include "axis/axis_pursuit.h"
#include "axis/axis_setpoint.h"
#include "axis/axis_text.h"
#include "core/clock.h"
#include "core/extreme.h"
#include "core/rare.h"

/* At the end of a run, the time after which an offline drive counts as gone. */
static const int64_t gone_after_ns = 100 * MS_IN_NS;
static const int64_t brake_ns = 20 * MS_IN_NS;
/* A motor that its emergency deceleration brings to rest in this time is about to rest: it follows its set-point. */
static const double rests_in_s = 3e-3;
static const double rest_counts = 50.0; /* tolerance, in counts of a CM1-E */
enum { BACK = 3 }; /* power_t.turning */
/* Cycles, at most 15. */
static const unsigned longest_undecided = 10;
/* A motor that does not come to rest by then is turned by something else than its ramp. */
static const uint16_t longest_swing_ms = CM1E_AXIS_LONGEST_SWING_MS;

/* Stops the motion, by our ramp or, during a homing, by the drive. Without torque there is nothing to stop. */
static void wind_down(cm1e_axis_t *axis, const cm1e_motion_limits_t *ramp)
{
    if (!axis->drive.feedback.enabled && !drive_moves(axis))
        cm1e_axis_become_free(axis);
    else
        axis->setpoint.source->stop(axis, ramp, HOME_GOAL_OFF);
}

void cm1e_axis_error_stop(cm1e_axis_t *axis, cm1e_error_t error, double value, double bound,
                          const cm1e_motion_limits_t *ramp)
{
    if (axis->state == CM1E_AXIS_ERROR_STOP)
        return; /* the first cause is reported */
    const bool homing_broke = drive_homes(axis) &&
                              (error == CM1E_ERROR_AXIS_HOMING_FAILED || error == CM1E_ERROR_AXIS_HOMING_TIMEOUT);
    const bool followed = axis_follows(axis);
    const bool coupling_broke = followed && (error == CM1E_ERROR_AXIS_COUPLING_LIMIT ||
                                             error == CM1E_ERROR_AXIS_MASTER_LOST || error == CM1E_ERROR_AXIS_COUPLED);
    const bool planner_broke = error == CM1E_ERROR_AXIS_SET_POINT_LIMIT || error == CM1E_ERROR_AXIS_SET_POINT_MISSING;
    /* 2.2.2: the blocks that lose the axis show an error, not CommandAborted. */
    cm1e_axis_commands_end(axis, CM1E_COMMAND_ERROR,
                           homing_broke || coupling_broke || planner_broke ? error : CM1E_ERROR_AXIS_ERROR_STOP);
    cm1e_axis_set_refusal(axis, CM1E_OK); /* outdated after the reset */
    cm1e_axis_forget_not_set(axis);
    axis->fault.error = error;
    axis->fault.device_error = axis->drive.fault.device_code;
    axis->fault.value = value;
    axis->fault.bound = bound;
    cm1e_axis_go(axis, ON_ERROR);
    if (!followed || !axis->coupling_hooks->stops_with_masters(axis))
        wind_down(axis, ramp);
    if (followed)
        axis->coupling_hooks->failed(axis);
}

/* `task`: that did not return; NULL: none. */
static void fail_without_program(cm1e_axis_t *axis, const char *task, bool late, int64_t time_ns)
{
    if (axis->state == CM1E_AXIS_ERROR_STOP)
        return;
    axis->fault.task = task;
    axis->fault.late = late;
    if (axis_led(axis))
        cm1e_axis_lead_fail(axis, CM1E_ERROR_PROGRAM); /* all in step: they stay on the path */
    else
        cm1e_axis_fail(axis, CM1E_ERROR_PROGRAM, 0.0, 0.0);
    if (axis->fault.error == CM1E_ERROR_PROGRAM)
        axis->fault.value = (double)time_ns / (double)MS_IN_NS;
}

void cm1e_axis_lose_program(cm1e_axis_t *axis, const char *task, int64_t limit_ns)
{
    if (axis->config->type == CM1E_AXIS_ENCODER)
        return;
    axis->power.enable = false;
    cm1e_axis_power_unsettle(axis);
    fail_without_program(axis, task, false, limit_ns);
}

/* Whether it has torque, or is about to get it. */
static bool needs_program(const cm1e_axis_t *axis)
{
    const bool torque = axis->state != CM1E_AXIS_DISABLED || axis->power.enable || axis->drive.command.enable;
    return torque && axis->config->type != CM1E_AXIS_ENCODER;
}

void cm1e_axis_stood_still(cm1e_axis_t *axis, int64_t pause_ns, int64_t now_ns)
{
    axis->now_ns = now_ns; /* the inputs of this cycle may be from before the pause: the braking begins behind it */
    if (needs_program(axis))
        fail_without_program(axis, NULL, false, pause_ns);
}

void cm1e_axis_ran_late(cm1e_axis_t *axis, int64_t late_ns)
{
    if (!needs_program(axis))
        return;
    fail_without_program(axis, NULL, true, late_ns);
    if (!axis_free(axis) && !drive_moves(axis)) /* a drive that homes, or moves by its own profile, brakes by itself */
        cm1e_axis_become_free(axis);
}

/* Begins to brake at the actual state, no faster and no farther than the set-point would have gone, or went before a
 * pause. The ramp lasts a moment at least, because the feedback is some cycles old and the motor may just begin to
 * move. */
void cm1e_axis_brake_from_actual(cm1e_axis_t *axis)
{
    if (axis_free(axis))
        return;
    const double velocity = axis_actual_velocity(axis) / axis->position.scale;
    const double before = cm1e_axis_pursuit_velocity(axis);
    cm1e_axis_set_to_actual(axis);
    cm1e_axis_put_velocity(axis, before > 0.0 ? fmax(0.0, fmin(velocity, before)) : fmin(0.0, fmax(velocity, before)));
    cm1e_axis_ramp_down(axis, &axis->limits.emergency);
    axis->power.brake_until_ns = axis->now_ns + brake_ns;
}

void cm1e_axis_keep_torque(cm1e_axis_t *axis, double velocity)
{
    const double ramp_s = fabs(velocity) / axis->limits.emergency.deceleration;
    axis->power.brake_until_ns = axis->now_ns + brake_ns + (int64_t)(ramp_s * 1e9);
}

void cm1e_axis_hold_unheard(cm1e_axis_t *axis)
{
    const bool moves = set_points_move(axis);
    if (axis->mode == CM1E_MODE_CSV || cm1e_drive_is_virtual(&axis->drive) ||
        !(moves || !cm1e_axis_backlash_at_rest(axis)))
        return;
    cm1e_axis_keep_torque(axis, axis->setpoint.velocity + cm1e_axis_backlash_velocity(axis) / axis->position.scale);
    cm1e_axis_backlash_stop(axis); /* the drive has stopped at the last target that it has heard */
    if (!moves)
        return;
    cm1e_axis_pursuit_hold(axis);
    cm1e_axis_hold_here(axis);
}

static void power_off(cm1e_axis_t *axis)
{
    if (axis->state == CM1E_AXIS_DISABLED || axis->state == CM1E_AXIS_ERROR_STOP)
        return;
    cm1e_axis_commands_end(axis, CM1E_COMMAND_ABORTED, CM1E_OK);
    cm1e_axis_go(axis, ON_POWER_OFF);
    wind_down(axis, &axis->limits.maximum);
}

/* The owner where a guest has enabled the axis (axis_guest.h). */
static const char guest;

/* A block may be replaced while it does not enable the axis. A guest gives way. */
static bool may_own(const power_t *power, const void *owner)
{
    return !power->owner || power->owner == owner || power->owner == &guest || !(power->enable || power->energized);
}

cm1e_error_t cm1e_axis_power(cm1e_axis_t *axis, const void *owner, bool enable, bool enable_positive,
                             bool enable_negative)
{
    axis->power.claimed |= owner != &guest;
    if (enable && axis->config->type == CM1E_AXIS_ENCODER) {
        cm1e_axis_set_refusal(axis, CM1E_ERROR_AXIS_VIRTUAL);
        return CM1E_ERROR_AXIS_VIRTUAL;
    }
    if (!may_own(&axis->power, owner))
        return CM1E_ERROR_FB_SECOND_POWER;
    axis->power.owner = owner;
    cm1e_axis_power_unsettle(axis);
    const bool positive_fell = axis->power.enable_positive && !enable_positive;
    const bool negative_fell = axis->power.enable_negative && !enable_negative;
    axis->power.shutting_down = false;
    axis->power.enable = enable;
    if (axis->power.enable_positive != enable_positive || axis->power.enable_negative != enable_negative)
        cm1e_axis_look_anew(axis);
    axis->power.enable_positive = enable_positive;
    axis->power.enable_negative = enable_negative;
    if (!enable)
        power_off(axis);
    if (positive_fell)
        cm1e_axis_direction_disabled(axis, 1.0);
    if (negative_fell)
        cm1e_axis_direction_disabled(axis, -1.0);
    if ((positive_fell || negative_fell) && axis->state == CM1E_AXIS_HOMING && axis->commands.active &&
        drive_homes(axis)) {
        cm1e_axis_command_end(axis, CM1E_COMMAND_ERROR, CM1E_ERROR_AXIS_DIRECTION_DISABLED);
        axis->setpoint.source->stop(axis, &axis->limits.maximum, HOME_GOAL_HOLD);
    }
    return enable && axis->motor_hooks ? axis->motor_hooks->refuses_power(axis) : CM1E_OK;
}

bool cm1e_axis_guest_powers(const cm1e_axis_t *axis) { return axis->power.owner == &guest && axis->power.enable; }

cm1e_guest_refusal_t cm1e_axis_guest_power(cm1e_axis_t *axis, bool enable)
{
    if (axis->power.claimed || (!enable && axis->power.owner != &guest))
        return CM1E_GUEST_POWER;
    if (cm1e_axis_power(axis, &guest, enable, true, true) == CM1E_OK)
        return CM1E_GUEST_MAY;
    cm1e_axis_power(axis, &guest, false, true, true);
    return CM1E_GUEST_MODE;
}

void cm1e_axis_claim_power(AXIS_REF_t reference)
{
    cm1e_axis_t *axis = cm1e_axis_from_handle(reference.Handle);
    if (!axis || axis->power.claimed)
        return;
    if (cm1e_axis_guest_powers(axis))
        cm1e_axis_power(axis, &guest, false, true, true);
    axis->power.claimed = true;
}

void cm1e_axis_power_settle(cm1e_axis_t *axis, const void *owner, uint64_t shown)
{
    if (axis->power.owner == owner && axis->power.enable && !axis->power.shutting_down && cm1e_axis_powered(axis))
        axis->power.settled = shown;
}

bool cm1e_axis_power_settled(AXIS_REF_t reference, const void *owner, uint64_t shown)
{
    const cm1e_axis_t *axis = cm1e_axis_from_handle(reference.Handle);
    return CM1E_USUALLY(axis && axis->power.owner == owner && axis->power.settled == shown);
}

void cm1e_axis_power_check(cm1e_axis_t *axis)
{
    if (axis->drive.feedback.state != OPERATION_ENABLED)
        cm1e_axis_power_unsettle(axis);
}

bool cm1e_axis_powered(const cm1e_axis_t *axis)
{
    return axis->power.energized && axis->drive.feedback.state == OPERATION_ENABLED;
}

/* counts/s; a motor that is slower rests. */
static double slow_velocity(const cm1e_axis_t *axis)
{
    const double noise = cm1e_axis_tolerance_counts(axis, CM1E_AXIS_VELOCITY_NOISE * axis->cycle_s) / axis->cycle_s;
    return axis->limits.emergency.deceleration * fabs(axis->position.scale) * rests_in_s + noise;
}

static bool is_fast(const cm1e_axis_t *axis) { return fabs(axis_actual_velocity(axis)) > slow_velocity(axis); }

/* counts; of the motor. */
static double away_from_set_point(const cm1e_axis_t *axis)
{
    return cm1e_position_minus(axis_actual(axis), axis->setpoint.position);
}

/* counts; of a motor without torque in this cycle. The set-point is where its load was in the cycle before. */
static double way_of_cycle(const cm1e_axis_t *axis)
{
    return away_from_set_point(axis) + cm1e_axis_backlash_slip(axis);
}

/* counts/s; the least that tells this velocity, the one of the cycle before, what both come to in the next cycle, and
 * the way since then. So one untrue value turns nothing, and the motor is not driven where the drive brakes it
 * already. */
static double coasting_velocity(const cm1e_axis_t *axis)
{
    const double now = axis_actual_velocity(axis), before = axis->power.velocity;
    const double others[] = {before, 2.0 * now - before, way_of_cycle(axis) / axis->cycle_s};
    double least = fabs(now);
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++)
        least = fmin(least, others[i] * now > 0.0 ? fabs(others[i]) : 0.0);
    return copysign(least, now);
}

/* Begins the ramp of a motor that turns with this velocity (counts/s), if it ends before a software limit. */
static bool brakes_first(cm1e_axis_t *axis, double counts_per_s)
{
    const double most = axis->limits.system.velocity;
    const double velocity = fmax(-most, fmin(counts_per_s / axis->position.scale, most));
    const cm1e_motion_state_t next = {.position = velocity * axis->cycle_s, .velocity = velocity};
    if (fabs(counts_per_s) <= slow_velocity(axis) ||
        !cm1e_axis_limits_can_stop(axis, cm1e_axis_line(axis, axis_actual(axis)), next))
        return false;
    cm1e_axis_set_to_actual(axis);
    cm1e_axis_put_velocity(axis, velocity);
    cm1e_axis_ramp_down(axis, &axis->limits.emergency);
    return true;
}

/* Lets the set-point stand where the motor is. */
static void hold_motor(cm1e_axis_t *axis)
{
    cm1e_axis_set_to_actual(axis);
    cm1e_axis_hold_here(axis);
}

/* Takes over the enabled drive (note 5). Its set-point is where the motor was braked, or begins at the actual position
 * of this cycle. */
static void take_over(cm1e_axis_t *axis)
{
    if (axis_free(axis))
        cm1e_axis_set_to_actual(axis);
    cm1e_axis_set_source(axis, &cm1e_source_hold);
    axis->power.energized = true;
    cm1e_axis_steps_init(axis);
    cm1e_axis_apply_limits(axis); /* without torque it may have been turned past the end of the counts */
    cm1e_axis_go(axis, ON_POWER_ON);
}

static int64_t later(int64_t a_ns, int64_t b_ns) { return a_ns > b_ns ? a_ns : b_ns; }

/* Whether the motor is not brought back by its servo: it gets faster on its way away from the set-point than it ever
 * came back, or was at first, or it is farther away than its lag may be. A load that swings does neither. A motor that
 * is caught when it gets its torque may do both for a moment, but never exceeds its maximum velocity. `away`: counts;
 * `slow`: tolerance. */
static bool runs_away(cm1e_axis_t *axis, double away, double velocity, double slow)
{
    const double speed = fabs(velocity), scale = fabs(axis->position.scale);
    const bool goes_away = away * velocity > 0.0, caught = !axis->power.energized;
    if (!goes_away)
        axis->power.velocity = fmaxf(axis->power.velocity, (float)speed);
    const double most = caught ? axis->limits.system.velocity * scale : 0.0;
    return (goes_away && speed > fmax(axis->power.velocity, most) + slow) ||
           (!caught && fabs(away) > axis->limits.max_lag * scale);
}

/* counts; beyond the noise of a motor that follows its set-point. */
static bool is_far(const cm1e_axis_t *axis, double away)
{
    return fabs(away) > slow_velocity(axis) * rests_in_s + cm1e_axis_tolerance_counts(axis, rest_counts);
}

/* Whether the motor is given up: it turns on for too long, or runs away. */
static bool swing_is_over(const cm1e_axis_t *axis)
{
    return (uint16_t)((uint16_t)(axis->now_ns / MS_IN_NS) - axis->power.held_ms) >= longest_swing_ms;
}

static bool paused(const cm1e_axis_t *axis) { return axis->silence.resumed == RESUMED_FROM_PAUSE; }

/* Whether the drive has shown in this cycle what the motor does now. */
static bool shows_motor(const cm1e_axis_t *axis)
{
    return axis->drive.feedback.fresh && !axis->silence.frozen && !paused(axis);
}

/* Whether it has shown that the motor rests. */
static bool shows_rest(const cm1e_axis_t *axis)
{
    return shows_motor(axis) && axis->drive.actual.contradictions == 0 && !is_fast(axis);
}

/* The motor may turn while the axis is not on yet: it is to rest for a moment then. Where its servo turns it round, it
 * is slow too, and friction may hold it there for some cycles. A pause is longer than it seems in its first cycle,
 * which has the time of its inputs: the cycle after it counts too. */
static void note_coasting(cm1e_axis_t *axis)
{
    if (axis->drive.actual.seen && (axis->power.undecided > 0 || !shows_rest(axis)))
        axis->power.brake_until_ns = axis->now_ns + brake_ns;
}

/* Whether a motor that is caught has turned round, far from the set-point: it was too fast for its ramp, or its load is
 * too heavy. Two cycles show it, so that one untrue position does not. */
static bool comes_back(cm1e_axis_t *axis, double away, double velocity)
{
    power_t *power = &axis->power;
    const bool caught = axis->state == CM1E_AXIS_DISABLED && !power->energized; /* else its bus was lost: a pursuit */
    if (!caught || !shows_motor(axis) || axis->drive.actual.contradictions > 0)
        return false;
    if (away * velocity > 0.0)
        power->turning = power->turning > 0 || fabs(velocity) > slow_velocity(axis);
    else if (power->turning > 0 && power->turning < BACK)
        power->turning++;
    return power->turning == BACK && is_far(axis, away);
}

/* The target goes to the motor no faster than a motor can (a rule of the bridge), though faster than its axis may be:
 * it meets the motor. true: it is there. */
static bool go_to_motor(cm1e_axis_t *axis, double away)
{
    const double whole = floor(cm1e_unit_peak_velocity(axis->config) * axis->cycle_s);
    const double most = larger(1.0, smaller(whole, INT32_MAX)); /* counts */
    cm1e_axis_shift_set_point(axis, fmax(-most, fmin(away, most)));
    cm1e_axis_hold_here(axis);
    axis->drive.command.position_step = (int32_t)larger(most, axis->drive.command.position_step);
    axis->power.brake_until_ns = later(axis->power.brake_until_ns, axis->now_ns + brake_ns);
    return fabs(away) <= most;
}

/* Power comes back during the ramp of a homing step that pressed, whose set-point is beyond the stop: it goes back to
 * the motor. While the drive is not heard it waits. true: nothing presses, so the axis may be taken over. */
static bool is_relieved(cm1e_axis_t *axis)
{
    if (axis->homing_step.pushing && shows_motor(axis))
        axis->homing_step.pushing = !go_to_motor(axis, away_from_set_point(axis));
    return !axis->homing_step.pushing;
}

/* The set-point is at rest. The torque stays for a moment after the motor turned last: where a swinging load turns
 * round, it is slow too, but away from the set-point. A motor that something holds away from there rests all the same.
 * One that runs away is let go: its torque may be what drives it. */
static void wait_for_rest(cm1e_axis_t *axis)
{
    power_t *power = &axis->power;
    const double velocity = axis_actual_velocity(axis);
    const uint16_t now_ms = (uint16_t)(axis->now_ns / MS_IN_NS);
    const bool first = !power->held, seen_again = power->undecided > 0 && shows_motor(axis);
    if (first) {
        power->held_ms = now_ms;
        power->velocity = (float)fabs(velocity);
        power->turning = 0;
    }
    power->held = true;
    cm1e_axis_steps_init(axis);
    if (!axis->drive.feedback.fresh || swing_is_over(axis))
        return;
    const double slow = slow_velocity(axis);
    const double away = away_from_set_point(axis);
    /* The first cycle of a pause has the time of its inputs: the moment begins behind its end. */
    const bool unseen = seen_again && !first && !power->energized;
    if (runs_away(axis, away, velocity, slow))
        power->held_ms = (uint16_t)(now_ms - longest_swing_ms);
    else if (comes_back(axis, away, velocity)) /* else it would be pulled back as hard as it was braked, to and fro */
        power->turning = go_to_motor(axis, away) ? 0 : BACK;
    else if (fabs(velocity) > slow || unseen || ((first || seen_again) && is_far(axis, away)))
        power->brake_until_ns = later(power->brake_until_ns, axis->now_ns + brake_ns);
}

/* Whether a ramp has ended, its last set-point was sent, and the motor rests: its torque may go, or the axis is taken
 * over. */
static bool ramp_is_over(cm1e_axis_t *axis)
{
    if (!cm1e_drive_is_virtual(&axis->drive))
        wait_for_rest(axis);
    return axis->now_ns >= axis->power.brake_until_ns && cm1e_axis_backlash_at_rest(axis) &&
           (!axis->power.shutting_down || cm1e_axis_outputs_off_first(axis));
}

/* The motor has just got its torque. If it turns, the set-point goes with it and brakes, or stands if that cannot be.
 * Its velocity is known when two cycles in a row have shown it under torque, by numbers that agree. Behind a pause or a
 * silence the drive has braked it already, and a target that went to it now would drive it. */
static void brake_or_hold(cm1e_axis_t *axis)
{
    power_t *power = &axis->power;
    const bool rests = shows_rest(axis), known = shows_motor(axis) && axis->drive.actual.contradictions == 0;
    const bool unheard = paused(axis) || axis->silence.silent_before > CM1E_AXIS_RIDDEN_OUT_CYCLES;
    const bool never = unheard || cm1e_drive_contradicts_itself(&axis->drive) ||
                       power->undecided >= longest_undecided;
    if (rests || (known && power->velocity != 0.0f) ? !brakes_first(axis, coasting_velocity(axis)) : never)
        hold_motor(axis);
    power->undecided++;
}

/* A motor may still turn when it gets its torque: it coasts, or its load turns it. A set-point that stood would brake
 * it with all of its torque, and pull it back from where that ends. The axis is taken over when both rest. */
static void take_over_or_brake(cm1e_axis_t *axis)
{
    if (cm1e_drive_is_virtual(&axis->drive) || axis->power.energized) {
        if (is_relieved(axis))
            take_over(axis);
        return;
    }
    if (axis_free(axis))
        brake_or_hold(axis);
    if (!axis_holds(axis) || !(shows_motor(axis) || paused(axis)) || !ramp_is_over(axis) ||
        !(cm1e_axis_backlash_is_seen(axis) || swing_is_over(axis)))
        return;
    if (!axis->power.held || !swing_is_over(axis)) {
        take_over(axis);
        return;
    }
    cm1e_axis_fail(axis, CM1E_ERROR_AXIS_NOT_AT_REST, axis_actual_velocity(axis) / axis->position.scale, 0.0);
    cm1e_axis_become_free(axis);
}

bool cm1e_axis_catches(const cm1e_axis_t *axis)
{
    return axis->state == CM1E_AXIS_DISABLED && axis_holds(axis) && !axis->power.energized &&
           fabs(axis_actual_velocity(axis)) <= axis->power.velocity;
}

/* counts/s; the velocity that the drive shows, if the way since the cycle before says so too; 0: it is not known. Where
 * positions tell it, the first one behind a silence is the mean of all its cycles, and a frame that comes too early
 * shows it once more. */
static double velocity_of_cycle(const cm1e_axis_t *axis)
{
    static const double close_part = 0.8;
    const double shown = axis_actual_velocity(axis);
    const double by_way = way_of_cycle(axis) / axis->cycle_s;
    const bool agrees = shown * by_way > 0.0 && fabs(by_way) >= close_part * fabs(shown);
    return agrees && axis->silence.silent_before == 0 ? shown : 0.0;
}

bool cm1e_axis_swings(const cm1e_axis_t *axis) { return axis->power.held && axis_holds(axis); }

void cm1e_axis_power_step(cm1e_axis_t *axis)
{
    const bool acting = axis_acts(axis);
    const bool wanted = cm1e_axis_wants_enable(axis) && !axis->power.letting_go;
    const bool free = axis_free(axis), holds = axis_holds(axis), leaves = holds && !wanted;
    const bool enables = axis->state == CM1E_AXIS_DISABLED && wanted && acting && (free || holds);
    if (!holds || (wanted && axis->power.energized))
        axis->power.held = false;
    if (free)
        note_coasting(axis);
    if (enables)
        take_over_or_brake(axis);
    else if (leaves && ramp_is_over(axis))
        cm1e_axis_become_free(axis);
    else if (!free && !drive_moves(axis) && !acting)
        cm1e_axis_become_free(axis); /* the torque was lost during a ramp */
    if (axis_free(axis))
        axis->power.velocity = acting && shows_motor(axis) ? (float)velocity_of_cycle(axis) : 0.0f;
    const bool at_work = wanted && axis->power.energized;
    if (at_work || (axis_free(axis) ? !acting : !set_points_move(axis)))
        axis->power.undecided = !at_work && (!shows_motor(axis) || is_fast(axis));
}

void cm1e_axis_enable_step(cm1e_axis_t *axis)
{
    axis->power.letting_go &= axis->drive.feedback.enabled;
    axis->drive.command.enable = !axis_free(axis) || (cm1e_axis_wants_enable(axis) && !axis->power.letting_go);
    if (!axis->drive.command.enable && axis_free(axis)) {
        axis->power.energized = false;
        cm1e_axis_power_unsettle(axis);
    }
}

/* ---- reset ------------------------------------------------------------------------------------------------------- */

cm1e_error_t cm1e_axis_reset(cm1e_axis_t *axis)
{
    axis->power.reset_error = CM1E_OK;
    const bool waits = axis->state == CM1E_AXIS_DISABLED && cm1e_drive_waits(&axis->drive);
    if (axis->state != CM1E_AXIS_ERROR_STOP && !waits) {
        axis->power.reset_state = CM1E_COMMAND_DONE; /* there is nothing to reset */
    } else if (axis->power.reset_state != CM1E_COMMAND_ACTIVE) {
        axis->power.reset_state = CM1E_COMMAND_ACTIVE;
        axis->power.reset_sent = false;
    }
    return CM1E_OK;
}

cm1e_command_state_t cm1e_axis_reset_state(const cm1e_axis_t *axis, cm1e_error_t *error)
{
    if (error)
        *error = axis->power.reset_error;
    return axis->power.reset_state;
}

static void reset_finished(cm1e_axis_t *axis)
{
    const cm1e_error_t error = axis->drive.fault.error;
    axis->drive.command.reset = false;
    axis->power.reset_error = error;
    axis->power.reset_state = error != CM1E_OK ? CM1E_COMMAND_ERROR : CM1E_COMMAND_DONE;
    if (axis->state == CM1E_AXIS_ERROR_STOP) {
        axis->fault.error = error;
        axis->fault.device_error = axis->drive.fault.device_code;
    }
    if (error == CM1E_OK)
        cm1e_axis_go(axis, ON_RESET);
}

/* Resets the drive after the ramp of ErrorStop. This also brings back a slave that was offline. */
void cm1e_axis_reset_step(cm1e_axis_t *axis)
{
    if (!axis_free(axis))
        return;
    if (!axis->power.reset_sent) {
        axis->drive.command.reset = true;
        axis->power.reset_sent = true;
    } else if (!cm1e_drive_resetting(&axis->drive)) {
        reset_finished(axis);
    }
}

bool cm1e_axis_shut_down(cm1e_axis_t *axis)
{
    axis->power.shutting_down = true;
    cm1e_axis_power_unsettle(axis);
    power_off(axis);
    if (!axis_free(axis) || axis->drive.torque.asked ||
        (axis->motor_hooks && !axis->motor_hooks->released(axis)))
        return false;
    cm1e_axis_outputs_off(axis); /* not earlier: a brake on an output must not act on a moving load */
    const bool gone = axis->now_ns - axis->power.free_ns >= gone_after_ns;
    return !cm1e_drive_shows_torque(&axis->drive) || (gone && !axis->drive.feedback.online);
}
