/**
 * @file homing/homing.h
 * Homings: by the drive (MC_Home), and in steps by the axis (Part 5). Blocks command them with cm1e_axis_start().
 */
#ifndef CM1E_HOMING_HOMING_H
#define CM1E_HOMING_HOMING_H

#include "axis/axis_api.h"

/** Gives an axis the functions for homings. @rt init */
cm1e_error_t cm1e_homing_add(cm1e_axis_t *axis, cm1e_diag_t *diag);

#endif
