#include "group_edge.h"

void MC_GroupReadError(MC_GroupReadError_t *fb)
{
    cm1e_group_t *group = cm1e_fb_group_enable(&fb->Private, fb->AxesGroup, fb->Enable);
    cm1e_group_info_t info = {.error = CM1E_OK};
    if (group)
        cm1e_group_get(group, &info);
    const fb_reading_t out = cm1e_fb_reading(&fb->Private, group, CM1E_OK);
    FB_SHOW_READING(fb, out);
    fb->GroupErrorID = cm1e_error_id(info.error);
}
