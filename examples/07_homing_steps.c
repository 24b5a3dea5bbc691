/*
 * Homing in steps (PLCopen Part 5): fast onto a switch (if the axis stands on it, off it first), slowly off it again,
 * which says where its edge is, then a little away. Three times, each time from another place; the program prints by
 * how much all positions change by that, which is how well the edge is found again: half the way of one cycle at the
 * slow velocity, and what the switch adds.
 * On the simulator the switch is at input 2, three revolutions from where the motor stands.
 *
 *     07_homing_steps -i sim --svg homing.svg
 *
 * On a wire: a switch at IN2 that goes on within 5 revolutions in positive direction and stays on for one at least.
 */
#include <math.h>

#include "example.h"

/* Revolutions, revolutions per second. */
static const LREAL places[] = {0, 3.6, 2.5}; /* left of the switch, on it, nearer */
static const LREAL fast = 2, slow = 0.1, switch_position = 3, away = -0.5;
static const TIME at_most = 20000000000; /* ns for a step */
enum { RUNS = sizeof places / sizeof places[0] };
enum { GO = 0, FAST, SLOW, AWAY };

static example_t example;
static MC_Power_t power = {.Axis = &example.axis, .EnablePositive = TRUE, .EnableNegative = TRUE};
static MC_MoveAbsolute_t move = {.Axis = &example.axis};
static MC_StepAbsoluteSwitch_t onto = {.Axis = &example.axis, .Direction = mcSwitchPositive,
                                       .SwitchMode = mcRisingEdge, .ReferenceSignal = {.InputNumber = 2}};
static MC_StepAbsoluteSwitch_t off = {.Axis = &example.axis, .Direction = mcNegativeDirection,
                                      .SwitchMode = mcFallingEdge, .ReferenceSignal = {.InputNumber = 2}};
static MC_FinishHoming_t finish = {.Axis = &example.axis};
static int homing, step;
static LREAL standing_at, changed[RUNS];
static WORD error_id;

/* The step's block is called in any case, so that it sees its Execute fall. */
static BOOL call_steps(void)
{
    move.Execute = step == GO;
    onto.Execute = step == FAST;
    off.Execute = step == SLOW;
    finish.Execute = step == AWAY;
    move.Position = places[homing];
    move.Velocity = onto.Velocity = finish.Velocity = fast;
    off.Velocity = slow;
    onto.SetPosition = NAN; /* too fast to measure the position of the switch */
    off.SetPosition = switch_position;
    onto.TimeLimit = off.TimeLimit = at_most;
    onto.DistanceLimit = off.DistanceLimit = 6;
    finish.Distance = away;
    MC_MoveAbsolute(&move);
    MC_StepAbsoluteSwitch(&onto);
    MC_StepAbsoluteSwitch(&off);
    MC_FinishHoming(&finish);
    const BOOL done[] = {move.Done, onto.Done, off.Done, finish.Done};
    return done[step];
}

static void program(void *context)
{
    (void)context;
    cm1e_axis_info_t now;
    power.Enable = homing < RUNS;
    MC_Power(&power);
    if (homing == RUNS) {
        if (!power.Status)
            example_finish(&example);
        return;
    }
    if (power.Status && call_steps()) {
        cm1e_axis_read(example.axis, &now);
        if (step == SLOW)
            changed[homing] = now.set_position - standing_at; /* the axis is at rest: only its positions have other
                                                               * values */
        step = step == AWAY ? GO : step + 1;
        homing += step == GO;
    }
    cm1e_axis_read(example.axis, &now);
    standing_at = now.set_position;
    const WORD errors[] = {power.ErrorID, move.ErrorID, onto.ErrorID, off.ErrorID, finish.ErrorID};
    for (size_t i = 0; i < sizeof errors / sizeof errors[0]; i++)
        if (errors[i] != 0 && error_id == 0) {
            error_id = errors[i];
            example_finish(&example);
        }
}

static void print_report(void)
{
    for (int i = 0; i < homing; i++)
        printf("homing %d from %g u: all positions change by %.5f u\n", i + 1, places[i], changed[i]);
}

int main(int argc, char **argv)
{
    cm1e_diag_t why = {0};
    example_options(&example, argc, argv, "Homes an axis in steps, on a switch at input 2.");
    cm1e_error_t error = example_open(&example, &why);
    if (error == CM1E_OK)
        error = example_run(&example, program, &why);
    if (example_is_done(&example, error))
        print_report();
    if (error_id != 0)
        example_tell_error(&example, error_id);
    return example_end(&example, error, &why, homing == RUNS && error_id == 0);
}
