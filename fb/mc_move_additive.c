#include "edge.h"

CM1E_APART static void work(MC_MoveAdditive_t *fb)
{
    const cm1e_axis_command_t command = {
        .kind = CM1E_COMMAND_MOVE_ADDITIVE,
        .position = fb->Distance,
        .velocity = fb->Velocity,
        FB_DYNAMICS(fb),
        .buffer_mode = fb->BufferMode,
    };
    const fb_outputs_t out = cm1e_fb_motion(&fb->Private, fb->Axis, fb->Execute, fb->ContinuousUpdate, &command);
    fb->Done = out.done;
    FB_SHOW_ACTIVE(fb, out);
}

void MC_MoveAdditive(MC_MoveAdditive_t *fb)
{
    if (!FB_STANDS(fb))
        work(fb);
}
