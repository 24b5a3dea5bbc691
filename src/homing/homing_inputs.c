/* The inputs of a step of Part 5: what is wrong with them. */
#include <math.h>

#include "homing/homing_private.h"

static bool usable(double value) { return isfinite(value) && value >= 0.0; }

/* Remembers for the text which input is wrong. */
static cm1e_error_t wrong(const cm1e_axis_t *axis, cm1e_error_t error, const char *name, double value,
                          const char *right)
{
    axis->homing->wrong_input = (wrong_input_t){name, right, true, value};
    return error;
}

static bool direction_valid(const cm1e_homing_step_t *step)
{
    switch ((int)step->direction) {
    case 0:
    case mcPositiveDirection:
    case mcNegativeDirection: return true;
    case mcSwitchPositive:
    case mcSwitchNegative: return step->kind == CM1E_STEP_ABSOLUTE_SWITCH;
    default: return false;
    }
}

static bool mode_valid(const cm1e_homing_step_t *step)
{
    const int last = step->kind == CM1E_STEP_LIMIT_SWITCH ? mcFallingEdge : mcEdgeSwitchNegative;
    return !step_by_switch(step->kind) || ((int)step->mode >= mcOn && (int)step->mode <= last);
}

cm1e_error_t cm1e_homing_wrong_signal(const cm1e_axis_t *axis, const cm1e_homing_step_t *step)
{
    return wrong(axis, CM1E_ERROR_AXIS_STEP_INPUT, "ReferenceSignal.InputNumber", step->input,
                 "the number of an input that the motor has, or of one on another slave, is right, or 0 for the "
                 "configured home switch");
}

cm1e_error_t cm1e_homing_step_inputs(const cm1e_axis_t *axis, const cm1e_homing_step_t *step)
{
    static const char limit[] = "0 or more is right";
    const bool absolute = step->kind == CM1E_STEP_ABSOLUTE_SWITCH;
    const struct {
        const char *name;
        double value;
    } limits[] = {{"TorqueLimit", step->torque_limit},
                  {"DistanceLimit", step->distance_limit},
                  {"TimeLimit in ms", (double)step->time_limit_ns * 1e-6},
                  {"DetectionVelocityLimit", step->detection_velocity},
                  {"DetectionVelocityTime in ms", (double)step->detection_ns * 1e-6}};
    if (!direction_valid(step))
        return wrong(axis, CM1E_ERROR_AXIS_DIRECTION, "Direction", (int)step->direction,
                     absolute ? "1, 3, 5 or 7 is right, or 0, which acts as 1"
                              : "1 or 3 is right, or 0, which acts as 1");
    if (!mode_valid(step))
        return wrong(axis, CM1E_ERROR_AXIS_STEP_INPUT, absolute ? "SwitchMode" : "LimitSwitchMode", (int)step->mode,
                     absolute ? "0 ... 5 is right" : "0 ... 3 is right");
    if (step->of_another_axis) {
        axis->homing->wrong_input = (wrong_input_t){.name = "ReferenceSignal.Axis is another axis",
                                                    .right = "the Axis of the block is right, or none"};
        return CM1E_ERROR_AXIS_STEP_INPUT;
    }
    if (step->input < 0)
        return cm1e_homing_wrong_signal(axis, step);
    for (size_t i = 0; i < sizeof limits / sizeof limits[0]; i++)
        if (!usable(limits[i].value))
            return wrong(axis, CM1E_ERROR_AXIS_STEP_INPUT, limits[i].name, limits[i].value, limit);
    return CM1E_OK;
}
