#include "axis/axis_signals.h"
#include "edge.h"

static cm1e_error_t write_output(const MC_WriteDigitalOutput_t *fb, cm1e_axis_t *axis)
{
    const int number = fb->OutputNumber ? fb->OutputNumber : fb->Output->Number;
    const cm1e_error_t error = fb_refuse_execution_mode(fb->ExecutionMode);
    return error ? error : cm1e_axis_write_output(axis, number, fb->Value != FALSE);
}

/** Done in the call after the edge: the value has left with the cycle of the edge. */
void MC_WriteDigitalOutput(MC_WriteDigitalOutput_t *fb)
{
    cm1e_axis_t *axis = NULL;
    switch (fb_execute(&fb->Private, fb->Output ? &fb->Output->Axis : NULL, fb->Execute, &axis)) {
    case FB_STEP_START: fb_started(&fb->Private, write_output(fb, axis)); break;
    case FB_STEP_POLL: fb_polled(&fb->Private, CM1E_COMMAND_DONE, CM1E_OK); break;
    case FB_STEP_NONE: break;
    }
    const fb_outputs_t out = fb_outputs(&fb->Private);
    fb->Done = out.done;
    fb->Busy = out.busy;
    fb->Error = out.error;
    fb->ErrorID = out.error_id;
}
