#include "axis/axis_signals.h"
#include "edge.h"

void MC_ReadActualTorque(MC_ReadActualTorque_t *fb)
{
    double torque = 0.0;
    cm1e_error_t error = CM1E_OK;
    const cm1e_axis_t *axis = cm1e_fb_enable(&fb->Private, fb->Axis, fb->Enable);
    if (axis)
        error = cm1e_axis_read_torque(axis, &torque);
    const fb_reading_t out = cm1e_fb_reading(&fb->Private, axis, error);
    FB_SHOW_READING(fb, out);
    fb->Torque = out.valid ? torque : 0.0;
}
