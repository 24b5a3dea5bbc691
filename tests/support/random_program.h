/**
 * @file random_program.h
 * A program that does anything with all blocks of one axis, and what must hold whatever it does. Needs a bench before
 * it, with cycle_begin(), cycle_end(), make(), `bench.power`; and the test program defines what the device does.
 * Include it once in a test program.
 */
#ifndef CM1E_TESTS_RANDOM_PROGRAM_H
#define CM1E_TESTS_RANDOM_PROGRAM_H

#include <limits.h>

#include "block_judge.h"
#include "chance.h"
#include "random_inputs.h"

/** Faults of this cycle, before it. */
static void act_on_device(void);
/** The power stage is on: the motor has torque. */
static bool has_torque(void);
/** Nobody can tell the drive anything at present. */
static bool is_deaf(void);
static void judge_motor(void);
/** The time passes in which nothing is sent. */
static void time_passes(int64_t time_ns);

static instance_t instances[BLOCKS_MOST];
static int count;
static ranges_t ranges;
static MC_TP_REF positions;
static MC_TV_REF velocities;
static MC_TA_REF accelerations;
static unsigned long long cycles_total, done_total, edges_total;
static unsigned seen[CM1E_AXIS_STATE_COUNT];

/** What the program knows of a move that it has started. */
typedef struct story {
    bool known;        /**< nothing has happened since that would change where it ends */
    double end;        /**< u; where it goes */
    double origin;     /**< u; of the count 0: positions have not got other names since */
} story_t;
static story_t stories[BLOCKS_MOST];
static bool edge_in_cycle; /* who lost the axis by it may have been called before */
enum { STUCK = 3000 };
static int calls_in_turn, at_rest, off_cycles, still_cycles;

static bool is(const instance_t *fb, const char *name) { return strcmp(name_of(fb), name) == 0; }
static bool is_superimposed(const instance_t *fb) { return strstr(name_of(fb), "Superimposed") != NULL; }

/** Any axis that is allowed. */
static void random_axis(cm1e_axis_config_t *axis)
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

static void random_tables(void)
{
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

/** All blocks but MC_Power, which the bench calls; two of those that may follow each other. */
static void begin_program(void)
{
    const cm1e_motion_limits_t *most = &judged.axis->maximum;
    ranges = (ranges_t){150000 / fabs(judged.axis->scale), most->velocity, most->acceleration, most->deceleration,
                        most->jerk};
    count = 0;
    for (size_t i = 0; i < block_count; i++) {
        const block_t *type = &block_table[i];
        if (!member_of(type, "Error") || strcmp(type->name, "MC_Power") == 0)
            continue;
        for (int copies = member_of(type, "BufferMode") ? 2 : 1; copies > 0; copies--) {
            make(&instances[count], type->name);
            point_at(&instances[count], "TimePosition", &positions);
            point_at(&instances[count], "TimeVelocity", &velocities);
            point_at(&instances[count++], "TimeAcceleration", &accelerations);
        }
    }
    memset(stories, 0, sizeof stories);
    calls_in_turn = 0;
    at_rest = off_cycles = still_cycles = 0;
}

/* ---- one block --------------------------------------------------------------------------------------------------- */

static void forget_stories(void)
{
    for (int i = 0; i < count; i++)
        stories[i].known = false;
}

static double origin(void) { return cm1e_axis_units(judged.axis, (position_t){0, 0.0}); }

/** A move that is Done stands where it was to go, if nothing else has touched it. */
static void judge_arrival(int n)
{
    const instance_t *fb = &instances[n];
    done_total++;
    const bool rests = judged.axis->state == CM1E_AXIS_STANDSTILL && !judged.axis->active;
    if (!stories[n].known || stories[n].origin != origin() || !rests)
        return;
    const double end = stories[n].end;
    const double scale = fabs(judged.axis->scale), off = (cm1e_axis_units(judged.axis, judged.axis->set) - end) * scale;
    /* Three roundings to a double in u: of where it began, of where that is to end, and of where it is. */
    MUST(fabs(off) < 0.01 + fabs(end) * scale * 4e-16, "%s is Done, but stands %.6g counts beside %.9g",
         name_of(fb), off, end);
}

/** What the program knows of the move that has just been started. */
static story_t story_of(const instance_t *fb, double set)
{
    const bool absolute = is(fb, "MC_MoveAbsolute"), relative = is(fb, "MC_MoveRelative");
    if (!(absolute || relative) || !fb->now.busy || judged.axis->modulo_range != 0)
        return (story_t){0};
    const bool updates = fb->memory[place_of(fb->view->type, "ContinuousUpdate")];
    const bool aborting = *(const int *)(const void *)(fb->memory + fb->view->buffer_mode) == mcAborting;
    return (story_t){.known = aborting && !updates, .origin = origin(),
                     .end = absolute ? real_of(fb, "Position") : set + real_of(fb, "Distance")};
}

/** CM1E_TEST_TELL=<cycle>: from there on every edge is told, for who repeats a seed. */
static void tell(const instance_t *fb, const from_t *from)
{
    static long long first = -1;
    if (first < 0)
        first = getenv("CM1E_TEST_TELL") ? atoll(getenv("CM1E_TEST_TELL")) : LLONG_MAX;
    if (judged.number < first)
        return;
    fprintf(stderr, "%lld: %s from %.17g, %.17g u/s, %.17g u/s2: ErrorID 0x%04X, %s;", judged.number, name_of(fb),
            cm1e_axis_units(judged.axis, from->position), from->velocity, from->acceleration, fb->now.error_id,
            cm1e_axis_state_name(judged.axis->state));
    for (size_t i = 0; i < fb->view->type->member_count; i++) {
        const block_member_t *m = &fb->view->type->members[i];
        if (m->type == BLOCK_LREAL && m->section == BLOCK_INPUT)
            fprintf(stderr, " %s %.17g", m->name, real_of(fb, m->name));
        else if (m->type == BLOCK_ENUM && m->section == BLOCK_INPUT)
            fprintf(stderr, " %s %d", m->name, *(const int *)(const void *)(fb->memory + m->offset));
        else if (m->type == BLOCK_INT && m->section == BLOCK_INPUT)
            fprintf(stderr, " %s %d", m->name, *(const INT *)(const void *)(fb->memory + m->offset));
    }
    fputc('\n', stderr);
}

static void play(int n)
{
    instance_t *fb = &instances[n];
    const bool edge_to_come = !fb->now.trigger && flag(fb, fb->view->execute);
    const cm1e_command_id_t active = judged.axis->active;
    const bool busy = fb->now.busy;
    const from_t from = from_set(judged.axis);
    const double set = cm1e_axis_units(judged.axis, judged.axis->set);
    call(fb);
    if (edge_to_come) {
        tell(fb, &from);
        edges_total++;
        edge_in_cycle = true;
        stories[n] = story_of(fb, set);
        if (!fb->now.error && !fb->view->type->rules)
            forget_stories();
        if (fb->now.error && fb->view->buffer_mode != NOWHERE)
            MUST(judged.axis->active == active, "%s is refused with 0x%04X, but the active command changed",
                 name_of(fb), fb->now.error_id);
        if (!fb->now.error && (is_superimposed(fb) || is(fb, "MC_SetPosition")))
            forget_stories();
    }
    if (fb->now.done && busy)
        judge_arrival(n);
}

/** An idle block needs no call; now and then it gets one. */
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

static void act_on(instance_t *fb)
{
    const uint16_t place = fb->view->execute != NOWHERE ? fb->view->execute : fb->view->enable;
    if (is(fb, "MC_Stop") && !fb->now.trigger && !one_in(8))
        return;
    if (is(fb, "MC_SetOverride") && !one_in(4))
        return;
    if (place == NOWHERE || one_in(12)) { /* inputs at any time, also without an edge */
        random_inputs(fb, &ranges, place == NOWHERE);
        return;
    }
    if (!fb->memory[place]) {
        random_tables();
        random_inputs(fb, &ranges, true);
        put(fb, "ContinuousUpdate", one_in(4));
    }
    fb->memory[place] = !fb->memory[place];
}

static void act(void)
{
    if (one_in(20))
        for (int burst = one_in(4) ? 1 + pick(6) : 1; burst > 0; burst--)
            act_on(&instances[pick(count)]);
    for (int i = 0; i < count && one_in(6); i++) { /* a command that goes on and on teaches nothing new */
        instance_t *fb = &instances[pick(count)];
        if (flag(fb, fb->view->execute) && (fb->now.done || fb->now.error || fb->now.aborted))
            trigger(fb, false);
        if (is(fb, "MC_Stop") && one_in(50))
            trigger(fb, false);
    }
    for (int i = 0; i < count && judged.axis->state == CM1E_AXIS_ERROR_STOP && one_in(50); i++)
        if (is(&instances[i], "MC_Reset"))
            trigger(&instances[i], !instances[i].now.trigger);
}

static void act_on_power(void)
{
    MC_Power_t *power = &bench.power;
    if (power->Enable ? one_in(6000) : one_in(100))
        power->Enable = !power->Enable;
    if (power->EnablePositive ? one_in(8000) : one_in(300))
        power->EnablePositive = !power->EnablePositive;
    if (power->EnableNegative ? one_in(8000) : one_in(300))
        power->EnableNegative = !power->EnableNegative;
}

/* ---- what must hold after every cycle ---------------------------------------------------------------------------- */

static void judge_active(void)
{
    int active = 0;
    for (int i = 0; i < count; i++)
        active += instances[i].now.active && !is_superimposed(&instances[i]) &&
                  instances[i].view->type->rules != NULL && !instances[i].view->type->rules->unchanged;
    MUST(edge_in_cycle || active <= 1, "%d blocks are Active", active);
}

static void judge_rest(void)
{
    const cm1e_axis_t *axis = judged.axis;
    const cm1e_axis_state_t state = axis->state;
    if (state == CM1E_AXIS_STANDSTILL) {
        MUST(axis->set_velocity == 0.0 && axis->set_acceleration == 0.0, "Standstill with the velocity %g",
             axis->set_velocity);
        MUST(!axis->active, "Standstill with an active command");
    }
    at_rest = state == CM1E_AXIS_STANDSTILL ? at_rest + 1 : 0;
    const bool off = state == CM1E_AXIS_ERROR_STOP || !bench.power.Enable;
    const cm1e_motion_limits_t *most = &axis->maximum;
    const double longest_s = most->velocity / most->deceleration + 2 * most->deceleration / most->jerk +
                             2 * sqrt(most->velocity / most->jerk) + 0.2 + 10.5 * (axis->activity == ACTIVITY_HOMING);
    off_cycles = off ? off_cycles + 1 : 0;
    MUST(off_cycles * (double)judged.cycle_ns * 1e-9 < longest_s || !has_torque() || is_deaf(),
         "%s: torque is on for %d cycles", cm1e_axis_state_name(state), off_cycles);
}

/** Whatever is to move does: nothing hangs. */
static void judge_progress(void)
{
    const cm1e_axis_t *axis = judged.axis;
    const bool to_move = axis->state == CM1E_AXIS_DISCRETE_MOTION ||
                         (axis->state == CM1E_AXIS_STOPPING && !axis->stop_held);
    still_cycles = to_move && axis->set_velocity == 0.0 && !axis->paused ? still_cycles + 1 : 0;
    MUST(still_cycles < STUCK, "%s, and nothing has moved for %d cycles", cm1e_axis_state_name(axis->state),
         still_cycles);
}

static void pause_for(int64_t time_ns)
{
    time_passes(time_ns);
    pause_of_master(time_ns);
}

static void one_cycle(void)
{
    edge_in_cycle = false;
    const cm1e_axis_state_t before = judged.axis->state;
    act_on_device();
    act_on_power();
    cycle_begin();
    const cm1e_axis_state_t powered = judged.axis->state;
    MUST(powered == before || bench.power.Enable || powered == CM1E_AXIS_DISABLED ||
             powered == CM1E_AXIS_ERROR_STOP, "MC_Power: to %s", cm1e_axis_state_name(powered));
    act();
    play_all();
    if (one_in(2000))
        pause_for(pick(95) * 1000000);
    cycle_end();
    judge_active();
    judge_rest();
    judge_motor();
    judge_progress();
    seen[judged.axis->state]++;
}

#endif
