#include "bridge/cool_muscle.h"
#include "edge.h"

static const cm1e_drive_cmd_t commands[] = {
    [cmMotorFree] = CM1E_DRIVE_CMD_MOTOR_FREE, [cmMotorEnable] = CM1E_DRIVE_CMD_MOTOR_ENABLE,
    [cmOriginSearch] = CM1E_DRIVE_CMD_ORIGIN_SEARCH, [cmResetCounter] = CM1E_DRIVE_CMD_RESET_COUNTER,
    [cmOriginSearchAbort] = CM1E_DRIVE_CMD_ORIGIN_SEARCH_ABORT,
};

static cm1e_error_t start(CM_Command_t *fb, cm1e_axis_t *axis)
{
    uint32_t ticket = 0;
    const cm1e_error_t error = (unsigned)fb->Command > cmOriginSearchAbort
                                   ? cm1e_axis_refuse_input(axis, CM1E_ERROR_INVALID_ARGUMENT, "CM_Command: Command",
                                                            (int)fb->Command, "0 ... 4")
                                   : cm1e_axis_motor_command(axis, commands[fb->Command], fb->Timeout, &ticket);
    fb->Private.command = ticket;
    return error;
}

static void poll(CM_Command_t *fb, const cm1e_axis_t *axis)
{
    cm1e_error_t error;
    const cm1e_command_state_t state = cm1e_axis_motor_command_state(axis, fb->Private.command, &error);
    cm1e_fb_polled_or_cancelled(&fb->Private, state, error);
}

void CM_Command(CM_Command_t *fb)
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
