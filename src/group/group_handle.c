/* AXES_GROUP_REF: the table of all groups of the process. A handle is a place in the table and a count of its uses, so
 * that a handle that outlives its group names no other group. */
#include <stdatomic.h>

#include "group/group_private.h"

static _Atomic(cm1e_group_t *) table[GROUP_HANDLES];
static _Atomic uint8_t uses[GROUP_HANDLES];

bool cm1e_group_take_handle(cm1e_group_t *group)
{
    for (unsigned i = 0; i < GROUP_HANDLES; i++) {
        if (atomic_load(&table[i]))
            continue;
        uint8_t use = (uint8_t)(atomic_fetch_add(&uses[i], 1) + 1);
        if (use == 0) /* 0 means "no group" */
            use = (uint8_t)(atomic_fetch_add(&uses[i], 1) + 1);
        group->handle = (uint16_t)(use << 8 | i);
        cm1e_group_t *none = NULL;
        if (atomic_compare_exchange_strong(&table[i], &none, group))
            return true;
    }
    return false;
}

cm1e_group_t *cm1e_group_from_reference(const AXES_GROUP_REF_t *reference)
{
    const unsigned place = reference ? reference->Handle & 0xFFu : GROUP_HANDLES;
    cm1e_group_t *group =
        place < GROUP_HANDLES ? atomic_load_explicit(&table[place], memory_order_acquire) : NULL;
    return group && group->handle == reference->Handle ? group : NULL;
}

void cm1e_group_drop_handle(AXES_GROUP_REF_t reference)
{
    atomic_store(&table[reference.Handle & 0xFF], NULL);
}
