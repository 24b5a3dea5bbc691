/* Sentences about what was not set: parameters, positions, overrides, signals, cams. */
#include <stdio.h>

#include "axis/axis_device.h"
#include "axis/axis_parameters.h"
#include "axis/axis_text.h"

const char *cm1e_axis_wired_name(const cm1e_axis_t *axis, int number, bool output)
{
    const cm1e_wiring_config_t *wiring = &axis->config->wiring;
    const int n = number - CM1E_WIRED_FIRST, count = output ? wiring->output_count : wiring->input_count;
    return n < 0 || n >= count ? "" : output ? wiring->outputs[n] : wiring->inputs[n];
}

/* Names a signal by its number, and one of another slave also by its name. */
static void signal_text(const cm1e_axis_t *axis, const char *before, const char *behind, char *text, size_t size)
{
    const not_set_t *refused = &axis->not_set;
    const char *wired = cm1e_axis_wired_name(axis, refused->number, refused->what == NOT_SET_OUTPUT);
    snprintf(text, size, "Axis \"%s\": %s %d%s%s%s%s: %s.%s", axis->config->name, before, refused->number,
             wired[0] ? " (" : "", wired, wired[0] ? ")" : "", behind, cm1e_strerror(refused->error),
             cm1e_axis_signals_advice(axis, refused->error));
}

static void override_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    const override_t *asked = &axis->override_refused;
    snprintf(text, size,
             "Axis \"%s\": MC_SetOverride to VelFactor %.6g, AccFactor %.6g, JerkFactor %.6g: %s; VelFactor 0 ... 1, "
             "AccFactor and JerkFactor above 0, up to 1 are right.", axis->config->name, asked->velocity,
             asked->acceleration, asked->jerk, cm1e_strerror(axis->not_set.error));
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
        snprintf(text, size, "Axis \"%s\": MC_SetPosition to %.6g u: %s.", name, refused->value,
                 cm1e_strerror(refused->error));
    } else if (refused->what == NOT_SET_OUTPUT) {
        signal_text(axis, "digital output", " was not written", text, size);
    } else if (refused->what == NOT_SET_PROBE && refused->error == CM1E_ERROR_AXIS_POSITION_RANGE) {
        snprintf(text, size, "Axis \"%s\": the window of the touch probe at input %d is none: FirstPosition and LastPosition "
                 "are inside the range of the axis, and on a linear axis FirstPosition is not above LastPosition.", name,
                 refused->number);
    } else if (refused->what == NOT_SET_PROBE) {
        signal_text(axis, "no touch probe at input", "", text, size);
    } else if (refused->what == NOT_SET_CAM) {
        axis->coupling_hooks->cam_text(axis, text, size);
    } else if (cm1e_axis_parameter_is_object(refused->number)) {
        cm1e_axis_object_text(axis, text, size);
    } else {
        cm1e_axis_parameter_text(axis, text, size);
    }
}
