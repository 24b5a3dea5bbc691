#include "axis/axis_signals.h"
#include "edge.h"

void MC_ReadDigitalInput(MC_ReadDigitalInput_t *fb)
{
    const cm1e_axis_t *axis = cm1e_fb_enable(&fb->Private, fb->Input ? &fb->Input->Axis : NULL, fb->Enable);
    const int number = !axis ? 0 : fb->InputNumber ? fb->InputNumber : fb->Input->Number;
    bool value = false;
    const cm1e_error_t error = axis ? cm1e_axis_read_input(cm1e_fb_axis(&fb->Private), number, &value) : CM1E_OK;
    if (error == CM1E_ERROR_AXIS_SIGNAL || error == CM1E_ERROR_PDO_MAPPING)
        cm1e_axis_refuse_signal(cm1e_fb_axis(&fb->Private), error, false, number, fb->ErrorID != cm1e_error_id(error));
    fb_reading_t out = cm1e_fb_reading(&fb->Private, axis, error == CM1E_ERROR_BUSY ? CM1E_OK : error);
    out.valid = out.valid && error == CM1E_OK; /* behind a bridge it comes some cycles later */
    fb_reads_right(&fb->Private, fb->ErrorID, out.error);
    FB_SHOW_READING(fb, out);
    fb->Value = out.valid && value;
}
