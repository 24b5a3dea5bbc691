/* AXES_GROUP_REF: the table of all groups of the process. A handle is a place in the table and a count of its uses, so
 * that a handle that outlives its group names no other group. */
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "group/group_private.h"

static _Atomic(cm1e_group_t *) table[GROUP_HANDLES];
static _Atomic uint8_t uses[GROUP_HANDLES];

static bool take_handle(cm1e_group_t *group)
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

cm1e_error_t cm1e_group_create(AXES_GROUP_REF_t *reference, const cm1e_group_config_t *config, cm1e_diag_t *diag)
{
    if (!reference)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "No place to put the group's handle.");
    *reference = (AXES_GROUP_REF_t){0};
    cm1e_group_t *group = calloc(1, sizeof *group);
    if (!group)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "No memory for an axes group.");
    if (config)
        group->config = *config;
    group->config.name[sizeof group->config.name - 1] = '\0';
    if (!group->config.name[0])
        (void)memcpy(group->config.name, "group", sizeof "group");
    group->override = 1.0;
    group->reset_state = CM1E_COMMAND_DONE;
    if (!take_handle(group)) {
        free(group);
        return cm1e_diag_set(diag, CM1E_ERROR_FULL, 0, "There are already %d axes groups in this process.",
                             GROUP_HANDLES);
    }
    reference->Handle = group->handle;
    return CM1E_OK;
}

cm1e_error_t cm1e_group_destroy(AXES_GROUP_REF_t reference)
{
    cm1e_group_t *group = cm1e_group_from_reference(&reference);
    if (!group)
        return CM1E_ERROR_GROUP_REF;
    cm1e_group_refresh(group);
    if (!cm1e_group_at_rest(group))
        return CM1E_ERROR_GROUP_STATE;
    cm1e_group_let_go(group);
    for (uint32_t ident = 1; ident <= CM1E_GROUP_AXES; ident++)
        cm1e_group_leave(group, ident);
    atomic_store(&table[reference.Handle & 0xFF], NULL);
    free(group);
    return CM1E_OK;
}
