/**
 * @file curve.h
 * A slave's position as a polynomial of degree 5 over its master's position: between two points at which position,
 * slope and curvature are given. A slope is the slave's velocity by the master's, u/u of the master. Pure functions, no
 * clock, no heap. @rt cycle throughout.
 */
#ifndef CM1E_MOTION_CURVE_H
#define CM1E_MOTION_CURVE_H

#include <stdbool.h>

#include "motion/profile.h"

/** A state of the slave: position (u) and its derivatives by the master's position. */
typedef struct cm1e_curve_point {
    double position, slope, curvature, third;
} cm1e_curve_point_t;

/** The polynomial for from <= master <= from + length (length > 0). */
typedef struct cm1e_curve {
    double from, length;
    double coefficient[6];      /**< coefficients of powers of (master - from) */
} cm1e_curve_t;

typedef struct cm1e_curve_extremes {
    double lowest, highest;         /**< position */
    double least_slope, most_slope; /**< signed */
    double curvature, third;        /**< absolute values */
} cm1e_curve_extremes_t;

/** Makes the curve that meets position, slope and curvature at both ends. `from` and `to` are the master's positions,
 *  in either order. Returns false if doubles cannot represent it. */
bool cm1e_curve_between(cm1e_curve_t *curve, double from, const cm1e_curve_point_t *first, double to,
                        const cm1e_curve_point_t *last);
/** The curve at a position of the master; outside of its interval the polynomial continues. */
static inline cm1e_curve_point_t cm1e_curve_at(const cm1e_curve_t *curve, double master)
{
    const double *c = curve->coefficient, x = master - curve->from;
    return (cm1e_curve_point_t){
        .position = c[0] + x * (c[1] + x * (c[2] + x * (c[3] + x * (c[4] + x * c[5])))),
        .slope = c[1] + x * (2 * c[2] + x * (3 * c[3] + x * (4 * c[4] + x * (5 * c[5])))),
        .curvature = 2 * c[2] + x * (6 * c[3] + x * (12 * c[4] + x * (20 * c[5]))),
        .third = 6 * c[3] + x * (24 * c[4] + x * (60 * c[5])),
    };
}
/** Extremes over the whole interval. */
void cm1e_curve_extremes(const cm1e_curve_t *curve, cm1e_curve_extremes_t *extremes);

/** Motion of the slave at a point of the curve, for a velocity and an acceleration of the master in u of the master. */
static inline cm1e_motion_state_t cm1e_curve_motion(const cm1e_curve_point_t *point, double velocity,
                                                    double acceleration)
{
    return (cm1e_motion_state_t){point->position, point->slope * velocity,
                                 point->curvature * velocity * velocity + point->slope * acceleration};
}
static inline double cm1e_curve_jerk(const cm1e_curve_point_t *point, double velocity, double acceleration, double jerk)
{
    return (point->third * velocity * velocity + 3 * point->curvature * acceleration) * velocity + point->slope * jerk;
}
/** The inverse: the point (with `third` 0) that corresponds to the motion of the slave. Returns false if the master
 *  stands and the slave does not, or if the master is too slow for a finite slope. */
bool cm1e_curve_point_of(cm1e_curve_point_t *point, const cm1e_motion_state_t *slave, double velocity,
                         double acceleration);

#endif
