#include "group_edge.h"

CM1E_APART static void work(MC_MoveDirectRelative_t *fb)
{
    cm1e_group_command_t command = {.kind = CM1E_GROUP_LINEAR_RELATIVE, FB_GROUP_ORDER(fb)};
    memcpy(command.position, fb->Distance, sizeof command.position);
    const fb_outputs_t out = cm1e_fb_group_motion(&fb->Private, fb->AxesGroup, fb->Execute, &command);
    FB_SHOW_GROUP_MOTION(fb, out);
}

void MC_MoveDirectRelative(MC_MoveDirectRelative_t *fb)
{
    if (!fb_group_stands(&fb->Private, fb->AxesGroup, fb->Execute))
        work(fb);
}
