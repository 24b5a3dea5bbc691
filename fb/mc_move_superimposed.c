#include "edge.h"

void MC_MoveSuperimposed(MC_MoveSuperimposed_t *fb)
{
    const cm1e_axis_command_t command = {
        .kind = CM1E_COMMAND_MOVE_SUPERIMPOSED,
        .position = fb->Distance,
        .velocity = fb->VelocityDiff,
        FB_DYNAMICS(fb),
    };
    const BOOL busy_before = fb->Busy;
    const fb_outputs_t out = cm1e_fb_motion(&fb->Private, fb->Axis, fb->Execute, fb->ContinuousUpdate, &command);
    if (busy_before || out.busy) /* the distance covered at the end stays readable */
        fb->CoveredDistance = out.covered;
    fb->Done = out.done;
    FB_SHOW(fb, out);
}
