#include "scheduler/tasks.h"

#include <stdio.h>

/** Limit of a call: with it the cycle goes on before the watchdog of a drive acts (100 ms). */
#define DEFAULT_LIMIT_NS INT64_C(50000000)

static cm1e_error_t check(const task_list_t *list, const cm1e_task_config_t *config, const char *name,
                          int64_t cycle_time_ns, cm1e_diag_t *diag)
{
    if (!config->program)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "Task \"%s\" has no program.", name);
    if (config->interval_ns < 0 || config->interval_ns % cycle_time_ns != 0)
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0,
                             "The interval of task \"%s\", %lld ns, is not a multiple of the bus cycle, %lld ns.", name,
                             (long long)config->interval_ns, (long long)cycle_time_ns);
    if (config->watchdog_cycles < -1)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0,
                             "The watchdog of task \"%s\" has %d cycles; expected 1 or more, 0 (50 ms) or -1 (none).",
                             name, (int)config->watchdog_cycles);
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
    if (config->watchdog_cycles >= 0)
        task.limit_ns = config->watchdog_cycles ? config->watchdog_cycles * cycle_time_ns : DEFAULT_LIMIT_NS;
    uint32_t place = list->count++;
    for (; place > 0 && list->tasks[place - 1].priority > task.priority; place--)
        list->tasks[place] = list->tasks[place - 1];
    list->tasks[place] = task;
    return CM1E_OK;
}

const task_t *cm1e_tasks_called(const task_list_t *list, uint64_t call)
{
    const uint32_t place = (uint32_t)(call & 0xFF);
    return place ? &list->tasks[place - 1] : NULL;
}

static const task_t *end_task(task_list_t *list)
{
    const uint32_t place = (uint32_t)(atomic_load(&list->leave.call) & 0xFF) - 1;
    list->tasks[place].next_cycle = INT64_MAX;
    list->ended++;
    return &list->tasks[place];
}

/** true: it returned in time. */
static bool call_task(task_list_t *list, uint32_t place)
{
    const uint64_t call = ++list->calls << 8 | (place + 1);
    atomic_store_explicit(&list->leave.call, call, memory_order_relaxed);
    list->tasks[place].program(list->tasks[place].context);
    return atomic_load_explicit(&list->leave.over, memory_order_relaxed) != call;
}

/** A task whose cycle was skipped runs in the next one, once, and keeps its phase. */
static const task_t *call_tasks(task_list_t *list, int64_t number)
{
    for (uint32_t i = 0; i < list->count; i++) {
        task_t *task = &list->tasks[i];
        if (number < task->next_cycle)
            continue;
        task->next_cycle = (number / task->every + 1) * task->every;
        if (!call_task(list, i))
            return end_task(list);
    }
    return NULL;
}

const task_t *cm1e_tasks_run(task_list_t *list, int64_t number)
{
    const task_t *over;
    if (sigsetjmp(list->leave.place, 0) == 0)
        over = call_tasks(list, number);
    else
        over = end_task(list);
    atomic_store_explicit(&list->leave.call, list->calls << 8, memory_order_relaxed);
    return over;
}
