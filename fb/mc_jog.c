#include <math.h>

#include "axis/axis_signals.h"
#include "edge.h"
#include "lease.h"

/* TwinCAT's MC_Jog, made of commands of the axis. A jog begins with the rising edge of one button while the other one
 * is not pressed. In the modes with a held button it is a move to the software limit, which ends there without an
 * error, or a motion at a velocity if there is no limit. It ends when the button is released or the other one is
 * pressed too; the axis ends it when this block is no longer called. Inching moves one step, independent of the
 * button. */

typedef struct jog {
    double velocity, acceleration, deceleration, jerk;
    bool held;
} jog_t;

static cm1e_error_t choose(const MC_Jog_t *fb, cm1e_axis_t *axis, const cm1e_axis_measures_t *measures, jog_t *jog)
{
    *jog = (jog_t){.velocity = fb->Velocity, .acceleration = fb->Acceleration, .deceleration = fb->Deceleration,
                   .jerk = fb->Jerk};
    const bool standard = fb->Mode == MC_JOGMODE_STANDARD_SLOW || fb->Mode == MC_JOGMODE_STANDARD_FAST;
    if (!standard && !(fb->Velocity > 0.0)) /* the axis would take a negative velocity as the other direction */
        return cm1e_axis_refuse_input(axis, CM1E_ERROR_AXIS_VELOCITY_RANGE, "MC_Jog: Velocity", fb->Velocity,
                                      "a velocity above 0");
    switch ((int)fb->Mode) {
    case MC_JOGMODE_STANDARD_SLOW:
    case MC_JOGMODE_STANDARD_FAST:
        *jog = (jog_t){.held = true, .velocity = fb->Mode == MC_JOGMODE_STANDARD_SLOW ? measures->jog_slow
                                                                                      : measures->jog_fast};
        return CM1E_OK;
    case MC_JOGMODE_CONTINOUS:
        jog->held = true;
        return CM1E_OK;
    case MC_JOGMODE_INCHING:
    case MC_JOGMODE_INCHING_MODULO:
        return isfinite(fb->Position) && fb->Position > 0.0
                   ? CM1E_OK : cm1e_axis_refuse_input(axis, CM1E_ERROR_AXIS_POSITION_RANGE, "MC_Jog: Position",
                                                      fb->Position, "a step above 0");
    default:
        return cm1e_axis_refuse_input(axis, CM1E_ERROR_INVALID_ARGUMENT, "MC_Jog: Mode", (int)fb->Mode, "0 ... 4");
    }
}

/** Target of one step from `position` in the direction of `sign`. INCHING_MODULO goes to the next multiple; within a
 *  thousandth of a multiple the axis counts as being there. */
static double step(const MC_Jog_t *fb, double position, double sign)
{
    if (fb->Mode == MC_JOGMODE_INCHING)
        return sign * fb->Position;
    const double steps = sign * position / fb->Position;
    return sign * ((floor(steps + 0.001) + 1.0) * fb->Position) - position;
}

/** The command for the axis. `distance` is the step (not used while a button is held), `room` the distance to the limit
 *  ahead; infinite if there is none. */
static cm1e_axis_command_t command_of(const MC_Jog_t *fb, const jog_t *jog, double limit, double room, double distance)
{
    cm1e_axis_command_t command = {.velocity = jog->velocity, .acceleration = jog->acceleration,
                                   .deceleration = jog->deceleration, .jerk = jog->jerk};
    if (!jog->held && distance < room) {
        command.kind = CM1E_COMMAND_MOVE_RELATIVE;
        command.position = fb->Private.backwards ? -distance : distance;
    } else if (isfinite(room)) {
        command.kind = CM1E_COMMAND_MOVE_ABSOLUTE;
        command.position = limit;
    } else {
        command.kind = CM1E_COMMAND_MOVE_VELOCITY;
        command.direction = fb->Private.backwards ? mcNegativeDirection : mcPositiveDirection;
    }
    return command;
}

static cm1e_error_t start(MC_Jog_t *fb, cm1e_axis_t *axis)
{
    const cm1e_axis_measures_t measures = cm1e_axis_measures(axis);
    cm1e_axis_info_t info;
    jog_t jog;
    const cm1e_error_t error = choose(fb, axis, &measures, &jog);
    fb->Private.common.command = 0;
    fb->Private.stopping = FALSE;
    if (error != CM1E_OK)
        return error;
    cm1e_axis_get(axis, &info);
    const double sign = fb->Private.backwards ? -1.0 : 1.0;
    const double limit = fb->Private.backwards ? measures.lower : measures.upper;
    const double room = sign * (limit - info.set_position);
    const double distance = jog.held ? 0.0 : sign * step(fb, info.set_position, sign);
    if (!jog.held && !(distance > 0.0 && isfinite(distance))) /* the multiple equals the present position within the
                                                               * precision of numbers */
        return cm1e_axis_refuse_input(axis, CM1E_ERROR_AXIS_POSITION_RANGE, "MC_Jog: Position", fb->Position,
                                      "a step that changes the present position");
    fb->Private.held = jog.held;
    fb->Private.deceleration = jog.deceleration;
    fb->Private.jerk = jog.jerk;
    /* At the limit: the present motion ends there in any case, and a disabled direction is reported. */
    const cm1e_axis_command_t command = room > measures.resolution ? command_of(fb, &jog, limit, room, distance)
                                                                   : (cm1e_axis_command_t){.kind = CM1E_COMMAND_HALT};
    return cm1e_axis_start(axis, &command, &fb->Private.common.command);
}

static void stop(MC_Jog_t *fb, cm1e_axis_t *axis)
{
    cm1e_axis_command_t halt = {.kind = CM1E_COMMAND_HALT, .deceleration = fb->Private.deceleration,
                                .jerk = fb->Private.jerk};
    cm1e_axis_keep(axis, 0, 0, 0.0, 0.0);
    fb->Private.stopping = TRUE;
    const cm1e_error_t error = cm1e_axis_start(axis, &halt, &fb->Private.common.command);
    if (error != CM1E_OK)
        cm1e_fb_fail(&fb->Private.common, error);
}

/* The axis stands at the limit, and the button is still pressed. Somebody else may move the axis away or take its
 * torque now, and it may fail: that ends the jog, although its own motion has ended before. */
static void wait_at_limit(MC_Jog_t *fb, cm1e_axis_t *axis)
{
    cm1e_axis_info_t info;
    cm1e_axis_get(axis, &info);
    if (info.state == CM1E_AXIS_ERROR_STOP)
        cm1e_fb_polled(&fb->Private.common, CM1E_COMMAND_ERROR, CM1E_ERROR_AXIS_ERROR_STOP);
    else if (info.state != CM1E_AXIS_STANDSTILL)
        cm1e_fb_polled(&fb->Private.common, CM1E_COMMAND_ABORTED, CM1E_OK);
}

static void poll(MC_Jog_t *fb, cm1e_axis_t *axis)
{
    cm1e_jog_private_t *p = &fb->Private;
    const cm1e_command_status_t status = cm1e_axis_command_status(axis, p->common.command);
    const BOOL button = p->backwards ? fb->JogBackwards : fb->JogForward;
    const bool both = fb->JogForward && fb->JogBackwards, released = p->held && !button;
    const bool at_limit = status.state == CM1E_COMMAND_DONE && p->held && !p->stopping;
    if (at_limit && button && !both)
        wait_at_limit(fb, axis);
    else if (status.state == CM1E_COMMAND_ACTIVE && !p->stopping && (both || released))
        stop(fb, axis);
    else
        cm1e_fb_polled(&p->common, status.state, status.error);
}

static void keep(MC_Jog_t *fb, cm1e_axis_t *axis, TIME called)
{
    cm1e_jog_private_t *p = &fb->Private;
    if (p->common.state == FB_BUSY && p->held && !p->stopping)
        cm1e_axis_keep(axis, p->common.command, fb_lease_ns(p->called, called), p->deceleration, p->jerk);
}

/** A rising edge of one button while the other one is not pressed. */
static bool begins(MC_Jog_t *fb)
{
    cm1e_jog_private_t *p = &fb->Private;
    const bool forward = fb->JogForward && !p->forward_before && !fb->JogBackwards;
    const bool backwards = fb->JogBackwards && !p->backwards_before && !fb->JogForward;
    p->forward_before = fb->JogForward != FALSE;
    p->backwards_before = fb->JogBackwards != FALSE;
    if (forward || backwards)
        p->backwards = backwards;
    return forward || backwards;
}

void MC_Jog(MC_Jog_t *fb)
{
    cm1e_jog_private_t *p = &fb->Private;
    const BOOL pressed = fb->JogForward || fb->JogBackwards;
    const TIME called = p->called;
    cm1e_axis_t *axis = NULL;
    p->common.trigger_before = pressed && !begins(fb); /* the edge, as cm1e_fb_execute() sees it */
    if (!pressed)
        p->forward_before = p->backwards_before = FALSE;
    const fb_step_t todo = cm1e_fb_execute(&p->common, fb->Axis, pressed, &axis);
    if (todo != FB_STEP_NONE)
        p->called = cm1e_axis_time(axis);
    if (todo == FB_STEP_START)
        cm1e_fb_started(&p->common, start(fb, axis));
    else if (todo == FB_STEP_POLL)
        poll(fb, axis);
    if (todo != FB_STEP_NONE)
        keep(fb, axis, called);
    const fb_outputs_t out = cm1e_fb_outputs(&p->common);
    fb->Done = out.done;
    fb->Busy = out.busy;
    fb->Active = out.busy && cm1e_axis_command_status(axis, p->common.command).state == CM1E_COMMAND_ACTIVE;
    fb->CommandAborted = out.aborted;
    fb->Error = out.error;
    fb->ErrorID = out.error_id;
}
