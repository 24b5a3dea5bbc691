#include "group_edge.h"

void MC_AddAxisToGroup(MC_AddAxisToGroup_t *fb)
{
    cm1e_group_t *group = NULL;
    if (cm1e_fb_group_execute(&fb->Private, fb->AxesGroup, fb->Execute, &group) == FB_STEP_START) {
        const AXIS_REF_t none = {0};
        const cm1e_error_t error = cm1e_group_add(group, fb->Axis ? *fb->Axis : none, fb->IdentInGroup);
        cm1e_fb_polled(&fb->Private, error != CM1E_OK ? CM1E_COMMAND_ERROR : CM1E_COMMAND_DONE, error);
    }
    const fb_outputs_t out = cm1e_fb_outputs(&fb->Private);
    FB_SHOW_DONE(fb, out);
}
