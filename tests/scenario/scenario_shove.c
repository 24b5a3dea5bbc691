/*
 * What seeds from 9,000,000,000 on add: an analog terminal; MC_Power is taken away, somebody shoves the load of the motor, and MC_Power comes
 * again while it turns; and a pause of the host or lost frames just then.
 */
#include <math.h>

#include "chance.h"
#include "scenario.h"

enum { FIRST_STEP = 260, REST = 120, LONGEST_COAST = 60, ENABLING = 14, LONGEST = 20 };

static void add_fault(scenario_t *scenario, fault_t fault)
{
    if (scenario->fault_count < SCENARIO_FAULTS)
        scenario->faults[scenario->fault_count++] = fault;
}

/** The load is as heavy as a motor can stop, or as light as none. Not where hard stops would end it. */
static void shove(scenario_t *scenario, int n)
{
    axis_spec_t *axis = &scenario->axes[n];
    if (axis->kind == AXIS_VIRTUAL || axis->stops != 0 || scenario->step_count == SCENARIO_STEPS)
        return;
    if (one_in(2))
        axis->load_inertia = one_in(2) ? uniform(2e-5, 6e-5) : uniform(1e-6, 2e-5);
    const double off_at = FIRST_STEP + pick((int)scenario->cycles - FIRST_STEP);
    const double on_at = off_at + REST + pick(2 * REST);
    const double before = 1 + pick(one_in(2) ? 10 : LONGEST_COAST);
    scenario->steps[scenario->step_count++] =
        (step_t){.at = off_at, .axis = n, .block = scenario_block("MC_Power"), .hold = on_at - off_at};
    add_fault(scenario, (fault_t){.at = on_at - before, .kind = FAULT_SHOVE, .axis = n, .network = axis->network,
                                  .length = 1, .value = floor(uniform(-1.2, 1.2) * axis->velocity)});
    if (one_in(2))
        add_fault(scenario, (fault_t){.at = on_at + pick(ENABLING), .axis = n, .network = axis->network,
                                      .kind = one_in(3) ? FAULT_LOSE : FAULT_STALL, .length = 1 + pick(one_in(2) ? 3 : LONGEST)});
}

void scenario_shove(scenario_t *scenario)
{
    for (int n = 0; n < scenario->axis_count; n++)
        for (int count = 1 + pick(2); count > 0; count--)
            shove(scenario, n);
    if (scenario->io != 0 && one_in(2))
        scenario->analog = 1 + pick(8);
}
