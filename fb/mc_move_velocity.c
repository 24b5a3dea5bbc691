#include "edge.h"

void MC_MoveVelocity(MC_MoveVelocity_t *fb)
{
    const cm1e_axis_command_t command = {
        .kind = CM1E_COMMAND_MOVE_VELOCITY,
        .velocity = fb->Velocity,
        FB_DYNAMICS(fb),
        .direction = fb->Direction ? fb->Direction : mcPositiveDirection,
        .buffer_mode = fb->BufferMode,
    };
    const fb_outputs_t out = cm1e_fb_motion(&fb->Private, fb->Axis, fb->Execute, fb->ContinuousUpdate, &command);
    /* 2.4.1: InVelocity refers to the set-point, may fall and rise again, and ends neither Busy nor Active. */
    fb->InVelocity = out.reached;
    FB_SHOW_ACTIVE(fb, out);
}
