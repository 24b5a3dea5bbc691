#include "group_edge.h"

static void start(cm1e_fb_private_t *fb, cm1e_group_t *group, const MC_GroupInterrupt_t *inputs)
{
    const cm1e_group_command_t command = {
        .kind = CM1E_GROUP_INTERRUPT,
        .deceleration = inputs->Deceleration,
        .jerk = inputs->Jerk,
    };
    fb->command = 0;
    cm1e_fb_started(fb, cm1e_group_start(group, &command, &fb->command));
}

static void poll(cm1e_fb_private_t *fb, const cm1e_group_t *group)
{
    const cm1e_command_status_t status = cm1e_group_command_status(group, fb->command);
    cm1e_fb_polled_or_cancelled(fb, status.state, status.error);
}

void MC_GroupInterrupt(MC_GroupInterrupt_t *fb)
{
    cm1e_group_t *group = NULL;
    switch (cm1e_fb_group_execute(&fb->Private, fb->AxesGroup, fb->Execute, &group)) {
    case FB_STEP_START: start(&fb->Private, group, fb); break;
    case FB_STEP_POLL: poll(&fb->Private, group); break;
    case FB_STEP_NONE: break;
    }
    const fb_outputs_t out = cm1e_fb_outputs(&fb->Private);
    FB_SHOW_DONE(fb, out);
}
