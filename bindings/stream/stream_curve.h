/**
 * @file stream_curve.h
 * The positions of a control, at the times of another clock. The control gives one position of each axis per period;
 * the bus needs one per cycle. A cubic B-spline over the positions joins them: its acceleration is never above that of
 * the positions, and at rest it is exact. It stays a few periods behind the newest position. The distance is kept, as
 * the two clocks drift, by a rate that changes by at most a thousandth. Plain computing, for the cycle.
 */
#ifndef CM1E_STREAM_CURVE_H
#define CM1E_STREAM_CURVE_H

#include "stream_link.h"

/** The rest of the samples is for positions that come early, and for those around a place. */
enum { CURVE_SAMPLES = 128, CURVE_LEAST_DELAY = 3, CURVE_MOST_DELAY = 100 };

/** What a step found. */
typedef enum curve_step {
    CURVE_EMPTY = 0, /**< too few positions yet */
    CURVE_GOES_ON,   /**< also while nothing moves and no position comes */
    CURVE_BROKEN,    /**< the next position has not come in motion, or too many came */
} curve_step_t;

typedef struct curve {
    uint32_t axes;
    double delay;          /**< periods behind the newest position */
    double per_cycle;      /**< periods in a cycle of the bus */
    int64_t newest;        /**< number of the newest position; -1: none */
    double place;          /**< number in the positions that the axes follow */
    double behind;         /**< the smoothed distance between the two */
    double samples[CURVE_SAMPLES][STREAM_AXES];
} curve_t;

/** Begins anew. `delay` in periods: CURVE_LEAST_DELAY ... CURVE_MOST_DELAY. */
void curve_init(curve_t *curve, uint32_t axes, double per_cycle, double delay);
/** Adds the positions of a period. */
void curve_add(curve_t *curve, const double *positions);
/** Goes on by a cycle of the bus. */
curve_step_t curve_step(curve_t *curve);
/** The position of an axis in this cycle; after the first CURVE_GOES_ON. */
double curve_at(const curve_t *curve, uint32_t axis);
/** Whether the axis has not moved in any position from that of this cycle to the newest. */
bool curve_rests(const curve_t *curve, uint32_t axis);

#endif
