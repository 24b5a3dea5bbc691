#include "coupling_block.h"

fb_outputs_t cm1e_fb_couple(cm1e_coupling_private_t *fb, const AXIS_REF_t *slave, BOOL execute, BOOL continuous_update,
                            const cm1e_axis_command_t *command)
{
    const cm1e_coupling_master_t *masters = command->coupling->master;
    if (fb->common.state != FB_BUSY) { /* so they are those of the edge while the block is busy */
        fb->master = masters[0].axis.Handle;
        fb->second_master = masters[1].axis.Handle;
    }
    const bool same = masters[0].axis.Handle == fb->master && masters[1].axis.Handle == fb->second_master;
    return cm1e_fb_motion(&fb->common, same ? slave : NULL, execute, continuous_update, command);
}

fb_outputs_t cm1e_fb_decouple(cm1e_fb_private_t *fb, const AXIS_REF_t *slave, BOOL execute, cm1e_command_kind_t kind)
{
    const cm1e_axis_command_t command = {.kind = kind};
    cm1e_command_status_t status;
    cm1e_axis_t *axis = NULL;
    switch (cm1e_fb_execute(fb, slave, execute, &axis)) {
    case FB_STEP_START: cm1e_fb_started(fb, cm1e_axis_start(axis, &command, &fb->command)); break;
    case FB_STEP_POLL:
        status = cm1e_axis_command_status(axis, fb->command);
        cm1e_fb_polled_or_cancelled(fb, status.state, status.error);
        break;
    case FB_STEP_NONE: break;
    }
    return cm1e_fb_outputs(fb);
}
