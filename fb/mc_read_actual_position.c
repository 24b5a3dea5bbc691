#include "edge.h"

void MC_ReadActualPosition(MC_ReadActualPosition_t *fb)
{
    cm1e_axis_info_t info = {0};
    const BOOL read = cm1e_fb_read(&fb->Private, fb->Axis, fb->Enable, &info);
    const fb_outputs_t out = cm1e_fb_outputs(&fb->Private);
    /* 2.2.3: off the bus is an error that goes away by itself, so Busy stays TRUE and Valid returns. */
    const bool offline = read && !info.online;
    fb->Valid = read && info.online;
    fb->Busy = out.busy;
    fb->Error = out.error || offline;
    fb->ErrorID = offline ? cm1e_error_id(CM1E_ERROR_AXIS_OFFLINE) : out.error_id;
    fb->Position = fb->Valid ? info.actual_position : 0;
}
