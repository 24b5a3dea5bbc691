/**
 * @file coupling_cam.h
 * Cams (Part 1, 4.2 and 4.3) and approaches over the master's position (4.3, 4.7), as the sources of this room see
 * them. Everything here runs in the cycle unless marked otherwise.
 *
 * A cam as MC_CamIn places it, with M the master's position and the scalings and offsets of the command:
 *
 *     position in the cam = (M - zero of the master - MasterOffset) / MasterScaling
 *     slave               = zero of the slave + SlaveOffset + SlaveScaling * cam(position in the cam)
 *
 * The zeros are the zeros of the axes' coordinates when the command began. If the cam is relative, the zero of the
 * master is its position at that time, and the zero of the slave is chosen so that the slave is on the cam (but for
 * SlaveOffset).
 */
#ifndef CM1E_COUPLING_COUPLING_CAM_H
#define CM1E_COUPLING_COUPLING_CAM_H

#include "axis/axis_parts.h"
#include "coupling/coupling.h"
#include "motion/approach.h"
#include "motion/cam.h"

/** A cam in the memory of its slave. */
typedef struct cam_slot {
    MC_CAM_ID id;                  /**< 0: none */
    bool master_absolute, slave_absolute;
    cm1e_cam_t cam;
    cm1e_cam_knot_t *knots;        /**< room for the `points` of the configuration */
} cam_slot_t;

/** The cams that stay, and a place for the next one. */
enum { CAM_SLOTS = CM1E_AXIS_CAMS + 1 };

/** What an approach waits for. */
typedef enum awaited {
    AWAIT_NOTHING = 0,
    AWAIT_PLACE,                   /**< the master passes the place where the approach begins */
    AWAIT_MOTION,                  /**< the master moves towards the place where the approach ends */
} awaited_t;

/** An approach is a curve over the master's position. It leads from the present motion of the slave to the motion that
 *  the slave must have when the master is at a given place. Counts of the master are those of the link. */
typedef struct approach {
    const struct coupling_function *then; /**< the coupling function after the approach */
    awaited_t awaited;             /**< what the beginning of the approach waits for */
    double start_distance;         /**< counts of the master, in its direction; 0: begins at once */
    double sync;                   /**< counts of the master where it ends */
    double again;                  /**< counts after which that place repeats; 0: it does not */
    MC_SYNC_MODE mode;
    double turn;                   /**< u of the slave; positions that differ by it are one place; 0: none */
    position_t begin, end;         /**< of the slave */
    double first;                  /**< u of the master from the end: where the curve begins */
    double fade;                   /**< u of the master before `first`, in which the curvature goes to 0; at least 0 */
    double steepest;               /**< largest absolute slope of the curve, and before it */
    cm1e_curve_t curve;            /**< u of the slave from `begin` over u of the master from the end */
} approach_t;

/** What an approach would have demanded of the slave, for the text. */
typedef struct approach_refused {
    const char *what;              /**< NULL: the master is at standstill, or passed the approach in a cycle */
    const char *unit;
    double asked, allowed;
} approach_refused_t;

/** The state of a slave that should have been on its cam, and the state that the cam demanded; u, u/s; for the text. */
typedef struct cam_refused {
    double position, wanted_position, velocity, wanted_velocity;
} cam_refused_t;

/** Made with the axis, if it may follow cams. */
typedef struct cams {
    cam_slot_t slots[CAM_SLOTS];
    MC_CAM_ID last;
    int points;
    cm1e_cam_fault_t fault;        /**< fault of the last cam that was refused, for the text */
    int wrong;                     /**< point of that fault, from 0 */
    cam_refused_t refused;
    cm1e_cam_knot_t knots[];
} cams_t;

/** A cam that is followed. */
typedef struct cam_place {
    const cam_slot_t *slot;        /**< NULL: the coupling function is no cam */
    position_t slave_zero;
    double away;                   /**< counts of the master from its zero to where its slave began to follow it */
    double master_offset, master_scaling, slave_offset, slave_scaling;
    double finer;                  /**< 1 / master_scaling */
    cm1e_cam_place_t place;
    cm1e_cam_sample_t before;      /**< sample of the last cycle, without its point */
    bool sampled;                  /**< `before` is valid */
    double entered;                /**< side from which the master came onto a single-shot cam; 0: it began on it */
    double left;                   /**< side to which it left the cam at its other end; 0: not yet */
} cam_place_t;

cm1e_error_t cm1e_cam_memory_init(cm1e_axis_t *axis, cm1e_diag_t *diag); /* @rt init */
/** The cam with a number; NULL: there is none. */
const cam_slot_t *cm1e_cam_memory_find(const cm1e_axis_t *axis, MC_CAM_ID id);
void cm1e_coupling_approach_text(const cm1e_axis_t *axis, char *text, size_t size);
void cm1e_cam_id_text(const cm1e_axis_t *axis, char *text, size_t size);
void cm1e_cam_start_text(const cm1e_axis_t *axis, char *text, size_t size);
/** What is wrong with the cam that was refused last, and what would be right. */
void cm1e_cam_table_text(const cm1e_axis_t *axis, char *text, size_t size);

#endif
