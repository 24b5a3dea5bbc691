#include "edge.h"

void MC_Home(MC_Home_t *fb)
{
    if (FB_STANDS(fb))
        return;
    const cm1e_axis_command_t command = {
        .kind = CM1E_COMMAND_HOME,
        .position = fb->Position,
        .buffer_mode = fb->BufferMode,
        .homing = fb->Parameters,
    };
    const fb_outputs_t out = cm1e_fb_motion(&fb->Private, fb->Axis, fb->Execute, FALSE, &command);
    fb->Done = out.done;
    FB_SHOW_ACTIVE(fb, out);
}
