/**
 * @file group.h
 * Axes groups (PLCopen Motion Control Part 4): several axes that move along one path. The application makes a group
 * before the cycle runs. MC_AddAxisToGroup adds axes, and the function blocks of mc_group.h act on the group in the
 * cycle of the scheduler. A group belongs to the bus of its first axis.
 */
#ifndef CM1E_GROUP_H
#define CM1E_GROUP_H

#include <stdbool.h>
#include <stddef.h>

#include "cm1e/api.h"
#include "cm1e/axis.h"
#include "cm1e/error.h"
#include "cm1e/iec_types.h"

#ifdef __cplusplus
extern "C" {
#endif

/** A handle of a group. It may be copied. 0 names no group. */
typedef struct AXES_GROUP_REF {
    UINT Handle;
} AXES_GROUP_REF_t;

enum {
    CM1E_GROUP_AXES = 8,     /**< IdentInGroup 1 ... 8 */
    CM1E_GROUP_COMMANDS = 30 /**< maximum number of active and waiting commands; one more gets CM1E_ERROR_FULL */
};

/** The states of PLCopen Part 4. */
typedef enum cm1e_group_state {
    CM1E_GROUP_DISABLED = 0,
    CM1E_GROUP_STANDBY,
    CM1E_GROUP_MOVING,
    CM1E_GROUP_STOPPING,
    CM1E_GROUP_ERROR_STOP,
    CM1E_GROUP_STATE_COUNT,
} cm1e_group_state_t;

/** Name of a state: "GroupStandby" and so on. Never NULL; static storage. @rt any */
CM1E_API const char *cm1e_group_state_name(cm1e_group_state_t state);

/** Configuration of a group. A zeroed struct is valid. */
typedef struct cm1e_group_config {
    char name[64]; /**< name in texts; "" selects "group" */
} cm1e_group_config_t;

/** The values of a group, all of the same cycle. Lengths along the path are measured with its first three axes, or with
 *  all if it has fewer. */
typedef struct cm1e_group_info {
    cm1e_group_state_t state;
    cm1e_error_t error;              /**< cause of GroupErrorStop; CM1E_OK in any other state */
    AXIS_REF_t axis[CM1E_GROUP_AXES]; /**< index: IdentInGroup - 1; handle 0: none */
    int axes;                        /**< number of axes */
    double path_velocity, path_acceleration; /**< u/s, u/s2; values of the set-point */
    double path_left;                /**< u; distance to the end of all commands */
    int commands;                    /**< number of active and waiting commands */
    bool interrupted;                /**< by MC_GroupInterrupt: MC_GroupContinue makes them go on */
} cm1e_group_info_t;

/** Makes a group without axes, in GroupDisabled. Free it with cm1e_group_destroy(). Returns CM1E_ERROR_FULL if the
 *  process has 32 groups already. @rt init */
CM1E_API cm1e_error_t cm1e_group_create(AXES_GROUP_REF_t *group, const cm1e_group_config_t *config, cm1e_diag_t *diag);
/** Frees a group. Do not call it while the cycle of its axes runs. Blocks that name the group show an error from then
 *  on. Returns CM1E_ERROR_GROUP_STATE, and does nothing, if the group still moves axes. @rt init */
CM1E_API cm1e_error_t cm1e_group_destroy(AXES_GROUP_REF_t group);
/** Reads the values of a group. Call it in a program of the scheduler that owns the axes. Returns CM1E_ERROR_GROUP_REF
 *  for a handle that names no group. @rt cycle */
CM1E_API cm1e_error_t cm1e_group_read(AXES_GROUP_REF_t group, cm1e_group_info_t *info);

/** Buffer size that is large enough for every text of cm1e_group_error_text(). */
enum { CM1E_GROUP_ERROR_TEXT_BYTES = 1536 };
/** Writes the error of the group as sentences: what happened, to which axis, what to do. Without an error it writes why
 *  the last command was refused; "" if none was. A buffer that is too small gets the beginning of the text.
 *  @rt block */
CM1E_API void cm1e_group_error_text(AXES_GROUP_REF_t group, char *text, size_t size);

#ifdef __cplusplus
}
#endif
#endif
