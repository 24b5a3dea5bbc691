/* Adds homings to an axis when it is made: a table of functions that the axis calls (axis_hooks.h). */
#include <stdlib.h>

#include "homing/homing.h"
#include "homing/homing_private.h"

static void forget(cm1e_axis_t *axis) { free(axis->homing); }

static bool is_away(const cm1e_axis_t *axis) { return axis->homing->drive.away; }

static const command_method_t methods[PLAN_COUNT] = {
    [PLAN_HOMING] = {cm1e_homing_start, cm1e_homing_buffer, NULL, cm1e_homing_begin, NULL},
    [PLAN_HOMING_STEP] = {cm1e_homing_step_start, cm1e_homing_step_buffer, NULL, cm1e_homing_step_begin, NULL},
};

_Static_assert(sizeof(homing_t) % 8 == 0, "what comes behind it in a copy is aligned");

static void copy_own(const cm1e_axis_t *axis, cm1e_axis_t *copy, void *place)
{
    copy->homing = place;
    *copy->homing = *axis->homing;
}

static const homing_hooks_t hooks = {
    .methods = methods,
    .own = {sizeof(homing_t), copy_own},
    .free = forget,
    .is_away = is_away,
    .step_cycle = cm1e_homing_step_cycle,
    .step_ended = cm1e_homing_step_ended,
    .step_anew = cm1e_homing_step_anew,
    .failed_text = cm1e_homing_failed_text,
    .refused_text = cm1e_homing_refused_text,
    .not_finished_text = cm1e_homing_not_finished_text,
};

cm1e_error_t cm1e_homing_add(cm1e_axis_t *axis, cm1e_diag_t *diag)
{
    axis->homing = calloc(1, sizeof *axis->homing);
    if (!axis->homing)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "No memory for the homing of axis \"%s\".",
                             axis->config->name);
    axis->homing_hooks = &hooks;
    return CM1E_OK;
}
