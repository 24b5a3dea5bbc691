/*
 * What seeds from 7,000,000,000 on add beside the motions: blocks that only read, strings, commands and modes of a bridge,
 * inputs and outputs of a terminal, touch probes that wait for one of them, and motors whose position is near the end of its
 * 32 bits when the run begins.
 */
#include <math.h>
#include <string.h>

#include "chance.h"
#include "scenario.h"

enum { FIRST_STEP = 260, WIRED_FIRST = 11 };

static const char *const readers[] = {"MC_ReadActualPosition", "MC_ReadActualVelocity", "MC_ReadActualTorque",
                                      "MC_ReadParameter", "MC_ReadBoolParameter", "MC_ReadAxisInfo"};
static const char *const signals[] = {"MC_ReadDigitalInput", "MC_ReadDigitalOutput", "MC_WriteDigitalOutput",
                                      "MC_TouchProbe"};
static const char *const of_bridges[] = {"CM_SendCML", "CM_SendCML", "CM_SetMode", "CM_Command"};
#define ONE_OF(list) scenario_block((list)[pick(sizeof(list) / sizeof(list)[0])])

static bool is_bridged(const axis_spec_t *axis) { return axis->kind >= AXIS_EB01 && axis->kind <= AXIS_EB12; }

/** The master reaches it by its targets only, and nothing gives it another origin. */
static bool may_start_far(const scenario_t *scenario, int n)
{
    const axis_spec_t *axis = &scenario->axes[n];
    for (int i = 0; i < scenario->step_count; i++) {
        const step_t *step = &scenario->steps[i];
        if ((int)step->axis == n && (step->block == scenario_block("MC_Home") || axis->stops != 0))
            return false;
    }
    return axis->kind == AXIS_CM1E && axis->motion == 0 && axis->mapping <= 1 && axis->modulo == 0 &&
           axis->optional == 0 && scenario->overlap == 0 && scenario->io == 0;
}

/** It begins less than a program's way from where its 32 bits end. */
static void start_far(scenario_t *scenario, int n)
{
    axis_spec_t *axis = &scenario->axes[n];
    axis->start = (one_in(2) ? 1 : -1) * (2147483648.0 - 1 - pick(one_in(2) ? 20000 : 400000));
    axis->limit_negative = axis->limit_positive = 0;
    for (int i = 0; i < scenario->step_count; i++) {
        step_t *step = &scenario->steps[i];
        if ((int)step->axis == n && (step->block == scenario_block("MC_MoveAbsolute") ||
                                     step->block == scenario_block("MC_MoveContinuousAbsolute")))
            step->position += axis->start;
    }
}

static step_t step_of(const scenario_t *scenario, int axis, int block)
{
    static const int parameters[] = {1, 2, 3, 7, 9, 10, 11, 12, 13, 14, 15, 16, 17, 999};
    return (step_t){.at = FIRST_STEP + pick((int)scenario->cycles - FIRST_STEP), .axis = axis, .block = block,
                    .hold = one_in(3) ? 1 + pick(30) : 100 + pick(2000), .value = pick(2), .mode = pick(4),
                    .parameter = parameters[pick(sizeof parameters / sizeof parameters[0])],
                    .again = one_in(3) ? 2 + pick(300) : 0};
}

static void add(scenario_t *scenario, step_t step)
{
    if (scenario->step_count < SCENARIO_STEPS)
        scenario->steps[scenario->step_count++] = step;
}

/** A terminal of its network, whose inputs change. Its outputs belong to one axis. */
static void wire(scenario_t *scenario, int n)
{
    if (scenario->io == 0 || scenario->axes[n].network != 0 || !one_in(2))
        return;
    for (int i = 0; i < n; i++)
        if (scenario->axes[i].wired != 0)
            return;
    scenario->axes[n].wired = 1;
    for (int count = 1 + pick(3); count > 0; count--) {
        step_t step = step_of(scenario, n, ONE_OF(signals));
        step.mode = one_in(4) ? pick(3) : WIRED_FIRST + pick(2);
        add(scenario, step);
        if (scenario->fault_count < SCENARIO_FAULTS)
            scenario->faults[scenario->fault_count++] = (fault_t){
                .at = FIRST_STEP + pick((int)scenario->cycles - FIRST_STEP), .kind = FAULT_INPUT, .axis = n,
                .length = 1 + pick(one_in(2) ? 20 : 500), .value = 1 + pick(2)};
    }
}

void scenario_beside(scenario_t *scenario)
{
    for (int n = 0; n < scenario->axis_count; n++) {
        if (may_start_far(scenario, n) && one_in(2))
            start_far(scenario, n);
        wire(scenario, n);
        for (int count = is_bridged(&scenario->axes[n]) ? pick(4) : 0; count > 0; count--)
            add(scenario, step_of(scenario, n, ONE_OF(of_bridges)));
        for (int count = pick(3); count > 0; count--)
            add(scenario, step_of(scenario, n, ONE_OF(readers)));
    }
}
