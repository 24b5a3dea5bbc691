/*
 * Motions by the drive itself (`motion: drive`): MC_MoveAbsolute, MC_MoveRelative and MC_MoveAdditive in profile
 * position mode (UG 6.2.2), MC_MoveVelocity in profile velocity mode (UG 6.2.3). The steps are those of a homing by the
 * drive: write the parameters while the axis holds its position in its own mode, switch the mode, move, and switch
 * back. So a motion begins and ends at standstill. MC_Halt and MC_Stop end it with the halt bit. That bit stays until
 * the mode is left, because clearing it would let the drive go on. Meanwhile the set-point of the axis is its actual
 * position.
 */
#include <math.h>
#include <stdlib.h>

#include "axis/axis_commands.h"
#include "axis/axis_device.h"
#include "axis/axis_driving.h"
#include "axis/axis_events.h"
#include "axis/axis_in_position.h"
#include "axis/axis_limits.h"
#include "axis/axis_plan.h"
#include "axis/axis_position.h"
#include "axis/axis_power.h"
#include "axis/axis_setpoint.h"
#include "axis/axis_text.h"
#include "core/bytes.h"
#include "core/clock.h"

static const int64_t parameter_timeout_ns = 5000 * MS_IN_NS;
static const int64_t acknowledge_timeout_ns = 500 * MS_IN_NS;
static const int64_t stale_ns = 10 * MS_IN_NS; /* "target reached" may so long be of the velocity before, which was 0 */
static const int64_t rest_ns = 10 * MS_IN_NS;
static const int32_t there_counts = 50;
/* Between the cycle that sees the motor and the drive that brakes it; s. */
static const double halt_latency_s = 0.005;

/* What is written before a motion, by mode. */
static const uint16_t parameters[2][DRIVE_PARAMETERS] = {
    [false] = {OBJ_6081_PROFILE_VELOCITY, OBJ_6083_PROFILE_ACCELERATION},
    [true] = {OBJ_6083_PROFILE_ACCELERATION, OBJ_6084_PROFILE_DECELERATION},
};

static cm1e_mode_t mode_of(const driving_t *d) { return d->velocity_mode ? CM1E_MODE_PV : CM1E_MODE_PP; }

/* ---- start ------------------------------------------------------------------------------------------------------- */

/* As the device keeps it, or false: out of its range. */
static bool parameter(const cm1e_axis_t *axis, uint16_t index, double counts, uint32_t *raw)
{
    const cm1e_entry_t *entry = cm1e_drive_entry(&axis->drive, index, 0);
    const int64_t rounded = cm1e_entry_round(entry, llround(counts));
    if (rounded < entry->minimum || rounded > entry->maximum)
        return false;
    const bool kilo = axis->config->acceleration_in_kpulses && index != OBJ_6081_PROFILE_VELOCITY;
    *raw = (uint32_t)(kilo ? rounded / 1000 : rounded);
    return true;
}

/* In the drive's 32 bits, without its wrap: it takes targets as absolute and would turn the other way round. */
static cm1e_error_t aim_position(const cm1e_axis_t *axis, const move_t *move, driving_t *d)
{
    const position_t target = move->target;
    const int64_t counts = target.counts + (target.fraction >= 0.5);
    const int64_t raw = axis->position.raw + counts - axis->position.actual_counts;
    const from_t from = from_set(axis);
    if (raw > INT32_MAX || raw < INT32_MIN || !cm1e_axis_limits_contain_target(axis, &from, target))
        return CM1E_ERROR_AXIS_POSITION_RANGE;
    d->target = (int32_t)raw;
    d->way = raw > axis->position.raw ? 1.0 : raw < axis->position.raw ? -1.0 : 0.0;
    if (axis->position.scale < 0.0)
        d->way = -d->way;
    return CM1E_OK;
}

static cm1e_error_t aim_velocity(const cm1e_axis_t *axis, const from_t *from, const move_t *move, driving_t *d)
{
    double velocity;
    const cm1e_error_t error = cm1e_axis_signed_velocity(axis, from, move, &velocity);
    const double now = cm1e_axis_units(axis, axis->setpoint.position);
    if (error != CM1E_OK)
        return error;
    if (velocity > 0.0 ? now >= axis->limits.upper : now <= axis->limits.lower)
        return CM1E_ERROR_AXIS_POSITION_RANGE;
    d->target_velocity = (int32_t)round(velocity * axis->position.scale);
    d->way = velocity > 0.0 ? 1.0 : -1.0;
    return CM1E_OK;
}

/* ns; no less than the profile takes with the values that the drive keeps. Its way may be too short for its speed. */
static int64_t profile_time(const cm1e_axis_t *axis, const driving_t *d)
{
    const double way = (double)llabs((int64_t)d->target - axis->position.raw), speed = d->raw[0];
    const double acceleration = d->raw[1] * (axis->config->acceleration_in_kpulses ? 1000.0 : 1.0);
    return (int64_t)(1e9 * fmin(way / speed + speed / acceleration, 1e9));
}

cm1e_error_t cm1e_axis_drive_prepare(cm1e_axis_t *axis, const from_t *from, move_t *move, driving_t *d)
{
    cm1e_motion_limits_t limits;
    *d = (driving_t){.velocity_mode = move->kind == CM1E_COMMAND_MOVE_VELOCITY};
    if (move->jerk != 0.0)
        return CM1E_ERROR_UNSUPPORTED;
    if (!d->velocity_mode && move->deceleration != 0.0 && move->deceleration != move->acceleration)
        return CM1E_ERROR_UNSUPPORTED; /* UG 6.2.2: the deceleration is the acceleration */
    cm1e_error_t error = cm1e_axis_limits_of(axis, from, move, &limits);
    if (error == CM1E_OK)
        error = cm1e_axis_resolve(axis, from, move);
    if (error == CM1E_OK)
        error = d->velocity_mode ? aim_velocity(axis, from, move, d) : aim_position(axis, move, d);
    if (error != CM1E_OK)
        return error;
    if (!cm1e_axis_direction_enabled(axis, d->way))
        return CM1E_ERROR_AXIS_DIRECTION_DISABLED;
    const double scale = fabs(axis->position.scale), acceleration = limits.acceleration * scale;
    const double braking = fmin(limits.deceleration * scale, d->velocity_mode ? INFINITY : acceleration);
    if (axis->set_aside.driving->submitted && cm1e_sdo_state(&axis->set_aside.driving->sdo) == CM1E_SDO_BUSY)
        return CM1E_ERROR_BUSY; /* of a motion that was stopped */
    d->speed = limits.velocity * scale;
    if (llround(d->speed) < 1)
        return CM1E_ERROR_AXIS_VELOCITY_RANGE; /* to the drive it is 0, with which no motion ends */
    d->acceleration = acceleration;
    d->braking = braking;
    const double values[2][DRIVE_PARAMETERS] = {{d->speed, braking}, {acceleration, braking}};
    for (int i = 0; i < DRIVE_PARAMETERS; i++)
        if (!parameter(axis, parameters[d->velocity_mode][i], values[d->velocity_mode][i], &d->raw[i]))
            return CM1E_ERROR_AXIS_DYNAMICS_RANGE;
    d->profile_ns = d->velocity_mode ? 0 : profile_time(axis, d);
    return CM1E_OK;
}

cm1e_error_t cm1e_axis_drive_profile_init(cm1e_axis_t *axis, cm1e_diag_t *diag)
{
    if (!drive_profiles(axis))
        return CM1E_OK;
    axis->set_aside.driving = calloc(1, sizeof *axis->set_aside.driving);
    return axis->set_aside.driving ? CM1E_OK : cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "No memory for the motions "
                                                             "of the drive of axis \"%s\".", axis->config->name);
}

static void enter(cm1e_axis_t *axis, drive_step_t step)
{
    axis->set_aside.driving->step = step;
    axis->set_aside.driving->step_ns = axis->set_aside.driving->due_ns = axis->now_ns;
    axis->set_aside.driving->nearest = INT64_MAX;
    cm1e_axis_watch_standstill(axis, &axis->set_aside.driving->standstill);
}

void cm1e_axis_drive_begin(cm1e_axis_t *axis, const driving_t *d)
{
    *axis->set_aside.driving = *d;
    cm1e_axis_set_reached(axis, false);
    cm1e_axis_set_source(axis, &cm1e_source_drive);
    enter(axis, DRIVE_WRITE);
}

/* The motion is over, in the axis's own mode. */
static void leave(cm1e_axis_t *axis)
{
    cm1e_axis_set_source(axis, &cm1e_source_hold);
    if (cm1e_axis_settle(axis))
        return;
    if (axis->commands.active)
        cm1e_axis_command_end(axis, CM1E_COMMAND_DONE, CM1E_OK); /* of the move, or of what ended it */
    cm1e_axis_go(axis, ON_AT_REST);
}

/* To the axis's own mode, which takes the target that it finds: so that is the set-point, a cycle before. */
static void back(cm1e_axis_t *axis) { enter(axis, DRIVE_RETURN); }

/* Without torque there is nothing to stop and no mode to wait for. */
static bool off(cm1e_axis_t *axis)
{
    if (axis->set_aside.driving->goal != HOME_GOAL_OFF)
        return false;
    axis->drive.command.halt = false;
    axis->drive.command.mode = axis->mode;
    cm1e_axis_let_go(axis);
    return true;
}

/* ---- the steps --------------------------------------------------------------------------------------------------- */

/* Nothing has moved: no reason for ErrorStop. */
static void refuse(cm1e_axis_t *axis, cm1e_error_t error)
{
    const driving_t *d = axis->set_aside.driving;
    const int number = cm1e_axis_number_of_object(d->sdo.index, d->sdo.subindex);
    cm1e_axis_command_end(axis, CM1E_COMMAND_ERROR, error);
    cm1e_axis_remember_not_set(axis, (not_set_t){.error = error, .number = number, .value = d->raw[d->next],
                                                 .abort_code = d->sdo.abort_code});
    leave(axis);
}

static void submit(cm1e_axis_t *axis)
{
    driving_t *d = axis->set_aside.driving;
    const uint16_t index = parameters[d->velocity_mode][d->next];
    cm1e_put_uint(d->data, sizeof d->data, d->raw[d->next]);
    d->sdo = (cm1e_sdo_t){.position = axis->drive.position, .index = index, .write = true, .data = d->data,
                          .size = sizeof d->data};
    const cm1e_error_t error = cm1e_sdo_submit(axis->drive.bus, &d->sdo);
    if (error == CM1E_OK)
        d->submitted = true;
    else if (error != CM1E_ERROR_FULL) /* full: again in the next cycle */
        refuse(axis, error);
}

static void step_write(cm1e_axis_t *axis)
{
    driving_t *d = axis->set_aside.driving;
    if (d->goal != HOME_GOAL_DONE) {
        leave(axis); /* a transfer under way ends by itself */
        return;
    }
    if (d->submitted) {
        const cm1e_sdo_state_t state = cm1e_sdo_state(&d->sdo);
        if (state == CM1E_SDO_ERROR) {
            d->submitted = false;
            refuse(axis, d->sdo.error);
            return;
        }
        if (state == CM1E_SDO_DONE) {
            d->submitted = false;
            d->next++;
        } else if (axis->now_ns - d->step_ns >= parameter_timeout_ns) {
            refuse(axis, CM1E_ERROR_TIMEOUT); /* the transfer ends by itself */
            return;
        }
    }
    while (d->next < DRIVE_PARAMETERS &&
           cm1e_drive_carry(&axis->drive, parameters[d->velocity_mode][d->next], d->raw[d->next]))
        d->next++;
    if (d->next < DRIVE_PARAMETERS) {
        if (!d->submitted)
            submit(axis);
        return;
    }
    if (!d->velocity_mode && d->target == axis->position.raw) {
        leave(axis); /* it is there, and no set-point would be acknowledged */
        return;
    }
    axis->drive.command.halt = false;
    axis->drive.command.mode = mode_of(d);
    enter(axis, DRIVE_SWITCH);
}

static void step_switch(cm1e_axis_t *axis)
{
    const driving_t *d = axis->set_aside.driving;
    cm1e_axis_set_to_actual(axis);
    if (!cm1e_axis_acts_in(axis, mode_of(d))) /* the drive's mode timeout bounds this */
        return;
    if (d->goal == HOME_GOAL_DONE)
        enter(axis, d->velocity_mode ? DRIVE_MOVE : DRIVE_GO);
    else
        back(axis);
}

static bool there(const cm1e_axis_t *axis)
{
    return llabs((int64_t)axis->position.raw - axis->set_aside.driving->target) <= there_counts;
}

/* Whether the motor is at its target and rests. A drive may say too early that it has reached it; then the switch to
 * the mode of the axis would stop a motor that turns. */
static bool rests_there(cm1e_axis_t *axis)
{
    standstill_t *standstill = &axis->set_aside.driving->standstill;
    (void)cm1e_axis_is_at_standstill(axis, standstill); /* keeps since when */
    return there(axis) && cm1e_axis_stood(axis, standstill) >= rest_ns;
}

static void arrived(cm1e_axis_t *axis)
{
    cm1e_axis_put_position(axis, axis->commands.move.target);
    back(axis);
}

/* UG 6.2.2, the handshake: bit 4 announces the set-point, bit 12 acknowledges it (cm1e_drive_write()). */
static void step_go(cm1e_axis_t *axis)
{
    const driving_t *d = axis->set_aside.driving;
    const bool rests = rests_there(axis);
    cm1e_axis_set_to_actual(axis);
    if (axis->drive.feedback.bit12 && axis->drive.target.set_point == d->target)
        enter(axis, DRIVE_MOVE);
    else if (axis->now_ns - d->step_ns < acknowledge_timeout_ns)
        return;
    else if (rests)
        arrived(axis);
    else
        cm1e_axis_fail(axis, CM1E_ERROR_TIMEOUT, 0.0, 0.0);
}

/* u/s; when a halt that is given now begins. The drive accelerates until then. */
static double velocity_at_halt(const cm1e_axis_t *axis)
{
    const driving_t *d = axis->set_aside.driving;
    const double v = axis->drive.feedback.velocity, most = d->target_velocity;
    const double later = fmin(fabs(most), fabs(v) + d->acceleration * halt_latency_s);
    return (v * most < 0.0 ? v : copysign(fmax(fabs(v), later), most)) / axis->position.scale;
}

/* Whether the halt, given now, would end inside the software limits. */
static bool can_halt(const cm1e_axis_t *axis)
{
    if (!axis->limits.software_limits)
        return true;
    const double v = velocity_at_halt(axis);
    const double now = cm1e_axis_units(axis, axis->setpoint.position);
    const double way = v * fabs(v) * fabs(axis->position.scale) / (2.0 * axis->set_aside.driving->braking);
    const double end = now + v * halt_latency_s + way;
    return v > 0.0 ? end <= axis->limits.upper : v < 0.0 ? end >= axis->limits.lower : true;
}

/* Whether the motor has come no nearer to its target for too long: it stands elsewhere, turns around the target, or
 * rests there and the drive does not say so. A drive may be slower than its profile. */
static bool is_overdue(cm1e_axis_t *axis)
{
    driving_t *d = axis->set_aside.driving;
    const int64_t away = llabs((int64_t)axis->position.raw - d->target);
    if (away < d->nearest || axis->now_ns < d->step_ns + d->profile_ns)
        d->due_ns = axis->now_ns;
    d->nearest = away < d->nearest ? away : d->nearest;
    return axis->now_ns - d->due_ns >= axis->in_position.timeout_us * INT64_C(1000);
}

static void step_move(cm1e_axis_t *axis)
{
    const cm1e_drive_feedback_t *f = &axis->drive.feedback;
    const driving_t *d = axis->set_aside.driving;
    const bool rests = !d->velocity_mode && rests_there(axis);
    cm1e_axis_set_to_actual(axis);
    if (!f->online)
        return;
    if (d->velocity_mode) {
        cm1e_axis_set_reached(axis, f->target_reached && axis->now_ns - d->step_ns >= stale_ns);
        if (!can_halt(axis))
            cm1e_axis_fail(axis, CM1E_ERROR_AXIS_POSITION_RANGE, cm1e_axis_units(axis, axis->setpoint.position),
                           f->velocity / axis->position.scale > 0.0 ? axis->limits.upper : axis->limits.lower);
    } else if (f->bit13) {
        cm1e_axis_fail(axis, CM1E_ERROR_AXIS_LAG, ((double)d->target - axis->position.raw) / axis->position.scale, 0.0);
    } else if (f->target_reached && rests) {
        arrived(axis);
    } else if (is_overdue(axis)) {
        cm1e_axis_in_position_fail(axis, ((double)axis->position.raw - d->target) / axis->position.scale);
    }
}

static void step_halt(cm1e_axis_t *axis)
{
    driving_t *d = axis->set_aside.driving;
    cm1e_axis_set_to_actual(axis);
    const bool at_rest = cm1e_axis_is_at_standstill(axis, &d->standstill);
    const bool expired = axis->now_ns - d->step_ns >= cm1e_axis_halt_bound_ns(axis, d->speed / d->braking, true);
    if (!expired && !at_rest)
        return;
    if (off(axis))
        return;
    if (expired)
        cm1e_axis_fail(axis, CM1E_ERROR_TIMEOUT, 0.0, 0.0);
    else
        back(axis);
}

static void step_return(cm1e_axis_t *axis)
{
    axis->drive.command.mode = axis->mode;
    if (!cm1e_axis_acts_in(axis, axis->mode))
        return;
    axis->drive.command.halt = false;
    leave(axis);
}

static bool step(cm1e_axis_t *axis)
{
    static void (*const steps[])(cm1e_axis_t *) = {
        [DRIVE_WRITE] = step_write, [DRIVE_SWITCH] = step_switch, [DRIVE_GO] = step_go,
        [DRIVE_MOVE] = step_move, [DRIVE_HALT] = step_halt, [DRIVE_RETURN] = step_return,
    };
    if (cm1e_axis_has_lost_torque(axis, axis->set_aside.driving->goal)) {
        (void)off(axis);
        return true;
    }
    steps[axis->set_aside.driving->step](axis);
    return true;
}

static void stop(cm1e_axis_t *axis, const cm1e_motion_limits_t *ramp, home_goal_t goal)
{
    (void)ramp; /* the drive has its own */
    axis->set_aside.driving->goal = goal;
    switch (axis->set_aside.driving->step) {
    case DRIVE_WRITE: /* still in the axis's own mode, holding */
    case DRIVE_SWITCH:
    case DRIVE_RETURN: /* standing; HOLD has to wait for the mode that is under way */
        (void)off(axis);
        break;
    case DRIVE_GO:
    case DRIVE_MOVE:
        axis->drive.command.halt = true;
        enter(axis, DRIVE_HALT);
        break;
    case DRIVE_HALT:
        break;
    }
}

static bool goes(cm1e_axis_t *axis, double sign)
{
    return axis->set_aside.driving->goal == HOME_GOAL_DONE && axis->set_aside.driving->way * sign > 0.0;
}

/* What the motor is to do while it moves by itself; in the other steps the axis's own targets hold. */
static void write(cm1e_axis_t *axis)
{
    const driving_t *d = axis->set_aside.driving;
    const bool under_way = d->step == DRIVE_GO || d->step == DRIVE_MOVE || d->step == DRIVE_HALT;
    if (under_way && !d->velocity_mode)
        axis->drive.command.target_position = d->target;
    axis->drive.command.target_velocity = under_way && d->velocity_mode ? d->target_velocity : 0;
}

const source_t cm1e_source_drive = {
    .step = step,
    .stop = stop,
    .goes = goes,
    .keeps = cm1e_axis_unknown_way_keeps,
    .write = write,
    .by_drive = true,
};
