/**
 * @file trigger.h
 * MC_TRIGGER_REF as the axis understands it, for MC_TouchProbe and MC_AbortTrigger.
 */
#ifndef CM1E_FB_TRIGGER_H
#define CM1E_FB_TRIGGER_H

#include "axis/axis_signals.h"
#include "edge.h"

/** NULL: input 1 goes on. An input of another motor is CM1E_ERROR_UNSUPPORTED: its inputs are of another moment. */
static inline cm1e_error_t fb_trigger(const MC_TRIGGER_REF *reference, const cm1e_fb_private_t *fb,
                                      cm1e_axis_trigger_t *trigger)
{
    *trigger = (cm1e_axis_trigger_t){.input = 1};
    if (!reference)
        return CM1E_OK;
    if (reference->Axis.Handle && reference->Axis.Handle != fb->axis_handle)
        return CM1E_ERROR_UNSUPPORTED;
    if (reference->InputNumber)
        trigger->input = reference->InputNumber;
    trigger->falling = reference->FallingEdge != FALSE;
    return CM1E_OK;
}

#endif
