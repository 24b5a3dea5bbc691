/**
 * @file axis_handle.h
 * AXIS_REF: the table of all axes of the process (core/handle.h).
 */
#ifndef CM1E_AXIS_AXIS_HANDLE_H
#define CM1E_AXIS_AXIS_HANDLE_H

#include "axis/axis_parts.h"
#include "core/handle.h"

enum { CM1E_AXIS_HANDLES = CM1E_HANDLE_PLACES };
_Static_assert(CM1E_AXIS_HANDLES >= CM1E_MAX_AXES, "every axis of a scheduler has a handle");

/** The table. Schedulers in several threads may create axes at the same time. */
extern cm1e_handle_table_t cm1e_axis_places;

/** The axis of a handle; NULL: there is none. @rt cycle */
static inline cm1e_axis_t *cm1e_axis_from_handle(uint16_t handle)
{
    cm1e_axis_t *axis = cm1e_handle_object(&cm1e_axis_places, handle);
    return axis && axis->handle == handle ? axis : NULL;
}

#endif
