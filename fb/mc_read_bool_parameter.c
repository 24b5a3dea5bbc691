#include "parameter.h"

void MC_ReadBoolParameter(MC_ReadBoolParameter_t *fb)
{
    fb_parameter_t shown = {.valid = fb->Valid, .value = fb->Value};
    cm1e_fb_read_parameter(&fb->Private, fb->Axis, fb->Enable, fb->ParameterNumber, true, &shown);
    fb->Valid = shown.valid;
    fb->Busy = shown.busy;
    fb->Error = shown.error;
    fb->ErrorID = shown.error_id;
    fb->Value = shown.value != 0.0;
}
