/**
 * @file axis_power.h
 * MC_Power, errors and their reset (axis_power.c).
 */
#ifndef CM1E_AXIS_AXIS_POWER_H
#define CM1E_AXIS_AXIS_POWER_H

#include "axis/axis_parts.h"

static inline void cm1e_axis_power_init(cm1e_axis_t *axis) { axis->power.reset_state = CM1E_COMMAND_DONE; }
/** Called when something of the power changes: its owner looks anew. */
static inline void cm1e_axis_power_unsettle(cm1e_axis_t *axis) { axis->power.settled = 0; }
/** Called when the drive may show another state. */
void cm1e_axis_power_check(cm1e_axis_t *axis);
/** Adds the drive's code of the fault, which may come a cycle later. */
static inline void cm1e_axis_tell_device_error(cm1e_axis_t *axis, uint16_t code) { axis->fault.device_error = code; }
static inline bool cm1e_axis_wants_enable(const cm1e_axis_t *axis)
{
    return axis->power.enable && !axis->power.shutting_down && axis->state != CM1E_AXIS_ERROR_STOP &&
           (!axis->motor_hooks || axis->motor_hooks->is_home(axis));
}
void cm1e_axis_become_free(cm1e_axis_t *axis); /* axis_free.c */
/** Called at the end of a motion or homing of the drive that power off has stopped. If power is wanted again by now,
 *  the torque goes all the same before it comes back: with torque the drive would go on in the mode of that motion, or
 *  jump to its target in the mode of the axis. */
void cm1e_axis_let_go(cm1e_axis_t *axis); /* axis_free.c */
void cm1e_axis_error_stop(cm1e_axis_t *axis, cm1e_error_t error, double value, double bound,
                          const cm1e_motion_limits_t *ramp);
/** Begins the ramp of ErrorStop anew, from the actual position and velocity of the motor. */
void cm1e_axis_brake_from_actual(cm1e_axis_t *axis);
/** Whether a motor that turned when it got its torque is brought to rest by a set-point that stands: it has become no
 *  faster since, and may be as far from there as it takes. @rt cycle */
bool cm1e_axis_catches(const cm1e_axis_t *axis);
/** Called when the set velocity falls by `velocity` (u/s) at once: the torque stays until the motor has had time to
 *  follow. */
void cm1e_axis_keep_torque(cm1e_axis_t *axis, double velocity);
/** Called when the bus is lost. In CSP the set-point stays, with torque for as long as the ramp of an error takes. So a
 *  drive stops at the same place whether it still receives frames or not. */
void cm1e_axis_hold_unheard(cm1e_axis_t *axis);
void cm1e_axis_power_step(cm1e_axis_t *axis);
void cm1e_axis_enable_step(cm1e_axis_t *axis);
void cm1e_axis_reset_step(cm1e_axis_t *axis); /* while a reset is under way */

#endif
