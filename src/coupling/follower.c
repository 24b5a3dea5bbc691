/* Adds couplings to an axis when it is made: a table of functions that the axis calls (axis_hooks.h). */
#include <stdlib.h>
#include <string.h>

#include "axis/axis_commands.h"
#include "axis/axis_setpoint.h"
#include "coupling/coupling.h"
#include "coupling/coupling_private.h"

static void forget(cm1e_axis_t *axis)
{
    cm1e_coupling_unlink(axis);
    free(axis->coupling->cams);
    free(axis->coupling);
}

/* Makes the pointers into the coupling and its cams point into their copies. Points of cams stay shared: no text needs
 * them. */
static void copy_own(const cm1e_axis_t *axis, cm1e_axis_t *copy, void *place)
{
    coupling_t *c = place;
    cams_t *cams = (cams_t *)(void *)((unsigned char *)place + sizeof *c);
    const coupling_t *own = axis->coupling;
    memcpy(c, own, sizeof *c);
    memcpy(cams, own->cams, sizeof *cams);
    for (int i = 0; i < FOLLOWS; i++)
        if (own->follows[i].cam.slot)
            c->follows[i].cam.slot = cams->slots + (own->follows[i].cam.slot - own->cams->slots);
    c->now = own->now ? c->follows + (own->now - own->follows) : NULL;
    c->cams = cams;
    copy->coupling = c;
}
_Static_assert(sizeof(coupling_t) % 8 == 0 && sizeof(cams_t) % 8 == 0, "one lies behind the other in a copy");

static bool stops_with_masters(const cm1e_axis_t *axis) { return axis->coupling->stopping; }

static bool by_actual(const cm1e_axis_t *axis) { return axis->coupling->now->by_actual; }

static bool hands_over(const cm1e_axis_t *axis)
{
    const follow_t *now = axis->coupling->now;
    return !now->waits_for_end || now->cam.left != 0.0;
}

static bool is_of(const link_t *link, const follow_t *follow)
{
    return follow && link >= follow->links && link < follow->links + follow->count;
}

/* Links stay in the list until their place is taken for another coupling, so not every link means a slave. */
static bool is_followed(const cm1e_axis_t *axis)
{
    for (const link_t *link = axis->coupling->slaves; link; link = link->next) {
        const coupling_t *slave = link->slave->coupling;
        if ((axis_follows(link->slave) && is_of(link, slave->now)) || is_of(link, slave->awaited))
            return true;
    }
    return false;
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
    .own = {sizeof(coupling_t) + sizeof(cams_t), copy_own},
    .observe = cm1e_coupling_observe,
    .observed_velocity = cm1e_coupling_observed_velocity,
    .advance_masters = cm1e_coupling_advance_masters,
    .first_set_point = cm1e_coupling_first_set_point,
    .await_step = cm1e_coupling_await_step,
    .await_nothing = cm1e_coupling_await_nothing,
    .hands_over = hands_over,
    .shift = cm1e_coupling_shift,
    .failed = cm1e_coupling_failed,
    .stops_with_masters = stops_with_masters,
    .by_actual = by_actual,
    .is_followed = is_followed,
    .resume_masters = cm1e_coupling_resume_masters,
    .resume_slaves = cm1e_coupling_resume_slaves,
    .begins_anew = cm1e_coupling_begins_anew,
    .look_across = cm1e_coupling_look_across,
    .held = cm1e_coupling_held,
    .phasing_end = cm1e_phasing_end,
    .phasing_status = cm1e_phasing_status,
    .phasing_covered = cm1e_phasing_covered,
    .text = cm1e_coupling_text,
    .cam_text = cm1e_cam_table_text,
};

cm1e_error_t cm1e_coupling_add(cm1e_axis_t *axis, cm1e_diag_t *diag)
{
    axis->coupling = cm1e_cache_lines(sizeof *axis->coupling);
    if (!axis->coupling)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "No memory for the couplings of axis \"%s\".",
                             axis->config->name);
    axis->coupling->keeps_ratio = axis->config->coupling_stop == CM1E_COUPLING_STOP_KEEP_RATIO;
    axis->coupling_hooks = &hooks;
    axis->observed = axis->config->type == CM1E_AXIS_ENCODER;
    return cm1e_cam_memory_init(axis, diag);
}
