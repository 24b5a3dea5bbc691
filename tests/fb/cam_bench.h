/**
 * @file cam_bench.h
 * MC_DigitalCamSwitch on an axis that is where the test says. Include it once in a test program.
 */
#ifndef CM1E_TESTS_CAM_BENCH_H
#define CM1E_TESTS_CAM_BENCH_H

#include <math.h>

#include "axis/axis_signals.h"
#include "fake_axis.h"
#include "quick_check.h"

#define MS INT64_C(1000000)

/* ---- what the block asks the axis -------------------------------------------------------------------------------- */

static TIME now_ns;
static cm1e_axis_measures_t measures;
static struct {
    int axis, number;
    bool value;
    int64_t keep_ns;
    unsigned writes;
    cm1e_error_t error;
    cm1e_error_t told; /* the last one of which the axis was told, and its output */
    int told_number;
} output;
static struct {
    cm1e_cam_switch_input_t input;
    int number;
    double value;
    unsigned count, right;
} refused; /* the last switch */

int64_t cm1e_axis_time(const cm1e_axis_t *axis)
{
    (void)axis;
    return now_ns;
}
cm1e_axis_measures_t cm1e_axis_measures(const cm1e_axis_t *axis)
{
    (void)axis;
    return measures;
}
cm1e_error_t cm1e_axis_hold_output(cm1e_axis_t *axis, int number, bool value, int64_t keep_ns)
{
    if (output.error)
        return output.error;
    output.axis = (int)(axis - fake_axes);
    output.number = number;
    output.value = value;
    output.keep_ns = keep_ns;
    output.writes++;
    return CM1E_OK;
}
void cm1e_axis_tell_output(cm1e_axis_t *axis, cm1e_error_t error, int number)
{
    (void)axis;
    output.told = error;
    output.told_number = number;
}
void cm1e_axis_refuse_cam_switch(cm1e_axis_t *axis, cm1e_cam_switch_input_t input, int number, double value)
{
    (void)axis;
    refused.input = input;
    refused.number = number;
    refused.value = value;
    refused.count++;
}
void cm1e_axis_cam_switches_right(cm1e_axis_t *axis)
{
    (void)axis;
    refused.right++;
}
void cm1e_axis_output_off(cm1e_axis_t *axis, int number) { (void)cm1e_axis_hold_output(axis, number, false, -1); }

/* ---- the axis ---------------------------------------------------------------------------------------------------- */

static AXIS_REF_t reference = {1};
static MC_CAMSWITCH_REF cams;
static MC_TRACK_REF tracks;
static MC_OUTPUT_REF outputs;
static MC_DigitalCamSwitch_t fb;
static double position, velocity; /* u, u/s */

static inline void fresh(double modulo_range)
{
    fake_reset();
    now_ns = 1000 * MS;
    measures = (cm1e_axis_measures_t){.resolution = 0.001, .modulo_range = modulo_range, .max_velocity = 50000.0};
    memset(&output, 0, sizeof output);
    memset(&cams, 0, sizeof cams);
    memset(&tracks, 0, sizeof tracks);
    memset(&outputs, 0, sizeof outputs);
    fb = (MC_DigitalCamSwitch_t){.Axis = &reference, .Switches = &cams, .Outputs = &outputs, .TrackOptions = &tracks,
                                 .Enable = TRUE, .EnableMask = 0xFFFFFFFF};
    position = velocity = 0.0;
}

static inline MC_CAMSWITCH *add(int track, double first, double last)
{
    MC_CAMSWITCH *cam = &cams.Switches[cams.NumberOfSwitches++];
    *cam = (MC_CAMSWITCH){.TrackNumber = (INT)track, .FirstOnPosition = first, .LastOnPosition = last};
    return cam;
}

static inline void call(void)
{
    const double range = measures.modulo_range;
    const double shown = range > 0.0 ? position - floor(position / range) * range : position;
    fake_axes[0].info.set_position = fake_axes[0].info.actual_position = shown;
    fake_axes[0].info.set_velocity = fake_axes[0].info.actual_velocity = velocity;
    MC_DigitalCamSwitch(&fb);
    if (fb.InOperation + fb.Error > 1 || (fb.InOperation && !fb.Busy) || (!fb.InOperation && outputs.Values))
        ck_abort_msg("InOperation %d Busy %d Error %d, %X", fb.InOperation, fb.Busy, fb.Error, outputs.Values);
}

/** One scan of a millisecond at the present velocity. */
static inline DWORD step(void)
{
    now_ns += MS;
    position += velocity * 1e-3;
    call();
    return outputs.Values;
}

static inline void at(double to, double with)
{
    position = to;
    velocity = with;
    now_ns += MS;
    call();
}

#endif
