#include "edge.h"

void MC_StepLimitSwitch(MC_StepLimitSwitch_t *fb)
{
    if (fb_stands(&fb->Private, fb->Axis, fb->Execute, fb->Active))
        return;
    const cm1e_homing_step_t step = {
        .kind = CM1E_STEP_LIMIT_SWITCH,
        .direction = fb->Direction,
        .mode = fb->LimitSwitchMode,
        .torque_limit = fb->TorqueLimit,
        .distance_limit = fb->DistanceLimit,
        .time_limit_ns = fb->TimeLimit,
    };
    const cm1e_axis_command_t command = {
        .kind = CM1E_COMMAND_HOMING_STEP,
        .velocity = fb->Velocity,
        .position = fb->SetPosition,
        .buffer_mode = fb->BufferMode,
        .step = &step,
    };
    fb_motion(&fb->Private, fb->Axis, fb->Execute, &command, CM1E_OK);
    const fb_outputs_t out = fb_outputs(&fb->Private);
    fb->Done = out.done;
    fb->Busy = fb->Active = out.busy;
    fb->CommandAborted = out.aborted;
    fb->Error = out.error;
    fb->ErrorID = out.error_id;
}
