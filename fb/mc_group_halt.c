#include "group_edge.h"

CM1E_APART static void work(MC_GroupHalt_t *fb)
{
    const cm1e_group_command_t command = {
        .kind = CM1E_GROUP_HALT,
        .deceleration = fb->Deceleration,
        .jerk = fb->Jerk,
        .buffer_mode = fb->BufferMode,
    };
    const fb_outputs_t out = cm1e_fb_group_motion(&fb->Private, fb->AxesGroup, fb->Execute, &command);
    FB_SHOW_GROUP_MOTION(fb, out);
}

void MC_GroupHalt(MC_GroupHalt_t *fb)
{
    if (!fb_group_stands(&fb->Private, fb->AxesGroup, fb->Execute))
        work(fb);
}
