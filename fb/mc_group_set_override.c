#include "group_edge.h"

/* Accelerations and jerks stay those of the commands in this version. */
static cm1e_error_t set_factors(cm1e_group_t *group, const MC_GroupSetOverride_t *fb)
{
    if (fb->AccFactor != 1.0 || fb->JerkFactor != 1.0)
        return CM1E_ERROR_AXIS_OVERRIDE;
    return cm1e_group_set_override(group, fb->VelFactor);
}

static cm1e_error_t set_or_refuse(cm1e_group_t *group, const MC_GroupSetOverride_t *fb)
{
    const cm1e_error_t error = set_factors(group, fb);
    if (error != CM1E_OK)
        cm1e_group_refuse_override(group, error, fb->VelFactor, fb->AccFactor, fb->JerkFactor,
                                   fb->ErrorID != cm1e_error_id(error));
    return error;
}

void MC_GroupSetOverride(MC_GroupSetOverride_t *fb)
{
    cm1e_group_t *group = cm1e_fb_group_enable(&fb->Private, fb->AxesGroup, fb->Enable);
    const fb_reading_t out = cm1e_fb_reading(&fb->Private, group, group ? set_or_refuse(group, fb) : CM1E_OK);
    fb->Enabled = out.valid;
    fb->Busy = out.busy;
    fb->Error = out.error;
    fb->ErrorID = out.error_id;
}
