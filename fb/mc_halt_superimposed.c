#include "edge.h"

void MC_HaltSuperimposed(MC_HaltSuperimposed_t *fb)
{
    const cm1e_axis_command_t command = {
        .kind = CM1E_COMMAND_HALT_SUPERIMPOSED,
        .deceleration = fb->Deceleration,
        .jerk = fb->Jerk,
    };
    const fb_outputs_t out = cm1e_fb_motion(&fb->Private, fb->Axis, fb->Execute, FALSE, &command);
    fb->Done = out.done;
    FB_SHOW_ACTIVE(fb, out);
}
