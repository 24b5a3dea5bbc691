/**
 * @file cam.h
 * Cams: a slave's position over its master's, through points. Compiled once from the application's points into memory
 * of the caller, 32 bytes a point; then every sample costs a comparison and a polynomial. Pure functions, no clock, no
 * heap. @rt cycle throughout; to compile takes time in proportion to the points, about 0.1 us each, up to 1 us where
 * one interval after the other goes beyond all before.
 */
#ifndef CM1E_MOTION_CAM_H
#define CM1E_MOTION_CAM_H

#include "cm1e/mc_types.h"
#include "motion/curve.h"

/** A point with what the curve has there; of mcCamLinear the slope from there on. */
typedef struct cm1e_cam_knot {
    double master, slave, slope, curvature;
} cm1e_cam_knot_t;

typedef struct cm1e_cam {
    const cm1e_cam_knot_t *knots;
    int count;
    MC_CAM_CURVE curve;
    bool periodic;
    double start, length;           /**< first position of the master, and from there to the last one */
    double advance;                 /**< of the slave, from the first to the last point */
    cm1e_curve_extremes_t extremes; /**< between the points too; `third` is a bound. mcCamLinear: without the steps of
                                         slope at the points */
} cm1e_cam_t;

typedef enum cm1e_cam_fault {
    CM1E_CAM_GOOD = 0,
    CM1E_CAM_TOO_FEW,       /**< less than 2 points, or none at all */
    CM1E_CAM_TOO_MANY,      /**< more than there is memory for */
    CM1E_CAM_NOT_FINITE,
    CM1E_CAM_NOT_RISING,    /**< the master's position is not above that of the point before */
    CM1E_CAM_CURVE,         /**< no such MC_CAM_CURVE */
    CM1E_CAM_STEEP,         /**< points so close together that doubles cannot hold the curve between them */
} cm1e_cam_fault_t;

/** Compiles points; `knots` has room for `capacity` of them, and must outlive the cam. mcCamCubicSpline is continuous
 *  in slope and curvature: natural at the ends (no curvature there), or periodic over them. Of a periodic cam whose
 *  last position is not its first one the slave advances by the difference in every period. On a fault the cam and its
 *  memory are of no use, and `*at` is the first wrong point, from 0. */
cm1e_cam_fault_t cm1e_cam_compile(cm1e_cam_t *cam, cm1e_cam_knot_t *knots, int capacity, const MC_CAM_REF *table,
                                  bool periodic, int *at);

/** Where the last sample was, so that the next one need not search. All zero: nowhere. */
typedef struct cm1e_cam_place {
    cm1e_curve_t curve;     /**< between two points, its positions counted from `start` of the cam */
    int knot;
    double turn;            /**< of a periodic cam, and its way from `start`: so much, and what doubles leave of it */
    double turn_way, turn_rest;
} cm1e_cam_place_t;

typedef struct cm1e_cam_sample {
    cm1e_curve_point_t point;   /**< of a periodic cam without what the slave advances: `turn` times `advance` */
    double turn;                /**< whole periods since `start`, rounded down; of a single-shot cam -1: at the first
                                     point or before it, 1: at the last one or behind it, 0: between them */
    double phase;               /**< of the master in the period, from `start` */
} cm1e_cam_sample_t;

/** At any position of the master. A single-shot cam keeps its first and last position outside of its points. */
void cm1e_cam_sample(const cm1e_cam_t *cam, cm1e_cam_place_t *place, double master, cm1e_cam_sample_t *sample);

#endif
