#include "bridge/cool_muscle.h"
#include "edge.h"

static const cm1e_bridge_mode_t modes[] = {
    [cmCSP] = CM1E_BRIDGE_MODE_CSP, [cmCML] = CM1E_BRIDGE_MODE_CML, [cmCMD] = CM1E_BRIDGE_MODE_CMD,
    [cmCPIO] = CM1E_BRIDGE_MODE_CPIO,
};

static cm1e_error_t start(CM_SetMode_t *fb, cm1e_axis_t *axis)
{
    uint32_t ticket = 0;
    const cm1e_error_t error = (unsigned)fb->Mode > cmCPIO
                                   ? cm1e_axis_refuse_input(axis, CM1E_ERROR_INVALID_ARGUMENT, "CM_SetMode: Mode",
                                                            (int)fb->Mode, "0 ... 3")
                                   : cm1e_axis_set_mode(axis, modes[fb->Mode], fb->Insist != FALSE, &ticket);
    fb->Private.command = ticket;
    return error;
}

static void poll(CM_SetMode_t *fb, const cm1e_axis_t *axis)
{
    cm1e_error_t error;
    const cm1e_command_state_t state = cm1e_axis_set_mode_state(axis, fb->Private.command, &error);
    cm1e_fb_polled_or_cancelled(&fb->Private, state, error);
}

void CM_SetMode(CM_SetMode_t *fb)
{
    cm1e_axis_t *axis = NULL;
    switch (cm1e_fb_execute(&fb->Private, fb->Axis, fb->Execute, &axis)) {
    case FB_STEP_START: cm1e_fb_started(&fb->Private, start(fb, axis)); break;
    case FB_STEP_POLL: poll(fb, axis); break;
    case FB_STEP_NONE: break;
    }
    const fb_outputs_t out = cm1e_fb_outputs(&fb->Private);
    FB_SHOW_DONE(fb, out);
}
