#include <math.h>

#include "axis/axis_signals.h"
#include "edge.h"

/* The measured velocity is noisy: a change below this share of the axis maximum, or below this number of counts/s, is
 * ignored. A change is shown for this time. */
static const double dead_share = 0.005, dead_counts_per_s = 2000.0;
static const TIME change_ns = 50000000;

static void show(MC_ReadMotionState_t *fb, double velocity, bool accelerating, bool decelerating)
{
    fb->Accelerating = accelerating;
    fb->Decelerating = decelerating;
    fb->ConstantVelocity = !accelerating && !decelerating;
    fb->DirectionPositive = velocity > 0.0;
    fb->DirectionNegative = velocity < 0.0;
}

/** The set-point knows its acceleration. */
static void show_set(MC_ReadMotionState_t *fb, const cm1e_axis_info_t *info)
{
    const double v = info->set_velocity, a = info->set_acceleration;
    show(fb, v, v * a > 0.0 || (v == 0.0 && a != 0.0), v * a < 0.0);
}

/** The speed moves a reference with a dead band. While the reference has risen within the last moment, the axis
 *  accelerates; while it has fallen, the axis decelerates. Noise within the dead band has no effect. */
static void show_actual(MC_ReadMotionState_t *fb, const cm1e_axis_t *axis, const cm1e_axis_info_t *info, bool begins)
{
    cm1e_motion_private_t *p = &fb->Private;
    const cm1e_axis_measures_t measures = cm1e_axis_measures(axis);
    const double band = fmax(dead_share * measures.max_velocity, dead_counts_per_s * measures.resolution);
    const double speed = fabs(info->actual_velocity);
    const TIME now = cm1e_axis_time(axis);
    if (begins) {
        p->reference = speed;
        p->changed = now - change_ns;
    }
    if (fabs(speed - p->reference) > band) {
        p->rising = speed > p->reference;
        p->reference = p->rising ? speed - band : speed + band;
        p->changed = now;
    }
    const bool changing = now - p->changed < change_ns;
    show(fb, speed > band ? info->actual_velocity : 0.0, changing && p->rising, changing && !p->rising);
}

void MC_ReadMotionState(MC_ReadMotionState_t *fb)
{
    cm1e_axis_info_t info = {0};
    cm1e_motion_private_t *p = &fb->Private;
    const cm1e_axis_t *axis = cm1e_fb_enable(&p->common, fb->Axis, fb->Enable);
    cm1e_error_t error = CM1E_OK;
    show(fb, 0.0, false, false);
    fb->ConstantVelocity = FALSE;
    if (axis) {
        cm1e_axis_get(axis, &info);
        if ((unsigned)fb->Source > mcCommandedValue)
            error = cm1e_axis_refuse_level(cm1e_fb_axis(&p->common), CM1E_ERROR_INVALID_ARGUMENT,
                                           "MC_ReadMotionState: Source", (int)fb->Source,
                                           "0 (mcSetValue), 1 (mcActualValue) or 2 (mcCommandedValue)",
                                           fb->ErrorID != cm1e_error_id(CM1E_ERROR_INVALID_ARGUMENT));
        else if (fb->Source == mcActualValue && !info.online)
            error = CM1E_ERROR_AXIS_OFFLINE;
    }
    const fb_reading_t out = cm1e_fb_reading(&p->common, axis, error);
    if (out.valid && fb->Source == mcActualValue)
        show_actual(fb, axis, &info, !p->measuring);
    else if (out.valid)
        show_set(fb, &info);
    p->measuring = out.valid && fb->Source == mcActualValue;
    fb_reads_right(&p->common, fb->ErrorID, out.error);
    FB_SHOW_READING(fb, out);
}
