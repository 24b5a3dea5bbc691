/**
 * @file in_task.h
 * Whether this thread runs the tasks of a scheduler just now. What waits there would keep the set-points from the
 * motors, what frees the bus or the scheduler there would pull them from under the cycle: both are refused.
 */
#ifndef CM1E_CORE_IN_TASK_H
#define CM1E_CORE_IN_TASK_H

#include <stdbool.h>

#include "cm1e/error.h"

/** Around the tasks of a cycle. @rt cycle */
void cm1e_in_task_begin(void);
void cm1e_in_task_end(void);
/** TRUE: the calling thread is between the two. @rt cycle */
bool cm1e_in_task(void);

/** The error of a function that waits, CM1E_ERROR_STATE: names the function ("cm1e_bus_scan()"), and what a task has
 *  `instead` of it: a sentence, or "". */
cm1e_error_t cm1e_in_task_refuse(const char *function, const char *instead, cm1e_diag_t *diag);

/** For a function that returns no error: TRUE in a task, and the scheduler hears of it after this cycle's tasks. */
bool cm1e_in_task_note(const char *function);
/** The first function noted in this thread since this was called last; NULL: none. @rt cycle */
const char *cm1e_in_task_noted(void);

#endif
