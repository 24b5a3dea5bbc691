#include "edge.h"

/* Not implemented in this version: use MC_TouchProbe and MC_SetPosition. */
void MC_StepReferenceFlyingSwitch(MC_StepReferenceFlyingSwitch_t *fb)
{
    const fb_outputs_t out = cm1e_fb_refused_step(&fb->Private, fb->Axis, fb->Execute, CM1E_ERROR_UNSUPPORTED);
    fb->Done = out.done;
    FB_SHOW_ACTIVE(fb, out);
}
