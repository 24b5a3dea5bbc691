#include "edge.h"

static void pair(const void *reference, int index, TIME *delta_ns, LREAL *value)
{
    const MC_TA *pair = &((const MC_TA_REF *)reference)->MC_TA_Array[index];
    *delta_ns = pair->DeltaTime;
    *value = pair->Acceleration;
}

void MC_AccelerationProfile(MC_AccelerationProfile_t *fb)
{
    const cm1e_axis_table_t table = {
        FB_TABLE(fb->TimeAcceleration, pair),
        .time_scale = fb->TimeScale,
        .scale = fb->AccelerationScale,
        .offset = fb->Offset,
    };
    const fb_outputs_t out = cm1e_fb_table_motion(&fb->Private, fb->Axis, fb->Execute, fb->ContinuousUpdate,
                                                  CM1E_COMMAND_ACCELERATION_PROFILE, fb->BufferMode, &table);
    fb->ProfileCompleted = out.reached;
    FB_SHOW_ACTIVE(fb, out);
}
