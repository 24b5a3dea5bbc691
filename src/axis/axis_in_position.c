/*
 * In position: the set-point is at rest, and the motor has been within a window around it for some time. CiA 402 has
 * objects for that, 0x6067 and 0x6068. Neither the CM1-E nor the bridge has them, so the axis does it itself.
 *
 * PLCopen leaves open whether Done of a move means its set-point or its motor. By default it means the set-point. With
 * in_position.done_waits a command that ends at a position stays active until the motor is there. The axis keeps torque
 * and set-point meanwhile, and it is an error if the motor is not there in time. A buffered command does not wait for
 * the motor: it begins when the set-point arrives, and then the command before it is Done.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "axis/axis_in_position.h"
#include "axis/axis_backlash.h"
#include "axis/axis_commands.h"
#include "axis/axis_events.h"
#include "axis/axis_position.h"
#include "axis/axis_setpoint.h"

/* Counts of a CM1-E: 0.02 % of a revolution. A servo in good order stays within it at rest. */
static const double default_window_counts = 10.0;
/* Before V1.3.3, a mapping without target position has the velocity in counts/ms. Then the position loop of the axis
 * (20/s) rounds the correction of less than 25 counts to 0. */
static const double coarse_window_counts = 30.0;

/* % of rated torque: with more, a motor at rest pushes against something. */
static const float pushing_torque = 80.0f;

/* A time in us; 3600 s are less than 2^32 us. */
static uint32_t in_us(double seconds, double otherwise)
{
    return (uint32_t)lround(fmin(seconds > 0.0 ? seconds : otherwise, 4000.0) * 1e6);
}

void cm1e_axis_in_position_init(cm1e_axis_t *axis)
{
    const cm1e_axis_config_t *c = axis->config;
    in_position_t *p = &axis->in_position;
    const bool coarse = axis->mode == CM1E_MODE_CSV && axis->drive.range.velocity_unit > 1;
    const double window = cm1e_axis_tolerance_counts(axis, coarse ? coarse_window_counts : default_window_counts);
    p->window = c->in_position_window > 0.0 ? c->in_position_window : window / fabs(axis->position.scale);
    p->time_us = in_us(c->in_position_time_s, CM1E_IN_POSITION_TIME_S);
    p->timeout_us = in_us(c->in_position_timeout_s, CM1E_IN_POSITION_TIMEOUT_S);
    p->done_waits = c->in_position_done_waits;
}

/* u; position of the motor minus its set-point. */
static double deviation(const cm1e_axis_t *axis)
{
    return cm1e_position_minus(axis_actual(axis), axis->setpoint.position) / axis->position.scale;
}

bool cm1e_axis_in_position(const cm1e_axis_t *axis)
{
    const in_position_t *p = &axis->in_position;
    return axis_holds(axis) && p->inside && p->there;
}

static bool passed(const cm1e_axis_t *axis, int64_t since_ns, uint32_t time_us)
{
    return axis->now_ns - since_ns >= (int64_t)time_us * 1000;
}

/* ---- Done waits for it ------------------------------------------------------------------------------------------- */

static bool ends_at_position(cm1e_command_kind_t kind)
{
    const command_plan_t plan = kind_row(kind)->plan;
    return plan == PLAN_TO_TARGET || plan == PLAN_HOMING;
}

bool cm1e_axis_settle(cm1e_axis_t *axis)
{
    in_position_t *p = &axis->in_position;
    if (!p->done_waits || !axis->commands.active || !ends_at_position(axis->commands.kind) ||
        axis->commands.waiting.count > 0 || axis->superimposed.id || cm1e_drive_is_virtual(&axis->drive))
        return false;
    p->settling = axis->commands.active;
    p->arrived_ns = axis->now_ns;
    p->torque = NAN;
    return true;
}

void cm1e_axis_settled(cm1e_axis_t *axis)
{
    if (!axis_settling(axis))
        return;
    cm1e_axis_command_end(axis, CM1E_COMMAND_DONE, CM1E_OK);
    cm1e_axis_go(axis, ON_DONE);
}

/* % of rated torque; NAN: unknown. */
static float torque_of(const cm1e_axis_t *axis)
{
    return axis->drive.image.in_torque.bytes > 0 ? 0.1f * (float)abs(axis->drive.feedback.torque) : NAN;
}

/* Remembers the numbers for the text, because a motor without torque may move away. */
static void remember(cm1e_axis_t *axis, double missed_by)
{
    in_position_t *p = &axis->in_position;
    p->missed_actual = cm1e_axis_units(axis, axis_actual(axis));
    p->missed_by = missed_by;
}

void cm1e_axis_in_position_ended(cm1e_axis_t *axis, bool by_error)
{
    axis->in_position.missed = by_error && axis_settling(axis);
    if (axis->in_position.missed)
        remember(axis, deviation(axis));
}

void cm1e_axis_in_position_fail(cm1e_axis_t *axis, double missed_by)
{
    axis->in_position.torque = torque_of(axis);
    remember(axis, missed_by);
    cm1e_axis_command_end(axis, CM1E_COMMAND_ERROR, CM1E_ERROR_AXIS_NOT_IN_POSITION);
    cm1e_axis_fail(axis, CM1E_ERROR_AXIS_NOT_IN_POSITION, missed_by, axis->in_position.window);
}

void cm1e_axis_in_position_step(cm1e_axis_t *axis)
{
    in_position_t *p = &axis->in_position;
    if (!axis->drive.feedback.fresh)
        return;
    const double counts = cm1e_position_minus(axis_actual(axis), axis->setpoint.position);
    const bool inside = fabs(counts) <= fabs(p->window * axis->position.scale) && cm1e_axis_backlash_at_rest(axis);
    if (inside && !p->inside)
        p->inside_ns = axis->now_ns;
    p->inside = inside;
    p->there = inside && passed(axis, p->inside_ns, p->time_us);
    if (!axis_settling(axis))
        return;
    p->torque = torque_of(axis);
    if (axis->commands.waiting.count > 0 || p->there || !p->done_waits)
        cm1e_axis_settled(axis);
    else if (passed(axis, p->arrived_ns, p->timeout_us))
        cm1e_axis_in_position_fail(axis, deviation(axis));
}

/* ---- in words ---------------------------------------------------------------------------------------------------- */

static const char *probable_cause(bool inside, float torque)
{
    if (inside)
        return "It was there, but did not rest, or the drive did not say that its target is reached: check the drive's "
               "own window and time (0x6067, 0x6068)";
    if (isnan(torque))
        return "Look for a mechanical stop or an obstacle, a load or a friction that is too large for the motor, and a "
               "torque limit in the drive";
    return torque >= pushing_torque
               ? "The motor pushes: look for a mechanical stop, an obstacle or a load that is too heavy"
               : "The motor does not push: look for a torque limit in the drive and for friction, and check whether "
                 "the window and the time suit this axis";
}

static void where(const cm1e_axis_t *axis, char *text, size_t size)
{
    const in_position_t *p = &axis->in_position;
    const double turn = axis->position.modulo_range, line = p->missed_actual - p->missed_by;
    const double set = turn > 0.0 ? line - turn * floor(line / turn) : line;
    char torque[48] = "";
    if (!isnan(p->torque))
        snprintf(torque, sizeof torque, ", with %.0f %% of its rated torque", (double)p->torque);
    snprintf(text, size, "Its set-point stood at %.6g u, the motor was at %.6g u, %.6g u %s it%s; in_position.window "
             "is %.6g u. %s", set, p->missed_actual, fabs(p->missed_by), p->missed_by < 0.0 ? "below" : "above", torque,
             p->window, probable_cause(fabs(p->missed_by) <= p->window, p->torque));
}

void cm1e_axis_in_position_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    char place[400];
    where(axis, place, sizeof place);
    snprintf(text, size, "Axis \"%s\": %s, which is %.6g s. %s; then reset the axis with MC_Reset.", axis->config->name,
             cm1e_strerror(axis->fault.error), axis->in_position.timeout_us * 1e-6, place);
}

void cm1e_axis_in_position_add(const cm1e_axis_t *axis, char *text, size_t size)
{
    const size_t used = strlen(text);
    char place[400];
    if (!axis->in_position.missed || used >= size)
        return;
    where(axis, place, sizeof place);
    snprintf(text + used, size - used, " %s.", place);
}
