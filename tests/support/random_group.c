#include "random_group.h"

#include <math.h>

#include "axis/axis_outside.h"
#include "random_program.h"

struct random_group groups[GROUPS_MOST];
int group_count;
unsigned long long led_total, group_done_total;
unsigned group_seen[CM1E_GROUP_STATE_COUNT];

struct random_group *random_group_of(const instance_t *fb)
{
    const cm1e_group_t *group = fb->view->group != NOWHERE ? group_of(fb) : NULL;
    for (int g = 0; group && g < group_count; g++)
        if (groups[g].group == group)
            return &groups[g];
    return NULL;
}

static int number_of(const cm1e_axis_t *axis)
{
    for (int n = 0; n < axis_count; n++)
        if (judged_axes[n].axis == axis)
            return n;
    return JUDGED_MOST;
}

/* ---- to make and to end them ------------------------------------------------------------------------------------- */

void make_groups(void)
{
    memset(groups, 0, sizeof groups);
    group_count = axis_count == 1 ? one_in(3) : pick(1 + GROUPS_MOST);
    for (int g = 0; g < group_count; g++) {
        MUST(cm1e_group_create(&groups[g].reference, NULL, NULL) == CM1E_OK, "no group");
        groups[g].group = cm1e_group_from_reference(&groups[g].reference);
        for (size_t i = 0; i < block_count; i++) {
            const block_t *type = &block_table[i];
            for (int copies = !member_of(type, "AxesGroup") ? 0 : member_of(type, "BufferMode") ? 2 : 1; copies > 0;
                 copies--) {
                judged_at = pick(axis_count);
                make(&instances[count], type->name);
                point_at(&instances[count++], "AxesGroup", &groups[g].reference);
            }
        }
    }
    judged_at = 0;
}

void end_groups(void)
{
    for (int g = 0; g < group_count; g++)
        MUST(cm1e_group_destroy(groups[g].reference) == CM1E_OK, "a group without axes cannot be destroyed");
    group_count = 0;
}

/* ---- inputs ------------------------------------------------------------------------------------------------------ */

static void put_array(instance_t *fb, const char *name, const double *values)
{
    const block_member_t *m = member_of(fb->view->type, name);
    if (m)
        memcpy(fb->memory + m->offset, values, m->size);
}

/* Points that its axes can get to, and a centre that is as far from both ends. */
static void random_points(instance_t *fb)
{
    const struct random_group *g = random_group_of(fb);
    const bool relative = strstr(name_of(fb), "Relative") != NULL;
    double end[CM1E_GROUP_AXES] = {0}, auxiliary[CM1E_GROUP_AXES] = {0}, from[CM1E_GROUP_AXES] = {0};
    double reach = INFINITY;
    int plane[2], axes = 0;
    for (int i = 0; i < CM1E_GROUP_AXES; i++) {
        const cm1e_axis_t *axis = cm1e_group_axis(g->group, (uint32_t)i + 1);
        if (!axis)
            continue;
        const double turn = cm1e_axis_configuration(axis)->modulo_range, scale = fabs(axis->position.scale);
        const double most = (one_in(2) ? 20000 : one_in(2) ? 2000 : 100000) / scale;
        from[i] = relative ? 0 : cm1e_axis_units(axis, axis->setpoint.position);
        end[i] = absurd(turn > 0 && !relative ? uniform(0, turn) : uniform(-most, most) + (relative ? 0 : from[i] / 2));
        auxiliary[i] = absurd(uniform(-most, most) + from[i] / 2);
        if (one_in(6))
            end[i] = from[i];
        reach = fmin(reach, 40000 / scale);
        if (axes < 2)
            plane[axes] = i;
        axes++;
    }
    if (axes >= 2 && member_of(fb->view->type, "AuxPoint") && !one_in(3)) {
        const double radius = reach * uniform(0.01, 1), at = uniform(0, 6.28), to = at + uniform(-6.28, 6.28);
        const bool border = *(const int *)(const void *)(fb->memory + place_of(fb->view->type, "CircMode")) == mcBorder;
        const double via = border ? (at + to) / 2 : 0, r = border ? radius : 0;
        for (int k = 0; k < 2; k++) {
            const double turned = k == 0 ? 0 : -1.5707963267948966; /* cosine, sine */
            const int i = plane[k];
            end[i] = from[i] + radius * (cos(to + turned) - cos(at + turned));
            auxiliary[i] = from[i] + r * cos(via + turned) - radius * cos(at + turned);
        }
    }
    put_array(fb, "Position", end);
    put_array(fb, "Distance", end);
    put_array(fb, "EndPoint", end);
    put_array(fb, "AuxPoint", auxiliary);
}

void choose_of_group(instance_t *fb)
{
    if (!random_group_of(fb))
        return;
    if (is(fb, "MC_AddAxisToGroup"))
        point_at(fb, "Axis", one_in(60) ? &named[axis_count] : &named[pick(axis_count)]);
    if (!one_in(20))
        random_points(fb);
    if (is(fb, "MC_AddAxisToGroup") && !one_in(4))
        put(fb, "IdentInGroup", 0);
}

/* What brings a group on its way, mostly. */
static const char *next_for(const struct random_group *g)
{
    static const char *const moves[] = {"MC_MoveLinearAbsolute", "MC_MoveLinearRelative", "MC_MoveCircularAbsolute",
                                        "MC_MoveCircularRelative", "MC_MoveLinearRelative", "MC_GroupHalt"};
    cm1e_group_info_t info;
    cm1e_group_get(g->group, &info);
    switch (info.state) {
    case CM1E_GROUP_DISABLED: return info.axes == 0 || one_in(2) ? "MC_AddAxisToGroup" : "MC_GroupEnable";
    case CM1E_GROUP_STANDBY: return moves[pick(5)];
    case CM1E_GROUP_MOVING:
        return info.interrupted ? "MC_GroupContinue" : one_in(8) ? "MC_GroupInterrupt" : moves[pick(6)];
    case CM1E_GROUP_ERROR_STOP: return "MC_GroupReset";
    default: return NULL;
    }
}

void bring_on(const struct random_group *g)
{
    const char *next = next_for(g);
    const int begin = pick(count);
    for (int i = 0; i < count && next; i++) {
        instance_t *fb = &instances[(begin + i) % count];
        if (group_of(fb) == g->group && is(fb, next)) {
            act_on(fb);
            return;
        }
    }
}

bool leaves_groups_alone(const instance_t *fb)
{
    const struct random_group *g = random_group_of(fb);
    const char *name = name_of(fb);
    if (!g)
        return !judged_axes[fb->of].axis->belongs.group || one_in(6);
    const bool ends = strstr(name, "Disable") || strstr(name, "Ungroup") || strstr(name, "Stop");
    return !ends || one_in(6);
}

/* ---- what must hold ---------------------------------------------------------------------------------------------- */

/* Transitions that need no block: an axis has failed, or was reset, or (`rests`) all is done. */
static unsigned group_goes_by_itself(const struct random_group *g, cm1e_group_state_t from, bool rests)
{
    unsigned to = 1u << from;
    if (from != CM1E_GROUP_DISABLED)
        to |= 1u << CM1E_GROUP_ERROR_STOP;
    if (from == CM1E_GROUP_ERROR_STOP && g->reset_asked)
        to |= 1u << CM1E_GROUP_STANDBY;
    if (rests && (from == CM1E_GROUP_MOVING || from == CM1E_GROUP_STOPPING))
        to |= 1u << CM1E_GROUP_STANDBY;
    return to;
}

/* Those of a block that is taken. */
static unsigned group_goes_by(const instance_t *fb, cm1e_group_state_t from)
{
    if (is(fb, "MC_GroupEnable"))
        return from == CM1E_GROUP_DISABLED ? 1u << CM1E_GROUP_STANDBY : 0;
    if (is(fb, "MC_GroupDisable") || is(fb, "MC_UngroupAllAxes"))
        return 1u << CM1E_GROUP_DISABLED;
    if (strncmp(name_of(fb), "MC_Move", 7) == 0)
        return from == CM1E_GROUP_STANDBY ? 1u << CM1E_GROUP_MOVING : 0;
    if (is(fb, "MC_GroupStop"))
        return from == CM1E_GROUP_STANDBY || from == CM1E_GROUP_MOVING ? 1u << CM1E_GROUP_STOPPING : 0;
    return 0;
}

/* After a call, or (NULL) after anything else. */
static void judge_group_state(struct random_group *g, const instance_t *fb)
{
    const cm1e_group_state_t before = g->state, after = g->group->state;
    const bool own = fb && group_of(fb) == g->group;
    const bool edge = own && fb->now.trigger && !fb->before.trigger && !fb->now.error;
    const bool released = own && is(fb, "MC_GroupStop") && !fb->now.trigger;
    /* A block of an axis has taken the last one from a group at rest in GroupStopping: no step of the path follows. */
    const bool let_go = fb && !group_of(fb) && before == CM1E_GROUP_STOPPING && !g->group->led && !g->group->stop_held;
    g->edge_in_cycle = g->edge_in_cycle || edge;
    if (own && is(fb, "MC_GroupReset") && edge)
        g->reset_asked = true;
    if (after == before)
        return;
    const unsigned alone = group_goes_by_itself(g, before, !fb || released || let_go);
    unsigned allowed = alone;
    for (int state = 0; state < CM1E_GROUP_STATE_COUNT && edge; state++)
        if (alone >> state & 1u)
            allowed |= group_goes_by(fb, (cm1e_group_state_t)state);
    MUST(allowed >> after & 1u, "%s: a group goes from %s to %s", fb ? name_of(fb) : "the cycle",
         cm1e_group_state_name(before), cm1e_group_state_name(after));
    if (after == CM1E_GROUP_ERROR_STOP)
        g->story.known = false;
    if (before == CM1E_GROUP_ERROR_STOP)
        g->reset_asked = false;
    g->state = after;
}

void judge_group_states(const instance_t *fb)
{
    for (int g = 0; g < group_count; g++)
        judge_group_state(&groups[g], fb);
}

void judge_led(void)
{
    const cm1e_axis_t *axis = judged.axis;
    int leaders = 0;
    for (int g = 0; g < group_count; g++)
        for (int i = 0; i < groups[g].group->axes; i++)
            leaders += (groups[g].group->led >> i & 1u) &&
                       cm1e_group_axis(groups[g].group, groups[g].group->ident[i]) == axis;
    const bool led = axis->setpoint.source == &cm1e_source_leader;
    const bool synchronised = axis->state == CM1E_AXIS_SYNCHRONIZED_MOTION;
    led_total += led;
    MUST(leaders == (led ? 1 : 0), "led: %d, by %d groups", led, leaders);
    MUST(!led || synchronised, "led in %s", cm1e_axis_state_name(axis->state));
    MUST(!led || !axis->commands.active, "led, and a command of its own is active");
    MUST(!synchronised || led || axis_follows(axis) || axis_from_outside(axis),
         "SynchronizedMotion with nothing to follow");
}

static bool group_stands(const cm1e_group_t *group)
{
    bool stands = true;
    for (uint32_t ident = 1; ident <= CM1E_GROUP_AXES; ident++) {
        const cm1e_axis_t *axis = cm1e_group_axis(group, ident);
        stands = stands && (!axis || axis->setpoint.velocity == 0.0);
    }
    return stands;
}

void judge_group(struct random_group *g, int longest, int stuck)
{
    const cm1e_group_t *group = g->group;
    const cm1e_group_state_t state = group->state;
    int active = 0;
    for (int i = 0; i < count; i++)
        active += instances[i].now.active && group_of(&instances[i]) == group;
    group_seen[state]++;
    MUST(g->edge_in_cycle || active <= 1, "%d blocks of a group are Active", active);
    g->edge_in_cycle = false;
    const bool commanded = group->queue.count > 0, all = group->led == (1u << group->axes) - 1u;
    if (state == CM1E_GROUP_MOVING)
        MUST(commanded && all, "GroupMoving with %d commands, axes 0x%X of %d", group->queue.count, group->led,
             group->axes);
    else if (state != CM1E_GROUP_STOPPING)
        MUST(!commanded, "%s, and a command is left", cm1e_group_state_name(state));
    MUST(state != CM1E_GROUP_STANDBY || group->led == 0, "GroupStandby, and axes are led");
    const bool held = state == CM1E_GROUP_STOPPING && group->stop_held && group->queue.count == 0;
    const bool brakes = state != CM1E_GROUP_MOVING && group->led != 0 && !held;
    g->braking_cycles = brakes ? g->braking_cycles + 1 : 0;
    MUST(g->braking_cycles < longest, "%s does not come to rest", cm1e_group_state_name(state));
    MUST(!group->interruption.on || state == CM1E_GROUP_MOVING, "%s, and interrupted", cm1e_group_state_name(state));
    MUST(!group->interruption.on || group->interruption.braking != 0 || group_stands(group),
         "MC_GroupInterrupt is Done, and an axis moves");
    const bool to_move = state == CM1E_GROUP_MOVING && group->override > 0.0 && !group->interruption.on;
    g->still_cycles = to_move && group_stands(group) ? g->still_cycles + 1 : 0;
    MUST(g->still_cycles < stuck, "GroupMoving, and nothing has moved for %d cycles", g->still_cycles);
}

static double origin_of(const cm1e_axis_t *axis) { return cm1e_axis_units(axis, (position_t){0, 0.0}); }

void begin_group_story(const instance_t *fb, int n, const double *set, cm1e_group_state_t before)
{
    struct random_group *g = random_group_of(fb);
    if (!g || is(fb, "MC_GroupReset") || is(fb, "MC_GroupInterrupt") || is(fb, "MC_GroupContinue"))
        return; /* the way goes on behind them */
    g->story.known = false;
    const bool relative = is(fb, "MC_MoveLinearRelative");
    if (before != CM1E_GROUP_STANDBY || !(relative || is(fb, "MC_MoveLinearAbsolute")) || fb->now.error)
        return;
    const char *way = relative ? "Distance" : "Position";
    g->story = (group_story_t){.known = true, .instance = n};
    memcpy(g->story.end, fb->memory + place_of(fb->view->type, way), sizeof g->story.end);
    for (int i = 0; i < CM1E_GROUP_AXES; i++) {
        const cm1e_axis_t *axis = cm1e_group_axis(g->group, (uint32_t)i + 1);
        if (!axis)
            continue;
        g->story.end[i] += relative ? set[number_of(axis)] : 0.0;
        g->story.origin[i] = origin_of(axis);
    }
}

void judge_group_arrival(int n)
{
    const instance_t *fb = &instances[n];
    struct random_group *g = random_group_of(fb);
    if (!g || !g->story.known || g->story.instance != n || g->group->state != CM1E_GROUP_STANDBY)
        return;
    group_done_total++;
    g->story.known = false;
    for (int i = 0; i < CM1E_GROUP_AXES; i++) {
        const cm1e_axis_t *axis = cm1e_group_axis(g->group, (uint32_t)i + 1);
        if (!axis || g->story.origin[i] != origin_of(axis) || cm1e_axis_configuration(axis)->modulo_range > 0 ||
            stories_touched[number_of(axis)] || axis->state == CM1E_AXIS_ERROR_STOP)
            continue;
        const double scale = fabs(axis->position.scale), end = g->story.end[i];
        const double off = (cm1e_axis_units(axis, axis->setpoint.position) - end) * scale;
        MUST(fabs(off) < 0.05 + fabs(end) * scale * 1e-14, "%s is Done, but axis %d stands %.6g counts beside %.9g",
             name_of(fb), number_of(axis), off, end);
    }
}
