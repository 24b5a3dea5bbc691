/**
 * @file axis_power.h
 * MC_Power, errors and their reset (axis_power.c).
 */
#ifndef CM1E_AXIS_AXIS_POWER_H
#define CM1E_AXIS_AXIS_POWER_H

#include "axis/axis.h"
#include "axis/axis_guard.h"

typedef struct power {
    bool enable, enable_positive, enable_negative;
    bool energized;                 /**< the axis has taken over the enabled drive */
    bool shutting_down;
    bool reset_sent;
    cm1e_error_t reset_error;
    cm1e_command_state_t reset_state;
    const void *owner;
    int64_t free_ns;                /**< since when no torque is asked for */
    int64_t brake_until_ns;         /**< so long at least the torque stays to brake */
} power_t;

/** Why the axis is in ErrorStop. */
typedef struct fault {
    cm1e_error_t error;
    uint16_t device_error;
    double value, bound;            /**< numbers for the text */
    guard_t guard;                  /**< with CM1E_ERROR_AXIS_COUPLING_LIMIT */
} fault_t;

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
