/**
 * @file bridge/cool_muscle.h
 * What a motor behind a bridge does beside motion, for its blocks: strings in CML, modes of operation, commands of CMD.
 * They are accepted only while the axis is Disabled and no torque is commanded. A block polls its request by a ticket,
 * so it may vanish at any time. All @rt cycle. CM1E_ERROR_CM_NO_BRIDGE: the motor is a CM1-E.
 */
#ifndef CM1E_BRIDGE_COOL_MUSCLE_H
#define CM1E_BRIDGE_COOL_MUSCLE_H

#include "axis/axis_api.h"
#include "device/bridge_facts.h"
#include "drive/drive_command.h"

/** Adds these functions to an axis behind a bridge. Does nothing to another axis. @rt init */
cm1e_error_t cm1e_cool_muscle_add(cm1e_axis_t *axis, cm1e_diag_t *diag);

/** The state of a string. */
typedef struct cm1e_axis_cml {
    cm1e_command_state_t state; /**< CM1E_COMMAND_UNKNOWN: forgotten, because of the strings after it */
    cm1e_error_t error;
    unsigned lines, strays;
} cm1e_axis_cml_t;

/** Switches to CML mode and sends a string. `text` is copied; it need not be terminated within `size` bytes. */
cm1e_error_t cm1e_axis_cml_send(cm1e_axis_t *axis, const char *text, size_t size, int64_t timeout_ns, bool allow_motion,
                                uint32_t *ticket);
cm1e_axis_cml_t cm1e_axis_cml_state(const cm1e_axis_t *axis, uint32_t ticket);
/** A line of the answer, 0 = first; NULL: no such line, or no longer. A damaged answer is line 0. */
const char *cm1e_axis_cml_line(const cm1e_axis_t *axis, uint32_t ticket, unsigned line);

/** Switches to CSP, CML, CMD or CPIO. `insist`: see cm1e_drive_mode_check(). */
cm1e_error_t cm1e_axis_set_mode(cm1e_axis_t *axis, cm1e_bridge_mode_t mode, bool insist, uint32_t *ticket);
/** The state of a switch that was accepted. */
cm1e_command_state_t cm1e_axis_set_mode_state(const cm1e_axis_t *axis, uint32_t ticket, cm1e_error_t *error);

/** Starts a command of CMD mode. `timeout_ns` bounds an origin search. */
cm1e_error_t cm1e_axis_motor_command(cm1e_axis_t *axis, cm1e_drive_cmd_t command, int64_t timeout_ns, uint32_t *ticket);
/** The state of a command that was accepted. */
cm1e_command_state_t cm1e_axis_motor_command_state(const cm1e_axis_t *axis, uint32_t ticket, cm1e_error_t *error);

#endif
