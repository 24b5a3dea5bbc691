/**
 * @file task_watch.h
 * The watch over the tasks: a thread beside the cycle that ends a call of a task which does not return. Tasks run in
 * the thread of the cycle, so such a call would leave the motors without set-points. The cycle goes on without the
 * task.
 *
 * Only the time counts in which the call computes or waits. The time that the machine takes away from it does not: a
 * task is not blamed for a busy processor, a suspended machine or a debugger.
 *
 * A call that is to be left is left by itself where it calls a block (cm1e_in_task_gate()). One that calls none is left
 * by a signal, after it has computed for so long that it cannot be in the middle of a block that it began before.
 */
#ifndef CM1E_SCHEDULER_TASK_WATCH_H
#define CM1E_SCHEDULER_TASK_WATCH_H

#include <pthread.h>
#include <time.h>

#include "scheduler/realtime.h"
#include "scheduler/tasks.h"

typedef struct task_watch {
    task_list_t *tasks;
    pthread_t cycle, thread;
    bool runs;
    bool signal_allowed;       /**< the thread of the cycle did not block the signal before */
    _Atomic bool ends;
    clockid_t clock;           /**< processor time of the thread of the cycle */
    int state_file;            /**< its state in /proc; -1: not known */
    int64_t period_ns;         /**< between two looks */
    uint64_t seen;             /**< the call of the last look */
    int64_t at_ns, computed_ns;/**< time and processor time of the last look */
    int64_t spent_ns;          /**< by this call */
    int64_t armed_ns;          /**< spent when it was told to be left; 0: it was not told */
} task_watch_t;

/** Starts the watch over the tasks of the calling thread, if one has a limit. CM1E_ERROR_NO_MEMORY: the thread cannot
 *  be made. @rt init */
cm1e_error_t cm1e_task_watch_begin(task_watch_t *watch, task_list_t *tasks, cm1e_diag_t *diag);
/** The watch has to run while a task computes for ever: it gets a priority above that of the cycle. @rt init */
void cm1e_task_watch_raise(const task_watch_t *watch, int priority);
/** Ends the watch; without one it does nothing. @rt init */
void cm1e_task_watch_end(task_watch_t *watch);

#endif
