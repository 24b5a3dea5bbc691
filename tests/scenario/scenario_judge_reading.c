/* What blocks read is what the axes show in the same cycle, what the configuration has, and what is at a terminal. */
#include <math.h>
#include <string.h>

#include "scenario_private.h"

/** An input of a terminal shows what is at it, after the two cycles of a frame. */
static void judge_input(run_t *run, const instance_t *block, const machine_axis_t *axis)
{
    enum { WIRED_FIRST = 11, SOON = 3 };
    /* An input that nothing drives is wired to the output of the same number. */
    static const char *const writers[] = {"MC_WriteDigitalOutput", NULL};
    const int number = (int)block->step->mode - WIRED_FIRST + 1;
    const bool wired = axis->spec->wired != 0 && number >= 1 && block_is(block, "MC_ReadDigitalInput") &&
                       !program_has(run->scenario, axis->number, writers);
    if (wired && run->phase == PHASE_PROGRAM && block_flag(block, "Valid") && !was_disturbed(run, &axis->seen) &&
        !fault_turns_input(run, SOON) && block_flag(block, "Value") != fault_drives_input(run, number))
        scenario_fail(run, "read", "%s: MC_ReadDigitalInput shows %d at input %d of its terminal", axis->name,
                      block_flag(block, "Value"), number);
}

/** Those of the axis itself, and limits that nothing changes. */
static void judge_parameter(run_t *run, const instance_t *block, const machine_axis_t *axis)
{
    const cm1e_axis_info_t *info = &axis->info;
    const axis_spec_t *spec = axis->spec;
    const double unit = spec->counts_per_unit;
    const bool moved = program_has(run->scenario, axis->number, origin_blocks);
    const bool written = program_has(run->scenario, axis->number, limit_blocks);
    const bool limited = spec->limit_positive != 0 || spec->limit_negative != 0;
    const struct { int number; double value; bool is_known; } values[] = {
        {1, info->set_position, !moved},          {10, info->actual_velocity, true},
        {11, info->set_velocity, true},           {2, spec->limit_positive / unit, limited && !written},
        {3, spec->limit_negative / unit, limited && !written},
        {9, spec->velocity / unit, !written},     {13, spec->acceleration / unit, !written},
        {15, spec->deceleration / unit, !written}, {17, spec->jerk / unit, !written}};
    if (!block_is(block, "MC_ReadParameter") || !block_flag(block, "Valid"))
        return;
    for (size_t i = 0; i < sizeof values / sizeof values[0]; i++)
        if (values[i].number == (int)block->step->parameter && values[i].is_known &&
            !close_to(block_number(block, "Value"), values[i].value, fabs(values[i].value) + spec->velocity / unit))
            scenario_fail(run, "read", "%s: MC_ReadParameter shows %.9g for number %d, not %.9g", axis->name,
                          block_number(block, "Value"), values[i].number, values[i].value);
}

static double element(const instance_t *block, const char *name, int place)
{
    double value;
    memcpy(&value, block->memory + block_member(block->type, name)->offset + (size_t)place * sizeof value, sizeof value);
    return value;
}

/** Position or velocity of one axis of the group. */
static void judge_member(run_t *run, const instance_t *block, const machine_axis_t *axis)
{
    const cm1e_axis_info_t *info = &axis->info;
    const bool position = block_is(block, "MC_GroupReadPosition"), set = block->step->source == mcSetValue;
    const double value = position ? (set ? info->set_position : info->actual_position)
                                  : (set ? info->set_velocity : info->actual_velocity);
    const double shown = element(block, position ? "Position" : "Velocity", axis->number);
    if (!(position && program_has(run->scenario, axis->number, origin_blocks)) &&
        !close_to(shown, value, fabs(value) + axis->spec->velocity / axis->spec->counts_per_unit))
        scenario_fail(run, "read", "%s: %s shows %.9g, the axis %.9g", axis->name, block->type->name, shown, value);
}

static void judge_group_reading(run_t *run, const instance_t *block)
{
    enum { MEMBERS = 2, GROUPED_AT = 200 };
    if (!block_flag(block, "Valid") || run->phase != PHASE_PROGRAM || run->cycle < GROUPED_AT)
        return;
    if (block_is(block, "MC_GroupReadPosition") || block_is(block, "MC_GroupReadVelocity"))
        for (int n = 0; n < MEMBERS; n++)
            if (run->axes[n].add.Done)
                judge_member(run, block, &run->axes[n]);
    if (!block_is(block, "MC_GroupReadConfiguration"))
        return;
    const int place = (int)block->step->mode - 1;
    AXIS_REF_t axis;
    memcpy(&axis, block->memory + block_member(block->type, "Axis")->offset, sizeof axis);
    if (place < 0 || place >= MEMBERS || axis.Handle != run->axes[place].reference.Handle)
        scenario_fail(run, "read", "MC_GroupReadConfiguration shows axis %u at place %d", (unsigned)axis.Handle, place + 1);
}

/** What a block reads is what the axis shows in the same cycle. */
/** Another block of this cycle may have homed it. */
static bool is_homed_now(const machine_axis_t *axis)
{
    cm1e_axis_info_t now = {0};
    cm1e_axis_read(axis->reference, &now);
    return now.homed;
}

void judge_reading(run_t *run, const instance_t *block, const machine_axis_t *axis)
{
    const cm1e_axis_info_t *info = &axis->info;
    const double largest = axis->spec->velocity / axis->spec->counts_per_unit;
    const bool moved = program_has(run->scenario, axis->number, origin_blocks);
    const struct { const char *block, *output; double value; bool is_known; } values[] = {
        {"MC_ReadActualPosition", "Position", info->actual_position, !moved},
        {"MC_ReadActualVelocity", "Velocity", info->actual_velocity, true},
        {"MC_ReadActualTorque", "Torque", info->actual_torque, true}};
    for (size_t i = 0; i < sizeof values / sizeof values[0]; i++)
        if (block_is(block, values[i].block) && block_flag(block, "Valid") && values[i].is_known &&
            !close_to(block_number(block, values[i].output), values[i].value, largest))
            scenario_fail(run, "read", "%s: %s shows %.9g, the axis %.9g", axis->name, block->type->name,
                          block_number(block, values[i].output), values[i].value);
    if (block_is(block, "MC_ReadAxisInfo") && block_flag(block, "Valid") &&
        (block_flag(block, "CommunicationReady") != info->online ||
         (block_flag(block, "IsHomed") != info->homed && block_flag(block, "IsHomed") != is_homed_now(axis))))
        scenario_fail(run, "read", "%s: MC_ReadAxisInfo: CommunicationReady %d, IsHomed %d; the axis %d, %d", axis->name,
                      block_flag(block, "CommunicationReady"), block_flag(block, "IsHomed"), info->online, info->homed);
    judge_parameter(run, block, axis);
    judge_group_reading(run, block);
    judge_input(run, block, axis);
    if (block_flag(block, "Valid") && block_flag(block, "Error"))
        scenario_fail(run, "block", "%s: %s is Valid, and shows Error", axis->name, block->type->name);
}
