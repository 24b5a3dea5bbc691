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
 * The zeros are those of the axes' coordinates when the command began, or, of what is relative, where the master was
 * then, and where they have to be for the slave to be on the cam where it was (but for SlaveOffset).
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
    cm1e_cam_knot_t *knots;        /**< as many as the axis has `points` */
} cam_slot_t;

/** Those that stay, and one more to take the next one in. */
enum { CAM_SLOTS = CM1E_AXIS_CAMS + 1 };

/** What an approach waits for. */
typedef enum awaited {
    AWAIT_NOTHING = 0,
    AWAIT_PLACE,                   /**< the master comes over the place where the approach begins */
    AWAIT_MOTION,                  /**< the master goes towards the place where it ends */
} awaited_t;

/** An approach is a curve over the master's position, from what the slave does to what it shall do when the master is
 *  at a place. Counts of the master are those of the link. */
typedef struct approach {
    const struct coupling_function *then; /**< the coupling function behind it */
    awaited_t awaited;             /**< the approach is still to come */
    double start_distance;         /**< counts of the master, signed as it goes; 0: from where it is */
    double sync;                   /**< counts of the master where it ends */
    double again;                  /**< counts after which that place comes again; 0: it does not */
    MC_SYNC_MODE mode;
    double turn;                   /**< u of the slave, whose places so far apart are the same; 0: there are none */
    position_t begin, end;         /**< of the slave */
    double first;                  /**< u of the master, counted from the end: where it begins */
    double steepest;               /**< largest slope of it, without sign */
    cm1e_curve_t curve;            /**< u of the slave from `begin` over u of the master from the end */
} approach_t;

/** What an approach would have demanded of the slave, for the text. */
typedef struct approach_refused {
    const char *what;              /**< NULL: the master stands while the slave moves, or has gone over it */
    const char *unit;
    double asked, allowed;
} approach_refused_t;

/** The state of a slave that should have been on its cam, and the state that the cam demanded; u, u/s; for the text. */
typedef struct cam_refused {
    double position, wanted_position, velocity, wanted_velocity;
} cam_refused_t;

/** Made with the axis. */
typedef struct cams {
    cam_slot_t slots[CAM_SLOTS];
    MC_CAM_ID last;
    int points;
    cm1e_cam_fault_t fault;        /**< fault of the last cam that was refused, for the text */
    int wrong;                     /**< point of that fault, from 0 */
    cam_refused_t refused;
    approach_refused_t approach_refused;
    cm1e_cam_knot_t knots[];
} cams_t;

/** A cam that is followed. */
typedef struct cam_place {
    const cam_slot_t *slot;        /**< NULL: it is another coupling function */
    position_t slave_zero;
    double away;                   /**< counts of the master from its zero to where its slave began to follow it */
    double master_offset, master_scaling, slave_offset, slave_scaling;
    double finer;                  /**< 1 / master_scaling */
    cm1e_cam_place_t place;
    cm1e_cam_sample_t before;      /**< sample of the last cycle, without its point */
    bool sampled;                  /**< there was a last cycle */
    double entered;                /**< turn from which the master came onto a single-shot cam; 0: it began on it */
    double left;                   /**< turn to which it left the cam at its other end; 0: not yet */
} cam_place_t;

cm1e_error_t cm1e_cam_memory_init(cm1e_axis_t *axis, cm1e_diag_t *diag); /* @rt init */
/** NULL: there is none of that number. */
const cam_slot_t *cm1e_cam_memory_find(const cm1e_axis_t *axis, MC_CAM_ID id);
void cm1e_coupling_approach_text(const cm1e_axis_t *axis, char *text, size_t size);
void cm1e_cam_id_text(const cm1e_axis_t *axis, char *text, size_t size);
void cm1e_cam_start_text(const cm1e_axis_t *axis, char *text, size_t size);
/** What is wrong with the cam that was refused last, and what would be right. */
void cm1e_cam_table_text(const cm1e_axis_t *axis, char *text, size_t size);

#endif
