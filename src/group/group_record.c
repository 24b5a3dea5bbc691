/* The commands of a group by number: the queue, whose first command is active, and how commands ended. */
#include "core/rare.h"
#include "group/group_private.h"

void cm1e_group_record(cm1e_group_t *group, cm1e_command_id_t id, cm1e_command_state_t state, cm1e_error_t error)
{
    group->records[id % GROUP_RECORDS] = (group_record_t){.id = id, .state = state, .error = error};
}

static cm1e_command_id_t first_of(const cm1e_group_t *group)
{
    return group->queue.active;
}

void cm1e_group_finish(cm1e_group_t *group, cm1e_command_id_t id)
{
    group_queue_t *queue = &group->queue;
    if (id == 0 || first_of(group) != id)
        return;
    cm1e_group_record(group, id, CM1E_COMMAND_DONE, CM1E_OK);
    queue->first = (queue->first + 1) % CM1E_GROUP_COMMANDS;
    queue->count--;
    cm1e_group_resume(group);
}

void cm1e_group_suspend(cm1e_group_t *group)
{
    group->queue.active = 0;
    group->queue.in_a_row = false;
}

void cm1e_group_resume(cm1e_group_t *group)
{
    group_queue_t *queue = &group->queue;
    queue->active = queue->count > 0 ? queue->ids[queue->first] : 0;
}

void cm1e_group_end_interrupt(cm1e_group_t *group, cm1e_command_state_t state, cm1e_error_t error)
{
    if (group->interruption.braking != 0)
        cm1e_group_record(group, group->interruption.braking, state, error);
    group->interruption.braking = 0;
}

void cm1e_group_end_all(cm1e_group_t *group, cm1e_command_state_t state, cm1e_error_t error)
{
    for (int i = 0; i < group->queue.count; i++)
        cm1e_group_record(group, group->queue.ids[(group->queue.first + i) % CM1E_GROUP_COMMANDS], state, error);
    cm1e_group_end_interrupt(group, state, error);
    group->interruption.on = false;
    group->queue.count = 0;
    group->queue.active = 0;
    group->stop = 0;
    group->stop_held = false;
}

void cm1e_group_enqueue(cm1e_group_t *group, cm1e_command_id_t id)
{
    group_queue_t *queue = &group->queue;
    queue->ids[(queue->first + queue->count) % CM1E_GROUP_COMMANDS] = id;
    if (queue->count == 0)
        queue->active = id;
    queue->in_a_row = queue->count == 0 || (queue->in_a_row && id == queue->active + (cm1e_command_id_t)queue->count);
    queue->count++;
}

static bool is_among(const group_queue_t *queue, cm1e_command_id_t id)
{
    for (int i = queue->active != 0 ? 1 : 0; i < queue->count; i++)
        if (queue->ids[(queue->first + i) % CM1E_GROUP_COMMANDS] == id)
            return true;
    return false;
}

static bool is_waiting(const group_queue_t *queue, cm1e_command_id_t id)
{
    const cm1e_command_id_t behind = id - queue->active; /* 0: the active one; more than any place: one before it */
    if (CM1E_USUALLY(queue->in_a_row))
        return behind > 0 && behind < (cm1e_command_id_t)queue->count;
    return is_among(queue, id);
}

bool cm1e_group_waits(AXES_GROUP_REF_t reference, cm1e_command_id_t id)
{
    const cm1e_group_t *group = cm1e_group_from_reference(&reference);
    return CM1E_USUALLY(group && is_waiting(&group->queue, id));
}

cm1e_command_status_t cm1e_group_command_status(const cm1e_group_t *group, cm1e_command_id_t id)
{
    if (id != 0 && (first_of(group) == id || group->interruption.braking == id))
        return (cm1e_command_status_t){.state = CM1E_COMMAND_ACTIVE};
    if (is_waiting(&group->queue, id))
        return (cm1e_command_status_t){.state = CM1E_COMMAND_BUFFERED};
    const group_record_t *record = &group->records[id % GROUP_RECORDS];
    if (id == 0 || record->id != id)
        return (cm1e_command_status_t){.state = CM1E_COMMAND_UNKNOWN};
    return (cm1e_command_status_t){.state = record->state, .error = record->error};
}

bool cm1e_group_runs(AXES_GROUP_REF_t reference, cm1e_command_id_t id)
{
    const cm1e_group_t *group = cm1e_group_from_reference(&reference);
    return group && id != 0 && first_of(group) == id;
}

cm1e_command_id_t cm1e_group_next_id(cm1e_group_t *group)
{
    if (++group->last_id == 0)
        group->last_id = 1; /* 0 is no command */
    return group->last_id;
}
