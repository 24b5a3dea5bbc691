#include "axis/axis_signals.h"
#include "edge.h"

/** Valid also while the drive is off the bus: CommunicationReady shows that, and the switches have their last
 *  values. */
void MC_ReadAxisInfo(MC_ReadAxisInfo_t *fb)
{
    cm1e_axis_info_t info = {0};
    cm1e_axis_condition_t condition = {0};
    const cm1e_axis_t *axis = cm1e_fb_enable(&fb->Private, fb->Axis, fb->Enable);
    if (axis) {
        cm1e_axis_want_switches(cm1e_fb_axis(&fb->Private));
        cm1e_axis_get(axis, &info);
        condition = cm1e_axis_condition(axis);
    }
    const fb_reading_t out = cm1e_fb_reading(&fb->Private, axis, CM1E_OK);
    FB_SHOW_READING(fb, out);
    fb->HomeAbsSwitch = axis && cm1e_axis_switch_active(axis, CM1E_SWITCH_HOME);
    fb->LimitSwitchPos = axis && cm1e_axis_switch_active(axis, CM1E_SWITCH_LIMIT_POSITIVE);
    fb->LimitSwitchNeg = axis && cm1e_axis_switch_active(axis, CM1E_SWITCH_LIMIT_NEGATIVE);
    fb->Simulation = condition.simulation;
    fb->CommunicationReady = condition.communication;
    fb->ReadyForPowerOn = condition.ready_for_power_on;
    fb->PowerOn = info.powered;
    fb->IsHomed = info.homed;
    fb->AxisWarning = condition.warning;
}
