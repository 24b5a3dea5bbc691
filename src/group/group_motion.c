/* The motion of a group along its path. In every cycle the first axis that asks for its set-point makes the step for
 * all axes. The group leads its axes while it moves or while GroupStopping holds them. At the end the axes get a last
 * set-point and are then free. */
#include "core/extreme.h"
#include "group/group_private.h"

bool cm1e_group_at_rest(const cm1e_group_t *group)
{
    const cm1e_path_phase_t phase = group->sample.phase;
    return !group->led || ((phase == CM1E_PATH_IDLE || phase == CM1E_PATH_STOPPED) && group->apart.moving == 0);
}

/* While an axis is off the path, the others go no farther from where it left than they must. */
void cm1e_group_rest(cm1e_group_t *group, double deceleration, double jerk)
{
    const bool together = group->apart.off == 0;
    group->rest_deceleration = together ? deceleration : 0.0;
    group->rest_jerk = together ? jerk : 0.0;
    cm1e_path_stop(&group->path, group->rest_deceleration, group->rest_jerk);
}

void cm1e_group_brake(cm1e_group_t *group, double deceleration, double jerk)
{
    group->halting = false;
    if (!group->led)
        return;
    cm1e_group_rest(group, deceleration, jerk);
    cm1e_path_clear(&group->path);
}

void cm1e_group_fail(cm1e_group_t *group, cm1e_error_t error, uint32_t culprit)
{
    if (group->state == CM1E_GROUP_ERROR_STOP || group->state == CM1E_GROUP_DISABLED)
        return; /* the first cause is kept; a disabled group only lets its axes come to rest */
    cm1e_group_end_all(group, CM1E_COMMAND_ERROR, CM1E_ERROR_GROUP_ERROR_STOP);
    group->error = error;
    group->culprit = culprit;
    group->refusal.error = CM1E_OK;
    group->state = cm1e_group_rule(group->state, TRIGGER_FAIL)->next;
    cm1e_group_brake(group, 0.0, 0.0);
}

/* ---- the cycle --------------------------------------------------------------------------------------------------- */

/* Ends the motion at rest; false: a command is left, or GroupStopping holds. */
static bool come_to_rest(cm1e_group_t *group)
{
    if (group->state == CM1E_GROUP_STOPPING && group->queue.count > 0)
        cm1e_group_finish(group, group->stop);
    const bool held = group->state == CM1E_GROUP_STOPPING && group->stop_held;
    if (group->queue.count > 0 || held)
        return false;
    group->state = cm1e_group_rule(group->state, TRIGGER_AT_REST)->next;
    return true;
}

/* The transitions of the state diagram that depend on the motion. */
static void after_step(cm1e_group_t *group)
{
    const cm1e_path_sample_t *sample = &group->sample;
    if (sample->phase == CM1E_PATH_MOVING && sample->done == 0 && group->apart.passed_count == 0)
        return;
    const bool at_rest = cm1e_group_at_rest(group);
    for (int i = 0; i < sample->done; i++)
        cm1e_group_pass(group, sample->done_tags[i]);
    if (group->interruption.on) {
        if (at_rest)
            cm1e_group_end_interrupt(group, CM1E_COMMAND_DONE, CM1E_OK);
        return;
    }
    if (group->halting && at_rest) { /* before the commands that waited for it, which may be done in the same step */
        group->halting = false;
        cm1e_group_finish(group, group->queue.ids[group->queue.first]);
        cm1e_path_go_on(&group->path);
    }
    cm1e_group_finish_passed(group);
    if (at_rest && come_to_rest(group))
        group->ending = true;
}

static void begin_step(cm1e_group_t *group)
{
    group->asked = 0;
    group->told = false;
}

/* After a silence all axes go on from the same place of the path, before it makes its step. */
static void meet(const cm1e_group_t *group)
{
    cm1e_axis_t *axes[CM1E_GROUP_AXES];
    uint32_t count = 0;
    for (int i = 0; i < group->axes; i++) {
        cm1e_axis_t *axis = cm1e_group_axis(group, group->ident[i]);
        if (axis)
            axes[count++] = axis;
    }
    cm1e_axis_meet(axes, count);
}

/* The first axis of a cycle makes the step for all. */
static void take_turn(cm1e_group_t *group, unsigned bit)
{
    if ((group->asked & bit) != 0) {
        meet(group);
        begin_step(group);
        if (!group->ending) {
            cm1e_path_step(&group->path, &group->sample);
            after_step(group);
        }
    }
    group->asked |= bit;
}

/* An axis that asks has found its bounds: the group does not end, and none of its axes may have left the path. */
static bool ordinary(void *context)
{
    cm1e_group_t *group = context;
    if (!cm1e_path_ordinary_step(&group->path, &group->sample))
        return false;
    begin_step(group);
    return true;
}

static cm1e_lead_t next(void *context, uint32_t index, double *position, double *velocity, double *acceleration)
{
    cm1e_group_t *group = context;
    const unsigned bit = 1u << index;
    cm1e_motion_state_t point;
    take_turn(group, bit);
    if ((group->apart.off & bit) != 0)
        cm1e_group_stray_step(group, index, &point);
    else
        point = (cm1e_motion_state_t){group->sample.position[index], group->sample.velocity[index],
                                      group->sample.acceleration[index]};
    *position = point.position;
    *velocity = point.velocity;
    *acceleration = point.acceleration;
    if (!group->ending)
        return CM1E_LEAD_ON;
    group->led &= ~bit;
    cm1e_group_forget_stray(group, index);
    return CM1E_LEAD_LAST;
}

/* The bus of an axis is silent. The others go on, unless all of them are. */
static void held(void *context, uint32_t index)
{
    cm1e_group_t *group = context;
    if (!group->apart.several || cm1e_group_all_held(group))
        return;
    cm1e_group_stray(group, index);
    take_turn(group, 1u << index);
}

/* The motor of an axis has run ahead. The path waits until the axis has come back. */
static void strays(void *context, uint32_t index, double velocity)
{
    cm1e_group_t *group = context;
    cm1e_group_stray(group, index);
    group->apart.strays[index].speed = larger(group->apart.strays[index].speed, fabs(velocity));
    take_turn(group, 1u << index);
}

/* Called when an axis has lost the lead. At rest in GroupStopping that is no error, because the axis leaves no path.
 * After the last axis no step follows. */
static void lost(void *context, uint32_t index, cm1e_error_t error)
{
    cm1e_group_t *group = context;
    const bool holding = group->state == CM1E_GROUP_STOPPING && cm1e_group_at_rest(group);
    group->led &= ~(1u << index);
    cm1e_group_forget_stray(group, index);
    if (error != CM1E_OK || !holding)
        cm1e_group_fail(group, CM1E_ERROR_GROUP_AXIS, group->ident[index]);
    else if (!group->led)
        (void)come_to_rest(group);
}

/* The smallest part of its velocity with which a motor of the group can go on. */
static double part_left(const cm1e_group_t *group)
{
    double least = 1.0;
    for (int i = 0; i < group->axes; i++) {
        const cm1e_axis_t *axis = cm1e_group_led_axis(group, i);
        if (axis)
            least = smaller(least, cm1e_axis_part_left(axis));
    }
    return least;
}

/* Whether this axis is the first one to tell the path of a pause or silence, and none has had its next set-point. */
static bool is_first(cm1e_group_t *group, uint32_t index)
{
    const bool first = !group->told && (group->asked & 1u << index) != 0;
    group->told |= first;
    return first;
}

/* Called when the motor of an axis has come to rest in a pause or silence, before it asks for its next set-point. */
static void paused(void *context, uint32_t index)
{
    cm1e_group_t *group = context;
    if (is_first(group, index))
        cm1e_path_pause(&group->path);
    if ((group->apart.off & 1u << index) != 0)
        cm1e_group_stray(group, index);
}

/* Called after a silence, before the axis asks for its next set-point. The first call is made before any of the axes is
 * slower. */
static void slow(void *context, uint32_t index, double *velocity, double *acceleration)
{
    cm1e_group_t *group = context;
    const double part = is_first(group, index) ? part_left(group) : 1.0;
    if (part < 1.0)
        cm1e_path_slow(&group->path, part, &group->sample);
    *velocity = group->sample.velocity[index];
    *acceleration = group->sample.acceleration[index];
}

static bool begins_anew(void *context)
{
    const cm1e_group_t *group = context;
    for (int i = 0; i < group->axes; i++) {
        const cm1e_axis_t *axis = cm1e_group_led_axis(group, i);
        if (axis && cm1e_axis_begins_anew(axis))
            return true;
    }
    return false;
}

/* Called after a silence: whether the axis goes on by itself. If all axes were silent, it tells the path too. */
static bool alone(void *context, uint32_t index)
{
    cm1e_group_t *group = context;
    if (!cm1e_group_strays(group, index))
        return false;
    if (!group->apart.several && begins_anew(group))
        paused(group, index);
    else
        cm1e_group_stray(group, index);
    return true;
}

static double stop_time(void *context)
{
    const cm1e_group_t *group = context;
    double longest_s = 0.0;
    for (int i = 0; i < group->axes; i++) {
        const cm1e_axis_t *axis = cm1e_group_axis(group, group->ident[i]);
        cm1e_motion_limits_t limits;
        double lowest, highest;
        if (!axis)
            continue;
        cm1e_axis_bounds(axis, &limits, &lowest, &highest);
        longest_s = larger(longest_s, fabs(group->sample.velocity[i]) / limits.deceleration);
    }
    return longest_s;
}

/* Axes on several buses may leave the path, and one that strays has left it. */
static bool bounds(void *context, uint32_t index, cm1e_motion_bounds_t *most, double *left_s)
{
    const cm1e_group_t *group = context;
    return !group->apart.several && group->apart.off == 0 && !group->ending &&
           cm1e_path_bounds(&group->path, (int)index, most, left_s);
}

/* ---- to take the axes, and to let them go ------------------------------------------------------------------------ */

void cm1e_group_let_go(cm1e_group_t *group)
{
    for (int i = 0; i < group->axes; i++) {
        cm1e_axis_t *axis = cm1e_group_led_axis(group, i);
        if (axis)
            cm1e_axis_release(axis);
    }
    group->led = 0;
}

cm1e_error_t cm1e_group_begin_path(cm1e_group_t *group)
{
    cm1e_path_config_t config = {.axes = 0};
    double position[CM1E_PATH_AXES] = {0.0};
    for (uint32_t ident = 1; ident <= CM1E_GROUP_AXES; ident++) {
        const cm1e_axis_t *axis = cm1e_group_axis(group, ident);
        cm1e_motion_limits_t limits;
        double lowest, highest;
        if (!axis)
            continue;
        cm1e_axis_bounds(axis, &limits, &lowest, &highest);
        config.axis[config.axes] = (cm1e_path_axis_t){limits.velocity,
                                                      smaller(limits.acceleration, limits.deceleration),
                                                      limits.jerk, lowest, highest};
        config.cycle_s = cm1e_axis_cycle(axis);
        position[config.axes] = cm1e_axis_place(axis, false);
        group->ident[config.axes++] = (uint8_t)ident;
    }
    group->axes = config.axes;
    config.space = config.axes < CM1E_PATH_SPACE ? config.axes : CM1E_PATH_SPACE;
    if (cm1e_path_begin(&group->path, &config, position) != CM1E_OK)
        return cm1e_group_refuse(group, (group_refusal_t){.error = CM1E_ERROR_GROUP_PATH});
    cm1e_path_override(&group->path, group->override);
    group->sample = (cm1e_path_sample_t){.phase = CM1E_PATH_IDLE};
    for (int i = 0; i < config.axes; i++)
        group->sample.position[i] = position[i];
    return CM1E_OK;
}

static const cm1e_axis_leader_t functions = {.next = next, .lost = lost, .paused = paused, .slow = slow,
                                             .begins_anew = begins_anew, .stop_time = stop_time, .strays = strays,
                                             .held = held, .alone = alone, .bounds = bounds,
                                             .ordinary = ordinary};

void cm1e_group_make_leaders(cm1e_group_t *group)
{
    for (int i = 0; i < CM1E_GROUP_AXES; i++) {
        cm1e_axis_leader_t *leader = &group->leads[i].leader;
        *leader = functions;
        leader->context = group;
        leader->index = (uint32_t)i;
        leader->course = &group->path.course;
        leader->asked = &group->asked;
        leader->bit = 1u << i;
        leader->position = &group->sample.position[i];
        leader->velocity = &group->sample.velocity[i];
        leader->acceleration = &group->sample.acceleration[i];
    }
}

cm1e_error_t cm1e_group_lead(cm1e_group_t *group, bool some)
{
    begin_step(group);
    group->led = 0;
    group->asked = UINT32_MAX;
    cm1e_group_together(group);
    group->ending = group->halting = group->interruption.on = false;
    for (int i = 0; i < group->axes; i++) {
        cm1e_axis_t *axis = cm1e_group_axis(group, group->ident[i]);
        if (axis && cm1e_axis_lead(axis, &group->leads[i].leader) == CM1E_OK) {
            group->led |= 1u << i;
        } else if (!some) {
            cm1e_group_let_go(group);
            return cm1e_group_refuse(group, (group_refusal_t){.error = CM1E_ERROR_GROUP_AXIS,
                                                              .ident = group->ident[i]});
        }
    }
    return CM1E_OK;
}
