#include "parameter.h"

void MC_WriteParameter(MC_WriteParameter_t *fb)
{
    const fb_outputs_t out = cm1e_fb_write_parameter(&fb->Private, fb->Axis, fb->Execute, fb->ParameterNumber, false,
                                                     fb->Value, fb->ExecutionMode);
    FB_SHOW_DONE(fb, out);
}
