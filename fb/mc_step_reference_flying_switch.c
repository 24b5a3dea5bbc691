#include "edge.h"

/* Not in this version: MC_TouchProbe and MC_SetPosition do it in two blocks. */
void MC_StepReferenceFlyingSwitch(MC_StepReferenceFlyingSwitch_t *fb)
{
    const cm1e_axis_command_t none = {.kind = CM1E_COMMAND_HOMING_STEP};
    fb_motion(&fb->Private, fb->Axis, fb->Execute, &none, CM1E_ERROR_UNSUPPORTED);
    const fb_outputs_t out = fb_outputs(&fb->Private);
    fb->Done = out.done;
    fb->Busy = fb->Active = out.busy;
    fb->CommandAborted = out.aborted;
    fb->Error = out.error;
    fb->ErrorID = out.error_id;
}
