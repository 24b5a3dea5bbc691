/**
 * @file group.h
 * Axes groups (PLCopen Motion Control Part 4): several axes that move along one path. A group is made by the program
 * before its cycle runs; axes come to it by MC_AddAxisToGroup, and the function blocks of mc_group.h act on it in the
 * cycle of their scheduler. It belongs to the bus of its first axis.
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

/** A handle: it may be copied. 0 names no group. */
typedef struct AXES_GROUP_REF {
    UINT Handle;
} AXES_GROUP_REF_t;

enum {
    CM1E_GROUP_AXES = 8,     /**< IdentInGroup 1 ... 8 */
    CM1E_GROUP_COMMANDS = 30 /**< the active one and those that wait; one more is CM1E_ERROR_FULL */
};

/** The state diagram of Part 4. */
typedef enum cm1e_group_state {
    CM1E_GROUP_DISABLED = 0,
    CM1E_GROUP_STANDBY,
    CM1E_GROUP_MOVING,
    CM1E_GROUP_STOPPING,
    CM1E_GROUP_ERROR_STOP,
    CM1E_GROUP_STATE_COUNT,
} cm1e_group_state_t;

/** "GroupStandby" ... ; never NULL. @rt any */
CM1E_API const char *cm1e_group_state_name(cm1e_group_state_t state);

/** All zero is good. */
typedef struct cm1e_group_config {
    char name[64]; /**< for texts; "": "group" */
} cm1e_group_config_t;

/** What a group shows; one consistent copy. Lengths along the path are those of its first up to three axes. */
typedef struct cm1e_group_info {
    cm1e_group_state_t state;
    cm1e_error_t error;              /**< why it is in GroupErrorStop; CM1E_OK otherwise */
    AXIS_REF_t axis[CM1E_GROUP_AXES]; /**< by IdentInGroup - 1; handle 0: none */
    int axes;                        /**< how many there are */
    double path_velocity, path_acceleration; /**< u/s, u/s2; of the set-point */
    double path_left;                /**< u; to the end of everything that was commanded */
    int commands;                    /**< under way and waiting */
} cm1e_group_info_t;

/** Makes a group without axes, in GroupDisabled. CM1E_ERROR_FULL: there are 32 in this process. @rt init */
CM1E_API cm1e_error_t cm1e_group_create(AXES_GROUP_REF_t *group, const cm1e_group_config_t *config, cm1e_diag_t *diag);
/** CM1E_ERROR_GROUP_STATE: it still moves axes, and nothing has happened. Blocks that name it show an error from then
 *  on. Not while the cycle of its axes runs. @rt init */
CM1E_API cm1e_error_t cm1e_group_destroy(AXES_GROUP_REF_t group);
/** CM1E_ERROR_GROUP_REF for a handle that names no group. @rt cycle (in a program of the axes' scheduler) */
CM1E_API cm1e_error_t cm1e_group_read(AXES_GROUP_REF_t group, cm1e_group_info_t *info);

/** Large enough for every text of cm1e_group_error_text(). */
enum { CM1E_GROUP_ERROR_TEXT_BYTES = 1536 };
/** The group's error as sentences: what happened, to which axis, what to do. Without an error: why the last command was
 *  refused; "" where nothing was. A buffer that is too small gets the beginning. @rt block */
CM1E_API void cm1e_group_error_text(AXES_GROUP_REF_t group, char *text, size_t size);

#ifdef __cplusplus
}
#endif
#endif
