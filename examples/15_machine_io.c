/*
 * A machine with I/O terminals beside its motor: valves that are switched by the position of the axis, a light curtain
 * that stops it, an analog value in each direction. The bus file names the terminals and their signals.
 *
 * The program stops the axis when the curtain is interrupted. That is control, not safety: what protects people is a
 * safety controller, which switches the power of the motor off whatever this program does.
 *
 *     15_machine_io                        the simulated segment
 *     15_machine_io -i eth1 -b mine.yaml   on that network interface the motor turns, and the valves are switched!
 */
#include <cm1e/io.h>

#include "example.h"

#ifndef MACHINE /* where CMake does not say it, the root of the repository is the current folder */
#define MACHINE "examples/machine.yaml"
#endif

typedef enum step { STEP_POWER = 0, STEP_FEED, STEP_STAND, STEP_GO_ON, STEP_OFF } step_t;
enum { GLUE = 0, BLOWER, LAMP, EMITTER, VALVES };
static const char *const valve_names[VALVES] = {"valves.glue", "valves.blower", "valves.lamp", "valves.emitter"};
static const LREAL end = 150, test_at = 80; /* mm */
static const int64_t stand_ns = 500000000;

static example_t example = {.bus_file = MACHINE};
static cm1e_io_t valves[VALVES], curtain, pressure, pressure_set;
static MC_Power_t power = {.Axis = &example.axis, .EnablePositive = TRUE, .EnableNegative = TRUE};
static MC_MoveAbsolute_t feed = {.Axis = &example.axis, .Velocity = 60, .Acceleration = 400,
                                 .Deceleration = 400};
static MC_MoveAbsolute_t rest;
static MC_Halt_t halt = {.Axis = &example.axis, .Deceleration = 600};
static step_t step;
static int64_t stands_since_ns;
static struct { LREAL interrupted, stood, glue_on, glue_off; int64_t interrupted_ns, stood_ns; int pressure; } seen;

/* Where the glue flows, in mm: track 1. The blower is on for 0.1 s from 130 mm on: track 2. */
static const MC_CAMSWITCH_REF switches = {
    .NumberOfSwitches = 3,
    .Switches = {{.TrackNumber = 1, .FirstOnPosition = 20, .LastOnPosition = 60},
                 {.TrackNumber = 1, .FirstOnPosition = 100, .LastOnPosition = 120},
                 {.TrackNumber = 2, .FirstOnPosition = 130, .CamSwitchMode = 1, .Duration = 100000000}},
};
static MC_OUTPUT_REF tracks; /* of no axis: the program writes them to the terminal */
static MC_DigitalCamSwitch_t cam_switch = {.Axis = &example.axis, .Switches = &switches, .Outputs = &tracks,
                                           .EnableMask = 3, .ValueSource = mcSetValue};

/* Found once, before the cycle. In the cycle a signal costs a copy of a few bytes. */
static cm1e_error_t find_signals(cm1e_diag_t *why)
{
    cm1e_error_t error = cm1e_io_find(example.bus, "switches.curtain", &curtain, why);
    if (error == CM1E_OK)
        error = cm1e_io_find(example.bus, "pressures.glue", &pressure, why);
    if (error == CM1E_OK)
        error = cm1e_io_find(example.bus, "set-points.glue", &pressure_set, why);
    for (int i = 0; i < VALVES && error == CM1E_OK; i++)
        error = cm1e_io_find(example.bus, valve_names[i], &valves[i], why);
    return error;
}

/* A terminal that does not answer, or a broken wire, counts as somebody in the curtain. */
static bool curtain_is_free(void) { return cm1e_io_quality(&curtain) == CM1E_IO_GOOD && cm1e_io_bool(&curtain); }

static LREAL position_now(void)
{
    cm1e_axis_info_t axis;
    cm1e_axis_read(example.axis, &axis);
    return axis.set_position;
}

static void call_blocks(void)
{
    power.Enable = step < STEP_OFF;
    MC_Power(&power);
    feed.Execute = step == STEP_FEED;
    MC_MoveAbsolute(&feed);
    halt.Execute = step == STEP_STAND;
    MC_Halt(&halt);
    rest.Execute = step == STEP_GO_ON;
    MC_MoveAbsolute(&rest);
    cam_switch.Enable = step > STEP_POWER && step < STEP_OFF;
    MC_DigitalCamSwitch(&cam_switch);
}

/* The curtain is tested once, in the middle of the move: without its emitter it has to show somebody. */
static bool emitter_is_on(void)
{
    const bool tests = step == STEP_FEED && position_now() >= test_at;
    return !tests && !(step == STEP_STAND && cm1e_scheduler_time_ns(example.scheduler) < stands_since_ns + stand_ns);
}

static void write_outputs(void)
{
    const bool glue = tracks.Values & 1;
    const LREAL position = position_now();
    if (glue && !cm1e_io_bool(&valves[GLUE]) && seen.glue_on == 0)
        seen.glue_on = position;
    if (!glue && cm1e_io_bool(&valves[GLUE]) && seen.glue_off == 0)
        seen.glue_off = position;
    cm1e_io_set_bool(&valves[GLUE], glue && curtain_is_free());
    cm1e_io_set_bool(&valves[BLOWER], tracks.Values >> 1 & 1);
    cm1e_io_set_bool(&valves[LAMP], !curtain_is_free());
    cm1e_io_set_bool(&valves[EMITTER], emitter_is_on());
    cm1e_io_set_integer(&pressure_set, 1000);
    seen.pressure = (int)cm1e_io_integer(&pressure);
}

static bool step_is_done(void)
{
    switch (step) {
    case STEP_POWER: return power.Status && curtain_is_free();
    case STEP_FEED: return !curtain_is_free();
    case STEP_STAND: return halt.Done && curtain_is_free();
    case STEP_GO_ON: return rest.Done;
    default: return !power.Status;
    }
}

static void note(void)
{
    const int64_t now_ns = cm1e_scheduler_time_ns(example.scheduler);
    if (step == STEP_STAND && stands_since_ns == 0) {
        stands_since_ns = seen.interrupted_ns = now_ns;
        seen.interrupted = position_now();
    }
    if (halt.Done && seen.stood_ns == 0) {
        seen.stood_ns = now_ns;
        seen.stood = position_now();
    }
}

static void program(void *context)
{
    static const char *const marks[] = {"power", "feed", "curtain", "go on", "off"};
    (void)context;
    call_blocks();
    note();
    write_outputs();
    const bool failed = example_failed(&example, example.axis, power.Error, power.ErrorID) ||
                        example_failed(&example, example.axis, feed.Error, feed.ErrorID) ||
                        example_failed(&example, example.axis, halt.Error, halt.ErrorID) ||
                        example_failed(&example, example.axis, rest.Error, rest.ErrorID) ||
                        example_failed(&example, example.axis, cam_switch.Error, cam_switch.ErrorID);
    if (failed)
        step = STEP_OFF;
    if (step_is_done())
        step = (step_t)example_next_step(&example, marks, step, STEP_OFF);
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
        {"bus", 'b', "FILE", 0, "another bus file with these signals; its interface is the default", 0}, {0}};
    static const struct argp argp = {options, option, NULL, "Valves and a light curtain beside an axis.", children, NULL,
                                     NULL};
    cm1e_diag_t why = {0};
    argp_parse(&argp, argc, argv, 0, NULL, NULL);
    feed.Position = end;
    rest = feed;
    cm1e_error_t error = example_open(&example, &why);
    if (error == CM1E_OK)
        error = find_signals(&why);
    if (error == CM1E_OK)
        error = example_run(&example, program, &why);
    if (example_is_done(&example, error)) {
        printf("Glue from %.2f mm on, off at %.2f mm. Pressure %d of 1000, with the offset of the terminal.\n",
               seen.glue_on, seen.glue_off, seen.pressure);
        printf("The curtain was interrupted at %.2f mm. The axis stood %lld ms later, at %.2f mm, and went on.\n",
               seen.interrupted, (long long)((seen.stood_ns - seen.interrupted_ns) / 1000000), seen.stood);
    }
    return example_end(&example, error, &why, true);
}
