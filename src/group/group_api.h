/**
 * @file group/group_api.h
 * The axes group as function blocks see it: members, the state diagram of Part 4, commands by number. Blocks post
 * commands and poll them; the axes ask the group for their set-points while their own outputs run. All in the thread of
 * the axes' cycle.
 */
#ifndef CM1E_GROUP_GROUP_API_H
#define CM1E_GROUP_GROUP_API_H

#include "axis/axis_api.h"
#include "cm1e/group.h"
#include "cm1e/mc_types.h"

typedef struct cm1e_group cm1e_group_t;

/** The group of a handle; NULL if the handle names no group. @rt cycle */
cm1e_group_t *cm1e_group_from_reference(const AXES_GROUP_REF_t *reference);

/* ---- members: in GroupDisabled, and while none of them is moved any more ----------------------------------------- */

/** Adds an axis. `ident` is 1 ... CM1E_GROUP_AXES; 0 selects the first free place. CM1E_ERROR_GROUP_MEMBER: the place
 *  is taken, or the axis is in a group already, or on a bus that no scheduler runs with those of the others.
 *  CM1E_ERROR_FB_AXIS_REF: no axis. CM1E_ERROR_UNSUPPORTED: the drive computes the profiles of the axis.
 *  CM1E_ERROR_AXIS_VIRTUAL: the axis is an encoder. @rt cycle */
cm1e_error_t cm1e_group_add(cm1e_group_t *group, AXIS_REF_t axis, uint32_t ident);
/** @rt cycle */
cm1e_error_t cm1e_group_remove(cm1e_group_t *group, uint32_t ident);
/** Removes all axes, in every state, like cm1e_group_disable(). A moving group is stopped first; then the axes are no
 *  longer members. @rt cycle */
cm1e_error_t cm1e_group_ungroup(cm1e_group_t *group);
/** The axis with this `ident`. CM1E_ERROR_GROUP_MEMBER: there is none. @rt cycle */
cm1e_error_t cm1e_group_member(const cm1e_group_t *group, uint32_t ident, AXIS_REF_t *axis);

/* ---- the state diagram ------------------------------------------------------------------------------------------- */

/** Enables the group. CM1E_ERROR_GROUP_MEMBER: it has no axes. @rt cycle */
cm1e_error_t cm1e_group_enable(cm1e_group_t *group);
/** Disables the group, in every state. Commands are aborted, and a moving group is stopped along its path. @rt cycle */
cm1e_error_t cm1e_group_disable(cm1e_group_t *group);
/** Resets the group, and its axes that are in ErrorStop. Poll it with cm1e_group_reset_state(). @rt cycle */
cm1e_error_t cm1e_group_reset(cm1e_group_t *group);
cm1e_command_state_t cm1e_group_reset_state(cm1e_group_t *group, cm1e_error_t *error);

/* ---- commands ---------------------------------------------------------------------------------------------------- */

typedef enum cm1e_group_kind {
    CM1E_GROUP_LINEAR_ABSOLUTE = 0,
    CM1E_GROUP_LINEAR_RELATIVE,
    CM1E_GROUP_CIRCULAR_ABSOLUTE,
    CM1E_GROUP_CIRCULAR_RELATIVE,
    CM1E_GROUP_HALT,
    CM1E_GROUP_STOP,
    CM1E_GROUP_INTERRUPT,
    CM1E_GROUP_KIND_COUNT,
} cm1e_group_kind_t;

/** A motion command. Positions are in u and stand at the place IdentInGroup - 1; places without an axis are ignored. A
 *  limit of 0 selects the largest value that the axes allow. */
typedef struct cm1e_group_command {
    cm1e_group_kind_t kind;
    double position[CM1E_GROUP_AXES];  /**< target or distance */
    double auxiliary[CM1E_GROUP_AXES]; /**< CIRCULAR_*: border point or centre */
    MC_CIRC_MODE circ_mode;
    MC_CIRC_PATHCHOICE path_choice;
    double velocity, acceleration, deceleration, jerk; /**< along the path */
    MC_COORD_SYSTEM coordinates;
    MC_BUFFER_MODE buffer_mode;
    MC_TRANSITION_MODE transition;
    double transition_parameter;
} cm1e_group_command_t;

/** Starts a command, appends it to the waiting ones, or refuses it; then *id is 0 and nothing has changed. @rt cycle */
cm1e_error_t cm1e_group_start(cm1e_group_t *group, const cm1e_group_command_t *command, cm1e_command_id_t *id);
cm1e_command_status_t cm1e_group_command_status(const cm1e_group_t *group, cm1e_command_id_t id);
/** Whether this is the active command of an existing group. @rt cycle */
bool cm1e_group_runs(AXES_GROUP_REF_t reference, cm1e_command_id_t id);
/** Whether this is a waiting command of an existing group. @rt cycle */
bool cm1e_group_waits(AXES_GROUP_REF_t reference, cm1e_command_id_t id);
/** Goes on with the commands that were interrupted, also while the group still brakes. CM1E_ERROR_GROUP_STATE: nothing
 *  is interrupted. @rt cycle */
cm1e_error_t cm1e_group_continue(cm1e_group_t *group);
/** Tells whether MC_GroupStop.Execute is TRUE. While it is, the group stays in GroupStopping. @rt cycle */
void cm1e_group_hold_stop(cm1e_group_t *group, cm1e_command_id_t id, bool hold);
/** Sets the factor on the velocities of commands, 0 ... 1, which holds until it is changed. CM1E_ERROR_AXIS_OVERRIDE:
 *  the factor is out of this range. @rt cycle */
cm1e_error_t cm1e_group_set_override(cm1e_group_t *group, double velocity);
/** Remembers for the text of the group which factor was refused. A block is refused in every call: the text is set when
 *  that `begins`, and when it is of another factor, so that it does not hide that of a command. @rt cycle */
void cm1e_group_refuse_override(cm1e_group_t *group, cm1e_error_t error, double velocity, double acceleration,
                                double jerk, bool begins);

/* ---- readings ---------------------------------------------------------------------------------------------------- */

/** Updates the group from the states of its axes, then copies its values. @rt cycle */
void cm1e_group_get(cm1e_group_t *group, cm1e_group_info_t *info);
/** Gives positions and velocities of the axes in u, as the axes show them, at the place IdentInGroup - 1 (0: no axis).
 *  `path` is the velocity along the path. CM1E_ERROR_AXIS_OFFLINE: actual values of an axis are not known. @rt cycle */
cm1e_error_t cm1e_group_values(const cm1e_group_t *group, MC_SOURCE source, double *position, double *velocity,
                               double *path);

#endif
