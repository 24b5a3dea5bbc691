#include "coupling_block.h"

CM1E_APART static void work(MC_GearInPos_t *fb)
{
    const cm1e_axis_coupling_t coupling = {
        .master = {{.axis = fb_master(fb->Master), .source = fb->MasterValueSource, .numerator = fb->RatioNumerator,
                    .denominator = fb->RatioDenominator}},
        .master_sync_position = fb->MasterSyncPosition,
        .slave_sync_position = fb->SlaveSyncPosition,
        .master_start_distance = fb->MasterStartDistance,
        .sync_mode = fb->SyncMode,
    };
    const cm1e_axis_command_t command = {
        .kind = CM1E_COMMAND_GEAR_IN_POS,
        .velocity = fb->Velocity,
        FB_DYNAMICS(fb),
        .buffer_mode = fb->BufferMode,
        .coupling = &coupling,
    };
    const fb_outputs_t out = cm1e_fb_couple(&fb->Private, fb->Slave, fb->Execute, FALSE, &command);
    fb->StartSync = out.synchronizing;
    fb->InSync = out.reached;
    FB_SHOW_ACTIVE(fb, out);
}

void MC_GearInPos(MC_GearInPos_t *fb)
{
    const cm1e_following_t now = fb_follows(&fb->Private, fb->Slave, fb->Master, NULL, fb->Execute);
    if (now.follows) {
        fb->StartSync = now.synchronizing;
        fb->InSync = now.reached;
    } else {
        work(fb);
    }
}
