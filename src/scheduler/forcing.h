/**
 * @file forcing.h
 * Variables of a program that others force: the value that they have whatever the program writes. The program runner has
 * named the variables for a trace, and permits them here; it applies what is forced before and behind each task. All @rt
 * cycle, unless it is said otherwise.
 */
#ifndef CM1E_SCHEDULER_FORCING_H
#define CM1E_SCHEDULER_FORCING_H

#include "core/guest_api.h"
#include "scheduler/trace_recorder.h"

enum { CM1E_FORCED = 64 };

/** A value as it lies in memory. */
typedef struct forced_value {
    uint8_t bytes[8];
    double shown;            /**< the same as a number, for the log */
} forced_value_t;

typedef struct forced {
    bool held;
    const void *owner;       /**< who forces it, with its number */
    uint32_t client;
    uint32_t column;         /**< of the trace */
    forced_value_t value;
    int64_t until_ns;
} forced_t;

typedef struct forcing {
    forced_t rows[CM1E_FORCED];
    uint32_t count;          /**< of those that are held */
} forcing_t;

typedef enum forcing_result { FORCING_DONE = 0, FORCING_HELD, FORCING_FULL, FORCING_ENDING } forcing_result_t;

/** Lets others write and force the variable that the trace has by this name. @rt init */
CM1E_GUEST_API void cm1e_scheduler_permit_forcing(cm1e_scheduler_t *scheduler, const char *name);
/** Gives the forced variables their values: between the inputs and the program, and behind it. */
CM1E_GUEST_API void cm1e_scheduler_apply_forced(cm1e_scheduler_t *scheduler);

/** Forces a permitted variable, or renews that. */
CM1E_GUEST_API forcing_result_t cm1e_scheduler_force(cm1e_scheduler_t *scheduler, const forced_t *forced);
/** Whoever forces it, it is the program's again. */
CM1E_GUEST_API void cm1e_scheduler_release(cm1e_scheduler_t *scheduler, uint32_t column);
/** Ends what this client forces. */
CM1E_GUEST_API void cm1e_scheduler_release_all(cm1e_scheduler_t *scheduler, const void *owner, uint32_t client);
/** Writes a permitted variable once; the program may change it. */
CM1E_GUEST_API forcing_result_t cm1e_scheduler_write(cm1e_scheduler_t *scheduler, uint32_t column,
                                                     const forced_value_t *value);
/** Whether the variable of a column is forced. */
CM1E_GUEST_API bool cm1e_scheduler_is_forced(const cm1e_scheduler_t *scheduler, uint32_t column);
/** Ends what was not renewed in time, and all at the end of the run. */
CM1E_GUEST_API void cm1e_scheduler_forcing_cycle(cm1e_scheduler_t *scheduler);

/** Of the scheduler. */
typedef struct forcing_parts {
    forcing_t *forcing;
    trace_t *trace;
    struct log *log;
    int64_t run_ns;
    bool ending;
} forcing_parts_t;
forcing_parts_t cm1e_scheduler_forcing_parts(cm1e_scheduler_t *scheduler);

#endif
