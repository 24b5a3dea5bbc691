/**
 * @file trace_recorder.h
 * A recorder: one value per signal and cycle, in a ring that is allocated before the cycle starts, and the writers of
 * files. A signal is a column. The first columns are those of the axes, TRACE_AXIS_COLUMNS each.
 */
#ifndef CM1E_SCHEDULER_TRACE_RECORDER_H
#define CM1E_SCHEDULER_TRACE_RECORDER_H

#include <stdio.h>

#include "axis/axis_api.h"
#include "cm1e/trace.h"
#include "core/guest_api.h"

/** Columns of an axis, in their order. */
enum {
    TRACE_STATE = 0, TRACE_SET_POSITION, TRACE_ACTUAL_POSITION, TRACE_SET_VELOCITY, TRACE_ACTUAL_VELOCITY, TRACE_TORQUE,
    TRACE_AXIS_COLUMNS,
};

typedef enum trace_kind {
    TRACE_KIND_NUMBER = 0,
    TRACE_KIND_FLAG,   /**< 0 or 1 */
    TRACE_KIND_STATE,  /**< cm1e_axis_state_t */
    TRACE_KIND_ERROR,  /**< cm1e_error_t */
    TRACE_KIND_COUNT,  /**< a number of events since the start */
} trace_kind_t;

/** An object of a drive that took no part when its column was added: where it lies shows when the drive has come. */
typedef struct trace_object {
    cm1e_bus_t *bus; /**< NULL: there is no such object */
    uint16_t position, index;
    uint8_t subindex;
} trace_object_t;

/** One signal. */
typedef struct trace_column {
    char name[CM1E_TRACE_NAME_BYTES], unit[CM1E_TRACE_UNIT_BYTES];
    trace_kind_t kind;
    cm1e_trace_type_t type;
    const void *value;  /**< where it is read; NULL: a column of an axis */
    bool little_endian; /**< it lies in the process image */
    uint8_t bit;        /**< it is one bit of a byte: 1 = bit 0; else 0 */
    trace_object_t absent;
} trace_column_t;

/** A moment that the program marked. */
typedef struct cm1e_trace_mark {
    int64_t time_ns;
    const char *text;
} trace_mark_t;

enum { TRACE_MARKS = 64 };

/** What the scheduler tells of its own cycles. */
typedef struct trace_timing {
    double wake_up_latency_us, execution_time_us;
    uint64_t lost_frames, overruns;
} trace_timing_t;

/** When the recording ends. */
typedef struct trace_trigger {
    cm1e_trace_trigger_kind_t kind;
    uint32_t column;
    double level, before;     /**< `before`: value of the last sample; NAN: there was none */
    bool stopped[CM1E_MAX_AXES]; /**< axes that were in ErrorStop in the last sample */
    uint32_t samples_before;
    bool seen;                /**< it came */
    uint32_t left;            /**< samples to record from then on */
    char text[CM1E_TRACE_NAME_BYTES + 16]; /**< of its mark */
} trace_trigger_t;

typedef struct trace {
    uint32_t axes, capacity, every;
    bool begun;               /**< the columns are complete */
    uint32_t first, used;     /**< samples: index of the oldest, and their number */
    uint32_t until_next;      /**< cycles until the next one is recorded */
    const char **names;       /**< of the axes */
    trace_column_t *columns;
    uint32_t column_count, column_room, variables;
    int64_t *times_ns;        /**< [capacity] */
    double *values;           /**< [capacity][column_count]; NULL: no sample yet */
    trace_timing_t timing;
    trace_trigger_t trigger;
    trace_mark_t marks[TRACE_MARKS]; /**< ring of marks */
    uint32_t first_mark, mark_count;
} trace_t;

/** The value of a variable of the program. @rt cycle */
CM1E_GUEST_API double cm1e_trace_value(const trace_column_t *column);

/** A trace of `count` axes with these names, which are not copied. `capacity` 0: it has columns, for others who record
 *  them, and records nothing itself. @rt init */
CM1E_GUEST_API cm1e_error_t cm1e_trace_init(trace_t *trace, const char *const names[], uint32_t count,
                                            uint32_t capacity, uint32_t every, cm1e_diag_t *diag);
CM1E_GUEST_API void cm1e_trace_free(trace_t *trace);
/** Adds a column that is read at `column->value`; conditions as for cm1e_scheduler_trace_variable(). @rt init */
CM1E_GUEST_API cm1e_error_t cm1e_trace_add(trace_t *trace, const trace_column_t *column, cm1e_diag_t *diag);
/** Adds the object of a drive at `position`; cm1e_scheduler_trace_object(). @rt init */
CM1E_GUEST_API cm1e_error_t cm1e_trace_add_object(trace_t *trace, cm1e_bus_t *bus, uint16_t position,
                                                  const char *axis, uint16_t index, uint8_t subindex,
                                                  cm1e_diag_t *diag);
/** Finds such an object in the present process data; NULL: it is not there. `*type` keeps its sign, and gets its size.
 *  @rt cycle */
const uint8_t *cm1e_trace_find_object(const trace_object_t *object, cm1e_trace_type_t *type);
cm1e_error_t cm1e_trace_set_trigger(trace_t *trace, const cm1e_trace_trigger_t *trigger, cm1e_diag_t *diag);
/** Allocates the samples; columns are complete. @rt init */
CM1E_GUEST_API cm1e_error_t cm1e_trace_begin(trace_t *trace, cm1e_diag_t *diag);
/** @rt cycle */
CM1E_GUEST_API void cm1e_trace_record(trace_t *trace, cm1e_axis_t *const axes[], int64_t time_ns);
/** Takes in a sample that was recorded elsewhere, and lets the trigger see it. false: the trigger has ended the
 *  recording. @rt block */
bool cm1e_trace_take(trace_t *trace, const double *values, int64_t time_ns);
/** The next sample of the ring, all values 0; NULL: the trigger has ended the recording. @rt cycle */
double *cm1e_trace_next_sample(trace_t *trace, int64_t time_ns);

/** Keeps the last TRACE_MARKS marks; `text` must outlive the trace. @rt cycle */
void cm1e_trace_mark(trace_t *trace, const char *text, int64_t time_ns);

/** The column has a variable of the program, or an object; those of axes and timing come before. */
static inline bool cm1e_trace_is_variable(const trace_t *trace, uint32_t column)
{
    return column + trace->variables >= trace->column_count;
}

/** Sample n, 0 = oldest: its time, and its values by column. */
CM1E_GUEST_API int64_t cm1e_trace_time_ns(const trace_t *trace, uint32_t n);
CM1E_GUEST_API const double *cm1e_trace_sample(const trace_t *trace, uint32_t n);
/** Mark n, 0 = oldest. */
CM1E_GUEST_API const trace_mark_t *cm1e_trace_mark_at(const trace_t *trace, uint32_t n);

/** The trace of a scheduler, NULL of none. It lives as long as the scheduler. @rt init */
CM1E_GUEST_API const trace_t *cm1e_scheduler_trace(const cm1e_scheduler_t *scheduler);

cm1e_error_t cm1e_trace_write_csv(const trace_t *trace, const char *path, cm1e_diag_t *diag); /**< @rt block */
cm1e_error_t cm1e_trace_write_npy(const trace_t *trace, const char *path, cm1e_diag_t *diag); /**< @rt block */

/** Prints the content of a file. */
void cm1e_trace_print_csv(const trace_t *trace, FILE *file);
/** Writes under a temporary name and renames, so that no reader sees an incomplete file; in the "C" locale.
 *  @rt block */
CM1E_GUEST_API cm1e_error_t cm1e_trace_write_file(const trace_t *trace, const char *path,
                                                  void (*print)(const trace_t *trace, FILE *file), cm1e_diag_t *diag);

#endif
