#include "parameter.h"

void MC_ReadParameter(MC_ReadParameter_t *fb)
{
    fb_parameter_t shown = {.valid = fb->Valid, .error_id = fb->ErrorID, .value = fb->Value};
    cm1e_fb_read_parameter(&fb->Private, fb->Axis, fb->Enable, fb->ParameterNumber, false, &shown);
    FB_SHOW_READING(fb, shown);
    fb->Value = shown.value;
}
