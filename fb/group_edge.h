/**
 * @file group_edge.h
 * Common code of the blocks of axes groups, based on the edge logic of edge.h. The group is latched like an axis. All
 * @rt cycle.
 */
#ifndef CM1E_FB_GROUP_EDGE_H
#define CM1E_FB_GROUP_EDGE_H

#include <string.h>

#include "edge.h"
#include "group/group_api.h"

/** The step of this call. `*group` is valid unless the step is FB_STEP_NONE. */
fb_step_t cm1e_fb_group_execute(cm1e_fb_private_t *fb, const AXES_GROUP_REF_t *reference, BOOL execute,
                                cm1e_group_t **group);
/** The group of the block, latched at its last rising edge; NULL: none. */
cm1e_group_t *cm1e_fb_group(const cm1e_fb_private_t *fb);
/** A whole block that acts on a group at its edge: Done or Error come in the same call. */
fb_outputs_t cm1e_fb_group_act(cm1e_fb_private_t *fb, const AXES_GROUP_REF_t *reference, BOOL execute,
                               cm1e_error_t (*act)(cm1e_group_t *group));
/** A whole block that is one command. */
fb_outputs_t cm1e_fb_group_motion(cm1e_fb_private_t *fb, const AXES_GROUP_REF_t *reference, BOOL execute,
                                  const cm1e_group_command_t *command);
/** A block of the Enable type: the group to read, or NULL if the block is disabled or in error. */
cm1e_group_t *cm1e_fb_group_enable(cm1e_fb_private_t *fb, const AXES_GROUP_REF_t *reference, BOOL enable);

/** Whether nothing has happened to the block, so that its outputs do not change: its command is active, or waits, as it
 *  did. */
static inline bool fb_group_stands(const cm1e_fb_private_t *fb, const AXES_GROUP_REF_t *reference, BOOL execute)
{
    return CM1E_USUALLY(fb->state == FB_BUSY && fb->trigger_before == execute && reference &&
                        reference->Handle == fb->axis_handle &&
                        (fb->active ? cm1e_group_runs(*reference, fb->command)
                                    : cm1e_group_waits(*reference, fb->command)));
}

/* Outputs of blocks that move a group. */
#define FB_SHOW_GROUP_MOTION(fb, out)                                                                                \
    ((fb)->Done = (out).done, FB_SHOW_ACTIVE(fb, out), (fb)->CommandAccepted = (out).busy || (out).done,             \
     (fb)->CommandID = (fb)->CommandAccepted ? (fb)->Private.command : 0)
/* Inputs of these blocks, with the names of the standard. */
#define FB_GROUP_INPUTS(fb)                                                                                          \
    .velocity = (fb)->Velocity, FB_DYNAMICS(fb), FB_GROUP_ORDER(fb)
/* ... and of those that move as fast as the axes can. */
#define FB_GROUP_ORDER(fb)                                                                                           \
    .coordinates = (fb)->CoordSystem, .buffer_mode = (fb)->BufferMode, .transition = (fb)->TransitionMode,           \
    .transition_parameter = (fb)->TransitionParameter

#endif
