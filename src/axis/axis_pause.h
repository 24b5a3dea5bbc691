/**
 * @file axis_pause.h
 * Cycles in which the motor did not take part, or perhaps did not (axis_pause.c).
 */
#ifndef CM1E_AXIS_AXIS_PAUSE_H
#define CM1E_AXIS_AXIS_PAUSE_H

#include <string.h>

#include "axis/axis_parts.h"

/** Counts/s: the resolution of the actual velocity of old firmware, and of a velocity computed from two positions. */
enum { CM1E_AXIS_VELOCITY_NOISE = 3000 };

/** Called at the begin of a cycle: whether an answer has come. Without an answer it is not known which target the drive
 *  holds. */
void cm1e_axis_note_answer(cm1e_axis_t *axis, bool answered, bool lost);
/** Whether the actual position is not known although the set-point goes on. */
static inline bool cm1e_axis_note_blind(cm1e_axis_t *axis, bool blind) { return axis->silence.blind = blind; }
/** Whether all frames have come back for a while. Then another answer changes nothing: cm1e_axis_note_answer(). */
static inline bool cm1e_axis_hears_well(const cm1e_axis_t *axis)
{
    static const silence_t none = {0};
    return memcmp(&axis->silence, &none, sizeof none) == 0;
}
/** Called before the set-point of the first cycle in which a frame has come back. */
void cm1e_axis_after_silence(cm1e_axis_t *axis);
/** Begins the motion anew at the present set-point with this velocity (u/s). */
void cm1e_axis_begin_anew(cm1e_axis_t *axis, double velocity);
/** Whether the motor has no new target for so long that it stops (CSP). */
bool cm1e_axis_stops_unheard(const cm1e_axis_t *axis);
/** Counts by which a motor has gone on in a silence that ended just now (CSV). */
double cm1e_axis_ran_on(const cm1e_axis_t *axis);

#endif
