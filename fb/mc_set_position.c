#include "parameter.h"

void MC_SetPosition(MC_SetPosition_t *fb)
{
    cm1e_axis_t *axis = NULL;
    cm1e_error_t error;
    switch (cm1e_fb_execute(&fb->Private, fb->Axis, fb->Execute, &axis)) {
    case FB_STEP_START:
        error = fb_refuse_execution_mode(axis, fb->ExecutionMode);
        cm1e_fb_started(&fb->Private, error != CM1E_OK ? error
                                                       : cm1e_axis_set_position(axis, fb->Position, fb->Relative));
        break;
    case FB_STEP_POLL: /* done at the edge */
        cm1e_fb_polled(&fb->Private, CM1E_COMMAND_DONE, CM1E_OK);
        break;
    case FB_STEP_NONE: break;
    }
    const fb_outputs_t out = cm1e_fb_outputs(&fb->Private);
    FB_SHOW_DONE(fb, out);
}
