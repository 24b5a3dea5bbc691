/*
 * What blocks show: what PLCopen 2.4.1 allows, and what the set-points say too.
 */
#include <math.h>
#include <string.h>

#include "scenario_private.h"

static void judge_outputs(run_t *run, instance_t *block)
{
    const bool done = block_flag(block, "Done"), busy = block_flag(block, "Busy");
    const bool aborted = block_flag(block, "CommandAborted"), error = block_flag(block, "Error");
    const int shown = done + busy + aborted + error;
    const bool ended = block->was_busy && !busy;
    const char *wrong = NULL;
    if (shown > 1 || (block->triggered && shown != 1))
        wrong = "not exactly one of them";
    else if (!block->triggered && !ended && shown != busy)
        wrong = "a result without Execute";
    else if (ended && shown != 1)
        wrong = "an end without a result";
    else if (block_flag(block, "Active") && !busy && !done)
        wrong = "Active without Busy";
    if (wrong)
        scenario_fail(run, "block", "%s: %s: Execute %d, Done %d, Busy %d, CommandAborted %d, Error %d, Active %d",
                      block->type->name, wrong, block->triggered, done, busy, aborted, error,
                      block_flag(block, "Active"));
    block->was_busy = busy;
}

/* ---- what they claim --------------------------------------------------------------------------------------------- */

/** Of blocks whose claims about the set-point do not hold while these are at work on the same axis. */
static const char *const layers[] = {"MC_MoveSuperimposed", "MC_HaltSuperimposed", "MC_PhasingRelative",
                                     "MC_PhasingAbsolute", NULL};
static const char *const overrides[] = {"MC_SetOverride", NULL};
static double number_of(const instance_t *block, const char *name)
{
    const block_member_t *member = block_member(block->type, name);
    int32_t value = 0;
    memcpy(&value, block->memory + member->offset, sizeof value);
    return value;
}

bool close_to(double one, double other, double largest)
{
    return fabs(one - other) <= 1e-6 * largest + 1e-9;
}

static void judge_velocity(run_t *run, const instance_t *block, const machine_axis_t *axis)
{
    const double most = axis->spec->velocity / axis->spec->counts_per_unit;
    const double wanted = fabs(block_number(block, "Velocity"));
    const bool by_drive = axis->spec->motion != 0; /* the drive alone knows its set-point */
    /* A motion that begins anew has a maximum that was lowered meanwhile. */
    const bool lowered = program_has(run->scenario, axis->number, limit_blocks) && fabs(axis->info.set_velocity) < wanted;
    if (block->step->change == 0 && !by_drive && !program_has(run->scenario, axis->number, overrides) &&
        !lowered && !close_to(fabs(axis->info.set_velocity), wanted, most))
        scenario_fail(run, "claim", "%s: InVelocity, but the set velocity is %.9g u/s, not %.9g", axis->name,
                      axis->info.set_velocity, wanted);
}

static void judge_gear(run_t *run, const instance_t *block, const machine_axis_t *axis)
{
    const machine_axis_t *master = &run->axes[(int)block->step->master];
    const double ratio = number_of(block, "RatioNumerator") / number_of(block, "RatioDenominator");
    const double most = axis->spec->velocity / axis->spec->counts_per_unit;
    /* In the cycle in which its master fails it shows what was. */
    if (block->step->source == 0 && master->spec->motion == 0 && master->info.state != CM1E_AXIS_ERROR_STOP &&
        !close_to(axis->info.set_velocity, ratio * master->info.set_velocity, most))
        scenario_fail(run, "claim", "%s: %s is in its ratio of %.6g, but the set velocities are %.9g and %.9g u/s",
                      axis->name, block->type->name, ratio, axis->info.set_velocity, master->info.set_velocity);
}

/** One that is passed without a stop, because another command waits to blend into it, is Done on its way. In the cycle in
 *  which its axis fails it shows what was: the set-point is where the motor is. */
static void judge_arrival(run_t *run, const instance_t *block, const machine_axis_t *axis)
{
    if (axis->info.state == CM1E_AXIS_ERROR_STOP)
        return;
    const double unit = axis->spec->counts_per_unit, range = axis->spec->modulo / unit;
    double off = axis->info.set_position - block_number(block, "Position");
    off = range > 0 ? remainder(off, range) : off;
    if (block->step->change == 0 && axis->info.set_velocity == 0 && fabs(off) * unit > 0.5)
        scenario_fail(run, "claim", "%s: MC_MoveAbsolute is Done at %.9g u, not at %.9g", axis->name,
                      axis->info.set_position, block_number(block, "Position"));
}

/** Its position is unknown only where inputs were missing, or the drive homes. */
static void judge_probe(run_t *run, const instance_t *block, const machine_axis_t *axis, WORD id)
{
    if (block_is(block, "MC_TouchProbe") && !block->was_error && id == cm1e_error_id(CM1E_ERROR_AXIS_PROBE) &&
        !was_disturbed(run, &axis->seen) && axis->info.state != CM1E_AXIS_HOMING)
        scenario_fail(run, "claim", "%s (%s): a touch probe does not know the position of its trigger", axis->name,
                      cm1e_axis_state_name(axis->info.state));
}

/** One of the two switches at a terminal is where the reference is: but for the way of the cycles in which the input comes. A
 *  fast motor may stop behind the middle. */
static void judge_switch(run_t *run, const instance_t *block, const machine_axis_t *axis)
{
    const double unit = axis->spec->counts_per_unit, most = 3 * axis->spec->velocity * run->scenario->cycle_us * 1e-6 + 10;
    const double shown = (axis->info.actual_position - block_number(block, "SetPosition")) * unit;
    const double place = axis->seen.load + (shown > axis->seen.load ? SWITCH_COUNTS : -SWITCH_COUNTS);
    if (!was_disturbed(run, &axis->seen) && fabs(shown - place) > most)
        scenario_fail(run, "claim", "%s: %s is Done %.0f counts from its switch, and shows %.0f", axis->name,
                      block->type->name, place, shown);
}

static void judge_claim(run_t *run, instance_t *block, const machine_axis_t *axis)
{
    const bool layered = program_has(run->scenario, axis->number, layers);
    const bool ended = block_flag(block, "Done") && block->was_busy;
    if (block_flag(block, "Active") && block_flag(block, "InVelocity") && !layered && block_is(block, "MC_MoveVelocity"))
        judge_velocity(run, block, axis);
    if (block_flag(block, "Active") && !layered && block_member(block->type, "RatioNumerator") &&
        (block_flag(block, "InGear") || block_flag(block, "InSync")))
        judge_gear(run, block, axis);
    const bool by_edge = block->step->mode == mcRisingEdge || block->step->mode == mcFallingEdge; /* else it may be there already */
    if (ended && axis->spec->switched != 0 &&
        (block_is(block, "MC_StepLimitSwitch") || (block_is(block, "MC_StepAbsoluteSwitch") && by_edge)))
        judge_switch(run, block, axis);
    if (ended && block_is(block, "MC_MoveAbsolute") && !layered && !program_has(run->scenario, axis->number, origin_blocks))
        judge_arrival(run, block, axis);
}

/** Another block has begun a command of the axis by now, and the text is about that one. */
static bool is_told_of_another(const run_t *run, const instance_t *block)
{
    for (int i = 0; i < run->scenario->step_count; i++)
        if (&run->blocks[i] != block && run->blocks[i].step->axis == block->step->axis && run->cycle - run->blocks[i].edge_at <= 1)
            return block->edge_at != run->cycle;
    return false;
}

/** It reads, and leaves the text to the commands of the axis. */
static bool only_reads(const instance_t *block) { return strncmp(block->type->name, "MC_Read", 7) == 0; }

/** What refuses a command, says why. */
static void judge_refusal(run_t *run, instance_t *block, const machine_axis_t *axis, WORD id)
{
    char text[CM1E_AXIS_ERROR_TEXT_BYTES] = "";
    const bool error = block_flag(block, "Error");
    if (error && !only_reads(block) && !block->was_error && !block_member(block->type, "AxesGroup") && !is_told_of_another(run, block)) {
        cm1e_axis_error_text(axis->reference, text, sizeof text);
        if (!strstr(text, axis->name) || strstr(text, "nan"))
            scenario_fail(run, "text", "%s (%s): %s shows error 0x%04X, and the text is: %.300s", axis->name,
                          cm1e_axis_state_name(axis->info.state), block->type->name, id, text);
    }
    block->was_error = error;
}

void judge_block(run_t *run, instance_t *block)
{
    const machine_axis_t *axis = &run->axes[(int)block->step->axis];
    const block_member_t *member = block_member(block->type, "ErrorID");
    WORD id;
    memcpy(&id, block->memory + member->offset, sizeof id);
    if (block_flag(block, "Error") != (id != 0) || (id != 0 && cm1e_error_from_id(id) == CM1E_ERROR_NOT_FOUND))
        scenario_fail(run, "block", "%s: Error %d, ErrorID 0x%04X", block->type->name, block_flag(block, "Error"), id);
    judge_probe(run, block, axis, id);
    judge_refusal(run, block, axis, id);
    judge_claim(run, block, axis);
    judge_reading(run, block, axis);
    if (block_member(block->type, "Execute"))
        judge_outputs(run, block);
    block->active = block_flag(block, "Active") ? block->active + 1 : 0;
    if (axis->info.state == CM1E_AXIS_ERROR_STOP && block_member(block->type, "Active") &&
        !block_member(block->type, "AxesGroup") && block_flag(block, "Busy"))
        scenario_fail(run, "block", "%s is Busy although %s is in ErrorStop", block->type->name, axis->name);
}


/* ---- what blocks read -------------------------------------------------------------------------------------------- */

static void read_axis(run_t *run, machine_axis_t *axis)
{
    MC_ReadStatus_t *status = &axis->status;
    MC_ReadAxisError_t *failure = &axis->failure;
    MC_ReadMotionState_t *motion = &axis->motion;
    status->Axis = failure->Axis = motion->Axis = &axis->reference;
    status->Enable = failure->Enable = motion->Enable = TRUE;
    MC_ReadStatus(status);
    MC_ReadAxisError(failure);
    MC_ReadMotionState(motion);
    const int states = status->ErrorStop + status->Disabled + status->Stopping + status->Homing + status->Standstill +
                       status->DiscreteMotion + status->ContinuousMotion + status->SynchronizedMotion;
    if (!status->Valid || states != 1)
        scenario_fail(run, "read", "%s: MC_ReadStatus: Valid %d, %d states", axis->name, status->Valid, states);
    if (!failure->Valid || (failure->AxisErrorID != 0) != (status->ErrorStop != FALSE))
        scenario_fail(run, "read", "%s: MC_ReadAxisError: Valid %d, AxisErrorID 0x%04X, ErrorStop %d", axis->name,
                      failure->Valid, failure->AxisErrorID, status->ErrorStop);
    const int changes = motion->ConstantVelocity + motion->Accelerating + motion->Decelerating;
    if (motion->Valid && (changes != 1 || (motion->DirectionPositive && motion->DirectionNegative)))
        scenario_fail(run, "read", "%s: MC_ReadMotionState: constant %d, accelerating %d, decelerating %d, positive %d, "
                      "negative %d", axis->name, motion->ConstantVelocity, motion->Accelerating, motion->Decelerating,
                      motion->DirectionPositive, motion->DirectionNegative);
}

/** A path goes on only while a block has it, or behind a refused edge of one. */
static void read_group(run_t *run)
{
    enum { SOON = 3 };
    MC_GroupReadStatus_t *group = &run->group_status;
    bool has = false;
    group->AxesGroup = &run->group;
    group->Enable = TRUE;
    MC_GroupReadStatus(group);
    MC_GroupReadError_t *failure = &run->group_failure;
    failure->AxesGroup = &run->group;
    failure->Enable = TRUE;
    MC_GroupReadError(failure);
    if (!failure->Valid || (failure->GroupErrorID != 0) != (group->GroupErrorStop != FALSE))
        scenario_fail(run, "read", "MC_GroupReadError: Valid %d, GroupErrorID 0x%04X, GroupErrorStop %d", failure->Valid,
                      failure->GroupErrorID, group->GroupErrorStop);
    const int states = group->GroupMoving + group->GroupHoming + group->GroupErrorStop + group->GroupStandby +
                       group->GroupStopping + group->GroupDisabled;
    if (!group->Valid || states != 1)
        scenario_fail(run, "read", "MC_GroupReadStatus: Valid %d, %d states", group->Valid, states);
    for (int i = 0; i < run->scenario->step_count; i++) {
        const instance_t *block = &run->blocks[i];
        if (block->step->at <= run->cycle && block_member(block->type, "AxesGroup"))
            has = has || block->triggered || block_flag(block, "Busy") || block_flag(block, "Error") || block->step->again > 0;
    }
    run->group_alone = group->GroupMoving && !has ? run->group_alone + 1 : 0;
    if (run->group_alone > SOON)
        scenario_fail(run, "block", "the group is in GroupMoving, and no block has it");
}

/** Moves on top of another motion, or only a part of it. */
static bool has_axis(const instance_t *block)
{
    return block_member(block->type, "Active") && !block_member(block->type, "AxesGroup") &&
           strncmp(block->type->name, "MC_Phasing", 10) != 0 && !block_is(block, "MC_HaltSuperimposed");
}

/** One block at a time has an axis, and an axis is in a state of motion because a block has it. */
void judge_blocks(run_t *run)
{
    enum { SOON = 3 };
    const bool program = run->phase == PHASE_PROGRAM;
    for (int n = 0; n < run->scenario->axis_count; n++)
        read_axis(run, &run->axes[n]);
    if (run->grouped && program)
        read_group(run);
    for (int n = 0; program && n < run->scenario->axis_count; n++) {
        const machine_axis_t *axis = &run->axes[n];
        const instance_t *has = NULL;
        bool busy = false, refused = false;
        for (int i = 0; i < run->scenario->step_count; i++) {
            const instance_t *block = &run->blocks[i];
            if ((int)block->step->axis != n || block->step->at > run->cycle)
                continue;
            if (!only_reads(block))
                busy = busy || block_flag(block, "Busy") || block->triggered;
            refused = refused || block_flag(block, "Error") || (block->step->again > 0 && block->step->buffer > 0);
            if (!has_axis(block) || block->active < SOON)
                continue;
            if (has)
                scenario_fail(run, "block", "%s: %s and %s have it at the same time", axis->name, has->type->name,
                              block->type->name);
            has = block;
        }
        /* Where a direction or the power is taken away it brakes by itself, and so behind a
         * silence that ends its motion; a command that waits is no longer that of its block, which has had another edge;
         * a motion goes on where a new edge of its block,
         * or new inputs of it, are refused (docs/FUNCTION-BLOCKS.md). */
        const bool moves = axis->info.state == CM1E_AXIS_DISCRETE_MOTION || axis->info.state == CM1E_AXIS_SYNCHRONIZED_MOTION ||
                           axis->info.state == CM1E_AXIS_STOPPING;
        witness_t *seen = &run->axes[n].seen;
        const bool turns = moves || axis->info.state == CM1E_AXIS_CONTINUOUS_MOTION;
        seen->barred = turns && (seen->barred || !axis->power.Enable || !axis->power.EnablePositive ||
                                 !axis->power.EnableNegative || refused || was_disturbed(run, seen));
        seen->alone = moves && !busy && !seen->barred && !(run->grouped && n < 2) ? seen->alone + 1 : 0;
        if (axis->seen.alone > SOON)
            scenario_fail(run, "block", "%s is in %s, and no block has it", axis->name,
                          cm1e_axis_state_name(axis->info.state));
    }
}
