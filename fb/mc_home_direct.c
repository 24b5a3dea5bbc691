#include "edge.h"

void MC_HomeDirect(MC_HomeDirect_t *fb)
{
    if (FB_STANDS(fb))
        return;
    const cm1e_homing_step_t step = {
        .kind = CM1E_STEP_DIRECT,
    };
    const cm1e_axis_command_t command = {FB_STEP_COMMAND(fb, &step)};
    const fb_outputs_t out = cm1e_fb_motion(&fb->Private, fb->Axis, fb->Execute, FALSE, &command);
    fb->Done = out.done;
    FB_SHOW_ACTIVE(fb, out);
}
