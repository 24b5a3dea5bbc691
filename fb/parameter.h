/**
 * @file parameter.h
 * Common code of MC_ReadParameter, MC_WriteParameter and the blocks for BOOL. Parameters of the axis are available at
 * once; those of the drive (from 1000 on) need an SDO, and the block is Busy meanwhile. All @rt cycle.
 */
#ifndef CM1E_FB_PARAMETER_H
#define CM1E_FB_PARAMETER_H

#include "axis/axis_parameters.h"
#include "edge.h"

/** Outputs of a reading block; on entry `valid`, `error_id` and `value` are those of the call before. */
typedef struct fb_parameter {
    BOOL valid, busy, error;
    WORD error_id;
    LREAL value;
} fb_parameter_t;

/** `boolean`: the block accepts only parameters of type BOOL. */
void cm1e_fb_read_parameter(cm1e_fb_private_t *fb, const AXIS_REF_t *reference, BOOL enable, INT number, bool boolean,
                            fb_parameter_t *shown);

/** `boolean`: the block accepts only parameters of type BOOL. */
fb_outputs_t cm1e_fb_write_parameter(cm1e_fb_private_t *fb, const AXIS_REF_t *reference, BOOL execute, INT number,
                                     bool boolean, LREAL value, MC_EXECUTION_MODE mode);

#endif
