#include "axis/axis_signals.h"
#include "edge.h"

void MC_ReadDigitalInput(MC_ReadDigitalInput_t *fb)
{
    const cm1e_axis_t *axis = cm1e_fb_enable(&fb->Private, fb->Input ? &fb->Input->Axis : NULL, fb->Enable);
    bool value = false;
    cm1e_error_t error = CM1E_OK;
    if (axis)
        error = cm1e_axis_read_input(cm1e_fb_axis(&fb->Private), fb->InputNumber ? fb->InputNumber : fb->Input->Number,
                                     &value);
    fb_reading_t out = cm1e_fb_reading(&fb->Private, axis, error == CM1E_ERROR_BUSY ? CM1E_OK : error);
    out.valid = out.valid && error == CM1E_OK; /* behind a bridge it comes some cycles later */
    FB_SHOW_READING(fb, out);
    fb->Value = out.valid && value;
}
