#include "coupling/coupling.h"
#include "edge.h"

/** The cam is copied at the edge; MC_CamIn names its master. */
static cm1e_error_t take(MC_CamTableSelect_t *fb, cm1e_axis_t *slave)
{
    fb->CamTableID = 0;
    const cm1e_error_t error = fb_refuse_execution_mode(slave, fb->ExecutionMode);
    if (error != CM1E_OK)
        return error;
    return fb->CamTable ? cm1e_axis_cam_select(slave, fb->CamTable, fb->Periodic, fb->MasterAbsolute, fb->SlaveAbsolute,
                                               &fb->CamTableID)
                        : cm1e_axis_refuse_input(slave, CM1E_ERROR_AXIS_CAM_TABLE, "MC_CamTableSelect: CamTable", 0,
                                                 "a variable of the type MC_CAM_REF");
}

void MC_CamTableSelect(MC_CamTableSelect_t *fb)
{
    cm1e_axis_t *slave = NULL;
    switch (cm1e_fb_execute(&fb->Private, fb->Slave, fb->Execute, &slave)) {
    case FB_STEP_START: cm1e_fb_started(&fb->Private, take(fb, slave)); break;
    case FB_STEP_POLL: /* done at the edge */
        cm1e_fb_polled(&fb->Private, CM1E_COMMAND_DONE, CM1E_OK);
        break;
    case FB_STEP_NONE: break;
    }
    const fb_outputs_t out = cm1e_fb_outputs(&fb->Private);
    FB_SHOW_DONE(fb, out);
}
