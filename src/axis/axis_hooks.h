/**
 * @file axis_hooks.h
 * What the axis asks of rooms above it, as tables of functions. Such a room adds itself to an axis when that is made
 * (src/assembly); an axis without it does the rest. All of it runs in the cycle unless marked otherwise.
 */
#ifndef CM1E_AXIS_AXIS_HOOKS_H
#define CM1E_AXIS_AXIS_HOOKS_H

#include "axis/axis.h"

/** What only a motor behind a bridge has (src/bridge): other modes than those of motion, and the way back from them. */
typedef struct motor_hooks {
    void (*free)(cm1e_axis_t *axis);               /**< @rt init */
    /** Between the programs and what is done about power. */
    void (*step)(cm1e_axis_t *axis);
    /** The motor is in the axis's own mode, or on its way there: it may be enabled. */
    bool (*is_home)(const cm1e_axis_t *axis);
    /** CM1E_OK, or why MC_Power cannot enable the motor, however long it waits. */
    cm1e_error_t (*refuses_power)(cm1e_axis_t *axis);
    /** CM1E_OK, or why MC_Home cannot be. */
    cm1e_error_t (*refuses_homing)(cm1e_axis_t *axis);
    /** At the end of a run: neither CML nor CMD moves the motor any more. TRUE at the latest 2 s after the first call. */
    bool (*released)(cm1e_axis_t *axis);
    /** What was refused or has failed; FALSE: this error is not one of those. */
    bool (*text)(const cm1e_axis_t *axis, cm1e_error_t error, char *text, size_t size);
} motor_hooks_t;

#endif
