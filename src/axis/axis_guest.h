/**
 * @file axis_guest.h
 * For those that act on an axis beside the program, as a person does through the control socket. The program has
 * precedence: its commands abort those of a guest, its MC_Power takes the power over, and an axis for which it has
 * called MC_Power is never enabled by a guest. In the cycle thread, after cm1e_axis_outputs(): it acts in the next
 * cycle.
 */
#ifndef CM1E_AXIS_AXIS_GUEST_H
#define CM1E_AXIS_AXIS_GUEST_H

#include "axis/axis_api.h"

/** Why a guest may not act on an axis. */
typedef enum cm1e_guest_refusal {
    CM1E_GUEST_MAY = 0,
    CM1E_GUEST_NO_MOTOR,   /**< an encoder */
    CM1E_GUEST_COMMANDED,  /**< a command of the program, or what one has left behind, moves it */
    CM1E_GUEST_FOLLOWED,   /**< another axis follows it, and would move too */
    CM1E_GUEST_GROUPED,    /**< it belongs to an axes group of the program */
    CM1E_GUEST_POWER,      /**< the program decides on its power: it has called MC_Power */
    CM1E_GUEST_MODE,       /**< behind a bridge, the motor is in a mode from which no way leads to motion */
} cm1e_guest_refusal_t;

/** Whether a guest may move it, or change its state; `own` is the guest's active command, 0: none. @rt cycle */
CM1E_GUEST_API cm1e_guest_refusal_t cm1e_axis_guest_may(const cm1e_axis_t *axis, cm1e_command_id_t own);
/** Enables it, or lets go of it: then it ramps down and loses its torque. Letting go of what the guest has not enabled
 *  changes nothing. @rt cycle */
CM1E_GUEST_API cm1e_guest_refusal_t cm1e_axis_guest_power(cm1e_axis_t *axis, bool enable);
/** The guest has enabled it, and the program has not taken it over. @rt cycle */
CM1E_GUEST_API bool cm1e_axis_guest_powers(const cm1e_axis_t *axis);
/** Moves with `velocity` (u/s, signed), to the software limit if there is one; acceleration 0: the axis's. Errors as
 *  cm1e_axis_start(), and CM1E_ERROR_AXIS_POSITION_RANGE: it is at that limit. @rt cycle */
CM1E_GUEST_API cm1e_error_t cm1e_axis_guest_jog(cm1e_axis_t *axis, double velocity, double acceleration,
                                                cm1e_command_id_t *id);
/** Homes as configured. @rt cycle */
CM1E_GUEST_API cm1e_error_t cm1e_axis_guest_home(cm1e_axis_t *axis, cm1e_command_id_t *id);
/** Ends the guest's command `*id`, if it is still active, by a halt with `deceleration` (0: the axis's), a homing by a
 *  stop. `*id` is the command that ends it then, or 0. @rt cycle */
CM1E_GUEST_API void cm1e_axis_guest_end(cm1e_axis_t *axis, double deceleration, cm1e_command_id_t *id);
/** The command is still active. @rt cycle */
CM1E_GUEST_API bool cm1e_axis_guest_runs(const cm1e_axis_t *axis, cm1e_command_id_t id);
/** As MC_Reset; the axis tells when it is done. @rt cycle */
CM1E_GUEST_API void cm1e_axis_guest_reset(cm1e_axis_t *axis);

/** MC_Power is called for this axis, enabling or not: the program decides on its power from now on. @rt cycle */
void cm1e_axis_claim_power(AXIS_REF_t reference);

#endif
