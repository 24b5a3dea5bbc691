/**
 * @file trace.h
 * The last cycles of every axis in a ring that is allocated before the cycle starts, and its writers.
 */
#ifndef CM1E_SCHEDULER_TRACE_H
#define CM1E_SCHEDULER_TRACE_H

#include <stdio.h>

#include "axis/axis.h"
#include "cm1e/scheduler.h"
#include "core/guest_api.h"

typedef struct cm1e_trace_sample {
    double set_position, actual_position, set_velocity, actual_velocity, torque;
    cm1e_axis_state_t state;
} trace_sample_t;

/** A moment that the program marked. */
typedef struct cm1e_trace_mark {
    int64_t time_ns;
    const char *text;
} trace_mark_t;

enum { TRACE_MARKS = 64 };

typedef struct trace {
    uint32_t axes, capacity, every;
    uint32_t first, used;     /**< samples: index of the oldest, and their number */
    uint32_t until_next;      /**< cycles until the next one is recorded */
    const char **names;       /**< of the axes */
    int64_t *times_ns;        /**< [capacity] */
    trace_sample_t *samples;  /**< [capacity][axes] */
    trace_mark_t marks[TRACE_MARKS]; /**< ring of marks */
    uint32_t first_mark, mark_count;
} trace_t;

/** `capacity` 0: a trace that records nothing. @rt init */
cm1e_error_t cm1e_trace_init(trace_t *trace, cm1e_axis_t *const axes[], uint32_t count, uint32_t capacity,
                             uint32_t every, cm1e_diag_t *diag);
void cm1e_trace_free(trace_t *trace);
/** @rt cycle */
void cm1e_trace_record(trace_t *trace, cm1e_axis_t *const axes[], int64_t time_ns);

/** Keeps the last TRACE_MARKS marks; `text` must outlive the trace. @rt cycle */
void cm1e_trace_mark(trace_t *trace, const char *text, int64_t time_ns);

/** Sample n, 0 = oldest. */
CM1E_GUEST_API int64_t cm1e_trace_time_ns(const trace_t *trace, uint32_t n);
CM1E_GUEST_API const trace_sample_t *cm1e_trace_sample(const trace_t *trace, uint32_t n, uint32_t axis);
/** Mark n, 0 = oldest. */
CM1E_GUEST_API const trace_mark_t *cm1e_trace_mark_at(const trace_t *trace, uint32_t n);

/** The trace of a scheduler. It lives as long as the scheduler. @rt init */
CM1E_GUEST_API const trace_t *cm1e_scheduler_trace(const cm1e_scheduler_t *scheduler);

/** Prints the content of a CSV file. */
void cm1e_trace_print_csv(const trace_t *trace, FILE *file);
/** Writes under a temporary name and renames, so that no reader sees an incomplete file; in the "C" locale.
 *  @rt block */
CM1E_GUEST_API cm1e_error_t cm1e_trace_write_file(const trace_t *trace, const char *path,
                                   void (*print)(const trace_t *trace, FILE *file), cm1e_diag_t *diag);

#endif
