/**
 * @file ideal_cam.h
 * The function that a cam table means, in long double and with nothing of the library: the straight lines, the
 * polynomials of degree 5, and the cubic spline, whose curvatures are solved for by elimination.
 */
#ifndef CM1E_TESTS_IDEAL_CAM_H
#define CM1E_TESTS_IDEAL_CAM_H

#include <math.h>
#include <string.h>

#include "cm1e/mc_types.h"

enum { IDEAL_POINTS = 24 };

typedef struct ideal_cam {
    MC_CAM_POINT points[IDEAL_POINTS];
    int count;
    MC_CAM_CURVE curve;
    bool periodic;
    long double curvature[IDEAL_POINTS]; /**< of the spline at each point */
} ideal_cam_t;

void ideal_cam_init(ideal_cam_t *cam, const MC_CAM_REF *table, bool periodic);

/** u of the slave at a position of the master in the cam's own numbers. */
long double ideal_cam_at(const ideal_cam_t *cam, long double x);

#endif
