/**
 * @file axis_handle.h
 * AXIS_REF: the table of all axes of the process. A handle is a place in the table and a count of its uses, so that a
 * handle kept beyond its axis names none, also when the place is taken again.
 */
#ifndef CM1E_AXIS_AXIS_HANDLE_H
#define CM1E_AXIS_AXIS_HANDLE_H

#include <stdbool.h>
#include <stdint.h>

#include "axis/axis.h"

enum { CM1E_AXIS_HANDLES = 256 };

/** FALSE: the table is full. @rt init */
bool cm1e_axis_handle_take(cm1e_axis_t *axis, uint16_t *handle);
/** @rt init */
void cm1e_axis_handle_give_back(uint16_t handle);

#endif
