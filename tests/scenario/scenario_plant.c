/*
 * What seeds from 8,000,000,000 on add around the motors: gears with backlash, mailboxes that answer late, limit switches
 * at a terminal, motors behind a bridge that a string or a command moves, what is read of a group, paths that are
 * interrupted and go on, and direct motions of a group.
 */
#include <math.h>
#include <string.h>

#include "chance.h"
#include "scenario.h"

enum { FIRST_STEP = 260 };

static const char *const group_readers[] = {"MC_GroupReadPosition", "MC_GroupReadVelocity", "MC_GroupReadError",
                                            "MC_GroupReadConfiguration"};
static const char *const switch_homings[] = {"MC_StepLimitSwitch", "MC_StepAbsoluteSwitch"};
#define ONE_OF(list) scenario_block((list)[pick(sizeof(list) / sizeof(list)[0])])

static bool is_bridged(const axis_spec_t *axis) { return axis->kind >= AXIS_EB01 && axis->kind <= AXIS_EB12; }

static double some_time(const scenario_t *scenario) { return FIRST_STEP + pick((int)scenario->cycles - FIRST_STEP); }

static void add(scenario_t *scenario, step_t step)
{
    if (scenario->step_count < SCENARIO_STEPS)
        scenario->steps[scenario->step_count++] = step;
}

/* ---- the machine ------------------------------------------------------------------------------------------------- */

/** In CSV a motor hunts round its target, and says nothing about its gear. */
static void make_gap(axis_spec_t *axis)
{
    if (axis->kind == AXIS_VIRTUAL || axis->motion != 0 || axis->stops != 0 || axis->mapping == MAPPING_CSV || one_in(2))
        return;
    axis->backlash = floor(uniform(1, one_in(2) ? 300 : 6000));
    axis->backlash_velocity = floor(uniform(5000, one_in(2) ? 50000 : 300000));
}

/** Hard stops, and switches before them that its program drives. */
static void make_switches(scenario_t *scenario, int n)
{
    axis_spec_t *axis = &scenario->axes[n];
    if (scenario->io == 0 || axis->kind != AXIS_CM1E || axis->network != 0 || axis->wired == 0 || axis->backlash != 0 ||
        axis->modulo != 0 || axis->start != 0)
        return;
    axis->stops = axis->switched = 1;
    axis->done_waits = 0;
    for (int i = 0; i < scenario->step_count; i++) {
        step_t *step = &scenario->steps[i];
        if ((int)step->axis != n || !one_in(4))
            continue;
        step->block = ONE_OF(switch_homings);
        step->mode = pick(4);
        step->direction = pick(2);
        step->velocity = floor(axis->velocity * uniform(0.05, 1));
        step->buffer = 0;
        step->hold = 1500;
    }
}

/* ---- the program ------------------------------------------------------------------------------------------------- */

/** MC_Power lets it go, and then it is moved by itself: by strings, or in CMD by commands. */
static void move_by_itself(scenario_t *scenario, int n)
{
    enum { ENABLE = 1, SEARCH = 2, COMMANDS = 5, CMD = 2, APART = 200 };
    double at = some_time(scenario);
    const bool by_strings = one_in(2);
    add(scenario, (step_t){.at = at, .axis = n, .block = scenario_block("MC_Power"), .hold = 300 + pick(1500)});
    at += 50 + pick(APART);
    if (!by_strings) {
        add(scenario, (step_t){.at = at, .axis = n, .block = scenario_block("CM_SetMode"), .mode = CMD, .hold = APART});
        at += 20 + pick(APART);
    }
    for (int count = 2 + pick(3), i = 0; i < count; i++) {
        step_t step = {.at = at, .axis = n, .hold = 20 + pick(2000), .allow = 1, .parameter = i == 0 ? 0 : pick(100),
                       .block = scenario_block(by_strings ? "CM_SendCML" : "CM_Command")};
        step.mode = by_strings ? 0 : i == 0 ? ENABLE : i == 1 ? SEARCH : pick(COMMANDS);
        add(scenario, step);
        at += 10 + pick(one_in(2) ? 60 : 4 * APART);
    }
}

static void read_group(scenario_t *scenario)
{
    for (int count = scenario->axis_count > 1 ? pick(4) : 0; count > 0; count--)
        add(scenario, (step_t){.at = some_time(scenario), .block = ONE_OF(group_readers), .hold = 100 + pick(2000),
                               .source = pick(3), .mode = pick(4), .again = one_in(3) ? 2 + pick(300) : 0});
}

/** Some lines become direct motions, and some parts of paths are interrupted. */
static void interrupt_paths(scenario_t *scenario)
{
    const double absolute = scenario_block("MC_MoveLinearAbsolute"), relative = scenario_block("MC_MoveLinearRelative");
    for (int i = 0, count = scenario->step_count; i < count; i++) {
        step_t *step = &scenario->steps[i];
        if ((step->block != absolute && step->block != relative) || one_in(2))
            continue;
        const double at = step->at + 1 + pick(one_in(2) ? 20 : 300);
        if (one_in(4))
            step->block = scenario_block(step->block == absolute ? "MC_MoveDirectAbsolute" : "MC_MoveDirectRelative");
        add(scenario, (step_t){.at = at, .block = scenario_block("MC_GroupInterrupt"), .hold = 1 + pick(600),
                               .deceleration = one_in(2) ? 0 : step->deceleration});
        if (!one_in(4))
            add(scenario, (step_t){.at = at + 1 + pick(one_in(2) ? 40 : 500), .block = scenario_block("MC_GroupContinue"),
                                   .hold = 1 + pick(100)});
    }
}

/* ---- the faults -------------------------------------------------------------------------------------------------- */

static void make_late_mailbox(scenario_t *scenario)
{
    const int n = pick(scenario->axis_count);
    if (scenario->axes[n].kind == AXIS_VIRTUAL || scenario->fault_count == SCENARIO_FAULTS)
        return;
    scenario->faults[scenario->fault_count++] = (fault_t){
        .at = some_time(scenario), .kind = FAULT_MAILBOX, .axis = n, .network = scenario->axes[n].network,
        .length = 50 + pick(1500), .value = floor(one_in(4) ? uniform(100000, 1000000) : uniform(500, 100000))};
}

void scenario_plant(scenario_t *scenario)
{
    bool grouped = one_in(4);
    for (int i = 0; i < scenario->step_count; i++)
        grouped = grouped || strncmp(scenario_blocks[(int)scenario->steps[i].block], "MC_Group", 8) == 0;
    for (int n = 0; n < scenario->axis_count; n++) {
        make_gap(&scenario->axes[n]);
        make_switches(scenario, n);
        if (is_bridged(&scenario->axes[n]) && one_in(2))
            move_by_itself(scenario, n);
    }
    if (grouped)
        read_group(scenario);
    while (one_in(2))
        make_late_mailbox(scenario);
    interrupt_paths(scenario);
}
