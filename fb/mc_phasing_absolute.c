#include "coupling_block.h"

void MC_PhasingAbsolute(MC_PhasingAbsolute_t *fb)
{
    const cm1e_axis_coupling_t coupling = {.master = {{.axis = fb_master(fb->Master)}}};
    const cm1e_axis_command_t command = {
        .kind = CM1E_COMMAND_PHASING_ABSOLUTE,
        .position = fb->PhaseShift,
        .velocity = fb->Velocity,
        FB_DYNAMICS(fb),
        .buffer_mode = fb->BufferMode,
        .coupling = &coupling,
    };
    const BOOL busy_before = fb->Busy;
    const fb_outputs_t out = cm1e_fb_couple(&fb->Private, fb->Slave, fb->Execute, FALSE, &command);
    if (busy_before || out.busy) /* the value at the end stays readable */
        fb->AbsolutePhaseShift = out.covered;
    fb->Done = out.done;
    FB_SHOW_ACTIVE(fb, out);
}
