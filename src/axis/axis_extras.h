/**
 * @file axis_extras.h
 * What an axis has to do in a cycle beside its motion, as bits (extra_t). Who begins or ends something of that kind
 * sets its bit.
 */
#ifndef CM1E_AXIS_AXIS_EXTRAS_H
#define CM1E_AXIS_AXIS_EXTRAS_H

#include "axis/axis_parts.h"

static inline void cm1e_axis_set_extra(cm1e_axis_t *axis, extra_t extra, bool on)
{
    axis->extras = (uint8_t)(on ? axis->extras | extra : axis->extras & ~extra);
}
static inline bool axis_has_extra(const cm1e_axis_t *axis, extra_t extra) { return axis->extras & extra; }
/** Whether the first waiting command awaits a place of its master. */
static inline bool axis_awaits(const cm1e_axis_t *axis) { return axis_has_extra(axis, EXTRA_AWAITS); }
/** Called when something of EXTRA_SIGNALS has begun or ended. */
static inline void cm1e_axis_signals_changed(cm1e_axis_t *axis)
{
    cm1e_axis_set_extra(axis, EXTRA_SIGNALS,
                        axis->commands.kept != 0 || axis->drive.command.digital_outputs != 0 || axis->drive.wiring);
}

#endif
