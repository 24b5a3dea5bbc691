#include "edge.h"

void MC_MoveContinuousAbsolute(MC_MoveContinuousAbsolute_t *fb)
{
    const cm1e_axis_command_t command = {
        .kind = CM1E_COMMAND_MOVE_CONTINUOUS_ABSOLUTE,
        .position = fb->Position,
        .end_velocity = fb->EndVelocity,
        .velocity = fb->Velocity,
        FB_DYNAMICS(fb),
        .direction = fb->Direction,
        .buffer_mode = fb->BufferMode,
    };
    const fb_outputs_t out = cm1e_fb_motion(&fb->Private, fb->Axis, fb->Execute, fb->ContinuousUpdate, &command);
    fb->InEndVelocity = out.reached;
    FB_SHOW_ACTIVE(fb, out);
}
