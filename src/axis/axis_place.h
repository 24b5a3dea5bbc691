/**
 * @file axis_place.h
 * Positions in counts.
 */
#ifndef CM1E_AXIS_AXIS_PLACE_H
#define CM1E_AXIS_AXIS_PLACE_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include "core/rare.h"

/** A position in counts without loss: whole counts and 0 <= fraction < 1. A double would lose the fraction after days
 *  in one direction. */
typedef struct position {
    int64_t counts;
    double fraction;
} position_t;

static inline position_t cm1e_position_plus(position_t position, double counts)
{
    const int64_t whole = (int64_t)counts;
    const double sum = position.fraction + (counts - (double)whole); /* -1 < sum < 2 */
    if (CM1E_USUALLY(sum >= 0.0 && sum < 1.0))
        return (position_t){position.counts + whole, sum};
    const double carry = sum >= 1.0 ? 1.0 : sum < 0.0 ? -1.0 : 0.0, fraction = sum - carry;
    position.counts += whole + (int64_t)carry;
    /* -1e-20 + 1 is 1 */
    return fraction < 1.0 ? (position_t){position.counts, fraction} : (position_t){position.counts + 1, 0.0};
}
static inline double cm1e_position_minus(position_t a, position_t b)
{
    return (double)(a.counts - b.counts) + (a.fraction - b.fraction);
}
/** Beyond 2^52 a double no longer resolves half a count; at full speed that is 57 years away. */
#define CM1E_FARTHEST_COUNTS (INT64_C(1) << 52)
static inline bool cm1e_position_in_range(position_t position)
{
    return (uint64_t)position.counts + CM1E_FARTHEST_COUNTS - 1 < 2 * (uint64_t)CM1E_FARTHEST_COUNTS - 1;
}

/** Whether the place so many counts away is one: a way of any size, also none that can be counted. */
static inline bool cm1e_position_reaches(position_t from, double counts)
{
    return fabs(counts) < (double)CM1E_FARTHEST_COUNTS && cm1e_position_in_range(cm1e_position_plus(from, counts));
}

/** As far there as the axis counts: for what is judged by how fast it is, and found too fast. */
static inline position_t cm1e_position_towards(position_t from, double counts)
{
    const double most = (double)CM1E_FARTHEST_COUNTS;
    return cm1e_position_plus(from, fabs(counts) < most ? counts : copysign(most, counts));
}

#endif
