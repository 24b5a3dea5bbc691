/* The last refusal of a group, and its error texts. */
#include <stdio.h>
#include <string.h>

#include "axis/axis_text.h"
#include "group/group_private.h"

cm1e_error_t cm1e_group_refuse(cm1e_group_t *group, group_refusal_t refusal)
{
    group->refusal = refusal;
    return refusal.error;
}

static const char *name_of(const cm1e_group_t *group, uint32_t ident)
{
    return ident ? cm1e_axis_name(group->member[ident - 1]) : "";
}

/* Appends the error text of the axis. */
static void add_axis_text(const cm1e_group_t *group, uint32_t ident, char *text, size_t size)
{
    const size_t used = strlen(text);
    if (!ident || used + 2 >= size)
        return;
    text[used] = ' ';
    cm1e_axis_error_text(group->member[ident - 1], text + used + 1, size - used - 1);
    if (!text[used + 1])
        text[used] = '\0';
}

static void error_text(const cm1e_group_t *group, char *text, size_t size)
{
    snprintf(text, size,
             "Axes group \"%s\" is in GroupErrorStop: axis \"%s\" (IdentInGroup %u) failed, was stopped by itself, "
             "lost its power or does not exist any more. The other axes were braked along the path. Remove the cause, "
             "then reset the group and its axes with MC_GroupReset.",
             group->config.name, name_of(group, group->culprit), (unsigned)group->culprit);
    add_axis_text(group, group->culprit, text, size);
}

static void bounds_text(const cm1e_group_t *group, char *text, size_t size)
{
    const group_refusal_t *refusal = &group->refusal;
    snprintf(text, size,
             "Axes group \"%s\": on this path axis \"%s\" (IdentInGroup %u) would reach %.6g u; its software limits "
             "are %.6g ... %.6g u.",
             group->config.name, name_of(group, refusal->ident), (unsigned)refusal->ident, refusal->value,
             refusal->lower, refusal->upper);
}

static void axis_text(const cm1e_group_t *group, char *text, size_t size)
{
    const uint32_t ident = group->refusal.ident;
    cm1e_axis_info_t info;
    const bool there = cm1e_axis_read(group->member[ident - 1], &info) == CM1E_OK;
    snprintf(text, size,
             "Axes group \"%s\": axis \"%s\" (IdentInGroup %u) is in %s%s; for a motion of the group every axis must "
             "be powered and in Standstill.",
             group->config.name, name_of(group, ident), (unsigned)ident,
             there ? cm1e_axis_state_name(info.state) : "no state, as it does not exist any more",
             there && info.state == CM1E_AXIS_STANDSTILL ? ", but waits for a master, or is not ready yet" : "");
    add_axis_text(group, ident, text, size);
}

static const char *const path_texts[] = {
    [CM1E_PATH_FINE] = "",
    [CM1E_PATH_FULL] = " Wait until one of the commands of the group is done.",
    [CM1E_PATH_NO_NUMBER] = " A position is not a finite number, or farther away than the axis counts.",
    [CM1E_PATH_NO_ARC] = (" A circle needs at least two axes, and points that neither coincide nor lie on a line; the "
                          "centre must be as far from the end as from the beginning. A half or a full circle by its "
                          "centre needs begin, centre and end at the same Z."),
    [CM1E_PATH_OUT_OF_BOUNDS] = "",
    [CM1E_PATH_NO_TRANSITION] = " TransitionParameter must be above 0.",
};

static void refusal_text(const cm1e_group_t *group, char *text, size_t size)
{
    const group_refusal_t *refusal = &group->refusal;
    if (refusal->path == CM1E_PATH_OUT_OF_BOUNDS) {
        bounds_text(group, text, size);
        return;
    }
    if (refusal->error == CM1E_ERROR_GROUP_AXIS && refusal->ident) {
        axis_text(group, text, size);
        return;
    }
    char about[160] = "";
    if (refusal->ident)
        snprintf(about, sizeof about, " Axis \"%s\" (IdentInGroup %u).", name_of(group, refusal->ident),
                 (unsigned)refusal->ident);
    const cm1e_axis_t *axis = refusal->ident && refusal->error == CM1E_ERROR_AXIS_DIRECTION_DISABLED
                                  ? cm1e_axis_from_reference(&group->member[refusal->ident - 1]) : NULL;
    char asked[64] = "";
    if (refusal->value != 0.0)
        snprintf(asked, sizeof asked, " %.6g was given.", refusal->value);
    snprintf(text, size, "Axes group \"%s\", %s: %s%s.%s%s%s%s%s", group->config.name,
             cm1e_group_state_name(group->state), cm1e_strerror(refusal->error),
             axis ? cm1e_axis_disabled_inputs(axis) : "", about, asked,
             path_texts[refusal->path], refusal->why ? " " : "", refusal->why ? refusal->why : "");
}

void cm1e_group_error_text(AXES_GROUP_REF_t reference, char *text, size_t size)
{
    if (!text || size == 0)
        return;
    text[0] = '\0';
    const cm1e_group_t *group = cm1e_group_from_reference(&reference);
    if (!group)
        return;
    if (group->error != CM1E_OK)
        error_text(group, text, size);
    else if (group->refusal.error != CM1E_OK)
        refusal_text(group, text, size);
}
