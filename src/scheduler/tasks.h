/**
 * @file tasks.h
 * IEC 61131-3 tasks: programs with an interval and a priority, called in the cycle one after the other.
 */
#ifndef CM1E_SCHEDULER_TASKS_H
#define CM1E_SCHEDULER_TASKS_H

#include "cm1e/scheduler.h"

typedef struct task {
    char name[CM1E_NAME_LENGTH];
    cm1e_program_t program;
    void *context;
    uint32_t priority;
    int64_t every;       /**< cycles */
    int64_t next_cycle;  /**< number of the cycle in which it is due */
} task_t;

/** Tasks, in the order in which they run. */
typedef struct task_list {
    task_t tasks[CM1E_MAX_TASKS];
    uint32_t count;
} task_list_t;

/** @rt init */
cm1e_error_t cm1e_tasks_add(task_list_t *list, const cm1e_task_config_t *config, int64_t cycle_time_ns,
                            cm1e_diag_t *diag);
/** Calls the tasks that are due in cycle `number` (0 = first; numbers rise, some may be missing). @rt cycle */
void cm1e_tasks_run(task_list_t *list, int64_t number);

#endif
