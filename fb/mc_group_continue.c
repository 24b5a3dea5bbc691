#include "group_edge.h"

void MC_GroupContinue(MC_GroupContinue_t *fb)
{
    const fb_outputs_t out = cm1e_fb_group_act(&fb->Private, fb->AxesGroup, fb->Execute, cm1e_group_continue);
    FB_SHOW_DONE(fb, out);
}
