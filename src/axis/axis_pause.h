/**
 * @file axis_pause.h
 * Cycles in which the motor did not take part, or perhaps did not (axis_pause.c).
 */
#ifndef CM1E_AXIS_AXIS_PAUSE_H
#define CM1E_AXIS_AXIS_PAUSE_H

#include "axis/axis.h"

/** A motor needs so many cycles to recover from one in which its target stood. */
enum { CM1E_SHAKEN_BY_SILENCE = 8 };

typedef struct silence {
    uint16_t shaken;                /**< by silence not long ago: CM1E_SHAKEN_BY_SILENCE for each cycle of it, one less
                                         with each answer */
    uint16_t silent, silent_before; /**< cycles in a row without an answer; those that the present one has ended */
    bool blind;                     /**< the actual position was not fresh, and the set-point goes on */
    bool frozen;                    /**< no answer to the last frame: set-points stay in this cycle */
    bool resumed;                   /**< a pause or silence before this cycle has been dealt with ... */
    bool began_anew;                /**< ... by another velocity than it had */
} silence_t;

/** Before the set-point of the first cycle in which a frame has come back again. */
void cm1e_axis_after_silence(cm1e_axis_t *axis);
/** Counts by which a motor has gone on in a silence that ended just now (CSV). */
double cm1e_axis_ran_on(const cm1e_axis_t *axis);

#endif
