#include "parameter.h"

void MC_WriteBoolParameter(MC_WriteBoolParameter_t *fb)
{
    const fb_outputs_t out = cm1e_fb_write_parameter(&fb->Private, fb->Axis, fb->Execute, fb->ParameterNumber, true,
                                                     fb->Value ? 1.0 : 0.0, fb->ExecutionMode);
    fb->Done = out.done;
    fb->Busy = out.busy;
    fb->Error = out.error;
    fb->ErrorID = out.error_id;
}
