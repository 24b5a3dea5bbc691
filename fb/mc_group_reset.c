#include "group_edge.h"

static void poll_reset(cm1e_fb_private_t *fb, cm1e_group_t *group)
{
    cm1e_error_t error = CM1E_OK;
    const cm1e_command_state_t state = cm1e_group_reset_state(group, &error);
    cm1e_fb_polled_or_cancelled(fb, state, error);
}

void MC_GroupReset(MC_GroupReset_t *fb)
{
    cm1e_group_t *group = NULL;
    switch (cm1e_fb_group_execute(&fb->Private, fb->AxesGroup, fb->Execute, &group)) {
    case FB_STEP_START: cm1e_fb_started(&fb->Private, cm1e_group_reset(group)); break;
    case FB_STEP_POLL: poll_reset(&fb->Private, group); break;
    case FB_STEP_NONE: break;
    }
    const fb_outputs_t out = cm1e_fb_outputs(&fb->Private);
    FB_SHOW_DONE(fb, out);
}
