#include "edge.h"

void MC_Home(MC_Home_t *fb)
{
    const cm1e_axis_command_t command = {
        .kind = CM1E_COMMAND_HOME,
        .position = fb->Position,
        .buffer_mode = fb->BufferMode,
        .homing = fb->Parameters,
    };
    fb_motion(&fb->Private, fb->Axis, fb->Execute, &command, CM1E_OK);
    const fb_outputs_t out = fb_outputs(&fb->Private);
    fb->Done = out.done;
    fb->Busy = fb->Active = out.busy;
    fb->CommandAborted = out.aborted;
    fb->Error = out.error;
    fb->ErrorID = out.error_id;
}
