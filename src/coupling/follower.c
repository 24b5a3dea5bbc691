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
    if (axis->coupling)
        free(axis->coupling->cams);
    free(axis->coupling);
    free(axis->followed);
}

/* What the copy of an axis has beside it. */
typedef struct own {
    coupling_t coupling;
    followed_t followed;
    _Alignas(cams_t) unsigned char cams[sizeof(cams_t)];
} own_t;

/* Makes the pointers into the coupling and its cams point into their copies. Points of cams stay shared: no text needs
 * them. */
static void copy_coupling(const coupling_t *own, own_t *place)
{
    coupling_t *c = &place->coupling;
    *c = *own;
    if (own->cams)
        c->cams = memcpy(place->cams, own->cams, sizeof place->cams);
    for (int i = 0; i < FOLLOWS; i++)
        if (own->follows[i].cam.slot)
            c->follows[i].cam.slot = c->cams->slots + (own->follows[i].cam.slot - own->cams->slots);
    c->now = own->now ? c->follows + (own->now - own->follows) : NULL;
}

static void copy_own(const cm1e_axis_t *axis, cm1e_axis_t *copy, void *memory)
{
    own_t *place = memory;
    copy->followed = memcpy(&place->followed, axis->followed, sizeof place->followed);
    if (axis->coupling)
        copy_coupling(axis->coupling, place);
    copy->coupling = axis->coupling ? &place->coupling : NULL;
}

static bool stops_with_masters(const cm1e_axis_t *axis) { return axis->coupling->stopping; }

/* Makes a superimposed distance (u) a part of the base motion. */
static void shift(cm1e_axis_t *axis, double way)
{
    follow_t *now = axis->coupling->now;
    const double counts = way * axis->position.scale;
    position_t *const places[] = {&now->anchor, &now->cam.slave_zero, &now->approach.begin, &now->approach.end};
    cm1e_axis_look_anew(axis);
    for (int i = 0; i < 4; i++)
        *places[i] = cm1e_position_plus(*places[i], counts);
}

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
    for (const link_t *link = axis->followed->slaves; link; link = link->next) {
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
    .own = {sizeof(own_t), copy_own},
    .observe = cm1e_coupling_observe,
    .observed_velocity = cm1e_coupling_observed_velocity,
    .advance_masters = cm1e_coupling_advance_masters,
    .first_set_point = cm1e_coupling_first_set_point,
    .await_step = cm1e_coupling_await_step,
    .await_nothing = cm1e_coupling_await_nothing,
    .hands_over = hands_over,
    .shift = shift,
    .failed = cm1e_coupling_failed,
    .stops_with_masters = stops_with_masters,
    .by_actual = by_actual,
    .is_followed = is_followed,
    .resume_masters = cm1e_coupling_resume_masters,
    .resume_slaves = cm1e_coupling_resume_slaves,
    .begin_slaves_anew = cm1e_coupling_begin_slaves_anew,
    .begins_anew = cm1e_coupling_begins_anew,
    .sees_trouble = cm1e_coupling_sees_trouble,
    .look_across = cm1e_coupling_look_across,
    .held = cm1e_coupling_held,
    .phasing_end = cm1e_phasing_end,
    .phasing_status = cm1e_phasing_status,
    .phasing_covered = cm1e_phasing_covered,
    .text = cm1e_coupling_text,
    .cam_text = cm1e_cam_table_text,
};

/* An encoder makes no motion, and a drive that moves by itself follows nothing. */
static bool may_follow(const cm1e_axis_config_t *config)
{
    return config->follows != CM1E_FOLLOWS_NOTHING && config->type != CM1E_AXIS_ENCODER &&
           config->motion != CM1E_MOTION_DRIVE;
}

cm1e_error_t cm1e_coupling_add(cm1e_axis_t *axis, cm1e_diag_t *diag)
{
    const cm1e_axis_config_t *config = axis->config;
    const bool follows = may_follow(config);
    axis->followed = calloc(1, sizeof *axis->followed);
    axis->coupling = follows ? cm1e_cache_lines(sizeof *axis->coupling) : NULL;
    if (!axis->followed || (follows && !axis->coupling)) {
        free(axis->followed);
        free(axis->coupling);
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "No memory for the couplings of axis \"%s\".",
                             config->name);
    }
    axis->coupling_hooks = &hooks;
    axis->observed = config->type == CM1E_AXIS_ENCODER;
    if (!follows)
        return CM1E_OK;
    axis->coupling->keeps_ratio = config->coupling_stop == CM1E_COUPLING_STOP_KEEP_RATIO;
    return config->follows == CM1E_FOLLOWS_ANY ? cm1e_cam_memory_init(axis, diag) : CM1E_OK;
}
