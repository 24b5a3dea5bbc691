#include "group_edge.h"

/** The group stays in GroupStopping while Execute is TRUE, also when the block itself is in error. */
static void hold_group(const cm1e_fb_private_t *fb)
{
    cm1e_group_t *group = fb->command ? cm1e_fb_group(fb) : NULL;
    if (group)
        cm1e_group_hold_stop(group, fb->command, fb->trigger_before);
}

void MC_GroupStop(MC_GroupStop_t *fb)
{
    const cm1e_group_command_t command = {
        .kind = CM1E_GROUP_STOP,
        .deceleration = fb->Deceleration,
        .jerk = fb->Jerk,
    };
    const fb_outputs_t out = cm1e_fb_group_motion(&fb->Private, fb->AxesGroup, fb->Execute, &command);
    hold_group(&fb->Private);
    fb->Done = out.done;
    FB_SHOW(fb, out);
}
