/*
 * Axes that leave the path of their group for a while. It is so where not all axes are heard together, because they are
 * on several buses, or some are optional. While all of them are silent at once, time stands still for all axes, as on
 * one bus. While only some of them are, the axes that are heard cannot stand still: their drives would hear it. So the
 * path comes to rest, within the limits of its axes. An axis that was silent has left the path: it holds its set-point.
 * It is so too where a load has turned a motor on in a pause or silence: its set-point goes after it (axis_pursuit.c).
 *
 * Then the axis comes to rest by itself, and goes back to its place on the path when that is at rest. Then the path
 * goes on. Each axis keeps its limits all the time. Behind a stop, a halt or an error no axis goes back: it is released
 * where it came to rest, and one that is on its way back comes to rest at once. In an interruption it waits there.
 */
#include "group/group_private.h"

static const double same_moment = 1e-6; /* cycles */
/* The part of the maximum velocity with which an axis goes back that was slower when it left the path. */
static const double least_part = 0.05;

void cm1e_group_together(cm1e_group_t *group)
{
    const cm1e_axis_t *first = NULL;
    group->apart.off = group->apart.moving = 0;
    group->apart.passed_count = 0;
    group->apart.several = false;
    for (int i = 0; i < group->axes; i++) {
        const cm1e_axis_t *axis = cm1e_group_axis(group, group->ident[i]);
        first = first ? first : axis;
        group->apart.several |= axis && !cm1e_axis_is_heard_with(axis, first);
    }
}

/* ---- who was silent ---------------------------------------------------------------------------------------------- */

bool cm1e_group_all_held(const cm1e_group_t *group)
{
    for (int i = 0; i < group->axes; i++) {
        const cm1e_axis_t *axis = cm1e_group_led_axis(group, i);
        if (axis && !cm1e_axis_held(axis))
            return false;
    }
    return true;
}

/* Whether all axes were silent in the same cycles, and on the path. */
static bool as_one(const cm1e_group_t *group, uint32_t silent)
{
    for (int i = 0; i < group->axes; i++) {
        const cm1e_axis_t *axis = cm1e_group_led_axis(group, i);
        if (axis && (cm1e_axis_held(axis) || cm1e_axis_was_silent(axis) != silent))
            return false;
    }
    return group->apart.off == 0;
}

/* The path comes to rest with the limits of its axes, and waits. */
static void hold_path(cm1e_group_t *group)
{
    cm1e_path_override(&group->path, 0.0);
    if (group->state != CM1E_GROUP_MOVING && group->state != CM1E_GROUP_STOPPING)
        return; /* it stops so already */
    cm1e_group_rest(group, 0.0, 0.0);
    if (group->state == CM1E_GROUP_MOVING && !group->halting && !group->interruption.on)
        cm1e_path_go_on(&group->path);
}

void cm1e_group_stray(cm1e_group_t *group, uint32_t index)
{
    stray_t *stray = &group->apart.strays[index];
    const unsigned bit = 1u << index;
    if ((group->apart.off & bit) == 0)
        stray->speed = fabs(group->sample.velocity[index]);
    stray->step = STRAY_SILENT;
    group->apart.off |= bit;
    group->apart.moving |= bit;
    hold_path(group);
}

bool cm1e_group_strays(const cm1e_group_t *group, uint32_t index)
{
    const cm1e_axis_t *axis = cm1e_group_axis(group, group->ident[index]);
    const bool off = (group->apart.off & 1u << index) != 0;
    return axis && (off || (group->apart.several && !as_one(group, cm1e_axis_was_silent(axis))));
}

void cm1e_group_forget_stray(cm1e_group_t *group, uint32_t index)
{
    group->apart.off &= ~(1u << index);
    group->apart.moving &= ~(1u << index);
}

/* ---- the way back ------------------------------------------------------------------------------------------------ */

static cm1e_motion_limits_t limits_of(const cm1e_axis_t *axis)
{
    cm1e_motion_limits_t limits;
    double lowest, highest;
    cm1e_axis_bounds(axis, &limits, &lowest, &highest);
    return limits;
}

/* The state at which a profile of its own begins: its set-point. The profile counts from there. */
static void begin(stray_t *stray, const cm1e_axis_t *axis)
{
    cm1e_axis_info_t info;
    cm1e_axis_get(axis, &info);
    stray->from = cm1e_axis_place(axis, false);
    stray->now = (cm1e_motion_state_t){0.0, info.set_velocity, info.set_acceleration};
    stray->cycles = 0;
}

static bool path_rests(const cm1e_group_t *group)
{
    for (int i = 0; i < group->axes; i++)
        if (group->sample.velocity[i] != 0.0 || group->sample.acceleration[i] != 0.0)
            return false;
    return true;
}

static void come_to_rest(stray_t *stray, const cm1e_axis_t *axis)
{
    const cm1e_motion_limits_t limits = limits_of(axis);
    begin(stray, axis);
    stray->step = STRAY_RAMP;
    if (cm1e_profile_to_velocity(&stray->profile, &stray->now, 0.0, &limits) != CM1E_OK)
        stray->profile = (cm1e_profile_t){.end = stray->now}; /* the guard of the axis judges it */
}

static void go_back(cm1e_group_t *group, stray_t *stray, const cm1e_axis_t *axis, uint32_t index)
{
    cm1e_motion_limits_t limits = limits_of(axis);
    limits.velocity = fmin(limits.velocity, fmax(stray->speed, least_part * limits.velocity));
    begin(stray, axis);
    stray->step = STRAY_BACK;
    group->apart.moving |= 1u << index;
    if (cm1e_profile_to_position(&stray->profile, &stray->now, group->sample.position[index] - stray->from, &limits) !=
        CM1E_OK)
        stray->profile = (cm1e_profile_t){.end = stray->now};
}

static void arrive(cm1e_group_t *group, stray_t *stray, uint32_t index)
{
    group->apart.moving &= ~(1u << index);
    if (stray->step == STRAY_RAMP) {
        stray->step = STRAY_REST;
        return;
    }
    group->apart.off &= ~(1u << index);
    if (group->apart.off == 0)
        cm1e_path_override(&group->path, group->override);
}

static void next_of(cm1e_group_t *group, stray_t *stray, const cm1e_axis_t *axis, uint32_t index)
{
    const double cycle_s = cm1e_axis_cycle(axis), time_s = (double)++stray->cycles * cycle_s;
    cm1e_profile_sample(&stray->profile, time_s, &stray->now);
    if (time_s < stray->profile.duration_s - same_moment * cycle_s)
        return;
    stray->now = stray->profile.end;
    arrive(group, stray, index);
}

void cm1e_group_stray_step(cm1e_group_t *group, uint32_t index, cm1e_motion_state_t *point)
{
    stray_t *stray = &group->apart.strays[index];
    const cm1e_axis_t *axis = cm1e_group_axis(group, group->ident[index]);
    const bool goes_on = group->state == CM1E_GROUP_MOVING && !group->halting && !group->interruption.on &&
                         group->queue.count > 0;
    if (stray->step == STRAY_SILENT || (stray->step == STRAY_BACK && !goes_on))
        come_to_rest(stray, axis);
    else if (stray->step == STRAY_REST && goes_on && path_rests(group))
        go_back(group, stray, axis, index);
    if (stray->step != STRAY_REST)
        next_of(group, stray, axis, index);
    *point = stray->now;
    point->position += stray->from;
    if ((group->apart.off & 1u << index) == 0)
        point->position = group->sample.position[index];
}

/* ---- commands that wait for it ----------------------------------------------------------------------------------- */

void cm1e_group_pass(cm1e_group_t *group, cm1e_command_id_t id)
{
    if (group->apart.passed_count < CM1E_GROUP_COMMANDS)
        group->apart.passed[group->apart.passed_count++] = id;
}

void cm1e_group_finish_passed(cm1e_group_t *group)
{
    if (group->apart.off != 0)
        return;
    for (int i = 0; i < group->apart.passed_count; i++)
        cm1e_group_finish(group, group->apart.passed[i]);
    group->apart.passed_count = 0;
}
