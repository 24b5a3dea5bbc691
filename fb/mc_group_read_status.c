#include "group_edge.h"

void MC_GroupReadStatus(MC_GroupReadStatus_t *fb)
{
    cm1e_group_t *group = cm1e_fb_group_enable(&fb->Private, fb->AxesGroup, fb->Enable);
    cm1e_group_info_t info = {.state = CM1E_GROUP_STATE_COUNT};
    if (group)
        cm1e_group_get(group, &info);
    const fb_reading_t out = cm1e_fb_reading(&fb->Private, group, CM1E_OK);
    FB_SHOW_READING(fb, out);
    fb->GroupMoving = info.state == CM1E_GROUP_MOVING;
    fb->GroupHoming = FALSE;
    fb->GroupErrorStop = info.state == CM1E_GROUP_ERROR_STOP;
    fb->GroupStandby = info.state == CM1E_GROUP_STANDBY;
    fb->GroupStopping = info.state == CM1E_GROUP_STOPPING;
    fb->GroupDisabled = info.state == CM1E_GROUP_DISABLED;
}
