#include "edge.h"

void MC_ReadStatus(MC_ReadStatus_t *fb)
{
    cm1e_axis_info_t info = {0};
    /* The axis itself has the state diagram, so the block is valid also while the drive is off the bus. */
    const BOOL valid = cm1e_fb_read(&fb->Private, fb->Axis, fb->Enable, &info);
    const fb_outputs_t out = cm1e_fb_outputs(&fb->Private);
    fb->Valid = valid;
    fb->Busy = out.busy;
    fb->Error = out.error;
    fb->ErrorID = out.error_id;
    fb->ErrorStop = valid && info.state == CM1E_AXIS_ERROR_STOP;
    fb->Disabled = valid && info.state == CM1E_AXIS_DISABLED;
    fb->Stopping = valid && info.state == CM1E_AXIS_STOPPING;
    fb->Homing = valid && info.state == CM1E_AXIS_HOMING;
    fb->Standstill = valid && info.state == CM1E_AXIS_STANDSTILL;
    fb->DiscreteMotion = valid && info.state == CM1E_AXIS_DISCRETE_MOTION;
    fb->ContinuousMotion = valid && info.state == CM1E_AXIS_CONTINUOUS_MOTION;
    fb->SynchronizedMotion = valid && info.state == CM1E_AXIS_SYNCHRONIZED_MOTION;
}
