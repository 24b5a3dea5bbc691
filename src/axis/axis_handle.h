/**
 * @file axis_handle.h
 * AXIS_REF: the table of all axes of the process. A handle is a place in the table and a count of its uses, so that a
 * handle kept beyond its axis names none, also when the place is taken again.
 */
#ifndef CM1E_AXIS_AXIS_HANDLE_H
#define CM1E_AXIS_AXIS_HANDLE_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#include "axis/axis_parts.h"

enum { CM1E_AXIS_HANDLES = 256 };

/** Schedulers in several threads may make their axes at the same time. */
extern _Atomic(cm1e_axis_t *) cm1e_axis_table[CM1E_AXIS_HANDLES];

/** NULL: the handle names no axis. @rt cycle */
static inline cm1e_axis_t *cm1e_axis_from_handle(uint16_t handle)
{
    cm1e_axis_t *axis = atomic_load_explicit(&cm1e_axis_table[handle & 0xFF], memory_order_acquire);
    return axis && axis->handle == handle && handle != 0 ? axis : NULL;
}

/** FALSE: the table is full. @rt init */
bool cm1e_axis_handle_take(cm1e_axis_t *axis, uint16_t *handle);
/** @rt init */
void cm1e_axis_handle_give_back(uint16_t handle);

#endif
