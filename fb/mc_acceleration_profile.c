#include "edge.h"

static void pair(const void *reference, int index, TIME *delta_ns, LREAL *value)
{
    const MC_TA *pair = &((const MC_TA_REF *)reference)->MC_TA_Array[index];
    *delta_ns = pair->DeltaTime;
    *value = pair->Acceleration;
}

void MC_AccelerationProfile(MC_AccelerationProfile_t *fb)
{
    const MC_TA_REF *reference = fb->TimeAcceleration;
    const cm1e_axis_table_t table = {
        .read = reference ? pair : NULL,
        .reference = reference,
        .count = reference ? reference->NumberOfPairs : 0,
        .absolute = reference && reference->IsAbsolute,
        .time_scale = fb->TimeScale,
        .scale = fb->AccelerationScale,
        .offset = fb->Offset,
    };
    const cm1e_axis_command_t command = {
        .kind = CM1E_COMMAND_ACCELERATION_PROFILE,
        .buffer_mode = fb->BufferMode,
        .table = &table,
    };
    /* A motion that is locked to time has nothing that could be changed on the way. */
    const cm1e_error_t refusal = fb->ContinuousUpdate ? CM1E_ERROR_UNSUPPORTED : CM1E_OK;
    const fb_outputs_t out = fb_motion_unless(refusal, &fb->Private, fb->Axis, fb->Execute, FALSE, &command);
    fb->ProfileCompleted = out.reached;
    FB_SHOW_ACTIVE(fb, out);
}
