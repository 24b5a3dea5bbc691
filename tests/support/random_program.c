#include "random_program.h"

#include <limits.h>

instance_t instances[INSTANCES_MOST];
int count;
MC_Power_t powers[JUDGED_MOST];
int axis_count = 1;
static MC_TP_REF positions;
static MC_TV_REF velocities;
static MC_TA_REF accelerations;
static MC_CAM_POINT points[8];
static MC_CAM_REF cam = {.Points = points};
AXIS_REF_t named[JUDGED_MOST + 1];
unsigned long long cycles_total, done_total, edges_total, synchronised_total;
unsigned seen[CM1E_AXIS_STATE_COUNT];

/* Of each axis. */
static struct player {
    ranges_t ranges;
    bool edge_in_cycle;             /**< who lost the axis by a call may have been called before */
    int at_rest, off_cycles, still_cycles;
    double off_velocity[JUDGED_MOST]; /**< u/s; of all axes, before its torque was to go */
    MC_CAM_ID cam;                  /**< the last one that was selected for it */
} players[JUDGED_MOST];
#define player players[judged_at]

/* What the program knows of a move that it has started. */
typedef struct story {
    bool known;        /**< nothing has happened since that would change where it ends */
    double end;        /**< u; where it goes */
    double origin;     /**< u; of the count 0: positions have not got other names since */
} story_t;
static story_t stories[INSTANCES_MOST];

/* What it knows of a gear: where both were in the first cycle with InGear. */
typedef struct sync {
    bool asked;        /**< its inputs were such that a position is kept */
    bool known;
    int master;
    cm1e_command_id_t id;
    double ratio;      /**< counts of the slave in one of the master */
    position_t master_at, slave_at;
} sync_t;
static sync_t syncs[INSTANCES_MOST];

enum { STUCK = 3000 };
static int calls_in_turn;
bool stories_touched[JUDGED_MOST];

bool is(const instance_t *fb, const char *name) { return strcmp(name_of(fb), name) == 0; }
static bool is_superimposed(const instance_t *fb) { return strstr(name_of(fb), "Superimposed") != NULL; }
/* Has a record of its own beside that of the active command. */
static bool is_on_top(const instance_t *fb) { return is_superimposed(fb) || strstr(name_of(fb), "MC_Phasing"); }
static bool is_multi(const block_t *type) { return member_of(type, "Slave") != NULL; }

void random_axis(cm1e_axis_config_t *axis)
{
    const double unit = one_in(3) ? 50000 : uniform(50, 60000);
    axis->counts_per_unit = unit;
    axis->invert = one_in(2);
    axis->max_velocity = one_in(4) ? 0 : uniform(20000, 2000000) / unit;
    axis->max_acceleration = one_in(4) ? 0 : uniform(200000, 8000000) / unit;
    axis->max_deceleration = one_in(3) ? 0 : uniform(200000, 8000000) / unit;
    axis->max_jerk = one_in(4) ? 0 : uniform(5e6, 5e8) / unit;
    axis->homing.method = (int8_t)(-1 - pick(6));
    if (one_in(4)) { /* a rotary table behind a gear */
        axis->counts_per_unit = 0;
        axis->units_per_revolution = axis->modulo_range = 360;
        axis->gear_numerator = 1 + (uint32_t)pick(20);
        axis->gear_denominator = 1 + (uint32_t)pick(7);
    }
    if (one_in(2) && axis->modulo_range == 0) {
        axis->software_limit_negative = uniform(-200000, -20000) / unit;
        axis->software_limit_positive = uniform(20000, 200000) / unit;
    }
    axis->table_profiles = one_in(2);
    axis->inputs = (cm1e_input_config_t){.limit_positive = 1, .limit_negative = 2, .home = 3};
}

/* A cam that the slave can follow at some velocity of the master, which axis that may be. */
static void random_cam(void)
{
    const ranges_t *slave = &player.ranges, *master = &players[pick(axis_count)].ranges;
    const double length = master->velocity * uniform(0.2, 2.0);
    const double way = fmin(0.3 * length * slave->velocity / master->velocity,
                            0.02 * slave->acceleration * pow(length / master->velocity, 2));
    cam.NumberOfPoints = (UINT)(2 + pick(7));
    cam.Curve = one_in(30) ? (MC_CAM_CURVE)pick(5) : (MC_CAM_CURVE)pick(3);
    for (int i = 0; i < 8; i++)
        points[i] = (MC_CAM_POINT){.Master = absurd(length * (i + uniform(0, 0.5)) / (cam.NumberOfPoints - 0.5)),
                                   .Slave = absurd(i == 0 || i == cam.NumberOfPoints - 1 ? 0 : way * uniform(0, 1))};
    if (one_in(100))
        cam.NumberOfPoints = (UINT)chance() % 300;
    if (cam.NumberOfPoints > 8)
        cam.Points = NULL;
    else
        cam.Points = points;
}

static void random_tables(void)
{
    const ranges_t ranges = player.ranges;
    random_cam();
    positions.NumberOfPairs = (WORD)(1 + pick(8));
    velocities.NumberOfPairs = (WORD)(1 + pick(8));
    accelerations.NumberOfPairs = (WORD)(1 + pick(8));
    positions.IsAbsolute = velocities.IsAbsolute = accelerations.IsAbsolute = one_in(3);
    double position = 0;
    for (int i = 0; i < 8; i++) {
        const TIME time = one_in(40) ? (TIME)chance() : (TIME)uniform(1e7, 4e8);
        position += ranges.velocity * (double)time * 1e-9 * uniform(-0.3, 0.5);
        positions.MC_TP_Array[i] = (MC_TP){time, absurd(position)};
        velocities.MC_TV_Array[i] = (MC_TV){time, absurd(ranges.velocity * uniform(-0.5, 1))};
        accelerations.MC_TA_Array[i] = (MC_TA){time, absurd(ranges.acceleration * uniform(-0.5, 0.5))};
    }
}

/* Of the axis judged_at: all blocks but MC_Power, which the bench calls; two of those that may follow each other. Of
 * several axes each has half of the others. */
static void make_blocks(void)
{
    for (size_t i = 0; i < block_count; i++) {
        const block_t *type = &block_table[i];
        if (!member_of(type, "Error") || strcmp(type->name, "MC_Power") == 0 || member_of(type, "AxesGroup"))
            continue;
        if (axis_count > 1 && !is_multi(type) && strcmp(type->name, "MC_Reset") != 0 && one_in(2))
            continue;
        for (int copies = member_of(type, "BufferMode") ? 2 : 1; copies > 0; copies--) {
            make(&instances[count], type->name);
            point_at(&instances[count], "CamTable", &cam);
            point_at(&instances[count], "TimePosition", &positions);
            point_at(&instances[count], "TimeVelocity", &velocities);
            point_at(&instances[count++], "TimeAcceleration", &accelerations);
        }
    }
}

void begin_program(void)
{
    count = 0;
    memset(players, 0, sizeof players);
    memset(named, 0, sizeof named);
    for (int n = 0; n < axis_count; n++) {
        judged_at = n;
        const cm1e_motion_limits_t *most = &judged.axis->limits.maximum;
        player.ranges = (ranges_t){150000 / fabs(judged.axis->position.scale), most->velocity, most->acceleration,
                                   most->deceleration, most->jerk};
        named[n] = judged.reference;
        judged.master = named[pick(axis_count)];
        make_blocks();
    }
    make_groups();
    memset(stories, 0, sizeof stories);
    memset(syncs, 0, sizeof syncs);
    calls_in_turn = 0;
}

/* ---- one block --------------------------------------------------------------------------------------------------- */

/* Of the axis judged_at. */
static void forget_stories(void)
{
    for (int i = 0; i < count; i++)
        if (instances[i].of == judged_at)
            stories[i].known = false;
}

double origin(void) { return cm1e_axis_units(judged.axis, (position_t){0, 0.0}); }

/* A move that is Done stands where it was to go, if nothing else has touched it. */
static void judge_arrival(int n)
{
    const instance_t *fb = &instances[n];
    done_total++;
    const bool rests = judged.axis->state == CM1E_AXIS_STANDSTILL && !judged.axis->commands.active;
    if (!stories[n].known || stories[n].origin != origin() || !rests)
        return;
    const double end = stories[n].end;
    const double scale = fabs(judged.axis->position.scale);
    const double off = (cm1e_axis_units(judged.axis, judged.axis->setpoint.position) - end) * scale;
    /* Three roundings to a double in u: of where it began, of where that is to end, and of where it is. */
    MUST(fabs(off) < 0.01 + fabs(end) * scale * 4e-16, "%s is Done, but stands %.6g counts beside %.9g",
         name_of(fb), off, end);
}

/* What the program knows of the move that has just been started. */
static story_t story_of(const instance_t *fb, double set)
{
    const bool absolute = is(fb, "MC_MoveAbsolute"), relative = is(fb, "MC_MoveRelative");
    if (!(absolute || relative) || !fb->now.busy || judged.axis->position.modulo_range != 0)
        return (story_t){0};
    const bool updates = fb->memory[place_of(fb->view->type, "ContinuousUpdate")];
    const bool aborting = *(const int *)(const void *)(fb->memory + fb->view->buffer_mode) == mcAborting;
    return (story_t){.known = aborting && !updates, .origin = origin(),
                     .end = absolute ? real_of(fb, "Position") : set + real_of(fb, "Distance")};
}

static int integer_of(const instance_t *fb, const char *name)
{
    const block_member_t *m = member_of(fb->view->type, name);
    int value;
    memcpy(&value, fb->memory + m->offset, sizeof value);
    return value;
}

static const AXIS_REF_t *pointer_of(const instance_t *fb, const char *name)
{
    const block_member_t *m = member_of(fb->view->type, name);
    const AXIS_REF_t *value;
    memcpy(&value, fb->memory + m->offset, sizeof value);
    return value;
}

/* CM1E_TEST_TELL=<cycle>: from there on every edge is told, for who repeats a seed. */
static void tell(const instance_t *fb, const from_t *from)
{
    static long long first = -1;
    if (first < 0)
        first = getenv("CM1E_TEST_TELL") ? atoll(getenv("CM1E_TEST_TELL")) : LLONG_MAX;
    if (judged.number < first)
        return;
    fprintf(stderr, "%lld: axis %d: %s from %.17g, %.17g u/s, %.17g u/s2: ErrorID 0x%04X, %s;", judged.number,
            judged_at, name_of(fb), cm1e_axis_units(judged.axis, from->position), from->velocity, from->acceleration,
            fb->now.error_id, cm1e_axis_state_name(judged.axis->state));
    for (size_t i = 0; i < fb->view->type->member_count; i++) {
        const block_member_t *m = &fb->view->type->members[i];
        if (m->type == BLOCK_LREAL && m->section == BLOCK_INPUT)
            for (size_t k = 0; k < m->size / sizeof(LREAL); k++)
                fprintf(stderr, " %s %.17g", m->name, ((const LREAL *)(const void *)(fb->memory + m->offset))[k]);
        else if (m->type == BLOCK_ENUM && m->section == BLOCK_INPUT)
            fprintf(stderr, " %s %d", m->name, *(const int *)(const void *)(fb->memory + m->offset));
        else if (m->type == BLOCK_BOOL && m->section == BLOCK_INPUT && fb->memory[m->offset])
            fprintf(stderr, " %s", m->name);
        else if ((m->type == BLOCK_DINT || m->type == BLOCK_UDINT) && m->section == BLOCK_INPUT)
            fprintf(stderr, " %s %d", m->name, *(const DINT *)(const void *)(fb->memory + m->offset));
        else if (m->type == BLOCK_POINTER && (strncmp(m->name, "Master", 6) == 0))
            fprintf(stderr, " %s %d", m->name, (int)(pointer_of(fb, m->name) - named));
        else if (m->type == BLOCK_INT && m->section == BLOCK_INPUT)
            fprintf(stderr, " %s %d", m->name, *(const INT *)(const void *)(fb->memory + m->offset));
    }
    fputc('\n', stderr);
}

/* ---- gears ------------------------------------------------------------------------------------------------------- */

/* What an MC_GearIn that has just been started is to keep. */
static sync_t sync_of(const instance_t *fb)
{
    const AXIS_REF_t *master = pointer_of(fb, "Master");
    const int n = master ? (int)(master - named) : axis_count;
    if (n >= axis_count || !fb->now.busy || integer_of(fb, "MasterValueSource") != mcSetValue)
        return (sync_t){0};
    const double ratio = (double)integer_of(fb, "RatioNumerator") / (UDINT)integer_of(fb, "RatioDenominator");
    return (sync_t){.asked = !fb->memory[place_of(fb->view->type, "ContinuousUpdate")], .master = n,
                    .ratio = ratio * judged.axis->position.scale / judged_axes[n].axis->position.scale};
}

/* InGear: the slave is where it has to be by where both were when that began. After the set-points. */
static void judge_sync(int n)
{
    const instance_t *fb = &instances[n];
    judged_at = fb->of;
    sync_t *sync = &syncs[n];
    const cm1e_axis_t *slave = judged.axis, *master = judged_axes[sync->master].axis;
    const bool moved_else = slave->superimposed.id != 0 || (slave->coupling && slave->coupling->phasing.moving);
    const bool in_gear = fb->now.reached && slave->setpoint.reached && slave->commands.kind == CM1E_COMMAND_GEAR_IN;
    if (!sync->asked || !in_gear || slave->coupling->now->by_actual || moved_else ||
        slave->commands.active != sync->id) {
        sync->id = fb->now.active ? slave->commands.active : 0;
        sync->known = false;
        return;
    }
    /* While no answer comes its time stands still; in the first cycle after that it has lost such a master. */
    if (axis_free(master)) {
        MUST(slave->silence.frozen, "InGear with a master that has no torque");
        return;
    }
    if (!sync->known) {
        sync->known = true;
        sync->master_at = master->setpoint.position;
        sync->slave_at = slave->setpoint.position;
        return;
    }
    const double way = cm1e_position_minus(master->setpoint.position, sync->master_at) * sync->ratio;
    const double off = cm1e_position_minus(slave->setpoint.position, sync->slave_at) - way;
    const double v = sync->ratio * master->setpoint.velocity * master->position.scale / slave->position.scale;
    synchronised_total++;
    MUST(fabs(off) <= 0.1 + 1e-9 * fabs(way), "InGear, and %.6g counts beside, after %.9g", off, way);
    MUST(fabs(slave->setpoint.velocity - v) <= 1e-6 * (fabs(v) + slave->limits.maximum.velocity * 1e-3),
         "InGear with %.9g instead of %.9g u/s", slave->setpoint.velocity, v);
}

static void play(int n)
{
    instance_t *fb = &instances[n];
    judged_at = fb->of;
    const bool edge_to_come = !fb->now.trigger && flag(fb, fb->view->execute);
    const cm1e_command_id_t active = judged.axis->commands.active;
    const bool busy = fb->now.busy;
    const from_t from = from_set(judged.axis);
    const double set = edge_to_come ? cm1e_axis_units(judged.axis, judged.axis->setpoint.position) : NAN;
    double sets[JUDGED_MOST];
    for (int a = 0; a < axis_count && edge_to_come && group_count > 0; a++)
        sets[a] = cm1e_axis_units(judged_axes[a].axis, judged_axes[a].axis->setpoint.position);
    const struct random_group *group = random_group_of(fb);
    const cm1e_group_state_t group_state = group ? group->group->state : CM1E_GROUP_DISABLED;
    call(fb);
    judge_group_states(fb);
    /* What waited at 0 is done at once by a new factor. */
    if (judged.axis->commands.active != active && is(fb, "MC_SetOverride"))
        player.edge_in_cycle = true;
    if (edge_to_come && group) {
        tell(fb, &from);
        edges_total++;
        if (!fb->now.error) {
            begin_group_story(fb, n, sets, group_state);
            for (int i = 0; i < count; i++)
                stories[i].known = false;
        }
    } else if (edge_to_come) {
        tell(fb, &from);
        edges_total++;
        player.edge_in_cycle = true;
        stories_touched[fb->of] = stories_touched[fb->of] || !fb->now.error;
        stories[n] = story_of(fb, set);
        if (is(fb, "MC_GearIn"))
            syncs[n] = sync_of(fb);
        if (!fb->now.error && !fb->view->type->rules)
            forget_stories();
        if (fb->now.error && fb->view->buffer_mode != NOWHERE)
            MUST(judged.axis->commands.active == active, "%s is refused with 0x%04X, but the active command changed",
                 name_of(fb), fb->now.error_id);
        if (!fb->now.error && (is_superimposed(fb) || is(fb, "MC_SetPosition")))
            forget_stories();
    }
    if (fb->now.done && (busy || edge_to_come) && group)
        judge_group_arrival(n);
    else if (fb->now.done && busy)
        judge_arrival(n);
    if (fb->now.done && is(fb, "MC_CamTableSelect"))
        player.cam = (MC_CAM_ID)integer_of(fb, "CamTableID");
}

/* An idle block needs no call; now and then it gets one. */
static void play_all(void)
{
    const int begin = pick(count);
    calls_in_turn = (calls_in_turn + 1) % 16;
    for (int i = 0; i < count; i++) {
        const int n = (begin + i) % count;
        const instance_t *fb = &instances[n];
        const uint16_t trigger_place = fb->view->execute != NOWHERE ? fb->view->execute : fb->view->enable;
        const bool awake = trigger_place == NOWHERE || fb->memory[trigger_place] || fb->now.trigger || fb->now.busy ||
                           fb->now.done || fb->now.error || fb->now.aborted;
        if (awake || n % 16 == calls_in_turn)
            play(n);
    }
}

/* A master, and a ratio with which the slave can often follow it at full speed. */
static void choose_master(instance_t *fb, const char *name, const char *numerator, const char *denominator)
{
    if (!member_of(fb->view->type, name))
        return;
    int master = pick(axis_count);
    if (master == fb->of && !one_in(10))
        master = (master + 1) % axis_count;
    point_at(fb, name, one_in(100) ? NULL : one_in(60) ? &named[axis_count] : &named[master]);
    if (!member_of(fb->view->type, numerator) || one_in(10))
        return;
    const ranges_t *its = &players[master].ranges, *own = &player.ranges;
    const double hardest = fmax(its->acceleration, its->deceleration);
    const double most = fmin(own->velocity / its->velocity,
                             fmin(fmin(own->acceleration, own->deceleration) / hardest, own->jerk / its->jerk));
    const double ratio = most * uniform(0.02, 0.9) * (one_in(3) ? -1 : 1);
    const double parts = 1 + pick(1000) + 30 / fabs(ratio);
    put(fb, denominator, floor(fmin(parts, 1e9)));
    put(fb, numerator, ceil(fmin(fabs(ratio) * parts, 1e9)) * copysign(1, ratio));
}

static void choose_masters(instance_t *fb)
{
    choose_master(fb, "Master", "RatioNumerator", "RatioDenominator");
    choose_master(fb, "Master1", "GearRatioNumeratorM1", "GearRatioDenominatorM1");
    choose_master(fb, "Master2", "GearRatioNumeratorM2", "GearRatioDenominatorM2");
    if (member_of(fb->view->type, "CamTableID") && is(fb, "MC_CamIn") && !one_in(10))
        put(fb, "CamTableID", player.cam);
}

void act_on(instance_t *fb)
{
    judged_at = fb->of;
    const uint16_t place = fb->view->execute != NOWHERE ? fb->view->execute : fb->view->enable;
    if (is(fb, "MC_Stop") && !fb->now.trigger && !one_in(8))
        return;
    if (group_count > 0 && !fb->now.trigger && !leaves_groups_alone(fb))
        return;
    if (is(fb, "MC_SetOverride") && !one_in(4))
        return;
    if (place == NOWHERE || one_in(12)) { /* inputs at any time, also without an edge */
        random_inputs(fb, &player.ranges, place == NOWHERE);
        return;
    }
    if (!fb->memory[place]) {
        random_tables();
        random_inputs(fb, &player.ranges, true);
        choose_masters(fb);
        choose_of_group(fb);
        put(fb, "ContinuousUpdate", one_in(4));
    }
    fb->memory[place] = !fb->memory[place];
}

static bool any_in_error_stop(void)
{
    bool any = false;
    for (int n = 0; n < axis_count; n++)
        any = any || judged_axes[n].axis->state == CM1E_AXIS_ERROR_STOP;
    return any;
}

static void act(void)
{
    if (axis_count > 1 && one_in(40)) { /* a slave, and a cam for it */
        const int n = pick(count);
        if (is_multi(instances[n].view->type))
            act_on(&instances[n]);
    }
    for (int g = 0; g < group_count; g++)
        if (one_in(groups[g].state == CM1E_GROUP_MOVING ? 200 : 40))
            bring_on(&groups[g]);
    if (one_in(20))
        for (int burst = one_in(4) ? 1 + pick(6) : 1; burst > 0; burst--)
            act_on(&instances[pick(count)]);
    for (int i = 0; i < count && one_in(6); i++) { /* a command that goes on and on teaches nothing new */
        instance_t *fb = &instances[pick(count)];
        if (flag(fb, fb->view->execute) && (fb->now.done || fb->now.error || fb->now.aborted))
            trigger(fb, false);
        if ((is(fb, "MC_Stop") || is(fb, "MC_GroupStop")) && one_in(50))
            trigger(fb, false);
    }
    for (int i = 0; i < count && any_in_error_stop(); i++)
        if (judged_axes[instances[i].of].axis->state == CM1E_AXIS_ERROR_STOP && is(&instances[i], "MC_Reset") &&
            one_in(50))
            trigger(&instances[i], !instances[i].now.trigger);
}

static void act_on_power(void)
{
    MC_Power_t *power = &powers[judged_at];
    if (power->Enable ? one_in(6000) : one_in(100))
        power->Enable = !power->Enable;
    if (power->EnablePositive ? one_in(8000) : one_in(300))
        power->EnablePositive = !power->EnablePositive;
    if (power->EnableNegative ? one_in(8000) : one_in(300))
        power->EnableNegative = !power->EnableNegative;
}

/* ---- what must hold after every cycle ---------------------------------------------------------------------------- */

/* Of all axes: at most one command of an axis is Active. */
static void judge_active(void)
{
    int active[JUDGED_MOST] = {0};
    for (int i = 0; i < count; i++) {
        const instance_t *fb = &instances[i];
        if (!fb->now.active || is_on_top(fb))
            continue;
        active[fb->of] += fb->view->type->rules != NULL && !fb->view->type->rules->unchanged;
    }
    for (int n = 0; n < axis_count; n++)
        MUST(players[n].edge_in_cycle || active[n] <= 1, "%d blocks of axis %d are Active", active[n], n);
}

static void judge_rest(void)
{
    const cm1e_axis_t *axis = judged.axis;
    const cm1e_axis_state_t state = axis->state;
    if (state == CM1E_AXIS_STANDSTILL) {
        MUST(axis->setpoint.velocity == 0.0 && axis->setpoint.acceleration == 0.0, "Standstill with the velocity %g",
             axis->setpoint.velocity);
        MUST(!axis->commands.active, "Standstill with an active command");
    }
    player.at_rest = state == CM1E_AXIS_STANDSTILL ? player.at_rest + 1 : 0;
    const bool off = state == CM1E_AXIS_ERROR_STOP || !powers[judged_at].Enable;
    double longest_s = 0;
    for (int n = 0; n < axis_count; n++) { /* a master that keeps its ratio brakes as its slave can */
        const cm1e_motion_limits_t *most = &judged_axes[n].axis->limits.maximum;
        if (!off)
            player.off_velocity[n] = fabs(judged_axes[n].axis->setpoint.velocity);
        const double velocity = fmax(most->velocity, player.off_velocity[n]); /* the maximum may be lowered */
        longest_s = fmax(longest_s, velocity / most->deceleration + 2 * most->deceleration / most->jerk +
                                        2 * sqrt(velocity / most->jerk) + 0.2);
    }
    longest_s += 10.5 * (drive_homes(axis));
    player.off_cycles = off ? player.off_cycles + 1 : 0;
    MUST(player.off_cycles * (double)judged.cycle_ns * 1e-9 < longest_s || !has_torque() || is_deaf(),
         "%s: torque is on for %d cycles", cm1e_axis_state_name(state), player.off_cycles);
}

/* Whatever is to move does: nothing hangs. */
static void judge_progress(void)
{
    const cm1e_axis_t *axis = judged.axis;
    const bool to_move = axis->state == CM1E_AXIS_DISCRETE_MOTION ||
                         (axis->state == CM1E_AXIS_STOPPING && !axis->commands.stop_held);
    /* Its override is 0, for the motion, or for the superimposed one of an axis that stands. */
    const bool on_top_paused = axis->setpoint.stands && axis->superimposed.id && axis->superimposed.paused;
    const bool paused = axis->override.velocity == 0.0 && (axis->setpoint.paused || on_top_paused);
    player.still_cycles = to_move && axis->setpoint.velocity == 0.0 && !paused ? player.still_cycles + 1 : 0;
    MUST(player.still_cycles < STUCK, "%s, and nothing has moved for %d cycles", cm1e_axis_state_name(axis->state),
         player.still_cycles);
}

static void pause_for(int64_t time_ns)
{
    if (time_ns == 0) /* the scheduler tells an axis of no such pause: to its hooks it would be the end of a silence */
        return;
    time_passes(time_ns);
    for (int n = 0; n < axis_count; n++) {
        judged_at = n;
        pause_of_master(time_ns);
    }
    for (int n = 0; n < axis_count; n++) /* it may be another's end too */
        judged_axes[n].state = judged_axes[n].axis->state;
    for (int i = 0; i < count; i++)
        syncs[i].known = false;
    judge_group_states(NULL);
}

/* A path of axes that brake as slowly as the slowest, with the others' units, needs its time. */
static void judge_groups(void)
{
    double longest_s = 0;
    for (int n = 0; n < axis_count; n++) {
        const cm1e_motion_limits_t *most = &judged_axes[n].axis->limits.maximum;
        longest_s = fmax(longest_s, most->velocity / most->deceleration + 2 * most->deceleration / most->jerk +
                                        2 * sqrt(most->velocity / most->jerk) + 0.2);
    }
    for (int g = 0; g < group_count; g++)
        judge_group(&groups[g], (int)(10 * longest_s * 1e9 / (double)judged.cycle_ns), STUCK);
}

static void judge_axis(void)
{
    judge_rest();
    judge_led();
    judge_motor();
    judge_progress();
    seen[judged.axis->state]++;
}

void one_cycle(void)
{
    cm1e_axis_state_t before[JUDGED_MOST];
    act_on_device();
    for (int n = 0; n < axis_count; n++) {
        judged_at = n;
        player.edge_in_cycle = false;
        before[n] = judged.axis->state;
        act_on_power();
    }
    cycle_begin();
    for (int n = 0; n < axis_count; n++) {
        const cm1e_axis_state_t powered = judged_axes[n].axis->state;
        MUST(powered == before[n] || powers[n].Enable || powered == CM1E_AXIS_DISABLED ||
                 powered == CM1E_AXIS_ERROR_STOP, "MC_Power of axis %d: to %s", n, cm1e_axis_state_name(powered));
    }
    judge_group_states(NULL);
    memset(stories_touched, 0, sizeof stories_touched);
    act();
    play_all();
    if (one_in(2000))
        pause_for(pick(95) * 1000000);
    cycle_end();
    judge_group_states(NULL);
    judge_active();
    for (int n = 0; n < axis_count; n++) {
        judged_at = n;
        judge_axis();
    }
    judge_groups();
    for (int i = 0; i < count && axis_count > 1; i++)
        if (syncs[i].asked)
            judge_sync(i);
    judged_at = 0;
}
