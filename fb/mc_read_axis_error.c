#include "edge.h"

void MC_ReadAxisError(MC_ReadAxisError_t *fb)
{
    cm1e_axis_info_t info = {0};
    const BOOL valid = cm1e_fb_read(&fb->Private, fb->Axis, fb->Enable, &info);
    const fb_outputs_t out = cm1e_fb_outputs(&fb->Private);
    fb->Valid = valid;
    fb->Busy = out.busy;
    fb->Error = out.error;
    fb->ErrorID = out.error_id;
    fb->AxisErrorID = valid ? cm1e_error_id(info.error) : 0;
    fb->DeviceErrorCode = valid ? info.device_error : 0;
}
