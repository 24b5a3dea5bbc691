/**
 * @file parameter.h
 * What MC_ReadParameter, MC_WriteParameter and their brothers for BOOL have in common: the parameters of the axis
 * answer at once, those of the drive (from 1000 on) over SDO, while the block is Busy. All @rt cycle.
 */
#ifndef CM1E_FB_PARAMETER_H
#define CM1E_FB_PARAMETER_H

#include "axis/axis_parameters.h"
#include "edge.h"

/** What a reading block shows; `valid` and `value` are also what it showed in the call before. */
typedef struct fb_parameter {
    BOOL valid, busy, error;
    WORD error_id;
    LREAL value;
} fb_parameter_t;

void cm1e_fb_read_parameter(cm1e_fb_private_t *fb, const AXIS_REF_t *reference, BOOL enable, INT number, bool boolean,
                            fb_parameter_t *shown);

/** `boolean`: the block is for parameters of type BOOL alone. */
fb_outputs_t cm1e_fb_write_parameter(cm1e_fb_private_t *fb, const AXIS_REF_t *reference, BOOL execute, INT number,
                                     bool boolean, LREAL value, MC_EXECUTION_MODE mode);

#endif
