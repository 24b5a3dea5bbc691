/**
 * @file in_task.h
 * Whether this thread runs the tasks of a scheduler at present. Functions that wait would delay the set-points of the
 * motors, and functions that free the bus or the scheduler would free what the cycle uses. Both are refused in a task.
 */
#ifndef CM1E_CORE_IN_TASK_H
#define CM1E_CORE_IN_TASK_H

#include <setjmp.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#include "cm1e/error.h"
#include "core/guest_api.h"

/** Called before and after the tasks of a cycle. @rt cycle */
void cm1e_in_task_begin(void);
void cm1e_in_task_end(void);
/** Whether the calling thread is between the two calls. @rt cycle */
CM1E_GUEST_API bool cm1e_in_task(void);

/** How a task is left that takes too long (src/scheduler/task_watch.h). */
typedef struct in_task_leave {
    sigjmp_buf place;               /**< where it was called */
    _Atomic uint64_t call;          /**< its present call; each has a number of its own */
    _Atomic uint64_t over;          /**< the call that is to be left; 0: none */
} in_task_leave_t;

/** Number of watches, in all threads, that have a call to leave. */
extern _Atomic unsigned cm1e_in_task_over;

/** The tasks of this thread can be left in this way, from now on; NULL: no longer. @rt init */
void cm1e_in_task_watched(in_task_leave_t *leave);
/** Leaves the task in which this thread is, if it is to be left: then it does not return. Otherwise it does nothing.
 *  Async-signal-safe. @rt cycle */
void cm1e_in_task_leave(void);
/** The first line of what a task calls to change an axis or a group: a task that is to be left changes nothing more,
 *  and is never left in the middle of a change. @rt cycle */
static inline void cm1e_in_task_gate(void)
{
    if (atomic_load_explicit(&cm1e_in_task_over, memory_order_relaxed))
        cm1e_in_task_leave();
}

/** CM1E_ERROR_STATE of a function that waits. The text names the function ("cm1e_bus_scan()") and what a task uses
 *  `instead`: a sentence, or "". */
CM1E_GUEST_API cm1e_error_t cm1e_in_task_refuse(const char *function, const char *instead, cm1e_diag_t *diag);

/** For a function that returns no error: returns true in a task, and the scheduler is told after the tasks of this
 *  cycle. */
bool cm1e_in_task_note(const char *function);
/** The first function noted in this thread since this was called last; NULL: none. @rt cycle */
const char *cm1e_in_task_noted(void);

#endif
