#include "edge.h"

/** An input of another motor cannot give the position of this axis. */
static bool is_of_another_axis(const MC_StepAbsoluteSwitch_t *fb)
{
    const UINT handle = fb->ReferenceSignal.Axis.Handle;
    return handle && fb->Axis && handle != fb->Axis->Handle;
}

void MC_StepAbsoluteSwitch(MC_StepAbsoluteSwitch_t *fb)
{
    if (FB_STANDS(fb))
        return;
    const cm1e_homing_step_t step = {
        .kind = CM1E_STEP_ABSOLUTE_SWITCH,
        .direction = fb->Direction,
        .mode = fb->SwitchMode,
        .input = fb->ReferenceSignal.InputNumber,
        .of_another_axis = is_of_another_axis(fb),
        FB_STEP_LIMITS(fb),
    };
    const cm1e_axis_command_t command = {FB_STEP_COMMAND(fb, &step), .velocity = fb->Velocity};
    const fb_outputs_t out = cm1e_fb_motion(&fb->Private, fb->Axis, fb->Execute, FALSE, &command);
    fb->Done = out.done;
    FB_SHOW_ACTIVE(fb, out);
}
