/**
 * @file in_task.h
 * Whether this thread runs the tasks of a scheduler at present. Functions that wait would delay the set-points of the
 * motors, and functions that free the bus or the scheduler would free what the cycle uses. Both are refused in a task.
 */
#ifndef CM1E_CORE_IN_TASK_H
#define CM1E_CORE_IN_TASK_H

#include <stdbool.h>

#include "cm1e/error.h"
#include "core/guest_api.h"

/** Called before and after the tasks of a cycle. @rt cycle */
void cm1e_in_task_begin(void);
void cm1e_in_task_end(void);
/** Whether the calling thread is between the two calls. @rt cycle */
CM1E_GUEST_API bool cm1e_in_task(void);

/** CM1E_ERROR_STATE of a function that waits. The text names the function ("cm1e_bus_scan()") and what a task uses
 *  `instead`: a sentence, or "". */
CM1E_GUEST_API cm1e_error_t cm1e_in_task_refuse(const char *function, const char *instead, cm1e_diag_t *diag);

/** For a function that returns no error: returns true in a task, and the scheduler is told after the tasks of this
 *  cycle. */
bool cm1e_in_task_note(const char *function);
/** The first function noted in this thread since this was called last; NULL: none. @rt cycle */
const char *cm1e_in_task_noted(void);

#endif
