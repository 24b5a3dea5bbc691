/**
 * @file cam.h
 * Cams: a slave's position over its master's, through points. A cam is compiled once from the application's points into
 * memory of the caller, 32 bytes a point; then every sample costs a comparison and a polynomial. Pure functions, no
 * clock, no heap. @rt cycle throughout. Compiling takes about 0.1 us per point, up to 1 us if each interval exceeds the
 * extremes of all earlier ones.
 */
#ifndef CM1E_MOTION_CAM_H
#define CM1E_MOTION_CAM_H

#include "cm1e/mc_types.h"
#include "motion/curve.h"

/** A point with slope and curvature of the curve there; with mcCamLinear the slope after the point. */
typedef struct cm1e_cam_knot {
    double master, slave, slope, curvature;
} cm1e_cam_knot_t;

typedef struct cm1e_cam {
    const cm1e_cam_knot_t *knots;
    int count;
    MC_CAM_CURVE curve;
    bool periodic;
    double start, length;           /**< first position of the master, and the distance to the last one */
    double advance;                 /**< distance of the slave from the first to the last point */
    cm1e_curve_extremes_t extremes; /**< extremes, between the points too; `third` is an upper bound. With
                                         mcCamLinear without the steps of slope at the points */
    double corner, shortest;        /**< mcCamLinear: largest step of the slope at a point, also from the end of a
                                         period to the next one; shortest distance of the master between two points */
} cm1e_cam_t;

typedef enum cm1e_cam_fault {
    CM1E_CAM_GOOD = 0,
    CM1E_CAM_TOO_FEW,       /**< less than 2 points, or no array */
    CM1E_CAM_TOO_MANY,      /**< more points than there is memory for */
    CM1E_CAM_NO_NUMBER,     /**< not finite, or beyond +-1e30 */
    CM1E_CAM_NOT_RISING,    /**< the master's position is not above that of the point before */
    CM1E_CAM_CURVE,         /**< no such MC_CAM_CURVE */
    CM1E_CAM_STEEP,         /**< points closer together than 1e-30, or so that doubles cannot hold the curve
                                 between them */
} cm1e_cam_fault_t;

/** Compiles points; `knots` has room for `capacity` of them, and must outlive the cam. mcCamCubicSpline is continuous
 *  in slope and curvature: natural at the ends (no curvature there), or periodic over them. If the last position of a
 *  periodic cam differs from the first one, the slave advances by the difference in every period. After a fault the cam
 *  and its memory are invalid, and `*at` is the first wrong point, counted from 0. */
cm1e_cam_fault_t cm1e_cam_compile(cm1e_cam_t *cam, cm1e_cam_knot_t *knots, int capacity, const MC_CAM_REF *table,
                                  bool periodic, int *at);

/** Place of the last sample, so that the next one need not search. All zero: no last sample. */
typedef struct cm1e_cam_place {
    cm1e_curve_t curve;     /**< interval between two points; positions count from `start` of the cam */
    int knot;
    double turn;            /**< period of a periodic cam, and its distance from `start` with its rounding remainder */
    double turn_way, turn_rest;
} cm1e_cam_place_t;

typedef struct cm1e_cam_sample {
    cm1e_curve_point_t point;   /**< of a periodic cam without the advance of the slave, `turn` times `advance` */
    double turn;                /**< whole periods since `start`, rounded down; of a single-shot cam -1: at the first
                                     point or before it, 1: at the last one or behind it, 0: between them */
    double phase;               /**< position of the master in the period, from `start` */
} cm1e_cam_sample_t;

/** Samples the cam at any position of the master. A single-shot cam keeps its first or last position outside of its
 *  points. */
void cm1e_cam_sample(const cm1e_cam_t *cam, cm1e_cam_place_t *place, double master, cm1e_cam_sample_t *sample);
/** A master that brakes until it stands, and its slave on the cam; u of the cam, s. */
typedef struct cm1e_cam_braking {
    double master, velocity;    /**< of the master, now or a cycle ago */
    double own;                 /**< the deceleration that the slave may have */
    double gentle, hard;        /**< decelerations of the master */
    double cycle_s;
    int *steps;                 /**< of the way, that may still be looked at in this cycle; it counts them */
} cm1e_cam_braking_t;

/** Steps in a cycle, at most: each costs 0.1 us or so. */
enum { CM1E_CAM_BRAKING_STEPS = 256 };

/** The deceleration of the master, from `gentle` to `hard`, with which the slave brakes no harder than `own` until the
 *  master stands; a bound below the largest one. It is `gentle` where nothing harder is known to be good: also if the
 *  way has too many points to look at. */
double cm1e_cam_hardest_braking(const cm1e_cam_t *cam, const cm1e_cam_braking_t *asked);
/** The curve behind a point of the cam. false: doubles cannot represent it, as is known when the cam is compiled. */
bool cm1e_cam_interval(const cm1e_cam_t *cam, int knot, cm1e_curve_t *curve);
/** cm1e_cam_sample() where the master is in the same interval of the same period as before, and not at its beginning.
 *  false: it is elsewhere, and nothing has changed. */
static inline bool cm1e_cam_sample_again(const cm1e_cam_t *cam, const cm1e_cam_place_t *place, double master,
                                         cm1e_cam_sample_t *sample)
{
    const double way = master - cam->start, phase = cam->periodic ? (way - place->turn_way) - place->turn_rest : way;
    if (!(phase > 0 && phase < cam->length && phase >= place->curve.from &&
          phase - place->curve.from < place->curve.length))
        return false;
    *sample = (cm1e_cam_sample_t){cm1e_curve_at(&place->curve, phase), cam->periodic ? place->turn : 0, phase};
    return true;
}

#endif
