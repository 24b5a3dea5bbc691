/**
 * @file trigger.h
 * Converts MC_TRIGGER_REF for the axis; used by MC_TouchProbe and MC_AbortTrigger.
 */
#ifndef CM1E_FB_TRIGGER_H
#define CM1E_FB_TRIGGER_H

#include "axis/axis_signals.h"
#include "edge.h"

/** NULL selects the rising edge of input 1. An input of another motor is CM1E_ERROR_UNSUPPORTED, because it is sampled
 *  at another moment. */
static inline cm1e_error_t fb_trigger(cm1e_axis_t *axis, const MC_TRIGGER_REF *reference, const cm1e_fb_private_t *fb,
                                      cm1e_axis_trigger_t *trigger)
{
    *trigger = (cm1e_axis_trigger_t){.input = 1};
    if (!reference)
        return CM1E_OK;
    if (reference->Axis.Handle && reference->Axis.Handle != fb->axis_handle)
        return cm1e_axis_refuse_input(axis, CM1E_ERROR_UNSUPPORTED, "TriggerInput.Axis", reference->Axis.Handle,
                                      "the Axis of the block, or a Handle of 0,");
    if (reference->InputNumber)
        trigger->input = reference->InputNumber;
    trigger->falling = reference->FallingEdge != FALSE;
    return CM1E_OK;
}

#endif
