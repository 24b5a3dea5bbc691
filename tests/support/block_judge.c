#include "block_judge.h"

struct judged_axis judged_axes[JUDGED_MOST];
int judged_at;

instance_t *called[INSTANCES_MOST];
int called_count;

void bench_fail(const char *format, ...)
{
    char words[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(words, sizeof words, format, arguments);
    va_end(arguments);
    ck_abort_msg("%s, axis %d, cycle %lld: %s", judged.scene, judged_at, judged.number, words);
    abort();
}

/* ---- members ----------------------------------------------------------------------------------------------------- */

const block_member_t *member_of(const block_t *type, const char *name)
{
    for (size_t i = 0; i < type->member_count; i++)
        if (strcmp(type->members[i].name, name) == 0)
            return &type->members[i];
    return NULL;
}

uint16_t place_of(const block_t *type, const char *name)
{
    const block_member_t *member = member_of(type, name);
    return member ? (uint16_t)member->offset : NOWHERE;
}

static uint16_t first_place(const block_t *type, const char *const *names)
{
    uint16_t place = NOWHERE;
    for (; *names && place == NOWHERE; names++)
        place = place_of(type, *names);
    return place;
}

const block_view_t *view_of(const char *name)
{
    static block_view_t views[BLOCKS_MOST];
    static const char *const reached[] = {"InVelocity", "InEndVelocity", "InTorque", "ProfileCompleted",
                                           "InGear", "InSync", NULL};
    static const char *const valid[] = {"Valid", "Enabled", "InOperation", NULL};
    static const char *const axis[] = {"Axis", "Slave", NULL};
    for (size_t i = 0; i < block_count; i++) {
        const block_t *type = &block_table[i];
        if (strcmp(type->name, name) != 0)
            continue;
        MUST(i < BLOCKS_MOST && type->size <= BLOCK_BYTES, "%s: make the bench larger", name);
        views[i] = (block_view_t){
            .type = type, .execute = place_of(type, "Execute"), .enable = place_of(type, "Enable"),
            .done = place_of(type, "Done"), .reached = first_place(type, reached), .busy = place_of(type, "Busy"),
            .active = place_of(type, "Active"), .aborted = place_of(type, "CommandAborted"),
            .error = place_of(type, "Error"), .error_id = place_of(type, "ErrorID"), .valid = first_place(type, valid),
            .axis = first_place(type, axis), .group = place_of(type, "AxesGroup"),
            .buffer_mode = place_of(type, "BufferMode"),
        };
        return &views[i];
    }
    bench_fail("there is no block %s", name);
}

bool flag(const instance_t *fb, uint16_t place) { return place != NOWHERE && fb->memory[place]; }

const char *name_of(const instance_t *fb) { return fb->view->type->name; }

void put(instance_t *fb, const char *name, double value)
{
    const block_member_t *m = member_of(fb->view->type, name);
    if (!m)
        return;
    void *place = fb->memory + m->offset;
    switch (m->type) { /* a number that one type does not have may be meant for another one */
    case BLOCK_BOOL: *(BOOL *)place = value != 0; break;
    case BLOCK_INT:
    case BLOCK_UINT:
    case BLOCK_WORD: memcpy(place, &(INT){(INT)value}, sizeof(INT)); break;
    case BLOCK_LREAL: memcpy(place, &value, sizeof value); break;
    case BLOCK_TIME: memcpy(place, &(TIME){(TIME)value}, sizeof(TIME)); break;
    case BLOCK_DINT:
    case BLOCK_UDINT:
    case BLOCK_DWORD:
    case BLOCK_ENUM: memcpy(place, &(int){(int)value}, sizeof(int)); break;
    case BLOCK_STRING:
    case BLOCK_STRUCT:
    case BLOCK_POINTER: bench_fail("%s.%s cannot be put", name_of(fb), name);
    }
}

double real_of(const instance_t *fb, const char *name)
{
    const block_member_t *m = member_of(fb->view->type, name);
    LREAL value;
    MUST(m && m->type == BLOCK_LREAL, "%s.%s is no LREAL", name_of(fb), name);
    memcpy(&value, fb->memory + m->offset, sizeof value);
    return value;
}

void point_at(instance_t *fb, const char *name, const void *what)
{
    const block_member_t *m = member_of(fb->view->type, name);
    if (m)
        memcpy(fb->memory + m->offset, &what, sizeof what);
}

/* ---- judging one call -------------------------------------------------------------------------------------------- */

static shown_t look(const instance_t *fb)
{
    const block_view_t *v = fb->view;
    shown_t now = {.trigger = flag(fb, v->execute) || flag(fb, v->enable), .done = flag(fb, v->done),
                   .reached = flag(fb, v->reached), .busy = flag(fb, v->busy), .active = flag(fb, v->active),
                   .aborted = flag(fb, v->aborted), .error = flag(fb, v->error), .valid = flag(fb, v->valid)};
    if (v->error_id != NOWHERE)
        memcpy(&now.error_id, fb->memory + v->error_id, sizeof now.error_id);
    return now;
}

#define RULE(condition, rule)                                                                                        \
    MUST(condition, "%s: %s (trigger %d, Done %d, Busy %d, Active %d, CommandAborted %d, Error %d 0x%04X, "          \
         "reached %d, Valid %d)", name_of(fb), rule, now->trigger, now->done, now->busy, now->active, now->aborted,  \
         now->error, now->error_id, now->reached, now->valid)

/* 2.4.1 for blocks with Execute: rules E6 ... E10, E14. */
static void judge_execute(const instance_t *fb)
{
    const shown_t *now = &fb->now, *before = &fb->before;
    const bool edge = now->trigger && !before->trigger;
    const int results = now->done + now->aborted + now->error;
    const bool stop = strcmp(name_of(fb), "MC_Stop") == 0;
    RULE(results + now->busy <= 1, "outputs exclude each other");
    RULE(!now->trigger || results + now->busy == 1, "Execute and no output");
    RULE(!now->active || (!now->aborted && !now->error && (!now->done || stop)), "Active with a result");
    RULE(!now->active || now->busy || stop, "Active without Busy");
    RULE(!now->reached || (now->busy && now->active), "the set value is reached by a block that is not Active");
    RULE(!now->busy || before->busy || edge, "Busy without an edge");
    RULE(!before->busy || now->busy || results || edge, "Busy fell and nothing rose");
    RULE(now->trigger || !results || before->busy, "a result outlives Execute");
    RULE(edge || !before->trigger || !now->trigger || before->busy || now->busy == before->busy, "it woke up again");
}

/* 2.4.1 and 2.2.3 for blocks with Enable: N1 ... N4. */
static void judge_enable(const instance_t *fb)
{
    const shown_t *now = &fb->now;
    RULE(!(now->valid && now->error), "Valid and Error");
    RULE(now->trigger || (!now->valid && !now->busy && !now->error), "an output without Enable");
    RULE(!now->valid || now->busy, "Valid without Busy");
    RULE(!now->trigger || now->busy || now->error, "Enable and neither Busy nor Error");
}

/* It is in MC_Halt or MC_Stop. */
static bool stops(const cm1e_axis_t *axis)
{
    return axis->commands.active &&
           (axis->commands.kind == CM1E_COMMAND_HALT || axis->commands.kind == CM1E_COMMAND_STOP);
}

/* What a call may do to the state of the axis: nothing but what the block's rules say, and that at an edge only. */
static void judge_state(instance_t *fb, cm1e_axis_state_t before, bool may_wait)
{
    const block_t *type = fb->view->type;
    const shown_t *now = &fb->now;
    const cm1e_axis_state_t after = judged.axis->state;
    const bool edge = now->trigger && !fb->before.trigger;
    judged.searched = judged.searched || after == CM1E_AXIS_HOMING;
    judged.stopped = stops(judged.axis);
    const bool free_to_change = edge && !now->error && type->rules && !type->rules[before].unchanged;
    /* MC_Reset, MC_Jog, the ends of a homing: tested where they are. A command that cannot go on under another override
     * ends with that error, and the next one begins (2.2.2, case 2). */
    const bool in_words = !type->rules || strcmp(type->name, "MC_SetOverride") == 0;
    if (edge)
        fb->refused = now->error;
    if (strcmp(type->name, "MC_Reset") == 0 && edge && !now->error)
        judged.reset_asked = true;
    /* Standstill again: it ends in this very cycle, and is in its own state until then. */
    const bool ends_homing = strcmp(type->name, "MC_HomeDirect") == 0 && before == CM1E_AXIS_HOMING &&
                             after == CM1E_AXIS_STANDSTILL;
    const bool ends_at_once = ends_homing || (type->rules && type->rules[before].next == CM1E_AXIS_STANDSTILL);
    if (after != before && !in_words)
        MUST(free_to_change && type->rules[before].refusal == CM1E_OK &&
                 (type->rules[before].next == after || ends_at_once),
             "%s: from %s to %s (edge %d, Error 0x%04X)", type->name, cm1e_axis_state_name(before),
             cm1e_axis_state_name(after), edge, now->error_id);
    const bool stop_again = strcmp(type->name, "MC_Stop") == 0 && before == CM1E_AXIS_STOPPING; /* may brake anew */
    const bool refuses = type->rules && !type->rules[before].unchanged && type->rules[before].refusal != CM1E_OK;
    if (edge && !may_wait && !stop_again && refuses)
        MUST(now->error, "%s is taken in %s", type->name, cm1e_axis_state_name(before));
    judged.state = after;
}

const cm1e_group_t *group_of(const instance_t *fb)
{
    const AXES_GROUP_REF_t *reference = NULL;
    if (fb->view->group != NOWHERE)
        memcpy(&reference, fb->memory + fb->view->group, sizeof reference);
    return cm1e_group_from_reference(reference);
}

/* A block of a group may take its members while they stand, let them go again, and reset them; nothing else, and no
 * other axis. `members`: bits of those it had before the call. */
static void judge_members(const instance_t *fb, unsigned members)
{
    const bool resets = strcmp(name_of(fb), "MC_GroupReset") == 0 && fb->now.trigger && !fb->before.trigger;
    for (int n = 0; n < JUDGED_MOST; n++) {
        struct judged_axis *one = &judged_axes[n];
        if (!one->axis)
            continue;
        const cm1e_axis_state_t before = one->state, after = one->axis->state;
        const bool member = members >> n & 1u;
        const bool taken = before == CM1E_AXIS_STANDSTILL && after == CM1E_AXIS_SYNCHRONIZED_MOTION;
        const bool freed = before == CM1E_AXIS_SYNCHRONIZED_MOTION && after == CM1E_AXIS_STANDSTILL && one->led;
        MUST(after == before || (member && (taken || freed)), "%s brings axis %d, member %d, from %s to %s",
             name_of(fb), n, member, cm1e_axis_state_name(before), cm1e_axis_state_name(after));
        one->reset_asked = one->reset_asked || (resets && member && !fb->now.error);
        one->state = after;
        one->led = one->axis->setpoint.source == &cm1e_source_leader;
    }
}

static unsigned members_of(const cm1e_group_t *group)
{
    unsigned members = 0;
    for (int n = 0; n < JUDGED_MOST && group; n++)
        if (judged_axes[n].axis && judged_axes[n].axis->belongs.group == group)
            members |= 1u << n;
    return members;
}

/* A block acts on its own axis only; what it makes others do comes with the cycle. */
static void judge_others(const instance_t *fb)
{
    for (int n = 0; n < JUDGED_MOST; n++)
        if (n != fb->of && judged_axes[n].axis)
            MUST(judged_axes[n].axis->state == judged_axes[n].state, "%s brings axis %d from %s to %s", name_of(fb), n,
                 cm1e_axis_state_name(judged_axes[n].state), cm1e_axis_state_name(judged_axes[n].axis->state));
}

void call(instance_t *fb)
{
    const block_view_t *v = fb->view;
    judged_at = fb->of;
    const cm1e_axis_state_t state = judged.axis->state;
    /* MC_GearInPos waits for its StartSync, alone or behind another command. */
    const bool before_it = judged.axis->commands.active || judged.axis->commands.waiting.count > 0 ||
                           (judged.axis->coupling && judged.axis->coupling->awaited);
    const bool may_wait = before_it && v->buffer_mode != NOWHERE && fb->memory[v->buffer_mode] != mcAborting;
    MUST(state == judged.state, "the state changed from %s to %s between two calls", cm1e_axis_state_name(judged.state),
         cm1e_axis_state_name(state));
    const cm1e_group_t *group = group_of(fb);
    const unsigned members = members_of(group);
    fb->before = fb->now;
    v->type->call(fb->memory);
    fb->now = look(fb);
    const shown_t *now = &fb->now;
    if (v->error_id != NOWHERE)
        RULE(now->error == (now->error_id != 0) && (!now->error || cm1e_error_from_id(now->error_id) < 0),
             "Error and ErrorID");
    if (v->execute != NOWHERE)
        judge_execute(fb);
    else if (v->valid != NOWHERE && v->busy != NOWHERE)
        judge_enable(fb);
    if (group) {
        judge_members(fb, members);
        return;
    }
    judge_state(fb, state, may_wait);
    judge_others(fb);
}

/* ---- watching the set-point -------------------------------------------------------------------------------------- */

struct watched_axis watched_axes[JUDGED_MOST];

bool set_point_is_ours(void)
{
    return !axis_free(judged.axis) && !drive_moves(judged.axis);
}

/* An axis that stands outside its software limits may come back but go no farther; nor farther than it brakes when the
 * limits or its coordinates are changed under way. */
static void watch_limits(void)
{
    const cm1e_axis_t *axis = judged.axis;
    const double now = cm1e_axis_units(axis, axis->setpoint.position), tolerance = 0.02 / fabs(axis->position.scale);
    const double way = axis->setpoint.velocity * axis->setpoint.velocity / (2.0 * axis->limits.maximum.deceleration) +
                       2.0 * fabs(axis->setpoint.velocity) * (double)judged.cycle_ns * 1e-9;
    const bool changed = axis->limits.lower != watched.lower || axis->limits.upper != watched.upper ||
                         cm1e_axis_units(axis, watched.set) != watched.units;
    /* Where the limits are is not known before a homing; what follows it begins wherever it was. */
    const bool stopped = (watched.searched || judged.searched) && axis->state == CM1E_AXIS_STOPPING;
    const bool searches = axis->state == CM1E_AXIS_HOMING || stopped;
    const bool searched = searches || judged.searched; /* it may have failed in the cycle in which it began */
    watched.searched = searches;
    judged.searched = false;
    if (!axis->limits.software_limits || !watched.ours || axis->setpoint.velocity == 0.0 || changed || searched) {
        watched.lowest = fmin(axis->limits.lower, now - way) - tolerance;
        watched.highest = fmax(axis->limits.upper, now + way) + tolerance;
    }
    if (axis->state == CM1E_AXIS_ERROR_STOP && watched.lost) { /* it brakes where a load has turned the motor to */
        const double actual = cm1e_axis_units(axis, axis_actual(axis));
        watched.lowest = fmin(watched.lowest, actual - way - tolerance);
        watched.highest = fmax(watched.highest, actual + way + tolerance);
    }
    watched.lower = axis->limits.lower;
    watched.upper = axis->limits.upper;
    if (axis->limits.software_limits)
        MUST(now >= watched.lowest && now <= watched.highest, "the set position %.9g is outside %.9g ... %.9g", now,
             watched.lowest, watched.highest);
}

/* It follows what has no limit of acceleration or jerk by its nature: an actual value, a cam of straight lines; or a
 * slave that does. */
static bool follows_roughly(const cm1e_axis_t *axis, int depth)
{
    const follow_t *follow = axis_follows(axis) ? axis->coupling->now : NULL;
    if (!follow || depth == 0)
        return false;
    bool rough = follow->linear || follow->by_actual;
    for (int i = 0; i < follow->count; i++)
        rough = rough || (follow->links[i].master && follows_roughly(follow->links[i].master, depth - 1));
    return rough;
}

/* u; by how much its set-point may be rounded: a slave's as much as its master's too, by the ratio. */
static double rounding_of(const cm1e_axis_t *axis, int depth)
{
    const follow_t *follow = axis_follows(axis) ? axis->coupling->now : NULL;
    double rounding = 1e-3 / fabs(axis->position.scale);
    for (int i = 0; follow && depth > 0 && i < follow->count; i++)
        if (follow->links[i].master)
            rounding += fabs(follow->links[i].ratio) * rounding_of(follow->links[i].master, depth - 1);
    return rounding;
}

/* u; the largest number that its set position is computed with, and rounded as: an axis counts from its target; the
 * path of a group goes in u from the zero of the coordinates to its ends, which may be at 4e9 u. */
static double largest_number(const cm1e_axis_t *axis)
{
    const cm1e_group_t *const group = axis->belongs.group;
    if (group && !axis->commands.active) /* led, maybe for this cycle alone */
        return fmax(fabs(group->path.end[axis->leader ? axis->leader->index : 0]), fabs(cm1e_axis_place(axis, false)));
    return fabs(cm1e_position_minus(axis->setpoint.target, axis->setpoint.position) / axis->position.scale);
}

void pause_of_master(int64_t pause_ns)
{
    cm1e_axis_after_pause(judged.axis, pause_ns);
    watched.ours = watched.ours && judged.axis->mode == CM1E_MODE_CSP;
    watched.velocity = watched.acceleration = 0;
    judged.state = judged.axis->state; /* a table over time ends by it */
}

/* Parameters may be changed under way: what was planned before keeps to what they were. */
static const cm1e_motion_limits_t *limits_in_force(void)
{
    const cm1e_motion_limits_t *now = &judged.axis->limits.maximum;
    if (!watched.ours || watched.resting)
        watched.most = watched.maximum;
    watched.resting = axis_holds(judged.axis);
    watched.maximum = *now;
    if (axis_follows(judged.axis)) /* the bounds of commands are lowered by parameters, not these */
        now = &judged.axis->limits.system;
    watched.most.velocity = fmax(watched.most.velocity, now->velocity);
    watched.most.acceleration = fmax(watched.most.acceleration, now->acceleration);
    watched.most.deceleration = fmax(watched.most.deceleration, now->deceleration);
    watched.most.jerk = fmax(watched.most.jerk, now->jerk);
    return &watched.most;
}

/* Where a ramp without limit of jerk is left for a motion, more than the axis's is needed to keep its velocity. */
static double jerk_to_stay_below(const cm1e_motion_limits_t *most)
{
    const double a = watched.acceleration, room = most->velocity - (a > 0 ? watched.velocity : -watched.velocity);
    return a * a / (2.0 * fmax(room, 1e-9 * most->velocity));
}

#define KEEPS(condition, format, ...)                                                                                \
    MUST(condition, "%s, command kind %d: " format, cm1e_axis_state_name(judged.axis->state), \
         (int)judged.axis->commands.kind, __VA_ARGS__)

/* While no answer comes the time of the set-points stands still; with the first one the motor goes on no faster than it
 * did. true: nothing else is to be said of this cycle. */
static bool watch_silence(void)
{
    const cm1e_axis_t *axis = judged.axis;
    const double way = cm1e_position_minus(axis->setpoint.position, watched.set) / axis->position.scale;
    const double v = axis->setpoint.velocity;
    const double gain = fmax(axis->limits.system.acceleration, axis->limits.system.deceleration) *
                                                     (double)judged.cycle_ns * 1e-9;
    if (axis->silence.frozen)
        KEEPS(way == 0.0, "the set position moves by %.9g while no frame comes back", way);
    else if (axis->silence.began_anew)
        KEEPS((v * watched.velocity >= 0.0 || fabs(v) <= gain) && fabs(v) <= fabs(watched.velocity) + gain,
              "after silence %.9g u/s, before %.9g", v, watched.velocity);
    return axis->silence.frozen || axis->silence.began_anew;
}

void watch_set_point(void)
{
    const cm1e_axis_t *axis = judged.axis;
    watch_limits();
    const double far = largest_number(axis);
    const cm1e_motion_limits_t *most = limits_in_force();
    const double t = (double)judged.cycle_ns * 1e-9, v = axis->setpoint.velocity, a = axis->setpoint.acceleration;
    const bool stop = axis->setpoint.source != &cm1e_source_leader &&
                      (!axis->commands.active || stops(axis) || judged.stopped || axis->setpoint.paused);
    const bool ours = set_point_is_ours(), stepping = watched.searched; /* lets go of what it pushes at */
    watched.rough = follows_roughly(axis, JUDGED_MOST) || (watched.rough && ours && watched.velocity != 0.0);
    /* Without an answer nobody knows that the torque is off: the ramp goes on. A motor that turns when it gets its torque is
     * braked before the axis is taken over. */
    const bool by_ramp = axis->state == CM1E_AXIS_DISABLED && (!axis->drive.answered || !axis->power.energized);
    const bool is_hard = axis->state == CM1E_AXIS_ERROR_STOP || stepping || by_ramp ||
                         (stop && axis->limits.software_limits) || watched.rough;
    /* A motor that was ahead when it was heard again: the set-point goes after it. */
    const bool hard = is_hard || watched.hard || axis_has_extra(axis, EXTRA_PURSUIT);
    const double largest = fmax(most->acceleration, most->deceleration), slack = 1.0 + 1e-6;
    const bool taken_over = watched.disabled && axis->state == CM1E_AXIS_STANDSTILL && v == 0.0 && a == 0.0 &&
                            cm1e_position_minus(axis->setpoint.position, axis_actual(axis)) == 0.0;
    const bool goes_on = ours && watched.ours && !watched.lost && !taken_over;
    const double most_jerk = most->jerk + jerk_on_coupling(axis, &watched.on_coupling);
    if (axis->state == CM1E_AXIS_DISABLED && watched.disabled && !axis->power.energized && v != 0.0 &&
        watched.velocity == 0.0 && !axis->silence.resumed) {
        const double motor = axis_actual_velocity(axis) / axis->position.scale;
        watched.ramps++;
        KEEPS(v * motor > 0.0 && fabs(v) <= fabs(motor) * slack, "it is braked from %.9g u/s, and turns at %.9g", v, motor);
    }
    /* The motor turned by itself: the limits that the program has lowered were none for it. */
    const double fastest = by_ramp && !axis->power.energized ? axis->limits.system.velocity : most->velocity;
    if (goes_on && !watched.rough) /* a hard one too */
        KEEPS(fabs(v) <= fastest * slack, "velocity %.12g, limit %.12g", v, fastest);
    if (goes_on && !hard && !watch_silence()) {
        const double way = cm1e_position_minus(axis->setpoint.position, watched.set) / axis->position.scale;
        const double jerk = fabs(a - watched.acceleration) / t, gain = fabs(v - watched.velocity);
        const double rounding = rounding_of(axis, JUDGED_MOST) + 4e-16 * fmax(far, watched.far);
        const double off = fabs(way - (v + watched.velocity) * t / 2.0);
        KEEPS(fabs(a) <= largest * slack, "acceleration %.12g, limit %.12g", a, largest);
        /* Of a set-point that is not of its own making the axis accepts 1e-5 counts of rounding (axis_guard.c). */
        const double guarded = axis->state == CM1E_AXIS_SYNCHRONIZED_MOTION ? 1e-5 / fabs(axis->position.scale) : 0.0;
        KEEPS(gain <= largest * t * slack + guarded + 1e-12, "velocity from %.9g to %.9g in a cycle",
              watched.velocity, v);
        KEEPS(jerk <= fmax(most_jerk, jerk_to_stay_below(most)) * slack + 1e-9,
              "jerk %.9g, limit %.9g (acceleration from %.9g to %.9g, velocity %.9g)", jerk, most_jerk,
             watched.acceleration, a, v);
        KEEPS(off <= most_jerk * t * t * t / 6.0 * slack + rounding,
             "the position moves by %.9g, the velocities are %.9g and %.9g", way, watched.velocity, v);
    }
    KEEPS(keeps_velocity_diff(axis, &watched.on_coupling), "a superimposed motion of %.9g u/s, right is %.9g",
          axis->superimposed.now.velocity, axis->superimposed.plan.limits.velocity);
    judged.stopped = false;
    watched.hard = is_hard;
    watched.moving += ours && v != 0.0;
    watched.ours = ours;
    watched.disabled = axis->state == CM1E_AXIS_DISABLED;
    watched.set = axis->setpoint.position;
    watched.far = far;
    watched.units = cm1e_axis_units(axis, axis->setpoint.position);
    watched.velocity = v;
    watched.acceleration = a;
    watched.lost = fabs(cm1e_position_minus(axis->setpoint.position, axis_actual(axis)) / axis->position.scale) > 0.9 *
                   axis->limits.max_lag;
}

/* ---- the cycle --------------------------------------------------------------------------------------------------- */

void judge_cycle(void)
{
    static const unsigned to[CM1E_AXIS_STATE_COUNT] = {
        [CM1E_AXIS_DISABLED] = 1u << CM1E_AXIS_STANDSTILL,
        [CM1E_AXIS_DISCRETE_MOTION] = 1u << CM1E_AXIS_STANDSTILL,
        [CM1E_AXIS_HOMING] = 1u << CM1E_AXIS_STANDSTILL,
        [CM1E_AXIS_STOPPING] = 1u << CM1E_AXIS_STANDSTILL,
        [CM1E_AXIS_ERROR_STOP] = 1u << CM1E_AXIS_DISABLED | 1u << CM1E_AXIS_STANDSTILL,
    };
    const unsigned begins = 1u << CM1E_AXIS_DISCRETE_MOTION | 1u << CM1E_AXIS_CONTINUOUS_MOTION |
                            1u << CM1E_AXIS_HOMING | 1u << CM1E_AXIS_SYNCHRONIZED_MOTION |
                            1u << CM1E_AXIS_STANDSTILL; /* a halt that ends at once */
    const cm1e_axis_state_t before = judged.state, after = judged.axis->state;
    bool waits = judged.waited;
    const bool led = judged.led; /* its group has come to rest, and lets it go with the last set-point */
    const bool kept = judged.kept && before == CM1E_AXIS_CONTINUOUS_MOTION; /* else it is halted in the cycle */
    judged.led = judged.axis->setpoint.source == &cm1e_source_leader;
    judged.kept = judged.axis->commands.kept != 0;
    judged.waited = judged.axis->commands.waiting.count > 0;
    if (after == before)
        return;
    for (int i = 0; i < called_count; i++)
        waits = waits || (called[i]->of == judged_at &&
                          ((called[i]->before.busy && !called[i]->before.active) ||
                           (called[i]->now.busy && !called[i]->now.active)));
    const bool let_go = led && before == CM1E_AXIS_SYNCHRONIZED_MOTION;
    const unsigned allowed = to[before] | 1u << CM1E_AXIS_ERROR_STOP | (waits ? begins : 0) |
                             (let_go ? 1u << CM1E_AXIS_STANDSTILL : 0) | (kept ? 1u << CM1E_AXIS_DISCRETE_MOTION : 0);
    MUST(allowed >> after & 1u, "from %s to %s in the cycle, a command waits: %d", cm1e_axis_state_name(before),
         cm1e_axis_state_name(after), waits);
    MUST(before != CM1E_AXIS_ERROR_STOP || judged.reset_asked, "ErrorStop was left without MC_Reset");
    judged.reset_asked = false;
    judged.state = after;
}

/* ---- making blocks ----------------------------------------------------------------------------------------------- */

static const MC_TP_REF table_of_positions = {
    .NumberOfPairs = 3, .MC_TP_Array = {{500000000, 0.2}, {500000000, 0.5}, {500000000, 0.7}}};
static const MC_TV_REF table_of_velocities = {
    .NumberOfPairs = 2, .MC_TV_Array = {{200000000, 1}, {200000000, 2}}};
static const MC_TA_REF table_of_accelerations = {.NumberOfPairs = 2, .IsAbsolute = TRUE,
                                                 .MC_TA_Array = {{100000000, 20}, {100000000, 10}}};
static MC_OUTPUT_REF output_of_axis;
static MC_INPUT_REF input_of_axis;
static MC_TRIGGER_REF trigger_of_axis;
const MC_CAM_POINT cam_points[] = {{0, 0, 0, 0}, {5, 2, 0, 0}, {10, 0, 0, 0}};
static const MC_CAM_REF cam_of_master = {.Points = cam_points, .NumberOfPoints = 3};
static const MC_CAMSWITCH_REF cam_switches = {
    .NumberOfSwitches = 1, .Switches = {{.TrackNumber = 1, .FirstOnPosition = 1, .LastOnPosition = 2}}};

void begin_blocks(void)
{
    called_count = 0;
    output_of_axis.Axis = input_of_axis.Axis = trigger_of_axis.Axis = judged.reference;
}

void put_in_reach(instance_t *fb, const char *name)
{
    MC_CAM_ID cam = 0;
    cm1e_axis_info_t slave, master;
    cm1e_axis_t *const followed = judged.master.Handle ? cm1e_axis_from_reference(&judged.master) : NULL;
    if (strcmp(name, "MC_CamIn") == 0 && judged.axis) {
        (void)cm1e_axis_cam_select(judged.axis, &cam_of_master, true, true, true, &cam);
        put(fb, "CamTableID", cam);
        put(fb, "StartMode", mcRampIn);
    }
    if (strcmp(name, "MC_GearInPos") != 0 || !judged.axis || !followed)
        return;
    cm1e_axis_get(judged.axis, &slave);
    cm1e_axis_get(followed, &master);
    put(fb, "MasterSyncPosition", master.set_position + 20.0);
    put(fb, "SlaveSyncPosition", slave.set_position + 3.0);
    put(fb, "Velocity", 30);
}

void put_out_of_reach_of_another(instance_t *fb)
{
    if (!member_of(fb->view->type, "SlaveSyncPosition"))
        return;
    put(fb, "MasterSyncPosition", real_of(fb, "MasterSyncPosition") + 20.0);
    put(fb, "SlaveSyncPosition", real_of(fb, "SlaveSyncPosition") + 10.0);
}

void point_at_axis(instance_t *fb, const AXIS_REF_t *axis)
{
    point_at(fb, "Axis", axis);
    point_at(fb, "Slave", axis);
}

void make(instance_t *fb, const char *name)
{
    static const struct {
        const char *name;
        double value;
    } good[] = {{"Position", 5}, {"Distance", 3}, {"Velocity", 10}, {"EndVelocity", 4}, {"VelocityDiff", 5},
                {"Acceleration", 80}, {"Deceleration", 80}, {"VelFactor", 1}, {"AccFactor", 1}, {"JerkFactor", 1},
                {"RatioNumerator", 1}, {"RatioDenominator", 2}, {"GearRatioNumeratorM1", 1},
                {"GearRatioDenominatorM1", 2}, {"GearRatioNumeratorM2", 1}, {"GearRatioDenominatorM2", 4},
                {"PhaseShift", 0.5}, {"ParameterNumber", 9}, {"InputNumber", 1}, {"OutputNumber", 1},
                {"EnableMask", 1}, {"Torque", 10}};
    static const char *const masters[] = {"Master", "Master1", "Master2", NULL};
    memset(fb, 0, sizeof *fb);
    fb->view = view_of(name);
    point_at_axis(fb, &judged.reference);
    for (const char *const *master = masters; *master; master++)
        point_at(fb, *master, &judged.master);
    point_at(fb, "CamTable", &cam_of_master);
    point_at(fb, "TimePosition", &table_of_positions);
    point_at(fb, "TimeVelocity", &table_of_velocities);
    point_at(fb, "TimeAcceleration", &table_of_accelerations);
    point_at(fb, "Output", &output_of_axis);
    point_at(fb, "Outputs", &output_of_axis);
    point_at(fb, "Input", &input_of_axis);
    point_at(fb, "TriggerInput", &trigger_of_axis);
    point_at(fb, "Switches", &cam_switches);
    for (size_t i = 0; i < sizeof good / sizeof good[0]; i++)
        put(fb, good[i].name, good[i].value);
    if (strstr(name, "MC_Write") && strstr(name, "Parameter"))
        put(fb, "ParameterNumber", strstr(name, "Bool") ? 6 : 7);
    if (strstr(name, "BoolParameter"))
        put(fb, "ParameterNumber", 4);
    put_in_reach(fb, name);
    fb->of = judged_at;
    MUST(called_count < INSTANCES_MOST, "too many blocks");
    called[called_count++] = fb;
}

void trigger(instance_t *fb, bool on)
{
    const uint16_t place = fb->view->execute != NOWHERE ? fb->view->execute : fb->view->enable;
    if (place != NOWHERE)
        fb->memory[place] = on;
}
