#include "parameter.h"

/** Reads an object of the drive repeatedly: a transfer always waits or runs. */
static cm1e_error_t read_object(cm1e_fb_private_t *fb, cm1e_axis_t *axis, INT number, fb_parameter_t *shown)
{
    double value;
    cm1e_error_t error = CM1E_OK;
    const bool asked = fb->command && cm1e_axis_object_number(fb->command) == number;
    const cm1e_command_state_t state = asked ? cm1e_axis_object_state(axis, fb->command, &value, &error)
                                             : CM1E_COMMAND_UNKNOWN;
    if (state == CM1E_COMMAND_BUFFERED || state == CM1E_COMMAND_ACTIVE)
        return CM1E_OK;
    shown->valid = state == CM1E_COMMAND_DONE;
    if (shown->valid)
        shown->value = value;
    DWORD ticket;
    const cm1e_error_t refused = shown->error_id ? cm1e_axis_object_read_again(axis, number, &ticket)
                                                 : cm1e_axis_object_start(axis, number, false, 0.0, &ticket);
    if (refused == CM1E_OK)
        fb->command = ticket; /* the queue is full: try again in the next call */
    return error != CM1E_OK ? error : refused == CM1E_ERROR_FULL ? CM1E_OK : refused;
}

static cm1e_error_t refuse_number(cm1e_axis_t *axis, INT number, bool boolean, const fb_parameter_t *shown)
{
    const cm1e_error_t error = CM1E_ERROR_AXIS_PARAMETER;
    return cm1e_axis_refuse_level(axis, error,
                                  boolean ? "MC_ReadBoolParameter: ParameterNumber"
                                          : "MC_ReadParameter: ParameterNumber",
                                  number, boolean ? "4, 5, 6, 1800 or 1804" : CM1E_PARAMETER_NUMBERS,
                                  shown->error_id != cm1e_error_id(error));
}

static cm1e_error_t read(cm1e_fb_private_t *fb, cm1e_axis_t *axis, INT number, bool boolean, fb_parameter_t *shown)
{
    if (boolean && !cm1e_axis_parameter_is_bool(number))
        return refuse_number(axis, number, true, shown);
    if (cm1e_axis_parameter_is_object(number))
        return read_object(fb, axis, number, shown);
    const cm1e_error_t error = cm1e_axis_read_parameter(axis, number, &shown->value);
    shown->valid = error == CM1E_OK;
    return error == CM1E_ERROR_AXIS_PARAMETER ? refuse_number(axis, number, false, shown) : error;
}

void cm1e_fb_read_parameter(cm1e_fb_private_t *fb, const AXIS_REF_t *reference, BOOL enable, INT number, bool boolean,
                            fb_parameter_t *shown)
{
    const bool edge = enable && !fb->trigger_before;
    const bool readable = cm1e_fb_enable(fb, reference, enable) != NULL;
    /* The error of a wrong number or of a refusal by the drive ends by itself or with another number, so Busy stays
     * TRUE (2.2.3). */
    cm1e_error_t error = CM1E_OK;
    if (edge || !readable) {
        fb->command = 0;
        shown->valid = FALSE;
    }
    if (readable)
        error = read(fb, cm1e_fb_axis(fb), number, boolean, shown);
    const fb_outputs_t out = cm1e_fb_outputs(fb);
    shown->busy = out.busy;
    shown->error = out.error || error != CM1E_OK;
    fb_reads_right(fb, shown->error_id, shown->error);
    shown->error_id = error != CM1E_OK ? cm1e_error_id(error) : out.error_id;
    if (shown->error)
        shown->valid = FALSE;
    if (!shown->valid)
        shown->value = 0.0;
}

static cm1e_error_t start(cm1e_fb_private_t *fb, cm1e_axis_t *axis, INT number, bool boolean, LREAL value)
{
    fb->command = 0;
    if (boolean && !cm1e_axis_parameter_is_bool(number))
        return cm1e_axis_refuse_input(axis, CM1E_ERROR_AXIS_PARAMETER, "MC_WriteBoolParameter: ParameterNumber", number,
                                      "4, 5, 6 or 1804");
    if (!cm1e_axis_parameter_is_object(number))
        return cm1e_axis_write_parameter(axis, number, value);
    return cm1e_axis_object_start(axis, number, true, value, &fb->command);
}

/** A block that was not called for a long time may have lost its result. */
static void poll_object(cm1e_fb_private_t *fb, const cm1e_axis_t *axis)
{
    double written;
    cm1e_error_t error;
    const cm1e_command_state_t state = cm1e_axis_object_state(axis, fb->command, &written, &error);
    if (state == CM1E_COMMAND_UNKNOWN)
        cm1e_fb_polled(fb, CM1E_COMMAND_ERROR, CM1E_ERROR_CANCELLED);
    else
        cm1e_fb_polled(fb, state, error);
}

fb_outputs_t cm1e_fb_write_parameter(cm1e_fb_private_t *fb, const AXIS_REF_t *reference, BOOL execute, INT number,
                                     bool boolean, LREAL value, MC_EXECUTION_MODE mode)
{
    cm1e_axis_t *axis = NULL;
    cm1e_error_t error;
    switch (cm1e_fb_execute(fb, reference, execute, &axis)) {
    case FB_STEP_START:
        error = fb_refuse_execution_mode(axis, mode);
        cm1e_fb_started(fb, error != CM1E_OK ? error : start(fb, axis, number, boolean, value));
        break;
    case FB_STEP_POLL:
        if (fb->command == 0) /* parameter of the axis: done at the edge, shown in the next call, as in all blocks */
            cm1e_fb_polled(fb, CM1E_COMMAND_DONE, CM1E_OK);
        else
            poll_object(fb, axis);
        break;
    case FB_STEP_NONE: break;
    }
    return cm1e_fb_outputs(fb);
}
