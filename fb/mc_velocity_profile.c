#include "edge.h"

static void pair(const void *reference, int index, TIME *delta_ns, LREAL *value)
{
    const MC_TV *pair = &((const MC_TV_REF *)reference)->MC_TV_Array[index];
    *delta_ns = pair->DeltaTime;
    *value = pair->Velocity;
}

void MC_VelocityProfile(MC_VelocityProfile_t *fb)
{
    const cm1e_axis_table_t table = {
        FB_TABLE(fb->TimeVelocity, pair),
        .time_scale = fb->TimeScale,
        .scale = fb->VelocityScale,
        .offset = fb->Offset,
    };
    const fb_outputs_t out = cm1e_fb_table_motion(&fb->Private, fb->Axis, fb->Execute, fb->ContinuousUpdate,
                                                  CM1E_COMMAND_VELOCITY_PROFILE, fb->BufferMode, &table);
    fb->ProfileCompleted = out.reached;
    FB_SHOW_ACTIVE(fb, out);
}
