#include "trigger.h"

static cm1e_error_t abort_trigger(const MC_AbortTrigger_t *fb, cm1e_axis_t *axis)
{
    cm1e_axis_trigger_t trigger;
    const cm1e_error_t error = fb_trigger(axis, fb->TriggerInput, &fb->Private, &trigger);
    return error != CM1E_OK ? error : cm1e_axis_probe_abort(axis, trigger);
}

void MC_AbortTrigger(MC_AbortTrigger_t *fb)
{
    cm1e_axis_t *axis = NULL;
    switch (cm1e_fb_execute(&fb->Private, fb->Axis, fb->Execute, &axis)) {
    case FB_STEP_START: cm1e_fb_started(&fb->Private, abort_trigger(fb, axis)); break;
    case FB_STEP_POLL: cm1e_fb_polled(&fb->Private, CM1E_COMMAND_DONE, CM1E_OK); break;
    case FB_STEP_NONE: break;
    }
    const fb_outputs_t out = cm1e_fb_outputs(&fb->Private);
    FB_SHOW_DONE(fb, out);
}
