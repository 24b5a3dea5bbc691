#include "edge.h"

/* The CM1-E counts from where it was switched on: its encoder is no absolute one. */
void MC_HomeAbsolute(MC_HomeAbsolute_t *fb)
{
    const cm1e_axis_command_t none = {.kind = CM1E_COMMAND_HOMING_STEP};
    const fb_outputs_t out = cm1e_fb_motion_unless(CM1E_ERROR_AXIS_NO_SUCH_SIGNAL, &fb->Private, fb->Axis, fb->Execute,
                                                   FALSE, &none);
    fb->Done = out.done;
    FB_SHOW_ACTIVE(fb, out);
}
