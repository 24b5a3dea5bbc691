/**
 * @file show.h
 * What the control socket tells, as JSON. docs/CONTROL.md names every member.
 */
#ifndef CM1E_CONTROL_SHOW_H
#define CM1E_CONTROL_SHOW_H

#include <jansson.h>

#include "control/view.h"

/** Of a filled snapshot. */
json_t *cm1e_show_axes(const view_t *view);
json_t *cm1e_show_slaves(const view_t *view);
json_t *cm1e_show_ring(const view_t *view);
/** Devices on the wire that are none of its slaves. */
json_t *cm1e_show_strangers(const view_t *view);

json_t *cm1e_show_statistics(const cm1e_scheduler_t *scheduler);
/** Records of the run after number `after`, as many as fit into a reply: {"events": [...], "lost": n, "last": n}. Of
 *  events of other buses only the text has the axis. */
json_t *cm1e_show_log(const view_t *view, uint64_t after);

/** null for what JSON has no number for. */
json_t *cm1e_show_real(double value);

#endif
