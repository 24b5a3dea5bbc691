#include "coupling_block.h"

/** TRUE in the first call after each end, also in a task that is slower than the bus cycle. */
static void show_ends(MC_CamIn_t *fb, UDINT ends)
{
    fb->EndOfProfile = ends > fb->Private.ends;
    fb->Private.ends = ends;
}

CM1E_APART static void work(MC_CamIn_t *fb)
{
    const cm1e_axis_coupling_t coupling = {
        .master = {{.axis = fb_master(fb->Master), .source = fb->MasterValueSource, .numerator = 1, .denominator = 1}},
        .master_sync_position = fb->MasterSyncPosition,
        .master_start_distance = fb->MasterStartDistance,
        .cam = fb->CamTableID,
        .start_mode = fb->StartMode,
        .master_offset = fb->MasterOffset,
        .slave_offset = fb->SlaveOffset,
        .master_scaling = fb->MasterScaling,
        .slave_scaling = fb->SlaveScaling,
    };
    const cm1e_axis_command_t command = {
        .kind = CM1E_COMMAND_CAM_IN,
        .buffer_mode = fb->BufferMode,
        .coupling = &coupling,
    };
    const fb_outputs_t out = cm1e_fb_couple(&fb->Private, fb->Slave, fb->Execute, fb->ContinuousUpdate, &command);
    fb->InSync = out.reached;
    show_ends(fb, out.ends);
    FB_SHOW_ACTIVE(fb, out);
}

void MC_CamIn(MC_CamIn_t *fb)
{
    const cm1e_following_t now = fb_follows(&fb->Private, fb->Slave, fb->Master, NULL, fb->Execute);
    if (now.follows) {
        fb->InSync = now.reached;
        show_ends(fb, now.ends);
    } else {
        work(fb);
    }
}
