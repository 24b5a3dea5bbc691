/*
 * Measures where a switch is: the axis passes it at three velocities, there and back, and MC_TouchProbe records the
 * position of both edges. The motor samples its inputs once a cycle, so each position is known to half the way of a
 * cycle; the program prints that beside it. What is left between the two directions is a delay, of the input and of the
 * switch itself, known to half a cycle as well: it shows as soon as it is longer. On the simulator the switch is at
 * input 2, three revolutions from where the motor stands.
 *
 *     05_touch_probe -i sim --svg probe.svg
 *
 * On a wire: a switch at IN2 that goes on between 2 and 4 revolutions in positive direction and stays on there.
 */
#include "example.h"

/* Revolutions, revolutions per second. */
static const LREAL before_it = 2, behind_it = 4;
static const LREAL velocities[] = {1, 3, 9};
enum { PASSES = sizeof velocities / sizeof velocities[0], THERE = 0, BACK };

static example_t example;
static MC_Power_t power = {.Axis = &example.axis, .EnablePositive = TRUE, .EnableNegative = TRUE};
static MC_MoveAbsolute_t move = {.Axis = &example.axis};
/* The switch goes on on the way there, and off on the way back. */
static const MC_TRIGGER_REF edges[] = {{.InputNumber = 2}, {.InputNumber = 2, .FallingEdge = TRUE}};
static MC_TouchProbe_t probe = {.Axis = &example.axis, .WindowOnly = TRUE};
static struct {
    LREAL position, uncertainty;
} recorded[PASSES][2];
static int pass = -1, way = BACK; /* the way to where it begins comes first */
static WORD error_id;

/* One way over the switch; TRUE when the axis stands behind it. */
static bool go(void)
{
    const bool measures = pass >= 0;
    move.Position = way == THERE ? behind_it : before_it;
    move.Velocity = measures ? velocities[pass] : 4;
    probe.TriggerInput = &edges[way];
    probe.FirstPosition = before_it;
    probe.LastPosition = behind_it;
    probe.Execute = measures;
    MC_TouchProbe(&probe);
    move.Execute = TRUE;
    MC_MoveAbsolute(&move);
    if (!move.Done)
        return false;
    if (measures) {
        recorded[pass][way].position = probe.RecordedPosition;
        recorded[pass][way].uncertainty = probe.Done ? probe.Uncertainty : -1;
    }
    move.Execute = probe.Execute = FALSE; /* the next edge needs a call with FALSE before */
    MC_MoveAbsolute(&move);
    MC_TouchProbe(&probe);
    return true;
}

static void program(void *context)
{
    (void)context;
    static BOOL done_before;
    power.Enable = pass < PASSES;
    MC_Power(&power);
    if (pass == PASSES) {
        if (!power.Status)
            example_finish(&example);
    } else if (power.Status && go()) {
        pass += way == BACK;
        way = way == THERE ? BACK : THERE;
    }
    if (probe.Done && !done_before)
        cm1e_scheduler_mark(example.scheduler, way == THERE ? "on" : "off");
    done_before = probe.Done;
    const WORD error = power.Error ? power.ErrorID : move.Error ? move.ErrorID : probe.Error ? probe.ErrorID : 0;
    if (error != 0 && error_id == 0) {
        error_id = error;
        example_finish(&example);
    }
}

/* Both directions see the same switch, each late by the same time. */
static void print_report(void)
{
    printf("     u/s        on at       off at      +-          between them       late by\n");
    for (int i = 0; i < pass; i++) {
        const LREAL on = recorded[i][THERE].position, off = recorded[i][BACK].position;
        if (recorded[i][THERE].uncertainty < 0 || recorded[i][BACK].uncertainty < 0)
            printf("%8g   the switch was not seen on both ways\n", velocities[i]);
        else
            printf("%8g %12.5f %12.5f %10.5f %16.5f %10.0f us\n", velocities[i], on, off,
                   recorded[i][THERE].uncertainty, (on + off) / 2, (on - off) / 2 / velocities[i] * 1e6);
    }
}

static bool all_seen(void)
{
    bool seen = pass == PASSES;
    for (int i = 0; i < PASSES && seen; i++)
        seen = recorded[i][THERE].uncertainty >= 0 && recorded[i][BACK].uncertainty >= 0;
    return seen;
}

int main(int argc, char **argv)
{
    cm1e_diag_t why = {0};
    example_options(&example, argc, argv, "Measures where a switch is, by touch probe.");
    cm1e_error_t error = example_open(&example, &why);
    if (error == CM1E_OK)
        error = example_run(&example, program, &why);
    if (example_is_done(&example, error))
        print_report();
    if (error_id != 0)
        example_tell_error(&example, error_id);
    return example_end(&example, error, &why, all_seen() && error_id == 0);
}
