#include "axis/axis_signals.h"
#include "edge.h"

static int number_of(const MC_WriteDigitalOutput_t *fb)
{
    return fb->OutputNumber ? fb->OutputNumber : fb->Output->Number;
}

static cm1e_error_t write_output(const MC_WriteDigitalOutput_t *fb, cm1e_axis_t *axis)
{
    const cm1e_error_t error = fb_refuse_execution_mode(axis, fb->ExecutionMode);
    return error != CM1E_OK ? error : cm1e_axis_write_output(axis, number_of(fb), fb->Value != FALSE);
}

static void poll(MC_WriteDigitalOutput_t *fb, cm1e_axis_t *axis)
{
    cm1e_error_t error;
    const cm1e_command_state_t state = cm1e_axis_output_state(axis, number_of(fb), &error);
    cm1e_fb_polled(&fb->Private, state, error);
}

/** Done comes in the call after the edge: the value was sent in the cycle of the edge. Behind a bridge an SDO transfers
 *  it. */
void MC_WriteDigitalOutput(MC_WriteDigitalOutput_t *fb)
{
    cm1e_axis_t *axis = NULL;
    switch (cm1e_fb_execute(&fb->Private, fb->Output ? &fb->Output->Axis : NULL, fb->Execute, &axis)) {
    case FB_STEP_START: cm1e_fb_started(&fb->Private, write_output(fb, axis)); break;
    case FB_STEP_POLL: poll(fb, axis); break;
    case FB_STEP_NONE: break;
    }
    const fb_outputs_t out = cm1e_fb_outputs(&fb->Private);
    FB_SHOW_DONE(fb, out);
}
