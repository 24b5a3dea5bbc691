/* Cams in the memory of their slave (MC_CamTableSelect). */
#include <stdio.h>
#include <stdlib.h>

#include "axis/axis_commands.h"
#include "axis/axis_setpoint.h"
#include "axis/axis_text.h"
#include "coupling/coupling_private.h"

enum { DEFAULT_POINTS = 128 };

cm1e_error_t cm1e_cam_memory_init(cm1e_axis_t *axis, cm1e_diag_t *diag)
{
    const int points = axis->config->cam_points ? axis->config->cam_points : DEFAULT_POINTS;
    cams_t *cams = calloc(1, sizeof *cams + (size_t)CAM_SLOTS * (size_t)points * sizeof cams->knots[0]);
    if (!cams)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "No memory for the cams of axis \"%s\": %d of %d points.",
                             axis->config->name, CM1E_AXIS_CAMS, points);
    cams->points = points;
    for (int i = 0; i < CAM_SLOTS; i++)
        cams->slots[i].knots = &cams->knots[i * points];
    axis->coupling->cams = cams;
    return CM1E_OK;
}

const cam_slot_t *cm1e_cam_memory_find(const cm1e_axis_t *axis, MC_CAM_ID id)
{
    for (int i = 0; id != 0 && i < CAM_SLOTS; i++)
        if (axis->coupling->cams->slots[i].id == id)
            return &axis->coupling->cams->slots[i];
    return NULL;
}

/* Whether the axis follows the cam, or a waiting command names it. */
static bool used(cm1e_axis_t *axis, const cam_slot_t *slot)
{
    const coupling_t *c = axis->coupling;
    if ((axis_follows(axis) && c->now->cam.slot == slot) || (c->awaited && c->awaited->cam.slot == slot))
        return true;
    for (int i = 0; i < COUPLINGS_WAITING; i++)
        if (c->waiting[i].coupling.cam == slot->id && cm1e_axis_find_waiting(axis, c->waiting[i].id))
            return true;
    return false;
}

static cam_slot_t *empty_slot(cams_t *cams)
{
    cam_slot_t *slot = cams->slots;
    while (slot->id != 0) /* one place is always free: there is one more than cams that stay */
        slot++;
    return slot;
}

/* The cam to be overwritten: the oldest one that is not in use; NULL: none. `*room`: whether a place is free. */
static cam_slot_t *to_go(cm1e_axis_t *axis, bool *room)
{
    cam_slot_t *oldest = NULL;
    int count = 0;
    for (int i = 0; i < CAM_SLOTS; i++) {
        cam_slot_t *slot = &axis->coupling->cams->slots[i];
        count += slot->id != 0;
        if (slot->id != 0 && !used(axis, slot) &&
            (!oldest || axis->coupling->cams->last - slot->id > axis->coupling->cams->last - oldest->id))
            oldest = slot;
    }
    *room = count < CM1E_AXIS_CAMS;
    return oldest;
}

static cm1e_error_t select_cam(cm1e_axis_t *axis, const MC_CAM_REF *table, bool periodic, cam_slot_t **taken)
{
    cams_t *cams = axis->coupling->cams;
    bool room;
    cam_slot_t *oldest = to_go(axis, &room), *slot = empty_slot(cams);
    if (!room && !oldest)
        return CM1E_ERROR_FULL;
    cams->fault = cm1e_cam_compile(&slot->cam, slot->knots, cams->points, table, periodic, &cams->wrong);
    if (cams->fault != CM1E_CAM_GOOD)
        return CM1E_ERROR_AXIS_CAM_TABLE;
    if (!room)
        oldest->id = 0;
    if (++cams->last == 0)
        cams->last = 1; /* 0 is not the number of a cam */
    slot->id = cams->last;
    *taken = slot;
    return CM1E_OK;
}

cm1e_error_t cm1e_axis_cam_select(cm1e_axis_t *slave, const MC_CAM_REF *cam, bool periodic, bool master_absolute,
                                  bool slave_absolute, MC_CAM_ID *id)
{
    cam_slot_t *slot = NULL;
    const cm1e_error_t error = coupling_can(slave, CM1E_COMMAND_CAM_IN)
                                   ? select_cam(slave, cam, periodic, &slot) : CM1E_ERROR_AXIS_NO_COUPLINGS;
    *id = 0;
    cm1e_axis_remember_not_set(slave, (not_set_t){.error = error, .what = NOT_SET_CAM});
    if (error != CM1E_OK)
        return error;
    slot->master_absolute = master_absolute;
    slot->slave_absolute = slave_absolute;
    *id = slot->id;
    return CM1E_OK;
}

void cm1e_no_couplings_text(const cm1e_axis_t *axis, const char *what, char *text, size_t size)
{
    const cm1e_axis_config_t *config = axis->config;
    if (config->type == CM1E_AXIS_ENCODER || config->motion == CM1E_MOTION_DRIVE)
        snprintf(text, size, "Axis \"%s\": %s, because the axis cannot follow: %s.", config->name, what,
                 config->type == CM1E_AXIS_ENCODER ? "it is an encoder"
                                                   : "its drive makes the motions (motion: drive)");
    else
        snprintf(text, size, "Axis \"%s\": %s, because the configuration has `follows: %s` for this axis. Write "
                 "`follows: %s` there.", config->name, what,
                 config->follows == CM1E_FOLLOWS_GEARS ? "gears" : "nothing",
                 config->follows == CM1E_FOLLOWS_GEARS ? "any" : "any, or gears if it follows no cam");
}

/* Explains what is wrong with the cam that was refused last, and what would be right. */
void cm1e_cam_table_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    if (axis->not_set.error == CM1E_ERROR_AXIS_NO_COUPLINGS) {
        cm1e_no_couplings_text(axis, "the cam was not selected", text, size);
        return;
    }
    const cams_t *cams = axis->coupling->cams;
    const char *name = axis->config->name;
    const int point = cams->wrong + 1;
    if (axis->not_set.error == CM1E_ERROR_FULL) {
        snprintf(text, size, "Axis \"%s\": the cam was not selected. There is memory for %d cams; all are followed, or "
                 "commands that wait name them.", name, CM1E_AXIS_CAMS);
        return;
    }
    switch (cams->fault) {
    case CM1E_CAM_TOO_FEW:
        snprintf(text, size, "Axis \"%s\": a cam has no points, or only one; expected 2 ... %d.", name, cams->points);
        break;
    case CM1E_CAM_TOO_MANY:
        snprintf(text, size, "Axis \"%s\": a cam has too many points; expected 2 ... %d, as `cam_points` of the bus "
                 "file says.", name, cams->points);
        break;
    case CM1E_CAM_NO_NUMBER:
        snprintf(text, size, "Axis \"%s\": a number of point %d of a cam is not finite or beyond 1e30; expected -1e30 "
                 "... 1e30.", name, point);
        break;
    case CM1E_CAM_NOT_RISING:
        snprintf(text, size, "Axis \"%s\": Master of point %d of a cam is not above that of point %d; it must rise "
                 "from one to the next.", name, point, point - 1);
        break;
    case CM1E_CAM_CURVE:
        snprintf(text, size, "Axis \"%s\": the Curve of a cam is unknown; expected mcCamPolynomial5, mcCamCubicSpline "
                 "or mcCamLinear.", name);
        break;
    case CM1E_CAM_STEEP:
        snprintf(text, size, "Axis \"%s\": points %d and %d of a cam are so close together, or so far apart, that the "
                 "curve between them cannot be computed; expected distances of the master of 1e-30 or more, and slaves "
                 "that the axis reaches.", name, point, point + 1);
        break;
    case CM1E_CAM_GOOD:
        break;
    }
}

void cm1e_cam_id_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    char ids[12 * CAM_SLOTS] = "";
    size_t used_bytes = 0;
    for (int i = 0; i < CAM_SLOTS; i++)
        if (axis->coupling->cams->slots[i].id != 0)
            used_bytes += (size_t)snprintf(ids + used_bytes, sizeof ids - used_bytes, " %u",
                                           (unsigned)axis->coupling->cams->slots[i].id);
    snprintf(text, size, "Axis \"%s\": %s. The last %d of this slave stay, now:%s.", axis->config->name,
             cm1e_strerror(CM1E_ERROR_AXIS_CAM_ID), CM1E_AXIS_CAMS, used_bytes ? ids : " none");
}

void cm1e_cam_start_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    const cam_refused_t *r = &axis->coupling->cams->refused;
    snprintf(text, size, "Axis \"%s\" is at %.6g u with %.6g u/s, but the cam is at %.6g u with %.6g u/s. Move it "
             "there first, or use mcRampIn or a MasterStartDistance.", axis->config->name,
             r->position, r->velocity, r->wanted_position, r->wanted_velocity);
}
