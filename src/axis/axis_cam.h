/**
 * @file axis_cam.h
 * Cams (Part 1, 4.2 and 4.3) and ways into step over the master's position (4.3, 4.7), as the sources about followers
 * see them. Everything here runs in the cycle unless marked otherwise.
 *
 * A cam as MC_CamIn places it, with M the master's position and the scalings and offsets of the command:
 *
 *     position in the cam = (M - zero of the master - MasterOffset) / MasterScaling
 *     slave               = zero of the slave + SlaveOffset + SlaveScaling * cam(position in the cam)
 *
 * The zeros are those of the axes' coordinates when the command began, or, of what is relative, where the master was
 * then, and where they have to be for the slave to be on the cam where it was (but for SlaveOffset).
 */
#ifndef CM1E_AXIS_AXIS_CAM_H
#define CM1E_AXIS_AXIS_CAM_H

#include "axis/axis_private.h"
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

/** Made with the axis. */
typedef struct cams {
    cam_slot_t slots[CAM_SLOTS];
    MC_CAM_ID last;
    int points;
    cm1e_cam_fault_t fault;        /**< of the last cam that was refused, for the text ... */
    int wrong;                     /**< ... at which point, from 0 */
    cm1e_cam_knot_t knots[];
} cams_t;

cm1e_error_t cm1e_axis_cams_init(cm1e_axis_t *axis, cm1e_diag_t *diag); /* @rt init */
/** NULL: there is none of that number. */
const cam_slot_t *cm1e_axis_cam_of(const cm1e_axis_t *axis, MC_CAM_ID id);
void cm1e_axis_cam_table_text(const cm1e_axis_t *axis, char *text, size_t size);

#endif
