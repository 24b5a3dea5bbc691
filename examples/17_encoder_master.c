/*
 * A belt that somebody else drives, with an encoder terminal on it, is the master of a feeder: MC_GearIn takes up the
 * velocity of the belt, and the feeder then keeps its distance to the belt. The counts of the terminal become an axis by
 * the bus file (belt.yaml): `type: encoder` and `encoder_signal`.
 *
 *     17_encoder_master                     the simulated segment
 *     17_encoder_master -i eth1 -b my.yaml  on that network interface; the feeder follows the belt as soon as it moves!
 */
#include <math.h>

#include "example.h"

#ifndef BELT /* where CMake does not say it, the root of the repository is the current folder */
#define BELT "examples/belt.yaml"
#endif

enum { MASTER = 0, FEEDER };
typedef enum step { STEP_POWER = 0, STEP_GEAR_IN, STEP_TOGETHER, STEP_HALT, STEP_OFF } step_t;
static const int64_t settle_ns = 500000000, together_ns = 2500000000;

static example_t example = {.bus_file = BELT};
static AXIS_REF_t belt, feeder;
static MC_Power_t power = {.Axis = &feeder, .EnablePositive = TRUE, .EnableNegative = TRUE};
static MC_GearIn_t gear_in = {.Master = &belt, .Slave = &feeder, .RatioNumerator = 1, .RatioDenominator = 1,
                              .MasterValueSource = mcActualValue, .Acceleration = 1000, .Deceleration = 1000,
                              .Jerk = 50000};
static MC_Halt_t halt = {.Axis = &feeder, .Deceleration = 1000};
static step_t step;
static int64_t step_began_ns;
static struct { LREAL belt, feeder, least, most; bool begun; } seen;

/* The feeder keeps its distance to the belt, and has its velocity. */
static void measure(void)
{
    cm1e_axis_info_t master, slave;
    const int64_t lasted_ns = cm1e_scheduler_time_ns(example.scheduler) - step_began_ns;
    cm1e_axis_read(belt, &master);
    cm1e_axis_read(feeder, &slave);
    if (step != STEP_TOGETHER || lasted_ns < settle_ns)
        return;
    const LREAL distance = slave.set_position - master.actual_position;
    seen.belt = master.actual_velocity;
    seen.feeder = slave.set_velocity;
    seen.least = seen.begun ? fmin(seen.least, distance) : distance;
    seen.most = seen.begun ? fmax(seen.most, distance) : distance;
    seen.begun = true;
}

static void call_blocks(void)
{
    power.Enable = step < STEP_OFF;
    MC_Power(&power);
    gear_in.Execute = step >= STEP_GEAR_IN && step < STEP_HALT;
    MC_GearIn(&gear_in);
    halt.Execute = step == STEP_HALT;
    MC_Halt(&halt);
}

static bool step_is_done(void)
{
    const int64_t lasted_ns = cm1e_scheduler_time_ns(example.scheduler) - step_began_ns;
    switch (step) {
    case STEP_POWER: return power.Status && lasted_ns >= settle_ns; /* until the filter of the encoder has settled */
    case STEP_GEAR_IN: return gear_in.InGear;
    case STEP_TOGETHER: return lasted_ns >= together_ns;
    case STEP_HALT: return halt.Done;
    default: return !power.Status;
    }
}

static void program(void *context)
{
    static const char *const marks[] = {"power", "gear in", "with the belt", "halt", "off"};
    (void)context;
    call_blocks();
    measure();
    if (example_failed(&example, feeder, power.Error, power.ErrorID) ||
        example_failed(&example, feeder, gear_in.Error, gear_in.ErrorID) ||
        example_failed(&example, feeder, halt.Error, halt.ErrorID))
        step = STEP_OFF;
    if (!step_is_done())
        return;
    step = (step_t)example_next_step(&example, marks, step, STEP_OFF);
    step_began_ns = cm1e_scheduler_time_ns(example.scheduler);
}

static error_t option(int key, char *argument, struct argp_state *state)
{
    if (key == ARGP_KEY_INIT)
        state->child_inputs[0] = &example;
    if (key == 'b')
        example.bus_file = argument;
    return key == ARGP_KEY_INIT || key == 'b' ? 0 : ARGP_ERR_UNKNOWN;
}

int main(int argc, char **argv)
{
    static const struct argp common = {example_option_list, example_option, NULL, NULL, NULL, NULL, NULL};
    static const struct argp_child children[] = {{&common, 0, NULL, 0}, {0}};
    static const struct argp_option options[] = {
        {"bus", 'b', "FILE", 0, "another bus file with these axes; its interface is the default", 0}, {0}};
    static const struct argp argp = {options, option, NULL, "A feeder that follows the encoder of a belt.", children,
                                     NULL, NULL};
    cm1e_diag_t why = {0};
    argp_parse(&argp, argc, argv, 0, NULL, NULL);
    cm1e_error_t error = example_open(&example, &why);
    if (error == CM1E_OK) {
        belt = cm1e_scheduler_axis(example.scheduler, MASTER);
        feeder = cm1e_scheduler_axis(example.scheduler, FEEDER);
        error = example_run(&example, program, &why);
    }
    if (example_is_done(&example, error))
        printf("The belt runs at %.1f mm/s, the feeder at %.1f mm/s. Their distance changed by %.3f mm in %.1f s.\n",
               seen.belt, seen.feeder, seen.most - seen.least, (double)(together_ns - settle_ns) * 1e-9);
    return example_end(&example, error, &why, true);
}
