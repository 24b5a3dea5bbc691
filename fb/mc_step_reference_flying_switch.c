#include "edge.h"

/* Not implemented in this version: use MC_TouchProbe and MC_SetPosition. */
void MC_StepReferenceFlyingSwitch(MC_StepReferenceFlyingSwitch_t *fb)
{
    const cm1e_axis_command_t none = {.kind = CM1E_COMMAND_HOMING_STEP};
    const fb_outputs_t out = cm1e_fb_motion_unless(CM1E_ERROR_UNSUPPORTED, &fb->Private, fb->Axis, fb->Execute, FALSE,
                                                   &none);
    fb->Done = out.done;
    FB_SHOW_ACTIVE(fb, out);
}
