/**
 * @file axis_backlash.h
 * The gap between motor and load (axis_backlash.c).
 */
#ifndef CM1E_AXIS_AXIS_BACKLASH_H
#define CM1E_AXIS_AXIS_BACKLASH_H

#include "axis/axis.h"

/** Counts in the direction in which u grows. */
typedef struct backlash {
    double gap;                    /**< 0: none */
    double velocity, acceleration; /**< of its compensation; counts/s, counts/s2 */
    double offset;                 /**< -gap ... 0: of the motor as seen from the load */
    double offset_velocity, target;
} backlash_t;

void cm1e_axis_backlash_init(cm1e_axis_t *axis); /* @rt init; after the limits */
/** Counts of the motor beyond its load; 0 without backlash. */
double cm1e_axis_backlash_offset(const cm1e_axis_t *axis);
/** Counts/s of the motor that its load does not do. */
double cm1e_axis_backlash_velocity(const cm1e_axis_t *axis);
bool cm1e_axis_backlash_at_rest(const cm1e_axis_t *axis);
/* Both only where there is a gap. */
void cm1e_axis_backlash_track(cm1e_axis_t *axis, int32_t moved_counts);
void cm1e_axis_backlash_step(cm1e_axis_t *axis);

#endif
