#include "axis/axis_signals.h"
#include "edge.h"

void MC_ReadDigitalInput(MC_ReadDigitalInput_t *fb)
{
    const cm1e_axis_t *axis = fb_enable(&fb->Private, fb->Input ? &fb->Input->Axis : NULL, fb->Enable);
    bool value = false;
    cm1e_error_t error = CM1E_OK;
    if (axis)
        error = cm1e_axis_read_input(axis, fb->InputNumber ? fb->InputNumber : fb->Input->Number, &value);
    const fb_reading_t out = fb_reading(&fb->Private, axis, error);
    fb->Valid = out.valid;
    fb->Busy = out.busy;
    fb->Error = out.error;
    fb->ErrorID = out.error_id;
    fb->Value = out.valid && value;
}
