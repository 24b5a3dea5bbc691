/**
 * @file tasks.h
 * IEC 61131-3 tasks: programs with an interval and a priority, called in the cycle one after the other.
 */
#ifndef CM1E_SCHEDULER_TASKS_H
#define CM1E_SCHEDULER_TASKS_H

#include "cm1e/scheduler.h"
#include "core/in_task.h"

typedef struct task {
    char name[CM1E_NAME_LENGTH];
    cm1e_program_t program;
    void *context;
    uint32_t priority;
    int64_t every;       /**< cycles */
    int64_t next_cycle;  /**< number of the cycle in which it is due; that of a task that was ended never comes */
    int64_t limit_ns;    /**< of one call; 0: none */
} task_t;

/** Tasks, in the order in which they run. */
typedef struct task_list {
    task_t tasks[CM1E_MAX_TASKS];
    uint32_t count, ended;
    uint64_t calls;
    in_task_leave_t leave; /**< `call`: 256 times the number of calls, and the place of the task + 1; 0 instead of that
                                between the calls */
} task_list_t;

/** @rt init */
cm1e_error_t cm1e_tasks_add(task_list_t *list, const cm1e_task_config_t *config, int64_t cycle_time_ns,
                            cm1e_diag_t *diag);
/** Calls the tasks that are due in cycle `number` (0 = first; numbers rise, some may be missing). Returns the task that
 *  did not return within its limit: it is not called again, and those behind it are called in the next cycle. NULL: all
 *  returned. @rt cycle */
const task_t *cm1e_tasks_run(task_list_t *list, int64_t number);
/** The task of a call; NULL: none. @rt any */
const task_t *cm1e_tasks_called(const task_list_t *list, uint64_t call);

#endif
