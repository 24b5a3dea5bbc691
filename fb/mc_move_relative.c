#include "edge.h"

void MC_MoveRelative(MC_MoveRelative_t *fb)
{
    if (fb_stands(&fb->Private, fb->Axis, fb->Execute, fb->Active && !fb->ContinuousUpdate))
        return;
    const cm1e_axis_command_t command = {
        .kind = CM1E_COMMAND_MOVE_RELATIVE,
        .position = fb->Distance,
        .velocity = fb->Velocity,
        .acceleration = fb->Acceleration,
        .deceleration = fb->Deceleration,
        .jerk = fb->Jerk,
        .buffer_mode = fb->BufferMode,
    };
    fb_motion(&fb->Private, fb->Axis, fb->Execute, &command, fb_refuse_continuous_update(fb->ContinuousUpdate));
    const fb_outputs_t out = fb_outputs(&fb->Private);
    fb->Done = out.done;
    fb->Busy = fb->Active = out.busy;
    fb->CommandAborted = out.aborted;
    fb->Error = out.error;
    fb->ErrorID = out.error_id;
}
