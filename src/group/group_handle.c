/* AXES_GROUP_REF: the table of all groups of the process (core/handle.h). */
#include "core/handle.h"
#include "group/group_private.h"

static cm1e_handle_table_t places;

bool cm1e_group_take_handle(cm1e_group_t *group)
{
    return cm1e_handle_take(&places, GROUP_HANDLES, group, &group->handle);
}

cm1e_group_t *cm1e_group_from_reference(const AXES_GROUP_REF_t *reference)
{
    cm1e_group_t *group = reference ? cm1e_handle_object(&places, reference->Handle) : NULL;
    return group && group->handle == reference->Handle ? group : NULL;
}

void cm1e_group_drop_handle(AXES_GROUP_REF_t reference) { cm1e_handle_give_back(&places, reference.Handle); }
