#include "scheduler/tasks.h"

#include <stdio.h>

static cm1e_error_t check(const task_list_t *list, const cm1e_task_config_t *config, const char *name,
                          int64_t cycle_time_ns, cm1e_diag_t *diag)
{
    if (!config->program)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "Task \"%s\" has no program.", name);
    if (config->interval_ns < 0 || config->interval_ns % cycle_time_ns != 0)
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0,
                             "The interval of task \"%s\", %lld ns, is not a multiple of the bus cycle, %lld ns.", name,
                             (long long)config->interval_ns, (long long)cycle_time_ns);
    if (list->count == CM1E_MAX_TASKS)
        return cm1e_diag_set(diag, CM1E_ERROR_FULL, 0, "Task \"%s\" is one too many: a scheduler runs at most %d.",
                             name, CM1E_MAX_TASKS);
    return CM1E_OK;
}

cm1e_error_t cm1e_tasks_add(task_list_t *list, const cm1e_task_config_t *config, int64_t cycle_time_ns,
                            cm1e_diag_t *diag)
{
    task_t task = {.program = config->program, .context = config->context, .priority = config->priority};
    if (config->name && config->name[0])
        snprintf(task.name, sizeof task.name, "%s", config->name);
    else
        snprintf(task.name, sizeof task.name, "task%u", list->count + 1);
    const cm1e_error_t error = check(list, config, task.name, cycle_time_ns, diag);
    if (error != CM1E_OK)
        return error;
    task.every = config->interval_ns ? config->interval_ns / cycle_time_ns : 1;
    uint32_t place = list->count++;
    for (; place > 0 && list->tasks[place - 1].priority > task.priority; place--)
        list->tasks[place] = list->tasks[place - 1];
    list->tasks[place] = task;
    return CM1E_OK;
}

/** A task whose cycle was skipped runs in the next one, once, and keeps its phase. */
void cm1e_tasks_run(task_list_t *list, int64_t number)
{
    for (uint32_t i = 0; i < list->count; i++) {
        task_t *task = &list->tasks[i];
        if (number < task->next_cycle)
            continue;
        task->next_cycle = (number / task->every + 1) * task->every;
        task->program(task->context);
    }
}
