#include "edge.h"

/* The CM1-E has no distance coded marks. */
void MC_StepDistanceCoded(MC_StepDistanceCoded_t *fb)
{
    const fb_outputs_t out = cm1e_fb_refused_step(&fb->Private, fb->Axis, fb->Execute, CM1E_ERROR_AXIS_NO_SUCH_SIGNAL);
    fb->Done = out.done;
    FB_SHOW_ACTIVE(fb, out);
}
