/**
 * @file forcing.h
 * Variables of a program that others force: the value that they have whatever the program writes. They are those of the
 * table of the scheduler (variables.h); the runner of the program applies what is forced before and behind each task.
 * All @rt cycle.
 */
#ifndef CM1E_SCHEDULER_FORCING_H
#define CM1E_SCHEDULER_FORCING_H

#include "core/guest_api.h"
#include "scheduler/variables.h"

enum { CM1E_FORCED = 64 };

typedef struct forced {
    bool held;
    bool taken;              /**< not held: another one has released it. Its owner is refused until `until_ns` */
    const void *owner;       /**< who forces it, with its number */
    uint32_t client;
    uint32_t variable;       /**< its row in the table */
    variable_value_t value;
    int64_t until_ns;
} forced_t;

typedef struct forcing {
    variables_t variables;   /**< all that can be forced */
    forced_t rows[CM1E_FORCED];
    uint32_t count;          /**< of those that are held */
} forcing_t;

typedef enum forcing_result {
    FORCING_DONE = 0,
    FORCING_HELD,
    FORCING_FULL,
    FORCING_ENDING,
    FORCING_TAKEN,           /**< another one has released it, and this owner has not let go of it since */
} forcing_result_t;

/** Gives the forced variables their values: between the inputs and the program, and behind it. */
CM1E_GUEST_API void cm1e_scheduler_apply_forced(cm1e_scheduler_t *scheduler);

/** Forces a variable, or renews that. An owner whose variable another one has released is refused, until it has let go
 *  of it: has released it too, or has not asked for it for the time of `until_ns`. */
CM1E_GUEST_API forcing_result_t cm1e_scheduler_force(cm1e_scheduler_t *scheduler, const forced_t *forced);
/** Whoever forces it, it is the program's again. `who` has the variable, and the owner that releases it. One whose
 *  variable another one has released only lets go of it: what a third one forces meanwhile stays. */
CM1E_GUEST_API void cm1e_scheduler_release(cm1e_scheduler_t *scheduler, const forced_t *who);
/** Ends what this client forces. */
CM1E_GUEST_API void cm1e_scheduler_release_all(cm1e_scheduler_t *scheduler, const void *owner, uint32_t client);
/** Writes a variable once; the program may change it. */
CM1E_GUEST_API forcing_result_t cm1e_scheduler_write(cm1e_scheduler_t *scheduler, uint32_t variable,
                                                     const variable_value_t *value);
/** What cm1e_scheduler_force(), or cm1e_scheduler_write() of its variable, would return now; nothing changes. */
CM1E_GUEST_API forcing_result_t cm1e_scheduler_would_take(cm1e_scheduler_t *scheduler, const forced_t *forced,
                                                          bool force);
/** Whether the variable of a row is forced. */
CM1E_GUEST_API bool cm1e_scheduler_is_forced(const cm1e_scheduler_t *scheduler, uint32_t variable);
/** Writes the rows that are forced to `rows`, and returns their number. */
CM1E_GUEST_API uint32_t cm1e_scheduler_list_forced(const cm1e_scheduler_t *scheduler, uint32_t rows[CM1E_FORCED]);
/** Ends what was not renewed in time, and all at the end of the run. */
CM1E_GUEST_API void cm1e_scheduler_forcing_cycle(cm1e_scheduler_t *scheduler);

/** Of the scheduler. */
typedef struct forcing_parts {
    forcing_t *forcing;
    struct log *log;
    int64_t run_ns;
    bool ending;
} forcing_parts_t;
forcing_parts_t cm1e_scheduler_forcing_parts(cm1e_scheduler_t *scheduler); /**< @rt cycle */
forcing_t *cm1e_scheduler_forcing(cm1e_scheduler_t *scheduler);

#endif
