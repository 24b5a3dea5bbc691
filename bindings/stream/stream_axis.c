#include "stream_axis.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* s; in this time the axis makes up for the distance between the control and itself when it took over. */
static const double take_over_s = 0.5;

void stream_axis_init(stream_axis_t *axis, AXIS_REF_t reference, double tolerance, double cycle_s,
                      uint32_t digital_outputs)
{
    memset(axis, 0, sizeof *axis);
    axis->reference = reference;
    axis->notice.tolerance = tolerance;
    axis->cycle_s = cycle_s;
    axis->digital_outputs = digital_outputs;
    axis->power.EnablePositive = axis->power.EnableNegative = TRUE;
}

static bool rises(bool now, bool *before)
{
    const bool edge = now && !*before;
    *before = now;
    return edge;
}

static void stop_for(stream_axis_t *axis, stream_reason_t reason, WORD error)
{
    axis->follow.Execute = axis->homing.Execute = FALSE;
    if (axis->notice.reason)
        return; /* the first one is told */
    axis->notice.reason = reason;
    axis->notice.error = error ? (cm1e_error_t)(CM1E_ERROR_ID_BASE - (int)error) : CM1E_OK;
    axis->notices++;
}

/* ---- faults ------------------------------------------------------------------------------------------------------ */

static void acknowledge(stream_axis_t *axis, const stream_wish_t *wish, const cm1e_axis_info_t *info)
{
    const bool enable = rises(wish->enable, &axis->enable_before), reset = rises(wish->reset, &axis->reset_before);
    if (enable || reset) {
        axis->notice.reason = STREAM_NO_REASON;
        axis->clear.Execute = info->state == CM1E_AXIS_ERROR_STOP;
        if (axis->clear.Execute)
            axis->homing.Execute = FALSE; /* the fault has ended it, even if it is of this cycle */
    }
    axis->clear.Axis = &axis->reference;
    MC_Reset(&axis->clear);
    if (axis->clear.Error)
        stop_for(axis, STREAM_NOT_RESET, axis->clear.ErrorID);
    if (axis->clear.Done || axis->clear.Error)
        axis->clear.Execute = FALSE;
}

static bool has_fault(const stream_axis_t *axis, const cm1e_axis_info_t *info)
{
    return axis->notice.reason || (info->state == CM1E_AXIS_ERROR_STOP && !axis->clear.Busy);
}

/* ---- homing by the drive ----------------------------------------------------------------------------------------- */

/* A fault ends it also while it waits for torque: after a reset nothing may move without a new edge. */
static bool ends_homing(stream_axis_t *axis, const stream_wish_t *wish, const cm1e_axis_info_t *info)
{
    const bool error = info->state == CM1E_AXIS_ERROR_STOP && !axis->clear.Busy; /* or asked for with the reset */
    if (error && !axis->homing.Busy) /* else MC_Home tells its error */
        stop_for(axis, STREAM_NOT_HOMED, 0);
    return error || axis->notice.reason || wish->enable || wish->stop || !wish->alive;
}

static void home(stream_axis_t *axis, const stream_wish_t *wish, const cm1e_axis_info_t *info)
{
    const bool edge = rises(wish->home, &axis->home_before);
    if (edge && !wish->enable && !wish->stop && !axis->homing.Execute && !has_fault(axis, info))
        axis->homing.Execute = TRUE;
    if (!axis->homing.Execute && !axis->homing.Busy)
        return;
    if (axis->homing.Execute && ends_homing(axis, wish, info))
        axis->homing.Execute = FALSE; /* its power goes off */
    if (info->state != CM1E_AXIS_STANDSTILL && !axis->homing.Busy)
        return; /* it waits for torque */
    axis->homing.Axis = &axis->reference;
    MC_Home(&axis->homing);
    if (axis->homing.Error)
        stop_for(axis, STREAM_NOT_HOMED, axis->homing.ErrorID);
    if (axis->homing.Done || axis->homing.CommandAborted || axis->homing.Error)
        axis->homing.Execute = FALSE;
}

/* ---- following --------------------------------------------------------------------------------------------------- */

/* The part of the offset that is left: a curve that begins and ends at rest and without acceleration. */
static double offset_now(const stream_axis_t *axis)
{
    const double s = fmin(axis->offset_s / take_over_s, 1.0);
    return axis->offset * (1.0 - s * s * s * (10.0 + s * (6.0 * s - 15.0)));
}

/* Begins to follow where the axis stands, if the control is near. It waits until the control stands too. */
static void take_over(stream_axis_t *axis, const stream_wish_t *wish, const cm1e_axis_info_t *info)
{
    if (!axis->power.Status || info->state != CM1E_AXIS_STANDSTILL || axis->notice.reason)
        return;
    const double offset = info->set_position - wish->position;
    if (!(fabs(offset) <= axis->notice.tolerance)) {
        axis->notice.asked = wish->position;
        axis->notice.found = info->set_position;
        stop_for(axis, STREAM_AWAY, 0);
        return;
    }
    axis->offset = offset;
    axis->offset_s = 0.0;
    axis->follow.Execute = wish->rests;
}

static void follow(stream_axis_t *axis, const stream_wish_t *wish, const cm1e_axis_info_t *info)
{
    if (!axis->follow.Execute && !axis->follow.Busy && wish->enable && wish->alive && !axis->homing.Execute)
        take_over(axis, wish, info);
    if (!wish->enable)
        axis->follow.Execute = FALSE;
    if (!axis->follow.Execute && !axis->follow.Busy && !axis->follow.Error)
        return;
    if (!wish->alive) { /* the block is not called any more, and the axis stops with that error */
        axis->follow = (CM_FollowPosition_t){0};
        stop_for(axis, STREAM_SILENT, 0);
        return;
    }
    axis->follow.Axis = &axis->reference;
    axis->follow.Position = wish->position + offset_now(axis);
    axis->offset_s += axis->cycle_s;
    CM_FollowPosition(&axis->follow);
    if (axis->follow.Error)
        stop_for(axis, STREAM_REFUSED, axis->follow.ErrorID);
    if (axis->follow.CommandAborted)
        axis->follow.Execute = FALSE;
}

/* ---- the cycle --------------------------------------------------------------------------------------------------- */

static void power(stream_axis_t *axis, const stream_wish_t *wish, const cm1e_axis_info_t *info)
{
    const bool error = info->state == CM1E_AXIS_ERROR_STOP;
    if (error && wish->enable && !axis->clear.Execute)
        stop_for(axis, STREAM_REFUSED, 0);
    axis->power.Axis = &axis->reference;
    axis->power.Enable = (wish->enable || axis->homing.Execute) && !axis->notice.reason && !error && wish->alive;
    MC_Power(&axis->power);
}

/* Writes an output when its value has changed. */
static void write_outputs(stream_axis_t *axis, uint32_t digital)
{
    for (uint32_t i = 0; i < axis->digital_outputs; i++) {
        MC_WriteDigitalOutput_t *write = &axis->outputs[i];
        const BOOL value = (digital >> i & 1) != 0;
        const MC_OUTPUT_REF output = {.Axis = axis->reference, .Number = (INT)(i + 1)};
        if (!write->Execute && value != write->Value) {
            write->Value = value;
            write->Execute = TRUE;
        }
        write->Output = &output;
        MC_WriteDigitalOutput(write);
        if (write->Done || write->Error)
            write->Execute = FALSE;
    }
}

static uint32_t flags_of(const stream_axis_t *axis, const cm1e_axis_info_t *info)
{
    return (axis->follow.Active ? STREAM_ENABLED : 0u) | (has_fault(axis, info) ? STREAM_FAULT : 0u) |
           (info->homed ? STREAM_HOMED : 0u) | (axis->homing.Execute ? STREAM_HOMING : 0u) |
           (info->powered ? STREAM_POWERED : 0u) | (info->online ? STREAM_ONLINE : 0u);
}

void stream_axis_step(stream_axis_t *axis, const stream_wish_t *wish, stream_axis_state_t *state)
{
    cm1e_axis_info_t info;
    if (cm1e_axis_read(axis->reference, &info) != CM1E_OK)
        return;
    acknowledge(axis, wish, &info);
    home(axis, wish, &info);
    follow(axis, wish, &info);
    power(axis, wish, &info);
    write_outputs(axis, wish->digital);
    *state = (stream_axis_state_t){
        .position = info.actual_position,
        .velocity = info.actual_velocity,
        .set_position = info.set_position,
        .lag = info.position_lag,
        .torque = info.torque_known ? info.actual_torque : 0.0,
        .flags = flags_of(axis, &info),
        .inputs = info.digital_known ? info.digital_inputs : 0,
        .error = (int32_t)info.error,
    };
}

void stream_notice_text(const stream_notice_t *notice, const char *name, char *text, size_t size)
{
    const char *why = notice->text[0] ? notice->text : cm1e_strerror(notice->error);
    switch (notice->reason) {
    case STREAM_AWAY:
        snprintf(text, size, "%s was not enabled: the control commands %.6g and the axis stands at %.6g. It "
                 "would jump. Up to %.6g between the two is right.", name, notice->asked, notice->found,
                 notice->tolerance);
        break;
    case STREAM_REFUSED: snprintf(text, size, "%s does not follow the control any more. %s", name, why); break;
    case STREAM_NOT_RESET: snprintf(text, size, "%s was not reset. %s", name, why); break;
    case STREAM_NOT_HOMED: snprintf(text, size, "%s was not homed. %s", name, why); break;
    case STREAM_SILENT:
        snprintf(text, size, "%s was stopped, because the control gave no position in time.", name);
        break;
    default: snprintf(text, size, "%s was not stopped.", name); break;
    }
}
