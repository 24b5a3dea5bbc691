#include "axis/axis_signals.h"
#include "edge.h"

void MC_ReadDigitalOutput(MC_ReadDigitalOutput_t *fb)
{
    const cm1e_axis_t *axis = cm1e_fb_enable(&fb->Private, fb->Output ? &fb->Output->Axis : NULL, fb->Enable);
    const int number = !axis ? 0 : fb->OutputNumber ? fb->OutputNumber : fb->Output->Number;
    bool value = false;
    const cm1e_error_t error = axis ? cm1e_axis_read_output(axis, number, &value) : CM1E_OK;
    if (error == CM1E_ERROR_AXIS_SIGNAL || error == CM1E_ERROR_PDO_MAPPING)
        cm1e_axis_refuse_signal(cm1e_fb_axis(&fb->Private), error, true, number, fb->ErrorID != cm1e_error_id(error));
    const fb_reading_t out = cm1e_fb_reading(&fb->Private, axis, error);
    fb_reads_right(&fb->Private, fb->ErrorID, out.error);
    FB_SHOW_READING(fb, out);
    fb->Value = out.valid && value;
}
