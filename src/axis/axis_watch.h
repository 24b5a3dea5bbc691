/**
 * @file axis_watch.h
 * Functions for observers of an axis that do not act on it: the event log, and windows of other threads.
 */
#ifndef CM1E_AXIS_AXIS_WATCH_H
#define CM1E_AXIS_AXIS_WATCH_H

#include "axis/axis_api.h"

/** The values by which an observer sees a change. */
typedef struct cm1e_axis_news {
    cm1e_axis_state_t state;
    cm1e_error_t error;             /**< CM1E_OK: none */
    uint16_t device_error;
    double value, bound;            /**< of the error: actual and allowed value; 0: none */
    cm1e_command_id_t command;      /**< the active one; 0: none */
    cm1e_command_kind_t kind;
    double position, velocity;      /**< u, u/s; inputs of that command; 0: none */
} cm1e_axis_news_t;

/** @rt cycle */
CM1E_GUEST_API void cm1e_axis_news(const cm1e_axis_t *axis, cm1e_axis_news_t *news);
/** The name of the block that posts commands of this kind: "MC_MoveAbsolute". @rt any */
CM1E_GUEST_API const char *cm1e_command_name(cm1e_command_kind_t kind);
/** Meaning and cure of an error code of the axis's drive; NULL: not a code of its manual. @rt any */
const cm1e_device_error_t *cm1e_axis_device_error(const cm1e_axis_t *axis, uint16_t code);

/** false: cm1e_axis_text() has no text. @rt cycle */
CM1E_GUEST_API bool cm1e_axis_has_text(const cm1e_axis_t *axis);
/** Bytes of a copy of this axis, whole cache lines. @rt any */
CM1E_GUEST_API size_t cm1e_axis_copy_bytes(const cm1e_axis_t *axis);
/** A copy whose text another thread may make while the axis goes on, with all that the text is made of. `copy` begins
 *  at a cache line (core/cache_line.h). @rt cycle */
CM1E_GUEST_API void cm1e_axis_copy(const cm1e_axis_t *axis, void *copy);
/** As cm1e_axis_error_text(), of an axis or of a copy. @rt block */
CM1E_GUEST_API void cm1e_axis_text(const cm1e_axis_t *axis, char *text, size_t size);

#endif
