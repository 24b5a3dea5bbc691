#include "parameter.h"

void MC_WriteBoolParameter(MC_WriteBoolParameter_t *fb)
{
    const fb_outputs_t out = cm1e_fb_write_parameter(&fb->Private, fb->Axis, fb->Execute, fb->ParameterNumber, true,
                                                     fb->Value ? 1.0 : 0.0, fb->ExecutionMode);
    FB_SHOW_DONE(fb, out);
}
