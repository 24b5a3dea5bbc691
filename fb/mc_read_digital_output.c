#include "axis/axis_signals.h"
#include "edge.h"

void MC_ReadDigitalOutput(MC_ReadDigitalOutput_t *fb)
{
    const cm1e_axis_t *axis = cm1e_fb_enable(&fb->Private, fb->Output ? &fb->Output->Axis : NULL, fb->Enable);
    bool value = false;
    cm1e_error_t error = CM1E_OK;
    if (axis)
        error = cm1e_axis_read_output(axis, fb->OutputNumber ? fb->OutputNumber : fb->Output->Number, &value);
    const fb_reading_t out = cm1e_fb_reading(&fb->Private, axis, error);
    FB_SHOW_READING(fb, out);
    fb->Value = out.valid && value;
}
