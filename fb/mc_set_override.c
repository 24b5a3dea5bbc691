#include "edge.h"

void MC_SetOverride(MC_SetOverride_t *fb)
{
    const cm1e_axis_t *enabled = cm1e_fb_enable(&fb->Private, fb->Axis, fb->Enable);
    cm1e_axis_t *axis = enabled ? cm1e_fb_axis(&fb->Private) : NULL;
    const cm1e_error_t error = axis ? cm1e_axis_set_override(axis, fb->VelFactor, fb->AccFactor, fb->JerkFactor)
                                    : CM1E_OK;
    if (error != CM1E_OK)
        cm1e_axis_refuse_override(axis, error, fb->VelFactor, fb->AccFactor, fb->JerkFactor,
                                  fb->ErrorID != cm1e_error_id(error));
    /* Refused factors change nothing, and valid ones end the error (figure 36, 4). */
    const fb_reading_t out = cm1e_fb_reading(&fb->Private, axis, error);
    fb_reads_right(&fb->Private, fb->ErrorID, out.error);
    fb->Enabled = out.valid;
    fb->Busy = out.busy;
    fb->Error = out.error;
    fb->ErrorID = out.error_id;
}
