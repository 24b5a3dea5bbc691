/* A group: its members, its states, and what it shows. */
#include <stdlib.h>
#include <string.h>

#include "group/group_private.h"

/* ---- created and destroyed ------------------------------------------------------------------------------------- */

cm1e_error_t cm1e_group_create(AXES_GROUP_REF_t *reference, const cm1e_group_config_t *config, cm1e_diag_t *diag)
{
    if (!reference)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "cm1e_group_create() needs a place for the handle "
                             "of the group.");
    *reference = (AXES_GROUP_REF_t){0};
    cm1e_group_t *group = cm1e_cache_lines(sizeof *group);
    if (!group)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "No memory for an axes group.");
    if (config)
        group->config = *config;
    group->config.name[sizeof group->config.name - 1] = '\0';
    if (!group->config.name[0])
        (void)memcpy(group->config.name, "group", sizeof "group");
    group->override = 1.0;
    group->reset_state = CM1E_COMMAND_DONE;
    cm1e_group_make_leaders(group);
    if (!cm1e_group_take_handle(group)) {
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
    cm1e_group_drop_handle(reference);
    free(group);
    return CM1E_OK;
}

/* ---- what became of the axes ------------------------------------------------------------------------------------- */

/* State of MC_GroupReset. It is done when none of its axes is in ErrorStop and the others have come to rest. */
static void refresh_reset(cm1e_group_t *group)
{
    if (group->reset_state != CM1E_COMMAND_ACTIVE || group->led)
        return;
    for (uint32_t ident = 1; ident <= CM1E_GROUP_AXES; ident++) {
        cm1e_axis_t *axis = cm1e_group_axis(group, ident);
        cm1e_error_t error = CM1E_ERROR_GROUP_AXIS;
        if (group->member[ident - 1].Handle == 0 || (axis && cm1e_axis_present_state(axis) != CM1E_AXIS_ERROR_STOP))
            continue;
        if (axis && cm1e_axis_reset_state(axis, &error) == CM1E_COMMAND_ACTIVE)
            return;
        group->culprit = ident;
        group->reset_state = CM1E_COMMAND_ERROR;
        group->reset_error = error != CM1E_OK ? error : CM1E_ERROR_GROUP_AXIS;
        return;
    }
    group->reset_state = CM1E_COMMAND_DONE;
    group->error = CM1E_OK;
    group->culprit = 0;
    group->state = cm1e_group_rule(group->state, TRIGGER_RESET)->next;
}

static void refresh_members(cm1e_group_t *group)
{
    for (uint32_t ident = 1; ident <= CM1E_GROUP_AXES; ident++) {
        const cm1e_axis_t *axis = cm1e_group_axis(group, ident);
        if (group->member[ident - 1].Handle != 0 && (!axis || cm1e_axis_present_state(axis) == CM1E_AXIS_ERROR_STOP))
            cm1e_group_fail(group, CM1E_ERROR_GROUP_AXIS, ident);
    }
}

void cm1e_group_refresh(cm1e_group_t *group)
{
    refresh_members(group);
    refresh_reset(group);
    if (group->ungroup && !group->led) {
        group->ungroup = false;
        for (uint32_t ident = 1; ident <= CM1E_GROUP_AXES; ident++)
            cm1e_group_leave(group, ident);
    }
}

/* ---- members ----------------------------------------------------------------------------------------------------- */

/* Refuses because of the state, or because axes have not come to rest yet. */
static cm1e_error_t refused_by_state(cm1e_group_t *group, group_trigger_t trigger)
{
    cm1e_group_refresh(group);
    const group_rule_t *rule = cm1e_group_rule(group->state, trigger);
    if (rule->refusal != CM1E_OK)
        return cm1e_group_refuse(group, (group_refusal_t){
            .error = rule->refusal,
            .why = trigger == TRIGGER_CONFIGURE ? "Axes can be added and removed only in GroupDisabled: use "
                                                  "MC_GroupDisable first." : NULL});
    if (group->state == CM1E_GROUP_DISABLED && group->led)
        return cm1e_group_refuse(group, (group_refusal_t){.error = CM1E_ERROR_GROUP_STATE,
                                                          .why = "Its axes have not come to rest yet."});
    return cm1e_group_refuse(group, (group_refusal_t){.error = CM1E_OK});
}

static cm1e_error_t refuse_member(cm1e_group_t *group, cm1e_error_t error, uint32_t ident, const char *why)
{
    return cm1e_group_refuse(group, (group_refusal_t){.error = error, .ident = ident, .why = why});
}

static cm1e_error_t refuse_ident(cm1e_group_t *group, uint32_t ident, const char *why)
{
    return cm1e_group_refuse(group, (group_refusal_t){.error = CM1E_ERROR_GROUP_MEMBER, .value = ident, .why = why});
}

/* Whether one thread advances the axis and the members in the same cycle. */
static bool shares_cycle(const cm1e_group_t *group, const cm1e_axis_t *axis)
{
    for (uint32_t ident = 1; ident <= CM1E_GROUP_AXES; ident++) {
        const cm1e_axis_t *member = cm1e_group_axis(group, ident);
        if (member && !cm1e_axis_shares_cycle(member, axis))
            return false;
    }
    return true;
}

cm1e_error_t cm1e_group_add(cm1e_group_t *group, AXIS_REF_t reference, uint32_t ident)
{
    const cm1e_error_t refused = refused_by_state(group, TRIGGER_CONFIGURE);
    cm1e_axis_t *axis = cm1e_axis_from_reference(&reference);
    if (refused != CM1E_OK)
        return refused;
    if (!axis)
        return refuse_member(group, CM1E_ERROR_FB_AXIS_REF, 0, NULL);
    for (uint32_t other = 1; other <= CM1E_GROUP_AXES; other++)
        if (group->member[other - 1].Handle == reference.Handle)
            return refuse_member(group, CM1E_ERROR_GROUP_MEMBER, other, "The axis has this place in the group "
                                                                        "already.");
    if (cm1e_group_free_ident(group) == 0)
        return refuse_member(group, CM1E_ERROR_GROUP_MEMBER, 0, "The group is full: it has 8 axes. "
                             "MC_RemoveAxisFromGroup makes room.");
    if (ident > CM1E_GROUP_AXES)
        return refuse_ident(group, ident, "IdentInGroup must be 1 ... 8, or 0 for the first free place.");
    if (ident == 0)
        ident = cm1e_group_free_ident(group);
    if (group->member[ident - 1].Handle != 0)
        return refuse_member(group, CM1E_ERROR_GROUP_MEMBER, ident, "This place is taken: use MC_RemoveAxisFromGroup "
                                                                    "first.");
    if (!shares_cycle(group, axis))
        return refuse_member(group, CM1E_ERROR_GROUP_MEMBER, 0, "The axis is on another bus than the other axes of the "
                             "group, and no scheduler runs both: see cm1e_scheduler_add_bus().");
    if (cm1e_axis_configuration(axis)->motion == CM1E_MOTION_DRIVE)
        return refuse_member(group, CM1E_ERROR_UNSUPPORTED, 0, "The drive computes the profiles of this axis: it needs "
                             "`motion: host` in the bus file.");
    if (cm1e_axis_configuration(axis)->type == CM1E_AXIS_ENCODER)
        return refuse_member(group, CM1E_ERROR_AXIS_VIRTUAL, 0, "An encoder cannot be moved.");
    if (!cm1e_axis_join(axis, group))
        return refuse_member(group, CM1E_ERROR_GROUP_MEMBER, 0, "The axis belongs to another group.");
    group->member[ident - 1] = reference;
    return CM1E_OK;
}

cm1e_error_t cm1e_group_remove(cm1e_group_t *group, uint32_t ident)
{
    const cm1e_error_t refused = refused_by_state(group, TRIGGER_CONFIGURE);
    if (refused != CM1E_OK)
        return refused;
    if (ident < 1 || ident > CM1E_GROUP_AXES || group->member[ident - 1].Handle == 0)
        return refuse_ident(group, ident, "There is no axis at this place.");
    cm1e_group_leave(group, ident);
    return CM1E_OK;
}

cm1e_error_t cm1e_group_ungroup(cm1e_group_t *group)
{
    const cm1e_error_t error = cm1e_group_disable(group);
    group->ungroup = error == CM1E_OK;
    cm1e_group_refresh(group);
    return error;
}

/* ---- the state diagram ------------------------------------------------------------------------------------------- */

cm1e_error_t cm1e_group_enable(cm1e_group_t *group)
{
    const cm1e_error_t refused = refused_by_state(group, TRIGGER_ENABLE);
    if (refused != CM1E_OK)
        return refused;
    if (cm1e_group_count(group) == 0)
        return refuse_member(group, CM1E_ERROR_GROUP_MEMBER, 0, "It has no axes: use MC_AddAxisToGroup first.");
    group->state = cm1e_group_rule(group->state, TRIGGER_ENABLE)->next;
    group->error = CM1E_OK;
    return CM1E_OK;
}

cm1e_error_t cm1e_group_disable(cm1e_group_t *group)
{
    cm1e_group_refresh(group);
    cm1e_group_end_all(group, CM1E_COMMAND_ABORTED, CM1E_OK);
    cm1e_group_brake(group, 0.0, 0.0);
    if (cm1e_group_at_rest(group))
        cm1e_group_let_go(group);
    if (group->reset_state == CM1E_COMMAND_ACTIVE) {
        group->reset_state = CM1E_COMMAND_ERROR;
        group->reset_error = CM1E_ERROR_CANCELLED;
    }
    group->state = cm1e_group_rule(group->state, TRIGGER_DISABLE)->next;
    group->error = group->refusal.error = CM1E_OK;
    group->culprit = 0;
    return CM1E_OK;
}

cm1e_error_t cm1e_group_reset(cm1e_group_t *group)
{
    cm1e_group_refresh(group);
    group->reset_error = CM1E_OK;
    group->reset_state = CM1E_COMMAND_DONE; /* in other states there is nothing to reset */
    if (group->state != CM1E_GROUP_ERROR_STOP)
        return CM1E_OK;
    group->reset_state = CM1E_COMMAND_ACTIVE;
    for (uint32_t ident = 1; ident <= CM1E_GROUP_AXES; ident++) {
        cm1e_axis_t *axis = cm1e_group_axis(group, ident);
        if (axis)
            (void)cm1e_axis_reset(axis);
    }
    return CM1E_OK;
}

cm1e_command_state_t cm1e_group_reset_state(cm1e_group_t *group, cm1e_error_t *error)
{
    cm1e_group_refresh(group);
    if (error)
        *error = group->reset_error;
    return group->reset_state;
}

/* ---- readings ---------------------------------------------------------------------------------------------------- */

void cm1e_group_get(cm1e_group_t *group, cm1e_group_info_t *info)
{
    cm1e_group_refresh(group);
    *info = (cm1e_group_info_t){
        .state = group->state,
        .error = group->error,
        .axes = cm1e_group_count(group),
        .commands = group->queue.count,
        .interrupted = group->interruption.on,
    };
    for (int i = 0; i < CM1E_GROUP_AXES; i++)
        info->axis[i] = group->member[i];
    if (group->led) {
        info->path_velocity = group->sample.path_velocity;
        info->path_acceleration = group->sample.path_acceleration;
        info->path_left = cm1e_path_left(&group->path);
    }
}

cm1e_error_t cm1e_group_read(AXES_GROUP_REF_t reference, cm1e_group_info_t *info)
{
    cm1e_group_t *group = cm1e_group_from_reference(&reference);
    if (!group)
        return CM1E_ERROR_GROUP_REF;
    if (!info)
        return CM1E_ERROR_INVALID_ARGUMENT;
    cm1e_group_get(group, info);
    return CM1E_OK;
}

cm1e_error_t cm1e_group_values(const cm1e_group_t *group, MC_SOURCE source, double *position, double *velocity,
                               double *path)
{
    double in_space = 0.0, others = 0.0;
    int axes = 0;
    if (source != mcSetValue && source != mcActualValue)
        return CM1E_ERROR_UNSUPPORTED;
    for (uint32_t ident = 1; ident <= CM1E_GROUP_AXES; ident++) {
        const cm1e_axis_t *axis = cm1e_group_axis(group, ident);
        cm1e_axis_info_t info = {.online = true};
        if (axis)
            cm1e_axis_get(axis, &info);
        if (source == mcActualValue && !info.online)
            return CM1E_ERROR_AXIS_OFFLINE;
        const bool actual = source == mcActualValue;
        position[ident - 1] = actual ? info.actual_position : info.set_position;
        velocity[ident - 1] = actual ? info.actual_velocity : info.set_velocity;
        *(axis && axes++ < CM1E_PATH_SPACE ? &in_space : &others) += velocity[ident - 1] * velocity[ident - 1];
    }
    *path = sqrt(in_space > 0.0 ? in_space : others);
    return CM1E_OK;
}
