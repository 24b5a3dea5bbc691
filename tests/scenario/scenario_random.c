/* A machine, a program and faults from a seed. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "chance.h"
#include "scenario.h"

#define PI 3.14159265358979323846

enum { FIRST_STEP = 260, CYCLES_LEAST = 900, CYCLES_MOST = 2600, ALLOCATIONS = 600 };

/** Seeds below have none of what make_more() adds, so that they stay as they were. */
static const uint64_t more_from = UINT64_C(1000000000);
static const uint64_t wide_from = UINT64_C(2000000000); /**< below, none of what make_wide() adds */
static const uint64_t swap_from = UINT64_C(3000000000); /**< below, no motors that change places */
static const uint64_t close_from = UINT64_C(4000000000); /**< below, none of what make_close() adds */
static const uint64_t ramp_from = UINT64_C(5000000000); /**< below, none of what make_ramp() adds */
static const uint64_t varied_from = UINT64_C(6000000000); /**< from here on scenario_vary() in its place */
static const uint64_t beside_from = UINT64_C(7000000000); /**< below, none of what scenario_beside() adds */
static const uint64_t shove_from = UINT64_C(9000000000); /**< below, none of what scenario_shove() adds */
static const uint64_t plant_from = UINT64_C(8000000000); /**< below, none of what scenario_plant() adds */

/* ---- the machine ------------------------------------------------------------------------------------------------- */

static void make_limits(axis_spec_t *axis)
{
    if (!one_in(2))
        return;
    axis->limit_negative = -floor(uniform(20000, 150000));
    axis->limit_positive = floor(uniform(20000, 150000));
}

static const int kinds[] = {AXIS_CM1E, AXIS_CIA402, AXIS_VIRTUAL, AXIS_EB01, AXIS_EB02, AXIS_EB12};

enum { CM1_MOST = 400000 };

static bool is_bridged(const axis_spec_t *axis) { return axis->kind >= AXIS_EB01 && axis->kind <= AXIS_EB12; }

static void make_axis(axis_spec_t *axis)
{
    *axis = (axis_spec_t){
        .kind = one_in(2) ? AXIS_CM1E : kinds[pick(sizeof kinds / sizeof kinds[0])],
        .firmware = pick(6),
        .mapping = one_in(2) ? 0 : pick(3),
        .counts_per_unit = one_in(3) ? 50000 : one_in(2) ? 1000 : floor(uniform(50, 5000)),
        .invert = one_in(3),
        .velocity = floor(uniform(50000, 1200000)),
        .acceleration = floor(uniform(300000, 6000000)),
        .deceleration = floor(uniform(300000, 6000000)),
        .jerk = floor(uniform(1e7, 3e8)),
        .load_inertia = one_in(3) ? uniform(1e-6, 6e-5) : 0,
        .friction = one_in(3) ? uniform(0.001, 0.02) : 0,
        .coupling_stop = pick(3),
    };
    axis->stops = axis->kind == AXIS_CM1E && one_in(5);
    axis->motion = axis->kind == AXIS_CM1E && axis->mapping == 0 && one_in(8);
    make_limits(axis);
    if (is_bridged(axis))
        axis->velocity = fmin(axis->velocity, CM1_MOST);
    if (axis->kind != AXIS_CM1E)
        axis->firmware = axis->mapping = 0;
}

/** Further motors of a bridge stand behind its first one. */
static int make_bridge(axis_spec_t *axes, int room)
{
    int count = 1;
    axes[0].channel = 1;
    while (count < room && count < 4 && !one_in(3)) {
        make_axis(&axes[count]);
        axes[count].kind = axes[0].kind;
        axes[count].firmware = axes[count].mapping = 0;
        axes[count].velocity = fmin(axes[count].velocity, CM1_MOST);
        axes[count].channel = count + 1;
        axes[count].network = axes[0].network;
        count++;
    }
    return count;
}

static void make_machine(scenario_t *scenario)
{
    const bool two_networks = scenario->axis_count > 1 && one_in(4);
    for (int n = 0; n < scenario->axis_count;) {
        axis_spec_t *axis = &scenario->axes[n];
        make_axis(axis);
        axis->network = two_networks && one_in(2);
        n += is_bridged(axis) ? make_bridge(axis, scenario->axis_count - n) : 1;
    }
    scenario->io = one_in(3) ? 1 + pick(2) : 0;
    scenario->ring = one_in(8);
    scenario->clocks = scenario->ring == 0 && one_in(3);
    for (int n = 0; n < scenario->axis_count; n++)
        if (scenario->axes[n].kind != AXIS_VIRTUAL)
            return;
    scenario->io = 1; /* a network without slaves does not start */
}

/* ---- the program ------------------------------------------------------------------------------------------------- */

typedef struct choice {
    const char *block;
    int weight;
} choice_t;
static const choice_t choices[] = {
    {"MC_MoveAbsolute", 20}, {"MC_MoveRelative", 20}, {"MC_MoveAdditive", 8}, {"MC_MoveVelocity", 14}, {"MC_Halt", 6},
    {"MC_Stop", 6}, {"MC_Power", 3}, {"MC_Reset", 12}, {"MC_MoveSuperimposed", 6}, {"MC_HaltSuperimposed", 1},
    {"MC_MoveContinuousAbsolute", 3}, {"MC_MoveContinuousRelative", 3}, {"MC_SetOverride", 4}, {"MC_Jog", 4},
    {"MC_SetPosition", 1}, {"MC_Home", 2}, {"MC_WriteDigitalOutput", 2}, {"MC_TouchProbe", 2}};
static const choice_t followers[] = {
    {"MC_GearIn", 10}, {"MC_GearOut", 2}, {"MC_CamIn", 6}, {"MC_CamOut", 2}, {"MC_PhasingRelative", 4},
    {"MC_GearInPos", 3}, {"MC_CombineAxes", 3}};
static const choice_t paths[] = {
    {"MC_MoveLinearAbsolute", 8}, {"MC_MoveLinearRelative", 8}, {"MC_MoveCircularRelative", 4}, {"MC_GroupStop", 2},
    {"MC_GroupHalt", 2}, {"MC_GroupReset", 3}};

static double some(double most) { return one_in(2) ? 0 : floor(uniform(most * 0.1, most)); }

static int random_block(const choice_t *list, size_t count)
{
    int total = 0;
    for (size_t i = 0; i < count; i++)
        total += list[i].weight;
    int at = pick(total);
    for (size_t i = 0; i < count; i++)
        if ((at -= list[i].weight) < 0)
            return scenario_block(list[i].block);
    return 0;
}

/** A command of a path of the first two axes; the way of the second one is in its own counts. */
static void make_path(const scenario_t *scenario, step_t *step)
{
    const axis_spec_t *axis = &scenario->axes[0];
    step->axis = 0;
    step->block = random_block(paths, sizeof paths / sizeof paths[0]);
    step->mode = 0; /* a point on the arc */
    step->x = floor(uniform(-15000, 15000));
    step->y = floor(uniform(-15000, 15000));
    step->aux_x = floor(uniform(-15000, 15000));
    step->aux_y = floor(uniform(-15000, 15000));
    step->velocity = one_in(3) ? 0 : floor(uniform(axis->velocity * 0.05, axis->velocity));
    step->acceleration = step->deceleration = step->jerk = 0;
    step->buffer = one_in(2) ? 1 : 0;
}

static void make_step(const scenario_t *scenario, step_t *step, bool grouped)
{
    const int n = pick(scenario->axis_count);
    const axis_spec_t *axis = &scenario->axes[n];
    const double reach = axis->limit_positive != 0 ? fmin(axis->limit_positive, -axis->limit_negative) : 150000;
    *step = (step_t){
        .at = FIRST_STEP + pick((int)scenario->cycles - FIRST_STEP),
        .axis = n,
        .master = pick(scenario->axis_count),
        .block = random_block(choices, sizeof choices / sizeof choices[0]),
        .hold = one_in(3) ? 1 + pick(5) : 20 + pick(600),
        .position = floor(uniform(-reach, reach)),
        .distance = floor(uniform(-reach, reach) * (one_in(3) ? 0.02 : 0.7)),
        .velocity = one_in(3) ? axis->velocity : floor(uniform(axis->velocity * 0.05, axis->velocity)),
        .acceleration = some(axis->acceleration),
        .deceleration = some(axis->deceleration),
        .jerk = some(axis->jerk),
        .buffer = one_in(2) ? 0 : pick(6),
        .direction = 0,
        .end_velocity = floor(uniform(-axis->velocity, axis->velocity) * 0.5),
        .numerator = one_in(2) ? 1 : 1 + pick(3),
        .denominator = 1 + pick(4),
        .factor = one_in(4) ? 0 : uniform(0.1, 1),
        .value = one_in(2),
        .mode = 0,
    };
    if (one_in(3) && step->block == scenario_block("MC_MoveVelocity"))
        step->velocity = -step->velocity;
    if (grouped && one_in(2)) {
        make_path(scenario, step);
    } else if (scenario->axis_count > 1 && one_in(5)) {
        step->block = random_block(followers, sizeof followers / sizeof followers[0]);
        step->master = (n + 1 + pick(scenario->axis_count - 1)) % scenario->axis_count;
        step->x = step->position;
        step->y = floor(uniform(-reach, reach));
        step->hold = 200 + pick(900);
        step->mode = step->block == scenario_block("MC_CamIn") ? 1 + pick(2) : 0;
    } else if (step->block == scenario_block("MC_Jog")) {
        step->mode = pick(4);
        step->direction = one_in(2);
        step->position = 100 + pick(3000);
    } else if (step->block == scenario_block("MC_Home") && axis->stops == 0) {
        step->block = scenario_block("MC_Halt");
    }
}

/* ---- the faults -------------------------------------------------------------------------------------------------- */

static const int all_faults[] = {
    FAULT_LOSE, FAULT_LOSE_OUT, FAULT_LOSE_BACK, FAULT_CORRUPT, FAULT_DELAY, FAULT_COUNTER, FAULT_STALL, FAULT_UNPLUG,
    FAULT_POWER_CYCLE, FAULT_FALL_BACK, FAULT_MOTOR_POWER, FAULT_ERROR, FAULT_OVER_TORQUE, FAULT_TEMPERATURE,
    FAULT_LOAD, FAULT_RING, FAULT_BRIDGE_ERROR, FAULT_BRIDGE_CABLE, FAULT_SWITCH, FAULT_EEPROM, FAULT_JUMP,
    FAULT_FREEZE, FAULT_CLOCK};

/** Whether the console takes it for this axis. */
static bool fits(const scenario_t *scenario, const axis_spec_t *axis, int kind)
{
    switch (kind) {
    case FAULT_ERROR:
    case FAULT_OVER_TORQUE:
    case FAULT_TEMPERATURE: return axis->kind == AXIS_CM1E;
    case FAULT_MOTOR_POWER:
    case FAULT_LOAD:
    case FAULT_SWITCH: return axis->kind == AXIS_CM1E || axis->kind == AXIS_CIA402;
    case FAULT_BRIDGE_ERROR:
    case FAULT_BRIDGE_CABLE: return is_bridged(axis);
    case FAULT_JUMP:
    case FAULT_FREEZE: return axis->kind == AXIS_CM1E && scenario->io == 0;
    case FAULT_CLOCK: return scenario->clocks != 0 && axis->kind != AXIS_VIRTUAL;
    case FAULT_RING: return scenario->ring != 0 && axis->kind != AXIS_VIRTUAL;
    case FAULT_UNPLUG: return scenario->ring == 0 && axis->kind != AXIS_VIRTUAL;
    case FAULT_POWER_CYCLE:
    case FAULT_FALL_BACK:
    case FAULT_EEPROM: return axis->kind != AXIS_VIRTUAL;
    default: return true;
    }
}

static const int codes[] = {0x2310, 0x4310, 0x7310, 0x7320, 0x7500, 0xFF04};

static void make_fault(const scenario_t *scenario, fault_t *fault)
{
    int n = pick(scenario->axis_count);
    int kind = all_faults[pick(sizeof all_faults / sizeof all_faults[0])];
    if (!fits(scenario, &scenario->axes[n], kind))
        kind = one_in(2) ? FAULT_LOSE : FAULT_LOSE_BACK;
    *fault = (fault_t){
        .at = FIRST_STEP + pick((int)scenario->cycles - FIRST_STEP),
        .kind = kind,
        .axis = n,
        .network = scenario->axes[n].network,
        .length = one_in(2) ? 1 + pick((int)scenario->lost_limit) : one_in(2) ? 1 + pick(30) : 1 + pick(300),
    };
    if (kind == FAULT_ERROR)
        fault->value = codes[pick(sizeof codes / sizeof codes[0])];
    if (kind == FAULT_DELAY)
        fault->value = one_in(2) ? 100 + pick(200) : 1000 + pick(4000);
    if (kind == FAULT_JUMP)
        fault->value = one_in(2) ? 1000000 : -100000000;
    if (kind == FAULT_CLOCK)
        fault->value = floor(uniform(-3000, 3000));
    if (kind == FAULT_LOAD)
        fault->value = uniform(-0.03, 0.03);
    if (kind == FAULT_DELAY || kind == FAULT_STALL)
        fault->length = 1 + pick(kind == FAULT_DELAY ? 5 : one_in(4) ? 90 : 8);
}

static int compare_times(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

/** Bridges, and the firmwares 1.2.0 and 1.3.0. */
static bool by_1_ms(const scenario_t *scenario)
{
    bool found = false;
    for (int n = 0; n < scenario->axis_count; n++)
        found = found || is_bridged(&scenario->axes[n]) || scenario->axes[n].firmware == 1 ||
                scenario->axes[n].firmware == 2;
    return found;
}

/** The supply of a motor dips for some cycles. */
static void make_dip(scenario_t *scenario)
{
    const int n = pick(scenario->axis_count);
    if (scenario->fault_count == SCENARIO_FAULTS || !fits(scenario, &scenario->axes[n], FAULT_MOTOR_POWER))
        return;
    scenario->faults[scenario->fault_count++] = (fault_t){
        .at = FIRST_STEP + pick((int)scenario->cycles - FIRST_STEP), .kind = FAULT_MOTOR_POWER, .axis = n,
        .network = scenario->axes[n].network, .length = 1 + pick(20)};
}

/** A clock jumps so far that it is not synchronous any more. */
static void lose_synchronism(scenario_t *scenario)
{
    const int n = pick(scenario->axis_count);
    const double step = floor(uniform(20000, 400000));
    if (scenario->fault_count == SCENARIO_FAULTS || !fits(scenario, &scenario->axes[n], FAULT_CLOCK))
        return;
    scenario->faults[scenario->fault_count++] = (fault_t){
        .at = FIRST_STEP + pick((int)scenario->cycles - FIRST_STEP), .kind = FAULT_CLOCK, .axis = n,
        .network = scenario->axes[n].network, .value = one_in(2) ? step : -step};
}

/** After all other draws, for seeds from `more_from` on. */
static void make_more(scenario_t *scenario)
{
    scenario->memory = 1 + pick(ALLOCATIONS);
    if (!by_1_ms(scenario) && one_in(2))
        scenario->cycle_us = 250;
    while (one_in(2))
        make_dip(scenario);
    if (one_in(2))
        lose_synchronism(scenario);
}

/* ---- seeds from wide_from on ------------------------------------------------------------------------------------- */

static const choice_t wide[] = {
    {"MC_PositionProfile", 4}, {"MC_VelocityProfile", 4}, {"MC_AccelerationProfile", 4}, {"CM_FollowPosition", 6},
    {"MC_PhasingAbsolute", 2}, {"MC_DigitalCamSwitch", 3}, {"MC_TorqueControl", 1}, {"MC_AbortTrigger", 1},
    {"MC_HomeDirect", 2}};
static const choice_t homings[] = {
    {"MC_StepAbsoluteSwitch", 3}, {"MC_StepLimitSwitch", 3}, {"MC_StepBlock", 3}, {"MC_HomeDirect", 1}};

/** Slaves whose inputs take the place of their outputs, or that come and go. */
static void make_wide_machine(scenario_t *scenario)
{
    if (scenario->ring == 0 && one_in(3)) {
        scenario->overlap = 1;
        return;
    }
    for (int n = 0; n < scenario->axis_count && scenario->ring == 0 && scenario->clocks == 0; n++)
        scenario->axes[n].optional = scenario->axes[n].kind == AXIS_CM1E && one_in(2);
}

/** Hard stops and switches, for homings in steps. */
static void make_stops(scenario_t *scenario)
{
    for (int n = 0; n < scenario->axis_count; n++)
        if (scenario->axes[n].kind == AXIS_CM1E && one_in(2))
            scenario->axes[n].stops = 1;
}

/** A swing over `distance` and back, as fast as the axis may be at most, or up to four times slower. */
static void make_wide_step(const scenario_t *scenario, step_t *step)
{
    const axis_spec_t *axis = &scenario->axes[(int)step->axis];
    const double way = fabs(step->distance), acceleration = fmin(axis->acceleration, axis->deceleration);
    const double fastest_s = fmax(PI * way / axis->velocity, fmax(PI * sqrt(2 * way / acceleration),
                                                                  2 * PI * cbrt(way / axis->jerk)));
    step->block = random_block(wide, sizeof wide / sizeof wide[0]);
    step->points = 4 + pick(28);
    step->period = floor(1000 * fastest_s * uniform(0.9, 4)) + 20;
    step->torque = one_in(2) ? 0 : 20 + pick(100);
    step->mode = one_in(2) ? 0 : pick(4);
    step->buffer = one_in(4) ? pick(6) : 0;
    step->hold = 200 + pick(1500);
}

/** A motion that begins at rest only: a halt comes before it. */
static void halt_before(const scenario_t *scenario, step_t *halt, const step_t *step)
{
    const axis_spec_t *axis = &scenario->axes[(int)step->axis];
    *halt = (step_t){.at = fmax(FIRST_STEP, step->at - 100 - pick(300)), .axis = step->axis,
                     .block = scenario_block("MC_Halt"), .hold = 400, .deceleration = axis->deceleration};
}

/** A homing in steps: a halt, a search, the end. */
static void make_homing(const scenario_t *scenario, step_t *steps)
{
    const axis_spec_t *axis = &scenario->axes[(int)steps[1].axis];
    step_t *search = &steps[1];
    search->block = random_block(homings, sizeof homings / sizeof homings[0]);
    search->direction = one_in(10) ? pick(4) : pick(2);
    search->mode = search->block == scenario_block("MC_StepAbsoluteSwitch") ? pick(6) : pick(4);
    search->velocity = floor(axis->velocity * uniform(0.05, one_in(4) ? 1 : 0.5));
    search->torque = one_in(2) ? 0 : 20 + pick(100);
    search->x = one_in(3) ? fabs(search->distance) : 0;
    search->buffer = 0;
    search->hold = 1500;
    halt_before(scenario, &steps[0], search);
    steps[2] = *search;
    steps[2].block = scenario_block("MC_FinishHoming");
    steps[2].at = search->at + 20 + pick(one_in(2) ? 1200 : 400);
    steps[2].distance *= 0.05;
}

static void make_absence(scenario_t *scenario)
{
    const int n = pick(scenario->axis_count);
    for (int i = 0; i < scenario->fault_count; i++) /* one of these for each axis */
        if (scenario->faults[i].kind >= FAULT_DETACH && (int)scenario->faults[i].axis == n)
            return;
    if (scenario->fault_count == SCENARIO_FAULTS || scenario->axes[n].optional == 0)
        return;
    scenario->faults[scenario->fault_count++] = (fault_t){
        .at = FIRST_STEP + pick((int)scenario->cycles - FIRST_STEP), .kind = one_in(2) ? FAULT_DETACH : FAULT_STRANGER,
        .axis = n, .network = scenario->axes[n].network, .length = 1 + pick(one_in(2) ? 100 : 1200)};
}

static bool may_swap(const scenario_t *scenario, int a, int b)
{
    const axis_spec_t *one = &scenario->axes[a], *other = &scenario->axes[b];
    return a != b && one->kind == AXIS_CM1E && other->kind == AXIS_CM1E && one->network == other->network &&
           scenario->ring == 0;
}

/** No slave comes and goes. */
static void make_all_stay(scenario_t *scenario)
{
    int kept = 0;
    for (int i = 0; i < scenario->fault_count; i++)
        if (scenario->faults[i].kind != FAULT_DETACH && scenario->faults[i].kind != FAULT_STRANGER)
            scenario->faults[kept++] = scenario->faults[i];
    scenario->fault_count = kept;
    for (int n = 0; n < scenario->axis_count; n++)
        scenario->axes[n].optional = 0;
}

/** Two motors with an ID change places for a while: they are without power, and then the one has the ID of the other. */
static void make_swap(scenario_t *scenario)
{
    for (int tries = 0; tries < 8; tries++) {
        const int a = pick(scenario->axis_count), b = pick(scenario->axis_count);
        if (!may_swap(scenario, a, b))
            continue;
        make_all_stay(scenario);
        if (scenario->fault_count == SCENARIO_FAULTS)
            return;
        scenario->axes[a].identified = scenario->axes[b].identified = 1;
        scenario->faults[scenario->fault_count++] = (fault_t){
            .at = FIRST_STEP + pick((int)scenario->cycles - FIRST_STEP), .kind = FAULT_SWAP, .axis = a,
            .network = scenario->axes[a].network, .length = 100 + pick(2000), .value = b};
        return;
    }
}

/** After the draws of make_more(). */
static void make_wide(scenario_t *scenario)
{
    make_wide_machine(scenario);
    make_stops(scenario);
    for (int i = 0; i < scenario->step_count; i++) {
        step_t *steps = &scenario->steps[i];
        const int left = scenario->step_count - i;
        if (left > 2 && scenario->axes[(int)steps[1].axis].stops != 0 && one_in(3)) {
            make_homing(scenario, steps);
            i += 2;
        } else if (left > 1 && one_in(3)) {
            make_wide_step(scenario, &steps[1]);
            halt_before(scenario, steps, &steps[1]);
            i++;
        }
    }
    if (one_in(3)) /* the others must go on */
        scenario->fault_count = 0;
    for (int i = 0; i < scenario->axis_count; i++)
        make_absence(scenario);
}

/** Frames are lost, or the host stands still, for some cycles. */
static void make_brief(fault_t *fault, const fault_t *first)
{
    static const uint8_t kinds_of[] = {FAULT_STALL, FAULT_LOSE, FAULT_LOSE_OUT, FAULT_LOSE_BACK};
    *fault = (fault_t){.kind = kinds_of[pick(4)], .axis = first->axis, .network = first->network, .length = 1 + pick(9)};
}

/** A fault that follows another one within some cycles: what was begun because of the first one is not over yet. */
static void make_next(scenario_t *scenario, const fault_t *first)
{
    enum { CLOSE = 12 };
    fault_t *next = &scenario->faults[scenario->fault_count];
    if (scenario->fault_count == SCENARIO_FAULTS)
        return;
    if (one_in(3))
        make_fault(scenario, next);
    else
        make_brief(next, first);
    next->at = first->at + (one_in(2) ? 0 : first->length) + 1 + pick(CLOSE);
    scenario->fault_count++;
}

/** Faults and commands just after faults, and heavy loads. */
static void make_close(scenario_t *scenario)
{
    enum { AFTER = 40 };
    const int count = scenario->fault_count;
    for (int n = 0; n < scenario->axis_count; n++)
        if (scenario->axes[n].kind != AXIS_VIRTUAL && one_in(2))
            scenario->axes[n].load_inertia = uniform(2e-5, 6e-5);
    for (int i = 0; i < count; i++) {
        fault_t *first = &scenario->faults[i];
        if (first->kind == FAULT_SWAP || one_in(3))
            continue;
        if (one_in(2)) {
            const double at = first->at;
            make_brief(first, first);
            first->at = at;
        }
        make_next(scenario, first);
        if (scenario->step_count > 0 && one_in(2))
            scenario->steps[pick(scenario->step_count)].at = first->at + 1 + pick(AFTER);
    }
}

static void add_step(scenario_t *scenario, step_t step)
{
    if (scenario->step_count < SCENARIO_STEPS && step.at >= FIRST_STEP)
        scenario->steps[scenario->step_count++] = step;
}

/** Before all that, a fast motion of a heavy load, its stop, and a pause or lost frames in the ramp of that stop. */
static void make_ramp(scenario_t *scenario)
{
    static const char *const stops[] = {"MC_Stop", "MC_Halt", "MC_Power"};
    enum { LATER = 900, SHORTEST = 200, MOTION = 200, RAMP = 100, LONGEST = 30, STOPS = sizeof stops / sizeof stops[0] };
    const int n = pick(scenario->axis_count);
    axis_spec_t *axis = &scenario->axes[n];
    if (scenario->fault_count == SCENARIO_FAULTS || axis->kind == AXIS_VIRTUAL || axis->stops != 0)
        return;
    for (int i = 0; i < scenario->step_count; i++)
        scenario->steps[i].at += LATER;
    for (int i = 0; i < scenario->fault_count; i++)
        scenario->faults[i].at += LATER;
    scenario->cycles += LATER;
    axis->velocity = is_bridged(axis) ? CM1_MOST : uniform(400000, 1200000);
    axis->acceleration = axis->deceleration = uniform(2000000, 6000000);
    axis->jerk = fmax(axis->jerk, 1e8);
    axis->load_inertia = uniform(2e-5, 6e-5);
    axis->limit_negative = axis->limit_positive = 0;
    const double stops_at = FIRST_STEP + SHORTEST + pick(MOTION);
    fault_t *fault = &scenario->faults[scenario->fault_count++];
    *fault = (fault_t){.kind = one_in(2) ? FAULT_STALL : FAULT_LOSE, .axis = n, .network = axis->network,
                       .length = 1 + pick(9), .at = stops_at + pick(RAMP)};
    if (fault->kind == FAULT_STALL && one_in(2))
        fault->length = 1 + pick(LONGEST);
    add_step(scenario, (step_t){.at = FIRST_STEP, .axis = n, .hold = LATER, .block = scenario_block("MC_MoveVelocity"),
                                .velocity = axis->velocity});
    add_step(scenario, (step_t){.at = stops_at, .axis = n, .hold = 20 + pick(400),
                                .block = scenario_block(stops[pick(STOPS)])});
}

void scenario_make(scenario_t *scenario, uint64_t seed)
{
    static const double limits[] = {3, 3, 3, 2, 5, 10};
    chance_seed(seed);
    for (int i = 0; i < 16; i++)
        chance();
    *scenario = (scenario_t){.seed = seed, .cycle_us = 1000, .lost_limit = limits[pick(6)],
                             .axis_count = 1 + pick(one_in(3) ? SCENARIO_AXES : 3)};
    scenario->cycles = CYCLES_LEAST + pick(CYCLES_MOST - CYCLES_LEAST);
    make_machine(scenario);
    if (!by_1_ms(scenario) && one_in(2))
        scenario->cycle_us = 500;
    const bool grouped = scenario->axis_count > 1 && one_in(6);
    scenario->step_count = 3 + pick(SCENARIO_STEPS - 20) / 2 + scenario->axis_count;
    for (int i = 0; i < scenario->step_count; i++)
        make_step(scenario, &scenario->steps[i], grouped);
    scenario->fault_count = one_in(8) ? 0 : 1 + pick(one_in(2) ? 2 : 6);
    for (int i = 0; i < scenario->fault_count; i++)
        make_fault(scenario, &scenario->faults[i]);
    if (seed >= more_from)
        make_more(scenario);
    if (seed >= wide_from)
        make_wide(scenario);
    if (seed >= swap_from)
        make_swap(scenario);
    if (seed >= close_from)
        make_close(scenario);
    if (seed >= varied_from)
        scenario_vary(scenario);
    else if (seed >= ramp_from)
        make_ramp(scenario);
    if (seed >= beside_from)
        scenario_beside(scenario);
    if (seed >= plant_from)
        scenario_plant(scenario);
    if (seed >= shove_from)
        scenario_shove(scenario);
    qsort(scenario->steps, (size_t)scenario->step_count, sizeof(step_t), compare_times);
    qsort(scenario->faults, (size_t)scenario->fault_count, sizeof(fault_t), compare_times);
}
