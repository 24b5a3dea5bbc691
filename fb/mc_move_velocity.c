#include "edge.h"

void MC_MoveVelocity(MC_MoveVelocity_t *fb)
{
    const cm1e_axis_command_t command = {
        .kind = CM1E_COMMAND_MOVE_VELOCITY,
        .velocity = fb->Velocity,
        .acceleration = fb->Acceleration,
        .deceleration = fb->Deceleration,
        .jerk = fb->Jerk,
        .direction = fb->Direction ? fb->Direction : mcPositiveDirection,
        .buffer_mode = fb->BufferMode,
    };
    const cm1e_command_status_t status = fb_motion(&fb->Private, fb->Axis, fb->Execute, &command,
                                                   fb_refuse_continuous_update(fb->ContinuousUpdate));
    const fb_outputs_t out = fb_outputs(&fb->Private);
    /* 2.4.1: InVelocity speaks of the set-point, may fall and rise again, and ends neither Busy nor Active. */
    fb->InVelocity = out.busy && status.reached;
    fb->Busy = fb->Active = out.busy;
    fb->CommandAborted = out.aborted;
    fb->Error = out.error;
    fb->ErrorID = out.error_id;
}
