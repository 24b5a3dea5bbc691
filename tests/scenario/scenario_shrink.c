/* Makes a failing scenario smaller: what is left must break the same rule. */
#include <string.h>

#include "scenario.h"

static int tries;

static bool still_fails(const scenario_t *scenario, const outcome_t *failure, unsigned limit_s, outcome_t *now)
{
    tries++;
    scenario_run_apart(scenario, now, limit_s);
    return now->failed && strcmp(now->rule, failure->rule) == 0;
}

/** Removes items of one list: first many at once, then one after the other. True: it removed one. */
static bool drop_items(scenario_t *scenario, const outcome_t *failure, unsigned limit_s, void *items, int *count,
                       size_t size)
{
    bool smaller = false;
    for (int chunk = *count; chunk > 0; chunk /= 2)
        for (int at = 0; at + chunk <= *count;) {
            const scenario_t before = *scenario;
            outcome_t now;
            char *place = (char *)items + (size_t)at * size;
            memmove(place, place + (size_t)chunk * size, (size_t)(*count - at - chunk) * size);
            *count -= chunk;
            if (still_fails(scenario, failure, limit_s, &now))
                smaller = true;
            else {
                *scenario = before;
                at += chunk;
            }
        }
    return smaller;
}

/** Without one axis: its steps and faults go too, and the axes behind it have other numbers. */
static void drop_axis(scenario_t *scenario, int n)
{
    int kept = 0;
    for (int i = 0; i < scenario->step_count; i++) {
        step_t step = scenario->steps[i];
        if ((int)step.axis == n || (int)step.master == n)
            continue;
        step.axis -= step.axis > n;
        step.master -= step.master > n;
        scenario->steps[kept++] = step;
    }
    scenario->step_count = kept;
    kept = 0;
    for (int i = 0; i < scenario->fault_count; i++) {
        fault_t fault = scenario->faults[i];
        if ((int)fault.axis == n)
            continue;
        fault.axis -= fault.axis > n;
        scenario->faults[kept++] = fault;
    }
    scenario->fault_count = kept;
    scenario->axis_count--;
    memmove(&scenario->axes[n], &scenario->axes[n + 1], (size_t)(scenario->axis_count - n) * sizeof scenario->axes[0]);
}

static bool drop_axes(scenario_t *scenario, const outcome_t *failure, unsigned limit_s)
{
    bool smaller = false;
    for (int n = scenario->axis_count - 1; n >= 0 && scenario->axis_count > 1; n--) {
        const scenario_t before = *scenario;
        outcome_t now;
        drop_axis(scenario, n);
        if (still_fails(scenario, failure, limit_s, &now))
            smaller = true;
        else
            *scenario = before;
    }
    return smaller;
}

/** Ends it soon after the failure, if that is in the program. */
static bool shorten(scenario_t *scenario, const outcome_t *failure, unsigned limit_s)
{
    const scenario_t before = *scenario;
    outcome_t now;
    if (!still_fails(scenario, failure, limit_s, &now))
        return false;
    const double needed = now.cycle + 2;
    for (double cycles = needed < before.cycles / 2 ? needed : before.cycles / 2; cycles < before.cycles;
         cycles = (cycles + before.cycles) / 2 + 1) {
        scenario->cycles = cycles;
        if (still_fails(scenario, failure, limit_s, &now))
            return before.cycles - cycles > 50;
    }
    *scenario = before;
    return false;
}

/** A number that is not needed takes its default. */
static bool plainer(scenario_t *scenario, const outcome_t *failure, unsigned limit_s, double *number, double value)
{
    const double before = *number;
    outcome_t now;
    if (before == value)
        return false;
    *number = value;
    if (still_fails(scenario, failure, limit_s, &now))
        return true;
    *number = before;
    return false;
}

static bool simplify(scenario_t *scenario, const outcome_t *failure, unsigned limit_s)
{
    bool simpler = plainer(scenario, failure, limit_s, &scenario->ring, 0);
    simpler = plainer(scenario, failure, limit_s, &scenario->clocks, 0) || simpler;
    simpler = plainer(scenario, failure, limit_s, &scenario->analog, 0) || simpler;
    simpler = plainer(scenario, failure, limit_s, &scenario->io, 0) || simpler;
    for (int n = 0; n < scenario->axis_count; n++) {
        axis_spec_t *axis = &scenario->axes[n];
        double *const numbers[] = {&axis->network, &axis->firmware, &axis->mapping, &axis->invert, &axis->load_inertia,
                                   &axis->friction, &axis->coupling_stop, &axis->stops, &axis->modulo,
                                   &axis->done_waits, &axis->start, &axis->wired, &axis->switched, &axis->backlash};
        for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++)
            simpler = plainer(scenario, failure, limit_s, numbers[i], 0) || simpler;
    }
    for (int i = 0; i < scenario->step_count; i++) {
        step_t *step = &scenario->steps[i];
        double *const numbers[] = {&step->acceleration, &step->deceleration, &step->jerk, &step->buffer, &step->hold,
                                   &step->direction, &step->again, &step->update, &step->change, &step->source,
                                   &step->transition, &step->scaling, &step->start_distance, &step->allow};
        for (size_t k = 0; k < sizeof numbers / sizeof numbers[0]; k++)
            simpler = plainer(scenario, failure, limit_s, numbers[k], 0) || simpler;
    }
    return simpler;
}

int scenario_shrink(scenario_t *scenario, const outcome_t *failure, unsigned limit_s)
{
    tries = 0;
    for (bool smaller = true; smaller && tries < 3000;) {
        smaller = drop_items(scenario, failure, limit_s, scenario->faults, &scenario->fault_count, sizeof(fault_t));
        smaller = drop_items(scenario, failure, limit_s, scenario->steps, &scenario->step_count, sizeof(step_t)) ||
                  smaller;
        smaller = drop_axes(scenario, failure, limit_s) || smaller;
        smaller = shorten(scenario, failure, limit_s) || smaller;
    }
    simplify(scenario, failure, limit_s);
    return tries;
}
