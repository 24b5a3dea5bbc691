/**
 * @file bridge/cool_muscle.h
 * What a motor behind a bridge does beside motion, for its blocks: strings in CML, modes of operation, commands of CMD.
 * All of it while the axis is Disabled and asks for no torque. Who asked polls by ticket, so a block may vanish at any
 * time. All @rt cycle; CM1E_ERROR_CM_NO_BRIDGE: the motor is a CM1-E.
 */
#ifndef CM1E_BRIDGE_COOL_MUSCLE_H
#define CM1E_BRIDGE_COOL_MUSCLE_H

#include "axis/axis.h"
#include "device/bridge.h"
#include "drive/drive_command.h"

/** Adds to the axis what a motor behind a bridge does; nothing where there is no bridge. @rt init */
cm1e_error_t cm1e_cool_muscle_add(cm1e_axis_t *axis, cm1e_diag_t *diag);

/** How it went with a string. */
typedef struct cm1e_axis_cml {
    cm1e_command_state_t state; /**< CM1E_COMMAND_UNKNOWN: so many came after it that the axis has forgotten it */
    cm1e_error_t error;
    unsigned lines, strays;
} cm1e_axis_cml_t;

/** Sends a string, by way of CML mode. `text` is copied, and need not have an end within `size` bytes. */
cm1e_error_t cm1e_axis_cml_send(cm1e_axis_t *axis, const char *text, size_t size, int64_t timeout_ns, bool allow_motion,
                                uint32_t *ticket);
cm1e_axis_cml_t cm1e_axis_cml_state(const cm1e_axis_t *axis, uint32_t ticket);
/** A line of its answer, 0 = first; NULL: there is none (any more). A damaged answer is line 0. */
const char *cm1e_axis_cml_line(const cm1e_axis_t *axis, uint32_t ticket, unsigned line);

/** CSP, CML, CMD or CPIO. `insist`: see cm1e_drive_mode_check(). */
cm1e_error_t cm1e_axis_set_mode(cm1e_axis_t *axis, cm1e_bridge_mode_t mode, bool insist, uint32_t *ticket);
/** Of one that was accepted. */
cm1e_command_state_t cm1e_axis_set_mode_state(const cm1e_axis_t *axis, uint32_t ticket, cm1e_error_t *error);

/** A command in CMD mode. `timeout_ns`: of an origin search. */
cm1e_error_t cm1e_axis_motor_command(cm1e_axis_t *axis, cm1e_drive_cmd_t command, int64_t timeout_ns, uint32_t *ticket);
/** Of one that was accepted. */
cm1e_command_state_t cm1e_axis_motor_command_state(const cm1e_axis_t *axis, uint32_t ticket, cm1e_error_t *error);

#endif
