#include "edge.h"

CM1E_APART static void work(MC_Halt_t *fb)
{
    const cm1e_axis_command_t command = {
        .kind = CM1E_COMMAND_HALT,
        .deceleration = fb->Deceleration,
        .jerk = fb->Jerk,
        .buffer_mode = fb->BufferMode,
    };
    const fb_outputs_t out = cm1e_fb_motion(&fb->Private, fb->Axis, fb->Execute, FALSE, &command);
    fb->Done = out.done;
    FB_SHOW_ACTIVE(fb, out);
}

void MC_Halt(MC_Halt_t *fb)
{
    if (!FB_STANDS(fb))
        work(fb);
}
