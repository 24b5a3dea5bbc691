#include "group_edge.h"

void MC_GroupReadConfiguration(MC_GroupReadConfiguration_t *fb)
{
    const cm1e_group_t *group = cm1e_fb_group_enable(&fb->Private, fb->AxesGroup, fb->Enable);
    AXIS_REF_t axis = {0};
    cm1e_error_t error = CM1E_OK;
    if (group)
        error = fb->CoordSystem == mcACS ? cm1e_group_member(group, fb->IdentInGroup, &axis)
                                         : CM1E_ERROR_GROUP_COORD_SYSTEM;
    const fb_reading_t out = cm1e_fb_reading(&fb->Private, group, error);
    FB_SHOW_READING(fb, out);
    fb->Axis = axis;
    fb->AxisID = axis.Handle;
}
