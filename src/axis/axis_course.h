/**
 * @file axis_course.h
 * What an axis on a profile does in its next cycles, decided ahead (axis_ordinary.c). Whoever follows it can decide
 * ahead too, and remembers the number of the course (setpoint_t.course): while the number stays, every cycle of the
 * axis is what was decided. The number changes with every new decision, whenever something changes on which one
 * depends, and with every cycle that takes the long way.
 */
#ifndef CM1E_AXIS_AXIS_COURSE_H
#define CM1E_AXIS_AXIS_COURSE_H

#include "axis/axis_parts.h"

typedef struct course {
    cm1e_motion_bounds_t most;
    double time_s;  /**< so long from now on */
    position_t end; /**< it goes there from the present set-point without turning round, and not beyond */
} course_t;

/** Something has changed on which it depends whether the next cycles are ordinary. */
static inline void cm1e_axis_look_anew(cm1e_axis_t *axis)
{
    axis->setpoint.ordinary_until_s = -INFINITY;
    axis->setpoint.course++;
}
/** The present course. false: nothing is decided ahead. */
bool cm1e_axis_course(const cm1e_axis_t *axis, course_t *course);

#endif
