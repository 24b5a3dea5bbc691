#include "edge.h"

static void pair(const void *reference, int index, TIME *delta_ns, LREAL *value)
{
    const MC_TP *pair = &((const MC_TP_REF *)reference)->MC_TP_Array[index];
    *delta_ns = pair->DeltaTime;
    *value = pair->Position;
}

void MC_PositionProfile(MC_PositionProfile_t *fb)
{
    if (FB_STANDS(fb))
        return;
    const cm1e_axis_table_t table = {
        FB_TABLE(fb->TimePosition, pair),
        .time_scale = fb->TimeScale,
        .scale = fb->PositionScale,
        .offset = fb->Offset,
    };
    const fb_outputs_t out = cm1e_fb_table_motion(&fb->Private, fb->Axis, fb->Execute, fb->ContinuousUpdate,
                                                  CM1E_COMMAND_POSITION_PROFILE, fb->BufferMode, &table);
    fb->Done = out.done;
    FB_SHOW_ACTIVE(fb, out);
}
