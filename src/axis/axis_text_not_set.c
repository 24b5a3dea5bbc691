/* Sentences about what was not set: parameters, positions, overrides, signals, cams. */
#include <stdio.h>

#include "axis/axis_device.h"
#include "axis/axis_parameters.h"
#include "axis/axis_text.h"

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
        snprintf(text, size, "Axis \"%s\": digital output %d was not written: %s.%s", name, refused->number,
                 cm1e_strerror(refused->error), cm1e_axis_signals_advice(axis, refused->error));
    } else if (refused->what == NOT_SET_PROBE) {
        snprintf(text, size, "Axis \"%s\": no touch probe at input %d: %s.%s", name, refused->number,
                 cm1e_strerror(refused->error), cm1e_axis_signals_advice(axis, refused->error));
    } else if (refused->what == NOT_SET_CAM) {
        axis->coupling_hooks->cam_text(axis, text, size);
    } else if (cm1e_axis_parameter_is_object(refused->number)) {
        cm1e_axis_object_text(axis, text, size);
    } else {
        cm1e_axis_parameter_text(axis, text, size);
    }
}
