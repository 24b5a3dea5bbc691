/* Sentences about the errors of an axis and about refused commands. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "axis/axis_text.h"
#include "axis/axis_commands.h"
#include "axis/axis_device.h"
#include "axis/axis_guard.h"
#include "axis/axis_in_position.h"
#include "axis/axis_outside.h"
#include "axis/axis_plan.h"
#include "axis/axis_position.h"
#include "axis/axis_setpoint.h"
#include "axis/axis_table.h"
#include "axis/axis_watch.h"

static bool coupling_text(const cm1e_axis_t *axis, cm1e_error_t error, bool refused, char *text, size_t size)
{
    return axis->coupling_hooks && axis->coupling_hooks->text(axis, error, refused, text, size);
}

/* Without a bound, the drive itself has reported the lag, in a motion by the drive. */
static void lag_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    if (axis->fault.bound == 0.0) {
        snprintf(text, size,
                 "Axis \"%s\": the drive reports a following error, with the motor %.6g u away from its target. Look "
                 "for a mechanical stop or a blocked axis, reduce load, velocity or acceleration; then reset the axis "
                 "with MC_Reset.", axis->config->name, fabs(axis->fault.value));
        return;
    }
    snprintf(text, size,
             "Axis \"%s\": %s: %.6g u, allowed are %.6g u. The motor did not follow the set-point: look for a blocked "
             "axis, reduce load, velocity or acceleration, or raise limits.position_lag; then reset the axis with "
             "MC_Reset.",
             axis->config->name, cm1e_strerror(axis->fault.error), axis->fault.value, axis->fault.bound);
}

static void not_at_rest_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    snprintf(text, size,
             "Axis \"%s\": the motor turned when it got its torque, and did not come to rest: %.6g u/s in the end. It "
             "was let go. Look for a load that drives it, or a servo that swings; then reset the axis with MC_Reset.",
             axis->config->name, axis->fault.value);
}

/* Adds where the counts of a motor behind a bridge end (BR appendix 5). */
static void add_counts_limit(const cm1e_axis_t *axis, char *text, size_t size)
{
    const size_t used = strlen(text);
    if (axis->limits.counts_limit && used < size)
        snprintf(text + used, size - used, " Behind the bridge the motor's own counts end at +-%d, by its K37 = %u: "
                 "that is %.6g ... %.6g u%s.", (int)axis->limits.counts_limit, axis->config->k37,
                 axis->limits.counts_lower, axis->limits.counts_upper,
                 axis->position.modulo_range > 0.0 ? " of this modulo axis, turns counted" : "");
}

static void range_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    snprintf(text, size,
             "Axis \"%s\": the motion was braked at %.6g u because it would have run over the limit at %.6g u. Reset "
             "the axis with MC_Reset and move away from the limit.",
             axis->config->name, axis->fault.value, axis->fault.bound);
    add_counts_limit(axis, text, size);
}

static void program_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    if (axis->fault.late) {
        snprintf(text, size,
                 "Axis \"%s\": every cycle of the last %.0f ms was late. Set-points hardly move then, and ramps do not "
                 "end, so it was stopped at once, without a ramp. Take a longer cycle time, or find out what takes so "
                 "long (statistics of the scheduler); then reset the axis with MC_Reset.",
                 axis->config->name, axis->fault.value);
        return;
    }
    if (!axis->fault.task) {
        snprintf(text, size,
                 "Axis \"%s\": no frame was sent for %.0f ms: the process was stopped or suspended, a task took so "
                 "long, or the machine gave it no processor. Its motor was without set-points. Find out why; then "
                 "reset the axis with MC_Reset.", axis->config->name, axis->fault.value);
        return;
    }
    snprintf(text, size,
             "Axis \"%s\": task \"%s\" did not return within %g ms, so it was ended, and all axes were stopped. Look "
             "for an endless loop, or for a call that waits, in its program; then start it again.",
             axis->config->name, axis->fault.task, axis->fault.value);
}

static void other_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    snprintf(text, size, "Axis \"%s\": %s. Remove the cause, then reset the axis with MC_Reset.", axis->config->name,
             cm1e_strerror(axis->fault.error));
}

const char *cm1e_axis_disabled_inputs(const cm1e_axis_t *axis)
{
    const bool positive = axis->power.enable_positive, negative = axis->power.enable_negative;
    return positive && negative ? ""
           : positive           ? ": its EnableNegative is FALSE"
           : negative           ? ": its EnablePositive is FALSE"
                                : ": its EnablePositive and EnableNegative are FALSE";
}

void cm1e_axis_not_finished_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    const not_set_t *ended = &axis->not_set;
    if (axis->homing_hooks && axis->homing_hooks->not_finished_text(axis, text, size))
        return;
    if (ended->error != CM1E_ERROR_AXIS_SYNC_WAY || !coupling_text(axis, ended->error, true, text, size))
        snprintf(text, size, "Axis \"%s\": %s, running or waiting, was ended: %s%s.", axis->config->name,
                 kind_row((unsigned)ended->number)->name, cm1e_strerror(ended->error),
                 ended->error == CM1E_ERROR_AXIS_DIRECTION_DISABLED ? cm1e_axis_disabled_inputs(axis) : "");
    if (ended->error == CM1E_ERROR_AXIS_POSITION_RANGE)
        add_counts_limit(axis, text, size);
}

static void refused_velocity_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    const cm1e_axis_command_t *refused = &axis->commands.refused;
    const double most = axis->limits.maximum.velocity;
    const char *name = axis->config->name;
    const bool fits = refused->velocity > 0.0 && refused->velocity <= most;
    const double one_count = 1.0 / fabs(axis->position.scale);
    if (drive_profiles(axis) && refused->velocity != 0.0 && fabs(refused->velocity) < 0.5 * one_count)
        snprintf(text, size, "Axis \"%s\": velocity %.6g was commanded, which its drive rounds to 0 counts/s; from "
                 "%.6g u/s on is right.", name, refused->velocity, 0.5 * one_count);
    else if (refused->kind == CM1E_COMMAND_MOVE_VELOCITY)
        snprintf(text, size, "Axis \"%s\": velocity %.6g was commanded; -%.6g ... %.6g u/s is right, but not 0.", name,
                 refused->velocity, most, most);
    else if (refused->kind == CM1E_COMMAND_MOVE_SUPERIMPOSED && fits)
        snprintf(text, size, "Axis \"%s\": velocity %.6g was commanded, in addition to the present motion and to those "
                 "that wait; the sum may be up to %.6g u/s.", name, refused->velocity, most);
    else if (refused->end_velocity != 0.0 && fits)
        snprintf(text, size, "Axis \"%s\": end velocity %.6g was commanded; -%.6g ... %.6g u/s is right.", name,
                 refused->end_velocity, most, most);
    else
        snprintf(text, size, "Axis \"%s\": velocity %.6g was commanded; above 0, up to %.6g u/s is right.", name,
                 refused->velocity, most);
}

static void refused_dynamics_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    snprintf(text, size,
             "Axis \"%s\": acceleration %.6g, deceleration %.6g, jerk %.6g were commanded; right is 0 (the maximum), "
             "or up to %.6g u/s2, %.6g u/s2 and %.6g u/s3.",
             axis->config->name, axis->commands.refused.acceleration, axis->commands.refused.deceleration,
             axis->commands.refused.jerk, axis->limits.maximum.acceleration, axis->limits.maximum.deceleration,
             axis->limits.maximum.jerk);
}

void cm1e_axis_small_text(const cm1e_axis_t *axis, const small_input_t *small, char *text, size_t size)
{
    char factor[64] = "", commanded[96];
    if (small->factor != 1.0)
        snprintf(factor, sizeof factor, " and the factor %.6g of MC_SetOverride", small->factor);
    if (small->is_maximum)
        snprintf(commanded, sizeof commanded, "%s 0 was commanded, which selects the maximum of %.6g %s,", small->name,
                 small->value, small->unit);
    else
        snprintf(commanded, sizeof commanded, "%s %.6g was commanded", small->name, small->value);
    snprintf(text, size, "Axis \"%s\": %s%s%s too small to compute with; %sfrom %.6g %s on is right.",
             axis->config->name, commanded, factor, factor[0] ? ": together they are" : ", which is",
             small->is_maximum || small->error == CM1E_ERROR_AXIS_VELOCITY_RANGE ? "" : "0 (the maximum), or ",
             small->least / small->factor, small->unit);
}

static bool refused_small_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    small_input_t small;
    const move_t move = cm1e_axis_move_of(&axis->commands.refused);
    if (!cm1e_axis_has_small(axis, &move, &small) || small.error != axis->commands.refusal)
        return false;
    cm1e_axis_small_text(axis, &small, text, size);
    return true;
}

/* Explains a refused superimposed motion: the position of the base, and its target if that is known. */
static void refused_on_top_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    const from_t base = from_base(axis);
    const double covered = axis->superimposed.id ? axis->superimposed.now.position : 0.0;
    const bool goes = axis_on_profile(axis) && !axis->setpoint.stands && axis->commands.active &&
                      !kind_row(axis->commands.kind)->is_endless;
    snprintf(text, size,
             "Axis \"%s\": the superimposed distance %.6g, added to a motion that is at %.6g and ends at %.6g%s, "
             "would leave the software limits %.6g ... %.6g u.",
             axis->config->name, axis->commands.refused.position, cm1e_axis_units(axis, base.position) + covered,
             cm1e_axis_units(axis, goes ? axis->setpoint.target : base.position) + covered,
             axis->commands.waiting.count > 0 ? ", and to those that wait" : "", axis->limits.lower,
             axis->limits.upper);
}

static void refused_position_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    const bool limited = axis->limits.negative_enabled || axis->limits.positive_enabled;
    const double position = cm1e_axis_units(axis, axis->setpoint.position);
    if (!isfinite(axis->commands.refused.position))
        snprintf(text, size, "Axis \"%s\": a position or distance of %.6g was commanded; a finite number is right.",
                 axis->config->name, axis->commands.refused.position);
    else if (axis->position.modulo_range > 0.0)
        snprintf(text, size, "Axis \"%s\": position or distance %.6g was commanded; positions of this modulo axis are "
                 "0 ... below %.6g u.", axis->config->name, axis->commands.refused.position,
                 axis->position.modulo_range);
    else if (axis->limits.software_limits && axis->commands.refused.kind == CM1E_COMMAND_MOVE_SUPERIMPOSED)
        refused_on_top_text(axis, text, size);
    else if (axis->limits.software_limits)
        snprintf(text, size,
                 "Axis \"%s\": a motion from %.6g with target, distance or stopping distance %.6g would leave the "
                 "%slimits %.6g ... %.6g u.",
                 axis->config->name, position, axis->commands.refused.position, limited ? "software " : "",
                 axis->limits.lower, axis->limits.upper);
    else
        snprintf(text, size, "Axis \"%s\": target or distance %.6g is not a finite number within +-%.6g u.",
                 axis->config->name, axis->commands.refused.position, cm1e_axis_farthest(axis));
    add_counts_limit(axis, text, size);
}

static void refused_virtual_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    if (axis->config->type == CM1E_AXIS_ENCODER)
        snprintf(text, size, "Axis \"%s\" is an encoder (type: encoder): it can be neither enabled nor moved. "
                 "Other axes can follow its actual value, and MC_SetPosition sets its position.", axis->config->name);
    else
        snprintf(text, size, "Axis \"%s\" is virtual (type: virtual): it has no motor, so it has no homing by a drive "
                 "or a switch, no digital signals, probes, torque, objects of a drive, and no CML. MC_HomeDirect and "
                 "MC_SetPosition set its position.", axis->config->name);
}

static void refused_by_drive_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    snprintf(text, size, "Axis \"%s\" moves by profiles of its drive (motion: drive). Its drive makes single moves "
             "from standstill with a Jerk of 0; if they go to a position, their Deceleration must be 0 or equal to "
             "their Acceleration. To follow a master, and for all other motions, it needs `motion: host` in the bus "
             "file.", axis->config->name);
}

static void refused_direction_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    const bool endless = kind_row(axis->commands.refused.kind)->plan == PLAN_VELOCITY;
    snprintf(text, size, "Axis \"%s\": Direction %d was commanded; %s is right.", axis->config->name,
             (int)axis->commands.refused.direction,
             endless ? "1, 3 or 4, or 0, which acts as 1," : "1 ... 4, or 0, which acts as 2,");
}

static void refused_disabled_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    snprintf(text, size, "Axis \"%s\", %s: %s%s. Every part of the way counts: a small Jerk, or a target that is too "
             "near, may turn the axis round first.", axis->config->name, cm1e_axis_state_name(axis->state),
             cm1e_strerror(CM1E_ERROR_AXIS_DIRECTION_DISABLED), cm1e_axis_disabled_inputs(axis));
}

/* Most of these blocks begin in Standstill; at standstill it is the end of a homing in steps that lacks a step. A
 * motion on top of another one begins in any state, but not on each kind of motion. In a homing only what should wait
 * is refused so. */
static void refused_state_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    const command_kind_t *block = kind_row(axis->commands.refused.kind);
    char why[160] = "it begins in Standstill. End the motion first, with MC_Halt";
    if (block->plan == PLAN_ON_TOP)
        snprintf(why, sizeof why, "it cannot be added to %s. End that first, with MC_Halt",
                 kind_row(axis->commands.kind)->name);
    else if (axis->state == CM1E_AXIS_STANDSTILL)
        snprintf(why, sizeof why, "it ends a homing, which begins with another step");
    else if (axis->state == CM1E_AXIS_HOMING)
        snprintf(why, sizeof why, "it cannot wait behind a motion that does not end by itself");
    snprintf(text, size, "Axis \"%s\", %s: %s was refused: %s.", axis->config->name, cm1e_axis_state_name(axis->state),
             block->name, why);
}

/* Which buffer modes are right depends on the command, and on what it would wait for. */
static void refused_buffer_mode_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    const cm1e_axis_command_t *refused = &axis->commands.refused;
    const command_plan_t plan = kind_row(refused->kind)->plan;
    const bool blends = plan != PLAN_HOMING_STEP && plan != PLAN_TABLE;
    const bool unknown = (unsigned)refused->buffer_mode > mcBlendingHigh;
    const char *right = drive_profiles(axis) ? "0 (mcAborting)" : !blends ? "0 (mcAborting) or 1 (mcBuffered)"
                        : unknown ? "0 ... 5" : "0 (mcAborting)";
    snprintf(text, size, "Axis \"%s\", %s: BufferMode %d was commanded; %s is right here.", axis->config->name,
             cm1e_axis_state_name(axis->state), (int)refused->buffer_mode, right);
}

/* The sentences for a refused command; the axis itself has no error. */
static const struct {
    cm1e_error_t error;
    void (*text)(const cm1e_axis_t *axis, char *text, size_t size);
} refusal_texts[] = {
    {CM1E_ERROR_AXIS_VELOCITY_RANGE, refused_velocity_text},
    {CM1E_ERROR_AXIS_DYNAMICS_RANGE, refused_dynamics_text},
    {CM1E_ERROR_AXIS_POSITION_RANGE, refused_position_text},
    {CM1E_ERROR_AXIS_SET_POINT_JUMP, cm1e_axis_outside_refused_text},
    {CM1E_ERROR_AXIS_VIRTUAL, refused_virtual_text},
    {CM1E_ERROR_AXIS_TABLE, cm1e_axis_table_refused_text},
    {CM1E_ERROR_AXIS_DIRECTION, refused_direction_text},
    {CM1E_ERROR_AXIS_DIRECTION_DISABLED, refused_disabled_text},
    {CM1E_ERROR_AXIS_STATE, refused_state_text},
    {CM1E_ERROR_AXIS_BUFFER_MODE, refused_buffer_mode_text},
};

static void refused_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    if (coupling_text(axis, axis->commands.refusal, true, text, size))
        return;
    if (kind_row(axis->commands.refused.kind)->plan != PLAN_TABLE && refused_small_text(axis, text, size))
        return;
    if (axis->homing_hooks && axis->homing_hooks->refused_text(axis, text, size))
        return;
    for (size_t i = 0; i < sizeof refusal_texts / sizeof refusal_texts[0]; i++)
        if (refusal_texts[i].error == axis->commands.refusal) {
            refusal_texts[i].text(axis, text, size);
            return;
        }
    if (axis->motor_hooks && axis->motor_hooks->text(axis, axis->commands.refusal, text, size))
        return;
    if (axis->commands.refusal == CM1E_ERROR_UNSUPPORTED && drive_profiles(axis)) {
        refused_by_drive_text(axis, text, size);
        return;
    }
    snprintf(text, size, "Axis \"%s\", %s: %s.%s", axis->config->name, cm1e_axis_state_name(axis->state),
             cm1e_strerror(axis->commands.refusal),
             axis->commands.refusal == CM1E_ERROR_PDO_MAPPING ? cm1e_axis_signals_advice(axis, axis->commands.refusal)
                                                              : "");
}

static const struct {
    cm1e_error_t error;
    void (*text)(const cm1e_axis_t *axis, char *text, size_t size);
} texts[] = {
    {CM1E_ERROR_AXIS_LAG, lag_text},
    {CM1E_ERROR_AXIS_NOT_AT_REST, not_at_rest_text},
    {CM1E_ERROR_PROGRAM, program_text},
    {CM1E_ERROR_AXIS_NOT_IN_POSITION, cm1e_axis_in_position_text},
    {CM1E_ERROR_AXIS_POSITION_RANGE, range_text},
    {CM1E_ERROR_AXIS_COUPLING_LIMIT, cm1e_axis_guard_text},
    {CM1E_ERROR_AXIS_SET_POINT_LIMIT, cm1e_axis_guard_text},
    {CM1E_ERROR_AXIS_SET_POINT_MISSING, cm1e_axis_outside_missing_text},
};

/* What was refused or not finished, and what is still so: that a slave does not get in step. */
static void no_fault_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    if (axis->commands.refusal)
        refused_text(axis, text, size);
    else if (axis->not_set.error)
        cm1e_axis_not_set_text(axis, text, size);
    const size_t used = strlen(text), begin = used > 0 ? used + 1 : 0;
    if (begin < size && coupling_text(axis, CM1E_OK, false, text + begin, size - begin) && used > 0)
        text[used] = ' ';
}

void cm1e_axis_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    text[0] = '\0';
    if (axis->fault.error == CM1E_OK) {
        no_fault_text(axis, text, size);
        return;
    }
    if (axis->fault.error == axis->drive.fault.error) {
        cm1e_drive_fault_text(&axis->drive, text, size);
        if (axis->fault.error == CM1E_ERROR_DRIVE_FAULT)
            cm1e_axis_in_position_add(axis, text, size);
        return;
    }
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++)
        if (texts[i].error == axis->fault.error) {
            texts[i].text(axis, text, size);
            return;
        }
    if (axis->homing_hooks && axis->homing_hooks->failed_text(axis, text, size))
        return;
    if (!coupling_text(axis, axis->fault.error, false, text, size))
        other_text(axis, text, size);
}

void cm1e_axis_error_text(AXIS_REF_t reference, char *text, size_t size)
{
    if (!text || size == 0)
        return;
    text[0] = '\0';
    const cm1e_axis_t *axis = cm1e_axis_from_reference(&reference);
    if (axis)
        cm1e_axis_text(axis, text, size);
}
