/* The program of a scenario: its steps as blocks that are called in every cycle, and what brings a machine back. */
#include <math.h>
#include <string.h>

#include "cia402/cia402.h"
#include "scenario_private.h"

enum { SELECT_AT = 3, ENABLE_AT = 5, GROUP_AT = 150 };
/* Cycles of 1 ms at most; with shorter cycles they last as long. */
enum { MEND_MS = 40, MEND_LATE_MS = 1200, DOWN_MS = 40000, REST_MS = 40, RESET_MS = 10500, RESETS = 3, AGAIN_MS = 200, POWER_MS = 4000,
       TEST_MS = 8000, OFF_MS = 3000 };
#define TEST_COUNTS 2000.0
#define NEAR_STOP 200000.0
#define STOP_COUNTS 249000.0 /* of 250,000 */
#define TURNING 100.0 /* counts/s */
#define CAM_MASTER_COUNTS 100000.0
#define CAM_SLAVE_COUNTS 4000.0

/** An input of a block, from a number of the step. */
typedef struct input {
    const char *name;
    size_t offset;
    bool is_length;      /**< counts in the step, units in the block */
} input_t;
#define LENGTH(name, member) {name, offsetof(step_t, member), true}
#define PLAIN(name, member) {name, offsetof(step_t, member), false}
static const input_t inputs[] = {
    LENGTH("Position", position), LENGTH("Distance", distance), LENGTH("Velocity", velocity),
    LENGTH("VelocityDiff", velocity), LENGTH("Acceleration", acceleration), LENGTH("Deceleration", deceleration),
    LENGTH("Jerk", jerk), LENGTH("EndVelocity", end_velocity), LENGTH("PhaseShift", distance),
    LENGTH("MasterSyncPosition", x), LENGTH("SlaveSyncPosition", y), PLAIN("BufferMode", buffer),
    PLAIN("Direction", direction), PLAIN("RatioNumerator", numerator), PLAIN("RatioDenominator", denominator),
    PLAIN("GearRatioNumeratorM1", numerator), PLAIN("GearRatioDenominatorM1", denominator),
    PLAIN("GearRatioNumeratorM2", numerator), PLAIN("GearRatioDenominatorM2", denominator),
    PLAIN("VelFactor", factor), PLAIN("Relative", relative), PLAIN("Value", value), PLAIN("Mode", mode), PLAIN("Insist", value),
    PLAIN("StartMode", mode), PLAIN("CircMode", mode), PLAIN("OutputNumber", mode), PLAIN("Command", mode), PLAIN("SwitchMode", mode),
    PLAIN("LimitSwitchMode", mode), PLAIN("TorqueLimit", torque), PLAIN("Torque", torque),
    LENGTH("SetPosition", position), LENGTH("DistanceLimit", x), PLAIN("ContinuousUpdate", update),
    PLAIN("ParameterNumber", parameter), PLAIN("MasterValueSource", source), PLAIN("TransitionMode", transition),
    LENGTH("TransitionParameter", corner), PLAIN("SlaveScaling", scaling),
    LENGTH("MasterStartDistance", start_distance), PLAIN("AllowMotion", allow), PLAIN("Source", source),
    PLAIN("IdentInGroup", mode)};

/** They change the limits that the configuration has. */
static const char *const limit_writers[] = {"MC_WriteParameter", "MC_WriteBoolParameter", NULL};

static int cycles_of(const run_t *run, double ms) { return (int)(ms * 1000 / run->scenario->cycle_us); }

static const MC_OUTPUT_REF *output_of(machine_axis_t *axis)
{
    static MC_OUTPUT_REF outputs[SCENARIO_AXES];
    outputs[axis->number] = (MC_OUTPUT_REF){.Axis = axis->reference, .Number = 1};
    return &outputs[axis->number];
}

/** Ways of the first two axes, each in its own units. */
static void set_path(const run_t *run, instance_t *block, const step_t *step)
{
    const double first = run->axes[0].spec->counts_per_unit;
    const double second = run->axes[run->scenario->axis_count > 1].spec->counts_per_unit;
    const struct { const char *name; double x, y; } ends[] = {
        {"Position", step->x, step->y}, {"Distance", step->x, step->y}, {"EndPoint", step->x, step->y},
        {"AuxPoint", step->aux_x, step->aux_y}};
    for (size_t i = 0; i < sizeof ends / sizeof ends[0]; i++) {
        const block_member_t *member = block_member(block->type, ends[i].name);
        const double values[2] = {ends[i].x / first, ends[i].y / second};
        if (member && member->size >= sizeof values) /* an array, not one number */
            memcpy(block->memory + member->offset, values, sizeof values);
    }
}

static void prepare_block(run_t *run, instance_t *block, const step_t *step)
{
    machine_axis_t *axis = &run->axes[(int)step->axis], *master = &run->axes[(int)step->master];
    *block = (instance_t){.type = block_type(scenario_blocks[(int)step->block]), .step = step, .edge_at = -1000};
    for (size_t i = 0; i < sizeof inputs / sizeof inputs[0]; i++) {
        double value;
        memcpy(&value, (const char *)step + inputs[i].offset, sizeof value);
        block_put(block, inputs[i].name, inputs[i].is_length ? value / axis->spec->counts_per_unit : value);
    }
    if (block_is(block, "MC_WriteParameter")) /* of a limit */
        block_put(block, "Value", step->position / axis->spec->counts_per_unit);
    block_put(block, "AccFactor", 1);
    block_put(block, "JerkFactor", 1);
    set_path(run, block, step);
    block_point(block, "Axis", &axis->reference);
    block_point(block, "Slave", &axis->reference);
    block_point(block, "Master", &master->reference);
    block_point(block, "Master1", &master->reference);
    block_point(block, "Master2", &run->axes[0].reference);
    block_point(block, "AxesGroup", &run->group);
    block_point(block, "Output", output_of(axis));
    data_prepare(run, block);
}

static void prepare_axis(machine_axis_t *axis)
{
    const double unit = axis->spec->counts_per_unit;
    const MC_CAM_POINT points[3] = {{0}, {.Master = CAM_MASTER_COUNTS / 2 / unit, .Slave = CAM_SLAVE_COUNTS / unit},
                                    {.Master = CAM_MASTER_COUNTS / unit}};
    memcpy(axis->cam_points, points, sizeof points);
    axis->cam = (MC_CAM_REF){.Points = axis->cam_points, .NumberOfPoints = 3, .Curve = mcCamPolynomial5};
    axis->power = (MC_Power_t){.Axis = &axis->reference, .EnablePositive = TRUE, .EnableNegative = TRUE};
    axis->reset = (MC_Reset_t){.Axis = &axis->reference};
    axis->restore = (MC_WriteParameter_t){.Axis = &axis->reference};
    axis->test = (MC_MoveRelative_t){.Axis = &axis->reference};
    axis->override = (MC_SetOverride_t){.Axis = &axis->reference, MC_SETOVERRIDE_DEFAULTS};
    axis->select = (MC_CamTableSelect_t){.Slave = &axis->reference, .CamTable = &axis->cam, .Periodic = TRUE};
}

void program_prepare(run_t *run)
{
    const scenario_t *scenario = run->scenario;
    for (int n = 0; n < scenario->axis_count; n++)
        prepare_axis(&run->axes[n]);
    for (int i = 0; i < scenario->step_count; i++) {
        prepare_block(run, &run->blocks[i], &scenario->steps[i]);
        run->grouped = run->grouped || block_member(run->blocks[i].type, "AxesGroup");
    }
    run->grouped = run->grouped && scenario->axis_count > 1;
    for (int n = 0; n < 2; n++)
        run->axes[n].add = (MC_AddAxisToGroup_t){.AxesGroup = &run->group, .Axis = &run->axes[n].reference,
                                                 .IdentInGroup = (UINT)(n + 1)};
    run->group_enable = (MC_GroupEnable_t){.AxesGroup = &run->group};
    run->ungroup = (MC_UngroupAllAxes_t){.AxesGroup = &run->group};
    run->group_reset = (MC_GroupReset_t){.AxesGroup = &run->group};
}

/* ---- the program ------------------------------------------------------------------------------------------------- */

static bool is_held(const run_t *run, const step_t *step)
{
    const double age = run->cycle - step->at;
    const bool between = step->again >= 2 && age >= step->again && fmod(age, step->again) < 1;
    return run->phase == PHASE_PROGRAM && age >= 0 && (step->hold == 0 || age < step->hold) && !between;
}

static bool is_power(const step_t *step) { return strcmp(scenario_blocks[(int)step->block], "MC_Power") == 0; }

static void call_power(run_t *run, machine_axis_t *axis)
{
    if (run->phase == PHASE_PROGRAM) {
        axis->power.Enable = run->cycle >= ENABLE_AT;
        axis->power.EnablePositive = axis->power.EnableNegative = TRUE;
        for (int i = 0; i < run->scenario->step_count; i++) { /* a step of MC_Power takes it away */
            const step_t *step = &run->scenario->steps[i];
            if (!is_power(step) || (int)step->axis != axis->number || !is_held(run, step))
                continue;
            BOOL *const taken[] = {&axis->power.Enable, &axis->power.EnablePositive, &axis->power.EnableNegative};
            *taken[(unsigned)step->mode % 3] = FALSE;
        }
    } else {
        axis->power.EnablePositive = axis->power.EnableNegative = TRUE;
    }
    MC_Power(&axis->power);
}

static void call_block(run_t *run, instance_t *block)
{
    const bool held = is_held(run, block->step);
    static const char *const triggers[] = {"Execute", "Enable", "JogForward"};
    if (strcmp(block->type->name, "MC_CamIn") == 0) {
        const MC_CAM_ID id = run->axes[(int)block->step->axis].cam_id;
        memcpy(block->memory + block_member(block->type, "CamTableID")->offset, &id, sizeof id);
    }
    const char *trigger = triggers[2];
    for (int i = 0; i < 3; i++)
        if (block_member(block->type, triggers[i])) {
            trigger = triggers[i];
            break;
        }
    if (strcmp(trigger, "JogForward") == 0 && block->step->direction != 0)
        trigger = "JogBackwards";
    if (held && !block->triggered)
        block->edge_at = run->cycle;
    block->triggered = held;
    block_put(block, trigger, held);
    data_cycle(run, block);
    block->type->call(block->memory);
    judge_block(run, block);
    if (block_member(block->type, "CamTable") && block_flag(block, "Done"))
        memcpy(&run->axes[(int)block->step->axis].cam_id, block->memory + block_member(block->type, "CamTableID")->offset,
               sizeof(MC_CAM_ID));
}

static void call_group(run_t *run)
{
    if (!run->grouped)
        return;
    for (int n = 0; n < 2; n++) {
        run->axes[n].add.Execute = run->cycle >= GROUP_AT;
        MC_AddAxisToGroup(&run->axes[n].add);
    }
    run->group_enable.Execute = run->cycle >= GROUP_AT + 2;
    MC_GroupEnable(&run->group_enable);
}

void program_cycle(run_t *run)
{
    for (int n = 0; n < run->scenario->axis_count; n++) {
        machine_axis_t *axis = &run->axes[n];
        axis->select.Execute = run->cycle >= SELECT_AT;
        MC_CamTableSelect(&axis->select);
        if (axis->cam_id == 0)
            axis->cam_id = axis->select.CamTableID;
        call_power(run, axis);
    }
    if (run->phase == PHASE_PROGRAM)
        call_group(run);
    for (int i = 0; i < run->scenario->step_count; i++)
        if (run->cycle >= run->blocks[i].step->at && !is_power(run->blocks[i].step))
            call_block(run, &run->blocks[i]);
    judge_blocks(run);
}

/* ---- bringing it back -------------------------------------------------------------------------------------------- */

static bool all(run_t *run, bool (*is)(run_t *run, machine_axis_t *axis))
{
    bool result = true;
    for (int n = 0; n < run->scenario->axis_count; n++)
        result = is(run, &run->axes[n]) && result;
    return result;
}

/** Goes on when it is so for all axes; false and a failure after so many ms. */
static void go_on(run_t *run, bool (*is)(run_t *run, machine_axis_t *axis), int limit_ms, const char *what)
{
    if (all(run, is)) {
        run->phase++;
        run->phase_begin = run->cycle;
        return;
    }
    if (run->cycle - run->phase_begin <= cycles_of(run, limit_ms))
        return;
    for (int n = 0; n < run->scenario->axis_count; n++) {
        char text[CM1E_AXIS_ERROR_TEXT_BYTES];
        cm1e_axis_error_text(run->axes[n].reference, text, sizeof text);
        if (!is(run, &run->axes[n]))
            scenario_fail(run, "recovery", "%s: %s within %d ms after the last fault; state %s, error 0x%04X: %.200s",
                          run->axes[n].name, what, limit_ms, cm1e_axis_state_name(run->axes[n].info.state),
                          cm1e_error_id(run->axes[n].info.error), text);
    }
}

static bool is_down(run_t *run, machine_axis_t *axis)
{
    axis->power.Enable = FALSE;
    const cm1e_axis_state_t state = axis->info.state;
    /* MC_Power ends a motion of the motor by itself, also where its slave has left Operational and shows no mode. */
    const bool elsewhere = axis->channel > 0 && axis->info.mode != CM1E_MODE_CSP;
    if (axis->seen.by_itself && elsewhere && axis->probe.torque_on)
        return true;
    /* A motor behind a bridge may hold its position by itself when it gets its supply (docs/SAFETY.md). */
    const bool rests = axis->seen.rest_cycles >= cycles_of(run, REST_MS);
    const bool free = !axis->probe.torque_on || (axis->channel > 0 && rests);
    /* Enabled before a stop, it is braked into that. The way back to csp needs a motor that rests for some time
     * (docs/SAFETY.md): MC_Power of the program, which began it, may fail until then, and MC_Reset comes after that. */
    const bool turns = axis->spec->stops != 0 && fabs(axis->probe.velocity_counts_per_s) > TURNING;
    const bool coasts = turns || (elsewhere && !rests);
    const bool pushed = run->cycle <= axis->seen.pushed_until; /* by a load, and it has not come to rest since */
    return (state == CM1E_AXIS_DISABLED || state == CM1E_AXIS_ERROR_STOP) && free && !coasts && !pushed;
}

/** A MC_Reset of the program is not over yet: its own edge may have come before the fault was gone. */
static bool is_being_reset(const run_t *run, const machine_axis_t *axis)
{
    for (int i = 0; i < run->scenario->step_count; i++)
        if ((int)run->blocks[i].step->axis == axis->number && block_is(&run->blocks[i], "MC_Reset") &&
            block_flag(&run->blocks[i], "Busy"))
            return true;
    return false;
}

/** One edge of MC_Reset, and another one where that failed. Where an axis is Disabled, and its slave has not been seen
 *  to be back, MC_Reset is Done without an effect: then it is asked again from time to time. */
static bool is_reset(run_t *run, machine_axis_t *axis)
{
    if (axis->info.state != CM1E_AXIS_ERROR_STOP && axis->info.online) {
        axis->reset.Execute = FALSE;
        MC_Reset(&axis->reset);
        return axis->info.state == CM1E_AXIS_DISABLED && !is_being_reset(run, axis);
    }
    const bool from_time_to_time = run->cycle % cycles_of(run, AGAIN_MS) == 0;
    const bool absent = axis->spec->optional != 0 && axis->reset.Error; /* as far as the bus knows by now */
    if (axis->reset.Done || absent) {
        axis->reset.Execute = !from_time_to_time;
        axis->resets -= absent && from_time_to_time;
    } else if (!axis->reset.Execute || axis->reset.Error) {
        axis->reset.Execute = !axis->reset.Execute && axis->resets < RESETS;
        axis->resets += axis->reset.Execute && axis->info.state == CM1E_AXIS_ERROR_STOP;
    }
    MC_Reset(&axis->reset);
    return false;
}

/** The program may have changed limits: those of the configuration again, one after the other. */
static bool is_restored(machine_axis_t *axis)
{
    const axis_spec_t *spec = axis->spec;
    const double unit = spec->counts_per_unit, pos = spec->limit_positive / unit, neg = spec->limit_negative / unit;
    const bool limited = pos != 0 || neg != 0;
    const struct { INT number; LREAL value; } limits[] = {
        {4, 0}, {5, 0}, {2, pos}, {3, neg}, {2, pos}, {4, limited}, {5, limited}, {9, spec->velocity / unit},
        {13, spec->acceleration / unit}, {15, spec->deceleration / unit}, {17, spec->jerk / unit}};
    MC_WriteParameter_t *block = &axis->restore;
    const int count = sizeof limits / sizeof limits[0];
    if (axis->restored >= count)
        return true;
    block->Execute = !block->Execute;
    block->ParameterNumber = limits[axis->restored].number;
    block->Value = limits[axis->restored].value;
    MC_WriteParameter(block);
    axis->restored += block->Execute;
    return false;
}

static bool is_enabled(run_t *run, machine_axis_t *axis)
{
    if (program_has(run->scenario, axis->number, limit_writers) && !is_restored(axis))
        return false;
    axis->power.Enable = axis->override.Enable = TRUE;
    MC_SetOverride(&axis->override);
    axis->test_from = axis->seen.load;
    /* A turning shaft is caught, and the axis is in Standstill meanwhile. */
    const bool turns = fabs(axis->probe.velocity_counts_per_s) > TURNING ||
                       axis->seen.rest_cycles < cycles_of(run, REST_MS);
    if (is_motor(axis) && turns)
        return false;
    return axis->info.state == CM1E_AXIS_STANDSTILL && axis->power.Status;
}

/** Inwards, as the configuration and the axis's own coordinates say; 0: a homing in steps or MC_SetPosition has put it
 *  outside its software limits, and the way back leads into a hard stop; or next to a limit, and the way from the stop
 *  would leave it. */
static double test_distance(const machine_axis_t *axis)
{
    const double position = axis->info.actual_position * axis->spec->counts_per_unit;
    const double middle = (axis->spec->limit_negative + axis->spec->limit_positive) / 2;
    const bool limited = axis->spec->limit_positive != 0 || axis->spec->limit_negative != 0;
    const double shaft = axis->probe.position_counts * (axis->spec->invert != 0 ? -1 : 1);
    const bool by_limits = limited && fabs(shaft) < NEAR_STOP;
    const bool outside = limited && (position > axis->spec->limit_positive || position < axis->spec->limit_negative);
    const double by = (by_limits || outside ? position > middle : shaft > 0) ? -TEST_COUNTS : TEST_COUNTS;
    const double target = position + by;
    const bool leaves = limited && !outside &&
                        (target > axis->spec->limit_positive || target < axis->spec->limit_negative);
    return leaves || (outside && axis->spec->stops != 0 && fabs(shaft + by) > STOP_COUNTS) ? 0 : by;
}

static bool is_moved(run_t *run, machine_axis_t *axis)
{
    (void)run;
    const double unit = axis->spec->counts_per_unit;
    if (!axis->test.Execute) {
        axis->test_by = test_distance(axis);
        axis->test.Distance = axis->test_by / unit;
        axis->test.Velocity = axis->spec->velocity / unit * 0.3;
    }
    if (axis->test_by == 0)
        return true;
    /* The values of a motion of the drive that was stopped may still be written: it is asked again. */
    axis->test.Execute = axis->test.ErrorID != cm1e_error_id(CM1E_ERROR_BUSY);
    MC_MoveRelative(&axis->test);
    /* In CSV friction lets the motor hunt round its target: judge_end() says how far from it is right. */
    const bool by_velocity = axis->spec->kind == AXIS_CM1E && axis->spec->mapping == MAPPING_CSV;
    return axis->test.Done && (axis->info.in_position || by_velocity);
}

static bool is_off(run_t *run, machine_axis_t *axis)
{
    (void)run;
    axis->power.Enable = FALSE;
    return axis->info.state == CM1E_AXIS_DISABLED && (!is_motor(axis) || !axis->probe.torque_on);
}

static bool is_mended(run_t *run, machine_axis_t *axis)
{
    bool late = false; /* a switch of the mode that waits for a late mailbox fails within a second */
    (void)axis;
    for (int i = 0; i < run->scenario->fault_count; i++)
        late = late || run->scenario->faults[i].kind == FAULT_MAILBOX;
    return run->cycle - run->phase_begin >= cycles_of(run, late ? MEND_LATE_MS : MEND_MS);
}

static void leave_group(run_t *run)
{
    if (!run->grouped)
        return;
    run->group_reset.Execute = run->phase == PHASE_RESET;
    MC_GroupReset(&run->group_reset);
    run->ungroup.Execute = run->phase == PHASE_POWER;
    MC_UngroupAllAxes(&run->ungroup);
}

/** From some modes of a bridge only its power leads back, and an error in CML is ended by it, or by a string. */
static void leave_modes(run_t *run)
{
    static const char *const changers[] = {"CM_SetMode", "CM_Command", NULL}, *const strings[] = {"CM_SendCML", NULL};
    for (int n = 0; n < run->scenario->axis_count; n++) {
        const machine_axis_t *axis = &run->axes[n];
        char order[40], answer[200];
        bool fails = axis->info.state == CM1E_AXIS_ERROR_STOP; /* or has an error that its axis does not know yet */
        for (int i = 0; i < run->scenario->fault_count; i++) {
            const fault_kind_t kind = run->scenario->faults[i].kind;
            const bool of_motor = kind == FAULT_BRIDGE_ERROR || kind == FAULT_BRIDGE_CABLE;
            fails = fails || (of_motor && (int)run->scenario->faults[i].axis == n);
        }
        const bool fails_in_cml = fails && program_has(run->scenario, n, strings);
        if (axis->channel == 0 || !(program_has(run->scenario, n, changers) || fails_in_cml))
            continue;
        snprintf(order, sizeof order, "power-cycle %u 10", axis->position);
        cm1e_bus_simulate(run->buses[axis->network], order, answer, sizeof answer);
        for (int i = 0; i < run->scenario->axis_count; i++)
            if (run->axes[i].network == axis->network && run->axes[i].position == axis->position)
                run->axes[i].seen.kept = false;
    }
}

void program_recover(run_t *run)
{
    leave_group(run);
    switch (run->phase) {
    case PHASE_PROGRAM:
        run->phase = PHASE_MEND;
        run->phase_begin = run->cycle;
        fault_mend(run);
        leave_modes(run);
        for (int n = 0; n < run->scenario->axis_count; n++)
            run->outcome->recoveries += run->axes[n].info.state == CM1E_AXIS_ERROR_STOP;
        break;
    case PHASE_MEND:
        if (is_mended(run, NULL))
            go_on(run, is_down, DOWN_MS, "no rest");
        break;
    case PHASE_RESET: go_on(run, is_reset, RESETS * RESET_MS, "MC_Reset is not Done"); break;
    case PHASE_POWER: go_on(run, is_enabled, POWER_MS, "no MC_Power.Status"); break;
    case PHASE_TEST: go_on(run, is_moved, TEST_MS, "the move has not ended"); break;
    case PHASE_OFF: go_on(run, is_off, OFF_MS, "not Disabled"); break;
    default: break;
    }
}
