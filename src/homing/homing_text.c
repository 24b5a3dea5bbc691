/* Sentences about homings: why one was refused, and why one failed. */
#include <stdio.h>
#include <string.h>

#include "axis/axis_signals.h"
#include "axis/axis_text.h"
#include "cm1e/error.h"
#include "homing/homing_private.h"

bool cm1e_homing_failed_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    if (axis->fault.error != CM1E_ERROR_AXIS_HOMING_FAILED && axis->fault.error != CM1E_ERROR_AXIS_HOMING_TIMEOUT)
        return false;
    const unsigned bits = (unsigned)axis->fault.value;
    const drive_homing_t *home = &axis->homing->drive;
    if (home->unstoppable) {
        snprintf(text, size, "Axis \"%s\": the homing was stopped, but the motor did not come to rest, so its torque "
                 "was taken away. Reset the axis with MC_Reset, and home it again.", axis->config->name);
        return true;
    }
    if (axis->fault.error == CM1E_ERROR_AXIS_HOMING_FAILED && home->unsettled) {
        snprintf(text, size, "Axis \"%s\": the drive reported that its homing was completed, although its motor still "
                 "turned, for a second and longer. Look for a load that moves the motor, a servo that swings, and the "
                 "end of the homing in the drive; then reset the axis with MC_Reset, and home it again.",
                 axis->config->name);
        return true;
    }
    snprintf(text, size,
             "Axis \"%s\": %s. Method %d, with %.6g u/s for up to %.6g s; statusword bits 13 (error), 12 (attained), "
             "10 (reached) were %u %u %u; homing began with %u %u %u. Check that the %s is reached in this direction, "
             "speed (homing.velocity), torque limit and timeout; then reset the axis with MC_Reset.",
             axis->config->name, cm1e_strerror(axis->fault.error), (int)home->raw[CM1E_HOMING_METHOD],
             cm1e_homing_velocity(axis), (double)home->timeout_ns * 1e-9, bits >> 2 & 1u, bits >> 1 & 1u,
             bits & 1u, home->bits_before >> 2 & 1u, home->bits_before >> 1 & 1u, home->bits_before & 1u,
             cm1e_homing_by_switch(axis, home->raw[CM1E_HOMING_METHOD]) ? "sensor" : "hard stop");
    return true;
}

static void refused_homing_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    const cm1e_sdo_t *sdo = &axis->homing->drive.sdo;
    const int value = (int)axis->homing->drive.raw[axis->homing->drive.next];
    char reason[160];
    if (axis->homing->drive.late)
        snprintf(reason, sizeof reason, "the time of the homing was over (homing.timeout_s, %.6g s)",
                 (double)axis->homing->drive.timeout_ns * 1e-9);
    else
        snprintf(reason, sizeof reason, "%s", cm1e_strerror(axis->homing->drive.refused));
    if (axis->homing->drive.refused == CM1E_ERROR_AXIS_HOMING_PARAMETER)
        cm1e_homing_wrong_text(axis, text, size);
    else if (axis->homing->drive.refused == CM1E_ERROR_AXIS_NOT_AT_REST)
        snprintf(text, size, "Axis \"%s\": homing was not started: %s. Behind a bridge the mode is switched at rest: "
                 "look for a load that moves the motor, or a servo that swings.", axis->config->name,
                 cm1e_strerror(axis->homing->drive.refused));
    else if (!sdo->write)
        snprintf(text, size, "Axis \"%s\": homing was not started: object 0x%04X:%02X, which tells the unit of the "
                 "offset, could not be read: %s.", axis->config->name, sdo->index, sdo->subindex, reason);
    else if (axis->homing->drive.refused == CM1E_ERROR_SDO_ABORT)
        snprintf(text, size,
                 "Axis \"%s\": homing was not started: the drive refused %d for object 0x%04X:%02X with SDO abort code "
                 "0x%08X (%s).",
                 axis->config->name, value, sdo->index, sdo->subindex, (unsigned)sdo->abort_code,
                 cm1e_sdo_abort_text(sdo->abort_code));
    else
        snprintf(text, size, "Axis \"%s\": homing was not started: object 0x%04X:%02X could not be written: %s.",
                 axis->config->name, sdo->index, sdo->subindex, reason);
}

/* Which switches the step needs that are on other slaves. */
static void away_text(const cm1e_axis_t *axis, int input, char *text, size_t size)
{
    const cm1e_input_config_t *inputs = &axis->config->inputs;
    const int numbers[] = {input ? input : inputs->home, inputs->limit_positive, inputs->limit_negative};
    char names[3 * CM1E_SIGNAL_LENGTH + 8] = "";
    for (int i = 0; i < 3; i++) {
        const char *name = cm1e_axis_wired_name(axis, numbers[i], false);
        const size_t used = strlen(names);
        if (name[0] && used < sizeof names)
            snprintf(names + used, sizeof names - used, "%s%s", used ? ", " : "", name);
    }
    snprintf(text, size, "Axis \"%s\": the homing step did not begin, or was stopped, because the slave of a switch "
             "does not take part in the bus cycle. Its switches are %s. Look at power and cable of these slaves; then "
             "begin the homing anew.", axis->config->name, names);
}

bool cm1e_homing_not_finished_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    const not_set_t *ended = &axis->not_set;
    if (ended->number == CM1E_COMMAND_HOMING_STEP && ended->error == CM1E_ERROR_AXIS_SIGNAL_AWAY) {
        away_text(axis, axis->homing->stepping.step.input, text, size);
        return true;
    }
    if (ended->number != CM1E_COMMAND_HOME || ended->error != axis->homing->drive.refused)
        return false;
    refused_homing_text(axis, text, size);
    return true;
}

/* An input of a step of Part 5. */
static bool wrong_input_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    const wrong_input_t *wrong = &axis->homing->wrong_input;
    const bool direction = axis->commands.refusal == CM1E_ERROR_AXIS_DIRECTION;
    if (axis->commands.refused.kind != CM1E_COMMAND_HOMING_STEP ||
        !(direction || axis->commands.refusal == CM1E_ERROR_AXIS_STEP_INPUT))
        return false;
    const char *const name = axis->config->name;
    if (wrong->valued)
        snprintf(text, size, "Axis \"%s\": the homing step was not started: %s is %.9g; %s.", name, wrong->name,
                 wrong->value, wrong->right);
    else
        snprintf(text, size, "Axis \"%s\": the homing step was not started: %s; %s.", name, wrong->name, wrong->right);
    return true;
}

bool cm1e_homing_refused_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    if (wrong_input_text(axis, text, size))
        return true;
    if (axis->commands.refusal == CM1E_ERROR_AXIS_SIGNAL_AWAY) {
        away_text(axis, 0, text, size);
        return true;
    }
    if (axis->commands.refusal != CM1E_ERROR_AXIS_HOMING_METHOD &&
        axis->commands.refusal != CM1E_ERROR_AXIS_HOMING_PARAMETER) return false;
    cm1e_homing_wrong_text(axis, text, size);
    return true;
}
