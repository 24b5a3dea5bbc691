/* What the axis knows of couplings: a table of functions, added to it when it is made. */
#include <stdlib.h>

#include "axis/axis_commands.h"
#include "coupling/coupling.h"
#include "coupling/coupling_private.h"

static void forget(cm1e_axis_t *axis)
{
    cm1e_coupling_unlink(axis);
    free(axis->coupling->cams);
    free(axis->coupling);
}

static bool stops_with_masters(const cm1e_axis_t *axis) { return axis->coupling->stopping; }

static bool by_actual(const cm1e_axis_t *axis) { return axis->coupling->now->by_actual; }

static bool hands_over(const cm1e_axis_t *axis)
{
    const follow_t *now = axis->coupling->now;
    return !now->waits_for_end || now->cam.left != 0.0;
}

static const command_method_t methods[PLAN_COUNT] = {
    [PLAN_KEEP_VELOCITY] = {cm1e_gear_out, NULL, NULL, NULL, cm1e_axis_update_move},
    [PLAN_COUPLING] = {cm1e_coupling_start, cm1e_coupling_buffer, cm1e_coupling_awaits, cm1e_coupling_begin,
                       cm1e_coupling_update},
    [PLAN_PHASING] = {cm1e_phasing_start, NULL, NULL, NULL, NULL},
};

static const coupling_hooks_t hooks = {
    .methods = methods,
    .free = forget,
    .observe = cm1e_coupling_observe,
    .advance_masters = cm1e_coupling_advance_masters,
    .first_set_point = cm1e_coupling_first_set_point,
    .await_step = cm1e_coupling_await_step,
    .await_nothing = cm1e_coupling_await_nothing,
    .hands_over = hands_over,
    .shift = cm1e_coupling_shift,
    .failed = cm1e_coupling_failed,
    .stops_with_masters = stops_with_masters,
    .by_actual = by_actual,
    .resume_masters = cm1e_coupling_resume_masters,
    .resume_slaves = cm1e_coupling_resume_slaves,
    .begins_anew = cm1e_coupling_begins_anew,
    .phasing_end = cm1e_phasing_end,
    .phasing_status = cm1e_phasing_status,
    .phasing_covered = cm1e_phasing_covered,
    .text = cm1e_coupling_text,
    .cam_text = cm1e_cam_table_text,
};

cm1e_error_t cm1e_coupling_add(cm1e_axis_t *axis, cm1e_diag_t *diag)
{
    axis->coupling = calloc(1, sizeof *axis->coupling);
    if (!axis->coupling)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "No memory for what axis \"%s\" may follow.",
                             axis->config->name);
    axis->coupling_hooks = &hooks;
    axis->observed = axis->config->type == CM1E_AXIS_ENCODER;
    return cm1e_cam_memory_init(axis, diag);
}
