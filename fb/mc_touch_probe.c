#include "trigger.h"

static cm1e_error_t arm(MC_TouchProbe_t *fb, cm1e_axis_t *axis)
{
    cm1e_axis_trigger_t trigger;
    const cm1e_error_t error = fb_trigger(axis, fb->TriggerInput, &fb->Private, &trigger);
    fb->Private.command = 0;
    fb->RecordedPosition = fb->Uncertainty = 0.0;
    return error != CM1E_OK ? error : cm1e_axis_probe(axis, trigger, fb->WindowOnly != FALSE, fb->FirstPosition,
                                           fb->LastPosition, &fb->Private.command);
}

static void poll(MC_TouchProbe_t *fb, const cm1e_axis_t *axis)
{
    const cm1e_probe_status_t status = cm1e_axis_probe_status(axis, fb->Private.command);
    cm1e_fb_polled(&fb->Private, status.state, status.error); /* UNKNOWN (another block took over the trigger) is
                                                               * shown as aborted */
    if (status.state == CM1E_COMMAND_DONE) {
        fb->RecordedPosition = status.position;
        fb->Uncertainty = status.uncertainty;
    }
}

/** The axis waits for the trigger, also while the block is not called. The recorded position stays until the next edge
 *  of Execute. */
void MC_TouchProbe(MC_TouchProbe_t *fb)
{
    cm1e_axis_t *axis = NULL;
    switch (cm1e_fb_execute(&fb->Private, fb->Axis, fb->Execute, &axis)) {
    case FB_STEP_START: cm1e_fb_started(&fb->Private, arm(fb, axis)); break;
    case FB_STEP_POLL: poll(fb, axis); break;
    case FB_STEP_NONE: break;
    }
    const fb_outputs_t out = cm1e_fb_outputs(&fb->Private);
    fb->Done = out.done;
    fb->Busy = out.busy;
    fb->CommandAborted = out.aborted;
    fb->Error = out.error;
    fb->ErrorID = out.error_id;
}
