/*
 * What seeds from 6,000,000,000 on add: modulo axes, blocks that are triggered again or change their inputs on the way,
 * bursts of buffered motions, limits that change, cams that are selected anew, paths with blending and override,
 * directions that are taken away, floods of emergencies, long pauses, faults of two slaves at once, and resets soon after
 * faults, so that an axis is in ErrorStop for a smaller part of the time.
 */
#include <math.h>
#include <string.h>

#include "chance.h"
#include "scenario.h"

enum { FIRST_STEP = 260, DIRECTIONS = 5, BUFFER_MODES = 6 };

typedef struct choice {
    const char *block;
    int weight;
} choice_t;

static const choice_t singles[] = {
    {"MC_MoveAbsolute", 12}, {"MC_MoveRelative", 8}, {"MC_MoveAdditive", 4}, {"MC_MoveVelocity", 10},
    {"MC_MoveContinuousAbsolute", 4}, {"MC_MoveContinuousRelative", 4}, {"MC_MoveSuperimposed", 5},
    {"MC_HaltSuperimposed", 2}, {"MC_SetOverride", 5}, {"MC_SetPosition", 4}, {"MC_WriteParameter", 6},
    {"MC_WriteBoolParameter", 2}, {"MC_TouchProbe", 2}, {"MC_Halt", 3}, {"MC_Stop", 2}, {"MC_Power", 3},
    {"MC_CamTableSelect", 2}, {"MC_TorqueControl", 1}, {"MC_DigitalCamSwitch", 2}};
static const choice_t coupled[] = {
    {"MC_GearIn", 8}, {"MC_CamIn", 6}, {"MC_GearInPos", 5}, {"MC_CombineAxes", 4}, {"MC_PhasingRelative", 4},
    {"MC_PhasingAbsolute", 3}, {"MC_GearOut", 2}, {"MC_CamOut", 2}, {"MC_CamTableSelect", 3}};
static const choice_t paths[] = {
    {"MC_MoveLinearAbsolute", 8}, {"MC_MoveLinearRelative", 10}, {"MC_MoveCircularRelative", 6},
    {"MC_MoveCircularAbsolute", 3}, {"MC_GroupSetOverride", 4}, {"MC_GroupHalt", 3}, {"MC_GroupStop", 2},
    {"MC_GroupReset", 2}, {"MC_GroupDisable", 1}, {"MC_GroupEnable", 1}};
static const choice_t homings[] = {{"MC_HomeAbsolute", 1}, {"MC_StepReferencePulse", 3},
                                   {"MC_StepReferenceFlyingSwitch", 2}, {"MC_AbortPassiveHoming", 1}};

static int random_block(const choice_t *list, size_t count)
{
    int total = 0, n = 0;
    for (size_t i = 0; i < count; i++)
        total += list[i].weight;
    for (int at = pick(total); (at -= list[n].weight) >= 0;)
        n++;
    return scenario_block(list[n].block);
}
#define BLOCK_OF(list) random_block(list, sizeof(list) / sizeof(list)[0])

static void add_step(scenario_t *scenario, step_t step)
{
    if (scenario->step_count < SCENARIO_STEPS && step.at >= FIRST_STEP && step.at < scenario->cycles)
        scenario->steps[scenario->step_count++] = step;
}

/* ---- the machine ------------------------------------------------------------------------------------------------- */

/** The range is a whole number of units, as a table of 360 degrees has it. */
static void vary_axis(axis_spec_t *axis)
{
    const bool limited = axis->limit_negative != 0 || axis->limit_positive != 0;
    if (!limited && axis->stops == 0 && one_in(2))
        axis->modulo = axis->counts_per_unit * ceil(uniform(3000, one_in(2) ? 20000 : 200000) / axis->counts_per_unit);
    /* In CSV, and with much friction, a motor does not get into the window of the default. */
    axis->done_waits = one_in(3) && axis->mapping != MAPPING_CSV && axis->friction == 0 && axis->stops == 0;
}

/* ---- the program ------------------------------------------------------------------------------------------------- */

/** Parameters of table 5 that may be written in motion: only to what the machine was not made for less. */
static void make_limit(const axis_spec_t *axis, step_t *step)
{
    static const int numbers[] = {2, 3, 9, 13, 15, 17};
    const int number = numbers[pick(sizeof numbers / sizeof numbers[0])];
    const double part = uniform(0.3, 1);
    step->parameter = number;
    step->position = number == 2   ? (axis->limit_positive != 0 ? axis->limit_positive : 200000) * part
                     : number == 3 ? (axis->limit_negative != 0 ? axis->limit_negative : -200000) * part
                     : number == 9 ? axis->velocity * part
                     : number == 13 ? axis->acceleration * part
                     : number == 15 ? axis->deceleration * part
                                    : axis->jerk * part;
}

static void make_single(const axis_spec_t *axis, step_t *step)
{
    step->block = BLOCK_OF(singles);
    step->direction = pick(DIRECTIONS);
    step->buffer = one_in(3) ? 0 : pick(BUFFER_MODES);
    if (axis->modulo > 0)
        step->position = floor(uniform(0, axis->modulo));
    step->relative = one_in(2);
    if (one_in(3))
        step->again = 2 + pick(one_in(2) ? 20 : 300);
    if (one_in(2)) {
        step->update = one_in(2);
        step->change = one_in(4) ? uniform(-1, 1) : uniform(0.2, 1);
        step->change_after = 1 + pick(200);
    }
    if (step->block == scenario_block("MC_WriteParameter"))
        make_limit(axis, step);
    else if (step->block == scenario_block("MC_WriteBoolParameter"))
        step->parameter = 4 + pick(2);
    else if (step->block == scenario_block("MC_Power"))
        step->mode = pick(3);
    else if (step->block == scenario_block("MC_CamTableSelect"))
        step->mode = pick(2);
    else
        step->mode = 0;
    if (step->block == scenario_block("MC_DigitalCamSwitch"))
        step->period = pick(100);
}

static void make_coupled(const scenario_t *scenario, step_t *step)
{
    const int n = (int)step->axis;
    step->block = BLOCK_OF(coupled);
    step->master = (n + 1 + pick(scenario->axis_count - 1)) % scenario->axis_count;
    step->numerator = (1 + pick(3)) * (one_in(3) ? -1 : 1);
    step->denominator = 1 + pick(5);
    step->source = one_in(4);
    step->x = floor(uniform(-50000, 50000));
    step->y = floor(uniform(-50000, 50000));
    step->hold = one_in(4) ? 2 + pick(50) : 200 + pick(900);
    step->mode = step->block == scenario_block("MC_CamIn")            ? pick(3)
                 : step->block == scenario_block("MC_CamTableSelect") ? pick(2)
                 : step->block == scenario_block("MC_CombineAxes")    ? pick(2)
                                                                      : 0;
    step->scaling = one_in(3) ? uniform(-1, 1) : 0;
    step->start_distance = one_in(3) ? floor(uniform(0, 30000)) : 0;
    step->buffer = one_in(3) ? pick(BUFFER_MODES) : 0;
    step->again = one_in(5) ? 50 + pick(300) : 0;
    step->update = one_in(4);
}

static void make_part(step_t *step)
{
    step->axis = 0;
    step->block = BLOCK_OF(paths);
    step->x = floor(uniform(-12000, 12000));
    step->y = floor(uniform(-12000, 12000));
    step->aux_x = floor(uniform(-12000, 12000));
    step->aux_y = floor(uniform(-12000, 12000));
    step->velocity = one_in(3) ? 0 : step->velocity;
    step->acceleration = step->deceleration = step->jerk = 0;
    step->mode = pick(3); /* centre, border, radius: some are refused */
    step->buffer = one_in(4) ? pick(2) : 2 + pick(4);
    step->transition = one_in(3) ? 0 : 3 + pick(2);
    step->corner = floor(uniform(10, 4000));
    step->factor = one_in(4) ? 0 : uniform(0.05, 1);
    step->hold = 20 + pick(600);
}

/** Motions shortly one after the other: the next one waits, blends, or takes over at any moment. */
static void make_burst(scenario_t *scenario, bool grouped)
{
    enum { LONGEST = 7, APART = 120 };
    if (scenario->step_count == 0)
        return;
    const step_t like = scenario->steps[pick(scenario->step_count)];
    const axis_spec_t *axis = &scenario->axes[grouped ? 0 : (int)like.axis];
    double at = FIRST_STEP + pick((int)scenario->cycles - FIRST_STEP);
    for (int count = 2 + pick(LONGEST - 1); count > 0; count--) {
        step_t step = like;
        step.at = at;
        if (grouped)
            make_part(&step);
        else
            make_single(axis, &step);
        step.distance = floor(like.distance * uniform(-1, 1));
        if (axis->modulo == 0)
            step.position = step.block == scenario_block("MC_WriteParameter") ? step.position
                                                                              : floor(like.position * uniform(-1, 1));
        at += 1 + pick(APART);
        add_step(scenario, step);
    }
}

static void vary_steps(scenario_t *scenario, bool grouped)
{
    for (int i = 0; i < scenario->step_count; i++) {
        step_t *step = &scenario->steps[i];
        const axis_spec_t *axis = &scenario->axes[(int)step->axis];
        if (grouped && one_in(3))
            make_part(step);
        else if (scenario->axis_count > 1 && one_in(4))
            make_coupled(scenario, step);
        else if (one_in(20) && axis->kind != AXIS_VIRTUAL)
            step->block = BLOCK_OF(homings);
        else if (one_in(2))
            make_single(axis, step);
    }
}

/* ---- the faults -------------------------------------------------------------------------------------------------- */

static void add_fault(scenario_t *scenario, fault_t fault)
{
    if (scenario->fault_count < SCENARIO_FAULTS)
        scenario->faults[scenario->fault_count++] = fault;
}

static void make_flood(scenario_t *scenario)
{
    const int n = pick(scenario->axis_count);
    const axis_spec_t *axis = &scenario->axes[n];
    if (axis->kind != AXIS_VIRTUAL)
        add_fault(scenario, (fault_t){.at = FIRST_STEP + pick((int)scenario->cycles - FIRST_STEP), .axis = n,
                                      .network = axis->network, .kind = FAULT_EMERGENCY, .length = 1 + pick(200),
                                      .value = 0xFF00 + pick(16)});
}

/** It may happen twice: nothing that the machine is made of comes, goes or lies. */
static bool may_repeat(const fault_t *fault)
{
    return fault->kind < FAULT_DETACH && fault->kind != FAULT_JUMP && fault->kind != FAULT_FREEZE;
}

/** The same fault hits another axis in the same cycle, or in the next ones. */
static void make_twin(scenario_t *scenario)
{
    const fault_t first = scenario->faults[pick(scenario->fault_count)];
    fault_t twin = first;
    const int n = pick(scenario->axis_count);
    const axis_spec_t *one = &scenario->axes[(int)first.axis], *other = &scenario->axes[n];
    if (n == (int)first.axis || one->kind != other->kind || one->network != other->network ||
        !may_repeat(&first))
        return;
    twin.axis = n;
    twin.at += pick(3);
    add_fault(scenario, twin);
}

/** Everything is brought back some time after a fault, and moves on; the fault may come again meanwhile. */
static void make_return(scenario_t *scenario, fault_t fault)
{
    const double at = fault.at + fault.length + 20 + pick(one_in(2) ? 60 : 300);
    fault.at = at + pick(one_in(2) ? 20 : 150);
    if (may_repeat(&fault) && fault.at < scenario->cycles && one_in(3))
        add_fault(scenario, fault);
    for (int n = 0; n < scenario->axis_count; n++) {
        step_t step = {.at = at + pick(10), .axis = n, .block = scenario_block("MC_Reset"), .hold = 100 + pick(300)};
        if (one_in(5))
            continue;
        add_step(scenario, step);
        step.hold = 200 + pick(600);
        step.at += 40 + pick(200);
        step.velocity = scenario->axes[n].velocity * uniform(0.2, 1) * (one_in(2) ? -1 : 1);
        step.block = scenario_block("MC_MoveVelocity");
        add_step(scenario, step);
    }
}

static void vary_faults(scenario_t *scenario)
{
    const int count = scenario->fault_count;
    for (int i = 0; i < count; i++)
        if (scenario->faults[i].kind == FAULT_STALL && one_in(3))
            scenario->faults[i].length = 3 + pick(300);
    if (count > 0 && one_in(2))
        make_twin(scenario);
    if (one_in(4))
        make_flood(scenario);
    for (int i = 0; i < count; i++)
        if (one_in(2))
            make_return(scenario, scenario->faults[i]);
}

void scenario_vary(scenario_t *scenario)
{
    bool grouped = scenario->axis_count > 1 && one_in(5);
    for (int n = 0; n < scenario->axis_count; n++)
        vary_axis(&scenario->axes[n]);
    vary_steps(scenario, grouped);
    while (one_in(2))
        make_burst(scenario, grouped);
    vary_faults(scenario);
}
