/**
 * @file axis_power.h
 * MC_Power, errors and their reset (axis_power.c).
 */
#ifndef CM1E_AXIS_AXIS_POWER_H
#define CM1E_AXIS_AXIS_POWER_H

#include "axis/axis_parts.h"

static inline void cm1e_axis_power_init(cm1e_axis_t *axis) { axis->power.reset_state = CM1E_COMMAND_DONE; }
/** The drive's own code of the fault may come a cycle later. */
static inline void cm1e_axis_tell_device_error(cm1e_axis_t *axis, uint16_t code) { axis->fault.device_error = code; }
static inline bool cm1e_axis_wants_enable(const cm1e_axis_t *axis)
{
    return axis->power.enable && !axis->power.shutting_down && axis->state != CM1E_AXIS_ERROR_STOP &&
           (!axis->motor_hooks || axis->motor_hooks->is_home(axis));
}
void cm1e_axis_become_free(cm1e_axis_t *axis); /* axis_free.c */
void cm1e_axis_error_stop(cm1e_axis_t *axis, cm1e_error_t error, double value, double bound,
                          const cm1e_motion_limits_t *ramp);
/** A ramp of ErrorStop begins anew, from the motor's own position and speed. */
void cm1e_axis_brake_from_actual(cm1e_axis_t *axis);
/** The set velocity falls by `velocity` (u/s) at once: the torque stays until the motor has had time to follow. */
void cm1e_axis_keep_torque(cm1e_axis_t *axis, double velocity);
/** The bus is lost. In CSP the set-point stays where it is, under torque for as long as the ramp of an error would take:
 *  a drive that still hears, and one that does not, both stop there. */
void cm1e_axis_hold_unheard(cm1e_axis_t *axis);
void cm1e_axis_power_step(cm1e_axis_t *axis);
void cm1e_axis_enable_step(cm1e_axis_t *axis);
void cm1e_axis_reset_step(cm1e_axis_t *axis); /* while a reset is under way */

#endif
