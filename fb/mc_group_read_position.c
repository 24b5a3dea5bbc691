#include "group_edge.h"

void MC_GroupReadPosition(MC_GroupReadPosition_t *fb)
{
    const cm1e_group_t *group = cm1e_fb_group_enable(&fb->Private, fb->AxesGroup, fb->Enable);
    LREAL position[CM1E_GROUP_AXES] = {0}, velocity[CM1E_GROUP_AXES], path;
    cm1e_error_t error = fb->CoordSystem == mcACS ? CM1E_OK : CM1E_ERROR_GROUP_COORD_SYSTEM;
    if (group && error == CM1E_OK)
        error = cm1e_group_values(group, fb->Source, position, velocity, &path);
    const fb_reading_t out = cm1e_fb_reading(&fb->Private, group, error);
    FB_SHOW_READING(fb, out);
    for (int i = 0; i < CM1E_GROUP_AXES; i++)
        fb->Position[i] = fb->Valid ? position[i] : 0;
}
