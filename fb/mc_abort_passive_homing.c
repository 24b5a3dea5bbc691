#include "edge.h"

/* There is no passive homing to abort in this version. */
void MC_AbortPassiveHoming(MC_AbortPassiveHoming_t *fb)
{
    const fb_outputs_t out = cm1e_fb_refused_step(&fb->Private, fb->Axis, fb->Execute, CM1E_ERROR_UNSUPPORTED);
    fb->Done = out.done;
    FB_SHOW(fb, out);
}
