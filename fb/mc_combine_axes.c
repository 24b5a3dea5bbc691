#include "coupling_block.h"

/** In the standard both numbers have a sign. A ratio that is out of range becomes 0, which the axis refuses. */
static cm1e_coupling_master_t master(const AXIS_REF_t *axis, MC_SOURCE source, DINT numerator, DINT denominator)
{
    const int64_t signed_numerator = denominator < 0 ? -(int64_t)numerator : numerator;
    return (cm1e_coupling_master_t){
        .axis = fb_master(axis),
        .source = source,
        .numerator = signed_numerator > INT32_MAX ? 0 : (int32_t)signed_numerator,
        .denominator = denominator < 0 ? 0u - (uint32_t)denominator : (uint32_t)denominator,
    };
}

CM1E_APART static void work(MC_CombineAxes_t *fb)
{
    const cm1e_axis_coupling_t coupling = {
        .master = {master(fb->Master1, fb->MasterValueSourceM1, fb->GearRatioNumeratorM1, fb->GearRatioDenominatorM1),
                   master(fb->Master2, fb->MasterValueSourceM2, fb->GearRatioNumeratorM2, fb->GearRatioDenominatorM2)},
        .combine = fb->CombineMode,
    };
    const cm1e_axis_command_t command = {
        .kind = CM1E_COMMAND_COMBINE_AXES,
        .buffer_mode = fb->BufferMode,
        .coupling = &coupling,
    };
    const fb_outputs_t out = cm1e_fb_couple(&fb->Private, fb->Slave, fb->Execute, fb->ContinuousUpdate, &command);
    fb->InSync = out.reached;
    FB_SHOW_ACTIVE(fb, out);
}

void MC_CombineAxes(MC_CombineAxes_t *fb)
{
    const cm1e_following_t now = fb_follows(&fb->Private, fb->Slave, fb->Master1, fb->Master2, fb->Execute);
    if (now.follows)
        fb->InSync = now.reached;
    else
        work(fb);
}
