/**
 * @file coupling/coupling.h
 * Couplings: an axis follows others by a gear, a cam or a combination of two (Part 1, chapter 4). Blocks command them
 * with cm1e_axis_start(). This header has what they need in addition.
 */
#ifndef CM1E_COUPLING_COUPLING_H
#define CM1E_COUPLING_COUPLING_H

#include "axis/axis_api.h"

/** Gives an axis the functions to follow others and to be followed. @rt init */
cm1e_error_t cm1e_coupling_add(cm1e_axis_t *axis, cm1e_diag_t *diag);

/** MC_CamTableSelect (4.2): copies a cam into the memory of its slave. The last CM1E_AXIS_CAMS cams stay there for
 *  MC_CamIn. A cam that is followed, or that a waiting command names, is not overwritten: CM1E_ERROR_FULL if there is
 *  no other place. CM1E_ERROR_AXIS_CAM_TABLE: the cam is wrong. @rt cycle */
enum { CM1E_AXIS_CAMS = 4 };
cm1e_error_t cm1e_axis_cam_select(cm1e_axis_t *slave, const MC_CAM_REF *cam, bool periodic, bool master_absolute,
                                  bool slave_absolute, MC_CAM_ID *id);

#endif
