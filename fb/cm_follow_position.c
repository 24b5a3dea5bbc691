#include "edge.h"

void CM_FollowPosition(CM_FollowPosition_t *fb)
{
    const cm1e_axis_command_t command = {.kind = CM1E_COMMAND_FOLLOW_POSITION, .position = fb->Position};
    const fb_outputs_t out = cm1e_fb_motion(&fb->Private, fb->Axis, fb->Execute, FALSE, &command);
    if (out.active)
        cm1e_axis_feed(*fb->Axis, fb->Private.command, fb->Position);
    FB_SHOW_ACTIVE(fb, out);
}
