/**
 * @file coupling_block.h
 * What blocks of a slave and its masters need in addition to the edge logic (edge.h). The masters are latched at the
 * rising edge with the slave. Another master while the block is busy is the same error as another Axis. All @rt cycle.
 */
#ifndef CM1E_FB_COUPLING_BLOCK_H
#define CM1E_FB_COUPLING_BLOCK_H

#include "edge.h"

/** The reference of a master. NULL names no axis, and the axis refuses it. */
static inline AXIS_REF_t fb_master(const AXIS_REF_t *master) { return master ? *master : (AXIS_REF_t){.Handle = 0}; }

/** cm1e_fb_motion() for a command that has a coupling. */
fb_outputs_t cm1e_fb_couple(cm1e_coupling_private_t *fb, const AXIS_REF_t *slave, BOOL execute, BOOL continuous_update,
                            const cm1e_axis_command_t *command);
/** A whole block that ends a coupling: a command without CommandAborted. */
fb_outputs_t cm1e_fb_decouple(cm1e_fb_private_t *fb, const AXIS_REF_t *slave, BOOL execute, cm1e_command_kind_t kind);

/** fb_stands() for a coupling block; values that may still change are in the result. `second` is NULL except for
 *  MC_CombineAxes. */
static inline cm1e_following_t fb_follows(const cm1e_coupling_private_t *fb, const AXIS_REF_t *slave,
                                          const AXIS_REF_t *master, const AXIS_REF_t *second, BOOL execute)
{
    if (CM1E_USUALLY(fb_same(&fb->common, slave, execute) && fb_master(master).Handle == fb->master &&
                     fb_master(second).Handle == fb->second_master))
        return cm1e_axis_follows_by(*slave, fb->common.command);
    return (cm1e_following_t){.follows = false};
}

#endif
