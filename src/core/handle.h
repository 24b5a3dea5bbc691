/**
 * @file handle.h
 * Handles of objects that live long (AXIS_REF, AXES_GROUP_REF): a table of the process for each kind. A handle is a
 * place in the table and a count of its uses. So a handle that is kept beyond its object names none, also when the
 * place is taken again. Of the free places the one with the fewest uses is taken, so that a handle returns as late as
 * possible. Several threads may take places at the same time.
 */
#ifndef CM1E_CORE_HANDLE_H
#define CM1E_CORE_HANDLE_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/** A handle: the place in its lower bits, and above them the number of its use, from 1. */
enum {
    CM1E_HANDLE_PLACE_BITS = 9,
    CM1E_HANDLE_PLACES = 1 << CM1E_HANDLE_PLACE_BITS,            /**< of a table */
    CM1E_HANDLE_USES = (1 << (16 - CM1E_HANDLE_PLACE_BITS)) - 1, /**< after so many uses a place repeats its handles */
};

/** Valid when zeroed. */
typedef struct cm1e_handle_table {
    _Atomic(void *) objects[CM1E_HANDLE_PLACES]; /**< NULL: free */
    _Atomic uint32_t uses[CM1E_HANDLE_PLACES];
} cm1e_handle_table_t;

/** Takes a free place for an object, one of the first `count`. `*handle` is a member of the object: it is written
 *  before anybody can find the object, so everything else in it has to be written before the call. It is never 0.
 *  false: all these places are taken, and `*handle` is 0. @rt init */
bool cm1e_handle_take(cm1e_handle_table_t *table, unsigned count, void *object, uint16_t *handle);
/** Nobody finds the object by its handle any more. @rt init */
void cm1e_handle_give_back(cm1e_handle_table_t *table, uint16_t handle);

static inline unsigned cm1e_handle_place(uint16_t handle) { return handle & (CM1E_HANDLE_PLACES - 1u); }

/** The object at the place of a handle; NULL: none. The caller compares the handle in the object, which is never 0,
 *  with this one: it may be an object that took the place later. @rt cycle */
static inline void *cm1e_handle_object(cm1e_handle_table_t *table, uint16_t handle)
{
    return atomic_load_explicit(&table->objects[cm1e_handle_place(handle)], memory_order_acquire);
}

#endif
