/* Sentences about what was not set: parameters, positions, overrides, signals, cams. */
#include <math.h>
#include <stdio.h>

#include "axis/axis_device.h"
#include "axis/axis_parameters.h"
#include "axis/axis_position.h"
#include "axis/axis_signals.h"
#include "axis/axis_text.h"

const char *cm1e_axis_wired_name(const cm1e_axis_t *axis, int number, bool output)
{
    const cm1e_wiring_config_t *wiring = &axis->config->wiring;
    const int n = number - CM1E_WIRED_FIRST, count = output ? wiring->output_count : wiring->input_count;
    return n < 0 || n >= count ? "" : output ? wiring->outputs[n] : wiring->inputs[n];
}

/* The numbers of the signals that the axis has: " Right is 1 ... 6, 11 ... 12 (on other slaves)." */
static void numbers_text(const cm1e_axis_t *axis, bool output, char *text, size_t size)
{
    enum { BITS = 16 };
    const cm1e_wiring_config_t *wiring = &axis->config->wiring;
    const cm1e_drive_t *drive = &axis->drive;
    const int wired = output ? wiring->output_count : wiring->input_count;
    const unsigned all = cm1e_drive_is_virtual(drive) ? 0
                         : output ? drive->kind->signals.outputs : drive->kind->signals.inputs;
    size_t used = 0;
    text[0] = '\0';
    for (int first = 0, last; first < BITS; first = last + 1) {
        for (last = first; last < BITS && all >> last & 1; last++) {}
        if (last > first && used < size)
            used += (size_t)snprintf(text + used, size - used, last > first + 1 ? "%s%d ... %d" : "%s%d",
                                     used ? ", " : " Right is ", first + 1, last);
    }
    if (wired > 0 && used < size)
        used += (size_t)snprintf(text + used, size - used,
                                 wired > 1 ? "%s%d ... %d (on other slaves)" : "%s%d (on another slave)",
                                 used ? ", " : " Right is ", CM1E_WIRED_FIRST, CM1E_WIRED_FIRST + wired - 1);
    if (used < size)
        snprintf(text + used, size - used, used ? "." : " This axis has none.");
}

/* Names a signal by its number, and one of another slave also by its name. */
static void signal_text(const cm1e_axis_t *axis, const char *before, const char *behind, char *text, size_t size)
{
    const not_set_t *refused = &axis->not_set;
    const bool output = refused->what == NOT_SET_OUTPUT || refused->what == NOT_READ_OUTPUT;
    const char *wired = cm1e_axis_wired_name(axis, refused->number, output);
    const char *advice = cm1e_axis_signals_advice(axis, refused->error);
    char numbers[96] = "";
    if (refused->error == CM1E_ERROR_AXIS_SIGNAL && !advice[0])
        numbers_text(axis, output, numbers, sizeof numbers);
    snprintf(text, size, "Axis \"%s\": %s %d%s%s%s%s: %s.%s%s", axis->config->name, before, refused->number,
             wired[0] ? " (" : "", wired, wired[0] ? ")" : "", behind, cm1e_strerror(refused->error), advice, numbers);
}

static void override_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    const override_t *asked = &axis->override_refused;
    snprintf(text, size,
             "Axis \"%s\": MC_SetOverride to VelFactor %.6g, AccFactor %.6g, JerkFactor %.6g: %s; VelFactor 0 ... 1, "
             "AccFactor and JerkFactor above 0, up to 1 are right.", axis->config->name, asked->velocity,
             asked->acceleration, asked->jerk, cm1e_strerror(axis->not_set.error));
}

void cm1e_axis_refuse_cam_switch(cm1e_axis_t *axis, cm1e_cam_switch_input_t input, int number, double value)
{
    cm1e_axis_remember_not_set(axis, (not_set_t){.error = CM1E_ERROR_FB_CAM_SWITCH, .what = NOT_SET_CAM_SWITCH,
                                                 .number = number, .value = value, .input = input});
}

void cm1e_axis_cam_switches_right(cm1e_axis_t *axis)
{
    cm1e_axis_remember_not_set(axis, (not_set_t){.error = CM1E_OK, .what = NOT_SET_CAM_SWITCH});
}

static void cam_switch_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    static const struct {
        const char *name, *right;
        double scale;
    } inputs[] = {
        [CM1E_CAM_SWITCH_COUNT] = {"NumberOfSwitches", "1 ... 32 is right", 1.0},
        [CM1E_CAM_SWITCH_TRACK] = {"TrackNumber", "1 ... 32 is right", 1.0},
        [CM1E_CAM_SWITCH_FIRST_ON] = {"FirstOnPosition", "a number is right, on a linear axis not above "
                                      "LastOnPosition", 1.0},
        [CM1E_CAM_SWITCH_LAST_ON] = {"LastOnPosition", "a number is right, on a modulo axis less than a turn after "
                                     "FirstOnPosition", 1.0},
        [CM1E_CAM_SWITCH_DIRECTION] = {"AxisDirection", "0, 1 or 2 is right", 1.0},
        [CM1E_CAM_SWITCH_MODE] = {"CamSwitchMode", "0 or 1 is right", 1.0},
        [CM1E_CAM_SWITCH_DURATION] = {"Duration in ms", "0 or more is right", 1e-6},
        [CM1E_CAM_SWITCH_ON_COMPENSATION] = {"OnCompensation of its track in ms",
                                             "up to an hour is right, or minus an hour", 1e-6},
        [CM1E_CAM_SWITCH_OFF_COMPENSATION] = {"OffCompensation of its track in ms",
                                              "up to an hour is right, or minus an hour", 1e-6},
        [CM1E_CAM_SWITCH_HYSTERESIS] = {"Hysteresis of its track", "0 or more is right", 1.0},
    };
    const not_set_t *refused = &axis->not_set;
    char which[24] = "";
    if (refused->input != CM1E_CAM_SWITCH_COUNT)
        snprintf(which, sizeof which, "switch %d: ", refused->number);
    snprintf(text, size, "Axis \"%s\": MC_DigitalCamSwitch: %s%s is %.9g; %s.", axis->config->name, which,
             inputs[refused->input].name, refused->value * inputs[refused->input].scale,
             inputs[refused->input].right);
}

/** MC_SetPosition: which positions are right. */
static void position_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    const not_set_t *refused = &axis->not_set;
    const limits_t *limits = &axis->limits;
    const char *name = axis->config->name, *how = refused->number ? "Relative by" : "to";
    if (refused->error != CM1E_ERROR_AXIS_POSITION_RANGE)
        snprintf(text, size, "Axis \"%s\": MC_SetPosition %s %.6g u: %s.", name, how, refused->value,
                 cm1e_strerror(refused->error));
    else if (!isfinite(refused->value))
        snprintf(text, size, "Axis \"%s\": MC_SetPosition %s %.6g u: a finite number is right.", name, how,
                 refused->value);
    else if (axis->position.modulo_range > 0.0)
        snprintf(text, size,
                 "Axis \"%s\": MC_SetPosition %s %.6g u: positions of this modulo axis are 0 ... below %.6g u.",
                 name, how, refused->value, axis->position.modulo_range);
    else if (limits->negative_enabled || limits->positive_enabled)
        snprintf(text, size, "Axis \"%s\": MC_SetPosition %s %.6g u would bring the axis, its running motion or one "
                 "that waits outside the software limits %.6g ... %.6g u.", name, how, refused->value,
                 limits->negative_enabled ? limits->negative : -INFINITY,
                 limits->positive_enabled ? limits->positive : INFINITY);
    else
        snprintf(text, size, "Axis \"%s\": MC_SetPosition %s %.6g u: positions are within +-%.6g u.", name, how,
                 refused->value, cm1e_axis_farthest(axis));
}

cm1e_error_t cm1e_axis_refuse_input(cm1e_axis_t *axis, cm1e_error_t error, const char *input, double value,
                                    const char *right)
{
    cm1e_axis_remember_not_set(axis, (not_set_t){.error = error, .what = NOT_SET_INPUT, .name = input, .value = value,
                                                 .right = right});
    return error;
}

cm1e_error_t cm1e_axis_refuse_level(cm1e_axis_t *axis, cm1e_error_t error, const char *input, int value,
                                    const char *right, bool begins)
{
    const not_set_t *last = &axis->not_set;
    const bool another = last->error != CM1E_OK && last->what == NOT_SET_INPUT && last->name == input &&
                         last->value != value;
    cm1e_axis_remember_repeated(axis, (not_set_t){.error = error, .what = NOT_SET_INPUT, .name = input, .value = value,
                                                  .right = right}, begins || another);
    return error;
}

void cm1e_axis_refuse_signal(cm1e_axis_t *axis, cm1e_error_t error, bool output, int number, bool begins)
{
    const not_set_what_t what = output ? NOT_READ_OUTPUT : NOT_READ_INPUT;
    const not_set_t *last = &axis->not_set;
    const bool another = last->error != CM1E_OK && last->what == what && last->number != number;
    cm1e_axis_remember_repeated(axis, (not_set_t){.error = error, .what = what, .number = number}, begins || another);
}

void cm1e_axis_not_set_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    const not_set_t *refused = &axis->not_set;
    const char *name = axis->config->name;
    if (refused->what == NOT_FINISHED) {
        cm1e_axis_not_finished_text(axis, text, size);
    } else if (refused->what == NOT_SET_OVERRIDE) {
        override_text(axis, text, size);
    } else if (refused->what == NOT_SET_POSITION) {
        position_text(axis, text, size);
    } else if (refused->what == NOT_SET_OUTPUT) {
        signal_text(axis, "digital output", " was not written", text, size);
    } else if (refused->what == NOT_READ_INPUT || refused->what == NOT_READ_OUTPUT) {
        signal_text(axis, refused->what == NOT_READ_OUTPUT ? "digital output" : "digital input", " was not read", text,
                    size);
    } else if (refused->what == NOT_SET_PROBE && refused->error == CM1E_ERROR_AXIS_POSITION_RANGE) {
        snprintf(text, size, "Axis \"%s\": the window of the touch probe at input %d is not valid: FirstPosition and "
                 "LastPosition have to be inside the range of the axis, and on a linear axis FirstPosition must not be "
                 "above LastPosition.", name, refused->number);
    } else if (refused->what == NOT_SET_PROBE) {
        signal_text(axis, "no touch probe at input", "", text, size);
    } else if (refused->what == NOT_SET_CAM) {
        axis->coupling_hooks->cam_text(axis, text, size);
    } else if (refused->what == NOT_SET_INPUT) {
        snprintf(text, size, "Axis \"%s\": %s is %.9g; %s is right.", name, refused->name, refused->value,
                 refused->right);
    } else if (refused->what == NOT_SET_CAM_SWITCH) {
        cam_switch_text(axis, text, size);
    } else if (cm1e_axis_parameter_is_object(refused->number)) {
        cm1e_axis_object_text(axis, text, size);
    } else {
        cm1e_axis_parameter_text(axis, text, size);
    }
}
