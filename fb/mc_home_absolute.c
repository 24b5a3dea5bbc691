#include "edge.h"

/* The CM1-E counts from where it was switched on: its encoder is no absolute one. */
void MC_HomeAbsolute(MC_HomeAbsolute_t *fb)
{
    const cm1e_axis_command_t none = {.kind = CM1E_COMMAND_HOMING_STEP};
    fb_motion(&fb->Private, fb->Axis, fb->Execute, &none, CM1E_ERROR_AXIS_NO_SUCH_SIGNAL);
    const fb_outputs_t out = fb_outputs(&fb->Private);
    fb->Done = out.done;
    fb->Busy = fb->Active = out.busy;
    fb->CommandAborted = out.aborted;
    fb->Error = out.error;
    fb->ErrorID = out.error_id;
}
