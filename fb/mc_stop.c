#include "edge.h"

/** The axis stays Stopping while Execute is TRUE, also when the block itself is in error (its Axis was changed). */
static bool hold_axis(cm1e_fb_private_t *fb)
{
    cm1e_axis_t *axis = fb->command ? cm1e_fb_axis(fb) : NULL;
    if (!axis)
        return false;
    return cm1e_axis_hold_stop(axis, fb->command, fb->trigger_before);
}

void MC_Stop(MC_Stop_t *fb)
{
    const cm1e_axis_command_t command = {
        .kind = CM1E_COMMAND_STOP,
        .deceleration = fb->Deceleration,
        .jerk = fb->Jerk,
    };
    const fb_outputs_t out = cm1e_fb_motion(&fb->Private, fb->Axis, fb->Execute, FALSE, &command);
    const bool held = hold_axis(&fb->Private);
    fb->Done = out.done;
    FB_SHOW(fb, out);
    fb->Active = out.busy || (out.done && held); /* 2.4.1: the one block that may show Active with Done */
}
