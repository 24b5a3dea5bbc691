#include "edge.h"

static void poll_reset(cm1e_fb_private_t *fb, const cm1e_axis_t *axis)
{
    cm1e_error_t error = CM1E_OK;
    const cm1e_command_state_t state = cm1e_axis_reset_state(axis, &error);
    cm1e_fb_polled_or_cancelled(fb, state, error);
}

void MC_Reset(MC_Reset_t *fb)
{
    cm1e_axis_t *axis = NULL;
    switch (cm1e_fb_execute(&fb->Private, fb->Axis, fb->Execute, &axis)) {
    case FB_STEP_START: cm1e_fb_started(&fb->Private, cm1e_axis_reset(axis)); break;
    case FB_STEP_POLL: poll_reset(&fb->Private, axis); break;
    case FB_STEP_NONE: break;
    }
    const fb_outputs_t out = cm1e_fb_outputs(&fb->Private);
    FB_SHOW_DONE(fb, out);
}
