#include "edge.h"

/** 3.13. The CM1-E has position and velocity modes only (0x6502 = 0x1A5, UG 6.2), so the block always shows an
 *  error. */
void MC_TorqueControl(MC_TorqueControl_t *fb)
{
    cm1e_axis_t *axis = NULL;
    const cm1e_axis_command_t none = {.velocity = fb->Velocity};
    if (cm1e_fb_execute(&fb->Private, fb->Axis, fb->Execute, &axis) == FB_STEP_START)
        cm1e_fb_started(&fb->Private, cm1e_axis_refuse(axis, &none, CM1E_ERROR_AXIS_NO_TORQUE_MODE));
    const fb_outputs_t out = cm1e_fb_outputs(&fb->Private);
    fb->InTorque = FALSE;
    fb->Busy = out.busy;
    fb->Active = FALSE;
    fb->CommandAborted = out.aborted;
    fb->Error = out.error;
    fb->ErrorID = out.error_id;
}
