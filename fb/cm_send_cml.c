#include <string.h>

#include "bridge/cool_muscle.h"
#include "edge.h"

/** The block has no CommandAborted: a string that the axis no longer remembers is an error. */
static void poll(CM_SendCML_t *fb, const cm1e_axis_t *axis)
{
    const cm1e_axis_cml_t sent = cm1e_axis_cml_state(axis, fb->Private.command);
    if (sent.state == CM1E_COMMAND_UNKNOWN)
        cm1e_fb_fail(&fb->Private, CM1E_ERROR_CANCELLED);
    else
        cm1e_fb_polled(&fb->Private, sent.state, sent.error);
}

static void show_answer(CM_SendCML_t *fb, const cm1e_axis_t *axis)
{
    const cm1e_axis_cml_t sent = cm1e_axis_cml_state(axis, fb->Private.command);
    const char *line = cm1e_axis_cml_line(axis, fb->Private.command, fb->Line > 0 ? (unsigned)fb->Line - 1 : 0);
    const size_t size = line ? strnlen(line, sizeof fb->Response - 1) : 0;
    if (line)
        memcpy(fb->Response, line, size);
    fb->Response[size] = '\0';
    fb->Lines = (INT)sent.lines;
    fb->Strays = sent.strays < INT16_MAX ? (INT)sent.strays : INT16_MAX;
}

void CM_SendCML(CM_SendCML_t *fb)
{
    cm1e_axis_t *axis = NULL;
    uint32_t ticket = 0;
    switch (cm1e_fb_execute(&fb->Private, fb->Axis, fb->Execute, &axis)) {
    case FB_STEP_START:
        cm1e_fb_started(&fb->Private, cm1e_axis_cml_send(axis, fb->Command, sizeof fb->Command, fb->Timeout,
                                                         fb->AllowMotion != FALSE, &ticket));
        fb->Private.command = ticket;
        break;
    case FB_STEP_POLL: poll(fb, axis); break;
    case FB_STEP_NONE: break;
    }
    const fb_outputs_t out = cm1e_fb_outputs(&fb->Private);
    FB_SHOW_DONE(fb, out);
    axis = out.done || out.error ? cm1e_fb_axis(&fb->Private) : NULL;
    if (axis) {
        show_answer(fb, axis);
    } else {
        fb->Response[0] = '\0';
        fb->Lines = fb->Strays = 0;
    }
}
