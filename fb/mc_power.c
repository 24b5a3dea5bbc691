#include <stddef.h>
#include <string.h>

#include "axis/axis_guest.h"
#include "core/in_task.h"
#include "edge.h"

/** Enable is a level for the power stage, not for the block (3.1). The axis is latched at Enable's rising edge, and
 *  this block controls it until the power stage is off. Another axis meanwhile is an error of the block, but the
 *  latched axis goes on following Enable, so that the program can still switch it off. */
static void release(cm1e_fb_private_t *fb)
{
    fb->axis_handle = 0;
    fb->state = FB_IDLE;
}

static void take(cm1e_fb_private_t *fb, const AXIS_REF_t *reference)
{
    release(fb);
    fb->axis_handle = reference ? reference->Handle : 0;
    if (cm1e_fb_axis(fb))
        fb->state = FB_BUSY;
    else
        cm1e_fb_fail(fb, CM1E_ERROR_FB_AXIS_REF);
}

/** The power stage cannot switch on, and the error of the axis says why. This error ends by itself after MC_Reset
 *  (2.2.3, figure 5). */
static cm1e_error_t reason_for_no_power(const cm1e_axis_t *axis)
{
    cm1e_axis_info_t info;
    cm1e_axis_get(axis, &info);
    return info.state == CM1E_AXIS_ERROR_STOP ? info.error : CM1E_OK;
}

/** Passes the inputs to the axis. Returns an error that may end by itself. */
static cm1e_error_t follow_inputs(MC_Power_t *fb, cm1e_axis_t *axis)
{
    const cm1e_error_t error = cm1e_axis_power(axis, fb, fb->Enable, fb->EnablePositive, fb->EnableNegative);
    if (error == CM1E_ERROR_FB_SECOND_POWER) {
        release(&fb->Private);
        if (fb->Enable)
            cm1e_fb_fail(&fb->Private, error);
        return CM1E_OK;
    }
    fb->Status = cm1e_axis_powered(axis);
    if (!fb->Enable)
        return CM1E_OK;
    return error != CM1E_OK || fb->Status ? error : reason_for_no_power(axis);
}

/** All inputs but the axis, and all outputs, as one number. */
static inline uint64_t shown(const MC_Power_t *fb)
{
    uint64_t word;
    enum { FROM = offsetof(MC_Power_t, Enable), TO = offsetof(MC_Power_t, ErrorID) + sizeof fb->ErrorID };
    _Static_assert(TO - FROM == sizeof word, "they fill a word");
    memcpy(&word, (const char *)fb + FROM, sizeof word);
    return word;
}

/** Nothing has changed since the last call, which is the usual case: the outputs do not change. */
static inline bool stands(const MC_Power_t *fb)
{
    return CM1E_USUALLY(fb->Enable && fb->Axis && fb->Axis->Handle == fb->Private.axis_handle &&
                        cm1e_axis_power_settled(*fb->Axis, fb, shown(fb)));
}

CM1E_RARE static void work(MC_Power_t *fb)
{
    cm1e_in_task_gate();
    cm1e_fb_private_t *private = &fb->Private;
    cm1e_error_t passing = CM1E_OK;
    if (fb->Enable && !private->trigger_before)
        take(private, fb->Axis);
    else if (!fb->Enable && fb->Axis)
        cm1e_axis_claim_power(*fb->Axis);
    private->trigger_before = fb->Enable ? TRUE : FALSE;
    fb->Status = FALSE;
    cm1e_axis_t *axis = cm1e_fb_axis(private);
    if (axis)
        passing = follow_inputs(fb, axis);
    if (!fb->Enable && !fb->Status)
        release(private);
    else if (private->state == FB_BUSY && (!fb->Axis || fb->Axis->Handle != private->axis_handle))
        cm1e_fb_fail(private, axis ? CM1E_ERROR_FB_AXIS_CHANGED : CM1E_ERROR_FB_AXIS_REF);
    const bool failed = private->state == FB_ERROR;
    fb->Error = fb->Enable && (failed || passing != CM1E_OK);
    fb->Valid = fb->Enable && !fb->Error;
    fb->ErrorID = fb->Error ? (failed ? private->error_id : cm1e_error_id(passing)) : 0;
    if (axis && fb->Valid && fb->Status)
        cm1e_axis_power_settle(axis, fb, shown(fb));
}

void MC_Power(MC_Power_t *fb)
{
    if (!stands(fb))
        work(fb);
}
