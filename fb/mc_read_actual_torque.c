#include "edge.h"

void MC_ReadActualTorque(MC_ReadActualTorque_t *fb)
{
    cm1e_axis_info_t info = {0};
    const cm1e_axis_t *axis = fb_enable(&fb->Private, fb->Axis, fb->Enable);
    if (axis)
        cm1e_axis_get(axis, &info);
    const fb_reading_t out = fb_reading(&fb->Private, axis, info.online ? CM1E_OK : CM1E_ERROR_AXIS_OFFLINE);
    fb->Valid = out.valid;
    fb->Busy = out.busy;
    fb->Error = out.error;
    fb->ErrorID = out.error_id;
    fb->Torque = out.valid ? info.actual_torque : 0.0;
}
