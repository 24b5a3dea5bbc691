/* The axes that are members of a group. An axis may cease to exist while it is a member. */
#include "group/group_private.h"

cm1e_axis_t *cm1e_group_axis(const cm1e_group_t *group, uint32_t ident)
{
    const AXIS_REF_t reference = ident >= 1 && ident <= CM1E_GROUP_AXES ? group->member[ident - 1] : (AXIS_REF_t){0};
    return reference.Handle ? cm1e_axis_from_reference(&reference) : NULL;
}

uint32_t cm1e_group_free_ident(const cm1e_group_t *group)
{
    for (uint32_t ident = 1; ident <= CM1E_GROUP_AXES; ident++)
        if (group->member[ident - 1].Handle == 0)
            return ident;
    return 0;
}

int cm1e_group_count(const cm1e_group_t *group)
{
    int count = 0;
    for (int i = 0; i < CM1E_GROUP_AXES; i++)
        count += group->member[i].Handle != 0;
    return count;
}

void cm1e_group_leave(cm1e_group_t *group, uint32_t ident)
{
    cm1e_axis_t *axis = cm1e_group_axis(group, ident);
    if (axis)
        cm1e_axis_leave(axis, group);
    group->member[ident - 1] = (AXIS_REF_t){0};
}

cm1e_error_t cm1e_group_member(const cm1e_group_t *group, uint32_t ident, AXIS_REF_t *axis)
{
    const bool there = ident >= 1 && ident <= CM1E_GROUP_AXES && group->member[ident - 1].Handle != 0;
    *axis = there ? group->member[ident - 1] : (AXIS_REF_t){0};
    return there ? CM1E_OK : CM1E_ERROR_GROUP_MEMBER;
}
