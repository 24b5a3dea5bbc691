/**
 * @file axis_guard.h
 * The last look at set-points that are not of the axis's own making (axis_guard.c).
 */
#ifndef CM1E_AXIS_AXIS_GUARD_H
#define CM1E_AXIS_AXIS_GUARD_H

#include "axis/axis_move.h"

/** What a set-point that is not of the axis's own making would break. */
typedef enum guard_limit {
    GUARD_KEPT = 0,
    GUARD_FINITE,
    GUARD_PAUSE,       /**< the motor has gone on without it (axis_pause.c) */
    GUARD_DIRECTION,
    GUARD_VELOCITY,
    GUARD_ACCELERATION,
    GUARD_DECELERATION,
    GUARD_JERK,
    GUARD_STEP,
    GUARD_SOFTWARE_LIMIT,
    GUARD_COUNT,
} guard_limit_t;

typedef struct guard {
    guard_limit_t limit;
    double asked, allowed; /**< in the units of the limit */
    bool by_actual;        /**< what asked for it was the actual value of a master */
} guard_t;

guard_t cm1e_axis_look_closely(const cm1e_axis_t *axis, const from_t *next, bool kept_jerk);
/** Whether a motion that keeps acceleration and jerk at every moment of the cycle leads to the next set-point. Then the
 *  differences of the set positions keep them too, whatever adds up in it. */
bool cm1e_axis_guard_smooth(const cm1e_axis_t *axis, const from_t *next);
/** When the axis begins to follow or to be led, and when its limits are written. */
void cm1e_axis_guard_renew(cm1e_axis_t *axis);
/** ErrorStop with CM1E_ERROR_AXIS_COUPLING_LIMIT, which tells what was asked for and allowed. */
void cm1e_axis_guard_fail(cm1e_axis_t *axis, guard_t broken);
void cm1e_axis_guard_text(const cm1e_axis_t *axis, char *text, size_t size);

#endif
